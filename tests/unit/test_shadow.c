/* test_shadow.c - cascades, bias, filters and the atlas of hdrp_shadow.h.
 * SPDX-License-Identifier: MIT */
#define HDRP_SHADOW_IMPLEMENTATION
#include "shadow_test.h"

#define ATLAS 256

static float texels[ATLAS * ATLAS];
static const hdrp_shadow_atlas atlas = {texels, ATLAS, ATLAS, 0};

static void draw(const hdrp_shadow_view* v, const scene* s)
{
    scene_draw(v, s, texels, ATLAS);
}

/* ---- cascades -------------------------------------------------------------------------------- */

static void splits_meet_the_ends_and_rise(void** state)
{
    (void)state;
    for (float weight = 0.0f; weight <= 1.0f; weight += 0.25f) {
        float last = hdrp_shadow_split(0.1f, 200.0f, 0.0f, weight);
        assert_true(fabsf(last - 0.1f) < 1e-6f);
        for (int i = 1; i <= 4; ++i) {
            float z = hdrp_shadow_split(0.1f, 200.0f, (float)i / 4.0f, weight);
            assert_true(z > last);
            last = z;
        }
        assert_true(last == 200.0f);
    }
    assert_true(fabsf(hdrp_shadow_split(1.0f, 100.0f, 0.5f, 1.0f) - 10.0f) < 1e-4f);
    assert_true(fabsf(hdrp_shadow_split(1.0f, 101.0f, 0.5f, 0.0f) - 51.0f) < 1e-4f);
    assert_true(hdrp_shadow_split(2.0f, 1.0f, 0.5f, 0.5f) == 2.0f);
}

static void balls_hold_the_corners_of_their_part(void** state)
{
    (void)state;
    for (int i = 0; i < 10000; ++i) {
        float n = uniform(0.01f, 10.0f), f = n + uniform(0.0f, 100.0f);
        float x = uniform(0.0f, 2.0f), y = uniform(0.0f, 2.0f);
        hdrp_v2 b = hdrp_shadow_slice_perspective(n, f, x, y);
        float to_far = hdrp_v3_length(v3(x * f, y * f, f - b.x));
        float to_near = hdrp_v3_length(v3(x * n, y * n, n - b.x));
        assert_true(to_far <= b.y && to_near <= b.y);
        b = hdrp_shadow_slice_orthographic(n, f, x, y);
        assert_true(hdrp_v3_length(v3(x, y, f - b.x)) <= b.y);
    }
}

static void depths_choose_their_part_and_blend(void** state)
{
    hdrp_v4 ends = hdrp_v4_make(1.0f, 3.0f, 9.0f, 27.0f);
    (void)state;
    assert_int_equal(hdrp_shadow_cascade_of_depth(ends, 0.5f), 0);
    assert_int_equal(hdrp_shadow_cascade_of_depth(ends, 1.0f), 1);
    assert_int_equal(hdrp_shadow_cascade_of_depth(ends, 26.0f), 3);
    assert_int_equal(hdrp_shadow_cascade_of_depth(ends, 1e18f), 4);
    assert_int_equal(hdrp_shadow_cascade_of_depth(ends, (float)NAN), 0);
    assert_true(hdrp_shadow_depth_weight(10.0f, 0.2f, 8.0f) == 1.0f);
    assert_true(fabsf(hdrp_shadow_depth_weight(10.0f, 0.2f, 9.0f) - 0.5f) < 1e-5f);
    assert_true(hdrp_shadow_depth_weight(10.0f, 0.2f, 10.0f) == 0.0f);
    assert_true(hdrp_shadow_depth_weight(10.0f, 0.0f, 9.9f) == 1.0f);
}

static hdrp_shadow_cascades four_cascades(hdrp_v3 eye, hdrp_v3 forward)
{
    hdrp_shadow_cascades d;
    memset(&d, 0, sizeof d);
    d.eye = eye;
    d.view_forward = forward;
    d.extent = hdrp_v2_make(0.8f, 0.45f);
    d.near_m = 0.1f;
    d.far_m = 100.0f;
    d.log_weight = 0.8f;
    d.forward = v3(0.3f, -1.0f, 0.2f);
    d.caster_m = 50.0f;
    d.count = 4;
    for (uint32_t i = 0; i < 4; ++i) {
        d.maps[i] = square(i % 2 * 128, i / 2 * 128, 128);
    }
    d.settings = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 1);
    return d;
}

