/* test_cull_reach.c - the formulas of hdrp_cull_tile.h against positions, in double.
 * SPDX-License-Identifier: MIT */
#include "cull_test.h"

#include "hdrp_cull_tile.h"

static hdrp_cull_interval interval(float nearest, float farthest)
{
    hdrp_cull_interval r;
    r.nearest = nearest;
    r.farthest = farthest;
    return r;
}

static void depths_are_enclosed_and_hardly_wider(void** state)
{
    hdrp_cull_interval a = hdrp_cull_interval_seen(2.0f, 4.0f), b;
    (void)state;
    assert_true(a.nearest < 2.0f && a.nearest > 1.99999f);
    assert_true(a.farthest > 4.0f && a.farthest < 4.00002f);
    b = hdrp_cull_interval_within(interval(1.0f, 9.0f), interval(2.0f, 4.0f));
    assert_true(b.nearest == a.nearest && b.farthest == a.farthest);
    b = hdrp_cull_interval_within(interval(3.0f, 3.5f), interval(2.0f, 4.0f));
    assert_true(b.nearest == 3.0f && b.farthest == 3.5f);
    b = hdrp_cull_interval_within(interval(5.0f, 6.0f), interval(2.0f, 4.0f));
    assert_true(b.nearest > b.farthest);
}

static void bounds_overlap_where_edges_touch(void** state)
{
    const hdrp_v4 rect = hdrp_v4_make(16, 32, 32, 48);
    hdrp_cull_bounds b;
    hdrp_cull_interval r;
    (void)state;
    b.nearest = 3.0f;
    b.farthest = 5.0f;
    for (int side = 0; side < 4; ++side) {
        for (int apart = 0; apart < 2; ++apart) {
            float gap = apart ? 0.001f : 0.0f;
            b.rect_px = hdrp_v4_make(20, 40, 25, 45);
            switch (side) {
            case 0:
                b.rect_px.x = 2, b.rect_px.z = 16 - gap;
                break;
            case 1:
                b.rect_px.x = 32 + gap, b.rect_px.z = 60;
                break;
            case 2:
                b.rect_px.y = 2, b.rect_px.w = 32 - gap;
                break;
            default:
                b.rect_px.y = 48 + gap, b.rect_px.w = 60;
            }
            r = hdrp_cull_bounds_in_rect(b, rect, interval(1.0f, 4.0f));
            assert_true((r.nearest <= r.farthest) == !apart);
            assert_true(apart || (r.nearest == 3.0f && r.farthest == 4.0f));
        }
    }
    b.rect_px = rect;
    r = hdrp_cull_bounds_in_rect(b, rect, interval(6.0f, 7.0f)); /* in front */
    assert_true(r.nearest > r.farthest);
}

static void coarse_cells_hold_whole_tiles_and_share_no_column(void** state)
{
    uint64_t seed = 5;
    (void)state;
    assert_int_equal(hdrp_cull_coarse_tiles(1), 64);
    assert_int_equal(hdrp_cull_coarse_tiles(16), 4);
    assert_int_equal(hdrp_cull_coarse_tiles(24), 2);
    assert_int_equal(hdrp_cull_coarse_tiles(32), 2);
    assert_int_equal(hdrp_cull_coarse_tiles(33), 2);
    assert_int_equal(hdrp_cull_coarse_tiles(16384), 2);
    assert_int_equal(hdrp_cull_coarse_tiles(0), 64);
    for (int i = 0; i < 20000; ++i) { /* what is as wide as a point is in one column only */
        float size = (float)(1 + (int)test_uniform(&seed, 0, 90)), x;
        hdrp_cull_bounds b;
        unsigned found = 0;
        x = i % 3 ? (float)test_uniform(&seed, 0, 8.0 * (double)size)
                  : size * (float)(int)test_uniform(&seed, 0, 8);
        b.rect_px = hdrp_v4_make(x, 3, x, 5);
        b.nearest = b.farthest = 1.0f;
        for (int k = 0; k < 8; ++k) {
            float left = (float)k * size;
            hdrp_u32 in = hdrp_cull_bounds_in_cell(b, hdrp_v4_make(left, 0, left + size, 9));
            assert_int_equal(in, x >= left && x < left + size);
            found += in;
        }
        assert_int_equal(found, 1);
    }
}

