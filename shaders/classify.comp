#version 450
// What each tile needs, and the first variant that has it: hdrp_cull_material_tiles,
// hdrp_cull_light_features, hdrp_cull_combine_features and hdrp_cull_assign_variants. A group makes
// a tile.
// contraction: none
// header: hdrp_gpu_vk_light.h
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_gpu_vk_light.h"
#include "group.glsl"

layout(std140, binding = 0) uniform HdrpLighting { hdrp_gpu_vk_lighting_params lighting; };
layout(std430, binding = 1) readonly buffer HdrpLights { hdrp_light lights[]; };
layout(std430, binding = 2) readonly buffer HdrpCells { uvec4 cells[]; };
layout(std430, binding = 3) readonly buffer HdrpEntries { uint entries[]; };
layout(std430, binding = 4) readonly buffer Variants { uint variants[]; };
layout(binding = 5) uniform texture2D depths;
layout(binding = 6) uniform utexture2D kinds;
layout(binding = 7) uniform texture2D rt2;
layout(std430, binding = 8) writeonly buffer Words { uint words[]; };
layout(std430, binding = 9) writeonly buffer Chosen { uint chosen[]; };
layout(push_constant) uniform Push { uvec4 push; }; // x number of variants

#include "lit_pixels.glsl"

shared uint materials;
shared uint listed;

// The union over the pixels of the tile that this thread looks at.
uint material_word(uvec2 begin, uvec2 end)
{
    uint split = lighting.lights.w & HDRP_GPU_VK_WORD_SPLIT;
    uint across = min(end.x - begin.x, GROUP);
    uint rows = GROUP / across;
    uvec2 own = uvec2(gl_LocalInvocationIndex % across, gl_LocalInvocationIndex / across);
    uint word = 0u;
    for (uint y = begin.y + own.y; own.y < rows && y < end.y; y += rows) {
        for (uint x = begin.x + own.x; x < end.x; x += across) {
            if (lit_depth(uvec2(x, y)) >= 0.0) {
                vec4 texel = texelFetch(rt2, ivec2(x, y), 0);
                word |= hdrp_gpu_vk_word_of_material(hdrp_pack_gbuffer_features(texel), split);
            }
        }
    }
    return word;
}

// The union over the entries of all lists of the tile that this thread looks at.
uint light_word(uint tile)
{
    uint word = 0u;
    for (uint slice = 0u; slice < lighting.grid.cells.x; ++slice) {
        uvec4 cell = cells[hdrp_cull_cell(lighting.grid, tile, slice)];
        uint last = hdrp_cull_last(cell, HDRP_CULL_CATEGORY_PUNCTUAL);
        uint first = hdrp_cull_first(cell, HDRP_CULL_CATEGORY_PUNCTUAL);
        for (uint k = first + gl_LocalInvocationIndex; k < last; k += GROUP) {
            word |= hdrp_gpu_vk_word_of_light(lights[hdrp_cull_entry_index(entries[k])].bits.x);
        }
    }
    return word;
}

void main()
{
    uvec2 at = gl_WorkGroupID.xy;
    uvec2 begin = at * lighting.grid.tiles.xy;
    uvec2 end = min(begin + lighting.grid.tiles.xy, lighting.picture.xy);
    uint tile = at.y * lighting.grid.tiles.z + at.x;
    if (gl_LocalInvocationIndex == 0u) {
        materials = 0u;
        listed = 0u;
    }
    wait_for_group();
    atomicOr(materials, material_word(begin, end));
    wait_for_group();
    if (materials != 0u) {
        atomicOr(listed, light_word(tile));
    }
    wait_for_group();
    if (gl_LocalInvocationIndex == 0u) {
        uint needed = hdrp_gpu_vk_word_of_tile(materials, listed, lighting.lights.w);
        uint found = HDRP_CULL_VARIANT_NONE;
        for (uint k = 0u; k < push.x; ++k) {
            found = hdrp_cull_first_covering(found, k, variants[k], needed);
        }
        words[tile] = needed;
        chosen[tile] = needed == 0u ? HDRP_CULL_VARIANT_EMPTY : found;
    }
}
