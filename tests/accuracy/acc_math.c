/* acc_math.c - accuracy of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_math.h"

static double max3(double a, double b, double c)
{
    return acc_larger(a, acc_larger(b, c));
}

static void normalize_or_error(acc* a)
{
    for (int i = 0; i < 1000000; ++i) {
        double d[3];
        acc_direction(a, d);
        double length = acc_log_uniform(a, 1e-37, 3e38);
        hdrp_v3 v = hdrp_v3_make(acc_float(d[0] * length), acc_float(d[1] * length),
                                 acc_float(d[2] * length));
        double x = (double)v.x, y = (double)v.y, z = (double)v.z;
        double reference = sqrt(x * x + y * y + z * z);
        hdrp_v3 n = hdrp_normalize_or(v, hdrp_v3_splat(9.0f));
        ACC_ADD(a,
                max3(fabs((double)n.x - x / reference), fabs((double)n.y - y / reference),
                     fabs((double)n.z - z / reference)),
                "v = (%.9g, %.9g, %.9g)", x, y, z);
    }
}

static double dot(hdrp_v3 a, hdrp_v3 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y + (double)a.z * (double)b.z;
}

/* The axes of a basis against what defines it: unit length and right angles. n itself is rounded,
 * so that its own length differs from 1 by up to 1.2e-7 and is part of the error. */
static void basis_error(acc* a)
{
    for (int i = 0; i < 1000000; ++i) {
        double d[3];
        acc_direction(a, d);
        if (i % 4 == 0) { /* close to the poles, where the two halves meet and 1 + n.z cancels */
            double s = acc_log_uniform(a, 1e-8, 1e-2);
            d[0] *= s;
            d[1] *= s;
            d[2] = copysign(sqrt(1.0 - d[0] * d[0] - d[1] * d[1]), d[2]);
        } else if (i % 4 == 1) { /* close to the equator, where x and y are largest */
            d[2] = copysign(acc_log_uniform(a, 1e-8, 1e-2), d[2]);
            double s = sqrt((1.0 - d[2] * d[2]) / (d[0] * d[0] + d[1] * d[1]));
            d[0] *= s;
            d[1] *= s;
        }
        hdrp_v3 n = hdrp_v3_make(acc_float(d[0]), acc_float(d[1]), acc_float(d[2]));
        if (i % 8 >= 4) { /* what normalising makes: shorter or longer by up to 1.2e-7 */
            n = hdrp_v3_normalize(hdrp_v3_scale(n, acc_float(acc_uniform(a, 0.5, 2.0))));
        }
        if (i == 0) { /* the worst that a search found */
            n = hdrp_v3_make(0.989563942f, -0.144093618f, 1.25912334e-06f);
        }
        hdrp_basis f = hdrp_basis_from_normal(n);
        double right = max3(fabs(dot(f.tangent, n)), fabs(dot(f.bitangent, n)),
                            fabs(dot(f.tangent, f.bitangent)));
        double length = acc_larger(fabs(sqrt(dot(f.tangent, f.tangent)) - 1.0),
                                   fabs(sqrt(dot(f.bitangent, f.bitangent)) - 1.0));
        ACC_ADD(a, acc_larger(right, length), "n = (%.9g, %.9g, %.9g)", (double)n.x, (double)n.y,
                (double)n.z);
    }
}

static void v3_length_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        double d[3], length = acc_log_uniform(a, 1.1e-18, 9e18);
        acc_direction(a, d);
        hdrp_v3 v = hdrp_v3_make(acc_float(d[0] * length), acc_float(d[1] * length),
                                 acc_float(d[2] * length));
        ACC_ADD(
            a,
            acc_ulp((double)hdrp_v3_length(v), hypot(hypot((double)v.x, (double)v.y), (double)v.z)),
            "v = (%.9g, %.9g, %.9g)", (double)v.x, (double)v.y, (double)v.z);
    }
}

static void v3_normalize_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        double d[3], length = acc_log_uniform(a, 1.1e-18, 9e17);
        acc_direction(a, d);
        hdrp_v3 v = hdrp_v3_make(acc_float(d[0] * length), acc_float(d[1] * length),
                                 acc_float(d[2] * length));
        double x = (double)v.x, y = (double)v.y, z = (double)v.z, h = hypot(hypot(x, y), z);
        hdrp_v3 n = hdrp_v3_normalize(v);
        ACC_ADD(
            a,
            max3(fabs((double)n.x - x / h), fabs((double)n.y - y / h), fabs((double)n.z - z / h)),
            "v = (%.9g, %.9g, %.9g)", x, y, z);
    }
}

const acc_entry acc_math[] = {
    {"v3_length", v3_length_error},
    {"v3_normalize", v3_normalize_error},
    {"normalize_or", normalize_or_error},
    {"basis", basis_error},
    {NULL, NULL},
};
