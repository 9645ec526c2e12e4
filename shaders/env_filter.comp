#version 450
// Faces of a level of a cube filtered by a lobe: what hdrp_env_prefilter and
// hdrp_env_convolve_irradiance do. A thread makes a texel.
// header: hdrp_gpu_vk_env.h
#extension GL_GOOGLE_include_directive : require

#define SIDE 8

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0) uniform writeonly image2DArray result; // a level
layout(std430, binding = 1) readonly buffer Radiance { vec4 radiance[]; };
layout(std430, binding = 2) readonly buffer Nodes { vec4 nodes[]; };
layout(push_constant) uniform Push
{
    uvec4 cubes; // x size of the radiance cube, y its levels, z size of the result
    uvec4 faces; // x first, y groups from one to the next, z 1: a mirror, which filters nothing
    vec4 lobe;   // x alpha, y opening, z factor of the result, w largest value of the format
};

#define ENV_NODES
#include "env_texels.glsl"

// Mean radiance under a lobe, by the walk of hdrp_i_env_gather. The faces are trees of four branches
// whose nodes say where they are: what comes next needs no stack.
vec3 gather(hdrp_i_env_lobe about)
{
    uint size = cubes.x, top = cubes.y - 1u;
    uint level = top, face = 0u, x = 0u, y = 0u;
    vec4 sum = vec4(0.0), sums = vec4(0.0);
    while (face < 6u) {
        uint index = env_index(size, level, face, x, y);
        vec4 texel = radiance[index];
        vec3 middle = level == 0u ? hdrp_i_env_texel_centre(face, x, y, size)
                                  : nodes[env_node_offset(size, index) + 2u].yzw;
        vec3 d = middle - about.axis;
        float q = hdrp_v3_dot(d, d);
        if (hdrp_i_env_is_hidden(q, texel.w) == 0u) {
            if (level > 0u && hdrp_i_env_is_far(about, q, texel.w) == 0u) {
                level -= 1u;
                x *= 2u;
                y *= 2u;
                continue;
            }
            sum += hdrp_i_env_part_of(
                about, env_node(size, level, index, face, x, y, texel), texel, level);
        }
        while (level < top && (x & y & 1u) != 0u) {
            x >>= 1;
            y >>= 1;
            level += 1u;
            sums += sum; // in parts: sums of thousands of floats lose digits
            sum = vec4(0.0);
        }
        if (level == top) {
            face += 1u;
        } else {
            y += x & 1u;
            x ^= 1u;
        }
    }
    sums += sum;
    return sums.xyz / sums.w;
}

// The nearest value that a half holds, where those are normal: devices may store another neighbour.
float half_of(float v)
{
    uint u = hdrp_bits_from_f32(v);
    u = (u + 0xfffu + (u >> 13 & 1u)) & ~0x1fffu;
    return v < 6.103515625e-05 ? v : hdrp_f32_from_bits(u);
}

void main()
{
    uint n = cubes.z;
    uint face = faces.x + gl_WorkGroupID.y / faces.y;
    uint x = gl_GlobalInvocationID.x;
    uint y = gl_WorkGroupID.y % faces.y * uint(SIDE) + gl_LocalInvocationID.y;
    if (x >= n || y >= n) {
        return;
    }
    vec3 mean;
    if (faces.z != 0u) { // the level of the radiance cube that has the size
        mean = radiance[env_level_offset(cubes.x, n) + (face * n + y) * n + x].xyz;
    } else {
        hdrp_i_env_lobe about = hdrp_i_env_lobe_make(lobe.x, lobe.y);
        about.axis = hdrp_i_env_texel_centre(face, x, y, n);
        mean = gather(about);
    }
    mean = min(mean * lobe.z, vec3(lobe.w));
    if (lobe.w == 65504.0) {
        mean = vec3(half_of(mean.x), half_of(mean.y), half_of(mean.z));
    }
    imageStore(result, ivec3(x, y, face), vec4(mean, 1.0));
}
