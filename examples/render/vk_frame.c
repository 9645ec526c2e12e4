/* The Vulkan backend: what a frame reads, the order of its passes, its film. */
#include "vk_frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The nearest depth, as a share of the size of the scene: rays have none. */
#define NEAREST 1e-5f

/* >>what a frame reads */

static float size_of(const rd_scene* scene)
{
    hdrp_v3 d = hdrp_v3_sub(scene->bounds.high, scene->bounds.low);
    return scene->bounds.low.x <= scene->bounds.high.x ? hdrp_v3_length(d) : 1.0f;
}

/* Depths between which everything is. */
static hdrp_v2 depths_of(const rd_scene* scene, const rd_camera* c)
{
    float size = size_of(scene);
    hdrp_v3 center = hdrp_v3_scale(hdrp_v3_add(scene->bounds.low, scene->bounds.high), 0.5f);
    float middle = hdrp_v3_dot(hdrp_v3_sub(center, c->eye), c->forward);
    return c->orthographic ? hdrp_v2_make(0.0f, hdrp_max(middle, 0.0f) + size)
                           : hdrp_v2_make(hdrp_max(NEAREST * size, 1e-6f), HDRP_FLT_MAX);
}

static void set_camera(rd_vk_frame* f, const rd_camera* c, int spp)
{
    f->eye_step = hdrp_v4_from_v3(c->eye, hdrp_rsqrt((float)spp));
    f->right_half_width = hdrp_v4_from_v3(c->right, c->half_width);
    f->up_half_height = hdrp_v4_from_v3(c->up, c->half_height);
    f->forward_orthographic = hdrp_v4_from_v3(c->forward, c->orthographic ? 1.0f : 0.0f);
}

static void set_sky(rd_vk_frame* f, const rd_renderer* r)
{
    const rd_environment* e = r->lighting->environment;
    bool shown = r->options->view == RD_VIEW_LIT && r->options->features & RD_FEATURE_SKY;
    memset(&f->sky, 0, sizeof f->sky);
    memset(&f->to_sun, 0, sizeof f->to_sun);
    memset(&f->sun_nits, 0, sizeof f->sun_nits);
    if (!shown || !e->present) {
        return;
    }
    f->sky.x = e->seen.kind == HDRP_ENV_CUBE ? 2.0f : 1.0f;
    if (e->disc) {
        float diameter = e->sun.forward_radius.w;
        float per_lux = hdrp_light_nits_from_lux_sky_disc(1.0f, diameter);
        f->sky.y = hdrp_sq(sinf(0.5f * diameter));
        f->to_sun = hdrp_v4_from_v3(hdrp_v3_neg(hdrp_v3_from_v4(e->sun.forward_radius)), 0.0f);
        f->sun_nits = hdrp_v4_from_v3(
            hdrp_v3_scale(hdrp_v3_from_v4(e->sun.color_inv_range_sq), per_lux), 0.0f);
    }
}

static void fill_frame(rd_vk* vk, const rd_sub_frame* s)
{
    const rd_renderer* r = s->r;
    rd_vk_frame* f = &vk->values;
    hdrp_v2 depths = depths_of(r->scene, &r->camera);
    set_camera(f, &r->camera, r->spp);
    f->jitter_size = hdrp_v4_make(s->jitter.x, s->jitter.y, (float)r->width, (float)r->height);
    f->depths_exposure = hdrp_v4_make(depths.x, depths.y, r->exposure, 0.0f);
    f->bits[0] = r->options->features;
    f->bits[1] = rd_lighting_material_features(r->options->features);
    f->bits[2] = (uint32_t)r->options->view;
    f->bits[3] = r->options->path == RD_PATH_FORWARD;
    f->sample_of[0] = s->index;
    f->sample_of[1] = r->options->seed;
    set_sky(f, r);
    memcpy(vk->frame.at, f, sizeof *f);
}

/* >>descriptors */

#define FRAME_BUFFERS 5u

static bool make_frame_layout(rd_vk* vk)
{
    VkDescriptorSetLayoutBinding bindings[1 + FRAME_BUFFERS];
    VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1 + FRAME_BUFFERS,
        .pBindings = bindings};
    memset(bindings, 0, sizeof bindings);
    for (uint32_t i = 0; i <= FRAME_BUFFERS; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType =
            i ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    }
    return rd_vk_check(
        &vk->device,
        vkCreateDescriptorSetLayout(vk->device.device, &info, NULL, &vk->frame_layout),
        "a layout of descriptors");
}

static bool make_frame_set(rd_vk* vk)
{
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, FRAME_BUFFERS}};
    const VkDescriptorPoolCreateInfo pool = {.sType =
                                                 VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    VkDescriptorSetAllocateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                       .descriptorSetCount = 1,
                                       .pSetLayouts = &vk->frame_layout};
    const VkBuffer buffers[1 + FRAME_BUFFERS] = {
        vk->frame.buffer.buffer,    vk->scene.meshes.buffer,  vk->scene.materials.buffer,
        vk->scene.vertices.buffer,  vk->scene.indices.buffer, vk->order.buffer.buffer.buffer};
    VkDevice device = vk->device.device;
    if (!rd_vk_check(&vk->device, vkCreateDescriptorPool(device, &pool, NULL, &vk->pool),
                     "descriptors")) {
        return false;
    }
    set.descriptorPool = vk->pool;
    if (!rd_vk_check(&vk->device, vkAllocateDescriptorSets(device, &set, &vk->frame_set),
                     "descriptors")) {
        return false;
    }
    for (uint32_t i = 0; i <= FRAME_BUFFERS; ++i) {
        const VkDescriptorBufferInfo info = {buffers[i], 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                      .dstSet = vk->frame_set,
                                      .dstBinding = i,
                                      .descriptorCount = 1,
                                      .pBufferInfo = &info};
        write.descriptorType =
            i ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
    }
    return true;
}

