#include "builtin_shape.h"

#include "noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const hdrp_v3 up = {0.0f, 1.0f, 0.0f};

/* >>grids */

static rd_shape allocate(uint32_t vertices, uint32_t triangles)
{
    rd_shape s;
    memset(&s, 0, sizeof s);
    s.ok = rd_mesh_allocate(&s.mesh, vertices, triangles, true, true, false, 1u);
    if (!s.ok) {
        rd_mesh_free(&s.mesh);
    }
    return s;
}

/* Central differences; at a pole, where one of them vanishes, the next ring decides. */
static void differentiate(rd_surface_function f, const void* parameters, float u, float v,
                          hdrp_v3* du, hdrp_v3* dv)
{
    const float h = 1e-3f;
    *du = hdrp_v3_sub(f(u + h, v, parameters), f(u - h, v, parameters));
    *dv = hdrp_v3_sub(f(u, v + h, parameters), f(u, v - h, parameters));
    if (hdrp_v3_length(*du) < 1e-6f) {
        float inward = v < 0.5f ? v + h : v - h;
        *du = hdrp_v3_sub(f(u + h, inward, parameters), f(u - h, inward, parameters));
    }
}

static void set_vertex(rd_mesh* m, uint32_t i, rd_surface_function f, const void* parameters,
                       float u, float v, hdrp_v2 uv_scale)
{
    hdrp_v3 du, dv;
    differentiate(f, parameters, u, v, &du, &dv);
    m->positions[i] = f(u, v, parameters);
    m->normals[i] = hdrp_normalize_or(hdrp_v3_cross(du, dv), up);
    m->uv[0][i] = hdrp_v2_make(u * uv_scale.x, v * uv_scale.y);
    /* The bitangent of glTF runs against v. */
    m->tangents[i] = hdrp_v4_from_v3(hdrp_normalize_or(du, hdrp_v3_splat(0.0f)), -1.0f);
}

static void set_quads(rd_mesh* m, uint32_t columns, uint32_t rows)
{
    uint32_t* t = m->indices;
    for (uint32_t j = 0; j < rows; ++j) {
        for (uint32_t i = 0; i < columns; ++i, t += 6) {
            uint32_t a = j * (columns + 1) + i;
            uint32_t c = a + columns + 1;
            uint32_t corners[6] = {a, a + 1, c + 1, a, c + 1, c};
            memcpy(t, corners, sizeof corners);
        }
    }
}

rd_shape rd_shape_grid(rd_surface_function f, const void* parameters, uint32_t columns,
                       uint32_t rows, hdrp_v2 uv_scale)
{
    rd_shape s = allocate((columns + 1) * (rows + 1), columns * rows * 2);
    if (!s.ok) {
        return s;
    }
    for (uint32_t j = 0; j <= rows; ++j) {
        for (uint32_t i = 0; i <= columns; ++i) {
            set_vertex(&s.mesh, j * (columns + 1) + i, f, parameters, (float)i / (float)columns,
                       (float)j / (float)rows, uv_scale);
        }
    }
    set_quads(&s.mesh, columns, rows);
    return s;
}

/* >>closed shapes. u runs around +Y against the clock as seen from above, v downwards, so that
 * d/du x d/dv points inwards: shapes run v upwards and flip the texture's v instead. */

static hdrp_v3 on_unit_sphere(float u, float v)
{
    float a = u * HDRP_TWO_PI, b = v * HDRP_PI;
    return hdrp_v3_make(sinf(b) * sinf(a), -cosf(b), sinf(b) * cosf(a));
}

static hdrp_v3 sphere(float u, float v, const void* parameters)
{
    return hdrp_v3_scale(on_unit_sphere(u, v), *(const float*)parameters);
}

rd_shape rd_shape_sphere(float radius, uint32_t segments, hdrp_v2 uv_scale)
{
    return rd_shape_grid(sphere, &radius, segments, segments / 2, uv_scale);
}

