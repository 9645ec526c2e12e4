/* hdrp_gpu_vk_core.h - what the passes on the GPU share: context, memory, how one is recorded.
 * SPDX-License-Identifier: MIT
 *
 * Included by the headers of the passes; hdrp_gpu_vk.h, which includes those, says how all of it is
 * used and makes the context. A pass is a compute shader: hdrp_i_gpu_vk_bind takes a set of
 * descriptors for it from the frame that is recorded, hdrp_i_gpu_vk_dispatch records it, and
 * hdrp_i_gpu_vk_order the barriers in front of it and behind.
 *
 * >>index of the functions, without hdrp_gpu_vk_ (written by tools/api_check.py --write)
 *   resources: buffer_create buffer_destroy image_create image_destroy cube_create cube_destroy
 * >>end */
#ifndef HDRP_GPU_VK_CORE_H
#define HDRP_GPU_VK_CORE_H

#include "hdrp_math.h"

#if HDRP_VERSION != 100
#error "hdrp_gpu_vk_core.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#ifndef HDRP_GPU
#include <stddef.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Passes, or-ed. What is not asked for is not created, and needs nothing of the device. */
#define HDRP_GPU_VK_PASS_FGD         1u
#define HDRP_GPU_VK_PASS_DEPTH       2u
#define HDRP_GPU_VK_PASS_LISTS       4u /* with depth */
#define HDRP_GPU_VK_PASS_BLOCKERS    8u
#define HDRP_GPU_VK_PASS_LIGHT       32u
#define HDRP_GPU_VK_PASS_SHADOW      64u
#define HDRP_GPU_VK_PASS_ENVIRONMENT 128u
#define HDRP_GPU_VK_PASS_TONE_MAP    256u
#define HDRP_GPU_VK_PASS_OIT         512u
#define HDRP_GPU_VK_PASS_ALL         1007u

/* Room for the compute shaders of all passes. */
#define HDRP_GPU_VK_SHADERS_MAX 32u

/* Frames whose commands may wait for execution at the same time. */
#define HDRP_GPU_VK_FRAMES_MAX 8u

/* >>context */

/* A part of device memory. */
typedef struct hdrp_gpu_vk_block {
    VkDeviceMemory memory;
    VkDeviceSize offset;
    void* handle; /* for the caller's release: whatever allocate left here */
} hdrp_gpu_vk_block;

/* Where device memory comes from. */
typedef struct hdrp_gpu_vk_memory {
    /* Memory of a type in required->memoryTypeBits, with these properties. */
    VkResult (*allocate)(void* user, const VkMemoryRequirements* required,
                         VkMemoryPropertyFlags properties, hdrp_gpu_vk_block* block);
    void (*release)(void* user, const hdrp_gpu_vk_block* block);
    void* user;
} hdrp_gpu_vk_memory;

/* Zero means the default where there is one. */
typedef struct hdrp_gpu_vk_desc {
    VkInstance instance; /* made for Vulkan 1.1 or later, as the device */
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family; /* of the command buffers; it can compute */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    const VkPhysicalDeviceFeatures* features; /* that were enabled; NULL: none. Not kept */
    uint32_t passes;                          /* HDRP_GPU_VK_PASS_...; 0: all */
    uint32_t frames;                          /* [0,HDRP_GPU_VK_FRAMES_MAX] 0: 2 */
    uint32_t frame_passes; /* [0,65536] sets that passes take in a frame, at most; 0: 64 */
    const VkAllocationCallbacks* allocation; /* NULL: the driver's. Must outlive the context */
    VkPipelineCache pipeline_cache;          /* used by hdrp_gpu_vk_init alone */
    hdrp_gpu_vk_memory memory;               /* NULL: an allocation of its own for each resource */
} hdrp_gpu_vk_desc;

/* Functions of the device that are used. */
#define HDRP_GPU_VK_DEVICE_FUNCTIONS(X)                                                            \
    X(AllocateDescriptorSets)                                                                      \
    X(AllocateMemory)                                                                              \
    X(BindBufferMemory)                                                                            \
    X(BindImageMemory)                                                                             \
    X(CmdBindDescriptorSets)                                                                       \
    X(CmdBindPipeline)                                                                             \
    X(CmdDispatch)                                                                                 \
    X(CmdDispatchIndirect)                                                                         \
    X(CmdFillBuffer)                                                                               \
    X(CmdPipelineBarrier)                                                                          \
    X(CmdPushConstants)                                                                            \
    X(CmdUpdateBuffer)                                                                             \
    X(CreateBuffer)                                                                                \
    X(CreateComputePipelines)                                                                      \
    X(CreateDescriptorPool)                                                                        \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(CreatePipelineLayout)                                                                        \
    X(CreateSampler)                                                                               \
    X(CreateShaderModule)                                                                          \
    X(DestroyBuffer)                                                                               \
    X(DestroyDescriptorPool)                                                                       \
    X(DestroyDescriptorSetLayout)                                                                  \
    X(DestroyImage)                                                                                \
    X(DestroyImageView)                                                                            \
    X(DestroyPipeline)                                                                             \
    X(DestroyPipelineLayout)                                                                       \
    X(DestroySampler)                                                                              \
    X(DestroyShaderModule)                                                                         \
    X(FreeMemory)                                                                                  \
    X(GetBufferMemoryRequirements)                                                                 \
    X(GetImageMemoryRequirements)                                                                  \
    X(ResetDescriptorPool)                                                                         \
    X(UpdateDescriptorSets)

