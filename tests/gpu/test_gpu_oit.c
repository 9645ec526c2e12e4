/* test_gpu_oit.c - transparency drawn by a device, with its blending, against hdrp_oit.h on the CPU.
 * SPDX-License-Identifier: MIT
 *
 * A stream of fragments is drawn as points, which blend in the order of the stream: on the device
 * and on the CPU each pixel goes through the same sums. Passes read what the device has left in the
 * passes before on both sides, so that a difference is of one pass. */
#include "gpu_test.h"

#include "hdrp_oit.h"
#include "hdrp_pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* clang-format off */
#include "oit_stream_vert.h"
#include "oit_stream_frag1.h"
#include "oit_stream_frag2.h"
#include "oit_stream_frag3.h"
#include "oit_stream_frag4.h"
#include "oit_stream_frag5.h"
/* clang-format on */

#define FRAGMENTS_MAX 20000u
#define READ_MAX      6u /* targets of passes before */

static const float near_m = 0.5f, far_m = 300.0f;
static gpu_device device;
static hdrp_gpu_vk gpu;

/* Fragments, and the pixel of each. */
typedef struct stream {
    hdrp_oit_fragment* fragments;
    uint32_t* pixels;
    size_t count;
} stream;

/* As the vertex shader reads them. */
typedef struct point {
    hdrp_v4 color, emission;
    hdrp_u32x4 place;
} point;

/* One resolution: what is drawn in it, its targets, and those of the CPU. */
typedef struct layer {
    uint32_t width, height;
    stream all, own;     /* of passes before the last, and of the last */
    uint32_t* depth_all; /* fragments of each pixel */
    uint32_t* depth_own;
    hdrp_gpu_vk_image targets[HDRP_OIT_TARGETS_MAX];
    hdrp_oit_image cpu;
} layer;

/* What is drawn with. */
static struct {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkShaderModule vertex, fragment[5]; /* with one to five targets */
    VkRenderPass render_pass;           /* of a pass of a mode */
    VkPipeline pipeline;
    hdrp_gpu_vk_image nothing, opaque, composed;
    hdrp_gpu_vk_buffer points, texels;
} vk;

static layer layers[2]; /* full and low */

static bool is_shuffled; /* the device draws in another order than the CPU */

static uint64_t random_state = 1;

static float uniform(float lo, float hi)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (float)(random_state >> 40) * 0x1p-24f;
}

/* ---- streams --------------------------------------------------------------------------------- */

static void stream_make(stream* s)
{
    s->fragments = malloc(FRAGMENTS_MAX * sizeof *s->fragments);
    s->pixels = malloc(FRAGMENTS_MAX * sizeof *s->pixels);
    s->count = 0;
    assert_true(s->fragments && s->pixels);
}

static void stream_free(stream* s)
{
    free(s->fragments);
    free(s->pixels);
}

static void put(stream* s, const layer* l, uint32_t x, uint32_t y, hdrp_oit_fragment f)
{
    if (x < l->width && y < l->height) {
        assert_true(s->count < FRAGMENTS_MAX);
        s->fragments[s->count] = f;
        s->pixels[s->count++] = y * l->width + x;
    }
}

/* Glass, smoke and light of any brightness; one in four covers nothing. */
static hdrp_oit_fragment random_fragment(void)
{
    hdrp_v3 color = hdrp_v3_make(uniform(0, 2), uniform(0, 2), uniform(0, 2));
    hdrp_v3 emission = hdrp_v3_make(uniform(0, 1), uniform(0, 1), uniform(0, 4));
    float alpha = uniform(0, 4) < 1 ? 0.0f : uniform(0.02f, 0.98f);
    float emits = uniform(0, 3) < 1 ? 1.0f : 0.0f;
    return hdrp_oit_fragment_make(hdrp_v3_scale(color, alpha), hdrp_v3_scale(emission, emits),
                                  alpha, expf(uniform(0.0f, 5.3f)));
}

static bool is_empty(uint32_t x, uint32_t y)
{
    return x / 4u % 3u == 1u && y / 4u % 2u == 0u; /* squares, in full and in low pixels */
}

/* Each fragment in its own layer, and in the other for the passes before the last. */
static void fill_streams(void)
{
    layer *full = &layers[0], *low = &layers[1];
    for (uint32_t y = 0; y < full->height; ++y) {
        for (uint32_t x = 0; x < full->width; ++x) {
            uint32_t count = is_empty(x, y) ? 0u : 2u + (uint32_t)uniform(0, 9);
            bool is_low = x % 2u == 0u && y % 2u == 0u;
            for (uint32_t i = 0; i < count; ++i) {
                hdrp_oit_fragment f = random_fragment();
                put(&full->own, full, x, y, f);
                put(&full->all, full, x, y, f);
                if (is_low) {
                    put(&low->all, low, x / 2u, y / 2u, f);
                }
                if (is_low && i < 5u) {
                    f = random_fragment();
                    put(&low->own, low, x / 2u, y / 2u, f);
                    put(&low->all, low, x / 2u, y / 2u, f);
                    for (uint32_t k = 0; k < 4u; ++k) {
                        put(&full->all, full, x + k % 2u, y + k / 2u, f);
                    }
                }
            }
        }
    }
}

static uint32_t* count_depths(const layer* l, const stream* s)
{
    uint32_t* depths = calloc((size_t)l->width * l->height, sizeof *depths);
    assert_non_null(depths);
    for (size_t i = 0; i < s->count; ++i) {
        ++depths[s->pixels[i]];
    }
    return depths;
}

static void make_layers(uint32_t width, uint32_t height, uint32_t low_width, uint32_t low_height)
{
    const uint32_t sides[4] = {width, height, low_width, low_height};
    for (uint32_t i = 0; i < 2; ++i) {
        memset(&layers[i], 0, sizeof layers[i]);
        layers[i].width = sides[2 * i];
        layers[i].height = sides[2 * i + 1];
        stream_make(&layers[i].all);
        stream_make(&layers[i].own);
    }
    fill_streams();
    for (uint32_t i = 0; i < 2; ++i) {
        layers[i].depth_all = count_depths(&layers[i], &layers[i].all);
        layers[i].depth_own = count_depths(&layers[i], &layers[i].own);
    }
}

