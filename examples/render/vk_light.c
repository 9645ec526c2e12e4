#include "vk_light.h"

#include <stdlib.h>
#include <string.h>

#define TILE_PX 16u

/* >>sky */

static bool make_cube(rd_vk_device* d, const hdrp_env_cube* cube, rd_vk_image* image)
{
    const rd_vk_image_desc desc = {VK_FORMAT_R32G32B32A32_SFLOAT,
                                   cube->size,
                                   cube->size,
                                   cube->level_count,
                                   6,
                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                   0};
    size_t offsets[32], bytes = 0;
    for (uint32_t i = 0; i < cube->level_count; ++i) {
        size_t side = cube->size >> i ? cube->size >> i : 1u;
        offsets[i] = bytes;
        bytes += side * side * 6 * sizeof(hdrp_v4);
    }
    return rd_vk_image_make(d, &desc, image) &&
           rd_vk_image_fill(d, image, cube->texels, bytes, offsets);
}

/* What the camera sees, as four floats a texel. */
static bool make_seen(rd_vk_device* d, const hdrp_env_image* seen, rd_vk_image* image)
{
    uint32_t rows = hdrp_env_image_rows(seen);
    size_t texels = (size_t)rows * seen->width;
    const size_t start = 0;
    const rd_vk_image_desc desc = {VK_FORMAT_R32G32B32A32_SFLOAT,
                                   seen->width,
                                   seen->height,
                                   1,
                                   rows / seen->height,
                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                   0};
    float* copy = (float*)malloc(texels * 4 * sizeof *copy);
    bool ok;
    if (!copy) {
        return rd_fail(d->report, "--backend vulkan", "out of memory");
    }
    for (size_t i = 0; i < texels; ++i) {
        const float* from = seen->texels + i * seen->texel_stride;
        copy[i * 4] = from[0] * seen->nits_per_unit;
        copy[i * 4 + 1] = from[1] * seen->nits_per_unit;
        copy[i * 4 + 2] = from[2] * seen->nits_per_unit;
        copy[i * 4 + 3] = 0.0f;
    }
    ok = rd_vk_image_make(d, &desc, image) &&
         rd_vk_image_fill(d, image, copy, texels * 4 * sizeof *copy, &start);
    free(copy);
    return ok;
}

static bool make_black(rd_vk_device* d, uint32_t layers, rd_vk_image* image)
{
    const float texels[6 * 4] = {0.0f};
    const size_t start = 0;
    const rd_vk_image_desc desc = {VK_FORMAT_R32G32B32A32_SFLOAT,
                                   1,
                                   1,
                                   1,
                                   layers,
                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                   0};
    return rd_vk_image_make(d, &desc, image) &&
           rd_vk_image_fill(d, image, texels, layers * 4 * sizeof(float), &start);
}

static bool make_sky(rd_vk_light* l, rd_vk_device* d)
{
    const rd_environment* e = l->lighting->environment;
    bool lights = e->present && l->lighting->features & RD_FEATURE_ENVIRONMENT;
    bool shown = e->present && l->lighting->features & RD_FEATURE_SKY;
    bool cube = e->seen.kind == HDRP_ENV_CUBE;
    return make_black(d, 1, &l->black) && make_black(d, 6, &l->black_cube) &&
           (!lights || make_cube(d, &e->baked.specular, &l->specular)) &&
           (!lights || l->lighting->fast_irradiance ||
            make_cube(d, &e->baked.irradiance, &l->irradiance)) &&
           (!shown || make_seen(d, &e->seen, cube ? &l->sky_cube : &l->sky));
}

/* >>tables and parameters */

static bool make_fgd(rd_vk_light* l, rd_vk_device* d)
{
    if (!l->lighting->fgd) {
        return true;
    }
    return rd_vk_check_hdrp(
               d,
               hdrp_gpu_vk_image_create(&d->gpu, VK_FORMAT_R32G32_SFLOAT, RD_FGD_SIZE, RD_FGD_SIZE,
                                        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                        "fgd", &l->fgd),
               "the table of FGD") &&
           rd_vk_begin(d) && rd_vk_check_hdrp(d, hdrp_gpu_vk_begin_frame(&d->gpu, 0), "a frame") &&
           rd_vk_check_hdrp(d, hdrp_gpu_vk_fgd_bake(&d->gpu, d->commands, &l->fgd), "FGD") &&
           (rd_vk_mark(d, "bake FGD table"), rd_vk_run(d));
}

