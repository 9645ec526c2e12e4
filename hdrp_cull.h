/* hdrp_cull.h - lists of the lights, probes and decals that reach each tile or cluster of pixels.
 * SPDX-License-Identifier: MIT
 *
 * What a pixel is lit by is looked up in a grid over the picture: tiles for opaque surfaces, whose
 * depth is known, clusters (tiles between two depths) for everything. Nothing is missed, whatever
 * the light, the camera and the rounding; hdrp_cull_volume.h, which this header includes, says how.
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
 *     hdrp_cull_build(&lists, &set, &depth, 0, hdrp_cull_rows(&lists), scratch, bytes);
 *
 * A shader gets grid, cells, entries and tiles in buffers, and reads them as hdrp_cull_grid.h says.
 *
 * Fine-pruned tiles, for opaque surfaces: tile_width_px = tile_height_px = 16, slice_count = 1, and
 * HDRP_CULL_PIXELS, which keeps what reaches at least one pixel; HDRP_CULL_BLOCKS notes of each
 * entry which sixteenths of the tile it reaches. They need depth, by which clusters only gain. Big
 * tiles: 64 pixels, slice_count = 1, no depth.
 *
 * Lists are ordered by category, then by index, and do not depend on how the work was split. A tile
 * whose entries do not fit drops the least important shapes, of equals those of higher index, and
 * counts them: hdrp_cull_count. A shape needs an entry in every slice that it reaches; once one
 * does not fit, what is less important is dropped too, so that the most important always stays.
 *
 * >>index of the functions, without hdrp_cull_ (written by tools/api_check.py --write)
 *   sets of shapes: set_memory_size set_init set_begin set_project
 *   grids of lists: desc_complete memory_size init begin measure_depth rows scratch_size build
 *       count masks light_features apply_blockers
 * >>end */
#ifndef HDRP_CULL_H
#define HDRP_CULL_H

#include "hdrp_cull_blocker.h"
#include "hdrp_cull_grid.h"
#include "hdrp_cull_tile.h"
#include "hdrp_cull_variant.h"
#include "hdrp_cull_volume.h"

#if HDRP_VERSION != 100
#error "hdrp_cull.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#ifndef HDRP_GPU
#include <stddef.h>
#endif

/* Shapes of a set: their indices have 16 bits. */
#define HDRP_CULL_SHAPES_MAX 65535u

/* Flags of hdrp_cull_desc. */
#define HDRP_CULL_FAST       1u /* rectangles and depths only; not with HDRP_CULL_PIXELS */
#define HDRP_CULL_ONE_SERIES 2u /* slices at the same depths in all tiles */
#define HDRP_CULL_PIXELS     4u /* one slice only: keep what reaches a pixel of the depth buffer */
#define HDRP_CULL_BLOCKS     8u /* the same, for each sixteenth of a tile: hdrp_cull_entry_covers */
#define HDRP_CULL_MASKS      16u /* the same, for each pixel: hdrp_cull_mask_word */

