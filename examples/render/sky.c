#include "sky.h"

#include <math.h>
#include <stdlib.h>

/* Scattering and extinction at sea level for red, green and blue light (680, 550, 440 nm), per
 * metre, and scale heights: Bruneton and Neyret 2008, "Precomputed Atmospheric Scattering"; ozone:
 * Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique". */
static const hdrp_v3 rayleigh = {5.802e-6f, 13.558e-6f, 33.1e-6f};
static const hdrp_v3 ozone = {0.650e-6f, 1.881e-6f, 0.085e-6f};
#define MIE_SCATTER     3.996e-6f
#define MIE_EXTINCT     4.440e-6f
#define MIE_G           0.76f
#define RAYLEIGH_HEIGHT 8000.0f
#define MIE_HEIGHT      1200.0f
#define EARTH_RADIUS    6.360e6f
#define TOP_RADIUS      6.420e6f
/* The sun above the atmosphere: 128 klx of daylight, its colour that of 5778 K. */
static const hdrp_v3 sun_above_lux = {1.28e5f * 1.05f, 1.28e5f * 0.99f, 1.28e5f * 0.95f};
#define SUN_RADIUS_RAD 0.004654f

#define VIEW_STEPS     16
#define SUN_STEPS      6

typedef struct densities {
    float rayleigh, mie, ozone;
} densities;

static densities density_at(float altitude)
{
    densities d;
    float h = hdrp_max(altitude, 0.0f);
    d.rayleigh = expf(-h / RAYLEIGH_HEIGHT);
    d.mie = expf(-h / MIE_HEIGHT);
    /* A layer 30 km thick around 25 km. */
    d.ozone = hdrp_max(0.0f, 1.0f - hdrp_abs(h - 25000.0f) / 15000.0f);
    return d;
}

static float altitude_of(hdrp_v3 p)
{
    return hdrp_v3_length(p) - EARTH_RADIUS;
}

/* Distance from p inside a sphere around the origin to its surface, along unit d. */
static float exit_distance(hdrp_v3 p, hdrp_v3 d, float radius)
{
    float b = hdrp_v3_dot(p, d);
    float c = (hdrp_v3_length(p) - radius) * (hdrp_v3_length(p) + radius);
    return -b + sqrtf(hdrp_max(b * b - c, 0.0f));
}

static hdrp_v3 transmittance(const rd_sky* sky, densities depth)
{
    float mie = MIE_EXTINCT * sky->haze * depth.mie;
    return hdrp_v3_make(expf(-rayleigh.x * depth.rayleigh - ozone.x * depth.ozone - mie),
                        expf(-rayleigh.y * depth.rayleigh - ozone.y * depth.ozone - mie),
                        expf(-rayleigh.z * depth.rayleigh - ozone.z * depth.ozone - mie));
}

static densities add(densities a, densities b, float length)
{
    a.rayleigh += b.rayleigh * length;
    a.mie += b.mie * length;
    a.ozone += b.ozone * length;
    return a;
}

/* Optical depths from p to the top of the atmosphere. Steps grow quadratically, as air thins. */
static densities depth_to_top(hdrp_v3 p, hdrp_v3 d)
{
    float length = exit_distance(p, d, TOP_RADIUS);
    densities sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < SUN_STEPS; ++i) {
        float a = hdrp_sq((float)i / SUN_STEPS), b = hdrp_sq((float)(i + 1) / SUN_STEPS);
        float t = 0.5f * (a + b) * length;
        sum = add(sum, density_at(altitude_of(hdrp_v3_mad(p, d, t))), (b - a) * length);
    }
    return sum;
}

static float rayleigh_phase(float c)
{
    return 3.0f / (16.0f * HDRP_PI) * (1.0f + c * c);
}

/* Cornette and Shanks 1992. */
static float mie_phase(float c)
{
    const float g = MIE_G;
    float k = 3.0f / (8.0f * HDRP_PI) * (1.0f - g * g) / (2.0f + g * g);
    return k * (1.0f + c * c) / powf(1.0f + g * g - 2.0f * g * c, 1.5f);
}

/* Light that p receives from everywhere but the sun, as if it came evenly from all sides: what
 * single scattering leaves out. The factor brings the zenith to measured clear skies. */
#define MULTIPLE_SCATTERING 0.3f

/* Light that the air around p sends towards the eye, per metre and before extinction. */
static hdrp_v3 scattered(const rd_sky* sky, hdrp_v3 p, densities d, float phase_r, float phase_m)
{
    hdrp_v3 light =
        hdrp_v3_mul(sun_above_lux, transmittance(sky, depth_to_top(p, sky->sun_direction)));
    float mie = MIE_SCATTER * sky->haze * d.mie;
    float even = MULTIPLE_SCATTERING / (4.0f * HDRP_PI);
    return hdrp_v3_make(
        light.x * (rayleigh.x * d.rayleigh * (phase_r + even) + mie * (phase_m + even)),
        light.y * (rayleigh.y * d.rayleigh * (phase_r + even) + mie * (phase_m + even)),
        light.z * (rayleigh.z * d.rayleigh * (phase_r + even) + mie * (phase_m + even)));
}

