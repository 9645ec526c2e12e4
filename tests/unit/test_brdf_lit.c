/* test_brdf_lit.c - the Lit model: reciprocal, total, and the same with and without what it lacks.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#include "brdf_test.h"

static bq_point points[BQ_MAX_POINTS];

static hdrp_v3 random_direction(uint64_t* seed)
{
    return bt_direction(2.0 * bt_random(seed) - 1.0, 6.2832 * bt_random(seed));
}

static hdrp_brdf_data random_material(uint64_t* seed, hdrp_u32 features)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.features = features & HDRP_BRDF_FEATURE_ALL;
    s.base_color = hdrp_v3_make(bt_random_f(seed), bt_random_f(seed), 1.0f);
    s.metallic = bt_random(seed) < 0.3 ? 1.0f : bt_random_f(seed);
    s.dielectric_fresnel0 = hdrp_v3_splat(bt_random(seed) < 0.5 ? 0.04f : bt_random_f(seed));
    s.perceptual_roughness = 0.1f + 0.9f * bt_random_f(seed);
    s.normal = random_direction(seed);
    s.tangent = random_direction(seed);
    s.anisotropy = 2.0f * bt_random_f(seed) - 1.0f;
    s.coat_mask = bt_random_f(seed);
    s.coat_perceptual_roughness = 0.1f + 0.9f * bt_random_f(seed);
    s.coat_normal = hdrp_v3_mad(s.normal, random_direction(seed), 0.2f);
    s.film_mask = bt_random_f(seed);
    s.film_ior = 1.0f + 1.5f * bt_random_f(seed);
    s.film_thickness_nm = 1200.0f * bt_random_f(seed);
    s.subsurface_mask = bt_random_f(seed);
    s.transmittance = hdrp_v3_make(bt_random_f(seed), 1.0f, bt_random_f(seed));
    s.transmission = bt_random_f(seed);
    s.ior = 1.3f + bt_random_f(seed);
    return hdrp_brdf_data_from_surface(s);
}

static int same_bits(hdrp_brdf_lit a, hdrp_brdf_lit b)
{
    return a.diffuse.x == b.diffuse.x && a.diffuse.y == b.diffuse.y && a.diffuse.z == b.diffuse.z &&
           a.specular.x == b.specular.x && a.specular.y == b.specular.y &&
           a.specular.z == b.specular.z;
}

/* The BRDF from v to l and from l to v, on the side of the normal or through the surface, where
 * both are seen from their own side. */
static void compare_both_ways(hdrp_brdf_data d, hdrp_v3 v, hdrp_v3 l, hdrp_u32 features,
                              double tolerance)
{
    hdrp_brdf_data back = d;
    float side = hdrp_sign_not_zero(hdrp_v3_dot(d.normal, l));
    back.normal = hdrp_v3_scale(d.normal, side);
    back.bitangent = hdrp_v3_scale(d.bitangent, side);
    back.coat_normal = hdrp_v3_scale(d.coat_normal, side);
    hdrp_brdf_lit forth = hdrp_brdf_lit_eval(d, bt_view(d, v, features), l, features);
    hdrp_brdf_lit return_ = hdrp_brdf_lit_eval(back, bt_view(back, l, features), v, features);
    double nl = fabs((double)hdrp_v3_dot(d.normal, l)), nv = (double)hdrp_v3_dot(d.normal, v);
    for (int c = 0; c < 3; ++c) {
        double a = bt_component(forth.diffuse, c) / nl, b = bt_component(return_.diffuse, c) / nv;
        if (!(fabs(a - b) <= tolerance * (fabs(a) + fabs(b)))) {
            fail_msg("diffuse %.9g and %.9g, features %u", a, b, features);
        }
        a = bt_component(forth.specular, c) / nl;
        b = bt_component(return_.specular, c) / nv;
        if (!(fabs(a - b) <= tolerance * (fabs(a) + fabs(b)))) {
            fail_msg("specular %.9g and %.9g, features %u", a, b, features);
        }
    }
}

