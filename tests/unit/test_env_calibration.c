/* test_env_calibration.c - illuminance of images, the multiplier for a wanted one, and the sun.
 * SPDX-License-Identifier: MIT */
#define HDRP_ENV_IMPLEMENTATION
#include "env_test.h"

static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {1, 2}, {3, 3}, {5, 7}, {64, 32}, {100, 33}};

static void a_constant_sky_gives_pi_times_its_radiance(void** state)
{
    (void)state;
    for (int i = 0; i < 14; ++i) {
        hdrp_env_image_kind kind = (hdrp_env_image_kind)(i % 2);
        hdrp_env_image image = test_image(
            kind, sizes[i / 2][0], kind == HDRP_ENV_CUBE ? sizes[i / 2][0] : sizes[i / 2][1], 5.0f);
        hdrp_env_stats stats = {0};
        assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
        test_near(stats.illuminance_lux / (5.0 * TEST_PI), 1.0, 1e-6);
        test_near(stats.average_nits / 5.0, 1.0, 1e-6);
        test_near(stats.peak_nits / 5.0, 1.0, 1e-6);
        assert_true(stats.peak_row == 0u && stats.peak_column == 0u && stats.invalid_texels == 0u);
        free(image.texels);
    }
}

static void only_the_upper_hemisphere_counts(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 8u, 6u, 0.0f);
    hdrp_env_stats stats = {0};
    for (uint32_t i = 0; i < 3u * 8u * 3u; ++i) {
        image.texels[i] = 2.0f;
    }
    assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
    test_near(stats.illuminance_lux, 2.0 * TEST_PI, 1e-5);
    test_near(stats.average_nits, 1.0, 1e-6);
    for (uint32_t i = 0; i < 3u * 8u * 6u; ++i) {
        image.texels[i] = i < 3u * 8u * 3u ? 0.0f : 2.0f;
    }
    assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
    assert_true(stats.illuminance_lux == 0.0);
    assert_int_equal(stats.peak_row, 3);
    free(image.texels);
}

/* Cube of 3: the middle row of a side face is half above the horizon. */
static void a_cube_is_cut_at_the_horizon_inside_a_row(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_CUBE, 3u, 3u, 1.0f);
    hdrp_env_stats all = {0}, without = {0};
    for (uint32_t k = 0; k < 6u * 9u; ++k) {
        bool below = k / 9u == 3u || (k / 9u != 2u && k / 3u % 3u == 2u);
        for (uint32_t c = 0; c < 3u; ++c) {
            image.texels[3u * k + c] = below ? 1000.0f : 1.0f;
        }
    }
    assert_int_equal(hdrp_env_measure(&image, &all), HDRP_OK);
    test_near(all.illuminance_lux, TEST_PI, 3e-6);
    for (uint32_t k = 0; k < 6u * 9u; ++k) {
        if (k / 9u != 2u && k / 9u != 3u && k / 3u % 3u == 1u) {
            memset(image.texels + 3u * k, 0, 3u * sizeof(float));
        }
    }
    /* The middle rows hold what lies below |y| = 1/3 on the walls: 4 (F(0) - F(1/3)) / 2. */
    assert_int_equal(hdrp_env_measure(&image, &without), HDRP_OK);
    double c = sqrt(1.0 + 1.0 / 9.0), strip = TEST_PI - 4.0 * atan(1.0 / c) / c;
    test_near(all.illuminance_lux - without.illuminance_lux, strip, 3e-6);
    free(image.texels);
}

static void measuring_does_not_depend_on_the_split(void** state)
{
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        hdrp_env_image image = test_random_image((hdrp_env_image_kind)kind, 12u, 12u);
        uint32_t rows = hdrp_env_image_rows(&image);
        hdrp_env_row record[72];
        hdrp_env_stats whole = {0}, split = {0};
        assert_int_equal(hdrp_env_measure(&image, &whole), HDRP_OK);
        for (uint32_t step = 1; step <= rows; ++step) {
            memset(record, 0xff, sizeof record);
            for (uint32_t end = rows; end > 0u; end -= end < step ? end : step) {
                uint32_t first = end < step ? 0u : end - step;
                assert_int_equal(hdrp_env_measure_rows(&image, first, end - first, record),
                                 HDRP_OK);
            }
            assert_int_equal(hdrp_env_stats_from_rows(&image, record, &split), HDRP_OK);
            assert_memory_equal(&whole, &split, sizeof whole);
        }
        free(image.texels);
    }
}

