/* test_gpu_soak.c - frames in flight of any size, camera and number of lights: test_gpu_soak [FRAMES]
 * SPDX-License-Identifier: MIT
 *
 * All passes, recorded and submitted as an engine does it: nothing waits for the device but for the
 * frame before the last. What a resize replaces lives on until then. The validation layers look for
 * hazards; allocators of the host and of the device count. */
#include "gpu_test.h"

#include "hdrp_cull.h"
#include "hdrp_env.h"
#include "hdrp_light.h"
#include "hdrp_shadow.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FRAMES_IN_FLIGHT 3u
#define LIGHTS_MAX       4000u
#define SIDE_MAX         160u
#define ATLAS            64u
#define CASCADES         4u

/* Of what is read back: a pixel that is shown, one that is lit, the cells of
 * a tile and its entries. */
#define LIT_AT     16u
#define CELLS_AT   64u
#define ENTRIES_AT 2048u
#define BACK_BYTES 65536u

static gpu_device device;
static uint32_t frame_count = 20; /* in the test suite */

static bool is_short(void)
{
    return frame_count < 100u;
}

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static uint64_t random_state = 1;
static double random_number(void)
{
    uint64_t z = (random_state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static float random_in(double low, double high)
{
    return (float)(low + (high - low) * random_number());
}

/* A number in [low,high]. */
static uint32_t random_whole(uint32_t low, uint32_t high)
{
    return low + (uint32_t)(random_number() * (double)(high - low + 1u));
}

static hdrp_v3 random_direction(void)
{
    return hdrp_sphere_uniform(hdrp_v2_make(random_in(0.0, 1.0), random_in(0.0, 1.0)));
}

/* ---- memory that is counted ------------------------------------------------------------------ */

static struct {
    int host, blocks;
} live;

/* The size and the gap stand in front of each block. */
static void* VKAPI_CALL host_allocate(void* user, size_t bytes, size_t alignment,
                                      VkSystemAllocationScope scope)
{
    size_t front = alignment > 2 * sizeof(size_t) ? alignment : 2 * sizeof(size_t);
    unsigned char* block = aligned_alloc(front, (front + bytes + front - 1) / front * front);
    (void)user;
    (void)scope;
    assert_non_null(block);
    ++live.host;
    memcpy(block + front - sizeof bytes, &bytes, sizeof bytes);
    memcpy(block + front - 2 * sizeof bytes, &front, sizeof front);
    return block + front;
}

static void VKAPI_CALL host_free(void* user, void* memory)
{
    size_t front;
    (void)user;
    if (memory) {
        --live.host;
        memcpy(&front, (unsigned char*)memory - 2 * sizeof front, sizeof front);
        free((unsigned char*)memory - front);
    }
}

static void* VKAPI_CALL host_reallocate(void* user, void* old, size_t bytes, size_t alignment,
                                        VkSystemAllocationScope scope)
{
    void* made = bytes ? host_allocate(user, bytes, alignment, scope) : NULL;
    size_t had;
    if (old) {
        memcpy(&had, (unsigned char*)old - sizeof had, sizeof had);
        if (made) {
            memcpy(made, old, had < bytes ? had : bytes);
        }
        host_free(user, old);
    }
    return made;
}

static VkResult take_block(void* user, const VkMemoryRequirements* required,
                           VkMemoryPropertyFlags properties, hdrp_gpu_vk_block* block)
{
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                 .allocationSize = required->size};
    VkPhysicalDeviceMemoryProperties types;
    VkResult r;
    (void)user;
    vkGetPhysicalDeviceMemoryProperties(device.physical, &types);
    while ((required->memoryTypeBits >> info.memoryTypeIndex & 1u) == 0u ||
           (types.memoryTypes[info.memoryTypeIndex].propertyFlags & properties) != properties) {
        ++info.memoryTypeIndex;
        assert_true(info.memoryTypeIndex < types.memoryTypeCount);
    }
    r = vkAllocateMemory(device.device, &info, NULL, &block->memory);
    live.blocks += r == VK_SUCCESS;
    return r;
}

static void give_block(void* user, const hdrp_gpu_vk_block* block)
{
    (void)user;
    --live.blocks;
    vkFreeMemory(device.device, block->memory, NULL);
}

/* ---- what a frame needs ---------------------------------------------------------------------- */

/* Of a size: replaced by a resize. */
typedef struct sized {
    uint32_t width, height;
    hdrp_gpu_vk_image depth, lit, shown, diffuse, visibility, rt[5];
    hdrp_gpu_vk_image sums[4]; /* of transparent surfaces, in full and in half resolution */
    hdrp_gpu_vk_buffer tiles;  /* of hdrp_gpu_vk_measure_depth */
    hdrp_cull_desc desc;
    hdrp_cull_camera camera;
    hdrp_gpu_vk_lists lists;
    hdrp_gpu_vk_tiles classified;
} sized;

/* Of a frame in flight. */
typedef struct slot {
    VkCommandBuffer commands;
    VkFence fence;
    bool is_pending;
    hdrp_gpu_vk_buffer texels, shapes, lights, views, back;
    sized retired[8]; /* used by frames up to this one, and by no later one */
    uint32_t retired_count;
    hdrp_v4 expected; /* of the pixel that was read back */
    uint32_t light_count;
    uint32_t tile, slices, entry_capacity; /* the tile whose lists were read back */
} slot;

typedef struct engine {
    hdrp_gpu_vk gpu;
    slot slots[FRAMES_IN_FLIGHT];
    sized now;
    hdrp_gpu_vk_image fgd;
    hdrp_gpu_vk_image sky, atlas;
    hdrp_gpu_vk_buffer noise, params;
    hdrp_gpu_vk_variants variants;
    hdrp_gpu_vk_env env[2]; /* one is baked, in many frames, while the other lights */
    uint32_t env_step;      /* what comes next of the bake */
    uint32_t frame;
    uint32_t resizes, bakes, most_lights, cameras[4];
} engine;

static hdrp_gpu_vk_image make_image(const engine* e, VkFormat format, uint32_t width,
                                    uint32_t height, VkImageUsageFlags usage)
{
    hdrp_gpu_vk_image image;
    assert_int_equal(hdrp_gpu_vk_image_create(&e->gpu, format, width, height,
                                              usage | VK_IMAGE_USAGE_SAMPLED_BIT |
                                                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                  VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                              "soak", &image),
                     HDRP_OK);
    return image;
}

static hdrp_gpu_vk_buffer make_host_buffer(const engine* e, VkDeviceSize bytes)
{
    return gpu_host_buffer(&e->gpu, bytes);
}

static void sized_destroy(const engine* e, sized* s)
{
    hdrp_gpu_vk_image_destroy(&e->gpu, &s->depth);
    hdrp_gpu_vk_image_destroy(&e->gpu, &s->lit);
    hdrp_gpu_vk_image_destroy(&e->gpu, &s->shown);
    hdrp_gpu_vk_image_destroy(&e->gpu, &s->diffuse);
    hdrp_gpu_vk_image_destroy(&e->gpu, &s->visibility);
    for (int i = 0; i < 5; ++i) {
        hdrp_gpu_vk_image_destroy(&e->gpu, &s->rt[i]);
    }
    for (int i = 0; i < 4; ++i) {
        hdrp_gpu_vk_image_destroy(&e->gpu, &s->sums[i]);
    }
    hdrp_gpu_vk_tiles_destroy(&e->gpu, &s->classified);
    hdrp_gpu_vk_buffer_destroy(&e->gpu, &s->tiles);
    hdrp_gpu_vk_lists_destroy(&e->gpu, &s->lists);
}

/* Lavapipe compiles shaders anew for images whose sides are powers of two: a short soak has none. */
static uint32_t random_side(void)
{
    uint32_t side = random_whole(1u, random_number() < 0.2 ? 8u : SIDE_MAX);
    while (is_short() && (side & (side - 1u)) == 0u) {
        ++side;
    }
    return side;
}

static sized sized_make(const engine* e)
{
    static const uint32_t tiles[] = {0u, 8u, 16u, 32u};
    static const uint32_t slices[] = {0u, 1u, 4u, 64u};
    static const uint32_t flags[] = {0u,
                                     HDRP_CULL_FAST,
                                     HDRP_CULL_ONE_SERIES,
                                     HDRP_CULL_PIXELS,
                                     HDRP_CULL_BLOCKS,
                                     HDRP_CULL_MASKS};
    static const VkFormat formats[5] = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM,
                                        VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                                        VK_FORMAT_R8G8B8A8_UNORM};
    sized s;
    memset(&s, 0, sizeof s);
    s.width = random_side();
    s.height = random_side();
    s.desc.width_px = s.width;
    s.desc.height_px = s.height;
    s.desc.tile_width_px = s.desc.tile_height_px = tiles[random_whole(0u, 3u)];
    s.desc.slice_count = slices[random_whole(0u, 3u)];
    s.desc.shape_capacity = LIGHTS_MAX;
    s.desc.flags = flags[random_whole(0u, 5u)];
    s.desc.slice_count = s.desc.flags >= HDRP_CULL_PIXELS ? 1u : s.desc.slice_count;
    s.depth = make_image(e, VK_FORMAT_R32_SFLOAT, s.width, s.height, 0u);
    s.lit =
        make_image(e, VK_FORMAT_R32G32B32A32_SFLOAT, s.width, s.height, VK_IMAGE_USAGE_STORAGE_BIT);
    s.diffuse =
        make_image(e, VK_FORMAT_R16G16B16A16_SFLOAT, s.width, s.height, VK_IMAGE_USAGE_STORAGE_BIT);
    s.visibility =
        make_image(e, VK_FORMAT_R8G8B8A8_UNORM, s.width, s.height, VK_IMAGE_USAGE_STORAGE_BIT);
    for (int i = 0; i < 5; ++i) {
        s.rt[i] = make_image(e, formats[i], s.width, s.height, 0u);
    }
    for (uint32_t i = 0; i < 4; ++i) {
        s.sums[i] = make_image(e, VK_FORMAT_R16G16B16A16_SFLOAT, i < 2 ? s.width : s.width / 2 + 1,
                               i < 2 ? s.height : s.height / 2 + 1, 0u);
    }
    s.shown =
        make_image(e, VK_FORMAT_R8G8B8A8_UNORM, s.width, s.height, VK_IMAGE_USAGE_STORAGE_BIT);
    assert_int_equal(hdrp_gpu_vk_lists_create(&e->gpu, &s.desc, &s.lists), HDRP_OK);
    s.desc = s.lists.desc;
    assert_int_equal(hdrp_gpu_vk_tiles_create(&e->gpu, s.lists.grid, &s.classified), HDRP_OK);
    return s;
}

