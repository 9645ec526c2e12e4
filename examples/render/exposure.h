/* The exposure of a picture, metered from a small one. */
#ifndef RD_EXPOSURE_H
#define RD_EXPOSURE_H

#include "camera.h"
#include "lighting.h"

/* EV100 for the light that falls on what the camera sees, whatever its colour: as if grey cards lay
 * everywhere. Where no light falls, for what the scene emits. `options` are those of the picture. */
bool rd_exposure_meter(const rd_options* options, const rd_lighting* lighting,
                       const rd_camera* camera, float* ev100, rd_report* report);

/* EV100 of a film of RGBA [nits]: the mean of the logarithm of luminance over what is covered, or
 * all of it, without the darkest and the brightest parts. False where all is black. */
bool rd_exposure_of_film(const float* film, size_t pixels, bool covered_only, float* ev100);

#endif
