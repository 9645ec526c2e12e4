/* test_env_lookup.c - reading a baked environment.
 * SPDX-License-Identifier: MIT */
#define HDRP_ENV_IMPLEMENTATION
#include "env_test.h"

static hdrp_env bake(hdrp_env_image image, uint32_t size, void** memory)
{
    hdrp_env env;
    hdrp_env_desc desc = {0};
    desc.radiance_size = desc.specular_size = size;
    size_t bytes = hdrp_env_memory_size(&desc);
    *memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_int_equal(hdrp_env_init(&env, &desc, *memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
    free(image.texels);
    return env;
}

static hdrp_v3 texel_direction(uint32_t k, uint32_t n)
{
    hdrp_env_place place = {k / n / n, ((float)(k % n) + 0.5f) / (float)n,
                            ((float)(k / n % n) + 0.5f) / (float)n};
    return hdrp_env_direction_from_cube(place);
}

static void levels_and_roughness_are_inverse_and_end_where_they_should(void** state)
{
    (void)state;
    for (hdrp_u32 levels = 1; levels <= 32u; ++levels) {
        float last = (float)levels - 1.0f;
        assert_true(hdrp_env_lod_from_perceptual_roughness(0.0f, levels) == 0.0f);
        assert_true(hdrp_env_lod_from_perceptual_roughness(1.0f, levels) == last);
        assert_true(hdrp_env_lod_from_perceptual_roughness(NAN, levels) == 0.0f);
        assert_true(hdrp_env_lod_from_perceptual_roughness(2.0f, levels) == last);
        assert_true(hdrp_env_perceptual_roughness_from_lod(0.0f, levels) == 0.0f);
        assert_true(hdrp_env_perceptual_roughness_from_lod(NAN, levels) == 0.0f);
        if (levels > 1u) {
            assert_true(hdrp_env_perceptual_roughness_from_lod(last, levels) == 1.0f);
            assert_true(hdrp_env_perceptual_roughness_from_lod(last + 5.0f, levels) == 1.0f);
        }
        for (int i = 0; i <= 100 && levels > 1u; ++i) {
            float r = (float)i / 100.0f;
            float lod = hdrp_env_lod_from_perceptual_roughness(r, levels);
            test_near((double)hdrp_env_perceptual_roughness_from_lod(lod, levels), (double)r, 1e-6);
        }
    }
}

static void lookups_at_texel_centres_read_the_texel(void** state)
{
    (void)state;
    void* memory;
    hdrp_env env = bake(test_random_image(HDRP_ENV_CUBE, 16u, 16u), 16u, &memory);
    for (uint32_t level = 0; level < env.specular.level_count; ++level) {
        hdrp_env_image image = hdrp_env_cube_image(&env.specular, level);
        float roughness =
            hdrp_env_perceptual_roughness_from_lod((float)level, env.specular.level_count);
        for (uint32_t k = 0; k < 6u * image.width * image.width; ++k) {
            hdrp_v3 t = hdrp_env_image_texel(&image, k / image.width, k % image.width);
            hdrp_v3 v = hdrp_env_specular(&env, texel_direction(k, image.width), roughness);
            double tolerance = 0.05 + 1e-4 * (double)(t.x + t.y + t.z);
            test_near_v3(v, (double)t.x, (double)t.y, (double)t.z, tolerance);
        }
    }
    free(memory);
}

static void between_two_levels_is_their_mean(void** state)
{
    (void)state;
    void* memory;
    hdrp_env env = bake(test_random_image(HDRP_ENV_LATLONG, 32u, 16u), 16u, &memory);
    uint64_t random = 9u;
    for (int i = 0; i < 200; ++i) {
        hdrp_v3 d = test_direction(&random);
        hdrp_v3 a = hdrp_env_radiance(&env, d, 1.0f), b = hdrp_env_radiance(&env, d, 2.0f);
        hdrp_v3 m = hdrp_env_radiance(&env, d, 1.5f);
        test_near_v3(m, 0.5 * (double)(a.x + b.x), 0.5 * (double)(a.y + b.y),
                     0.5 * (double)(a.z + b.z), 1e-2);
    }
    free(memory);
}

static void levels_outside_the_cube_are_its_ends(void** state)
{
    (void)state;
    void* memory;
    hdrp_env env = bake(test_random_image(HDRP_ENV_LATLONG, 32u, 16u), 8u, &memory);
    hdrp_v3 d = test_unit(1, 2, 3);
    float low[] = {-1.0f, NAN, -INFINITY}, high[] = {3.5f, 100.0f, INFINITY};
    for (int i = 0; i < 3; ++i) {
        hdrp_v3 a = hdrp_env_radiance(&env, d, low[i]), b = hdrp_env_radiance(&env, d, 0.0f);
        assert_memory_equal(&a, &b, sizeof a);
        a = hdrp_env_radiance(&env, d, high[i]);
        b = hdrp_env_radiance(&env, d, 3.0f);
        assert_memory_equal(&a, &b, sizeof a);
    }
    assert_int_equal(hdrp_env_cube_image(&env.radiance, 9u).width, 1);
    free(memory);
}

static void every_level_is_seamless(void** state)
{
    (void)state;
    void* memory;
    hdrp_env_image sky = test_random_image(HDRP_ENV_LATLONG, 64u, 32u);
    for (size_t i = 0; i < test_floats(&sky); ++i) {
        sky.texels[i] = fminf(sky.texels[i], 2.0f);
    }
    hdrp_env env = bake(sky, 16u, &memory);
    for (int i = 0; i < 12 * 41; ++i) {
        hdrp_v3 one, other;
        test_edge(i / 41, (i % 41) / 20.0 - 1.0, 2e-6, &one, &other);
        for (int k = 0; k < 9; ++k) {
            hdrp_v3 a = hdrp_env_specular(&env, one, (float)k / 8.0f);
            hdrp_v3 b = hdrp_env_specular(&env, other, (float)k / 8.0f);
            test_near_v3(a, (double)b.x, (double)b.y, (double)b.z, 1e-3);
        }
        hdrp_v3 a = hdrp_env_irradiance(&env, one), b = hdrp_env_irradiance(&env, other);
        test_near_v3(a, (double)b.x, (double)b.y, (double)b.z, 1e-3);
    }
    free(memory);
}

/* Level ground under the baked sky sees what the calibration measured in the image. */
static void irradiance_of_level_ground_is_the_measured_illuminance(void** state)
{
    (void)state;
    hdrp_env_image image = test_random_image(HDRP_ENV_LATLONG, 128u, 64u);
    hdrp_env_stats stats = {0};
    void* memory;
    assert_int_equal(hdrp_env_measure(&image, &stats), HDRP_OK);
    hdrp_env env = bake(image, 64u, &memory);
    hdrp_v3 e = hdrp_env_irradiance(&env, hdrp_v3_make(0.0f, 1.0f, 0.0f));
    test_near((double)e.x / stats.illuminance_lux_rgb[0], 1.0, 5e-3);
    test_near((double)e.y / stats.illuminance_lux_rgb[1], 1.0, 5e-3);
    test_near((double)e.z / stats.illuminance_lux_rgb[2], 1.0, 5e-3);
    free(memory);
}

/* What a bake calibrates is what a lookup returns: nits, whatever a texel of 1 stands for. */
static void lookups_are_in_nits(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 8u, 4u, 2.0f);
    void* memory;
    image.nits_per_unit = 50.0f;
    hdrp_env env = bake(image, 4u, &memory);
    hdrp_v3 up = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    test_near((double)hdrp_env_radiance(&env, up, 0.0f).y, 100.0, 1e-3);
    test_near((double)hdrp_env_specular(&env, up, 0.6f).y, 100.0, 1e-3);
    test_near((double)hdrp_env_irradiance(&env, up).y, 100.0 * TEST_PI, 1e-3);
    test_near((double)hdrp_env_cube_lookup(&env.radiance, up, 1.3f).y, 100.0, 1e-3);
    free(memory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_and_roughness_are_inverse_and_end_where_they_should),
        cmocka_unit_test(lookups_at_texel_centres_read_the_texel),
        cmocka_unit_test(between_two_levels_is_their_mean),
        cmocka_unit_test(levels_outside_the_cube_are_its_ends),
        cmocka_unit_test(every_level_is_seamless),
        cmocka_unit_test(irradiance_of_level_ground_is_the_measured_illuminance),
        cmocka_unit_test(lookups_are_in_nits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
