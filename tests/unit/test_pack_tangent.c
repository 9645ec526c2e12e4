/* test_pack_tangent.c - the angle of a tangent in the default frame.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_pack.h"

static hdrp_u32 random_state = 1u;

static float random_signed(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return hdrp_f32_from_u32(random_state >> 8u) * 0x1p-23f - 1.0f;
}

/* Every other one within 1e-3 of the equator, on either side. */
static hdrp_v3 random_normal(int i)
{
    hdrp_v3 n;
    do {
        n = hdrp_v3_make(random_signed(), random_signed(), random_signed());
        n.z *= i % 2 ? 1e-3f : 1.0f;
    } while (hdrp_v3_dot(n, n) < 0.01f);
    return hdrp_v3_normalize(n);
}

static hdrp_v3 random_tangent(hdrp_v3 n)
{
    hdrp_v3 t;
    do {
        t = hdrp_v3_cross(n, hdrp_v3_make(random_signed(), random_signed(), random_signed()));
    } while (hdrp_v3_dot(t, t) < 0.01f);
    return hdrp_v3_normalize(t);
}

/* From the chord, which keeps its precision for small angles. */
static double angle_degrees(hdrp_v3 a, hdrp_v3 b)
{
    double x = (double)a.x - (double)b.x, y = (double)a.y - (double)b.y;
    double z = (double)a.z - (double)b.z;
    return 2.0 * asin(fmin(0.5 * sqrt(x * x + y * y + z * z), 1.0)) * 57.29577951308232;
}

static void every_code_survives(void** state)
{
    (void)state;
    for (int i = 0; i < 200; ++i) {
        hdrp_v3 n = random_normal(i);
        for (hdrp_u32 code = 0; code < 2048u; ++code) {
            hdrp_v3 t = hdrp_pack_tangent_from_angle11(n, code);
            assert_true(fabsf(hdrp_v3_dot(t, n)) < 1e-6f);
            assert_true(fabsf(hdrp_v3_dot(t, t) - 1.0f) < 1e-6f);
            assert_int_equal(hdrp_pack_angle11_from_tangent(n, t), code);
            assert_int_equal(hdrp_pack_angle11_from_tangent(n, hdrp_v3_neg(t)), code);
        }
    }
}

static void every_fast_code_is_a_tangent_that_survives(void** state)
{
    (void)state;
    for (int i = 0; i < 200; ++i) {
        hdrp_v3 n = random_normal(i);
        for (hdrp_u32 code = 0; code < 2048u; ++code) {
            hdrp_v3 t = hdrp_pack_tangent_from_angle11_fast(n, code);
            assert_true(fabsf(hdrp_v3_dot(t, n)) < 1e-6f);
            assert_true(fabsf(hdrp_v3_dot(t, t) - 1.0f) < 1e-6f);
            /* On an axis and on a diagonal two flags say the same: compare directions. */
            hdrp_u32 again = hdrp_pack_angle11_from_tangent_fast(n, t);
            assert_true(angle_degrees(hdrp_pack_tangent_from_angle11_fast(n, again), t) < 1e-4);
        }
    }
}

/* Where the flags change: a multiple of 45 degrees, and one step of a float to either side. */
static void fast_flags_agree_on_the_borders_of_octants(void** state)
{
    (void)state;
    hdrp_v3 n = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    const float s[] = {0.0f, -0.0f, 1e-7f, -1e-7f, 0.70710678f, 0.70710685f, 0.7071067f};
    const float c[] = {1.0f, 1.0f, 1.0f, 1.0f, 0.70710678f, 0.7071067f, 0.70710685f};
    for (int i = 0; i < 7 * 8; ++i) {
        float x = i & 8 ? s[i % 7] : c[i % 7], y = i & 8 ? c[i % 7] : s[i % 7];
        hdrp_v3 t = hdrp_v3_make(i & 1 ? -x : x, i & 2 ? -y : y, 0.0f);
        hdrp_u32 code = hdrp_pack_angle11_from_tangent_fast(n, t);
        assert_true(angle_degrees(hdrp_pack_tangent_from_angle11_fast(n, code), t) < 1e-4);
    }
}

static void what_has_no_angle_is_the_default_tangent(void** state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY, 0.0f, HDRP_FLT_MAX, 1e-40f};
    hdrp_v3 n = hdrp_v3_make(0.6f, 0.0f, -0.8f);
    hdrp_v3 t = hdrp_basis_from_normal(n).tangent;
    for (int i = 0; i < 6; ++i) {
        hdrp_u32 code = hdrp_pack_angle11_from_tangent(n, hdrp_v3_splat(bad[i]));
        hdrp_u32 fast = hdrp_pack_angle11_from_tangent_fast(n, hdrp_v3_splat(bad[i]));
        assert_int_equal(code, 0);
        assert_true(angle_degrees(hdrp_pack_tangent_from_angle11(n, code), t) < 1e-4);
        assert_true(angle_degrees(hdrp_pack_tangent_from_angle11_fast(n, fast), t) < 1e-4);
    }
}

/* Normal and tangent packed together, as the GBuffer does it and as the slides do it: these take
 * the angle in the frame of the unpacked normal, which only works because the sign of z
 * survives. */
static void the_whole_pipeline_keeps_its_ceilings(void** state)
{
    (void)state;
    double decoded_frame = 0.0, original_frame = 0.0;
    for (int i = 0; i < 400000; ++i) {
        hdrp_v3 n = random_normal(i), t = random_tangent(n);
        hdrp_v3 m = hdrp_pack_normal_from_oct_snorm(hdrp_pack_oct_snorm_from_normal(n, 12u), 12u);
        hdrp_v3 a = hdrp_pack_tangent_from_angle11(m, hdrp_pack_angle11_from_tangent(m, t));
        hdrp_v3 b =
            hdrp_pack_tangent_from_angle11_fast(m, hdrp_pack_angle11_from_tangent_fast(n, t));
        decoded_frame =
            fmax(decoded_frame, fmin(angle_degrees(a, t), angle_degrees(hdrp_v3_neg(a), t)));
        original_frame = fmax(original_frame, angle_degrees(b, t));
    }
    assert_true(decoded_frame > 0.06 && decoded_frame <= 0.075);
    assert_true(original_frame > 0.12 && original_frame <= 0.17);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_code_survives),
        cmocka_unit_test(every_fast_code_is_a_tangent_that_survives),
        cmocka_unit_test(fast_flags_agree_on_the_borders_of_octants),
        cmocka_unit_test(what_has_no_angle_is_the_default_tangent),
        cmocka_unit_test(the_whole_pipeline_keeps_its_ceilings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
