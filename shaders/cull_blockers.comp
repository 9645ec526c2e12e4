#version 450
// Lights leave the cells that their blockers keep dark: hdrp_cull_apply_blockers. A thread has one.
// header: hdrp_gpu_vk_cull.h
// contraction: none
// inline: none
#extension GL_GOOGLE_include_directive : require
#define PROJECTS
#define FRAME_ACCESS readonly
#define SHAPE_ACCESS readonly
#define NO_SHAPES
#include "cull_lists.glsl"
#include "hdrp_cull_blocker.h"

layout(std430, binding = 1) readonly buffer Places { vec4 places[]; };
layout(std430, binding = 2) readonly buffer Blockers { hdrp_cull_blocker blockers[]; };
layout(std430, binding = 3) readonly buffer LightLinks { uvec2 light_links[]; };
layout(std430, binding = 4) readonly buffer Links { uint links[]; };
layout(std430, binding = 5) readonly buffer Tiles { vec4 tiles[]; };
layout(std430, binding = 6) buffer Cells { uvec4 cells[]; };
layout(std430, binding = 7) buffer Entries { uint entries[]; };
layout(std430, binding = 8) buffer Masks { uint masks[]; };
layout(std430, binding = 9) writeonly buffer BlockerMasks { uint blocker_masks[]; };
layout(push_constant) uniform Push { uvec4 numbers; }; // x lights that have blockers

// All that shadows in a cell depend on.
struct Cell
{
    hdrp_cull_tile tile;
    hdrp_cull_interval of_tile, own; // depths
};

hdrp_cull_shadow shadow_of(Cell cell, uint blocker, hdrp_v4 light)
{
    return hdrp_cull_shadow_make(hdrp_cull_blocker_in_view(blockers[blocker], frame.camera), light,
                                 cell.tile, cell.of_tile, frame.camera.forward_orthographic.w);
}

// The class of a blocker with its portals; shadows are made where they are first asked for.
uint class_of(Cell cell, uint blocker, hdrp_v4 light)
{
    uint first = blockers[blocker].bits.y;
    uint portals = blockers[blocker].bits.z;
    uint own = HDRP_CULL_SHADOW_NONE;
    uint most = HDRP_CULL_SHADOW_NONE;
    // The blocker first, then its portals: one text, for it is long.
    for (uint i = 0u; i <= portals && most != HDRP_CULL_SHADOW_WHOLE; ++i) {
        uint index = i == 0u ? blocker : first + i - 1u;
        uint c = hdrp_cull_shadow_class(shadow_of(cell, index, light), cell.own);
        if (i == 0u && c == HDRP_CULL_SHADOW_NONE) {
            return c;
        }
        own = i == 0u ? c : own;
        most = i > 0u && c != HDRP_CULL_SHADOW_NONE ? c : most;
    }
    return hdrp_cull_shadow_through(own, most);
}

// Whether a light stays in a cell; mask has a bit for each blocker that pixels have to test.
bool stays(Cell cell, uint light, out uint mask)
{
    mask = 0u;
    if (light >= numbers.x) {
        return true;
    }
    uvec2 own = light_links[light];
    hdrp_v4 place = hdrp_cull_light_place_in_view(places[light], frame.camera);
    for (uint k = 0u; k < own.y; ++k) {
        uint c = class_of(cell, links[own.x + k], place);
        if (c == HDRP_CULL_SHADOW_WHOLE) {
            mask = 0u;
            return false;
        }
        mask |= c == HDRP_CULL_SHADOW_PIXEL ? 1u << k : 0u;
    }
    return true;
}

void move_entry(uint from, uint to, uint mask)
{
    uint words = (frame.picture.z & FLAG_MASKS) != 0u ? hdrp_cull_mask_words(frame.grid) : 0u;
    entries[to] = entries[from];
    blocker_masks[to] = mask;
    for (uint k = 0u; k < words; ++k) {
        masks[to * words + k] = masks[from * words + k];
    }
}

void main()
{
    frame = frame_in_memory;
    uint at = thread_index();
    uint slices = frame.grid.cells.x;
    uint index = at / slices;
    if (index >= frame.grid.tiles.z * frame.grid.tiles.w) {
        return;
    }
    uvec4 cell = cells[at];
    if ((cell.y | cell.z) == 0u) {
        return;
    }
    uvec2 tile = uvec2(index % frame.grid.tiles.z, index / frame.grid.tiles.z);
    uvec2 begin = tile * frame.grid.tiles.xy;
    uvec2 end = min(begin + frame.grid.tiles.xy, frame.picture.xy);
    Cell c;
    c.tile = hdrp_cull_tile_make(frame.camera, float(begin.x), float(begin.y), float(end.x),
                                 float(end.y), float(frame.picture.x), float(frame.picture.y));
    float near_m = frame.pixel.z;
    float far_m = frame.pixel.w;
    c.own = hdrp_cull_slice_depths(frame.grid, tiles[index], at % slices, near_m, far_m);
    c.of_tile = hdrp_cull_slice_depths(frame.grid, tiles[index], 0u, near_m, far_m);
    c.of_tile.farthest =
        hdrp_cull_slice_depths(frame.grid, tiles[index], slices - 1u, near_m, far_m).farthest;
    uint counts[HDRP_CULL_CATEGORY_COUNT];
    uint n = cell.x;
    uint i = cell.x;
    for (uint category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        uint first = n;
        for (uint last = hdrp_cull_last(cell, category); i < last; ++i) {
            uint mask;
            if (stays(c, hdrp_cull_entry_index(entries[i]), mask)) {
                move_entry(i, n++, mask);
            }
        }
        counts[category] = n - first;
    }
    cells[at] = uvec4(cell.x, counts[0] | counts[1] << 16, counts[2] | counts[3] << 16, cell.w);
}
