/* test_gpu_context.c - contexts and resources: what is missing, what fails, what is left behind.
 * SPDX-License-Identifier: MIT
 *
 * Between the header and the driver stand functions of this file, which count objects and fail when
 * they are told to. */
#include "gpu_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static gpu_device device;

/* ---- a driver that fails --------------------------------------------------------------------- */

static struct {
    int live;                                /* objects and pieces of memory */
    int calls, fail_at;                      /* of functions that may fail; -1: none fails */
    VkResult failure;                        /* what they return then */
    const VkAllocationCallbacks* allocation; /* that every call must be given */
    VkPipelineCache cache;                   /* likewise, calls that make pipelines */
    uint32_t storage_buffers;                /* limit of descriptors in a stage; 0: the device's */
    uint32_t threads, shared_bytes;          /* limits of a group; 0: the device's */
    uint32_t version;                        /* of Vulkan; 0: the device's */
    int sizes_asked;                         /* of subgroups */
    const char* hidden;                      /* a function that the driver has not */
    int names;                               /* of objects, for debuggers */
} driver;

static bool fails(void)
{
    return driver.calls++ == driver.fail_at;
}

#define CREATE(name, info_type, handle_type)                                                       \
    static VKAPI_ATTR VkResult VKAPI_CALL my_vk##name(VkDevice d, const info_type* info,           \
                                                      const VkAllocationCallbacks* allocation,     \
                                                      handle_type* handle)                         \
    {                                                                                              \
        VkResult r = driver.failure;                                                               \
        assert_ptr_equal(allocation, driver.allocation);                                           \
        if (!fails()) {                                                                            \
            r = vk##name(d, info, allocation, handle);                                             \
            driver.live += r == VK_SUCCESS;                                                        \
        }                                                                                          \
        return r;                                                                                  \
    }

#define DESTROY(name, handle_type)                                                                 \
    static VKAPI_ATTR void VKAPI_CALL my_vk##name(VkDevice d, handle_type handle,                  \
                                                  const VkAllocationCallbacks* allocation)         \
    {                                                                                              \
        assert_ptr_equal(allocation, driver.allocation);                                           \
        driver.live -= handle != VK_NULL_HANDLE;                                                   \
        vk##name(d, handle, allocation);                                                           \
    }

