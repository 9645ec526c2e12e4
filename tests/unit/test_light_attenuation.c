/* test_light_attenuation.c - falloff, cones, pyramids and boxes of hdrp_light.h.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_light.h"

static void light_ends_at_its_range_without_a_crease(void** state)
{
    (void)state;
    float inv = hdrp_light_inv_range_sq(5.0f);
    assert_true(hdrp_light_falloff(25.0f, inv) == 0.0f);
    assert_true(hdrp_light_falloff(1e30f, inv) == 0.0f);
    assert_true(hdrp_light_window(0.0f, inv) == 1.0f);
    /* Near the range r the window is (4 (r - d) / r)^2: a hundredth of the way, 1.6e-3. */
    assert_true(fabsf(hdrp_light_window(4.95f * 4.95f, inv) - 1.55e-3f) < 2e-5f);
    assert_true(hdrp_light_window(4.9995f * 4.9995f, inv) / 0.0005f < 1e-3f);
    /* glTF's window has a crease: slope -4 / r. */
    assert_true(fabsf(hdrp_light_falloff_gltf(4.95f * 4.95f, inv) * 24.5f - 0.0394f) < 2e-4f);
}

static void an_infinite_range_leaves_the_inverse_square(void** state)
{
    (void)state;
    float ranges[] = {HDRP_LIGHT_RANGE_INFINITE, HDRP_FLT_MAX, INFINITY};
    for (int i = 0; i < 3; ++i) {
        assert_true(hdrp_light_inv_range_sq(ranges[i]) == 0.0f);
    }
    assert_true(hdrp_light_falloff(4.0f, 0.0f) == 0.25f);
    assert_true(hdrp_light_falloff(1e36f, 0.0f) == 1e-36f);
    assert_true(hdrp_light_falloff_gltf(4.0f, 0.0f) == 0.25f);
}

static void light_stops_growing_near_the_lamp(void** state)
{
    (void)state;
    assert_true(hdrp_light_falloff(0.0f, 0.0f) == hdrp_light_falloff(0.9e-4f, 0.0f));
    assert_true(fabsf(hdrp_light_falloff(0.0f, 0.0f) - 1e4f) < 0.01f);
}

static hdrp_v3 tilted(double angle)
{
    return hdrp_v3_make((float)sin(angle), 0.0f, (float)cos(angle));
}

static float cone_at(double angle, hdrp_light_cone_shape cone)
{
    hdrp_v3 axis = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    return hdrp_light_cone_attenuation(hdrp_light_versine(tilted(angle), axis), cone);
}

static void a_cone_is_full_inside_and_empty_outside(void** state)
{
    (void)state;
    double outers[] = {1e-4, 1e-2, 0.5, 1.5707963, 3.0};
    for (int i = 0; i < 5; ++i) {
        double outer = outers[i];
        hdrp_light_cone_shape soft = hdrp_light_cone_shape_make((float)(0.5 * outer), (float)outer);
        hdrp_light_cone_shape hard = hdrp_light_cone_shape_make((float)outer, (float)outer);
        assert_true(cone_at(0.0, soft) == 1.0f && cone_at(0.49 * outer, soft) == 1.0f);
        assert_true(cone_at(0.75 * outer, soft) > 0.1f && cone_at(0.75 * outer, soft) < 0.6f);
        assert_true(cone_at(1.01 * outer, soft) == 0.0f);
        assert_true(cone_at(0.99 * outer, hard) == 1.0f && cone_at(1.01 * outer, hard) == 0.0f);
    }
}

static void a_cone_of_360_degrees_has_no_hole(void** state)
{
    (void)state;
    hdrp_light_cone_shape all = hdrp_light_cone_shape_make(HDRP_PI, HDRP_PI);
    assert_true(cone_at(3.14159265358979, all) == 1.0f);
    assert_true(hdrp_light_cone_attenuation(2.0f, all) == 1.0f);
}

static void cone_angles_in_the_wrong_order_make_a_hard_cone(void** state)
{
    (void)state;
    hdrp_light_cone_shape a = hdrp_light_cone_shape_make(0.7f, 0.3f);
    hdrp_light_cone_shape b = hdrp_light_cone_shape_make(0.3f, 0.3f);
    assert_true(a.versine_outer == b.versine_outer && a.scale == b.scale);
    a = hdrp_light_cone_shape_make(NAN, NAN);
    b = hdrp_light_cone_shape_make(0.0f, HDRP_LIGHT_HALF_ANGLE_MIN);
    assert_true(a.versine_outer == b.versine_outer && a.scale == b.scale);
}

