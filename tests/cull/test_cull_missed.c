/* test_cull_missed.c - what a light reaches is in the lists, whatever the light and the camera.
 * SPDX-License-Identifier: MIT
 *
 * Lists are built for whole pictures and compared with cull_reference.h, cell by cell around the
 * outline of each light. "--long" takes many millions of pairs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "cull_generate.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static uint32_t effort = 1u; /* times as many scenes */

static void run_and_compare(cull_test_scene* s, uint64_t seed, cull_tally* tally)
{
    hdrp_cull_stats stats;
    assert_true(cull_scene_run(s));
    assert_int_equal(hdrp_cull_count(&s->lists, &stats), HDRP_OK);
    assert_int_equal(stats.dropped, 0);
    cull_scene_compare(s, seed, tally);
}

/* Scenes with each kind of camera; returns how many pairs were missed. */
static uint64_t sweep(const char* what, uint64_t first_seed, uint32_t scenes, cull_recipe how)
{
    uint64_t missed = 0u;
    for (int view = 0; view < CULL_VIEWS; ++view) {
        cull_tally tally;
        memset(&tally, 0, sizeof tally);
        how.view = (cull_view)view;
        for (uint64_t i = 0; i < scenes; ++i) {
            uint64_t seed = (first_seed + i) * CULL_VIEWS + (uint64_t)view;
            cull_test_scene s;
            cull_random_scene(&s, seed, &how);
            run_and_compare(&s, seed, &tally);
            cull_scene_free(&s);
        }
        printf("%s, %s: %u scenes\n", what, cull_view_string(how.view), scenes);
        cull_print_tally(stdout, &tally);
        assert_true(tally.unknown * 2000u <= tally.asked);
        missed += cull_total(tally.missed);
    }
    return missed;
}

static void random_lights_are_listed_wherever_they_reach(void** state)
{
    const cull_recipe how = {CULL_VIEW_CENTRED, true, false, 10u, 8u, 24u};
    (void)state;
    assert_int_equal(sweep("random lights", 1000000u, 75u * effort, how), 0);
}

static void lights_that_just_touch_a_cell_are_listed_in_it(void** state)
{
    const cull_recipe how = {CULL_VIEW_CENTRED, true, true, 10u, 8u, 24u};
    (void)state;
    assert_int_equal(sweep("touching lights", 2000000u, 100u * effort, how), 0);
}

static void lights_that_just_touch_a_cell_are_listed_in_the_tightest_mode(void** state)
{
    const cull_recipe how = {CULL_VIEW_CENTRED, false, true, 14u, 10u, 24u};
    (void)state;
    assert_int_equal(sweep("touching lights, tight", 3000000u, 75u * effort, how), 0);
}

/* >>extremes */

/* Runs a picture of some size and grid with random lights in front of every kind of camera. */
static void check_grid(uint64_t seed, hdrp_u32x4 picture, hdrp_u32x4 tile, uint32_t count,
                       bool touching)
{
    cull_tally tally;
    memset(&tally, 0, sizeof tally);
    for (int i = 0; i < 2 * CULL_VIEWS; ++i) {
        cull_recipe how = {(cull_view)(i / 2), false, touching, 2u, 2u, count > 0u ? count : 1u};
        cull_test_scene s;
        cull_random_scene(&s, seed + (uint64_t)i, &how);
        free(s.texels);
        s.texels = NULL;
        s.count = count;
        s.desc.width_px = picture.x;
        s.desc.height_px = picture.y;
        s.desc.slice_count = picture.z;
        s.desc.tile_width_px = tile.x;
        s.desc.tile_height_px = tile.y;
        s.desc.shape_capacity = s.capacity;
        s.desc.entry_capacity = picture.w * picture.z;
        s.desc.flags = i % 2 == 0 ? 0u : HDRP_CULL_FAST;
        run_and_compare(&s, seed + (uint64_t)i, &tally);
        if (count == 0u) {
            hdrp_cull_stats stats;
            hdrp_cull_count(&s.lists, &stats);
            assert_true(stats.entries == 0u && stats.longest == 0u);
        }
        cull_scene_free(&s);
    }
    printf("%u x %u, %u slices, tiles of %u x %u, %u lights\n", picture.x, picture.y, picture.z,
           tile.x, tile.y, count);
    cull_print_tally(stdout, &tally);
    assert_int_equal(cull_total(tally.missed), 0);
}

