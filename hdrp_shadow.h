/* hdrp_shadow.h - shadow maps: cascades, spots, points, their atlas, bias and filtering.
 * SPDX-License-Identifier: MIT
 *
 * See hdrp_math.h for the languages, the conventions and the override macros. Casters are drawn by
 * the caller, into squares of one depth image, the atlas. A view says where a position of the world
 * is in such a square, and how deep; clip_x to clip_w are the rows of its projection, for Vulkan's
 * clip space (y downwards, depth in [0,1]). The algorithm layer, C and C++ only, is compiled in one
 * source file:
 *
 *     #define HDRP_SHADOW_IMPLEMENTATION
 *     #include "hdrp_shadow.h"
 *
 * Each frame:
 *
 *     hdrp_shadow_place(atlas_px, 64, requests, count, order, maps, &stats);  squares by importance
 *     hdrp_shadow_make_cascades(&desc, views);                                of the sun
 *     views[n] = hdrp_shadow_view_light(light, face, near_m, maps[n], settings);   of other lights
 *     ... casters are drawn with the projection of each view, into its square ...
 *     shadow = hdrp_shadow_cascades_visibility(&atlas, views, 4, position, normal);
 *     face = hdrp_shadow_map_of_direction(views[n], from_light);      0 unless it shines all around
 *     shadow = hdrp_shadow_visibility(&atlas, &views[n + face], position, normal);
 *
 * The contract of the bias. Nothing is added to depths when casters are drawn: receivers move along
 * their normal, by as many texels as the filter and the slope ask for, hdrp_shadow_offset_texels. A
 * plane is then lit wherever it is not in the shadow of something else, at any angle to the light
 * and with any filter, as long as
 *     - the normal is that of the plane, off by at most 1.2 degrees,
 *     - coordinates are at most 4 times the depth range of the view, and maps 128 px or more,
 *     - settings.depth_step is that of the depth format, where it is coarser than 2^-20.
 * Shadows move by no more than those texels: at most 1.05 sqrt(2) times hdrp_shadow_filter_radius,
 * 0.8 texels without a filter and 3 and 4.5 with those of 3 x 3 and 5 x 5, and by a twentieth of
 * that where the light falls along the normal. With settings.slope_max above 0 depths follow the
 * plane of the receiver within the filter, and only surfaces steeper than that are moved. This is
 * for normals of the geometry: to those of a normal map, whose planes are none, it gives acne.
 *
 * >>index of the functions, without hdrp_shadow_ (written by tools/api_check.py --write)
 *   cascades: split slice_perspective slice_orthographic cascade_of_depth depth_weight
 *   filters: filter_radius border_px weights_make taps_make
 *   views: settings_make view_ball view_perspective
 *   lights: map_count face face_axis view_light map_of_direction
 *   lookup: offset_texels receiver_make lit cascade_weight
 *   maps: visibility cascades_visibility make_cascades
 *   atlas: place
 * >>end */
#ifndef HDRP_SHADOW_H
#define HDRP_SHADOW_H

#include "hdrp_light.h"

#if HDRP_VERSION != 100
#error "hdrp_shadow.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* >>cascades
 * Parts of what the camera sees, one behind the other, each with a map of its own. A map covers a
 * ball around its part: turning the camera does not change its size, and it moves by whole texels,
 * so that shadows do not shimmer. */

#define HDRP_SHADOW_CASCADES_MAX 4u

/** Depth at which a part of what the camera sees ends.
 *  near_m       [1e-6,1e9]  depth at which the first part begins
 *  far_m        [1e-6,1e9]  depth at which the last part ends; shadows end there
 *  share        [0,1]       (i + 1) / n for part i of n
 *  log_weight   [0,1]       0: parts of equal depth; 1: each grows by the same factor
 *  returns      [1e-6,1e9] m
 *  edges        near_m and far_m at the ends of share; a far_m below near_m counts as near_m
 *  error        <= 3e-7 relative  @accuracy shadow_split
 *  source       Zhang et al. 2006, "Parallel-Split Shadow Maps for Large-scale Virtual
 *               Environments", section on the practical split scheme */
HDRP_FN float hdrp_shadow_split(float near_m, float far_m, float share, float log_weight)
{
    float end = hdrp_max(far_m, near_m);
    float even = near_m + (end - near_m) * share;
    float rising = near_m * hdrp_pow(end / near_m, share);
    return hdrp_clamp(hdrp_lerp(even, rising, log_weight), near_m, end);
}

/** The smallest ball around a part of what a perspective camera sees.
 *  near_m   [1e-6,1e9]  depth at which the part begins
 *  far_m    [1e-6,1e9]  depth at which it ends
 *  tan_x    [0,16]      x / depth at the farther of the left and the right edge
 *  tan_y    [0,16]      y / depth at the farther of the lower and the upper edge
 *  returns  [0,3e10]    x depth of the centre, on the axis, y radius, m
 *  edges    a far_m below near_m counts as near_m; the radius is larger than need be by 1e-6 of it
 *           and 1e-7 of far_m, so that rounding leaves no corner outside
 *  error    <= 1.5e-6 relative to the radius and far_m / 10: of the radius, and of the distance of
 *           corners from the centre, against the best of all  @accuracy shadow_slice_perspective
 *  source   derived: the centre is equally far from the corners of both ends, or, where the part is
 *           wider than deep, that of the far end
 *  note     (far - near)^2 + 2 (far^2 + near^2) k + (far + near)^2 k^2 with k = tan_x^2 + tan_y^2
 *           is the square of the diameter, without differences that cancel */
HDRP_FN hdrp_v2 hdrp_shadow_slice_perspective(float near_m, float far_m, float tan_x, float tan_y)
{
    float f = hdrp_max(far_m, near_m);
    float k = tan_x * tan_x + tan_y * tan_y;
    float sum = f + near_m;
    float difference = f - near_m;
    float middle = 0.5f * sum * (1.0f + k);
    float diameter_sq =
        difference * difference + 2.0f * (f * f + near_m * near_m) * k + (sum * k) * (sum * k);
    float is_wide = middle >= f ? 1.0f : 0.0f;
    float radius = is_wide > 0.0f ? f * hdrp_sqrt(k) : 0.5f * hdrp_sqrt(diameter_sq);
    return hdrp_v2_make(is_wide > 0.0f ? f : middle, radius * 1.000001f + f * 1e-7f);
}

/** The smallest ball around a part of what an orthographic camera sees.
 *  near_m         [0,1e9]   depth at which the part begins
 *  far_m          [0,1e9]   depth at which it ends
 *  half_width_m   [0,1e9]   of the picture
 *  half_height_m  [0,1e9]
 *  returns        [0,2e9]   x depth of the centre, y radius, m
 *  edges          a far_m below near_m counts as near_m; the radius is 1e-6 of it larger
 *  error          <= 1.5e-6 relative  @accuracy shadow_slice_orthographic
 *  source         a definition: half the diagonal of a box */
HDRP_FN hdrp_v2 hdrp_shadow_slice_orthographic(float near_m, float far_m, float half_width_m,
                                               float half_height_m)
{
    float f = hdrp_max(far_m, near_m);
    float depth = 0.5f * (f - near_m);
    float radius =
        hdrp_sqrt(half_width_m * half_width_m + half_height_m * half_height_m + depth * depth);
    return hdrp_v2_make(near_m + depth, radius * 1.000001f);
}

