/* The Vulkan backend: what a frame reads, and how all of it comes and goes. */
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

void rd_vk_fill_frame(rd_vk* vk, const rd_sub_frame* s)
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
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
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
        &vk->device, vkCreateDescriptorSetLayout(vk->device.device, &info, NULL, &vk->frame_layout),
        "a layout of descriptors");
}

static bool make_frame_set(rd_vk* vk)
{
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, FRAME_BUFFERS}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    VkDescriptorSetAllocateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                       .descriptorSetCount = 1,
                                       .pSetLayouts = &vk->frame_layout};
    const VkBuffer buffers[1 + FRAME_BUFFERS] = {
        vk->frame.buffer.buffer,   vk->scene.meshes.buffer,  vk->scene.materials.buffer,
        vk->scene.vertices.buffer, vk->scene.indices.buffer, vk->order.buffer.buffer.buffer};
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
    if (stage == RD_STAGE_LISTS || view == RD_VIEW_DIFFUSE || view == RD_VIEW_SPECULAR ||
        view == RD_VIEW_LAYERS || view == RD_VIEW_AO) {
        return rd_fail(report, "--view", "%s needs --backend cpu", rd_view_name(view));
    }
    return true;
}

bool rd_vk_is_lit(const rd_renderer* r)
{
    return rd_view_stage_of(r->options->view) == RD_STAGE_LIGHTING;
}

static bool make_all(rd_vk* vk, const rd_renderer* r)
{
    const size_t pixels = (size_t)r->width * (size_t)r->height;
    VkDescriptorSetLayout layouts[4];
    vk->options = r->options;
    if (!rd_vk_scene_make(&vk->scene, &vk->device, r->scene) || !rd_vk_order_make(vk) ||
        !rd_vk_mapped_make(&vk->device, sizeof(rd_vk_frame), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                           &vk->frame) ||
        !rd_vk_mapped_make(&vk->device, pixels * 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           &vk->picture) ||
        !make_frame_layout(vk) || !rd_vk_light_layout_make(&vk->light, &vk->device) ||
        !rd_vk_oit_layout_make(&vk->oit, &vk->device)) {
        return false;
    }
    layouts[0] = vk->frame_layout;
    layouts[1] = vk->scene.material_layout;
    layouts[2] = vk->light.layout;
    layouts[3] = vk->oit.set_layout;
    return make_frame_set(vk) &&
           rd_vk_raster_make(&vk->raster, &vk->device, (uint32_t)r->width, (uint32_t)r->height,
                             layouts, 4) &&
           (!rd_vk_is_lit(r) ||
            (rd_vk_light_make(&vk->light, &vk->device, r, &vk->raster) &&
             rd_vk_oit_make(&vk->oit, &vk->device, r, &vk->raster, &vk->light.black)));
}

rd_vk* rd_vk_open(rd_renderer* r, rd_report* report)
{
    rd_vk* vk = can_show(r, report) ? (rd_vk*)calloc(1, sizeof *vk) : NULL;
    double begin = rd_now_ms(), others = r->stats ? rd_stats_passes_ms(r->stats) : 0.0;
    if (!vk) {
        rd_fail(report, "--backend vulkan", "out of memory"); /* unless there is an error already */
        return NULL;
    }
    if (!rd_vk_device_open(&vk->device, r->stats, report) || !make_all(vk, r)) {
        rd_vk_close(vk);
        return NULL;
    }
    if (r->stats) {
        others = rd_stats_passes_ms(r->stats) - others;
        rd_stats_pass(r->stats, "upload scene", rd_now_ms() - begin - others);
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
        rd_vk_oit_free(&vk->oit, &vk->device);
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

void rd_vk_count(const rd_vk* vk, rd_stats* stats)
{
    rd_stats_limit(stats, "lights_without_shadow_maps", (double)vk->light.shadow.without);
    rd_stats_limit(stats, "lights_without_lists", (double)vk->light.lists.left_out);
    rd_stats_limit(stats, "listed_lights_dropped", (double)vk->dropped);
}

unsigned rd_vk_messages(const rd_vk* vk)
{
    return vk->device.messages;
}

const char* rd_vk_device_name(const rd_vk* vk)
{
    return vk->device.properties.deviceName;
}
