/* hdrp_cull_volume.h - where lights reach: cameras, shapes, and their depths inside a tile.
 * SPDX-License-Identifier: MIT
 *
 * The geometry of light culling, for hdrp_cull.h, which includes this header, and for shaders. One
 * question is asked of everything: between which depths does a shape lie inside a tile? A tile is a
 * rectangle of pixels, seen as the frustum behind it; a cell of a grid of clusters is a tile
 * between two depths, so that the interval answers for all slices of a tile at once.
 *
 *     shape = hdrp_cull_shape_from_light(light);             a convex body in the world
 *     shape = hdrp_cull_shape_in_view(shape, camera);        the same, seen by the camera
 *     tile = hdrp_cull_tile_make(camera, x0, y0, x1, y1, width, height);
 *     interval = hdrp_cull_interval_ball(tile, hdrp_cull_shape_ball(shape), orthographic);
 *     for each i below hdrp_cull_shape_plane_count(shape):
 *         plane = hdrp_cull_shape_plane(shape, i, orthographic);
 *         interval = hdrp_cull_interval_plane(interval, tile, plane, orthographic);
 *
 * The interval of a ball is the true one; a plane that touches a shape from outside shortens it.
 * The planes of a shape are those of its faces and those that it shares with the eye, so that the
 * shape is missed by a tile that misses its silhouette. Every result is conservative: rounding
 * makes shapes larger, by 1e-6 of their distance, and never smaller.
 *
 * View space, here: x to the right, y up, z the depth in front of the camera, in metres. Pixels
 * count from the upper left. Angles of lights reach from 0 to all around: what is wider than half a
 * sphere is treated as the ball that contains it, but for single positions.
 *
 * Comparisons decide here what is listed, so nothing in this header may be contracted to fused
 * multiply-adds: the results are the same in every build, but for clang's -ffp-contract=fast, which
 * takes no orders from headers. See hdrp_math.h for the languages and the
 * override macros. There is no algorithm layer.
 *
 * >>index of the functions, without hdrp_cull_ (written by tools/api_check.py --write)
 *   camera: camera_perspective camera_orthographic view_from_world offset_of_pixel direction_to_eye
 *   shapes: shape_sphere shape_box shape_from_light shape_with_features shape_in_layers shape_kind
 *       shape_category shape_in_view shape_ball shape_plane_count shape_plane shape_contains
 *   tiles: tile_make interval_ball interval_plane
 *   screen bounds: ball_bounds shape_bounds
 * >>end */
#ifndef HDRP_CULL_VOLUME_H
#define HDRP_CULL_VOLUME_H

#include "hdrp_light.h"

#if HDRP_VERSION != 100
#error "hdrp_cull_volume.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* gcc knows no such pragma; hdrp_cull.h turns contraction off for the functions that call these. */
#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT OFF
#endif

/* Shapes grow by this share of their distance from the eye and of their size: 8 roundings. */
#define HDRP_CULL_MARGIN 1e-6f
/* Metres. What is farther from the camera, or that large, counts as reaching everywhere. */
#define HDRP_CULL_DISTANCE_MAX 1e12f
/* Metres; as the far distance of a camera: none. */
#define HDRP_CULL_FAR_INFINITE 1e18f
/* Edges of a perspective window, as tangents: 89.99 degrees. */
#define HDRP_CULL_TANGENT_MAX 5e3f
/* Planes that hdrp_cull_shape_plane knows of one shape. */
#define HDRP_CULL_PLANES_MAX 12u