#ifndef HDRP_GPU
#ifdef __cplusplus
extern "C" {
#endif

/* >>sets of shapes: screen bounds */

/* Room for the planes of a shape: those it has, and others that exclude nothing. */
#define HDRP_CULL_PLANES_STRIDE 16u

/* Shapes as a camera sees them. The members are for reading; init sets the pointers. */
typedef struct hdrp_cull_set {
    hdrp_cull_camera camera;
    uint32_t width_px, height_px;
    uint32_t count, capacity;
    hdrp_cull_shape* shapes;  /* in view space */
    hdrp_v4* balls;           /* hdrp_cull_shape_ball */
    float* planes;            /* of each shape x, y, z, w of HDRP_CULL_PLANES_STRIDE planes */
    hdrp_cull_bounds* bounds; /* on the screen */
    uint16_t* kinds;          /* kind | category << 8 of each shape: the lower bits of bits.x */
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
 *  count      [0,HDRP_CULL_SHAPES_MAX]  shapes that hdrp_cull_set_project will be given: at most
 *             the capacity
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT
 *  note       what exceeds the capacity is for the caller to leave out: nothing is dropped here */
HDRP_API hdrp_result hdrp_cull_set_begin(hdrp_cull_set* set, const hdrp_cull_camera* camera,
                                         uint32_t width_px, uint32_t height_px, uint32_t count);

/** First stage: shapes in view space, their planes and the bounds of each on the screen.
 *  set      after hdrp_cull_set_begin
 *  shapes   all `count` of them, in the world; an index in a list is an index into this array
 *  first    [0,HDRP_CULL_SHAPES_MAX]  first to be projected
 *  count    [0,HDRP_CULL_SHAPES_MAX]  how many: at most up to the count of hdrp_cull_set_begin
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
    uint32_t entry_capacity; /* [slices,65535 x slices] of all lists of a tile; 0: 32 a slice, at
                                least 256. A shape may need an entry in each slice */
    uint32_t flags;          /* HDRP_CULL_FAST | ... */
    float series_start_m, series_end_m; /* of hdrp_cull_grid_make */
} hdrp_cull_desc;

/* Lists of a picture. The members are for reading; init sets the pointers. */
typedef struct hdrp_cull_lists {
    hdrp_cull_desc desc;     /* with the defaults in place */
    hdrp_cull_grid grid;     /* for the camera of hdrp_cull_begin */
    hdrp_v4* tiles;          /* see hdrp_cull_grid.h */
    hdrp_u32x4* cells;       /* see hdrp_cull_grid.h */
    uint32_t* entries;       /* entry_capacity of each tile, which begins at a multiple of that */
    uint32_t* masks;         /* of each entry, see hdrp_cull_mask_word; NULL without the flag */
    uint32_t* tile_dropped;  /* shapes that each tile had no room for */
    hdrp_cull_camera camera; /* of hdrp_cull_begin */
} hdrp_cull_lists;

/* Depths of a picture. */
typedef struct hdrp_cull_depth {
    const float* texels;             /* rows from the top */
    size_t row_stride;               /* texels from row to row */
    const hdrp_depth_params* device; /* how to read device depth; NULL: texels are metres */
} hdrp_cull_depth;

/** A description of lists with its defaults in place, as hdrp_cull_init keeps it.
 *  desc      sizes
 *  complete  result; may be desc
 *  returns   HDRP_OK, or an error, with complete untouched
 *  errors    HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for sizes out of their ranges,
 *            HDRP_ERROR_TOO_LARGE where cells, entries or masks are more than 32 bits can count */
HDRP_API hdrp_result hdrp_cull_desc_complete(const hdrp_cull_desc* desc, hdrp_cull_desc* complete);

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
 *  errors        HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for sizes out of their ranges,
 *                HDRP_ERROR_TOO_LARGE, HDRP_ERROR_MEMORY_TOO_SMALL, HDRP_ERROR_MEMORY_ALIGNMENT
 *  note          with fewer entries than slices the most important shape might not fit, and then a
 *                tile would list nothing at all: such an entry_capacity is out of range */
HDRP_API hdrp_result hdrp_cull_init(hdrp_cull_lists* lists, const hdrp_cull_desc* desc,
                                    void* memory, size_t memory_bytes);

/** Begins a frame: the grid for a camera, tiles without depth, no lists.
 *  lists    from hdrp_cull_init
 *  set      after hdrp_cull_set_begin; its picture has the size of the lists
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for another size of picture */
HDRP_API hdrp_result hdrp_cull_begin(hdrp_cull_lists* lists, const hdrp_cull_set* set);

/** Optional stage: the nearest and farthest opaque depth of tiles, and their slices. Nothing is
 *  known to be in front without it, as transparent surfaces and fog want it.
 *  lists      after hdrp_cull_begin
 *  depth      of the picture; what is NaN, beyond the far distance or within a millionth of it is
 *             sky
 *  first_row  [0,HDRP_CULL_SIZE_MAX]  first row of tiles
 *  row_count  [0,HDRP_CULL_SIZE_MAX]  how many: at most up to grid.tiles.w
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
 *  lists          after hdrp_cull_begin and, where there is depth, hdrp_cull_measure_depth
 *  set            after hdrp_cull_set_project of all its shapes
 *  depth          that of hdrp_cull_measure_depth; needed with HDRP_CULL_PIXELS or
 *                 HDRP_CULL_BLOCKS, else NULL will do
 *  first_row      [0,HDRP_CULL_SIZE_MAX]  first row to build, of those that hdrp_cull_rows counts
 *  row_count      [0,HDRP_CULL_SIZE_MAX]  how many: at most up to hdrp_cull_rows
 *  scratch        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT, for this call alone
 *  scratch_bytes  size of the block
 *  returns        HDRP_OK, also where shapes were dropped
 *  errors         HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range, a set that is
 *                 larger than desc.shape_capacity or of another camera than lists,
 *                 HDRP_ERROR_TOO_LARGE for the target, HDRP_ERROR_MEMORY_TOO_SMALL,
 *                 HDRP_ERROR_MEMORY_ALIGNMENT
 *  memory         calls that run at the same time need scratch of their own; nothing is kept in it
 *  range          rows are independent */
HDRP_API hdrp_result hdrp_cull_build(hdrp_cull_lists* lists, const hdrp_cull_set* set,
                                     const hdrp_cull_depth* depth, uint32_t first_row,
                                     uint32_t row_count, void* scratch, size_t scratch_bytes);

/* What did not fit, and what did. */
typedef struct hdrp_cull_stats {
    uint64_t entries;    /* of all lists */
    uint64_t dropped;    /* shapes dropped, summed over the tiles */
    uint32_t tiles_full; /* tiles that dropped shapes */
    uint32_t longest;    /* entries of the longest list */
} hdrp_cull_stats;

/** Counts of a frame.
 *  lists    after hdrp_cull_build of all rows
 *  stats    result
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER */
HDRP_API hdrp_result hdrp_cull_count(const hdrp_cull_lists* lists, hdrp_cull_stats* stats);

/** The lists of tiles as bit masks: bit i % 32 of word i / 32 of a cell is set where shape i is
 *  listed.
 *  lists       after hdrp_cull_build of the tiles' rows
 *  first_tile  any  index of the first tile, row by row
 *  tile_count  any  how many: at most up to grid.tiles.z times grid.tiles.w
 *  words       result: `stride` words for each cell, of the first tile on
 *  stride      any  words of a cell: at least (count + 31) / 32 for a set of count shapes
 *  returns     HDRP_OK
 *  errors      HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range, or a stride that
 *              does not hold a listed index, in which case nothing is written
 *  range       tiles are independent */
HDRP_API hdrp_result hdrp_cull_masks(const hdrp_cull_lists* lists, uint32_t first_tile,
                                     uint32_t tile_count, uint32_t* words, uint32_t stride);

/** Light features of tiles, for hdrp_cull_combine_features: the union over what their lists hold.
 *  lists       after hdrp_cull_build and, where there are blockers, hdrp_cull_apply_blockers
 *  set         that of hdrp_cull_build: hdrp_cull_shape_with_features says what its features mean
 *  first_tile  any  index of the first tile, row by row
 *  tile_count  any  how many: at most up to grid.tiles.z times grid.tiles.w
 *  words       result: a word for each tile of lists, of which those of the range are written
 *  returns     HDRP_OK
 *  errors      HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range, or a set that does
 *              not hold a listed index, in which case nothing is written
 *  range       tiles are independent
 *  note        0 where all lists are empty; what a tile dropped is not shaded and does not count */
HDRP_API hdrp_result hdrp_cull_light_features(const hdrp_cull_lists* lists,
                                              const hdrp_cull_set* set, uint32_t first_tile,
                                              uint32_t tile_count, uint32_t* words);

/** Optional stage: lights leave the cells that their blockers keep dark, and for each of the others
 *  a mask says which of its blockers pixels have to test.
 *  lists       after hdrp_cull_build of the tiles' rows; lists become shorter, in the same order
 *  job         after hdrp_cull_blocker_job_begin, for the camera of lists; lights are the first of
 *              the shapes. It counts what was decided
 *  first_tile  any  index of the first tile, row by row
 *  tile_count  any  how many: at most up to grid.tiles.z times grid.tiles.w
 *  masks       result: a word for each entry, at the index of the entry; as many as there are tiles
 *              times entry_capacity. What belongs to no entry is left alone
 *  returns     HDRP_OK
 *  errors      HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range or another camera
 *  range       tiles are independent; each job needs a hdrp_cull_blocker_job of its own
 *  source      Kircher 2018, "Rendering Technology in Agents of Mayhem", slides on blocker tile
 *              culling */
HDRP_API hdrp_result hdrp_cull_apply_blockers(hdrp_cull_lists* lists, hdrp_cull_blocker_job* job,
                                              uint32_t first_tile, uint32_t tile_count,
                                              uint32_t* masks);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */

#endif /* HDRP_CULL_H */

#if defined(HDRP_CULL_IMPLEMENTATION) && !defined(HDRP_GPU) && !defined(HDRP_I_CULL_IMPLEMENTED)
#define HDRP_I_CULL_IMPLEMENTED

/* Their bodies too, where they were included before the macro was defined. */
#include "hdrp_cull_blocker.h"
#include "hdrp_cull_variant.h"

/* Lists are the same bits whether or not the target has fused multiply-adds. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wpass-failed" /* where loops are not to be vectorised */
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off")
#endif

/* The turns of the loop that follows do not depend on each other: no two arrays overlap. */
#if defined(__clang__)
#define HDRP_I_CULL_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define HDRP_I_CULL_INDEPENDENT _Pragma("GCC ivdep")
#else
#define HDRP_I_CULL_INDEPENDENT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- memory ---------------------------------------------------------------------------------- */

/* Hands out parts of a block; with a NULL block it only counts. */
typedef struct hdrp_i_cull_arena {
    unsigned char* block;
    size_t used;
} hdrp_i_cull_arena;

static void* hdrp_i_cull_take(hdrp_i_cull_arena* arena, size_t count, size_t size)
{
    void* place = arena->block ? arena->block + arena->used : NULL;
    arena->used += HDRP_MEMORY_ROUND_UP(count * size);
    return place;
}

static hdrp_result hdrp_i_cull_check_block(const void* memory, size_t bytes, size_t needed)
{
    if (!memory) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if ((uintptr_t)memory % HDRP_MEMORY_ALIGNMENT != 0u) {
        return HDRP_ERROR_MEMORY_ALIGNMENT;
    }
    return bytes < needed ? HDRP_ERROR_MEMORY_TOO_SMALL : HDRP_OK;
}

static int hdrp_i_cull_bad_range(uint32_t first, uint32_t count, uint32_t end)
{
    return first > end || count > end - first;
}

/* ---- sets ------------------------------------------------------------------------------------ */

static size_t hdrp_i_cull_place_set(hdrp_cull_set* set, uint32_t capacity, void* memory)
{
    hdrp_i_cull_arena arena;
    arena.block = (unsigned char*)memory;
    arena.used = 0u;
    memset(set, 0, sizeof *set);
    set->capacity = capacity;
    set->shapes = (hdrp_cull_shape*)hdrp_i_cull_take(&arena, capacity, sizeof *set->shapes);
    set->balls = (hdrp_v4*)hdrp_i_cull_take(&arena, capacity, sizeof *set->balls);
    set->planes = (float*)hdrp_i_cull_take(&arena, (size_t)capacity * 4u * HDRP_CULL_PLANES_STRIDE,
                                           sizeof *set->planes);
    set->bounds = (hdrp_cull_bounds*)hdrp_i_cull_take(&arena, capacity, sizeof *set->bounds);
    set->kinds = (uint16_t*)hdrp_i_cull_take(&arena, capacity, sizeof *set->kinds);
    return arena.used;
}

HDRP_API size_t hdrp_cull_set_memory_size(uint32_t capacity)
{
    hdrp_cull_set set;
    return capacity < 1u || capacity > HDRP_CULL_SHAPES_MAX
               ? 0u
               : hdrp_i_cull_place_set(&set, capacity, NULL);
}

HDRP_API hdrp_result hdrp_cull_set_init(hdrp_cull_set* set, uint32_t capacity, void* memory,
                                        size_t memory_bytes)
{
    hdrp_result r;
    size_t needed = hdrp_cull_set_memory_size(capacity);
    if (!set) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (needed == 0u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    r = hdrp_i_cull_check_block(memory, memory_bytes, needed);
    if (r == HDRP_OK) {
        hdrp_i_cull_place_set(set, capacity, memory);
    }
    return r;
}

HDRP_API hdrp_result hdrp_cull_set_begin(hdrp_cull_set* set, const hdrp_cull_camera* camera,
                                         uint32_t width_px, uint32_t height_px, uint32_t count)
{
    if (!set || !camera) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (width_px < 1u || width_px > HDRP_CULL_SIZE_MAX || height_px < 1u ||
        height_px > HDRP_CULL_SIZE_MAX || count > set->capacity) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    set->camera = *camera;
    set->width_px = width_px;
    set->height_px = height_px;
    set->count = count;
    return HDRP_OK;
}

static uint32_t hdrp_i_cull_category(const hdrp_cull_set* set, uint32_t i)
{
    return (uint32_t)set->kinds[i] >> 8;
}

static int hdrp_i_cull_is_ball(const hdrp_cull_set* set, uint32_t i)
{
    return (set->kinds[i] & HDRP_CULL_KIND_MASK) == HDRP_CULL_KIND_BALL;
}

/* The planes of a shape; what it has less than others excludes nothing. */
static void hdrp_i_cull_project_planes(hdrp_cull_shape shape, float orthographic, float* planes)
{
    uint32_t count = hdrp_cull_shape_plane_count(shape), k;
    for (k = 0u; k < HDRP_CULL_PLANES_STRIDE; ++k) {
        hdrp_v4 plane = hdrp_v4_make(0.0f, 0.0f, 0.0f, 1.0f);
        if (k < count) {
            plane = hdrp_cull_shape_plane(shape, k, orthographic);
        }
        planes[k] = plane.x;
        planes[k + HDRP_CULL_PLANES_STRIDE] = plane.y;
        planes[k + 2u * HDRP_CULL_PLANES_STRIDE] = plane.z;
        planes[k + 3u * HDRP_CULL_PLANES_STRIDE] = plane.w;
    }
}

HDRP_API hdrp_result hdrp_cull_set_project(hdrp_cull_set* set, const hdrp_cull_shape* shapes,
                                           uint32_t first, uint32_t count)
{
    uint32_t i;
    float orthographic;
    if (!set || (!shapes && count > 0u)) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (hdrp_i_cull_bad_range(first, count, set->count)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    orthographic = set->camera.forward_orthographic.w;
    for (i = first; i < first + count; ++i) {
        hdrp_cull_shape s = hdrp_cull_shape_in_view(shapes[i], set->camera);
        set->shapes[i] = s;
        set->balls[i] = hdrp_cull_shape_ball(s);
        set->kinds[i] = (uint16_t)(hdrp_cull_shape_kind(s) | hdrp_cull_shape_category(s) << 8);
        set->bounds[i] =
            hdrp_cull_shape_bounds(s, set->camera, (float)set->width_px, (float)set->height_px);
        if (set->bounds[i].rect_px.x > set->bounds[i].rect_px.z) {
            continue; /* not seen: nobody asks for its planes */
        }
        if (!hdrp_i_cull_is_ball(set, i)) {
            hdrp_i_cull_project_planes(s, orthographic,
                                       set->planes + (size_t)i * 4u * HDRP_CULL_PLANES_STRIDE);
        }
    }
    return HDRP_OK;
}

/* ---- lists ----------------------------------------------------------------------------------- */

/* The descriptor with its defaults; width_px is 0 where it is not valid. */
static hdrp_cull_desc hdrp_i_cull_defaults(const hdrp_cull_desc* desc)
{
    hdrp_cull_desc d;
    memset(&d, 0, sizeof d);
    if (!desc) {
        return d;
    }
    d = *desc;
    d.tile_width_px = d.tile_width_px ? d.tile_width_px : 32u;
    d.tile_height_px = d.tile_height_px ? d.tile_height_px : 32u;
    d.slice_count = d.slice_count ? d.slice_count : 64u;
    d.shape_capacity = d.shape_capacity ? d.shape_capacity : 1024u;
    if (d.entry_capacity == 0u) {
        d.entry_capacity = d.slice_count > 8u ? 32u * d.slice_count : 256u;
    }
    d.flags |= (d.flags & HDRP_CULL_MASKS) ? HDRP_CULL_BLOCKS : 0u;
    d.flags |= (d.flags & HDRP_CULL_BLOCKS) ? HDRP_CULL_PIXELS : 0u;
    /* Fewer shapes to ask the pixels about save more than finding them out costs. */
    d.flags &= (d.flags & HDRP_CULL_PIXELS) ? ~HDRP_CULL_FAST : ~0u;
    if (d.width_px > HDRP_CULL_SIZE_MAX || d.height_px > HDRP_CULL_SIZE_MAX || d.height_px < 1u ||
        d.tile_width_px > HDRP_CULL_SIZE_MAX || d.tile_height_px > HDRP_CULL_SIZE_MAX ||
        d.slice_count > HDRP_CULL_SLICES_MAX || d.shape_capacity > HDRP_CULL_SHAPES_MAX ||
        d.entry_capacity < d.slice_count || d.entry_capacity > 65535u * d.slice_count ||
        d.flags > 31u || ((d.flags & HDRP_CULL_PIXELS) && d.slice_count > 1u) ||
        !(d.series_start_m >= 0.0f) || !(d.series_end_m >= 0.0f)) {
        d.width_px = 0u;
    }
    return d;
}

/* Words of a mask; 0 where there are none. */
static size_t hdrp_i_cull_words(const hdrp_cull_desc* d)
{
    size_t of_block = (size_t)((d->tile_width_px + 3u) / 4u) * ((d->tile_height_px + 3u) / 4u);
    return (d->flags & HDRP_CULL_MASKS) ? (of_block + 1u) / 2u : 0u;
}

/* Columns, rows and their product; 0 where cells, entries or masks are too many for 32 bits. */
static uint32_t hdrp_i_cull_tiles(const hdrp_cull_desc* d, uint32_t* columns, uint32_t* rows)
{
    uint64_t tiles;
    *columns = (d->width_px + d->tile_width_px - 1u) / d->tile_width_px;
    *rows = (d->height_px + d->tile_height_px - 1u) / d->tile_height_px;
    tiles = (uint64_t)*columns * *rows;
    return tiles * d->slice_count > 0xffffffffu ||
                   tiles * d->entry_capacity * (1u + hdrp_i_cull_words(d)) > 0xffffffffu
               ? 0u
               : (uint32_t)tiles;
}

HDRP_API hdrp_result hdrp_cull_desc_complete(const hdrp_cull_desc* desc, hdrp_cull_desc* complete)
{
    hdrp_cull_desc d = hdrp_i_cull_defaults(desc);
    uint32_t columns, rows;
    if (!desc || !complete) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (d.width_px == 0u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    if (hdrp_i_cull_tiles(&d, &columns, &rows) == 0u) {
        return HDRP_ERROR_TOO_LARGE;
    }
    *complete = d;
    return HDRP_OK;
}

static size_t hdrp_i_cull_place_lists(hdrp_cull_lists* lists, uint32_t tiles, void* memory)
{
    hdrp_i_cull_arena arena;
    size_t cells = (size_t)tiles * lists->desc.slice_count;
    size_t entries = (size_t)tiles * lists->desc.entry_capacity;
    arena.block = (unsigned char*)memory;
    arena.used = 0u;
    lists->tiles = (hdrp_v4*)hdrp_i_cull_take(&arena, tiles, sizeof *lists->tiles);
    lists->cells = (hdrp_u32x4*)hdrp_i_cull_take(&arena, cells, sizeof *lists->cells);
    lists->entries = (uint32_t*)hdrp_i_cull_take(&arena, entries, sizeof *lists->entries);
    lists->masks = NULL;
    if (lists->desc.flags & HDRP_CULL_MASKS) {
        lists->masks = (uint32_t*)hdrp_i_cull_take(
            &arena, entries * hdrp_i_cull_words(&lists->desc), sizeof *lists->masks);
    }
    lists->tile_dropped = (uint32_t*)hdrp_i_cull_take(&arena, tiles, sizeof *lists->tile_dropped);
    return arena.used;
}

HDRP_API size_t hdrp_cull_memory_size(const hdrp_cull_desc* desc)
{
    hdrp_cull_lists lists;
    uint32_t columns, rows, tiles;
    memset(&lists, 0, sizeof lists);
    lists.desc = hdrp_i_cull_defaults(desc);
    if (lists.desc.width_px == 0u) {
        return 0u;
    }
    tiles = hdrp_i_cull_tiles(&lists.desc, &columns, &rows);
    /* 4-byte words and 16-byte cells, on a target whose sizes have 32 bits. */
    if (tiles == 0u ||
        ((uint64_t)tiles * lists.desc.entry_capacity * 4u * (1u + hdrp_i_cull_words(&lists.desc)) +
         (uint64_t)tiles * lists.desc.slice_count * 16u + (uint64_t)tiles * 20u + 64u) >
            (uint64_t)(SIZE_MAX / 2u)) {
        return 0u;
    }
    return hdrp_i_cull_place_lists(&lists, tiles, NULL);
}

HDRP_API hdrp_result hdrp_cull_init(hdrp_cull_lists* lists, const hdrp_cull_desc* desc,
                                    void* memory, size_t memory_bytes)
{
    hdrp_cull_desc d = hdrp_i_cull_defaults(desc);
    size_t needed = hdrp_cull_memory_size(desc);
    uint32_t columns, rows, tiles;
    hdrp_result r;
    if (!lists || !desc) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (needed == 0u) {
        return d.width_px == 0u ? HDRP_ERROR_BAD_ARGUMENT : HDRP_ERROR_TOO_LARGE;
    }
    r = hdrp_i_cull_check_block(memory, memory_bytes, needed);
    if (r == HDRP_OK) {
        memset(lists, 0, sizeof *lists);
        lists->desc = d;
        tiles = hdrp_i_cull_tiles(&d, &columns, &rows);
        hdrp_i_cull_place_lists(lists, tiles, memory);
        lists->grid.tiles = hdrp_u32x4_make(d.tile_width_px, d.tile_height_px, columns, rows);
        memset(lists->tiles, 0, tiles * sizeof *lists->tiles);
        memset(lists->cells, 0, (size_t)tiles * d.slice_count * sizeof *lists->cells);
        memset(lists->tile_dropped, 0, tiles * sizeof *lists->tile_dropped);
    }
    return r;
}

HDRP_API hdrp_result hdrp_cull_begin(hdrp_cull_lists* lists, const hdrp_cull_set* set)
{
    const hdrp_cull_desc* d;
    hdrp_v4 unknown;
    size_t i, tiles;
    if (!lists || !set) {
        return HDRP_ERROR_NULL_POINTER;
    }
    d = &lists->desc;
    if (set->width_px != d->width_px || set->height_px != d->height_px) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    lists->camera = set->camera;
    lists->grid = hdrp_cull_grid_make(
        set->camera, hdrp_u32x4_make(d->width_px, d->height_px, d->slice_count, d->entry_capacity),
        hdrp_u32x4_make(d->tile_width_px, d->tile_height_px, 0u, 0u), d->series_start_m,
        d->series_end_m);
    unknown =
        hdrp_v4_make(set->camera.eye_near.w, set->camera.right_far.w, lists->grid.series.w, 0.0f);
    tiles = (size_t)lists->grid.tiles.z * lists->grid.tiles.w;
    for (i = 0u; i < tiles; ++i) {
        lists->tiles[i] = unknown;
    }
    memset(lists->cells, 0, tiles * d->slice_count * sizeof *lists->cells);
    memset(lists->tile_dropped, 0, tiles * sizeof *lists->tile_dropped);
    return HDRP_OK;
}

/* ---- depth ----------------------------------------------------------------------------------- */

/* Pixels of a row that are read together. */
#define HDRP_I_CULL_RUN 64u

HDRP_FN void hdrp_i_cull_read_device(hdrp_depth_params device, const hdrp_cull_camera* camera,
                                     const float* texels, uint32_t count, float* z)
{
    float near_m = camera->eye_near.w, far_m = camera->right_far.w;
    uint32_t i;
    HDRP_I_CULL_INDEPENDENT
    for (i = 0u; i < count; ++i) {
        z[i] = hdrp_cull_opaque_depth(hdrp_view_depth(device, texels[i]), near_m, far_m);
    }
}

HDRP_FN void hdrp_i_cull_read_metres(const hdrp_cull_camera* camera, const float* texels,
                                     uint32_t count, float* z)
{
    float near_m = camera->eye_near.w, far_m = camera->right_far.w;
    uint32_t i;
    HDRP_I_CULL_INDEPENDENT
    for (i = 0u; i < count; ++i) {
        z[i] = hdrp_cull_opaque_depth(texels[i], near_m, far_m);
    }
}

static void hdrp_i_cull_read(const hdrp_cull_depth* depth, const hdrp_cull_camera* camera,
                             const float* texels, uint32_t count, float* z)
{
    if (depth->device) {
        hdrp_i_cull_read_device(*depth->device, camera, texels, count, z);
    } else {
        hdrp_i_cull_read_metres(camera, texels, count, z);
    }
}

/* Widens the range of each column of a run. */
HDRP_FN void hdrp_i_cull_widen(const float* z, uint32_t count, float* nearest, float* farthest)
{
    uint32_t i;
    HDRP_I_CULL_INDEPENDENT
    for (i = 0u; i < count; ++i) {
        float there = z[i] >= 0.0f ? z[i] : HDRP_FLT_MAX;
        nearest[i] = there < nearest[i] ? there : nearest[i];
        farthest[i] = z[i] > farthest[i] ? z[i] : farthest[i];
    }
}

/* The ranges of a row of tiles, in which y and z are the pixels of the row. */
static void hdrp_i_cull_depth_row(hdrp_cull_lists* lists, const hdrp_cull_depth* depth,
                                  uint32_t row)
{
    hdrp_v4* tiles = lists->tiles + (size_t)row * lists->grid.tiles.z;
    uint32_t y0 = row * lists->grid.tiles.y, y1 = y0 + lists->grid.tiles.y,
             width = lists->desc.width_px;
    uint32_t x, y, i, column = 0u;
    uint32_t one_series = (lists->desc.flags & HDRP_CULL_ONE_SERIES) != 0u;
    float lo = HDRP_FLT_MAX, hi = -1.0f;
    y1 = y1 < lists->desc.height_px ? y1 : lists->desc.height_px;
    for (x = 0u; x < width; x += HDRP_I_CULL_RUN) {
        uint32_t count = width - x < HDRP_I_CULL_RUN ? width - x : HDRP_I_CULL_RUN;
        float z[HDRP_I_CULL_RUN], nearest[HDRP_I_CULL_RUN], farthest[HDRP_I_CULL_RUN];
        for (i = 0u; i < count; ++i) {
            nearest[i] = HDRP_FLT_MAX;
            farthest[i] = -1.0f;
        }
        for (y = y0; y < y1; ++y) {
            hdrp_i_cull_read(depth, &lists->camera, depth->texels + y * depth->row_stride + x,
                             count, z);
            hdrp_i_cull_widen(z, count, nearest, farthest);
        }
        for (i = 0u; i < count; ++i) {
            lo = hdrp_min(nearest[i], lo);
            hi = hdrp_max(farthest[i], hi);
            if ((x + i + 1u) % lists->grid.tiles.x == 0u || x + i + 1u == width) {
                tiles[column++] = hdrp_cull_tile_of_depths(lists->grid, lo, hi, one_series);
                lo = HDRP_FLT_MAX;
                hi = -1.0f;
            }
        }
    }
}

HDRP_API hdrp_result hdrp_cull_measure_depth(hdrp_cull_lists* lists, const hdrp_cull_depth* depth,
                                             uint32_t first_row, uint32_t row_count)
{
    uint32_t row;
    if (!lists || !depth || !depth->texels) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (hdrp_i_cull_bad_range(first_row, row_count, lists->grid.tiles.w) ||
        depth->row_stride < lists->desc.width_px) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (row = first_row; row < first_row + row_count; ++row) {
        hdrp_i_cull_depth_row(lists, depth, row);
    }
    return HDRP_OK;
}

/* ---- lists of a tile --------------------------------------------------------------------------
 * A coarse cell is a block of tiles. What is seen in it is a candidate for each of its tiles; what
 * a tile finds among the candidates is a hit. Both lie in arrays of their own, one for each member,
 * so that compilers test several of them at once. */

typedef struct hdrp_i_cull_scratch {
    uint16_t* coarse;       /* shapes of each coarse cell of a row */
    uint32_t* coarse_count; /* how many */
    /* Candidates: the shape, its rectangle in pixels, depths, ball, and its depths in a tile. */
    uint16_t* candidate;
    float *left, *upper, *right, *lower, *nearest, *farthest;
    float *x, *y, *z, *radius;
    float *tile_nearest, *tile_farthest;
    uint8_t* is_ball;
    uint8_t* around; /* 1 for a ball around all that the tile shows */
    /* Hits: the shape, which candidate it is, its depths in the tile, its slices. */
    uint16_t *hit, *origin;
    float *hit_nearest, *hit_farthest;
    uint8_t *hit_first, *hit_last;
    uint16_t* blocks; /* what it reaches */
    uint32_t* masks;  /* the pixels that it reaches */
    uint16_t* keep;   /* 0 where there is no room */
    uint64_t* order;  /* by importance */
    /* Pixels of a tile. */
    float *local_x, *local_y, *pixel_x, *pixel_y, *pixel_z;
    float *row, *column_nearest, *column_farthest;
    size_t mask_words;
    uint32_t capacity;
} hdrp_i_cull_scratch;

/* What the functions of a tile share. */
typedef struct hdrp_i_cull_job {
    hdrp_cull_lists* lists;
    const hdrp_cull_set* set;
    const hdrp_cull_depth* depth;
    hdrp_i_cull_scratch s;
    uint32_t coarse_columns, coarse_rows;             /* tiles of a coarse cell */
    uint32_t present;                                 /* a bit for each category */
    uint32_t candidate_end[HDRP_CULL_CATEGORY_COUNT]; /* of each category */
    uint32_t hit_end[HDRP_CULL_CATEGORY_COUNT];
    uint32_t hit_count;
    int all_balls;           /* no candidate has planes */
    uint32_t x0, y0, x1, y1; /* of the tile, in px */
    hdrp_v4 rect_px;         /* the same as floats */
} hdrp_i_cull_job;

static float* hdrp_i_cull_floats(hdrp_i_cull_arena* arena, size_t count)
{
    return (float*)hdrp_i_cull_take(arena, count, sizeof(float));
}

static size_t hdrp_i_cull_place_scratch(hdrp_i_cull_scratch* s, const hdrp_cull_desc* d,
                                        uint32_t columns, void* memory)
{
    hdrp_i_cull_arena a;
    size_t n = ((size_t)d->shape_capacity + 7u) & ~(size_t)7u;
    size_t across = (columns + hdrp_cull_coarse_tiles(d->tile_width_px) - 1u) /
                    hdrp_cull_coarse_tiles(d->tile_width_px);
    size_t pixels = 0u, across_px = 0u;
    float** of_shapes[] = {&s->left,
                           &s->upper,
                           &s->right,
                           &s->lower,
                           &s->nearest,
                           &s->farthest,
                           &s->x,
                           &s->y,
                           &s->z,
                           &s->radius,
                           &s->tile_nearest,
                           &s->tile_farthest,
                           &s->hit_nearest,
                           &s->hit_farthest};
    uint16_t** indices[] = {&s->candidate, &s->hit, &s->origin, &s->blocks, &s->keep};
    uint8_t** bytes[] = {&s->is_ball, &s->around, &s->hit_first, &s->hit_last};
    size_t i;
    a.block = (unsigned char*)memory;
    a.used = 0u;
    if (d->flags & HDRP_CULL_PIXELS) {
        across_px = (d->tile_width_px + 3u) / 4u * 4u;
        pixels = across_px * ((d->tile_height_px + 3u) / 4u * 4u);
    }
    s->capacity = d->shape_capacity;
    s->coarse = (uint16_t*)hdrp_i_cull_take(&a, across * n, sizeof(uint16_t));
    s->coarse_count = (uint32_t*)hdrp_i_cull_take(&a, across, sizeof(uint32_t));
    for (i = 0u; i < sizeof of_shapes / sizeof of_shapes[0]; ++i) {
        *of_shapes[i] = hdrp_i_cull_floats(&a, n);
    }
    for (i = 0u; i < sizeof indices / sizeof indices[0]; ++i) {
        *indices[i] = (uint16_t*)hdrp_i_cull_take(&a, n, sizeof(uint16_t));
    }
    for (i = 0u; i < sizeof bytes / sizeof bytes[0]; ++i) {
        *bytes[i] = (uint8_t*)hdrp_i_cull_take(&a, n, 1u);
    }
    s->order = (uint64_t*)hdrp_i_cull_take(&a, n, sizeof(uint64_t));
    s->local_x = hdrp_i_cull_floats(&a, pixels);
    s->local_y = hdrp_i_cull_floats(&a, pixels);
    s->pixel_x = hdrp_i_cull_floats(&a, pixels);
    s->pixel_y = hdrp_i_cull_floats(&a, pixels);
    s->pixel_z = hdrp_i_cull_floats(&a, pixels);
    s->row = hdrp_i_cull_floats(&a, across_px);
    s->column_nearest = hdrp_i_cull_floats(&a, across_px);
    s->column_farthest = hdrp_i_cull_floats(&a, across_px);
    s->mask_words = hdrp_i_cull_words(d);
    s->masks = (uint32_t*)hdrp_i_cull_take(&a, n * s->mask_words, sizeof(uint32_t));
    return a.used;
}

HDRP_API size_t hdrp_cull_scratch_size(const hdrp_cull_desc* desc)
{
    hdrp_cull_desc d = hdrp_i_cull_defaults(desc);
    hdrp_i_cull_scratch s;
    uint32_t columns, rows;
    if (d.width_px == 0u || hdrp_i_cull_tiles(&d, &columns, &rows) == 0u) {
        return 0u;
    }
    /* More than 20 words for each shape, with its mask, and 8 for each pixel of a tile. */
    if ((uint64_t)d.shape_capacity * (30u + columns + hdrp_i_cull_words(&d)) * 4u +
            ((uint64_t)d.tile_width_px + 3u) * (d.tile_height_px + 3u) * 32u >
        (uint64_t)(SIZE_MAX / 2u)) {
        return 0u;
    }
    return hdrp_i_cull_place_scratch(&s, &d, columns, NULL);
}

HDRP_API uint32_t hdrp_cull_rows(const hdrp_cull_lists* lists)
{
    uint32_t tiles = lists ? hdrp_cull_coarse_tiles(lists->desc.tile_height_px) : 1u;
    return lists ? (lists->grid.tiles.w + tiles - 1u) / tiles : 0u;
}

/* The coarse cell of a place, as hdrp_cull_bounds_in_cell compares: a quotient may be rounded up to
 * the next one. */
static uint32_t hdrp_i_cull_cell_of(float x_px, float cell_px)
{
    float x = hdrp_max(x_px, 0.0f);
    uint32_t cell = (uint32_t)(x / cell_px);
    return cell - ((float)cell * cell_px > x ? 1u : 0u);
}

/* Appends a shape to the coarse cells of a row that its rectangle reaches. */
static void hdrp_i_cull_spread(hdrp_i_cull_job* job, uint32_t i, uint32_t across)
{
    hdrp_v4 rect = job->set->bounds[i].rect_px;
    float cell_px = (float)(job->coarse_columns * job->lists->grid.tiles.x);
    uint32_t first = hdrp_i_cull_cell_of(rect.x, cell_px),
             last = hdrp_i_cull_cell_of(rect.z, cell_px);
    last = last < across ? last : across - 1u;
    for (; first <= last; ++first) {
        job->s.coarse[(size_t)first * job->s.capacity + job->s.coarse_count[first]++] = (uint16_t)i;
    }
}

/* Shapes of each coarse cell of a row, by category and index. */
static void hdrp_i_cull_collect(hdrp_i_cull_job* job, uint32_t coarse_row, uint32_t across)
{
    const hdrp_cull_set* set = job->set;
    uint32_t tile_rows = job->coarse_rows * job->lists->grid.tiles.y;
    float upper = (float)(coarse_row * tile_rows), lower = (float)((coarse_row + 1u) * tile_rows);
    uint32_t category, i;
    memset(job->s.coarse_count, 0, across * sizeof *job->s.coarse_count);
    for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        for (i = 0u; job->present >> category & 1u && i < set->count; ++i) {
            const hdrp_cull_bounds* b = &set->bounds[i];
            if (b->rect_px.y <= lower && b->rect_px.w >= upper && b->rect_px.x <= b->rect_px.z &&
                hdrp_i_cull_category(set, i) == category) {
                hdrp_i_cull_spread(job, i, across);
            }
        }
    }
}

/* Arrays are as long as whole vectors, so that no loop has a rest to be done one by one. */
#define HDRP_I_CULL_WHOLE(count) (((count) + 7u) & ~7u)

/* The shapes of a coarse cell become candidates. */
static void hdrp_i_cull_gather(hdrp_i_cull_job* job, uint32_t column)
{
    hdrp_i_cull_scratch* s = &job->s;
    const uint16_t* shapes = s->coarse + (size_t)column * s->capacity;
    uint32_t count = s->coarse_count[column], m, category;
    memset(job->candidate_end, 0, sizeof job->candidate_end);
    job->all_balls = 1;
    for (m = 0u; m < count; ++m) {
        uint32_t i = shapes[m];
        const hdrp_cull_bounds* b = &job->set->bounds[i];
        const hdrp_v4* ball = &job->set->balls[i];
        s->candidate[m] = (uint16_t)i;
        s->left[m] = b->rect_px.x;
        s->upper[m] = b->rect_px.y;
        s->right[m] = b->rect_px.z;
        s->lower[m] = b->rect_px.w;
        s->nearest[m] = b->nearest;
        s->farthest[m] = b->farthest;
        s->x[m] = ball->x;
        s->y[m] = ball->y;
        s->z[m] = ball->z;
        s->radius[m] = ball->w;
        s->is_ball[m] = hdrp_i_cull_is_ball(job->set, i) ? 1u : 0u;
        job->all_balls &= s->is_ball[m];
        job->candidate_end[hdrp_i_cull_category(job->set, i)] = m + 1u;
    }
    for (; m < HDRP_I_CULL_WHOLE(count); ++m) {
        s->left[m] = s->upper[m] = s->right[m] = s->lower[m] = 0.0f;
        s->nearest[m] = s->farthest[m] = 0.0f;
        s->x[m] = s->y[m] = s->z[m] = s->radius[m] = 0.0f;
    }
    for (category = 1u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        if (job->candidate_end[category] < job->candidate_end[category - 1u]) {
            job->candidate_end[category] = job->candidate_end[category - 1u];
        }
    }
}

/* ---- tests of candidates --------------------------------------------------------------------- */

/* The depths of a candidate that are among those of a rectangle; none where the rectangles do not
 * overlap. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_overlap(const hdrp_i_cull_scratch* s, uint32_t m,
                                               hdrp_v4 rect_px, hdrp_cull_interval seen)
{
    hdrp_cull_bounds b;
    b.rect_px = hdrp_v4_make(s->left[m], s->upper[m], s->right[m], s->lower[m]);
    b.nearest = s->nearest[m];
    b.farthest = s->farthest[m];
    return hdrp_cull_bounds_in_rect(b, rect_px, seen);
}

/* What is left of the depths of a candidate inside its ball. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_in_ball(const hdrp_i_cull_scratch* s, uint32_t m,
                                               hdrp_cull_interval depths, hdrp_cull_tile tile,
                                               float orthographic)
{
    hdrp_v4 ball = hdrp_v4_make(s->x[m], s->y[m], s->z[m], s->radius[m]);
    return hdrp_cull_interval_within(depths, hdrp_cull_interval_ball(tile, ball, orthographic));
}

/* The depths of each candidate in a tile: none where nearest > farthest. */
static void hdrp_i_cull_test_bounds(const hdrp_i_cull_job* job, hdrp_cull_interval seen)
{
    const hdrp_i_cull_scratch s = job->s; /* whose pointers no store can change */
    hdrp_v4 rect_px = job->rect_px;
    uint32_t count = HDRP_I_CULL_WHOLE(job->candidate_end[HDRP_CULL_CATEGORY_COUNT - 1u]), m;
    HDRP_I_CULL_INDEPENDENT
    for (m = 0u; m < count; ++m) {
        hdrp_cull_interval r = hdrp_i_cull_overlap(&s, m, rect_px, seen);
        s.tile_nearest[m] = r.nearest;
        s.tile_farthest[m] = r.farthest;
    }
}

/* The same inside their balls. A constant projection leaves a loop without the other in it. */
HDRP_FN void hdrp_i_cull_test_balls(const hdrp_i_cull_job* job, hdrp_cull_tile tile,
                                    hdrp_cull_interval seen, float orthographic)
{
    const hdrp_i_cull_scratch s = job->s;
    hdrp_v4 rect_px = job->rect_px;
    uint32_t count = HDRP_I_CULL_WHOLE(job->candidate_end[HDRP_CULL_CATEGORY_COUNT - 1u]), m;
    HDRP_I_CULL_INDEPENDENT
    for (m = 0u; m < count; ++m) {
        hdrp_cull_interval r = hdrp_i_cull_overlap(&s, m, rect_px, seen);
        r = hdrp_i_cull_in_ball(&s, m, r, tile, orthographic);
        s.tile_nearest[m] = r.nearest;
        s.tile_farthest[m] = r.farthest;
    }
}

/* The candidates that have depths in the tile become hits. */
static void hdrp_i_cull_select(hdrp_i_cull_job* job)
{
    const hdrp_i_cull_scratch s = job->s;
    uint32_t m = 0u, n = 0u, category;
    for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        for (; m < job->candidate_end[category]; ++m) {
            /* Written in any case: whether it stays is hard to predict. */
            float nearest = s.tile_nearest[m], farthest = s.tile_farthest[m];
            s.hit[n] = s.candidate[m];
            s.origin[n] = (uint16_t)m;
            s.hit_nearest[n] = nearest;
            s.hit_farthest[n] = farthest;
            n += nearest <= farthest ? 1u : 0u;
        }
        job->hit_end[category] = n;
    }
    job->hit_count = n;
}

/* Shortens the interval of a hit by the planes of its shape, all of them at once. */
static hdrp_cull_interval hdrp_i_cull_in_planes(const hdrp_i_cull_job* job, uint32_t i,
                                                hdrp_cull_interval depths, hdrp_cull_tile tile,
                                                float orthographic)
{
    float nearest[HDRP_CULL_PLANES_STRIDE], farthest[HDRP_CULL_PLANES_STRIDE];
    const float* x = job->set->planes + (size_t)i * 4u * HDRP_CULL_PLANES_STRIDE;
    const float* y = x + HDRP_CULL_PLANES_STRIDE;
    const float* z = y + HDRP_CULL_PLANES_STRIDE;
    const float* w = z + HDRP_CULL_PLANES_STRIDE;
    hdrp_cull_interval both;
    uint32_t k, half_count;
    HDRP_I_CULL_INDEPENDENT
    for (k = 0u; k < HDRP_CULL_PLANES_STRIDE; ++k) {
        hdrp_cull_interval r;
        r.nearest = 0.0f;
        r.farthest = HDRP_FLT_MAX;
        r = hdrp_cull_interval_plane(r, tile, hdrp_v4_make(x[k], y[k], z[k], w[k]), orthographic);
        nearest[k] = r.nearest;
        farthest[k] = r.farthest;
    }
    for (half_count = HDRP_CULL_PLANES_STRIDE / 2u; half_count > 0u; half_count /= 2u) {
        for (k = 0u; k < half_count; ++k) {
            nearest[k] = hdrp_max(nearest[k + half_count], nearest[k]);
            farthest[k] = hdrp_min(farthest[k + half_count], farthest[k]);
        }
    }
    both.nearest = nearest[0];
    both.farthest = farthest[0];
    return hdrp_cull_interval_within(depths, both);
}

/* Drops the hits whose planes keep them out of the tile. */
static void hdrp_i_cull_test_planes(hdrp_i_cull_job* job, hdrp_cull_tile tile, float orthographic)
{
    const hdrp_i_cull_scratch s = job->s;
    uint32_t h = 0u, n = 0u, category;
    for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        for (; h < job->hit_end[category]; ++h) {
            hdrp_cull_interval r;
            r.nearest = s.hit_nearest[h];
            r.farthest = s.hit_farthest[h];
            if (!s.is_ball[s.origin[h]]) {
                r = hdrp_i_cull_in_planes(job, s.hit[h], r, tile, orthographic);
            }
            s.hit[n] = s.hit[h];
            s.origin[n] = s.origin[h];
            s.hit_nearest[n] = r.nearest;
            s.hit_farthest[n] = r.farthest;
            n += r.nearest <= r.farthest ? 1u : 0u;
        }
        job->hit_end[category] = n;
    }
    job->hit_count = n;
}

/* The shapes that reach the rectangle between two depths become hits; where its pixels will be
 * asked, those of balls that may reach it. */
static void hdrp_i_cull_find(hdrp_i_cull_job* job, hdrp_cull_tile tile, float lo, float hi,
                             int pixels)
{
    float orthographic = job->lists->camera.forward_orthographic.w;
    uint32_t fast = job->lists->desc.flags & HDRP_CULL_FAST;
    hdrp_cull_interval seen = hdrp_cull_interval_seen(lo, hi);
    if (fast || pixels) {
        hdrp_i_cull_test_bounds(job, seen);
    } else if (orthographic > 0.0f) {
        hdrp_i_cull_test_balls(job, tile, seen, 1.0f);
    } else {
        hdrp_i_cull_test_balls(job, tile, seen, 0.0f);
    }
    hdrp_i_cull_select(job);
    if (!fast && !job->all_balls) {
        hdrp_i_cull_test_planes(job, tile, orthographic);
    }
}

/* ---- pixels ---------------------------------------------------------------------------------- */

/* The pixels of a tile lie block by block, sixteen of them, each row by row. Blocks at the edges of
 * the picture are as large as others: the depth of what is beyond is negative, as that of sky. */

/* Where each of the pixels is in the tile: the same for all tiles. */
static void hdrp_i_cull_place_pixels(const hdrp_i_cull_job* job)
{
    uint32_t width = job->lists->grid.cells.z, height = job->lists->grid.cells.w, block, x, y;
    size_t n = 0u;
    for (block = 0u; block < HDRP_CULL_BLOCK_COUNT; ++block) {
        for (y = 0u; y < height; ++y) {
            for (x = 0u; x < width; ++x, ++n) {
                job->s.local_x[n] = (float)(int)(block % 4u * width + x);
                job->s.local_y[n] = (float)(int)(block / 4u * height + y);
            }
        }
    }
}

/* Moves a row of a tile to its four blocks. */
static void hdrp_i_cull_scatter(const float* row, uint32_t width, uint32_t of_block, float* z)
{
    uint32_t block, x;
    for (block = 0u; block < 4u; ++block, z += of_block, row += width) {
        if (width == 4u) { /* as in tiles of 16 pixels: without a loop */
            memcpy(z, row, 4u * sizeof *z);
            continue;
        }
        for (x = 0u; x < width; ++x) {
            z[x] = row[x];
        }
    }
}

/* The nearest and the farthest depth of each block. */
typedef struct hdrp_i_cull_ranges {
    float nearest[HDRP_CULL_BLOCK_COUNT], farthest[HDRP_CULL_BLOCK_COUNT];
} hdrp_i_cull_ranges;

/* Those of a band of four blocks, from those of its columns. */
static void hdrp_i_cull_reduce_band(const hdrp_i_cull_scratch* s, uint32_t width, uint32_t band,
                                    hdrp_i_cull_ranges* ranges)
{
    uint32_t block, x;
    for (block = 0u; block < 4u; ++block) {
        float nearest = s->column_nearest[block * width],
              farthest = s->column_farthest[block * width];
        for (x = block * width + 1u; x < (block + 1u) * width; ++x) {
            nearest = hdrp_min(s->column_nearest[x], nearest);
            farthest = hdrp_max(s->column_farthest[x], farthest);
        }
        ranges->nearest[4u * band + block] = nearest;
        ranges->farthest[4u * band + block] = farthest;
    }
}

/* Reads a row of pixels of a tile. */
HDRP_FN void hdrp_i_cull_read_row(const hdrp_i_cull_job* job, uint32_t y, uint32_t columns)
{
    const hdrp_i_cull_scratch s = job->s;
    hdrp_i_cull_read(job->depth, &job->lists->camera,
                     job->depth->texels + (job->y0 + y) * job->depth->row_stride + job->x0, columns,
                     s.row);
    hdrp_i_cull_widen(s.row, columns, s.column_nearest, s.column_farthest);
}

/* Depths of a tile. */
static void hdrp_i_cull_read_depth(const hdrp_i_cull_job* job, hdrp_i_cull_ranges* ranges)
{
    const hdrp_i_cull_scratch* s = &job->s;
    uint32_t width = job->lists->grid.cells.z, height = job->lists->grid.cells.w;
    uint32_t of_block = width * height, columns = job->x1 - job->x0, rows = job->y1 - job->y0;
    uint32_t band, y, i;
    for (i = 0u; i < 4u * width; ++i) {
        s->row[i] = -1.0f;
    }
    for (band = 0u; band < 4u; ++band) {
        for (i = 0u; i < 4u * width; ++i) {
            s->column_nearest[i] = HDRP_FLT_MAX;
            s->column_farthest[i] = -1.0f;
        }
        for (y = band * height; y < (band + 1u) * height; ++y) {
            if (y < rows && columns == 16u) { /* as in most tiles: loops of known length */
                hdrp_i_cull_read_row(job, y, 16u);
            } else if (y < rows) {
                hdrp_i_cull_read_row(job, y, columns);
            } else {
                memset(s->row, 0xff, 4u * width * sizeof *s->row); /* NaN: not seen either */
            }
            hdrp_i_cull_scatter(s->row, width, of_block,
                                s->pixel_z + (size_t)(band * 4u) * of_block +
                                    (y - band * height) * width);
        }
        hdrp_i_cull_reduce_band(s, width, band, ranges);
    }
}

/* Places of the pixels' centres, in view space. */
static void hdrp_i_cull_read_pixels(const hdrp_i_cull_job* job, hdrp_i_cull_ranges* ranges)
{
    const hdrp_cull_lists* lists = job->lists;
    const float* local_x = job->s.local_x;
    const float* local_y = job->s.local_y;
    const float* z = job->s.pixel_z;
    float* x = job->s.pixel_x;
    float* y = job->s.pixel_y;
    hdrp_cull_camera camera = lists->camera;
    hdrp_v2 size = hdrp_v2_make(camera.window.z / (float)lists->desc.width_px,
                                camera.window.w / (float)lists->desc.height_px);
    float x0 = (float)job->x0 + 0.5f;
    float y0 = (float)lists->desc.height_px - (float)job->y0 - 0.5f;
    uint32_t count = HDRP_CULL_BLOCK_COUNT * lists->grid.cells.z * lists->grid.cells.w, i;
    hdrp_i_cull_read_depth(job, ranges);
    HDRP_I_CULL_INDEPENDENT
    for (i = 0u; i < count; ++i) {
        hdrp_v3 p = hdrp_cull_pixel_in_view(camera, size, x0 + local_x[i], y0 - local_y[i], z[i]);
        x[i] = p.x;
        y[i] = p.y;
    }
}

/* Boxes around what the blocks of a tile show. */
typedef struct hdrp_i_cull_boxes {
    float x0[HDRP_CULL_BLOCK_COUNT], x1[HDRP_CULL_BLOCK_COUNT];
    float y0[HDRP_CULL_BLOCK_COUNT], y1[HDRP_CULL_BLOCK_COUNT];
    float z0[HDRP_CULL_BLOCK_COUNT], z1[HDRP_CULL_BLOCK_COUNT];
} hdrp_i_cull_boxes;

static void hdrp_i_cull_box_blocks(const hdrp_i_cull_job* job, const hdrp_cull_tile* tile,
                                   const hdrp_i_cull_ranges* ranges, hdrp_i_cull_boxes* boxes)
{
    const hdrp_cull_lists* lists = job->lists;
    hdrp_v4 w = lists->camera.window;
    hdrp_v2 size = hdrp_v2_make(w.z / (float)lists->desc.width_px * (float)lists->grid.cells.z,
                                w.w / (float)lists->desc.height_px * (float)lists->grid.cells.w);
    uint32_t block;
    for (block = 0u; block < HDRP_CULL_BLOCK_COUNT; ++block) {
        hdrp_cull_interval depths;
        hdrp_cull_box b;
        depths.nearest = ranges->nearest[block];
        depths.farthest = ranges->farthest[block];
        b = hdrp_cull_block_box(tile->window, size, block, depths,
                                lists->camera.forward_orthographic.w);
        boxes->x0[block] = b.low.x;
        boxes->x1[block] = b.high.x;
        boxes->y0[block] = b.low.y;
        boxes->y1[block] = b.high.y;
        boxes->z0[block] = b.low.z;
        boxes->z1[block] = b.high.z;
    }
}

/* The blocks that a ball may reach, a bit for each; in the upper half those that it contains. */
static uint32_t hdrp_i_cull_ball_in_blocks(const hdrp_i_cull_boxes* b, hdrp_v4 ball)
{
    uint32_t found = 0u, i;
    HDRP_I_CULL_INDEPENDENT
    for (i = 0u; i < HDRP_CULL_BLOCK_COUNT; ++i) {
        hdrp_cull_box box;
        box.low = hdrp_v3_make(b->x0[i], b->y0[i], b->z0[i]);
        box.high = hdrp_v3_make(b->x1[i], b->y1[i], b->z1[i]);
        found |= hdrp_cull_box_in_ball(box, ball) << i;
    }
    return found;
}

/* Marks the candidates whose ball contains all that a tile shows: the box around it. */
static void hdrp_i_cull_balls_around_tile(const hdrp_i_cull_job* job, const hdrp_cull_tile* tile,
                                          hdrp_v4 info)
{
    const hdrp_i_cull_scratch s = job->s;
    uint32_t count = HDRP_I_CULL_WHOLE(job->candidate_end[HDRP_CULL_CATEGORY_COUNT - 1u]), m;
    hdrp_cull_interval depths;
    hdrp_cull_box box;
    depths.nearest = info.x;
    depths.farthest = info.y;
    box = hdrp_cull_window_box(tile->window, depths, job->lists->camera.forward_orthographic.w);
    HDRP_I_CULL_INDEPENDENT
    for (m = 0u; m < count; ++m) {
        hdrp_v4 ball = hdrp_v4_make(s.x[m], s.y[m], s.z[m], s.radius[m]);
        s.around[m] = (uint8_t)(hdrp_cull_box_in_ball(box, ball) >> 16);
    }
}

/* The same for those whose ball contains one of four pixels, which most do that reach any. */
static void hdrp_i_cull_balls_around_pixels(const hdrp_i_cull_job* job)
{
    const hdrp_i_cull_scratch s = job->s;
    uint32_t width = job->lists->grid.cells.z, height = job->lists->grid.cells.w;
    uint32_t count = HDRP_I_CULL_WHOLE(job->candidate_end[HDRP_CULL_CATEGORY_COUNT - 1u]), m, k;
    hdrp_v3 pixels[4];
    for (k = 0u; k < 4u; ++k) { /* in the middle of the blocks at the corners */
        uint32_t at = ((k / 2u * 12u + k % 2u * 3u) * height + height / 2u) * width + width / 2u;
        float far_m = s.pixel_z[at] >= 0.0f ? 0.0f : 2.0f * HDRP_LIGHT_RANGE_INFINITE; /* sky */
        pixels[k] = hdrp_v3_make(s.pixel_x[at] + far_m, s.pixel_y[at], s.pixel_z[at]);
    }
    HDRP_I_CULL_INDEPENDENT
    for (m = 0u; m < count; ++m) {
        hdrp_v4 c = hdrp_v4_make(s.x[m], s.y[m], s.z[m], 0.0f);
        float a = hdrp_cull_distance_sq(c, pixels[0]), b = hdrp_cull_distance_sq(c, pixels[1]);
        float d = hdrp_cull_distance_sq(c, pixels[2]), e = hdrp_cull_distance_sq(c, pixels[3]);
        float nearest2 = hdrp_min(hdrp_min(a, b), hdrp_min(d, e));
        s.around[m] = (uint8_t)(s.around[m] | (nearest2 <= s.radius[m] * s.radius[m] ? 1u : 0u));
    }
}

/* Which of some pixels, at most 32, a shape of a kind reaches, a bit for each. A constant kind
 * leaves a loop without the other ones in it. */
HDRP_FN uint32_t hdrp_i_cull_reach_kind(const hdrp_i_cull_scratch* s, hdrp_cull_shape shape,
                                        hdrp_u32 kind, uint32_t first, uint32_t count)
{
    const float* x = s->pixel_x + first;
    const float* y = s->pixel_y + first;
    const float* z = s->pixel_z + first;
    uint32_t reached = 0u, i;
    shape.bits.x = kind;
    HDRP_I_CULL_INDEPENDENT
    for (i = 0u; i < count; ++i) {
        float in = hdrp_cull_shape_contains(shape, hdrp_v3_make(x[i], y[i], z[i]));
        float seen = z[i] >= 0.0f ? in : 0.0f;
        reached |= (seen > 0.0f ? 1u : 0u) << i;
    }
    return reached;
}

static uint32_t hdrp_i_cull_reach(const hdrp_i_cull_scratch* s, const hdrp_cull_shape* shape,
                                  uint32_t first, uint32_t count)
{
    switch (hdrp_cull_shape_kind(*shape)) {
    case HDRP_CULL_KIND_BALL:
        return hdrp_i_cull_reach_kind(s, *shape, HDRP_CULL_KIND_BALL, first, count);
    case HDRP_CULL_KIND_CONE:
        return hdrp_i_cull_reach_kind(s, *shape, HDRP_CULL_KIND_CONE, first, count);
    case HDRP_CULL_KIND_PYRAMID:
        return hdrp_i_cull_reach_kind(s, *shape, HDRP_CULL_KIND_PYRAMID, first, count);
    case HDRP_CULL_KIND_BOX:
        return hdrp_i_cull_reach_kind(s, *shape, HDRP_CULL_KIND_BOX, first, count);
    default:
        return hdrp_i_cull_reach_kind(s, *shape, HDRP_CULL_KIND_FRONT, first, count);
    }
}

/* Notes pixels, at most 32 from one on, in a mask. */
static void hdrp_i_cull_note(uint32_t* mask, uint32_t first, uint32_t pixels)
{
    uint32_t shift = first % 32u;
    mask[first / 32u] |= pixels << shift;
    if (shift > 0u && pixels >> (32u - shift) > 0u) {
        mask[first / 32u + 1u] |= pixels >> (32u - shift);
    }
}

/* Whether a shape reaches a pixel of a block; notes which, or all of them where that is known. */
static uint32_t hdrp_i_cull_ask_block(const hdrp_i_cull_job* job, uint32_t i, uint32_t block,
                                      int inside, uint32_t* mask)
{
    uint32_t of_block = job->lists->grid.cells.z * job->lists->grid.cells.w, any = 0u, at;
    for (at = block * of_block; at < (block + 1u) * of_block; at += 32u) {
        uint32_t left = (block + 1u) * of_block - at, count = left < 32u ? left : 32u;
        uint32_t pixels = inside ? 0xffffffffu >> (32u - count)
                                 : hdrp_i_cull_reach(&job->s, &job->set->shapes[i], at, count);
        any |= pixels;
        if (job->s.mask_words > 0u) {
            hdrp_i_cull_note(mask, at, pixels);
        } else if (any > 0u) {
            break;
        }
    }
    return any > 0u ? 1u : 0u;
}

static void hdrp_i_cull_fill_mask(uint32_t* mask, size_t words, uint32_t word)
{
    size_t i;
    for (i = 0u; i < words; ++i) {
        mask[i] = word;
    }
}

/* Which blocks of a tile a candidate reaches; without HDRP_CULL_BLOCKS all where it reaches one. */
static uint32_t hdrp_i_cull_blocks_reached(const hdrp_i_cull_job* job, uint32_t m,
                                           const hdrp_i_cull_boxes* boxes, uint32_t* mask)
{
    const hdrp_i_cull_scratch* s = &job->s;
    int all = (job->lists->desc.flags & HDRP_CULL_BLOCKS) != 0u;
    uint32_t found =
        hdrp_i_cull_ball_in_blocks(boxes, hdrp_v4_make(s->x[m], s->y[m], s->z[m], s->radius[m]));
    /* Inside its ball is inside a shape only if it is one. */
    uint32_t bits = s->is_ball[m] ? found >> 16 : 0u, rest = found & 0xffffu & ~bits, block;
    for (block = 0u; s->mask_words > 0u && bits >> block > 0u; ++block) {
        if (bits >> block & 1u) {
            hdrp_i_cull_ask_block(job, s->candidate[m], block, 1, mask);
        }
    }
    for (block = 0u; rest >> block > 0u && (all || bits == 0u); ++block) {
        if (rest >> block & 1u) {
            bits |= hdrp_i_cull_ask_block(job, s->candidate[m], block, 0, mask) << block;
        }
    }
    return all || bits == 0u ? bits : 0xffffu;
}

/* Reads the pixels of a tile and what bounds them. */
static void hdrp_i_cull_prepare_pixels(const hdrp_i_cull_job* job, const hdrp_cull_tile* tile,
                                       hdrp_i_cull_boxes* boxes)
{
    hdrp_i_cull_ranges ranges;
    hdrp_i_cull_read_pixels(job, &ranges);
    hdrp_i_cull_box_blocks(job, tile, &ranges, boxes);
    if (!(job->lists->desc.flags & HDRP_CULL_BLOCKS)) { /* one pixel decides for all blocks */
        hdrp_i_cull_balls_around_pixels(job);
    }
}

/* The blocks that each hit reaches; those that reach none are dropped. Pixels are read only where a
 * hit does not contain the whole of what the tile shows. */
static void hdrp_i_cull_test_pixels(hdrp_i_cull_job* job, hdrp_cull_tile tile, hdrp_v4 info)
{
    const hdrp_i_cull_scratch s = job->s;
    hdrp_i_cull_boxes boxes;
    uint32_t prepared = 0u, h = 0u, n = 0u, category;
    hdrp_i_cull_balls_around_tile(job, &tile, info);
    for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        for (; h < job->hit_end[category]; ++h) {
            uint32_t m = s.origin[h], blocks = 0xffffu;
            uint32_t* mask = s.masks + n * s.mask_words;
            if (!(s.around[m] & s.is_ball[m]) && prepared++ == 0u) {
                hdrp_i_cull_prepare_pixels(job, &tile, &boxes);
            }
            if (s.around[m] & s.is_ball[m]) {
                hdrp_i_cull_fill_mask(mask, s.mask_words, 0xffffffffu);
            } else {
                hdrp_i_cull_fill_mask(mask, s.mask_words, 0u);
                blocks = hdrp_i_cull_blocks_reached(job, m, &boxes, mask);
            }
            s.hit[n] = s.hit[h];
            s.blocks[n] = (uint16_t)blocks;
            n += blocks != 0u ? 1u : 0u;
        }
        job->hit_end[category] = n;
    }
    job->hit_count = n;
}

