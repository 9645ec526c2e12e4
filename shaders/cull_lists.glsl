// What the shaders that build lists share: the data of a frame, and the question that lists ask.
// A group works on a tile or on a coarse cell; its threads take candidates in turn, and those that
// find something learn their places, so that lists keep the order of categories and indices.
#include "hdrp_cull_grid.h"
#include "hdrp_cull_tile.h"
#include "group.glsl"

#define GROUPS_ACROSS 65535 // in a row of a dispatch of many threads
#define PLANES_STRIDE 12
#define FLAG_FAST     1u
#define FLAG_BLOCKS   8u
#define FLAG_MASKS    16u

struct Frame
{
    hdrp_cull_camera camera;
    hdrp_cull_grid grid;
    hdrp_depth_params device;
    vec4 pixel;    // x, y size of a pixel in the window, z near and w far distance [m]
    uvec4 picture; // x width and y height [px], z flags of hdrp_cull_desc, w 1: device depth
    uvec4 numbers; // x shapes, y room for them in a coarse cell, z, w tiles of a coarse cell
    uvec4 found;   // x a bit for each category that there is
};

// A shape as lists ask for it.
struct Seen
{
    vec4 rect_px;
    vec4 ball;
    float nearest, farthest;
    uint kind;  // | category << 8 | planes << 16
    uint order; // of importance: the least is dropped last
};

layout(std430, binding = 0) FRAME_ACCESS buffer FrameData { Frame frame_in_memory; };
// A copy, which main makes first: what is in memory may have changed for all that drivers know, and
// is read anew each time.
Frame frame;
#ifndef NO_SHAPES
layout(std430, binding = 1) SHAPE_ACCESS buffer SeenShapes { Seen seen_shapes[]; };
layout(std430, binding = 2) SHAPE_ACCESS buffer Planes { vec4 planes[]; };
layout(std430, binding = 3) SHAPE_ACCESS buffer Shapes { hdrp_cull_shape shapes[]; };
#endif

#ifdef PROJECTS
// Of a thread among all.
uint thread_index()
{
    return gl_WorkGroupID.y * (GROUPS_ACROSS * GROUP) + gl_GlobalInvocationID.x;
}
#endif

uint category_of(Seen s)
{
    return (s.kind >> 8) & 255u;
}

bool is_ball(Seen s)
{
    return (s.kind & HDRP_CULL_KIND_MASK) == HDRP_CULL_KIND_BALL;
}

#ifndef PROJECTS

shared uint found_bits[2];

// The place of each thread among those of the group that found something, and their number.
uint place_among(bool found, out uint total)
{
    uint thread = gl_LocalInvocationIndex;
    wait_for_group();
    if (thread < 2u) {
        found_bits[thread] = 0u;
    }
    wait_for_group();
    if (found) {
        atomicOr(found_bits[thread >> 5], 1u << (thread & 31u));
    }
    wait_for_group();
    uint low = uint(bitCount(found_bits[0]));
    total = low + uint(bitCount(found_bits[1]));
    uint before = found_bits[thread >> 5] & ((1u << (thread & 31u)) - 1u);
    return uint(bitCount(before)) + (thread >= 32u ? low : 0u);
}

// A rectangle of the picture, what is behind it, and between which depths something is seen.
struct Window
{
    hdrp_cull_tile tile;
    vec4 rect_px;
    hdrp_cull_interval seen;
};

Window window_of(uvec2 begin, uvec2 end, float nearest, float farthest)
{
    Window w;
    w.rect_px = vec4(begin, min(end, frame.picture.xy));
    w.tile = hdrp_cull_tile_make(frame.camera, w.rect_px.x, w.rect_px.y, w.rect_px.z, w.rect_px.w,
                                 float(frame.picture.x), float(frame.picture.y));
    w.seen = hdrp_cull_interval_seen(nearest, farthest);
    return w;
}

hdrp_cull_interval in_planes(uint shape, uint count, hdrp_cull_interval depths, Window w,
                             float orthographic)
{
    hdrp_cull_interval all = hdrp_cull_interval(0.0, HDRP_FLT_MAX);
    for (uint k = 0u; k < count; ++k) {
        hdrp_cull_interval one = hdrp_cull_interval_plane(
            hdrp_cull_interval(0.0, HDRP_FLT_MAX), w.tile, planes[shape * PLANES_STRIDE + k],
            orthographic);
        all.nearest = hdrp_max(one.nearest, all.nearest);
        all.farthest = hdrp_min(one.farthest, all.farthest);
    }
    return hdrp_cull_interval_within(depths, all);
}

