/* gpu_test.h - a Vulkan device for tests: opened once, with validation layers where there are any.
 * SPDX-License-Identifier: MIT */
#ifndef GPU_TEST_H
#define GPU_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_brdf.h"
#include "hdrp_gpu_vk.h"

#define GPU_SKIPPED 77 /* exit status that CTest shows as skipped */

typedef struct gpu_device {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkPhysicalDeviceFeatures features; /* that are enabled */
    VkQueue queue;
    uint32_t family;
    VkCommandPool pool;
    VkCommandBuffer commands;
    bool is_lavapipe, is_validated;
    unsigned messages; /* of the validation layers */
    VkDebugUtilsMessengerEXT messenger;
} gpu_device;

/* False, after a line that says why, where there is no device. */
bool gpu_open(gpu_device* d);
/* Where it also lacks what passes that write images need. */
bool gpu_open_writing(gpu_device* d);
void gpu_close(gpu_device* d);

/* What hdrp_gpu_vk_init is given for all passes. */
hdrp_gpu_vk_desc gpu_desc(const gpu_device* d);

VkCommandBuffer gpu_begin(gpu_device* d);
void gpu_run(gpu_device* d); /* submits what was recorded, and waits */

/* A buffer that the host can map, and its contents; map_done afterwards. */
hdrp_gpu_vk_buffer gpu_host_buffer(const hdrp_gpu_vk* gpu, VkDeviceSize bytes);
hdrp_gpu_vk_buffer gpu_filled_buffer(const gpu_device* d, const hdrp_gpu_vk* gpu, const void* data,
                                     size_t bytes);
void* gpu_map(const gpu_device* d, const hdrp_gpu_vk_buffer* buffer);
void gpu_unmap(const gpu_device* d, const hdrp_gpu_vk_buffer* buffer);

/* All levels and layers of an image, between all that was recorded before and all that comes. */
void gpu_change_layout(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                       VkImageLayout before, VkImageLayout after);

/* Commands that move texels, for an image in SHADER_READ_ONLY_OPTIMAL afterwards. */
void gpu_upload(VkCommandBuffer commands, const hdrp_gpu_vk_buffer* from,
                const hdrp_gpu_vk_image* to, VkImageAspectFlags aspect);
void gpu_download(VkCommandBuffer commands, const hdrp_gpu_vk_image* from,
                  const hdrp_gpu_vk_buffer* to);

/* Images that hdrp_gpu_vk_image_create does not make, with a view of all levels and layers. */
hdrp_gpu_vk_image gpu_image(const gpu_device* d, const VkImageCreateInfo* info,
                            VkImageViewType type, VkImageAspectFlags aspect);
hdrp_gpu_vk_image gpu_depth_image(const gpu_device* d, uint32_t width, uint32_t height);
void gpu_image_destroy(const gpu_device* d, hdrp_gpu_vk_image* image);

#endif /* GPU_TEST_H */