/** The part that holds a depth, for those who choose by depth and not by balls.
 *  ends_m   any    depths at which parts 0 to 3 end, rising; the same as the last where there are
 *                  fewer
 *  z_view   any    m
 *  returns  [0,4]  4 behind the last
 *  edges    an end belongs to the part behind it; NaN is in front
 *  error    none: a selection
 *  source   Zhang et al. 2006, "Parallel-Split Shadow Maps for Large-scale Virtual Environments" */
HDRP_FN hdrp_u32 hdrp_shadow_cascade_of_depth(hdrp_v4 ends_m, float z_view)
{
    hdrp_u32 a = z_view >= ends_m.x ? 1u : 0u;
    hdrp_u32 b = z_view >= ends_m.y ? 1u : 0u;
    hdrp_u32 c = z_view >= ends_m.z ? 1u : 0u;
    hdrp_u32 d = z_view >= ends_m.w ? 1u : 0u;
    return a + b + c + d;
}

/** Share of a part in a blend with the next, by depth.
 *  end_m    [1e-6,1e9]  depth at which the part ends
 *  band     [0,1]       share of that depth over which it fades
 *  z_view   any         m
 *  returns  [0,1]       1 in front of the band, 0 from end_m on
 *  edges    without a band it ends within 1e-4 of its depth; NaN gives 0
 *  error    none: a definition
 *  source   a definition */
HDRP_FN float hdrp_shadow_depth_weight(float end_m, float band, float z_view)
{
    return hdrp_saturate((end_m - z_view) / (end_m * hdrp_max(band, 1e-4f)));
}

/* >>filters
 * How many texels of a map, and with which weights, become the visibility of a position. */

#define HDRP_SHADOW_FILTER_HARD     0u /* the texel that holds the position */
#define HDRP_SHADOW_FILTER_BILINEAR 1u /* 2 x 2: an edge is a linear ramp of one texel */
#define HDRP_SHADOW_FILTER_TENT_3   2u /* a tent over 3 x 3 texels, in 2 x 2 bilinear taps */
#define HDRP_SHADOW_FILTER_TENT_5   3u /* a tent over 5 x 5 texels, in 3 x 3 bilinear taps */

/** How far the centres of the texels of a filter are from a position, at most, along one side.
 *  filter_kind  any        HDRP_SHADOW_FILTER_...
 *  returns      [0.5,3]    texels
 *  edges        what is beyond the last filter counts as it
 *  error        none: a definition
 *  source       a definition */
HDRP_FN float hdrp_shadow_filter_radius(hdrp_u32 filter_kind)
{
    return filter_kind == 0u ? 0.5f : hdrp_f32_from_u32(filter_kind < 3u ? filter_kind : 3u);
}

/** Texels at each side of a map that are there for the filter and the offset alone.
 *  filter_kind  any      HDRP_SHADOW_FILTER_...
 *  returns      [2,8]    px
 *  edges        what is beyond the last filter counts as it
 *  error        none: a definition
 *  source       derived: hdrp_shadow_filter_radius, and 1.05 sqrt(2) times that for the offset */
HDRP_FN hdrp_u32 hdrp_shadow_border_px(hdrp_u32 filter_kind)
{
    hdrp_u32 wide = filter_kind == 2u ? 5u : 8u;
    hdrp_u32 narrow = filter_kind == 0u ? 2u : 3u;
    return filter_kind < 2u ? narrow : wide;
}

/* Weights of up to six texels in a row: of the texels at base, base + 2 and base + 4 from the one
 * whose centre is last at or before the position, and of those behind each. Made by
 * hdrp_shadow_weights_make. */
struct hdrp_shadow_weights {
    hdrp_v3 even; /* [0,1] */
    hdrp_v3 odd;  /* [0,1] */
    float base;   /* [-2,0] */
};
HDRP_TYPEDEF(hdrp_shadow_weights)

/* Share of a tent of a half width that is before x. */
HDRP_FN float hdrp_i_shadow_tent_before(float x, float half_width)
{
    float a = hdrp_saturate((half_width - hdrp_abs(x)) / half_width);
    float tail = 0.5f * a * a;
    return x < 0.0f ? tail : 1.0f - tail;
}

/** Weights of texels along one side of a map.
 *  filter_kind  any    HDRP_SHADOW_FILTER_...
 *  fraction     [0,1]  of the position between the centres of two texels
 *  returns      valid  the sum is 1; without the filters of 3 and 5 the last ones are 0
 *  edges        without a filter the nearer texel counts, and the second one at 0.5
 *  error        <= 1.5e-7 absolute against the integral of the tent over each texel, and for the
 *               sum  @accuracy shadow_weights
 *  source       Reeves, Salesin and Cook 1987, "Rendering Antialiased Shadows with Depth Maps"; the
 *               tent is an integral over each texel, so that a straight edge along a side moves the
 *               visibility by the integral of the tent, without steps
 *  note         weights of two sides are multiplied */
HDRP_FN hdrp_shadow_weights hdrp_shadow_weights_make(hdrp_u32 filter_kind, float fraction)
{
    hdrp_shadow_weights w;
    float pairs = hdrp_f32_from_u32(filter_kind < 3u ? filter_kind : 3u);
    float h = hdrp_max(pairs, 1.0f) - 0.5f;
    float first = 0.5f - hdrp_max(pairs, 1.0f) - fraction; /* where the first texel begins */
    float c1 = hdrp_i_shadow_tent_before(first + 1.0f, h);
    float c2 = hdrp_i_shadow_tent_before(first + 2.0f, h);
    float c3 = hdrp_i_shadow_tent_before(first + 3.0f, h);
    float c4 = hdrp_i_shadow_tent_before(first + 4.0f, h);
    float c5 = hdrp_i_shadow_tent_before(first + 5.0f, h);
    float near_share = filter_kind == 0u ? (fraction < 0.5f ? 1.0f : 0.0f) : 1.0f - fraction;
    w.even = hdrp_v3_make(c1, c3 - c2, c5 - c4);
    w.odd = hdrp_v3_make(c2 - c1, c4 - c3, 1.0f - c5);
    w.base = 1.0f - hdrp_max(pairs, 1.0f);
    if (filter_kind < 2u) {
        w.even = hdrp_v3_make(near_share, 0.0f, 0.0f);
        w.odd = hdrp_v3_make(1.0f - near_share, 0.0f, 0.0f);
    }
    return w;
}

/* The same as taps of a sampler that filters what it has compared: pairs of texels at once. */
struct hdrp_shadow_taps {
    hdrp_v3 weight; /* [0,1] */
    hdrp_v3 place;  /* [-2,4] where, in texels from the centre of the texel before the position */
};
HDRP_TYPEDEF(hdrp_shadow_taps)

/** Taps along one side of a map for a sampler that compares and filters linearly.
 *  weights  valid
 *  returns  valid  as many taps as hdrp_shadow_filter_radius says, rounded up: 1, 2 or 3
 *  edges    a tap without weight is at the first of its texels
 *  error    <= 1e-7 absolute for the weights of texels that come of it  @accuracy shadow_taps
 *  source   Sigg and Hadwiger 2005, "Fast Third-Order Texture Filtering", eq. 6: one linear tap
 *           instead of two neighbours */
HDRP_FN hdrp_shadow_taps hdrp_shadow_taps_make(hdrp_shadow_weights weights)
{
    hdrp_shadow_taps t;
    hdrp_v3 w = hdrp_v3_add(weights.even, weights.odd);
    t.weight = hdrp_v3_make(hdrp_min(w.x, 1.0f), hdrp_min(w.y, 1.0f), hdrp_min(w.z, 1.0f));
    t.place = hdrp_v3_make(weights.base + weights.odd.x / hdrp_max(w.x, 1e-4f),
                           weights.base + 2.0f + weights.odd.y / hdrp_max(w.y, 1e-4f),
                           weights.base + 4.0f + weights.odd.z / hdrp_max(w.z, 1e-4f));
    return t;
}

