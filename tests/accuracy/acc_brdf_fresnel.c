/* acc_brdf_fresnel.c - accuracy of the Fresnel terms of hdrp_brdf_lobes.h.
 * SPDX-License-Identifier: MIT */
#include <complex.h>

#include "accuracy.h"

#include "hdrp_brdf_lobes.h"

#define COUNT 40000

static double relative(float measured, double reference)
{
    return acc_relative((double)measured, reference);
}

static double absolute(float measured, double reference)
{
    return fabs((double)measured - reference);
}

/* An angle's cosine: uniform, at grazing, or close to normal incidence. */
static float cosine(acc* a, int i)
{
    switch (i % 3) {
    case 0:
        return acc_float(acc_uniform(a, 0.0, 1.0));
    case 1:
        return acc_float(acc_log_uniform(a, 1e-9, 1.0));
    default:
        return acc_float(1.0 - acc_log_uniform(a, 1e-9, 1.0));
    }
}

static float unit_value(acc* a, int i)
{
    return i < 2 ? (float)i : cosine(a, i);
}

static void schlick_weight(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float u = unit_value(a, i);
        ACC_ADD(a, relative(hdrp_brdf_schlick_weight(u), pow(1.0 - (double)u, 5.0)), "u %.9g",
                (double)u);
    }
}

static void f_schlick(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float u = unit_value(a, i), f0 = unit_value(a, i / 2), f90 = unit_value(a, i / 3);
        double reference = (double)f0 + ((double)f90 - (double)f0) * pow(1.0 - (double)u, 5.0);
        ACC_ADD(a, absolute(hdrp_brdf_f_schlick(f0, f90, u), reference),
                "F0 %.9g, F90 %.9g, u %.9g", (double)f0, (double)f90, (double)u);
    }
}

/* Unpolarised reflectance from complex amplitudes: continuous through total reflection. */
static double reflectance(double cos_i, double complex eta)
{
    double complex cos_t = csqrt(1.0 - (1.0 - cos_i) * (1.0 + cos_i) / (eta * eta));
    double complex s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    double complex p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    double rs = cabs(s), rp = cabs(p);
    return 0.5 * (rs * rs + rp * rp);
}

static void compare_dielectric(acc* a, float c, float eta)
{
    double reference = eta == 1.0f ? 0.0 : reflectance((double)c, (double)eta);
    ACC_ADD(a, absolute(hdrp_brdf_f_dielectric_exact(c, eta), reference), "cosine %.9g, eta %.9g",
            (double)c, (double)eta);
}

static double critical_cosine(double eta)
{
    return sqrt(acc_larger((1.0 - eta) * (1.0 + eta), 0.0));
}

static void f_dielectric_exact(acc* a)
{
    for (int i = 0; i < 10 * COUNT; ++i) {
        float eta = acc_float(i % 5 ? acc_log_uniform(a, 0.25, 4.0)
                                    : 1.0 + (i % 2 ? -1.0 : 1.0) * acc_log_uniform(a, 1e-7, 0.5));
        float c = i < 2 ? (float)i : cosine(a, i);
        if (i % 3 == 0 && eta < 1.0f) { /* close to total reflection, where the slope is steep */
            double near_critical = critical_cosine((double)eta) + acc_log_uniform(a, 1e-3, 0.1);
            c = acc_float(fmin(near_critical, 1.0));
        }
        if (eta > 1.0f || fabs((double)c - critical_cosine((double)eta)) >= 1e-3) {
            compare_dielectric(a, c, eta);
        }
    }
}

static void f_dielectric_critical(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float eta = acc_float(acc_uniform(a, 0.25, 1.0));
        double off = i % 8 ? (i % 2 ? -1.0 : 1.0) * acc_log_uniform(a, 1e-9, 1e-3) : 0.0;
        double c = critical_cosine((double)eta) + off;
        compare_dielectric(a, acc_float(fmin(acc_larger(c, 0.0), 1.0)), eta);
    }
}

static void f_conductor_exact(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float eta = acc_float(i % 7 ? acc_log_uniform(a, 0.01, 20.0) : 1.0);
        float kappa = acc_float(acc_log_uniform(a, 0.01, 20.0));
        double close = critical_cosine(fmin((double)eta, 1.0));
        float c = i < 2 ? (float)i : i % 4 ? cosine(a, i) : acc_float(close);
        ACC_ADD(a,
                absolute(hdrp_brdf_f_conductor_exact(c, eta, kappa),
                         reflectance((double)c, (double)eta + (double)kappa * (double complex)I)),
                "cosine %.9g, eta %.9g, kappa %.9g", (double)c, (double)eta, (double)kappa);
    }
}

/* Reflected is what is not transmitted: 1 - 4 n1 n2 / (n1 + n2)^2. */
static double normal_incidence(double n1, double n2)
{
    double t = n1 / (n1 + n2);
    return 1.0 - 4.0 * t * (1.0 - t);
}

