/* acc_math_surface.c - accuracy of the surface gradients of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_math.h"

#define PI 3.14159265358979323846

typedef struct vec {
    double v[3];
} vec;

static vec vec_make(double x, double y, double z)
{
    vec r = {{x, y, z}};
    return r;
}

static vec vec_of(hdrp_v3 a)
{
    return vec_make((double)a.x, (double)a.y, (double)a.z);
}

static hdrp_v3 rounded(vec a)
{
    return hdrp_v3_make((float)a.v[0], (float)a.v[1], (float)a.v[2]);
}

/* a + b s */
static vec mad(vec a, vec b, double s)
{
    return vec_make(a.v[0] + b.v[0] * s, a.v[1] + b.v[1] * s, a.v[2] + b.v[2] * s);
}

static vec scaled(vec a, double s)
{
    return mad(vec_make(0.0, 0.0, 0.0), a, s);
}

static double dot(vec a, vec b)
{
    return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

static vec cross(vec a, vec b)
{
    return vec_make(a.v[1] * b.v[2] - a.v[2] * b.v[1], a.v[2] * b.v[0] - a.v[0] * b.v[2],
                    a.v[0] * b.v[1] - a.v[1] * b.v[0]);
}

static double length(vec a)
{
    return sqrt(dot(a, a));
}

static vec normalized(vec a)
{
    return scaled(a, 1.0 / length(a));
}

static double distance(hdrp_v3 measured, vec reference)
{
    return length(mad(vec_of(measured), reference, -1.0));
}

static double largest_difference(hdrp_v3 measured, vec reference)
{
    vec d = mad(vec_of(measured), reference, -1.0);
    return acc_larger(fabs(d.v[0]), acc_larger(fabs(d.v[1]), fabs(d.v[2])));
}

static double degrees_between(hdrp_v3 measured, vec reference)
{
    vec m = vec_of(measured);
    return acc_degrees(m.v, reference.v);
}

static vec direction(acc* a)
{
    vec r;
    acc_direction(a, r.v);
    return r;
}

/* A unit normal as the library receives it, rounded, and two unit tangents of that. */
static hdrp_v3 random_normal(acc* a, vec* n, vec* t, vec* b)
{
    hdrp_v3 f = rounded(direction(a));
    *n = normalized(vec_of(f));
    *t = normalized(cross(*n, direction(a)));
    *b = cross(*n, *t);
    return f;
}

static void surface_frame_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        hdrp_v3 n = rounded(scaled(direction(a), acc_log_uniform(a, 1e-9, 1e9)));
        hdrp_v3 t = rounded(scaled(direction(a), acc_log_uniform(a, 1e-3, 1e9)));
        double side = i % 2 ? 1.0 : -1.0;
        hdrp_surface_frame f = hdrp_surface_frame_from_vertex(n, t, (float)side);
        vec unit = normalized(vec_of(n)), tangent = scaled(vec_of(t), 1.0 / length(vec_of(n)));
        vec bitangent = scaled(cross(unit, vec_of(t)), side);
        double error = distance(f.normal, unit);
        error = acc_larger(error, distance(f.tangent, tangent) / length(tangent));
        error = acc_larger(error, distance(f.bitangent, bitangent) / length(vec_of(t)));
        ACC_ADD(a, error, "n = (%.9g, %.9g, %.9g)", (double)n.x, (double)n.y, (double)n.z);
    }
}

/* The projected parallelogram is the parallelogram seen along the normal. */
static void surface_footprint_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        vec n, t, b;
        hdrp_v3 normal = random_normal(a, &n, &t, &b);
        hdrp_v3 x = rounded(scaled(direction(a), acc_log_uniform(a, 1e-6, 1e6)));
        hdrp_v3 y = rounded(scaled(direction(a), acc_log_uniform(a, 1e-6, 1e6)));
        double product = length(vec_of(x)) * length(vec_of(y));
        double reference = dot(n, cross(vec_of(x), vec_of(y)));
        if (fabs(reference) > 1e-5 * product) {
            hdrp_surface_footprint f = hdrp_surface_footprint_from_position(normal, x, y);
            ACC_ADD(a, fabs((double)f.area - reference) / product, "x = (%.9g, %.9g, %.9g)",
                    (double)x.x, (double)x.y, (double)x.z);
        }
    }
}

/* An affine map of the plane: dp = pu du + pv dv, with random, skewed and mirrored pu and pv. */
typedef struct surface_map {
    vec n, pu, pv;
    hdrp_v3 normal, dp_dx, dp_dy;
    hdrp_v2 duv_dx, duv_dy;
} surface_map;

