/* acc_brdf_albedo.c - accuracy of directional albedos, further bounces and diffuse lobes.
 * SPDX-License-Identifier: MIT
 *
 * Albedos are referred to a two-dimensional quadrature over light directions, bounces to a random
 * walk between microfacets. */
#include "accuracy.h"

#define HDRP_BRDF_IMPLEMENTATION
#include "../brdf_quadrature.h"
#include "hdrp_brdf.h"

#define MAX_SIZE 64

static bq_point points[BQ_MAX_POINTS];

static double relative(float measured, double reference)
{
    return acc_relative((double)measured, reference);
}

static double alpha_of(float perceptual_roughness)
{
    double p = (double)perceptual_roughness;
    return acc_larger(p * p, (double)HDRP_ALPHA_MIN);
}

/* A view: anywhere, or at the angle where shadowing is strongest. */
static float random_view(acc* a, int i, double lowest, double alpha)
{
    double c = i % 3 == 0   ? acc_uniform(a, lowest, 1.0)
               : i % 3 == 1 ? acc_log_uniform(a, acc_larger(lowest, 1e-4), 1.0)
                            : fmin(acc_larger(alpha * acc_log_uniform(a, 0.1, 10.0), lowest), 1.0);
    return acc_float(i % 31 == 0 ? 1.0 : c);
}

static float random_roughness(acc* a, int i)
{
    return acc_float(i % 41 == 0 ? 1.0 : i % 37 == 0 ? 0.0 : acc_uniform(a, 0.0, 1.0));
}

static bq_fgd reference_fgd(float n_dot_v, float perceptual_roughness)
{
    static bq_rule rule;
    if (rule.polar == 0) {
        rule = bq_make(16, 12);
    }
    return bq_integrate_fgd(&rule, acc_larger((double)n_dot_v, 1e-6),
                            alpha_of(perceptual_roughness), points);
}

static double fgd_difference(hdrp_brdf_fgd m, bq_fgd r)
{
    return acc_larger(fabs((double)m.albedo - r.albedo), fabs((double)m.schlick - r.schlick));
}

static void fgd_fast(acc* a)
{
    for (int i = 0; i < 2000; ++i) {
        float p = random_roughness(a, i), c = random_view(a, i, 0.0, alpha_of(p));
        ACC_ADD(a, fgd_difference(hdrp_brdf_fgd_fast(c, p), reference_fgd(c, p)),
                "n.v %.9g, perceptual roughness %.9g", (double)c, (double)p);
    }
}

static void fgd_fast_albedo(acc* a)
{
    for (int i = 0; i < 2000; ++i) {
        float p = random_roughness(a, i), c = random_view(a, i, 0.0, alpha_of(p));
        double r = reference_fgd(c, p).albedo;
        ACC_ADD(a, fabs((double)hdrp_brdf_fgd_fast(c, p).albedo - r),
                "n.v %.9g, perceptual roughness %.9g", (double)c, (double)p);
    }
}

static void fgd_integrate(acc* a)
{
    for (int i = 0; i < 1500; ++i) {
        float p = random_roughness(a, i), c = random_view(a, i, 0.0, alpha_of(p));
        ACC_ADD(a, fgd_difference(hdrp_brdf_fgd_integrate(c, p), reference_fgd(c, p)),
                "n.v %.9g, perceptual roughness %.9g", (double)c, (double)p);
    }
}

static const hdrp_brdf_fgd* fgd_table(void)
{
    static hdrp_brdf_fgd table[MAX_SIZE * MAX_SIZE];
    if (table[0].albedo == 0.0f) {
        hdrp_brdf_fgd_bake_rows(table, MAX_SIZE, 0, MAX_SIZE);
    }
    return table;
}

static void fgd_lookup(acc* a)
{
    for (int i = 0; i < 2000; ++i) {
        float p = random_roughness(a, i), c = random_view(a, i, 0.05, alpha_of(p));
        hdrp_brdf_fgd m = hdrp_brdf_fgd_lookup(fgd_table(), MAX_SIZE, c, p);
        ACC_ADD(a, fgd_difference(m, reference_fgd(c, p)), "n.v %.9g, perceptual roughness %.9g",
                (double)c, (double)p);
    }
}

static void fgd_lookup_grazing(acc* a)
{
    for (int i = 0; i < 2000; ++i) {
        float p = random_roughness(a, i), c = random_view(a, i, 0.0, alpha_of(p));
        hdrp_brdf_fgd m = hdrp_brdf_fgd_lookup(fgd_table(), MAX_SIZE, c, p);
        ACC_ADD(a, fgd_difference(m, reference_fgd(c, p)), "n.v %.9g, perceptual roughness %.9g",
                (double)c, (double)p);
    }
}