/* What the camera sees up to far_m is in a cascade, and inside the border of its map. */
static void cascades_hold_what_the_camera_sees(void** state)
{
    (void)state;
    for (int i = 0; i < 200; ++i) {
        hdrp_v3 eye = v3(uniform(-50.0f, 50.0f), uniform(-5.0f, 5.0f), uniform(-50.0f, 50.0f));
        hdrp_v3 f = direction();
        hdrp_basis frame = hdrp_basis_from_normal(f);
        hdrp_shadow_cascades desc = four_cascades(eye, f);
        hdrp_shadow_view views[4];
        float border = (float)hdrp_shadow_border_px(HDRP_SHADOW_FILTER_TENT_3);
        desc.orthographic = (uint32_t)(i & 1);
        if (desc.orthographic) {
            desc.extent = hdrp_v2_make(20.0f, 10.0f);
            desc.near_m = 0.0f;
        }
        assert_int_equal(hdrp_shadow_make_cascades(&desc, views), HDRP_OK);
        for (int k = 0; k < 200; ++k) {
            float z = uniform(desc.near_m, 99.99f), spread = desc.orthographic ? 1.0f : z;
            float left = 1.0f;
            /* The picture may be turned around the axis: the corners are the farthest. */
            hdrp_v3 p = hdrp_v3_mad(eye, f, z);
            p = hdrp_v3_mad(p, frame.tangent, desc.extent.x * spread * uniform(-1.0f, 1.0f));
            p = hdrp_v3_mad(p, frame.bitangent, desc.extent.y * spread * uniform(-1.0f, 1.0f));
            for (int c = 0; c < 4; ++c) {
                float w = hdrp_shadow_cascade_weight(views[c], p);
                left *= 1.0f - w;
                if (w > 0.0f) {
                    hdrp_shadow_receiver r = hdrp_shadow_receiver_make(
                        views[c], p, hdrp_v3_from_v4(views[c].axis_texel));
                    assert_true(r.place.w == 1.0f);
                    assert_true(r.place.x >= views[c].limits.x + border - 0.3f &&
                                r.place.x <= views[c].limits.z + 1.3f - border);
                    assert_true(r.place.y >= views[c].limits.y + border - 0.3f &&
                                r.place.y <= views[c].limits.w + 1.3f - border);
                    assert_true(r.place.z > 0.0f && r.place.z < 1.0f);
                }
            }
            assert_true(left < 1e-3f);
        }
    }
}

/* A position stays where it is in its texel, whatever the camera does. */
static void cascades_do_not_shimmer(void** state)
{
    hdrp_v3 n = v3(0.0f, 1.0f, 0.0f);
    hdrp_shadow_view first[4], views[4];
    hdrp_shadow_cascades desc = four_cascades(v3(0.0f, 2.0f, 0.0f), v3(0.0f, 0.0f, -1.0f));
    (void)state;
    assert_int_equal(hdrp_shadow_make_cascades(&desc, first), HDRP_OK);
    for (int i = 0; i < 500; ++i) {
        desc = four_cascades(v3(uniform(-4.0f, 4.0f), 2.0f, uniform(-4.0f, 4.0f)), direction());
        assert_int_equal(hdrp_shadow_make_cascades(&desc, views), HDRP_OK);
        for (int c = 0; c < 4; ++c) {
            hdrp_v3 p = v3(0.3f, 0.0f, -0.7f);
            hdrp_shadow_receiver a = hdrp_shadow_receiver_make(first[c], p, n);
            hdrp_shadow_receiver b = hdrp_shadow_receiver_make(views[c], p, n);
            assert_true(views[c].axis_texel.w == first[c].axis_texel.w);
            if (a.place.w > 0.0f && b.place.w > 0.0f) {
                float x = a.place.x - b.place.x, y = a.place.y - b.place.y;
                assert_true(fabsf(x - floorf(x + 0.5f)) < 0.01f);
                assert_true(fabsf(y - floorf(y + 0.5f)) < 0.01f);
            }
        }
    }
}

