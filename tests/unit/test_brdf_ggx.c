/* test_brdf_ggx.c - the GGX lobe is a distribution, and stays finite where highlights are extreme.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#include "brdf_test.h"

static const float widths[] = {1e-4f, 1e-3f, 0.01f, 0.09f, 0.36f, 0.7f, 1.0f};
#define WIDTH_COUNT 7

/* Integral of D cos over the hemisphere, in slopes: each quadrant by Gauss-Legendre in the scaled
 * radius and the azimuth. */
static double total(float at, float ab)
{
    double x[64], w[64], sum = 0.0;
    bq_gauss_legendre(64, x, w);
    for (int i = 0; i < 64; ++i) {
        /* r from 0 to infinity. The tail of D falls with r^-4. */
        double r = x[i] / (1.0 - x[i]), dr = w[i] / ((1.0 - x[i]) * (1.0 - x[i]));
        for (int j = 0; j < 64; ++j) {
            double phi = 0.5 * BQ_PI * x[j], sx = (double)at * r * cos(phi);
            double sy = (double)ab * r * sin(phi), c = 1.0 / sqrt(1.0 + sx * sx + sy * sy);
            hdrp_v3 h = hdrp_v3_make((float)(-sx * c), (float)(-sy * c), (float)c);
            float d = at == ab ? hdrp_brdf_d_ggx_vectors(hdrp_v3_make(0.0f, 0.0f, 1.0f), h, at)
                               : hdrp_brdf_d_ggx_aniso(h.x, h.y, h.z, at, ab);
            /* d(omega) cos = c^4 d(slopes). */
            sum +=
                w[j] * 2.0 * BQ_PI * dr * r * (double)at * (double)ab * c * c * c * c * (double)d;
        }
    }
    return sum;
}

static void the_isotropic_distribution_integrates_to_one(void** state)
{
    (void)state;
    for (int i = 0; i < WIDTH_COUNT; ++i) {
        assert_true(fabs(total(widths[i], widths[i]) - 1.0) < 1e-5);
    }
}

static void the_anisotropic_distribution_integrates_to_one(void** state)
{
    (void)state;
    for (int i = 0; i < WIDTH_COUNT; ++i) {
        for (int j = 0; j < WIDTH_COUNT; ++j) {
            if (i != j) {
                assert_true(fabs(total(widths[i], widths[j]) - 1.0) < 1e-5);
            }
        }
    }
}

static void equal_widths_are_isotropic(void** state)
{
    uint64_t seed = 1;
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f), t = hdrp_v3_make(1.0f, 0.0f, 0.0f);
    hdrp_v3 b = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        float a = widths[i % WIDTH_COUNT];
        hdrp_v3 l = bt_direction(bt_random(&seed), 6.2832 * bt_random(&seed));
        hdrp_v3 v = bt_direction(bt_random(&seed), 6.2832 * bt_random(&seed));
        hdrp_v3 h = hdrp_brdf_half_vector(l, v, n);
        double d1 = (double)hdrp_brdf_d_ggx_vectors(n, h, a);
        double d2 = (double)hdrp_brdf_d_ggx_aniso_vectors(t, b, n, h, a, a);
        double v1 = (double)hdrp_brdf_v_smith_ggx(l.z, v.z, a);
        double v2 = (double)hdrp_brdf_v_smith_ggx_aniso(l.x, l.y, l.z, v.x, v.y, v.z, a, a);
        assert_true(fabs(d1 / d2 - 1.0) < 2e-6 && fabs(v1 / v2 - 1.0) < 1e-6);
    }
}

static void visibility_is_the_masking_of_both_directions(void** state)
{
    uint64_t seed = 2;
    (void)state;
    for (int i = 0; i < 5000; ++i) {
        double a = (double)widths[i % WIDTH_COUNT], c[2], lambda = 0.0;
        for (int k = 0; k < 2; ++k) {
            c[k] = (double)(float)(0.001 + 0.999 * bt_random(&seed));
            lambda += 0.5 * (sqrt(1.0 + a * a * (1.0 / (c[k] * c[k]) - 1.0)) - 1.0);
        }
        double v = (double)hdrp_brdf_v_smith_ggx((float)c[0], (float)c[1], (float)a);
        assert_true(fabs(v * 4.0 * c[0] * c[1] * (1.0 + lambda) - 1.0) < 1e-6);
    }
}