/* Albedos of a stretched lobe by its visible normals (Heitz 2018), stratified: side^2 of them. */
static bq_fgd reference_stretched(const double v[3], double at, double ab, int side)
{
    double s[3] = {at * v[0], ab * v[1], v[2]}, length;
    length = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    double own = 0.5 + 0.5 * length / v[2];
    bq_fgd sum = {0.0, 0.0};
    for (int i = 0; i < side * side; ++i) {
        double phi = 2.0 * BQ_PI * (i % side + 0.5) / side, u = (i / side + 0.5) / side;
        double z = (1.0 - u) * (1.0 + s[2] / length) - s[2] / length;
        double r = sqrt(acc_larger(1.0 - z * z, 0.0)), l[3];
        double h[3] = {at * (r * cos(phi) + s[0] / length), ab * (r * sin(phi) + s[1] / length),
                       z + s[2] / length};
        double c =
            (v[0] * h[0] + v[1] * h[1] + v[2] * h[2]) / (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
        double cosine = c * sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
        for (int k = 0; k < 3; ++k) {
            l[k] = 2.0 * c * h[k] - v[k];
        }
        if (l[2] > 0.0) {
            double x = at * l[0] / l[2], y = ab * l[1] / l[2];
            double kept = own / (own + 0.5 * sqrt(1.0 + x * x + y * y) - 0.5);
            sum.albedo += kept / (side * side);
            sum.schlick += kept * pow(1.0 - fmin(cosine, 1.0), 5.0) / (side * side);
        }
    }
    return sum;
}

typedef struct stretched {
    float roughness, anisotropy;
    hdrp_brdf_alphas alphas;
    double v[3];
    hdrp_brdf_fgd fit;
    bq_fgd reference;
} stretched;

static stretched random_stretched(acc* a, int i, double limit)
{
    stretched s;
    s.roughness = random_roughness(a, i);
    s.anisotropy = acc_float(i % 7 == 0 ? (i % 2 ? limit : -limit) : acc_uniform(a, -limit, limit));
    s.alphas = hdrp_brdf_alphas_kulla(s.roughness, s.anisotropy);
    double c = (double)random_view(a, i, 3e-4, alpha_of(s.roughness));
    double phi = i % 5 < 2 ? 0.5 * BQ_PI * (i % 5) : acc_uniform(a, 0.0, 2.0 * BQ_PI);
    double side = sqrt(1.0 - c * c);
    s.v[0] = side * cos(phi);
    s.v[1] = side * sin(phi);
    s.v[2] = c;
    s.reference = reference_stretched(s.v, (double)s.alphas.t, (double)s.alphas.b, 56);
    hdrp_brdf_fgd_fit fit = hdrp_brdf_fgd_fit_towards(hdrp_brdf_fgd_fit_make_aniso(s.alphas),
                                                      hdrp_brdf_fgd_stretch_make(s.alphas),
                                                      (float)s.v[0], (float)s.v[1], (float)c);
    s.fit = hdrp_brdf_fgd_from_fit(fit, (float)c);
    return s;
}

static void add_stretched(acc* a, const stretched* s, double error)
{
    ACC_ADD(a, acc_larger(error, 0.0),
            "v %.9g %.9g %.9g, perceptual roughness %.9g, anisotropy %.9g", s->v[0], s->v[1],
            s->v[2], (double)s->roughness, (double)s->anisotropy);
}

static void fgd_towards_above(acc* a)
{
    for (int i = 0; i < 2500; ++i) {
        stretched s = random_stretched(a, i, 1.0);
        add_stretched(a, &s, (double)s.fit.albedo - s.reference.albedo);
    }
}

static void fgd_towards_below(acc* a)
{
    for (int i = 0; i < 2500; ++i) {
        stretched s = random_stretched(a, i, 1.0);
        add_stretched(a, &s, s.reference.albedo - (double)s.fit.albedo);
    }
}

static void fgd_towards_schlick(acc* a)
{
    for (int i = 0; i < 2500; ++i) {
        stretched s = random_stretched(a, i, 0.75);
        add_stretched(a, &s, fabs((double)s.fit.schlick - s.reference.schlick));
    }
}

static void fgd_towards_schlick_below(acc* a)
{
    for (int i = 0; i < 2500; ++i) {
        stretched s = random_stretched(a, i, 1.0);
        add_stretched(a, &s, s.reference.schlick - (double)s.fit.schlick);
    }
}

static double fitted_schlick(hdrp_brdf_alphas alphas, const double v[3])
{
    hdrp_brdf_fgd_fit fit = hdrp_brdf_fgd_fit_towards(hdrp_brdf_fgd_fit_make_aniso(alphas),
                                                      hdrp_brdf_fgd_stretch_make(alphas),
                                                      (float)v[0], (float)v[1], (float)v[2]);
    return (double)hdrp_brdf_fgd_from_fit(fit, (float)v[2]).schlick;
}

/* Cosine-weighted over a quarter turn, nodes gathered at grazing and at the narrow side: of the loss,
 * or of Schlick's weight by the fit, since the mean is there to divide a lobe that comes from it. */
static void fgd_aniso_means(acc* a, bool of_schlick)
{
    enum { NODES = 20 };
    double x[NODES], w[NODES];
    bq_gauss_legendre(NODES, x, w);
    for (int i = 0; i < 40; ++i) {
        float p = random_roughness(a, i), k = acc_float(i % 4 ? acc_uniform(a, 0.0, 1.0) : 1.0);
        hdrp_brdf_alphas alphas = hdrp_brdf_alphas_kulla(p, k);
        hdrp_brdf_fgd_fit fit = hdrp_brdf_fgd_fit_make_aniso(alphas);
        double at = (double)alphas.t, ab = (double)alphas.b, mean = 0.0, top = asinh(1.0 / ab);
        double gather = acc_larger(ab / at, 1e-3), turn = asinh(0.5 * BQ_PI / gather);
        for (int j = 0; j < NODES * NODES; ++j) {
            double c = ab * sinh(top * x[j / NODES]), side = sqrt(acc_larger(1.0 - c * c, 0.0));
            double phi = gather * sinh(turn * x[j % NODES]);
            double v[3] = {side * sin(phi), side * cos(phi), c};
            double weight = w[j / NODES] * top * ab * cosh(top * x[j / NODES]) * 2.0 * c;
            weight *= w[j % NODES] * turn * gather * cosh(turn * x[j % NODES]) / (0.5 * BQ_PI);
            mean += weight * (of_schlick ? fitted_schlick(alphas, v)
                                         : 1.0 - reference_stretched(v, at, ab, 32).albedo);
        }
        ACC_ADD(a, fabs((double)(of_schlick ? fit.mean_schlick : fit.mean_loss) - mean),
                "perceptual roughness %.9g, anisotropy %.9g", (double)p, (double)k);
    }
}

static void fgd_aniso_mean(acc* a)
{
    fgd_aniso_means(a, false);
}

static void fgd_aniso_mean_schlick(acc* a)
{
    fgd_aniso_means(a, true);
}

/* One step of a ray through the microsurface, whose heights are uniform in [-1,1] (Heitz et al.
 * 2016): the height of the next hit, or 2 where the ray escapes. */
static double next_height(double cosine, double height, double alpha, double u)
{
    double below = fmin(acc_larger(0.5 * (height + 1.0), 0.0), 1.0); /* cumulative distribution */
    if (cosine > 0.99999) {
        return 2.0;
    }
    if (cosine < -0.99999) {
        return 2.0 * u * below - 1.0;
    }
    if (fabs(cosine) < 1e-6) {
        return height;
    }
    double slope = sqrt(1.0 + alpha * alpha * (1.0 - cosine * cosine) / (cosine * cosine));
    double lambda = 0.5 * ((cosine > 0.0 ? slope : -slope) - 1.0);
    double escape = cosine > 0.0 ? pow(below, lambda) : 0.0;
    return u > 1.0 - escape ? 2.0
                            : acc_larger(2.0 * below / pow(1.0 - u, 1.0 / lambda) - 1.0, -1.0);
}

/* Reflects the ray w at a visible normal; returns the cosine of the incidence. */
static double bounce(acc* a, double w[3], double alpha)
{
    double v[3] = {-alpha * w[0], -alpha * w[1], -w[2]}, h[3], length, c = 0.0;
    length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    double phi = acc_uniform(a, 0.0, 2.0 * BQ_PI);
    double z = acc_uniform(a, -v[2] / length, 1.0), r = sqrt(acc_larger(1.0 - z * z, 0.0));
    h[0] = alpha * (r * cos(phi) + v[0] / length);
    h[1] = alpha * (r * sin(phi) + v[1] / length);
    h[2] = acc_larger(z + v[2] / length, 0.0);
    length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int k = 0; k < 3; ++k) {
        h[k] /= length;
        c -= w[k] * h[k];
    }
    for (int k = 0; k < 3; ++k) {
        w[k] += 2.0 * c * h[k];
    }
    return c;
}