static void cascades_that_are_none_are_refused(void** state)
{
    hdrp_shadow_view views[4];
    hdrp_shadow_cascades good = four_cascades(v3(0.0f, 0.0f, 0.0f), v3(0.0f, 0.0f, -1.0f)), bad;
    (void)state;
    assert_int_equal(hdrp_shadow_make_cascades(NULL, views), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_shadow_make_cascades(&good, NULL), HDRP_ERROR_NULL_POINTER);
    bad = good;
    bad.count = 0;
    assert_int_equal(hdrp_shadow_make_cascades(&bad, views), HDRP_ERROR_BAD_ARGUMENT);
    bad.count = 5;
    assert_int_equal(hdrp_shadow_make_cascades(&bad, views), HDRP_ERROR_BAD_ARGUMENT);
    bad = good;
    bad.far_m = HDRP_DEPTH_INFINITE;
    assert_int_equal(hdrp_shadow_make_cascades(&bad, views), HDRP_ERROR_BAD_ARGUMENT);
    bad.far_m = bad.near_m;
    assert_int_equal(hdrp_shadow_make_cascades(&bad, views), HDRP_ERROR_BAD_ARGUMENT);
    bad = good;
    bad.near_m = (float)NAN;
    assert_int_equal(hdrp_shadow_make_cascades(&bad, views), HDRP_ERROR_BAD_ARGUMENT);
}

/* ---- filters --------------------------------------------------------------------------------- */

static void weights_of(hdrp_u32 kind, float f, double out[6])
{
    hdrp_shadow_weights w = hdrp_shadow_weights_make(kind, f);
    const float all[6] = {w.even.x, w.odd.x, w.even.y, w.odd.y, w.even.z, w.odd.z};
    for (int i = 0; i < 6; ++i) {
        out[i] = (double)all[i];
    }
}

static void weights_sum_to_one(void** state)
{
    (void)state;
    for (hdrp_u32 kind = 0; kind < 4; ++kind) {
        for (int i = 0; i <= 1000; ++i) {
            double w[6], sum = 0.0, mean = 0.0;
            float f = (float)i / 1000.0f;
            hdrp_shadow_weights s = hdrp_shadow_weights_make(kind, f);
            weights_of(kind, f, w);
            for (int k = 0; k < 6; ++k) {
                assert_true(w[k] >= 0.0);
                sum += w[k];
                mean += w[k] * ((double)s.base + k);
            }
            assert_true(fabs(sum - 1.0) < 3e-7);
            /* The mean place is that of the position, but for what texels are too wide for. */
            assert_true(kind == 0 || fabs(mean - (double)f) < (kind == 1 ? 1e-6 : 0.05));
        }
    }
}

/* Visibility of a straight edge, at which texels begin to be lit, as the position moves over it. */
static double ramp(hdrp_u32 kind, double x)
{
    double at = x - 0.5, before = floor(at), w[6], sum = 0.0;
    float base = hdrp_shadow_weights_make(kind, (float)(at - before)).base;
    weights_of(kind, (float)(at - before), w);
    for (int k = 0; k < 6; ++k) {
        sum += before + (double)base + k >= 0.0 ? w[k] : 0.0;
    }
    return sum;
}

static void an_edge_is_a_ramp_of_the_width_of_the_filter(void** state)
{
    (void)state;
    for (int i = -4000; i <= 4000; ++i) {
        double x = i / 1000.0, h = 0.0, t;
        assert_true(fabs(ramp(HDRP_SHADOW_FILTER_HARD, x) - (x >= 0.0 ? 1.0 : 0.0)) < 1e-6 ||
                    fabs(x) < 1e-6);
        t = x + 0.5;
        t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
        assert_true(fabs(ramp(HDRP_SHADOW_FILTER_BILINEAR, x) - t) < 1e-6);
        for (hdrp_u32 kind = 2; kind < 4; ++kind) {
            h = (double)kind - 0.5;
            t = x < -h    ? 0.0
                : x > h   ? 1.0
                : x < 0.0 ? (x + h) * (x + h) / (2.0 * h * h)
                          : 1.0 - (h - x) * (h - x) / (2.0 * h * h);
            assert_true(fabs(ramp(kind, x) - t) < 1e-6);
        }
    }
}

static void taps_are_pairs_of_texels(void** state)
{
    (void)state;
    for (hdrp_u32 kind = 1; kind < 4; ++kind) {
        for (int i = 0; i <= 100; ++i) {
            hdrp_shadow_weights w = hdrp_shadow_weights_make(kind, (float)i / 100.0f);
            hdrp_shadow_taps t = hdrp_shadow_taps_make(w);
            const float weight[3] = {t.weight.x, t.weight.y, t.weight.z};
            const float place[3] = {t.place.x, t.place.y, t.place.z};
            const float odd[3] = {w.odd.x, w.odd.y, w.odd.z};
            for (hdrp_u32 k = 0; k < kind; ++k) {
                float first = w.base + 2.0f * (float)k;
                assert_true(place[k] >= first && place[k] <= first + 1.0f);
                assert_true(fabsf(weight[k] * (place[k] - first) - odd[k]) < 1e-6f);
            }
        }
    }
}

