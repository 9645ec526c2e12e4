/* test_pack_float_uint.c - a float and an integer in one channel.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_pack.h"

static const hdrp_u32 targets[] = {8u, 10u, 16u};

static void every_code_of_every_split_survives(void** state)
{
    (void)state;
    for (int t = 0; t < 3; ++t) {
        for (hdrp_u32 bits_i = 0; bits_i <= targets[t]; ++bits_i) {
            hdrp_u32 bits_f = targets[t] - bits_i;
            for (hdrp_u32 code = 0; code < (1u << targets[t]); ++code) {
                hdrp_pack_float_uint_pair p =
                    hdrp_pack_float_uint_from_code(code, bits_i, targets[t]);
                /* By definition: integer division, and the remainder over its largest value. */
                hdrp_u32 parts = 1u << bits_f;
                double f = parts > 1u ? (double)(code % parts) / (double)(parts - 1u) : 0.0;
                assert_true(p.i == code / parts);
                assert_true(p.f == (float)f);
                assert_true(hdrp_pack_float_uint_code(p.f, p.i, bits_i, targets[t]) == code);
            }
        }
    }
}

static void every_code_of_every_split_survives_a_render_target(void** state)
{
    (void)state;
    for (int t = 0; t < 3; ++t) {
        double last = (double)((1u << targets[t]) - 1u);
        for (hdrp_u32 bits_i = 0; bits_i <= targets[t]; ++bits_i) {
            for (hdrp_u32 code = 0; code < (1u << targets[t]); ++code) {
                hdrp_pack_float_uint_pair p =
                    hdrp_pack_float_uint_from_code(code, bits_i, targets[t]);
                float value = hdrp_pack_float_uint(p.f, p.i, bits_i, targets[t]);
                /* The hardware multiplies and rounds; it may be off by 0.6 of a code, and what it
                 * stores must not depend on that. */
                assert_true(fabs((double)value * last - (double)code) < 0.01);
                assert_true(floor((double)value * last + 0.5) == (double)code);
                hdrp_pack_float_uint_pair q =
                    hdrp_pack_float_uint_from_target(value, bits_i, targets[t]);
                assert_true(q.i == p.i && q.f == p.f);
            }
        }
    }
}

static void a_filtered_or_inexact_fetch_still_gives_the_integer(void** state)
{
    (void)state;
    for (hdrp_u32 code = 0; code < 256u; ++code) {
        float value = hdrp_pack_float_from_unorm(code, 8u);
        for (int k = -1; k <= 1; ++k) {
            hdrp_pack_float_uint_pair p =
                hdrp_pack_float_uint_from_target(value + (float)k * (0.45f / 255.0f), 3u, 8u);
            assert_int_equal(p.i, code >> 5);
        }
    }
}

static void input_out_of_range_stays_in_its_field(void** state)
{
    (void)state;
    assert_int_equal(hdrp_pack_float_uint_code(NAN, 5u, 3u, 8u), 5 << 5);
    assert_int_equal(hdrp_pack_float_uint_code(2.0f, 5u, 3u, 8u), (5 << 5) | 31);
    assert_int_equal(hdrp_pack_float_uint_code(-1.0f, 0xffffffffu, 3u, 8u), 7 << 5);
    assert_int_equal(hdrp_pack_float_uint_code(1.0f, 0xffffffffu, 16u, 8u), 255);
    hdrp_pack_float_uint_pair p = hdrp_pack_float_uint_from_target(NAN, 3u, 8u);
    assert_true(p.f == 0.0f && p.i == 0u);
    p = hdrp_pack_float_uint_from_target(INFINITY, 3u, 8u);
    assert_true(p.f == 1.0f && p.i == 7u);
}

/* The example of the post: mask 2 in 4 bits and 1.0 in 6 bits of 10. */
static void the_published_example_packs_as_printed(void** state)
{
    (void)state;
    assert_int_equal(hdrp_pack_float_uint_code(1.0f, 2u, 4u, 10u), 0xbf); /* 0010 111111 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_code_of_every_split_survives),
        cmocka_unit_test(every_code_of_every_split_survives_a_render_target),
        cmocka_unit_test(a_filtered_or_inexact_fetch_still_gives_the_integer),
        cmocka_unit_test(input_out_of_range_stays_in_its_field),
        cmocka_unit_test(the_published_example_packs_as_printed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
