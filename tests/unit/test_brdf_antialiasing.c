/* test_brdf_antialiasing.c - a filtered lobe is about the average of the lobes it stands for.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#include "brdf_test.h"

/* Density of GGX slopes at distance r. */
static double slopes(double r, double alpha)
{
    double s = 1.0 + r * r / (alpha * alpha);
    return 1.0 / (BQ_PI * alpha * alpha * s * s);
}

/* The same, averaged over normals whose slopes are Gaussian with deviation sigma on each axis: what
 * a pixel sees of a rippled surface. */
static double averaged_slopes(double r, double alpha, double sigma)
{
    enum { RADII = 160, ANGLES = 64 };
    double sum = 0.0;
    for (int i = 0; i < RADII; ++i) {
        double q = 5.0 * sigma * (i + 0.5) / RADII;
        double weight = exp(-0.5 * q * q / (sigma * sigma)) / (2.0 * BQ_PI * sigma * sigma) * q *
                        (5.0 * sigma / RADII);
        for (int j = 0; j < ANGLES; ++j) {
            double phi = 2.0 * BQ_PI * (j + 0.5) / ANGLES;
            double distance2 = r * r + q * q - 2.0 * r * q * cos(phi);
            sum += weight * (2.0 * BQ_PI / ANGLES) * slopes(sqrt(fmax(distance2, 0.0)), alpha);
        }
    }
    return sum;
}

/* Energy that is in the wrong place, and the peak against the true one. */
static void a_filtered_lobe_is_close_to_the_average(void** state)
{
    const double alphas[] = {0.02, 0.05, 0.2}, sigmas[] = {0.02, 0.05, 0.1, 0.2};
    double worst = 0.0, low = 9.0, high = 0.0;
    (void)state;
    for (int k = 0; k < 12; ++k) {
        double alpha = alphas[k / 4], sigma = sigmas[k % 4], misplaced = 0.0, peak;
        float p = hdrp_brdf_perceptual_roughness_filtered((float)sqrt(alpha),
                                                          (float)(2.0 * sigma * sigma));
        double filtered = (double)p * (double)p;
        for (int i = 0; i < 60; ++i) {
            /* t = r / (r + filtered) is even on [0,1). */
            double t = (i + 0.5) / 60.0, r = filtered * t / (1.0 - t);
            double dr = filtered / ((1.0 - t) * (1.0 - t)) / 60.0;
            misplaced += 0.5 * fabs(averaged_slopes(r, alpha, sigma) - slopes(r, filtered)) * 2.0 *
                         BQ_PI * r * dr;
        }
        peak = slopes(0.0, filtered) / averaged_slopes(0.0, alpha, sigma);
        worst = fmax(worst, misplaced);
        low = fmin(low, peak);
        high = fmax(high, peak);
    }
    print_message("filtered lobes: %.1f %% of the energy misplaced at most, peaks %.2f to %.2f\n",
                  100.0 * worst, low, high);
    assert_true(worst < 0.25 && low > 0.6 && high < 1.4);
}

static void the_average_normal_tells_the_variance(void** state)
{
    (void)state;
    for (double sigma = 0.02; sigma < 0.21; sigma += 0.03) {
        double length = 0.0;
        for (int i = 0; i < 2000; ++i) {
            /* Gaussian slopes by their radius; the average points along the normal. */
            double r = 6.0 * sigma * (i + 0.5) / 2000.0;
            double weight =
                exp(-0.5 * r * r / (sigma * sigma)) * r / (sigma * sigma) * 6.0 * sigma / 2000.0;
            length += weight / sqrt(1.0 + r * r);
        }
        double variance = (double)hdrp_brdf_variance_from_average_normal((float)length);
        /* Toksvig takes the lobe for a Gaussian in angle: second order in the slope. */
        assert_true(fabs(variance / (2.0 * sigma * sigma) - 1.0) < 0.15);
    }
    assert_true(hdrp_brdf_variance_from_average_normal(1.0f) == 0.0f);
    /* By hand: slopes of variance 1/4, twice that in alpha^2. */
    assert_true(fabsf(hdrp_brdf_variance_from_average_normal(0.8f) - 0.5f) < 1e-6f);
    assert_true(hdrp_brdf_variance_from_average_normal(0.6f) == 1.0f);
    assert_true(hdrp_brdf_variance_from_average_normal(0.0f) == 1.0f);
}

