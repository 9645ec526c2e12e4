/* test_brdf_lit_model.c - the Lit model is what it is written to be: layer upon layer, in double.
 * SPDX-License-Identifier: MIT
 *
 * The layers come from their definitions: microfacets by the slopes of their normals, a coat and a
 * slab by what they leave to the layer below, light that bounces again as a series. From the header
 * comes what is fitted to measurements or computed to a claim of its own: FGD and thin films. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#include "brdf_test.h"

#define SLAB  HDRP_BRDF_FEATURE_TRANSMISSION
#define GRAIN HDRP_BRDF_FEATURE_ANISOTROPY
#define FILM  HDRP_BRDF_FEATURE_IRIDESCENCE
#define COAT  HDRP_BRDF_FEATURE_CLEAR_COAT
#define WALL  HDRP_BRDF_FEATURE_REFRACTION

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalise(double a[3])
{
    double length = sqrt(dot(a, a));
    for (int i = 0; i < 3; ++i) {
        a[i] /= length;
    }
}

static void to_doubles(hdrp_v3 v, double out[3])
{
    out[0] = (double)v.x;
    out[1] = (double)v.y;
    out[2] = (double)v.z;
}

static double clamp01(double x)
{
    return fmin(fmax(x, 0.0), 1.0);
}

/* Rows are the tangent, the bitangent and the normal. */
typedef struct frame {
    double axis[3][3];
} frame;

/* Any frame about a normal. */
static frame frame_about(const double n[3])
{
    frame f;
    double other[3] = {fabs(n[0]) < 0.5, fabs(n[0]) >= 0.5, 0.0}, along = dot(other, n);
    for (int i = 0; i < 3; ++i) {
        f.axis[0][i] = other[i] - along * n[i];
        f.axis[2][i] = n[i];
    }
    normalise(f.axis[0]);
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        f.axis[1][i] = n[j] * f.axis[0][k] - n[k] * f.axis[0][j];
    }
    return f;
}

static void to_local(const frame* f, const double x[3], double out[3])
{
    for (int i = 0; i < 3; ++i) {
        out[i] = dot(f->axis[i], x);
    }
}

static double schlick(double f0, double f90, double u)
{
    return f0 + (f90 - f0) * pow(1.0 - clamp01(u), 5.0);
}

/* D V cos of two directions in a frame, 0 where one is below. */
static double lobe(const frame* f, const double v[3], const double l[3], double at, double ab,
                   double* l_dot_h)
{
    double a[3], b[3];
    to_local(f, v, a);
    to_local(f, l, b);
    *l_dot_h = sqrt(fmax(0.5 + 0.5 * dot(v, l), 0.0));
    return b[2] > 0.0 ? bq_specular(a, b, at, ab, l_dot_h) : 0.0;
}

/* Light that the first bounce loses to shadowing meets a facet at every further bounce, where the
 * mean of its Fresnel term is reflected; of that, some leaves and the rest meets another one. What
 * is not reflected enters. */
static void bounce(double again, double mean, double* reflected, double* entered)
{
    double left = 1.0;
    *reflected = 0.0;
    *entered = (1.0 - mean) * left;
    left *= mean;
    for (int i = 0; i < 4000; ++i) {
        *entered += (1.0 - mean) * left;
        left *= mean;
        *reflected += (1.0 - again) * left;
        left *= again;
    }
}

/* All that one pixel needs, in double. */
typedef struct model {
    hdrp_brdf_data d;
    hdrp_u32 features;
    frame base, coat;
    double v[3], at, ab, coat_alpha, mask;
    double f0[3], f90, outer_ior;
    hdrp_brdf_fgd_fit fit;
    double reflected[3], passed[3], mean_share[3];
    double slab[3], tint[3];
    hdrp_brdf_fgd seen;
} model;

static hdrp_brdf_fgd fgd_towards(const model* m, const double x[3])
{
    double a[3];
    to_local(&m->base, x, a);
    if (m->features & GRAIN) {
        hdrp_brdf_alphas alphas = {(float)m->at, (float)m->ab};
        hdrp_brdf_fgd_stretch s = hdrp_brdf_fgd_stretch_make(alphas);
        return hdrp_brdf_fgd_from_fit(
            hdrp_brdf_fgd_fit_towards(m->fit, s, (float)a[0], (float)a[1], (float)fabs(a[2])),
            (float)fabs(a[2]));
    }
    return hdrp_brdf_fgd_from_fit(m->fit, (float)fabs(a[2]));
}