/* A stream in another order. */
static void shuffle(stream* s)
{
    for (size_t i = s->count; i > 1u; --i) {
        size_t k = (size_t)uniform(0, (float)i) % i;
        hdrp_oit_fragment f = s->fragments[i - 1u];
        uint32_t pixel = s->pixels[i - 1u];
        s->fragments[i - 1u] = s->fragments[k];
        s->pixels[i - 1u] = s->pixels[k];
        s->fragments[k] = f;
        s->pixels[k] = pixel;
    }
}

/* ---- Vulkan ---------------------------------------------------------------------------------- */

static hdrp_gpu_vk_image make_image(VkFormat format, uint32_t width, uint32_t height,
                                    VkImageUsageFlags usage)
{
    hdrp_gpu_vk_image image;
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, format, width, height,
                                              usage | VK_IMAGE_USAGE_SAMPLED_BIT |
                                                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                  VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                              "transparent", &image),
                     HDRP_OK);
    return image;
}

static VkShaderModule make_module(const uint32_t* words, size_t bytes)
{
    const VkShaderModuleCreateInfo code = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = bytes, .pCode = words};
    VkShaderModule made;
    assert_int_equal(vkCreateShaderModule(device.device, &code, NULL, &made), VK_SUCCESS);
    return made;
}

static void make_layout(void)
{
    VkDescriptorSetLayoutBinding bindings[READ_MAX + 1u];
    const VkDescriptorSetLayoutCreateInfo sets = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = READ_MAX + 1u,
        .pBindings = bindings};
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 64u * READ_MAX},
                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 64u}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 64,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    const VkPushConstantRange range = {VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                       32};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &vk.set_layout,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    memset(bindings, 0, sizeof bindings);
    for (uint32_t i = 0; i <= READ_MAX; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorCount = 1;
        bindings[i].descriptorType =
            i < READ_MAX ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        bindings[i].stageFlags =
            i < READ_MAX ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_VERTEX_BIT;
    }
    assert_int_equal(vkCreateDescriptorSetLayout(device.device, &sets, NULL, &vk.set_layout),
                     VK_SUCCESS);
    assert_int_equal(vkCreatePipelineLayout(device.device, &layout, NULL, &vk.layout), VK_SUCCESS);
    assert_int_equal(vkCreateDescriptorPool(device.device, &pool, NULL, &vk.pool), VK_SUCCESS);
}

/* A render pass with the targets of a pass, cleared. */
static VkRenderPass make_render_pass(const hdrp_oit_target* targets, uint32_t count)
{
    VkAttachmentDescription attachments[HDRP_OIT_TARGETS_MAX];
    VkAttachmentReference references[HDRP_OIT_TARGETS_MAX];
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = count,
                                          .pColorAttachments = references};
    const VkPipelineStageFlags readers = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                                         VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                                         VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkSubpassDependency dependencies[2] = {
        {VK_SUBPASS_EXTERNAL, 0, readers, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, 0,
         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, readers,
         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT, 0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = count,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    VkRenderPass made;
    memset(attachments, 0, sizeof attachments);
    for (uint32_t i = 0; i < count; ++i) {
        attachments[i].format = hdrp_gpu_vk_oit_attachment_of(&targets[i]).format;
        attachments[i].samples = VK_SAMPLE_COUNT_1_BIT;
        attachments[i].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        attachments[i].finalLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        references[i].attachment = i;
        references[i].layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    }
    assert_int_equal(vkCreateRenderPass(device.device, &info, NULL, &made), VK_SUCCESS);
    return made;
}

/* The states that do not depend on the mode. */
static VkPipeline make_pipeline(uint32_t mode, uint32_t pass, const hdrp_oit_target* targets,
                                uint32_t count, VkRenderPass render_pass)
{
    const uint32_t constants[2] = {mode, pass};
    const VkSpecializationMapEntry entries[2] = {{0, 0, 4}, {1, 4, 4}};
    const VkSpecializationInfo special = {2, entries, sizeof constants, constants};
    const VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vk.vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = vk.fragment[count - 1u],
         .pName = "main",
         .pSpecializationInfo = &special}};
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST};
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo rasterization = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineColorBlendAttachmentState states[HDRP_OIT_TARGETS_MAX];
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = count,
        .pAttachments = states};
    const VkDynamicState changes[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = changes};
    const VkGraphicsPipelineCreateInfo info = {.sType =
                                                   VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                               .stageCount = 2,
                                               .pStages = stages,
                                               .pVertexInputState = &input,
                                               .pInputAssemblyState = &assembly,
                                               .pViewportState = &viewport,
                                               .pRasterizationState = &rasterization,
                                               .pMultisampleState = &samples,
                                               .pColorBlendState = &blend,
                                               .pDynamicState = &dynamic,
                                               .layout = vk.layout,
                                               .renderPass = render_pass};
    VkPipeline made;
    for (uint32_t i = 0; i < count; ++i) {
        states[i] = hdrp_gpu_vk_oit_attachment_of(&targets[i]).blend;
    }
    assert_int_equal(
        vkCreateGraphicsPipelines(device.device, VK_NULL_HANDLE, 1, &info, NULL, &made),
        VK_SUCCESS);
    return made;
}

/* A set with the targets before one of them, and stand-ins. */
static VkDescriptorSet make_set(const layer* l, uint32_t before)
{
    const VkDescriptorSetAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = vk.pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &vk.set_layout};
    const VkDescriptorBufferInfo points = {vk.points.buffer, 0, VK_WHOLE_SIZE};
    VkDescriptorImageInfo images[READ_MAX];
    VkDescriptorSet set;
    VkWriteDescriptorSet writes[2] = {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .descriptorCount = READ_MAX,
                                       .descriptorType = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                       .pImageInfo = images},
                                      {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .dstBinding = READ_MAX,
                                       .descriptorCount = 1,
                                       .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                       .pBufferInfo = &points}};
    for (uint32_t i = 0; i < READ_MAX; ++i) {
        images[i].sampler = VK_NULL_HANDLE;
        images[i].imageView = i < before ? l->targets[i].view : vk.nothing.view;
        images[i].imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    }
    assert_int_equal(vkAllocateDescriptorSets(device.device, &info, &set), VK_SUCCESS);
    writes[0].dstSet = writes[1].dstSet = set;
    vkUpdateDescriptorSets(device.device, 2, writes, 0, NULL);
    return set;
}