static void pictures_and_tiles_may_have_any_size(void** state)
{
    (void)state;
    check_grid(11u, hdrp_u32x4_make(1u, 1u, 1u, 64u), hdrp_u32x4_make(1u, 1u, 0u, 0u), 64u, false);
    check_grid(12u, hdrp_u32x4_make(1u, 1u, 64u, 64u), hdrp_u32x4_make(32u, 32u, 0u, 0u), 64u,
               false);
    check_grid(13u, hdrp_u32x4_make(17u, 13u, 64u, 64u), hdrp_u32x4_make(1u, 1u, 0u, 0u), 64u,
               false);
    check_grid(14u, hdrp_u32x4_make(333u, 217u, 24u, 64u), hdrp_u32x4_make(32u, 48u, 0u, 0u), 64u,
               false);
    check_grid(15u, hdrp_u32x4_make(8192u, 8192u, 16u, 32u), hdrp_u32x4_make(256u, 256u, 0u, 0u),
               32u, false);
    check_grid(16u, hdrp_u32x4_make(16384u, 3u, 1u, 32u), hdrp_u32x4_make(100u, 2u, 0u, 0u), 32u,
               false);
}

static void there_may_be_no_lights_or_ten_thousand(void** state)
{
    (void)state;
    check_grid(21u, hdrp_u32x4_make(64u, 64u, 64u, 1u), hdrp_u32x4_make(16u, 16u, 0u, 0u), 0u,
               false);
    check_grid(22u, hdrp_u32x4_make(64u, 48u, 16u, 10000u), hdrp_u32x4_make(16u, 16u, 0u, 0u),
               10000u, false);
}

/* Balls whose distance to a cell is exactly their radius, in numbers that floats hold: 2 3 6 make
 * 7, 1 4 8 make 9. Cells are boxes with edges of 4 m and whole coordinates. */
static void a_sphere_that_touches_a_corner_in_exact_numbers_is_listed(void** state)
{
    static const float steps[4][4] = {{2.0f, 3.0f, 6.0f, 7.0f},
                                      {4.0f, 8.0f, 1.0f, 9.0f},
                                      {3.0f, 4.0f, 0.0f, 5.0f},
                                      {0.0f, 0.0f, 3.0f, 3.0f}};
    (void)state;
    for (int k = 0; k < 4 * 8; ++k) {
        const float* step = steps[k / 8];
        float x = (k & 1) != 0 ? step[0] : -step[0], y = (k & 2) != 0 ? step[1] : -step[1];
        float z = (k & 4) != 0 ? step[2] : -step[2];
        cull_tally tally;
        cull_test_scene s;
        uint32_t tile;
        memset(&tally, 0, sizeof tally);
        cull_scene_init(&s, 1u);
        s.camera = hdrp_cull_camera_orthographic(hdrp_v3_splat(0.0f), hdrp_v3_make(0, 0, -1),
                                                 hdrp_v3_make(0, 1, 0), -16.0f, 16.0f, -16.0f,
                                                 16.0f, 1.0f, 256.0f);
        s.desc.width_px = s.desc.height_px = 128u;
        s.desc.tile_width_px = s.desc.tile_height_px = 16u;
        s.desc.slice_count = 8u; /* powers of 2 */
        s.desc.flags = HDRP_CULL_ONE_SERIES;
        s.desc.series_end_m = 256.0f;
        s.count = 1u;
        s.items[0].type = CULL_PROBE;
        s.items[0].position = hdrp_v3_make(4.0f + x, -4.0f + y, -16.0f - z);
        s.items[0].range = step[3];
        run_and_compare(&s, 0u, &tally);
        /* It touches the cell on the other side of the corner; 16 m is a depth of slice 4 only. */
        tile = (y > 0.0f ? 5u : 4u) * 8u + (x > 0.0f ? 4u : 5u);
        if (z < 0.0f) {
            assert_true(cull_scene_lists(&s, hdrp_cull_cell(s.lists.grid, tile, 4u), 0u));
        }
        assert_int_equal(cull_total(tally.missed), 0);
        cull_scene_free(&s);
    }
}

/* >>positions that are lit, as a shader finds their lists */

/* Somewhere near the surface of a body, in the world. */
static hdrp_v3 near_the_surface(cull_random* r, const cull_test_scene* s, const ref_body* b)
{
    hdrp_v3 d = cull_direction(r), e = cull_direction(r);
    ref_v3 p = ref_support(b, (ref_v3){d.x, d.y, d.z}), q = ref_support(b, (ref_v3){e.x, e.y, e.z});
    double t = cull_below(r, 2u) == 0u ? cull_uniform(r, 0.0, 1.0) : cull_log_uniform(r, 1e-8, 1.0);
    return cull_world_from_view(&s->camera, (double)(p.x + (q.x - p.x) * (ref_real)t),
                                (double)(p.y + (q.y - p.y) * (ref_real)t),
                                (double)(p.z + (q.z - p.z) * (ref_real)t));
}

