/* test_env_bake.c - cubes of radiance, GGX lobes and irradiance from images.
 * SPDX-License-Identifier: MIT */
#define HDRP_ENV_IMPLEMENTATION
#include "env_test.h"

static hdrp_env make_env(hdrp_env_desc desc, void** memory)
{
    hdrp_env env;
    size_t bytes = hdrp_env_memory_size(&desc);
    assert_true(bytes > 0u);
    *memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_non_null(*memory);
    memset(*memory, 0xff, bytes);
    assert_int_equal(hdrp_env_init(&env, &desc, *memory, bytes), HDRP_OK);
    return env;
}

static hdrp_env_desc make_desc(uint32_t radiance, uint32_t specular, uint32_t irradiance)
{
    hdrp_env_desc desc = {0};
    desc.radiance_size = radiance;
    desc.specular_size = specular;
    desc.irradiance_size = irradiance;
    return desc;
}

static size_t texel_count(const hdrp_env_cube* cube)
{
    size_t count = 0u;
    for (uint32_t level = 0; level < cube->level_count; ++level) {
        count += (size_t)6u * (cube->size >> level) * (cube->size >> level);
    }
    return count;
}

static void expect_constant(const hdrp_env_cube* cube, double value)
{
    for (size_t i = 0; i < texel_count(cube); ++i) {
        test_near_v3(hdrp_v3_from_v4(cube->texels[i]), value, value, value, 1e-6 * value);
        assert_true(cube->texels[i].w > 0.0f);
    }
}

static void a_constant_sky_stays_constant(void** state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {3, 5}, {64, 32}, {300, 150}};
    for (int i = 0; i < 10; ++i) {
        bool cube = i % 2;
        hdrp_env_image image = test_image(cube ? HDRP_ENV_CUBE : HDRP_ENV_LATLONG, sizes[i / 2][0],
                                          sizes[i / 2][cube ? 0 : 1], 3.0f);
        hdrp_env_desc desc = make_desc(1u << i / 2, i % 3 ? 0u : 1u << i / 4, 1u << i % 4);
        void* memory;
        hdrp_env env = make_env(desc, &memory);
        hdrp_env_sh sh;
        assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
        expect_constant(&env.radiance, 3.0);
        expect_constant(&env.specular, 3.0);
        expect_constant(&env.irradiance, 3.0 * TEST_PI);
        assert_int_equal(hdrp_env_project_sh(&env, &sh), HDRP_OK);
        test_near_v3(hdrp_env_irradiance_fast(sh, test_unit(1, 2, -3)), 3.0 * TEST_PI,
                     3.0 * TEST_PI, 3.0 * TEST_PI, 1e-5);
        free(memory);
        free(image.texels);
    }
}

/* The pole of a sky that is white above and black below sees it all, the opposite one nothing; at
 * the horizon, half. */
static void half_a_sky_lights_half_the_normals(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 64u, 32u, 0.0f);
    void* memory;
    hdrp_env env = make_env(make_desc(64u, 32u, 32u), &memory);
    for (uint32_t i = 0; i < 3u * 64u * 16u; ++i) {
        image.texels[i] = 1.0f;
    }
    assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
    test_near((double)hdrp_env_irradiance(&env, test_unit(0, 1, 0)).x / TEST_PI, 1.0, 2e-3);
    test_near((double)hdrp_env_irradiance(&env, test_unit(0, -1, 0)).x / TEST_PI, 0.0, 2e-3);
    test_near((double)hdrp_env_irradiance(&env, test_unit(1, 0, 0.3)).x / TEST_PI, 0.5, 2e-3);
    test_near((double)hdrp_env_specular(&env, test_unit(0.1, 1, 0), 0.3f).x, 1.0, 1e-3);
    test_near((double)hdrp_env_specular(&env, test_unit(0.1, -1, 0), 0.3f).x, 0.0, 1e-3);
    test_near((double)hdrp_env_specular(&env, test_unit(1, 0, 0.2), 0.5f).x, 0.5, 2e-3);
    free(memory);
    free(image.texels);
}

