/* test_pack_scalar.c - UNORM, SNORM, sRGB and small floats of hdrp_pack.h, code by code.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_pack.h"

static void every_unorm_code_survives(void** state)
{
    (void)state;
    for (hdrp_u32 bits = 1; bits <= 16; ++bits) {
        for (hdrp_u32 code = 0; code < (1u << bits); ++code) {
            float x = hdrp_pack_float_from_unorm(code, bits);
            assert_true(hdrp_pack_unorm_from_float(x, bits) == code);
            assert_true(hdrp_pack_unorm_target(x, bits) == x);
        }
        assert_true(hdrp_pack_float_from_unorm((1u << bits) - 1u, bits) == 1.0f);
    }
}

static void every_snorm_code_survives(void** state)
{
    (void)state;
    for (hdrp_u32 bits = 2; bits <= 16; ++bits) {
        hdrp_u32 lowest = 1u << (bits - 1u);
        for (hdrp_u32 code = 0; code < (1u << bits); ++code) {
            float x = hdrp_pack_float_from_snorm(code, bits);
            hdrp_u32 again = code == lowest ? code + 1u : code;
            assert_true(hdrp_pack_snorm_from_float(x, bits) == again);
            float target = hdrp_pack_biased_snorm_target(x, bits);
            assert_true(target >= 0.0f && target <= 1.0f);
            assert_true(hdrp_pack_float_from_biased_snorm_target(target, bits) == x);
        }
        assert_true(hdrp_pack_float_from_snorm(0u, bits) == 0.0f);
        assert_true(hdrp_pack_float_from_snorm(lowest, bits) == -1.0f);
        assert_true(hdrp_pack_float_from_snorm(lowest + 1u, bits) == -1.0f);
        assert_true(hdrp_pack_float_from_snorm(lowest - 1u, bits) == 1.0f);
    }
}

static void unorm_and_snorm_limit_their_input(void** state)
{
    (void)state;
    assert_int_equal(hdrp_pack_unorm_from_float(NAN, 8u), 0);
    assert_int_equal(hdrp_pack_unorm_from_float(-INFINITY, 8u), 0);
    assert_int_equal(hdrp_pack_unorm_from_float(INFINITY, 8u), 255);
    assert_int_equal(hdrp_pack_unorm_from_float(HDRP_FLT_MAX, 16u), 65535);
    assert_int_equal(hdrp_pack_unorm_from_float(-0.0f, 10u), 0);
    assert_int_equal(hdrp_pack_unorm_from_float(1.40129846e-45f, 16u), 0);
    assert_int_equal(hdrp_pack_unorm_from_float(0.5f, 8u), 128);
    assert_int_equal(hdrp_pack_unorm_from_float(0.7f, 0u), 0);
    assert_int_equal(hdrp_pack_snorm_from_float(NAN, 8u), 0);
    assert_int_equal(hdrp_pack_snorm_from_float(-INFINITY, 8u), 0x81);
    assert_int_equal(hdrp_pack_snorm_from_float(INFINITY, 8u), 0x7f);
    assert_true(hdrp_pack_float_from_biased_snorm_target(hdrp_pack_biased_snorm_target(NAN, 8u),
                                                         8u) == 0.0f);
}

static void every_srgb_code_survives(void** state)
{
    (void)state;
    float last = -1.0f;
    for (hdrp_u32 code = 0; code < 256; ++code) {
        float x = hdrp_pack_linear_from_srgb8(code);
        assert_true(x > last);
        assert_int_equal(hdrp_pack_srgb8_from_linear(x), code);
        last = x;
    }
    assert_true(hdrp_pack_linear_from_srgb8(0u) == 0.0f);
    assert_true(hdrp_pack_linear_from_srgb8(255u) == 1.0f);
    assert_int_equal(hdrp_pack_srgb8_from_linear(NAN), 0);
    assert_int_equal(hdrp_pack_srgb8_from_linear(2.0f), 255);
    assert_int_equal(hdrp_pack_srgb8_from_linear(0.21405f), 128); /* 0.5 encoded is code 127.5 */
    assert_int_equal(hdrp_pack_srgb8_from_linear(0.21404f), 127);
}

static void rgba8_puts_red_in_the_low_byte(void** state)
{
    (void)state;
    hdrp_v4 v = hdrp_v4_make(1.0f / 255.0f, 2.0f / 255.0f, 3.0f / 255.0f, 4.0f / 255.0f);
    assert_int_equal(hdrp_pack_rgba8_from_v4(v), 0x04030201);
    hdrp_v4 back = hdrp_pack_v4_from_rgba8(0x04030201u);
    assert_true(back.x == v.x && back.y == v.y && back.z == v.z && back.w == v.w);
    hdrp_v4 linear = hdrp_pack_linear_from_srgba8(0x807f0180u);
    assert_true(linear.x == hdrp_pack_linear_from_srgb8(0x80u));
    assert_true(linear.y == hdrp_pack_linear_from_srgb8(0x01u));
    assert_true(linear.z == hdrp_pack_linear_from_srgb8(0x7fu));
    assert_true(linear.w == 128.0f / 255.0f);
    assert_int_equal(hdrp_pack_srgba8_from_linear(linear), 0x807f0180);
}