/* All features but the thin film, whose F0 is that of one view. */
static void every_lobe_is_reciprocal(void** state)
{
    const hdrp_u32 used[] = {HDRP_BRDF_FEATURE_TRANSMISSION, HDRP_BRDF_FEATURE_CLEAR_COAT,
                             HDRP_BRDF_FEATURE_REFRACTION, HDRP_BRDF_FEATURE_ANISOTROPY};
    uint64_t seed = 1;
    int compared = 0;
    (void)state;
    for (int i = 0; i < 40000; ++i) {
        hdrp_u32 features = 0u;
        for (int k = 0; k < 4; ++k) {
            features |= i >> k & 1 ? used[k] : 0u;
        }
        hdrp_brdf_data d = random_material(&seed, features);
        hdrp_v3 v = random_direction(&seed), l = random_direction(&seed);
        /* A coat with a normal of its own has a cosine of its own. */
        d.coat_normal = d.normal;
        /* Grazing views are bent to HDRP_BRDF_N_DOT_V_MIN, lights are not. Narrow anisotropic lobes
         * amplify the rounding of the frame. */
        if (hdrp_v3_dot(d.normal, v) > 0.01f && fabsf(hdrp_v3_dot(d.normal, l)) > 0.01f) {
            compare_both_ways(d, v, l, features, 3e-4);
            ++compared;
        }
    }
    assert_true(compared > 10000);
}

static void a_film_is_reciprocal_at_mirror_angles_only(void** state)
{
    hdrp_brdf_surface s = bt_surface(0.5f, 0.0f, 0.04f, 0.3f);
    s.features = HDRP_BRDF_FEATURE_IRIDESCENCE;
    s.film_mask = 1.0f;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    (void)state;
    for (double c = 0.05; c < 1.0; c += 0.1) {
        compare_both_ways(d, bt_direction(c, 0.0), bt_direction(c, BQ_PI), s.features, 1e-4);
    }
}

/* A mask may name features that the material lacks; it may not drop one that it has. */
static void an_absent_feature_changes_no_bit(void** state)
{
    const hdrp_u32 neutral = HDRP_BRDF_FEATURE_ALL & ~HDRP_BRDF_FEATURE_ANISOTROPY;
    uint64_t seed = 2;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_u32 own = (hdrp_u32)i & HDRP_BRDF_FEATURE_ALL;
        hdrp_u32 wide = own | neutral;
        hdrp_brdf_data d = random_material(&seed, own);
        hdrp_v3 v = random_direction(&seed), l = random_direction(&seed);
        hdrp_brdf_lit_view w = bt_view(d, v, own), x = bt_view(d, v, wide);
        assert_true(same_bits(hdrp_brdf_lit_eval(d, w, l, own), hdrp_brdf_lit_eval(d, x, l, wide)));
        assert_true(hdrp_brdf_lit_pdf(d, w, l, own) == hdrp_brdf_lit_pdf(d, x, l, wide));
    }
}

static void no_anisotropy_is_isotropic_up_to_rounding(void** state)
{
    uint64_t seed = 3;
    (void)state;
    for (int i = 0; i < 5000; ++i) {
        hdrp_brdf_data d = random_material(&seed, 0u);
        hdrp_v3 v = random_direction(&seed), l = random_direction(&seed);
        hdrp_brdf_lit a = hdrp_brdf_lit_eval(d, bt_view(d, v, 0u), l, 0u);
        hdrp_u32 mask = HDRP_BRDF_FEATURE_ANISOTROPY;
        hdrp_brdf_lit b = hdrp_brdf_lit_eval(d, bt_view(d, v, mask), l, mask);
        double x = bt_lit_sum(a, 1), y = bt_lit_sum(b, 1);
        assert_true(fabs(x - y) <= 1e-4 * fabs(x));
    }
}

static void the_subsurface_feature_leaves_lighting_alone(void** state)
{
    uint64_t seed = 4;
    hdrp_brdf_data d = random_material(&seed, HDRP_BRDF_FEATURE_SUBSURFACE);
    (void)state;
    for (int i = 0; i < 100; ++i) {
        hdrp_v3 v = random_direction(&seed), l = random_direction(&seed);
        hdrp_u32 f = HDRP_BRDF_FEATURE_SUBSURFACE;
        assert_true(same_bits(hdrp_brdf_lit_eval(d, bt_view(d, v, 0u), l, 0u),
                              hdrp_brdf_lit_eval(d, bt_view(d, v, f), l, f)));
    }
}

static double reflected(const hdrp_brdf_lit_env* e, int c)
{
    return bt_component(e->specular_weight, c) + bt_component(e->diffuse_weight, c) +
           bt_component(e->through_weight, c) + bt_component(e->transmitted_weight, c) +
           (double)e->coat_weight;
}

