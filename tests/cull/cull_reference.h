/* cull_reference.h - what lights reach and what cells are, by brute force, for tests of culling.
 * SPDX-License-Identifier: MIT
 *
 * Written from the definitions of lights, cameras and cells, in long double, and sharing no formula
 * with hdrp_cull_volume.h. A cell is what is seen through a rectangle of the picture between two
 * depths. Whether a light reaches it is decided with a certificate: a position in both, or a plane
 * between them (Gilbert, Johnson and Keerthi 1988, "A Fast Procedure for Computing the Distance
 * Between Complex Objects in Three-Dimensional Space"). */
#ifndef CULL_REFERENCE_H
#define CULL_REFERENCE_H

#include "hdrp_cull.h"

#include <stdbool.h>

typedef long double ref_real;

typedef struct ref_v3 {
    ref_real x, y, z;
} ref_v3;

typedef enum ref_kind {
    REF_NOTHING,
    REF_EVERYTHING,
    REF_ROUND_BOX,  /* within `range` of a box, which may be flat, a line or a point */
    REF_FRONT_BOX,  /* the same of a rectangle, in front of it */
    REF_FRONT_DISC, /* of a disc with radius `half.x` */
    REF_CONE,       /* of a half angle up to pi */
    REF_PYRAMID
} ref_kind;

/* What a light, a probe or a decal reaches, in view space: x right, y up, z depth. */
typedef struct ref_body {
    ref_kind kind;
    ref_v3 center; /* of a cone or pyramid: its apex */
    ref_v3 right, up, forward;
    ref_v3 half; /* along them */
    ref_real range;
    ref_real cos_x, sin_x, cos_y, sin_y; /* half angles; a cone has the first only */
} ref_body;

/* u = x / z and v = y / z in a perspective view, x and y in m in an orthographic one. */
typedef struct ref_cell {
    ref_real u0, u1, v0, v1;
    ref_real z0, z1;
    bool orthographic;
} ref_cell;

typedef enum ref_result {
    REF_DISJOINT,
    REF_UNKNOWN, /* neither certificate: too close to call in this arithmetic */
    REF_INTERSECTS
} ref_result;

/* Positions that are this close, relative to their distance from the eye, are one. */
#define REF_TOLERANCE 1e-9L

ref_v3 ref_view_from_world(const hdrp_cull_camera* camera, hdrp_v3 position);
ref_body ref_body_of_light(const hdrp_light* light, const hdrp_cull_camera* camera);
ref_body ref_body_of_sphere(hdrp_v3 center, float radius, const hdrp_cull_camera* camera);
/* half: along right, up and forward; the lengths of forward and up do not matter. */
ref_body ref_body_of_box(hdrp_v3 center, hdrp_v3 forward, hdrp_v3 up, hdrp_v3 half,
                         const hdrp_cull_camera* camera);

/* The position of a body that is farthest in a direction of any length; a wide cone counts as its
 * ball. */
ref_v3 ref_support(const ref_body* body, ref_v3 direction);
/* A position that is at most `tolerance` outside counts. */
bool ref_contains(const ref_body* body, ref_v3 p, ref_real tolerance);
bool ref_cell_contains(const ref_cell* cell, ref_v3 p, ref_real tolerance);

/* What is seen through the pixels [x0,x1) x [y0,y1) of a picture, at all depths of a camera. */
ref_cell ref_cell_of_pixels(const hdrp_cull_camera* camera, uint32_t x0, uint32_t y0, uint32_t x1,
                            uint32_t y1, uint32_t width, uint32_t height);
/* Where a pixel of a depth is. */
ref_v3 ref_position_of_pixel(const hdrp_cull_camera* camera, ref_real x_px, ref_real y_px,
                             uint32_t width, uint32_t height, ref_real z);

/* The witness, which may be NULL, is in both where they intersect. */
ref_result ref_intersect(const ref_body* body, const ref_cell* cell, ref_v3* witness);

/* The depths that hdrp_cull_slice puts in each slice: the first and the last float of [near,far].
 * A slice without any has lo > hi, which are then the floats on its two sides. */
void ref_slices(hdrp_cull_grid grid, float scale, float near_m, float far_m, float* lo, float* hi);

/* Which slices of a tile a body reaches; returns how many. Bodies are convex, so that they are
 * neighbours, and are found by bisection; of wide cones each slice is asked for. Results that were
 * REF_UNKNOWN count as disjoint, and are added up. */
uint32_t ref_reach(const ref_body* body, const ref_cell* tile, const float* lo, const float* hi,
                   uint32_t slices, bool* reached, uint64_t* unknown);

/* Whether one of the four sides of a cell, continued, has all of a body in front of it. */
bool ref_outside_a_side(const ref_body* body, const ref_cell* cell);

#endif