static void mip_levels_keep_the_flux_and_the_sphere(void** state)
{
    (void)state;
    hdrp_env_image image = test_random_image(HDRP_ENV_LATLONG, 128u, 64u);
    hdrp_env_stats before = {0}, after = {0};
    void* memory;
    hdrp_env env = make_env(make_desc(32u, 1u, 1u), &memory);
    assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
    assert_int_equal(hdrp_env_measure(&image, &before), HDRP_OK);
    for (uint32_t level = 0; level < env.radiance.level_count; ++level) {
        hdrp_env_image cube = hdrp_env_cube_image(&env.radiance, level);
        double solid_angle = 0.0;
        for (uint32_t k = 0; k < 6u * cube.width * cube.width; ++k) {
            solid_angle += (double)cube.texels[4u * k + 3u];
        }
        assert_int_equal(cube.width, 32u >> level);
        assert_int_equal(hdrp_env_measure(&cube, &after), HDRP_OK);
        test_near(after.average_nits / before.average_nits, 1.0, 1e-4);
        test_near(solid_angle, 4.0 * TEST_PI, 1e-5);
    }
    free(memory);
    free(image.texels);
}

/* A cube of the same size is taken over as it is. */
static void a_cube_of_the_same_size_is_copied(void** state)
{
    (void)state;
    hdrp_env_image image = test_random_image(HDRP_ENV_CUBE, 16u, 16u);
    void* memory;
    hdrp_env env = make_env(make_desc(16u, 8u, 1u), &memory);
    assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
    for (size_t k = 0; k < 6u * 256u; ++k) {
        for (int c = 0; c < 3; ++c) {
            double expected = (double)image.texels[3u * k + (size_t)c];
            test_near((double)(&env.radiance.texels[k].x)[c], expected, 1e-6 * expected);
        }
    }
    /* Level 0 of the specular cube is the level of its size. */
    assert_memory_equal(env.specular.texels, env.radiance.texels + 6u * 256u,
                        6u * 64u * sizeof(hdrp_v4));
    free(memory);
    free(image.texels);
}

static void no_step_depends_on_the_split(void** state)
{
    (void)state;
    for (int kind = 0; kind < 2; ++kind) {
        hdrp_env_image image = test_random_image((hdrp_env_image_kind)kind, 40u, 40u);
        hdrp_env_desc desc = make_desc(16u, 16u, 4u);
        size_t bytes = hdrp_env_memory_size(&desc);
        void *whole, *split;
        hdrp_env a = make_env(desc, &whole), b = make_env(desc, &split);
        assert_int_equal(hdrp_env_bake(&a, &image), HDRP_OK);
        for (uint32_t step = 1; step < 50u; step += step < 8u ? 1u : 7u) {
            uint32_t end[4] = {96u, 6u, hdrp_env_specular_rows(&b), 24u};
            memset(split, 0xff, bytes);
            for (int stage = 0; stage < 4; ++stage) {
                for (uint32_t e = end[stage]; e > 0u; e -= e < step ? e : step) {
                    uint32_t first = e < step ? 0u : e - step;
                    hdrp_result r = stage == 0   ? hdrp_env_resample(&b, &image, first, e - first)
                                    : stage == 1 ? hdrp_env_reduce(&b, first, e - first)
                                    : stage == 2
                                        ? hdrp_env_prefilter(&b, first, e - first)
                                        : hdrp_env_convolve_irradiance(&b, first, e - first);
                    assert_int_equal(r, HDRP_OK);
                }
            }
            assert_memory_equal(whole, split, bytes);
        }
        free(whole);
        free(split);
        free(image.texels);
    }
}

static void expect_finite(const hdrp_env_cube* cube)
{
    for (size_t i = 0; i < texel_count(cube); ++i) {
        hdrp_v4 t = cube->texels[i];
        assert_true(t.x >= 0.0f && t.x <= HDRP_FLT_MAX && t.y >= 0.0f && t.y <= HDRP_FLT_MAX &&
                    t.z >= 0.0f && t.z <= HDRP_FLT_MAX);
    }
}