CREATE(AllocateMemory, VkMemoryAllocateInfo, VkDeviceMemory)
CREATE(CreateBuffer, VkBufferCreateInfo, VkBuffer)
CREATE(CreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)
CREATE(CreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
CREATE(CreateImage, VkImageCreateInfo, VkImage)
CREATE(CreateImageView, VkImageViewCreateInfo, VkImageView)
CREATE(CreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
CREATE(CreateSampler, VkSamplerCreateInfo, VkSampler)
CREATE(CreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
DESTROY(FreeMemory, VkDeviceMemory)
DESTROY(DestroyBuffer, VkBuffer)
DESTROY(DestroyDescriptorPool, VkDescriptorPool)
DESTROY(DestroyDescriptorSetLayout, VkDescriptorSetLayout)
DESTROY(DestroyImage, VkImage)
DESTROY(DestroyImageView, VkImageView)
DESTROY(DestroyPipeline, VkPipeline)
DESTROY(DestroyPipelineLayout, VkPipelineLayout)
DESTROY(DestroySampler, VkSampler)
DESTROY(DestroyShaderModule, VkShaderModule)

static VKAPI_ATTR VkResult VKAPI_CALL my_vkCreateComputePipelines(
    VkDevice d, VkPipelineCache cache, uint32_t count, const VkComputePipelineCreateInfo* infos,
    const VkAllocationCallbacks* allocation, VkPipeline* pipelines)
{
    VkResult r = driver.failure;
    assert_ptr_equal(allocation, driver.allocation);
    assert_true(cache == driver.cache);
    assert_int_equal(count, 1);
    if (!fails()) {
        r = vkCreateComputePipelines(d, cache, count, infos, allocation, pipelines);
        driver.live += r == VK_SUCCESS;
    }
    return r;
}

static VKAPI_ATTR VkResult VKAPI_CALL my_vkBindBufferMemory(VkDevice d, VkBuffer buffer,
                                                            VkDeviceMemory memory,
                                                            VkDeviceSize offset)
{
    return fails() ? driver.failure : vkBindBufferMemory(d, buffer, memory, offset);
}

static VKAPI_ATTR VkResult VKAPI_CALL my_vkBindImageMemory(VkDevice d, VkImage image,
                                                           VkDeviceMemory memory,
                                                           VkDeviceSize offset)
{
    return fails() ? driver.failure : vkBindImageMemory(d, image, memory, offset);
}

static VKAPI_ATTR VkResult VKAPI_CALL my_vkAllocateDescriptorSets(
    VkDevice d, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* sets)
{
    return fails() ? driver.failure : vkAllocateDescriptorSets(d, info, sets);
}

static VKAPI_ATTR VkResult VKAPI_CALL my_vkResetDescriptorPool(VkDevice d, VkDescriptorPool pool,
                                                               VkDescriptorPoolResetFlags flags)
{
    return fails() ? driver.failure : vkResetDescriptorPool(d, pool, flags);
}

static VKAPI_ATTR VkResult VKAPI_CALL
my_vkSetDebugUtilsObjectNameEXT(VkDevice d, const VkDebugUtilsObjectNameInfoEXT* info)
{
    (void)d;
    assert_true(info->objectHandle != 0 && info->pObjectName[0] != '\0');
    ++driver.names;
    return VK_ERROR_OUT_OF_HOST_MEMORY; /* of no consequence */
}

#define ROW(name)                                                                                  \
    {                                                                                              \
        "vk" #name, (PFN_vkVoidFunction)my_vk##name                                                \
    }

static PFN_vkVoidFunction VKAPI_CALL my_vkGetDeviceProcAddr(VkDevice d, const char* name)
{
    static const struct {
        const char* name;
        PFN_vkVoidFunction function;
    } ours[] = {ROW(AllocateMemory),
                ROW(CreateBuffer),
                ROW(CreateDescriptorPool),
                ROW(CreateDescriptorSetLayout),
                ROW(CreateImage),
                ROW(CreateImageView),
                ROW(CreatePipelineLayout),
                ROW(CreateSampler),
                ROW(CreateShaderModule),
                ROW(CreateComputePipelines),
                ROW(FreeMemory),
                ROW(DestroyBuffer),
                ROW(DestroyDescriptorPool),
                ROW(DestroyDescriptorSetLayout),
                ROW(DestroyImage),
                ROW(DestroyImageView),
                ROW(DestroyPipeline),
                ROW(DestroyPipelineLayout),
                ROW(DestroySampler),
                ROW(DestroyShaderModule),
                ROW(BindBufferMemory),
                ROW(BindImageMemory),
                ROW(AllocateDescriptorSets),
                ROW(ResetDescriptorPool)};
    if (driver.hidden && strcmp(name, driver.hidden) == 0) {
        return NULL;
    }
    for (size_t i = 0; i < sizeof ours / sizeof ours[0]; ++i) {
        if (strcmp(name, ours[i].name) == 0) {
            return ours[i].function;
        }
    }
    return vkGetDeviceProcAddr(d, name);
}

static VKAPI_ATTR void VKAPI_CALL my_vkGetPhysicalDeviceProperties(VkPhysicalDevice physical,
                                                                   VkPhysicalDeviceProperties* p)
{
    vkGetPhysicalDeviceProperties(physical, p);
    if (driver.storage_buffers) {
        p->limits.maxPerStageDescriptorStorageBuffers = driver.storage_buffers;
    }
    if (driver.threads) {
        p->limits.maxComputeWorkGroupInvocations = driver.threads;
    }
    if (driver.shared_bytes) {
        p->limits.maxComputeSharedMemorySize = driver.shared_bytes;
    }
    if (driver.version) {
        p->apiVersion = driver.version;
    }
}

/* What an older device would say is no affair of this: it must not be asked. */
static VKAPI_ATTR void VKAPI_CALL my_vkGetPhysicalDeviceProperties2(VkPhysicalDevice physical,
                                                                    VkPhysicalDeviceProperties2* p)
{
    ++driver.sizes_asked;
    vkGetPhysicalDeviceProperties2(physical, p);
}

static PFN_vkVoidFunction VKAPI_CALL my_vkGetInstanceProcAddr(VkInstance instance, const char* name)
{
    if (driver.hidden && strcmp(name, driver.hidden) == 0) {
        return NULL;
    }
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) {
        return (PFN_vkVoidFunction)my_vkGetDeviceProcAddr;
    }
    if (strcmp(name, "vkGetPhysicalDeviceProperties") == 0) {
        return (PFN_vkVoidFunction)my_vkGetPhysicalDeviceProperties;
    }
    if (strcmp(name, "vkGetPhysicalDeviceProperties2") == 0) {
        return (PFN_vkVoidFunction)my_vkGetPhysicalDeviceProperties2;
    }
    if (strcmp(name, "vkSetDebugUtilsObjectNameEXT") == 0) {
        return (PFN_vkVoidFunction)my_vkSetDebugUtilsObjectNameEXT;
    }
    return vkGetInstanceProcAddr(instance, name);
}

static hdrp_gpu_vk_desc failing_desc(void)
{
    hdrp_gpu_vk_desc desc = gpu_desc(&device);
    desc.get_instance_proc_addr = my_vkGetInstanceProcAddr;
    return desc;
}

static int set_up(void** state)
{
    (void)state;
    memset(&driver, 0, sizeof driver);
    driver.fail_at = -1;
    return 0;
}

static int tear_down(void** state)
{
    (void)state;
    return driver.live != 0 || device.messages != 0;
}

/* ---- what is missing ------------------------------------------------------------------------- */

static void expect_missing(const hdrp_gpu_vk_desc* desc, const char* name)
{
    assert_string_equal(hdrp_gpu_vk_missing(desc, 0), name);
    assert_null(hdrp_gpu_vk_missing(desc, 1));
}

static void what_is_missing_has_a_name(void** state)
{
    const VkPhysicalDeviceFeatures none = {0};
    hdrp_gpu_vk_desc desc = failing_desc();
    hdrp_gpu_vk gpu;
    (void)state;
    memset(&gpu, 0x5a, sizeof gpu);
    assert_null(hdrp_gpu_vk_missing(&desc, 0));
    desc.features = NULL;
    expect_missing(&desc, "shaderStorageImageWriteWithoutFormat");
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_ERROR_UNSUPPORTED);
    desc.features = &none;
    expect_missing(&desc, "shaderStorageImageWriteWithoutFormat");
    desc.queue_family = 63;
    assert_string_equal(hdrp_gpu_vk_missing(&desc, 0), "VK_QUEUE_COMPUTE_BIT in the queue family");
    assert_string_equal(hdrp_gpu_vk_missing(&desc, 1), "shaderStorageImageWriteWithoutFormat");
    assert_null(hdrp_gpu_vk_missing(&desc, 2));
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_ERROR_UNSUPPORTED);
    desc = failing_desc();
    driver.hidden = "vkCmdDispatch";
    expect_missing(&desc, "vkCmdDispatch");
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_ERROR_UNSUPPORTED);
    driver.hidden = "vkGetPhysicalDeviceFormatProperties";
    expect_missing(&desc, "vkGetPhysicalDeviceFormatProperties");
    driver.hidden = NULL;
    driver.storage_buffers = 9; /* lists need one more, measuring depth one at all */
    expect_missing(&desc, "maxPerStageDescriptorStorageBuffers");
    desc.passes = HDRP_GPU_VK_PASS_DEPTH;
    assert_null(hdrp_gpu_vk_missing(&desc, 0));
    driver.storage_buffers = 11; /* lighting needs more, for blockers */
    desc.passes = HDRP_GPU_VK_PASS_LISTS;
    assert_null(hdrp_gpu_vk_missing(&desc, 0));
    desc.passes = HDRP_GPU_VK_PASS_LIGHT;
    expect_missing(&desc, "maxPerStageDescriptorStorageBuffers");
    driver.storage_buffers = 12;
    assert_null(hdrp_gpu_vk_missing(&desc, 0));
    desc.passes = 0;
    driver.storage_buffers = 0;
    driver.threads = 128; /* as few as Vulkan allows: lighting needs more, the others do not */
    expect_missing(&desc, "maxComputeWorkGroupInvocations");
    desc.passes = HDRP_GPU_VK_PASS_ALL & ~HDRP_GPU_VK_PASS_LIGHT;
    assert_null(hdrp_gpu_vk_missing(&desc, 0));
    desc.passes = 0;
    driver.threads = 0;
    driver.shared_bytes = 16384; /* likewise, the environment */
    expect_missing(&desc, "maxComputeSharedMemorySize");
    desc.passes = HDRP_GPU_VK_PASS_ALL & ~HDRP_GPU_VK_PASS_ENVIRONMENT;
    assert_null(hdrp_gpu_vk_missing(&desc, 0));
    desc.passes = 0;
    driver.shared_bytes = 0;
    desc.device = VK_NULL_HANDLE;
    desc.get_instance_proc_addr = NULL;
    assert_string_equal(hdrp_gpu_vk_missing(&desc, 0), "device");
    assert_string_equal(hdrp_gpu_vk_missing(&desc, 1), "get_instance_proc_addr");
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_ERROR_NULL_POINTER);
    expect_missing(NULL, "desc");
    for (size_t i = 0; i < sizeof gpu; ++i) {
        assert_int_equal(((unsigned char*)&gpu)[i], 0x5a);
    }
}

