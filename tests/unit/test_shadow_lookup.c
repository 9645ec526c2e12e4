/* test_shadow_lookup.c - where receivers are in shadow maps, and what filters make of texels.
 * SPDX-License-Identifier: MIT
 *
 * Texels hold what a test needs and not what casters leave, so that every decision is at a known
 * place. */
#define HDRP_SHADOW_IMPLEMENTATION
#include "shadow_test.h"

#define SIZE 64

static float texels[SIZE * SIZE];
static const hdrp_shadow_atlas atlas = {texels, SIZE, SIZE, 0};

static void fill(float depth)
{
    for (int i = 0; i < SIZE * SIZE; ++i) {
        texels[i] = depth;
    }
}

/* Light from above on a ball of 10 m: texel rows and columns are along x and z, depth along y. */
static hdrp_shadow_view from_above(hdrp_shadow_settings s)
{
    return hdrp_shadow_view_ball(hdrp_v4_make(0.0f, 0.0f, 0.0f, 10.0f), v3(0.0f, -1.0f, 0.0f),
                                 10.0f, square(0, 0, SIZE), s);
}

static hdrp_shadow_view filtered(hdrp_u32 filter_kind)
{
    return from_above(hdrp_shadow_settings_make(filter_kind, 0));
}

/* The position, on the ground, that such a view sees at a place of its map. */
static hdrp_v3 ground_at(const hdrp_shadow_view* v, double column, double row)
{
    double p[3];
    (void)scene_unproject(v, (column - (double)v->place.z) / (double)v->place.x,
                          (row - (double)v->place.w) / (double)v->place.y, 0.5, p);
    return v3((float)p[0], 0.0f, (float)p[2]);
}

/* Texels by which a receiver moves, as the contract of the bias has them. */
static double offset_of(hdrp_shadow_settings s, double sine, double incidence)
{
    double steeper = sine - 0.75 * (double)s.slope_max * fabs(incidence);
    return sqrt(2.0) * radius_of(s.filter_kind) * (fmax(steeper, 0.0) + 0.05);
}

static hdrp_shadow_settings settings_of(int i)
{
    hdrp_shadow_settings s = hdrp_shadow_settings_make((hdrp_u32)(i & 3), (hdrp_u32)(i >> 2 & 1));
    s.slope_max = i % 3 ? 0.0f : uniform(0.2f, 2.0f);
    return s;
}

static void offsets_are_those_of_the_contract(void** state)
{
    (void)state;
    for (int i = 0; i < 4000; ++i) {
        hdrp_shadow_settings s = settings_of(i);
        hdrp_shadow_view v = from_above(s);
        float cosine = uniform(-1.0f, 1.0f), incidence = uniform(-1.5f, 1.5f);
        double sine = sqrt(1.0 - (double)cosine * (double)cosine);
        double expected = offset_of(s, sine, (double)incidence);
        double found = (double)hdrp_shadow_offset_texels(v, cosine, incidence);
        assert_true(fabs(found - expected) <= 2e-6 * expected + 1e-6);
    }
}

/* Receivers of light from a position, far from the origin, against the same in double. */
static void receivers_move_along_their_normal(void** state)
{
    int seen = 0;
    (void)state;
    for (int i = 0; i < 8000; ++i) {
        hdrp_shadow_settings s = settings_of(i);
        hdrp_v3 eye = hdrp_v3_scale(direction(), 40.0f), f = direction(), n = direction();
        hdrp_shadow_view v = hdrp_shadow_view_perspective(
            eye, f, direction(), hdrp_v4_make(1.0f, 1.0f, 0.5f, 50.0f), square(0, 0, SIZE), s);
        hdrp_v3 p = v3_from(dv_mad(dv_mad(dv_from(eye), dv_from(f), (double)uniform(3.0f, 10.0f)),
                                   dv_from(direction()), 2.0));
        hdrp_shadow_receiver r = hdrp_shadow_receiver_make(v, p, n);
        dvec to_light = dv_mad(dv_from(eye), dv_from(p), -1.0), normal = dv_from(n), moved;
        double depth = -dv_dot(to_light, dv_from(f)), cosine = -dv_dot(normal, dv_from(f));
        double incidence = dv_dot(normal, to_light) / depth;
        double texel = (double)v.axis_texel.w * depth;
        moved = dv_mad(dv_from(p), normal,
                       texel * offset_of(s, sqrt(1.0 - cosine * cosine), incidence));
        if (column_of(&v, moved) > 0.1 && column_of(&v, moved) < SIZE - 0.1 &&
            row_place_of(&v, moved) > 0.1 && row_place_of(&v, moved) < SIZE - 0.1) {
            ++seen;
            assert_true(r.place.w == 1.0f);
            assert_true(fabs((double)r.place.x - column_of(&v, moved)) < 1e-3);
            assert_true(fabs((double)r.place.y - row_place_of(&v, moved)) < 1e-3);
            assert_true(fabs((double)r.place.z - depth_of(&v, moved)) < 1e-5);
        }
    }
    assert_true(seen > 4000);
}

