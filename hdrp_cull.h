/* hdrp_cull.h - lists of the lights, probes and decals that reach each tile or cluster of a picture.
 * SPDX-License-Identifier: MIT
 *
 * What a pixel is lit by is looked up in a grid over the picture: tiles for opaque surfaces, whose
 * depth is known, clusters (tiles between two depths) for everything. Nothing is missed, whatever the
 * light, the camera and the rounding; hdrp_cull_volume.h, which this header includes, says how.
 *
 *     #define HDRP_CULL_IMPLEMENTATION          in one source file
 *     #include "hdrp_cull.h"
 *
 * Once, for a picture of a size; every block is the caller's, aligned to HDRP_MEMORY_ALIGNMENT:
 *
 *     hdrp_cull_desc desc = {0};                            clusters of 32 x 32 pixels, 64 slices
 *     desc.width_px = 1280, desc.height_px = 720;
 *     hdrp_cull_set_init(&set, capacity, memory, hdrp_cull_set_memory_size(capacity));
 *     hdrp_cull_init(&lists, &desc, memory, hdrp_cull_memory_size(&desc));
 *
 * Each frame, in ranges that independent jobs may share as they like:
 *
 *     hdrp_cull_set_begin(&set, &camera, 1280, 720, count);
 *     hdrp_cull_set_project(&set, shapes, 0, count);                    screen bounds
 *     hdrp_cull_begin(&lists, &set);
 *     hdrp_cull_measure_depth(&lists, &depth, 0, lists.grid.tiles.w);   rows of tiles; or none
 *     hdrp_cull_build(&lists, &set, NULL, 0, hdrp_cull_rows(&lists), scratch, bytes);
 *
 * A shader copies set, cells, entries and tiles to buffers and reads them with the formulas below:
 *
 *     tile = hdrp_cull_tile_of_pixel(grid, x, y);
 *     cell = cells[hdrp_cull_cell(grid, tile, hdrp_cull_slice(grid, tiles[tile], z_view))];
 *     for (i = hdrp_cull_first(cell, category); i < hdrp_cull_last(cell, category); ++i)
 *         shade with light hdrp_cull_entry_index(entries[i])
 *
 * Fine-pruned tiles, for opaque surfaces: tile_width_px = tile_height_px = 16, slice_count = 1, and
 * HDRP_CULL_PIXELS, which keeps what reaches at least one pixel; HDRP_CULL_BLOCKS notes of each entry
 * which sixteenths of the tile it reaches. Big tiles: 64 pixels, slice_count = 1, no depth.
 *
 * Lists are ordered by category, then by index, and do not depend on how the work was split. A tile
 * whose entries do not fit drops the least important shapes, of equals those of higher index, and
 * counts them: hdrp_cull_dropped.
 *
 * >>index of the functions, without hdrp_cull_ (written by tools/api_check.py --write)
 * >>end */
#ifndef HDRP_CULL_H
#define HDRP_CULL_H

#include "hdrp_cull_volume.h"

#if HDRP_VERSION != 100
#error "hdrp_cull.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#ifndef HDRP_GPU
#include <stddef.h>
#endif

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT OFF
#endif

/* Largest picture, in pixels along a side. */
#define HDRP_CULL_SIZE_MAX 16384u
/* Shapes of a set: their indices have 16 bits. */
#define HDRP_CULL_SHAPES_MAX 65535u
/* Slices of a tile. */
#define HDRP_CULL_SLICES_MAX 256u

/* Flags of hdrp_cull_desc. */
#define HDRP_CULL_FAST       1u /* rectangles and depths only: looser, several times faster */
#define HDRP_CULL_ONE_SERIES 2u /* slices at the same depths in all tiles */
#define HDRP_CULL_PIXELS     4u /* one slice only: keep what reaches a pixel of the depth buffer */
#define HDRP_CULL_BLOCKS     8u /* the same, for each sixteenth of a tile: hdrp_cull_entry_covers */

