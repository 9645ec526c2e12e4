/* sampling.c - samplers follow the densities that they state: sampling
 * SPDX-License-Identifier: MIT
 *
 * Pearson's chi-squared test of every sampler of the headers, over roughness x angle x anisotropy
 * where it has them. Prints a CSV line per sampler:
 *
 *     sampler,cases,samples,bins,least_p,integral_error,at
 *
 * least_p: the smallest of the cases' p values; of so many good ones it is about 1 / cases, and the
 * test fails below 1e-4 / cases. integral_error: by how much a density misses 1 at most. at: the
 * case of least_p. Point sets (Hammersley, R2, Fibonacci) are no random numbers: they are held to
 * their discrepancy in the unit tests. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HDRP_ENV_IMPLEMENTATION
#define HDRP_ENV_IMAGE_IMPLEMENTATION
#include "../unit/brdf_test.h"
#include "hdrp_env_image.h"

#define MAX_BINS 4096

static int failures;
static double seen[MAX_BINS], expected[MAX_BINS];

typedef struct tally {
    int cases, samples, bins;
    double least_p, integral_error;
    char at[96];
} tally;

/* Upper tail of the chi-squared distribution, from its cube root, which is almost normal (Wilson
 * and Hilferty 1931). z is bt_chi_squared's number of deviations, where good samples have 0. */
static double p_value(double deviations, double freedom)
{
    double ratio = 1.0 + deviations * sqrt(2.0 / freedom), k = 2.0 / (9.0 * freedom);
    return 0.5 * erfc((cbrt(fmax(ratio, 0.0)) - (1.0 - k)) / sqrt(2.0 * k));
}

static void clear(void)
{
    memset(seen, 0, sizeof seen);
    memset(expected, 0, sizeof expected);
}

/* Takes one case's histogram into account; expected holds probabilities. */
static void add_case(tally* t, int bins, int samples, const char* at)
{
    double total = 0.0, freedom = 0.0;
    for (int i = 0; i < bins; ++i) {
        total += expected[i];
        expected[i] *= samples;
        freedom += expected[i] >= 10.0;
    }
    double p = p_value(bt_chi_squared(seen, expected, bins), fmax(freedom, 1.0));
    t->cases++;
    t->samples = samples;
    t->bins = bins;
    t->integral_error = fmax(t->integral_error, fabs(total - 1.0));
    if (!(p >= t->least_p)) {
        t->least_p = p;
        snprintf(t->at, sizeof t->at, "%s", at);
    }
}

static void report(const char* sampler, const tally* t, double integral_bound)
{
    printf("%s,%d,%d,%d,%.3g,%.2g,%s\n", sampler, t->cases, t->samples, t->bins, t->least_p,
           t->integral_error, t->at);
    if (!(t->least_p >= 1e-4 / t->cases && t->integral_error <= integral_bound)) {
        fprintf(stderr, "sampling: %s: p = %.3g, integral off by %.3g\n", sampler, t->least_p,
                t->integral_error);
        failures++;
    }
}

/* Of n equal bins, the one that a number in [0,1] belongs to. */
static int bin_of(double x, int n)
{
    return (int)fmin(fmax(x, 0.0) * n, n - 1);
}

static double turn_of(double x, double y)
{
    return atan2(y, x) / (2.0 * BQ_PI) + 0.5;
}

/* >>simple maps: what they are uniform in is known in closed form */

typedef hdrp_v2 (*chart)(hdrp_v2 u);

static hdrp_v2 disk_chart(hdrp_v2 p)
{
    return hdrp_v2_make((float)turn_of((double)p.x, (double)p.y), p.x * p.x + p.y * p.y);
}

static hdrp_v2 concentric(hdrp_v2 u)
{
    return disk_chart(hdrp_disk_concentric(u));
}

static hdrp_v2 polar_disk(hdrp_v2 u)
{
    return disk_chart(hdrp_disk_polar(u));
}

static hdrp_v2 cosine(hdrp_v2 u)
{
    hdrp_v3 d = hdrp_hemisphere_cosine(u);
    return hdrp_v2_make((float)turn_of((double)d.x, (double)d.y), d.z * d.z);
}

static hdrp_v2 hemisphere(hdrp_v2 u)
{
    hdrp_v3 d = hdrp_hemisphere_uniform(u);
    return hdrp_v2_make((float)turn_of((double)d.x, (double)d.y), d.z);
}

