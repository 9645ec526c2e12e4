/* cull_hash_scenes.c - see cull_hash.h.
 * SPDX-License-Identifier: MIT
 *
 * Compiled without contraction in every family, and without the C library's mathematics: the scenes
 * are the same bits everywhere, so that lists that differ differ for reasons of their own. */
#include "cull_hash.h"
#include "cull_scene.h"

#include <stdbool.h>
#include <stdlib.h>

static float number(uint32_t* stream, float lo, float hi)
{
    return cull_scene_random((*stream)++, 77u, lo, hi);
}

/* Powers of 2 from 2^lo to 2^hi, and what is between them. */
static float scale(uint32_t* stream, int lo, int hi)
{
    uint32_t octave = hdrp_hash2((*stream)++, 78u) % (uint32_t)(hi - lo);
    float power = hdrp_f32_from_bits((uint32_t)((int)octave + lo + 127) << 23);
    return power * number(stream, 1.0f, 2.0f);
}

/* Of any length. Only one argument of a call may draw numbers: their order is the compiler's. */
static hdrp_v3 direction(uint32_t* stream)
{
    float x = number(stream, -1.0f, 1.0f);
    float y = number(stream, -1.0f, 1.0f);
    return hdrp_v3_make(x, y, number(stream, -1.0f, 1.0f));
}

static hdrp_light area_light(uint32_t type, hdrp_light box, float range, float radius)
{
    box.bits.x = type;
    box.position_range.w = range;
    box.forward_radius.w = radius;
    box.half_angle = hdrp_v4_make(-1.0f, 0.0f, -1.0f, 0.0f);
    return box;
}

static hdrp_cull_shape make_shape(uint32_t* stream, uint32_t kind, hdrp_v3 eye)
{
    float distance = scale(stream, -2, 6);
    hdrp_v3 p = hdrp_v3_add(eye, hdrp_v3_scale(direction(stream), distance));
    hdrp_v3 f = direction(stream), up = direction(stream), one = hdrp_v3_splat(1.0f);
    float range = scale(stream, -5, 5), x = scale(stream, -5, 3), y = scale(stream, -5, 3);
    float a = number(stream, 0.0f, kind == 3u ? HDRP_PI : HDRP_HALF_PI);
    float b = number(stream, 0.0f, HDRP_HALF_PI);
    hdrp_light box = hdrp_light_box(p, f, up, one, x, y, range, 0.1f);
    switch (kind) {
    case 0u:
        return hdrp_cull_shape_sphere(p, range, HDRP_CULL_CATEGORY_ENVIRONMENT);
    case 1u:
        return hdrp_cull_shape_box(p, f, up, x, y, range, HDRP_CULL_CATEGORY_DECAL);
    case 2u:
    case 3u:
        return hdrp_cull_shape_from_light(hdrp_light_spot(p, f, one, range, 0.5f * a, a));
    case 4u:
        return hdrp_cull_shape_from_light(hdrp_light_pyramid(p, f, up, one, range, a, b, 0.1f));
    case 5u:
        return hdrp_cull_shape_from_light(box);
    case 6u:
        return hdrp_cull_shape_from_light(area_light(HDRP_LIGHT_TYPE_SPHERE, box, range, x));
    case 7u:
        return hdrp_cull_shape_from_light(area_light(HDRP_LIGHT_TYPE_DISC, box, range, x));
    case 8u:
        return hdrp_cull_shape_from_light(area_light(HDRP_LIGHT_TYPE_RECTANGLE, box, range, 0.0f));
    case 9u:
        return hdrp_cull_shape_from_light(area_light(HDRP_LIGHT_TYPE_LINE, box, range, 0.0f));
    case 10u:
        return hdrp_cull_shape_from_light(hdrp_light_directional(f, one, 0.01f));
    default:
        return hdrp_cull_shape_from_light(hdrp_light_point(p, one, range));
    }
}

