/* test_shadow_view.c - the projections of hdrp_shadow.h against what they are for, in double.
 * SPDX-License-Identifier: MIT */
#define HDRP_SHADOW_IMPLEMENTATION
#include "shadow_test.h"

#define SIZE 128

static const hdrp_u32x4 map = {32, 64, SIZE, 0};

/* Texels of a map that are for what the light sees: the rest is for the filter and for the offset,
 * which is at most 1.05 sqrt(2) times as wide. */
static double inner_px(hdrp_u32 filter_kind)
{
    return SIZE - 2.0 * ceil(radius_of(filter_kind) * (1.0 + 1.05 * sqrt(2.0)));
}

static void expect_near(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance)) {
        fail_msg("%.9g, not %.9g", found, expected);
    }
}

/* The square, the axis, and a frame that looks along it: x to the right, y downwards, of which the
 * map holds so much. Lights are a little wider than they are asked to be. */
static void expect_frame(const hdrp_shadow_view* v, dvec forward, double half_x, double half_y)
{
    const dvec zero = {0.0, 0.0, 0.0};
    dvec x = row_of(v->clip_x), y = row_of(v->clip_y), axis = row_of(v->axis_texel), turned;
    expect_near(dv_length(x) * half_x, 1.0, 2e-5);
    expect_near(dv_length(y) * half_y, 1.0, 2e-5);
    x = dv_mad(zero, x, 1.0 / dv_length(x));
    y = dv_mad(zero, y, 1.0 / dv_length(y));
    turned = dv_mad(dv_cross(x, y), forward, -1.0); /* forward is up cross right, and up is -y */
    expect_near(dv_length(turned), 0.0, 1e-6);
    expect_near(dv_length(dv_mad(axis, forward, 1.0)), 0.0, 3e-7);
    assert_true(v->limits.x == 32.0f && v->limits.z == 159.0f);
    assert_true(v->limits.y == 64.0f && v->limits.w == 191.0f);
    assert_true(v->place.x == 64.0f && v->place.z == 96.0f);
    assert_true(v->place.y == 64.0f && v->place.w == 128.0f);
}

/* Depth at a distance along forward from the eye, whose reverse is 1 minus it. */
static void expect_depth(const hdrp_shadow_view* v, dvec eye, dvec forward, double z, double depth)
{
    double found = depth_of(v, dv_mad(eye, forward, z));
    expect_near(found, v->bias.w < 0.0f ? 1.0 - depth : depth, 5e-6);
}

/* A view of what is within tangents x and y of an axis. */
static void expect_perspective(const hdrp_shadow_view* v, hdrp_v3 position, hdrp_v3 axis, double x,
                               double y, double near_m, double far_m)
{
    dvec eye = dv_from(position), forward = dv_from(axis);
    double inner = inner_px((hdrp_u32)v->fade.y);
    expect_frame(v, forward, x * SIZE / inner, y * SIZE / inner);
    expect_near((double)v->axis_texel.w * inner, 2.0 * fmax(x, y), 4e-5 * fmax(x, y));
    expect_near(dv_length(dv_mad(row_of(v->clip_w), forward, -1.0)), 0.0, 3e-7);
    expect_near(clip_of(v->clip_x, eye) * x, 0.0, 1e-6);
    expect_near(clip_of(v->clip_y, eye) * y, 0.0, 1e-6);
    expect_near(clip_of(v->clip_w, eye), 0.0, 1e-6);
    for (double z = near_m; z < far_m; z *= 2.0) {
        double depth = far_m * (z - near_m) / (z * (far_m - near_m));
        expect_depth(v, eye, forward, z, depth);
    }
    expect_depth(v, eye, forward, far_m, 1.0);
    assert_true(v->ball.x == position.x && v->ball.y == position.y && v->ball.z == position.z);
    assert_true(v->ball.w == 0.0f && v->fade.w == 1.0f);
}

static hdrp_shadow_settings settings_of(int i)
{
    return hdrp_shadow_settings_make((hdrp_u32)(i & 3), (hdrp_u32)(i >> 2 & 1));
}

static hdrp_v3 somewhere(void)
{
    return v3(uniform(-2.0f, 2.0f), uniform(-2.0f, 2.0f), uniform(-2.0f, 2.0f));
}

static void settings_are_those_that_are_recommended(void** state)
{
    hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 0);
    (void)state;
    assert_true(s.band == 0.1f && s.slope_max == 0.0f && s.depth_step == 0.0f);
    assert_int_equal(s.reverse, 0);
}

