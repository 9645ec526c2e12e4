/* env_test.h - what the tests of hdrp_env_image.h and hdrp_env.h share.
 * SPDX-License-Identifier: MIT */
#ifndef ENV_TEST_H
#define ENV_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "hdrp_env.h"

#define TEST_PI 3.14159265358979323846

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static inline double test_random(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static inline hdrp_v3 test_direction(uint64_t* state)
{
    double z = 2.0 * test_random(state) - 1.0, phi = 2.0 * TEST_PI * test_random(state);
    double r = sqrt(1.0 - z * z);
    return hdrp_v3_make((float)(r * cos(phi)), (float)z, (float)(r * sin(phi)));
}

/* An image of constant radiance; free its texels. */
static inline hdrp_env_image test_image(hdrp_env_image_kind kind, uint32_t width, uint32_t height,
                                        float radiance)
{
    hdrp_env_image image = {0};
    size_t count = (size_t)width * height * (kind == HDRP_ENV_CUBE ? 18u : 3u);
    image.kind = kind;
    image.width = width;
    image.height = height;
    image.texels = malloc(count * sizeof(float));
    assert_non_null(image.texels);
    for (size_t i = 0; i < count; ++i) {
        image.texels[i] = radiance;
    }
    return image;
}

static inline size_t test_floats(const hdrp_env_image* image)
{
    return (size_t)3u * image->width * hdrp_env_image_rows(image);
}

/* Random texels, a few of them very bright. */
static inline hdrp_env_image test_random_image(hdrp_env_image_kind kind, uint32_t width,
                                               uint32_t height)
{
    hdrp_env_image image = test_image(kind, width, height, 0.0f);
    uint64_t state = 1u + width * 1000u + height;
    for (size_t i = 0; i < test_floats(&image); ++i) {
        double v = test_random(&state);
        image.texels[i] = (float)(v < 0.01 ? 1e4 * test_random(&state) : v);
    }
    return image;
}

static inline void test_near(double measured, double expected, double tolerance)
{
    if (!(fabs(measured - expected) <= tolerance)) {
        print_error("%.9g is not within %.3g of %.9g\n", measured, tolerance, expected);
    }
    assert_true(fabs(measured - expected) <= tolerance);
}

static inline void test_near_v3(hdrp_v3 v, double x, double y, double z, double tolerance)
{
    test_near((double)v.x, x, tolerance);
    test_near((double)v.y, y, tolerance);
    test_near((double)v.z, z, tolerance);
}

/* Unit direction to a point of the cube [-1,1]^3. */
static inline hdrp_v3 test_unit(double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    return hdrp_v3_make((float)(x / length), (float)(y / length), (float)(z / length));
}

/* A point on edge 0..11 of the cube [-1,1]^3, and a step on either adjacent face away from it. */
static inline void test_edge(int edge, double along, double step, hdrp_v3* one, hdrp_v3* other)
{
    int axis = edge / 4, a = (axis + 1) % 3, b = (axis + 2) % 3;
    double p[3], q[3];
    p[axis] = q[axis] = along;
    p[a] = edge % 2 ? 1.0 : -1.0;
    q[a] = p[a] * (1.0 - step);
    q[b] = edge / 2 % 2 ? 1.0 : -1.0;
    p[b] = q[b] * (1.0 - step);
    *one = test_unit(p[0], p[1], p[2]);
    *other = test_unit(q[0], q[1], q[2]);
}

#endif