/* One of four kinds of cameras, anywhere. */
static hdrp_cull_camera random_camera(engine* e, uint32_t reverse, hdrp_depth_params* device_depth)
{
    uint32_t kind = random_whole(0u, 3u);
    float near_m = random_in(0.05, 1.0), far_m = random_in(20.0, 2000.0);
    hdrp_v3 eye = hdrp_v3_scale(random_direction(), random_in(0.0, 50.0));
    hdrp_v3 forward = random_direction(), up = random_direction();
    ++e->cameras[kind];
    if (kind == 2u) {
        float width = random_in(1.0, 100.0), height = random_in(1.0, 100.0);
        *device_depth = hdrp_depth_params_orthographic(near_m, far_m, reverse);
        return hdrp_cull_camera_orthographic(eye, forward, up, -width, width, -height, height,
                                             near_m, far_m);
    }
    *device_depth =
        hdrp_depth_params_perspective(near_m, kind == 3u ? HDRP_DEPTH_INFINITE : far_m, reverse);
    return hdrp_cull_camera_perspective(
        eye, forward, up, kind == 1u ? -0.2f : -1.0f, random_in(0.3, 1.5), random_in(-1.2, -0.1),
        random_in(0.1, 1.2), near_m, kind == 3u ? HDRP_CULL_FAR_INFINITE : far_m);
}

