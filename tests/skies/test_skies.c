/* test_skies.c - hdrp_env.h on real skies: conventions, calibration, and filters against brute
 * force. Prints what it measures; exits with 77 where the assets are missing.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image.h"

#define HDRP_ENV_IMPLEMENTATION
#include "env_brute_force.h"

#define PI 3.14159265358979323846

static int failures;

static void expect(bool good, const char* what)
{
    if (!good) {
        printf("FAILED: %s\n", what);
        ++failures;
    }
}

/* A sky of the assets; edges says whether its samples lie on edges, as OpenEXR's attribute has it. */
static hdrp_env_image load(const char* folder, const char* name, bool* edges)
{
    hdrp_env_image image = {0};
    rd_image_f32 file;
    rd_report report = {0};
    char path[1024];
    snprintf(path, sizeof path, "%s/hdri/%s", folder, name);
    if (!rd_image_read_f32(&file, path, &report)) {
        printf("%s\n", report.error);
        exit(1);
    }
    image.texels = file.rgba;
    image.width = (uint32_t)file.width;
    image.height = (uint32_t)file.height;
    image.texel_stride = 4u;
    if (file.layout == RD_LAYOUT_CUBE) {
        image.kind = HDRP_ENV_CUBE;
        image.height = image.width;
    }
    *edges = file.layout != RD_LAYOUT_PLAIN;
    return image;
}

static hdrp_env_image load_areas(const char* folder, const char* name)
{
    bool edges;
    hdrp_env_image file = load(folder, name, &edges), image = file;
    if (!edges) {
        return file;
    }
    image.width -= 1u;
    image.height -= 1u;
    image.texel_stride = 3u;
    image.texels = malloc(sizeof(float) * 3u * image.width * hdrp_env_image_rows(&file));
    expect(image.texels && hdrp_env_texels_from_openexr(&file, 0u, hdrp_env_image_rows(&image),
                                                        image.texels) == HDRP_OK,
           "conversion of an OpenEXR environment map");
    free(file.texels);
    return image;
}

static uint32_t next(uint32_t* state, uint32_t end)
{
    *state = *state * 1664525u + 1013904223u; /* Knuth, TAOCP 2, section 3.3.4 */
    return (uint32_t)(((uint64_t)*state * end) >> 32);
}

static hdrp_v3 next_direction(uint32_t* state)
{
    double y = 2.0 * next(state, 100000u) / 1e5 - 1.0, phi = 2.0 * PI * next(state, 100000u) / 1e5;
    double r = sqrt(1.0 - y * y);
    return hdrp_v3_make((float)(r * sin(phi)), (float)y, (float)(r * cos(phi)));
}

/* The same place as a panorama and as a cube: a wrong axis, mirror or half texel would show. */
static void compare_layouts(const char* folder, const char* panorama, const char* cube)
{
    hdrp_env_image a = load_areas(folder, panorama), b = load_areas(folder, cube);
    hdrp_env_stats sa = {0}, sb = {0};
    uint32_t random = 1u;
    double difference = 0.0, mirrored = 0.0, sum = 0.0;
    for (int i = 0; i < 100000; ++i) {
        hdrp_v3 d = next_direction(&random);
        /* The brightest texels are blurred differently in the two files. */
        float u = hdrp_min(hdrp_env_image_radiance(&a, d).y, 4.0f);
        float v = hdrp_min(hdrp_env_image_radiance(&b, d).y, 4.0f);
        d.x = -d.x;
        float m = hdrp_min(hdrp_env_image_radiance(&b, d).y, 4.0f);
        difference += (double)((u - v) * (u - v));
        mirrored += (double)((u - m) * (u - m));
        sum += (double)(u * u);
    }
    hdrp_env_measure(&a, &sa);
    hdrp_env_measure(&b, &sb);
    printf("%s against %s: RMS difference %.3f (mirrored %.3f), lux %.5g and %.5g\n", panorama,
           cube, sqrt(difference / sum), sqrt(mirrored / sum), sa.illuminance_lux,
           sb.illuminance_lux);
    expect(sqrt(difference / sum) < 0.05, "panorama and cube show the same");
    expect(mirrored > 9.0 * difference, "a mirrored cube would be noticed");
    expect(fabs(sa.illuminance_lux / sb.illuminance_lux - 1.0) < 1e-3, "same illuminance");
    free(a.texels);
    free(b.texels);
}

