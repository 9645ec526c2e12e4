/* cull_scene.h - many lights in a street: a camera, the depths that it sees, and lights near them.
 * SPDX-License-Identifier: MIT
 *
 * Numbers come from hashes, and no function of the C library is called, so that the scene is the same
 * everywhere: to the bit where compilers contract nothing to fused multiply-adds, to a rounding
 * elsewhere. The street has buildings, walls, crates and lamp posts on a plane, and sky
 * above. Lights stand near surfaces, denser where it is near; how far they reach does not depend on
 * how many there are: of 1000 points about 20 reach something that a tile of 16 x 16 pixels shows. */
#ifndef CULL_SCENE_H
#define CULL_SCENE_H

#include "hdrp_cull_volume.h"

#include <stddef.h>

#define CULL_SCENE_BOX_COUNT 160
#define CULL_SCENE_NEAR_M    0.1f
#define CULL_SCENE_FAR_M     200.0f

/* How many of the lights are spots. */
typedef enum cull_scene_mix {
    CULL_SCENE_POINTS,
    CULL_SCENE_HALF, /* every other one */
    CULL_SCENE_SPOTS
} cull_scene_mix;

typedef struct cull_scene_box {
    hdrp_v3 lo, hi;
} cull_scene_box;

typedef struct cull_scene {
    uint32_t width_px, height_px;
    hdrp_cull_camera camera; /* 60 degrees from the lower to the upper edge */
    cull_scene_box boxes[CULL_SCENE_BOX_COUNT];
} cull_scene;

/* In [lo, hi), a number of its own for every index and stream. */
static inline float cull_scene_random(uint32_t index, uint32_t stream, float lo, float hi)
{
    return lo + (hi - lo) * hdrp_unit_from_u32(hdrp_hash2(index, stream));
}

/* A distance that is more often near than far, so that there is as much to see in the distance. */
static inline float cull_scene_random_distance(uint32_t index, uint32_t stream, float lo, float hi)
{
    float x = cull_scene_random(index, stream, 1.0f, hdrp_sqrt(lo / hi));
    return lo / (x * x);
}

static inline cull_scene_box cull_scene_make_box(uint32_t index, float half_width)
{
    /* Building, crate, wall along the view, lamp post. */
    static const float half_min[4] = {2.0f, 0.3f, 0.1f, 0.06f};
    static const float half_max[4] = {6.0f, 1.2f, 0.2f, 0.12f};
    static const float height_min[4] = {4.0f, 0.5f, 1.0f, 3.0f};
    static const float height_max[4] = {16.0f, 2.0f, 3.0f, 7.0f};
    uint32_t kind = index & 3u;
    float x = cull_scene_random(index, 100u, half_min[kind], half_max[kind]);
    float z = kind == 2u ? cull_scene_random(index, 101u, 2.0f, 8.0f)
                         : cull_scene_random(index, 101u, half_min[kind], half_max[kind]);
    float height = cull_scene_random(index, 102u, height_min[kind], height_max[kind]);
    float distance = z + cull_scene_random_distance(index, 103u, kind == 0u ? 15.0f : 5.0f, 150.0f);
    float at = cull_scene_random(index, 104u, -1.1f, 1.1f) * half_width * distance;
    cull_scene_box box;
    box.lo = hdrp_v3_make(at - x, 0.0f, -distance - z);
    box.hi = hdrp_v3_make(at + x, height, -distance + z);
    return box;
}

static inline void cull_scene_make(cull_scene* scene, uint32_t width_px, uint32_t height_px)
{
    const float half_height = 0.57735027f; /* tan 30 degrees */
    float half_width = half_height * (float)width_px / (float)height_px;
    scene->width_px = width_px;
    scene->height_px = height_px;
    scene->camera = hdrp_cull_camera_perspective(
        hdrp_v3_make(0.0f, 5.0f, 0.0f), hdrp_v3_make(0.05f, -0.1f, -1.0f),
        hdrp_v3_make(0.0f, 1.0f, 0.0f), -half_width, half_width, -half_height, half_height,
        CULL_SCENE_NEAR_M, CULL_SCENE_FAR_M);
    for (uint32_t i = 0u; i < CULL_SCENE_BOX_COUNT; ++i) {
        scene->boxes[i] = cull_scene_make_box(i, half_width);
    }
}

/* From the eye through a place in the picture, as long as depth is 1 m. */
static inline hdrp_v3 cull_scene_ray(const cull_scene* scene, float x_px, float y_px)
{
    hdrp_v4 w = scene->camera.window;
    float u = w.x + x_px * (w.z / (float)scene->width_px);
    float v = w.y + ((float)scene->height_px - y_px) * (w.w / (float)scene->height_px);
    hdrp_v3 ray = hdrp_v3_from_v4(scene->camera.forward_orthographic);
    ray = hdrp_v3_add(ray, hdrp_v3_scale(hdrp_v3_from_v4(scene->camera.right_far), u));
    return hdrp_v3_add(ray, hdrp_v3_scale(hdrp_v3_from_v4(scene->camera.up), v));
}

