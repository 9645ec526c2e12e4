/* The lights of a scene as records of hdrp_light.h. */
#ifndef RD_LIGHTS_H
#define RD_LIGHTS_H

#include "hdrp_light.h"
#include "scene.h"

typedef struct rd_lights {
    hdrp_light* items;
    uint32_t count;
    hdrp_cull_blocker_scene blockers; /* of the same lights */
    hdrp_v4* places;                  /* that it refers to */
    hdrp_cull_blocker_links* links;
} rd_lights;

/* What the light list is made of. */
typedef struct rd_lights_desc {
    const rd_scene* scene;
    const hdrp_light* sun; /* of the sky, NULL: none; becomes the first light */
    uint32_t generated;    /* scattered over the scene */
    float generated_lux;   /* of the generated lights together, on average */
    uint32_t seed;
} rd_lights_desc;

bool rd_lights_make(rd_lights* lights, const rd_lights_desc* desc);
void rd_lights_free(rd_lights* lights);

/* The record of a light of the scene. */
hdrp_light rd_light_record(const rd_light* light);

/* No part of a box is reached by the light, by distance. */
bool rd_light_misses(const hdrp_light* light, const rd_bounds* box);

/* The cone that the source of a light fills, seen from where its incident light was evaluated: the
 * sine of its half angle, 0 for a source without size. */
float rd_light_sine(const hdrp_light* light, const hdrp_light_incident* incident);

/* Variance of normals, as hdrp_brdf_perceptual_roughness_filtered takes it, that spreads the image
 * of a point as far as the source is wide. */
float rd_light_variance(float sine);

/* A unit direction in that cone, even over its disc. */
hdrp_v3 rd_light_direction(const hdrp_light_incident* incident, float sine, hdrp_v2 u);

/* Where a shadow ray to the light ends: in front of the source itself. */
float rd_light_shadow_end(const hdrp_light* light, const hdrp_light_incident* incident);

#endif