/* Functions of the instance that are used. */
#define HDRP_GPU_VK_INSTANCE_FUNCTIONS(X)                                                          \
    X(GetDeviceProcAddr)                                                                           \
    X(GetPhysicalDeviceFormatProperties)                                                           \
    X(GetPhysicalDeviceMemoryProperties)                                                           \
    X(GetPhysicalDeviceProperties)                                                                 \
    X(GetPhysicalDeviceProperties2)                                                                \
    X(GetPhysicalDeviceQueueFamilyProperties)

#define HDRP_GPU_VK_MEMBER(name) PFN_vk##name name;
typedef struct hdrp_gpu_vk_functions {
    HDRP_GPU_VK_DEVICE_FUNCTIONS(HDRP_GPU_VK_MEMBER)
    HDRP_GPU_VK_INSTANCE_FUNCTIONS(HDRP_GPU_VK_MEMBER)
    PFN_vkSetDebugUtilsObjectNameEXT SetDebugUtilsObjectNameEXT; /* NULL without the extension */
} hdrp_gpu_vk_functions;
#undef HDRP_GPU_VK_MEMBER

/* A compute shader of a pass. */
typedef struct hdrp_gpu_vk_pipeline {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline; /* VK_NULL_HANDLE where its pass was not asked for */
} hdrp_gpu_vk_pipeline;

/* The members are for reading. */
typedef struct hdrp_gpu_vk {
    hdrp_gpu_vk_desc desc; /* with the defaults in place */
    hdrp_gpu_vk_functions vk;
    VkPhysicalDeviceMemoryProperties memory_types;
    VkDeviceSize buffer_range_max, buffer_alignment; /* limits of storage buffers */
    uint32_t groups_max;                             /* of a dispatch, side by side */
    VkPipelineStageFlags shader_stages;              /* compute and, where there are, fragment */
    uint32_t group;                                  /* threads of the groups that build lists */
    uint32_t one_subgroup; /* 1 where they run in step, and need no barriers */
    VkSampler linear;      /* linear within a level and between levels, clamped to the edge */
    hdrp_gpu_vk_pipeline pipelines[HDRP_GPU_VK_SHADERS_MAX]; /* by hdrp_i_gpu_vk_shader.index */
    VkDescriptorPool pools[HDRP_GPU_VK_FRAMES_MAX];
    uint32_t frame, passes_recorded; /* the frame that is recorded, and sets taken in it */
} hdrp_gpu_vk;

/* >>resources
 * For those who have no means of their own; passes take any buffer and image. */

typedef struct hdrp_gpu_vk_buffer {
    VkBuffer buffer;
    VkDeviceSize bytes;
    hdrp_gpu_vk_block block;
} hdrp_gpu_vk_buffer;

/* An image of the caller's own needs no block. */
typedef struct hdrp_gpu_vk_image {
    VkImage image;
    VkImageView view;
    VkFormat format;
    uint32_t width_px, height_px;
    hdrp_gpu_vk_block block;
} hdrp_gpu_vk_image;

/* Levels of a cube of 4096 texels. */
#define HDRP_GPU_VK_CUBE_LEVELS_MAX 13u

/* A cube with mip levels, faces in the order +X -X +Y -Y +Z -Z. */
typedef struct hdrp_gpu_vk_cube {
    VkImage image;
    VkImageView view; /* VK_IMAGE_VIEW_TYPE_CUBE, all levels: for samplers */
    VkImageView levels[HDRP_GPU_VK_CUBE_LEVELS_MAX]; /* 2D_ARRAY of six layers: to write to */
    VkFormat format;
    uint32_t size_px, level_count; /* level k has size_px >> k */
    hdrp_gpu_vk_block block;
} hdrp_gpu_vk_cube;

/** A buffer with memory.
 *  gpu         from hdrp_gpu_vk_init
 *  bytes       any  at least 1
 *  usage       VK_BUFFER_USAGE_...
 *  properties  VK_MEMORY_PROPERTY_... that its memory must have
 *  name        for debuggers; NULL: none
 *  buffer      result; to be destroyed by hdrp_gpu_vk_buffer_destroy
 *  returns     HDRP_OK, or an error, with buffer untouched and nothing left on the device
 *  errors      HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT, HDRP_ERROR_UNSUPPORTED where no
 *              memory has the properties, and those of the driver as for hdrp_gpu_vk_init
 *  memory      from desc.memory */
HDRP_API hdrp_result hdrp_gpu_vk_buffer_create(const hdrp_gpu_vk* gpu, VkDeviceSize bytes,
                                               VkBufferUsageFlags usage,
                                               VkMemoryPropertyFlags properties, const char* name,
                                               hdrp_gpu_vk_buffer* buffer);

