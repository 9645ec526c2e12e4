/* test_cull_grid.c - the formulas of hdrp_cull_grid.h: grids, slices and how lists are read.
 * SPDX-License-Identifier: MIT */
#include "cull_test.h"

#include "hdrp_cull_grid.h"

static hdrp_cull_camera camera_of(float near_m, float far_m)
{
    return hdrp_cull_camera_perspective(hdrp_v3_make(0, 0, 0), hdrp_v3_make(0, 0, -1),
                                        hdrp_v3_make(0, 1, 0), -1, 1, -1, 1, near_m, far_m);
}

static hdrp_cull_grid grid_of(float near_m, float far_m, uint32_t slices)
{
    return hdrp_cull_grid_make(camera_of(near_m, far_m), hdrp_u32x4_make(1280, 720, slices, 100),
                               hdrp_u32x4_make(32, 16, 0, 0), 0.0f, 0.0f);
}

static void the_logarithm_is_exact_for_powers_of_two_and_rises(void** state)
{
    float last = -INFINITY;
    (void)state;
    for (int e = -126; e < 128; ++e) {
        assert_true(hdrp_cull_log2(ldexpf(1.0f, e)) == (float)e);
    }
    /* Every float of two octaves, and of those around the ends of the others. */
    for (uint32_t bits = 0x3f000000u; bits <= 0x40000000u; ++bits) {
        float y = hdrp_cull_log2(hdrp_f32_from_bits(bits));
        assert_true(y > last || (y == last && bits > 0x3f000000u));
        last = y;
    }
    for (uint32_t e = 2; e < 255u; ++e) {
        uint32_t bits = e << 23;
        for (uint32_t k = 0; k < 64u; ++k) {
            assert_true(hdrp_cull_log2(hdrp_f32_from_bits(bits - k - 1u)) <=
                        hdrp_cull_log2(hdrp_f32_from_bits(bits - k)));
            assert_true(hdrp_cull_log2(hdrp_f32_from_bits(bits + k)) <=
                        hdrp_cull_log2(hdrp_f32_from_bits(bits + k + 1u)));
        }
    }
    assert_true(hdrp_cull_log2(0.0f) == -126.0f && hdrp_cull_log2(-5.0f) == -126.0f);
    assert_true(hdrp_cull_log2((float)NAN) == -126.0f && hdrp_cull_log2(1e-45f) == -126.0f);
    assert_true(hdrp_cull_log2((float)INFINITY) == 128.0f);
}

static void grids_cover_the_picture(void** state)
{
    hdrp_cull_grid g = grid_of(0.5f, 200.0f, 64);
    (void)state;
    assert_int_equal(g.tiles.x, 32);
    assert_int_equal(g.tiles.y, 16);
    assert_int_equal(g.tiles.z, 40);
    assert_int_equal(g.tiles.w, 45);
    assert_int_equal(g.cells.x, 64);
    assert_int_equal(g.cells.y, 100);
    assert_int_equal(g.cells.z, 8);
    assert_int_equal(g.cells.w, 4);
    assert_true(g.series.x == 0.5f && g.series.y == -1.0f && g.series.z == 200.0f);
    g = hdrp_cull_grid_make(camera_of(0.5f, 200.0f), hdrp_u32x4_make(1281, 719, 1, 0),
                            hdrp_u32x4_make(30, 5, 0, 0), 4.0f, 16.0f);
    assert_int_equal(g.tiles.z, 43);
    assert_int_equal(g.tiles.w, 144);
    assert_int_equal(g.cells.z, 8); /* four blocks of 8 hold 30 */
    assert_int_equal(g.cells.w, 2);
    assert_true(g.series.x == 4.0f && g.series.z == 16.0f && g.series.w == 0.5f);
}