static void bounds_of_nothing_reach_no_cell(void** state)
{
    hdrp_cull_bounds b;
    (void)state;
    b.nearest = b.farthest = 1.0f;
    b.rect_px = hdrp_v4_make(7, 0, 6, 9);
    assert_int_equal(hdrp_cull_bounds_in_cell(b, hdrp_v4_make(0, 0, 64, 64)), 0);
    b.rect_px = hdrp_v4_make(-2, 3, -1, 9); /* left of the picture */
    assert_int_equal(hdrp_cull_bounds_in_cell(b, hdrp_v4_make(0, 0, 64, 64)), 1);
    assert_int_equal(hdrp_cull_bounds_in_cell(b, hdrp_v4_make(64, 0, 128, 64)), 0);
    b.rect_px = hdrp_v4_make(3, 64, 5, 90); /* rows share their edges */
    assert_int_equal(hdrp_cull_bounds_in_cell(b, hdrp_v4_make(0, 0, 64, 64)), 1);
    b.rect_px.y = 64.5f;
    assert_int_equal(hdrp_cull_bounds_in_cell(b, hdrp_v4_make(0, 0, 64, 64)), 0);
}

static hdrp_cull_camera random_camera(uint64_t* seed, int orthographic)
{
    hdrp_v3 eye = hdrp_v3_splat(0.0f), forward = hdrp_v3_make(0, 0, -1), up = hdrp_v3_make(0, 1, 0);
    float a[4];
    for (int i = 0; i < 4; ++i) {
        a[i] = (float)test_uniform(seed, -2, 2);
    }
    return orthographic
               ? hdrp_cull_camera_orthographic(eye, forward, up, a[0], a[1], a[2], a[3], 0.1f, 99.f)
               : hdrp_cull_camera_perspective(eye, forward, up, a[0], a[1], a[2], a[3], 0.1f, 99.f);
}

static bool is_inside(hdrp_cull_box b, hdrp_v3 p)
{
    return p.x >= b.low.x && p.x <= b.high.x && p.y >= b.low.y && p.y <= b.high.y &&
           p.z >= b.low.z && p.z <= b.high.z;
}

/* Pixels of a tile of 32 x 32 pixels of a picture of 128 x 96, all of them. */
static void boxes_enclose_the_pixels_of_their_blocks(void** state)
{
    uint64_t seed = 9;
    (void)state;
    for (int i = 0; i < 200; ++i) {
        hdrp_cull_camera camera = random_camera(&seed, i & 1);
        float flat = camera.forward_orthographic.w;
        hdrp_cull_tile tile = hdrp_cull_tile_make(camera, 64, 32, 96, 64, 128, 96);
        hdrp_v2 px = hdrp_v2_make(camera.window.z / 128, camera.window.w / 96);
        float lo = (float)test_log_uniform(&seed, 0.1, 50), hi = lo * 1.5f;
        hdrp_cull_box all = hdrp_cull_window_box(tile.window, interval(lo, hi), flat);
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x) {
                hdrp_u32 block = (hdrp_u32)(y / 8 * 4 + x / 8);
                hdrp_cull_box b = hdrp_cull_block_box(tile.window, hdrp_v2_make(px.x * 8, px.y * 8),
                                                      block, interval(lo, hi), flat);
                float z = x & 1 ? lo : hi;
                hdrp_v3 p = hdrp_cull_pixel_in_view(camera, px, (float)(64 + x) + 0.5f,
                                                    96.0f - (float)(32 + y) - 0.5f, z);
                double k = flat > 0.0f ? 1.0 : (double)z;
                double u = (double)camera.window.x + (64.5 + x) * (double)camera.window.z / 128.0;
                assert_true(fabs((double)p.x - u * k) <= 1e-5 * (fabs(u * k) + k));
                assert_true(p.z == z && is_inside(all, p) && is_inside(b, p));
            }
        }
    }
}

/* Bounds of [lo,hi] times a depth of [nearest,farthest]. */
static void scaled(double lo, double hi, double nearest, double farthest, double out[2])
{
    out[0] = fmin(lo * nearest, lo * farthest);
    out[1] = fmax(hi * nearest, hi * farthest);
}

/* The edges of a block of 8 x 8 pixels, whose place in the picture is known, against its box: each
 * side of that is outside of them, by no more than what a tile is wider than its pixels. The tile of
 * 32 x 32 pixels at (64,32) may be cut by the end of the picture, its blocks are not. */