/* Their sizes decide how many threads build lists. */
static void subgroups_of_old_devices_are_not_asked_for(void** state)
{
    hdrp_gpu_vk_desc desc = failing_desc();
    VkPhysicalDeviceProperties properties;
    hdrp_gpu_vk gpu;
    (void)state;
    desc.passes = HDRP_GPU_VK_PASS_DEPTH;
    driver.version = VK_API_VERSION_1_2;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    assert_int_equal(driver.sizes_asked, 0);
    assert_int_equal(gpu.group, 64);
    assert_int_equal(gpu.one_subgroup, 0);
    hdrp_gpu_vk_destroy(&gpu);
    driver.version = 0;
    vkGetPhysicalDeviceProperties(device.physical, &properties);
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    assert_int_equal(driver.sizes_asked, properties.apiVersion >= VK_API_VERSION_1_3);
    hdrp_gpu_vk_destroy(&gpu);
}

static void descs_out_of_range_are_refused(void** state)
{
    hdrp_gpu_vk gpu;
    hdrp_gpu_vk_desc desc = failing_desc();
    (void)state;
    assert_int_equal(hdrp_gpu_vk_init(NULL, &desc), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_init(&gpu, NULL), HDRP_ERROR_NULL_POINTER);
    desc.passes = HDRP_GPU_VK_PASS_ALL + 1u;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_ERROR_BAD_ARGUMENT);
    desc = failing_desc();
    desc.frames = HDRP_GPU_VK_FRAMES_MAX + 1u;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_ERROR_BAD_ARGUMENT);
    desc = failing_desc();
    desc.frame_passes = 65537;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(driver.calls, 0);
}