/* Depths of both sides of the range, and sky. */
static void write_depths(float* texels, const sized* s, hdrp_depth_params params, float sky)
{
    double scale = random_number();
    for (uint32_t i = 0; i < s->width * s->height; ++i) {
        float z = (float)exp2(12.0 * scale * random_number() - 3.0);
        texels[i] = i / s->width < s->height / 4u ? 0.0f : hdrp_device_depth(params, z);
    }
    texels[0] = sky; /* where nothing is lit */
}

/* Lights, and what lists need of them; behind them a directional one, which is in no list. */
static void write_lights(hdrp_light* lights, hdrp_cull_shape* shapes, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        hdrp_v3 at = hdrp_v3_scale(random_direction(), random_in(0.0, 100.0));
        float range = 0.1f + 8.0f * hdrp_sq(random_in(0.0, 1.0));
        hdrp_v3 color = hdrp_v3_make(random_in(0.0, 1000.0), 1.0f, 10.0f);
        lights[i] = hdrp_light_point(at, color, range);
        if (i % 3u == 1u) {
            lights[i] = hdrp_light_spot(at, random_direction(), color, range, random_in(0.0, 0.5),
                                        random_in(0.5, 1.5));
        } else if (i % 7u == 2u) {
            lights[i] = hdrp_light_box(at, random_direction(), random_direction(), color, range,
                                       range, 2.0f * range, 0.1f);
        }
        shapes[i] = hdrp_cull_shape_from_light(lights[i]);
    }
    lights[count] = hdrp_light_directional(random_direction(), hdrp_v3_splat(1e4f), 0.01f);
}

static void change(VkCommandBuffer commands, VkImage image, VkImageLayout before,
                   VkImageLayout after)
{
    gpu_change_layout(commands, image, VK_IMAGE_ASPECT_COLOR_BIT, before, after);
}

