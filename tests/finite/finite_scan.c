/* finite_scan.c - runs the scan: finite_scan [--limit N] [FUNCTION...]
 * SPDX-License-Identifier: MIT */
#include "finite_scan.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define MAX_ARGUMENTS   16
#define MAX_BYTES       4096 /* of a result */
#define SHOWN           3    /* failures printed per function */
#define STRUCT_COUNT    1024 /* samples of a struct */
#define LOCKSTEP        40   /* of them, those in which every member takes its own k-th sample */

#define FS_HEADER(name) extern const fs_function* const fs_##name[];
#include "modules.inc"
#undef FS_HEADER

static const fs_function* const* const headers[] = {
#define FS_HEADER(name) fs_##name,
#include "modules.inc"
#undef FS_HEADER
};

/* Bits that look random and depend on nothing but the arguments (the finaliser of SplitMix64,
 * Steele, Lea and Flood 2014). */
static uint64_t hash(uint64_t a, uint64_t b)
{
    uint64_t z = a * 0x9e3779b97f4a7c15u + (b + 1) * 0xd1342543de82ef95u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static const unsigned char* sample(const fs_source* source, size_t index)
{
    const unsigned char* first =
        source->table ? (const unsigned char*)source->table : source->built;
    return first + index * source->size;
}

/* Walks combinations of argument samples: all of them where that is at most limit; otherwise every
 * combination of the first few samples of each, then limit / 2 drawn ones. */
typedef struct walk {
    const fs_function* function;
    uint64_t position, corner_total, total;
    size_t corners[MAX_ARGUMENTS];
    const void* arguments[MAX_ARGUMENTS];
} walk;

static walk walk_begin(const fs_function* f, uint64_t limit)
{
    walk w = {.function = f, .corner_total = 1};
    double product = 1.0;
    for (size_t i = 0; i < f->argument_count; ++i) {
        product *= (double)f->arguments[i].source->count;
    }
    if (product <= (double)limit) {
        for (size_t i = 0; i < f->argument_count; ++i) {
            w.corners[i] = f->arguments[i].source->count;
            w.corner_total *= w.corners[i];
        }
        w.total = w.corner_total;
        return w;
    }
    for (size_t i = 0; i < f->argument_count; ++i) {
        w.corners[i] = 1;
    }
    /* One more for the argument that has the smallest share so far, while the product allows it. */
    for (;;) {
        size_t best = f->argument_count;
        double best_share = 2.0;
        for (size_t i = 0; i < f->argument_count; ++i) {
            double share = (double)w.corners[i] / (double)f->arguments[i].source->count;
            bool fits = w.corner_total / w.corners[i] * (w.corners[i] + 1) <= limit / 2;
            if (w.corners[i] < f->arguments[i].source->count && fits && share < best_share) {
                best = i;
                best_share = share;
            }
        }
        if (best == f->argument_count) {
            break;
        }
        w.corner_total = w.corner_total / w.corners[best] * (w.corners[best] + 1);
        w.corners[best]++;
    }
    w.total = w.corner_total + limit / 2;
    return w;
}

static bool walk_next(walk* w)
{
    const fs_function* f = w->function;
    uint64_t rest = w->position;
    if (w->position == w->total) {
        return false;
    }
    for (size_t i = 0; i < f->argument_count; ++i) {
        const fs_source* source = f->arguments[i].source;
        size_t index = w->position < w->corner_total ? rest % w->corners[i]
                                                     : hash(w->position, i) % source->count;
        rest /= w->corners[i];
        w->arguments[i] = sample(source, index);
    }
    w->position++;
    return true;
}

static bool build_arguments(const fs_function* f);

static void build_from_parts(fs_source* s)
{
    s->count = STRUCT_COUNT;
    for (size_t k = 0; k < STRUCT_COUNT; ++k) {
        for (size_t i = 0; i < s->part_count; ++i) {
            const fs_source* part = s->parts[i].source;
            size_t index = (k < LOCKSTEP ? k : hash(k, i)) % part->count;
            memcpy(s->built + k * s->size + s->parts[i].offset, sample(part, index), part->size);
        }
    }
}

/* Calls the producers in turn with drawn arguments: the first ones in lockstep, as above. */
static void build_from_producers(fs_source* s)
{
    const void* arguments[MAX_ARGUMENTS];
    for (uint64_t k = 0; k < 64 * STRUCT_COUNT && s->count < STRUCT_COUNT; ++k) {
        const fs_function* f = s->producers[k % s->producer_count];
        uint64_t round = k / s->producer_count;
        for (size_t i = 0; i < f->argument_count; ++i) {
            const fs_source* source = f->arguments[i].source;
            size_t index = (round < LOCKSTEP ? round : hash(round, i)) % source->count;
            arguments[i] = sample(source, index);
        }
        if (!f->is_required || f->is_required(arguments)) {
            f->call(arguments, s->built + s->count * s->size);
            s->count++;
        }
    }
}

/* Makes the samples of a struct. False when there are none. */
static bool build(fs_source* s)
{
    bool good = !s->is_building;
    if (s->table || s->built || !good) {
        return good;
    }
    s->is_building = true;
    for (size_t i = 0; i < s->part_count; ++i) {
        good = good && build(s->parts[i].source);
    }
    for (size_t i = 0; i < s->producer_count; ++i) {
        good = good && build_arguments(s->producers[i]);
    }
    s->is_building = false;
    s->built = calloc(STRUCT_COUNT, s->size);
    if (!good || !s->built) {
        return false;
    }
    if (s->producer_count) {
        build_from_producers(s);
    } else {
        build_from_parts(s);
    }
    return s->count > 0;
}

static bool build_arguments(const fs_function* f)
{
    for (size_t i = 0; i < f->argument_count; ++i) {
        if (!build(f->arguments[i].source)) {
            return false;
        }
    }
    return true;
}

static float f32_at(const unsigned char* bytes, size_t offset)
{
    float x;
    memcpy(&x, bytes + offset, sizeof x);
    return x;
}

static bool holds(const fs_check* c, const unsigned char* result)
{
    double x = 0.0, length = 0.0;
    uint32_t bits;
    switch (c->rule) {
    case FS_FINITE:
        return isfinite(f32_at(result, c->offset));
    case FS_UNIT:
        for (size_t i = 0; i < c->count; ++i) {
            x = (double)f32_at(result, c->offset + i * sizeof(float));
            length += x * x;
        }
        return fabs(sqrt(length) - 1.0) <= 1e-6;
    case FS_INTEGER:
        memcpy(&bits, result + c->offset, sizeof bits);
        x = (double)bits;
        break;
    case FS_INTERVAL:
        x = (double)f32_at(result, c->offset);
        break;
    }
    return (c->lo_open ? x > c->lo : x >= c->lo) && (c->hi_open ? x < c->hi : x <= c->hi);
}

static void print_value(const fs_type* type, const unsigned char* bytes)
{
    for (size_t i = 0; i < type->leaf_count; ++i) {
        const fs_leaf* leaf = &type->leaves[i];
        uint32_t u;
        memcpy(&u, bytes + leaf->offset, sizeof u);
        printf("%s%s%s", i ? ", " : "", leaf->name, leaf->name[0] ? " " : "");
        if (leaf->kind == FS_F32) {
            double x = (double)f32_at(bytes, leaf->offset);
            printf("%a (%.9g)", x, x);
        } else {
            printf("%lu", (unsigned long)u);
        }
    }
}

static void print_arguments(const fs_function* f, const void* const* arguments)
{
    for (size_t i = 0; i < f->argument_count; ++i) {
        printf("     %-10s ", f->arguments[i].name);
        print_value(f->arguments[i].type, arguments[i]);
        printf("\n");
    }
}

/* The undefined behaviour sanitizer calls this before it reports and ends the program. */
static const fs_function* current_function;
static const void* const* current_arguments;
void __ubsan_on_report(void);
void __ubsan_on_report(void)
{
    if (current_function) {
        printf("FAIL %s (%s) does what is undefined\n", current_function->name,
               current_function->header);
        print_arguments(current_function, current_arguments);
        fflush(stdout);
    }
}

static void print_failure(const fs_function* f, const fs_check* c, const void* const* arguments,
                          const unsigned char* result)
{
    printf("FAIL %s (%s)\n", f->name, f->header);
    print_arguments(f, arguments);
    printf("     returned   ");
    print_value(f->result, result);
    printf("\n     in which   ");
    for (size_t i = 0; i < f->result->leaf_count; ++i) {
        if (f->result->leaves[i].offset == c->offset) {
            printf("%s ", f->result->leaves[i].name);
        }
    }
    switch (c->rule) {
    case FS_FINITE:
        printf("is not finite\n");
        break;
    case FS_UNIT:
        printf("begins what is not a unit vector\n");
        break;
    case FS_INTEGER:
    case FS_INTERVAL:
        printf("is not in %c%.9g,%.9g%c\n", c->lo_open ? '(' : '[', c->lo, c->hi,
               c->hi_open ? ')' : ']');
        break;
    }
}

static bool scan(const fs_function* f, uint64_t limit)
{
    /* As uint64_t, so that every struct of floats and integers is aligned. */
    uint64_t storage[MAX_BYTES / sizeof(uint64_t)];
    const unsigned char* result = (const unsigned char*)storage;
    unsigned long long calls = 0, bad = 0;
    clock_t start = clock();
    if (f->missing) {
        printf("FAIL %s (%s) is not scanned: %s\n", f->name, f->header, f->missing);
        return false;
    }
    if (f->argument_count > MAX_ARGUMENTS || f->result->size > MAX_BYTES || !build_arguments(f)) {
        printf("FAIL %s (%s) is not scanned: no samples\n", f->name, f->header);
        return false;
    }
    walk w = walk_begin(f, limit);
    current_function = f;
    current_arguments = w.arguments;
    while (walk_next(&w)) {
        if (f->is_required && !f->is_required(w.arguments)) {
            continue;
        }
        calls++;
        f->call(w.arguments, storage);
        for (size_t i = 0; i < f->check_count; ++i) {
            if (!holds(&f->checks[i], result)) {
                if (bad++ < SHOWN) {
                    print_failure(f, &f->checks[i], w.arguments, result);
                }
                break;
            }
        }
    }
    current_function = NULL;
    if (calls == 0) {
        printf("FAIL %s (%s): no sample meets its 'requires'\n", f->name, f->header);
        return false;
    }
    printf("%-4s %-48s %9llu calls %8.3f s\n", bad ? "FAIL" : "ok", f->name, calls,
           (double)(clock() - start) / CLOCKS_PER_SEC);
    if (bad) {
        printf("     %llu bad results\n", bad);
    }
    return bad == 0;
}

static bool is_selected(const char* name, int count, char** names)
{
    for (int i = 0; i < count; ++i) {
        if (strcmp(names[i], name) == 0) {
            return true;
        }
    }
    return count == 0;
}

int main(int argc, char** argv)
{
    uint64_t limit = 300000;
    int first = 1, failures = 0, scanned = 0;
    if (argc > 2 && strcmp(argv[1], "--limit") == 0) {
        limit = strtoull(argv[2], NULL, 10);
        first = 3;
    }
    for (size_t h = 0; h < sizeof headers / sizeof headers[0]; ++h) {
        for (const fs_function* const* f = headers[h]; *f; ++f) {
            if (is_selected((*f)->name, argc - first, argv + first)) {
                failures += !scan(*f, limit);
                scanned++;
            }
        }
    }
    printf("%d functions, %d failed\n", scanned, failures);
    return failures != 0 || scanned == 0;
}
