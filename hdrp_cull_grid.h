/* hdrp_cull_grid.h - where the list of a pixel is: grids of tiles and slices, cells, entries.
 * SPDX-License-Identifier: MIT
 *
 * For shaders, and for hdrp_cull.h, which includes this header: from a pixel and its depth to a
 * cell of the grid, and from the cell to the shapes that it lists.
 *
 *     tile = hdrp_cull_tile_of_pixel(grid, x, y);
 *     cell = cells[hdrp_cull_cell(grid, tile, hdrp_cull_slice(grid, tiles[tile].z, z_view))];
 *     for (i = hdrp_cull_first(cell, category); i < hdrp_cull_last(cell, category); ++i)
 *         if (hdrp_cull_entry_covers(grid, entries[i], x, y) != 0u)
 *             shade with light hdrp_cull_entry_index(entries[i])
 *
 * Comparisons decide here what is found, so nothing in this header may be contracted to fused
 * multiply-adds; see hdrp_cull_volume.h. See hdrp_math.h for the languages and the override macros.
 * There is no algorithm layer.
 *
 * >>index of the functions, without hdrp_cull_ (written by tools/api_check.py --write)
 *   grid: log2 series_scale opaque_depth tile_of_depths grid_make tile_of_pixel slice slice_begin
 *       slice_depths cell
 *   lists: first last entry_index entry_covers entry_bit mask_words mask_word mask_bit lowest_bit
 * >>end */
#ifndef HDRP_CULL_GRID_H
#define HDRP_CULL_GRID_H

#include "hdrp_cull_volume.h"

#if HDRP_VERSION != 100
#error "hdrp_cull_grid.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT OFF
#endif

/* Largest picture, in pixels along a side. */
#define HDRP_CULL_SIZE_MAX 16384u
/* Slices of a tile. */
#define HDRP_CULL_SLICES_MAX 256u

/* >>grid
 * What a shader needs to find the list of a position. Of each tile it also needs a vector, written
 * by hdrp_cull_measure_depth: x nearest and y farthest opaque depth [m], nothing opaque where
 * x > y; z scale of its slices, w 0. */

/* Made by hdrp_cull_grid_make. */
struct hdrp_cull_grid {
    hdrp_u32x4 tiles; /* any  width and height in px of a tile, columns, rows */
    hdrp_u32x4 cells; /* any  slices of a tile, entries of a tile, width and height of a block */
    hdrp_v4 series;   /* x [1e-6,1e9] m, y [-20,30] its log2, z [1e-6,1e18] m, w [0,1e7] scale */
};
HDRP_TYPEDEF(hdrp_cull_grid)

#ifndef HDRP_GPU
typedef char hdrp_i_cull_grid_size_of[sizeof(hdrp_cull_grid) == 48 ? 1 : -1];
#endif

/** Logarithm to the base 2 for slices: a cubic in each octave, made of +, - and * alone, so that no
 *  device rounds it differently.
 *  x        [FLT_MIN,FLT_MAX]
 *  returns  [-126,128]  rises with x; exact for powers of 2
 *  edges    smaller x and NaN count as FLT_MIN
 *  error    <= 1.3e-4 absolute  @accuracy cull_log2
 *  source   our own minimax fit of q in log2(1 + m) = m + m (1 - m) q(m), by tools/fit_cull.py */
HDRP_FN float hdrp_cull_log2(float x)
{
    hdrp_u32 u = hdrp_bits_from_f32(hdrp_clamp(x, HDRP_FLT_MIN, HDRP_FLT_MAX));
    /* The exponent, in the last bits of a number near 2^23: conversions do not vectorise. */
    float e = hdrp_f32_from_bits(u >> 23 | 0x4b000000u) - 8388735.0f; /* 2^23 + 127 */
    float m = hdrp_f32_from_bits((u & 0x007fffffu) | 0x3f800000u) - 1.0f;
    float q = 0.43872573f + m * (-0.23905817f + m * 0.08213063f);
    return e + (m + m * (1.0f - m) * q);
}

