/* test_gpu_light.c - classification and deferred lighting against the CPU.
 * SPDX-License-Identifier: MIT */
#include "gpu_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FGD_SIZE 64u

static gpu_device device;
static hdrp_gpu_vk gpu;
static hdrp_brdf_fgd fgd_of_cpu[FGD_SIZE * FGD_SIZE];

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static uint64_t seed;

static float number(void)
{
    uint64_t z = (seed += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (float)((z ^ (z >> 31)) >> 40) * 0x1p-24f;
}

static float between(float low, float high)
{
    return low + (high - low) * number();
}

static uint32_t below(uint32_t count)
{
    return (uint32_t)(number() * (float)count);
}

static hdrp_v3 any_direction(void)
{
    return hdrp_sphere_uniform(hdrp_v2_make(number(), number()));
}

static hdrp_v3 any_color(float most)
{
    return hdrp_v3_make(number() * most, number() * most, number() * most);
}

/* ---- a scene --------------------------------------------------------------------------------- */

enum { KIND_OTHER, KIND_DEFERRED = 5, KIND_STRAY = 12 };

#define KIND_MASK 7u

typedef struct scene_desc {
    uint32_t width, height, tile;
    uint32_t lights;      /* of lists */
    uint32_t directional; /* of none */
    uint32_t slices;      /* of lists; 0: 1 */
    uint32_t list_flags;
    uint32_t types;       /* of lights: HDRP_GPU_VK_WORD_LIGHTS bits; 0: all */
    uint32_t materials;   /* features of materials: mask */
    bool sky_only, plain; /* plain: no features, no kinds, no RT4, no environment */
    bool split, environment, harmonics, table, masked;
    bool srgb;  /* RT0 has the format that it is made for */
    bool atlas; /* of shadow maps with random depths */
    bool blockers;
} scene_desc;

typedef struct scene {
    scene_desc desc;
    hdrp_cull_camera camera;
    hdrp_pack_gbuffer_texel* texels;
    float* depths; /* metres */
    uint8_t* kinds;
    uint8_t* occlusion;
    uint8_t* shadow;
    hdrp_light* lights; /* those of lists, then directional ones */
    hdrp_v3 slabs[HDRP_GPU_VK_PROFILES];
    float exposure;
    hdrp_cull_set set;
    hdrp_cull_lists lists;
    void *set_memory, *list_memory, *env_memory;
    hdrp_env env;
    hdrp_env_sh sh;
    hdrp_shadow_view* views;
    uint32_t view_count;
    float* atlas; /* depths */
    hdrp_cull_blocker_scene blocked;
    uint32_t* blocker_masks; /* of entries */
    uint64_t blocked_pixels; /* bits in them */
} scene;

static size_t pixels_of(const scene* s)
{
    return (size_t)s->desc.width * s->desc.height;
}

static void* aligned(size_t bytes)
{
    void* p = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_non_null(p);
    return p;
}

/* One of the materials that the GBuffer holds. */
static hdrp_brdf_surface any_surface(uint32_t mask, uint32_t kind)
{
    static const uint32_t features[] = {0u,
                                        HDRP_BRDF_FEATURE_ANISOTROPY,
                                        HDRP_BRDF_FEATURE_IRIDESCENCE,
                                        HDRP_BRDF_FEATURE_SUBSURFACE,
                                        HDRP_BRDF_FEATURE_TRANSMISSION,
                                        HDRP_BRDF_FEATURE_SUBSURFACE |
                                            HDRP_BRDF_FEATURE_TRANSMISSION,
                                        0u};
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.features = features[kind % 7u] | (kind % 3u == 0u ? HDRP_BRDF_FEATURE_CLEAR_COAT : 0u);
    s.features &= mask;
    s.base_color = any_color(0.9f);
    s.metallic = s.features & (HDRP_BRDF_FEATURE_ANISOTROPY | HDRP_BRDF_FEATURE_IRIDESCENCE)
                     ? number()
                     : 0.0f;
    s.perceptual_roughness = between(0.1f, 1.0f);
    s.normal = hdrp_v3_add(any_direction(), hdrp_v3_make(0.0f, 0.0f, 1.2f));
    s.coat_normal = s.normal;
    s.tangent = any_direction();
    s.ambient_occlusion = number();
    s.specular_occlusion = number();
    s.anisotropy = between(-0.9f, 0.9f);
    s.coat_mask = between(0.1f, 1.0f);
    s.film_mask = number();
    s.film_ior = between(1.1f, 2.0f);
    s.film_thickness_nm = between(100.0f, 900.0f);
    s.subsurface_mask = number();
    s.diffusion_profile = below(16u);
    s.thickness = number();
    return s;
}

static void make_pixels(scene* s)
{
    const scene_desc* d = &s->desc;
    for (uint32_t y = 0; y < d->height; ++y) {
        for (uint32_t x = 0; x < d->width; ++x) {
            size_t i = (size_t)y * d->width + x;
            uint32_t block = (x / 24u) + 5u * (y / 24u); /* neighbours are alike, more or less */
            uint32_t kind = number() < 0.9f ? block : below(21u);
            hdrp_brdf_surface surface = any_surface(d->plain ? 0u : d->materials, kind);
            hdrp_pack_gbuffer_extra e = {0};
            e.emissive = number() < 0.1f ? any_color(2.0f) : hdrp_v3_splat(0.0f);
            e.light_layers = number() < 0.8f ? 255u : below(256u);
            e.targets = HDRP_PACK_GBUFFER_RT4;
            s->texels[i] = hdrp_pack_gbuffer_texel_from_targets(
                hdrp_pack_gbuffer_encode(hdrp_brdf_data_from_surface(surface), e));
            s->depths[i] = d->sky_only || number() < 0.05f || block % 9u == 7u
                               ? s->camera.right_far.w
                               : between(3.0f, 20.0f);
            s->kinds[i] =
                (uint8_t)(number() < 0.9f && block % 9u != 5u ? KIND_DEFERRED | (below(8u) << 3)
                                                              : KIND_STRAY);
            s->occlusion[i] = (uint8_t)below(256u);
            s->shadow[i] = number() < 0.3f ? 0u : (uint8_t)below(256u);
        }
    }
}

static hdrp_v3 any_place(const scene* s)
{
    float z = between(2.0f, 22.0f);
    hdrp_v3 offset = hdrp_cull_offset_of_pixel(s->camera, number() * (float)s->desc.width,
                                               number() * (float)s->desc.height,
                                               (float)s->desc.width, (float)s->desc.height, z);
    return hdrp_v3_add(offset, hdrp_v3_from_v4(s->camera.eye_near));
}

static hdrp_light any_light(const scene* s)
{
    uint32_t types = s->desc.types ? s->desc.types : HDRP_GPU_VK_WORD_LIGHTS;
    uint32_t type = 1u + below(5u);
    hdrp_v3 place = any_place(s), forward = any_direction(), up = any_direction();
    float range = between(1.0f, 6.0f);
    hdrp_light l;
    while (!(types & HDRP_CULL_FEATURE_OF_TYPE(type))) {
        type = 1u + below(5u);
    }
    if (type == HDRP_LIGHT_TYPE_DIRECTIONAL) {
        l = hdrp_light_directional(forward, any_color(3.0f), between(0.0f, 0.1f));
    } else if (type == HDRP_LIGHT_TYPE_POINT) {
        l = hdrp_light_point(place, any_color(100.0f), range);
    } else if (type == HDRP_LIGHT_TYPE_SPOT) {
        l = hdrp_light_spot(place, forward, any_color(200.0f), range, 0.3f, between(0.4f, 1.2f));
    } else if (type == HDRP_LIGHT_TYPE_PYRAMID) {
        l = hdrp_light_pyramid(place, forward, up, any_color(200.0f), range, between(0.3f, 1.0f),
                               between(0.3f, 1.0f), 0.1f);
    } else {
        l = hdrp_light_box(place, forward, up, any_color(20.0f), between(0.5f, 3.0f),
                           between(0.5f, 3.0f), range, 0.2f);
    }
    if (type != HDRP_LIGHT_TYPE_DIRECTIONAL && type != HDRP_LIGHT_TYPE_BOX && number() < 0.3f) {
        l.forward_radius.w = between(0.01f, 0.4f);
    }
    l.bits.x |= number() < 0.1f ? HDRP_LIGHT_FEATURE_SHADOW : 0u;
    l.bits.x |= number() < 0.1f ? HDRP_LIGHT_FEATURE_NEGATIVE : 0u;
    l.bits.y = number() < 0.8f ? HDRP_LIGHT_LAYERS_ALL : 1u + below(255u);
    return l;
}

static void make_lists(scene* s)
{
    const scene_desc* d = &s->desc;
    hdrp_cull_desc desc = {0};
    hdrp_cull_depth depth = {s->depths, d->width, NULL};
    uint32_t capacity = d->lights > 0u ? d->lights : 1u;
    size_t scratch_bytes;
    void* scratch;
    hdrp_cull_shape* shapes = malloc(capacity * sizeof *shapes);
    assert_non_null(shapes);
    desc.width_px = d->width;
    desc.height_px = d->height;
    desc.tile_width_px = desc.tile_height_px = d->tile;
    desc.slice_count = d->slices ? d->slices : 1u;
    desc.shape_capacity = capacity;
    desc.entry_capacity = capacity * desc.slice_count;
    desc.flags = d->list_flags;
    s->set_memory = aligned(hdrp_cull_set_memory_size(capacity));
    s->list_memory = aligned(hdrp_cull_memory_size(&desc));
    scratch_bytes = hdrp_cull_scratch_size(&desc);
    scratch = aligned(scratch_bytes);
    for (uint32_t i = 0; i < d->lights; ++i) {
        shapes[i] = hdrp_cull_shape_from_light(s->lights[i]);
    }
    assert_int_equal(
        hdrp_cull_set_init(&s->set, capacity, s->set_memory, hdrp_cull_set_memory_size(capacity)),
        HDRP_OK);
    assert_int_equal(hdrp_cull_init(&s->lists, &desc, s->list_memory, hdrp_cull_memory_size(&desc)),
                     HDRP_OK);
    assert_int_equal(hdrp_cull_set_begin(&s->set, &s->camera, d->width, d->height, d->lights),
                     HDRP_OK);
    assert_int_equal(hdrp_cull_begin(&s->lists, &s->set), HDRP_OK);
    assert_int_equal(hdrp_cull_measure_depth(&s->lists, &depth, 0, s->lists.grid.tiles.w), HDRP_OK);
    assert_int_equal(hdrp_cull_set_project(&s->set, shapes, 0, d->lights), HDRP_OK);
    assert_int_equal(hdrp_cull_build(&s->lists, &s->set, &depth, 0, hdrp_cull_rows(&s->lists),
                                     scratch, scratch_bytes),
                     HDRP_OK);
    free(scratch);
    free(shapes);
}

#define WALLS            24u
#define PORTALS          8u
#define BLOCKERS_A_LIGHT 3u

/* Walls, of which a few have a window, and which of them keep each light away, be it in a list or
 * not. Every fifth has none. */
static void make_blockers(scene* s)
{
    uint32_t count = s->desc.lights + s->desc.directional;
    hdrp_cull_blocker* walls = malloc((WALLS + PORTALS) * sizeof *walls);
    hdrp_v4* places = malloc(count * sizeof *places);
    hdrp_cull_blocker_links* own = malloc(count * sizeof *own);
    uint32_t* links = malloc(count * BLOCKERS_A_LIGHT * sizeof *links);
    assert_true(walls && places && own && links);
    for (uint32_t i = 0; i < WALLS; ++i) {
        hdrp_v3 at = any_place(s), front = any_direction(), up = any_direction();
        walls[i] = i % 6u == 5u ? hdrp_cull_blocker_plane(at, front)
                                : hdrp_cull_blocker_rectangle(at, front, up, between(1.0f, 6.0f),
                                                              between(1.0f, 6.0f));
        if (i % 3u == 0u) {
            uint32_t first = WALLS + i / 3u;
            walls[first] = hdrp_cull_blocker_rectangle(at, front, up, 1.5f, 1.0f);
            walls[i] = hdrp_cull_blocker_with_portals(walls[i], first, i % 6u ? 1u : 0u);
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        places[i] = hdrp_cull_light_place(s->lights[i]);
        own[i].first = i * BLOCKERS_A_LIGHT;
        own[i].count = i % 5u == 4u ? 0u : 1u + i % BLOCKERS_A_LIGHT;
        for (uint32_t k = 0; k < BLOCKERS_A_LIGHT; ++k) {
            links[i * BLOCKERS_A_LIGHT + k] = below(WALLS);
        }
    }
    s->blocked = (hdrp_cull_blocker_scene){
        places, own, links, walls, count, count * BLOCKERS_A_LIGHT, WALLS + PORTALS};
}

/* Lights leave cells, and masks say what is left for pixels. */
static void apply_blockers(scene* s)
{
    hdrp_u32x4 tiles = s->lists.grid.tiles;
    const hdrp_cull_blocker_desc limits = {s->blocked.light_count, s->blocked.link_count,
                                           s->blocked.blocker_count};
    size_t bytes = hdrp_cull_blocker_memory_size(&limits);
    void *memory = aligned(bytes), *scratch;
    hdrp_cull_blocker_set set;
    hdrp_cull_blocker_job job;
    s->blocker_masks =
        calloc((size_t)tiles.z * tiles.w * s->lists.grid.cells.y, sizeof *s->blocker_masks);
    assert_non_null(s->blocker_masks);
    assert_int_equal(hdrp_cull_blocker_init(&set, &limits, memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_blocker_begin(&set, &s->blocked, &s->camera), HDRP_OK);
    assert_int_equal(
        hdrp_cull_blocker_project(&set, 0, s->blocked.light_count + s->blocked.blocker_count),
        HDRP_OK);
    bytes = hdrp_cull_blocker_scratch_size(&set);
    scratch = aligned(bytes);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, &set, scratch, bytes), HDRP_OK);
    assert_int_equal(
        hdrp_cull_apply_blockers(&s->lists, &job, 0, tiles.z * tiles.w, s->blocker_masks), HDRP_OK);
    s->blocked_pixels = job.stats.pixel;
    free(memory);
    free(scratch);
}

#define MAP_PX   16u
#define ATLAS_PX 512u

/* Maps for the lights that want one, and casters at any depth. */
static void make_atlas(scene* s)
{
    const hdrp_shadow_settings settings = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, 0u);
    s->views = malloc((6u * s->desc.lights + 1u) * sizeof *s->views);
    s->atlas = malloc(ATLAS_PX * ATLAS_PX * sizeof *s->atlas);
    assert_true(s->views && s->atlas);
    for (size_t i = 0; i < ATLAS_PX * ATLAS_PX; ++i) {
        s->atlas[i] = between(0.9f, 1.0f);
    }
    for (uint32_t i = 0; i < s->desc.lights; ++i) {
        uint32_t count = hdrp_shadow_map_count(s->lights[i]);
        if (!(s->lights[i].bits.x & HDRP_LIGHT_FEATURE_SHADOW)) {
            continue;
        }
        s->lights[i].bits.z = s->view_count;
        s->lights[i].bits.x &= count > 0u ? ~0u : ~HDRP_LIGHT_FEATURE_SHADOW;
        for (uint32_t face = 0; face < count; ++face) {
            uint32_t k = s->view_count++, in_row = ATLAS_PX / MAP_PX;
            hdrp_u32x4 map = hdrp_u32x4_make(k % in_row * MAP_PX, k / in_row * MAP_PX, MAP_PX, 0u);
            assert_true(k < in_row * in_row);
            s->views[k] = hdrp_shadow_view_light(s->lights[i], face, 0.1f, map, settings);
        }
    }
    assert_true(s->view_count > 0u);
}