/* ---- drawing --------------------------------------------------------------------------------- */

static void upload_points(const layer* l, const stream* s)
{
    point* p = gpu_map(&device, &vk.points);
    for (size_t i = 0; i < s->count; ++i) {
        hdrp_oit_fragment f = s->fragments[i];
        float depth = far_m / (far_m - near_m) * (1.0f - near_m / f.z_view); /* as hdrp_oit.h */
        p[i].color = hdrp_v4_from_v3(f.premultiplied, f.alpha);
        p[i].emission = hdrp_v4_from_v3(f.emission, f.z_view);
        p[i].place = hdrp_u32x4_make(s->pixels[i] % l->width, s->pixels[i] / l->width,
                                     hdrp_bits_from_f32(depth), 0u);
    }
    gpu_unmap(&device, &vk.points);
}

/* Draws a stream into the targets [first,last) by vk.pipeline. */
static void draw(const layer* l, const stream* s, uint32_t first, uint32_t last)
{
    const hdrp_oit_desc* d = &l->cpu.desc;
    const float push[8] = {(float)l->width, (float)l->height, d->scale, 0.0f,
                           d->feather,      d->exposure,      0.0f,     0.0f};
    const VkViewport viewport = {0.0f, 0.0f, (float)l->width, (float)l->height, 0.0f, 1.0f};
    const VkRect2D area = {{0, 0}, {l->width, l->height}};
    VkImageView views[HDRP_OIT_TARGETS_MAX];
    VkClearValue clears[HDRP_OIT_TARGETS_MAX];
    VkFramebufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                      .renderPass = vk.render_pass,
                                      .attachmentCount = last - first,
                                      .pAttachments = views,
                                      .width = l->width,
                                      .height = l->height,
                                      .layers = 1};
    VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                   .renderPass = vk.render_pass,
                                   .renderArea = area,
                                   .clearValueCount = last - first,
                                   .pClearValues = clears};
    VkDescriptorSet set = make_set(l, first);
    VkCommandBuffer commands;
    for (uint32_t i = first; i < last; ++i) {
        views[i - first] = l->targets[i].view;
        clears[i - first] = hdrp_gpu_vk_oit_attachment_of(&l->cpu.targets[i]).clear;
    }
    assert_int_equal(vkCreateFramebuffer(device.device, &buffer, NULL, &begin.framebuffer),
                     VK_SUCCESS);
    upload_points(l, s);
    commands = gpu_begin(&device);
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, vk.pipeline);
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, vk.layout, 0, 1, &set, 0,
                            NULL);
    vkCmdPushConstants(commands, vk.layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                       push);
    vkCmdDraw(commands, (uint32_t)s->count, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    gpu_run(&device);
    assert_int_equal(vkResetDescriptorPool(device.device, vk.pool, 0), VK_SUCCESS);
    vkDestroyFramebuffer(device.device, begin.framebuffer, NULL);
}

/* ---- what targets hold ----------------------------------------------------------------------- */

static float half_at(const uint8_t* bytes)
{
    uint16_t code;
    memcpy(&code, bytes, sizeof code);
    return hdrp_pack_float_from_half(code);
}

static hdrp_v4 decoded(VkFormat format, const uint8_t* b)
{
    hdrp_v4 v = hdrp_v4_make(0.0f, 0.0f, 0.0f, 0.0f);
    uint32_t word;
    memcpy(&word, b, sizeof word);
    switch (format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        memcpy(&v, b, 16);
        return v;
    case VK_FORMAT_R32G32_SFLOAT:
        memcpy(&v, b, 8);
        return v;
    case VK_FORMAT_R32_SFLOAT:
        memcpy(&v, b, 4);
        return v;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return hdrp_v4_make(half_at(b), half_at(b + 2), half_at(b + 4), half_at(b + 6));
    case VK_FORMAT_R16_SFLOAT:
        return hdrp_v4_make(half_at(b), 0.0f, 0.0f, 0.0f);
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        return hdrp_v4_from_v3(hdrp_pack_rgb_from_r11g11b10f(word), 1.0f);
    case VK_FORMAT_R8G8B8A8_UNORM:
        return hdrp_pack_v4_from_rgba8(word);
    case VK_FORMAT_R8_UNORM:
        return hdrp_v4_make((float)b[0] / 255.0f, 0.0f, 0.0f, 0.0f);
    default:
        fail_msg("format %d", (int)format);
        return v;
    }
}

static uint32_t bytes_of(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return 16;
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return 8;
    case VK_FORMAT_R16_SFLOAT:
        return 2;
    case VK_FORMAT_R8_UNORM:
        return 1;
    default:
        return 4;
    }
}

static void download(const hdrp_gpu_vk_image* image, hdrp_v4* texels)
{
    const uint8_t* bytes;
    gpu_download(gpu_begin(&device), image, &vk.texels);
    gpu_run(&device);
    bytes = gpu_map(&device, &vk.texels);
    for (uint32_t i = 0; i < image->width_px * image->height_px; ++i) {
        texels[i] = decoded(image->format, bytes + i * bytes_of(image->format));
    }
    gpu_unmap(&device, &vk.texels);
}

/* Components of a format, and how far from each other sums of n fragments may be on both sides: each
 * sum is rounded to a neighbour in the format, on the CPU to the nearest one, by Vulkan to any. That
 * is at most one and a half steps of the format for each fragment, relative to a sum that does not
 * fall, and so to the last one; revealage does fall, but what was rounded falls with it. */
typedef struct rounding {
    uint32_t components;
    double step, step_blue; /* relative to the value */
    double fixed;           /* absolute */
} rounding;

static rounding rounding_of(hdrp_oit_format format)
{
    static const rounding all[8] = {{4, 0x1p-23, 0x1p-23, 1e-7},    {2, 0x1p-23, 0x1p-23, 1e-7},
                                    {1, 0x1p-23, 0x1p-23, 1e-7},    {4, 0x1p-10, 0x1p-10, 0x1p-14},
                                    {1, 0x1p-10, 0x1p-10, 0x1p-14}, {3, 0x1p-6, 0x1p-5, 0x1p-14},
                                    {4, 0.0, 0.0, 1.0 / 255.0},     {1, 0.0, 0.0, 1.0 / 255.0}};
    return all[format];
}