/* ---- limits ---------------------------------------------------------------------------------- */

static void hdrp_i_cull_sift(uint64_t* key, uint32_t root, uint32_t count)
{
    for (;;) {
        uint32_t child = 2u * root + 1u;
        uint64_t k = key[root];
        if (child >= count) {
            return;
        }
        child += child + 1u < count && key[child + 1u] > key[child] ? 1u : 0u;
        if (k >= key[child]) {
            return;
        }
        key[root] = key[child];
        key[child] = k;
        root = child;
    }
}

static void hdrp_i_cull_sort(uint64_t* key, uint32_t count)
{
    uint32_t i;
    for (i = count / 2u; i-- > 0u;) {
        hdrp_i_cull_sift(key, i, count);
    }
    for (i = count; i-- > 1u;) {
        uint64_t k = key[0];
        key[0] = key[i];
        key[i] = k;
        hdrp_i_cull_sift(key, 0u, i);
    }
}

/* Entries that the hits of a tile need. */
static uint64_t hdrp_i_cull_needed(const hdrp_i_cull_job* job)
{
    uint64_t needed = 0u;
    uint32_t h;
    for (h = 0u; h < job->hit_count; ++h) {
        needed += 1u + (uint64_t)(job->s.hit_last[h] - job->s.hit_first[h]);
    }
    return needed;
}

