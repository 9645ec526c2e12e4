/* test_env_image.c - reading, cleaning and converting images of the sphere.
 * SPDX-License-Identifier: MIT */
#define HDRP_ENV_IMPLEMENTATION
#include "env_test.h"

static void an_image_that_cannot_be_read_is_refused(void** state)
{
    (void)state;
    hdrp_env_image good = test_image(HDRP_ENV_CUBE, 2u, 2u, 1.0f), bad;
    assert_int_equal(hdrp_env_image_check(&good), HDRP_OK);
    assert_int_equal(hdrp_env_image_rows(&good), 12);
    assert_int_equal(hdrp_env_image_check(NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_image_rows(NULL), 0);
    assert_int_equal(hdrp_env_image_floats(&good), 6 * 2 * 2 * 3);
    assert_int_equal(hdrp_env_image_floats(NULL), 0);
    for (int i = 0; i < 12; ++i) {
        bad = good;
        bad.texels = i == 0 ? NULL : good.texels;
        bad.width = i == 1 ? 0u : (i == 2 ? 65537u : (i == 3 ? 3u : 2u));
        bad.height = i == 4 ? 0u : 2u;
        bad.kind = i == 5 ? (hdrp_env_image_kind)2 : HDRP_ENV_CUBE;
        bad.texel_stride = i == 6 ? 2u : (i == 7 ? 257u : 0u);
        bad.row_stride = i == 8 ? 5u : 0u;
        bad.face_stride = i == 9 ? 11u : 0u;
        bad.nits_per_unit = i == 10 ? -1.0f : (i == 11 ? NAN : 0.0f);
        assert_int_equal(hdrp_env_image_check(&bad),
                         i == 0 ? HDRP_ERROR_NULL_POINTER : HDRP_ERROR_BAD_ARGUMENT);
        assert_int_equal(hdrp_env_image_rows(&bad), 0);
        assert_int_equal(hdrp_env_image_floats(&bad), 0);
    }
    bad = good;
    bad.row_stride = (size_t)-1 / 8u;
    assert_int_equal(hdrp_env_image_check(&bad), HDRP_ERROR_TOO_LARGE);
    free(good.texels);
}

/* Four channels, a gap after each row and each face. */
static void strides_change_where_texels_are_and_nothing_else(void** state)
{
    (void)state;
    hdrp_env_image tight = test_random_image(HDRP_ENV_CUBE, 5u, 5u), wide = tight;
    hdrp_env_stats a = {0}, b = {0};
    uint64_t random = 3u;
    wide.texel_stride = 4u;
    wide.row_stride = 23u;
    wide.face_stride = 117u;
    wide.texels = malloc(sizeof(float) * 6u * 117u);
    assert_int_equal(hdrp_env_image_floats(&wide), 5u * 117u + 4u * 23u + 4u * 4u + 3u);
    for (uint32_t i = 0; i < 6u * 117u; ++i) {
        wide.texels[i] = NAN;
    }
    for (uint32_t k = 0; k < 6u * 25u; ++k) {
        memcpy(wide.texels + k / 25u * 117u + k / 5u % 5u * 23u + k % 5u * 4u,
               tight.texels + 3u * k, 3u * sizeof(float));
    }
    assert_int_equal(hdrp_env_measure(&tight, &a), HDRP_OK);
    assert_int_equal(hdrp_env_measure(&wide, &b), HDRP_OK);
    assert_memory_equal(&a, &b, sizeof a);
    for (int i = 0; i < 1000; ++i) {
        hdrp_v3 d = test_direction(&random);
        hdrp_v3 p = hdrp_env_image_radiance(&tight, d), q = hdrp_env_image_radiance(&wide, d);
        assert_memory_equal(&p, &q, sizeof p);
    }
    free(tight.texels);
    free(wide.texels);
}

static void a_texel_is_never_less_than_black_or_infinite(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 2u, 1u, 2.0f);
    image.nits_per_unit = 3.0f;
    image.texels[0] = NAN;
    image.texels[1] = -INFINITY;
    image.texels[2] = INFINITY;
    hdrp_v3 bad = hdrp_env_image_texel(&image, 0u, 0u), good = hdrp_env_image_texel(&image, 0u, 1u);
    assert_true(bad.x == 0.0f && bad.y == 0.0f && bad.z == 1e20f);
    assert_true(good.x == 6.0f && good.y == 6.0f && good.z == 6.0f);
    free(image.texels);
}

