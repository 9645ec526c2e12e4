/* bench_gpu.c - times the building of lists on a Vulkan device: bench_gpu [--rounds N]
 *     [--size 720|1080] [--csv FILE]
 * SPDX-License-Identifier: MIT
 *
 * The street of bench_cull with 10 to 4000 lights, and the ways to list them: what the device says
 * between two timestamps around hdrp_gpu_vk_build_lists, projection and depth included, and the same
 * without lights, which is what depth and empty lists take. All ways take turns; the median counts,
 * and the least where the machine has other work. */
#define _GNU_SOURCE
#define HDRP_CULL_IMPLEMENTATION
#define HDRP_GPU_VK_IMPLEMENTATION
#include "hdrp_gpu_vk.h"

#include "bench_vk.h"
#include "cull_scene.h"

#include <string.h>

#define ROUNDS_MAX 1001
#define LIGHTS_MAX 4000u

typedef struct way {
    const char* name;
    hdrp_cull_desc desc;
    bool has_depth;
    hdrp_gpu_vk_lists lists;
    double ms[ROUNDS_MAX];
} way;

#define TILES .tile_width_px = 16, .tile_height_px = 16, .slice_count = 1
static way ways[] = {
    {.name = "clusters 32x32x64", .has_depth = true},
    {.name = "clusters 32x32x64, no depth"},
    {.name = "tiles 16x16", .desc = {TILES, .flags = HDRP_CULL_PIXELS}, .has_depth = true},
    {.name = "tiles 16x16, blocks", .desc = {TILES, .flags = HDRP_CULL_BLOCKS}, .has_depth = true},
    {.name = "tiles 16x16, no pixels", .desc = {TILES}, .has_depth = true},
};
#define WAYS (sizeof ways / sizeof ways[0])

static bench_vk vk;
static hdrp_gpu_vk gpu;

#define HDRP(call) must((call) == HDRP_OK, #call)

/* ---- commands -------------------------------------------------------------------------------- */

static void begin(void)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK(vkBeginCommandBuffer(vk.commands, &info));
    vkCmdResetQueryPool(vk.commands, vk.queries, 0, 2);
}

/* Executes what was recorded; milliseconds between its timestamps. */
static double run(void)
{
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &vk.commands};
    uint64_t ticks[2] = {0, 0};
    VK(vkEndCommandBuffer(vk.commands));
    VK(vkQueueSubmit(vk.queue, 1, &submit, VK_NULL_HANDLE));
    VK(vkQueueWaitIdle(vk.queue));
    VK(vkGetQueryPoolResults(vk.device, vk.queries, 0, 2, sizeof ticks, ticks, sizeof ticks[0],
                             VK_QUERY_RESULT_64_BIT));
    return (double)(ticks[1] - ticks[0]) * (double)vk.properties.limits.timestampPeriod * 1e-6;
}

static hdrp_gpu_vk_buffer host_buffer(const void* data, size_t bytes)
{
    hdrp_gpu_vk_buffer b;
    void* mapped;
    HDRP(hdrp_gpu_vk_buffer_create(
        &gpu, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, NULL, &b));
    VK(vkMapMemory(vk.device, b.block.memory, b.block.offset, bytes, 0, &mapped));
    memcpy(mapped, data, bytes);
    vkUnmapMemory(vk.device, b.block.memory);
    return b;
}

/* ---- the scene ------------------------------------------------------------------------------- */

static cull_scene street;
static hdrp_gpu_vk_buffer shapes;
static hdrp_gpu_vk_image depth;

static void move_depth(VkImageLayout before, VkImageLayout after, VkAccessFlags from,
                       VkAccessFlags to)
{
    VkImageMemoryBarrier b = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    b.srcAccessMask = from;
    b.dstAccessMask = to;
    b.oldLayout = before;
    b.newLayout = after;
    b.image = depth.image;
    b.subresourceRange.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    b.subresourceRange.levelCount = b.subresourceRange.layerCount = 1;
    vkCmdPipelineBarrier(vk.commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 1, &b);
}

