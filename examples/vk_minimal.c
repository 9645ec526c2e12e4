/* vk_minimal.c - the passes of hdrp_gpu_vk.h on the first Vulkan device that is there.
 * SPDX-License-Identifier: MIT
 *
 * Bakes the table of FGD, measures the depths of tiles of a slope, and reads both back: everything
 * is recorded into one command buffer of ours. Prints a few numbers, and fails where they are not
 * those of the CPU. Exit status 77: there is no device. */
#define HDRP_BRDF_IMPLEMENTATION
#define HDRP_CULL_IMPLEMENTATION
#define HDRP_GPU_VK_IMPLEMENTATION
#include "hdrp_brdf.h"
#include "hdrp_gpu_vk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FGD_SIZE 16u
#define WIDTH    200u
#define HEIGHT   100u
#define TILE     16u

static void check(int good, const char* what)
{
    if (!good) {
        fprintf(stderr, "vk_minimal: %s failed\n", what);
        exit(1);
    }
}

static void vk(VkResult result, const char* what)
{
    check(result == VK_SUCCESS, what);
}

/* What an engine has already: a device, one queue that computes, a command buffer. */
typedef struct engine {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkPhysicalDeviceFeatures features;
    VkQueue queue;
    VkCommandPool pool;
    VkCommandBuffer commands;
} engine;

static int engine_open(engine* e)
{
    const float priority = 1.0f;
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO};
    VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VkPhysicalDeviceFeatures has;
    uint32_t count = 1;
    application.apiVersion = VK_API_VERSION_1_1;
    instance.pApplicationInfo = &application;
    if (vkCreateInstance(&instance, NULL, &e->instance) != VK_SUCCESS ||
        vkEnumeratePhysicalDevices(e->instance, &count, &e->physical) < VK_SUCCESS || count == 0) {
        return 0;
    }
    vkGetPhysicalDeviceFeatures(e->physical, &has);
    e->features.shaderStorageImageWriteWithoutFormat = has.shaderStorageImageWriteWithoutFormat;
    queue.queueCount = 1; /* of family 0, which computes on all desktop devices */
    queue.pQueuePriorities = &priority;
    device.queueCreateInfoCount = 1;
    device.pQueueCreateInfos = &queue;
    device.pEnabledFeatures = &e->features;
    vk(vkCreateDevice(e->physical, &device, NULL, &e->device), "vkCreateDevice");
    vkGetDeviceQueue(e->device, 0, 0, &e->queue);
    vk(vkCreateCommandPool(e->device, &pool, NULL, &e->pool), "vkCreateCommandPool");
    buffer.commandPool = e->pool;
    buffer.commandBufferCount = 1;
    vk(vkAllocateCommandBuffers(e->device, &buffer, &e->commands), "vkAllocateCommandBuffers");
    vk(vkBeginCommandBuffer(e->commands, &begin), "vkBeginCommandBuffer");
    return 1;
}