static void visibility_does_not_tell_the_light_from_the_view(void** state)
{
    uint64_t seed = 3;
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        float a = bt_random_f(&seed), b = 2.0f * bt_random_f(&seed);
        hdrp_v3 l = bt_direction(bt_random(&seed), 6.2832 * bt_random(&seed));
        hdrp_v3 v = bt_direction(bt_random(&seed), 6.2832 * bt_random(&seed));
        double x = (double)hdrp_brdf_v_smith_ggx_aniso(l.x, l.y, l.z, v.x, v.y, v.z, a, b);
        double y = (double)hdrp_brdf_v_smith_ggx_aniso(v.x, v.y, v.z, l.x, l.y, l.z, a, b);
        assert_true(fabs(x / y - 1.0) < 1e-6);
        x = (double)hdrp_brdf_v_smith_ggx_fast(l.z, v.z, a);
        y = (double)hdrp_brdf_v_smith_ggx_fast(v.z, l.z, a);
        assert_true(fabs(x / y - 1.0) < 1e-6);
    }
}

static void a_width_below_the_minimum_acts_as_the_minimum(void** state)
{
    const float below[] = {0.0f, 1e-10f, -1.0f, NAN};
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f), h = hdrp_v3_make(1e-4f, 0.0f, 1.0f);
    (void)state;
    for (int i = 0; i < 4; ++i) {
        float a = below[i], m = HDRP_ALPHA_MIN;
        assert_true(hdrp_brdf_d_ggx(0.99f, a) == hdrp_brdf_d_ggx(0.99f, m));
        assert_true(hdrp_brdf_d_ggx_vectors(n, h, a) == hdrp_brdf_d_ggx_vectors(n, h, m));
        assert_true(hdrp_brdf_v_smith_ggx(0.5f, 0.25f, a) == hdrp_brdf_v_smith_ggx(0.5f, 0.25f, m));
        assert_true(hdrp_brdf_d_ggx_aniso(h.x, h.y, h.z, a, 0.5f) ==
                    hdrp_brdf_d_ggx_aniso(h.x, h.y, h.z, m, 0.5f));
    }
}

static void the_peak_is_one_over_pi_alpha_squared(void** state)
{
    hdrp_v3 n = hdrp_v3_make(0.6f, 0.0f, 0.8f);
    (void)state;
    for (int i = 0; i < WIDTH_COUNT; ++i) {
        double a = (double)widths[i], peak = 1.0 / (BQ_PI * a * a);
        assert_true(fabs((double)hdrp_brdf_d_ggx(1.0f, widths[i]) / peak - 1.0) < 1e-6);
        assert_true(fabs((double)hdrp_brdf_d_ggx_vectors(n, n, widths[i]) / peak - 1.0) < 1e-6);
    }
}

/* Both directions at the horizon: the largest value of V meets the largest of D. */
static void the_lobe_stays_finite_at_grazing(void** state)
{
    const float c[] = {0.0f, 1e-38f, 1e-20f, 1e-7f, 1e-4f, 1.0f};
    (void)state;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            float v = hdrp_brdf_v_smith_ggx(c[i], c[j], 0.0f);
            float lobe = hdrp_brdf_d_ggx(1.0f, 0.0f) * v * c[i];
            assert_true(lobe >= 0.0f && lobe <= HDRP_FLT_MAX);
            assert_true(c[i] > 0.0f || lobe == 0.0f);
        }
    }
}

static void opposite_directions_have_a_half_vector(void** state)
{
    hdrp_v3 n = hdrp_v3_make(0.0f, 1.0f, 0.0f), v = hdrp_v3_make(0.6f, 0.0f, 0.8f);
    (void)state;
    hdrp_v3 h = hdrp_brdf_half_vector(hdrp_v3_neg(v), v, n);
    assert_true(h.x == n.x && h.y == n.y && h.z == n.z);
    h = hdrp_brdf_half_vector(v, v, n);
    assert_true(fabsf(hdrp_v3_dot(h, v) - 1.0f) < 1e-6f);
}

/* The density of the reflected directions is what samples reflect above the horizon. */
static void the_sampled_density_integrates_to_what_stays_above(void** state)
{
    static bq_point points[BQ_MAX_POINTS];
    bq_rule rule = bq_make(24, 12);
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    uint64_t seed = 4;
    (void)state;
    for (int i = 2; i < WIDTH_COUNT; ++i) {
        for (double c = 0.02; c < 1.01; c += 0.196) {
            hdrp_v3 v = bt_direction(fmin(c, 1.0), 0.0);
            double sum = 0.0, above = 0.0;
            int count = bq_points(&rule, acos(fmin(c, 1.0)), 0.0, (double)widths[i], points);
            for (int k = 0; k < count; ++k) {
                hdrp_v3 h = hdrp_brdf_half_vector(bt_v3(points[k].l), v, n);
                sum += (double)hdrp_brdf_pdf_vndf(v, h, widths[i], widths[i]) * points[k].weight;
            }
            for (int k = 0; k < 20000; ++k) {
                hdrp_v2 u = hdrp_v2_make(bt_random_f(&seed), bt_random_f(&seed));
                hdrp_v3 h = hdrp_brdf_sample_vndf(v, widths[i], widths[i], u);
                above += 2.0f * hdrp_v3_dot(v, h) * h.z > v.z ? 1.0 / 20000.0 : 0.0;
            }
            assert_true(sum < 1.0 + 1e-3 && fabs(sum - above) < 0.02);
        }
    }
}

