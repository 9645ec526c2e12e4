/* test_math_fast.c - edges and exact values of the fast math of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_math.h"

static const float nan_pattern[] = {NAN, -NAN};

static void rsqrt_follows_ieee_at_the_edges(void** state)
{
    (void)state;
    assert_true(hdrp_rsqrt(0.0f) == INFINITY && hdrp_rsqrt(-0.0f) == -INFINITY);
    assert_true(hdrp_rsqrt(INFINITY) == 0.0f);
    assert_true(isnan(hdrp_rsqrt(-1.0f)) && isnan(hdrp_rsqrt(NAN)));
    assert_true(hdrp_rsqrt(4.0f) == 0.5f);
}

static void rsqrt_fast_stays_finite(void** state)
{
    (void)state;
    float low[] = {0.0f, -0.0f, -1.0f, -INFINITY, 1e-45f, NAN, -NAN};
    for (int i = 0; i < 7; ++i) {
        assert_true(hdrp_rsqrt_fast(low[i]) == hdrp_rsqrt_fast(HDRP_FLT_MIN));
    }
    assert_true(fabs((double)hdrp_rsqrt_fast(HDRP_FLT_MIN) / 0x1p63 - 1.0) < 1e-6);
    assert_true(hdrp_rsqrt_fast(INFINITY) == hdrp_rsqrt_fast(HDRP_FLT_MAX));
    assert_true(hdrp_rsqrt_fast(INFINITY) > 0.0f);
}

static void an_arc_cosine_is_exact_at_the_ends_and_falls(float (*f)(float))
{
    assert_true(f(1.0f) == 0.0f && f(-1.0f) == HDRP_PI);
    assert_true(f(7.0f) == 0.0f && f(-INFINITY) == HDRP_PI);
    assert_true(f(0.0f) == HDRP_HALF_PI && f(-0.0f) == HDRP_HALF_PI);
    assert_true(f(nan_pattern[0]) >= 0.0f && f(nan_pattern[1]) >= 0.0f);
    for (int i = -1000; i < 1000; ++i) {
        float x = (float)i * 0.001f;
        assert_true(f(x) > f(x + 0.001f));
    }
}

static void arc_cosines_are_exact_at_the_ends_and_fall(void** state)
{
    (void)state;
    an_arc_cosine_is_exact_at_the_ends_and_falls(hdrp_acos_fast);
    an_arc_cosine_is_exact_at_the_ends_and_falls(hdrp_acos_exact);
}

static void an_arc_tangent_knows_axes_quadrants_and_signed_zeros(float (*f)(float, float),
                                                                 double tolerance)
{
    static const float v[] = {0.0f, -0.0f, 1.0f, -1.0f, 1e-30f, -2e30f, INFINITY, -INFINITY};
    for (int i = 0; i < 8; ++i) {
        for (int k = 0; k < 8; ++k) {
            double expected = atan2((double)v[i], (double)v[k]);
            float measured = f(v[i], v[k]);
            assert_true(fabs((double)measured - expected) < tolerance);
            assert_true(signbit(measured) == signbit(v[i]));
        }
    }
    for (int i = 0; i < 2; ++i) {
        assert_true(fabsf(f(nan_pattern[i], 1.0f)) <= HDRP_PI);
        assert_true(fabsf(f(1.0f, nan_pattern[i])) <= HDRP_PI);
        assert_true(fabsf(f(nan_pattern[i], nan_pattern[i])) <= HDRP_PI);
    }
}

static void arc_tangents_know_axes_quadrants_and_signed_zeros(void** state)
{
    (void)state;
    an_arc_tangent_knows_axes_quadrants_and_signed_zeros(hdrp_atan2_fast, 1e-6);
    an_arc_tangent_knows_axes_quadrants_and_signed_zeros(hdrp_atan2_exact, 2e-7);
}

static void exp2_fast_is_exact_for_integers_and_saturates(void** state)
{
    (void)state;
    for (int i = -149; i < 128; ++i) {
        assert_true(hdrp_exp2_fast((float)i) == (float)ldexp(1.0, i));
    }
    assert_true(hdrp_exp2_fast(128.0f) == HDRP_FLT_MAX);
    assert_true(hdrp_exp2_fast(1e30f) == HDRP_FLT_MAX);
    assert_true(hdrp_exp2_fast(INFINITY) == HDRP_FLT_MAX);
    assert_true(hdrp_exp2_fast(-150.5f) == 0.0f && hdrp_exp2_fast(-INFINITY) == 0.0f);
    assert_true(hdrp_exp2_fast(nan_pattern[0]) == 0.0f && hdrp_exp2_fast(nan_pattern[1]) == 0.0f);
    assert_true(hdrp_exp2_fast(-0.0f) == 1.0f && hdrp_exp2_fast(1e-45f) == 1.0f);
}

static void exp2_fast_reaches_the_smallest_denormal(void** state)
{
    (void)state;
    assert_true(hdrp_exp2_fast(-149.0f) == 0x1p-149f);
    for (int i = 0; i < 24000; ++i) {
        float x = -150.0f + (float)i * 0.001f;
        double exact = exp2((double)x), error = (double)hdrp_exp2_fast(x) - exact;
        assert_true(fabs(error) <= 0x1p-150 + 2.5e-7 * exact);
    }
}

static void exp2_fast_rises_where_its_pieces_meet(void** state)
{
    (void)state;
    for (int i = -120; i < 120; ++i) {
        uint32_t middle = hdrp_bits_from_f32((float)i + 0.5f);
        for (uint32_t u = middle - 50u; u < middle + 50u; ++u) {
            float a = hdrp_f32_from_bits(u), b = hdrp_f32_from_bits(u + 1u);
            float lower = hdrp_exp2_fast(hdrp_min(a, b)), upper = hdrp_exp2_fast(hdrp_max(a, b));
            /* Rounding alone may turn two neighbours around, by less than the claimed error. */
            assert_true(upper > lower * (1.0f - 2.5e-7f));
        }
    }
}

