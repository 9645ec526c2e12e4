/* acc_env_image.c - accuracy of hdrp_env_image.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include <stdlib.h>

/* acc_env.c compiles the bodies of both headers. */
#include "hdrp_env_image.h"

#define PI 3.14159265358979323846

static double max3(double a, double b, double c)
{
    return acc_larger(a, acc_larger(b, c));
}

/* A float direction: uniform, on an axis, or close to one. */
static hdrp_v3 any_direction(acc* a, int i)
{
    double d[3];
    acc_direction(a, d);
    if (i % 3 == 0) {
        double s = acc_log_uniform(a, 1e-9, 1.0);
        d[i % 2 ? 0 : 1] *= s;
        d[2] *= s;
    }
    if (i % 16 == 0) {
        d[i / 16 % 3] = 0.0;
        d[i / 48 % 3] = 0.0;
    }
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (length == 0.0) {
        return hdrp_v3_make(0.0f, -1.0f, 0.0f);
    }
    return hdrp_v3_make(acc_float(d[0] / length), acc_float(d[1] / length),
                        acc_float(d[2] / length));
}

static uint32_t any_below(acc* a, uint32_t end)
{
    return (uint32_t)(acc_random_bits(a) % end);
}

/* Angles as twice the arc tangent of half of them, by chords. */
static void latlong_uv_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_v3 d = any_direction(a, i);
        hdrp_v2 uv = hdrp_env_latlong_from_direction(d);
        double x = (double)d.x, y = (double)d.y, z = (double)d.z;
        double length = sqrt(x * x + y * y + z * z), across = hypot(x, z);
        double polar = 2.0 * atan2(hypot(across, y - length), hypot(across, y + length));
        double longitude =
            across == 0.0 ? 0.0 : 2.0 * atan2(hypot(x, z - across), hypot(x, z + across));
        double u = 0.5 - copysign(longitude, x) / (2.0 * PI);
        double du = fabs((double)uv.x - u);
        du = fmin(du, fabs(1.0 - du)) * sin(polar);
        ACC_ADD(a, acc_larger(du, fabs((double)uv.y - polar / PI)), "d = (%.9g, %.9g, %.9g)", x, y,
                z);
    }
}

/* Sines and cosines as rational functions of the tangent of half the angle. */
static void latlong_direction_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_v2 uv =
            hdrp_v2_make(acc_float(acc_uniform(a, 0.0, 1.0)), acc_float(acc_uniform(a, 0.0, 1.0)));
        if (i < 81) {
            uv = hdrp_v2_make(acc_float(i % 9) / 8.0f, acc_float(i / 9) / 8.0f);
        }
        hdrp_v3 d = hdrp_env_direction_from_latlong(uv);
        double p = tan(0.5 * PI * (double)uv.y), q = tan(PI * (0.5 - (double)uv.x));
        double across = 2.0 / (1.0 / p + p), up = 2.0 / (1.0 + p * p) - 1.0;
        ACC_ADD(a,
                max3(fabs((double)d.y - up), fabs((double)d.x - across * 2.0 / (1.0 / q + q)),
                     fabs((double)d.z - across * (2.0 / (1.0 + q * q) - 1.0))),
                "uv = (%.9g, %.9g)", (double)uv.x, (double)uv.y);
    }
}

/* Right, down and outward of each face, from the table of the Vulkan specification. */
static const double face_axes[6][3][3] = {
    {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
    {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cube_place_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_v3 f = any_direction(a, i);
        double d[3] = {(double)f.x, (double)f.y, (double)f.z};
        hdrp_env_place place = hdrp_env_cube_from_direction(f);
        int best = 0;
        for (int face = 1; face < 6; ++face) {
            best = dot(face_axes[face][2], d) > dot(face_axes[best][2], d) ? face : best;
        }
        double outward = dot(face_axes[place.face][2], d);
        double u = 0.5 + 0.5 * dot(face_axes[place.face][0], d) / outward;
        double v = 0.5 + 0.5 * dot(face_axes[place.face][1], d) / outward;
        double wrong_face = outward < dot(face_axes[best][2], d) ? 1.0 : 0.0;
        ACC_ADD(a, max3(wrong_face, fabs((double)place.u - u), fabs((double)place.v - v)),
                "d = (%.9g, %.9g, %.9g)", d[0], d[1], d[2]);
    }
}

static void cube_direction_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_env_place place;
        place.face = (hdrp_u32)(i % 6);
        place.u = i < 54 ? acc_float(i / 6 % 3) / 2.0f : acc_float(acc_uniform(a, 0.0, 1.0));
        place.v = i < 54 ? acc_float(i / 18) / 2.0f : acc_float(acc_uniform(a, 0.0, 1.0));
        hdrp_v3 d = hdrp_env_direction_from_cube(place);
        double p[3];
        for (int k = 0; k < 3; ++k) {
            p[k] = face_axes[place.face][0][k] * (2.0 * (double)place.u - 1.0) +
                   face_axes[place.face][1][k] * (2.0 * (double)place.v - 1.0) +
                   face_axes[place.face][2][k];
        }
        double length = sqrt(dot(p, p));
        ACC_ADD(a,
                max3(fabs((double)d.x - p[0] / length), fabs((double)d.y - p[1] / length),
                     fabs((double)d.z - p[2] / length)),
                "face %u (%.9g, %.9g)", place.face, (double)place.u, (double)place.v);
    }
}

