#include "layers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void rd_layer_list_free(struct rd_layer_list* l)
{
    if (l) {
        free(l->items);
        free(l);
    }
}

static rd_layer* append(struct rd_layer_list* l)
{
    if (l->count == l->capacity) {
        uint32_t capacity = l->capacity ? l->capacity * 2 : 256;
        rd_layer* grown = (rd_layer*)realloc(l->items, capacity * sizeof *grown);
        if (!grown) {
            ++l->dropped;
            return NULL;
        }
        l->items = grown;
        l->capacity = capacity;
    }
    return &l->items[l->count++];
}

/* >>through volumes */

/* How often light is followed that does not get out of a volume. */
#define MAX_REFLECTIONS 4
/* A far side so many times the thickness away is that of something hollow, as a light bulb is. */
#define HOLLOW 2.0f

/* Through the volume that light enters at p, out of its far side, and on to the first opaque
 * surface. Where no far side is found the thickness of the material tells the way. */
static void follow(const rd_sub_frame* s, const rd_shade_point* p, hdrp_v3 direction, rd_layer* l)
{
    rd_ray ray = {rd_trace_offset(p->position, hdrp_v3_neg(p->geometric_normal)), 0.0f, direction,
                  HDRP_FLT_MAX};
    bool inside = true;
    rd_hit hit;
    for (int i = 0; i < MAX_REFLECTIONS && inside; ++i) {
        rd_surface far_side;
        hdrp_brdf_refraction r;
        rd_trace_closest_any(s->r->trace, &ray, &hit, 1);
        if (hit.mesh == RD_NO_HIT || hit.t > HOLLOW * p->data.volume_thickness_m) {
            break;
        }
        rd_surface_evaluate(s->r->scene, &ray, NULL, &hit, &far_side);
        if (!far_side.back_face) {
            break;
        }
        r = hdrp_brdf_refract(far_side.view, far_side.brdf.normal, p->data.ior);
        inside = r.transmits == 0.0f;
        ray.direction = r.direction;
        ray.origin = rd_trace_offset(
            far_side.position,
            hdrp_v3_scale(far_side.geometric_normal,
                          hdrp_sign_not_zero(hdrp_v3_dot(far_side.geometric_normal, r.direction))));
    }
    l->source_direction = ray.direction;
    l->source = hdrp_v3_mad(p->position, direction, p->data.volume_thickness_m);
    if (!inside) {
        rd_trace_closest(s->r->trace, &ray, &hit, 1);
        l->sees_sky = hit.mesh == RD_NO_HIT;
        l->source = l->sees_sky ? l->source : hdrp_v3_mad(ray.origin, ray.direction, hit.t);
    }
}

/* >>lighting of layers, a batch at a time */

typedef struct batch {
    uint32_t count;
    uint32_t item[RD_RUN]; /* index in the list */
    hdrp_v3 emission[RD_RUN];
    float alpha[RD_RUN];
} batch;

/* What is seen straight through it, or where it bends light to. */
static void finish(const rd_sub_frame* s, rd_layer* l, const rd_shade_point* p,
                   const rd_shaded* shaded)
{
    hdrp_v3 rest = hdrp_v3_splat(1.0f - l->coverage);
    l->through = hdrp_v3_mad(rest, shaded->transmitted_weight, l->coverage);
    /* Coverage lets light through as it is, however rough the surface. */
    l->transmitted_perceptual_roughness = hdrp_v3_max_component(shaded->transmitted_weight) > 0.0f
                                              ? shaded->transmitted_perceptual_roughness
                                              : 0.0f;
    l->bends = p->data.volume_thickness_m > 0.0f;
    l->sees_sky = false;
    if (l->bends && rd_has(s, RD_FEATURE_GLASS_RAYS)) {
        follow(s, p, shaded->transmitted_direction, l);
    } else if (l->bends) {
        l->source_direction = shaded->transmitted_direction;
        l->source = hdrp_v3_mad(p->position, l->source_direction, p->data.volume_thickness_m);
    }
}

static void shade_batch(const rd_sub_frame* s, rd_worker* w, batch* b)
{
    rd_shade(s->r->lighting, rd_layer_lists(s), w->points, b->count, s->index, w->shaded,
             &w->shade);
    for (uint32_t i = 0; i < b->count; ++i) {
        rd_layer* l = &w->list->items[b->item[i]];
        l->light = hdrp_v3_scale(rd_lit_part(s, &w->shaded[i], b->emission[i]), b->alpha[i]);
        finish(s, l, &w->points[i], &w->shaded[i]);
    }
    b->count = 0;
}

/* >>gathering */

/* A sample of a grid: its place in pixels of the picture, and a pixel that it lies in. */
typedef struct place {
    float at_x, at_y;
    int x, y;
} place;

static place place_of(const rd_sub_frame* s, const rd_layer_grid* g, int x, int y)
{
    place p;
    p.at_x = ((float)x + 0.5f) * g->step_x - 0.5f;
    p.at_y = ((float)y + 0.5f) * g->step_y - 0.5f;
    p.x = (int)hdrp_clamp(p.at_x, 0.0f, (float)(s->r->width - 1));
    p.y = (int)hdrp_clamp(p.at_y, 0.0f, (float)(s->r->height - 1));
    return p;
}

