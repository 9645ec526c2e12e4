/* Transparent surfaces: all that a ray meets in front of the opaque one, each lit by the light loop
 * and composited in order of distance. Glass looks up what is behind it in the opaque picture. */
#include "frame.h"

#include <math.h>
#include <stdlib.h>

/* Lobes of transmitted light are as wide as those of reflected light: twice the slope of the
 * microfacets, whose root mean square, cut off at the tail, is about 0.7 alpha. */
#define BLUR_PER_ALPHA 1.4f
/* Lookups of a blurred picture, and how much finer than the blur its level then may be. */
#define BLUR_TAPS     8
#define BLUR_LOD_BIAS 1.5f
/* Layers behind which less is left are not looked at. */
#define NOTHING_LEFT 1e-3f

typedef struct layer {
    int x;           /* of the pixel in its row */
    hdrp_v3 light;   /* what it sends towards the viewer [nits] */
    hdrp_v3 through; /* share of the light behind that it lets through */
    float alpha;
    float distance_m;
    float transmitted_perceptual_roughness;
    bool bends; /* a volume: light comes from the place or from the sky in the direction below */
    bool sees_sky;
    hdrp_v3 source_direction, source;
} layer;

struct rd_layer_list {
    layer* items;
    uint32_t count, capacity;
    uint64_t dropped;
};

void rd_layer_list_free(struct rd_layer_list* l)
{
    if (l) {
        free(l->items);
        free(l);
    }
}

static layer* append(struct rd_layer_list* l)
{
    if (l->count == l->capacity) {
        uint32_t capacity = l->capacity ? l->capacity * 2 : 256;
        layer* grown = (layer*)realloc(l->items, capacity * sizeof *grown);
        if (!grown) {
            ++l->dropped;
            return NULL;
        }
        l->items = grown;
        l->capacity = capacity;
    }
    return &l->items[l->count++];
}

/* >>lighting of layers, a batch at a time */

typedef struct batch {
    uint32_t count;
    uint32_t first; /* index in the list of the first that waits for its light */
    hdrp_v3 emission[RD_RUN];
} batch;

/* How often light is followed that does not get out of a volume. */
#define MAX_REFLECTIONS 4
/* A far side so many times the thickness away is that of something hollow, as a light bulb is. */
#define HOLLOW 2.0f

/* Through the volume that light enters at p, out of its far side, and on to the first opaque
 * surface. Where no far side is found the thickness of the material tells the way. */
static void follow(const rd_sub_frame* s, const rd_shade_point* p, hdrp_v3 direction, layer* l)
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

static void finish(const rd_sub_frame* s, layer* l, const rd_shade_point* p,
                   const rd_shaded* shaded, hdrp_v3 light)
{
    hdrp_v3 rest = hdrp_v3_splat(1.0f - l->alpha);
    l->light = hdrp_v3_scale(light, l->alpha);
    l->through = hdrp_v3_mad(rest, shaded->transmitted_weight, l->alpha);
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
        hdrp_v3 light = rd_lit_part(s, &w->shaded[i], b->emission[i]);
        finish(s, &w->list->items[b->first + i], &w->points[i], &w->shaded[i], light);
    }
    b->first += b->count;
    b->count = 0;
}

static void add_surface(const rd_sub_frame* s, rd_worker* w, batch* b, const rd_surface* surface,
                        int x, int y)
{
    layer* l = append(w->list);
    rd_shade_point* p = &w->points[b->count];
    if (!l) {
        return;
    }
    l->x = x;
    l->alpha = surface->alpha;
    l->distance_m = surface->distance_m;
    p->data = rd_engine_data(surface, s->r->options->features);
    p->position = surface->position;
    p->geometric_normal = surface->geometric_normal;
    p->view = surface->view;
    p->visibility = 1.0f;
    p->hash = rd_pixel_hash(s, x, y);
    p->layers = surface->light_layers;
    if (rd_layer_lists(s)) {
        rd_lists_find_cluster(&s->r->lists, x, y, p);
    }
    b->emission[b->count] = rd_emission_nits(surface, s->r->exposure);
    if (++b->count == RD_RUN) {
        shade_batch(s, w, b);
    }
}

