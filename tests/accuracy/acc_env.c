/* acc_env.c - accuracy of hdrp_env.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include <stdlib.h>
#include <string.h>

#define HDRP_ENV_IMPLEMENTATION
#include "env_brute_force.h"

#define PI 3.14159265358979323846

static void lod_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        double r = (double)acc_float(i < 1000 ? i / 999.0 : acc_uniform(a, 0.0, 1.0));
        hdrp_u32 levels = 1u + (hdrp_u32)(i % 32);
        double last = (double)levels - 1.0, b = 1.0 + (double)HDRP_ENV_LOD_CURVE;
        double reference = last * (b * r - (double)HDRP_ENV_LOD_CURVE * r * r);
        ACC_ADD(
            a, acc_ulp((double)hdrp_env_lod_from_perceptual_roughness((float)r, levels), reference),
            "roughness %.9g of %u levels", r, levels);
    }
}

/* The root of the quadratic by bisection. */
static void perceptual_roughness_error(acc* a)
{
    for (int i = 0; i < 20000; ++i) {
        hdrp_u32 levels = 2u + (hdrp_u32)(i % 31);
        float lod = acc_float(acc_uniform(a, 0.0, (double)levels - 1.0));
        lod = i < 31 ? (float)levels - 1.0f : lod;
        double lo = 0.0, hi = 1.0, t = (double)lod / ((double)levels - 1.0);
        for (int k = 0; k < 80; ++k) {
            double r = 0.5 * (lo + hi);
            *(r * (1.0 + (double)HDRP_ENV_LOD_CURVE * (1.0 - r)) < t ? &lo : &hi) = r;
        }
        double measured = (double)hdrp_env_perceptual_roughness_from_lod(lod, levels);
        ACC_ADD(a, acc_relative(measured, 0.5 * (lo + hi)), "lod %.9g of %u levels", (double)lod,
                levels);
    }
}

static void sh_windowed_error(acc* a)
{
    for (int i = 0; i < 10000; ++i) {
        hdrp_env_sh sh;
        float* c = &sh.mean.x;
        memset(&sh, 0, sizeof sh);
        for (int k = 0; k < 36; ++k) {
            c[k] = acc_float(acc_uniform(a, -1.0, 1.0));
        }
        double lambda = (double)acc_float(acc_log_uniform(a, 1e-6, 1e6));
        hdrp_env_sh r = hdrp_env_sh_windowed(sh, (float)lambda);
        for (int k = 0; k < 36; ++k) {
            int l = k < 4 ? 0 : (k < 16 ? 1 : 2);
            double reference = (double)c[k] / (1.0 + lambda * pow(l * (l + 1.0), 2.0));
            ACC_ADD(a, acc_relative((double)(&r.mean.x)[k], reference), "%d lambda %.9g", k,
                    lambda);
        }
    }
}

/* ---- skies ----------------------------------------------------------------------------------- */

typedef enum sky_kind { SKY_LINEAR, SKY_BROAD, SKY_LAMPS, SKY_SUN } sky_kind;

static const double linear_axis[3] = {0.36, 0.48, -0.8};

/* Fills an image: radiance linear in direction; a few broad lobes; the same with lamps of a texel
 * or a few, thousands of times brighter; or a single texel. */
static void fill_sky(acc* a, const hdrp_env_image* image, sky_kind kind)
{
    double axis[6][3], power[6];
    uint32_t count = image->width * hdrp_env_image_rows(image);
    for (int i = 0; i < 6; ++i) {
        acc_direction(a, axis[i]);
        power[i] = acc_uniform(a, 1.0, 12.0);
    }
    for (uint32_t k = 0; k < count; ++k) {
        hdrp_env_place place = {k / image->width / image->height, 0.0f, 0.0f};
        place.u = (acc_float(k % image->width) + 0.5f) / (float)image->width;
        place.v = (acc_float(k / image->width % image->height) + 0.5f) / (float)image->height;
        hdrp_v3 d = image->kind == HDRP_ENV_CUBE
                        ? hdrp_env_direction_from_cube(place)
                        : hdrp_env_direction_from_latlong(hdrp_v2_make(place.u, place.v));
        double v[3] = {(double)d.x, (double)d.y, (double)d.z}, c[3] = {0.02, 0.02, 0.02};
        for (int i = 0; i < 6; ++i) {
            double cosine = v[0] * axis[i][0] + v[1] * axis[i][1] + v[2] * axis[i][2];
            double lobe = pow(acc_larger(cosine, 0.0), power[i]);
            c[i % 3] += lobe;
            c[(i + 1) % 3] += 0.5 * lobe;
        }
        for (int i = 0; i < 3; ++i) {
            double linear =
                1.0 + 0.9 * (v[0] * linear_axis[0] + v[1] * linear_axis[1] + v[2] * linear_axis[2]);
            image->texels[3u * k + (uint32_t)i] =
                acc_float(kind == SKY_LINEAR ? linear : (kind == SKY_SUN ? 0.0 : c[i]));
        }
    }
    for (int i = 0; i < (kind == SKY_LAMPS ? 8 : (kind == SKY_SUN ? 1 : 0)); ++i) {
        uint32_t k = (uint32_t)(acc_random_bits(a) % (count - 2u));
        for (uint32_t c = 0; c < 3u * (1u + (uint32_t)i % 2u); ++c) {
            image->texels[3u * k + c] = acc_float(acc_log_uniform(a, 1e2, 1e4));
        }
    }
}

