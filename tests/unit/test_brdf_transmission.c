/* test_brdf_transmission.c - refraction keeps its energy, and ends where it has to.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#include "brdf_test.h"

static bq_point points[BQ_MAX_POINTS];

static void smooth_refraction_follows_snell(void** state)
{
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f), v = hdrp_v3_make(0.6f, 0.0f, 0.8f);
    (void)state;
    hdrp_brdf_refraction r = hdrp_brdf_refract(v, n, 1.0f / 1.5f);
    assert_true(r.transmits == 1.0f && fabsf(r.direction.x + 0.4f) < 1e-6f);
    assert_true(r.direction.z < 0.0f && fabsf(hdrp_v3_length(r.direction) - 1.0f) < 1e-6f);
    r = hdrp_brdf_refract(v, n, 1.0f);
    assert_true(fabsf(r.direction.x + 0.6f) < 1e-6f && fabsf(r.direction.z + 0.8f) < 1e-6f);
    /* From the inside at 53 degrees: totally reflected. */
    r = hdrp_brdf_refract(hdrp_v3_make(0.8f, 0.0f, 0.6f), n, 1.5f);
    assert_true(r.transmits == 0.0f && fabsf(r.direction.x + 0.8f) < 1e-6f &&
                fabsf(r.direction.z - 0.6f) < 1e-6f);
    r = hdrp_brdf_refract(n, n, 1.5f);
    assert_true(r.direction.z == -1.0f);
}

static void a_volume_absorbs_by_distance(void** state)
{
    hdrp_v3 c = hdrp_v3_make(0.25f, 1.0f, 0.0f);
    (void)state;
    hdrp_v3 t = hdrp_brdf_volume_transmittance(c, 2.0f, 2.0f);
    assert_true(fabsf(t.x - 0.25f) < 1e-6f && t.y == 1.0f && t.z < 1e-30f);
    t = hdrp_brdf_volume_transmittance(c, 2.0f, 1.0f);
    assert_true(fabsf(t.x - 0.5f) < 1e-6f);
    t = hdrp_brdf_volume_transmittance(c, 2.0f, 0.0f);
    assert_true(t.x == 1.0f && t.z == 1.0f);
    t = hdrp_brdf_volume_transmittance(c, 0.0f, 1e-30f);
    assert_true(t.x < 1e-6f && t.y == 1.0f && t.z == 0.0f);
    t = hdrp_brdf_volume_transmittance(c, HUGE_VALF, 1e30f);
    assert_true(t.x == 1.0f && t.z == 1.0f);
    t = hdrp_brdf_volume_transmittance(c, 1e-30f, HDRP_FLT_MAX);
    assert_true(t.x == 0.0f && t.y == 1.0f && t.z == 0.0f);
}

static void a_volume_without_bending_does_not_blur(void** state)
{
    (void)state;
    assert_true(hdrp_brdf_refraction_perceptual_roughness(0.7f, 1.0f) == 0.0f);
    assert_true(hdrp_brdf_refraction_perceptual_roughness(0.7f, 1.5f) == 0.7f);
    /* In proportion to how far the IOR is on its way from 1 to 1.5. */
    assert_true(hdrp_brdf_refraction_perceptual_roughness(0.5f, 1.25f) == 0.25f);
    assert_true(hdrp_brdf_refraction_perceptual_roughness(0.5f, 1.4375f) == 0.4375f);
    assert_true(hdrp_brdf_refraction_perceptual_roughness(0.7f, 2.5f) == 0.7f);
}

/* Refracted light of all directions, by way of the visible normals of v: f cos / pdf, where the
 * density per l is that of the half vector times (eta^2 l.h) / (v.h - eta l.h)^2. */
static double transmitted(double n_dot_v, float alpha, float eta)
{
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f), v = bt_direction(n_dot_v, 0.0);
    const int side = 64;
    double sum = 0.0;
    for (int k = 0; k < side * side; ++k) {
        hdrp_v2 u = hdrp_v2_make(((float)(k % side) + 0.5f) / (float)side,
                                 ((float)(k / side) + 0.5f) / (float)side);
        hdrp_v3 h = hdrp_brdf_sample_vndf(v, alpha, alpha, u);
        hdrp_brdf_refraction r = hdrp_brdf_refract(v, h, 1.0f / eta);
        double vh = (double)hdrp_v3_dot(v, h), lh = -(double)hdrp_v3_dot(r.direction, h);
        if (r.transmits > 0.0f && vh > 0.0) {
            double e = (double)eta, w = vh - e * lh;
            double jacobian = e * e * lh / (w * w) * 4.0 * vh;
            double pdf = (double)hdrp_brdf_pdf_vndf(v, h, alpha, alpha) * jacobian;
            sum += (double)hdrp_brdf_btdf_ggx(n, v, r.direction, alpha, eta) / pdf;
        }
    }
    return sum / (side * side);
}

/* The same for reflection with the exact Fresnel term. */
static double reflected(double n_dot_v, float alpha, float eta)
{
    bq_rule rule = bq_make(16, 12);
    double v[3] = {sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v}, c, sum = 0.0;
    int count = bq_points(&rule, acos(n_dot_v), 0.0, (double)alpha, points);
    for (int i = 0; i < count; ++i) {
        double f = bq_specular(v, points[i].l, (double)alpha, (double)alpha, &c);
        sum += points[i].weight * f * (double)hdrp_brdf_f_dielectric_exact((float)c, eta);
    }
    return sum;
}

