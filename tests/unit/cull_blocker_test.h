/* cull_blocker_test.h - what the tests of hdrp_cull_blocker.h share: random scenes, and what a light
 * reaches in double, by solving for the place where a ray meets a plane.
 * SPDX-License-Identifier: MIT */
#ifndef CULL_BLOCKER_TEST_H
#define CULL_BLOCKER_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "hdrp_cull_blocker.h"

#define TEST_PI 3.14159265358979323846

typedef struct test_v3 {
    double x, y, z;
} test_v3;

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static inline double test_random(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static inline double test_between(uint64_t* state, double lo, double hi)
{
    return lo + (hi - lo) * test_random(state);
}

/* Logarithmically between two positive numbers. */
static inline double test_log(uint64_t* state, double lo, double hi)
{
    return lo * pow(hi / lo, test_random(state));
}

static inline uint32_t test_below(uint64_t* state, uint32_t end)
{
    return (uint32_t)(test_random(state) * (double)end);
}

static inline test_v3 test_vec(double x, double y, double z)
{
    test_v3 v = {x, y, z};
    return v;
}

static inline test_v3 test_direction(uint64_t* state)
{
    double z = 2.0 * test_random(state) - 1.0, phi = 2.0 * TEST_PI * test_random(state);
    double r = sqrt(1.0 - z * z);
    return test_vec(r * cos(phi), z, r * sin(phi));
}

static inline test_v3 test_mad(test_v3 a, test_v3 b, double s)
{
    return test_vec(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}

static inline double test_dot(test_v3 a, test_v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline test_v3 test_of(hdrp_v4 v)
{
    return test_vec((double)v.x, (double)v.y, (double)v.z);
}

static inline hdrp_v3 test_float(test_v3 v)
{
    return hdrp_v3_make((float)v.x, (float)v.y, (float)v.z);
}

/* Whether a blocker blocks: 1 - t of the way to the light the ray meets the plane. */
static inline bool test_blocks(const hdrp_cull_blocker* b, hdrp_v4 light, test_v3 p)
{
    test_v3 c = test_of(b->center), n = test_of(b->front);
    test_v3 way = light.w > 0.0f ? test_mad(test_of(light), p, -1.0) : test_of(light);
    test_v3 from = test_mad(c, p, -1.0), hit;
    double t = test_dot(n, from) / test_dot(n, way);
    if (b->bits.x == HDRP_CULL_BLOCKER_PLANE) {
        return test_dot(n, from) > 0.0;
    }
    if (b->bits.x != HDRP_CULL_BLOCKER_RECTANGLE || test_dot(n, way) == 0.0 || !(t > 0.0) ||
        (light.w > 0.0f && t >= 1.0)) {
        return false;
    }
    hit = test_mad(test_mad(p, way, t), c, -1.0);
    return fabs(test_dot(hit, test_of(b->right_half))) <= (double)b->right_half.w &&
           fabs(test_dot(hit, test_of(b->up_half))) <= (double)b->up_half.w;
}

/* Whether a light reaches a position through those of its blockers that are in the mask. */
static inline bool test_reaches(const hdrp_cull_blocker_scene* s, uint32_t light, uint32_t mask,
                                test_v3 p)
{
    for (uint32_t k = 0; k < s->lights[light].count; ++k) {
        const hdrp_cull_blocker* b = &s->blockers[s->links[s->lights[light].first + k]];
        bool open = (mask >> k & 1u) == 0u || !test_blocks(b, s->places[light], p);
        for (uint32_t i = 0; i < b->bits.z; ++i) {
            open = open || test_blocks(&s->blockers[b->bits.y + i], s->places[light], p);
        }
        if (!open) {
            return false;
        }
    }
    return true;
}

/* A cell of a picture of 1280 x 720. */
typedef struct test_cell {
    hdrp_cull_camera camera;
    hdrp_cull_tile tile;
    double x0, y0, x1, y1; /* px */
    hdrp_cull_interval depths;
} test_cell;

static inline hdrp_cull_camera test_camera(uint64_t* state, bool orthographic)
{
    test_v3 eye = test_mad(test_vec(0, 0, 0), test_direction(state), test_log(state, 0.1, 1e5));
    hdrp_v3 forward = test_float(test_direction(state)), up = test_float(test_direction(state));
    float height = (float)test_log(state, 0.1, 1.5), aspect = 16.0f / 9.0f;
    float shift = (float)test_between(state, -0.2, 0.2);
    if (orthographic) {
        float size = (float)test_log(state, 1.0, 100.0);
        return hdrp_cull_camera_orthographic(test_float(eye), forward, up, -size * aspect,
                                             size * aspect, -size, size, 0.1f, 1000.0f);
    }
    return hdrp_cull_camera_perspective(test_float(eye), forward, up, (shift - height) * aspect,
                                        (shift + height) * aspect, -height, height, 0.1f,
                                        HDRP_CULL_FAR_INFINITE);
}

/* Tiles of 8 to 256 pixels, slices that are thin, thick, or without end. */
static inline test_cell test_random_cell(uint64_t* state, bool orthographic)
{
    test_cell c;
    double size = floor(test_log(state, 8.0, 256.0));
    c.camera = test_camera(state, orthographic);
    c.x0 = floor(test_between(state, 0.0, 1280.0 - size));
    c.y0 = floor(test_between(state, 0.0, 720.0 - size));
    c.x1 = c.x0 + size;
    c.y1 = c.y0 + size;
    c.tile = hdrp_cull_tile_make(c.camera, (float)c.x0, (float)c.y0, (float)c.x1, (float)c.y1,
                                 1280.0f, 720.0f);
    c.depths.nearest = (float)test_log(state, 0.1, 100.0);
    c.depths.farthest = c.depths.nearest * (1.0f + (float)test_log(state, 1e-3, 3.0));
    if (test_random(state) < 0.03 && !orthographic) {
        c.depths.farthest = HDRP_CULL_FAR_INFINITE;
    }
    return c;
}

/* A position in a cell, in the world: x, y and z from 0 to 1. */
static inline test_v3 test_place(const test_cell* c, double x, double y, double z)
{
    double px = c->x0 + (c->x1 - c->x0) * x, py = c->y0 + (c->y1 - c->y0) * y;
    hdrp_v4 w = c->camera.window;
    double u = (double)w.x + (double)w.z * px / 1280.0;
    double v = (double)w.y + (double)w.w * (1.0 - py / 720.0);
    double lo = (double)c->depths.nearest, hi = (double)c->depths.farthest;
    double depth = hi > 1e12 ? lo * pow(1e5, z) : lo + (hi - lo) * z;
    double k = c->camera.forward_orthographic.w > 0.0f ? 1.0 : depth;
    test_v3 p = test_mad(test_of(c->camera.eye_near), test_of(c->camera.right_far), u * k);
    p = test_mad(p, test_of(c->camera.up), v * k);
    return test_mad(p, test_of(c->camera.forward_orthographic), depth);
}

/* A rectangle whose shadow, for a light, goes past a cell. */
static inline hdrp_cull_blocker test_random_blocker(uint64_t* state, const test_cell* c,
                                                    hdrp_v4 light)
{
    test_v3 target = test_place(c, test_random(state), test_random(state), test_random(state));
    test_v3 way = light.w > 0.0f ? test_mad(test_of(light), target, -1.0) : test_of(light);
    double length = sqrt(test_dot(way, way));
    double reach = light.w > 0.0f ? length : test_log(state, 0.1, 100.0);
    double size = test_log(state, 0.01, 3.0) * (light.w > 0.0f ? length : reach);
    double share = test_between(state, -0.1, 1.1);
    test_v3 center = test_mad(target, way, share * reach / length);
    center = test_mad(center, test_direction(state), 1.2 * size * test_random(state));
    if (test_random(state) < 0.1) {
        return hdrp_cull_blocker_plane(test_float(target), test_float(test_direction(state)));
    }
    return hdrp_cull_blocker_rectangle(test_float(center), test_float(test_direction(state)),
                                       test_float(test_direction(state)), (float)size,
                                       (float)(size * test_log(state, 0.1, 10.0)));
}

/* A light near a cell, in it, or infinitely far. */
static inline hdrp_v4 test_random_light(uint64_t* state, const test_cell* c)
{
    test_v3 p = test_place(c, test_random(state), test_random(state), 0.5 * test_random(state));
    test_v3 d = test_direction(state);
    if (test_random(state) < 0.2) {
        return hdrp_v4_make((float)d.x, (float)d.y, (float)d.z, 0.0f);
    }
    p = test_mad(p, d, (double)c->depths.nearest * test_log(state, 0.01, 3.0));
    return hdrp_v4_from_v3(test_float(p), 1.0f);
}

#endif
