/* test_brdf_furnace.c - in a white furnace no surface reflects more than it receives.
 * SPDX-License-Identifier: MIT
 *
 * "View side" sums the light that reaches one viewer from everywhere; "light side" sums what one
 * light sends everywhere. A reciprocal lobe has the same albedo on both. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#define HDRP_BRDF_IMPLEMENTATION
#include "brdf_test.h"

#define TABLE_SIZE 64
#define LIMIT      1.005

static bq_point points[BQ_MAX_POINTS];

static void polar(double cosine, double azimuth, double v[3])
{
    double s = sqrt((1.0 - cosine) * (1.0 + cosine));
    v[0] = s * cos(azimuth);
    v[1] = s * sin(azimuth);
    v[2] = cosine;
}

/* What of a white environment reaches the viewer in v, per channel. */
static void view_side(hdrp_brdf_data d, const double v[3], hdrp_u32 features, int count,
                      double albedo[3])
{
    hdrp_brdf_lit_view w = bt_view(d, bt_v3(v), features);
    albedo[0] = albedo[1] = albedo[2] = 0.0;
    for (int i = 0; i < count; ++i) {
        hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, bt_v3(points[i].l), features);
        for (int c = 0; c < 3; ++c) {
            albedo[c] += points[i].weight * bt_lit_sum(r, c);
        }
    }
}

/* What of the light from direction l leaves the surface. Light that crosses it arrives at a viewer
 * on the other side, which the model sees as a light from below. */
static void light_side(hdrp_brdf_data d, const double l[3], hdrp_u32 features, int count,
                       double albedo[3])
{
    albedo[0] = albedo[1] = albedo[2] = 0.0;
    for (int i = 0; i < count; ++i) {
        double v[3] = {points[i].l[0], points[i].l[1], fabs(points[i].l[2])};
        double from[3] = {l[0], l[1], points[i].l[2] < 0.0 ? -l[2] : l[2]};
        if (v[2] < 1e-4) {
            continue;
        }
        hdrp_brdf_lit_view w = bt_view(d, bt_v3(v), features);
        hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, bt_v3(from), features);
        for (int c = 0; c < 3; ++c) {
            albedo[c] += points[i].weight * bt_lit_sum(r, c) * v[2] / l[2];
        }
    }
}

static double largest(const double x[3])
{
    return fmax(fmax(x[0], x[1]), x[2]);
}

static hdrp_brdf_data material(float base_color, float metallic, float f0, float roughness)
{
    return hdrp_brdf_data_from_surface(bt_surface(base_color, metallic, f0, roughness));
}

static void the_quadrature_itself_is_right(void** state)
{
    bq_rule rule = bq_make(16, 12);
    (void)state;
    for (double c = 0.001; c <= 1.0; c += 0.0999) {
        /* Closed form at alpha = 1. */
        double reference = 1.0 - c * log(1.0 + 1.0 / c), v[3];
        assert_true(fabs(bq_integrate_fgd(&rule, c, 1.0, points).albedo - reference) < 2e-5);
        bt_lobe lobe = {0.3, 0.3, 0};
        polar(c, 0.4, v);
        double sum = 0.0, unused;
        int count = bt_mixed_points(v, &lobe, 1, 96, points);
        for (int i = 0; i < count; ++i) {
            sum += points[i].l[2] > 0.0
                       ? points[i].weight * bq_specular(v, points[i].l, 0.3, 0.3, &unused)
                       : 0.0;
        }
        assert_true(fabs(sum - bq_integrate_fgd(&rule, c, 0.3, points).albedo) < 2e-3);
    }
}