static void sanitising_counts_and_replaces(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 4u, 2u, 1.0f);
    hdrp_env_sanitize_counts counts = {0};
    float* t = image.texels;
    t[0] = NAN;       /* texel 0: between the last texel of the row, 1, and texel 1, 72704 */
    t[3] = 72704.0f;  /* above the largest half, but finite: kept */
    t[7] = INFINITY;  /* becomes the largest half */
    t[8] = -INFINITY; /* becomes black */
    t[10] = -1e-3f;
    t[12] = 1e30f;
    t[13] = NAN; /* the only bad green of its row: mean of its neighbours, both 1 */
    assert_int_equal(hdrp_env_sanitize(&image, NULL, 0u, 2u, &counts), HDRP_OK);
    assert_int_equal(counts.nan_texels, 2);
    assert_int_equal(counts.infinite_texels, 1);
    assert_int_equal(counts.negative_texels, 1);
    assert_int_equal(counts.too_large_texels, 1);
    test_near((double)t[0], 0.5 * (1.0 + 72704.0), 0.01);
    assert_true(t[3] == 72704.0f && t[7] == 65504.0f && t[8] == 0.0f && t[10] == 0.0f);
    assert_true(t[12] == 1e12f && t[13] == 1.0f && t[1] == 1.0f);
    assert_int_equal(hdrp_env_sanitize(&image, NULL, 0u, 2u, &counts), HDRP_OK);
    assert_true(counts.nan_texels + counts.infinite_texels + counts.negative_texels +
                    counts.too_large_texels ==
                0u);
    free(image.texels);
}

static void a_run_of_nan_is_interpolated_around_the_seam(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 6u, 1u, NAN);
    float* t = image.texels;
    for (int c = 0; c < 3; ++c) {
        t[6 + c] = 6.0f;
        t[9 + c] = 1.0f;
    }
    assert_int_equal(hdrp_env_sanitize(&image, NULL, 0u, 1u, NULL), HDRP_OK);
    float expected[6] = {4.0f, 5.0f, 6.0f, 1.0f, 2.0f, 3.0f};
    for (int x = 0; x < 6; ++x) {
        test_near((double)t[3 * x + 1], (double)expected[x], 1e-6);
    }
    free(image.texels);
}

static void a_run_of_nan_on_a_cube_ends_at_the_edge(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_CUBE, 4u, 4u, NAN);
    float* t = image.texels + 3 * 4 * 9; /* a row of the third face */
    t[3] = 7.0f;
    t[6] = 9.0f;
    assert_int_equal(hdrp_env_sanitize(&image, NULL, 0u, 24u, NULL), HDRP_OK);
    assert_true(t[0] == 7.0f && t[3] == 7.0f && t[6] == 9.0f && t[9] == 9.0f);
    assert_true(t[1] == 0.0f && image.texels[0] == 0.0f); /* rows without any value */
    free(image.texels);
}

static void sanitising_obeys_its_desc_and_its_range(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 3u, 4u, INFINITY);
    hdrp_env_sanitize_desc desc = {1000.0f, 100.0f}, bad = {0.0f, -1.0f};
    hdrp_env_sanitize_counts counts = {0};
    assert_int_equal(hdrp_env_sanitize(&image, &desc, 1u, 2u, &counts), HDRP_OK);
    assert_int_equal(counts.infinite_texels, 6);
    assert_true(image.texels[0] == INFINITY && image.texels[9] == 100.0f);
    memset(&counts, 7, sizeof counts);
    hdrp_env_sanitize_counts before = counts;
    assert_int_equal(hdrp_env_sanitize(&image, &bad, 0u, 4u, &counts), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_sanitize(&image, NULL, 2u, 3u, &counts), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_sanitize(&image, NULL, 5u, 0u, &counts), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_sanitize(NULL, NULL, 0u, 0u, &counts), HDRP_ERROR_NULL_POINTER);
    assert_memory_equal(&counts, &before, sizeof counts);
    assert_true(image.texels[0] == INFINITY);
    free(image.texels);
}