static void sizes_of_grids_are_limited(void** state)
{
    const uint32_t most = 0xffffffffu;
    hdrp_cull_grid g = hdrp_cull_grid_make(camera_of(1, 10), hdrp_u32x4_make(0, 0, 0, 0),
                                           hdrp_u32x4_make(0, 0, 0, 0), 0, 0);
    (void)state;
    assert_int_equal(g.tiles.x, 1);
    assert_int_equal(g.tiles.y, 1);
    assert_int_equal(g.tiles.z, 1);
    assert_int_equal(g.tiles.w, 1);
    assert_int_equal(g.cells.x, 1);
    assert_int_equal(g.cells.z, 1);
    assert_int_equal(g.cells.w, 1);
    g = hdrp_cull_grid_make(camera_of(1, 10), hdrp_u32x4_make(most, most, most, most),
                            hdrp_u32x4_make(most, most, 0, 0), (float)NAN, (float)NAN);
    assert_int_equal(g.tiles.x, HDRP_CULL_SIZE_MAX);
    assert_int_equal(g.tiles.z, 1);
    assert_int_equal(g.cells.x, HDRP_CULL_SLICES_MAX);
    assert_int_equal(g.cells.y, most);
    assert_int_equal(g.cells.z, HDRP_CULL_SIZE_MAX / 4);
    assert_true(g.series.x == 1.0f && g.series.z == 10.0f);
    assert_int_equal(hdrp_cull_entry_covers(g, most, most, most), 1u);
    g = hdrp_cull_grid_make(camera_of(1, 1e6f), hdrp_u32x4_make(1, 1, 10, 1),
                            hdrp_u32x4_make(1, 1, 0, 0), 0, 0);
    assert_true(g.series.z == 1000.0f); /* at most a thousand times the start */
    g = hdrp_cull_grid_make(camera_of(1, 100), hdrp_u32x4_make(1, 1, 10, 1),
                            hdrp_u32x4_make(1, 1, 0, 0), 50.0f, 2.0f);
    assert_true(g.series.x == 50.0f && g.series.z == 50.0f && isfinite(g.series.w));
    g = hdrp_cull_grid_make(camera_of(1, 100), hdrp_u32x4_make(1, 1, 10, 1),
                            hdrp_u32x4_make(1, 1, 0, 0), (float)INFINITY, (float)INFINITY);
    assert_true(g.series.x == 1e9f && g.series.z == HDRP_CULL_FAR_INFINITE);
}

static void half_of_the_slices_are_in_front_of_the_farthest_depth(void** state)
{
    (void)state;
    for (double ratio = 1.1; ratio <= 1e6; ratio *= 1.3) {
        for (uint32_t slices = 1; slices <= 256u; slices *= 2u) {
            hdrp_cull_grid g = grid_of(0.1f, 1e7f, slices);
            float farthest = (float)(0.1 * ratio);
            float scale = hdrp_cull_series_scale(g, farthest);
            uint32_t at = hdrp_cull_slice(g, scale, farthest * 1.00001f);
            uint32_t before = hdrp_cull_slice(g, scale, farthest * 0.9999f);
            assert_int_equal(at, slices / 2u);
            assert_int_equal(before, slices > 1u ? slices / 2u - 1u : 0u);
        }
    }
}

static void every_slice_is_reached_in_order(void** state)
{
    (void)state;
    for (double ratio = 1.1; ratio <= 1e6; ratio *= 7.0) {
        for (uint32_t slices = 1; slices <= 256u; slices = slices < 3 ? slices + 1 : slices * 2) {
            hdrp_cull_grid g = grid_of(0.25f, 1e9f, slices);
            float scale = hdrp_cull_series_scale(g, (float)(0.25 * ratio));
            uint32_t last = 0;
            double step = pow(ratio, 2.0 / (8.0 * slices + 1.0));
            for (double z = 0.1; z < 0.25 * ratio * ratio * ratio; z *= step) {
                uint32_t slice = hdrp_cull_slice(g, scale, (float)z);
                assert_true(slice == last || slice == last + 1u);
                last = slice;
            }
            assert_int_equal(last, slices - 1u);
            assert_int_equal(hdrp_cull_slice(g, scale, (float)INFINITY), slices - 1u);
            assert_int_equal(hdrp_cull_slice(g, scale, 1e18f), slices - 1u);
            assert_int_equal(hdrp_cull_slice(g, scale, 0.0f), 0u);
            assert_int_equal(hdrp_cull_slice(g, scale, -1.0f), 0u);
            assert_int_equal(hdrp_cull_slice(g, scale, (float)NAN), 0u);
        }
    }
}