static void maps_end_at_their_last_texel(void** state)
{
    hdrp_shadow_view v = filtered(HDRP_SHADOW_FILTER_BILINEAR);
    hdrp_v3 up = v3(0.0f, 1.0f, 0.0f);
    (void)state;
    fill(0.0f); /* all of it in shadow */
    for (int side = 0; side < 4; ++side) {
        for (int outside = 0; outside < 2; ++outside) {
            double beyond = outside ? 0.01 : -0.01;
            double at = side & 1 ? SIZE + beyond : -beyond;
            hdrp_v3 p = side & 2 ? ground_at(&v, 20.0, at) : ground_at(&v, at, 20.0);
            assert_true(hdrp_shadow_receiver_make(v, p, up).place.w == (outside ? 0.0f : 1.0f));
            assert_true(hdrp_shadow_visibility(&atlas, &v, p, up) == (outside ? 1.0f : 0.0f));
        }
    }
}

/* The step that depths are allowed, in both directions. */
static void depths_within_the_rounding_are_the_same(void** state)
{
    static const float steps[] = {0.0f, 1.0f / 65535.0f, 0.0078125f};
    (void)state;
    for (int i = 0; i < 6; ++i) {
        hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_HARD, i & 1);
        double allowed, towards = i & 1 ? 1.0 : -1.0; /* the light */
        hdrp_shadow_view v;
        hdrp_shadow_receiver r;
        hdrp_v2 at = hdrp_v2_make(32.5f, 32.5f);
        s.depth_step = steps[i / 2];
        allowed = fmax(1.5 * (double)s.depth_step, 0x1p-20);
        v = from_above(s);
        r = hdrp_shadow_receiver_make(v, v3(0.0f, 0.0f, 0.0f), v3(0.0f, 1.0f, 0.0f));
        r.place.z = 0.5f;
        for (double share = 0.9995; share < 1.001; share += 0.001) {
            /* 2^-20 is but 32 steps of the floats around a half. */
            double off = allowed * (s.depth_step > 1e-3f ? share : share < 1.0 ? 0.95 : 1.05);
            float depth = (float)(0.5 + towards * off);
            assert_true(hdrp_shadow_lit(v, r, at, depth) == (share < 1.0 ? 1.0f : 0.0f));
        }
        assert_true(hdrp_shadow_lit(v, r, at, 0.5f - (float)(towards * 0.3)) == 1.0f);
    }
}

/* Depths of a steep plane at the centres of texels, moved to both sides of what is allowed: only
 * where the receiver's depth is taken at the same centre do all fall on their side. */
static void depths_follow_planes_to_the_centre_of_a_texel(void** state)
{
    (void)state;
    for (int i = 0; i < 20; ++i) {
        hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_HARD, 0);
        hdrp_v3 light = direction();
        hdrp_basis b = hdrp_basis_from_normal(light);
        float turn = uniform(0.0f, 6.2f), sine = uniform(0.7f, 0.9f);
        float cosine = sqrtf(1.0f - sine * sine);
        hdrp_v3 n = hdrp_v3_mad(hdrp_v3_scale(light, cosine), b.tangent, sine * cosf(turn));
        scene plane = {{0.0f, 0.0f, 0.0f}, 0.0f, {0.0f, 0.0f, 0.0f}, 0.0f};
        hdrp_shadow_view v;
        s.slope_max = 8.0f;
        plane.n = hdrp_v3_normalize(hdrp_v3_mad(n, b.bitangent, sine * sinf(turn)));
        v = hdrp_shadow_view_ball(hdrp_v4_make(0.0f, 0.0f, 0.0f, 10.0f), hdrp_v3_neg(light), 10.0f,
                                  square(0, 0, SIZE), s);
        plane.distance =
            (float)(offset_of(s, (double)sine, (double)cosine) * (double)v.axis_texel.w);
        scene_draw(&v, &plane, texels, SIZE);
        b = hdrp_basis_from_normal(plane.n);
        for (int k = 0; k < 400; ++k) {
            double over = k & 1 ? 3e-6 : -3e-6;
            hdrp_v3 p = hdrp_v3_scale(b.tangent, uniform(-3.0f, 3.0f));
            hdrp_shadow_receiver r;
            float was, seen;
            size_t at;
            p = hdrp_v3_mad(p, b.bitangent, uniform(-3.0f, 3.0f));
            r = hdrp_shadow_receiver_make(v, p, plane.n);
            at = (size_t)r.place.y * SIZE + (size_t)r.place.x;
            if (fabsf(r.place.x - floorf(r.place.x + 0.5f)) < 0.01f ||
                fabsf(r.place.y - floorf(r.place.y + 0.5f)) < 0.01f) {
                continue; /* which texel holds it is rounding's choice */
            }
            was = texels[at];
            texels[at] = (float)((double)was - 0x1p-20 - over);
            seen = hdrp_shadow_visibility(&atlas, &v, p, plane.n);
            texels[at] = was;
            assert_true(seen == (over > 0.0 ? 0.0f : 1.0f));
        }
    }
}

