/* test_cull_split.c - lists are the same bits however the work is split, and end where they must.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "cull_generate.h"

#include <stdlib.h>
#include <string.h>

#define GUARD   64u
#define PATTERN 0xa5

/* A block with bytes before and behind it that nobody may write. */
typedef struct guarded {
    unsigned char* memory;
    size_t bytes;
} guarded;

static guarded guarded_make(size_t bytes)
{
    guarded g = {cull_allocate(bytes + 2u * GUARD), bytes};
    memset(g.memory, PATTERN, bytes + 2u * GUARD);
    return g;
}

static void* guarded_block(guarded g)
{
    return g.memory + GUARD;
}

static void guarded_check(guarded g)
{
    for (size_t i = 0; i < GUARD; ++i) {
        assert_int_equal(g.memory[i], PATTERN);
        assert_int_equal(g.memory[GUARD + g.bytes + i], PATTERN);
    }
}

static void guarded_free(guarded g)
{
    guarded_check(g);
    free(g.memory);
}

/* Lists of a scene, made in pieces. */
typedef struct frame {
    hdrp_cull_set set;
    hdrp_cull_lists lists;
    guarded set_block, lists_block;
} frame;

/* The order in which n pieces are done. */
typedef enum order { FORWARDS, BACKWARDS, SHUFFLED } order;

static void fill_order(uint32_t* pieces, uint32_t n, order how, cull_random* r)
{
    for (uint32_t i = 0; i < n; ++i) {
        pieces[i] = how == BACKWARDS ? n - 1u - i : i;
    }
    for (uint32_t i = n; how == SHUFFLED && i > 1u; --i) {
        uint32_t k = cull_below(r, i), t = pieces[i - 1u];
        pieces[i - 1u] = pieces[k];
        pieces[k] = t;
    }
}

/* Where piece i of n of a range begins. */
static uint32_t begin_of(uint32_t count, uint32_t n, uint32_t i)
{
    return (uint32_t)((uint64_t)count * i / n);
}

static void build_piece(frame* f, const hdrp_cull_depth* depth, uint32_t first, uint32_t count)
{
    guarded scratch = guarded_make(hdrp_cull_scratch_size(&f->lists.desc));
    assert_int_equal(hdrp_cull_build(&f->lists, &f->set, depth, first, count,
                                     guarded_block(scratch), scratch.bytes),
                     HDRP_OK);
    guarded_free(scratch);
}

/* All stages, each in n pieces. */
static void frame_run(frame* f, const cull_test_scene* s, uint32_t n, order how, uint64_t seed)
{
    hdrp_cull_depth depth = {s->texels, s->desc.width_px, s->device};
    cull_random r = {seed};
    uint32_t pieces[64], i, rows;
    assert_int_equal(
        hdrp_cull_set_begin(&f->set, &s->camera, s->desc.width_px, s->desc.height_px, s->count),
        HDRP_OK);
    fill_order(pieces, n, how, &r);
    for (i = 0; i < n; ++i) {
        uint32_t first = begin_of(s->count, n, pieces[i]);
        assert_int_equal(hdrp_cull_set_project(&f->set, s->shapes, first,
                                               begin_of(s->count, n, pieces[i] + 1u) - first),
                         HDRP_OK);
    }
    assert_int_equal(hdrp_cull_begin(&f->lists, &f->set), HDRP_OK);
    rows = f->lists.grid.tiles.w;
    fill_order(pieces, n, how, &r);
    for (i = 0; s->texels != NULL && i < n; ++i) {
        uint32_t first = begin_of(rows, n, pieces[i]);
        assert_int_equal(hdrp_cull_measure_depth(&f->lists, &depth, first,
                                                 begin_of(rows, n, pieces[i] + 1u) - first),
                         HDRP_OK);
    }
    rows = hdrp_cull_rows(&f->lists);
    fill_order(pieces, n, how, &r);
    for (i = 0; i < n; ++i) {
        uint32_t first = begin_of(rows, n, pieces[i]);
        build_piece(f, s->texels != NULL ? &depth : NULL, first,
                    begin_of(rows, n, pieces[i] + 1u) - first);
    }
}

static void frame_init(frame* f, const cull_test_scene* s)
{
    f->set_block = guarded_make(hdrp_cull_set_memory_size(s->capacity));
    f->lists_block = guarded_make(hdrp_cull_memory_size(&s->desc));
    assert_int_equal(
        hdrp_cull_set_init(&f->set, s->capacity, guarded_block(f->set_block), f->set_block.bytes),
        HDRP_OK);
    assert_int_equal(
        hdrp_cull_init(&f->lists, &s->desc, guarded_block(f->lists_block), f->lists_block.bytes),
        HDRP_OK);
}