static void pyramids_fill_their_map_but_for_the_border(void** state)
{
    (void)state;
    for (int i = 0; i < 4000; ++i) {
        hdrp_v3 eye = somewhere(), f = direction(), up = direction();
        float x = uniform(0.1f, 7.9f), y = uniform(0.1f, 7.9f), n = uniform(0.5f, 2.0f);
        float far_m = n * uniform(2.0f, 200.0f);
        hdrp_shadow_view v = hdrp_shadow_view_perspective(
            eye, hdrp_v3_scale(f, 3.0f), up, hdrp_v4_make(x, y, n, far_m), map, settings_of(i));
        dvec right = row_of(v.clip_x);
        expect_perspective(&v, eye, f, (double)x, (double)y, (double)n, (double)far_m);
        if (fabsf(hdrp_v3_dot(f, up)) < 0.9f) { /* up is upwards, and the right is level */
            expect_near(dv_dot(right, dv_from(up)) / dv_length(right), 0.0, 2e-6);
            assert_true(dv_dot(row_of(v.clip_y), dv_from(up)) < 0.0);
        }
    }
}

static void limits_of_pyramids_are_as_documented(void** state)
{
    hdrp_v3 at = v3(0.0f, 0.0f, 0.0f), f = v3(0.0f, 0.0f, 1.0f), up = v3(0.0f, 1.0f, 0.0f);
    hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_HARD, 1);
    hdrp_shadow_view v =
        hdrp_shadow_view_perspective(at, f, up, hdrp_v4_make(99.0f, 0.0f, 1.0f, 0.0f), map, s);
    double inner = inner_px(0);
    (void)state;
    expect_near(dv_length(row_of(v.clip_x)) * 8.0 * SIZE / inner, 1.0, 1e-6);
    expect_near(dv_length(row_of(v.clip_y)) * 1e-4 * SIZE / inner, 1.0, 1e-6);
    expect_near(depth_of(&v, dv_from(f)), 1.0, 1e-6);
    expect_near(clip_of(v.clip_z, dv_from(v3(0.0f, 0.0f, 1.001f))), 0.0, 1e-3);
    v = hdrp_shadow_view_perspective(at, at, up, hdrp_v4_make(1.0f, 1.0f, 1.0f, 9.0f), map, s);
    expect_near(dv_length(dv_mad(row_of(v.axis_texel), dv_from(up), -1.0)), 0.0, 1e-6);
}

static void cones_and_pyramids_are_seen_up_to_their_angle(void** state)
{
    const hdrp_v3 white = {1.0f, 1.0f, 1.0f};
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        hdrp_v3 eye = somewhere(), f = direction();
        float x = uniform(0.1f, 1.2f), y = uniform(0.1f, 1.2f), range = uniform(5.0f, 50.0f);
        hdrp_light spot = hdrp_light_spot(eye, f, white, range, 0.1f, x);
        hdrp_light pyramid = hdrp_light_pyramid(eye, f, direction(), white, range, x, y, 0.1f);
        hdrp_shadow_view v = hdrp_shadow_view_light(spot, 0, 0.5f, map, settings_of(i));
        double tan_x = tan((double)x), tan_y = tan((double)y);
        expect_perspective(&v, eye, f, tan_x, tan_x, 0.5, (double)range);
        assert_true(v.fade.z == 1.0f);
        v = hdrp_shadow_view_light(pyramid, 0, 0.5f, map, settings_of(i));
        expect_perspective(&v, eye, f, tan_x, tan_y, 0.5, (double)range);
        expect_near(dv_dot(row_of(v.clip_x), row_of(pyramid.up_half_height)), 0.0, 1e-5);
    }
}

/* A cone of half angle atan(8), 82.9 degrees, is the widest that one map holds. */
static void wide_cones_need_faces(void** state)
{
    const hdrp_v3 at = {0.0f, 0.0f, 0.0f}, f = {0.0f, 0.0f, 1.0f}, white = {1.0f, 1.0f, 1.0f};
    hdrp_light narrow = hdrp_light_spot(at, f, white, 9.0f, 0.1f, (float)atan(7.998));
    hdrp_light wide = hdrp_light_spot(at, f, white, 9.0f, 0.1f, (float)atan(8.004));
    hdrp_light pyramid = hdrp_light_pyramid(at, f, white, white, 9.0f, 1.5f, 1.5f, 0.1f);
    (void)state;
    assert_int_equal(hdrp_shadow_map_count(narrow), 1);
    assert_int_equal(hdrp_shadow_map_count(wide), 6);
    assert_int_equal(hdrp_shadow_map_count(pyramid), 1);
}

