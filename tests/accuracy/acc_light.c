/* acc_light.c - accuracy of hdrp_light.h.
 * SPDX-License-Identifier: MIT
 *
 * Solid angles and fluxes are referred to Gauss-Legendre integrals of the emission, attenuations to
 * angles and planes in double. */
#include "accuracy.h"

#include "hdrp_light.h"

#define PI  3.14159265358979323846
#define DEG (PI / 180.0)

typedef double integrand(double x, const double* p);

/* Composite 8-point Gauss-Legendre rule (Abramowitz and Stegun 1964, table 25.4). */
static double integrate(integrand* f, const double* p, double a, double b, int panels)
{
    static const double x[4] = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                0.960289856497536232};
    static const double w[4] = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                0.101228536290376259};
    double sum = 0.0, half = 0.5 * (b - a) / panels;
    for (int i = 0; i < panels; ++i) {
        double middle = a + (2 * i + 1) * half;
        for (int k = 0; k < 4; ++k) {
            sum += w[k] * (f(middle - half * x[k], p) + f(middle + half * x[k], p));
        }
    }
    return sum * half;
}

static double ring(double t, const double* p)
{
    (void)p;
    return 2.0 * PI * sin(t);
}

static double ring_cos(double t, const double* p)
{
    return ring(t, p) * cos(t);
}

static double ring_line(double t, const double* p)
{
    return ring(t, p) * 2.0 * sin(t);
}

static double circle(double r, const double* p)
{
    (void)p;
    return 2.0 * PI * r;
}

static double cone_solid_angle(double half_angle)
{
    return integrate(ring, NULL, 0.0, half_angle, 4);
}

static float log_float(acc* a, double lo, double hi)
{
    return acc_float(acc_log_uniform(a, lo, hi));
}

/* An angle in (0, limit]: small ones by magnitude, large ones evenly, and the ends. */
static float angle(acc* a, int i, double smallest, float limit)
{
    if (i < 2) {
        return i == 0 ? limit : nextafterf(limit, 0.0f);
    }
    float x = acc_float(i % 2 ? acc_uniform(a, 0.0, (double)limit)
                              : acc_log_uniform(a, smallest, (double)limit));
    return fminf(fmaxf(x, acc_float(smallest)), limit);
}

/* A normal number that everyday values, the whole range and its two ends share. */
static float normal_float(acc* a, int i)
{
    double x = i % 4 == 0   ? acc_log_uniform(a, 1e-3, 1e6)
               : i % 4 == 1 ? acc_log_uniform(a, (double)HDRP_FLT_MIN, (double)HDRP_FLT_MAX)
               : i % 4 == 2 ? (double)HDRP_FLT_MAX * acc_uniform(a, 0.05, 1.0)
                            : (double)HDRP_FLT_MIN * acc_uniform(a, 1.0, 20.0);
    return fmaxf(acc_float(x), HDRP_FLT_MIN);
}

static bool is_normal(double x)
{
    return x >= (double)HDRP_FLT_MIN && x <= (double)HDRP_FLT_MAX;
}

/* One of two units and its factor to the other, such that both numbers are normal: any number that
 * allows it, or one whose result is any. 0 where there is none. */
static float unit_value(acc* a, int i, double factor)
{
    double x = (double)normal_float(a, i / 2);
    x = i % 2 ? (double)acc_float(x / factor) : x;
    return is_normal(x) && is_normal(x * factor) ? acc_float(x) : 0.0f;
}

static void candela_point_error(acc* a)
{
    double sphere = cone_solid_angle(PI);
    for (int i = 0; i < 20000; ++i) {
        float lumen = log_float(a, 1e-30, 3.4e38);
        ACC_ADD(a,
                acc_relative((double)hdrp_light_candela_from_lumen_point(lumen),
                             (double)lumen / sphere),
                "%.9g lm", (double)lumen);
    }
}

static void lumen_point_error(acc* a)
{
    double sphere = cone_solid_angle(PI);
    for (int i = 0; i < 20000; ++i) {
        float candela = log_float(a, 1e-30, 2.7e37);
        ACC_ADD(a,
                acc_relative((double)hdrp_light_lumen_from_candela_point(candela),
                             (double)candela * sphere),
                "%.9g cd", (double)candela);
    }
}

static void solid_angle_cone_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float full = angle(a, i, 2e-18, HDRP_TWO_PI);
        double reference = cone_solid_angle(0.5 * (double)full);
        ACC_ADD(a, acc_relative((double)hdrp_light_solid_angle_cone(full), reference), "%.9g rad",
                (double)full);
    }
}

static void spot_reflector_errors(acc* a, bool to_candela)
{
    for (int i = 0; i < 200000; ++i) {
        float full = angle(a, i, (double)HDRP_FLT_MIN, HDRP_TWO_PI);
        double solid_angle = cone_solid_angle(0.5 * (double)full);
        double factor = to_candela ? 1.0 / solid_angle : solid_angle;
        float x = unit_value(a, i / 2, factor);
        float y = to_candela ? hdrp_light_candela_from_lumen_spot_reflector(x, full)
                             : hdrp_light_lumen_from_candela_spot_reflector(x, full);
        ACC_ADD(a, acc_relative((double)y, (double)x * factor), "%.9g at %.9g rad", (double)x,
                (double)full);
    }
}