static void radii_and_borders_are_those_of_the_filters(void** state)
{
    (void)state;
    for (hdrp_u32 kind = 0; kind < 5; ++kind) {
        float r = hdrp_shadow_filter_radius(kind);
        assert_true((float)hdrp_shadow_border_px(kind) >= r * (1.0f + 1.05f * HDRP_SQRT_2));
        assert_true((float)hdrp_shadow_border_px(kind) < r * (1.0f + 1.05f * HDRP_SQRT_2) + 1.0f);
    }
    assert_true(hdrp_shadow_filter_radius(0) == 0.5f && hdrp_shadow_filter_radius(9) == 3.0f);
    assert_int_equal(hdrp_shadow_settings_make(9, 7).filter_kind, 3);
    assert_int_equal(hdrp_shadow_settings_make(9, 7).reverse, 1);
}

/* ---- bias ------------------------------------------------------------------------------------ */

static hdrp_shadow_settings settings_of(int i)
{
    hdrp_shadow_settings s = hdrp_shadow_settings_make((hdrp_u32)(i & 3), (hdrp_u32)(i >> 2 & 1));
    s.slope_max = (i >> 3 & 1) ? 2.0f : 0.0f;
    s.depth_step = (i >> 4 & 1) ? 1.0f / 65535.0f : 0.0f;
    return s;
}

/* What a format of 16 bits keeps. */
static void round_texels(float step)
{
    for (size_t i = 0; step > 0.0f && i < sizeof texels / sizeof texels[0]; ++i) {
        texels[i] = floorf(texels[i] / step + 0.5f) * step;
    }
}

/* A plane that faces the light, by a cosine. */
static hdrp_v3 tilted(hdrp_v3 axis, float cosine)
{
    hdrp_basis b = hdrp_basis_from_normal(axis);
    float turn = uniform(0.0f, 6.2f), sine = sqrtf(1.0f - cosine * cosine);
    hdrp_v3 n = hdrp_v3_scale(axis, cosine);
    n = hdrp_v3_mad(n, b.tangent, sine * cosf(turn));
    return hdrp_v3_mad(n, b.bitangent, sine * sinf(turn));
}

/* The normal, off by as much as the contract allows: 1.2 degrees. */
static hdrp_v3 shaken(hdrp_v3 n)
{
    return hdrp_v3_normalize(hdrp_v3_mad(n, tilted(n, 0.0f), 0.0209f));
}

static void planes_in_parallel_light_have_no_acne(void** state)
{
    (void)state;
    for (int i = 0; i < 320; ++i) {
        hdrp_shadow_settings s = settings_of(i);
        hdrp_v3 light = direction();
        float cosine = i % 5 == 0 ? uniform(0.001f, 0.05f) : uniform(0.02f, 1.0f);
        hdrp_shadow_view v = hdrp_shadow_view_ball(
            hdrp_v4_make(uniform(-20.0f, 20.0f), 1.0f, uniform(-20.0f, 20.0f), 10.0f),
            hdrp_v3_neg(light), 60.0f, square(64, 0, 128), s);
        scene plane = {tilted(light, cosine), 0.0f, {0.0f, 0.0f, 0.0f}, 0.0f};
        hdrp_basis b = hdrp_basis_from_normal(plane.n);
        hdrp_v3 center = hdrp_v3_from_v4(v.ball);
        plane.distance = hdrp_v3_dot(plane.n, center);
        draw(&v, &plane);
        round_texels(s.depth_step);
        for (int k = 0; k < 200; ++k) {
            hdrp_v3 p = hdrp_v3_mad(center, b.tangent, uniform(-6.0f, 6.0f));
            float seen;
            p = hdrp_v3_mad(p, b.bitangent, uniform(-6.0f, 6.0f));
            seen = hdrp_shadow_visibility(&atlas, &v, p, shaken(plane.n));
            if (!(seen > 0.999999f)) {
                fail_msg("visibility %g, filter %u, slope %g, cosine %g", (double)seen,
                         s.filter_kind, (double)s.slope_max, (double)cosine);
            }
        }
    }
}

