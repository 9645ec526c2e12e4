/* test_gpu_passes.c - every pass against the function of the CPU that it stands for.
 * SPDX-License-Identifier: MIT */
#include "gpu_test.h"

#include <math.h>
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

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static double random_number(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* ---- FGD ------------------------------------------------------------------------------------- */

/* The table of the device, as the host buffer of a readback. */
static hdrp_gpu_vk_buffer bake(VkFormat format, uint32_t size, VkDeviceSize texel_bytes)
{
    hdrp_gpu_vk_image table;
    hdrp_gpu_vk_buffer back = gpu_host_buffer(&gpu, size * size * texel_bytes);
    VkCommandBuffer commands;
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, format, size, size,
                                              VK_IMAGE_USAGE_STORAGE_BIT |
                                                  VK_IMAGE_USAGE_SAMPLED_BIT |
                                                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                              "fgd", &table),
                     HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    commands = gpu_begin(&device);
    /* Twice: contents and layout before do not matter. */
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &table), HDRP_OK);
    if (size < 8) {
        assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &table), HDRP_OK);
    }
    gpu_download(commands, &table, &back);
    gpu_run(&device);
    hdrp_gpu_vk_image_destroy(&gpu, &table);
    return back;
}

static hdrp_brdf_fgd* cpu_table(uint32_t size)
{
    hdrp_brdf_fgd* table = malloc(size * size * sizeof *table);
    assert_non_null(table);
    assert_int_equal(hdrp_brdf_fgd_bake_rows(table, (int)size, 0, (int)size), HDRP_OK);
    return table;
}

static void the_table_of_fgd_is_that_of_the_cpu(void** state)
{
    const uint32_t sizes[] = {2, 3, 24, 64};
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; ++s) {
        uint32_t size = sizes[s];
        hdrp_brdf_fgd* expected = cpu_table(size);
        hdrp_gpu_vk_buffer back = bake(VK_FORMAT_R32G32_SFLOAT, size, 8);
        const hdrp_brdf_fgd* found = gpu_map(&device, &back);
        float worst = 0.0f;
        for (uint32_t i = 0; i < size * size; ++i) {
            worst = fmaxf(worst, fabsf(found[i].albedo - expected[i].albedo));
            worst = fmaxf(worst, fabsf(found[i].schlick - expected[i].schlick));
            assert_true(found[i].schlick >= 0.0f && found[i].schlick <= found[i].albedo);
            assert_true(found[i].albedo <= 1.0f);
        }
        printf("FGD of size %u: off by up to %.2g\n", size, (double)worst);
        assert_true(worst <= 1.5e-4f);
        gpu_unmap(&device, &back);
        hdrp_gpu_vk_buffer_destroy(&gpu, &back);
        free(expected);
    }
}

static void a_table_of_16_bits_is_rounded_once(void** state)
{
    hdrp_brdf_fgd* expected = cpu_table(8);
    hdrp_gpu_vk_buffer back = bake(VK_FORMAT_R16G16_UNORM, 8, 4);
    const uint16_t* found = gpu_map(&device, &back);
    (void)state;
    for (uint32_t i = 0; i < 64; ++i) {
        assert_true(fabsf((float)found[2 * i] / 65535.0f - expected[i].albedo) < 1.6e-4f);
        assert_true(fabsf((float)found[2 * i + 1] / 65535.0f - expected[i].schlick) < 1.6e-4f);
    }
    gpu_unmap(&device, &back);
    hdrp_gpu_vk_buffer_destroy(&gpu, &back);
    free(expected);
}

static void tables_that_are_none_are_refused(void** state)
{
    hdrp_gpu_vk_image table = {0};
    hdrp_gpu_vk_image bad;
    VkCommandBuffer commands = gpu_begin(&device);
    (void)state;
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32G32_SFLOAT, 4, 4,
                                              VK_IMAGE_USAGE_STORAGE_BIT, NULL, &table),
                     HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_fgd_bake(NULL, commands, &table), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, NULL, &table), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, NULL), HDRP_ERROR_NULL_POINTER);
    bad = table;
    bad.view = VK_NULL_HANDLE;
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &bad), HDRP_ERROR_NULL_POINTER);
    bad = table;
    bad.height_px = 3;
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &bad), HDRP_ERROR_BAD_ARGUMENT);
    bad.width_px = bad.height_px = 1;
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &bad), HDRP_ERROR_BAD_ARGUMENT);
    bad.width_px = bad.height_px = 4097;
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &bad), HDRP_ERROR_BAD_ARGUMENT);
    bad = table;
    bad.format = VK_FORMAT_D32_SFLOAT;
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &bad), HDRP_ERROR_UNSUPPORTED);
    assert_int_equal(gpu.passes_recorded, 0);
    gpu_run(&device);
    hdrp_gpu_vk_image_destroy(&gpu, &table);
}