HDRP_FN float hdrp_i_cull_dot(hdrp_v3 a, hdrp_v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

HDRP_FN hdrp_v3 hdrp_i_cull_mad(hdrp_v3 a, hdrp_v3 b, float s)
{
    return hdrp_v3_make(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}

HDRP_FN hdrp_v3 hdrp_i_cull_cross(hdrp_v3 a, hdrp_v3 b)
{
    return hdrp_v3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/* The sine of the angle between unit vectors: that of their cosine has no digits near 0. */
HDRP_FN float hdrp_i_cull_sine(hdrp_v3 a, hdrp_v3 b)
{
    hdrp_v3 c = hdrp_i_cull_cross(a, b);
    return hdrp_sqrt(hdrp_i_cull_dot(c, c));
}

/* |x| + |y| + |z|: what rounding errors of a position are measured by. */
HDRP_FN float hdrp_i_cull_size(hdrp_v3 v)
{
    return hdrp_abs(v.x) + hdrp_abs(v.y) + hdrp_abs(v.z);
}

/* v / |v|; the fallback where v is too short, or NaN, to have a direction. */
HDRP_FN hdrp_v3 hdrp_i_cull_unit(hdrp_v3 v, hdrp_v3 fallback)
{
    float k = 1.0f / hdrp_max(hdrp_i_cull_size(v), 1e-30f);
    hdrp_v3 w = hdrp_v3_scale(v, k);
    float length = hdrp_sqrt(hdrp_i_cull_dot(w, w));
    return hdrp_v3_select(length > 0.5f ? 1.0f : 0.0f,
                          hdrp_v3_scale(w, 1.0f / hdrp_max(length, 0.5f)), fallback);
}

/* >>camera */

/* Made by hdrp_cull_camera_perspective and hdrp_cull_camera_orthographic. */
struct hdrp_cull_camera {
    hdrp_v4 eye_near;             /* xyz [-1e18,1e18], w [1e-6,1e9] */
    hdrp_v4 right_far;            /* xyz unit, w [1e-6,1e18] */
    hdrp_v4 up;                   /* xyz unit, w [0,0] */
    hdrp_v4 forward_orthographic; /* xyz unit, w [0,1] */
    hdrp_v4 window;               /* left and bottom edge, width, height: x / z, or m */
};
HDRP_TYPEDEF(hdrp_cull_camera)

/* The frame and the depths, for both makers. */
HDRP_FN hdrp_cull_camera hdrp_i_cull_camera(hdrp_v3 eye, hdrp_v3 forward, hdrp_v3 up, float near_m,
                                            float far_m)
{
    hdrp_cull_camera c;
    hdrp_v3 f = hdrp_i_cull_unit(forward, hdrp_v3_make(0.0f, 0.0f, -1.0f));
    float steep = hdrp_abs(f.y) < 0.9f ? 0.0f : 1.0f;
    hdrp_v3 other = hdrp_v3_make(steep, 1.0f - steep, 0.0f);
    hdrp_v3 arbitrary = hdrp_i_cull_unit(hdrp_i_cull_cross(f, other), other);
    hdrp_v3 x = hdrp_i_cull_cross(f, hdrp_i_cull_unit(up, f));
    float near_limited = hdrp_clamp(near_m, 1e-6f, 1e9f);
    x = hdrp_v3_select(hdrp_i_cull_dot(x, x) > 1e-6f ? 1.0f : 0.0f, x, arbitrary);
    x = hdrp_i_cull_unit(x, arbitrary);
    /* Where up is nearly along f, rounding leaves x askew. */
    x = hdrp_i_cull_unit(hdrp_i_cull_mad(x, f, -hdrp_i_cull_dot(x, f)), arbitrary);
    c.eye_near = hdrp_v4_make(hdrp_clamp(eye.x, -1e18f, 1e18f), hdrp_clamp(eye.y, -1e18f, 1e18f),
                              hdrp_clamp(eye.z, -1e18f, 1e18f), near_limited);
    c.right_far = hdrp_v4_from_v3(x, hdrp_clamp(far_m, near_limited, HDRP_CULL_FAR_INFINITE));
    c.up = hdrp_v4_from_v3(hdrp_i_cull_cross(x, f), 0.0f);
    c.forward_orthographic = hdrp_v4_from_v3(f, 0.0f);
    c.window = hdrp_v4_make(-1.0f, -1.0f, 2.0f, 2.0f);
    return c;
}

/* One axis of a window: its lower edge and its size, which is at least 1e-6 of the edges. */
HDRP_FN hdrp_v2 hdrp_i_cull_window(float lo, float hi, float limit)
{
    float a = hdrp_clamp(lo, -limit, limit);
    float b = hdrp_clamp(hi, -limit, limit);
    float least = 1e-6f * hdrp_max(hdrp_max(hdrp_abs(a), hdrp_abs(b)), 1e-6f);
    return hdrp_v2_make(hdrp_min(a, b), hdrp_max(hdrp_abs(b - a), least));
}

/* A camera with a window: its edges are left, right, bottom, top. */
HDRP_FN hdrp_cull_camera hdrp_i_cull_with_window(hdrp_cull_camera c, hdrp_v4 edges, float limit)
{
    hdrp_v2 x = hdrp_i_cull_window(edges.x, edges.y, limit);
    hdrp_v2 y = hdrp_i_cull_window(edges.z, edges.w, limit);
    c.window = hdrp_v4_make(x.x, y.x, x.y, y.y);
    return c;
}

/** A perspective camera; the window may be off centre, as that of an eye of a headset.
 *  eye          any  m
 *  forward      any  direction of view; any length
 *  up           any  roughly upwards in the picture; any length, need not be orthogonal
 *  tan_left     any  x / depth at the left edge of the picture: negative left of the axis
 *  tan_right    any  at the right edge
 *  tan_bottom   any  y / depth at the lower edge
 *  tan_top      any  at the upper edge
 *  near_m       any  nearest depth of anything that is lit
 *  far_m        any  farthest depth; HDRP_CULL_FAR_INFINITE: none
 *  returns      valid
 *  edges        without a direction it looks along -z; tangents are limited to
 *               HDRP_CULL_TANGENT_MAX, depths to [1e-6,1e9] and [near,HDRP_CULL_FAR_INFINITE]; NaN
 *               counts as the lower end; a window of no width gets the least that is not
 *  error        none: limits
 *  source       a definition */
HDRP_FN hdrp_cull_camera hdrp_cull_camera_perspective(hdrp_v3 eye, hdrp_v3 forward, hdrp_v3 up,
                                                      float tan_left, float tan_right,
                                                      float tan_bottom, float tan_top, float near_m,
                                                      float far_m)
{
    hdrp_cull_camera c = hdrp_i_cull_camera(eye, forward, up, near_m, far_m);
    return hdrp_i_cull_with_window(c, hdrp_v4_make(tan_left, tan_right, tan_bottom, tan_top),
                                   HDRP_CULL_TANGENT_MAX);
}

/** An orthographic camera.
 *  eye          any  m, in the plane from which depth counts
 *  forward      any  direction of view; any length
 *  up           any  roughly upwards in the picture; any length, need not be orthogonal
 *  left_m       any  x at the left edge of the picture
 *  right_m      any  at the right edge
 *  bottom_m     any  y at the lower edge
 *  top_m        any  at the upper edge
 *  near_m       any  nearest depth
 *  far_m        any  farthest depth
 *  returns      valid
 *  edges        those of hdrp_cull_camera_perspective; edges of the window are limited to 1e9 m
 *  error        none: limits
 *  source       a definition */
HDRP_FN hdrp_cull_camera hdrp_cull_camera_orthographic(hdrp_v3 eye, hdrp_v3 forward, hdrp_v3 up,
                                                       float left_m, float right_m, float bottom_m,
                                                       float top_m, float near_m, float far_m)
{
    hdrp_cull_camera c = hdrp_i_cull_camera(eye, forward, up, near_m, far_m);
    c.forward_orthographic.w = 1.0f;
    return hdrp_i_cull_with_window(c, hdrp_v4_make(left_m, right_m, bottom_m, top_m), 1e9f);
}

/** A position as the camera sees it.
 *  position  [-1e18,1e18]  m, in the frame in which the camera was made
 *  camera    valid
 *  returns   [-4e18,4e18]  x to the right, y up, z depth
 *  edges     none
 *  error     <= 8e-7 relative to the distance, per component, against a frame that is not rounded
 *            @accuracy cull_view_from_world
 *  source    a definition
 *  note      the difference to the eye comes first, so that far from the origin nothing is lost
 *            that the position has not lost */
HDRP_FN hdrp_v3 hdrp_cull_view_from_world(hdrp_v3 position, hdrp_cull_camera camera)
{
    hdrp_v3 d = hdrp_v3_sub(position, hdrp_v3_from_v4(camera.eye_near));
    return hdrp_v3_make(hdrp_i_cull_dot(d, hdrp_v3_from_v4(camera.right_far)),
                        hdrp_i_cull_dot(d, hdrp_v3_from_v4(camera.up)),
                        hdrp_i_cull_dot(d, hdrp_v3_from_v4(camera.forward_orthographic)));
}

/** Where a pixel is, as a difference to the eye of the camera.
 *  camera    valid
 *  x_px      any      of the picture, from the left; the middle of the first pixel is 0.5
 *  y_px      any      likewise, from the top
 *  width_px  [1,16384]
 *  height_px [1,16384]
 *  z_view    [0,1e18] m  depth of what is there
 *  returns   any      m, along the axes of the world
 *  edges     none
 *  error     none: the definition of a camera, turned round
 *  source    a definition
 *  note      the position is the sum of this and the eye; far from the origin the difference has
 *            digits that the position has lost */
HDRP_FN hdrp_v3 hdrp_cull_offset_of_pixel(hdrp_cull_camera camera, float x_px, float y_px,
                                          float width_px, float height_px, float z_view)
{
    float x = camera.window.x + camera.window.z * (x_px / width_px);
    float y = camera.window.y + camera.window.w * (1.0f - y_px / height_px);
    float spread = camera.forward_orthographic.w > 0.0f ? 1.0f : z_view;
    hdrp_v3 p = hdrp_v3_scale(hdrp_v3_from_v4(camera.forward_orthographic), z_view);
    p = hdrp_v3_mad(p, hdrp_v3_from_v4(camera.right_far), x * spread);
    return hdrp_v3_mad(p, hdrp_v3_from_v4(camera.up), y * spread);
}

/** Direction from a place towards the viewer.
 *  camera   valid
 *  offset   any   m  of the place, from hdrp_cull_offset_of_pixel
 *  returns  unit
 *  edges    at the eye, against the direction of view
 *  error    none: a definition
 *  source   a definition */
HDRP_FN hdrp_v3 hdrp_cull_direction_to_eye(hdrp_cull_camera camera, hdrp_v3 offset)
{
    hdrp_v3 back = hdrp_v3_neg(hdrp_v3_from_v4(camera.forward_orthographic));
    hdrp_v3 to_eye = hdrp_normalize_or(hdrp_v3_neg(offset), back);
    return hdrp_v3_select(camera.forward_orthographic.w, back, to_eye);
}

/* >>shapes
 * What a light, a probe or a decal reaches, as a convex body: lists are made of these. */

#define HDRP_CULL_KIND_NONE    0u /* reaches nothing */
#define HDRP_CULL_KIND_BALL    1u
#define HDRP_CULL_KIND_CONE    2u /* the part of a ball inside a cone */
#define HDRP_CULL_KIND_PYRAMID 3u /* the part of a ball between four planes */
#define HDRP_CULL_KIND_BOX     4u /* everything within the range of a box; range 0: the box */
#define HDRP_CULL_KIND_FRONT   5u /* the same, in front of its centre */
#define HDRP_CULL_KIND_MASK    255u

/* A bit beside the kind: the centre lies half the depth ahead of the position that is given. Added
 * in view space, where nothing is lost that far from the origin of the world has no digits. */
#define HDRP_CULL_SHAPE_AHEAD 65536u

/* What lists are grouped by, in this order. */
#define HDRP_CULL_CATEGORY_PUNCTUAL    0u
#define HDRP_CULL_CATEGORY_AREA        1u
#define HDRP_CULL_CATEGORY_ENVIRONMENT 2u /* reflection probes */
#define HDRP_CULL_CATEGORY_DECAL       3u
#define HDRP_CULL_CATEGORY_COUNT       4u

/* Made by hdrp_cull_shape_sphere, hdrp_cull_shape_box and hdrp_cull_shape_from_light. */
struct hdrp_cull_shape {
    hdrp_v4 center_range; /* xyz [-4e18,4e18], w [0,1e18] m: apex of cones and pyramids */
    hdrp_v4 right_half;   /* xyz unit, w [0,1e18] m half size along it */
    hdrp_v4 up_half;      /* xyz unit, w [0,1e18] m */
    hdrp_v4 forward_half; /* xyz unit, w [0,1e18] m */
    hdrp_v4 half_angle;   /* [-1,1] cos and sin across right, then across up */
    /* any: x kind | category << 8 | ..._AHEAD, y layers, for shading alone, z features, w the bits
     * of a float that is not negative, hdrp_bits_from_f32: the importance */
    hdrp_u32x4 bits;
};
HDRP_TYPEDEF(hdrp_cull_shape)

/* 1 where a position can be computed with. */
HDRP_FN float hdrp_i_cull_usable(hdrp_v3 p)
{
    float farthest = hdrp_max(hdrp_abs(p.x), hdrp_max(hdrp_abs(p.y), hdrp_abs(p.z)));
    float known = p.x + p.y + p.z;
    return farthest <= HDRP_LIGHT_POSITION_MAX && known == known ? 1.0f : 0.0f;
}

HDRP_FN hdrp_cull_shape hdrp_i_cull_shape(hdrp_u32 kind, hdrp_u32 category, hdrp_v3 position,
                                          float range_m)
{
    hdrp_cull_shape s;
    float range = hdrp_clamp(range_m, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    hdrp_u32 usable = hdrp_i_cull_usable(position) > 0.0f ? kind : HDRP_CULL_KIND_NONE;
    hdrp_v3 p =
        hdrp_v3_select(usable != HDRP_CULL_KIND_NONE ? 1.0f : 0.0f, position, hdrp_v3_splat(0.0f));
    s.center_range = hdrp_v4_from_v3(p, range);
    s.right_half = hdrp_v4_make(1.0f, 0.0f, 0.0f, 0.0f);
    s.up_half = hdrp_v4_make(0.0f, 1.0f, 0.0f, 0.0f);
    s.forward_half = hdrp_v4_make(0.0f, 0.0f, -1.0f, 0.0f);
    s.half_angle = hdrp_v4_make(-1.0f, 0.0f, -1.0f, 0.0f);
    s.bits = hdrp_u32x4_make(usable | ((category & 3u) << 8), HDRP_LIGHT_LAYERS_ALL, 0u,
                             hdrp_bits_from_f32(1.0f));
    return s;
}

/** A ball: the reach of a reflection probe.
 *  center    any  m
 *  radius_m  any
 *  category  any  HDRP_CULL_CATEGORY_..., modulo 4
 *  returns   valid  on all layers, without features, importance 1
 *  edges     reaches nothing where the centre is NaN or beyond 1e18 m and where the radius is 0,
 *            negative or NaN; a radius of 1e18 m reaches everything
 *  error     none: limits
 *  source    a definition */
HDRP_FN hdrp_cull_shape hdrp_cull_shape_sphere(hdrp_v3 center, float radius_m, hdrp_u32 category)
{
    hdrp_u32 kind = radius_m > 0.0f ? HDRP_CULL_KIND_BALL : HDRP_CULL_KIND_NONE;
    return hdrp_i_cull_shape(kind, category, center, radius_m);
}

/** A box: the reach of a decal or a reflection probe.
 *  center         any  m
 *  forward        any  direction of its depth; any length
 *  up             any  roughly along its height; any length, need not be orthogonal
 *  half_width_m   any
 *  half_height_m  any
 *  half_depth_m   any
 *  category       any  HDRP_CULL_CATEGORY_..., modulo 4
 *  returns        valid  on all layers, without features, importance 1
 *  edges          reaches nothing where the centre is NaN or beyond 1e18 m and where a size is
 *                 negative or NaN; a size of 0 is a rectangle; sizes are limited to 1e18 m; without
 *                 directions as hdrp_cull_camera_perspective
 *  error          none: limits
 *  source         a definition */
HDRP_FN hdrp_cull_shape hdrp_cull_shape_box(hdrp_v3 center, hdrp_v3 forward, hdrp_v3 up,
                                            float half_width_m, float half_height_m,
                                            float half_depth_m, hdrp_u32 category)
{
    hdrp_u32 kind = half_width_m >= 0.0f && half_height_m >= 0.0f && half_depth_m >= 0.0f
                        ? HDRP_CULL_KIND_BOX
                        : HDRP_CULL_KIND_NONE;
    hdrp_cull_shape s = hdrp_i_cull_shape(kind, category, center, 0.0f);
    hdrp_cull_camera frame = hdrp_i_cull_camera(center, forward, up, 1.0f, 1.0f);
    s.right_half = frame.right_far;
    s.up_half = frame.up;
    s.forward_half = frame.forward_orthographic;
    s.right_half.w = hdrp_clamp(half_width_m, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    s.up_half.w = hdrp_clamp(half_height_m, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    s.forward_half.w = hdrp_clamp(half_depth_m, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    return s;
}

/* Features of a shape that comes from a light: its type as one of the lower bits, and the features
 * of its record, HDRP_LIGHT_FEATURE_..., from this one on. */
#define HDRP_CULL_FEATURE_OF_TYPE(type) (1u << (type))
#define HDRP_CULL_FEATURE_SHIFT         8u

/* The kind of body that a type of light fills. */
HDRP_FN hdrp_u32 hdrp_i_cull_kind_of_light(hdrp_u32 type)
{
    hdrp_u32 kind = HDRP_CULL_KIND_NONE;
    if (type == HDRP_LIGHT_TYPE_DIRECTIONAL || type == HDRP_LIGHT_TYPE_POINT ||
        type == HDRP_LIGHT_TYPE_SPHERE) {
        kind = HDRP_CULL_KIND_BALL;
    }
    if (type == HDRP_LIGHT_TYPE_SPOT) {
        kind = HDRP_CULL_KIND_CONE;
    }
    if (type == HDRP_LIGHT_TYPE_PYRAMID) {
        kind = HDRP_CULL_KIND_PYRAMID;
    }
    if (type == HDRP_LIGHT_TYPE_BOX || type == HDRP_LIGHT_TYPE_LINE) {
        kind = HDRP_CULL_KIND_BOX;
    }
    if (type == HDRP_LIGHT_TYPE_RECTANGLE || type == HDRP_LIGHT_TYPE_DISC) {
        kind = HDRP_CULL_KIND_FRONT;
    }
    return kind;
}

/** Where a light reaches.
 *  light    valid
 *  returns  valid  with the layers and the importance of the light, and its features
 *  edges    reaches nothing where it has no type or range; a directional light reaches everything.
 *           Area lights reach what is within their range of their surface, rectangles and discs in
 *           front of them only; a disc counts as the part of a square that is within its ball. An
 *           importance below 0 and NaN count as 0, an infinite one as FLT_MAX
 *  error    none: a selection
 *  source   a definition */
HDRP_FN hdrp_cull_shape hdrp_cull_shape_from_light(hdrp_light light)
{
    hdrp_u32 type = hdrp_light_type(light);
    hdrp_u32 kind = hdrp_i_cull_kind_of_light(type);
    hdrp_u32 category =
        type >= HDRP_LIGHT_TYPE_SPHERE ? HDRP_CULL_CATEGORY_AREA : HDRP_CULL_CATEGORY_PUNCTUAL;
    float range = light.position_range.w;
    hdrp_v3 p = hdrp_v3_from_v4(light.position_range);
    hdrp_cull_shape s =
        hdrp_i_cull_shape(range > 0.0f ? kind : HDRP_CULL_KIND_NONE, category, p, range);
    s.right_half = light.right_half_width;
    s.up_half = light.up_half_height;
    s.forward_half = hdrp_v4_from_v3(hdrp_v3_from_v4(light.forward_radius), 0.0f);
    s.half_angle = light.half_angle;
    if (type == HDRP_LIGHT_TYPE_BOX) {
        s.center_range.w = 0.0f;
        s.forward_half.w = 0.5f * range;
        s.bits.x |= HDRP_CULL_SHAPE_AHEAD;
    }
    if (type == HDRP_LIGHT_TYPE_SPHERE) {
        s.center_range.w = hdrp_min(range + light.forward_radius.w, HDRP_LIGHT_RANGE_INFINITE);
    }
    if (type == HDRP_LIGHT_TYPE_DISC) {
        s.right_half.w = light.forward_radius.w;
        s.up_half.w = light.forward_radius.w;
    }
    if (type == HDRP_LIGHT_TYPE_LINE) {
        s.up_half.w = 0.0f;
    }
    s.bits.y = light.bits.y;
    s.bits.z = HDRP_CULL_FEATURE_OF_TYPE(type & 15u) |
               ((light.bits.x & ~HDRP_LIGHT_TYPE_MASK) << HDRP_CULL_FEATURE_SHIFT);
    s.bits.w = hdrp_bits_from_f32(hdrp_clamp(light.edge_importance.w, 0.0f, HDRP_FLT_MAX));
    return s;
}

/** A shape with what lists are ranked by and shaders ask for: a probe or a decal gets it here.
 *  shape       valid
 *  features    any  bits that mean what the caller says: hdrp_cull_light_features collects them
 *  layers      any  on which it has an effect, one bit each: hdrp_cull_shape_in_layers
 *  importance  any  what lists keep first when they are full
 *  returns     valid
 *  edges       an importance below 0 and NaN count as 0, an infinite one as FLT_MAX
 *  error       none: a definition
 *  source      a definition
 *  note        replaces what hdrp_cull_shape_from_light took from a light: for one feature more,
 *              give it shape.bits.z | feature */
HDRP_FN hdrp_cull_shape hdrp_cull_shape_with_features(hdrp_cull_shape shape, hdrp_u32 features,
                                                      hdrp_u32 layers, float importance)
{
    shape.bits.y = layers;
    shape.bits.z = features;
    shape.bits.w = hdrp_bits_from_f32(hdrp_clamp(importance, 0.0f, HDRP_FLT_MAX));
    return shape;
}

/** Whether a shape has an effect on a surface: hdrp_light_affects for what is not a light.
 *  shape    any
 *  layers   any    of the surface, one bit each
 *  returns  [0,1]  1 where they have a layer in common
 *  edges    a surface on no layer is affected by nothing
 *  error    none: a selection of bits
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slides on light layers */
HDRP_FN hdrp_u32 hdrp_cull_shape_in_layers(hdrp_cull_shape shape, hdrp_u32 layers)
{
    return (shape.bits.y & layers) != 0u ? 1u : 0u;
}

/** The kind of a shape.
 *  shape    any
 *  returns  [0,255]  HDRP_CULL_KIND_...
 *  edges    none
 *  error    none: a selection of bits
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_shape_kind(hdrp_cull_shape shape)
{
    return shape.bits.x & HDRP_CULL_KIND_MASK;
}

/** The category of a shape.
 *  shape    any
 *  returns  [0,3]  HDRP_CULL_CATEGORY_...
 *  edges    none
 *  error    none: a selection of bits
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_shape_category(hdrp_cull_shape shape)
{
    return (shape.bits.x >> 8) & 3u;
}

/* An axis in view space. */
HDRP_FN hdrp_v4 hdrp_i_cull_axis_in_view(hdrp_v4 axis_half, hdrp_cull_camera camera)
{
    hdrp_v3 a = hdrp_v3_from_v4(axis_half);
    return hdrp_v4_make(hdrp_i_cull_dot(a, hdrp_v3_from_v4(camera.right_far)),
                        hdrp_i_cull_dot(a, hdrp_v3_from_v4(camera.up)),
                        hdrp_i_cull_dot(a, hdrp_v3_from_v4(camera.forward_orthographic)),
                        axis_half.w);
}

/** A shape in view space.
 *  shape    valid
 *  camera   valid
 *  returns  valid
 *  edges    a ball of infinite range, and everything that is farther than HDRP_CULL_DISTANCE_MAX or
 *           that large, becomes a ball that reaches everything
 *  error    none: hdrp_cull_view_from_world, and the same for axes
 *  source   a definition */
HDRP_FN hdrp_cull_shape hdrp_cull_shape_in_view(hdrp_cull_shape shape, hdrp_cull_camera camera)
{
    hdrp_u32 kind = hdrp_cull_shape_kind(shape);
    float range = shape.center_range.w;
    hdrp_v3 c = hdrp_cull_view_from_world(hdrp_v3_from_v4(shape.center_range), camera);
    float half_size = hdrp_max(hdrp_max(shape.right_half.w, shape.up_half.w), shape.forward_half.w);
    float everywhere =
        hdrp_max(hdrp_i_cull_size(c), half_size) > HDRP_CULL_DISTANCE_MAX ? 1.0f : 0.0f;
    if (kind == HDRP_CULL_KIND_BALL && range >= HDRP_LIGHT_RANGE_INFINITE) {
        everywhere = 1.0f;
    }
    shape.right_half = hdrp_i_cull_axis_in_view(shape.right_half, camera);
    shape.up_half = hdrp_i_cull_axis_in_view(shape.up_half, camera);
    shape.forward_half = hdrp_i_cull_axis_in_view(shape.forward_half, camera);
    if ((shape.bits.x & HDRP_CULL_SHAPE_AHEAD) != 0u) {
        c = hdrp_i_cull_mad(c, hdrp_v3_from_v4(shape.forward_half), shape.forward_half.w);
        shape.bits.x &= ~HDRP_CULL_SHAPE_AHEAD;
    }
    shape.center_range = hdrp_v4_from_v3(c, range);
    if (everywhere > 0.0f && kind != HDRP_CULL_KIND_NONE) {
        shape.center_range = hdrp_v4_make(0.0f, 0.0f, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
        shape.bits.x = (shape.bits.x & ~HDRP_CULL_KIND_MASK) | HDRP_CULL_KIND_BALL;
    }
    return shape;
}

/* What rounding may have moved a position in view space by. */
HDRP_FN float hdrp_i_cull_margin(hdrp_v3 p)
{
    return HDRP_CULL_MARGIN * hdrp_i_cull_size(p);
}

/** The smallest ball around the centre of a shape that contains it.
 *  shape    valid  in view space
 *  returns  valid  xyz centre, w radius, rounded up
 *  edges    the radius is 0 for a shape that reaches nothing
 *  error    <= 3e-6 relative to the larger of radius and distance, upwards
 *           @accuracy cull_shape_ball
 *  source   a definition */
HDRP_FN hdrp_v4 hdrp_cull_shape_ball(hdrp_cull_shape shape)
{
    hdrp_u32 kind = hdrp_cull_shape_kind(shape);
    hdrp_v3 c = hdrp_v3_from_v4(shape.center_range);
    hdrp_v3 h = hdrp_v3_make(shape.right_half.w, shape.up_half.w, shape.forward_half.w);
    float corner = kind >= HDRP_CULL_KIND_BOX ? hdrp_sqrt(hdrp_i_cull_dot(h, h)) : 0.0f;
    float radius = (corner + shape.center_range.w) * (1.0f + HDRP_CULL_MARGIN);
    radius = hdrp_min(radius + hdrp_i_cull_margin(c), HDRP_LIGHT_RANGE_INFINITE);
    return hdrp_v4_from_v3(c, kind == HDRP_CULL_KIND_NONE ? 0.0f : radius);
}

/** How many planes hdrp_cull_shape_plane knows.
 *  shape    any
 *  returns  [0,HDRP_CULL_PLANES_MAX]
 *  edges    0 for balls, which need none, and where nothing is reached
 *  error    none: a selection
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_cull_shape_plane_count(hdrp_cull_shape shape)
{
    hdrp_u32 kind = hdrp_cull_shape_kind(shape);
    hdrp_u32 count = kind >= HDRP_CULL_KIND_BOX ? 12u : 0u;
    if (kind == HDRP_CULL_KIND_CONE && shape.half_angle.x >= 0.0f) {
        count = 12u;
    }
    return kind == HDRP_CULL_KIND_PYRAMID ? 10u : count;
}

/* A plane that excludes nothing. */
HDRP_FN hdrp_v4 hdrp_i_cull_no_plane(void)
{
    return hdrp_v4_make(0.0f, 0.0f, 0.0f, 1.0f);
}

/* cos and sin of an angle in [0, pi / 2] and 2e-6 more: directions are rounded. */
HDRP_FN hdrp_v2 hdrp_i_cull_wider(float cosine, float sine)
{
    return hdrp_v2_make(hdrp_max(cosine - 2e-6f * sine, 0.0f),
                        hdrp_min(sine + 2e-6f * cosine, 1.0f));
}

/* The plane through the apex of a cone that touches it where the azimuth is that of a direction. */
HDRP_FN hdrp_v4 hdrp_i_cull_cone_side(hdrp_cull_shape s, hdrp_v3 direction)
{
    hdrp_v3 apex = hdrp_v3_from_v4(s.center_range);
    hdrp_v3 f = hdrp_v3_from_v4(s.forward_half);
    hdrp_v2 angle = hdrp_i_cull_wider(s.half_angle.x, s.half_angle.y);
    hdrp_v3 p = hdrp_i_cull_mad(direction, f, -hdrp_i_cull_dot(direction, f));
    hdrp_v3 n;
    p = hdrp_i_cull_unit(p, hdrp_v3_from_v4(s.right_half));
    n = hdrp_i_cull_mad(hdrp_v3_scale(p, angle.x), f, -angle.y);
    return hdrp_v4_from_v3(n, hdrp_i_cull_dot(n, apex) + hdrp_i_cull_margin(apex));
}

/* The direction in which the eye sees a position. */
HDRP_FN hdrp_v3 hdrp_i_cull_view_ray(hdrp_v3 p, float orthographic)
{
    hdrp_v3 along = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    return hdrp_v3_select(orthographic, along, hdrp_i_cull_unit(p, along));
}

/* One of the two sides of a cone, +1 or -1, that the eye sees as the outline of it. */
HDRP_FN hdrp_v4 hdrp_i_cull_cone_outline(hdrp_cull_shape s, float side, float orthographic)
{
    hdrp_v3 f = hdrp_v3_from_v4(s.forward_half);
    hdrp_v3 ray = hdrp_i_cull_view_ray(hdrp_v3_from_v4(s.center_range), orthographic);
    hdrp_v3 w = hdrp_i_cull_mad(f, ray, -hdrp_i_cull_dot(f, ray));
    float sine2 = hdrp_i_cull_dot(w, w);
    float ratio = s.half_angle.y * s.half_angle.y / hdrp_max(sine2, 1e-20f);
    hdrp_v3 across =
        hdrp_v3_scale(hdrp_i_cull_cross(ray, w), side * hdrp_sqrt(hdrp_max(1.0f - ratio, 0.0f)));
    /* The normal is at right angles to the ray, and to the line where it touches the cone. */
    hdrp_v3 n = hdrp_i_cull_mad(hdrp_v3_scale(across, 1.0f / hdrp_sqrt(hdrp_max(sine2, 1e-20f))), w,
                                -s.half_angle.y / hdrp_max(sine2, 1e-20f));
    hdrp_v4 plane = hdrp_i_cull_cone_side(s, n);
    /* From inside the cone, and from behind, there is no such side. */
    if (ratio >= 1.0f) {
        plane = hdrp_i_cull_no_plane();
    }
    return plane;
}

/* The plane across the axis that ends a cone or a pyramid: 1 at its range, -1 at its apex. */
HDRP_FN hdrp_v4 hdrp_i_cull_cap(hdrp_cull_shape s, float side)
{
    hdrp_v3 apex = hdrp_v3_from_v4(s.center_range);
    hdrp_v3 n = hdrp_v3_scale(hdrp_v3_from_v4(s.forward_half), side);
    float range = side > 0.0f ? s.center_range.w * (1.0f + HDRP_CULL_MARGIN) : 0.0f;
    return hdrp_v4_from_v3(n, hdrp_i_cull_dot(n, apex) + range + hdrp_i_cull_margin(apex));
}

/* cos(i pi / 4), i in [0, 8]. */
HDRP_FN float hdrp_i_cull_cos_eighth(hdrp_u32 i)
{
    hdrp_u32 k = i & 3u;
    float c = k == 0u ? 1.0f : k == 2u ? 0.0f : HDRP_SQRT_HALF;
    return (i & 7u) > 2u && (i & 7u) < 6u ? -c : c;
}

/* Sides by eighths, outline, range, apex. */
HDRP_FN hdrp_v4 hdrp_i_cull_cone_plane(hdrp_cull_shape s, hdrp_u32 i, float orthographic)
{
    hdrp_v4 r = hdrp_i_cull_no_plane();
    if (i < 8u) {
        r = hdrp_i_cull_cone_side(
            s,
            hdrp_i_cull_mad(hdrp_v3_scale(hdrp_v3_from_v4(s.right_half), hdrp_i_cull_cos_eighth(i)),
                            hdrp_v3_from_v4(s.up_half), hdrp_i_cull_cos_eighth(i + 6u)));
    } else if (i < 10u) {
        r = hdrp_i_cull_cone_outline(s, i == 8u ? 1.0f : -1.0f, orthographic);
    } else {
        r = hdrp_i_cull_cap(s, i == 10u ? 1.0f : -1.0f);
    }
    return r;
}

/* An edge of a pyramid, along right and up as the bits of i say. */
HDRP_FN hdrp_v3 hdrp_i_cull_pyramid_edge(hdrp_cull_shape s, hdrp_u32 i)
{
    hdrp_v2 x = hdrp_i_cull_wider(s.half_angle.x, s.half_angle.y);
    hdrp_v2 y = hdrp_i_cull_wider(s.half_angle.z, s.half_angle.w);
    hdrp_v3 e = hdrp_v3_scale(hdrp_v3_from_v4(s.forward_half), x.x * y.x);
    e = hdrp_i_cull_mad(e, hdrp_v3_from_v4(s.right_half), (i & 1u) != 0u ? x.y * y.x : -x.y * y.x);
    e = hdrp_i_cull_mad(e, hdrp_v3_from_v4(s.up_half), (i & 2u) != 0u ? x.x * y.y : -x.x * y.y);
    return hdrp_i_cull_unit(e, hdrp_v3_from_v4(s.forward_half));
}

/* The middle of a side of a pyramid: right, left, up, down. */
HDRP_FN hdrp_v3 hdrp_i_cull_pyramid_side(hdrp_cull_shape s, hdrp_u32 i)
{
    hdrp_v2 a = hdrp_i_cull_wider(s.half_angle.x, s.half_angle.y);
    hdrp_v4 axis = s.right_half;
    if (i >= 2u) {
        a = hdrp_i_cull_wider(s.half_angle.z, s.half_angle.w);
        axis = s.up_half;
    }
    return hdrp_i_cull_mad(hdrp_v3_scale(hdrp_v3_from_v4(s.forward_half), a.x),
                           hdrp_v3_from_v4(axis), (i & 1u) != 0u ? -a.y : a.y);
}

/* The plane of the eye and an edge, where the pyramid is on one side of it. */
HDRP_FN hdrp_v4 hdrp_i_cull_pyramid_outline(hdrp_cull_shape s, hdrp_u32 i, float orthographic)
{
    hdrp_v3 apex = hdrp_v3_from_v4(s.center_range);
    hdrp_v3 n =
        hdrp_i_cull_cross(hdrp_i_cull_view_ray(apex, orthographic), hdrp_i_cull_pyramid_edge(s, i));
    float length2 = hdrp_i_cull_dot(n, n);
    float reach = -1.0f;
    hdrp_v4 r = hdrp_i_cull_no_plane();
    hdrp_u32 k;
    n = hdrp_i_cull_unit(n, hdrp_v3_from_v4(s.forward_half));
    if (hdrp_i_cull_dot(n, hdrp_v3_from_v4(s.forward_half)) > 0.0f) {
        n = hdrp_v3_neg(n);
    }
    for (k = 0u; k < 4u; ++k) {
        reach = hdrp_max(reach, hdrp_i_cull_dot(n, hdrp_i_cull_pyramid_edge(s, k)));
        /* Where a half angle is 90 degrees, two edges are one, and the sides say more. */
        reach = hdrp_max(reach, hdrp_i_cull_dot(n, hdrp_i_cull_pyramid_side(s, k)));
    }
    /* The edges are wider than the pyramid, by more than the direction of n is uncertain. */
    if (length2 > 1e-4f && reach < 5e-7f) {
        r = hdrp_v4_from_v3(n, hdrp_i_cull_dot(n, apex) + hdrp_i_cull_margin(apex) +
                                   HDRP_CULL_MARGIN * s.center_range.w);
    }
    return r;
}

/* Sides, range, apex, outline. */
HDRP_FN hdrp_v4 hdrp_i_cull_pyramid_plane(hdrp_cull_shape s, hdrp_u32 i, float orthographic)
{
    hdrp_v4 r = hdrp_i_cull_no_plane();
    hdrp_v3 axis = hdrp_v3_from_v4(s.right_half);
    hdrp_v2 angle = hdrp_i_cull_wider(s.half_angle.x, s.half_angle.y);
    hdrp_v3 apex = hdrp_v3_from_v4(s.center_range);
    if (i < 4u) {
        hdrp_v3 n;
        if (i >= 2u) {
            axis = hdrp_v3_from_v4(s.up_half);
            angle = hdrp_i_cull_wider(s.half_angle.z, s.half_angle.w);
        }
        n = hdrp_i_cull_mad(hdrp_v3_scale(axis, (i & 1u) != 0u ? -angle.x : angle.x),
                            hdrp_v3_from_v4(s.forward_half), -angle.y);
        r = hdrp_v4_from_v3(n, hdrp_i_cull_dot(n, apex) + hdrp_i_cull_margin(apex));
    } else if (i < 6u) {
        r = hdrp_i_cull_cap(s, i == 4u ? 1.0f : -1.0f);
    } else {
        r = hdrp_i_cull_pyramid_outline(s, i - 6u, orthographic);
    }
    return r;
}

/* The plane with a unit normal that touches a rounded box from outside. */
HDRP_FN hdrp_v4 hdrp_i_cull_box_touch(hdrp_cull_shape s, hdrp_v3 n)
{
    hdrp_v3 c = hdrp_v3_from_v4(s.center_range);
    float x = s.right_half.w * hdrp_abs(hdrp_i_cull_dot(n, hdrp_v3_from_v4(s.right_half)));
    float y = s.up_half.w * hdrp_abs(hdrp_i_cull_dot(n, hdrp_v3_from_v4(s.up_half)));
    float cosine = hdrp_i_cull_dot(n, hdrp_v3_from_v4(s.forward_half));
    float z = s.forward_half.w * hdrp_abs(cosine);
    float round_part = 1.0f;
    float size = s.right_half.w + s.up_half.w + s.forward_half.w + s.center_range.w;
    if (hdrp_cull_shape_kind(s) == HDRP_CULL_KIND_FRONT && cosine < 0.0f) {
        round_part = hdrp_i_cull_sine(n, hdrp_v3_from_v4(s.forward_half));
    }
    return hdrp_v4_from_v3(n, hdrp_i_cull_dot(n, c) + (x + y + z) + s.center_range.w * round_part +
                                  HDRP_CULL_MARGIN * size + hdrp_i_cull_margin(c));
}

/* On which side of a slab of a box the eye is: 1, -1, or 0 inside. */
HDRP_FN float hdrp_i_cull_box_seen_from(hdrp_cull_shape s, hdrp_v4 axis, float orthographic)
{
    float half_size = axis.w + s.center_range.w;
    float at = -hdrp_i_cull_dot(hdrp_v3_from_v4(s.center_range), hdrp_v3_from_v4(axis));
    if (orthographic > 0.0f) {
        at = -axis.z;
        half_size = 1e-6f;
    }
    return at > half_size ? 1.0f : at < -half_size ? -1.0f : 0.0f;
}

/* The plane of the eye and one of two edges along the third axis that are part of the outline. */
HDRP_FN hdrp_v4 hdrp_i_cull_box_outline(hdrp_cull_shape s, hdrp_v4 first, hdrp_v4 second,
                                        hdrp_v4 along, float side, float orthographic)
{
    float a = hdrp_i_cull_box_seen_from(s, first, orthographic);
    float b = hdrp_i_cull_box_seen_from(s, second, orthographic);
    float u = a == 0.0f ? side : b == 0.0f || side > 0.0f ? a : -a;
    float v = b == 0.0f ? side : a == 0.0f || side < 0.0f ? b : -b;
    hdrp_v3 c = hdrp_v3_from_v4(s.center_range);
    hdrp_v3 offset = hdrp_v3_scale(hdrp_v3_from_v4(first), u * (first.w + s.center_range.w));
    hdrp_v3 n;
    hdrp_v4 r;
    offset = hdrp_i_cull_mad(offset, hdrp_v3_from_v4(second), v * (second.w + s.center_range.w));
    n = hdrp_i_cull_cross(hdrp_i_cull_view_ray(hdrp_v3_add(c, offset), orthographic),
                          hdrp_v3_from_v4(along));
    n = hdrp_v3_scale(n, hdrp_i_cull_dot(n, offset) < 0.0f ? -1.0f : 1.0f);
    n = hdrp_i_cull_unit(n, hdrp_v3_from_v4(first));
    r = hdrp_i_cull_box_touch(s, n);
    if (a == 0.0f && b == 0.0f) {
        r = hdrp_i_cull_no_plane();
    }
    return r;
}

/* Faces, then two edges of the outline along each axis. */
HDRP_FN hdrp_v4 hdrp_i_cull_box_plane(hdrp_cull_shape s, hdrp_u32 i, float orthographic)
{
    hdrp_v4 r = hdrp_i_cull_no_plane();
    float side = (i & 1u) != 0u ? -1.0f : 1.0f;
    hdrp_u32 k = (i < 6u ? i : i - 6u) >> 1;
    hdrp_v4 along = s.forward_half, first = s.right_half, second = s.up_half;
    if (k == 0u) {
        along = s.right_half;
        first = s.up_half;
        second = s.forward_half;
    } else if (k == 1u) {
        along = s.up_half;
        second = s.forward_half;
    }
    if (i < 6u) {
        r = hdrp_i_cull_box_touch(s, hdrp_v3_scale(hdrp_v3_from_v4(along), side));
    } else {
        r = hdrp_i_cull_box_outline(s, first, second, along, side, orthographic);
    }
    return r;
}

/** A plane that a shape does not cross, for hdrp_cull_interval_plane.
 *  shape         valid  in view space
 *  i             [0,11]  which, below hdrp_cull_shape_plane_count
 *  orthographic  [0,1]  1 for an orthographic camera
 *  returns       any    xyz unit normal, or 0; the shape is where dot(normal, p) <= w
 *  edges         a normal of 0 and w = 1 where there is no such plane, as of an outline that is
 *                seen from inside
 *  error         none: encloses the shape; widened as HDRP_CULL_MARGIN says
 *  source        supporting planes of convex bodies, faces and outlines as seen from the eye */
HDRP_FN hdrp_v4 hdrp_cull_shape_plane(hdrp_cull_shape shape, hdrp_u32 i, float orthographic)
{
    hdrp_v4 r = hdrp_i_cull_no_plane();
    hdrp_u32 kind = hdrp_cull_shape_kind(shape);
    if (kind == HDRP_CULL_KIND_CONE) {
        r = hdrp_i_cull_cone_plane(shape, i, orthographic);
    }
    if (kind == HDRP_CULL_KIND_PYRAMID) {
        r = hdrp_i_cull_pyramid_plane(shape, i, orthographic);
    }
    if (kind >= HDRP_CULL_KIND_BOX) {
        r = hdrp_i_cull_box_plane(shape, i, orthographic);
    }
    return r;
}

/* Inside a cone around forward, for a position relative to the apex. Compares sines, because the
 * cosines of narrow cones have no digits left. */
HDRP_FN float hdrp_i_cull_in_cone(hdrp_cull_shape s, hdrp_v3 d, float margin)
{
    hdrp_v3 f = hdrp_v3_from_v4(s.forward_half);
    hdrp_v3 c = hdrp_i_cull_cross(d, f);
    float across2 = hdrp_i_cull_dot(c, c) * (s.half_angle.x * s.half_angle.x);
    float along = hdrp_i_cull_dot(d, f) * s.half_angle.y + margin;
    float front = along >= 0.0f ? 1.0f : 0.0f;
    /* Less than half a sphere is near the axis, in front; more is not near it, behind. */
    float narrow = across2 <= along * along ? front : 0.0f;
    float wide = across2 >= along * along ? 1.0f : front;
    return s.half_angle.x >= 0.0f ? narrow : wide;
}

/** Whether a shape reaches a position.
 *  shape     valid         in view space
 *  position  [-1e18,1e18]  in view space
 *  returns   [0,1]         1 inside
 *  edges     1 within HDRP_CULL_MARGIN of the surface; 0 for a shape that reaches nothing
 *  error     none: a test of positions that are rounded
 *  source    a definition */
HDRP_FN float hdrp_cull_shape_contains(hdrp_cull_shape shape, hdrp_v3 position)
{
    hdrp_u32 kind = hdrp_cull_shape_kind(shape);
    hdrp_v3 c = hdrp_v3_from_v4(shape.center_range);
    hdrp_v3 d = hdrp_v3_sub(position, c);
    float margin = hdrp_i_cull_margin(c) + hdrp_i_cull_margin(position);
    float range = shape.center_range.w * (1.0f + HDRP_CULL_MARGIN) + margin;
    float x = hdrp_abs(hdrp_i_cull_dot(d, hdrp_v3_from_v4(shape.right_half)));
    float y = hdrp_abs(hdrp_i_cull_dot(d, hdrp_v3_from_v4(shape.up_half)));
    float z = hdrp_i_cull_dot(d, hdrp_v3_from_v4(shape.forward_half));
    float inside = kind == HDRP_CULL_KIND_NONE ? 0.0f : 1.0f;
    if (kind == HDRP_CULL_KIND_CONE) {
        inside = hdrp_i_cull_in_cone(shape, d, margin);
    }
    if (kind == HDRP_CULL_KIND_PYRAMID) {
        float a = z * shape.half_angle.y - x * shape.half_angle.x + margin;
        float b = z * shape.half_angle.w - y * shape.half_angle.z + margin;
        inside = hdrp_min(a, b) >= 0.0f ? 1.0f : 0.0f;
    }
    if (kind == HDRP_CULL_KIND_FRONT) {
        inside = z >= -margin ? 1.0f : 0.0f;
    }
    if (kind >= HDRP_CULL_KIND_BOX) {
        range += HDRP_CULL_MARGIN * (shape.right_half.w + shape.up_half.w + shape.forward_half.w);
        d = hdrp_v3_make(hdrp_max(x - shape.right_half.w, 0.0f),
                         hdrp_max(y - shape.up_half.w, 0.0f),
                         hdrp_max(hdrp_abs(z) - shape.forward_half.w, 0.0f));
    }
    return hdrp_i_cull_dot(d, d) <= range * range ? inside : 0.0f;
}

/* >>tiles */

/* A rectangle of a picture. Made by hdrp_cull_tile_make. */
struct hdrp_cull_tile {
    hdrp_v4 window;         /* left, right, bottom, top: x / z, or m when orthographic */
    hdrp_v4 inverse_edge;   /* 1 / (1 + w^2) for each w of the window */
    hdrp_v4 inverse_corner; /* 1 / (1 + u^2 + v^2): left and right bottom, left and right top */
    hdrp_v4 extent;         /* largest |u| and |v|; 0, 0 */
};
HDRP_TYPEDEF(hdrp_cull_tile)

/** The frustum behind a rectangle of pixels.
 *  camera     valid
 *  x0_px      [0,16384]  left edge, from the left of the picture
 *  y0_px      [0,16384]  upper edge, from the top
 *  x1_px      [0,16384]  right edge
 *  y1_px      [0,16384]  lower edge
 *  width_px   [1,16384]  of the picture
 *  height_px  [1,16384]  of the picture
 *  returns    valid      a little larger than the rectangle
 *  edges      edges beyond the picture are allowed
 *  error      none: encloses the rectangle, by at most 1e-6 of the window
 *  source     a definition */
HDRP_FN hdrp_cull_tile hdrp_cull_tile_make(hdrp_cull_camera camera, float x0_px, float y0_px,
                                           float x1_px, float y1_px, float width_px,
                                           float height_px)
{
    hdrp_cull_tile t;
    hdrp_v4 w = camera.window;
    float du = w.z / width_px;
    float dv = w.w / height_px;
    float eu = 0.25f * HDRP_CULL_MARGIN * (hdrp_abs(w.x) + w.z);
    float ev = 0.25f * HDRP_CULL_MARGIN * (hdrp_abs(w.y) + w.w);
    float u0 = w.x + x0_px * du - eu;
    float u1 = w.x + x1_px * du + eu;
    float v0 = w.y + (height_px - y1_px) * dv - ev;
    float v1 = w.y + (height_px - y0_px) * dv + ev;
    hdrp_v4 sq = hdrp_v4_make(1.0f + u0 * u0, 1.0f + u1 * u1, 1.0f + v0 * v0, 1.0f + v1 * v1);
    t.window = hdrp_v4_make(u0, u1, v0, v1);
    t.inverse_edge = hdrp_v4_make(1.0f / sq.x, 1.0f / sq.y, 1.0f / sq.z, 1.0f / sq.w);
    t.inverse_corner = hdrp_v4_make(1.0f / (sq.x + v0 * v0), 1.0f / (sq.y + v0 * v0),
                                    1.0f / (sq.x + v1 * v1), 1.0f / (sq.y + v1 * v1));
    t.extent = hdrp_v4_make(hdrp_max(hdrp_abs(u0), hdrp_abs(u1)),
                            hdrp_max(hdrp_abs(v0), hdrp_abs(v1)), 0.0f, 0.0f);
    return t;
}

#ifndef HDRP_GPU
/* C and shaders share these: an array of negative size, an error, where their sizes differ. */
typedef char hdrp_i_cull_camera_size_of[sizeof(hdrp_cull_camera) == 80 ? 1 : -1];
typedef char hdrp_i_cull_shape_size_of[sizeof(hdrp_cull_shape) == 96 ? 1 : -1];
typedef char hdrp_i_cull_tile_size_of[sizeof(hdrp_cull_tile) == 64 ? 1 : -1];
#endif

/* Depths, in metres. Nothing is between them where nearest > farthest. */
struct hdrp_cull_interval {
    float nearest;  /* any */
    float farthest; /* any */
};
HDRP_TYPEDEF(hdrp_cull_interval)

#define HDRP_I_CULL_EMPTY 3e38f

/* Adds the chord of a ray through a corner of the tile. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_corner(hdrp_cull_interval r, hdrp_v4 ball, float u, float v,
                                              float inverse)
{
    float x = ball.x - u * ball.z;
    float y = ball.y - v * ball.z;
    float w = ball.x * v - ball.y * u;
    float chord2 = (ball.w * ball.w - (x * x + y * y + w * w) * inverse) * inverse;
    float middle = (ball.x * u + ball.y * v + ball.z) * inverse;
    float half_chord = hdrp_sqrt(hdrp_max(chord2, 0.0f));
    float begin = chord2 >= 0.0f ? middle - half_chord : HDRP_I_CULL_EMPTY;
    float end = chord2 >= 0.0f ? middle + half_chord : -HDRP_I_CULL_EMPTY;
    r.nearest = hdrp_min(begin, r.nearest);
    r.farthest = hdrp_max(end, r.farthest);
    return r;
}

/* Adds the nearest and the farthest place of the circle in a side of the tile, where they are on
 * the side. The side is x = u z, or with the coordinates exchanged y = v z. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_side(hdrp_cull_interval r, float x, float y, float z,
                                            float radius2, float u, float inverse, float v0,
                                            float v1, float margin)
{
    float d = x - u * z;
    float chord2 = (radius2 - d * d * inverse) * inverse;
    float middle = (x * u + z) * inverse;
    float half_depth = hdrp_sqrt(hdrp_max(chord2, 0.0f));
    float z0 = middle - half_depth;
    float z1 = middle + half_depth;
    float lo =
        chord2 >= 0.0f && v0 * z0 - margin <= y && y <= v1 * z0 + margin ? z0 : HDRP_I_CULL_EMPTY;
    float hi =
        chord2 >= 0.0f && v0 * z1 - margin <= y && y <= v1 * z1 + margin ? z1 : -HDRP_I_CULL_EMPTY;
    r.nearest = hdrp_min(lo, r.nearest);
    r.farthest = hdrp_max(hi, r.farthest);
    return r;
}

HDRP_FN hdrp_cull_interval hdrp_i_cull_ball_perspective(hdrp_cull_tile t, hdrp_v4 b)
{
    hdrp_cull_interval r;
    float r2 = b.w * b.w;
    float margin = HDRP_CULL_MARGIN * (hdrp_abs(b.x) + hdrp_abs(b.y) + hdrp_abs(b.z));
    float z0 = b.z - b.w;
    float z1 = b.z + b.w;
    hdrp_v4 w = t.window;
    float in0 = w.x * z0 - margin <= b.x && b.x <= w.y * z0 + margin ? 1.0f : 0.0f;
    float in1 = w.x * z1 - margin <= b.x && b.x <= w.y * z1 + margin ? 1.0f : 0.0f;
    in0 = w.z * z0 - margin <= b.y && b.y <= w.w * z0 + margin ? in0 : 0.0f;
    in1 = w.z * z1 - margin <= b.y && b.y <= w.w * z1 + margin ? in1 : 0.0f;
    r.nearest = in0 > 0.0f ? z0 : HDRP_I_CULL_EMPTY;
    r.farthest = in1 > 0.0f ? z1 : -HDRP_I_CULL_EMPTY;
    r = hdrp_i_cull_corner(r, b, w.x, w.z, t.inverse_corner.x);
    r = hdrp_i_cull_corner(r, b, w.y, w.z, t.inverse_corner.y);
    r = hdrp_i_cull_corner(r, b, w.x, w.w, t.inverse_corner.z);
    r = hdrp_i_cull_corner(r, b, w.y, w.w, t.inverse_corner.w);
    r = hdrp_i_cull_side(r, b.x, b.y, b.z, r2, w.x, t.inverse_edge.x, w.z, w.w, margin);
    r = hdrp_i_cull_side(r, b.x, b.y, b.z, r2, w.y, t.inverse_edge.y, w.z, w.w, margin);
    r = hdrp_i_cull_side(r, b.y, b.x, b.z, r2, w.z, t.inverse_edge.z, w.x, w.y, margin);
    r = hdrp_i_cull_side(r, b.y, b.x, b.z, r2, w.w, t.inverse_edge.w, w.x, w.y, margin);
    return r;
}

HDRP_FN hdrp_cull_interval hdrp_i_cull_ball_orthographic(hdrp_cull_tile t, hdrp_v4 b)
{
    hdrp_cull_interval r;
    float x = hdrp_max(hdrp_max(t.window.x - b.x, b.x - t.window.y), 0.0f);
    float y = hdrp_max(hdrp_max(t.window.z - b.y, b.y - t.window.w), 0.0f);
    float chord2 = b.w * b.w - (x * x + y * y);
    float half_depth = hdrp_sqrt(hdrp_max(chord2, 0.0f));
    r.nearest = chord2 >= 0.0f ? b.z - half_depth : HDRP_I_CULL_EMPTY;
    r.farthest = chord2 >= 0.0f ? b.z + half_depth : -HDRP_I_CULL_EMPTY;
    return r;
}

/** Between which depths a ball lies inside a tile.
 *  tile          valid
 *  ball          any     xyz centre in view space, w radius: hdrp_cull_shape_ball
 *  orthographic  [0,1]   1 for an orthographic camera
 *  returns       any     nearest > farthest where the ball misses the tile
 *  edges         depths may be negative: behind the camera; a ball around the eye begins there,
 *                and so may one beside it
 *  error         <= 4e-7 relative to the larger of distance and radius, as a radius: the interval
 *                is that of a ball so much larger or smaller  @accuracy cull_interval_ball
 *  source        derived: the extremes are those of the ball, of its circles in the four sides, or
 *                of its chords on the four edges of the tile; each counts if it is in the tile */
HDRP_FN hdrp_cull_interval hdrp_cull_interval_ball(hdrp_cull_tile tile, hdrp_v4 ball,
                                                   float orthographic)
{
    hdrp_cull_interval r = hdrp_i_cull_ball_perspective(tile, ball);
    if (orthographic > 0.0f) {
        r = hdrp_i_cull_ball_orthographic(tile, ball);
    }
    return r;
}

/* The part of an interval where z * slope <= d. */
HDRP_FN hdrp_cull_interval hdrp_i_cull_clip(hdrp_cull_interval r, float slope, float d)
{
    float z = d / (slope == 0.0f ? 1e-20f : slope);
    float margin = HDRP_CULL_MARGIN * hdrp_abs(z);
    float end = slope >= 0.0f ? z + margin : HDRP_I_CULL_EMPTY;
    float begin = slope < 0.0f ? z - margin : -HDRP_I_CULL_EMPTY;
    r.farthest = hdrp_min(end, r.farthest);
    r.nearest = hdrp_max(begin, r.nearest);
    return r;
}

/** Shortens an interval to what is on the inner side of a plane.
 *  interval      any
 *  tile          valid
 *  plane         any     xyz normal, w offset: hdrp_cull_shape_plane
 *  orthographic  [0,1]   1 for an orthographic camera
 *  returns       any     nothing is left in front of the camera where nearest > farthest or
 *                farthest < 0
 *  edges         a normal of 0 with w > 0 changes nothing
 *  error         none: encloses; the plane counts as 1e-6 farther out, in angle and in depth
 *  source        derived: at a depth z the least dot(n, p) in the tile is z times a constant */
HDRP_FN hdrp_cull_interval hdrp_cull_interval_plane(hdrp_cull_interval interval,
                                                    hdrp_cull_tile tile, hdrp_v4 plane,
                                                    float orthographic)
{
    hdrp_v4 w = tile.window;
    float least = hdrp_min(plane.x * w.x, plane.x * w.y) + hdrp_min(plane.y * w.z, plane.y * w.w);
    float size = hdrp_abs(plane.x) * tile.extent.x + hdrp_abs(plane.y) * tile.extent.y;
    float slope = least + plane.z - HDRP_CULL_MARGIN * (size + hdrp_abs(plane.z));
    float d = plane.w;
    if (orthographic > 0.0f) {
        d = plane.w - least + HDRP_CULL_MARGIN * size;
        slope = plane.z;
    }
    return hdrp_i_cull_clip(interval, slope, d);
}

/* >>screen bounds */

struct hdrp_cull_bounds {
    hdrp_v4 rect_px; /* [-2,16386] left, upper, right and lower edge; nothing where left > right */
    float nearest;   /* any depth in m */
    float farthest;  /* any */
};
HDRP_TYPEDEF(hdrp_cull_bounds)

/* Least and largest x / z of a circle at z >= near_m, the radius of which is not negative. */
HDRP_FN hdrp_v2 hdrp_i_cull_extent(float x, float z, float radius, float near_m)
{
    float d2 = x * x + z * z;
    float t = hdrp_sqrt(hdrp_max(d2 * (1.0f - HDRP_CULL_MARGIN) - radius * radius, 0.0f));
    float at = near_m - z;
    float half_near = hdrp_sqrt(hdrp_max(radius * radius - at * at, 0.0f));
    float z_lo = z * t - radius * x;
    float z_hi = z * t + radius * x;
    float lo = (x - half_near) / near_m;
    float hi = (x + half_near) / near_m;
    /* Where the tangent touches before the near plane, what the plane cuts is the outermost; in
     * doubt the tangent, which is never too narrow. */
    return hdrp_v2_make(z_hi * t > 0.99f * near_m * d2 ? (x * t - radius * z) / z_hi : lo,
                        z_lo * t > 0.99f * near_m * d2 ? (x * t + radius * z) / z_lo : hi);
}

/* From coordinates of the window to pixels, a little wider. */
HDRP_FN hdrp_v2 hdrp_i_cull_px(hdrp_v2 range, float edge, float size, float size_px)
{
    float scale = size_px / size;
    float lo = range.x - 2.0f * HDRP_CULL_MARGIN * (hdrp_abs(range.x) + hdrp_abs(edge) + size);
    float hi = range.y + 2.0f * HDRP_CULL_MARGIN * (hdrp_abs(range.y) + hdrp_abs(edge) + size);
    return hdrp_v2_make(hdrp_clamp((lo - edge) * scale, -1.0f, size_px + 1.0f),
                        hdrp_clamp((hi - edge) * scale, -1.0f, size_px + 1.0f));
}

/** The part of the picture in which a ball can be seen.
 *  ball       any        xyz centre in view space, w radius, rounded up: hdrp_cull_shape_ball
 *  camera     valid
 *  width_px   [1,16384]  of the picture
 *  height_px  [1,16384]  of the picture
 *  returns    valid      depths between the near and the far distance of the camera; left > right
 *             where it is behind, beyond or beside the picture
 *  edges      around the camera: the whole picture; across the near distance: what is behind that
 *             does not count
 *  error      none: encloses what was rounded up; by at most 0.1 px where the window is less wide
 *             than 120 degrees, the ball beyond the near distance and 0.1 % away from the eye
 *  source     tangents of a circle through the eye, after Mara and McGuire 2013, "2D Polyhedral
 *             Bounds of a Clipped, Perspective-Projected 3D Sphere" */
HDRP_FN hdrp_cull_bounds hdrp_cull_ball_bounds(hdrp_v4 ball, hdrp_cull_camera camera,
                                               float width_px, float height_px)
{
    hdrp_cull_bounds r;
    float near_m = camera.eye_near.w;
    float z0 = ball.z - ball.w;
    float z1 = ball.z + ball.w;
    hdrp_v2 x = hdrp_v2_make(ball.x - ball.w, ball.x + ball.w);
    hdrp_v2 y = hdrp_v2_make(ball.y - ball.w, ball.y + ball.w);
    float seen;
    if (camera.forward_orthographic.w <= 0.0f) {
        x = hdrp_i_cull_extent(ball.x, ball.z, ball.w, near_m);
        y = hdrp_i_cull_extent(ball.y, ball.z, ball.w, near_m);
    }
    x = hdrp_i_cull_px(x, camera.window.x, camera.window.z, width_px);
    y = hdrp_i_cull_px(y, camera.window.y, camera.window.w, height_px);
    r.nearest = hdrp_max(z0 - HDRP_CULL_MARGIN * hdrp_abs(z0), near_m);
    r.farthest = hdrp_min(z1 + HDRP_CULL_MARGIN * hdrp_abs(z1), camera.right_far.w);
    seen =
        r.nearest <= r.farthest && x.x <= width_px && x.y >= 0.0f && y.x <= height_px && y.y >= 0.0f
            ? 1.0f
            : 0.0f;
    r.rect_px = hdrp_v4_make(x.x, height_px - y.y, x.y, height_px - y.x);
    if (seen <= 0.0f) {
        r.rect_px = hdrp_v4_make(1.0f, 1.0f, 0.0f, 0.0f);
    }
    return r;
}

/* What is inside two bounds. */
HDRP_FN hdrp_cull_bounds hdrp_i_cull_both(hdrp_cull_bounds a, hdrp_cull_bounds b)
{
    hdrp_cull_bounds r;
    r.rect_px =
        hdrp_v4_make(hdrp_max(a.rect_px.x, b.rect_px.x), hdrp_max(a.rect_px.y, b.rect_px.y),
                     hdrp_min(a.rect_px.z, b.rect_px.z), hdrp_min(a.rect_px.w, b.rect_px.w));
    r.nearest = hdrp_max(a.nearest, b.nearest);
    r.farthest = hdrp_min(a.farthest, b.farthest);
    return r;
}

/* The cone around a pyramid: cos and sin of the angle between its axis and its edges. */
HDRP_FN hdrp_v2 hdrp_i_cull_cone_of(hdrp_cull_shape s)
{
    hdrp_v4 a = s.half_angle;
    float z = a.x * a.z;
    float r2 = a.y * a.y * (a.z * a.z) + a.x * a.x * (a.w * a.w);
    float k = 1.0f / hdrp_sqrt(hdrp_max(z * z + r2, 1e-20f));
    /* Two half angles of 90 degrees leave no edges: half of the ball. */
    hdrp_v2 cone = hdrp_v2_make(z * k, z * z + r2 > 1e-18f ? hdrp_sqrt(r2) * k : 1.0f);
    if (hdrp_cull_shape_kind(s) == HDRP_CULL_KIND_CONE) {
        cone = hdrp_v2_make(a.x, a.y);
    }
    return hdrp_i_cull_wider(cone.x, cone.y);
}

/* The smallest ball around the part of a ball that is inside a cone of at most half a sphere. */
HDRP_FN hdrp_v4 hdrp_i_cull_cone_ball(hdrp_cull_shape s, hdrp_v2 cone)
{
    hdrp_v3 apex = hdrp_v3_from_v4(s.center_range);
    float range = s.center_range.w * (1.0f + HDRP_CULL_MARGIN);
    /* Up to 45 degrees through the apex and the rim, above that through the rim alone. */
    float along = cone.x >= HDRP_SQRT_HALF ? 0.5f / cone.x : cone.x;
    float radius = cone.x >= HDRP_SQRT_HALF ? along : cone.y;
    hdrp_v3 c = hdrp_i_cull_mad(apex, hdrp_v3_from_v4(s.forward_half), along * range);
    return hdrp_v4_from_v3(c, radius * range * (1.0f + HDRP_CULL_MARGIN) + hdrp_i_cull_margin(c) +
                                  hdrp_i_cull_margin(apex));
}

/* How far a cone with a cap reaches along a direction, in ranges, from the angle to its axis. */
HDRP_FN float hdrp_i_cull_cone_reach(hdrp_v2 cone, float cosine, float sine)
{
    float rim = cosine * cone.x + sine * cone.y;
    return cosine >= cone.x ? 1.0f : hdrp_max(rim, 0.0f);
}

/* Depths between which a cone with a cap is. */
HDRP_FN hdrp_v2 hdrp_i_cull_cone_depths(hdrp_cull_shape s, hdrp_v2 cone)
{
    hdrp_v3 ahead = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    float cosine = s.forward_half.z;
    float sine = hdrp_i_cull_sine(hdrp_v3_from_v4(s.forward_half), ahead);
    float range = s.center_range.w;
    float margin =
        hdrp_i_cull_margin(hdrp_v3_from_v4(s.center_range)) + 4.0f * HDRP_CULL_MARGIN * range;
    return hdrp_v2_make(
        s.center_range.z - range * hdrp_i_cull_cone_reach(cone, -cosine, sine) - margin,
        s.center_range.z + range * hdrp_i_cull_cone_reach(cone, cosine, sine) + margin);
}

/** The part of the picture in which a shape can be seen.
 *  shape      valid      in view space
 *  camera     valid
 *  width_px   [1,16384]  of the picture
 *  height_px  [1,16384]  of the picture
 *  returns    valid      as hdrp_cull_ball_bounds
 *  edges      those of hdrp_cull_ball_bounds; nothing where nothing is reached
 *  error      none: encloses
 *  source     the ball of the shape and, of cones, the smallest one; depths of cones and boxes by
 *             their support functions */
HDRP_FN hdrp_cull_bounds hdrp_cull_shape_bounds(hdrp_cull_shape shape, hdrp_cull_camera camera,
                                                float width_px, float height_px)
{
    hdrp_u32 kind = hdrp_cull_shape_kind(shape);
    hdrp_u32 is_cone = (kind == HDRP_CULL_KIND_CONE && shape.half_angle.x >= 0.0f) ||
                               kind == HDRP_CULL_KIND_PYRAMID
                           ? 1u
                           : 0u;
    hdrp_v4 ball = hdrp_cull_shape_ball(shape);
    hdrp_v4 of_cone = ball;
    hdrp_v2 z = hdrp_v2_make(-HDRP_FLT_MAX, HDRP_FLT_MAX);
    hdrp_cull_bounds r;
    /* Bounds come last: then the shape is not needed any more, which saves a GPU registers. */
    if (is_cone != 0u) {
        hdrp_v2 cone = hdrp_i_cull_cone_of(shape);
        z = hdrp_i_cull_cone_depths(shape, cone);
        of_cone = hdrp_i_cull_cone_ball(shape, cone);
    }
    if (kind >= HDRP_CULL_KIND_BOX) {
        z.y = hdrp_i_cull_box_touch(shape, hdrp_v3_make(0.0f, 0.0f, 1.0f)).w;
        z.x = -hdrp_i_cull_box_touch(shape, hdrp_v3_make(0.0f, 0.0f, -1.0f)).w;
    }
    r = hdrp_cull_ball_bounds(ball, camera, width_px, height_px);
    if (is_cone != 0u) {
        r = hdrp_i_cull_both(r, hdrp_cull_ball_bounds(of_cone, camera, width_px, height_px));
    }
    r.nearest = hdrp_max(z.x, r.nearest);
    r.farthest = hdrp_min(z.y, r.farthest);
    if (kind == HDRP_CULL_KIND_NONE || r.nearest > r.farthest) {
        r.rect_px = hdrp_v4_make(1.0f, 1.0f, 0.0f, 0.0f);
    }
    return r;
}

#if defined(__clang__) && !defined(HDRP_GPU)
#pragma STDC FP_CONTRACT DEFAULT
#endif

#endif /* HDRP_CULL_VOLUME_H */
