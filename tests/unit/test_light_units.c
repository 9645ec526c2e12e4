/* test_light_units.c - photometric units and exposure of hdrp_light.h.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_light.h"

static void expect_near(float value, double expected, double relative)
{
    if (!(fabs((double)value - expected) <= relative * fabs(expected))) {
        fail_msg("%.9g, expected %.9g", (double)value, expected);
    }
}

static void a_narrow_reflector_keeps_its_digits(void** state)
{
    (void)state;
    /* A small cone covers a disc: solid angle pi (angle / 2)^2. */
    float angles[] = {1e-4f, 1e-6f, 1e-9f, 1e-15f};
    for (int i = 0; i < 4; ++i) {
        double expected =
            1000.0 / (3.14159265358979 * 0.25 * (double)angles[i] * (double)angles[i]);
        expect_near(hdrp_light_candela_from_lumen_spot_reflector(1000.0f, angles[i]), expected,
                    1e-6);
    }
    expect_near(hdrp_light_candela_from_lumen_spot_reflector(1e-30f, 1e-33f), 1.2732395e36, 1e-6);
    expect_near(hdrp_light_lumen_from_candela_spot_reflector(1e36f, 1e-30f), 7.8539816e-25, 1e-6);
}

static void a_reflector_of_the_whole_sphere_is_a_point_light(void** state)
{
    (void)state;
    expect_near(hdrp_light_candela_from_lumen_spot_reflector(1000.0f, HDRP_TWO_PI), 79.5774715,
                3e-7);
    expect_near(hdrp_light_candela_from_lumen_point(1000.0f), 79.5774715, 3e-7);
    expect_near(hdrp_light_candela_from_lumen_spot_occluder(1000.0f), 79.5774715, 3e-7);
    expect_near(hdrp_light_lumen_from_candela_spot_occluder(79.5774715f), 1000.0, 3e-7);
    expect_near(hdrp_light_candela_from_lumen_spot(1000.0f, HDRP_PI, HDRP_PI), 79.5774715, 3e-7);
}

static void light_without_a_beam_saturates(void** state)
{
    (void)state;
    assert_true(hdrp_light_candela_from_lumen_spot_reflector(1.0f, 0.0f) == HDRP_FLT_MAX);
    assert_true(hdrp_light_candela_from_lumen_spot_reflector(0.0f, 0.0f) == 0.0f);
    assert_true(hdrp_light_candela_from_lumen_pyramid(1.0f, 0.0f, 1.0f) == HDRP_FLT_MAX);
    assert_true(hdrp_light_candela_from_lumen_pyramid(0.0f, 0.0f, 1.0f) == 0.0f);
    assert_true(hdrp_light_nits_from_lux_sky_disc(1.0f, 0.0f) == HDRP_FLT_MAX);
    assert_true(hdrp_light_lux_from_candela(1.0f, 0.0f) == HDRP_FLT_MAX);
    assert_true(hdrp_light_lux_from_candela(0.0f, 0.0f) == 0.0f);
    assert_true(hdrp_light_lux_sun_from_lux_ground(1.0f, -0.5f) == HDRP_FLT_MAX);
}

/* Quotients and products on the way to a result may leave the range that the result is in. */
static void units_do_not_leave_the_range_before_their_result_does(void** state)
{
    (void)state;
    const double pi = 3.14159265358979323846;
    expect_near(hdrp_light_candela_from_lumen_spot_reflector(2e38f, 1.0f),
                2e38 / (4.0 * pi * pow(sin(0.25), 2.0)), 4e-7);
    expect_near(hdrp_light_candela_from_lumen_spot_reflector(2.93e38f, 4.086f), 3.20531e37, 1e-5);
    expect_near(hdrp_light_candela_from_lumen_spot_reflector(1.2e-38f, 1.0f),
                (double)1.2e-38f / (4.0 * pi * pow(sin(0.25), 2.0)), 4e-7);
    expect_near(hdrp_light_lumen_from_candela_spot_reflector(3.4e38f, 1.1f),
                (double)3.4e38f * 4.0 * pi * pow(sin(0.275), 2.0), 4e-7);
    expect_near(hdrp_light_nits_from_lux_sky_disc(2.9e38f, 2.0f),
                2.9e38 / (pi * pow(sin(1.0), 2.0)), 4e-7);
    /* A solid angle of 3e-42 sr is no normal number, and 1e-56 none at all. */
    expect_near(hdrp_light_candela_from_lumen_pyramid(1e-3f, 4.2e-29f, 7.5e-14f),
                (double)1e-3f / ((double)4.2e-29f * (double)7.5e-14f), 4e-7);
    expect_near(hdrp_light_lumen_from_candela_pyramid(4e37f, 1e-28f, 1e-28f),
                (double)4e37f * (double)1e-28f * (double)1e-28f, 4e-7);
}