/* Keeps the hits that are marked. */
static void hdrp_i_cull_keep(hdrp_i_cull_job* job)
{
    const hdrp_i_cull_scratch* s = &job->s;
    uint32_t h = 0u, n = 0u, category;
    for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        for (; h < job->hit_end[category]; ++h) {
            s->hit[n] = s->hit[h];
            s->hit_first[n] = s->hit_first[h];
            s->hit_last[n] = s->hit_last[h];
            s->blocks[n] = s->blocks[h];
            memmove(s->masks + n * s->mask_words, s->masks + h * s->mask_words,
                    s->mask_words * sizeof *s->masks);
            n += s->keep[h];
        }
        job->hit_end[category] = n;
    }
    job->hit_count = n;
}

/* Leaves out what does not fit; returns how many. The order does not depend on anything but the
 * shapes, so that the same ones are left out in the next frame. */
static uint32_t hdrp_i_cull_limit(hdrp_i_cull_job* job)
{
    hdrp_i_cull_scratch* s = &job->s;
    uint64_t room = job->lists->desc.entry_capacity;
    uint32_t h, dropped = 0u, count = job->hit_count;
    if (hdrp_i_cull_needed(job) <= room) {
        return 0u;
    }
    for (h = 0u; h < count; ++h) {
        hdrp_u32 importance = job->set->shapes[s->hit[h]].bits.w;
        /* The bits of floats that are not negative are ordered as the floats are. */
        s->order[h] = (uint64_t)(~importance & 0x7fffffffu) << 32 | (uint64_t)s->hit[h] << 16 | h;
    }
    hdrp_i_cull_sort(s->order, count);
    for (h = 0u; h < count; ++h) {
        uint32_t at = (uint32_t)(s->order[h] & 0xffffu);
        uint64_t needed = 1u + (uint64_t)(s->hit_last[at] - s->hit_first[at]);
        uint32_t fits = dropped == 0u && needed <= room ? 1u : 0u;
        room -= fits ? needed : 0u;
        dropped += fits ? 0u : 1u;
        s->keep[at] = (uint16_t)fits;
    }
    hdrp_i_cull_keep(job);
    return dropped;
}

