#version 450
// Spherical harmonics of the irradiance: what hdrp_env_project_sh does. One group; each of its
// threads sums every so many texels of a level.
// header: hdrp_gpu_vk_env.h
#extension GL_GOOGLE_include_directive : require

#define THREADS 128

layout(local_size_x = THREADS) in;
layout(std430, binding = 0) readonly buffer Radiance { vec4 radiance[]; };
layout(std430, binding = 1) readonly buffer Nodes { vec4 nodes[]; };
layout(std430, binding = 2) writeonly buffer Harmonics { vec4 harmonics[9]; };
layout(push_constant) uniform Push { uvec4 push; }; // x size of the radiance cube, y level

#define ENV_NODES
#include "env_texels.glsl"

shared vec4 sums[9][THREADS];

// One of the products of the normal that hdrp_env_sh multiplies.
float product(uint k, vec3 d)
{
    float p = k < 4u ? (k == 0u ? 1.0 : d[k - 1u]) : 0.0;
    p = k == 4u ? d.x * d.y : p;
    p = k == 5u ? d.y * d.z : p;
    p = k == 6u ? d.x * d.z : p;
    p = k == 7u ? 3.0 * d.z * d.z - 1.0 : p;
    return k == 8u ? d.x * d.x - d.y * d.y : p;
}

void main()
{
    // As in hdrp_env_project_sh.
    const float scale[9] = float[](3.14159265, 6.28318531, 6.28318531, 6.28318531, 11.7809725,
                                   11.7809725, 11.7809725, 0.981747704, 2.94524311);
    uint size = push.x, level = push.y, n = size >> level;
    uint thread = gl_LocalInvocationID.x;
    vec4 sum[9];
    for (uint k = 0u; k < 9u; ++k) {
        sum[k] = vec4(0.0);
    }
    for (uint i = thread; i < 6u * n * n; i += uint(THREADS)) {
        uint face = i / (n * n), y = i / n % n, x = i % n;
        uint index = env_level_offset(size, n) + i;
        vec4 texel = radiance[index];
        hdrp_env_node node = env_node(size, level, index, face, x, y, texel);
        vec3 flux = texel.xyz * texel.w;
        for (uint k = 0u; k < 9u; ++k) {
            sum[k] += vec4(flux.x * product(k, node.light.mean + node.red),
                           flux.y * product(k, node.light.mean + node.green),
                           flux.z * product(k, node.light.mean + node.blue), texel.w);
        }
    }
    for (uint k = 0u; k < 9u; ++k) {
        sums[k][thread] = sum[k];
    }
    for (uint half_way = THREADS / 2; half_way > 0u; half_way >>= 1) {
        barrier();
        if (thread < half_way) {
            for (uint k = 0u; k < 9u; ++k) {
                sums[k][thread] += sums[k][thread + half_way];
            }
        }
    }
    barrier();
    if (thread < 9u) {
        vec4 total = sums[thread][0];
        harmonics[thread] = vec4(total.xyz * (scale[thread] / total.w), 0.0);
    }
}
