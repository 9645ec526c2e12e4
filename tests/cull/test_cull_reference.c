/* test_cull_reference.c - the reference of the tests of culling, tested itself.
 * SPDX-License-Identifier: MIT
 *
 * Its answers are compared with positions that are drawn without it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "cull_generate.h"

#include <math.h>

static void random_scene(cull_test_scene* s, uint64_t seed)
{
    cull_recipe touching = {(cull_view)(seed % CULL_VIEWS), false, true, 10u, 8u, 24u};
    cull_random_scene(s, seed, &touching);
}

static ref_v3 place(ref_real x, ref_real y, ref_real z)
{
    ref_v3 r = {x, y, z};
    return r;
}

static ref_v3 towards(ref_v3 p, ref_v3 d, ref_real s)
{
    return place(p.x + d.x * s, p.y + d.y * s, p.z + d.z * s);
}

static ref_real dot(ref_v3 a, ref_v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static ref_v3 direction(cull_random* r)
{
    hdrp_v3 d = cull_direction(r);
    return place(d.x, d.y, d.z);
}

/* A position of a body, by its definition alone: drawn around it until it is inside. Narrow cones
 * are drawn by angle. False where it takes too long. */
static bool draw_inside(cull_random* r, const ref_body* b, ref_v3* p)
{
    bool narrow = b->kind == REF_CONE || b->kind == REF_PYRAMID;
    ref_real limit_x = narrow ? atan2l(b->sin_x, b->cos_x) : 0.0L;
    ref_real limit_y = b->kind == REF_PYRAMID ? atan2l(b->sin_y, b->cos_y) : limit_x;
    for (int i = 0; i < 100; ++i) {
        ref_real x = (ref_real)cull_uniform(r, -1.0, 1.0), y = (ref_real)cull_uniform(r, -1.0, 1.0);
        ref_real z = (ref_real)cull_uniform(r, -1.0, 1.0);
        ref_real size = b->range;
        if (narrow) {
            size *= cbrtl(fabsl(z));
            x = tanl(x * fminl(limit_x, 1.57L)) * size;
            y = tanl(y * fminl(limit_y, 1.57L)) * size;
            z = size;
        } else {
            x *= b->half.x + size;
            y *= (b->kind == REF_FRONT_DISC ? b->half.x : b->half.y) + size;
            z *= b->half.z + size;
        }
        *p = towards(towards(towards(b->center, b->right, x), b->up, y), b->forward, z);
        if (ref_contains(b, *p, 0.0L)) {
            return true;
        }
    }
    return false;
}

static void no_position_of_a_body_is_beyond_its_support(void** state)
{
    cull_random r = {11u};
    int drawn = 0;
    (void)state;
    for (int i = 0; i < 4000; ++i) {
        hdrp_cull_camera camera = cull_random_camera(&r, (cull_view)cull_below(&r, CULL_VIEWS));
        cull_type type = (cull_type)(1u + cull_below(&r, CULL_TYPES - 1u));
        cull_item item = cull_random_item(&r, &camera, type);
        ref_body b = cull_body_of_item(&item, &camera);
        ref_v3 p;
        if (type == CULL_SPOT_WIDE) {
            continue; /* not convex */
        }
        for (int k = 0; k < 20 && draw_inside(&r, &b, &p); ++k) {
            ref_v3 d = k == 0 ? b.forward : direction(&r);
            ref_v3 s = ref_support(&b, d);
            ref_real size = b.range + sqrtl(dot(b.center, b.center)) + b.half.x + b.half.y;
            assert_true(dot(p, d) <= dot(s, d) + 1e-15L * size);
            assert_true(ref_contains(&b, s, 1e-15L * size));
            ++drawn;
        }
    }
    assert_true(drawn > 60000);
}

static void witnesses_are_in_both(void** state)
{
    int found = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 60u; ++seed) {
        cull_test_scene s;
        cull_random r = {seed};
        random_scene(&s, seed);
        assert_true(cull_scene_run(&s));
        for (int i = 0; i < 2000; ++i) {
            float lo[HDRP_CULL_SLICES_MAX], hi[HDRP_CULL_SLICES_MAX];
            uint32_t item = cull_below(&r, s.count), k = cull_below(&r, s.lists.grid.cells.x);
            uint32_t tile = cull_below(&r, s.lists.grid.tiles.z * s.lists.grid.tiles.w);
            ref_cell cell = cull_scene_tile(&s, tile);
            ref_v3 p;
            if (i % 50 == 0) {
                cull_scene_slices(&s, tile, lo, hi);
            }
            cell.z0 = lo[k];
            cell.z1 = hi[k];
            if (ref_intersect(&s.bodies[item], &cell, &p) == REF_INTERSECTS) {
                ref_real tolerance = 3.0L * REF_TOLERANCE * sqrtl(dot(p, p));
                assert_true(ref_contains(&s.bodies[item], p, tolerance));
                assert_true(ref_cell_contains(&cell, p, tolerance));
                ++found;
            }
        }
        cull_scene_free(&s);
    }
    assert_true(found > 3000);
}