static void planes_in_light_from_a_point_have_no_acne(void** state)
{
    (void)state;
    for (int i = 0; i < 320; ++i) {
        hdrp_shadow_settings s = settings_of(i);
        hdrp_v3 light = direction();
        float cosine = i % 5 == 0 ? uniform(0.01f, 0.1f) : uniform(0.05f, 1.0f);
        hdrp_shadow_view v = hdrp_shadow_view_perspective(
            hdrp_v3_scale(light, 8.0f), hdrp_v3_neg(light), v3(0.0f, 1.0f, 0.0f),
            hdrp_v4_make(1.0f, 0.7f, 0.2f, 40.0f), square(0, 64, 128), s);
        scene plane = {tilted(light, cosine), 0.0f, {0.0f, 0.0f, 0.0f}, 0.0f};
        hdrp_basis b = hdrp_basis_from_normal(plane.n);
        draw(&v, &plane);
        round_texels(s.depth_step);
        for (int k = 0; k < 200; ++k) {
            hdrp_v3 p = hdrp_v3_scale(b.tangent, uniform(-6.0f, 6.0f));
            float seen;
            p = hdrp_v3_mad(p, b.bitangent, uniform(-6.0f, 6.0f));
            seen = hdrp_shadow_visibility(&atlas, &v, p, plane.n);
            if (!(seen > 0.999999f)) {
                fail_msg("visibility %g, filter %u, slope %g, cosine %g", (double)seen,
                         s.filter_kind, (double)s.slope_max, (double)cosine);
            }
        }
    }
}

/* The shadow of a ball is where rays say, but for the width of the filter and the offset. */
static void shadows_move_by_no_more_than_the_offset(void** state)
{
    (void)state;
    for (int i = 0; i < 64; ++i) {
        hdrp_shadow_settings s = settings_of(i);
        hdrp_v3 light = hdrp_v3_normalize(v3(0.4f, 1.0f, 0.3f));
        hdrp_shadow_view v = hdrp_shadow_view_ball(hdrp_v4_make(0.0f, 0.0f, 0.0f, 8.0f),
                                                   hdrp_v3_neg(light), 20.0f, square(0, 0, 256), s);
        scene ball = {{0.0f, 1.0f, 0.0f}, 0.0f, {0.0f, 3.0f, 0.0f}, 1.5f};
        hdrp_v3 n = v3(0.0f, 1.0f, 0.0f);
        float texel = v.axis_texel.w, shadowed = 0.0f;
        float away = texel * (1.5f * hdrp_shadow_filter_radius(s.filter_kind) + 1.0f);
        away += texel * 1.5f * hdrp_shadow_offset_texels(v, light.y, light.y);
        draw(&v, &ball);
        for (int k = 0; k < 2000; ++k) {
            hdrp_v3 p = v3(uniform(-5.0f, 4.0f), 0.0f, uniform(-5.0f, 4.0f));
            hdrp_v3 to = hdrp_v3_sub(ball.center, p);
            float along = hdrp_v3_dot(to, light);
            float miss = hdrp_v3_length(hdrp_v3_mad(to, light, -along)) - ball.radius;
            float seen = hdrp_shadow_visibility(&atlas, &v, p, n);
            if (fabsf(miss) > away) {
                assert_true(seen == (miss > 0.0f ? 1.0f : 0.0f) ||
                            fabsf(seen - (miss > 0.0f ? 1.0f : 0.0f)) < 1e-6f);
                shadowed += 1.0f - seen;
            }
        }
        assert_true(shadowed > 50.0f);
        assert_true(hdrp_shadow_offset_texels(v, 0.0f, 0.0f) <=
                    1.0501f * HDRP_SQRT_2 * hdrp_shadow_filter_radius(s.filter_kind));
        assert_true(hdrp_shadow_offset_texels(v, 1.0f, 1.0f) <=
                    0.0501f * HDRP_SQRT_2 * hdrp_shadow_filter_radius(s.filter_kind));
    }
}

/* Without the offset planes do have acne: the tests above can fail. */
static void planes_without_bias_have_acne(void** state)
{
    hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 1);
    hdrp_shadow_view v = hdrp_shadow_view_ball(hdrp_v4_make(0.0f, 0.0f, 0.0f, 8.0f),
                                               v3(-1.0f, -1.0f, 0.0f), 20.0f, square(0, 0, 128), s);
    scene plane = {{0.0f, 1.0f, 0.0f}, 0.0f, {0.0f, 0.0f, 0.0f}, 0.0f};
    float least = 1.0f;
    (void)state;
    draw(&v, &plane);
    v.bias.x = 0.0f;
    for (int k = 0; k < 200; ++k) {
        hdrp_v3 p = v3(uniform(-4.0f, 4.0f), 0.0f, uniform(-4.0f, 4.0f));
        least = hdrp_min(least, hdrp_shadow_visibility(&atlas, &v, p, plane.n));
    }
    assert_true(least < 0.7f);
}