static void make_environment(scene* s)
{
    enum { WIDTH = 32, HEIGHT = 16 };
    float texels[WIDTH * HEIGHT * 3];
    hdrp_env_image image = {0};
    hdrp_env_desc desc = {0};
    desc.radiance_size = desc.specular_size = 16u;
    desc.irradiance_size = 8u;
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        float bright = i % 97 == 5 ? 20.0f : 1.0f;
        texels[3 * i] = bright * (1.0f + 0.8f * sinf((float)i * 0.05f));
        texels[3 * i + 1] = bright * (float)(i / WIDTH) / HEIGHT;
        texels[3 * i + 2] = bright * (float)(i % WIDTH) / WIDTH;
    }
    image.texels = texels;
    image.width = WIDTH;
    image.height = HEIGHT;
    image.kind = HDRP_ENV_LATLONG;
    s->env_memory = aligned(hdrp_env_memory_size(&desc));
    assert_int_equal(hdrp_env_init(&s->env, &desc, s->env_memory, hdrp_env_memory_size(&desc)),
                     HDRP_OK);
    assert_int_equal(hdrp_env_bake(&s->env, &image), HDRP_OK);
    assert_int_equal(hdrp_env_project_sh(&s->env, &s->sh), HDRP_OK);
}

static scene make_scene(const scene_desc* desc)
{
    scene s;
    uint32_t count = desc->lights + desc->directional;
    memset(&s, 0, sizeof s);
    s.desc = *desc;
    seed = desc->width * 7u + desc->height * 13u + desc->lights;
    s.camera = hdrp_cull_camera_perspective(
        hdrp_v3_make(10.0f, -3.0f, 5.0f), hdrp_v3_make(0.2f, -0.1f, -1.0f),
        hdrp_v3_make(0.1f, 1.0f, 0.0f), -0.8f, 0.8f, -0.6f, 0.6f, 0.1f, 100.0f);
    s.texels = malloc(pixels_of(&s) * sizeof *s.texels);
    s.depths = malloc(pixels_of(&s) * sizeof *s.depths);
    s.kinds = malloc(pixels_of(&s));
    s.occlusion = malloc(pixels_of(&s));
    s.shadow = malloc(pixels_of(&s));
    s.lights = malloc((count + 1u) * sizeof *s.lights);
    assert_true(s.texels && s.depths && s.kinds && s.occlusion && s.shadow && s.lights);
    memset(s.lights, 0, (count + 1u) * sizeof *s.lights);
    s.exposure = 0.125f;
    make_pixels(&s);
    for (uint32_t i = 0; i < HDRP_GPU_VK_PROFILES; ++i) {
        s.slabs[i] = any_color(1.0f);
    }
    for (uint32_t i = 0; i < desc->lights; ++i) {
        s.lights[i] = any_light(&s);
    }
    for (uint32_t i = desc->lights; i < count; ++i) {
        s.lights[i] = hdrp_light_directional(any_direction(), any_color(5.0f), 0.01f);
        s.lights[i].bits.y = i % 2u ? HDRP_LIGHT_LAYERS_ALL : 15u;
    }
    if (desc->atlas) {
        make_atlas(&s);
    }
    make_lists(&s);
    if (desc->blockers) {
        make_blockers(&s);
        apply_blockers(&s);
    }
    if (desc->environment) {
        make_environment(&s);
    }
    return s;
}