/* >>views
 * What a shader knows of a map. Ten vectors, the same in C and in std430 buffers. */

#define HDRP_SHADOW_VIEW_SIZE 160u
/* Tangent of the widest half angle of one map: 82.9 degrees. Wider lights need faces. */
#define HDRP_SHADOW_TAN_MAX 8.0f
/* Largest map and atlas, in pixels along a side. */
#define HDRP_SHADOW_SIZE_MAX 16384u
/* What normals may be off by, as a share of the filter: see the contract above. */
#define HDRP_SHADOW_MARGIN 0.05f

/* Choices for a view. Made by hdrp_shadow_settings_make. */
struct hdrp_shadow_settings {
    hdrp_u32 filter_kind; /* [0,3] HDRP_SHADOW_FILTER_... */
    hdrp_u32 reverse;     /* [0,1] 1 where device depth is 1 at the near plane and 0 at the far */
    float slope_max;      /* [0,8] slope up to which depths follow the plane of the receiver */
    float depth_step; /* [0,0.01] of the depth format: 1 / 65535 for D16; 0: 2^-20, all others */
    float band;       /* [0,0.5] share of a ball's radius over which a cascade fades */
};
HDRP_TYPEDEF(hdrp_shadow_settings)

/* Made by hdrp_shadow_view_ball, hdrp_shadow_view_perspective and hdrp_shadow_view_light. */
struct hdrp_shadow_view {
    hdrp_v4 clip_x;     /* finite  clip coordinates are dot products of these and (x, y, z, 1) */
    hdrp_v4 clip_y;     /* finite */
    hdrp_v4 clip_z;     /* finite */
    hdrp_v4 clip_w;     /* finite */
    hdrp_v4 place;      /* [0,32768]  texel of the atlas = (x, y) times clip / w, plus (z, w) */
    hdrp_v4 limits;     /* [0,32768]  x, y first texel, z, w last one */
    hdrp_v4 axis_texel; /* xyz unit, w [0,1e19] m  towards the light; width of a texel by clip w */
    hdrp_v4 bias;       /* xyz [0,8], w [-1,1]  texels, depth, slope_max; -1: reverse depth */
    hdrp_v4 ball;       /* xyz [-1e18,1e18], w [0,1e30] m^2  of a cascade: centre, radius^2; else
                           where the light comes from, and 0 */
    hdrp_v4 fade;       /* x [0,1e30], yzw [0,6]  1/m^2 inside the rim, filter_kind, maps, 1 where
                           the light comes from a position */
};
HDRP_TYPEDEF(hdrp_shadow_view)

#ifndef HDRP_GPU
typedef char hdrp_i_shadow_view_size_of[sizeof(hdrp_shadow_view) == HDRP_SHADOW_VIEW_SIZE ? 1 : -1];
#endif

/** Recommended choices for a filter.
 *  filter_kind  any    HDRP_SHADOW_FILTER_...
 *  reverse      any    not 0 where device depth is 1 at the near plane and 0 at the far one
 *  returns      valid  slope_max 0, the step of 24 bits or more, a band of a tenth
 *  edges        what is beyond the last filter counts as it
 *  error        none: a definition
 *  source       a definition */
HDRP_FN hdrp_shadow_settings hdrp_shadow_settings_make(hdrp_u32 filter_kind, hdrp_u32 reverse)
{
    hdrp_shadow_settings s;
    s.filter_kind = filter_kind < 3u ? filter_kind : 3u;
    s.reverse = reverse != 0u ? 1u : 0u;
    s.slope_max = 0.0f;
    s.depth_step = 0.0f;
    s.band = 0.1f;
    return s;
}

/* A row of a projection: the component of a position along an axis, from an origin. */
HDRP_FN hdrp_v4 hdrp_i_shadow_row(hdrp_v3 axis, hdrp_v3 origin, float scale, float offset)
{
    hdrp_v3 a = hdrp_v3_scale(axis, scale);
    return hdrp_v4_from_v3(a, offset - hdrp_v3_dot(a, origin));
}

/* Square of a map: x first column, y first row, z size in px, w texels inside the border. */
HDRP_FN hdrp_v4 hdrp_i_shadow_square(hdrp_u32x4 map, hdrp_u32 filter_kind)
{
    hdrp_u32 limit = HDRP_SHADOW_SIZE_MAX;
    hdrp_u32 size = map.z < limit ? map.z : limit;
    hdrp_u32 border = 2u * hdrp_shadow_border_px(filter_kind);
    size = size > 1u ? size : 1u;
    return hdrp_v4_make(hdrp_f32_from_u32(map.x < limit ? map.x : limit),
                        hdrp_f32_from_u32(map.y < limit ? map.y : limit), hdrp_f32_from_u32(size),
                        hdrp_f32_from_u32(size > border ? size - border : 1u));
}

/* What views have in common: the square and the choices. */
HDRP_FN hdrp_shadow_view hdrp_i_shadow_view(hdrp_v4 square, hdrp_shadow_settings s, hdrp_v3 axis,
                                            float texel)
{
    hdrp_shadow_view v;
    float half_px = 0.5f * square.z;
    float rounding = hdrp_max(1.5f * s.depth_step, 9.5367431640625e-7f); /* 2^-20 */
    v.place = hdrp_v4_make(half_px, half_px, square.x + half_px, square.y + half_px);
    v.limits =
        hdrp_v4_make(square.x, square.y, square.x + square.z - 1.0f, square.y + square.z - 1.0f);
    v.axis_texel = hdrp_v4_from_v3(axis, texel);
    v.bias = hdrp_v4_make(HDRP_SQRT_2 * hdrp_shadow_filter_radius(s.filter_kind), rounding,
                          s.slope_max, s.reverse != 0u ? -1.0f : 1.0f);
    v.ball = hdrp_v4_make(0.0f, 0.0f, 0.0f, 0.0f);
    v.fade =
        hdrp_v4_make(0.0f, hdrp_f32_from_u32(s.filter_kind < 3u ? s.filter_kind : 3u), 1.0f, 0.0f);
    v.clip_x = v.ball;
    v.clip_y = v.ball;
    v.clip_z = v.ball;
    v.clip_w = hdrp_v4_make(0.0f, 0.0f, 0.0f, 1.0f);
    return v;
}

/* Depth of a parallel projection: 0 or, reversed, 1 where the component along the axis, which
 * points towards the light, is nearest_m, and the other after range_m. */
HDRP_FN hdrp_v4 hdrp_i_shadow_parallel_depth(hdrp_v3 axis, float nearest_m, float range_m,
                                             hdrp_u32 reverse)
{
    float scale = 1.0f / range_m;
    float s = reverse != 0u ? scale : -scale;
    float end = reverse != 0u ? range_m - nearest_m : nearest_m;
    return hdrp_v4_from_v3(hdrp_v3_scale(axis, s), end * scale);
}

/* Nearest whole multiple of a step. */
HDRP_FN float hdrp_i_shadow_snap(float x, float step)
{
    return hdrp_floor(x / step + 0.5f) * step;
}