static void passes_that_are_not_asked_for_are_not_made(void** state)
{
    hdrp_gpu_vk gpu;
    hdrp_gpu_vk_desc desc = failing_desc();
    hdrp_gpu_vk_image table;
    (void)state;
    desc.features = NULL; /* which the pass needs none of */
    desc.passes = HDRP_GPU_VK_PASS_DEPTH;
    desc.frames = 1;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    assert_int_equal(driver.live, 5); /* a sampler, a set layout, a layout, a pipeline, a pool */
    assert_int_equal(driver.names, 1);
    assert_true(gpu.pipelines[0].pipeline == VK_NULL_HANDLE);
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32G32_SFLOAT, 4, 4,
                                              VK_IMAGE_USAGE_STORAGE_BIT, "table", &table),
                     HDRP_OK);
    assert_int_equal(driver.names, 2);
    assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, gpu_begin(&device), &table),
                     HDRP_ERROR_UNSUPPORTED);
    gpu_run(&device);
    hdrp_gpu_vk_image_destroy(&gpu, &table);
    hdrp_gpu_vk_destroy(&gpu);
    hdrp_gpu_vk_destroy(&gpu);
    hdrp_gpu_vk_destroy(NULL);
}

/* ---- what fails ------------------------------------------------------------------------------ */

static const struct {
    VkResult said;
    hdrp_result meant;
} failures[] = {{VK_ERROR_OUT_OF_HOST_MEMORY, HDRP_ERROR_OUT_OF_HOST_MEMORY},
                {VK_ERROR_OUT_OF_DEVICE_MEMORY, HDRP_ERROR_OUT_OF_DEVICE_MEMORY},
                {VK_ERROR_DEVICE_LOST, HDRP_ERROR_DEVICE_LOST},
                {VK_ERROR_INITIALIZATION_FAILED, HDRP_ERROR_DRIVER}};

/* Everything that a context can make. */
typedef struct resources {
    hdrp_gpu_vk_buffer shapes;
    hdrp_gpu_vk_image table, sky, shown;
    hdrp_gpu_vk_cube cube;
    hdrp_gpu_vk_env env;
    hdrp_gpu_vk_lists lists;
    hdrp_gpu_vk_variants variants;
    hdrp_gpu_vk_tiles tiles;
    hdrp_gpu_vk_buffer params, views;
    hdrp_gpu_vk_image lit, visibility, composed;
} resources;

/* What lighting and shadows need besides. */
static hdrp_result make_lighting(const hdrp_gpu_vk* gpu, resources* made)
{
    const uint32_t word = HDRP_GPU_VK_WORD_LIT;
    const VkImageUsageFlags both = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    hdrp_result r = hdrp_gpu_vk_tiles_create(gpu, made->lists.grid, &made->tiles);
    r = r == HDRP_OK ? hdrp_gpu_vk_buffer_create(gpu, HDRP_GPU_VK_LIGHTING_BYTES,
                                                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                 local, "params", &made->params)
                     : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_buffer_create(gpu, sizeof(hdrp_shadow_view),
                                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, local, "views",
                                                 &made->views)
                     : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_image_create(gpu, VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, both,
                                                "lit", &made->lit)
                     : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_image_create(gpu, VK_FORMAT_R8G8B8A8_UNORM, 8, 8, both,
                                                "visibility", &made->visibility)
                     : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_image_create(gpu, VK_FORMAT_R16G16B16A16_SFLOAT, 8, 8, both,
                                                "composed", &made->composed)
                     : r;
    /* Last: it takes longest. */
    return r == HDRP_OK ? hdrp_gpu_vk_variants_create(gpu, &word, 1, &made->variants) : r;
}

static hdrp_result make_resources(const hdrp_gpu_vk* gpu, resources* made)
{
    const hdrp_env_desc small = {4, 4, 0, 2, 0.0f};
    hdrp_cull_desc cull = {0};
    const VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
    const VkImageUsageFlags both = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    hdrp_result r =
        hdrp_gpu_vk_buffer_create(gpu, 4096, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                  VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, "shapes", &made->shapes);
    r = r == HDRP_OK ? hdrp_gpu_vk_image_create(gpu, VK_FORMAT_R32G32_SFLOAT, 2, 2, both, "table",
                                                &made->table)
                     : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_image_create(gpu, format, 8, 8, both, "sky", &made->sky) : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_image_create(gpu, VK_FORMAT_R8G8B8A8_UNORM, 2, 1, both, "shown",
                                                &made->shown)
                     : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_cube_create(gpu, format, 8, 4, both, "cube", &made->cube) : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_env_create(gpu, &small, format, &made->env) : r;
    cull.width_px = cull.height_px = 8;
    cull.slice_count = 1;
    cull.flags = HDRP_CULL_MASKS;
    r = r == HDRP_OK ? hdrp_gpu_vk_lists_create(gpu, &cull, &made->lists) : r;
    return r == HDRP_OK ? make_lighting(gpu, made) : r;
}

