/* test_math_colour.c - edges and exact values of colour and colour temperature of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_math.h"

typedef float curve(float x);

static curve* const curves[] = {hdrp_linear_from_srgb, hdrp_srgb_from_linear,
                                hdrp_linear_from_srgb_fast, hdrp_srgb_from_linear_fast};

static void srgb_is_exact_at_black_and_white(void** state)
{
    (void)state;
    for (int i = 0; i < 4; ++i) {
        assert_true(curves[i](0.0f) == 0.0f && curves[i](1.0f) == 1.0f);
        assert_true(curves[i](-0.0f) == 0.0f && curves[i](-1.0f) == 0.0f);
        assert_true(curves[i](NAN) == 0.0f && curves[i](-NAN) == 0.0f);
        assert_true(curves[i](-INFINITY) == 0.0f);
    }
}

static void srgb_continues_above_white_where_it_is_not_fast(void** state)
{
    (void)state;
    assert_true(hdrp_linear_from_srgb(2.0f) > 4.9f && hdrp_linear_from_srgb(2.0f) < 5.0f);
    assert_true(isfinite(hdrp_linear_from_srgb(1e16f)) && isfinite(hdrp_srgb_from_linear(3.4e38f)));
    assert_true(hdrp_linear_from_srgb_fast(2.0f) == 1.0f);
    assert_true(hdrp_srgb_from_linear_fast(INFINITY) == 1.0f);
}

static void rises(curve* f, float rounding, uint32_t first, uint32_t last, uint32_t step)
{
    float before = f(hdrp_f32_from_bits(first));
    for (uint32_t u = first + step; u <= last; u += step) {
        float now = f(hdrp_f32_from_bits(u));
        assert_true(now >= before * (1.0f - rounding));
        before = now;
    }
}

static void srgb_is_monotone(void** state)
{
    (void)state;
    for (int i = 0; i < 4; ++i) {
        float rounding = i < 2 ? 0.0f : (i == 2 ? 2e-7f : 4e-7f);
        rises(curves[i], rounding, 0u, hdrp_bits_from_f32(1.0f), 1021u);
        for (int k = 0; k < 2; ++k) { /* every float around the ends of the straight pieces */
            uint32_t knee = hdrp_bits_from_f32(k ? 0.04045f : 0.0031308f);
            rises(curves[i], rounding, knee - 20000u, knee + 20000u, 1u);
        }
        rises(curves[i], rounding, hdrp_bits_from_f32(0.99f), hdrp_bits_from_f32(1.0f), 1u);
    }
}

static void every_8_bit_code_survives_all_pairs_of_codecs(void** state)
{
    (void)state;
    for (int code = 0; code < 256; ++code) {
        for (int d = 0; d < 4; d += 2) {
            for (int e = 1; e < 4; e += 2) {
                float encoded = curves[e](curves[d]((float)code / 255.0f));
                assert_int_equal((int)(encoded * 255.0f + 0.5f), code);
            }
        }
    }
}

static void vector_forms_apply_to_each_component(void** state)
{
    (void)state;
    hdrp_v3 v = hdrp_v3_make(0.02f, 0.3f, 0.9f);
    hdrp_v3 d = hdrp_v3_linear_from_srgb(v), e = hdrp_v3_srgb_from_linear(v);
    hdrp_v3 df = hdrp_v3_linear_from_srgb_fast(v), ef = hdrp_v3_srgb_from_linear_fast(v);
    assert_true(d.x == hdrp_linear_from_srgb(v.x) && d.z == hdrp_linear_from_srgb(v.z));
    assert_true(e.y == hdrp_srgb_from_linear(v.y) && e.z == hdrp_srgb_from_linear(v.z));
    assert_true(df.x == hdrp_linear_from_srgb_fast(v.x) && df.y == hdrp_linear_from_srgb_fast(v.y));
    assert_true(ef.x == hdrp_srgb_from_linear_fast(v.x) && ef.z == hdrp_srgb_from_linear_fast(v.z));
}

