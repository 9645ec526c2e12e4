#version 450
// Nearest and farthest opaque depth of each tile, and the scale of its slices: what
// hdrp_cull_measure_depth writes, to the bit where the device divides as IEEE 754 says. A group
// makes a tile.
// contraction: none
// header: hdrp_gpu_vk_cull.h
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_cull_grid.h"
#include "group.glsl"

layout(binding = 0) uniform texture2D depths;
layout(std430, binding = 1) writeonly buffer Tiles { vec4 tiles[]; };
layout(push_constant) uniform Push
{
    hdrp_cull_grid grid;
    hdrp_depth_params device;
    vec4 limits;   // x near and y far distance [m]
    uvec4 picture; // x width and y height [px], z 1: device depth, w 1: one series
};

// Bits of depths: those of floats that are not negative rise with them.
shared uint nearest_bits;
shared uint farthest_bits;

void main()
{
    uvec2 tile = gl_WorkGroupID.xy;
    uvec2 begin = tile * grid.tiles.xy;
    uvec2 size = min(begin + grid.tiles.xy, picture.xy) - begin;
    float nearest = HDRP_FLT_MAX;
    float farthest = -1.0;
    if (gl_LocalInvocationIndex == 0u) {
        nearest_bits = hdrp_bits_from_f32(HDRP_FLT_MAX);
        farthest_bits = 0u;
    }
    wait_for_group();
    // Whole rows of threads: a quotient for each pixel would take longer than the pixel.
    uint across = min(size.x, GROUP);
    uint rows = GROUP / across;
    uvec2 own = uvec2(gl_LocalInvocationIndex % across, gl_LocalInvocationIndex / across);
    uint y = own.y;
    do { // asks at its end, as the loop inside does: see group.glsl
        uint x = own.x;
        do {
            if (own.y < rows && x < size.x && y < size.y) {
                float texel = texelFetch(depths, ivec2(begin + uvec2(x, y)), 0).x;
                float z = picture.z != 0u ? hdrp_view_depth(device, texel) : texel;
                z = hdrp_cull_opaque_depth(z, limits.x, limits.y);
                nearest = z >= 0.0 && z < nearest ? z : nearest;
                farthest = z > farthest ? z : farthest;
            }
            x += across;
        } while (x < size.x);
        y += rows;
    } while (y < size.y);
    if (farthest >= 0.0) { // an opaque depth is above 0, so that 0 is left for sky
        atomicMin(nearest_bits, hdrp_bits_from_f32(nearest));
        atomicMax(farthest_bits, hdrp_bits_from_f32(farthest));
    }
    wait_for_group();
    if (gl_LocalInvocationIndex == 0u) {
        float most = farthest_bits == 0u ? -1.0 : hdrp_f32_from_bits(farthest_bits);
        tiles[tile.y * grid.tiles.z + tile.x] =
            hdrp_cull_tile_of_depths(grid, hdrp_f32_from_bits(nearest_bits), most, picture.w);
    }
}