/* Fresnel0 = 1 and nothing below: every direction sees the furnace as it is. */
static void a_metal_of_fresnel0_one_is_white(void** state)
{
    bq_rule rule = bq_make(24, 12);
    double worst = 0.0, grazing = 0.0;
    (void)state;
    for (int i = 0; i <= 20; ++i) {
        float roughness = (float)i / 20.0f;
        double alpha = fmax((double)roughness * (double)roughness, 1e-4);
        hdrp_brdf_data d = material(1.0f, 1.0f, 0.04f, roughness);
        for (double c = 0.002; c <= 1.0; c = c < 0.049 ? 2.0 * c : c < 0.05 ? 0.05 : c + 0.095) {
            double v[3], albedo[3];
            /* Rounding a grazing direction turns its half vector by more than such a lobe is wide. */
            if (c * alpha < 2e-5) {
                continue;
            }
            polar(c, 0.0, v);
            int count = bq_points(&rule, acos(c), 0.0, alpha, points);
            view_side(d, v, 0u, count, albedo);
            double error = fabs(albedo[0] - 1.0);
            light_side(d, v, 0u, count, albedo);
            error = fmax(error, fabs(albedo[0] - 1.0));
            worst = fmax(worst, c >= 0.05 ? error : 0.0);
            grazing = fmax(grazing, error);
        }
    }
    print_message("F0 = 1 metal: error %.5f from n.v 0.05 upwards, %.5f from 0.002\n", worst,
                  grazing);
    assert_true(worst < 0.005 && grazing < 0.01);
}

/* The factor of the talk, for engines that scale one lobe: white from the view side. */
static void the_compensation_factor_with_a_table_keeps_a_furnace_white(void** state)
{
    static hdrp_brdf_fgd table[TABLE_SIZE * TABLE_SIZE];
    bq_rule rule = bq_make(16, 12);
    double worst = 0.0, grazing = 0.0;
    (void)state;
    assert_int_equal(hdrp_brdf_fgd_bake_rows(table, TABLE_SIZE, 0, TABLE_SIZE), HDRP_OK);
    for (float roughness = 0.0f; roughness <= 1.0f; roughness += 0.03f) {
        for (float c = 0.0005f; c <= 1.0f; c = c < 0.04f ? 1.5f * c : c + 0.041f) {
            double alpha = fmax((double)roughness * (double)roughness, 1e-4);
            hdrp_brdf_fgd fgd = hdrp_brdf_fgd_lookup(table, TABLE_SIZE, c, roughness);
            double factor = (double)hdrp_brdf_energy_compensation(fgd, hdrp_v3_splat(1.0f)).x;
            double error =
                fabs(bq_integrate_fgd(&rule, (double)c, alpha, points).albedo * factor - 1.0);
            worst = fmax(worst, c >= 0.05f ? error : 0.0);
            grazing = fmax(grazing, error);
        }
    }
    print_message("F0 = 1 by factor and 64 x 64 table: error %.5f from n.v 0.05 upwards, "
                  "%.5f from 0.0005\n",
                  worst, grazing);
    assert_true(worst < 0.005 && grazing < 0.08);
}

static void white_diffuse_and_specular_never_gain(void** state)
{
    const float f0[] = {0.0f, 0.005f, 0.02f, 0.04f, 0.1f, 0.3f, 0.7f, 0.95f, 1.0f};
    bq_rule rule = bq_make(12, 8);
    double most = 0.0, least = 2.0, light_most = 0.0;
    (void)state;
    for (int k = 0; k < 9; ++k) {
        for (float roughness = 0.05f; roughness <= 1.001f; roughness += 0.095f) {
            hdrp_brdf_data d = material(1.0f, 0.0f, f0[k], fminf(roughness, 1.0f));
            double alpha = (double)roughness * (double)roughness;
            for (double c = 0.008; c <= 1.01; c = c < 0.09 ? 2.0 * c : c + 0.124) {
                double v[3], albedo[3];
                polar(fmin(c, 1.0), 0.0, v);
                int count = bq_points(&rule, acos(fmin(c, 1.0)), 0.0, alpha, points);
                view_side(d, v, 0u, count, albedo);
                most = fmax(most, largest(albedo));
                least = fmin(least, albedo[0]);
                light_side(d, v, 0u, count, albedo);
                light_most = fmax(light_most, largest(albedo));
            }
        }
    }
    print_message(
        "white diffuse below every F0: albedo %.4f to %.4f, from the light's side at most "
        "%.4f\n",
        least, most, light_most);
    assert_true(most < LIMIT && light_most < LIMIT && least > 0.99);
}

static float often_an_end(uint64_t* seed)
{
    double x = bt_random(seed);
    return x < 0.25 ? 0.0f : x < 0.5 ? 1.0f : bt_random_f(seed);
}

