#include "vk_shadow.h"

#include <stdlib.h>
#include <string.h>

#define ATLAS_PX    4096u
#define SMALLEST_PX 64u
#define CASCADE_PX  2048u
#define LIGHT_PX    512u
#define CASCADES    HDRP_SHADOW_CASCADES_MAX
/* Drawing more takes longer than a picture is worth. */
#define VIEWS_MAX 1024u
/* The nearest casters of a light, as a share of its range. */
#define NEAREST 2e-3f
/* How logarithmic the ends of cascades are. */
#define LOG_WEIGHT 0.7f

/* Reverse depth. */
static hdrp_shadow_settings settings(void)
{
    return hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_BILINEAR, 1u);
}

/* >>which lights get maps, and where */

static hdrp_shadow_request request_of(const hdrp_light* light, bool is_directional)
{
    hdrp_shadow_request r;
    hdrp_v3 color = hdrp_v3_from_v4(light->color_inv_range_sq);
    memset(&r, 0, sizeof r);
    if (!(light->bits.x & HDRP_LIGHT_FEATURE_SHADOW)) {
        return r;
    }
    r.importance = is_directional ? HDRP_FLT_MAX : hdrp_luminance(color);
    r.size_px = is_directional ? CASCADE_PX : LIGHT_PX;
    r.maps = is_directional ? CASCADES : hdrp_shadow_map_count(*light);
    return r;
}

/* Requests in the order of views: directional lights first. */
static uint32_t make_requests(const hdrp_light* records, uint32_t listed, uint32_t directional,
                              hdrp_shadow_request* requests, uint32_t* lights)
{
    uint32_t n = 0, views = 0;
    for (uint32_t i = 0; i < directional && n < HDRP_GPU_VK_SHADOW_LIGHTS; ++i) {
        requests[n] = request_of(&records[listed + i], true);
        lights[n] = listed + i;
        views += requests[n++].maps;
    }
    for (uint32_t i = 0; i < listed; ++i) {
        hdrp_shadow_request r = request_of(&records[i], false);
        if (r.maps > 0u && views + r.maps <= VIEWS_MAX) {
            requests[n] = r;
            lights[n++] = i;
            views += r.maps;
        }
    }
    return n;
}

static uint32_t maps_of(const hdrp_shadow_request* requests, uint32_t count)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; ++i) {
        n += requests[i].maps;
    }
    return n;
}

static void take_shadows(hdrp_light* records, uint32_t count, rd_vk_shadow* s)
{
    for (uint32_t i = 0; i < count; ++i) {
        s->without += (records[i].bits.x & HDRP_LIGHT_FEATURE_SHADOW) != 0u;
        records[i].bits.x &= ~HDRP_LIGHT_FEATURE_SHADOW;
        records[i].bits.z = HDRP_LIGHT_INDEX_NONE;
    }
}

/* Views that stand still are made here; those of cascades when the camera is known. */
static void assign(rd_vk_shadow* s, hdrp_light* records, const hdrp_shadow_request* r,
                   uint32_t light, bool is_directional)
{
    hdrp_light* l = &records[light];
    if (r->placed_px == 0u) {
        return;
    }
    l->bits.x |= HDRP_LIGHT_FEATURE_SHADOW;
    l->bits.z = r->first;
    --s->without;
    for (uint32_t k = 0; k < r->maps; ++k) {
        uint32_t view = r->first + k;
        s->light_of_view[view] = light;
        if (!is_directional) {
            /* What is inside of a lamp does not keep its light in. */
            float nearest_m = hdrp_max(NEAREST * l->position_range.w, l->forward_radius.w);
            s->views[view] = hdrp_shadow_view_light(*l, k, nearest_m, s->maps[view], settings());
        }
    }
}

