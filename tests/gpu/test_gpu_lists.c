/* test_gpu_lists.c - lists that the device builds, against those of hdrp_cull.h.
 * SPDX-License-Identifier: MIT
 *
 * On lavapipe, which divides and takes roots as the C compiler does, all is equal to the bit. On any
 * device both are held to the scenes' exact pairs by tests/cull; here what only one of them lists is
 * counted and printed. */
#include "gpu_test.h"

#include "cull_generate.h"
#include "cull_hash.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static gpu_device device;
static hdrp_gpu_vk gpu;

static int set_up(void** state)
{
    const hdrp_gpu_vk_desc desc = gpu_desc(&device);
    (void)state;
    return hdrp_gpu_vk_init(&gpu, &desc) != HDRP_OK;
}

static int tear_down(void** state)
{
    (void)state;
    hdrp_gpu_vk_destroy(&gpu);
    return device.messages != 0;
}

/* What lists are made of, and those of the CPU. */
typedef struct scene {
    hdrp_cull_desc desc;
    hdrp_cull_camera camera;
    const hdrp_cull_shape* shapes;
    uint32_t count;
    const float* texels; /* NULL: no depth */
    const hdrp_depth_params* device;
    hdrp_cull_set set;
    hdrp_cull_lists lists;
    void *set_memory, *lists_memory;
} scene;

static void build_on_cpu(scene* s)
{
    size_t set_bytes = hdrp_cull_set_memory_size(s->count ? s->count : 1);
    size_t bytes = hdrp_cull_memory_size(&s->desc);
    size_t scratch_bytes = hdrp_cull_scratch_size(&s->desc);
    void* scratch = cull_allocate(scratch_bytes);
    hdrp_cull_depth depth = {s->texels, s->desc.width_px, s->device};
    s->set_memory = cull_allocate(set_bytes);
    s->lists_memory = cull_allocate(bytes);
    assert_int_equal(hdrp_cull_set_init(&s->set, s->count ? s->count : 1, s->set_memory, set_bytes),
                     HDRP_OK);
    assert_int_equal(hdrp_cull_init(&s->lists, &s->desc, s->lists_memory, bytes), HDRP_OK);
    assert_int_equal(
        hdrp_cull_set_begin(&s->set, &s->camera, s->desc.width_px, s->desc.height_px, s->count),
        HDRP_OK);
    assert_int_equal(hdrp_cull_set_project(&s->set, s->shapes, 0, s->count), HDRP_OK);
    assert_int_equal(hdrp_cull_begin(&s->lists, &s->set), HDRP_OK);
    if (s->texels) {
        assert_int_equal(hdrp_cull_measure_depth(&s->lists, &depth, 0, s->lists.grid.tiles.w),
                         HDRP_OK);
    }
    assert_int_equal(hdrp_cull_build(&s->lists, &s->set, s->texels ? &depth : NULL, 0,
                                     hdrp_cull_rows(&s->lists), scratch, scratch_bytes),
                     HDRP_OK);
    free(scratch);
}

static void scene_free(scene* s)
{
    free(s->set_memory);
    free(s->lists_memory);
}

/* The lists of the device, read back. */
typedef struct found {
    hdrp_gpu_vk_lists lists;
    hdrp_gpu_vk_buffer tiles, cells, entries, masks, dropped;
} found;

static void copy_back(VkCommandBuffer commands, const hdrp_gpu_vk_buffer* from,
                      hdrp_gpu_vk_buffer* to)
{
    VkBufferCopy region = {0, 0, from->bytes};
    if (from->buffer) {
        *to = gpu_host_buffer(&gpu, from->bytes);
        vkCmdCopyBuffer(commands, from->buffer, to->buffer, 1, &region);
    }
}