static bool is_shown(const rd_sub_frame* s, const rd_surface* surface)
{
    const rd_material* m = surface->material;
    return (!surface->back_face || m->double_sided) && surface->alpha > 0.0f &&
           (rd_has(s, RD_FEATURE_ALPHA_BLEND) || m->alpha_mode != RD_ALPHA_BLEND);
}

static void add_pixel(const rd_sub_frame* s, rd_worker* w, batch* b, int x, int y)
{
    rd_ray ray = rd_pixel_ray(s, x, y);
    ray.t_max = s->r->hits[rd_pixel(s, x, y)].t;
    rd_trace_layers(s->r->trace, &ray, &w->layers);
    w->counts.layer_hits += w->layers.count;
    for (uint32_t i = 0; i < w->layers.count; ++i) {
        rd_surface surface;
        rd_evaluate(s, x, y, &ray, &w->layers.hits[i], &surface);
        if (is_shown(s, &surface)) {
            add_surface(s, w, b, &surface, x, y);
        }
    }
}

/* >>what is behind */

/* Where the light behind a stack of layers comes from. */
typedef struct backdrop {
    float x, y;      /* in pixels */
    float blur_px;   /* square of the radius */
    float nearest_m; /* of the layers that bend light */
    bool sees_sky;
    hdrp_v3 direction; /* of the sky, for that and for what is outside the picture */
    float perceptual_roughness;
} backdrop;

/* Pixels across which a lobe of a layer sees the surface behind it. */
static float blur_radius_px(const rd_sub_frame* s, const layer* l, float background_m)
{
    const rd_camera* c = &s->r->camera;
    float alpha = hdrp_sq(l->transmitted_perceptual_roughness);
    float pixel = 2.0f * c->half_height / (float)s->r->height; /* at distance 1 */
    float behind = hdrp_max(1.0f - l->distance_m / background_m, 0.0f);
    return BLUR_PER_ALPHA * alpha * behind / pixel;
}

static void bend(const rd_sub_frame* s, const layer* l, float x, float y, backdrop* b)
{
    hdrp_v2 at = rd_camera_project(&s->r->camera, l->source);
    b->x += at.x - x;
    b->y += at.y - y;
    b->sees_sky = b->sees_sky || l->sees_sky;
    b->direction = l->source_direction;
    b->nearest_m = hdrp_min(b->nearest_m, l->distance_m);
}

static bool is_outside(const rd_sub_frame* s, const backdrop* b)
{
    return !(b->x >= 0.0f && b->y >= 0.0f && b->x < (float)s->r->width &&
             b->y < (float)s->r->height);
}

/* Something in front of the glass is not seen through it. */
static bool is_in_front(const rd_sub_frame* s, const backdrop* b)
{
    return s->r->hits[rd_pixel(s, (int)b->x, (int)b->y)].t < b->nearest_m;
}

static hdrp_v3 blurred(const rd_sub_frame* s, const backdrop* b, uint32_t hash)
{
    float radius = sqrtf(b->blur_px);
    float lod = log2f(hdrp_max(radius, 1.0f)) - BLUR_LOD_BIAS;
    float turn = hdrp_unit_from_u32(hash) * HDRP_TWO_PI;
    float c = cosf(turn), k = sinf(turn);
    hdrp_v3 sum = hdrp_v3_splat(0.0f);
    if (radius < 0.5f) {
        return rd_pyramid_sample(&s->r->pyramid, b->x, b->y, 0.0f);
    }
    for (uint32_t i = 0; i < BLUR_TAPS; ++i) {
        hdrp_v2 d = hdrp_v2_scale(hdrp_fibonacci_disk(i, BLUR_TAPS), radius);
        float x = b->x + c * d.x - k * d.y, y = b->y + k * d.x + c * d.y;
        sum = hdrp_v3_add(sum, rd_pyramid_sample(&s->r->pyramid, x, y, lod));
    }
    return hdrp_v3_scale(sum, 1.0f / BLUR_TAPS);
}

