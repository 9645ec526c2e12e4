#version 450
// Transparent surfaces, from back to front: what they send to the viewer, and what they let through.
#extension GL_GOOGLE_include_directive : require
#include "forward.glsl"

layout(location = 0, index = 0) out vec4 color;
layout(location = 0, index = 1) out vec4 through;

void main()
{
    Surface s = surface_at(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    hdrp_lit_surface lit = lit_surface(s, engine_data(s));
    vec3 light = (lit.diffuse + lit.specular + emission_nits(s)) * frame.depths_exposure.z;
    color = vec4(light * s.alpha, s.coverage);
    through = vec4(vec3(1.0 - s.coverage) + lit.transmitted_weight * s.coverage, 1.0 - s.coverage);
}