static void boxes_are_hardly_wider_than_their_blocks(void** state)
{
    uint64_t seed = 10;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_cull_camera c = random_camera(&seed, i & 1);
        float flat = c.forward_orthographic.w;
        float width = floorf((float)test_uniform(&seed, 65, 129));
        float height = floorf((float)test_uniform(&seed, 33, 97));
        hdrp_cull_tile tile =
            hdrp_cull_tile_make(c, 64, 32, fminf(width, 96), fminf(height, 64), width, height);
        double px = (double)c.window.z / (double)width, py = (double)c.window.w / (double)height;
        hdrp_v2 size = hdrp_v2_make((float)(8.0 * px), (float)(8.0 * py));
        hdrp_u32 block = (hdrp_u32)(i / 2 % 16);
        float lo = (float)test_log_uniform(&seed, 0.1, 50), hi = lo * 1.5f;
        hdrp_cull_box b = hdrp_cull_block_box(tile.window, size, block, interval(lo, hi), flat);
        double k0 = flat > 0.0f ? 1.0 : (double)lo, k1 = flat > 0.0f ? 1.0 : (double)hi;
        double left = (double)c.window.x + (64 + block % 4 * 8) * px;
        double top = (double)c.window.y + ((double)height - 32 - block / 4 * 8) * py;
        double x_slack = 4e-6 * (fabs((double)c.window.x) + (double)c.window.z) * k1;
        double y_slack = 4e-6 * (fabs((double)c.window.y) + (double)c.window.w) * k1;
        /* The margin of a cut tile is on one side: that moves edges, but no centre, of pixels out. */
        double x_cut = width < 96.0f ? x_slack : 0.0, y_cut = height < 64.0f ? y_slack : 0.0;
        double x[2], y[2];
        scaled(left, left + 8.0 * px, k0, k1, x);
        scaled(top - 8.0 * py, top, k0, k1, y);
        assert_true((double)b.low.x <= x[0] + x_cut && (double)b.low.x >= x[0] - x_slack);
        assert_true((double)b.high.x >= x[1] - x_cut && (double)b.high.x <= x[1] + x_slack);
        assert_true((double)b.low.y <= y[0] + y_cut && (double)b.low.y >= y[0] - y_slack);
        assert_true((double)b.high.y >= y[1] - y_cut && (double)b.high.y <= y[1] + y_slack);
        assert_true(b.low.z == lo && b.high.z == hi);
    }
}

static void blocks_of_sky_are_out_of_reach(void** state)
{
    hdrp_cull_box b = hdrp_cull_block_box(hdrp_v4_make(-1, 1, -1, 1), hdrp_v2_make(0.5f, 0.5f), 5,
                                          interval(HDRP_FLT_MAX, -1.0f), 0.0f);
    hdrp_v4 ball = hdrp_v4_make(0, 0, 5, HDRP_LIGHT_RANGE_INFINITE);
    (void)state;
    assert_true(isfinite(b.low.x) && isfinite(b.high.y));
    assert_int_equal(hdrp_cull_box_in_ball(b, ball), 0);
}

static double clamped(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* The nearest point of a box, and its farthest corner. */
static void balls_reach_and_contain_boxes_as_their_points_say(void** state)
{
    uint64_t seed = 77;
    unsigned reached = 0, contained = 0;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        double c[3], lo[3], hi[3], near2 = 0, far2 = 0;
        hdrp_cull_box box;
        hdrp_v4 ball;
        hdrp_u32 found;
        for (int k = 0; k < 3; ++k) {
            c[k] = (double)(float)test_uniform(&seed, -4, 4);
            lo[k] = (double)(float)test_uniform(&seed, -4, 2);
            hi[k] = (double)(float)(lo[k] + test_uniform(&seed, 0, 3));
            near2 += pow(clamped(c[k], lo[k], hi[k]) - c[k], 2);
            far2 += pow(fmax(fabs(c[k] - lo[k]), fabs(c[k] - hi[k])), 2);
        }
        box.low = hdrp_v3_make((float)lo[0], (float)lo[1], (float)lo[2]);
        box.high = hdrp_v3_make((float)hi[0], (float)hi[1], (float)hi[2]);
        ball =
            hdrp_v4_make((float)c[0], (float)c[1], (float)c[2], (float)test_uniform(&seed, 0, 8));
        found = hdrp_cull_box_in_ball(box, ball);
        double r2 = (double)ball.w * (double)ball.w;
        if (fabs(near2 - r2) > 1e-5 * r2) {
            assert_int_equal(found & 1u, near2 < r2);
        }
        if (fabs(far2 - r2) > 1e-5 * r2) {
            assert_int_equal(found >> 16, far2 < r2);
        }
        reached += found & 1u;
        contained += found >> 16;
        assert_true(fabs((double)hdrp_cull_distance_sq(ball, box.low) -
                         (pow(c[0] - lo[0], 2) + pow(c[1] - lo[1], 2) + pow(c[2] - lo[2], 2))) <=
                    1e-5 * 200);
    }
    assert_true(reached > 5000 && contained > 1000 && contained < reached);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depths_are_enclosed_and_hardly_wider),
        cmocka_unit_test(bounds_overlap_where_edges_touch),
        cmocka_unit_test(coarse_cells_hold_whole_tiles_and_share_no_column),
        cmocka_unit_test(bounds_of_nothing_reach_no_cell),
        cmocka_unit_test(boxes_enclose_the_pixels_of_their_blocks),
        cmocka_unit_test(boxes_are_hardly_wider_than_their_blocks),
        cmocka_unit_test(blocks_of_sky_are_out_of_reach),
        cmocka_unit_test(balls_reach_and_contain_boxes_as_their_points_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