static void paint(VkCommandBuffer commands, VkImage image, hdrp_v4 color)
{
    const VkClearColorValue value = {.float32 = {color.x, color.y, color.z, color.w}};
    const VkImageSubresourceRange range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    change(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
    change(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
           VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

/* ---- passes ---------------------------------------------------------------------------------- */

static void record_depth(engine* e, slot* f, const hdrp_depth_params* params)
{
    sized* s = &e->now;
    hdrp_gpu_vk_depth depth = {0};
    size_t count;
    depth.view = s->depth.view;
    depth.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    depth.width_px = s->width;
    depth.height_px = s->height;
    depth.device = params;
    depth.camera = s->camera;
    depth.grid = hdrp_cull_grid_make(s->camera, hdrp_u32x4_make(s->width, s->height, 16u, 256u),
                                     hdrp_u32x4_make(16u, 16u, 0u, 0u), 0.0f, 0.0f);
    count = (size_t)depth.grid.tiles.z * depth.grid.tiles.w;
    if (!s->tiles.buffer) {
        assert_int_equal(hdrp_gpu_vk_buffer_create(
                             &e->gpu, count * sizeof(hdrp_v4),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                             VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, "tiles", &s->tiles),
                         HDRP_OK);
    }
    depth.tiles = s->tiles.buffer;
    assert_int_equal(hdrp_gpu_vk_measure_depth(&e->gpu, f->commands, &depth), HDRP_OK);
}

static void record_lists(engine* e, slot* f, const hdrp_depth_params* params)
{
    sized* s = &e->now;
    hdrp_gpu_vk_cull_frame frame = {0};
    VkBufferCopy region[2];
    frame.camera = s->camera;
    frame.shapes = f->shapes.buffer;
    frame.count = f->light_count;
    if ((s->desc.flags & HDRP_CULL_PIXELS) || random_number() < 0.8) {
        frame.view = s->depth.view;
        frame.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        frame.device = params;
    }
    assert_int_equal(hdrp_gpu_vk_build_lists(&e->gpu, f->commands, &s->lists, &frame), HDRP_OK);
    f->tile = random_whole(0u, s->lists.grid.tiles.z * s->lists.grid.tiles.w - 1u);
    f->slices = s->desc.slice_count;
    f->entry_capacity = s->desc.entry_capacity;
    region[0].size = (VkDeviceSize)16 * f->slices;
    region[0].srcOffset = region[0].size * f->tile;
    region[0].dstOffset = CELLS_AT;
    region[1].size = (VkDeviceSize)4 * f->entry_capacity;
    region[1].srcOffset = region[1].size * f->tile;
    region[1].dstOffset = ENTRIES_AT;
    vkCmdCopyBuffer(f->commands, s->lists.cells.buffer, f->back.buffer, 1, &region[0]);
    vkCmdCopyBuffer(f->commands, s->lists.entries.buffer, f->back.buffer, 1, &region[1]);
}

/* Lists of a tile lie in its room, and name lights that there are. */
static void look_at_lists(const slot* f, const uint8_t* back)
{
    const hdrp_u32x4* cells = (const hdrp_u32x4*)(const void*)(back + CELLS_AT);
    const uint32_t* entries = (const uint32_t*)(const void*)(back + ENTRIES_AT);
    uint32_t begin = f->tile * f->entry_capacity;
    for (uint32_t i = 0; i < f->slices; ++i) {
        uint32_t last = hdrp_cull_last(cells[i], 3u);
        assert_in_range(cells[i].x, begin, begin + f->entry_capacity);
        assert_in_range(last, cells[i].x, begin + f->entry_capacity);
        for (uint32_t k = cells[i].x; k < last; ++k) {
            assert_true((entries[k - begin] & 0xffffu) < f->light_count);
        }
    }
}

/* A step of a bake that takes many frames. */
static void record_environment(engine* e, slot* f)
{
    hdrp_gpu_vk_env* env = &e->env[e->bakes % 2u];
    uint32_t n = env->desc.radiance_size, levels = env->desc.specular_levels;
    hdrp_gpu_vk_env_image sky = {0};
    hdrp_gpu_vk* gpu = &e->gpu;
    hdrp_result r;
    sky.view = e->sky.view;
    sky.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    sky.width_px = e->sky.width_px;
    sky.height_px = e->sky.height_px;
    if (e->env_step == 0u) {
        paint(f->commands, e->sky.image,
              hdrp_v4_make(random_in(0.0, 1e5), random_in(0.0, 1.0), 1e9f, 1.0f));
    }
    if (e->env_step < 6u) {
        r = hdrp_gpu_vk_env_resample(gpu, f->commands, env, &sky, e->env_step * n, n);
    } else if (e->env_step == 6u) {
        r = hdrp_gpu_vk_env_reduce(gpu, f->commands, env);
    } else if (e->env_step < 7u + 2u * levels) {
        r = hdrp_gpu_vk_env_prefilter(gpu, f->commands, env, 3u * (e->env_step - 7u), 3u);
    } else if (e->env_step == 7u + 2u * levels) {
        r = hdrp_gpu_vk_env_convolve_irradiance(gpu, f->commands, env, 0u, 6u);
    } else {
        r = hdrp_gpu_vk_env_project_sh(gpu, f->commands, env);
    }
    assert_int_equal(r, HDRP_OK);
    e->env_step = e->env_step == 8u + 2u * levels ? 0u : e->env_step + 1u;
    e->bakes += e->env_step == 0u;
}

static void record_shadows(engine* e, slot* f, const hdrp_depth_params* params)
{
    sized* s = &e->now;
    hdrp_shadow_cascades cascades = {0};
    hdrp_gpu_vk_shadow shadow = {0};
    cascades.eye = hdrp_v3_from_v4(s->camera.eye_near);
    cascades.view_forward = hdrp_v3_from_v4(s->camera.forward_orthographic);
    cascades.extent = hdrp_v2_make(1.0f, 1.0f);
    cascades.orthographic = s->camera.forward_orthographic.w != 0.0f;
    cascades.near_m = s->camera.eye_near.w;
    cascades.far_m = 20.0f;
    cascades.log_weight = 0.7f;
    cascades.forward = random_direction();
    cascades.caster_m = 50.0f;
    cascades.count = CASCADES;
    cascades.settings = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 1u);
    for (uint32_t i = 0; i < CASCADES; ++i) {
        cascades.maps[i] =
            hdrp_u32x4_make(i % 2u * ATLAS / 2u, i / 2u * ATLAS / 2u, ATLAS / 2u, 0u);
    }
    assert_int_equal(hdrp_shadow_make_cascades(&cascades, gpu_map(&device, &f->views)), HDRP_OK);
    gpu_unmap(&device, &f->views);
    paint(f->commands, e->atlas.image, hdrp_v4_make(random_in(0.0, 1.0), 0.0f, 0.0f, 0.0f));
    shadow.width_px = s->width;
    shadow.height_px = s->height;
    shadow.depth = s->depth.view;
    shadow.normals = s->rt[1].view;
    shadow.atlas = e->atlas.view;
    shadow.device = params;
    shadow.camera = s->camera;
    shadow.views = f->views.buffer;
    shadow.view_count = shadow.cascades[0] = CASCADES;
    assert_int_equal(hdrp_gpu_vk_resolve_shadows(&e->gpu, f->commands, &shadow, &s->visibility),
                     HDRP_OK);
}

/* Any bits are a GBuffer, but for emission, which must be finite. */
static void upload_gbuffer(engine* e, slot* f)
{
    for (int i = 0; i < 5; ++i) {
        if (i == 3) {
            paint(f->commands, e->now.rt[i].image,
                  hdrp_v4_make(random_in(0.0, 10.0), 0.0f, 1.0f, 0.0f));
        } else {
            gpu_upload(f->commands, &e->noise, &e->now.rt[i], VK_IMAGE_ASPECT_COLOR_BIT);
        }
    }
}

static void record_lighting(engine* e, slot* f, const hdrp_depth_params* params)
{
    const VkBufferImageCopy region = {.bufferOffset = LIT_AT,
                                      .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageOffset = {(int32_t)random_whole(0u, e->now.width - 1u),
                                                      (int32_t)random_whole(0u, e->now.height - 1u),
                                                      0},
                                      .imageExtent = {1, 1, 1}};
    sized* s = &e->now;
    const hdrp_gpu_vk_env* env = &e->env[(e->bakes + 1u) % 2u];
    hdrp_gpu_vk_lighting l = {0};
    hdrp_gpu_vk_lit lit = {0};
    l.params = e->params.buffer;
    l.width_px = s->width;
    l.height_px = s->height;
    l.depth = s->depth.view;
    l.device = params;
    for (int i = 0; i < 5; ++i) {
        l.rt[i] = s->rt[i].view;
    }
    l.camera = s->camera;
    l.grid = s->lists.grid;
    l.list_flags = s->lists.desc.flags;
    l.tiles.buffer = s->lists.tiles.buffer;
    l.cells.buffer = s->lists.cells.buffer;
    l.entries.buffer = s->lists.entries.buffer;
    l.masks.buffer = s->lists.masks.buffer;
    l.lights.buffer = f->lights.buffer;
    l.light_count = f->light_count + 1u;
    l.first_directional = l.first_masked = f->light_count;
    l.directional_count = random_whole(0u, 1u);
    l.masked_count = l.directional_count;
    l.shadow_mask = l.directional_count ? s->visibility.view : VK_NULL_HANDLE;
    l.fgd = e->fgd.view;
    l.fgd_size = e->fgd.width_px;
    if (e->bakes > 0u) {
        l.specular = env->specular.view;
        l.specular_levels = env->specular.level_count;
        l.irradiance = env->irradiance.view;
    }
    l.exposure = 1e-3f;
    l.split = random_whole(0u, 1u);
    lit.color = s->lit.view;
    if (l.split) {
        lit.diffuse = s->diffuse.view;
        paint(f->commands, s->diffuse.image, hdrp_v4_make(0.0f, 0.0f, 0.0f, 0.0f));
        change(f->commands, s->diffuse.image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
               VK_IMAGE_LAYOUT_GENERAL);
    }
    assert_int_equal(hdrp_gpu_vk_write_lighting(&e->gpu, f->commands, &l), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_classify(&e->gpu, f->commands, &l, &e->variants, &s->classified),
                     HDRP_OK);
    assert_int_equal(
        hdrp_gpu_vk_light_deferred(&e->gpu, f->commands, &l, &e->variants, &s->classified, &lit),
        HDRP_OK);
    vkCmdCopyImageToBuffer(f->commands, s->lit.image, VK_IMAGE_LAYOUT_GENERAL, f->back.buffer, 1,
                           &region);
}

/* What the sky is painted with, which lighting leaves alone. */
static hdrp_v4 paint_sky(engine* e, slot* f)
{
    hdrp_v4 light =
        hdrp_v4_make(random_in(0.0, 2.0), random_in(0.0, 2.0), random_in(0.0, 2.0), 1.0f);
    paint(f->commands, e->now.lit.image, light);
    change(f->commands, e->now.lit.image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
           VK_IMAGE_LAYOUT_GENERAL);
    return light;
}

/* Fog over everything, in place; what is seen of a pixel then. */
static hdrp_v4 record_fog(engine* e, slot* f, hdrp_v4 light)
{
    static const hdrp_oit_mode modes[4] = {HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_MODE_WAVELET,
                                           HDRP_OIT_MODE_FRONT, HDRP_OIT_MODE_TALK};
    sized* s = &e->now;
    hdrp_gpu_vk_oit_layer low = {0};
    hdrp_gpu_vk_oit oit = {0};
    uint32_t kind = random_whole(0u, 3u);
    /* No alpha and no light, and what lets all through, but for half of what the first two modes
     * are given: alpha 1/2 of grey. */
    bool is_fog = kind < 2u;
    hdrp_v4 sum = is_fog ? hdrp_v4_make(0.25f, 0.25f, 0.25f, 0.5f) : hdrp_v4_make(0, 0, 0, 0);
    hdrp_v4 through = hdrp_v4_make(0.0f, 0.0f, 0.0f, is_fog ? 0.5f : 1.0f);
    if (kind == 3u) {
        through = hdrp_v4_make(1.0f, 1.0f, 1.0f, 0.0f);
    }
    oit.mode = modes[kind];
    oit.full.width_px = s->width;
    oit.full.height_px = s->height;
    low.width_px = s->sums[2].width_px;
    low.height_px = s->sums[2].height_px;
    paint(f->commands, s->sums[0].image, sum);
    paint(f->commands, s->sums[1].image, through);
    through = kind == 3u ? through : hdrp_v4_make(0.0f, 0.0f, 0.0f, 1.0f);
    paint(f->commands, s->sums[2].image, hdrp_v4_make(0, 0, 0, 0));
    paint(f->commands, s->sums[3].image, through);
    oit.full.targets[0] = s->sums[0].view;
    oit.full.targets[1] = kind == 2u ? s->sums[0].view : s->sums[1].view;
    oit.full.targets[2] = kind == 2u ? s->sums[1].view : VK_NULL_HANDLE;
    low.targets[0] = s->sums[2].view;
    low.targets[1] = kind == 2u ? s->sums[2].view : s->sums[3].view;
    low.targets[2] = kind == 2u ? s->sums[3].view : VK_NULL_HANDLE;
    oit.low = random_number() < 0.5 ? &low : NULL;
    oit.opaque = s->lit.view;
    oit.opaque_layout = VK_IMAGE_LAYOUT_GENERAL;
    oit.color = &s->lit;
    assert_int_equal(hdrp_gpu_vk_oit_composite(&e->gpu, f->commands, &oit), HDRP_OK);
    change(f->commands, s->lit.image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
           VK_IMAGE_LAYOUT_GENERAL);
    return is_fog ? hdrp_v4_make(0.5f * light.x + 0.25f, 0.5f * light.y + 0.25f,
                                 0.5f * light.z + 0.25f, light.w)
                  : light;
}

static void record_tone_map(engine* e, slot* f, hdrp_v4 light)
{
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = {1, 1, 1}};
    hdrp_gpu_vk_tone_map map = {0};
    hdrp_v3 shown;
    map.source = e->now.lit.view;
    map.layout = VK_IMAGE_LAYOUT_GENERAL;
    map.target = &e->now.shown;
    map.exposure = random_in(0.1, 2.0);
    map.curve = random_whole(0u, 1u);
    map.is_dithered = random_whole(0u, 1u);
    map.frame = e->frame;
    assert_int_equal(hdrp_gpu_vk_tone_map_record(&e->gpu, f->commands, &map), HDRP_OK);
    shown = hdrp_tonemap(hdrp_v3_scale(hdrp_v3_from_v4(light), map.exposure), map.curve);
    f->expected = hdrp_v4_from_v3(hdrp_v3_srgb_from_linear(shown), 1.0f);
    change(f->commands, e->now.shown.image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(f->commands, e->now.shown.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           f->back.buffer, 1, &region);
}

/* ---- frames ---------------------------------------------------------------------------------- */

/* Waits for the frame that used a slot last, looks at what it left, and frees what it held. */
static void finish(engine* e, slot* f)
{
    const uint8_t* pixel;
    const float* lit;
    if (!f->is_pending) {
        return;
    }
    assert_int_equal(vkWaitForFences(device.device, 1, &f->fence, VK_TRUE, UINT64_MAX), VK_SUCCESS);
    assert_int_equal(vkResetFences(device.device, 1, &f->fence), VK_SUCCESS);
    f->is_pending = false;
    pixel = gpu_map(&device, &f->back);
    assert_true(fabsf((float)pixel[0] - 255.0f * f->expected.x) <= 1.6f);
    assert_true(fabsf((float)pixel[1] - 255.0f * f->expected.y) <= 1.6f);
    assert_true(fabsf((float)pixel[2] - 255.0f * f->expected.z) <= 1.6f);
    assert_int_equal(pixel[3], 255);
    lit = (const float*)(const void*)(pixel + LIT_AT);
    for (int i = 0; i < 4; ++i) {
        assert_true(lit[i] >= 0.0f && lit[i] <= 1e30f);
    }
    look_at_lists(f, pixel);
    gpu_unmap(&device, &f->back);
    while (f->retired_count > 0u) {
        sized_destroy(e, &f->retired[--f->retired_count]);
    }
}

static void upload_depth(engine* e, slot* f, hdrp_depth_params params, float sky)
{
    write_depths(gpu_map(&device, &f->texels), &e->now, params, sky);
    gpu_unmap(&device, &f->texels);
    gpu_upload(f->commands, &f->texels, &e->now.depth, VK_IMAGE_ASPECT_COLOR_BIT);
}

static void run_frame(engine* e)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    slot* f = &e->slots[e->frame % FRAMES_IN_FLIGHT];
    slot* before = &e->slots[(e->frame + FRAMES_IN_FLIGHT - 1u) % FRAMES_IN_FLIGHT];
    hdrp_depth_params params;
    uint32_t reverse = random_whole(0u, 1u);
    hdrp_v4 sky;
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1};
    finish(e, f);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&e->gpu, e->frame % FRAMES_IN_FLIGHT), HDRP_OK);
    assert_int_equal(vkBeginCommandBuffer(f->commands, &begin), VK_SUCCESS);
    if (e->frame > 0u && random_number() < 0.3) {
        /* The frame before is the last that uses it. */
        before->retired[before->retired_count++] = e->now;
        e->now = sized_make(e);
        ++e->resizes;
    }
    e->now.camera = random_camera(e, reverse, &params);
    f->light_count = random_number() < 0.1 ? 0u : random_whole(0u, LIGHTS_MAX);
    e->most_lights = f->light_count > e->most_lights ? f->light_count : e->most_lights;
    write_lights(gpu_map(&device, &f->lights), gpu_map(&device, &f->shapes), f->light_count);
    gpu_unmap(&device, &f->lights);
    gpu_unmap(&device, &f->shapes);
    upload_depth(e, f, params, reverse ? 0.0f : 1.0f);
    if (e->frame % 16u == 0u) {
        assert_int_equal(hdrp_gpu_vk_fgd_bake(&e->gpu, f->commands, &e->fgd), HDRP_OK);
    }
    record_depth(e, f, &params);
    record_lists(e, f, &params);
    record_environment(e, f);
    upload_gbuffer(e, f);
    record_shadows(e, f, &params);
    sky = paint_sky(e, f);
    if (!is_short() || e->frame % 3u == 0u) { /* lavapipe forgets large shaders after a frame */
        record_lighting(e, f, &params);
    }
    sky = record_fog(e, f, sky);
    record_tone_map(e, f, sky);
    assert_int_equal(vkEndCommandBuffer(f->commands), VK_SUCCESS);
    submit.pCommandBuffers = &f->commands;
    assert_int_equal(vkQueueSubmit(device.queue, 1, &submit, f->fence), VK_SUCCESS);
    f->is_pending = true;
    ++e->frame;
}

