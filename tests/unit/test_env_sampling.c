/* test_env_sampling.c - directions in proportion to the luminance of an image.
 * SPDX-License-Identifier: MIT */
#define HDRP_ENV_IMPLEMENTATION
#include "env_test.h"

typedef struct fixture {
    hdrp_env_image image;
    hdrp_env_sampler sampler;
    void* memory;
} fixture;

static fixture make_fixture(hdrp_env_image image)
{
    fixture f;
    size_t bytes = hdrp_env_sampler_memory_size(&image);
    f.image = image;
    f.memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_non_null(f.memory);
    memset(f.memory, 0xff, bytes);
    assert_int_equal(hdrp_env_sampler_init(&f.sampler, &image, f.memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_env_sampler_build(&f.sampler, 0u, hdrp_env_image_rows(&image)), HDRP_OK);
    assert_int_equal(hdrp_env_sampler_finish(&f.sampler), HDRP_OK);
    return f;
}

static void free_fixture(fixture* f)
{
    free(f->image.texels);
    free(f->memory);
}

/* Direction, solid angle and texel of a point of a fine grid over an image. */
static hdrp_v3 grid_point(const hdrp_env_image* image, uint32_t fine, uint32_t k,
                          double* solid_angle, uint32_t* texel)
{
    uint32_t w = image->width * fine, h = image->height * fine;
    uint32_t face = k / w / h, x = k % w, y = k / w % h;
    hdrp_env_place place = {face, ((float)x + 0.5f) / (float)w, ((float)y + 0.5f) / (float)h};
    *texel = (face * image->height + y / fine) * image->width + x / fine;
    if (image->kind == HDRP_ENV_CUBE) {
        *solid_angle = (double)hdrp_env_cube_solid_angle(x, y, w);
        return hdrp_env_direction_from_cube(place);
    }
    *solid_angle = (double)hdrp_env_latlong_solid_angle(y, w, h);
    return hdrp_env_direction_from_latlong(hdrp_v2_make(place.u, place.v));
}

static void the_density_integrates_to_one(void** state)
{
    (void)state;
    for (int i = 0; i < 8; ++i) {
        uint32_t n = i < 4 ? 1u + (uint32_t)i : 13u;
        fixture f = make_fixture(test_random_image((hdrp_env_image_kind)(i % 2), n, n));
        uint32_t fine = 16u;
        double sum = 0.0;
        for (uint32_t k = 0; k < n * fine * hdrp_env_image_rows(&f.image) * fine; ++k) {
            double solid_angle;
            uint32_t texel;
            hdrp_v3 d = grid_point(&f.image, fine, k, &solid_angle, &texel);
            sum += solid_angle * (double)hdrp_env_sampler_pdf(&f.sampler, d);
        }
        test_near(sum, 1.0, 3e-3 / n);
        free_fixture(&f);
    }
}

/* Pearson's statistic over quarters of texels, against the integrated density. */
static void samples_follow_the_density(void** state)
{
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        fixture f = make_fixture(test_random_image((hdrp_env_image_kind)kind, 8u, 8u));
        enum { SAMPLES = 200000, FINE = 8, BINS = 6 * 16 * 16 };
        static double expected[BINS], counted[BINS];
        uint32_t rows = hdrp_env_image_rows(&f.image), bins = rows * 8u * 4u;
        uint64_t random = 5u;
        double chi2 = 0.0;
        int degrees = 0;
        memset(expected, 0, sizeof expected);
        memset(counted, 0, sizeof counted);
        for (uint32_t k = 0; k < 8u * FINE * rows * FINE; ++k) {
            double solid_angle;
            uint32_t texel, x = k % (8u * FINE), y = k / (8u * FINE);
            hdrp_v3 d = grid_point(&f.image, FINE, k, &solid_angle, &texel);
            expected[y / 4u * 16u + x / 4u] +=
                SAMPLES * solid_angle * (double)hdrp_env_sampler_pdf(&f.sampler, d);
        }
        for (int i = 0; i < SAMPLES; ++i) {
            hdrp_env_sample s = hdrp_env_sampler_sample(&f.sampler, (float)test_random(&random),
                                                        (float)test_random(&random));
            hdrp_env_place p = hdrp_env_cube_from_direction(s.direction);
            if (kind == 0) {
                hdrp_v2 uv = hdrp_env_latlong_from_direction(s.direction);
                p.face = 0u;
                p.u = uv.x;
                p.v = uv.y;
            }
            uint32_t x = (uint32_t)fminf(p.u * 16.0f, 15.0f),
                     y = (uint32_t)fminf(p.v * 16.0f, 15.0f);
            counted[(p.face * 16u + y) * 16u + x] += 1.0;
        }
        for (uint32_t b = 0; b < bins; ++b) {
            if (expected[b] > 5.0) {
                chi2 += pow(counted[b] - expected[b], 2.0) / expected[b];
                ++degrees;
            }
        }
        assert_true(degrees > 100);
        /* Mean `degrees`, variance 2 `degrees`: five standard deviations. */
        test_near(chi2, degrees, 5.0 * sqrt(2.0 * degrees));
        free_fixture(&f);
    }
}

