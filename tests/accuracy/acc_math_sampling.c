/* acc_math_sampling.c - accuracy of the point sets and mappings of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_math.h"

#define PI 3.14159265358979323846

/* Small, middling and the largest indices. */
static uint32_t random_index(acc* a, int i)
{
    return i < 4096 ? (uint32_t)i : (uint32_t)(acc_random_bits(a) >> (32 + i % 20));
}

/* Distance on a circle of circumference 1. */
static double around(double x, long double turns)
{
    double d = x - (double)(turns - floorl(turns));
    return fabs(d - floor(d + 0.5));
}

static void hammersley_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        uint32_t index = random_index(a, i);
        uint32_t count = index + 1u + (uint32_t)(acc_random_bits(a) % (0xffffffffu - index));
        hdrp_v2 p = hdrp_hammersley(index, count);
        double inverse = 0.0;
        for (int k = 0; k < 32; ++k) {
            inverse += (double)(index >> k & 1u) * ldexp(0.5, -k);
        }
        ACC_ADD(a,
                acc_larger(fabs((double)p.x - (double)index / (double)count),
                           fabs((double)p.y - inverse)),
                "%u of %u", index, count);
    }
}

static void r2_error(acc* a)
{
    long double p = 1.3247L;
    for (int k = 0; k < 8; ++k) {
        p -= (p * p * p - p - 1.0L) / (3.0L * p * p - 1.0L);
    }
    for (int i = 0; i < 400000; ++i) {
        uint32_t index = random_index(a, i);
        hdrp_v2 r = hdrp_r2(index);
        ACC_ADD(a,
                acc_larger(around((double)r.x, 0.5L + (long double)index / p),
                           around((double)r.y, 0.5L + (long double)index / (p * p))),
                "%u", index);
    }
}

/* The angle of index i on both Fibonacci spirals. */
static double golden_angle(uint32_t i)
{
    long double turns = (long double)i * (sqrtl(5.0L) - 1.0L) * 0.5L;
    return 2.0 * PI * (double)(turns - floorl(turns));
}

static uint32_t random_count(acc* a, uint32_t index)
{
    return index + 1u + (uint32_t)(acc_random_bits(a) % (0xffffffffu - index));
}

static void fibonacci_disk_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        uint32_t index = random_index(a, i), count = random_count(a, index);
        double angle = golden_angle(index), r = sqrt(((double)index + 0.5) / (double)count);
        hdrp_v2 p = hdrp_fibonacci_disk(index, count);
        ACC_ADD(a,
                acc_larger(fabs((double)p.x - r * cos(angle)), fabs((double)p.y - r * sin(angle))),
                "%u of %u", index, count);
    }
}

static double difference3(hdrp_v3 measured, double x, double y, double z)
{
    return acc_larger(fabs((double)measured.x - x),
                      acc_larger(fabs((double)measured.y - y), fabs((double)measured.z - z)));
}

static void fibonacci_sphere_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        uint32_t index = random_index(a, i), count = random_count(a, index);
        double angle = golden_angle(index);
        double polar = acos(1.0 - (2.0 * (double)index + 1.0) / (double)count);
        ACC_ADD(a,
                difference3(hdrp_fibonacci_sphere(index, count), sin(polar) * cos(angle),
                            sin(polar) * sin(angle), cos(polar)),
                "%u of %u", index, count);
    }
}

/* Inside, on the diagonals, and on the border. */
static hdrp_v2 square_point(acc* a, int i)
{
    float x = acc_float(acc_uniform(a, 0.0, 1.0)), y = acc_float(acc_uniform(a, 0.0, 1.0));
    y = i % 8 == 1 ? x : (i % 8 == 2 ? 1.0f - x : y);
    x = i % 8 == 3 ? 0.0f : (i % 8 == 4 ? 1.0f : x);
    return hdrp_v2_make(x, i % 8 == 5 ? 1.0f : y);
}