static void fresnel0_from_ior(acc* a)
{
    for (int i = 0; i < 50 * COUNT; ++i) {
        float outer = acc_float(i % 3 ? acc_log_uniform(a, 0.1, 10.0) : 1.0);
        float ior = acc_float(i % 2 ? acc_log_uniform(a, 0.1, 10.0) : acc_log_uniform(a, 1.0, 4e7));
        ACC_ADD(a,
                absolute(hdrp_brdf_fresnel0_from_ior(ior, outer),
                         normal_incidence((double)ior, (double)outer)),
                "IOR %.9g over %.9g", (double)ior, (double)outer);
    }
}

static void ior_from_fresnel0(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float f0 = unit_value(a, i);
        double back = normal_incidence((double)hdrp_brdf_ior_from_fresnel0(f0), 1.0);
        ACC_ADD(a, fabs(back - (double)f0), "F0 %.9g", (double)f0);
    }
}

/* By way of the IOR, which is infinite for F0 = 1. */
static double at_interface(double f0, double outer)
{
    double s = sqrt(f0), ior = (1.0 + s) / (1.0 - s);
    return f0 == 1.0 ? 1.0 : normal_incidence(ior, outer);
}

static void fresnel0_at_interface(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float f0 = unit_value(a, i), outer = acc_float(acc_uniform(a, 1.0, 3.0));
        ACC_ADD(a,
                absolute(hdrp_brdf_fresnel0_at_interface(f0, outer),
                         at_interface((double)f0, (double)outer)),
                "F0 %.9g, IOR %.9g", (double)f0, (double)outer);
    }
}

static void fresnel0_under_coat_fast(acc* a)
{
    for (int i = 0; i <= 10000; ++i) {
        float f0 = (float)i / 10000.0f;
        ACC_ADD(a, absolute(hdrp_brdf_fresnel0_under_coat_fast(f0), at_interface((double)f0, 1.5)),
                "F0 %.9g", (double)f0);
    }
}

static void fresnel0_under_coat_fast_upper(acc* a)
{
    for (int i = 400; i <= 10000; ++i) {
        float f0 = (float)i / 10000.0f;
        ACC_ADD(a, absolute(hdrp_brdf_fresnel0_under_coat_fast(f0), at_interface((double)f0, 1.5)),
                "F0 %.9g", (double)f0);
    }
}

static void refracted_cosine(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float c = unit_value(a, i);
        float eta = acc_float(i % 2 ? acc_log_uniform(a, 0.25, 4.0) : acc_log_uniform(a, 1.0, 4e7));
        double sine = sin(acos((double)c)) / (double)eta;
        double measured = (double)hdrp_brdf_refracted_cosine(c, eta);
        ACC_ADD(a, fabs(measured * measured - acc_larger(1.0 - sine * sine, 0.0)),
                "cosine %.9g, eta %.9g", (double)c, (double)eta);
    }
}

/* Against the two polarisations of Fresnel for IOR 1.5, by tangents and sines of the angles. */
static void f_schlick_dielectric(acc* a)
{
    for (int i = 1; i < 20000; ++i) {
        double t = 0.5 * 3.14159265358979323846 * i / 20000.0, r = asin(sin(t) / 1.5);
        double reference =
            0.5 * (pow(sin(t - r) / sin(t + r), 2.0) + pow(tan(t - r) / tan(t + r), 2.0));
        float u = acc_float(cos(t));
        ACC_ADD(a, absolute(hdrp_brdf_f_schlick(0.04f, 1.0f, u), reference), "u %.9g", (double)u);
    }
}

static void fresnel0_from_schlick(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float u = acc_float(acc_uniform(a, 0.1, 1.0));
        double weight = pow(1.0 - (double)u, 5.0);
        float f = acc_float(acc_uniform(a, weight, 1.0));
        double f0 = (double)hdrp_brdf_fresnel0_from_schlick(f, u);
        ACC_ADD(a, fabs(f0 + (1.0 - f0) * weight - (double)f), "F %.9g, u %.9g", (double)f,
                (double)u);
    }
}

const acc_entry acc_brdf_fresnel[] = {
    {"brdf_schlick_weight", schlick_weight},
    {"brdf_f_schlick", f_schlick},
    {"brdf_f_schlick_dielectric", f_schlick_dielectric},
    {"brdf_f_dielectric_exact", f_dielectric_exact},
    {"brdf_f_dielectric_critical", f_dielectric_critical},
    {"brdf_f_conductor_exact", f_conductor_exact},
    {"brdf_fresnel0_from_ior", fresnel0_from_ior},
    {"brdf_ior_from_fresnel0", ior_from_fresnel0},
    {"brdf_fresnel0_at_interface", fresnel0_at_interface},
    {"brdf_fresnel0_under_coat_fast", fresnel0_under_coat_fast},
    {"brdf_fresnel0_under_coat_fast_upper", fresnel0_under_coat_fast_upper},
    {"brdf_refracted_cosine", refracted_cosine},
    {"brdf_fresnel0_from_schlick", fresnel0_from_schlick},
    {NULL, NULL},
};
