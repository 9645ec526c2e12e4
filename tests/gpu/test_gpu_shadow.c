/* test_gpu_shadow.c - shadows on the device against those of the CPU and against traced rays.
 * SPDX-License-Identifier: MIT */
#include "gpu_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hdrp_pack.h"

#include "../shadow_scene.h"

#define ATLAS   512u
#define VIEWS   8u
#define LIGHTS  HDRP_GPU_VK_SHADOW_LIGHTS
#define ONE_BIT (1.0f / 255.0f)

static gpu_device device;
static hdrp_gpu_vk gpu;

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

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

/* ---- a picture ------------------------------------------------------------------------------- */

/* A plane and a ball over it, as a camera sees them, with the maps of up to four lights. */
typedef struct picture {
    uint32_t width, height;
    scene world;
    hdrp_cull_camera camera;
    const hdrp_depth_params* params; /* NULL: metres */
    bool depth_format, plain_normals;
    hdrp_shadow_view views[VIEWS];
    uint32_t view_count, first, cascades[LIGHTS];
    hdrp_v3 lights[LIGHTS]; /* towards them */
    float* depths;
    uint8_t* codes; /* of the normal buffer */
    float* normals; /* four floats each */
    float atlas[ATLAS * ATLAS];
} picture;

static size_t pixels_of(const picture* p)
{
    return (size_t)p->width * p->height;
}

static hdrp_v3 eye_of(const picture* p)
{
    return hdrp_v3_from_v4(p->camera.eye_near);
}

/* What the shader makes of a pixel and its depth. */
static hdrp_v3 position_of(const picture* p, float x_px, float y_px, float z)
{
    return hdrp_v3_add(eye_of(p), hdrp_cull_offset_of_pixel(p->camera, x_px, y_px, (float)p->width,
                                                            (float)p->height, z));
}

static hdrp_v3 position_of_pixel(const picture* p, uint32_t x, uint32_t y, float z)
{
    return position_of(p, (float)x + 0.5f, (float)y + 0.5f, z);
}

/* The depth of the picture at a pixel in metres, or an infinite one. */
static float depth_of(const picture* p, size_t i)
{
    return p->params ? hdrp_view_depth(*p->params, p->depths[i]) : p->depths[i];
}

static hdrp_v3 normal_at(const scene* s, hdrp_v3 at)
{
    hdrp_v3 d = hdrp_v3_sub(at, s->center);
    return fabsf(hdrp_v3_length(d) - s->radius) < 1e-3f * s->radius ? hdrp_v3_normalize(d) : s->n;
}

/* Depths and normals of the picture, by rays from the eye. */
static void fill(picture* p)
{
    p->depths = malloc(pixels_of(p) * sizeof *p->depths);
    p->codes = malloc(pixels_of(p) * 4);
    p->normals = malloc(pixels_of(p) * 4 * sizeof *p->normals);
    for (size_t i = 0; i < pixels_of(p); ++i) {
        uint32_t x = (uint32_t)(i % p->width), y = (uint32_t)(i / p->width);
        hdrp_v3 a = position_of_pixel(p, x, y, 0.0f), b = position_of_pixel(p, x, y, 1.0f);
        const double from[3] = {(double)a.x, (double)a.y, (double)a.z};
        const double along[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y,
                                 (double)b.z - (double)a.z};
        double t = scene_trace(&p->world, from, along);
        float z = t >= 0.0 && t < (double)p->camera.right_far.w ? (float)t : HDRP_DEPTH_INFINITE;
        hdrp_v3 n = normal_at(&p->world, position_of_pixel(p, x, y, z));
        hdrp_v4 code = hdrp_pack_normal_buffer_encode(n, 0.5f);
        const float coded[4] = {code.x, code.y, code.z, code.w};
        const float plain[4] = {n.x * 3.0f, n.y * 3.0f, n.z * 3.0f, 0.0f};
        p->depths[i] = p->params ? hdrp_device_depth(*p->params, z) : z;
        for (int k = 0; k < 4; ++k) {
            p->codes[4 * i + (size_t)k] = (uint8_t)lrintf(coded[k] * 255.0f);
        }
        memcpy(p->normals + 4 * i, plain, sizeof plain);
    }
    for (uint32_t i = 0; i < p->view_count; ++i) {
        scene_draw(&p->views[i], &p->world, p->atlas, ATLAS);
    }
}

