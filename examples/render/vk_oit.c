#include "vk_oit.h"

#include <string.h>

uint32_t rd_vk_oit_pass_first(const rd_vk_oit* o, uint32_t pass)
{
    uint32_t i = 0;
    while (i < o->target_count && o->targets[i].pass < pass) {
        ++i;
    }
    return i;
}

/* >>targets */

static bool is_possible(const rd_vk_oit* o, rd_vk_device* d, rd_oit oit)
{
    hdrp_gpu_vk_desc desc = d->gpu.desc;
    const char* lacks;
    desc.features = &d->features;
    lacks = hdrp_gpu_vk_oit_missing(&desc, o->targets, o->target_count, 0);
    return !lacks || rd_fail(d->report, "--oit", "%s: %s lacks %s", rd_oit_name(oit),
                             d->properties.deviceName, lacks);
}

static bool make_targets(rd_vk_oit* o, rd_vk_device* d, rd_vk_oit_layer* l)
{
    bool ok = true;
    for (uint32_t i = 0; ok && i < o->target_count; ++i) {
        const rd_vk_image_desc desc = {hdrp_gpu_vk_oit_attachment_of(&o->targets[i]).format,
                                       l->width,
                                       l->height,
                                       1,
                                       1,
                                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                           VK_IMAGE_USAGE_SAMPLED_BIT,
                                       0};
        ok = rd_vk_image_make(d, &desc, &l->targets[i]);
    }
    return ok;
}

static bool make_low_depth(rd_vk_oit* o, rd_vk_device* d)
{
    const rd_vk_image_desc desc = {VK_FORMAT_D32_SFLOAT,
                                   o->layers[1].width,
                                   o->layers[1].height,
                                   1,
                                   1,
                                   VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                                   VK_IMAGE_ASPECT_DEPTH_BIT};
    return rd_vk_image_make(d, &desc, &o->low_depth);
}

/* >>passes */

/* With some of the targets; without, the depth alone is written. */
static bool make_pass(rd_vk_device* d, const hdrp_oit_target* targets, uint32_t count,
                      VkRenderPass* pass)
{
    VkAttachmentDescription attachments[HDRP_OIT_TARGETS_MAX + 1];
    for (uint32_t i = 0; i < count; ++i) {
        attachments[i] =
            rd_vk_attachment(hdrp_gpu_vk_oit_attachment_of(&targets[i]).format,
                             VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    attachments[count] = rd_vk_attachment(
        VK_FORMAT_D32_SFLOAT, count ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    return rd_vk_pass_make(d, attachments, count,
                           count ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                 : VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                           pass);
}

static bool make_framebuffer(rd_vk_device* d, const rd_vk_oit_layer* l, uint32_t first,
                             uint32_t count, const rd_vk_image* depth, VkRenderPass pass,
                             VkFramebuffer* framebuffer)
{
    VkImageView views[HDRP_OIT_TARGETS_MAX + 1];
    for (uint32_t i = 0; i < count; ++i) {
        views[i] = l->targets[first + i].base.view;
    }
    views[count] = depth->base.view;
    return rd_vk_framebuffer_make(d, pass, views, count + 1, l->width, l->height, framebuffer);
}

static bool make_passes(rd_vk_oit* o, rd_vk_device* d, const rd_vk_raster* raster)
{
    bool ok = true;
    for (uint32_t i = 0; ok && i < o->pass_count; ++i) {
        uint32_t first = rd_vk_oit_pass_first(o, i);
        uint32_t count = rd_vk_oit_pass_first(o, i + 1) - first;
        ok = make_pass(d, o->targets + first, count, &o->passes[i]);
        for (uint32_t k = 0; ok && k < o->layer_count; ++k) {
            rd_vk_oit_layer* l = &o->layers[k];
            const rd_vk_image* depth = k ? &o->low_depth : &raster->targets[RD_VK_DEPTH];
            ok = make_framebuffer(d, l, first, count, depth, o->passes[i], &l->framebuffers[i]);
        }
    }
    return ok && (o->layer_count < 2 || (make_pass(d, NULL, 0, &o->depth_pass) &&
                                         make_framebuffer(d, &o->layers[1], 0, 0, &o->low_depth,
                                                          o->depth_pass, &o->depth_framebuffer)));
}

/* >>descriptors */

bool rd_vk_oit_layout_make(rd_vk_oit* o, rd_vk_device* d)
{
    VkDescriptorSetLayoutBinding bindings[RD_VK_OIT_READ + 1];
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = RD_VK_OIT_READ + 1,
        .pBindings = bindings};
    memset(bindings, 0, sizeof bindings);
    for (uint32_t i = 0; i <= RD_VK_OIT_READ; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
    }
    return rd_vk_check(d, vkCreateDescriptorSetLayout(d->device, &info, NULL, &o->set_layout),
                       "a layout of descriptors");
}

static bool make_sets(rd_vk_oit* o, rd_vk_device* d)
{
    const uint32_t most = 2 * RD_VK_OIT_PASSES;
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                       most * (RD_VK_OIT_READ + 1)};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = most,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorSetCount = 1,
                                        .pSetLayouts = &o->set_layout};
    bool ok =
        rd_vk_check(d, vkCreateDescriptorPool(d->device, &pool, NULL, &o->pool), "descriptors");
    info.descriptorPool = o->pool;
    for (uint32_t i = 0; ok && i < o->layer_count * o->pass_count; ++i) {
        ok = rd_vk_check(
            d,
            vkAllocateDescriptorSets(d->device, &info,
                                     &o->layers[i / o->pass_count].sets[i % o->pass_count]),
            "descriptors");
    }
    return ok;
}

