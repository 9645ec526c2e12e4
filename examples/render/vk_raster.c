#include "vk_raster.h"

#include <string.h>

#define CONSTANTS_MAX 8u

/* >>targets */

static const VkFormat formats[RD_VK_TARGET_COUNT] = {
    [RD_VK_RT0] = VK_FORMAT_R8G8B8A8_SRGB,
    [RD_VK_RT1] = VK_FORMAT_R8G8B8A8_UNORM,
    [RD_VK_RT2] = VK_FORMAT_R8G8B8A8_UNORM,
    [RD_VK_RT3] = VK_FORMAT_B10G11R11_UFLOAT_PACK32,
    [RD_VK_RT4] = VK_FORMAT_R8G8B8A8_UNORM,
    [RD_VK_KINDS] = VK_FORMAT_R8_UINT,
    [RD_VK_NORMALS] = VK_FORMAT_R16G16B16A16_SFLOAT,
    [RD_VK_LIT] = VK_FORMAT_R32G32B32A32_SFLOAT,
    [RD_VK_LAYER_LIGHT] = VK_FORMAT_R32G32B32A32_SFLOAT,
    [RD_VK_LAYER_THROUGH] = VK_FORMAT_R32G32B32A32_SFLOAT,
    [RD_VK_LAYER_MOVED] = VK_FORMAT_R32G32B32A32_SFLOAT,
    [RD_VK_LAYER_MOST] = VK_FORMAT_R32G32B32A32_SFLOAT,
    [RD_VK_LAYER_DIRECTION] = VK_FORMAT_R32G32B32A32_SFLOAT,
    [RD_VK_DEPTH] = VK_FORMAT_D32_SFLOAT,
};

/* Lavapipe's conversions from and to sRGB are off by up to a code: there the shader rounds RT0 to
 * codes, and the target keeps what they stand for. */
static VkFormat format_of(const rd_vk_device* d, int target)
{
    return target == RD_VK_RT0 && rd_vk_is_coarse(d) ? VK_FORMAT_R32G32B32A32_SFLOAT
                                                     : formats[target];
}

static bool make_targets(rd_vk_raster* r, rd_vk_device* d)
{
    bool ok = true;
    for (int i = 0; ok && i < RD_VK_TARGET_COUNT; ++i) {
        rd_vk_image_desc desc = {format_of(d, i),
                                 r->width,
                                 r->height,
                                 1,
                                 1,
                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                     VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                 VK_IMAGE_ASPECT_COLOR_BIT};
        if (i == RD_VK_LIT) {
            desc.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
        }
        if (i == RD_VK_DEPTH) {
            desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                         VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
            desc.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
        }
        ok = rd_vk_image_make(d, &desc, &r->targets[i]);
    }
    return ok;
}

/* >>render passes */

VkAttachmentDescription rd_vk_attachment(VkFormat format, VkAttachmentLoadOp load,
                                         VkImageLayout layout)
{
    VkAttachmentDescription a;
    memset(&a, 0, sizeof a);
    a.format = format;
    a.samples = VK_SAMPLE_COUNT_1_BIT;
    a.loadOp = load;
    a.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    a.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    a.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    a.initialLayout = load == VK_ATTACHMENT_LOAD_OP_LOAD ? layout : VK_IMAGE_LAYOUT_UNDEFINED;
    a.finalLayout = layout;
    return a;
}

/* Orders a pass after all that was recorded before, and what comes after it likewise. Passes are
 * compatible where this is the same too. */
static VkSubpassDependency dependency(uint32_t from, uint32_t to)
{
    VkSubpassDependency s;
    memset(&s, 0, sizeof s);
    s.srcSubpass = from;
    s.dstSubpass = to;
    s.srcStageMask = from == VK_SUBPASS_EXTERNAL ? VK_PIPELINE_STAGE_ALL_COMMANDS_BIT
                                                 : VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
    s.dstStageMask = to == VK_SUBPASS_EXTERNAL ? VK_PIPELINE_STAGE_ALL_COMMANDS_BIT
                                               : VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
    s.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    s.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    return s;
}