static void a_sample_knows_its_density_and_radiance(void** state)
{
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        fixture f = make_fixture(test_random_image((hdrp_env_image_kind)kind, 16u, 16u));
        uint64_t random = 6u;
        int wrong = 0;
        for (int i = 0; i < 20000; ++i) {
            hdrp_env_sample s = hdrp_env_sampler_sample(&f.sampler, (float)test_random(&random),
                                                        (float)test_random(&random));
            hdrp_v3 v = hdrp_env_image_radiance(&f.image, s.direction);
            double pdf = (double)hdrp_env_sampler_pdf(&f.sampler, s.direction);
            assert_memory_equal(&v, &s.radiance_nits, sizeof v);
            assert_true(s.pdf_per_sr > 0.0f);
            test_near((double)hdrp_v3_length(s.direction), 1.0, 1e-6);
            /* On the border of two texels rounding may give the other one. */
            wrong += fabs(pdf / (double)s.pdf_per_sr - 1.0) > 1e-5;
        }
        assert_true(wrong < 20);
        free_fixture(&f);
    }
}

/* What a path tracer estimates: the mean of radiance over density is the flux, and nothing that
 * emits is missed. */
static void the_estimate_of_the_flux_is_unbiased(void** state)
{
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        hdrp_env_image image = test_image((hdrp_env_image_kind)kind, 24u, 24u, 0.0f);
        image.texels[3 * 24 * 7 + 30] = 1e6f; /* red only: still seen by luminance */
        image.texels[3 * 24 * 20 + 9] = 1.0f;
        fixture f = make_fixture(image);
        uint64_t random = 7u;
        double flux = 0.0, reference = 0.0;
        for (uint32_t k = 0; k < 24u * 8u * hdrp_env_image_rows(&image) * 8u; ++k) {
            double solid_angle;
            uint32_t texel;
            hdrp_v3 d = grid_point(&image, 8u, k, &solid_angle, &texel);
            hdrp_v3 v = hdrp_env_image_radiance(&image, d);
            reference += solid_angle * (double)v.x;
            assert_true(v.x + v.y + v.z == 0.0f || hdrp_env_sampler_pdf(&f.sampler, d) > 0.0f);
        }
        for (int i = 0; i < 200000; ++i) {
            hdrp_env_sample s = hdrp_env_sampler_sample(&f.sampler, (float)test_random(&random),
                                                        (float)test_random(&random));
            flux += (double)s.radiance_nits.x / (double)s.pdf_per_sr / 200000.0;
        }
        test_near(flux / reference, 1.0, 0.01);
        free_fixture(&f);
    }
}

static void building_does_not_depend_on_the_split(void** state)
{
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        fixture f = make_fixture(test_random_image((hdrp_env_image_kind)kind, 9u, 9u));
        uint32_t rows = hdrp_env_image_rows(&f.image);
        size_t bytes = hdrp_env_sampler_memory_size(&f.image);
        void* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
        for (uint32_t step = 1; step < rows; ++step) {
            hdrp_env_sampler sampler;
            memset(memory, 0xff, bytes);
            assert_int_equal(hdrp_env_sampler_init(&sampler, &f.image, memory, bytes), HDRP_OK);
            for (uint32_t end = rows; end > 0u; end -= end < step ? end : step) {
                uint32_t first = end < step ? 0u : end - step;
                assert_int_equal(hdrp_env_sampler_build(&sampler, first, end - first), HDRP_OK);
            }
            assert_int_equal(hdrp_env_sampler_finish(&sampler), HDRP_OK);
            assert_memory_equal(memory, f.memory, bytes);
        }
        free(memory);
        free_fixture(&f);
    }
}

/* The weight of a texel is the mean of what lookups find in it. Four steps a side hit the kinks of
 * the bilinear surface, between which the midpoint rule is exact. */
static void texels_are_weighted_by_what_lookups_find_in_them(void** state)
{
    const uint32_t fine = 4u, n = 8u;
    hdrp_env_image image = test_random_image(HDRP_ENV_LATLONG, n, n);
    (void)state;
    for (uint32_t k = 0; k < n * n; ++k) {
        double mean = 0.0;
        for (uint32_t i = 0; i < fine * fine; ++i) {
            float u = ((float)(k % n) + ((float)(i % fine) + 0.5f) / (float)fine) / (float)n;
            float v = ((float)(k / n) + ((float)(i / fine) + 0.5f) / (float)fine) / (float)n;
            hdrp_v3 nits = hdrp_env_image_radiance(
                &image, hdrp_env_direction_from_latlong(hdrp_v2_make(u, v)));
            mean += (double)hdrp_luminance(nits) / (fine * fine);
        }
        test_near(hdrp_i_image_bilinear_mean(&image, k / n, k % n) / mean, 1.0, 1e-4);
    }
    free(image.texels);
}