/* ---- depth ----------------------------------------------------------------------------------- */

typedef struct picture {
    hdrp_cull_desc desc;
    hdrp_cull_camera camera;
    const hdrp_depth_params* params; /* NULL: metres */
    float* texels;
} picture;

static size_t pixels_of(const picture* p)
{
    return (size_t)p->desc.width_px * p->desc.height_px;
}

/* Tiles of the CPU, to be freed with their memory, which begins the block. */
static hdrp_v4* cpu_tiles(const picture* p, hdrp_cull_grid* grid)
{
    hdrp_cull_depth depth = {p->texels, p->desc.width_px, p->params};
    size_t bytes = hdrp_cull_memory_size(&p->desc);
    void* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    void* set_memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, hdrp_cull_set_memory_size(1));
    hdrp_cull_lists lists;
    hdrp_cull_set set;
    hdrp_v4* tiles;
    size_t count;
    assert_int_equal(hdrp_cull_init(&lists, &p->desc, memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_set_init(&set, 1, set_memory, hdrp_cull_set_memory_size(1)),
                     HDRP_OK);
    assert_int_equal(hdrp_cull_set_begin(&set, &p->camera, p->desc.width_px, p->desc.height_px, 0),
                     HDRP_OK);
    assert_int_equal(hdrp_cull_begin(&lists, &set), HDRP_OK);
    assert_int_equal(hdrp_cull_measure_depth(&lists, &depth, 0, lists.grid.tiles.w), HDRP_OK);
    *grid = lists.grid;
    count = (size_t)grid->tiles.z * grid->tiles.w;
    tiles = malloc(count * sizeof *tiles);
    assert_non_null(tiles);
    memcpy(tiles, lists.tiles, count * sizeof *tiles);
    free(set_memory);
    free(memory);
    return tiles;
}

static hdrp_gpu_vk_depth depth_of(const picture* p, const hdrp_gpu_vk_image* image,
                                  hdrp_cull_grid grid, const hdrp_gpu_vk_buffer* tiles)
{
    hdrp_gpu_vk_depth depth = {0};
    depth.view = image->view;
    depth.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    depth.width_px = p->desc.width_px;
    depth.height_px = p->desc.height_px;
    depth.device = p->params;
    depth.camera = p->camera;
    depth.grid = grid;
    depth.flags = p->desc.flags;
    depth.tiles = tiles->buffer;
    return depth;
}

static void expect_same_tiles(const hdrp_v4* found, const hdrp_v4* expected, size_t count,
                              bool to_the_bit)
{
    if (to_the_bit) {
        assert_memory_equal(found, expected, count * sizeof *found);
        return;
    }
    for (size_t i = 0; i < count; ++i) {
        const float* a = &found[i].x;
        const float* b = &expected[i].x;
        for (int k = 0; k < 4; ++k) {
            assert_true(fabsf(a[k] - b[k]) <= 1e-6f * fabsf(b[k]));
        }
    }
}

/* Both ways of measuring a picture give the same tiles, and what is beside them is left alone. */
static void expect_parity(const picture* p, bool depth_format)
{
    hdrp_cull_grid grid;
    hdrp_v4* expected = cpu_tiles(p, &grid);
    size_t count = (size_t)grid.tiles.z * grid.tiles.w;
    hdrp_gpu_vk_buffer texels = gpu_host_buffer(&gpu, pixels_of(p) * sizeof(float));
    hdrp_gpu_vk_buffer tiles = gpu_host_buffer(&gpu, (count + 1) * sizeof(hdrp_v4) + 256);
    VkImageAspectFlags aspect =
        depth_format ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    const VkBufferCopy copied = {.srcOffset = 256, .size = sizeof(float)};
    hdrp_gpu_vk_image image;
    hdrp_gpu_vk_depth depth;
    VkCommandBuffer commands;
    unsigned char* bytes;
    if (depth_format) {
        image = gpu_depth_image(&device, p->desc.width_px, p->desc.height_px);
    } else {
        assert_int_equal(hdrp_gpu_vk_image_create(
                             &gpu, VK_FORMAT_R32_SFLOAT, p->desc.width_px, p->desc.height_px,
                             VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, "depth",
                             &image),
                         HDRP_OK);
    }
    memcpy(gpu_map(&device, &texels), p->texels, pixels_of(p) * sizeof(float));
    gpu_unmap(&device, &texels);
    bytes = gpu_map(&device, &tiles);
    memset(bytes, 0x5a, (size_t)tiles.bytes);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 1), HDRP_OK);
    commands = gpu_begin(&device);
    gpu_upload(commands, &texels, &image, aspect);
    depth = depth_of(p, &image, grid, &tiles);
    depth.tiles_offset = 256;
    /* Twice, the other way at first: what is written last counts. The copy between them sees the
     * first, and needs no barrier of ours. */
    depth.flags ^= HDRP_CULL_ONE_SERIES;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &depth), HDRP_OK);
    vkCmdCopyBuffer(commands, tiles.buffer, texels.buffer, 1, &copied);
    depth.flags ^= HDRP_CULL_ONE_SERIES;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &depth), HDRP_OK);
    gpu_run(&device);
    expect_same_tiles((const hdrp_v4*)(bytes + 256), expected, count, device.is_lavapipe);
    assert_int_equal(bytes[255], 0x5a);
    assert_int_equal(bytes[256 + count * sizeof(hdrp_v4)], 0x5a);
    gpu_unmap(&device, &tiles);
    if (depth_format) {
        gpu_image_destroy(&device, &image);
    } else {
        hdrp_gpu_vk_image_destroy(&gpu, &image);
    }
    hdrp_gpu_vk_buffer_destroy(&gpu, &tiles);
    hdrp_gpu_vk_buffer_destroy(&gpu, &texels);
    free(expected);
}