static const float* components_of(const hdrp_v4* v)
{
    return &v->x;
}

/* How far two texels are apart, in units of what they may be; `exports` is how far apart, relative
 * to it, what two compilers make of one export. */
static double apart(const hdrp_oit_target* target, hdrp_v4 cpu, hdrp_v4 found, uint32_t n,
                    double exports)
{
    rounding p = rounding_of(target->format);
    double worst = 0.0;
    for (uint32_t k = 0; k < p.components; ++k) {
        double a = (double)components_of(&cpu)[k], b = (double)components_of(&found)[k];
        double step = k == 2u ? p.step_blue : p.step;
        double may = 1.5 * n * (step * fabs(a) + p.fixed) + exports * fabs(a);
        double d = fabs(a - b);
        d = d == 0.0 ? 0.0 : d / (may > 0.0 ? may : 1e-30);
        worst = d <= worst ? worst : d; /* NaN is the worst */
    }
    return worst;
}

/* ---- a mode ---------------------------------------------------------------------------------- */

static void open_mode(uint32_t mode, hdrp_oit_precision precision)
{
    for (uint32_t i = 0; i < 2; ++i) {
        layer* l = &layers[i];
        hdrp_oit_desc desc;
        size_t bytes;
        memset(&desc, 0, sizeof desc);
        desc.width_px = l->width;
        desc.height_px = l->height;
        desc.mode = mode;
        desc.precision = precision;
        desc.scale = 0.5f;
        desc.exposure = 0.25f;
        bytes = hdrp_oit_memory_size(&desc);
        assert_int_equal(
            hdrp_oit_image_init(&l->cpu, &desc, aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes), bytes),
            HDRP_OK);
        for (uint32_t k = 0; k < l->cpu.target_count; ++k) {
            l->targets[k] = make_image(hdrp_gpu_vk_oit_attachment_of(&l->cpu.targets[k]).format,
                                       l->width, l->height, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        }
    }
}

static void close_mode(void)
{
    for (uint32_t i = 0; i < 2; ++i) {
        for (uint32_t k = 0; k < layers[i].cpu.target_count; ++k) {
            hdrp_gpu_vk_image_destroy(&gpu, &layers[i].targets[k]);
        }
        free(layers[i].cpu.texels);
    }
}

static uint32_t pass_begin(const hdrp_oit_image* image, uint32_t pass)
{
    uint32_t i = 0;
    while (i < image->target_count && image->targets[i].pass < pass) {
        ++i;
    }
    return i;
}

/* Draws a pass on both sides, compares, and goes on from what the device has. */
static void run_pass(layer* l, uint32_t first, uint32_t last, bool is_last, double exports)
{
    const stream* s = is_last ? &l->own : &l->all;
    const uint32_t* depths = is_last ? l->depth_own : l->depth_all;
    size_t count = (size_t)l->width * l->height;
    hdrp_v4* found = malloc(count * sizeof *found);
    assert_non_null(found);
    hdrp_oit_blend_rows(&l->cpu, l->cpu.targets[first].pass, s->fragments, s->pixels, s->count, 0,
                        l->height);
    if (is_shuffled) {
        shuffle(is_last ? &l->own : &l->all);
    }
    draw(l, s, first, last);
    for (uint32_t k = first; k < last; ++k) {
        hdrp_v4* cpu = l->cpu.texels + k * count;
        download(&l->targets[k], found);
        for (size_t i = 0; i < count; ++i) {
            assert_true(apart(&l->cpu.targets[k], cpu[i], found[i], depths[i], exports) <= 1.0);
        }
        memcpy(cpu, found, count * sizeof *found);
    }
    free(found);
}

/* All passes, in both resolutions. */
static void run_passes(void)
{
    const hdrp_oit_image* image = &layers[0].cpu;
    uint32_t mode = image->desc.mode, passes = hdrp_oit_pass_count(mode);
    for (uint32_t pass = 0; pass < passes; ++pass) {
        uint32_t first = pass_begin(image, pass), last = pass_begin(image, pass + 1u);
        bool is_last = pass + 1u == passes;
        bool is_ill = mode == HDRP_OIT_MODE_MOMENTS_6 || mode == HDRP_OIT_MODE_MOMENTS_4;
        /* Moments find depths as roots, which a last digit moves. */
        double exports = is_last && is_ill ? 5e-3 : 2e-5;
        vk.render_pass = make_render_pass(image->targets + first, last - first);
        vk.pipeline =
            make_pipeline(mode, pass, image->targets + first, last - first, vk.render_pass);
        run_pass(&layers[0], first, last, is_last, exports);
        run_pass(&layers[1], first, last, is_last, exports);
        vkDestroyPipeline(device.device, vk.pipeline, NULL);
        vkDestroyRenderPass(device.device, vk.render_pass, NULL);
    }
}

/* ---- the composite --------------------------------------------------------------------------- */

static double behind_at(uint32_t x, uint32_t y, uint32_t channel)
{
    return 0.125 * (double)((3u * x + 5u * y + 7u * channel) % 17u);
}

static hdrp_v3 behind_of(uint32_t x, uint32_t y)
{
    return hdrp_v3_make((float)behind_at(x, y, 0), (float)behind_at(x, y, 1),
                        (float)behind_at(x, y, 2));
}

/* A component of a target between low pixels, in double. */
static double low_at(uint32_t target, uint32_t component, uint32_t x, uint32_t y)
{
    const layer* l = &layers[1];
    const hdrp_v4* texels = l->cpu.texels + (size_t)target * l->width * l->height;
    double u = ((double)x + 0.5) * l->width / layers[0].width - 0.5;
    double v = ((double)y + 0.5) * l->height / layers[0].height - 0.5;
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
        double column = floor(u) + k % 2, row = floor(v) + k / 2;
        double weight = (1.0 - fabs(u - column)) * (1.0 - fabs(v - row));
        uint32_t i = (uint32_t)fmin(fmax(column, 0.0), (double)(l->width - 1u));
        uint32_t j = (uint32_t)fmin(fmax(row, 0.0), (double)(l->height - 1u));
        sum += weight * (double)components_of(&texels[j * l->width + i])[component];
    }
    return sum;
}