static void the_multiplier_brings_the_wanted_illuminance(void** state)
{
    (void)state;
    hdrp_env_image image = test_random_image(HDRP_ENV_LATLONG, 64u, 32u);
    hdrp_env_stats stats = {0};
    float multiplier = 0.0f;
    image.nits_per_unit = 0.25f;
    assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
    assert_int_equal(hdrp_env_lux_multiplier(&stats, 20000.0, &multiplier), HDRP_OK);
    image.nits_per_unit *= multiplier;
    assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
    test_near(stats.illuminance_lux / 20000.0, 1.0, 2e-7);
    free(image.texels);
}

static void no_multiplier_for_black_invalid_or_nonsense(void** state)
{
    (void)state;
    double wanted[] = {0.0, -1.0, (double)NAN, (double)INFINITY, 1e13};
    float texel[] = {NAN, INFINITY, -1.0f};
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 4u, 4u, 1.0f);
    hdrp_env_stats stats = {0};
    float multiplier = 7.0f;
    assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
    for (int i = 0; i < 5; ++i) {
        assert_int_equal(hdrp_env_lux_multiplier(&stats, wanted[i], &multiplier),
                         HDRP_ERROR_BAD_ARGUMENT);
    }
    for (int i = 0; i < 3; ++i) {
        image.texels[10] = texel[i];
        assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
        assert_int_equal(stats.invalid_texels, 1);
        assert_true(stats.illuminance_lux > 0.0 && stats.illuminance_lux < 4.0);
        assert_int_equal(hdrp_env_lux_multiplier(&stats, 1.0, &multiplier),
                         HDRP_ERROR_BAD_ARGUMENT);
    }
    memset(image.texels, 0, sizeof(float) * test_floats(&image));
    assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
    assert_int_equal(hdrp_env_lux_multiplier(&stats, 1.0, &multiplier), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_lux_multiplier(&stats, 1.0, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_lux_multiplier(NULL, 1.0, &multiplier), HDRP_ERROR_NULL_POINTER);
    assert_true(multiplier == 7.0f);
    free(image.texels);
}

/* Above 1e20 nits a texel counts as that: a calibration by such sums would be wrong. */
static void texels_too_bright_to_measure_are_counted_and_not_calibrated(void** state)
{
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        hdrp_env_image image = test_image((hdrp_env_image_kind)kind, 4u, 4u, 1e20f);
        uint32_t rows = hdrp_env_image_rows(&image);
        hdrp_env_stats stats = {0}, split = {0};
        hdrp_env_row record[24];
        hdrp_env_sun sun;
        float multiplier = 7.0f;
        assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
        assert_int_equal(stats.limited_texels, 0);
        assert_int_equal(hdrp_env_lux_multiplier(&stats, 1e5, &multiplier), HDRP_OK);
        image.nits_per_unit = multiplier;
        assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
        test_near(stats.illuminance_lux / 1e5, 1.0, 1e-6);
        multiplier = 7.0f;
        image.nits_per_unit = 1.0001f;
        assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
        assert_int_equal(stats.limited_texels, 4u * rows);
        assert_int_equal(hdrp_env_lux_multiplier(&stats, 1e5, &multiplier),
                         HDRP_ERROR_BAD_ARGUMENT);
        image.nits_per_unit = 1.0f;
        image.texels[10] = 1e30f;
        assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
        assert_true(stats.limited_texels == 1u && stats.invalid_texels == 0u);
        assert_int_equal(hdrp_env_measure_rows(&image, 0u, rows, record), HDRP_OK);
        assert_int_equal(hdrp_env_stats_from_rows(&image, record, &split), HDRP_OK);
        assert_int_equal(split.limited_texels, 1);
        assert_int_equal(hdrp_env_lux_multiplier(&stats, 1e5, &multiplier),
                         HDRP_ERROR_BAD_ARGUMENT);
        assert_int_equal(hdrp_env_find_sun(&image, 0.0f, &sun), HDRP_ERROR_BAD_ARGUMENT);
        assert_true(multiplier == 7.0f);
        free(image.texels);
    }
}

