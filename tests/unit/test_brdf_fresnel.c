/* test_brdf_fresnel.c - Fresnel terms at the ends of their ranges, and the conversions around F0.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "brdf_test.h"

static void schlick_meets_both_reflectances(void** state)
{
    hdrp_v3 f0 = hdrp_v3_make(0.02f, 0.5f, 1.0f);
    (void)state;
    for (float f = 0.0f; f <= 1.0f; f += 0.125f) {
        assert_true(hdrp_brdf_f_schlick(f, 1.0f, 1.0f) == f);
        assert_true(hdrp_brdf_f_schlick(f, 0.75f, 0.0f) == 0.75f);
        assert_true(hdrp_brdf_f_schlick(f, 1.0f, 1.0000005f) == f);
        assert_true(hdrp_brdf_f_schlick(f, 1.0f, -0.1f) == 1.0f);
    }
    hdrp_v3 f = hdrp_brdf_f_schlick_rgb(f0, 1.0f, 0.3f);
    assert_true(f.x == hdrp_brdf_f_schlick(0.02f, 1.0f, 0.3f) && f.z == 1.0f);
}

static void a_surface_without_f0_does_not_reflect_at_grazing(void** state)
{
    (void)state;
    assert_true(hdrp_brdf_fresnel90(hdrp_v3_splat(0.0f)) == 0.0f);
    assert_true(hdrp_brdf_fresnel90(hdrp_v3_make(0.0f, 0.01f, 0.0f)) == 0.5f);
    assert_true(hdrp_brdf_fresnel90(hdrp_v3_splat(0.02f)) == 1.0f);
    assert_true(hdrp_brdf_fresnel90(hdrp_v3_make(0.0f, 0.0f, 1.0f)) == 1.0f);
}

static void a_dielectric_reflects_totally_beyond_the_critical_angle(void** state)
{
    (void)state;
    /* From glass to air, at 41.8 degrees: a cosine of 0.745. */
    assert_true(hdrp_brdf_f_dielectric_exact(0.74f, 1.0f / 1.5f) == 1.0f);
    assert_true(hdrp_brdf_f_dielectric_exact(0.75f, 1.0f / 1.5f) < 0.8f);
    for (float c = 0.0f; c <= 1.0f; c += 0.0625f) {
        assert_true(hdrp_brdf_f_dielectric_exact(c, 1.0f) == 0.0f);
    }
    assert_true(hdrp_brdf_f_dielectric_exact(0.0f, 1.5f) == 1.0f);
    assert_true(fabsf(hdrp_brdf_f_dielectric_exact(1.0f, 1.5f) - 0.04f) < 1e-7f);
    assert_true(fabsf(hdrp_brdf_f_dielectric_exact(1.0f, 1.0f / 1.5f) - 0.04f) < 1e-7f);
}

/* tan(angle) = eta: no light of the polarisation in the plane of incidence is reflected. */
static void brewsters_angle_leaves_one_polarisation(void** state)
{
    (void)state;
    for (double eta = 1.1; eta < 3.0; eta += 0.3) {
        double c = cos(atan(eta)), rs = (1.0 - eta * eta) / (1.0 + eta * eta);
        assert_true(fabs((double)hdrp_brdf_f_dielectric_exact((float)c, (float)eta) -
                         0.5 * rs * rs) < 1e-6);
    }
}

static void a_conductor_without_extinction_is_a_dielectric(void** state)
{
    (void)state;
    for (float c = 0.0625f; c <= 1.0f; c += 0.0625f) {
        assert_true(fabsf(hdrp_brdf_f_conductor_exact(c, 1.5f, 0.0f) -
                          hdrp_brdf_f_dielectric_exact(c, 1.5f)) < 1e-6f);
    }
    assert_true(hdrp_brdf_f_conductor_exact(0.0f, 1.0f, 0.0f) == 0.0f);
    assert_true(hdrp_brdf_f_conductor_exact(0.0f, 0.2f, 3.0f) == 1.0f);
    /* Gold at 650 nm: 0.16 + 3.8 i (Johnson and Christy 1972) gives 0.96. */
    assert_true(fabsf(hdrp_brdf_f_conductor_exact(1.0f, 0.16f, 3.8f) - 0.96f) < 0.01f);
}

static void indices_and_f0_convert_both_ways(void** state)
{
    (void)state;
    assert_true(fabsf(hdrp_brdf_fresnel0_from_ior(1.5f, 1.0f) - 0.04f) < 1e-8f);
    assert_true(hdrp_brdf_fresnel0_from_ior(1.5f, 1.5f) == 0.0f);
    assert_true(fabsf(hdrp_brdf_ior_from_fresnel0(0.04f) - 1.5f) < 2e-7f);
    assert_true(hdrp_brdf_ior_from_fresnel0(0.0f) == 1.0f);
    /* The pole: finite, and 1 again on the way back. */
    float ior = hdrp_brdf_ior_from_fresnel0(1.0f);
    assert_true(ior < 1e8f && hdrp_brdf_fresnel0_from_ior(ior, 1.0f) > 0.9999998f);
    assert_true(hdrp_brdf_ior_from_fresnel0(NAN) == 1.0f);
    /* Against water the ratio of IORs is what comes back. */
    for (float outer = 1.0f; outer < 1.6f; outer += 0.33f) {
        float f0 = hdrp_brdf_fresnel0_from_ior(2.4f, outer);
        assert_true(fabsf(hdrp_brdf_ior_from_fresnel0(f0) * outer - 2.4f) < 2e-6f);
    }
}