static void frame_free(frame* f)
{
    guarded_free(f->set_block);
    guarded_free(f->lists_block);
}

/* All that a reader may look at: the rest of a tile's entries is nobody's. */
static void assert_same_lists(const frame* a, const frame* b)
{
    hdrp_cull_grid g = a->lists.grid;
    size_t tiles = (size_t)g.tiles.z * g.tiles.w, cells = tiles * g.cells.x;
    assert_memory_equal(a->lists.tiles, b->lists.tiles, tiles * sizeof *a->lists.tiles);
    assert_memory_equal(a->lists.cells, b->lists.cells, cells * sizeof *a->lists.cells);
    assert_memory_equal(a->lists.tile_dropped, b->lists.tile_dropped, tiles * sizeof(uint32_t));
    for (size_t c = 0; c < cells; ++c) {
        uint32_t first = hdrp_cull_first(a->lists.cells[c], 0u);
        uint32_t last = hdrp_cull_last(a->lists.cells[c], 3u);
        assert_true(first <= last && last - first <= g.cells.y);
        if (last > first) {
            assert_memory_equal(a->lists.entries + first, b->lists.entries + first,
                                (last - first) * sizeof *a->lists.entries);
        }
        if (last > first && a->lists.masks != NULL) {
            size_t words = hdrp_cull_mask_words(g);
            assert_memory_equal(a->lists.masks + first * words, b->lists.masks + first * words,
                                (last - first) * words * sizeof *a->lists.masks);
        }
    }
}

/* Categories in order, indices rising in each, entries inside their tile; masks say the same. */
static void check_order(const frame* f, const cull_test_scene* s)
{
    hdrp_cull_grid g = f->lists.grid;
    uint32_t tiles = g.tiles.z * g.tiles.w, stride = (s->count + 31u) / 32u + 1u;
    uint32_t* words = cull_allocate((size_t)tiles * g.cells.x * stride * sizeof *words);
    assert_int_equal(hdrp_cull_masks(&f->lists, 0u, tiles, words, stride), HDRP_OK);
    for (uint32_t c = 0; c < tiles * g.cells.x; ++c) {
        uint32_t tile = c / g.cells.x, found = 0u, set = 0u;
        for (uint32_t category = 0; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
            int64_t before = -1;
            uint32_t i = hdrp_cull_first(f->lists.cells[c], category);
            for (; i < hdrp_cull_last(f->lists.cells[c], category); ++i) {
                uint32_t shape = hdrp_cull_entry_index(f->lists.entries[i]);
                assert_true(i >= tile * g.cells.y && i < (tile + 1u) * g.cells.y);
                assert_true(shape < s->count && (int64_t)shape > before);
                assert_int_equal(hdrp_cull_shape_category(s->shapes[shape]), category);
                assert_true((words[(size_t)c * stride + shape / 32u] >> (shape % 32u) & 1u) != 0u);
                before = shape;
                ++found;
            }
        }
        for (uint32_t w = 0; w < stride; ++w) {
            for (uint32_t word = words[(size_t)c * stride + w]; word != 0u; word &= word - 1u) {
                ++set;
            }
        }
        assert_int_equal(set, found);
    }
    free(words);
}

/* A tall and narrow picture, which has many rows to split. */
static void tall_scene(cull_test_scene* s, uint64_t seed)
{
    static const uint32_t of_pixels = HDRP_CULL_PIXELS | HDRP_CULL_BLOCKS | HDRP_CULL_MASKS;
    static const uint32_t flags[8] = {0u,
                                      HDRP_CULL_ONE_SERIES,
                                      HDRP_CULL_FAST,
                                      HDRP_CULL_PIXELS,
                                      HDRP_CULL_BLOCKS,
                                      HDRP_CULL_BLOCKS | HDRP_CULL_FAST,
                                      HDRP_CULL_MASKS,
                                      HDRP_CULL_MASKS | HDRP_CULL_FAST};
    static const uint32_t sizes[4] = {16u, 32u, 23u, 100u};
    cull_recipe how = {(cull_view)(seed % CULL_VIEWS), true, false, 2u, 2u, 60u};
    cull_random r = {seed};
    cull_random_scene(s, seed, &how);
    free(s->texels);
    s->texels = NULL;
    s->desc.flags = flags[seed % 8u];
    s->desc.slice_count = (s->desc.flags & of_pixels) != 0u ? 1u : 1u + cull_below(&r, 40u);
    s->desc.tile_width_px = sizes[cull_below(&r, 4u)];
    s->desc.tile_height_px = sizes[cull_below(&r, 4u)];
    s->desc.width_px = 1u + cull_below(&r, 90u);
    s->desc.height_px = 1u + cull_below(&r, seed % 3u == 0u ? 300u : 4400u);
    s->desc.entry_capacity = s->capacity * s->desc.slice_count;
    if ((s->desc.flags & of_pixels) != 0u || cull_below(&r, 2u) == 0u) {
        cull_random_depth(&r, s);
    }
    for (uint32_t i = 0; i < s->count; ++i) {
        static const float importances[5] = {0.0f, 1.0f, 1.0f, 2.5f, 1e20f};
        s->items[i].importance = importances[cull_below(&r, 5u)];
    }
    assert_true(cull_scene_run(s));
}