static void the_series_without_depth_ends_where_it_was_told(void** state)
{
    hdrp_cull_grid g = hdrp_cull_grid_make(camera_of(0.1f, 1e6f), hdrp_u32x4_make(64, 64, 48, 9),
                                           hdrp_u32x4_make(32, 32, 0, 0), 1.0f, 64.0f);
    (void)state;
    assert_true(g.series.w == 8.0f); /* 48 slices in 6 octaves */
    assert_int_equal(hdrp_cull_slice(g, g.series.w, 0.5f), 0u);
    assert_int_equal(hdrp_cull_slice(g, g.series.w, 4.0f), 16u);
    assert_int_equal(hdrp_cull_slice(g, g.series.w, 63.0f), 47u);
    assert_int_equal(hdrp_cull_slice(g, g.series.w, 1e5f), 47u);
}

static void scales_are_finite_for_every_depth(void** state)
{
    const float depths[] = {0.0f, -1.0f, 0.1f, 0.100001f, 1e30f, (float)NAN, (float)INFINITY};
    hdrp_cull_grid g = grid_of(0.1f, 1e6f, 64);
    (void)state;
    for (size_t i = 0; i < sizeof depths / sizeof depths[0]; ++i) {
        float scale = hdrp_cull_series_scale(g, depths[i]);
        assert_true(scale > 0.0f && scale <= 32001.0f);
    }
    assert_true(hdrp_cull_series_scale(g, (float)NAN) == hdrp_cull_series_scale(g, 0.1f));
    assert_true(hdrp_cull_series_scale(grid_of(0.1f, 1e6f, 1), 10.0f) == 0.0f);
}

static void depths_of_pixels_are_opaque_or_sky(void** state)
{
    (void)state;
    assert_true(hdrp_cull_opaque_depth(5.0f, 0.5f, 100.0f) == 5.0f);
    assert_true(hdrp_cull_opaque_depth(0.5f, 0.5f, 100.0f) == 0.5f);
    assert_true(hdrp_cull_opaque_depth(0.1f, 0.5f, 100.0f) == 0.5f);
    assert_true(hdrp_cull_opaque_depth(0.0f, 0.5f, 100.0f) == 0.5f);
    assert_true(hdrp_cull_opaque_depth(-0.1f, 0.5f, 100.0f) == -1.0f);
    assert_true(hdrp_cull_opaque_depth(99.99f, 0.5f, 100.0f) == 99.99f);
    assert_true(hdrp_cull_opaque_depth(99.99995f, 0.5f, 100.0f) == -1.0f);
    assert_true(hdrp_cull_opaque_depth(100.0f, 0.5f, 100.0f) == -1.0f);
    assert_true(hdrp_cull_opaque_depth((float)INFINITY, 0.5f, 100.0f) == -1.0f);
    assert_true(hdrp_cull_opaque_depth((float)NAN, 0.5f, 100.0f) == -1.0f);
}

static void tiles_hold_their_depths_and_a_scale(void** state)
{
    hdrp_cull_grid g = grid_of(0.5f, 200.0f, 64);
    hdrp_v4 tile = hdrp_cull_tile_of_depths(g, 2.0f, 8.0f, 0u);
    (void)state;
    assert_true(tile.x == 2.0f && tile.y == 8.0f && tile.w == 0.0f);
    assert_true(tile.z == 8.0f); /* 32 slices in the 4 octaves from 0.5 m to 8 m */
    tile = hdrp_cull_tile_of_depths(g, 2.0f, 8.0f, 1u);
    assert_true(tile.x == 2.0f && tile.y == 8.0f && tile.z == g.series.w);
    tile = hdrp_cull_tile_of_depths(g, HDRP_FLT_MAX, -1.0f, 0u);
    assert_true(tile.x == 1.0f && tile.y == -1.0f && tile.z == g.series.w && tile.w == 0.0f);
    tile = hdrp_cull_tile_of_depths(g, 1.0f, (float)NAN, 0u);
    assert_true(tile.x == 1.0f && tile.y == -1.0f && tile.z == g.series.w);
}