static surface_map random_map(acc* a)
{
    surface_map m;
    vec t, b;
    double angle = acc_uniform(a, 0.1, PI - 0.1), turn = acc_uniform(a, 0.1, PI - 0.1);
    double start = acc_uniform(a, 0.0, 2.0 * PI), step = acc_log_uniform(a, 1e-5, 1e2);
    double stretch = acc_log_uniform(a, 0.5, 2.0), side = acc_uniform(a, -1.0, 1.0);
    m.normal = random_normal(a, &m.n, &t, &b);
    angle = copysign(angle, side);
    m.pu = scaled(t, acc_log_uniform(a, 1e-3, 1e3));
    m.pv = scaled(mad(scaled(t, cos(angle)), b, sin(angle)), length(m.pu) * stretch);
    turn = acc_uniform(a, -1.0, 1.0) < 0.0 ? -turn : turn;
    m.duv_dx = hdrp_v2_make(acc_float(step * cos(start)), acc_float(step * sin(start)));
    m.duv_dy =
        hdrp_v2_make(acc_float(step * cos(start + turn)), acc_float(step * sin(start + turn)));
    m.dp_dx = rounded(mad(scaled(m.pu, (double)m.duv_dx.x), m.pv, (double)m.duv_dx.y));
    m.dp_dy = rounded(mad(scaled(m.pu, (double)m.duv_dy.x), m.pv, (double)m.duv_dy.y));
    return m;
}

static void basis_from_uv_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        surface_map m = random_map(a);
        hdrp_surface_footprint f = hdrp_surface_footprint_from_position(m.normal, m.dp_dx, m.dp_dy);
        hdrp_basis basis = hdrp_basis_from_uv(f, m.duv_dx, m.duv_dy);
        vec bitangent = mad(m.pv, m.pu, -dot(m.pu, m.pv) / dot(m.pu, m.pu));
        ACC_ADD(a,
                acc_larger(degrees_between(basis.tangent, m.pu),
                           degrees_between(basis.bitangent, bitangent)),
                "duv_dx = (%.9g, %.9g)", (double)m.duv_dx.x, (double)m.duv_dx.y);
    }
}

/* A height that grows along a direction g of space. */
static void surface_gradient_height_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        surface_map m = random_map(a);
        vec x = vec_of(m.dp_dx), y = vec_of(m.dp_dy);
        double sine = length(cross(x, y)) / (length(x) * length(y));
        vec g = scaled(normalized(cross(m.n, direction(a))), acc_log_uniform(a, 1e-2, 1e2));
        if (sine > 0.0998) { /* 0.1 rad */
            hdrp_surface_footprint f =
                hdrp_surface_footprint_from_position(m.normal, m.dp_dx, m.dp_dy);
            hdrp_v3 measured =
                hdrp_surface_gradient_from_height(f, (float)dot(g, x), (float)dot(g, y));
            ACC_ADD(a, distance(measured, g) / length(g), "dp_dx = (%.9g, %.9g, %.9g)",
                    (double)m.dp_dx.x, (double)m.dp_dx.y, (double)m.dp_dx.z);
        }
    }
}

static void normal_from_xy_errors(acc* a, double smallest_z)
{
    for (int i = 0; i < 400000; ++i) {
        double z = acc_uniform(a, smallest_z, 1.0), turn = acc_uniform(a, 0.0, 2.0 * PI);
        z = i % 2 && smallest_z == 0.0 ? z * z * z * z : z;
        double radius = sqrt(1.0 - z * z);
        float x = acc_float(radius * cos(turn)), y = acc_float(radius * sin(turn));
        double d = (double)x * (double)x + (double)y * (double)y;
        vec reference = vec_make((double)x, (double)y, sqrt(acc_larger(1.0 - d, 0.0)));
        ACC_ADD(a, degrees_between(hdrp_normal_from_xy(x, y), reference), "(%.9g, %.9g)", (double)x,
                (double)y);
    }
}

static void normal_from_xy_error(acc* a)
{
    normal_from_xy_errors(a, 0.0);
}

static void normal_from_xy_upright_error(acc* a)
{
    normal_from_xy_errors(a, 0.1);
}

