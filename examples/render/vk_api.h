/* The functions of Vulkan, found at run time: a program that never asks for them starts without the
 * loader. */
#ifndef RD_VK_API_H
#define RD_VK_API_H

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan_core.h>

#include <stdbool.h>

#define RD_VK_GLOBAL_FUNCTIONS(X)                                                                  \
    X(CreateInstance)                                                                              \
    X(EnumerateInstanceLayerProperties)

#define RD_VK_INSTANCE_FUNCTIONS(X)                                                                \
    X(CreateDevice)                                                                                \
    X(DestroyInstance)                                                                             \
    X(EnumeratePhysicalDevices)                                                                    \
    X(GetDeviceProcAddr)                                                                           \
    X(GetPhysicalDeviceFeatures)                                                                   \
    X(GetPhysicalDeviceFormatProperties)                                                           \
    X(GetPhysicalDeviceMemoryProperties)                                                           \
    X(GetPhysicalDeviceProperties)                                                                 \
    X(GetPhysicalDeviceQueueFamilyProperties)

#define RD_VK_DEVICE_FUNCTIONS(X)                                                                  \
    X(AllocateCommandBuffers)                                                                      \
    X(AllocateDescriptorSets)                                                                      \
    X(AllocateMemory)                                                                              \
    X(BeginCommandBuffer)                                                                          \
    X(BindImageMemory)                                                                             \
    X(CmdBeginRenderPass)                                                                          \
    X(CmdBindDescriptorSets)                                                                       \
    X(CmdBindPipeline)                                                                             \
    X(CmdBlitImage)                                                                                \
    X(CmdClearAttachments)                                                                         \
    X(CmdClearColorImage)                                                                          \
    X(CmdCopyBuffer)                                                                               \
    X(CmdCopyBufferToImage)                                                                        \
    X(CmdCopyImage)                                                                                \
    X(CmdCopyImageToBuffer)                                                                        \
    X(CmdDraw)                                                                                     \
    X(CmdEndRenderPass)                                                                            \
    X(CmdPipelineBarrier)                                                                          \
    X(CmdPushConstants)                                                                            \
    X(CmdResetQueryPool)                                                                           \
    X(CmdSetScissor)                                                                               \
    X(CmdSetViewport)                                                                              \
    X(CmdWriteTimestamp)                                                                           \
    X(CreateCommandPool)                                                                           \
    X(CreateDescriptorPool)                                                                        \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreateFramebuffer)                                                                           \
    X(CreateGraphicsPipelines)                                                                     \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(CreatePipelineLayout)                                                                        \
    X(CreateQueryPool)                                                                             \
    X(CreateRenderPass)                                                                            \
    X(CreateSampler)                                                                               \
    X(CreateShaderModule)                                                                          \
    X(DestroyCommandPool)                                                                          \
    X(DestroyDescriptorPool)                                                                       \
    X(DestroyDescriptorSetLayout)                                                                  \
    X(DestroyDevice)                                                                               \
    X(DestroyFramebuffer)                                                                          \
    X(DestroyImage)                                                                                \
    X(DestroyImageView)                                                                            \
    X(DestroyPipeline)                                                                             \
    X(DestroyPipelineLayout)                                                                       \
    X(DestroyQueryPool)                                                                            \
    X(DestroyRenderPass)                                                                           \
    X(DestroySampler)                                                                              \
    X(DestroyShaderModule)                                                                         \
    X(DeviceWaitIdle)                                                                              \
    X(EndCommandBuffer)                                                                            \
    X(FreeMemory)                                                                                  \
    X(GetDeviceQueue)                                                                              \
    X(GetImageMemoryRequirements)                                                                  \
    X(GetQueryPoolResults)                                                                         \
    X(MapMemory)                                                                                   \
    X(QueueSubmit)                                                                                 \
    X(QueueWaitIdle)                                                                               \
    X(UnmapMemory)                                                                                 \
    X(UpdateDescriptorSets)

#define RD_VK_DECLARE(name) extern PFN_vk##name vk##name;
RD_VK_GLOBAL_FUNCTIONS(RD_VK_DECLARE)
RD_VK_INSTANCE_FUNCTIONS(RD_VK_DECLARE)
RD_VK_DEVICE_FUNCTIONS(RD_VK_DECLARE)
#undef RD_VK_DECLARE
extern PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr;

/* False where there is no loader. */
bool rd_vk_load(void);
void rd_vk_load_instance(VkInstance instance);
void rd_vk_load_device(VkDevice device);

#endif
