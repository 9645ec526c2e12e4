// The pass of colour: what a surface sends to the viewer, which is emission where it covers nothing.
// Light is times the exposure, as in the picture behind it.
#extension GL_GOOGLE_include_directive : require
#include "forward.glsl"
#include "oit.glsl"

void main()
{
    Surface s = surface_at(draw.mesh, triangle, oit_ray());
    uvec2 pixel = uvec2(clamp(oit_place(), vec2(0.0), frame.jitter_size.zw - 1.0));
    hdrp_lit_surface lit = lit_surface_at(s, engine_data(s), pixel);
    vec3 light = (lit.diffuse + lit.specular + emission_nits(s)) * frame.depths_exposure.z;
    hdrp_oit_write(hdrp_oit_fragment_make(light * s.alpha, vec3(0.0), s.coverage, oit_z_view()));
}
