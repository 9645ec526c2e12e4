#include "camera.h"

#include <math.h>

static const hdrp_v3 world_up = {0.0f, 1.0f, 0.0f};

static void set_size(rd_camera* c, int width_px, int height_px)
{
    c->width_px = width_px;
    c->height_px = height_px;
}

static void set_lens(rd_camera* c, float fov_y_rad)
{
    c->half_height = tanf(0.5f * fov_y_rad);
    c->half_width = c->half_height * (float)c->width_px / (float)c->height_px;
}

static void set_axes(rd_camera* c, hdrp_v3 forward, hdrp_v3 up)
{
    hdrp_v3 side = hdrp_v3_cross(forward, up);
    /* Straight up or down, any right will do. */
    c->right = hdrp_normalize_or(side, hdrp_v3_make(1.0f, 0.0f, 0.0f));
    c->forward = forward;
    c->up = hdrp_v3_cross(c->right, forward);
}

rd_camera rd_camera_look_at(hdrp_v3 eye, hdrp_v3 target, float fov_y_rad, int width_px,
                            int height_px)
{
    rd_camera c;
    hdrp_v3 to = hdrp_v3_sub(target, eye);
    c.eye = eye;
    c.target = target;
    c.orthographic = false;
    set_size(&c, width_px, height_px);
    set_axes(&c, hdrp_normalize_or(to, hdrp_v3_make(0.0f, 0.0f, -1.0f)), world_up);
    set_lens(&c, fov_y_rad);
    return c;
}

static hdrp_v3 center(const rd_bounds* b)
{
    return hdrp_v3_scale(hdrp_v3_add(b->low, b->high), 0.5f);
}

static bool is_empty(const rd_bounds* b)
{
    return !(b->low.x <= b->high.x);
}

rd_camera rd_camera_from_scene(const rd_scene* scene, int index, int width_px, int height_px)
{
    const rd_scene_camera* from = &scene->cameras[index];
    rd_camera c;
    float distance = 1.0f;
    c.eye = from->world_from_view.t;
    c.orthographic = from->orthographic;
    set_size(&c, width_px, height_px);
    c.right = from->world_from_view.x;
    c.up = from->world_from_view.y;
    c.forward = hdrp_v3_neg(from->world_from_view.z);
    if (!is_empty(&scene->bounds)) {
        distance = hdrp_v3_dot(hdrp_v3_sub(center(&scene->bounds), c.eye), c.forward);
    }
    c.target = hdrp_v3_mad(c.eye, c.forward, distance > 0.0f ? distance : 1.0f);
    if (c.orthographic) {
        c.half_width = from->half_width;
        c.half_height = from->half_height;
    } else {
        set_lens(&c, from->fov_y_rad);
    }
    return c;
}

/* The smallest distance along -forward from which a box corner is inside the image. */
static float fit_corner(const rd_camera* c, hdrp_v3 corner)
{
    hdrp_v3 d = hdrp_v3_sub(corner, c->target);
    float x = hdrp_abs(hdrp_v3_dot(d, c->right)) / c->half_width;
    float y = hdrp_abs(hdrp_v3_dot(d, c->up)) / c->half_height;
    return hdrp_max(x, y) - hdrp_v3_dot(d, c->forward);
}

rd_camera rd_camera_frame(const rd_scene* scene, float fov_y_rad, int width_px, int height_px)
{
    rd_bounds b = scene->bounds;
    hdrp_v3 from = hdrp_v3_normalize(hdrp_v3_make(0.22f, 0.16f, 1.0f));
    rd_camera c;
    float distance = 0.0f;
    if (is_empty(&b)) {
        b.low = hdrp_v3_splat(-1.0f);
        b.high = hdrp_v3_splat(1.0f);
    }
    c = rd_camera_look_at(hdrp_v3_add(center(&b), from), center(&b), fov_y_rad, width_px,
                          height_px);
    for (int i = 0; i < 8; ++i) {
        hdrp_v3 corner = hdrp_v3_make(i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y,
                                      i & 4 ? b.high.z : b.low.z);
        distance = hdrp_max(distance, fit_corner(&c, corner));
    }
    /* A margin of 4 % around the box; the tiny part keeps off a scene that is a single point. */
    c.eye = hdrp_v3_mad(c.target, from, distance * 1.04f + 1e-6f);
    return c;
}