static found build_on_device(const scene* s)
{
    found f = {0};
    hdrp_gpu_vk_cull_frame frame = {0};
    VkDeviceSize bytes = (s->count ? s->count : 1) * sizeof *s->shapes;
    hdrp_gpu_vk_buffer shapes = gpu_host_buffer(&gpu, bytes), texels = {0};
    hdrp_gpu_vk_image depth = {0};
    VkCommandBuffer commands = gpu_begin(&device);
    size_t pixels = (size_t)s->desc.width_px * s->desc.height_px;
    if (s->count) {
        memcpy(gpu_map(&device, &shapes), s->shapes, s->count * sizeof *s->shapes);
        gpu_unmap(&device, &shapes);
    }
    frame.camera = s->camera;
    frame.shapes = shapes.buffer;
    frame.count = s->count;
    if (s->texels) {
        texels = gpu_host_buffer(&gpu, pixels * sizeof(float));
        memcpy(gpu_map(&device, &texels), s->texels, pixels * sizeof(float));
        gpu_unmap(&device, &texels);
        assert_int_equal(hdrp_gpu_vk_image_create(
                             &gpu, VK_FORMAT_R32_SFLOAT, s->desc.width_px, s->desc.height_px,
                             VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, "depth",
                             &depth),
                         HDRP_OK);
        gpu_upload(commands, &texels, &depth, VK_IMAGE_ASPECT_COLOR_BIT);
        frame.view = depth.view;
        frame.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        frame.device = s->device;
    }
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &s->desc, &f.lists), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, &f.lists, &frame), HDRP_OK);
    copy_back(commands, &f.lists.tiles, &f.tiles);
    copy_back(commands, &f.lists.cells, &f.cells);
    copy_back(commands, &f.lists.entries, &f.entries);
    copy_back(commands, &f.lists.masks, &f.masks);
    copy_back(commands, &f.lists.dropped, &f.dropped);
    gpu_run(&device);
    hdrp_gpu_vk_buffer_destroy(&gpu, &shapes);
    hdrp_gpu_vk_buffer_destroy(&gpu, &texels);
    hdrp_gpu_vk_image_destroy(&gpu, &depth);
    return f;
}

static void found_free(found* f)
{
    hdrp_gpu_vk_buffer_destroy(&gpu, &f->tiles);
    hdrp_gpu_vk_buffer_destroy(&gpu, &f->cells);
    hdrp_gpu_vk_buffer_destroy(&gpu, &f->entries);
    hdrp_gpu_vk_buffer_destroy(&gpu, &f->masks);
    hdrp_gpu_vk_buffer_destroy(&gpu, &f->dropped);
    hdrp_gpu_vk_lists_destroy(&gpu, &f->lists);
}

/* Entries of all cells, and of those how many only one of the two lists has. */
typedef struct tally {
    uint64_t entries, only_cpu, only_device;
    unsigned unequal; /* scenes */
} tally;

static int by_value(const void* a, const void* b)
{
    uint32_t x = *(const uint32_t*)a & 0xffffu, y = *(const uint32_t*)b & 0xffffu;
    return x < y ? -1 : x > y;
}

static uint32_t sorted(const uint32_t* entries, hdrp_u32x4 cell, uint32_t end, uint32_t** copy)
{
    uint32_t n = hdrp_cull_last(cell, 3) - cell.x;
    assert_in_range(cell.x, 0, end);
    assert_in_range(n, 0, end - cell.x);
    *copy = malloc((n + 1) * sizeof **copy);
    assert_non_null(*copy);
    memcpy(*copy, entries + cell.x, n * sizeof **copy);
    qsort(*copy, n, sizeof **copy, by_value);
    return n;
}

static void count_differences(const uint32_t* a, uint32_t na, const uint32_t* b, uint32_t nb,
                              tally* t)
{
    uint32_t i = 0, j = 0;
    while (i < na || j < nb) {
        uint32_t x = i < na ? a[i] & 0xffffu : 0x10000u, y = j < nb ? b[j] & 0xffffu : 0x10000u;
        t->only_cpu += x < y;
        t->only_device += y < x;
        i += x <= y;
        j += y <= x;
    }
}

static void compare(const scene* s, const found* f, tally* t)
{
    const hdrp_cull_lists* l = &s->lists;
    size_t tiles = (size_t)l->grid.tiles.z * l->grid.tiles.w, cells = tiles * l->grid.cells.x;
    size_t words = l->masks ? hdrp_cull_mask_words(l->grid) : 0;
    uint32_t end = (uint32_t)tiles * l->desc.entry_capacity;
    const hdrp_u32x4* found_cells = gpu_map(&device, &f->cells);
    const uint32_t* found_entries = gpu_map(&device, &f->entries);
    const uint32_t* found_masks = l->masks ? gpu_map(&device, &f->masks) : NULL;
    bool same = memcmp(gpu_map(&device, &f->tiles), l->tiles, tiles * sizeof *l->tiles) == 0 &&
                memcmp(found_cells, l->cells, cells * sizeof *l->cells) == 0 &&
                memcmp(gpu_map(&device, &f->dropped), l->tile_dropped, tiles * 4) == 0;
    assert_memory_equal(&f->lists.grid, &l->grid, sizeof l->grid);
    assert_memory_equal(&f->lists.desc, &l->desc, sizeof l->desc);
    for (size_t c = 0; c < cells; ++c) {
        uint32_t first = l->cells[c].x, n = hdrp_cull_last(l->cells[c], 3) - first;
        uint32_t *a, *b, na = sorted(l->entries, l->cells[c], end, &a),
                         nb = sorted(found_entries, found_cells[c], end, &b);
        count_differences(a, na, b, nb, t);
        t->entries += na;
        same = same && memcmp(found_entries + first, l->entries + first, n * 4u) == 0 &&
               (!l->masks ||
                memcmp(found_masks + first * words, l->masks + first * words, n * words * 4u) == 0);
        free(a);
        free(b);
    }
    gpu_unmap(&device, &f->tiles);
    gpu_unmap(&device, &f->cells);
    gpu_unmap(&device, &f->entries);
    gpu_unmap(&device, &f->dropped);
    if (found_masks) {
        gpu_unmap(&device, &f->masks);
    }
    t->unequal += !same;
}

