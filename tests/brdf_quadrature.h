/* brdf_quadrature.h - integrals over the hemisphere of functions that peak where GGX lobes do.
 * SPDX-License-Identifier: MIT
 *
 * Nodes are half vectors: polar angles gathered at the normal on the scale of a width. For each
 * azimuth the polar angle ends exactly where the light reaches the horizon, so that the integrand
 * is smooth on every segment, and nodes are gathered there too. */
#ifndef BRDF_QUADRATURE_H
#define BRDF_QUADRATURE_H

#include <math.h>

#define BQ_PI         3.14159265358979323846
#define BQ_MAX_POLAR  256
#define BQ_MAX_POINTS 262144

typedef struct bq_point {
    double l[3];   /* unit, above the horizon */
    double weight; /* solid angle */
} bq_point;

typedef struct bq_rule {
    int polar, azimuth;                      /* nodes of half a polar range, of a quarter turn */
    double x[BQ_MAX_POLAR], w[BQ_MAX_POLAR]; /* Gauss-Legendre on [0,1] */
    double turn_x[BQ_MAX_POLAR], turn_w[BQ_MAX_POLAR];
} bq_rule;

/* Gauss-Legendre nodes and weights on [0,1], by Newton's method on the Legendre polynomial. */
static inline void bq_gauss_legendre(int n, double* x, double* w)
{
    for (int i = 0; i < n; ++i) {
        double t = cos(BQ_PI * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 8; ++step) {
            double p0 = 1.0, p1 = t;
            for (int j = 2; j <= n; ++j) {
                double p2 = ((2.0 * j - 1.0) * t * p1 - (j - 1.0) * p0) / j;
                p0 = p1;
                p1 = p2;
            }
            slope = n * (t * p1 - p0) / (t * t - 1.0);
            t -= p1 / slope;
        }
        x[i] = 0.5 + 0.5 * t;
        w[i] = 1.0 / ((1.0 - t * t) * slope * slope);
    }
}

static inline bq_rule bq_make(int polar, int azimuth)
{
    bq_rule r;
    r.polar = polar;
    r.azimuth = azimuth;
    bq_gauss_legendre(polar, r.x, r.w);
    bq_gauss_legendre(azimuth, r.turn_x, r.turn_w);
    return r;
}

/* Light directions for a view (theta_v from +Z, azimuth phi_v) and the scale of the narrowest lobe;
 * returns their number, 8 * polar * azimuth. */
static inline int bq_points(const bq_rule* r, double theta_v, double phi_v, double alpha,
                            bq_point* out)
{
    double v[3] = {sin(theta_v) * cos(phi_v), sin(theta_v) * sin(phi_v), cos(theta_v)};
    double scale[2] = {alpha, fmin(alpha, fmax(cos(theta_v), 1e-6))};
    int count = 0;
    for (int j = 0; j < 4 * r->azimuth; ++j) {
        /* Quarter turns, because grazing views make a kink where one ends. */
        double turn = 0.5 * BQ_PI * (j / r->azimuth + r->turn_x[j % r->azimuth]);
        double phi = phi_v + turn, turn_weight = 0.5 * BQ_PI * r->turn_w[j % r->azimuth];
        /* l.z is proportional to cos(2 theta_h - delta). */
        double delta = atan2(sin(theta_v) * cos(turn), cos(theta_v));
        double half = 0.125 * BQ_PI + 0.25 * delta;
        for (int i = 0; i < 2 * r->polar; ++i, ++count) {
            /* From the normal to half way, then from the horizon to half way. */
            double gather = scale[i % 2], top = asinh(half / gather);
            double s = top * r->x[i / 2], from_end = gather * sinh(s);
            double theta = i % 2 ? 2.0 * half - from_end : from_end;
            double h[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
            double c = v[0] * h[0] + v[1] * h[1] + v[2] * h[2];
            for (int k = 0; k < 3; ++k) {
                out[count].l[k] = 2.0 * c * h[k] - v[k];
            }
            out[count].weight =
                4.0 * fabs(c) * sin(theta) * r->w[i / 2] * top * gather * cosh(s) * turn_weight;
        }
    }
    return count;
}

/* D of a normal from its slopes over the widths. */
static inline double bq_d(const double h[3], double at, double ab)
{
    double x = h[0] / at, y = h[1] / ab, s = x * x + y * y + h[2] * h[2];
    return 1.0 / (BQ_PI * at * ab * s * s);
}

/* D V n_dot_l of one pair of directions, and the cosine between light and half vector. */
static inline double bq_specular(const double v[3], const double l[3], double at, double ab,
                                 double* l_dot_h)
{
    double h[3] = {l[0] + v[0], l[1] + v[1], l[2] + v[2]};
    double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    double lambda_l = sqrt(at * at * l[0] * l[0] + ab * ab * l[1] * l[1] + l[2] * l[2]);
    double lambda_v = sqrt(at * at * v[0] * v[0] + ab * ab * v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; ++k) {
        h[k] /= length;
    }
    *l_dot_h = h[0] * l[0] + h[1] * l[1] + h[2] * l[2];
    return bq_d(h, at, ab) * 0.5 * l[2] / (l[2] * lambda_v + v[2] * lambda_l);
}

typedef struct bq_fgd {
    double albedo, schlick;
} bq_fgd;

/* Directional albedo for F = 1 and for Schlick's weight, isotropic. */
static inline bq_fgd bq_integrate_fgd(const bq_rule* r, double n_dot_v, double alpha,
                                      bq_point* scratch)
{
    double theta = acos(n_dot_v), v[3] = {sin(theta), 0.0, n_dot_v}, c;
    int count = bq_points(r, theta, 0.0, alpha, scratch);
    bq_fgd sum = {0.0, 0.0};
    for (int i = 0; i < count; ++i) {
        double f = bq_specular(v, scratch[i].l, alpha, alpha, &c) * scratch[i].weight;
        sum.albedo += f;
        sum.schlick += f * pow(1.0 - fmin(c, 1.0), 5.0);
    }
    return sum;
}

#endif
