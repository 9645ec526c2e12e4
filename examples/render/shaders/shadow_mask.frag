#version 450
// Casters with holes.
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#include "surface.glsl"
#include "mask.glsl"

layout(location = 0) flat in uint triangle;
layout(location = 1) in vec3 weight_in;

void main()
{
    set_triangle(draw.mesh, triangle);
    weight = weight_in;
    if (is_hole()) {
        discard;
    }
}