static void candela_spot_reflector_error(acc* a)
{
    spot_reflector_errors(a, true);
}

static void lumen_spot_reflector_error(acc* a)
{
    spot_reflector_errors(a, false);
}

/* The pyramid as slices around the y axis: a slice at angle t from the yz plane is bounded by
 * sin(latitude), which the upper face limits to p[0] cos t / sqrt(p[1]^2 + (p[0] cos t)^2). */
static double pyramid_slice(double t, const double* p)
{
    double c = p[0] * cos(t);
    return 4.0 * c / sqrt(p[1] * p[1] + c * c);
}

/* Panels shrink towards the last slice, where a face at nearly 90 degrees makes a boundary layer. */
static double pyramid_solid_angle(double full_x, double full_y)
{
    double x = fmin(0.5 * full_x, 0.5 * PI), y = fmin(0.5 * full_y, 0.5 * PI);
    double p[2] = {sin(y), cos(y)}, sum = 0.0, from = 0.0;
    for (int k = 1; k < 40; ++k) {
        double to = k == 39 ? x : x * (1.0 - exp2(-k));
        sum += integrate(pyramid_slice, p, from, to, 1);
        from = to;
    }
    return sum;
}

static void solid_angle_pyramid_error(acc* a)
{
    for (int i = 0; i < 6000; ++i) {
        float x = angle(a, i, 1e-18, HDRP_PI), y = angle(a, i / 2, 1e-18, HDRP_PI);
        double reference = pyramid_solid_angle((double)x, (double)y);
        ACC_ADD(a, acc_relative((double)hdrp_light_solid_angle_pyramid(x, y), reference),
                "%.9g x %.9g rad", (double)x, (double)y);
    }
}

static void pyramid_errors(acc* a, bool to_candela)
{
    for (int i = 0; i < 20000; ++i) {
        double least = i % 8 < 4 ? 1e-9 : (double)HDRP_FLT_MIN;
        float fx = angle(a, i, least, HDRP_PI), fy = angle(a, i / 2, least, HDRP_PI);
        double solid_angle = pyramid_solid_angle((double)fx, (double)fy);
        double factor = to_candela ? 1.0 / solid_angle : solid_angle;
        float x = unit_value(a, i / 4, factor);
        x = to_candela ? x : fminf(x, 5e37f);
        float y = to_candela ? hdrp_light_candela_from_lumen_pyramid(x, fx, fy)
                             : hdrp_light_lumen_from_candela_pyramid(x, fx, fy);
        ACC_ADD(a, acc_relative((double)y, (double)x * factor), "%.9g at %.9g x %.9g rad",
                (double)x, (double)fx, (double)fy);
    }
}

static void candela_pyramid_error(acc* a)
{
    pyramid_errors(a, true);
}

static void lumen_pyramid_error(acc* a)
{
    pyramid_errors(a, false);
}

/* Area lights: flux = luminance * area * the integral of cos over the hemisphere. */

static double sphere_flux(double radius)
{
    return integrate(ring, NULL, 0.0, PI, 8) * radius * radius *
           integrate(ring_cos, NULL, 0.0, 0.5 * PI, 8);
}

static double disc_flux(double radius)
{
    return integrate(circle, NULL, 0.0, radius, 1) * integrate(ring_cos, NULL, 0.0, 0.5 * PI, 8);
}

static double rectangle_flux(double side)
{
    return side * (0.5 * side) * integrate(ring_cos, NULL, 0.0, 0.5 * PI, 8);
}

static double line_flux(double length)
{
    return length * integrate(ring_line, NULL, 0.0, PI, 8);
}

static double isotropic_line_flux(double length)
{
    return length * integrate(ring, NULL, 0.0, PI, 8);
}

typedef float area_function(float value, float size);

static float nits_rectangle(float lumen, float side)
{
    return hdrp_light_nits_from_lumen_rectangle(lumen, side, side * 0.5f);
}

static float lumen_rectangle(float nits, float side)
{
    return hdrp_light_lumen_from_nits_rectangle(nits, side, side * 0.5f);
}

static void area_errors(acc* a, area_function* f, double (*flux)(double), bool to_luminance)
{
    for (int i = 0; i < 5000; ++i) {
        float value = log_float(a, 1e-3, to_luminance ? 1e24 : 1e12);
        float size = log_float(a, 2e-6, 1e12);
        double emitted = flux((double)size);
        double reference = to_luminance ? (double)value / emitted : (double)value * emitted;
        ACC_ADD(a, acc_relative((double)f(value, size), reference), "%.9g, size %.9g m",
                (double)value, (double)size);
    }
}

static void nits_sphere_error(acc* a)
{
    area_errors(a, hdrp_light_nits_from_lumen_sphere, sphere_flux, true);
}

static void lumen_sphere_error(acc* a)
{
    area_errors(a, hdrp_light_lumen_from_nits_sphere, sphere_flux, false);
}

static void nits_disc_error(acc* a)
{
    area_errors(a, hdrp_light_nits_from_lumen_disc, disc_flux, true);
}

