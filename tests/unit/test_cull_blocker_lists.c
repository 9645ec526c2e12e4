/* test_cull_blocker_lists.c - blockers in grids of lists: what leaves and what pixels have to test.
 * SPDX-License-Identifier: MIT */
#define HDRP_CULL_IMPLEMENTATION
#include "hdrp_cull.h"
#include "cull_blocker_test.h"
#include "cull_blocker_world.h"

/* Where a shape is in the list of a cell, or -1. */
static int find(const uint32_t* entries, hdrp_u32x4 cell, uint32_t shape)
{
    for (uint32_t i = hdrp_cull_first(cell, 0); i < hdrp_cull_last(cell, 3); ++i) {
        if (hdrp_cull_entry_index(entries[i]) == shape) {
            return (int)i;
        }
    }
    return -1;
}

static int compare_at(const grid* g, const world* w, float x, float y, float z)
{
    hdrp_v4 window = w->camera.window;
    float k = w->camera.forward_orthographic.w > 0.0f ? 1.0f : z;
    float u = (window.x + window.z * x / (float)BLOCKER_WIDTH) * k;
    float v = (window.y + window.w * (1.0f - y / (float)BLOCKER_HEIGHT)) * k;
    test_v3 p = test_mad(test_of(w->camera.eye_near), test_of(w->camera.right_far), (double)u);
    p = test_mad(p, test_of(w->camera.up), (double)v);
    p = test_mad(p, test_of(w->camera.forward_orthographic), (double)z);
    uint32_t tile = hdrp_cull_tile_of_pixel(g->lists.grid, (uint32_t)x, (uint32_t)y);
    uint32_t at = hdrp_cull_cell(g->lists.grid, tile,
                                 hdrp_cull_slice(g->lists.grid, g->lists.tiles[tile].z, z));
    int wrong = 0;
    for (uint32_t i = 0; i < BLOCKER_LIGHTS; ++i) {
        int before = find(g->old_entries, g->old_cells[at], i);
        int after = find(g->lists.entries, g->lists.cells[at], i);
        bool lit = test_reaches(&w->scene, i, 0xffffffffu, p);
        wrong += before < 0 && after >= 0;
        if (before >= 0) {
            wrong += lit != (after >= 0 && test_reaches(&w->scene, i, g->masks[after], p));
        }
    }
    return wrong;
}

static void lists_and_masks_decide_as_all_blockers_do(void** state)
{
    (void)state;
    static world w;
    static grid g;
    uint64_t seed = 1, removed = 0, pixel = 0, none = 0;
    for (int i = 0; i < 24; ++i) {
        hdrp_cull_desc desc = {0};
        bool with_depth = i % 3 != 0, tiles = i % 4 >= 2;
        desc.tile_width_px = tiles ? 16u : 32u;
        desc.tile_height_px = tiles ? 16u : 24u;
        desc.slice_count = tiles ? 1u : i % 2 ? 24u : 3u;
        desc.flags = i % 5 == 0 ? HDRP_CULL_ONE_SERIES : 0u;
        make_world(&w, &seed, i % 6 == 5);
        build(&g, &w, desc, with_depth);
        hdrp_cull_blocker_stats stats = apply(&g, 1);
        int wrong = 0;
        for (int q = 0; q < 6000; ++q) {
            uint32_t x = test_below(&seed, BLOCKER_WIDTH), y = test_below(&seed, BLOCKER_HEIGHT);
            float z = (float)test_log(&seed, 0.1, 90.0);
            if (with_depth && (tiles || q % 2)) {
                z = w.depth[y * BLOCKER_WIDTH + x];
            }
            wrong += compare_at(&g, &w, (float)x + 0.5f, (float)y + 0.5f, z);
        }
        assert_int_equal(wrong, 0);
        if (i < 4) {
            print_message("%llu of %llu lights left cells, %llu pairs none, %llu per pixel\n",
                          (unsigned long long)stats.lights_removed,
                          (unsigned long long)stats.lights, (unsigned long long)stats.none,
                          (unsigned long long)stats.pixel);
        }
        removed += stats.lights_removed;
        pixel += stats.pixel;
        none += stats.none;
        drop(&g);
    }
    assert_true(removed > 1000u && pixel > 1000u && none > 1000u);
}

static void what_stays_keeps_its_order_and_its_category(void** state)
{
    (void)state;
    static world w;
    static grid g;
    uint64_t seed = 2;
    hdrp_cull_desc desc = {0};
    make_world(&w, &seed, false);
    build(&g, &w, desc, true);
    hdrp_cull_blocker_stats stats = apply(&g, 3);
    uint64_t before = 0, after = 0, lights = 0;
    for (size_t c = 0; c < g.cells; ++c) {
        assert_int_equal(g.old_cells[c].x, g.lists.cells[c].x);
        assert_int_equal(g.old_cells[c].w, g.lists.cells[c].w);
        for (uint32_t category = 0; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
            uint32_t i = hdrp_cull_first(g.old_cells[c], category);
            uint32_t end = hdrp_cull_last(g.old_cells[c], category);
            before += end - i;
            for (uint32_t k = i; k < end; ++k) {
                lights += hdrp_cull_entry_index(g.old_entries[k]) < BLOCKER_LIGHTS;
            }
            for (uint32_t k = hdrp_cull_first(g.lists.cells[c], category);
                 k < hdrp_cull_last(g.lists.cells[c], category); ++k, ++i, ++after) {
                while (i < end && g.old_entries[i] != g.lists.entries[k]) {
                    assert_true(category == HDRP_CULL_CATEGORY_PUNCTUAL);
                    ++i;
                }
                assert_true(i < end);
                uint32_t shape = hdrp_cull_entry_index(g.lists.entries[k]);
                assert_true(g.masks[k] < 8u && (shape < BLOCKER_LIGHTS || g.masks[k] == 0u));
            }
        }
    }
    assert_int_equal(lights, stats.lights);
    assert_int_equal(before - after, stats.lights_removed);
    drop(&g);
}