/* ---- views ----------------------------------------------------------------------------------- */

static void faces_of_a_point_cover_all_directions(void** state)
{
    hdrp_light light = hdrp_light_point(v3(1.0f, 2.0f, 3.0f), v3(100.0f, 100.0f, 100.0f), 20.0f);
    hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_5, 1);
    (void)state;
    assert_int_equal(hdrp_shadow_map_count(light), 6);
    for (int i = 0; i < 20000; ++i) {
        hdrp_v3 d = direction();
        hdrp_u32 face = hdrp_shadow_face(d);
        hdrp_shadow_view v = hdrp_shadow_view_light(light, face, 0.05f, square(64, 64, 128), s);
        hdrp_v3 p = hdrp_v3_mad(v3(1.0f, 2.0f, 3.0f), d, uniform(0.1f, 19.0f));
        hdrp_shadow_receiver r = hdrp_shadow_receiver_make(v, p, hdrp_v3_neg(d));
        assert_true(hdrp_v3_dot(d, hdrp_shadow_face_axis(face)) >= 0.577f);
        assert_int_equal(hdrp_shadow_map_of_direction(v, d), face);
        assert_true(r.place.w == 1.0f);
        assert_true(r.place.x - 3.0f >= 64.0f && r.place.x + 3.0f <= 192.0f);
        assert_true(r.place.y - 3.0f >= 64.0f && r.place.y + 3.0f <= 192.0f);
    }
}

static void spots_and_boxes_see_what_they_light(void** state)
{
    hdrp_v3 white = v3(1.0f, 1.0f, 1.0f), none = v3(0.0f, 0.0f, 0.0f);
    hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 0);
    (void)state;
    assert_int_equal(hdrp_shadow_map_count(hdrp_light_directional(white, white, 0.0f)), 0);
    for (int i = 0; i < 2000; ++i) {
        hdrp_v3 f = direction();
        hdrp_light lights[3] = {
            hdrp_light_spot(none, f, white, 10.0f, 0.1f, uniform(0.2f, 1.3f)),
            hdrp_light_pyramid(none, f, direction(), white, 10.0f, 0.7f, 0.4f, 0.1f),
            hdrp_light_box(none, f, direction(), white, 2.0f, 1.0f, 10.0f, 0.1f)};
        for (int k = 0; k < 3; ++k) {
            hdrp_shadow_view v = hdrp_shadow_view_light(lights[k], 0, 0.01f, square(0, 0, 128), s);
            hdrp_v3 p = hdrp_v3_mad(hdrp_v3_scale(f, uniform(0.5f, 9.0f)), direction(), 4.0f);
            hdrp_light_incident lit = hdrp_light_eval(lights[k], p);
            hdrp_shadow_receiver r = hdrp_shadow_receiver_make(v, p, lit.l);
            assert_int_equal(hdrp_shadow_map_count(lights[k]), 1);
            assert_int_equal(hdrp_shadow_map_of_direction(v, f), 0);
            if (lit.illuminance.x > 0.0f) {
                assert_true(r.place.w == 1.0f);
                assert_true(r.place.x > 2.0f && r.place.x < 126.0f);
                assert_true(r.place.y > 2.0f && r.place.y < 126.0f);
                assert_true(r.place.z >= 0.0f && r.place.z <= 1.0f);
            }
        }
    }
    assert_int_equal(hdrp_shadow_map_count(hdrp_light_spot(none, white, white, 10.0f, 0.1f, 1.6f)),
                     6);
}

