/* test_light_record.c - the light record of hdrp_light.h and its evaluation.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_light.h"

#define PI 3.14159265358979323846

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

static bool is_black(hdrp_v3 v)
{
    return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f;
}

static hdrp_v3 at(hdrp_v3 origin, double theta, double phi, double radius)
{
    return hdrp_v3_add(origin,
                       v3((float)(radius * sin(theta) * cos(phi)),
                          (float)(radius * sin(theta) * sin(phi)), (float)(radius * cos(theta))));
}

/* Lumens through a sphere of 7 m around the light, which shines along +z. */
static double flux(hdrp_light light, double last_theta)
{
    const int rings = 800, steps = 180;
    hdrp_v3 origin = hdrp_v3_from_v4(light.position_range);
    double sum = 0.0, width = last_theta / rings;
    for (int i = 0; i < rings; ++i) {
        double theta = (i + 0.5) * width;
        for (int k = 0; k < steps; ++k) {
            double phi = (k + 0.5) * (2.0 * PI / steps);
            sum += sin(theta) *
                   (double)hdrp_light_eval(light, at(origin, theta, phi, 7.0)).illuminance.x;
        }
    }
    return sum * width * (2.0 * PI / steps) * 49.0;
}

static void expect_flux(hdrp_light light, double last_theta, double lumen, double relative)
{
    double measured = flux(light, last_theta);
    if (!(fabs(measured - lumen) <= relative * lumen)) {
        fail_msg("%.6g lm, expected %.6g", measured, lumen);
    }
}

static void every_spot_emits_the_requested_flux(void** state)
{
    (void)state;
    hdrp_v3 p = v3(1.0f, 2.0f, 3.0f), z = v3(0.0f, 0.0f, 1.0f);
    float inner[] = {0.0f, 0.2f, 0.5f, 1.0f, 0.3f}, outer[] = {0.3f, 0.3f, 1.5f, 3.1f, 0.3f};
    for (int i = 0; i < 5; ++i) {
        float candela = hdrp_light_candela_from_lumen_spot(1000.0f, inner[i], outer[i]);
        hdrp_light spot =
            hdrp_light_spot(p, z, hdrp_v3_splat(candela), INFINITY, inner[i], outer[i]);
        expect_flux(spot, fmin(1.01 * (double)outer[i], PI), 1000.0, 1e-3);
    }
}

static void a_hard_reflector_emits_the_requested_flux(void** state)
{
    (void)state;
    float candela = hdrp_light_candela_from_lumen_spot_reflector(1000.0f, 0.6f);
    hdrp_light spot = hdrp_light_spot(v3(0.0f, 0.0f, 0.0f), v3(0.0f, 0.0f, 1.0f),
                                      hdrp_v3_splat(candela), INFINITY, 0.3f, 0.3f);
    expect_flux(spot, 0.31, 1000.0, 2e-3);
}

static void point_and_pyramid_emit_the_requested_flux(void** state)
{
    (void)state;
    hdrp_v3 p = v3(1.0f, 2.0f, 3.0f), z = v3(0.0f, 0.0f, 1.0f), y = v3(0.0f, 1.0f, 0.0f);
    float candela = hdrp_light_candela_from_lumen_point(1000.0f);
    hdrp_light point = hdrp_light_point(p, hdrp_v3_splat(candela), INFINITY);
    expect_flux(point, PI, 1000.0, 1e-5);
    float half_x[] = {0.6f, 0.2f, 1.5707964f}, half_y[] = {0.3f, 1.2f, 1.0f};
    for (int i = 0; i < 3; ++i) {
        candela =
            hdrp_light_candela_from_lumen_pyramid(1000.0f, 2.0f * half_x[i], 2.0f * half_y[i]);
        hdrp_light pyramid = hdrp_light_pyramid(p, z, y, hdrp_v3_splat(candela), INFINITY,
                                                half_x[i], half_y[i], 0.0f);
        expect_flux(pyramid, 0.5 * PI, 1000.0, 3e-3);
    }
}

