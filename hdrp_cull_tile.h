/* hdrp_cull_tile.h - whether a shape reaches a tile, its blocks of pixels, its pixels.
 * SPDX-License-Identifier: MIT
 *
 * What hdrp_cull.h, which includes this header, asks of the shapes of a set to make lists, and what
 * the passes of hdrp_gpu_vk_cull.h ask, so that both list the same. In short, for a tile:
 *
 *     seen = hdrp_cull_interval_seen(nearest, farthest);
 *     r = hdrp_cull_bounds_in_rect(bounds, rect_px, seen);
 *     r = hdrp_cull_interval_within(r, hdrp_cull_interval_ball(tile, ball, orthographic));
 *     listed where r.nearest <= r.farthest
 *
 * Comparisons decide here what is listed, so nothing in this header may be contracted to fused
 * multiply-adds; see hdrp_cull_volume.h. See hdrp_math.h for the languages and the override macros.
 * There is no algorithm layer.
 *
 * >>index of the functions, without hdrp_cull_ (written by tools/api_check.py --write)
 *   tiles: interval_seen interval_within bounds_in_rect coarse_tiles bounds_in_cell
 *   blocks of pixels: window_box block_box box_in_ball
 *   pixels: pixel_in_view distance_sq
 * >>end */
#ifndef HDRP_CULL_TILE_H
#define HDRP_CULL_TILE_H

#include "hdrp_cull_volume.h"

#if HDRP_VERSION != 100
#error "hdrp_cull_tile.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT OFF
#endif

/* A tile has four times four blocks of pixels. */
#define HDRP_CULL_BLOCK_COUNT 16u
/* A coarse cell, a block of tiles, of about so many pixels is asked for as a whole first. */
#define HDRP_CULL_COARSE_PX 64u

/* >>tiles */

/* Depths are looked up with functions that may be contracted elsewhere: hdrp_cull_slice. */
#define HDRP_I_CULL_DEPTH_MARGIN 2e-6f

/** The depths that a tile shows, a little wider.
 *  nearest_m   any
 *  farthest_m  any
 *  returns     any  nothing is between them where nearest_m > farthest_m
 *  edges       none
 *  error       none: encloses, by 2e-6 of each
 *  source      a definition */
HDRP_FN hdrp_cull_interval hdrp_cull_interval_seen(float nearest_m, float farthest_m)
{
    hdrp_cull_interval r;
    r.nearest = nearest_m * (1.0f - HDRP_I_CULL_DEPTH_MARGIN);
    r.farthest = farthest_m * (1.0f + HDRP_I_CULL_DEPTH_MARGIN);
    return r;
}

/** What is left of some depths within those of a ball or of planes.
 *  depths   any
 *  other    any  from hdrp_cull_interval_ball or hdrp_cull_interval_plane
 *  returns  any  nothing where nearest > farthest
 *  edges    none
 *  error    none: encloses, by 2e-6 of each
 *  source   a definition */
HDRP_FN hdrp_cull_interval hdrp_cull_interval_within(hdrp_cull_interval depths,
                                                     hdrp_cull_interval other)
{
    depths.nearest = hdrp_max(other.nearest * (1.0f - HDRP_I_CULL_DEPTH_MARGIN), depths.nearest);
    depths.farthest = hdrp_min(other.farthest * (1.0f + HDRP_I_CULL_DEPTH_MARGIN), depths.farthest);
    return depths;
}

/** The depths of screen bounds that are among those seen in a rectangle.
 *  bounds   valid  of a shape: hdrp_cull_shape_bounds
 *  rect_px  [0,16384]  left, upper, right and lower edge
 *  seen     any    from hdrp_cull_interval_seen
 *  returns  any    nothing where nearest > farthest: so where the rectangles are apart
 *  edges    rectangles that share an edge overlap
 *  error    none: comparisons
 *  source   a definition */
