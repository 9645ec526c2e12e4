/* gpu_test.c - see gpu_test.h. SPDX-License-Identifier: MIT */
#include "gpu_test.h"

#include <stdio.h>
#include <string.h>

#define VALIDATION "VK_LAYER_KHRONOS_validation"

static VKAPI_ATTR VkBool32 VKAPI_CALL
count_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT type,
              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
{
    (void)severity;
    (void)type;
    ++((gpu_device*)user)->messages;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
}

static bool has_validation(void)
{
    VkLayerProperties layers[64];
    uint32_t count = 64;
    if (vkEnumerateInstanceLayerProperties(&count, layers) < VK_SUCCESS) {
        return false;
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (strcmp(layers[i].layerName, VALIDATION) == 0) {
            return true;
        }
    }
    return false;
}

static bool open_instance(gpu_device* d)
{
    const char* layer = VALIDATION;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkValidationFeatureEnableEXT enabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .apiVersion = VK_API_VERSION_1_1};
    const VkDebugUtilsMessengerCreateInfoEXT messages = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = count_message,
        .pUserData = d};
    const VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                              .enabledValidationFeatureCount = 1,
                                              .pEnabledValidationFeatures = enabled};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    PFN_vkCreateDebugUtilsMessengerEXT create;
    d->is_validated = has_validation();
    if (d->is_validated) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    if (vkCreateInstance(&info, NULL, &d->instance) != VK_SUCCESS) {
        return false;
    }
    create = (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
        d->instance, "vkCreateDebugUtilsMessengerEXT");
    return !d->is_validated || !create ||
           create(d->instance, &messages, NULL, &d->messenger) == VK_SUCCESS;
}

/* The first queue family that computes, of the first device that has one. */
static bool choose(gpu_device* d)
{
    VkPhysicalDevice devices[16];
    uint32_t device_count = 16;
    if (vkEnumeratePhysicalDevices(d->instance, &device_count, devices) < VK_SUCCESS) {
        return false;
    }
    for (uint32_t i = 0; i < device_count; ++i) {
        VkPhysicalDeviceProperties properties;
        VkQueueFamilyProperties families[16];
        uint32_t count = 16;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        vkGetPhysicalDeviceQueueFamilyProperties(devices[i], &count, families);
        for (uint32_t k = 0; k < count; ++k) {
            if (families[k].queueFlags & VK_QUEUE_COMPUTE_BIT &&
                properties.apiVersion >= VK_API_VERSION_1_1) {
                d->physical = devices[i];
                d->family = k;
                d->is_lavapipe = strstr(properties.deviceName, "llvmpipe") != NULL;
                printf("device: %s%s\n", properties.deviceName,
                       d->is_validated ? ", validated" : ", no validation layers installed");
                return true;
            }
        }
    }
    return false;
}

static bool open_device(gpu_device* d)
{
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = d->family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .pEnabledFeatures = &d->features};
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = d->family};
    VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                          .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                          .commandBufferCount = 1};
    VkPhysicalDeviceFeatures has;
    vkGetPhysicalDeviceFeatures(d->physical, &has);
    d->features.shaderStorageImageWriteWithoutFormat = has.shaderStorageImageWriteWithoutFormat;
    d->features.independentBlend = has.independentBlend;
    if (vkCreateDevice(d->physical, &info, NULL, &d->device) != VK_SUCCESS) {
        return false;
    }
    vkGetDeviceQueue(d->device, d->family, 0, &d->queue);
    if (vkCreateCommandPool(d->device, &pool, NULL, &d->pool) != VK_SUCCESS) {
        return false;
    }
    buffer.commandPool = d->pool;
    return vkAllocateCommandBuffers(d->device, &buffer, &d->commands) == VK_SUCCESS;
}

bool gpu_open(gpu_device* d)
{
    memset(d, 0, sizeof *d);
    if (!open_instance(d) || !choose(d) || !open_device(d)) {
        puts("skipped: no device with Vulkan 1.1 here (Debian: mesa-vulkan-drivers)");
        gpu_close(d);
        return false;
    }
    return true;
}

bool gpu_open_writing(gpu_device* d)
{
    if (!gpu_open(d)) {
        return false;
    }
    if (!d->features.shaderStorageImageWriteWithoutFormat) {
        puts("skipped: the device lacks shaderStorageImageWriteWithoutFormat");
        gpu_close(d);
        return false;
    }
    return true;
}

void gpu_close(gpu_device* d)
{
    if (d->device) {
        vkDeviceWaitIdle(d->device); /* what a failed test left under way */
        vkDestroyCommandPool(d->device, d->pool, NULL);
        vkDestroyDevice(d->device, NULL);
    }
    if (d->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                d->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(d->instance, d->messenger, NULL);
    }
    /* The instance stays: with it drivers and layers would be unloaded, and a sanitizer could no
     * longer tell what they keep from what we leak. */
}

/* What LeakSanitizer, where there is one, asks the program for. */
const char* __lsan_default_suppressions(void);
const char* __lsan_default_suppressions(void)
{
    return "leak:libVkLayer_khronos_validation\n";
}

