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

EX_ERROR(acos_absolute, ex_absolute(EX_Y(0), acos(x)))
EX_ERROR(exp2_relative, ex_relative(EX_Y(0), exp2(x)))
EX_ERROR(log2_relative, ex_relative(EX_Y(0), log2(x)))

/* Of exp and exp2 the domain is where results are normal floats. */
const ex_sweep ex_sweeps_built_in[] = {
    EX_SWEEP(hdrp_sqrt, sqrt, EX_CLAIM(sqrt, 0.0f, FLT_MAX)),
    EX_SWEEP(hdrp_sin, sin, EX_CLAIM(sin, -FLT_MAX, FLT_MAX)),
    EX_SWEEP(hdrp_cos, cos, EX_CLAIM(cos, -FLT_MAX, FLT_MAX)),
    EX_SWEEP(hdrp_tan, tan, EX_CLAIM(tan, -FLT_MAX, FLT_MAX)),
    EX_SWEEP(hdrp_asin, asin, EX_CLAIM(asin, -1.0f, 1.0f)),
    EX_SWEEP(hdrp_acos, acos, EX_CLAIM(acos, -1.0f, 1.0f), EX_CLAIM(acos_absolute, -1.0f, 1.0f)),
    EX_SWEEP(hdrp_exp, exp, EX_CLAIM(exp, -87.33654f, 88.72283f)),
    EX_SWEEP(hdrp_exp2, exp2, EX_CLAIM(exp2, -126.0f, 127.999992f),
             EX_CLAIM(exp2_relative, -126.0f, 127.999992f)),
    EX_SWEEP(hdrp_log, log, EX_CLAIM(log, 1e-45f, FLT_MAX)),
    EX_SWEEP(hdrp_log2, log2, EX_CLAIM(log2, 1e-45f, FLT_MAX),
             EX_CLAIM(log2_relative, 1e-45f, FLT_MAX)),
    {NULL, NULL, 0, NULL, {EX_NO_CLAIM}},
};
