/* acc_cull_grid.c - accuracy of hdrp_cull_grid.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_cull_grid.h"

static void log2_at(acc* a, float x)
{
    ACC_ADD(a, fabs((double)hdrp_cull_log2(x) - log2((double)x)), "x = %.9g", (double)x);
}

static void log2_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        log2_at(a, acc_float(acc_log_uniform(a, 1.2e-38, 3.4e38)));
        log2_at(a, acc_float(1.0 + i * 1e-5));
    }
    log2_at(a, HDRP_FLT_MIN);
    log2_at(a, HDRP_FLT_MAX);
    log2_at(a, 1.0f);
}

/* What hdrp_cull_log2 approximates in each octave, in double: see there. */
static double cubic_log2(double x)
{
    int e;
    double m = 2.0 * frexp(x, &e) - 1.0;
    double q = 0.43872573 + m * (-0.23905817 + m * 0.08213063);
    return e - 1 + (m + m * (1.0 - m) * q);
}

/* Where it reaches a value: by bisection. */
static double where_cubic_is(double wanted)
{
    double lo = exp2(wanted - 1.0), hi = exp2(wanted + 1.0);
    for (int i = 0; i < 60; ++i) {
        double middle = 0.5 * (lo + hi);
        if (cubic_log2(middle) < wanted) {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    return lo;
}

static void slice_begin_error(acc* a)
{
    for (int i = 0; i < 20000; ++i) {
        hdrp_cull_camera camera = hdrp_cull_camera_perspective(
            hdrp_v3_splat(0.0f), hdrp_v3_make(0, 0, -1), hdrp_v3_make(0, 1, 0), -1, 1, -1, 1,
            acc_float(acc_log_uniform(a, 1e-6, 1e6)), HDRP_CULL_FAR_INFINITE);
        hdrp_u32 slices = 2u + (hdrp_u32)acc_uniform(a, 0.0, 254.9);
        hdrp_cull_grid g = hdrp_cull_grid_make(camera, hdrp_u32x4_make(9, 9, slices, 9),
                                               hdrp_u32x4_make(9, 9, 0, 0), 0.0f, 0.0f);
        float scale = hdrp_cull_series_scale(g, acc_float(acc_log_uniform(a, 1e-5, 1e12)));
        hdrp_u32 k = 1u + (hdrp_u32)acc_uniform(a, 0.0, (double)slices - 1.1);
        double wanted = (double)g.series.y + (double)k / fmax((double)scale, 1e-3);
        double expected;
        if (wanted > 125.0) { /* beyond all depths */
            continue;
        }
        /* The place in the series is a float: what it is off by counts for the depth. */
        wanted = (double)(g.series.y + (float)k / (scale > 1e-3f ? scale : 1e-3f));
        expected = where_cubic_is(wanted);
        ACC_ADD(a, fabs((double)hdrp_cull_slice_begin(g, scale, k) - expected) / expected,
                "slice %u of scale %.9g from %.9g", k, (double)scale, (double)g.series.x);
    }
}

const acc_entry acc_cull_grid[] = {
    {"cull_log2", log2_error}, {"cull_slice_begin", slice_begin_error}, {NULL, NULL}};