static void a_pyramid_covers_what_geometry_says(void** state)
{
    (void)state;
    /* Faces of a cube seen from its centre, an octant pair, a hemisphere, and a small rectangle. */
    expect_near(hdrp_light_solid_angle_pyramid(HDRP_HALF_PI, HDRP_HALF_PI), 2.0943951, 3e-7);
    expect_near(hdrp_light_solid_angle_pyramid(HDRP_PI, HDRP_HALF_PI), 3.1415927, 3e-7);
    expect_near(hdrp_light_solid_angle_pyramid(HDRP_PI, HDRP_PI), 6.2831853, 3e-7);
    expect_near(hdrp_light_solid_angle_pyramid(1e-9f, 1e-12f), 1e-21, 3e-7);
}

static void a_round_trip_gives_the_flux_back(void** state)
{
    (void)state;
    float angles[] = {1e-12f, 1e-3f, 0.5f, 3.0f};
    for (int i = 0; i < 4; ++i) {
        float x = angles[i], y = 0.7f * x;
        expect_near(hdrp_light_lumen_from_candela_spot_reflector(
                        hdrp_light_candela_from_lumen_spot_reflector(800.0f, x), x),
                    800.0, 5e-7);
        expect_near(hdrp_light_lumen_from_candela_pyramid(
                        hdrp_light_candela_from_lumen_pyramid(800.0f, x, y), x, y),
                    800.0, 5e-7);
        expect_near(hdrp_light_lumen_from_candela_spot(
                        hdrp_light_candela_from_lumen_spot(800.0f, y, x), y, x),
                    800.0, 5e-7);
        expect_near(
            hdrp_light_lux_from_nits_sky_disc(hdrp_light_nits_from_lux_sky_disc(800.0f, x), x),
            800.0, 5e-7);
        expect_near(
            hdrp_light_lumen_from_nits_sphere(hdrp_light_nits_from_lumen_sphere(800.0f, x), x),
            800.0, 5e-7);
    }
}

static void area_lights_match_their_definitions(void** state)
{
    (void)state;
    /* A Lambertian square metre emits pi times its luminance. */
    expect_near(hdrp_light_nits_from_lumen_rectangle(3.14159265f, 2.0f, 0.5f), 1.0, 3e-7);
    expect_near(hdrp_light_nits_from_lumen_disc(3.14159265f, 0.56418958f), 1.0, 3e-7);
    expect_near(hdrp_light_nits_from_lumen_sphere(3.14159265f, 0.28209479f), 1.0, 3e-7);
    /* A line stands for a cylinder: of radius 1/(2 pi) m, a metre of it has a square metre. */
    expect_near(hdrp_light_nits_from_lumen_line(3.14159265f, 1.0f), 0.159154943, 3e-7);
    expect_near(hdrp_light_candela_m_from_lumen_line_isotropic(12.5663706f, 2.0f), 0.5, 3e-7);
    assert_true(hdrp_light_nits_from_lumen_sphere(1.0f, 0.0f) ==
                hdrp_light_nits_from_lumen_sphere(1.0f, HDRP_LIGHT_SIZE_MIN_M));
}

static void the_sun_has_its_known_luminance(void** state)
{
    (void)state;
    /* 100,000 lux from a disc of 0.533 degrees: about 1.5e9 nits at the ground. */
    expect_near(hdrp_light_nits_from_lux_sky_disc(1e5f, 0.0093026f), 1.471e9, 2e-3);
    expect_near(hdrp_light_nits_from_lux_sky_disc(3.14159265f, HDRP_PI), 1.0, 3e-7);
    assert_true(hdrp_light_lux_ground_from_lux_sun(1e5f, HDRP_HALF_PI) == 1e5f);
    assert_true(hdrp_light_lux_ground_from_lux_sun(1e5f, -0.1f) == 0.0f);
    expect_near(hdrp_light_lux_ground_from_lux_sun(1e5f, 0.52359878f), 5e4, 3e-7);
}

static void illuminance_follows_the_inverse_square(void** state)
{
    (void)state;
    expect_near(hdrp_light_lux_from_candela(100.0f, 5.0f), 4.0, 1e-7);
    expect_near(hdrp_light_candela_from_lux(4.0f, 5.0f), 100.0, 1e-7);
    expect_near(hdrp_light_lux_from_candela(1e30f, 1e25f), 1e-20, 3e-7);
    expect_near(hdrp_light_lux_from_candela(1e-30f, 1e-25f), 1e20, 3e-7);
}