/* Both figures of ImfEnvmap.h, as right, down and outward. */
static void openexr_place_error(acc* a)
{
    static const double openexr_axes[6][2][3] = {
        {{0, 0, 1}, {0, -1, 0}}, {{0, 0, -1}, {0, -1, 0}}, {{1, 0, 0}, {0, 0, -1}},
        {{1, 0, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}}, {{1, 0, 0}, {0, -1, 0}},
    };
    for (int i = 0; i < 60000; ++i) {
        hdrp_v3 f = any_direction(a, i);
        double d[3] = {(double)f.x, (double)f.y, (double)f.z};
        hdrp_env_place ours = hdrp_env_cube_from_direction(f);
        hdrp_env_place theirs = hdrp_env_cube_from_openexr(ours);
        double outward = dot(face_axes[ours.face][2], d);
        double u = 0.5 + 0.5 * dot(openexr_axes[ours.face][0], d) / outward;
        double v = 0.5 + 0.5 * dot(openexr_axes[ours.face][1], d) / outward;
        ACC_ADD(a, acc_larger(fabs((double)theirs.u - u), fabs((double)theirs.v - v)),
                "d = (%.9g, %.9g, %.9g)", d[0], d[1], d[2]);
    }
}

/* Sizes from 1 to the largest, and a texel: at random, or one of those around an edge or the
 * middle, where rounding is worst. */
static void any_texel(acc* a, uint32_t size, uint32_t* x)
{
    uint32_t special[6] = {0u, 1u, size / 2u, (size - 1u) / 2u, size - 1u, any_below(a, size)};
    *x = special[any_below(a, 6u)];
    *x = *x < size ? *x : size - 1u;
}

static uint32_t any_size(acc* a, double largest)
{
    uint32_t n = (uint32_t)acc_log_uniform(a, 1.0, largest + 0.9);
    if (any_below(a, 3u) == 0u) {
        for (uint32_t k = 1u; k <= (uint32_t)largest; k *= 2u) {
            if (k >= n) {
                return k;
            }
        }
    }
    return n;
}

/* Differences of antiderivatives, which long double has the digits for. */
static void latlong_solid_angle_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        uint32_t w = any_size(a, 65536.0), h = any_size(a, 65536.0), y;
        any_texel(a, h, &y);
        long double upper = (long double)PI * y / h, lower = (long double)PI * (y + 1.0L) / h;
        double reference = (double)(2.0L * (long double)PI / w * (cosl(upper) - cosl(lower)));
        ACC_ADD(a, acc_relative((double)hdrp_env_latlong_solid_angle(y, w, h), reference),
                "row %u of %u x %u", y, w, h);
    }
}

static void latlong_cosine_weight_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        uint32_t w = any_size(a, 65536.0), h = any_size(a, 65536.0), y;
        any_texel(a, h, &y);
        long double horizon = 0.5L * (long double)PI;
        long double upper = fminl((long double)PI * y / h, horizon);
        long double lower = fminl((long double)PI * (y + 1.0L) / h, horizon);
        long double s = sinl(lower), t = sinl(upper);
        double reference = 2u * y >= h ? 0.0 : (double)((long double)PI / w * (s * s - t * t));
        ACC_ADD(a, acc_relative((double)hdrp_env_latlong_cosine_weight(y, w, h), reference),
                "row %u of %u x %u", y, w, h);
    }
}

static long double corner(long double s, long double t)
{
    return atan2l(s * t, sqrtl(s * s + t * t + 1.0L));
}

