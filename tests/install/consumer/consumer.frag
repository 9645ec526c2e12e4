#version 450
// What users' shaders include of an installation.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_gpu_vk_light.h"
#include "hdrp_shadow.h"

#define HDRP_FEATURES     0u
#define HDRP_WORD         HDRP_GPU_VK_WORD_ALL
#define HDRP_LIGHTING_SET 1
#define HDRP_SHADOW_ATLAS
#define HDRP_LIGHT_BLOCKERS
#include "shaders/shadow_map.glsl"
#include "shaders/light_blockers.glsl"
#include "shaders/light_loop.glsl"
#define HDRP_NORMAL_ONLY
#include "shaders/gbuffer_output.glsl"

layout(location = 0) in vec3 offset;

void main()
{
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(hdrp_brdf_surface_default());
    hdrp_lit_surface r = hdrp_light_surface(d, offset, uvec2(gl_FragCoord.xy), 0u, 1.0, 255u, 1.0);
    d.normal = r.specular;
    hdrp_write_normal(d);
}