#define WALK_F0_COUNT 4
static const double walk_f0[WALK_F0_COUNT] = {0.2, 0.5, 0.8, 0.95};

static void walk(acc* a, double n_dot_v, double alpha, int paths, double albedo[WALK_F0_COUNT])
{
    for (int k = 0; k < WALK_F0_COUNT; ++k) {
        albedo[k] = 0.0;
    }
    for (int path = 0; path < paths; ++path) {
        double w[3] = {-sqrt(1.0 - n_dot_v * n_dot_v), 0.0, -n_dot_v}, height = 0.998;
        double left[WALK_F0_COUNT] = {1.0, 1.0, 1.0, 1.0};
        for (int order = 0; order < 40; ++order) {
            height = next_height(w[2], height, alpha, acc_uniform(a, 0.0, 1.0));
            if (height >= 2.0) {
                break;
            }
            double weight = pow(1.0 - fmin(acc_larger(bounce(a, w, alpha), 0.0), 1.0), 5.0);
            for (int k = 0; k < WALK_F0_COUNT; ++k) {
                left[k] *= walk_f0[k] + (1.0 - walk_f0[k]) * weight;
            }
        }
        for (int k = 0; k < WALK_F0_COUNT; ++k) {
            albedo[k] += left[k] / paths;
        }
    }
}