static hdrp_v3 torus(float u, float v, const void* parameters)
{
    const float* p = (const float*)parameters;
    float a = u * HDRP_TWO_PI, b = v * HDRP_TWO_PI;
    float r = p[0] - p[1] * cosf(b);
    return hdrp_v3_make(r * sinf(a), -p[1] * sinf(b), r * cosf(a));
}

rd_shape rd_shape_torus(float radius, float tube, uint32_t segments)
{
    float p[2] = {radius, tube};
    return rd_shape_grid(torus, p, segments, segments / 2, hdrp_v2_make(8.0f, 2.0f));
}

typedef struct rock_parameters {
    float radius;
    uint32_t seed;
} rock_parameters;

static hdrp_v3 rock(float u, float v, const void* parameters)
{
    const rock_parameters* p = (const rock_parameters*)parameters;
    hdrp_v3 d = on_unit_sphere(u, v);
    hdrp_v3 at = hdrp_v3_mad(hdrp_v3_splat(8.0f), d, 1.1f);
    float coarse = rd_fractal_noise(at, 64u, 2, p->seed);
    float fine = hdrp_abs(rd_fractal_noise(hdrp_v3_scale(at, 2.5f), 256u, 4, p->seed + 7u));
    float r = p->radius * (1.0f + 0.28f * coarse - 0.12f * fine);
    return hdrp_v3_make(d.x * r * 1.15f, d.y * r * 0.9f, d.z * r);
}

rd_shape rd_shape_rock(float radius, uint32_t segments, uint32_t seed)
{
    rock_parameters p = {radius, seed};
    return rd_shape_grid(rock, &p, segments, segments / 2, hdrp_v2_make(4.0f, 2.0f));
}

/* >>lathe */

static hdrp_v2 segment_normal(hdrp_v2 a, hdrp_v2 b)
{
    /* The profile runs downwards, with the solid on the inner side. */
    hdrp_v2 n = hdrp_v2_make(a.y - b.y, b.x - a.x);
    float length = sqrtf(hdrp_v2_dot(n, n));
    return length > 0.0f ? hdrp_v2_scale(n, 1.0f / length) : hdrp_v2_make(0.0f, 1.0f);
}

/* The normal of segment s at its end e: shared with the neighbour across soft edges. */
static hdrp_v2 profile_normal(const hdrp_v2* profile, uint32_t count, uint32_t s, uint32_t e)
{
    hdrp_v2 own = segment_normal(profile[s], profile[s + 1]);
    hdrp_v2 other = own;
    hdrp_v2 sum;
    if (e == 0 && s > 0) {
        other = segment_normal(profile[s - 1], profile[s]);
    } else if (e == 1 && s + 2 < count) {
        other = segment_normal(profile[s + 1], profile[s + 2]);
    }
    if (hdrp_v2_dot(own, other) < 0.766f) {
        return own;
    }
    sum = hdrp_v2_add(own, other);
    return hdrp_v2_scale(sum, 1.0f / sqrtf(hdrp_v2_dot(sum, sum)));
}

static void set_lathe_vertex(rd_mesh* m, uint32_t i, hdrp_v2 point, hdrp_v2 normal, float turn,
                             hdrp_v2 uv)
{
    float s = sinf(turn * HDRP_TWO_PI), c = cosf(turn * HDRP_TWO_PI);
    m->positions[i] = hdrp_v3_make(point.x * s, point.y, point.x * c);
    m->normals[i] = hdrp_v3_make(normal.x * s, normal.y, normal.x * c);
    m->tangents[i] = hdrp_v4_make(c, 0.0f, -s, 1.0f);
    m->uv[0][i] = uv;
}

