/* test_brdf_film.c - a thin film fades in from nothing, and is never negative, above 1 or undefined.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../accuracy/cie_observers.h"
#include "brdf_test.h"

typedef hdrp_v3 film_function(float, float, float, float, hdrp_v3);

static int in_gamut(hdrp_v3 c)
{
    return c.x >= 0.0f && c.x <= 1.0f && c.y >= 0.0f && c.y <= 1.0f && c.z >= 0.0f && c.z <= 1.0f;
}

static void a_film_of_no_thickness_is_the_bare_base(void** state)
{
    film_function* films[] = {hdrp_brdf_film, hdrp_brdf_film_exact, hdrp_brdf_film_fast};
    const float f0s[] = {0.0f, 0.02f, 0.04f, 0.2f, 0.6f, 0.9f, 0.999f};
    (void)state;
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 7; ++i) {
            for (float c = 0.02f; c <= 1.0f; c += 0.07f) {
                for (float ior = 1.0f; ior <= 3.0f; ior += 0.4f) {
                    float base = hdrp_brdf_ior_from_fresnel0(f0s[i]);
                    double bare =
                        base > 4.0f
                            ? (double)hdrp_brdf_f_conductor_exact(c, fminf(base, 20.0f), 0.0f)
                            : (double)hdrp_brdf_f_dielectric_exact(c, base);
                    hdrp_v3 m = films[k](c, 1.0f, ior, 0.0f, hdrp_v3_splat(f0s[i]));
                    if (base <= 20.0f && fabs((double)m.x - bare) > 1e-5) {
                        fail_msg("%.7g for %.7g, F0 %.3g, cosine %.3g, IOR %.3g", (double)m.x, bare,
                                 (double)f0s[i], (double)c, (double)ior);
                    }
                    assert_true(fabsf(m.x - m.y) < 2e-6f && fabsf(m.y - m.z) < 2e-6f);
                }
            }
        }
    }
}

/* Light inside a coat that is steeper than its film's critical angle does not reach the base. */
static void a_film_thinner_than_the_coat_reflects_totally(void** state)
{
    const float critical = 0.4988877f; /* sqrt(1 - (1.3 / 1.5)^2) */
    film_function* films[] = {hdrp_brdf_film, hdrp_brdf_film_exact, hdrp_brdf_film_fast};
    (void)state;
    for (int k = 0; k < 3; ++k) {
        for (float nm = 0.0f; nm <= 500.0f; nm += 250.0f) {
            hdrp_v3 beyond = films[k](0.3f, 1.5f, 1.3f, nm, hdrp_v3_splat(0.04f));
            hdrp_v3 before = films[k](critical + 0.02f, 1.5f, 1.3f, nm, hdrp_v3_splat(0.04f));
            assert_true(beyond.x == 1.0f && beyond.y == 1.0f && beyond.z == 1.0f);
            assert_true(before.x < 0.8f && before.z < 0.8f);
        }
    }
}

static void a_film_grows_continuously(void** state)
{
    (void)state;
    for (float nm = 0.0f; nm < 400.0f; nm += 1.0f) {
        hdrp_v3 a = hdrp_brdf_film(0.8f, 1.0f, 1.4f, nm, hdrp_v3_splat(0.1f));
        hdrp_v3 b = hdrp_brdf_film(0.8f, 1.0f, 1.4f, nm + 1.0f, hdrp_v3_splat(0.1f));
        assert_true(fabsf(a.x - b.x) < 0.005f && fabsf(a.z - b.z) < 0.005f);
    }
}

/* A quarter of 550 nm in a film whose index is the root of the base's: the green is cancelled. */
static void a_quarter_wave_film_is_an_antireflective_coating(void** state)
{
    float ior = 1.22474487f, nm = 550.0f / (4.0f * ior);
    (void)state;
    hdrp_v3 c = hdrp_brdf_film_exact(1.0f, 1.0f, ior, nm, hdrp_v3_splat(0.04f));
    assert_true(c.y < 0.002f && c.y < c.x && c.y < c.z);
    assert_true(hdrp_brdf_film_airy(1.0f, 1.0f, ior, 1.5f, nm, 550.0f) < 1e-6f);
    /* Twice that and the film is absent. */
    assert_true(fabsf(hdrp_brdf_film_airy(1.0f, 1.0f, ior, 1.5f, 2.0f * nm, 550.0f) - 0.04f) <
                1e-6f);
}

static void a_mirror_and_a_grazing_view_reflect_all(void** state)
{
    film_function* films[] = {hdrp_brdf_film, hdrp_brdf_film_exact, hdrp_brdf_film_fast};
    (void)state;
    for (int k = 0; k < 3; ++k) {
        for (float nm = 0.0f; nm <= 3000.0f; nm += 150.0f) {
            hdrp_v3 grazing = films[k](0.0f, 1.0f, 1.5f, nm, hdrp_v3_splat(0.04f));
            assert_true(grazing.x > 0.9999f && grazing.z > 0.9999f);
            hdrp_v3 mirror = films[k](0.5f, 1.0f, 1.5f, nm, hdrp_v3_splat(1.0f));
            assert_true(mirror.x > 0.999f && mirror.y > 0.999f && mirror.z > 0.999f);
        }
    }
}