/* Depths from nothing to beyond the far distance, sky, and what is no depth at all. Whole tiles
 * of sky come from a coarse pattern. */
static void fill_metres(picture* p, uint64_t seed)
{
    const float odd[] = {(float)NAN, (float)INFINITY, -(float)INFINITY, -1.0f, 0.0f,  -0.0f,
                         0.5f,       100.0f,          99.9999f,         1e30f, 1e-30f};
    uint64_t random = seed;
    for (size_t i = 0; i < pixels_of(p); ++i) {
        size_t x = i % p->desc.width_px, y = i / p->desc.width_px;
        double r = random_number(&random);
        p->texels[i] = (float)(0.2 * pow(1000.0, random_number(&random)));
        if (r < 0.2) {
            p->texels[i] = odd[(size_t)(r * 5.0 * sizeof odd / sizeof odd[0])];
        }
        if ((x / 24 + y / 24) % 3 == 1) {
            p->texels[i] = r < 0.5 ? (float)NAN : 1e9f;
        }
    }
}

static picture picture_of(uint32_t width, uint32_t height, uint32_t tile_width,
                          uint32_t tile_height, uint32_t slices, uint32_t flags)
{
    picture p = {0};
    p.desc.width_px = width;
    p.desc.height_px = height;
    p.desc.tile_width_px = tile_width;
    p.desc.tile_height_px = tile_height;
    p.desc.slice_count = slices;
    p.desc.flags = flags;
    p.camera = hdrp_cull_camera_perspective(hdrp_v3_splat(0.0f), hdrp_v3_make(0.0f, 0.0f, -1.0f),
                                            hdrp_v3_make(0.0f, 1.0f, 0.0f), -1.0f, 1.0f, -1.0f,
                                            1.0f, 0.5f, 100.0f);
    p.texels = malloc(pixels_of(&p) * sizeof(float));
    assert_non_null(p.texels);
    return p;
}

/* Sizes of pictures and tiles that divide each other, and that do not. */
static const uint32_t shapes[][5] = {{1, 1, 0, 0, 0},     {1, 1, 16, 16, 1},  {64, 64, 16, 16, 1},
                                     {33, 17, 16, 8, 1},  {130, 67, 0, 0, 0}, {97, 1, 5, 3, 7},
                                     {50, 50, 64, 64, 1}, {40, 24, 1, 1, 2},  {70, 70, 7, 70, 256}};

static void depths_in_metres_are_measured_as_on_the_cpu(void** state)
{
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; ++i) {
        for (uint32_t flags = 0; flags <= HDRP_CULL_ONE_SERIES; flags += HDRP_CULL_ONE_SERIES) {
            const uint32_t* s = shapes[i];
            picture p = picture_of(s[0], s[1], s[2], s[3], s[4], flags);
            fill_metres(&p, 7 + i);
            expect_parity(&p, false);
            free(p.texels);
        }
    }
}

static void odd_depths_of_one_pixel_are_measured_as_on_the_cpu(void** state)
{
    const float odd[] = {(float)NAN, -(float)NAN, (float)INFINITY, -1.0f,    0.0f,  -0.0f,
                         1e-40f,     0.5f,        99.9998f,        99.9999f, 100.0f};
    picture p = picture_of(1, 1, 0, 0, 0, 0);
    (void)state;
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
        p.texels[0] = odd[i];
        expect_parity(&p, false);
    }
    free(p.texels);
}