/* All that a surface reflects of a white environment by the formulas: from the roughness, the F0 and
 * the albedos of the first bounce. */
typedef double reflected_by(float perceptual_roughness, double f0, bq_fgd first);

static void compare_with_walk(acc* a, reflected_by* f)
{
    static const float roughness[] = {0.3f, 0.5f, 0.7f, 0.85f, 1.0f};
    static const float view[] = {0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 1.0f};
    for (int i = 0; i < 30; ++i) {
        float p = roughness[i / 6], c = view[i % 6];
        bq_fgd first = reference_fgd(c, p);
        double albedo[WALK_F0_COUNT];
        walk(a, (double)c, alpha_of(p), 20000, albedo);
        for (int k = 0; k < WALK_F0_COUNT; ++k) {
            ACC_ADD(a, fabs(f(p, walk_f0[k], first) - albedo[k]),
                    "n.v %.3f, perceptual roughness %.3f, F0 %.2f", (double)c, (double)p,
                    walk_f0[k]);
        }
    }
}

static double first_bounce(double f0, bq_fgd e)
{
    return f0 * (e.albedo - e.schlick) + e.schlick;
}

static double with_bounces(float p, double f0, bq_fgd e)
{
    hdrp_brdf_bounces b =
        hdrp_brdf_bounces_make(hdrp_brdf_fgd_fit_make(p), hdrp_v3_splat((float)f0), 1.0f);
    return first_bounce(f0, e) + (1.0 - e.albedo) * (double)b.reflected.y;
}

static double with_compensation(float p, double f0, bq_fgd e)
{
    (void)p;
    hdrp_brdf_fgd fgd;
    fgd.albedo = (float)e.albedo;
    fgd.schlick = (float)e.schlick;
    hdrp_v3 factor = hdrp_brdf_energy_compensation(fgd, hdrp_v3_splat((float)f0));
    return first_bounce(f0, e) * (double)factor.y;
}

static void bounces(acc* a)
{
    compare_with_walk(a, with_bounces);
}

static void energy_compensation(acc* a)
{
    compare_with_walk(a, with_compensation);
}

/* Integral over light cosines of 2 pi f cos, where f changes fastest at grazing. */
typedef double per_cosine(float n_dot_l, const void* context);

static double integrate_cosine(per_cosine* f, const void* context, double alpha)
{
    static double x[32], w[32];
    if (w[0] == 0.0) {
        bq_gauss_legendre(32, x, w);
    }
    double top = asinh(1.0 / alpha), sum = 0.0;
    for (int i = 0; i < 32; ++i) {
        double s = top * x[i], c = alpha * sinh(s);
        sum += w[i] * top * alpha * cosh(s) * 2.0 * BQ_PI * c * f(acc_float(c), context);
    }
    return sum;
}