static void pixels_find_their_tile_and_cell(void** state)
{
    hdrp_cull_grid g = grid_of(0.5f, 200.0f, 64);
    (void)state;
    assert_int_equal(hdrp_cull_tile_of_pixel(g, 0, 0), 0);
    assert_int_equal(hdrp_cull_tile_of_pixel(g, 31, 15), 0);
    assert_int_equal(hdrp_cull_tile_of_pixel(g, 32, 15), 1);
    assert_int_equal(hdrp_cull_tile_of_pixel(g, 31, 16), 40);
    assert_int_equal(hdrp_cull_tile_of_pixel(g, 1279, 719), 40 * 45 - 1);
    assert_int_equal(hdrp_cull_cell(g, 3, 5), 3 * 64 + 5);
}

static void cells_know_their_categories(void** state)
{
    hdrp_u32x4 cell = hdrp_u32x4_make(1000u, 3u | 65535u << 16, 5u | 7u << 16, 2u);
    (void)state;
    assert_int_equal(hdrp_cull_first(cell, HDRP_CULL_CATEGORY_PUNCTUAL), 1000);
    assert_int_equal(hdrp_cull_last(cell, HDRP_CULL_CATEGORY_PUNCTUAL), 1003);
    assert_int_equal(hdrp_cull_first(cell, HDRP_CULL_CATEGORY_AREA), 1003);
    assert_int_equal(hdrp_cull_last(cell, HDRP_CULL_CATEGORY_AREA), 1003 + 65535);
    assert_int_equal(hdrp_cull_first(cell, HDRP_CULL_CATEGORY_ENVIRONMENT), 1003 + 65535);
    assert_int_equal(hdrp_cull_last(cell, HDRP_CULL_CATEGORY_ENVIRONMENT), 1008 + 65535);
    assert_int_equal(hdrp_cull_first(cell, HDRP_CULL_CATEGORY_DECAL), 1008 + 65535);
    assert_int_equal(hdrp_cull_last(cell, HDRP_CULL_CATEGORY_DECAL), 1008 + 65535 + 7);
}

static void entries_hold_an_index_and_blocks(void** state)
{
    hdrp_cull_grid g = grid_of(0.5f, 200.0f, 1);
    (void)state;
    assert_int_equal(hdrp_cull_entry_index(0xabcd1234u), 0x1234u);
    for (uint32_t block = 0; block < 16u; ++block) {
        uint32_t entry = 1u << (16u + block) | 0xffffu;
        for (uint32_t y = 0; y < 16u; ++y) {
            for (uint32_t x = 0; x < 32u; ++x) {
                uint32_t own = y / 4u * 4u + x / 8u;
                /* a tile in the middle of the picture: 5 columns and 7 rows before it */
                assert_int_equal(hdrp_cull_entry_covers(g, entry, 160u + x, 112u + y),
                                 own == block ? 1u : 0u);
                assert_int_equal(hdrp_cull_entry_bit(g, 160u + x, 112u + y), 1u << (16u + own));
            }
        }
    }
}