static int last_of(float end, int size)
{
    int last = (int)ceilf(end) - 1;
    return last < size ? last : size - 1;
}

/* Where what is opaque begins. A sample of several pixels goes on to the farthest: then soft things
 * stop at no silhouette, and leak over it by less than one sample. */
static float opaque_m(const rd_sub_frame* s, const rd_layer_grid* g, int x, int y)
{
    int first_x = (int)((float)x * g->step_x), first_y = (int)((float)y * g->step_y);
    int last_x = last_of((float)(x + 1) * g->step_x, s->r->width);
    int last_y = last_of((float)(y + 1) * g->step_y, s->r->height);
    float farthest = 0.0f;
    for (int py = first_y; py <= last_y; ++py) {
        for (int px = first_x; px <= last_x; ++px) {
            farthest = hdrp_max(farthest, s->r->hits[rd_pixel(s, px, py)].t);
        }
    }
    return farthest;
}

static void add_point(const rd_sub_frame* s, rd_worker* w, batch* b, const rd_surface* surface,
                      const place* at)
{
    rd_shade_point* p = &w->points[b->count];
    p->data = rd_engine_data(surface, s->r->options->features);
    p->position = surface->position;
    p->geometric_normal = surface->geometric_normal;
    p->view = surface->view;
    p->visibility = 1.0f;
    p->hash = rd_pixel_hash(s, at->x, at->y);
    p->layers = surface->light_layers;
    if (rd_layer_lists(s)) {
        rd_lists_find_cluster(&s->r->lists, at->x, at->y, p);
    }
    b->item[b->count] = w->list->count - 1;
    b->alpha[b->count] = surface->alpha;
    b->emission[b->count] = rd_emission_nits(surface, s->r->exposure);
    if (++b->count == RD_RUN) {
        shade_batch(s, w, b);
    }
}

static void add_surface(const rd_sub_frame* s, rd_worker* w, batch* b, const rd_surface* surface,
                        int x, const place* at, rd_layer_use use)
{
    const rd_camera* c = &s->r->camera;
    rd_layer* l = append(w->list);
    if (!l) {
        return;
    }
    memset(l, 0, sizeof *l);
    l->x = x;
    l->material = surface->material;
    l->coverage = surface->coverage;
    l->distance_m = surface->distance_m;
    l->z_view = hdrp_v3_dot(hdrp_v3_sub(surface->position, c->eye), c->forward);
    l->is_lit = use == RD_LAYER_LIT;
    if (l->is_lit) {
        add_point(s, w, b, surface, at);
    }
}

static bool is_shown(const rd_sub_frame* s, const rd_surface* surface)
{
    const rd_material* m = surface->material;
    return (!surface->back_face || m->double_sided) && surface->alpha > 0.0f &&
           (rd_has(s, RD_FEATURE_ALPHA_BLEND) || m->alpha_mode != RD_ALPHA_BLEND);
}

static const rd_material* material_of(const rd_sub_frame* s, const rd_hit* hit)
{
    const rd_scene* scene = s->r->scene;
    return &scene->materials[scene->meshes[hit->mesh].material];
}

static void add_sample(const rd_sub_frame* s, rd_worker* w, batch* b, const rd_layer_grid* g, int x,
                       int y)
{
    place at = place_of(s, g, x, y);
    rd_ray ray = rd_sample_ray(s, at.at_x, at.at_y);
    rd_ray_spread spread = rd_sample_spread(s, at.at_x, at.at_y, hdrp_max(g->step_x, g->step_y));
    ray.t_max = opaque_m(s, g, x, y);
    rd_trace_layers(s->r->trace, &ray, &w->layers);
    w->counts.layer_hits += w->layers.count;
    for (uint32_t i = 0; i < w->layers.count; ++i) {
        rd_layer_use use = g->use(s, material_of(s, &w->layers.hits[i]));
        rd_surface surface;
        if (use == RD_LAYER_IGNORED) {
            continue;
        }
        rd_surface_evaluate(s->r->scene, &ray, &spread, &w->layers.hits[i], &surface);
        if (is_shown(s, &surface)) {
            add_surface(s, w, b, &surface, x, &at, use);
        }
    }
}

static bool begin_list(rd_worker* w)
{
    if (!w->list) {
        w->list = (struct rd_layer_list*)calloc(1, sizeof *w->list);
    }
    if (w->list) {
        w->list->count = 0;
    }
    return w->list != NULL;
}

bool rd_layers_gather(const rd_sub_frame* s, rd_worker* w, const rd_layer_grid* g, int y)
{
    batch b;
    if (!begin_list(w)) {
        return false;
    }
    b.count = 0;
    for (int x = 0; x < g->width; ++x) {
        add_sample(s, w, &b, g, x, y);
    }
    shade_batch(s, w, &b);
    w->counts.layers_dropped += w->list->dropped;
    w->list->dropped = 0;
    return true;
}