/* Whether a light shines at a place, as shading computes it. */
static bool lit(const cull_item* item, const ref_body* b, const hdrp_cull_camera* camera, hdrp_v3 p)
{
    hdrp_light_incident in;
    if (item->type >= CULL_SPHERE) {
        return ref_contains(b, ref_view_from_world(camera, p), 0.0L);
    }
    in = hdrp_light_eval(cull_light_of_item(item), p);
    return in.illuminance.x > 0.0f;
}

static void what_shades_finds_its_lights(void** state)
{
    uint64_t found = 0u, missed = 0u;
    (void)state;
    for (uint64_t seed = 0; seed < 200u * effort; ++seed) {
        cull_recipe how = {(cull_view)(seed % CULL_VIEWS), true, seed % 8u < 4u, 10u, 8u, 24u};
        cull_random r = {seed};
        cull_test_scene s;
        cull_random_scene(&s, 5000000u + seed, &how);
        free(s.texels);
        s.texels = NULL;
        assert_true(cull_scene_run(&s));
        for (uint32_t i = 0; i < 500u * s.count; ++i) {
            uint32_t item = i % s.count, tile, cell;
            hdrp_cull_grid grid = s.lists.grid;
            hdrp_v3 p = near_the_surface(&r, &s, &s.bodies[item]), v;
            ref_real spread, x, y;
            if (s.bodies[item].kind == REF_EVERYTHING) {
                continue;
            }
            v = hdrp_cull_view_from_world(p, s.camera);
            spread = s.camera.forward_orthographic.w > 0.0f ? 1.0L : (ref_real)v.z;
            x = (v.x / spread - s.camera.window.x) * s.desc.width_px / s.camera.window.z;
            y = s.desc.height_px -
                (v.y / spread - s.camera.window.y) * s.desc.height_px / s.camera.window.w;
            if (!(v.z >= s.camera.eye_near.w && v.z <= s.camera.right_far.w && x >= 0.0L &&
                  y >= 0.0L && x < s.desc.width_px && y < s.desc.height_px) ||
                !lit(&s.items[item], &s.bodies[item], &s.camera, p)) {
                continue;
            }
            tile = hdrp_cull_tile_of_pixel(grid, (uint32_t)x, (uint32_t)y);
            cell = hdrp_cull_cell(grid, tile, hdrp_cull_slice(grid, s.lists.tiles[tile].z, v.z));
            ++found;
            if (!cull_scene_lists(&s, cell, item)) {
                if (++missed <= 10u) {
                    printf("missed: scene %" PRIu64 ", shape %u, position %a %a %a, cell %u\n",
                           5000000u + seed, item, (double)p.x, (double)p.y, (double)p.z, cell);
                    cull_print_item(stdout, &s.items[item]);
                    cull_print_scene(stdout, &s);
                }
            }
        }
        cull_scene_free(&s);
    }
    printf("%" PRIu64 " lit positions, %" PRIu64 " missed\n", found, missed);
    assert_true(found > 100000u);
    assert_int_equal(missed, 0);
}

/* >>fine-pruned tiles */

typedef struct pixel_tally {
    uint64_t reached, missed, uncovered;
} pixel_tally;

static void compare_pixels(const cull_test_scene* s, uint64_t seed, pixel_tally* t)
{
    hdrp_cull_grid grid = s->lists.grid;
    for (uint32_t y = 0; y < s->desc.height_px; ++y) {
        for (uint32_t x = 0; x < s->desc.width_px; ++x) {
            float z = cull_scene_depth_of_pixel(s, x, y);
            uint32_t tile = hdrp_cull_tile_of_pixel(grid, x, y);
            hdrp_u32x4 cell = s->lists.cells[tile];
            ref_v3 p = ref_position_of_pixel(&s->camera, x + 0.5L, y + 0.5L, s->desc.width_px,
                                             s->desc.height_px, z);
            for (uint32_t i = 0; z >= 0.0f && i < s->count; ++i) {
                bool covered = false;
                if (!ref_contains(&s->bodies[i], p, 0.0L)) {
                    continue;
                }
                t->reached += 1u;
                for (uint32_t e = hdrp_cull_first(cell, 0); e < hdrp_cull_last(cell, 3u); ++e) {
                    covered = covered || (hdrp_cull_entry_index(s->lists.entries[e]) == i &&
                                          cull_scene_covers(s, e, x, y));
                }
                t->missed += cull_scene_lists(s, tile, i) ? 0u : 1u;
                t->uncovered += covered ? 0u : 1u;
                if (!covered && t->uncovered <= 10u) {
                    printf("missed: scene %" PRIu64 ", shape %u, pixel %u %u, depth %a, tile %u\n",
                           seed, i, x, y, (double)z, tile);
                    cull_print_item(stdout, &s->items[i]);
                    cull_print_scene(stdout, s);
                }
            }
        }
    }
}

