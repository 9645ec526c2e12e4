#version 450
// A level of the radiance cube and its nodes from the level below: what hdrp_env_reduce does. A
// thread makes a texel.
// header: hdrp_gpu_vk_env.h
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Radiance { vec4 radiance[]; };
layout(std430, binding = 1) buffer Nodes { vec4 nodes[]; };
layout(push_constant) uniform Push { uvec4 push; }; // x size of the cube, y level, z groups in a row

#define ENV_NODES
#include "env_texels.glsl"

void store(uint at, hdrp_env_node n)
{
    nodes[at] = vec4(n.light.mean, n.light.xx);
    nodes[at + 1u] = vec4(n.light.yy, n.light.zz, n.light.xy, n.light.yz);
    nodes[at + 2u] = vec4(n.light.xz, n.area.mean);
    nodes[at + 3u] = vec4(n.area.xx, n.area.yy, n.area.zz, n.area.xy);
    nodes[at + 4u] = vec4(n.area.yz, n.area.xz, n.red.x, n.red.y);
    nodes[at + 5u] = vec4(n.red.z, n.green);
    nodes[at + 6u] = vec4(n.blue, 0.0);
}

void main()
{
    uint size = push.x, level = push.y, n = size >> level;
    uint i = (gl_WorkGroupID.y * push.z + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
    if (i >= 6u * n * n) {
        return;
    }
    uint face = i / (n * n), y = i / n % n, x = i % n;
    hdrp_env_node child[4];
    vec4 texel[4];
    float solid_angle = 0.0, light = 0.0;
    vec3 mean = vec3(0.0);
    for (uint k = 0u; k < 4u; ++k) {
        uint cx = 2u * x + k % 2u, cy = 2u * y + k / 2u;
        uint at = env_index(size, level - 1u, face, cx, cy);
        texel[k] = radiance[at];
        child[k] = env_node(size, level - 1u, at, face, cx, cy, texel[k]);
        solid_angle += texel[k].w;
    }
    for (uint k = 0u; k < 4u; ++k) {
        float by_area = texel[k].w / solid_angle;
        mean = hdrp_v3_mad(mean, texel[k].xyz, by_area);
        light += by_area * hdrp_i_env_light_of(texel[k]);
    }
    hdrp_env_node sum = hdrp_i_env_node_make(hdrp_i_env_spread_splat(0.0));
    for (uint k = 0u; k < 4u; ++k) {
        sum = hdrp_i_env_add_means(sum, child[k],
                                   hdrp_i_env_share_make(texel[k], solid_angle, light, mean));
    }
    for (uint k = 0u; k < 4u; ++k) {
        sum = hdrp_i_env_add_rest(sum, child[k],
                                  hdrp_i_env_share_make(texel[k], solid_angle, light, mean));
    }
    uint index = env_index(size, level, face, x, y);
    radiance[index] = vec4(mean, solid_angle);
    store(env_node_offset(size, index), sum);
}
