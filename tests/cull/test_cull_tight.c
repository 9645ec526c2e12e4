/* test_cull_tight.c - how much is listed in vain: pairs over the pairs of the exact test.
 * SPDX-License-Identifier: MIT
 *
 * In the street of lights that bench_cull measures. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "cull_harness.h"
#include "cull_scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LIGHTS 1000u

static hdrp_light lights[LIGHTS];
static cull_scene street;
static float* street_depth;

static void add_lights(cull_test_scene* s, cull_scene_mix mix)
{
    for (uint32_t i = 0; i < LIGHTS; ++i) {
        lights[i] = cull_scene_light(&street, mix, i);
        s->items[i].light = &lights[i];
        s->items[i].type =
            hdrp_light_type(lights[i]) == HDRP_LIGHT_TYPE_SPOT ? CULL_SPOT : CULL_POINT;
    }
    s->count = LIGHTS;
}

/* Lights of one other type in the same places, with sizes and angles at random. */
static void add_others(cull_test_scene* s, cull_type type)
{
    cull_random r = {(uint64_t)type};
    s->count = 300u;
    for (uint32_t i = 0; i < s->count; ++i) {
        cull_item* item = &s->items[i];
        item->type = type;
        item->position = cull_scene_light_position(&street, i);
        item->forward = cull_direction(&r);
        do {
            item->up = cull_direction(&r);
        } while (hdrp_abs(hdrp_v3_dot(item->up, item->forward)) > 0.9f);
        item->range = cull_scene_light_range(i);
        item->half_x = (float)cull_uniform(&r, 0.1, 1.5);
        item->half_y = (float)cull_uniform(&r, 0.1, 1.5);
        item->half_z = (float)cull_uniform(&r, 0.1, 1.5);
        item->half_angle_x = (float)cull_uniform(&r, 0.2, 0.7);
        item->half_angle_y = (float)cull_uniform(&r, 0.2, 0.7);
        if (type == CULL_SPOT_WIDE) {
            item->half_angle_x = (float)cull_uniform(&r, 1.6, 3.1);
        }
    }
}

typedef struct grid {
    const char* name;
    uint32_t width_px, height_px, slices, flags;
    float start_m;
    bool depth;
} grid;

static const grid grids[] = {
    {"17 x 9 x 24", 76u, 80u, 24u, HDRP_CULL_ONE_SERIES, 5.0f, false},
    {"40 x 23 x 64", 32u, 32u, 64u, HDRP_CULL_ONE_SERIES, 0.0f, false},
    {"40 x 23 x 64, by depth", 32u, 32u, 64u, 0u, 0.0f, true},
};
#define GRIDS (sizeof grids / sizeof grids[0])

static void set_grid(cull_test_scene* s, const grid* g, uint32_t flags)
{
    size_t pixels = (size_t)street.width_px * street.height_px;
    s->camera = street.camera;
    s->desc.width_px = street.width_px;
    s->desc.height_px = street.height_px;
    s->desc.tile_width_px = g->width_px;
    s->desc.tile_height_px = g->height_px;
    s->desc.slice_count = g->slices;
    s->desc.series_start_m = g->start_m;
    s->desc.flags = g->flags | flags;
    s->desc.entry_capacity = 200u * g->slices;
    if (g->depth) {
        s->texels = cull_allocate(pixels * sizeof *s->texels);
        memcpy(s->texels, street_depth, pixels * sizeof *s->texels);
    }
}

/* Pairs over exact pairs; the lists are complete. The reference takes a wide cone for missed where
 * none of 32 halves of its ball is seen to touch a cell, which makes the ratio larger. */
static double measure(cull_test_scene* s, const char* what, const char* where)
{
    cull_tally t;
    hdrp_cull_stats stats;
    double ratio;
    memset(&t, 0, sizeof t);
    assert_true(cull_scene_run(s));
    assert_int_equal(hdrp_cull_count(&s->lists, &stats), HDRP_OK);
    assert_int_equal(stats.dropped, 0);
    cull_scene_compare(s, 0u, &t);
    assert_int_equal(cull_total(t.missed), 0);
    assert_int_equal(t.unknown, 0);
    assert_true(stats.entries == cull_total(t.listed));
    ratio = (double)cull_total(t.listed) / (double)cull_total(t.reached);
    printf("%-28s %-24s %8" PRIu64 " pairs, %8" PRIu64 " exact, %.4f times\n", what, where,
           cull_total(t.listed), cull_total(t.reached), ratio);
    return ratio;
}

static double measure_mix(cull_scene_mix mix, const grid* g, uint32_t flags, const char* what)
{
    cull_test_scene s;
    double ratio;
    cull_scene_init(&s, LIGHTS);
    set_grid(&s, g, flags);
    add_lights(&s, mix);
    ratio = measure(&s, what, g->name);
    cull_scene_free(&s);
    return ratio;
}

static void points_are_listed_in_few_cells_in_vain(void** state)
{
    (void)state;
    for (size_t g = 0; g < GRIDS; ++g) {
        assert_true(measure_mix(CULL_SCENE_POINTS, &grids[g], 0u, "points") <= 1.05);
    }
}

