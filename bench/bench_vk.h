/* bench_vk.h - a Vulkan device for the benchmarks, and the time that commands take on it.
 * SPDX-License-Identifier: MIT
 *
 * The first device that there is. Without one the program ends, and says so; what fails ends it with
 * an error. */
#ifndef BENCH_VK_H
#define BENCH_VK_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <vulkan/vulkan.h>

typedef struct bench_vk {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceFeatures features; /* that are enabled: to be set before it is opened */
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkQueryPool queries; /* of two timestamps */
} bench_vk;

static void must(bool good, const char* what)
{
    if (!good) {
        fprintf(stderr, "%s failed\n", what);
        exit(1);
    }
}
#define VK(call) must((call) == VK_SUCCESS, #call)

/* A queue that can do all of these. */
static void bench_vk_choose(bench_vk* vk, VkQueueFlags wanted)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = 1, family_count = 16;
    if (vkEnumeratePhysicalDevices(vk->instance, &count, &vk->physical) < VK_SUCCESS ||
        count == 0) {
        puts("skipped: no Vulkan device here (Debian: mesa-vulkan-drivers)");
        exit(0);
    }
    vkGetPhysicalDeviceProperties(vk->physical, &vk->properties);
    vkGetPhysicalDeviceQueueFamilyProperties(vk->physical, &family_count, families);
    while (vk->family < family_count && (families[vk->family].queueFlags & wanted) != wanted) {
        ++vk->family;
    }
    must(vk->family < family_count && families[vk->family].timestampValidBits > 0,
         "finding a queue that does what is measured and tells the time");
}

static void bench_vk_open(bench_vk* vk, VkQueueFlags wanted)
{
    const float priority = 1.0f;
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .apiVersion = VK_API_VERSION_1_1};
    const VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                           .pApplicationInfo = &application};
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueCount = 1,
                                     .pQueuePriorities = &priority};
    const VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                       .queueCreateInfoCount = 1,
                                       .pQueueCreateInfos = &queue,
                                       .pEnabledFeatures = &vk->features};
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT};
    VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                          .commandBufferCount = 1};
    const VkQueryPoolCreateInfo queries = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                           .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                           .queryCount = 2};
    VK(vkCreateInstance(&instance, NULL, &vk->instance));
    bench_vk_choose(vk, wanted);
    queue.queueFamilyIndex = pool.queueFamilyIndex = vk->family;
    VK(vkCreateDevice(vk->physical, &device, NULL, &vk->device));
    vkGetDeviceQueue(vk->device, vk->family, 0, &vk->queue);
    VK(vkCreateCommandPool(vk->device, &pool, NULL, &vk->pool));
    buffer.commandPool = vk->pool;
    VK(vkAllocateCommandBuffers(vk->device, &buffer, &vk->commands));
    VK(vkCreateQueryPool(vk->device, &queries, NULL, &vk->queries));
}

#endif
