// What a fragment shader writes into the GBuffer, or into the normal buffer alone: the forward
// prepass of materials that no GBuffer holds. Before the line that includes it, a shader has
//
//     #extension GL_GOOGLE_include_directive : require
//     #include "hdrp_pack.h"
//
// and may define HDRP_GBUFFER_TARGETS, HDRP_PACK_GBUFFER_RT4 | _RT5 of those that exist; 0.
// Locations are the numbers of the targets, in the formats that hdrp_pack.h says; the normal
// buffer is RT1, at location HDRP_NORMAL_LOCATION, 1.
//
//     hdrp_write_gbuffer(hdrp_brdf_data_from_surface(surface), extra);
//
// With HDRP_NORMAL_ONLY defined before, only hdrp_write_normal is declared, and RT1.

#ifndef HDRP_GBUFFER_TARGETS
#define HDRP_GBUFFER_TARGETS 0u
#endif
#ifndef HDRP_NORMAL_LOCATION
#define HDRP_NORMAL_LOCATION 1
#endif

layout(location = HDRP_NORMAL_LOCATION) out vec4 hdrp_rt1;

void hdrp_write_normal(hdrp_brdf_data d)
{
    hdrp_rt1 = hdrp_pack_normal_buffer_encode(d.normal, d.perceptual_roughness);
}

#ifndef HDRP_NORMAL_ONLY
layout(location = 0) out vec4 hdrp_rt0;
layout(location = 2) out vec4 hdrp_rt2;
layout(location = 3) out vec3 hdrp_rt3;
layout(location = 4) out vec4 hdrp_rt4; // without a target what is written goes nowhere
layout(location = 5) out vec4 hdrp_rt5;

// e.targets is set here. Emission and baked light are exposed, as hdrp_pack_gbuffer_extra says.
void hdrp_write_gbuffer(hdrp_brdf_data d, hdrp_pack_gbuffer_extra e)
{
    hdrp_pack_gbuffer g;
    e.targets = HDRP_GBUFFER_TARGETS;
    g = hdrp_pack_gbuffer_encode(d, e);
    hdrp_rt0 = g.rt0;
    hdrp_rt1 = g.rt1;
    hdrp_rt2 = g.rt2;
    hdrp_rt3 = g.rt3;
    hdrp_rt4 = g.rt4;
    hdrp_rt5 = g.rt5;
}
#endif