/* >>grid
 * What a shader needs to find the list of a position. Of each tile it also needs a vector, written
 * by hdrp_cull_measure_depth: x nearest and y farthest opaque depth [m], nothing opaque where x > y;
 * z scale of its slices, w 0. */

/* Made by hdrp_cull_grid_make. */
struct hdrp_cull_grid {
    hdrp_u32x4 tiles; /* any: width and height in px of a tile, columns, rows */
    hdrp_u32x4 cells; /* any: slices of a tile, entries of a tile, width and height of a block */
    hdrp_v4 series;   /* x [1e-6,1e9] m, y [-20,30] its log2, z [1e-6,1e18] m, w [0,1e7] scale */
};
HDRP_TYPEDEF(hdrp_cull_grid)

/** Logarithm to the base 2 for slices: a cubic in each octave, made of +, - and * alone, so that no
 *  device rounds it differently.
 *  x        [FLT_MIN,FLT_MAX]
 *  returns  [-126,128]  rises with x; exact for powers of 2
 *  edges    smaller x and NaN count as FLT_MIN
 *  error    <= 1.3e-4 absolute  @accuracy cull_log2
 *  source   log2(1 + m) = m + m (1 - m) q(m) with q a minimax polynomial; coefficients own */
HDRP_FN float hdrp_cull_log2(float x)
{
    hdrp_u32 u = hdrp_bits_from_f32(hdrp_clamp(x, HDRP_FLT_MIN, HDRP_FLT_MAX));
    float e = hdrp_f32_from_u32(u >> 23) - 127.0f;
    float m = hdrp_f32_from_bits((u & 0x007fffffu) | 0x3f800000u) - 1.0f;
    float q = 0.43872573f + m * (-0.23905817f + m * 0.08213063f);
    return e + (m + m * (1.0f - m) * q);
}

/** Scale of the slices of a tile: half of them are in front of a depth.
 *  grid        valid
 *  farthest_m  any     farthest opaque depth
 *  returns     [0,1e7]  slices in an octave of depth
 *  edges       a depth of less than a thousandth beyond the start of the series counts as that; an
 *              infinite one or NaN as the start
 *  error       none: a definition
 *  source      Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *              Definition Render Pipeline", slides on clustered lists; without the limit that their
 *              series has when the farthest depth is far */
HDRP_FN float hdrp_cull_series_scale(hdrp_cull_grid grid, float farthest_m)
{
    float octaves = hdrp_cull_log2(farthest_m) - grid.series.y;
    return hdrp_f32_from_u32(grid.cells.x >> 1) / hdrp_max(octaves, 1e-3f);
}

/** The grid over a picture.
 *  camera          valid
 *  picture         any  x width and y height in px, z slices, w entries of a tile
 *  tile            any  x width and y height in px, z and w 0
 *  series_start_m  any  first boundary between slices comes after this; 0: the near distance
 *  series_end_m    any  last slice of a tile without depth ends here; 0: the far distance, but at
 *                       most 1000 times the start
 *  returns         valid
 *  edges           sizes of 0 count as 1; the last slice reaches to the far distance, wherever the
 *                  series ends
 *  error           none: limits
 *  source          a definition */
HDRP_FN hdrp_cull_grid hdrp_cull_grid_make(hdrp_cull_camera camera, hdrp_u32x4 picture,
                                           hdrp_u32x4 tile, float series_start_m,
                                           float series_end_m)
{
    hdrp_cull_grid g;
    hdrp_u32 w = tile.x > 0u ? tile.x : 1u;
    hdrp_u32 h = tile.y > 0u ? tile.y : 1u;
    hdrp_u32 slices = picture.z > 0u ? picture.z : 1u;
    float start =
        hdrp_clamp(series_start_m > 0.0f ? series_start_m : camera.eye_near.w, 1e-6f, 1e9f);
    float end = hdrp_min(camera.right_far.w, 1000.0f * start);
    float octaves;
    end = hdrp_clamp(series_end_m > 0.0f ? series_end_m : end, start, HDRP_CULL_FAR_INFINITE);
    g.tiles = hdrp_u32x4_make(w, h, (picture.x + w - 1u) / w, (picture.y + h - 1u) / h);
    g.cells = hdrp_u32x4_make(slices, picture.w, (w + 3u) >> 2, (h + 3u) >> 2);
    octaves = hdrp_max(hdrp_cull_log2(end) - hdrp_cull_log2(start), 1e-3f);
    g.series = hdrp_v4_make(start, hdrp_cull_log2(start), end, hdrp_f32_from_u32(slices) / octaves);
    return g;
}