static void destroy_resources(const hdrp_gpu_vk* gpu, resources* made)
{
    hdrp_gpu_vk_image_destroy(gpu, &made->composed);
    hdrp_gpu_vk_image_destroy(gpu, &made->visibility);
    hdrp_gpu_vk_image_destroy(gpu, &made->lit);
    hdrp_gpu_vk_buffer_destroy(gpu, &made->views);
    hdrp_gpu_vk_buffer_destroy(gpu, &made->params);
    hdrp_gpu_vk_tiles_destroy(gpu, &made->tiles);
    hdrp_gpu_vk_variants_destroy(gpu, &made->variants);
    hdrp_gpu_vk_lists_destroy(gpu, &made->lists);
    hdrp_gpu_vk_env_destroy(gpu, &made->env);
    hdrp_gpu_vk_cube_destroy(gpu, &made->cube);
    hdrp_gpu_vk_image_destroy(gpu, &made->shown);
    hdrp_gpu_vk_image_destroy(gpu, &made->sky);
    hdrp_gpu_vk_image_destroy(gpu, &made->table);
    hdrp_gpu_vk_buffer_destroy(gpu, &made->shapes);
}

/* Lighting by the lists, with shadows of one directional light; any image serves as input. */
static hdrp_result record_lighting(hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                   const resources* made)
{
    hdrp_gpu_vk_lighting lighting = {0};
    hdrp_gpu_vk_shadow shadow = {0};
    hdrp_gpu_vk_lit lit = {0};
    hdrp_result r;
    shadow.width_px = shadow.height_px = lighting.width_px = lighting.height_px = 8;
    shadow.depth = shadow.normals = shadow.atlas = lighting.depth = made->sky.view;
    shadow.camera = lighting.camera = made->lists.camera;
    shadow.views = made->views.buffer;
    shadow.view_count = 1;
    shadow.cascades[0] = 1;
    lighting.params = made->params.buffer;
    for (int i = 0; i < 5; ++i) {
        lighting.rt[i] = made->sky.view;
    }
    lighting.grid = made->lists.grid;
    lighting.list_flags = made->lists.desc.flags;
    lighting.tiles.buffer = made->lists.tiles.buffer;
    lighting.cells.buffer = made->lists.cells.buffer;
    lighting.entries.buffer = made->lists.entries.buffer;
    lighting.masks.buffer = made->lists.masks.buffer;
    lighting.lights.buffer = made->shapes.buffer; /* large enough for a light */
    lighting.light_count = 1;
    lighting.specular = made->env.specular.view;
    lighting.specular_levels = made->env.specular.level_count;
    lighting.irradiance = made->env.irradiance.view;
    lit.color = made->lit.view;
    r = hdrp_gpu_vk_resolve_shadows(gpu, commands, &shadow, &made->visibility);
    r = r == HDRP_OK ? hdrp_gpu_vk_write_lighting(gpu, commands, &lighting) : r;
    r = r == HDRP_OK ? hdrp_gpu_vk_classify(gpu, commands, &lighting, &made->variants, &made->tiles)
                     : r;
    return r == HDRP_OK ? hdrp_gpu_vk_light_deferred(gpu, commands, &lighting, &made->variants,
                                                     &made->tiles, &lit)
                        : r;
}

/* Any images serve as targets. */
static hdrp_result record_composite(hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                    const resources* made)
{
    hdrp_gpu_vk_oit oit = {0};
    oit.mode = HDRP_OIT_MODE_WAVELET;
    oit.full.width_px = oit.full.height_px = 8;
    oit.full.targets[0] = oit.full.targets[1] = made->sky.view;
    oit.low = &oit.full;
    oit.opaque = made->lit.view;
    oit.opaque_layout = VK_IMAGE_LAYOUT_GENERAL;
    oit.color = &made->composed;
    return hdrp_gpu_vk_oit_composite(gpu, commands, &oit);
}

static hdrp_result record_passes(hdrp_gpu_vk* gpu, VkCommandBuffer commands, resources* made)
{
    hdrp_gpu_vk_cull_frame frame = {0};
    hdrp_gpu_vk_env_image sky = {0};
    hdrp_gpu_vk_tone_map map = {0};
    hdrp_result r = hdrp_gpu_vk_fgd_bake(gpu, commands, &made->table);
    sky.view = map.source = made->sky.view;
    sky.layout = map.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    sky.width_px = 2;
    sky.height_px = 1;
    map.target = &made->shown;
    r = r == HDRP_OK ? hdrp_gpu_vk_env_bake(gpu, commands, &made->env, &sky) : r;
    frame.camera = hdrp_cull_camera_perspective(hdrp_v3_splat(0.0f), hdrp_v3_splat(1.0f),
                                                hdrp_v3_make(0.0f, 1.0f, 0.0f), -1.0f, 1.0f, -1.0f,
                                                1.0f, 0.1f, 10.0f);
    frame.shapes = made->shapes.buffer;
    frame.count = 1;
    frame.view = made->sky.view;
    frame.layout = sky.layout;
    r = r == HDRP_OK ? hdrp_gpu_vk_build_lists(gpu, commands, &made->lists, &frame) : r;
    r = r == HDRP_OK ? record_lighting(gpu, commands, made) : r;
    r = r == HDRP_OK ? record_composite(gpu, commands, made) : r;
    return r == HDRP_OK ? hdrp_gpu_vk_tone_map_record(gpu, commands, &map) : r;
}

