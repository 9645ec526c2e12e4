/* A Vulkan device, one queue of it, memory, and commands that are run at once. */
#ifndef RD_VK_DEVICE_H
#define RD_VK_DEVICE_H

#include "vk_api.h"

#include "hdrp_gpu_vk.h"
#include "report.h"
#include "stats.h"

/* Times that can be taken between two submissions. */
#define RD_VK_MARKS_MAX 64

typedef struct rd_vk_device {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceFeatures features; /* all that there are: all are enabled */
    uint32_t family, timestamp_bits;
    VkDebugUtilsMessengerEXT messenger;
    unsigned messages; /* of validation layers, where HDRP_RENDER_VALIDATE asks for them */
    VkDevice device;
    VkQueue queue;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkQueryPool queries;
    const char* marks[RD_VK_MARKS_MAX];
    uint32_t mark_count;
    hdrp_gpu_vk gpu;
    rd_report* report;
    rd_stats* stats; /* for times; NULL: none */
} rd_vk_device;

/* The best device there is: discrete, integrated, virtual, then one that is a CPU. */
bool rd_vk_device_open(rd_vk_device* d, rd_stats* stats, rd_report* report);
void rd_vk_device_close(rd_vk_device* d);

/* Reports what went wrong, unless nothing did; says whether all is well. */
bool rd_vk_check(rd_vk_device* d, VkResult result, const char* what);
bool rd_vk_check_hdrp(rd_vk_device* d, hdrp_result result, const char* what);

/* Filters and encodes colours with too few bits: lavapipe, and what else is a CPU. */
bool rd_vk_is_coarse(const rd_vk_device* d);

/* >>commands */

/* Commands are recorded between the two; rd_vk_run returns when all have been executed. */
bool rd_vk_begin(rd_vk_device* d);
bool rd_vk_run(rd_vk_device* d);
/* The time since the mark before goes to the pass of this name; a name of NULL drops it. */
void rd_vk_mark(rd_vk_device* d, const char* pass);
/* All that was recorded before is done and seen by all that comes after. */
void rd_vk_barrier(rd_vk_device* d);

/* >>memory */

/* An image of one or six layers, and a view of it all: a cube where there are six. */
typedef struct rd_vk_image {
    hdrp_gpu_vk_image base;
    uint32_t levels, layers;
    VkImageAspectFlags aspect;
} rd_vk_image;

typedef struct rd_vk_image_desc {
    VkFormat format;
    uint32_t width, height, levels, layers;
    VkImageUsageFlags usage;
    VkImageAspectFlags aspect; /* 0: colour */
} rd_vk_image_desc;

bool rd_vk_image_make(rd_vk_device* d, const rd_vk_image_desc* desc, rd_vk_image* image);
void rd_vk_image_free(rd_vk_device* d, rd_vk_image* image);
void rd_vk_layout(rd_vk_device* d, const rd_vk_image* image, VkImageLayout before,
                  VkImageLayout after);
/* A level lies at each offset, its layers one after the other. Leaves the image to be sampled. */
bool rd_vk_image_fill(rd_vk_device* d, rd_vk_image* image, const void* texels, size_t bytes,
                      const size_t* offsets);

/* Memory that is mapped for as long as it lives. */
typedef struct rd_vk_mapped {
    hdrp_gpu_vk_buffer buffer;
    void* at;
} rd_vk_mapped;

bool rd_vk_mapped_make(rd_vk_device* d, size_t bytes, VkBufferUsageFlags usage, rd_vk_mapped* out);
void rd_vk_mapped_free(rd_vk_device* d, rd_vk_mapped* m);

/* A storage buffer on the device; of no bytes, one of a few is made. */
bool rd_vk_buffer_fill(rd_vk_device* d, const void* data, size_t bytes, hdrp_gpu_vk_buffer* out);

bool rd_vk_sampler_make(rd_vk_device* d, VkFilter magnification, VkSamplerAddressMode u,
                        VkSamplerAddressMode v, VkSampler* out);

#endif
