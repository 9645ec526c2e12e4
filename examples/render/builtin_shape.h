/* Shapes of the built-in scene: parametric surfaces with normals, uv and tangents. */
#ifndef RD_BUILTIN_SHAPE_H
#define RD_BUILTIN_SHAPE_H

#include "scene.h"

/* A point for parameters in [0,1]^2. The normal is d/du x d/dv. */
typedef hdrp_v3 (*rd_surface_function)(float u, float v, const void* parameters);

typedef struct rd_shape {
    rd_mesh mesh;
    bool ok; /* false: out of memory */
} rd_shape;

/* A grid of columns x rows quads over the parameters; uv = parameters * uv_scale. */
rd_shape rd_shape_grid(rd_surface_function f, const void* parameters, uint32_t columns,
                       uint32_t rows, hdrp_v2 uv_scale);

rd_shape rd_shape_sphere(float radius, uint32_t segments, hdrp_v2 uv_scale);
rd_shape rd_shape_torus(float radius, float tube, uint32_t segments);
/* A sphere with bumps of noise. */
rd_shape rd_shape_rock(float radius, uint32_t segments, uint32_t seed);
/* Turned around +Y: a profile of (radius, height) points from top to bottom, smoothed only where
 * neighbouring segments turn by less than 40 degrees. */
rd_shape rd_shape_lathe(const hdrp_v2* profile, uint32_t count, uint32_t segments,
                        hdrp_v2 uv_scale);
/* Edges rounded to a radius; uv in metres. Centred, of full size. */
rd_shape rd_shape_rounded_box(hdrp_v3 size, float radius);
/* Upright in the xy plane, facing +Z, hanging in folds. */
rd_shape rd_shape_cloth(float width, float height, float depth, hdrp_v2 uv_scale);
/* Floor that bends up into a wall behind it; open towards +Z. */
rd_shape rd_shape_cove(float half_width, float front, float back, float bend, float height,
                       float uv_per_m);
/* Upright in the xy plane, facing +Z, bottom edge at y = 0. Bent backwards by `bend` metres. */
rd_shape rd_shape_card(float width, float height, float bend, hdrp_v2 uv_scale);

#endif
