/* prefilters.c - error and cost of ways to filter a sky for GGX lobes, against brute force.
 * SPDX-License-Identifier: MIT
 *
 * prefilters           a table, by sky, method and setting: errors relative to the largest channel
 *                      of a texel, and milliseconds for the specular cube on one core; irradiance
 *                      likewise, relative to the largest of the sky
 * prefilters --quick   fewer texels, no times; fails where hdrp_env_prefilter does not keep its
 *                      distance from the sampled ones
 *
 * Sampled: GGX half vectors from a Hammersley set, N = V = R, weight n.l (Karis 2013, "Real Shading
 * in Unreal Engine 4"); and the same reading the mip level whose texels are as large as the share of
 * a sample (Krivanek and Colbert 2008, "Real-time Shading with Filtered Importance Sampling"). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "image.h"

#define HDRP_ENV_IMPLEMENTATION
#include "env_brute_force.h"

#define PI          3.14159265358979323846
#define TIMED_ROUND 3

typedef struct prefilter {
    const char* name;
    float opening;    /* of hdrp_env_prefilter; 0 for sampled ones */
    uint32_t samples; /* of sampled ones */
    bool levels;      /* whether they read mip levels */
} prefilter;

static const prefilter prefilters[] = {
    {"sampled", 0.0f, 16u, false},           {"sampled", 0.0f, 64u, false},
    {"sampled", 0.0f, 256u, false},          {"sampled", 0.0f, 1024u, false},
    {"sampled levels", 0.0f, 16u, true},     {"sampled levels", 0.0f, 64u, true},
    {"sampled levels", 0.0f, 256u, true},    {"sampled levels", 0.0f, 1024u, true},
    {"hdrp_env_prefilter", 0.8f, 0u, false}, {"hdrp_env_prefilter", 0.4f, 0u, false},
    {"hdrp_env_prefilter", 0.2f, 0u, false},
};
#define PREFILTERS ((int)(sizeof prefilters / sizeof prefilters[0]))
#define DEFAULT    9 /* the one with the default opening */

typedef struct result {
    double max, sum, ms;
    int count;
} result;

static double uniform(void)
{
    static uint64_t state = 88172645463325252u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 9007199254740992.0;
}

