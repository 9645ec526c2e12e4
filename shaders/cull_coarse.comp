#version 450
// The shapes that reach each block of tiles, by category and index. Where tiles have no slices,
// what reaches nothing that they show is left out: many small tiles share what is left.
// header: hdrp_gpu_vk_cull.h
// contraction: none
#extension GL_GOOGLE_include_directive : require
#define FRAME_ACCESS readonly
#define SHAPE_ACCESS readonly
#include "cull_lists.glsl"

layout(std430, binding = 4) writeonly buffer Coarse { uint coarse[]; };
layout(std430, binding = 5) readonly buffer Tiles { vec4 tiles[]; };

shared uint nearest_bits;
shared uint farthest_bits;

// The depths that some tiles show, widened tile by tile.
void measure(uvec2 first, uvec2 count)
{
    if (gl_LocalInvocationIndex == 0u) {
        nearest_bits = hdrp_bits_from_f32(HDRP_FLT_MAX);
        farthest_bits = 0u;
    }
    wait_for_group();
    for (uint k = gl_LocalInvocationIndex; k < count.x * count.y; k += GROUP) {
        uvec2 at = first + uvec2(k % count.x, k / count.x);
        if (at.x < frame.grid.tiles.z && at.y < frame.grid.tiles.w) {
            vec4 tile = tiles[at.y * frame.grid.tiles.z + at.x];
            if (tile.x <= tile.y) {
                atomicMin(nearest_bits, hdrp_bits_from_f32(tile.x));
                atomicMax(farthest_bits, hdrp_bits_from_f32(tile.y));
            }
        }
    }
    wait_for_group();
}

void main()
{
    frame = frame_in_memory;
    uvec2 first = gl_WorkGroupID.xy * frame.numbers.zw; // tile
    uvec2 begin = first * frame.grid.tiles.xy;
    uvec2 end = begin + frame.numbers.zw * frame.grid.tiles.xy;
    bool pruned = frame.grid.cells.x == 1u;
    uint cell = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint base = cell * (1u + frame.numbers.y);
    uint n = 0u;
    measure(first, frame.numbers.zw);
    Window w = window_of(begin, end, hdrp_f32_from_bits(nearest_bits),
                         hdrp_f32_from_bits(farthest_bits));
    for (uint category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        for (uint from = 0u; (frame.found.x >> category & 1u) != 0u && from < frame.numbers.x;
             from += GROUP) {
            uint i = from + gl_LocalInvocationIndex;
            bool found = false;
            if (i < frame.numbers.x) {
                Seen s = seen_shapes[i];
                found = category_of(s) == category &&
                        hdrp_cull_bounds_in_cell(hdrp_cull_bounds(s.rect_px, s.nearest, s.farthest),
                                                 vec4(begin, end)) != 0u;
                if (found && pruned) {
                    hdrp_cull_interval r = depths_in(w, i, s, false);
                    found = r.nearest <= r.farthest;
                }
            }
            uint total;
            uint at = place_among(found, total);
            if (found) {
                coarse[base + 1u + n + at] = i;
            }
            n += total;
        }
    }
    if (gl_LocalInvocationIndex == 0u) {
        coarse[base] = n;
    }
}