static hdrp_brdf_data random_material(uint64_t* seed, hdrp_u32 features)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.features = features & HDRP_BRDF_FEATURE_ALL;
    s.base_color = hdrp_v3_make(1.0f, often_an_end(seed), often_an_end(seed));
    s.metallic = often_an_end(seed);
    s.dielectric_fresnel0 = hdrp_v3_splat(bt_random(seed) < 0.5 ? 0.04f : bt_random_f(seed));
    s.perceptual_roughness = 0.15f + 0.85f * bt_random_f(seed);
    s.anisotropy = 2.0f * bt_random_f(seed) - 1.0f;
    s.coat_mask = often_an_end(seed);
    s.coat_perceptual_roughness = bt_random(seed) < 0.5 ? 0.07f : 0.07f + 0.9f * bt_random_f(seed);
    s.film_mask = often_an_end(seed);
    s.film_ior = 1.0f + 1.5f * bt_random_f(seed);
    s.film_thickness_nm = bt_random(seed) < 0.2 ? 0.0f : 1200.0f * bt_random_f(seed);
    s.transmittance = hdrp_v3_make(1.0f, often_an_end(seed), often_an_end(seed));
    s.transmission = often_an_end(seed);
    s.ior = 1.2f + 0.8f * bt_random_f(seed);
    return hdrp_brdf_data_from_surface(s);
}

typedef struct furnace {
    double view, light;
} furnace;

static furnace random_furnace(hdrp_u32 features, int materials, uint64_t seed)
{
    furnace most = {0.0, 0.0};
    for (int i = 0; i < materials; ++i) {
        hdrp_brdf_data d = random_material(&seed, features);
        double v[3], albedo[3], c = bt_random(&seed);
        polar(0.01 + 0.99 * (i % 3 ? c : c * c * c), 6.2832 * bt_random(&seed), v);
        int count = bt_lit_points(d, v, features, points);
        view_side(d, v, features, count, albedo);
        most.view = fmax(most.view, largest(albedo));
        light_side(d, v, features, count, albedo);
        most.light = fmax(most.light, largest(albedo));
    }
    return most;
}

/* Every combination of features that the docstrings promise energy conservation for. */
static void no_combination_of_features_gains_energy(void** state)
{
    const hdrp_u32 used[] = {HDRP_BRDF_FEATURE_TRANSMISSION, HDRP_BRDF_FEATURE_CLEAR_COAT,
                             HDRP_BRDF_FEATURE_REFRACTION, HDRP_BRDF_FEATURE_IRIDESCENCE};
    double most = 0.0, light = 0.0, film_light = 0.0;
    (void)state;
    for (int combination = 0; combination < 16; ++combination) {
        hdrp_u32 features = 0u;
        for (int k = 0; k < 4; ++k) {
            features |= combination >> k & 1 ? used[k] : 0u;
        }
        furnace f = random_furnace(features, 40, (uint64_t)combination);
        most = fmax(most, f.view);
        if (features & HDRP_BRDF_FEATURE_IRIDESCENCE) {
            film_light = fmax(film_light, f.light);
        } else {
            light = fmax(light, f.light);
        }
    }
    /* Stretched, but for the wall, whose lobe the quadrature of stretched lobes does not see. */
    for (int combination = 0; combination < 8; ++combination) {
        hdrp_u32 features = HDRP_BRDF_FEATURE_ANISOTROPY;
        features |= combination & 1 ? HDRP_BRDF_FEATURE_TRANSMISSION : 0u;
        features |= combination & 2 ? HDRP_BRDF_FEATURE_CLEAR_COAT : 0u;
        features |= combination & 4 ? HDRP_BRDF_FEATURE_IRIDESCENCE : 0u;
        furnace f = random_furnace(features, 12, (uint64_t)combination + 100u);
        most = fmax(most, f.view);
        light = fmax(light, features & HDRP_BRDF_FEATURE_IRIDESCENCE ? 0.0 : f.light);
    }
    print_message("coat, film, slab and wall in all combinations: at most %.4f from the view's "
                  "side; %.4f from the light's, %.4f with a film\n",
                  most, light, film_light);
    assert_true(most < LIMIT && light < LIMIT && film_light < 1.1);
}

static double sum_of_weights(const hdrp_brdf_lit_env* e, int c)
{
    return bt_component(e->specular_weight, c) + bt_component(e->diffuse_weight, c) +
           bt_component(e->through_weight, c) + bt_component(e->transmitted_weight, c) +
           (double)e->coat_weight;
}

