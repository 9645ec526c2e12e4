/* acc_cull_volume.c - accuracy of hdrp_cull_volume.h.
 * SPDX-License-Identifier: MIT
 *
 * Frames are referred to one made in double from the same directions, radii to corners, intervals to
 * the least distance of a ball's centre from the slices of a tile, which is found by search. */
#include "accuracy.h"

#include "hdrp_cull_volume.h"

typedef struct vec {
    double x, y, z;
} vec;

static vec direction(acc* a)
{
    double d[3];
    acc_direction(a, d);
    return (vec){d[0], d[1], d[2]};
}

static hdrp_v3 scaled(vec v, double s)
{
    return hdrp_v3_make(acc_float(v.x * s), acc_float(v.y * s), acc_float(v.z * s));
}

static vec widened(hdrp_v3 v)
{
    return (vec){(double)v.x, (double)v.y, (double)v.z};
}

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec minus(vec a, vec b, double s)
{
    return (vec){a.x - b.x * s, a.y - b.y * s, a.z - b.z * s};
}

static vec unit(vec a)
{
    return minus((vec){0.0, 0.0, 0.0}, a, -1.0 / sqrt(dot(a, a)));
}

static void view_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        vec f = direction(a), u = direction(a), out = direction(a), at = direction(a), d;
        if (fabs(dot(f, u)) > 0.99) {
            continue; /* what is up is not known better than the directions are */
        }
        double distance = acc_log_uniform(a, 1e-3, 1e7), away = acc_log_uniform(a, 1e-3, 1e9);
        hdrp_v3 eye = scaled(at, away), forward = scaled(f, 1.0), up = scaled(u, 3.0);
        hdrp_v3 p = hdrp_v3_add(eye, scaled(out, distance));
        hdrp_cull_camera c =
            hdrp_cull_camera_perspective(eye, forward, up, -1.0f, 1.0f, -1.0f, 1.0f, 0.1f, 100.0f);
        hdrp_v3 view = hdrp_cull_view_from_world(p, c);
        d = minus(widened(p), widened(eye), 1.0);
        distance = sqrt(dot(d, d));
        if (distance == 0.0) {
            continue;
        }
        /* Depth along forward, height along what of up is across it, and the rest. */
        f = unit(widened(forward));
        u = widened(up);
        u = unit(minus(u, f, dot(u, f)));
        double z = dot(d, f), y = dot(d, u);
        vec rest = minus(minus(d, f, z), u, y);
        /* The rest is along right: forward x up. */
        double x = rest.x * (f.y * u.z - f.z * u.y) + rest.y * (f.z * u.x - f.x * u.z) +
                   rest.z * (f.x * u.y - f.y * u.x);
        double error = acc_larger(fabs((double)view.x - x), fabs((double)view.y - y));
        error = acc_larger(error, fabs((double)view.z - z));
        ACC_ADD(a, error / distance, "p (%.9g %.9g %.9g), eye (%.9g %.9g %.9g)", (double)p.x,
                (double)p.y, (double)p.z, (double)eye.x, (double)eye.y, (double)eye.z);
    }
}

/* The distance of the farthest corner of a box, by trying all of them. */
static double farthest_corner(hdrp_cull_shape s)
{
    double best = 0.0;
    for (int i = 0; i < 8; ++i) {
        vec corner = {0.0, 0.0, 0.0};
        hdrp_v4 axes[3] = {s.right_half, s.up_half, s.forward_half};
        for (int k = 0; k < 3; ++k) {
            vec axis = unit(widened(hdrp_v3_from_v4(axes[k])));
            corner = minus(corner, axis, i >> k & 1 ? (double)axes[k].w : -(double)axes[k].w);
        }
        best = fmax(best, sqrt(dot(corner, corner)));
    }
    return best;
}

static void ball_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        double distance = acc_log_uniform(a, 1e-3, 1e7), size = acc_log_uniform(a, 1e-3, 1e5);
        hdrp_v3 p = scaled(direction(a), distance);
        hdrp_cull_shape s = hdrp_cull_shape_sphere(p, acc_float(size), 0u);
        double radius = (double)s.center_range.w;
        if (i & 1) {
            hdrp_v3 f = scaled(direction(a), 1.0), up = scaled(direction(a), 1.0);
            float x = acc_float(size * acc_log_uniform(a, 1e-3, 10.0));
            float y = acc_float(size * acc_log_uniform(a, 1e-3, 10.0));
            s = hdrp_cull_shape_box(p, f, up, x, y, acc_float(i & 2 ? size : 0.0), 0u);
            s.center_range.w = acc_float(i & 4 ? size : 0.0);
            radius = farthest_corner(s) + (double)s.center_range.w;
        }
        hdrp_v4 ball = hdrp_cull_shape_ball(s);
        vec c = widened(p);
        distance = sqrt(dot(c, c));
        double error = ((double)ball.w - radius) / fmax(radius, distance);
        /* Never too small. */
        ACC_ADD(a, error < 0.0 ? 1.0 : error, "p (%.9g %.9g %.9g), radius %.9g", c.x, c.y, c.z,
                radius);
    }
}

/* A tile and the centre of a ball. */
typedef struct view {
    double left, right, bottom, top;
    vec c;
    bool flat;
} view;

