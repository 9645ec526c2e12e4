/* test_oit_sums.c - composites of weighted sums, the talk's constants, and what images default to.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define HDRP_OIT_IMPLEMENTATION
#include "hdrp_oit.h"

#define SIDE 4u

static hdrp_v3 black(void)
{
    return hdrp_v3_splat(0.0f);
}

/* ---- sums ------------------------------------------------------------------------------------ */

static void emission_is_seen_through_the_mean_of_an_even_medium(void** state)
{
    (void)state;
    for (double log2_r = -16.0; log2_r < 0.0; log2_r += 1.0 / 64.0) {
        double r = (double)(float)exp2(log2_r), expected = (1.0 - r) / -log(r);
        hdrp_oit_targets t;
        t.accum = hdrp_v4_make(0, 0, 0, 0);
        t.light = hdrp_v4_make(1, 1, 1, (float)r);
        double got = (double)hdrp_oit_composite(t, black(), 1.0f).x;
        assert_true(fabs(got - expected) <= 3e-6 * expected);
    }
}

static void light_is_limited_to_a_half_float_and_products_to_a_32nd(void** state)
{
    hdrp_v3 bright = hdrp_v3_make(1e9f, 65504.0f, 1.0f);
    hdrp_oit_fragment f = hdrp_oit_fragment_make(bright, bright, 1.0f, INFINITY);
    hdrp_oit_fragment added = hdrp_oit_fragment_make(black(), bright, 0.0f, 1.0f);
    hdrp_oit_targets t = hdrp_oit_weighted_export(f, 1.0f, 1.0f);
    hdrp_oit_targets a = hdrp_oit_weighted_export(added, 1.0f, 1.0f);
    (void)state;
    assert_true(f.premultiplied.x == 65504.0f && f.emission.y == 65504.0f);
    assert_true(f.z_view == 1e6f);
    assert_true(fabsf(t.accum.x - 2047.0f) <= 1e-3f && fabsf(a.light.x - 2047.0f) <= 1e-3f);
    /* The colour of the fragment stays, as the weight goes down with it. */
    assert_true(fabsf(t.accum.x / t.accum.w - 65504.0f) <= 0.01f);
    assert_true(32.0f * 2047.0f <= 65504.0f);
    /* And what covers without a colour. */
    for (int i = 1; i <= 2; ++i) {
        hdrp_oit_fragment dark = hdrp_oit_fragment_make(black(), black(), 0.5f * (float)i, 1.0f);
        float covers = hdrp_oit_weighted_export(dark, 3000.0f, 1.0f).accum.w;
        assert_true(fabsf(covers - (i == 1 ? 1500.0f : 2047.0f)) <= 1e-3f);
    }
}

/* ---- the talk -------------------------------------------------------------------------------- */

static void talk_exports_are_limited_as_shown(void** state)
{
    hdrp_oit_talk_settings s = hdrp_oit_talk_settings_make(1.0f, 1.0f);
    hdrp_oit_fragment f = hdrp_oit_fragment_make(hdrp_v3_splat(5000.0f), black(), 1.0f, 1000.0f);
    hdrp_oit_targets t = hdrp_oit_talk_export(f, s);
    (void)state;
    assert_true(t.accum.w == 5.0f && t.accum.x == 5000.0f); /* the bias, and 1000 times it */
    f = hdrp_oit_fragment_make(black(), hdrp_v3_splat(0.03125f), 0.5f, 1000.0f);
    t = hdrp_oit_talk_export(f, s);
    assert_true(fabsf(t.light.w - 0.0390625f) <= 1e-7f); /* ten times it, and an eighth */
}

/* The shader in the appendix of the talk, in double. */
static double talk_mean_factor(double revealage, double additiveness)
{
    double amplify = additiveness * 8.0;
    double added = amplify * 0.25 + (amplify - amplify * 0.25) * revealage;
    double opaque = fmin((1.0 - revealage) * 2.0, 1.0);
    return fmax(added + opaque, 1.0);
}