/* At any view, and whether the FGD comes from a table or from the fit, which differ at grazing. */
static void an_environment_is_never_asked_for_more_than_there_is(void** state)
{
    static hdrp_brdf_fgd table[TABLE_SIZE * TABLE_SIZE];
    double most[2] = {0.0, 0.0}, coated[2] = {0.0, 0.0};
    uint64_t seed = 11u;
    (void)state;
    assert_int_equal(hdrp_brdf_fgd_bake_rows(table, TABLE_SIZE, 0, TABLE_SIZE), HDRP_OK);
    for (int i = 0; i < 400000; ++i) {
        hdrp_u32 features = i % 2 ? 0u : (hdrp_u32)(i / 4) & HDRP_BRDF_FEATURE_ALL;
        hdrp_brdf_data d = random_material(&seed, features);
        double c = pow(1e-4, bt_random(&seed)), phi = 6.2832 * bt_random(&seed);
        d.perceptual_roughness = often_an_end(&seed);
        int fit = i / 2 % 2;
        float n_dot_v = (float)c;
        hdrp_brdf_fgd fgd =
            fit ? hdrp_brdf_fgd_fast(n_dot_v, d.perceptual_roughness)
                : hdrp_brdf_fgd_lookup(table, TABLE_SIZE, n_dot_v, d.perceptual_roughness);
        hdrp_brdf_lit_view w = hdrp_brdf_lit_view_make(d, bt_direction(c, phi), fgd, features);
        hdrp_brdf_lit_env e = hdrp_brdf_lit_env_make(d, w, features);
        for (int channel = 0; channel < 3; ++channel) {
            double* x = features & HDRP_BRDF_FEATURE_CLEAR_COAT ? coated : most;
            x[fit] = fmax(x[fit], sum_of_weights(&e, channel));
        }
    }
    print_message(
        "weights of an environment: at most %.4f by table, %.4f by fit, under a coat %.4f "
        "and %.4f\n",
        most[0], most[1], coated[0], coated[1]);
    assert_true(most[0] < 1.0 + 1e-6 && most[1] < 1.0 + 1e-6);
    assert_true(coated[0] < LIMIT && coated[1] < LIMIT);
}

/* A white surface under a film, as it is made or, for extremes, as no shop sells it. */
static hdrp_brdf_data random_film(uint64_t* seed, int extreme, hdrp_u32 features)
{
    hdrp_brdf_surface s = bt_surface(1.0f, 0.0f, 0.04f, 0.1f + 0.9f * bt_random_f(seed));
    s.features = features & HDRP_BRDF_FEATURE_ALL;
    s.anisotropy = bt_random_f(seed) - 0.5f;
    s.coat_mask = s.film_mask = 1.0f;
    s.film_ior = 1.2f + 0.8f * bt_random_f(seed);
    s.film_thickness_nm = 100.0f + 700.0f * bt_random_f(seed);
    if (extreme) {
        s.film_mask = 0.5f + 0.5f * bt_random_f(seed);
        s.film_ior = 1.0f + 2.0f * bt_random_f(seed);
        s.film_thickness_nm = 3000.0f * bt_random_f(seed);
        s.dielectric_fresnel0 = hdrp_v3_splat(bt_random_f(seed));
    }
    return hdrp_brdf_data_from_surface(s);
}

static void an_exact_film_does_not_gain(void** state)
{
    const hdrp_u32 base = HDRP_BRDF_FEATURE_IRIDESCENCE | HDRP_BRDF_LIT_EXACT;
    const char* names[] = {"ordinary", "extreme", "coated", "stretched"};
    (void)state;
    for (int k = 0; k < 4; ++k) {
        hdrp_u32 features = base | (k == 2   ? HDRP_BRDF_FEATURE_CLEAR_COAT
                                    : k == 3 ? HDRP_BRDF_FEATURE_ANISOTROPY
                                             : 0u);
        double most = 0.0, least = 2.0, light = 0.0, weights = 0.0;
        uint64_t seed = 20u + (uint64_t)k;
        for (int i = 0; i < (k < 2 ? 400 : 60); ++i) {
            hdrp_brdf_data d = random_film(&seed, k == 1, features);
            double c = 0.02 + 0.98 * bt_random(&seed), v[3], albedo[3];
            polar(c, 6.2832 * bt_random(&seed), v);
            int count = bt_lit_points(d, v, features, points);
            view_side(d, v, features, count, albedo);
            most = fmax(most, largest(albedo));
            least = fmin(least, fmin(fmin(albedo[0], albedo[1]), albedo[2]));
            hdrp_brdf_lit_env e =
                hdrp_brdf_lit_env_make(d, bt_view(d, bt_v3(v), features), features);
            for (int channel = 0; channel < 3 && k != 2; ++channel) {
                double error = sum_of_weights(&e, channel) - bt_component(bt_v3(albedo), channel);
                weights = fmax(weights, fabs(error));
            }
            if (i < 15 && k < 2) {
                light_side(d, v, features, count, albedo);
                light = fmax(light, largest(albedo));
            }
        }
        print_message("exact film, %s: %.4f to %.4f from the view's side, at most %.4f from the "
                      "light's; environment off by %.4f\n",
                      names[k], least, most, light, weights);
        assert_true(most < 1.01 && light < 1.07);
        assert_true(k == 2 || (least > 0.98 && weights < 0.02));
    }
}

