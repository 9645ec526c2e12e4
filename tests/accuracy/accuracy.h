/* accuracy.h - the registry: one entry per claim that a docstring makes.
 * SPDX-License-Identifier: MIT
 *
 * A docstring line "error <= 2e-6 relative ... @accuracy brdf_d_ggx" is a claim. Each claim needs an
 * entry of the same id in an acc_<module>.c, which walks the documented domain (dense grid, random
 * points, the extremes), compares the float function with a double-precision reference of a
 * different derivation, and reports every error:
 *
 *     static void sqrt_error(acc* a)
 *     {
 *         for (int i = 0; i < 1000; ++i) {
 *             float x = acc_float(acc_uniform(a, 0.0, 4.0));
 *             ACC_ADD(a, acc_relative(hdrp_sqrt(x), sqrt(x)), "x = %.9g", x);
 *         }
 *     }
 *     const acc_entry acc_example[] = {{"sqrt", sqrt_error}, {NULL, NULL}};
 *
 * The program fails when a measured error exceeds its claim, when a result is not finite, when a
 * claim has no entry and when an entry has no claim. */
#ifndef ACCURACY_H
#define ACCURACY_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct acc {
    const char* unit; /* of the claim: relative, absolute, degrees or ulp */
    double max, sum;
    uint64_t count, non_finite;
    uint64_t random_state;
    char worst[160]; /* the input of the largest error, or of the first non-finite result */
} acc;

typedef struct acc_entry {
    const char* id;
    void (*run)(acc* a);
} acc_entry;

/* Counts one error. True when it is the largest so far or not finite: describe the input then. */
bool acc_add(acc* a, double error);
void acc_describe(acc* a, const char* format, ...);
#define ACC_ADD(a, error, ...)                                                                     \
    do {                                                                                           \
        if (acc_add((a), (error))) {                                                               \
            acc_describe((a), __VA_ARGS__);                                                        \
        }                                                                                          \
    } while (0)

/* |measured - reference| / |reference|; 0 when both are 0. */
double acc_relative(double measured, double reference);
/* Error in units in the last place of the reference rounded to float (denormals: of FLT_MIN). */
double acc_ulp(double measured, double reference);
/* Angle between two vectors of any length, in degrees; precise for small angles. NaN when
 * either has no direction. */
double acc_degrees(const double a[3], const double b[3]);

/* The larger; NaN when either is NaN, which fmax would drop. */
static inline double acc_larger(double a, double b)
{
    return a >= b || isnan(a) ? a : b;
}

/* A fixed sequence per entry: every run and every build sees the same inputs. */
uint64_t acc_random_bits(acc* a);
double acc_uniform(acc* a, double lo, double hi);
double acc_log_uniform(acc* a, double lo, double hi); /* 0 < lo < hi */
void acc_direction(acc* a, double out[3]);            /* uniform on the unit sphere */

/* x rounded to float, out of line: gcc 12 at -O2 vectorises two (double)(float)x in a row and drops
 * the rounding, so that a reference would see an input that the float function does not. */
float acc_float(double x);

#endif
