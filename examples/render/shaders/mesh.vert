#version 450
// Triangles, their corners pulled from the buffers of the scene.
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"

layout(location = 0) flat out uint triangle_out;
invariant gl_Position; // the GBuffer is drawn where the depth is equal to that of the prepass

// Reverse depth, without a far plane where there is perspective.
vec4 project(vec3 position)
{
    vec3 d = position - frame.eye_step.xyz;
    float z = dot(d, frame.forward_orthographic.xyz);
    vec2 at = vec2(dot(d, frame.right_half_width.xyz) / frame.right_half_width.w,
                   -dot(d, frame.up_half_height.xyz) / frame.up_half_height.w);
    // The sample of each pixel moves to its centre.
    vec2 shift = 2.0 * (0.5 - frame.jitter_size.xy) / frame.jitter_size.zw;
    if (is_orthographic()) {
        float near = frame.depths_exposure.x, far = frame.depths_exposure.y;
        return vec4(at + shift, (far - z) / (far - near), 1.0);
    }
    return vec4(at + shift * z, frame.depths_exposure.x, z);
}

// Back faces of single-sided materials are not there: decided as the CPU does, without a pipeline
// for each kind.
bool is_hidden(Mesh m, vec3 a, vec3 b, vec3 c)
{
    vec3 view = is_orthographic() ? -frame.forward_orthographic.xyz : frame.eye_step.xyz - a;
    return (materials[m.more.z].bits.y & RD_GPU_DOUBLE_SIDED) == 0u &&
           dot(cross(b - a, c - a), view) < 0.0;
}

void main()
{
    uint id = uint(gl_VertexIndex) / 3u;
    uint corner = uint(gl_VertexIndex) % 3u;
    uint triangle = draw.ordered != 0u ? order[id] : id;
    Mesh m = meshes[draw.mesh];
    uint first = m.data.x + 3u * triangle;
    vec3 p[3];
    for (int i = 0; i < 3; ++i) {
        p[i] = fetch3(m.data.y, indices[first + uint(i)]);
    }
    triangle_out = triangle;
    gl_Position = is_hidden(m, p[0], p[1], p[2]) ? vec4(0.0, 0.0, -1.0, 1.0) : project(p[corner]);
}