static void lumen_disc_error(acc* a)
{
    area_errors(a, hdrp_light_lumen_from_nits_disc, disc_flux, false);
}

static void nits_rectangle_error(acc* a)
{
    area_errors(a, nits_rectangle, rectangle_flux, true);
}

static void lumen_rectangle_error(acc* a)
{
    area_errors(a, lumen_rectangle, rectangle_flux, false);
}

static void nits_line_error(acc* a)
{
    area_errors(a, hdrp_light_nits_from_lumen_line, line_flux, true);
}

static void lumen_line_error(acc* a)
{
    area_errors(a, hdrp_light_lumen_from_nits_line, line_flux, false);
}

static void nits_line_isotropic_error(acc* a)
{
    area_errors(a, hdrp_light_candela_m_from_lumen_line_isotropic, isotropic_line_flux, true);
}

static void lumen_line_isotropic_error(acc* a)
{
    area_errors(a, hdrp_light_lumen_from_candela_m_line_isotropic, isotropic_line_flux, false);
}

/* Exposure values. The references go through natural and decimal logarithms. */

static void from_ev100_errors(acc* a, float (*f)(float), double at_zero)
{
    for (int i = 0; i < 50000; ++i) {
        float ev = i < 2 ? (i == 0 ? -HDRP_LIGHT_EV100_MAX : HDRP_LIGHT_EV100_MAX)
                         : acc_float(acc_uniform(a, i % 2 ? -120.0 : -10.0, i % 2 ? 120.0 : 20.0));
        double reference = at_zero * pow(10.0, (double)ev * log10(2.0));
        ACC_ADD(a, acc_relative((double)f(ev), reference), "EV %.9g", (double)ev);
    }
}

static void to_ev100_errors(acc* a, float (*f)(float), double at_zero)
{
    for (int i = 0; i < 50000; ++i) {
        float x = i % 2 ? log_float(a, 3.1e-38, 4.1e37) : log_float(a, 1e-6, 1e6);
        double reference = (log((double)x) - log(at_zero)) / log(2.0);
        ACC_ADD(a, fabs((double)f(x) - reference), "%.9g", (double)x);
    }
}

static void nits_ev100_error(acc* a)
{
    from_ev100_errors(a, hdrp_light_nits_from_ev100, 12.5 / 100.0);
}

static void ev100_nits_error(acc* a)
{
    to_ev100_errors(a, hdrp_light_ev100_from_nits, 12.5 / 100.0);
}

static void lux_ev100_error(acc* a)
{
    from_ev100_errors(a, hdrp_light_lux_from_ev100, 250.0 / 100.0);
}

static void ev100_lux_error(acc* a)
{
    to_ev100_errors(a, hdrp_light_ev100_from_lux, 250.0 / 100.0);
}

static void ev100_camera_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        double limit = i % 2 ? 1e6 : 1e3;
        float n = log_float(a, 1.0 / limit, limit), t = log_float(a, 1.0 / limit, limit);
        float s = log_float(a, 1.0 / limit, limit);
        double reference =
            (2.0 * log((double)n) - log((double)t) + log(100.0) - log((double)s)) / log(2.0);
        ACC_ADD(a, fabs((double)hdrp_light_ev100_from_camera(n, t, s) - reference),
                "f/%.9g, %.9g s, ISO %.9g", (double)n, (double)t, (double)s);
    }
}

/* A camera at random with the EV100 in question, whose sensor needs an exposure of speed / S behind
 * a lens that passes q / N^2, for the luminance that renders as value. */
static double sensor_luminance(acc* a, double ev100, double speed, double value)
{
    double s = acc_log_uniform(a, 10.0, 1e5), t = acc_log_uniform(a, 1e-4, 10.0);
    double n_squared = exp(ev100 * log(2.0)) * t * s / 100.0;
    double exposure = speed / s / value;
    return exposure * n_squared / (0.65 * t);
}

static void exposure_errors(acc* a, float (*f)(float), double speed, double value, bool invert)
{
    for (int i = 0; i < 50000; ++i) {
        float ev = acc_float(acc_uniform(a, i % 2 ? -120.0 : -10.0, i % 2 ? 120.0 : 20.0));
        double luminance = sensor_luminance(a, (double)ev, speed, value);
        ACC_ADD(a, acc_relative((double)f(ev), invert ? 1.0 / luminance : luminance), "EV %.9g",
                (double)ev);
    }
}

static void nits_saturation_error(acc* a)
{
    exposure_errors(a, hdrp_light_nits_max_saturation, 78.0, 1.0, false);
}

static void exposure_saturation_error(acc* a)
{
    exposure_errors(a, hdrp_light_exposure_saturation, 78.0, 1.0, true);
}

static void nits_standard_output_error(acc* a)
{
    exposure_errors(a, hdrp_light_nits_max_standard_output, 10.0, 0.18, false);
}

static void exposure_standard_output_error(acc* a)
{
    exposure_errors(a, hdrp_light_exposure_standard_output, 10.0, 0.18, true);
}

/* Illuminance. */

