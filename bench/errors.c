/* errors.c - how exact the octahedral encoders are, measured next to their speed.
 * SPDX-License-Identifier: MIT */
#include "errors.h"

#include "bench.h"

#include <math.h>
#include <meshoptimizer.h>
#include <stdio.h>

#define DIRECTIONS 2000000
#define BATCH      1000

typedef struct error {
    double worst, sum;
} error;

/* The angle between the normal and the point of the square, which is decoded in double. */
static void add(error* e, const float* n, double x, double y)
{
    double z = 1.0 - fabs(x) - fabs(y), fold = z < 0.0 ? -z : 0.0;
    double dx = x - copysign(fold, x), dy = y - copysign(fold, y);
    double nx = (double)n[0], ny = (double)n[1], nz = (double)n[2];
    double cx = ny * z - nz * dy, cy = nz * dx - nx * z, cz = nx * dy - ny * dx;
    double sine = sqrt(cx * cx + cy * cy + cz * cz);
    double angle = atan2(sine, nx * dx + ny * dy + nz * z) * (180.0 / 3.14159265358979324);
    e->worst = angle > e->worst ? angle : e->worst;
    e->sum += angle;
}

static double coordinate(hdrp_u32 code)
{
    return (double)hdrp_pack_float_from_snorm(code, 12u);
}

static double middle(hdrp_u32 code)
{
    return ((double)(code & 4095u) - 2047.5) / 2047.5;
}

static void print(const char* name, error e)
{
    printf("  %-42s %8.4f %8.4f\n", name, e.worst, e.sum / DIRECTIONS);
}

void bench_print_errors(void)
{
    static float n[4 * BATCH];
    static int16_t filtered[4 * BATCH];
    error e[5] = {{0.0, 0.0}};
    for (int i = 0; i < DIRECTIONS; i += BATCH) {
        for (int k = 0; k < BATCH; ++k) {
            hdrp_v3 v = hdrp_fibonacci_sphere((hdrp_u32)(i + k), DIRECTIONS);
            n[4 * k] = v.x;
            n[4 * k + 1] = v.y;
            n[4 * k + 2] = v.z;
        }
        meshopt_encodeFilterOct(filtered, BATCH, 8, 12, n);
        for (int k = 0; k < BATCH; ++k) {
            const float* v = n + 4 * k;
            hdrp_v3 d = hdrp_v3_make(v[0], v[1], v[2]);
            hdrp_u32 snorm = hdrp_pack_oct_snorm_from_normal(d, 12u);
            hdrp_u32 exact = hdrp_pack_oct_snorm_from_normal_exact(d, 12u);
            hdrp_u32 unorm = hdrp_pack_oct_unorm_from_normal(d, 12u);
            hdrp_u32 unorm_exact = hdrp_pack_oct_unorm_from_normal_exact(d, 12u);
            add(&e[0], v, filtered[4 * k] / 2047.0, filtered[4 * k + 1] / 2047.0);
            add(&e[1], v, coordinate(snorm), coordinate(snorm >> 12));
            add(&e[2], v, coordinate(exact), coordinate(exact >> 12));
            add(&e[3], v, middle(unorm), middle(unorm >> 12));
            add(&e[4], v, middle(unorm_exact), middle(unorm_exact >> 12));
        }
    }
    printf("error of octahedral 12/12 encoders in degrees     worst     mean\n");
    print("meshoptimizer", e[0]);
    print("hdrp_pack_oct_snorm_from_normal", e[1]);
    print("hdrp_pack_oct_snorm_from_normal_exact", e[2]);
    print("hdrp_pack_oct_unorm_from_normal", e[3]);
    print("hdrp_pack_oct_unorm_from_normal_exact", e[4]);
}