static void check_splits(const cull_test_scene* s, const frame* whole, uint64_t seed)
{
    static const uint32_t counts[4] = {1u, 2u, 7u, 64u};
    for (uint32_t i = 0; i < 4u; ++i) {
        for (int how = FORWARDS; how <= SHUFFLED; ++how) {
            frame split;
            frame_init(&split, s);
            frame_run(&split, s, counts[i], (order)how, seed);
            assert_same_lists(whole, &split);
            if (how == SHUFFLED) { /* another frame in the same memory */
                frame_run(&split, s, counts[3u - i], FORWARDS, seed);
                assert_same_lists(whole, &split);
            }
            frame_free(&split);
        }
    }
}

static void lists_do_not_depend_on_how_the_work_was_split(void** state)
{
    uint32_t entries = 0u;
    (void)state;
    for (uint64_t seed = 0; seed < 48u; ++seed) {
        cull_test_scene s;
        frame whole;
        hdrp_cull_stats stats;
        tall_scene(&s, seed);
        frame_init(&whole, &s);
        frame_run(&whole, &s, 1u, FORWARDS, seed);
        check_order(&whole, &s);
        check_splits(&s, &whole, seed);
        assert_int_equal(hdrp_cull_count(&whole.lists, &stats), HDRP_OK);
        assert_int_equal(stats.dropped, 0);
        entries += (uint32_t)stats.entries;
        frame_free(&whole);
        cull_scene_free(&s);
    }
    assert_true(entries > 100000u);
}

/* >>limits */

/* Entries that each shape has in a tile. */
static void entries_of_shapes(const frame* f, uint32_t tile, uint32_t* counts, uint32_t count)
{
    uint32_t slices = f->lists.grid.cells.x;
    memset(counts, 0, count * sizeof *counts);
    for (uint32_t c = tile * slices; c < (tile + 1u) * slices; ++c) {
        uint32_t i = hdrp_cull_first(f->lists.cells[c], 0u);
        for (; i < hdrp_cull_last(f->lists.cells[c], 3u); ++i) {
            counts[hdrp_cull_entry_index(f->lists.entries[i])] += 1u;
        }
    }
}

/* The most important first, of equals the lower index. */
static const cull_item* sorted_items;
static int by_importance(const void* a, const void* b)
{
    uint32_t x = *(const uint32_t*)a, y = *(const uint32_t*)b;
    float p = sorted_items[x].importance, q = sorted_items[y].importance;
    return p != q ? (p > q ? -1 : 1) : (x < y ? -1 : 1);
}

/* What is kept is what comes first and fits; all of the rest is counted. Returns how many. */
static uint32_t check_tile(const cull_test_scene* s, const frame* all, const frame* some,
                           uint32_t tile, const uint32_t* sorted)
{
    uint32_t full[64], kept[64], dropped = 0u, room = some->lists.desc.entry_capacity;
    uint32_t slices = all->lists.grid.cells.x, h;
    bool any = false;
    assert_true(s->count <= 64u);
    entries_of_shapes(all, tile, full, s->count);
    entries_of_shapes(some, tile, kept, s->count);
    for (h = 0; h < s->count; ++h) {
        uint32_t i = sorted[h];
        bool fits = dropped == 0u && full[i] <= room;
        if (full[i] == 0u) {
            assert_int_equal(kept[i], 0u);
            continue;
        }
        assert_int_equal(kept[i], fits ? full[i] : 0u);
        room -= fits ? full[i] : 0u;
        dropped += fits ? 0u : 1u;
        any = any || fits;
    }
    assert_true(any || dropped == 0u); /* whatever is lost, the most important is there */
    assert_int_equal(some->lists.tile_dropped[tile], dropped);
    for (h = tile * slices; h < (tile + 1u) * slices; ++h) {
        assert_int_equal(some->lists.cells[h].w, dropped);
    }
    return dropped;
}

