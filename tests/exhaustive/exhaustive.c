/* exhaustive.c - runs the sweeps: exhaustive [--subset] [--csv FILE] [NAME...]
 * SPDX-License-Identifier: MIT
 *
 * Inputs are cut into chunks of fixed size whose results are added up in order, so that the digits
 * do not depend on the number of threads. */
#include "exhaustive.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* What the docstrings say: claims, and the ranges of first arguments and of results. */
typedef struct doc_claim {
    const char* id;
    const char* function;
    const char* header;
    double bound;
    const char* unit;
} doc_claim;

static const doc_claim claims[] = {
#include "claims.inc"
};

typedef struct ranges {
    const char* function;
    float lo, hi;               /* closed range of the first argument */
    int takes_nan;              /* NaN belongs to it */
    float result_lo, result_hi; /* closed range of a result; not finite where one may not be */
} ranges;

static const ranges formulas[] = {
#include "ranges.inc"
};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

typedef struct result {
    double worst; /* -1 before the first */
    double sum;
    uint64_t count;
    uint64_t non_finite; /* not finite or outside the documented range, for a documented input */
    uint64_t outside;    /* not finite, for an input outside the documented range */
    uint32_t input;      /* bit pattern or index of the worst */
    ex_point point;      /* the worst of a search */
} result;

static const result no_result = {-1.0, 0.0, 0, 0, 0, 0, {{0.0, 0.0, 0.0}, 0.0}};

static bool subset;

static void add(result* r, double error, uint32_t input)
{
    r->count++;
    if (!isfinite(error)) {
        r->input = r->non_finite == 0 ? input : r->input;
        r->worst = HUGE_VAL;
        r->non_finite++;
        return;
    }
    r->sum += error;
    if (error > r->worst) {
        r->worst = error;
        r->input = input;
    }
}

static void merge(result* into, const result* part)
{
    into->count += part->count;
    into->sum += part->sum;
    into->non_finite += part->non_finite;
    into->outside += part->outside;
    if (part->worst > into->worst) {
        into->worst = part->worst;
        into->input = part->input;
        into->point = part->point;
    }
}

/* ---- sweeps ---------------------------------------------------------------------------------- */

#define CHUNK_BITS    20
#define SUBSET_STRIDE 4099u /* odd, so that mantissas vary */
#define AROUND_EDGE   1024u