/* A target of colour of a pixel, merged with the low layer: added, and revealage multiplied. */
static hdrp_v4 merged_at(uint32_t target, uint32_t x, uint32_t y, bool has_low)
{
    const layer* l = &layers[0];
    hdrp_v4 v = l->cpu.texels[((size_t)target * l->height + y) * l->width + x];
    float out[4];
    for (uint32_t k = 0; k < 4; ++k) {
        hdrp_oit_blend blend =
            k == 3u ? l->cpu.targets[target].alpha : l->cpu.targets[target].color;
        double own = (double)components_of(&v)[k];
        double other = has_low ? low_at(target, k, x, y) : (double)(blend != HDRP_OIT_BLEND_ADD);
        out[k] = (float)(blend == HDRP_OIT_BLEND_ADD ? own + other : own * other);
    }
    return hdrp_v4_make(out[0], out[1], out[2], out[3]);
}

static hdrp_v3 color_at(uint32_t x, uint32_t y, bool has_low)
{
    const hdrp_oit_image* image = &layers[0].cpu;
    const hdrp_oit_desc* d = &image->desc;
    uint32_t first = pass_begin(image, hdrp_oit_pass_count(d->mode) - 1u);
    uint32_t sums = d->mode == HDRP_OIT_MODE_FRONT ? first + 1u : first;
    hdrp_oit_targets t;
    hdrp_oit_front_targets all;
    t.accum = merged_at(sums, x, y, has_low);
    t.light = merged_at(sums + 1u, x, y, has_low);
    if (image->target_count > sums + 2u) {
        t.light.w = merged_at(sums + 2u, x, y, has_low).x;
    }
    all.front = merged_at(first, x, y, has_low);
    all.accum = t.accum;
    all.light = t.light;
    switch (d->mode) {
    case HDRP_OIT_MODE_FRONT:
        return hdrp_oit_front_composite(all, behind_of(x, y), d->scale);
    case HDRP_OIT_MODE_TALK:
        return hdrp_oit_talk_composite(t, behind_of(x, y));
    case HDRP_OIT_MODE_WAVELET:
    case HDRP_OIT_MODE_MOMENTS_6:
    case HDRP_OIT_MODE_MOMENTS_4:
        return hdrp_oit_layer_composite(t, behind_of(x, y), d->scale);
    default:
        return hdrp_oit_composite(t, behind_of(x, y), d->scale);
    }
}

/* How much of a quarter that is covered and a rest that is not is covered with all fragments. */
static float alpha_at(uint32_t x, uint32_t y, bool has_low)
{
    const hdrp_oit_image* image = &layers[0].cpu;
    uint32_t mode = image->desc.mode, last = image->target_count - 1u;
    hdrp_v4 v = merged_at(last, x, y, has_low);
    float through =
        mode == HDRP_OIT_MODE_TALK || image->desc.precision == HDRP_OIT_PRECISION_COMPACT ? v.x
                                                                                          : v.w;
    if (mode == HDRP_OIT_MODE_FRONT) {
        through *= 1.0f - hdrp_min(merged_at(1, x, y, has_low).w, 1.0f);
    }
    return 1.0f - 0.75f * through;
}

static hdrp_gpu_vk_oit_layer views_of(const layer* l)
{
    uint32_t first = pass_begin(&l->cpu, hdrp_oit_pass_count(l->cpu.desc.mode) - 1u);
    hdrp_gpu_vk_oit_layer made;
    memset(&made, 0, sizeof made);
    made.width_px = l->width;
    made.height_px = l->height;
    for (uint32_t i = first; i < l->cpu.target_count; ++i) {
        made.targets[i - first] = l->targets[i].view;
    }
    return made;
}

static hdrp_gpu_vk_oit oit_of(const hdrp_gpu_vk_oit_layer* low)
{
    hdrp_gpu_vk_oit oit;
    memset(&oit, 0, sizeof oit);
    oit.mode = layers[0].cpu.desc.mode;
    oit.scale = layers[0].cpu.desc.scale;
    oit.full = views_of(&layers[0]);
    oit.low = low;
    oit.opaque = vk.opaque.view;
    oit.color = &vk.composed;
    return oit;
}

/* What the device composes of its targets, against the CPU with the same ones. */
static void expect_composed(bool has_low)
{
    const layer* l = &layers[0];
    hdrp_gpu_vk_oit_layer low = views_of(&layers[1]);
    hdrp_gpu_vk_oit oit = oit_of(has_low ? &low : NULL);
    hdrp_v4* found = malloc((size_t)l->width * l->height * sizeof *found);
    assert_non_null(found);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_oit_composite(&gpu, gpu_begin(&device), &oit), HDRP_OK);
    gpu_run(&device);
    download(&vk.composed, found);
    for (uint32_t y = 0; y < l->height; ++y) {
        for (uint32_t x = 0; x < l->width; ++x) {
            hdrp_v3 expected = color_at(x, y, has_low), behind = behind_of(x, y);
            hdrp_v4 c = found[y * l->width + x];
            hdrp_v3 d = hdrp_v3_sub(hdrp_v3_from_v4(c), expected);
            hdrp_v3 may = hdrp_v3_scale(expected, 2e-5f);
            assert_true(fabsf(d.x) <= may.x + 1e-6f && fabsf(d.y) <= may.y + 1e-6f &&
                        fabsf(d.z) <= may.z + 1e-6f);
            assert_true(fabsf(c.w - alpha_at(x, y, has_low)) <= 1e-6f);
            if (l->depth_own[y * l->width + x] == 0u && !has_low) {
                assert_true(c.x == behind.x && c.y == behind.y && c.z == behind.z && c.w == 0.25f);
            }
        }
    }
    free(found);
}

/* ---- tests ----------------------------------------------------------------------------------- */

/* Whether the device can draw a mode; those that Vulkan promises are there. */
static bool is_drawn(uint32_t mode, hdrp_oit_precision precision)
{
    const hdrp_gpu_vk_desc desc = gpu_desc(&device);
    hdrp_oit_target targets[HDRP_OIT_TARGETS_MAX];
    uint32_t count = hdrp_oit_describe_targets(mode, precision, targets);
    const char* missing = hdrp_gpu_vk_oit_missing(&desc, targets, count, 0);
    if (missing) {
        printf("mode %u is not drawn: the device lacks %s\n", mode, missing);
    }
    assert_true(!missing || !device.is_lavapipe);
    return !missing;
}

