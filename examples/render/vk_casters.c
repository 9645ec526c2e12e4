/* Shadow maps are drawn. */
#include "vk_frame.h"

#include "shadow_mask_frag.h"
#include "shadow_vert.h"

#include <string.h>

/* Casters in front of the nearest depth count for directional lights alone. */
static VkPipeline pipeline_of(rd_vk* vk, bool masked, bool clamped)
{
    VkPipeline* p = &vk->casters[masked][clamped];
    const uint32_t constants[3] = {0, 0, rd_vk_is_coarse(&vk->device)};
    rd_vk_pipeline_desc desc;
    if (*p || vk->device.report->failed) {
        return *p;
    }
    memset(&desc, 0, sizeof desc);
    desc.vertex.words = spirv_shadow_vert;
    desc.vertex.bytes = sizeof spirv_shadow_vert;
    if (masked) {
        desc.fragment.words = spirv_shadow_mask_frag;
        desc.fragment.bytes = sizeof spirv_shadow_mask_frag;
    }
    desc.constants = constants;
    desc.constant_count = 3;
    desc.pass = RD_VK_PASS_DEPTH; /* compatible with that of the atlas */
    desc.compare = VK_COMPARE_OP_GREATER;
    desc.writes_depth = true;
    desc.clamps_depth = clamped && vk->device.features.depthClamp;
    rd_vk_pipeline_make(&vk->raster, &vk->device, &desc, p);
    return *p;
}

/* No part of a ball is in front of a plane. */
static bool is_behind(hdrp_v4 plane, hdrp_v4 ball)
{
    hdrp_v3 n = hdrp_v3_from_v4(plane);
    return hdrp_v3_dot(n, hdrp_v3_from_v4(ball)) + plane.w < -hdrp_v3_length(n) * ball.w;
}

static hdrp_v4 plus(hdrp_v4 a, hdrp_v4 b, float sign)
{
    return hdrp_v4_make(a.x + sign * b.x, a.y + sign * b.y, a.z + sign * b.z, a.w + sign * b.w);
}

static bool is_outside(const hdrp_shadow_view* v, hdrp_v4 ball)
{
    return is_behind(plus(v->clip_w, v->clip_x, 1.0f), ball) ||
           is_behind(plus(v->clip_w, v->clip_x, -1.0f), ball) ||
           is_behind(plus(v->clip_w, v->clip_y, 1.0f), ball) ||
           is_behind(plus(v->clip_w, v->clip_y, -1.0f), ball);
}

static bool is_cascade(const rd_vk_shadow* s, uint32_t view)
{
    return s->views[view].ball.w > 0.0f;
}

static void draw_mesh(rd_vk* vk, uint32_t view, uint32_t mesh)
{
    const rd_mesh* m = &vk->scene.scene->meshes[mesh];
    bool masked = vk->scene.scene->materials[m->material].alpha_mode == RD_ALPHA_MASK;
    VkPipeline p = pipeline_of(vk, masked, is_cascade(&vk->light.shadow, view));
    const uint32_t push[4] = {mesh, 0, view, 0};
    VkCommandBuffer commands = vk->device.commands;
    if (!p) {
        return;
    }
    if (p != vk->bound) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p);
        vk->bound = p;
    }
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, vk->raster.layout, 1, 1,
                            &vk->scene.material_sets[m->material], 0, NULL);
    vkCmdPushConstants(commands, vk->raster.layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                       push);
    vkCmdDraw(commands, m->triangle_count * 3, 1, 0, 0);
}

static void draw_view(rd_vk* vk, uint32_t view)
{
    const hdrp_shadow_view* v = &vk->light.shadow.views[view];
    hdrp_gpu_vk_shadow_raster raster = hdrp_gpu_vk_shadow_raster_of(v);
    VkClearAttachment clear;
    VkClearRect square = {raster.scissor, 0, 1};
    memset(&clear, 0, sizeof clear);
    clear.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
    clear.clearValue.depthStencil = raster.far_away;
    vkCmdSetViewport(vk->device.commands, 0, 1, &raster.viewport);
    vkCmdSetScissor(vk->device.commands, 0, 1, &raster.scissor);
    vkCmdClearAttachments(vk->device.commands, 1, &clear, 1, &square);
    for (int i = 0; i < vk->scene.scene->mesh_count; ++i) {
        const rd_mesh* m = &vk->scene.scene->meshes[i];
        if (!rd_material_is_layer(&vk->scene.scene->materials[m->material]) &&
            !is_outside(v, vk->scene.balls[i])) {
            draw_mesh(vk, view, (uint32_t)i);
        }
    }
}

void rd_vk_draw_shadows(rd_vk* vk)
{
    rd_vk_shadow* s = &vk->light.shadow;
    const VkImageLayout drawn = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    const VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    VkRenderPassBeginInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                  .renderPass = s->pass,
                                  .framebuffer = s->framebuffer};
    info.renderArea.extent.width = s->atlas.base.width_px;
    info.renderArea.extent.height = s->atlas.base.height_px;
    rd_vk_layout(&vk->device, &s->atlas, s->still_drawn ? read : VK_IMAGE_LAYOUT_UNDEFINED, drawn);
    vkCmdBeginRenderPass(vk->device.commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    vk->bound = VK_NULL_HANDLE;
    rd_vk_bind_frame(vk, 0);
    for (uint32_t i = 0; i < s->view_count; ++i) {
        if (!s->still_drawn || is_cascade(s, i)) {
            draw_view(vk, i);
        }
    }
    vkCmdEndRenderPass(vk->device.commands);
    rd_vk_layout(&vk->device, &s->atlas, drawn, read);
    s->still_drawn = true;
    rd_vk_mark(&vk->device, "shadow maps");
}

void rd_vk_casters_free(rd_vk* vk)
{
    for (int i = 0; i < 4; ++i) {
        vkDestroyPipeline(vk->device.device, vk->casters[i / 2][i % 2], NULL);
    }
}