/* Each pixel of a tile has a bit of its own, and each block bits that follow each other. */
static void masks_have_a_bit_for_each_pixel(void** state)
{
    static const uint32_t sizes[][2] = {{16, 16}, {8, 8}, {32, 16}, {5, 3}, {1, 1}, {64, 64}};
    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; ++k) {
        uint32_t w = sizes[k][0], h = sizes[k][1], bits[200] = {0};
        hdrp_cull_grid g =
            hdrp_cull_grid_make(camera_of(1, 10), hdrp_u32x4_make(7 * w, 5 * h, 1, 9),
                                hdrp_u32x4_make(w, h, 0, 0), 0, 0);
        uint32_t words = hdrp_cull_mask_words(g), of_block = g.cells.z * g.cells.w;
        assert_true(words <= 200u && words * 32u >= 16u * of_block);
        assert_true(words * 32u < 16u * of_block + 32u);
        for (uint32_t y = 0; y < h; ++y) {
            for (uint32_t x = 0; x < w; ++x) {
                uint32_t word = hdrp_cull_mask_word(g, 3u, 2u * w + x, h + y);
                uint32_t bit = hdrp_cull_mask_bit(g, 2u * w + x, h + y);
                uint32_t block = y / g.cells.w * 4u + x / g.cells.z;
                assert_true(word >= 3u * words && word < 4u * words && bit < 32u);
                word -= 3u * words;
                assert_true((bits[word] >> bit & 1u) == 0u);
                bits[word] |= 1u << bit;
                assert_int_equal((word * 32u + bit) / of_block, block);
            }
        }
    }
    assert_int_equal(
        hdrp_cull_mask_words(hdrp_cull_grid_make(camera_of(1, 10), hdrp_u32x4_make(64, 64, 1, 9),
                                                 hdrp_u32x4_make(16, 16, 0, 0), 0, 0)),
        8u);
}

static void every_bit_is_the_lowest_of_some_words(void** state)
{
    (void)state;
    for (uint32_t i = 0; i < 32u; ++i) {
        uint32_t bit = 1u << i;
        assert_int_equal(hdrp_cull_lowest_bit(bit), i);
        assert_int_equal(hdrp_cull_lowest_bit(0u - bit), i);
        assert_int_equal(hdrp_cull_lowest_bit(bit | 0x80000000u), i);
    }
}

static void slices_meet_a_little_wider_than_they_are(void** state)
{
    hdrp_cull_grid g = grid_of(0.5f, 1e5f, 24), one = grid_of(0.5f, 1e5f, 1);
    hdrp_v4 tile = hdrp_v4_make(2.0f, 70.0f, 0.0f, 0.0f);
    float last = 0.5f;
    (void)state;
    tile.z = hdrp_cull_series_scale(g, 70.0f);
    for (uint32_t k = 0; k < 24; ++k) {
        hdrp_cull_interval r = hdrp_cull_slice_depths(g, tile, k, 0.5f, 1e5f);
        float middle = sqrtf(r.nearest * r.farthest);
        assert_int_equal(hdrp_cull_slice(g, tile.z, middle), k);
        assert_true(r.nearest <= last && r.nearest >= last * 0.99995f);
        assert_true(k == 0 || hdrp_cull_slice(g, tile.z, r.nearest) == k - 1);
        assert_true(k == 23 ? r.farthest == 1e5f : hdrp_cull_slice(g, tile.z, r.farthest) == k + 1);
        last = r.farthest;
    }
    assert_true(hdrp_cull_slice_begin(g, tile.z, 12) > 69.9f &&
                hdrp_cull_slice_begin(g, tile.z, 12) < 70.1f); /* half of them are in front */
    assert_true(hdrp_cull_slice_depths(one, tile, 0, 0.5f, 1e5f).nearest == 2.0f);
    assert_true(hdrp_cull_slice_depths(one, tile, 0, 0.5f, 1e5f).farthest == 70.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_meet_a_little_wider_than_they_are),
        cmocka_unit_test(the_logarithm_is_exact_for_powers_of_two_and_rises),
        cmocka_unit_test(grids_cover_the_picture),
        cmocka_unit_test(sizes_of_grids_are_limited),
        cmocka_unit_test(half_of_the_slices_are_in_front_of_the_farthest_depth),
        cmocka_unit_test(every_slice_is_reached_in_order),
        cmocka_unit_test(the_series_without_depth_ends_where_it_was_told),
        cmocka_unit_test(scales_are_finite_for_every_depth),
        cmocka_unit_test(depths_of_pixels_are_opaque_or_sky),
        cmocka_unit_test(tiles_hold_their_depths_and_a_scale),
        cmocka_unit_test(pixels_find_their_tile_and_cell),
        cmocka_unit_test(cells_know_their_categories),
        cmocka_unit_test(entries_hold_an_index_and_blocks),
        cmocka_unit_test(masks_have_a_bit_for_each_pixel),
        cmocka_unit_test(every_bit_is_the_lowest_of_some_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
