/* sweeps_pack.c - encoders of one float of hdrp_pack.h, for fixed widths where a width is an
 * argument.
 * SPDX-License-Identifier: MIT */
#include "exhaustive.h"

#include "hdrp_pack.h"

static const unsigned widths[4] = {8u, 10u, 12u, 16u};

static void pack_unorm_codes_values(const float* restrict x, float* restrict y, int n)
{
    for (int k = 0; k < 4; ++k) {
        for (int i = 0; i < n; ++i) {
            y[k * EX_BLOCK + i] = (float)hdrp_pack_unorm_from_float(x[i], widths[k]);
        }
    }
}

/* 24 + 16 bits: the product is exact. */
static double pack_unorm_codes_error(double x, const float* y)
{
    double v = ex_clamp(x, 0.0, 1.0), worst = 0.0;
    for (int k = 0; k < 4; ++k) {
        worst = ex_larger(worst, fabs(EX_Y(k) - v * ((double)(1u << widths[k]) - 1.0)));
    }
    return worst;
}
EX_ERRORS(pack_unorm_codes)

static void pack_snorm_codes_values(const float* restrict x, float* restrict y, int n)
{
    for (int k = 0; k < 4; ++k) {
        for (int i = 0; i < n; ++i) {
            y[k * EX_BLOCK + i] = (float)hdrp_pack_snorm_from_float(x[i], widths[k]);
        }
    }
}

static double pack_snorm_codes_error(double x, const float* y)
{
    double v = ex_clamp(x, -1.0, 1.0), worst = 0.0;
    for (int k = 0; k < 4; ++k) {
        double last = (double)(1u << (widths[k] - 1u)) - 1.0, code = EX_Y(k);
        code -= code > last ? 2.0 * (last + 1.0) : 0.0;
        worst = ex_larger(worst, fabs(code - v * last));
    }
    return worst;
}
EX_ERRORS(pack_snorm_codes)

static void pack_biased_snorm_8_values(const float* restrict x, float* restrict y, int n)
{
    for (int i = 0; i < n; ++i) {
        y[i] = hdrp_pack_biased_snorm_target(x[i], 8u);
    }
}
/* The target stores a whole code, of which 128 is 0. */
EX_ERROR(pack_biased_snorm_8, ex_absolute((nearbyint(EX_Y(0) * 255.0) - 128.0) / 127.0, x))

EX_VALUES(pack_srgb8_codes, hdrp_pack_srgb8_from_linear)
static double pack_srgb8_codes_error(double x, const float* y)
{
    double code = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return ex_absolute(EX_Y(0), code * 255.0);
}
EX_ERRORS(pack_srgb8_codes)

#define MIN_NORMAL 6.10351562e-5f /* 2^-14, of five exponent bits */

/* What a code of five exponent bits is by the definition of the format. */
static double small_float(uint32_t code, int mantissa_bits)
{
    int exponent = (int)(code >> mantissa_bits);
    double mantissa = ldexp((double)(code & ((1u << mantissa_bits) - 1u)), -mantissa_bits);
    return exponent == 0 ? ldexp(mantissa, -14) : ldexp(1.0 + mantissa, exponent - 15);
}

static double half_value(double code)
{
    uint32_t u = (uint32_t)code;
    return (u & 0x8000u ? -1.0 : 1.0) * small_float(u & 0x7fffu, 10);
}

/* The multiple of the format's last place nearest to x, the even one where two are. */
static double nearest(double x, int mantissa_bits)
{
    double place = ldexp(ex_larger(ex_binade(x), (double)MIN_NORMAL), -mantissa_bits);
    return rint(x / place) * place;
}

EX_VALUES(pack_half, hdrp_pack_half_from_float)
EX_ERROR(pack_half, ex_relative(half_value(EX_Y(0)), x))
EX_ERROR(pack_half_denormal, ex_absolute(half_value(EX_Y(0)), x))
EX_ERROR(half_rounding, ex_absolute(half_value(EX_Y(0)), nearest(x, 10)))

EX_VALUES(half_saturated, hdrp_pack_half_from_float_saturated)
static double half_saturated_error(double x, const float* y)
{
    double limited = ex_clamp(x, -65504.0, 65504.0);
    return ex_absolute(EX_Y(0), (double)hdrp_pack_half_from_float((float)limited));
}
EX_ERRORS(half_saturated)