/** The tile that holds a pixel.
 *  grid     valid
 *  x_px     any  from the left
 *  y_px     any  from the top
 *  returns  any  index of the tile, row by row
 *  edges    pixels beyond the picture belong to no tile: their result means nothing
 *  error    none: a definition
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_tile_of_pixel(hdrp_cull_grid grid, hdrp_u32 x_px, hdrp_u32 y_px)
{
    return (y_px / grid.tiles.y) * grid.tiles.z + x_px / grid.tiles.x;
}

/** The slice that holds a depth.
 *  grid     valid
 *  scale    [0,1e7]  of the tile
 *  z_view   any      m
 *  returns  [0,255]
 *  edges    in front of the series the first slice, behind it the last; NaN counts as 0
 *  error    none: a definition; what is listed in a slice allows for a depth that is off by 1e-6
 *  source   Olsson, Billeter and Assarsson 2012, "Clustered Deferred and Forward Shading", eq. 2 */
HDRP_FN hdrp_u32 hdrp_cull_slice(hdrp_cull_grid grid, float scale, float z_view)
{
    float k = (hdrp_cull_log2(z_view) - grid.series.y) * scale;
    float last = hdrp_f32_from_u32(grid.cells.x) - 1.0f;
    return hdrp_u32_from_f32(hdrp_clamp(k, 0.0f, last));
}

/** The cell of a slice of a tile.
 *  grid     valid
 *  tile     any  from hdrp_cull_tile_of_pixel
 *  slice    any  from hdrp_cull_slice
 *  returns  any  index
 *  edges    none
 *  error    none: a definition
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_cell(hdrp_cull_grid grid, hdrp_u32 tile, hdrp_u32 slice)
{
    return tile * grid.cells.x + slice;
}

/* >>lists
 * A cell is x the first of its entries, y and z the counts of the four categories, 16 bits each, the
 * first in the low bits of y, and w how many shapes its tile has dropped. */

/* Entries of a category. */
HDRP_FN hdrp_u32 hdrp_i_cull_count(hdrp_u32x4 cell, hdrp_u32 category)
{
    hdrp_u32 both = category < 2u ? cell.y : cell.z;
    return (both >> ((category & 1u) << 4)) & 0xffffu;
}

/** Index of the first entry of a category in a cell.
 *  cell      any    from the cells of hdrp_cull_build
 *  category  [0,3]  HDRP_CULL_CATEGORY_...
 *  returns   any    into the entries
 *  edges     the entries of a cell are contiguous: those of all categories are from the first of
 *            category 0 up to the last of category 3
 *  error     none: a selection of bits
 *  source    a definition */
HDRP_FN hdrp_u32 hdrp_cull_first(hdrp_u32x4 cell, hdrp_u32 category)
{
    hdrp_u32 first = cell.x;
    first += category > 0u ? cell.y & 0xffffu : 0u;
    first += category > 1u ? cell.y >> 16 : 0u;
    first += category > 2u ? cell.z & 0xffffu : 0u;
    return first;
}

/** Index behind the last entry of a category in a cell.
 *  cell      any    from the cells of hdrp_cull_build
 *  category  [0,3]  HDRP_CULL_CATEGORY_...
 *  returns   any    into the entries
 *  edges     hdrp_cull_first where there is none
 *  error     none: a selection of bits
 *  source    a definition */