/** Scale of the slices of a tile: half of them are in front of a depth.
 *  grid        valid
 *  farthest_m  any      farthest opaque depth
 *  returns     [0,1e7]  slices in an octave of depth
 *  edges       a depth up to a thousandth of an octave beyond the start of the series counts as
 *              that, and so does NaN; an infinite one counts as FLT_MAX
 *  error       none: a definition
 *  source      Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *              Definition Render Pipeline", slides on clustered lists; without the limit that their
 *              series has when the farthest depth is far */
HDRP_FN float hdrp_cull_series_scale(hdrp_cull_grid grid, float farthest_m)
{
    float octaves = hdrp_cull_log2(farthest_m) - grid.series.y;
    return hdrp_f32_from_u32(grid.cells.x >> 1) / hdrp_max(octaves, 1e-3f);
}

/** What the depth of a pixel counts for in hdrp_cull_measure_depth.
 *  z_view   any  m
 *  near_m   [1e-6,1e9]   camera.eye_near.w
 *  far_m    [1e-6,1e18]  camera.right_far.w
 *  returns  [-1,1e18]  the depth in front of the camera; -1 where nothing opaque is seen
 *  edges    what is in front of the near distance counts as at it; NaN, negative depths, and those
 *           beyond the far distance or within a millionth of it are sky
 *  error    none: a selection
 *  source   a definition
 *  note     cleared depth, turned into metres, may fall short of the far distance by a rounding */
HDRP_FN float hdrp_cull_opaque_depth(float z_view, float near_m, float far_m)
{
    float seen = z_view < near_m ? near_m : z_view;
    float here = z_view < far_m * (1.0f - HDRP_CULL_MARGIN) ? seen : -1.0f;
    return z_view >= 0.0f ? here : -1.0f;
}

/** The vector of a tile, from the depths of its pixels by hdrp_cull_opaque_depth.
 *  grid        valid
 *  nearest_m   any    of the pixels that are not sky
 *  farthest_m  any    of all pixels: negative where all are sky
 *  one_series  [0,1]  1 with HDRP_CULL_ONE_SERIES
 *  returns     any    x, y and z as they are kept for shaders, w 0
 *  edges       where all is sky, or farthest_m NaN, nearest and farthest are 1 and -1
 *  error       none: a selection, and hdrp_cull_series_scale
 *  source      a definition */
HDRP_FN hdrp_v4 hdrp_cull_tile_of_depths(hdrp_cull_grid grid, float nearest_m, float farthest_m,
                                         hdrp_u32 one_series)
{
    float own = hdrp_cull_series_scale(grid, farthest_m);
    float scale = one_series != 0u ? grid.series.w : own;
    float z = farthest_m >= 0.0f ? scale : grid.series.w;
    float nearest = farthest_m >= 0.0f ? nearest_m : 1.0f;
    return hdrp_v4_make(nearest, farthest_m >= 0.0f ? farthest_m : -1.0f, z, 0.0f);
}

/* x, but at least 1 and at most a limit. */
HDRP_FN hdrp_u32 hdrp_i_cull_limit_u32(hdrp_u32 x, hdrp_u32 limit)
{
    hdrp_u32 y = x > 0u ? x : 1u;
    return y < limit ? y : limit;
}

/** The grid over a picture.
 *  camera          valid
 *  picture         any  x width and y height in px, z slices, w entries of a tile
 *  tile            any  x width and y height in px, z and w 0
 *  series_start_m  any  first boundary between slices comes after this; 0: the near distance
 *  series_end_m    any  last slice of a tile without depth ends here; 0: the far distance, but at
 *                       most 1000 times the start
 *  returns         valid
 *  edges           sizes and slices of 0 count as 1, what is beyond HDRP_CULL_SIZE_MAX and
 *                  HDRP_CULL_SLICES_MAX as these; the last slice reaches to the far distance,
 *                  wherever the series ends
 *  error           none: limits
 *  source          a definition */
