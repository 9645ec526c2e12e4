/* cull_hash.h - the scenes that cull_hash.c makes lists of.
 * SPDX-License-Identifier: MIT */
#ifndef CULL_HASH_H
#define CULL_HASH_H

#include "hdrp_cull.h"

#define CULL_HASH_SCENES     26u
#define CULL_HASH_SHAPES_MAX 1000u

typedef struct cull_hash_scene {
    hdrp_cull_camera camera;
    hdrp_cull_desc desc;
    uint32_t count;
    hdrp_cull_shape shapes[CULL_HASH_SHAPES_MAX];
    float* texels; /* to be freed, or NULL */
} cull_hash_scene;

void cull_hash_scene_make(cull_hash_scene* scene, uint32_t index);

#endif
