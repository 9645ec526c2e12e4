#include "vk_device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A variable of the environment that asks for validation layers, and their synchronisation checks. */
#define VALIDATE     "HDRP_RENDER_VALIDATE"
#define MESSAGES_MAX 10
#define VALIDATION   "VK_LAYER_KHRONOS_validation"

bool rd_vk_check(rd_vk_device* d, VkResult result, const char* what)
{
    if (result >= VK_SUCCESS) {
        return true;
    }
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        return rd_fail(d->report, "--backend vulkan", "out of memory: %s", what);
    }
    if (result == VK_ERROR_DEVICE_LOST) {
        return rd_fail(d->report, "--backend vulkan", "the device was lost: %s", what);
    }
    return rd_fail(d->report, "--backend vulkan", "%s failed (%d)", what, (int)result);
}

bool rd_vk_check_hdrp(rd_vk_device* d, hdrp_result result, const char* what)
{
    return result == HDRP_OK
               ? true
               : rd_fail(d->report, "--backend vulkan", "%s: %s", what, hdrp_result_string(result));
}

/* >>instance */

static VKAPI_ATTR VkBool32 VKAPI_CALL
print_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT type,
              const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
{
    (void)severity;
    (void)type;
    if (((rd_vk_device*)user)->messages++ < MESSAGES_MAX) {
        fprintf(stderr, "validation: %s\n", data->pMessage);
    }
    return VK_FALSE;
}

static bool has_validation(void)
{
    VkLayerProperties layers[64];
    uint32_t count = 64;
    if (!getenv(VALIDATE) || vkEnumerateInstanceLayerProperties(&count, layers) < VK_SUCCESS) {
        return false;
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (strcmp(layers[i].layerName, VALIDATION) == 0) {
            return true;
        }
    }
    return false;
}

static bool make_instance(rd_vk_device* d)
{
    const char* layer = VALIDATION;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkValidationFeatureEnableEXT checks[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkDebugUtilsMessengerCreateInfoEXT messages = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = print_message,
        .pUserData = d};
    const VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                              .enabledValidationFeatureCount = 1,
                                              .pEnabledValidationFeatures = checks};
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "hdrp_render",
                                           .apiVersion = VK_API_VERSION_1_1};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    PFN_vkCreateDebugUtilsMessengerEXT create;
    bool validated = has_validation();
    if (validated) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    if (vkCreateInstance(&info, NULL, &d->instance) != VK_SUCCESS) {
        return rd_fail(d->report, "--backend vulkan", "there is no driver");
    }
    rd_vk_load_instance(d->instance);
    create = (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
        d->instance, "vkCreateDebugUtilsMessengerEXT");
    return !validated || !create ||
           rd_vk_check(d, create(d->instance, &messages, NULL, &d->messenger), "messages");
}

/* >>device */

/* How good a type of device is; the order of VkPhysicalDeviceType does not say. */
static int rank_of(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 5;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 4;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 2;
    default:
        return 1;
    }
}

/* A queue family that draws and computes. */
static bool find_family(VkPhysicalDevice device, uint32_t* family, uint32_t* timestamp_bits)
{
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[32];
    uint32_t count = 32;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    for (uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & both) == both) {
            *family = i;
            *timestamp_bits = families[i].timestampValidBits;
            return true;
        }
    }
    return false;
}

static bool choose(rd_vk_device* d)
{
    VkPhysicalDevice devices[32];
    uint32_t count = 32;
    int best = 0;
    if (vkEnumeratePhysicalDevices(d->instance, &count, devices) < VK_SUCCESS) {
        count = 0;
    }
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceProperties p;
        uint32_t family, bits;
        vkGetPhysicalDeviceProperties(devices[i], &p);
        if (p.apiVersion >= VK_API_VERSION_1_1 && rank_of(p.deviceType) > best &&
            find_family(devices[i], &family, &bits)) {
            best = rank_of(p.deviceType);
            d->physical = devices[i];
            d->properties = p;
            d->family = family;
            d->timestamp_bits = bits;
        }
    }
    return best > 0 ? true
                    : rd_fail(d->report, "--backend vulkan",
                              "there is no device with Vulkan 1.1 that draws and computes");
}

static bool has_format(rd_vk_device* d, VkFormat format, VkFormatFeatureFlags needed)
{
    VkFormatProperties p;
    vkGetPhysicalDeviceFormatProperties(d->physical, format, &p);
    return (p.optimalTilingFeatures & needed) == needed;
}

/* Beyond what all devices of version 1.1 have. */
static bool has_what_is_needed(rd_vk_device* d)
{
    const char* device = d->properties.deviceName;
    if (!d->features.dualSrcBlend || !d->features.independentBlend) {
        return rd_fail(d->report, device, "lacks the features dualSrcBlend or independentBlend");
    }
    if (!has_format(d, VK_FORMAT_R32G32B32A32_SFLOAT,
                    VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT |
                        VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT)) {
        return rd_fail(d->report, device, "cannot blend and filter 32-bit float");
    }
    if (!has_format(d, VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) {
        return rd_fail(d->report, device, "cannot draw to R11G11B10");
    }
    if (d->properties.limits.maxColorAttachments < 7u ||
        d->properties.limits.maxPerStageDescriptorSamplers < 24u ||
        d->properties.limits.maxPerStageDescriptorStorageBuffers < 16u) {
        return rd_fail(d->report, device,
                       "has too few colour attachments, samplers or storage buffers");
    }
    return true;
}

static bool make_device(rd_vk_device* d)
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
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = d->family};
    VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                          .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                          .commandBufferCount = 1};
    const VkQueryPoolCreateInfo queries = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                           .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                           .queryCount = RD_VK_MARKS_MAX};
    if (!rd_vk_check(d, vkCreateDevice(d->physical, &info, NULL, &d->device), "the device")) {
        return false;
    }
    rd_vk_load_device(d->device);
    vkGetDeviceQueue(d->device, d->family, 0, &d->queue);
    if (!rd_vk_check(d, vkCreateCommandPool(d->device, &pool, NULL, &d->pool), "commands")) {
        return false;
    }
    buffer.commandPool = d->pool;
    return rd_vk_check(d, vkAllocateCommandBuffers(d->device, &buffer, &d->commands), "commands") &&
           rd_vk_check(d, vkCreateQueryPool(d->device, &queries, NULL, &d->queries), "queries");
}