static hdrp_v3 light_behind(const rd_sub_frame* s, const backdrop* b, int x, int y)
{
    backdrop straight = *b;
    const rd_environment* e = s->r->lighting->environment;
    uint32_t hash = hdrp_hash2(rd_pixel_hash(s, x, y), s->index);
    if (b->sees_sky || is_outside(s, b)) {
        return e->present ? hdrp_env_specular(&e->baked, b->direction, b->perceptual_roughness)
                          : hdrp_v3_splat(0.0f);
    }
    if (b->nearest_m < HDRP_FLT_MAX && is_in_front(s, b)) {
        straight.x = (float)x + s->jitter.x;
        straight.y = (float)y + s->jitter.y;
    }
    if (straight.blur_px <= 0.0f && b->nearest_m == HDRP_FLT_MAX) {
        return s->r->lit[rd_pixel(s, x, y)];
    }
    return blurred(s, &straight, hash);
}

/* >>compositing, front to back */

static void composite(const rd_sub_frame* s, const layer* layers, uint32_t count, int x, int y)
{
    size_t px = rd_pixel(s, x, y);
    float* film = s->r->film + px * 4;
    float background_m = s->r->hits[px].t, left_uncovered = 1.0f;
    hdrp_v3 sum = hdrp_v3_splat(0.0f), left = hdrp_v3_splat(1.0f);
    float fx = (float)x + s->jitter.x, fy = (float)y + s->jitter.y;
    backdrop b = {fx, fy, 0.0f, HDRP_FLT_MAX, false, {0.0f, 0.0f, 0.0f}, 0.0f};
    for (uint32_t i = 0; i < count && hdrp_v3_max_component(left) > NOTHING_LEFT; ++i) {
        const layer* l = &layers[i];
        sum = hdrp_v3_add(sum, hdrp_v3_mul(left, l->light));
        left = hdrp_v3_mul(left, l->through);
        left_uncovered *= 1.0f - l->alpha;
        b.blur_px += hdrp_sq(blur_radius_px(s, l, background_m));
        b.perceptual_roughness =
            hdrp_max(b.perceptual_roughness, l->transmitted_perceptual_roughness);
        if (l->bends) {
            bend(s, l, fx, fy, &b);
        }
    }
    if (hdrp_v3_max_component(left) > NOTHING_LEFT) {
        sum = hdrp_v3_add(sum, hdrp_v3_mul(left, light_behind(s, &b, x, y)));
    }
    film[0] += sum.x;
    film[1] += sum.y;
    film[2] += sum.z;
    film[3] += s->r->gbuffer.kinds[px] == RD_PIXEL_SKY ? 1.0f - left_uncovered : 1.0f;
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

void rd_layers_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    batch b;
    uint32_t at = 0;
    if (!begin_list(w)) {
        rd_resolve_row(s, w, y);
        return;
    }
    b.count = b.first = 0;
    for (int x = 0; x < s->r->width; ++x) {
        add_pixel(s, w, &b, x, y);
    }
    shade_batch(s, w, &b);
    for (int x = 0; x < s->r->width; ++x) {
        uint32_t first = at;
        while (at < w->list->count && w->list->items[at].x == x) {
            ++at;
        }
        composite(s, w->list->items + first, at - first, x, y);
    }
    w->counts.layers_dropped += w->list->dropped;
    w->list->dropped = 0;
}

/* Where nothing is transparent. */
void rd_resolve_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    (void)w;
    for (int x = 0; x < s->r->width; ++x) {
        composite(s, NULL, 0, x, y);
    }
}