/* All that is farther than d is behind a clip plane. */
static void cells_before_and_behind_a_clip_plane_need_no_test(void** state)
{
    (void)state;
    static world w;
    static grid g;
    uint64_t seed = 5, listed = 0;
    for (int i = 0; i < 60; ++i) {
        hdrp_cull_desc desc = {0};
        desc.slice_count = 48u;
        desc.flags = i % 2 ? HDRP_CULL_ONE_SERIES : 0u;
        make_world(&w, &seed, i % 3 == 0);
        float d = (float)test_log(&seed, 0.2, 60.0);
        test_v3 ahead = test_of(w.camera.forward_orthographic);
        test_v3 p = test_mad(test_of(w.camera.eye_near), ahead, (double)d);
        w.blockers[0] = hdrp_cull_blocker_plane(
            test_float(p), test_float(test_mad(test_vec(0, 0, 0), ahead, -1.0)));
        w.links[0] = 0u;
        w.lights[0].first = 0u;
        w.lights[0].count = 1u;
        w.scene.light_count = w.scene.link_count = w.scene.blocker_count = 1u;
        build(&g, &w, desc, i % 2 == 0);
        apply(&g, 1);
        for (size_t at = 0; at < g.cells; ++at) {
            float scale = g.lists.tiles[at / 48u].z;
            uint32_t k = (uint32_t)(at % 48u);
            int after = find(g.lists.entries, g.lists.cells[at], 0u);
            if (find(g.old_entries, g.old_cells[at], 0u) < 0) {
                assert_true(after < 0); /* beyond the far distance */
                continue;
            }
            ++listed;
            if (k < hdrp_cull_slice(g.lists.grid, scale, d * (1.0f - 1e-4f))) {
                assert_true(after >= 0 && g.masks[after] == 0u);
            } else if (k > hdrp_cull_slice(g.lists.grid, scale, d * (1.0f + 1e-4f))) {
                assert_true(after < 0);
            } else if (k == hdrp_cull_slice(g.lists.grid, scale, d)) {
                assert_true(after >= 0 && g.masks[after] == 1u);
            }
        }
        drop(&g);
    }
    assert_true(listed > 10000u);
}

static void any_split_into_jobs_gives_the_same_bits(void** state)
{
    (void)state;
    static world w;
    static grid g[4];
    const uint32_t jobs[4] = {1, 2, 7, 28};
    for (int i = 0; i < 4; ++i) {
        uint64_t seed = 3;
        hdrp_cull_desc desc = {0};
        make_world(&w, &seed, false);
        build(&g[i], &w, desc, true);
        hdrp_cull_blocker_stats stats = apply(&g[i], jobs[i]);
        assert_true(stats.lights_removed > 0u);
        assert_memory_equal(g[0].lists.cells, g[i].lists.cells, g[0].cells * sizeof(hdrp_u32x4));
        for (size_t c = 0; c < g[0].cells; ++c) {
            hdrp_u32x4 cell = g[0].lists.cells[c];
            size_t bytes = (hdrp_cull_last(cell, 3) - cell.x) * sizeof(uint32_t);
            assert_memory_equal(g[0].masks + cell.x, g[i].masks + cell.x, bytes);
            assert_memory_equal(g[0].lists.entries + cell.x, g[i].lists.entries + cell.x, bytes);
        }
    }
    for (int i = 0; i < 4; ++i) {
        drop(&g[i]);
    }
}

static void bad_arguments_leave_lists_alone(void** state)
{
    (void)state;
    static world w;
    static grid g;
    uint64_t seed = 4;
    hdrp_cull_desc desc = {0};
    hdrp_cull_blocker_job job;
    make_world(&w, &seed, false);
    build(&g, &w, desc, false);
    uint32_t tiles = g.lists.grid.tiles.z * g.lists.grid.tiles.w;
    size_t bytes = hdrp_cull_blocker_scratch_size(&g.blockers);
    void* scratch = block(bytes);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, &g.blockers, scratch, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_apply_blockers(NULL, &job, 0, tiles, g.masks),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_apply_blockers(&g.lists, NULL, 0, tiles, g.masks),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_apply_blockers(&g.lists, &job, 0, tiles, NULL),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_apply_blockers(&g.lists, &job, 1, tiles, g.masks),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_apply_blockers(&g.lists, &job, tiles, 0, NULL), HDRP_OK);
    g.lists.camera.eye_near.x += 1.0f;
    assert_int_equal(hdrp_cull_apply_blockers(&g.lists, &job, 0, tiles, g.masks),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_memory_equal(g.old_cells, g.lists.cells, g.cells * sizeof *g.old_cells);
    assert_memory_equal(g.old_entries, g.lists.entries, g.entries * sizeof *g.old_entries);
    free(scratch);
    drop(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_and_masks_decide_as_all_blockers_do),
        cmocka_unit_test(what_stays_keeps_its_order_and_its_category),
        cmocka_unit_test(cells_before_and_behind_a_clip_plane_need_no_test),
        cmocka_unit_test(any_split_into_jobs_gives_the_same_bits),
        cmocka_unit_test(bad_arguments_leave_lists_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