static void free_scene(scene* s)
{
    free(s->texels);
    free(s->depths);
    free(s->kinds);
    free(s->occlusion);
    free(s->shadow);
    free(s->lights);
    free(s->set_memory);
    free(s->list_memory);
    free(s->env_memory);
    free(s->views);
    free(s->atlas);
    free(s->blocker_masks);
    free((void*)s->blocked.places);
    free((void*)s->blocked.lights);
    free((void*)s->blocked.links);
    free((void*)s->blocked.blockers);
}

/* ---- the CPU --------------------------------------------------------------------------------- */

static bool is_deferred(const scene* s, size_t pixel)
{
    bool kind = s->desc.plain || (s->kinds[pixel] & KIND_MASK) == KIND_DEFERRED;
    return kind && hdrp_cull_opaque_depth(s->depths[pixel], s->camera.eye_near.w,
                                          s->camera.right_far.w) >= 0.0f;
}

static uint32_t frame_word(const scene* s)
{
    return (s->lists.desc.slice_count > 1u ? HDRP_GPU_VK_WORD_SLICES : 0u) |
           (s->desc.directional ? HDRP_GPU_VK_WORD_DIRECTIONAL : 0u) |
           (s->desc.directional && s->desc.masked ? HDRP_GPU_VK_WORD_SHADOW_MASK : 0u) |
           (s->desc.environment ? HDRP_GPU_VK_WORD_ENVIRONMENT : 0u) |
           (s->desc.blockers ? HDRP_GPU_VK_WORD_BLOCKERS : 0u);
}

/* Words of tiles by the functions of the CPU. */
static uint32_t* cpu_words(const scene* s)
{
    hdrp_u32x4 tiles = s->lists.grid.tiles;
    uint32_t count = tiles.z * tiles.w;
    uint32_t* pixels = malloc(pixels_of(s) * sizeof *pixels);
    uint32_t* words = malloc(count * sizeof *words);
    uint32_t* lights = malloc(count * sizeof *lights);
    hdrp_cull_feature_image image = {0};
    assert_true(pixels && words && lights);
    for (size_t i = 0; i < pixels_of(s); ++i) {
        uint32_t features = hdrp_pack_gbuffer_texel_features(s->texels[i].rt2);
        pixels[i] = is_deferred(s, i) ? hdrp_gpu_vk_word_of_material(
                                            features, s->desc.split ? HDRP_GPU_VK_WORD_SPLIT : 0u)
                                      : 0u;
    }
    image.pixels = pixels;
    image.width = s->desc.width;
    image.height = s->desc.height;
    assert_int_equal(hdrp_cull_material_tiles(&image, s->desc.tile, 0, tiles.w, words), HDRP_OK);
    assert_int_equal(hdrp_cull_light_features(&s->lists, &s->set, 0, count, lights), HDRP_OK);
    for (uint32_t i = 0; i < count; ++i) {
        lights[i] &= HDRP_GPU_VK_WORD_LIGHTS | HDRP_GPU_VK_WORD_NEGATIVE; /* no atlas: no shadow */
        lights[i] |= frame_word(s);
    }
    assert_int_equal(hdrp_cull_combine_features(words, lights, words, 0, count), HDRP_OK);
    free(pixels);
    free(lights);
    return words;
}

typedef struct cpu_pixel {
    hdrp_v3 diffuse, specular; /* exposed */
    uint32_t features;
} cpu_pixel;

static void add_sky(const scene* s, hdrp_brdf_data d, const hdrp_brdf_lit_view* w, float visibility,
                    cpu_pixel* out)
{
    hdrp_brdf_lit_env e;
    hdrp_v3 front, behind, nits;
    d.ambient_occlusion = hdrp_min(d.ambient_occlusion, visibility);
    d.specular_occlusion *=
        hdrp_brdf_specular_occlusion(d.ambient_occlusion, w->n_dot_v, d.perceptual_roughness);
    e = hdrp_brdf_lit_env_make(d, *w, d.features);
    front = s->desc.harmonics ? hdrp_env_irradiance_fast(s->sh, d.normal)
                              : hdrp_env_irradiance(&s->env, d.normal);
    behind = s->desc.harmonics ? hdrp_env_irradiance_fast(s->sh, hdrp_v3_neg(d.normal))
                               : hdrp_env_irradiance(&s->env, hdrp_v3_neg(d.normal));
    out->diffuse = hdrp_v3_mad(out->diffuse, hdrp_v3_mul(front, e.diffuse_weight), HDRP_INV_PI);
    out->diffuse = hdrp_v3_mad(out->diffuse, hdrp_v3_mul(behind, e.through_weight), HDRP_INV_PI);
    nits = hdrp_env_specular(&s->env, e.specular_direction, e.specular_perceptual_roughness);
    out->specular = hdrp_v3_add(out->specular, hdrp_v3_mul(nits, e.specular_weight));
    nits = hdrp_env_specular(&s->env, e.coat_direction, e.coat_perceptual_roughness);
    out->specular = hdrp_v3_mad(out->specular, nits, e.coat_weight);
}

/* Every light on a pixel, without lists. */
static cpu_pixel shade(const scene* s, uint32_t x, uint32_t y)
{
    size_t at = (size_t)y * s->desc.width + x;
    uint32_t targets = s->desc.plain ? 0u : HDRP_PACK_GBUFFER_RT4;
    hdrp_pack_gbuffer g = hdrp_pack_gbuffer_targets_from_texel(s->texels[at]);
    hdrp_brdf_data d = hdrp_pack_gbuffer_decode(g, targets);
    hdrp_pack_gbuffer_extra e = hdrp_pack_gbuffer_decode_extra(g, targets);
    hdrp_v3 offset =
        hdrp_cull_offset_of_pixel(s->camera, (float)x + 0.5f, (float)y + 0.5f, (float)s->desc.width,
                                  (float)s->desc.height, s->depths[at]);
    hdrp_v3 place = hdrp_v3_add(offset, hdrp_v3_from_v4(s->camera.eye_near));
    hdrp_v3 v = hdrp_cull_direction_to_eye(s->camera, offset);
    float n_dot_v = hdrp_saturate(hdrp_v3_dot(d.normal, v));
    hdrp_brdf_fgd fgd = s->desc.table ? hdrp_brdf_fgd_lookup(fgd_of_cpu, (int)FGD_SIZE, n_dot_v,
                                                             d.perceptual_roughness)
                                      : hdrp_brdf_fgd_fast(n_dot_v, d.perceptual_roughness);
    hdrp_brdf_lit_view w;
    cpu_pixel out = {0};
    if (d.features & HDRP_BRDF_FEATURE_TRANSMISSION) {
        d.transmittance =
            hdrp_brdf_volume_transmittance(s->slabs[d.diffusion_profile], 1.0f, d.thickness);
    }
    w = hdrp_brdf_lit_view_make(d, v, fgd, d.features);
    out.features = d.features;
    for (uint32_t i = 0; i < s->desc.lights + s->desc.directional; ++i) {
        hdrp_light_incident in = hdrp_light_eval(s->lights[i], place);
        float variance = hdrp_light_variance(s->lights[i], in);
        float visible =
            s->desc.masked && i == s->desc.lights ? (float)s->shadow[at] / 255.0f : 1.0f;
        hdrp_brdf_lit lit;
        if (!hdrp_light_affects(s->lights[i], e.light_layers)) {
            continue;
        }
        if (s->desc.atlas && s->lights[i].bits.x & HDRP_LIGHT_FEATURE_SHADOW) {
            const hdrp_shadow_atlas atlas = {s->atlas, ATLAS_PX, ATLAS_PX, 0};
            const hdrp_shadow_view* view = &s->views[s->lights[i].bits.z];
            view += hdrp_shadow_map_of_direction(*view, hdrp_v3_neg(in.l));
            visible *= hdrp_shadow_visibility(&atlas, view, place, d.normal);
        }
        if (s->desc.blockers) {
            visible *= hdrp_cull_blocker_light_visible(&s->blocked, i, UINT32_MAX, place);
        }
        visible *= hdrp_light_sign(s->lights[i]);
        lit = hdrp_brdf_lit_eval(d, hdrp_brdf_lit_view_widened(w, variance), in.l, d.features);
        out.diffuse = hdrp_v3_mad(out.diffuse, hdrp_v3_mul(in.illuminance, lit.diffuse), visible);
        out.specular =
            hdrp_v3_mad(out.specular, hdrp_v3_mul(in.illuminance, lit.specular), visible);
    }
    if (s->desc.environment) {
        add_sky(s, d, &w, s->desc.plain ? 1.0f : (float)s->occlusion[at] / 255.0f, &out);
    }
    out.diffuse = hdrp_v3_scale(out.diffuse, s->exposure);
    out.specular = hdrp_v3_scale(out.specular, s->exposure);
    out.specular = hdrp_v3_add(out.specular, e.static_diffuse);
    return out;
}