static void engine_open(engine* e, const VkAllocationCallbacks* callbacks)
{
    const hdrp_env_desc small = {16u, 16u, 0u, 4u, 0.0f};
    const uint32_t words[2] = {HDRP_GPU_VK_WORD_LIT | HDRP_GPU_VK_WORD_LIGHTS |
                                   HDRP_GPU_VK_WORD_SLICES,
                               HDRP_GPU_VK_WORD_ALL};
    uint32_t* noise;
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = device.pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 1};
    hdrp_gpu_vk_desc desc = gpu_desc(&device);
    memset(e, 0, sizeof *e);
    desc.frames = FRAMES_IN_FLIGHT;
    desc.allocation = callbacks;
    desc.memory.allocate = take_block;
    desc.memory.release = give_block;
    assert_int_equal(hdrp_gpu_vk_init(&e->gpu, &desc), HDRP_OK);
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; ++i) {
        slot* f = &e->slots[i];
        assert_int_equal(vkAllocateCommandBuffers(device.device, &commands, &f->commands),
                         VK_SUCCESS);
        assert_int_equal(vkCreateFence(device.device, &fence, NULL, &f->fence), VK_SUCCESS);
        f->texels = make_host_buffer(e, (VkDeviceSize)4 * SIDE_MAX * SIDE_MAX);
        f->shapes = make_host_buffer(e, (VkDeviceSize)LIGHTS_MAX * sizeof(hdrp_cull_shape));
        f->lights = make_host_buffer(e, (VkDeviceSize)(LIGHTS_MAX + 1u) * sizeof(hdrp_light));
        f->views = make_host_buffer(e, CASCADES * sizeof(hdrp_shadow_view));
        f->back = make_host_buffer(e, BACK_BYTES);
        memset(gpu_map(&device, &f->back), 0, BACK_BYTES);
        gpu_unmap(&device, &f->back);
    }
    e->fgd = make_image(e, VK_FORMAT_R16G16B16A16_SFLOAT, 4u, 4u, VK_IMAGE_USAGE_STORAGE_BIT);
    e->sky = make_image(e, VK_FORMAT_R32G32B32A32_SFLOAT, 37u, 19u, 0u);
    e->atlas = make_image(e, VK_FORMAT_R32_SFLOAT, ATLAS, ATLAS, 0u);
    e->noise = make_host_buffer(e, (VkDeviceSize)4 * SIDE_MAX * SIDE_MAX);
    noise = gpu_map(&device, &e->noise);
    for (uint32_t i = 0; i < SIDE_MAX * SIDE_MAX; ++i) {
        noise[i] = hdrp_hash1(i);
    }
    gpu_unmap(&device, &e->noise);
    assert_int_equal(hdrp_gpu_vk_buffer_create(
                         &e->gpu, HDRP_GPU_VK_LIGHTING_BYTES,
                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                         VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, "params", &e->params),
                     HDRP_OK);
    /* A large shader: one of them serves a short soak. */
    assert_int_equal(hdrp_gpu_vk_variants_create(&e->gpu, is_short() ? words + 1 : words,
                                                 is_short() ? 1u : 2u, &e->variants),
                     HDRP_OK);
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(
            hdrp_gpu_vk_env_create(&e->gpu, &small, VK_FORMAT_R16G16B16A16_SFLOAT, &e->env[i]),
            HDRP_OK);
    }
    e->now = sized_make(e);
}