static double ramp(double x)
{
    return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
}

/* Visibility of what is lit by texels before an edge, where an edge of 2 x 2 texels is as straight
 * as in double, also next to the centres of texels, where other texels begin to count. */
static void positions_next_to_centres_are_between_the_right_texels(void** state)
{
    const int edge = 24;
    hdrp_shadow_view v = filtered(HDRP_SHADOW_FILTER_BILINEAR);
    (void)state;
    for (int down = 0; down < 2; ++down) {
        for (int y = 0; y < SIZE; ++y) {
            for (int x = 0; x < SIZE; ++x) {
                texels[y * SIZE + x] = (down ? y : x) < edge ? 1.0f : 0.0f;
            }
        }
        for (int i = -100; i <= 100; ++i) {
            double at = edge - 0.5 + (i & 1) + i * 3e-5;
            hdrp_v3 p = down ? ground_at(&v, 20.3, at) : ground_at(&v, at, 20.3);
            double seen = (double)hdrp_shadow_visibility(&atlas, &v, p, v3(0.0f, 1.0f, 0.0f));
            assert_true(fabs(seen - ramp(edge + 0.5 - at)) < 1e-4);
        }
    }
}

static void texels_beside_the_atlas_are_lit(void** state)
{
    hdrp_shadow_view v = filtered(HDRP_SHADOW_FILTER_BILINEAR);
    hdrp_shadow_atlas part = {texels, 30, 40, SIZE};
    (void)state;
    fill(0.0f);
    for (int i = 0; i <= 20; ++i) {
        double at = i * 0.1;
        hdrp_v3 p = ground_at(&v, 29.0 + at, 20.0), q = ground_at(&v, 20.0, 39.0 + at);
        hdrp_v3 up = v3(0.0f, 1.0f, 0.0f);
        double across = (double)hdrp_shadow_visibility(&part, &v, p, up);
        double down = (double)hdrp_shadow_visibility(&part, &v, q, up);
        assert_true(fabs(across - ramp(at - 0.5)) < 5e-5);
        assert_true(fabs(down - ramp(at - 0.5)) < 5e-5);
    }
}

static void what_cascades_leave_is_lit(void** state)
{
    hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_HARD, 0);
    hdrp_shadow_view v;
    (void)state;
    s.band = 0.4f;
    v = from_above(s);
    fill(0.0f);
    for (int i = 0; i <= 40; ++i) {
        double x = 5.0 + 0.1 * i, share = ramp((100.0 - x * x) / (100.0 - 36.0));
        hdrp_v3 p = v3((float)x, 0.0f, 0.0f), up = v3(0.0f, 1.0f, 0.0f);
        double seen = (double)hdrp_shadow_cascades_visibility(&atlas, &v, 1, p, up);
        assert_true(fabs(seen - (1.0 - share)) < 2e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(offsets_are_those_of_the_contract),
        cmocka_unit_test(receivers_move_along_their_normal),
        cmocka_unit_test(maps_end_at_their_last_texel),
        cmocka_unit_test(depths_within_the_rounding_are_the_same),
        cmocka_unit_test(depths_follow_planes_to_the_centre_of_a_texel),
        cmocka_unit_test(positions_next_to_centres_are_between_the_right_texels),
        cmocka_unit_test(texels_beside_the_atlas_are_lit),
        cmocka_unit_test(what_cascades_leave_is_lit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
