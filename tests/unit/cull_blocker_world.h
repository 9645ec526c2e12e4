/* cull_blocker_world.h - a scene of lights and blockers, and its lists before and after them.
 * SPDX-License-Identifier: MIT */
#ifndef CULL_BLOCKER_WORLD_H
#define CULL_BLOCKER_WORLD_H

#include "cull_blocker_test.h"
#include "hdrp_cull.h"

#define BLOCKER_WIDTH  200u
#define BLOCKER_HEIGHT 120u
#define BLOCKER_SHAPES 40u
#define BLOCKER_LIGHTS 30u /* the rest are decals and probes */
#define BLOCKER_LINKS  120u
#define BLOCKER_WALLS  90u

typedef struct world {
    hdrp_cull_camera camera;
    hdrp_cull_shape shapes[BLOCKER_SHAPES];
    hdrp_v4 places[BLOCKER_LIGHTS];
    hdrp_cull_blocker_links lights[BLOCKER_LIGHTS];
    uint32_t links[BLOCKER_LINKS];
    hdrp_cull_blocker blockers[BLOCKER_WALLS];
    hdrp_cull_blocker_scene scene;
    float depth[BLOCKER_WIDTH * BLOCKER_HEIGHT];
} world;

static inline hdrp_v3 in_box(uint64_t* seed, double size)
{
    return test_float(test_vec(test_between(seed, -size, size), test_between(seed, -size, size),
                               test_between(seed, -size, size)));
}

static inline void make_world(world* w, uint64_t* seed, bool orthographic)
{
    memset(w, 0, sizeof *w);
    hdrp_v3 eye = hdrp_v3_make(0.0f, 1.0f, 25.0f), ahead = hdrp_v3_make(0.1f, 0.0f, -1.0f);
    hdrp_v3 up = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    w->camera = orthographic ? hdrp_cull_camera_orthographic(eye, ahead, up, -15.0f, 15.0f, -9.0f,
                                                             9.0f, 0.1f, 100.0f)
                             : hdrp_cull_camera_perspective(eye, ahead, up, -0.8f, 0.8f, -0.5f,
                                                            0.5f, 0.1f, HDRP_CULL_FAR_INFINITE);
    for (uint32_t i = 0; i < BLOCKER_SHAPES; ++i) {
        hdrp_v3 p = in_box(seed, 12.0), one = hdrp_v3_splat(1.0f);
        hdrp_light light = hdrp_light_point(p, one, (float)test_between(seed, 3.0, 15.0));
        if (i % 5u == 0u) {
            light = hdrp_light_directional(test_float(test_direction(seed)), one, 0.0f);
        }
        if (i < BLOCKER_LIGHTS) {
            w->shapes[i] = hdrp_cull_shape_from_light(light);
            w->places[i] = hdrp_cull_light_place(light);
            if (i % 7u == 6u) { /* lights of one room share its walls */
                w->lights[i] = w->lights[i - 1u];
                continue;
            }
            w->lights[i].first = w->scene.link_count;
            w->lights[i].count = test_below(seed, 4);
            w->scene.link_count += w->lights[i].count;
        } else {
            w->shapes[i] = hdrp_cull_shape_sphere(
                p, 5.0f, i % 2u ? HDRP_CULL_CATEGORY_ENVIRONMENT : HDRP_CULL_CATEGORY_DECAL);
        }
    }
    uint32_t walls = 40, next = walls;
    for (uint32_t i = 0; i < walls; ++i) {
        w->blockers[i] = hdrp_cull_blocker_rectangle(
            in_box(seed, 10.0), test_float(test_direction(seed)), up,
            (float)test_log(seed, 0.5, 15.0), (float)test_log(seed, 0.5, 15.0));
        if (i % 8u == 0u) {
            w->blockers[i] =
                hdrp_cull_blocker_plane(in_box(seed, 10.0), test_float(test_direction(seed)));
        }
        if (i % 3u == 0u) {
            w->blockers[i] = hdrp_cull_blocker_with_portals(w->blockers[i], next, 1u + i % 2u);
            for (uint32_t k = 0; k < 1u + i % 2u; ++k) {
                w->blockers[next++] = hdrp_cull_blocker_rectangle(
                    hdrp_v3_from_v4(w->blockers[i].center), hdrp_v3_from_v4(w->blockers[i].front),
                    up, 1.0f + (float)k, 1.0f);
            }
        }
    }
    for (uint32_t i = 0; i < w->scene.link_count; ++i) {
        w->links[i] = test_below(seed, walls);
    }
    w->scene.places = w->places;
    w->scene.lights = w->lights;
    w->scene.links = w->links;
    w->scene.blockers = w->blockers;
    w->scene.light_count = BLOCKER_LIGHTS;
    w->scene.blocker_count = next;
    for (uint32_t i = 0; i < BLOCKER_WIDTH * BLOCKER_HEIGHT; ++i) {
        uint32_t x = i % BLOCKER_WIDTH, y = i / BLOCKER_WIDTH;
        w->depth[i] = 12.0f + 20.0f * (float)((x / 23u * 7u + y / 31u * 5u) % 11u) / 10.0f +
                      0.02f * (float)(x % 23u);
    }
}