static void errors_leave_results_alone(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 4u, 4u, 1.0f), bad = image;
    hdrp_env_stats stats, before;
    hdrp_env_sun sun, sun_before;
    hdrp_env_row rows[4], rows_before[4];
    bad.width = 0u;
    memset(&stats, 7, sizeof stats);
    memset(&sun, 7, sizeof sun);
    memset(rows, 7, sizeof rows);
    before = stats;
    sun_before = sun;
    memcpy(rows_before, rows, sizeof rows);
    assert_int_equal(hdrp_env_measure(&bad, &stats), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_measure(&image, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_measure_rows(&image, 2u, 3u, rows), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_measure_rows(&image, 0u, 1u, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_stats_from_rows(&bad, rows, &stats), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_stats_from_rows(&image, NULL, &stats), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_find_sun(&bad, 0.0f, &sun), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_find_sun(&image, -1.0f, &sun), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_find_sun(&image, NAN, &sun), HDRP_ERROR_BAD_ARGUMENT);
    image.texels[3] = NAN;
    assert_int_equal(hdrp_env_find_sun(&image, 0.0f, &sun), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_remove_sun(&image, NULL), HDRP_ERROR_NULL_POINTER);
    assert_memory_equal(&stats, &before, sizeof stats);
    assert_memory_equal(&sun, &sun_before, sizeof sun);
    assert_memory_equal(rows, rows_before, sizeof rows);
    free(image.texels);
}

/* A sky with a disc of 1 degree radius; its texels cover solid_angle. */
static hdrp_env_image sky_with_sun(hdrp_env_image_kind kind, hdrp_v3 direction, double* solid_angle)
{
    uint32_t w = kind == HDRP_ENV_CUBE ? 128u : 512u, h = kind == HDRP_ENV_CUBE ? 128u : 256u;
    hdrp_env_image image = test_image(kind, w, h, 1.0f);
    *solid_angle = 0.0;
    for (uint32_t k = 0; k < w * hdrp_env_image_rows(&image); ++k) {
        hdrp_env_place place = {k / w / h, ((float)(k % w) + 0.5f) / (float)w,
                                ((float)(k / w % h) + 0.5f) / (float)h};
        hdrp_v3 d = kind == HDRP_ENV_CUBE
                        ? hdrp_env_direction_from_cube(place)
                        : hdrp_env_direction_from_latlong(hdrp_v2_make(place.u, place.v));
        if (hdrp_v3_dot(d, direction) > 0.99984769f) {
            *solid_angle +=
                (double)(kind == HDRP_ENV_CUBE ? hdrp_env_cube_solid_angle(k % w, k / w % h, w)
                                               : hdrp_env_latlong_solid_angle(k / w, w, h));
            image.texels[3u * k] = 2e5f;
            image.texels[3u * k + 1u] = 1e5f;
            image.texels[3u * k + 2u] = 5e4f;
        }
    }
    return image;
}

static void the_sun_is_found_and_removed(void** state)
{
    (void)state;
    for (int i = 0; i < 8; ++i) {
        hdrp_v3 s = test_unit(cos(i), 0.15 + 0.1 * i, sin(i));
        double solid_angle;
        hdrp_env_image image = sky_with_sun((hdrp_env_image_kind)(i % 2), s, &solid_angle);
        hdrp_env_sun sun = {0};
        hdrp_env_stats before = {0}, after = {0};
        assert_int_equal(hdrp_env_measure(&image, &before), HDRP_OK);
        assert_int_equal(hdrp_env_find_sun(&image, 0.0f, &sun), HDRP_OK);
        assert_true(hdrp_v3_dot(sun.direction, s) > 0.99998f); /* half a texel */
        test_near(acos((double)sun.cos_radius), 0.035, 3e-6);  /* two degrees, as documented */
        test_near((double)sun.solid_angle_sr / solid_angle, 1.0, 1e-6);
        test_near((double)sun.illuminance_lux.y / (1e5 * (double)sun.solid_angle_sr), 1.0, 1e-3);
        test_near((double)sun.illuminance_lux.x / (double)sun.illuminance_lux.z, 4.0, 1e-3);
        test_near_v3(sun.background_nits, 1.0, 1.0, 1.0, 1e-6);
        assert_true(sun.share > 0.8f && sun.share < 1.0f);
        assert_int_equal(hdrp_env_remove_sun(&image, &sun), HDRP_OK);
        assert_int_equal(hdrp_env_measure(&image, &after), HDRP_OK);
        test_near(after.illuminance_lux, TEST_PI, 1e-5);
        for (int c = 0; c < 3; ++c) {
            float lux[3] = {sun.illuminance_lux.x, sun.illuminance_lux.y, sun.illuminance_lux.z};
            double sum = after.illuminance_lux_rgb[c] + (double)lux[c] * (double)sun.direction.y;
            test_near(sum / before.illuminance_lux_rgb[c], 1.0, 1e-6);
        }
        free(image.texels);
    }
}

/* A faint sun among dark texels: they are no light to take out, and stay. */
static void dark_texels_near_the_sun_stay(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 180u, 90u, 10.0f);
    hdrp_env_stats before = {0}, after = {0};
    hdrp_env_sun sun = {0};
    for (uint32_t y = 28; y < 33; ++y) {
        for (uint32_t x = 88; x < 93; ++x) {
            float v = x == 90u && y == 30u ? 500.0f : 2.0f;
            image.texels[3u * (180u * y + x)] = v;
            image.texels[3u * (180u * y + x) + 1u] = v;
            image.texels[3u * (180u * y + x) + 2u] = v;
        }
    }
    assert_int_equal(hdrp_env_measure(&image, &before), HDRP_OK);
    assert_int_equal(hdrp_env_find_sun(&image, 0.1f, &sun), HDRP_OK);
    assert_int_equal(hdrp_env_remove_sun(&image, &sun), HDRP_OK);
    assert_int_equal(hdrp_env_measure(&image, &after), HDRP_OK);
    test_near(
        (after.illuminance_lux + (double)(hdrp_luminance(sun.illuminance_lux) * sun.direction.y)) /
            before.illuminance_lux,
        1.0, 1e-6);
    assert_true(image.texels[3u * (180u * 30u + 89u)] == 2.0f);
    assert_true(sun.illuminance_lux.y > 0.0f && image.texels[3u * (180u * 30u + 90u)] <= 10.0f);
    free(image.texels);
}

