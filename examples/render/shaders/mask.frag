#version 450
// The depth prepass of materials with holes.
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#include "surface.glsl"
#include "mask.glsl"

layout(location = 0) flat in uint triangle;

void main()
{
    set_patch(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    if (is_hole()) {
        discard;
    }
}