/* Reflectance of film and base for light that came from air at a cosine: through a coat it bends. */
static double film(const model* m, double u, int channel)
{
    double inside = sqrt(1.0 - (1.0 - u * u) / (m->outer_ior * m->outer_ior));
    hdrp_v3 f = m->features & HDRP_BRDF_LIT_EXACT
                    ? hdrp_brdf_film_exact((float)inside, (float)m->outer_ior, m->d.film_ior,
                                           m->d.film_thickness_nm, m->d.fresnel0)
                    : hdrp_brdf_film((float)inside, (float)m->outer_ior, m->d.film_ior,
                                     m->d.film_thickness_nm, m->d.fresnel0);
    return bt_component(f, channel);
}

/* F0 against air, and against a coat of IOR 1.5 as far as there is one: both from the base's IOR. */
static double bare_f0(const model* m, int channel)
{
    double f0 = bt_component(m->d.fresnel0, channel), r = sqrt(f0);
    double ior = (1.0 + r) / (1.0 - r), under = (ior - 1.5) / (ior + 1.5);
    return f0 + (m->features & COAT ? m->mask * (under * under - f0) : 0.0);
}

/* Share of light that neither the first nor a later bounce reflects, over 1 - F0. */
static double share(const model* m, hdrp_brdf_fgd fgd, int channel)
{
    double first = (double)fgd.albedo, weight = (double)fgd.schlick;
    return first - m->f90 * weight + m->passed[channel] * (1.0 - first);
}

static double specular_albedo(const model* m, int channel)
{
    double first = (double)m->seen.albedo, weight = (double)m->seen.schlick;
    return m->f0[channel] * (first - weight) + m->f90 * weight +
           m->reflected[channel] * (1.0 - first);
}

static double front_albedo(const model* m, int channel)
{
    return m->tint[channel] * (1.0 - m->f0[channel]) * share(m, m->seen, channel);
}

static void set_fresnel(model* m)
{
    double u = dot(m->base.axis[2], m->v), largest = 0.0;
    m->mask = (double)m->d.coat_mask;
    m->outer_ior = m->features & COAT ? 1.0 + 0.5 * m->mask : 1.0;
    for (int c = 0; c < 3; ++c) {
        m->f0[c] = bare_f0(m, c);
        largest = fmax(largest, m->f0[c]);
    }
    m->f90 = fmin(largest / 0.02, 1.0);
    if (m->features & FILM) {
        /* The Schlick curve to 1 that goes through the film's reflectance, but for grazing views. */
        double k = (double)m->d.film_mask, at = fmax(u, 0.25), weight = pow(1.0 - at, 5.0);
        for (int c = 0; c < 3; ++c) {
            double through = clamp01((film(m, at, c) - weight) / (1.0 - weight));
            m->f0[c] = (1.0 - k) * m->f0[c] + k * through;
        }
        m->f90 = (1.0 - k) * m->f90 + k;
    }
}

