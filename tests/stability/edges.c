/* edges.c - behaviour at and around the ends of every documented range: edges [FUNCTION...]
 * SPDX-License-Identifier: MIT
 *
 * Every formula is called at the end of the range of one of its arguments, at the 16 floats inside
 * it and at the 16 outside; the other arguments are drawn from inside their ranges, 256 times.
 * Prints a CSV line per end:
 *
 *     function,parameter,end,value,jump,inside,outside
 *
 * value: of the first draw, its first number. jump: the step of a result from the end to the next
 * float inside, less 4 times the largest of the steps that follow, in units in the last place of
 * the largest magnitude among them; 0 for less than 64 of those, which rounding explains. inside:
 * 'smooth', 'jumps' or 'not finite'. outside: 'held' where all results stay those of the end,
 * 'continues', 'jumps' or 'not finite'; 'no call' where what the function requires ends there
 * too. */
#include "edges.h"

#define main finite_scan_main
#include "../finite/finite_scan.c"
#undef main

#define FS_HEADER(name) extern const range_edge edges_##name[];
#include "modules.inc"
#undef FS_HEADER

static const range_edge* const edge_tables[] = {
#define FS_HEADER(name) edges_##name,
#include "modules.inc"
#undef FS_HEADER
};

#define DRAWS    256
#define SMALLEST 64.0 /* units in the last place that are no jump */
#define STEPS    16
#define PLACES   (2 * STEPS + 1)

typedef struct verdict {
    double value, jump, outside_jump;
    bool any, finite_inside, finite_outside, held, called_outside;
} verdict;

static float moved(float x, int direction, int count)
{
    for (int i = 0; i < count; ++i) {
        x = nextafterf(x, direction > 0 ? INFINITY : -INFINITY);
    }
    return x;
}

static void draw(const range_edge* e, uint64_t k, uint64_t storage[][MAX_BYTES / 8],
                 const void** arguments)
{
    const fs_function* f = e->function;
    for (size_t i = 0; i < f->argument_count; ++i) {
        const fs_source* source = f->arguments[i].source;
        memcpy(storage[i], sample(source, (size_t)(hash(k, i) % source->count)), source->size);
        arguments[i] = storage[i];
    }
}

static bool call_at(const range_edge* e, float x, uint64_t storage[][MAX_BYTES / 8],
                    const void* const* arguments, uint64_t* result)
{
    memcpy((unsigned char*)storage[e->argument] + e->offset, &x, sizeof x);
    if (e->function->is_required && !e->function->is_required(arguments)) {
        return false;
    }
    e->function->call(arguments, result);
    return true;
}

/* Step from the end, x[0], to x[1] beyond what the steps from there to x[STEPS] explain, in units
 * in the last place. */
static double jump_of(double end, const double* x)
{
    double size = fmax(fmax(fabs(end), fabs(x[0])), (double)FLT_MIN), largest = 0.0;
    for (int i = 1; i < STEPS; ++i) {
        largest = fmax(largest, fabs(x[i] - x[i - 1]));
        size = fmax(size, fabs(x[i]));
    }
    double ulps = (fabs(end - x[0]) - 4.0 * largest) / (size * 0x1p-24);
    return ulps > SMALLEST ? ulps : 0.0;
}

/* Floats of one result leaf: at the end, then inside, then outside. */
static void judge(verdict* v, const double x[PLACES], bool called_outside)
{
    bool inside = true, outside = true, held = true;
    for (int i = 0; i <= STEPS; ++i) {
        inside = inside && isfinite(x[i]);
    }
    for (int i = STEPS + 1; i < PLACES && called_outside; ++i) {
        outside = outside && isfinite(x[i]);
        held = held && x[i] == x[0];
    }
    v->finite_inside = v->finite_inside && inside;
    v->finite_outside = v->finite_outside && outside;
    v->held = v->held && held;
    v->jump = inside ? fmax(v->jump, jump_of(x[0], x + 1)) : v->jump;
    if (called_outside && inside && outside) {
        v->outside_jump = fmax(v->outside_jump, jump_of(x[0], x + STEPS + 1));
    }
}

static verdict walk_edge(const range_edge* e)
{
    static uint64_t storage[MAX_ARGUMENTS][MAX_BYTES / 8], results[PLACES][MAX_BYTES / 8];
    const void* arguments[MAX_ARGUMENTS];
    verdict v = {0.0, 0.0, 0.0, false, true, true, true, false};
    float at_end = e->closed ? e->end : moved(e->end, e->inwards, 1);
    for (uint64_t k = 0; k < DRAWS; ++k) {
        int called_inside = 0, called_outside = 0;
        draw(e, k, storage, arguments);
        for (int i = 0; i < PLACES; ++i) {
            int step = i <= STEPS ? i : STEPS - i;
            bool called = call_at(e, moved(at_end, step < 0 ? -e->inwards : e->inwards, abs(step)),
                                  storage, arguments, results[i]);
            called_inside += called && step >= 0;
            called_outside += called && step < 0;
        }
        if (called_inside <= STEPS) {
            continue;
        }
        bool outside = called_outside == STEPS;
        v.called_outside = v.called_outside || outside;
        for (size_t i = 0; i < e->function->result->leaf_count; ++i) {
            const fs_leaf* leaf = &e->function->result->leaves[i];
            double x[PLACES];
            if (leaf->kind != FS_F32) {
                continue;
            }
            for (int j = 0; j < PLACES; ++j) {
                x[j] = (double)f32_at((unsigned char*)results[j], leaf->offset);
            }
            v.value = v.any ? v.value : x[0];
            v.any = true;
            judge(&v, x, outside);
        }
    }
    return v;
}

static bool has_floats(const fs_function* f)
{
    for (size_t i = 0; i < f->result->leaf_count; ++i) {
        if (f->result->leaves[i].kind == FS_F32) {
            return true;
        }
    }
    return false;
}

static void print_edge(const range_edge* e, verdict v)
{
    const char* inside = !v.finite_inside ? "not finite" : v.jump > 0.0 ? "jumps" : "smooth";
    const char* outside = !v.called_outside      ? "no call"
                          : !v.finite_outside    ? "not finite"
                          : v.held               ? "held"
                          : v.outside_jump > 0.0 ? "jumps"
                                                 : "continues";
    printf("%s,%s,%.6g,%.3g,%.2g,%s,%s\n", e->function->name, e->parameter, (double)e->end, v.value,
           v.jump, inside, outside);
}

int main(int argc, char** argv)
{
    printf("function,parameter,end,value,jump,inside,outside\n");
    for (size_t h = 0; h < sizeof edge_tables / sizeof edge_tables[0]; ++h) {
        for (const range_edge* e = edge_tables[h]; e->function; ++e) {
            const fs_function* f = e->function;
            if (f->missing || !has_floats(f) || !is_selected(f->name, argc - 1, argv + 1)) {
                continue;
            }
            if (!build_arguments(f)) {
                fprintf(stderr, "edges: no samples for %s\n", f->name);
                return 1;
            }
            verdict v = walk_edge(e);
            if (v.any) {
                print_edge(e, v);
            }
        }
    }
    return 0;
}
