/* cull_test.h - shapes, tiles and cameras in double, for the tests of hdrp_cull_volume.h.
 * SPDX-License-Identifier: MIT
 *
 * A shape here is what its record says, read in double: where its points are, how far it reaches
 * along a direction, how far outside a position is. Nothing is shared with the header but the
 * record. */
#ifndef CULL_TEST_H
#define CULL_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_cull_volume.h"

#define TEST_PI 3.14159265358979323846

typedef struct dvec {
    double x, y, z;
} dvec;

/* A number in [0,1) of a fixed sequence (Steele et al. 2014, splitmix64). */
static inline double test_random(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static inline double test_uniform(uint64_t* state, double lo, double hi)
{
    return lo + (hi - lo) * test_random(state);
}

static inline double test_log_uniform(uint64_t* state, double lo, double hi)
{
    return lo * pow(hi / lo, test_random(state));
}

/* In [-1,1]; a third of them at the ends. */
static inline double test_share(uint64_t* state)
{
    double t = test_uniform(state, -1.5, 1.5);
    return t < -1.0 ? -1.0 : t > 1.0 ? 1.0 : t;
}

static inline dvec dv(double x, double y, double z)
{
    dvec r = {x, y, z};
    return r;
}

static inline dvec dv_from(hdrp_v3 v)
{
    return dv((double)v.x, (double)v.y, (double)v.z);
}

static inline dvec dv_from_v4(hdrp_v4 v)
{
    return dv((double)v.x, (double)v.y, (double)v.z);
}

static inline hdrp_v3 v3_from(dvec v)
{
    return hdrp_v3_make((float)v.x, (float)v.y, (float)v.z);
}

static inline dvec dv_mad(dvec a, dvec b, double s)
{
    return dv(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}

static inline double dv_dot(dvec a, dvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline dvec dv_cross(dvec a, dvec b)
{
    return dv(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double dv_length(dvec a)
{
    return sqrt(dv_dot(a, a));
}

static inline dvec dv_unit(dvec a)
{
    return dv_mad(dv(0.0, 0.0, 0.0), a, 1.0 / dv_length(a));
}

static inline dvec test_direction(uint64_t* state)
{
    double z = test_uniform(state, -1.0, 1.0), phi = test_uniform(state, 0.0, 2.0 * TEST_PI);
    double r = sqrt(1.0 - z * z);
    return dv(r * cos(phi), r * sin(phi), z);
}

/* A record, in double. */
typedef struct body {
    uint32_t kind;
    dvec center, right, up, forward;
    double range, half_x, half_y, half_z, angle_x, angle_y;
} body;

static inline body body_of(hdrp_cull_shape s)
{
    body b;
    b.kind = hdrp_cull_shape_kind(s);
    b.center = dv_from_v4(s.center_range);
    b.right = dv_unit(dv_from_v4(s.right_half));
    b.up = dv_unit(dv_from_v4(s.up_half));
    b.forward = dv_unit(dv_from_v4(s.forward_half));
    b.range = (double)s.center_range.w;
    b.half_x = (double)s.right_half.w;
    b.half_y = (double)s.up_half.w;
    b.half_z = (double)s.forward_half.w;
    b.angle_x = atan2((double)s.half_angle.y, (double)s.half_angle.x);
    b.angle_y = atan2((double)s.half_angle.w, (double)s.half_angle.z);
    return b;
}

static inline double body_size(const body* b)
{
    return b->range + (b->kind >= HDRP_CULL_KIND_BOX ? b->half_x + b->half_y + b->half_z : 0.0);
}

/* A point of the body, often of its surface, its edges and its corners. */
static inline dvec body_point(const body* b, uint64_t* state)
{
    dvec d = test_direction(state), p = b->center;
    double length = b->range * fmin(cbrt(1.3 * test_random(state)), 1.0);
    if (b->kind == HDRP_CULL_KIND_CONE) {
        double theta = b->angle_x * fabs(test_share(state));
        double phi = test_uniform(state, 0.0, 2.0 * TEST_PI);
        d = dv_mad(dv_mad(dv_mad(dv(0.0, 0.0, 0.0), b->forward, cos(theta)), b->right,
                          sin(theta) * cos(phi)),
                   b->up, sin(theta) * sin(phi));
    } else if (b->kind == HDRP_CULL_KIND_PYRAMID) {
        double x = test_share(state), y = test_share(state);
        d = dv_mad(dv(0.0, 0.0, 0.0), b->forward, cos(b->angle_x) * cos(b->angle_y));
        d = dv_mad(d, b->right, x * sin(b->angle_x) * cos(b->angle_y));
        d = dv_mad(d, b->up, y * sin(b->angle_y) * cos(b->angle_x));
        d = dv_length(d) > 1e-9 ? dv_unit(d) : b->forward;
    } else if (b->kind >= HDRP_CULL_KIND_BOX) {
        p = dv_mad(p, b->right, b->half_x * test_share(state));
        p = dv_mad(p, b->up, b->half_y * test_share(state));
        p = dv_mad(p, b->forward, b->half_z * test_share(state));
        if (b->kind == HDRP_CULL_KIND_FRONT && dv_dot(d, b->forward) < 0.0) {
            d = dv_mad(d, b->forward, -dv_dot(d, b->forward) * (test_random(state) < 0.5 ? 2 : 1));
            d = dv_unit(d);
        }
    }
    return dv_mad(p, d, length);
}

/* How far a position is outside at least, in metres: 0 or negative inside. */
static inline double body_outside(const body* b, dvec p)
{
    dvec d = dv_mad(p, b->center, -1.0);
    double x = fabs(dv_dot(d, b->right)), y = fabs(dv_dot(d, b->up)), z = dv_dot(d, b->forward);
    double r = dv_length(d), out = r - b->range;
    if (b->kind == HDRP_CULL_KIND_CONE) {
        double theta = atan2(dv_length(dv_cross(d, b->forward)), z);
        out = fmax(out, r * sin(fmin(theta - b->angle_x, 0.5 * TEST_PI)));
    } else if (b->kind == HDRP_CULL_KIND_PYRAMID) {
        out = fmax(out, x * cos(b->angle_x) - z * sin(b->angle_x));
        out = fmax(out, y * cos(b->angle_y) - z * sin(b->angle_y));
    } else if (b->kind >= HDRP_CULL_KIND_BOX) {
        dvec q =
            dv(fmax(x - b->half_x, 0.0), fmax(y - b->half_y, 0.0), fmax(fabs(z) - b->half_z, 0.0));
        out = dv_length(q) - b->range;
        out = b->kind == HDRP_CULL_KIND_FRONT ? fmax(out, -z) : out;
    }
    return out;
}

/* The largest dot(n, p) over the body, for a unit vector. */
static inline double body_support(const body* b, dvec n)
{
    double at = dv_dot(n, b->center), cosine = dv_dot(n, b->forward), best = 0.0;
    double sine = dv_length(dv_cross(n, b->forward)), theta = atan2(sine, cosine);
    if (b->kind == HDRP_CULL_KIND_CONE) {
        return at + b->range * fmax(0.0, cos(fmax(theta - b->angle_x, 0.0)));
    }
    if (b->kind == HDRP_CULL_KIND_PYRAMID) {
        double cx = cos(b->angle_x), sx = sin(b->angle_x), cy = cos(b->angle_y),
               sy = sin(b->angle_y);
        const int steps = 64;
        body at_origin = *b;
        at_origin.center = dv(0.0, 0.0, 0.0);
        best = body_outside(&at_origin, dv_mad(dv(0.0, 0.0, 0.0), n, b->range)) < 1e-6 * b->range
                   ? 1.0
                   : 0.0;
        for (int side = 0; side < 4; ++side) {
            for (int i = 0; i <= steps; ++i) {
                double t = 2.0 * i / steps - 1.0, u = side & 1 ? 1.0 : -1.0;
                double x = side < 2 ? u : t, y = side < 2 ? t : u;
                dvec e = dv_mad(dv(0.0, 0.0, 0.0), b->forward, cx * cy);
                e = dv_mad(dv_mad(e, b->right, x * sx * cy), b->up, y * sy * cx);
                best = dv_length(e) > 1e-9 ? fmax(best, dv_dot(dv_unit(e), n)) : best;
            }
        }
        return at + b->range * best;
    }
    if (b->kind >= HDRP_CULL_KIND_BOX) {
        best = -INFINITY;
        for (int i = 0; i < 8; ++i) {
            dvec c = dv_mad(b->center, b->right, i & 1 ? b->half_x : -b->half_x);
            c = dv_mad(c, b->up, i & 2 ? b->half_y : -b->half_y);
            c = dv_mad(c, b->forward, i & 4 ? b->half_z : -b->half_z);
            best = fmax(best, dv_dot(c, n));
        }
        return best + b->range * (b->kind == HDRP_CULL_KIND_FRONT && cosine < 0.0 ? sine : 1.0);
    }
    return at + b->range;
}

/* A random shape of a kind, in front of, around or behind the origin. */
static inline hdrp_cull_shape test_shape(uint32_t kind, uint64_t* state)
{
    const hdrp_v3 white = {1.0f, 1.0f, 1.0f};
    double range = test_log_uniform(state, 1e-3, 1e5);
    double away = range * test_log_uniform(state, 1e-2, 1e2);
    hdrp_v3 p = v3_from(dv_mad(dv(0.0, 0.0, 0.0), test_direction(state), away));
    hdrp_v3 f = v3_from(test_direction(state)), up = v3_from(test_direction(state));
    double a = test_random(state) < 0.1 ? 0.5 * TEST_PI : test_log_uniform(state, 1e-3, 1.57);
    double b = test_random(state) < 0.1 ? 0.5 * TEST_PI : test_log_uniform(state, 1e-3, 1.57);
    float x = (float)(range * test_log_uniform(state, 1e-2, 10.0));
    float y = (float)(range * test_log_uniform(state, 1e-2, 10.0));
    float z = (float)(range * test_log_uniform(state, 1e-2, 10.0));
    hdrp_cull_shape s = hdrp_cull_shape_sphere(p, (float)range, 0u);
    if (test_random(state) < 0.25) { /* along an axis, or almost */
        double off = test_random(state) < 0.5 ? 0.0 : test_log_uniform(state, 1e-6, 1e-2);
        f = test_random(state) < 0.5 ? hdrp_v3_make((float)off, 0.0f, 1.0f)
                                     : hdrp_v3_make(0.0f, (float)off, -1.0f);
    }
    switch (kind) {
    case HDRP_CULL_KIND_CONE:
        s = hdrp_cull_shape_from_light(hdrp_light_spot(p, f, white, (float)range, 0.0f, (float)a));
        break;
    case HDRP_CULL_KIND_PYRAMID:
        s = hdrp_cull_shape_from_light(
            hdrp_light_pyramid(p, f, up, white, (float)range, (float)a, (float)b, 0.5f));
        break;
    case HDRP_CULL_KIND_BOX:
    case HDRP_CULL_KIND_FRONT:
        s = hdrp_cull_shape_box(p, f, up, x, y, z, 0u);
        s.center_range.w =
            kind == HDRP_CULL_KIND_FRONT || test_random(state) < 0.5 ? (float)range : 0.0f;
        if (kind == HDRP_CULL_KIND_FRONT) {
            s.forward_half.w = 0.0f;
            s.bits.x = HDRP_CULL_KIND_FRONT;
        }
        break;
    default:
        break;
    }
    return s;
}

#endif
