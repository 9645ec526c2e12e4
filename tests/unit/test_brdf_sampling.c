/* test_brdf_sampling.c - directions drawn from the Lit model follow the density that it states.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#include "brdf_test.h"

#define MATERIALS 10

static bq_point points[BQ_MAX_POINTS];

/* From plain to everything at once; widths that the bins below can resolve. */
static hdrp_brdf_data material(int index)
{
    const hdrp_u32 features[MATERIALS] = {0u,
                                          0u,
                                          0u,
                                          HDRP_BRDF_FEATURE_ANISOTROPY,
                                          HDRP_BRDF_FEATURE_CLEAR_COAT,
                                          HDRP_BRDF_FEATURE_TRANSMISSION,
                                          HDRP_BRDF_FEATURE_REFRACTION,
                                          HDRP_BRDF_FEATURE_IRIDESCENCE,
                                          HDRP_BRDF_FEATURE_CLEAR_COAT,
                                          HDRP_BRDF_FEATURE_ALL};
    hdrp_brdf_surface s = bt_surface(0.8f, index % 3 == 1 ? 1.0f : 0.2f, 0.04f, 0.55f);
    s.perceptual_roughness = index == 2 ? 1.0f : 0.55f;
    s.features = features[index];
    s.anisotropy = 0.5f;
    s.coat_mask = 0.9f;
    s.coat_perceptual_roughness = 0.45f;
    s.film_mask = 1.0f;
    s.transmittance = hdrp_v3_make(0.9f, 0.5f, 0.7f);
    s.transmission = 0.6f;
    s.ior = 1.5f;
    if (index == 8) {
        s.coat_normal = hdrp_v3_make(0.5f, 0.2f, 1.0f);
    }
    return hdrp_brdf_data_from_surface(s);
}

static hdrp_v3 drawn(hdrp_brdf_data d, hdrp_brdf_lit_view w, uint64_t* seed)
{
    float x = bt_random_f(seed), y = bt_random_f(seed), z = bt_random_f(seed);
    return hdrp_brdf_lit_sample(d, w, hdrp_v3_make(x, y, z), d.features);
}

static void directions_follow_the_stated_density(void** state)
{
    enum { ROWS = 32, COLUMNS = 24, BINS = ROWS * COLUMNS, SAMPLES = 150000, FINE = 12 };
    (void)state;
    for (int k = 0; k < MATERIALS * 2; ++k) {
        static double seen[BINS], expected[BINS];
        hdrp_brdf_data d = material(k / 2);
        hdrp_v3 v = bt_direction(k % 2 ? 0.15 : 0.8, 0.5);
        hdrp_brdf_lit_view w = bt_view(d, v, d.features);
        uint64_t seed = 100u + (uint64_t)k;
        double total = 0.0;
        for (int i = 0; i < BINS; ++i) {
            seen[i] = expected[i] = 0.0;
        }
        for (int i = 0; i < ROWS * FINE; ++i) {
            for (int j = 0; j < COLUMNS * FINE; ++j) {
                double phi = 2.0 * BQ_PI * ((j + 0.5) / (COLUMNS * FINE) - 0.5);
                hdrp_v3 l = bt_direction(2.0 * (i + 0.5) / (ROWS * FINE) - 1.0, phi);
                double p = (double)hdrp_brdf_lit_pdf(d, w, l, d.features) * 4.0 * BQ_PI /
                           (BINS * FINE * FINE);
                expected[i / FINE * COLUMNS + j / FINE] += p * SAMPLES;
                total += p;
            }
        }
        for (int i = 0; i < SAMPLES; ++i) {
            hdrp_v3 l = drawn(d, w, &seed);
            double turn = atan2((double)l.y, (double)l.x) / (2.0 * BQ_PI) + 0.5;
            int row = (int)fmin((0.5 + 0.5 * (double)l.z) * ROWS, ROWS - 1);
            seen[row * COLUMNS + (int)fmin(turn * COLUMNS, COLUMNS - 1)] += 1.0;
        }
        double deviations = bt_chi_squared(seen, expected, BINS);
        if (!(deviations < 5.0 && fabs(total - 1.0) < 2e-3)) {
            fail_msg("%.1f standard deviations, integral %.5f, material %d, view %d", deviations,
                     total, k / 2, k % 2);
        }
    }
}