/* Where the Schlick curve through the film at the view misses most of what other facets reflect. */
static void a_film_of_high_index_on_plastic_does_not_gain(void** state)
{
    const hdrp_u32 features = HDRP_BRDF_FEATURE_IRIDESCENCE | HDRP_BRDF_LIT_EXACT;
    hdrp_brdf_surface s = bt_surface(1.0f, 0.0f, 0.04f, 0.617f);
    double v[3], albedo[3];
    (void)state;
    s.features = HDRP_BRDF_FEATURE_IRIDESCENCE;
    s.film_mask = 1.0f;
    s.film_ior = 2.83f;
    s.film_thickness_nm = 281.0f;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    polar(0.15, 0.0, v);
    view_side(d, v, features, bt_lit_points(d, v, features, points), albedo);
    for (int c = 0; c < 3; ++c) {
        assert_true(fabs(albedo[c] - 1.0) < 0.005);
    }
}

/* Least and greatest albedo of a white surface, stretched by this much, over directions of view. */
static void stretched_albedos(float anisotropy, float fresnel0, double* least, double* most)
{
    const double cosines[] = {0.005, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0};
    const double azimuths[] = {0.0, 30.0, 60.0, 80.0, 90.0};
    for (int i = 0; i < 30 * 8; ++i) {
        double c = cosines[i / 30], albedo[3], v[3];
        float roughness = 0.2f * (float)(i / 5 % 6);
        /* Both signs: the same lobe, turned by a right angle. */
        int turned = i % 2;
        hdrp_brdf_surface s = bt_surface(1.0f, fresnel0 < 1.0f ? 0.0f : 1.0f, fresnel0, roughness);
        s.features = HDRP_BRDF_FEATURE_ANISOTROPY;
        s.anisotropy = turned ? -anisotropy : anisotropy;
        hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
        hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(roughness, s.anisotropy);
        bt_lobe lobe = {(double)a.t, (double)a.b, 0};
        /* Rounding a grazing direction turns its half vector by more than such a lobe is wide. */
        if (c * (double)roughness * (double)roughness < 2e-5) {
            continue;
        }
        polar(c, azimuths[i % 5] * BQ_PI / 180.0 + (turned ? BQ_PI / 2.0 : 0.0), v);
        int count = bt_mixed_points(v, &lobe, 1, 56, points);
        view_side(d, v, s.features, count, albedo);
        *most = fmax(*most, albedo[0]);
        *least = c >= 0.05 ? fmin(*least, albedo[0]) : *least;
        if (i % 4 == 0) {
            light_side(d, v, s.features, count, albedo);
            *most = fmax(*most, albedo[0]);
        }
    }
}

static void an_anisotropic_lobe_never_gains(void** state)
{
    const float fresnel0[] = {1.0f, 0.3f, 0.04f};
    const double floors[] = {0.985, 0.965, 0.93, 0.93};
    (void)state;
    for (int k = 0; k < 3; ++k) {
        for (int step = 1; step <= 4; ++step) {
            double most = 0.0, least = 2.0;
            stretched_albedos(0.25f * (float)step, fresnel0[k], &least, &most);
            print_message("anisotropy +-%.2f, F0 %.2f: albedo %.4f (n.v from 0.05) to %.4f\n",
                          0.25 * step, (double)fresnel0[k], least, most);
            assert_true(most < LIMIT && least > floors[step - 1]);
        }
    }
}