static bool make_params(rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster)
{
    const VkBufferUsageFlags usage =
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const size_t cells = (raster->width / TILE_PX + 1u) * (raster->height / TILE_PX + 1u);
    void* zeros = calloc(cells, sizeof(hdrp_u32x4));
    bool ok = zeros && rd_vk_buffer_fill(d, zeros, cells * sizeof(hdrp_u32x4), &l->nothing);
    free(zeros);
    return ok && rd_vk_mapped_make(d, HDRP_GPU_VK_LIGHTING_BYTES, usage, &l->params[0]) &&
           rd_vk_mapped_make(d, HDRP_GPU_VK_LIGHTING_BYTES, usage, &l->params[1]);
}

/* >>variants of deferred lighting: plain materials, and all that this scene has */

static bool make_variants(rd_vk_light* l, rd_vk_device* d)
{
    const rd_scene* scene = l->lighting->scene;
    hdrp_u32 materials = 0u;
    uint32_t words[2], count = 0;
    double begin = rd_now_ms();
    for (int i = 0; i < scene->material_count; ++i) {
        materials |= scene->materials[i].features;
    }
    materials &= rd_lighting_material_features(l->lighting->features);
    materials &= HDRP_GPU_VK_WORD_MATERIALS >> HDRP_GPU_VK_WORD_MATERIAL_SHIFT;
    words[count++] = HDRP_GPU_VK_WORD_ALL & ~HDRP_GPU_VK_WORD_MATERIALS & ~HDRP_GPU_VK_WORD_SPLIT &
                     ~HDRP_GPU_VK_WORD_NEGATIVE;
    if (materials != 0u) {
        words[count++] = words[0] | materials << HDRP_GPU_VK_WORD_MATERIAL_SHIFT;
    }
    if (!rd_vk_check_hdrp(d, hdrp_gpu_vk_variants_create(&d->gpu, words, count, &l->variants),
                          "variants of lighting")) {
        return false;
    }
    if (d->stats) {
        rd_stats_pass(d->stats, "compile lighting", rd_now_ms() - begin);
    }
    return true;
}

/* >>making */

/* As those of pyramid.c. */
static uint32_t levels_of(const rd_vk_raster* raster)
{
    uint32_t n = 1;
    while (raster->width >> n > 0u || raster->height >> n > 0u) {
        ++n;
    }
    return n;
}

static bool make_behind(rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster)
{
    const rd_vk_image_desc desc = {VK_FORMAT_R32G32B32A32_SFLOAT,
                                   raster->width,
                                   raster->height,
                                   levels_of(raster),
                                   1,
                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                   0};
    const rd_vk_image_desc depth = {VK_FORMAT_D32_SFLOAT,
                                    raster->width,
                                    raster->height,
                                    1,
                                    1,
                                    VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                    VK_IMAGE_ASPECT_DEPTH_BIT};
    return rd_vk_image_make(d, &desc, &l->behind) && rd_vk_image_make(d, &depth, &l->behind_depth);
}

/* No lists: all lights count as those that reach everything. */
static void make_empty_grid(rd_vk_light* l, const rd_vk_raster* raster, int which)
{
    rd_vk_grid* g = &l->grids[which];
    const hdrp_gpu_vk_range nothing = {l->nothing.buffer, 0};
    hdrp_cull_camera c = hdrp_cull_camera_perspective(
        hdrp_v3_splat(0.0f), hdrp_v3_make(0.0f, 0.0f, -1.0f), hdrp_v3_make(0.0f, 1.0f, 0.0f), -1.0f,
        1.0f, -1.0f, 1.0f, 0.0f, HDRP_CULL_FAR_INFINITE);
    g->grid = hdrp_cull_grid_make(c, hdrp_u32x4_make(raster->width, raster->height, 1u, 1u),
                                  hdrp_u32x4_make(TILE_PX, TILE_PX, 0u, 0u), 0.0f, 0.0f);
    g->tiles = g->cells = g->entries = g->masks = nothing;
}

static void take_grid(rd_vk_light* l, int which)
{
    const hdrp_gpu_vk_lists* lists = &l->lists.grids[which];
    rd_vk_grid* g = &l->grids[which];
    g->tiles.buffer = lists->tiles.buffer;
    g->cells.buffer = lists->cells.buffer;
    g->entries.buffer = lists->entries.buffer;
    g->flags = lists->desc.flags;
}

