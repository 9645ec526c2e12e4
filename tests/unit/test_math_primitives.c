/* test_math_primitives.c - the wrappers of the language layer and the small vector functions.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_math.h"

static void expect_v2(hdrp_v2 v, float x, float y)
{
    assert_true(v.x == x && v.y == y);
}

static void expect_v3(hdrp_v3 v, float x, float y, float z)
{
    assert_true(v.x == x && v.y == y && v.z == z);
}

static void expect_v4(hdrp_v4 v, float x, float y, float z, float w)
{
    assert_true(v.x == x && v.y == y && v.z == z && v.w == w);
}

static void expect_near(float x, double reference)
{
    assert_true(fabs((double)x - reference) <= 2e-7 * fmax(1.0, fabs(reference)));
}

static void wrappers_call_the_function_of_their_name(void** state)
{
    (void)state;
    /* Angles whose sine, cosine and tangent are known without a library. */
    double root3 = 1.7320508075688772;
    expect_near(hdrp_sin(HDRP_PI / 6.0f), 0.5);
    expect_near(hdrp_cos(HDRP_PI / 6.0f), root3 / 2.0);
    expect_near(hdrp_tan(HDRP_PI / 6.0f), 1.0 / root3);
    expect_near(hdrp_asin(0.5f), 3.14159265358979 / 6.0);
    expect_near(hdrp_acos(0.5f), 3.14159265358979 / 3.0);
    expect_near(hdrp_atan2(1.0f, -1.0f), 3.14159265358979 * 0.75);
    expect_near(hdrp_atan2(-1.0f, 0.0f), -3.14159265358979 * 0.5);
    expect_near(hdrp_exp(1.0f), 2.718281828459045);
    expect_near(hdrp_log(10.0f), 2.302585092994046);
    assert_true(hdrp_sqrt(9.0f) == 3.0f);
    assert_true(hdrp_exp2(-3.0f) == 0.125f);
    assert_true(hdrp_log2(0.125f) == -3.0f);
    assert_true(hdrp_pow(3.0f, 4.0f) == 81.0f);
    assert_true(hdrp_floor(-1.5f) == -2.0f && hdrp_floor(1.5f) == 1.0f);
    assert_true(hdrp_abs(-2.5f) == 2.5f && hdrp_abs(2.5f) == 2.5f);
    assert_true(hdrp_sq(-3.0f) == 9.0f);
}

static void a_sign_is_never_zero(void** state)
{
    (void)state;
    assert_true(hdrp_sign_not_zero(-1e-45f) == -1.0f);
    assert_true(hdrp_sign_not_zero(0.0f) == 1.0f && hdrp_sign_not_zero(-0.0f) == 1.0f);
    assert_true(hdrp_sign_not_zero(5.0f) == 1.0f);
}

static void integers_and_bits_convert_both_ways(void** state)
{
    (void)state;
    assert_true(hdrp_f32_from_u32(16777217u) == 16777216.0f); /* 25 bits: to even */
    assert_true(hdrp_f32_from_u32(4294967295u) == 4294967296.0f);
    assert_true(hdrp_u32_from_f32(2.9f) == 2u && hdrp_u32_from_f32(4294967040.0f) == 4294967040u);
    assert_true(hdrp_bits_from_f32(1.0f) == 0x3f800000u);
    assert_true(hdrp_bits_from_f32(-0.0f) == 0x80000000u);
    assert_true(hdrp_f32_from_bits(0x7f7fffffu) == HDRP_FLT_MAX);
    assert_true(hdrp_f32_from_bits(0x00800000u) == HDRP_FLT_MIN);
    assert_true(hdrp_f32_from_bits(0x34000000u) == HDRP_FLT_EPSILON);
}

static void vectors_keep_the_order_of_their_components(void** state)
{
    (void)state;
    hdrp_v4 v = hdrp_v4_make(1.0f, 2.0f, 3.0f, 4.0f);
    hdrp_u32x4 u = hdrp_u32x4_make(1u, 2u, 3u, 4u);
    expect_v2(hdrp_v2_make(1.0f, 2.0f), 1.0f, 2.0f);
    expect_v3(hdrp_v3_make(1.0f, 2.0f, 3.0f), 1.0f, 2.0f, 3.0f);
    expect_v4(v, 1.0f, 2.0f, 3.0f, 4.0f);
    assert_true(u.x == 1u && u.y == 2u && u.z == 3u && u.w == 4u);
    expect_v3(hdrp_v3_splat(7.0f), 7.0f, 7.0f, 7.0f);
    expect_v3(hdrp_v3_from_v4(v), 1.0f, 2.0f, 3.0f);
    expect_v4(hdrp_v4_from_v3(hdrp_v3_make(5.0f, 6.0f, 7.0f), 8.0f), 5.0f, 6.0f, 7.0f, 8.0f);
}