/* In a white furnace the weights add up to what the lights of all directions do. */
static void environment_weights_are_the_integral_of_all_lights(void** state)
{
    const struct {
        const char* name;
        hdrp_u32 features;
        double tolerance;
    } cases[] = {{"base", 0u, 0.005},
                 {"slab", HDRP_BRDF_FEATURE_TRANSMISSION, 0.006},
                 {"film", HDRP_BRDF_FEATURE_IRIDESCENCE, 0.006},
                 {"wall", HDRP_BRDF_FEATURE_REFRACTION, 0.006},
                 {"coat", HDRP_BRDF_FEATURE_CLEAR_COAT, 0.05},
                 {"anisotropy", HDRP_BRDF_FEATURE_ANISOTROPY, 0.05}};
    uint64_t seed = 5;
    (void)state;
    for (int k = 0; k < 6; ++k) {
        double worst = 0.0;
        for (int i = 0; i < 60; ++i) {
            hdrp_u32 f = cases[k].features;
            hdrp_brdf_data d = random_material(&seed, f);
            hdrp_brdf_surface s = hdrp_brdf_surface_default();
            d.normal = d.coat_normal = s.normal;
            d.tangent = s.tangent;
            d.bitangent = hdrp_v3_make(0.0f, 1.0f, 0.0f);
            d.ior = 1.3f + 0.5f * bt_random_f(&seed);
            d.perceptual_roughness = hdrp_max(d.perceptual_roughness, 0.15f);
            double c = 0.02 + 0.98 * bt_random(&seed), phi = 6.2832 * bt_random(&seed), sum[3];
            double v[3] = {sqrt(1.0 - c * c) * cos(phi), sqrt(1.0 - c * c) * sin(phi), c};
            int count = bt_lit_points(d, v, f, points);
            hdrp_brdf_lit_view w = bt_view(d, bt_v3(v), f);
            sum[0] = sum[1] = sum[2] = 0.0;
            for (int j = 0; j < count; ++j) {
                hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, bt_v3(points[j].l), f);
                for (int channel = 0; channel < 3; ++channel) {
                    sum[channel] += points[j].weight * bt_lit_sum(r, channel);
                }
            }
            hdrp_brdf_lit_env e = hdrp_brdf_lit_env_make(d, w, f);
            for (int channel = 0; channel < 3; ++channel) {
                worst = fmax(worst, fabs(reflected(&e, channel) - sum[channel]));
            }
        }
        print_message("environment of a furnace, %s: off by at most %.4f\n", cases[k].name, worst);
        assert_true(worst < cases[k].tolerance);
    }
}

static void occlusion_dims_the_environment_only(void** state)
{
    uint64_t seed = 6;
    hdrp_brdf_data d = random_material(&seed, HDRP_BRDF_FEATURE_CLEAR_COAT);
    (void)state;
    d.ambient_occlusion = 0.5f;
    d.specular_occlusion = 0.25f;
    hdrp_brdf_data open = d;
    open.ambient_occlusion = open.specular_occlusion = 1.0f;
    hdrp_u32 f = HDRP_BRDF_FEATURE_CLEAR_COAT;
    hdrp_brdf_lit_view w = bt_view(d, d.normal, f);
    hdrp_brdf_lit_env a = hdrp_brdf_lit_env_make(d, w, f), b = hdrp_brdf_lit_env_make(open, w, f);
    assert_true(a.diffuse_weight.x == 0.5f * b.diffuse_weight.x);
    assert_true(a.specular_weight.y == 0.25f * b.specular_weight.y);
    assert_true(a.coat_weight == 0.25f * b.coat_weight);
    assert_true(same_bits(hdrp_brdf_lit_eval(d, w, d.normal, f),
                          hdrp_brdf_lit_eval(open, bt_view(open, d.normal, f), d.normal, f)));
}