typedef struct sky {
    hdrp_env env;
    hdrp_env_image image;
    void* memory;
} sky;

/* A cube of size texels with a sky, taken over as it is by the environment. */
static sky make_sky(acc* a, sky_kind kind, uint32_t size, uint32_t specular_size, float opening)
{
    sky s;
    hdrp_env_desc desc = {0};
    memset(&s, 0, sizeof s);
    desc.radiance_size = size;
    desc.specular_size = specular_size;
    desc.opening = opening;
    s.image.width = s.image.height = size;
    s.image.kind = HDRP_ENV_CUBE;
    s.image.texels = malloc(sizeof(float) * 18u * size * size);
    s.memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, hdrp_env_memory_size(&desc));
    if (!s.image.texels || !s.memory ||
        hdrp_env_init(&s.env, &desc, s.memory, hdrp_env_memory_size(&desc)) != HDRP_OK) {
        abort();
    }
    fill_sky(a, &s.image, kind);
    hdrp_env_resample(&s.env, &s.image, 0u, 6u * size);
    hdrp_env_reduce(&s.env, 0u, 6u);
    return s;
}

static void free_sky(sky* s)
{
    free(s->image.texels);
    free(s->memory);
}

/* Largest error of the channels, against the largest channel. */
static double worst_channel(hdrp_v3 v, const double reference[3])
{
    double error =
        acc_larger(fabs((double)v.x - reference[0]),
                   acc_larger(fabs((double)v.y - reference[1]), fabs((double)v.z - reference[2])));
    return error / acc_larger(reference[0], acc_larger(reference[1], reference[2]));
}

static hdrp_v3 any_normal(acc* a)
{
    double d[3];
    acc_direction(a, d);
    return hdrp_v3_make((float)d[0], (float)d[1], (float)d[2]);
}

/* ---- baking ---------------------------------------------------------------------------------- */

/* Flux of images of all proportions, measured before and after. */
static void resample_flux_error(acc* a)
{
    static const uint32_t sizes[8][3] = {{256, 128, 32}, {300, 150, 32}, {257, 128, 16},
                                         {64, 33, 64},   {2, 1, 16},     {1, 1, 4},
                                         {40, 0, 16},    {16, 0, 64}};
    for (int i = 0; i < 8; ++i) {
        const uint32_t* size = sizes[i % 8];
        hdrp_env_image image = {0}, cube;
        hdrp_env_stats before, after;
        sky s = make_sky(a, SKY_SUN, size[2], size[2], 0.0f);
        image.width = size[0];
        image.height = size[1] ? size[1] : size[0];
        image.kind = size[1] ? HDRP_ENV_LATLONG : HDRP_ENV_CUBE;
        image.texels =
            malloc(sizeof(float) * 3u * image.width * hdrp_env_image_rows(&s.image) * 100u);
        if (!image.texels) {
            abort();
        }
        fill_sky(a, &image, image.width < 16u ? SKY_BROAD : SKY_LAMPS);
        hdrp_env_resample(&s.env, &image, 0u, 6u * size[2]);
        cube = hdrp_env_cube_image(&s.env.radiance, 0u);
        hdrp_env_measure(&image, &before);
        hdrp_env_measure(&cube, &after);
        for (int c = 0; c < 3; ++c) {
            ACC_ADD(a, acc_relative(after.average_nits_rgb[c], before.average_nits_rgb[c]),
                    "%u x %u to %u", size[0], size[1], size[2]);
        }
        free(image.texels);
        free_sky(&s);
    }
}

