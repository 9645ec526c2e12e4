/* Ambient occlusion by short rays, in the place that screen-space ambient occlusion has: from the
 * normal buffer, before lighting. Each pixel of a tile of 4 by 4 sends one ray of a set of 16; a
 * blur over two tiles then weighs all of them alike everywhere, so that no noise is left. */
#include "frame.h"

#include <math.h>

#define TILE 4
/* Length of the rays, of the diagonal of the scene. */
#define REACH 0.03f
/* Neighbours count while their planes are within this share of the distance to the camera. */
#define PLANE_TOLERANCE 0.01f

static float reach(const rd_sub_frame* s)
{
    const rd_bounds* b = &s->r->scene->bounds;
    return REACH * hdrp_v3_length(hdrp_v3_sub(b->high, b->low));
}

static hdrp_v3 normal_of(const rd_sub_frame* s, int x, int y)
{
    return rd_gbuffer_decode_normal(s->r->gbuffer.texels[rd_pixel(s, x, y)]);
}

/* Rays of random lengths: what is near shades more, as if it faded out with distance. */
static rd_ray occlusion_ray(const rd_sub_frame* s, int x, int y, float longest)
{
    uint32_t place = (uint32_t)((y & (TILE - 1)) * TILE + (x & (TILE - 1)));
    uint32_t i = s->index * TILE * TILE + place;
    hdrp_v3 d = hdrp_hemisphere_cosine(hdrp_r2(i));
    hdrp_v3 n = normal_of(s, x, y);
    hdrp_basis b = hdrp_basis_from_normal(n);
    hdrp_v3 flat = s->r->gbuffer.geometric_normals[rd_pixel(s, x, y)];
    float above;
    rd_ray ray;
    ray.direction = hdrp_v3_normalize(
        hdrp_v3_mad(hdrp_v3_mad(hdrp_v3_scale(b.tangent, d.x), b.bitangent, d.y), n, d.z));
    /* A smooth surface does not hide itself behind the triangle that stands for it. */
    above = hdrp_v3_dot(ray.direction, flat);
    ray.direction = hdrp_v3_mad(ray.direction, flat, hdrp_abs(above) - above);
    ray.origin = rd_trace_offset(s->r->gbuffer.positions[rd_pixel(s, x, y)], flat);
    ray.t_min = 0.0f;
    ray.t_max = longest * hdrp_unit_from_u32(hdrp_reverse_bits(i) ^ 0x9e3779b9u);
    return ray;
}

static void trace_run(const rd_sub_frame* s, rd_worker* w, int x0, int x1, int y)
{
    rd_ray rays[RD_RUN];
    size_t pixel[RD_RUN];
    bool hidden[RD_RUN];
    uint32_t n = 0;
    float longest = reach(s);
    for (int x = x0; x < x1; ++x) {
        size_t px = rd_pixel(s, x, y);
        s->r->visibility[0][px] = 1.0f;
        if (s->r->gbuffer.kinds[px] != RD_PIXEL_SKY) {
            rays[n] = occlusion_ray(s, x, y, longest);
            pixel[n++] = px;
        }
    }
    if (n > 0) {
        rd_trace_hidden(s->r->trace, rays, hidden, n);
    }
    for (uint32_t i = 0; i < n; ++i) {
        s->r->visibility[0][pixel[i]] = hidden[i] ? 0.0f : 1.0f;
    }
    w->counts.occlusion_rays += n;
}

void rd_occlusion_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    for (int x = 0; x < s->r->width; x += RD_RUN) {
        trace_run(s, w, x, x + RD_RUN < s->r->width ? x + RD_RUN : s->r->width, y);
    }
}

/* >>blur */

/* The plane that a neighbour has to be near to. */
typedef struct plane {
    hdrp_v3 point, normal;
    float tolerance;
} plane;

static float weight(const rd_sub_frame* s, const plane* p, int x, int y)
{
    size_t px = rd_pixel(s, x, y);
    float off, facing;
    if (s->r->gbuffer.kinds[px] == RD_PIXEL_SKY) {
        return 0.0f;
    }
    off = hdrp_abs(hdrp_v3_dot(hdrp_v3_sub(s->r->gbuffer.positions[px], p->point), p->normal));
    facing = hdrp_v3_dot(s->r->gbuffer.geometric_normals[px], p->normal);
    return off < p->tolerance && facing > 0.8f ? 1.0f : 0.0f;
}

/* Every ray of the set stands in the window once or twice; the weights of each add up to TILE. */
static float tent(int distance)
{
    return (float)(TILE - (distance < 0 ? -distance : distance));
}

static float blurred(const rd_sub_frame* s, int x, int y)
{
    size_t px = rd_pixel(s, x, y);
    float sum = 0.0f, weights = 0.0f;
    plane p;
    p.point = s->r->gbuffer.positions[px];
    p.normal = s->r->gbuffer.geometric_normals[px];
    p.tolerance = PLANE_TOLERANCE * s->r->hits[px].t;
    for (int j = y - TILE + 1; j < y + TILE; ++j) {
        for (int i = x - TILE + 1; i < x + TILE; ++i) {
            if (i >= 0 && j >= 0 && i < s->r->width && j < s->r->height) {
                float k = weight(s, &p, i, j) * tent(i - x) * tent(j - y);
                sum += k * s->r->visibility[0][rd_pixel(s, i, j)];
                weights += k;
            }
        }
    }
    return weights > 0.0f ? sum / weights : 1.0f;
}

void rd_occlusion_blur_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    (void)w;
    for (int x = 0; x < s->r->width; ++x) {
        size_t px = rd_pixel(s, x, y);
        s->r->visibility[1][px] = s->r->gbuffer.kinds[px] == RD_PIXEL_SKY ? 1.0f : blurred(s, x, y);
    }
}
