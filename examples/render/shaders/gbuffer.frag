#version 450
// The GBuffer of what it can hold; of other materials the normal buffer alone.
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#include "hdrp_pack.h"
#include "surface.glsl"
#include "engine.glsl"

layout(location = 0) flat in uint triangle;
layout(location = 0) out vec4 rt0;
layout(location = 1) out vec4 rt1;
layout(location = 2) out vec4 rt2;
layout(location = 3) out vec3 rt3;
layout(location = 4) out vec4 rt4;
layout(location = 5) out uint kind; // RD_PIXEL_...
layout(location = 6) out vec4 geometric_normal;

#define PIXEL_DEFERRED 1u
#define PIXEL_FORWARD  2u

void main()
{
    Surface s = surface_at(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    hdrp_brdf_data data = engine_data(s);
    hdrp_pack_gbuffer_extra e;
    hdrp_pack_gbuffer g;
    bool deferred = frame.bits.w == 0u && !is_unlit() && hdrp_pack_gbuffer_supports(data) != 0u;
    e.emissive = s.emission_nits * frame.depths_exposure.z;
    e.static_diffuse = vec3(0.0);
    e.specular_occlusion_data = vec2(0.0);
    e.light_layers = s.light_layers;
    e.shadow_masks = vec4(1.0);
    e.targets = HDRP_PACK_GBUFFER_RT4;
    g = hdrp_pack_gbuffer_encode(data, e);
    geometric_normal = vec4(s.geometric_normal, 0.0);
    kind = deferred ? PIXEL_DEFERRED : PIXEL_FORWARD;
    rt0 = deferred ? g.rt0 : vec4(0.0);
    if (IS_COARSE) { // so are its conversions from and to sRGB: the target keeps what codes stand for
        rt0 = hdrp_pack_linear_from_srgba8(hdrp_pack_srgba8_from_linear(rt0));
    }
    rt1 = deferred ? g.rt1 : hdrp_pack_normal_buffer_encode(data.normal, data.perceptual_roughness);
    rt2 = deferred ? g.rt2 : vec4(0.0);
    rt3 = deferred ? g.rt3 : vec3(0.0);
    rt4 = deferred ? g.rt4 : vec4(0.0);
}