HDRP_FN hdrp_cull_interval hdrp_cull_bounds_in_rect(hdrp_cull_bounds bounds, hdrp_v4 rect_px,
                                                    hdrp_cull_interval seen)
{
    /* A difference is positive where there is a gap. */
    float x = hdrp_max(bounds.rect_px.x - rect_px.z, rect_px.x - bounds.rect_px.z);
    float y = hdrp_max(bounds.rect_px.y - rect_px.w, rect_px.y - bounds.rect_px.w);
    seen.nearest = hdrp_max(bounds.nearest, seen.nearest);
    seen.farthest = hdrp_min(bounds.farthest, seen.farthest);
    seen.nearest = hdrp_max(x, y) <= 0.0f ? seen.nearest : HDRP_FLT_MAX;
    return seen;
}

/** Tiles of a coarse cell along one side.
 *  tile_px  [1,16384]  size of a tile
 *  returns  [2,64]
 *  edges    0 counts as 1
 *  error    none: a definition
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_coarse_tiles(hdrp_u32 tile_px)
{
    hdrp_u32 px = tile_px > 0u ? tile_px : 1u;
    return px * 2u <= HDRP_CULL_COARSE_PX ? HDRP_CULL_COARSE_PX / px : 2u;
}

/** Whether screen bounds reach a coarse cell.
 *  bounds   valid  of a shape
 *  cell_px  [0,32768]  left, upper, right and lower edge
 *  returns  [0,1]
 *  edges    the right edge belongs to the next cell; what is left of the picture reaches the first
 *  error    none: comparisons
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_bounds_in_cell(hdrp_cull_bounds bounds, hdrp_v4 cell_px)
{
    hdrp_v4 r = bounds.rect_px;
    hdrp_u32 across = r.x < cell_px.z && hdrp_max(r.z, 0.0f) >= cell_px.x ? 1u : 0u;
    hdrp_u32 down = r.y <= cell_px.w && r.w >= cell_px.y ? across : 0u;
    return r.x <= r.z ? down : 0u;
}

/* >>blocks of pixels */

/* A box around what a rectangle of the picture shows between two depths, in view space. */
struct hdrp_cull_box {
    hdrp_v3 low;  /* any */
    hdrp_v3 high; /* any */
};
HDRP_TYPEDEF(hdrp_cull_box)

/** The box around what a window shows between two depths.
 *  window        any    left, right, bottom, top: hdrp_cull_tile.window
 *  depths        any    m
 *  orthographic  [0,1]  1 for an orthographic camera
 *  returns       any
 *  edges         none
 *  error         none: encloses what hdrp_cull_pixel_in_view gives for the window's pixels
 *  source        a definition */
HDRP_FN hdrp_cull_box hdrp_cull_window_box(hdrp_v4 window, hdrp_cull_interval depths,
                                           float orthographic)
{
    hdrp_cull_box b;
    float k0 = orthographic > 0.0f ? 1.0f : depths.nearest;
    float k1 = orthographic > 0.0f ? 1.0f : depths.farthest;
    b.low = hdrp_v3_make(hdrp_min(window.x * k0, window.x * k1),
                         hdrp_min(window.z * k0, window.z * k1), depths.nearest);
    b.high = hdrp_v3_make(hdrp_max(window.y * k0, window.y * k1),
                          hdrp_max(window.w * k0, window.w * k1), depths.farthest);
    return b;
}

/** The box around the surfaces of a block, one of four times four of a tile.
 *  window        any     of the tile
 *  size          [0,1e9] width and height of a block, as the window measures
 *  block         [0,15]  row by row from the top
 *  depths        any     nearest and farthest of the block's pixels: hdrp_cull_opaque_depth
 *  orthographic  [0,1]   1 for an orthographic camera
 *  returns       any
 *  edges         a block that shows only sky, whose farthest depth is negative, is out of
 *                everything's reach
 *  error         none: encloses; as wide as the window of the tile, which is a little wider than
 *                its pixels
 *  source        a definition */