static void rough_glass_transmits_what_it_does_not_reflect(void** state)
{
    const float alphas[] = {0.01f, 0.1f, 0.36f, 0.81f}, etas[] = {1.5f, 1.0f / 1.5f, 1.1f, 2.4f};
    (void)state;
    for (int i = 0; i < 16; ++i) {
        for (double c = 0.1; c <= 1.0; c += 0.15) {
            float alpha = alphas[i / 4], eta = etas[i % 4];
            double t = transmitted(c, alpha, eta), r = reflected(c, alpha, eta);
            if (!(t + r < 1.003)) {
                fail_msg("%.4f + %.4f, alpha %.3f, eta %.3f, n.v %.2f", r, t, (double)alpha,
                         (double)eta, c);
            }
            /* A smooth surface loses nothing; a rough one what bounces between its facets. */
            assert_true(i / 4 != 0 || t + r > 0.99);
        }
    }
}

static void refraction_ends_at_the_critical_angle_and_the_wrong_sides(void** state)
{
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f), v = bt_direction(0.5, 0.0);
    hdrp_v3 below = hdrp_v3_neg(v);
    (void)state;
    assert_true(hdrp_brdf_btdf_ggx(n, v, v, 0.5f, 1.5f) == 0.0f);
    assert_true(hdrp_brdf_btdf_ggx(n, below, below, 0.5f, 1.5f) == 0.0f);
    assert_true(hdrp_brdf_btdf_ggx(n, v, below, 0.5f, 1.5f) > 0.0f);
    /* Straight through, no interface to speak of: finite. */
    float t = hdrp_brdf_btdf_ggx(n, v, below, 0.0f, 1.0f);
    assert_true(t > 0.0f && t <= HDRP_FLT_MAX);
    /* Indices that differ by less than a thousandth count as if by that. */
    float nearest = hdrp_brdf_btdf_ggx(n, v, below, 0.5f, 1.001f);
    assert_true(fabsf(hdrp_brdf_btdf_ggx(n, v, below, 0.5f, 1.0f) / nearest - 1.0f) < 1e-2f);
    assert_true(fabsf(hdrp_brdf_btdf_ggx(n, v, below, 0.5f, 1.0005f) / nearest - 1.0f) < 1e-2f);
}

static void the_btdf_is_reciprocal(void** state)
{
    uint64_t seed = 1;
    (void)state;
    for (int i = 0; i < 5000; ++i) {
        hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f), m = hdrp_v3_make(0.0f, 0.0f, -1.0f);
        double cv = 0.05 + 0.95 * bt_random(&seed), cl = 0.05 + 0.95 * bt_random(&seed);
        hdrp_v3 v = bt_direction(cv, 0.0), l = bt_direction(-cl, 6.2832 * bt_random(&seed));
        float alpha = 0.1f + 0.9f * bt_random_f(&seed), eta = 1.1f + bt_random_f(&seed);
        /* What flows both ways is radiance over the squared index, per solid angle times it. */
        double a = (double)hdrp_brdf_btdf_ggx(n, v, l, alpha, eta) / cl;
        double b = (double)hdrp_brdf_btdf_ggx(m, l, v, alpha, 1.0f / eta) / cv;
        b *= (double)eta * (double)eta;
        assert_true(fabs(a - b) <= 2e-4 * (fabs(a) + fabs(b)) + 1e-5);
    }
}

static void a_clear_thin_wall_lets_through_what_it_does_not_reflect(void** state)
{
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f), f0 = hdrp_v3_make(0.04f, 0.5f, 1.0f);
    bq_rule rule = bq_make(16, 12);
    (void)state;
    for (float alpha = 0.01f; alpha < 1.0f; alpha += 0.19f) {
        for (double c = 0.1; c <= 1.0; c += 0.18) {
            double v[3] = {sqrt(1.0 - c * c), 0.0, c}, through[3] = {0.0, 0.0, 0.0}, unused;
            double single = 0.0, mirrored[3] = {0.0, 0.0, 0.0};
            int count = bq_points(&rule, acos(c), 0.0, (double)alpha, points);
            for (int i = 0; i < count; ++i) {
                hdrp_v3 l = bt_v3(points[i].l), below = hdrp_v3_make(l.x, l.y, -l.z);
                double dv = bq_specular(v, points[i].l, (double)alpha, (double)alpha, &unused);
                hdrp_v3 t = hdrp_brdf_btdf_thin_ggx(n, bt_v3(v), below, alpha, f0, 1.0f);
                hdrp_v3 f = hdrp_brdf_f_schlick_rgb(f0, 1.0f, (float)unused);
                single += points[i].weight * dv;
                for (int k = 0; k < 3; ++k) {
                    through[k] += points[i].weight * bt_component(t, k);
                    mirrored[k] += points[i].weight * dv * bt_component(f, k);
                }
            }
            for (int k = 0; k < 3; ++k) {
                assert_true(fabs(through[k] + mirrored[k] - single) < 1e-3);
            }
            assert_true(through[2] < 1e-6);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_refraction_follows_snell),
        cmocka_unit_test(a_volume_absorbs_by_distance),
        cmocka_unit_test(a_volume_without_bending_does_not_blur),
        cmocka_unit_test(rough_glass_transmits_what_it_does_not_reflect),
        cmocka_unit_test(refraction_ends_at_the_critical_angle_and_the_wrong_sides),
        cmocka_unit_test(the_btdf_is_reciprocal),
        cmocka_unit_test(a_clear_thin_wall_lets_through_what_it_does_not_reflect),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