/* One texel at the peak, one just above half of it, one just below, which is not part of the disc of light. */
static void the_solid_angle_of_a_sun_ends_at_half_its_peak(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 180u, 90u, 1.0f);
    hdrp_env_sun sun = {0};
    for (uint32_t i = 0; i < 3u; ++i) {
        float* texel = image.texels + 3u * (180u * 30u + 90u + i);
        texel[0] = texel[1] = texel[2] = i == 0u ? 1000.0f : i == 1u ? 500.2f : 499.8f;
    }
    assert_int_equal(hdrp_env_find_sun(&image, 0.2f, &sun), HDRP_OK);
    test_near((double)sun.solid_angle_sr /
                  (2.0 * (double)hdrp_env_latlong_solid_angle(30u, 180u, 90u)),
              1.0, 1e-6);
    free(image.texels);
}

static void an_even_sky_has_no_sun(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 32u, 16u, 3.0f);
    hdrp_env_sun sun = {0};
    assert_int_equal(hdrp_env_find_sun(&image, 0.0f, &sun), HDRP_OK);
    assert_true(sun.share < 1e-6f && sun.illuminance_lux.y < 1e-6f);
    memset(image.texels, 0, sizeof(float) * test_floats(&image));
    assert_int_equal(hdrp_env_find_sun(&image, 0.0f, &sun), HDRP_OK);
    assert_true(sun.share == 0.0f && sun.illuminance_lux.y == 0.0f);
    test_near((double)hdrp_v3_length(sun.direction), 1.0, 1e-6);
    free(image.texels);
}