/* A pixel filter of variance 0.25 over a normal that turns by g per pixel along x. */
static void derivatives_tell_the_variance_of_a_pixel(void** state)
{
    hdrp_v3 none = hdrp_v3_splat(0.0f);
    (void)state;
    for (float g = 0.05f; g < 0.5f; g += 0.1f) {
        float v =
            hdrp_brdf_variance_from_derivatives(hdrp_v3_make(g, 0.0f, 0.0f), none, 0.25f, 1.0f);
        assert_true(fabsf(v - 2.0f * 0.25f * g * g) < 1e-6f);
    }
    hdrp_v3 steep = hdrp_v3_make(3.0f, 0.0f, 0.0f), broken = hdrp_v3_make(NAN, 0.0f, 0.0f);
    assert_true(hdrp_brdf_variance_from_derivatives(steep, none, 0.25f, 0.18f) == 0.18f);
    assert_true(hdrp_brdf_variance_from_derivatives(broken, none, 0.25f, 0.18f) == 0.0f);
    assert_true(hdrp_brdf_variance_from_derivatives(none, broken, 0.25f, 0.18f) == 0.0f);
    /* Normals on both sides of a pixel can differ by 2, no more. */
    assert_true(hdrp_brdf_variance_from_derivatives(steep, none, 0.0625f, 1.0f) == 0.5f);
    hdrp_v3 huge = hdrp_v3_splat(HUGE_VALF);
    assert_true(hdrp_brdf_variance_from_derivatives(huge, huge, 0.25f, 0.18f) == 0.18f);
}

static void filtering_is_monotone_and_starts_from_nothing(void** state)
{
    (void)state;
    for (float p = 0.0f; p <= 1.0f; p += 0.0625f) {
        float before = hdrp_brdf_perceptual_roughness_filtered(p, 0.0f);
        assert_true(fabsf(before - p) <= 1e-7f);
        for (float v = 0.0078125f; v <= 1.0f; v += 0.0078125f) {
            float after = hdrp_brdf_perceptual_roughness_filtered(p, v);
            assert_true(after >= before && after <= 1.0f);
            before = after;
        }
    }
    /* Two filters in a row are one of the sum. */
    float twice = hdrp_brdf_perceptual_roughness_filtered(0.3f, 0.02f);
    twice = hdrp_brdf_perceptual_roughness_filtered(twice, 0.03f);
    assert_true(fabsf(twice - hdrp_brdf_perceptual_roughness_filtered(0.3f, 0.05f)) < 1e-6f);
    assert_true(hdrp_brdf_perceptual_roughness_filtered(0.5f, NAN) == 0.5f);
}

static void occlusion_leaves_open_surfaces_alone(void** state)
{
    (void)state;
    for (float c = 0.0f; c <= 1.0f; c += 0.125f) {
        for (float p = 0.0f; p <= 1.0f; p += 0.125f) {
            float before = 0.0f;
            assert_true(hdrp_brdf_specular_occlusion(1.0f, c, p) == 1.0f);
            assert_true(hdrp_brdf_specular_occlusion(0.0f, c, p) == 0.0f);
            for (float ao = 0.0f; ao <= 1.0f; ao += 0.03125f) {
                float s = hdrp_brdf_specular_occlusion(ao, c, p);
                assert_true(s >= before && s <= 1.0f);
                before = s;
            }
        }
    }
    /* A smooth surface seen head on reflects from above, where it is open. */
    assert_true(hdrp_brdf_specular_occlusion(0.5f, 1.0f, 0.0f) > 0.7f);
    /* By hand: alpha 1/16, so that the exponent is 2^-2, and (1/16 + 1/2)^(1/4) is sqrt(3) / 2. */
    assert_true(fabsf(hdrp_brdf_specular_occlusion(0.5f, 0.0625f, 0.25f) - 0.3660254f) < 1e-6f);
    /* At alpha 1/8 the exponent is 2^-3: 0.75^(1/8) - 1/2. */
    assert_true(fabsf(hdrp_brdf_specular_occlusion(0.5f, 0.25f, 0.35355339f) - 0.4646786f) < 2e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_filtered_lobe_is_close_to_the_average),
        cmocka_unit_test(the_average_normal_tells_the_variance),
        cmocka_unit_test(derivatives_tell_the_variance_of_a_pixel),
        cmocka_unit_test(filtering_is_monotone_and_starts_from_nothing),
        cmocka_unit_test(occlusion_leaves_open_surfaces_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