static void run_mode(uint32_t mode, hdrp_oit_precision precision)
{
    if (!is_drawn(mode, precision)) {
        return;
    }
    open_mode(mode, precision);
    run_passes();
    expect_composed(false);
    expect_composed(true);
    close_mode();
}

static void modes_are_those_of_the_cpu(void** state)
{
    (void)state;
    for (uint32_t mode = 0; mode < HDRP_OIT_MODE_COUNT; ++mode) {
        run_mode(mode, HDRP_OIT_PRECISION_NATIVE);
        run_mode(mode, HDRP_OIT_PRECISION_FLOAT);
    }
}

/* Where light has other formats: in the pass of colour of each kind of composite. */
static void compact_targets_are_those_of_the_cpu(void** state)
{
    (void)state;
    run_mode(HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_COMPACT);
    run_mode(HDRP_OIT_MODE_FRONT, HDRP_OIT_PRECISION_COMPACT);
    run_mode(HDRP_OIT_MODE_WAVELET, HDRP_OIT_PRECISION_COMPACT);
}

static void order_changes_no_more_than_rounding(void** state)
{
    static const uint32_t tried[4] = {HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_MODE_FRONT,
                                      HDRP_OIT_MODE_WAVELET, HDRP_OIT_MODE_TALK};
    (void)state;
    is_shuffled = true;
    for (uint32_t i = 0; i < 4; ++i) {
        run_mode(tried[i], HDRP_OIT_PRECISION_NATIVE);
    }
    is_shuffled = false;
}

/* ---- what is described and refused ----------------------------------------------------------- */

/* Factors as hdrp_oit.h words them, by the sums that Vulkan makes of them. */
static void attachments_blend_as_described(void** state)
{
    hdrp_oit_target targets[HDRP_OIT_TARGETS_MAX];
    hdrp_gpu_vk_oit_attachment a;
    (void)state;
    assert_int_equal(
        hdrp_oit_describe_targets(HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_NATIVE, targets),
        2);
    a = hdrp_gpu_vk_oit_attachment_of(&targets[1]);
    assert_int_equal(a.format, VK_FORMAT_R16G16B16A16_SFLOAT);
    assert_true(a.clear.color.float32[0] == 0.0f && a.clear.color.float32[3] == 1.0f);
    assert_int_equal(a.blend.blendEnable, VK_TRUE);
    assert_int_equal(a.blend.srcColorBlendFactor, VK_BLEND_FACTOR_ONE);
    assert_int_equal(a.blend.dstColorBlendFactor, VK_BLEND_FACTOR_ONE);
    assert_int_equal(a.blend.colorBlendOp, VK_BLEND_OP_ADD);
    assert_int_equal(a.blend.srcAlphaBlendFactor, VK_BLEND_FACTOR_ZERO);
    assert_int_equal(a.blend.dstAlphaBlendFactor, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA);
    assert_int_equal(a.blend.alphaBlendOp, VK_BLEND_OP_ADD);
    assert_int_equal(a.blend.colorWriteMask, 15);
    hdrp_oit_describe_targets(HDRP_OIT_MODE_TALK, HDRP_OIT_PRECISION_NATIVE, targets);
    a = hdrp_gpu_vk_oit_attachment_of(&targets[1]);
    assert_int_equal(a.format, VK_FORMAT_R8G8B8A8_UNORM);
    assert_int_equal(a.blend.srcColorBlendFactor, VK_BLEND_FACTOR_ZERO);
    assert_int_equal(a.blend.dstColorBlendFactor, VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR);
    assert_int_equal(a.blend.dstAlphaBlendFactor, VK_BLEND_FACTOR_ONE);
    hdrp_oit_describe_targets(HDRP_OIT_MODE_WAVELET, HDRP_OIT_PRECISION_NATIVE, targets);
    a = hdrp_gpu_vk_oit_attachment_of(&targets[0]);
    assert_int_equal(a.format, VK_FORMAT_R32G32_SFLOAT);
    assert_true(a.clear.color.float32[0] == -HDRP_OIT_NOTHING && a.clear.color.float32[1] == 0.0f);
    assert_int_equal(a.blend.colorBlendOp, VK_BLEND_OP_MAX);
    assert_int_equal(a.blend.alphaBlendOp, VK_BLEND_OP_MAX);
    targets[0].format = (hdrp_oit_format)99;
    assert_int_equal(hdrp_gpu_vk_oit_attachment_of(&targets[0]).format, VK_FORMAT_UNDEFINED);
}

/* A driver of few abilities. */
static const char* hidden;

static VKAPI_ATTR void VKAPI_CALL poor_formats(VkPhysicalDevice physical, VkFormat format,
                                               VkFormatProperties* properties)
{
    vkGetPhysicalDeviceFormatProperties(physical, format, properties);
    if (format == VK_FORMAT_R32G32_SFLOAT || format == VK_FORMAT_B10G11R11_UFLOAT_PACK32) {
        properties->optimalTilingFeatures &=
            ~(VkFormatFeatureFlags)VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    }
}