HDRP_FN hdrp_cull_box hdrp_cull_block_box(hdrp_v4 window, hdrp_v2 size, hdrp_u32 block,
                                          hdrp_cull_interval depths, float orthographic)
{
    float column = hdrp_f32_from_u32(block & 3u);
    float row = hdrp_f32_from_u32(block >> 2);
    float sky = 2.0f * HDRP_LIGHT_RANGE_INFINITE;
    float is_sky = depths.farthest < 0.0f ? 1.0f : 0.0f;
    hdrp_v4 w;
    w.x = window.x + column * size.x;
    w.y = hdrp_max(window.y - (3.0f - column) * size.x, w.x + size.x);
    w.w = window.w - row * size.y;
    w.z = hdrp_min(window.z + (3.0f - row) * size.y, w.w - size.y);
    depths.nearest = is_sky > 0.0f ? sky : depths.nearest;
    depths.farthest = is_sky > 0.0f ? sky : depths.farthest;
    return hdrp_cull_window_box(w, depths, orthographic);
}

/** Whether a ball reaches a box, and whether it contains it.
 *  box      any
 *  ball     any  xyz centre, w radius
 *  returns  any  bit 0: reaches, bit 16: contains
 *  edges    touching counts as both
 *  error    none: a comparison of sums of squares, each good to a few ulp
 *  source   Arvo 1990, "A Simple Method for Box-Sphere Intersection Testing" */
HDRP_FN hdrp_u32 hdrp_cull_box_in_ball(hdrp_cull_box box, hdrp_v4 ball)
{
    float r2 = ball.w * ball.w;
    float ax = box.low.x - ball.x;
    float bx = ball.x - box.high.x;
    float ay = box.low.y - ball.y;
    float by = ball.y - box.high.y;
    float az = box.low.z - ball.z;
    float bz = ball.z - box.high.z;
    float near_x = hdrp_max(hdrp_max(ax, bx), 0.0f);
    float near_y = hdrp_max(hdrp_max(ay, by), 0.0f);
    float near_z = hdrp_max(hdrp_max(az, bz), 0.0f);
    float far_x = hdrp_min(ax, bx);
    float far_y = hdrp_min(ay, by);
    float far_z = hdrp_min(az, bz);
    hdrp_u32 reaches = near_x * near_x + near_y * near_y + near_z * near_z <= r2 ? 1u : 0u;
    hdrp_u32 contains = far_x * far_x + far_y * far_y + far_z * far_z <= r2 ? 65536u : 0u;
    return reaches + contains;
}

/* >>pixels */

/** The place of what a pixel shows.
 *  camera      valid
 *  pixel_size  [0,1e9]      of the window: its width and height over those of the picture
 *  x_px        [0,16384]    from the left edge of the picture; centres end in .5
 *  y_px        [0,16384]    from the lower edge
 *  z_view      [-1,1e18] m  depth
 *  returns     any          in view space: z is z_view
 *  edges       sky, of negative depth, is behind the camera
 *  error       none: a definition
 *  source      a definition */
HDRP_FN hdrp_v3 hdrp_cull_pixel_in_view(hdrp_cull_camera camera, hdrp_v2 pixel_size, float x_px,
                                        float y_px, float z_view)
{
    float k = camera.forward_orthographic.w > 0.0f ? 1.0f : z_view;
    return hdrp_v3_make((camera.window.x + x_px * pixel_size.x) * k,
                        (camera.window.y + y_px * pixel_size.y) * k, z_view);
}

/** The square of the distance of a position from the centre of a ball.
 *  ball      any  xyz centre
 *  position  any
 *  returns   any  m^2
 *  edges     infinite where it overflows
 *  error     none: sums and products
 *  source    a definition */
HDRP_FN float hdrp_cull_distance_sq(hdrp_v4 ball, hdrp_v3 position)
{
    float x = ball.x - position.x;
    float y = ball.y - position.y;
    float z = ball.z - position.z;
    return x * x + y * y + z * z;
}

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT DEFAULT
#endif

#endif /* HDRP_CULL_TILE_H */
