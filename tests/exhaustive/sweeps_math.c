/* sweeps_math.c - functions of one float of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include "exhaustive.h"

#include "hdrp_math.h"
#include "planck.h"
#include "srgb_reference.h"

/* The references of the square roots and of the polynomials are the functions of libm in double. */

EX_VALUES(rsqrt, hdrp_rsqrt)
EX_ERROR(rsqrt, ex_relative(EX_Y(0), 1.0 / sqrt(x)))

EX_VALUES(rsqrt_fast, hdrp_rsqrt_fast)
EX_ERROR(rsqrt_fast, ex_relative(EX_Y(0), 1.0 / sqrt(x)))

EX_VALUES(acos_fast, hdrp_acos_fast)
EX_ERROR(acos_fast, ex_absolute(EX_Y(0), acos(x)))
EX_ERROR(acos_fast_relative, ex_relative(EX_Y(0), acos(x)))

EX_VALUES(acos_exact, hdrp_acos_exact)
EX_ERROR(acos_exact, ex_ulp(EX_Y(0), acos(x)))
EX_ERROR(acos_exact_absolute, ex_absolute(EX_Y(0), acos(x)))

EX_VALUES(exp2_fast, hdrp_exp2_fast)
EX_ERROR(exp2_fast, ex_relative(EX_Y(0), exp2(x)))

EX_VALUES(log2_fast, hdrp_log2_fast)
EX_ERROR(log2_fast, ex_relative(EX_Y(0), log2(x)))

static void sincos_values(const float* restrict x, float* restrict y, int n)
{
    for (int i = 0; i < n; ++i) {
        hdrp_sincos_result r = hdrp_sincos(x[i]);
        y[i] = r.sine;
        y[EX_BLOCK + i] = r.cosine;
    }
}
EX_ERROR(sincos, ex_larger(ex_absolute(EX_Y(0), sin(x)), ex_absolute(EX_Y(1), cos(x))))

static void sincos_fast_values(const float* restrict x, float* restrict y, int n)
{
    for (int i = 0; i < n; ++i) {
        hdrp_sincos_result r = hdrp_sincos_fast(x[i]);
        y[i] = r.sine;
        y[EX_BLOCK + i] = r.cosine;
    }
}
EX_ERROR(sincos_fast_sine, ex_absolute(EX_Y(0), sin(x)))
EX_ERROR(sincos_fast_cosine, ex_absolute(EX_Y(1), cos(x)))

EX_VALUES(linear_from_srgb, hdrp_linear_from_srgb)
EX_ERROR(linear_from_srgb, ex_relative(EX_Y(0), linear_from_srgb(x)))
EX_ERROR(linear_from_srgb_hdr, ex_relative(EX_Y(0), linear_from_srgb(x)))

EX_VALUES(srgb_from_linear, hdrp_srgb_from_linear)
EX_ERROR(srgb_from_linear, ex_relative(EX_Y(0), srgb_from_linear(x)))
EX_ERROR(srgb_from_linear_absolute, ex_absolute(EX_Y(0), srgb_from_linear(x)))

EX_VALUES(linear_from_srgb_fast, hdrp_linear_from_srgb_fast)
EX_ERROR(linear_from_srgb_fast, ex_relative(EX_Y(0), linear_from_srgb(x)))
EX_ERROR(linear_from_srgb_fast_absolute, ex_absolute(EX_Y(0), linear_from_srgb(x)))

EX_VALUES(srgb_from_linear_fast, hdrp_srgb_from_linear_fast)
EX_ERROR(srgb_from_linear_fast, ex_absolute(EX_Y(0), srgb_from_linear(x)))

static double kelvin_error(double kelvin, const float* y, const double observer[CIE_COUNT][3],
                           bool whiten)
{
    double rgb[3];
    planck_rec709(kelvin, observer, whiten, rgb);
    return ex_larger(ex_absolute(EX_Y(0), rgb[0]),
                     ex_larger(ex_absolute(EX_Y(1), rgb[1]), ex_absolute(EX_Y(2), rgb[2])));
}

static void rec709_from_kelvin_values(const float* restrict x, float* restrict y, int n)
{
    for (int i = 0; i < n; ++i) {
        hdrp_v3 c = hdrp_rec709_from_kelvin(x[i]);
        y[i] = c.x;
        y[EX_BLOCK + i] = c.y;
        y[2 * EX_BLOCK + i] = c.z;
    }
}
EX_ERROR(rec709_from_kelvin, kelvin_error(x, y, cie_1931_2_degree, false))

