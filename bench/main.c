/* main.c - times all kernels: bench_cpu [--rounds N] [--csv FILE] [--features-csv FILE] [WORD]
 * SPDX-License-Identifier: MIT
 *
 * One core. The kernels that do the same work, hdrp's and its peers', take turns, so that whatever
 * slows the machine down slows down both; of all turns the median counts. */
#define _GNU_SOURCE
#include "bench.h"
#include "errors.h"

#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define ROUNDS_MAX  1001
#define KERNELS_MAX 2048
/* Long enough for the clock, short enough that few turns are interrupted. */
#define TURN_SECONDS 20e-6

typedef struct measurement {
    const bench_kernel* kernel;
    const char* build;
    int calls; /* of run, a turn */
    double ns; /* an element, the median */
    bool done;
    double turns[ROUNDS_MAX];
} measurement;

static measurement measurements[KERNELS_MAX];
static int measurement_count;
static int rounds = 101;

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double turn(const measurement* m)
{
    double start = seconds();
    for (int i = 0; i < m->calls; ++i) {
        m->kernel->run();
    }
    return seconds() - start;
}

static void add(const bench_list* list, const char* build, const char* word)
{
    for (size_t i = 0; i < list->count && measurement_count < KERNELS_MAX; ++i) {
        const bench_kernel* k = &list->kernels[i];
        if (!word || strstr(k->name, word) || strstr(k->topic, word)) {
            measurements[measurement_count].kernel = k;
            measurements[measurement_count++].build = build;
        }
    }
}

static double elements(const measurement* m)
{
    return strcmp(m->kernel->form, "memory") ? BENCH_COUNT : BENCH_MEMORY_COUNT;
}

/* How many calls make a turn. The first ones bring code and data into the caches. */
static void calibrate(measurement* m)
{
    m->calls = 1;
    turn(m);
    while (turn(m) < TURN_SECONDS && m->calls < 1 << 20) {
        m->calls *= 2;
    }
}