static model make(hdrp_brdf_data d, hdrp_v3 v, hdrp_u32 features)
{
    model m = {.d = d, .features = features};
    double n[3],
        width = fmax((double)d.perceptual_roughness * (double)d.perceptual_roughness, 1e-4);
    double anisotropy = features & GRAIN ? (double)d.anisotropy : 0.0;
    to_doubles(d.tangent, m.base.axis[0]);
    to_doubles(d.bitangent, m.base.axis[1]);
    to_doubles(d.normal, m.base.axis[2]);
    to_doubles(d.coat_normal, n);
    m.coat = frame_about(n);
    to_doubles(v, m.v);
    m.at = width * (1.0 + anisotropy);
    m.ab = width * (1.0 - anisotropy);
    m.coat_alpha =
        fmax((double)d.coat_perceptual_roughness * (double)d.coat_perceptual_roughness, 1e-4);
    hdrp_brdf_alphas alphas = {(float)m.at, (float)m.ab};
    m.fit = features & GRAIN ? hdrp_brdf_fgd_fit_make_aniso(alphas)
                             : hdrp_brdf_fgd_fit_make(d.perceptual_roughness);
    set_fresnel(&m);
    m.seen = fgd_towards(&m, m.v);
    for (int c = 0; c < 3; ++c) {
        double loss = (double)m.fit.mean_loss, entered, mean = 0.0;
        /* The mean over cosines of 1 - (1 - F0) (1 - F90 (1 - u)^5), weighted by 2 u. */
        for (int i = 0; i < 64; ++i) {
            double u = (i + 0.5) / 64.0;
            mean += 2.0 * u * pow(1.0 - u, 5.0) / 64.0;
        }
        mean = 1.0 - (1.0 - m.f0[c]) * (1.0 - m.f90 * mean);
        bounce(2.0 / 3.0 * loss, mean, &m.reflected[c], &entered);
        m.passed[c] = entered / (1.0 - m.f0[c]);
        m.mean_share[c] = 1.0 - loss - m.f90 * (double)m.fit.mean_schlick + m.passed[c] * loss;
        m.slab[c] = features & SLAB && d.features & SLAB ? bt_component(d.transmittance, c) : 0.0;
        /* What crosses a slab, what a wall refracts: missing in front. */
        m.tint[c] = bt_component(d.diffuse_color, c);
        m.tint[c] /= 1.0 + m.tint[c] * m.slab[c];
        m.tint[c] *= features & WALL ? 1.0 - (double)d.transmission : 1.0;
    }
    return m;
}

/* What a coat leaves of light that crosses it at a cosine. */
static double below_coat(const model* m, const double x[3])
{
    return 1.0 - m->mask * schlick(0.04, 1.0, fabs(dot(m->coat.axis[2], x)));
}

/* Light refracted through a wall: the reflected lobe, mirrored, of what is not reflected. */
static double refracted(const model* m, const double l[3], int channel)
{
    double p = (double)m->d.perceptual_roughness * clamp01(2.0 * ((double)m->d.ior - 1.0));
    double alpha = fmax(p * p, 1e-4), mirrored[3], u, cosine = dot(m->base.axis[2], l);
    for (int i = 0; i < 3; ++i) {
        mirrored[i] = l[i] - 2.0 * cosine * m->base.axis[2][i];
    }
    double dv = lobe(&m->base, m->v, mirrored, alpha, alpha, &u);
    return bt_component(m->d.diffuse_color, channel) * bt_component(m->d.transmittance, channel) *
           (double)m->d.transmission * (1.0 - schlick(m->f0[channel], m->f90, u)) * dv;
}

typedef struct parts {
    double diffuse, specular;
} parts;

static parts evaluate(const model* m, const double l[3], int c)
{
    parts r;
    double cosine = dot(m->base.axis[2], l), front = fmax(cosine, 0.0), u;
    double dv = lobe(&m->base, m->v, l, m->at, m->ab, &u);
    hdrp_brdf_fgd fgd = fgd_towards(m, l);
    double f = schlick(m->f0[c], m->f90, u), mask = (double)m->d.film_mask;
    if (m->features & HDRP_BRDF_LIT_EXACT && m->features & FILM) {
        double bare = fmin(fmax(fmax(bare_f0(m, 0), bare_f0(m, 1)), bare_f0(m, 2)) / 0.02, 1.0);
        f = (1.0 - mask) * schlick(bare_f0(m, c), bare, u) + mask * film(m, u, c);
    }
    r.specular = f * dv + m->reflected[c] * (1.0 - (double)m->seen.albedo) *
                              (1.0 - (double)fgd.albedo) / (BQ_PI * (double)m->fit.mean_loss) *
                              front;
    r.diffuse = front_albedo(m, c) * share(m, fgd, c) / (BQ_PI * m->mean_share[c]);
    r.diffuse *= front + m->slab[c] * fmax(-cosine, 0.0);
    r.specular += m->features & WALL ? refracted(m, l, c) : 0.0;
    if (m->features & COAT) {
        double both = below_coat(m, m->v) * below_coat(m, l);
        r.diffuse *= both;
        dv = lobe(&m->coat, m->v, l, m->coat_alpha, m->coat_alpha, &u);
        r.specular = both * r.specular + m->mask * schlick(0.04, 1.0, u) * dv;
    }
    return r;
}

/* A material of all the features named, no lobe narrow, F0 of all channels but under a film that of
 * a real surface. */
