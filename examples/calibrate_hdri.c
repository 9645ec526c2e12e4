/* calibrate_hdri.c - makes a picture of a sky light a scene: measure, calibrate, split off the sun,
 * prefilter, look up.
 * SPDX-License-Identifier: MIT
 *
 *     cc -I. examples/calibrate_hdri.c -lm && ./a.out
 *
 * Exits with 1 when the numbers are implausible. */
#include <stdio.h>
#include <stdlib.h>

#define HDRP_ENV_IMPLEMENTATION
#include "hdrp_env.h"

#define WIDTH      512u
#define HEIGHT     256u
#define WANTED_LUX 20000.0

/* A blue gradient over grey ground with a small sun, in units of no meaning, as files have them.
 * One texel is broken, as in files, too. */
static void paint(float* texels, hdrp_v3 to_sun)
{
    for (uint32_t k = 0; k < WIDTH * HEIGHT; ++k) {
        hdrp_v2 uv = hdrp_v2_make(((float)(k % WIDTH) + 0.5f) / (float)WIDTH,
                                  ((float)(k / WIDTH) + 0.5f) / (float)HEIGHT);
        hdrp_v3 d = hdrp_env_direction_from_latlong(uv);
        float up = hdrp_max(d.y, 0.0f);
        float sun = hdrp_v3_dot(d, to_sun) > 0.9999f ? 30000.0f : 0.0f;
        texels[3u * k] = d.y > 0.0f ? 0.9f - 0.6f * up + sun : 0.2f;
        texels[3u * k + 1u] = d.y > 0.0f ? 0.9f - 0.4f * up + 0.9f * sun : 0.2f;
        texels[3u * k + 2u] = d.y > 0.0f ? 1.0f - 0.1f * up + 0.8f * sun : 0.2f;
    }
    texels[1000] = NAN;
}

static int is_near(double measured, double expected, double tolerance)
{
    int good = fabs(measured - expected) <= tolerance * fabs(expected);
    if (!good) {
        printf("%g should be %g\n", measured, expected);
    }
    return good;
}

/* Lux of the sky and nits per unit, so that the image gives what was wanted. */
static int calibrate(hdrp_env_image* sky)
{
    hdrp_env_sanitize_counts found = {0};
    hdrp_env_stats stats = {0};
    float multiplier = 0.0f;
    if (hdrp_env_sanitize(sky, NULL, 0u, hdrp_env_image_rows(sky), &found) != HDRP_OK ||
        hdrp_env_measure(sky, &stats) != HDRP_OK ||
        hdrp_env_lux_multiplier(&stats, WANTED_LUX, &multiplier) != HDRP_OK) {
        return 0;
    }
    printf("%u broken texel; %.2f lux as stored, %.1f times that wanted\n",
           (unsigned)found.nan_texels, stats.illuminance_lux, (double)multiplier);
    sky->nits_per_unit = multiplier;
    return found.nan_texels == 1u && hdrp_env_measure(sky, &stats) == HDRP_OK &&
           is_near(stats.illuminance_lux, WANTED_LUX, 1e-6);
}

/* The sun as a directional light that can cast shadows; the image keeps the rest. */
static int split_sun(hdrp_env_image* sky, hdrp_v3 to_sun)
{
    hdrp_env_sun sun = {0};
    hdrp_env_stats stats = {0};
    double from_sun;
    if (hdrp_env_find_sun(sky, 0.0f, &sun) != HDRP_OK ||
        hdrp_env_remove_sun(sky, &sun) != HDRP_OK || hdrp_env_measure(sky, &stats) != HDRP_OK) {
        return 0;
    }
    from_sun = (double)(hdrp_luminance(sun.illuminance_lux) * sun.direction.y);
    printf("sun: (%.2f %.2f %.2f), %.0f lux on level ground; sky: %.0f lux\n",
           (double)sun.direction.x, (double)sun.direction.y, (double)sun.direction.z, from_sun,
           stats.illuminance_lux);
    return hdrp_v3_dot(sun.direction, to_sun) > 0.99999f &&
           is_near(from_sun + stats.illuminance_lux, WANTED_LUX, 1e-5);
}

/* What surfaces see of the prefiltered sky. */
static int look_up(const hdrp_env* env)
{
    hdrp_v3 up = hdrp_v3_make(0.0f, 1.0f, 0.0f), level = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    float mirror = hdrp_env_specular(env, up, 0.0f).y, rough = hdrp_env_specular(env, up, 1.0f).y;
    float ceiling = hdrp_env_irradiance(env, hdrp_v3_neg(up)).y;
    hdrp_env_sh sh;
    for (int i = 0; i <= 4; ++i) {
        float perceptual_roughness = (float)i / 4.0f;
        printf("roughness %.2f: %5.0f nits from above, %5.0f from the horizon\n",
               (double)perceptual_roughness,
               (double)hdrp_env_specular(env, up, perceptual_roughness).y,
               (double)hdrp_env_specular(env, level, perceptual_roughness).y);
    }
    if (hdrp_env_project_sh(env, &sh) != HDRP_OK) {
        return 0;
    }
    printf("floor %.0f lux, ceiling %.0f lux; by spherical harmonics %.0f and %.0f\n",
           (double)hdrp_env_irradiance(env, up).y, (double)ceiling,
           (double)hdrp_env_irradiance_fast(sh, up).y,
           (double)hdrp_env_irradiance_fast(sh, hdrp_v3_neg(up)).y);
    /* The sky is darkest above; under all of it a rough floor sees irradiance / pi. */
    return mirror < rough &&
           is_near((double)rough * 3.14159265, (double)hdrp_env_irradiance(env, up).y, 0.05) &&
           is_near((double)hdrp_env_irradiance_fast(sh, up).y,
                   (double)hdrp_env_irradiance(env, up).y, 0.05);
}

int main(void)
{
    hdrp_v3 to_sun = hdrp_v3_normalize(hdrp_v3_make(0.4f, 0.7f, -0.6f));
    hdrp_env_image sky = {0};
    hdrp_env_desc desc = {0};
    hdrp_env env;
    size_t bytes;
    void* memory;
    int good;
    desc.radiance_size = 128u; /* small and quick; zero means the defaults */
    desc.specular_size = 64u;
    bytes = hdrp_env_memory_size(&desc);
    memory = malloc(bytes);
    sky.texels = (float*)malloc(sizeof(float) * 3u * WIDTH * HEIGHT);
    sky.width = WIDTH;
    sky.height = HEIGHT;
    good = memory && sky.texels;
    if (good) {
        paint(sky.texels, to_sun);
        good = calibrate(&sky) && split_sun(&sky, to_sun) &&
               hdrp_env_init(&env, &desc, memory, bytes) == HDRP_OK &&
               hdrp_env_bake(&env, &sky) == HDRP_OK && look_up(&env);
    }
    free(sky.texels);
    free(memory);
    printf("%s\n", good ? "as expected" : "NOT as expected");
    return good ? 0 : 1;
}