/* What a code of five exponent bits, bias 15, is by definition. */
static double small_float(hdrp_u32 code, int mantissa_bits)
{
    int exponent = (int)(code >> mantissa_bits);
    double mantissa = ldexp((double)(code & ((1u << mantissa_bits) - 1u)), -mantissa_bits);
    if (exponent == 31) {
        return mantissa == 0.0 ? HUGE_VAL : (double)NAN;
    }
    return exponent == 0 ? ldexp(mantissa, -14) : ldexp(1.0 + mantissa, exponent - 15);
}

typedef hdrp_u32 (*encoder)(float x);
typedef float (*decoder)(hdrp_u32 code);

static hdrp_u32 red(float x)
{
    return hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(x, 0.0f, 0.0f));
}

static hdrp_u32 green(float x)
{
    return hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(0.0f, x, 0.0f)) >> 11u;
}

static hdrp_u32 blue(float x)
{
    return hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(0.0f, 0.0f, x)) >> 22u;
}

static float from_red(hdrp_u32 code)
{
    return hdrp_pack_rgb_from_r11g11b10f(code).x;
}

static float from_green(hdrp_u32 code)
{
    return hdrp_pack_rgb_from_r11g11b10f(code << 11u).y;
}

static float from_blue(hdrp_u32 code)
{
    return hdrp_pack_rgb_from_r11g11b10f(code << 22u).z;
}

/* Every finite code, and the floats around every place where the nearest code changes. */
static void expect_small_float(encoder encode, decoder decode, int mantissa_bits)
{
    hdrp_u32 infinity = 31u << mantissa_bits;
    for (hdrp_u32 code = 0; code < infinity; ++code) {
        double value = small_float(code, mantissa_bits);
        assert_true((double)decode(code) == value);
        assert_int_equal(encode((float)value), code);
        if (code + 1u < infinity) {
            /* Exact in float: one bit more than the code has. */
            float middle = (float)(0.5 * (value + small_float(code + 1u, mantissa_bits)));
            assert_int_equal(encode(middle), code + (code & 1u));
            assert_int_equal(encode(nextafterf(middle, 0.0f)), code);
            assert_int_equal(encode(nextafterf(middle, INFINITY)), code + 1u);
        }
    }
    assert_true(isinf(decode(infinity)));
    for (hdrp_u32 code = infinity + 1u; code < (1u << (mantissa_bits + 5)); ++code) {
        assert_true(isnan(decode(code)));
    }
    assert_int_equal(encode(INFINITY), infinity);
    assert_true(encode(NAN) > infinity);
    assert_true(isnan(decode(encode(NAN))));
    assert_true(isnan(decode(encode(hdrp_f32_from_bits(0x7fc00001u)))));
    assert_int_equal(encode(1.40129846e-45f), 0);
    assert_int_equal(encode(HDRP_FLT_MIN), 0);
}

static void half_rounds_to_nearest_even(void** state)
{
    (void)state;
    expect_small_float(hdrp_pack_half_from_float, hdrp_pack_float_from_half, 10);
    expect_small_float(red, from_red, 6);
    expect_small_float(green, from_green, 6);
    expect_small_float(blue, from_blue, 5);
}

static void half_keeps_sign_and_nan(void** state)
{
    (void)state;
    for (hdrp_u32 code = 0; code < 0x7c00u; ++code) {
        float x = hdrp_pack_float_from_half(code | 0x8000u);
        assert_true(x == -hdrp_pack_float_from_half(code) && signbit(x));
        assert_int_equal(hdrp_pack_half_from_float(x), code | 0x8000u);
        assert_int_equal(hdrp_pack_half_from_float_saturated(x), code | 0x8000u);
    }
    assert_true(isnan(hdrp_pack_float_from_half(0xfc01u)));
    /* A quiet NaN of either sign, with the upper ten bits of its payload. */
    assert_int_equal(hdrp_pack_half_from_float(hdrp_f32_from_bits(0xffc0a000u)), 0xfe05);
    assert_int_equal(hdrp_pack_half_from_float_saturated(hdrp_f32_from_bits(0x7fc00000u)), 0x7e00);
}