static hdrp_brdf_data random_material(uint64_t* seed, hdrp_u32 features)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    double n = 2.0 * bt_random(seed) - 1.0;
    s.features = features & HDRP_BRDF_FEATURE_ALL;
    s.base_color = hdrp_v3_make(0.2f + 0.7f * bt_random_f(seed), 0.6f, bt_random_f(seed));
    s.metallic = bt_random(seed) < 0.3 ? 0.0f : 0.9f * bt_random_f(seed);
    s.dielectric_fresnel0 =
        hdrp_v3_splat(bt_random(seed) < 0.5 ? 0.04f : 0.005f + 0.1f * bt_random_f(seed));
    s.perceptual_roughness = 0.3f + 0.7f * bt_random_f(seed);
    s.normal = bt_direction(n, 6.2832 * bt_random(seed));
    s.tangent = bt_direction(2.0 * bt_random(seed) - 1.0, 6.2832 * bt_random(seed));
    s.ambient_occlusion = bt_random_f(seed);
    s.specular_occlusion = bt_random_f(seed);
    s.anisotropy = 1.6f * bt_random_f(seed) - 0.8f;
    s.coat_mask = bt_random(seed) < 0.3 ? 1.0f : bt_random_f(seed);
    s.coat_perceptual_roughness = 0.3f + 0.7f * bt_random_f(seed);
    s.coat_normal = hdrp_v3_mad(s.normal, s.tangent, 0.2f * bt_random_f(seed));
    s.film_mask = bt_random_f(seed);
    s.film_ior = 1.2f + bt_random_f(seed);
    s.film_thickness_nm = 800.0f * bt_random_f(seed);
    s.transmittance = hdrp_v3_make(bt_random_f(seed), 0.9f, 0.3f);
    s.transmission = bt_random_f(seed);
    s.ior = bt_random(seed) < 0.5 ? 1.3f : 1.0f + 0.8f * bt_random_f(seed);
    return hdrp_brdf_data_from_surface(s);
}

/* A view that base and coat both face by a good margin. */
static hdrp_v3 random_view(uint64_t* seed, hdrp_brdf_data d)
{
    hdrp_v3 v = d.normal;
    do {
        v = bt_direction(2.0 * bt_random(seed) - 1.0, 6.2832 * bt_random(seed));
    } while (hdrp_v3_dot(v, d.normal) < 0.1f || hdrp_v3_dot(v, d.coat_normal) < 0.1f);
    return v;
}

static void expect_near(double measured, double expected, double tolerance, const char* what,
                        hdrp_u32 features)
{
    if (!(fabs(measured - expected) <= tolerance)) {
        fail_msg("%s: %.9g for %.9g, features %u", what, measured, expected, features);
    }
}

static const hdrp_u32 sets[] = {0u,
                                GRAIN,
                                COAT,
                                SLAB,
                                WALL,
                                FILM,
                                FILM | COAT,
                                COAT | SLAB | WALL,
                                GRAIN | COAT,
                                FILM | HDRP_BRDF_LIT_EXACT,
                                FILM | COAT | HDRP_BRDF_LIT_EXACT};
#define SETS 11

static void every_light_is_shaded_by_the_layers_that_it_meets(void** state)
{
    uint64_t seed = 1;
    (void)state;
    for (int i = 0; i < 1000 * SETS; ++i) {
        hdrp_u32 f = sets[i % SETS];
        hdrp_brdf_data d = random_material(&seed, f);
        hdrp_v3 v = random_view(&seed, d);
        /* Half of the lights where the lobe is. */
        hdrp_v3 l = bt_direction(2.0 * bt_random(&seed) - 1.0, 6.2832 * bt_random(&seed));
        hdrp_v3 mirror = hdrp_v3_mad(hdrp_v3_neg(v), d.normal, 2.0f * hdrp_v3_dot(d.normal, v));
        l = hdrp_v3_normalize(hdrp_v3_mad(l, mirror, i / SETS % 2 ? 2.0f : 0.0f));
        hdrp_brdf_lit_view w = bt_view(d, v, f);
        hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, l, f);
        model m = make(d, v, f);
        double light[3];
        to_doubles(l, light);
        /* Without a wall or a slab it is black behind, and the half vector is at the horizon. */
        if (fabs(dot(light, m.base.axis[2])) < 0.02) {
            continue;
        }
        for (int c = 0; c < 3; ++c) {
            parts p = evaluate(&m, light, c);
            /* An exact film's diffuse lobe is another: below. */
            if (!(f & HDRP_BRDF_LIT_EXACT)) {
                expect_near(bt_component(r.diffuse, c), p.diffuse, 1e-4 * p.diffuse, "diffuse", f);
            }
            expect_near(bt_component(r.specular, c), p.specular, 2e-4 * p.specular + 1e-6,
                        "specular", f);
        }
    }
}

