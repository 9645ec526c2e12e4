/* cull_generate.c - see cull_generate.h.
 * SPDX-License-Identifier: MIT */
#include "cull_generate.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

const char* cull_view_string(cull_view view)
{
    static const char* const names[CULL_VIEWS] = {"centred", "off centre", "orthographic",
                                                  "infinite"};
    return names[view];
}

hdrp_cull_camera cull_random_camera(cull_random* r, cull_view view)
{
    static const double eyes[4] = {0.0, 100.0, 1e5, 1e5};
    double near_m = cull_log_uniform(r, 1e-3, 10.0);
    double far_m = near_m * cull_log_uniform(r, 3.0, 1e6);
    double size = cull_log_uniform(r, 0.03, 3.0), aspect = cull_log_uniform(r, 0.4, 2.5);
    double e = eyes[cull_below(r, 4u)];
    double offset_x = 0.0, offset_y = 0.0;
    hdrp_v3 eye = hdrp_v3_make((float)cull_uniform(r, -e, e), (float)cull_uniform(r, -e, e),
                               (float)cull_uniform(r, -e, e));
    hdrp_v3 forward = cull_direction(r), up = cull_direction(r);
    if (cull_below(r, 3u) == 0u) { /* along the axes, as in a test picture */
        forward = hdrp_v3_make(0.0f, 0.0f, -1.0f);
        up = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    }
    if (view == CULL_VIEW_WINDOW) {
        offset_x = size * cull_uniform(r, -2.0, 2.0);
        offset_y = size * cull_uniform(r, -2.0, 2.0);
    }
    if (view == CULL_VIEW_INFINITE) {
        far_m = (double)HDRP_CULL_FAR_INFINITE;
    }
    if (view == CULL_VIEW_ORTHOGRAPHIC) {
        double m = size * cull_log_uniform(r, 1.0, 1e4);
        return hdrp_cull_camera_orthographic(eye, forward, up, (float)(-m * aspect),
                                             (float)(m * aspect * cull_uniform(r, -0.5, 2.0)),
                                             (float)-m, (float)m, (float)near_m, (float)far_m);
    }
    return hdrp_cull_camera_perspective(eye, forward, up, (float)(offset_x - size * aspect),
                                        (float)(offset_x + size * aspect), (float)(offset_y - size),
                                        (float)(offset_y + size), (float)near_m, (float)far_m);
}

static double along_axes(float e, float a, float b, float f, double x, double y, double z)
{
    return (double)e + (double)a * x + (double)b * y + (double)f * z;
}

hdrp_v3 cull_world_from_view(const hdrp_cull_camera* c, double x, double y, double z)
{
    const hdrp_v4 a = c->right_far, b = c->up, f = c->forward_orthographic, e = c->eye_near;
    return hdrp_v3_make((float)along_axes(e.x, a.x, b.x, f.x, x, y, z),
                        (float)along_axes(e.y, a.y, b.y, f.y, x, y, z),
                        (float)along_axes(e.z, a.z, b.z, f.z, x, y, z));
}

/* Around what is seen, sometimes behind it, at the eye, or near the near plane. */
static hdrp_v3 random_place(cull_random* r, const hdrp_cull_camera* c, double* distance)
{
    double near_m = (double)c->eye_near.w, far_m = fmin((double)c->right_far.w, near_m * 1e6);
    double z = cull_log_uniform(r, near_m * 0.7, far_m * 1.2), spread;
    double u = (double)c->window.x + (double)c->window.z * cull_uniform(r, -0.4, 1.4);
    double v = (double)c->window.y + (double)c->window.w * cull_uniform(r, -0.4, 1.4);
    switch (cull_below(r, 12u)) {
    case 0u:
        z = -z;
        break;
    case 1u:
        z = 0.0;
        u = v = 0.0;
        break;
    case 2u:
        z = near_m * cull_uniform(r, 0.0, 2.0);
        break;
    default:
        break;
    }
    spread = c->forward_orthographic.w > 0.0f ? 1.0 : fabs(z);
    *distance = sqrt(u * u * spread * spread + v * v * spread * spread + z * z);
    return cull_world_from_view(c, u * spread, v * spread, z);
}

static double random_half_angle(cull_random* r, bool wide)
{
    double degrees = cull_uniform(r, 0.0, 90.0);
    switch (cull_below(r, 7u)) {
    case 0u:
        degrees = 0.05; /* 0.1 and 179.9 degrees from side to side */
        break;
    case 1u:
        degrees = 89.95;
        break;
    case 2u:
        degrees = cull_log_uniform(r, 1e-3, 90.0);
        break;
    case 3u:
        degrees = 90.0 - cull_log_uniform(r, 1e-5, 90.0);
        break;
    default:
        break;
    }
    return (wide ? 180.0 - degrees : degrees) * (PI / 180.0);
}