static void vectors_compute_by_component(void** state)
{
    (void)state;
    hdrp_v2 a2 = hdrp_v2_make(1.0f, 2.0f), b2 = hdrp_v2_make(4.0f, 8.0f);
    hdrp_v3 a = hdrp_v3_make(1.0f, -2.0f, 3.0f), b = hdrp_v3_make(4.0f, 8.0f, 16.0f);
    hdrp_v4 a4 = hdrp_v4_make(1.0f, 2.0f, 3.0f, 4.0f), b4 = hdrp_v4_make(1.0f, 10.0f, 100.0f, 1e3f);
    expect_v2(hdrp_v2_add(a2, b2), 5.0f, 10.0f);
    expect_v2(hdrp_v2_sub(a2, b2), -3.0f, -6.0f);
    expect_v2(hdrp_v2_scale(b2, 0.5f), 2.0f, 4.0f);
    assert_true(hdrp_v2_dot(a2, b2) == 20.0f);
    expect_v3(hdrp_v3_add(a, b), 5.0f, 6.0f, 19.0f);
    expect_v3(hdrp_v3_sub(a, b), -3.0f, -10.0f, -13.0f);
    expect_v3(hdrp_v3_mul(a, b), 4.0f, -16.0f, 48.0f);
    expect_v3(hdrp_v3_scale(a, 2.0f), 2.0f, -4.0f, 6.0f);
    expect_v3(hdrp_v3_mad(a, b, 0.25f), 2.0f, 0.0f, 7.0f);
    expect_v3(hdrp_v3_neg(a), -1.0f, 2.0f, -3.0f);
    expect_v3(hdrp_v3_lerp(a, b, 0.0f), 1.0f, -2.0f, 3.0f);
    expect_v3(hdrp_v3_lerp(a, b, 1.0f), 4.0f, 8.0f, 16.0f);
    expect_v3(hdrp_v3_lerp(a, b, 0.5f), 2.5f, 3.0f, 9.5f);
    expect_v3(hdrp_v3_max(a, 0.0f), 1.0f, 0.0f, 3.0f);
    expect_v3(hdrp_v3_saturate(hdrp_v3_make(NAN, 0.25f, 3.0f)), 0.0f, 0.25f, 1.0f);
    assert_true(hdrp_v3_max_component(a) == 3.0f);
    assert_true(hdrp_v3_max_component(hdrp_v3_make(9.0f, 2.0f, 3.0f)) == 9.0f);
    assert_true(hdrp_v3_max_component(hdrp_v3_make(1.0f, 9.0f, 3.0f)) == 9.0f);
    assert_true(hdrp_v3_dot(a, b) == 36.0f);
    assert_true(hdrp_v4_dot(a4, b4) == 4321.0f);
    expect_v4(hdrp_v4_mul(a4, b4), 1.0f, 20.0f, 300.0f, 4000.0f);
}

static void lengths_are_those_of_pythagorean_quadruples(void** state)
{
    (void)state;
    hdrp_v3 n = hdrp_v3_normalize(hdrp_v3_make(2.0f, -3.0f, 6.0f));
    assert_true(hdrp_v3_length(hdrp_v3_make(2.0f, -3.0f, 6.0f)) == 7.0f);
    expect_near(n.x, 2.0 / 7.0);
    expect_near(n.y, -3.0 / 7.0);
    expect_near(n.z, 6.0 / 7.0);
}

/* Components chosen so that no two of the six products are equal; right-handed. */
static void a_cross_product_is_the_determinant(void** state)
{
    (void)state;
    hdrp_v3 a = hdrp_v3_make(2.0f, 3.0f, 5.0f), b = hdrp_v3_make(7.0f, 11.0f, 13.0f);
    hdrp_v3 x = hdrp_v3_make(1.0f, 0.0f, 0.0f), y = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    expect_v3(hdrp_v3_cross(x, y), 0.0f, 0.0f, 1.0f);
    expect_v3(hdrp_v3_cross(a, b), -16.0f, 9.0f, 1.0f);
}

static void every_result_has_a_sentence_of_its_own(void** state)
{
    (void)state;
    for (int i = HDRP_OK; i <= HDRP_ERROR_DRIVER + 1; ++i) {
        assert_true(hdrp_result_string((hdrp_result)i)[0] != '\0');
        for (int k = HDRP_OK; k < i; ++k) {
            assert_string_not_equal(hdrp_result_string((hdrp_result)i),
                                    hdrp_result_string((hdrp_result)k));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrappers_call_the_function_of_their_name),
        cmocka_unit_test(a_sign_is_never_zero),
        cmocka_unit_test(integers_and_bits_convert_both_ways),
        cmocka_unit_test(vectors_keep_the_order_of_their_components),
        cmocka_unit_test(vectors_compute_by_component),
        cmocka_unit_test(lengths_are_those_of_pythagorean_quadruples),
        cmocka_unit_test(a_cross_product_is_the_determinant),
        cmocka_unit_test(every_result_has_a_sentence_of_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
