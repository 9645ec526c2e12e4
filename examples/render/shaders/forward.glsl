// Lighting of a surface as it is drawn, by the loop of deferred lighting.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scene.glsl"
#include "hdrp_pack.h"
#include "hdrp_gpu_vk_light.h"
#include "hdrp_shadow.h"
#include "surface.glsl"
#include "engine.glsl"

layout(constant_id = 0) const uint MATERIALS = 0u; // HDRP_BRDF_FEATURE_...
layout(constant_id = 1) const uint WORD = 0u;      // HDRP_GPU_VK_WORD_...
#define HDRP_FEATURES        MATERIALS
#define HDRP_WORD            WORD
#define HDRP_LIGHTING_SET    2
#define light_shadow map_shadow
#include "shaders/shadow_map.glsl"
#undef light_shadow

// Bias is for the normal of the triangle; lists of layers have directional lights too.
vec3 shadow_normal;

float light_shadow(uint shadow_index, vec3 position, vec3 normal, vec3 l, float distance_m)
{
    float cascades = shadow_views[shadow_index].ball.w;
    if (cascades > 0.0) {
        return shadow_cascades_visibility(shadow_index, HDRP_SHADOW_CASCADES_MAX, position,
                                          shadow_normal);
    }
    return map_shadow(shadow_index, position, shadow_normal, l, distance_m);
}

#define HDRP_SHADOW_ATLAS
#define HDRP_LIGHT_BLOCKERS
#define HDRP_BLOCKER_BINDING 22
#include "shaders/light_blockers.glsl"
#include "shaders/light_loop.glsl"

layout(location = 0) flat in uint triangle;

hdrp_lit_surface lit_surface_at(Surface s, hdrp_brdf_data data, uvec2 pixel)
{
    vec3 offset = s.position - frame.eye_step.xyz;
    uint tile = hdrp_cull_tile_of_pixel(lighting.grid, pixel.x, pixel.y);
    shadow_normal = s.geometric_normal;
    float z_view = dot(offset, frame.forward_orthographic.xyz);
    return hdrp_light_surface(data, offset, pixel, tile, z_view, s.light_layers, 1.0);
}

hdrp_lit_surface lit_surface(Surface s, hdrp_brdf_data data)
{
    return lit_surface_at(s, data, uvec2(gl_FragCoord.xy));
}