HDRP_FN hdrp_cull_grid hdrp_cull_grid_make(hdrp_cull_camera camera, hdrp_u32x4 picture,
                                           hdrp_u32x4 tile, float series_start_m,
                                           float series_end_m)
{
    hdrp_cull_grid g;
    hdrp_u32 w = hdrp_i_cull_limit_u32(tile.x, HDRP_CULL_SIZE_MAX);
    hdrp_u32 h = hdrp_i_cull_limit_u32(tile.y, HDRP_CULL_SIZE_MAX);
    hdrp_u32 columns = (hdrp_i_cull_limit_u32(picture.x, HDRP_CULL_SIZE_MAX) + w - 1u) / w;
    hdrp_u32 rows = (hdrp_i_cull_limit_u32(picture.y, HDRP_CULL_SIZE_MAX) + h - 1u) / h;
    hdrp_u32 slices = hdrp_i_cull_limit_u32(picture.z, HDRP_CULL_SLICES_MAX);
    float start =
        hdrp_clamp(series_start_m > 0.0f ? series_start_m : camera.eye_near.w, 1e-6f, 1e9f);
    float end = hdrp_min(camera.right_far.w, 1000.0f * start);
    float octaves;
    end = hdrp_clamp(series_end_m > 0.0f ? series_end_m : end, start, HDRP_CULL_FAR_INFINITE);
    g.tiles = hdrp_u32x4_make(w, h, columns, rows);
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
    /* In the last bits of a number near 2^23: conversions do not vectorise. */
    return hdrp_bits_from_f32(hdrp_floor(hdrp_clamp(k, 0.0f, last)) + 8388608.0f) & 0xffffu;
}

/** The depth at which a slice begins: hdrp_cull_slice gives it for greater depths.
 *  grid     valid
 *  scale    [0,1e7]  of the tile
 *  slice    [1,255]
 *  returns  [1e-38,1e38]  m
 *  edges    the first slice begins at the near distance, whatever this says; scales below a
 *           thousandth count as that
 *  error    <= 3e-6 relative  @accuracy cull_slice_begin
 *  source   the inverse of hdrp_cull_log2 by Newton's method, with the slope of the logarithm */
HDRP_FN float hdrp_cull_slice_begin(hdrp_cull_grid grid, float scale, hdrp_u32 slice)
{
    float place = grid.series.y + hdrp_f32_from_u32(slice) / hdrp_max(scale, 1e-3f);
    float wanted = hdrp_clamp(place, -126.0f, 126.0f);
    float octave = hdrp_floor(wanted);
    hdrp_u32 exponent = hdrp_bits_from_f32(octave + 8388735.0f) & 0xffu; /* 2^23 + 127 */
    float z = hdrp_f32_from_bits(exponent << 23);
    z += z * (wanted - octave);
    z += z * 0.6931472f * (wanted - hdrp_cull_log2(z));
    z += z * 0.6931472f * (wanted - hdrp_cull_log2(z));
    z += z * 0.6931472f * (wanted - hdrp_cull_log2(z));
    return z + z * 0.6931472f * (wanted - hdrp_cull_log2(z));
}

/** The depths of a slice of a tile, a little wider.
 *  grid     valid
 *  tile     any      vector of the tile, see above
 *  slice    [0,255]
 *  near_m   [1e-6,1e9]   camera.eye_near.w
 *  far_m    [1e-6,1e18]  camera.right_far.w
 *  returns  any      those that the tile shows where it has one slice: none where the nearest is
 *                    beyond the farthest
 *  edges    the first slice begins at the near distance, the last one ends at the far distance
 *  error    none: encloses, by 1e-5 of each
 *  source   a definition */