cull_item cull_random_item(cull_random* r, const hdrp_cull_camera* c, cull_type type)
{
    cull_item i;
    double distance, size;
    memset(&i, 0, sizeof i);
    i.type = type;
    i.position = random_place(r, c, &distance);
    i.forward = cull_direction(r);
    if (cull_below(r, 3u) == 0u) { /* almost towards the eye or along an axis of the camera */
        hdrp_v3 eye = hdrp_v3_from_v4(c->eye_near);
        hdrp_v3 axes[4] = {hdrp_v3_sub(i.position, eye), hdrp_v3_from_v4(c->right_far),
                           hdrp_v3_from_v4(c->up), hdrp_v3_from_v4(c->forward_orthographic)};
        hdrp_v3 axis = hdrp_normalize_or(axes[cull_below(r, 4u)], i.forward);
        float side = cull_below(r, 2u) == 0u ? 1.0f : -1.0f;
        float off = cull_below(r, 8u) == 0u ? 0.0f : (float)cull_log_uniform(r, 1e-7, 1.0);
        i.forward = hdrp_normalize_or(
            hdrp_v3_add(hdrp_v3_scale(axis, side), hdrp_v3_scale(cull_direction(r), off)), axis);
    }
    do {
        i.up = cull_direction(r);
    } while (hdrp_abs(hdrp_v3_dot(i.up, i.forward)) > 0.99f);
    distance = fmax(distance, (double)c->eye_near.w);
    i.range = (float)fmin(fmax(distance * cull_log_uniform(r, 3e-3, 3.0), 1e-3), 1e5);
    if (cull_below(r, 8u) == 0u) {
        i.range = (float)cull_log_uniform(r, 1e-3, 1e5);
    }
    size = (double)i.range * cull_log_uniform(r, 1e-2, 10.0);
    i.half_x = (float)(size * cull_log_uniform(r, 1e-2, 1.0));
    i.half_y = (float)(size * cull_log_uniform(r, 1e-2, 1.0));
    i.half_z = (float)cull_log_uniform(r, 1e-3, 1.0);
    if (type == CULL_PROBE_BOX) {
        i.half_x = (float)cull_log_uniform(r, 1e-3, 1.0);
        i.half_y = cull_below(r, 8u) == 0u ? 0.0f : (float)cull_log_uniform(r, 1e-3, 1.0);
    }
    i.half_angle_x = (float)random_half_angle(r, type == CULL_SPOT_WIDE);
    i.half_angle_y = (float)random_half_angle(r, false);
    i.importance = 1.0f;
    return i;
}

/* Makes a shape as small, or as narrow, as it may be to touch a cell: the next float less does not
 * touch it. Leaves those alone that are far from it. */