static void any_sky_gives_finite_light_that_is_not_negative(void** state)
{
    (void)state;
    float bright[] = {72704.0f, 1e12f, HDRP_FLT_MAX, INFINITY, NAN, -INFINITY, -5.0f, 1e-40f};
    for (int i = 0; i < 8; ++i) {
        hdrp_env_image image = test_random_image(HDRP_ENV_LATLONG, 32u, 16u);
        void* memory;
        hdrp_env env = make_env(make_desc(32u, 16u, 4u), &memory);
        hdrp_env_sh sh;
        image.texels[3 * 32 * 4 + 30] = bright[i];
        image.texels[3 * 32 * 8 + 31] = bright[i];
        assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
        assert_int_equal(hdrp_env_project_sh(&env, &sh), HDRP_OK);
        expect_finite(&env.radiance);
        expect_finite(&env.specular);
        expect_finite(&env.irradiance);
        uint64_t random = 8u;
        for (int k = 0; k < 1000; ++k) {
            hdrp_v3 e = hdrp_env_irradiance_fast(sh, test_direction(&random));
            assert_true(e.x >= 0.0f && e.x <= HDRP_FLT_MAX && e.y >= 0.0f && e.z >= 0.0f);
        }
        if (i == 0) { /* a sun that half floats cannot hold keeps its brightness */
            hdrp_env_image cube = hdrp_env_cube_image(&env.radiance, 0u);
            hdrp_env_stats stats = {0};
            assert_int_equal(hdrp_env_measure(&cube, &stats), HDRP_OK);
            assert_true(stats.peak_nits > 0.2 * 72704.0 * 0.2126);
        }
        free(memory);
        free(image.texels);
    }
}

static void a_black_sky_is_black(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 8u, 4u, 0.0f);
    void* memory;
    hdrp_env env = make_env(make_desc(8u, 8u, 4u), &memory);
    assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
    for (size_t i = 0; i < texel_count(&env.specular); ++i) {
        hdrp_v4 t = env.specular.texels[i];
        assert_true(t.x == 0.0f && t.y == 0.0f && t.z == 0.0f);
    }
    assert_true(hdrp_env_irradiance(&env, test_unit(1, 2, 3)).y == 0.0f);
    free(memory);
    free(image.texels);
}

/* Reflections of one lamp fall off as the lobe does, and every level holds the same light. */
static void a_lamp_is_spread_by_the_lobe(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_CUBE, 64u, 64u, 0.0f);
    void* memory;
    hdrp_env env = make_env(make_desc(64u, 64u, 4u), &memory);
    hdrp_v3 lamp = test_unit(1, -0.5 / 32.0, -0.5 / 32.0); /* centre of texel (32, 32) of +X */
    for (int c = 0; c < 3; ++c) {
        image.texels[3 * (64 * 32 + 32) + c] = 1000.0f;
    }
    assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
    for (uint32_t level = 2; level < env.specular.level_count; ++level) {
        double r =
            (double)hdrp_env_perceptual_roughness_from_lod((float)level, env.specular.level_count);
        double a2 = r * r * r * r, norm = 0.0;
        for (int i = 0; i < 100000; ++i) {
            /* t is the squared sine of half the angle; 4 pi dt is the solid angle. */
            double t = 0.5 * (i + 0.5) / 100000.0, k = t * (1.0 - a2) + a2;
            norm += (1.0 - 2.0 * t) / (k * k) * 2.0 * TEST_PI / 100000.0;
        }
        uint32_t n = 64u >> level;
        for (uint32_t k = 0; k < n * n; ++k) {
            hdrp_env_place place = {0u, ((float)(k % n) + 0.5f) / (float)n,
                                    ((float)(k / n) + 0.5f) / (float)n};
            hdrp_env_image level_image = hdrp_env_cube_image(&env.specular, level);
            double t = 0.5 * (1.0 - (double)hdrp_v3_dot(hdrp_env_direction_from_cube(place), lamp));
            double lobe = (1.0 - 2.0 * t) / pow(t * (1.0 - a2) + a2, 2.0) / norm;
            double expected = 1000.0 * (double)hdrp_env_cube_solid_angle(32u, 32u, 64u) * lobe;
            test_near((double)level_image.texels[4u * k] / expected, 1.0, 0.02);
        }
    }
    free(memory);
    free(image.texels);
}