hdrp_gpu_vk_desc gpu_desc(const gpu_device* d)
{
    hdrp_gpu_vk_desc desc = {0};
    desc.instance = d->instance;
    desc.physical_device = d->physical;
    desc.device = d->device;
    desc.queue_family = d->family;
    desc.get_instance_proc_addr = vkGetInstanceProcAddr;
    desc.features = &d->features;
    return desc;
}

VkCommandBuffer gpu_begin(gpu_device* d)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    assert_int_equal(vkBeginCommandBuffer(d->commands, &info), VK_SUCCESS);
    return d->commands;
}

void gpu_run(gpu_device* d)
{
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &d->commands};
    assert_int_equal(vkEndCommandBuffer(d->commands), VK_SUCCESS);
    assert_int_equal(vkQueueSubmit(d->queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
    assert_int_equal(vkQueueWaitIdle(d->queue), VK_SUCCESS);
}

hdrp_gpu_vk_buffer gpu_host_buffer(const hdrp_gpu_vk* gpu, VkDeviceSize bytes)
{
    hdrp_gpu_vk_buffer buffer;
    assert_int_equal(hdrp_gpu_vk_buffer_create(
                         gpu, bytes,
                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                         VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                         "host", &buffer),
                     HDRP_OK);
    return buffer;
}

void* gpu_map(const gpu_device* d, const hdrp_gpu_vk_buffer* buffer)
{
    void* memory = NULL;
    assert_int_equal(vkMapMemory(d->device, buffer->block.memory, buffer->block.offset,
                                 buffer->bytes, 0, &memory),
                     VK_SUCCESS);
    return memory;
}

void gpu_unmap(const gpu_device* d, const hdrp_gpu_vk_buffer* buffer)
{
    vkUnmapMemory(d->device, buffer->block.memory);
}

hdrp_gpu_vk_buffer gpu_filled_buffer(const gpu_device* d, const hdrp_gpu_vk* gpu, const void* data,
                                     size_t bytes)
{
    hdrp_gpu_vk_buffer buffer = gpu_host_buffer(gpu, bytes);
    memcpy(gpu_map(d, &buffer), data, bytes);
    gpu_unmap(d, &buffer);
    return buffer;
}

void gpu_change_layout(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                       VkImageLayout before, VkImageLayout after)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
        .oldLayout = before,
        .newLayout = after,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
}

void gpu_upload(VkCommandBuffer commands, const hdrp_gpu_vk_buffer* from,
                const hdrp_gpu_vk_image* to, VkImageAspectFlags aspect)
{
    const VkBufferImageCopy region = {.imageSubresource = {aspect, 0, 0, 1},
                                      .imageExtent = {to->width_px, to->height_px, 1}};
    gpu_change_layout(commands, to->image, aspect, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, from->buffer, to->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           1, &region);
    gpu_change_layout(commands, to->image, aspect, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void gpu_download(VkCommandBuffer commands, const hdrp_gpu_vk_image* from,
                  const hdrp_gpu_vk_buffer* to)
{
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = {from->width_px, from->height_px, 1}};
    gpu_change_layout(commands, from->image, VK_IMAGE_ASPECT_COLOR_BIT,
                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(commands, from->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to->buffer,
                           1, &region);
    gpu_change_layout(commands, from->image, VK_IMAGE_ASPECT_COLOR_BIT,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

static uint32_t device_memory_type(const gpu_device* d, uint32_t bits)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(d->physical, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        if (bits >> i & 1u &&
            memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) {
            return i;
        }
    }
    fail_msg("no device memory");
    return 0;
}

hdrp_gpu_vk_image gpu_image(const gpu_device* d, const VkImageCreateInfo* info,
                            VkImageViewType type, VkImageAspectFlags aspect)
{
    VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .viewType = type,
        .format = info->format,
        .subresourceRange = {aspect, 0, info->mipLevels, 0, info->arrayLayers}};
    VkMemoryAllocateInfo allocation = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    VkMemoryRequirements needs;
    hdrp_gpu_vk_image image = {
        .format = info->format, .width_px = info->extent.width, .height_px = info->extent.height};
    assert_int_equal(vkCreateImage(d->device, info, NULL, &image.image), VK_SUCCESS);
    vkGetImageMemoryRequirements(d->device, image.image, &needs);
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = device_memory_type(d, needs.memoryTypeBits);
    assert_int_equal(vkAllocateMemory(d->device, &allocation, NULL, &image.block.memory),
                     VK_SUCCESS);
    assert_int_equal(vkBindImageMemory(d->device, image.image, image.block.memory, 0), VK_SUCCESS);
    view.image = image.image;
    assert_int_equal(vkCreateImageView(d->device, &view, NULL, &image.view), VK_SUCCESS);
    return image;
}

hdrp_gpu_vk_image gpu_depth_image(const gpu_device* d, uint32_t width, uint32_t height)
{
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = VK_FORMAT_D32_SFLOAT,
                                    .extent = {width, height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                             VK_IMAGE_USAGE_SAMPLED_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    return gpu_image(d, &info, VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_ASPECT_DEPTH_BIT);
}

void gpu_image_destroy(const gpu_device* d, hdrp_gpu_vk_image* image)
{
    vkDestroyImageView(d->device, image->view, NULL);
    vkDestroyImage(d->device, image->image, NULL);
    vkFreeMemory(d->device, image->block.memory, NULL);
}