typedef struct surface {
    hdrp_brdf_fgd_fit fit;
    float n_dot_v, f0, f90;
} surface;

static double multiscatter_of(float n_dot_l, const void* context)
{
    const surface* s = (const surface*)context;
    return (double)hdrp_brdf_multiscatter(s->fit, s->n_dot_v, n_dot_l, hdrp_v3_splat(s->f0), s->f90)
        .x;
}

static double diffuse_of(float n_dot_l, const void* context)
{
    const surface* s = (const surface*)context;
    return (double)hdrp_brdf_diffuse(s->fit, s->n_dot_v, n_dot_l, hdrp_v3_splat(s->f0), s->f90).z;
}

static double share_of(float n_dot_l, const void* context)
{
    const surface* s = (const surface*)context;
    hdrp_brdf_bounces b = hdrp_brdf_bounces_make(s->fit, hdrp_v3_splat(s->f0), s->f90);
    return (double)hdrp_brdf_diffuse_share(hdrp_brdf_fgd_from_fit(s->fit, n_dot_l), b, s->f90).y /
           BQ_PI;
}

static void multiscatter(acc* a)
{
    for (int i = 0; i < 800; ++i) {
        float p = random_roughness(a, i), c = random_view(a, i, 0.05, alpha_of(p));
        surface s = {hdrp_brdf_fgd_fit_make(p), c, 1.0f, 1.0f};
        double sum =
            reference_fgd(c, p).albedo + integrate_cosine(multiscatter_of, &s, alpha_of(p));
        ACC_ADD(a, fabs(sum - 1.0), "n.v %.9g, perceptual roughness %.9g", (double)c, (double)p);
    }
}

static void multiscatter_grazing(acc* a)
{
    for (int i = 0; i < 800; ++i) {
        float p = random_roughness(a, i), c = random_view(a, i, 0.0, alpha_of(p));
        surface s = {hdrp_brdf_fgd_fit_make(p), c, 1.0f, 1.0f};
        double sum =
            reference_fgd(c, p).albedo + integrate_cosine(multiscatter_of, &s, alpha_of(p));
        ACC_ADD(a, fabs(sum - 1.0), "n.v %.9g, perceptual roughness %.9g", (double)c, (double)p);
    }
}

static surface random_surface(acc* a, int i, float p, float c)
{
    surface s = {hdrp_brdf_fgd_fit_make(p), c, 0.0f, 0.0f};
    s.f0 = acc_float(i % 4 == 0   ? 0.04
                     : i % 4 == 1 ? acc_uniform(a, 0.0, 1.0)
                     : i % 4 == 2 ? acc_log_uniform(a, 1e-4, 1.0)
                                  : (double)(i / 4 % 2));
    s.f90 = hdrp_brdf_fresnel90(hdrp_v3_splat(s.f0));
    return s;
}

static void diffuse_share_mean(acc* a)
{
    for (int i = 0; i < 2000; ++i) {
        float p = random_roughness(a, i);
        surface s = random_surface(a, i, p, 0.5f);
        hdrp_brdf_bounces b = hdrp_brdf_bounces_make(s.fit, hdrp_v3_splat(s.f0), s.f90);
        ACC_ADD(a,
                relative(hdrp_brdf_diffuse_share_mean(s.fit, b, s.f90).x,
                         integrate_cosine(share_of, &s, alpha_of(p))),
                "perceptual roughness %.9g, F0 %.9g", (double)p, (double)s.f0);
    }
}

/* Albedo of the specular lobe, all its bounces and a white diffuse lobe, less 1. */
static double excess(acc* a, int i, float* p, float* c, float* f0)
{
    *p = random_roughness(a, i);
    *c = random_view(a, i, 0.0, alpha_of(*p));
    surface s = random_surface(a, i, *p, *c);
    *f0 = s.f0;
    bq_fgd e = reference_fgd(*c, *p);
    double first = (double)s.f0 * (e.albedo - e.schlick) + (double)s.f90 * e.schlick;
    return first + integrate_cosine(multiscatter_of, &s, alpha_of(*p)) +
           integrate_cosine(diffuse_of, &s, alpha_of(*p)) - 1.0;
}

static void diffuse_gain(acc* a)
{
    for (int i = 0; i < 1500; ++i) {
        float p, c, f0;
        ACC_ADD(a, acc_larger(excess(a, i, &p, &c, &f0), 0.0),
                "n.v %.9g, perceptual roughness %.9g, F0 %.9g", (double)c, (double)p, (double)f0);
    }
}

