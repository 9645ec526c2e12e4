/* hdrp_gpu_vk.h - the passes on the GPU: Vulkan compute, in the caller's command buffers.
 * SPDX-License-Identifier: MIT
 *
 * For an engine that has a device and a command buffer. The SPIR-V is at the end of this file, made
 * from shaders/, whose formulas are those of the other headers. Vulkan 1.1 and <vulkan/...> are all
 * that is needed: every function comes from the caller's loader, none from a library.
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
 *     hdrp_gpu_vk_fgd_bake(&gpu, commands, &table);       once; outside of render passes, like all
 *     hdrp_gpu_vk_measure_depth(&gpu, commands, &depth);
 *
 * Nothing is submitted and nothing is waited for. A pass does what the function of the same name
 * does on the CPU: hdrp_brdf_fgd_bake_rows, hdrp_cull_measure_depth. Each says in which layouts it
 * takes and leaves images. What it writes may have been read or written by compute and fragment
 * shaders and by copies in earlier commands of the same queue, and may be read by them in later
 * ones: the barriers for that are recorded. What it reads is for the caller to make visible to the
 * compute stage, and so is what comes from another queue or goes there.
 *
 * Pipelines, sets and push constants of VK_PIPELINE_BIND_POINT_COMPUTE are not what they were after
 * a pass. Memory of the host is asked for by the driver alone, through desc.allocation. An
 * hdrp_gpu_vk is not locked: threads that record at the same time need one each.
 *
 * >>index of the functions, without hdrp_gpu_vk_ (written by tools/api_check.py --write)
 *   context: missing init destroy begin_frame
 *   resources: buffer_create buffer_destroy image_create image_destroy
 *   passes: fgd_bake measure_depth
 * >>end */
#ifndef HDRP_GPU_VK_H
#define HDRP_GPU_VK_H

#include "hdrp_cull.h"

#if HDRP_VERSION != 100
#error "hdrp_gpu_vk.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#ifndef HDRP_GPU
#include <stddef.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Passes, or-ed. What is not asked for is not created, and needs nothing of the device. */
#define HDRP_GPU_VK_PASS_FGD   1u
#define HDRP_GPU_VK_PASS_DEPTH 2u
#define HDRP_GPU_VK_PASS_ALL   3u
#define HDRP_GPU_VK_PASS_COUNT 2u

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
    uint32_t frame_passes; /* [0,65536] passes that are recorded in a frame, at most; 0: 64 */
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
    X(CmdPipelineBarrier)                                                                          \
    X(CmdPushConstants)                                                                            \
    X(CreateBuffer)                                                                                \
    X(CreateComputePipelines)                                                                      \
    X(CreateDescriptorPool)                                                                        \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(CreatePipelineLayout)                                                                        \
    X(CreateShaderModule)                                                                          \
    X(DestroyBuffer)                                                                               \
    X(DestroyDescriptorPool)                                                                       \
    X(DestroyDescriptorSetLayout)                                                                  \
    X(DestroyImage)                                                                                \
    X(DestroyImageView)                                                                            \
    X(DestroyPipeline)                                                                             \
    X(DestroyPipelineLayout)                                                                       \
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
    X(GetPhysicalDeviceQueueFamilyProperties)

#define HDRP_GPU_VK_MEMBER(name) PFN_vk##name name;
typedef struct hdrp_gpu_vk_functions {
    HDRP_GPU_VK_DEVICE_FUNCTIONS(HDRP_GPU_VK_MEMBER)
    HDRP_GPU_VK_INSTANCE_FUNCTIONS(HDRP_GPU_VK_MEMBER)
    PFN_vkSetDebugUtilsObjectNameEXT SetDebugUtilsObjectNameEXT; /* NULL without the extension */
} hdrp_gpu_vk_functions;
#undef HDRP_GPU_VK_MEMBER

typedef struct hdrp_gpu_vk_pass {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline; /* VK_NULL_HANDLE where it was not asked for */
} hdrp_gpu_vk_pass;

/* The members are for reading. */
typedef struct hdrp_gpu_vk {
    hdrp_gpu_vk_desc desc; /* with the defaults in place */
    hdrp_gpu_vk_functions vk;
    VkPhysicalDeviceMemoryProperties memory_types;
    VkDeviceSize buffer_range_max, buffer_alignment; /* limits of storage buffers */
    VkPipelineStageFlags shader_stages;              /* compute and, where there are, fragment */
    hdrp_gpu_vk_pass passes[HDRP_GPU_VK_PASS_COUNT]; /* in the order of HDRP_GPU_VK_PASS_... */
    VkDescriptorPool pools[HDRP_GPU_VK_FRAMES_MAX];
    uint32_t frame, passes_recorded; /* the frame that is recorded, and passes in it */
} hdrp_gpu_vk;

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

/* >>passes */

/** Records HDRP_GPU_VK_PASS_FGD: the table of FGD, as hdrp_brdf_fgd_bake_rows writes it.
 *  gpu       from hdrp_gpu_vk_init
 *  commands  that are recorded, outside of a render pass
 *  table     width equals height, [2,4096] px, of a format with a red and a green channel that can
 *            be stored to: R32G32_SFLOAT, R16G16_UNORM, RGBA16_SFLOAT; its usage includes
 *            VK_IMAGE_USAGE_STORAGE_BIT and VK_IMAGE_USAGE_SAMPLED_BIT
 *  returns   HDRP_OK, or an error, with nothing recorded
 *  errors    HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT, HDRP_ERROR_UNSUPPORTED where the
 *            pass was not asked for or the format cannot be stored to,
 *            HDRP_ERROR_OUT_OF_DEVICE_MEMORY beyond desc.frame_passes, and those of the driver as
 *            for hdrp_gpu_vk_init
 *  note      albedo is red, schlick green, within 1.5e-4 of hdrp_brdf_fgd_bake_rows, and rounded to
 *            the format. Contents before do not matter: VK_IMAGE_LAYOUT_UNDEFINED in, and
 *            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL out, of the one level and layer. Needs the
 *            feature shaderStorageImageWriteWithoutFormat */
HDRP_API hdrp_result hdrp_gpu_vk_fgd_bake(hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                          const hdrp_gpu_vk_image* table);

/* Depths of a picture, and the tiles that they are measured for. */
typedef struct hdrp_gpu_vk_depth {
    VkImageView view;     /* red channel or depth aspect, of one sample; usage includes SAMPLED */
    VkImageLayout layout; /* that the image is in, and stays in: one to be sampled in */
    uint32_t width_px, height_px; /* [1,HDRP_CULL_SIZE_MAX] of the picture, at most the image's */
    const hdrp_depth_params* device; /* how to read device depth; NULL: texels are metres */
    hdrp_cull_camera camera;         /* from its makers */
    hdrp_cull_grid grid;             /* of hdrp_cull_grid_make for the picture and the camera */
    uint32_t flags;                  /* those of hdrp_cull_desc: HDRP_CULL_ONE_SERIES counts */
    VkBuffer tiles;                  /* usage includes STORAGE */
    VkDeviceSize tiles_offset;       /* multiple of the limit minStorageBufferOffsetAlignment: there
                                  begins an hdrp_v4 for each tile, row by row */
} hdrp_gpu_vk_depth;

/** Records HDRP_GPU_VK_PASS_DEPTH: the nearest and farthest opaque depth of each tile, and the
 *  scale of its slices, as hdrp_cull_measure_depth writes them.
 *  gpu       from hdrp_gpu_vk_init
 *  commands  that are recorded, outside of a render pass
 *  depth     what is read and written
 *  returns   HDRP_OK, or an error, with nothing recorded
 *  errors    HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for sizes out of their ranges, a grid
 *            of another picture or an offset that is not aligned, HDRP_ERROR_TOO_LARGE where the
 *            tiles exceed the limit maxStorageBufferRange, HDRP_ERROR_UNSUPPORTED where the pass
 *            was not asked for, HDRP_ERROR_OUT_OF_DEVICE_MEMORY beyond desc.frame_passes, and those
 *            of the driver as for hdrp_gpu_vk_init
 *  note      equal to the bit where the device divides as IEEE 754 says and the depths are metres.
 *            The image is read by the compute stage: writers before it and after it have to be
 *            ordered by the caller */
HDRP_API hdrp_result hdrp_gpu_vk_measure_depth(hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                               const hdrp_gpu_vk_depth* depth);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_GPU_VK_H */

#if defined(HDRP_GPU_VK_IMPLEMENTATION) && !defined(HDRP_GPU_VK_IMPLEMENTED) && !defined(HDRP_GPU)
#define HDRP_GPU_VK_IMPLEMENTED