/** The view of a cascade: parallel light on a ball.
 *  ball      [-1e6,1e6]  xyz centre, m, in the frame of the positions that are looked up; w radius
 *  forward   any         direction of travel of the light; any length
 *  caster_m  [0,1e6]     how far in front of the centre casters count; at least the radius
 *  map       any         x first column, y first row, z size in px of its square; w 0
 *  settings  valid
 *  returns   valid
 *  edges     without a direction the light shines down; a radius below 1 mm counts as that
 *  error     none: a definition; rounding moves positions within the map by less than
 *            HDRP_SHADOW_MARGIN
 *  source    Valient 2008, "Stable Rendering of Cascaded Shadow Maps", in ShaderX6: a ball, and
 *            steps of whole texels
 *  note      the ball fills the map but for hdrp_shadow_border_px on each side and one texel, half
 *            of which the map may be off to either side;
 *            draw with depth clamped and not clipped: what is in front of the near plane casts too.
 *            Where positions are relative to a camera that moves, so is the grid of texels, and
 *            shadows shimmer: give such positions an origin that stays */
HDRP_FN hdrp_shadow_view hdrp_shadow_view_ball(hdrp_v4 ball, hdrp_v3 forward, float caster_m,
                                               hdrp_u32x4 map, hdrp_shadow_settings settings)
{
    hdrp_v3 f = hdrp_normalize_or(forward, hdrp_v3_make(0.0f, -1.0f, 0.0f));
    hdrp_v3 axis = hdrp_v3_neg(f);
    hdrp_basis basis = hdrp_basis_from_normal(axis);
    hdrp_v4 square = hdrp_i_shadow_square(map, settings.filter_kind);
    hdrp_v3 center = hdrp_v3_from_v4(ball);
    float radius = hdrp_max(ball.w, 1e-3f);
    float before = hdrp_max(caster_m, radius);
    /* One texel more, by which the grid may be off. */
    float texel = 2.0f * radius / hdrp_max(square.w - 1.0f, 1.0f);
    float scale = 2.0f / (texel * square.z);
    float inner = radius * (1.0f - hdrp_clamp(settings.band, 1e-4f, 0.5f));
    hdrp_shadow_view v = hdrp_i_shadow_view(square, settings, axis, texel);
    float x = hdrp_i_shadow_snap(hdrp_v3_dot(basis.tangent, center), texel);
    float y = hdrp_i_shadow_snap(hdrp_v3_dot(basis.bitangent, center), texel);
    v.clip_x = hdrp_v4_from_v3(hdrp_v3_scale(basis.tangent, scale), -x * scale);
    v.clip_y = hdrp_v4_from_v3(hdrp_v3_scale(basis.bitangent, -scale), y * scale);
    v.clip_z = hdrp_i_shadow_parallel_depth(axis, hdrp_v3_dot(axis, center) + before,
                                            before + radius, settings.reverse);
    v.ball = hdrp_v4_from_v3(center, radius * radius);
    v.fade.x = 1.0f / (radius * radius - inner * inner);
    return v;
}

/* A perspective view whose frame is orthonormal: tangents x, y, depths z, w. */
HDRP_FN hdrp_shadow_view hdrp_i_shadow_perspective(hdrp_v3 eye, hdrp_v3 right, hdrp_v3 up,
                                                   hdrp_v3 forward, hdrp_v4 extent, hdrp_u32x4 map,
                                                   hdrp_shadow_settings settings)
{
    hdrp_v4 square = hdrp_i_shadow_square(map, settings.filter_kind);
    float n = hdrp_clamp(extent.z, 1e-6f, 1e9f);
    float f = hdrp_clamp(extent.w, n * 1.001f, 1e18f);
    float wider = square.z / square.w; /* the border */
    float x = hdrp_clamp(extent.x, 1e-4f, HDRP_SHADOW_TAN_MAX) * wider;
    float y = hdrp_clamp(extent.y, 1e-4f, HDRP_SHADOW_TAN_MAX) * wider;
    float k = n / (f - n);
    hdrp_shadow_view v = hdrp_i_shadow_view(square, settings, hdrp_v3_neg(forward),
                                            2.0f * hdrp_max(x, y) / square.z);
    v.ball = hdrp_v4_from_v3(eye, 0.0f);
    v.fade.w = 1.0f;
    v.clip_x = hdrp_i_shadow_row(right, eye, 1.0f / x, 0.0f);
    v.clip_y = hdrp_i_shadow_row(up, eye, -1.0f / y, 0.0f);
    v.clip_w = hdrp_i_shadow_row(forward, eye, 1.0f, 0.0f);
    v.clip_z = settings.reverse != 0u ? hdrp_i_shadow_row(forward, eye, -k, n + n * k)
                                      : hdrp_i_shadow_row(forward, eye, 1.0f + k, -n - n * k);
    return v;
}

/** The view of light that comes from a position, within a pyramid.
 *  position  [-1e6,1e6]  m
 *  forward   any         axis, away from the light; any length
 *  up        any         roughly upwards in the map; any length, need not be orthogonal
 *  extent    [0,1e9]     x, y tangents of the half angles, z nearest, w farthest depth, m
 *  map       any         as for hdrp_shadow_view_ball
 *  settings  valid       band is not used
 *  returns   valid
 *  edges     tangents are limited to [1e-4,HDRP_SHADOW_TAN_MAX], the nearest depth to 1e-6 m, the
 *            farthest to 1.001 times the nearest; without a direction it looks down
 *  error     none: as hdrp_shadow_view_ball
 *  source    Williams 1978, "Casting Curved Shadows on Curved Surfaces"
 *  note      the map is wider than the pyramid by hdrp_shadow_border_px */
HDRP_FN hdrp_shadow_view hdrp_shadow_view_perspective(hdrp_v3 position, hdrp_v3 forward, hdrp_v3 up,
                                                      hdrp_v4 extent, hdrp_u32x4 map,
                                                      hdrp_shadow_settings settings)
{
    hdrp_light frame =
        hdrp_light_pyramid(position, forward, up, hdrp_v3_splat(1.0f), 1.0f, 0.5f, 0.5f, 0.0f);
    return hdrp_i_shadow_perspective(position, hdrp_v3_from_v4(frame.right_half_width),
                                     hdrp_v3_from_v4(frame.up_half_height),
                                     hdrp_v3_from_v4(frame.forward_radius), extent, map, settings);
}

/* >>lights */

/** Maps that a light needs.
 *  light    any
 *  returns  [0,6]  1 for a spot, a pyramid and a box, 6 faces for what shines all around; for a
 *                  directional light its cascades count, so 0, as for none
 *  edges    a cone wider than HDRP_SHADOW_TAN_MAX needs faces
 *  error    none: a selection
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_shadow_map_count(hdrp_light light)
{
    hdrp_u32 type = hdrp_light_type(light);
    float wide = light.half_angle.y > HDRP_SHADOW_TAN_MAX * light.half_angle.x ? 1.0f : 0.0f;
    hdrp_u32 spot = type == HDRP_LIGHT_TYPE_SPOT && wide > 0.0f ? 6u : 1u;
    hdrp_u32 n = type >= HDRP_LIGHT_TYPE_SPOT && type <= HDRP_LIGHT_TYPE_BOX ? spot : 6u;
    return type == HDRP_LIGHT_TYPE_NONE || type == HDRP_LIGHT_TYPE_DIRECTIONAL ? 0u : n;
}

/** The face of a cube that a direction points to.
 *  direction  any    from the light; any length
 *  returns    [0,5]  +x, -x, +y, -y, +z, -z
 *  edges      where two faces meet x goes before y, and y before z; no direction is +x
 *  error      none: a selection
 *  source     Vulkan specification, "Cube Map Face Selection": the major axis */