static void a_coat_is_exact_where_it_matters(void** state)
{
    hdrp_v3 f = hdrp_brdf_fresnel0_under_coat(hdrp_v3_make(0.04f, 1.0f, 0.0f));
    (void)state;
    assert_true(f.x < 1e-14f);
    assert_true(f.y == 1.0f);
    assert_true(fabsf(f.z - 0.04f) < 1e-8f); /* air below the coat reflects as the coat in air */
    assert_true(hdrp_brdf_fresnel0_at_interface(0.3f, 1.0f) > 0.2999999f);
    assert_true(hdrp_brdf_fresnel0_at_interface(0.3f, 1.0f) < 0.3000001f);
    /* Copper of the talk's table, by its own closed formula. */
    f = hdrp_brdf_fresnel0_under_coat(hdrp_v3_make(0.955008f, 0.637427f, 0.538163f));
    assert_true(fabsf(f.x - 0.933273f) < 2e-6f && fabsf(f.y - 0.507081f) < 2e-6f &&
                fabsf(f.z - 0.391058f) < 2e-6f);
}

static void the_fast_coat_is_the_cubic_of_the_talk(void** state)
{
    (void)state;
    assert_true(hdrp_brdf_fresnel0_under_coat_fast(0.05f) == 0.0f);
    assert_true(fabsf(hdrp_brdf_fresnel0_under_coat_fast(1.0f) - 0.9963f) < 1e-4f);
}

static void a_refracted_angle_ends_at_the_horizon(void** state)
{
    (void)state;
    assert_true(hdrp_brdf_refracted_cosine(1.0f, 1.5f) == 1.0f);
    assert_true(fabsf(hdrp_brdf_refracted_cosine(0.0f, 1.5f) - sqrtf(5.0f) / 3.0f) < 1e-6f);
    assert_true(hdrp_brdf_refracted_cosine(0.5f, 0.5f) == 0.0f);
}

static void colours_convert_to_base_and_metallic(void** state)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    hdrp_v3 black = hdrp_v3_splat(0.0f), gold = hdrp_v3_make(1.0f, 0.77f, 0.34f);
    (void)state;
    hdrp_brdf_data d = hdrp_brdf_data_from_diffuse_specular(s, black, gold);
    assert_true(d.metallic == 1.0f && d.base_color.x == 1.0f && d.base_color.y == 0.77f &&
                d.base_color.z == 0.34f);
    d = hdrp_brdf_data_from_diffuse_specular(s, gold, hdrp_v3_splat(0.04f));
    assert_true(d.metallic < 1e-6f && fabsf(d.base_color.y - 0.77f) < 1e-6f);
    /* The colours of a half metal give it back. */
    hdrp_v3 base = hdrp_v3_make(0.9f, 0.6f, 0.3f);
    d = hdrp_brdf_data_from_diffuse_specular(
        s, hdrp_brdf_diffuse_color(base, 0.5f),
        hdrp_brdf_fresnel0(base, 0.5f, hdrp_v3_splat(HDRP_BRDF_COAT_FRESNEL0)));
    assert_true(fabsf(d.metallic - 0.5f) < 1e-6f && fabsf(d.base_color.x - 0.9f) < 1e-6f);
    assert_true(fabsf(d.base_color.z - 0.3f) < 1e-6f && d.diffuse_color.x == 0.45f);
}

/* The way of the light that a first bounce loses: it meets facets again and again, each time reflects
 * the mean Fresnel term, and escapes but for two thirds of the mean loss of a first bounce. */
static void bounces_are_a_sum_over_the_way_of_the_light(void** state)
{
    (void)state;
    for (int i = 0; i < 25; ++i) {
        float f0 = 0.25f * (float)(i % 5), roughness = 0.2f + 0.2f * (float)(i / 5);
        hdrp_brdf_fgd_fit fit = hdrp_brdf_fgd_fit_make(roughness);
        hdrp_brdf_bounces b = hdrp_brdf_bounces_make(fit, hdrp_v3_splat(f0), 1.0f);
        double mean = 0.0, left, escaped = 0.0;
        for (int k = 0; k < 1000; ++k) {
            double c = (k + 0.5) / 1000.0;
            mean += 2e-3 * c * ((double)f0 + (1.0 - (double)f0) * pow(1.0 - c, 5.0));
        }
        left = mean; /* it is lost after its first reflection, and reflected once more */
        for (int k = 0; k < 400; ++k) {
            double again = left * mean;
            escaped += again * (1.0 - (double)fit.mean_loss * 2.0 / 3.0);
            left = again * (double)fit.mean_loss * 2.0 / 3.0;
        }
        assert_true(fabs((double)b.reflected.y - escaped) < 2e-6);
        assert_true(fabsf(b.reflected.y + (1.0f - f0) * b.passed.y - 1.0f) < 1e-6f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(schlick_meets_both_reflectances),
        cmocka_unit_test(a_surface_without_f0_does_not_reflect_at_grazing),
        cmocka_unit_test(a_dielectric_reflects_totally_beyond_the_critical_angle),
        cmocka_unit_test(brewsters_angle_leaves_one_polarisation),
        cmocka_unit_test(a_conductor_without_extinction_is_a_dielectric),
        cmocka_unit_test(indices_and_f0_convert_both_ways),
        cmocka_unit_test(a_coat_is_exact_where_it_matters),
        cmocka_unit_test(the_fast_coat_is_the_cubic_of_the_talk),
        cmocka_unit_test(a_refracted_angle_ends_at_the_horizon),
        cmocka_unit_test(colours_convert_to_base_and_metallic),
        cmocka_unit_test(bounces_are_a_sum_over_the_way_of_the_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