static double worst_channel(hdrp_v4 texel, double scale, const double reference[3])
{
    double error = fmax(fabs((double)texel.x / scale - reference[0]),
                        fmax(fabs((double)texel.y / scale - reference[1]),
                             fabs((double)texel.z / scale - reference[2])));
    return error / fmax(reference[0], fmax(reference[1], reference[2]));
}

/* Texels of every level and of the irradiance, half of them around the brightest place. */
static double worst_texel(const hdrp_env* env, hdrp_v3 bright)
{
    hdrp_env_image radiance = hdrp_env_cube_image(&env->radiance, 0u);
    uint32_t random = 2u;
    double worst = 0.0;
    for (uint32_t level = 1; level <= env->specular.level_count; ++level) {
        bool diffuse = level == env->specular.level_count;
        const hdrp_env_cube* cube = diffuse ? &env->irradiance : &env->specular;
        hdrp_env_image image = hdrp_env_cube_image(cube, diffuse ? 0u : level);
        double r = diffuse ? 1.0
                           : (double)hdrp_env_perceptual_roughness_from_lod(
                                 (float)level, env->specular.level_count);
        for (int k = 0; k < 8; ++k) {
            hdrp_v3 d = next_direction(&random);
            double reference[3];
            uint32_t n = image.width;
            d = k % 2 ? d : hdrp_v3_mad(bright, d, (float)(r * r));
            hdrp_env_place place = hdrp_env_cube_from_direction(d);
            uint32_t x = (uint32_t)(place.u * (float)n), y = (uint32_t)(place.v * (float)n);
            x = x < n ? x : n - 1u;
            y = y < n ? y : n - 1u;
            place.u = ((float)x + 0.5f) / (float)n;
            place.v = ((float)y + 0.5f) / (float)n;
            env_brute_force(&radiance, hdrp_env_direction_from_cube(place), r * r, reference);
            const float* t = image.texels + 4u * ((place.face * n + y) * n + x);
            double error =
                worst_channel(hdrp_v4_make(t[0], t[1], t[2], 0.0f), diffuse ? PI : 1.0, reference);
            worst = fmax(worst, error);
        }
    }
    return worst;
}

static void bake_sky(const char* folder, const char* name)
{
    hdrp_env_image image = load_areas(folder, name);
    hdrp_env_sanitize_counts found = {0};
    hdrp_env_stats stats = {0}, after = {0};
    hdrp_env_sun sun = {0};
    hdrp_env_desc desc = {0};
    hdrp_env env;
    desc.radiance_size = 128u;
    desc.specular_size = 64u;
    size_t bytes = hdrp_env_memory_size(&desc);
    void* memory = malloc(bytes);
    expect(hdrp_env_sanitize(&image, NULL, 0u, hdrp_env_image_rows(&image), &found) == HDRP_OK &&
               hdrp_env_measure(&image, &stats) == HDRP_OK &&
               hdrp_env_find_sun(&image, 0.0f, &sun) == HDRP_OK && memory &&
               hdrp_env_init(&env, &desc, memory, bytes) == HDRP_OK &&
               hdrp_env_bake(&env, &image) == HDRP_OK,
           name);
    if (failures == 0) {
        hdrp_env_image cube = hdrp_env_cube_image(&env.radiance, 0u);
        hdrp_env_measure(&cube, &after);
        double flux = after.average_nits / stats.average_nits - 1.0;
        double lux = after.illuminance_lux / stats.illuminance_lux - 1.0;
        double error = worst_texel(&env, sun.direction);
        printf("%s: %.5g lux, mean %.4g, peak %.6g; NaN %u, infinite %u, negative %u\n", name,
               stats.illuminance_lux, stats.average_nits, stats.peak_nits,
               (unsigned)found.nan_texels, (unsigned)found.infinite_texels,
               (unsigned)found.negative_texels);
        printf(
            "    brightest spot %.1f %% of the light, %.3g lux facing it; as a cube of 128: flux "
            "%+.1e, lux %+.1e; filters against brute force %.1e\n",
            100.0 * (double)sun.share, (double)hdrp_luminance(sun.illuminance_lux), flux, lux,
            error);
        expect(stats.invalid_texels == 0u, "no invalid texel is left");
        expect(fabs(flux) < 1e-3, "the cube has the flux of the image");
        expect(fabs(lux) < 1e-2, "the cube has the illuminance of the image");
        expect(error < 1e-2, "the filters agree with brute force");
    }
    free(memory);
    free(image.texels);
}