HDRP_FN hdrp_u32 hdrp_shadow_face(hdrp_v3 direction)
{
    float x = hdrp_abs(direction.x);
    float y = hdrp_abs(direction.y);
    float z = hdrp_abs(direction.z);
    hdrp_u32 on_z = z > y ? (direction.z < 0.0f ? 5u : 4u) : (direction.y < 0.0f ? 3u : 2u);
    hdrp_u32 on_x = direction.x < 0.0f ? 1u : 0u;
    return y > x || z > x ? on_z : on_x;
}

/** The axis of a face.
 *  face     [0,5]  from hdrp_shadow_face
 *  returns  unit
 *  edges    what is beyond 5 counts as 5
 *  error    none: a selection
 *  source   a definition */
HDRP_FN hdrp_v3 hdrp_shadow_face_axis(hdrp_u32 face)
{
    float s = (face & 1u) != 0u || face > 5u ? -1.0f : 1.0f;
    return hdrp_v3_make(face < 2u ? s : 0.0f, (face >> 1u) == 1u ? s : 0.0f, face > 3u ? s : 0.0f);
}

/* Parallel light inside a box: the light's own frame, without a grid. */
HDRP_FN hdrp_shadow_view hdrp_i_shadow_box(hdrp_light light, hdrp_u32x4 map,
                                           hdrp_shadow_settings settings)
{
    hdrp_v4 square = hdrp_i_shadow_square(map, settings.filter_kind);
    hdrp_v3 axis = hdrp_v3_neg(hdrp_v3_from_v4(light.forward_radius));
    hdrp_v3 origin = hdrp_v3_from_v4(light.position_range);
    float larger = hdrp_max(light.right_half_width.w, light.up_half_height.w);
    float texel = 2.0f * hdrp_max(larger, 1e-3f) / square.w;
    float scale = 2.0f / (texel * square.z);
    hdrp_shadow_view v = hdrp_i_shadow_view(square, settings, axis, texel);
    v.clip_x = hdrp_i_shadow_row(hdrp_v3_from_v4(light.right_half_width), origin, scale, 0.0f);
    v.clip_y = hdrp_i_shadow_row(hdrp_v3_from_v4(light.up_half_height), origin, -scale, 0.0f);
    v.clip_z = hdrp_i_shadow_parallel_depth(
        axis, hdrp_v3_dot(axis, origin), hdrp_max(light.position_range.w, 1e-3f), settings.reverse);
    return v;
}

/** The view of a map of a light that is not directional.
 *  light     valid
 *  face      any         [0,5] where hdrp_shadow_map_count is 6
 *  near_m    any         nearest depth of casters; limited to [1e-6,1e9]
 *  map       any         as for hdrp_shadow_view_ball
 *  settings  valid       band is not used
 *  returns   valid
 *  edges     the far depth is the range, at most a million times the near one
 *  error     none: as hdrp_shadow_view_ball
 *  source    Williams 1978, "Casting Curved Shadows on Curved Surfaces"
 *  note      area lights count as points; a cone is put into a square of its half angle */
HDRP_FN hdrp_shadow_view hdrp_shadow_view_light(hdrp_light light, hdrp_u32 face, float near_m,
                                                hdrp_u32x4 map, hdrp_shadow_settings settings)
{
    hdrp_v3 eye = hdrp_v3_from_v4(light.position_range);
    hdrp_v3 right = hdrp_v3_from_v4(light.right_half_width);
    hdrp_v3 up = hdrp_v3_from_v4(light.up_half_height);
    hdrp_v3 forward = hdrp_v3_from_v4(light.forward_radius);
    float n = hdrp_clamp(near_m, 1e-6f, 1e9f);
    float f = hdrp_min(light.position_range.w, 1e6f * n);
    hdrp_v4 a = light.half_angle;
    hdrp_v4 extent = hdrp_v4_make(a.y / hdrp_max(a.x, 1e-4f), a.w / hdrp_max(a.z, 1e-4f), n, f);
    hdrp_u32 maps = hdrp_shadow_map_count(light);
    hdrp_shadow_view v;
    if (maps != 1u) {
        hdrp_v3 axis = hdrp_shadow_face_axis(face);
        float steep = hdrp_abs(axis.y);
        up = hdrp_v3_make(0.0f, 1.0f - steep, steep);
        forward = axis;
        right = hdrp_v3_cross(forward, up);
        extent = hdrp_v4_make(1.0f, 1.0f, n, f);
    }
    if (hdrp_light_type(light) == HDRP_LIGHT_TYPE_BOX) {
        return hdrp_i_shadow_box(light, map, settings);
    }
    v = hdrp_i_shadow_perspective(eye, right, up, forward, extent, map, settings);
    v.fade.z = maps != 1u ? 6.0f : 1.0f;
    return v;
}

/** Which of the maps of a light holds a direction: to be added to its first one.
 *  view       valid  the first one
 *  direction  any    from the light; any length
 *  returns    [0,5]
 *  edges      0 for a light with one map
 *  error      none: a selection, by hdrp_shadow_face
 *  source     a definition */
HDRP_FN hdrp_u32 hdrp_shadow_map_of_direction(hdrp_shadow_view view, hdrp_v3 direction)
{
    return view.fade.z > 1.0f ? hdrp_shadow_face(direction) : 0u;
}

/* >>lookup */

/** Texels by which a receiver is moved along its normal.
 *  view       valid
 *  cosine     any       between the normal and the axis towards the light
 *  incidence  any       the same with the direction to the light in place of the axis, as long as
 *             its component along the axis is 1: cosine in parallel light
 *  returns    [0,4.6]
 *  edges      a cosine outside [-1,1] counts as the nearer end, NaN as -1; without slope_max
 *             incidence does not count
 *  error      none: a definition, as the contract at the top has it
 *  source     Holbert 2011, "Saying Goodbye to Shadow Acne"; the length is derived: what is moved
 *             by sqrt(2) radius sin texels is in front of its own plane everywhere in a square of
 *             that radius, at its own depth
 *  note       with slope_max only what is steeper than three quarters of it counts: near that
 *             light from a position is not parallel enough for all of it */
HDRP_FN float hdrp_shadow_offset_texels(hdrp_shadow_view view, float cosine, float incidence)
{
    float c = hdrp_clamp(cosine, -1.0f, 1.0f);
    float sine = hdrp_sqrt((1.0f - c) * (1.0f + c));
    float follows = view.bias.z > 0.0f ? 0.75f * view.bias.z * hdrp_abs(incidence) : 0.0f;
    return view.bias.x * (hdrp_max(sine - follows, 0.0f) + HDRP_SHADOW_MARGIN);
}

/* A position in a map. */
struct hdrp_shadow_receiver {
    hdrp_v4 place; /* [-32768,65536] x, y texels of the atlas, z device depth, w 1: in the map */
    hdrp_v4 plane; /* finite  x, y by what depth rises per texel in the plane; z, w 0 */
};
HDRP_TYPEDEF(hdrp_shadow_receiver)

/* Direction to the light, as long as its component along the axis is 1. */
HDRP_FN hdrp_v3 hdrp_i_shadow_to_light(hdrp_shadow_view view, hdrp_v3 position)
{
    hdrp_v3 axis = hdrp_v3_from_v4(view.axis_texel);
    hdrp_v3 d = hdrp_v3_sub(hdrp_v3_from_v4(view.ball), position);
    d = hdrp_v3_scale(d, 1.0f / hdrp_max(hdrp_v3_dot(d, axis), 1e-9f));
    return hdrp_v3_select(view.fade.w, d, axis);
}