static void inverse_square_errors(acc* a, bool to_lux)
{
    double sphere = cone_solid_angle(PI);
    for (int i = 0; i < 50000; ++i) {
        float d = normal_float(a, i);
        double area = sphere * (double)d * (double)d;
        double factor = to_lux ? sphere / area : area / sphere;
        float x = unit_value(a, i / 4, factor);
        float y = to_lux ? hdrp_light_lux_from_candela(x, d) : hdrp_light_candela_from_lux(x, d);
        ACC_ADD(a, acc_relative((double)y, (double)x * factor), "%.9g at %.9g m", (double)x,
                (double)d);
    }
}

static void lux_candela_error(acc* a)
{
    inverse_square_errors(a, true);
}

static void candela_lux_error(acc* a)
{
    inverse_square_errors(a, false);
}

/* The vertical component of the direction to the sun, from the tangent of half its elevation. */
static double sun_height(double elevation)
{
    double t = tan(0.5 * elevation);
    return 2.0 * t / (1.0 + t * t);
}

static void lux_ground_error(acc* a)
{
    for (int i = 0; i < 50000; ++i) {
        float elevation = angle(a, i, (double)HDRP_FLT_MIN, HDRP_HALF_PI);
        double factor = sun_height((double)elevation);
        float x = unit_value(a, i / 2, factor);
        ACC_ADD(a,
                acc_relative((double)hdrp_light_lux_ground_from_lux_sun(x, elevation),
                             (double)x * factor),
                "%.9g at %.9g rad", (double)x, (double)elevation);
    }
}

static void lux_sun_error(acc* a)
{
    for (int i = 0; i < 50000; ++i) {
        float elevation = angle(a, i, (double)HDRP_FLT_MIN, HDRP_HALF_PI);
        double factor = 1.0 / sun_height((double)elevation);
        float x = unit_value(a, i / 2, factor);
        ACC_ADD(a,
                acc_relative((double)hdrp_light_lux_sun_from_lux_ground(x, elevation),
                             (double)x * factor),
                "%.9g at %.9g rad", (double)x, (double)elevation);
    }
}

static void sky_disc_errors(acc* a, bool to_nits)
{
    for (int i = 0; i < 100000; ++i) {
        float diameter = angle(a, i, (double)HDRP_FLT_MIN, HDRP_PI);
        double share = integrate(ring_cos, NULL, 0.0, 0.5 * (double)diameter, 4);
        double factor = to_nits ? 1.0 / share : share;
        float x = unit_value(a, i / 2, factor);
        float y = to_nits ? hdrp_light_nits_from_lux_sky_disc(x, diameter)
                          : hdrp_light_lux_from_nits_sky_disc(x, diameter);
        ACC_ADD(a, acc_relative((double)y, (double)x * factor), "%.9g at %.9g rad", (double)x,
                (double)diameter);
    }
}

static void nits_sky_disc_error(acc* a)
{
    sky_disc_errors(a, true);
}

static void lux_sky_disc_error(acc* a)
{
    sky_disc_errors(a, false);
}

/* Attenuation by distance. */

static void inv_range_sq_error(acc* a)
{
    for (int i = 0; i < 50000; ++i) {
        float r = log_float(a, 1e-6, 9.9e17);
        ACC_ADD(a, acc_relative((double)hdrp_light_inv_range_sq(r), pow((double)r, -2.0)), "%.9g m",
                (double)r);
    }
}

static double window_reference(double distance_sq, double inv_range_sq, double power)
{
    double ratio = sqrt(distance_sq * inv_range_sq);
    return ratio < 1.0 ? pow(1.0 - pow(ratio, 4.0), power) : 0.0;
}

/* Squared distances up to a little beyond the range, closer and closer to it, and far inside. */
static float squared_distance(acc* a, int i, float inv_range_sq)
{
    double share = i % 3 == 0   ? acc_uniform(a, 0.0, 1.1)
                   : i % 3 == 1 ? acc_log_uniform(a, 1e-12, 1.0)
                                : 1.0 - acc_log_uniform(a, 1e-8, 1.0);
    return acc_float(share / (double)inv_range_sq);
}

static void window_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float inv = hdrp_light_inv_range_sq(log_float(a, 1e-3, 1e9));
        float d2 = squared_distance(a, i, inv);
        ACC_ADD(a,
                fabs((double)hdrp_light_window(d2, inv) -
                     window_reference((double)d2, (double)inv, 2.0)),
                "d^2 %.9g, 1/r^2 %.9g", (double)d2, (double)inv);
    }
}

static void falloff_errors(acc* a, float (*f)(float, float), double power)
{
    for (int i = 0; i < 100000; ++i) {
        float inv = hdrp_light_inv_range_sq(log_float(a, 1e-3, 1e9));
        float d2 = squared_distance(a, i, inv);
        double nearest = (double)HDRP_LIGHT_DISTANCE_MIN_M;
        double limited = acc_larger((double)d2, nearest * nearest);
        double reference = window_reference((double)d2, (double)inv, power) / limited;
        ACC_ADD(a, fabs((double)f(d2, inv) - reference) * limited, "d^2 %.9g, 1/r^2 %.9g",
                (double)d2, (double)inv);
    }
}

static void falloff_error(acc* a)
{
    falloff_errors(a, hdrp_light_falloff, 2.0);
}