/* Depths that rise and fall from pixel to pixel, and sky. */
static void make_depth(cull_hash_scene* s, uint32_t index)
{
    uint32_t count = s->desc.width_px * s->desc.height_px, stream = 3000000u * index;
    s->texels = malloc(count * sizeof *s->texels);
    for (uint32_t i = 0; s->texels != NULL && i < count; ++i) {
        float z = 1.0f + (float)((i % s->desc.width_px) / 24u) * number(&stream, 0.9f, 1.1f);
        s->texels[i] = i / s->desc.width_px < 10u ? HDRP_DEPTH_INFINITE : z;
    }
}

static hdrp_cull_camera make_camera(uint32_t* stream, uint32_t kind)
{
    hdrp_v3 eye = hdrp_v3_scale(direction(stream), kind == 3u ? 1e5f : 10.0f);
    hdrp_v3 f = direction(stream), up = direction(stream);
    float near_m = scale(stream, -6, 0), far_m = kind == 1u ? HDRP_CULL_FAR_INFINITE : 300.0f;
    if (kind == 2u) {
        return hdrp_cull_camera_orthographic(eye, f, up, -9.0f, 20.0f, -8.0f, 8.0f, near_m, far_m);
    }
    return hdrp_cull_camera_perspective(eye, f, up, -1.3f, kind == 3u ? 0.4f : 1.3f, -0.9f, 0.7f,
                                        near_m, far_m);
}

/* The last two scenes: the street of bench_cull. */
static void make_street(cull_hash_scene* s, bool pixels)
{
    cull_scene street;
    cull_scene_make(&street, 320u, 180u);
    s->camera = street.camera;
    s->count = CULL_HASH_SHAPES_MAX;
    for (uint32_t i = 0; i < s->count; ++i) {
        s->shapes[i] = hdrp_cull_shape_from_light(cull_scene_light(&street, CULL_SCENE_HALF, i));
    }
    s->desc.width_px = street.width_px;
    s->desc.height_px = street.height_px;
    s->desc.tile_width_px = s->desc.tile_height_px = pixels ? 16u : 32u;
    s->desc.slice_count = pixels ? 1u : 64u;
    s->desc.flags = pixels ? HDRP_CULL_MASKS : 0u;
    s->texels = malloc((size_t)street.width_px * street.height_px * sizeof *s->texels);
    if (s->texels != NULL) {
        cull_scene_depth(&street, s->texels);
    }
}

void cull_hash_scene_make(cull_hash_scene* s, uint32_t index)
{
    static const uint32_t flags[6] = {0u,
                                      HDRP_CULL_ONE_SERIES,
                                      HDRP_CULL_FAST,
                                      HDRP_CULL_PIXELS,
                                      HDRP_CULL_BLOCKS,
                                      HDRP_CULL_MASKS};
    static const uint32_t of_pixels = HDRP_CULL_PIXELS | HDRP_CULL_BLOCKS | HDRP_CULL_MASKS;
    static const uint32_t tiles[4] = {32u, 16u, 24u, 70u};
    static const uint32_t slices[4] = {64u, 1u, 16u, 33u};
    uint32_t stream = 100000u * index;
    const cull_hash_scene empty = {0};
    *s = empty;
    if (index + 2u >= CULL_HASH_SCENES) {
        make_street(s, index + 2u == CULL_HASH_SCENES);
        return;
    }
    s->camera = make_camera(&stream, index % 4u);
    s->count = 240u;
    for (uint32_t i = 0; i < s->count; ++i) {
        s->shapes[i] = make_shape(&stream, i % 13u, hdrp_v3_from_v4(s->camera.eye_near));
        s->shapes[i].bits.w = hdrp_bits_from_f32(number(&stream, 0.0f, 4.0f));
    }
    s->desc.flags = flags[index % 6u];
    s->desc.tile_width_px = tiles[index / 2u % 4u];
    s->desc.tile_height_px = tiles[index / 3u % 4u];
    s->desc.width_px = 200u + index;
    s->desc.height_px = 150u;
    s->desc.slice_count = (s->desc.flags & of_pixels) != 0u ? 1u : slices[index / 6u % 4u];
    s->desc.entry_capacity = index % 5u == 0u ? s->desc.slice_count + 39u : 0u; /* some are full */
    if (index % 3u != 0u || (s->desc.flags & of_pixels) != 0u) {
        make_depth(s, index);
    }
}