bool rd_vk_pass_make(rd_vk_device* d, const VkAttachmentDescription* attachments, uint32_t colors,
                     VkImageLayout depth, VkRenderPass* out)
{
    VkAttachmentReference references[RD_VK_COLORS_MAX];
    const VkAttachmentReference last = {colors, depth};
    const VkSubpassDependency dependencies[2] = {dependency(VK_SUBPASS_EXTERNAL, 0),
                                                 dependency(0, VK_SUBPASS_EXTERNAL)};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = colors,
                                          .pColorAttachments = references,
                                          .pDepthStencilAttachment = &last};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = colors + 1,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    for (uint32_t i = 0; i < colors; ++i) {
        references[i].attachment = i;
        references[i].layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    }
    return rd_vk_check(d, vkCreateRenderPass(d->device, &info, NULL, out), "a render pass");
}

bool rd_vk_framebuffer_make(rd_vk_device* d, VkRenderPass pass, const VkImageView* views,
                            uint32_t count, uint32_t width, uint32_t height, VkFramebuffer* out)
{
    const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                          .renderPass = pass,
                                          .attachmentCount = count,
                                          .pAttachments = views,
                                          .width = width,
                                          .height = height,
                                          .layers = 1};
    return rd_vk_check(d, vkCreateFramebuffer(d->device, &info, NULL, out), "a framebuffer");
}

/* The colour targets of a pass. */
static uint32_t colors_of(rd_vk_pass pass, rd_vk_target* out)
{
    uint32_t n = 0;
    if (pass == RD_VK_PASS_GBUFFER) {
        for (int i = RD_VK_RT0; i <= RD_VK_NORMALS; ++i) {
            out[n++] = (rd_vk_target)i;
        }
    } else if (pass == RD_VK_PASS_LIT) {
        out[n++] = RD_VK_LIT;
    } else if (pass == RD_VK_PASS_LAYERS) {
        out[n++] = RD_VK_LAYER_LIGHT;
    } else if (pass == RD_VK_PASS_BEHIND) {
        for (int i = RD_VK_LAYER_THROUGH; i <= RD_VK_LAYER_DIRECTION; ++i) {
            out[n++] = (rd_vk_target)i;
        }
    }
    return n;
}

static bool make_pass(rd_vk_raster* r, rd_vk_device* d, rd_vk_pass pass)
{
    const VkAttachmentLoadOp load =
        pass == RD_VK_PASS_LIT ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
    const VkImageLayout layout = pass >= RD_VK_PASS_LIT
                                     ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                     : VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    rd_vk_target colors[RD_VK_COLORS_MAX];
    VkAttachmentDescription attachments[RD_VK_COLORS_MAX + 1];
    uint32_t count = colors_of(pass, colors);
    for (uint32_t i = 0; i < count; ++i) {
        attachments[i] = rd_vk_attachment(format_of(d, (int)colors[i]), load,
                                          VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    }
    attachments[count] = rd_vk_attachment(formats[RD_VK_DEPTH],
                                          pass == RD_VK_PASS_DEPTH ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                                                   : VK_ATTACHMENT_LOAD_OP_LOAD,
                                          layout);
    return rd_vk_pass_make(d, attachments, count, layout, &r->passes[pass]);
}

static bool make_framebuffer(rd_vk_raster* r, rd_vk_device* d, rd_vk_pass pass)
{
    rd_vk_target colors[RD_VK_COLORS_MAX];
    VkImageView views[RD_VK_COLORS_MAX + 1];
    uint32_t count = colors_of(pass, colors);
    for (uint32_t i = 0; i < count; ++i) {
        views[i] = r->targets[colors[i]].base.view;
    }
    views[count] = r->targets[RD_VK_DEPTH].base.view;
    return rd_vk_framebuffer_make(d, r->passes[pass], views, count + 1, r->width, r->height,
                                  &r->framebuffers[pass]);
}

bool rd_vk_raster_make(rd_vk_raster* r, rd_vk_device* d, uint32_t width, uint32_t height,
                       const VkDescriptorSetLayout* sets, uint32_t set_count)
{
    const VkPushConstantRange push = {VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                      16};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = set_count,
                                               .pSetLayouts = sets,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &push};
    bool ok;
    memset(r, 0, sizeof *r);
    r->width = width;
    r->height = height;
    ok = make_targets(r, d) &&
         rd_vk_check(d, vkCreatePipelineLayout(d->device, &layout, NULL, &r->layout), "a layout");
    for (int i = 0; ok && i < RD_VK_PASS_COUNT; ++i) {
        ok = make_pass(r, d, (rd_vk_pass)i) && make_framebuffer(r, d, (rd_vk_pass)i);
    }
    return ok;
}