static double cube_solid_angle(uint32_t x, uint32_t y, uint32_t n)
{
    long double s0 = 2.0L * x / n - 1.0L, s1 = 2.0L * (x + 1.0L) / n - 1.0L;
    long double t0 = 2.0L * y / n - 1.0L, t1 = 2.0L * (y + 1.0L) / n - 1.0L;
    return (double)(corner(s0, t0) - corner(s0, t1) - corner(s1, t0) + corner(s1, t1));
}

static void cube_solid_angle_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        uint32_t n = any_size(a, 65536.0), x, y;
        any_texel(a, n, &x);
        any_texel(a, n, &y);
        ACC_ADD(a,
                acc_relative((double)hdrp_env_cube_solid_angle(x, y, n), cube_solid_angle(x, y, n)),
                "texel (%u, %u) of %u", x, y, n);
    }
}

/* Gauss-Legendre quadrature of f over a rectangle cut into parts. */
static double quadrature(double (*f)(double s, double t), double s0, double s1, double t0,
                         double t1, int parts)
{
    static const double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                   0.9602898564975363};
    static const double weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                     0.1012285362903763};
    double sum = 0.0, ds = (s1 - s0) / parts, dt = (t1 - t0) / parts;
    for (int part = 0; part < parts * parts; ++part) {
        double s = s0 + (part % parts + 0.5) * ds, t = t0 + (part / parts + 0.5) * dt;
        for (int k = 0; k < 64; ++k) {
            int i = k % 8, j = k / 8;
            double p = (i % 2 ? -0.5 : 0.5) * node[i / 2] * ds;
            double q = (j % 2 ? -0.5 : 0.5) * node[j / 2] * dt;
            sum += weight[i / 2] * weight[j / 2] * f(s + p, t + q);
        }
    }
    return 0.25 * ds * dt * sum;
}

static double top_integrand(double s, double t)
{
    double r2 = 1.0 + s * s + t * t;
    return 1.0 / (r2 * r2);
}

static double side_integrand(double s, double t)
{
    double r2 = 1.0 + s * s + t * t;
    return -t / (r2 * r2);
}

static double cosine_weight(uint32_t face, uint32_t x, uint32_t y, uint32_t n)
{
    double s0 = 2.0 * x / n - 1.0, s1 = 2.0 * (x + 1.0) / n - 1.0;
    double t0 = 2.0 * y / n - 1.0, t1 = 2.0 * (y + 1.0) / n - 1.0;
    int parts = n < 16u ? 4 : 1;
    if (face == 2u) {
        return quadrature(top_integrand, s0, s1, t0, t1, parts);
    }
    if (face == 3u || t0 >= 0.0) {
        return 0.0;
    }
    return quadrature(side_integrand, s0, s1, t0, fmin(t1, 0.0), parts);
}

static void cube_cosine_weight_error(acc* a)
{
    for (int i = 0; i < 20000; ++i) {
        uint32_t n = any_size(a, 65536.0), face = any_below(a, 6u), x, y;
        any_texel(a, n, &x);
        any_texel(a, n, &y);
        ACC_ADD(a,
                acc_relative((double)hdrp_env_cube_cosine_weight(face, x, y, n),
                             cosine_weight(face, x, y, n)),
                "face %u texel (%u, %u) of %u", face, x, y, n);
    }
}

/* An image of random texels with a few bright ones. */
static hdrp_env_image random_image(acc* a, int cube, uint32_t width, uint32_t height, float* texels)
{
    hdrp_env_image image = {0};
    image.texels = texels;
    image.width = width;
    image.height = cube ? width : height;
    image.kind = cube ? HDRP_ENV_CUBE : HDRP_ENV_LATLONG;
    for (uint32_t i = 0; i < 3u * image.width * hdrp_env_image_rows(&image); ++i) {
        texels[i] = acc_float(acc_log_uniform(a, 1e-2, i % 97u ? 1e1 : 1e6));
    }
    return image;
}

