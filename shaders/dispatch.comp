#version 450
// The tiles of each variant in increasing order, and the arguments that dispatch them, as
// hdrp_cull_build_dispatch writes them. A group for each variant, which looks at all tiles twice;
// one more counts those that have none.
// header: hdrp_gpu_vk_light.h
#extension GL_GOOGLE_include_directive : require
#include "hdrp_cull_variant.h"

#define THREADS 256u
#define WORDS   8u /* of a bit for each thread */

layout(local_size_x = 256) in;
layout(std430, binding = 0) readonly buffer Chosen { uint chosen[]; };
layout(std430, binding = 1) writeonly buffer List { uint list[]; };
layout(std430, binding = 2) writeonly buffer Arguments { uvec4 arguments[]; };
// x variants, y columns, z tiles, w groups side by side at most
layout(push_constant) uniform Push { uvec4 push; };

shared uint before; // tiles of earlier variants; of no variant: without features
shared uint own;    // tiles of this one; of no variant: not covered
shared uint bits[WORDS];

// Counts for this group.
void count_tiles(uint variant)
{
    uint lower = 0u, equal = 0u;
    for (uint t = gl_LocalInvocationID.x; t < push.z; t += THREADS) {
        uint c = chosen[t];
        if (variant < push.x) {
            lower += c < variant ? 1u : 0u;
            equal += c == variant ? 1u : 0u;
        } else {
            lower += c == HDRP_CULL_VARIANT_EMPTY ? 1u : 0u;
            equal += c != HDRP_CULL_VARIANT_EMPTY && c >= push.x ? 1u : 0u;
        }
    }
    atomicAdd(before, lower);
    atomicAdd(own, equal);
}

// Writes the tiles of the variant, each behind those of lower index.
void list_tiles(uint variant, uint first)
{
    uint thread = gl_LocalInvocationID.x;
    for (uint begin = 0u; begin < push.z; begin += THREADS) {
        uint t = begin + thread;
        bool is_own = t < push.z && chosen[min(t, push.z - 1u)] == variant;
        uint place = first;
        if (thread < WORDS) {
            bits[thread] = 0u;
        }
        barrier();
        if (is_own) {
            atomicOr(bits[thread >> 5], 1u << (thread & 31u));
        }
        barrier();
        for (uint w = 0u; w < WORDS; ++w) {
            uint lower = w < (thread >> 5) ? 0xffffffffu : (1u << (thread & 31u)) - 1u;
            place += uint(bitCount(bits[w] & (w > (thread >> 5) ? 0u : lower)));
            first += uint(bitCount(bits[w]));
        }
        if (is_own) {
            list[place] = hdrp_cull_tile_id(t % push.y, t / push.y);
        }
        barrier();
    }
}

void main()
{
    uint variant = gl_WorkGroupID.x;
    if (gl_LocalInvocationID.x == 0u) {
        before = 0u;
        own = 0u;
    }
    barrier();
    count_tiles(variant);
    barrier();
    if (variant == push.x) {
        if (gl_LocalInvocationID.x == 0u) {
            arguments[HDRP_CULL_VARIANT_MAX] = uvec4(push.z - before - own, before, own, 0u);
        }
        return;
    }
    if (gl_LocalInvocationID.x == 0u) {
        // Groups in rows, of which the last may have some too many.
        arguments[variant] = uvec4(min(own, push.w), max((own + push.w - 1u) / push.w, 1u), 1u,
                                   before);
    }
    list_tiles(variant, before);
}