static VKAPI_ATTR void VKAPI_CALL poor_limits(VkPhysicalDevice physical,
                                              VkPhysicalDeviceProperties* properties)
{
    vkGetPhysicalDeviceProperties(physical, properties);
    properties->limits.maxColorAttachments = properties->limits.maxFragmentOutputAttachments = 4;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL poor_functions(VkInstance instance,
                                                               const char* name)
{
    if (hidden && strcmp(name, hidden) == 0) {
        return NULL;
    }
    if (strcmp(name, "vkGetPhysicalDeviceFormatProperties") == 0) {
        return (PFN_vkVoidFunction)poor_formats;
    }
    return strcmp(name, "vkGetPhysicalDeviceProperties") == 0
               ? (PFN_vkVoidFunction)poor_limits
               : vkGetInstanceProcAddr(instance, name);
}

static const char* missing_of(const hdrp_gpu_vk_desc* desc, uint32_t mode,
                              hdrp_oit_precision precision, uint32_t index)
{
    hdrp_oit_target targets[HDRP_OIT_TARGETS_MAX];
    uint32_t count = hdrp_oit_describe_targets(mode, precision, targets);
    return hdrp_gpu_vk_oit_missing(desc, targets, count, index);
}

static void what_targets_lack_has_a_name(void** state)
{
    const hdrp_oit_precision native = HDRP_OIT_PRECISION_NATIVE;
    const VkPhysicalDeviceFeatures none = {0};
    hdrp_gpu_vk_desc desc = gpu_desc(&device);
    (void)state;
    assert_string_equal(missing_of(NULL, 0, native, 0), "desc");
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_COUNT, native, 0), "targets");
    assert_string_equal(hdrp_gpu_vk_oit_missing(&desc, NULL, 2, 0), "targets");
    desc.get_instance_proc_addr = poor_functions;
    assert_null(missing_of(&desc, HDRP_OIT_MODE_RECOMMENDED, native, 0));
    assert_null(missing_of(&desc, HDRP_OIT_MODE_FRONT, native, 0));
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_WAVELET, native, 0),
                        "VK_FORMAT_R32G32_SFLOAT");
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_WAVELET, native, 1), "maxColorAttachments");
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_WAVELET, native, 2),
                        "maxFragmentOutputAttachments");
    assert_null(missing_of(&desc, HDRP_OIT_MODE_WAVELET, native, 3));
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_COMPACT, 0),
                        "VK_FORMAT_B10G11R11_UFLOAT_PACK32");
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_MOMENTS_4, native, 0),
                        "VK_FORMAT_R32G32_SFLOAT"); /* twice a target, once a name */
    assert_null(missing_of(&desc, HDRP_OIT_MODE_MOMENTS_4, native, 1));
    desc.features = &none;
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_RECOMMENDED, native, 0),
                        "independentBlend");
    desc.features = NULL;
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_FRONT, native, 0), "independentBlend");
    hidden = "vkGetPhysicalDeviceProperties";
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_FRONT, native, 0), hidden);
    hidden = "vkGetPhysicalDeviceFormatProperties";
    assert_string_equal(missing_of(&desc, HDRP_OIT_MODE_FRONT, native, 0), hidden);
    hidden = NULL;
    desc.instance = VK_NULL_HANDLE;
    desc.physical_device = VK_NULL_HANDLE;
    desc.get_instance_proc_addr = NULL;
    assert_string_equal(missing_of(&desc, 0, native, 0), "instance");
    assert_string_equal(missing_of(&desc, 0, native, 1), "physical_device");
    assert_string_equal(missing_of(&desc, 0, native, 2), "get_instance_proc_addr");
}

static void expect_refused(const hdrp_gpu_vk_oit* oit, hdrp_result expected)
{
    assert_int_equal(hdrp_gpu_vk_oit_composite(&gpu, device.commands, oit), expected);
}

static void composites_out_of_range_are_refused(void** state)
{
    hdrp_gpu_vk_oit_layer low, other;
    hdrp_gpu_vk_image color;
    hdrp_gpu_vk_oit oit;
    hdrp_gpu_vk_desc desc = gpu_desc(&device);
    hdrp_gpu_vk without;
    (void)state;
    open_mode(HDRP_OIT_MODE_FRONT, HDRP_OIT_PRECISION_COMPACT);
    low = views_of(&layers[1]);
    gpu_begin(&device);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    oit = oit_of(&low);
    assert_int_equal(hdrp_gpu_vk_oit_composite(NULL, device.commands, &oit),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_oit_composite(&gpu, NULL, &oit), HDRP_ERROR_NULL_POINTER);
    expect_refused(NULL, HDRP_ERROR_NULL_POINTER);
    oit.opaque = VK_NULL_HANDLE;
    expect_refused(&oit, HDRP_ERROR_NULL_POINTER);
    oit = oit_of(&low);
    oit.color = NULL;
    expect_refused(&oit, HDRP_ERROR_NULL_POINTER);
    oit = oit_of(&low);
    color = vk.composed;
    color.view = VK_NULL_HANDLE;
    oit.color = &color;
    expect_refused(&oit, HDRP_ERROR_NULL_POINTER);
    for (uint32_t i = 0; i < 3; ++i) {
        oit = oit_of(&low);
        oit.full.targets[i] = VK_NULL_HANDLE;
        expect_refused(&oit, HDRP_ERROR_NULL_POINTER);
        other = low;
        other.targets[i] = VK_NULL_HANDLE;
        oit = oit_of(&other);
        expect_refused(&oit, HDRP_ERROR_NULL_POINTER);
    }
    other = low;
    other.targets[3] = VK_NULL_HANDLE; /* compact there, and not here */
    oit = oit_of(&other);
    expect_refused(&oit, HDRP_ERROR_BAD_ARGUMENT);
    other = low;
    other.width_px = 0;
    expect_refused(&oit, HDRP_ERROR_BAD_ARGUMENT);
    other.width_px = 1;
    other.height_px = 16385;
    expect_refused(&oit, HDRP_ERROR_BAD_ARGUMENT);
    oit = oit_of(&low);
    oit.mode = HDRP_OIT_MODE_COUNT;
    expect_refused(&oit, HDRP_ERROR_BAD_ARGUMENT);
    oit = oit_of(&low);
    oit.scale = 1048577.0f;
    expect_refused(&oit, HDRP_ERROR_BAD_ARGUMENT);
    oit.scale = NAN;
    expect_refused(&oit, HDRP_ERROR_BAD_ARGUMENT);
    oit = oit_of(&low);
    --oit.full.width_px;
    expect_refused(&oit, HDRP_ERROR_BAD_ARGUMENT);
    oit = oit_of(&low);
    color = vk.composed;
    color.format = VK_FORMAT_R8G8B8A8_SRGB;
    oit.color = &color;
    expect_refused(&oit, HDRP_ERROR_UNSUPPORTED);
    desc.passes = HDRP_GPU_VK_PASS_TONE_MAP;
    assert_int_equal(hdrp_gpu_vk_init(&without, &desc), HDRP_OK);
    oit = oit_of(&low);
    assert_int_equal(hdrp_gpu_vk_oit_composite(&without, device.commands, &oit),
                     HDRP_ERROR_UNSUPPORTED);
    hdrp_gpu_vk_destroy(&without);
    gpu_run(&device);
    close_mode();
}