static void release(picture* p)
{
    free(p->depths);
    free(p->codes);
    free(p->normals);
    free(p);
}

/* The normal that the shader reads. */
static hdrp_v3 normal_of(const picture* p, size_t i)
{
    const uint8_t* c = p->codes + 4 * i;
    if (p->plain_normals) {
        const float* n = p->normals + 4 * i;
        return hdrp_normalize_or(v3(n[0], n[1], n[2]), v3(0.0f, 1.0f, 0.0f));
    }
    return hdrp_pack_normal_buffer_decode(hdrp_v4_make((float)c[0] / 255.0f, (float)c[1] / 255.0f,
                                                       (float)c[2] / 255.0f, (float)c[3] / 255.0f))
        .normal;
}

/* ---- the pass -------------------------------------------------------------------------------- */

static hdrp_gpu_vk_image image_of(VkFormat format, uint32_t width, uint32_t height,
                                  VkImageUsageFlags usage)
{
    hdrp_gpu_vk_image image;
    assert_int_equal(hdrp_gpu_vk_image_create(&gpu, format, width, height, usage, NULL, &image),
                     HDRP_OK);
    return image;
}

/* An image with contents; a depth image where it is said. */
static hdrp_gpu_vk_image upload(VkCommandBuffer commands, VkFormat format, uint32_t width,
                                uint32_t height, const void* texels, size_t bytes,
                                hdrp_gpu_vk_buffer* staging)
{
    bool is_depth = format == VK_FORMAT_D32_SFLOAT;
    hdrp_gpu_vk_image image =
        is_depth ? gpu_depth_image(&device, width, height)
                 : image_of(format, width, height,
                            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    *staging = gpu_host_buffer(&gpu, bytes);
    memcpy(gpu_map(&device, staging), texels, bytes);
    gpu_unmap(&device, staging);
    gpu_upload(commands, staging, &image,
               is_depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT);
    return image;
}

static void destroy(hdrp_gpu_vk_image* image, bool is_depth)
{
    if (is_depth) {
        gpu_image_destroy(&device, image);
    } else {
        hdrp_gpu_vk_image_destroy(&gpu, image);
    }
}

/* Visibilities of the device, `channels` of each pixel; to be freed. */
static uint8_t* resolve(const picture* p, uint32_t channels)
{
    VkFormat depth_format = p->depth_format ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_R32_SFLOAT;
    hdrp_gpu_vk_buffer staging[3], views = gpu_host_buffer(&gpu, sizeof p->views + 256);
    hdrp_gpu_vk_buffer result = gpu_host_buffer(&gpu, (pixels_of(p) * channels + 3) / 4 * 4);
    hdrp_gpu_vk_image visibility = image_of(
        channels == 1 ? VK_FORMAT_R8_UNORM : VK_FORMAT_R8G8B8A8_UNORM, p->width, p->height,
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    VkCommandBuffer commands = gpu_begin(&device);
    hdrp_gpu_vk_image depth = upload(commands, depth_format, p->width, p->height, p->depths,
                                     pixels_of(p) * 4, &staging[0]);
    hdrp_gpu_vk_image normals = p->plain_normals
                                    ? upload(commands, VK_FORMAT_R32G32B32A32_SFLOAT, p->width,
                                             p->height, p->normals, pixels_of(p) * 16, &staging[1])
                                    : upload(commands, VK_FORMAT_R8G8B8A8_UNORM, p->width,
                                             p->height, p->codes, pixels_of(p) * 4, &staging[1]);
    hdrp_gpu_vk_image atlas =
        upload(commands, depth_format, ATLAS, ATLAS, p->atlas, sizeof p->atlas, &staging[2]);
    hdrp_gpu_vk_shadow shadow = {0};
    uint8_t* r = malloc(pixels_of(p) * channels);
    assert_non_null(r);
    memcpy((unsigned char*)gpu_map(&device, &views) + 256, p->views, sizeof p->views);
    gpu_unmap(&device, &views);
    shadow.width_px = p->width;
    shadow.height_px = p->height;
    shadow.depth = depth.view;
    shadow.normals = normals.view;
    shadow.normals_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    shadow.atlas = atlas.view;
    shadow.flags = p->plain_normals ? HDRP_GPU_VK_SHADOW_PLAIN_NORMALS : 0;
    shadow.device = p->params;
    shadow.camera = p->camera;
    shadow.views = views.buffer;
    shadow.views_offset = 256;
    shadow.view_count = VIEWS;
    shadow.first = p->first;
    memcpy(shadow.cascades, p->cascades, sizeof shadow.cascades);
    assert_int_equal(hdrp_gpu_vk_begin_frame(&gpu, 0), HDRP_OK);
    assert_int_equal(hdrp_gpu_vk_resolve_shadows(&gpu, commands, &shadow, &visibility), HDRP_OK);
    /* Again: what was written before does not matter. */
    assert_int_equal(hdrp_gpu_vk_resolve_shadows(&gpu, commands, &shadow, &visibility), HDRP_OK);
    gpu_download(commands, &visibility, &result);
    gpu_run(&device);
    memcpy(r, gpu_map(&device, &result), pixels_of(p) * channels);
    gpu_unmap(&device, &result);
    destroy(&depth, p->depth_format);
    destroy(&atlas, p->depth_format);
    destroy(&normals, false);
    destroy(&visibility, false);
    for (int i = 0; i < 3; ++i) {
        hdrp_gpu_vk_buffer_destroy(&gpu, &staging[i]);
    }
    hdrp_gpu_vk_buffer_destroy(&gpu, &result);
    hdrp_gpu_vk_buffer_destroy(&gpu, &views);
    return r;
}

/* ---- what is expected ------------------------------------------------------------------------ */

/* Whether what rays see near the edge of the shadow says nothing: how far the edge may be. */
static float doubt_of(const picture* p, uint32_t light, uint32_t first, hdrp_v3 at)
{
    float widest = 0.0f;
    (void)light;
    for (uint32_t i = first; i < first + p->cascades[light]; ++i) {
        if (hdrp_shadow_cascade_weight(p->views[i], at) > 0.0f) {
            const hdrp_shadow_view* v = &p->views[i];
            float w = hdrp_v4_dot(v->clip_w, hdrp_v4_from_v3(at, 1.0f));
            float slope = hdrp_v3_dot(p->world.n, hdrp_v3_from_v4(v->axis_texel));
            float texels = v->bias.x + hdrp_shadow_offset_texels(*v, slope, 0.0f) + 1.0f;
            widest = hdrp_max(widest, texels * v->axis_texel.w * w);
        }
    }
    return widest;
}

/* 1 lit, 0 shadowed by the ball, -1 too near its edge to say; on the plane. */
static int traced(const picture* p, hdrp_v3 at, hdrp_v3 l, float doubt)
{
    hdrp_v3 to = hdrp_v3_sub(p->world.center, at);
    float along = hdrp_v3_dot(to, l);
    float miss = hdrp_v3_length(hdrp_v3_mad(to, l, -along)) - p->world.radius;
    if (along < 0.0f) {
        miss = hdrp_v3_length(to) - p->world.radius; /* the ball is behind */
    }
    if (p->world.radius <= 0.0f || miss > doubt) {
        return 1;
    }
    return along > 0.0f && miss < -doubt ? 0 : -1;
}

static bool is_on_plane(const picture* p, hdrp_v3 at)
{
    return fabsf(hdrp_v3_dot(p->world.n, at) - p->world.distance) < 1e-3f;
}

typedef struct tally {
    uint32_t pixels, differ, judged, wrong, shadowed;
} tally;

static void count_pixel(const picture* p, const hdrp_shadow_atlas* atlas, uint32_t light,
                        uint32_t first, size_t i, uint8_t code, tally* t)
{
    float z = depth_of(p, i), found = (float)code * ONE_BIT, expected = 1.0f;
    bool is_sky = !(z < p->camera.right_far.w);
    hdrp_v3 at, n = normal_of(p, i);
    at = position_of_pixel(p, (uint32_t)(i % p->width), (uint32_t)(i / p->width), z);
    if (!is_sky && p->cascades[light] > 0) {
        expected =
            hdrp_shadow_cascades_visibility(atlas, p->views + first, p->cascades[light], at, n);
    }
    ++t->pixels;
    t->differ += fabsf(found - expected) > 0.502f * ONE_BIT + 1e-5f;
    if (!is_sky && p->cascades[light] > 0 && is_on_plane(p, at)) {
        int truth = traced(p, at, p->lights[light], doubt_of(p, light, first, at));
        float inside = 0.0f;
        for (uint32_t k = first; k < first + p->cascades[light]; ++k) {
            inside = hdrp_max(inside, hdrp_shadow_cascade_weight(p->views[k], at));
        }
        if (truth == 1 || (truth == 0 && inside >= 1.0f)) {
            ++t->judged;
            t->wrong += code != (truth ? 255 : 0);
            t->shadowed += truth == 0;
        }
    }
}

/* Renders, and compares with the CPU and with rays. */
static tally judge(const picture* p, uint32_t channels)
{
    const hdrp_shadow_atlas atlas = {p->atlas, ATLAS, ATLAS, 0};
    uint8_t* codes = resolve(p, channels);
    tally t = {0};
    uint32_t first = p->first;
    for (uint32_t light = 0; light < channels; ++light) {
        for (size_t i = 0; i < pixels_of(p); ++i) {
            count_pixel(p, &atlas, light, first, i, codes[i * channels + light], &t);
        }
        first += p->cascades[light];
    }
    free(codes);
    /* A comparison may turn where the device rounds otherwise. */
    if (t.differ * 1000u > (device.is_lavapipe ? 0u : t.pixels) || t.wrong) {
        fail_msg("%u of %u differ, %u of %u are wrong", t.differ, t.pixels, t.wrong, t.judged);
    }
    return t;
}

/* ---- scenes ---------------------------------------------------------------------------------- */

typedef struct options {
    hdrp_u32 filter_kind, reverse_maps;
    float slope_max, height; /* of the sun: y towards it */
    bool orthographic;
} options;

static void add_sun(picture* p, uint32_t light, uint32_t count, const options* o)
{
    hdrp_shadow_cascades d;
    uint32_t at = p->view_count;
    memset(&d, 0, sizeof d);
    p->lights[light] = hdrp_v3_normalize(v3(0.6f, o->height, 0.25f + 0.2f * (float)light));
    p->cascades[light] = count;
    if (count == 0) {
        return;
    }
    d.eye = eye_of(p);
    d.view_forward = hdrp_v3_from_v4(p->camera.forward_orthographic);
    d.extent = o->orthographic ? hdrp_v2_make(8.0f, 6.0f) : hdrp_v2_make(0.9f, 0.6f);
    d.orthographic = o->orthographic;
    d.near_m = 0.5f;
    d.far_m = 20.0f;
    d.log_weight = 0.7f;
    d.forward = hdrp_v3_neg(p->lights[light]);
    d.caster_m = 30.0f;
    d.count = count;
    d.settings = hdrp_shadow_settings_make(o->filter_kind, o->reverse_maps);
    d.settings.slope_max = o->slope_max;
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t k = at - p->first + i;
        d.maps[i] = hdrp_u32x4_make(k % 2 * 256, k / 2 * 256, 256, 0);
    }
    assert_int_equal(hdrp_shadow_make_cascades(&d, p->views + at), HDRP_OK);
    p->view_count += count;
}

static picture* picture_of(uint32_t width, uint32_t height, const options* o)
{
    picture* p = calloc(1, sizeof *p);
    const hdrp_v3 eye = v3(0.0f, 3.0f, 9.0f), forward = v3(0.0f, -0.25f, -1.0f);
    const hdrp_v3 up = v3(0.0f, 1.0f, 0.0f);
    assert_non_null(p);
    p->width = width;
    p->height = height;
    p->world.n = up;
    p->world.center = v3(0.0f, 1.6f, 1.0f);
    p->world.radius = 1.5f;
    p->camera = o->orthographic ? hdrp_cull_camera_orthographic(eye, forward, up, -8.0f, 8.0f,
                                                                -6.0f, 6.0f, 0.5f, 200.0f)
                                : hdrp_cull_camera_perspective(eye, forward, up, -0.8f, 0.9f, -0.6f,
                                                               0.5f, 0.5f, 200.0f);
    return p;
}

/* ---- tests ----------------------------------------------------------------------------------- */

static void shadows_are_those_of_the_cpu_and_of_rays(void** state)
{
    const hdrp_depth_params params[] = {
        hdrp_depth_params_perspective(0.5f, 200.0f, 1),
        hdrp_depth_params_perspective(0.5f, 200.0f, 0),
        hdrp_depth_params_perspective(0.5f, HDRP_DEPTH_INFINITE, 1)};
    uint32_t shadowed = 0;
    (void)state;
    for (uint32_t i = 0; i < 16; ++i) {
        options o = {i & 3u, i >> 2 & 1u, i & 8u ? 2.0f : 0.0f, 0.8f, false};
        picture* p = picture_of(161, 91, &o);
        tally t;
        p->params = i % 4 < 3 ? &params[i % 4] : NULL;
        p->depth_format = i % 2 == 0;
        p->plain_normals = i % 3 == 1;
        add_sun(p, 0, 1 + i % 4, &o);
        fill(p);
        t = judge(p, 1);
        assert_true(t.judged * 2u > t.pixels);
        shadowed += t.shadowed;
        release(p);
    }
    assert_true(shadowed > 500u);
}

static void an_orthographic_camera_sees_the_same(void** state)
{
    const hdrp_depth_params params[] = {hdrp_depth_params_orthographic(0.5f, 200.0f, 1),
                                        hdrp_depth_params_orthographic(0.5f, 200.0f, 0)};
    (void)state;
    for (uint32_t i = 0; i < 3; ++i) {
        options o = {HDRP_SHADOW_FILTER_TENT_3, 1, 0.0f, 0.8f, true};
        picture* p = picture_of(120, 67, &o);
        p->params = i < 2 ? &params[i] : NULL;
        add_sun(p, 0, 3, &o);
        fill(p);
        assert_true(judge(p, 1).shadowed > 10u);
        release(p);
    }
}

/* The sun near the horizon: a plane that shadows itself nowhere. */
static void a_plane_at_a_grazing_angle_has_no_acne(void** state)
{
    const float heights[] = {0.3f, 0.1f, 0.03f, 0.01f};
    (void)state;
    for (uint32_t i = 0; i < 16; ++i) {
        options o = {i & 3u, 1, i & 4u ? 2.0f : 0.0f, heights[i >> 2], false};
        picture* p = picture_of(96, 64, &o);
        p->world.radius = 0.0f;
        add_sun(p, 0, 4, &o);
        fill(p);
        assert_true(judge(p, 1).judged * 3u > 96u * 64u);
        release(p);
    }
}

static void four_lights_have_a_channel_each(void** state)
{
    options o = {HDRP_SHADOW_FILTER_BILINEAR, 1, 0.0f, 0.8f, false};
    picture* p = picture_of(70, 45, &o);
    (void)state;
    p->first = 1; /* views of something else come first */
    p->view_count = 1;
    memset(&p->views[0], 0, sizeof p->views[0]);
    p->views[0].limits = hdrp_v4_make(0.0f, 0.0f, -1.0f, -1.0f);
    add_sun(p, 0, 1, &o);
    add_sun(p, 1, 2, &o);
    add_sun(p, 2, 0, &o);
    add_sun(p, 3, 1, &o);
    fill(p);
    assert_true(judge(p, 4).shadowed > 10u);
    release(p);
}

/* A spot, whose view is given a ball that holds everything: the lookup of the light loop. */
static void a_spot_casts_the_shadow_that_rays_see(void** state)
{
    (void)state;
    for (uint32_t i = 0; i < 8; ++i) {
        options o = {i & 3u, i >> 2 & 1u, 0.0f, 0.8f, false};
        picture* p = picture_of(90, 60, &o);
        hdrp_shadow_settings s = hdrp_shadow_settings_make(o.filter_kind, o.reverse_maps);
        hdrp_light spot = hdrp_light_spot(v3(1.0f, 9.0f, 1.0f), v3(-0.1f, -1.0f, 0.0f),
                                          v3(1.0f, 1.0f, 1.0f), 30.0f, 0.5f, 0.7f);
        const hdrp_shadow_atlas atlas = {p->atlas, ATLAS, ATLAS, 0};
        uint8_t* codes;
        uint32_t dark = 0, differ = 0;
        p->views[0] = hdrp_shadow_view_light(spot, 0, 0.1f, hdrp_u32x4_make(0, 0, ATLAS, 0), s);
        p->views[0].ball.w = 1e9f;
        p->views[0].fade.x = 1.0f;
        p->view_count = 1;
        p->cascades[0] = 1;
        fill(p);
        codes = resolve(p, 1);
        for (size_t k = 0; k < pixels_of(p); ++k) {
            float z = depth_of(p, k), expected = 1.0f;
            if (z < p->camera.right_far.w) {
                hdrp_v3 n = normal_of(p, k);
                hdrp_v3 at =
                    position_of_pixel(p, (uint32_t)(k % p->width), (uint32_t)(k / p->width), z);
                hdrp_v3 l = hdrp_v3_sub(hdrp_v3_from_v4(spot.position_range), at);
                int truth = traced(p, at, hdrp_v3_normalize(l), 1.4f * doubt_of(p, 0, 0, at));
                expected = hdrp_shadow_visibility(&atlas, &p->views[0], at, n);
                if (is_on_plane(p, at) && truth >= 0) {
                    assert_int_equal(codes[k], truth * 255);
                    dark += truth == 0;
                }
            }
            differ += fabsf((float)codes[k] * ONE_BIT - expected) > 0.502f * ONE_BIT + 1e-5f;
        }
        assert_true(dark > 20u && differ * 1000u <= (device.is_lavapipe ? 0u : pixels_of(p)));
        free(codes);
        release(p);
    }
}

static void pictures_of_any_size_and_without_shadows(void** state)
{
    const uint32_t sizes[][2] = {{1, 1}, {1, 17}, {8, 8}, {9, 7}, {65, 3}};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        for (uint32_t count = 0; count < 3; count += 2) {
            options o = {HDRP_SHADOW_FILTER_BILINEAR, 0, 0.0f, 0.8f, false};
            picture* p = picture_of(sizes[i][0], sizes[i][1], &o);
            add_sun(p, 0, count, &o);
            fill(p);
            judge(p, 1);
            release(p);
        }
    }
}