static void a_pyramid_has_the_corners_of_a_rectangle(void** state)
{
    (void)state;
    /* Faces at tan = 0.5 and 0.25. A place on the plane z = 1 is inside up to those. */
    hdrp_light_pyramid_shape p = hdrp_light_pyramid_shape_make(atanf(0.5f), atanf(0.25f), 0.0f);
    for (int i = -1; i <= 1; i += 2) {
        for (int k = -1; k <= 1; k += 2) {
            float x = 0.499f * (float)i, y = 0.2495f * (float)k;
            hdrp_v3 inside = hdrp_v3_normalize(hdrp_v3_make(x, y, 1.0f));
            hdrp_v3 beside = hdrp_v3_normalize(hdrp_v3_make(x * 1.004f, y, 1.0f));
            hdrp_v3 above = hdrp_v3_normalize(hdrp_v3_make(x, y * 1.004f, 1.0f));
            assert_true(hdrp_light_pyramid_attenuation(inside, p) == 1.0f);
            assert_true(hdrp_light_pyramid_attenuation(beside, p) == 0.0f);
            assert_true(hdrp_light_pyramid_attenuation(above, p) == 0.0f);
        }
    }
    assert_true(hdrp_light_pyramid_attenuation(hdrp_v3_make(0.0f, 0.0f, -1.0f), p) == 0.0f);
}

static void a_pyramid_of_180_degrees_is_a_hemisphere(void** state)
{
    (void)state;
    hdrp_light_pyramid_shape p = hdrp_light_pyramid_shape_make(HDRP_HALF_PI, HDRP_HALF_PI, 0.0f);
    assert_true(hdrp_light_pyramid_attenuation(tilted(1.5706), p) == 1.0f);
    assert_true(hdrp_light_pyramid_attenuation(tilted(1.571), p) == 0.0f);
}

static void a_soft_pyramid_fades_from_the_axis(void** state)
{
    (void)state;
    hdrp_light_pyramid_shape p = hdrp_light_pyramid_shape_make(0.4f, 0.4f, 1.0f);
    float last = hdrp_light_pyramid_attenuation(tilted(0.0), p);
    assert_true(last > 0.999999f);
    for (int i = 1; i <= 40; ++i) {
        float next = hdrp_light_pyramid_attenuation(tilted(0.01 * i), p);
        assert_true(next < last);
        last = next;
    }
    assert_true(last < 1e-9f);
}

static void a_box_is_lit_between_its_faces(void** state)
{
    (void)state;
    hdrp_v3 middle = hdrp_v3_make(0.0f, 0.0f, 2.0f);
    assert_true(hdrp_light_box_attenuation(middle, 1.0f, 0.5f, 4.0f, 4.0f) == 1.0f);
    /* Halfway through a border of 0.25 m: (1/2)^2. */
    assert_true(hdrp_light_box_attenuation(hdrp_v3_make(0.875f, 0.0f, 2.0f), 1.0f, 0.5f, 4.0f,
                                           4.0f) == 0.25f);
    assert_true(hdrp_light_box_attenuation(hdrp_v3_make(0.0f, -0.375f, 2.0f), 1.0f, 0.5f, 4.0f,
                                           4.0f) == 0.25f);
    assert_true(hdrp_light_box_attenuation(hdrp_v3_make(0.0f, 0.0f, 3.875f), 1.0f, 0.5f, 4.0f,
                                           4.0f) == 0.25f);
    /* The emitting face is hard, the others end at 0. */
    assert_true(
        hdrp_light_box_attenuation(hdrp_v3_make(0.0f, 0.0f, 0.0f), 1.0f, 0.5f, 4.0f, 4.0f) == 1.0f);
    assert_true(hdrp_light_box_attenuation(hdrp_v3_make(0.0f, 0.0f, -1e-6f), 1.0f, 0.5f, 4.0f,
                                           4.0f) == 0.0f);
    assert_true(hdrp_light_box_attenuation(hdrp_v3_make(-1.0f, 0.0f, 2.0f), 1.0f, 0.5f, 4.0f,
                                           4.0f) == 0.0f);
    assert_true(
        hdrp_light_box_attenuation(hdrp_v3_make(0.0f, 0.0f, 4.0f), 1.0f, 0.5f, 4.0f, 4.0f) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_ends_at_its_range_without_a_crease),
        cmocka_unit_test(an_infinite_range_leaves_the_inverse_square),
        cmocka_unit_test(light_stops_growing_near_the_lamp),
        cmocka_unit_test(a_cone_is_full_inside_and_empty_outside),
        cmocka_unit_test(a_cone_of_360_degrees_has_no_hole),
        cmocka_unit_test(cone_angles_in_the_wrong_order_make_a_hard_cone),
        cmocka_unit_test(a_pyramid_has_the_corners_of_a_rectangle),
        cmocka_unit_test(a_pyramid_of_180_degrees_is_a_hemisphere),
        cmocka_unit_test(a_soft_pyramid_fades_from_the_axis),
        cmocka_unit_test(a_box_is_lit_between_its_faces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