static void spots_are_listed_in_few_cells_in_vain(void** state)
{
    (void)state;
    for (size_t g = 0; g < GRIDS; ++g) {
        assert_true(measure_mix(CULL_SCENE_HALF, &grids[g], 0u, "half of them spots") <= 1.15);
        assert_true(measure_mix(CULL_SCENE_SPOTS, &grids[g], 0u, "spots") <= 1.15);
    }
}

static void the_fast_mode_is_looser(void** state)
{
    static const double most[GRIDS][2] = {{1.60, 2.29}, {2.31, 4.43}, {2.23, 4.18}};
    (void)state;
    for (size_t g = 0; g < GRIDS; ++g) {
        assert_true(measure_mix(CULL_SCENE_POINTS, &grids[g], HDRP_CULL_FAST, "points, fast") <=
                    most[g][0]);
        assert_true(measure_mix(CULL_SCENE_SPOTS, &grids[g], HDRP_CULL_FAST, "spots, fast") <=
                    most[g][1]);
    }
}

static void other_lights_are_listed_as_tightly_as_ever(void** state)
{
    /* What was measured and a little; the coarse grid, then the fine one. */
    static const struct {
        cull_type type;
        double most[2];
    } rows[] = {
        {CULL_SPOT_WIDE, {1.100, 1.410}}, {CULL_PYRAMID, {1.100, 1.040}},
        {CULL_BOX, {1.080, 1.040}},       {CULL_SPHERE, {1.001, 1.001}},
        {CULL_DISC, {1.180, 1.220}},      {CULL_RECTANGLE, {1.120, 1.230}},
        {CULL_LINE, {1.150, 1.220}},      {CULL_PROBE, {1.001, 1.001}},
        {CULL_PROBE_BOX, {1.050, 1.020}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        for (size_t g = 0; g < 2u; ++g) {
            cull_test_scene s;
            cull_scene_init(&s, LIGHTS);
            set_grid(&s, &grids[g], 0u);
            add_others(&s, rows[i].type);
            assert_true(measure(&s, cull_type_string(rows[i].type), grids[g].name) <=
                        rows[i].most[g]);
            cull_scene_free(&s);
        }
    }
}

/* Lights that pixels visit over lights that reach them, summed over the pixels that are lit. */
static double visited(cull_scene_mix mix, uint32_t flags, const char* what)
{
    static const grid fine = {"16 x 16 px", 16u, 16u, 1u, 0u, 0.0f, true};
    cull_test_scene s;
    uint64_t visits = 0u, reached = 0u;
    cull_scene_init(&s, LIGHTS);
    set_grid(&s, &fine, flags);
    add_lights(&s, mix);
    assert_true(cull_scene_run(&s));
    for (uint32_t y = 0; y < s.desc.height_px; ++y) {
        for (uint32_t x = 0; x < s.desc.width_px; ++x) {
            hdrp_cull_grid g = s.lists.grid;
            hdrp_u32x4 cell = s.lists.cells[hdrp_cull_tile_of_pixel(g, x, y)];
            float z = cull_scene_depth_of_pixel(&s, x, y);
            ref_v3 p = ref_position_of_pixel(&s.camera, x + 0.5L, y + 0.5L, s.desc.width_px,
                                             s.desc.height_px, z);
            for (uint32_t i = hdrp_cull_first(cell, 0u); z >= 0.0f && i < hdrp_cull_last(cell, 3u);
                 ++i) {
                const ref_body* body = &s.bodies[hdrp_cull_entry_index(s.lists.entries[i])];
                visits += cull_scene_covers(&s, i, x, y) ? 1u : 0u;
                reached += ref_contains(body, p, 0.0L) ? 1u : 0u;
            }
        }
    }
    cull_scene_free(&s);
    printf("%-28s %.2f lights reach a pixel, %.4f times as many are visited\n", what,
           (double)reached / ((double)street.width_px * street.height_px),
           (double)visits / (double)reached);
    return (double)visits / (double)reached;
}

static void pixels_visit_few_lights_in_vain(void** state)
{
    /* Blocks of 4 x 4 pixels hold edges of objects, some of which a light does not reach. */
    static const struct {
        const char* what;
        uint32_t flags;
        double most[3];
    } rows[] = {{"masks", HDRP_CULL_MASKS, {1.001, 1.001, 1.001}},
                {"blocks", HDRP_CULL_BLOCKS, {1.08, 1.08, 1.15}},
                {"tiles", HDRP_CULL_PIXELS, {1.36, 1.38, 1.76}}};
    static const char* const mixes[3] = {"points", "half of them spots", "spots"};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        for (int mix = 0; mix < 3; ++mix) {
            char what[64];
            snprintf(what, sizeof what, "%s, %s", mixes[mix], rows[i].what);
            assert_true(visited((cull_scene_mix)mix, rows[i].flags, what) <= rows[i].most[mix]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_are_listed_in_few_cells_in_vain),
        cmocka_unit_test(spots_are_listed_in_few_cells_in_vain),
        cmocka_unit_test(the_fast_mode_is_looser),
        cmocka_unit_test(other_lights_are_listed_as_tightly_as_ever),
        cmocka_unit_test(pixels_visit_few_lights_in_vain),
    };
    cull_scene_make(&street, 1280u, 720u);
    street_depth = cull_allocate((size_t)street.width_px * street.height_px * sizeof *street_depth);
    cull_scene_depth(&street, street_depth);
    return cmocka_run_group_tests_name("cull_tight", tests, NULL, NULL);
}
