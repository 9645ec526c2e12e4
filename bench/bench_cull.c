/* bench_cull.c - times light culling: bench_cull [OPTIONS] [quick] [WORD]
 * SPDX-License-Identifier: MIT
 *
 * One core, but for the column of two jobs. All ways to cull the same lights take turns of a frame,
 * so that whatever slows the machine down slows down all of them; of all turns the median counts, or
 * with --least, for a machine that has other work, the least of the time that the processor had for
 * it. "quick" is 1000 lights at 1280 x 720; a word selects the ways whose names contain it, or with =
 * in front of it the way of that name. */
#define _GNU_SOURCE
#define HDRP_CULL_IMPLEMENTATION
#include "hdrp_cull.h"

#include "cull_counts.h"
#include "cull_scene.h"
#include "cull_team.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define ROUNDS_MAX 1001
#define WAYS_MAX   16
/* Two jobs share frames that take at least as long. */
#define TWO_JOBS_MS 2.0
/* Beyond this many, the exact count takes minutes. */
#define EXACT_LIGHTS_MAX 1000u

enum { PROJECT, DEPTH, BUILD, STAGE_COUNT, TOTAL = STAGE_COUNT };

/* A way to cull. */
typedef struct way {
    const char* name;
    bool is_naive; /* not hdrp's: a test of every light with every cell */
    bool has_depth;
    hdrp_cull_desc desc;
    hdrp_cull_lists lists;
    void *memory, *scratch[2]; /* scratch of each job */
    size_t scratch_bytes;
    cull_naive naive;
    double turns[TOTAL + 1][ROUNDS_MAX]; /* ms */
    double ms[TOTAL + 1];                /* medians */
    cull_counts counts;
    double speedup;      /* by two jobs; 0: not measured */
    double us_per_light; /* that was added since the last count of lights */
    double last_ms;
    uint32_t last_count;
} way;

static struct {
    cull_scene scene;
    cull_scene_mix mix;
    uint32_t count;
    float* texels;
    hdrp_cull_shape* shapes;
    hdrp_cull_set set;
    void* set_memory;
} work;

static const char* const mix_names[] = {"points", "half", "spots"};
static way ways[WAYS_MAX];
static int way_count;
static int rounds = 31;
static bool takes_least;

static void check(hdrp_result r, const char* what)
{
    if (r != HDRP_OK) {
        fprintf(stderr, "bench_cull: %s: %s\n", what, hdrp_result_string(r));
        exit(1);
    }
}

static void* allocate(size_t bytes)
{
    void* p = aligned_alloc(64, (bytes + 64u) / 64u * 64u);
    if (!p) {
        fprintf(stderr, "bench_cull: out of memory\n");
        exit(1);
    }
    return p;
}

