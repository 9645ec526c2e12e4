/* test_gpu_blockers.c - lists that blockers have shortened, against those of hdrp_cull_apply_blockers.
 * SPDX-License-Identifier: MIT */
#include "gpu_test.h"

#include "cull_blocker_world.h"

static gpu_device device;
static hdrp_gpu_vk gpu;

static int set_up(void** state)
{
    hdrp_gpu_vk_desc desc = gpu_desc(&device);
    (void)state;
    desc.passes = HDRP_GPU_VK_PASS_LISTS | HDRP_GPU_VK_PASS_BLOCKERS;
    return hdrp_gpu_vk_init(&gpu, &desc) != HDRP_OK;
}

static int tear_down(void** state)
{
    (void)state;
    hdrp_gpu_vk_destroy(&gpu);
    return device.messages != 0;
}

/* The world in buffers of the device, and what is read back. */
typedef struct buffers {
    hdrp_gpu_vk_buffer shapes, places, lights, links, blockers, masks, texels, cells, entries;
    hdrp_gpu_vk_image depth;
} buffers;

static hdrp_gpu_vk_buffer filled(const void* data, size_t bytes)
{
    return gpu_filled_buffer(&device, &gpu, data, bytes);
}

static hdrp_gpu_vk_array range_of(const hdrp_gpu_vk_buffer* b)
{
    const hdrp_gpu_vk_array r = {b->buffer, 0, b->bytes};
    return r;
}

static buffers make_buffers(const world* w, const grid* g)
{
    buffers b = {0};
    b.shapes = filled(w->shapes, sizeof w->shapes);
    b.places = filled(w->places, sizeof w->places);
    b.lights = filled(w->lights, sizeof w->lights);
    b.links = filled(w->links, sizeof w->links);
    b.blockers = filled(w->blockers, sizeof w->blockers);
    b.texels = filled(w->depth, sizeof w->depth);
    b.masks = gpu_host_buffer(&gpu, g->entries * sizeof(uint32_t));
    b.cells = gpu_host_buffer(&gpu, g->cells * sizeof(hdrp_u32x4));
    b.entries = gpu_host_buffer(&gpu, g->entries * sizeof(uint32_t));
    assert_int_equal(
        hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32_SFLOAT, BLOCKER_WIDTH, BLOCKER_HEIGHT,
                                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, NULL,
                                 &b.depth),
        HDRP_OK);
    return b;
}

static void destroy_buffers(buffers* b)
{
    hdrp_gpu_vk_buffer* const all[] = {&b->shapes, &b->places, &b->lights, &b->links,  &b->blockers,
                                       &b->masks,  &b->texels, &b->cells,  &b->entries};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
        hdrp_gpu_vk_buffer_destroy(&gpu, all[i]);
    }
    hdrp_gpu_vk_image_destroy(&gpu, &b->depth);
}

static hdrp_gpu_vk_blockers blockers_of(const world* w, const buffers* b)
{
    hdrp_gpu_vk_blockers r;
    r.places = range_of(&b->places);
    r.lights = range_of(&b->lights);
    r.links = range_of(&b->links);
    r.blockers = range_of(&b->blockers);
    r.masks = range_of(&b->masks);
    r.light_count = w->scene.light_count;
    return r;
}

static void run_on_device(const world* w, const grid* g, bool with_depth, buffers* b)
{
    const hdrp_gpu_vk_blockers blockers = blockers_of(w, b);
    const VkBufferCopy cells = {0, 0, b->cells.bytes}, entries = {0, 0, b->entries.bytes};
    hdrp_gpu_vk_cull_frame frame = {0};
    hdrp_gpu_vk_lists lists;
    VkCommandBuffer commands = gpu_begin(&device);
    frame.camera = w->camera;
    frame.shapes = b->shapes.buffer;
    frame.count = BLOCKER_SHAPES;
    gpu_upload(commands, &b->texels, &b->depth, VK_IMAGE_ASPECT_COLOR_BIT);
    if (with_depth) {
        frame.view = b->depth.view;
        frame.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    }
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &g->lists.desc, &lists), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_build_lists(&gpu, commands, &lists, &frame), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_apply_blockers(&gpu, commands, &lists, &blockers), HDRP_OK);
    vkCmdCopyBuffer(commands, lists.cells.buffer, b->cells.buffer, 1, &cells);
    vkCmdCopyBuffer(commands, lists.entries.buffer, b->entries.buffer, 1, &entries);
    gpu_run(&device);
    hdrp_gpu_vk_lists_destroy(&gpu, &lists);
}

