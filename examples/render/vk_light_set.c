/* The set of descriptors that shaders light surfaces with. */
#include "vk_light.h"

#include <string.h>

static bool is_buffer(uint32_t binding)
{
    return binding <= RD_VK_BIND_MASKS || binding == RD_VK_BIND_VIEWS ||
           binding >= RD_VK_BIND_BLOCKERS;
}

static VkDescriptorType type_of(uint32_t binding)
{
    if (binding == RD_VK_BIND_PARAMS) {
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    }
    if (is_buffer(binding)) {
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }
    return binding == RD_VK_BIND_SUN_MASK || binding == RD_VK_BIND_KINDS ||
                   binding == RD_VK_BIND_DEPTH || binding == RD_VK_BIND_ATLAS ||
                   binding >= RD_VK_BIND_LAYERS
               ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
               : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

bool rd_vk_light_layout_make(rd_vk_light* l, rd_vk_device* d)
{
    VkDescriptorSetLayoutBinding bindings[RD_VK_BIND_COUNT];
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = RD_VK_BIND_COUNT,
                                            .pBindings = bindings};
    memset(bindings, 0, sizeof bindings);
    for (uint32_t i = 0; i < RD_VK_BIND_COUNT; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = type_of(i);
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    }
    return rd_vk_check(d, vkCreateDescriptorSetLayout(d->device, &info, NULL, &l->layout),
                       "a layout of descriptors");
}

bool rd_vk_light_sets_make(rd_vk_light* l, rd_vk_device* d)
{
    const VkDescriptorPoolSize sizes[4] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2},
                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 20},
                                           {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 18},
                                           {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 14}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 2,
                                             .poolSizeCount = 4,
                                             .pPoolSizes = sizes};
    const VkDescriptorSetLayout layouts[2] = {l->layout, l->layout};
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorSetCount = 2,
                                        .pSetLayouts = layouts};
    if (!rd_vk_check(d, vkCreateDescriptorPool(d->device, &pool, NULL, &l->pool), "descriptors")) {
        return false;
    }
    info.descriptorPool = l->pool;
    return rd_vk_check(d, vkAllocateDescriptorSets(d->device, &info, l->sets), "descriptors");
}

static VkDescriptorImageInfo image_info(const rd_vk_light* l, const rd_vk_raster* raster,
                                        uint32_t binding)
{
    const rd_vk_image* image = NULL;
    VkDescriptorImageInfo info = {binding == RD_VK_BIND_SKY ? l->around : l->clamped,
                                  l->black.base.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    bool is_cube = binding == RD_VK_BIND_SPECULAR || binding == RD_VK_BIND_IRRADIANCE ||
                   binding == RD_VK_BIND_SKY_CUBE;
    image = binding == RD_VK_BIND_SPECULAR     ? &l->specular
            : binding == RD_VK_BIND_IRRADIANCE ? &l->irradiance
            : binding == RD_VK_BIND_SKY        ? &l->sky
            : binding == RD_VK_BIND_SKY_CUBE   ? &l->sky_cube
            : binding == RD_VK_BIND_BEHIND     ? &l->behind
            : binding == RD_VK_BIND_ATLAS      ? &l->shadow.atlas
            : binding >= RD_VK_BIND_LAYERS
                ? &raster->targets[RD_VK_LAYER_LIGHT + binding - RD_VK_BIND_LAYERS]
            : binding == RD_VK_BIND_KINDS ? &raster->targets[RD_VK_KINDS]
            : binding == RD_VK_BIND_DEPTH ? &l->behind_depth
                                          : NULL;
    if (is_cube) {
        info.imageView = l->black_cube.base.view;
    }
    if (binding == RD_VK_BIND_FGD && l->fgd.view) {
        info.imageView = l->fgd.view;
    } else if (binding == RD_VK_BIND_SUN_MASK && l->shadow.visibility.view) {
        info.imageView = l->shadow.visibility.view;
    } else if (image && image->base.view) {
        info.imageView = image->base.view;
    }
    return info;
}

/* In the order of shaders/light_blockers.glsl. */
static hdrp_gpu_vk_array blocker_array(const rd_vk_light* l, int which, uint32_t index)
{
    const hdrp_gpu_vk_blockers* b = &l->blockers[which];
    const hdrp_gpu_vk_array arrays[4] = {b->masks, b->lights, b->links, b->blockers};
    return arrays[index];
}

static VkDescriptorBufferInfo buffer_info(const rd_vk_light* l, int which, uint32_t binding)
{
    const rd_vk_grid* g = &l->grids[which];
    const hdrp_gpu_vk_range records = {l->lists.records.buffer, 0};
    const hdrp_gpu_vk_range views = {
        l->shadow.present ? l->shadow.buffer.buffer.buffer : l->nothing.buffer, 0};
    const hdrp_gpu_vk_range params = {l->params[which].buffer.buffer, 0};
    const hdrp_gpu_vk_range ranges[6] = {params, records, g->tiles, g->cells, g->entries, g->masks};
    VkDescriptorBufferInfo info = {l->nothing.buffer, 0, VK_WHOLE_SIZE};
    if (binding >= RD_VK_BIND_BLOCKERS) {
        hdrp_gpu_vk_array a = blocker_array(l, which, binding - RD_VK_BIND_BLOCKERS);
        info.buffer = a.buffer ? a.buffer : info.buffer;
    } else {
        const hdrp_gpu_vk_range* at = binding == RD_VK_BIND_VIEWS ? &views : &ranges[binding];
        info.buffer = at->buffer;
        info.offset = at->offset;
    }
    return info;
}

void rd_vk_light_set_write(const rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster,
                           int which)
{
    for (uint32_t i = 0; i < RD_VK_BIND_COUNT; ++i) {
        VkDescriptorImageInfo image;
        VkDescriptorBufferInfo buffer;
        VkWriteDescriptorSet write = {
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, .dstBinding = i, .descriptorCount = 1};
        write.dstSet = l->sets[which];
        write.descriptorType = type_of(i);
        if (is_buffer(i)) {
            buffer = buffer_info(l, which, i);
            write.pBufferInfo = &buffer;
        } else {
            image = image_info(l, raster, i);
            write.pImageInfo = &image;
        }
        vkUpdateDescriptorSets(d->device, 1, &write, 0, NULL);
    }
}
