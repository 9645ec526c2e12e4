#define HDRP_ENV_IMPLEMENTATION
#include "environment.h"

#include "sky.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SKY_WIDTH 512
/* A bright spot is taken for a sun if it holds this share of all light and is this small: a disc of
 * two degrees. Larger lamps stay in the picture, where reflections show their shape. */
#define SUN_SHARE_MIN       0.04f
#define SUN_SOLID_ANGLE_MAX 0.001f
#define ROWS_PER_JOB        32

static bool out_of_memory(rd_report* report)
{
    return rd_fail(report, "sky", "out of memory");
}

/* >>pictures of the sky */

static void view_texels(hdrp_env_image* image, float* texels, int width, int height, bool cube,
                        uint32_t stride)
{
    memset(image, 0, sizeof *image);
    image->texels = texels;
    image->width = (uint32_t)width;
    image->height = (uint32_t)(cube ? width : height);
    image->kind = cube ? HDRP_ENV_CUBE : HDRP_ENV_LATLONG;
    image->texel_stride = stride;
    image->nits_per_unit = 1.0f;
}

static size_t texel_count(const hdrp_env_image* image)
{
    return (size_t)hdrp_env_image_rows(image) * image->width;
}

/* OpenEXR's environment maps hold samples on the edges; all else is taken to hold areas. */
static bool take_file(rd_environment* e, const rd_environment_desc* d, rd_report* report)
{
    rd_image_f32* f = d->file;
    bool cube = f->layout == RD_LAYOUT_CUBE;
    hdrp_env_image samples;
    if (cube && f->height != f->width * 6) {
        return rd_fail(report, d->name, "is no cube: %d x %d", f->width, f->height);
    }
    if (f->layout == RD_LAYOUT_PLAIN || f->width < 2 || f->height < 2) {
        view_texels(&e->seen, f->rgba, f->width, f->height, false, 4);
        e->texels[0] = f->rgba;
        f->rgba = NULL;
        return true;
    }
    view_texels(&samples, f->rgba, f->width, f->height, cube, 4);
    view_texels(&e->seen, NULL, f->width - 1, f->height - 1, cube, 3);
    e->texels[0] = (float*)malloc((size_t)(f->width - 1) * (size_t)f->height * 3 * sizeof(float));
    if (!e->texels[0]) {
        return out_of_memory(report);
    }
    e->seen.texels = e->texels[0];
    hdrp_env_texels_from_openexr(&samples, 0, hdrp_env_image_rows(&e->seen), e->texels[0]);
    return true;
}

/* Rows are jobs of their own; the counts add up. */
static void sanitize(const hdrp_env_image* image, hdrp_env_sanitize_counts* sum)
{
    uint64_t nan = 0, infinite = 0, negative = 0, large = 0;
    int rows = (int)hdrp_env_image_rows(image);
#pragma omp parallel for schedule(static) reduction(+ : nan, infinite, negative, large)
    for (int y = 0; y < rows; y += ROWS_PER_JOB) {
        hdrp_env_sanitize_counts c;
        int n = rows - y < ROWS_PER_JOB ? rows - y : ROWS_PER_JOB;
        hdrp_env_sanitize(image, NULL, (uint32_t)y, (uint32_t)n, &c);
        nan += c.nan_texels;
        infinite += c.infinite_texels;
        negative += c.negative_texels;
        large += c.too_large_texels;
    }
    sum->nan_texels = nan;
    sum->infinite_texels = infinite;
    sum->negative_texels = negative;
    sum->too_large_texels = large;
}

static void clean(rd_environment* e, const char* name, rd_stats* stats, rd_report* report)
{
    hdrp_env_sanitize_counts c;
    sanitize(&e->seen, &c);
    rd_stats_count(stats, "sky_texels_nan", (double)c.nan_texels);
    rd_stats_count(stats, "sky_texels_infinite", (double)c.infinite_texels);
    rd_stats_count(stats, "sky_texels_negative", (double)c.negative_texels);
    rd_stats_count(stats, "sky_texels_too_large", (double)c.too_large_texels);
    if (c.nan_texels + c.infinite_texels + c.negative_texels + c.too_large_texels > 0) {
        rd_warn(report, name,
                "replaced texels: %llu NaN, %llu infinite, %llu negative, %llu too large",
                (unsigned long long)c.nan_texels, (unsigned long long)c.infinite_texels,
                (unsigned long long)c.negative_texels, (unsigned long long)c.too_large_texels);
    }
}