/* A clamped cosine has 2 pi / 3 and pi / 4 at orders 1 and 2: undershoot of 0.04 of a lone sun,
 * gone when windowed by 0.18. */
static void windowing_keeps_a_lone_sun_positive(void** state)
{
    (void)state;
    hdrp_env_image image = test_image(HDRP_ENV_CUBE, 64u, 64u, 0.0f);
    void* memory;
    hdrp_env env = make_env(make_desc(64u, 1u, 1u), &memory);
    hdrp_env_sh sh, soft;
    double lowest[2] = {1e9, 1e9};
    for (int c = 0; c < 3; ++c) {
        image.texels[3 * (64 * 32 + 32) + c] = 1000.0f;
    }
    assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
    assert_int_equal(hdrp_env_project_sh(&env, &sh), HDRP_OK);
    soft = hdrp_env_sh_windowed(sh, 0.18f);
    for (int i = 0; i <= 1000; ++i) {
        double angle = TEST_PI * i / 1000.0;
        hdrp_v3 n = test_unit(cos(angle), sin(angle), 0.0);
        assert_true(hdrp_env_irradiance_fast(sh, n).x >= 0.0f);
        /* With an offset the clamp at 0 is out of the way. */
        hdrp_env_sh lifted = sh, lifted_soft = soft;
        lifted.mean.x += 1.0f;
        lifted_soft.mean.x += 1.0f;
        lowest[0] = fmin(lowest[0], (double)hdrp_env_irradiance_fast(lifted, n).x - 1.0);
        lowest[1] = fmin(lowest[1], (double)hdrp_env_irradiance_fast(lifted_soft, n).x - 1.0);
    }
    double lux = 1000.0 * (double)hdrp_env_cube_solid_angle(32u, 32u, 64u);
    test_near(lowest[0] / lux, -0.04, 0.002);
    assert_true(lowest[1] > 0.0);
    free(memory);
    free(image.texels);
}

/* A row of the image that holds the direction of some point of the rows to write is visited. */
static void no_row_is_missed_that_touches_the_target(void** state)
{
    (void)state;
    const uint32_t n = 64u, ends[][2] = {{0, 64}, {0, 1}, {63, 64}, {20, 30}, {31, 33}, {40, 64}};
    for (uint32_t face = 0; face < 6u; ++face) {
        for (int k = 0; k < 6; ++k) {
            hdrp_i_env_target target = {0};
            target.face = face;
            target.size = n;
            target.first_row = ends[k][0];
            target.end_row = ends[k][1];
            for (int i = 0; i <= 256 * 64; ++i) {
                /* All of the width, the rows from one end to the other, but for a rounding. */
                double s = (i % 257 / 128.0 - 1.0) * (1.0 - 1e-6), t = (i / 257 / 63.0) * 0.9998;
                t = (ends[k][0] + (ends[k][1] - ends[k][0]) * (t + 1e-4)) * 2.0 / n - 1.0;
                hdrp_v3 p = hdrp_env_point_from_cube(face, (float)s, (float)t);
                double polar = atan2(hypot((double)p.x, (double)p.z), (double)p.y);
                double from = polar - 1e-7, to = polar + 1e-7;
                double sines[2] = {sin(from), sin(to)}, cosines[2] = {cos(from), cos(to)};
                assert_true(from < 0.0 || to > TEST_PI ||
                            hdrp_i_env_row_sees(&target, sines, cosines));
            }
        }
    }
}