rd_camera rd_camera_orbit(rd_camera c, float angle_rad)
{
    float s = sinf(angle_rad), k = cosf(angle_rad);
    hdrp_v3* vectors[4] = {&c.eye, &c.right, &c.up, &c.forward};
    c.eye = hdrp_v3_sub(c.eye, c.target);
    for (int i = 0; i < 4; ++i) {
        hdrp_v3 v = *vectors[i];
        *vectors[i] = hdrp_v3_make(v.x * k + v.z * s, v.y, v.z * k - v.x * s);
    }
    c.eye = hdrp_v3_add(c.eye, c.target);
    return c;
}

/* Image coordinates in [-1, 1], y up. */
static hdrp_v2 screen(const rd_camera* c, float x, float y)
{
    return hdrp_v2_make(2.0f * x / (float)c->width_px - 1.0f,
                        1.0f - 2.0f * y / (float)c->height_px);
}

/* Through the image plane at distance 1, not of unit length. */
static hdrp_v3 plane_point(const rd_camera* c, hdrp_v2 s)
{
    return hdrp_v3_mad(hdrp_v3_scale(c->right, s.x * c->half_width), c->up, s.y * c->half_height);
}

rd_ray rd_camera_ray(const rd_camera* c, float x, float y)
{
    hdrp_v3 p = plane_point(c, screen(c, x, y));
    rd_ray r;
    r.origin = c->orthographic ? hdrp_v3_add(c->eye, p) : c->eye;
    r.direction = c->orthographic ? c->forward : hdrp_v3_normalize(hdrp_v3_add(c->forward, p));
    r.t_min = 0.0f;
    r.t_max = HDRP_FLT_MAX;
    return r;
}

hdrp_v2 rd_camera_project(const rd_camera* c, hdrp_v3 p)
{
    hdrp_v3 d = hdrp_v3_sub(p, c->eye);
    float depth = c->orthographic ? 1.0f : hdrp_v3_dot(d, c->forward);
    float x = hdrp_v3_dot(d, c->right) / (depth * c->half_width);
    float y = hdrp_v3_dot(d, c->up) / (depth * c->half_height);
    return hdrp_v2_make((0.5f + 0.5f * x) * (float)c->width_px,
                        (0.5f - 0.5f * y) * (float)c->height_px);
}

/* Derivative of d / |d| where d moves by step. */
static hdrp_v3 normalized_derivative(hdrp_v3 d, hdrp_v3 step)
{
    float length = hdrp_v3_length(d);
    hdrp_v3 unit = hdrp_v3_scale(d, 1.0f / length);
    return hdrp_v3_scale(hdrp_v3_mad(step, unit, -hdrp_v3_dot(unit, step)), 1.0f / length);
}

rd_ray_spread rd_camera_spread(const rd_camera* c, float x, float y)
{
    hdrp_v3 zero = hdrp_v3_splat(0.0f);
    hdrp_v3 dx = hdrp_v3_scale(c->right, 2.0f * c->half_width / (float)c->width_px);
    hdrp_v3 dy = hdrp_v3_scale(c->up, -2.0f * c->half_height / (float)c->height_px);
    hdrp_v3 d = hdrp_v3_add(c->forward, plane_point(c, screen(c, x, y)));
    rd_ray_spread s;
    s.origin_dx = c->orthographic ? dx : zero;
    s.origin_dy = c->orthographic ? dy : zero;
    s.direction_dx = c->orthographic ? zero : normalized_derivative(d, dx);
    s.direction_dy = c->orthographic ? zero : normalized_derivative(d, dy);
    return s;
}

hdrp_v2 rd_camera_jitter(uint32_t i, uint32_t seed)
{
    /* A seed starts the sequence somewhere else; 0 starts it at the centre of the pixel. */
    return hdrp_r2(i + seed * 0x9e3779b9u);
}
