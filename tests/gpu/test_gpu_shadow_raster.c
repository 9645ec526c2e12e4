/* test_gpu_shadow_raster.c - maps that a device has drawn, with the views and the state of hdrp.
 * SPDX-License-Identifier: MIT */
#include "gpu_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../shadow_scene.h"
#include "shadow_vert.h"

#define ATLAS 256u

static gpu_device device;
static hdrp_gpu_vk gpu;

/* What is drawn with. */
static struct {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipelineLayout layout;
} vk;

static int set_up(void** state)
{
    const hdrp_gpu_vk_desc desc = gpu_desc(&device);
    (void)state;
    return hdrp_gpu_vk_init(&gpu, &desc) != HDRP_OK;
}

static int tear_down(void** state)
{
    (void)state;
    hdrp_gpu_vk_destroy(&gpu);
    return device.messages != 0;
}

static float uniform(float lo, float hi)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (float)(state >> 40) * 0x1p-24f;
}

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

static hdrp_v3 direction(void)
{
    return hdrp_sphere_uniform(hdrp_v2_make(uniform(0.0f, 1.0f), uniform(0.0f, 1.0f)));
}

/* ---- Vulkan ---------------------------------------------------------------------------------- */

static void make_image(void)
{
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = VK_FORMAT_D32_SFLOAT,
                                    .extent = {ATLAS, ATLAS, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                  .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                  .format = VK_FORMAT_D32_SFLOAT,
                                  .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
    VkMemoryAllocateInfo memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    VkMemoryRequirements needs;
    assert_int_equal(vkCreateImage(device.device, &info, NULL, &vk.image), VK_SUCCESS);
    vkGetImageMemoryRequirements(device.device, vk.image, &needs);
    memory.allocationSize = needs.size;
    while (!(needs.memoryTypeBits >> memory.memoryTypeIndex & 1u)) {
        ++memory.memoryTypeIndex;
    }
    assert_int_equal(vkAllocateMemory(device.device, &memory, NULL, &vk.memory), VK_SUCCESS);
    assert_int_equal(vkBindImageMemory(device.device, vk.image, vk.memory, 0), VK_SUCCESS);
    view.image = vk.image;
    assert_int_equal(vkCreateImageView(device.device, &view, NULL, &vk.view), VK_SUCCESS);
}

static void make_pass(void)
{
    const VkAttachmentDescription depth = {.format = VK_FORMAT_D32_SFLOAT,
                                           .samples = VK_SAMPLE_COUNT_1_BIT,
                                           .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                           .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .pDepthStencilAttachment = &reference};
    const VkSubpassDependency after = {.srcSubpass = 0,
                                       .dstSubpass = VK_SUBPASS_EXTERNAL,
                                       .srcStageMask = VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
                                       .srcAccessMask =
                                           VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                       .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
    const VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &depth,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1,
                                         .pDependencies = &after};
    const VkPushConstantRange range = {VK_SHADER_STAGE_VERTEX_BIT, 0, 64};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .attachmentCount = 1,
                                           .pAttachments = &vk.view,
                                           .width = ATLAS,
                                           .height = ATLAS,
                                           .layers = 1};
    assert_int_equal(vkCreateRenderPass(device.device, &pass, NULL, &vk.pass), VK_SUCCESS);
    framebuffer.renderPass = vk.pass;
    assert_int_equal(vkCreateFramebuffer(device.device, &framebuffer, NULL, &vk.framebuffer),
                     VK_SUCCESS);
    assert_int_equal(vkCreatePipelineLayout(device.device, &layout, NULL, &vk.layout), VK_SUCCESS);
}

static VkPipeline make_pipeline(const hdrp_gpu_vk_shadow_raster* raster)
{
    const VkShaderModuleCreateInfo code = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                           .codeSize = sizeof shadow_vert,
                                           .pCode = shadow_vert};
    VkPipelineShaderStageCreateInfo stage = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = VK_SHADER_STAGE_VERTEX_BIT,
        .pName = "main"};
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP};
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &raster->viewport,
        .scissorCount = 1,
        .pScissors = &raster->scissor};
    const VkPipelineRasterizationStateCreateInfo rasterization = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .depthBiasEnable = raster->depth_bias,
        .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = raster->compare};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 1,
                                         .pVertexInputState = &input,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewport,
                                         .pRasterizationState = &rasterization,
                                         .pMultisampleState = &samples,
                                         .pDepthStencilState = &depth};
    VkPipeline pipeline = VK_NULL_HANDLE;
    assert_int_equal(vkCreateShaderModule(device.device, &code, NULL, &stage.module), VK_SUCCESS);
    info.pStages = &stage;
    info.layout = vk.layout;
    info.renderPass = vk.pass;
    assert_int_equal(
        vkCreateGraphicsPipelines(device.device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
        VK_SUCCESS);
    vkDestroyShaderModule(device.device, stage.module, NULL);
    return pipeline;
}