static hdrp_v3 to_v3(const double x[3])
{
    return hdrp_v3_make((float)x[0], (float)x[1], (float)x[2]);
}

static void expect_direction(hdrp_v3 measured, const double expected[3], const char* what,
                             hdrp_u32 features)
{
    double m[3];
    to_doubles(measured, m);
    for (int i = 0; i < 3; ++i) {
        expect_near(m[i], expected[i], 3e-6, what, features);
    }
}

static void mirror(const double v[3], const double n[3], double out[3])
{
    double cosine = dot(v, n);
    for (int i = 0; i < 3; ++i) {
        out[i] = 2.0 * cosine * n[i] - v[i];
    }
}

/* Without a volume light goes on as it came; into one it bends, towards -n by Snell's law. */
static void transmitted_direction(const model* m, double out[3])
{
    double along[3], sine, eta = 1.0 / (double)m->d.ior;
    const double* n = m->base.axis[2];
    double cosine = dot(m->v, n);
    if (m->d.volume_thickness_m == 0.0f) {
        eta = 1.0;
    }
    for (int i = 0; i < 3; ++i) {
        along[i] = m->v[i] - cosine * n[i];
    }
    sine = eta * sqrt(dot(along, along));
    for (int i = 0; i < 3; ++i) {
        out[i] = -eta * along[i] - sqrt(1.0 - sine * sine) * n[i];
    }
}

/* What the base sends back of a white environment, all its bounces, and what is left of it. */
static void compare_base_weights(const model* m, hdrp_brdf_lit_env e)
{
    double coat_in = 1.0, coat_mean = 1.0, coat_out = 1.0;
    double dim = (double)m->d.specular_occlusion, open = (double)m->d.ambient_occlusion;
    hdrp_brdf_fgd wall = hdrp_brdf_fgd_fast(
        hdrp_v3_dot(m->d.normal, to_v3(m->v)),
        (float)((double)m->d.perceptual_roughness * clamp01(2.0 * (double)m->d.ior - 2.0)));
    if (m->features & COAT) {
        coat_out = below_coat(m, m->v);
        /* By the angles at which light meets the microfacets, and by all angles. */
        coat_in =
            1.0 -
            m->mask * schlick(0.04, 1.0,
                              1.0 - pow((double)m->seen.schlick / (double)m->seen.albedo, 0.2));
        coat_mean = 1.0 - m->mask * (0.04 + 0.96 / 21.0);
    }
    for (int c = 0; c < 3; ++c) {
        double specular = specular_albedo(m, c);
        double diffuse = fmin(front_albedo(m, c), m->tint[c] * (1.0 - specular));
        double through = bt_component(m->d.diffuse_color, c) * bt_component(m->d.transmittance, c) *
                         (double)m->d.transmission;
        double first = (double)wall.albedo, weight = (double)wall.schlick;
        double passed = first - (m->f0[c] * (first - weight) + m->f90 * weight);
        through *= m->features & WALL ? fmin(passed, 1.0 - specular) : 0.0;
        diffuse *= coat_out * coat_mean;
        expect_near(bt_component(e.specular_weight, c), specular * coat_in * coat_out * dim, 1e-5,
                    "specular weight", m->features);
        expect_near(bt_component(e.diffuse_weight, c), diffuse * open, 1e-5, "diffuse weight",
                    m->features);
        expect_near(bt_component(e.through_weight, c), diffuse * m->slab[c], 1e-5, "through weight",
                    m->features);
        expect_near(bt_component(e.transmitted_weight, c), through * coat_in * coat_out, 1e-5,
                    "transmitted weight", m->features);
    }
}

