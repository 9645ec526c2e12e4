#include "render.h"

#include "frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_PER_JOB 8

static int default_spp(rd_quality q)
{
    return q == RD_QUALITY_FAST ? 1 : q == RD_QUALITY_BALANCED ? 4 : 64;
}

/* >>memory */

static void* allocate(size_t pixels, size_t size)
{
    return malloc((pixels ? pixels : 1) * size);
}

static bool allocate_frame(rd_renderer* r, size_t pixels)
{
    r->visibility[0] = (float*)allocate(pixels, sizeof(float));
    r->visibility[1] = (float*)allocate(pixels, sizeof(float));
    r->lit = (hdrp_v3*)allocate(pixels, sizeof(hdrp_v3));
    return r->visibility[0] && r->visibility[1] && r->lit &&
           rd_gbuffer_allocate(&r->gbuffer, pixels) &&
           rd_pyramid_begin(&r->pyramid, r->lit, r->width, r->height);
}

static bool begin_oit(rd_renderer* r)
{
    const rd_options* o = r->options;
    const rd_oit_desc d = {o->oit, r->width, r->height, r->exposure, rd_oit_has_low(o, r->scene)};
    return o->oit == RD_OIT_SORTED || o->backend != RD_BACKEND_CPU || rd_oit_begin(&r->oit, &d);
}

static float size_of(const rd_scene* scene)
{
    hdrp_v3 d = hdrp_v3_sub(scene->bounds.high, scene->bounds.low);
    return scene->bounds.low.x <= scene->bounds.high.x ? hdrp_v3_length(d) : 0.0f;
}

bool rd_renderer_begin(rd_renderer* r, const rd_renderer_desc* d, rd_report* report)
{
    const rd_options* o = d->options;
    size_t pixels = (size_t)o->width * (size_t)o->height;
    memset(r, 0, sizeof *r);
    r->options = o;
    r->lighting = d->lighting;
    r->scene = d->lighting->scene;
    r->trace = d->lighting->trace;
    r->stats = d->stats;
    r->progress = d->progress;
    r->exposure = d->exposure;
    r->width = o->width;
    r->height = o->height;
    r->spp = o->spp ? o->spp : default_spp(o->quality);
    r->hits = (rd_hit*)allocate(pixels, sizeof *r->hits);
    r->film = (float*)allocate(pixels, 4 * sizeof *r->film);
    if (!r->hits || !r->film || !allocate_frame(r, pixels) || !begin_oit(r) ||
        !rd_lists_begin(&r->lists, &r->lighting->lights, (o->features & RD_FEATURE_BLOCKERS) != 0,
                        r->width, r->height, size_of(r->scene))) {
        rd_renderer_end(r);
        return rd_fail(report, "image", "out of memory");
    }
    return true;
}

void rd_renderer_end(rd_renderer* r)
{
    rd_pyramid_end(&r->pyramid);
    rd_gbuffer_free(&r->gbuffer);
    rd_lists_end(&r->lists);
    rd_variants_end(&r->variants);
    rd_oit_end(&r->oit);
    free(r->visibility[0]);
    free(r->visibility[1]);
    free(r->lit);
    free(r->hits);
    free(r->film);
    memset(r, 0, sizeof *r);
}

/* >>passes */

static void visibility_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    rd_ray rays[RD_RUN];
    for (int x = 0; x < s->r->width; x += RD_RUN) {
        int n = s->r->width - x < RD_RUN ? s->r->width - x : RD_RUN;
        for (int i = 0; i < n; ++i) {
            rays[i] = rd_pixel_ray(s, x + i, y);
        }
        rd_trace_closest(s->r->trace, rays, &s->r->hits[rd_pixel(s, x, y)], (uint32_t)n);
    }
    w->counts.primary_rays += (uint64_t)s->r->width;
}

static void add_counts(rd_render_counts* sum, const rd_worker* w)
{
    sum->primary_rays += w->counts.primary_rays;
    sum->shadow_rays += w->counts.shadow_rays + w->shade.shadow_rays;
    for (int i = 0; i < RD_SHADE_VARIANTS; ++i) {
        sum->shade.samples[i] += w->shade.samples[i];
        sum->shade.timed_samples[i] += w->shade.timed_samples[i];
        sum->shade.timed_ms[i] += w->shade.timed_ms[i];
    }
    for (int i = 0; i < 2; ++i) {
        sum->shade.visited[i] += w->shade.visited[i];
        sum->shade.in_range[i] += w->shade.in_range[i];
    }
    sum->occlusion_rays += w->counts.occlusion_rays;
    sum->path_rays += w->counts.path_rays;
    sum->deferred_samples += w->counts.deferred_samples;
    sum->forward_samples += w->counts.forward_samples;
    sum->layer_hits += w->counts.layer_hits;
    sum->layers_dropped += w->counts.layers_dropped + w->layers.dropped;
}

/* What rd_render has yet to do, for the progress bar. */
typedef struct schedule {
    double done, total; /* jobs */
} schedule;

static int jobs_of(int rows)
{
    return (rows + ROWS_PER_JOB - 1) / ROWS_PER_JOB;
}

