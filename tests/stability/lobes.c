/* lobes.c - normalisation, bounds, reciprocity and energy of every lobe: lobes
 * SPDX-License-Identifier: MIT
 *
 * Quadrature in double around the float formulas, over roughness x angle x anisotropy. Prints a CSV
 * line per lobe and check, with the worst place, and fails where a bound is broken:
 *
 *     lobe,check,worst,bound,at */
#include <stdbool.h>
#include <stdio.h>

#define HDRP_BRDF_IMPLEMENTATION
#include "../unit/brdf_test.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

static bq_point points[BQ_MAX_POINTS];
static int failures;

static const float roughnesses[] = {0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.75f, 1.0f};
static const double cosines[] = {0.02, 0.05, 0.15, 0.4, 0.7, 0.95, 1.0};
static const float anisotropies[] = {-0.9f, -0.5f, 0.0f, 0.5f, 0.9f};

/* The largest value of a check so far, and where it was. */
typedef struct worst {
    double value;
    float roughness, anisotropy;
    double n_dot_v;
} worst;

static const worst none = {-HUGE_VAL, 0.0f, 0.0f, 0.0};

static worst larger(worst w, double value, float roughness, float anisotropy, double n_dot_v)
{
    worst r = {value, roughness, anisotropy, n_dot_v};
    return value <= w.value ? w : r; /* NaN is kept */
}

static void report(const char* lobe, const char* check, worst w, double bound)
{
    bool good = w.value <= bound;
    printf("%s,%s,%.3g,%.3g,roughness %.3g; anisotropy %.2g; n.v %.3g\n", lobe, check, w.value,
           bound, (double)w.roughness, (double)w.anisotropy, w.n_dot_v);
    if (!good) {
        fprintf(stderr, "lobes: %s: %s is %.4g, more than %.4g\n", lobe, check, w.value, bound);
        failures++;
    }
}