/* ---- cells ----------------------------------------------------------------------------------- */

/* The slices of each hit. */
static void hdrp_i_cull_slices(hdrp_i_cull_job* job, float scale)
{
    float* nearest = job->s.hit_nearest;
    float* farthest = job->s.hit_farthest;
    uint8_t* first = job->s.hit_first;
    uint8_t* last = job->s.hit_last;
    hdrp_cull_grid grid = job->lists->grid;
    uint32_t h, count;
    if (job->lists->desc.slice_count == 1u) {
        memset(first, 0, job->hit_count);
        memset(last, 0, job->hit_count);
        return;
    }
    count = HDRP_I_CULL_WHOLE(job->hit_count);
    for (h = job->hit_count; h < count; ++h) {
        nearest[h] = farthest[h] = 0.0f;
    }
    HDRP_I_CULL_INDEPENDENT
    for (h = 0u; h < count; ++h) {
        first[h] = (uint8_t)hdrp_cull_slice(grid, scale, nearest[h]);
        last[h] = (uint8_t)hdrp_cull_slice(grid, scale, farthest[h]);
    }
}

/* How many hits of the four categories are in each slice, 16 bits each. First what each slice has
 * more than the one before it: sums of whole words are sums of their parts, whatever those borrow
 * from each other. */