static void the_environment_is_weighted_by_what_each_layer_reflects(void** state)
{
    uint64_t seed = 2;
    (void)state;
    for (int i = 0; i < 500 * SETS; ++i) {
        hdrp_u32 f = sets[i % SETS] & ~HDRP_BRDF_LIT_EXACT;
        hdrp_brdf_data d = random_material(&seed, f);
        d.volume_thickness_m = i / SETS % 2 ? 1.0f : 0.0f;
        hdrp_v3 v = random_view(&seed, d);
        model m = make(d, v, f);
        hdrp_brdf_lit_env e = hdrp_brdf_lit_env_make(d, bt_view(d, v, f), f);
        double x[3];
        compare_base_weights(&m, e);
        if (f & WALL) {
            transmitted_direction(&m, x);
            expect_direction(e.transmitted_direction, x, "transmitted direction", f);
        }
        if (f & COAT) {
            float c = hdrp_v3_dot(d.coat_normal, v);
            hdrp_brdf_fgd fgd = hdrp_brdf_fgd_fast(c, d.coat_perceptual_roughness);
            double first = (double)fgd.albedo, weight = (double)fgd.schlick;
            mirror(m.v, m.coat.axis[2], x);
            expect_direction(e.coat_direction, x, "coat direction", f);
            expect_near((double)e.coat_weight,
                        m.mask * (0.04 * (first - weight) + weight) * (double)d.specular_occlusion,
                        1e-6, "coat weight", f);
        }
    }
}

/* Light from all facets of a smooth film is reflected by one angle. */
static void an_exact_film_leaves_the_diffuse_lobe_what_it_does_not_reflect(void** state)
{
    const hdrp_u32 f = FILM | HDRP_BRDF_LIT_EXACT;
    uint64_t seed = 3;
    (void)state;
    for (int i = 0; i < 200; ++i) {
        hdrp_brdf_data d = random_material(&seed, f);
        d.perceptual_roughness = 0.02f;
        d.film_mask = 1.0f;
        hdrp_v3 v = random_view(&seed, d);
        hdrp_brdf_lit_view w = bt_view(d, v, f);
        model m = make(d, v, f);
        for (int c = 0; c < 3; ++c) {
            double reflected = film(&m, dot(m.v, m.base.axis[2]), c);
            double left = bt_component(d.diffuse_color, c) * (1.0 - reflected);
            expect_near(bt_component(w.specular_albedo, c), reflected, 2e-4, "film", f);
            expect_near(bt_component(w.diffuse_albedo, c), left, 2e-4, "below it", f);
            expect_near(bt_component(w.diffuse, c) * BQ_PI * m.mean_share[c], left, 2e-4,
                        "the lobe below it", f);
        }
    }
}

/* A table may say that the specular lobe reflects more than the fit does. */
static void nothing_is_left_below_a_lobe_that_reflects_all(void** state)
{
    const hdrp_brdf_fgd all = {1.0f, 1.0f};
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(bt_surface(1.0f, 0.0f, 0.04f, 0.6f));
    hdrp_brdf_lit_view w = hdrp_brdf_lit_view_make(d, d.normal, all, 0u);
    (void)state;
    for (int c = 0; c < 3; ++c) {
        assert_true(bt_component(w.specular_albedo, c) == 1.0);
        assert_true(bt_component(w.diffuse_albedo, c) == 0.0);
    }
}

/* Density of mirror directions about the visible normals of a lobe. */
static double density(const frame* f, const double v[3], const double l[3], double at, double ab)
{
    double a[3], b[3], h[3];
    to_local(f, v, a);
    to_local(f, l, b);
    for (int i = 0; i < 3; ++i) {
        h[i] = a[i] + b[i];
    }
    normalise(h);
    double g = sqrt(at * at * a[0] * a[0] + ab * ab * a[1] * a[1] + a[2] * a[2]);
    return h[2] > 0.0 ? 0.5 * bq_d(h, at, ab) / (a[2] + g) : 0.0;
}

static double largest(const model* m, double (*albedo)(const model*, int))
{
    return fmax(fmax(albedo(m, 0), albedo(m, 1)), albedo(m, 2));
}

/* Light that bounces between microfacets before it leaves: as diffuse as the diffuse lobe. */
static double bounced(const model* m, int channel)
{
    return m->reflected[channel] * (1.0 - (double)m->seen.albedo);
}

static double diffuse_left(const model* m, int channel)
{
    return fmin(front_albedo(m, channel), m->tint[channel] * (1.0 - specular_albedo(m, channel)));
}

