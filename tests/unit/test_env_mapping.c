/* test_env_mapping.c - where directions are on latitude-longitude images and cubes.
 * SPDX-License-Identifier: MIT */
#define HDRP_ENV_IMPLEMENTATION
#include "env_test.h"

static void expect_uv(hdrp_v3 d, double u, double v)
{
    hdrp_v2 uv = hdrp_env_latlong_from_direction(d);
    test_near((double)uv.x, u, 1e-7);
    test_near((double)uv.y, v, 1e-7);
}

static void latlong_axes_are_those_of_the_convention(void** state)
{
    (void)state;
    expect_uv(hdrp_v3_make(0.0f, 0.0f, 1.0f), 0.5, 0.5);
    expect_uv(hdrp_v3_make(1.0f, 0.0f, 0.0f), 0.25, 0.5);
    expect_uv(hdrp_v3_make(-1.0f, 0.0f, 0.0f), 0.75, 0.5);
    expect_uv(hdrp_v3_make(0.0f, 1.0f, 0.0f), 0.5, 0.0);
    expect_uv(hdrp_v3_make(0.0f, -1.0f, 0.0f), 0.5, 1.0);
    expect_uv(hdrp_v3_make(1e-9f, 0.0f, -1.0f), 0.0, 0.5);
    expect_uv(hdrp_v3_make(-1e-9f, 0.0f, -1.0f), 1.0, 0.5);
}

/* Longitude +pi/4 (between +Z and +X), latitude +pi/4. */
static void latlong_latitude_and_longitude_grow_as_documented(void** state)
{
    (void)state;
    expect_uv(hdrp_v3_make(0.5f, 0.70710678f, 0.5f), 0.375, 0.25);
}

static void latlong_round_trip_returns_the_direction(void** state)
{
    (void)state;
    uint64_t random = 1u;
    for (int i = 0; i < 10000; ++i) {
        hdrp_v3 d = test_direction(&random);
        hdrp_v3 r = hdrp_env_direction_from_latlong(hdrp_env_latlong_from_direction(d));
        test_near_v3(r, (double)d.x, (double)d.y, (double)d.z, 2e-6);
    }
}

static void expect_place(hdrp_v3 d, hdrp_u32 face, double u, double v)
{
    hdrp_env_place place = hdrp_env_cube_from_direction(d);
    assert_int_equal(place.face, face);
    test_near((double)place.u, u, 1e-7);
    test_near((double)place.v, v, 1e-7);
}

/* Section "Cube Map Face Selection" of the Vulkan specification: what is to the right of and below
 * the middle of each face. */
static void cube_faces_lie_as_vulkan_reads_them(void** state)
{
    (void)state;
    expect_place(test_unit(1, 0, -0.5), HDRP_ENV_FACE_POSITIVE_X, 0.75, 0.5);
    expect_place(test_unit(1, -0.5, 0), HDRP_ENV_FACE_POSITIVE_X, 0.5, 0.75);
    expect_place(test_unit(-1, 0, 0.5), HDRP_ENV_FACE_NEGATIVE_X, 0.75, 0.5);
    expect_place(test_unit(-1, -0.5, 0), HDRP_ENV_FACE_NEGATIVE_X, 0.5, 0.75);
    expect_place(test_unit(0.5, 1, 0), HDRP_ENV_FACE_POSITIVE_Y, 0.75, 0.5);
    expect_place(test_unit(0, 1, 0.5), HDRP_ENV_FACE_POSITIVE_Y, 0.5, 0.75);
    expect_place(test_unit(0.5, -1, 0), HDRP_ENV_FACE_NEGATIVE_Y, 0.75, 0.5);
    expect_place(test_unit(0, -1, -0.5), HDRP_ENV_FACE_NEGATIVE_Y, 0.5, 0.75);
    expect_place(test_unit(0.5, 0, 1), HDRP_ENV_FACE_POSITIVE_Z, 0.75, 0.5);
    expect_place(test_unit(0, -0.5, 1), HDRP_ENV_FACE_POSITIVE_Z, 0.5, 0.75);
    expect_place(test_unit(-0.5, 0, -1), HDRP_ENV_FACE_NEGATIVE_Z, 0.75, 0.5);
    expect_place(test_unit(0, -0.5, -1), HDRP_ENV_FACE_NEGATIVE_Z, 0.5, 0.75);
}

static void cube_round_trip_returns_the_direction(void** state)
{
    (void)state;
    uint64_t random = 2u;
    for (int i = 0; i < 10000; ++i) {
        hdrp_v3 d = test_direction(&random);
        hdrp_v3 r = hdrp_env_direction_from_cube(hdrp_env_cube_from_direction(d));
        test_near_v3(r, (double)d.x, (double)d.y, (double)d.z, 5e-7);
    }
}