static void the_environment_is_asked_where_it_is_seen(void** state)
{
    hdrp_brdf_surface s = bt_surface(1.0f, 1.0f, 0.04f, 0.0f);
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    hdrp_v3 v = hdrp_v3_make(0.6f, 0.0f, 0.8f);
    (void)state;
    hdrp_brdf_lit_env e = hdrp_brdf_lit_env_make(d, bt_view(d, v, 0u), 0u);
    assert_true(fabsf(e.specular_direction.x + 0.6f) < 1e-3f &&
                fabsf(e.specular_direction.z - 0.8f) < 1e-3f);
    /* A rough lobe gets most of its light from nearer to the normal. */
    assert_true(hdrp_brdf_dominant_direction(d.normal, e.specular_direction, 1.0f).z == 1.0f);
    /* By hand: 0.64 (sqrt(0.64) + 0.36) = 0.7424 of the way, (0.44544, 0, 0.85152) before scaling. */
    hdrp_v3 mirror = hdrp_v3_make(0.6f, 0.0f, 0.8f);
    hdrp_v3 dominant = hdrp_brdf_dominant_direction(d.normal, mirror, 0.36f);
    assert_true(fabsf(dominant.x - 0.463522f) < 2e-6f && fabsf(dominant.z - 0.886086f) < 2e-6f);
    d.transmission = 1.0f;
    d.transmittance = d.diffuse_color = hdrp_v3_splat(1.0f);
    d.ior = 1.5f;
    hdrp_u32 f = HDRP_BRDF_FEATURE_REFRACTION;
    e = hdrp_brdf_lit_env_make(d, bt_view(d, v, f), f);
    assert_true(e.transmitted_direction.x == -v.x && e.transmitted_direction.z == -v.z);
    d.volume_thickness_m = 0.1f;
    e = hdrp_brdf_lit_env_make(d, bt_view(d, v, f), f);
    assert_true(fabsf(e.transmitted_direction.x + 0.4f) < 1e-6f); /* Snell: 0.6 / 1.5 */
}

static int finite_lit(hdrp_brdf_lit r)
{
    for (int c = 0; c < 3; ++c) {
        double d = bt_component(r.diffuse, c), s = bt_component(r.specular, c);
        if (!(d >= 0.0 && s >= 0.0 && d < 1e30 && s < 1e30)) {
            return 0;
        }
    }
    return 1;
}

/* Every direction that a light or a normal map can come up with. */
static void extreme_directions_stay_finite(void** state)
{
    const double cosines[] = {1.0, 1e-3, 1e-7, 1e-20, 0.0, -1e-7, -0.5, -1.0};
    uint64_t seed = 7;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_u32 f = (hdrp_u32)i & HDRP_BRDF_FEATURE_ALL;
        f |= i & 64 ? HDRP_BRDF_LIT_EXACT : 0u;
        hdrp_brdf_data d = random_material(&seed, f);
        hdrp_brdf_surface surface = hdrp_brdf_surface_default();
        d.normal = surface.normal;
        d.tangent = surface.tangent;
        d.bitangent = hdrp_v3_make(0.0f, 1.0f, 0.0f);
        d.perceptual_roughness = i % 3 ? (float)(i % 3 - 1) : d.perceptual_roughness;
        d.coat_perceptual_roughness = 0.0f;
        d.fresnel0 = hdrp_v3_make(0.0f, 1.0f, 1e-6f);
        hdrp_v3 v = bt_direction(cosines[i % 8], 0.3);
        hdrp_v3 l = i % 5 == 0   ? hdrp_v3_neg(v)
                    : i % 5 == 1 ? v
                    : i % 5 == 2 ? bt_direction(cosines[i / 8 % 8], 0.3 + BQ_PI)
                                 : bt_direction(cosines[i / 8 % 8], 6.2832 * bt_random(&seed));
        hdrp_brdf_lit_view w = bt_view(d, v, f);
        hdrp_v3 u = hdrp_v3_make(bt_random_f(&seed), (float)(i % 2), (float)(i / 2 % 2));
        hdrp_v3 drawn = hdrp_brdf_lit_sample(d, w, u, f);
        assert_true(finite_lit(hdrp_brdf_lit_eval(d, w, l, f)));
        assert_true(finite_lit(hdrp_brdf_lit_eval(d, w, drawn, f)));
        assert_true(hdrp_brdf_lit_pdf(d, w, l, f) >= 0.0f);
        assert_true(hdrp_brdf_lit_pdf(d, w, l, f) <= HDRP_FLT_MAX);
        assert_true(fabsf(hdrp_v3_length(drawn) - 1.0f) < 1e-6f);
    }
}