static void full_tiles_keep_what_is_most_important(void** state)
{
    uint32_t total = 0u;
    (void)state;
    for (uint64_t seed = 100; seed < 148u; ++seed) {
        cull_random r = {seed};
        cull_test_scene s;
        frame all, some;
        hdrp_cull_stats stats;
        uint32_t sorted[64], dropped = 0u, full = 0u;
        tall_scene(&s, seed);
        frame_init(&all, &s);
        frame_run(&all, &s, 1u, FORWARDS, seed);
        s.desc.entry_capacity = s.desc.slice_count;
        s.desc.entry_capacity +=
            cull_below(&r, cull_below(&r, 2u) == 0u ? 8u : 10u * s.desc.slice_count);
        frame_init(&some, &s);
        frame_run(&some, &s, 1u, FORWARDS, seed);
        for (uint32_t i = 0; i < s.count; ++i) {
            sorted[i] = i;
            s.items[i].importance = hdrp_f32_from_bits(s.shapes[i].bits.w);
        }
        sorted_items = s.items;
        qsort(sorted, s.count, sizeof *sorted, by_importance);
        for (uint32_t t = 0; t < some.lists.grid.tiles.z * some.lists.grid.tiles.w; ++t) {
            uint32_t d = check_tile(&s, &all, &some, t, sorted);
            dropped += d;
            full += d > 0u ? 1u : 0u;
        }
        check_order(&some, &s);
        check_splits(&s, &some, seed);
        assert_int_equal(hdrp_cull_count(&some.lists, &stats), HDRP_OK);
        assert_int_equal(stats.dropped, dropped);
        assert_int_equal(stats.tiles_full, full);
        total += dropped;
        frame_free(&all);
        frame_free(&some);
        cull_scene_free(&s);
    }
    assert_true(total > 1000u);
}

static bool is_untouched(const void* memory, size_t bytes)
{
    const unsigned char* p = memory;
    size_t i = 0;
    while (i < bytes && p[i] == PATTERN) {
        ++i;
    }
    return i == bytes;
}

/* Builds one row and marks the tiles whose cells it wrote. It wrote entries in no others. */
static void mark_tiles(frame* f, const hdrp_cull_depth* depth, uint32_t row, uint8_t* writers)
{
    hdrp_cull_grid g = f->lists.grid;
    uint32_t tiles = g.tiles.z * g.tiles.w, slices = g.cells.x, capacity = g.cells.y;
    size_t cell_bytes = slices * sizeof *f->lists.cells;
    memset(f->lists.entries, PATTERN, (size_t)tiles * capacity * sizeof *f->lists.entries);
    memset(f->lists.cells, PATTERN, tiles * cell_bytes);
    build_piece(f, depth, row, 1u);
    for (uint32_t t = 0; t < tiles; ++t) {
        bool written = !is_untouched(f->lists.cells + (size_t)t * slices, cell_bytes);
        writers[t] = (uint8_t)(writers[t] + (written ? 1u : 0u));
        assert_true(written || is_untouched(f->lists.entries + (size_t)t * capacity,
                                            capacity * sizeof *f->lists.entries));
    }
}

static void each_tile_is_written_by_one_row_and_by_no_other(void** state)
{
    (void)state;
    for (uint64_t seed = 200; seed < 248u; ++seed) {
        cull_test_scene s;
        hdrp_cull_depth depth;
        frame f;
        uint32_t tiles;
        uint8_t* writers;
        tall_scene(&s, seed);
        s.desc.entry_capacity = s.desc.slice_count + 2u;
        frame_init(&f, &s);
        frame_run(&f, &s, 1u, FORWARDS, seed);
        tiles = f.lists.grid.tiles.z * f.lists.grid.tiles.w;
        writers = cull_allocate(tiles);
        memset(writers, 0, tiles);
        depth.texels = s.texels;
        depth.row_stride = s.desc.width_px;
        depth.device = s.device;
        for (uint32_t row = 0; row < hdrp_cull_rows(&f.lists); ++row) {
            mark_tiles(&f, s.texels != NULL ? &depth : NULL, row, writers);
        }
        for (uint32_t t = 0; t < tiles; ++t) {
            assert_int_equal(writers[t], 1u);
        }
        free(writers);
        frame_free(&f);
        cull_scene_free(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_do_not_depend_on_how_the_work_was_split),
        cmocka_unit_test(full_tiles_keep_what_is_most_important),
        cmocka_unit_test(each_tile_is_written_by_one_row_and_by_no_other),
    };
    return cmocka_run_group_tests_name("cull_split", tests, NULL, NULL);
}