static void destroy(void)
{
    vkDestroyPipelineLayout(device.device, vk.layout, NULL);
    vkDestroyFramebuffer(device.device, vk.framebuffer, NULL);
    vkDestroyRenderPass(device.device, vk.pass, NULL);
    vkDestroyImageView(device.device, vk.view, NULL);
    vkDestroyImage(device.device, vk.image, NULL);
    vkFreeMemory(device.device, vk.memory, NULL);
}

/* ---- drawing --------------------------------------------------------------------------------- */

/* A square of the plane, of 60 m, as the vertex shader wants it. */
static hdrp_v4 row_of(hdrp_v4 row, hdrp_v3 corner, hdrp_v3 x, hdrp_v3 y)
{
    hdrp_v3 a = hdrp_v3_from_v4(row);
    return hdrp_v4_make(hdrp_v3_dot(a, x), hdrp_v3_dot(a, y), 0.0f, hdrp_v3_dot(a, corner) + row.w);
}

/* Draws the plane of a scene into the square of a view; to be freed. */
static float* rasterise(const hdrp_shadow_view* v, const scene* s)
{
    const hdrp_gpu_vk_shadow_raster raster = hdrp_gpu_vk_shadow_raster_of(v);
    const VkClearValue cleared = {.depthStencil = raster.far_away};
    const VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = vk.pass,
                                        .framebuffer = vk.framebuffer,
                                        .renderArea = {{0, 0}, {ATLAS, ATLAS}},
                                        .clearValueCount = 1,
                                        .pClearValues = &cleared};
    const VkBufferImageCopy all = {.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1},
                                   .imageExtent = {ATLAS, ATLAS, 1}};
    hdrp_basis b = hdrp_basis_from_normal(s->n);
    hdrp_v3 x = hdrp_v3_scale(b.tangent, 60.0f), y = hdrp_v3_scale(b.bitangent, 60.0f);
    hdrp_v3 corner = hdrp_v3_mad(hdrp_v3_mad(hdrp_v3_scale(s->n, s->distance), x, -0.5f), y, -0.5f);
    const hdrp_v4 rows[4] = {row_of(v->clip_x, corner, x, y), row_of(v->clip_y, corner, x, y),
                             row_of(v->clip_z, corner, x, y), row_of(v->clip_w, corner, x, y)};
    hdrp_gpu_vk_buffer result = gpu_host_buffer(&gpu, ATLAS * ATLAS * sizeof(float));
    VkPipeline pipeline = make_pipeline(&raster);
    VkCommandBuffer commands = gpu_begin(&device);
    float* texels = malloc(ATLAS * ATLAS * sizeof *texels);
    assert_non_null(texels);
    vkCmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdPushConstants(commands, vk.layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof rows, rows);
    vkCmdDraw(commands, 4, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    vkCmdCopyImageToBuffer(commands, vk.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, result.buffer,
                           1, &all);
    gpu_run(&device);
    memcpy(texels, gpu_map(&device, &result), ATLAS * ATLAS * sizeof *texels);
    gpu_unmap(&device, &result);
    hdrp_gpu_vk_buffer_destroy(&gpu, &result);
    vkDestroyPipeline(device.device, pipeline, NULL);
    return texels;
}

/* Depths are those of rays, to within what a twentieth of a texel changes, which is what the bias
 * leaves to rasterisers; and what is drawn is lit. */
static void expect_traced(const hdrp_shadow_view* v, const scene* s)
{
    float* drawn = rasterise(v, s);
    float* traced = calloc(ATLAS * ATLAS, sizeof *traced);
    const hdrp_shadow_atlas atlas = {drawn, ATLAS, ATLAS, 0};
    float clear = v->bias.w < 0.0f ? 0.0f : 1.0f;
    hdrp_basis b = hdrp_basis_from_normal(s->n);
    hdrp_v3 lit =
        hdrp_v3_dot(s->n, hdrp_v3_from_v4(v->axis_texel)) > 0.0f ? s->n : hdrp_v3_neg(s->n);
    uint32_t compared = 0;
    assert_non_null(traced);
    scene_draw(v, s, traced, ATLAS);
    for (uint32_t y = (uint32_t)v->limits.y + 1; y < (uint32_t)v->limits.w; ++y) {
        for (uint32_t x = (uint32_t)v->limits.x + 1; x < (uint32_t)v->limits.z; ++x) {
            const float* t = traced + y * ATLAS + x;
            float slope = hdrp_max(fabsf(t[1] - t[-1]), fabsf(t[ATLAS] - t[-(int)ATLAS]));
            bool whole = t[1] != clear && t[-1] != clear && t[ATLAS] != clear &&
                         t[-(int)ATLAS] != clear && *t != clear;
            float found = drawn[y * ATLAS + x];
            if (whole && found != clear) {
                assert_true(fabsf(found - *t) <= 0.025f * slope + 2e-6f);
                ++compared;
            }
        }
    }
    assert_true(drawn[0] == clear); /* nothing is drawn beside the square */
    for (int i = 0; i < 300 && compared > 0; ++i) {
        hdrp_v3 p =
            hdrp_v3_mad(hdrp_v3_scale(s->n, s->distance), b.tangent, uniform(-20.0f, 20.0f));
        p = hdrp_v3_mad(p, b.bitangent, uniform(-20.0f, 20.0f));
        assert_true(hdrp_shadow_visibility(&atlas, v, p, lit) > 0.999999f);
    }
    assert_true(compared > 1000u);
    free(drawn);
    free(traced);
}