/** Destroys a buffer.
 *  gpu     that made it
 *  buffer  NULL and a buffer of zeros are allowed; it is all zeros afterwards
 *  edges   what uses it must have been executed */
HDRP_API void hdrp_gpu_vk_buffer_destroy(const hdrp_gpu_vk* gpu, hdrp_gpu_vk_buffer* buffer);

/** A colour image of two dimensions in the memory of the device, and a view of it.
 *  gpu        from hdrp_gpu_vk_init
 *  format     with optimal tiling for the usage
 *  width_px   [1,16384]
 *  height_px  [1,16384]
 *  usage      VK_IMAGE_USAGE_...
 *  name       for debuggers; NULL: none
 *  image      result, in VK_IMAGE_LAYOUT_UNDEFINED; to be destroyed by hdrp_gpu_vk_image_destroy
 *  returns    HDRP_OK, or an error, with image untouched and nothing left on the device
 *  errors     as hdrp_gpu_vk_buffer_create; HDRP_ERROR_UNSUPPORTED also where the format cannot be
 *             stored to, or sampled, as the usage asks
 *  memory     from desc.memory */
HDRP_API hdrp_result hdrp_gpu_vk_image_create(const hdrp_gpu_vk* gpu, VkFormat format,
                                              uint32_t width_px, uint32_t height_px,
                                              VkImageUsageFlags usage, const char* name,
                                              hdrp_gpu_vk_image* image);

/** Destroys an image.
 *  gpu    that made it
 *  image  NULL and an image of zeros are allowed; it is all zeros afterwards
 *  edges  what uses it must have been executed */
HDRP_API void hdrp_gpu_vk_image_destroy(const hdrp_gpu_vk* gpu, hdrp_gpu_vk_image* image);

/** A cube with mip levels in the memory of the device, a view of all of it and one of each level.
 *  gpu          from hdrp_gpu_vk_init
 *  format       with optimal tiling for the usage
 *  size_px      [1,4096]  a power of two
 *  level_count  [1,13]  levels, down to 1 by 1 texel at most
 *  usage        VK_IMAGE_USAGE_...
 *  name         for debuggers; NULL: none
 *  cube         result, in VK_IMAGE_LAYOUT_UNDEFINED; to be destroyed by hdrp_gpu_vk_cube_destroy
 *  returns      HDRP_OK, or an error, with cube untouched and nothing left on the device
 *  errors       as hdrp_gpu_vk_image_create
 *  memory       from desc.memory */
HDRP_API hdrp_result hdrp_gpu_vk_cube_create(const hdrp_gpu_vk* gpu, VkFormat format,
                                             uint32_t size_px, uint32_t level_count,
                                             VkImageUsageFlags usage, const char* name,
                                             hdrp_gpu_vk_cube* cube);

/** Destroys a cube.
 *  gpu    that made it
 *  cube   NULL and a cube of zeros are allowed; it is all zeros afterwards
 *  edges  what uses it must have been executed */
HDRP_API void hdrp_gpu_vk_cube_destroy(const hdrp_gpu_vk* gpu, hdrp_gpu_vk_cube* cube);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_GPU_VK_CORE_H */

#if defined(HDRP_GPU_VK_IMPLEMENTATION) && !defined(HDRP_I_GPU_VK_CORE_IMPLEMENTED) &&             \
    !defined(HDRP_GPU)
#define HDRP_I_GPU_VK_CORE_IMPLEMENTED

#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Functions that not every header of passes calls. */
#define HDRP_I_GPU_VK_FN HDRP_FN

/* ---- what a pass is made of ------------------------------------------------------------------ */

#define HDRP_I_GPU_VK_BINDINGS_MAX 28u
#define HDRP_I_GPU_VK_GROUP_MAX    64u /* threads, of shaders/group.glsl */

/* Places in hdrp_gpu_vk.pipelines. */
#define HDRP_I_GPU_VK_FGD              0u
#define HDRP_I_GPU_VK_DEPTH            1u
#define HDRP_I_GPU_VK_CULL_PROJECT     2u
#define HDRP_I_GPU_VK_CULL_COARSE      3u
#define HDRP_I_GPU_VK_CULL_TILES       4u
#define HDRP_I_GPU_VK_CULL_PIXELS      5u
#define HDRP_I_GPU_VK_CULL_CLUSTERS    6u
#define HDRP_I_GPU_VK_CULL_BLOCKERS    7u
#define HDRP_I_GPU_VK_OIT_COMPOSITE    8u /* to 11u: a kind each */
#define HDRP_I_GPU_VK_CLASSIFY         16u
#define HDRP_I_GPU_VK_DISPATCH         17u
#define HDRP_I_GPU_VK_DEFERRED         18u
#define HDRP_I_GPU_VK_SHADOW           28u
#define HDRP_I_GPU_VK_ENV_FROM_LATLONG 20u
#define HDRP_I_GPU_VK_ENV_FROM_CUBE    21u
#define HDRP_I_GPU_VK_ENV_REDUCE       22u
#define HDRP_I_GPU_VK_ENV_FILTER       23u
#define HDRP_I_GPU_VK_ENV_HARMONICS    24u
#define HDRP_I_GPU_VK_TONE_MAP         25u

