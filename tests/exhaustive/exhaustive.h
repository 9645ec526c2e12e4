/* exhaustive.h - sweeps over every float and every code.
 * SPDX-License-Identifier: MIT
 *
 * A sweep calls a function of one float with all 2^32 of them, compares it with a double-precision
 * reference where a docstring makes a claim, and counts the results that are outside the range that
 * the docstring gives. A walk goes through the codes of a codec. A search looks for the direction
 * that a codec of directions stores worst.
 *
 * Bounds come from the docstrings: a claim is named by its id. What has no claim of its own, such as
 * that a code survives decoding and encoding, states its bound here. */
#ifndef EXHAUSTIVE_H
#define EXHAUSTIVE_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Floats that are worked on at once. Component k of the result for float i is y[k * EX_BLOCK + i]:
 * by component, so that loops over the floats vectorise. */
#define EX_BLOCK      1024
#define EX_COMPONENTS 4
/* Component k of a result, inside an error function. */
#define EX_Y(k) ((double)y[(k)*EX_BLOCK])

#define EX_PI   3.14159265358979323846

typedef struct ex_claim {
    const char* id; /* of the docstring's claim, or NULL */
    double bound;   /* where there is no id; in unit */
    const char* unit;
    float lo, hi; /* closed domain of the comparison: every float of it */
    void (*errors)(const float* x, const float* y, double* e, int n);
} ex_claim;

typedef struct ex_sweep {
    const char* function;
    const char* detail; /* fixed arguments, or "" */
    int components;
    void (*values)(const float* x, float* y, int n);
    ex_claim claims[3]; /* up to the first without errors */
} ex_sweep;

typedef struct ex_walk {
    const char* function;
    const char* detail;
    const char* id; /* or NULL, and then: */
    double bound;
    const char* unit;
    uint32_t count;       /* indices 0 to count - 1 */
    uint32_t subset_step; /* which of them the subset looks at */
    /* Error at an index: negative where there is no such code, infinite where a code is lost. */
    double (*error)(uint32_t index);
} ex_walk;

/* A point of the space that a search looks at: a unit vector and an angle in radians. */
typedef struct ex_point {
    double direction[3];
    double angle;
} ex_point;

typedef struct ex_search {
    const char* function;
    const char* detail;
    const char* id;
    double (*error)(const ex_point* p); /* negative where the claim does not hold */
} ex_search;

/* Tables end with a function of NULL. */
extern const ex_sweep ex_sweeps_built_in[], ex_sweeps_math[], ex_sweeps_brdf[], ex_sweeps_light[],
    ex_sweeps_cull[], ex_sweeps_pack[];
extern const ex_walk ex_walks_pack[];
extern const ex_search ex_searches_pack[];

static inline double ex_absolute(double measured, double reference)
{
    return fabs(measured - reference);
}

static inline double ex_relative(double measured, double reference)
{
    return measured == reference ? 0.0 : fabs(measured - reference) / fabs(reference);
}

/* The larger one; NaN if one of them is. fmax calls the C library, and hides NaN. */
static inline double ex_larger(double a, double b)
{
    return ((a >= b) | (a != a)) ? a : b;
}

static inline double ex_clamp(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* The largest power of two that is at most the normal |x|. */
static inline double ex_binade(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits &= 0x7ff0000000000000u;
    memcpy(&x, &bits, sizeof bits);
    return x;
}

/* In units in the last place of the reference rounded to float; of denormals those of FLT_MIN. */
static inline double ex_ulp(double measured, double reference)
{
    return fabs(measured - reference) /
           (ex_binade(ex_larger(fabs(reference), (double)FLT_MIN)) * 0x1p-23);
}

/* A function of one float, as values of an ex_sweep. */
#define EX_VALUES(name, call)                                                                      \
    static void name##_values(const float* restrict x, float* restrict y, int n)                   \
    {                                                                                              \
        for (int i = 0; i < n; ++i) {                                                              \
            y[i] = (float)call(x[i]);                                                              \
        }                                                                                          \
    }
/* The loop over name##_error, which gcc inlines, for claims. */
#define EX_ERRORS(name)                                                                            \
    static void name##_errors(const float* restrict x, const float* restrict y,                    \
                              double* restrict e, int n)                                           \
    {                                                                                              \
        for (int i = 0; i < n; ++i) {                                                              \
            e[i] = name##_error((double)x[i], y + i);                                              \
        }                                                                                          \
    }
#define EX_ERROR(name, expression)                                                                 \
    static double name##_error(double x, const float* y)                                           \
    {                                                                                              \
        return expression;                                                                         \
    }                                                                                              \
    EX_ERRORS(name)
/* A claim of a docstring over [lo, hi], whose error function is called like it. */
#define EX_CLAIM(name, lo, hi)                                                                     \
    {                                                                                              \
#name, 0.0, "", lo, hi, name##_errors                                                      \
    }
#define EX_STATED(name, bound, unit, lo, hi)                                                       \
    {                                                                                              \
        NULL, bound, unit, lo, hi, name##_errors                                                   \
    }
#define EX_NO_CLAIM                                                                                \
    {                                                                                              \
        NULL, 0.0, "", 0.0f, 0.0f, NULL                                                            \
    }
#define EX_SWEEP(function, name, ...)                                                              \
    {                                                                                              \
#function, "", 1, name##_values,                                                           \
        {                                                                                          \
            __VA_ARGS__                                                                            \
        }                                                                                          \
    }

#endif