/* Samples on the edges of radiance that is linear on the cube; OpenEXR's figures place them. */
static void openexr_cubes_are_turned_and_averaged(void** state)
{
    (void)state;
    hdrp_env_image file = test_image(HDRP_ENV_CUBE, 5u, 5u, 0.0f);
    hdrp_env_image image = test_image(HDRP_ENV_CUBE, 4u, 4u, -1.0f);
    for (uint32_t k = 0; k < 6u * 25u; ++k) {
        hdrp_env_place place = {k / 25u, (float)(k % 5u) / 4.0f, (float)(k / 5u % 5u) / 4.0f};
        place = hdrp_env_cube_from_openexr(place);
        hdrp_v3 p =
            hdrp_env_point_from_cube(place.face, 2.0f * place.u - 1.0f, 2.0f * place.v - 1.0f);
        file.texels[3u * k] = p.x;
        file.texels[3u * k + 1u] = p.y;
        file.texels[3u * k + 2u] = p.z;
    }
    assert_int_equal(hdrp_env_texels_from_openexr(&file, 0u, 13u, image.texels), HDRP_OK);
    assert_int_equal(hdrp_env_texels_from_openexr(&file, 13u, 11u, image.texels), HDRP_OK);
    for (uint32_t k = 0; k < 6u * 16u; ++k) {
        hdrp_v3 p = hdrp_env_point_from_cube(k / 16u, ((float)(k % 4u) + 0.5f) * 0.5f - 1.0f,
                                             ((float)(k / 4u % 4u) + 0.5f) * 0.5f - 1.0f);
        hdrp_v3 v = hdrp_v3_make(image.texels[3u * k], image.texels[3u * k + 1u],
                                 image.texels[3u * k + 2u]);
        test_near_v3(v, (double)p.x, (double)p.y, (double)p.z, 1e-6);
    }
    free(file.texels);
    free(image.texels);
}

static void openexr_panoramas_lose_a_row_and_a_column(void** state)
{
    (void)state;
    hdrp_env_image file = test_image(HDRP_ENV_LATLONG, 3u, 2u, 0.0f);
    float result[6] = {0.0f}, untouched[12] = {5.0f};
    for (uint32_t i = 0; i < 6u; ++i) {
        file.texels[3u * i] = (float)i;
    }
    assert_int_equal(hdrp_env_texels_from_openexr(&file, 0u, 1u, result), HDRP_OK);
    assert_true(result[0] == 2.0f && result[3] == 3.0f && result[1] == 0.0f);
    file.height = 1u;
    assert_int_equal(hdrp_env_texels_from_openexr(&file, 0u, 1u, untouched),
                     HDRP_ERROR_BAD_ARGUMENT);
    file.height = 2u;
    assert_int_equal(hdrp_env_texels_from_openexr(&file, 0u, 2u, untouched),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_texels_from_openexr(&file, 0u, 1u, NULL), HDRP_ERROR_NULL_POINTER);
    assert_true(untouched[0] == 5.0f);
    free(file.texels);
}

static void expect_close(const hdrp_env_image* image, hdrp_v3 one, hdrp_v3 other, double tolerance)
{
    hdrp_v3 a = hdrp_env_image_radiance(image, one), b = hdrp_env_image_radiance(image, other);
    test_near_v3(a, (double)b.x, (double)b.y, (double)b.z, tolerance);
}

static void lookups_are_continuous_over_every_edge_and_corner(void** state)
{
    (void)state;
    uint64_t random = 4u;
    for (uint32_t n = 1; n <= 9; ++n) {
        hdrp_env_image image = test_image(HDRP_ENV_CUBE, n, n, 0.0f);
        for (size_t i = 0; i < test_floats(&image); ++i) {
            image.texels[i] = (float)test_random(&random);
        }
        for (int i = 0; i < 12 * 101; ++i) {
            hdrp_v3 one, other;
            test_edge(i / 101, (i % 101) / 50.0 - 1.0, 2e-6, &one, &other);
            expect_close(&image, one, other, 4e-5 * n);
        }
        free(image.texels);
    }
}

static void lookups_are_continuous_over_the_seam_and_through_the_poles(void** state)
{
    (void)state;
    hdrp_env_image image = test_random_image(HDRP_ENV_LATLONG, 16u, 8u);
    for (size_t i = 0; i < test_floats(&image); ++i) {
        image.texels[i] = fminf(image.texels[i], 1.0f);
    }
    for (int i = 1; i < 100; ++i) {
        double polar = TEST_PI * i / 100.0, azimuth = 0.0628 * i;
        expect_close(&image, test_unit(1e-6 * sin(polar), cos(polar), -sin(polar)),
                     test_unit(-1e-6 * sin(polar), cos(polar), -sin(polar)), 1e-4);
        expect_close(&image, test_unit(1e-6 * sin(azimuth), 1.0, 1e-6 * cos(azimuth)),
                     test_unit(-1e-6 * sin(azimuth), 1.0, -1e-6 * cos(azimuth)), 1e-4);
        expect_close(&image, test_unit(1e-6 * sin(azimuth), -1.0, 1e-6 * cos(azimuth)),
                     test_unit(-1e-6 * sin(azimuth), -1.0, -1e-6 * cos(azimuth)), 1e-4);
    }
    free(image.texels);
}