static double milliseconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static int by_value(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

/* The median, or the least. */
static double typical(double* values)
{
    qsort(values, (size_t)rounds, sizeof *values, by_value);
    return values[takes_least ? 0 : rounds / 2];
}

/* ---- a frame ----------------------------------------------------------------------------------*/

static hdrp_cull_depth work_depth(void)
{
    hdrp_cull_depth depth = {work.texels, work.scene.width_px, NULL};
    return depth;
}

/* How many parts a stage has. */
static uint32_t parts_of(const way* w, int stage)
{
    uint32_t rows = stage == BUILD ? hdrp_cull_rows(&w->lists) : w->lists.grid.tiles.w;
    return stage == PROJECT ? work.count : stage == DEPTH && !w->has_depth ? 0u : rows;
}

static void run_parts(way* w, int stage, uint32_t first, uint32_t count, int job)
{
    hdrp_cull_depth depth = work_depth();
    if (stage == PROJECT) {
        check(hdrp_cull_set_project(&work.set, work.shapes, first, count), "project");
    } else if (stage == DEPTH) {
        check(hdrp_cull_measure_depth(&w->lists, &depth, first, count), "measure_depth");
    } else {
        check(hdrp_cull_build(&w->lists, &work.set, w->has_depth ? &depth : NULL, first, count,
                              w->scratch[job], w->scratch_bytes),
              "build");
    }
}

static void begin_stage(void* argument, int stage)
{
    way* w = argument;
    if (stage == PROJECT) {
        check(hdrp_cull_set_begin(&work.set, &work.scene.camera, work.scene.width_px,
                                  work.scene.height_px, work.count),
              "set_begin");
    } else if (stage == DEPTH) {
        check(hdrp_cull_begin(&w->lists, &work.set), "begin");
    }
}

/* On one core; the times are those of turn r. */
static void run_frame(way* w, int r, clockid_t clock)
{
    double t[STAGE_COUNT + 1];
    t[0] = milliseconds(clock);
    for (int stage = 0; stage < STAGE_COUNT; ++stage) {
        if (w->is_naive) {
            if (stage == BUILD) {
                cull_naive_build(&w->naive, &work.set);
            }
        } else {
            begin_stage(w, stage);
            if (parts_of(w, stage) > 0u) {
                run_parts(w, stage, 0u, parts_of(w, stage), 0);
            }
        }
        t[stage + 1] = milliseconds(clock);
        w->turns[stage][r] = t[stage + 1] - t[stage];
    }
    w->turns[TOTAL][r] = t[STAGE_COUNT] - t[0];
}

/* ---- two jobs ---------------------------------------------------------------------------------*/

static cull_team team;

static void run_job(void* argument, int stage, int job)
{
    way* w = argument;
    uint32_t total = parts_of(w, stage), step = stage == PROJECT ? 64u : 1u, first;
    while ((first = cull_team_take(&team, step)) < total) {
        run_parts(w, stage, first, total - first < step ? total - first : step, job);
    }
}

static void measure_two_jobs(way* w)
{
    static double two[ROUNDS_MAX];
    team.stage_count = STAGE_COUNT;
    team.begin = begin_stage;
    team.run = run_job;
    team.argument = w;
    if (!cull_team_start(&team)) {
        return;
    }
    for (int r = 0; r < rounds; ++r) {
        double start;
        run_frame(w, r, CLOCK_MONOTONIC);
        start = milliseconds(CLOCK_MONOTONIC);
        cull_team_frame(&team);
        two[r] = milliseconds(CLOCK_MONOTONIC) - start;
    }
    cull_team_stop(&team);
    w->speedup = typical(w->turns[TOTAL]) / typical(two);
}

/* ---- what is measured -------------------------------------------------------------------------*/

static void add_way(const char* name, const char* word, uint32_t tile_width_px,
                    uint32_t tile_height_px, uint32_t slices, uint32_t flags)
{
    way* w = &ways[way_count];
    if (word && (word[0] == '=' ? strcmp(name, word + 1) != 0 : !strstr(name, word))) {
        return;
    }
    memset(w, 0, sizeof *w);
    w->name = name;
    w->desc.width_px = work.scene.width_px;
    w->desc.height_px = work.scene.height_px;
    w->desc.tile_width_px = tile_width_px;
    w->desc.tile_height_px = tile_height_px;
    w->desc.slice_count = slices;
    w->desc.flags = flags;
    w->has_depth = (flags & HDRP_CULL_ONE_SERIES) == 0u;
    if (!w->has_depth) {
        w->desc.series_start_m = 5.0f;
    }
    w->is_naive = strstr(name, "naive") != NULL;
    ++way_count;
}

static void add_ways(const char* word)
{
    uint32_t width = (work.scene.width_px + 16u) / 17u, height = (work.scene.height_px + 8u) / 9u;
    way_count = 0;
    add_way("grid 17x9x24", word, width, height, 24u, HDRP_CULL_ONE_SERIES);
    add_way("grid 17x9x24, fast", word, width, height, 24u, HDRP_CULL_ONE_SERIES | HDRP_CULL_FAST);
    add_way("grid 17x9x24, naive", word, width, height, 24u, HDRP_CULL_ONE_SERIES);
    add_way("clusters 32x32x64", word, 32u, 32u, 64u, 0u);
    add_way("clusters 32x32x64, fast", word, 32u, 32u, 64u, HDRP_CULL_FAST);
    add_way("tiles 16x16", word, 16u, 16u, 1u, HDRP_CULL_PIXELS);
    add_way("tiles 16x16, blocks", word, 16u, 16u, 1u, HDRP_CULL_BLOCKS);
    add_way("tiles 16x16, masks", word, 16u, 16u, 1u, HDRP_CULL_MASKS);
    add_way("tiles 16x16, no pixels", word, 16u, 16u, 1u, 0u);
    add_way("tiles 16x16, no pixels, fast", word, 16u, 16u, 1u, HDRP_CULL_FAST);
}

static void free_way(way* w)
{
    free(w->memory);
    free(w->scratch[0]);
    free(w->scratch[1]);
    cull_naive_free(&w->naive);
    w->memory = w->scratch[0] = w->scratch[1] = NULL;
}

static void place_way(way* w)
{
    size_t bytes = hdrp_cull_memory_size(&w->desc);
    free_way(w);
    w->memory = allocate(bytes);
    w->scratch_bytes = hdrp_cull_scratch_size(&w->desc);
    w->scratch[0] = allocate(w->scratch_bytes);
    w->scratch[1] = allocate(w->scratch_bytes);
    check(hdrp_cull_init(&w->lists, &w->desc, w->memory, bytes), "init");
}

/* With room for all entries: as much as is the default, or twice as much, and so on. */
static void prepare_way(way* w)
{
    hdrp_cull_stats stats;
    w->desc.shape_capacity = work.count;
    w->desc.entry_capacity = 0u;
    w->speedup = 0.0;
    for (;;) {
        place_way(w);
        begin_stage(w, PROJECT);
        run_parts(w, PROJECT, 0u, work.count, 0);
        begin_stage(w, DEPTH);
        if (w->is_naive) {
            cull_naive_make(&w->naive, &w->lists);
            return;
        }
        run_frame(w, 0, CLOCK_MONOTONIC);
        check(hdrp_cull_count(&w->lists, &stats), "count");
        if (stats.dropped == 0u) {
            return;
        }
        w->desc.entry_capacity = 2u * w->lists.desc.entry_capacity;
    }
}

static void prepare_work(cull_scene_mix mix, uint32_t count)
{
    size_t bytes = hdrp_cull_set_memory_size(count);
    free(work.shapes);
    free(work.set_memory);
    work.mix = mix;
    work.count = count;
    work.shapes = allocate(count * sizeof *work.shapes);
    work.set_memory = allocate(bytes);
    for (uint32_t i = 0u; i < count; ++i) {
        work.shapes[i] = hdrp_cull_shape_from_light(cull_scene_light(&work.scene, mix, i));
    }
    check(hdrp_cull_set_init(&work.set, count, work.set_memory, bytes), "set_init");
}

static void count_way(way* w, cull_truth* truth)
{
    memset(&w->counts, 0, sizeof w->counts);
    if (w->is_naive) {
        cull_counts_naive(&w->counts, truth, &w->naive, &w->lists);
    } else {
        cull_counts_lists(&w->counts, truth, &w->lists);
    }
    if (work.count <= EXACT_LIGHTS_MAX) {
        cull_counts_exact(&w->counts, truth, &w->lists);
    }
}

static void take_times(way* w)
{
    for (int stage = 0; stage <= TOTAL; ++stage) {
        w->ms[stage] = typical(w->turns[stage]);
    }
    w->us_per_light = 1e3 * (w->ms[TOTAL] - w->last_ms) / (work.count - w->last_count);
    w->last_ms = w->ms[TOTAL];
    w->last_count = work.count;
}

static void measure_all(void)
{
    cull_truth truth;
    cull_truth_make(&truth, &work.scene, work.texels, work.mix, work.count);
    for (int i = 0; i < way_count; ++i) {
        prepare_way(&ways[i]);
    }
    for (int r = 0; r < rounds; ++r) {
        for (int i = 0; i < way_count; ++i) {
            run_frame(&ways[i], r, takes_least ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC);
        }
    }
    for (int i = 0; i < way_count; ++i) {
        way* w = &ways[i];
        take_times(w);
        if (!w->is_naive && w->ms[TOTAL] >= TWO_JOBS_MS) {
            measure_two_jobs(w);
        }
        count_way(w, &truth);
        free_way(w);
    }
    cull_truth_free(&truth);
}

/* ---- results ----------------------------------------------------------------------------------*/

static void print_number(FILE* csv, const char* table_format, double x)
{
    if (x > 0.0) {
        printf(table_format, x);
        fprintf(csv, ",%.4g", x);
    } else {
        char width[16];
        int n = snprintf(width, sizeof width, table_format, 0.0);
        printf("%*s", n, "-");
        fprintf(csv, ",");
    }
}

static double ratio(double a, double b)
{
    return b > 0.0 ? a / b : 0.0;
}

static void print_way(FILE* csv, const way* w)
{
    const cull_counts* c = &w->counts;
    printf("%-29s", w->name);
    fprintf(csv, "%ux%u,%s,%u,\"%s\"", work.scene.width_px, work.scene.height_px,
            mix_names[work.mix], work.count, w->name);
    for (int stage = 0; stage <= TOTAL; ++stage) {
        print_number(csv, "%9.4f", w->ms[stage]);
    }
    print_number(csv, "%9.3f", w->us_per_light);
    print_number(csv, "%9.2f", ratio(1e6 * w->ms[BUILD], (double)c->pairs));
    print_number(csv, "%9.0f", (double)c->pairs);
    print_number(csv, "%7.3f", ratio((double)c->compared_pairs, (double)c->exact_pairs));
    print_number(csv, "%7.3f", ratio((double)c->visits, (double)c->true_visits));
    print_number(csv, "%7.2f", w->speedup);
    printf("\n");
    fprintf(csv, "\n");
}

static void print_all(FILE* csv)
{
    printf("\n%ux%u, %s, %u lights\n%-29s%9s%9s%9s%9s%9s%9s%9s%7s%7s%7s\n", work.scene.width_px,
           work.scene.height_px, mix_names[work.mix], work.count, "", "project", "depth", "build",
           "total", "us/light", "ns/pair", "pairs", "/exact", "/true", "2 jobs");
    for (int i = 0; i < way_count; ++i) {
        print_way(csv, &ways[i]);
    }
    fflush(stdout);
    fflush(csv);
}

static FILE* open_csv(const char* name)
{
    FILE* f = fopen(name ? name : "/dev/null", "w");
    if (!f) {
        perror(name);
        exit(1);
    }
    fprintf(f, "picture,mix,lights,way,project_ms,depth_ms,build_ms,total_ms,us_per_added_light,"
               "ns_per_pair,pairs,pairs_over_exact,visits_over_true,two_jobs_speedup\n");
    return f;
}

/* ---- options ----------------------------------------------------------------------------------*/

typedef struct options {
    const char *csv, *word, *mix;
    uint32_t lights, size; /* 0: all */
} options;

static void bad_option(const char* what)
{
    fprintf(stderr,
            "bench_cull: %s\nbench_cull [--rounds N] [--least] [--csv FILE] [--lights N] "
            "[--size 720|1080] [--mix points|half|spots] [quick] [WORD]\n",
            what);
    exit(2);
}

static options read_options(int argc, char** argv)
{
    options o = {NULL, NULL, NULL, 0u, 0u};
    for (int i = 1; i < argc; ++i) {
        bool has_value = i + 1 < argc;
        if (!strcmp(argv[i], "--rounds") && has_value) {
            rounds = atoi(argv[++i]);
        } else if (!strcmp(argv[i], "--csv") && has_value) {
            o.csv = argv[++i];
        } else if (!strcmp(argv[i], "--lights") && has_value) {
            o.lights = (uint32_t)strtoul(argv[++i], NULL, 10);
        } else if (!strcmp(argv[i], "--size") && has_value) {
            o.size = (uint32_t)strtoul(argv[++i], NULL, 10);
        } else if (!strcmp(argv[i], "--mix") && has_value) {
            o.mix = argv[++i];
        } else if (!strcmp(argv[i], "--least")) {
            takes_least = true;
        } else if (!strcmp(argv[i], "quick")) {
            o.lights = 1000u;
            o.size = 720u;
        } else if (argv[i][0] == '-') {
            bad_option("unknown option, or one without its value");
        } else {
            o.word = argv[i];
        }
    }
    if (rounds < 1 || rounds > ROUNDS_MAX || o.lights > HDRP_CULL_SHAPES_MAX) {
        bad_option("a number is out of range");
    }
    return o;
}

static void bench_scene(FILE* csv, options o, uint32_t width, uint32_t height)
{
    static const uint32_t counts[] = {10u, 50u, 100u, 250u, 500u, 1000u, 4000u, 10000u};
    cull_scene_make(&work.scene, width, height);
    free(work.texels);
    work.texels = allocate((size_t)width * height * sizeof *work.texels);
    cull_scene_depth(&work.scene, work.texels);
    for (int mix = CULL_SCENE_POINTS; mix <= CULL_SCENE_SPOTS; ++mix) {
        if (o.mix && strcmp(o.mix, mix_names[mix])) {
            continue;
        }
        add_ways(o.word);
        for (size_t i = 0; i < (o.lights ? 1u : sizeof counts / sizeof *counts); ++i) {
            prepare_work((cull_scene_mix)mix, o.lights ? o.lights : counts[i]);
            measure_all();
            print_all(csv);
        }
    }
}

int main(int argc, char** argv)
{
    options o = read_options(argc, argv);
    FILE* csv = open_csv(o.csv);
    sched_getaffinity(0, sizeof team.allowed, &team.allowed);
    cull_team_pin(&team.allowed, 0);
    if (o.size != 1080u) {
        bench_scene(csv, o, 1280u, 720u);
    }
    if (o.size != 720u) {
        bench_scene(csv, o, 1920u, 1080u);
    }
    fclose(csv);
    return 0;
}
