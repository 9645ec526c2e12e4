#version 450
// Opaque surfaces that no layout of the GBuffer holds.
#extension GL_GOOGLE_include_directive : require
#include "forward.glsl"

layout(set = 2, binding = 15) uniform utexture2D kinds;
layout(location = 0) out vec4 color;

#define PIXEL_FORWARD 2u

void main()
{
    Surface s;
    hdrp_lit_surface lit;
    if (texelFetch(kinds, ivec2(gl_FragCoord.xy), 0).x != PIXEL_FORWARD) {
        discard;
    }
    s = surface_at(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    lit = lit_surface(s, engine_data(s));
    color = vec4((lit.diffuse + lit.specular + emission_nits(s)) * frame.depths_exposure.z, 1.0);
}