static void samples_follow_their_density(void** state)
{
    enum { ROWS = 24, COLUMNS = 24, BINS = ROWS * COLUMNS, SAMPLES = 200000, FINE = 12 };
    const double cosines[] = {1.0, 0.6, 0.1};
    const float pairs[][2] = {{0.3f, 0.3f}, {0.9f, 0.9f}, {0.7f, 0.15f}};
    (void)state;
    for (int test = 0; test < 9; ++test) {
        static double seen[BINS], expected[BINS];
        uint64_t seed = 10;
        float at = pairs[test / 3][0], ab = pairs[test / 3][1];
        hdrp_v3 v = bt_direction(cosines[test % 3], 0.7);
        for (int i = 0; i < BINS; ++i) {
            seen[i] = expected[i] = 0.0;
        }
        for (int i = 0; i < SAMPLES; ++i) {
            hdrp_v2 u = hdrp_v2_make(bt_random_f(&seed), bt_random_f(&seed));
            hdrp_v3 h = hdrp_brdf_sample_vndf(v, at, ab, u);
            double turn = atan2((double)h.y, (double)h.x) / (2.0 * BQ_PI) + 0.5;
            int row = (int)fmin((double)h.z * ROWS, ROWS - 1);
            seen[row * COLUMNS + (int)fmin(turn * COLUMNS, COLUMNS - 1)] += 1.0;
        }
        for (int i = 0; i < ROWS * FINE; ++i) {
            for (int j = 0; j < COLUMNS * FINE; ++j) {
                double phi = 2.0 * BQ_PI * ((j + 0.5) / (COLUMNS * FINE) - 0.5);
                hdrp_v3 h = bt_direction((i + 0.5) / (ROWS * FINE), phi);
                double c = fmax((double)hdrp_v3_dot(v, h), 0.0);
                /* Per solid angle of half vectors: the Jacobian of the reflection is 4 v.h. */
                expected[i / FINE * COLUMNS + j / FINE] +=
                    4.0 * c * (double)hdrp_brdf_pdf_vndf(v, h, at, ab) * 2.0 * BQ_PI * SAMPLES /
                    (BINS * FINE * FINE);
            }
        }
        double deviations = bt_chi_squared(seen, expected, BINS);
        if (!(deviations < 5.0)) {
            fail_msg("%.1f standard deviations, widths %.2f %.2f, n.v %.2f", deviations, (double)at,
                     (double)ab, cosines[test % 3]);
        }
    }
}

static void samples_stay_above_the_surface_at_the_ends(void** state)
{
    const float u[] = {0.0f, 1.0f, 0.5f}, z[] = {0.0f, 1e-20f, 1e-4f, 1.0f};
    (void)state;
    for (int i = 0; i < 36; ++i) {
        hdrp_v3 v = bt_direction((double)z[i % 4], 1.0);
        hdrp_v3 h = hdrp_brdf_sample_vndf(v, 0.0f, 2.0f, hdrp_v2_make(u[i / 4 % 3], u[i / 12]));
        assert_true(h.z >= 0.0f && fabsf(hdrp_v3_length(h) - 1.0f) < 1e-6f);
    }
}

/* The slopes of a GGX surface seen head on are those of all its normals: the share of them below a
 * slope s is s^2 / (s^2 + alpha^2). */
static void a_view_along_the_normal_draws_slopes_of_a_known_share(void** state)
{
    hdrp_v3 v = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    (void)state;
    for (float alpha = 0.1f; alpha < 1.0f; alpha += 0.2f) {
        for (float u = 0.1f; u < 1.0f; u += 0.1f) {
            hdrp_v3 h = hdrp_brdf_sample_vndf(v, alpha, alpha, hdrp_v2_make(0.125f, u));
            double slope = hypot((double)h.x, (double)h.y) / (double)h.z;
            double share = slope * slope / (slope * slope + (double)alpha * (double)alpha);
            assert_true(fabs(share - (double)u) < 2e-6);
            assert_true(fabsf(h.x - h.y) < 1e-6f);
        }
    }
}

/* A surface of width 1 is a hemisphere, which mirrors a view evenly into the cap of all heights from
 * 1 down to that of the mirrored view. */
static void a_hemisphere_mirrors_its_view_evenly(void** state)
{
    (void)state;
    for (double c = 0.1; c < 1.0; c += 0.2) {
        hdrp_v3 v = bt_direction(c, 1.0);
        for (float u = 0.1f; u < 1.0f; u += 0.1f) {
            hdrp_v3 h = hdrp_brdf_sample_vndf(v, 1.0f, 1.0f, hdrp_v2_make(0.3f, u));
            double height = 2.0 * (double)hdrp_v3_dot(v, h) * (double)h.z - c;
            assert_true(fabs((1.0 - height) / (1.0 + c) - (double)u) < 2e-6);
        }
    }
}

