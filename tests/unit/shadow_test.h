/* shadow_test.h - what the tests of hdrp_shadow.h share.
 * SPDX-License-Identifier: MIT
 *
 * A test that needs the algorithm layer defines HDRP_SHADOW_IMPLEMENTATION first. */
#ifndef SHADOW_TEST_H
#define SHADOW_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "hdrp_shadow.h"

#include "../shadow_scene.h"

static uint64_t random_state = 1;

static inline float uniform(float lo, float hi)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (float)(random_state >> 40) * 0x1p-24f;
}

static inline hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

static inline hdrp_v3 direction(void)
{
    hdrp_v3 d;
    do {
        d = v3(uniform(-1.0f, 1.0f), uniform(-1.0f, 1.0f), uniform(-1.0f, 1.0f));
    } while (hdrp_v3_dot(d, d) > 1.0f || hdrp_v3_dot(d, d) < 0.01f);
    return hdrp_v3_normalize(d);
}

static inline hdrp_u32x4 square(uint32_t x, uint32_t y, uint32_t size)
{
    return hdrp_u32x4_make(x, y, size, 0);
}

/* ---- in double ------------------------------------------------------------------------------- */

typedef struct dvec {
    double x, y, z;
} dvec;

static inline dvec dv_from(hdrp_v3 v)
{
    dvec r = {(double)v.x, (double)v.y, (double)v.z};
    return r;
}

static inline dvec dv_mad(dvec a, dvec b, double s)
{
    dvec r = {a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
    return r;
}

static inline double dv_dot(dvec a, dvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline dvec dv_cross(dvec a, dvec b)
{
    dvec r = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return r;
}

static inline double dv_length(dvec a)
{
    return sqrt(dv_dot(a, a));
}

static inline hdrp_v3 v3_from(dvec v)
{
    return v3((float)v.x, (float)v.y, (float)v.z);
}

/* The direction of a row of a projection, and what it gives for a position. */
static inline dvec row_of(hdrp_v4 row)
{
    return dv_from(hdrp_v3_from_v4(row));
}

static inline double clip_of(hdrp_v4 row, dvec p)
{
    return dv_dot(row_of(row), p) + (double)row.w;
}

static inline double depth_of(const hdrp_shadow_view* v, dvec p)
{
    return clip_of(v->clip_z, p) / clip_of(v->clip_w, p);
}

/* Where in the atlas a position is. */
static inline double column_of(const hdrp_shadow_view* v, dvec p)
{
    return (double)v->place.x * clip_of(v->clip_x, p) / clip_of(v->clip_w, p) + (double)v->place.z;
}

static inline double row_place_of(const hdrp_shadow_view* v, dvec p)
{
    return (double)v->place.y * clip_of(v->clip_y, p) / clip_of(v->clip_w, p) + (double)v->place.w;
}

/* By how many texels a filter reads beside a position, along one side. */
static inline double radius_of(hdrp_u32 filter_kind)
{
    static const double radii[] = {0.5, 1.0, 2.0, 3.0};
    return radii[filter_kind < 3u ? filter_kind : 3u];
}

#endif
