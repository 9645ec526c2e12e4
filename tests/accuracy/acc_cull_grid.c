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

const acc_entry acc_cull_grid[] = {{"cull_log2", log2_error}, {NULL, NULL}};