static void hdrp_i_cull_count_slices(const hdrp_i_cull_job* job, uint64_t* counts)
{
    uint32_t slices = job->lists->desc.slice_count, category, h = 0u, k;
    uint64_t sum = 0u;
    memset(counts, 0, (slices + 1u) * sizeof *counts);
    for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        uint64_t one = (uint64_t)1u << (16u * category);
        for (; h < job->hit_end[category]; ++h) {
            counts[job->s.hit_first[h]] += one;
            counts[job->s.hit_last[h] + 1u] -= one;
        }
    }
    for (k = 0u; k < slices; ++k) {
        sum += counts[k];
        counts[k] = sum;
    }
}

/* Of a word of four counts: the highest part of the product is their sum. Shading languages, which
 * look at what they skip, know no number as long as the factor. */
static uint32_t hdrp_i_cull_sum_of_four(uint64_t counts)
{
    return (uint32_t)(counts * ((uint64_t)0x00010001u << 32 | 0x00010001u) >> 48);
}

/* The cells and the entries of a tile of several slices. */
static void hdrp_i_cull_write_slices(const hdrp_i_cull_job* job, hdrp_u32x4* cells, uint32_t at,
                                     uint32_t dropped)
{
    uint64_t counts[HDRP_CULL_SLICES_MAX + 1u];
    uint32_t next[HDRP_CULL_SLICES_MAX];
    uint32_t* entries = job->lists->entries;
    uint32_t slices = job->lists->desc.slice_count, k, h;
    hdrp_i_cull_count_slices(job, counts);
    for (k = 0u; k < slices; ++k) {
        cells[k] = hdrp_u32x4_make(at, (uint32_t)counts[k], (uint32_t)(counts[k] >> 32), dropped);
        next[k] = at;
        at += hdrp_i_cull_sum_of_four(counts[k]);
    }
    for (h = 0u; h < job->hit_count; ++h) {
        uint32_t entry = (uint32_t)job->s.hit[h] | (uint32_t)job->s.blocks[h] << 16;
        uint32_t last = job->s.hit_last[h];
        for (k = job->s.hit_first[h]; k <= last; ++k) {
            entries[next[k]++] = entry;
        }
    }
}