static float float_of(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static const ranges* ranges_of(const char* function)
{
    for (size_t i = 0; i < COUNT(formulas); ++i) {
        if (strcmp(formulas[i].function, function) == 0) {
            return &formulas[i];
        }
    }
    fprintf(stderr, "exhaustive: no docstring gives the ranges of %s\n", function);
    exit(1);
}

/* Adds the errors of those of n floats that are in the claim's domain, of every run of them at once:
 * references may be slow, or not defined elsewhere. */
static void compare(const ex_claim* claim, const float* x, const float* y, int n, result* r)
{
    double e[EX_BLOCK];
    for (int first = 0, end; first < n; first = end) {
        bool in = x[first] >= claim->lo && x[first] <= claim->hi;
        for (end = first + 1; end < n && (x[end] >= claim->lo && x[end] <= claim->hi) == in;
             ++end) {
        }
        if (in) {
            claim->errors(x + first, y + first, e, end - first);
            for (int i = first; i < end; ++i) {
                add(r, e[i - first], bits_of(x[i]));
            }
        }
    }
}

/* Adds the results for n floats to results[0..2], one per claim. */
static void sweep_block(const ex_sweep* s, const ranges* r, const float* x, int n,
                        result results[3])
{
    static const float largest = FLT_MAX;
    float y[EX_BLOCK * EX_COMPONENTS];
    unsigned wrong = 0, outside = 0;
    const float lo = r->lo, hi = r->hi, result_lo = r->result_lo, result_hi = r->result_hi;
    const unsigned nan = r->takes_nan ? 1u : 0u;
    s->values(x, y, n);
    for (int k = 0; k < s->components; ++k) {
        const float* v = y + k * EX_BLOCK;
        for (int i = 0; i < n; ++i) {
            unsigned in = ((x[i] >= lo) & (x[i] <= hi)) | (nan & (x[i] != x[i]));
            unsigned good = (v[i] >= result_lo) & (v[i] <= result_hi);
            unsigned finite = (v[i] >= -largest) & (v[i] <= largest);
            wrong += in & (good ^ 1u);
            outside += (in ^ 1u) & (finite ^ 1u);
        }
    }
    results[0].count += s->claims[0].errors ? 0u : (uint64_t)n;
    /* A result that may be anything is only compared. */
    results[0].non_finite += isinf(result_hi) ? 0 : wrong;
    results[0].outside += outside;
    for (int c = 0; c < 3 && s->claims[c].errors; ++c) {
        compare(&s->claims[c], x, y, n, &results[c]);
    }
}

/* A chunk of the subset: every 4099th pattern, and those next to the ends of binades. */
static void sweep_subset_chunk(const ex_sweep* s, const ranges* r, uint32_t chunk, result out[3])
{
    float x[EX_BLOCK];
    int n = 0;
    uint32_t base = chunk << CHUNK_BITS;
    uint32_t first = (SUBSET_STRIDE - base % SUBSET_STRIDE) % SUBSET_STRIDE;
    for (uint32_t i = first; i < 1u << CHUNK_BITS; i += SUBSET_STRIDE) {
        x[n++] = float_of(base + i);
    }
    sweep_block(s, r, x, n, out);
    if (base << 9u == 0u || (base + (1u << CHUNK_BITS)) << 9u == 0u) {
        uint32_t start = base << 9u == 0u ? base : base + (1u << CHUNK_BITS) - AROUND_EDGE;
        for (uint32_t i = 0; i < AROUND_EDGE; ++i) {
            x[i] = float_of(start + i);
        }
        sweep_block(s, r, x, (int)AROUND_EDGE, out);
    }
}

/* The patterns around the ends of the domains of a sweep. */
static void sweep_edges(const ex_sweep* s, const ranges* r, result out[3])
{
    float x[EX_BLOCK];
    for (int c = 0; c < 3 && s->claims[c].errors; ++c) {
        for (int end = 0; end < 4; ++end) {
            uint32_t edge = bits_of(end & 1 ? s->claims[c].hi : s->claims[c].lo);
            uint32_t start = end & 2 ? edge : edge - AROUND_EDGE;
            for (uint32_t i = 0; i < AROUND_EDGE; ++i) {
                x[i] = float_of(start + i);
            }
            sweep_block(s, r, x, (int)AROUND_EDGE, out);
        }
    }
}

static void sweep_chunk(const ex_sweep* s, const ranges* r, uint32_t chunk, result out[3])
{
    float x[EX_BLOCK];
    if (subset) {
        sweep_subset_chunk(s, r, chunk, out);
        return;
    }
    for (uint32_t block = 0; block < (1u << CHUNK_BITS) / EX_BLOCK; ++block) {
        uint32_t base = (chunk << CHUNK_BITS) + block * EX_BLOCK;
        for (uint32_t i = 0; i < EX_BLOCK; ++i) {
            x[i] = float_of(base + i);
        }
        sweep_block(s, r, x, EX_BLOCK, out);
    }
}

static void run_sweep(const ex_sweep* s, result totals[3])
{
    enum { CHUNKS = 1 << (32 - CHUNK_BITS) };
    static result parts[CHUNKS][3];
    const ranges* r = ranges_of(s->function);
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 8)
#endif
    for (int chunk = 0; chunk < CHUNKS; ++chunk) {
        parts[chunk][0] = parts[chunk][1] = parts[chunk][2] = no_result;
        sweep_chunk(s, r, (uint32_t)chunk, parts[chunk]);
    }
    totals[0] = totals[1] = totals[2] = no_result;
    for (int chunk = 0; chunk < CHUNKS; ++chunk) {
        for (int c = 0; c < 3; ++c) {
            merge(&totals[c], &parts[chunk][c]);
        }
    }
    if (subset) {
        sweep_edges(s, r, totals);
    }
}

/* ---- walks ----------------------------------------------------------------------------------- */

static void run_walk(const ex_walk* w, result* total)
{
    enum { CHUNK = 1 << 14, MOST_CHUNKS = 1 << 18 };
    static result parts[MOST_CHUNKS];
    uint32_t step = subset ? w->subset_step : 1u;
    uint32_t indices = (w->count - 1u) / step + 1u;
    int chunks = (int)((indices - 1u) / CHUNK + 1u);
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
    for (int chunk = 0; chunk < chunks; ++chunk) {
        uint32_t first = (uint32_t)chunk * CHUNK;
        uint32_t last = first + CHUNK < indices ? first + CHUNK : indices;
        parts[chunk] = no_result;
        for (uint32_t i = first; i < last; ++i) {
            double error = w->error(i * step);
            if (!(error < 0.0)) {
                add(&parts[chunk], error, i * step);
            }
        }
    }
    *total = no_result;
    for (int chunk = 0; chunk < chunks; ++chunk) {
        merge(total, &parts[chunk]);
    }
}

/* ---- searches -------------------------------------------------------------------------------- */

