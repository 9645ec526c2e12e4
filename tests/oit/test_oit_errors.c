/* test_oit_errors.c - errors against sorting stay below what is promised, and are those on record.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "oit_harness.h"
#include "oit_motion.h"

static const char* const precisions[] = {"native", "compact", "float"};

static const oit_case* case_named(const char* name)
{
    for (size_t i = 0; i < oit_case_count; ++i) {
        if (strcmp(oit_cases[i].name, name) == 0) {
            return &oit_cases[i];
        }
    }
    fail_msg("no case %s", name);
    return NULL;
}

static oit_error measure(const char* name, hdrp_oit_mode mode, hdrp_oit_precision precision)
{
    const oit_case* c = case_named(name);
    oit_pixels pixels;
    oit_error e;
    oit_generate(c, &pixels);
    e = oit_measure(c, &pixels, mode, precision);
    oit_free(&pixels);
    return e;
}

static void holds(const char* name, hdrp_oit_mode mode, double bound)
{
    oit_error e = measure(name, mode, HDRP_OIT_PRECISION_NATIVE);
    if (!(e.rms <= bound)) {
        fail_msg("%s on %s: RMSE %.5f, at most %.5f", oit_mode_name(mode), name, e.rms, bound);
    }
}

static void recommended_is_as_good_as_promised(void** state)
{
    (void)state;
    holds("low", HDRP_OIT_MODE_RECOMMENDED, 0.030);
    holds("mixed", HDRP_OIT_MODE_RECOMMENDED, 0.095);
    holds("high", HDRP_OIT_MODE_RECOMMENDED, 0.125);
}

static void recommended_holds_on_depths_it_was_not_fitted_on(void** state)
{
    (void)state;
    holds("low_1_10", HDRP_OIT_MODE_RECOMMENDED, 0.035);
    holds("mixed_1_10", HDRP_OIT_MODE_RECOMMENDED, 0.125);
    holds("high_1_10", HDRP_OIT_MODE_RECOMMENDED, 0.18);
    holds("low_0.1_1000", HDRP_OIT_MODE_RECOMMENDED, 0.035);
    holds("mixed_0.1_1000", HDRP_OIT_MODE_RECOMMENDED, 0.125);
    holds("high_0.1_1000", HDRP_OIT_MODE_RECOMMENDED, 0.18);
}

/* A third less than with all emission in sums of its own. */
static void recommended_shares_what_covers_and_emits(void** state)
{
    (void)state;
    holds("shining_low", HDRP_OIT_MODE_RECOMMENDED, 0.17);
    holds("shining", HDRP_OIT_MODE_RECOMMENDED, 0.26);
    holds("shining_high", HDRP_OIT_MODE_RECOMMENDED, 0.19);
}

static void recommended_is_the_same_at_every_exposure(void** state)
{
    (void)state;
    holds("stops_-10", HDRP_OIT_MODE_RECOMMENDED, 0.095);
    holds("stops_-5", HDRP_OIT_MODE_RECOMMENDED, 0.095);
    holds("stops_5", HDRP_OIT_MODE_RECOMMENDED, 0.095);
    holds("stops_10", HDRP_OIT_MODE_RECOMMENDED, 0.095);
    holds("stops_-10_scaled", HDRP_OIT_MODE_RECOMMENDED, 0.095);
}

static void better_modes_are_as_good_as_promised(void** state)
{
    static const hdrp_oit_mode better[2] = {HDRP_OIT_MODE_WAVELET, HDRP_OIT_MODE_MOMENTS_6};
    static const char* const ranges[3] = {"", "_1_10", "_0.1_1000"};
    (void)state;
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 3; ++k) {
            char name[32];
            snprintf(name, sizeof name, "low%s", ranges[k]);
            holds(name, better[i], 0.006);
            snprintf(name, sizeof name, "mixed%s", ranges[k]);
            holds(name, better[i], 0.020);
            snprintf(name, sizeof name, "high%s", ranges[k]);
            holds(name, better[i], 0.015);
        }
        holds("pane", better[i], 0.07);
    }
    for (uint32_t m = HDRP_OIT_MODE_WAVELET; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        holds("half_emissive", (hdrp_oit_mode)m, 0.03);
    }
    holds("shining_low", HDRP_OIT_MODE_WAVELET, 0.03);
    holds("shining_low", HDRP_OIT_MODE_MOMENTS_6, 0.035);
    holds("shining_high", HDRP_OIT_MODE_WAVELET, 0.02);
    holds("shining_high", HDRP_OIT_MODE_MOMENTS_6, 0.02);
    holds("low", HDRP_OIT_MODE_MOMENTS_4, 0.006);
    holds("mixed", HDRP_OIT_MODE_MOMENTS_4, 0.032);
    holds("high", HDRP_OIT_MODE_MOMENTS_4, 0.060);
}

static void a_front_apart_is_worth_a_pass_of_depth(void** state)
{
    (void)state;
    holds("low", HDRP_OIT_MODE_FRONT, 0.014);
    holds("mixed", HDRP_OIT_MODE_FRONT, 0.045);
    holds("high", HDRP_OIT_MODE_FRONT, 0.015);
    holds("half_emissive", HDRP_OIT_MODE_FRONT, 0.15);
    holds("front_99", HDRP_OIT_MODE_FRONT, 0.002);
}