static void set_lathe_band(rd_mesh* m, const hdrp_v2* profile, uint32_t count, uint32_t band,
                           uint32_t segments, hdrp_v2 uv_scale)
{
    uint32_t first = band * 2 * (segments + 1);
    uint32_t* t = m->indices + (size_t)band * segments * 6;
    for (uint32_t e = 0; e < 2; ++e) {
        hdrp_v2 n = profile_normal(profile, count, band, e);
        float v = (float)(band + e) / (float)(count - 1);
        for (uint32_t i = 0; i <= segments; ++i) {
            float turn = (float)i / (float)segments;
            set_lathe_vertex(m, first + e * (segments + 1) + i, profile[band + e], n, turn,
                             hdrp_v2_make(turn * uv_scale.x, v * uv_scale.y));
        }
    }
    for (uint32_t i = 0; i < segments; ++i, t += 6) {
        uint32_t a = first + i, c = a + segments + 1;
        uint32_t corners[6] = {a, c, c + 1, a, c + 1, a + 1};
        memcpy(t, corners, sizeof corners);
    }
}

rd_shape rd_shape_lathe(const hdrp_v2* profile, uint32_t count, uint32_t segments, hdrp_v2 uv_scale)
{
    uint32_t bands = count - 1;
    rd_shape s = allocate(bands * 2 * (segments + 1), bands * segments * 2);
    for (uint32_t b = 0; s.ok && b < bands; ++b) {
        set_lathe_band(&s.mesh, profile, count, b, segments, uv_scale);
    }
    return s;
}

/* >>rounded box: six faces, each a grid whose lines crowd at the edges */

#define EDGE_STEPS 6
#define FACE_LINES (2 * (EDGE_STEPS + 1))

/* Line i of a side from -half to half: the rounded parts in equal angles. */
static float face_line(int i, float half, float radius)
{
    float side = i <= EDGE_STEPS ? -1.0f : 1.0f;
    int from_edge = i <= EDGE_STEPS ? i : FACE_LINES - 1 - i;
    float angle = (float)from_edge / EDGE_STEPS * 0.25f * HDRP_PI;
    return side * (half - radius + radius * tanf(0.25f * HDRP_PI - angle));
}

static float component(hdrp_v3 v, int i)
{
    return i == 0 ? v.x : i == 1 ? v.y : v.z;
}

/* A vector whose components along three axes, counted from `first` on, are a, b and c. */
static hdrp_v3 compose(int first, float a, float b, float c)
{
    float v[3];
    v[first] = a;
    v[(first + 1) % 3] = b;
    v[(first + 2) % 3] = c;
    return hdrp_v3_make(v[0], v[1], v[2]);
}

static void set_face_vertex(rd_mesh* m, uint32_t index, hdrp_v3 on_cube, hdrp_v3 core, float radius,
                            hdrp_v3 tangent, hdrp_v2 uv)
{
    hdrp_v3 inner =
        hdrp_v3_make(hdrp_clamp(on_cube.x, -core.x, core.x), hdrp_clamp(on_cube.y, -core.y, core.y),
                     hdrp_clamp(on_cube.z, -core.z, core.z));
    hdrp_v3 n = hdrp_v3_normalize(hdrp_v3_sub(on_cube, inner));
    hdrp_v3 t = hdrp_v3_mad(tangent, n, -hdrp_v3_dot(tangent, n));
    m->positions[index] = hdrp_v3_mad(inner, n, radius);
    m->normals[index] = n;
    m->tangents[index] = hdrp_v4_from_v3(hdrp_normalize_or(t, tangent), 1.0f);
    m->uv[0][index] = uv;
}

static void set_face(rd_mesh* m, int face, hdrp_v3 half, float radius)
{
    int axis = face / 2;
    float sign = face % 2 ? 1.0f : -1.0f;
    hdrp_v3 core = hdrp_v3_make(half.x - radius, half.y - radius, half.z - radius);
    uint32_t first = (uint32_t)(face * FACE_LINES * FACE_LINES);
    uint32_t* t = m->indices + (size_t)face * (FACE_LINES - 1) * (FACE_LINES - 1) * 6;
    for (int j = 0; j < FACE_LINES; ++j) {
        for (int i = 0; i < FACE_LINES; ++i) {
            float a = sign * face_line(i, component(half, (axis + 1) % 3), radius);
            float b = face_line(j, component(half, (axis + 2) % 3), radius);
            hdrp_v3 p = compose(axis, sign * component(half, axis), a, b);
            set_face_vertex(m, first + (uint32_t)(j * FACE_LINES + i), p, core, radius,
                            compose(axis, 0.0f, sign, 0.0f), hdrp_v2_make(sign * a, -b));
        }
    }
    for (uint32_t j = 0; j + 1 < FACE_LINES; ++j) {
        for (uint32_t i = 0; i + 1 < FACE_LINES; ++i, t += 6) {
            uint32_t a = first + j * FACE_LINES + i, c = a + FACE_LINES;
            uint32_t corners[6] = {a, a + 1, c + 1, a, c + 1, c};
            memcpy(t, corners, sizeof corners);
        }
    }
}