static void normal_from_rgb_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        vec c = vec_make(acc_uniform(a, 0.0, 1.0), acc_uniform(a, 0.0, 1.0), (i % 256) / 255.0);
        hdrp_v3 rgb = rounded(c);
        vec reference = vec_make((double)rgb.x * 2.0 - 1.0, (double)rgb.y * 2.0 - 1.0,
                                 (double)rgb.z * 2.0 - 1.0);
        ACC_ADD(a, largest_difference(hdrp_normal_from_rgb(rgb), reference), "(%.9g, %.9g, %.9g)",
                (double)rgb.x, (double)rgb.y, (double)rgb.z);
    }
}

/* The slope of a plane is the tangent of the angle between its normal and the axis. */
static void derivative_from_normal_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        hdrp_v3 v = rounded(scaled(direction(a), acc_log_uniform(a, 1e-9, 1e9)));
        double scale = acc_log_uniform(a, 1e-3, 1e3), turn = atan2((double)v.y, (double)v.x);
        double across = hypot((double)v.x, (double)v.y);
        double slope = tan(fmin(atan2(across, (double)v.z), atan(128.0))) * (double)(float)scale;
        hdrp_v2 d = hdrp_derivative_from_normal(v, (float)scale);
        double error = hypot((double)d.x + slope * cos(turn), (double)d.y + slope * sin(turn));
        ACC_ADD(a, error / slope, "v = (%.9g, %.9g, %.9g)", (double)v.x, (double)v.y, (double)v.z);
    }
}

static void derivative_from_heights_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        float left = acc_float(acc_uniform(a, -1.0, 1.0)),
              right = acc_float(acc_uniform(a, -1.0, 1.0));
        float s = acc_float(acc_log_uniform(a, 1e-9, 1e9));
        hdrp_v2 d = hdrp_derivative_from_heights(left, right, right, left, hdrp_v2_make(s, s));
        double slope = ((double)right - (double)left) / (2.0 * (double)s);
        ACC_ADD(a, acc_larger(acc_relative((double)d.x, slope), acc_relative((double)d.y, -slope)),
                "%.9g, %.9g, spacing %.9g", (double)left, (double)right, (double)s);
    }
}

static void surface_gradient_derivative_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        hdrp_v3 t = rounded(scaled(direction(a), acc_log_uniform(a, 1e-2, 1e2)));
        hdrp_v3 b = rounded(scaled(direction(a), acc_log_uniform(a, 1e-2, 1e2)));
        hdrp_v2 d = hdrp_v2_make(acc_float(acc_uniform(a, -128.0, 128.0)),
                                 acc_float(acc_uniform(a, -1.0, 1.0)));
        vec x = scaled(vec_of(t), (double)d.x), y = scaled(vec_of(b), (double)d.y);
        ACC_ADD(a,
                distance(hdrp_surface_gradient_from_derivative(d, t, b), mad(x, y, 1.0)) /
                    (length(x) + length(y)),
                "d = (%.9g, %.9g)", (double)d.x, (double)d.y);
    }
}

/* There and back: the gradient of a normal resolves to that normal. */
static void surface_gradient_normal_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        vec n, t, b;
        hdrp_v3 normal = random_normal(a, &n, &t, &b);
        double angle = i % 2 ? acc_uniform(a, 0.0, 1.5628) : acc_log_uniform(a, 1e-6, 1.5628);
        vec v = mad(scaled(n, cos(angle)), t, sin(angle));
        hdrp_v3 other = rounded(scaled(v, acc_log_uniform(a, 1e-20, 1e20)));
        hdrp_v3 g = hdrp_surface_gradient_from_normal(normal, other);
        ACC_ADD(a, degrees_between(hdrp_normal_from_surface_gradient(normal, g), vec_of(other)),
                "at %.9g degrees from n", angle * 180.0 / PI);
    }
}

static void surface_gradient_volume_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        vec n, t, b;
        hdrp_v3 normal = random_normal(a, &n, &t, &b);
        hdrp_v3 g = rounded(scaled(direction(a), acc_log_uniform(a, 1e-9, 1e9)));
        vec reference = mad(scaled(t, dot(t, vec_of(g))), b, dot(b, vec_of(g)));
        ACC_ADD(a,
                distance(hdrp_surface_gradient_from_volume(normal, g), reference) /
                    length(vec_of(g)),
                "n = (%.9g, %.9g, %.9g)", (double)normal.x, (double)normal.y, (double)normal.z);
    }
}

