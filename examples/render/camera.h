/* The camera: rays through pixels with their derivatives, framing, and movement between frames. */
#ifndef RD_CAMERA_H
#define RD_CAMERA_H

#include "scene.h"
#include "trace.h"

typedef struct rd_camera {
    hdrp_v3 eye, target; /* target: what an orbit circles around */
    hdrp_v3 right, up, forward;
    bool orthographic;
    float half_width, half_height; /* of the image at distance 1; orthographic: in metres */
    int width_px, height_px;
} rd_camera;

/* How a ray changes from one pixel to the next. */
typedef struct rd_ray_spread {
    hdrp_v3 origin_dx, origin_dy;
    hdrp_v3 direction_dx, direction_dy;
} rd_ray_spread;

/* Looks from eye to target with +Y up. */
rd_camera rd_camera_look_at(hdrp_v3 eye, hdrp_v3 target, float fov_y_rad, int width_px,
                            int height_px);
/* A camera of the scene. */
rd_camera rd_camera_from_scene(const rd_scene* scene, int index, int width_px, int height_px);
/* Sees all of the scene, slightly from above and the right of its +Z side. */
rd_camera rd_camera_frame(const rd_scene* scene, float fov_y_rad, int width_px, int height_px);
/* Turned around the vertical through its target. */
rd_camera rd_camera_orbit(rd_camera camera, float angle_rad);

/* The ray through image position (x, y): pixel units, the origin is the upper left corner. */
rd_ray rd_camera_ray(const rd_camera* c, float x, float y);
rd_ray_spread rd_camera_spread(const rd_camera* c, float x, float y);

/* The image position of a point, in the same units. Not a number for the plane of the eye. */
hdrp_v2 rd_camera_project(const rd_camera* c, hdrp_v3 p);

/* Where in its pixel sample i lies: the R2 sequence, whose first point is the centre. */
hdrp_v2 rd_camera_jitter(uint32_t i, uint32_t seed);

#endif
