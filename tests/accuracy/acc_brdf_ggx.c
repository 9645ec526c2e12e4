/* acc_brdf_ggx.c - accuracy of the GGX terms of hdrp_brdf_lobes.h.
 * SPDX-License-Identifier: MIT
 *
 * Distributions are referred to slopes of exact angles, visibilities to Smith's Lambda. */
#include "accuracy.h"

#include "hdrp_brdf_lobes.h"

#define PI    3.14159265358979323846
#define COUNT 40000

static double relative(float measured, double reference)
{
    return acc_relative((double)measured, reference);
}

typedef struct vec {
    double x, y, z;
} vec;

static vec vec_of(hdrp_v3 v)
{
    vec r = {(double)v.x, (double)v.y, (double)v.z};
    return r;
}

static hdrp_v3 rounded(vec v)
{
    return hdrp_v3_make(acc_float(v.x), acc_float(v.y), acc_float(v.z));
}

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec cross(vec a, vec b)
{
    vec r = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return r;
}

static vec mad(vec a, vec b, double s)
{
    vec r = {a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
    return r;
}

static vec unit(vec v)
{
    vec zero = {0.0, 0.0, 0.0};
    return mad(zero, v, 1.0 / sqrt(dot(v, v)));
}

static vec direction(acc* a)
{
    double d[3];
    acc_direction(a, d);
    vec r = {d[0], d[1], d[2]};
    return r;
}

/* A vector at an angle from n, in a random plane. */
static vec tilted(acc* a, vec n, double angle)
{
    vec side = unit(cross(n, direction(a)));
    vec zero = {0.0, 0.0, 0.0};
    return unit(mad(mad(zero, n, cos(angle)), side, sin(angle)));
}

static double angle_between(vec a, vec b)
{
    vec c = cross(a, b);
    return atan2(sqrt(dot(c, c)), dot(a, b));
}

/* Distribution of slopes (x, y), and of normals from it. */
static double d_from_slopes(double x, double y, double cos2, double at, double ab)
{
    double s = 1.0 + x * x / (at * at) + y * y / (ab * ab);
    return 1.0 / (PI * at * ab * s * s * cos2 * cos2);
}

static double width(float alpha)
{
    return acc_larger((double)alpha, 1e-4);
}

static float random_alpha(acc* a, int i, double hi)
{
    return i % 17 == 0 ? 0.0f : acc_float(acc_log_uniform(a, 1e-4, hi));
}

/* Angles from the tip of the lobe to its far tail. */
static double random_angle(acc* a, float alpha)
{
    double t = acc_log_uniform(a, 1e-3, 1e3) * width(alpha);
    return t < 1.55 ? t : acc_uniform(a, 0.0, 1.55);
}

static void alpha_from_perceptual_roughness(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float p = acc_float(acc_uniform(a, 0.0, 1.0));
        double reference = acc_larger(exp(2.0 * log((double)p)), (double)HDRP_ALPHA_MIN);
        ACC_ADD(a, relative(hdrp_brdf_alpha_from_perceptual_roughness(p), reference), "%.9g",
                (double)p);
    }
}

static void half_vector(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        vec dv = direction(a);
        hdrp_v3 v = rounded(dv);
        vec opposite = {-dv.x, -dv.y, -dv.z};
        hdrp_v3 l = i % 2 ? rounded(direction(a))
                          : rounded(tilted(a, opposite, acc_log_uniform(a, 2e-3, 1.0)));
        vec sum = mad(vec_of(l), vec_of(v), 1.0);
        if (dot(sum, sum) < 1e-6) {
            continue;
        }
        vec reference = unit(sum), h = vec_of(hdrp_brdf_half_vector(l, v, v));
        double error = acc_larger(acc_larger(fabs(h.x - reference.x), fabs(h.y - reference.y)),
                                  fabs(h.z - reference.z));
        ACC_ADD(a, error, "|l + v| = %.9g", sqrt(dot(sum, sum)));
    }
}