static void talk_composites_are_amplified_as_shown(void** state)
{
    (void)state;
    for (int i = 0; i <= 32; ++i) {
        for (int k = 0; k <= 32; ++k) {
            double r = i / 32.0, additive = k / 32.0;
            hdrp_oit_targets t;
            t.accum = hdrp_v4_make(3.0f, 1.5f, 0.0f, 6.0f);
            t.light = hdrp_v4_make((float)r, 0, 0, (float)additive);
            hdrp_v3 got = hdrp_oit_talk_composite(t, hdrp_v3_splat(2.0f));
            double factor = talk_mean_factor(r, additive);
            assert_true(fabs((double)got.x - (0.5 * factor + 2.0 * r)) <= 2e-6);
            assert_true(fabs((double)got.y - (0.25 * factor + 2.0 * r)) <= 2e-6);
            assert_true(fabs((double)got.z - 2.0 * r) <= 2e-6);
        }
    }
}

/* ---- images ---------------------------------------------------------------------------------- */

static hdrp_oit_desc desc_of(hdrp_oit_mode mode)
{
    hdrp_oit_desc d;
    memset(&d, 0, sizeof d);
    d.width_px = SIDE;
    d.height_px = SIDE;
    d.mode = mode;
    d.precision = HDRP_OIT_PRECISION_FLOAT;
    return d;
}

static hdrp_result init(hdrp_oit_image* image, const hdrp_oit_desc* d)
{
    _Alignas(16) static char memory[1 << 16];
    return hdrp_oit_image_init(image, d, memory, sizeof memory);
}

/* Two layers of dim colours in a pixel. */
static hdrp_v3 drawn(const hdrp_oit_desc* d)
{
    const hdrp_oit_fragment f[2] = {
        hdrp_oit_fragment_make(hdrp_v3_make(0.2f, 0.0f, 0.1f), black(), 0.4f, 1.5f),
        hdrp_oit_fragment_make(hdrp_v3_make(0.0f, 0.3f, 0.1f), hdrp_v3_splat(0.05f), 0.1f, 2.5f)};
    const uint32_t pixels[2] = {0, 0};
    hdrp_oit_image image;
    hdrp_v3 behind[SIDE * SIDE], color[SIDE * SIDE];
    memset(behind, 0, sizeof behind);
    assert_int_equal(init(&image, d), HDRP_OK);
    hdrp_oit_blend_rows(&image, 0, f, pixels, 2, 0, SIDE);
    hdrp_oit_composite_rows(&image, behind, color, 0, SIDE);
    return color[0];
}

