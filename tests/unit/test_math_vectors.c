/* test_math_vectors.c - edges of the vector functions of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_math.h"

static void expect_v3(hdrp_v3 v, float x, float y, float z)
{
    assert_true(v.x == x && v.y == y && v.z == z);
}

static void normalize_or_takes_the_fallback(void** state)
{
    (void)state;
    hdrp_v3 fallback = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    float bad[] = {NAN, INFINITY, -INFINITY};
    expect_v3(hdrp_normalize_or(hdrp_v3_splat(0.0f), fallback), 0.0f, 1.0f, 0.0f);
    for (int i = 0; i < 3; ++i) {
        expect_v3(hdrp_normalize_or(hdrp_v3_make(bad[i], 0.0f, 0.0f), fallback), 0.0f, 1.0f, 0.0f);
        expect_v3(hdrp_normalize_or(hdrp_v3_make(1.0f, 0.0f, bad[i]), fallback), 0.0f, 1.0f, 0.0f);
        expect_v3(hdrp_normalize_or(hdrp_v3_splat(bad[i]), fallback), 0.0f, 1.0f, 0.0f);
    }
}

static void normalize_or_keeps_extreme_lengths(void** state)
{
    (void)state;
    float lengths[] = {1.40129846e-45f, HDRP_FLT_MIN, HDRP_FLT_MAX};
    for (int i = 0; i < 3; ++i) {
        expect_v3(hdrp_normalize_or(hdrp_v3_make(0.0f, -lengths[i], 0.0f), hdrp_v3_splat(0.0f)),
                  0.0f, -1.0f, 0.0f);
    }
}

static void basis_is_exact_on_the_axes(void** state)
{
    (void)state;
    hdrp_basis up = hdrp_basis_from_normal(hdrp_v3_make(0.0f, 0.0f, 1.0f));
    hdrp_basis down = hdrp_basis_from_normal(hdrp_v3_make(0.0f, 0.0f, -1.0f));
    expect_v3(hdrp_v3_cross(up.tangent, up.bitangent), 0.0f, 0.0f, 1.0f);
    expect_v3(hdrp_v3_cross(down.tangent, down.bitangent), 0.0f, 0.0f, -1.0f);
}

static void select_takes_the_first_where_the_condition_is_positive(void** state)
{
    (void)state;
    hdrp_v3 a = hdrp_v3_make(1.0f, 2.0f, 3.0f), b = hdrp_v3_make(-4.0f, -5.0f, -6.0f);
    expect_v3(hdrp_v3_select(1e-30f, a, b), 1.0f, 2.0f, 3.0f);
    expect_v3(hdrp_v3_select(0.0f, a, b), -4.0f, -5.0f, -6.0f);
    expect_v3(hdrp_v3_select(-1.0f, a, b), -4.0f, -5.0f, -6.0f);
    expect_v3(hdrp_v3_select(NAN, a, b), -4.0f, -5.0f, -6.0f);
}

static void limits_give_the_safe_bound_for_nan(void** state)
{
    (void)state;
    assert_true(hdrp_max(NAN, 2.0f) == 2.0f);
    assert_true(hdrp_min(NAN, 2.0f) == 2.0f);
    assert_true(hdrp_clamp(NAN, 3.0f, 4.0f) == 3.0f);
    assert_true(hdrp_saturate(NAN) == 0.0f);
    assert_true(hdrp_saturate(INFINITY) == 1.0f);
    assert_true(hdrp_lerp(5.0f, 7.0f, 1.0f) == 7.0f);
}

static void products_go_by_component(void** state)
{
    (void)state;
    hdrp_v4 p =
        hdrp_v4_mul(hdrp_v4_make(2.0f, 3.0f, 5.0f, 7.0f), hdrp_v4_make(11.0f, 13.0f, 17.0f, 19.0f));
    assert_true(p.x == 22.0f && p.y == 39.0f && p.z == 85.0f && p.w == 133.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normalize_or_takes_the_fallback),
        cmocka_unit_test(normalize_or_keeps_extreme_lengths),
        cmocka_unit_test(basis_is_exact_on_the_axes),
        cmocka_unit_test(select_takes_the_first_where_the_condition_is_positive),
        cmocka_unit_test(limits_give_the_safe_bound_for_nan),
        cmocka_unit_test(products_go_by_component),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
