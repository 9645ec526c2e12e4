/* cull_reference.c - see cull_reference.h.
 * SPDX-License-Identifier: MIT */
#include "cull_reference.h"

#include <math.h>

static ref_v3 vec(ref_real x, ref_real y, ref_real z)
{
    ref_v3 r = {x, y, z};
    return r;
}

static ref_v3 from_float(hdrp_v3 v)
{
    return vec(v.x, v.y, v.z);
}

static ref_v3 add(ref_v3 a, ref_v3 b)
{
    return vec(a.x + b.x, a.y + b.y, a.z + b.z);
}

static ref_v3 sub(ref_v3 a, ref_v3 b)
{
    return vec(a.x - b.x, a.y - b.y, a.z - b.z);
}

static ref_v3 scale(ref_v3 a, ref_real s)
{
    return vec(a.x * s, a.y * s, a.z * s);
}

static ref_real dot(ref_v3 a, ref_v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static ref_v3 cross(ref_v3 a, ref_v3 b)
{
    return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static ref_real length(ref_v3 a)
{
    return sqrtl(dot(a, a));
}

/* a / |a|, or 0. */
static ref_v3 unit(ref_v3 a)
{
    ref_real l = length(a);
    return l > 0.0L ? scale(a, 1.0L / l) : a;
}

/* >>bodies */

static ref_v3 axis_in_view(const hdrp_cull_camera* camera, hdrp_v3 axis)
{
    ref_v3 a = from_float(axis);
    return vec(dot(a, from_float(hdrp_v3_from_v4(camera->right_far))),
               dot(a, from_float(hdrp_v3_from_v4(camera->up))),
               dot(a, from_float(hdrp_v3_from_v4(camera->forward_orthographic))));
}

ref_v3 ref_view_from_world(const hdrp_cull_camera* camera, hdrp_v3 position)
{
    ref_v3 d = sub(from_float(position), from_float(hdrp_v3_from_v4(camera->eye_near)));
    return vec(dot(d, from_float(hdrp_v3_from_v4(camera->right_far))),
               dot(d, from_float(hdrp_v3_from_v4(camera->up))),
               dot(d, from_float(hdrp_v3_from_v4(camera->forward_orthographic))));
}

/* A right-angled frame from axes that are rounded; forward counts most. */
static void set_frame(ref_body* b, ref_v3 right, ref_v3 up, ref_v3 forward)
{
    b->forward = unit(forward);
    b->right = unit(sub(right, scale(b->forward, dot(right, b->forward))));
    up = sub(up, scale(b->forward, dot(up, b->forward)));
    b->up = unit(sub(up, scale(b->right, dot(up, b->right))));
}

ref_body ref_body_of_sphere(hdrp_v3 center, float radius, const hdrp_cull_camera* camera)
{
    ref_body b = {0};
    b.kind = !(radius > 0.0f)                      ? REF_NOTHING
             : radius >= HDRP_LIGHT_RANGE_INFINITE ? REF_EVERYTHING
                                                   : REF_ROUND_BOX;
    b.center = ref_view_from_world(camera, center);
    set_frame(&b, vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1));
    b.range = radius;
    return b;
}

ref_body ref_body_of_box(hdrp_v3 center, hdrp_v3 forward, hdrp_v3 up, hdrp_v3 half,
                         const hdrp_cull_camera* camera)
{
    ref_body b = {0};
    ref_v3 f = unit(from_float(forward));
    ref_v3 right = unit(cross(f, from_float(up)));
    ref_v3 top = cross(right, f);
    ref_v3 axes[3] = {right, top, f};
    for (int i = 0; i < 3; ++i) {
        ref_v3 a = axes[i];
        axes[i] = vec(dot(a, from_float(hdrp_v3_from_v4(camera->right_far))),
                      dot(a, from_float(hdrp_v3_from_v4(camera->up))),
                      dot(a, from_float(hdrp_v3_from_v4(camera->forward_orthographic))));
    }
    b.kind = REF_ROUND_BOX;
    b.center = ref_view_from_world(camera, center);
    set_frame(&b, axes[0], axes[1], axes[2]);
    b.half = from_float(half);
    return b;
}

ref_body ref_body_of_light(const hdrp_light* light, const hdrp_cull_camera* camera)
{
    ref_body b = {0};
    hdrp_u32 type = hdrp_light_type(*light);
    ref_real range = light->position_range.w, radius = light->forward_radius.w;
    b.center = ref_view_from_world(camera, hdrp_v3_from_v4(light->position_range));
    set_frame(&b, axis_in_view(camera, hdrp_v3_from_v4(light->right_half_width)),
              axis_in_view(camera, hdrp_v3_from_v4(light->up_half_height)),
              axis_in_view(camera, hdrp_v3_from_v4(light->forward_radius)));
    b.range = range;
    b.kind = REF_ROUND_BOX;
    if (type == HDRP_LIGHT_TYPE_SPOT) {
        ref_real versine = fminl(light->edge_importance.x, 2.0L);
        b.kind = REF_CONE;
        b.cos_x = 1.0L - versine;
        b.sin_x = sqrtl(versine * (2.0L - versine));
    } else if (type == HDRP_LIGHT_TYPE_PYRAMID) {
        ref_real x = hypotl(light->half_angle.x, light->half_angle.y);
        ref_real y = hypotl(light->half_angle.z, light->half_angle.w);
        b.kind = REF_PYRAMID;
        b.cos_x = light->half_angle.x / x;
        b.sin_x = light->half_angle.y / x;
        b.cos_y = light->half_angle.z / y;
        b.sin_y = light->half_angle.w / y;
    } else if (type == HDRP_LIGHT_TYPE_BOX) {
        b.center = add(b.center, scale(b.forward, 0.5L * range));
        b.half = vec(light->right_half_width.w, light->up_half_height.w, 0.5L * range);
        b.range = 0.0L;
    } else if (type == HDRP_LIGHT_TYPE_SPHERE) {
        b.range = range + radius;
    } else if (type == HDRP_LIGHT_TYPE_LINE) {
        b.half.x = light->right_half_width.w;
    } else if (type == HDRP_LIGHT_TYPE_RECTANGLE) {
        b.kind = REF_FRONT_BOX;
        b.half = vec(light->right_half_width.w, light->up_half_height.w, 0.0L);
    } else if (type == HDRP_LIGHT_TYPE_DISC) {
        b.kind = REF_FRONT_DISC;
        b.half.x = radius;
    } else if (type != HDRP_LIGHT_TYPE_POINT && type != HDRP_LIGHT_TYPE_DIRECTIONAL) {
        b.kind = REF_NOTHING;
    }
    if (type == HDRP_LIGHT_TYPE_DIRECTIONAL ||
        (type == HDRP_LIGHT_TYPE_POINT && range >= (ref_real)HDRP_LIGHT_RANGE_INFINITE)) {
        b.kind = REF_EVERYTHING;
    }
    b.kind = range > 0.0L ? b.kind : REF_NOTHING;
    return b;
}

static ref_v3 in_frame(const ref_body* b, ref_v3 v)
{
    return vec(dot(v, b->right), dot(v, b->up), dot(v, b->forward));
}

static ref_v3 from_frame(const ref_body* b, ref_v3 v)
{
    return add(add(scale(b->right, v.x), scale(b->up, v.y)), scale(b->forward, v.z));
}

static ref_real sign_of(ref_real x)
{
    return x < 0.0L ? -1.0L : 1.0L;
}

/* The place of a cone of directions that is nearest to d, in the frame of the body: 0 where all of
 * the cone is behind d. */
static ref_v3 nearest_in_cone(const ref_body* b, ref_v3 d)
{
    ref_real across = sqrtl(d.x * d.x + d.y * d.y);
    ref_real along = across * b->sin_x + d.z * b->cos_x;
    if (b->cos_x < 0.0L || across * b->cos_x <= d.z * b->sin_x) {
        return d;
    }
    if (along <= 0.0L) {
        return vec(0, 0, 0);
    }
    return vec(d.x * (along * b->sin_x / across), d.y * (along * b->sin_x / across),
               along * b->cos_x);
}

/* The same for four symmetrical faces: the answer lies inside, on a face or on an edge. */
static ref_v3 nearest_in_pyramid(const ref_body* b, ref_v3 d)
{
    ref_v3 q = vec(fabsl(d.x), fabsl(d.y), d.z), best = vec(0, 0, 0);
    ref_v3 face[2] = {vec(b->cos_x, 0.0L, -b->sin_x), vec(0.0L, b->cos_y, -b->sin_y)};
    ref_v3 edge = unit(vec(b->sin_x * b->cos_y, b->cos_x * b->sin_y, b->cos_x * b->cos_y));
    if (dot(q, face[0]) <= 0.0L && dot(q, face[1]) <= 0.0L) {
        return d;
    }
    if (dot(q, edge) > 0.0L) {
        best = scale(edge, dot(q, edge));
    }
    for (int i = 0; i < 2; ++i) {
        /* Made of coordinates in the face: where they are rounding errors it is still inside. */
        ref_real along = i == 0 ? q.x * b->sin_x + q.z * b->cos_x : q.y * b->sin_y + q.z * b->cos_y;
        ref_v3 p = i == 0 ? vec(along * b->sin_x, q.y, along * b->cos_x)
                          : vec(q.x, along * b->sin_y, along * b->cos_y);
        if (along >= 0.0L && dot(p, face[1 - i]) <= 0.0L && dot(p, p) > dot(best, best)) {
            best = p;
        }
    }
    return vec(best.x * sign_of(d.x), best.y * sign_of(d.y), best.z);
}

ref_v3 ref_support(const ref_body* body, ref_v3 direction)
{
    ref_v3 d = unit(in_frame(body, direction)), p, rounded = d;
    const ref_v3 h = body->half;
    if (body->kind == REF_CONE || body->kind == REF_PYRAMID) {
        p = unit(body->kind == REF_CONE ? nearest_in_cone(body, d) : nearest_in_pyramid(body, d));
        return add(body->center, from_frame(body, scale(p, body->range)));
    }
    p = vec(h.x * sign_of(d.x), h.y * sign_of(d.y), h.z * sign_of(d.z));
    if (body->kind == REF_FRONT_DISC) {
        p = scale(unit(vec(d.x, d.y, 0.0L)), h.x);
    }
    if (body->kind != REF_ROUND_BOX && d.z < 0.0L) {
        rounded = unit(vec(d.x, d.y, 0.0L));
    }
    return add(body->center, from_frame(body, add(p, scale(rounded, body->range))));
}

bool ref_contains(const ref_body* body, ref_v3 p, ref_real tolerance)
{
    ref_v3 d = in_frame(body, sub(p, body->center));
    ref_real across = sqrtl(d.x * d.x + d.y * d.y);
    ref_v3 out = vec(fmaxl(fabsl(d.x) - body->half.x, 0.0L), fmaxl(fabsl(d.y) - body->half.y, 0.0L),
                     fmaxl(fabsl(d.z) - body->half.z, 0.0L));
    switch (body->kind) {
    case REF_NOTHING:
        return false;
    case REF_EVERYTHING:
        return true;
    case REF_ROUND_BOX:
        return length(out) <= body->range + tolerance;
    case REF_FRONT_BOX:
        return length(out) <= body->range + tolerance && d.z >= -tolerance;
    case REF_FRONT_DISC:
        return hypotl(fmaxl(across - body->half.x, 0.0L), d.z) <= body->range + tolerance &&
               d.z >= -tolerance;
    case REF_CONE:
        return length(d) <= body->range + tolerance &&
               across * body->cos_x - d.z * body->sin_x <= tolerance;
    case REF_PYRAMID:
        return length(d) <= body->range + tolerance &&
               fabsl(d.x) * body->cos_x - d.z * body->sin_x <= tolerance &&
               fabsl(d.y) * body->cos_y - d.z * body->sin_y <= tolerance;
    }
    return false;
}

/* >>cells */

ref_cell ref_cell_of_pixels(const hdrp_cull_camera* camera, uint32_t x0, uint32_t y0, uint32_t x1,
                            uint32_t y1, uint32_t width, uint32_t height)
{
    ref_cell c;
    ref_real left = camera->window.x, bottom = camera->window.y;
    ref_real u = (ref_real)camera->window.z / width, v = (ref_real)camera->window.w / height;
    x1 = x1 < width ? x1 : width;
    y1 = y1 < height ? y1 : height;
    c.u0 = left + u * x0;
    c.u1 = left + u * x1;
    c.v0 = bottom + v * (height - y1);
    c.v1 = bottom + v * (height - y0);
    c.z0 = camera->eye_near.w;
    c.z1 = camera->right_far.w;
    c.orthographic = camera->forward_orthographic.w > 0.0f;
    return c;
}

ref_v3 ref_position_of_pixel(const hdrp_cull_camera* camera, ref_real x_px, ref_real y_px,
                             uint32_t width, uint32_t height, ref_real z)
{
    ref_real u = camera->window.x + x_px * camera->window.z / width;
    ref_real v = camera->window.y + (height - y_px) * camera->window.w / height;
    ref_real spread = camera->forward_orthographic.w > 0.0f ? 1.0L : z;
    return vec(u * spread, v * spread, z);
}

bool ref_cell_contains(const ref_cell* cell, ref_v3 p, ref_real tolerance)
{
    ref_real spread = cell->orthographic ? 1.0L : p.z;
    return cell->u0 * spread <= p.x + tolerance && p.x - tolerance <= cell->u1 * spread &&
           cell->v0 * spread <= p.y + tolerance && p.y - tolerance <= cell->v1 * spread &&
           cell->z0 <= p.z + tolerance && p.z - tolerance <= cell->z1;
}

static void cell_corners(const ref_cell* cell, ref_v3 corners[8])
{
    for (int i = 0; i < 8; ++i) {
        ref_real z = (i & 4) != 0 ? cell->z1 : cell->z0;
        ref_real spread = cell->orthographic ? 1.0L : z;
        corners[i] = vec(((i & 1) != 0 ? cell->u1 : cell->u0) * spread,
                         ((i & 2) != 0 ? cell->v1 : cell->v0) * spread, z);
    }
}

static float float_of_bits(uint32_t bits)
{
    return hdrp_f32_from_bits(bits);
}

void ref_slices(hdrp_cull_grid grid, float scale_of_tile, float near_m, float far_m, float* lo,
                float* hi)
{
    /* Floats that are positive are in the order of their bits. */
    uint32_t end = hdrp_bits_from_f32(far_m) + 1u, begin = hdrp_bits_from_f32(near_m);
    for (uint32_t k = 0; k < grid.cells.x; ++k) {
        uint32_t a = begin, b = end; /* the first that is in a later slice is in [a, b] */
        while (a < b) {
            uint32_t middle = a + (b - a) / 2u;
            if (hdrp_cull_slice(grid, scale_of_tile, float_of_bits(middle)) > k) {
                b = middle;
            } else {
                a = middle + 1u;
            }
        }
        lo[k] = float_of_bits(begin);
        hi[k] = float_of_bits(a - 1u);
        begin = a;
    }
}

/* >>intersection */

/* A position of the difference of a body and a cell, and the position of the cell. */
typedef struct corner {
    ref_v3 w, b;
} corner;

typedef struct simplex {
    corner c[4];
    int count;
    ref_v3 nearest; /* to the origin */
    ref_v3 b;       /* where that is in the cell */
} simplex;

/* Weights of the position of the plane, line or space through up to four corners that is nearest to
 * the origin. False where the corners are no such thing. */
static bool weights(const ref_v3* p, int count, ref_real w[4], ref_v3* nearest)
{
    ref_v3 e[3];
    for (int i = 1; i < count; ++i) {
        e[i - 1] = sub(p[i], p[0]);
    }
    if (count == 1) {
        w[0] = 1.0L;
        *nearest = p[0];
    } else if (count == 2) {
        ref_real l2 = dot(e[0], e[0]);
        if (!(l2 > 0.0L)) {
            return false;
        }
        w[1] = -dot(p[0], e[0]) / l2;
        *nearest = add(p[0], scale(e[0], w[1]));
    } else if (count == 3) {
        ref_v3 n = cross(e[0], e[1]), q;
        ref_real n2 = dot(n, n);
        if (!(n2 > 1e-34L * dot(e[0], e[0]) * dot(e[1], e[1]))) {
            return false;
        }
        *nearest = scale(n, dot(p[0], n) / n2);
        q = sub(*nearest, p[0]);
        w[1] = dot(cross(q, e[1]), n) / n2;
        w[2] = dot(cross(e[0], q), n) / n2;
    } else {
        ref_v3 q = scale(p[0], -1.0L);
        ref_real volume = dot(e[0], cross(e[1], e[2]));
        if (!(fabsl(volume) > 1e-17L * length(e[0]) * length(e[1]) * length(e[2]))) {
            return false;
        }
        w[1] = dot(q, cross(e[1], e[2])) / volume;
        w[2] = dot(e[0], cross(q, e[2])) / volume;
        w[3] = dot(e[0], cross(e[1], q)) / volume;
        *nearest = vec(0, 0, 0);
    }
    w[0] = 1.0L;
    for (int i = 1; i < count; ++i) {
        w[0] -= w[i];
    }
    return true;
}

/* Keeps the face of the simplex that is nearest to the origin; the last corner is one of its own.
 * False where none is nearer than before. */
static bool reduce(simplex* s)
{
    simplex best = *s;
    bool found = false;
    ref_real least = s->count > 1 ? dot(s->nearest, s->nearest) : HUGE_VALL;
    int last = s->count - 1;
    for (int mask = 0; mask < 1 << last; ++mask) {
        simplex t;
        ref_v3 p[4];
        ref_real w[4];
        bool inside = true;
        t.count = 0;
        for (int i = 0; i <= last; ++i) {
            if (i == last || ((mask >> i) & 1) != 0) {
                p[t.count] = s->c[i].w;
                t.c[t.count++] = s->c[i];
            }
        }
        if (!weights(p, t.count, w, &t.nearest)) {
            continue;
        }
        t.b = vec(0, 0, 0);
        for (int i = 0; i < t.count; ++i) {
            inside = inside && w[i] >= 0.0L;
            t.b = add(t.b, scale(t.c[i].b, w[i]));
        }
        if (inside && dot(t.nearest, t.nearest) < least) {
            least = dot(t.nearest, t.nearest);
            best = t;
            found = true;
        }
    }
    *s = best;
    return found;
}

static corner support_difference(const ref_body* body, const ref_v3 corners[8], ref_v3 direction)
{
    corner c;
    c.b = corners[0];
    for (int i = 1; i < 8; ++i) {
        if (dot(corners[i], direction) < dot(c.b, direction)) {
            c.b = corners[i];
        }
    }
    c.w = sub(ref_support(body, direction), c.b);
    return c;
}

/* Bodies and cells are convex; a body with a sharp core counts as that, with its range added. */
static ref_result distance_test(const ref_body* body, const ref_v3 corners[8], ref_v3* witness)
{
    ref_body core = *body;
    ref_real range = 0.0L;
    simplex s;
    ref_v3 middle = scale(add(corners[0], corners[7]), 0.5L);
    if (body->kind == REF_ROUND_BOX) {
        range = body->range;
        core.range = 0.0L;
    }
    s.count = 1;
    s.nearest = sub(body->center, middle);
    s.c[0] = support_difference(&core, corners, scale(s.nearest, -1.0L));
    if (!reduce(&s)) {
        return REF_UNKNOWN;
    }
    for (int i = 0; i < 500; ++i) {
        ref_real gap = length(s.nearest), tolerance = REF_TOLERANCE * length(s.b), apart;
        corner c;
        *witness = s.b;
        if (gap <= range || gap == 0.0L) {
            return REF_INTERSECTS;
        }
        c = support_difference(&core, corners, scale(s.nearest, -1.0L));
        apart = dot(s.nearest, c.w) / gap - range;
        if (apart > tolerance) {
            return REF_DISJOINT;
        }
        if (gap - range <= tolerance) {
            return REF_INTERSECTS;
        }
        s.c[s.count++] = c;
        if (!reduce(&s)) {
            return apart > 0.0L ? REF_DISJOINT : REF_UNKNOWN;
        }
    }
    return REF_UNKNOWN;
}

bool ref_outside_a_side(const ref_body* body, const ref_cell* cell)
{
    ref_real o = cell->orthographic ? 0.0L : 1.0L, m = 1.0L - o;
    const ref_v3 normal[4] = {vec(-1.0L, 0.0L, o * cell->u0), vec(1.0L, 0.0L, -o * cell->u1),
                              vec(0.0L, -1.0L, o * cell->v0), vec(0.0L, 1.0L, -o * cell->v1)};
    const ref_real offset[4] = {-m * cell->u0, m * cell->u1, -m * cell->v0, m * cell->v1};
    for (int i = 0; i < 4; ++i) {
        ref_v3 p = ref_support(body, scale(normal[i], -1.0L));
        ref_real l = length(normal[i]);
        if (dot(p, normal[i]) - offset[i] > REF_TOLERANCE * l * length(p)) {
            return true;
        }
    }
    return false;
}

static ref_result convex_test(const ref_body* body, const ref_cell* cell, ref_v3* witness)
{
    ref_cell c = *cell;
    ref_body b = *body;
    ref_v3 corners[8];
    ref_real farthest = 0.0L;
    ref_real lo = ref_support(body, vec(0, 0, -1)).z, hi = ref_support(body, vec(0, 0, 1)).z;
    ref_real tolerance = REF_TOLERANCE * (fabsl(lo) + fabsl(hi));
    if (ref_outside_a_side(body, cell) || lo - tolerance > c.z1 || hi + tolerance < c.z0) {
        return REF_DISJOINT;
    }
    /* Depths that the body does not have do not matter, and may be infinite. */
    c.z0 = fminl(fmaxl(c.z0, lo), c.z1);
    c.z1 = fmaxl(fminl(c.z1, hi), c.z0);
    cell_corners(&c, corners);
    /* Nor does a range that is longer than the way from the centre to any of the cell. */
    for (int i = 0; i < 8; ++i) {
        farthest = fmaxl(farthest, length(sub(corners[i], b.center)));
    }
    b.range = fminl(b.range, 1.001L * farthest);
    return distance_test(&b, corners, witness);
}

/* More than half a sphere is the union of halves, one for each direction of its rim. */
static ref_result wide_cone_test(const ref_body* body, const ref_cell* cell, ref_v3* witness)
{
    ref_body part = *body;
    ref_v3 corners[8], toward;
    ref_result r;
    part.kind = REF_ROUND_BOX;
    r = convex_test(&part, cell,
                    witness); /* its ball: the witness is what is nearest to the apex */
    if (r != REF_INTERSECTS || ref_contains(body, *witness, 0.0L)) {
        return r;
    }
    cell_corners(cell, corners);
    for (int i = 0; i < 8; ++i) {
        if (ref_contains(body, corners[i], 0.0L)) {
            *witness = corners[i];
            return REF_INTERSECTS;
        }
    }
    toward = in_frame(body, sub(scale(add(corners[0], corners[7]), 0.5L), body->center));
    part.kind = REF_CONE;
    part.cos_x = 0.0L;
    part.sin_x = 1.0L;
    for (int i = 0; i < 32; ++i) {
        ref_real azimuth = atan2l(toward.y, toward.x) + i * 3.14159265358979323846L / 16.0L;
        part.forward = from_frame(
            body, vec(-body->cos_x * cosl(azimuth), -body->cos_x * sinl(azimuth), body->sin_x));
        part.right =
            unit(cross(part.forward, fabsl(part.forward.x) < 0.5L ? vec(1, 0, 0) : vec(0, 1, 0)));
        part.up = cross(part.right, part.forward);
        if (convex_test(&part, cell, witness) == REF_INTERSECTS) {
            return REF_INTERSECTS;
        }
    }
    return REF_DISJOINT;
}

ref_result ref_intersect(const ref_body* body, const ref_cell* cell, ref_v3* witness)
{
    ref_v3 unused, corners[8];
    witness = witness != NULL ? witness : &unused;
    if (body->kind == REF_NOTHING || !(cell->z0 <= cell->z1)) {
        return REF_DISJOINT;
    }
    if (body->kind == REF_EVERYTHING) {
        cell_corners(cell, corners);
        *witness = corners[0];
        return REF_INTERSECTS;
    }
    if (body->kind == REF_CONE && body->cos_x < 0.0L) {
        return wide_cone_test(body, cell, witness);
    }
    return convex_test(body, cell, witness);
}

static bool slice_test(const ref_body* body, const ref_cell* tile, float lo, float hi,
                       uint64_t* unknown)
{
    ref_cell cell = *tile;
    ref_result r;
    cell.z0 = lo < hi ? lo : hi;
    cell.z1 = lo < hi ? hi : lo;
    r = ref_intersect(body, &cell, NULL);
    *unknown += r == REF_UNKNOWN ? 1u : 0u;
    return r == REF_INTERSECTS;
}

uint32_t ref_reach(const ref_body* body, const ref_cell* tile, const float* lo, const float* hi,
                   uint32_t slices, bool* reached, uint64_t* unknown)
{
    uint32_t at = 0, first = 0, last = slices - 1u, count = 0, k;
    bool wide = body->kind == REF_CONE && body->cos_x < 0.0L;
    ref_v3 place;
    ref_result r = ref_intersect(body, tile, &place);
    *unknown += r == REF_UNKNOWN ? 1u : 0u;
    for (k = 0; k < slices; ++k) {
        reached[k] = wide && r == REF_INTERSECTS && slice_test(body, tile, lo[k], hi[k], unknown);
    }
    if (r != REF_INTERSECTS) {
        return 0u;
    }
    while (at + 1u < slices && place.z > (ref_real)hi[at]) {
        ++at;
    }
    if (!wide && body->kind != REF_EVERYTHING) {
        for (last = at; first < last;) {
            k = (first + last) / 2u;
            if (slice_test(body, tile, lo[k], hi[k], unknown)) {
                last = k;
            } else {
                first = k + 1u;
            }
        }
        for (k = at, last = slices - 1u; k < last;) {
            uint32_t middle = (k + last + 1u) / 2u;
            if (slice_test(body, tile, lo[middle], hi[middle], unknown)) {
                k = middle;
            } else {
                last = middle - 1u;
            }
        }
    }
    for (k = 0; k < slices; ++k) {
        reached[k] = (wide ? reached[k] : first <= k && k <= last) && lo[k] <= hi[k];
        count += reached[k] ? 1u : 0u;
    }
    return count;
}