static hdrp_v2 sphere(hdrp_v2 u)
{
    hdrp_v3 d = hdrp_sphere_uniform(u);
    return hdrp_v2_make((float)turn_of((double)d.x, (double)d.y), 0.5f + 0.5f * d.z);
}

static void simple(const char* name, chart map)
{
    enum { SIDE = 32, SAMPLES = 400000 };
    tally t = {0, 0, 0, 1.0, 0.0, ""};
    for (int k = 0; k < 4; ++k) {
        uint64_t seed = 10u + (uint64_t)k;
        char at[96];
        clear();
        for (int i = 0; i < SIDE * SIDE; ++i) {
            expected[i] = 1.0 / (SIDE * SIDE);
        }
        for (int i = 0; i < SAMPLES; ++i) {
            float x = bt_random_f(&seed), y = bt_random_f(&seed);
            hdrp_v2 p = map(hdrp_v2_make(x, y));
            seen[bin_of((double)p.x, SIDE) * SIDE + bin_of((double)p.y, SIDE)] += 1.0;
        }
        snprintf(at, sizeof at, "seed %d", k);
        add_case(&t, SIDE * SIDE, SAMPLES, at);
    }
    report(name, &t, 1e-9);
}

/* The density over solid angle that is stated for cosine-weighted directions. */
static void cosine_density(void)
{
    tally t = {1, 0, 0, 1.0, 0.0, ""};
    double sum = 0.0;
    for (int i = 0; i < 10000; ++i) {
        sum += 2.0 * BQ_PI * (double)hdrp_hemisphere_cosine_pdf((float)((i + 0.5) / 10000.0)) /
               10000.0;
    }
    t.integral_error = fabs(sum - 1.0);
    snprintf(t.at, sizeof t.at, "the density only");
    report("hdrp_hemisphere_cosine_pdf", &t, 1e-6);
}

/* >>visible normals, in slopes over the widths: any width is resolved */

/* Direction whose slopes over the widths have radius sqrt(1 / t^2 - 1), and its solid angle. */
static void normal_at(double t, double turn, hdrp_brdf_alphas a, double h[3], double* solid_angle)
{
    double s = sqrt(1.0 / (t * t) - 1.0), phi = 2.0 * BQ_PI * (turn - 0.5);
    double x = (double)a.t * s * cos(phi), y = (double)a.b * s * sin(phi);
    double length = sqrt(1.0 + x * x + y * y);
    h[0] = x / length;
    h[1] = y / length;
    h[2] = 1.0 / length;
    *solid_angle =
        2.0 * BQ_PI * (double)a.t * (double)a.b / (t * t * t) / (length * length * length);
}

static void visible_case(tally* t, float roughness, float anisotropy, double n_dot_v)
{
    enum { SIDE = 24, FINE = 12, SAMPLES = 60000 };
    hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(roughness, anisotropy);
    hdrp_v3 v = bt_direction(n_dot_v, 0.7);
    uint64_t seed = 7u + (uint64_t)t->cases;
    char at[96];
    clear();
    for (int i = 0; i < SIDE * FINE; ++i) {
        for (int j = 0; j < SIDE * FINE; ++j) {
            double h[3], solid_angle;
            normal_at((i + 0.5) / (SIDE * FINE), (j + 0.5) / (SIDE * FINE), a, h, &solid_angle);
            hdrp_v3 n = bt_v3(h);
            double c = (double)hdrp_v3_dot(v, n);
            double p = c > 0.0 ? 4.0 * c * (double)hdrp_brdf_pdf_vndf(v, n, a.t, a.b) : 0.0;
            expected[i / FINE * SIDE + j / FINE] += p * solid_angle / (SIDE * SIDE * FINE * FINE);
        }
    }
    for (int i = 0; i < SAMPLES; ++i) {
        float x = bt_random_f(&seed), y = bt_random_f(&seed);
        hdrp_v3 h = hdrp_brdf_sample_vndf(v, a.t, a.b, hdrp_v2_make(x, y));
        double sx = (double)h.x / (double)a.t, sy = (double)h.y / (double)a.b;
        double place = (double)h.z / sqrt(sx * sx + sy * sy + (double)h.z * (double)h.z);
        seen[bin_of(place, SIDE) * SIDE + bin_of(turn_of(sx, sy), SIDE)] += 1.0;
    }
    snprintf(at, sizeof at, "roughness %.3g; anisotropy %.2g; n.v %.3g", (double)roughness,
             (double)anisotropy, n_dot_v);
    add_case(t, SIDE * SIDE, SAMPLES, at);
}