static bool make_context(rd_vk_device* d)
{
    hdrp_gpu_vk_desc desc;
    const char* lacks;
    memset(&desc, 0, sizeof desc);
    desc.instance = d->instance;
    desc.physical_device = d->physical;
    desc.device = d->device;
    desc.queue_family = d->family;
    desc.get_instance_proc_addr = vkGetInstanceProcAddr;
    desc.features = &d->features;
    lacks = hdrp_gpu_vk_missing(&desc, 0);
    if (lacks) {
        return rd_fail(d->report, d->properties.deviceName, "lacks %s", lacks);
    }
    return rd_vk_check_hdrp(d, hdrp_gpu_vk_init(&d->gpu, &desc), "passes");
}

bool rd_vk_device_open(rd_vk_device* d, rd_stats* stats, rd_report* report)
{
    double begin = rd_now_ms();
    memset(d, 0, sizeof *d);
    d->report = report;
    if (!rd_vk_load()) {
        return rd_fail(report, "--backend vulkan",
                       "there is no loader, libvulkan.so.1 (Debian: libvulkan1)");
    }
    if (!make_instance(d) || !choose(d)) {
        return false;
    }
    vkGetPhysicalDeviceFeatures(d->physical, &d->features);
    d->features.robustBufferAccess = VK_FALSE;
    if (!has_what_is_needed(d) || !make_device(d) || !make_context(d)) {
        return false;
    }
    d->stats = stats;
    if (stats) {
        rd_stats_pass(stats, "open device", rd_now_ms() - begin);
    }
    return true;
}

void rd_vk_device_close(rd_vk_device* d)
{
    if (d->device) {
        vkDeviceWaitIdle(d->device);
        hdrp_gpu_vk_destroy(&d->gpu);
        vkDestroyQueryPool(d->device, d->queries, NULL);
        vkDestroyCommandPool(d->device, d->pool, NULL);
        vkDestroyDevice(d->device, NULL);
    }
    if (d->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                d->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(d->instance, d->messenger, NULL);
    }
    if (d->instance) {
        vkDestroyInstance(d->instance, NULL);
    }
    memset(d, 0, sizeof *d);
}

bool rd_vk_is_coarse(const rd_vk_device* d)
{
    return d->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

/* >>commands */

bool rd_vk_begin(rd_vk_device* d)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (!rd_vk_check(d, vkBeginCommandBuffer(d->commands, &info), "recording")) {
        return false;
    }
    d->mark_count = 0;
    vkCmdResetQueryPool(d->commands, d->queries, 0, RD_VK_MARKS_MAX);
    rd_vk_mark(d, NULL);
    return true;
}

void rd_vk_mark(rd_vk_device* d, const char* pass)
{
    if (d->timestamp_bits == 0 || d->mark_count == RD_VK_MARKS_MAX) {
        return;
    }
    vkCmdWriteTimestamp(d->commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, d->queries,
                        d->mark_count);
    d->marks[d->mark_count++] = pass;
}

static bool read_marks(rd_vk_device* d)
{
    uint64_t at[RD_VK_MARKS_MAX];
    uint64_t mask = d->timestamp_bits < 64 ? ((uint64_t)1 << d->timestamp_bits) - 1 : ~(uint64_t)0;
    if (d->mark_count < 2 || !d->stats) {
        return true;
    }
    if (!rd_vk_check(d,
                     vkGetQueryPoolResults(d->device, d->queries, 0, d->mark_count, sizeof at, at,
                                           sizeof at[0],
                                           VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                     "timestamps")) {
        return false;
    }
    for (uint32_t i = 1; i < d->mark_count; ++i) {
        double ticks = (double)((at[i] - at[i - 1]) & mask);
        if (d->marks[i]) {
            rd_stats_pass(d->stats, d->marks[i],
                          ticks * (double)d->properties.limits.timestampPeriod * 1e-6);
        }
    }
    return true;
}

bool rd_vk_run(rd_vk_device* d)
{
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &d->commands};
    return rd_vk_check(d, vkEndCommandBuffer(d->commands), "recording") &&
           rd_vk_check(d, vkQueueSubmit(d->queue, 1, &info, VK_NULL_HANDLE), "submission") &&
           rd_vk_check(d, vkQueueWaitIdle(d->queue), "execution") && read_marks(d);
}

void rd_vk_barrier(rd_vk_device* d)
{
    const VkMemoryBarrier all = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                 .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                 .dstAccessMask =
                                     VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    vkCmdPipelineBarrier(d->commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &all, 0, NULL, 0, NULL);
}