enum { SEARCH_CHUNK = 10000, SEARCH_CHUNKS = 1000, SEARCH_RANDOM = 7000 };

/* SplitMix64 (Steele, Lea and Flood 2014). */
static double uniform(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static void normalize(double d[3])
{
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; ++k) {
        d[k] /= length;
    }
}

/* Uniform on the sphere; every fourth one next to a plane of two axes. */
static ex_point random_point(uint64_t* state, int i)
{
    ex_point p;
    double z = 2.0 * uniform(state) - 1.0, phi = 2.0 * EX_PI * uniform(state);
    p.direction[0] = sqrt(1.0 - z * z) * cos(phi);
    p.direction[1] = sqrt(1.0 - z * z) * sin(phi);
    p.direction[2] = z;
    if (i % 4 == 0) {
        p.direction[i / 4 % 3] *= pow(10.0, -9.0 * uniform(state));
        normalize(p.direction);
    }
    p.angle = 2.0 * EX_PI * uniform(state);
    return p;
}

/* Close to the worst so far, closer and closer. */
static ex_point nearby(uint64_t* state, const ex_point* p, double progress)
{
    ex_point q = *p;
    double radius = 0.03 * pow(1e-5, progress);
    for (int k = 0; k < 3; ++k) {
        q.direction[k] += radius * (2.0 * uniform(state) - 1.0);
    }
    normalize(q.direction);
    q.angle += radius * (2.0 * uniform(state) - 1.0);
    return q;
}

static void search_chunk(const ex_search* s, int chunk, result* r)
{
    uint64_t state = (uint64_t)chunk * 0x9e3779b97f4a7c15u + 1u;
    for (int i = 0; i < SEARCH_CHUNK; ++i) {
        ex_point p = i < SEARCH_RANDOM || r->worst < 0.0
                         ? random_point(&state, i)
                         : nearby(&state, &r->point,
                                  (double)(i - SEARCH_RANDOM) / (SEARCH_CHUNK - SEARCH_RANDOM));
        double error = s->error(&p), worst = r->worst;
        if (!(error < 0.0)) {
            add(r, error, (uint32_t)i);
            r->point = r->worst > worst ? p : r->point;
        }
    }
}

static void run_search(const ex_search* s, result* total)
{
    static result parts[SEARCH_CHUNKS];
    int chunks = subset ? SEARCH_CHUNKS / 100 : SEARCH_CHUNKS;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic)
#endif
    for (int chunk = 0; chunk < chunks; ++chunk) {
        parts[chunk] = no_result;
        search_chunk(s, chunk, &parts[chunk]);
    }
    *total = no_result;
    for (int chunk = 0; chunk < chunks; ++chunk) {
        merge(total, &parts[chunk]);
    }
}

/* ---- report ---------------------------------------------------------------------------------- */

typedef struct row {
    const char* function;
    const char* id; /* or NULL */
    const char* unit;
    double bound; /* negative: there is none */
    char domain[96];
    char input[96];
} row;

static FILE* csv;
static int failures, rows;

static void report(row* w, const result* r)
{
    double mean = r->count > r->non_finite ? r->sum / (double)(r->count - r->non_finite) : 0.0;
    bool compared = r->worst >= 0.0;
    bool good = r->non_finite == 0 && (compared ? r->worst <= w->bound : w->bound < 0.0);
    char worst[32] = "", average[32] = "", bound[32] = "";
    if (compared) {
        snprintf(worst, sizeof worst, "%.3g", r->worst);
        snprintf(average, sizeof average, "%.3g", mean);
    }
    if (w->bound >= 0.0) {
        snprintf(bound, sizeof bound, "%.9g", w->bound);
    }
    ++rows;
    failures += !good;
    printf("%-4s %-40s %-30s n %-10llu worst %-9s <= %-10s mean %-9s %-8s at %s\n",
           good ? "ok" : "FAIL", w->function, w->id ? w->id : w->domain,
           (unsigned long long)r->count, worst, bound, average, w->unit, compared ? w->input : "");
    if (r->non_finite) {
        printf("     %llu results are lost, not finite or outside the documented range\n",
               (unsigned long long)r->non_finite);
    }
    if (r->outside) {
        printf("     %llu results for inputs outside the documented range are not finite\n",
               (unsigned long long)r->outside);
    }
    fflush(stdout);
    if (csv) {
        fprintf(csv, "%s,%s,%llu,%s,%s,%s,%s,%llu,%llu,%s,%s\n", w->function, w->domain,
                (unsigned long long)r->count, worst, compared ? w->input : "", average, w->unit,
                (unsigned long long)r->non_finite, (unsigned long long)r->outside,
                w->id ? w->id : "", bound);
        fflush(csv); /* what is done stays, if the rest is cut short */
    }
}