static void falloff_gltf_error(acc* a)
{
    falloff_errors(a, hdrp_light_falloff_gltf, 1.0);
}

/* Attenuation by direction. */

typedef struct vec {
    double x, y, z;
} vec;

static vec vec_from(hdrp_v3 v)
{
    vec r = {(double)v.x, (double)v.y, (double)v.z};
    return r;
}

static hdrp_v3 v3_from(vec v)
{
    return hdrp_v3_make(acc_float(v.x), acc_float(v.y), acc_float(v.z));
}

static vec mad(vec a, vec b, double s)
{
    vec r = {a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
    return r;
}

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec cross(vec a, vec b)
{
    vec r = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return r;
}

static vec unit(vec v)
{
    vec zero = {0.0, 0.0, 0.0};
    return mad(zero, v, 1.0 / sqrt(dot(v, v)));
}

static vec random_direction(acc* a)
{
    double d[3];
    acc_direction(a, d);
    vec r = {d[0], d[1], d[2]};
    return r;
}

static double angle_between(vec a, vec b)
{
    vec c = cross(a, b);
    return atan2(sqrt(dot(c, c)), dot(a, b));
}

/* A direction at the given angle from the axis. */
static vec tilted(acc* a, vec axis, double tilt)
{
    vec side = cross(axis, random_direction(a)), zero = {0.0, 0.0, 0.0};
    return mad(mad(zero, axis, cos(tilt)), unit(side), sin(tilt));
}

static void versine_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        vec axis = random_direction(a);
        double tilt = i % 2 ? acc_log_uniform(a, 1e-4, PI) : PI - acc_log_uniform(a, 1e-6, 1.0);
        hdrp_v3 u = v3_from(axis), v = v3_from(tilted(a, axis, tilt));
        double theta = angle_between(vec_from(u), vec_from(v)), s = sin(0.5 * theta);
        ACC_ADD(a, fabs((double)hdrp_light_versine(u, v) - 2.0 * s * s) / theta, "%.9g rad", theta);
    }
}

/* Inner and outer half angles whose edge is at least a tenth of the cone. */
static void soft_cone(acc* a, double smallest, float* inner, float* outer)
{
    *outer = acc_float(acc_larger(smallest, acc_uniform(a, 0.0, 1.0) < 0.5
                                                ? acc_uniform(a, smallest, PI)
                                                : acc_log_uniform(a, smallest, PI)));
    double versine = 2.0 * pow(sin(0.5 * (double)*outer), 2.0);
    double inner_versine = acc_uniform(a, 0.0, 0.9) * versine;
    *inner = acc_float(2.0 * asin(sqrt(0.5 * inner_versine)));
}

static void cone_shape_error(acc* a)
{
    for (int i = 0; i < 50000; ++i) {
        float inner, outer;
        soft_cone(a, (double)HDRP_LIGHT_HALF_ANGLE_MIN, &inner, &outer);
        double reference = cone_solid_angle((double)outer) / (2.0 * PI);
        ACC_ADD(
            a,
            acc_relative((double)hdrp_light_cone_shape_make(inner, outer).versine_outer, reference),
            "%.9g rad", (double)outer);
    }
}

/* By cosines, as published. */
static double cone_reference(double theta, double inner, double outer)
{
    double t = (cos(theta) - cos(outer)) / (cos(inner) - cos(outer));
    t = fmin(acc_larger(t, 0.0), 1.0);
    return t * t;
}

static void cone_attenuation_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float inner, outer;
        soft_cone(a, DEG, &inner, &outer);
        double theta = acc_uniform(a, 0.0, fmin(1.1 * (double)outer, PI)), s = sin(0.5 * theta);
        float versine = acc_float(2.0 * s * s);
        double given = 2.0 * asin(fmin(sqrt(0.5 * (double)versine), 1.0));
        double reference = cone_reference(given, (double)inner, (double)outer);
        hdrp_light_cone_shape cone = hdrp_light_cone_shape_make(inner, outer);
        ACC_ADD(a, fabs((double)hdrp_light_cone_attenuation(versine, cone) - reference),
                "at %.9g, %.9g to %.9g rad", theta, (double)inner, (double)outer);
    }
}

/* The attenuation of a cone, p = {inner, outer}, in versines so that small cones keep their digits
 * in double as well. */
static double soft_ring(double t, const double* p)
{
    double outer = sin(0.5 * p[1] + 0.5 * t) * sin(0.5 * p[1] - 0.5 * t);
    double width = sin(0.5 * p[1] + 0.5 * p[0]) * sin(0.5 * p[1] - 0.5 * p[0]);
    return ring(t, p) * pow(outer / width, 2.0);
}

static double spot_solid_angle(double inner, double outer)
{
    double p[2] = {inner, outer};
    return cone_solid_angle(inner) + integrate(soft_ring, p, inner, outer, 8);
}

static void solid_angle_spot_error(acc* a)
{
    for (int i = 0; i < 10000; ++i) {
        float inner, outer;
        soft_cone(a, (double)HDRP_LIGHT_HALF_ANGLE_MIN, &inner, &outer);
        double reference = spot_solid_angle((double)inner, (double)outer);
        ACC_ADD(a, acc_relative((double)hdrp_light_solid_angle_spot(inner, outer), reference),
                "%.9g to %.9g rad", (double)inner, (double)outer);
    }
}

