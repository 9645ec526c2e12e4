/* Opaque surfaces: the GBuffer, deferred lighting, and forward lighting of what it cannot hold. */
#include "frame.h"

/* >>GBuffer */

/* A forward prepass writes the normal buffer for the passes that come before lighting. */
static void store(const rd_sub_frame* s, rd_worker* w, size_t px, const rd_surface* surface)
{
    rd_renderer* r = s->r;
    hdrp_brdf_data data = rd_engine_data(surface, r->options->features);
    bool deferred = r->options->path == RD_PATH_DEFERRED && !surface->material->unlit &&
                    hdrp_pack_gbuffer_supports(data);
    r->gbuffer.positions[px] = surface->position;
    r->gbuffer.geometric_normals[px] = surface->geometric_normal;
    if (deferred) {
        r->gbuffer.kinds[px] = RD_PIXEL_DEFERRED;
        r->gbuffer.texels[px] =
            rd_gbuffer_encode(data, surface->emission_nits, surface->light_layers, r->exposure);
        ++w->counts.deferred_samples;
    } else {
        r->gbuffer.kinds[px] = RD_PIXEL_FORWARD;
        r->gbuffer.texels[px] = rd_gbuffer_encode_normal(data);
        ++w->counts.forward_samples;
    }
}

void rd_gbuffer_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    for (int x = 0; x < s->r->width; ++x) {
        size_t px = rd_pixel(s, x, y);
        rd_ray ray = rd_pixel_ray(s, x, y);
        rd_surface surface;
        if (s->r->hits[px].mesh == RD_NO_HIT) {
            s->r->gbuffer.kinds[px] = RD_PIXEL_SKY;
            continue;
        }
        rd_evaluate(s, x, y, &ray, &s->r->hits[px], &surface);
        store(s, w, px, &surface);
    }
}

/* >>lighting */

/* Pixels of a run that one pass shades, and what they emit. */
typedef struct batch {
    uint32_t count;
    size_t pixel[RD_RUN];
    hdrp_v3 emission[RD_RUN];
} batch;

static void set_place(const rd_sub_frame* s, rd_shade_point* p, const rd_ray* ray, int x, int y)
{
    size_t px = rd_pixel(s, x, y);
    p->position = s->r->gbuffer.positions[px];
    p->geometric_normal = s->r->gbuffer.geometric_normals[px];
    p->view = hdrp_v3_neg(ray->direction);
    p->visibility = s->r->visibility[1][px];
    p->hash = rd_pixel_hash(s, x, y);
    if (rd_opaque_lists(s)) {
        rd_lists_find_tile(&s->r->lists, x, y, p);
    }
}

static void shade_batch(const rd_sub_frame* s, rd_worker* w, const batch* b)
{
    rd_shade(s->r->lighting, rd_opaque_lists(s), w->points, b->count, s->index, w->shaded,
             &w->shade);
    for (uint32_t i = 0; i < b->count; ++i) {
        s->r->lit[b->pixel[i]] = rd_lit_part(s, &w->shaded[i], b->emission[i]);
    }
}

static void deferred_run(const rd_sub_frame* s, rd_worker* w, int x0, int x1, int y)
{
    const rd_gbuffer* g = &s->r->gbuffer;
    batch b;
    b.count = 0;
    for (int x = x0; x < x1; ++x) {
        size_t px = rd_pixel(s, x, y);
        rd_ray ray = rd_pixel_ray(s, x, y);
        if (g->kinds[px] != RD_PIXEL_DEFERRED) {
            continue;
        }
        w->points[b.count].data = rd_gbuffer_decode(g->texels[px], s->r->scene);
        set_place(s, &w->points[b.count], &ray, x, y);
        w->points[b.count].layers = rd_gbuffer_decode_light_layers(g->texels[px]);
        b.emission[b.count] = rd_gbuffer_decode_emission(g->texels[px], s->r->exposure);
        b.pixel[b.count++] = px;
    }
    shade_batch(s, w, &b);
}

static void forward_run(const rd_sub_frame* s, rd_worker* w, int x0, int x1, int y)
{
    batch b;
    b.count = 0;
    for (int x = x0; x < x1; ++x) {
        size_t px = rd_pixel(s, x, y);
        rd_ray ray = rd_pixel_ray(s, x, y);
        rd_surface surface;
        if (s->r->gbuffer.kinds[px] == RD_PIXEL_SKY) {
            s->r->lit[px] = rd_background(s, &ray);
        }
        if (s->r->gbuffer.kinds[px] != RD_PIXEL_FORWARD) {
            continue;
        }
        rd_evaluate(s, x, y, &ray, &s->r->hits[px], &surface);
        w->points[b.count].data = rd_engine_data(&surface, s->r->options->features);
        set_place(s, &w->points[b.count], &ray, x, y);
        w->points[b.count].layers = surface.light_layers;
        b.emission[b.count] = rd_emission_nits(&surface, s->r->exposure);
        b.pixel[b.count++] = px;
    }
    shade_batch(s, w, &b);
}

typedef void (*run_pass)(const rd_sub_frame* s, rd_worker* w, int x0, int x1, int y);

static void in_runs(const rd_sub_frame* s, rd_worker* w, int y, run_pass f)
{
    for (int x = 0; x < s->r->width; x += RD_RUN) {
        f(s, w, x, x + RD_RUN < s->r->width ? x + RD_RUN : s->r->width, y);
    }
}

void rd_deferred_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    in_runs(s, w, y, deferred_run);
}

void rd_forward_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    in_runs(s, w, y, forward_run);
}