static void a_pyramid_is_wide_along_its_right_axis(void** state)
{
    (void)state;
    /* Looks like a camera: forward -z, up +y, right +x. */
    hdrp_light l =
        hdrp_light_pyramid(v3(0.0f, 0.0f, 0.0f), v3(0.0f, 0.0f, -2.0f), v3(0.0f, 3.0f, 1.0f),
                           hdrp_v3_splat(1.0f), 10.0f, 0.6f, 0.2f, 0.0f);
    assert_true(l.right_half_width.x == 1.0f && l.up_half_height.y == 1.0f);
    assert_false(is_black(hdrp_light_eval(l, v3(0.5f, 0.0f, -1.0f)).illuminance));
    assert_false(is_black(hdrp_light_eval(l, v3(-0.5f, 0.0f, -1.0f)).illuminance));
    assert_true(is_black(hdrp_light_eval(l, v3(0.0f, 0.5f, -1.0f)).illuminance));
    assert_true(is_black(hdrp_light_eval(l, v3(0.0f, 0.0f, 1.0f)).illuminance));
}

static void a_point_light_lights_from_where_it_is(void** state)
{
    (void)state;
    hdrp_light l = hdrp_light_point(v3(0.0f, 3.0f, 4.0f), v3(25.0f, 50.0f, 75.0f), INFINITY);
    hdrp_light_incident i = hdrp_light_eval(l, hdrp_v3_splat(0.0f));
    assert_true(i.distance_m == 5.0f);
    assert_true(fabsf(i.l.y - 0.6f) < 1e-6f && fabsf(i.l.z - 0.8f) < 1e-6f && i.l.x == 0.0f);
    assert_true(fabsf(i.illuminance.x - 1.0f) < 1e-6f && fabsf(i.illuminance.z - 3.0f) < 1e-6f);
}

static void nothing_is_lit_beyond_the_range(void** state)
{
    (void)state;
    hdrp_light l = hdrp_light_point(v3(0.0f, 0.0f, 0.0f), hdrp_v3_splat(1e30f), 2.0f);
    assert_true(is_black(hdrp_light_eval(l, v3(2.0f, 0.0f, 0.0f)).illuminance));
    assert_true(is_black(hdrp_light_eval(l, v3(1e18f, 1e18f, -1e18f)).illuminance));
    assert_false(is_black(hdrp_light_eval(l, v3(1.999f, 0.0f, 0.0f)).illuminance));
}

static void the_light_s_own_place_is_lit_from_behind_its_axis(void** state)
{
    (void)state;
    hdrp_v3 p = v3(5.0f, 6.0f, 7.0f), axis = v3(1.0f, 0.0f, 0.0f), up = v3(0.0f, 1.0f, 0.0f);
    hdrp_light lights[3];
    lights[0] = hdrp_light_point(p, hdrp_v3_splat(1.0f), 10.0f);
    lights[1] = hdrp_light_spot(p, axis, hdrp_v3_splat(1.0f), 10.0f, 0.1f, 0.2f);
    lights[2] = hdrp_light_pyramid(p, axis, up, hdrp_v3_splat(1.0f), 10.0f, 0.1f, 0.2f, 0.5f);
    for (int i = 0; i < 3; ++i) {
        hdrp_light_incident r = hdrp_light_eval(lights[i], p);
        assert_true(r.distance_m == 0.0f);
        assert_true(fabsf(r.illuminance.x - 1e4f) < 0.1f);
        assert_true(hdrp_v3_dot(r.l, hdrp_v3_from_v4(lights[i].forward_radius)) == -1.0f);
    }
}

static void the_sun_is_the_same_everywhere(void** state)
{
    (void)state;
    hdrp_light sun = hdrp_light_directional(v3(0.0f, -2.0f, 0.0f), v3(1e5f, 9e4f, 8e4f), 0.0093f);
    hdrp_light_incident i = hdrp_light_eval(sun, v3(1e18f, -3.0f, 0.0f));
    assert_true(i.l.y == 1.0f && i.illuminance.x == 1e5f && i.illuminance.z == 8e4f);
    assert_true(i.distance_m == HDRP_LIGHT_DISTANCE_INFINITE);
    assert_true(sun.forward_radius.w == 0.0093f);
}

