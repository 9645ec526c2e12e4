/* shadow_scene.h - a plane and a ball, and shadow maps of them that are made by tracing rays.
 * SPDX-License-Identifier: MIT */
#ifndef SHADOW_SCENE_H
#define SHADOW_SCENE_H

#include <math.h>
#include <stdbool.h>

#include "hdrp_shadow.h"

/* A plane n . p = distance; a ball where radius is above 0 casts too. Sides do not matter. */
typedef struct scene {
    hdrp_v3 n;
    float distance;
    hdrp_v3 center;
    float radius;
} scene;

static inline double scene_dot(hdrp_v3 a, const double b[3])
{
    return (double)a.x * b[0] + (double)a.y * b[1] + (double)a.z * b[2];
}

/* Where the line a + t d meets the scene first for t of at least 0; negative: nowhere. */
static inline double scene_trace(const scene* s, const double a[3], const double d[3])
{
    double best = -1.0, slope = scene_dot(s->n, d);
    double t = slope != 0.0 ? ((double)s->distance - scene_dot(s->n, a)) / slope : -1.0;
    best = t >= 0.0 ? t : -1.0;
    if (s->radius > 0.0f) {
        double to[3] = {a[0] - (double)s->center.x, a[1] - (double)s->center.y,
                        a[2] - (double)s->center.z};
        double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        double b = (to[0] * d[0] + to[1] * d[1] + to[2] * d[2]) / dd;
        double c = (to[0] * to[0] + to[1] * to[1] + to[2] * to[2] -
                    (double)s->radius * (double)s->radius) /
                   dd;
        double h = b * b - c;
        t = h >= 0.0 ? -b - sqrt(h) : -1.0;
        best = t >= 0.0 && (best < 0.0 || t < best) ? t : best;
    }
    return best;
}

static inline void scene_row(hdrp_v4 row, double out[4])
{
    out[0] = (double)row.x;
    out[1] = (double)row.y;
    out[2] = (double)row.z;
    out[3] = (double)row.w;
}

/* Position whose clip coordinates are x w, y w, z w: the projection is inverted by Cramer's rule. */
static inline bool scene_unproject(const hdrp_shadow_view* v, double x, double y, double z,
                                   double p[3])
{
    double r[4][4], m[3][3], b[3], det = 0.0;
    const double value[3] = {x, y, z};
    scene_row(v->clip_x, r[0]);
    scene_row(v->clip_y, r[1]);
    scene_row(v->clip_z, r[2]);
    scene_row(v->clip_w, r[3]);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            m[i][k] = r[i][k] - value[i] * r[3][k];
        }
        b[i] = value[i] * r[3][3] - r[i][3];
    }
    det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
          m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
          m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    for (int k = 0; k < 3; ++k) {
        int i = (k + 1) % 3, l = (k + 2) % 3;
        /* column k replaced by b */
        p[k] = (b[0] * (m[1][i] * m[2][l] - m[1][l] * m[2][i]) -
                b[1] * (m[0][i] * m[2][l] - m[0][l] * m[2][i]) +
                b[2] * (m[0][i] * m[1][l] - m[0][l] * m[1][i])) /
               det;
    }
    return det != 0.0;
}

static inline double scene_clip(hdrp_v4 row, const double p[3])
{
    double r[4];
    scene_row(row, r);
    return r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3];
}

/* The depth at the centre of every texel of a view, as a rasteriser that does not round has it. */
static inline void scene_draw(const hdrp_shadow_view* v, const scene* s, float* texels,
                              uint32_t width)
{
    bool reverse = v->bias.w < 0.0f;
    for (int y = (int)v->limits.y; y <= (int)v->limits.w; ++y) {
        for (int x = (int)v->limits.x; x <= (int)v->limits.z; ++x) {
            double at_x = ((double)x + 0.5 - (double)v->place.z) / (double)v->place.x;
            double at_y = ((double)y + 0.5 - (double)v->place.w) / (double)v->place.y;
            double a[3], b[3], p[3], d[3], t, depth = reverse ? 0.0 : 1.0;
            (void)scene_unproject(v, at_x, at_y, reverse ? 1.0 : 0.0, a);
            (void)scene_unproject(v, at_x, at_y, 0.5, b);
            for (int k = 0; k < 3; ++k) {
                d[k] = b[k] - a[k];
            }
            t = scene_trace(s, a, d);
            if (t >= 0.0) {
                for (int k = 0; k < 3; ++k) {
                    p[k] = a[k] + t * d[k];
                }
                depth = scene_clip(v->clip_z, p) / scene_clip(v->clip_w, p);
                depth = depth < 0.0 ? 0.0 : depth > 1.0 ? 1.0 : depth;
            }
            texels[(size_t)y * width + (size_t)x] = (float)depth;
        }
    }
}

#endif