static void triplanar_weights_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        vec n = direction(a);
        float sharpness = acc_float(acc_log_uniform(a, 1.0, 64.0));
        hdrp_v3 v = rounded(scaled(n, acc_log_uniform(a, 1e-20, 1e20)));
        double l[3] = {log(fabs((double)v.x)), log(fabs((double)v.y)), log(fabs((double)v.z))};
        double top = acc_larger(l[0], acc_larger(l[1], l[2])), s = (double)sharpness;
        vec w = vec_make(exp(s * (l[0] - top)), exp(s * (l[1] - top)), exp(s * (l[2] - top)));
        double sum = w.v[0] + w.v[1] + w.v[2];
        ACC_ADD(a, largest_difference(hdrp_triplanar_weights(v, sharpness), scaled(w, 1.0 / sum)),
                "sharpness %.9g", s);
    }
}

/* Heights that are linear in each look-up, h = w (s u + t v), so that their change along a tangent
 * follows from evaluating them at both ends. */
static void surface_gradient_triplanar_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        vec n, t, b;
        hdrp_v3 normal = random_normal(a, &n, &t, &b);
        hdrp_v3 w = rounded(
            vec_make(acc_uniform(a, 0.0, 1.0), acc_uniform(a, 0.0, 1.0), acc_uniform(a, 0.0, 1.0)));
        hdrp_v2 d[3];
        double slope[2] = {0.0, 0.0}, largest = 0.0;
        static const int look_up[3][2] = {{2, 1}, {0, 2}, {0, 1}};
        for (int k = 0; k < 3; ++k) {
            d[k] = hdrp_v2_make(acc_float(acc_uniform(a, -4.0, 4.0)),
                                acc_float(acc_uniform(a, -4.0, 4.0)));
            double s = (double)d[k].x, r = (double)d[k].y, weight = vec_of(w).v[k];
            slope[0] += weight * (s * t.v[look_up[k][0]] + r * t.v[look_up[k][1]]);
            slope[1] += weight * (s * b.v[look_up[k][0]] + r * b.v[look_up[k][1]]);
            largest = acc_larger(largest, hypot(s, r));
        }
        vec reference = mad(scaled(t, slope[0]), b, slope[1]);
        hdrp_v3 g = hdrp_surface_gradient_from_triplanar(normal, w, d[0], d[1], d[2]);
        ACC_ADD(a, distance(g, reference) / largest, "n = (%.9g, %.9g, %.9g)", (double)normal.x,
                (double)normal.y, (double)normal.z);
    }
}

/* A tangent-plane gradient of length s leans the normal by atan s. */
static void normal_from_surface_gradient_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        vec n, t, b;
        hdrp_v3 normal = random_normal(a, &n, &t, &b);
        hdrp_v3 g = rounded(scaled(t, acc_log_uniform(a, 1e-6, 1e4)));
        double lean = atan(length(vec_of(g)));
        vec reference = mad(scaled(n, cos(lean)), normalized(vec_of(g)), -sin(lean));
        ACC_ADD(a, largest_difference(hdrp_normal_from_surface_gradient(normal, g), reference),
                "slope %.9g", tan(lean));
    }
}

static void normal_from_surface_gradient_unclamped_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        vec n, t, b;
        hdrp_v3 normal = random_normal(a, &n, &t, &b);
        hdrp_v3 g = rounded(scaled(direction(a), acc_log_uniform(a, 1e-6, 1e4)));
        vec reference = normalized(mad(vec_of(normal), vec_of(g), -1.0));
        if (length(mad(n, vec_of(g), -1.0)) > 0.5) {
            ACC_ADD(a,
                    largest_difference(hdrp_normal_from_surface_gradient_unclamped(normal, g),
                                       reference),
                    "slope %.9g", length(vec_of(g)));
        }
    }
}

const acc_entry acc_math_surface[] = {
    {"surface_frame", surface_frame_error},
    {"surface_footprint", surface_footprint_error},
    {"basis_from_uv", basis_from_uv_error},
    {"normal_from_xy", normal_from_xy_error},
    {"normal_from_xy_upright", normal_from_xy_upright_error},
    {"normal_from_rgb", normal_from_rgb_error},
    {"derivative_from_normal", derivative_from_normal_error},
    {"derivative_from_heights", derivative_from_heights_error},
    {"surface_gradient_derivative", surface_gradient_derivative_error},
    {"surface_gradient_normal", surface_gradient_normal_error},
    {"surface_gradient_volume", surface_gradient_volume_error},
    {"surface_gradient_height", surface_gradient_height_error},
    {"triplanar_weights", triplanar_weights_error},
    {"surface_gradient_triplanar", surface_gradient_triplanar_error},
    {"normal_from_surface_gradient", normal_from_surface_gradient_error},
    {"normal_from_surface_gradient_unclamped", normal_from_surface_gradient_unclamped_error},
    {NULL, NULL},
};