/* An even sky is drawn evenly. On a cube of single texels, that is not so: each face has a sixth,
 * spread over its square, and k = 1 + s^2 + t^2 = 1 / m^2 with m the direction's largest part. */
static void even_skies_have_densities_in_closed_form(void** state)
{
    uint64_t random = 9u;
    fixture cube = make_fixture(test_image(HDRP_ENV_CUBE, 1u, 1u, 3.0f));
    fixture panorama = make_fixture(test_image(HDRP_ENV_LATLONG, 2u, 1u, 3.0f));
    (void)state;
    for (int i = 0; i < 1000; ++i) {
        float u1 = (float)test_random(&random), u2 = (float)test_random(&random);
        hdrp_env_sample s = hdrp_env_sampler_sample(&cube.sampler, u1, u2);
        double m = fmax(fmax(fabs((double)s.direction.x), fabs((double)s.direction.y)),
                        fabs((double)s.direction.z));
        test_near((double)s.pdf_per_sr * m * m * m * 24.0, 1.0, 1e-5);
        test_near((double)hdrp_env_sampler_pdf(&cube.sampler, s.direction) * m * m * m * 24.0, 1.0,
                  1e-5);
        s = hdrp_env_sampler_sample(&panorama.sampler, u1, u2);
        double longitude = TEST_PI - 2.0 * TEST_PI * (double)u2, y = 1.0 - 2.0 * (double)u1;
        test_near((double)s.pdf_per_sr * 4.0 * TEST_PI, 1.0, 1e-5);
        test_near_v3(s.direction, sqrt(1.0 - y * y) * sin(longitude), y,
                     sqrt(1.0 - y * y) * cos(longitude), 1e-5);
    }
    free_fixture(&cube);
    free_fixture(&panorama);
}

static void numbers_outside_the_range_give_a_sample(void** state)
{
    (void)state;
    fixture f = make_fixture(test_random_image(HDRP_ENV_LATLONG, 4u, 4u));
    float u[] = {0.0f, 1.0f, -1.0f, NAN, INFINITY, 0.99999994f};
    for (int i = 0; i < 36; ++i) {
        hdrp_env_sample s = hdrp_env_sampler_sample(&f.sampler, u[i % 6], u[i / 6]);
        test_near((double)hdrp_v3_length(s.direction), 1.0, 1e-6);
        assert_true(s.pdf_per_sr > 0.0f && s.pdf_per_sr <= HDRP_FLT_MAX);
    }
    free_fixture(&f);
}

static void errors_are_reported_and_change_nothing(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 4u, 4u, 0.0f), bad = image;
    size_t bytes = hdrp_env_sampler_memory_size(&image);
    char* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, (bytes + 31u) / 16u * 16u);
    hdrp_env_sampler sampler, before;
    bad.height = 0u;
    assert_int_equal(bytes % HDRP_MEMORY_ALIGNMENT, 0);
    memset(&sampler, 7, sizeof sampler);
    before = sampler;
    assert_int_equal(hdrp_env_sampler_memory_size(&bad), 0);
    assert_int_equal(hdrp_env_sampler_init(&sampler, &bad, memory, bytes), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_sampler_init(&sampler, &image, NULL, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_sampler_init(&sampler, &image, memory, bytes - 1u),
                     HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(hdrp_env_sampler_init(&sampler, &image, memory + 4, bytes),
                     HDRP_ERROR_MEMORY_ALIGNMENT);
    assert_memory_equal(&sampler, &before, sizeof sampler);
    assert_int_equal(hdrp_env_sampler_init(&sampler, &image, memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_env_sampler_build(&sampler, 0u, 5u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_sampler_build(NULL, 0u, 4u), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_sampler_build(&sampler, 0u, 4u), HDRP_OK);
    assert_int_equal(hdrp_env_sampler_finish(&sampler), HDRP_ERROR_BAD_ARGUMENT); /* black */
    assert_int_equal(hdrp_env_sampler_finish(NULL), HDRP_ERROR_NULL_POINTER);
    free(memory);
    free(image.texels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_density_integrates_to_one),
        cmocka_unit_test(samples_follow_the_density),
        cmocka_unit_test(a_sample_knows_its_density_and_radiance),
        cmocka_unit_test(the_estimate_of_the_flux_is_unbiased),
        cmocka_unit_test(building_does_not_depend_on_the_split),
        cmocka_unit_test(texels_are_weighted_by_what_lookups_find_in_them),
        cmocka_unit_test(even_skies_have_densities_in_closed_form),
        cmocka_unit_test(numbers_outside_the_range_give_a_sample),
        cmocka_unit_test(errors_are_reported_and_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
