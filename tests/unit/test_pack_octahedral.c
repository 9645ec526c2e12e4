/* test_pack_octahedral.c - octahedral normals: every code, and the sign of z.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_pack.h"

typedef hdrp_u32 (*encoder)(hdrp_v3 n, hdrp_u32 bits);
typedef hdrp_v3 (*decoder)(hdrp_u32 code, hdrp_u32 bits);

static const encoder encoders[] = {
    hdrp_pack_oct_snorm_from_normal, hdrp_pack_oct_snorm_from_normal_exact,
    hdrp_pack_oct_unorm_from_normal, hdrp_pack_oct_unorm_from_normal_exact};
static const decoder decoders[] = {hdrp_pack_normal_from_oct_snorm, hdrp_pack_normal_from_oct_snorm,
                                   hdrp_pack_normal_from_oct_unorm,
                                   hdrp_pack_normal_from_oct_unorm};

/* Every code is a unit vector, and that vector is encoded as itself. */
static void expect_all_codes(encoder encode, decoder decode, hdrp_u32 bits)
{
    hdrp_u32 bad = 0;
    for (hdrp_u32 code = 0; code < (1u << (2u * bits)); ++code) {
        hdrp_v3 n = decode(code, bits);
        hdrp_v3 again = decode(encode(n, bits), bits);
        float length2 = hdrp_v3_dot(n, n);
        bad += length2 > 0.9999995f && length2 < 1.0000005f ? 0u : 1u;
        bad += n.x == again.x && n.y == again.y && n.z == again.z ? 0u : 1u;
    }
    assert_int_equal(bad, 0);
}

static void every_snorm_12_code_is_a_fixed_point(void** state)
{
    (void)state;
    expect_all_codes(hdrp_pack_oct_snorm_from_normal, hdrp_pack_normal_from_oct_snorm, 12u);
}

static void every_unorm_12_code_is_a_fixed_point(void** state)
{
    (void)state;
    expect_all_codes(hdrp_pack_oct_unorm_from_normal, hdrp_pack_normal_from_oct_unorm, 12u);
}

static void every_8_bit_code_is_a_fixed_point_of_every_encoder(void** state)
{
    (void)state;
    for (int k = 0; k < 4; ++k) {
        for (hdrp_u32 bits = 2; bits <= 8; ++bits) {
            expect_all_codes(encoders[k], decoders[k], bits);
        }
    }
}

/* Of all codes on the side of the normal, of which the search sees four. */
static void the_exact_unorm_encoder_finds_the_nearest_code(void** state)
{
    const hdrp_u32 bits = 3u;
    hdrp_u32 random = 1u;
    (void)state;
    for (int i = 0; i < 60000; ++i) {
        float v[3], best = -2.0f;
        for (int c = 0; c < 3; ++c) {
            random = random * 1664525u + 1013904223u;
            v[c] = (float)(random >> 8) * 0x1p-23f - 1.0f;
        }
        hdrp_v3 n = hdrp_normalize_or(hdrp_v3_make(v[0], v[1], v[2]), hdrp_v3_splat(1.0f));
        for (hdrp_u32 code = 0u; code < (1u << (2u * bits)); ++code) {
            hdrp_v3 d = hdrp_pack_normal_from_oct_unorm(code, bits);
            if ((d.z < 0.0f) == (n.z < 0.0f)) {
                best = fmaxf(best, hdrp_v3_dot(d, n));
            }
        }
        hdrp_u32 found = hdrp_pack_oct_unorm_from_normal_exact(n, bits);
        assert_true(hdrp_v3_dot(hdrp_pack_normal_from_oct_unorm(found, bits), n) >= best - 3e-7f);
    }
}

/* Normals on and next to the equator: in the plane at every quarter of a step of 12 bits, with z
 * from 0 over denormals to two steps. */
static void the_sign_of_z_survives_at_every_seam(void** state)
{
    (void)state;
    const float heights[] = {0.0f, 1e-45f, 1e-30f, 1e-9f, 1e-7f, 1e-4f, 2.4e-4f, 4.9e-4f, 1e-3f};
    hdrp_u32 lost = 0;
    for (int i = 0; i <= 4 * 4095; ++i) {
        float x = (float)i / (4.0f * 4095.0f), y = 1.0f - x;
        for (int k = 0; k < 9 * 8; ++k) {
            float z = heights[k / 8];
            hdrp_v3 n =
                hdrp_v3_make(k & 1 ? -x : x, k & 2 ? -y : y, k & 4 ? -z : z); /* any length */
            for (int e = 0; e < 4; ++e) {
                lost += (decoders[e](encoders[e](n, 12u), 12u).z < 0.0f) == (n.z < 0.0f) ? 0u : 1u;
            }
        }
    }
    assert_int_equal(lost, 0);
}

static void the_sign_of_z_survives_at_any_width(void** state)
{
    (void)state;
    hdrp_u32 lost = 0, random = 1u;
    for (int i = 0; i < 200000; ++i) {
        float v[4];
        for (int k = 0; k < 4; ++k) {
            random = random * 1664525u + 1013904223u;
            v[k] = hdrp_f32_from_u32(random >> 8u) * 0x1p-23f - 1.0f;
        }
        float scale = hdrp_f32_from_bits((random % 127u) << 23u); /* 0, or 2^-126 to 2^-1 */
        hdrp_v3 n = hdrp_v3_make(v[0], v[1], v[2] * scale);
        for (int e = 0; e < 4; ++e) {
            hdrp_u32 bits = 2u + (hdrp_u32)(i % 15);
            hdrp_v3 m = decoders[e](encoders[e](n, bits), bits);
            lost += (m.z < 0.0f) == (n.z < 0.0f) ? 0u : 1u;
        }
    }
    assert_int_equal(lost, 0);
}