static void a_view_from_behind_is_bent_to_the_horizon(void** state)
{
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(bt_surface(0.8f, 0.0f, 0.04f, 0.4f));
    (void)state;
    for (double c = 0.01; c >= -1.0; c -= 0.0505) {
        hdrp_brdf_lit_view w = bt_view(d, bt_direction(c, 1.0), 0u);
        assert_true(w.n_dot_v >= HDRP_BRDF_N_DOT_V_MIN &&
                    fabsf(hdrp_v3_length(w.v) - 1.0f) < 1e-6f);
        assert_true(fabsf(hdrp_v3_dot(w.v, d.normal) - w.n_dot_v) < 1e-6f);
        if (c < 0.0 && c > -0.99) {
            /* In the plane of the view, just above the horizon. */
            assert_true(w.n_dot_v < 1e-3f && fabsf(w.v.x - (float)cos(1.0)) < 1e-3f);
        }
    }
}

static void a_black_surface_is_black(void** state)
{
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(bt_surface(0.0f, 0.0f, 0.0f, 0.5f));
    uint64_t seed = 8;
    (void)state;
    for (int i = 0; i < 1000; ++i) {
        hdrp_v3 v = random_direction(&seed), l = random_direction(&seed);
        hdrp_u32 f = HDRP_BRDF_FEATURE_ALL & ~HDRP_BRDF_FEATURE_IRIDESCENCE;
        hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, bt_view(d, v, f), l, f);
        assert_true(bt_lit_sum(r, 0) == 0.0 && bt_lit_sum(r, 2) == 0.0);
    }
}

static void light_below_the_horizon_needs_a_slab_or_a_wall(void** state)
{
    hdrp_v3 below = hdrp_v3_make(0.0f, 0.6f, -0.8f);
    (void)state;
    for (hdrp_u32 f = 0u; f <= HDRP_BRDF_FEATURE_ALL; ++f) {
        hdrp_brdf_surface s = bt_surface(0.8f, 0.0f, 0.04f, 0.4f);
        s.features = f;
        s.coat_mask = s.film_mask = s.transmission = 0.5f;
        s.transmittance = hdrp_v3_splat(0.5f);
        hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
        hdrp_v3 v = hdrp_v3_make(0.0f, -0.6f, 0.8f);
        hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, bt_view(d, v, f), below, f);
        assert_true((r.diffuse.x > 0.0f) == ((f & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u));
        assert_true((r.specular.x > 0.0f) == ((f & HDRP_BRDF_FEATURE_REFRACTION) != 0u));
    }
}

/* The coat's index is the base's, so that under the coat nothing is left to reflect. */
static void a_coat_on_its_own_material_hides_the_base_lobe(void** state)
{
    hdrp_brdf_surface s = bt_surface(0.0f, 0.0f, 0.04f, 0.6f);
    s.features = HDRP_BRDF_FEATURE_CLEAR_COAT;
    s.coat_mask = 1.0f;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    hdrp_brdf_lit_view w = bt_view(d, hdrp_v3_make(0.6f, 0.0f, 0.8f), s.features);
    (void)state;
    assert_true(hdrp_v3_max_component(w.fresnel0) < 1e-12f && w.fresnel90 < 1e-9f);
}

/* Over a base of its own index and no colour a coat is alone. Its lobe reflects what a GGX lobe of
 * Schlick's F0 = 0.04 does. */
static void a_coat_reflects_what_its_fresnel_term_and_width_say(void** state)
{
    bq_rule rule = bq_make(16, 12);
    (void)state;
    for (int i = 0; i < 24; ++i) {
        double c = 0.1 + 0.3 * (i % 4), v[3] = {sqrt(1.0 - c * c), 0.0, c}, sum = 0.0;
        hdrp_brdf_surface s = bt_surface(0.0f, 0.0f, 0.04f, 0.5f);
        s.features = HDRP_BRDF_FEATURE_CLEAR_COAT;
        s.coat_mask = i < 12 ? 1.0f : 0.5f;
        s.coat_perceptual_roughness = 0.2f + 0.25f * (float)(i / 4 % 3);
        hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
        d.fresnel0 = hdrp_v3_splat(i < 12 ? 0.04f : 0.0f);
        hdrp_brdf_lit_view w = bt_view(d, bt_v3(v), s.features);
        w.fresnel0 = w.bounces.reflected = hdrp_v3_splat(0.0f);
        w.fresnel90 = 0.0f;
        double alpha = bt_alpha(d.coat_perceptual_roughness);
        bq_fgd fgd = bq_integrate_fgd(&rule, c, alpha, points);
        double expected = (double)d.coat_mask * (0.04 * (fgd.albedo - fgd.schlick) + fgd.schlick);
        int count = bq_points(&rule, acos(c), 0.0, alpha, points);
        for (int j = 0; j < count; ++j) {
            hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, bt_v3(points[j].l), s.features);
            sum += points[j].weight * bt_lit_sum(r, 1);
        }
        assert_true(fabs(sum - expected) < 1e-3 * expected);
    }
}

