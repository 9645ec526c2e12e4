/* acc_math_fast.c - accuracy of the fast math of hdrp_math.h against libm in double precision.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_math.h"

/* Strides through the bit patterns of floats: odd, so that mantissas vary, and about 5e5 steps. */
#define STRIDE 4099u

static void rsqrt_error(acc* a)
{
    for (uint32_t u = 1u; u < 0x7f800000u; u += STRIDE) {
        float x = hdrp_f32_from_bits(u);
        ACC_ADD(a, acc_relative((double)hdrp_rsqrt(x), 1.0 / sqrt((double)x)), "x = %.9g",
                (double)x);
    }
}

static void rsqrt_fast_error(acc* a)
{
    /* Every mantissa of two octaves: the others repeat them. */
    for (uint32_t u = 0x3f800000u; u < 0x40800000u; u += 31u) {
        float x = hdrp_f32_from_bits(u);
        ACC_ADD(a, acc_relative((double)hdrp_rsqrt_fast(x), 1.0 / sqrt((double)x)), "x = %.9g",
                (double)x);
    }
    for (uint32_t u = 0x00800000u; u < 0x7f800000u; u += STRIDE) {
        float x = hdrp_f32_from_bits(u);
        ACC_ADD(a, acc_relative((double)hdrp_rsqrt_fast(x), 1.0 / sqrt((double)x)), "x = %.9g",
                (double)x);
    }
}

static float acos_input(acc* a, int i)
{
    double magnitude = i % 2 ? acc_uniform(a, 0.0, 1.0) : 1.0 - acc_log_uniform(a, 1e-8, 1.0);
    return (float)magnitude;
}

static void acos_absolute(acc* a, float (*f)(float))
{
    for (int i = 0; i < 400000; ++i) {
        float x = acos_input(a, i) * (i % 3 ? 1.0f : -1.0f);
        ACC_ADD(a, fabs((double)f(x) - acos((double)x)), "x = %.9g", (double)x);
    }
}

static void acos_fast_error(acc* a)
{
    acos_absolute(a, hdrp_acos_fast);
}

static void acos_absolute_error(acc* a)
{
    acos_absolute(a, hdrp_acos);
}

static void acos_exact_absolute_error(acc* a)
{
    acos_absolute(a, hdrp_acos_exact);
}

static void acos_fast_relative_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        float x = acos_input(a, i);
        ACC_ADD(a, acc_relative((double)hdrp_acos_fast(x), acos((double)x)), "x = %.9g", (double)x);
    }
}

static void atan2_absolute(acc* a, float (*f)(float, float))
{
    for (int i = 0; i < 400000; ++i) {
        double angle = acc_uniform(a, -3.2, 3.2), radius = acc_log_uniform(a, 1e-36, 3e38);
        float x = acc_float(cos(angle) * radius), y = acc_float(sin(angle) * radius);
        ACC_ADD(a, fabs((double)f(y, x) - atan2((double)y, (double)x)), "y = %.9g, x = %.9g",
                (double)y, (double)x);
    }
}

static void atan2_fast_error(acc* a)
{
    atan2_absolute(a, hdrp_atan2_fast);
}

static void atan2_absolute_error(acc* a)
{
    atan2_absolute(a, hdrp_atan2);
}

static void atan2_exact_absolute_error(acc* a)
{
    atan2_absolute(a, hdrp_atan2_exact);
}

static void atan2_fast_relative_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        float x = acc_float(acc_log_uniform(a, 1e-3, 1e3));
        float y = x * acc_float(acc_log_uniform(a, 1e-9, 1e6) * (i % 2 ? 1.0 : -1.0));
        ACC_ADD(a, acc_relative((double)hdrp_atan2_fast(y, x), atan2((double)y, (double)x)),
                "y = %.9g, x = %.9g", (double)y, (double)x);
    }
}

static void acos_exact_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        float x = acos_input(a, i) * (i % 3 ? 1.0f : -1.0f);
        ACC_ADD(a, acc_ulp((double)hdrp_acos_exact(x), acos((double)x)), "x = %.9g", (double)x);
    }
    for (uint32_t u = 0x3eff0000u; u < 0x3f010000u; u += 7u) { /* where two pieces meet */
        float x = hdrp_f32_from_bits(u);
        ACC_ADD(a, acc_ulp((double)hdrp_acos_exact(x), acos((double)x)), "x = %.9g", (double)x);
    }
}

static void atan2_exact_error(acc* a)
{
    for (int i = 0; i < 600000; ++i) {
        float x = (float)acc_log_uniform(a, 1e-3, 1e3) * (i % 3 ? 1.0f : -1.0f);
        float y = x * (float)(acc_log_uniform(a, 1e-9, 1e6) * (i % 2 ? 1.0 : -1.0));
        if (i < 2) { /* the worst that searches of 6e7 found, without and with FMA */
            y = i == 0 ? 0.19327119f : 0.219246507f;
            x = i == 0 ? 1.54520273f : 1.74854493f;
        }
        ACC_ADD(a, acc_ulp((double)hdrp_atan2_exact(y, x), atan2((double)y, (double)x)),
                "y = %.9g, x = %.9g", (double)y, (double)x);
    }
}

static void exp2_relative(acc* a, float (*f)(float))
{
    for (int i = 0; i < 800000; ++i) {
        float x = i % 2 ? acc_float(acc_uniform(a, -126.0, 127.9999))
                        : acc_float(acc_uniform(a, -1.5, 1.5));
        ACC_ADD(a, acc_relative((double)f(x), exp2((double)x)), "x = %.9g", (double)x);
    }
}