static void make_touch(cull_random* r, const cull_test_scene* s, cull_item* i, const ref_cell* cell)
{
    bool angle = (i->type == CULL_SPOT || i->type == CULL_PYRAMID) && cull_below(r, 2u) == 0u;
    float* size = angle ? &i->half_angle_x : &i->range;
    uint32_t lo = hdrp_bits_from_f32(angle ? 1e-4f : 1e-3f), hi;
    uint32_t end = hdrp_bits_from_f32(angle ? 1.5707f : 1e5f);
    uint32_t at = hdrp_bits_from_f32(*size);
    hi = at;
    for (uint32_t step = 1u << 22;; hi = hi + step < end ? hi + step : end) {
        ref_body body;
        *size = hdrp_f32_from_bits(hi);
        body = cull_body_of_item(i, &s->camera);
        if (ref_intersect(&body, cell, NULL) == REF_INTERSECTS) {
            break;
        }
        lo = hi;
        if (hi == end) {
            *size = hdrp_f32_from_bits(at);
            return;
        }
    }
    while (hi - lo > 1u) {
        uint32_t middle = lo + (hi - lo) / 2u;
        ref_body body;
        *size = hdrp_f32_from_bits(middle);
        body = cull_body_of_item(i, &s->camera);
        if (ref_intersect(&body, cell, NULL) == REF_INTERSECTS) {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    *size = hdrp_f32_from_bits(hi);
}

static ref_cell random_cell(cull_random* r, const cull_test_scene* s, hdrp_cull_grid grid)
{
    float lo[HDRP_CULL_SLICES_MAX], hi[HDRP_CULL_SLICES_MAX];
    uint32_t x = cull_below(r, grid.tiles.z) * grid.tiles.x;
    uint32_t y = cull_below(r, grid.tiles.w) * grid.tiles.y, k;
    ref_cell cell = ref_cell_of_pixels(&s->camera, x, y, x + grid.tiles.x, y + grid.tiles.y,
                                       s->desc.width_px, s->desc.height_px);
    ref_slices(grid, grid.series.w, s->camera.eye_near.w, s->camera.right_far.w, lo, hi);
    do {
        k = cull_below(r, grid.cells.x);
    } while (lo[k] > hi[k]);
    cell.z0 = lo[k];
    cell.z1 = hi[k];
    return cell;
}

void cull_random_depth(cull_random* r, cull_test_scene* s)
{
    size_t count = (size_t)s->desc.width_px * s->desc.height_px;
    double near_m = (double)s->camera.eye_near.w;
    double far_m = fmin((double)s->camera.right_far.w, near_m * 1e5);
    uint32_t block = 1u + cull_below(r, 40u);
    uint64_t salt = cull_bits(r);
    s->texels = cull_allocate(count * sizeof *s->texels);
    for (size_t i = 0; i < count; ++i) {
        uint64_t x = i % s->desc.width_px / block, y = i / s->desc.width_px / block;
        cull_random local = {salt + x * 7919u + y * 104729u};
        double z = cull_log_uniform(&local, near_m * 0.9, far_m * 1.5);
        z *= 1.0 + 0.01 * cull_uniform(r, -1.0, 1.0);
        s->texels[i] = cull_below(&local, 12u) == 0u ? HDRP_DEPTH_INFINITE : (float)z;
    }
}

static void random_desc(cull_random* r, cull_test_scene* s, const cull_recipe* how)
{
    static const uint32_t slices[8] = {1u, 2u, 7u, 16u, 24u, 64u, 64u, 200u};
    hdrp_cull_desc* d = &s->desc;
    uint32_t columns = 1u + cull_below(r, how->columns), rows = 1u + cull_below(r, how->rows);
    d->tile_width_px = 1u + cull_below(r, cull_below(r, 3u) == 0u ? 4u : 80u);
    d->tile_height_px = 1u + cull_below(r, cull_below(r, 3u) == 0u ? 4u : 80u);
    d->width_px = columns * d->tile_width_px - cull_below(r, d->tile_width_px);
    d->height_px = rows * d->tile_height_px - cull_below(r, d->tile_height_px);
    d->slice_count = slices[cull_below(r, 8u)];
    d->shape_capacity = s->capacity;
    d->entry_capacity = s->capacity * d->slice_count;
    d->flags = cull_below(r, 2u) == 0u ? HDRP_CULL_ONE_SERIES : 0u;
    d->flags |= how->fast && cull_below(r, 3u) == 0u ? HDRP_CULL_FAST : 0u;
    if (cull_below(r, 4u) == 0u) {
        d->series_start_m = s->camera.eye_near.w * (float)cull_log_uniform(r, 0.5, 30.0);
        d->series_end_m = d->series_start_m * (float)cull_log_uniform(r, 1.0, 1e5);
    }
}

void cull_random_scene(cull_test_scene* s, uint64_t seed, const cull_recipe* how)
{
    cull_random random = {seed};
    hdrp_cull_grid grid;
    cull_bits(&random);
    cull_scene_init(s, how->lights);
    s->camera = cull_random_camera(&random, how->view);
    random_desc(&random, s, how);
    if (cull_below(&random, 2u) == 0u) {
        cull_random_depth(&random, s);
    }
    grid = hdrp_cull_grid_make(
        s->camera, hdrp_u32x4_make(s->desc.width_px, s->desc.height_px, s->desc.slice_count, 1u),
        hdrp_u32x4_make(s->desc.tile_width_px, s->desc.tile_height_px, 0u, 0u),
        s->desc.series_start_m, s->desc.series_end_m);
    s->count = how->lights;
    for (uint32_t i = 0; i < s->count; ++i) {
        cull_type type = (cull_type)(1u + cull_below(&random, CULL_TYPES - 1u));
        s->items[i] = cull_random_item(&random, &s->camera, i == 0u ? CULL_DIRECTIONAL : type);
        if (how->touching && i > 0u && s->items[i].type != CULL_SPOT_WIDE) {
            ref_cell cell = random_cell(&random, s, grid);
            make_touch(&random, s, &s->items[i], &cell);
        }
    }
}