/* Depth at which a ray hits a box; far away where it does not. */
static inline float cull_scene_hit(cull_scene_box box, hdrp_v3 eye, hdrp_v3 inverse)
{
    float x0 = (box.lo.x - eye.x) * inverse.x, x1 = (box.hi.x - eye.x) * inverse.x;
    float y0 = (box.lo.y - eye.y) * inverse.y, y1 = (box.hi.y - eye.y) * inverse.y;
    float z0 = (box.lo.z - eye.z) * inverse.z, z1 = (box.hi.z - eye.z) * inverse.z;
    float enter = hdrp_max(hdrp_max(hdrp_min(x0, x1), hdrp_min(y0, y1)), hdrp_min(z0, z1));
    float leave = hdrp_min(hdrp_min(hdrp_max(x0, x1), hdrp_max(y0, y1)), hdrp_max(z0, z1));
    return enter <= leave && enter > 0.0f ? enter : HDRP_DEPTH_INFINITE;
}

static inline float cull_scene_inverse(float x)
{
    return 1.0f / (hdrp_abs(x) < 1e-9f ? 1e-9f : x);
}

/* Depths in metres of all pixels, row by row from the top; HDRP_DEPTH_INFINITE is sky. */
static inline void cull_scene_depth(const cull_scene* scene, float* texels)
{
    hdrp_v3 eye = hdrp_v3_from_v4(scene->camera.eye_near);
    for (uint32_t y = 0u; y < scene->height_px; ++y) {
        for (uint32_t x = 0u; x < scene->width_px; ++x) {
            hdrp_v3 ray = cull_scene_ray(scene, (float)x + 0.5f, (float)y + 0.5f);
            hdrp_v3 inverse = hdrp_v3_make(cull_scene_inverse(ray.x), cull_scene_inverse(ray.y),
                                           cull_scene_inverse(ray.z));
            float z = ray.y < -1e-9f ? eye.y * -inverse.y : HDRP_DEPTH_INFINITE;
            for (uint32_t i = 0u; i < CULL_SCENE_BOX_COUNT; ++i) {
                z = hdrp_min(z, cull_scene_hit(scene->boxes[i], eye, inverse));
            }
            texels[(size_t)y * scene->width_px + x] =
                z < CULL_SCENE_FAR_M ? z : HDRP_DEPTH_INFINITE;
        }
    }
}

/* Somewhere above what stands at a random place of the street: more places are near than far, fewer
 * than the picture shows of the ground. */
static inline hdrp_v3 cull_scene_light_position(const cull_scene* scene, uint32_t index)
{
    float half_width = 0.5f * scene->camera.window.z;
    float share = cull_scene_random(index, 1u, 0.0f, 1.0f);
    float distance = 4.0f + 146.0f * share * share;
    float x = cull_scene_random(index, 2u, -1.0f, 1.0f) * half_width * distance;
    float height = 0.0f;
    for (uint32_t i = 0u; i < CULL_SCENE_BOX_COUNT; ++i) {
        const cull_scene_box* b = &scene->boxes[i];
        if (b->lo.x <= x && x <= b->hi.x && b->lo.z <= -distance && -distance <= b->hi.z) {
            height = hdrp_max(height, b->hi.y);
        }
    }
    return hdrp_v3_make(x, height + cull_scene_random(index, 3u, 0.2f, 3.0f), -distance);
}

/* Ranges of 1.5 to 5.5 m, short ones more often. */
static inline float cull_scene_light_range(uint32_t index)
{
    return cull_scene_random_distance(index, 4u, 1.5f, 5.5f);
}

/* Light `index` of a scene; the same place and range in every mix. Spots have half angles of 12 to
 * 40 degrees, and mostly shine downwards. */
static inline hdrp_light cull_scene_light(const cull_scene* scene, cull_scene_mix mix,
                                          uint32_t index)
{
    hdrp_v3 position = cull_scene_light_position(scene, index);
    hdrp_v3 color = hdrp_v3_splat(cull_scene_random(index, 5u, 10.0f, 1000.0f));
    float range = cull_scene_light_range(index);
    float angle = cull_scene_random(index, 6u, 12.0f, 40.0f) * (HDRP_PI / 180.0f);
    float tilt = (index >> 1 & 3u) == 0u ? 1.0f : -0.5f; /* upper end of the vertical part */
    hdrp_v3 forward = hdrp_v3_make(cull_scene_random(index, 7u, -1.0f, 1.0f),
                                   cull_scene_random(index, 8u, -1.0f, tilt),
                                   cull_scene_random(index, 9u, -1.0f, 1.0f));
    hdrp_light light = hdrp_light_point(position, color, range);
    if (mix == CULL_SCENE_SPOTS || (mix == CULL_SCENE_HALF && (index & 1u) != 0u)) {
        light = hdrp_light_spot(position, forward, color, range, 0.8f * angle, angle);
    }
    return light;
}

#endif
