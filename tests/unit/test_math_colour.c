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

static void a_display_shows_what_no_light_is_as_black(void** state)
{
    hdrp_v3 c;
    (void)state;
    for (uint32_t tone = 0; tone < 3; ++tone) {
        c = hdrp_tonemap(hdrp_v3_make(NAN, -1.0f, -INFINITY), tone);
        assert_true(c.x == 0.0f && c.y == 0.0f && c.z == 0.0f);
        c = hdrp_tonemap(hdrp_v3_splat(INFINITY), tone);
        assert_true(c.x > 0.999f && c.x <= 1.0f && c.y == c.x && c.z == c.x);
        c = hdrp_tonemap(hdrp_v3_make(INFINITY, 0.0f, NAN), tone);
        assert_true(c.x > 0.999f && c.x <= 1.0f && c.y >= 0.0f && c.y <= 1.0f && c.z == c.y);
    }
    /* Base colours lose the 4 % that a dielectric adds to them, up to the knee. */
    c = hdrp_tonemap(hdrp_v3_make(0.2f, 0.5f, 0.79f), HDRP_TONEMAP_NEUTRAL);
    assert_true(fabsf(c.x - 0.16f) < 1e-6f && fabsf(c.y - 0.46f) < 1e-6f);
    assert_true(fabsf(c.z - 0.75f) < 1e-6f);
    c = hdrp_tonemap(hdrp_v3_make(0.2f, 0.5f, 1.5f), HDRP_TONEMAP_CLAMP);
    assert_true(c.x == 0.2f && c.y == 0.5f && c.z == 1.0f);
}

static void noise_is_triangular_and_has_no_mean(void** state)
{
    int near = 0;
    double sum = 0.0, squares = 0.0;
    (void)state;
    for (uint32_t i = 0; i < 100000; ++i) {
        double n = (double)hdrp_dither_from_hash(hdrp_hash1(i));
        assert_true(n > -1.0 && n < 1.0);
        sum += n;
        squares += n * n;
        near += fabs(n) < 0.5;
    }
    assert_true(fabs(sum / 1e5) < 5e-3 && fabs(squares / 1e5 - 1.0 / 6.0) < 3e-3);
    assert_true(near > 74000 && near < 76000);
    assert_true(hdrp_dither_from_hash(0u) == 0.0f && hdrp_dither_from_hash(0xffffffffu) == 0.0f);
}

static void codes_are_whole_and_keep_the_mean_when_dithered(void** state)
{
    (void)state;
    for (float x = 0.0f; x <= 1.0f; x += 0.0037f) {
        double sum = 0.0;
        assert_true(hdrp_dithered(x, 255.0f, 0.0f) * 255.0f ==
                    floorf(hdrp_dithered(x, 255.0f, 0.0f) * 255.0f + 0.5f));
        assert_true(fabsf(hdrp_dithered(x, 255.0f, 0.0f) - x) <= 0.5001f / 255.0f);
        for (uint32_t i = 0; i < 4096; ++i) {
            float code =
                hdrp_dithered(x, 255.0f, hdrp_dither_from_hash(hdrp_hash2(i, 7u))) * 255.0f;
            assert_true(code >= 0.0f && code <= 255.0f);
            sum += (double)code;
        }
        if (x > 1.0f / 255.0f && x < 254.0f / 255.0f) {
            assert_true(fabs(sum / 4096.0 - (double)x * 255.0) < 0.05);
        }
    }
    assert_true(hdrp_dithered(10.4998f / 255.0f, 255.0f, 0.0f) == 10.0f / 255.0f);
    assert_true(hdrp_dithered(10.5002f / 255.0f, 255.0f, 0.0f) == 11.0f / 255.0f);
    for (float noise = -1.0f; noise <= 1.0f; noise += 0.25f) {
        assert_true(hdrp_dithered(0.0f, 255.0f, noise) == 0.0f);
        assert_true(hdrp_dithered(1.0f, 255.0f, noise) == 1.0f);
        assert_true(hdrp_dithered(NAN, 255.0f, noise) == 0.0f);
        assert_true(hdrp_dithered(INFINITY, 1023.0f, noise) == 1.0f);
        assert_true(hdrp_dithered(-1.0f, 1.0f, noise) == 0.0f);
    }
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
        cmocka_unit_test(a_display_shows_what_no_light_is_as_black),
        cmocka_unit_test(noise_is_triangular_and_has_no_mean),
        cmocka_unit_test(codes_are_whole_and_keep_the_mean_when_dithered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