/* Resources, and a frame that is recorded and thrown away. The first error, or HDRP_OK. */
static hdrp_result use(hdrp_gpu_vk* gpu)
{
    resources made = {0};
    VkCommandBuffer commands = gpu_begin(&device);
    hdrp_result r = make_resources(gpu, &made);
    r = r == HDRP_OK ? hdrp_gpu_vk_begin_frame(gpu, 1) : r;
    r = r == HDRP_OK ? record_passes(gpu, commands, &made) : r;
    assert_int_equal(vkEndCommandBuffer(commands), VK_SUCCESS);
    assert_int_equal(vkResetCommandBuffer(commands, 0), VK_SUCCESS);
    destroy_resources(gpu, &made);
    return r;
}

/* The next pass behind one of them, from 0 on; 0 behind the last. */
static uint32_t next_pass(uint32_t pass)
{
    do {
        pass = pass ? pass << 1 : 1u;
    } while (pass && !(pass & HDRP_GPU_VK_PASS_ALL));
    return pass;
}

/* Passes are made one by one, which takes less time than all of them for each call. */
static void no_context_that_fails_leaves_anything(void** state)
{
    hdrp_gpu_vk_desc desc = failing_desc();
    int count = 0;
    (void)state;
    for (desc.passes = next_pass(0); desc.passes; desc.passes = next_pass(desc.passes)) {
        hdrp_gpu_vk gpu;
        int calls;
        driver.calls = 0;
        driver.fail_at = -1;
        assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
        calls = driver.calls;
        hdrp_gpu_vk_destroy(&gpu);
        assert_int_equal(driver.live, 0);
        for (int at = 0; at < calls; ++at, ++count) {
            /* Neighbours are calls of different functions: each fails in every way somewhere. */
            size_t i = (size_t)(at + at / 4 + count) % (sizeof failures / sizeof failures[0]);
            driver.failure = failures[i].said;
            driver.calls = 0;
            driver.fail_at = at;
            assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), failures[i].meant);
            assert_int_equal(driver.calls, at + 1);
            assert_int_equal(driver.live, 0);
        }
    }
    printf("%d calls of contexts that may fail\n", count);
}

static void no_resource_and_no_frame_that_fails_leaves_anything(void** state)
{
    const hdrp_gpu_vk_desc desc = failing_desc();
    hdrp_gpu_vk gpu;
    int calls, before;
    (void)state;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    before = driver.live;
    driver.calls = 0;
    assert_int_equal(use(&gpu), HDRP_OK);
    calls = driver.calls;
    printf("%d calls of resources and frames that may fail\n", calls);
    assert_int_equal(driver.live, before);
    for (int at = 0; at < calls; ++at) {
        size_t i = (size_t)(at + at / 4) % (sizeof failures / sizeof failures[0]);
        driver.failure = failures[i].said;
        driver.calls = 0;
        driver.fail_at = at;
        assert_int_equal(use(&gpu), failures[i].meant);
        assert_int_equal(driver.calls, at + 1);
        assert_int_equal(driver.live, before);
    }
    hdrp_gpu_vk_destroy(&gpu);
}

/* An allocator of the host that counts and fails. The size stands in front of each block. */
typedef struct host_memory {
    int live, calls, fail_at;
} host_memory;

static void* VKAPI_CALL host_allocate(void* user, size_t bytes, size_t alignment,
                                      VkSystemAllocationScope scope)
{
    host_memory* host = user;
    size_t front = alignment > 2 * sizeof(size_t) ? alignment : 2 * sizeof(size_t);
    unsigned char* block;
    (void)scope;
    if (host->calls++ == host->fail_at || bytes == 0) {
        return NULL;
    }
    block = aligned_alloc(front, (front + bytes + front - 1) / front * front);
    if (!block) {
        return NULL;
    }
    ++host->live;
    memcpy(block + front - sizeof bytes, &bytes, sizeof bytes);
    memcpy(block + front - 2 * sizeof bytes, &front, sizeof front);
    return block + front;
}

static void VKAPI_CALL host_free(void* user, void* memory)
{
    host_memory* host = user;
    size_t front;
    if (memory) {
        --host->live;
        memcpy(&front, (unsigned char*)memory - 2 * sizeof front, sizeof front);
        free((unsigned char*)memory - front);
    }
}

