/* half_formulas.h - formulas whose useful range in half precision is searched for.
 * SPDX-License-Identifier: MIT */
#ifndef HALF_FORMULAS_H
#define HALF_FORMULAS_H

enum half_formula {
    HALF_D,
    HALF_D_VECTORS,
    HALF_D_ANISO,
    HALF_D_ANISO_VECTORS,
    HALF_V,
    HALF_V_ANISO,
    HALF_PDF_VNDF,
    HALF_FRESNEL,
    HALF_MULTISCATTER,
    HALF_OCT_DECODE,
    HALF_OCT_ROUND_TRIP,
    HALF_FALLOFF,
    HALF_WINDOW_OF_RANGE,
    HALF_LUX,
    HALF_NITS,
    HALF_EXPOSURE,
    HALF_POINT_LIGHT,
    HALF_LIT
};

/* Calls a formula with inputs that are halves; up to three results. One object file has it in
 * half precision, another one in float. */
void half_eval_half(enum half_formula formula, const double* in, double out[3]);
void half_eval_float(enum half_formula formula, const double* in, double out[3]);

#endif
