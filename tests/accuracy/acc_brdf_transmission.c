/* acc_brdf_transmission.c - accuracy of refraction in hdrp_brdf_lobes.h.
 * SPDX-License-Identifier: MIT
 *
 * Directions are referred to angles in the plane of incidence, the rough interface to complex
 * amplitudes, slopes and Smith's Lambda. */
#include <complex.h>

#include "accuracy.h"

#include "hdrp_brdf_lobes.h"

#define PI    3.14159265358979323846
#define COUNT 40000

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalize(double v[3])
{
    double s = 1.0 / sqrt(dot(v, v));
    for (int k = 0; k < 3; ++k) {
        v[k] *= s;
    }
}

static hdrp_v3 rounded(const double v[3])
{
    return hdrp_v3_make(acc_float(v[0]), acc_float(v[1]), acc_float(v[2]));
}

static void widen(hdrp_v3 v, double out[3])
{
    out[0] = (double)v.x;
    out[1] = (double)v.y;
    out[2] = (double)v.z;
}

/* A direction whose cosine with the unit n is given, in a random plane. */
static void around(acc* a, const double n[3], double cosine, double out[3])
{
    double side[3], d[3];
    acc_direction(a, d);
    for (int k = 0; k < 3; ++k) {
        side[k] = d[k] - n[k] * dot(n, d);
    }
    normalize(side);
    for (int k = 0; k < 3; ++k) {
        out[k] = n[k] * cosine + side[k] * sqrt(1.0 - cosine * cosine);
    }
}

static void refract(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        double n[3], v[3], side[3];
        acc_direction(a, n);
        hdrp_v3 fn = rounded(n);
        widen(fn, n);
        normalize(n);
        around(a, n, acc_uniform(a, 0.0, 1.0), v);
        hdrp_v3 fv = rounded(v);
        widen(fv, v);
        normalize(v);
        float eta = acc_float(acc_log_uniform(a, 0.25, 4.0));
        double angle = acos(fmin(dot(n, v), 1.0)), sine = (double)eta * sin(angle);
        if (sine > 0.999 || dot(n, v) > 0.9999999) {
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            side[k] = v[k] - n[k] * dot(n, v);
        }
        normalize(side);
        double beyond = asin(sine), error = 0.0, m[3];
        widen(hdrp_brdf_refract(fv, fn, eta).direction, m);
        for (int k = 0; k < 3; ++k) {
            double r = -n[k] * cos(beyond) - side[k] * sin(beyond);
            error = acc_larger(error, fabs(m[k] - r));
        }
        ACC_ADD(a, error, "angle %.9g, eta %.9g", angle, (double)eta);
    }
}

static void volume_transmittance(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float color = acc_float(i % 3 ? acc_uniform(a, 0.0, 1.0) : acc_log_uniform(a, 1e-37, 1.0));
        float at = acc_float(acc_log_uniform(a, 1e-4, 1e4));
        float d = acc_float((double)at * acc_log_uniform(a, 1e-4, 1e2));
        double reference = exp(log((double)color) * ((double)d / (double)at));
        float m = hdrp_brdf_volume_transmittance(hdrp_v3_splat(color), at, d).y;
        ACC_ADD(a, fabs((double)m - reference), "colour %.9g, %.9g of %.9g m", (double)color,
                (double)d, (double)at);
    }
}

static double transmission(double cos_i, double eta)
{
    double complex cos_t = csqrt(1.0 - (1.0 - cos_i * cos_i) / (eta * eta));
    double complex s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    double complex p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 1.0 - 0.5 * creal(s * conj(s) + p * conj(p));
}

static double lambda(double alpha, double cosine)
{
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)) - 1.0);
}

/* Density of light in l per projected solid angle, from that of half vectors and the change of
 * variables between both. */
static void btdf_ggx(acc* a)
{
    const double n[3] = {0.0, 0.0, 1.0};
    for (int i = 0; i < COUNT; ++i) {
        double v[3], h[3], l[3], eta = acc_log_uniform(a, 0.4, 2.5);
        float alpha = acc_float(acc_log_uniform(a, 0.05, 1.0));
        double slope = (double)alpha * acc_log_uniform(a, 1e-2, 5.0);
        around(a, n, acc_uniform(a, 0.05, 1.0), v);
        around(a, n, 1.0 / sqrt(1.0 + slope * slope), h);
        double c = dot(v, h), k = 1.0 - (1.0 - c * c) / (eta * eta);
        if (fabs(eta - 1.0) < 0.05 || c <= 0.05 || k <= 0.01) {
            continue;
        }
        for (int j = 0; j < 3; ++j) {
            l[j] = h[j] * (c / eta - sqrt(k)) - v[j] / eta;
        }
        hdrp_v3 fv = rounded(v), fl = rounded(l);
        widen(fv, v);
        widen(fl, l);
        if (l[2] > -0.05) {
            continue;
        }
        /* The half vector of the rounded directions. */
        float feta = acc_float(eta);
        eta = (double)feta;
        for (int j = 0; j < 3; ++j) {
            h[j] = v[j] + eta * l[j];
        }
        normalize(h);
        if (h[2] < 0.0) {
            h[0] = -h[0];
            h[1] = -h[1];
            h[2] = -h[2];
        }
        double vh = dot(v, h), lh = -dot(l, h), al = (double)alpha;
        if (vh <= 0.01 || lh <= 0.01) {
            continue;
        }
        double tan2 = 1.0 / (h[2] * h[2]) - 1.0, s = 1.0 + tan2 / (al * al);
        double d = 1.0 / (PI * al * al * s * s * pow(h[2], 4.0));
        double g = 1.0 / (1.0 + lambda(al, v[2]) + lambda(al, -l[2]));
        /* Length of v + eta l, which turns by d(omega_h) = (eta / length)^2 l.h d(omega_l). */
        double length = fabs(vh - eta * lh), jacobian = eta * eta * lh / (length * length);
        double reference = transmission(vh, eta) * d * g * vh * jacobian / v[2];
        float m = hdrp_brdf_btdf_ggx(hdrp_v3_make(0.0f, 0.0f, 1.0f), fv, fl, alpha, feta);
        ACC_ADD(a, acc_relative((double)m, reference), "n.v %.6g, n.l %.6g, alpha %.6g, eta %.6g",
                v[2], l[2], al, eta);
    }
}

const acc_entry acc_brdf_transmission[] = {
    {"brdf_refract", refract},
    {"brdf_volume_transmittance", volume_transmittance},
    {"brdf_btdf_ggx", btdf_ggx},
    {NULL, NULL},
};
