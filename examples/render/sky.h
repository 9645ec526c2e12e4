/* The procedural sky: a clear atmosphere over a diffuse ground, and the sun as a light. */
#ifndef RD_SKY_H
#define RD_SKY_H

#include "image.h"
#include "hdrp_math.h"

typedef struct rd_sky {
    hdrp_v3 sun_direction; /* unit, towards the sun */
    hdrp_v3 sun_lux;       /* on a plane that faces it, on the ground */
    float sun_radius_rad;  /* of the disc */
    float haze;            /* 1: clear continental air; scales the aerosol */
    hdrp_v3 ground_albedo;
    hdrp_v3 ground_nits; /* luminance of the lit ground */
} rd_sky;

/* The sun at an elevation above the horizon, and an azimuth from +Z towards +X. */
rd_sky rd_sky_make(float elevation_rad, float azimuth_rad, float haze, hdrp_v3 ground_albedo);

/* Luminance seen along a unit direction, without the disc of the sun. */
hdrp_v3 rd_sky_nits(const rd_sky* sky, hdrp_v3 direction);

/* Lat-long image of it: the first row is straight up, +Z is in the middle, +X a quarter to the
 * left of it, as OpenEXR's envmap attribute has it. */
bool rd_sky_image(const rd_sky* sky, int width, int height, rd_image_f32* image);

#endif