static bool place(rd_vk_shadow* s, rd_vk_device* d, hdrp_light* records,
                  hdrp_shadow_request* requests, const uint32_t* lights, uint32_t count,
                  uint32_t listed)
{
    uint32_t* order = (uint32_t*)malloc(((size_t)count + 1) * sizeof *order);
    size_t maps = maps_of(requests, count);
    bool ok;
    s->view_count = (uint32_t)maps;
    s->maps = (hdrp_u32x4*)calloc(maps + 1, sizeof *s->maps);
    s->views = (hdrp_shadow_view*)calloc(maps + 1, sizeof *s->views);
    s->light_of_view = (uint32_t*)calloc(maps + 1, sizeof *s->light_of_view);
    ok = order && s->maps && s->views && s->light_of_view;
    ok = (ok || rd_fail(d->report, "--backend vulkan", "out of memory")) &&
         rd_vk_check_hdrp(
             d, hdrp_shadow_place(ATLAS_PX, SMALLEST_PX, requests, count, order, s->maps, NULL),
             "an atlas of shadows");
    for (uint32_t i = 0; ok && i < count; ++i) {
        bool is_directional = lights[i] >= listed;
        assign(s, records, &requests[i], lights[i], is_directional);
        if (is_directional) {
            s->cascades[i] = requests[i].placed_px ? requests[i].maps : 0u;
            s->masked = i + 1;
        }
    }
    free(order);
    return ok;
}

/* >>images */

/* Squares are cleared on their own: those of still lights stay. */
static bool make_pass(rd_vk_shadow* s, rd_vk_device* d)
{
    const VkImageLayout layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    const VkAttachmentDescription depth =
        rd_vk_attachment(VK_FORMAT_D32_SFLOAT, VK_ATTACHMENT_LOAD_OP_LOAD, layout);
    return rd_vk_pass_make(d, &depth, 0, layout, &s->pass) &&
           rd_vk_framebuffer_make(d, s->pass, &s->atlas.base.view, 1, ATLAS_PX, ATLAS_PX,
                                  &s->framebuffer);
}

static bool make_images(rd_vk_shadow* s, rd_vk_device* d, const rd_renderer* r)
{
    const rd_vk_image_desc desc = {VK_FORMAT_D32_SFLOAT,
                                   ATLAS_PX,
                                   ATLAS_PX,
                                   1,
                                   1,
                                   VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                       VK_IMAGE_USAGE_SAMPLED_BIT,
                                   VK_IMAGE_ASPECT_DEPTH_BIT};
    size_t bytes = (size_t)s->view_count * sizeof *s->views;
    return rd_vk_image_make(d, &desc, &s->atlas) && make_pass(s, d) &&
           rd_vk_check_hdrp(
               d,
               hdrp_gpu_vk_image_create(&d->gpu, VK_FORMAT_R8G8B8A8_UNORM, (uint32_t)r->width,
                                        (uint32_t)r->height,
                                        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                        "shadows", &s->visibility),
               "an image of shadows") &&
           rd_vk_mapped_make(d, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &s->buffer);
}

bool rd_vk_shadow_make(rd_vk_shadow* s, rd_vk_device* d, const rd_renderer* r, hdrp_light* records,
                       uint32_t listed, uint32_t directional)
{
    size_t most = (size_t)listed + directional + 1;
    hdrp_shadow_request* requests = (hdrp_shadow_request*)calloc(most, sizeof *requests);
    uint32_t* lights = (uint32_t*)calloc(most, sizeof *lights);
    uint32_t count = 0;
    bool casts = r->scene->bounds.low.x <= r->scene->bounds.high.x; /* else the scene is empty */
    bool on = (r->options->features & RD_FEATURE_SHADOWS) != 0 && casts, ok = true;
    memset(s, 0, sizeof *s);
    if (!requests || !lights) {
        ok = rd_fail(d->report, "--backend vulkan", "out of memory");
    } else if (on) {
        count = make_requests(records, listed, directional, requests, lights);
    }
    take_shadows(records, listed + directional, s);
    if (ok && maps_of(requests, count) > 0u) {
        ok = place(s, d, records, requests, lights, count, listed) && make_images(s, d, r);
        s->present = ok;
    }
    s->without = on ? s->without : 0u;
    free(requests);
    free(lights);
    return ok;
}