/* Distance of the centre from the slice of the tile at a depth: convex. */
static double slice_distance(const view* v, double z)
{
    double k = v->flat ? 1.0 : z;
    double x = fmax(fmax(v->left * k - v->c.x, v->c.x - v->right * k), 0.0);
    double y = fmax(fmax(v->bottom * k - v->c.y, v->c.y - v->top * k), 0.0);
    return hypot(hypot(x, y), z - v->c.z);
}

/* The depth of the nearest slice, in front of the eye unless the picture is orthographic. */
static double nearest_slice(const view* v)
{
    double reach = sqrt(dot(v->c, v->c)), lo = v->flat ? v->c.z - 1e-9 * reach : 0.0;
    double hi = v->flat ? v->c.z + 1e-9 * reach : 2.0 * reach;
    for (int i = 0; i < 120; ++i) {
        double a = lo + (hi - lo) * 0.382, b = lo + (hi - lo) * 0.618;
        bool left = slice_distance(v, a) <= slice_distance(v, b);
        lo = left ? lo : a;
        hi = left ? b : hi;
    }
    return 0.5 * (lo + hi);
}

/* The radius for which one end of the interval is the true one: the ball reaches a depth when its
 * radius is the distance of a slice there or beyond. */
static double radius_of_end(const view* v, double z, double nearest, bool is_far)
{
    bool beyond = is_far ? z > nearest : z < nearest;
    return slice_distance(v, beyond ? z : nearest);
}

static double interval_error_of(const view* v, double radius, hdrp_cull_interval r)
{
    double z = nearest_slice(v), touching = slice_distance(v, z), size, error;
    double lo = (double)r.nearest, hi = (double)r.farthest;
    size = fmax(radius, sqrt(dot(v->c, v->c)));
    if (isnan(lo) || isnan(hi)) {
        return (double)NAN;
    }
    if (lo > hi || (!v->flat && hi < 0.0)) {
        return fmax(radius - touching, 0.0) / size;
    }
    /* What begins behind the eye is cut off by the picture. */
    error = v->flat || lo > 0.0 ? fabs(radius_of_end(v, lo, z, false) - radius) : 0.0;
    return fmax(error, fabs(radius_of_end(v, hi, z, true) - radius)) / size;
}

static hdrp_cull_tile random_tile(acc* a, float flat, double size)
{
    const float width = 1920.0f, height = 1080.0f;
    hdrp_v3 o = hdrp_v3_make(0.0f, 0.0f, 0.0f), z = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    hdrp_v3 y = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    double k = flat > 0.0f ? size * acc_log_uniform(a, 1e-2, 1e2) : tan(acc_uniform(a, 0.05, 1.3));
    double x = k * acc_uniform(a, -1.0, 1.0);
    float left = acc_float(x - k), right = acc_float(x + k);
    float bottom = acc_float(-0.6 * k), top = acc_float(0.6 * k);
    hdrp_cull_camera c =
        flat > 0.0f ? hdrp_cull_camera_orthographic(o, z, y, left, right, bottom, top, 0.1f, 1e6f)
                    : hdrp_cull_camera_perspective(o, z, y, left, right, bottom, top, 0.1f, 1e6f);
    float px = acc_float(floor(acc_log_uniform(a, 8.0, 513.0)));
    float x0 = acc_float(floor(acc_uniform(a, 0.0, 1920.0 - (double)px)));
    float y0 = acc_float(floor(acc_uniform(a, 0.0, 1080.0 - (double)px)));
    return hdrp_cull_tile_make(c, x0, y0, x0 + px, y0 + px, width, height);
}

static void interval_error(acc* a)
{
    for (int i = 0; i < 20000; ++i) {
        float flat = i & 1 ? 1.0f : 0.0f;
        double distance = acc_log_uniform(a, 1e-3, 1e5), radius = acc_log_uniform(a, 1e-3, 1e5);
        hdrp_cull_tile t = random_tile(a, flat, distance);
        view v = {(double)t.window.x, (double)t.window.y, (double)t.window.z,
                  (double)t.window.w, {0.0, 0.0, 0.0},    flat > 0.0f};
        /* Around the tile, or anywhere. */
        vec c = {acc_uniform(a, v.left, v.right), acc_uniform(a, v.bottom, v.top), 1.0};
        if (v.flat) {
            c.z = distance * acc_uniform(a, -1.0, 1.0);
            distance = 1.0;
        }
        vec aside = direction(a);
        double off = acc_log_uniform(a, 1e-3, 2.0) * sqrt(dot(c, c));
        c = minus(i & 6 ? c : (vec){0.0, 0.0, 0.0}, aside, off);
        hdrp_v3 p = scaled(c, distance);
        v.c = widened(p);
        if (i & 8) { /* near the limit, where it just reaches the tile */
            double touching = slice_distance(&v, nearest_slice(&v));
            radius = touching * (1.0 + acc_log_uniform(a, 1e-8, 1e-2));
        }
        radius = (double)acc_float(fmax(radius, 1e-3));
        hdrp_cull_interval r =
            hdrp_cull_interval_ball(t, hdrp_v4_from_v3(p, acc_float(radius)), flat);
        ACC_ADD(a, interval_error_of(&v, radius, r), "%d: ball (%.9g %.9g %.9g) %.9g, tile %g %g",
                i, v.c.x, v.c.y, v.c.z, radius, v.left, v.bottom);
    }
}

const acc_entry acc_cull_volume[] = {{"cull_view_from_world", view_error},
                                     {"cull_shape_ball", ball_error},
                                     {"cull_interval_ball", interval_error},
                                     {NULL, NULL}};
