/* cull_harness.h - scenes for tests of hdrp_cull.h: shapes, what they truly reach, and lists.
 * SPDX-License-Identifier: MIT */
#ifndef CULL_HARNESS_H
#define CULL_HARNESS_H

#include "cull_reference.h"

#include <stdio.h>

/* >>random numbers: what follows from a seed is the same on every machine but for libm */

typedef struct cull_random {
    uint64_t state;
} cull_random;

uint64_t cull_bits(cull_random* r);
double cull_uniform(cull_random* r, double lo, double hi);
double cull_log_uniform(cull_random* r, double lo, double hi);
uint32_t cull_below(cull_random* r, uint32_t end);
hdrp_v3 cull_direction(cull_random* r);

/* >>shapes */

typedef enum cull_type {
    CULL_DIRECTIONAL,
    CULL_POINT,
    CULL_SPOT,
    CULL_SPOT_WIDE, /* more than half a sphere */
    CULL_PYRAMID,
    CULL_BOX,
    CULL_SPHERE,
    CULL_DISC,
    CULL_RECTANGLE,
    CULL_LINE,
    CULL_PROBE,
    CULL_PROBE_BOX, /* and decals */
    CULL_TYPES
} cull_type;

const char* cull_type_string(cull_type type);

/* All that is known of a shape, in the world. */
typedef struct cull_item {
    cull_type type;
    const hdrp_light* light; /* NULL, or all that follows does not count */
    hdrp_v3 position, forward, up;
    float range;                      /* radius of a probe; scale of a probe's box */
    float half_x, half_y, half_z;     /* or the radius of a sphere or disc in x */
    float half_angle_x, half_angle_y; /* rad */
    float importance;
} cull_item;

/* Of probes: a point light. */
hdrp_light cull_light_of_item(const cull_item* item);
hdrp_cull_shape cull_shape_of_item(const cull_item* item);
ref_body cull_body_of_item(const cull_item* item, const hdrp_cull_camera* camera);
/* A light of the record's area types, for which hdrp_light.h has no makers. */
hdrp_light cull_area_light(uint32_t type, hdrp_v3 position, hdrp_v3 forward, hdrp_v3 up,
                           float range, float half_x, float half_y, float radius);
void cull_print_item(FILE* file, const cull_item* item);

/* >>scenes */

typedef struct cull_test_scene {
    hdrp_cull_camera camera;
    hdrp_cull_desc desc;
    cull_item* items;
    uint32_t count, capacity;
    float* texels; /* metres or device depth; NULL: none */
    const hdrp_depth_params* device;
    hdrp_depth_params device_params;
    /* made by cull_scene_run */
    hdrp_cull_shape* shapes;
    ref_body* bodies;
    hdrp_cull_set set;
    hdrp_cull_lists lists;
    uint32_t* listed; /* bits: `stride` words of each cell */
    uint32_t stride;
    void *set_memory, *lists_memory, *scratch;
} cull_test_scene;

void cull_scene_init(cull_test_scene* scene, uint32_t capacity);
void cull_scene_free(cull_test_scene* scene);
/* All stages, in one piece. False, and a line, where one fails. */
bool cull_scene_run(cull_test_scene* scene);
bool cull_scene_lists(const cull_test_scene* scene, uint32_t cell, uint32_t item);
/* Whether a pixel has to visit an entry: its block and, in lists that have masks, itself. */
bool cull_scene_covers(const cull_test_scene* scene, uint32_t entry, uint32_t x, uint32_t y);
ref_cell cull_scene_tile(const cull_test_scene* scene, uint32_t tile);
/* The slices of a tile; of a tile of one slice with depth, what is seen in it. */
void cull_scene_slices(const cull_test_scene* scene, uint32_t tile, float* lo, float* hi);
/* Depth of a pixel in metres; negative for sky. */
float cull_scene_depth_of_pixel(const cull_test_scene* scene, uint32_t x, uint32_t y);
void cull_print_scene(FILE* file, const cull_test_scene* scene);

/* Memory that is aligned, and ends the program where there is none. */
void* cull_allocate(size_t bytes);

/* What a walk over all cells of a scene found. */
typedef struct cull_tally {
    uint64_t reached[CULL_TYPES]; /* pairs of a shape and a cell that truly touch */
    uint64_t listed[CULL_TYPES];
    uint64_t missed[CULL_TYPES]; /* reached and not listed */
    uint64_t asked, unknown;     /* tiles asked for; results without a certificate */
} cull_tally;

/* Compares all lists with the reference; prints each pair that is missed, up to some. */
void cull_scene_compare(const cull_test_scene* scene, uint64_t seed, cull_tally* tally);
void cull_print_tally(FILE* file, const cull_tally* tally);
uint64_t cull_total(const uint64_t counts[CULL_TYPES]);

#endif