/* The estimate that a path tracer makes, against a quadrature. */
static void estimates_converge_to_the_albedo(void** state)
{
    const int samples = 100000;
    (void)state;
    for (int k = 0; k < MATERIALS; ++k) {
        hdrp_brdf_data d = material(k);
        double v[3] = {0.6, 0.0, 0.8}, sum = 0.0, square = 0.0, reference = 0.0;
        if (k == 8) {
            continue; /* its coat is tilted, the points are not */
        }
        hdrp_brdf_lit_view w = bt_view(d, bt_v3(v), d.features);
        uint64_t seed = 200u + (uint64_t)k;
        for (int i = 0; i < samples; ++i) {
            hdrp_v3 l = drawn(d, w, &seed);
            double p = (double)hdrp_brdf_lit_pdf(d, w, l, d.features);
            double f = bt_lit_sum(hdrp_brdf_lit_eval(d, w, l, d.features), 0);
            double estimate = p > 0.0 ? f / p : 0.0;
            sum += estimate;
            square += estimate * estimate;
        }
        int count = bt_lit_points(d, v, d.features, points);
        for (int i = 0; i < count; ++i) {
            hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, bt_v3(points[i].l), d.features);
            reference += points[i].weight * bt_lit_sum(r, 0);
        }
        double mean = sum / samples;
        double deviation = sqrt((square / samples - mean * mean) / samples);
        print_message("material %d: albedo %.4f, sampled %.4f +- %.4f\n", k, reference, mean,
                      deviation);
        assert_true(fabs(mean - reference) < 5.0 * deviation + 0.002);
        /* Samples are worth about the same: one of them carries little noise. */
        assert_true(deviation * sqrt((double)samples) < 0.8);
    }
}

static void a_direction_is_drawn_at_the_ends_of_the_square(void** state)
{
    const float ends[] = {0.0f, 1.0f};
    (void)state;
    for (int k = 0; k < MATERIALS * 8; ++k) {
        hdrp_brdf_data d = material(k / 8);
        hdrp_brdf_lit_view w = bt_view(d, bt_direction(0.3, 0.0), d.features);
        hdrp_v3 u = hdrp_v3_make(ends[k % 2], ends[k / 2 % 2], ends[k / 4 % 2]);
        hdrp_v3 l = hdrp_brdf_lit_sample(d, w, u, d.features);
        assert_true(fabsf(hdrp_v3_length(l) - 1.0f) < 1e-6f);
    }
}

static void a_black_surface_still_has_a_density(void** state)
{
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(bt_surface(0.0f, 0.0f, 0.0f, 0.5f));
    hdrp_v3 v = hdrp_v3_make(0.0f, 0.6f, 0.8f);
    hdrp_brdf_lit_view w = bt_view(d, v, 0u);
    uint64_t seed = 1;
    (void)state;
    assert_true(hdrp_brdf_lit_pdf(d, w, drawn(d, w, &seed), 0u) > 0.0f);
}

/* A coat whose normal turns away from the viewer is bent into view like a base is. All of it then
 * agrees on that view: what it reflects, how it is sampled, and with which density. */