static void* VKAPI_CALL host_reallocate(void* user, void* old, size_t bytes, size_t alignment,
                                        VkSystemAllocationScope scope)
{
    size_t had = 0;
    void* made = bytes ? host_allocate(user, bytes, alignment, scope) : NULL;
    if (old && (made || bytes == 0)) {
        memcpy(&had, (unsigned char*)old - sizeof had, sizeof had);
        if (made) {
            memcpy(made, old, had < bytes ? had : bytes);
        }
        host_free(user, old);
    }
    return made;
}

/* Drivers may do without some of what they ask for. */
static void expect_memory_to_be_short(hdrp_result r)
{
    assert_true(r == HDRP_OK || r == HDRP_ERROR_OUT_OF_HOST_MEMORY ||
                r == HDRP_ERROR_OUT_OF_DEVICE_MEMORY);
}

static void every_allocation_of_the_host_may_fail(void** state)
{
    host_memory host = {0, 0, -1};
    const VkAllocationCallbacks callbacks = {.pUserData = &host,
                                             .pfnAllocation = host_allocate,
                                             .pfnReallocation = host_reallocate,
                                             .pfnFree = host_free};
    hdrp_gpu_vk_desc desc = failing_desc();
    hdrp_gpu_vk gpu;
    int calls, before, count = 0;
    (void)state;
    desc.allocation = &callbacks;
    driver.allocation = &callbacks;
    for (desc.passes = next_pass(0); desc.passes; desc.passes = next_pass(desc.passes)) {
        host.calls = 0;
        host.fail_at = -1;
        assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
        calls = host.calls;
        hdrp_gpu_vk_destroy(&gpu);
        for (int at = 0; at < calls; ++at, ++count) {
            hdrp_result r;
            host.calls = 0;
            host.fail_at = at;
            r = hdrp_gpu_vk_init(&gpu, &desc);
            expect_memory_to_be_short(r);
            if (r == HDRP_OK) {
                hdrp_gpu_vk_destroy(&gpu);
            }
            assert_int_equal(host.live, 0);
            assert_int_equal(driver.live, 0);
        }
    }
    desc.passes = 0;
    host.fail_at = -1;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    before = host.live;
    host.calls = 0;
    assert_int_equal(use(&gpu), HDRP_OK);
    calls = host.calls;
    for (int at = 0; at < calls; ++at, ++count) {
        host.calls = 0;
        host.fail_at = at;
        expect_memory_to_be_short(use(&gpu));
        assert_int_equal(host.live, before);
    }
    printf("%d allocations of the host\n", count);
    hdrp_gpu_vk_destroy(&gpu);
    assert_int_equal(host.live, 0);
}

/* Memory of the caller: one piece, handed out from the middle. */
typedef struct device_memory {
    VkDeviceMemory memory;
    VkMemoryPropertyFlags wanted;
    VkDeviceSize used;
    int live, calls, fail_at; /* -1: none fails */
} device_memory;

static VkResult take_memory(void* user, const VkMemoryRequirements* required,
                            VkMemoryPropertyFlags properties, hdrp_gpu_vk_block* block)
{
    device_memory* m = user;
    m->wanted = properties;
    if (m->calls++ == m->fail_at || (required->memoryTypeBits & 1u) == 0) {
        block->memory = m->memory; /* what is left of a failure does not matter */
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    m->used = (m->used + required->alignment - 1) / required->alignment * required->alignment;
    block->memory = m->memory;
    block->offset = m->used;
    block->handle = m;
    m->used += required->size;
    ++m->live;
    return VK_SUCCESS;
}

static void give_memory(void* user, const hdrp_gpu_vk_block* block)
{
    device_memory* m = user;
    assert_ptr_equal(block->handle, m);
    assert_true(block->memory == m->memory);
    --m->live;
}

static void memory_comes_from_the_caller(void** state)
{
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = 1 << 24};
    device_memory m = {.used = 4096, .fail_at = -1};
    hdrp_gpu_vk_desc desc = failing_desc();
    hdrp_gpu_vk gpu;
    hdrp_gpu_vk_buffer buffer;
    hdrp_gpu_vk_image image;
    (void)state;
    assert_int_equal(vkAllocateMemory(device.device, &info, NULL, &m.memory), VK_SUCCESS);
    desc.memory.allocate = take_memory;
    desc.memory.user = &m;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_ERROR_BAD_ARGUMENT);
    desc.memory.release = give_memory;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    assert_int_equal(use(&gpu), HDRP_OK);
    assert_int_equal(m.live, 0);
    assert_true(m.used > 4096);
    for (int calls = m.calls, at = 0; at < calls; ++at) {
        m.calls = 0;
        m.used = 4096;
        m.fail_at = at;
        assert_int_equal(use(&gpu), HDRP_ERROR_OUT_OF_DEVICE_MEMORY);
        assert_int_equal(m.calls, at + 1);
        assert_int_equal(m.live, 0);
    }
    m.used = 4096;
    m.fail_at = -1;
    assert_int_equal(hdrp_gpu_vk_buffer_create(&gpu, 100, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                               VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, NULL, &buffer),
                     HDRP_OK);
    assert_int_equal(m.wanted, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT);
    assert_true(buffer.block.memory == m.memory && buffer.block.offset >= 4096);
    hdrp_gpu_vk_buffer_destroy(&gpu, &buffer);
    m.fail_at = m.calls;
    assert_int_equal(
        hdrp_gpu_vk_buffer_create(&gpu, 100, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, 0, NULL, &buffer),
        HDRP_ERROR_OUT_OF_DEVICE_MEMORY);
    m.fail_at = m.calls;
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32_SFLOAT, 1, 1,
                                              VK_IMAGE_USAGE_SAMPLED_BIT, NULL, &image),
                     HDRP_ERROR_OUT_OF_DEVICE_MEMORY);
    assert_int_equal(m.live, 0);
    hdrp_gpu_vk_destroy(&gpu);
    vkFreeMemory(device.device, m.memory, NULL);
}