/* Gradient of a clip coordinate after the division, at a position. */
HDRP_FN hdrp_v3 hdrp_i_shadow_gradient(hdrp_v4 row, hdrp_v4 row_w, float value, float inv_w)
{
    hdrp_v3 g = hdrp_v3_mad(hdrp_v3_from_v4(row), hdrp_v3_from_v4(row_w), -value);
    return hdrp_v3_scale(g, inv_w);
}

/* How depth changes along x and y of the map, on a plane through a position of clip x, y, z, with
 * 1 / w in w: nothing where the plane is seen from its edge. */
HDRP_FN hdrp_v2 hdrp_i_shadow_plane(hdrp_shadow_view view, hdrp_v4 at, hdrp_v3 normal, float most)
{
    hdrp_v3 x = hdrp_i_shadow_gradient(view.clip_x, view.clip_w, at.x, at.w);
    hdrp_v3 y = hdrp_i_shadow_gradient(view.clip_y, view.clip_w, at.y, at.w);
    hdrp_v3 z = hdrp_i_shadow_gradient(view.clip_z, view.clip_w, at.z, at.w);
    float below = hdrp_v3_dot(normal, hdrp_v3_cross(x, y));
    float gx = hdrp_v3_dot(normal, hdrp_v3_cross(z, y)) / (below * view.place.x);
    float gy = hdrp_v3_dot(normal, hdrp_v3_cross(x, z)) / (below * view.place.y);
    float steep = hdrp_sqrt(gx * gx + gy * gy);
    float scale = most / hdrp_max(steep, most);
    float usable = steep < 1e18f && most > 0.0f && most < 1e18f ? 1.0f : 0.0f;
    return hdrp_v2_make(usable > 0.0f ? gx * scale : 0.0f, usable > 0.0f ? gy * scale : 0.0f);
}

/** Where a position is in a map, after its bias.
 *  view      valid
 *  position  [-1e18,1e18]  m
 *  normal    unit          of the surface, on the side that is lit
 *  returns   valid
 *  edges     not in the map: behind the light, or outside of the square
 *  error     none: a projection, whose rounding the bias allows for
 *  source    Holbert 2011, "Saying Goodbye to Shadow Acne"; Isidoro 2006, "Shadow Mapping:
 *            GPU-based Tips and Techniques", slides on receiver plane depth bias */
HDRP_FN hdrp_shadow_receiver hdrp_shadow_receiver_make(hdrp_shadow_view view, hdrp_v3 position,
                                                       hdrp_v3 normal)
{
    hdrp_shadow_receiver r;
    float cosine = hdrp_v3_dot(normal, hdrp_v3_from_v4(view.axis_texel));
    float depth = hdrp_v4_dot(view.clip_w, hdrp_v4_from_v3(position, 1.0f));
    float texel = view.axis_texel.w * hdrp_clamp(depth, 0.0f, 1e18f);
    float incidence = hdrp_v3_dot(normal, hdrp_i_shadow_to_light(view, position));
    float offset = hdrp_shadow_offset_texels(view, cosine, incidence);
    hdrp_v3 moved = hdrp_v3_mad(position, normal, offset * texel);
    hdrp_v4 p = hdrp_v4_from_v3(moved, 1.0f);
    float w = hdrp_v4_dot(view.clip_w, p);
    float inv_w = 1.0f / hdrp_max(w, 1e-9f);
    float x = hdrp_v4_dot(view.clip_x, p) * inv_w;
    float y = hdrp_v4_dot(view.clip_y, p) * inv_w;
    float z = hdrp_v4_dot(view.clip_z, p) * inv_w;
    float inside = w > 1e-9f && hdrp_abs(x) < 1.0f && hdrp_abs(y) < 1.0f ? 1.0f : 0.0f;
    hdrp_v2 slope = hdrp_v2_make(0.0f, 0.0f);
    x = hdrp_clamp(x, -1.0f, 1.0f);
    y = hdrp_clamp(y, -1.0f, 1.0f);
    z = hdrp_saturate(z);
    if (view.bias.z > 0.0f) {
        /* By how much depth changes in a texel of a surface as steep as may be. */
        hdrp_v3 g = hdrp_i_shadow_gradient(view.clip_z, view.clip_w, z, inv_w);
        slope = hdrp_i_shadow_plane(view, hdrp_v4_make(x, y, z, inv_w), normal,
                                    view.bias.z * texel * hdrp_v3_length(g));
    }
    r.place =
        hdrp_v4_make(x * view.place.x + view.place.z, y * view.place.y + view.place.w, z, inside);
    r.plane = hdrp_v4_make(slope.x, slope.y, 0.0f, 0.0f);
    return r;
}

/** Whether a texel of a map leaves a receiver lit.
 *  view      valid
 *  receiver  valid
 *  texel     [-1e5,1e5]  x, y of its centre
 *  depth     any         device depth that it holds
 *  returns   [0,1]       1: lit
 *  edges     NaN shadows nothing, and neither does what is nearer to the light by at most 1.5
 *            settings.depth_step, or 2^-20 where that is more
 *  error     none: a comparison
 *  source    Williams 1978, "Casting Curved Shadows on Curved Surfaces" */
HDRP_FN float hdrp_shadow_lit(hdrp_shadow_view view, hdrp_shadow_receiver receiver, hdrp_v2 texel,
                              float depth)
{
    float along = receiver.plane.x * (texel.x - receiver.place.x) +
                  receiver.plane.y * (texel.y - receiver.place.y);
    float z = hdrp_saturate(receiver.place.z + along);
    return (z - depth) * view.bias.w > view.bias.y ? 0.0f : 1.0f;
}

/** Share of a cascade in a blend with the next one: 1 inside its ball, and fading towards its rim.
 *  view      valid  from hdrp_shadow_view_ball
 *  position  any    m
 *  returns   [0,1]
 *  edges     0 outside; NaN gives 0
 *  error     none: a definition
 *  source    a definition
 *  note      from the first cascade on each takes its share of what is left, and what the last one
 *            leaves is lit: continuous wherever the camera is */
HDRP_FN float hdrp_shadow_cascade_weight(hdrp_shadow_view view, hdrp_v3 position)
{
    hdrp_v3 d = hdrp_v3_sub(position, hdrp_v3_from_v4(view.ball));
    return hdrp_saturate((view.ball.w - hdrp_v3_dot(d, d)) * view.fade.x);
}