void rd_vk_raster_free(rd_vk_raster* r, rd_vk_device* d)
{
    for (int i = 0; d->device && i < RD_VK_PASS_COUNT; ++i) {
        vkDestroyFramebuffer(d->device, r->framebuffers[i], NULL);
        vkDestroyRenderPass(d->device, r->passes[i], NULL);
    }
    for (int i = 0; i < RD_VK_TARGET_COUNT; ++i) {
        rd_vk_image_free(d, &r->targets[i]);
    }
    if (d->device) {
        vkDestroyPipelineLayout(d->device, r->layout, NULL);
    }
    memset(r, 0, sizeof *r);
}

void rd_vk_pass_begin(const rd_vk_raster* r, rd_vk_device* d, rd_vk_pass pass)
{
    VkClearValue clear[RD_VK_COLORS_MAX + 1]; /* zeros: of reverse depth, the farthest */
    const VkViewport viewport = {0.0f, 0.0f, (float)r->width, (float)r->height, 0.0f, 1.0f};
    VkRenderPassBeginInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                  .renderPass = r->passes[pass],
                                  .framebuffer = r->framebuffers[pass],
                                  .renderArea = {{0, 0}, {r->width, r->height}},
                                  .clearValueCount = RD_VK_COLORS_MAX + 1,
                                  .pClearValues = clear};
    memset(clear, 0, sizeof clear);
    for (int i = 0; pass == RD_VK_PASS_BEHIND && i < 4; ++i) {
        clear[0].color.float32[i] = 1.0f; /* of the product */
    }
    vkCmdBeginRenderPass(d->commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdSetViewport(d->commands, 0, 1, &viewport);
    vkCmdSetScissor(d->commands, 0, 1, &info.renderArea);
}

void rd_vk_pass_end(rd_vk_device* d)
{
    vkCmdEndRenderPass(d->commands);
}

/* >>pipelines */

static VkResult make_module(rd_vk_device* d, rd_vk_code code, VkShaderModule* out)
{
    VkShaderModuleCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.bytes;
    info.pCode = code.words;
    return vkCreateShaderModule(d->device, &info, NULL, out);
}

/* Of the four attachments of RD_VK_PASS_BEHIND. */
static VkPipelineColorBlendAttachmentState blending_behind(uint32_t attachment)
{
    static const VkBlendFactor from[4] = {VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_ONE,
                                          VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE};
    static const VkBlendFactor to[4] = {VK_BLEND_FACTOR_SRC_COLOR, VK_BLEND_FACTOR_ONE,
                                        VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA};
    VkPipelineColorBlendAttachmentState s;
    memset(&s, 0, sizeof s);
    s.colorWriteMask = 15u;
    s.blendEnable = VK_TRUE;
    s.colorBlendOp = s.alphaBlendOp = attachment == 2u ? VK_BLEND_OP_MAX : VK_BLEND_OP_ADD;
    s.srcColorBlendFactor = s.srcAlphaBlendFactor = from[attachment];
    s.dstColorBlendFactor = to[attachment];
    s.dstAlphaBlendFactor = attachment == 0u ? VK_BLEND_FACTOR_SRC_ALPHA : to[attachment];
    return s;
}