static void candela_spot_error(acc* a)
{
    for (int i = 0; i < 10000; ++i) {
        float inner, outer, lumen = log_float(a, 1e-3, 1e6);
        soft_cone(a, (double)HDRP_LIGHT_HALF_ANGLE_MIN, &inner, &outer);
        double reference = (double)lumen / spot_solid_angle((double)inner, (double)outer);
        ACC_ADD(a,
                acc_relative((double)hdrp_light_candela_from_lumen_spot(lumen, inner, outer),
                             reference),
                "%.9g to %.9g rad", (double)inner, (double)outer);
    }
}

static void lumen_spot_error(acc* a)
{
    for (int i = 0; i < 10000; ++i) {
        float inner, outer, candela = log_float(a, 1e-3, 1e6);
        soft_cone(a, (double)HDRP_LIGHT_HALF_ANGLE_MIN, &inner, &outer);
        double reference = (double)candela * spot_solid_angle((double)inner, (double)outer);
        ACC_ADD(a,
                acc_relative((double)hdrp_light_lumen_from_candela_spot(candela, inner, outer),
                             reference),
                "%.9g to %.9g rad", (double)inner, (double)outer);
    }
}

static void pyramid_shape_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float x = angle(a, i + 1, 1e-5, HDRP_HALF_PI);
        hdrp_light_pyramid_shape p = hdrp_light_pyramid_shape_make(x, x, 1.0f);
        ACC_ADD(a,
                acc_larger(acc_relative((double)p.sin_x, sin((double)x)),
                           acc_relative((double)p.cos_y, cos((double)x))),
                "%.9g rad", (double)x);
    }
}

/* The distance of a direction from the right face, relative to that of the direction in which the
 * edge begins. The face is the plane through the apex and its two corners. */
static double face_reference(double along, double z, double half_angle, double edge)
{
    vec top = {sin(half_angle), 0.5, cos(half_angle)};
    vec bottom = {sin(half_angle), -0.5, cos(half_angle)};
    vec begin = {sin(half_angle * (1.0 - edge)), 0.0, cos(half_angle * (1.0 - edge))};
    vec d = {fabs(along), 0.0, z};
    vec inwards = cross(top, bottom);
    return fmin(acc_larger(dot(inwards, d) / dot(inwards, begin), 0.0), 1.0);
}

static double pyramid_reference(vec d, double half_x, double half_y, double edge)
{
    double t = face_reference(d.x, d.z, half_x, edge) * face_reference(d.y, d.z, half_y, edge);
    return t * t;
}

/* A direction towards and around a pyramid. */
static vec pyramid_direction(acc* a, double half_x, double half_y)
{
    double x = acc_uniform(a, -1.1, 1.1) * half_x, y = acc_uniform(a, -1.1, 1.1) * half_y;
    vec d = {sin(x) * cos(y), sin(y), cos(x) * cos(y)};
    return unit(d);
}

static void pyramid_attenuation_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float x = log_float(a, DEG, 0.5 * PI), y = log_float(a, DEG, 0.5 * PI);
        float edge = acc_float(acc_uniform(a, 0.1, 1.0));
        hdrp_v3 d = v3_from(pyramid_direction(a, (double)x, (double)y));
        double reference = pyramid_reference(vec_from(d), (double)x, (double)y, (double)edge);
        hdrp_light_pyramid_shape p = hdrp_light_pyramid_shape_make(x, y, edge);
        ACC_ADD(a, fabs((double)hdrp_light_pyramid_attenuation(d, p) - reference),
                "%.9g x %.9g rad, edge %.9g", (double)x, (double)y, (double)edge);
    }
}

static double box_reference(vec p, double half_width, double half_height, double depth, double edge)
{
    double x = fmin(half_width - p.x, half_width + p.x) / edge;
    double y = fmin(half_height - p.y, half_height + p.y) / edge;
    double t = fmin(acc_larger(x, 0.0), 1.0) * fmin(acc_larger(y, 0.0), 1.0);
    t *= fmin(acc_larger((depth - p.z) / edge, 0.0), 1.0);
    return p.z < 0.0 ? 0.0 : t * t;
}

/* A place in and around a box. */
static vec box_place(acc* a, float half_width, float half_height, float depth)
{
    vec p = {acc_uniform(a, -1.1, 1.1) * (double)half_width,
             acc_uniform(a, -1.1, 1.1) * (double)half_height,
             acc_uniform(a, -0.1, 1.1) * (double)depth};
    return p;
}

static void box_attenuation_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float w = log_float(a, 0.1, 10.0), h = log_float(a, 0.1, 10.0);
        float d = log_float(a, 0.1, 10.0);
        float edge = acc_float(acc_uniform(a, 0.1, 1.0) * (double)fminf(fminf(w, h), d));
        hdrp_v3 p = v3_from(box_place(a, w, h, d));
        double reference =
            box_reference(vec_from(p), (double)w, (double)h, (double)d, (double)edge);
        ACC_ADD(a, fabs((double)hdrp_light_box_attenuation(p, w, h, d, 1.0f / edge) - reference),
                "%.9g x %.9g x %.9g m, border %.9g m", (double)w, (double)h, (double)d,
                (double)edge);
    }
}