static void a_coat_that_faces_away_is_bent_into_view(void** state)
{
    const float roughness[] = {0.03f, 0.2f, 0.5f};
    const double least[] = {0.93, 0.55, 0.2};
    const int samples = 100000;
    (void)state;
    for (int k = 0; k < 3; ++k) {
        hdrp_brdf_surface s = bt_surface(1.0f, 0.0f, 0.04f, 0.5f);
        s.features = HDRP_BRDF_FEATURE_CLEAR_COAT;
        s.coat_mask = 1.0f;
        s.coat_perceptual_roughness = roughness[k];
        s.coat_normal = hdrp_v3_make(-0.64f, 0.0f, 0.76f);
        hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
        hdrp_brdf_lit_view w = bt_view(d, bt_direction(0.3, 0.0), s.features);
        assert_true(hdrp_v3_dot(d.coat_normal, w.v) < -0.3f);
        double sum = 0.0, most = 0.0;
        uint64_t seed = 300u;
        for (int i = 0; i < samples; ++i) {
            hdrp_v3 l = drawn(d, w, &seed);
            double p = (double)hdrp_brdf_lit_pdf(d, w, l, d.features);
            double f = bt_lit_sum(hdrp_brdf_lit_eval(d, w, l, d.features), 0);
            sum += p > 0.0 ? f / p / samples : 0.0;
            most = fmax(most, p > 0.0 ? f / p : 0.0);
        }
        hdrp_brdf_lit_env e = hdrp_brdf_lit_env_make(d, w, d.features);
        print_message("coat of roughness %.2f: albedo %.4f, one sample at most %.2f\n",
                      (double)roughness[k], sum, most);
        /* Its Fresnel term is 1 there; what misses is shadowed, more the rougher it is. */
        assert_true(sum > least[k] && sum < 1.005 && most < 1.05);
        /* Seen at the horizon, the mirror direction is the continued view. */
        assert_true(hdrp_v3_dot(e.coat_direction, w.coat_v) < -0.999f);
        assert_true(fabsf(hdrp_v3_dot(e.coat_direction, d.coat_normal)) < 1e-3f);
    }
}

static void no_sample_outweighs_the_others(void** state)
{
    double most = 0.0, wall = 0.0;
    uint64_t seed = 400u;
    (void)state;
    for (int i = 0; i < 400000; ++i) {
        hdrp_brdf_surface s = bt_surface(bt_random_f(&seed), 0.0f, 0.04f, 0.0f);
        double x = bt_random(&seed);
        s.features = (hdrp_u32)i & HDRP_BRDF_FEATURE_ALL;
        s.metallic = i % 3 ? 0.0f : bt_random_f(&seed);
        s.anisotropy = 2.0f * bt_random_f(&seed) - 1.0f;
        s.coat_mask = bt_random_f(&seed);
        /* Rounding a grazing direction turns its half vector by more than narrower lobes are wide. */
        s.perceptual_roughness = 0.1f + 0.9f * bt_random_f(&seed);
        s.coat_perceptual_roughness = 0.05f + 0.9f * bt_random_f(&seed);
        s.coat_normal = bt_direction(1.0 - 0.3 * bt_random(&seed), 6.2832 * bt_random(&seed));
        s.film_mask = bt_random_f(&seed);
        s.film_thickness_nm = 1000.0f * bt_random_f(&seed);
        s.transmittance = hdrp_v3_splat(bt_random_f(&seed));
        s.transmission = bt_random_f(&seed);
        s.ior = 1.0f + 2.0f * bt_random_f(&seed);
        hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
        hdrp_v3 v = bt_direction(i % 4 ? x : 1e-4 + 0.01 * x, 6.2832 * bt_random(&seed));
        hdrp_brdf_lit_view w = bt_view(d, v, d.features);
        hdrp_v3 l = drawn(d, w, &seed);
        double p = (double)hdrp_brdf_lit_pdf(d, w, l, d.features);
        double f = bt_lit_sum(hdrp_brdf_lit_eval(d, w, l, d.features), 0);
        double weight = p > 0.0 ? f / p : 0.0;
        most = fmax(most, weight);
        wall = fmax(wall, hdrp_v3_dot(l, d.normal) < 0.0f ? weight : 0.0);
    }
    print_message("one sample weighs at most %.2f, of light through a wall or slab %.2f\n", most,
                  wall);
    assert_true(wall < 6.0 && most < 12.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_follow_the_stated_density),
        cmocka_unit_test(estimates_converge_to_the_albedo),
        cmocka_unit_test(a_direction_is_drawn_at_the_ends_of_the_square),
        cmocka_unit_test(a_black_surface_still_has_a_density),
        cmocka_unit_test(a_coat_that_faces_away_is_bent_into_view),
        cmocka_unit_test(no_sample_outweighs_the_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
