/* cull_counts.h - how good lists are: pairs over those that exist, visits over those that light.
 * SPDX-License-Identifier: MIT
 *
 * The truth is computed in double, or by tests/cull/cull_reference.h, and shares no code with
 * hdrp_cull.h. */
#ifndef CULL_COUNTS_H
#define CULL_COUNTS_H

#include "cull_scene.h"
#include "hdrp_cull.h"

#include <stdbool.h>

typedef struct cull_counts {
    uint64_t pairs; /* of a cell and a light in its list */
    /* Of those tiles for which it is counted, or 0: the same, and those that reach the cell. */
    uint64_t compared_pairs, exact_pairs;
    uint64_t visits;      /* of a pixel and a light in its list */
    uint64_t true_visits; /* of a pixel and a light that reaches it */
} cull_counts;

typedef struct cull_truth_light {
    double position[3], forward[3], range, cosine; /* cosine < -1: all around */
} cull_truth_light;

/* Exact pairs of a grid, which serve all ways to fill it. */
#define CULL_EXACT_MAX 8
typedef struct cull_exact {
    uint32_t tile_px, slices;
    bool for_pixels;
    uint64_t pairs;
} cull_exact;

/* The lights of a workload, and some pixels: how many lights reach each. */
typedef struct cull_truth {
    const cull_scene* scene;
    const float* texels;
    cull_scene_mix mix;
    cull_truth_light* lights;
    uint32_t light_count, pixel_count;
    uint32_t *pixel_x, *pixel_y, *reached;
    cull_exact exact[CULL_EXACT_MAX];
    uint32_t exact_count;
} cull_truth;

void cull_truth_make(cull_truth* truth, const cull_scene* scene, const float* texels,
                     cull_scene_mix mix, uint32_t light_count);
void cull_truth_free(cull_truth* truth);

/* Pairs and visits. */
void cull_counts_lists(cull_counts* counts, const cull_truth* truth, const hdrp_cull_lists* lists);
/* Exact pairs. Lights of lists that are made for pixels have to reach one. */
void cull_counts_exact(cull_counts* counts, cull_truth* truth, const hdrp_cull_lists* lists);

/* The simple method, for comparison: every ball with the box around every cell of a grid whose
 * slices are the same in all tiles. */
typedef struct cull_naive {
    hdrp_v3 *lo, *hi; /* of each cell, in view space */
    uint32_t* begin;  /* of the list of each cell, and of one more */
    uint16_t* entries;
    uint32_t cell_count, entry_capacity;
} cull_naive;

void cull_naive_make(cull_naive* naive, const hdrp_cull_lists* lists);
void cull_naive_free(cull_naive* naive);
void cull_naive_build(cull_naive* naive, const hdrp_cull_set* set);
void cull_counts_naive(cull_counts* counts, const cull_truth* truth, const cull_naive* naive,
                       const hdrp_cull_lists* lists);

#endif
