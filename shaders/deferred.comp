#version 450
// Lights the pixels of the tiles of a variant. A group lights a tile; each wave of 64 threads a
// square of 8 x 8 pixels of it.
// header: hdrp_gpu_vk_light.h
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_gpu_vk_light.h"

#define SIDE 16u

layout(constant_id = 0) const uint WORD = HDRP_GPU_VK_WORD_ALL;
#define HDRP_WORD     WORD
#define HDRP_FEATURES ((WORD >> HDRP_GPU_VK_WORD_MATERIAL_SHIFT) & 31u)
#define HDRP_SHADOW_ATLAS
#define HDRP_LIGHT_BLOCKERS
#define HDRP_BLOCKER_BINDING 24
#include "hdrp_shadow.h"
#include "shadow_map.glsl"
#include "light_blockers.glsl"
#include "light_loop.glsl"

layout(local_size_x = 256) in;
layout(binding = 12) uniform texture2D depths;
layout(binding = 13) uniform texture2D rt0;
layout(binding = 14) uniform texture2D rt1;
layout(binding = 15) uniform texture2D rt2;
layout(binding = 16) uniform texture2D rt3;
layout(binding = 17) uniform texture2D rt4;
layout(binding = 18) uniform utexture2D kinds;
layout(binding = 19) uniform texture2D occlusion;
layout(binding = 20) uniform writeonly image2D color;
layout(binding = 21) uniform writeonly image2D diffuse;
layout(std430, binding = 22) readonly buffer List { uint list[]; };
layout(std430, binding = 23) readonly buffer Arguments { uvec4 arguments[]; };
layout(push_constant) uniform Push { uvec4 push; }; // x index of the variant, y variants

#include "lit_pixels.glsl"

// Place of a pixel less the eye.
vec3 offset_of(uvec2 pixel, float z)
{
    return hdrp_cull_offset_of_pixel(lighting.camera, float(pixel.x) + 0.5, float(pixel.y) + 0.5,
                                     float(lighting.picture.x), float(lighting.picture.y), z);
}

// The material of a pixel.
hdrp_brdf_data load_material(ivec2 at)
{
    hdrp_pack_gbuffer g;
    uint targets = hdrp_i_there_is(HDRP_GPU_VK_LIGHTING_RT4) ? HDRP_PACK_GBUFFER_RT4 : 0u;
    hdrp_brdf_data d;
    g.rt0 = texelFetch(rt0, at, 0);
    g.rt1 = texelFetch(rt1, at, 0);
    g.rt2 = texelFetch(rt2, at, 0);
    g.rt3 = vec3(0.0);
    g.rt4 = texelFetch(rt4, at, 0);
    g.rt5 = vec4(0.0);
    d = hdrp_pack_gbuffer_decode_features(g, targets, HDRP_FEATURES);
    if ((d.features & HDRP_FEATURES & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u) {
        vec3 slab = hdrp_v3_from_v4(slab_colors[d.diffusion_profile]);
        d.transmittance = hdrp_brdf_volume_transmittance(slab, 1.0, d.thickness);
    }
    return d;
}

// Layers that a pixel is on.
uint load_layers(ivec2 at)
{
    uint layers = 255u;
    if (hdrp_i_there_is(HDRP_GPU_VK_LIGHTING_RT4)) {
        layers = hdrp_pack_unorm_from_float(texelFetch(rt4, at, 0).w, 8u);
    }
    return layers;
}

void light_pixel(uvec2 pixel, uint tile)
{
    // What is found again from one register takes no others meanwhile.
    uint id = hdrp_cull_tile_id(pixel.x, pixel.y);
    float z = lit_depth(pixel);
    float visibility = 1.0;
    hdrp_lit_surface r;
    hdrp_light_state s;
    vec3 v, position, glow;
    uint layers;
    ivec2 at = ivec2(pixel);
    if (z < 0.0) {
        return;
    }
    if (hdrp_i_has(HDRP_GPU_VK_WORD_ENVIRONMENT) &&
        hdrp_i_there_is(HDRP_GPU_VK_LIGHTING_OCCLUSION)) {
        visibility = texelFetch(occlusion, at, 0).x;
    }
    v = hdrp_cull_direction_to_eye(lighting.camera, offset_of(pixel, z));
    s = hdrp_light_begin(r, load_material(at), v, visibility);
    at = hdrp_i_pixel(id);
    layers = load_layers(at);
    position = offset_of(uvec2(at), z) + hdrp_v3_from_v4(lighting.camera.eye_near);
    hdrp_light_end(r, s, position, uvec2(at), tile, z, layers);
    at = hdrp_i_pixel(id);
    glow = hdrp_i_pack_gbuffer_light(texelFetch(rt3, at, 0).xyz);
    if (hdrp_i_has(HDRP_GPU_VK_WORD_SPLIT) &&
        (lighting.lights.w & HDRP_GPU_VK_WORD_SPLIT) != 0u &&
        (s.d.features & HDRP_BRDF_FEATURE_SUBSURFACE) != 0u) {
        imageStore(diffuse, at, vec4(r.diffuse * lighting.scales.x, 1.0));
        r.diffuse = vec3(0.0);
    }
    imageStore(color, at, vec4((r.diffuse + r.specular) * lighting.scales.x + glow, 1.0));
}

void main()
{
    uint last = push.x + 1u < push.y ? arguments[push.x + 1u].w : arguments[HDRP_CULL_VARIANT_MAX].x;
    uint own = arguments[push.x].w + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (own >= last) { // of a row that is not full
        return;
    }
    uint id = list[own];
    uvec2 at = uvec2(hdrp_cull_tile_id_x(id), hdrp_cull_tile_id_y(id));
    uvec2 begin = at * lighting.grid.tiles.xy;
    uvec2 end = min(begin + lighting.grid.tiles.xy, lighting.picture.xy);
    uint tile = at.y * lighting.grid.tiles.z + at.x;
    // Loops over what does not depend on the thread.
    for (uint y = begin.y; y < end.y; y += SIDE) {
        for (uint x = begin.x; x < end.x; x += SIDE) {
            uint wave = gl_LocalInvocationIndex >> 6;
            uint lane = gl_LocalInvocationIndex & 63u;
            uvec2 pixel = uvec2(x + (wave & 1u) * 8u + (lane & 7u),
                                y + (wave >> 1) * 8u + (lane >> 3));
            if (pixel.x < end.x && pixel.y < end.y) {
                light_pixel(pixel, tile);
            }
        }
    }
}
