#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_PER_JOB 8
#define MAX_RUN      64 /* pixels whose rays are traced in one call */

static int default_spp(rd_quality q)
{
    return q == RD_QUALITY_FAST ? 1 : q == RD_QUALITY_BALANCED ? 4 : 64;
}

bool rd_renderer_begin(rd_renderer* r, const rd_options* options, const rd_scene* scene,
                       const rd_trace* trace, rd_stats* stats, rd_progress* progress,
                       rd_report* report)
{
    size_t pixels = (size_t)options->width * (size_t)options->height;
    memset(r, 0, sizeof *r);
    r->options = options;
    r->scene = scene;
    r->trace = trace;
    r->stats = stats;
    r->progress = progress;
    r->width = options->width;
    r->height = options->height;
    r->spp = options->spp ? options->spp : default_spp(options->quality);
    r->hits = (rd_hit*)malloc(pixels * sizeof *r->hits);
    r->film = (float*)malloc(pixels * 4 * sizeof *r->film);
    if (!r->hits || !r->film) {
        rd_renderer_end(r);
        return rd_fail(report, "image", "out of memory");
    }
    return true;
}

void rd_renderer_end(rd_renderer* r)
{
    free(r->hits);
    free(r->film);
    memset(r, 0, sizeof *r);
}

/* >>passes
 * A pass works on one row of a sub-frame; rows are independent jobs. */

typedef struct sub_frame {
    rd_renderer* r;
    hdrp_v2 jitter; /* of the sample inside each pixel */
} sub_frame;

/* What a thread needs for itself. */
typedef struct worker {
    rd_layers layers;
    uint64_t ray_count, layer_hit_count;
} worker;

typedef void (*row_pass)(const sub_frame* s, worker* w, int y);

static rd_ray pixel_ray(const sub_frame* s, int x, int y)
{
    return rd_camera_ray(&s->r->camera, (float)x + s->jitter.x, (float)y + s->jitter.y);
}

static rd_ray_spread pixel_spread(const sub_frame* s, int x, int y)
{
    return rd_camera_spread(&s->r->camera, (float)x + s->jitter.x, (float)y + s->jitter.y);
}

static rd_hit* pixel_hit(const sub_frame* s, int x, int y)
{
    return &s->r->hits[(size_t)y * (size_t)s->r->width + (size_t)x];
}

static void visibility_row(const sub_frame* s, worker* w, int y)
{
    rd_ray rays[MAX_RUN];
    for (int x = 0; x < s->r->width; x += MAX_RUN) {
        int n = s->r->width - x < MAX_RUN ? s->r->width - x : MAX_RUN;
        for (int i = 0; i < n; ++i) {
            rays[i] = pixel_ray(s, x + i, y);
        }
        rd_trace_closest(s->r->trace, rays, pixel_hit(s, x, y), (uint32_t)n);
    }
    w->ray_count += (uint64_t)s->r->width;
}

/* Light from the viewer, without shadows: enough to see what was loaded. */
static hdrp_v3 preview_color(const rd_surface* s)
{
    float facing = hdrp_saturate(hdrp_v3_dot(s->brdf.normal, s->view));
    float sky = 0.5f + 0.5f * s->brdf.normal.y;
    hdrp_v3 c = hdrp_v3_scale(s->brdf.base_color, 0.55f * facing + 0.4f * sky);
    return hdrp_v3_add(c, s->emission_nits);
}

static hdrp_v3 surface_value(const sub_frame* s, const rd_surface* surface)
{
    rd_view view = s->r->options->view;
    return view == RD_VIEW_LIT ? preview_color(surface)
                               : rd_view_value(view, &s->r->camera, surface);
}

static hdrp_v4 evaluate(const sub_frame* s, int x, int y, const rd_ray* ray, const rd_hit* hit)
{
    rd_surface surface;
    rd_ray_spread spread = pixel_spread(s, x, y);
    rd_surface_evaluate(s->r->scene, ray, &spread, hit, &surface);
    return hdrp_v4_from_v3(surface_value(s, &surface), surface.alpha);
}