/* ---- the device ------------------------------------------------------------------------------ */

enum { IMAGE_RT0, IMAGE_DEPTH = 5, IMAGE_KINDS, IMAGE_OCCLUSION, IMAGE_SHADOW, IMAGES };
enum {
    BUFFER_LIGHTS,
    BUFFER_TILES,
    BUFFER_CELLS,
    BUFFER_ENTRIES,
    BUFFER_MASKS,
    BUFFER_VIEWS,
    BUFFER_ATLAS,
    BUFFER_BLOCKER_LIGHTS,
    BUFFER_LINKS,
    BUFFER_BLOCKERS,
    BUFFER_BLOCKER_MASKS,
    BUFFERS
};

typedef struct on_device {
    hdrp_gpu_vk_image images[IMAGES];
    hdrp_gpu_vk_buffer uploads[IMAGES], buffers[BUFFERS], params, cube_uploads[2];
    hdrp_gpu_vk_image cubes[2];
    hdrp_gpu_vk_image fgd, color, diffuse, atlas;
    hdrp_gpu_vk_blockers blockers;
    hdrp_gpu_vk_lighting lighting;
    hdrp_gpu_vk_tiles tiles;
} on_device;

static hdrp_gpu_vk_buffer filled_buffer(const void* data, size_t bytes)
{
    return gpu_filled_buffer(&device, &gpu, data, bytes);
}

/* An image and what it will be filled with; texels are every stride-th of data. */
static void make_image(const scene* s, on_device* o, int k, VkFormat format, size_t texel,
                       const void* data, size_t stride)
{
    hdrp_gpu_vk_buffer b = gpu_host_buffer(&gpu, (pixels_of(s) * texel + 3u) / 4u * 4u);
    char* to = gpu_map(&device, &b);
    for (size_t i = 0; i < pixels_of(s); ++i) {
        memcpy(to + i * texel, (const char*)data + i * stride, texel);
    }
    gpu_unmap(&device, &b);
    o->uploads[k] = b;
    assert_int_equal(
        hdrp_gpu_vk_image_create(&gpu, format, s->desc.width, s->desc.height,
                                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                 "input", &o->images[k]),
        HDRP_OK);
}

static void make_cube(const hdrp_env_cube* cube, hdrp_gpu_vk_image* image,
                      hdrp_gpu_vk_buffer* upload)
{
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                    .extent = {cube->size, cube->size, 1},
                                    .mipLevels = cube->level_count,
                                    .arrayLayers = 6,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    size_t count = 0;
    for (uint32_t level = 0; level < cube->level_count; ++level) {
        count += (size_t)6u * (cube->size >> level) * (cube->size >> level);
    }
    *upload = filled_buffer(cube->texels, count * sizeof *cube->texels);
    *image = gpu_image(&device, &info, VK_IMAGE_VIEW_TYPE_CUBE, VK_IMAGE_ASPECT_COLOR_BIT);
}

static void change(VkCommandBuffer commands, const hdrp_gpu_vk_image* image, VkImageLayout before,
                   VkImageLayout after)
{
    gpu_change_layout(commands, image->image, VK_IMAGE_ASPECT_COLOR_BIT, before, after);
}

