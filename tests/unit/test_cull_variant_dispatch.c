/* test_cull_variant_dispatch.c - features of tiles, their variants, and what is dispatched.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define HDRP_CULL_IMPLEMENTATION
#include "hdrp_cull_variant.h"

#define GUARD 0xdeadbeefu

/* A word of a fixed sequence (Steele et al. 2014, splitmix64). */
static uint32_t test_word(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (uint32_t)((z ^ (z >> 31)) >> 32);
}

static void a_variant_covers_what_needs_none_but_its_features(void** state)
{
    (void)state;
    for (uint32_t variant = 0u; variant < 32u; ++variant) {
        for (uint32_t features = 0u; features < 32u; ++features) {
            bool covers = true;
            uint32_t vain = 0u;
            for (uint32_t b = 0u; b < 5u; ++b) {
                bool has = variant >> b & 1u, needs = features >> b & 1u;
                covers = covers && (has || !needs);
                vain += has && !needs ? 1u << b : 0u;
            }
            assert_int_equal(hdrp_cull_variant_covers(variant, features), covers);
            assert_int_equal(hdrp_cull_superfluous_features(variant, features), vain);
        }
    }
}

static void the_search_for_the_first_covering_variant_stops_at_the_first(void** state)
{
    (void)state;
    const uint32_t variants[4] = {0x1u, 0x3u, 0x6u, 0x7u};
    const uint32_t expected[9] = {0u, 0u, 1u, 1u, 2u, 3u, 2u, 3u, HDRP_CULL_VARIANT_NONE};
    for (uint32_t features = 0u; features < 9u; ++features) {
        uint32_t found = HDRP_CULL_VARIANT_NONE;
        for (uint32_t i = 0u; i < 4u; ++i) {
            found = hdrp_cull_first_covering(found, i, variants[i], features);
        }
        assert_int_equal(found, expected[features]);
    }
}

static void a_tile_id_gives_back_column_and_row(void** state)
{
    (void)state;
    const uint32_t values[5] = {0u, 1u, 255u, 32768u, 65535u};
    for (int i = 0; i < 25; ++i) {
        uint32_t x = values[i / 5], y = values[i % 5], id = hdrp_cull_tile_id(x, y);
        assert_int_equal(hdrp_cull_tile_id_x(id), x);
        assert_int_equal(hdrp_cull_tile_id_y(id), y);
    }
    assert_int_equal(hdrp_cull_tile_id(3u, 2u), 0x20003);
    assert_int_equal(hdrp_cull_tile_id(65536u + 3u, 2u), 0x20003);
}

static void tiles_along_a_side_include_the_part_of_one(void** state)
{
    (void)state;
    assert_int_equal(hdrp_cull_tiles_along(32u, 16u), 2);
    assert_int_equal(hdrp_cull_tiles_along(33u, 16u), 3);
    assert_int_equal(hdrp_cull_tiles_along(1u, 16u), 1);
    assert_int_equal(hdrp_cull_tiles_along(0u, 16u), 0);
    assert_int_equal(hdrp_cull_tiles_along(5u, 0u), 0);
}

/* Sizes that are and are not multiples of the tile; pixels between rows must not count. */
static void tiles_have_the_union_of_their_pixels_and_no_others(void** state)
{
    (void)state;
    const uint32_t sizes[5][3] = {{32, 16, 16}, {33, 17, 16}, {7, 9, 4}, {1, 1, 16}, {20, 30, 1}};
    uint64_t random = 1u;
    for (int k = 0; k < 5; ++k) {
        uint32_t w = sizes[k][0], h = sizes[k][1], size = sizes[k][2], stride = w + 3u;
        uint32_t tiles_x = (w + size - 1u) / size, tiles_y = (h + size - 1u) / size;
        uint32_t* pixels = malloc(sizeof *pixels * stride * h);
        uint32_t* expected = calloc((size_t)tiles_x * tiles_y, sizeof *expected);
        uint32_t* words = malloc(sizeof *words * tiles_x * tiles_y);
        hdrp_cull_feature_image image = {pixels, w, h, stride, 0x80000000u, 0u};
        for (uint32_t i = 0u; i < stride * h; ++i) {
            uint32_t r = test_word(&random);
            pixels[i] = i % stride >= w ? 0xffffffffu : r % 3u ? 0x80000000u : 1u << (r >> 8) % 31u;
            if (i % stride < w && pixels[i] != 0x80000000u) {
                expected[i / stride / size * tiles_x + i % stride / size] |= pixels[i];
            }
        }
        memset(words, 0xff, sizeof *words * tiles_x * tiles_y);
        for (uint32_t y = tiles_y; y-- > 0u;) {
            assert_int_equal(hdrp_cull_material_tiles(&image, size, y, 1u, words), HDRP_OK);
        }
        assert_memory_equal(words, expected, sizeof *words * tiles_x * tiles_y);
        free(pixels);
        free(expected);
        free(words);
    }
}