/* >>opening */

/* Rays, lists and layers are looked at on the CPU alone. */
static bool can_show(const rd_renderer* r, rd_report* report)
{
    rd_view view = r->options->view;
    rd_view_stage stage = rd_view_stage_of(view);
    if (r->options->quality == RD_QUALITY_REFERENCE && stage == RD_STAGE_LIGHTING) {
        return rd_fail(report, "--quality reference", "needs --backend cpu");
    }
    if (stage == RD_STAGE_LISTS || view == RD_VIEW_DIFFUSE || view == RD_VIEW_SPECULAR || view == RD_VIEW_LAYERS || view == RD_VIEW_AO) {
        return rd_fail(report, "--view", "%s needs --backend cpu", rd_view_name(view));
    }
    return true;
}

static bool is_lit(const rd_renderer* r)
{
    return rd_view_stage_of(r->options->view) == RD_STAGE_LIGHTING;
}

static bool make_all(rd_vk* vk, const rd_renderer* r)
{
    const size_t pixels = (size_t)r->width * (size_t)r->height;
    VkDescriptorSetLayout layouts[3];
    if (!rd_vk_scene_make(&vk->scene, &vk->device, r->scene) || !rd_vk_order_make(vk) ||
        !rd_vk_mapped_make(&vk->device, sizeof(rd_vk_frame), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                           &vk->frame) ||
        !rd_vk_mapped_make(&vk->device, pixels * 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           &vk->picture) ||
        !make_frame_layout(vk) || !rd_vk_light_layout_make(&vk->light, &vk->device)) {
        return false;
    }
    layouts[0] = vk->frame_layout;
    layouts[1] = vk->scene.material_layout;
    layouts[2] = vk->light.layout;
    return make_frame_set(vk) &&
           rd_vk_raster_make(&vk->raster, &vk->device, (uint32_t)r->width, (uint32_t)r->height,
                             layouts, 3) &&
           (!is_lit(r) || rd_vk_light_make(&vk->light, &vk->device, r, &vk->raster));
}

rd_vk* rd_vk_open(rd_renderer* r, rd_report* report)
{
    rd_vk* vk = can_show(r, report) ? (rd_vk*)calloc(1, sizeof *vk) : NULL;
    double begin = rd_now_ms();
    if (!vk) {
        rd_fail(report, "--backend vulkan", "out of memory"); /* unless there is an error already */
        return NULL;
    }
    if (!rd_vk_device_open(&vk->device, r->stats, report) || !make_all(vk, r)) {
        rd_vk_close(vk);
        return NULL;
    }
    if (r->stats) {
        rd_stats_pass(r->stats, "upload scene", rd_now_ms() - begin);
    }
    return vk;
}

void rd_vk_close(rd_vk* vk)
{
    VkDevice device = vk ? vk->device.device : VK_NULL_HANDLE;
    if (!vk) {
        return;
    }
    if (device) {
        vkDeviceWaitIdle(device);
        rd_vk_programs_free(vk);
        rd_vk_casters_free(vk);
        vkDestroyDescriptorPool(device, vk->pool, NULL);
        vkDestroyDescriptorSetLayout(device, vk->frame_layout, NULL);
        rd_vk_light_free(&vk->light, &vk->device);
        rd_vk_raster_free(&vk->raster, &vk->device);
        rd_vk_mapped_free(&vk->device, &vk->frame);
        rd_vk_mapped_free(&vk->device, &vk->picture);
        rd_vk_order_free(vk);
        rd_vk_scene_free(&vk->scene, &vk->device);
    }
    rd_vk_device_close(&vk->device);
    free(vk);
}

unsigned rd_vk_messages(const rd_vk* vk)
{
    return vk->device.messages;
}

const char* rd_vk_device_name(const rd_vk* vk)
{
    return vk->device.properties.deviceName;
}

/* >>passes */

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
    vkCmdClearColorImage(vk->device.commands, lit->base.image,
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &zero, 1, &all);
    rd_vk_layout(&vk->device, lit, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 after);
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
    return true;
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
    float k = is_lit(r) ? 1.0f / r->exposure : 1.0f;
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            r->film[i * 4 + c] += from[i * 4 + c] * k;
        }
        r->film[i * 4 + 3] += from[i * 4 + 3];
    }
}

static bool sub_frame(rd_vk* vk, const rd_sub_frame* s)
{
    fill_frame(vk, s);
    if (!rd_vk_begin(&vk->device)) {
        return false;
    }
    depth_prepass(vk);
    if (is_lit(s->r)) {
        lighting(vk, s);
    } else {
        keep_depth(vk);
        view(vk, s);
    }
    read_back(vk);
    if (vk->device.report->failed || !rd_vk_run(&vk->device)) {
        return false;
    }
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
    rd_vk_order_sort(vk, camera);
    ok = !is_lit(r) || shadows(vk, r);
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
