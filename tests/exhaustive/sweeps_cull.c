/* sweeps_cull.c - functions of one float of hdrp_cull_grid.h.
 * SPDX-License-Identifier: MIT */
#include "exhaustive.h"

#include "hdrp_cull_grid.h"

EX_VALUES(cull_log2, hdrp_cull_log2)
EX_ERROR(cull_log2, ex_absolute(EX_Y(0), log2(x)))

const ex_sweep ex_sweeps_cull[] = {
    EX_SWEEP(hdrp_cull_log2, cull_log2, EX_CLAIM(cull_log2, FLT_MIN, FLT_MAX)),
    {NULL, NULL, 0, NULL, {EX_NO_CLAIM}},
};
