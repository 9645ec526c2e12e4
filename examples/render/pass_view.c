/* Pictures of anything but light: quantities of surfaces, and of the GBuffer. */
#include "frame.h"

/* >>surfaces */

/* Front to back: `front` over what comes next. */
static hdrp_v4 under(hdrp_v4 front, hdrp_v4 next)
{
    float k = (1.0f - front.w) * next.w;
    return hdrp_v4_make(front.x + next.x * k, front.y + next.y * k, front.z + next.z * k,
                        front.w + k);
}

static hdrp_v4 material_value(const rd_sub_frame* s, int x, int y, const rd_ray* ray,
                              const rd_hit* hit)
{
    rd_surface surface;
    rd_evaluate(s, x, y, ray, hit, &surface);
    return hdrp_v4_from_v3(rd_view_value(s->r->options->view, &s->r->camera, &surface),
                           surface.alpha);
}

static hdrp_v4 pixel_value(const rd_sub_frame* s, rd_worker* w, int x, int y)
{
    const rd_hit* hit = &s->r->hits[rd_pixel(s, x, y)];
    rd_ray ray = rd_pixel_ray(s, x, y);
    hdrp_v4 sum = hdrp_v4_make(0.0f, 0.0f, 0.0f, 0.0f);
    ray.t_max = hit->t;
    rd_trace_layers(s->r->trace, &ray, &w->layers);
    w->counts.layer_hits += w->layers.count;
    if (s->r->options->view == RD_VIEW_LAYERS) {
        float n = (float)w->layers.count / 16.0f;
        return hdrp_v4_make(n, n, n, hit->mesh != RD_NO_HIT || w->layers.count ? 1.0f : 0.0f);
    }
    for (uint32_t i = 0; i < w->layers.count; ++i) {
        sum = under(sum, material_value(s, x, y, &ray, &w->layers.hits[i]));
    }
    if (hit->mesh != RD_NO_HIT) {
        hdrp_v4 opaque = material_value(s, x, y, &ray, hit);
        opaque.w = 1.0f;
        sum = under(sum, opaque);
    }
    return sum;
}

void rd_material_view_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    float* film = s->r->film + rd_pixel(s, 0, y) * 4;
    for (int x = 0; x < s->r->width; ++x, film += 4) {
        hdrp_v4 v = pixel_value(s, w, x, y);
        film[0] += v.x;
        film[1] += v.y;
        film[2] += v.z;
        film[3] += v.w;
    }
}

/* >>GBuffer */

static hdrp_v3 frame_value(const rd_sub_frame* s, size_t px)
{
    hdrp_pack_gbuffer g = hdrp_pack_gbuffer_targets_from_texel(s->r->gbuffer.texels[px]);
    switch (s->r->options->view) {
    case RD_VIEW_AO:
        return hdrp_v3_splat(s->r->visibility[1][px]);
    case RD_VIEW_PATH:
        return s->r->gbuffer.kinds[px] == RD_PIXEL_FORWARD ? hdrp_v3_make(0.8f, 0.25f, 0.1f)
                                                           : hdrp_v3_make(0.1f, 0.35f, 0.7f);
    case RD_VIEW_RT0:
        return hdrp_v3_from_v4(g.rt0);
    case RD_VIEW_RT1:
        return hdrp_v3_from_v4(g.rt1);
    case RD_VIEW_RT2:
        return hdrp_v3_from_v4(g.rt2);
    case RD_VIEW_RT3:
        return g.rt3;
    default:
        return hdrp_v3_from_v4(g.rt4);
    }
}

void rd_frame_view_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    (void)w;
    for (int x = 0; x < s->r->width; ++x) {
        size_t px = rd_pixel(s, x, y);
        float* film = s->r->film + px * 4;
        if (s->r->gbuffer.kinds[px] != RD_PIXEL_SKY) {
            hdrp_v3 v = frame_value(s, px);
            film[0] += v.x;
            film[1] += v.y;
            film[2] += v.z;
            film[3] += 1.0f;
        }
    }
}