/* A big cube without texels of its own but where a test writes them. */
static void texels_across_an_edge_are_half_a_texel_below_it(void** state)
{
    const uint32_t n = 1024u;
    hdrp_env_image image = {.kind = HDRP_ENV_CUBE, .width = n, .height = n};
    (void)state;
    image.texels = calloc((size_t)18u * n * n, sizeof(float));
    assert_non_null(image.texels);
    for (uint32_t k = 0; k < 6u * n * n; ++k) {
        uint32_t x = k % n, y = k / n % n;
        if (x == 0u || x == n - 1u || y == 0u || y == n - 1u) {
            image.texels[3u * k] = (float)k; /* exact: below 2^24 */
        }
    }
    for (uint32_t k = 0; k < 24u * n; ++k) {
        uint32_t face = k / n / 4u, side = k / n % 4u, end = side % 2u ? n - 1u : 0u;
        int x = (int)(side < 2u ? end : k % n), y = (int)(side < 2u ? k % n : end);
        int step = side % 2u ? 1 : -1;
        uint32_t found = (uint32_t)hdrp_i_image_read_across(&image, face, side < 2u ? x + step : x,
                                                            side < 2u ? y : y + step)
                             .x;
        hdrp_v3 here = hdrp_env_point_from_cube(face, (2.0f * (float)x + 1.0f) / (float)n - 1.0f,
                                                (2.0f * (float)y + 1.0f) / (float)n - 1.0f);
        hdrp_v3 there = hdrp_env_point_from_cube(
            found / n / n, (2.0f * (float)(found % n) + 1.0f) / (float)n - 1.0f,
            (2.0f * (float)(found / n % n) + 1.0f) / (float)n - 1.0f);
        /* Both middles are half a texel, 1 / n, from the edge and at right angles. */
        double apart = (double)hdrp_v3_length(hdrp_v3_sub(here, there)) * n;
        assert_true(found / n / n != face);
        test_near(apart, sqrt(2.0), 0.01);
    }
    free(image.texels);
}

static void lookups_at_texel_centres_read_the_texel(void** state)
{
    (void)state;
    hdrp_env_image image = test_random_image(HDRP_ENV_LATLONG, 7u, 5u);
    for (uint32_t k = 0; k < 35u; ++k) {
        hdrp_v3 d = hdrp_env_direction_from_latlong(
            hdrp_v2_make(((float)(k % 7u) + 0.5f) / 7.0f, ((float)(k / 7u) + 0.5f) / 5.0f));
        hdrp_v3 v = hdrp_env_image_radiance(&image, d),
                t = hdrp_env_image_texel(&image, k / 7u, k % 7u);
        test_near_v3(v, (double)t.x, (double)t.y, (double)t.z, 0.05);
    }
    free(image.texels);
}

static void lookups_of_the_smallest_images_and_bad_directions_are_finite(void** state)
{
    (void)state;
    float bad[] = {0.0f, NAN, INFINITY, -1.0f};
    for (int kind = 0; kind < 2; ++kind) {
        hdrp_env_image image = test_image((hdrp_env_image_kind)kind, 1u, 1u, 2.0f);
        for (int i = 0; i < 64; ++i) {
            hdrp_v3 v = hdrp_env_image_radiance(
                &image, hdrp_v3_make(bad[i % 4], bad[i / 4 % 4], bad[i / 16]));
            test_near_v3(v, 2.0, 2.0, 2.0, 1e-6);
        }
        free(image.texels);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_image_that_cannot_be_read_is_refused),
        cmocka_unit_test(strides_change_where_texels_are_and_nothing_else),
        cmocka_unit_test(a_texel_is_never_less_than_black_or_infinite),
        cmocka_unit_test(sanitising_counts_and_replaces),
        cmocka_unit_test(a_run_of_nan_is_interpolated_around_the_seam),
        cmocka_unit_test(a_run_of_nan_on_a_cube_ends_at_the_edge),
        cmocka_unit_test(sanitising_obeys_its_desc_and_its_range),
        cmocka_unit_test(openexr_cubes_are_turned_and_averaged),
        cmocka_unit_test(openexr_panoramas_lose_a_row_and_a_column),
        cmocka_unit_test(lookups_are_continuous_over_every_edge_and_corner),
        cmocka_unit_test(lookups_are_continuous_over_the_seam_and_through_the_poles),
        cmocka_unit_test(texels_across_an_edge_are_half_a_texel_below_it),
        cmocka_unit_test(lookups_at_texel_centres_read_the_texel),
        cmocka_unit_test(lookups_of_the_smallest_images_and_bad_directions_are_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