static void polar(double cosine, double azimuth, double v[3])
{
    double s = sqrt((1.0 - cosine) * (1.0 + cosine));
    v[0] = s * cos(azimuth);
    v[1] = s * sin(azimuth);
    v[2] = cosine;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* >>normalisation */

/* Half vectors for which D n.h is equally likely in every cell: slopes (x / at, y / ab) of radius
 * sqrt(u / (1 - u)). What is left in density is what the formula gets wrong. */
typedef struct slope_node {
    double h[3], solid_angle;
} slope_node;

#define U_NODES    96
#define TURN_NODES 96

static slope_node slope_at(const bq_rule* r, int i, int j, double at, double ab)
{
    double u = r->x[i], phi = 2.0 * BQ_PI * (j + 0.5) / TURN_NODES, s = sqrt(u / (1.0 - u));
    double x = -at * s * cos(phi), y = -ab * s * sin(phi);
    double length = sqrt(1.0 + x * x + y * y);
    slope_node n = {{-x / length, -y / length, 1.0 / length}, 0.0};
    /* Slopes cover at ab / (2 (1 - u)^2) du dphi, directions cos^3 of that. */
    n.solid_angle = r->w[i] * (2.0 * BQ_PI / TURN_NODES) * 0.5 * at * ab / ((1.0 - u) * (1.0 - u)) /
                    (length * length * length);
    return n;
}

typedef double (*distribution)(hdrp_v3 h, float at, float ab);

static double from_cosine(hdrp_v3 h, float at, float ab)
{
    (void)ab;
    return (double)hdrp_brdf_d_ggx(fminf(h.z, 1.0f), at);
}

static double from_vectors(hdrp_v3 h, float at, float ab)
{
    (void)ab;
    return (double)hdrp_brdf_d_ggx_vectors(hdrp_v3_make(0.0f, 0.0f, 1.0f), h, at);
}

static double aniso_local(hdrp_v3 h, float at, float ab)
{
    return (double)hdrp_brdf_d_ggx_aniso(h.x, h.y, fminf(h.z, 1.0f), at, ab);
}

static double aniso_vectors(hdrp_v3 h, float at, float ab)
{
    return (double)hdrp_brdf_d_ggx_aniso_vectors(hdrp_v3_make(1.0f, 0.0f, 0.0f),
                                                 hdrp_v3_make(0.0f, 1.0f, 0.0f),
                                                 hdrp_v3_make(0.0f, 0.0f, 1.0f), h, at, ab);
}

static void normalisation(const char* name, distribution d, bool aniso, float least, double bound)
{
    bq_rule rule = bq_make(U_NODES, 1);
    worst w = none;
    for (int k = 0; k < COUNT(roughnesses) * COUNT(anisotropies); ++k) {
        float roughness = roughnesses[k / COUNT(anisotropies)];
        float anisotropy = anisotropies[k % COUNT(anisotropies)];
        hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(roughness, anisotropy);
        double sum = 0.0;
        if (roughness < least || (!aniso && anisotropy != 0.0f)) {
            continue;
        }
        for (int i = 0; i < U_NODES; ++i) {
            for (int j = 0; j < TURN_NODES; ++j) {
                slope_node n = slope_at(&rule, i, j, (double)a.t, (double)a.b);
                sum += d(bt_v3(n.h), a.t, a.b) * n.h[2] * n.solid_angle;
            }
        }
        w = larger(w, fabs(sum - 1.0), roughness, anisotropy, 0.0);
    }
    report(name, "normalisation of D n.h", w, bound);
}

/* The density of visible normals over the sphere of reflected directions. */
static void visible_normals(void)
{
    bq_rule rule = bq_make(U_NODES, 1);
    worst w = none;
    for (int k = 0; k < COUNT(roughnesses) * COUNT(anisotropies) * COUNT(cosines); ++k) {
        float roughness = roughnesses[k % COUNT(roughnesses)];
        float anisotropy = anisotropies[k / COUNT(roughnesses) % COUNT(anisotropies)];
        hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(roughness, anisotropy);
        double v[3], sum = 0.0, c = cosines[k / COUNT(roughnesses) / COUNT(anisotropies)];
        polar(c, 0.5, v);
        for (int i = 0; i < U_NODES; ++i) {
            for (int j = 0; j < TURN_NODES; ++j) {
                slope_node n = slope_at(&rule, i, j, (double)a.t, (double)a.b);
                double v_dot_h = dot(v, n.h);
                double p = v_dot_h > 0.0
                               ? (double)hdrp_brdf_pdf_vndf(bt_v3(v), bt_v3(n.h), a.t, a.b)
                               : 0.0;
                sum += p * 4.0 * v_dot_h * n.solid_angle;
            }
        }
        w = larger(w, fabs(sum - 1.0), roughness, anisotropy, c);
    }
    report("visible normals", "normalisation of the density", w, 0.01);
}

/* Masking and shadowing, V 4 n.l n.v, between 0 and 1, and the smaller the more grazing. */
static void visibility_bounds(void)
{
    worst most = none, fast = none, stretched = none;
    for (int k = 0; k < COUNT(roughnesses) * 4000; ++k) {
        float roughness = roughnesses[k % COUNT(roughnesses)];
        float alpha = hdrp_brdf_alpha_from_perceptual_roughness(roughness);
        float nl = hdrp_hammersley((hdrp_u32)k, 4000u * COUNT(roughnesses)).y;
        float nv = hdrp_r2((hdrp_u32)k).x;
        double both = 4.0 * (double)nl * (double)nv;
        hdrp_v3 l = bt_direction((double)nl, 1.0), v = bt_direction((double)nv, 3.0);
        hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(roughness, 0.9f);
        if (nl < 1e-4f || nv < 1e-4f) {
            continue;
        }
        most = larger(most, both * (double)hdrp_brdf_v_smith_ggx(nl, nv, alpha) - 1.0, roughness,
                      0.0f, (double)nv);
        fast = larger(fast, both * (double)hdrp_brdf_v_smith_ggx_fast(nl, nv, alpha) - 1.0,
                      roughness, 0.0f, (double)nv);
        stretched = larger(
            stretched,
            both * (double)hdrp_brdf_v_smith_ggx_aniso(l.x, l.y, l.z, v.x, v.y, v.z, a.t, a.b) -
                1.0,
            roughness, 0.9f, (double)nv);
    }
    report("GGX", "shadowing above 1", most, 1e-6);
    report("GGX fast", "shadowing above 1", fast, 1e-6);
    report("GGX anisotropic", "shadowing above 1", stretched, 1e-6);
}

/* >>reciprocity: a BRDF, without its cosine, for directions above the horizon */

typedef double (*brdf)(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features);

static const hdrp_v3* up(void)
{
    static const hdrp_v3 z = {0.0f, 0.0f, 1.0f};
    return &z;
}

static double ggx(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features)
{
    float alpha = hdrp_brdf_alpha_from_perceptual_roughness(roughness);
    hdrp_v3 h = hdrp_brdf_half_vector(l, v, *up());
    (void)anisotropy;
    (void)features;
    return (double)(hdrp_brdf_d_ggx_vectors(*up(), h, alpha) *
                    hdrp_brdf_v_smith_ggx(l.z, v.z, alpha) *
                    hdrp_brdf_f_schlick(0.04f, 1.0f, hdrp_saturate(hdrp_v3_dot(l, h))));
}

static double ggx_aniso(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features)
{
    hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(roughness, anisotropy);
    hdrp_v3 h = hdrp_brdf_half_vector(l, v, *up());
    (void)features;
    return aniso_vectors(h, a.t, a.b) *
           (double)hdrp_brdf_v_smith_ggx_aniso(l.x, l.y, l.z, v.x, v.y, v.z, a.t, a.b);
}

static double multiscatter(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy,
                           hdrp_u32 features)
{
    (void)anisotropy;
    (void)features;
    return (double)hdrp_brdf_multiscatter(hdrp_brdf_fgd_fit_make(roughness), v.z, l.z,
                                          hdrp_v3_splat(1.0f), 1.0f)
        .x;
}

static double burley(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features)
{
    (void)anisotropy;
    (void)features;
    return (double)hdrp_brdf_diffuse_disney(v.z, l.z, hdrp_v3_dot(l, v), roughness);
}

static double burley_normalized(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy,
                                hdrp_u32 features)
{
    (void)anisotropy;
    (void)features;
    return (double)hdrp_brdf_diffuse_disney_normalized(v.z, l.z, hdrp_v3_dot(l, v), roughness);
}

static double diffuse(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features)
{
    (void)anisotropy;
    (void)features;
    return (double)hdrp_brdf_diffuse(hdrp_brdf_fgd_fit_make(roughness), v.z, l.z,
                                     hdrp_v3_splat(0.04f), 1.0f)
        .x;
}

/* Transmission: l is below, given as its mirror image. Seen from there, the normal turns round. */
static double thin_wall(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features)
{
    float alpha = hdrp_brdf_alpha_from_perceptual_roughness(roughness);
    hdrp_v3 below = hdrp_v3_make(l.x, l.y, -l.z);
    (void)anisotropy;
    (void)features;
    return (double)hdrp_brdf_btdf_thin_ggx(*up(), v, below, alpha, hdrp_v3_splat(0.04f), 1.0f).x /
           (double)l.z;
}

/* features 1 swaps the media with the directions. The formula is of radiance over ior^2, which
 * fills solid angles that are ior^2 times as large: over the ratio of the iors it is reciprocal. */
static double volume(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features)
{
    float alpha = hdrp_brdf_alpha_from_perceptual_roughness(roughness);
    hdrp_v3 below = hdrp_v3_make(l.x, l.y, -l.z);
    float eta = features ? 1.0f / 1.5f : 1.5f;
    (void)anisotropy;
    return (double)hdrp_brdf_btdf_ggx(*up(), v, below, alpha, eta) / (double)(l.z * eta);
}

/* Beside the features of a material: the coat is as rough as the base, otherwise 0.1. */
#define ROUGH_COAT 0x10000u

/* A white material with everything that the features turn on. */
static hdrp_brdf_data white(float roughness, float anisotropy, float metallic, hdrp_u32 features)
{
    hdrp_brdf_surface s = bt_surface(1.0f, metallic, 0.04f, roughness);
    s.features = features;
    s.anisotropy = anisotropy;
    s.coat_mask = 1.0f;
    s.coat_perceptual_roughness = features & ROUGH_COAT ? roughness : 0.1f;
    s.film_mask = 1.0f;
    s.film_thickness_nm = 500.0f;
    s.transmittance = hdrp_v3_splat(1.0f);
    s.transmission = 0.5f;
    return hdrp_brdf_data_from_surface(s);
}

static double lit(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features)
{
    hdrp_brdf_data d = white(roughness, anisotropy, 0.0f, features);
    return bt_lit_sum(hdrp_brdf_lit_eval(d, bt_view(d, v, features), l, features), 1) / (double)l.z;
}

static void reciprocity(const char* name, brdf f, hdrp_u32 features, bool aniso, double bound)
{
    uint64_t seed = 1;
    worst w = none;
    for (int k = 0; k < 20000; ++k) {
        float roughness = roughnesses[k % COUNT(roughnesses)];
        float anisotropy = aniso ? anisotropies[k / COUNT(roughnesses) % COUNT(anisotropies)] : 0;
        hdrp_v3 v = bt_direction(0.02 + 0.98 * bt_random(&seed), 2.0 * BQ_PI * bt_random(&seed));
        hdrp_v3 l = bt_direction(0.02 + 0.98 * bt_random(&seed), 2.0 * BQ_PI * bt_random(&seed));
        if (k % 2) { /* near the mirror direction, where lobes are large */
            double turn = BQ_PI + 0.2 * (bt_random(&seed) - 0.5);
            l = bt_direction(fmin(fmax((double)v.z + 0.1 * (bt_random(&seed) - 0.5), 0.02), 1.0),
                             atan2((double)v.y, (double)v.x) + turn);
        }
        if (roughness < 0.2f) {
            continue; /* rounding turns the half vectors of narrower lobes */
        }
        hdrp_u32 back = f == volume ? 1u : features;
        double there = f(l, v, roughness, anisotropy, features);
        double again = f(v, l, roughness, anisotropy, back);
        double error = fabs(there - again) / fmax(fmax(there, again), 1e-2);
        w = larger(w, error, roughness, anisotropy, (double)v.z);
    }
    report(name, "reciprocity", w, bound);
}

/* >>energy */

/* Albedo above 1 and below 1 of an isotropic lobe, towards the viewer. */
static void albedo(const char* name, brdf f, brdf added, double above, double below)
{
    bq_rule rule = bq_make(24, 12);
    worst most = none, least = none;
    for (int k = 0; k < COUNT(roughnesses) * COUNT(cosines); ++k) {
        float roughness = roughnesses[k % COUNT(roughnesses)];
        double v[3], sum = 0.0, c = cosines[k / COUNT(roughnesses)];
        polar(c, 0.0, v);
        int count = bq_points(&rule, acos(c), 0.0, bt_alpha(roughness), points);
        for (int i = 0; i < count; ++i) {
            hdrp_v3 l = bt_v3(points[i].l);
            double value = f(l, bt_v3(v), roughness, 0.0f, 0u);
            value += added ? added(l, bt_v3(v), roughness, 0.0f, 0u) : 0.0;
            sum += points[i].weight * points[i].l[2] * value;
        }
        most = larger(most, sum - 1.0, roughness, 0.0f, c);
        least = larger(least, 1.0 - sum, roughness, 0.0f, c);
    }
    report(name, "albedo above 1", most, above);
    report(name, "albedo below 1", least, below);
}

static double mirror(hdrp_v3 l, hdrp_v3 v, float roughness, float anisotropy, hdrp_u32 features)
{
    float alpha = hdrp_brdf_alpha_from_perceptual_roughness(roughness);
    (void)anisotropy;
    (void)features;
    return (double)(hdrp_brdf_d_ggx_vectors(*up(), hdrp_brdf_half_vector(l, v, *up()), alpha) *
                    hdrp_brdf_v_smith_ggx(l.z, v.z, alpha));
}

static void albedo_aniso(void)
{
    worst most = none, least = none;
    for (int k = 0; k < COUNT(roughnesses) * COUNT(anisotropies) * COUNT(cosines); ++k) {
        float roughness = roughnesses[k % COUNT(roughnesses)];
        float anisotropy = anisotropies[k / COUNT(roughnesses) % COUNT(anisotropies)];
        hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(roughness, anisotropy);
        bt_lobe lobe = {(double)a.t, (double)a.b, 0};
        double v[3], sum = 0.0, c = cosines[k / COUNT(roughnesses) / COUNT(anisotropies)];
        polar(c, 0.5, v);
        int count = bt_mixed_points(v, &lobe, 1, 96, points);
        for (int i = 0; i < count; ++i) {
            if (points[i].l[2] > 0.0) {
                sum += points[i].weight * points[i].l[2] *
                       ggx_aniso(bt_v3(points[i].l), bt_v3(v), roughness, anisotropy, 0u);
            }
        }
        most = larger(most, sum - 1.0, roughness, anisotropy, c);
        least = larger(least, 1.0 - sum, roughness, anisotropy, c);
    }
    report("GGX anisotropic", "albedo above 1", most, 0.002);
    report("GGX anisotropic", "albedo below 1", least, 0.75);
}

/* What refracts into a volume and what reflects, together; l by refraction about half vectors. */
static void volume_energy(float eta, const char* name)
{
    bq_rule rule = bq_make(24, 12), slopes = bq_make(U_NODES, 1);
    worst most = none;
    for (int k = 0; k < COUNT(roughnesses) * COUNT(cosines); ++k) {
        float roughness = roughnesses[k % COUNT(roughnesses)];
        double alpha = bt_alpha(roughness), v[3], sum = 0.0, c = cosines[k / COUNT(roughnesses)];
        polar(c, 0.0, v);
        int count = bq_points(&rule, acos(c), 0.0, alpha, points);
        for (int i = 0; i < count; ++i) {
            hdrp_v3 l = bt_v3(points[i].l), h = hdrp_brdf_half_vector(l, bt_v3(v), *up());
            double f = (double)hdrp_brdf_f_dielectric_exact(hdrp_saturate(hdrp_v3_dot(l, h)), eta);
            sum += points[i].weight * points[i].l[2] * f * mirror(l, bt_v3(v), roughness, 0.0f, 0u);
        }
        for (int k2 = 0; k2 < U_NODES * TURN_NODES; ++k2) {
            slope_node n = slope_at(&slopes, k2 / TURN_NODES, k2 % TURN_NODES, alpha, alpha);
            double e = (double)eta, cv = dot(v, n.h), s2 = (1.0 - cv * cv) / (e * e), l[3];
            if (cv <= 0.0 || s2 >= 1.0) {
                continue;
            }
            double cl = sqrt(1.0 - s2), w = cv - e * cl;
            for (int i = 0; i < 3; ++i) {
                l[i] = (cv / e - cl) * n.h[i] - v[i] / e;
            }
            sum += (double)hdrp_brdf_btdf_ggx(*up(), bt_v3(v), bt_v3(l), (float)alpha, eta) *
                   n.solid_angle * w * w / (e * e * cl);
        }
        most = larger(most, sum - 1.0, roughness, 0.0f, c);
    }
    report(name, "reflected and refracted above 1", most, 0.005);
}

/* The whole model in a white furnace, from the side of the viewer and of one light. */
static void furnace(const char* name, hdrp_u32 features, float metallic, double above, double below,
                    double light_above)
{
    bool aniso = (features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u;
    worst most = none, least = none, sent = none;
    for (int k = 0; k < COUNT(roughnesses) * COUNT(cosines) * COUNT(anisotropies); ++k) {
        float roughness = roughnesses[k % COUNT(roughnesses)];
        double c = cosines[k / COUNT(roughnesses) % COUNT(cosines)], v[3];
        float anisotropy = anisotropies[k / COUNT(roughnesses) / COUNT(cosines)];
        double reached[3] = {0.0, 0.0, 0.0}, left[3] = {0.0, 0.0, 0.0};
        /* Rounding a grazing direction turns its half vector by more than narrow lobes are wide. */
        if ((!aniso && anisotropy != 0.0f) || (aniso && roughness < 0.2f)) {
            continue;
        }
        hdrp_brdf_data d = white(roughness, anisotropy, metallic, features);
        polar(c, 0.5, v);
        int count = bt_lit_points(d, v, features, points);
        hdrp_brdf_lit_view w = bt_view(d, bt_v3(v), features);
        for (int i = 0; i < count; ++i) {
            hdrp_v3 l = bt_v3(points[i].l);
            hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, l, features);
            double side = fabs(points[i].l[2]);
            hdrp_v3 towards = hdrp_v3_make(l.x, l.y, fabsf(l.z));
            double from[3] = {v[0], v[1], l.z < 0.0f ? -v[2] : v[2]};
            hdrp_brdf_lit s = {hdrp_v3_splat(0.0f), hdrp_v3_splat(0.0f)};
            if (side > 1e-4 && !aniso) {
                s = hdrp_brdf_lit_eval(d, bt_view(d, towards, features), bt_v3(from), features);
            }
            for (int channel = 0; channel < 3; ++channel) {
                reached[channel] += points[i].weight * bt_lit_sum(r, channel);
                left[channel] += points[i].weight * bt_lit_sum(s, channel) * side / v[2];
            }
        }
        double top = fmax(fmax(reached[0], reached[1]), reached[2]);
        double bottom = fmin(fmin(reached[0], reached[1]), reached[2]);
        most = larger(most, top - 1.0, roughness, anisotropy, c);
        least = larger(least, 1.0 - bottom, roughness, anisotropy, c);
        sent = larger(sent, fmax(fmax(left[0], left[1]), left[2]) - 1.0, roughness, anisotropy, c);
    }
    report(name, "albedo above 1", most, above);
    report(name, "albedo below 1", least, below);
    if (!aniso) { /* it is reciprocal, see above */
        report(name, "light sent above 1", sent, light_above);
    }
}

int main(void)
{
    const hdrp_u32 coat = HDRP_BRDF_FEATURE_CLEAR_COAT, film = HDRP_BRDF_FEATURE_IRIDESCENCE;
    const hdrp_u32 aniso = HDRP_BRDF_FEATURE_ANISOTROPY, slab = HDRP_BRDF_FEATURE_TRANSMISSION;
    const hdrp_u32 wall = HDRP_BRDF_FEATURE_REFRACTION;
    printf("lobe,check,worst,bound,at\n");
    normalisation("GGX from a cosine", from_cosine, false, 0.0f, 0.01);
    normalisation("GGX from vectors", from_vectors, false, 0.0f, 1e-5);
    normalisation("GGX anisotropic from components", aniso_local, true, 0.0f, 1e-5);
    normalisation("GGX anisotropic from vectors", aniso_vectors, true, 0.0f, 1e-5);
    visible_normals();
    visibility_bounds();

    reciprocity("GGX", ggx, 0u, false, 2e-5);
    reciprocity("GGX anisotropic", ggx_aniso, 0u, true, 2e-5);
    reciprocity("multiscattered GGX", multiscatter, 0u, false, 1e-6);
    reciprocity("diffuse", diffuse, 0u, false, 1e-6);
    reciprocity("diffuse of Burley", burley, 0u, false, 1e-6);
    reciprocity("diffuse of Burley; normalised", burley_normalized, 0u, false, 1e-6);
    reciprocity("thin wall", thin_wall, 0u, false, 2e-4);
    reciprocity("volume", volume, 0u, false, 1e-3);
    reciprocity("Lit standard", lit, 0u, false, 2e-5);
    reciprocity("Lit + coat", lit, coat, false, 2e-5);
    reciprocity("Lit + anisotropy", lit, aniso, true, 2e-5);
    reciprocity("Lit + film", lit, film, false, 0.3);
    reciprocity("Lit + film; exact", lit, film | HDRP_BRDF_LIT_EXACT, false, 0.25);
    reciprocity("Lit + slab", lit, slab, false, 2e-5);
    reciprocity("Lit + thin wall", lit, wall, false, 2e-5);

    albedo("GGX", mirror, NULL, 1e-4, 0.7);
    albedo("GGX with multiscattering", mirror, multiscatter, 0.004, 0.004);
    albedo("diffuse of Burley", burley, NULL, 0.56, 0.45);
    albedo("diffuse of Burley; normalised", burley_normalized, NULL, 0.03, 0.9);
    albedo("diffuse", diffuse, NULL, 0.0, 0.9);
    albedo_aniso();
    volume_energy(1.5f, "volume entered");
    volume_energy(1.0f / 1.5f, "volume left");
    furnace("Lit standard", 0u, 0.0f, 0.005, 0.01, 0.005);
    furnace("Lit standard; metal", 0u, 1.0f, 0.005, 0.01, 0.005);
    furnace("Lit + coat", coat, 0.0f, 0.005, 0.2, 0.005);
    furnace("Lit + coat; metal", coat, 1.0f, 0.005, 0.27, 0.005);
    furnace("Lit + coat as rough as the base", coat | ROUGH_COAT, 0.0f, 0.005, 0.9, 0.005);
    furnace("Lit + anisotropy", aniso, 0.0f, 0.005, 0.07, 0.005);
    furnace("Lit + anisotropy; metal", aniso, 1.0f, 0.005, 0.02, 0.005);
    furnace("Lit + film", film, 0.0f, 0.005, 0.01, 0.07);
    furnace("Lit + film; metal", film, 1.0f, 0.005, 0.01, 0.005);
    furnace("Lit + film; exact", film | HDRP_BRDF_LIT_EXACT, 0.0f, 0.01, 0.01, 0.07);
    furnace("Lit + slab", slab, 0.0f, 0.005, 0.01, 0.005);
    furnace("Lit + thin wall", wall, 0.0f, 0.005, 0.36, 0.005);
    furnace("Lit + coat + film", coat | film, 0.0f, 0.005, 0.22, 0.02);
    furnace("Lit + everything isotropic", coat | film | slab | wall, 0.0f, 0.005, 0.41, 0.02);
    return failures != 0;
}