/* Targets of the passes before one of them, and for the low layer the depth of the picture; what
 * there is not is `nothing`. */
static void write_set(const rd_vk_oit* o, const rd_vk_device* d, uint32_t layer, uint32_t pass,
                      const rd_vk_image* depth, const rd_vk_image* nothing)
{
    const rd_vk_oit_layer* l = &o->layers[layer];
    uint32_t before = rd_vk_oit_pass_first(o, pass);
    for (uint32_t i = 0; i <= RD_VK_OIT_READ; ++i) {
        VkDescriptorImageInfo image = {VK_NULL_HANDLE, nothing->base.view,
                                       VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = l->sets[pass],
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                            .pImageInfo = &image};
        if (i < before && i < RD_VK_OIT_READ) {
            image.imageView = l->targets[i].base.view;
        } else if (i == RD_VK_OIT_READ && layer == 1) {
            image.imageView = depth->base.view;
            image.imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
        }
        vkUpdateDescriptorSets(d->device, 1, &write, 0, NULL);
    }
}

/* >>making */

static void free_mode(rd_vk_oit* o, rd_vk_device* d)
{
    VkDescriptorSetLayout layout = o->set_layout;
    for (uint32_t i = 0; i < 2; ++i) {
        for (uint32_t k = 0; k < HDRP_OIT_TARGETS_MAX; ++k) {
            rd_vk_image_free(d, &o->layers[i].targets[k]);
        }
        for (uint32_t k = 0; k < RD_VK_OIT_PASSES; ++k) {
            vkDestroyFramebuffer(d->device, o->layers[i].framebuffers[k], NULL);
        }
    }
    for (uint32_t k = 0; k < RD_VK_OIT_PASSES; ++k) {
        vkDestroyPipeline(d->device, o->pipelines[k], NULL);
        vkDestroyRenderPass(d->device, o->passes[k], NULL);
    }
    vkDestroyPipeline(d->device, o->depth_pipeline, NULL);
    vkDestroyFramebuffer(d->device, o->depth_framebuffer, NULL);
    vkDestroyRenderPass(d->device, o->depth_pass, NULL);
    rd_vk_image_free(d, &o->low_depth);
    vkDestroyDescriptorPool(d->device, o->pool, NULL);
    memset(o, 0, sizeof *o);
    o->set_layout = layout;
}

void rd_vk_oit_free(rd_vk_oit* o, rd_vk_device* d)
{
    free_mode(o, d);
    vkDestroyDescriptorSetLayout(d->device, o->set_layout, NULL);
    memset(o, 0, sizeof *o);
}