static void luminance_of_white_is_one_and_never_overflows(void** state)
{
    (void)state;
    assert_true(hdrp_luminance(hdrp_v3_splat(1.0f)) == 1.0f);
    assert_true(hdrp_luminance(hdrp_v3_splat(0.0f)) == 0.0f);
    assert_true(isfinite(hdrp_luminance(hdrp_v3_splat(HDRP_FLT_MAX))));
    assert_true(hdrp_luminance(hdrp_v3_make(1.0f, 0.0f, 0.0f)) == 0.2126f);
    assert_true(hdrp_luminance(hdrp_v3_make(0.0f, 1.0f, 0.0f)) == 0.7152f);
    assert_true(hdrp_luminance(hdrp_v3_make(0.0f, 0.0f, 1.0f)) == 0.0722f);
}

typedef hdrp_v3 temperature(float kelvin);

static temperature* const temperatures[] = {hdrp_rec709_from_kelvin, hdrp_rec709_from_kelvin_fast};

static int same(hdrp_v3 a, hdrp_v3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void temperatures_outside_the_range_are_limited(void** state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        hdrp_v3 coldest = temperatures[i](1000.0f), hottest = temperatures[i](40000.0f);
        float low[] = {0.0f, -0.0f, 999.0f, -5.0f, -INFINITY, NAN, -NAN};
        for (int k = 0; k < 7; ++k) {
            assert_true(same(temperatures[i](low[k]), coldest));
        }
        assert_true(same(temperatures[i](1e30f), hottest));
        assert_true(same(temperatures[i](INFINITY), hottest));
        assert_true(coldest.x == 1.0f && hottest.z == 1.0f);
    }
    assert_true(hdrp_rec709_from_kelvin(1000.0f).z == 0.0f);
}

static void the_largest_channel_is_one_and_none_is_negative(void** state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k <= 39000; ++k) {
            hdrp_v3 c = temperatures[i]((float)(1000 + k));
            assert_true(hdrp_v3_max_component(c) == 1.0f);
            assert_true(c.x >= 0.0f && c.y >= 0.0f && c.z >= 0.0f);
        }
    }
}

static float largest_step(temperature* f, float first, float last)
{
    float step = 0.0f;
    for (float t = first; t < last; t += 0.01f) {
        hdrp_v3 d = hdrp_v3_sub(f(t + 0.01f), f(t));
        step = hdrp_max(step, hdrp_max(hdrp_max(hdrp_abs(d.x), hdrp_abs(d.y)), hdrp_abs(d.z)));
    }
    return step;
}

static void only_the_published_fit_steps_at_its_pivot(void** state)
{
    (void)state;
    assert_true(largest_step(hdrp_rec709_from_kelvin, 6400.0f, 6800.0f) < 1e-5f);
    float step = largest_step(hdrp_rec709_from_kelvin_fast, 6569.0f, 6571.0f);
    assert_true(step > 0.0020f && step < 0.0022f);
}

static void the_published_fit_has_its_misprints_corrected(void** state)
{
    (void)state;
    double k = 4.836, misprinted = (-399.809 + 414.271 * k + 111.543 * k * k) /
                                   (2770.24 + 164.143 * k + 84.7356 * k * k);
    double corrected =
        (-399.809 + 414.271 * k + 111.543 * k * k) / (2779.24 + 164.143 * k + 84.7356 * k * k);
    double measured = (double)hdrp_rec709_from_kelvin_fast(4836.0f).y;
    assert_true(fabs(misprinted - corrected) > 1.2e-3);
    assert_true(fabs(measured - corrected) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(srgb_is_exact_at_black_and_white),
        cmocka_unit_test(srgb_continues_above_white_where_it_is_not_fast),
        cmocka_unit_test(srgb_is_monotone),
        cmocka_unit_test(every_8_bit_code_survives_all_pairs_of_codecs),
        cmocka_unit_test(vector_forms_apply_to_each_component),
        cmocka_unit_test(luminance_of_white_is_one_and_never_overflows),
        cmocka_unit_test(temperatures_outside_the_range_are_limited),
        cmocka_unit_test(the_largest_channel_is_one_and_none_is_negative),
        cmocka_unit_test(only_the_published_fit_steps_at_its_pivot),
        cmocka_unit_test(the_published_fit_has_its_misprints_corrected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
