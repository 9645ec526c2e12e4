/* sweeps_built_in.c - functions of libm that hdrp_math.h wraps.
 * SPDX-License-Identifier: MIT */
#include "exhaustive.h"

#include "hdrp_math.h"

#define BUILT_IN(name)                                                                             \
    EX_VALUES(name, hdrp_##name)                                                                   \
    EX_ERROR(name, ex_ulp(EX_Y(0), name(x)))
BUILT_IN(sqrt)
BUILT_IN(sin)
BUILT_IN(cos)
BUILT_IN(tan)
BUILT_IN(asin)
BUILT_IN(acos)
BUILT_IN(exp)
BUILT_IN(exp2)
BUILT_IN(log)
BUILT_IN(log2)

const ex_sweep ex_sweeps_built_in[] = {
    EX_SWEEP(hdrp_sqrt, sqrt, EX_CLAIM(sqrt, 0.0f, FLT_MAX, 3u)),
    EX_SWEEP(hdrp_sin, sin, EX_CLAIM(sin, -8192.0f, 8192.0f, 13u)),
    EX_SWEEP(hdrp_cos, cos, EX_CLAIM(cos, -8192.0f, 8192.0f, 13u)),
    EX_SWEEP(hdrp_tan, tan, EX_CLAIM(tan, -8192.0f, 8192.0f, 13u)),
    EX_SWEEP(hdrp_asin, asin, EX_CLAIM(asin, -1.0f, 1.0f, 13u)),
    EX_SWEEP(hdrp_acos, acos, EX_CLAIM(acos, -1.0f, 1.0f, 13u)),
    EX_SWEEP(hdrp_exp, exp, EX_CLAIM(exp, -87.3f, 88.7f, 13u)),
    EX_SWEEP(hdrp_exp2, exp2, EX_CLAIM(exp2, -126.0f, 127.999992f, 13u)),
    EX_SWEEP(hdrp_log, log, EX_CLAIM(log, 1e-45f, FLT_MAX, 13u)),
    EX_SWEEP(hdrp_log2, log2, EX_CLAIM(log2, 1e-45f, FLT_MAX, 13u)),
    {NULL, NULL, 0, NULL, {EX_NO_CLAIM}},
};