/* The same for one slice: hits and entries are in one order. */
static void hdrp_i_cull_write_one(const hdrp_i_cull_job* job, hdrp_u32x4* cell, uint32_t at,
                                  uint32_t dropped)
{
    const hdrp_i_cull_scratch s = job->s;
    const uint32_t* end = job->hit_end;
    uint32_t* entries = job->lists->entries + at;
    uint32_t* masks = job->lists->masks;
    uint32_t h;
    *cell = hdrp_u32x4_make(at, end[0] | (end[1] - end[0]) << 16,
                            (end[2] - end[1]) | (end[3] - end[2]) << 16, dropped);
    HDRP_I_CULL_INDEPENDENT
    for (h = 0u; h < job->hit_count; ++h) {
        entries[h] = (uint32_t)s.hit[h] | (uint32_t)s.blocks[h] << 16;
    }
    if (masks && job->hit_count > 0u) {
        memcpy(masks + at * s.mask_words, s.masks, job->hit_count * s.mask_words * sizeof *s.masks);
    }
}

static void hdrp_i_cull_write(hdrp_i_cull_job* job, uint32_t tile, uint32_t dropped)
{
    hdrp_cull_lists* lists = job->lists;
    uint32_t slices = lists->desc.slice_count, at = tile * lists->desc.entry_capacity;
    hdrp_u32x4* cells = lists->cells + (size_t)tile * slices;
    if (slices == 1u) {
        hdrp_i_cull_write_one(job, cells, at, dropped);
    } else {
        hdrp_i_cull_write_slices(job, cells, at, dropped);
    }
    lists->tile_dropped[tile] = dropped;
}

/* The rectangle of pixels of a tile, or of several. */
static hdrp_cull_tile hdrp_i_cull_set_rectangle(hdrp_i_cull_job* job, uint32_t column, uint32_t row,
                                                uint32_t columns, uint32_t rows)
{
    const hdrp_cull_lists* lists = job->lists;
    uint32_t x1 = (column + columns) * lists->grid.tiles.x, y1 = (row + rows) * lists->grid.tiles.y;
    job->x0 = column * lists->grid.tiles.x;
    job->y0 = row * lists->grid.tiles.y;
    job->x1 = x1 < lists->desc.width_px ? x1 : lists->desc.width_px;
    job->y1 = y1 < lists->desc.height_px ? y1 : lists->desc.height_px;
    job->rect_px = hdrp_v4_make((float)job->x0, (float)job->y0, (float)job->x1, (float)job->y1);
    return hdrp_cull_tile_make(lists->camera, job->rect_px.x, job->rect_px.y, job->rect_px.z,
                               job->rect_px.w, (float)lists->desc.width_px,
                               (float)lists->desc.height_px);
}

static void hdrp_i_cull_build_tile(hdrp_i_cull_job* job, uint32_t column, uint32_t row)
{
    hdrp_cull_lists* lists = job->lists;
    uint32_t tile = row * lists->grid.tiles.z + column;
    hdrp_v4 info = lists->tiles[tile];
    hdrp_cull_tile t = hdrp_i_cull_set_rectangle(job, column, row, 1u, 1u);
    if (lists->desc.slice_count == 1u) {
        /* Nothing is between its depths where there is only sky. */
        hdrp_i_cull_find(job, t, info.x, info.y, (lists->desc.flags & HDRP_CULL_PIXELS) != 0u);
    } else {
        hdrp_i_cull_find(job, t, lists->camera.eye_near.w, lists->camera.right_far.w, 0);
    }
    if (lists->desc.flags & HDRP_CULL_PIXELS) {
        hdrp_i_cull_test_pixels(job, t, info);
    } else {
        memset(job->s.blocks, 0xff, job->hit_count * sizeof *job->s.blocks);
    }
    hdrp_i_cull_slices(job, info.z);
    hdrp_i_cull_write(job, tile, hdrp_i_cull_limit(job));
}

/* Leaves out the shapes of a coarse cell that reach none of what its tiles show. */
static void hdrp_i_cull_prune_coarse(hdrp_i_cull_job* job, uint32_t cell, uint32_t first_row)
{
    const hdrp_cull_lists* lists = job->lists;
    uint32_t first_column = cell * job->coarse_columns, row, column;
    float lo = HDRP_FLT_MAX, hi = 0.0f;
    for (row = first_row; row < first_row + job->coarse_rows && row < lists->grid.tiles.w; ++row) {
        for (column = first_column;
             column < first_column + job->coarse_columns && column < lists->grid.tiles.z;
             ++column) {
            hdrp_v4 info = lists->tiles[(size_t)row * lists->grid.tiles.z + column];
            lo = info.x <= info.y ? hdrp_min(info.x, lo) : lo;
            hi = info.x <= info.y ? hdrp_max(info.y, hi) : hi;
        }
    }
    hdrp_i_cull_find(job,
                     hdrp_i_cull_set_rectangle(job, first_column, first_row, job->coarse_columns,
                                               job->coarse_rows),
                     lo, hi, 0);
    memcpy(job->s.coarse + (size_t)cell * job->s.capacity, job->s.hit,
           job->hit_count * sizeof *job->s.hit);
    job->s.coarse_count[cell] = job->hit_count;
}

