/* A picture at ever lower resolutions: what is seen through rough glass. */
#ifndef RD_PYRAMID_H
#define RD_PYRAMID_H

#include "hdrp_math.h"

#include <stdbool.h>

#define RD_PYRAMID_MAX 12

typedef struct rd_pyramid {
    int width, height, level_count;
    hdrp_v3* level[RD_PYRAMID_MAX]; /* level 0 is the caller's; the others one block, at level[1] */
} rd_pyramid;

bool rd_pyramid_begin(rd_pyramid* p, hdrp_v3* picture, int width, int height);
void rd_pyramid_end(rd_pyramid* p);

/* Fills the levels from level 0. */
void rd_pyramid_build(rd_pyramid* p);

/* Trilinear; x and y in pixels of level 0, limited to the picture. */
hdrp_v3 rd_pyramid_sample(const rd_pyramid* p, float x, float y, float lod);

#endif
