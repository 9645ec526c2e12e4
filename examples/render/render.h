/* One picture: the passes of a frame, sample by sample, into a film. */
#ifndef RD_RENDER_H
#define RD_RENDER_H

#include "camera.h"
#include "gbuffer.h"
#include "lighting.h"
#include "lists.h"
#include "oit.h"
#include "options.h"
#include "progress.h"
#include "pyramid.h"
#include "scene.h"
#include "stats.h"
#include "trace.h"
#include "variants.h"

typedef struct rd_render_counts {
    uint64_t primary_rays, shadow_rays, occlusion_rays, path_rays;
    uint64_t deferred_samples, forward_samples, layer_hits, layers_dropped;
    rd_shade_counts shade;
} rd_render_counts;

/* A sub-frame is the whole image at one sample a pixel. Every pass of the pipeline runs over it by
 * rows; the film sums the sub-frames up. */
typedef struct rd_renderer {
    const rd_options* options;
    const rd_scene* scene;
    const rd_trace* trace;
    const rd_lighting* lighting;
    rd_stats* stats; /* NULL: times are not kept */
    rd_progress* progress;
    rd_camera camera;
    int width, height, spp;
    float exposure; /* of a nit; the GBuffer stores emission exposed, unlit materials show as set */
    /* Of the sub-frame, by pixel. */
    rd_hit* hits;
    rd_gbuffer gbuffer;
    float* visibility[2]; /* of the surroundings: as traced, and blurred */
    rd_lists lists;       /* of lights */
    rd_variants variants;
    hdrp_v3* lit;       /* opaque surfaces and the sky [nits] */
    rd_pyramid pyramid; /* of lit, for what is seen through rough glass */
    rd_oit_images oit;  /* where blended surfaces are not sorted */
    float* film;        /* RGBA; A is the coverage. Sums, and means once rd_render has returned */
    rd_render_counts counts;
} rd_renderer;

typedef struct rd_renderer_desc {
    const rd_options* options;
    const rd_lighting* lighting;
    float exposure;
    rd_stats* stats;
    rd_progress* progress;
} rd_renderer_desc;

bool rd_renderer_begin(rd_renderer* r, const rd_renderer_desc* desc, rd_report* report);
/* Fills the film with the picture that the camera sees. */
void rd_render(rd_renderer* r, const rd_camera* camera);
void rd_renderer_end(rd_renderer* r);

#endif
