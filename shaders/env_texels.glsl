// What the passes of the environment share: the cube of radiance with its levels, as hdrp_env_cube
// lays it out, and what its texels are as parts of the sky, seven vectors for each above level 0.
#include "hdrp_env.h"

// Texels before a level, of which n is the size: 6 (size^2 + (size/2)^2 + ... + (2 n)^2).
uint env_level_offset(uint size, uint n)
{
    return 8u * (size * size - n * n);
}

uint env_index(uint size, uint level, uint face, uint x, uint y)
{
    uint n = size >> level;
    return env_level_offset(size, n) + (face * n + y) * n + x;
}

#ifdef ENV_NODES
// Texels of the levels above 0 begin at the first of the nodes.
uint env_node_offset(uint size, uint index)
{
    return 7u * (index - 6u * size * size);
}

hdrp_env_node env_load(uint at)
{
    hdrp_env_node n;
    n.light.mean = nodes[at].xyz;
    n.light.xx = nodes[at].w;
    n.light.yy = nodes[at + 1u].x;
    n.light.zz = nodes[at + 1u].y;
    n.light.xy = nodes[at + 1u].z;
    n.light.yz = nodes[at + 1u].w;
    n.light.xz = nodes[at + 2u].x;
    n.area.mean = nodes[at + 2u].yzw;
    n.area.xx = nodes[at + 3u].x;
    n.area.yy = nodes[at + 3u].y;
    n.area.zz = nodes[at + 3u].z;
    n.area.xy = nodes[at + 3u].w;
    n.area.yz = nodes[at + 4u].x;
    n.area.xz = nodes[at + 4u].y;
    n.red = vec3(nodes[at + 4u].zw, nodes[at + 5u].x);
    n.green = nodes[at + 5u].yzw;
    n.blue = nodes[at + 6u].xyz;
    return n;
}

hdrp_env_node env_node(uint size, uint level, uint index, uint face, uint x, uint y, vec4 texel)
{
    hdrp_env_node n;
    if (level == 0u) {
        n = hdrp_i_env_leaf(face, x, y, size, texel.w);
    } else {
        n = env_load(env_node_offset(size, index));
    }
    return n;
}
#endif
