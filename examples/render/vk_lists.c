#include "vk_lists.h"

#include "variants.h"

#include <stdlib.h>
#include <string.h>

/* As in lists.c. */
#define TILE_PX         16u
#define SLICES          64u
#define SERIES_START    2e-3f
#define TILE_ENTRIES    512u
#define CLUSTER_ENTRIES 4096u

/* >>records */

static bool is_directional(const hdrp_light* light)
{
    return hdrp_light_type(*light) == HDRP_LIGHT_TYPE_DIRECTIONAL;
}

/* What blockers ask of lights, in the order of records. */
typedef struct blocked_lights {
    hdrp_v4* places;
    hdrp_cull_blocker_links* links;
} blocked_lights;

/* Directional lights are in no list of opaque surfaces: they are looked up in an image of shadows.
 * Those of layers have them, for these are not in that image. */
static bool sort_records(rd_vk_lists* l, const rd_lights* lights, hdrp_cull_shape* shapes,
                         blocked_lights* b)
{
    uint32_t n = 0;
    l->items = (hdrp_light*)calloc((size_t)lights->count + 1, sizeof *l->items);
    for (int pass = 0; l->items && pass < 2; ++pass) {
        for (uint32_t i = 0; i < lights->count; ++i) {
            if (is_directional(&lights->items[i]) == (pass == 1)) {
                shapes[n] = rd_variants_shape(lights, i);
                b->places[n] = lights->places[i];
                b->links[n] = lights->links[i];
                l->items[n++] = lights->items[i];
            }
        }
        l->listed = pass == 0 ? n : l->listed;
    }
    l->directional = n - l->listed;
    return l->items != NULL;
}

static bool make_blockers(rd_vk_lists* l, rd_vk_device* d, const rd_renderer* r,
                          const blocked_lights* b)
{
    const hdrp_cull_blocker_scene* scene = &r->lighting->lights.blockers;
    l->blocked = (r->lighting->features & RD_FEATURE_BLOCKERS) != 0 && scene->link_count > 0u;
    return !l->blocked ||
           (rd_vk_buffer_fill(d, b->places, scene->light_count * sizeof *b->places, &l->places) &&
            rd_vk_buffer_fill(d, b->links, scene->light_count * sizeof *b->links, &l->own_links) &&
            rd_vk_buffer_fill(d, scene->links, scene->link_count * sizeof *scene->links,
                              &l->links) &&
            rd_vk_buffer_fill(d, scene->blockers, scene->blocker_count * sizeof *scene->blockers,
                              &l->blockers));
}

static bool make_records(rd_vk_lists* l, rd_vk_device* d, const rd_renderer* r,
                         rd_vk_shadow* shadow)
{
    const rd_lights* lights = &r->lighting->lights;
    size_t count = lights->count;
    hdrp_cull_shape* shapes = (hdrp_cull_shape*)malloc((count + 1) * sizeof *shapes);
    blocked_lights b = {(hdrp_v4*)malloc((count + 1) * sizeof *b.places),
                        (hdrp_cull_blocker_links*)malloc((count + 1) * sizeof *b.links)};
    bool ok = shapes && b.places && b.links && sort_records(l, lights, shapes, &b);
    if (!ok) {
        rd_fail(d->report, "--backend vulkan", "out of memory");
    }
    ok = ok && rd_vk_shadow_make(shadow, d, r, l->items, l->listed, l->directional) &&
         rd_vk_buffer_fill(d, l->items, (count ? count : 1) * sizeof *l->items, &l->records) &&
         rd_vk_buffer_fill(d, shapes, count * sizeof *shapes, &l->shapes) &&
         make_blockers(l, d, r, &b);
    free(shapes);
    free(b.places);
    free(b.links);
    return ok;
}

/* >>lists */