static void without_pixels_all_tiles_get_the_fallback(void** state)
{
    (void)state;
    hdrp_cull_feature_image image = {NULL, 20u, 20u, 0u, 9u, 5u};
    uint32_t words[5] = {GUARD, GUARD, GUARD, GUARD, GUARD};
    assert_int_equal(hdrp_cull_material_tiles(&image, 16u, 0u, 2u, words), HDRP_OK);
    for (int i = 0; i < 4; ++i) {
        assert_int_equal(words[i], 5u);
    }
    assert_int_equal(words[4], GUARD);
    image.fallback = 9u; /* all are skipped */
    assert_int_equal(hdrp_cull_material_tiles(&image, 16u, 0u, 2u, words), HDRP_OK);
    assert_int_equal(words[3], 0u);
}

static void an_image_that_cannot_be_read_is_refused(void** state)
{
    (void)state;
    uint32_t pixels[4] = {1u, 2u, 3u, 4u}, words[4] = {GUARD, GUARD, GUARD, GUARD};
    hdrp_cull_feature_image good = {pixels, 2u, 2u, 0u, 0u, 0u}, bad;
    for (int i = 0; i < 7; ++i) {
        bad = good;
        bad.width = i == 0 ? 0u : i == 1 ? 65537u : 2u;
        bad.height = i == 2 ? 0u : i == 3 ? 65537u : 2u;
        bad.row_stride = i == 4 ? 1u : 0u;
        assert_int_equal(hdrp_cull_material_tiles(&bad,
                                                  i == 5   ? 0u
                                                  : i == 6 ? 65537u
                                                           : 1u,
                                                  0u, 1u, words),
                         HDRP_ERROR_BAD_ARGUMENT);
    }
    assert_int_equal(hdrp_cull_material_tiles(&good, 1u, 1u, 2u, words), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_material_tiles(&good, 1u, 3u, 0u, words), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_material_tiles(NULL, 1u, 0u, 1u, words), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_material_tiles(&good, 1u, 0u, 1u, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(words[0], GUARD);
    assert_int_equal(hdrp_cull_material_tiles(&good, 1u, 2u, 0u, words), HDRP_OK);
    assert_int_equal(words[0], GUARD);
}

static void tiles_of_sky_stay_empty_under_lights(void** state)
{
    (void)state;
    const uint32_t materials[4] = {0u, 1u, 2u, 4u}, lights[4] = {0x100u, 0x200u, 0u, 0x400u};
    const uint32_t expected[4] = {0u, 0x201u, 2u, 0x404u};
    uint32_t words[4] = {GUARD, GUARD, GUARD, GUARD};
    assert_int_equal(hdrp_cull_combine_features(materials, lights, words, 2u, 2u), HDRP_OK);
    assert_int_equal(words[1], GUARD);
    assert_int_equal(hdrp_cull_combine_features(materials, lights, words, 0u, 2u), HDRP_OK);
    assert_memory_equal(words, expected, sizeof words);
    memcpy(words, materials, sizeof words);
    assert_int_equal(hdrp_cull_combine_features(words, lights, words, 0u, 4u), HDRP_OK);
    assert_memory_equal(words, expected, sizeof words);
    assert_int_equal(hdrp_cull_combine_features(materials, NULL, words, 0u, 4u), HDRP_OK);
    assert_memory_equal(words, materials, sizeof words);
    assert_int_equal(hdrp_cull_combine_features(NULL, lights, words, 0u, 4u),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_combine_features(materials, lights, words, 2u, 0xffffffffu),
                     HDRP_ERROR_BAD_ARGUMENT);
}

#define TILES_X 13u
#define TILES_Y 11u
#define TILES   (TILES_X * TILES_Y)

static const uint32_t MASKS[5] = {0x03u, 0x0fu, 0x13u, 0x30u, 0x3fu};
static const double COSTS[5] = {1.0, 4.0, 1.0, 0.5, 9.0};

/* Random words of seven bits, the highest of which no variant has; some are empty. */
static void make_words(uint32_t* words)
{
    uint64_t random = 7u;
    for (uint32_t i = 0u; i < TILES; ++i) {
        uint32_t r = test_word(&random);
        words[i] = r % 5u == 0u ? 0u : r >> 8 & r >> 16 & 0x7fu;
    }
}

static void each_tile_gets_the_first_or_the_cheapest_variant_that_covers_it(void** state)
{
    (void)state;
    uint32_t words[TILES], uncovered = 0u, different = 0u;
    uint8_t first[TILES], cheapest[TILES];
    hdrp_cull_variant_list list = {MASKS, NULL, 5u};
    make_words(words);
    assert_int_equal(hdrp_cull_assign_variants(&list, words, first, 0u, TILES), HDRP_OK);
    list.costs = COSTS;
    assert_int_equal(hdrp_cull_assign_variants(&list, words, cheapest, 0u, TILES), HDRP_OK);
    for (uint32_t i = 0u; i < TILES; ++i) {
        uint32_t a = words[i] ? HDRP_CULL_VARIANT_NONE : HDRP_CULL_VARIANT_EMPTY, b = a;
        for (uint32_t r = 5u; words[i] != 0u && r-- > 0u;) {
            if ((words[i] | MASKS[r]) == MASKS[r]) {
                b = a == HDRP_CULL_VARIANT_NONE || COSTS[r] <= COSTS[b] ? r : b;
                a = r;
            }
        }
        assert_int_equal(first[i], a);
        assert_int_equal(cheapest[i], b);
        uncovered += a == HDRP_CULL_VARIANT_NONE;
        different += a != b;
    }
    assert_true(uncovered > 0u && different > 0u);
}

static void the_split_of_tiles_changes_no_variant(void** state)
{
    (void)state;
    uint32_t words[TILES];
    uint8_t whole[TILES], parts[TILES + 1u];
    hdrp_cull_variant_list list = {MASKS, NULL, 5u};
    make_words(words);
    assert_int_equal(hdrp_cull_assign_variants(&list, words, whole, 0u, TILES), HDRP_OK);
    for (uint32_t step = 1u; step < 30u; step += 4u) {
        memset(parts, 77, sizeof parts);
        for (uint32_t end = TILES; end > 0u;) {
            uint32_t n = end < step ? end : step;
            end -= n;
            assert_int_equal(hdrp_cull_assign_variants(&list, words, parts, end, n), HDRP_OK);
        }
        assert_memory_equal(parts, whole, sizeof whole);
        assert_int_equal(parts[TILES], 77);
    }
}

static void a_list_of_variants_that_is_none_is_refused(void** state)
{
    (void)state;
    uint32_t words[1] = {1u};
    uint8_t chosen[1] = {77u};
    double bad_cost[1] = {NAN};
    hdrp_cull_variant_list list = {MASKS, NULL, 0u};
    assert_int_equal(hdrp_cull_assign_variants(&list, words, chosen, 0u, 1u),
                     HDRP_ERROR_BAD_ARGUMENT);
    list.count = HDRP_CULL_VARIANT_MAX + 1u;
    assert_int_equal(hdrp_cull_assign_variants(&list, words, chosen, 0u, 1u),
                     HDRP_ERROR_BAD_ARGUMENT);
    list.count = 1u;
    list.costs = bad_cost;
    assert_int_equal(hdrp_cull_assign_variants(&list, words, chosen, 0u, 1u),
                     HDRP_ERROR_BAD_ARGUMENT);
    list.costs = NULL;
    assert_int_equal(hdrp_cull_assign_variants(&list, words, chosen, 2u, 0xffffffffu),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_assign_variants(NULL, words, chosen, 0u, 1u),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_assign_variants(&list, NULL, chosen, 0u, 1u),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_assign_variants(&list, words, NULL, 0u, 1u),
                     HDRP_ERROR_NULL_POINTER);
    list.masks = NULL;
    assert_int_equal(hdrp_cull_assign_variants(&list, words, chosen, 0u, 1u),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(chosen[0], 77);
}

/* With every capacity: a list is the beginning of the full one, and all tiles are accounted for. */
static void every_tile_is_dispatched_once_in_order_or_counted(void** state)
{
    (void)state;
    uint32_t words[TILES], full[TILES], full_count = 0u, empty = 0u, uncovered = 0u;
    uint8_t chosen[TILES];
    hdrp_cull_variant_list list = {MASKS, NULL, 5u};
    make_words(words);
    assert_int_equal(hdrp_cull_assign_variants(&list, words, chosen, 0u, TILES), HDRP_OK);
    for (uint32_t r = 0u; r < 5u; ++r) {
        for (uint32_t i = 0u; i < TILES; ++i) {
            if (chosen[i] == r) {
                full[full_count++] = i % TILES_X | i / TILES_X << 16;
            }
        }
    }
    for (uint32_t i = 0u; i < TILES; ++i) {
        empty += words[i] == 0u;
        uncovered += words[i] >> 6 != 0u;
    }
    for (uint32_t capacity = 0u; capacity <= TILES; ++capacity) {
        hdrp_cull_arguments arguments[6];
        uint32_t tiles[TILES + 1u], fits = capacity < full_count ? capacity : full_count, at = 0u;
        hdrp_cull_dispatch d = {arguments, tiles, 5u, capacity, 0u, 0u, 0u, 0u};
        memset(arguments, 0xee, sizeof arguments);
        memset(tiles, 0xee, sizeof tiles);
        assert_int_equal(hdrp_cull_build_dispatch(&d, chosen, TILES_X, TILES_Y), HDRP_OK);
        assert_memory_equal(tiles, full, fits * sizeof *tiles);
        assert_int_equal(tiles[fits], 0xeeeeeeeeu);
        assert_int_equal(arguments[5].groups_x, 0xeeeeeeeeu);
        for (uint32_t r = 0u; r < 5u; ++r) {
            assert_int_equal(arguments[r].first, at);
            assert_true(arguments[r].groups_y == 1u && arguments[r].groups_z == 1u);
            for (uint32_t g = 0u; g < arguments[r].groups_x; ++g, ++at) {
                uint32_t id = tiles[arguments[r].first + g];
                assert_int_equal(chosen[(id >> 16) * TILES_X + (id & 0xffffu)], r);
            }
        }
        assert_int_equal(at, fits);
        assert_int_equal(d.listed, fits);
        assert_int_equal(d.empty, empty);
        assert_int_equal(d.uncovered, uncovered);
        assert_int_equal(d.dropped, full_count - fits);
        assert_int_equal(d.listed + d.empty + d.uncovered + d.dropped, TILES);
    }
}

static void arguments_have_the_layout_of_vulkan(void** state)
{
    (void)state;
    assert_int_equal(sizeof(hdrp_cull_arguments), 16);
    assert_int_equal(offsetof(hdrp_cull_arguments, groups_x), 0);
    assert_int_equal(offsetof(hdrp_cull_arguments, groups_y), 4);
    assert_int_equal(offsetof(hdrp_cull_arguments, groups_z), 8);
    assert_int_equal(offsetof(hdrp_cull_arguments, first), 12);
}

static void a_dispatch_with_wrong_sizes_is_refused(void** state)
{
    (void)state;
    hdrp_cull_arguments arguments[1] = {{GUARD, 0u, 0u, 0u}};
    uint8_t chosen[1] = {3u};
    uint32_t tiles[1] = {GUARD};
    hdrp_cull_dispatch good = {arguments, tiles, 1u, 1u, 0u, 0u, 0u, 0u}, bad = good;
    bad.variant_count = 0u;
    assert_int_equal(hdrp_cull_build_dispatch(&bad, chosen, 1u, 1u), HDRP_ERROR_BAD_ARGUMENT);
    bad.variant_count = HDRP_CULL_VARIANT_MAX + 1u;
    assert_int_equal(hdrp_cull_build_dispatch(&bad, chosen, 1u, 1u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_build_dispatch(&good, chosen, 0u, 1u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_build_dispatch(&good, chosen, 1u, 65537u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_build_dispatch(&good, chosen, 65536u, 65536u),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_build_dispatch(NULL, chosen, 1u, 1u), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_build_dispatch(&good, NULL, 1u, 1u), HDRP_ERROR_NULL_POINTER);
    bad = good;
    bad.arguments = NULL;
    assert_int_equal(hdrp_cull_build_dispatch(&bad, chosen, 1u, 1u), HDRP_ERROR_NULL_POINTER);
    bad = good;
    bad.tiles = NULL;
    assert_int_equal(hdrp_cull_build_dispatch(&bad, chosen, 1u, 1u), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(arguments[0].groups_x, GUARD);
    bad.tile_capacity = 0u; /* only counts; a variant that is not in the list is none */
    assert_int_equal(hdrp_cull_build_dispatch(&bad, chosen, 1u, 1u), HDRP_OK);
    assert_int_equal(bad.uncovered, 1);
    assert_int_equal(arguments[0].groups_x, 0);
}

/* Against counting each of the 256 possible words. */
static void a_histogram_has_every_set_once_in_order_with_its_weight(void** state)
{
    (void)state;
    enum { N = 4000 };
    uint32_t* words = malloc(N * sizeof *words);
    uint32_t* weights = malloc(N * sizeof *weights);
    uint64_t random = 3u, expected[256] = {0u};
    hdrp_cull_feature_count entries[257], parts_entries[257], other_entries[257];
    assert_true(words && weights);
    for (int i = 0; i < N; ++i) {
        words[i] = test_word(&random) & test_word(&random) & 0xffu;
        weights[i] = i % 7 == 0 ? 0xffffffffu : test_word(&random) % 256u;
        expected[words[i]] += weights[i];
    }
    for (uint32_t capacity = 1u; capacity <= 256u; capacity += 15u) {
        hdrp_cull_histogram h = {entries, capacity, 0u, 0u}, parts = h, other = h;
        uint32_t at = 0u;
        uint64_t left_out = 0u;
        parts.entries = parts_entries;
        other.entries = other_entries;
        entries[capacity].features = GUARD;
        assert_int_equal(hdrp_cull_histogram_add(&h, words, weights, N), HDRP_OK);
        for (uint32_t f = 1u; f < 256u; ++f) {
            if (expected[f] != 0u && at < capacity) {
                assert_int_equal(h.entries[at].features, f);
                assert_true(h.entries[at++].weight == expected[f]);
            } else {
                left_out += expected[f];
            }
        }
        assert_int_equal(h.count, at);
        assert_true(h.left_out == left_out);
        assert_int_equal(entries[capacity].features, GUARD);
        /* The later half first, and two jobs. */
        assert_int_equal(hdrp_cull_histogram_add(&parts, words + N / 2, weights + N / 2, N - N / 2),
                         HDRP_OK);
        assert_int_equal(hdrp_cull_histogram_add(&other, words, weights, N / 2), HDRP_OK);
        assert_int_equal(hdrp_cull_histogram_merge(&parts, &other), HDRP_OK);
        assert_int_equal(parts.count, h.count);
        assert_true(parts.left_out == h.left_out);
        for (uint32_t i = 0u; i < h.count; ++i) {
            assert_int_equal(parts_entries[i].features, entries[i].features);
            assert_true(parts_entries[i].weight == entries[i].weight);
        }
    }
    free(words);
    free(weights);
}

static void without_weights_tiles_are_counted_and_empty_ones_are_not(void** state)
{
    (void)state;
    const uint32_t words[6] = {4u, 0u, 2u, 4u, 0u, 4u};
    hdrp_cull_feature_count entries[4];
    hdrp_cull_histogram h = {entries, 4u, 0u, 0u}, bad = h;
    assert_int_equal(hdrp_cull_histogram_add(&h, words, NULL, 6u), HDRP_OK);
    assert_int_equal(h.count, 2);
    assert_true(entries[0].features == 2u && entries[0].weight == 1u);
    assert_true(entries[1].features == 4u && entries[1].weight == 3u);
    assert_int_equal(hdrp_cull_all_features(entries, 2u), 6);
    assert_int_equal(hdrp_cull_all_features(NULL, 2u), 0);
    bad.capacity = 0u;
    assert_int_equal(hdrp_cull_histogram_add(&bad, words, NULL, 6u), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_histogram_merge(&h, &bad), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_histogram_merge(&h, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_histogram_add(&h, NULL, NULL, 6u), HDRP_ERROR_NULL_POINTER);
    bad.entries = NULL;
    assert_int_equal(hdrp_cull_histogram_add(&bad, words, NULL, 6u), HDRP_ERROR_NULL_POINTER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_variant_covers_what_needs_none_but_its_features),
        cmocka_unit_test(the_search_for_the_first_covering_variant_stops_at_the_first),
        cmocka_unit_test(a_tile_id_gives_back_column_and_row),
        cmocka_unit_test(tiles_along_a_side_include_the_part_of_one),
        cmocka_unit_test(tiles_have_the_union_of_their_pixels_and_no_others),
        cmocka_unit_test(without_pixels_all_tiles_get_the_fallback),
        cmocka_unit_test(an_image_that_cannot_be_read_is_refused),
        cmocka_unit_test(tiles_of_sky_stay_empty_under_lights),
        cmocka_unit_test(each_tile_gets_the_first_or_the_cheapest_variant_that_covers_it),
        cmocka_unit_test(the_split_of_tiles_changes_no_variant),
        cmocka_unit_test(a_list_of_variants_that_is_none_is_refused),
        cmocka_unit_test(every_tile_is_dispatched_once_in_order_or_counted),
        cmocka_unit_test(arguments_have_the_layout_of_vulkan),
        cmocka_unit_test(a_dispatch_with_wrong_sizes_is_refused),
        cmocka_unit_test(a_histogram_has_every_set_once_in_order_with_its_weight),
        cmocka_unit_test(without_weights_tiles_are_counted_and_empty_ones_are_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
