/* acc_math_built_in.c - what the single-precision functions of libm lose against those in double.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_math.h"

#define COUNT 300000

typedef float function(float x);
typedef double reference(double x);

static void compare(acc* a, function* f, reference* r, float x)
{
    ACC_ADD(a, acc_ulp((double)f(x), r((double)x)), "x = %.9g", (double)x);
}

/* Either sign of a magnitude: uniform, or in powers of ten. */
static float magnitude(acc* a, int i, double lo, double hi)
{
    double x = i % 2 ? acc_uniform(a, lo, hi) : acc_log_uniform(a, lo, hi);
    return acc_float(i % 4 < 2 ? x : -x);
}

static void sqrt_error(acc* a)
{
    for (uint32_t u = 1u; u < 0x7f800000u; u += 4099u) {
        compare(a, hdrp_sqrt, sqrt, hdrp_f32_from_bits(u));
    }
}

/* Angles of some turns, and some large ones. */
static float angle(acc* a, int i)
{
    return magnitude(a, i, 1e-30, i % 8 == 7 ? 1e30 : 1e3);
}

static void sin_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_sin, sin, angle(a, i));
    }
}

static void cos_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_cos, cos, angle(a, i));
    }
}

static void tan_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_tan, tan, angle(a, i));
    }
}

static void asin_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_asin, asin, magnitude(a, i, 1e-30, 1.0));
    }
}

static void acos_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_acos, acos, magnitude(a, i, 1e-30, 1.0));
        compare(a, hdrp_acos, acos, acc_float(1.0 - acc_log_uniform(a, 1e-8, 1.0)));
    }
}

static void atan2_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        double phi = acc_uniform(a, -3.2, 3.2), radius = acc_log_uniform(a, 1e-30, 3e38);
        float x = acc_float(cos(phi) * radius), y = acc_float(sin(phi) * radius);
        ACC_ADD(a, acc_ulp((double)hdrp_atan2(y, x), atan2((double)y, (double)x)),
                "y = %.9g, x = %.9g", (double)y, (double)x);
    }
}

static void exp_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_exp, exp, magnitude(a, i, 1e-8, 87.3));
    }
}

static void exp2_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_exp2, exp2, magnitude(a, i, 1e-8, 126.0));
    }
}

static float positive(acc* a, int i)
{
    return acc_float(i % 2 ? acc_log_uniform(a, 1e-45, 3e38) : 1.0 + acc_uniform(a, -0.6, 1.0));
}

static void log_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_log, log, positive(a, i));
    }
}

static void log2_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        compare(a, hdrp_log2, log2, positive(a, i));
    }
}

static void pow_error(acc* a)
{
    for (int i = 0; i < COUNT; ++i) {
        float x = acc_float(acc_log_uniform(a, 1e-37, 1e38));
        float y = acc_float(acc_uniform(a, -125.0, 127.0) / log2((double)x));
        double r = pow((double)x, (double)y);
        if (r > 1.2e-38 && r < 3.4e38) {
            ACC_ADD(a, acc_ulp((double)hdrp_pow(x, y), r), "x = %.9g, y = %.9g", (double)x,
                    (double)y);
        }
    }
}

const acc_entry acc_math_built_in[] = {
    {"sqrt", sqrt_error}, {"sin", sin_error},   {"cos", cos_error},     {"tan", tan_error},
    {"asin", asin_error}, {"acos", acos_error}, {"atan2", atan2_error}, {"exp", exp_error},
    {"exp2", exp2_error}, {"log", log_error},   {"log2", log2_error},   {"pow", pow_error},
    {NULL, NULL},
};