static double milliseconds(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

/* ---- skies ------------------------------------------------------------------------------------ */

/* A clear sky over a dim ground and, where it has one, a sun of one texel that gives five times the
 * light of the sky. */
static void fill(const hdrp_env_image* image, bool sun)
{
    const hdrp_v3 to_sun = hdrp_v3_make(0.48f, 0.64f, 0.6f);
    uint32_t n = image->width;
    hdrp_env_place at = hdrp_env_cube_from_direction(to_sun);
    uint32_t x = (uint32_t)(at.u * (float)n), y = (uint32_t)(at.v * (float)n);
    uint32_t disc = (at.face * n + y) * n + x;
    for (uint32_t k = 0; k < 6u * n * n; ++k) {
        hdrp_env_place place = {k / n / n, 0.0f, 0.0f};
        place.u = ((float)(k % n) + 0.5f) / (float)n;
        place.v = ((float)(k / n % n) + 0.5f) / (float)n;
        hdrp_v3 d = hdrp_env_direction_from_cube(place);
        float glow = powf(fmaxf(hdrp_v3_dot(d, to_sun), 0.0f), 24.0f);
        float sky = d.y > 0.0f ? 1.0f : expf(12.0f * d.y);
        float direct = sun && k == disc ? 10.0f / hdrp_env_cube_solid_angle(x, y, n) : 0.0f;
        image->texels[3u * k + 0u] = 0.1f + 0.3f * sky + 2.0f * glow + direct;
        image->texels[3u * k + 1u] = 0.1f + 0.5f * sky + 1.6f * glow + 0.9f * direct;
        image->texels[3u * k + 2u] =
            0.1f + 0.9f * sky * (0.4f + 0.6f * d.y * d.y) + glow + 0.8f * direct;
    }
}

static hdrp_env_image synthetic(uint32_t size, bool sun)
{
    hdrp_env_image image = {0};
    image.width = image.height = size;
    image.kind = HDRP_ENV_CUBE;
    image.texels = malloc(sizeof(float) * 18u * size * size);
    if (!image.texels) {
        abort();
    }
    fill(&image, sun);
    return image;
}

/* A picture of the assets, where they are. */
static bool load(const char* path, hdrp_env_image* image)
{
    rd_image_f32 file;
    rd_report report = {0};
    if (!rd_image_read_f32(&file, path, &report)) {
        return false;
    }
    memset(image, 0, sizeof *image);
    image->texels = file.rgba;
    image->width = (uint32_t)file.width;
    image->height = (uint32_t)file.height;
    image->texel_stride = 4u;
    return file.layout == RD_LAYOUT_PLAIN &&
           hdrp_env_sanitize(image, NULL, 0u, hdrp_env_image_rows(image), NULL) == HDRP_OK;
}

/* ---- filters ---------------------------------------------------------------------------------- */

static hdrp_v3 sampled(const hdrp_env* env, const prefilter* how, hdrp_v3 n, float alpha)
{
    hdrp_basis basis = hdrp_basis_from_normal(n);
    hdrp_v3 sum = hdrp_v3_splat(0.0f);
    float total = 0.0f, a2 = alpha * alpha;
    float texel = 4.0f * HDRP_PI / (6.0f * (float)(env->radiance.size * env->radiance.size));
    for (uint32_t i = 0; i < how->samples; ++i) {
        hdrp_v2 u = hdrp_hammersley(i, how->samples);
        float cos2 = (1.0f - u.y) / (1.0f + (a2 - 1.0f) * u.y), c = sqrtf(cos2);
        float s = sqrtf(fmaxf(1.0f - cos2, 0.0f)), phi = 2.0f * HDRP_PI * u.x;
        hdrp_v3 h = hdrp_v3_add(
            hdrp_v3_scale(basis.tangent, s * cosf(phi)),
            hdrp_v3_add(hdrp_v3_scale(basis.bitangent, s * sinf(phi)), hdrp_v3_scale(n, c)));
        hdrp_v3 l = hdrp_v3_normalize(hdrp_v3_sub(hdrp_v3_scale(h, 2.0f * c), n));
        float n_dot_l = hdrp_v3_dot(n, l), d = cos2 * (a2 - 1.0f) + 1.0f;
        float pdf = a2 / (4.0f * HDRP_PI * d * d);
        float lod = how->levels ? 0.5f * log2f(1.0f / ((float)how->samples * pdf * texel)) : 0.0f;
        if (n_dot_l > 0.0f) {
            hdrp_v3 light = hdrp_env_radiance(env, l, fmaxf(lod, 0.0f));
            sum = hdrp_v3_mad(sum, light, n_dot_l);
            total += n_dot_l;
        }
    }
    return hdrp_v3_scale(sum, 1.0f / total);
}

static hdrp_v3 filtered(hdrp_env* env, const prefilter* how, hdrp_v3 axis, float alpha)
{
    if (how->samples) {
        return sampled(env, how, axis, alpha);
    }
    env->opening = how->opening;
    hdrp_i_env_lobe lobe = hdrp_i_env_lobe_make(alpha, env->opening);
    lobe.axis = axis;
    return hdrp_i_env_gather(env, &lobe);
}

static void add_error(result* r, hdrp_v3 v, const double reference[3])
{
    double error = fmax(fabs((double)v.x - reference[0]),
                        fmax(fabs((double)v.y - reference[1]), fabs((double)v.z - reference[2])));
    error /= fmax(reference[0], fmax(reference[1], reference[2]));
    r->max = fmax(r->max, error);
    r->sum += error;
    ++r->count;
}

/* Some texels of every rough level of the specular cube by every method. */
static void measure(hdrp_env* env, const hdrp_env_image* cube, int texels, bool timed,
                    result results[PREFILTERS])
{
    memset(results, 0, sizeof(result) * (size_t)PREFILTERS);
    for (uint32_t level = 1u; level < env->specular.level_count; ++level) {
        uint32_t n = env->specular.size >> level;
        float alpha = hdrp_sq(
            hdrp_env_perceptual_roughness_from_lod((float)level, env->specular.level_count));
        for (int i = 0; i < texels; ++i) {
            uint32_t k = (uint32_t)(uniform() * 6.0 * n * n);
            hdrp_v3 axis = hdrp_i_env_texel_centre(k / n / n, k % n, k / n % n, n);
            double reference[3];
            env_brute_force(cube, axis, (double)alpha, reference);
            for (int p = 0; p < PREFILTERS; ++p) {
                double best = 1e30;
                hdrp_v3 v = hdrp_v3_splat(0.0f);
                for (int round = 0; round < (timed ? TIMED_ROUND : 1); ++round) {
                    double start = milliseconds();
                    v = filtered(env, &prefilters[p], axis, alpha);
                    best = fmin(best, milliseconds() - start);
                }
                add_error(&results[p], v, reference);
                results[p].ms += best * 6.0 * n * n / texels;
            }
        }
    }
}

/* Irradiance at some normals, errors relative to the largest: by harmonics and by a cube. */
static void measure_irradiance(hdrp_env* env, const hdrp_env_image* cube, int normals,
                               result results[2])
{
    hdrp_env_sh sh;
    double start = milliseconds(), middle, largest = 0.0;
    memset(results, 0, sizeof(result) * 2u);
    hdrp_env_project_sh(env, &sh);
    middle = milliseconds();
    hdrp_env_convolve_irradiance(env, 0u, 6u * env->irradiance.size);
    results[0].ms = middle - start;
    results[1].ms = milliseconds() - middle;
    for (int i = 0; i < normals; ++i) {
        double reference[3];
        hdrp_v3 n = hdrp_fibonacci_sphere((hdrp_u32)i, (hdrp_u32)normals);
        env_brute_force(cube, n, 1.0, reference);
        hdrp_v3 e[2] = {hdrp_env_irradiance_fast(sh, n), hdrp_env_irradiance(env, n)};
        for (int k = 0; k < 2; ++k) {
            double error = fmax(fabs((double)e[k].x - PI * reference[0]),
                                fmax(fabs((double)e[k].y - PI * reference[1]),
                                     fabs((double)e[k].z - PI * reference[2])));
            results[k].max = fmax(results[k].max, error);
            results[k].sum += error;
            ++results[k].count;
        }
        largest = fmax(largest, PI * fmax(reference[0], fmax(reference[1], reference[2])));
    }
    for (int k = 0; k < 2; ++k) {
        results[k].max /= largest;
        results[k].sum /= largest;
    }
}

/* ---- the table -------------------------------------------------------------------------------- */

static void print_row(const char* quantity, const char* sky, const char* method,
                      const char* setting, const result* r, bool timed)
{
    printf("%s,%s,%s,%s,%.3g,%.3g", quantity, sky, method, setting, r->max, r->sum / r->count);
    printf(timed ? ",%.3g\n" : "\n", r->ms);
}

static int report(const char* sky, const result results[PREFILTERS], bool timed)
{
    int wrong = 0;
    for (int p = 0; p < PREFILTERS; ++p) {
        const prefilter* f = &prefilters[p];
        const result* r = &results[p];
        char setting[32];
        snprintf(setting, sizeof setting, f->samples ? "%.0f samples" : "opening %.1f",
                 f->samples ? (double)f->samples : (double)f->opening);
        print_row("GGX lobes", sky, f->name, setting, r, timed);
        if (f->samples &&
            (results[DEFAULT].max > 0.5 * r->max || results[DEFAULT].sum > 0.5 * r->sum)) {
            fprintf(stderr, "%s: %s, %s, is nearly as good as hdrp_env_prefilter\n", sky, f->name,
                    setting);
            ++wrong;
        }
    }
    return wrong;
}

static int compare(const char* sky, const hdrp_env_image* image, uint32_t size, int texels,
                   bool timed)
{
    hdrp_env env;
    hdrp_env_desc desc = {0};
    result results[PREFILTERS], irradiances[2];
    desc.radiance_size = size;
    void* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, hdrp_env_memory_size(&desc));
    if (!memory || hdrp_env_init(&env, &desc, memory, hdrp_env_memory_size(&desc)) != HDRP_OK ||
        hdrp_env_resample(&env, image, 0u, 6u * size) != HDRP_OK ||
        hdrp_env_reduce(&env, 0u, 6u) != HDRP_OK) {
        abort();
    }
    hdrp_env_image cube = hdrp_env_cube_image(&env.radiance, 0u);
    measure(&env, &cube, texels, timed, results);
    measure_irradiance(&env, &cube, 4 * texels, irradiances);
    print_row("irradiance", sky, "hdrp_env_irradiance_fast", "9 coefficients", &irradiances[0],
              timed);
    print_row("irradiance", sky, "hdrp_env_irradiance", "16 by 16", &irradiances[1], timed);
    free(memory);
    return report(sky, results, timed);
}

