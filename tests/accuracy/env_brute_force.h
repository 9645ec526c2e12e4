/* env_brute_force.h - what hdrp_env.h filters, summed the slow way, for tests.
 * SPDX-License-Identifier: MIT */
#ifndef ENV_BRUTE_FORCE_H
#define ENV_BRUTE_FORCE_H

#include <math.h>
#include <stdbool.h>

#include "hdrp_env.h"

/* Mean of the radiance of a cube under the lobe D(h) n.l / 4 of GGX around an axis, straight from
 * its definition, over every texel, each cut into parts where the lobe or the horizon need it. For
 * alpha 1, times pi, this is the irradiance. */
static inline void env_brute_force(const hdrp_env_image* cube, hdrp_v3 axis, double alpha,
                                   double result[3])
{
    double n[3] = {(double)axis.x, (double)axis.y, (double)axis.z};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double sum[3] = {0.0, 0.0, 0.0}, total = 0.0;
    uint32_t size = cube->width;
    double a2 = alpha * alpha, wide = 2.0 / size;
    for (uint32_t k = 0; k < 6u * size * size; ++k) {
        uint32_t face = k / size / size, x = k % size, y = k / size % size;
        hdrp_v3 m = hdrp_env_point_from_cube(face, ((float)x + 0.5f) * (float)wide - 1.0f,
                                             ((float)y + 0.5f) * (float)wide - 1.0f);
        double middle = (double)hdrp_v3_dot(m, axis) / (double)hdrp_v3_length(m);
        double q = fmax(2.0 - 2.0 * middle, 0.0), mean = 0.0;
        bool narrow = q < 60.0 * wide * wide || (q < 16.0 * a2 && a2 < 25.0 * wide * wide);
        int parts = narrow || fabs(middle) < wide ? 4 : 2;
        if (middle < -wide) {
            continue;
        }
        for (int part = 0; part < parts * parts; ++part) {
            double u = (x + (part % parts + 0.5) / parts) * wide - 1.0;
            double v = (y + (part / parts + 0.5) / parts) * wide - 1.0;
            hdrp_v3 p = hdrp_env_point_from_cube(face, (float)u, (float)v);
            double l[3] = {(double)p.x, (double)p.y, (double)p.z};
            double r2 = l[0] * l[0] + l[1] * l[1] + l[2] * l[2], r = sqrt(r2), h2 = 0.0;
            double n_dot_l = (l[0] * n[0] + l[1] * n[1] + l[2] * n[2]) / (r * length);
            for (int i = 0; i < 3; ++i) {
                double h = l[i] / r + n[i] / length;
                h2 += h * h;
            }
            double n_dot_h = (1.0 + n_dot_l) / sqrt(h2);
            double t = n_dot_h * n_dot_h * (a2 - 1.0) + 1.0;
            mean += n_dot_l <= 0.0 ? 0.0 : a2 / (t * t) * n_dot_l / (parts * parts * r2 * r);
        }
        hdrp_v3 radiance = hdrp_env_image_texel(cube, face * size + y, x);
        sum[0] += mean * (double)radiance.x;
        sum[1] += mean * (double)radiance.y;
        sum[2] += mean * (double)radiance.z;
        total += mean;
    }
    for (int i = 0; i < 3; ++i) {
        result[i] = sum[i] / total;
    }
}

#endif