/* What is opaque in the image that is composed into, which holds halves. */
static void composites_in_place_stay_finite(void** state)
{
    const layer* l = &layers[0];
    size_t count = (size_t)l->width * l->height;
    hdrp_gpu_vk_image color =
        make_image(VK_FORMAT_R16G16B16A16_SFLOAT, l->width, l->height, VK_IMAGE_USAGE_STORAGE_BIT);
    hdrp_v4* found = malloc(count * sizeof *found);
    uint16_t* halves;
    hdrp_gpu_vk_oit oit;
    (void)state;
    assert_non_null(found);
    open_mode(HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_NATIVE);
    run_passes();
    oit = oit_of(NULL);
    oit.color = &color;
    oit.opaque = color.view;
    oit.scale = 0x1p-16f; /* of sums that are as bright as can be */
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    halves = gpu_map(&device, &vk.texels);
    for (size_t i = 0; i < 4u * count; ++i) {
        halves[i] = (uint16_t)(0x3c00u + i % 100u);
    }
    gpu_unmap(&device, &vk.texels);
    gpu_upload(gpu_begin(&device), &vk.texels, &color, VK_IMAGE_ASPECT_COLOR_BIT);
    assert_int_equal(hdrp_gpu_vk_oit_composite(&gpu, device.commands, &oit), HDRP_OK);
    gpu_run(&device);
    download(&color, found);
    for (size_t i = 0; i < count; ++i) {
        for (uint32_t k = 0; k < 4; ++k) {
            float was = hdrp_pack_float_from_half(0x3c00u + (uint32_t)(4u * i + k) % 100u);
            float is = components_of(&found[i])[k];
            assert_true(l->depth_own[i] ? is >= 0.0f && is <= 65504.0f : is == was);
        }
    }
    close_mode();
    free(found);
    hdrp_gpu_vk_image_destroy(&gpu, &color);
}

static void set_up_drawing(void)
{
    float* texels;
    vk.vertex = make_module(oit_stream_vert, sizeof oit_stream_vert);
    vk.fragment[0] = make_module(oit_stream_frag1, sizeof oit_stream_frag1);
    vk.fragment[1] = make_module(oit_stream_frag2, sizeof oit_stream_frag2);
    vk.fragment[2] = make_module(oit_stream_frag3, sizeof oit_stream_frag3);
    vk.fragment[3] = make_module(oit_stream_frag4, sizeof oit_stream_frag4);
    vk.fragment[4] = make_module(oit_stream_frag5, sizeof oit_stream_frag5);
    make_layout();
    make_layers(25, 17, 13, 9);
    vk.points = gpu_host_buffer(&gpu, FRAGMENTS_MAX * sizeof(point));
    vk.texels = gpu_host_buffer(&gpu, 64u * 64u * 16u);
    vk.nothing = make_image(VK_FORMAT_R32G32B32A32_SFLOAT, 1, 1, 0u);
    vk.opaque = make_image(VK_FORMAT_R32G32B32A32_SFLOAT, layers[0].width, layers[0].height,
                           VK_IMAGE_USAGE_STORAGE_BIT);
    vk.composed = make_image(VK_FORMAT_R32G32B32A32_SFLOAT, layers[0].width, layers[0].height,
                             VK_IMAGE_USAGE_STORAGE_BIT);
    texels = gpu_map(&device, &vk.texels);
    for (uint32_t i = 0; i < layers[0].width * layers[0].height; ++i) {
        hdrp_v3 c = behind_of(i % layers[0].width, i / layers[0].width);
        const float rgba[4] = {c.x, c.y, c.z, 0.25f};
        memcpy(texels + 4 * i, rgba, sizeof rgba);
    }
    gpu_unmap(&device, &vk.texels);
    gpu_begin(&device);
    gpu_upload(device.commands, &vk.texels, &vk.nothing, VK_IMAGE_ASPECT_COLOR_BIT);
    gpu_upload(device.commands, &vk.texels, &vk.opaque, VK_IMAGE_ASPECT_COLOR_BIT);
    gpu_run(&device);
}

static void tear_down_drawing(void)
{
    for (uint32_t i = 0; i < 2; ++i) {
        stream_free(&layers[i].all);
        stream_free(&layers[i].own);
        free(layers[i].depth_all);
        free(layers[i].depth_own);
    }
    hdrp_gpu_vk_image_destroy(&gpu, &vk.composed);
    hdrp_gpu_vk_image_destroy(&gpu, &vk.opaque);
    hdrp_gpu_vk_image_destroy(&gpu, &vk.nothing);
    hdrp_gpu_vk_buffer_destroy(&gpu, &vk.texels);
    hdrp_gpu_vk_buffer_destroy(&gpu, &vk.points);
    vkDestroyDescriptorPool(device.device, vk.pool, NULL);
    vkDestroyPipelineLayout(device.device, vk.layout, NULL);
    vkDestroyDescriptorSetLayout(device.device, vk.set_layout, NULL);
    for (uint32_t i = 0; i < 5; ++i) {
        vkDestroyShaderModule(device.device, vk.fragment[i], NULL);
    }
    vkDestroyShaderModule(device.device, vk.vertex, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(modes_are_those_of_the_cpu),
        cmocka_unit_test(compact_targets_are_those_of_the_cpu),
        cmocka_unit_test(order_changes_no_more_than_rounding),
        cmocka_unit_test(attachments_blend_as_described),
        cmocka_unit_test(what_targets_lack_has_a_name),
        cmocka_unit_test(composites_out_of_range_are_refused),
        cmocka_unit_test(composites_in_place_stay_finite),
    };
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    hdrp_gpu_vk_desc desc;
    int failed;
    if (!gpu_open(&device)) {
        return GPU_SKIPPED;
    }
    vkGetPhysicalDeviceQueueFamilyProperties(device.physical, &count, families);
    if (!(families[device.family].queueFlags & VK_QUEUE_GRAPHICS_BIT) ||
        !device.features.shaderStorageImageWriteWithoutFormat ||
        !device.features.independentBlend) {
        puts("skipped: the queue family draws nothing, or the device lacks a feature");
        gpu_close(&device);
        return GPU_SKIPPED;
    }
    desc = gpu_desc(&device);
    desc.passes = HDRP_GPU_VK_PASS_OIT;
    if (hdrp_gpu_vk_init(&gpu, &desc) != HDRP_OK) {
        return 1;
    }
    set_up_drawing();
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    tear_down_drawing();
    hdrp_gpu_vk_destroy(&gpu);
    gpu_close(&device);
    return failed || device.messages;
}