static void sin2_between(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        vec dn = direction(a);
        hdrp_v3 n = rounded(dn), h = rounded(tilted(a, dn, acc_log_uniform(a, 1e-5, 1.5)));
        double s = sin(angle_between(vec_of(n), vec_of(h)));
        ACC_ADD(a, relative(hdrp_brdf_sin2_between(n, h), s * s), "sine %.9g", s);
    }
}

static void d_ggx(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float alpha = random_alpha(a, i, 1.0);
        float c = acc_float(i % 9 ? cos(random_angle(a, alpha)) : acc_uniform(a, 0.0, 1.0));
        double cos2 = (double)c * (double)c, tan2 = (1.0 - (double)c) * (1.0 + (double)c) / cos2;
        double reference = d_from_slopes(sqrt(tan2), 0.0, cos2, width(alpha), width(alpha));
        ACC_ADD(a, relative(hdrp_brdf_d_ggx(c, alpha), reference), "n.h %.9g, alpha %.9g",
                (double)c, (double)alpha);
    }
}

static double d_of_angle(double angle, float alpha)
{
    double c = cos(angle);
    return d_from_slopes(tan(angle), 0.0, c * c, width(alpha), width(alpha));
}

static void d_ggx_vectors(acc* a)
{
    for (int i = 0; i < 2 * COUNT; ++i) {
        float alpha = random_alpha(a, i, 1.0);
        vec dn = direction(a);
        hdrp_v3 n = rounded(dn), h = rounded(tilted(a, dn, random_angle(a, alpha)));
        double angle = angle_between(vec_of(n), vec_of(h));
        ACC_ADD(a, relative(hdrp_brdf_d_ggx_vectors(n, h, alpha), d_of_angle(angle, alpha)),
                "angle %.9g, alpha %.9g", angle, (double)alpha);
    }
}

/* A third in the flank of the narrowest lobe about a normal whose components are all rounded as
 * coarsely: there an angle loses most. */
static void d_ggx_unrounded(acc* a)
{
    for (int i = 0; i < 12 * COUNT; ++i) {
        int narrow = i % 3 == 0;
        vec even = {1.0, 1.0, 1.0};
        float alpha = narrow ? 1e-4f : random_alpha(a, i, 1.0);
        hdrp_v3 n =
            rounded(narrow ? unit(mad(even, direction(a), i % 2 ? 0.2 : 1e-5)) : direction(a));
        double tilt = narrow ? acc_uniform(a, 0.3, 2.0) * width(alpha) : random_angle(a, alpha);
        vec dh = tilted(a, unit(vec_of(n)), tilt);
        double angle = angle_between(vec_of(n), dh);
        ACC_ADD(a,
                relative(hdrp_brdf_d_ggx_vectors(n, rounded(dh), alpha), d_of_angle(angle, alpha)),
                "angle %.9g, alpha %.9g", angle, (double)alpha);
    }
}

static double lambda(double at, double ab, double x, double y, double z)
{
    double tan2 = (at * at * x * x + ab * ab * y * y) / (z * z);
    return 0.5 * (sqrt(1.0 + tan2) - 1.0);
}

/* G2 / (4 n.l n.v) with G2 = 1 / (1 + Lambda(l) + Lambda(v)). */
static double visibility(double at, double ab, vec l, vec v)
{
    double sum = 1.0 + lambda(at, ab, l.x, l.y, l.z) + lambda(at, ab, v.x, v.y, v.z);
    return 1.0 / (4.0 * l.z * v.z * sum);
}

static vec vec_of_cosine(float c)
{
    vec r = {sqrt((1.0 - (double)c) * (1.0 + (double)c)), 0.0, (double)c};
    return r;
}

static float random_cosine(acc* a, int i)
{
    return acc_float(i % 3 ? acc_uniform(a, 0.0, 1.0) : acc_log_uniform(a, 1e-6, 1.0));
}