static void visible_normals(void)
{
    const float roughness[] = {0.02f, 0.1f, 0.3f, 0.6f, 1.0f};
    const float anisotropy[] = {-0.9f, 0.0f, 0.5f};
    const double n_dot_v[] = {0.02, 0.15, 0.5, 1.0};
    tally t = {0, 0, 0, 1.0, 0.0, ""};
    for (int i = 0; i < 60; ++i) {
        visible_case(&t, roughness[i % 5], anisotropy[i / 5 % 3], n_dot_v[i / 15]);
    }
    report("hdrp_brdf_sample_vndf", &t, 0.02);
}

/* >>the Lit model; widths that bins on the sphere resolve */

static void lit_case(tally* t, float roughness, float anisotropy, double n_dot_v, hdrp_u32 features)
{
    enum { ROWS = 32, COLUMNS = 24, BINS = ROWS * COLUMNS, FINE = 10, SAMPLES = 40000 };
    hdrp_brdf_surface s = bt_surface(0.8f, 0.2f, 0.04f, roughness);
    uint64_t seed = 3u + (uint64_t)t->cases;
    char at[96];
    s.features = features;
    s.anisotropy = anisotropy;
    s.coat_mask = 0.9f;
    s.coat_perceptual_roughness = 0.45f;
    s.coat_normal = hdrp_v3_make(0.3f, 0.1f, 1.0f);
    s.film_mask = 1.0f;
    s.transmittance = hdrp_v3_make(0.9f, 0.5f, 0.7f);
    s.transmission = 0.6f;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    hdrp_brdf_lit_view w = bt_view(d, bt_direction(n_dot_v, 0.5), features);
    clear();
    for (int i = 0; i < ROWS * FINE; ++i) {
        for (int j = 0; j < COLUMNS * FINE; ++j) {
            double phi = 2.0 * BQ_PI * ((j + 0.5) / (COLUMNS * FINE) - 0.5);
            hdrp_v3 l = bt_direction(2.0 * (i + 0.5) / (ROWS * FINE) - 1.0, phi);
            expected[i / FINE * COLUMNS + j / FINE] +=
                (double)hdrp_brdf_lit_pdf(d, w, l, features) * 4.0 * BQ_PI / (BINS * FINE * FINE);
        }
    }
    for (int i = 0; i < SAMPLES; ++i) {
        float x = bt_random_f(&seed), y = bt_random_f(&seed), z = bt_random_f(&seed);
        hdrp_v3 l = hdrp_brdf_lit_sample(d, w, hdrp_v3_make(x, y, z), features);
        seen[bin_of(0.5 + 0.5 * (double)l.z, ROWS) * COLUMNS +
             bin_of(turn_of((double)l.x, (double)l.y), COLUMNS)] += 1.0;
    }
    snprintf(at, sizeof at, "roughness %.3g; anisotropy %.2g; n.v %.3g; features %u",
             (double)roughness, (double)anisotropy, n_dot_v, features);
    add_case(t, BINS, SAMPLES, at);
}

static void lit(void)
{
    const hdrp_u32 features[] = {0u,
                                 HDRP_BRDF_FEATURE_CLEAR_COAT,
                                 HDRP_BRDF_FEATURE_TRANSMISSION,
                                 HDRP_BRDF_FEATURE_REFRACTION,
                                 HDRP_BRDF_FEATURE_IRIDESCENCE,
                                 HDRP_BRDF_FEATURE_ANISOTROPY,
                                 HDRP_BRDF_FEATURE_ALL};
    const float roughness[] = {0.5f, 0.75f, 1.0f}, anisotropy[] = {-0.6f, 0.6f};
    const double n_dot_v[] = {0.05, 0.4, 0.9};
    tally t = {0, 0, 0, 1.0, 0.0, ""};
    for (int i = 0; i < 7 * 9; ++i) {
        float a = features[i / 9] & HDRP_BRDF_FEATURE_ANISOTROPY ? anisotropy[i % 2] : 0.0f;
        lit_case(&t, roughness[i % 3], a, n_dot_v[i / 3 % 3], features[i / 9]);
    }
    report("hdrp_brdf_lit_sample", &t, 0.01);
}

/* >>environments */