static hdrp_v3 air_nits(const rd_sky* sky, hdrp_v3 direction)
{
    hdrp_v3 eye = {0.0f, EARTH_RADIUS + 10.0f, 0.0f};
    float c = hdrp_v3_dot(direction, sky->sun_direction);
    float phase_r = rayleigh_phase(c), phase_m = mie_phase(c);
    float length = exit_distance(eye, direction, TOP_RADIUS);
    densities depth = {0.0f, 0.0f, 0.0f};
    hdrp_v3 sum = hdrp_v3_splat(0.0f);
    for (int i = 0; i < VIEW_STEPS; ++i) {
        float a = hdrp_sq((float)i / VIEW_STEPS), b = hdrp_sq((float)(i + 1) / VIEW_STEPS);
        float step = (b - a) * length;
        hdrp_v3 p = hdrp_v3_mad(eye, direction, 0.5f * (a + b) * length);
        densities d = density_at(altitude_of(p));
        hdrp_v3 s;
        depth = add(depth, d, 0.5f * step);
        s = hdrp_v3_mul(scattered(sky, p, d, phase_r, phase_m), transmittance(sky, depth));
        sum = hdrp_v3_mad(sum, s, step);
        depth = add(depth, d, 0.5f * step);
    }
    return sum;
}

hdrp_v3 rd_sky_nits(const rd_sky* sky, hdrp_v3 direction)
{
    /* The horizon fades over a degree, so that no filter sees an edge. */
    float above = hdrp_saturate(direction.y / 0.02f + 0.5f);
    hdrp_v3 up = direction;
    hdrp_v3 air;
    if (above <= 0.0f) {
        return sky->ground_nits;
    }
    up.y = hdrp_max(up.y, 0.002f);
    air = air_nits(sky, hdrp_v3_normalize(up));
    return hdrp_v3_lerp(sky->ground_nits, air, above);
}

/* Illuminance of the ground by the sky alone, over a coarse grid of equal solid angles. */
static hdrp_v3 sky_lux(const rd_sky* sky)
{
    enum { RINGS = 6, SECTORS = 12 };
    hdrp_v3 sum = hdrp_v3_splat(0.0f);
    for (int i = 0; i < RINGS * SECTORS; ++i) {
        float y = ((float)(i / SECTORS) + 0.5f) / RINGS;
        float a = ((float)(i % SECTORS) + 0.5f) / SECTORS * HDRP_TWO_PI;
        float r = sqrtf(1.0f - y * y);
        hdrp_v3 d = hdrp_v3_make(r * sinf(a), y, r * cosf(a));
        sum = hdrp_v3_mad(sum, air_nits(sky, d), y * HDRP_TWO_PI / (RINGS * SECTORS));
    }
    return sum;
}

rd_sky rd_sky_make(float elevation_rad, float azimuth_rad, float haze, hdrp_v3 ground_albedo)
{
    rd_sky s;
    hdrp_v3 ground = {0.0f, EARTH_RADIUS + 10.0f, 0.0f};
    hdrp_v3 lux;
    float c = cosf(elevation_rad);
    s.sun_direction =
        hdrp_v3_make(c * sinf(azimuth_rad), sinf(elevation_rad), c * cosf(azimuth_rad));
    s.sun_radius_rad = SUN_RADIUS_RAD;
    s.haze = haze;
    s.ground_albedo = ground_albedo;
    s.sun_lux =
        hdrp_v3_mul(sun_above_lux, transmittance(&s, depth_to_top(ground, s.sun_direction)));
    lux = hdrp_v3_mad(sky_lux(&s), s.sun_lux, hdrp_max(s.sun_direction.y, 0.0f));
    s.ground_nits = hdrp_v3_scale(hdrp_v3_mul(s.ground_albedo, lux), HDRP_INV_PI);
    return s;
}

static void fill_row(const rd_sky* sky, int y, int width, int height, float* out)
{
    float latitude = HDRP_HALF_PI - ((float)y + 0.5f) / (float)height * HDRP_PI;
    for (int x = 0; x < width; ++x, out += 4) {
        float longitude = HDRP_PI - ((float)x + 0.5f) / (float)width * HDRP_TWO_PI;
        float r = cosf(latitude);
        hdrp_v3 d = hdrp_v3_make(r * sinf(longitude), sinf(latitude), r * cosf(longitude));
        hdrp_v3 c = rd_sky_nits(sky, d);
        out[0] = c.x;
        out[1] = c.y;
        out[2] = c.z;
        out[3] = 1.0f;
    }
}

bool rd_sky_image(const rd_sky* sky, int width, int height, rd_image_f32* image)
{
    float* rgba = (float*)malloc((size_t)width * (size_t)height * 4 * sizeof *rgba);
    if (!rgba) {
        return false;
    }
#pragma omp parallel for schedule(dynamic, 4)
    for (int y = 0; y < height; ++y) {
        fill_row(sky, y, width, height, rgba + (size_t)y * (size_t)width * 4);
    }
    image->width = width;
    image->height = height;
    image->layout = RD_LAYOUT_LATLONG;
    image->rgba = rgba;
    return true;
}