static double angle_degrees(hdrp_v3 a, hdrp_v3 b)
{
    double x = (double)a.x - (double)b.x, y = (double)a.y - (double)b.y;
    double z = (double)a.z - (double)b.z;
    return 2.0 * asin(0.5 * sqrt(x * x + y * y + z * z)) * 57.29577951308232;
}

/* What the sign of z is for: the frame of the decoded normal is the frame of the original. */
static void the_default_frame_survives_near_the_equator(void** state)
{
    (void)state;
    double worst = 0.0;
    for (int i = 0; i < 200000; ++i) {
        double phi = 6.283185307179586 * i / 200000.0;
        double z = ((i % 401) - 200) * 1e-5;
        hdrp_v3 n = hdrp_normalize_or(hdrp_v3_make((float)cos(phi), (float)sin(phi), (float)z),
                                      hdrp_v3_splat(0.0f));
        for (int e = 0; e < 4; ++e) {
            hdrp_v3 m = decoders[e](encoders[e](n, 12u), 12u);
            double error =
                angle_degrees(hdrp_basis_from_normal(n).tangent, hdrp_basis_from_normal(m).tangent);
            worst = fmax(worst, error);
        }
    }
    assert_true(worst > 0.01 && worst < 0.08);
}

static void expect_direction(hdrp_v3 n, float x, float y, float z)
{
    assert_true(n.x == x && n.y == y && n.z == z);
}

static void snorm_stores_the_axes_exactly(void** state)
{
    (void)state;
    for (int k = 0; k < 6; ++k) {
        float s = k & 1 ? -1.0f : 1.0f;
        float x = k / 2 == 0 ? s : 0.0f, y = k / 2 == 1 ? s : 0.0f, z = k / 2 == 2 ? s : 0.0f;
        for (int e = 0; e < 2; ++e) {
            expect_direction(decoders[e](encoders[e](hdrp_v3_make(x, y, z), 12u), 12u), x, y, z);
        }
    }
    assert_int_equal(hdrp_pack_oct_snorm_from_normal(hdrp_v3_make(0.0f, 0.0f, 7.0f), 12u), 0);
}

static void what_has_no_direction_is_plus_z(void** state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY, 0.0f, -0.0f, 1e-40f, HDRP_FLT_MAX};
    for (int i = 0; i < 7; ++i) {
        hdrp_v3 n = hdrp_v3_splat(bad[i]);
        for (int e = 0; e < 2; ++e) {
            expect_direction(decoders[e](encoders[e](n, 12u), 12u), 0.0f, 0.0f, 1.0f);
        }
        for (int e = 2; e < 4; ++e) {
            assert_true(decoders[e](encoders[e](n, 12u), 12u).z > 0.9999f);
        }
    }
    hdrp_v3 one_nan = hdrp_v3_make(0.6f, NAN, 0.8f);
    expect_direction(decoders[0](encoders[0](one_nan, 12u), 12u), 0.0f, 0.0f, 1.0f);
}

static void length_does_not_matter(void** state)
{
    (void)state;
    for (int e = 0; e < 4; ++e) {
        hdrp_u32 code = encoders[e](hdrp_v3_make(0.25f, -0.5f, -0.125f), 12u);
        hdrp_v3 huge = hdrp_v3_make(0x1p40f, -0x1p41f, -0x1p39f);
        hdrp_v3 tiny = hdrp_v3_make(0x1p-40f, -0x1p-39f, -0x1p-41f);
        assert_int_equal(encoders[e](huge, 12u), code);
        assert_int_equal(encoders[e](tiny, 12u), code);
    }
}

static void every_oct24_code_survives_three_bytes(void** state)
{
    (void)state;
    hdrp_u32 bad = 0;
    for (hdrp_u32 code = 0; code < (1u << 24); ++code) {
        hdrp_v3 target = hdrp_pack_oct24_target(code);
        bad += hdrp_pack_oct24_from_target(target) == code ? 0u : 1u;
    }
    assert_int_equal(bad, 0);
    /* 0xABC and 0xDEF: upper bytes alone in red and green, the low digits together in blue. */
    hdrp_v4 v = hdrp_v4_from_v3(hdrp_pack_oct24_target(0xdefabcu), 0.0f);
    assert_int_equal(hdrp_pack_rgba8_from_v4(v), 0xcfdeab);
    assert_int_equal(hdrp_pack_oct24_from_target(hdrp_v3_splat(NAN)), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_snorm_12_code_is_a_fixed_point),
        cmocka_unit_test(every_unorm_12_code_is_a_fixed_point),
        cmocka_unit_test(every_8_bit_code_is_a_fixed_point_of_every_encoder),
        cmocka_unit_test(the_exact_unorm_encoder_finds_the_nearest_code),
        cmocka_unit_test(the_sign_of_z_survives_at_every_seam),
        cmocka_unit_test(the_sign_of_z_survives_at_any_width),
        cmocka_unit_test(the_default_frame_survives_near_the_equator),
        cmocka_unit_test(snorm_stores_the_axes_exactly),
        cmocka_unit_test(what_has_no_direction_is_plus_z),
        cmocka_unit_test(length_does_not_matter),
        cmocka_unit_test(every_oct24_code_survives_three_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