static void casters_are_drawn_into_the_square_of_their_view(void** state)
{
    (void)state;
    for (hdrp_u32 reverse = 0; reverse < 2; ++reverse) {
        hdrp_shadow_settings s = hdrp_shadow_settings_make(HDRP_SHADOW_FILTER_TENT_3, reverse);
        hdrp_u32x4 map = hdrp_u32x4_make(64, 128, 32, 0);
        hdrp_shadow_view sun = hdrp_shadow_view_ball(hdrp_v4_make(0.0f, 0.0f, 0.0f, 8.0f),
                                                     v3(0.0f, -1.0f, 0.0f), 9.0f, map, s);
        hdrp_light lamp = hdrp_light_point(v3(0.0f, 0.0f, 0.0f), v3(1.0f, 1.0f, 1.0f), 5.0f);
        hdrp_shadow_view face = hdrp_shadow_view_light(lamp, 3, 0.1f, map, s);
        hdrp_gpu_vk_shadow_raster r = hdrp_gpu_vk_shadow_raster_of(&sun);
        assert_true(r.viewport.x == 64.0f && r.viewport.y == 128.0f && r.viewport.width == 32.0f &&
                    r.viewport.height == 32.0f && r.viewport.minDepth == 0.0f &&
                    r.viewport.maxDepth == 1.0f);
        assert_true(r.scissor.offset.x == 64 && r.scissor.offset.y == 128 &&
                    r.scissor.extent.width == 32 && r.scissor.extent.height == 32);
        assert_true(r.far_away.depth == (reverse ? 0.0f : 1.0f));
        assert_int_equal(r.compare,
                         reverse ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_LESS_OR_EQUAL);
        assert_int_equal(r.depth_clamp, VK_TRUE);
        assert_int_equal(r.depth_bias, VK_FALSE);
        assert_int_equal(hdrp_gpu_vk_shadow_raster_of(&face).depth_clamp, VK_FALSE);
    }
}