HDRP_FN hdrp_cull_interval hdrp_cull_slice_depths(hdrp_cull_grid grid, hdrp_v4 tile, hdrp_u32 slice,
                                                  float near_m, float far_m)
{
    hdrp_cull_interval r;
    float begin = hdrp_cull_slice_begin(grid, tile.z, slice);
    float end = hdrp_cull_slice_begin(grid, tile.z, slice + 1u);
    float nearest = hdrp_clamp(begin - begin * 1e-5f, near_m, far_m);
    r.nearest = slice > 0u ? nearest : near_m;
    r.farthest =
        slice + 1u < grid.cells.x ? hdrp_clamp(end + end * 1e-5f, r.nearest, far_m) : far_m;
    r.nearest = grid.cells.x == 1u ? tile.x : r.nearest;
    r.farthest = grid.cells.x == 1u ? tile.y : r.farthest;
    return r;
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
 * A cell is x the first of its entries, y and z the counts of the four categories, 16 bits each,
 * the first in the low bits of y, and w how many shapes its tile has dropped. */

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

/** The bit of entries that stands for the block of a pixel, for loops over many of them:
 *  hdrp_cull_entry_covers tests it.
 *  grid     valid
 *  x_px     any
 *  y_px     any
 *  returns  any  a single bit of the upper half
 *  edges    the pixel has to be in the tile of the list
 *  error    none: a selection of bits
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_entry_bit(hdrp_cull_grid grid, hdrp_u32 x_px, hdrp_u32 y_px)
{
    hdrp_u32 x = (x_px % grid.tiles.x) / grid.cells.z;
    hdrp_u32 y = (y_px % grid.tiles.y) / grid.cells.w;
    return 1u << (16u + ((y & 3u) * 4u + (x & 3u)));
}

/* Where a pixel is in the mask of a tile: block by block, in each row by row. */
HDRP_FN hdrp_u32 hdrp_i_cull_mask_place(hdrp_cull_grid grid, hdrp_u32 x_px, hdrp_u32 y_px)
{
    hdrp_u32 x = x_px % grid.tiles.x;
    hdrp_u32 y = y_px % grid.tiles.y;
    hdrp_u32 block = (y / grid.cells.w) * 4u + x / grid.cells.z;
    hdrp_u32 in_block = (y % grid.cells.w) * grid.cells.z + x % grid.cells.z;
    return block * (grid.cells.z * grid.cells.w) + in_block;
}

/** Words of the mask of an entry: 8 for tiles of 16 x 16 pixels.
 *  grid     valid
 *  returns  any
 *  edges    none
 *  error    none: a definition
 *  source   a definition
 *  note     one block after the other, of half a word or more each: a word is 8 x 4 pixels, which a
 *           group of threads asks together */
HDRP_FN hdrp_u32 hdrp_cull_mask_words(hdrp_cull_grid grid)
{
    return (grid.cells.z * grid.cells.w + 1u) >> 1;
}

/** The word that says whether the shape of an entry reaches a pixel, in lists with HDRP_CULL_MASKS.
 *  grid     valid
 *  entry    any  index of the entry, not the entry
 *  x_px     any
 *  y_px     any
 *  returns  any  index into the masks; hdrp_cull_mask_bit says which bit
 *  edges    the pixel has to be in the tile of the list
 *  error    none: a definition
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_mask_word(hdrp_cull_grid grid, hdrp_u32 entry, hdrp_u32 x_px,
                                     hdrp_u32 y_px)
{
    return entry * hdrp_cull_mask_words(grid) + (hdrp_i_cull_mask_place(grid, x_px, y_px) >> 5);
}

/** The bit of the word that stands for a pixel.
 *  grid     valid
 *  x_px     any
 *  y_px     any
 *  returns  [0,31]
 *  edges    none
 *  error    none: a definition
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_mask_bit(hdrp_cull_grid grid, hdrp_u32 x_px, hdrp_u32 y_px)
{
    return hdrp_i_cull_mask_place(grid, x_px, y_px) & 31u;
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

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT DEFAULT
#endif

#endif /* HDRP_CULL_GRID_H */