static void camera_settings_give_the_tabulated_ev(void** state)
{
    (void)state;
    /* Nominal f-numbers and times are rounded: whole EVs within a sixth of a stop. */
    static const float table[][4] = {
        {16.0f, 125.0f, 100.0f, 15.0f},  {1.0f, 1.0f, 100.0f, 0.0f},
        {2.8f, 60.0f, 100.0f, 9.0f},     {5.6f, 250.0f, 100.0f, 13.0f},
        {22.0f, 1000.0f, 100.0f, 19.0f}, {1.4f, 1.0f / 8, 100.0f, -2.0f},
        {16.0f, 125.0f, 200.0f, 14.0f},  {4.0f, 15.0f, 1600.0f, 4.0f},
    };
    for (int i = 0; i < 8; ++i) {
        float ev = hdrp_light_ev100_from_camera(table[i][0], 1.0f / table[i][1], table[i][2]);
        if (!(fabsf(ev - table[i][3]) <= 1.0f / 6.0f)) {
            fail_msg("row %d: EV %.3f, expected %.0f", i, (double)ev, (double)table[i][3]);
        }
    }
}

static void meters_agree_with_published_values(void** state)
{
    (void)state;
    /* EV 15, a sunny scene: 4096 nits, 82 klux (the tables of camera makers). */
    expect_near(hdrp_light_nits_from_ev100(15.0f), 4096.0, 3e-7);
    expect_near(hdrp_light_lux_from_ev100(15.0f), 81920.0, 3e-7);
    expect_near(hdrp_light_ev100_from_nits(4096.0f), 15.0, 3e-7);
    expect_near(hdrp_light_ev100_from_lux(81920.0f), 15.0, 3e-7);
}

static void exposure_follows_the_standard(void** state)
{
    (void)state;
    /* ISO 12232 at f/1, 1 s, ISO 100: 0.65 L t / N^2 reaches 78 / 100 lux s at 1.2 nits; 10 / 100
     * at 0.1538 nits, which is to print as 0.18. */
    float ev = hdrp_light_ev100_from_camera(1.0f, 1.0f, 100.0f);
    expect_near(hdrp_light_nits_max_saturation(ev), 1.2, 3e-7);
    expect_near(hdrp_light_exposure_saturation(ev) * 1.2f, 1.0, 3e-7);
    expect_near(hdrp_light_exposure_standard_output(ev) * 0.153846154f, 0.18, 3e-7);
    expect_near(hdrp_light_nits_max_standard_output(ev), 0.854700855, 3e-7);
    /* What a meter with K = 12.5 reads renders as K q / 78 and as K q 0.18 / 10. */
    float metered = hdrp_light_nits_from_ev100(9.0f);
    expect_near(metered * hdrp_light_exposure_saturation(9.0f), 0.104166667, 3e-7);
    expect_near(metered * hdrp_light_exposure_standard_output(9.0f), 0.14625, 3e-7);
    /* A compensation of one stop doubles the image. */
    expect_near(hdrp_light_exposure_saturation(hdrp_light_ev100_compensated(12.0f, 1.0f)),
                2.0 * (double)hdrp_light_exposure_saturation(12.0f), 3e-7);
}

static void bad_settings_stay_finite(void** state)
{
    (void)state;
    float bad[] = {NAN, INFINITY, -INFINITY, 0.0f, -1.0f};
    for (int i = 0; i < 5; ++i) {
        assert_true(isfinite(hdrp_light_ev100_from_camera(bad[i], bad[i], bad[i])));
        assert_true(isfinite(hdrp_light_ev100_from_nits(bad[i])));
        assert_true(isfinite(hdrp_light_ev100_from_lux(bad[i])) || bad[i] == INFINITY);
        assert_true(isfinite(hdrp_light_exposure_saturation(bad[i])));
        assert_true(isfinite(hdrp_light_exposure_standard_output(bad[i])));
        assert_true(isfinite(hdrp_light_solid_angle_cone(bad[i])));
        assert_true(isfinite(hdrp_light_solid_angle_pyramid(bad[i], bad[i])));
        assert_true(isfinite(hdrp_light_solid_angle_spot(bad[i], bad[i])));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_narrow_reflector_keeps_its_digits),
        cmocka_unit_test(a_reflector_of_the_whole_sphere_is_a_point_light),
        cmocka_unit_test(light_without_a_beam_saturates),
        cmocka_unit_test(units_do_not_leave_the_range_before_their_result_does),
        cmocka_unit_test(a_pyramid_covers_what_geometry_says),
        cmocka_unit_test(a_round_trip_gives_the_flux_back),
        cmocka_unit_test(area_lights_match_their_definitions),
        cmocka_unit_test(the_sun_has_its_known_luminance),
        cmocka_unit_test(illuminance_follows_the_inverse_square),
        cmocka_unit_test(camera_settings_give_the_tabulated_ev),
        cmocka_unit_test(meters_agree_with_published_values),
        cmocka_unit_test(exposure_follows_the_standard),
        cmocka_unit_test(bad_settings_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