static void a_box_projects_parallel_rays(void** state)
{
    (void)state;
    hdrp_light box =
        hdrp_light_box(v3(1.0f, 5.0f, 0.0f), v3(0.0f, -1.0f, 0.0f), v3(0.0f, 0.0f, -1.0f),
                       hdrp_v3_splat(300.0f), 2.0f, 1.0f, 4.0f, 0.5f);
    hdrp_light_incident i = hdrp_light_eval(box, v3(2.0f, 3.0f, 0.3f));
    assert_true(i.illuminance.x == 300.0f && i.l.y == 1.0f && i.distance_m == 2.0f);
    assert_true(is_black(hdrp_light_eval(box, v3(1.0f, 3.0f, 1.5f)).illuminance));
    i = hdrp_light_eval(box, v3(1.0f, 5.5f, 0.0f));
    assert_true(is_black(i.illuminance) && i.distance_m == 0.0f); /* before the emitting face */
    assert_true(is_black(hdrp_light_eval(box, v3(1.0f, 0.5f, 0.0f)).illuminance));
}

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static double test_random(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double angle_between(hdrp_v3 a, hdrp_v3 b)
{
    double ax = (double)a.x, ay = (double)a.y, az = (double)a.z;
    double bx = (double)b.x, by = (double)b.y, bz = (double)b.z;
    double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    return atan2(sqrt(x * x + y * y + z * z), ax * bx + ay * by + az * bz);
}

/* A lit direction is within the half angle that the record states. */
static void bounds_by_the_half_angle_hold_all_light(void** state)
{
    (void)state;
    uint64_t random = 5u;
    for (int i = 0; i < 200000; ++i) {
        double outer = i % 2 ? exp(log(1e-5) + test_random(&random) * log(3.14159265 / 1e-5))
                             : 3.14159274 - exp(log(1e-5) + test_random(&random) * log(1e4));
        double inner = i % 4 < 2 ? outer : outer * test_random(&random);
        double polar = acos(2.0 * test_random(&random) - 1.0);
        hdrp_v3 f = at(v3(0.0f, 0.0f, 0.0f), polar, 2.0 * PI * test_random(&random), 1.0);
        hdrp_light l = hdrp_light_spot(v3(0.0f, 0.0f, 0.0f), f, hdrp_v3_splat(1.0f),
                                       HDRP_LIGHT_RANGE_INFINITE, (float)inner, (float)outer);
        double bound = atan2((double)l.half_angle.y, (double)l.half_angle.x);
        double angle = bound + (i % 8 ? exp(log(1e-9) + test_random(&random) * log(1e9)) : 0.0);
        hdrp_basis b = hdrp_basis_from_normal(f);
        hdrp_v3 p = hdrp_v3_add(hdrp_v3_scale(f, (float)cos(angle)),
                                hdrp_v3_scale(b.tangent, (float)sin(angle)));
        assert_true(bound >= (double)(float)outer - 1e-9);
        assert_true(outer > 1.5 || bound < outer * (1.0 + 7e-5) + 3e-7);
        if (angle_between(f, p) > bound) {
            assert_true(is_black(hdrp_light_eval(l, p).illuminance));
        }
    }
}

static void a_pyramid_is_dark_beyond_its_half_angles(void** state)
{
    (void)state;
    uint64_t random = 6u;
    for (int i = 0; i < 200000; ++i) {
        double polar = acos(2.0 * test_random(&random) - 1.0);
        hdrp_v3 f = at(v3(0.0f, 0.0f, 0.0f), polar, 2.0 * PI * test_random(&random), 1.0);
        float half = (float)exp(log(1e-5) + test_random(&random) * log(1.57 / 1e-5));
        hdrp_light l =
            hdrp_light_pyramid(v3(0.0f, 0.0f, 0.0f), f, v3(0.1f, 1.0f, 0.3f), hdrp_v3_splat(1.0f),
                               HDRP_LIGHT_RANGE_INFINITE, half, half, (float)test_random(&random));
        hdrp_v4 side = i % 2 ? l.right_half_width : l.up_half_height;
        double bound = i % 2 ? atan2((double)l.half_angle.y, (double)l.half_angle.x)
                             : atan2((double)l.half_angle.w, (double)l.half_angle.z);
        double angle = bound + exp(log(3e-7) + test_random(&random) * log(1e6));
        hdrp_v3 p = hdrp_v3_add(hdrp_v3_scale(f, (float)cos(angle)),
                                hdrp_v3_scale(hdrp_v3_from_v4(side), (float)sin(angle)));
        if (angle_between(f, p) > bound + 3e-7) {
            assert_true(is_black(hdrp_light_eval(l, p).illuminance));
        }
    }
}

static void unknown_and_area_lights_are_dark(void** state)
{
    (void)state;
    hdrp_light l = hdrp_light_point(v3(0.0f, 1.0f, 0.0f), hdrp_v3_splat(1.0f), 10.0f);
    hdrp_light zero;
    memset(&zero, 0, sizeof zero);
    assert_true(is_black(hdrp_light_eval(zero, hdrp_v3_splat(0.0f)).illuminance));
    assert_true(hdrp_v3_length(hdrp_light_eval(zero, hdrp_v3_splat(0.0f)).l) == 1.0f);
    for (hdrp_u32 type = HDRP_LIGHT_TYPE_SPHERE; type <= HDRP_LIGHT_TYPE_MASK; ++type) {
        l.bits.x = type;
        assert_true(is_black(hdrp_light_eval(l, hdrp_v3_splat(0.0f)).illuminance));
    }
}

static void expect_v4(hdrp_v4 v, float x, float y, float z, float w)
{
    assert_true(v.x == x && v.y == y && v.z == z && v.w == w);
}

/* Cosine and sine of both half angles: of all directions, and of one. */
static void lights_without_a_cone_have_the_half_angles_of_all_or_none(void** state)
{
    hdrp_v3 one = hdrp_v3_splat(1.0f), none = hdrp_v3_splat(0.0f);
    (void)state;
    expect_v4(hdrp_light_point(none, one, 10.0f).half_angle, -1.0f, 0.0f, -1.0f, 0.0f);
    expect_v4(hdrp_light_directional(one, one, 0.0f).half_angle, 1.0f, 0.0f, 1.0f, 0.0f);
    expect_v4(hdrp_light_box(none, one, one, one, 1.0f, 1.0f, 1.0f, 0.5f).half_angle, 1.0f, 0.0f,
              1.0f, 0.0f);
}

static void a_light_without_a_direction_shines_down(void** state)
{
    hdrp_v3 none = hdrp_v3_splat(0.0f);
    (void)state;
    expect_v4(hdrp_light_spot(none, none, none, 1.0f, 0.1f, 0.2f).forward_radius, 0.0f, -1.0f, 0.0f,
              0.0f);
}

static void a_hard_edge_has_a_ten_thousandth_of_a_box(void** state)
{
    hdrp_v3 none = hdrp_v3_splat(0.0f), one = hdrp_v3_splat(1.0f);
    (void)state;
    float slope = hdrp_light_box(none, one, none, one, 3.0f, 2.0f, 4.0f, 0.0f).edge_importance.x;
    assert_true(fabsf(slope - 5000.0f) < 0.01f);
}

static void layers_link_lights_to_surfaces(void** state)
{
    (void)state;
    hdrp_light l = hdrp_light_point(v3(0.0f, 1.0f, 0.0f), hdrp_v3_splat(1.0f), 10.0f);
    assert_int_equal(hdrp_light_affects(l, 0x80000000u), 1);
    assert_int_equal(hdrp_light_affects(l, 0u), 0);
    l.bits.y = 6u;
    assert_int_equal(hdrp_light_affects(l, 1u), 0);
    assert_int_equal(hdrp_light_affects(l, 4u), 1);
    l.bits.x |= HDRP_LIGHT_FEATURE_SHADOW;
    assert_int_equal(hdrp_light_type(l), HDRP_LIGHT_TYPE_POINT);
}

static void a_place_or_range_that_is_no_number_makes_a_light_dark(void** state)
{
    (void)state;
    float bad[] = {NAN, INFINITY, -INFINITY, 2e18f};
    for (int i = 0; i < 4; ++i) {
        hdrp_light l = hdrp_light_point(v3(0.0f, bad[i], 0.0f), hdrp_v3_splat(1.0f), 10.0f);
        assert_true(is_black(hdrp_v3_from_v4(l.color_inv_range_sq)));
        assert_true(l.position_range.y == 0.0f && l.edge_importance.w == 0.0f);
    }
    float no_range[] = {NAN, 0.0f, -1.0f, -INFINITY};
    for (int i = 0; i < 4; ++i) {
        hdrp_light l = hdrp_light_point(v3(0.0f, 0.0f, 0.0f), hdrp_v3_splat(1.0f), no_range[i]);
        assert_true(is_black(hdrp_light_eval(l, v3(0.0f, 0.0f, 0.0f)).illuminance));
    }
    hdrp_light l = hdrp_light_point(v3(0.0f, 0.0f, 0.0f), v3(NAN, -1.0f, INFINITY), 10.0f);
    assert_true(l.color_inv_range_sq.x == 0.0f && l.color_inv_range_sq.y == 0.0f);
    assert_true(l.color_inv_range_sq.z == HDRP_LIGHT_COLOR_MAX);
}

static bool is_same(hdrp_light_incident a, hdrp_light_incident b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static void each_type_has_a_function_of_its_own(void** state)
{
    (void)state;
    hdrp_v3 p = v3(0.0f, 3.0f, 0.0f), down = v3(0.0f, -1.0f, 0.0f), up = v3(1.0f, 0.0f, 0.0f);
    hdrp_v3 color = v3(3.0f, 2.0f, 1.0f), q = v3(0.1f, 1.0f, 0.2f);
    hdrp_light sun = hdrp_light_directional(down, color, 0.0f);
    hdrp_light point = hdrp_light_point(p, color, 9.0f);
    hdrp_light spot = hdrp_light_spot(p, down, color, 9.0f, 0.1f, 0.5f);
    hdrp_light pyramid = hdrp_light_pyramid(p, down, up, color, 9.0f, 0.5f, 0.4f, 0.9f);
    hdrp_light box = hdrp_light_box(p, down, up, color, 1.0f, 1.0f, 3.0f, 1.0f);
    assert_true(is_same(hdrp_light_eval(sun, q), hdrp_light_eval_directional(sun)));
    assert_true(is_same(hdrp_light_eval(point, q), hdrp_light_eval_point(point, q)));
    assert_true(is_same(hdrp_light_eval(spot, q), hdrp_light_eval_spot(spot, q)));
    assert_true(is_same(hdrp_light_eval(pyramid, q), hdrp_light_eval_pyramid(pyramid, q)));
    assert_true(is_same(hdrp_light_eval(box, q), hdrp_light_eval_box(box, q)));
    assert_false(is_same(hdrp_light_eval(spot, q), hdrp_light_eval(pyramid, q)));
    assert_false(is_same(hdrp_light_eval(spot, q), hdrp_light_eval(point, q)));
}

static bool is_finite3(hdrp_v3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static void expect_sound(hdrp_light l, hdrp_v3 position)
{
    hdrp_light_incident i = hdrp_light_eval(l, position);
    float c = hdrp_v3_dot(hdrp_v3_from_v4(l.right_half_width), hdrp_v3_from_v4(l.forward_radius));
    assert_true(is_finite3(i.illuminance));
    assert_true(i.illuminance.x >= 0.0f && i.illuminance.y >= 0.0f && i.illuminance.z >= 0.0f);
    assert_true(i.distance_m >= 0.0f && i.distance_m <= HDRP_LIGHT_DISTANCE_INFINITE);
    assert_true(fabsf(hdrp_v3_length(i.l) - 1.0f) < 1e-6f);
    assert_true(fabsf(c) < 1e-6f);
    assert_true(fabsf(hdrp_sq(l.half_angle.x) + hdrp_sq(l.half_angle.y) - 1.0f) < 1e-6f);
    assert_true(l.position_range.w >= 0.0f && isfinite(l.edge_importance.y));
}

/* Every argument of every maker takes every value, one at a time and all at once, and the result is
 * evaluated at every place. */
static void a_record_of_anything_is_sound(void** state)
{
    (void)state;
    static const float values[] = {
        NAN,  INFINITY, -INFINITY,  0.0f,  -0.0f,  1e-45f,  1.1754e-38f, 1e-18f,      1e-15f, 0.5f,
        1.0f, -1.0f,    1.0000001f, 1e18f, -1e18f, 3.4e38f, -3.4e38f,    3.14159274f, 100.0f};
    static const float places[] = {0.0f,   1e-45f, -1e-18f, 1e-15f, 1.0f,
                                   -0.25f, 1e9f,   1e18f,   -1e18f};
    const int count = (int)(sizeof values / sizeof values[0]);
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < 17; ++k) {
            float x[16] = {0.0f, 0.0f, 0.0f, 0.0f, -1.0f, 0.0f, 1.0f, 0.0f,
                           0.0f, 2.0f, 9.0f, 0.4f, 0.5f,  0.3f, 0.6f, 0.7f};
            for (int n = 0; n < 16; ++n) {
                x[n] = k == n || k == 16 ? values[i] : x[n];
            }
            hdrp_v3 p = v3(x[0], x[1], x[2]), f = v3(x[3], x[4], x[5]), up = v3(x[6], x[7], x[8]);
            hdrp_v3 color = hdrp_v3_splat(x[9]);
            for (int j = 0; j < 81; ++j) {
                hdrp_v3 q = v3(places[j % 9], places[j / 9], places[(j + i) % 9]);
                expect_sound(hdrp_light_point(p, color, x[10]), q);
                expect_sound(hdrp_light_spot(p, f, color, x[10], x[11], x[12]), q);
                expect_sound(hdrp_light_pyramid(p, f, up, color, x[10], x[11], x[12], x[13]), q);
                expect_sound(hdrp_light_box(p, f, up, color, x[10], x[11], x[14], x[15]), q);
                expect_sound(hdrp_light_directional(f, color, x[13]), q);
            }
        }
    }
}

static void the_layout_is_the_documented_one(void** state)
{
    (void)state;
    assert_int_equal(sizeof(hdrp_light), 128);
    assert_int_equal(offsetof(hdrp_light, color_inv_range_sq), 16);
    assert_int_equal(offsetof(hdrp_light, forward_radius), 64);
    assert_int_equal(offsetof(hdrp_light, bits), 112);
    assert_int_equal(HDRP_LIGHT_LAYOUT_VERSION, 1);
}

static void sources_are_seen_at_an_angle(void** state)
{
    hdrp_light lamp = hdrp_light_point(v3(0, 3, 0), v3(1, 1, 1), 10.0f);
    hdrp_light sun = hdrp_light_directional(v3(0, -1, 0), v3(1, 1, 1), 0.2f);
    hdrp_light box =
        hdrp_light_box(v3(0, 3, 0), v3(0, -1, 0), v3(1, 0, 0), v3(1, 1, 1), 1.0f, 1.0f, 5.0f, 0.1f);
    hdrp_light_incident i = hdrp_light_eval(lamp, v3(0, 0, 0));
    float sine;
    (void)state;
    assert_true(hdrp_light_sine(lamp, i) == 0.0f && hdrp_light_variance(lamp, i) == 0.0f);
    lamp.forward_radius.w = 0.5f;
    sine = hdrp_light_sine(lamp, i);
    assert_true(fabsf(sine - 0.5f / 3.0f) < 1e-6f);
    assert_true(fabsf(hdrp_light_variance(lamp, i) - sine * sine / 8.0f) < 1e-8f);
    i.distance_m = 0.1f; /* inside */
    assert_true(hdrp_light_sine(lamp, i) == 0.99f);
    i = hdrp_light_eval(sun, v3(0, 0, 0));
    assert_true(fabsf(hdrp_light_sine(sun, i) - sinf(0.1f)) < 1e-6f);
    box.forward_radius.w = 1.0f;
    assert_true(hdrp_light_sine(box, hdrp_light_eval(box, v3(0, 0, 0))) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_spot_emits_the_requested_flux),
        cmocka_unit_test(a_hard_reflector_emits_the_requested_flux),
        cmocka_unit_test(point_and_pyramid_emit_the_requested_flux),
        cmocka_unit_test(a_pyramid_is_wide_along_its_right_axis),
        cmocka_unit_test(a_point_light_lights_from_where_it_is),
        cmocka_unit_test(nothing_is_lit_beyond_the_range),
        cmocka_unit_test(the_light_s_own_place_is_lit_from_behind_its_axis),
        cmocka_unit_test(the_sun_is_the_same_everywhere),
        cmocka_unit_test(a_box_projects_parallel_rays),
        cmocka_unit_test(bounds_by_the_half_angle_hold_all_light),
        cmocka_unit_test(a_pyramid_is_dark_beyond_its_half_angles),
        cmocka_unit_test(unknown_and_area_lights_are_dark),
        cmocka_unit_test(lights_without_a_cone_have_the_half_angles_of_all_or_none),
        cmocka_unit_test(a_light_without_a_direction_shines_down),
        cmocka_unit_test(a_hard_edge_has_a_ten_thousandth_of_a_box),
        cmocka_unit_test(layers_link_lights_to_surfaces),
        cmocka_unit_test(a_place_or_range_that_is_no_number_makes_a_light_dark),
        cmocka_unit_test(each_type_has_a_function_of_its_own),
        cmocka_unit_test(a_record_of_anything_is_sound),
        cmocka_unit_test(the_layout_is_the_documented_one),
        cmocka_unit_test(sources_are_seen_at_an_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