static void device_depth_is_measured_as_on_the_cpu(void** state)
{
    const hdrp_depth_params params[] = {hdrp_depth_params_perspective(0.5f, 100.0f, 1),
                                        hdrp_depth_params_perspective(0.5f, 100.0f, 0),
                                        hdrp_depth_params_perspective(0.5f, HDRP_DEPTH_INFINITE, 1),
                                        hdrp_depth_params_orthographic(0.5f, 100.0f, 1)};
    (void)state;
    for (size_t i = 0; i < sizeof params / sizeof params[0]; ++i) {
        for (int depth_format = 0; depth_format < 2; ++depth_format) {
            picture p = picture_of(100, 37, 16, 16, 1, 0);
            uint64_t random = i;
            p.params = &params[i];
            for (size_t k = 0; k < pixels_of(&p); ++k) {
                float z = (float)(0.5 * pow(200.0, random_number(&random)));
                float cleared = i == 1 ? 1.0f : 0.0f;
                p.texels[k] = k % 100 < 40 ? cleared : hdrp_device_depth(params[i], z);
            }
            expect_parity(&p, depth_format != 0);
            free(p.texels);
        }
    }
}

static void depths_that_are_none_are_refused(void** state)
{
    picture p = picture_of(8, 8, 4, 4, 1, 0);
    hdrp_cull_grid grid;
    hdrp_gpu_vk_buffer tiles = gpu_host_buffer(&gpu, 4096);
    hdrp_gpu_vk_image image;
    hdrp_gpu_vk_depth good, bad;
    VkCommandBuffer commands = gpu_begin(&device);
    (void)state;
    fill_metres(&p, 1);
    free(cpu_tiles(&p, &grid));
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32_SFLOAT, 8, 8,
                                              VK_IMAGE_USAGE_SAMPLED_BIT, NULL, &image),
                     HDRP_OK);
    good = depth_of(&p, &image, grid, &tiles);
    assert_int_equal(hdrp_gpu_vk_measure_depth(NULL, commands, &good), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, NULL, &good), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, NULL), HDRP_ERROR_NULL_POINTER);
    bad = good;
    bad.view = VK_NULL_HANDLE;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &bad), HDRP_ERROR_NULL_POINTER);
    bad = good;
    bad.tiles = VK_NULL_HANDLE;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &bad), HDRP_ERROR_NULL_POINTER);
    bad = good;
    bad.width_px = 9;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &bad), HDRP_ERROR_BAD_ARGUMENT);
    bad.width_px = 0;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &bad), HDRP_ERROR_BAD_ARGUMENT);
    bad = good;
    bad.height_px = HDRP_CULL_SIZE_MAX + 1;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &bad), HDRP_ERROR_BAD_ARGUMENT);
    bad = good;
    bad.grid.tiles.x = 0;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &bad), HDRP_ERROR_BAD_ARGUMENT);
    bad = good;
    bad.tiles_offset = 1;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &bad), HDRP_ERROR_BAD_ARGUMENT);
    if (gpu.buffer_range_max < (VkDeviceSize)16 * HDRP_CULL_SIZE_MAX * HDRP_CULL_SIZE_MAX) {
        bad = good;
        bad.width_px = bad.height_px = HDRP_CULL_SIZE_MAX;
        bad.grid.tiles = hdrp_u32x4_make(1, 1, HDRP_CULL_SIZE_MAX, HDRP_CULL_SIZE_MAX);
        assert_int_equal(hdrp_gpu_vk_measure_depth(&gpu, commands, &bad), HDRP_ERROR_TOO_LARGE);
    }
    assert_int_equal(gpu.passes_recorded, 0);
    gpu_run(&device);
    hdrp_gpu_vk_image_destroy(&gpu, &image);
    hdrp_gpu_vk_buffer_destroy(&gpu, &tiles);
    free(p.texels);
}

static void frames_of_any_size_follow_each_other(void** state)
{
    uint64_t random = 3;
    (void)state;
    for (uint32_t frame = 0; frame < 24; ++frame) {
        uint32_t width = 1 + (uint32_t)(random_number(&random) * 90.0);
        uint32_t height = 1 + (uint32_t)(random_number(&random) * 90.0);
        picture p = picture_of(width, height, frame % 3 * 8, frame % 3 * 8, frame % 5, 0);
        fill_metres(&p, frame);
        expect_parity(&p, frame % 2 != 0);
        free(p.texels);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_table_of_fgd_is_that_of_the_cpu, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_table_of_16_bits_is_rounded_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(tables_that_are_none_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(depths_in_metres_are_measured_as_on_the_cpu, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(odd_depths_of_one_pixel_are_measured_as_on_the_cpu, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(device_depth_is_measured_as_on_the_cpu, set_up, tear_down),
        cmocka_unit_test_setup_teardown(depths_that_are_none_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(frames_of_any_size_follow_each_other, set_up, tear_down),
    };
    int failed;
    if (!gpu_open_writing(&device)) {
        return GPU_SKIPPED;
    }
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    gpu_close(&device);
    return failed || device.messages;
}