static void faces_look_along_their_axes_at_right_angles(void** state)
{
    static const hdrp_v3 axes[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                    {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    hdrp_v3 eye = v3(1.0f, -2.0f, 0.5f);
    hdrp_light light = hdrp_light_point(eye, v3(1.0f, 1.0f, 1.0f), 20.0f);
    (void)state;
    for (int i = 0; i < 48; ++i) {
        hdrp_u32 face = (hdrp_u32)(i / 8);
        hdrp_shadow_view v = hdrp_shadow_view_light(light, face, 0.5f, map, settings_of(i));
        hdrp_v3 a = hdrp_shadow_face_axis(face);
        assert_true(a.x == axes[face].x && a.y == axes[face].y && a.z == axes[face].z);
        expect_perspective(&v, eye, axes[face], 1.0, 1.0, 0.5, 20.0);
        assert_true(v.fade.z == 6.0f);
    }
    assert_true(hdrp_shadow_face_axis(7).z == -1.0f);
}

/* Beyond a million times the near depth nothing of a light with a long range is in the map. */
static void ranges_end_at_a_million_times_the_near_depth(void** state)
{
    hdrp_light light = hdrp_light_point(v3(0, 0, 0), v3(1.0f, 1.0f, 1.0f), 1e5f);
    hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_HARD, 1);
    hdrp_shadow_view v = hdrp_shadow_view_light(light, 4, 0.0078125f, map, s);
    (void)state;
    /* Near the far end depths are near 0, so that rounding hides little. */
    expect_near(clip_of(v.clip_z, dv_from(v3(0, 0, 7812.5f))) / 0.0078125, 0.0, 1e-5);
    expect_near(clip_of(v.clip_z, dv_from(v3(0, 0, 3906.25f))) / 0.0078125, 0.5, 1e-5);
}

static void boxes_fill_their_map_but_for_the_border(void** state)
{
    const hdrp_v3 white = {1.0f, 1.0f, 1.0f};
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        hdrp_v3 at = somewhere(), f = direction();
        float x = uniform(0.5f, 5.0f), y = uniform(0.5f, 5.0f), range = uniform(1.0f, 20.0f);
        hdrp_light box = hdrp_light_box(at, f, direction(), white, x, y, range, 0.1f);
        hdrp_shadow_view v = hdrp_shadow_view_light(box, 0, 0.1f, map, settings_of(i));
        dvec origin = dv_from(at), forward = dv_from(f);
        double half = (double)fmaxf(box.right_half_width.w, box.up_half_height.w);
        double inner = inner_px((hdrp_u32)(i & 3));
        expect_frame(&v, forward, half * SIZE / inner, half * SIZE / inner);
        expect_near((double)v.axis_texel.w, 2.0 * half / inner, 1e-6 * half);
        expect_near(clip_of(v.clip_x, origin), 0.0, 2e-6);
        expect_near(clip_of(v.clip_y, origin), 0.0, 2e-6);
        expect_near(dv_dot(row_of(v.clip_x), row_of(box.up_half_height)), 0.0, 1e-5);
        assert_true(dv_dot(row_of(v.clip_y), row_of(box.up_half_height)) < 0.0);
        assert_true(v.clip_w.x == 0.0f && v.clip_w.y == 0.0f && v.clip_w.z == 0.0f);
        assert_true(v.clip_w.w == 1.0f && v.fade.w == 0.0f && v.fade.z == 1.0f);
        expect_depth(&v, origin, forward, 0.0, 0.0);
        expect_depth(&v, origin, forward, (double)box.position_range.w, 1.0);
    }
}

/* A ball fills its map but for the border and a texel, by half of which it may be off on either
 * side. */
static void balls_are_off_by_half_a_texel_at_most(void** state)
{
    double most = 0.0;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_v3 at = v3(uniform(-9.0f, 9.0f), uniform(-9.0f, 9.0f), uniform(-9.0f, 9.0f));
        hdrp_v3 f = direction();
        float r = uniform(5.0f, 20.0f), caster = uniform(0.0f, 99.0f);
        hdrp_shadow_view v = hdrp_shadow_view_ball(hdrp_v4_from_v3(at, r), hdrp_v3_scale(f, 7.0f),
                                                   caster, map, settings_of(i));
        dvec center = dv_from(at), forward = dv_from(f);
        double radius = (double)r, texel = 2.0 * radius / (inner_px((hdrp_u32)(i & 3)) - 1.0);
        double x = column_of(&v, center) - 96.0, y = row_place_of(&v, center) - 128.0;
        expect_frame(&v, forward, 0.5 * SIZE * texel, 0.5 * SIZE * texel);
        expect_near((double)v.axis_texel.w, texel, 1e-6 * texel);
        most = fmax(most, fmax(fabs(x), fabs(y)));
        expect_depth(&v, center, forward, -fmax((double)caster, radius), 0.0);
        expect_depth(&v, center, forward, radius, 1.0);
        assert_true(v.ball.x == at.x && v.ball.y == at.y && v.ball.z == at.z);
        assert_true(v.clip_w.w == 1.0f && v.fade.w == 0.0f && v.fade.z == 1.0f);
    }
    assert_true(most <= 0.5 + 5e-5 && most > 0.499);
}