/* Cells that differ, in their lights or in the masks of these. */
static unsigned differences(const grid* g, const buffers* b)
{
    const hdrp_u32x4* cells = gpu_map(&device, &b->cells);
    const uint32_t* entries = gpu_map(&device, &b->entries);
    const uint32_t* masks = gpu_map(&device, &b->masks);
    unsigned different = 0;
    for (size_t c = 0; c < g->cells; ++c) {
        hdrp_u32x4 cell = g->lists.cells[c];
        size_t first = cell.x, n = hdrp_cull_last(cell, 3) - cell.x;
        different += memcmp(&cells[c], &cell, sizeof cell) != 0 ||
                     memcmp(entries + first, g->lists.entries + first, 4 * n) != 0 ||
                     memcmp(masks + first, g->masks + first, 4 * n) != 0;
    }
    gpu_unmap(&device, &b->cells);
    gpu_unmap(&device, &b->entries);
    gpu_unmap(&device, &b->masks);
    return different;
}

static void lists_lose_what_those_of_the_cpu_lose(void** state)
{
    static world w;
    uint64_t seed = 3, removed = 0, cells = 0;
    unsigned different = 0;
    (void)state;
    for (uint32_t i = 0; i < 24; ++i) {
        const hdrp_cull_desc descs[] = {
            {.tile_width_px = 32, .tile_height_px = 32, .slice_count = 24},
            {.tile_width_px = 16, .tile_height_px = 16, .slice_count = 1},
            {.tile_width_px = 16,
             .tile_height_px = 16,
             .slice_count = 1,
             .flags = HDRP_CULL_MASKS}};
        bool with_depth = i % 3 == 2 || i % 4 < 2;
        grid g = {0};
        buffers b;
        make_world(&w, &seed, i % 2);
        build(&g, &w, descs[i % 3], with_depth);
        removed += apply(&g, 1).lights_removed;
        b = make_buffers(&w, &g);
        run_on_device(&w, &g, with_depth, &b);
        different += differences(&g, &b);
        cells += g.cells;
        destroy_buffers(&b);
        drop(&g);
    }
    printf("%llu lights left cells; %u of %llu cells differ\n", (unsigned long long)removed,
           different, (unsigned long long)cells);
    assert_true(removed > 1000);
    assert_true(different == 0 || (!device.is_lavapipe && different * 1000u < cells));
}

static void bad_ranges_are_refused(void** state)
{
    static world w;
    uint64_t seed = 1;
    grid g = {0};
    hdrp_gpu_vk_lists lists;
    VkCommandBuffer commands = gpu_begin(&device);
    (void)state;
    make_world(&w, &seed, false);
    build(&g, &w, (hdrp_cull_desc){.slice_count = 8}, true);
    buffers b = make_buffers(&w, &g);
    const hdrp_gpu_vk_blockers good = blockers_of(&w, &b);
    hdrp_gpu_vk_blockers bad = good;
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_lists_create(&gpu, &g.lists.desc, &lists), HDRP_OK);
#define EXPECT(context, commands_, lists_, blockers_, result)                                      \
    assert_int_equal(hdrp_gpu_vk_apply_blockers(context, commands_, lists_, blockers_), result)
    EXPECT(NULL, commands, &lists, &good, HDRP_ERROR_NULL_POINTER);
    EXPECT(&gpu, NULL, &lists, &good, HDRP_ERROR_NULL_POINTER);
    EXPECT(&gpu, commands, NULL, &good, HDRP_ERROR_NULL_POINTER);
    EXPECT(&gpu, commands, &lists, NULL, HDRP_ERROR_NULL_POINTER);
    bad.links.buffer = VK_NULL_HANDLE;
    EXPECT(&gpu, commands, &lists, &bad, HDRP_ERROR_NULL_POINTER);
    bad = good, bad.places.bytes -= 1;
    EXPECT(&gpu, commands, &lists, &bad, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.lights.bytes = 4;
    EXPECT(&gpu, commands, &lists, &bad, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.masks.bytes -= 4;
    EXPECT(&gpu, commands, &lists, &bad, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.blockers.bytes = 79;
    EXPECT(&gpu, commands, &lists, &bad, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.links.bytes = 0;
    EXPECT(&gpu, commands, &lists, &bad, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.light_count = 1025;
    EXPECT(&gpu, commands, &lists, &bad, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.light_count = 0;
    EXPECT(&gpu, commands, &lists, &bad, HDRP_OK);
    assert_int_equal(gpu.passes_recorded, 0);
    gpu_run(&device);
    hdrp_gpu_vk_lists_destroy(&gpu, &lists);
    destroy_buffers(&b);
    drop(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_lose_what_those_of_the_cpu_lose),
        cmocka_unit_test(bad_ranges_are_refused),
    };
    int failed;
    if (!gpu_open(&device)) {
        return GPU_SKIPPED;
    }
    failed = cmocka_run_group_tests(tests, set_up, tear_down);
    gpu_close(&device);
    return failed;
}