/* >>maps */
#ifndef HDRP_GPU
#ifdef __cplusplus
extern "C" {
#endif

/* Device depths of an atlas. */
typedef struct hdrp_shadow_atlas {
    const float* depths; /* row by row, from the top */
    uint32_t width_px, height_px;
    uint32_t stride; /* floats from row to row; 0: width_px */
} hdrp_shadow_atlas;

/** Share of a light that reaches a position, by one map.
 *  atlas     the caller's, with casters drawn
 *  view      of the map
 *  position  m
 *  normal    unit, of the surface
 *  returns   [0,1]  1: all of it; also where the position is outside of the map
 *  edges     texels outside of the atlas are lit */
HDRP_API float hdrp_shadow_visibility(const hdrp_shadow_atlas* atlas, const hdrp_shadow_view* view,
                                      hdrp_v3 position, hdrp_v3 normal);

/** Share of a directional light that reaches a position, by its cascades.
 *  atlas     the caller's, with casters drawn
 *  views     of the cascades, from the finest to the coarsest
 *  count     any  of them; 0: lit
 *  position  m
 *  normal    unit, of the surface
 *  returns   [0,1]  1: all of it; also where no cascade reaches
 *  edges     as hdrp_shadow_visibility */
HDRP_API float hdrp_shadow_cascades_visibility(const hdrp_shadow_atlas* atlas,
                                               const hdrp_shadow_view* views, uint32_t count,
                                               hdrp_v3 position, hdrp_v3 normal);

/* What cascades are made for. */
typedef struct hdrp_shadow_cascades {
    hdrp_v3 eye;          /* m, of the camera, in the frame in which positions are looked up */
    hdrp_v3 view_forward; /* any length; without a direction it is -Z */
    hdrp_v2 extent;       /* x, y tangents of the farthest edges of the picture; orthographic: m */
    uint32_t orthographic;
    float near_m, far_m; /* at far_m shadows end, however far the camera sees */
    float log_weight;    /* [0,1] as for hdrp_shadow_split */
    hdrp_v3 forward;     /* direction of travel of the light */
    float caster_m;      /* as for hdrp_shadow_view_ball, in front of the nearest of the balls */
    uint32_t count;      /* [1,HDRP_SHADOW_CASCADES_MAX] */
    hdrp_u32x4 maps[HDRP_SHADOW_CASCADES_MAX]; /* squares of the atlas */
    hdrp_shadow_settings settings;
} hdrp_shadow_cascades;

/** The views of the cascades of a directional light.
 *  desc     the camera, the light and the squares
 *  views    result; desc->count of them
 *  returns  HDRP_OK, or an error, with views untouched
 *  errors   HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a count or depths out of their
 *           ranges */
HDRP_API hdrp_result hdrp_shadow_make_cascades(const hdrp_shadow_cascades* desc,
                                               hdrp_shadow_view* views);

/* >>atlas
 * Squares of powers of 2 in a square atlas of a power of 2, without a gap between them. */

/* Maps of one light. */
typedef struct hdrp_shadow_request {
    float importance;   /* what keeps its size first; below 0 and NaN count as 0 */
    uint32_t size_px;   /* of each map that would be best: rounded down to a power of 2 */
    uint32_t maps;      /* [0,6] all of the same size */
    uint32_t placed_px; /* result: size that it got; 0: dropped */
    uint32_t first;     /* result: of its maps */
} hdrp_shadow_request;

typedef struct hdrp_shadow_place_stats {
    uint32_t placed, shrunk, dropped; /* requests: shrunk ones are among the placed */
    uint64_t used_px;                 /* texels */
} hdrp_shadow_place_stats;

/** Places maps in an atlas, the important ones in full size.
 *  atlas_px     [1,HDRP_SHADOW_SIZE_MAX]  side of the atlas, a power of 2
 *  smallest_px  [1,HDRP_SHADOW_SIZE_MAX]  to which maps may be shrunk, a power of 2
 *  requests     what to place, and where it went
 *  count        any  of them
 *  order        scratch of the caller for count numbers
 *  maps         result, for all maps of all requests, in their order: x first column, y first row,
 *               z size, w 0; all 0 for a request that was dropped
 *  stats        result; NULL: not wanted
 *  returns      HDRP_OK, or an error, with nothing changed
 *  errors       HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for sizes that are no powers of 2
 *               or out of their ranges and for more than 6 maps
 *  memory       all of it is the caller's
 *  note         where not all fits, maps are halved one after the other, from the least important
 *               on; when all have been, again. What does not fit at the smallest size is dropped,
 *               the least important first. Of the same importance the first counts more. Squares
 *               follow each other along a Z curve, the large ones first: they always fit */
HDRP_API hdrp_result hdrp_shadow_place(uint32_t atlas_px, uint32_t smallest_px,
                                       hdrp_shadow_request* requests, uint32_t count,
                                       uint32_t* order, hdrp_u32x4* maps,
                                       hdrp_shadow_place_stats* stats);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_SHADOW_H */

#if defined(HDRP_SHADOW_IMPLEMENTATION) && !defined(HDRP_SHADOW_IMPLEMENTED) && !defined(HDRP_GPU)
#define HDRP_SHADOW_IMPLEMENTED

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- lookup ---------------------------------------------------------------------------------- */

/* Weight of texel i of a filter. */
static float hdrp_i_shadow_weight(const hdrp_shadow_weights* w, uint32_t i)
{
    const hdrp_v3* side = (i & 1u) ? &w->odd : &w->even;
    return i < 2u ? side->x : i < 4u ? side->y : side->z;
}

/* Whether the texel of a map at a place leaves a receiver lit. */
static float hdrp_i_shadow_texel(const hdrp_shadow_atlas* atlas, const hdrp_shadow_view* view,
                                 const hdrp_shadow_receiver* receiver, float x, float y)
{
    float column = hdrp_clamp(x, view->limits.x, view->limits.z);
    float row = hdrp_clamp(y, view->limits.y, view->limits.w);
    size_t stride = atlas->stride ? atlas->stride : atlas->width_px;
    if (column >= (float)atlas->width_px || row >= (float)atlas->height_px) {
        return 1.0f;
    }
    return hdrp_shadow_lit(*view, *receiver, hdrp_v2_make(column + 0.5f, row + 0.5f),
                           atlas->depths[(size_t)row * stride + (size_t)column]);
}

HDRP_API float hdrp_shadow_visibility(const hdrp_shadow_atlas* atlas, const hdrp_shadow_view* view,
                                      hdrp_v3 position, hdrp_v3 normal)
{
    hdrp_shadow_receiver r = hdrp_shadow_receiver_make(*view, position, normal);
    hdrp_u32 kind = hdrp_u32_from_f32(view->fade.y);
    uint32_t i, k, side = kind < 2u ? 2u : 2u * kind;
    float x = hdrp_floor(r.place.x - 0.5f);
    float y = hdrp_floor(r.place.y - 0.5f);
    hdrp_shadow_weights wx = hdrp_shadow_weights_make(kind, r.place.x - 0.5f - x);
    hdrp_shadow_weights wy = hdrp_shadow_weights_make(kind, r.place.y - 0.5f - y);
    float sum = 0.0f;
    if (!(r.place.w > 0.0f)) {
        return 1.0f;
    }
    for (k = 0u; k < side; ++k) {
        for (i = 0u; i < side; ++i) {
            float w = hdrp_i_shadow_weight(&wx, i) * hdrp_i_shadow_weight(&wy, k);
            sum += w * hdrp_i_shadow_texel(atlas, view, &r, x + wx.base + (float)i,
                                           y + wy.base + (float)k);
        }
    }
    return hdrp_saturate(sum);
}

HDRP_API float hdrp_shadow_cascades_visibility(const hdrp_shadow_atlas* atlas,
                                               const hdrp_shadow_view* views, uint32_t count,
                                               hdrp_v3 position, hdrp_v3 normal)
{
    float left = 1.0f, sum = 0.0f;
    uint32_t i;
    for (i = 0u; i < count && left > 0.0f; ++i) {
        float w = hdrp_shadow_cascade_weight(views[i], position);
        if (w > 0.0f) {
            sum += left * w * hdrp_shadow_visibility(atlas, &views[i], position, normal);
            left *= 1.0f - w;
        }
    }
    return hdrp_saturate(sum + left);
}

/* ---- cascades -------------------------------------------------------------------------------- */

HDRP_API hdrp_result hdrp_shadow_make_cascades(const hdrp_shadow_cascades* desc,
                                               hdrp_shadow_view* views)
{
    hdrp_v3 forward;
    float begin, total;
    uint32_t i;
    if (!desc || !views) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (desc->count - 1u >= HDRP_SHADOW_CASCADES_MAX || !(desc->near_m >= 0.0f) ||
        !(desc->far_m > desc->near_m) || !(desc->far_m <= 1e9f)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    forward = hdrp_normalize_or(desc->view_forward, hdrp_v3_make(0.0f, 0.0f, -1.0f));
    total = (float)desc->count;
    begin = desc->near_m;
    for (i = 0u; i < desc->count; ++i) {
        float end = hdrp_shadow_split(hdrp_max(desc->near_m, 1e-6f), desc->far_m,
                                      (float)(i + 1u) / total, hdrp_saturate(desc->log_weight));
        hdrp_v2 b = desc->orthographic
                        ? hdrp_shadow_slice_orthographic(begin, end, desc->extent.x, desc->extent.y)
                        : hdrp_shadow_slice_perspective(begin, end, desc->extent.x, desc->extent.y);
        hdrp_v3 center = hdrp_v3_mad(desc->eye, forward, b.x);
        /* What fades, at the rim, is outside of the part. */
        float radius = b.y / (1.0f - hdrp_clamp(desc->settings.band, 1e-4f, 0.5f));
        views[i] = hdrp_shadow_view_ball(hdrp_v4_from_v3(center, radius), desc->forward,
                                         desc->caster_m + radius, desc->maps[i], desc->settings);
        begin = end;
    }
    return HDRP_OK;
}

/* ---- atlas ----------------------------------------------------------------------------------- */

static int hdrp_i_shadow_power_of_2(uint32_t x)
{
    return x - 1u < HDRP_SHADOW_SIZE_MAX && (x & (x - 1u)) == 0u;
}

/* Whether request a counts less than request b: the smaller size where sizes count, then less
 * importance, then the later one. */
static int hdrp_i_shadow_after(const hdrp_shadow_request* requests, uint32_t a, uint32_t b,
                               int by_size)
{
    float x = hdrp_clamp(requests[a].importance, 0.0f, HDRP_FLT_MAX);
    float y = hdrp_clamp(requests[b].importance, 0.0f, HDRP_FLT_MAX);
    if (by_size && requests[a].placed_px != requests[b].placed_px) {
        return requests[a].placed_px < requests[b].placed_px;
    }
    return x < y || (!(x > y) && a > b);
}

/* Moves what is out of order in a heap down; its top counts least. */
static void hdrp_i_shadow_sift(const hdrp_shadow_request* requests, uint32_t* order, uint32_t at,
                               uint32_t count, int by_size)
{
    for (;;) {
        uint32_t child = 2u * at + 1u, moved = order[at];
        if (child >= count) {
            return;
        }
        if (child + 1u < count &&
            hdrp_i_shadow_after(requests, order[child + 1u], order[child], by_size)) {
            ++child;
        }
        if (!hdrp_i_shadow_after(requests, order[child], moved, by_size)) {
            return;
        }
        order[at] = order[child];
        order[child] = moved;
        at = child;
    }
}

/* Sorts: what counts most comes first. A heap, as it needs no more memory. */
static void hdrp_i_shadow_sort(const hdrp_shadow_request* requests, uint32_t* order, uint32_t count,
                               int by_size)
{
    uint32_t i, last;
    for (i = count / 2u; i-- > 0u;) {
        hdrp_i_shadow_sift(requests, order, i, count, by_size);
    }
    for (i = count; i-- > 1u;) {
        last = order[i];
        order[i] = order[0];
        order[0] = last;
        hdrp_i_shadow_sift(requests, order, 0u, i, by_size);
    }
}

static uint64_t hdrp_i_shadow_area(const hdrp_shadow_request* r)
{
    return (uint64_t)r->placed_px * r->placed_px * r->maps;
}

/* Halves and drops, from the least important on, until what is left fits. */
static void hdrp_i_shadow_shrink(hdrp_shadow_request* requests, const uint32_t* order,
                                 uint32_t count, uint32_t smallest_px, uint64_t room)
{
    uint64_t total = 0u;
    uint32_t i;
    int halved = 1;
    for (i = 0u; i < count; ++i) {
        total += hdrp_i_shadow_area(&requests[i]);
    }
    while (total > room && halved) {
        halved = 0;
        for (i = count; i-- > 0u && total > room;) {
            hdrp_shadow_request* r = &requests[order[i]];
            if (r->placed_px > smallest_px) {
                total -= hdrp_i_shadow_area(r);
                r->placed_px /= 2u;
                total += hdrp_i_shadow_area(r);
                halved = 1;
            }
        }
    }
    for (i = count; i-- > 0u && total > room;) {
        total -= hdrp_i_shadow_area(&requests[order[i]]);
        requests[order[i]].placed_px = 0u;
    }
}

/* Every second bit, from bit 0 on, of a place along a Z curve. */
static uint32_t hdrp_i_shadow_even_bits(uint64_t place)
{
    uint32_t i, r = 0u;
    for (i = 0u; i < 16u; ++i) {
        r |= (uint32_t)(place >> (2u * i) & 1u) << i;
    }
    return r;
}

static uint32_t hdrp_i_shadow_size(const hdrp_shadow_request* r, uint32_t atlas_px,
                                   uint32_t smallest_px)
{
    uint32_t size = smallest_px;
    while (size < atlas_px && size <= r->size_px / 2u) {
        size *= 2u;
    }
    return r->maps == 0u || r->size_px == 0u ? 0u : size;
}

HDRP_API hdrp_result hdrp_shadow_place(uint32_t atlas_px, uint32_t smallest_px,
                                       hdrp_shadow_request* requests, uint32_t count,
                                       uint32_t* order, hdrp_u32x4* maps,
                                       hdrp_shadow_place_stats* stats)
{
    hdrp_shadow_place_stats s = {0u, 0u, 0u, 0u};
    uint64_t used = 0u;
    uint32_t i, k, first = 0u;
    if ((!requests || !order || !maps) && count > 0u) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (!hdrp_i_shadow_power_of_2(atlas_px) || !hdrp_i_shadow_power_of_2(smallest_px) ||
        smallest_px > atlas_px) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (i = 0u; i < count; ++i) {
        if (requests[i].maps > 6u) {
            return HDRP_ERROR_BAD_ARGUMENT;
        }
    }
    for (i = 0u; i < count; ++i) {
        order[i] = i;
        requests[i].placed_px = hdrp_i_shadow_size(&requests[i], atlas_px, smallest_px);
        requests[i].first = first;
        first += requests[i].maps;
    }
    hdrp_i_shadow_sort(requests, order, count, 0);
    hdrp_i_shadow_shrink(requests, order, count, smallest_px, (uint64_t)atlas_px * atlas_px);
    hdrp_i_shadow_sort(requests, order, count, 1);
    for (i = 0u; i < count; ++i) {
        const hdrp_shadow_request* r = &requests[order[i]];
        uint32_t best = hdrp_i_shadow_size(r, atlas_px, smallest_px);
        for (k = 0u; k < r->maps; ++k) {
            maps[r->first + k] = hdrp_u32x4_make(
                r->placed_px ? hdrp_i_shadow_even_bits(used) : 0u,
                r->placed_px ? hdrp_i_shadow_even_bits(used >> 1) : 0u, r->placed_px, 0u);
            used += (uint64_t)r->placed_px * r->placed_px;
        }
        s.placed += r->placed_px > 0u ? 1u : 0u;
        s.shrunk += r->placed_px > 0u && r->placed_px < best ? 1u : 0u;
        s.dropped += best > 0u && r->placed_px == 0u ? 1u : 0u;
    }
    s.used_px = used;
    if (stats) {
        *stats = s;
    }
    return HDRP_OK;
}

#ifdef __cplusplus
}
#endif

#endif /* HDRP_SHADOW_IMPLEMENTATION */
