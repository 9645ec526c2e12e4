/* Times and counts of a run: a table for people, JSON for programs. */
#ifndef RD_STATS_H
#define RD_STATS_H

#include "report.h"

#include <stdint.h>

#define RD_STATS_MAX 48

typedef struct rd_stats_entry {
    const char* name;
    double value;
} rd_stats_entry;

/* Names must outlive the stats. Adding to a name that exists sums up. */
typedef struct rd_stats {
    rd_stats_entry passes[RD_STATS_MAX]; /* milliseconds */
    rd_stats_entry counts[RD_STATS_MAX];
    rd_stats_entry limits[RD_STATS_MAX];   /* what was dropped; listed even where it is 0 */
    rd_stats_entry errors[RD_STATS_MAX];   /* results of --compare */
    rd_stats_entry lit[RD_STATS_MAX];      /* samples by features of their material */
    rd_stats_entry lit_ns[RD_STATS_MAX];   /* to light one of them */
    rd_stats_entry lists[RD_STATS_MAX];    /* of lights: lengths, visits, costs of variants */
    rd_stats_entry variants[RD_STATS_MAX]; /* tiles that run each */
    rd_stats_entry variant_cycles[RD_STATS_MAX];
    int list_count, variant_count, variant_cycles_count;
    int pass_count, count_count, limit_count, error_count, lit_count, lit_ns_count;
    double begin_ms;
    const char* scene;  /* for the JSON file */
    const char* device; /* of --backend vulkan; NULL: the CPU */
    int width, height, spp;
} rd_stats;

double rd_now_ms(void);
void rd_stats_begin(rd_stats* s);
void rd_stats_pass(rd_stats* s, const char* name, double ms);
void rd_stats_count(rd_stats* s, const char* name, double n);
void rd_stats_limit(rd_stats* s, const char* name, double n);
void rd_stats_error(rd_stats* s, const char* name, double value);
/* Lights of all kinds, sky and shadow rays, on one thread; NaN where it could not be told. */
void rd_stats_lit(rd_stats* s, const char* material, double samples, double ns_each);

void rd_stats_list(rd_stats* s, const char* name, double value);
/* What a tile of it costs by the model of variants.c. */
void rd_stats_variant(rd_stats* s, const char* features, double tiles, double cycles_each);

void rd_stats_print(const rd_stats* s);
bool rd_stats_write(const rd_stats* s, const char* path, rd_report* report);

#endif
