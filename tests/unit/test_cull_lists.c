/* test_cull_lists.c - sets and lists of hdrp_cull.h: errors, order, limits, what is read from them.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define HDRP_CULL_IMPLEMENTATION
#include "cull_test.h"
#include "hdrp_cull.h"

#define WIDTH  100u
#define HEIGHT 80u

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

/* Depth is along +z, -x to the right, y up. */
static hdrp_cull_camera camera(void)
{
    return hdrp_cull_camera_perspective(v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), -1.25f, 1.25f, -1.0f,
                                        1.0f, 0.5f, 100.0f);
}

static void* block(size_t bytes)
{
    void* p = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes ? bytes : HDRP_MEMORY_ALIGNMENT);
    assert_non_null(p);
    memset(p, 0xa5, bytes);
    return p;
}

/* A set and lists with memory of their own. */
typedef struct scene {
    hdrp_cull_set set;
    hdrp_cull_lists lists;
    hdrp_cull_desc desc;
    void *set_memory, *memory, *scratch;
    size_t scratch_bytes;
} scene;

static hdrp_cull_desc desc_of(uint32_t slices, uint32_t flags)
{
    hdrp_cull_desc d = {0};
    d.width_px = WIDTH;
    d.height_px = HEIGHT;
    d.tile_width_px = d.tile_height_px = 16u;
    d.slice_count = slices;
    d.flags = flags;
    return d;
}