static bool calibrate(rd_environment* e, const rd_environment_desc* d, rd_report* report)
{
    hdrp_env_stats s;
    float k = 1.0f;
    if (hdrp_env_measure(&e->seen, &s) != HDRP_OK) {
        return rd_fail(report, d->name, "cannot be used as a sky");
    }
    if (d->lux > 0.0f && hdrp_env_lux_multiplier(&s, (double)d->lux, &k) != HDRP_OK) {
        return rd_fail(report, d->name, "has no light to be scaled to --env-lux");
    }
    e->seen.nits_per_unit = k;
    e->ground_lux = s.illuminance_lux * (double)k;
    return true;
}

/* >>the sun of a picture becomes a light, so that it can cast a shadow */

static bool is_sun(const hdrp_env_sun* sun)
{
    return sun->share >= SUN_SHARE_MIN && sun->solid_angle_sr <= SUN_SOLID_ANGLE_MAX;
}

static bool copy_texels(rd_environment* e, rd_report* report)
{
    size_t floats = texel_count(&e->seen) * e->seen.texel_stride;
    e->texels[1] = (float*)malloc(floats * sizeof(float));
    if (!e->texels[1]) {
        return out_of_memory(report);
    }
    memcpy(e->texels[1], e->seen.texels, floats * sizeof(float));
    e->light.texels = e->texels[1];
    return true;
}

static bool split_sun(rd_environment* e, rd_report* report)
{
    hdrp_env_sun sun;
    e->light = e->seen;
    if (hdrp_env_find_sun(&e->seen, 0.0f, &sun) != HDRP_OK || !is_sun(&sun)) {
        return true;
    }
    if (!copy_texels(e, report)) {
        return false;
    }
    hdrp_env_remove_sun(&e->light, &sun);
    e->has_sun = true;
    /* A disc of solid angle pi sin^2 of its radius. */
    e->sun = hdrp_light_directional(hdrp_v3_neg(sun.direction), sun.illuminance_lux,
                                    2.0f * asinf(sqrtf(sun.solid_angle_sr * HDRP_INV_PI)));
    return true;
}

/* >>the procedural sky */

static void scale(rd_environment* e, float k)
{
    e->seen.nits_per_unit *= k;
    e->light.nits_per_unit *= k;
    e->ground_lux *= (double)k;
    e->sun.color_inv_range_sq.x *= k;
    e->sun.color_inv_range_sq.y *= k;
    e->sun.color_inv_range_sq.z *= k;
}

static bool make_sky(rd_environment* e, const rd_environment_desc* d, rd_report* report)
{
    rd_sky sky = rd_sky_make(d->sun_elevation_rad, d->sun_azimuth_rad, 1.0f, d->ground_albedo);
    rd_image_f32 image;
    hdrp_env_stats s;
    if (!rd_sky_image(&sky, SKY_WIDTH, SKY_WIDTH / 2, &image)) {
        return out_of_memory(report);
    }
    e->texels[0] = image.rgba;
    view_texels(&e->seen, image.rgba, image.width, image.height, false, 4);
    e->light = e->seen;
    e->sun = hdrp_light_directional(hdrp_v3_neg(sky.sun_direction), sky.sun_lux,
                                    2.0f * sky.sun_radius_rad);
    e->has_sun = e->disc = true;
    hdrp_env_measure(&e->seen, &s);
    e->ground_lux = s.illuminance_lux + (double)hdrp_luminance(sky.sun_lux) *
                                            (double)hdrp_max(sky.sun_direction.y, 0.0f);
    if (d->lux > 0.0f) {
        scale(e, d->lux / (float)e->ground_lux);
    }
    return true;
}

/* >>filtering */

typedef hdrp_result (*step)(hdrp_env* env, uint32_t first, uint32_t count);

static void run_step(hdrp_env* env, step f, uint32_t total, uint32_t job)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (uint32_t i = 0; i < total; i += job) {
        f(env, i, total - i < job ? total - i : job);
    }
}

static void resample(hdrp_env* env, const hdrp_env_image* image)
{
    uint32_t rows = 6 * env->radiance.size, job = env->radiance.size / 4;
#pragma omp parallel for schedule(dynamic, 1)
    for (uint32_t i = 0; i < rows; i += job) {
        hdrp_env_resample(env, image, i, job);
    }
}