static void v_smith_ggx(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float alpha = random_alpha(a, i, 1.0), nl = random_cosine(a, i),
              nv = random_cosine(a, i / 2);
        double reference =
            visibility(width(alpha), width(alpha), vec_of_cosine(nl), vec_of_cosine(nv));
        ACC_ADD(a, relative(hdrp_brdf_v_smith_ggx(nl, nv, alpha), reference),
                "n.l %.9g, n.v %.9g, alpha %.9g", (double)nl, (double)nv, (double)alpha);
    }
}

static void dv_ggx(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float alpha = random_alpha(a, i, 1.0), nl = random_cosine(a, i),
              nv = random_cosine(a, i / 2);
        float c = acc_float(i % 9 ? cos(random_angle(a, alpha)) : acc_uniform(a, 0.0, 1.0));
        double cos2 = (double)c * (double)c, tan2 = (1.0 - (double)c) * (1.0 + (double)c) / cos2;
        double w = width(alpha), reference = d_from_slopes(sqrt(tan2), 0.0, cos2, w, w) *
                                             visibility(w, w, vec_of_cosine(nl), vec_of_cosine(nv));
        ACC_ADD(a, relative(hdrp_brdf_dv_ggx(c, nl, nv, alpha), reference),
                "n.h %.9g, n.l %.9g, n.v %.9g, alpha %.9g", (double)c, (double)nl, (double)nv,
                (double)alpha);
    }
}

static void dv_ggx_vectors(acc* a)
{
    for (int i = 0; i < 2 * COUNT; ++i) {
        float alpha = random_alpha(a, i, 1.0), nl = random_cosine(a, i),
              nv = random_cosine(a, i / 2);
        vec dn = direction(a);
        hdrp_v3 n = rounded(dn), h = rounded(tilted(a, dn, random_angle(a, alpha)));
        double angle = angle_between(vec_of(n), vec_of(h)), w = width(alpha);
        double reference =
            d_of_angle(angle, alpha) * visibility(w, w, vec_of_cosine(nl), vec_of_cosine(nv));
        ACC_ADD(a, relative(hdrp_brdf_dv_ggx_vectors(n, h, nl, nv, alpha), reference),
                "angle %.9g, n.l %.9g, n.v %.9g, alpha %.9g", angle, (double)nl, (double)nv,
                (double)alpha);
    }
}

static void v_smith_ggx_fast(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float alpha = acc_float(acc_uniform(a, 0.0, 1.0));
        float nl = acc_float(i % 5 ? acc_uniform(a, 0.1, 1.0) : 0.1 + 0.9 * (i % 10 / 5));
        float nv = acc_float(i % 7 ? acc_uniform(a, 0.1, 1.0) : 0.1 + 0.9 * (i % 14 / 7));
        double reference =
            visibility(width(alpha), width(alpha), vec_of_cosine(nl), vec_of_cosine(nv));
        ACC_ADD(a, relative(hdrp_brdf_v_smith_ggx_fast(nl, nv, alpha), reference),
                "n.l %.9g, n.v %.9g, alpha %.9g", (double)nl, (double)nv, (double)alpha);
    }
}

/* A half vector whose slopes are drawn on the scale of both widths. */
static vec random_half(acc* a, float alpha_t, float alpha_b)
{
    double r = acc_log_uniform(a, 1e-3, 1e2), phi = acc_uniform(a, 0.0, 2.0 * PI);
    vec h = {r * cos(phi) * width(alpha_t), r * sin(phi) * width(alpha_b), 1.0};
    return unit(h);
}