bool rd_vk_oit_make(rd_vk_oit* o, rd_vk_device* d, const rd_renderer* r, const rd_vk_raster* raster,
                    const rd_vk_image* nothing)
{
    bool ok;
    free_mode(o, d);
    o->made_for = r->options->oit;
    if (r->options->oit == RD_OIT_SORTED) {
        return true;
    }
    o->mode = rd_oit_mode(r->options->oit);
    o->pass_count = hdrp_oit_pass_count(o->mode);
    o->target_count = hdrp_oit_describe_targets(o->mode, HDRP_OIT_PRECISION_NATIVE, o->targets);
    o->layer_count = rd_oit_has_low(r->options, r->scene) ? 2 : 1;
    o->layers[0].width = raster->width;
    o->layers[0].height = raster->height;
    o->layers[1].width = (raster->width + 1) / 2;
    o->layers[1].height = (raster->height + 1) / 2;
    ok = is_possible(o, d, r->options->oit) && (o->layer_count < 2 || make_low_depth(o, d));
    for (uint32_t i = 0; ok && i < o->layer_count; ++i) {
        ok = make_targets(o, d, &o->layers[i]);
    }
    ok = ok && make_passes(o, d, raster) && make_sets(o, d);
    for (uint32_t i = 0; ok && i < o->layer_count * o->pass_count; ++i) {
        write_set(o, d, i / o->pass_count, i % o->pass_count, &raster->targets[RD_VK_DEPTH],
                  nothing);
    }
    o->present = ok;
    return ok;
}

/* >>recording */

static void begin(rd_vk_device* d, VkRenderPass pass, VkFramebuffer framebuffer,
                  const rd_vk_oit_layer* l, const VkClearValue* clears, uint32_t count)
{
    const VkViewport viewport = {0.0f, 0.0f, (float)l->width, (float)l->height, 0.0f, 1.0f};
    const VkRenderPassBeginInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = pass,
                                        .framebuffer = framebuffer,
                                        .renderArea = {{0, 0}, {l->width, l->height}},
                                        .clearValueCount = count,
                                        .pClearValues = clears};
    vkCmdBeginRenderPass(d->commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdSetViewport(d->commands, 0, 1, &viewport);
    vkCmdSetScissor(d->commands, 0, 1, &info.renderArea);
}

void rd_vk_oit_pass_begin(const rd_vk_oit* o, rd_vk_device* d, uint32_t layer, uint32_t pass)
{
    const rd_vk_oit_layer* l = &o->layers[layer];
    uint32_t first = rd_vk_oit_pass_first(o, pass);
    uint32_t count = rd_vk_oit_pass_first(o, pass + 1) - first;
    VkClearValue clears[HDRP_OIT_TARGETS_MAX];
    for (uint32_t i = 0; i < count; ++i) {
        clears[i] = hdrp_gpu_vk_oit_attachment_of(&o->targets[first + i]).clear;
    }
    begin(d, o->passes[pass], l->framebuffers[pass], l, clears, count);
}

void rd_vk_oit_depth_begin(const rd_vk_oit* o, rd_vk_device* d)
{
    begin(d, o->depth_pass, o->depth_framebuffer, &o->layers[1], NULL, 0);
}

static hdrp_gpu_vk_oit_layer views_of(const rd_vk_oit* o, const rd_vk_oit_layer* l)
{
    uint32_t first = rd_vk_oit_pass_first(o, o->pass_count - 1);
    hdrp_gpu_vk_oit_layer views;
    memset(&views, 0, sizeof views);
    views.width_px = l->width;
    views.height_px = l->height;
    for (uint32_t i = first; i < o->target_count; ++i) {
        views.targets[i - first] = l->targets[i].base.view;
    }
    return views;
}

bool rd_vk_oit_compose(const rd_vk_oit* o, rd_vk_device* d, const rd_vk_raster* raster)
{
    const rd_vk_image* lit = &raster->targets[RD_VK_LIT];
    hdrp_gpu_vk_oit_layer low = views_of(o, &o->layers[1]);
    hdrp_gpu_vk_oit oit;
    bool ok;
    memset(&oit, 0, sizeof oit);
    oit.mode = o->mode;
    oit.full = views_of(o, &o->layers[0]);
    oit.low = o->layer_count > 1 ? &low : NULL;
    oit.opaque = lit->base.view;
    oit.color = &lit->base;
    rd_vk_layout(d, lit, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    ok = rd_vk_check_hdrp(d, hdrp_gpu_vk_oit_composite(&d->gpu, d->commands, &oit), "composition");
    rd_vk_layout(d, lit, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    return ok;
}