static void check(scene* s, tally* t, const char* what, uint32_t index)
{
    unsigned before = t->unequal;
    found f;
    build_on_cpu(s);
    f = build_on_device(s);
    compare(s, &f, t);
    if (t->unequal > before) {
        printf("%s %u: lists differ\n", what, (unsigned)index);
    }
    scene_free(s);
    found_free(&f);
}

/* Those of other devices may differ in what rounding decides: a ten thousandth of the entries. */
static void check_tally(const tally* t)
{
    printf("%llu entries; only on the CPU %llu, only on the device %llu\n",
           (unsigned long long)t->entries, (unsigned long long)t->only_cpu,
           (unsigned long long)t->only_device);
    assert_true((t->only_cpu + t->only_device) * 10000u <= t->entries);
    assert_true(!device.is_lavapipe || t->unequal == 0);
}

/* The scenes whose hashes all compilers agree on: all kinds, cameras, flags; lists that are full. */
static void lists_of_all_kinds_are_those_of_the_cpu(void** state)
{
    static cull_hash_scene all;
    tally t = {0};
    (void)state;
    for (uint32_t i = 0; i < CULL_HASH_SCENES; ++i) {
        scene s = {0};
        cull_hash_scene_make(&all, i);
        s.desc = all.desc;
        s.camera = all.camera;
        s.shapes = all.shapes;
        s.count = all.count;
        s.texels = all.texels;
        if (s.desc.flags & (HDRP_CULL_PIXELS | HDRP_CULL_BLOCKS | HDRP_CULL_MASKS)) {
            s.desc.tile_width_px = s.desc.tile_width_px > 32 ? 32 : s.desc.tile_width_px;
            s.desc.tile_height_px = s.desc.tile_height_px > 32 ? 32 : s.desc.tile_height_px;
        }
        check(&s, &t, "scene", i);
        free(all.texels);
    }
    check_tally(&t);
}

/* The culling grid of tests/cull: random lights in front of all cameras, metres and device depth. */
static void lists_of_random_scenes_are_those_of_the_cpu(void** state)
{
    tally t = {0};
    (void)state;
    for (uint32_t i = 0; i < 120; ++i) {
        const cull_recipe how = {(cull_view)(i % CULL_VIEWS), i % 8 == 5, i % 3 == 0, 5, 4, 40};
        cull_test_scene random;
        scene s = {0};
        cull_random_scene(&random, i, &how);
        assert_true(cull_scene_run(&random));
        s.desc = random.desc;
        s.camera = random.camera;
        s.shapes = random.shapes;
        s.count = random.count;
        s.texels = random.texels;
        s.device = random.device;
        check(&s, &t, "seed", i);
        cull_scene_free(&random);
    }
    check_tally(&t);
}