/* ---- tests ----------------------------------------------------------------------------------- */

static void maps_of_parallel_light_are_drawn_as_traced(void** state)
{
    (void)state;
    for (uint32_t i = 0; i < 16; ++i) {
        hdrp_shadow_settings s = hdrp_shadow_settings_make(i & 3u, i >> 2 & 1u);
        hdrp_v3 l = direction();
        hdrp_v3 n = hdrp_v3_normalize(hdrp_v3_mad(l, direction(), i < 8 ? 0.6f : 0.97f));
        scene plane = {n, uniform(-3.0f, 3.0f), {0.0f, 0.0f, 0.0f}, 0.0f};
        hdrp_shadow_view v =
            hdrp_shadow_view_ball(hdrp_v4_make(0.0f, 0.0f, 0.0f, 8.0f), hdrp_v3_neg(l), 40.0f,
                                  hdrp_u32x4_make(64, 128, 128, 0), s);
        expect_traced(&v, &plane);
    }
}

static void maps_of_spots_are_drawn_as_traced(void** state)
{
    (void)state;
    for (uint32_t i = 0; i < 16; ++i) {
        hdrp_shadow_settings s = hdrp_shadow_settings_make(i & 3u, i >> 2 & 1u);
        hdrp_v3 l = direction();
        hdrp_v3 n = hdrp_v3_normalize(hdrp_v3_mad(l, direction(), 0.5f));
        scene plane = {n, 0.0f, {0.0f, 0.0f, 0.0f}, 0.0f};
        hdrp_light light = hdrp_light_spot(hdrp_v3_scale(l, 6.0f), hdrp_v3_neg(l),
                                           v3(1.0f, 1.0f, 1.0f), 60.0f, 0.3f, 0.7f);
        hdrp_shadow_view v =
            hdrp_shadow_view_light(light, 0, 0.2f, hdrp_u32x4_make(128, 64, 128, 0), s);
        expect_traced(&v, &plane);
    }
}

static void faces_of_points_are_drawn_as_traced(void** state)
{
    (void)state;
    for (uint32_t face = 0; face < 6; ++face) {
        hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 1);
        hdrp_v3 axis = hdrp_shadow_face_axis(face);
        hdrp_v3 n = hdrp_v3_normalize(hdrp_v3_mad(hdrp_v3_neg(axis), direction(), 0.3f));
        hdrp_light light =
            hdrp_light_point(hdrp_v3_scale(axis, -6.0f), v3(1.0f, 1.0f, 1.0f), 60.0f);
        scene plane = {n, 0.0f, {0.0f, 0.0f, 0.0f}, 0.0f};
        hdrp_shadow_view v =
            hdrp_shadow_view_light(light, face, 0.2f, hdrp_u32x4_make(64, 64, 128, 0), s);
        expect_traced(&v, &plane);
    }
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(maps_of_parallel_light_are_drawn_as_traced),
        TEST(maps_of_spots_are_drawn_as_traced),
        TEST(faces_of_points_are_drawn_as_traced),
    };
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    int failed;
    if (!gpu_open(&device)) {
        return GPU_SKIPPED;
    }
    vkGetPhysicalDeviceQueueFamilyProperties(device.physical, &count, families);
    if (!(families[device.family].queueFlags & VK_QUEUE_GRAPHICS_BIT) ||
        !device.features.shaderStorageImageWriteWithoutFormat) {
        puts("skipped: the queue family draws nothing, or the device lacks a feature");
        gpu_close(&device);
        return GPU_SKIPPED;
    }
    make_image();
    make_pass();
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    destroy();
    gpu_close(&device);
    return failed || device.messages;
}