static void kulla_widths_have_the_mean_of_the_roughness(void** state)
{
    (void)state;
    for (float k = -1.0f; k <= 1.0f; k += 0.125f) {
        hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(0.5f, k);
        assert_true(fabsf(0.5f * (a.t + a.b) - 0.25f) < 6e-5f);
        assert_true(k <= 0.0f || a.t > a.b);
        a = hdrp_brdf_alphas_disney(0.5f, k);
        assert_true(fabsf(sqrtf(a.t * a.b) - 0.25f) < 1e-6f);
        assert_true(a.t <= 10.01f * a.b && a.b <= 10.01f * a.t);
    }
}

/* KHR_materials_anisotropy: widths lerp(alpha, 1, strength^2) and alpha. */
static void gltf_anisotropy_converts(void** state)
{
    hdrp_brdf_alphas w;
    (void)state;
    for (float s = 0.0f; s <= 1.0f; s += 0.125f) {
        w.b = 0.2f;
        w.t = hdrp_lerp(0.2f, 1.0f, s * s);
        hdrp_brdf_kulla k = hdrp_brdf_kulla_from_alphas(w);
        hdrp_brdf_alphas back = hdrp_brdf_alphas_kulla(k.perceptual_roughness, k.anisotropy);
        assert_true(fabsf(back.t - w.t) < 1e-6f && fabsf(back.b - w.b) < 1e-6f);
    }
}

static void the_environment_lobe_bends_towards_the_view(void** state)
{
    hdrp_v3 t = hdrp_v3_make(1.0f, 0.0f, 0.0f), b = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f), v = hdrp_v3_make(0.6f, 0.0f, 0.8f);
    (void)state;
    hdrp_brdf_env_lobe e = hdrp_brdf_env_lobe_aniso(t, b, n, v, 0.0f, 0.5f);
    assert_true(e.normal.x == 0.0f && e.normal.z == 1.0f && e.perceptual_roughness == 0.5f);
    /* Stretched along x, seen from x: in the plane of the view all normals on the way count. */
    e = hdrp_brdf_env_lobe_aniso(t, b, n, v, 0.8f, 0.5f);
    assert_true(e.normal.x > 0.4f && e.normal.y == 0.0f);
    assert_true(e.perceptual_roughness < 0.5f);
    /* Stretched across it: only the normal itself does. */
    e = hdrp_brdf_env_lobe_aniso(t, b, n, v, -0.8f, 0.5f);
    assert_true(fabsf(e.normal.x) < 1e-6f && e.normal.z == 1.0f);
    /* By hand: 0.5 * 1.5 sqrt(0.25) = 0.375 of the way to v, and 0.25 (1.2 - 0.5). */
    e = hdrp_brdf_env_lobe_aniso(t, b, n, v, 0.5f, 0.25f);
    assert_true(fabsf(e.normal.x - 0.236351f) < 2e-6f && fabsf(e.normal.z - 0.971667f) < 2e-6f);
    assert_true(fabsf(e.perceptual_roughness - 0.175f) < 1e-7f);
    e = hdrp_brdf_env_lobe_aniso(t, b, n, b, 1.0f, 1.0f);
    assert_true(e.normal.z == 1.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_isotropic_distribution_integrates_to_one),
        cmocka_unit_test(the_anisotropic_distribution_integrates_to_one),
        cmocka_unit_test(equal_widths_are_isotropic),
        cmocka_unit_test(visibility_is_the_masking_of_both_directions),
        cmocka_unit_test(visibility_does_not_tell_the_light_from_the_view),
        cmocka_unit_test(a_width_below_the_minimum_acts_as_the_minimum),
        cmocka_unit_test(the_peak_is_one_over_pi_alpha_squared),
        cmocka_unit_test(the_lobe_stays_finite_at_grazing),
        cmocka_unit_test(opposite_directions_have_a_half_vector),
        cmocka_unit_test(the_sampled_density_integrates_to_what_stays_above),
        cmocka_unit_test(samples_follow_their_density),
        cmocka_unit_test(samples_stay_above_the_surface_at_the_ends),
        cmocka_unit_test(a_view_along_the_normal_draws_slopes_of_a_known_share),
        cmocka_unit_test(a_hemisphere_mirrors_its_view_evenly),
        cmocka_unit_test(kulla_widths_have_the_mean_of_the_roughness),
        cmocka_unit_test(gltf_anisotropy_converts),
        cmocka_unit_test(the_environment_lobe_bends_towards_the_view),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