static void* allocate_block(rd_environment* e, int which, size_t bytes)
{
    e->memory[which] = bytes ? malloc(bytes) : NULL;
    return e->memory[which];
}

static bool bake(rd_environment* e, const rd_environment_desc* d, rd_report* report)
{
    hdrp_env_desc desc;
    size_t bytes;
    memset(&desc, 0, sizeof desc);
    if (d->quality != RD_QUALITY_BALANCED) { /* a reference only meters its exposure with it */
        desc.radiance_size = 128;
        desc.specular_size = 64;
    }
    bytes = hdrp_env_memory_size(&desc);
    if (hdrp_env_init(&e->baked, &desc, allocate_block(e, 0, bytes), bytes) != HDRP_OK) {
        return out_of_memory(report);
    }
    resample(&e->baked, &e->light);
    run_step(&e->baked, hdrp_env_reduce, 6, 1);
    run_step(&e->baked, hdrp_env_prefilter, hdrp_env_specular_rows(&e->baked), 8);
    run_step(&e->baked, hdrp_env_convolve_irradiance, 6 * e->baked.irradiance.size, 4);
    hdrp_env_project_sh(&e->baked, &e->sh);
    return true;
}

static bool build_sampler(rd_environment* e, rd_report* report)
{
    size_t bytes = hdrp_env_sampler_memory_size(&e->light);
    if (hdrp_env_sampler_init(&e->sampler, &e->light, allocate_block(e, 1, bytes), bytes) !=
        HDRP_OK) {
        return out_of_memory(report);
    }
    hdrp_env_sampler_build(&e->sampler, 0, hdrp_env_image_rows(&e->light));
    /* A black sky cannot be sampled, and need not be. */
    e->present = hdrp_env_sampler_finish(&e->sampler) == HDRP_OK;
    return true;
}

bool rd_environment_make(rd_environment* e, const rd_environment_desc* d, rd_stats* stats,
                         rd_report* report)
{
    double begin = rd_now_ms();
    memset(e, 0, sizeof *e);
    if (d->file) {
        if (!take_file(e, d, report)) {
            return false;
        }
        clean(e, d->name, stats, report);
        if (!calibrate(e, d, report) || !split_sun(e, report)) {
            return false;
        }
    } else if (!make_sky(e, d, report)) {
        return false;
    }
    e->present = true;
    rd_stats_count(stats, "sky_ground_lux", e->ground_lux);
    rd_stats_count(stats, "sky_sun_lux",
                   e->has_sun ? (double)hdrp_luminance(hdrp_v3_from_v4(e->sun.color_inv_range_sq))
                              : 0.0);
    rd_stats_pass(stats, "make sky", rd_now_ms() - begin);
    begin = rd_now_ms();
    if (!bake(e, d, report) || (d->quality == RD_QUALITY_REFERENCE && !build_sampler(e, report))) {
        return false;
    }
    rd_stats_pass(stats, "bake sky", rd_now_ms() - begin);
    return true;
}

void rd_environment_free(rd_environment* e)
{
    for (int i = 0; i < 2; ++i) {
        free(e->texels[i]);
        free(e->memory[i]);
    }
    memset(e, 0, sizeof *e);
}

hdrp_v3 rd_environment_seen(const rd_environment* e, hdrp_v3 direction)
{
    hdrp_v3 nits = hdrp_v3_splat(0.0f);
    if (!e->present) {
        return nits;
    }
    nits = hdrp_env_image_radiance(&e->seen, direction);
    if (e->disc) {
        hdrp_v3 to_sun = hdrp_v3_neg(hdrp_v3_from_v4(e->sun.forward_radius));
        float diameter = e->sun.forward_radius.w;
        hdrp_v3 off = hdrp_v3_cross(direction, to_sun);
        if (hdrp_v3_dot(direction, to_sun) > 0.0f &&
            hdrp_v3_dot(off, off) < hdrp_sq(sinf(0.5f * diameter))) {
            hdrp_v3 lux = hdrp_v3_from_v4(e->sun.color_inv_range_sq);
            float per_lux = hdrp_light_nits_from_lux_sky_disc(1.0f, diameter);
            nits = hdrp_v3_mad(nits, lux, per_lux);
        }
    }
    return nits;
}