static void hdrp_i_cull_build_row(hdrp_i_cull_job* job, uint32_t coarse_row)
{
    hdrp_u32x4 size = job->lists->grid.tiles;
    uint32_t across = (size.z + job->coarse_columns - 1u) / job->coarse_columns;
    uint32_t first_row = coarse_row * job->coarse_rows, cell, row, column;
    hdrp_i_cull_collect(job, coarse_row, across);
    for (cell = 0u; cell < across; ++cell) {
        uint32_t begin = cell * job->coarse_columns, end = begin + job->coarse_columns;
        hdrp_i_cull_gather(job, cell);
        if (job->lists->desc.slice_count == 1u) { /* many small tiles share what is left */
            hdrp_i_cull_prune_coarse(job, cell, first_row);
            hdrp_i_cull_gather(job, cell);
        }
        for (row = first_row; row < first_row + job->coarse_rows && row < size.w; ++row) {
            for (column = begin; column < end && column < size.z; ++column) {
                hdrp_i_cull_build_tile(job, column, row);
            }
        }
    }
}

HDRP_API hdrp_result hdrp_cull_build(hdrp_cull_lists* lists, const hdrp_cull_set* set,
                                     const hdrp_cull_depth* depth, uint32_t first_row,
                                     uint32_t row_count, void* scratch, size_t scratch_bytes)
{
    hdrp_i_cull_job job;
    hdrp_result r;
    size_t needed;
    uint32_t row, i;
    if (!lists || !set || ((lists->desc.flags & HDRP_CULL_PIXELS) && (!depth || !depth->texels))) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (hdrp_i_cull_bad_range(first_row, row_count, hdrp_cull_rows(lists)) ||
        set->count > lists->desc.shape_capacity || set->width_px != lists->desc.width_px ||
        set->height_px != lists->desc.height_px ||
        memcmp(&set->camera, &lists->camera, sizeof set->camera) != 0 ||
        ((lists->desc.flags & HDRP_CULL_PIXELS) && depth->row_stride < lists->desc.width_px)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    needed = hdrp_cull_scratch_size(&lists->desc);
    r = needed > 0u ? hdrp_i_cull_check_block(scratch, scratch_bytes, needed)
                    : HDRP_ERROR_TOO_LARGE;
    if (r != HDRP_OK) {
        return r;
    }
    memset(&job, 0, sizeof job);
    hdrp_i_cull_place_scratch(&job.s, &lists->desc, lists->grid.tiles.z, scratch);
    job.lists = lists;
    job.set = set;
    job.depth = depth;
    job.coarse_columns = hdrp_cull_coarse_tiles(lists->desc.tile_width_px);
    job.coarse_rows = hdrp_cull_coarse_tiles(lists->desc.tile_height_px);
    for (i = 0u; i < set->count; ++i) {
        job.present |= 1u << hdrp_i_cull_category(set, i);
    }
    if (lists->desc.flags & HDRP_CULL_PIXELS) {
        hdrp_i_cull_place_pixels(&job);
    }
    for (row = first_row; row < first_row + row_count; ++row) {
        hdrp_i_cull_build_row(&job, row);
    }
    return HDRP_OK;
}

/* ---- reading --------------------------------------------------------------------------------- */

HDRP_API hdrp_result hdrp_cull_count(const hdrp_cull_lists* lists, hdrp_cull_stats* stats)
{
    size_t tiles, i;
    if (!lists || !stats) {
        return HDRP_ERROR_NULL_POINTER;
    }
    memset(stats, 0, sizeof *stats);
    tiles = (size_t)lists->grid.tiles.z * lists->grid.tiles.w;
    for (i = 0u; i < tiles; ++i) {
        stats->tiles_full += lists->tile_dropped[i] > 0u ? 1u : 0u;
        stats->dropped += lists->tile_dropped[i];
    }
    for (i = 0u; i < tiles * lists->desc.slice_count; ++i) {
        uint32_t length = hdrp_cull_last(lists->cells[i], HDRP_CULL_CATEGORY_DECAL) -
                          hdrp_cull_first(lists->cells[i], HDRP_CULL_CATEGORY_PUNCTUAL);
        stats->entries += length;
        stats->longest = length > stats->longest ? length : stats->longest;
    }
    return HDRP_OK;
}

/* One more than the largest index that tiles list; 0 where all their lists are empty. */
static uint32_t hdrp_i_cull_listed(const hdrp_cull_lists* lists, uint32_t first_tile,
                                   uint32_t tile_count)
{
    size_t c = (size_t)first_tile * lists->desc.slice_count;
    size_t end = c + (size_t)tile_count * lists->desc.slice_count;
    uint32_t listed = 0u, i;
    for (; c < end; ++c) {
        uint32_t last = hdrp_cull_last(lists->cells[c], HDRP_CULL_CATEGORY_DECAL);
        for (i = lists->cells[c].x; i < last; ++i) {
            uint32_t shape = hdrp_cull_entry_index(lists->entries[i]);
            listed = shape >= listed ? shape + 1u : listed;
        }
    }
    return listed;
}

HDRP_API hdrp_result hdrp_cull_masks(const hdrp_cull_lists* lists, uint32_t first_tile,
                                     uint32_t tile_count, uint32_t* words, uint32_t stride)
{
    size_t first, cells, c;
    uint32_t i;
    if (!lists || (!words && tile_count > 0u)) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (hdrp_i_cull_bad_range(first_tile, tile_count, lists->grid.tiles.z * lists->grid.tiles.w) ||
        (hdrp_i_cull_listed(lists, first_tile, tile_count) + 31u) / 32u > stride) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    first = (size_t)first_tile * lists->desc.slice_count;
    cells = (size_t)tile_count * lists->desc.slice_count;
    if (cells > 0u) {
        memset(words, 0, cells * stride * sizeof *words);
    }
    for (c = 0u; c < cells; ++c) {
        hdrp_u32x4 cell = lists->cells[first + c];
        uint32_t last = hdrp_cull_last(cell, HDRP_CULL_CATEGORY_DECAL);
        for (i = cell.x; i < last; ++i) {
            uint32_t shape = hdrp_cull_entry_index(lists->entries[i]);
            words[c * stride + shape / 32u] |= 1u << (shape % 32u);
        }
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_cull_light_features(const hdrp_cull_lists* lists,
                                              const hdrp_cull_set* set, uint32_t first_tile,
                                              uint32_t tile_count, uint32_t* words)
{
    uint32_t slices, tile, k, i;
    if (!lists || !set || (!words && tile_count > 0u)) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (hdrp_i_cull_bad_range(first_tile, tile_count, lists->grid.tiles.z * lists->grid.tiles.w) ||
        hdrp_i_cull_listed(lists, first_tile, tile_count) > set->count) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    slices = lists->desc.slice_count;
    for (tile = first_tile; tile < first_tile + tile_count; ++tile) {
        words[tile] = 0u;
        for (k = 0u; k < slices; ++k) {
            hdrp_u32x4 cell = lists->cells[(size_t)tile * slices + k];
            uint32_t last = hdrp_cull_last(cell, HDRP_CULL_CATEGORY_DECAL);
            for (i = cell.x; i < last; ++i) {
                words[tile] |= set->shapes[hdrp_cull_entry_index(lists->entries[i])].bits.z;
            }
        }
    }
    return HDRP_OK;
}

/* ---- blockers -------------------------------------------------------------------------------- */

/* The depths of a cell, a little wider. */
static hdrp_cull_interval hdrp_i_cull_slice_depths(const hdrp_cull_lists* lists, hdrp_v4 info,
                                                   uint32_t k)
{
    return hdrp_cull_slice_depths(lists->grid, info, k, lists->camera.eye_near.w,
                                  lists->camera.right_far.w);
}

/* The pixels of an entry go with it. */
static void hdrp_i_cull_move_mask(const hdrp_cull_lists* lists, size_t from, size_t to)
{
    size_t words = hdrp_i_cull_words(&lists->desc);
    if (words > 0u && from != to) {
        memcpy(lists->masks + to * words, lists->masks + from * words,
               words * sizeof *lists->masks);
    }
}

/* Shortens the lists of a cell. */
static void hdrp_i_cull_apply_cell(hdrp_cull_lists* lists, hdrp_cull_blocker_job* job, size_t at,
                                   hdrp_cull_interval depths, uint32_t* masks)
{
    hdrp_u32x4 cell = lists->cells[at];
    uint32_t counts[HDRP_CULL_CATEGORY_COUNT], n = cell.x, category, i;
    for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        uint32_t begin = n, last = hdrp_cull_last(cell, category);
        for (i = hdrp_cull_first(cell, category); i < last; ++i) {
            uint32_t entry = lists->entries[i], mask;
            uint32_t stays =
                hdrp_cull_blocker_classify(job, hdrp_cull_entry_index(entry), depths, &mask);
            if (stays) {
                lists->entries[n] = entry;
                masks[n] = mask;
                hdrp_i_cull_move_mask(lists, i, n);
                ++n;
            }
        }
        counts[category] = n - begin;
    }
    lists->cells[at].y = counts[0] | counts[1] << 16;
    lists->cells[at].z = counts[2] | counts[3] << 16;
}

HDRP_API hdrp_result hdrp_cull_apply_blockers(hdrp_cull_lists* lists, hdrp_cull_blocker_job* job,
                                              uint32_t first_tile, uint32_t tile_count,
                                              uint32_t* masks)
{
    uint32_t t, k, slices;
    if (!lists || !job || !job->set || (!masks && tile_count > 0u)) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (hdrp_i_cull_bad_range(first_tile, tile_count, lists->grid.tiles.z * lists->grid.tiles.w) ||
        memcmp(&job->set->camera, &lists->camera, sizeof lists->camera) != 0) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    slices = lists->desc.slice_count;
    for (t = first_tile; t < first_tile + tile_count; ++t) {
        hdrp_v4 info = lists->tiles[t];
        uint32_t x0 = t % lists->grid.tiles.z * lists->grid.tiles.x, x1 = x0 + lists->grid.tiles.x;
        uint32_t y0 = t / lists->grid.tiles.z * lists->grid.tiles.y, y1 = y0 + lists->grid.tiles.y;
        hdrp_cull_tile tile =
            hdrp_cull_tile_make(lists->camera, (float)x0, (float)y0,
                                (float)(x1 < lists->desc.width_px ? x1 : lists->desc.width_px),
                                (float)(y1 < lists->desc.height_px ? y1 : lists->desc.height_px),
                                (float)lists->desc.width_px, (float)lists->desc.height_px);
        hdrp_cull_interval depths = hdrp_i_cull_slice_depths(lists, info, 0u);
        depths.farthest = hdrp_i_cull_slice_depths(lists, info, slices - 1u).farthest;
        hdrp_cull_blocker_job_tile(job, &tile, depths);
        for (k = 0u; k < slices; ++k) {
            size_t at = (size_t)t * slices + k;
            if ((lists->cells[at].y | lists->cells[at].z) != 0u) {
                depths = hdrp_i_cull_slice_depths(lists, info, k);
                hdrp_i_cull_apply_cell(lists, job, at, depths, masks);
            }
        }
    }
    return HDRP_OK;
}

#ifdef __cplusplus
}
#endif

#if defined(__clang__)
#pragma STDC FP_CONTRACT DEFAULT
#pragma clang diagnostic pop
#elif defined(__GNUC__)
#pragma GCC pop_options
#endif

#undef HDRP_I_CULL_INDEPENDENT

#endif /* HDRP_CULL_IMPLEMENTATION */