/* Evaluation: everything from the maker's arguments on, in double. */

typedef struct scene {
    hdrp_v3 light, forward, up, surface;
    float candela, range;
    double distance;
} scene;

/* A light at random, with a surface in the given direction from it (which follows forward). */
static void place(acc* a, scene* s, vec direction)
{
    vec at = random_direction(a), zero = {0.0, 0.0, 0.0};
    at = mad(zero, at, acc_log_uniform(a, 0.01, 100.0));
    s->light = v3_from(at);
    s->range = log_float(a, 0.1, 1e4);
    s->candela = log_float(a, 1e-3, 1e6);
    s->distance = acc_log_uniform(a, 0.1, 1e3);
    s->surface = v3_from(mad(at, direction, s->distance));
}

/* From the float positions; the share of candela / d^2 that is left of a measured illuminance. */
static vec to_surface(const scene* s)
{
    return mad(vec_from(s->surface), vec_from(s->light), -1.0);
}

static double share_error(const scene* s, hdrp_light_incident i, double attenuation)
{
    vec d = to_surface(s);
    double distance_sq = dot(d, d), range = (double)s->range;
    double limited = acc_larger(distance_sq, pow((double)HDRP_LIGHT_DISTANCE_MIN_M, 2.0));
    double window = window_reference(distance_sq, 1.0 / (range * range), 2.0);
    return fabs((double)i.illuminance.y * limited / (double)s->candela - window * attenuation);
}

static void eval_point_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        scene s;
        place(a, &s, random_direction(a));
        hdrp_light light = hdrp_light_point(s.light, hdrp_v3_splat(s.candela), s.range);
        ACC_ADD(a, share_error(&s, hdrp_light_eval(light, s.surface), 1.0), "%.9g m, range %.9g m",
                s.distance, (double)s.range);
    }
}

static void eval_direction_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        scene s;
        place(a, &s, random_direction(a));
        hdrp_light light = hdrp_light_point(s.light, hdrp_v3_splat(s.candela), s.range);
        vec zero = {0.0, 0.0, 0.0};
        vec l = mad(zero, unit(to_surface(&s)), -1.0);
        vec d = mad(vec_from(hdrp_light_eval(light, s.surface).l), l, -1.0);
        ACC_ADD(a, acc_larger(fabs(d.x), acc_larger(fabs(d.y), fabs(d.z))), "%.9g m", s.distance);
    }
}

static void eval_spot_errors(acc* a, double smallest)
{
    for (int i = 0; i < 100000; ++i) {
        scene s;
        float inner, outer;
        soft_cone(a, smallest, &inner, &outer);
        vec zero = {0.0, 0.0, 0.0}, axis = random_direction(a);
        double theta = acc_uniform(a, 0.0, fmin(1.1 * (double)outer, PI));
        place(a, &s, tilted(a, axis, theta));
        s.forward = v3_from(mad(zero, axis, acc_log_uniform(a, 1e-3, 1e3)));
        hdrp_light light =
            hdrp_light_spot(s.light, s.forward, hdrp_v3_splat(s.candela), s.range, inner, outer);
        theta = angle_between(vec_from(s.forward), to_surface(&s));
        double attenuation = cone_reference(theta, (double)inner, (double)outer);
        ACC_ADD(a, share_error(&s, hdrp_light_eval(light, s.surface), attenuation),
                "at %.9g, %.9g to %.9g rad", theta, (double)inner, (double)outer);
    }
}

static void eval_spot_error(acc* a)
{
    eval_spot_errors(a, 10.0 * DEG);
}

static void eval_spot_narrow_error(acc* a)
{
    eval_spot_errors(a, DEG);
}

/* A frame at random, as the maker receives it, and in double. */
static void frame(acc* a, scene* s, vec axes[3])
{
    vec forward = random_direction(a), zero = {0.0, 0.0, 0.0};
    vec up = tilted(a, forward, acc_uniform(a, 0.5, 2.6));
    s->forward = v3_from(mad(zero, forward, acc_log_uniform(a, 1e-3, 1e3)));
    s->up = v3_from(mad(zero, up, acc_log_uniform(a, 1e-3, 1e3)));
    axes[2] = unit(vec_from(s->forward));
    axes[0] = unit(cross(axes[2], vec_from(s->up)));
    axes[1] = cross(axes[0], axes[2]);
}

static vec from_frame(const vec axes[3], vec v)
{
    vec zero = {0.0, 0.0, 0.0};
    return mad(mad(mad(zero, axes[0], v.x), axes[1], v.y), axes[2], v.z);
}

static vec in_frame(const vec axes[3], vec v)
{
    vec r = {dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)};
    return r;
}

