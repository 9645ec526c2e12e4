/* accuracy.c - runs the registry: accuracy [--csv FILE] [ID...]
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

typedef struct acc_claim {
    const char* id;
    const char* function;
    const char* header;
    double bound;
    const char* unit;
} acc_claim;

static const acc_claim claims[] = {
#include "claims.inc"
};
#define CLAIM_COUNT      (sizeof claims / sizeof claims[0])

#define ACC_MODULE(name) extern const acc_entry acc_##name[];
#include "modules.inc"
#undef ACC_MODULE

static const acc_entry* const modules[] = {
#define ACC_MODULE(name) acc_##name,
#include "modules.inc"
#undef ACC_MODULE
};
#define MODULE_COUNT (sizeof modules / sizeof modules[0])

bool acc_add(acc* a, double error)
{
    a->count++;
    if (!isfinite(error)) {
        return a->non_finite++ == 0;
    }
    a->sum += error;
    if (error > a->max) {
        a->max = error;
        return a->non_finite == 0;
    }
    return false;
}

void acc_describe(acc* a, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(a->worst, sizeof a->worst, format, arguments);
    va_end(arguments);
}

double acc_relative(double measured, double reference)
{
    if (measured == reference) {
        return 0.0;
    }
    return fabs(measured - reference) / fabs(reference);
}

double acc_ulp(double measured, double reference)
{
    int exponent;
    double magnitude = fmax(fabs(reference), (double)FLT_MIN);
    frexp(magnitude, &exponent);
    return fabs(measured - reference) / ldexp(1.0, exponent - 24);
}

double acc_degrees(const double a[3], const double b[3])
{
    double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
    double s = sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
    double c = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    return s > 0.0 || c != 0.0 ? atan2(s, c) * (180.0 / 3.14159265358979323846) : (double)NAN;
}

/* SplitMix64 (Steele, Lea and Flood 2014). */
uint64_t acc_random_bits(acc* a)
{
    uint64_t z = (a->random_state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double acc_uniform(acc* a, double lo, double hi)
{
    return lo + (hi - lo) * ((double)(acc_random_bits(a) >> 11) * 0x1p-53);
}

double acc_log_uniform(acc* a, double lo, double hi)
{
    return exp(acc_uniform(a, log(lo), log(hi)));
}

void acc_direction(acc* a, double out[3])
{
    double z = acc_uniform(a, -1.0, 1.0);
    double phi = acc_uniform(a, 0.0, 2.0 * 3.14159265358979323846);
    double r = sqrt(1.0 - z * z);
    out[0] = r * cos(phi);
    out[1] = r * sin(phi);
    out[2] = z;
}

float acc_float(double x)
{
    return (float)x;
}

/* What the digits of a measurement depend on beside the source: the compiler, and the libm that the
 * references and the built-ins call, which glibc chooses by processor. */
static void print_origin(FILE* csv)
{
#if defined(__clang__)
    fprintf(csv, "# clang %d.%d.%d", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
    fprintf(csv, "# gcc %d.%d.%d", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
    fprintf(csv, "# unknown compiler");
#endif
#if defined(__GLIBC__)
    fprintf(csv, ", glibc %s", gnu_get_libc_version());
#else
    fprintf(csv, ", unknown libc");
#endif
#if defined(__x86_64__)
    fprintf(csv, " on x86-64 %s FMA\n", __builtin_cpu_supports("fma") ? "with" : "without");
#elif defined(__aarch64__)
    fprintf(csv, " on aarch64\n");
#else
    fprintf(csv, " on an unknown architecture\n");
#endif
}

static const acc_claim* find_claim(const char* id)
{
    for (size_t i = 0; i < CLAIM_COUNT; ++i) {
        if (strcmp(claims[i].id, id) == 0) {
            return &claims[i];
        }
    }
    return NULL;
}

static bool has_entry(const char* id)
{
    for (size_t m = 0; m < MODULE_COUNT; ++m) {
        for (const acc_entry* e = modules[m]; e->id; ++e) {
            if (strcmp(e->id, id) == 0) {
                return true;
            }
        }
    }
    return false;
}

static bool run_entry(const acc_entry* entry, const acc_claim* claim, FILE* csv)
{
    acc a = {.unit = claim->unit, .random_state = 1};
    entry->run(&a);
    double mean = a.count > a.non_finite ? a.sum / (double)(a.count - a.non_finite) : 0.0;
    bool good = a.count > 0 && a.non_finite == 0 && a.max <= claim->bound;
    printf("%-4s %-36s max %-9.3g <= %-9.3g mean %-9.3g %-8s n %-9llu at %s\n",
           good ? "ok" : "FAIL", claim->id, a.max, claim->bound, mean, claim->unit,
           (unsigned long long)a.count, a.worst);
    if (a.non_finite) {
        printf("     %llu results are not finite\n", (unsigned long long)a.non_finite);
    }
    if (csv) {
        fprintf(csv, "%s,%s,%s,%.9g,%.9g,%.9g,%llu,%llu\n", claim->id, claim->function, claim->unit,
                claim->bound, a.max, mean, (unsigned long long)a.count,
                (unsigned long long)a.non_finite);
    }
    fflush(stdout);
    return good;
}

static bool is_selected(const char* id, int count, char** names)
{
    for (int i = 0; i < count; ++i) {
        if (strcmp(names[i], id) == 0) {
            return true;
        }
    }
    return count == 0;
}

int main(int argc, char** argv)
{
    FILE* csv = NULL;
    int first = 1, failures = 0;
    if (argc > 2 && strcmp(argv[1], "--csv") == 0) {
        csv = fopen(argv[2], "w");
        if (!csv) {
            fprintf(stderr, "accuracy: cannot write %s\n", argv[2]);
            return 1;
        }
        print_origin(csv);
        fprintf(csv, "id,function,unit,claim,max,mean,count,non_finite\n");
        first = 3;
    }
    for (size_t m = 0; m < MODULE_COUNT; ++m) {
        for (const acc_entry* e = modules[m]; e->id; ++e) {
            const acc_claim* claim = find_claim(e->id);
            if (!claim) {
                printf("FAIL %s: no docstring claims this entry\n", e->id);
                ++failures;
            } else if (is_selected(e->id, argc - first, argv + first)) {
                failures += !run_entry(e, claim, csv);
            }
        }
    }
    for (size_t i = 0; i < CLAIM_COUNT; ++i) {
        if (!has_entry(claims[i].id)) {
            printf("FAIL %s: the claim of %s has no entry\n", claims[i].id, claims[i].function);
            ++failures;
        }
    }
    if (csv && fclose(csv) != 0) {
        fprintf(stderr, "accuracy: cannot write the CSV file\n");
        ++failures;
    }
    printf("%d failed\n", failures);
    return failures != 0;
}
