/* The order of the passes, and the film. */
#include "vk_frame.h"

#include <string.h>

static void depth_prepass(rd_vk* vk)
{
    rd_vk_pass_begin(&vk->raster, &vk->device, RD_VK_PASS_DEPTH);
    rd_vk_draw_meshes(vk, RD_VK_PROGRAM_DEPTH, RD_VK_SOLID);
    rd_vk_draw_meshes(vk, RD_VK_PROGRAM_MASK, RD_VK_MASKED);
    rd_vk_pass_end(&vk->device);
    rd_vk_mark(&vk->device, "depth prepass");
}

/* Depth from now on is only tested and read. */
static void keep_depth(rd_vk* vk)
{
    rd_vk_layout(&vk->device, &vk->raster.targets[RD_VK_DEPTH],
                 VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
}

static void clear_lit(rd_vk* vk, VkImageLayout after)
{
    const VkClearColorValue zero = {{0.0f, 0.0f, 0.0f, 0.0f}};
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    const rd_vk_image* lit = &vk->raster.targets[RD_VK_LIT];
    rd_vk_layout(&vk->device, lit, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdClearColorImage(vk->device.commands, lit->base.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         &zero, 1, &all);
    rd_vk_layout(&vk->device, lit, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, after);
}

static void view(rd_vk* vk, const rd_sub_frame* s)
{
    clear_lit(vk, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    rd_vk_pass_begin(&vk->raster, &vk->device, RD_VK_PASS_LIT);
    rd_vk_draw_meshes(vk, RD_VK_PROGRAM_VIEW, RD_VK_ALL);
    if (rd_view_stage_of(s->r->options->view) == RD_STAGE_MATERIAL) {
        rd_vk_draw_layers(vk, RD_VK_PROGRAM_VIEW_LAYER);
    }
    rd_vk_pass_end(&vk->device);
    rd_vk_mark(&vk->device, "view");
}

static void gbuffer(rd_vk* vk)
{
    rd_vk_pass_begin(&vk->raster, &vk->device, RD_VK_PASS_GBUFFER);
    rd_vk_draw_meshes(vk, RD_VK_PROGRAM_GBUFFER, RD_VK_ALL);
    rd_vk_pass_end(&vk->device);
    for (int i = RD_VK_RT0; i <= RD_VK_NORMALS; ++i) {
        rd_vk_layout(&vk->device, &vk->raster.targets[i], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    rd_vk_mark(&vk->device, "GBuffer");
}

/* The camera of lists and lighting: as in lists.c, samples are the centres of its pixels. */
static hdrp_cull_camera cull_camera(const rd_vk* vk, const rd_sub_frame* s)
{
    const rd_camera* c = &s->r->camera;
    float w = (float)c->width_px, h = (float)c->height_px;
    float x = s->jitter.x - 0.5f, y = s->jitter.y - 0.5f;
    float left = (2.0f * x / w - 1.0f) * c->half_width;
    float right = (2.0f * (x + w) / w - 1.0f) * c->half_width;
    float top = (1.0f - 2.0f * y / h) * c->half_height;
    float bottom = (1.0f - 2.0f * (y + h) / h) * c->half_height;
    float near_m = vk->values.depths_exposure.x;
    return (c->orthographic ? hdrp_cull_camera_orthographic : hdrp_cull_camera_perspective)(
        c->eye, c->forward, c->up, left, right, bottom, top, near_m, HDRP_CULL_FAR_INFINITE);
}

static bool deferred(rd_vk* vk, const rd_sub_frame* s)
{
    rd_vk_device* d = &vk->device;
    const rd_vk_image* lit = &vk->raster.targets[RD_VK_LIT];
    hdrp_cull_camera camera = cull_camera(vk, s);
    hdrp_v4 at = vk->values.depths_exposure;
    bool ok = rd_vk_check_hdrp(d, hdrp_gpu_vk_begin_frame(&d->gpu, 0), "a frame") &&
              rd_vk_light_begin(&vk->light, d, &vk->raster, &camera, hdrp_v2_make(at.x, at.y),
                                s->r->exposure);
    clear_lit(vk, VK_IMAGE_LAYOUT_GENERAL);
    ok = ok && rd_vk_light_deferred(&vk->light, d, &vk->raster);
    rd_vk_layout(d, lit, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    return ok;
}

static void forward(rd_vk* vk)
{
    rd_vk_pass_begin(&vk->raster, &vk->device, RD_VK_PASS_LIT);
    rd_vk_draw_meshes(vk, RD_VK_PROGRAM_FORWARD, RD_VK_FORWARD);
    rd_vk_draw_screen(vk, RD_VK_PROGRAM_SKY);
    rd_vk_pass_end(&vk->device);
    rd_vk_mark(&vk->device, "forward opaque and sky");
}

static void draw_layers(rd_vk* vk, rd_vk_pass pass, rd_vk_program program)
{
    rd_vk_pass_begin(&vk->raster, &vk->device, pass);
    rd_vk_draw_layers(vk, program);
    rd_vk_pass_end(&vk->device);
}

/* Glass does not see what is straight behind it: its light and what it lets through are kept apart
 * from the opaque picture. */
static void glass(rd_vk* vk)
{
    rd_vk_keep_opaque(vk);
    draw_layers(vk, RD_VK_PASS_LAYERS, RD_VK_PROGRAM_LAYER_APART);
    draw_layers(vk, RD_VK_PASS_BEHIND, RD_VK_PROGRAM_BEND);
    for (int i = RD_VK_LAYER_LIGHT; i <= RD_VK_LAYER_DIRECTION; ++i) {
        rd_vk_layout(&vk->device, &vk->raster.targets[i], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    rd_vk_pass_begin(&vk->raster, &vk->device, RD_VK_PASS_LIT);
    rd_vk_draw_screen(vk, RD_VK_PROGRAM_COMPOSITE);
    rd_vk_pass_end(&vk->device);
}

static void transparent(rd_vk* vk)
{
    if (rd_vk_has_glass(vk)) {
        glass(vk);
    } else {
        draw_layers(vk, RD_VK_PASS_LIT, RD_VK_PROGRAM_LAYER);
    }
    rd_vk_mark(&vk->device, "transparent surfaces");
}

/* The order of the talk. */
static bool lighting(rd_vk* vk, const rd_sub_frame* s)
{
    gbuffer(vk);
    keep_depth(vk);
    if (!deferred(vk, s)) {
        return false;
    }
    forward(vk);
    if (vk->order.count > 0) {
        transparent(vk);
    }
    return !rd_vk_has_blended(vk) || rd_vk_draw_blended(vk);
}

static void read_back(rd_vk* vk)
{
    const rd_vk_image* lit = &vk->raster.targets[RD_VK_LIT];
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = {vk->raster.width, vk->raster.height, 1}};
    rd_vk_layout(&vk->device, lit, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(vk->device.commands, lit->base.image,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk->picture.buffer.buffer, 1,
                           &region);
    rd_vk_barrier(&vk->device);
    rd_vk_mark(&vk->device, "read back");
}

/* The film holds nits, or what a view shows. */
static void add_to_film(rd_vk* vk, rd_renderer* r)
{
    size_t pixels = (size_t)r->width * (size_t)r->height;
    const float* from = (const float*)vk->picture.at;
    float k = rd_vk_is_lit(r) ? 1.0f / r->exposure : 1.0f;
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            r->film[i * 4 + c] += from[i * 4 + c] * k;
        }
        r->film[i * 4 + 3] += from[i * 4 + 3];
    }
}

static bool sub_frame(rd_vk* vk, const rd_sub_frame* s)
{
    rd_vk_fill_frame(vk, s);
    if (!rd_vk_begin(&vk->device)) {
        return false;
    }
    depth_prepass(vk);
    if (rd_vk_is_lit(s->r)) {
        lighting(vk, s);
    } else {
        keep_depth(vk);
        view(vk, s);
    }
    read_back(vk);
    if (vk->device.report->failed || !rd_vk_run(&vk->device)) {
        return false;
    }
    vk->dropped += rd_vk_lists_dropped(&vk->light.lists);
    add_to_film(vk, s->r);
    return true;
}

/* Once for all samples: cascades do not move with them. */
static bool shadows(rd_vk* vk, const rd_renderer* r)
{
    rd_vk_shadow* s = &vk->light.shadow;
    if (!s->present) {
        return true;
    }
    if (!rd_vk_shadow_aim(s, &vk->device, r, vk->light.lists.items) || !rd_vk_begin(&vk->device)) {
        return false;
    }
    rd_vk_draw_shadows(vk);
    return !vk->device.report->failed && rd_vk_run(&vk->device);
}

bool rd_vk_render(rd_vk* vk, rd_renderer* r, const rd_camera* camera)
{
    size_t values = (size_t)r->width * (size_t)r->height * 4;
    rd_sub_frame s;
    bool ok = true;
    r->camera = *camera;
    s.r = r;
    memset(r->film, 0, values * sizeof *r->film);
    if (rd_vk_is_lit(r) && vk->oit.made_for != r->options->oit) {
        ok = rd_vk_oit_make(&vk->oit, &vk->device, r, &vk->raster, &vk->light.black);
    }
    rd_vk_order_sort(vk, camera);
    ok = ok && (!rd_vk_is_lit(r) || shadows(vk, r));
    for (int i = 0; ok && i < r->spp; ++i) {
        s.index = (uint32_t)i;
        s.jitter = rd_camera_jitter(s.index, r->options->seed);
        rd_progress_show(r->progress, "GPU", (double)i, (double)r->spp);
        ok = sub_frame(vk, &s);
    }
    for (size_t i = 0; i < values; ++i) {
        r->film[i] *= 1.0f / (float)r->spp;
    }
    rd_progress_end(r->progress);
    return ok;
}
