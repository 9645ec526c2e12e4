/* One picture: the passes of a frame, sample by sample, into a film. */
#ifndef RD_RENDER_H
#define RD_RENDER_H

#include "camera.h"
#include "options.h"
#include "progress.h"
#include "scene.h"
#include "stats.h"
#include "trace.h"

/* A sub-frame is the whole image at one sample a pixel. Every pass of the pipeline runs over it by
 * rows; the film sums the sub-frames up. */
typedef struct rd_renderer {
    const rd_options* options;
    const rd_scene* scene;
    const rd_trace* trace;
    rd_stats* stats;
    rd_progress* progress;
    rd_camera camera;
    int width, height, spp;
    rd_hit* hits; /* of the sub-frame, by pixel */
    float* film;  /* RGBA; A is the coverage. Sums, and means once rd_render has returned */
    uint64_t ray_count, layer_hit_count, layers_dropped;
} rd_renderer;

bool rd_renderer_begin(rd_renderer* r, const rd_options* options, const rd_scene* scene,
                       const rd_trace* trace, rd_stats* stats, rd_progress* progress,
                       rd_report* report);
/* Fills the film with the picture that the camera sees. */
void rd_render(rd_renderer* r, const rd_camera* camera);
void rd_renderer_end(rd_renderer* r);

#endif
