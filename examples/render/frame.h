/* What the passes of a frame share. */
#ifndef RD_FRAME_H
#define RD_FRAME_H

#include "render.h"

/* Pixels of a row that are treated together. */
#define RD_RUN RD_SHADE_MAX

typedef struct rd_sub_frame {
    rd_renderer* r;
    hdrp_v2 jitter; /* of the sample inside each pixel */
    uint32_t index; /* of the sample */
} rd_sub_frame;

/* What a thread needs for itself. */
typedef struct rd_worker {
    rd_layers layers;
    rd_shade_counts shade;
    rd_render_counts counts;
    rd_shade_point points[RD_RUN];
    rd_shaded shaded[RD_RUN];
    struct rd_layer_list* list; /* of the pass of transparent surfaces */
} rd_worker;

/* A pass works on one row of a sub-frame; rows are independent jobs. */
typedef void (*rd_row_pass)(const rd_sub_frame* s, rd_worker* w, int y);

void rd_material_view_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_gbuffer_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_occlusion_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_occlusion_blur_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_frame_view_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_lists_view_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_deferred_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_forward_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_oit_low_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_oit_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_layers_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_resolve_row(const rd_sub_frame* s, rd_worker* w, int y);
void rd_reference_row(const rd_sub_frame* s, rd_worker* w, int y);

/* The lights of all tiles and clusters, as soon as the visible surfaces are known. */
void rd_lists_build(const rd_sub_frame* s);
/* And the variant of each tile. */
void rd_variants_build(const rd_sub_frame* s);

void rd_layer_list_free(struct rd_layer_list* list);

static inline size_t rd_pixel(const rd_sub_frame* s, int x, int y)
{
    return (size_t)y * (size_t)s->r->width + (size_t)x;
}

static inline uint32_t rd_pixel_hash(const rd_sub_frame* s, int x, int y)
{
    return hdrp_hash3((uint32_t)x, (uint32_t)y, s->r->options->seed);
}

/* x and y in pixels, with fractions where the sample is not one of a pixel. */
static inline rd_ray rd_sample_ray(const rd_sub_frame* s, float x, float y)
{
    return rd_camera_ray(&s->r->camera, x + s->jitter.x, y + s->jitter.y);
}

static inline rd_ray rd_pixel_ray(const rd_sub_frame* s, int x, int y)
{
    return rd_sample_ray(s, (float)x, (float)y);
}

/* The part of an area of so many pixels squared that a sample stands for. */
static inline rd_ray_spread rd_sample_spread(const rd_sub_frame* s, float x, float y, float pixels)
{
    rd_ray_spread r = rd_camera_spread(&s->r->camera, x + s->jitter.x, y + s->jitter.y);
    float k = pixels * hdrp_rsqrt((float)s->r->spp);
    r.origin_dx = hdrp_v3_scale(r.origin_dx, k);
    r.origin_dy = hdrp_v3_scale(r.origin_dy, k);
    r.direction_dx = hdrp_v3_scale(r.direction_dx, k);
    r.direction_dy = hdrp_v3_scale(r.direction_dy, k);
    return r;
}

/* What a ray sees that leaves the scene. */
static inline hdrp_v3 rd_background(const rd_sub_frame* s, const rd_ray* ray)
{
    bool shown = s->r->options->view == RD_VIEW_LIT && s->r->options->features & RD_FEATURE_SKY;
    return shown ? rd_environment_seen(s->r->lighting->environment, ray->direction)
                 : hdrp_v3_splat(0.0f);
}

/* What a view of lighting shows of it. */
static inline hdrp_v3 rd_lit_part(const rd_sub_frame* s, const rd_shaded* shaded, hdrp_v3 emission)
{
    rd_view view = s->r->options->view;
    hdrp_v3 sum = hdrp_v3_add(shaded->diffuse, shaded->specular);
    return view == RD_VIEW_DIFFUSE    ? shaded->diffuse
           : view == RD_VIEW_SPECULAR ? shaded->specular
                                      : hdrp_v3_add(sum, emission);
}

static inline void rd_evaluate(const rd_sub_frame* s, int x, int y, const rd_ray* ray,
                               const rd_hit* hit, rd_surface* out)
{
    rd_ray_spread spread = rd_sample_spread(s, (float)x, (float)y, 1.0f);
    rd_surface_evaluate(s->r->scene, ray, &spread, hit, out);
}

static inline bool rd_has(const rd_sub_frame* s, uint32_t feature)
{
    return (s->r->options->features & feature) != 0;
}

/* What the light loop walks; NULL: it visits all lights. */
static inline const rd_grid* rd_opaque_lists(const rd_sub_frame* s)
{
    const rd_lists* l = &s->r->lists;
    return l->ready && rd_has(s, RD_FEATURE_LISTS) ? &l->tiles : NULL;
}

static inline const rd_grid* rd_layer_lists(const rd_sub_frame* s)
{
    const rd_lists* l = &s->r->lists;
    return l->ready && rd_has(s, RD_FEATURE_LISTS) ? &l->clusters : NULL;
}

#endif