/* Front to back: `front` over what comes next. */
static hdrp_v4 under(hdrp_v4 front, hdrp_v4 next)
{
    float k = (1.0f - front.w) * next.w;
    return hdrp_v4_make(front.x + next.x * k, front.y + next.y * k, front.z + next.z * k,
                        front.w + k);
}

static hdrp_v4 pixel_value(const sub_frame* s, worker* w, int x, int y)
{
    const rd_hit* hit = pixel_hit(s, x, y);
    rd_ray ray = pixel_ray(s, x, y);
    hdrp_v4 sum = hdrp_v4_make(0.0f, 0.0f, 0.0f, 0.0f);
    ray.t_max = hit->t;
    rd_trace_layers(s->r->trace, &ray, &w->layers);
    w->layer_hit_count += w->layers.count;
    if (s->r->options->view == RD_VIEW_LAYERS) {
        float n = (float)w->layers.count / 16.0f;
        return hdrp_v4_make(n, n, n, hit->mesh != RD_NO_HIT || w->layers.count ? 1.0f : 0.0f);
    }
    for (uint32_t i = 0; i < w->layers.count; ++i) {
        sum = under(sum, evaluate(s, x, y, &ray, &w->layers.hits[i]));
    }
    if (hit->mesh != RD_NO_HIT) {
        hdrp_v4 opaque = evaluate(s, x, y, &ray, hit);
        opaque.w = 1.0f;
        sum = under(sum, opaque);
    }
    return sum;
}

static void view_row(const sub_frame* s, worker* w, int y)
{
    float* film = s->r->film + (size_t)y * (size_t)s->r->width * 4;
    for (int x = 0; x < s->r->width; ++x, film += 4) {
        hdrp_v4 v = pixel_value(s, w, x, y);
        film[0] += v.x;
        film[1] += v.y;
        film[2] += v.z;
        film[3] += v.w;
    }
}

static void run_pass(const sub_frame* s, const char* name, row_pass pass, double* done,
                     double total)
{
    rd_renderer* r = s->r;
    double begin = rd_now_ms();
    int jobs = (r->height + ROWS_PER_JOB - 1) / ROWS_PER_JOB;
    uint64_t rays = 0, layer_hits = 0, dropped = 0;
#pragma omp parallel reduction(+ : rays, layer_hits, dropped)
    {
        worker w;
        memset(&w, 0, sizeof w);
#pragma omp for schedule(dynamic, 1)
        for (int j = 0; j < jobs; ++j) {
            int end = (j + 1) * ROWS_PER_JOB < r->height ? (j + 1) * ROWS_PER_JOB : r->height;
            for (int y = j * ROWS_PER_JOB; y < end; ++y) {
                pass(s, &w, y);
            }
#pragma omp atomic
            *done += 1.0;
            rd_progress_show(r->progress, name, *done, total);
        }
        rays += w.ray_count;
        layer_hits += w.layer_hit_count;
        dropped += w.layers.dropped;
        free(w.layers.hits);
    }
    r->ray_count += rays;
    r->layer_hit_count += layer_hits;
    r->layers_dropped += dropped;
    rd_stats_pass(r->stats, name, rd_now_ms() - begin);
}

static void scale_film(rd_renderer* r)
{
    size_t n = (size_t)r->width * (size_t)r->height * 4;
    float k = 1.0f / (float)r->spp;
    for (size_t i = 0; i < n; ++i) {
        r->film[i] *= k;
    }
}

void rd_render(rd_renderer* r, const rd_camera* camera)
{
    double done = 0.0;
    double total = 2.0 * r->spp * ((r->height + ROWS_PER_JOB - 1) / ROWS_PER_JOB);
    sub_frame s;
    r->camera = *camera;
    s.r = r;
    memset(r->film, 0, (size_t)r->width * (size_t)r->height * 4 * sizeof *r->film);
    for (int i = 0; i < r->spp; ++i) {
        s.jitter = rd_camera_jitter((uint32_t)i, r->options->seed);
        run_pass(&s, "visible surfaces", visibility_row, &done, total);
        run_pass(&s, "view", view_row, &done, total);
    }
    scale_film(r);
    rd_progress_end(r->progress);
}