static void diffuse_loss(acc* a)
{
    for (int i = 0; i < 1500; ++i) {
        float p, c, f0;
        ACC_ADD(a, acc_larger(-excess(a, i, &p, &c, &f0), 0.0),
                "n.v %.9g, perceptual roughness %.9g, F0 %.9g", (double)c, (double)p, (double)f0);
    }
}

/* Burley's lobe from angles: the half angle of the directions instead of their cosine. */
static double disney(acc* a, float args[4], int normalized)
{
    args[0] = acc_float(acc_uniform(a, 0.0, 1.0));
    args[1] = acc_float(acc_uniform(a, 0.0, 1.0));
    args[2] = acc_float(acc_uniform(a, -1.0, 1.0));
    args[3] = acc_float(acc_uniform(a, 0.0, 1.0));
    double pr = (double)args[3], d = cos(0.5 * acos((double)args[2]));
    double f90 = (normalized ? 0.5 * pr : 0.5) + 2.0 * pr * d * d;
    double fl = 1.0 + (f90 - 1.0) * pow(1.0 - (double)args[1], 5.0);
    double fv = 1.0 + (f90 - 1.0) * pow(1.0 - (double)args[0], 5.0);
    return fl * fv / BQ_PI * (normalized ? 1.0 - pr * (51.0 / 151.0) : 1.0);
}

static void diffuse_disney(acc* a)
{
    for (int i = 0; i < 40000; ++i) {
        float x[4];
        double reference = disney(a, x, 0);
        ACC_ADD(a, relative(hdrp_brdf_diffuse_disney(x[0], x[1], x[2], x[3]), reference),
                "n.v %.9g, n.l %.9g, l.v %.9g, %.9g", (double)x[0], (double)x[1], (double)x[2],
                (double)x[3]);
    }
}

static void diffuse_disney_normalized(acc* a)
{
    for (int i = 0; i < 40000; ++i) {
        float x[4];
        double reference = disney(a, x, 1);
        double error =
            fabs((double)hdrp_brdf_diffuse_disney_normalized(x[0], x[1], x[2], x[3]) - reference);
        ACC_ADD(a, error, "n.v %.9g, n.l %.9g, l.v %.9g, %.9g", (double)x[0], (double)x[1],
                (double)x[2], (double)x[3]);
    }
}

static void perceptual_roughness_filtered(acc* a)
{
    for (int i = 0; i < 40000; ++i) {
        float p = acc_float(acc_uniform(a, 0.0, 1.0));
        float v = acc_float(i % 2 ? acc_uniform(a, 0.0, 1.0) : acc_log_uniform(a, 1e-8, 1.0));
        double reference = fmin(pow(pow((double)p, 4.0) + (double)v, 0.25), 1.0);
        ACC_ADD(a, fabs((double)hdrp_brdf_perceptual_roughness_filtered(p, v) - reference),
                "perceptual roughness %.9g, variance %.9g", (double)p, (double)v);
    }
}

const acc_entry acc_brdf_albedo[] = {
    {"brdf_fgd_fast", fgd_fast},
    {"brdf_fgd_fast_albedo", fgd_fast_albedo},
    {"brdf_fgd_fit_towards_above", fgd_towards_above},
    {"brdf_fgd_fit_towards_below", fgd_towards_below},
    {"brdf_fgd_fit_towards_schlick", fgd_towards_schlick},
    {"brdf_fgd_fit_towards_schlick_below", fgd_towards_schlick_below},
    {"brdf_fgd_fit_aniso_mean", fgd_aniso_mean},
    {"brdf_fgd_fit_aniso_mean_schlick", fgd_aniso_mean_schlick},
    {"brdf_fgd_integrate", fgd_integrate},
    {"brdf_fgd_lookup", fgd_lookup},
    {"brdf_fgd_lookup_grazing", fgd_lookup_grazing},
    {"brdf_bounces", bounces},
    {"brdf_energy_compensation", energy_compensation},
    {"brdf_multiscatter", multiscatter},
    {"brdf_multiscatter_grazing", multiscatter_grazing},
    {"brdf_diffuse_share_mean", diffuse_share_mean},
    {"brdf_diffuse_gain", diffuse_gain},
    {"brdf_diffuse_loss", diffuse_loss},
    {"brdf_diffuse_disney", diffuse_disney},
    {"brdf_diffuse_disney_normalized", diffuse_disney_normalized},
    {"brdf_perceptual_roughness_filtered", perceptual_roughness_filtered},
    {NULL, NULL},
};