/* Small, empty, and more than a batch of the shader in one tile. */
static void lists_without_room_or_lights_are_those_of_the_cpu(void** state)
{
    static hdrp_cull_shape shapes[3000];
    static float texels[64 * 64];
    const uint32_t counts[] = {0, 1, 64, 65, 1023, 1024, 1025, 3000};
    tally t = {0};
    (void)state;
    for (uint32_t i = 0; i < 3000; ++i) {
        hdrp_v3 p = hdrp_v3_make((float)(i % 7) - 3.0f, (float)(i % 5) - 2.0f, -3.0f);
        shapes[i] = hdrp_cull_shape_sphere(p, 4.0f + (float)(i % 11), i * 4u / 3000u);
        shapes[i].bits.w = hdrp_bits_from_f32((float)(hdrp_hash2(i, 1u) % 97u));
    }
    for (uint32_t i = 0; i < 64 * 64; ++i) {
        texels[i] = 2.0f + (float)(i % 9);
    }
    for (uint32_t i = 0; i < 8 * 8; ++i) {
        const uint32_t flags[] = {0, HDRP_CULL_PIXELS, HDRP_CULL_MASKS, 0};
        scene s = {0};
        s.desc.width_px = i & 1 ? 64 : 1;
        s.desc.height_px = i & 1 ? 50 : 1;
        s.desc.flags = flags[i / 2 % 4];
        s.desc.slice_count = i / 2 % 4 == 3 ? 70 : 1;
        s.desc.shape_capacity = 3000;
        s.desc.entry_capacity = i & 1 ? (s.desc.flags ? 150 : 900) : 0;
        s.camera = hdrp_cull_camera_perspective(hdrp_v3_splat(0.0f), hdrp_v3_make(0, 0, -1),
                                                hdrp_v3_make(0, 1, 0), -1, 1, -1, 1, 0.1f, 100.0f);
        s.shapes = shapes;
        /* Mesa's lavapipe leaves a shader's loops after 65535 turns: too few for more pixels. */
        s.count = counts[i / 8];
        s.count = device.is_lavapipe && s.desc.flags && s.count > 200 ? 200 : s.count;
        s.texels = texels;
        check(&s, &t, "size", i);
    }
    check_tally(&t);
}

static void bad_input_is_refused_and_records_nothing(void** state)
{
    const hdrp_cull_desc good = {.width_px = 64, .height_px = 64};
    hdrp_cull_desc desc = good;
    hdrp_gpu_vk_lists lists, before;
    hdrp_gpu_vk_cull_frame frame = {0};
    VkCommandBuffer commands = gpu_begin(&device);
    (void)state;
    memset(&lists, 0x5a, sizeof lists);
    before = lists;
    assert_int_equal(hdrp_gpu_vk_lists_create(NULL, &good, &lists), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, NULL, &lists), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &good, NULL), HDRP_ERROR_NULL_POINTER);
    desc.width_px = 0;
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &desc, &lists), HDRP_ERROR_BAD_ARGUMENT);
    desc.width_px = desc.height_px = 16384;
    desc.tile_width_px = desc.tile_height_px = 1;
    desc.slice_count = 256;
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &desc, &lists), HDRP_ERROR_TOO_LARGE);
    desc = good;
    desc.slice_count = 1;
    desc.tile_width_px = desc.tile_height_px = 36;
    desc.flags = HDRP_CULL_PIXELS;
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &desc, &lists), HDRP_ERROR_UNSUPPORTED);
    assert_memory_equal(&lists, &before, sizeof lists);
    desc.tile_width_px = desc.tile_height_px = 32;
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &desc, &lists), HDRP_OK);
    frame.camera = hdrp_cull_camera_orthographic(hdrp_v3_splat(0), hdrp_v3_splat(1),
                                                 hdrp_v3_make(0, 1, 0), -1, 1, -1, 1, 1, 2);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_build_lists(NULL, commands, &lists, &frame),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, NULL, &lists, &frame), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, NULL, &frame),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, &lists, NULL),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, &lists, &frame),
                     HDRP_ERROR_NULL_POINTER); /* pixels without depth */
    hdrp_gpu_vk_lists_destroy(&gpu, &lists);
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, &lists, &frame),
                     HDRP_ERROR_NULL_POINTER); /* of zeros */
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &good, &lists), HDRP_OK);
    frame.count = 1;
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, &lists, &frame),
                     HDRP_ERROR_NULL_POINTER);
    frame.shapes = lists.shapes.buffer; /* any */
    frame.count = 1025;
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, &lists, &frame),
                     HDRP_ERROR_BAD_ARGUMENT);
    frame.count = 1;
    frame.shapes_offset = 4;
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, &lists, &frame),
                     gpu.buffer_alignment > 4 ? HDRP_ERROR_BAD_ARGUMENT : HDRP_OK);
    gpu_run(&device);
    hdrp_gpu_vk_lists_destroy(&gpu, &lists);
    hdrp_gpu_vk_lists_destroy(&gpu, &lists);
    hdrp_gpu_vk_lists_destroy(&gpu, NULL);
    hdrp_gpu_vk_lists_destroy(NULL, &lists);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_of_all_kinds_are_those_of_the_cpu),
        cmocka_unit_test(lists_of_random_scenes_are_those_of_the_cpu),
        cmocka_unit_test(lists_without_room_or_lights_are_those_of_the_cpu),
        cmocka_unit_test(bad_input_is_refused_and_records_nothing),
    };
    int failed;
    if (!gpu_open(&device)) {
        return GPU_SKIPPED;
    }
    failed = cmocka_run_group_tests(tests, set_up, tear_down);
    gpu_close(&device);
    return failed;
}