static void eval_pyramid_errors(acc* a, double smallest)
{
    for (int i = 0; i < 100000; ++i) {
        scene s;
        vec axes[3];
        float x = log_float(a, smallest, 0.5 * PI), y = log_float(a, smallest, 0.5 * PI);
        float edge = acc_float(acc_uniform(a, 0.1, 1.0));
        frame(a, &s, axes);
        place(a, &s, from_frame(axes, pyramid_direction(a, (double)x, (double)y)));
        hdrp_light light = hdrp_light_pyramid(s.light, s.forward, s.up, hdrp_v3_splat(s.candela),
                                              s.range, x, y, edge);
        vec d = unit(in_frame(axes, to_surface(&s)));
        double attenuation = pyramid_reference(d, (double)x, (double)y, (double)edge);
        ACC_ADD(a, share_error(&s, hdrp_light_eval(light, s.surface), attenuation),
                "%.9g x %.9g rad, edge %.9g", (double)x, (double)y, (double)edge);
    }
}

static void eval_pyramid_error(acc* a)
{
    eval_pyramid_errors(a, 10.0 * DEG);
}

static void eval_pyramid_narrow_error(acc* a)
{
    eval_pyramid_errors(a, DEG);
}

static void eval_box_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        scene s;
        vec axes[3];
        float w = log_float(a, 0.5, 5.0), h = log_float(a, 0.5, 5.0), z = log_float(a, 0.5, 5.0);
        float edge = acc_float(acc_uniform(a, 0.1, 1.0) * (double)fminf(fminf(w, h), z));
        frame(a, &s, axes);
        place(a, &s, axes[2]);
        s.surface = v3_from(mad(from_frame(axes, box_place(a, w, h, z)), vec_from(s.light), 1.0));
        vec p = in_frame(axes, to_surface(&s));
        if (fabs(p.z) < 1e-4) { /* the hard face: either answer is right */
            continue;
        }
        hdrp_light light =
            hdrp_light_box(s.light, s.forward, s.up, hdrp_v3_splat(s.candela), w, h, z, edge);
        double reference = box_reference(p, (double)w, (double)h, (double)z, (double)edge);
        double share = (double)hdrp_light_eval(light, s.surface).illuminance.x / (double)s.candela;
        ACC_ADD(a, fabs(share - reference), "%.9g x %.9g x %.9g m, border %.9g m", (double)w,
                (double)h, (double)z, (double)edge);
    }
}

const acc_entry acc_light[] = {
    {"light_candela_point", candela_point_error},
    {"light_lumen_point", lumen_point_error},
    {"light_solid_angle_cone", solid_angle_cone_error},
    {"light_candela_spot_reflector", candela_spot_reflector_error},
    {"light_lumen_spot_reflector", lumen_spot_reflector_error},
    {"light_solid_angle_pyramid", solid_angle_pyramid_error},
    {"light_candela_pyramid", candela_pyramid_error},
    {"light_lumen_pyramid", lumen_pyramid_error},
    {"light_nits_sphere", nits_sphere_error},
    {"light_lumen_sphere", lumen_sphere_error},
    {"light_nits_disc", nits_disc_error},
    {"light_lumen_disc", lumen_disc_error},
    {"light_nits_rectangle", nits_rectangle_error},
    {"light_lumen_rectangle", lumen_rectangle_error},
    {"light_nits_line", nits_line_error},
    {"light_lumen_line", lumen_line_error},
    {"light_nits_line_isotropic", nits_line_isotropic_error},
    {"light_lumen_line_isotropic", lumen_line_isotropic_error},
    {"light_nits_ev100", nits_ev100_error},
    {"light_ev100_nits", ev100_nits_error},
    {"light_lux_ev100", lux_ev100_error},
    {"light_ev100_lux", ev100_lux_error},
    {"light_lux_candela", lux_candela_error},
    {"light_candela_lux", candela_lux_error},
    {"light_lux_ground", lux_ground_error},
    {"light_lux_sun", lux_sun_error},
    {"light_nits_sky_disc", nits_sky_disc_error},
    {"light_lux_sky_disc", lux_sky_disc_error},
    {"light_ev100_camera", ev100_camera_error},
    {"light_nits_saturation", nits_saturation_error},
    {"light_exposure_saturation", exposure_saturation_error},
    {"light_nits_standard_output", nits_standard_output_error},
    {"light_exposure_standard_output", exposure_standard_output_error},
    {"light_inv_range_sq", inv_range_sq_error},
    {"light_window", window_error},
    {"light_falloff", falloff_error},
    {"light_falloff_gltf", falloff_gltf_error},
    {"light_versine", versine_error},
    {"light_cone_shape", cone_shape_error},
    {"light_cone_attenuation", cone_attenuation_error},
    {"light_solid_angle_spot", solid_angle_spot_error},
    {"light_candela_spot", candela_spot_error},
    {"light_lumen_spot", lumen_spot_error},
    {"light_pyramid_shape", pyramid_shape_error},
    {"light_pyramid_attenuation", pyramid_attenuation_error},
    {"light_box_attenuation", box_attenuation_error},
    {"light_eval_point", eval_point_error},
    {"light_eval_direction", eval_direction_error},
    {"light_eval_spot", eval_spot_error},
    {"light_eval_spot_narrow", eval_spot_narrow_error},
    {"light_eval_pyramid", eval_pyramid_error},
    {"light_eval_pyramid_narrow", eval_pyramid_narrow_error},
    {"light_eval_box", eval_box_error},
    {NULL, NULL},
};