/* Light from all around meets the coat at all angles: its mean Fresnel term, by quadrature. */
static void a_coat_dims_diffuse_light_by_its_mean_fresnel_term(void** state)
{
    double mean = 0.0;
    const int steps = 2000;
    (void)state;
    for (int i = 0; i < steps; ++i) {
        double c = (i + 0.5) / steps;
        mean += 2.0 * c * (0.04 + 0.96 * pow(1.0 - c, 5.0)) / steps;
    }
    for (float mask = 0.25f; mask <= 1.0f; mask += 0.25f) {
        hdrp_brdf_surface s = bt_surface(0.5f, 0.0f, 0.04f, 0.5f);
        s.features = HDRP_BRDF_FEATURE_CLEAR_COAT;
        s.coat_mask = mask;
        hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
        hdrp_brdf_lit_view w = bt_view(d, d.normal, s.features);
        hdrp_brdf_lit_env e = hdrp_brdf_lit_env_make(d, w, s.features);
        /* On the way out along the normal F0 is lost, on the way in the mean. */
        double expected = (1.0 - 0.04 * (double)mask) * (1.0 - mean * (double)mask);
        assert_true(fabs((double)(e.diffuse_weight.y / w.diffuse_albedo.y) - expected) < 1e-5);
    }
}

/* The usage in the comment that opens hdrp_brdf.h. */
static void the_usage_in_the_header_lights_a_pixel(void** state)
{
    hdrp_brdf_surface surface = hdrp_brdf_surface_default();
    hdrp_v3 v = hdrp_v3_make(0.0f, 0.6f, 0.8f), l = hdrp_v3_make(0.8f, 0.0f, 0.6f);
    float lux = 1000.0f;
    (void)state;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(surface);
    float n_dot_v = hdrp_v3_dot(d.normal, v);
    hdrp_brdf_fgd fgd = hdrp_brdf_fgd_fast(n_dot_v, d.perceptual_roughness);
    hdrp_brdf_lit_view w = hdrp_brdf_lit_view_make(d, v, fgd, d.features);
    hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, l, d.features);
    hdrp_v3 nits = hdrp_v3_scale(hdrp_v3_add(r.diffuse, r.specular), lux);
    /* About Lambert: 0.5 / pi times the cosine of the light. */
    assert_true(fabsf(nits.x - 0.5f * HDRP_INV_PI * 0.6f * lux) < 10.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_lobe_is_reciprocal),
        cmocka_unit_test(a_film_is_reciprocal_at_mirror_angles_only),
        cmocka_unit_test(an_absent_feature_changes_no_bit),
        cmocka_unit_test(no_anisotropy_is_isotropic_up_to_rounding),
        cmocka_unit_test(the_subsurface_feature_leaves_lighting_alone),
        cmocka_unit_test(environment_weights_are_the_integral_of_all_lights),
        cmocka_unit_test(occlusion_dims_the_environment_only),
        cmocka_unit_test(the_environment_is_asked_where_it_is_seen),
        cmocka_unit_test(extreme_directions_stay_finite),
        cmocka_unit_test(a_view_from_behind_is_bent_to_the_horizon),
        cmocka_unit_test(a_black_surface_is_black),
        cmocka_unit_test(light_below_the_horizon_needs_a_slab_or_a_wall),
        cmocka_unit_test(a_coat_on_its_own_material_hides_the_base_lobe),
        cmocka_unit_test(a_coat_reflects_what_its_fresnel_term_and_width_say),
        cmocka_unit_test(a_coat_dims_diffuse_light_by_its_mean_fresnel_term),
        cmocka_unit_test(the_usage_in_the_header_lights_a_pixel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