/* Shadows of directional lights come from an image, but those of layers, and with lists. */
static void describe_shadows(const rd_vk_light* l, hdrp_gpu_vk_lighting* d, int which)
{
    if (!l->shadow.present) {
        return;
    }
    d->shadow_views.buffer = l->shadow.buffer.buffer.buffer;
    d->shadow_view_count = l->shadow.view_count;
    d->shadow_atlas = l->shadow.atlas.base.view;
    if (which == 0 && l->shadow.masked > 0u) {
        d->shadow_mask = l->shadow.visibility.view;
        d->first_masked = l->lists.listed;
        d->masked_count = l->shadow.masked;
    }
}

/* Without lists all blockers are asked, and no mask is read. */
static void describe_blockers(rd_vk_light* l, int which)
{
    hdrp_gpu_vk_blockers* b = &l->blockers[which];
    *b = rd_vk_lists_blockers(&l->lists, which);
    if (b->light_count > 0u && b->masks.buffer == VK_NULL_HANDLE) {
        b->masks.buffer = l->nothing.buffer;
        b->masks.bytes = l->nothing.bytes;
    }
    l->desc[which].blockers = b->light_count > 0u ? b : NULL;
}

static void describe(rd_vk_light* l, const rd_vk_raster* raster, int which)
{
    hdrp_gpu_vk_lighting* d = &l->desc[which];
    const rd_environment* e = l->lighting->environment;
    memset(d, 0, sizeof *d);
    d->params = l->params[which].buffer.buffer;
    d->width_px = raster->width;
    d->height_px = raster->height;
    d->depth = raster->targets[RD_VK_DEPTH].base.view;
    d->depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    d->device = &l->device_depth;
    for (int i = 0; i < 5; ++i) {
        d->rt[i] = raster->targets[RD_VK_RT0 + i].base.view;
    }
    d->kinds = raster->targets[RD_VK_KINDS].base.view;
    d->kind_mask = 255u;
    d->kind_lit = RD_PIXEL_DEFERRED;
    d->lights.buffer = l->lists.records.buffer;
    d->light_count = l->lighting->lights.count ? l->lighting->lights.count : 1u;
    d->fgd = l->fgd.view;
    d->fgd_size = RD_FGD_SIZE;
    describe_shadows(l, d, which);
    describe_blockers(l, which);
    d->specular = l->specular.base.view;
    d->specular_levels = l->specular.levels;
    d->irradiance = l->irradiance.base.view;
    d->sh = e->sh;
    for (uint32_t i = 0; i < HDRP_GPU_VK_PROFILES; ++i) {
        d->slab_colors[i] = l->lighting->scene->slab_color[i % RD_MAX_PROFILES];
    }
}

bool rd_vk_light_make(rd_vk_light* l, rd_vk_device* d, const rd_renderer* r,
                      const rd_vk_raster* raster)
{
    const VkSamplerAddressMode clamp = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    l->lighting = r->lighting;
    if (!rd_vk_sampler_make(d, VK_FILTER_LINEAR, clamp, clamp, &l->clamped) ||
        !rd_vk_sampler_make(d, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT, clamp,
                            &l->around) ||
        !make_sky(l, d) || !make_fgd(l, d) || !rd_vk_lists_make(&l->lists, d, r, &l->shadow) ||
        !make_params(l, d, raster) || !make_variants(l, d) || !make_behind(l, d, raster) ||
        !rd_vk_light_sets_make(l, d)) {
        return false;
    }
    for (int i = 0; i < 2; ++i) {
        make_empty_grid(l, raster, i);
        if (l->lists.ready) {
            take_grid(l, i);
        }
        describe(l, raster, i);
        rd_vk_light_set_write(l, d, raster, i);
    }
    return rd_vk_check_hdrp(d, hdrp_gpu_vk_tiles_create(&d->gpu, l->grids[0].grid, &l->tiles),
                            "tiles of lighting");
}

