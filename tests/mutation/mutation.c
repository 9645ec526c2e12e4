/* mutation.c - would the registry notice? mutation [--part I N] [--only TEXT] OUTPUT.csv
 * SPDX-License-Identifier: MIT
 *
 * Built against headers in which tools/mutate.py has made every constant a possible fault. Each
 * entry of the registry runs once to learn its result and which faults it can see; then each fault
 * is switched on, and the entries that see it run, the quickest first, until one notices: its error
 * exceeds the claim, a result is not finite, or the maximum or the mean differ from what they were
 * in three digits, which is what the record of the registry holds them to. --only tries faults
 * whose header or key holds a text. */
#include "mutant.h"

#define main accuracy_main
#include "../accuracy/accuracy.c"
#undef main

#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define MOST_ENTRIES 1024

int hdrp_mutant;
float hdrp_mutant_factor = 1.0f;
unsigned char hdrp_mutant_reached[HDRP_MUTANT_MAX];

typedef struct mutant_info {
    const char* header;
    int line;
    const char* kind;
    const char* key;
    float amount;
} mutant_info;

static const mutant_info mutants[] = {
#include "mutants.inc"
};
#define MUTANT_COUNT ((int)(sizeof mutants / sizeof mutants[0]))

typedef struct entry_result {
    char max[16], mean[16];
    bool good;
} entry_result;

typedef struct entry_state {
    const acc_entry* entry;
    const acc_claim* claim;
    double seconds;
    entry_result result;
    unsigned char reached[HDRP_MUTANT_MAX];
} entry_state;

static entry_state entries[MOST_ENTRIES];
static int entry_count;

static entry_result run(const acc_entry* entry, const acc_claim* claim)
{
    acc a = {.unit = claim->unit, .random_state = 1};
    entry_result r;
    entry->run(&a);
    snprintf(r.max, sizeof r.max, "%.3g", a.max);
    snprintf(r.mean, sizeof r.mean, "%.3g", a.count ? a.sum / (double)a.count : 0.0);
    r.good = a.non_finite == 0 && a.max <= claim->bound;
    return r;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int by_time(const void* a, const void* b)
{
    double x = ((const entry_state*)a)->seconds, y = ((const entry_state*)b)->seconds;
    return (x > y) - (x < y);
}

static void learn(void)
{
    for (size_t m = 0; m < MODULE_COUNT; ++m) {
        for (const acc_entry* e = modules[m]; e->id && entry_count < MOST_ENTRIES; ++e) {
            entry_state* s = &entries[entry_count++];
            s->entry = e;
            s->claim = find_claim(e->id);
            memset(hdrp_mutant_reached, 0, sizeof hdrp_mutant_reached);
            double begin = now();
            s->result = run(e, s->claim);
            s->seconds = now() - begin;
            memcpy(s->reached, hdrp_mutant_reached, sizeof s->reached);
        }
    }
    qsort(entries, (size_t)entry_count, sizeof entries[0], by_time);
}

/* The first entry that notices mutant k, or -1. */
static int first_to_notice(int k)
{
    hdrp_mutant = k;
    hdrp_mutant_factor = 1.0f + mutants[k - 1].amount;
    for (int i = 0; i < entry_count; ++i) {
        const entry_state* s = &entries[i];
        if (!s->reached[k]) {
            continue;
        }
        entry_result r = run(s->entry, s->claim);
        if (!r.good || strcmp(r.max, s->result.max) != 0 || strcmp(r.mean, s->result.mean) != 0) {
            return i;
        }
    }
    return -1;
}

/* In a process of its own: a fault may crash or not come back, which is noticed too. */
static const char* verdict(int k, int seconds)
{
    int channel[2], found = -2;
    if (pipe(channel) != 0) {
        return "error";
    }
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        setrlimit(RLIMIT_CPU, &(struct rlimit){(rlim_t)seconds, (rlim_t)seconds});
        found = first_to_notice(k);
        _exit(write(channel[1], &found, sizeof found) != sizeof found);
    }
    close(channel[1]);
    bool answered = read(channel[0], &found, sizeof found) == sizeof found;
    close(channel[0]);
    waitpid(child, NULL, 0);
    if (!answered) {
        return "crash";
    }
    return found < 0 ? "" : entries[found].entry->id;
}

int main(int argc, char** argv)
{
    int part = 0, parts = 1, at = 1;
    const char* only = "";
    if (at + 3 < argc && strcmp(argv[at], "--part") == 0) {
        part = atoi(argv[at + 1]);
        parts = atoi(argv[at + 2]);
        at += 3;
    }
    if (at + 2 < argc && strcmp(argv[at], "--only") == 0) {
        only = argv[at + 1];
        at += 2;
    }
    if (at + 1 != argc) {
        fprintf(stderr, "usage: mutation [--part I N] [--only TEXT] OUTPUT.csv\n");
        return 2;
    }
    FILE* csv = fopen(argv[at], "w");
    if (!csv) {
        fprintf(stderr, "mutation: cannot write %s\n", argv[at]);
        return 1;
    }
    learn();
    double all = 0.0;
    for (int i = 0; i < entry_count; ++i) {
        all += entries[i].seconds;
    }
    fprintf(csv, "number,header,line,kind,key,amount,reached,noticed_by\n");
    for (int k = 1 + part; k <= MUTANT_COUNT; k += parts) {
        const mutant_info* m = &mutants[k - 1];
        int reached = 0;
        if (!strstr(m->header, only) && !strstr(m->key, only)) {
            continue;
        }
        for (int i = 0; i < entry_count; ++i) {
            reached += entries[i].reached[k];
        }
        fprintf(csv, "%d,%s,%d,%s,%s,%g,%d,%s\n", k, m->header, m->line, m->kind, m->key,
                (double)m->amount, reached, reached ? verdict(k, 10 + 5 * (int)all) : "");
        fflush(csv);
    }
    return fclose(csv) != 0;
}
