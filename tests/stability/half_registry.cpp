/* half_registry.cpp - the accuracy registry in half precision: half_registry [ID...]
 * SPDX-License-Identifier: MIT
 *
 * Compiled twice, with hdrp_half and with float. Prints a line that names the compiler,
 * then a CSV line per entry:
 *
 *     id,function,unit,max,mean,non_finite_share,count,absolute_max,largest,normal_max,marks
 *
 * An input that is infinite as a half is left out; all others are rounded to half first, and the
 * reference is that of the rounded input, so that the errors are those of the arithmetic.
 * absolute_max is the largest |measured - reference| and largest the largest |reference|, both of
 * entries with a relative error. normal_max is the largest error where all references are normal
 * numbers of half, 2^-14 to 65504. marks says what half could not hold: b a bit pattern, i an
 * integer. */
#include "half.hpp"

#include <time.h>

#ifdef HALF_PRECISION
#include "half_as_float.hpp"
#endif
#define acc_add      acc_add_every
#define acc_relative acc_relative_only
#define acc_ulp      acc_ulp_float
#define acc_degrees  acc_degrees_of_any
#define main         accuracy_main
#include "accuracy.c"
#undef acc_add
#undef acc_relative
#undef acc_ulp
#undef acc_degrees
#undef main

/* Of the entry that runs. The last sample's references are within half's normal numbers until one
 * is not. */
static double absolute_max, largest, normal_max;
static bool is_normal = true;
static uint64_t taken;

bool acc_add(acc* a, double error)
{
    bool outside = half_mark.outside;
    bool normal = is_normal;
    half_mark.outside = false;
    is_normal = true;
    if (outside) {
        return false;
    }
    taken += normal;
    if (normal && !(error <= normal_max)) {
        normal_max = error; /* NaN stays */
    }
    return acc_add_every(a, error);
}

/* Whether half holds the right results as normal numbers. */
static void note_reference(double reference)
{
    double size = fabs(reference);
    is_normal = is_normal && (size == 0.0 || (size >= 0x1p-14 && size <= 65504.0));
}

double acc_relative(double measured, double reference)
{
    if (!half_mark.outside && measured != reference) {
        absolute_max = fmax(absolute_max, fabs(measured - reference));
        largest = fmax(largest, fabs(reference));
    }
    note_reference(reference);
    return acc_relative_only(measured, reference);
}

/* In units in the last place of the number that is computed with. */
double acc_ulp(double measured, double reference)
{
    note_reference(reference);
#ifdef HALF_PRECISION
    int exponent;
    frexp(fmax(fabs(reference), 0x1p-14), &exponent);
    return fabs(measured - reference) / ldexp(1.0, exponent - 11);
#else
    return acc_ulp_float(measured, reference);
#endif
}

/* A vector of no length has no direction: that is no error of 0. */
double acc_degrees(const double a[3], const double b[3])
{
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2], angle = acc_degrees_of_any(a, b);
    return dot == 0.0 && angle == 0.0 ? HUGE_VAL : angle;
}

static void run(const acc_entry* entry, const acc_claim* claim)
{
    acc a;
    memset((void*)&a, 0, sizeof a);
    a.unit = claim->unit;
    a.random_state = 1;
    absolute_max = largest = normal_max = 0.0;
    taken = 0;
    is_normal = true;
    half_mark = half_marks();
    entry->run(&a);
    uint64_t finite = a.count - a.non_finite;
    printf("%s,%s,%s,%.9g,%.9g,%.9g,%llu,%.9g,%.9g,%.9g,%s%s\n", claim->id, claim->function,
           claim->unit, a.max, finite ? a.sum / (double)finite : 0.0,
           a.count ? (double)a.non_finite / (double)a.count : 0.0, (unsigned long long)a.count,
           absolute_max, largest, taken ? normal_max : HUGE_VAL, half_mark.bits ? "b" : "",
           half_mark.integers ? "i" : "");
    fprintf(stderr, "%6.2f s %s at %s\n", (double)clock() / CLOCKS_PER_SEC, claim->id, a.worst);
    fflush(stdout);
}

int main(int argc, char** argv)
{
    half_print_origin();
    printf(
        "id,function,unit,max,mean,non_finite_share,count,absolute_max,largest,normal_max,marks\n");
    for (size_t m = 0; m < MODULE_COUNT; ++m) {
        for (const acc_entry* e = modules[m]; e->id; ++e) {
            const acc_claim* claim = find_claim(e->id);
            if (claim && is_selected(e->id, argc - 1, argv + 1)) {
                run(e, claim);
            }
        }
    }
    return 0;
}