void rd_vk_shadow_free(rd_vk_shadow* s, rd_vk_device* d)
{
    rd_vk_image_free(d, &s->atlas);
    hdrp_gpu_vk_image_destroy(&d->gpu, &s->visibility);
    rd_vk_mapped_free(d, &s->buffer);
    vkDestroyFramebuffer(d->device, s->framebuffer, NULL);
    vkDestroyRenderPass(d->device, s->pass, NULL);
    free(s->light_of_view);
    free(s->maps);
    free(s->views);
    memset(s, 0, sizeof *s);
}

/* >>cascades */

/* Nearest and farthest depth of what the camera may see of the scene. */
static hdrp_v2 depths_of(const rd_renderer* r)
{
    const rd_bounds* b = &r->scene->bounds;
    const rd_camera* c = &r->camera;
    float nearest = HDRP_FLT_MAX, farthest = 0.0f;
    for (int i = 0; i < 8; ++i) {
        hdrp_v3 p = hdrp_v3_make(i & 1 ? b->high.x : b->low.x, i & 2 ? b->high.y : b->low.y,
                                 i & 4 ? b->high.z : b->low.z);
        float z = hdrp_v3_dot(hdrp_v3_sub(p, c->eye), c->forward);
        nearest = hdrp_min(nearest, z);
        farthest = hdrp_max(farthest, z);
    }
    farthest = hdrp_max(farthest, 1e-3f);
    return hdrp_v2_make(hdrp_max(nearest, 1e-2f * farthest), 1.001f * farthest);
}

static hdrp_shadow_cascades cascades_of(const rd_vk_shadow* s, const rd_renderer* r,
                                        const hdrp_light* light, uint32_t count)
{
    const rd_camera* c = &r->camera;
    hdrp_v3 size = hdrp_v3_sub(r->scene->bounds.high, r->scene->bounds.low);
    hdrp_v2 depths = depths_of(r);
    hdrp_shadow_cascades d;
    memset(&d, 0, sizeof d);
    d.eye = c->eye;
    d.view_forward = c->forward;
    d.extent = hdrp_v2_make(c->half_width, c->half_height);
    d.orthographic = c->orthographic;
    d.near_m = depths.x;
    d.far_m = depths.y;
    d.log_weight = LOG_WEIGHT;
    d.forward = hdrp_v3_from_v4(light->forward_radius);
    d.caster_m = 2.0f * hdrp_v3_length(size);
    d.count = count;
    for (uint32_t i = 0; i < count; ++i) {
        d.maps[i] = s->maps[light->bits.z + i];
    }
    d.settings = settings();
    return d;
}

/* A ball around the scene, a little larger: cascades fade at their rim. */
static hdrp_v4 ball_of(const rd_scene* scene)
{
    hdrp_v3 half = hdrp_v3_scale(hdrp_v3_sub(scene->bounds.high, scene->bounds.low), 0.5f);
    hdrp_v3 center = hdrp_v3_add(scene->bounds.low, half);
    return hdrp_v4_from_v3(center, 1.15f * hdrp_v3_length(half));
}

/* What covers more than all that there is covers that instead. */
static void shrink(const rd_scene* scene, const hdrp_shadow_cascades* c, hdrp_shadow_view* views)
{
    hdrp_v4 ball = ball_of(scene);
    for (uint32_t i = 0; i < c->count; ++i) {
        if (views[i].ball.w > ball.w * ball.w) {
            views[i] =
                hdrp_shadow_view_ball(ball, c->forward, c->caster_m, c->maps[i], c->settings);
        }
    }
}

bool rd_vk_shadow_aim(rd_vk_shadow* s, rd_vk_device* d, const rd_renderer* r,
                      const hdrp_light* records)
{
    bool ok = true;
    uint32_t first = 0;
    for (uint32_t i = 0; ok && i < s->masked; ++i) {
        if (s->cascades[i] > 0u) {
            const hdrp_light* light = &records[s->light_of_view[first]];
            hdrp_shadow_cascades c = cascades_of(s, r, light, s->cascades[i]);
            ok = rd_vk_check_hdrp(d, hdrp_shadow_make_cascades(&c, s->views + first), "cascades");
            shrink(r->scene, &c, s->views + first);
            first += s->cascades[i];
        }
    }
    memcpy(s->buffer.at, s->views, (size_t)s->view_count * sizeof *s->views);
    return ok;
}