int main(int argc, char** argv)
{
    static const char* const files[] = {"spiaggia_di_mondello_1k.hdr", "night_1k_half_piz.exr"};
    static const char* const names[] = {"beach", "night"};
    bool quick = argc == 2 && strcmp(argv[1], "--quick") == 0;
    uint32_t size = quick ? 64u : 256u;
    int texels = quick ? 4 : 12, wrong = 0;
    hdrp_env_image sky;
    const char* assets = getenv("HDRP_TEST_ASSETS");
    printf("quantity,sky,method,setting,max,mean%s\n", quick ? "" : ",milliseconds");
    for (int sun = 0; sun < 2; ++sun) {
        sky = synthetic(size, sun != 0);
        wrong += compare(sun ? "sun" : "clear", &sky, size, texels, !quick);
        free(sky.texels);
    }
    for (int i = 0; i < 2 && !quick; ++i) {
        char path[1024];
        snprintf(path, sizeof path, "%s/hdri/%s", assets ? assets : HDRP_ASSETS, files[i]);
        if (load(path, &sky)) {
            wrong += compare(names[i], &sky, size, texels, !quick);
            free(sky.texels);
        } else {
            fprintf(stderr, "skipped: %s\n", path);
        }
    }
    return wrong ? 1 : 0;
}
