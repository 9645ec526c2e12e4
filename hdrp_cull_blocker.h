/* hdrp_cull_blocker.h - what keeps light from where it would leak: blockers, portals, clip planes.
 * SPDX-License-Identifier: MIT
 *
 * A blocker is a rectangle, or an infinite plane with everything behind it, that keeps the light of
 * some lights away; a portal is a rectangle through which light passes one blocker all the same, as
 * through a door. A light L lights a position P if for every blocker of L
 *
 *     the segment from P to L does not cross it, or crosses one of its portals.
 *
 * A portal need not lie in the plane of its blocker. The segment ends before P and L: a rectangle
 * blocks neither a surface nor a light in its own plane. A plane blocks what is behind it, wherever
 * the light is. Parallel light comes from infinity; of an area light its centre counts.
 *
 * hdrp_cull.h, which includes this header, asks it for every cell of a grid of lists: which of the
 * blockers shade nothing there, all of the cell, or a part? A light that is kept from all of a cell
 * leaves its list. For each of the others a mask says which blockers a pixel still has to test:
 *
 *     visible = 1
 *     for each bit k of masks[i]:                             hdrp_cull_lowest_bit
 *         blocker = blockers[links[lights[light].first + k]]
 *         through = the largest hdrp_cull_blocker_blocks(portal, place, position) of its portals
 *         blocks = hdrp_cull_blocker_blocks(blocker, place, position)
 *         visible = hdrp_cull_blocker_visible(visible, blocks, through)
 *
 * with place = hdrp_cull_light_place(light). On the CPU hdrp_cull_blocker_light_visible does that.
 *
 * For a pair of light and blocker hdrp_cull_shadow_make gives the depths between which something of
 * a tile may be in the shadow, and those between which all of it is: the true ones up to rounding,
 * for all slices at once. Comparisons decide, so that nothing may be contracted. View space is that
 * of hdrp_cull_volume.h; for the languages and the override macros see hdrp_math.h. The
 * algorithm layer is compiled in one source file:
 *
 *     #define HDRP_CULL_IMPLEMENTATION
 *     #include "hdrp_cull_blocker.h"
 *
 * >>index of the functions, without hdrp_cull_ (written by tools/api_check.py --write)
 *   blockers: blocker_rectangle blocker_plane blocker_with_portals light_place blocker_blocks
 *       blocker_visible blocker_in_view light_place_in_view
 *   shadows in tiles: shadow_make shadow_class shadow_through
 *   blockers of all lights: blocker_memory_size blocker_init blocker_begin blocker_project
 *       blocker_light_visible
 *   blockers in cells: blocker_scratch_size blocker_job_begin blocker_job_tile blocker_classify
 * >>end */
#ifndef HDRP_CULL_BLOCKER_H
#define HDRP_CULL_BLOCKER_H

#include "hdrp_cull_volume.h"

#if HDRP_VERSION != 100
#error "hdrp_cull_blocker.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#ifndef HDRP_GPU
#include <stddef.h>
#endif

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT OFF
#endif

/* Blockers of a light: each has a bit of a mask. Portals of a blocker. */
#define HDRP_CULL_BLOCKERS_MAX      32u
#define HDRP_CULL_PORTALS_MAX       32u

#define HDRP_CULL_BLOCKER_NONE      0u /* blocks nothing */
#define HDRP_CULL_BLOCKER_RECTANGLE 1u
#define HDRP_CULL_BLOCKER_PLANE     2u /* everything behind it */