static float size_of(const rd_scene* scene)
{
    hdrp_v3 d = hdrp_v3_sub(scene->bounds.high, scene->bounds.low);
    return scene->bounds.low.x <= scene->bounds.high.x ? hdrp_v3_length(d) : 1.0f;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static bool make_grid(rd_vk_lists* l, rd_vk_device* d, const rd_renderer* r, int which)
{
    uint32_t count = l->listed + l->directional;
    hdrp_cull_desc desc;
    size_t tiles;
    memset(&desc, 0, sizeof desc);
    desc.width_px = (uint32_t)r->width;
    desc.height_px = (uint32_t)r->height;
    desc.shape_capacity = count;
    if (which == 0) {
        desc.tile_width_px = desc.tile_height_px = TILE_PX;
        desc.slice_count = 1u;
        desc.flags = HDRP_CULL_PIXELS | HDRP_CULL_BLOCKS;
        desc.entry_capacity = least(count, TILE_ENTRIES);
    } else {
        desc.slice_count = SLICES;
        desc.entry_capacity = least(count, CLUSTER_ENTRIES / SLICES) * SLICES;
        desc.series_start_m = SERIES_START * size_of(r->scene);
    }
    if (!rd_vk_check_hdrp(d, hdrp_gpu_vk_lists_create(&d->gpu, &desc, &l->grids[which]), "lists")) {
        return false;
    }
    tiles = (size_t)((desc.width_px + l->grids[which].desc.tile_width_px - 1u) /
                     l->grids[which].desc.tile_width_px) *
            ((desc.height_px + l->grids[which].desc.tile_height_px - 1u) /
             l->grids[which].desc.tile_height_px);
    return rd_vk_mapped_make(d, tiles * sizeof(uint32_t), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                             &l->dropped[which]) &&
           (!l->blocked ||
            rd_vk_check_hdrp(
                d,
                hdrp_gpu_vk_buffer_create(&d->gpu, tiles * desc.entry_capacity * sizeof(uint32_t),
                                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                          VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, "masks of blockers",
                                          &l->blocker_masks[which]),
                "lists"));
}

bool rd_vk_lists_make(rd_vk_lists* l, rd_vk_device* d, const rd_renderer* r, rd_vk_shadow* shadow)
{
    const uint32_t wanted = RD_FEATURE_LISTS | RD_FEATURE_LIGHTS;
    uint32_t count;
    memset(l, 0, sizeof *l);
    if (!make_records(l, d, r, shadow)) {
        return false;
    }
    count = l->listed + l->directional;
    l->ready = (r->options->features & wanted) == wanted && count > 0u;
    if (l->ready && count > HDRP_CULL_SHAPES_MAX) { /* as in lists.c: surfaces visit all of them */
        l->left_out = count;
        l->ready = false;
    }
    return !l->ready || (make_grid(l, d, r, 0) && make_grid(l, d, r, 1));
}

void rd_vk_lists_free(rd_vk_lists* l, rd_vk_device* d)
{
    for (int i = 0; i < 2; ++i) {
        hdrp_gpu_vk_lists_destroy(&d->gpu, &l->grids[i]);
        rd_vk_mapped_free(d, &l->dropped[i]);
        hdrp_gpu_vk_buffer_destroy(&d->gpu, &l->blocker_masks[i]);
    }
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &l->places);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &l->own_links);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &l->links);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &l->blockers);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &l->records);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &l->shapes);
    free(l->items);
    memset(l, 0, sizeof *l);
}

static hdrp_gpu_vk_array all_of(const hdrp_gpu_vk_buffer* b)
{
    const hdrp_gpu_vk_array r = {b->buffer, 0, b->bytes};
    return r;
}

hdrp_gpu_vk_blockers rd_vk_lists_blockers(const rd_vk_lists* l, int which)
{
    hdrp_gpu_vk_blockers b;
    memset(&b, 0, sizeof b);
    if (l->blocked) {
        b.places = all_of(&l->places);
        b.lights = all_of(&l->own_links);
        b.links = all_of(&l->links);
        b.blockers = all_of(&l->blockers);
        b.masks = all_of(&l->blocker_masks[which]);
        b.light_count = l->listed + l->directional;
    }
    return b;
}

static bool apply_blockers(rd_vk_lists* l, rd_vk_device* d, int which)
{
    const hdrp_gpu_vk_blockers b = rd_vk_lists_blockers(l, which);
    bool ok = rd_vk_check_hdrp(
        d, hdrp_gpu_vk_apply_blockers(&d->gpu, d->commands, &l->grids[which], &b), "blockers");
    rd_vk_mark(d, which == 0 ? "blockers: tiles" : "blockers: clusters");
    return ok;
}

bool rd_vk_lists_build(rd_vk_lists* l, rd_vk_device* d, const rd_vk_raster* raster,
                       const hdrp_cull_camera* camera, const hdrp_depth_params* device)
{
    hdrp_gpu_vk_cull_frame frame;
    bool ok = true;
    memset(&frame, 0, sizeof frame);
    frame.camera = *camera;
    frame.shapes = l->shapes.buffer;
    frame.view = raster->targets[RD_VK_DEPTH].base.view;
    frame.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    frame.device = device;
    for (int i = 0; ok && l->ready && i < 2; ++i) {
        const VkBufferCopy words = {0, 0, l->dropped[i].buffer.bytes};
        frame.count = i == 0 ? l->listed : l->listed + l->directional;
        ok = rd_vk_check_hdrp(
            d, hdrp_gpu_vk_build_lists(&d->gpu, d->commands, &l->grids[i], &frame), "lists");
        vkCmdCopyBuffer(d->commands, l->grids[i].dropped.buffer, l->dropped[i].buffer.buffer, 1,
                        &words);
        rd_vk_mark(d, i == 0 ? "lists: tiles" : "lists: clusters");
        ok = ok && (!l->blocked || apply_blockers(l, d, i));
    }
    return ok;
}

uint64_t rd_vk_lists_dropped(const rd_vk_lists* l)
{
    uint64_t sum = 0;
    for (int i = 0; l->ready && i < 2; ++i) {
        const uint32_t* words = (const uint32_t*)l->dropped[i].at;
        for (size_t k = 0; k < l->dropped[i].buffer.bytes / sizeof *words; ++k) {
            sum += words[k];
        }
    }
    return sum;
}