static void depths_compare_both_ways(void** state)
{
    (void)state;
    for (hdrp_u32 reverse = 0; reverse < 2; ++reverse) {
        hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_HARD, reverse);
        hdrp_shadow_view v = hdrp_shadow_view_ball(
            hdrp_v4_make(0.0f, 0.0f, 0.0f, 8.0f), v3(0.0f, -1.0f, 0.0f), 8.0f, square(0, 0, 64), s);
        hdrp_shadow_receiver r =
            hdrp_shadow_receiver_make(v, v3(0.0f, 0.0f, 0.0f), v3(0.0f, 1.0f, 0.0f));
        hdrp_v2 at = hdrp_v2_make(r.place.x, r.place.y);
        float nearer = reverse ? 0.6f : 0.4f, farther = reverse ? 0.4f : 0.6f;
        assert_true(fabsf(r.place.z - 0.5f) < 0.01f);
        assert_true(hdrp_shadow_lit(v, r, at, nearer) == 0.0f);
        assert_true(hdrp_shadow_lit(v, r, at, farther) == 1.0f);
        assert_true(hdrp_shadow_lit(v, r, at, r.place.z) == 1.0f);
        assert_true(hdrp_shadow_lit(v, r, at, reverse ? 0.0f : 1.0f) == 1.0f);
        assert_true(hdrp_shadow_lit(v, r, at, (float)NAN) == 1.0f);
    }
}

/* Cascades of a scene with a ball: continuous along lines, and lit beyond the last. */
static void cascades_blend_without_steps(void** state)
{
    hdrp_shadow_cascades desc = four_cascades(v3(0.0f, 2.0f, 0.0f), v3(0.0f, 0.0f, -1.0f));
    hdrp_shadow_view views[4];
    scene roof = {{0.0f, 1.0f, 0.0f}, 40.0f, {0.0f, 0.0f, 0.0f}, 0.0f};
    hdrp_v3 n = v3(0.0f, 1.0f, 0.0f);
    float last = 1.0f;
    (void)state;
    assert_int_equal(hdrp_shadow_make_cascades(&desc, views), HDRP_OK);
    for (int i = 0; i < 4; ++i) {
        draw(&views[i], &roof); /* all is in its shadow */
    }
    for (int i = -20000; i < 300000; ++i) {
        float seen = hdrp_shadow_cascades_visibility(&atlas, views, 4,
                                                     v3(0.0f, 0.0f, -(float)i * 0.001f), n);
        assert_true(fabsf(seen - last) < 0.02f);
        last = seen;
    }
    assert_true(last == 1.0f);
    assert_true(hdrp_shadow_cascades_visibility(&atlas, views, 4, v3(0.0f, 0.0f, -50.0f), n) ==
                0.0f);
    assert_true(hdrp_shadow_cascades_visibility(&atlas, views, 0, v3(0.0f, 0.0f, -50.0f), n) ==
                1.0f);
}

/* ---- atlas ----------------------------------------------------------------------------------- */

static void expect_apart(const hdrp_u32x4* maps, uint32_t count, uint32_t side)
{
    for (uint32_t i = 0; i < count; ++i) {
        assert_true(maps[i].x + maps[i].z <= side && maps[i].y + maps[i].z <= side);
        assert_true(maps[i].z == 0 || (maps[i].x % maps[i].z == 0 && maps[i].y % maps[i].z == 0));
        for (uint32_t k = i + 1; k < count; ++k) {
            bool apart = maps[i].x + maps[i].z <= maps[k].x || maps[k].x + maps[k].z <= maps[i].x ||
                         maps[i].y + maps[i].z <= maps[k].y || maps[k].y + maps[k].z <= maps[i].y;
            assert_true(apart || maps[i].z == 0 || maps[k].z == 0);
        }
    }
}