/* Positions of bodies that happen to be in a cell prove that the two intersect. */
static void what_shares_a_position_intersects(void** state)
{
    int shared = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 100u; ++seed) {
        cull_test_scene s;
        cull_random r = {seed};
        random_scene(&s, seed);
        assert_true(cull_scene_run(&s));
        for (int i = 0; i < 3000; ++i) {
            float lo[HDRP_CULL_SLICES_MAX], hi[HDRP_CULL_SLICES_MAX];
            uint32_t item = cull_below(&r, s.count), tile, slice;
            const ref_body* b = &s.bodies[item];
            hdrp_cull_grid grid = s.lists.grid;
            ref_real spread, x, y;
            ref_cell cell;
            ref_v3 p;
            if (b->kind == REF_EVERYTHING || !draw_inside(&r, b, &p)) {
                continue;
            }
            if (s.items[item].type != CULL_SPOT_WIDE) { /* convex: somewhere in, up to the border */
                p = towards(p, ref_support(b, direction(&r)), 1.0L);
                p = place(0.5L * p.x, 0.5L * p.y, 0.5L * p.z);
            }
            spread = s.camera.forward_orthographic.w > 0.0f ? 1.0L : p.z;
            x = (p.x / spread - s.camera.window.x) * s.desc.width_px / s.camera.window.z;
            y = s.desc.height_px -
                (p.y / spread - s.camera.window.y) * s.desc.height_px / s.camera.window.w;
            if (!(p.z >= s.camera.eye_near.w && p.z <= s.camera.right_far.w && x >= 0.0L &&
                  y >= 0.0L && x < s.desc.width_px && y < s.desc.height_px)) {
                continue;
            }
            tile = hdrp_cull_tile_of_pixel(grid, (uint32_t)x, (uint32_t)y);
            slice = hdrp_cull_slice(grid, s.lists.tiles[tile].z, (float)p.z);
            ref_slices(grid, s.lists.tiles[tile].z, s.camera.eye_near.w, s.camera.right_far.w, lo,
                       hi);
            cell = cull_scene_tile(&s, tile);
            cell.z0 = lo[slice];
            cell.z1 = hi[slice];
            if (ref_cell_contains(&cell, p, -1e-12L * fabsl(p.z))) {
                assert_int_equal(ref_intersect(b, &cell, NULL), REF_INTERSECTS);
                ++shared;
            }
        }
        cull_scene_free(&s);
    }
    assert_true(shared > 10000);
}

/* In an orthographic view a cell is a box, whose distance to a position is known. */
static void a_ball_touches_a_box_at_its_distance(void** state)
{
    cull_random r = {5u};
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        ref_cell c = {-1, 2, 3, 5, 7, 11, true};
        ref_v3 p =
            place((ref_real)cull_uniform(&r, -20.0, 20.0), (ref_real)cull_uniform(&r, -20.0, 20.0),
                  (ref_real)cull_uniform(&r, -20.0, 30.0));
        ref_real x = fmaxl(fmaxl(c.u0 - p.x, p.x - c.u1), 0.0L);
        ref_real y = fmaxl(fmaxl(c.v0 - p.y, p.y - c.v1), 0.0L);
        ref_real z = fmaxl(fmaxl(c.z0 - p.z, p.z - c.z1), 0.0L);
        ref_real distance = sqrtl(x * x + y * y + z * z);
        ref_body b = {0};
        b.kind = REF_ROUND_BOX;
        b.center = p;
        b.right = place(1, 0, 0);
        b.up = place(0, 1, 0);
        b.forward = place(0, 0, 1);
        b.range = distance * (1.0L + 1e-12L) + 1e-15L;
        assert_int_equal(ref_intersect(&b, &c, NULL), REF_INTERSECTS);
        b.range = distance - 1e-7L;
        if (b.range > 0.0L) {
            assert_int_equal(ref_intersect(&b, &c, NULL), REF_DISJOINT);
        }
    }
}

static void slices_are_what_the_formula_says(void** state)
{
    cull_random r = {6u};
    (void)state;
    for (int i = 0; i < 50; ++i) {
        float near_m = (float)cull_log_uniform(&r, 1e-3, 10.0);
        float far_m = near_m * (float)cull_log_uniform(&r, 1.5, 1e6);
        float lo[HDRP_CULL_SLICES_MAX], hi[HDRP_CULL_SLICES_MAX];
        hdrp_cull_camera c = cull_random_camera(&r, (cull_view)cull_below(&r, CULL_VIEWS));
        hdrp_cull_grid g = hdrp_cull_grid_make(
            c, hdrp_u32x4_make(64u, 64u, 1u + cull_below(&r, HDRP_CULL_SLICES_MAX), 1u),
            hdrp_u32x4_make(32u, 32u, 0u, 0u), near_m, far_m);
        ref_slices(g, g.series.w, near_m, far_m, lo, hi);
        assert_true(lo[0] == near_m && hi[g.cells.x - 1u] == far_m);
        for (int k = 0; k < 2000; ++k) {
            float z = (float)cull_log_uniform(&r, (double)near_m, (double)far_m);
            uint32_t slice;
            z = hdrp_clamp(z, near_m, far_m);
            slice = hdrp_cull_slice(g, g.series.w, z);
            assert_true(lo[slice] <= z && z <= hi[slice]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_position_of_a_body_is_beyond_its_support),
        cmocka_unit_test(witnesses_are_in_both),
        cmocka_unit_test(what_shares_a_position_intersects),
        cmocka_unit_test(a_ball_touches_a_box_at_its_distance),
        cmocka_unit_test(slices_are_what_the_formula_says),
    };
    return cmocka_run_group_tests_name("cull_reference", tests, NULL, NULL);
}
