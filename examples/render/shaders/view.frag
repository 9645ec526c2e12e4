#version 450
// One quantity of the surfaces: view.c.
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#include "hdrp_pack.h"
#include "surface.glsl"
#include "engine.glsl"

layout(location = 0) flat in uint triangle;
layout(location = 0) out vec4 color; // premultiplied

vec3 index_color(uint i)
{
    float h = hdrp_unit_from_u32(hdrp_hash1(i)) * 6.0;
    return hdrp_v3_saturate(vec3(abs(h - 3.0) - 1.0, 2.0 - abs(h - 2.0), 2.0 - abs(h - 4.0)));
}

vec3 feature_color(uint f)
{
    vec3 c = vec3(0.15);
    c += (f & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u ? vec3(0.8, 0.1, 0.1) : vec3(0.0);
    c += (f & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u ? vec3(0.1, 0.7, 0.1) : vec3(0.0);
    c += (f & HDRP_BRDF_FEATURE_IRIDESCENCE) != 0u ? vec3(0.1, 0.2, 0.8) : vec3(0.0);
    c += (f & HDRP_BRDF_FEATURE_REFRACTION) != 0u ? vec3(0.0, 0.6, 0.6) : vec3(0.0);
    c += (f & HDRP_BRDF_FEATURE_SUBSURFACE) != 0u ? vec3(0.6, 0.4, 0.0) : vec3(0.0);
    c += (f & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u ? vec3(0.5, 0.0, 0.5) : vec3(0.0);
    return hdrp_v3_saturate(c);
}

vec3 value_of(Surface s)
{
    hdrp_brdf_surface b = s.brdf;
    switch (frame.bits.z) {
    case RD_GPU_VIEW_BASE_COLOR: return b.base_color;
    case RD_GPU_VIEW_NORMAL: return b.normal;
    case RD_GPU_VIEW_GEOMETRIC_NORMAL: return s.geometric_normal;
    case RD_GPU_VIEW_VERTEX_NORMAL: return s.vertex_normal;
    case RD_GPU_VIEW_TANGENT: return hdrp_normalize_or(b.tangent, vec3(0.0));
    case RD_GPU_VIEW_UV: return vec3(s.uv - floor(s.uv), 0.0);
    case RD_GPU_VIEW_ROUGHNESS: return vec3(b.perceptual_roughness);
    case RD_GPU_VIEW_METALLIC: return vec3(b.metallic);
    case RD_GPU_VIEW_F0: return hdrp_brdf_fresnel0(b.base_color, b.metallic, b.dielectric_fresnel0);
    case RD_GPU_VIEW_DEPTH:
        return vec3(dot(s.position - frame.eye_step.xyz, frame.forward_orthographic.xyz));
    case RD_GPU_VIEW_FEATURES: return feature_color(b.features);
    case RD_GPU_VIEW_MATERIAL: return index_color(MATERIAL.details.y);
    case RD_GPU_VIEW_ALPHA: return vec3(s.alpha);
    case RD_GPU_VIEW_EMISSION: return s.emission_nits;
    case RD_GPU_VIEW_OCCLUSION: return vec3(b.ambient_occlusion);
    case RD_GPU_VIEW_COAT: return vec3(b.coat_mask, b.coat_perceptual_roughness, 0.0);
    case RD_GPU_VIEW_ANISOTROPY: return vec3(b.anisotropy);
    case RD_GPU_VIEW_FILM: return vec3(b.film_mask, b.film_thickness_nm / 1000.0, 0.0);
    case RD_GPU_VIEW_TRANSMISSION: return vec3(b.transmission, b.volume_thickness_m, 0.0);
    default: return vec3(0.0);
    }
}

// Of the GBuffer as memory holds it.
vec3 target_of(Surface s)
{
    hdrp_brdf_data data = engine_data(s);
    bool deferred = frame.bits.w == 0u && !is_unlit() && hdrp_pack_gbuffer_supports(data) != 0u;
    hdrp_pack_gbuffer_extra e;
    hdrp_pack_gbuffer g;
    vec4 normal = hdrp_pack_normal_buffer_encode(data.normal, data.perceptual_roughness);
    e.emissive = s.emission_nits * frame.depths_exposure.z;
    e.static_diffuse = vec3(0.0);
    e.specular_occlusion_data = vec2(0.0);
    e.light_layers = s.light_layers;
    e.shadow_masks = vec4(1.0);
    e.targets = HDRP_PACK_GBUFFER_RT4;
    g = hdrp_pack_gbuffer_targets_from_texel(
        hdrp_pack_gbuffer_texel_from_targets(hdrp_pack_gbuffer_encode(data, e)));
    normal = hdrp_pack_v4_from_rgba8(hdrp_pack_rgba8_from_v4(normal));
    switch (frame.bits.z) {
    case RD_GPU_VIEW_AO: return vec3(1.0);
    case RD_GPU_VIEW_PATH: return deferred ? vec3(0.1, 0.35, 0.7) : vec3(0.8, 0.25, 0.1);
    case RD_GPU_VIEW_RT0: return deferred ? g.rt0.xyz : vec3(0.0);
    case RD_GPU_VIEW_RT1: return deferred ? g.rt1.xyz : normal.xyz;
    case RD_GPU_VIEW_RT2: return deferred ? g.rt2.xyz : vec3(0.0);
    case RD_GPU_VIEW_RT3: return deferred ? g.rt3 : vec3(0.0);
    default: return deferred ? g.rt4.xyz : vec3(0.0);
    }
}

void main()
{
    Surface s = surface_at(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    vec3 v = frame.bits.z >= RD_GPU_VIEW_AO ? target_of(s) : value_of(s);
    float alpha = draw.ordered != 0u ? s.alpha : 1.0;
    color = vec4(v * alpha, alpha);
}