static void environment_case(tally* t, hdrp_env_image_kind kind, uint32_t size, double contrast)
{
    enum { FINE = 16, SIDE = 12, SAMPLES = 200000 };
    hdrp_env_image image = {0};
    hdrp_env_sampler sampler;
    uint64_t seed = 5u + (uint64_t)t->cases;
    uint32_t faces = kind == HDRP_ENV_CUBE ? 6u : 1u, grid = SIDE * FINE;
    int bins = (int)faces * SIDE * SIDE;
    char at[96];
    image.kind = kind;
    image.width = image.height = size;
    size_t count = (size_t)3u * faces * size * size;
    image.texels = malloc(count * sizeof(float));
    for (size_t i = 0; image.texels && i < count; ++i) {
        image.texels[i] = (float)exp(contrast * (bt_random(&seed) - 0.5));
    }
    size_t bytes = hdrp_env_sampler_memory_size(&image);
    void* memory =
        aligned_alloc(HDRP_MEMORY_ALIGNMENT, (bytes + HDRP_MEMORY_ALIGNMENT - 1) /
                                                 HDRP_MEMORY_ALIGNMENT * HDRP_MEMORY_ALIGNMENT);
    if (!image.texels || !memory ||
        hdrp_env_sampler_init(&sampler, &image, memory, bytes) != HDRP_OK ||
        hdrp_env_sampler_build(&sampler, 0u, hdrp_env_image_rows(&image)) != HDRP_OK ||
        hdrp_env_sampler_finish(&sampler) != HDRP_OK) {
        fprintf(stderr, "sampling: no sampler for an image of %u\n", size);
        exit(1);
    }
    clear();
    for (uint32_t k = 0; k < faces * grid * grid; ++k) {
        uint32_t x = k % grid, y = k / grid % grid, face = k / grid / grid;
        hdrp_env_place place = {face, ((float)x + 0.5f) / (float)grid,
                                ((float)y + 0.5f) / (float)grid};
        bool cube = kind == HDRP_ENV_CUBE;
        hdrp_v3 d = cube ? hdrp_env_direction_from_cube(place)
                         : hdrp_env_direction_from_latlong(hdrp_v2_make(place.u, place.v));
        double solid_angle = cube ? (double)hdrp_env_cube_solid_angle(x, y, grid)
                                  : (double)hdrp_env_latlong_solid_angle(y, grid, grid);
        expected[(face * SIDE + y / FINE) * SIDE + x / FINE] +=
            solid_angle * (double)hdrp_env_sampler_pdf(&sampler, d);
    }
    for (int i = 0; i < SAMPLES; ++i) {
        float x = bt_random_f(&seed), y = bt_random_f(&seed);
        hdrp_env_sample s = hdrp_env_sampler_sample(&sampler, x, y);
        hdrp_env_place p = hdrp_env_cube_from_direction(s.direction);
        if (kind != HDRP_ENV_CUBE) {
            hdrp_v2 uv = hdrp_env_latlong_from_direction(s.direction);
            p.face = 0u;
            p.u = uv.x;
            p.v = uv.y;
        }
        seen[((int)p.face * SIDE + bin_of((double)p.v, SIDE)) * SIDE + bin_of((double)p.u, SIDE)] +=
            1.0;
    }
    snprintf(at, sizeof at, "%s of %u; contrast %.3g", faces == 6u ? "cube" : "latlong", size,
             exp(contrast));
    add_case(t, bins, SAMPLES, at);
    free(image.texels);
    free(memory);
}

static void environments(void)
{
    const uint32_t sizes[] = {1u, 3u, 6u, 24u};
    const double contrasts[] = {0.0, 4.0, 10.0};
    tally t = {0, 0, 0, 1.0, 0.0, ""};
    for (int i = 0; i < 24; ++i) {
        environment_case(&t, i % 2 ? HDRP_ENV_CUBE : HDRP_ENV_LATLONG, sizes[i / 2 % 4],
                         contrasts[i / 8]);
    }
    report("hdrp_env_sampler_sample", &t, 3e-3);
}

int main(void)
{
    printf("sampler,cases,samples,bins,least_p,integral_error,at\n");
    simple("hdrp_disk_concentric", concentric);
    simple("hdrp_disk_polar", polar_disk);
    simple("hdrp_hemisphere_cosine", cosine);
    simple("hdrp_hemisphere_uniform", hemisphere);
    simple("hdrp_sphere_uniform", sphere);
    cosine_density();
    visible_normals();
    lit();
    environments();
    return failures != 0;
}