void rd_vk_light_free(rd_vk_light* l, rd_vk_device* d)
{
    rd_vk_image* images[] = {&l->specular, &l->irradiance,   &l->sky,   &l->sky_cube,
                             &l->behind,   &l->behind_depth, &l->black, &l->black_cube};
    hdrp_gpu_vk_tiles_destroy(&d->gpu, &l->tiles);
    hdrp_gpu_vk_variants_destroy(&d->gpu, &l->variants);
    hdrp_gpu_vk_image_destroy(&d->gpu, &l->fgd);
    rd_vk_lists_free(&l->lists, d);
    rd_vk_shadow_free(&l->shadow, d);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &l->nothing);
    rd_vk_mapped_free(d, &l->params[0]);
    rd_vk_mapped_free(d, &l->params[1]);
    for (size_t i = 0; i < sizeof images / sizeof images[0]; ++i) {
        rd_vk_image_free(d, images[i]);
    }
    vkDestroySampler(d->device, l->clamped, NULL);
    vkDestroySampler(d->device, l->around, NULL);
    vkDestroyDescriptorPool(d->device, l->pool, NULL);
    vkDestroyDescriptorSetLayout(d->device, l->layout, NULL);
    memset(l, 0, sizeof *l);
}

/* >>recording */

static bool resolve(rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster,
                    const hdrp_cull_camera* camera)
{
    hdrp_gpu_vk_shadow s;
    memset(&s, 0, sizeof s);
    s.width_px = raster->width;
    s.height_px = raster->height;
    s.depth = raster->targets[RD_VK_DEPTH].base.view;
    s.depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    s.normals = raster->targets[RD_VK_NORMALS].base.view;
    s.atlas = l->shadow.atlas.base.view;
    s.flags = HDRP_GPU_VK_SHADOW_PLAIN_NORMALS;
    s.device = &l->device_depth;
    s.camera = *camera;
    s.views = l->shadow.buffer.buffer.buffer;
    s.view_count = l->shadow.view_count;
    memcpy(s.cascades, l->shadow.cascades, sizeof s.cascades);
    if (!rd_vk_check_hdrp(
            d, hdrp_gpu_vk_resolve_shadows(&d->gpu, d->commands, &s, &l->shadow.visibility),
            "shadows")) {
        return false;
    }
    rd_vk_mark(d, "directional shadows");
    return true;
}

/* Without lists all lights count as those that reach everything. */
static void set_lights(rd_vk_light* l, hdrp_gpu_vk_lighting* desc, int which)
{
    const rd_vk_lists* lists = &l->lists;
    bool lit = (l->lighting->features & RD_FEATURE_LIGHTS) != 0;
    desc->first_directional = lists->ready ? lists->listed : 0u;
    desc->directional_count =
        lists->ready ? lists->directional : lists->listed + lists->directional;
    if (!lit || (lists->ready && which == 1)) {
        desc->directional_count = 0u;
    }
}

bool rd_vk_light_begin(rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster,
                       const hdrp_cull_camera* camera, hdrp_v2 depths, float exposure)
{
    bool ok;
    l->device_depth = camera->forward_orthographic.w != 0.0f
                          ? hdrp_depth_params_orthographic(depths.x, depths.y, 1u)
                          : hdrp_depth_params_perspective(depths.x, HDRP_CULL_FAR_INFINITE, 1u);
    ok = rd_vk_lists_build(&l->lists, d, raster, camera, &l->device_depth);
    ok = ok && (l->shadow.masked == 0u || resolve(l, d, raster, camera));
    for (int i = 0; ok && i < 2; ++i) {
        hdrp_gpu_vk_lighting* desc = &l->desc[i];
        const rd_vk_grid* g = &l->grids[i];
        desc->camera = *camera;
        desc->grid = l->lists.ready ? l->lists.grids[i].grid : g->grid;
        desc->list_flags = g->flags;
        desc->tiles = g->tiles;
        desc->cells = g->cells;
        desc->entries = g->entries;
        desc->masks = g->masks;
        desc->exposure = exposure;
        set_lights(l, desc, i);
        ok = rd_vk_check_hdrp(d, hdrp_gpu_vk_write_lighting(&d->gpu, d->commands, desc),
                              "parameters of lighting");
    }
    return ok;
}

bool rd_vk_light_deferred(rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster)
{
    const hdrp_gpu_vk_lit lit = {raster->targets[RD_VK_LIT].base.view, VK_NULL_HANDLE};
    const hdrp_gpu_vk_lighting* desc = &l->desc[0];
    bool ok = rd_vk_check_hdrp(
        d, hdrp_gpu_vk_classify(&d->gpu, d->commands, desc, &l->variants, &l->tiles),
        "classification");
    rd_vk_mark(d, "classification");
    ok = ok && rd_vk_check_hdrp(d,
                                hdrp_gpu_vk_light_deferred(&d->gpu, d->commands, desc, &l->variants,
                                                           &l->tiles, &lit),
                                "deferred lighting");
    rd_vk_mark(d, "deferred lighting");
    return ok;
}