/* A compute shader. Each letter of `bindings` is the type of one, in order from 0 on: s storage
 * image, t sampled image, c sampled image with a sampler, b storage buffer, u uniform buffer. */
typedef struct hdrp_i_gpu_vk_shader {
    uint32_t index; /* in hdrp_gpu_vk.pipelines */
    uint32_t pass;  /* HDRP_GPU_VK_PASS_... that needs it */
    const char* name;
    const uint32_t* words;
    size_t bytes;
    const char* bindings;
    uint32_t push_bytes;
    uint32_t has_variants; /* 1: its pipelines are made later, specialised */
    uint32_t kind;         /* constant 2, of shaders that several passes share */
} hdrp_i_gpu_vk_shader;

HDRP_I_GPU_VK_FN hdrp_i_gpu_vk_shader hdrp_i_gpu_vk_shader_make(uint32_t index, uint32_t pass,
                                                                const char* name,
                                                                const char* bindings,
                                                                size_t push_bytes)
{
    hdrp_i_gpu_vk_shader s;
    memset(&s, 0, sizeof s);
    s.index = index;
    s.pass = pass;
    s.name = name;
    s.bindings = bindings;
    s.push_bytes = (uint32_t)push_bytes;
    return s;
}

HDRP_I_GPU_VK_FN VkDescriptorType hdrp_i_gpu_vk_type_of(char letter)
{
    switch (letter) {
    case 's':
        return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    case 't':
        return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    case 'c':
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case 'b':
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    default:
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    }
}

HDRP_I_GPU_VK_FN hdrp_result hdrp_i_gpu_vk_result(VkResult r)
{
    switch (r) {
    case VK_SUCCESS:
        return HDRP_OK;
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return HDRP_ERROR_OUT_OF_HOST_MEMORY;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
    case VK_ERROR_TOO_MANY_OBJECTS:
        return HDRP_ERROR_OUT_OF_DEVICE_MEMORY;
    case VK_ERROR_DEVICE_LOST:
        return HDRP_ERROR_DEVICE_LOST;
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
        return HDRP_ERROR_UNSUPPORTED;
    default:
        return HDRP_ERROR_DRIVER;
    }
}

HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_name(const hdrp_gpu_vk* gpu, VkObjectType type, uint64_t object,
                                         const char* name)
{
    VkDebugUtilsObjectNameInfoEXT info;
    if (!gpu->vk.SetDebugUtilsObjectNameEXT || !name) {
        return;
    }
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = name;
    gpu->vk.SetDebugUtilsObjectNameEXT(gpu->desc.device, &info); /* a name that fails is no loss */
}

HDRP_I_GPU_VK_FN VkResult hdrp_i_gpu_vk_layouts(const hdrp_gpu_vk* gpu,
                                                const hdrp_i_gpu_vk_shader* shader,
                                                hdrp_gpu_vk_pipeline* made)
{
    VkDescriptorSetLayoutBinding bindings[HDRP_I_GPU_VK_BINDINGS_MAX];
    VkDescriptorSetLayoutCreateInfo sets;
    VkPipelineLayoutCreateInfo layout;
    VkPushConstantRange push;
    VkResult r;
    uint32_t i;
    memset(bindings, 0, sizeof bindings);
    for (i = 0u; shader->bindings[i]; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = hdrp_i_gpu_vk_type_of(shader->bindings[i]);
        bindings[i].descriptorCount = 1u;
        bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    }
    memset(&sets, 0, sizeof sets);
    sets.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    sets.bindingCount = i;
    sets.pBindings = bindings;
    r = gpu->vk.CreateDescriptorSetLayout(gpu->desc.device, &sets, gpu->desc.allocation,
                                          &made->set_layout);
    if (r != VK_SUCCESS) {
        return r;
    }
    push.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    push.offset = 0u;
    push.size = shader->push_bytes;
    memset(&layout, 0, sizeof layout);
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1u;
    layout.pSetLayouts = &made->set_layout;
    layout.pushConstantRangeCount = shader->push_bytes > 0u ? 1u : 0u;
    layout.pPushConstantRanges = &push;
    return gpu->vk.CreatePipelineLayout(gpu->desc.device, &layout, gpu->desc.allocation,
                                        &made->layout);
}

