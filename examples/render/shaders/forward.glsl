// Lighting of a surface as it is drawn, by the loop of deferred lighting.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scene.glsl"
#include "hdrp_pack.h"
#include "hdrp_gpu_vk_light.h"
#include "surface.glsl"
#include "engine.glsl"

layout(constant_id = 0) const uint MATERIALS = 0u; // HDRP_BRDF_FEATURE_...
layout(constant_id = 1) const uint WORD = 0u;      // HDRP_GPU_VK_WORD_...
#define HDRP_FEATURES        MATERIALS
#define HDRP_WORD            WORD
#define HDRP_LIGHTING_SET    2
#include "shaders/light_loop.glsl"

layout(location = 0) flat in uint triangle;

hdrp_lit_surface lit_surface(Surface s, hdrp_brdf_data data)
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    vec3 offset = s.position - frame.eye_step.xyz;
    uint tile = hdrp_cull_tile_of_pixel(lighting.grid, pixel.x, pixel.y);
    float z_view = dot(offset, frame.forward_orthographic.xyz);
    return hdrp_light_surface(data, offset, pixel, tile, z_view, s.light_layers, 1.0);
}