/* A clamped cosine to order 2 is 1/4 + c / 2 + 5/32 (3 c^2 - 1). */
static void harmonics_of_a_lamp_are_those_of_a_clamped_cosine(void** state)
{
    (void)state;
    const uint32_t n = 128u, texels[] = {17u * 128u + 40u, 90u * 128u + 100u, 64u * 128u + 3u};
    uint64_t random = 10u;
    for (uint32_t i = 0; i < 6u; ++i) {
        hdrp_env_image image = test_image(HDRP_ENV_CUBE, n, n, 0.0f);
        void* memory;
        hdrp_env env = make_env(make_desc(n, 1u, 1u), &memory);
        uint32_t k = texels[i % 3u];
        hdrp_env_place place = {i, ((float)(k % n) + 0.5f) / (float)n,
                                ((float)(k / n) + 0.5f) / (float)n};
        hdrp_v3 lamp = hdrp_env_direction_from_cube(place);
        double lux = 1000.0 * (double)hdrp_env_cube_solid_angle(k % n, k / n, n);
        hdrp_env_sh sh;
        image.texels[3u * (i * n * n + k) + 1u] = 1000.0f;
        assert_int_equal(hdrp_env_resample(&env, &image, 0u, 6u * n), HDRP_OK);
        assert_int_equal(hdrp_env_reduce(&env, 0u, 6u), HDRP_OK);
        assert_int_equal(hdrp_env_project_sh(&env, &sh), HDRP_OK);
        for (int j = 0; j < 200; ++j) {
            hdrp_v3 normal = test_direction(&random);
            double c = (double)hdrp_v3_dot(normal, lamp);
            double expected = 0.25 + 0.5 * c + 5.0 / 32.0 * (3.0 * c * c - 1.0);
            double measured = (double)hdrp_env_irradiance_fast(sh, normal).y / lux;
            test_near(measured, fmax(expected, 0.0), 2e-5);
        }
        free(memory);
        free(image.texels);
    }
}

/* Moments of the directions in a texel near the middle of a face, where it is a square. */
static void a_texel_spreads_its_light_as_a_square(void** state)
{
    (void)state;
    const uint32_t n = 256u;
    void* memory;
    hdrp_env env = make_env(make_desc(n, 1u, 1u), &memory);
    hdrp_env_image image = test_image(HDRP_ENV_CUBE, n, n, 1.0f);
    assert_int_equal(hdrp_env_resample(&env, &image, 0u, 6u * n), HDRP_OK);
    for (uint32_t face = 0; face < 6u; ++face) {
        double m2[3] = {0.0, 0.0, 0.0}, m[3] = {0.0, 0.0, 0.0};
        hdrp_env_node node = hdrp_i_env_node_at(&env, 0u, (size_t)(face * n + n / 2u) * n + n / 2u);
        double spread[3] = {(double)node.light.xx, (double)node.light.yy, (double)node.light.zz};
        for (int i = 0; i < 32 * 32; ++i) {
            double s = 2.0 / n * (i % 32 + 0.5) / 32.0, t = 2.0 / n * (i / 32 + 0.5) / 32.0;
            hdrp_v3 p = hdrp_env_point_from_cube(face, (float)s, (float)t);
            double x[3] = {(double)p.x, (double)p.y, (double)p.z};
            double length = sqrt(1.0 + s * s + t * t);
            for (int c = 0; c < 3; ++c) {
                m[c] += x[c] / length / 1024.0;
                m2[c] += x[c] * x[c] / (length * length) / 1024.0;
            }
        }
        for (int c = 0; c < 3; ++c) {
            /* Exact but for the samples, which lack a thousandth of the variance. */
            double expected = (m2[c] - m[c] * m[c]) / (1.0 - 1.0 / (32.0 * 32.0));
            test_near(spread[c], expected, 2e-4 * pow(2.0 / n, 2.0) / 12.0);
        }
    }
    free(memory);
    free(image.texels);
}