/* Some texels of some rows of every level. */
static void prefilter_error(acc* a, sky_kind kind)
{
    for (int i = 0; i < 2; ++i) {
        sky s = make_sky(a, kind, 64u, 32u, 0.0f);
        for (int k = 0; k < 24; ++k) {
            uint32_t level = 1u + (uint32_t)k % 3u, n = 32u >> level;
            uint32_t first = level == 1u ? 192u : (level == 2u ? 288u : 336u);
            uint32_t row = (uint32_t)(acc_random_bits(a) % (6u * n));
            double r = (double)hdrp_env_perceptual_roughness_from_lod((float)level, 4u),
                   reference[3];
            hdrp_env_prefilter(&s.env, first + row, 1u);
            for (uint32_t x = 0; x < n; x += n / 2u) {
                hdrp_v4 texel =
                    s.env.specular.texels[hdrp_i_env_level_offset(32u, level) + row * n + x];
                hdrp_v3 axis = hdrp_i_env_texel_centre(row / n, x, row % n, n);
                env_brute_force(&s.image, axis, r * r, reference);
                ACC_ADD(a, worst_channel(hdrp_v3_from_v4(texel), reference),
                        "sky %d level %u row %u texel %u", i, level, row, x);
            }
        }
        free_sky(&s);
    }
}

static void prefilter_broad_error(acc* a)
{
    prefilter_error(a, SKY_BROAD);
}

static void prefilter_lamps_error(acc* a)
{
    prefilter_error(a, SKY_LAMPS);
}

/* A lobe turns the slope of a linear sky into its mean cosine: one integral over the angle. */
static void prefilter_linear_error(acc* a)
{
    sky s = make_sky(a, SKY_LINEAR, 32u, 32u, 0.0f);
    hdrp_env_prefilter(&s.env, 0u, hdrp_env_specular_rows(&s.env));
    for (uint32_t level = 1; level < s.env.specular.level_count; ++level) {
        double r = (double)hdrp_env_perceptual_roughness_from_lod((float)level,
                                                                  s.env.specular.level_count);
        double a2 = r * r * r * r, top = 0.0, bottom = 0.0;
        uint32_t n = 32u >> level;
        for (int i = 0; i < 200000; ++i) {
            /* Even steps of the logarithm resolve the peak. */
            double angle = 0.5 * PI * exp(-(i + 0.5) * 1e-4);
            double t = 1.0 - (1.0 - a2) * pow(cos(0.5 * angle), 2.0);
            double weight = cos(angle) * sin(angle) * angle / (t * t);
            top += weight * cos(angle);
            bottom += weight;
        }
        for (uint32_t k = 0; k < 6u * n * n; ++k) {
            hdrp_v3 d = hdrp_i_env_texel_centre(k / n / n, k % n, k / n % n, n);
            double cosine = (double)d.x * linear_axis[0] + (double)d.y * linear_axis[1] +
                            (double)d.z * linear_axis[2];
            double reference = 1.0 + 0.9 * cosine * top / bottom;
            double texel = (double)s.env.specular.texels[hdrp_i_env_level_offset(32u, level) + k].x;
            ACC_ADD(a, fabs(texel - reference), "level %u texel %u", level, k);
        }
    }
    free_sky(&s);
}

/* Error of irradiance, against the largest. */
static void add_irradiance_errors(acc* a, const sky* s, const hdrp_v3* normal, const hdrp_v3* e,
                                  int count)
{
    double error[32], largest = 0.0;
    for (int k = 0; k < count; ++k) {
        double reference[3];
        env_brute_force(&s->image, normal[k], 1.0, reference);
        error[k] = acc_larger(fabs((double)e[k].x - PI * reference[0]),
                              acc_larger(fabs((double)e[k].y - PI * reference[1]),
                                         fabs((double)e[k].z - PI * reference[2])));
        for (int c = 0; c < 3; ++c) {
            largest = acc_larger(largest, PI * reference[c]);
        }
    }
    for (int k = 0; k < count; ++k) {
        ACC_ADD(a, error[k] / largest, "n = (%.3g, %.3g, %.3g)", (double)normal[k].x,
                (double)normal[k].y, (double)normal[k].z);
    }
}

static void irradiance_error(acc* a)
{
    for (int i = 0; i < 2; ++i) {
        sky s = make_sky(a, i % 2 ? SKY_LAMPS : SKY_BROAD, 64u, 1u, 0.0f);
        hdrp_v3 normal[32], e[32];
        for (uint32_t k = 0; k < 32u; k += 4u) {
            uint32_t row = (uint32_t)(acc_random_bits(a) % 96u);
            hdrp_env_convolve_irradiance(&s.env, row, 1u);
            for (uint32_t x = 0; x < 4u; ++x) {
                normal[k + x] = hdrp_i_env_texel_centre(row / 16u, 4u * x, row % 16u, 16u);
                e[k + x] = hdrp_v3_from_v4(s.env.irradiance.texels[row * 16u + 4u * x]);
            }
        }
        add_irradiance_errors(a, &s, normal, e, 32);
        free_sky(&s);
    }
}