static void half_overflows_as_stated(void** state)
{
    (void)state;
    assert_int_equal(hdrp_pack_half_from_float(65504.0f), 0x7bff);
    assert_int_equal(hdrp_pack_half_from_float(nextafterf(65520.0f, 0.0f)), 0x7bff);
    assert_int_equal(hdrp_pack_half_from_float(65520.0f), 0x7c00);
    assert_int_equal(hdrp_pack_half_from_float(-65520.0f), 0xfc00);
    assert_int_equal(hdrp_pack_half_from_float(HDRP_FLT_MAX), 0x7c00);
    assert_int_equal(hdrp_pack_half_from_float_saturated(65520.0f), 0x7bff);
    assert_int_equal(hdrp_pack_half_from_float_saturated(HDRP_FLT_MAX), 0x7bff);
    assert_int_equal(hdrp_pack_half_from_float_saturated(INFINITY), 0x7bff);
    assert_int_equal(hdrp_pack_half_from_float_saturated(-INFINITY), 0xfbff);
}

static void r11g11b10f_overflows_as_stated(void** state)
{
    (void)state;
    assert_true(from_red(red(65024.0f)) == 65024.0f);
    assert_true(from_red(red(HDRP_FLT_MAX)) == 65024.0f);
    assert_true(from_green(green(65536.0f)) == 65024.0f);
    assert_true(from_blue(blue(64512.0f)) == 64512.0f);
    assert_true(from_blue(blue(HDRP_FLT_MAX)) == 64512.0f);
    float negative[] = {-0.0f, -1.5f, -1e-20f, -HDRP_FLT_MAX, -INFINITY};
    for (int i = 0; i < 5; ++i) {
        assert_int_equal(
            hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(negative[i], negative[i], negative[i])), 0);
    }
    /* A NaN of either sign or payload stays one and does not become infinity. */
    hdrp_u32 nans[] = {0x7fc00000u, 0xffc00000u, 0x7f800001u, 0xff800001u};
    for (int i = 0; i < 4; ++i) {
        float nan = hdrp_f32_from_bits(nans[i]);
        assert_true(isnan(from_red(red(nan))) && isnan(from_blue(blue(nan))));
    }
}

static void r11g11b10f_channels_do_not_touch(void** state)
{
    (void)state;
    hdrp_u32 texel = hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(1.0f, 2.0f, 4.0f));
    assert_int_equal(texel, (15u << 6) | ((16u << 6) << 11) | ((17u << 5) << 22));
    hdrp_v3 rgb = hdrp_pack_rgb_from_r11g11b10f(texel);
    assert_true(rgb.x == 1.0f && rgb.y == 2.0f && rgb.z == 4.0f);
}

/* FNV-1a over the codes of a fixed walk through all floats: what differs between two compilers or
 * optimisation levels differs here. The number was computed once, at -O0, after the tests above
 * had passed. */
static void integer_codecs_are_the_same_in_every_build(void** state)
{
    (void)state;
    uint64_t hash = 0xcbf29ce484222325u;
    hdrp_u32 bits = 1u;
    for (int i = 0; i < 400000; ++i) {
        bits = bits * 1664525u + 1013904223u;
        float x = hdrp_f32_from_bits(bits), unit = hdrp_f32_from_u32(bits >> 8u) * 0x1p-24f;
        hdrp_u32 codes[] = {
            hdrp_pack_half_from_float(x),
            hdrp_pack_half_from_float_saturated(x),
            hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(x, unit, 1.0f / (unit + 1e-5f))),
            hdrp_pack_unorm_from_float(unit, 8u),
            hdrp_pack_unorm_from_float(unit, 16u),
            hdrp_pack_snorm_from_float(unit - 0.5f, 12u),
            hdrp_pack_float_uint_code(unit, bits, 3u, 10u),
            hdrp_bits_from_f32(hdrp_pack_float_from_half(bits & 0xfbffu)),
            hdrp_pack_oct_snorm_from_normal(hdrp_v3_make(unit - 0.5f, x, 0.25f), 12u),
            hdrp_pack_oct_unorm_from_normal(hdrp_v3_make(unit - 0.5f, 0.3f, x), 16u)};
        for (int k = 0; k < 10; ++k) {
            hash = (hash ^ codes[k]) * 0x100000001b3u;
        }
    }
    assert_true(hash == 0x39b02d9552626b26u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_unorm_code_survives),
        cmocka_unit_test(every_snorm_code_survives),
        cmocka_unit_test(unorm_and_snorm_limit_their_input),
        cmocka_unit_test(every_srgb_code_survives),
        cmocka_unit_test(rgba8_puts_red_in_the_low_byte),
        cmocka_unit_test(half_rounds_to_nearest_even),
        cmocka_unit_test(half_keeps_sign_and_nan),
        cmocka_unit_test(half_overflows_as_stated),
        cmocka_unit_test(r11g11b10f_overflows_as_stated),
        cmocka_unit_test(r11g11b10f_channels_do_not_touch),
        cmocka_unit_test(integer_codecs_are_the_same_in_every_build),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