/* A pipeline of a shader; `constants` specialise it: NULL for none. */
HDRP_I_GPU_VK_FN VkResult hdrp_i_gpu_vk_specialise(const hdrp_gpu_vk* gpu,
                                                   const hdrp_i_gpu_vk_shader* shader,
                                                   VkPipelineLayout layout,
                                                   const VkSpecializationInfo* constants,
                                                   VkPipeline* pipeline)
{
    VkShaderModuleCreateInfo code;
    VkComputePipelineCreateInfo info;
    VkShaderModule module_of_shader = VK_NULL_HANDLE;
    VkResult r;
    memset(&code, 0, sizeof code);
    code.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    code.codeSize = shader->bytes;
    code.pCode = shader->words;
    r = gpu->vk.CreateShaderModule(gpu->desc.device, &code, gpu->desc.allocation,
                                   &module_of_shader);
    if (r != VK_SUCCESS) {
        return r;
    }
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module_of_shader;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = constants;
    info.layout = layout;
    r = gpu->vk.CreateComputePipelines(gpu->desc.device, gpu->desc.pipeline_cache, 1u, &info,
                                       gpu->desc.allocation, pipeline);
    gpu->vk.DestroyShaderModule(gpu->desc.device, module_of_shader, gpu->desc.allocation);
    if (r == VK_SUCCESS) {
        hdrp_i_gpu_vk_name(gpu, VK_OBJECT_TYPE_PIPELINE, (uint64_t)*pipeline, shader->name);
    }
    return r;
}

/* ---- resources ------------------------------------------------------------------------------- */

HDRP_I_GPU_VK_FN hdrp_result hdrp_i_gpu_vk_allocate(const hdrp_gpu_vk* gpu,
                                                    const VkMemoryRequirements* needs,
                                                    VkMemoryPropertyFlags properties,
                                                    hdrp_gpu_vk_block* block)
{
    VkMemoryAllocateInfo info;
    uint32_t i;
    if (gpu->desc.memory.allocate) {
        return hdrp_i_gpu_vk_result(
            gpu->desc.memory.allocate(gpu->desc.memory.user, needs, properties, block));
    }
    for (i = 0u; i < gpu->memory_types.memoryTypeCount; ++i) {
        VkMemoryPropertyFlags has = gpu->memory_types.memoryTypes[i].propertyFlags;
        if ((needs->memoryTypeBits >> i & 1u) != 0u && (has & properties) == properties) {
            break;
        }
    }
    if (i == gpu->memory_types.memoryTypeCount) {
        return HDRP_ERROR_UNSUPPORTED;
    }
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs->size;
    info.memoryTypeIndex = i;
    return hdrp_i_gpu_vk_result(
        gpu->vk.AllocateMemory(gpu->desc.device, &info, gpu->desc.allocation, &block->memory));
}

HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_release(const hdrp_gpu_vk* gpu, const hdrp_gpu_vk_block* block)
{
    if (block->memory == VK_NULL_HANDLE) {
        return;
    }
    if (gpu->desc.memory.release) {
        gpu->desc.memory.release(gpu->desc.memory.user, block);
    } else {
        gpu->vk.FreeMemory(gpu->desc.device, block->memory, gpu->desc.allocation);
    }
}

HDRP_API hdrp_result hdrp_gpu_vk_buffer_create(const hdrp_gpu_vk* gpu, VkDeviceSize bytes,
                                               VkBufferUsageFlags usage,
                                               VkMemoryPropertyFlags properties, const char* name,
                                               hdrp_gpu_vk_buffer* buffer)
{
    VkBufferCreateInfo info;
    VkMemoryRequirements needs;
    hdrp_gpu_vk_buffer made;
    hdrp_result r;
    if (!gpu || !buffer) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (bytes == 0u || usage == 0u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    memset(&made, 0, sizeof made);
    made.bytes = bytes;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = usage;
    info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    r = hdrp_i_gpu_vk_result(
        gpu->vk.CreateBuffer(gpu->desc.device, &info, gpu->desc.allocation, &made.buffer));
    if (r != HDRP_OK) {
        return r;
    }
    gpu->vk.GetBufferMemoryRequirements(gpu->desc.device, made.buffer, &needs);
    r = hdrp_i_gpu_vk_allocate(gpu, &needs, properties, &made.block);
    if (r == HDRP_OK) {
        r = hdrp_i_gpu_vk_result(gpu->vk.BindBufferMemory(gpu->desc.device, made.buffer,
                                                          made.block.memory, made.block.offset));
    } else {
        memset(&made.block, 0, sizeof made.block);
    }
    if (r != HDRP_OK) {
        hdrp_gpu_vk_buffer_destroy(gpu, &made);
        return r;
    }
    hdrp_i_gpu_vk_name(gpu, VK_OBJECT_TYPE_BUFFER, (uint64_t)made.buffer, name);
    *buffer = made;
    return HDRP_OK;
}

HDRP_API void hdrp_gpu_vk_buffer_destroy(const hdrp_gpu_vk* gpu, hdrp_gpu_vk_buffer* buffer)
{
    if (!gpu || !buffer || buffer->buffer == VK_NULL_HANDLE) {
        return;
    }
    gpu->vk.DestroyBuffer(gpu->desc.device, buffer->buffer, gpu->desc.allocation);
    hdrp_i_gpu_vk_release(gpu, &buffer->block);
    memset(buffer, 0, sizeof *buffer);
}

/* Whether images of a format can be stored to and sampled as their usage asks. */
HDRP_I_GPU_VK_FN int hdrp_i_gpu_vk_has_format(const hdrp_gpu_vk* gpu, VkFormat format,
                                              VkImageUsageFlags usage)
{
    VkFormatProperties properties;
    VkFormatFeatureFlags needs = 0u;
    if (usage & VK_IMAGE_USAGE_STORAGE_BIT) {
        needs |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    }
    if (usage & VK_IMAGE_USAGE_SAMPLED_BIT) {
        needs |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    }
    gpu->vk.GetPhysicalDeviceFormatProperties(gpu->desc.physical_device, format, &properties);
    return (properties.optimalTilingFeatures & needs) == needs;
}

/* Largest value of a format of cubes; 0 for formats that are none. */
HDRP_I_GPU_VK_FN float hdrp_i_gpu_vk_largest(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return 65504.0f;
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        return 64512.0f; /* of its ten bits; those of eleven reach 65024 */
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return HDRP_FLT_MAX;
    default:
        return 0.0f;
    }
}