/* Sizes at which the ring around the disc holds no texel, or nothing is outside the disc. */
static void an_even_sky_of_any_size_keeps_its_light(void** state)
{
    (void)state;
    for (uint32_t i = 0; i < 2u * 9u * 9u; ++i) {
        uint32_t w = i / 2u % 9u + 1u, h = i / 18u + 1u;
        hdrp_env_image image = test_image((hdrp_env_image_kind)(i % 2u), w, h, 0.1f);
        hdrp_env_stats stats = {0};
        hdrp_env_sun sun = {0};
        if (image.kind == HDRP_ENV_LATLONG || w == h) {
            assert_int_equal(hdrp_env_find_sun(&image, 0.0f, &sun), HDRP_OK);
            assert_true(sun.share < 1e-6f && hdrp_luminance(sun.illuminance_lux) < 1e-6f);
            assert_int_equal(hdrp_env_remove_sun(&image, &sun), HDRP_OK);
            assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
            test_near(stats.illuminance_lux / (0.1 * TEST_PI), 1.0, 1e-6);
        }
        free(image.texels);
    }
}

/* 4 by 2: the disc is one texel of 45 degrees latitude, and no other centre is near enough. */
static void without_a_ring_the_rest_of_the_image_is_the_background(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 4u, 2u, 1.0f);
    hdrp_env_sun sun = {0};
    image.texels[3] = image.texels[4] = image.texels[5] = 9.0f;
    assert_int_equal(hdrp_env_find_sun(&image, 0.0f, &sun), HDRP_OK);
    test_near_v3(sun.background_nits, 1.0, 1.0, 1.0, 1e-6);
    test_near((double)sun.share, 0.5, 1e-6); /* 8 nits of one texel in 8, of 2 on average */
    assert_int_equal(hdrp_env_remove_sun(&image, &sun), HDRP_OK);
    test_near((double)image.texels[4], 1.0, 1e-6);
    free(image.texels);
}

static void the_smallest_images_have_a_sun_or_none(void** state)
{
    (void)state;
    for (int i = 0; i < 6; ++i) {
        uint32_t n = 1u + (uint32_t)i / 2u;
        hdrp_env_image image = test_random_image((hdrp_env_image_kind)(i % 2), n, n);
        hdrp_env_sun sun = {0};
        assert_int_equal(hdrp_env_find_sun(&image, 0.0f, &sun), HDRP_OK);
        test_near((double)hdrp_v3_length(sun.direction), 1.0, 1e-6);
        assert_true(sun.share >= 0.0f && sun.share <= 1.0f);
        assert_int_equal(hdrp_env_remove_sun(&image, &sun), HDRP_OK);
        free(image.texels);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_sky_gives_pi_times_its_radiance),
        cmocka_unit_test(only_the_upper_hemisphere_counts),
        cmocka_unit_test(a_cube_is_cut_at_the_horizon_inside_a_row),
        cmocka_unit_test(measuring_does_not_depend_on_the_split),
        cmocka_unit_test(the_multiplier_brings_the_wanted_illuminance),
        cmocka_unit_test(no_multiplier_for_black_invalid_or_nonsense),
        cmocka_unit_test(texels_too_bright_to_measure_are_counted_and_not_calibrated),
        cmocka_unit_test(errors_leave_results_alone),
        cmocka_unit_test(the_sun_is_found_and_removed),
        cmocka_unit_test(dark_texels_near_the_sun_stay),
        cmocka_unit_test(the_solid_angle_of_a_sun_ends_at_half_its_peak),
        cmocka_unit_test(an_even_sky_has_no_sun),
        cmocka_unit_test(an_even_sky_of_any_size_keeps_its_light),
        cmocka_unit_test(without_a_ring_the_rest_of_the_image_is_the_background),
        cmocka_unit_test(the_smallest_images_have_a_sun_or_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