static void small_float_values(const float* restrict x, float* restrict y, int n)
{
    for (int i = 0; i < n; ++i) {
        hdrp_u32 texel = hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(x[i], x[i], x[i]));
        y[i] = (float)(texel & 2047u);
        y[EX_BLOCK + i] = (float)((texel >> 11u) & 2047u);
        y[2 * EX_BLOCK + i] = (float)(texel >> 22u);
    }
}
static double pack_r11_error(double x, const float* y)
{
    return y[0] == y[EX_BLOCK] ? ex_relative(small_float((uint32_t)y[0], 6), x) : HUGE_VAL;
}
EX_ERRORS(pack_r11)
EX_ERROR(pack_b10, ex_relative(small_float((uint32_t)EX_Y(2), 5), x))
static double small_rounding_error(double x, const float* y)
{
    double v = ex_larger(x, 0.0);
    double red = ex_absolute(small_float((uint32_t)y[0], 6), nearest(v, 6));
    double blue = ex_absolute(small_float((uint32_t)y[2 * EX_BLOCK], 5), nearest(v, 5));
    return ex_larger(red, blue);
}
EX_ERRORS(small_rounding)

static void float_uint_values(const float* x, float* y, int n, hdrp_u32 bits, hdrp_u32 number)
{
    for (int i = 0; i < n; ++i) {
        y[i] = (float)hdrp_pack_float_uint_code(x[i], number, bits, 8u);
    }
}
static void pack_float_uint_3_of_8_values(const float* restrict x, float* restrict y, int n)
{
    float_uint_values(x, y, n, 3u, 5u);
}
EX_ERROR(pack_float_uint_3_of_8, ex_absolute((EX_Y(0) - 32.0 * 5.0) / 31.0, x))
static void pack_float_uint_4_of_8_values(const float* restrict x, float* restrict y, int n)
{
    float_uint_values(x, y, n, 4u, 10u);
}
EX_ERROR(pack_float_uint_4_of_8, ex_absolute((EX_Y(0) - 16.0 * 10.0) / 15.0, x))

const ex_sweep ex_sweeps_pack[] = {
    {"hdrp_pack_unorm_from_float",
     "at 8 10 12 and 16 bits",
     4,
     pack_unorm_codes_values,
     {EX_CLAIM(pack_unorm_codes, 0.0f, 1.0f), EX_CLAIM(pack_unorm_codes, -FLT_MAX, FLT_MAX)}},
    {"hdrp_pack_snorm_from_float",
     "at 8 10 12 and 16 bits",
     4,
     pack_snorm_codes_values,
     {EX_CLAIM(pack_snorm_codes, -1.0f, 1.0f), EX_CLAIM(pack_snorm_codes, -FLT_MAX, FLT_MAX)}},
    {"hdrp_pack_biased_snorm_target",
     "at 8 bits",
     1,
     pack_biased_snorm_8_values,
     {EX_CLAIM(pack_biased_snorm_8, -1.0f, 1.0f)}},
    EX_SWEEP(hdrp_pack_srgb8_from_linear, pack_srgb8_codes, EX_CLAIM(pack_srgb8_codes, 0.0f, 1.0f)),
    EX_SWEEP(hdrp_pack_half_from_float, pack_half, EX_CLAIM(pack_half, MIN_NORMAL, 65519.9961f),
             EX_CLAIM(pack_half_denormal, -MIN_NORMAL, MIN_NORMAL),
             EX_STATED(half_rounding, 0.0, "absolute", -65519.9961f, 65519.9961f)),
    EX_SWEEP(hdrp_pack_half_from_float_saturated, half_saturated,
             EX_STATED(half_saturated, 0.0, "absolute", -INFINITY, INFINITY)),
    {"hdrp_pack_r11g11b10f_from_rgb",
     "in every channel",
     3,
     small_float_values,
     {EX_CLAIM(pack_r11, MIN_NORMAL, 65024.0f), EX_CLAIM(pack_b10, MIN_NORMAL, 64512.0f),
      EX_STATED(small_rounding, 0.0, "absolute", -FLT_MAX, 64512.0f)}},
    {"hdrp_pack_float_uint_code",
     "at 3 of 8 bits",
     1,
     pack_float_uint_3_of_8_values,
     {EX_CLAIM(pack_float_uint_3_of_8, 0.0f, 1.0f)}},
    {"hdrp_pack_float_uint_code",
     "at 4 of 8 bits",
     1,
     pack_float_uint_4_of_8_values,
     {EX_CLAIM(pack_float_uint_4_of_8, 0.0f, 1.0f)}},
    {NULL, NULL, 0, NULL, {EX_NO_CLAIM}},
};