static void log2_fast_is_exact_for_powers_of_two_and_finite_for_the_rest(void** state)
{
    (void)state;
    for (int i = -149; i < 128; ++i) {
        assert_true(hdrp_log2_fast((float)ldexp(1.0, i)) == (float)i);
    }
    float low[] = {0.0f, -0.0f, -1.0f, -INFINITY, NAN, -NAN, -1e-45f};
    for (int i = 0; i < 7; ++i) {
        assert_true(hdrp_log2_fast(low[i]) == -151.0f);
    }
    assert_true(hdrp_log2_fast(INFINITY) == 128.0f);
}

static void pow_fast_takes_zero_one_and_the_rest_of_the_edges(void** state)
{
    (void)state;
    float y[] = {-INFINITY, -HDRP_FLT_MAX, -1.0f, -1e-20f, 0.0f, 1e-20f, 2.4f, INFINITY};
    for (int i = 0; i < 8; ++i) {
        float of_zero = y[i] > 0.0f ? 0.0f : (y[i] < 0.0f ? HDRP_FLT_MAX : 1.0f);
        assert_true(hdrp_pow_fast(0.0f, y[i]) == of_zero);
        assert_true(hdrp_pow_fast(-3.0f, y[i]) == of_zero);
        assert_true(hdrp_pow_fast(NAN, y[i]) == of_zero);
        assert_true(hdrp_pow_fast(1.0f, y[i]) == (isinf(y[i]) ? 0.0f : 1.0f));
    }
    assert_true(hdrp_pow_fast(INFINITY, 0.0f) == 1.0f);
    assert_true(hdrp_pow_fast(2.0f, 3.0f) == 8.0f);
    assert_true(hdrp_pow_fast(10.0f, 50.0f) == HDRP_FLT_MAX);
    assert_true(hdrp_pow_fast(0.5f, NAN) == 0.0f);
}