/* Lists, before and after blockers. */
typedef struct grid {
    hdrp_cull_lists lists;
    hdrp_cull_set set;
    hdrp_cull_blocker_set blockers;
    uint32_t* masks;
    hdrp_u32x4* old_cells;
    uint32_t* old_entries;
    size_t cells, entries;
    void* blocks[4];
} grid;

static inline void* block(size_t bytes)
{
    void* p = aligned_alloc(HDRP_MEMORY_ALIGNMENT, HDRP_MEMORY_ROUND_UP(bytes));
    assert_non_null(p);
    memset(p, 0xcd, bytes);
    return p;
}

static inline void build(grid* g, const world* w, hdrp_cull_desc desc, bool with_depth)
{
    hdrp_cull_depth depth = {w->depth, BLOCKER_WIDTH, NULL};
    hdrp_cull_blocker_desc limits = {BLOCKER_LIGHTS, BLOCKER_LINKS, BLOCKER_WALLS};
    desc.width_px = BLOCKER_WIDTH;
    desc.height_px = BLOCKER_HEIGHT;
    size_t bytes = hdrp_cull_set_memory_size(BLOCKER_SHAPES);
    g->blocks[0] = block(bytes);
    assert_int_equal(hdrp_cull_set_init(&g->set, BLOCKER_SHAPES, g->blocks[0], bytes), HDRP_OK);
    bytes = hdrp_cull_memory_size(&desc);
    g->blocks[1] = block(bytes);
    assert_int_equal(hdrp_cull_init(&g->lists, &desc, g->blocks[1], bytes), HDRP_OK);
    bytes = hdrp_cull_blocker_memory_size(&limits);
    g->blocks[2] = block(bytes);
    assert_int_equal(hdrp_cull_blocker_init(&g->blockers, &limits, g->blocks[2], bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_blocker_begin(&g->blockers, &w->scene, &w->camera), HDRP_OK);
    assert_int_equal(
        hdrp_cull_blocker_project(&g->blockers, 0, w->scene.light_count + w->scene.blocker_count),
        HDRP_OK);
    assert_int_equal(
        hdrp_cull_set_begin(&g->set, &w->camera, BLOCKER_WIDTH, BLOCKER_HEIGHT, BLOCKER_SHAPES),
        HDRP_OK);
    assert_int_equal(hdrp_cull_set_project(&g->set, w->shapes, 0, BLOCKER_SHAPES), HDRP_OK);
    assert_int_equal(hdrp_cull_begin(&g->lists, &g->set), HDRP_OK);
    if (with_depth) {
        assert_int_equal(hdrp_cull_measure_depth(&g->lists, &depth, 0, g->lists.grid.tiles.w),
                         HDRP_OK);
    }
    bytes = hdrp_cull_scratch_size(&g->lists.desc);
    g->blocks[3] = block(bytes);
    assert_int_equal(hdrp_cull_build(&g->lists, &g->set, &depth, 0, hdrp_cull_rows(&g->lists),
                                     g->blocks[3], bytes),
                     HDRP_OK);
    size_t tiles = (size_t)g->lists.grid.tiles.z * g->lists.grid.tiles.w;
    g->cells = tiles * g->lists.desc.slice_count;
    g->entries = tiles * g->lists.desc.entry_capacity;
    g->old_cells = block(g->cells * sizeof *g->old_cells);
    g->old_entries = block(g->entries * sizeof *g->old_entries);
    g->masks = block(g->entries * sizeof *g->masks);
    memcpy(g->old_cells, g->lists.cells, g->cells * sizeof *g->old_cells);
    memcpy(g->old_entries, g->lists.entries, g->entries * sizeof *g->old_entries);
}

static inline void drop(grid* g)
{
    for (int i = 0; i < 4; ++i) {
        free(g->blocks[i]);
    }
    free(g->old_cells);
    free(g->old_entries);
    free(g->masks);
}

/* Applies blockers in a number of jobs, the last range first. */
static inline hdrp_cull_blocker_stats apply(grid* g, uint32_t jobs)
{
    hdrp_cull_blocker_stats sum = {0};
    uint32_t tiles = g->lists.grid.tiles.z * g->lists.grid.tiles.w;
    size_t bytes = hdrp_cull_blocker_scratch_size(&g->blockers);
    void* scratch = block(bytes);
    for (uint32_t j = jobs; j-- > 0u;) {
        hdrp_cull_blocker_job job;
        uint32_t first = tiles * j / jobs, end = tiles * (j + 1u) / jobs;
        assert_int_equal(hdrp_cull_blocker_job_begin(&job, &g->blockers, scratch, bytes), HDRP_OK);
        assert_int_equal(hdrp_cull_apply_blockers(&g->lists, &job, first, end - first, g->masks),
                         HDRP_OK);
        sum.lights += job.stats.lights;
        sum.lights_removed += job.stats.lights_removed;
        sum.pixel += job.stats.pixel;
        sum.none += job.stats.none;
        sum.whole += job.stats.whole;
        sum.shadows += job.stats.shadows;
    }
    free(scratch);
    return sum;
}

#endif /* CULL_BLOCKER_WORLD_H */