static void d_ggx_aniso(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float at = random_alpha(a, i, 3.2), ab = random_alpha(a, i / 2, 3.2);
        hdrp_v3 h = rounded(i % 5 ? random_half(a, at, ab) : direction(a));
        h.z = fabsf(h.z);
        if (h.z == 0.0f) {
            continue;
        }
        vec d = vec_of(h);
        double reference = d_from_slopes(d.x / d.z, d.y / d.z, d.z * d.z, width(at), width(ab));
        ACC_ADD(a, relative(hdrp_brdf_d_ggx_aniso(h.x, h.y, h.z, at, ab), reference),
                "h (%.9g %.9g %.9g), widths %.9g %.9g", d.x, d.y, d.z, (double)at, (double)ab);
    }
}

/* Against the frame that t, b and n stand for: orthogonal, where rounding left them almost so. */
static void compare_aniso_vectors(acc* a, float at, float ab)
{
    vec dn = direction(a), dt = unit(cross(dn, direction(a))), db = cross(dn, dt);
    vec local = random_half(a, at, ab), zero = {0.0, 0.0, 0.0};
    hdrp_v3 t = rounded(dt), b = rounded(db), n = rounded(dn);
    hdrp_v3 h = rounded(mad(mad(mad(zero, dt, local.x), db, local.y), dn, local.z));
    vec en = unit(vec_of(n)), eh = unit(vec_of(h));
    vec et = unit(mad(vec_of(t), en, -dot(vec_of(t), en)));
    vec eb = unit(mad(vec_of(b), en, -dot(vec_of(b), en)));
    double z = dot(en, eh), x = dot(et, eh) / z, y = dot(eb, eh) / z;
    double reference = d_from_slopes(x, y, z * z, width(at), width(ab));
    ACC_ADD(a, relative(hdrp_brdf_d_ggx_aniso_vectors(t, b, n, h, at, ab), reference),
            "slopes (%.9g %.9g), widths %.9g %.9g", x, y, (double)at, (double)ab);
}

static void d_ggx_aniso_vectors(acc* a)
{
    for (int i = 0; i < 12 * COUNT; ++i) {
        float at = random_alpha(a, i, 3.2);
        double ab = width(at) * acc_log_uniform(a, 0.1, 10.0);
        compare_aniso_vectors(a, at, acc_float(fmin(acc_larger(ab, 1e-4), 3.2)));
    }
}

static void d_ggx_aniso_vectors_narrow(acc* a)
{
    for (int i = 0; i < 2 * COUNT; ++i) {
        float at = random_alpha(a, i, 3.2);
        compare_aniso_vectors(a, at, random_alpha(a, i / 2, 3.2));
    }
}

static vec upper(acc* a)
{
    vec d = direction(a);
    d.z = fabs(d.z) + 1e-6;
    return unit(d);
}

static void v_smith_ggx_aniso(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float at = random_alpha(a, i, 3.2), ab = random_alpha(a, i / 2, 3.2);
        hdrp_v3 l = rounded(upper(a)), v = rounded(upper(a));
        double reference = visibility(width(at), width(ab), vec_of(l), vec_of(v));
        ACC_ADD(
            a,
            relative(hdrp_brdf_v_smith_ggx_aniso(l.x, l.y, l.z, v.x, v.y, v.z, at, ab), reference),
            "n.l %.9g, n.v %.9g, widths %.9g %.9g", (double)l.z, (double)v.z, (double)at,
            (double)ab);
    }
}

/* D of the visible normals, G1 (v.h) D / n.v, over the Jacobian of the reflection. */
static void pdf_vndf(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float at = random_alpha(a, i, 3.2), ab = random_alpha(a, i / 2, 3.2);
        hdrp_v3 v = rounded(upper(a)), h = rounded(random_half(a, at, ab));
        vec dv = vec_of(v), dh = vec_of(h);
        double g1 = 1.0 / (1.0 + lambda(width(at), width(ab), dv.x, dv.y, dv.z));
        double d = d_from_slopes(dh.x / dh.z, dh.y / dh.z, dh.z * dh.z, width(at), width(ab));
        double c = dot(dv, dh), reference = g1 * c * d / dv.z / (4.0 * c);
        ACC_ADD(a, relative(hdrp_brdf_pdf_vndf(v, h, at, ab), reference),
                "n.v %.9g, widths %.9g %.9g", dv.z, (double)at, (double)ab);
    }
}