static void engine_close(engine* e)
{
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; ++i) {
        slot* f = &e->slots[(e->frame + i) % FRAMES_IN_FLIGHT]; /* the oldest first */
        finish(e, f);
        hdrp_gpu_vk_buffer_destroy(&e->gpu, &f->texels);
        hdrp_gpu_vk_buffer_destroy(&e->gpu, &f->shapes);
        hdrp_gpu_vk_buffer_destroy(&e->gpu, &f->lights);
        hdrp_gpu_vk_buffer_destroy(&e->gpu, &f->views);
        hdrp_gpu_vk_buffer_destroy(&e->gpu, &f->back);
        vkFreeCommandBuffers(device.device, device.pool, 1, &f->commands);
        vkDestroyFence(device.device, f->fence, NULL);
    }
    sized_destroy(e, &e->now);
    hdrp_gpu_vk_env_destroy(&e->gpu, &e->env[0]);
    hdrp_gpu_vk_env_destroy(&e->gpu, &e->env[1]);
    hdrp_gpu_vk_variants_destroy(&e->gpu, &e->variants);
    hdrp_gpu_vk_buffer_destroy(&e->gpu, &e->params);
    hdrp_gpu_vk_buffer_destroy(&e->gpu, &e->noise);
    hdrp_gpu_vk_image_destroy(&e->gpu, &e->atlas);
    hdrp_gpu_vk_image_destroy(&e->gpu, &e->sky);
    hdrp_gpu_vk_image_destroy(&e->gpu, &e->fgd);
    hdrp_gpu_vk_destroy(&e->gpu);
}

static void frames_of_all_kinds_follow_each_other(void** state)
{
    const VkAllocationCallbacks callbacks = {
        .pfnAllocation = host_allocate, .pfnReallocation = host_reallocate, .pfnFree = host_free};
    static engine e;
    (void)state;
    engine_open(&e, &callbacks);
    while (e.frame < frame_count) {
        run_frame(&e);
        assert_int_equal(device.messages, 0);
    }
    engine_close(&e);
    printf("%u frames, %u resizes, %u environments, up to %u lights, cameras %u %u %u %u\n",
           e.frame, e.resizes, e.bakes, e.most_lights, e.cameras[0], e.cameras[1], e.cameras[2],
           e.cameras[3]);
    assert_int_equal(live.host, 0);
    assert_int_equal(live.blocks, 0);
    assert_int_equal(device.messages, 0);
}

int main(int argc, char** argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_of_all_kinds_follow_each_other),
    };
    int failed;
    frame_count = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : frame_count;
    if (!gpu_open_writing(&device)) {
        return GPU_SKIPPED;
    }
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    gpu_close(&device);
    return failed || device.messages;
}