HDRP_FN hdrp_u32 hdrp_cull_last(hdrp_u32x4 cell, hdrp_u32 category)
{
    return hdrp_cull_first(cell, category) + hdrp_i_cull_count(cell, category);
}

/** The shape of an entry.
 *  entry    any
 *  returns  [0,65535]  index into the shapes of the set
 *  edges    none
 *  error    none: a selection of bits
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_entry_index(hdrp_u32 entry)
{
    return entry & 0xffffu;
}

/** Whether the shape of an entry reaches the block of a pixel: a sixteenth of its tile.
 *  grid     valid
 *  entry    any
 *  x_px     any
 *  y_px     any
 *  returns  [0,1]  1 where it may; always 1 in lists without HDRP_CULL_BLOCKS
 *  edges    the pixel has to be in the tile of the list
 *  error    none: a selection of bits
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_entry_covers(hdrp_cull_grid grid, hdrp_u32 entry, hdrp_u32 x_px,
                                        hdrp_u32 y_px)
{
    hdrp_u32 x = (x_px % grid.tiles.x) / grid.cells.z;
    hdrp_u32 y = (y_px % grid.tiles.y) / grid.cells.w;
    return (entry >> (16u + ((y & 3u) * 4u + (x & 3u)))) & 1u;
}

/** Index of the lowest bit of a word of a bit mask.
 *  word     [1,4294967295]
 *  returns  [0,31]
 *  edges    means nothing for 0
 *  error    none: exact
 *  source   the exponent of a power of 2
 *  note     word & (word - 1) is the word without that bit, for the next turn of a loop */
HDRP_FN hdrp_u32 hdrp_cull_lowest_bit(hdrp_u32 word)
{
    hdrp_u32 lowest = word & (~word + 1u);
    return (hdrp_bits_from_f32(hdrp_f32_from_u32(lowest)) >> 23) - 127u;
}