static void rec709_from_kelvin_fast_values(const float* restrict x, float* restrict y, int n)
{
    for (int i = 0; i < n; ++i) {
        hdrp_v3 c = hdrp_rec709_from_kelvin_fast(x[i]);
        y[i] = c.x;
        y[EX_BLOCK + i] = c.y;
        y[2 * EX_BLOCK + i] = c.z;
    }
}
EX_ERROR(rec709_from_kelvin_fast_1964, kelvin_error(x, y, cie_1964_10_degree, true))
EX_ERROR(rec709_from_kelvin_fast_1931, kelvin_error(x, y, cie_1931_2_degree, false))

EX_VALUES(hemisphere_cosine_pdf, hdrp_hemisphere_cosine_pdf)
EX_ERROR(hemisphere_cosine_pdf, ex_relative(EX_Y(0), fmax(x, 0.0) / EX_PI))

/* Relative errors end where a result would be denormal. */
const ex_sweep ex_sweeps_math[] = {
    EX_SWEEP(hdrp_rsqrt, rsqrt, EX_CLAIM(rsqrt, 1e-45f, FLT_MAX)),
    EX_SWEEP(hdrp_rsqrt_fast, rsqrt_fast, EX_CLAIM(rsqrt_fast, FLT_MIN, FLT_MAX)),
    EX_SWEEP(hdrp_acos_fast, acos_fast, EX_CLAIM(acos_fast, -1.0f, 1.0f),
             EX_CLAIM(acos_fast_relative, 0.0f, 1.0f)),
    EX_SWEEP(hdrp_acos_exact, acos_exact, EX_CLAIM(acos_exact, -1.0f, 1.0f),
             EX_CLAIM(acos_exact_absolute, -1.0f, 1.0f)),
    EX_SWEEP(hdrp_exp2_fast, exp2_fast, EX_CLAIM(exp2_fast, -126.0f, 127.999992f)),
    EX_SWEEP(hdrp_log2_fast, log2_fast, EX_CLAIM(log2_fast, 1e-45f, FLT_MAX)),
    {"hdrp_sincos", "", 2, sincos_values, {EX_CLAIM(sincos, -8192.0f, 8192.0f)}},
    {"hdrp_sincos_fast",
     "",
     2,
     sincos_fast_values,
     {EX_CLAIM(sincos_fast_sine, -8192.0f, 8192.0f),
      EX_CLAIM(sincos_fast_cosine, -8192.0f, 8192.0f)}},
    EX_SWEEP(hdrp_linear_from_srgb, linear_from_srgb, EX_CLAIM(linear_from_srgb, 2.4e-37f, 1.0f),
             EX_CLAIM(linear_from_srgb_hdr, 1.0f, 1e16f)),
    EX_SWEEP(hdrp_srgb_from_linear, srgb_from_linear, EX_CLAIM(srgb_from_linear, 9.1e-39f, FLT_MAX),
             EX_CLAIM(srgb_from_linear_absolute, 0.0f, 1.0f)),
    EX_SWEEP(hdrp_linear_from_srgb_fast, linear_from_srgb_fast,
             EX_CLAIM(linear_from_srgb_fast, 2.4e-37f, 1.0f),
             EX_CLAIM(linear_from_srgb_fast_absolute, 0.0f, 1.0f)),
    EX_SWEEP(hdrp_srgb_from_linear_fast, srgb_from_linear_fast,
             EX_CLAIM(srgb_from_linear_fast, 0.0f, 1.0f)),
    {"hdrp_rec709_from_kelvin",
     "",
     3,
     rec709_from_kelvin_values,
     {EX_CLAIM(rec709_from_kelvin, 1000.0f, 40000.0f)}},
    {"hdrp_rec709_from_kelvin_fast",
     "",
     3,
     rec709_from_kelvin_fast_values,
     {EX_CLAIM(rec709_from_kelvin_fast_1964, 1000.0f, 40000.0f),
      EX_CLAIM(rec709_from_kelvin_fast_1931, 1000.0f, 40000.0f)}},
    EX_SWEEP(hdrp_hemisphere_cosine_pdf, hemisphere_cosine_pdf,
             EX_CLAIM(hemisphere_cosine_pdf, 4e-38f, 1.0f)),
    {NULL, NULL, 0, NULL, {EX_NO_CLAIM}},
};
