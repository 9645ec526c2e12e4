/* hdrp_gpu_vk.h - the passes on the GPU: Vulkan compute, in the caller's command buffers.
 * SPDX-License-Identifier: MIT
 *
 * For an engine that has a device and a command buffer. The passes, which this header includes, are
 * in a header for each topic, with their SPIR-V at its end, made from shaders/, whose formulas are
 * those of the other headers. Vulkan 1.1 and <vulkan/...> are all that is needed: every function
 * comes from the caller's loader, none from a library.
 *
 *     #define HDRP_GPU_VK_IMPLEMENTATION        in one source file
 *     #include "hdrp_gpu_vk.h"
 *
 * Once; a desc of zeros with these members is the default, and what a device lacks has a name:
 *
 *     desc.instance = instance, desc.physical_device = physical, desc.device = device;
 *     desc.queue_family = family, desc.get_instance_proc_addr = vkGetInstanceProcAddr;
 *     desc.features = &features;                          those that the device was made with
 *     for (i = 0; hdrp_gpu_vk_missing(&desc, i); ++i) puts(hdrp_gpu_vk_missing(&desc, i));
 *     hdrp_gpu_vk_init(&gpu, &desc);
 *
 * Each frame, where what was recorded for the same number before has been executed:
 *
 *     hdrp_gpu_vk_begin_frame(&gpu, frame_number % 2);
 *     hdrp_gpu_vk_build_lists(&gpu, commands, &lists, &frame);        reads depth, draw it before
 *     ... the caller draws the GBuffer, and shadow maps: hdrp_gpu_vk_shadow_raster_of
 *     hdrp_gpu_vk_resolve_shadows(&gpu, commands, &shadow, &mask);    reads depth, normals, maps
 *     hdrp_gpu_vk_write_lighting(&gpu, commands, &lighting);          names all of these
 *     hdrp_gpu_vk_classify(&gpu, commands, &lighting, &variants, &tiles);
 *     hdrp_gpu_vk_light_deferred(&gpu, commands, &lighting, &variants, &tiles, &lit);
 *     ... the caller draws forward surfaces: shaders/light_loop.glsl
 *     ... and transparent ones, into targets of their own: shaders/oit_output.glsl
 *     hdrp_gpu_vk_oit_composite(&gpu, commands, &oit);
 *     hdrp_gpu_vk_tone_map_record(&gpu, commands, &map);
 *
 * all outside of render passes. hdrp_gpu_vk_fgd_bake is for once, hdrp_gpu_vk_env_bake for when the
 * sky changes. A pass that is not wanted is left out, here and in desc.passes; the program
 * examples/vk_minimal.c lights a picture. Nothing is submitted and nothing is waited for.
 *
 * A pass does what a function does on the CPU: hdrp_cull_build, hdrp_shadow_cascades_visibility,
 * hdrp_cull_assign_variants, hdrp_brdf_lit_eval, hdrp_oit_composite_rows. Each says in which
 * layouts it takes and leaves images. What it writes may have been read or written by compute and
 * fragment shaders and by copies in earlier commands of the same queue, and may be read by them in
 * later ones: the barriers for that are recorded. What it reads is for the caller to make visible
 * to the compute stage, and so is what comes from another queue or goes there.
 *
 * Memory: images, and buffers of shapes, lights and views, are the caller's; passes hold them until
 * they have been executed, and structs until the call returns. What ..._create makes (lists, tiles,
 * variants, environments) is in memory of desc.memory until ..._destroy; one of each serves all
 * frames in flight of a queue. To resize is to make others. Memory of the host is asked for by the
 * driver alone, through desc.allocation.
 *
 * Lists depend on no shading: a context of its own, for the family of a queue that only computes,
 * records them there while the graphics queue draws shadows. Their buffers are of exclusive
 * sharing, so that the caller hands them over with a semaphore and, between families, a pair of
 * barriers; back too, before they are built again, or there are lists for each frame in flight.
 *
 * What passes need beside Vulkan 1.1 and a queue that computes; hdrp_gpu_vk_missing checks it:
 *
 *     lists, blockers   10 storage buffers of a shader
 *     lighting          12 of them, 13 sampled images, 2 storage images
 *     environments      18432 bytes of memory that a group shares
 *     all but lists, blockers and depth: the feature shaderStorageImageWriteWithoutFormat
 *
 * hdrp_gpu_vk_lists_create needs the bodies of hdrp_cull.h: HDRP_CULL_IMPLEMENTATION in one file.
 *
 * Pipelines, sets and push constants of VK_PIPELINE_BIND_POINT_COMPUTE are not what they were after
 * a pass. An hdrp_gpu_vk is not locked: threads that record at the same time need one each.
 *
 * >>index of the functions, without hdrp_gpu_vk_ (written by tools/api_check.py --write)
 *   context: missing init destroy begin_frame
 * >>end */