static void upload_cube(VkCommandBuffer commands, const hdrp_env_cube* cube,
                        const hdrp_gpu_vk_image* image, const hdrp_gpu_vk_buffer* from)
{
    VkDeviceSize offset = 0;
    change(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    for (uint32_t level = 0; level < cube->level_count; ++level) {
        uint32_t size = cube->size >> level;
        const VkBufferImageCopy region = {
            .bufferOffset = offset,
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 6},
            .imageExtent = {size, size, 1}};
        vkCmdCopyBufferToImage(commands, from->buffer, image->image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        offset += (VkDeviceSize)6u * size * size * sizeof(hdrp_v4);
    }
    change(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
           VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

static hdrp_gpu_vk_array filled_array(on_device* o, int k, const void* data, size_t bytes)
{
    hdrp_gpu_vk_array a = {VK_NULL_HANDLE, 0, bytes};
    o->buffers[k] = filled_buffer(data, bytes);
    a.buffer = o->buffers[k].buffer;
    return a;
}

static void make_blocker_buffers(const scene* s, on_device* o)
{
    const hdrp_cull_blocker_scene* b = &s->blocked;
    hdrp_u32x4 tiles = s->lists.grid.tiles;
    size_t entries = (size_t)tiles.z * tiles.w * s->lists.grid.cells.y;
    o->blockers.lights =
        filled_array(o, BUFFER_BLOCKER_LIGHTS, b->lights, b->light_count * sizeof *b->lights);
    o->blockers.links = filled_array(o, BUFFER_LINKS, b->links, b->link_count * sizeof *b->links);
    o->blockers.blockers =
        filled_array(o, BUFFER_BLOCKERS, b->blockers, b->blocker_count * sizeof *b->blockers);
    o->blockers.masks =
        filled_array(o, BUFFER_BLOCKER_MASKS, s->blocker_masks, entries * sizeof *s->blocker_masks);
    o->blockers.light_count = b->light_count;
}

static void make_buffers(const scene* s, on_device* o)
{
    const hdrp_cull_lists* l = &s->lists;
    size_t tiles = (size_t)l->grid.tiles.z * l->grid.tiles.w;
    size_t entries = tiles * l->grid.cells.y;
    uint32_t lights = s->desc.lights + s->desc.directional;
    o->buffers[BUFFER_LIGHTS] =
        filled_buffer(s->lights, (lights ? lights : 1u) * sizeof *s->lights);
    o->buffers[BUFFER_TILES] = filled_buffer(l->tiles, tiles * sizeof *l->tiles);
    o->buffers[BUFFER_CELLS] =
        filled_buffer(l->cells, tiles * l->desc.slice_count * sizeof *l->cells);
    o->buffers[BUFFER_ENTRIES] = filled_buffer(l->entries, entries * sizeof *l->entries);
    if (l->masks) {
        o->buffers[BUFFER_MASKS] =
            filled_buffer(l->masks, entries * hdrp_cull_mask_words(l->grid) * sizeof *l->masks);
    }
    if (s->desc.blockers) {
        make_blocker_buffers(s, o);
    }
    if (s->desc.atlas) {
        o->buffers[BUFFER_VIEWS] = filled_buffer(s->views, s->view_count * sizeof *s->views);
        o->buffers[BUFFER_ATLAS] = filled_buffer(s->atlas, ATLAS_PX * ATLAS_PX * sizeof *s->atlas);
        assert_int_equal(
            hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32_SFLOAT, ATLAS_PX, ATLAS_PX,
                                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                     "atlas", &o->atlas),
            HDRP_OK);
    }
    assert_int_equal(hdrp_gpu_vk_buffer_create(
                         &gpu, HDRP_GPU_VK_LIGHTING_BYTES,
                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                         VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, "params", &o->params),
                     HDRP_OK);
}

static void set_lighting(const scene* s, on_device* o)
{
    hdrp_gpu_vk_lighting* l = &o->lighting;
    l->params = o->params.buffer;
    l->width_px = s->desc.width;
    l->height_px = s->desc.height;
    l->depth = o->images[IMAGE_DEPTH].view;
    for (int k = 0; k < 5; ++k) {
        l->rt[k] = s->desc.plain && k == 4 ? VK_NULL_HANDLE : o->images[k].view;
    }
    if (!s->desc.plain) {
        l->kinds = o->images[IMAGE_KINDS].view;
        l->kind_mask = KIND_MASK;
        l->kind_lit = KIND_DEFERRED;
        l->occlusion = o->images[IMAGE_OCCLUSION].view;
    }
    l->camera = s->camera;
    l->grid = s->lists.grid;
    l->list_flags = s->lists.desc.flags;
    l->tiles.buffer = o->buffers[BUFFER_TILES].buffer;
    l->cells.buffer = o->buffers[BUFFER_CELLS].buffer;
    l->entries.buffer = o->buffers[BUFFER_ENTRIES].buffer;
    l->masks.buffer = o->buffers[BUFFER_MASKS].buffer;
    l->lights.buffer = o->buffers[BUFFER_LIGHTS].buffer;
    l->light_count = s->desc.lights + s->desc.directional;
    l->light_count += l->light_count == 0u;
    l->first_directional = s->desc.lights;
    l->directional_count = s->desc.directional;
    l->first_masked = s->desc.lights;
    l->masked_count = 1;
    l->shadow_mask = s->desc.masked ? o->images[IMAGE_SHADOW].view : VK_NULL_HANDLE;
    l->shadow_views.buffer = o->buffers[BUFFER_VIEWS].buffer;
    l->shadow_view_count = s->view_count;
    l->shadow_atlas = o->atlas.view;
    l->fgd = s->desc.table ? o->fgd.view : VK_NULL_HANDLE;
    l->fgd_size = FGD_SIZE;
    l->specular = o->cubes[0].view;
    l->specular_levels = s->env.specular.level_count;
    l->irradiance = s->desc.harmonics ? VK_NULL_HANDLE : o->cubes[1].view;
    l->sh = s->sh;
    l->split = s->desc.split;
    l->exposure = s->exposure;
    l->blockers = s->desc.blockers ? &o->blockers : NULL;
    memcpy(l->slab_colors, s->slabs, sizeof s->slabs);
}

static hdrp_gpu_vk_image output_image(const scene* s)
{
    hdrp_gpu_vk_image image;
    assert_int_equal(hdrp_gpu_vk_image_create(
                         &gpu, VK_FORMAT_R32G32B32A32_SFLOAT, s->desc.width, s->desc.height,
                         VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                             VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                         "lit", &image),
                     HDRP_OK);
    return image;
}

static void to_device(const scene* s, on_device* o)
{
    const hdrp_pack_gbuffer_texel* t = s->texels;
    memset(o, 0, sizeof *o);
    if (s->desc.srgb) {
        make_image(s, o, 0, VK_FORMAT_R8G8B8A8_SRGB, 4, &t->rt0, sizeof *t);
    } else { /* what the CPU reads: devices decode sRGB as coarsely as its codes allow */
        hdrp_v4* linear = malloc(pixels_of(s) * sizeof *linear);
        assert_non_null(linear);
        for (size_t i = 0; i < pixels_of(s); ++i) {
            linear[i] = hdrp_pack_linear_from_srgba8(t[i].rt0);
        }
        make_image(s, o, 0, VK_FORMAT_R32G32B32A32_SFLOAT, sizeof *linear, linear, sizeof *linear);
        free(linear);
    }
    make_image(s, o, 1, VK_FORMAT_R8G8B8A8_UNORM, 4, &t->rt1, sizeof *t);
    make_image(s, o, 2, VK_FORMAT_R8G8B8A8_UNORM, 4, &t->rt2, sizeof *t);
    make_image(s, o, 3, VK_FORMAT_B10G11R11_UFLOAT_PACK32, 4, &t->rt3, sizeof *t);
    make_image(s, o, 4, VK_FORMAT_R8G8B8A8_UNORM, 4, &t->rt4, sizeof *t);
    make_image(s, o, IMAGE_DEPTH, VK_FORMAT_R32_SFLOAT, 4, s->depths, 4);
    make_image(s, o, IMAGE_KINDS, VK_FORMAT_R8_UINT, 1, s->kinds, 1);
    make_image(s, o, IMAGE_OCCLUSION, VK_FORMAT_R8_UNORM, 1, s->occlusion, 1);
    make_image(s, o, IMAGE_SHADOW, VK_FORMAT_R8_UNORM, 1, s->shadow, 1);
    make_buffers(s, o);
    if (s->desc.environment) {
        make_cube(&s->env.specular, &o->cubes[0], &o->cube_uploads[0]);
        make_cube(&s->env.irradiance, &o->cubes[1], &o->cube_uploads[1]);
    }
    if (s->desc.table) {
        assert_int_equal(
            hdrp_gpu_vk_image_create(&gpu, VK_FORMAT_R32G32_SFLOAT, FGD_SIZE, FGD_SIZE,
                                     VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, "fgd",
                                     &o->fgd),
            HDRP_OK);
    }
    o->color = output_image(s);
    o->diffuse = output_image(s);
    assert_int_equal(hdrp_gpu_vk_tiles_create(&gpu, s->lists.grid, &o->tiles), HDRP_OK);
    set_lighting(s, o);
}

static void free_device(on_device* o)
{
    for (int k = 0; k < IMAGES; ++k) {
        hdrp_gpu_vk_image_destroy(&gpu, &o->images[k]);
        hdrp_gpu_vk_buffer_destroy(&gpu, &o->uploads[k]);
    }
    for (int k = 0; k < BUFFERS; ++k) {
        hdrp_gpu_vk_buffer_destroy(&gpu, &o->buffers[k]);
    }
    for (int k = 0; k < 2; ++k) {
        hdrp_gpu_vk_image_destroy(&gpu, &o->cubes[k]);
        hdrp_gpu_vk_buffer_destroy(&gpu, &o->cube_uploads[k]);
    }
    hdrp_gpu_vk_buffer_destroy(&gpu, &o->params);
    hdrp_gpu_vk_image_destroy(&gpu, &o->fgd);
    hdrp_gpu_vk_image_destroy(&gpu, &o->atlas);
    hdrp_gpu_vk_image_destroy(&gpu, &o->color);
    hdrp_gpu_vk_image_destroy(&gpu, &o->diffuse);
    hdrp_gpu_vk_tiles_destroy(&gpu, &o->tiles);
}

static VkCommandBuffer begin(const scene* s, const on_device* o)
{
    VkCommandBuffer commands = gpu_begin(&device);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    for (int k = 0; k < IMAGES; ++k) {
        gpu_upload(commands, &o->uploads[k], &o->images[k], VK_IMAGE_ASPECT_COLOR_BIT);
    }
    if (s->desc.environment) {
        upload_cube(commands, &s->env.specular, &o->cubes[0], &o->cube_uploads[0]);
        upload_cube(commands, &s->env.irradiance, &o->cubes[1], &o->cube_uploads[1]);
    }
    if (s->desc.atlas) {
        gpu_upload(commands, &o->buffers[BUFFER_ATLAS], &o->atlas, VK_IMAGE_ASPECT_COLOR_BIT);
    }
    if (s->desc.table) {
        assert_int_equal(hdrp_gpu_vk_fgd_bake(&gpu, commands, &o->fgd), HDRP_OK);
    }
    assert_int_equal(hdrp_gpu_vk_write_lighting(&gpu, commands, &o->lighting), HDRP_OK);
    return commands;
}

static hdrp_gpu_vk_variants make_variants(const uint32_t* words, uint32_t count)
{
    hdrp_gpu_vk_variants v;
    assert_int_equal(hdrp_gpu_vk_variants_create(&gpu, words, count, &v), HDRP_OK);
    return v;
}

/* ---- classification -------------------------------------------------------------------------- */

static hdrp_gpu_vk_buffer copied(VkCommandBuffer commands, const hdrp_gpu_vk_buffer* from)
{
    hdrp_gpu_vk_buffer to = gpu_host_buffer(&gpu, from->bytes);
    const VkBufferCopy all = {0, 0, from->bytes};
    vkCmdCopyBuffer(commands, from->buffer, to.buffer, 1, &all);
    return to;
}

static void expect_words(hdrp_gpu_vk_buffer* back, const uint32_t* expected, size_t count)
{
    const uint32_t* found = gpu_map(&device, back);
    for (size_t i = 0; i < count; ++i) {
        assert_int_equal(found[i], expected[i]);
    }
    gpu_unmap(&device, back);
    hdrp_gpu_vk_buffer_destroy(&gpu, back);
}

/* Against the functions of the CPU, for variants that need no pipelines. */
static void expect_classified(const scene_desc* desc, const hdrp_gpu_vk_variants* stand_ins,
                              const uint32_t* masks, uint32_t count, uint32_t* uncovered)
{
    scene s = make_scene(desc);
    on_device o;
    uint32_t tiles = s.lists.grid.tiles.z * s.lists.grid.tiles.w;
    uint32_t* words = cpu_words(&s);
    uint8_t* chosen = malloc(tiles);
    uint32_t* chosen_words = malloc(tiles * sizeof *chosen_words);
    uint32_t* list = malloc(tiles * sizeof *list);
    hdrp_cull_arguments arguments[HDRP_CULL_VARIANT_MAX];
    hdrp_cull_variant_list variants = {masks, NULL, count};
    hdrp_cull_dispatch dispatch = {arguments, list, count, tiles, 0, 0, 0, 0};
    hdrp_gpu_vk_variants made = *stand_ins;
    hdrp_gpu_vk_buffer back[4];
    VkCommandBuffer commands;
    uint32_t results[4];
    assert_true(chosen && chosen_words && list);
    made.count = count;
    memcpy(made.words, masks, count * sizeof *masks);
    assert_int_equal(hdrp_cull_assign_variants(&variants, words, chosen, 0, tiles), HDRP_OK);
    assert_int_equal(
        hdrp_cull_build_dispatch(&dispatch, chosen, s.lists.grid.tiles.z, s.lists.grid.tiles.w),
        HDRP_OK);
    to_device(&s, &o);
    commands = begin(&s, &o);
    assert_int_equal(hdrp_gpu_vk_classify(&gpu, commands, &o.lighting, &made, &o.tiles), HDRP_OK);
    back[0] = copied(commands, &o.tiles.words);
    back[1] = copied(commands, &o.tiles.chosen);
    back[2] = copied(commands, &o.tiles.list);
    back[3] = copied(commands, &o.tiles.arguments);
    gpu_run(&device);
    for (uint32_t i = 0; i < tiles; ++i) {
        chosen_words[i] = chosen[i];
    }
    expect_words(&back[0], words, tiles);
    expect_words(&back[1], chosen_words, tiles);
    expect_words(&back[2], list, dispatch.listed);
    memcpy(results, (uint32_t*)gpu_map(&device, &back[3]) + 4u * HDRP_CULL_VARIANT_MAX,
           sizeof results);
    gpu_unmap(&device, &back[3]);
    assert_int_equal(results[0], dispatch.listed);
    assert_int_equal(results[1], dispatch.empty);
    assert_int_equal(results[2], dispatch.uncovered);
    assert_int_equal(results[3], 0);
    expect_words(&back[3], (const uint32_t*)arguments, 4u * count);
    *uncovered = dispatch.uncovered;
    free_device(&o);
    free_scene(&s);
    free(words);
    free(chosen);
    free(chosen_words);
    free(list);
}

#define FRAME                                                                                      \
    (HDRP_GPU_VK_WORD_LIT | HDRP_GPU_VK_WORD_DIRECTIONAL | HDRP_GPU_VK_WORD_SHADOW_MASK |          \
     HDRP_GPU_VK_WORD_ENVIRONMENT | HDRP_GPU_VK_WORD_NEGATIVE | HDRP_GPU_VK_WORD_SHADOW)
#define OF(features) ((uint32_t)(features) << HDRP_GPU_VK_WORD_MATERIAL_SHIFT)

static void tiles_are_classified_as_on_the_cpu(void** state)
{
    const scene_desc sizes[] = {
        {.width = 1, .height = 1, .tile = 16, .lights = 3, .materials = 31u},
        {.width = 130, .height = 75, .tile = 16, .lights = 60, .materials = 31u, .split = true},
        {.width = 97, .height = 33, .tile = 8, .lights = 40, .directional = 2, .materials = 31u},
        {.width = 203, .height = 150, .tile = 32, .lights = 200, .materials = 5u, .slices = 8},
        {.width = 75, .height = 65, .tile = 5, .lights = 0, .materials = 31u, .plain = true},
        {.width = 64, .height = 64, .tile = 16, .lights = 20, .sky_only = true},
        {.width = 64, .height = 64, .tile = 16, .lights = 20, .blockers = true},
        {.width = 640, .height = 500, .tile = 8, .lights = 30, .materials = 31u}, /* many tiles */
    };
    uint32_t masks[HDRP_CULL_VARIANT_MAX];
    uint32_t uncovered = 0, all_uncovered = 0, none = HDRP_GPU_VK_WORD_LIT;
    hdrp_gpu_vk_variants made = make_variants(&none, 1);
    (void)state;
    for (uint32_t i = 0; i < HDRP_CULL_VARIANT_MAX; ++i) {
        uint32_t lights = i % 4u == 0u ? 0u : i % 4u == 1u ? 0xcu : HDRP_GPU_VK_WORD_LIGHTS;
        masks[i] = FRAME | lights | OF(i >> 1);
    }
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        expect_classified(&sizes[i], &made, masks, HDRP_CULL_VARIANT_MAX, &uncovered);
        all_uncovered += uncovered;
        masks[7] = HDRP_GPU_VK_WORD_ALL;
        expect_classified(&sizes[i], &made, masks, 8, &uncovered);
        assert_int_equal(uncovered, 0);
        masks[7] = masks[0] = FRAME;
    }
    assert_true(all_uncovered > 0);
    hdrp_gpu_vk_variants_destroy(&gpu, &made);
}

/* ---- deferred lighting ----------------------------------------------------------------------- */

#define UNTOUCHED (-3.0f)

static void clear(VkCommandBuffer commands, const hdrp_gpu_vk_image* image, float value)
{
    const VkClearColorValue color = {{value, value, value, value}};
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    change(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    vkCmdClearColorImage(commands, image->image, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &all);
}

/* What deferred lighting writes, and into the second half the diffuse part. */
static hdrp_v4* light(const scene* s, const hdrp_gpu_vk_variants* variants)
{
    on_device o;
    size_t bytes = pixels_of(s) * sizeof(hdrp_v4);
    hdrp_v4* result = malloc(2u * bytes);
    hdrp_gpu_vk_buffer back[2];
    hdrp_gpu_vk_lit lit = {VK_NULL_HANDLE, VK_NULL_HANDLE};
    VkCommandBuffer commands;
    assert_non_null(result);
    to_device(s, &o);
    lit.color = o.color.view;
    lit.diffuse = s->desc.split ? o.diffuse.view : VK_NULL_HANDLE;
    commands = begin(s, &o);
    clear(commands, &o.color, UNTOUCHED);
    clear(commands, &o.diffuse, UNTOUCHED);
    assert_int_equal(hdrp_gpu_vk_classify(&gpu, commands, &o.lighting, variants, &o.tiles),
                     HDRP_OK);
    assert_int_equal(
        hdrp_gpu_vk_light_deferred(&gpu, commands, &o.lighting, variants, &o.tiles, &lit), HDRP_OK);
    back[0] = gpu_host_buffer(&gpu, bytes);
    back[1] = gpu_host_buffer(&gpu, bytes);
    change(commands, &o.color, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    change(commands, &o.diffuse, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    gpu_download(commands, &o.color, &back[0]);
    gpu_download(commands, &o.diffuse, &back[1]);
    gpu_run(&device);
    for (int k = 0; k < 2; ++k) {
        memcpy((char*)result + (size_t)k * bytes, gpu_map(&device, &back[k]), bytes);
        gpu_unmap(&device, &back[k]);
        hdrp_gpu_vk_buffer_destroy(&gpu, &back[k]);
    }
    free_device(&o);
    return result;
}

static void expect_untouched(hdrp_v4 v)
{
    assert_true(v.x == UNTOUCHED && v.y == UNTOUCHED && v.z == UNTOUCHED && v.w == UNTOUCHED);
}

/* Compares with the loop of the CPU over all lights. */
static void expect_lit(const char* name, const scene_desc* desc,
                       const hdrp_gpu_vk_variants* variants)
{
    scene s = make_scene(desc);
    hdrp_v4* found = light(&s, variants);
    double error = 0.0, reference = 0.0, worst = 0.0;
    uint32_t lit = 0, apart = 0;
    assert_true(!desc->blockers || s.blocked_pixels > 100);
    for (size_t i = 0; i < pixels_of(&s); ++i) {
        uint32_t x = (uint32_t)(i % desc->width), y = (uint32_t)(i / desc->width);
        hdrp_v3 sum = hdrp_v3_from_v4(found[i]), difference, expected;
        cpu_pixel p;
        float scale;
        if (!is_deferred(&s, i)) {
            expect_untouched(found[i]);
            expect_untouched(found[pixels_of(&s) + i]);
            continue;
        }
        p = shade(&s, x, y);
        expected = hdrp_v3_add(p.diffuse, p.specular);
        if (desc->split && p.features & HDRP_BRDF_FEATURE_SUBSURFACE) {
            hdrp_v3 diffuse = hdrp_v3_from_v4(found[pixels_of(&s) + i]);
            difference = hdrp_v3_sub(diffuse, p.diffuse);
            scale = hdrp_v3_length(p.diffuse) + 1e-2f;
            assert_true(hdrp_v3_length(difference) < 0.01f * scale);
            sum = hdrp_v3_add(sum, diffuse);
            ++apart;
        } else {
            expect_untouched(found[pixels_of(&s) + i]);
        }
        assert_true(found[i].w == 1.0f);
        difference = hdrp_v3_sub(sum, expected);
        error += (double)hdrp_v3_dot(difference, difference);
        reference += (double)hdrp_v3_dot(expected, expected);
        worst =
            fmax(worst, (double)(hdrp_v3_length(difference) / (hdrp_v3_length(expected) + 0.05f)));
        ++lit;
    }
    if (lit > 0) {
        printf("%s: %u pixels, %u of them in parts, relative RMSE %.2g, worst pixel %.2g\n", name,
               lit, apart, reference > 0.0 ? sqrt(error / reference) : 0.0, worst);
        /* Devices decode sRGB as coarsely as its codes allow. */
        assert_true(error <= (desc->srgb ? 4e-6 : 1e-6) * reference);
        assert_true(worst < 0.02);
    }
    free(found);
    free_scene(&s);
}

static void pixels_are_lit_as_on_the_cpu(void** state)
{
    const uint32_t words[] = {
        FRAME | 0xcu,
        HDRP_GPU_VK_WORD_ALL,
    };
    static const struct {
        const char* name;
        scene_desc desc;
    } cases[] = {
        {"one pixel", {.width = 1, .height = 1, .tile = 16, .lights = 2, .plain = true}},
        {"points and spots",
         {.width = 97, .height = 61, .tile = 16, .lights = 50, .types = 0xcu, .plain = true}},
        {"sRGB", {.width = 40, .height = 30, .tile = 16, .lights = 20, .srgb = true}},
        {"no lights", {.width = 40, .height = 30, .tile = 16, .materials = 31u}},
        {"every material",
         {.width = 120,
          .height = 75,
          .tile = 16,
          .lights = 40,
          .directional = 2,
          .materials = 31u,
          .environment = true,
          .table = true,
          .masked = true}},
        {"in parts",
         {.width = 75,
          .height = 50,
          .tile = 8,
          .lights = 30,
          .directional = 1,
          .materials = 31u,
          .environment = true,
          .harmonics = true,
          .split = true,
          .list_flags = HDRP_CULL_PIXELS | HDRP_CULL_BLOCKS}},
        {"a thousand lights",
         {.width = 64,
          .height = 48,
          .tile = 16,
          .lights = 1000,
          .materials = 16u,
          .list_flags = HDRP_CULL_PIXELS | HDRP_CULL_MASKS}},
        {"slices",
         {.width = 64, .height = 48, .tile = 32, .lights = 100, .materials = 31u, .slices = 16}},
        {"shadows",
         {.width = 64, .height = 40, .tile = 16, .lights = 200, .materials = 16u, .atlas = true}},
        {"blockers",
         {.width = 75,
          .height = 50,
          .tile = 16,
          .lights = 80,
          .directional = 2,
          .materials = 16u,
          .list_flags = HDRP_CULL_PIXELS | HDRP_CULL_BLOCKS | HDRP_CULL_MASKS,
          .blockers = true}},
        {"blockers in slices",
         {.width = 64, .height = 48, .tile = 32, .lights = 60, .slices = 8, .blockers = true}},
        {"sky", {.width = 40, .height = 30, .tile = 16, .lights = 5, .sky_only = true}},
    };
    hdrp_gpu_vk_variants variants = make_variants(words, 2);
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        expect_lit(cases[i].name, &cases[i].desc, &variants);
    }
    hdrp_gpu_vk_variants_destroy(&gpu, &variants);
}

/* As on a device that takes few groups side by side: rows of them light what is left. */
static void more_tiles_than_a_row_of_groups_are_lit(void** state)
{
    const uint32_t words[] = {FRAME | 0xcu, HDRP_GPU_VK_WORD_ALL};
    const scene_desc desc = {.width = 75, .height = 50, .tile = 8, .lights = 30, .materials = 16u};
    hdrp_gpu_vk_variants variants = make_variants(words, 2);
    uint32_t groups_max = gpu.groups_max;
    (void)state;
    gpu.groups_max = 7u;
    expect_lit("rows of 7 groups", &desc, &variants);
    gpu.groups_max = groups_max;
    hdrp_gpu_vk_variants_destroy(&gpu, &variants);
}

/* Light that is written apart, and what is left, make what is written together. */
static void parts_sum_up(void** state)
{
    const uint32_t words[] = {HDRP_GPU_VK_WORD_ALL};
    scene_desc desc = {.width = 120,
                       .height = 28,
                       .tile = 16,
                       .lights = 20,
                       .directional = 1,
                       .materials = 19u,
                       .environment = true,
                       .harmonics = true,
                       .srgb = true};
    hdrp_gpu_vk_variants variants = make_variants(words, 1);
    scene s = make_scene(&desc);
    hdrp_v4 *whole = light(&s, &variants), *parts;
    size_t apart = 0;
    (void)state;
    s.desc.split = true;
    parts = light(&s, &variants);
    for (size_t i = 0; i < pixels_of(&s); ++i) {
        hdrp_v4 below = parts[pixels_of(&s) + i];
        hdrp_v3 sum = hdrp_v3_from_v4(parts[i]), expected = hdrp_v3_from_v4(whole[i]);
        if (below.w == 1.0f) {
            sum = hdrp_v3_add(sum, hdrp_v3_from_v4(below));
            ++apart;
        } else {
            expect_untouched(below);
        }
        assert_true(hdrp_v3_length(hdrp_v3_sub(sum, expected)) <=
                    1e-5f * (hdrp_v3_length(expected) + 1.0f));
        expect_untouched(whole[pixels_of(&s) + i]);
    }
    assert_true(apart > 100);
    free(whole);
    free(parts);
    free_scene(&s);
    hdrp_gpu_vk_variants_destroy(&gpu, &variants);
}

static void expect_refused(const on_device* o, const hdrp_gpu_vk_variants* v,
                           const hdrp_gpu_vk_lighting* lighting, hdrp_result expected)
{
    const hdrp_gpu_vk_lit lit = {o->color.view, VK_NULL_HANDLE};
    assert_int_equal(hdrp_gpu_vk_classify(&gpu, device.commands, lighting, v, &o->tiles), expected);
    assert_int_equal(
        hdrp_gpu_vk_light_deferred(&gpu, device.commands, lighting, v, &o->tiles, &lit), expected);
}

static void expect_missing_pointers_are_refused(const on_device* o, const hdrp_gpu_vk_variants* v)
{
    const hdrp_gpu_vk_lit lit = {o->color.view, VK_NULL_HANDLE}, none = {0};
    const hdrp_gpu_vk_lighting* l = &o->lighting;
    VkCommandBuffer c = device.commands;
    hdrp_gpu_vk_lighting split = o->lighting;
    split.split = 1u;
    assert_int_equal(hdrp_gpu_vk_write_lighting(NULL, c, l), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_write_lighting(&gpu, NULL, l), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_write_lighting(&gpu, c, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_classify(NULL, c, l, v, &o->tiles), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_classify(&gpu, NULL, l, v, &o->tiles), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_classify(&gpu, c, NULL, v, &o->tiles), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_classify(&gpu, c, l, NULL, &o->tiles), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_classify(&gpu, c, l, v, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_light_deferred(&gpu, c, l, v, &o->tiles, NULL),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_light_deferred(&gpu, c, l, v, &o->tiles, &none),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_light_deferred(&gpu, c, &split, v, &o->tiles, &lit),
                     HDRP_ERROR_NULL_POINTER);
}

static void expect_bad_blockers_are_refused(const on_device* o, const hdrp_gpu_vk_variants* v)
{
#define REFUSED(change, expected)                                                                  \
    bad = o->blockers;                                                                             \
    bad.change;                                                                                    \
    expect_refused(o, v, &lighting, expected)
    hdrp_gpu_vk_lighting lighting = o->lighting;
    hdrp_gpu_vk_blockers bad;
    lighting.blockers = &bad;
    REFUSED(lights.buffer = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(links.buffer = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(blockers.buffer = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(masks.buffer = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(lights.bytes -= 1u, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(light_count += 1u, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(links.bytes = 3u, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(blockers.bytes = 79u, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(masks.bytes -= 4u, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(masks.offset = 1u, HDRP_ERROR_BAD_ARGUMENT);
#undef REFUSED
}

/* Each in turn, with one member that is not what it should be. */
static void expect_bad_members_are_refused(const on_device* o, const hdrp_gpu_vk_variants* v)
{
#define REFUSED(change, expected)                                                                  \
    bad = o->lighting;                                                                             \
    bad.change;                                                                                    \
    expect_refused(o, v, &bad, expected)
    hdrp_gpu_vk_lighting bad;
    REFUSED(params = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(depth = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(rt[0] = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(rt[3] = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(lights.buffer = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(cells.buffer = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(entries.buffer = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(tiles.buffer = VK_NULL_HANDLE, HDRP_ERROR_NULL_POINTER);
    REFUSED(list_flags = HDRP_CULL_MASKS, HDRP_ERROR_NULL_POINTER);
    REFUSED(width_px = 0, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(width_px = 33, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(height_px = 16385, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(grid.tiles.x = 0, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(grid.cells.x = 0, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(grid.cells.y = 0, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(light_count = 0, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(first_directional = 100, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(directional_count = 100, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(masked_count = 5, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(exposure = -1.0f, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(exposure = NAN, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(exposure = INFINITY, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(params_offset = 16, HDRP_ERROR_BAD_ARGUMENT);
    REFUSED(lights.offset = 1, HDRP_ERROR_BAD_ARGUMENT);
    expect_bad_blockers_are_refused(o, v);
    bad = o->lighting;
    bad.fgd = o->color.view;
    bad.fgd_size = 1u;
    expect_refused(o, v, &bad, HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_write_lighting(&gpu, device.commands, &bad),
                     HDRP_ERROR_BAD_ARGUMENT);
    bad = o->lighting;
    bad.grid.cells.x = HDRP_CULL_SLICES_MAX;
    bad.grid.cells.y = 0xffffffffu;
    bad.blockers = NULL;
    expect_refused(o, v, &bad, HDRP_ERROR_TOO_LARGE);
#undef REFUSED
}

static void what_cannot_be_lit_is_refused(void** state)
{
    const scene_desc desc = {
        .width = 32, .height = 16, .tile = 16, .lights = 12, .plain = true, .blockers = true};
    const uint32_t words[] = {HDRP_GPU_VK_WORD_LIT, HDRP_GPU_VK_WORD_LIT};
    hdrp_gpu_vk_variants v = make_variants(words, 2), other;
    hdrp_gpu_vk small = gpu;
    hdrp_gpu_vk_tiles tiles;
    hdrp_cull_grid grid;
    scene s = make_scene(&desc);
    on_device o;
    (void)state;
    to_device(&s, &o);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    gpu_begin(&device);
    expect_missing_pointers_are_refused(&o, &v);
    expect_bad_members_are_refused(&o, &v);
    assert_int_equal(gpu.passes_recorded, 0);
    gpu_run(&device);
    assert_int_equal(hdrp_gpu_vk_variants_create(NULL, words, 1, &other), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_variants_create(&gpu, NULL, 1, &other), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_variants_create(&gpu, words, 1, NULL), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_variants_create(&gpu, words, 0, &other), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_variants_create(&gpu, words, 65, &other), HDRP_ERROR_BAD_ARGUMENT);
    grid = s.lists.grid;
    grid.tiles.w = 0;
    assert_int_equal(hdrp_gpu_vk_tiles_create(&gpu, grid, &tiles), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_gpu_vk_tiles_create(NULL, grid, &tiles), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_tiles_create(&gpu, grid, NULL), HDRP_ERROR_NULL_POINTER);
    small.buffer_range_max = 4u * s.lists.grid.tiles.z * s.lists.grid.tiles.w - 1u;
    assert_int_equal(hdrp_gpu_vk_tiles_create(&small, s.lists.grid, &tiles), HDRP_ERROR_TOO_LARGE);
    ++small.buffer_range_max;
    assert_int_equal(hdrp_gpu_vk_tiles_create(&small, s.lists.grid, &tiles), HDRP_OK);
    hdrp_gpu_vk_tiles_destroy(&gpu, &tiles);
    hdrp_gpu_vk_variants_destroy(&gpu, NULL);
    hdrp_gpu_vk_tiles_destroy(&gpu, NULL);
    free_device(&o);
    free_scene(&s);
    hdrp_gpu_vk_variants_destroy(&gpu, &v);
    assert_int_equal(v.count, 0);
    hdrp_gpu_vk_variants_destroy(&gpu, &v);
    memset(&small, 0, sizeof small);
    hdrp_gpu_vk_variants_destroy(&small, &v); /* a context that was destroyed before */
}

/* A context without the pass has no variants, and records nothing. */
static void a_pass_that_was_not_asked_for_is_refused(void** state)
{
    hdrp_gpu_vk_desc desc = gpu_desc(&device);
    const uint32_t word = HDRP_GPU_VK_WORD_LIT;
    hdrp_gpu_vk_variants v;
    hdrp_gpu_vk other;
    (void)state;
    desc.passes = HDRP_GPU_VK_PASS_DEPTH;
    assert_int_equal(hdrp_gpu_vk_init(&other, &desc), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_variants_create(&other, &word, 1, &v), HDRP_ERROR_UNSUPPORTED);
    hdrp_gpu_vk_destroy(&other);
}

static void words_say_what_is_needed(void** state)
{
    hdrp_light lamp = hdrp_light_point(hdrp_v3_splat(0.0f), hdrp_v3_splat(1.0f), 5.0f);
    uint32_t shape;
    (void)state;
    lamp.bits.x |= HDRP_LIGHT_FEATURE_SHADOW | HDRP_LIGHT_FEATURE_COOKIE;
    shape = hdrp_cull_shape_from_light(lamp).bits.z;
    assert_int_equal(hdrp_gpu_vk_word_of_light(lamp.bits.x), shape & HDRP_GPU_VK_WORD_ALL);
    assert_int_equal(hdrp_gpu_vk_word_of_light(HDRP_LIGHT_TYPE_SPHERE), 0);
    assert_int_equal(hdrp_gpu_vk_word_of_light(HDRP_LIGHT_FEATURE_SHADOW), 0);
    assert_int_equal(hdrp_gpu_vk_word_of_light(18u), 0);
    assert_int_equal(hdrp_gpu_vk_word_of_material(0, HDRP_GPU_VK_WORD_SPLIT), HDRP_GPU_VK_WORD_LIT);
    assert_int_equal(hdrp_gpu_vk_word_of_material(1, HDRP_GPU_VK_WORD_SPLIT),
                     HDRP_GPU_VK_WORD_LIT | HDRP_GPU_VK_WORD_SPLIT | OF(1));
    assert_int_equal(hdrp_gpu_vk_word_of_tile(0, 4, 0xffffffffu), 0);
    assert_int_equal(hdrp_gpu_vk_word_of_tile(HDRP_GPU_VK_WORD_LIT, HDRP_GPU_VK_WORD_SHADOW | 4u,
                                              HDRP_GPU_VK_WORD_SPLIT),
                     HDRP_GPU_VK_WORD_LIT | 4u);
    assert_int_equal(hdrp_gpu_vk_word_of_tile(HDRP_GPU_VK_WORD_LIT, HDRP_GPU_VK_WORD_SHADOW | 4u,
                                              HDRP_GPU_VK_WORD_SHADOW),
                     HDRP_GPU_VK_WORD_LIT | HDRP_GPU_VK_WORD_SHADOW | 4u);
}

static int set_up(void** state)
{
    const hdrp_gpu_vk_desc desc = gpu_desc(&device);
    (void)state;
    hdrp_brdf_fgd_bake_rows(fgd_of_cpu, (int)FGD_SIZE, 0, (int)FGD_SIZE);
    return hdrp_gpu_vk_init(&gpu, &desc) != HDRP_OK;
}

static int tear_down(void** state)
{
    (void)state;
    hdrp_gpu_vk_destroy(&gpu);
    return device.messages != 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(tiles_are_classified_as_on_the_cpu, set_up, tear_down),
        cmocka_unit_test_setup_teardown(pixels_are_lit_as_on_the_cpu, set_up, tear_down),
        cmocka_unit_test_setup_teardown(more_tiles_than_a_row_of_groups_are_lit, set_up, tear_down),
        cmocka_unit_test_setup_teardown(parts_sum_up, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_cannot_be_lit_is_refused, set_up, tear_down),
        cmocka_unit_test(a_pass_that_was_not_asked_for_is_refused),
        cmocka_unit_test(words_say_what_is_needed),
    };
    int failed;
    if (!gpu_open_writing(&device)) {
        return GPU_SKIPPED;
    }
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    gpu_close(&device);
    return failed;
}