rd_shape rd_shape_rounded_box(hdrp_v3 size, float radius)
{
    uint32_t quads = (FACE_LINES - 1) * (FACE_LINES - 1);
    rd_shape s = allocate(6 * FACE_LINES * FACE_LINES, 6 * quads * 2);
    for (int face = 0; s.ok && face < 6; ++face) {
        set_face(&s.mesh, face, hdrp_v3_scale(size, 0.5f), radius);
    }
    return s;
}

/* >>sheets. v runs upwards in space; their textures are turned upside down by a negative scale. */

typedef struct sheet_parameters {
    float width, height, depth;
} sheet_parameters;

static hdrp_v3 cloth(float u, float v, const void* parameters)
{
    const sheet_parameters* p = (const sheet_parameters*)parameters;
    float loose = 1.0f - 0.55f * v; /* folds open towards the lower edge */
    float phase = u * 5.0f * HDRP_TWO_PI + 1.3f * sinf(v * 2.2f + u * 5.0f);
    float z = p->depth * loose * (0.7f * sinf(phase) + 0.3f * sinf(phase * 2.0f + v * 3.0f));
    float hem = 0.03f * loose * cosf(phase);
    return hdrp_v3_make((u - 0.5f) * p->width * (0.92f + 0.08f * loose), v * p->height + hem, z);
}

rd_shape rd_shape_cloth(float width, float height, float depth, hdrp_v2 uv_scale)
{
    sheet_parameters p = {width, height, depth};
    return rd_shape_grid(cloth, &p, 160, 60, uv_scale);
}

static hdrp_v3 card(float u, float v, const void* parameters)
{
    const sheet_parameters* p = (const sheet_parameters*)parameters;
    return hdrp_v3_make((u - 0.5f) * p->width, v * p->height, -p->depth * v * v);
}

rd_shape rd_shape_card(float width, float height, float bend, hdrp_v2 uv_scale)
{
    sheet_parameters p = {width, height, bend};
    return rd_shape_grid(card, &p, 4, bend != 0.0f ? 12 : 1, uv_scale);
}

typedef struct cove_parameters {
    float half_width, front, back, bend, height;
} cove_parameters;

/* Along the floor, around the bend, up the wall, at even speed. */
static hdrp_v3 cove(float u, float v, const void* parameters)
{
    const cove_parameters* p = (const cove_parameters*)parameters;
    float floor_length = p->front - p->back - p->bend;
    float arc = HDRP_HALF_PI * p->bend;
    float s = v * (floor_length + arc + p->height);
    float x = (u - 0.5f) * 2.0f * p->half_width;
    float angle;
    if (s < floor_length) {
        return hdrp_v3_make(x, 0.0f, p->front - s);
    }
    if (s > floor_length + arc) {
        return hdrp_v3_make(x, p->bend + s - floor_length - arc, p->back);
    }
    angle = (s - floor_length) / p->bend;
    return hdrp_v3_make(x, p->bend * (1.0f - cosf(angle)),
                        p->back + p->bend * (1.0f - sinf(angle)));
}

rd_shape rd_shape_cove(float half_width, float front, float back, float bend, float height,
                       float uv_per_m)
{
    cove_parameters p = {half_width, front, back, bend, height};
    float length = front - back - bend + HDRP_HALF_PI * bend + height;
    return rd_shape_grid(cove, &p, 8, 96,
                         hdrp_v2_make(2.0f * half_width * uv_per_m, length * uv_per_m));
}