static VkPipelineColorBlendAttachmentState blending(rd_vk_blend blend)
{
    VkPipelineColorBlendAttachmentState s;
    memset(&s, 0, sizeof s);
    s.colorWriteMask = 15u;
    s.blendEnable = blend != RD_VK_BLEND_NONE;
    s.srcColorBlendFactor = s.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    s.dstColorBlendFactor = blend == RD_VK_BLEND_LAYER ? VK_BLEND_FACTOR_SRC1_COLOR
                                                       : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    s.dstAlphaBlendFactor = blend == RD_VK_BLEND_LAYER ? VK_BLEND_FACTOR_SRC1_ALPHA
                                                       : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    return s;
}

static VkResult make_pipeline(const rd_vk_raster* r, rd_vk_device* d,
                              const rd_vk_pipeline_desc* desc,
                              VkPipelineShaderStageCreateInfo* stages, VkPipeline* out)
{
    static const VkDynamicState dynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineVertexInputStateCreateInfo vertices = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .depthClampEnable = desc->clamps_depth,
        .cullMode = VK_CULL_MODE_NONE,
        .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = desc->writes_depth,
        .depthCompareOp = desc->compare};
    VkPipelineColorBlendAttachmentState blends[RD_VK_COLORS_MAX];
    rd_vk_target colors[RD_VK_COLORS_MAX];
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    const VkPipelineDynamicStateCreateInfo state = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = dynamic};
    const VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .stageCount = desc->fragment.words ? 2 : 1,
        .pStages = stages,
        .pVertexInputState = &vertices,
        .pInputAssemblyState = &assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &raster,
        .pMultisampleState = &samples,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blend,
        .pDynamicState = &state,
        .layout = r->layout,
        .renderPass = desc->other_pass ? desc->other_pass : r->passes[desc->pass]};
    blend.attachmentCount = desc->other_pass ? desc->blend_count : colors_of(desc->pass, colors);
    blend.pAttachments = desc->other_pass ? desc->blends : blends;
    for (uint32_t i = 0; !desc->other_pass && i < blend.attachmentCount; ++i) {
        blends[i] = desc->blend == RD_VK_BLEND_BEHIND ? blending_behind(i) : blending(desc->blend);
    }
    return vkCreateGraphicsPipelines(d->device, VK_NULL_HANDLE, 1, &info, NULL, out);
}

bool rd_vk_pipeline_make(const rd_vk_raster* r, rd_vk_device* d, const rd_vk_pipeline_desc* desc,
                         VkPipeline* out)
{
    VkSpecializationMapEntry entries[CONSTANTS_MAX];
    VkSpecializationInfo special = {desc->constant_count, entries, desc->constant_count * 4u,
                                    desc->constants};
    VkPipelineShaderStageCreateInfo stages[2];
    VkResult result;
    memset(stages, 0, sizeof stages);
    for (uint32_t i = 0; i < desc->constant_count; ++i) {
        entries[i].constantID = i;
        entries[i].offset = i * 4u;
        entries[i].size = 4;
    }
    for (int i = 0; i < 2; ++i) {
        stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stages[i].stage = i ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_VERTEX_BIT;
        stages[i].pName = "main";
    }
    stages[1].pSpecializationInfo = &special;
    result = make_module(d, desc->vertex, &stages[0].module);
    if (result == VK_SUCCESS && desc->fragment.words) {
        result = make_module(d, desc->fragment, &stages[1].module);
    }
    if (result == VK_SUCCESS) {
        result = make_pipeline(r, d, desc, stages, out);
    }
    vkDestroyShaderModule(d->device, stages[0].module, NULL);
    vkDestroyShaderModule(d->device, stages[1].module, NULL);
    return rd_vk_check(d, result, "a pipeline");
}
