/* Which lights reach what is seen: lists by tiles for opaque surfaces, by clusters for others. */
#ifndef RD_LISTS_H
#define RD_LISTS_H

#include "hdrp_cull.h"
#include "lighting.h"

/* A grid of lists, its memory, and what the last build made of it. */
typedef struct rd_grid {
    hdrp_cull_lists lists;
    uint32_t* masks; /* of each entry: the blockers to be tested; NULL: all */
    void* memory;
    void* scratch; /* a part for each thread */
    size_t scratch_bytes;
    hdrp_cull_stats counts;
} rd_grid;

typedef struct rd_lists {
    bool ready;        /* for this sub-frame; else all surfaces visit all lights */
    uint32_t count;    /* of lights */
    uint32_t left_out; /* lights beyond what lists can name: then there are none */
    uint32_t threads;
    hdrp_cull_shape* shapes; /* of the lights, in the world */
    hdrp_cull_set set;
    void* set_memory;
    const hdrp_cull_blocker_scene* scene; /* NULL: nothing is blocked */
    hdrp_cull_blocker_set blockers;
    void* blocker_memory;
    void* blocker_scratch; /* a part for each thread */
    hdrp_cull_blocker_stats blocked;
    float* depth;           /* [m] of opaque surfaces; infinite: the sky */
    rd_grid tiles;          /* of 16 x 16 pixels, pruned by the pixels that are seen */
    rd_grid clusters;       /* 64 behind tiles of 32 x 32 */
    uint64_t dropped, full; /* lights, and tiles that dropped some, of all builds */
} rd_lists;

/* `blocked`: their blockers count. `size_m` is that of the scene. False: out of memory. */
bool rd_lists_begin(rd_lists* l, const rd_lights* lights, bool blocked, int width, int height,
                    float size_m);
void rd_lists_end(rd_lists* l);

/* Tells a point which entries are its own: those of a pixel's tile, or of its cluster there. */
void rd_lists_find_tile(const rd_lists* l, int x, int y, rd_shade_point* p);
void rd_lists_find_cluster(const rd_lists* l, int x, int y, rd_shade_point* p);

#endif