static void maps_are_placed_by_importance(void** state)
{
    hdrp_shadow_request r[40];
    uint32_t order[40], total;
    hdrp_u32x4 maps[240], again[240];
    hdrp_shadow_place_stats stats;
    (void)state;
    for (int round = 0; round < 300; ++round) {
        uint32_t count = (uint32_t)uniform(0.0f, 40.99f), placed = 0, shrunk = 0, dropped = 0;
        uint64_t used = 0;
        total = 0;
        for (uint32_t i = 0; i < count; ++i) {
            memset(&r[i], 0, sizeof r[i]);
            r[i].importance = floorf(uniform(0.0f, 6.0f));
            r[i].size_px = (uint32_t)uniform(1.0f, 3000.0f);
            r[i].maps = uniform(0.0f, 1.0f) < 0.3f ? 6 : 1;
            total += r[i].maps;
        }
        assert_int_equal(hdrp_shadow_place(2048, 64, r, count, order, maps, &stats), HDRP_OK);
        expect_apart(maps, total, 2048);
        for (uint32_t i = 0; i < count; ++i) {
            uint32_t wanted = 64;
            while (wanted < 2048 && wanted * 2 <= r[i].size_px) {
                wanted *= 2;
            }
            assert_true(r[i].placed_px <= wanted);
            assert_true(r[i].placed_px == 0 || r[i].placed_px >= 64);
            placed += r[i].placed_px > 0;
            shrunk += r[i].placed_px > 0 && r[i].placed_px < wanted;
            dropped += r[i].placed_px == 0;
            used += (uint64_t)r[i].maps * r[i].placed_px * r[i].placed_px;
            for (uint32_t k = 0; k < r[i].maps; ++k) {
                assert_int_equal(maps[r[i].first + k].z, r[i].placed_px);
            }
            for (uint32_t k = 0; k < count; ++k) { /* of what asks the same, the important one */
                if (r[i].importance > r[k].importance && r[i].size_px == r[k].size_px) {
                    assert_true(r[i].placed_px >= r[k].placed_px);
                }
            }
        }
        assert_int_equal(stats.placed, placed);
        assert_int_equal(stats.shrunk, shrunk);
        assert_int_equal(stats.dropped, dropped);
        assert_true(stats.used_px == used && used <= 2048u * 2048u);
        assert_int_equal(hdrp_shadow_place(2048, 64, r, count, order, again, NULL), HDRP_OK);
        assert_memory_equal(maps, again, total * sizeof maps[0]);
    }
}

static void what_does_not_fit_is_shrunk_and_then_dropped(void** state)
{
    hdrp_shadow_request r[5] = {{1.0f, 128, 1, 0, 0},
                                {3.0f, 128, 1, 0, 0},
                                {2.0f, 128, 1, 0, 0},
                                {(float)NAN, 128, 1, 0, 0},
                                {4.0f, 128, 1, 0, 0}};
    uint32_t order[5];
    hdrp_u32x4 maps[5];
    hdrp_shadow_place_stats stats;
    (void)state;
    assert_int_equal(hdrp_shadow_place(256, 64, r, 5, order, maps, &stats), HDRP_OK);
    assert_true(r[4].placed_px == 128 && r[1].placed_px == 128 && r[2].placed_px == 128);
    assert_true(r[0].placed_px == 64 && r[3].placed_px == 64 && stats.shrunk == 2);
    assert_int_equal(hdrp_shadow_place(128, 128, r, 5, order, maps, &stats), HDRP_OK);
    assert_true(stats.placed == 1 && stats.dropped == 4 && r[4].placed_px == 128);
    assert_true(maps[0].z == 0 && maps[4].z == 128 && maps[4].x == 0);
    assert_int_equal(hdrp_shadow_place(100, 64, r, 5, order, maps, NULL), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_shadow_place(128, 256, r, 5, order, maps, NULL), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_shadow_place(128, 0, r, 5, order, maps, NULL), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_shadow_place(128, 64, NULL, 5, order, maps, NULL),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_shadow_place(128, 64, NULL, 0, NULL, NULL, NULL), HDRP_OK);
    r[0].maps = 7;
    assert_int_equal(hdrp_shadow_place(128, 64, r, 5, order, maps, NULL), HDRP_ERROR_BAD_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(splits_meet_the_ends_and_rise),
        cmocka_unit_test(balls_hold_the_corners_of_their_part),
        cmocka_unit_test(depths_choose_their_part_and_blend),
        cmocka_unit_test(cascades_hold_what_the_camera_sees),
        cmocka_unit_test(cascades_do_not_shimmer),
        cmocka_unit_test(cascades_that_are_none_are_refused),
        cmocka_unit_test(weights_sum_to_one),
        cmocka_unit_test(an_edge_is_a_ramp_of_the_width_of_the_filter),
        cmocka_unit_test(taps_are_pairs_of_texels),
        cmocka_unit_test(radii_and_borders_are_those_of_the_filters),
        cmocka_unit_test(planes_in_parallel_light_have_no_acne),
        cmocka_unit_test(planes_in_light_from_a_point_have_no_acne),
        cmocka_unit_test(shadows_move_by_no_more_than_the_offset),
        cmocka_unit_test(planes_without_bias_have_acne),
        cmocka_unit_test(faces_of_a_point_cover_all_directions),
        cmocka_unit_test(spots_and_boxes_see_what_they_light),
        cmocka_unit_test(depths_compare_both_ways),
        cmocka_unit_test(cascades_blend_without_steps),
        cmocka_unit_test(maps_are_placed_by_importance),
        cmocka_unit_test(what_does_not_fit_is_shrunk_and_then_dropped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