#ifndef HDRP_GPU
#ifdef __cplusplus
extern "C" {
#endif

/* >>sets of shapes: screen bounds */

/* Shapes as a camera sees them. The members are for reading; init sets the pointers. */
typedef struct hdrp_cull_set {
    hdrp_cull_camera camera;
    uint32_t width_px, height_px;
    uint32_t count, capacity;
    hdrp_cull_shape* shapes;  /* in view space */
    hdrp_v4* balls;           /* hdrp_cull_shape_ball */
    hdrp_v4* planes;          /* HDRP_CULL_PLANES_MAX of each shape */
    hdrp_cull_bounds* bounds; /* on the screen */
} hdrp_cull_set;

/** Bytes that hdrp_cull_set_init needs.
 *  capacity  [1,HDRP_CULL_SHAPES_MAX]  shapes
 *  returns   bytes, a multiple of HDRP_MEMORY_ALIGNMENT
 *  edges     0 where capacity is out of range */
HDRP_API size_t hdrp_cull_set_memory_size(uint32_t capacity);

/** Places a set in a block of memory. It is empty.
 *  set           result
 *  capacity      [1,HDRP_CULL_SHAPES_MAX]  shapes
 *  memory        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT; it must outlive set
 *  memory_bytes  size of the block
 *  returns       HDRP_OK
 *  errors        HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT, HDRP_ERROR_MEMORY_TOO_SMALL,
 *                HDRP_ERROR_MEMORY_ALIGNMENT */
HDRP_API hdrp_result hdrp_cull_set_init(hdrp_cull_set* set, uint32_t capacity, void* memory,
                                        size_t memory_bytes);

/** Begins a frame.
 *  set        from hdrp_cull_set_init
 *  camera     from its makers
 *  width_px   [1,HDRP_CULL_SIZE_MAX]  of the picture
 *  height_px  [1,HDRP_CULL_SIZE_MAX]
 *  count      [0,capacity]  shapes that hdrp_cull_set_project will be given
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT
 *  note       what does not fit the capacity is for the caller to leave out: nothing is dropped here */
HDRP_API hdrp_result hdrp_cull_set_begin(hdrp_cull_set* set, const hdrp_cull_camera* camera,
                                         uint32_t width_px, uint32_t height_px, uint32_t count);

/** First stage: shapes in view space, their planes and the bounds of each on the screen.
 *  set      after hdrp_cull_set_begin
 *  shapes   all `count` of them, in the world; an index in a list is an index into this array
 *  first    [0,count]  first to be projected
 *  count    [0,count]  how many
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range
 *  range    shapes are independent */
HDRP_API hdrp_result hdrp_cull_set_project(hdrp_cull_set* set, const hdrp_cull_shape* shapes,
                                           uint32_t first, uint32_t count);

/* >>grids of lists */

/* Zero means the default. */
typedef struct hdrp_cull_desc {
    uint32_t width_px, height_px;           /* [1,HDRP_CULL_SIZE_MAX] of the picture: no default */
    uint32_t tile_width_px, tile_height_px; /* [0,HDRP_CULL_SIZE_MAX] 0: 32 */
    uint32_t slice_count;                   /* [0,HDRP_CULL_SLICES_MAX] 0: 64; 1: tiles */
    uint32_t shape_capacity;                /* [0,HDRP_CULL_SHAPES_MAX] of sets; 0: 1024 */
    uint32_t
        entry_capacity; /* [0,65535 x slices] of all lists of a tile; 0: 32 a slice, at least 256 */
    uint32_t flags;     /* HDRP_CULL_FAST | ... */
    float series_start_m, series_end_m; /* of hdrp_cull_grid_make */
} hdrp_cull_desc;

/* Lists of a picture. The members are for reading; init sets the pointers. */
typedef struct hdrp_cull_lists {
    hdrp_cull_desc desc;     /* with the defaults in place */
    hdrp_cull_grid grid;     /* for the camera of hdrp_cull_begin */
    hdrp_v4* tiles;          /* see the section grid */
    hdrp_u32x4* cells;       /* see the section lists */
    uint32_t* entries;       /* entry_capacity of each tile, which begins at a multiple of that */
    uint32_t* tile_dropped;  /* shapes that each tile had no room for */
    hdrp_cull_camera camera; /* of hdrp_cull_begin */
} hdrp_cull_lists;

/* Depths of a picture. */
typedef struct hdrp_cull_depth {
    const float* texels;             /* rows from the top */
    size_t row_stride;               /* texels from row to row */
    const hdrp_depth_params* device; /* how to read device depth; NULL: texels are metres */
} hdrp_cull_depth;

/** Bytes that hdrp_cull_init needs.
 *  desc     sizes
 *  returns  bytes, a multiple of HDRP_MEMORY_ALIGNMENT
 *  edges    0 where desc is NULL or not valid, or too large for the target */
HDRP_API size_t hdrp_cull_memory_size(const hdrp_cull_desc* desc);

/** Places lists in a block of memory.
 *  lists         result
 *  desc          sizes
 *  memory        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT; it must outlive lists
 *  memory_bytes  size of the block
 *  returns       HDRP_OK
 *  errors        HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT, HDRP_ERROR_TOO_LARGE,
 *                HDRP_ERROR_MEMORY_TOO_SMALL, HDRP_ERROR_MEMORY_ALIGNMENT */
HDRP_API hdrp_result hdrp_cull_init(hdrp_cull_lists* lists, const hdrp_cull_desc* desc,
                                    void* memory, size_t memory_bytes);

/** Begins a frame: the grid for a camera, tiles without depth, no lists.
 *  lists    from hdrp_cull_init
 *  set      after hdrp_cull_set_begin; its picture has the size of the lists
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for another size of picture */
HDRP_API hdrp_result hdrp_cull_begin(hdrp_cull_lists* lists, const hdrp_cull_set* set);

/** Optional stage: the nearest and farthest opaque depth of tiles, and their slices. Without it
 *  lists serve transparent surfaces and fog: nothing is known to be in front.
 *  lists      after hdrp_cull_begin
 *  depth      of the picture; what is NaN, at or beyond the far distance is sky
 *  first_row  [0,grid.tiles.w]  of tiles
 *  row_count  [0,grid.tiles.w]
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range or stride
 *  range      rows of tiles are independent
 *  note       a tile of one slice that shows only sky gets an empty list */
HDRP_API hdrp_result hdrp_cull_measure_depth(hdrp_cull_lists* lists, const hdrp_cull_depth* depth,
                                             uint32_t first_row, uint32_t row_count);

/** How many rows hdrp_cull_build can be split into.
 *  lists    from hdrp_cull_init
 *  returns  rows of about 64 pixels
 *  edges    0 where lists is NULL */
HDRP_API uint32_t hdrp_cull_rows(const hdrp_cull_lists* lists);

/** Bytes of scratch memory that a call of hdrp_cull_build needs.
 *  desc     sizes
 *  returns  bytes, a multiple of HDRP_MEMORY_ALIGNMENT
 *  edges    0 where desc is NULL or not valid, or too large for the target */
HDRP_API size_t hdrp_cull_scratch_size(const hdrp_cull_desc* desc);

/** Last stage: the lists.
 *  lists          after hdrp_cull_begin, and hdrp_cull_measure_depth of the same rows if there is depth
 *  set            after hdrp_cull_set_project of all its shapes
 *  depth          that of hdrp_cull_measure_depth; needed with HDRP_CULL_PIXELS or HDRP_CULL_BLOCKS,
 *                 else NULL will do
 *  first_row      [0,hdrp_cull_rows]  first of the rows to build
 *  row_count      [0,hdrp_cull_rows]
 *  scratch        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT, for this call alone
 *  scratch_bytes  size of the block
 *  returns        HDRP_OK, also where shapes were dropped
 *  errors         HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range or a set that is
 *                 larger than desc.shape_capacity, HDRP_ERROR_MEMORY_TOO_SMALL,
 *                 HDRP_ERROR_MEMORY_ALIGNMENT
 *  memory         calls that run at the same time need scratch of their own; nothing is kept in it
 *  range          rows are independent */
HDRP_API hdrp_result hdrp_cull_build(hdrp_cull_lists* lists, const hdrp_cull_set* set,
                                     const hdrp_cull_depth* depth, uint32_t first_row,
                                     uint32_t row_count, void* scratch, size_t scratch_bytes);

/** What did not fit, and what did.
 *  tiles    that dropped something
 *  dropped  shapes, summed over the tiles
 *  entries  of all lists */
typedef struct hdrp_cull_stats {
    uint64_t entries;
    uint32_t tiles_full; /* tiles that dropped shapes */
    uint32_t dropped;    /* shapes dropped, summed over the tiles */
    uint32_t longest;    /* entries of the longest list */
} hdrp_cull_stats;

/** Counts of a frame.
 *  lists    after hdrp_cull_build of all rows
 *  stats    result
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER */
HDRP_API hdrp_result hdrp_cull_count(const hdrp_cull_lists* lists, hdrp_cull_stats* stats);

/** The lists of tiles as bit masks: bit i % 32 of word i / 32 of a cell is set where shape i is listed.
 *  lists       after hdrp_cull_build of the tiles' rows
 *  first_tile  [0,tiles]
 *  tile_count  [0,tiles]
 *  words       result: `stride` words for each cell, of the first tile on
 *  stride      words of a cell: at least (count + 31) / 32 for a set of count shapes
 *  returns     HDRP_OK
 *  errors      HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range, or a stride that
 *              does not hold a listed index, in which case nothing is written
 *  range       tiles are independent */
HDRP_API hdrp_result hdrp_cull_masks(const hdrp_cull_lists* lists, uint32_t first_tile,
                                     uint32_t tile_count, uint32_t* words, uint32_t stride);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT DEFAULT
#endif

#endif /* HDRP_CULL_H */
