#include "vk_device.h"

#include <string.h>

/* >>buffers */

#define HOST (VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)

bool rd_vk_mapped_make(rd_vk_device* d, size_t bytes, VkBufferUsageFlags usage, rd_vk_mapped* out)
{
    memset(out, 0, sizeof *out);
    return rd_vk_check_hdrp(
               d, hdrp_gpu_vk_buffer_create(&d->gpu, bytes, usage, HOST, NULL, &out->buffer),
               "a buffer") &&
           rd_vk_check(d,
                       vkMapMemory(d->device, out->buffer.block.memory, out->buffer.block.offset,
                                   bytes, 0, &out->at),
                       "a buffer");
}

void rd_vk_mapped_free(rd_vk_device* d, rd_vk_mapped* m)
{
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &m->buffer); /* freeing memory unmaps it */
    m->at = NULL;
}

bool rd_vk_buffer_fill(rd_vk_device* d, const void* data, size_t bytes, hdrp_gpu_vk_buffer* out)
{
    const size_t least = 256;
    size_t size = bytes > least ? bytes : least;
    const VkBufferCopy whole = {0, 0, size};
    rd_vk_mapped staging;
    bool ok;
    if (bytes > d->properties.limits.maxStorageBufferRange) {
        return rd_fail(d->report, d->properties.deviceName, "cannot read a buffer of %zu bytes",
                       bytes);
    }
    ok = rd_vk_mapped_make(d, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, &staging) &&
         rd_vk_check_hdrp(d,
                          hdrp_gpu_vk_buffer_create(&d->gpu, size,
                                                    VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                                    VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, NULL, out),
                          "a buffer");
    if (ok) {
        memset(staging.at, 0, size);
        memcpy(staging.at, data, bytes);
        ok = rd_vk_begin(d);
    }
    if (ok) {
        vkCmdCopyBuffer(d->commands, staging.buffer.buffer, out->buffer, 1, &whole);
        ok = rd_vk_run(d);
    }
    rd_vk_mapped_free(d, &staging);
    return ok;
}

/* >>images */

static uint32_t device_memory_type(const rd_vk_device* d, uint32_t bits)
{
    const VkPhysicalDeviceMemoryProperties* m = &d->gpu.memory_types;
    uint32_t any = 0;
    for (uint32_t i = 0; i < m->memoryTypeCount; ++i) {
        if (bits >> i & 1u) {
            any = i;
            if (m->memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) {
                break;
            }
        }
    }
    return any;
}

static VkResult place(rd_vk_device* d, rd_vk_image* image)
{
    VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    VkMemoryAllocateInfo allocation = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    VkMemoryRequirements needs;
    VkResult r;
    vkGetImageMemoryRequirements(d->device, image->base.image, &needs);
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = device_memory_type(d, needs.memoryTypeBits);
    r = vkAllocateMemory(d->device, &allocation, NULL, &image->base.block.memory);
    if (r != VK_SUCCESS) {
        return r;
    }
    r = vkBindImageMemory(d->device, image->base.image, image->base.block.memory, 0);
    if (r != VK_SUCCESS) {
        return r;
    }
    view.image = image->base.image;
    view.viewType = image->layers == 6u ? VK_IMAGE_VIEW_TYPE_CUBE : VK_IMAGE_VIEW_TYPE_2D;
    view.format = image->base.format;
    view.subresourceRange.aspectMask = image->aspect;
    view.subresourceRange.levelCount = image->levels;
    view.subresourceRange.layerCount = image->layers;
    return vkCreateImageView(d->device, &view, NULL, &image->base.view);
}

bool rd_vk_image_make(rd_vk_device* d, const rd_vk_image_desc* desc, rd_vk_image* image)
{
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .samples = VK_SAMPLE_COUNT_1_BIT};
    VkResult r;
    memset(image, 0, sizeof *image);
    if (desc->width > d->properties.limits.maxImageDimension2D ||
        desc->height > d->properties.limits.maxImageDimension2D) {
        return rd_fail(d->report, d->properties.deviceName, "has no images of %u x %u", desc->width,
                       desc->height);
    }
    image->base.format = info.format = desc->format;
    image->base.width_px = info.extent.width = desc->width;
    image->base.height_px = info.extent.height = desc->height;
    image->levels = info.mipLevels = desc->levels;
    image->layers = info.arrayLayers = desc->layers;
    image->aspect = desc->aspect ? desc->aspect : (VkImageAspectFlags)VK_IMAGE_ASPECT_COLOR_BIT;
    info.extent.depth = 1;
    info.usage = desc->usage;
    info.flags = desc->layers == 6u ? (VkImageCreateFlags)VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0u;
    r = vkCreateImage(d->device, &info, NULL, &image->base.image);
    if (r == VK_SUCCESS) {
        r = place(d, image);
    }
    return rd_vk_check(d, r, "an image");
}

void rd_vk_image_free(rd_vk_device* d, rd_vk_image* image)
{
    if (image->base.image) {
        vkDestroyImageView(d->device, image->base.view, NULL);
        vkDestroyImage(d->device, image->base.image, NULL);
        vkFreeMemory(d->device, image->base.block.memory, NULL);
    }
    memset(image, 0, sizeof *image);
}

void rd_vk_layout(rd_vk_device* d, const rd_vk_image* image, VkImageLayout before,
                  VkImageLayout after)
{
    VkImageMemoryBarrier b = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                              .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                              .dstAccessMask =
                                  VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                              .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                              .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED};
    b.oldLayout = before;
    b.newLayout = after;
    b.image = image->base.image;
    b.subresourceRange.aspectMask = image->aspect;
    b.subresourceRange.levelCount = image->levels;
    b.subresourceRange.layerCount = image->layers;
    vkCmdPipelineBarrier(d->commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 1, &b);
}

static void copy_levels(rd_vk_device* d, const rd_vk_image* image, VkBuffer from,
                        const size_t* offsets)
{
    for (uint32_t i = 0; i < image->levels; ++i) {
        VkBufferImageCopy c;
        memset(&c, 0, sizeof c);
        c.bufferOffset = offsets[i];
        c.imageSubresource.aspectMask = image->aspect;
        c.imageSubresource.mipLevel = i;
        c.imageSubresource.layerCount = image->layers;
        c.imageExtent.width = image->base.width_px >> i ? image->base.width_px >> i : 1u;
        c.imageExtent.height = image->base.height_px >> i ? image->base.height_px >> i : 1u;
        c.imageExtent.depth = 1;
        vkCmdCopyBufferToImage(d->commands, from, image->base.image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &c);
    }
}

bool rd_vk_image_fill(rd_vk_device* d, rd_vk_image* image, const void* texels, size_t bytes,
                      const size_t* offsets)
{
    rd_vk_mapped staging;
    bool ok = rd_vk_mapped_make(d, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, &staging);
    if (ok) {
        memcpy(staging.at, texels, bytes);
        ok = rd_vk_begin(d);
    }
    if (ok) {
        rd_vk_layout(d, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        copy_levels(d, image, staging.buffer.buffer, offsets);
        rd_vk_layout(d, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        ok = rd_vk_run(d);
    }
    rd_vk_mapped_free(d, &staging);
    return ok;
}

bool rd_vk_sampler_make(rd_vk_device* d, VkFilter magnification, VkSamplerAddressMode u,
                        VkSamplerAddressMode v, VkSampler* out)
{
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .maxLod = VK_LOD_CLAMP_NONE};
    info.magFilter = magnification;
    info.addressModeU = u;
    info.addressModeV = v;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    return rd_vk_check(d, vkCreateSampler(d->device, &info, NULL, out), "a sampler");
}