static void broken_texels_are_counted(const char* folder)
{
    bool edges;
    hdrp_env_image image = load(folder, "conformance/BrightRingsNanInf.exr", &edges);
    hdrp_env_sanitize_counts found = {0};
    hdrp_env_stats stats = {0};
    hdrp_env_sanitize(&image, NULL, 0u, hdrp_env_image_rows(&image), &found);
    hdrp_env_measure(&image, &stats);
    printf("BrightRingsNanInf.exr: NaN %u, infinite %u, negative %u; peak afterwards %.6g\n",
           (unsigned)found.nan_texels, (unsigned)found.infinite_texels,
           (unsigned)found.negative_texels, stats.peak_nits);
    expect(found.nan_texels > 0u && found.infinite_texels > 0u, "NaN and infinity are found");
    expect(stats.invalid_texels == 0u, "and replaced");
    free(image.texels);
}

static void a_sun_beyond_half_floats_survives(const char* folder)
{
    bool edges;
    hdrp_env_image image = load(folder, "spiaggia_di_mondello_1k_float_zip.exr", &edges);
    hdrp_env_sanitize_counts found = {0};
    float largest = 0.0f;
    hdrp_env_sanitize(&image, NULL, 0u, hdrp_env_image_rows(&image), &found);
    for (uint32_t i = 0; i < image.width * image.height; ++i) {
        hdrp_v3 v = hdrp_env_image_texel(&image, i / image.width, i % image.width);
        largest = hdrp_max(largest, hdrp_v3_max_component(v));
    }
    expect(largest > 65504.0f && largest < 1e6f, "a sun above the largest half is kept");
    free(image.texels);
}

int main(void)
{
    const char* folder = getenv("HDRP_TEST_ASSETS");
    FILE* probe;
    char path[1024];
    folder = folder ? folder : HDRP_ASSETS;
    snprintf(path, sizeof path, "%s/hdri/KernerEnvCube.exr", folder);
    probe = fopen(path, "rb");
    if (!probe) {
        printf("skipped: no test assets in %s (set HDRP_TEST_ASSETS)\n", folder);
        return 77;
    }
    fclose(probe);
    compare_layouts(folder, "KernerEnvLatLong.exr", "KernerEnvCube.exr");
    compare_layouts(folder, "conformance/OrientationLatLong.exr",
                    "conformance/OrientationCube.exr");
    broken_texels_are_counted(folder);
    a_sun_beyond_half_floats_survives(folder);
    bake_sky(folder, "KernerEnvLatLong.exr");
    bake_sky(folder, "studio_1k_half_zip.exr");
    bake_sky(folder, "night_1k_half_piz.exr");
    bake_sky(folder, "sunset_512_half_none.exr");
    bake_sky(folder, "spiaggia_di_mondello_1k_float_zip.exr");
    bake_sky(folder, "forest_dwab_float.exr");
    return failures != 0;
}