static int by_value(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

static bool same_work(const measurement* a, const measurement* b)
{
    return !strcmp(a->kernel->topic, b->kernel->topic) &&
           !strcmp(a->kernel->name, b->kernel->name) && !strcmp(a->kernel->form, b->kernel->form);
}

static void measure_group(measurement* first)
{
    measurement* group[64];
    int count = 0;
    for (int i = 0; i < measurement_count && count < 64; ++i) {
        if (same_work(&measurements[i], first)) {
            calibrate(&measurements[i]);
            group[count++] = &measurements[i];
        }
    }
    /* Turns through memory, and tables, take as long as hundreds of others. */
    bool is_slow = turn(group[0]) > 50.0 * TURN_SECONDS;
    int turns = is_slow ? rounds / 8 + 1 : rounds;
    for (int r = 0; r < turns; ++r) {
        for (int i = 0; i < count; ++i) {
            bench_data_shuffle();
            group[i]->turns[r] = turn(group[i]);
        }
    }
    for (int i = 0; i < count; ++i) {
        measurement* m = group[i];
        qsort(m->turns, (size_t)turns, sizeof m->turns[0], by_value);
        m->ns = 1e9 * m->turns[turns / 2] / m->calls / elements(m);
        m->done = true;
    }
}

static void print_row(FILE* csv, const measurement* m, const measurement* peer)
{
    const bench_kernel* k = m->kernel;
    printf("%-18s %-46s %-6s %-7s %8.3f", k->topic, k->name, m->build, k->form, m->ns);
    fprintf(csv, "%s,%s,%s,%s,%.3g,", k->topic, k->name, m->build, k->form, m->ns);
    if (peer) {
        printf("  %-30s %8.3f %7.2f\n", peer->kernel->peer, peer->ns, peer->ns / m->ns);
        fprintf(csv, "%s,%.3g,%.3g\n", peer->kernel->peer, peer->ns, peer->ns / m->ns);
    } else {
        printf("\n");
        fprintf(csv, ",,\n");
    }
}

static void print_rows(FILE* csv, const measurement* m)
{
    bool any = false;
    if (!strncmp(m->kernel->topic, "feature", 7)) {
        return; /* they have a file of their own */
    }
    for (int i = 0; i < measurement_count; ++i) {
        const measurement* p = &measurements[i];
        if (p->kernel->peer && same_work(m, p) && !strcmp(m->build, p->build)) {
            print_row(csv, m, p);
            any = true;
        }
    }
    if (!any) {
        print_row(csv, m, NULL);
    }
}

static double ns_of(const char* topic, const char* name, const char* build)
{
    for (int i = 0; i < measurement_count; ++i) {
        const measurement* m = &measurements[i];
        if (!strcmp(m->kernel->topic, topic) && !strcmp(m->kernel->name, name) &&
            !strcmp(m->build, build) && !strcmp(m->kernel->form, "vector")) {
            return m->ns;
        }
    }
    return 0.0;
}

/* A light, and once a pixel the view, by gcc and by clang. */
static void print_features(FILE* csv)
{
    for (int i = 0; i < measurement_count; ++i) {
        const bench_kernel* k = measurements[i].kernel;
        if (strcmp(k->topic, "feature") || strcmp(k->form, "vector") ||
            strcmp(measurements[i].build, "gcc")) {
            continue;
        }
        fprintf(csv, "%s,%.3g,%.3g,%.3g,%.3g\n", k->name, measurements[i].ns,
                ns_of("feature_view", k->name, "gcc"), ns_of("feature", k->name, "clang"),
                ns_of("feature_view", k->name, "clang"));
    }
}

static FILE* open_csv(const char* name, const char* header)
{
    FILE* f = fopen(name ? name : "/dev/null", "w");
    if (!f) {
        perror(name);
        exit(1);
    }
    fprintf(f, "%s\n", header);
    return f;
}

static void pin(void)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET((size_t)sched_getcpu(), &set);
    if (sched_setaffinity(0, sizeof set, &set)) {
        perror("sched_setaffinity");
    }
}

#define ADD(build, name)                                                                           \
    do {                                                                                           \
        add(&bench_formulas_##build, name, word);                                                  \
        add(&bench_peers_##build, name, word);                                                     \
        add(&bench_peers_cpp_##build, name, word);                                                 \
    } while (0)

int main(int argc, char** argv)
{
    const char *csv_name = NULL, *features_name = NULL, *word = NULL;
    FILE *csv, *features_csv;
    for (int i = 1; i < argc; ++i) {
        if (!strcmp(argv[i], "--rounds") && i + 1 < argc) {
            rounds = atoi(argv[++i]);
        } else if (!strcmp(argv[i], "--csv") && i + 1 < argc) {
            csv_name = argv[++i];
        } else if (!strcmp(argv[i], "--features-csv") && i + 1 < argc) {
            features_name = argv[++i];
        } else {
            word = argv[i];
        }
    }
    if (rounds < 1 || rounds > ROUNDS_MAX) {
        fprintf(stderr, "bench_cpu: --rounds must be in [1, %d]\n", ROUNDS_MAX);
        return 1;
    }
    pin();
    bench_data_init();
    ADD(gcc, "gcc");
    ADD(gcc_trapping, "gcc-trapping");
    ADD(clang, "clang");
    csv = open_csv(csv_name, "topic,name,build,form,ns,peer,peer_ns,ratio");
    features_csv = open_csv(features_name, "set,ns,view_ns,clang_ns,clang_view_ns");
    for (int i = 0; i < measurement_count; ++i) {
        if (!measurements[i].done) {
            measure_group(&measurements[i]);
        }
        if (!measurements[i].kernel->peer) {
            print_rows(csv, &measurements[i]);
        }
    }
    print_features(features_csv);
    bench_print_errors();
    fclose(csv);
    fclose(features_csv);
    return 0;
}