#ifndef HDRP_GPU_VK_H
#define HDRP_GPU_VK_H

#include "hdrp_gpu_vk_core.h"
#include "hdrp_gpu_vk_cull.h"
#include "hdrp_gpu_vk_env.h"
#include "hdrp_gpu_vk_light.h"
#include "hdrp_gpu_vk_oit.h"
#include "hdrp_gpu_vk_shadow.h"

#if HDRP_VERSION != 100
#error "hdrp_gpu_vk.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#ifndef HDRP_GPU
#ifdef __cplusplus
extern "C" {
#endif

/* >>context */

/** What a device lacks for the passes of a desc, one after the other.
 *  desc     as for hdrp_gpu_vk_init
 *  index    any  0 for the first
 *  returns  the name of a version, a feature, a limit or a function; NULL behind the last
 *  edges    desc itself is missing where it is NULL, and so is a member that must not be */
HDRP_API const char* hdrp_gpu_vk_missing(const hdrp_gpu_vk_desc* desc, uint32_t index);

/** Makes the pipelines of the passes that are asked for.
 *  gpu      result; to be destroyed by hdrp_gpu_vk_destroy
 *  desc     the caller's device and choices
 *  returns  HDRP_OK, or an error, with gpu untouched and nothing left on the device
 *  errors   HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for members out of their ranges,
 *           HDRP_ERROR_UNSUPPORTED where hdrp_gpu_vk_missing names something,
 *           HDRP_ERROR_OUT_OF_HOST_MEMORY, HDRP_ERROR_OUT_OF_DEVICE_MEMORY, HDRP_ERROR_DEVICE_LOST,
 *           HDRP_ERROR_DRIVER
 *  memory   the caller's device must outlive gpu */
HDRP_API hdrp_result hdrp_gpu_vk_init(hdrp_gpu_vk* gpu, const hdrp_gpu_vk_desc* desc);

/** Destroys what hdrp_gpu_vk_init made.
 *  gpu    NULL and a gpu of zeros are allowed; it is all zeros afterwards
 *  edges  what was recorded must have been executed, and resources be destroyed before */
HDRP_API void hdrp_gpu_vk_destroy(hdrp_gpu_vk* gpu);

/** Begins to record a frame: what the passes of the frame of that number needed is free again.
 *  gpu      from hdrp_gpu_vk_init
 *  frame    [0,7]  less than desc.frames; what was recorded under this number must have been
 *           executed
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT, and those of the driver as for
 *           hdrp_gpu_vk_init
 *  note     a new context records frame 0 */
HDRP_API hdrp_result hdrp_gpu_vk_begin_frame(hdrp_gpu_vk* gpu, uint32_t frame);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_GPU_VK_H */

#if defined(HDRP_GPU_VK_IMPLEMENTATION) && !defined(HDRP_GPU_VK_IMPLEMENTED) && !defined(HDRP_GPU)
#define HDRP_GPU_VK_IMPLEMENTED

/* Their bodies too, where they were included before the macro was defined. */
#include "hdrp_gpu_vk_core.h"
#include "hdrp_gpu_vk_cull.h"
#include "hdrp_gpu_vk_env.h"
#include "hdrp_gpu_vk_light.h"
#include "hdrp_gpu_vk_oit.h"
#include "hdrp_gpu_vk_shadow.h"

#ifdef __cplusplus
extern "C" {
#endif

#define HDRP_I_GPU_VK_FAMILIES_MAX 64u

/* The shaders of a header. */
typedef hdrp_i_gpu_vk_shader (*hdrp_i_gpu_vk_shader_of)(uint32_t);

#define HDRP_I_GPU_VK_TOPICS 5u

static hdrp_i_gpu_vk_shader_of hdrp_i_gpu_vk_topic(uint32_t topic)
{
    static const hdrp_i_gpu_vk_shader_of topics[HDRP_I_GPU_VK_TOPICS] = {
        hdrp_i_gpu_vk_cull_shader, hdrp_i_gpu_vk_env_shader, hdrp_i_gpu_vk_light_shader,
        hdrp_i_gpu_vk_oit_shader, hdrp_i_gpu_vk_shadow_shader};
    return topics[topic];
}

/* ---- what is missing ------------------------------------------------------------------------- */

/* Counts what is missing, and keeps the one that is asked for. */
typedef struct hdrp_i_gpu_vk_missing {
    uint32_t index, count;
    const char* found;
} hdrp_i_gpu_vk_missing;

static void hdrp_i_gpu_vk_need(hdrp_i_gpu_vk_missing* missing, int present, const char* name)
{
    if (!present) {
        missing->found = missing->count == missing->index ? name : missing->found;
        ++missing->count;
    }
}

#define HDRP_I_GPU_VK_LOAD_INSTANCE(name)                                                          \
    vk->name = (PFN_vk##name)desc->get_instance_proc_addr(desc->instance, "vk" #name);             \
    hdrp_i_gpu_vk_need(missing, vk->name != NULL, "vk" #name);
#define HDRP_I_GPU_VK_LOAD_DEVICE(name)                                                            \
    vk->name = (PFN_vk##name)vk->GetDeviceProcAddr(desc->device, "vk" #name);                      \
    hdrp_i_gpu_vk_need(missing, vk->name != NULL, "vk" #name);

static void hdrp_i_gpu_vk_load(hdrp_gpu_vk_functions* vk, const hdrp_gpu_vk_desc* desc,
                               hdrp_i_gpu_vk_missing* missing)
{
    memset(vk, 0, sizeof *vk);
    HDRP_GPU_VK_INSTANCE_FUNCTIONS(HDRP_I_GPU_VK_LOAD_INSTANCE)
    if (vk->GetDeviceProcAddr) {
        HDRP_GPU_VK_DEVICE_FUNCTIONS(HDRP_I_GPU_VK_LOAD_DEVICE)
    }
    vk->SetDebugUtilsObjectNameEXT = (PFN_vkSetDebugUtilsObjectNameEXT)desc->get_instance_proc_addr(
        desc->instance, "vkSetDebugUtilsObjectNameEXT");
}

/* What the queues of a family can do; 0 where there is no such family. */
static VkQueueFlags hdrp_i_gpu_vk_queue_flags(const hdrp_gpu_vk_functions* vk,
                                              const hdrp_gpu_vk_desc* desc)
{
    VkQueueFamilyProperties families[HDRP_I_GPU_VK_FAMILIES_MAX];
    uint32_t count = HDRP_I_GPU_VK_FAMILIES_MAX;
    memset(families, 0, sizeof families);
    vk->GetPhysicalDeviceQueueFamilyProperties(desc->physical_device, &count, families);
    return desc->queue_family < count ? families[desc->queue_family].queueFlags : 0u;
}

/* The most descriptors of some types, a letter each, that a shader of some passes has. */
static uint32_t hdrp_i_gpu_vk_most(uint32_t passes, const char* letters)
{
    uint32_t most = 0u, topic, i, n;
    const char* at;
    for (topic = 0u; topic < HDRP_I_GPU_VK_TOPICS; ++topic) {
        hdrp_i_gpu_vk_shader_of shader_of = hdrp_i_gpu_vk_topic(topic);
        for (i = 0u; shader_of(i).name; ++i) {
            n = 0u;
            for (at = shader_of(i).bindings; *at && (shader_of(i).pass & passes) != 0u; ++at) {
                n += strchr(letters, *at) ? 1u : 0u;
            }
            most = n > most ? n : most;
        }
    }
    return most;
}

static void hdrp_i_gpu_vk_check_limits(hdrp_i_gpu_vk_missing* missing,
                                       const VkPhysicalDeviceLimits* limits, uint32_t passes)
{
    hdrp_i_gpu_vk_need(
        missing, limits->maxPerStageDescriptorStorageBuffers >= hdrp_i_gpu_vk_most(passes, "b"),
        "maxPerStageDescriptorStorageBuffers");
    hdrp_i_gpu_vk_need(
        missing, limits->maxPerStageDescriptorSampledImages >= hdrp_i_gpu_vk_most(passes, "tc"),
        "maxPerStageDescriptorSampledImages");
    hdrp_i_gpu_vk_need(
        missing, limits->maxPerStageDescriptorStorageImages >= hdrp_i_gpu_vk_most(passes, "s"),
        "maxPerStageDescriptorStorageImages");
    if (passes & HDRP_GPU_VK_PASS_LIGHT) { /* shaders/deferred.comp and dispatch.comp */
        hdrp_i_gpu_vk_need(missing, limits->maxComputeWorkGroupSize[0] >= 256u,
                           "maxComputeWorkGroupSize");
        hdrp_i_gpu_vk_need(missing, limits->maxComputeWorkGroupInvocations >= 256u,
                           "maxComputeWorkGroupInvocations");
    }
    if (passes & HDRP_GPU_VK_PASS_ENVIRONMENT) { /* shaders/env_harmonics.comp */
        hdrp_i_gpu_vk_need(missing, limits->maxComputeSharedMemorySize >= 18432u,
                           "maxComputeSharedMemorySize");
    }
}

/* Loads the functions, and asks for everything that passes need. */
static void hdrp_i_gpu_vk_check(hdrp_gpu_vk_functions* vk, const hdrp_gpu_vk_desc* desc,
                                hdrp_i_gpu_vk_missing* missing)
{
    VkPhysicalDeviceProperties properties;
    uint32_t passes = desc->passes ? desc->passes : HDRP_GPU_VK_PASS_ALL;
    hdrp_i_gpu_vk_need(missing, desc->instance != VK_NULL_HANDLE, "instance");
    hdrp_i_gpu_vk_need(missing, desc->physical_device != VK_NULL_HANDLE, "physical_device");
    hdrp_i_gpu_vk_need(missing, desc->device != VK_NULL_HANDLE, "device");
    hdrp_i_gpu_vk_need(missing, desc->get_instance_proc_addr != NULL, "get_instance_proc_addr");
    if (missing->count) {
        return;
    }
    hdrp_i_gpu_vk_load(vk, desc, missing);
    if (missing->count) {
        return;
    }
    vk->GetPhysicalDeviceProperties(desc->physical_device, &properties);
    hdrp_i_gpu_vk_need(missing, properties.apiVersion >= VK_API_VERSION_1_1, "Vulkan 1.1");
    hdrp_i_gpu_vk_need(missing, (hdrp_i_gpu_vk_queue_flags(vk, desc) & VK_QUEUE_COMPUTE_BIT) != 0u,
                       "VK_QUEUE_COMPUTE_BIT in the queue family");
    hdrp_i_gpu_vk_check_limits(missing, &properties.limits, passes);
    if (passes &
        (HDRP_GPU_VK_PASS_FGD | HDRP_GPU_VK_PASS_LIGHT | HDRP_GPU_VK_PASS_SHADOW |
         HDRP_GPU_VK_PASS_ENVIRONMENT | HDRP_GPU_VK_PASS_TONE_MAP | HDRP_GPU_VK_PASS_OIT)) {
        hdrp_i_gpu_vk_need(missing,
                           desc->features && desc->features->shaderStorageImageWriteWithoutFormat,
                           "shaderStorageImageWriteWithoutFormat");
    }
}

HDRP_API const char* hdrp_gpu_vk_missing(const hdrp_gpu_vk_desc* desc, uint32_t index)
{
    hdrp_gpu_vk_functions vk;
    hdrp_i_gpu_vk_missing missing;
    memset(&missing, 0, sizeof missing);
    missing.index = index;
    hdrp_i_gpu_vk_need(&missing, desc != NULL, "desc");
    if (desc) {
        hdrp_i_gpu_vk_check(&vk, desc, &missing);
    }
    return missing.found;
}

/* ---- the context ----------------------------------------------------------------------------- */

/* Sets of a frame; of each type as many descriptors as the passes could need. */
static VkResult hdrp_i_gpu_vk_pool(hdrp_gpu_vk* gpu, VkDescriptorPool* pool)
{
    static const char letters[] = "stcbu";
    static const uint32_t at_most[] = {4u, 12u, 8u, 16u, 2u}; /* of each in a shader */
    VkDescriptorPoolSize sizes[5];
    VkDescriptorPoolCreateInfo info;
    uint32_t i;
    for (i = 0u; i < 5u; ++i) {
        sizes[i].type = hdrp_i_gpu_vk_type_of(letters[i]);
        sizes[i].descriptorCount = gpu->desc.frame_passes * at_most[i];
    }
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = gpu->desc.frame_passes;
    info.poolSizeCount = 5u;
    info.pPoolSizes = sizes;
    return gpu->vk.CreateDescriptorPool(gpu->desc.device, &info, gpu->desc.allocation, pool);
}

static VkResult hdrp_i_gpu_vk_sampler(hdrp_gpu_vk* gpu)
{
    VkSamplerCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = VK_FILTER_LINEAR;
    info.minFilter = VK_FILTER_LINEAR;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = VK_LOD_CLAMP_NONE;
    return gpu->vk.CreateSampler(gpu->desc.device, &info, gpu->desc.allocation, &gpu->linear);
}

/* Threads of a group: a subgroup, where all subgroups have one size, so that it runs in step. What
 * Vulkan promises of full subgroups only with a feature, devices of one size do anyway. Those of
 * Vulkan 1.3 can be asked for sizes; to others the structure may mean nothing. */
static void hdrp_i_gpu_vk_choose_group(hdrp_gpu_vk* gpu, uint32_t version)
{
    VkPhysicalDeviceSubgroupSizeControlPropertiesEXT sizes;
    VkPhysicalDeviceProperties2 all;
    memset(&sizes, 0, sizeof sizes);
    sizes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES_EXT;
    memset(&all, 0, sizeof all);
    all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    all.pNext = &sizes;
    if (version >= VK_MAKE_VERSION(1, 3, 0)) {
        gpu->vk.GetPhysicalDeviceProperties2(gpu->desc.physical_device, &all);
    }
    gpu->group = HDRP_I_GPU_VK_GROUP_MAX;
    gpu->one_subgroup = 0u;
    if (sizes.minSubgroupSize == sizes.maxSubgroupSize && sizes.minSubgroupSize >= 4u &&
        sizes.minSubgroupSize <= HDRP_I_GPU_VK_GROUP_MAX) {
        gpu->group = sizes.minSubgroupSize;
        gpu->one_subgroup = 1u;
    }
}

/* The shaders of the passes that are asked for, of one of the headers. */
static VkResult hdrp_i_gpu_vk_make_shaders(hdrp_gpu_vk* gpu, hdrp_i_gpu_vk_shader_of shader_of)
{
    static const VkSpecializationMapEntry entries[3] = {
        {0u, 0u, sizeof(uint32_t)}, {1u, 4u, sizeof(uint32_t)}, {2u, 8u, sizeof(uint32_t)}};
    uint32_t values[3]; /* of shaders/group.glsl, and the kind; others have none by these numbers */
    VkSpecializationInfo constants;
    VkResult r = VK_SUCCESS;
    uint32_t i;
    values[0] = gpu->group;
    values[1] = gpu->one_subgroup;
    constants.mapEntryCount = 3u;
    constants.pMapEntries = entries;
    constants.dataSize = sizeof values;
    constants.pData = values;
    for (i = 0u; shader_of(i).name && r == VK_SUCCESS; ++i) {
        hdrp_i_gpu_vk_shader shader = shader_of(i);
        hdrp_gpu_vk_pipeline* made = &gpu->pipelines[shader.index];
        if ((gpu->desc.passes & shader.pass) == 0u) {
            continue;
        }
        values[2] = shader.kind;
        r = hdrp_i_gpu_vk_layouts(gpu, &shader, made);
        if (r == VK_SUCCESS && shader.has_variants == 0u) {
            r = hdrp_i_gpu_vk_specialise(gpu, &shader, made->layout, &constants, &made->pipeline);
        }
    }
    return r;
}

static VkResult hdrp_i_gpu_vk_make(hdrp_gpu_vk* gpu)
{
    VkResult r = hdrp_i_gpu_vk_sampler(gpu);
    uint32_t i;
    for (i = 0u; i < HDRP_I_GPU_VK_TOPICS && r == VK_SUCCESS; ++i) {
        r = hdrp_i_gpu_vk_make_shaders(gpu, hdrp_i_gpu_vk_topic(i));
    }
    for (i = 0u; i < gpu->desc.frames && r == VK_SUCCESS; ++i) {
        r = hdrp_i_gpu_vk_pool(gpu, &gpu->pools[i]);
    }
    return r;
}

static int hdrp_i_gpu_vk_bad_desc(const hdrp_gpu_vk_desc* desc)
{
    return (desc->passes & ~HDRP_GPU_VK_PASS_ALL) != 0u || desc->frames > HDRP_GPU_VK_FRAMES_MAX ||
           desc->frame_passes > 65536u || !desc->memory.allocate != !desc->memory.release;
}

HDRP_API hdrp_result hdrp_gpu_vk_init(hdrp_gpu_vk* gpu, const hdrp_gpu_vk_desc* desc)
{
    hdrp_gpu_vk made;
    hdrp_i_gpu_vk_missing missing;
    VkPhysicalDeviceProperties properties;
    VkResult r;
    if (!gpu || !desc || !desc->get_instance_proc_addr || desc->instance == VK_NULL_HANDLE ||
        desc->physical_device == VK_NULL_HANDLE || desc->device == VK_NULL_HANDLE) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (hdrp_i_gpu_vk_bad_desc(desc)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    memset(&made, 0, sizeof made);
    memset(&missing, 0, sizeof missing);
    hdrp_i_gpu_vk_check(&made.vk, desc, &missing);
    if (missing.count) {
        return HDRP_ERROR_UNSUPPORTED;
    }
    made.desc = *desc;
    made.desc.features = NULL;
    made.desc.passes = desc->passes ? desc->passes : HDRP_GPU_VK_PASS_ALL;
    made.desc.frames = desc->frames ? desc->frames : 2u;
    made.desc.frame_passes = desc->frame_passes ? desc->frame_passes : 64u;
    made.vk.GetPhysicalDeviceProperties(desc->physical_device, &properties);
    made.buffer_range_max = properties.limits.maxStorageBufferRange;
    made.buffer_alignment = properties.limits.minStorageBufferOffsetAlignment;
    made.groups_max = properties.limits.maxComputeWorkGroupCount[0];
    made.vk.GetPhysicalDeviceMemoryProperties(desc->physical_device, &made.memory_types);
    hdrp_i_gpu_vk_choose_group(&made, properties.apiVersion);
    made.shader_stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    if (hdrp_i_gpu_vk_queue_flags(&made.vk, desc) & VK_QUEUE_GRAPHICS_BIT) {
        made.shader_stages |= VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    }
    r = hdrp_i_gpu_vk_make(&made);
    if (r != VK_SUCCESS) {
        hdrp_gpu_vk_destroy(&made);
        return hdrp_i_gpu_vk_result(r);
    }
    made.desc.pipeline_cache = VK_NULL_HANDLE;
    *gpu = made;
    return HDRP_OK;
}

HDRP_API void hdrp_gpu_vk_destroy(hdrp_gpu_vk* gpu)
{
    uint32_t i;
    if (!gpu || gpu->desc.device == VK_NULL_HANDLE) {
        return;
    }
    for (i = 0u; i < HDRP_GPU_VK_FRAMES_MAX; ++i) {
        gpu->vk.DestroyDescriptorPool(gpu->desc.device, gpu->pools[i], gpu->desc.allocation);
    }
    gpu->vk.DestroySampler(gpu->desc.device, gpu->linear, gpu->desc.allocation);
    for (i = 0u; i < HDRP_GPU_VK_SHADERS_MAX; ++i) {
        hdrp_gpu_vk_pipeline* pass = &gpu->pipelines[i];
        gpu->vk.DestroyPipeline(gpu->desc.device, pass->pipeline, gpu->desc.allocation);
        gpu->vk.DestroyPipelineLayout(gpu->desc.device, pass->layout, gpu->desc.allocation);
        gpu->vk.DestroyDescriptorSetLayout(gpu->desc.device, pass->set_layout,
                                           gpu->desc.allocation);
    }
    memset(gpu, 0, sizeof *gpu);
}

HDRP_API hdrp_result hdrp_gpu_vk_begin_frame(hdrp_gpu_vk* gpu, uint32_t frame)
{
    VkResult r;
    if (!gpu) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (frame >= gpu->desc.frames) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    r = gpu->vk.ResetDescriptorPool(gpu->desc.device, gpu->pools[frame], 0u);
    if (r == VK_SUCCESS) {
        gpu->frame = frame;
        gpu->passes_recorded = 0u;
    }
    return hdrp_i_gpu_vk_result(r);
}

#ifdef __cplusplus
}
#endif

#endif /* HDRP_GPU_VK_IMPLEMENTATION */