/* The memory of an image. */
HDRP_I_GPU_VK_FN hdrp_result hdrp_i_gpu_vk_image_bind(const hdrp_gpu_vk* gpu, VkImage image,
                                                      hdrp_gpu_vk_block* block)
{
    VkMemoryRequirements needs;
    hdrp_result r;
    gpu->vk.GetImageMemoryRequirements(gpu->desc.device, image, &needs);
    r = hdrp_i_gpu_vk_allocate(gpu, &needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, block);
    if (r != HDRP_OK) {
        memset(block, 0, sizeof *block);
        return r;
    }
    return hdrp_i_gpu_vk_result(
        gpu->vk.BindImageMemory(gpu->desc.device, image, block->memory, block->offset));
}

/* A view of some levels and layers. */
HDRP_I_GPU_VK_FN hdrp_result hdrp_i_gpu_vk_image_view(const hdrp_gpu_vk* gpu, VkImage image,
                                                      VkFormat format, VkImageViewType type,
                                                      uint32_t first_level, uint32_t level_count,
                                                      uint32_t layer_count, VkImageView* made)
{
    VkImageViewCreateInfo view;
    memset(&view, 0, sizeof view);
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image;
    view.viewType = type;
    view.format = format;
    view.subresourceRange.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    view.subresourceRange.baseMipLevel = first_level;
    view.subresourceRange.levelCount = level_count;
    view.subresourceRange.layerCount = layer_count;
    return hdrp_i_gpu_vk_result(
        gpu->vk.CreateImageView(gpu->desc.device, &view, gpu->desc.allocation, made));
}

/* An image of two dimensions or, with six layers, a cube. */
HDRP_I_GPU_VK_FN hdrp_result hdrp_i_gpu_vk_image_make(const hdrp_gpu_vk* gpu, VkFormat format,
                                                      uint32_t width_px, uint32_t height_px,
                                                      uint32_t level_count, uint32_t layer_count,
                                                      VkImageUsageFlags usage, VkImage* image)
{
    VkImageCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.flags = layer_count == 6u ? (VkImageCreateFlags)VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0u;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent.width = width_px;
    info.extent.height = height_px;
    info.extent.depth = 1u;
    info.mipLevels = level_count;
    info.arrayLayers = layer_count;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usage;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    return hdrp_i_gpu_vk_result(
        gpu->vk.CreateImage(gpu->desc.device, &info, gpu->desc.allocation, image));
}

