/* cull_generate.h - random scenes for the tests of hdrp_cull.h: any light in front of any camera.
 * SPDX-License-Identifier: MIT */
#ifndef CULL_GENERATE_H
#define CULL_GENERATE_H

#include "cull_harness.h"

typedef enum cull_view {
    CULL_VIEW_CENTRED,
    CULL_VIEW_WINDOW, /* off centre, as an eye of a headset; the axis may be outside */
    CULL_VIEW_ORTHOGRAPHIC,
    CULL_VIEW_INFINITE, /* perspective, without a far distance */
    CULL_VIEWS
} cull_view;

const char* cull_view_string(cull_view view);

/* What a scene may have. */
typedef struct cull_recipe {
    cull_view view;
    bool fast;              /* HDRP_CULL_FAST */
    bool touching;          /* ranges and angles are such that lights just touch a cell */
    uint32_t columns, rows; /* most tiles */
    uint32_t lights;
} cull_recipe;

hdrp_cull_camera cull_random_camera(cull_random* r, cull_view view);
hdrp_v3 cull_world_from_view(const hdrp_cull_camera* c, double x, double y, double z);
cull_item cull_random_item(cull_random* r, const hdrp_cull_camera* c, cull_type type);
/* Blocks of pixels that are near and far, each a little rough, and sky. */
void cull_random_depth(cull_random* r, cull_test_scene* s);
void cull_random_scene(cull_test_scene* s, uint64_t seed, const cull_recipe* how);

#endif