static void alphas_kulla(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float p = acc_float(acc_uniform(a, 0.01, 1.0));
        float k = i < 3 ? acc_float(i - 1) : acc_float(acc_uniform(a, -1.0, 1.0));
        double t = acc_larger((double)p * (double)p * (1.0 + (double)k), (double)HDRP_ALPHA_MIN);
        double b = acc_larger((double)p * (double)p * (1.0 - (double)k), (double)HDRP_ALPHA_MIN);
        hdrp_brdf_alphas m = hdrp_brdf_alphas_kulla(p, k);
        ACC_ADD(a, acc_larger(relative(m.t, t), relative(m.b, b)), "%.9g, %.9g", (double)p,
                (double)k);
    }
}

static void alphas_disney(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float p = acc_float(acc_uniform(a, 0.02, 1.0));
        float k = i < 3 ? acc_float(i - 1) : acc_float(acc_uniform(a, -1.0, 1.0));
        double log_aspect = 0.5 * log1p(-0.9 * fabs((double)k)), log_alpha = 2.0 * log((double)p);
        double wide = exp(log_alpha - log_aspect);
        double narrow = acc_larger(exp(log_alpha + log_aspect), (double)HDRP_ALPHA_MIN);
        hdrp_brdf_alphas m = hdrp_brdf_alphas_disney(p, k);
        double mw = (double)(k < 0.0f ? m.b : m.t), mn = (double)(k < 0.0f ? m.t : m.b);
        ACC_ADD(a, acc_larger(acc_relative(mw, wide), acc_relative(mn, narrow)), "%.9g, %.9g",
                (double)p, (double)k);
    }
}

static void kulla_from_alphas(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        hdrp_brdf_alphas w;
        w.t = acc_float(acc_log_uniform(a, 1e-4, 1.0));
        w.b = acc_float(acc_log_uniform(a, 1e-4, 1.0));
        hdrp_brdf_kulla k = hdrp_brdf_kulla_from_alphas(w);
        double mean = (double)k.perceptual_roughness * (double)k.perceptual_roughness;
        double t = mean * (1.0 + (double)k.anisotropy), b = mean * (1.0 - (double)k.anisotropy);
        ACC_ADD(a, acc_larger(fabs(t - (double)w.t), fabs(b - (double)w.b)) / mean, "%.9g, %.9g",
                (double)w.t, (double)w.b);
    }
}

const acc_entry acc_brdf_ggx[] = {
    {"brdf_alpha_from_perceptual_roughness", alpha_from_perceptual_roughness},
    {"brdf_half_vector", half_vector},
    {"brdf_sin2_between", sin2_between},
    {"brdf_d_ggx", d_ggx},
    {"brdf_d_ggx_vectors", d_ggx_vectors},
    {"brdf_d_ggx_unrounded", d_ggx_unrounded},
    {"brdf_v_smith_ggx", v_smith_ggx},
    {"brdf_dv_ggx", dv_ggx},
    {"brdf_dv_ggx_vectors", dv_ggx_vectors},
    {"brdf_v_smith_ggx_fast", v_smith_ggx_fast},
    {"brdf_d_ggx_aniso", d_ggx_aniso},
    {"brdf_d_ggx_aniso_vectors", d_ggx_aniso_vectors},
    {"brdf_d_ggx_aniso_vectors_narrow", d_ggx_aniso_vectors_narrow},
    {"brdf_v_smith_ggx_aniso", v_smith_ggx_aniso},
    {"brdf_pdf_vndf", pdf_vndf},
    {"brdf_alphas_kulla", alphas_kulla},
    {"brdf_alphas_disney", alphas_disney},
    {"brdf_kulla_from_alphas", kulla_from_alphas},
    {NULL, NULL},
};