#define REFUSED(shadow, image, error)                                                              \
    assert_int_equal(hdrp_gpu_vk_resolve_shadows(&gpu, commands, &(shadow), &(image)), error)

static void shadows_that_are_none_are_refused(void** state)
{
    hdrp_gpu_vk_image image =
        image_of(VK_FORMAT_R8_UNORM, 4, 4, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    hdrp_gpu_vk_buffer views = gpu_host_buffer(&gpu, sizeof(hdrp_shadow_view));
    VkCommandBuffer commands = gpu_begin(&device);
    hdrp_gpu_vk_shadow good = {0}, bad;
    hdrp_gpu_vk_image other;
    (void)state;
    good.width_px = good.height_px = 4;
    good.depth = good.normals = good.atlas = image.view;
    good.views = views.buffer;
    good.view_count = 1;
    good.cascades[1] = 1;
    assert_int_equal(hdrp_gpu_vk_resolve_shadows(NULL, commands, &good, &image),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_resolve_shadows(&gpu, NULL, &good, &image),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_resolve_shadows(&gpu, commands, NULL, &image),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_gpu_vk_resolve_shadows(&gpu, commands, &good, NULL),
                     HDRP_ERROR_NULL_POINTER);
    bad = good, bad.depth = VK_NULL_HANDLE;
    REFUSED(bad, image, HDRP_ERROR_NULL_POINTER);
    bad = good, bad.normals = VK_NULL_HANDLE;
    REFUSED(bad, image, HDRP_ERROR_NULL_POINTER);
    bad = good, bad.atlas = VK_NULL_HANDLE;
    REFUSED(bad, image, HDRP_ERROR_NULL_POINTER);
    bad = good, bad.views = VK_NULL_HANDLE;
    REFUSED(bad, image, HDRP_ERROR_NULL_POINTER);
    other = image, other.view = VK_NULL_HANDLE;
    REFUSED(good, other, HDRP_ERROR_NULL_POINTER);
    bad = good, bad.width_px = 0;
    REFUSED(bad, image, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.height_px = 5;
    REFUSED(bad, image, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.views_offset = 1;
    REFUSED(bad, image, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.view_count = 0;
    REFUSED(bad, image, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.cascades[0] = 1;
    REFUSED(bad, image, HDRP_ERROR_BAD_ARGUMENT);
    bad = good, bad.cascades[3] = 256, bad.view_count = 1000;
    REFUSED(bad, image, HDRP_ERROR_BAD_ARGUMENT);
    other = image, other.format = VK_FORMAT_D32_SFLOAT;
    REFUSED(good, other, HDRP_ERROR_UNSUPPORTED);
    assert_int_equal(gpu.passes_recorded, 0);
    gpu_run(&device);
    hdrp_gpu_vk_buffer_destroy(&gpu, &views);
    hdrp_gpu_vk_image_destroy(&gpu, &image);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(shadows_are_those_of_the_cpu_and_of_rays),
        TEST(an_orthographic_camera_sees_the_same),
        TEST(a_plane_at_a_grazing_angle_has_no_acne),
        TEST(four_lights_have_a_channel_each),
        TEST(a_spot_casts_the_shadow_that_rays_see),
        TEST(pictures_of_any_size_and_without_shadows),
        TEST(casters_are_drawn_into_the_square_of_their_view),
        TEST(shadows_that_are_none_are_refused),
    };
    int failed;
    if (!gpu_open_writing(&device)) {
        return GPU_SKIPPED;
    }
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    gpu_close(&device);
    return failed || device.messages;
}
