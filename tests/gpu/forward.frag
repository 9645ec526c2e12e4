#version 450
// Forward lighting and all outputs, as an engine would include them; compiled, not run. Features are
// a specialization constant, and so are mode and pass of what is transparent.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_gpu_vk_light.h"
#include "hdrp_oit.h"
#include "hdrp_shadow.h"

layout(constant_id = 0) const uint FEATURES = HDRP_BRDF_FEATURE_ALL;
#define HDRP_FEATURES      FEATURES
#define HDRP_WORD          HDRP_GPU_VK_WORD_ALL
#define HDRP_LIGHTING_SET  1
#define HDRP_SHADOW_ATLAS
#define HDRP_LIGHT_BLOCKERS
#include "shadow_map.glsl"
#include "light_blockers.glsl"
#include "light_loop.glsl"

#ifdef GBUFFER
#define HDRP_GBUFFER_TARGETS HDRP_PACK_GBUFFER_RT4
#include "gbuffer_output.glsl"
#elif defined(NORMALS)
#define HDRP_NORMAL_ONLY
#include "gbuffer_output.glsl"
#elif defined(TRANSPARENT)
layout(constant_id = 1) const uint MODE = HDRP_OIT_MODE_RECOMMENDED;
layout(constant_id = 2) const uint PASS = 0u;
#define HDRP_OIT_MODE    MODE
#define HDRP_OIT_PASS    PASS
#define HDRP_OIT_BINDING 12
#define HDRP_OIT_SET     1
#include "oit_output.glsl"
vec3 color = vec3(0.0);
#else
layout(location = 0) out vec4 lit;
vec3 color;
#endif

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

void main()
{
    hdrp_brdf_surface surface = hdrp_brdf_surface_default();
    hdrp_brdf_data d;
    surface.normal = normal;
    surface.features = FEATURES;
    d = hdrp_brdf_data_from_surface(surface);
#ifdef GBUFFER
    hdrp_pack_gbuffer_extra e;
    e.emissive = vec3(0.0);
    e.static_diffuse = vec3(0.0);
    e.specular_occlusion_data = vec2(0.0);
    e.light_layers = 255u;
    e.shadow_masks = vec4(1.0);
    hdrp_write_gbuffer(d, e);
#elif defined(NORMALS)
    hdrp_write_normal(d);
#else
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    vec3 offset = position - hdrp_v3_from_v4(lighting.camera.eye_near);
    float z_view = dot(offset, hdrp_v3_from_v4(lighting.camera.forward_orthographic));
    uint tile = hdrp_cull_tile_of_pixel(lighting.grid, pixel.x, pixel.y);
#ifdef TRANSPARENT
    if (hdrp_oit_writes_color())
#endif
    {
        hdrp_lit_surface r = hdrp_light_surface(d, offset, pixel, tile, z_view, 255u, 1.0);
        color = (r.diffuse + r.specular) * lighting.scales.x;
    }
#ifdef TRANSPARENT
    hdrp_oit_write(hdrp_oit_fragment_make(color * 0.5, vec3(0.0), 0.5, z_view));
#else
    lit = vec4(color, 1.0);
#endif
#endif
}