/* Illuminance and mean, with texel weights by quadrature and long double. */
static void measure_error(acc* a)
{
    float* texels = malloc(sizeof(float) * 3u * 64u * 64u * 6u);
    for (int i = 0; i < 60 && texels; ++i) {
        int cube = i % 2;
        uint32_t w = any_size(a, cube ? 24.0 : 64.0), h = cube ? w : any_size(a, 64.0);
        hdrp_env_image image = random_image(a, cube, w, h, texels);
        hdrp_env_stats stats;
        double lux[3] = {0.0, 0.0, 0.0}, flux[3] = {0.0, 0.0, 0.0};
        if (hdrp_env_measure(&image, &stats) != HDRP_OK) {
            ACC_ADD(a, 1.0, "measure failed for %u x %u", w, h);
        }
        for (uint32_t k = 0; k < w * hdrp_env_image_rows(&image); ++k) {
            uint32_t x = k % w, y = k / w % h, face = k / w / h;
            double polar0 = PI * y / h, polar1 = PI * (y + 1.0) / h;
            double cosine =
                PI / w *
                (pow(sin(fmin(polar1, 0.5 * PI)), 2.0) - pow(sin(fmin(polar0, 0.5 * PI)), 2.0));
            double solid_angle = 2.0 * PI / w * (cos(polar0) - cos(polar1));
            if (cube) {
                cosine = cosine_weight(face, x, y, w);
                solid_angle = cube_solid_angle(x, y, w);
            }
            for (int c = 0; c < 3; ++c) {
                lux[c] += cosine * (double)texels[3u * k + (uint32_t)c];
                flux[c] += solid_angle * (double)texels[3u * k + (uint32_t)c];
            }
        }
        for (int c = 0; c < 3; ++c) {
            double error =
                acc_larger(acc_relative(stats.illuminance_lux_rgb[c], lux[c]),
                           acc_relative(stats.average_nits_rgb[c], flux[c] / (4.0 * PI)));
            ACC_ADD(a, error, "%s %u x %u channel %d", cube ? "cube" : "lat-long", w, h, c);
        }
    }
    free(texels);
}

/* A sky with a round sun and its glow: the light that was taken out and what remains must add up
 * to what was there. */
static void remove_sun_error(acc* a)
{
    float* texels = malloc(sizeof(float) * 3u * 256u * 128u);
    for (int i = 0; i < 24 && texels; ++i) {
        int cube = i % 3 == 0;
        uint32_t w = cube ? 64u : 256u, h = cube ? 64u : 128u;
        hdrp_env_image image = random_image(a, cube, w, h, texels);
        double elevation = acc_uniform(a, 0.1, 1.5), azimuth = acc_uniform(a, 0.0, 2.0 * PI);
        double s[3] = {cos(elevation) * sin(azimuth), sin(elevation),
                       cos(elevation) * cos(azimuth)};
        double radius = acc_uniform(a, 0.002, 0.03);
        for (uint32_t k = 0; k < w * hdrp_env_image_rows(&image); ++k) {
            hdrp_env_place place = {k / w / h, (acc_float(k % w) + 0.5f) / (float)w,
                                    (acc_float(k / w % h) + 0.5f) / (float)h};
            hdrp_v3 d = cube ? hdrp_env_direction_from_cube(place)
                             : hdrp_env_direction_from_latlong(hdrp_v2_make(place.u, place.v));
            double q = pow((double)d.x - s[0], 2.0) + pow((double)d.y - s[1], 2.0) +
                       pow((double)d.z - s[2], 2.0);
            double glow = 1e6 / (1.0 + pow(q / (radius * radius), 2.0));
            for (int c = 0; c < 3; ++c) {
                texels[3u * k + (uint32_t)c] =
                    acc_float(1.0 + (double)d.y * 0.5 + glow / (c + 1.0));
            }
        }
        hdrp_env_stats before, after;
        hdrp_env_sun sun;
        hdrp_env_measure(&image, &before);
        hdrp_env_find_sun(&image, 0.0f, &sun);
        hdrp_env_remove_sun(&image, &sun);
        hdrp_env_measure(&image, &after);
        double direct = 0.2126 * (double)sun.illuminance_lux.x +
                        0.7152 * (double)sun.illuminance_lux.y +
                        0.0722 * (double)sun.illuminance_lux.z;
        double sum = after.illuminance_lux + direct * (double)sun.direction.y;
        ACC_ADD(a, acc_relative(sum, before.illuminance_lux), "%s elevation %.3g radius %.3g",
                cube ? "cube" : "lat-long", elevation, radius);
    }
    free(texels);
}

const acc_entry acc_env_image[] = {
    {"env_latlong_uv", latlong_uv_error},
    {"env_latlong_direction", latlong_direction_error},
    {"env_cube_place", cube_place_error},
    {"env_cube_direction", cube_direction_error},
    {"env_openexr_place", openexr_place_error},
    {"env_latlong_solid_angle", latlong_solid_angle_error},
    {"env_latlong_cosine_weight", latlong_cosine_weight_error},
    {"env_cube_solid_angle", cube_solid_angle_error},
    {"env_cube_cosine_weight", cube_cosine_weight_error},
    {"env_measure", measure_error},
    {"env_remove_sun", remove_sun_error},
    {NULL, NULL},
};
