/* From a hit to what lighting wants: position, frames, filtered textures, a hdrp_brdf_surface. */
#ifndef RD_SURFACE_H
#define RD_SURFACE_H

#include "camera.h"
#include "scene.h"
#include "trace.h"

/* Of hdrp_brdf_variance_from_derivatives: the pixel filter is a pixel wide; the limit keeps
 * silhouettes from turning dull. */
#define RD_VARIANCE_STRENGTH 0.16f
#define RD_VARIANCE_LIMIT    0.1f

typedef struct rd_surface {
    const rd_material* material;
    hdrp_brdf_surface brdf;
    hdrp_v3 position;
    hdrp_v3 view;             /* unit, towards where the ray came from */
    hdrp_v3 geometric_normal; /* unit, on the side of the viewer, as are the other normals */
    hdrp_v3 vertex_normal;    /* interpolated, unit */
    hdrp_v3 position_dx, position_dy; /* from one pixel to the next, in the plane of the triangle */
    hdrp_v3 normal_dx, normal_dy;     /* the same of the interpolated normal */
    hdrp_v2 uv;
    float distance_m;
    hdrp_v3 emission_nits;
    float alpha;
    float
        coverage; /* how much of what is behind is hidden: alpha, or 0 where only light is added */
    bool back_face;
    hdrp_u32 light_layers;
    float map_variance;      /* of the normals that the normal map has within the footprint */
    float coat_map_variance; /* the same of the coat's */
} rd_surface;

/* Spread NULL: no footprint, textures are sampled at their finest level. */
void rd_surface_evaluate(const rd_scene* scene, const rd_ray* ray, const rd_ray_spread* spread,
                         const rd_hit* hit, rd_surface* out);

#endif