/* Beyond a spread of 1 / (4 m r) the series would turn negative: it stays what it is there. */
static void the_series_ends_where_a_part_is_wider_than_the_lobe(void** state)
{
    (void)state;
    hdrp_i_env_lobe lobe = hdrp_i_env_lobe_make(0.001f, 0.4f);
    hdrp_v3 middle = hdrp_v3_make(0.002f, 1.0f, 0.0f);
    lobe.axis = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    /* d.d and 4 a are 4e-6 each, so that 1 / r is 8e-6; the cosine is 1 within 2e-5. */
    double limit = 0.25 * 8e-6;
    double value[2];
    for (int i = 0; i < 2; ++i) {
        float xx = (float)(limit * (i == 0 ? 0.99999 : 10.0));
        hdrp_env_spread part = {middle, xx, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
        value[i] = (double)hdrp_i_env_kernel(lobe, part).value;
    }
    test_near(value[1] / value[0], 1.0, 1e-4);
}

static void bad_descriptions_and_blocks_are_refused(void** state)
{
    (void)state;
    hdrp_env_desc bad[10];
    hdrp_env env, before;
    char* memory;
    size_t bytes;
    memset(bad, 0, sizeof bad);
    bad[0].radiance_size = 3u;
    bad[1].radiance_size = 8192u;
    bad[2].specular_size = 512u;
    bad[3].specular_size = 100u;
    bad[4].irradiance_size = 512u;
    bad[5].specular_levels = 9u;
    bad[6].opening = -0.1f;
    bad[7].opening = 1.1f;
    bad[8].opening = NAN;
    bad[9].irradiance_size = 3u;
    memset(&env, 7, sizeof env);
    before = env;
    bytes = hdrp_env_memory_size(NULL);
    assert_int_equal(bytes % HDRP_MEMORY_ALIGNMENT, 0);
    memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, (bytes + 31u) / 16u * 16u);
    for (int i = 0; i < 10; ++i) {
        assert_int_equal(hdrp_env_memory_size(&bad[i]), 0);
        assert_int_equal(hdrp_env_init(&env, &bad[i], memory, bytes), HDRP_ERROR_BAD_ARGUMENT);
    }
    assert_int_equal(hdrp_env_init(&env, NULL, memory, bytes - 1u), HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(hdrp_env_init(&env, NULL, memory + 8, bytes), HDRP_ERROR_MEMORY_ALIGNMENT);
    assert_int_equal(hdrp_env_init(&env, NULL, NULL, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_init(NULL, NULL, memory, bytes), HDRP_ERROR_NULL_POINTER);
    assert_memory_equal(&env, &before, sizeof env);
    free(memory);
}

static void bad_ranges_are_refused_and_write_nothing(void** state)
{
    (void)state;
    hdrp_env_desc desc = make_desc(4u, 4u, 2u);
    size_t bytes = hdrp_env_memory_size(&desc);
    hdrp_env_image image = test_image(HDRP_ENV_LATLONG, 4u, 2u, 1.0f), bad = image;
    void* memory;
    hdrp_env env = make_env(desc, &memory);
    unsigned char* byte = memory;
    bad.texels = NULL;
    assert_int_equal(hdrp_env_specular_rows(&env), 6u * (4u + 2u + 1u));
    assert_int_equal(hdrp_env_specular_rows(NULL), 0);
    assert_int_equal(hdrp_env_resample(&env, &image, 20u, 5u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_resample(&env, &bad, 0u, 1u), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_resample(NULL, &image, 0u, 1u), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_reduce(&env, 7u, 0u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_reduce(NULL, 0u, 6u), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_prefilter(&env, 1u, 42u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_prefilter(NULL, 0u, 0u), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_convolve_irradiance(&env, 13u, 0u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_convolve_irradiance(NULL, 0u, 0u), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_bake(&env, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_bake(NULL, &image), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_env_project_sh(&env, NULL), HDRP_ERROR_NULL_POINTER);
    for (size_t i = 0; i < bytes; ++i) {
        assert_int_equal(byte[i], 0xff);
    }
    free(memory);
    free(image.texels);
}

/* Resampling begins with clearing what it writes. */
static void an_environment_is_not_resampled_from_itself(void** state)
{
    (void)state;
    hdrp_env_image image = test_random_image(HDRP_ENV_LATLONG, 16u, 8u);
    hdrp_env_desc desc = make_desc(8u, 8u, 2u);
    size_t bytes = hdrp_env_memory_size(&desc), level = 6u * 64u * sizeof(hdrp_v4);
    void* other;
    unsigned char* before = malloc(bytes);
    char* block = aligned_alloc(HDRP_MEMORY_ALIGNMENT, level + bytes);
    char* memory = block + level;
    hdrp_env env, copy = make_env(desc, &other);
    assert_true(before && block);
    memset(memory, 0xff, bytes);
    assert_int_equal(hdrp_env_init(&env, &desc, memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_env_bake(&env, &image), HDRP_OK);
    hdrp_env_image own = hdrp_env_cube_image(&env.radiance, 0u);
    memcpy(before, memory, bytes);
    assert_int_equal(hdrp_env_bake(&env, &own), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_env_resample(&env, &own, 7u, 1u), HDRP_ERROR_BAD_ARGUMENT);
    own.texels += (size_t)4u * (6u * 64u - 1u); /* its first texel is the last of the level */
    assert_int_equal(hdrp_env_bake(&env, &own), HDRP_ERROR_BAD_ARGUMENT);
    own.texels = (float*)(void*)block + 4; /* and its last the first */
    assert_int_equal(hdrp_env_bake(&env, &own), HDRP_ERROR_BAD_ARGUMENT);
    assert_memory_equal(before, memory, bytes);
    /* Other levels and other cubes are read before they are written. */
    own = hdrp_env_cube_image(&env.radiance, 1u);
    assert_int_equal(hdrp_env_bake(&copy, &own), HDRP_OK);
    assert_int_equal(hdrp_env_bake(&env, &own), HDRP_OK);
    assert_memory_equal(env.radiance.texels, copy.radiance.texels, bytes);
    free(before);
    free(block);
    free(other);
    free(image.texels);
}

/* The series in the spread of a part has a negative mean where the part is wider than the lobe. */
static void a_lobe_narrower_than_a_texel_stays_positive(void** state)
{
    (void)state;
    for (int i = 1; i <= 40; ++i) {
        float alpha = 0.005f * (float)i;
        hdrp_i_env_lobe lobe = hdrp_i_env_lobe_make(alpha, 0.4f);
        hdrp_env_spread part = {{0.0f, 0.99f, 0.0f}, 0.005f, 0.0f, 0.005f, 0.0f, 0.0f, 0.0f};
        lobe.axis = hdrp_v3_make(0.0f, 1.0f, 0.0f);
        /* Never above the peak, at least a third of it at the distance of the part. */
        double peak = 1.0 / pow(4.0 * (double)alpha * (double)alpha, 2.0);
        double there = 1.0 / pow(1e-4 + 4.0 * (double)alpha * (double)alpha, 2.0);
        double value = (double)hdrp_i_env_kernel(lobe, part).value;
        assert_true(value > there / 3.0 && value < peak);
    }
}

static void the_layout_of_harmonics_is_the_documented_one(void** state)
{
    (void)state;
    assert_int_equal(sizeof(hdrp_env_sh), 9 * 16);
    assert_int_equal(offsetof(hdrp_env_sh, mean), 0);
    assert_int_equal(offsetof(hdrp_env_sh, xy), 64);
    assert_int_equal(offsetof(hdrp_env_sh, xx), 128);
    assert_int_equal(HDRP_ENV_SH_LAYOUT_VERSION, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_sky_stays_constant),
        cmocka_unit_test(half_a_sky_lights_half_the_normals),
        cmocka_unit_test(mip_levels_keep_the_flux_and_the_sphere),
        cmocka_unit_test(a_cube_of_the_same_size_is_copied),
        cmocka_unit_test(no_step_depends_on_the_split),
        cmocka_unit_test(any_sky_gives_finite_light_that_is_not_negative),
        cmocka_unit_test(a_black_sky_is_black),
        cmocka_unit_test(a_lamp_is_spread_by_the_lobe),
        cmocka_unit_test(windowing_keeps_a_lone_sun_positive),
        cmocka_unit_test(no_row_is_missed_that_touches_the_target),
        cmocka_unit_test(harmonics_of_a_lamp_are_those_of_a_clamped_cosine),
        cmocka_unit_test(a_texel_spreads_its_light_as_a_square),
        cmocka_unit_test(the_series_ends_where_a_part_is_wider_than_the_lobe),
        cmocka_unit_test(bad_descriptions_and_blocks_are_refused),
        cmocka_unit_test(bad_ranges_are_refused_and_write_nothing),
        cmocka_unit_test(the_layout_of_harmonics_is_the_documented_one),
        cmocka_unit_test(an_environment_is_not_resampled_from_itself),
        cmocka_unit_test(a_lobe_narrower_than_a_texel_stays_positive),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