/* The four wedges of the paper, each with its own radius and angle; returns the radius. */
static double concentric(hdrp_v2 u, double* x, double* y)
{
    double a = 2.0 * (double)u.x - 1.0, b = 2.0 * (double)u.y - 1.0, r = 0.0, phi = 0.0;
    if (a > -b) {
        r = a > b ? a : b;
        phi = a > b ? PI / 4.0 * (b / a) : PI / 4.0 * (2.0 - a / b);
    } else if (a < 0.0 || b < 0.0) {
        r = a < b ? -a : -b;
        phi = a < b ? PI / 4.0 * (4.0 + b / a) : PI / 4.0 * (6.0 - a / b);
    }
    *x = r * cos(phi);
    *y = r * sin(phi);
    return r;
}

static void disk_concentric_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        double x, y;
        hdrp_v2 u = square_point(a, i), p = hdrp_disk_concentric(u);
        concentric(u, &x, &y);
        ACC_ADD(a, acc_larger(fabs((double)p.x - x), fabs((double)p.y - y)), "(%.9g, %.9g)",
                (double)u.x, (double)u.y);
    }
}

static void disk_polar_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_v2 u = square_point(a, i), p = hdrp_disk_polar(u);
        double r = sqrt((double)u.x), phi = 2.0 * PI * (double)u.y;
        ACC_ADD(a, acc_larger(fabs((double)p.x - r * cos(phi)), fabs((double)p.y - r * sin(phi))),
                "(%.9g, %.9g)", (double)u.x, (double)u.y);
    }
}

static void hemisphere_cosine_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        double x, y;
        hdrp_v2 u = square_point(a, i);
        concentric(u, &x, &y);
        /* 1 - r without cancellation, for the reference needs the horizon too */
        double e = fmin(fmin((double)u.x, 1.0 - (double)u.x), fmin((double)u.y, 1.0 - (double)u.y));
        ACC_ADD(a, difference3(hdrp_hemisphere_cosine(u), x, y, sin(acos(1.0 - 2.0 * e))),
                "(%.9g, %.9g)", (double)u.x, (double)u.y);
    }
}

static void hemisphere_cosine_pdf_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float c = acc_float(acc_log_uniform(a, 1e-30, 1.0));
        ACC_ADD(a, acc_relative((double)hdrp_hemisphere_cosine_pdf(c), (double)c / PI),
                "cosine %.9g", (double)c);
    }
}

/* z of the highest polar angle below which the share u.x of the area lies. */
static void band_error(acc* a, hdrp_v3 measured, hdrp_v2 u, double z)
{
    double phi = 2.0 * PI * (double)u.y, polar = acos(z);
    ACC_ADD(a, difference3(measured, sin(polar) * cos(phi), sin(polar) * sin(phi), z),
            "(%.9g, %.9g)", (double)u.x, (double)u.y);
}

static void hemisphere_uniform_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_v2 u = square_point(a, i);
        band_error(a, hdrp_hemisphere_uniform(u), u, 1.0 - (double)u.x);
    }
}

static void sphere_uniform_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_v2 u = square_point(a, i);
        band_error(a, hdrp_sphere_uniform(u), u, 1.0 - 2.0 * (double)u.x);
    }
}

const acc_entry acc_math_sampling[] = {
    {"hammersley", hammersley_error},
    {"r2", r2_error},
    {"fibonacci_disk", fibonacci_disk_error},
    {"fibonacci_sphere", fibonacci_sphere_error},
    {"disk_concentric", disk_concentric_error},
    {"disk_polar", disk_polar_error},
    {"hemisphere_cosine", hemisphere_cosine_error},
    {"hemisphere_cosine_pdf", hemisphere_cosine_pdf_error},
    {"hemisphere_uniform", hemisphere_uniform_error},
    {"sphere_uniform", sphere_uniform_error},
    {NULL, NULL},
};