/* Bound and unit of a claim, which must be that of a docstring. */
static void look_up(row* w)
{
    for (size_t i = 0; w->id && i < COUNT(claims); ++i) {
        if (strcmp(claims[i].id, w->id) == 0) {
            w->bound = claims[i].bound;
            w->unit = claims[i].unit;
            return;
        }
    }
    if (w->id) {
        fprintf(stderr, "exhaustive: no docstring makes the claim %s\n", w->id);
        exit(1);
    }
}

static row make_row(const char* function, const char* id, double bound, const char* unit)
{
    row w;
    memset(&w, 0, sizeof w);
    w.function = function;
    w.id = id;
    w.bound = bound;
    w.unit = unit;
    look_up(&w);
    return w;
}

static void report_sweep(const ex_sweep* s)
{
    result totals[3];
    run_sweep(s, totals);
    for (int c = 0; c == 0 || (c < 3 && s->claims[c].errors); ++c) {
        const ex_claim* k = &s->claims[c];
        row w =
            make_row(s->function, k->errors ? k->id : NULL, k->errors ? k->bound : -1.0, k->unit);
        if (k->errors) {
            /* A comma would end the field. */
            snprintf(w.domain, sizeof w.domain, "%.9g to %.9g%s%s", (double)k->lo, (double)k->hi,
                     *s->detail ? " " : "", s->detail);
        } else {
            snprintf(w.domain, sizeof w.domain, "every float%s%s", *s->detail ? " " : "",
                     s->detail);
        }
        snprintf(w.input, sizeof w.input, "%.9g", (double)float_of(totals[c].input));
        report(&w, &totals[c]);
    }
}

static void report_walk(const ex_walk* k)
{
    result total;
    row w = make_row(k->function, k->id, k->bound, k->unit);
    run_walk(k, &total);
    snprintf(w.domain, sizeof w.domain, "%s", k->detail);
    snprintf(w.input, sizeof w.input, "%u", total.input);
    report(&w, &total);
}

static void report_search(const ex_search* s)
{
    result total;
    row w = make_row(s->function, s->id, 0.0, "");
    run_search(s, &total);
    snprintf(w.domain, sizeof w.domain, "%s", s->detail);
    snprintf(w.input, sizeof w.input, "(%.9g %.9g %.9g)", total.point.direction[0],
             total.point.direction[1], total.point.direction[2]);
    report(&w, &total);
}

static bool is_selected(const char* function, int count, char** names)
{
    for (int i = 0; i < count; ++i) {
        if (strcmp(names[i], function) == 0) {
            return true;
        }
    }
    return count == 0;
}

int main(int argc, char** argv)
{
    static const ex_sweep* const sweeps[] = {ex_sweeps_built_in, ex_sweeps_math, ex_sweeps_brdf,
                                             ex_sweeps_light,    ex_sweeps_cull, ex_sweeps_pack};
    struct timespec start, end;
    int first = 1;
    timespec_get(&start, TIME_UTC);
    for (; first < argc && argv[first][0] == '-'; ++first) {
        if (strcmp(argv[first], "--subset") == 0) {
            subset = true;
        } else if (strcmp(argv[first], "--csv") == 0 && first + 1 < argc) {
            csv = fopen(argv[++first], "w");
        }
    }
    if (csv) {
        fprintf(csv, "name,domain,count,worst_error,worst_input,mean,unit,non_finite,"
                     "non_finite_outside,id,claim\n");
    }
    for (size_t t = 0; t < COUNT(sweeps); ++t) {
        for (const ex_sweep* s = sweeps[t]; s->function; ++s) {
            if (is_selected(s->function, argc - first, argv + first)) {
                report_sweep(s);
            }
        }
    }
    for (const ex_walk* w = ex_walks_pack; w->function; ++w) {
        if (is_selected(w->function, argc - first, argv + first)) {
            report_walk(w);
        }
    }
    for (const ex_search* s = ex_searches_pack; s->function; ++s) {
        if (is_selected(s->function, argc - first, argv + first)) {
            report_search(s);
        }
    }
    if (csv && fclose(csv) != 0) {
        fprintf(stderr, "exhaustive: cannot write the CSV file\n");
        return 1;
    }
    timespec_get(&end, TIME_UTC);
    printf("%d rows, %d failed; %.0f s, %.0f s of processors\n", rows, failures,
           difftime(end.tv_sec, start.tv_sec), (double)clock() / CLOCKS_PER_SEC);
    return failures != 0 || rows == 0;
}