static void make_scene(uint32_t width, uint32_t height)
{
    size_t pixels = (size_t)width * height;
    float* texels = malloc(pixels * sizeof *texels);
    hdrp_cull_shape* all = malloc(LIGHTS_MAX * sizeof *all);
    hdrp_gpu_vk_buffer upload;
    VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                .imageExtent = {width, height, 1}};
    must(texels && all, "finding memory");
    cull_scene_make(&street, width, height);
    cull_scene_depth(&street, texels);
    for (uint32_t i = 0; i < LIGHTS_MAX; ++i) {
        all[i] = hdrp_cull_shape_from_light(cull_scene_light(&street, CULL_SCENE_POINTS, i));
    }
    shapes = host_buffer(all, LIGHTS_MAX * sizeof *all);
    upload = host_buffer(texels, pixels * sizeof *texels);
    HDRP(hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32_SFLOAT, width, height,
                                  VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                  "depth", &depth));
    begin();
    move_depth(VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0,
               VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdCopyBufferToImage(vk.commands, upload.buffer, depth.image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    move_depth(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
               VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT);
    vkCmdWriteTimestamp(vk.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, vk.queries, 0);
    vkCmdWriteTimestamp(vk.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, vk.queries, 1);
    run();
    hdrp_gpu_vk_buffer_destroy(&gpu, &upload);
    free(texels);
    free(all);
}

/* ---- turns ----------------------------------------------------------------------------------- */

static double build(way* w, uint32_t lights)
{
    hdrp_gpu_vk_cull_frame frame = {0};
    frame.camera = street.camera;
    frame.shapes = shapes.buffer;
    frame.count = lights;
    frame.view = w->has_depth ? depth.view : VK_NULL_HANDLE;
    frame.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    HDRP(hdrp_gpu_vk_begin_frame(&gpu, 0));
    begin();
    vkCmdWriteTimestamp(vk.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, vk.queries, 0);
    HDRP(hdrp_gpu_vk_build_lists(&gpu, vk.commands, &w->lists, &frame));
    vkCmdWriteTimestamp(vk.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, vk.queries, 1);
    return run();
}

static int by_time(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return x < y ? -1 : x > y;
}

static void measure(uint32_t lights, int rounds, uint32_t height, FILE* csv)
{
    for (int round = -1; round < rounds; ++round) { /* the first is not counted: it compiles */
        for (size_t i = 0; i < WAYS; ++i) {
            double ms = build(&ways[i], lights);
            ways[i].ms[round < 0 ? 0 : round] = ms;
        }
    }
    for (size_t i = 0; i < WAYS; ++i) {
        way* w = &ways[i];
        qsort(w->ms, (size_t)rounds, sizeof w->ms[0], by_time);
        printf("%5u  %-30s %9.3f %9.3f\n", lights, w->name, w->ms[rounds / 2], w->ms[0]);
        if (csv) {
            fprintf(csv, "%u,%u,\"%s\",%.4f,%.4f\n", height, lights, w->name, w->ms[rounds / 2],
                    w->ms[0]);
        }
    }
}

static void make_lists(uint32_t width, uint32_t height)
{
    for (size_t i = 0; i < WAYS; ++i) {
        ways[i].desc.width_px = width;
        ways[i].desc.height_px = height;
        ways[i].desc.shape_capacity = LIGHTS_MAX;
        HDRP(hdrp_gpu_vk_lists_create(&gpu, &ways[i].desc, &ways[i].lists));
    }
}

static void close_all(void)
{
    for (size_t i = 0; i < WAYS; ++i) {
        hdrp_gpu_vk_lists_destroy(&gpu, &ways[i].lists);
    }
    hdrp_gpu_vk_buffer_destroy(&gpu, &shapes);
    hdrp_gpu_vk_image_destroy(&gpu, &depth);
    hdrp_gpu_vk_destroy(&gpu);
    vkDestroyQueryPool(vk.device, vk.queries, NULL);
    vkDestroyCommandPool(vk.device, vk.pool, NULL);
    vkDestroyDevice(vk.device, NULL);
    vkDestroyInstance(vk.instance, NULL);
}

int main(int argc, char** argv)
{
    const uint32_t counts[] = {0, 10, 100, 256, 500, 1000, 4000};
    hdrp_gpu_vk_desc desc = {0};
    uint32_t height = 720;
    int rounds = 21;
    FILE* csv = NULL;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (strcmp(argv[i], "--rounds") == 0) {
            rounds = atoi(argv[i + 1]);
        } else if (strcmp(argv[i], "--size") == 0) {
            height = (uint32_t)atoi(argv[i + 1]);
        } else if (strcmp(argv[i], "--csv") == 0) {
            csv = fopen(argv[i + 1], "w");
            must(csv != NULL, "opening the file of results");
        } else {
            must(0, "reading an option");
        }
    }
    must(rounds >= 1 && rounds <= ROUNDS_MAX && (height == 720 || height == 1080) && argc % 2 == 1,
         "reading the options");
    bench_vk_open(&vk, VK_QUEUE_COMPUTE_BIT);
    desc.instance = vk.instance;
    desc.physical_device = vk.physical;
    desc.device = vk.device;
    desc.queue_family = vk.family;
    desc.get_instance_proc_addr = vkGetInstanceProcAddr;
    desc.passes = HDRP_GPU_VK_PASS_LISTS;
    HDRP(hdrp_gpu_vk_init(&gpu, &desc));
    make_scene(height * 16 / 9, height);
    make_lists(height * 16 / 9, height);
    printf("%s, %ux%u\n\nlights way                            median ms  least ms\n",
           vk.properties.deviceName, height * 16 / 9, height);
    if (csv) {
        fprintf(csv, "# device: %s\nheight,lights,way,median_ms,least_ms\n",
                vk.properties.deviceName);
    }
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i) {
        measure(counts[i], rounds, height, csv);
    }
    must(!csv || fclose(csv) == 0, "writing the file of results");
    close_all();
    return 0;
}