/* Without memory for a worker its rows stay as they were; the caller's checks come first. */
static void run_rows(const rd_sub_frame* s, const char* name, rd_row_pass pass, int rows,
                     schedule* t)
{
    rd_renderer* r = s->r;
    double begin = rd_now_ms();
    int jobs = jobs_of(rows);
#pragma omp parallel
    {
        rd_worker* w = (rd_worker*)calloc(1, sizeof *w);
#pragma omp for schedule(dynamic, 1)
        for (int j = 0; j < jobs; ++j) {
            int end = (j + 1) * ROWS_PER_JOB < rows ? (j + 1) * ROWS_PER_JOB : rows;
            for (int y = j * ROWS_PER_JOB; w && y < end; ++y) {
                pass(s, w, y);
            }
#pragma omp atomic
            t->done += 1.0;
            rd_progress_show(r->progress, name, t->done, t->total);
        }
        if (w) {
#pragma omp critical(rd_counts)
            add_counts(&r->counts, w);
            rd_layer_list_free(w->list);
            free(w->layers.hits);
            free(w);
        }
    }
    if (r->stats) {
        rd_stats_pass(r->stats, name, rd_now_ms() - begin);
    }
}

static void run_pass(const rd_sub_frame* s, const char* name, rd_row_pass pass, schedule* t)
{
    run_rows(s, name, pass, s->r->height, t);
}

static void clear_visibility(rd_renderer* r)
{
    size_t pixels = (size_t)r->width * (size_t)r->height;
    for (size_t i = 0; i < pixels; ++i) {
        r->visibility[1][i] = 1.0f;
    }
}

static void occlusion(const rd_sub_frame* s, schedule* t)
{
    const rd_options* o = s->r->options;
    if (o->quality == RD_QUALITY_FAST || !(o->features & RD_FEATURE_AO)) {
        clear_visibility(s->r);
        return;
    }
    run_pass(s, "ambient occlusion", rd_occlusion_row, t);
    run_pass(s, "blur of occlusion", rd_occlusion_blur_row, t);
}

static void transparent(const rd_sub_frame* s, schedule* t)
{
    rd_renderer* r = s->r;
    double begin = rd_now_ms();
    if (!rd_trace_has_layers(r->trace)) {
        run_pass(s, "resolve", rd_resolve_row, t);
        return;
    }
    rd_pyramid_build(&r->pyramid);
    if (r->stats) {
        rd_stats_pass(r->stats, "pyramid", rd_now_ms() - begin);
    }
    if (r->oit.has_low) {
        run_rows(s, "half resolution", rd_oit_low_row, (int)r->oit.low.desc.height_px, t);
    }
    run_pass(s, "transparent surfaces", r->oit.present ? rd_oit_row : rd_layers_row, t);
}

static void lists(const rd_sub_frame* s, rd_view_stage stage)
{
    const rd_options* o = s->r->options;
    if (stage != RD_STAGE_GBUFFER && rd_has(s, RD_FEATURE_LIGHTS) &&
        (stage == RD_STAGE_LISTS || rd_has(s, RD_FEATURE_LISTS))) {
        rd_lists_build(s);
    }
    if (o->view == RD_VIEW_VARIANTS || (o->stats && s->r->stats)) {
        rd_variants_build(s);
    }
}

/* The order of the talk: prepass and GBuffer, what lighting needs of it, deferred lighting, forward
 * opaque, then everything transparent. */
static void real_time(const rd_sub_frame* s, schedule* t)
{
    rd_view_stage stage = rd_view_stage_of(s->r->options->view);
    run_pass(s, "visible surfaces", visibility_row, t);
    if (stage == RD_STAGE_MATERIAL) {
        run_pass(s, "view", rd_material_view_row, t);
        return;
    }
    run_pass(s, "GBuffer", rd_gbuffer_row, t);
    lists(s, stage);
    if (stage == RD_STAGE_LISTS) {
        run_pass(s, "view", rd_lists_view_row, t);
        return;
    }
    occlusion(s, t);
    if (stage == RD_STAGE_GBUFFER) {
        run_pass(s, "view", rd_frame_view_row, t);
        return;
    }
    run_pass(s, "deferred lighting", rd_deferred_row, t);
    run_pass(s, "forward opaque and sky", rd_forward_row, t);
    transparent(s, t);
}

static int passes(const rd_renderer* r)
{
    bool occlusion_on =
        r->options->quality != RD_QUALITY_FAST && r->options->features & RD_FEATURE_AO;
    switch (rd_view_stage_of(r->options->view)) {
    case RD_STAGE_MATERIAL:
        return 2;
    case RD_STAGE_LISTS:
        return 3;
    case RD_STAGE_GBUFFER:
        return 3 + 2 * occlusion_on;
    default:
        return r->options->quality == RD_QUALITY_REFERENCE ? 1 : 5 + 2 * occlusion_on;
    }
}

static bool is_path_traced(const rd_renderer* r)
{
    return r->options->quality == RD_QUALITY_REFERENCE &&
           rd_view_stage_of(r->options->view) == RD_STAGE_LIGHTING;
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
    int low_jobs = r->oit.has_low ? jobs_of((int)r->oit.low.desc.height_px) : 0;
    schedule t = {0.0, (double)r->spp * (passes(r) * jobs_of(r->height) + low_jobs)};
    rd_sub_frame s;
    r->camera = *camera;
    s.r = r;
    memset(r->film, 0, (size_t)r->width * (size_t)r->height * 4 * sizeof *r->film);
    for (int i = 0; i < r->spp; ++i) {
        s.index = (uint32_t)i;
        s.jitter = rd_camera_jitter(s.index, r->options->seed);
        if (is_path_traced(r)) {
            run_pass(&s, "path tracing", rd_reference_row, &t);
        } else {
            real_time(&s, &t);
        }
    }
    scale_film(r);
    rd_progress_end(r->progress);
}