static int same(hdrp_v3 a, hdrp_v3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void zeros_are_the_defaults_that_are_written_down(void** state)
{
    hdrp_oit_desc eq10 = desc_of(HDRP_OIT_MODE_EQ10), talk = desc_of(HDRP_OIT_MODE_TALK_WEIGHT);
    hdrp_v3 by_eq10 = drawn(&eq10), by_talk = drawn(&talk);
    hdrp_oit_image image;
    (void)state;
    eq10.near_m = 0.5f;
    eq10.far_m = 300.0f;
    eq10.scale = 1.0f;
    assert_true(same(drawn(&eq10), by_eq10));
    talk.feather = 1.0f / 3.0f;
    talk.exposure = 1.0f;
    assert_true(same(drawn(&talk), by_talk));
    /* They are not what the weight leaves out. */
    eq10.near_m = 2.0f; /* behind the first layer: else ratios of weights are the same */
    assert_false(same(drawn(&eq10), by_eq10));
    talk.feather = 0.5f;
    assert_false(same(drawn(&talk), by_talk));
    assert_int_equal(init(&image, &(hdrp_oit_desc){SIDE, SIDE, HDRP_OIT_MODE_EQ10,
                                                   HDRP_OIT_PRECISION_NATIVE, 0, 0, 0, 0, 0}),
                     HDRP_OK);
    assert_true(image.desc.scale == 1.0f && image.desc.near_m == 0.5f);
    assert_true(image.desc.far_m == 300.0f && image.desc.exposure == 1.0f);
}

/* A fragment at the far plane of eq. 10 weighs the least that there is, before it more. */
static void device_depth_is_that_of_a_perspective(void** state)
{
    hdrp_oit_desc d = desc_of(HDRP_OIT_MODE_EQ10);
    const uint32_t pixel = 0;
    hdrp_oit_image image;
    (void)state;
    d.near_m = 1.0f;
    d.far_m = 9.0f;
    for (float z = 1.0f; z < 9.0f; z += 0.25f) {
        hdrp_oit_fragment f = hdrp_oit_fragment_make(black(), black(), 0.5f, z);
        double depth = (1.0 / 1.0 - 1.0 / (double)z) / (1.0 / 1.0 - 1.0 / 9.0);
        double expected = 0.5 * fmax(3e3 * pow(1.0 - depth, 3.0), 0.01) * 0.5;
        assert_int_equal(init(&image, &d), HDRP_OK);
        hdrp_oit_blend_rows(&image, 0, &f, &pixel, 1, 0, SIDE);
        assert_true(fabs((double)image.texels[0].w - expected) <= 2e-5 * expected);
    }
}

static void ranges_of_descriptions_are_closed(void** state)
{
    static const float limits[3] = {1048576.0f, 1.0f, 1e9f};
    hdrp_oit_image image;
    (void)state;
    for (int i = 0; i < 6; ++i) {
        hdrp_oit_desc d = desc_of(HDRP_OIT_MODE_TALK);
        float above = nextafterf(limits[i / 2], INFINITY);
        float value = i % 2 == 0 ? limits[i / 2] : above;
        *(i / 2 == 0 ? &d.scale : i / 2 == 1 ? &d.feather : &d.exposure) = value;
        assert_int_equal(init(&image, &d), i % 2 == 0 ? HDRP_OK : HDRP_ERROR_BAD_ARGUMENT);
    }
    static const float depths[4][2] = {{0.5f, 0.5f}, {0.0f, 0.3f}, {300.0f, 0.0f}, {9.0f, 8.0f}};
    for (int i = 0; i < 4; ++i) { /* near before far, the defaults included */
        hdrp_oit_desc d = desc_of(HDRP_OIT_MODE_EQ10);
        d.near_m = depths[i][0];
        d.far_m = depths[i][1];
        assert_int_equal(init(&image, &d), HDRP_ERROR_BAD_ARGUMENT);
    }
    hdrp_oit_desc late = desc_of(HDRP_OIT_MODE_EQ10);
    late.near_m = 299.0f;
    assert_int_equal(init(&image, &late), HDRP_OK);
    hdrp_oit_desc far_away = desc_of(HDRP_OIT_MODE_EQ10);
    far_away.far_m = 1e6f;
    assert_int_equal(init(&image, &far_away), HDRP_OK);
    far_away.far_m = nextafterf(1e6f, INFINITY);
    assert_int_equal(init(&image, &far_away), HDRP_ERROR_BAD_ARGUMENT);
}

/* A row that is covered at half of the resolution fades over the next two, as columns do. */
static void low_rows_fade_into_each_other(void** state)
{
    const float share[8] = {1.0f, 1.0f, 1.0f, 0.75f, 0.25f, 0.0f, 0.0f, 0.0f};
    const hdrp_oit_fragment f = hdrp_oit_fragment_make(hdrp_v3_splat(0.25f), black(), 0.5f, 4.0f);
    _Alignas(16) static char memory[2][1 << 12];
    const hdrp_oit_fragment both[2] = {f, f};
    const uint32_t pixels[2] = {0, 1};
    hdrp_oit_desc d = desc_of(HDRP_OIT_MODE_RECOMMENDED);
    hdrp_oit_image high, low;
    hdrp_v3 behind[8], color[8];
    (void)state;
    memset(behind, 0, sizeof behind);
    d.width_px = 1;
    d.height_px = 8;
    assert_int_equal(hdrp_oit_image_init(&high, &d, memory[0], sizeof memory[0]), HDRP_OK);
    d.height_px = 4;
    assert_int_equal(hdrp_oit_image_init(&low, &d, memory[1], sizeof memory[1]), HDRP_OK);
    hdrp_oit_blend_rows(&low, 0, both, pixels, 2, 0, 4);
    assert_int_equal(hdrp_oit_merge_rows(&high, &low, 0, 8), HDRP_OK);
    hdrp_oit_composite_rows(&high, behind, color, 0, 8);
    for (int i = 0; i < 8; ++i) {
        assert_true(fabsf(color[i].y - 0.25f * share[i]) < 1e-6f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(emission_is_seen_through_the_mean_of_an_even_medium),
        cmocka_unit_test(light_is_limited_to_a_half_float_and_products_to_a_32nd),
        cmocka_unit_test(talk_exports_are_limited_as_shown),
        cmocka_unit_test(talk_composites_are_amplified_as_shown),
        cmocka_unit_test(zeros_are_the_defaults_that_are_written_down),
        cmocka_unit_test(device_depth_is_that_of_a_perspective),
        cmocka_unit_test(ranges_of_descriptions_are_closed),
        cmocka_unit_test(low_rows_fade_into_each_other),
    };
    return cmocka_run_group_tests_name("oit sums", tests, NULL, NULL);
}