static void cube_places_are_total(void** state)
{
    (void)state;
    float bad[] = {0.0f, NAN, INFINITY, -INFINITY, 1e-45f, HDRP_FLT_MAX};
    for (int i = 0; i < 216; ++i) {
        hdrp_v3 d = hdrp_v3_make(bad[i % 6], bad[i / 6 % 6], bad[i / 36]);
        hdrp_env_place place = hdrp_env_cube_from_direction(d);
        assert_true(place.face < 6u && place.u >= 0.0f && place.u <= 1.0f && place.v >= 0.0f &&
                    place.v <= 1.0f);
    }
    expect_place(hdrp_v3_splat(0.0f), HDRP_ENV_FACE_POSITIVE_X, 0.5, 0.5);
}

static void openexr_faces_are_mirrored_and_mirroring_is_its_own_inverse(void** state)
{
    (void)state;
    for (hdrp_u32 face = 0; face < 6u; ++face) {
        hdrp_env_place place = {face, 0.125f, 0.75f};
        hdrp_env_place there = hdrp_env_cube_from_openexr(place);
        hdrp_env_place back = hdrp_env_cube_from_openexr(there);
        bool vertical = face == 2u || face == 3u;
        assert_true(there.u == (vertical ? 0.125f : 0.875f));
        assert_true(there.v == (vertical ? 0.25f : 0.75f));
        assert_true(back.face == face && back.u == place.u && back.v == place.v);
    }
}

static void texels_beyond_a_face_count_as_its_last(void** state)
{
    (void)state;
    float last = hdrp_env_cube_solid_angle(7u, 7u, 8u);
    assert_true(hdrp_env_cube_solid_angle(8u, 9u, 8u) == last);
    assert_true(hdrp_env_cube_solid_angle(65535u, 7u, 8u) == last);
    assert_true(hdrp_env_cube_solid_angle(7u, 65535u, 8u) == last);
}

static void solid_angles_add_up_to_the_sphere(void** state)
{
    (void)state;
    for (uint32_t n = 1; n <= 65; n += n < 8u ? 1u : 19u) {
        double latlong = 0.0, cube = 0.0;
        for (uint32_t y = 0; y < n; ++y) {
            latlong += 7.0 * (double)hdrp_env_latlong_solid_angle(y, 7u, n);
            for (uint32_t x = 0; x < n; ++x) {
                cube += 6.0 * (double)hdrp_env_cube_solid_angle(x, y, n);
            }
        }
        test_near(latlong, 4.0 * TEST_PI, 4e-6);
        test_near(cube, 4.0 * TEST_PI, 4e-6);
    }
}

static void cosine_weights_add_up_to_pi(void** state)
{
    (void)state;
    for (uint32_t n = 1; n <= 65; n += n < 8u ? 1u : 19u) {
        double latlong = 0.0, cube = 0.0;
        for (uint32_t y = 0; y < n; ++y) {
            latlong += 7.0 * (double)hdrp_env_latlong_cosine_weight(y, 7u, n);
            for (uint32_t k = 0; k < 6u * n; ++k) {
                cube += (double)hdrp_env_cube_cosine_weight(k / n, k % n, y, n);
            }
        }
        test_near(latlong, TEST_PI, 1e-6);
        test_near(cube, TEST_PI, 1e-6);
    }
}

/* Three rows of 60 degrees: pi (sin^2 60), pi (1 - sin^2 60), nothing. */
static void a_row_across_the_horizon_counts_its_upper_part(void** state)
{
    (void)state;
    test_near((double)hdrp_env_latlong_cosine_weight(0u, 1u, 3u), 0.75 * TEST_PI, 1e-6);
    test_near((double)hdrp_env_latlong_cosine_weight(1u, 1u, 3u), 0.25 * TEST_PI, 1e-6);
    assert_true(hdrp_env_latlong_cosine_weight(2u, 1u, 3u) == 0.0f);
    /* A whole face: form factors of a cube from its centre, (pi - top) / 4 for each wall. */
    double top = (double)hdrp_env_cube_cosine_weight(2u, 0u, 0u, 1u);
    test_near(top, 4.0 / sqrt(2.0) * atan(1.0 / sqrt(2.0)), 1e-6);
    test_near((double)hdrp_env_cube_cosine_weight(4u, 0u, 0u, 1u), 0.25 * (TEST_PI - top), 1e-6);
    assert_true(hdrp_env_cube_cosine_weight(3u, 0u, 0u, 1u) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(latlong_axes_are_those_of_the_convention),
        cmocka_unit_test(latlong_latitude_and_longitude_grow_as_documented),
        cmocka_unit_test(latlong_round_trip_returns_the_direction),
        cmocka_unit_test(cube_faces_lie_as_vulkan_reads_them),
        cmocka_unit_test(cube_round_trip_returns_the_direction),
        cmocka_unit_test(cube_places_are_total),
        cmocka_unit_test(openexr_faces_are_mirrored_and_mirroring_is_its_own_inverse),
        cmocka_unit_test(texels_beyond_a_face_count_as_its_last),
        cmocka_unit_test(solid_angles_add_up_to_the_sphere),
        cmocka_unit_test(cosine_weights_add_up_to_pi),
        cmocka_unit_test(a_row_across_the_horizon_counts_its_upper_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