/* Device depth instead of metres, of either direction. Sky is what buffers are cleared to. */
static void to_device_depth(cull_test_scene* s, bool reverse)
{
    float near_m = s->camera.eye_near.w, far_m = s->camera.right_far.w;
    size_t count = (size_t)s->desc.width_px * s->desc.height_px;
    s->device_params = s->camera.forward_orthographic.w > 0.0f
                           ? hdrp_depth_params_orthographic(near_m, far_m, reverse ? 1u : 0u)
                           : hdrp_depth_params_perspective(near_m, far_m, reverse ? 1u : 0u);
    s->device = &s->device_params;
    for (size_t i = 0; i < count; ++i) {
        float sky = reverse ? 0.0f : 1.0f;
        s->texels[i] =
            s->texels[i] < far_m ? hdrp_device_depth(s->device_params, s->texels[i]) : sky;
    }
}

static void lights_that_reach_a_pixel_are_in_its_tile_and_cover_its_block(void** state)
{
    static const uint32_t flags[5] = {HDRP_CULL_PIXELS, HDRP_CULL_BLOCKS, HDRP_CULL_MASKS,
                                      HDRP_CULL_BLOCKS | HDRP_CULL_FAST,
                                      HDRP_CULL_MASKS | HDRP_CULL_FAST};
    pixel_tally tally = {0u, 0u, 0u};
    (void)state;
    for (uint64_t seed = 0; seed < 200u * effort; ++seed) {
        cull_recipe how = {(cull_view)(seed % CULL_VIEWS), false, seed % 8u < 4u, 2u, 2u, 24u};
        cull_random r = {seed};
        cull_test_scene s;
        cull_random_scene(&s, 6000000u + seed, &how);
        free(s.texels);
        s.desc.slice_count = 1u;
        s.desc.entry_capacity = s.capacity;
        s.desc.flags = flags[seed / 4u % 5u];
        s.desc.tile_width_px = s.desc.tile_height_px = 16u;
        if (seed % 3u == 0u) {
            s.desc.tile_width_px = 1u + cull_below(&r, 40u);
            s.desc.tile_height_px = 1u + cull_below(&r, 40u);
        }
        s.desc.width_px = 1u + cull_below(&r, 100u);
        s.desc.height_px = 1u + cull_below(&r, 80u);
        cull_random_depth(&r, &s);
        if (cull_below(&r, 2u) == 0u) {
            to_device_depth(&s, cull_below(&r, 2u) == 0u);
        }
        assert_true(cull_scene_run(&s));
        compare_pixels(&s, 6000000u + seed, &tally);
        cull_scene_free(&s);
    }
    printf("%" PRIu64 " pairs of a light and a pixel, %" PRIu64 " not listed, %" PRIu64
           " not covered\n",
           tally.reached, tally.missed, tally.uncovered);
    assert_true(tally.reached > 500000u);
    assert_int_equal(tally.missed + tally.uncovered, 0);
}

int main(int argc, char** argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_lights_are_listed_wherever_they_reach),
        cmocka_unit_test(lights_that_just_touch_a_cell_are_listed_in_it),
        cmocka_unit_test(lights_that_just_touch_a_cell_are_listed_in_the_tightest_mode),
        cmocka_unit_test(pictures_and_tiles_may_have_any_size),
        cmocka_unit_test(there_may_be_no_lights_or_ten_thousand),
        cmocka_unit_test(a_sphere_that_touches_a_corner_in_exact_numbers_is_listed),
        cmocka_unit_test(what_shades_finds_its_lights),
        cmocka_unit_test(lights_that_reach_a_pixel_are_in_its_tile_and_cover_its_block),
    };
    if (argc > 1 && strcmp(argv[1], "--long") == 0) {
        effort = 10u;
    }
    return cmocka_run_group_tests_name("cull_missed", tests, NULL, NULL);
}