static void what_only_adds_is_exact_with_emission_apart(void** state)
{
    (void)state;
    for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
        oit_error e = measure("additive", (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT);
        if (m != HDRP_OIT_MODE_TALK) {
            assert_true(e.largest <= 4e-6);
        }
        e = measure("additive", (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE);
        if (m != HDRP_OIT_MODE_TALK) {
            assert_true(e.largest <= 12 * 0x1p-10); /* 12 roundings below 4 */
        }
    }
}

static void a_dense_front_hides_what_is_behind(void** state)
{
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_FRONT; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        oit_error e = measure("front_99", (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE);
        assert_true(e.largest <= 0.03);
    }
    holds("front_99", HDRP_OIT_MODE_RECOMMENDED, 0.07);
}

static void errors_are_those_on_record(void** state)
{
    char line[256], name[64], mode[32], precision[16];
    double rms, largest;
    unsigned bytes, passes;
    size_t rows = 0;
    FILE* in = fopen(OIT_RECORDED, "r");
    (void)state;
    assert_non_null(in);
    assert_non_null(fgets(line, sizeof line, in));
    for (size_t i = 0; i < oit_case_count; ++i) {
        oit_pixels pixels;
        oit_generate(&oit_cases[i], &pixels);
        for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
            for (int k = 0; k < 3; ++k, ++rows) {
                oit_error e =
                    oit_measure(&oit_cases[i], &pixels, (hdrp_oit_mode)m, (hdrp_oit_precision)k);
                assert_non_null(fgets(line, sizeof line, in));
                assert_int_equal(sscanf(line, "%63[^,],%31[^,],%15[^,],%u,%u,%lf,%lf", name, mode,
                                        precision, &bytes, &passes, &rms, &largest),
                                 7);
                assert_string_equal(name, oit_cases[i].name);
                assert_string_equal(mode, oit_mode_name((hdrp_oit_mode)m));
                assert_string_equal(precision, precisions[k]);
                assert_int_equal(bytes,
                                 hdrp_oit_bytes_per_pixel((hdrp_oit_mode)m, (hdrp_oit_precision)k));
                assert_true(fabs(e.rms - rms) <= 0.02 * rms + 2e-5);
            }
        }
        oit_free(&pixels);
    }
    assert_null(fgets(line, sizeof line, in));
    fclose(in);
}

/* One pass changes as smoothly as the scene; better modes are as abrupt as sorting each pixel. */
static void nothing_jumps_that_sorting_cards_makes_jump(void** state)
{
    motion_step crossing[MOTION_WAYS], orbit[MOTION_WAYS];
    (void)state;
    assert_true(motion_measure(MOTION_CROSSING, crossing) && motion_measure(MOTION_ORBIT, orbit));
    assert_true(crossing[MOTION_SORTED_CARDS].picture > 0.05);
    for (uint32_t way = 0; way < HDRP_OIT_MODE_COUNT; ++way) {
        assert_true(crossing[way].picture <= 0.15 * crossing[MOTION_SORTED_CARDS].picture);
        assert_true(crossing[way].picture <= 0.6 * crossing[MOTION_SORTED_PIXELS].picture);
    }
    assert_true(orbit[HDRP_OIT_MODE_RECOMMENDED].picture <= 0.001);
    assert_true(orbit[HDRP_OIT_MODE_RECOMMENDED].pixel <= 0.01);
    for (uint32_t way = HDRP_OIT_MODE_WAVELET; way <= HDRP_OIT_MODE_MOMENTS_4; ++way) {
        assert_true(orbit[way].picture <= 1.05 * orbit[MOTION_SORTED_PIXELS].picture);
    }
}

static void steps_are_those_on_record(void** state)
{
    char line[256], name[32], way_name[32];
    double picture, pixel, rms;
    FILE* in = fopen(OIT_STEPS_RECORDED, "r");
    (void)state;
    assert_non_null(in);
    assert_non_null(fgets(line, sizeof line, in));
    for (int s = 0; s < MOTION_SEQUENCES; ++s) {
        motion_step steps[MOTION_WAYS];
        assert_true(motion_measure((motion_sequence)s, steps));
        for (int way = 0; way < MOTION_WAYS; ++way) {
            assert_non_null(fgets(line, sizeof line, in));
            assert_int_equal(
                sscanf(line, "%31[^,],%31[^,],%lf,%lf,%lf", name, way_name, &picture, &pixel, &rms),
                5);
            assert_string_equal(name, motion_sequence_name((motion_sequence)s));
            assert_string_equal(way_name, motion_way_name(way));
            assert_true(fabs(steps[way].picture - picture) <= 0.02 * picture + 2e-5);
            assert_true(fabs(steps[way].error - rms) <= 0.02 * rms + 2e-5);
        }
    }
    assert_null(fgets(line, sizeof line, in));
    fclose(in);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recommended_is_as_good_as_promised),
        cmocka_unit_test(recommended_holds_on_depths_it_was_not_fitted_on),
        cmocka_unit_test(recommended_shares_what_covers_and_emits),
        cmocka_unit_test(recommended_is_the_same_at_every_exposure),
        cmocka_unit_test(better_modes_are_as_good_as_promised),
        cmocka_unit_test(a_front_apart_is_worth_a_pass_of_depth),
        cmocka_unit_test(what_only_adds_is_exact_with_emission_apart),
        cmocka_unit_test(a_dense_front_hides_what_is_behind),
        cmocka_unit_test(errors_are_those_on_record),
        cmocka_unit_test(nothing_jumps_that_sorting_cards_makes_jump),
        cmocka_unit_test(steps_are_those_on_record),
    };
    return cmocka_run_group_tests_name("oit errors", tests, NULL, NULL);
}