// The depths of a shape in a window: none where nearest > farthest. Where pixels will be asked, the
// ball is left to them.
hdrp_cull_interval depths_in(Window w, uint shape, Seen s, bool pixels)
{
    float orthographic = frame.camera.forward_orthographic.w;
    bool fast = (frame.picture.z & FLAG_FAST) != 0u;
    hdrp_cull_interval r = hdrp_cull_bounds_in_rect(
        hdrp_cull_bounds(s.rect_px, s.nearest, s.farthest), w.rect_px, w.seen);
    if (!fast && !pixels && r.nearest <= r.farthest) {
        r = hdrp_cull_interval_within(r, hdrp_cull_interval_ball(w.tile, s.ball, orthographic));
    }
    if (!fast && !is_ball(s) && r.nearest <= r.farthest) {
        r = in_planes(shape, s.kind >> 16, r, w, orthographic);
    }
    return r;
}

#endif

#ifdef FILLS_LISTS

layout(std430, binding = 4) readonly buffer Coarse { uint coarse[]; };
layout(std430, binding = 5) readonly buffer Tiles { vec4 tiles[]; };
layout(std430, binding = 6) writeonly buffer Cells { uvec4 cells[]; };
layout(std430, binding = 7) writeonly buffer Entries { uint entries[]; };
layout(std430, binding = 8) writeonly buffer Masks { uint masks[]; };
// Of each tile how many shapes it dropped; behind that, where tiles have no slices, a bit for each of
// its candidates that is a hit.
layout(std430, binding = 9) buffer Dropped { uint dropped_of_tile[]; };

// The first candidate of a tile, behind their number.
uint candidates_of(uvec2 tile)
{
    uvec2 cell = tile / frame.numbers.zw;
    uint across = (frame.grid.tiles.z + frame.numbers.z - 1u) / frame.numbers.z;
    return (cell.y * across + cell.x) * (1u + frame.numbers.y) + 1u;
}

// ---- room ----
// Where entries do not fit, the shapes with the least keys stay that fit all together: of order,
// then of index. Their end is found digit by digit, as a radix sort goes.

#define DIGITS      6 // of 8 bits: four of the order, two of the index
#define DIGIT_COUNT 256

shared uint sums[DIGIT_COUNT];  // entries of the shapes with each digit
shared uint end_key[2];         // order and index of the first shape that does not fit
shared uint room;

uint digit_of(uint order, uint index, int level)
{
    return level < 4 ? (order >> (24 - 8 * level)) & 255u : (index >> (8 - 8 * (level - 4))) & 255u;
}

// Whether all digits in front of a level are those of the end.
bool leads_to_end(uint order, uint index, int level)
{
    uint shift = uint(32 - 8 * level);
    bool same = level == 0 || (level < 4 ? order >> shift == end_key[0] >> shift
                                         : order == end_key[0]);
    return same && (level < 5 || index >> 8 == end_key[1] >> 8);
}

bool is_kept(uint order, uint index)
{
    return order < end_key[0] || (order == end_key[0] && index < end_key[1]);
}

void begin_room()
{
    wait_for_group();
    if (gl_LocalInvocationIndex == 0u) {
        end_key[0] = end_key[1] = 0u;
        room = frame.grid.cells.y;
    }
}

void begin_level()
{
    wait_for_group();
    for (uint i = gl_LocalInvocationIndex; i < DIGIT_COUNT; i += GROUP) {
        sums[i] = 0u;
    }
    wait_for_group();
}

// Walks the digits of a level as long as their shapes fit.
void end_level(int level)
{
    wait_for_group();
    if (gl_LocalInvocationIndex == 0u) {
        uint digit = 0u;
        while (digit < DIGIT_COUNT - 1 && sums[digit] <= room) {
            room -= sums[digit];
            ++digit;
        }
        end_key[level / 4] |= digit << (level < 4 ? 24 - 8 * level : 8 - 8 * (level - 4));
    }
    wait_for_group();
}

#endif
