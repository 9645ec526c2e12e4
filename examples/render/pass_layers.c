/* Transparent surfaces: all that a ray meets in front of the opaque one, each lit by the light loop
 * and composited in order of distance. Glass looks up what is behind it in the opaque picture. */
#include "layers.h"

#include <math.h>

/* Lobes of transmitted light are as wide as those of reflected light: twice the slope of the
 * microfacets, whose root mean square, cut off at the tail, is about 0.7 alpha. */
#define BLUR_PER_ALPHA 1.4f
/* Lookups of a blurred picture, and how much finer than the blur its level then may be. */
#define BLUR_TAPS     8
#define BLUR_LOD_BIAS 1.5f
/* Layers behind which less is left are not looked at. */
#define NOTHING_LEFT 1e-3f

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
static float blur_radius_px(const rd_sub_frame* s, const rd_layer* l, float background_m)
{
    const rd_camera* c = &s->r->camera;
    float alpha = hdrp_sq(l->transmitted_perceptual_roughness);
    float pixel = 2.0f * c->half_height / (float)s->r->height; /* at distance 1 */
    float behind = hdrp_max(1.0f - l->distance_m / background_m, 0.0f);
    return BLUR_PER_ALPHA * alpha * behind / pixel;
}

static void bend(const rd_sub_frame* s, const rd_layer* l, float x, float y, backdrop* b)
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

rd_layers_seen rd_layers_over(const rd_sub_frame* s, const rd_layer* layers, uint32_t count,
                              rd_layer_choice choice, int x, int y)
{
    float background_m = s->r->hits[rd_pixel(s, x, y)].t;
    hdrp_v3 left = hdrp_v3_splat(1.0f);
    float fx = (float)x + s->jitter.x, fy = (float)y + s->jitter.y;
    backdrop b = {fx, fy, 0.0f, HDRP_FLT_MAX, false, {0.0f, 0.0f, 0.0f}, 0.0f};
    rd_layers_seen seen = {{0.0f, 0.0f, 0.0f}, 1.0f};
    for (uint32_t i = 0; i < count && hdrp_v3_max_component(left) > NOTHING_LEFT; ++i) {
        const rd_layer* l = &layers[i];
        if (choice == RD_LAYERS_WITHOUT_BLENDED && rd_oit_is_blended(s->r->options, l->material)) {
            continue;
        }
        seen.color = hdrp_v3_add(seen.color, hdrp_v3_mul(left, l->light));
        left = hdrp_v3_mul(left, l->through);
        seen.uncovered *= 1.0f - l->coverage;
        b.blur_px += hdrp_sq(blur_radius_px(s, l, background_m));
        b.perceptual_roughness =
            hdrp_max(b.perceptual_roughness, l->transmitted_perceptual_roughness);
        if (l->bends) {
            bend(s, l, fx, fy, &b);
        }
    }
    if (hdrp_v3_max_component(left) > NOTHING_LEFT) {
        seen.color = hdrp_v3_add(seen.color, hdrp_v3_mul(left, light_behind(s, &b, x, y)));
    }
    return seen;
}

void rd_layers_resolve(const rd_sub_frame* s, rd_layers_seen seen, int x, int y)
{
    size_t px = rd_pixel(s, x, y);
    float* film = s->r->film + px * 4;
    film[0] += seen.color.x;
    film[1] += seen.color.y;
    film[2] += seen.color.z;
    film[3] += s->r->gbuffer.kinds[px] == RD_PIXEL_SKY ? 1.0f - seen.uncovered : 1.0f;
}

static rd_layer_use light_all(const rd_sub_frame* s, const rd_material* m)
{
    (void)s;
    (void)m;
    return RD_LAYER_LIT;
}

void rd_layers_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    const rd_layer_grid grid = {s->r->width, 1.0f, 1.0f, light_all};
    uint32_t at = 0;
    if (!rd_layers_gather(s, w, &grid, y)) {
        rd_resolve_row(s, w, y);
        return;
    }
    for (int x = 0; x < s->r->width; ++x) {
        uint32_t first = at;
        while (at < w->list->count && w->list->items[at].x == x) {
            ++at;
        }
        rd_layers_resolve(
            s, rd_layers_over(s, w->list->items + first, at - first, RD_LAYERS_ALL, x, y), x, y);
    }
}

/* Where nothing is transparent. */
void rd_resolve_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    (void)w;
    for (int x = 0; x < s->r->width; ++x) {
        rd_layers_resolve(s, rd_layers_over(s, NULL, 0, RD_LAYERS_ALL, x, y), x, y);
    }
}