/* The published lobes do not conserve energy: this is the table of by how much. */
static void published_diffuse_lobes_exceed_one(void** state)
{
    bq_rule rule = bq_make(24, 24);
    double most[2] = {0.0, 0.0}, ahead[2] = {2.0, 0.0};
    (void)state;
    print_message("albedo of Burley's diffuse lobe, and normalized\n  roughness");
    const double cosines[] = {1.0, 0.75, 0.5, 0.25, 0.1, 0.01, 1e-4};
    for (int j = 0; j < 7; ++j) {
        print_message("     n.v %.2f   ", cosines[j]);
    }
    for (float roughness = 0.0f; roughness <= 1.0f; roughness += 0.25f) {
        print_message("\n     %.2f  ", (double)roughness);
        for (int j = 0; j < 7; ++j) {
            double v[3], sum[2] = {0.0, 0.0};
            polar(cosines[j], 0.0, v);
            int count = bq_points(&rule, acos(cosines[j]), 0.0, 0.5, points);
            for (int i = 0; i < count; ++i) {
                const double* l = points[i].l;
                float l_dot_v = (float)(l[0] * v[0] + l[1] * v[1] + l[2] * v[2]);
                double weight = points[i].weight * l[2];
                sum[0] += weight * (double)hdrp_brdf_diffuse_disney((float)v[2], (float)l[2],
                                                                    l_dot_v, roughness);
                sum[1] += weight * (double)hdrp_brdf_diffuse_disney_normalized(
                                       (float)v[2], (float)l[2], l_dot_v, roughness);
            }
            print_message("  %.3f  %.3f", sum[0], sum[1]);
            most[0] = fmax(most[0], sum[0]);
            most[1] = fmax(most[1], sum[1]);
            if (j == 0) {
                ahead[0] = fmin(ahead[0], sum[1]);
                ahead[1] = fmax(ahead[1], sum[1]);
            }
        }
    }
    print_message("\n");
    assert_true(most[0] > 1.555 && most[0] < 1.565);
    assert_true(most[1] > 1.025 && most[1] < 1.035);
    assert_true(fabs(ahead[0] - 0.69) < 0.005 && fabs(ahead[1] - 0.95) < 0.005);
}

static void a_thin_slab_shares_its_light(void** state)
{
    const float transmittance[] = {0.0f, 0.05f, 0.5f, 1.0f};
    (void)state;
    for (int k = 0; k < 4; ++k) {
        for (int white = 0; white < 2; ++white) {
            hdrp_brdf_surface s = bt_surface(white ? 1.0f : 0.2f, 0.0f, 0.0f, 0.5f);
            s.features = HDRP_BRDF_FEATURE_TRANSMISSION;
            s.transmittance = hdrp_v3_splat(transmittance[k]);
            hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
            hdrp_v3 n = d.normal;
            hdrp_brdf_lit_view w = bt_view(d, n, s.features);
            float front = hdrp_brdf_lit_eval(d, w, n, s.features).diffuse.x * HDRP_PI;
            float back = hdrp_brdf_lit_eval(d, w, hdrp_v3_neg(n), s.features).diffuse.x * HDRP_PI;
            float c = d.diffuse_color.x, t = transmittance[k];
            /* Through light is the front's times the transmittance, as in the talk; white light is
             * shared, and a dark or dense slab reflects almost as if it were opaque. */
            assert_true(fabsf(back - t * front) < 1e-6f && front + back <= 1.0f + 1e-6f);
            assert_true(fabsf(front - c / (1.0f + c * t)) < 1e-3f);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_quadrature_itself_is_right),
        cmocka_unit_test(a_metal_of_fresnel0_one_is_white),
        cmocka_unit_test(the_compensation_factor_with_a_table_keeps_a_furnace_white),
        cmocka_unit_test(white_diffuse_and_specular_never_gain),
        cmocka_unit_test(no_combination_of_features_gains_energy),
        cmocka_unit_test(an_environment_is_never_asked_for_more_than_there_is),
        cmocka_unit_test(an_exact_film_does_not_gain),
        cmocka_unit_test(a_film_of_high_index_on_plastic_does_not_gain),
        cmocka_unit_test(an_anisotropic_lobe_never_gains),
        cmocka_unit_test(published_diffuse_lobes_exceed_one),
        cmocka_unit_test(a_thin_slab_shares_its_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