HDRP_FN float hdrp_i_cull_blocker_dot(hdrp_v3 a, hdrp_v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* |x| + |y| + |z|: what rounding errors of a position are measured by. */
HDRP_FN float hdrp_i_cull_blocker_size(hdrp_v3 v)
{
    return hdrp_abs(v.x) + hdrp_abs(v.y) + hdrp_abs(v.z);
}

HDRP_FN hdrp_v3 hdrp_i_cull_blocker_mad(hdrp_v3 a, hdrp_v3 b, float s)
{
    return hdrp_v3_make(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}

/* >>blockers
 * A portal is the same record. C, std430 and structured buffers share the layout, 80 bytes. */

/* Made by hdrp_cull_blocker_rectangle and hdrp_cull_blocker_plane. */
struct hdrp_cull_blocker {
    hdrp_v4 center;     /* xyz [-1e18,1e18], w [0,0] */
    hdrp_v4 right_half; /* xyz unit, w [0,1e18] m half size along it */
    hdrp_v4 up_half;    /* xyz unit, w [0,1e18] m */
    hdrp_v4 front;      /* xyz unit, w [0,0] */
    hdrp_u32x4 bits;    /* any: x kind, y first portal, z portals, w 0 */
};
HDRP_TYPEDEF(hdrp_cull_blocker)

/* Where the blockers of a light are in a list of indices. */
struct hdrp_cull_blocker_links {
    hdrp_u32 first; /* any */
    hdrp_u32 count; /* any, up to HDRP_CULL_BLOCKERS_MAX */
};
HDRP_TYPEDEF(hdrp_cull_blocker_links)

/* The frame of a blocker, by the function that knows the frame of a box. */
HDRP_FN hdrp_cull_blocker hdrp_i_cull_blocker(hdrp_u32 kind, hdrp_v3 center, hdrp_v3 front,
                                              hdrp_v3 up, float half_width_m, float half_height_m)
{
    hdrp_cull_blocker b;
    hdrp_cull_shape s = hdrp_cull_shape_box(center, front, up, half_width_m, half_height_m, 0.0f,
                                            HDRP_CULL_CATEGORY_PUNCTUAL);
    float usable = hdrp_cull_shape_kind(s) == HDRP_CULL_KIND_BOX ? 1.0f : 0.0f;
    b.center = hdrp_v4_from_v3(hdrp_v3_from_v4(s.center_range), 0.0f);
    b.right_half = s.right_half;
    b.up_half = s.up_half;
    b.front = hdrp_v4_from_v3(hdrp_v3_from_v4(s.forward_half), 0.0f);
    b.bits = hdrp_u32x4_make(usable > 0.0f ? kind : HDRP_CULL_BLOCKER_NONE, 0u, 0u, 0u);
    return b;
}

/** A rectangle that blocks light, from both sides; or a portal.
 *  center         any  m
 *  front          any  at right angles to it, either way; any length
 *  up             any  roughly along its height; any length, need not be orthogonal
 *  half_width_m   any
 *  half_height_m  any
 *  returns        valid  without portals
 *  edges          blocks nothing, or lets nothing through, where a size is 0, negative or NaN and
 *                 where the centre is NaN or beyond 1e18 m; sizes are limited to 1e18 m; without
 *                 directions as hdrp_cull_camera_perspective
 *  error          none: limits
 *  source         a definition */
HDRP_FN hdrp_cull_blocker hdrp_cull_blocker_rectangle(hdrp_v3 center, hdrp_v3 front, hdrp_v3 up,
                                                      float half_width_m, float half_height_m)
{
    hdrp_u32 kind = half_width_m > 0.0f && half_height_m > 0.0f ? HDRP_CULL_BLOCKER_RECTANGLE
                                                                : HDRP_CULL_BLOCKER_NONE;
    return hdrp_i_cull_blocker(kind, center, front, up, half_width_m, half_height_m);
}

/** A plane that blocks all light behind it.
 *  position  any  m, in the plane
 *  front     any  direction of the side that stays lit; any length
 *  returns   valid  without portals
 *  edges     blocks nothing where the position is NaN or beyond 1e18 m; without a direction as
 *            hdrp_cull_camera_perspective
 *  error     none: limits
 *  source    Kircher 2018, "Rendering Technology in Agents of Mayhem", slides on light leaking */
HDRP_FN hdrp_cull_blocker hdrp_cull_blocker_plane(hdrp_v3 position, hdrp_v3 front)
{
    return hdrp_i_cull_blocker(HDRP_CULL_BLOCKER_PLANE, position, front,
                               hdrp_v3_make(0.0f, 1.0f, 0.0f), 0.0f, 0.0f);
}

/** A blocker with holes.
 *  blocker  valid
 *  first    any  index of the first of its portals in the array of blockers
 *  count    any  portals, one after the other
 *  returns  valid
 *  edges    a count above HDRP_CULL_PORTALS_MAX becomes that
 *  error    none: a definition
 *  source   a definition */
HDRP_FN hdrp_cull_blocker hdrp_cull_blocker_with_portals(hdrp_cull_blocker blocker, hdrp_u32 first,
                                                         hdrp_u32 count)
{
    blocker.bits.y = first;
    blocker.bits.z = count < HDRP_CULL_PORTALS_MAX ? count : HDRP_CULL_PORTALS_MAX;
    return blocker;
}

/** Where the light of a light comes from.
 *  light    valid
 *  returns  [-1e18,1e18]  xyz position and w 1; of directional lights and box projectors xyz the
 *           direction to the light and w 0
 *  edges    the centre of an area light
 *  error    none: a selection
 *  source   homogeneous coordinates */
HDRP_FN hdrp_v4 hdrp_cull_light_place(hdrp_light light)
{
    hdrp_u32 type = hdrp_light_type(light);
    float parallel =
        type == HDRP_LIGHT_TYPE_DIRECTIONAL || type == HDRP_LIGHT_TYPE_BOX ? 1.0f : 0.0f;
    hdrp_v3 p = hdrp_v3_select(parallel, hdrp_v3_neg(hdrp_v3_from_v4(light.forward_radius)),
                               hdrp_v3_from_v4(light.position_range));
    return hdrp_v4_from_v3(p, 1.0f - parallel);
}

/** Whether a blocker, by itself, keeps a light from a position; or whether light passes a portal.
 *  blocker   valid
 *  light     any  hdrp_cull_light_place
 *  position  any  in the frame of blocker and light
 *  returns   [0,1]  1 where it does
 *  edges     the rim of a rectangle belongs to it; 0 where position or light are in its plane, or
 *            NaN, and where the blocker blocks nothing
 *  error     none: a test of positions that are rounded; good for positions up to 1e18 m
 *  source    where the plane cuts the segment, with both sides times the denominator */
HDRP_FN float hdrp_cull_blocker_blocks(hdrp_cull_blocker blocker, hdrp_v4 light, hdrp_v3 position)
{
    hdrp_v3 center = hdrp_v3_from_v4(blocker.center);
    hdrp_v3 right = hdrp_v3_from_v4(blocker.right_half);
    hdrp_v3 up = hdrp_v3_from_v4(blocker.up_half);
    hdrp_v3 p = hdrp_v3_sub(position, center);
    hdrp_v3 l = hdrp_v3_sub(hdrp_v3_from_v4(light), hdrp_v3_scale(center, light.w));
    float a = hdrp_i_cull_blocker_dot(p, hdrp_v3_from_v4(blocker.front));
    float b = hdrp_i_cull_blocker_dot(l, hdrp_v3_from_v4(blocker.front));
    float x =
        hdrp_abs(a * hdrp_i_cull_blocker_dot(l, right) - b * hdrp_i_cull_blocker_dot(p, right));
    float y = hdrp_abs(a * hdrp_i_cull_blocker_dot(l, up) - b * hdrp_i_cull_blocker_dot(p, up));
    float whole = hdrp_abs(b - a * light.w);
    float crosses = (a < 0.0f && b > 0.0f) || (a > 0.0f && b < 0.0f) ? 1.0f : 0.0f;
    float blocks =
        x <= blocker.right_half.w * whole && y <= blocker.up_half.w * whole ? crosses : 0.0f;
    float behind = a < 0.0f ? 1.0f : 0.0f;
    blocks = blocker.bits.x == HDRP_CULL_BLOCKER_RECTANGLE ? blocks : 0.0f;
    return blocker.bits.x == HDRP_CULL_BLOCKER_PLANE ? behind : blocks;
}

/** Visibility of a light after one more blocker.
 *  visible  [0,1]  before
 *  blocks   [0,1]  hdrp_cull_blocker_blocks of the blocker
 *  through  [0,1]  the largest of its portals, 0 where it has none
 *  returns  [0,1]
 *  edges    none
 *  error    none: a definition; exact for 0 and 1
 *  source   a definition
 *  note     shares between 0 and 1, of several samples of an area light, work as well */
HDRP_FN float hdrp_cull_blocker_visible(float visible, float blocks, float through)
{
    return visible * (1.0f - blocks * (1.0f - through));
}

/* A direction in view space. */
HDRP_FN hdrp_v3 hdrp_i_cull_blocker_turn(hdrp_v3 a, hdrp_cull_camera camera)
{
    return hdrp_v3_make(hdrp_i_cull_blocker_dot(a, hdrp_v3_from_v4(camera.right_far)),
                        hdrp_i_cull_blocker_dot(a, hdrp_v3_from_v4(camera.up)),
                        hdrp_i_cull_blocker_dot(a, hdrp_v3_from_v4(camera.forward_orthographic)));
}

/** A blocker in view space.
 *  blocker  valid
 *  camera   valid
 *  returns  any
 *  edges    none
 *  error    none: hdrp_cull_view_from_world, and the same for axes
 *  source   a definition */
HDRP_FN hdrp_cull_blocker hdrp_cull_blocker_in_view(hdrp_cull_blocker blocker,
                                                    hdrp_cull_camera camera)
{
    hdrp_v3 center = hdrp_cull_view_from_world(hdrp_v3_from_v4(blocker.center), camera);
    hdrp_v3 right = hdrp_i_cull_blocker_turn(hdrp_v3_from_v4(blocker.right_half), camera);
    hdrp_v3 up = hdrp_i_cull_blocker_turn(hdrp_v3_from_v4(blocker.up_half), camera);
    hdrp_v3 front = hdrp_i_cull_blocker_turn(hdrp_v3_from_v4(blocker.front), camera);
    blocker.center = hdrp_v4_from_v3(center, 0.0f);
    blocker.right_half = hdrp_v4_from_v3(right, blocker.right_half.w);
    blocker.up_half = hdrp_v4_from_v3(up, blocker.up_half.w);
    blocker.front = hdrp_v4_from_v3(front, 0.0f);
    return blocker;
}

/** The place of a light in view space.
 *  place    [-1e18,1e18]  hdrp_cull_light_place
 *  camera   valid
 *  returns  any
 *  edges    none
 *  error    none: hdrp_cull_view_from_world, and the same for directions
 *  source   a definition */
HDRP_FN hdrp_v4 hdrp_cull_light_place_in_view(hdrp_v4 place, hdrp_cull_camera camera)
{
    hdrp_v3 p = hdrp_v3_from_v4(place);
    return hdrp_v4_from_v3(hdrp_v3_select(place.w, hdrp_cull_view_from_world(p, camera),
                                          hdrp_i_cull_blocker_turn(p, camera)),
                           place.w);
}

/* >>shadows in tiles
 * The shadow of a rectangle is convex: behind its plane as seen from the light, and inside four
 * planes through the light and its edges. For one light both sides of every comparison of
 * hdrp_cull_blocker_blocks are linear in the position: those are the planes, and there is no
 * division that would lose digits where the light is close to the rectangle. */

#define HDRP_CULL_SHADOW_NONE  0u /* nothing is in the shadow */
#define HDRP_CULL_SHADOW_WHOLE 1u /* all is */
#define HDRP_CULL_SHADOW_PIXEL 2u /* a part may be */

/* Where the shadow of a pair of blocker and light is in a tile. */
struct hdrp_cull_shadow {
    hdrp_cull_interval reached; /* any: depths between which a part of the tile may be in it */
    hdrp_cull_interval covered; /* any: depths between which all of the tile is */
};
HDRP_TYPEDEF(hdrp_cull_shadow)

/* More than any depth. */
#define HDRP_I_CULL_BLOCKER_FAR 3e38f

/* A light in the frame of a blocker: in front of it, at z > 0. */
struct hdrp_i_cull_blocker_pair {
    hdrp_cull_blocker blocker;
    hdrp_v4 light;
    float x, y, z;     /* the light from the centre, or its direction; times w */
    float half_size;   /* the larger */
    float center_size; /* of the centre; what follows measures rounding too */
    float light_size;  /* of the light and the centre */
    float offset_size; /* |x| + |y| + |z| */
};
HDRP_TYPEDEF(hdrp_i_cull_blocker_pair)

HDRP_FN hdrp_i_cull_blocker_pair hdrp_i_cull_blocker_pair_make(hdrp_cull_blocker blocker,
                                                               hdrp_v4 light)
{
    hdrp_i_cull_blocker_pair r;
    hdrp_v3 c = hdrp_v3_from_v4(blocker.center);
    hdrp_v3 l = hdrp_v3_sub(hdrp_v3_from_v4(light), hdrp_v3_scale(c, light.w));
    r.blocker = blocker;
    r.light = light;
    r.x = hdrp_i_cull_blocker_dot(l, hdrp_v3_from_v4(blocker.right_half));
    r.y = hdrp_i_cull_blocker_dot(l, hdrp_v3_from_v4(blocker.up_half));
    r.z = hdrp_i_cull_blocker_dot(l, hdrp_v3_from_v4(blocker.front));
    r.half_size = hdrp_max(blocker.right_half.w, blocker.up_half.w);
    r.center_size = hdrp_i_cull_blocker_size(c);
    r.light_size = hdrp_i_cull_blocker_size(hdrp_v3_from_v4(light)) + light.w * r.center_size;
    r.offset_size = hdrp_abs(r.x) + hdrp_abs(r.y) + hdrp_abs(r.z);
    return r;
}

/* The same pair from the other side. */
HDRP_FN hdrp_i_cull_blocker_pair hdrp_i_cull_blocker_turned(hdrp_i_cull_blocker_pair r)
{
    r.blocker.front = hdrp_v4_from_v3(hdrp_v3_neg(hdrp_v3_from_v4(r.blocker.front)), 0.0f);
    r.z = -r.z;
    return r;
}

/* How far inside the planes of a shadow a position is, and what rounding may make of that. */
struct hdrp_i_cull_blocker_at {
    hdrp_v4 side;
    float front;
    float side_margin;
    float front_margin;
};
HDRP_TYPEDEF(hdrp_i_cull_blocker_at)

HDRP_FN hdrp_i_cull_blocker_at hdrp_i_cull_blocker_at_make(hdrp_i_cull_blocker_pair r, hdrp_v3 p)
{
    hdrp_i_cull_blocker_at at;
    hdrp_v3 d = hdrp_v3_sub(p, hdrp_v3_from_v4(r.blocker.center));
    float a = hdrp_i_cull_blocker_dot(d, hdrp_v3_from_v4(r.blocker.front));
    float u = hdrp_i_cull_blocker_dot(d, hdrp_v3_from_v4(r.blocker.right_half));
    float v = hdrp_i_cull_blocker_dot(d, hdrp_v3_from_v4(r.blocker.up_half));
    float across = r.z - a * r.light.w;
    float x = a * r.x - r.z * u;
    float y = a * r.y - r.z * v;
    float half_x = across * r.blocker.right_half.w;
    float half_y = across * r.blocker.up_half.w;
    float size = hdrp_i_cull_blocker_size(p) + r.center_size;
    float spread = hdrp_abs(a) + hdrp_abs(u) + hdrp_abs(v);
    at.side = hdrp_v4_make(half_x - x, half_x + x, half_y - y, half_y + y);
    at.front = -a;
    /* Each factor of a product is uncertain by twice HDRP_CULL_MARGIN of what it is made of. */
    at.front_margin = 2.0f * HDRP_CULL_MARGIN * size;
    at.side_margin =
        2.0f * HDRP_CULL_MARGIN *
        (size * (r.light.w * r.half_size + r.offset_size) + r.light_size * (r.half_size + spread));
    if (r.blocker.bits.x == HDRP_CULL_BLOCKER_PLANE) {
        at.side = hdrp_v4_make(1.0f, 1.0f, 1.0f, 1.0f);
        at.side_margin = 0.0f;
    }
    return at;
}

/* Farther out by its margins times a factor, which is negative for farther in. */
HDRP_FN hdrp_i_cull_blocker_at hdrp_i_cull_blocker_moved(hdrp_i_cull_blocker_at at, float factor)
{
    float m = at.side_margin * factor;
    at.side = hdrp_v4_make(at.side.x + m, at.side.y + m, at.side.z + m, at.side.w + m);
    at.front = at.front + at.front_margin * factor;
    return at;
}

/* An edge of a tile: its values at depth 0, at the depth of the blocker, and at the far end. In
 * between, values are linear and margins are convex; a line of margins from end to end would allow
 * for far too much where the blocker is. */
struct hdrp_i_cull_blocker_edge {
    hdrp_i_cull_blocker_at first, middle, last;
};
HDRP_TYPEDEF(hdrp_i_cull_blocker_edge)

HDRP_FN hdrp_v3 hdrp_i_cull_blocker_place(float u, float v, float z, float orthographic)
{
    float k = orthographic > 0.0f ? 1.0f : z;
    return hdrp_v3_make(u * k, v * k, z);
}

HDRP_FN hdrp_i_cull_blocker_edge hdrp_i_cull_blocker_edge_make(hdrp_i_cull_blocker_pair r, float u,
                                                               float v, hdrp_v3 depths,
                                                               float orthographic)
{
    hdrp_i_cull_blocker_edge e;
    e.first =
        hdrp_i_cull_blocker_at_make(r, hdrp_i_cull_blocker_place(u, v, depths.x, orthographic));
    e.middle =
        hdrp_i_cull_blocker_at_make(r, hdrp_i_cull_blocker_place(u, v, depths.y, orthographic));
    e.last =
        hdrp_i_cull_blocker_at_make(r, hdrp_i_cull_blocker_place(u, v, depths.z, orthographic));
    return e;
}

HDRP_FN hdrp_i_cull_blocker_edge hdrp_i_cull_blocker_edge_moved(hdrp_i_cull_blocker_edge e,
                                                                float factor)
{
    e.first = hdrp_i_cull_blocker_moved(e.first, factor);
    e.middle = hdrp_i_cull_blocker_moved(e.middle, factor);
    e.last = hdrp_i_cull_blocker_moved(e.last, factor);
    return e;
}

/* Where a line through (z0, f0) and (z1, f1) is 0; from the nearer end, whose digits count. */
HDRP_FN float hdrp_i_cull_blocker_root(float z0, float f0, float z1, float f1)
{
    return z0 + (z1 - z0) * (f0 / (f0 - f1));
}

/* Shortens an interval to the depths at which a value is not negative. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_limit(hdrp_cull_interval r, hdrp_v3 depths, float f0,
                                                     float f1, float f2)
{
    float lo = depths.x;
    float hi = depths.z;
    if (f0 < 0.0f) {
        lo = f1 >= 0.0f ? hdrp_i_cull_blocker_root(depths.x, f0, depths.y, f1)
                        : hdrp_i_cull_blocker_root(depths.y, f1, depths.z, f2);
        lo = hdrp_max(f1, f2) >= 0.0f ? lo : HDRP_I_CULL_BLOCKER_FAR;
    }
    if (f2 < 0.0f) {
        hi = f1 >= 0.0f ? hdrp_i_cull_blocker_root(depths.y, f1, depths.z, f2)
                        : hdrp_i_cull_blocker_root(depths.x, f0, depths.y, f1);
        hi = hdrp_max(f0, f1) >= 0.0f ? hi : -HDRP_I_CULL_BLOCKER_FAR;
    }
    r.nearest = hdrp_max(lo, r.nearest);
    r.farthest = hdrp_min(hi, r.farthest);
    return r;
}

/* The same for all five planes. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_inside(hdrp_cull_interval r, hdrp_v3 z,
                                                      hdrp_i_cull_blocker_edge e)
{
    hdrp_v4 a = e.first.side, b = e.middle.side, c = e.last.side;
    r = hdrp_i_cull_blocker_limit(r, z, e.first.front, e.middle.front, e.last.front);
    r = hdrp_i_cull_blocker_limit(r, z, a.x, b.x, c.x);
    r = hdrp_i_cull_blocker_limit(r, z, a.y, b.y, c.y);
    r = hdrp_i_cull_blocker_limit(r, z, a.z, b.z, c.z);
    return hdrp_i_cull_blocker_limit(r, z, a.w, b.w, c.w);
}

/* The interval around both. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_join(hdrp_cull_interval a, hdrp_cull_interval b)
{
    if (b.nearest <= b.farthest) {
        a.nearest = hdrp_min(b.nearest, a.nearest);
        a.farthest = hdrp_max(b.farthest, a.farthest);
    }
    return a;
}

HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_interval(float nearest, float farthest)
{
    hdrp_cull_interval r;
    r.nearest = nearest;
    r.farthest = farthest;
    return r;
}

HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_nowhere(void)
{
    return hdrp_i_cull_blocker_interval(HDRP_I_CULL_BLOCKER_FAR, -HDRP_I_CULL_BLOCKER_FAR);
}

/* Shortens an interval of t to where f0 + t f1 is not negative. It begins at 0 or more. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_clip(hdrp_cull_interval t, float f0, float f1)
{
    float at = -f0 / (f1 == 0.0f ? 1.0f : f1);
    float enters = f1 > 0.0f ? at : HDRP_I_CULL_BLOCKER_FAR;
    float leaves = f1 < 0.0f ? at : HDRP_I_CULL_BLOCKER_FAR;
    t.nearest = hdrp_max(f0 < 0.0f ? enters : 0.0f, t.nearest);
    t.farthest = hdrp_min(f0 < 0.0f ? HDRP_I_CULL_BLOCKER_FAR : leaves, t.farthest);
    return t;
}

/* Adds a depth where the line between two positions of that depth enters the shadow. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_across(hdrp_cull_interval r, float z,
                                                      hdrp_i_cull_blocker_at a,
                                                      hdrp_i_cull_blocker_at b)
{
    hdrp_cull_interval t = hdrp_i_cull_blocker_interval(0.0f, 1.0f);
    t = hdrp_i_cull_blocker_clip(t, a.front, b.front - a.front);
    t = hdrp_i_cull_blocker_clip(t, a.side.x, b.side.x - a.side.x);
    t = hdrp_i_cull_blocker_clip(t, a.side.y, b.side.y - a.side.y);
    t = hdrp_i_cull_blocker_clip(t, a.side.z, b.side.z - a.side.z);
    t = hdrp_i_cull_blocker_clip(t, a.side.w, b.side.w - a.side.w);
    if (t.nearest <= t.farthest) {
        r = hdrp_i_cull_blocker_join(r, hdrp_i_cull_blocker_interval(z, z));
    }
    return r;
}

/* How far a position is inside the sides of a tile, or a direction leads there, and a margin more.
 * Across is z, or in the orthographic case 1 and 0. */
HDRP_FN hdrp_v4 hdrp_i_cull_blocker_sides(hdrp_cull_tile tile, hdrp_v3 p, float across,
                                          float margin)
{
    hdrp_v4 w = tile.window;
    return hdrp_v4_make(p.x - w.x * across + margin, w.y * across - p.x + margin,
                        p.y - w.z * across + margin, w.w * across - p.y + margin);
}

/* Edges of a shadow: four from the corners of the rectangle away from the light, four around it. */
struct hdrp_i_cull_blocker_edges {
    hdrp_v3 x, y;             /* from the centre to the edges of the rectangle */
    float z_max;              /* of the tile */
    float p_margin, d_margin; /* rounding of a corner, and of the direction from the light to it */
    float p_factor, p_more;   /* what that may make of the distance to a side of the tile */
    float orthographic;
};
HDRP_TYPEDEF(hdrp_i_cull_blocker_edges)

HDRP_FN hdrp_i_cull_blocker_edges hdrp_i_cull_blocker_edges_make(hdrp_i_cull_blocker_pair s,
                                                                 hdrp_cull_tile tile, float z_max,
                                                                 float orthographic)
{
    hdrp_i_cull_blocker_edges e;
    float wide = 1.0f + hdrp_max(tile.extent.x, tile.extent.y);
    e.x = hdrp_v3_scale(hdrp_v3_from_v4(s.blocker.right_half), s.blocker.right_half.w);
    e.y = hdrp_v3_scale(hdrp_v3_from_v4(s.blocker.up_half), s.blocker.up_half.w);
    e.z_max = z_max;
    e.p_margin = 2.0f * HDRP_CULL_MARGIN * (s.center_size + 2.0f * s.half_size);
    e.d_margin = 2.0f * HDRP_CULL_MARGIN * (s.light_size + s.light.w * 2.0f * s.half_size);
    e.p_factor = orthographic > 0.0f ? 1.0f : wide;
    e.p_more = orthographic > 0.0f ? HDRP_CULL_MARGIN * wide : 0.0f;
    e.orthographic = orthographic;
    return e;
}

HDRP_FN hdrp_v3 hdrp_i_cull_blocker_corner(hdrp_i_cull_blocker_pair s, hdrp_i_cull_blocker_edges e,
                                           hdrp_u32 i)
{
    hdrp_v3 p = hdrp_i_cull_blocker_mad(hdrp_v3_from_v4(s.blocker.center), e.x,
                                        (i & 1u) != 0u ? 1.0f : -1.0f);
    return hdrp_i_cull_blocker_mad(p, e.y, (i & 2u) != 0u ? 1.0f : -1.0f);
}

/* From the light to a corner. */
HDRP_FN hdrp_v3 hdrp_i_cull_blocker_away(hdrp_i_cull_blocker_pair s, hdrp_v3 corner)
{
    return hdrp_v3_sub(hdrp_v3_scale(corner, s.light.w), hdrp_v3_from_v4(s.light));
}

HDRP_FN hdrp_v4 hdrp_i_cull_blocker_sides_at(hdrp_cull_tile tile, hdrp_i_cull_blocker_edges e,
                                             hdrp_v3 p)
{
    return hdrp_i_cull_blocker_sides(tile, p, e.orthographic > 0.0f ? 1.0f : p.z,
                                     e.p_margin * e.p_factor + e.p_more);
}

HDRP_FN hdrp_v4 hdrp_i_cull_blocker_sides_along(hdrp_cull_tile tile, hdrp_i_cull_blocker_edges e,
                                                hdrp_v3 d, float margin)
{
    return hdrp_i_cull_blocker_sides(tile, d, e.orthographic > 0.0f ? 0.0f : d.z,
                                     margin * e.p_factor);
}

/* Adds the part of an edge, p + t d with t from 0, that is in the tile. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_trace(hdrp_cull_interval r, hdrp_cull_tile tile,
                                                     hdrp_i_cull_blocker_edges e, hdrp_v3 p,
                                                     hdrp_v3 d, float t_max, float d_margin)
{
    hdrp_cull_interval t = hdrp_i_cull_blocker_interval(0.0f, t_max);
    hdrp_v4 f0 = hdrp_i_cull_blocker_sides_at(tile, e, p);
    hdrp_v4 f1 = hdrp_i_cull_blocker_sides_along(tile, e, d, d_margin);
    float z0, z1;
    t = hdrp_i_cull_blocker_clip(t, f0.x, f1.x);
    t = hdrp_i_cull_blocker_clip(t, f0.y, f1.y);
    t = hdrp_i_cull_blocker_clip(t, f0.z, f1.z);
    t = hdrp_i_cull_blocker_clip(t, f0.w, f1.w);
    /* Nothing that can be computed with is farther; a longer edge never leaves the tile. */
    t.farthest = hdrp_min(t.farthest, 1e24f);
    if (t.nearest <= t.farthest) {
        z0 = hdrp_min(t.nearest * (d.z - d_margin), t.farthest * (d.z - d_margin));
        z1 = hdrp_max(t.nearest * (d.z + d_margin), t.farthest * (d.z + d_margin));
        z0 = p.z + z0 - e.p_margin;
        z1 = p.z + z1 + e.p_margin;
        if (z0 <= e.z_max && z1 >= 0.0f) {
            r = hdrp_i_cull_blocker_join(r, hdrp_i_cull_blocker_interval(z0, z1));
        }
    }
    return r;
}

/* Adds all edges. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_trace_all(hdrp_cull_interval r,
                                                         hdrp_i_cull_blocker_pair s,
                                                         hdrp_cull_tile tile,
                                                         hdrp_i_cull_blocker_edges e)
{
    hdrp_u32 i;
    for (i = 0u; i < 4u; ++i) {
        hdrp_v3 p = hdrp_i_cull_blocker_corner(s, e, i);
        hdrp_v3 along = hdrp_v3_scale(e.x, i == 0u ? 2.0f : -2.0f);
        if (i == 1u || i == 2u) {
            along = hdrp_v3_scale(e.y, i == 1u ? 2.0f : -2.0f);
        }
        r = hdrp_i_cull_blocker_trace(r, tile, e, p, along, 1.0f, e.p_margin);
        r = hdrp_i_cull_blocker_trace(r, tile, e, p, hdrp_i_cull_blocker_away(s, p),
                                      HDRP_I_CULL_BLOCKER_FAR, e.d_margin);
    }
    return r;
}

/* Widens what the planes of a shadow are known to be at most. */
HDRP_FN hdrp_v4 hdrp_i_cull_blocker_most(hdrp_v4 m, hdrp_v4 side)
{
    return hdrp_v4_make(hdrp_max(side.x, m.x), hdrp_max(side.y, m.y), hdrp_max(side.z, m.z),
                        hdrp_max(side.w, m.w));
}

HDRP_FN float hdrp_i_cull_blocker_least(hdrp_v4 m)
{
    return hdrp_min(hdrp_min(m.x, m.y), hdrp_min(m.z, m.w));
}

/* 1 where the whole shadow is outside one side of the tile: its corners, and its directions. */
HDRP_FN float hdrp_i_cull_blocker_beside(hdrp_i_cull_blocker_pair s, hdrp_cull_tile tile,
                                         hdrp_i_cull_blocker_edges e)
{
    hdrp_v4 m = hdrp_v4_make(-1.0f, -1.0f, -1.0f, -1.0f);
    hdrp_u32 i;
    for (i = 0u; i < 4u; ++i) {
        hdrp_v3 p = hdrp_i_cull_blocker_corner(s, e, i);
        m = hdrp_i_cull_blocker_most(m, hdrp_i_cull_blocker_sides_at(tile, e, p));
        m = hdrp_i_cull_blocker_most(m, hdrp_i_cull_blocker_sides_along(
                                            tile, e, hdrp_i_cull_blocker_away(s, p), e.d_margin));
    }
    return hdrp_i_cull_blocker_least(m) < 0.0f ? 1.0f : 0.0f;
}

/* An edge of a tile, of the four around it. */
HDRP_FN hdrp_i_cull_blocker_edge hdrp_i_cull_blocker_edge_of(hdrp_i_cull_blocker_pair s,
                                                             hdrp_cull_tile tile, hdrp_u32 i,
                                                             hdrp_v3 z, float orthographic)
{
    float u = i == 1u || i == 2u ? tile.window.y : tile.window.x;
    float v = i < 2u ? tile.window.z : tile.window.w;
    return hdrp_i_cull_blocker_edge_make(s, u, v, z, orthographic);
}

/* What the edges of a tile say of it. Values that have been moved outwards are largest at an end;
 * below -1 they are not told apart. */
struct hdrp_i_cull_blocker_outline {
    hdrp_cull_interval covered;
    hdrp_v4 first, last; /* the most inside each side of the shadow that an end of an edge is */
    float front;         /* likewise, of both ends */
};
HDRP_TYPEDEF(hdrp_i_cull_blocker_outline)

/* Edges are made one by one, and once more by what needs them: all of them are more than a GPU has
 * registers for. */
HDRP_FN hdrp_i_cull_blocker_outline hdrp_i_cull_blocker_outline_make(hdrp_i_cull_blocker_pair s,
                                                                     hdrp_cull_tile tile, hdrp_v3 z,
                                                                     float orthographic)
{
    hdrp_i_cull_blocker_outline o;
    hdrp_u32 i;
    o.covered = hdrp_i_cull_blocker_interval(z.x, z.z);
    o.first = hdrp_v4_make(-1.0f, -1.0f, -1.0f, -1.0f);
    o.last = o.first;
    o.front = -1.0f;
    for (i = 0u; i < 4u; ++i) {
        hdrp_i_cull_blocker_edge e = hdrp_i_cull_blocker_edge_of(s, tile, i, z, orthographic);
        o.covered =
            hdrp_i_cull_blocker_inside(o.covered, z, hdrp_i_cull_blocker_edge_moved(e, -1.0f));
        e = hdrp_i_cull_blocker_edge_moved(e, 1.0f);
        o.first = hdrp_i_cull_blocker_most(o.first, e.first.side);
        o.last = hdrp_i_cull_blocker_most(o.last, e.last.side);
        o.front = hdrp_max(hdrp_max(e.first.front, e.last.front), o.front);
    }
    return o;
}

/* 1 where all of the tile is outside one plane of the shadow. */
HDRP_FN float hdrp_i_cull_blocker_apart(hdrp_i_cull_blocker_outline o)
{
    hdrp_v4 m = hdrp_i_cull_blocker_most(o.first, o.last);
    return hdrp_min(hdrp_i_cull_blocker_least(m), o.front) < 0.0f ? 1.0f : 0.0f;
}

/* Adds where the edges of the tile are in the shadow, whose planes have been moved outwards, and
 * the far end, or the near one, of the tile where its outline enters it. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_enter(hdrp_cull_interval r,
                                                     hdrp_i_cull_blocker_pair s,
                                                     hdrp_cull_tile tile, hdrp_v3 z,
                                                     float orthographic,
                                                     hdrp_i_cull_blocker_outline o)
{
    hdrp_cull_interval whole = hdrp_i_cull_blocker_interval(z.x, z.z);
    float near_end =
        orthographic > 0.0f && hdrp_i_cull_blocker_least(o.first) >= 0.0f ? 1.0f : 0.0f;
    float far_end = hdrp_i_cull_blocker_least(o.last) >= 0.0f ? 1.0f : 0.0f;
    hdrp_i_cull_blocker_edge before = hdrp_i_cull_blocker_edge_moved(
        hdrp_i_cull_blocker_edge_of(s, tile, 3u, z, orthographic), 1.0f);
    hdrp_u32 i;
    for (i = 0u; i < 4u; ++i) {
        hdrp_i_cull_blocker_edge e = hdrp_i_cull_blocker_edge_moved(
            hdrp_i_cull_blocker_edge_of(s, tile, i, z, orthographic), 1.0f);
        r = hdrp_i_cull_blocker_join(r, hdrp_i_cull_blocker_inside(whole, z, e));
        if (far_end > 0.0f) {
            r = hdrp_i_cull_blocker_across(r, z.z, before.last, e.last);
        }
        if (near_end > 0.0f) {
            r = hdrp_i_cull_blocker_across(r, z.x, before.first, e.first);
        }
        before = e;
    }
    return r;
}

/* Where some of the tile is in the shadow: the nearest and farthest places of two convex bodies
 * that meet are on an edge of one of them. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_blocker_reached(hdrp_i_cull_blocker_pair s,
                                                       hdrp_cull_tile tile, hdrp_v3 z,
                                                       float orthographic,
                                                       hdrp_i_cull_blocker_outline o)
{
    hdrp_cull_interval r = hdrp_i_cull_blocker_nowhere();
    float finite = s.blocker.bits.x == HDRP_CULL_BLOCKER_RECTANGLE ? 1.0f : 0.0f;
    hdrp_i_cull_blocker_edges e = hdrp_i_cull_blocker_edges_make(s, tile, z.z, orthographic);
    float apart = hdrp_i_cull_blocker_apart(o);
    if (apart <= 0.0f && finite > 0.0f) {
        apart = hdrp_i_cull_blocker_beside(s, tile, e);
    }
    if (apart <= 0.0f) {
        r = hdrp_i_cull_blocker_enter(r, s, tile, z, orthographic, o);
        if (finite > 0.0f) {
            r = hdrp_i_cull_blocker_trace_all(r, s, tile, e);
        }
    }
    return r;
}

/* A pair that is not far away, with the light in front. */
HDRP_FN hdrp_cull_shadow hdrp_i_cull_blocker_cast(hdrp_i_cull_blocker_pair s, hdrp_cull_tile tile,
                                                  hdrp_cull_interval depths, float orthographic)
{
    hdrp_cull_shadow r;
    hdrp_v3 z =
        hdrp_v3_make(0.0f, hdrp_clamp(s.blocker.center.z, 0.0f, depths.farthest), depths.farthest);
    hdrp_i_cull_blocker_outline o = hdrp_i_cull_blocker_outline_make(s, tile, z, orthographic);
    r.reached = hdrp_i_cull_blocker_interval(z.x, z.z);
    r.covered = o.covered;
    if (r.covered.nearest > depths.nearest || r.covered.farthest < depths.farthest) {
        r.reached = hdrp_i_cull_blocker_reached(s, tile, z, orthographic, o);
    }
    return r;
}

/** The shadow of a blocker in a tile; or the light of a portal.
 *  blocker       any    in view space
 *  light         any    hdrp_cull_light_place, in view space
 *  tile          valid
 *  depths        any    of all cells of the tile: what is outside does not count
 *  orthographic  [0,1]  1 for an orthographic camera
 *  returns       any    reached.nearest > reached.farthest where it does not meet the tile, and
 *                covered likewise, where at no depth all of the tile is in the shadow
 *  edges         where blocker or light are farther than HDRP_CULL_DISTANCE_MAX, or that large, it
 *                may reach everything and covers nothing; it covers nothing where the light is in
 *                the plane of a rectangle, up to rounding
 *  error         none: reached encloses and covered is enclosed, by the true intervals with
 *                blocker, light and positions uncertain by 2e-6 of their distances
 *  source        derived: the tile is at each depth a rectangle, whose corners are in the shadow
 *                between two depths; the nearest and farthest places that two convex bodies share
 *                are on an edge of one of them */
HDRP_FN hdrp_cull_shadow hdrp_cull_shadow_make(hdrp_cull_blocker blocker, hdrp_v4 light,
                                               hdrp_cull_tile tile, hdrp_cull_interval depths,
                                               float orthographic)
{
    hdrp_cull_shadow r;
    hdrp_i_cull_blocker_pair s = hdrp_i_cull_blocker_pair_make(blocker, light);
    hdrp_u32 kind = blocker.bits.x;
    float size = hdrp_max(s.center_size, s.half_size);
    float uncertain = 0.0f;
    hdrp_u32 i;
    if (kind == HDRP_CULL_BLOCKER_RECTANGLE) {
        size = hdrp_max(s.light_size, size);
        uncertain = hdrp_abs(s.z) <= 2.0f * HDRP_CULL_MARGIN * s.light_size ? 1.0f : 0.0f;
        if (s.z < 0.0f) {
            s = hdrp_i_cull_blocker_turned(s);
        }
    }
    depths.farthest = hdrp_clamp(depths.farthest, 0.0f, HDRP_CULL_FAR_INFINITE) *
                      (1.0f + 4.0f * HDRP_CULL_MARGIN);
    r.reached = hdrp_i_cull_blocker_nowhere();
    r.covered = r.reached;
    for (i = 0u; i < 2u; ++i) { /* one text for both sides, for it is long */
        if (i == 0u || uncertain > 0.0f) {
            hdrp_cull_shadow one = hdrp_i_cull_blocker_cast(s, tile, depths, orthographic);
            r.reached = hdrp_i_cull_blocker_join(r.reached, one.reached);
            r.covered = uncertain > 0.0f ? r.covered : one.covered;
            s = hdrp_i_cull_blocker_turned(s);
        }
    }
    if (!(size <= HDRP_CULL_DISTANCE_MAX)) {
        r.reached = hdrp_i_cull_blocker_interval(-HDRP_I_CULL_BLOCKER_FAR, HDRP_I_CULL_BLOCKER_FAR);
        r.covered = hdrp_i_cull_blocker_nowhere();
    }
    if (kind != HDRP_CULL_BLOCKER_RECTANGLE && kind != HDRP_CULL_BLOCKER_PLANE) {
        r.reached = hdrp_i_cull_blocker_nowhere();
        r.covered = r.reached;
    }
    return r;
}

/** How much of a cell is in a shadow.
 *  shadow   any
 *  depths   any   of the cell, inside those that the shadow was made for
 *  returns  [0,2]  HDRP_CULL_SHADOW_...
 *  edges    depths count as 1e-6 wider; a cell without depths and NaN are a part
 *  error    none: a selection
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_shadow_class(hdrp_cull_shadow shadow, hdrp_cull_interval depths)
{
    float nearest = depths.nearest * (1.0f - HDRP_CULL_MARGIN);
    float farthest = depths.farthest * (1.0f + HDRP_CULL_MARGIN);
    hdrp_u32 r = HDRP_CULL_SHADOW_PIXEL;
    if (shadow.covered.nearest <= nearest && nearest <= farthest &&
        farthest <= shadow.covered.farthest) {
        r = HDRP_CULL_SHADOW_WHOLE;
    }
    if (farthest < shadow.reached.nearest || shadow.reached.farthest < nearest ||
        shadow.reached.nearest > shadow.reached.farthest) {
        r = HDRP_CULL_SHADOW_NONE;
    }
    return r;
}

/** Whether a blocker with portals has to be asked for, from the classes of both.
 *  blocker  [0,2]  class of the blocker: HDRP_CULL_SHADOW_...
 *  portals  [0,2]  the largest of its portals by rank none, pixel, whole; none where it has none
 *  returns  [0,2]  none: it does not matter; whole: no light arrives; pixel: pixels have to test it
 *  edges    none
 *  error    none: a selection
 *  source   Kircher 2018, "Rendering Technology in Agents of Mayhem", slides on blocker tile
 *           culling */
HDRP_FN hdrp_u32 hdrp_cull_shadow_through(hdrp_u32 blocker, hdrp_u32 portals)
{
    hdrp_u32 r = blocker;
    r = portals == HDRP_CULL_SHADOW_PIXEL && blocker == HDRP_CULL_SHADOW_WHOLE
            ? HDRP_CULL_SHADOW_PIXEL
            : r;
    return portals == HDRP_CULL_SHADOW_WHOLE ? HDRP_CULL_SHADOW_NONE : r;
}

#ifndef HDRP_GPU
#ifdef __cplusplus
extern "C" {
#endif

/* The array has a negative size, which is an error in every C and C++, where an offset is wrong. */
#define HDRP_I_CULL_BLOCKER_OFFSET(member, offset)                                                 \
    typedef char                                                                                   \
        hdrp_i_cull_blocker_##member[offsetof(hdrp_cull_blocker, member) == (offset) ? 1 : -1];
HDRP_I_CULL_BLOCKER_OFFSET(center, 0)
HDRP_I_CULL_BLOCKER_OFFSET(right_half, 16)
HDRP_I_CULL_BLOCKER_OFFSET(up_half, 32)
HDRP_I_CULL_BLOCKER_OFFSET(front, 48)
HDRP_I_CULL_BLOCKER_OFFSET(bits, 64)
typedef char hdrp_i_cull_blocker_size_of[sizeof(hdrp_cull_blocker) == 80u ? 1 : -1];
#undef HDRP_I_CULL_BLOCKER_OFFSET

/* >>blockers of all lights */

/* What a scene has, in the world. A shader reads the same arrays. */
typedef struct hdrp_cull_blocker_scene {
    const hdrp_v4* places;                 /* of each light: hdrp_cull_light_place */
    const hdrp_cull_blocker_links* lights; /* of each light, where its blockers are in links */
    const uint32_t* links;                 /* indices of blockers */
    const hdrp_cull_blocker* blockers;     /* and portals */
    uint32_t light_count; /* an index is that of a shape in lists; other shapes come later */
    uint32_t link_count;
    uint32_t blocker_count;
} hdrp_cull_blocker_scene;

/* Limits. */
typedef struct hdrp_cull_blocker_desc {
    uint32_t light_capacity;   /* [1,65535] */
    uint32_t link_capacity;    /* [1,1048576] */
    uint32_t blocker_capacity; /* [1,1048576] */
} hdrp_cull_blocker_desc;

/* A scene as a camera sees it. The members are for reading; init sets the pointers. */
typedef struct hdrp_cull_blocker_set {
    hdrp_cull_blocker_desc desc;
    hdrp_cull_blocker_scene scene;
    hdrp_cull_camera camera;
    hdrp_v4* places;             /* in view space */
    hdrp_cull_blocker* blockers; /* in view space */
    uint32_t* first_pair;        /* of each link: its blocker and then its portals */
    uint32_t pair_count;
} hdrp_cull_blocker_set;

/** Bytes that hdrp_cull_blocker_init needs.
 *  desc     limits
 *  returns  bytes, a multiple of HDRP_MEMORY_ALIGNMENT
 *  edges    0 where desc is NULL or not valid, or too large for the target */
HDRP_API size_t hdrp_cull_blocker_memory_size(const hdrp_cull_blocker_desc* desc);

/** Places a set in a block of memory. It is empty.
 *  set           result
 *  desc          limits
 *  memory        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT; it must outlive set
 *  memory_bytes  size of the block
 *  returns       HDRP_OK
 *  errors        HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT, HDRP_ERROR_TOO_LARGE,
 *                HDRP_ERROR_MEMORY_TOO_SMALL, HDRP_ERROR_MEMORY_ALIGNMENT */
HDRP_API hdrp_result hdrp_cull_blocker_init(hdrp_cull_blocker_set* set,
                                            const hdrp_cull_blocker_desc* desc, void* memory,
                                            size_t memory_bytes);

/** Begins a frame: takes over a scene, whose arrays must outlive the frame.
 *  set      from hdrp_cull_blocker_init
 *  scene    the arrays may be NULL where their counts are 0
 *  camera   from its makers
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT where a count is above its limit, a
 *           light has more than HDRP_CULL_BLOCKERS_MAX blockers or a blocker more than
 *           HDRP_CULL_PORTALS_MAX portals, or an index is too large; HDRP_ERROR_TOO_LARGE for more
 *           than 2^24 pairs */
HDRP_API hdrp_result hdrp_cull_blocker_begin(hdrp_cull_blocker_set* set,
                                             const hdrp_cull_blocker_scene* scene,
                                             const hdrp_cull_camera* camera);

/** Lights and blockers in view space.
 *  set      after hdrp_cull_blocker_begin
 *  first    [0,1114111]  of light_count + blocker_count: lights, then blockers
 *  count    [0,1114111]  how many
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range
 *  range    lights and blockers are independent */
HDRP_API hdrp_result hdrp_cull_blocker_project(hdrp_cull_blocker_set* set, uint32_t first,
                                               uint32_t count);

/** Whether a light reaches a position, in the world: the definition that a shader repeats.
 *  scene     the blockers
 *  light     any  index of the light
 *  mask      any  of the light in the cell of the position; 0xffffffff asks for all blockers
 *  position  m
 *  returns   1 where it does, else 0
 *  edges     1 where scene is NULL and for a light beyond light_count: nothing blocks those */
HDRP_API float hdrp_cull_blocker_light_visible(const hdrp_cull_blocker_scene* scene, uint32_t light,
                                               uint32_t mask, hdrp_v3 position);

/* >>blockers in cells
 * One tile after the other: hdrp_cull_apply_blockers of hdrp_cull.h does all of this for lists. */

/* How often something was decided: whole numbers, which jobs add up in any order. */
typedef struct hdrp_cull_blocker_stats {
    uint64_t shadows;        /* made: pairs of a light and a blocker or portal, in tiles */
    uint64_t none;           /* pairs of a light and a blocker in cells that may be forgotten */
    uint64_t whole;          /* that keep all light out */
    uint64_t pixel;          /* that pixels have to test */
    uint64_t lights;         /* asked for, in cells */
    uint64_t lights_removed; /* from them */
} hdrp_cull_blocker_stats;

/* What a job remembers. The members are for reading. */
typedef struct hdrp_cull_blocker_job {
    const hdrp_cull_blocker_set* set;
    hdrp_cull_shadow* shadows; /* of all pairs, as far as this tile has asked for them */
    uint32_t* blocker_tile;    /* of each link, in which tile its own shadow was made */
    uint32_t* portals_tile;    /* the same for those of its portals */
    uint32_t* light;           /* of each link, for which light: several may share a link */
    uint32_t tile_number;
    hdrp_cull_tile tile;
    hdrp_cull_interval depths;
    hdrp_cull_blocker_stats stats;
} hdrp_cull_blocker_job;

/** Bytes of scratch memory that a job needs.
 *  set      after hdrp_cull_blocker_begin
 *  returns  bytes, a multiple of HDRP_MEMORY_ALIGNMENT: 28 for each link and 16 for each of its
 *           portals, and less than 80
 *  edges    0 where set is NULL */
HDRP_API size_t hdrp_cull_blocker_scratch_size(const hdrp_cull_blocker_set* set);

/** Begins a job, of any number of tiles.
 *  job            result, with all counts 0
 *  set            after hdrp_cull_blocker_project of everything; it must outlive job
 *  scratch        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT
 *  scratch_bytes  size of the block
 *  returns        HDRP_OK
 *  errors         HDRP_ERROR_NULL_POINTER, HDRP_ERROR_MEMORY_TOO_SMALL, HDRP_ERROR_MEMORY_ALIGNMENT
 *  memory         jobs that run at the same time need scratch of their own, as long as they live
 *  range          the results for a tile do not depend on the tiles before it */
HDRP_API hdrp_result hdrp_cull_blocker_job_begin(hdrp_cull_blocker_job* job,
                                                 const hdrp_cull_blocker_set* set, void* scratch,
                                                 size_t scratch_bytes);

/** Goes on to a tile.
 *  job      after hdrp_cull_blocker_job_begin
 *  tile     hdrp_cull_tile_make
 *  depths   of all its cells
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER */
HDRP_API hdrp_result hdrp_cull_blocker_job_tile(hdrp_cull_blocker_job* job,
                                                const hdrp_cull_tile* tile,
                                                hdrp_cull_interval depths);

/** Classifies the blockers of a light in a cell of the tile.
 *  job      after hdrp_cull_blocker_job_tile
 *  light    any  index of the light, or of another shape
 *  depths   of the cell
 *  mask     result: bit k is set where pixels have to test blocker k of the light
 *  returns  1 where the light stays; 0 where a blocker keeps it from all of the cell
 *  edges    1 and no bits for a shape beyond light_count; a light that goes leaves no bits
 *  note     a shadow is made when a tile first asks for it, and serves its other cells too; that of
 *           a portal is made only where its blocker matters */
HDRP_API uint32_t hdrp_cull_blocker_classify(hdrp_cull_blocker_job* job, uint32_t light,
                                             hdrp_cull_interval depths, uint32_t* mask);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT DEFAULT
#endif

#endif /* HDRP_CULL_BLOCKER_H */

#if defined(HDRP_CULL_IMPLEMENTATION) && !defined(HDRP_GPU) &&                                     \
    !defined(HDRP_I_CULL_BLOCKER_IMPLEMENTED)
#define HDRP_I_CULL_BLOCKER_IMPLEMENTED

/* Masks are the same bits whether or not the target has fused multiply-adds. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC push_options
#pragma GCC optimize("fp-contract=off")
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- memory ---------------------------------------------------------------------------------- */

#define HDRP_I_CULL_BLOCKER_LIMIT (1u << 20)
#define HDRP_I_CULL_BLOCKER_PAIRS (1u << 24)

/* The next part of a block; with a NULL block it only counts. */
static void* hdrp_i_cull_blocker_take(void* block, size_t* used, size_t count, size_t size)
{
    void* place = block ? (unsigned char*)block + *used : NULL;
    *used += HDRP_MEMORY_ROUND_UP(count * size);
    return place;
}

static hdrp_result hdrp_i_cull_blocker_check(const void* memory, size_t bytes, size_t needed)
{
    if (!memory) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if ((uintptr_t)memory % HDRP_MEMORY_ALIGNMENT != 0u) {
        return HDRP_ERROR_MEMORY_ALIGNMENT;
    }
    return bytes < needed ? HDRP_ERROR_MEMORY_TOO_SMALL : HDRP_OK;
}

static size_t hdrp_i_cull_blocker_place_set(hdrp_cull_blocker_set* set,
                                            const hdrp_cull_blocker_desc* desc, void* memory)
{
    size_t used = 0u;
    memset(set, 0, sizeof *set);
    set->desc = *desc;
    set->places = (hdrp_v4*)hdrp_i_cull_blocker_take(memory, &used, desc->light_capacity,
                                                     sizeof *set->places);
    set->blockers = (hdrp_cull_blocker*)hdrp_i_cull_blocker_take(
        memory, &used, desc->blocker_capacity, sizeof *set->blockers);
    set->first_pair = (uint32_t*)hdrp_i_cull_blocker_take(memory, &used, desc->link_capacity,
                                                          sizeof *set->first_pair);
    return used;
}

HDRP_API size_t hdrp_cull_blocker_memory_size(const hdrp_cull_blocker_desc* desc)
{
    hdrp_cull_blocker_set set;
    if (!desc || desc->light_capacity < 1u || desc->light_capacity > 65535u ||
        desc->link_capacity < 1u || desc->link_capacity > HDRP_I_CULL_BLOCKER_LIMIT ||
        desc->blocker_capacity < 1u || desc->blocker_capacity > HDRP_I_CULL_BLOCKER_LIMIT) {
        return 0u;
    }
    return hdrp_i_cull_blocker_place_set(&set, desc, NULL); /* at most 90 MB */
}

HDRP_API hdrp_result hdrp_cull_blocker_init(hdrp_cull_blocker_set* set,
                                            const hdrp_cull_blocker_desc* desc, void* memory,
                                            size_t memory_bytes)
{
    size_t needed = hdrp_cull_blocker_memory_size(desc);
    hdrp_result r;
    if (!set || !desc) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (needed == 0u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    r = hdrp_i_cull_blocker_check(memory, memory_bytes, needed);
    if (r == HDRP_OK) {
        hdrp_i_cull_blocker_place_set(set, desc, memory);
    }
    return r;
}

/* ---- frames ---------------------------------------------------------------------------------- */

static hdrp_result hdrp_i_cull_blocker_check_scene(const hdrp_cull_blocker_desc* desc,
                                                   const hdrp_cull_blocker_scene* s)
{
    uint32_t i;
    if ((s->light_count > 0u && (!s->places || !s->lights)) || (s->link_count > 0u && !s->links) ||
        (s->blocker_count > 0u && !s->blockers)) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (s->light_count > desc->light_capacity || s->link_count > desc->link_capacity ||
        s->blocker_count > desc->blocker_capacity) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (i = 0u; i < s->light_count; ++i) {
        hdrp_cull_blocker_links l = s->lights[i];
        if (l.count > HDRP_CULL_BLOCKERS_MAX || l.first > s->link_count ||
            l.count > s->link_count - l.first) {
            return HDRP_ERROR_BAD_ARGUMENT;
        }
    }
    for (i = 0u; i < s->blocker_count; ++i) {
        hdrp_u32x4 b = s->blockers[i].bits;
        if (b.z > HDRP_CULL_PORTALS_MAX ||
            (b.z > 0u && (b.y > s->blocker_count || b.z > s->blocker_count - b.y))) {
            return HDRP_ERROR_BAD_ARGUMENT;
        }
    }
    for (i = 0u; i < s->link_count; ++i) {
        if (s->links[i] >= s->blocker_count) {
            return HDRP_ERROR_BAD_ARGUMENT;
        }
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_cull_blocker_begin(hdrp_cull_blocker_set* set,
                                             const hdrp_cull_blocker_scene* scene,
                                             const hdrp_cull_camera* camera)
{
    hdrp_result r;
    uint32_t i, pairs = 0u;
    if (!set || !scene || !camera) {
        return HDRP_ERROR_NULL_POINTER;
    }
    r = hdrp_i_cull_blocker_check_scene(&set->desc, scene);
    if (r != HDRP_OK) {
        return r;
    }
    for (i = 0u; i < scene->link_count; ++i) { /* at most 33 x 2^20 */
        pairs += 1u + scene->blockers[scene->links[i]].bits.z;
    }
    if (pairs > HDRP_I_CULL_BLOCKER_PAIRS) {
        return HDRP_ERROR_TOO_LARGE;
    }
    set->scene = *scene;
    set->camera = *camera;
    set->pair_count = pairs;
    for (i = 0u, pairs = 0u; i < scene->link_count; ++i) {
        set->first_pair[i] = pairs;
        pairs += 1u + scene->blockers[scene->links[i]].bits.z;
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_cull_blocker_project(hdrp_cull_blocker_set* set, uint32_t first,
                                               uint32_t count)
{
    uint32_t i, end;
    if (!set) {
        return HDRP_ERROR_NULL_POINTER;
    }
    end = set->scene.light_count + set->scene.blocker_count;
    if (first > end || count > end - first) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (i = first; i < first + count; ++i) {
        uint32_t k = i - set->scene.light_count; /* of a blocker */
        if (i < set->scene.light_count) {
            set->places[i] = hdrp_cull_light_place_in_view(set->scene.places[i], set->camera);
        } else {
            set->blockers[k] = hdrp_cull_blocker_in_view(set->scene.blockers[k], set->camera);
        }
    }
    return HDRP_OK;
}

HDRP_API float hdrp_cull_blocker_light_visible(const hdrp_cull_blocker_scene* scene, uint32_t light,
                                               uint32_t mask, hdrp_v3 position)
{
    float visible = 1.0f;
    uint32_t k, i;
    if (!scene || light >= scene->light_count) {
        return visible;
    }
    for (k = 0u; k < scene->lights[light].count; ++k) {
        const hdrp_cull_blocker* b = scene->blockers + scene->links[scene->lights[light].first + k];
        float through = 0.0f;
        if (((mask >> k) & 1u) == 0u) {
            continue;
        }
        for (i = 0u; i < b->bits.z; ++i) {
            through = hdrp_max(hdrp_cull_blocker_blocks(scene->blockers[b->bits.y + i],
                                                        scene->places[light], position),
                               through);
        }
        visible = hdrp_cull_blocker_visible(
            visible, hdrp_cull_blocker_blocks(*b, scene->places[light], position), through);
    }
    return visible;
}

/* ---- cells ----------------------------------------------------------------------------------- */

static size_t hdrp_i_cull_blocker_place_job(hdrp_cull_blocker_job* job,
                                            const hdrp_cull_blocker_set* set, void* scratch)
{
    size_t used = 0u, links = set->scene.link_count;
    memset(job, 0, sizeof *job);
    job->set = set;
    job->shadows = (hdrp_cull_shadow*)hdrp_i_cull_blocker_take(scratch, &used, set->pair_count,
                                                               sizeof *job->shadows);
    job->blocker_tile =
        (uint32_t*)hdrp_i_cull_blocker_take(scratch, &used, links, sizeof *job->blocker_tile);
    job->portals_tile =
        (uint32_t*)hdrp_i_cull_blocker_take(scratch, &used, links, sizeof *job->portals_tile);
    job->light = (uint32_t*)hdrp_i_cull_blocker_take(scratch, &used, links, sizeof *job->light);
    return used + HDRP_MEMORY_ALIGNMENT;
}

HDRP_API size_t hdrp_cull_blocker_scratch_size(const hdrp_cull_blocker_set* set)
{
    hdrp_cull_blocker_job job;
    return set ? hdrp_i_cull_blocker_place_job(&job, set, NULL) : 0u;
}

HDRP_API hdrp_result hdrp_cull_blocker_job_begin(hdrp_cull_blocker_job* job,
                                                 const hdrp_cull_blocker_set* set, void* scratch,
                                                 size_t scratch_bytes)
{
    hdrp_result r;
    if (!job || !set) {
        return HDRP_ERROR_NULL_POINTER;
    }
    r = hdrp_i_cull_blocker_check(scratch, scratch_bytes, hdrp_cull_blocker_scratch_size(set));
    if (r == HDRP_OK) {
        hdrp_i_cull_blocker_place_job(job, set, scratch);
        memset(job->blocker_tile, 0, set->scene.link_count * sizeof *job->blocker_tile);
        memset(job->portals_tile, 0, set->scene.link_count * sizeof *job->portals_tile);
        memset(job->light, 0, set->scene.link_count * sizeof *job->light);
    }
    return r;
}

HDRP_API hdrp_result hdrp_cull_blocker_job_tile(hdrp_cull_blocker_job* job,
                                                const hdrp_cull_tile* tile,
                                                hdrp_cull_interval depths)
{
    if (!job || !tile) {
        return HDRP_ERROR_NULL_POINTER;
    }
    job->tile = *tile;
    job->depths = depths;
    job->tile_number += 1u;
    return HDRP_OK;
}

/* Makes one shadow; where the formula is inlined, once. */
static void hdrp_i_cull_blocker_shadow(hdrp_cull_blocker_job* job, uint32_t pair, uint32_t blocker,
                                       uint32_t light)
{
    job->shadows[pair] =
        hdrp_cull_shadow_make(job->set->blockers[blocker], job->set->places[light], job->tile,
                              job->depths, job->set->camera.forward_orthographic.w);
    job->stats.shadows += 1u;
}

/* The largest class of the portals of a link. */
static uint32_t hdrp_i_cull_blocker_portals(hdrp_cull_blocker_job* job, uint32_t link,
                                            uint32_t light, hdrp_cull_interval depths)
{
    const hdrp_cull_blocker_set* set = job->set;
    hdrp_u32x4 b = set->scene.blockers[set->scene.links[link]].bits;
    uint32_t pair = set->first_pair[link] + 1u, i, most = HDRP_CULL_SHADOW_NONE;
    if (job->portals_tile[link] != job->tile_number) {
        for (i = 0u; i < b.z; ++i) {
            hdrp_i_cull_blocker_shadow(job, pair + i, b.y + i, light);
        }
        job->portals_tile[link] = job->tile_number;
    }
    for (i = 0u; i < b.z && most != HDRP_CULL_SHADOW_WHOLE; ++i) {
        uint32_t c = hdrp_cull_shadow_class(job->shadows[pair + i], depths);
        most = c != HDRP_CULL_SHADOW_NONE ? c : most;
    }
    return most;
}

HDRP_API uint32_t hdrp_cull_blocker_classify(hdrp_cull_blocker_job* job, uint32_t light,
                                             hdrp_cull_interval depths, uint32_t* mask)
{
    const hdrp_cull_blocker_scene* scene = &job->set->scene;
    uint32_t k, bits = 0u, stays = 1u;
    *mask = 0u;
    if (light >= scene->light_count) {
        return 1u;
    }
    for (k = 0u; k < scene->lights[light].count && stays; ++k) {
        uint32_t link = scene->lights[light].first + k, c;
        if (job->light[link] != light) { /* tiles count from 1 */
            job->light[link] = light;
            job->blocker_tile[link] = job->portals_tile[link] = 0u;
        }
        if (job->blocker_tile[link] != job->tile_number) {
            hdrp_i_cull_blocker_shadow(job, job->set->first_pair[link], scene->links[link], light);
            job->blocker_tile[link] = job->tile_number;
        }
        c = hdrp_cull_shadow_class(job->shadows[job->set->first_pair[link]], depths);
        if (c != HDRP_CULL_SHADOW_NONE) {
            c = hdrp_cull_shadow_through(c, hdrp_i_cull_blocker_portals(job, link, light, depths));
        }
        job->stats.none += c == HDRP_CULL_SHADOW_NONE ? 1u : 0u;
        job->stats.whole += c == HDRP_CULL_SHADOW_WHOLE ? 1u : 0u;
        job->stats.pixel += c == HDRP_CULL_SHADOW_PIXEL ? 1u : 0u;
        bits |= c == HDRP_CULL_SHADOW_PIXEL ? 1u << k : 0u;
        stays = c == HDRP_CULL_SHADOW_WHOLE ? 0u : 1u;
    }
    job->stats.lights += 1u;
    job->stats.lights_removed += stays ? 0u : 1u;
    *mask = stays ? bits : 0u;
    return stays;
}

#ifdef __cplusplus
}
#endif

#if defined(__clang__)
#pragma STDC FP_CONTRACT DEFAULT
#elif defined(__GNUC__)
#pragma GCC pop_options
#endif

#endif /* HDRP_CULL_IMPLEMENTATION */