/* Corners that made the published form NaN: grazing with F0 = 1, and a coat as dense as the film. */
static void no_corner_leaves_the_gamut(void** state)
{
    const float cosines[] = {0.0f, 1e-30f, 1e-7f, 0.01f, 0.7453559f, 0.99999994f, 1.0f};
    const float iors[] = {1.0f, 1.0000001f, 1.4999999f, 1.5f, 1.5000001f, 3.0f};
    const float f0s[] = {0.0f, 1e-30f, 0.04f, 0.9999f, 0.99999994f, 1.0f};
    film_function* films[] = {hdrp_brdf_film, hdrp_brdf_film_exact, hdrp_brdf_film_fast};
    (void)state;
    for (int i = 0; i < 7 * 6 * 6 * 6; ++i) {
        float outer = i % 2 ? 1.5f : 1.0f, nm = i % 4 < 2 ? 0.0f : 777.0f;
        hdrp_v3 f0 = hdrp_v3_make(f0s[i % 6], f0s[i / 6 % 6], 0.5f);
        for (int k = 0; k < 3; ++k) {
            assert_true(in_gamut(films[k](cosines[i % 7], outer, iors[i / 36 % 6], nm, f0)));
        }
    }
}

/* Two nearly perfect mirrors: an order that is closed with too much or too little decay, or with the
 * wrong sign, shows as an error near 1. */
static void a_film_between_mirrors_agrees_with_its_wavelengths(void** state)
{
    (void)state;
    for (float nm = 20.0f; nm < 200.0f; nm += 3.0f) {
        double sum[3] = {0.0, 0.0, 0.0}, weight[3] = {0.0, 0.0, 0.0};
        float base = hdrp_brdf_ior_from_fresnel0(0.98f);
        hdrp_v3 m = hdrp_brdf_film(0.03f, 1.0f, 1.8f, nm, hdrp_v3_splat(0.98f));
        for (int k = 0; k < CIE_COUNT; ++k) {
            const double* xyz = cie_1931_2_degree[k];
            double r =
                (double)hdrp_brdf_film_airy(0.03f, 1.0f, 1.8f, base, nm, 360.0f + 5.0f * (float)k);
            double w[3] = {3.2404542 * xyz[0] - 1.5371385 * xyz[1] - 0.4985314 * xyz[2],
                           -0.969266 * xyz[0] + 1.8760108 * xyz[1] + 0.041556 * xyz[2],
                           0.0556434 * xyz[0] - 0.2040259 * xyz[1] + 1.0572252 * xyz[2]};
            for (int i = 0; i < 3; ++i) {
                sum[i] += w[i] * r;
                weight[i] += w[i];
            }
        }
        assert_true(fabs((double)m.x - fmin(sum[0] / weight[0], 1.0)) < 0.15);
        assert_true(fabs((double)m.y - fmin(sum[1] / weight[1], 1.0)) < 0.15);
        assert_true(fabs((double)m.z - fmin(sum[2] / weight[2], 1.0)) < 0.15);
    }
}

static void the_thickness_of_the_talk_translates(void** state)
{
    (void)state;
    /* t = 0.3: film IOR 1.7, optical path 0.9 um at normal incidence, 2 n d. */
    float t = 0.3f, ior = 2.0f - t, nm = 1500.0f * t / ior;
    assert_true(fabsf(2.0f * ior * nm - 3000.0f * t) < 1e-3f);
    hdrp_v3 c = hdrp_brdf_film(1.0f, 1.0f, ior, nm, hdrp_v3_splat(0.5f));
    assert_true(in_gamut(c) && fabsf(c.x - c.z) > 0.05f);
}

static void a_film_inside_a_coat_sees_light_from_air(void** state)
{
    hdrp_brdf_surface s = bt_surface(0.5f, 0.0f, 0.04f, 0.3f);
    (void)state;
    s.features = HDRP_BRDF_FEATURE_CLEAR_COAT | HDRP_BRDF_FEATURE_IRIDESCENCE;
    s.coat_mask = s.film_mask = 1.0f;
    s.film_ior = 1.5f; /* the coat's own: only the base is left to reflect */
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    for (double c = 0.3; c <= 1.0; c += 0.1) {
        hdrp_brdf_lit_view w = bt_view(d, bt_direction(c, 0.0), s.features);
        /* Base and coat are both of IOR 1.5 too. */
        assert_true(hdrp_v3_max_component(w.fresnel0) < 1e-5f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_film_of_no_thickness_is_the_bare_base),
        cmocka_unit_test(a_film_thinner_than_the_coat_reflects_totally),
        cmocka_unit_test(a_film_grows_continuously),
        cmocka_unit_test(a_quarter_wave_film_is_an_antireflective_coating),
        cmocka_unit_test(a_mirror_and_a_grazing_view_reflect_all),
        cmocka_unit_test(no_corner_leaves_the_gamut),
        cmocka_unit_test(a_film_between_mirrors_agrees_with_its_wavelengths),
        cmocka_unit_test(the_thickness_of_the_talk_translates),
        cmocka_unit_test(a_film_inside_a_coat_sees_light_from_air),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