static scene scene_seen(hdrp_cull_desc desc, hdrp_cull_camera c, const hdrp_cull_shape* shapes,
                        uint32_t count)
{
    scene s = {0};
    size_t set_bytes = hdrp_cull_set_memory_size(64u), bytes = hdrp_cull_memory_size(&desc);
    assert_true(set_bytes > 0 && bytes > 0);
    s.desc = desc;
    s.set_memory = block(set_bytes);
    s.memory = block(bytes);
    s.scratch_bytes = hdrp_cull_scratch_size(&desc);
    s.scratch = block(s.scratch_bytes);
    assert_int_equal(hdrp_cull_set_init(&s.set, 64u, s.set_memory, set_bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_init(&s.lists, &desc, s.memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_set_begin(&s.set, &c, WIDTH, HEIGHT, count), HDRP_OK);
    assert_int_equal(hdrp_cull_set_project(&s.set, shapes, 0u, count), HDRP_OK);
    assert_int_equal(hdrp_cull_begin(&s.lists, &s.set), HDRP_OK);
    return s;
}

static scene scene_make(hdrp_cull_desc desc, const hdrp_cull_shape* shapes, uint32_t count)
{
    return scene_seen(desc, camera(), shapes, count);
}

static void scene_build(scene* s, const hdrp_cull_depth* depth)
{
    if (depth) {
        assert_int_equal(hdrp_cull_measure_depth(&s->lists, depth, 0u, s->lists.grid.tiles.w),
                         HDRP_OK);
    }
    assert_int_equal(hdrp_cull_build(&s->lists, &s->set, depth, 0u, hdrp_cull_rows(&s->lists),
                                     s->scratch, s->scratch_bytes),
                     HDRP_OK);
}

static void scene_free(scene* s)
{
    free(s->set_memory);
    free(s->memory);
    free(s->scratch);
}

/* The list of a category of the cell of a pixel at a depth, as text: "3 5 " */
static const char* list_at(const scene* s, uint32_t x, uint32_t y, float z, uint32_t category)
{
    static char text[1024];
    const hdrp_cull_lists* l = &s->lists;
    uint32_t tile = hdrp_cull_tile_of_pixel(l->grid, x, y);
    uint32_t slice = hdrp_cull_slice(l->grid, l->tiles[tile].z, z);
    hdrp_u32x4 cell = l->cells[hdrp_cull_cell(l->grid, tile, slice)];
    size_t at = 0;
    text[0] = '\0';
    for (uint32_t i = hdrp_cull_first(cell, category); i < hdrp_cull_last(cell, category); ++i) {
        at += (size_t)snprintf(text + at, sizeof text - at, "%u ",
                               hdrp_cull_entry_index(l->entries[i]));
    }
    return text;
}

static void sizes_that_are_out_of_range_need_no_memory(void** state)
{
    hdrp_cull_desc good = desc_of(0u, 0u), d, complete = good;
    (void)state;
    assert_int_equal(hdrp_cull_set_memory_size(0u), 0u);
    assert_int_equal(hdrp_cull_set_memory_size(HDRP_CULL_SHAPES_MAX + 1u), 0u);
    assert_true(hdrp_cull_set_memory_size(1u) > 0u);
    assert_true(hdrp_cull_set_memory_size(HDRP_CULL_SHAPES_MAX) % HDRP_MEMORY_ALIGNMENT == 0u);
    assert_int_equal(hdrp_cull_memory_size(NULL), 0u);
    assert_int_equal(hdrp_cull_scratch_size(NULL), 0u);
    assert_true(hdrp_cull_memory_size(&good) > 0u && hdrp_cull_scratch_size(&good) > 0u);
    assert_true(hdrp_cull_memory_size(&good) % HDRP_MEMORY_ALIGNMENT == 0u);
    assert_true(hdrp_cull_scratch_size(&good) % HDRP_MEMORY_ALIGNMENT == 0u);
#define EXPECT_BAD(member, value)                                                                  \
    d = good;                                                                                      \
    d.member = value;                                                                              \
    assert_int_equal(hdrp_cull_memory_size(&d), 0u);                                               \
    assert_int_equal(hdrp_cull_scratch_size(&d), 0u);                                              \
    assert_int_equal(hdrp_cull_desc_complete(&d, &complete), HDRP_ERROR_BAD_ARGUMENT)
    EXPECT_BAD(width_px, 0u);
    EXPECT_BAD(height_px, 0u);
    EXPECT_BAD(width_px, HDRP_CULL_SIZE_MAX + 1u);
    EXPECT_BAD(height_px, HDRP_CULL_SIZE_MAX + 1u);
    EXPECT_BAD(tile_width_px, HDRP_CULL_SIZE_MAX + 1u);
    EXPECT_BAD(tile_height_px, HDRP_CULL_SIZE_MAX + 1u);
    EXPECT_BAD(slice_count, HDRP_CULL_SLICES_MAX + 1u);
    EXPECT_BAD(shape_capacity, HDRP_CULL_SHAPES_MAX + 1u);
    EXPECT_BAD(entry_capacity, 65535u * 64u + 1u);
    EXPECT_BAD(entry_capacity, 63u); /* less than an entry in each of 64 slices */
    d.entry_capacity = 64u;
    assert_true(hdrp_cull_memory_size(&d) > 0u && hdrp_cull_scratch_size(&d) > 0u);
    EXPECT_BAD(flags, 1u << 31);
    EXPECT_BAD(flags, HDRP_CULL_PIXELS); /* with 64 slices */
    EXPECT_BAD(flags, HDRP_CULL_BLOCKS);
    EXPECT_BAD(series_start_m, -1.0f);
    EXPECT_BAD(series_end_m, (float)NAN);
    /* Tiles of a pixel, with 256 slices: 2^36 cells. */
    d = good;
    d.width_px = d.height_px = HDRP_CULL_SIZE_MAX;
    d.tile_width_px = d.tile_height_px = 1u;
    d.slice_count = HDRP_CULL_SLICES_MAX;
    assert_int_equal(hdrp_cull_memory_size(&d), 0u);
    assert_int_equal(hdrp_cull_desc_complete(&d, &complete), HDRP_ERROR_TOO_LARGE);
    assert_int_equal(hdrp_cull_desc_complete(NULL, &complete), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_desc_complete(&good, NULL), HDRP_ERROR_NULL_POINTER);
    assert_memory_equal(&complete, &good, sizeof good);
    assert_int_equal(hdrp_cull_scratch_size(&d), 0u);
}

static void a_set_that_cannot_be_made_is_left_alone(void** state)
{
    size_t bytes = hdrp_cull_set_memory_size(10u);
    char* memory = block(bytes + 16u);
    hdrp_cull_set set, before;
    hdrp_cull_camera c = camera();
    (void)state;
    memset(&set, 0x5a, sizeof set);
    before = set;
    assert_int_equal(hdrp_cull_set_init(NULL, 10u, memory, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_set_init(&set, 10u, NULL, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_set_init(&set, 0u, memory, bytes), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_init(&set, 65536u, memory, bytes), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_init(&set, 10u, memory, bytes - 1u),
                     HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(hdrp_cull_set_init(&set, 10u, memory + 4, bytes), HDRP_ERROR_MEMORY_ALIGNMENT);
    assert_memory_equal(&set, &before, sizeof set);
    assert_int_equal(hdrp_cull_set_init(&set, 10u, memory, bytes), HDRP_OK);
    assert_int_equal(set.count, 0u);
    before = set;
    assert_int_equal(hdrp_cull_set_begin(NULL, &c, 1, 1, 0), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_set_begin(&set, NULL, 1, 1, 0), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_set_begin(&set, &c, 0, 1, 0), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_begin(&set, &c, 1, 0, 0), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_begin(&set, &c, 16385, 1, 0), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_begin(&set, &c, 1, 16385, 0), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_begin(&set, &c, 1, 1, 11), HDRP_ERROR_BAD_ARGUMENT);
    assert_memory_equal(&set, &before, sizeof set);
    assert_int_equal(hdrp_cull_set_begin(&set, &c, 16384, 16384, 10), HDRP_OK);
    free(memory);
}

static void shapes_are_projected_in_any_ranges(void** state)
{
    hdrp_cull_shape shapes[4];
    size_t bytes = hdrp_cull_set_memory_size(4u);
    hdrp_cull_set set;
    hdrp_cull_camera c = camera();
    void* memory = block(bytes);
    (void)state;
    for (int i = 0; i < 4; ++i) {
        shapes[i] = hdrp_cull_shape_sphere(v3((float)i, 0, 10), 1.0f, (uint32_t)i);
    }
    assert_int_equal(hdrp_cull_set_init(&set, 4u, memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_set_begin(&set, &c, WIDTH, HEIGHT, 3u), HDRP_OK);
    assert_int_equal(hdrp_cull_set_project(NULL, shapes, 0, 1), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_set_project(&set, NULL, 0, 1), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_set_project(&set, NULL, 0, 0), HDRP_OK);
    assert_int_equal(hdrp_cull_set_project(&set, shapes, 0, 4), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_project(&set, shapes, 4, 0), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_project(&set, shapes, 2, 0xffffffffu), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_set_project(&set, shapes, 3, 0), HDRP_OK);
    assert_int_equal(hdrp_cull_set_project(&set, shapes, 2, 1), HDRP_OK);
    assert_int_equal(hdrp_cull_set_project(&set, shapes, 0, 2), HDRP_OK);
    for (uint32_t i = 0; i < 3u; ++i) {
        hdrp_cull_shape s = hdrp_cull_shape_in_view(shapes[i], c);
        hdrp_cull_bounds b = hdrp_cull_shape_bounds(s, c, (float)WIDTH, (float)HEIGHT);
        assert_memory_equal(&set.shapes[i], &s, sizeof s);
        assert_memory_equal(&set.bounds[i], &b, sizeof b);
        assert_true(set.balls[i].w == hdrp_cull_shape_ball(s).w);
    }
    free(memory);
}

static void lists_that_cannot_be_made_are_left_alone(void** state)
{
    hdrp_cull_desc d = desc_of(0u, 0u), bad = d, few = d, large = d;
    size_t bytes = hdrp_cull_memory_size(&d);
    char* memory = block(bytes + 16u);
    hdrp_cull_lists lists, before;
    (void)state;
    bad.width_px = 0u;
    few.entry_capacity = 63u;
    large.width_px = large.height_px = HDRP_CULL_SIZE_MAX;
    large.tile_width_px = large.tile_height_px = 1u;
    large.slice_count = HDRP_CULL_SLICES_MAX;
    memset(&lists, 0x5a, sizeof lists);
    before = lists;
    assert_int_equal(hdrp_cull_init(NULL, &d, memory, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_init(&lists, NULL, memory, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_init(&lists, &d, NULL, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_init(&lists, &bad, memory, bytes), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_init(&lists, &few, memory, bytes), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_init(&lists, &large, memory, bytes), HDRP_ERROR_TOO_LARGE);
    assert_int_equal(hdrp_cull_init(&lists, &d, memory, bytes - 1u), HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(hdrp_cull_init(&lists, &d, memory + 8, bytes), HDRP_ERROR_MEMORY_ALIGNMENT);
    assert_memory_equal(&lists, &before, sizeof lists);
    assert_int_equal(hdrp_cull_rows(NULL), 0u);
    assert_int_equal(hdrp_cull_init(&lists, &d, memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_rows(&lists), 2u); /* 80 pixels in rows of 64 */
    free(memory);
}

static void zeros_are_the_defaults(void** state)
{
    hdrp_cull_desc d = {0};
    hdrp_cull_lists lists;
    void* memory;
    size_t bytes;
    (void)state;
    d.width_px = 100u;
    d.height_px = 33u;
    bytes = hdrp_cull_memory_size(&d);
    memory = block(bytes);
    assert_int_equal(hdrp_cull_init(&lists, &d, memory, bytes), HDRP_OK);
    assert_int_equal(lists.desc.tile_width_px, 32u);
    assert_int_equal(lists.desc.tile_height_px, 32u);
    assert_int_equal(lists.desc.slice_count, 64u);
    assert_int_equal(lists.desc.shape_capacity, 1024u);
    assert_int_equal(lists.desc.entry_capacity, 2048u);
    assert_int_equal(lists.grid.tiles.z, 4u);
    assert_int_equal(lists.grid.tiles.w, 2u);
    assert_int_equal(hdrp_cull_desc_complete(&d, &d), HDRP_OK);
    assert_memory_equal(&d, &lists.desc, sizeof d);
    free(memory);
}

static void frames_and_ranges_are_checked(void** state)
{
    float texels[WIDTH * HEIGHT];
    hdrp_cull_depth depth = {texels, WIDTH, NULL}, no_texels = {NULL, WIDTH, NULL};
    hdrp_cull_depth narrow = {texels, WIDTH - 1u, NULL};
    hdrp_cull_shape shape = hdrp_cull_shape_sphere(v3(0, 0, 10), 1.0f, 0u);
    scene s = scene_make(desc_of(1u, HDRP_CULL_PIXELS), &shape, 1u);
    hdrp_cull_camera c = camera();
    uint32_t rows = hdrp_cull_rows(&s.lists);
    (void)state;
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        texels[i] = 10.0f;
    }
    assert_int_equal(hdrp_cull_begin(NULL, &s.set), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_begin(&s.lists, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_measure_depth(NULL, &depth, 0, 1), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_measure_depth(&s.lists, NULL, 0, 1), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_measure_depth(&s.lists, &no_texels, 0, 1), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_measure_depth(&s.lists, &narrow, 0, 1), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_measure_depth(&s.lists, &depth, 0, 6), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_measure_depth(&s.lists, &depth, 6, 0), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_measure_depth(&s.lists, &depth, 5, 0), HDRP_OK);
    assert_int_equal(hdrp_cull_measure_depth(&s.lists, &depth, 0, 5), HDRP_OK);
#define BUILD(lists, set, depth, first, count, scratch, bytes)                                     \
    hdrp_cull_build(lists, set, depth, first, count, scratch, bytes)
    assert_int_equal(BUILD(NULL, &s.set, &depth, 0, rows, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(BUILD(&s.lists, NULL, &depth, 0, rows, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(BUILD(&s.lists, &s.set, NULL, 0, rows, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(BUILD(&s.lists, &s.set, &no_texels, 0, rows, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(BUILD(&s.lists, &s.set, &narrow, 0, rows, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(BUILD(&s.lists, &s.set, &depth, 0, rows, NULL, s.scratch_bytes),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(BUILD(&s.lists, &s.set, &depth, 0, rows, s.scratch, s.scratch_bytes - 1u),
                     HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(
        BUILD(&s.lists, &s.set, &depth, 0, rows, (char*)s.scratch + 4, s.scratch_bytes),
        HDRP_ERROR_MEMORY_ALIGNMENT);
    assert_int_equal(BUILD(&s.lists, &s.set, &depth, 0, rows + 1u, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(BUILD(&s.lists, &s.set, &depth, 1, 0xffffffffu, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(BUILD(&s.lists, &s.set, &depth, rows, 0, s.scratch, s.scratch_bytes), HDRP_OK);
    assert_int_equal(BUILD(&s.lists, &s.set, &depth, 0, rows, s.scratch, s.scratch_bytes), HDRP_OK);
    /* The set of the other eye. */
    c.eye_near.x += 0.06f;
    assert_int_equal(hdrp_cull_set_begin(&s.set, &c, WIDTH, HEIGHT, 1u), HDRP_OK);
    assert_int_equal(BUILD(&s.lists, &s.set, &depth, 0, rows, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_BAD_ARGUMENT);
    /* A picture of another size. */
    assert_int_equal(hdrp_cull_set_begin(&s.set, &c, WIDTH + 1u, HEIGHT, 1u), HDRP_OK);
    assert_int_equal(hdrp_cull_begin(&s.lists, &s.set), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(BUILD(&s.lists, &s.set, &depth, 0, rows, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_BAD_ARGUMENT);
    scene_free(&s);
    /* A set that is larger than the lists were made for. */
    hdrp_cull_desc small = desc_of(1u, 0u);
    hdrp_cull_shape two[] = {shape, shape};
    small.shape_capacity = 1u;
    s = scene_make(small, two, 2u);
    assert_int_equal(BUILD(&s.lists, &s.set, NULL, 0, 1u, s.scratch, s.scratch_bytes),
                     HDRP_ERROR_BAD_ARGUMENT);
    scene_free(&s);
}

static void an_empty_set_gives_empty_lists(void** state)
{
    scene s = scene_make(desc_of(8u, 0u), NULL, 0u);
    hdrp_cull_stats stats;
    uint32_t words[8u * 7u * 5u];
    (void)state;
    scene_build(&s, NULL);
    assert_int_equal(hdrp_cull_count(&s.lists, &stats), HDRP_OK);
    assert_true(stats.entries == 0u && stats.longest == 0u);
    assert_true(stats.dropped == 0u && stats.tiles_full == 0u);
    memset(words, 0xff, sizeof words);
    assert_int_equal(hdrp_cull_masks(&s.lists, 0u, 35u, words, 1u), HDRP_OK);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        assert_int_equal(words[i], 0u);
    }
    assert_int_equal(hdrp_cull_masks(&s.lists, 0u, 35u, words, 0u), HDRP_OK);
    scene_free(&s);
}

/* Balls of four categories around one place, and one elsewhere. */
static void fill(hdrp_cull_shape shapes[6])
{
    static const uint32_t category[] = {3u, 0u, 2u, 0u, 1u, 0u};
    for (uint32_t i = 0; i < 6u; ++i) {
        shapes[i] = hdrp_cull_shape_sphere(v3(i == 5u ? 8.0f : 0.0f, 0, 10), 0.5f, category[i]);
        shapes[i].bits.w = hdrp_bits_from_f32((float)(i * i)); /* importance */
    }
}

static void lists_are_ordered_by_category_and_index(void** state)
{
    hdrp_cull_shape shapes[6];
    scene s;
    hdrp_cull_stats stats;
    (void)state;
    fill(shapes);
    s = scene_make(desc_of(16u, 0u), shapes, 6u);
    scene_build(&s, NULL);
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_PUNCTUAL), "1 3 ");
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_AREA), "4 ");
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_ENVIRONMENT), "2 ");
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_DECAL), "0 ");
    assert_string_equal(list_at(&s, 50, 40, 1.0f, HDRP_CULL_CATEGORY_PUNCTUAL), "");
    assert_string_equal(list_at(&s, 50, 40, 60.0f, HDRP_CULL_CATEGORY_PUNCTUAL), "");
    assert_string_equal(list_at(&s, 2, 2, 10.0f, HDRP_CULL_CATEGORY_PUNCTUAL), "");
    assert_string_equal(list_at(&s, 17, 40, 10.0f, HDRP_CULL_CATEGORY_PUNCTUAL), "5 ");
    assert_int_equal(hdrp_cull_count(NULL, &stats), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_count(&s.lists, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_count(&s.lists, &stats), HDRP_OK);
    assert_int_equal(stats.longest, 5u);
    assert_int_equal(stats.dropped, 0u);
    uint64_t entries = 0;
    for (uint32_t tile = 0; tile < 35u; ++tile) {
        for (uint32_t slice = 0; slice < 16u; ++slice) {
            hdrp_u32x4 cell = s.lists.cells[hdrp_cull_cell(s.lists.grid, tile, slice)];
            assert_int_equal(cell.w, 0u);
            for (uint32_t category = 0; category < 4u; ++category) {
                entries += hdrp_cull_last(cell, category) - hdrp_cull_first(cell, category);
            }
        }
    }
    assert_true(stats.entries == entries);
    scene_free(&s);
}

static void masks_have_the_bits_of_lists(void** state)
{
    hdrp_cull_shape shapes[40];
    uint32_t words[16u * 35u * 2u], untouched;
    scene s;
    (void)state;
    for (uint32_t i = 0; i < 40u; ++i) {
        shapes[i] = hdrp_cull_shape_sphere(v3((float)i * 0.5f - 10.0f, 0, 10), 0.5f, i & 3u);
    }
    s = scene_make(desc_of(16u, 0u), shapes, 40u);
    scene_build(&s, NULL);
    assert_int_equal(hdrp_cull_masks(NULL, 0, 1, words, 2), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_masks(&s.lists, 0, 1, NULL, 2), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_masks(&s.lists, 0, 0, NULL, 2), HDRP_OK);
    assert_int_equal(hdrp_cull_masks(&s.lists, 0, 36, words, 2), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_masks(&s.lists, 36, 0, words, 2), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_masks(&s.lists, 2, 0xfffffffeu, words, 2), HDRP_ERROR_BAD_ARGUMENT);
    memset(words, 0x77, sizeof words);
    untouched = words[0];
    /* Index 39 is in the second word. */
    assert_int_equal(hdrp_cull_masks(&s.lists, 0, 35, words, 1), HDRP_ERROR_BAD_ARGUMENT);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        assert_int_equal(words[i], untouched);
    }
    assert_int_equal(hdrp_cull_masks(&s.lists, 14, 21, words, 2), HDRP_OK);
    for (uint32_t cell = 0; cell < 16u * 21u; ++cell) {
        hdrp_u32x4 c = s.lists.cells[14u * 16u + cell];
        uint32_t expected[2] = {0u, 0u};
        for (uint32_t i = hdrp_cull_first(c, 0u); i < hdrp_cull_last(c, 3u); ++i) {
            uint32_t index = hdrp_cull_entry_index(s.lists.entries[i]);
            expected[index / 32u] |= 1u << (index % 32u);
        }
        assert_int_equal(words[2u * cell], expected[0]);
        assert_int_equal(words[2u * cell + 1u], expected[1]);
    }
    /* And they are walked from the lowest bit to the highest. */
    uint32_t tile = hdrp_cull_tile_of_pixel(s.lists.grid, 50, 40) - 14u, visited = 0u;
    uint32_t slice = hdrp_cull_slice(s.lists.grid, s.lists.tiles[0].z, 10.0f);
    for (uint32_t k = 0; k < 2u; ++k) {
        for (uint32_t w = words[2u * (tile * 16u + slice) + k]; w != 0u; w &= w - 1u) {
            uint32_t index = 32u * k + hdrp_cull_lowest_bit(w);
            assert_true(index >= visited && fabs((double)index * 0.5 - 10.0) < 4.5);
            visited = index + 1u;
        }
    }
    assert_true(visited > 20u);
    scene_free(&s);
}

static void a_full_tile_drops_the_least_important_and_counts_them(void** state)
{
    hdrp_cull_desc desc = desc_of(1u, 0u);
    hdrp_cull_shape shapes[6];
    hdrp_cull_stats stats;
    scene s;
    uint32_t tile;
    (void)state;
    fill(shapes); /* importance 0, 1, 4, 9, 16 and, elsewhere, 25 */
    desc.entry_capacity = 2u;
    s = scene_make(desc, shapes, 6u);
    scene_build(&s, NULL);
    tile = hdrp_cull_tile_of_pixel(s.lists.grid, 50, 40);
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_PUNCTUAL), "3 ");
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_AREA), "4 ");
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_ENVIRONMENT), "");
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_DECAL), "");
    assert_int_equal(s.lists.tile_dropped[tile], 3u);
    assert_int_equal(s.lists.cells[tile].w, 3u);
    assert_int_equal(hdrp_cull_count(&s.lists, &stats), HDRP_OK);
    assert_int_equal(stats.longest, 2u);
    assert_int_equal(stats.dropped, 3u * stats.tiles_full);
    assert_true(stats.tiles_full >= 1u);
    scene_free(&s);
    /* Of equals those of lower index stay. */
    for (uint32_t i = 0; i < 6u; ++i) {
        shapes[i] = hdrp_cull_shape_sphere(v3(0, 0, 10), 0.5f, 0u);
    }
    s = scene_make(desc, shapes, 6u);
    scene_build(&s, NULL);
    assert_string_equal(list_at(&s, 50, 40, 10.0f, HDRP_CULL_CATEGORY_PUNCTUAL), "0 1 ");
    scene_free(&s);
}

static void light_features_are_the_union_over_the_lists_of_a_tile(void** state)
{
    hdrp_cull_shape shapes[6];
    uint32_t words[35], expected[35] = {0u};
    scene s;
    (void)state;
    fill(shapes); /* five around (50, 40), of all categories, and one in column 1 */
    for (uint32_t i = 0; i < 6u; ++i) {
        shapes[i] = hdrp_cull_shape_with_features(shapes[i], 0x80000001u << i, 0u, 1.0f);
        /* Of each a depth of its own: no cell lists them all. */
        shapes[i].center_range.z = i == 5u ? 10.0f : 2.0f + 6.0f * (float)i;
    }
    s = scene_make(desc_of(16u, 0u), shapes, 6u);
    scene_build(&s, NULL);
    memset(words, 0x77, sizeof words);
    assert_int_equal(hdrp_cull_light_features(&s.lists, &s.set, 14u, 21u, words), HDRP_OK);
    for (uint32_t t = 0; t < 14u; ++t) {
        assert_int_equal(words[t], 0x77777777u);
    }
    assert_int_equal(words[hdrp_cull_tile_of_pixel(s.lists.grid, 50, 40)], 0x8000001fu);
    assert_int_equal(words[hdrp_cull_tile_of_pixel(s.lists.grid, 17, 40)], 0x20u);
    assert_int_equal(words[34], 0u);
    assert_int_equal(hdrp_cull_light_features(&s.lists, &s.set, 0u, 35u, words), HDRP_OK);
    for (uint32_t i = 0; i < 6u; ++i) {
        /* The lists by themselves, shape by shape. */
        scene one = scene_make(desc_of(16u, 0u), shapes + i, 1u);
        hdrp_cull_stats stats;
        scene_build(&one, NULL);
        assert_int_equal(hdrp_cull_count(&one.lists, &stats), HDRP_OK);
        assert_true(stats.entries > 0u);
        for (uint32_t c = 0; c < 35u * 16u; ++c) {
            hdrp_u32x4 cell = one.lists.cells[c];
            expected[c / 16u] |= hdrp_cull_last(cell, 3u) > cell.x ? shapes[i].bits.z : 0u;
        }
        scene_free(&one);
    }
    assert_memory_equal(words, expected, sizeof words);
    scene_free(&s);
    s = scene_make(desc_of(16u, 0u), NULL, 0u);
    scene_build(&s, NULL);
    assert_int_equal(hdrp_cull_light_features(&s.lists, &s.set, 0u, 35u, words), HDRP_OK);
    for (uint32_t t = 0; t < 35u; ++t) {
        assert_int_equal(words[t], 0u);
    }
    scene_free(&s);
}

static void light_features_of_what_was_dropped_do_not_count(void** state)
{
    hdrp_cull_desc desc = desc_of(1u, 0u);
    hdrp_cull_shape shapes[6];
    uint32_t words[35];
    scene s;
    (void)state;
    fill(shapes); /* importance 0, 1, 4, 9, 16 and, elsewhere, 25 */
    for (uint32_t i = 0; i < 6u; ++i) {
        shapes[i].bits.z = 1u << i;
    }
    desc.entry_capacity = 2u;
    s = scene_make(desc, shapes, 6u);
    scene_build(&s, NULL);
    assert_int_equal(hdrp_cull_light_features(&s.lists, &s.set, 0u, 35u, words), HDRP_OK);
    assert_int_equal(words[hdrp_cull_tile_of_pixel(s.lists.grid, 50, 40)], 0x18u);
    scene_free(&s);
}

static void light_features_of_a_bad_range_or_another_set_are_not_written(void** state)
{
    hdrp_cull_shape shapes[6];
    hdrp_cull_camera c = camera();
    uint32_t words[35], before[35];
    scene s;
    (void)state;
    fill(shapes);
    s = scene_make(desc_of(16u, 0u), shapes, 6u);
    scene_build(&s, NULL);
    memset(words, 0x77, sizeof words);
    memcpy(before, words, sizeof words);
#define FEATURES(lists, set, first, count, words)                                                  \
    hdrp_cull_light_features(lists, set, first, count, words)
    assert_int_equal(FEATURES(NULL, &s.set, 0, 1, words), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(FEATURES(&s.lists, NULL, 0, 1, words), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(FEATURES(&s.lists, &s.set, 0, 1, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(FEATURES(&s.lists, &s.set, 0, 0, NULL), HDRP_OK);
    assert_int_equal(FEATURES(&s.lists, &s.set, 35, 0, words), HDRP_OK);
    assert_int_equal(FEATURES(&s.lists, &s.set, 0, 36, words), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(FEATURES(&s.lists, &s.set, 36, 0, words), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(FEATURES(&s.lists, &s.set, 2, 0xfffffffeu, words), HDRP_ERROR_BAD_ARGUMENT);
    /* Shape 5 is listed, in column 1 alone. */
    assert_int_equal(hdrp_cull_set_begin(&s.set, &c, WIDTH, HEIGHT, 5u), HDRP_OK);
    assert_int_equal(FEATURES(&s.lists, &s.set, 0, 35, words), HDRP_ERROR_BAD_ARGUMENT);
    assert_memory_equal(words, before, sizeof words);
    assert_int_equal(FEATURES(&s.lists, &s.set, 17, 1, words), HDRP_OK);
    scene_free(&s);
}

/* A large picture in small tiles with 65535 shapes drops more than 32 bits count. */
static void dropped_shapes_are_counted_in_64_bits(void** state)
{
    scene s = scene_make(desc_of(1u, 0u), NULL, 0u);
    hdrp_cull_stats stats;
    (void)state;
    scene_build(&s, NULL);
    for (uint32_t tile = 0; tile < 35u; ++tile) {
        s.lists.tile_dropped[tile] = tile < 2u ? 0x80000000u : 0u;
    }
    assert_int_equal(hdrp_cull_count(&s.lists, &stats), HDRP_OK);
    assert_true(stats.dropped == (uint64_t)1u << 32);
    assert_int_equal(stats.tiles_full, 2u);
    scene_free(&s);
}

/* The least room there may be: the most important shape stays, though it spans all slices. */
static void a_full_tile_never_loses_the_most_important_shape(void** state)
{
    hdrp_cull_desc desc = desc_of(16u, 0u);
    hdrp_cull_shape shapes[3] = {hdrp_cull_shape_sphere(v3(0, 0, 10), 0.5f, 0u),
                                 hdrp_cull_shape_sphere(v3(0, 0, 0), 1e18f, 0u),
                                 hdrp_cull_shape_sphere(v3(0, 0, 10), 0.5f, 0u)};
    scene s;
    (void)state;
    shapes[1].bits.w = hdrp_bits_from_f32(2.0f);
    desc.entry_capacity = 16u;
    s = scene_make(desc, shapes, 3u);
    scene_build(&s, NULL);
    for (uint32_t cell = 0; cell < 35u * 16u; ++cell) {
        hdrp_u32x4 c = s.lists.cells[cell];
        assert_int_equal(hdrp_cull_last(c, 3u) - c.x, 1u);
        assert_int_equal(hdrp_cull_entry_index(s.lists.entries[c.x]), 1u);
    }
    assert_int_equal(s.lists.tile_dropped[hdrp_cull_tile_of_pixel(s.lists.grid, 50, 40)], 2u);
    scene_free(&s);
}

static void depth_decides_what_a_tile_lists(void** state)
{
    float texels[WIDTH * HEIGHT];
    hdrp_cull_depth depth = {texels, WIDTH, NULL};
    hdrp_cull_shape shapes[3];
    scene s;
    (void)state;
    for (int i = 0; i < 3; ++i) {
        shapes[i] = hdrp_cull_shape_sphere(v3(0, 0, 5.0f + 10.0f * (float)i), 2.0f, 0u);
    }
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        texels[i] = i % WIDTH < 50u ? 15.0f : (float)INFINITY; /* a wall, then sky */
    }
    s = scene_make(desc_of(1u, 0u), shapes, 3u);
    scene_build(&s, &depth);
    assert_string_equal(list_at(&s, 47, 40, 15.0f, 0u), "1 ");
    assert_string_equal(list_at(&s, 66, 40, 15.0f, 0u), ""); /* sky alone */
    assert_true(s.lists.tiles[0].x == 15.0f && s.lists.tiles[0].y == 15.0f);
    assert_true(s.lists.tiles[6].x > s.lists.tiles[6].y);
    scene_free(&s);
    /* Depth as a device has it. */
    hdrp_depth_params params = hdrp_depth_params_perspective(0.5f, 100.0f, 1u);
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        texels[i] = i % WIDTH < 50u ? hdrp_device_depth(params, 25.0f) : 0.0f;
    }
    depth.device = &params;
    s = scene_make(desc_of(1u, 0u), shapes, 3u);
    scene_build(&s, &depth);
    assert_string_equal(list_at(&s, 47, 40, 25.0f, 0u), "2 ");
    assert_string_equal(list_at(&s, 66, 40, 25.0f, 0u), "");
    scene_free(&s);
    /* Clusters: half of the slices are in front of the farthest depth. */
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        texels[i] = hdrp_device_depth(params, i % WIDTH < 50u ? 4.0f : 25.0f);
    }
    s = scene_make(desc_of(32u, 0u), shapes, 3u);
    scene_build(&s, &depth);
    assert_int_equal(hdrp_cull_slice(s.lists.grid, s.lists.tiles[0].z, 4.01f), 16u);
    assert_int_equal(hdrp_cull_slice(s.lists.grid, s.lists.tiles[6].z, 25.1f), 16u);
    assert_string_equal(list_at(&s, 47, 40, 25.0f, 0u), "2 ");
    scene_free(&s);
    s = scene_make(desc_of(32u, HDRP_CULL_ONE_SERIES), shapes, 3u);
    scene_build(&s, &depth);
    assert_true(s.lists.tiles[0].z == s.lists.tiles[6].z);
    scene_free(&s);
}

static void blocks_are_those_whose_pixels_are_reached(void** state)
{
    float texels[WIDTH * HEIGHT];
    hdrp_cull_depth depth = {texels, WIDTH, NULL};
    /* At 10 m a pixel is 0.25 m wide: this ball covers a bit more than one block of 4 x 4. */
    hdrp_cull_shape shape = hdrp_cull_shape_sphere(v3(1.5f, 0.75f, 10), 0.4f, 0u);
    scene s;
    uint32_t covered = 0;
    (void)state;
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        texels[i] = 10.0f;
    }
    s = scene_make(desc_of(1u, HDRP_CULL_BLOCKS), &shape, 1u);
    scene_build(&s, &depth);
    for (uint32_t y = 0; y < HEIGHT; ++y) {
        for (uint32_t x = 0; x < WIDTH; ++x) {
            double px = ((double)x + 0.5 - 50.0) * 0.25, py = (40.0 - (double)y - 0.5) * 0.25;
            bool reached = hypot(px + 1.5, py - 0.75) <= 0.4;
            hdrp_u32x4 cell = s.lists.cells[hdrp_cull_tile_of_pixel(s.lists.grid, x, y)];
            uint32_t n = hdrp_cull_last(cell, 3u) - cell.x;
            uint32_t covers =
                n ? hdrp_cull_entry_covers(s.lists.grid, s.lists.entries[cell.x], x, y) : 0u;
            assert_true(n <= 1u && (covers == 1u || !reached));
            covered += covers;
        }
    }
    assert_true(covered >= 16u && covered <= 64u);
    scene_free(&s);
    /* In front of the wall nothing is reached. */
    shape = hdrp_cull_shape_sphere(v3(1.5f, 0.75f, 9), 0.4f, 0u);
    s = scene_make(desc_of(1u, HDRP_CULL_PIXELS), &shape, 1u);
    scene_build(&s, &depth);
    hdrp_cull_stats stats;
    assert_int_equal(hdrp_cull_count(&s.lists, &stats), HDRP_OK);
    assert_true(stats.entries == 0u);
    scene_free(&s);
}

static void masks_of_entries_are_the_pixels_that_are_reached(void** state)
{
    float texels[WIDTH * HEIGHT];
    hdrp_cull_depth depth = {texels, WIDTH, NULL};
    /* Of the three balls the second is in front of the wall, and the third contains whole tiles. */
    hdrp_cull_shape shapes[3] = {hdrp_cull_shape_sphere(v3(1.5f, 0.75f, 10), 0.9f, 1u),
                                 hdrp_cull_shape_sphere(v3(1.5f, 0.75f, 8), 0.9f, 0u),
                                 hdrp_cull_shape_sphere(v3(2.0f, 0, 10), 6.0f, 0u)};
    const double x[] = {-1.5, -1.5, -2.0}, y[] = {0.75, 0.75, 0.0}, radius[] = {0.9, 0.0, 6.0};
    uint32_t seen = 0, unseen = 0;
    scene s;
    (void)state;
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        texels[i] = 10.0f;
    }
    s = scene_make(desc_of(1u, HDRP_CULL_MASKS), shapes, 3u);
    scene_build(&s, &depth);
    for (uint32_t py = 0; py < HEIGHT; ++py) {
        for (uint32_t px = 0; px < WIDTH; ++px) {
            double u = ((double)px + 0.5 - 50.0) * 0.25, v = (40.0 - (double)py - 0.5) * 0.25;
            hdrp_u32x4 cell = s.lists.cells[hdrp_cull_tile_of_pixel(s.lists.grid, px, py)];
            bool listed[3] = {false, false, false};
            for (uint32_t i = cell.x; i < hdrp_cull_last(cell, 3u); ++i) {
                uint32_t index = hdrp_cull_entry_index(s.lists.entries[i]);
                uint32_t word = s.lists.masks[hdrp_cull_mask_word(s.lists.grid, i, px, py)];
                uint32_t bit = word >> hdrp_cull_mask_bit(s.lists.grid, px, py) & 1u;
                assert_true(index < 3u && !listed[index]);
                listed[index] = true;
                assert_int_equal(bit, hypot(u - x[index], v - y[index]) <= radius[index]);
                seen += bit;
                unseen += 1u - bit;
            }
            for (uint32_t index = 0; index < 3u; ++index) {
                assert_true(listed[index] || hypot(u - x[index], v - y[index]) > radius[index]);
            }
        }
    }
    assert_true(seen > 1000u && unseen > 100u);
    scene_free(&s);
}

/* An orthographic picture in which a pixel is a metre. */
static hdrp_cull_camera map(void)
{
    return hdrp_cull_camera_orthographic(v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), -50.0f, 50.0f,
                                         -40.0f, 40.0f, 0.5f, 100.0f);
}

/* Whether the mask of the only shape has a pixel. */
static bool mask_has(const scene* s, uint32_t x, uint32_t y)
{
    hdrp_u32x4 cell = s->lists.cells[hdrp_cull_tile_of_pixel(s->lists.grid, x, y)];
    return hdrp_cull_last(cell, 3u) > cell.x &&
           (s->lists.masks[hdrp_cull_mask_word(s->lists.grid, cell.x, x, y)] >>
                hdrp_cull_mask_bit(s->lists.grid, x, y) &
            1u);
}

/* The rim of a ball goes through the centres of four pixels, or passes them by 0.3 mm. */
static void pixels_are_asked_at_their_centres(void** state)
{
    static float texels[WIDTH * HEIGHT];
    hdrp_cull_depth depth = {texels, WIDTH, NULL};
    (void)state;
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        texels[i] = 10.0f;
    }
    for (int inside = 0; inside < 2; ++inside) {
        float radius = inside ? 20.5003f : 20.4997f;
        hdrp_cull_shape across = hdrp_cull_shape_sphere(v3(0, 0.5f, 10), radius, 0u);
        hdrp_cull_shape along = hdrp_cull_shape_sphere(v3(-0.5f, 0, 10), radius, 0u);
        scene s = scene_seen(desc_of(1u, HDRP_CULL_MASKS), map(), &across, 1u);
        scene_build(&s, &depth);
        assert_true(mask_has(&s, 69, 39) && mask_has(&s, 30, 39));
        assert_int_equal(mask_has(&s, 70, 39), inside);
        assert_int_equal(mask_has(&s, 29, 39), inside);
        scene_free(&s);
        s = scene_seen(desc_of(1u, HDRP_CULL_MASKS), map(), &along, 1u);
        scene_build(&s, &depth);
        assert_true(mask_has(&s, 50, 20) && mask_has(&s, 50, 59));
        assert_int_equal(mask_has(&s, 50, 19), inside);
        assert_int_equal(mask_has(&s, 50, 60), inside);
        scene_free(&s);
    }
}

/* Balls of all sizes, in front of, on and behind a rough surface with holes: each is in the list of a
 * tile exactly if it reaches a pixel of it. A pixel within 1e-4 of a rim may count or not. */
static void expect_balls_where_pixels_are_reached(hdrp_cull_camera c, bool flat)
{
    static float texels[WIDTH * HEIGHT];
    hdrp_cull_depth depth = {texels, WIDTH, NULL};
    hdrp_cull_shape shapes[48];
    double ball[48][4];
    uint64_t state = 7u;
    scene s;
    uint32_t listed = 0u;
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        texels[i] = (float)(test_random(&state) < 0.1 ? 1000.0 : test_uniform(&state, 18.0, 22.0));
    }
    for (uint32_t i = 0; i < 48u; ++i) {
        double size = flat ? 1.0 : 0.5;
        ball[i][0] = test_uniform(&state, -50.0, 50.0) * size;
        ball[i][1] = test_uniform(&state, -40.0, 40.0) * size;
        ball[i][2] = test_uniform(&state, 14.0, 26.0);
        ball[i][3] = test_log_uniform(&state, 0.5, 30.0) * size;
        shapes[i] = hdrp_cull_shape_sphere(
            v3((float)-ball[i][0], (float)ball[i][1], (float)ball[i][2]), (float)ball[i][3], 0u);
    }
    s = scene_seen(desc_of(1u, HDRP_CULL_PIXELS), c, shapes, 48u);
    scene_build(&s, &depth);
    for (uint32_t tile = 0; tile < s.lists.grid.tiles.z * s.lists.grid.tiles.w; ++tile) {
        uint32_t x0 = tile % s.lists.grid.tiles.z * 16u, y0 = tile / s.lists.grid.tiles.z * 16u;
        hdrp_u32x4 cell = s.lists.cells[tile];
        for (uint32_t i = 0; i < 48u; ++i) {
            double gap = 1e9; /* of the pixel deepest inside to the rim, negative inside */
            bool found = false;
            for (uint32_t e = cell.x; e < hdrp_cull_last(cell, 3u); ++e) {
                found |= hdrp_cull_entry_index(s.lists.entries[e]) == i;
            }
            for (uint32_t y = y0; y < y0 + 16u && y < HEIGHT; ++y) {
                for (uint32_t x = x0; x < x0 + 16u && x < WIDTH; ++x) {
                    double z = (double)texels[y * WIDTH + x], k = flat ? 1.0 : 0.025 * z;
                    double dx = ((double)x + 0.5 - 50.0) * k - ball[i][0];
                    double dy = (40.0 - (double)y - 0.5) * k - ball[i][1], dz = z - ball[i][2];
                    double outside = sqrt(dx * dx + dy * dy + dz * dz) - ball[i][3];
                    gap = z < 100.0 && outside < gap ? outside : gap;
                }
            }
            assert_true(gap > -1e-4 || found);
            assert_true(gap < 1e-4 || !found);
            listed += found ? 1u : 0u;
        }
    }
    assert_true(listed > 100u);
    scene_free(&s);
}

static void balls_are_listed_where_pixels_are_reached(void** state)
{
    (void)state;
    expect_balls_where_pixels_are_reached(camera(), false);
    expect_balls_where_pixels_are_reached(map(), true);
}

/* A wall right in front of where a shape begins in a tile, or behind its end, is not reached. */
static void expect_reached(hdrp_cull_camera c, hdrp_cull_shape shape, uint32_t x, double nearest,
                           double farthest)
{
    static float texels[WIDTH * HEIGHT];
    const double walls[] = {nearest * 0.9997, nearest * 1.0003, farthest * 0.9997,
                            farthest * 1.0003};
    hdrp_cull_depth depth = {texels, WIDTH, NULL};
    for (int k = 0; k < 4; ++k) {
        scene s = scene_seen(desc_of(1u, 0u), c, &shape, 1u);
        for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
            texels[i] = (float)walls[k];
        }
        scene_build(&s, &depth);
        assert_string_equal(list_at(&s, x, 40, texels[0], 0u), k == 1 || k == 2 ? "0 " : "");
        scene_free(&s);
    }
}

/* Where a shape begins and ends on the left side of the tile at pixel 64, or on the axis of view,
 * in closed form. */
static void walls_beside_shapes_are_not_reached(void** state)
{
    const double left = 0.35, at = 14.0, chord = sqrt(100.0 - (1.0 + left * left) * 75.0);
    const double narrow = 3.0 * sqrt(2.0), wide = 12.0 * sqrt(2.0);
    hdrp_v3 oblique = v3(1, 0, 1), up = v3(0, 1, 0);
    hdrp_cull_shape ball = hdrp_cull_shape_sphere(v3(0, 0, 10), 5.0f, 0u);
    hdrp_cull_shape large = hdrp_cull_shape_sphere(v3(0, 0, 30), 20.0f, 0u);
    /* Of these |x| + |z - depth| is limited. */
    hdrp_cull_shape box = hdrp_cull_shape_box(v3(0, 0, 10), oblique, up, 3, 20, 3, 0u);
    hdrp_cull_shape block = hdrp_cull_shape_box(v3(0, 0, 30), oblique, up, 12, 50, 12, 0u);
    (void)state;
    expect_reached(camera(), ball, 50u, 5.0, 15.0);
    expect_reached(camera(), ball, 70u, (10.0 - chord) / (1.0 + left * left),
                   (10.0 + chord) / (1.0 + left * left));
    expect_reached(camera(), box, 70u, (10.0 - narrow) / (1.0 - left),
                   (10.0 + narrow) / (1.0 + left));
    expect_reached(map(), large, 50u, 10.0, 50.0);
    expect_reached(map(), large, 70u, 30.0 - sqrt(400.0 - at * at), 30.0 + sqrt(400.0 - at * at));
    expect_reached(map(), block, 70u, 30.0 - (wide - at), 30.0 + (wide - at));
}

static void rows_may_be_built_in_any_order(void** state)
{
    hdrp_cull_shape shapes[40];
    scene s, t;
    (void)state;
    for (uint32_t i = 0; i < 40u; ++i) {
        shapes[i] = hdrp_cull_shape_sphere(v3((float)i * 0.5f - 10.0f, (float)(i % 7u) - 3.0f, 10),
                                           0.5f + (float)(i % 3u), i & 3u);
    }
    s = scene_make(desc_of(16u, 0u), shapes, 40u);
    t = scene_make(desc_of(16u, 0u), shapes, 40u);
    scene_build(&s, NULL);
    for (uint32_t row = hdrp_cull_rows(&t.lists); row-- > 0u;) {
        assert_int_equal(
            hdrp_cull_build(&t.lists, &t.set, NULL, row, 1u, t.scratch, t.scratch_bytes), HDRP_OK);
    }
    assert_memory_equal(s.lists.cells, t.lists.cells, 35u * 16u * sizeof *s.lists.cells);
    for (uint32_t i = 0; i < 35u * 16u; ++i) {
        hdrp_u32x4 cell = s.lists.cells[i];
        for (uint32_t k = cell.x; k < hdrp_cull_last(cell, 3u); ++k) {
            assert_int_equal(s.lists.entries[k], t.lists.entries[k]);
        }
    }
    scene_free(&s);
    scene_free(&t);
}

/* Of 0.1 and 1000 m the far plane comes back as 999.99994 m. */
static void cleared_device_depth_is_sky(void** state)
{
    (void)state;
    for (hdrp_u32 reverse = 0u; reverse < 2u; ++reverse) {
        static float texels[WIDTH * HEIGHT];
        hdrp_depth_params device = hdrp_depth_params_perspective(0.1f, 1000.0f, reverse);
        hdrp_cull_depth depth = {texels, WIDTH, &device};
        hdrp_cull_shape shape = hdrp_cull_shape_sphere(v3(0, 0, 10), 1.0f, 0u);
        scene s = scene_make(desc_of(1u, 0u), &shape, 1u);
        hdrp_cull_camera c = hdrp_cull_camera_perspective(v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0),
                                                          -1.0f, 1.0f, -1.0f, 1.0f, 0.1f, 1000.0f);
        for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
            texels[i] = reverse ? 0.0f : 1.0f;
        }
        assert_int_equal(hdrp_cull_set_begin(&s.set, &c, WIDTH, HEIGHT, 1u), HDRP_OK);
        assert_int_equal(hdrp_cull_begin(&s.lists, &s.set), HDRP_OK);
        assert_int_equal(hdrp_cull_measure_depth(&s.lists, &depth, 0u, 1u), HDRP_OK);
        assert_true(s.lists.tiles[0].x > s.lists.tiles[0].y);
        scene_free(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cleared_device_depth_is_sky),
        cmocka_unit_test(sizes_that_are_out_of_range_need_no_memory),
        cmocka_unit_test(a_set_that_cannot_be_made_is_left_alone),
        cmocka_unit_test(shapes_are_projected_in_any_ranges),
        cmocka_unit_test(lists_that_cannot_be_made_are_left_alone),
        cmocka_unit_test(zeros_are_the_defaults),
        cmocka_unit_test(frames_and_ranges_are_checked),
        cmocka_unit_test(an_empty_set_gives_empty_lists),
        cmocka_unit_test(lists_are_ordered_by_category_and_index),
        cmocka_unit_test(masks_have_the_bits_of_lists),
        cmocka_unit_test(a_full_tile_drops_the_least_important_and_counts_them),
        cmocka_unit_test(light_features_are_the_union_over_the_lists_of_a_tile),
        cmocka_unit_test(light_features_of_what_was_dropped_do_not_count),
        cmocka_unit_test(light_features_of_a_bad_range_or_another_set_are_not_written),
        cmocka_unit_test(dropped_shapes_are_counted_in_64_bits),
        cmocka_unit_test(a_full_tile_never_loses_the_most_important_shape),
        cmocka_unit_test(depth_decides_what_a_tile_lists),
        cmocka_unit_test(blocks_are_those_whose_pixels_are_reached),
        cmocka_unit_test(masks_of_entries_are_the_pixels_that_are_reached),
        cmocka_unit_test(pixels_are_asked_at_their_centres),
        cmocka_unit_test(balls_are_listed_where_pixels_are_reached),
        cmocka_unit_test(walls_beside_shapes_are_not_reached),
        cmocka_unit_test(rows_may_be_built_in_any_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