HDRP_API hdrp_result hdrp_gpu_vk_image_create(const hdrp_gpu_vk* gpu, VkFormat format,
                                              uint32_t width_px, uint32_t height_px,
                                              VkImageUsageFlags usage, const char* name,
                                              hdrp_gpu_vk_image* image)
{
    hdrp_gpu_vk_image made;
    hdrp_result r;
    if (!gpu || !image) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (width_px - 1u >= 16384u || height_px - 1u >= 16384u || usage == 0u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    if (!hdrp_i_gpu_vk_has_format(gpu, format, usage)) {
        return HDRP_ERROR_UNSUPPORTED;
    }
    memset(&made, 0, sizeof made);
    made.format = format;
    made.width_px = width_px;
    made.height_px = height_px;
    r = hdrp_i_gpu_vk_image_make(gpu, format, width_px, height_px, 1u, 1u, usage, &made.image);
    r = r == HDRP_OK ? hdrp_i_gpu_vk_image_bind(gpu, made.image, &made.block) : r;
    if (r == HDRP_OK) {
        r = hdrp_i_gpu_vk_image_view(gpu, made.image, format, VK_IMAGE_VIEW_TYPE_2D, 0u, 1u, 1u,
                                     &made.view);
    }
    if (r != HDRP_OK) {
        hdrp_gpu_vk_image_destroy(gpu, &made);
        return r;
    }
    hdrp_i_gpu_vk_name(gpu, VK_OBJECT_TYPE_IMAGE, (uint64_t)made.image, name);
    *image = made;
    return HDRP_OK;
}

HDRP_API void hdrp_gpu_vk_image_destroy(const hdrp_gpu_vk* gpu, hdrp_gpu_vk_image* image)
{
    if (!gpu || !image || image->image == VK_NULL_HANDLE) {
        return;
    }
    gpu->vk.DestroyImageView(gpu->desc.device, image->view, gpu->desc.allocation);
    gpu->vk.DestroyImage(gpu->desc.device, image->image, gpu->desc.allocation);
    hdrp_i_gpu_vk_release(gpu, &image->block);
    memset(image, 0, sizeof *image);
}

HDRP_API hdrp_result hdrp_gpu_vk_cube_create(const hdrp_gpu_vk* gpu, VkFormat format,
                                             uint32_t size_px, uint32_t level_count,
                                             VkImageUsageFlags usage, const char* name,
                                             hdrp_gpu_vk_cube* cube)
{
    hdrp_gpu_vk_cube made;
    hdrp_result r;
    uint32_t i;
    if (!gpu || !cube) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (size_px - 1u >= 4096u || (size_px & (size_px - 1u)) != 0u || level_count == 0u ||
        level_count > HDRP_GPU_VK_CUBE_LEVELS_MAX || (size_px >> (level_count - 1u)) == 0u ||
        usage == 0u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    if (!hdrp_i_gpu_vk_has_format(gpu, format, usage)) {
        return HDRP_ERROR_UNSUPPORTED;
    }
    memset(&made, 0, sizeof made);
    made.format = format;
    made.size_px = size_px;
    made.level_count = level_count;
    r = hdrp_i_gpu_vk_image_make(gpu, format, size_px, size_px, level_count, 6u, usage,
                                 &made.image);
    r = r == HDRP_OK ? hdrp_i_gpu_vk_image_bind(gpu, made.image, &made.block) : r;
    if (r == HDRP_OK) {
        r = hdrp_i_gpu_vk_image_view(gpu, made.image, format, VK_IMAGE_VIEW_TYPE_CUBE, 0u,
                                     level_count, 6u, &made.view);
    }
    for (i = 0u; i < level_count && r == HDRP_OK; ++i) {
        r = hdrp_i_gpu_vk_image_view(gpu, made.image, format, VK_IMAGE_VIEW_TYPE_2D_ARRAY, i, 1u,
                                     6u, &made.levels[i]);
    }
    if (r != HDRP_OK) {
        hdrp_gpu_vk_cube_destroy(gpu, &made);
        return r;
    }
    hdrp_i_gpu_vk_name(gpu, VK_OBJECT_TYPE_IMAGE, (uint64_t)made.image, name);
    *cube = made;
    return HDRP_OK;
}

HDRP_API void hdrp_gpu_vk_cube_destroy(const hdrp_gpu_vk* gpu, hdrp_gpu_vk_cube* cube)
{
    uint32_t i;
    if (!gpu || !cube || cube->image == VK_NULL_HANDLE) {
        return;
    }
    for (i = 0u; i < HDRP_GPU_VK_CUBE_LEVELS_MAX; ++i) {
        gpu->vk.DestroyImageView(gpu->desc.device, cube->levels[i], gpu->desc.allocation);
    }
    gpu->vk.DestroyImageView(gpu->desc.device, cube->view, gpu->desc.allocation);
    gpu->vk.DestroyImage(gpu->desc.device, cube->image, gpu->desc.allocation);
    hdrp_i_gpu_vk_release(gpu, &cube->block);
    memset(cube, 0, sizeof *cube);
}

/* ---- recording ------------------------------------------------------------------------------- */

/* What a binding is bound to: the image or the buffer. */
typedef struct hdrp_i_gpu_vk_bound {
    VkDescriptorImageInfo image;
    VkDescriptorBufferInfo buffer;
} hdrp_i_gpu_vk_bound;

HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_bound_buffer(hdrp_i_gpu_vk_bound* bound,
                                                 const hdrp_gpu_vk_buffer* buffer)
{
    bound->buffer.buffer = buffer->buffer;
    bound->buffer.range = VK_WHOLE_SIZE;
}

/* A set of a pass for the frame that is recorded. */
HDRP_I_GPU_VK_FN hdrp_result hdrp_i_gpu_vk_bind(hdrp_gpu_vk* gpu,
                                                const hdrp_i_gpu_vk_shader* shader,
                                                const hdrp_i_gpu_vk_bound* bound,
                                                VkDescriptorSet* set)
{
    const hdrp_gpu_vk_pipeline* pipeline = &gpu->pipelines[shader->index];
    VkDescriptorSetAllocateInfo info;
    VkWriteDescriptorSet writes[HDRP_I_GPU_VK_BINDINGS_MAX];
    VkResult r;
    uint32_t i;
    if (pipeline->layout == VK_NULL_HANDLE) {
        return HDRP_ERROR_UNSUPPORTED;
    }
    if (gpu->passes_recorded == gpu->desc.frame_passes) {
        return HDRP_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = gpu->pools[gpu->frame];
    info.descriptorSetCount = 1u;
    info.pSetLayouts = &pipeline->set_layout;
    r = gpu->vk.AllocateDescriptorSets(gpu->desc.device, &info, set);
    if (r != VK_SUCCESS) {
        return hdrp_i_gpu_vk_result(r);
    }
    ++gpu->passes_recorded;
    memset(writes, 0, sizeof writes);
    for (i = 0u; shader->bindings[i]; ++i) {
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = *set;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1u;
        writes[i].descriptorType = hdrp_i_gpu_vk_type_of(shader->bindings[i]);
        writes[i].pImageInfo = &bound[i].image;
        writes[i].pBufferInfo = &bound[i].buffer;
    }
    gpu->vk.UpdateDescriptorSets(gpu->desc.device, i, writes, 0u, NULL);
    return HDRP_OK;
}

HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_dispatch(const hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                             const hdrp_i_gpu_vk_shader* shader,
                                             VkDescriptorSet set, const void* push,
                                             uint32_t groups_x, uint32_t groups_y)
{
    const hdrp_gpu_vk_pipeline* p = &gpu->pipelines[shader->index];
    gpu->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->pipeline);
    gpu->vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->layout, 0u, 1u, &set,
                                  0u, NULL);
    if (shader->push_bytes > 0u) {
        gpu->vk.CmdPushConstants(commands, p->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0u,
                                 shader->push_bytes, push);
    }
    gpu->vk.CmdDispatch(commands, groups_x, groups_y, 1u);
}

/* All that was written in some stages is seen in others. */
HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_barrier(const hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                            VkPipelineStageFlags from, VkAccessFlags written,
                                            VkPipelineStageFlags to, VkAccessFlags seen)
{
    VkMemoryBarrier all;
    memset(&all, 0, sizeof all);
    all.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    all.srcAccessMask = written;
    all.dstAccessMask = seen;
    gpu->vk.CmdPipelineBarrier(commands, from, to, 0u, 1u, &all, 0u, NULL, 0u, NULL);
}

/* Between the shaders of a pass. */
HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_next(const hdrp_gpu_vk* gpu, VkCommandBuffer commands)
{
    hdrp_i_gpu_vk_barrier(gpu, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

/* Parameters of a pass, of at most 65536 bytes, for its shaders; what was recorded before has read
 * the old ones. */
HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_update(const hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                           VkBuffer buffer, VkDeviceSize offset, size_t bytes,
                                           const void* data)
{
    hdrp_i_gpu_vk_barrier(gpu, commands, gpu->shader_stages | VK_PIPELINE_STAGE_TRANSFER_BIT,
                          VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                          VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    gpu->vk.CmdUpdateBuffer(commands, buffer, offset, bytes, data);
    hdrp_i_gpu_vk_barrier(gpu, commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                          VK_ACCESS_TRANSFER_WRITE_BIT, gpu->shader_stages,
                          VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_SHADER_READ_BIT |
                              VK_ACCESS_SHADER_WRITE_BIT);
}

/* What a pass writes is ordered after everything that shaders and copies did to it before, or seen
 * by them afterwards. With an image the layout of the layers of a level changes too: from the one
 * that is given to VK_IMAGE_LAYOUT_GENERAL, or afterwards to it. */
HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_order_level(const hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                                int before, VkImage image, uint32_t level,
                                                uint32_t layer_count, VkImageLayout layout)
{
    VkPipelineStageFlags others = gpu->shader_stages | VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkPipelineStageFlags own = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    VkAccessFlags from = before ? VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT
                                : VK_ACCESS_SHADER_WRITE_BIT;
    VkAccessFlags to = before ? VK_ACCESS_SHADER_WRITE_BIT
                              : VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT;
    VkMemoryBarrier all;
    VkImageMemoryBarrier one;
    if (before && layout != VK_IMAGE_LAYOUT_UNDEFINED) { /* what is there may be read as well */
        to |= VK_ACCESS_SHADER_READ_BIT;
    }
    memset(&all, 0, sizeof all);
    all.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    all.srcAccessMask = from;
    all.dstAccessMask = to;
    memset(&one, 0, sizeof one);
    one.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    one.srcAccessMask = from;
    one.dstAccessMask = to;
    one.oldLayout = before ? layout : VK_IMAGE_LAYOUT_GENERAL;
    one.newLayout = before ? VK_IMAGE_LAYOUT_GENERAL : layout;
    one.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    one.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    one.image = image;
    one.subresourceRange.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    one.subresourceRange.baseMipLevel = level;
    one.subresourceRange.levelCount = 1u;
    one.subresourceRange.layerCount = layer_count;
    gpu->vk.CmdPipelineBarrier(commands, before ? others : own, before ? own : others, 0u,
                               image == VK_NULL_HANDLE ? 1u : 0u, &all, 0u, NULL,
                               image == VK_NULL_HANDLE ? 0u : 1u, &one);
}

/* The same of all of an image whose contents before do not matter. */
HDRP_I_GPU_VK_FN void hdrp_i_gpu_vk_order(const hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                          int before, VkImage image)
{
    hdrp_i_gpu_vk_order_level(gpu, commands, before, image, 0u, 1u,
                              before ? VK_IMAGE_LAYOUT_UNDEFINED
                                     : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

#ifdef __cplusplus
}
#endif

#endif /* HDRP_GPU_VK_IMPLEMENTATION */
