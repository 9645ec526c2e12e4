/* test_math_depth.c - device depth of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_math.h"

static bool within(float x, double expected, double relative)
{
    return fabs((double)x - expected) <= relative * fabs(expected);
}

static void the_ends_are_the_near_and_the_far_distance(void** state)
{
    (void)state;
    for (uint32_t reverse = 0; reverse < 2u; ++reverse) {
        float at_near = reverse ? 1.0f : 0.0f, at_far = 1.0f - at_near;
        hdrp_depth_params p = hdrp_depth_params_perspective(0.25f, 1000.0f, reverse);
        assert_true(within(hdrp_view_depth(p, at_near), 0.25, 2e-7));
        assert_true(within(hdrp_view_depth(p, at_far), 1000.0, 2e-7));
        assert_true(hdrp_device_depth(p, 0.25f) == at_near);
        assert_true(hdrp_device_depth(p, 1000.0f) == at_far);
        p = hdrp_depth_params_orthographic(0.25f, 1000.0f, reverse);
        assert_true(hdrp_view_depth(p, at_near) == 0.25f);
        assert_true(hdrp_view_depth(p, at_far) == 1000.0f);
        assert_true(hdrp_device_depth(p, 0.25f) == at_near);
        assert_true(hdrp_device_depth(p, 1000.0f) == at_far);
        /* In the middle: 2 n f / (n + f), and (n + f) / 2. */
        assert_true(within(hdrp_view_depth(p, 0.5f), 500.125, 1e-7));
        p = hdrp_depth_params_perspective(0.25f, 1000.0f, reverse);
        assert_true(within(hdrp_view_depth(p, 0.5f), 500.0 / 1000.25, 2e-7));
    }
}

static void an_infinite_projection_ends_nowhere(void** state)
{
    const float far_m[] = {HDRP_DEPTH_INFINITE, 2e18f, (float)INFINITY};
    (void)state;
    for (int i = 0; i < 3; ++i) {
        hdrp_depth_params p = hdrp_depth_params_perspective(0.5f, far_m[i], 1u);
        assert_true(hdrp_view_depth(p, 0.0f) == HDRP_DEPTH_INFINITE);
        assert_true(hdrp_view_depth(p, 1e-30f) == HDRP_DEPTH_INFINITE);
        assert_true(within(hdrp_view_depth(p, 1e-10f), 5e9, 2e-7));
        assert_true(within(hdrp_device_depth(p, 5e9f), 1e-10, 2e-7));
        assert_true(within(hdrp_device_depth(p, 1e30f), 5e-19, 2e-7));
        assert_true(within(hdrp_device_depth(p, (float)INFINITY), 5e-19, 2e-7));
        assert_true(within(hdrp_device_depth(p, (float)NAN), 5e-19, 2e-7));
        p = hdrp_depth_params_perspective(0.5f, far_m[i], 0u);
        assert_true(hdrp_view_depth(p, 1.0f) == HDRP_DEPTH_INFINITE);
        assert_true(hdrp_view_depth(p, 0.0f) == 0.5f);
        assert_true(hdrp_view_depth(p, 0.75f) == 2.0f);
    }
}

static void what_is_outside_counts_as_the_nearer_end(void** state)
{
    const float nan = (float)NAN, inf = (float)INFINITY;
    hdrp_depth_params p = hdrp_depth_params_perspective(0.5f, 100.0f, 1u);
    (void)state;
    assert_true(hdrp_view_depth(p, 2.0f) == hdrp_view_depth(p, 1.0f));
    assert_true(hdrp_view_depth(p, inf) == hdrp_view_depth(p, 1.0f));
    assert_true(hdrp_view_depth(p, -2.0f) == hdrp_view_depth(p, 0.0f));
    assert_true(hdrp_view_depth(p, nan) == hdrp_view_depth(p, 0.0f));
    for (uint32_t reverse = 0; reverse < 2u; ++reverse) {
        float at_near = reverse ? 1.0f : 0.0f, at_far = 1.0f - at_near;
        for (int flat = 0; flat < 2; ++flat) {
            p = flat ? hdrp_depth_params_orthographic(0.5f, 100.0f, reverse)
                     : hdrp_depth_params_perspective(0.5f, 100.0f, reverse);
            assert_true(hdrp_device_depth(p, 0.1f) == at_near);
            assert_true(hdrp_device_depth(p, 0.0f) == at_near);
            assert_true(hdrp_device_depth(p, -3.0f) == at_near);
            assert_true(hdrp_device_depth(p, -inf) == at_near);
            assert_true(hdrp_device_depth(p, 1e30f) == at_far);
            assert_true(hdrp_device_depth(p, inf) == at_far);
            assert_true(hdrp_device_depth(p, nan) == at_far);
        }
    }
    /* A far plane in front of the near one counts as at it. */
    p = hdrp_depth_params_perspective(2.0f, 1.0f, 1u);
    assert_true(hdrp_view_depth(p, 0.0f) == 2.0f && hdrp_view_depth(p, 1.0f) == 2.0f);
    p = hdrp_depth_params_orthographic(2.0f, 2.0f, 1u);
    assert_true(hdrp_view_depth(p, 0.0f) == 2.0f && hdrp_view_depth(p, 1.0f) == 2.0f);
    assert_true(hdrp_device_depth(p, 1.0f) == 1.0f && hdrp_device_depth(p, 3.0f) == 0.0f);
}

static void device_depth_inverts_view_depth(void** state)
{
    (void)state;
    for (double z = 0.1; z < 1e4; z *= 1.01) {
        hdrp_depth_params p = hdrp_depth_params_perspective(0.1f, 1e4f, 1u);
        assert_true(within(hdrp_view_depth(p, hdrp_device_depth(p, (float)z)), z, 1e-6));
        p = hdrp_depth_params_orthographic(0.1f, 1e4f, 1u);
        assert_true(fabs((double)hdrp_view_depth(p, hdrp_device_depth(p, (float)z)) - z) < 2e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_ends_are_the_near_and_the_far_distance),
        cmocka_unit_test(an_infinite_projection_ends_nowhere),
        cmocka_unit_test(what_is_outside_counts_as_the_nearer_end),
        cmocka_unit_test(device_depth_inverts_view_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