static void resources_out_of_range_are_refused(void** state)
{
    const hdrp_gpu_vk_desc desc = failing_desc();
    hdrp_gpu_vk gpu;
    hdrp_gpu_vk_buffer buffer = {0};
    hdrp_gpu_vk_image image = {0};
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkFormat format = VK_FORMAT_R32_SFLOAT;
    (void)state;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_buffer_create(NULL, 1, 32, 0, NULL, &buffer),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_buffer_create(&gpu, 1, 32, 0, NULL, NULL),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_buffer_create(&gpu, 0, 32, 0, NULL, &buffer),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_buffer_create(&gpu, 1, 0, 0, NULL, &buffer),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_buffer_create(&gpu, 1, 32, 0x40000000u, NULL, &buffer),
                     HDRP_ERROR_UNSUPPORTED);
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, format, 0, 1, sampled, NULL, &image),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, format, 1, 16385, sampled, NULL, &image),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, format, 1, 1, 0, NULL, &image),
                     HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, format, 1, 1, sampled, NULL, NULL),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(
        hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_UNDEFINED, 1, 1, sampled, NULL, &image),
        HDRP_ERROR_UNSUPPORTED);
    hdrp_gpu_vk_buffer_destroy(&gpu, &buffer);
    hdrp_gpu_vk_buffer_destroy(&gpu, NULL);
    hdrp_gpu_vk_image_destroy(&gpu, &image);
    hdrp_gpu_vk_image_destroy(NULL, NULL);
    hdrp_gpu_vk_destroy(&gpu);
}

static void frames_take_back_what_they_gave(void** state)
{
    hdrp_gpu_vk_desc desc = failing_desc();
    hdrp_gpu_vk gpu;
    hdrp_gpu_vk_image table;
    (void)state;
    desc.frames = 3;
    desc.frame_passes = 2;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_image_create(
                         &gpu, VK_FORMAT_R32G32_SFLOAT, 2, 2,
                         VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, "table", &table),
                     HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_begin_frame(NULL, 0), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 3), HDRP_ERROR_BAD_ARGUMENT);
    for (uint32_t frame = 0; frame < 9; ++frame) {
        VkCommandBuffer commands = gpu_begin(&device);
        assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, frame % 3), HDRP_OK);
        assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &table), HDRP_OK);
        assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &table), HDRP_OK);
        assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &table),
                         HDRP_ERROR_OUT_OF_DEVICE_MEMORY);
        gpu_run(&device);
    }
    hdrp_gpu_vk_image_destroy(&gpu, &table);
    hdrp_gpu_vk_destroy(&gpu);
}

static void a_pipeline_cache_is_used(void** state)
{
    const VkPipelineCacheCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    hdrp_gpu_vk_desc desc = failing_desc();
    hdrp_gpu_vk gpu;
    (void)state;
    assert_int_equal(vkCreatePipelineCache(device.device, &info, NULL, &driver.cache), VK_SUCCESS);
    desc.pipeline_cache = driver.cache;
    assert_int_equal(hdrp_gpu_vk_init(&gpu, &desc), HDRP_OK);
    vkDestroyPipelineCache(device.device, driver.cache, NULL);
    hdrp_gpu_vk_destroy(&gpu);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_is_missing_has_a_name),
        TEST(subgroups_of_old_devices_are_not_asked_for),
        TEST(descs_out_of_range_are_refused),
        TEST(passes_that_are_not_asked_for_are_not_made),
        TEST(no_context_that_fails_leaves_anything),
        TEST(no_resource_and_no_frame_that_fails_leaves_anything),
        TEST(every_allocation_of_the_host_may_fail),
        TEST(memory_comes_from_the_caller),
        TEST(resources_out_of_range_are_refused),
        TEST(frames_take_back_what_they_gave),
        TEST(a_pipeline_cache_is_used),
    };
    int failed;
    if (!gpu_open_writing(&device)) {
        return GPU_SKIPPED;
    }
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    gpu_close(&device);
    return failed || device.messages;
}