static double refracted_most(const model* m, int channel)
{
    return bt_component(m->d.diffuse_color, channel) * bt_component(m->d.transmittance, channel) *
           (double)m->d.transmission;
}

static double largest_f0(const model* m, int channel)
{
    return m->f0[channel];
}

static double largest_slab(const model* m, int channel)
{
    return m->slab[channel];
}

/* Each lobe is drawn in proportion to what it reflects of a white environment. */
static void lobes_are_drawn_in_proportion_to_their_light(void** state)
{
    uint64_t seed = 4;
    (void)state;
    for (int i = 0; i < 500 * SETS; ++i) {
        hdrp_u32 f = sets[i % SETS] & ~HDRP_BRDF_LIT_EXACT;
        hdrp_brdf_data d = random_material(&seed, f);
        hdrp_v3 v = random_view(&seed, d);
        hdrp_v3 l = bt_direction(2.0 * bt_random(&seed) - 1.0, 6.2832 * bt_random(&seed));
        model m = make(d, v, f);
        double light[3], mirrored[3], p = (double)d.perceptual_roughness;
        to_doubles(l, light);
        double cosine = dot(m.base.axis[2], light);
        double below = f & COAT ? below_coat(&m, m.v) : 1.0;
        double again = largest(&m, bounced), diffuse = largest(&m, diffuse_left);
        double specular = fmax(below * (largest(&m, specular_albedo) - again), 1e-3);
        double through = below * diffuse * largest(&m, largest_slab), wall = 0.0;
        if (f & WALL) {
            /* A grazing view lets facets of a rough wall refract at other angles. */
            double let_in = 1.0 - schlick(largest(&m, largest_f0), m.f90, dot(m.base.axis[2], m.v));
            wall = below * largest(&m, refracted_most) * fmax(let_in, 0.25);
        }
        diffuse = below * (diffuse + again);
        double sum = specular + diffuse + through + wall + (1.0 - below);
        double expected = specular * density(&m.base, m.v, light, m.at, m.ab);
        expected += (cosine > 0.0 ? diffuse : through) * fabs(cosine) / BQ_PI;
        expected += (1.0 - below) * density(&m.coat, m.v, light, m.coat_alpha, m.coat_alpha);
        if (f & WALL) {
            mirror(light, m.base.axis[2], mirrored);
            for (int k = 0; k < 3; ++k) {
                mirrored[k] = -mirrored[k];
            }
            p *= clamp01(2.0 * (double)d.ior - 2.0);
            expected +=
                wall * density(&m.base, m.v, mirrored, fmax(p * p, 1e-4), fmax(p * p, 1e-4));
        }
        expected /= sum;
        double measured = (double)hdrp_brdf_lit_pdf(d, bt_view(d, v, f), l, f);
        expect_near(measured, expected, 1e-4 * expected + 1e-6, "density", f);
    }
}

static void a_smooth_wall_is_drawn_straight_through(void** state)
{
    hdrp_brdf_surface s = bt_surface(1.0f, 0.0f, 0.0f, 0.0f);
    s.features = WALL;
    s.transmission = 1.0f;
    s.transmittance = hdrp_v3_splat(1.0f);
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    (void)state;
    for (double c = 0.1; c <= 1.0; c += 0.1) {
        hdrp_v3 v = bt_direction(c, 2.0);
        double ahead[3];
        to_doubles(hdrp_v3_neg(v), ahead);
        hdrp_v3 l =
            hdrp_brdf_lit_sample(d, bt_view(d, v, WALL), hdrp_v3_make(0.5f, 0.5f, 0.5f), WALL);
        double measured[3];
        to_doubles(l, measured);
        for (int i = 0; i < 3; ++i) {
            expect_near(measured[i], ahead[i], 3e-4, "straight", WALL);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_light_is_shaded_by_the_layers_that_it_meets),
        cmocka_unit_test(the_environment_is_weighted_by_what_each_layer_reflects),
        cmocka_unit_test(an_exact_film_leaves_the_diffuse_lobe_what_it_does_not_reflect),
        cmocka_unit_test(nothing_is_left_below_a_lobe_that_reflects_all),
        cmocka_unit_test(lobes_are_drawn_in_proportion_to_their_light),
        cmocka_unit_test(a_smooth_wall_is_drawn_straight_through),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