static void balls_of_nothing_have_a_millimetre_and_light_from_above(void** state)
{
    hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_HARD, 0);
    hdrp_shadow_view v = hdrp_shadow_view_ball(hdrp_v4_make(0, 0, 0, 0), v3(0, 0, 0), 0.0f, map, s);
    (void)state;
    assert_true(v.axis_texel.x == 0.0f && v.axis_texel.y == 1.0f && v.axis_texel.z == 0.0f);
    expect_near((double)v.axis_texel.w, 2e-3 / (inner_px(0) - 1.0), 1e-9);
}

/* In squares of distances the fade is linear. */
static void cascades_fade_in_the_band_at_their_rim(void** state)
{
    hdrp_v3 at = v3(1.0f, 2.0f, 3.0f);
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        hdrp_shadow_settings s = settings_of(i);
        double radius = (double)uniform(1.0f, 30.0f), share = (double)uniform(0.0f, 1.1f), inner;
        hdrp_shadow_view v;
        hdrp_v3 p;
        dvec off;
        double d, expected;
        s.band = uniform(0.05f, 0.5f);
        inner = radius * (1.0 - (double)s.band);
        v = hdrp_shadow_view_ball(hdrp_v4_from_v3(at, (float)radius), direction(), 0.0f, map, s);
        p = v3_from(dv_mad(dv_from(at), dv_from(direction()), radius * share));
        off = dv_mad(dv_from(p), dv_from(at), -1.0);
        d = dv_length(off);
        expected = (radius * radius - d * d) / (radius * radius - inner * inner);
        expected = fmin(fmax(expected, 0.0), 1.0);
        expect_near((double)hdrp_shadow_cascade_weight(v, p), expected, 4e-5);
    }
}

static void cascades_of_no_direction_look_along_minus_z(void** state)
{
    hdrp_shadow_cascades d;
    hdrp_shadow_view views[2], same[2];
    (void)state;
    memset(&d, 0, sizeof d);
    d.extent = hdrp_v2_make(0.8f, 0.45f);
    d.near_m = 1.0f;
    d.far_m = 1e9f;
    d.log_weight = 0.5f;
    d.forward = v3(0.3f, -1.0f, 0.2f);
    d.count = 2;
    d.maps[0] = d.maps[1] = map;
    d.settings = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 1);
    assert_int_equal(hdrp_shadow_make_cascades(&d, views), HDRP_OK);
    d.view_forward = v3(0.0f, 0.0f, -5.0f);
    assert_int_equal(hdrp_shadow_make_cascades(&d, same), HDRP_OK);
    assert_memory_equal(views, same, sizeof views);
    d.far_m = 1.0005e9f;
    assert_int_equal(hdrp_shadow_make_cascades(&d, views), HDRP_ERROR_BAD_ARGUMENT);
    assert_memory_equal(views, same, sizeof views);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(settings_are_those_that_are_recommended),
        cmocka_unit_test(pyramids_fill_their_map_but_for_the_border),
        cmocka_unit_test(limits_of_pyramids_are_as_documented),
        cmocka_unit_test(cones_and_pyramids_are_seen_up_to_their_angle),
        cmocka_unit_test(wide_cones_need_faces),
        cmocka_unit_test(faces_look_along_their_axes_at_right_angles),
        cmocka_unit_test(ranges_end_at_a_million_times_the_near_depth),
        cmocka_unit_test(boxes_fill_their_map_but_for_the_border),
        cmocka_unit_test(balls_are_off_by_half_a_texel_at_most),
        cmocka_unit_test(balls_of_nothing_have_a_millimetre_and_light_from_above),
        cmocka_unit_test(cascades_fade_in_the_band_at_their_rim),
        cmocka_unit_test(cascades_of_no_direction_look_along_minus_z),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