#ifdef __cplusplus
extern "C" {
#endif

/* ---- what a pass is made of ------------------------------------------------------------------ */

#define HDRP_I_GPU_VK_BINDINGS_MAX 2u
#define HDRP_I_GPU_VK_FAMILIES_MAX 64u

/* A compute shader, its bindings in order from 0 on, and the bytes of its push constants. */
typedef struct hdrp_i_gpu_vk_shader {
    const char* name;
    const uint32_t* words;
    size_t bytes;
    uint32_t bindings;
    VkDescriptorType types[HDRP_I_GPU_VK_BINDINGS_MAX];
    uint32_t push_bytes;
} hdrp_i_gpu_vk_shader;

/* Defined behind the words. */
static hdrp_i_gpu_vk_shader hdrp_i_gpu_vk_shader_of(uint32_t pass);

/* Push constants, as the shaders declare them. */
typedef struct hdrp_i_gpu_vk_push_fgd {
    hdrp_u32x4 size;
} hdrp_i_gpu_vk_push_fgd;

typedef struct hdrp_i_gpu_vk_push_depth {
    hdrp_cull_grid grid;
    hdrp_depth_params device;
    hdrp_v4 limits;
    hdrp_u32x4 picture;
} hdrp_i_gpu_vk_push_depth;

static hdrp_result hdrp_i_gpu_vk_result(VkResult r)
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

static void hdrp_i_gpu_vk_name(const hdrp_gpu_vk* gpu, VkObjectType type, uint64_t object,
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
    if (passes & HDRP_GPU_VK_PASS_FGD) {
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

static VkResult hdrp_i_gpu_vk_layouts(hdrp_gpu_vk* gpu, const hdrp_i_gpu_vk_shader* shader,
                                      hdrp_gpu_vk_pass* pass)
{
    VkDescriptorSetLayoutBinding bindings[HDRP_I_GPU_VK_BINDINGS_MAX];
    VkDescriptorSetLayoutCreateInfo sets;
    VkPipelineLayoutCreateInfo layout;
    VkPushConstantRange push;
    VkResult r;
    uint32_t i;
    memset(bindings, 0, sizeof bindings);
    for (i = 0u; i < shader->bindings; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = shader->types[i];
        bindings[i].descriptorCount = 1u;
        bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    }
    memset(&sets, 0, sizeof sets);
    sets.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    sets.bindingCount = shader->bindings;
    sets.pBindings = bindings;
    r = gpu->vk.CreateDescriptorSetLayout(gpu->desc.device, &sets, gpu->desc.allocation,
                                          &pass->set_layout);
    if (r != VK_SUCCESS) {
        return r;
    }
    push.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    push.offset = 0u;
    push.size = shader->push_bytes;
    memset(&layout, 0, sizeof layout);
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1u;
    layout.pSetLayouts = &pass->set_layout;
    layout.pushConstantRangeCount = 1u;
    layout.pPushConstantRanges = &push;
    return gpu->vk.CreatePipelineLayout(gpu->desc.device, &layout, gpu->desc.allocation,
                                        &pass->layout);
}

static VkResult hdrp_i_gpu_vk_pipeline(hdrp_gpu_vk* gpu, const hdrp_i_gpu_vk_shader* shader,
                                       hdrp_gpu_vk_pass* pass)
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
    info.layout = pass->layout;
    r = gpu->vk.CreateComputePipelines(gpu->desc.device, gpu->desc.pipeline_cache, 1u, &info,
                                       gpu->desc.allocation, &pass->pipeline);
    gpu->vk.DestroyShaderModule(gpu->desc.device, module_of_shader, gpu->desc.allocation);
    return r;
}

/* Sets of a frame; of each type as many descriptors as the passes could need. */
static VkResult hdrp_i_gpu_vk_pool(hdrp_gpu_vk* gpu, VkDescriptorPool* pool)
{
    static const VkDescriptorType types[3] = {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                              VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                              VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    VkDescriptorPoolSize sizes[3];
    VkDescriptorPoolCreateInfo info;
    uint32_t i;
    for (i = 0u; i < 3u; ++i) {
        sizes[i].type = types[i];
        sizes[i].descriptorCount = gpu->desc.frame_passes * HDRP_I_GPU_VK_BINDINGS_MAX;
    }
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = gpu->desc.frame_passes;
    info.poolSizeCount = 3u;
    info.pPoolSizes = sizes;
    return gpu->vk.CreateDescriptorPool(gpu->desc.device, &info, gpu->desc.allocation, pool);
}

static VkResult hdrp_i_gpu_vk_make(hdrp_gpu_vk* gpu)
{
    VkResult r = VK_SUCCESS;
    uint32_t i;
    for (i = 0u; i < HDRP_GPU_VK_PASS_COUNT && r == VK_SUCCESS; ++i) {
        hdrp_i_gpu_vk_shader shader = hdrp_i_gpu_vk_shader_of(i);
        hdrp_gpu_vk_pass* pass = &gpu->passes[i];
        if ((gpu->desc.passes >> i & 1u) == 0u) {
            continue;
        }
        r = hdrp_i_gpu_vk_layouts(gpu, &shader, pass);
        if (r == VK_SUCCESS) {
            r = hdrp_i_gpu_vk_pipeline(gpu, &shader, pass);
        }
        if (r == VK_SUCCESS) {
            hdrp_i_gpu_vk_name(gpu, VK_OBJECT_TYPE_PIPELINE, (uint64_t)pass->pipeline, shader.name);
        }
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
    made.vk.GetPhysicalDeviceMemoryProperties(desc->physical_device, &made.memory_types);
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
    for (i = 0u; i < HDRP_GPU_VK_PASS_COUNT; ++i) {
        hdrp_gpu_vk_pass* pass = &gpu->passes[i];
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

/* ---- resources ------------------------------------------------------------------------------- */

static hdrp_result hdrp_i_gpu_vk_allocate(const hdrp_gpu_vk* gpu, const VkMemoryRequirements* needs,
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

static void hdrp_i_gpu_vk_release(const hdrp_gpu_vk* gpu, const hdrp_gpu_vk_block* block)
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
static int hdrp_i_gpu_vk_has_format(const hdrp_gpu_vk* gpu, VkFormat format,
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

/* Of an image that exists, the memory and the view. */
static hdrp_result hdrp_i_gpu_vk_image_fill(const hdrp_gpu_vk* gpu, hdrp_gpu_vk_image* image)
{
    VkMemoryRequirements needs;
    VkImageViewCreateInfo view;
    hdrp_result r;
    gpu->vk.GetImageMemoryRequirements(gpu->desc.device, image->image, &needs);
    r = hdrp_i_gpu_vk_allocate(gpu, &needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, &image->block);
    if (r != HDRP_OK) {
        memset(&image->block, 0, sizeof image->block);
        return r;
    }
    r = hdrp_i_gpu_vk_result(gpu->vk.BindImageMemory(gpu->desc.device, image->image,
                                                     image->block.memory, image->block.offset));
    if (r != HDRP_OK) {
        return r;
    }
    memset(&view, 0, sizeof view);
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image->image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = image->format;
    view.subresourceRange.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    view.subresourceRange.levelCount = 1u;
    view.subresourceRange.layerCount = 1u;
    return hdrp_i_gpu_vk_result(
        gpu->vk.CreateImageView(gpu->desc.device, &view, gpu->desc.allocation, &image->view));
}

HDRP_API hdrp_result hdrp_gpu_vk_image_create(const hdrp_gpu_vk* gpu, VkFormat format,
                                              uint32_t width_px, uint32_t height_px,
                                              VkImageUsageFlags usage, const char* name,
                                              hdrp_gpu_vk_image* image)
{
    VkImageCreateInfo info;
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
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent.width = width_px;
    info.extent.height = height_px;
    info.extent.depth = 1u;
    info.mipLevels = 1u;
    info.arrayLayers = 1u;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usage;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    r = hdrp_i_gpu_vk_result(
        gpu->vk.CreateImage(gpu->desc.device, &info, gpu->desc.allocation, &made.image));
    if (r == HDRP_OK) {
        r = hdrp_i_gpu_vk_image_fill(gpu, &made);
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

/* ---- passes ---------------------------------------------------------------------------------- */

/* What a binding is bound to: the image or the buffer. */
typedef struct hdrp_i_gpu_vk_bound {
    VkDescriptorImageInfo image;
    VkDescriptorBufferInfo buffer;
} hdrp_i_gpu_vk_bound;

/* A set of a pass for the frame that is recorded. */
static hdrp_result hdrp_i_gpu_vk_bind(hdrp_gpu_vk* gpu, uint32_t pass,
                                      const hdrp_i_gpu_vk_bound* bound, VkDescriptorSet* set)
{
    hdrp_i_gpu_vk_shader shader = hdrp_i_gpu_vk_shader_of(pass);
    VkDescriptorSetAllocateInfo info;
    VkWriteDescriptorSet writes[HDRP_I_GPU_VK_BINDINGS_MAX];
    VkResult r;
    uint32_t i;
    if (gpu->passes[pass].pipeline == VK_NULL_HANDLE) {
        return HDRP_ERROR_UNSUPPORTED;
    }
    if (gpu->passes_recorded == gpu->desc.frame_passes) {
        return HDRP_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = gpu->pools[gpu->frame];
    info.descriptorSetCount = 1u;
    info.pSetLayouts = &gpu->passes[pass].set_layout;
    r = gpu->vk.AllocateDescriptorSets(gpu->desc.device, &info, set);
    if (r != VK_SUCCESS) {
        return hdrp_i_gpu_vk_result(r);
    }
    ++gpu->passes_recorded;
    memset(writes, 0, sizeof writes);
    for (i = 0u; i < shader.bindings; ++i) {
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = *set;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1u;
        writes[i].descriptorType = shader.types[i];
        writes[i].pImageInfo = &bound[i].image;
        writes[i].pBufferInfo = &bound[i].buffer;
    }
    gpu->vk.UpdateDescriptorSets(gpu->desc.device, shader.bindings, writes, 0u, NULL);
    return HDRP_OK;
}

static void hdrp_i_gpu_vk_dispatch(const hdrp_gpu_vk* gpu, VkCommandBuffer commands, uint32_t pass,
                                   VkDescriptorSet set, const void* push, uint32_t groups_x,
                                   uint32_t groups_y)
{
    const hdrp_gpu_vk_pass* p = &gpu->passes[pass];
    gpu->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->pipeline);
    gpu->vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->layout, 0u, 1u, &set,
                                  0u, NULL);
    gpu->vk.CmdPushConstants(commands, p->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0u,
                             hdrp_i_gpu_vk_shader_of(pass).push_bytes, push);
    gpu->vk.CmdDispatch(commands, groups_x, groups_y, 1u);
}

/* What a pass writes is ordered after everything that shaders and copies did to it before, or seen
 * by them afterwards. With an image its layout changes too. */
static void hdrp_i_gpu_vk_order(const hdrp_gpu_vk* gpu, VkCommandBuffer commands, int before,
                                VkImage image)
{
    VkPipelineStageFlags others = gpu->shader_stages | VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkPipelineStageFlags own = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    VkAccessFlags from = before ? VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT
                                : VK_ACCESS_SHADER_WRITE_BIT;
    VkAccessFlags to = before ? VK_ACCESS_SHADER_WRITE_BIT
                              : VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT;
    VkMemoryBarrier all;
    VkImageMemoryBarrier one;
    memset(&all, 0, sizeof all);
    all.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    all.srcAccessMask = from;
    all.dstAccessMask = to;
    memset(&one, 0, sizeof one);
    one.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    one.srcAccessMask = from;
    one.dstAccessMask = to;
    one.oldLayout = before ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL;
    one.newLayout = before ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    one.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    one.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    one.image = image;
    one.subresourceRange.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    one.subresourceRange.levelCount = 1u;
    one.subresourceRange.layerCount = 1u;
    gpu->vk.CmdPipelineBarrier(commands, before ? others : own, before ? own : others, 0u,
                               image == VK_NULL_HANDLE ? 1u : 0u, &all, 0u, NULL,
                               image == VK_NULL_HANDLE ? 0u : 1u, &one);
}

HDRP_API hdrp_result hdrp_gpu_vk_fgd_bake(hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                          const hdrp_gpu_vk_image* table)
{
    hdrp_i_gpu_vk_push_fgd push;
    hdrp_i_gpu_vk_bound bound;
    VkDescriptorSet set = VK_NULL_HANDLE;
    hdrp_result r;
    if (!gpu || !commands || !table || table->image == VK_NULL_HANDLE ||
        table->view == VK_NULL_HANDLE) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (table->width_px != table->height_px || table->width_px < 2u || table->width_px > 4096u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    if (!hdrp_i_gpu_vk_has_format(gpu, table->format, VK_IMAGE_USAGE_STORAGE_BIT)) {
        return HDRP_ERROR_UNSUPPORTED;
    }
    memset(&bound, 0, sizeof bound);
    bound.image.imageView = table->view;
    bound.image.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    r = hdrp_i_gpu_vk_bind(gpu, 0u, &bound, &set);
    if (r != HDRP_OK) {
        return r;
    }
    push.size = hdrp_u32x4_make(table->width_px, 0u, 0u, 0u);
    hdrp_i_gpu_vk_order(gpu, commands, 1, table->image);
    hdrp_i_gpu_vk_dispatch(gpu, commands, 0u, set, &push, table->width_px, table->width_px);
    hdrp_i_gpu_vk_order(gpu, commands, 0, table->image);
    return HDRP_OK;
}

/* Whether a number of tiles of a size is what covers a side of a picture. */
static int hdrp_i_gpu_vk_bad_side(uint32_t size_px, uint32_t tile_px, uint32_t tiles)
{
    return size_px - 1u >= HDRP_CULL_SIZE_MAX || tile_px - 1u >= HDRP_CULL_SIZE_MAX ||
           tiles != (size_px + tile_px - 1u) / tile_px;
}

HDRP_API hdrp_result hdrp_gpu_vk_measure_depth(hdrp_gpu_vk* gpu, VkCommandBuffer commands,
                                               const hdrp_gpu_vk_depth* depth)
{
    hdrp_i_gpu_vk_push_depth push;
    hdrp_i_gpu_vk_bound bound[2];
    VkDescriptorSet set = VK_NULL_HANDLE;
    VkDeviceSize bytes;
    hdrp_u32x4 tiles;
    hdrp_result r;
    if (!gpu || !commands || !depth || depth->view == VK_NULL_HANDLE ||
        depth->tiles == VK_NULL_HANDLE) {
        return HDRP_ERROR_NULL_POINTER;
    }
    tiles = depth->grid.tiles;
    if (hdrp_i_gpu_vk_bad_side(depth->width_px, tiles.x, tiles.z) ||
        hdrp_i_gpu_vk_bad_side(depth->height_px, tiles.y, tiles.w) ||
        depth->tiles_offset % gpu->buffer_alignment != 0u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    bytes = (VkDeviceSize)tiles.z * tiles.w * sizeof(hdrp_v4);
    if (bytes > gpu->buffer_range_max) {
        return HDRP_ERROR_TOO_LARGE;
    }
    memset(bound, 0, sizeof bound);
    bound[0].image.imageView = depth->view;
    bound[0].image.imageLayout = depth->layout;
    bound[1].buffer.buffer = depth->tiles;
    bound[1].buffer.offset = depth->tiles_offset;
    bound[1].buffer.range = bytes;
    r = hdrp_i_gpu_vk_bind(gpu, 1u, bound, &set);
    if (r != HDRP_OK) {
        return r;
    }
    memset(&push, 0, sizeof push);
    push.grid = depth->grid;
    push.limits = hdrp_v4_make(depth->camera.eye_near.w, depth->camera.right_far.w, 0.0f, 0.0f);
    push.picture = hdrp_u32x4_make(depth->width_px, depth->height_px, depth->device != NULL,
                                   (depth->flags & HDRP_CULL_ONE_SERIES) != 0u);
    if (depth->device) {
        push.device = *depth->device;
    }
    hdrp_i_gpu_vk_order(gpu, commands, 1, VK_NULL_HANDLE);
    hdrp_i_gpu_vk_dispatch(gpu, commands, 1u, set, &push, tiles.z, tiles.w);
    hdrp_i_gpu_vk_order(gpu, commands, 0, VK_NULL_HANDLE);
    return HDRP_OK;
}

/* >>spirv, written by tools/embed_spirv.py
 * Glslang Version: 11:12.0.0, SPIRV-Tools v2023.1 */
/* clang-format off */
static const uint32_t hdrp_i_gpu_vk_spirv_depth[] = {
    0x07230203, 0x00010300, 0x0008000b, 0x00000387, 0x00000000, 0x00020011, 0x00000001, 0x0006000b,
    0x00000001, 0x4c534c47, 0x6474732e, 0x3035342e, 0x00000000, 0x0003000e, 0x00000000, 0x00000001,
    0x0008000f, 0x00000005, 0x00000004, 0x6e69616d, 0x00000000, 0x00000149, 0x00000166, 0x00000174,
    0x00060010, 0x00000004, 0x00000011, 0x00000008, 0x00000008, 0x00000001, 0x00040047, 0x00000149,
    0x0000000b, 0x0000001a, 0x00050048, 0x0000014e, 0x00000000, 0x00000023, 0x00000000, 0x00050048,
    0x0000014e, 0x00000001, 0x00000023, 0x00000010, 0x00050048, 0x0000014e, 0x00000002, 0x00000023,
    0x00000020, 0x00050048, 0x0000014f, 0x00000000, 0x00000023, 0x00000000, 0x00050048, 0x0000014f,
    0x00000001, 0x00000023, 0x00000010, 0x00050048, 0x00000150, 0x00000000, 0x00000023, 0x00000000,
    0x00050048, 0x00000150, 0x00000001, 0x00000023, 0x00000030, 0x00050048, 0x00000150, 0x00000002,
    0x00000023, 0x00000050, 0x00050048, 0x00000150, 0x00000003, 0x00000023, 0x00000060, 0x00030047,
    0x00000150, 0x00000002, 0x00040047, 0x00000166, 0x0000000b, 0x0000001d, 0x00040047, 0x00000174,
    0x0000000b, 0x0000001b, 0x00040047, 0x00000193, 0x00000022, 0x00000000, 0x00040047, 0x00000193,
    0x00000021, 0x00000000, 0x00040047, 0x000001ed, 0x00000006, 0x00000010, 0x00040048, 0x000001ee,
    0x00000000, 0x00000019, 0x00050048, 0x000001ee, 0x00000000, 0x00000023, 0x00000000, 0x00030047,
    0x000001ee, 0x00000002, 0x00040047, 0x000001f0, 0x00000022, 0x00000000, 0x00040047, 0x000001f0,
    0x00000021, 0x00000001, 0x00040047, 0x00000210, 0x0000000b, 0x00000019, 0x00030047, 0x00000226,
    0x0000002a, 0x00030047, 0x0000022a, 0x0000002a, 0x00030047, 0x0000022e, 0x0000002a, 0x00030047,
    0x00000232, 0x0000002a, 0x00030047, 0x00000236, 0x0000002a, 0x00030047, 0x0000023a, 0x0000002a,
    0x00030047, 0x0000023c, 0x0000002a, 0x00030047, 0x00000290, 0x0000002a, 0x00030047, 0x000002e1,
    0x0000002a, 0x00030047, 0x000002e8, 0x0000002a, 0x00030047, 0x000002fc, 0x0000002a, 0x00030047,
    0x00000301, 0x0000002a, 0x00030047, 0x00000304, 0x0000002a, 0x00030047, 0x00000305, 0x0000002a,
    0x00030047, 0x00000306, 0x0000002a, 0x00030047, 0x00000307, 0x0000002a, 0x00030047, 0x0000030c,
    0x0000002a, 0x00030047, 0x0000030d, 0x0000002a, 0x00030047, 0x0000030f, 0x0000002a, 0x00030047,
    0x00000310, 0x0000002a, 0x00030047, 0x00000311, 0x0000002a, 0x00020013, 0x00000002, 0x00030021,
    0x00000003, 0x00000002, 0x00040015, 0x00000006, 0x00000020, 0x00000000, 0x00030016, 0x00000008,
    0x00000020, 0x00040017, 0x00000028, 0x00000008, 0x00000004, 0x00040017, 0x0000003a, 0x00000006,
    0x00000004, 0x00020014, 0x0000005c, 0x0004002b, 0x00000008, 0x00000076, 0x00000000, 0x0004002b,
    0x00000008, 0x00000077, 0x3f800000, 0x00040015, 0x0000008a, 0x00000020, 0x00000001, 0x0004002b,
    0x0000008a, 0x0000008b, 0x00000001, 0x0004002b, 0x00000006, 0x0000008c, 0x00000000, 0x0004002b,
    0x00000006, 0x00000092, 0x00000001, 0x0004002b, 0x0000008a, 0x00000097, 0x00000000, 0x0004002b,
    0x00000006, 0x0000009d, 0x00000002, 0x0004002b, 0x00000006, 0x000000a8, 0x00000003, 0x0004002b,
    0x00000008, 0x000000ac, 0x00800000, 0x0004002b, 0x00000008, 0x000000b1, 0x5d5e0b6b, 0x0004002b,
    0x00000008, 0x000000ba, 0x7f7fffff, 0x0004002b, 0x0000008a, 0x000000c4, 0x00000017, 0x0004002b,
    0x00000006, 0x000000c6, 0x4b000000, 0x0004002b, 0x00000008, 0x000000ca, 0x4b00007f, 0x0004002b,
    0x00000006, 0x000000ce, 0x007fffff, 0x0004002b, 0x00000006, 0x000000d0, 0x3f800000, 0x0004002b,
    0x00000008, 0x000000d6, 0x3ee0a0a9, 0x0004002b, 0x00000008, 0x000000d8, 0xbe74cbaa, 0x0004002b,
    0x00000008, 0x000000da, 0x3da8341b, 0x0004002b, 0x0000008a, 0x000000ef, 0x00000002, 0x0004002b,
    0x00000008, 0x000000f8, 0x3a83126f, 0x0004002b, 0x00000008, 0x0000010a, 0x3f7fffef, 0x0004002b,
    0x00000008, 0x0000010e, 0xbf800000, 0x00040017, 0x00000144, 0x00000006, 0x00000002, 0x00040017,
    0x00000147, 0x00000006, 0x00000003, 0x00040020, 0x00000148, 0x00000001, 0x00000147, 0x0004003b,
    0x00000148, 0x00000149, 0x00000001, 0x0005001e, 0x0000014e, 0x0000003a, 0x0000003a, 0x00000028,
    0x0004001e, 0x0000014f, 0x00000028, 0x00000028, 0x0006001e, 0x00000150, 0x0000014e, 0x0000014f,
    0x00000028, 0x0000003a, 0x00040020, 0x00000151, 0x00000009, 0x00000150, 0x0004003b, 0x00000151,
    0x00000152, 0x00000009, 0x00040020, 0x00000153, 0x00000009, 0x0000003a, 0x0004002b, 0x0000008a,
    0x0000015e, 0x00000003, 0x00040020, 0x00000165, 0x00000001, 0x00000006, 0x0004003b, 0x00000165,
    0x00000166, 0x00000001, 0x00040020, 0x0000016b, 0x00000004, 0x00000006, 0x0004003b, 0x0000016b,
    0x0000016c, 0x00000004, 0x0004003b, 0x0000016b, 0x0000016f, 0x00000004, 0x0004002b, 0x00000006,
    0x00000170, 0x00000108, 0x0004003b, 0x00000148, 0x00000174, 0x00000001, 0x00090019, 0x00000191,
    0x00000008, 0x00000001, 0x00000000, 0x00000000, 0x00000000, 0x00000001, 0x00000000, 0x00040020,
    0x00000192, 0x00000000, 0x00000191, 0x0004003b, 0x00000192, 0x00000193, 0x00000000, 0x00040017,
    0x00000199, 0x0000008a, 0x00000002, 0x00040020, 0x0000019e, 0x00000009, 0x00000006, 0x00040020,
    0x000001a6, 0x00000009, 0x0000014f, 0x00040020, 0x000001b7, 0x00000009, 0x00000008, 0x0004002b,
    0x00000006, 0x000001cd, 0x00000008, 0x0003001d, 0x000001ed, 0x00000028, 0x0003001e, 0x000001ee,
    0x000001ed, 0x00040020, 0x000001ef, 0x0000000c, 0x000001ee, 0x0004003b, 0x000001ef, 0x000001f0,
    0x0000000c, 0x00040020, 0x000001fd, 0x00000009, 0x0000014e, 0x00040020, 0x0000020e, 0x0000000c,
    0x00000028, 0x0006002c, 0x00000147, 0x00000210, 0x000001cd, 0x000001cd, 0x00000092, 0x0004002b,
    0x00000006, 0x00000386, 0x7f7fffff, 0x00050036, 0x00000002, 0x00000004, 0x00000000, 0x00000003,
    0x000200f8, 0x00000005, 0x0004003d, 0x00000147, 0x0000014a, 0x00000149, 0x0007004f, 0x00000144,
    0x0000014b, 0x0000014a, 0x0000014a, 0x00000000, 0x00000001, 0x00060041, 0x00000153, 0x00000154,
    0x00000152, 0x00000097, 0x00000097, 0x0004003d, 0x0000003a, 0x00000155, 0x00000154, 0x0007004f,
    0x00000144, 0x00000156, 0x00000155, 0x00000155, 0x00000000, 0x00000001, 0x00050084, 0x00000144,
    0x00000157, 0x0000014b, 0x00000156, 0x00050080, 0x00000144, 0x0000015d, 0x00000157, 0x00000156,
    0x00050041, 0x00000153, 0x0000015f, 0x00000152, 0x0000015e, 0x0004003d, 0x0000003a, 0x00000160,
    0x0000015f, 0x0007004f, 0x00000144, 0x00000161, 0x00000160, 0x00000160, 0x00000000, 0x00000001,
    0x0007000c, 0x00000144, 0x00000162, 0x00000001, 0x00000026, 0x0000015d, 0x00000161, 0x0004003d,
    0x00000006, 0x00000167, 0x00000166, 0x000500aa, 0x0000005c, 0x00000168, 0x00000167, 0x0000008c,
    0x000300f7, 0x0000016a, 0x00000000, 0x000400fa, 0x00000168, 0x00000169, 0x0000016a, 0x000200f8,
    0x00000169, 0x0003003e, 0x0000016c, 0x00000386, 0x0003003e, 0x0000016f, 0x0000008c, 0x000200f9,
    0x0000016a, 0x000200f8, 0x0000016a, 0x000400e0, 0x0000009d, 0x0000009d, 0x00000170, 0x00050051,
    0x00000006, 0x00000173, 0x00000157, 0x00000001, 0x00050041, 0x00000165, 0x00000175, 0x00000174,
    0x00000092, 0x0004003d, 0x00000006, 0x00000176, 0x00000175, 0x00050080, 0x00000006, 0x00000177,
    0x00000173, 0x00000176, 0x000200f9, 0x00000178, 0x000200f8, 0x00000178, 0x000700f5, 0x00000008,
    0x00000377, 0x000000ba, 0x0000016a, 0x00000380, 0x0000017b, 0x000700f5, 0x00000008, 0x00000375,
    0x0000010e, 0x0000016a, 0x00000382, 0x0000017b, 0x000700f5, 0x00000006, 0x00000374, 0x00000177,
    0x0000016a, 0x000001d1, 0x0000017b, 0x00050051, 0x00000006, 0x0000017f, 0x00000162, 0x00000001,
    0x000500b0, 0x0000005c, 0x00000180, 0x00000374, 0x0000017f, 0x000400f6, 0x0000017a, 0x0000017b,
    0x00000000, 0x000400fa, 0x00000180, 0x00000179, 0x0000017a, 0x000200f8, 0x00000179, 0x00050051,
    0x00000006, 0x00000183, 0x00000157, 0x00000000, 0x00050041, 0x00000165, 0x00000184, 0x00000174,
    0x0000008c, 0x0004003d, 0x00000006, 0x00000185, 0x00000184, 0x00050080, 0x00000006, 0x00000186,
    0x00000183, 0x00000185, 0x000200f9, 0x00000187, 0x000200f8, 0x00000187, 0x000700f5, 0x00000008,
    0x00000382, 0x00000375, 0x00000179, 0x000001cc, 0x0000018a, 0x000700f5, 0x00000008, 0x00000380,
    0x00000377, 0x00000179, 0x000001c6, 0x0000018a, 0x000700f5, 0x00000006, 0x0000037c, 0x00000186,
    0x00000179, 0x000001cf, 0x0000018a, 0x00050051, 0x00000006, 0x0000018e, 0x00000162, 0x00000000,
    0x000500b0, 0x0000005c, 0x0000018f, 0x0000037c, 0x0000018e, 0x000400f6, 0x00000189, 0x0000018a,
    0x00000000, 0x000400fa, 0x0000018f, 0x00000188, 0x00000189, 0x000200f8, 0x00000188, 0x0004003d,
    0x00000191, 0x00000194, 0x00000193, 0x0004007c, 0x0000008a, 0x00000196, 0x0000037c, 0x0004007c,
    0x0000008a, 0x00000198, 0x00000374, 0x00050050, 0x00000199, 0x0000019a, 0x00000196, 0x00000198,
    0x0007005f, 0x00000028, 0x0000019b, 0x00000194, 0x0000019a, 0x00000002, 0x00000097, 0x00050051,
    0x00000008, 0x0000019c, 0x0000019b, 0x00000000, 0x00060041, 0x0000019e, 0x0000019f, 0x00000152,
    0x0000015e, 0x0000009d, 0x0004003d, 0x00000006, 0x000001a0, 0x0000019f, 0x000500ab, 0x0000005c,
    0x000001a1, 0x000001a0, 0x0000008c, 0x000300f7, 0x000001a4, 0x00000000, 0x000400fa, 0x000001a1,
    0x000001a3, 0x000001b1, 0x000200f8, 0x000001a3, 0x00050041, 0x000001a6, 0x000001a7, 0x00000152,
    0x0000008b, 0x0004003d, 0x0000014f, 0x000001a8, 0x000001a7, 0x00050051, 0x00000028, 0x000001a9,
    0x000001a8, 0x00000000, 0x00050051, 0x00000028, 0x000001ac, 0x000001a8, 0x00000001, 0x000500ba,
    0x0000005c, 0x00000255, 0x0000019c, 0x00000076, 0x000600a9, 0x00000008, 0x00000258, 0x00000255,
    0x0000019c, 0x00000076, 0x000500b8, 0x0000005c, 0x0000025d, 0x00000258, 0x00000077, 0x000600a9,
    0x00000008, 0x00000260, 0x0000025d, 0x00000258, 0x00000077, 0x00050051, 0x00000008, 0x00000225,
    0x000001ac, 0x00000000, 0x00050085, 0x00000008, 0x00000226, 0x00000260, 0x00000225, 0x00050051,
    0x00000008, 0x00000229, 0x000001ac, 0x00000001, 0x00050081, 0x00000008, 0x0000022a, 0x00000226,
    0x00000229, 0x00050051, 0x00000008, 0x0000022c, 0x000001a9, 0x00000000, 0x00050085, 0x00000008,
    0x0000022e, 0x0000022c, 0x0000022a, 0x00050051, 0x00000008, 0x00000230, 0x000001a9, 0x00000002,
    0x00050085, 0x00000008, 0x00000232, 0x00000230, 0x0000022a, 0x00050051, 0x00000008, 0x00000235,
    0x000001a9, 0x00000001, 0x00050081, 0x00000008, 0x00000236, 0x0000022e, 0x00000235, 0x00050051,
    0x00000008, 0x00000239, 0x000001a9, 0x00000003, 0x00050081, 0x00000008, 0x0000023a, 0x00000232,
    0x00000239, 0x000500ba, 0x0000005c, 0x00000265, 0x0000023a, 0x000000ac, 0x000600a9, 0x00000008,
    0x00000268, 0x00000265, 0x0000023a, 0x000000ac, 0x00050088, 0x00000008, 0x0000023c, 0x00000236,
    0x00000268, 0x000500ba, 0x0000005c, 0x00000278, 0x0000023c, 0x00000076, 0x000600a9, 0x00000008,
    0x0000027b, 0x00000278, 0x0000023c, 0x00000076, 0x000500b8, 0x0000005c, 0x00000280, 0x0000027b,
    0x000000b1, 0x000600a9, 0x00000008, 0x00000283, 0x00000280, 0x0000027b, 0x000000b1, 0x000200f9,
    0x000001a4, 0x000200f8, 0x000001b1, 0x000200f9, 0x000001a4, 0x000200f8, 0x000001a4, 0x000700f5,
    0x00000008, 0x0000037e, 0x00000283, 0x000001a3, 0x0000019c, 0x000001b1, 0x00060041, 0x000001b7,
    0x000001b8, 0x00000152, 0x000000ef, 0x0000008c, 0x0004003d, 0x00000008, 0x000001b9, 0x000001b8,
    0x00060041, 0x000001b7, 0x000001bb, 0x00000152, 0x000000ef, 0x00000092, 0x0004003d, 0x00000008,
    0x000001bc, 0x000001bb, 0x000500b8, 0x0000005c, 0x0000028a, 0x0000037e, 0x000001b9, 0x000600a9,
    0x00000008, 0x0000028d, 0x0000028a, 0x000001b9, 0x0000037e, 0x00050085, 0x00000008, 0x00000290,
    0x000001bc, 0x0000010a, 0x000500b8, 0x0000005c, 0x00000291, 0x0000037e, 0x00000290, 0x000600a9,
    0x00000008, 0x00000293, 0x00000291, 0x0000028d, 0x0000010e, 0x000500be, 0x0000005c, 0x00000295,
    0x0000037e, 0x00000076, 0x000600a9, 0x00000008, 0x00000297, 0x00000295, 0x00000293, 0x0000010e,
    0x000500be, 0x0000005c, 0x000001bf, 0x00000297, 0x00000076, 0x000500b8, 0x0000005c, 0x000001c2,
    0x00000297, 0x00000380, 0x000500a7, 0x0000005c, 0x000001c3, 0x000001bf, 0x000001c2, 0x000600a9,
    0x00000008, 0x000001c6, 0x000001c3, 0x00000297, 0x00000380, 0x000500ba, 0x0000005c, 0x000001c9,
    0x00000297, 0x00000382, 0x000600a9, 0x00000008, 0x000001cc, 0x000001c9, 0x00000297, 0x00000382,
    0x000200f9, 0x0000018a, 0x000200f8, 0x0000018a, 0x00050080, 0x00000006, 0x000001cf, 0x0000037c,
    0x000001cd, 0x000200f9, 0x00000187, 0x000200f8, 0x00000189, 0x000200f9, 0x0000017b, 0x000200f8,
    0x0000017b, 0x00050080, 0x00000006, 0x000001d1, 0x00000374, 0x000001cd, 0x000200f9, 0x00000178,
    0x000200f8, 0x0000017a, 0x000500be, 0x0000005c, 0x000001d3, 0x00000375, 0x00000076, 0x000300f7,
    0x000001d5, 0x00000000, 0x000400fa, 0x000001d3, 0x000001d4, 0x000001d5, 0x000200f8, 0x000001d4,
    0x0004007c, 0x00000006, 0x0000029b, 0x00000377, 0x000700ed, 0x00000006, 0x000001d9, 0x0000016c,
    0x00000092, 0x0000008c, 0x0000029b, 0x0004007c, 0x00000006, 0x0000029f, 0x00000375, 0x000700ef,
    0x00000006, 0x000001dd, 0x0000016f, 0x00000092, 0x0000008c, 0x0000029f, 0x000200f9, 0x000001d5,
    0x000200f8, 0x000001d5, 0x000400e0, 0x0000009d, 0x0000009d, 0x00000170, 0x000300f7, 0x000001e1,
    0x00000000, 0x000400fa, 0x00000168, 0x000001e0, 0x000001e1, 0x000200f8, 0x000001e0, 0x0004003d,
    0x00000006, 0x000001e3, 0x0000016f, 0x000500aa, 0x0000005c, 0x000001e4, 0x000001e3, 0x0000008c,
    0x000300f7, 0x000001e7, 0x00000000, 0x000400fa, 0x000001e4, 0x000001e6, 0x000001e8, 0x000200f8,
    0x000001e6, 0x000200f9, 0x000001e7, 0x000200f8, 0x000001e8, 0x0004003d, 0x00000006, 0x000001ea,
    0x0000016f, 0x0004007c, 0x00000008, 0x000002a3, 0x000001ea, 0x000200f9, 0x000001e7, 0x000200f8,
    0x000001e7, 0x000700f5, 0x00000008, 0x00000379, 0x0000010e, 0x000001e6, 0x000002a3, 0x000001e8,
    0x00050051, 0x00000006, 0x000001f2, 0x0000014a, 0x00000001, 0x00070041, 0x0000019e, 0x000001f3,
    0x00000152, 0x00000097, 0x00000097, 0x0000009d, 0x0004003d, 0x00000006, 0x000001f4, 0x000001f3,
    0x00050084, 0x00000006, 0x000001f5, 0x000001f2, 0x000001f4, 0x00050051, 0x00000006, 0x000001f7,
    0x0000014a, 0x00000000, 0x00050080, 0x00000006, 0x000001f8, 0x000001f5, 0x000001f7, 0x0004003d,
    0x00000006, 0x000001fa, 0x0000016c, 0x0004007c, 0x00000008, 0x000002a7, 0x000001fa, 0x00050041,
    0x000001fd, 0x000001fe, 0x00000152, 0x00000097, 0x0004003d, 0x0000014e, 0x000001ff, 0x000001fe,
    0x00050051, 0x0000003a, 0x00000203, 0x000001ff, 0x00000001, 0x00050051, 0x00000028, 0x00000205,
    0x000001ff, 0x00000002, 0x00060041, 0x0000019e, 0x0000020b, 0x00000152, 0x0000015e, 0x000000a8,
    0x0004003d, 0x00000006, 0x0000020c, 0x0000020b, 0x000500ba, 0x0000005c, 0x00000321, 0x00000379,
    0x000000ac, 0x000600a9, 0x00000008, 0x00000324, 0x00000321, 0x00000379, 0x000000ac, 0x000500b8,
    0x0000005c, 0x00000329, 0x00000324, 0x000000ba, 0x000600a9, 0x00000008, 0x0000032c, 0x00000329,
    0x00000324, 0x000000ba, 0x0004007c, 0x00000006, 0x00000330, 0x0000032c, 0x000500c2, 0x00000006,
    0x000002f9, 0x00000330, 0x000000c4, 0x000500c5, 0x00000006, 0x000002fa, 0x000002f9, 0x000000c6,
    0x0004007c, 0x00000008, 0x00000334, 0x000002fa, 0x00050083, 0x00000008, 0x000002fc, 0x00000334,
    0x000000ca, 0x000500c7, 0x00000006, 0x000002fe, 0x00000330, 0x000000ce, 0x000500c5, 0x00000006,
    0x000002ff, 0x000002fe, 0x000000d0, 0x0004007c, 0x00000008, 0x00000338, 0x000002ff, 0x00050083,
    0x00000008, 0x00000301, 0x00000338, 0x00000077, 0x00050085, 0x00000008, 0x00000304, 0x00000301,
    0x000000da, 0x00050081, 0x00000008, 0x00000305, 0x000000d8, 0x00000304, 0x00050085, 0x00000008,
    0x00000306, 0x00000301, 0x00000305, 0x00050081, 0x00000008, 0x00000307, 0x000000d6, 0x00000306,
    0x00050083, 0x00000008, 0x0000030c, 0x00000077, 0x00000301, 0x00050085, 0x00000008, 0x0000030d,
    0x00000301, 0x0000030c, 0x00050085, 0x00000008, 0x0000030f, 0x0000030d, 0x00000307, 0x00050081,
    0x00000008, 0x00000310, 0x00000301, 0x0000030f, 0x00050081, 0x00000008, 0x00000311, 0x000002fc,
    0x00000310, 0x00050051, 0x00000008, 0x000002e0, 0x00000205, 0x00000001, 0x00050083, 0x00000008,
    0x000002e1, 0x00000311, 0x000002e0, 0x00050051, 0x00000006, 0x000002e3, 0x00000203, 0x00000000,
    0x000500c2, 0x00000006, 0x000002e4, 0x000002e3, 0x0000008b, 0x00040070, 0x00000008, 0x0000033c,
    0x000002e4, 0x000500ba, 0x0000005c, 0x00000341, 0x000002e1, 0x000000f8, 0x000600a9, 0x00000008,
    0x00000344, 0x00000341, 0x000002e1, 0x000000f8, 0x00050088, 0x00000008, 0x000002e8, 0x0000033c,
    0x00000344, 0x000500ab, 0x0000005c, 0x000002ba, 0x0000020c, 0x0000008c, 0x000300f7, 0x000002c0,
    0x00000000, 0x000400fa, 0x000002ba, 0x000002bb, 0x000002be, 0x000200f8, 0x000002bb, 0x00050051,
    0x00000008, 0x000002bd, 0x00000205, 0x00000003, 0x000200f9, 0x000002c0, 0x000200f8, 0x000002be,
    0x000200f9, 0x000002c0, 0x000200f8, 0x000002c0, 0x000700f5, 0x00000008, 0x0000037a, 0x000002bd,
    0x000002bb, 0x000002e8, 0x000002be, 0x000500be, 0x0000005c, 0x000002c3, 0x00000379, 0x00000076,
    0x000300f7, 0x000002c9, 0x00000000, 0x000400fa, 0x000002c3, 0x000002c4, 0x000002c6, 0x000200f8,
    0x000002c4, 0x000200f9, 0x000002c9, 0x000200f8, 0x000002c6, 0x00050051, 0x00000008, 0x000002c8,
    0x00000205, 0x00000003, 0x000200f9, 0x000002c9, 0x000200f8, 0x000002c9, 0x000700f5, 0x00000008,
    0x0000037b, 0x0000037a, 0x000002c4, 0x000002c8, 0x000002c6, 0x000600a9, 0x00000008, 0x000002ce,
    0x000002c3, 0x000002a7, 0x00000077, 0x000600a9, 0x00000008, 0x000002d2, 0x000002c3, 0x00000379,
    0x0000010e, 0x00070050, 0x00000028, 0x0000034b, 0x000002ce, 0x000002d2, 0x0000037b, 0x00000076,
    0x00060041, 0x0000020e, 0x0000020f, 0x000001f0, 0x00000097, 0x000001f8, 0x0003003e, 0x0000020f,
    0x0000034b, 0x000200f9, 0x000001e1, 0x000200f8, 0x000001e1, 0x000100fd, 0x00010038,
};
static const uint32_t hdrp_i_gpu_vk_spirv_fgd[] = {
    0x07230203, 0x00010300, 0x0008000b, 0x00000784, 0x00000000, 0x00020011, 0x00000001, 0x00020011,
    0x00000038, 0x0006000b, 0x00000001, 0x4c534c47, 0x6474732e, 0x3035342e, 0x00000000, 0x0003000e,
    0x00000000, 0x00000001, 0x0007000f, 0x00000005, 0x00000004, 0x6e69616d, 0x00000000, 0x00000275,
    0x0000027c, 0x00060010, 0x00000004, 0x00000011, 0x00000040, 0x00000001, 0x00000001, 0x00040047,
    0x00000275, 0x0000000b, 0x0000001b, 0x00040047, 0x0000027c, 0x0000000b, 0x0000001a, 0x00050048,
    0x00000283, 0x00000000, 0x00000023, 0x00000000, 0x00030047, 0x00000283, 0x00000002, 0x00040047,
    0x000002eb, 0x00000022, 0x00000000, 0x00040047, 0x000002eb, 0x00000021, 0x00000000, 0x00030047,
    0x000002eb, 0x00000019, 0x00040047, 0x000002f5, 0x0000000b, 0x00000019, 0x00020013, 0x00000002,
    0x00030021, 0x00000003, 0x00000002, 0x00030016, 0x00000006, 0x00000020, 0x00040017, 0x00000057,
    0x00000006, 0x00000002, 0x00020014, 0x00000078, 0x0004002b, 0x00000006, 0x00000092, 0x00000000,
    0x0004002b, 0x00000006, 0x00000093, 0x3f800000, 0x00040015, 0x000000a6, 0x00000020, 0x00000000,
    0x0004002b, 0x000000a6, 0x000000a7, 0x00000000, 0x0004002b, 0x000000a6, 0x000000ac, 0x00000001,
    0x0004002b, 0x000000a6, 0x000000b1, 0x00000002, 0x0004002b, 0x00000006, 0x0000012a, 0x7f7fffff,
    0x0004002b, 0x00000006, 0x00000150, 0x38d1b717, 0x0004002b, 0x00000006, 0x00000173, 0x2edbe6ff,
    0x0004002b, 0x00000006, 0x0000017e, 0x3f000000, 0x0005002c, 0x00000057, 0x00000210, 0x00000092,
    0x00000092, 0x00040015, 0x00000211, 0x00000020, 0x00000001, 0x0004002b, 0x00000211, 0x00000214,
    0x00000000, 0x0004002b, 0x00000211, 0x0000021b, 0x00000100, 0x0004002b, 0x00000006, 0x00000246,
    0x40000000, 0x0004002b, 0x00000211, 0x0000026a, 0x00000001, 0x00040017, 0x00000273, 0x000000a6,
    0x00000003, 0x00040020, 0x00000274, 0x00000001, 0x00000273, 0x0004003b, 0x00000274, 0x00000275,
    0x00000001, 0x00040020, 0x00000276, 0x00000001, 0x000000a6, 0x00040017, 0x00000279, 0x000000a6,
    0x00000002, 0x0004003b, 0x00000274, 0x0000027c, 0x00000001, 0x00040017, 0x00000282, 0x000000a6,
    0x00000004, 0x0003001e, 0x00000283, 0x00000282, 0x00040020, 0x00000284, 0x00000009, 0x00000283,
    0x0004003b, 0x00000284, 0x00000285, 0x00000009, 0x00040020, 0x00000286, 0x00000009, 0x000000a6,
    0x0004002b, 0x00000006, 0x00000293, 0x358637bd, 0x0004002b, 0x000000a6, 0x000002a4, 0x00000040,
    0x0004001c, 0x000002a5, 0x00000057, 0x000002a4, 0x00040020, 0x000002a6, 0x00000004, 0x000002a5,
    0x0004003b, 0x000002a6, 0x000002a7, 0x00000004, 0x00040020, 0x000002b4, 0x00000004, 0x00000057,
    0x0004002b, 0x000000a6, 0x000002b7, 0x00000020, 0x0004002b, 0x000000a6, 0x000002bf, 0x00000108,
    0x00090019, 0x000002e9, 0x00000006, 0x00000001, 0x00000000, 0x00000000, 0x00000000, 0x00000002,
    0x00000000, 0x00040020, 0x000002ea, 0x00000000, 0x000002e9, 0x0004003b, 0x000002ea, 0x000002eb,
    0x00000000, 0x00040017, 0x000002ee, 0x00000211, 0x00000002, 0x00040017, 0x000002f1, 0x00000006,
    0x00000004, 0x0006002c, 0x00000273, 0x000002f5, 0x000002a4, 0x000000ac, 0x000000ac, 0x0004002b,
    0x00000006, 0x00000773, 0x3b800000, 0x0005002c, 0x00000057, 0x00000774, 0x00000773, 0x00000773,
    0x0004002b, 0x00000006, 0x00000775, 0x3c800000, 0x0005002c, 0x00000057, 0x00000776, 0x00000775,
    0x00000775, 0x0004002b, 0x00000006, 0x00000778, 0x3cc90fdb, 0x0004002b, 0x00000006, 0x0000077b,
    0x3d490fdb, 0x0004002b, 0x00000006, 0x0000077f, 0xbe22f983, 0x00050036, 0x00000002, 0x00000004,
    0x00000000, 0x00000003, 0x000200f8, 0x00000005, 0x00050041, 0x00000276, 0x00000277, 0x00000275,
    0x000000a7, 0x0004003d, 0x000000a6, 0x00000278, 0x00000277, 0x0004003d, 0x00000273, 0x0000027d,
    0x0000027c, 0x0007004f, 0x00000279, 0x0000027e, 0x0000027d, 0x0000027d, 0x00000000, 0x00000001,
    0x00040070, 0x00000057, 0x00000281, 0x0000027e, 0x00060041, 0x00000286, 0x00000287, 0x00000285,
    0x00000214, 0x000000a7, 0x0004003d, 0x000000a6, 0x00000288, 0x00000287, 0x00050082, 0x000000a6,
    0x00000289, 0x00000288, 0x000000ac, 0x00040070, 0x00000006, 0x0000028a, 0x00000289, 0x00050050,
    0x00000057, 0x0000028b, 0x0000028a, 0x0000028a, 0x00050088, 0x00000057, 0x0000028c, 0x00000281,
    0x0000028b, 0x00050051, 0x00000006, 0x0000028f, 0x0000028c, 0x00000000, 0x00050085, 0x00000006,
    0x00000292, 0x0000028f, 0x0000028f, 0x0007000c, 0x00000006, 0x00000294, 0x00000001, 0x00000028,
    0x00000292, 0x00000293, 0x00050083, 0x00000006, 0x00000297, 0x00000093, 0x00000294, 0x00050081,
    0x00000006, 0x00000299, 0x00000093, 0x00000294, 0x00050085, 0x00000006, 0x0000029a, 0x00000297,
    0x00000299, 0x0006000c, 0x00000006, 0x000002f9, 0x00000001, 0x0000001f, 0x0000029a, 0x00050051,
    0x00000006, 0x000002a2, 0x0000028c, 0x00000001, 0x000500ba, 0x00000078, 0x0000031a, 0x000002a2,
    0x00000092, 0x000600a9, 0x00000006, 0x0000031d, 0x0000031a, 0x000002a2, 0x00000092, 0x000500b8,
    0x00000078, 0x00000322, 0x0000031d, 0x00000093, 0x000600a9, 0x00000006, 0x00000325, 0x00000322,
    0x0000031d, 0x00000093, 0x00050085, 0x00000006, 0x0000032a, 0x00000325, 0x00000325, 0x000500ba,
    0x00000078, 0x0000032f, 0x0000032a, 0x00000150, 0x000600a9, 0x00000006, 0x00000332, 0x0000032f,
    0x0000032a, 0x00000150, 0x00040070, 0x00000006, 0x000002aa, 0x00000278, 0x00050081, 0x00000006,
    0x000002ab, 0x000002aa, 0x0000017e, 0x00050085, 0x00000006, 0x00000354, 0x00000294, 0x00000294,
    0x00050085, 0x00000006, 0x00000357, 0x00000332, 0x00000332, 0x0004007f, 0x00000006, 0x00000772,
    0x00000332, 0x0008000c, 0x00000006, 0x00000358, 0x00000001, 0x00000032, 0x00000772, 0x00000332,
    0x00000093, 0x0008000c, 0x00000006, 0x0000035d, 0x00000001, 0x00000032, 0x00000354, 0x00000358,
    0x00000357, 0x0006000c, 0x00000006, 0x000003a4, 0x00000001, 0x0000001f, 0x0000035d, 0x00050081,
    0x00000006, 0x0000035f, 0x00000294, 0x000003a4, 0x000200f9, 0x00000360, 0x000200f8, 0x00000360,
    0x000700f5, 0x00000057, 0x0000074b, 0x00000210, 0x00000005, 0x00000399, 0x00000364, 0x000700f5,
    0x00000211, 0x0000074a, 0x00000214, 0x00000005, 0x0000039c, 0x00000364, 0x000500b1, 0x00000078,
    0x00000363, 0x0000074a, 0x0000021b, 0x000400f6, 0x0000039d, 0x00000364, 0x00000000, 0x000400fa,
    0x00000363, 0x00000364, 0x0000039d, 0x000200f8, 0x00000364, 0x0004006f, 0x00000006, 0x00000366,
    0x0000074a, 0x00050081, 0x00000006, 0x00000367, 0x00000366, 0x0000017e, 0x00050085, 0x00000006,
    0x0000036b, 0x00000367, 0x00000778, 0x0006000c, 0x00000006, 0x000003a8, 0x00000001, 0x0000000d,
    0x0000036b, 0x00050085, 0x00000006, 0x0000077a, 0x000003a8, 0x0000077f, 0x0008000c, 0x00000006,
    0x0000036e, 0x00000001, 0x00000032, 0x00000367, 0x00000773, 0x0000077a, 0x0006000c, 0x00000006,
    0x000003ac, 0x00000001, 0x0000000e, 0x0000036b, 0x00050083, 0x00000006, 0x00000372, 0x00000093,
    0x000003ac, 0x000500ba, 0x00000078, 0x00000420, 0x00000332, 0x00000150, 0x000600a9, 0x00000006,
    0x00000423, 0x00000420, 0x00000332, 0x00000150, 0x00050085, 0x00000006, 0x000003dc, 0x00000423,
    0x000002f9, 0x000500ba, 0x00000078, 0x00000436, 0x00000294, 0x00000092, 0x000600a9, 0x00000006,
    0x00000439, 0x00000436, 0x00000294, 0x00000092, 0x0006000c, 0x00000006, 0x00000487, 0x00000001,
    0x00000004, 0x000003dc, 0x0006000c, 0x00000006, 0x0000048b, 0x00000001, 0x00000004, 0x00000092,
    0x000500ba, 0x00000078, 0x00000490, 0x00000487, 0x0000048b, 0x000600a9, 0x00000006, 0x00000493,
    0x00000490, 0x00000487, 0x0000048b, 0x0006000c, 0x00000006, 0x00000497, 0x00000001, 0x00000004,
    0x00000439, 0x000500ba, 0x00000078, 0x0000049c, 0x00000493, 0x00000497, 0x000600a9, 0x00000006,
    0x0000049f, 0x0000049c, 0x00000493, 0x00000497, 0x00050088, 0x00000006, 0x00000467, 0x000003dc,
    0x0000049f, 0x00050088, 0x00000006, 0x0000046f, 0x00000439, 0x0000049f, 0x00050085, 0x00000006,
    0x000004b7, 0x0000046f, 0x0000046f, 0x0008000c, 0x00000006, 0x000004b8, 0x00000001, 0x00000032,
    0x00000467, 0x00000467, 0x000004b7, 0x0006000c, 0x00000006, 0x000004bc, 0x00000001, 0x0000001f,
    0x000004b8, 0x00050088, 0x00000006, 0x00000476, 0x00000093, 0x000004bc, 0x000500be, 0x00000078,
    0x00000478, 0x000004b8, 0x00000093, 0x000600a9, 0x00000006, 0x00000479, 0x00000478, 0x00000093,
    0x00000092, 0x000500bc, 0x00000078, 0x0000047b, 0x0000049f, 0x0000012a, 0x000600a9, 0x00000006,
    0x0000047d, 0x0000047b, 0x00000479, 0x00000092, 0x00050085, 0x00000006, 0x000004c5, 0x00000467,
    0x00000476, 0x00050085, 0x00000006, 0x000004cd, 0x0000046f, 0x00000476, 0x000500ba, 0x00000078,
    0x000004de, 0x0000047d, 0x00000092, 0x000600a9, 0x00000006, 0x00000780, 0x000004de, 0x000004c5,
    0x00000092, 0x000600a9, 0x00000006, 0x00000781, 0x000004de, 0x000004cd, 0x00000093, 0x00050085,
    0x00000006, 0x000003e9, 0x000002ab, 0x0000077b, 0x00050083, 0x00000006, 0x000003ec, 0x00000093,
    0x0000036e, 0x00050081, 0x00000006, 0x000003ef, 0x00000093, 0x00000781, 0x0004007f, 0x00000006,
    0x0000077c, 0x00000781, 0x0008000c, 0x00000006, 0x000003f3, 0x00000001, 0x00000032, 0x000003ec,
    0x000003ef, 0x0000077c, 0x00050083, 0x00000006, 0x000003f5, 0x00000093, 0x000003f3, 0x00050081,
    0x00000006, 0x000003f7, 0x00000093, 0x000003f3, 0x00050085, 0x00000006, 0x000003f8, 0x000003f5,
    0x000003f7, 0x000500ba, 0x00000078, 0x00000506, 0x000003f8, 0x00000092, 0x000600a9, 0x00000006,
    0x00000509, 0x00000506, 0x000003f8, 0x00000092, 0x0006000c, 0x00000006, 0x0000050d, 0x00000001,
    0x0000001f, 0x00000509, 0x0006000c, 0x00000006, 0x00000511, 0x00000001, 0x0000000e, 0x000003e9,
    0x0008000c, 0x00000006, 0x00000401, 0x00000001, 0x00000032, 0x0000050d, 0x00000511, 0x00000780,
    0x0006000c, 0x00000006, 0x00000515, 0x00000001, 0x0000000d, 0x000003e9, 0x00050085, 0x00000006,
    0x00000405, 0x0000050d, 0x00000515, 0x00050081, 0x00000006, 0x0000040c, 0x000003f3, 0x00000781,
    0x00050085, 0x00000006, 0x00000411, 0x00000423, 0x00000401, 0x00050085, 0x00000006, 0x00000415,
    0x00000423, 0x00000405, 0x000500ba, 0x00000078, 0x00000520, 0x0000040c, 0x00000092, 0x000600a9,
    0x00000006, 0x00000523, 0x00000520, 0x0000040c, 0x00000092, 0x0006000c, 0x00000006, 0x00000571,
    0x00000001, 0x00000004, 0x00000411, 0x0006000c, 0x00000006, 0x00000575, 0x00000001, 0x00000004,
    0x00000415, 0x000500ba, 0x00000078, 0x0000057a, 0x00000571, 0x00000575, 0x000600a9, 0x00000006,
    0x0000057d, 0x0000057a, 0x00000571, 0x00000575, 0x0006000c, 0x00000006, 0x00000581, 0x00000001,
    0x00000004, 0x00000523, 0x000500ba, 0x00000078, 0x00000586, 0x0000057d, 0x00000581, 0x000600a9,
    0x00000006, 0x00000589, 0x00000586, 0x0000057d, 0x00000581, 0x00050088, 0x00000006, 0x00000551,
    0x00000411, 0x00000589, 0x00050088, 0x00000006, 0x00000555, 0x00000415, 0x00000589, 0x00050088,
    0x00000006, 0x00000559, 0x00000523, 0x00000589, 0x00050085, 0x00000006, 0x0000059b, 0x00000555,
    0x00000555, 0x0008000c, 0x00000006, 0x0000059c, 0x00000001, 0x00000032, 0x00000551, 0x00000551,
    0x0000059b, 0x0008000c, 0x00000006, 0x000005a2, 0x00000001, 0x00000032, 0x00000559, 0x00000559,
    0x0000059c, 0x0006000c, 0x00000006, 0x000005a6, 0x00000001, 0x0000001f, 0x000005a2, 0x00050088,
    0x00000006, 0x00000560, 0x00000093, 0x000005a6, 0x000500be, 0x00000078, 0x00000562, 0x000005a2,
    0x00000093, 0x000600a9, 0x00000006, 0x00000563, 0x00000562, 0x00000093, 0x00000092, 0x000500bc,
    0x00000078, 0x00000565, 0x00000589, 0x0000012a, 0x000600a9, 0x00000006, 0x00000567, 0x00000565,
    0x00000563, 0x00000092, 0x00050085, 0x00000006, 0x000005af, 0x00000551, 0x00000560, 0x00050085,
    0x00000006, 0x000005b7, 0x00000559, 0x00000560, 0x000500ba, 0x00000078, 0x000005c8, 0x00000567,
    0x00000092, 0x000600a9, 0x00000006, 0x00000782, 0x000005c8, 0x000005af, 0x00000092, 0x000600a9,
    0x00000006, 0x00000783, 0x000005c8, 0x000005b7, 0x00000093, 0x00050085, 0x00000006, 0x000005fd,
    0x00000294, 0x00000783, 0x0008000c, 0x00000006, 0x000005fe, 0x00000001, 0x00000032, 0x000002f9,
    0x00000782, 0x000005fd, 0x000500ba, 0x00000078, 0x00000615, 0x000005fe, 0x00000092, 0x000600a9,
    0x00000006, 0x00000618, 0x00000615, 0x000005fe, 0x00000092, 0x000500b8, 0x00000078, 0x0000061d,
    0x00000618, 0x00000093, 0x000600a9, 0x00000006, 0x00000620, 0x0000061d, 0x00000618, 0x00000093,
    0x00050085, 0x00000006, 0x0000037f, 0x00000246, 0x00000620, 0x0004007f, 0x00000006, 0x0000077d,
    0x00000294, 0x0008000c, 0x00000006, 0x00000385, 0x00000001, 0x00000032, 0x0000037f, 0x00000783,
    0x0000077d, 0x000500ba, 0x00000078, 0x00000637, 0x00000385, 0x00000092, 0x000600a9, 0x00000006,
    0x0000063a, 0x00000637, 0x00000385, 0x00000092, 0x000500b8, 0x00000078, 0x0000063f, 0x0000063a,
    0x00000093, 0x000600a9, 0x00000006, 0x00000642, 0x0000063f, 0x0000063a, 0x00000093, 0x00050085,
    0x00000006, 0x0000064f, 0x00000423, 0x00000423, 0x0004007f, 0x00000006, 0x0000077e, 0x00000423,
    0x0008000c, 0x00000006, 0x00000669, 0x00000001, 0x00000032, 0x0000077e, 0x00000423, 0x00000093,
    0x0008000c, 0x00000006, 0x0000066c, 0x00000001, 0x00000032, 0x00000354, 0x00000669, 0x0000064f,
    0x0006000c, 0x00000006, 0x00000681, 0x00000001, 0x0000001f, 0x0000066c, 0x00050085, 0x00000006,
    0x00000672, 0x00000642, 0x00000642, 0x0008000c, 0x00000006, 0x00000677, 0x00000001, 0x00000032,
    0x00000672, 0x00000669, 0x0000064f, 0x0006000c, 0x00000006, 0x00000685, 0x00000001, 0x0000001f,
    0x00000677, 0x00050085, 0x00000006, 0x00000679, 0x00000294, 0x00000685, 0x0008000c, 0x00000006,
    0x0000067c, 0x00000001, 0x00000032, 0x00000642, 0x00000681, 0x00000679, 0x000500ba, 0x00000078,
    0x0000068a, 0x0000067c, 0x00000173, 0x000600a9, 0x00000006, 0x0000068d, 0x0000068a, 0x0000067c,
    0x00000173, 0x00050088, 0x00000006, 0x0000038c, 0x00000093, 0x0000068d, 0x00050085, 0x00000006,
    0x0000038e, 0x0000038c, 0x00000642, 0x00050085, 0x00000006, 0x00000390, 0x0000038e, 0x0000035f,
    0x00050085, 0x00000006, 0x00000393, 0x00000372, 0x00000390, 0x00050083, 0x00000006, 0x00000694,
    0x00000093, 0x00000620, 0x000500ba, 0x00000078, 0x000006b4, 0x00000694, 0x00000092, 0x000600a9,
    0x00000006, 0x000006b7, 0x000006b4, 0x00000694, 0x00000092, 0x000500b8, 0x00000078, 0x000006bc,
    0x000006b7, 0x00000093, 0x000600a9, 0x00000006, 0x000006bf, 0x000006bc, 0x000006b7, 0x00000093,
    0x00050085, 0x00000006, 0x00000698, 0x000006bf, 0x000006bf, 0x00050085, 0x00000006, 0x0000069b,
    0x00000698, 0x00000698, 0x00050085, 0x00000006, 0x0000069d, 0x0000069b, 0x000006bf, 0x00050050,
    0x00000057, 0x00000396, 0x00000093, 0x0000069d, 0x0005008e, 0x00000057, 0x00000397, 0x00000396,
    0x00000393, 0x00050081, 0x00000057, 0x00000399, 0x0000074b, 0x00000397, 0x00050080, 0x00000211,
    0x0000039c, 0x0000074a, 0x0000026a, 0x000200f9, 0x00000360, 0x000200f8, 0x0000039d, 0x00050085,
    0x00000057, 0x000003a0, 0x0000074b, 0x00000774, 0x00050041, 0x000002b4, 0x000002b5, 0x000002a7,
    0x00000278, 0x0003003e, 0x000002b5, 0x000003a0, 0x000200f9, 0x000002b8, 0x000200f8, 0x000002b8,
    0x000700f5, 0x000000a6, 0x0000074c, 0x000002b7, 0x0000039d, 0x000002d0, 0x000002bb, 0x000500ac,
    0x00000078, 0x000002be, 0x0000074c, 0x000000a7, 0x000400f6, 0x000002ba, 0x000002bb, 0x00000000,
    0x000400fa, 0x000002be, 0x000002b9, 0x000002ba, 0x000200f8, 0x000002b9, 0x000400e0, 0x000000b1,
    0x000000b1, 0x000002bf, 0x000500b0, 0x00000078, 0x000002c2, 0x00000278, 0x0000074c, 0x000300f7,
    0x000002c4, 0x00000000, 0x000400fa, 0x000002c2, 0x000002c3, 0x000002c4, 0x000200f8, 0x000002c3,
    0x00050080, 0x000000a6, 0x000002c8, 0x00000278, 0x0000074c, 0x00050041, 0x000002b4, 0x000002c9,
    0x000002a7, 0x000002c8, 0x0004003d, 0x00000057, 0x000002ca, 0x000002c9, 0x0004003d, 0x00000057,
    0x000002cc, 0x000002b5, 0x00050081, 0x00000057, 0x000002cd, 0x000002cc, 0x000002ca, 0x0003003e,
    0x000002b5, 0x000002cd, 0x000200f9, 0x000002c4, 0x000200f8, 0x000002c4, 0x000200f9, 0x000002bb,
    0x000200f8, 0x000002bb, 0x000500c2, 0x000000a6, 0x000002d0, 0x0000074c, 0x0000026a, 0x000200f9,
    0x000002b8, 0x000200f8, 0x000002ba, 0x000500aa, 0x00000078, 0x000002d2, 0x00000278, 0x000000a7,
    0x000300f7, 0x000002d4, 0x00000000, 0x000400fa, 0x000002d2, 0x000002d3, 0x000002d4, 0x000200f8,
    0x000002d3, 0x00050041, 0x000002b4, 0x000002d6, 0x000002a7, 0x00000214, 0x0004003d, 0x00000057,
    0x000002d7, 0x000002d6, 0x00050085, 0x00000057, 0x000002da, 0x000002d7, 0x00000776, 0x00050051,
    0x00000006, 0x000002dd, 0x000002da, 0x00000000, 0x000500ba, 0x00000078, 0x000006d6, 0x000002dd,
    0x00000092, 0x000600a9, 0x00000006, 0x000006d9, 0x000006d6, 0x000002dd, 0x00000092, 0x000500b8,
    0x00000078, 0x000006de, 0x000006d9, 0x00000093, 0x000600a9, 0x00000006, 0x000006e1, 0x000006de,
    0x000006d9, 0x00000093, 0x00050051, 0x00000006, 0x000002e2, 0x000002da, 0x00000001, 0x000500ba,
    0x00000078, 0x000006f1, 0x000002e2, 0x00000092, 0x000600a9, 0x00000006, 0x000006f4, 0x000006f1,
    0x000002e2, 0x00000092, 0x000500b8, 0x00000078, 0x000006f9, 0x000006f4, 0x000006e1, 0x000600a9,
    0x00000006, 0x000006fc, 0x000006f9, 0x000006f4, 0x000006e1, 0x0004003d, 0x000002e9, 0x000002ec,
    0x000002eb, 0x0004007c, 0x000002ee, 0x000002ef, 0x0000027e, 0x00070050, 0x000002f1, 0x000002f4,
    0x000006e1, 0x000006fc, 0x00000092, 0x00000092, 0x00040063, 0x000002ec, 0x000002ef, 0x000002f4,
    0x000200f9, 0x000002d4, 0x000200f8, 0x000002d4, 0x000100fd, 0x00010038,
};
/* clang-format on */
/* >>end of spirv */

static hdrp_i_gpu_vk_shader hdrp_i_gpu_vk_shader_of(uint32_t pass)
{
    hdrp_i_gpu_vk_shader s;
    memset(&s, 0, sizeof s);
    switch (pass) {
    case 0u:
        s.name = "hdrp fgd";
        s.words = hdrp_i_gpu_vk_spirv_fgd;
        s.bytes = sizeof hdrp_i_gpu_vk_spirv_fgd;
        s.bindings = 1u;
        s.types[0] = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        s.push_bytes = (uint32_t)sizeof(hdrp_i_gpu_vk_push_fgd);
        break;
    default:
        s.name = "hdrp depth";
        s.words = hdrp_i_gpu_vk_spirv_depth;
        s.bytes = sizeof hdrp_i_gpu_vk_spirv_depth;
        s.bindings = 2u;
        s.types[0] = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        s.types[1] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        s.push_bytes = (uint32_t)sizeof(hdrp_i_gpu_vk_push_depth);
        break;
    }
    return s;
}

#ifdef __cplusplus
}
#endif

#endif /* HDRP_GPU_VK_IMPLEMENTATION */