static void engine_run(engine* e)
{
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &e->commands;
    vk(vkEndCommandBuffer(e->commands), "vkEndCommandBuffer");
    vk(vkQueueSubmit(e->queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    vk(vkQueueWaitIdle(e->queue), "vkQueueWaitIdle");
}

static void engine_layout(engine* e, VkImage image, VkImageLayout before, VkImageLayout after)
{
    VkImageMemoryBarrier b = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    b.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    b.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    b.oldLayout = before;
    b.newLayout = after;
    b.image = image;
    b.subresourceRange.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    b.subresourceRange.levelCount = 1;
    b.subresourceRange.layerCount = 1;
    vkCmdPipelineBarrier(e->commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 1, &b);
}

int main(void)
{
    const VkImageUsageFlags copies =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    static engine e;
    hdrp_gpu_vk_desc desc = {0};
    hdrp_gpu_vk gpu;
    hdrp_gpu_vk_image table, slope;
    hdrp_gpu_vk_buffer texels, tiles, back;
    hdrp_gpu_vk_depth depth = {0};
    VkBufferImageCopy region = {0};
    hdrp_brdf_fgd* fgd;
    hdrp_v4* ranges;
    float *z, worst = 0.0f;
    uint32_t i;
    if (!engine_open(&e)) {
        puts("skipped: no Vulkan device");
        return 77;
    }
    desc.instance = e.instance, desc.physical_device = e.physical, desc.device = e.device;
    desc.get_instance_proc_addr = vkGetInstanceProcAddr, desc.features = &e.features;
    for (i = 0; hdrp_gpu_vk_missing(&desc, i); ++i) {
        printf("the device lacks %s\n", hdrp_gpu_vk_missing(&desc, i));
    }
    check(hdrp_gpu_vk_init(&gpu, &desc) == HDRP_OK, "hdrp_gpu_vk_init");

    check(!hdrp_gpu_vk_image_create(
              &gpu, VK_FORMAT_R32G32_SFLOAT, FGD_SIZE, FGD_SIZE,
              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | copies, "fgd", &table) &&
              !hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32_SFLOAT, WIDTH, HEIGHT,
                                        VK_IMAGE_USAGE_SAMPLED_BIT | copies, "slope", &slope) &&
              !hdrp_gpu_vk_buffer_create(&gpu, WIDTH * HEIGHT * 4u,
                                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT, host, NULL, &texels) &&
              !hdrp_gpu_vk_buffer_create(&gpu, 8192, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, host,
                                         "tiles", &tiles) &&
              !hdrp_gpu_vk_buffer_create(&gpu, FGD_SIZE * FGD_SIZE * 8u,
                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT, host, NULL, &back),
          "making of resources");
    vk(vkMapMemory(e.device, texels.block.memory, 0, VK_WHOLE_SIZE, 0, (void**)&z), "vkMapMemory");
    vk(vkMapMemory(e.device, tiles.block.memory, 0, VK_WHOLE_SIZE, 0, (void**)&ranges), "map");
    vk(vkMapMemory(e.device, back.block.memory, 0, VK_WHOLE_SIZE, 0, (void**)&fgd), "map");
    for (i = 0; i < WIDTH * HEIGHT; ++i) { /* a slope, and above it the sky */
        z[i] = i / WIDTH < TILE ? 1e9f : 2.0f + 0.25f * (float)(i % WIDTH);
    }
    region.imageSubresource.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    region.imageSubresource.layerCount = 1;
    region.imageExtent.width = WIDTH;
    region.imageExtent.height = HEIGHT;
    region.imageExtent.depth = 1;
    engine_layout(&e, slope.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    vkCmdCopyBufferToImage(e.commands, texels.buffer, slope.image, VK_IMAGE_LAYOUT_GENERAL, 1,
                           &region);
    engine_layout(&e, slope.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);

    depth.view = slope.view, depth.layout = VK_IMAGE_LAYOUT_GENERAL;
    depth.width_px = WIDTH, depth.height_px = HEIGHT, depth.tiles = tiles.buffer;
    depth.camera = hdrp_cull_camera_perspective(
        hdrp_v3_splat(0.0f), hdrp_v3_make(0.0f, 0.0f, -1.0f), hdrp_v3_make(0.0f, 1.0f, 0.0f), -1.0f,
        1.0f, -0.5f, 0.5f, 0.1f, 1000.0f);
    depth.grid = hdrp_cull_grid_make(depth.camera, hdrp_u32x4_make(WIDTH, HEIGHT, 64u, 256u),
                                     hdrp_u32x4_make(TILE, TILE, 0u, 0u), 0.0f, 0.0f);
    check(!hdrp_gpu_vk_begin_frame(&gpu, 0) && !hdrp_gpu_vk_fgd_bake(&gpu, e.commands, &table) &&
              !hdrp_gpu_vk_measure_depth(&gpu, e.commands, &depth),
          "recording");
    engine_layout(&e, table.image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                  VK_IMAGE_LAYOUT_GENERAL);
    region.imageExtent.width = region.imageExtent.height = FGD_SIZE;
    vkCmdCopyImageToBuffer(e.commands, table.image, VK_IMAGE_LAYOUT_GENERAL, back.buffer, 1,
                           &region);
    engine_run(&e);

    for (i = 0; i < FGD_SIZE * FGD_SIZE; ++i) {
        float u = (float)(i % FGD_SIZE) / (FGD_SIZE - 1u), v = (float)(i / FGD_SIZE);
        hdrp_brdf_fgd expected = hdrp_brdf_fgd_integrate(u * u, v / (FGD_SIZE - 1u));
        worst = fmaxf(worst, fabsf(fgd[i].albedo - expected.albedo));
        worst = fmaxf(worst, fabsf(fgd[i].schlick - expected.schlick));
    }
    printf("FGD: within %.1e of the CPU\n", (double)worst);
    for (i = 0; i < depth.grid.tiles.z; ++i) { /* the second row of tiles */
        hdrp_v4 t = ranges[depth.grid.tiles.z + i];
        printf("tile %2u: %6.2f m to %6.2f m\n", i, (double)t.x, (double)t.y);
        check(t.x == 2.0f + 4.0f * (float)i && t.y >= t.x && ranges[i].x > ranges[i].y, "depth");
    }
    hdrp_gpu_vk_image_destroy(&gpu, &table), hdrp_gpu_vk_image_destroy(&gpu, &slope);
    hdrp_gpu_vk_buffer_destroy(&gpu, &texels), hdrp_gpu_vk_buffer_destroy(&gpu, &tiles);
    hdrp_gpu_vk_buffer_destroy(&gpu, &back), hdrp_gpu_vk_destroy(&gpu);
    vkDestroyCommandPool(e.device, e.pool, NULL);
    vkDestroyDevice(e.device, NULL);
    vkDestroyInstance(e.instance, NULL);
    return worst > 1.5e-4f;
}