static void irradiance_lookup_error(acc* a)
{
    for (int i = 0; i < 2; ++i) {
        sky s = make_sky(a, i ? SKY_LAMPS : SKY_BROAD, 32u, 1u, 0.0f);
        hdrp_v3 normal[32], e[32];
        hdrp_env_convolve_irradiance(&s.env, 0u, 96u);
        for (int k = 0; k < 32; ++k) {
            normal[k] = any_normal(a);
            e[k] = hdrp_env_irradiance(&s.env, normal[k]);
        }
        add_irradiance_errors(a, &s, normal, e, 32);
        free_sky(&s);
    }
}

static void specular_error(acc* a)
{
    for (int i = 0; i < 1; ++i) {
        sky s = make_sky(a, SKY_BROAD, 64u, 64u, 0.5f);
        hdrp_env_stats stats;
        hdrp_env_measure(&s.image, &stats);
        hdrp_env_prefilter(&s.env, 0u, hdrp_env_specular_rows(&s.env));
        for (int k = 0; k < 40; ++k) {
            double r = acc_uniform(a, 0.05, 1.0), reference[3];
            hdrp_v3 axis = any_normal(a);
            hdrp_v3 v = hdrp_env_specular(&s.env, axis, (float)r);
            env_brute_force(&s.image, axis, r * r, reference);
            for (int c = 0; c < 3; ++c) {
                double measured = (double)(c == 0 ? v.x : (c == 1 ? v.y : v.z));
                ACC_ADD(a, fabs(measured - reference[c]) / stats.average_nits,
                        "sky %d roughness %.3g", i, r);
            }
        }
        free_sky(&s);
    }
}

static void irradiance_fast_error(acc* a)
{
    sky s = make_sky(a, SKY_LINEAR, 64u, 1u, 0.0f);
    hdrp_env_sh sh;
    hdrp_env_project_sh(&s.env, &sh);
    for (int i = 0; i < 20000; ++i) {
        hdrp_v3 n = any_normal(a);
        double cosine = (double)n.x * linear_axis[0] + (double)n.y * linear_axis[1] +
                        (double)n.z * linear_axis[2];
        double reference = PI * (1.0 + 0.9 * 2.0 / 3.0 * cosine);
        ACC_ADD(a, acc_relative((double)hdrp_env_irradiance_fast(sh, n).x, reference),
                "n = (%.9g, %.9g, %.9g)", (double)n.x, (double)n.y, (double)n.z);
    }
    free_sky(&s);
}

/* The horizon of a sun is a crease that passes between texels. */
static void irradiance_lookup_sun_error(acc* a)
{
    for (int i = 0; i < 3; ++i) {
        sky s = make_sky(a, SKY_SUN, 32u, 1u, 0.0f);
        hdrp_env_sun sun;
        hdrp_env_find_sun(&s.image, 0.0f, &sun);
        hdrp_env_convolve_irradiance(&s.env, 0u, 96u);
        for (int k = 0; k < 20000; ++k) {
            hdrp_v3 n = any_normal(a);
            double cosine = acc_larger((double)hdrp_v3_dot(n, sun.direction), 0.0);
            double e = (double)hdrp_env_irradiance(&s.env, n).y / (double)sun.illuminance_lux.y;
            ACC_ADD(a, fabs(e - cosine), "cosine %.9g", cosine);
        }
        free_sky(&s);
    }
}

static void irradiance_fast_sun_error(acc* a)
{
    for (int i = 0; i < 4; ++i) {
        sky s = make_sky(a, SKY_SUN, 64u, 1u, 0.0f);
        hdrp_env_sun sun;
        hdrp_env_sh sh;
        hdrp_env_find_sun(&s.image, 0.0f, &sun);
        hdrp_env_project_sh(&s.env, &sh);
        for (int k = 0; k < 2000; ++k) {
            hdrp_v3 n = any_normal(a);
            double cosine = acc_larger((double)hdrp_v3_dot(n, sun.direction), 0.0);
            double e = (double)hdrp_env_irradiance_fast(sh, n).y / (double)sun.illuminance_lux.y;
            ACC_ADD(a, fabs(e - cosine), "cosine %.9g", cosine);
        }
        free_sky(&s);
    }
}

const acc_entry acc_env[] = {
    {"env_lod", lod_error},
    {"env_perceptual_roughness", perceptual_roughness_error},
    {"env_sh_windowed", sh_windowed_error},
    {"env_resample_flux", resample_flux_error},
    {"env_prefilter_broad", prefilter_broad_error},
    {"env_prefilter_lamps", prefilter_lamps_error},
    {"env_prefilter_linear", prefilter_linear_error},
    {"env_irradiance", irradiance_error},
    {"env_irradiance_lookup_sun", irradiance_lookup_sun_error},
    {"env_irradiance_lookup", irradiance_lookup_error},
    {"env_specular", specular_error},
    {"env_irradiance_fast", irradiance_fast_error},
    {"env_irradiance_fast_sun", irradiance_fast_sun_error},
    {NULL, NULL},
};