static void sincos_keeps_small_angles_and_the_unit_circle(void** state)
{
    (void)state;
    hdrp_sincos_result r = hdrp_sincos(0.0f);
    assert_true(r.sine == 0.0f && r.cosine == 1.0f);
    assert_true(hdrp_sincos(1e-30f).sine == 1e-30f && hdrp_sincos(-1e-45f).sine == -1e-45f);
    assert_true(hdrp_sincos_fast(1e-30f).sine == 1e-30f && hdrp_sincos_fast(0.0f).cosine == 1.0f);
    static const float quarter[4][2] = {{0.0f, 1.0f}, {1.0f, 0.0f}, {0.0f, -1.0f}, {-1.0f, 0.0f}};
    for (int i = -8; i < 8; ++i) {
        r = hdrp_sincos((float)i * HDRP_HALF_PI);
        hdrp_sincos_result fast = hdrp_sincos_fast((float)i * HDRP_HALF_PI);
        const float* expected = quarter[i & 3];
        assert_true(fabsf(r.sine - expected[0]) < 1e-6f && fabsf(r.cosine - expected[1]) < 1e-6f);
        assert_true(fabsf(fast.sine - expected[0]) < 1e-5f);
        assert_true(fabsf(fast.cosine - expected[1]) < 1e-5f);
    }
    for (int i = -7; i <= 7; ++i) { /* all quadrants, away from the axes */
        r = hdrp_sincos((float)i);
        assert_true(fabs((double)r.sine - sin((double)i)) < 1e-6);
        assert_true(fabs((double)r.cosine - cos((double)i)) < 1e-6);
    }
    for (int i = -8192; i <= 8192; ++i) {
        r = hdrp_sincos((float)i * 0.9999f);
        assert_true(fabsf(r.sine) <= 1.0f && fabsf(r.cosine) <= 1.0f);
        assert_true(fabsf(r.sine * r.sine + r.cosine * r.cosine - 1.0f) < 3e-7f);
        r = hdrp_sincos_fast((float)i * 0.9999f);
        assert_true(fabsf(r.sine) <= 1.0000012f && fabsf(r.cosine) <= 1.0000012f);
    }
}

static void sincos_holds_the_ends_of_its_range(void** state)
{
    (void)state;
    hdrp_sincos_result upper = hdrp_sincos(8192.0f), lower = hdrp_sincos(-8192.0f);
    assert_true(hdrp_sincos(1e9f).sine == upper.sine);
    assert_true(hdrp_sincos(INFINITY).cosine == upper.cosine);
    assert_true(hdrp_sincos(nan_pattern[0]).sine == lower.sine);
    assert_true(hdrp_sincos(nan_pattern[1]).sine == lower.sine);
    assert_true(hdrp_sincos_fast(-1e9f).sine == hdrp_sincos_fast(-8192.0f).sine);
    assert_true(hdrp_sincos_fast(NAN).cosine == hdrp_sincos_fast(-8192.0f).cosine);
}

static void every_kind_of_float_gives_a_finite_result(void** state)
{
    (void)state;
    uint32_t u = 0u;
    do {
        float x = hdrp_f32_from_bits(u), y = hdrp_f32_from_bits(u * 2654435769u);
        float sum = hdrp_acos_fast(x) + hdrp_atan2_fast(x, y) + hdrp_log2_fast(x);
        assert_true(isfinite(sum));
        assert_true(isfinite(hdrp_exp2_fast(x)) && isfinite(hdrp_pow_fast(x, y)));
        assert_true(isfinite(hdrp_rsqrt_fast(x)));
        assert_true(isfinite(hdrp_sincos(x).sine + hdrp_sincos(x).cosine));
        assert_true(isfinite(hdrp_sincos_fast(x).sine + hdrp_sincos_fast(x).cosine));
        u += 65537u;
    } while (u >= 65537u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rsqrt_follows_ieee_at_the_edges),
        cmocka_unit_test(rsqrt_fast_stays_finite),
        cmocka_unit_test(arc_cosines_are_exact_at_the_ends_and_fall),
        cmocka_unit_test(arc_tangents_know_axes_quadrants_and_signed_zeros),
        cmocka_unit_test(exp2_fast_is_exact_for_integers_and_saturates),
        cmocka_unit_test(exp2_fast_reaches_the_smallest_denormal),
        cmocka_unit_test(exp2_fast_rises_where_its_pieces_meet),
        cmocka_unit_test(log2_fast_is_exact_for_powers_of_two_and_finite_for_the_rest),
        cmocka_unit_test(pow_fast_takes_zero_one_and_the_rest_of_the_edges),
        cmocka_unit_test(sincos_keeps_small_angles_and_the_unit_circle),
        cmocka_unit_test(sincos_holds_the_ends_of_its_range),
        cmocka_unit_test(every_kind_of_float_gives_a_finite_result),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