static void exp2_fast_error(acc* a)
{
    exp2_relative(a, hdrp_exp2_fast);
}

static void exp2_relative_error(acc* a)
{
    exp2_relative(a, hdrp_exp2);
}

static void log2_relative(acc* a, float (*f)(float))
{
    for (uint32_t u = 1u; u < 0x7f800000u; u += STRIDE) {
        float x = hdrp_f32_from_bits(u);
        ACC_ADD(a, acc_relative((double)f(x), log2((double)x)), "x = %.9g", (double)x);
    }
    for (int i = 0; i < 400000; ++i) { /* around 1, where the logarithm vanishes */
        float x = acc_float(1.0 + acc_log_uniform(a, 1e-7, 1.0) * (i % 2 ? 1.0 : -0.5));
        ACC_ADD(a, acc_relative((double)f(x), log2((double)x)), "x = %.9g", (double)x);
    }
}

static void log2_fast_error(acc* a)
{
    log2_relative(a, hdrp_log2_fast);
}

static void log2_relative_error(acc* a)
{
    log2_relative(a, hdrp_log2);
}

static void pow_relative(acc* a, float (*f)(float, float))
{
    for (int i = 0; i < 400000; ++i) {
        float x = acc_float(acc_log_uniform(a, 1.5e-45, 3.4e38));
        double l = log2((double)x), exponent = acc_uniform(a, -125.9, 127.9);
        float y = acc_float(exponent / l);
        double reference = pow((double)x, (double)y);
        if (reference > 1.2e-38 && reference < 3.4e38) {
            ACC_ADD(a, acc_relative((double)f(x, y), reference), "x = %.9g, y = %.9g", (double)x,
                    (double)y);
        }
    }
}

static void pow_fast_error(acc* a)
{
    pow_relative(a, hdrp_pow_fast);
}

static void pow_relative_error(acc* a)
{
    pow_relative(a, hdrp_pow);
}

static void pow_fast_colour_error(acc* a)
{
    for (int i = 0; i < 800000; ++i) {
        double darkest = i % 2 ? 1e-2 : 1.0; /* the exponent and its rounding are largest there */
        float x = fmaxf(
            acc_float(i % 4 < 2 ? acc_uniform(a, 1e-3, darkest) : acc_log_uniform(a, 1e-3, 1.0)),
            1e-3f);
        float y = acc_float(i % 2 ? acc_uniform(a, 2.0, 2.5) : acc_uniform(a, 0.3, 2.5));
        if (i < 2) { /* the worst that searches of 6e7 found */
            x = i == 0 ? 0.00143253535f : 0.00259380531f;
            y = i == 0 ? 2.36061811f : 2.39744878f;
        }
        ACC_ADD(a, acc_relative((double)hdrp_pow_fast(x, y), pow((double)x, (double)y)),
                "x = %.9g, y = %.9g", (double)x, (double)y);
    }
}

/* Small angles, the whole range, and floats next to multiples of a quarter turn. */
static float angle(acc* a, int i)
{
    double x = acc_uniform(a, -8192.0, 8192.0);
    if (i % 3 == 1) {
        x = acc_uniform(a, -7.0, 7.0);
    } else if (i % 3 == 2) {
        x = floor(x * 0.63) * 1.57079632679489661923 + acc_uniform(a, -1e-3, 1e-3);
    }
    return (float)x;
}

static void sincos_error(acc* a)
{
    for (int i = 0; i < 500000; ++i) {
        float x = angle(a, i);
        hdrp_sincos_result r = hdrp_sincos(x);
        ACC_ADD(a,
                acc_larger(fabs((double)r.sine - sin((double)x)),
                           fabs((double)r.cosine - cos((double)x))),
                "x = %.9g", (double)x);
    }
}

static void sincos_fast_sine_error(acc* a)
{
    for (int i = 0; i < 500000; ++i) {
        float x = angle(a, i);
        ACC_ADD(a, fabs((double)hdrp_sincos_fast(x).sine - sin((double)x)), "x = %.9g", (double)x);
    }
}

static void sincos_fast_cosine_error(acc* a)
{
    for (int i = 0; i < 500000; ++i) {
        float x = angle(a, i);
        ACC_ADD(a, fabs((double)hdrp_sincos_fast(x).cosine - cos((double)x)), "x = %.9g",
                (double)x);
    }
}

const acc_entry acc_math_fast[] = {
    {"rsqrt", rsqrt_error},
    {"rsqrt_fast", rsqrt_fast_error},
    {"acos_fast", acos_fast_error},
    {"acos_fast_relative", acos_fast_relative_error},
    {"atan2_fast", atan2_fast_error},
    {"atan2_fast_relative", atan2_fast_relative_error},
    {"acos_exact", acos_exact_error},
    {"acos_exact_absolute", acos_exact_absolute_error},
    {"atan2_exact", atan2_exact_error},
    {"atan2_exact_absolute", atan2_exact_absolute_error},
    {"exp2_fast", exp2_fast_error},
    {"log2_fast", log2_fast_error},
    {"pow_fast", pow_fast_error},
    {"pow_fast_colour", pow_fast_colour_error},
    {"sincos", sincos_error},
    {"sincos_fast_sine", sincos_fast_sine_error},
    {"sincos_fast_cosine", sincos_fast_cosine_error},
    {"acos_absolute", acos_absolute_error},
    {"atan2_absolute", atan2_absolute_error},
    {"exp2_relative", exp2_relative_error},
    {"log2_relative", log2_relative_error},
    {"pow_relative", pow_relative_error},
    {NULL, NULL},
};
