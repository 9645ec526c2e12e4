#version 450
// Casters of a shadow map; for materials with holes, where on the triangle a pixel is.
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#include "hdrp_shadow.h"

layout(std430, set = 2, binding = 10) readonly buffer Views { hdrp_shadow_view views[]; };

layout(location = 0) flat out uint triangle_out;
layout(location = 1) out vec3 weight_out;

void main()
{
    uint triangle = uint(gl_VertexIndex) / 3u;
    uint corner = uint(gl_VertexIndex) % 3u;
    Mesh m = meshes[draw.mesh];
    hdrp_shadow_view v = views[draw.view];
    vec4 p = vec4(fetch3(m.data.y, indices[m.data.x + 3u * triangle + corner]), 1.0);
    triangle_out = triangle;
    weight_out = vec3(corner == 0u, corner == 1u, corner == 2u);
    gl_Position = vec4(dot(v.clip_x, p), dot(v.clip_y, p), dot(v.clip_z, p), dot(v.clip_w, p));
}
