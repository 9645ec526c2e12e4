/* acc_pack.c - accuracy of hdrp_pack.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_pack.h"

/* Random values, and a few floats around every place where the nearest code changes. */
static void around(acc* a, double value, void (*test)(acc*, float, hdrp_u32), hdrp_u32 bits)
{
    float x = (float)value;
    test(a, nextafterf(x, -INFINITY), bits);
    test(a, x, bits);
    test(a, nextafterf(x, INFINITY), bits);
}

static void unorm_at(acc* a, float x, hdrp_u32 bits)
{
    double last = ldexp(1.0, (int)bits) - 1.0; /* 24 + 16 bits: the product is exact */
    double exact = fmin(acc_larger((double)x, 0.0), 1.0) * last;
    ACC_ADD(a, fabs((double)hdrp_pack_unorm_from_float(x, bits) - exact), "x %.9g, %u bits",
            (double)x, bits);
}

static void unorm_codes_error(acc* a)
{
    for (hdrp_u32 bits = 1; bits <= 16; ++bits) {
        double last = ldexp(1.0, (int)bits) - 1.0;
        for (hdrp_u32 code = 0; code < (1u << bits); ++code) {
            around(a, ((double)code + 0.5) / last, unorm_at, bits);
            around(a, (double)code / last, unorm_at, bits);
        }
        for (int i = 0; i < 5000; ++i) {
            unorm_at(a, acc_float(acc_uniform(a, -0.1, 1.1)), bits);
            unorm_at(a, acc_float(acc_log_uniform(a, 1e-44, 1.0)), bits);
        }
    }
}

static void snorm_at(acc* a, float x, hdrp_u32 bits)
{
    double last = ldexp(1.0, (int)bits - 1) - 1.0;
    double exact = fmin(acc_larger((double)x, -1.0), 1.0) * last;
    double code = (double)hdrp_pack_snorm_from_float(x, bits);
    code -= code > last ? ldexp(1.0, (int)bits) : 0.0;
    ACC_ADD(a, fabs(code - exact), "x %.9g, %u bits", (double)x, bits);
}

static void snorm_codes_error(acc* a)
{
    for (hdrp_u32 bits = 2; bits <= 16; ++bits) {
        double last = ldexp(1.0, (int)bits - 1) - 1.0;
        for (int code = -(int)last; code <= (int)last; ++code) {
            around(a, ((double)code + 0.5) / last, snorm_at, bits);
            around(a, (double)code / last, snorm_at, bits);
        }
    }
}

static void float_from_unorm_error(acc* a)
{
    for (hdrp_u32 bits = 1; bits <= 16; ++bits) {
        for (hdrp_u32 code = 0; code < (1u << bits); ++code) {
            double reference = (double)code / (ldexp(1.0, (int)bits) - 1.0);
            ACC_ADD(a, acc_ulp((double)hdrp_pack_float_from_unorm(code, bits), reference),
                    "code %u of %u bits", code, bits);
        }
    }
}

static void float_from_snorm_error(acc* a)
{
    for (hdrp_u32 bits = 2; bits <= 16; ++bits) {
        for (hdrp_u32 code = 0; code < (1u << bits); ++code) {
            double last = ldexp(1.0, (int)bits - 1) - 1.0;
            double value = (double)code;
            value -= value > last ? ldexp(1.0, (int)bits) : 0.0;
            ACC_ADD(a,
                    acc_ulp((double)hdrp_pack_float_from_snorm(code, bits),
                            acc_larger(value / last, -1.0)),
                    "code %u of %u bits", code, bits);
        }
    }
}

static void biased_snorm_at(acc* a, float x, hdrp_u32 bits)
{
    float target = hdrp_pack_biased_snorm_target(x, bits);
    double decoded = (double)hdrp_pack_float_from_biased_snorm_target(target, bits);
    ACC_ADD(a, fabs(decoded - fmin(acc_larger((double)x, -1.0), 1.0)), "x %.9g", (double)x);
}

static void biased_snorm_8_error(acc* a)
{
    for (int code = -127; code <= 127; ++code) {
        around(a, ((double)code + 0.5) / 127.0, biased_snorm_at, 8u);
        around(a, (double)code / 127.0, biased_snorm_at, 8u);
    }
}

/* The power p/q of x for small integers, by Newton's method on y^q = x^p. */
static double rational_power(double x, int p, int q)
{
    double target = 1.0, y = 1.0;
    for (int i = 0; i < p; ++i) {
        target *= x;
    }
    for (int k = 0; k < 200; ++k) {
        double below = 1.0;
        for (int i = 0; i < q - 1; ++i) {
            below *= y;
        }
        y -= (y * below - target) / ((double)q * below);
    }
    return y;
}

static void srgb8_at(acc* a, float x, hdrp_u32 unused)
{
    (void)unused;
    double v = fmin(acc_larger((double)x, 0.0), 1.0);
    double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * rational_power(v, 5, 12) - 0.055;
    ACC_ADD(a, fabs((double)hdrp_pack_srgb8_from_linear(x) - encoded * 255.0), "x %.9g", (double)x);
}

static double linear_from_srgb(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : rational_power((encoded + 0.055) / 1.055, 12, 5);
}

static void srgb8_codes_error(acc* a)
{
    for (int code = 0; code < 255; ++code) {
        around(a, linear_from_srgb(((double)code + 0.5) / 255.0), srgb8_at, 8u);
        around(a, linear_from_srgb((double)code / 255.0), srgb8_at, 8u);
    }
    for (int i = 0; i < 20000; ++i) {
        srgb8_at(a, acc_float(acc_uniform(a, 0.0, 1.0)), 8u);
    }
}

static void linear_from_srgb8_error(acc* a)
{
    for (hdrp_u32 code = 0; code < 256; ++code) {
        ACC_ADD(a,
                acc_relative((double)hdrp_pack_linear_from_srgb8(code),
                             linear_from_srgb((double)code / 255.0)),
                "code %u", code);
    }
}

/* What a code of five exponent bits is by the definition of the format. */
static double small_float(hdrp_u32 code, int mantissa_bits)
{
    int exponent = (int)(code >> mantissa_bits);
    double mantissa = ldexp((double)(code & ((1u << mantissa_bits) - 1u)), -mantissa_bits);
    return exponent == 0 ? ldexp(mantissa, -14) : ldexp(1.0 + mantissa, exponent - 15);
}

static void half_at(acc* a, float x, hdrp_u32 unused)
{
    (void)unused;
    double decoded = small_float(hdrp_pack_half_from_float(x), 10);
    ACC_ADD(a, acc_relative(decoded, (double)x), "x %.9g", (double)x);
}

static void half_error(acc* a)
{
    for (hdrp_u32 code = 0x0400; code < 0x7bff; ++code) {
        around(a, 0.5 * (small_float(code, 10) + small_float(code + 1, 10)), half_at, 0u);
    }
    for (int i = 0; i < 100000; ++i) {
        half_at(a, acc_float(acc_log_uniform(a, ldexp(1.0, -14), 65504.0)), 0u);
    }
}

static void half_denormal_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        float x = acc_float(acc_log_uniform(a, 1e-10, ldexp(1.0, -14)));
        float y = acc_float(acc_uniform(a, 0.0, ldexp(1.0, -14)));
        ACC_ADD(a, fabs(small_float(hdrp_pack_half_from_float(x), 10) - (double)x), "x %.9g",
                (double)x);
        ACC_ADD(a, fabs(small_float(hdrp_pack_half_from_float(y), 10) - (double)y), "x %.9g",
                (double)y);
    }
}

static void r11_at(acc* a, float x, hdrp_u32 unused)
{
    (void)unused;
    hdrp_u32 texel = hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(x, x, 0.0f));
    ACC_ADD(a, acc_relative(small_float(texel & 2047u, 6), (double)x), "red %.9g", (double)x);
    ACC_ADD(a, acc_relative(small_float(texel >> 11u, 6), (double)x), "green %.9g", (double)x);
}

static void r11_error(acc* a)
{
    for (hdrp_u32 code = 1u << 6; code < (31u << 6) - 1u; ++code) {
        around(a, 0.5 * (small_float(code, 6) + small_float(code + 1, 6)), r11_at, 0u);
    }
    for (int i = 0; i < 100000; ++i) {
        r11_at(a, acc_float(acc_log_uniform(a, ldexp(1.0, -14), 65024.0)), 0u);
    }
}

static void b10_at(acc* a, float x, hdrp_u32 unused)
{
    (void)unused;
    hdrp_u32 texel = hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(0.0f, 0.0f, x));
    ACC_ADD(a, acc_relative(small_float(texel >> 22u, 5), (double)x), "blue %.9g", (double)x);
}

static void b10_error(acc* a)
{
    for (hdrp_u32 code = 1u << 5; code < (31u << 5) - 1u; ++code) {
        around(a, 0.5 * (small_float(code, 5) + small_float(code + 1, 5)), b10_at, 0u);
    }
    for (int i = 0; i < 100000; ++i) {
        b10_at(a, acc_float(acc_log_uniform(a, ldexp(1.0, -14), 64512.0)), 0u);
    }
}

static void float_uint_at(acc* a, float f, hdrp_u32 i, hdrp_u32 bits_i)
{
    float target = hdrp_pack_float_uint(f, i, bits_i, 8u);
    hdrp_pack_float_uint_pair pair = hdrp_pack_float_uint_from_target(target, bits_i, 8u);
    double error = pair.i == i ? fabs((double)pair.f - (double)f) : HUGE_VAL;
    ACC_ADD(a, error, "f %.9g, i %u", (double)f, i);
}

static void float_uint_error(acc* a, hdrp_u32 bits_i)
{
    double last = (double)((1u << (8u - bits_i)) - 1u);
    for (hdrp_u32 i = 0; i < (1u << bits_i); ++i) {
        for (int k = 0; k < 2000; ++k) {
            float_uint_at(a, acc_float((double)k / 1999.0), i, bits_i);
        }
        for (double code = 0.0; code < last; code += 1.0) {
            float_uint_at(a, acc_float((code + 0.5) / last), i, bits_i);
        }
    }
}

static void float_uint_3_of_8_error(acc* a)
{
    float_uint_error(a, 3u);
}

static void float_uint_4_of_8_error(acc* a)
{
    float_uint_error(a, 4u);
}

static double degrees(hdrp_v3 measured, const double reference[3])
{
    double m[3] = {(double)measured.x, (double)measured.y, (double)measured.z};
    return acc_degrees(m, reference);
}

/* Directions that are hard for an octahedral code with `steps` steps from 0 to 1: the corners
 * between four codes, near the middle of a face where the map is coarsest and near the equator
 * where the side is at stake; the axes and seams; and random ones. The first component of the plane
 * is negative half of the time. */
static hdrp_v3 hard_normal(acc* a, int i, double steps)
{
    double d[3];
    acc_direction(a, d);
    double x = floor(fabs(d[0]) * steps), y = floor(fabs(d[1]) * steps);
    double z_sign = d[2] < 0.0 ? -1.0 : 1.0;
    if (i % 8 == 1 || i % 8 == 2) { /* a corner near the middle of a face */
        x = floor(steps / 3.0 + 20.0 * (x / steps - 0.5));
        y = floor(steps / 3.0 + 20.0 * (y / steps - 0.5));
        d[0] = copysign((x + (i % 8 == 1 ? 0.5 : 0.0)) / steps, d[0]);
        d[1] = copysign((y + (i % 8 == 1 ? 0.5 : 0.0)) / steps, d[1]);
        d[2] = z_sign * (1.0 - fabs(d[0]) - fabs(d[1]));
    } else if (i % 8 == 3 || i % 8 == 4) { /* close to the equator, or on it */
        d[2] = i % 16 < 8 ? z_sign * acc_log_uniform(a, 1e-9, 2.0 / steps) : 0.0;
    } else if (i % 8 == 5) { /* close to a seam */
        d[i % 3] = copysign(acc_log_uniform(a, 1e-9, 2.0 / steps), d[i % 3]);
    } else if (i % 8 == 6) { /* close to an axis */
        d[i % 3] = copysign(acc_log_uniform(a, 1e-9, 2.0 / steps), d[i % 3]);
        d[(i + 1) % 3] = copysign(acc_log_uniform(a, 1e-9, 2.0 / steps), d[(i + 1) % 3]);
    }
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return hdrp_v3_make(acc_float(d[0] / length), acc_float(d[1] / length),
                        acc_float(d[2] / length));
}

typedef hdrp_u32 (*oct_encoder)(hdrp_v3 n, hdrp_u32 bits);
typedef hdrp_v3 (*oct_decoder)(hdrp_u32 code, hdrp_u32 bits);

/* A lost sign of z is an infinite error. */
static void oct_error(acc* a, oct_encoder encode, oct_decoder decode, hdrp_u32 bits)
{
    double steps =
        ldexp(1.0, (int)bits - 1) - (decode == hdrp_pack_normal_from_oct_snorm ? 1.0 : 0.5);
    for (int i = 0; i < 250000; ++i) {
        hdrp_v3 n = hard_normal(a, i, steps);
        double reference[3] = {(double)n.x, (double)n.y, (double)n.z};
        hdrp_v3 decoded = decode(encode(n, bits), bits);
        double error = (decoded.z < 0.0f) == (n.z < 0.0f) ? degrees(decoded, reference) : HUGE_VAL;
        ACC_ADD(a, error, "n = (%.9g, %.9g, %.9g)", (double)n.x, (double)n.y, (double)n.z);
    }
}

/* Without the normals just below the equator, where SNORM has to leave its codes with z = 0. */
static void oct_snorm_exact_12_away_error(acc* a)
{
    for (int i = 0; i < 250000; ++i) {
        hdrp_v3 n = hard_normal(a, i, 2047.0);
        double reference[3] = {(double)n.x, (double)n.y, (double)n.z};
        hdrp_v3 m =
            hdrp_pack_normal_from_oct_snorm(hdrp_pack_oct_snorm_from_normal_exact(n, 12u), 12u);
        if (!(n.z < 0.0f && n.z > -1e-3f)) {
            ACC_ADD(a, degrees(m, reference), "n = (%.9g, %.9g, %.9g)", reference[0], reference[1],
                    reference[2]);
        }
    }
}

#define OCT_ENTRY(name, encode, decode, bits)                                                      \
    static void name##_error(acc* a)                                                               \
    {                                                                                              \
        oct_error(a, encode, decode, bits);                                                        \
    }
#define OCT_ENTRIES(kind, bits)                                                                    \
    OCT_ENTRY(oct_##kind##_##bits, hdrp_pack_oct_##kind##_from_normal,                             \
              hdrp_pack_normal_from_oct_##kind, bits##u)                                           \
    OCT_ENTRY(oct_##kind##_exact_##bits, hdrp_pack_oct_##kind##_from_normal_exact,                 \
              hdrp_pack_normal_from_oct_##kind, bits##u)
OCT_ENTRIES(snorm, 8)
OCT_ENTRIES(snorm, 12)
OCT_ENTRIES(snorm, 16)
OCT_ENTRIES(unorm, 8)
OCT_ENTRIES(unorm, 12)
OCT_ENTRIES(unorm, 16)

/* A decoder against the definition of the map: below the equator a point is the mirror image in the
 * line |x| + |y| = 1. x and y are those of the code, in [-1,1]. */
static void oct_decoded(acc* a, hdrp_v3 measured, double x, double y, hdrp_u32 code, hdrp_u32 bits)
{
    double n[3] = {x, y, 1.0 - fabs(x) - fabs(y)};
    if (n[2] < 0.0) {
        n[0] = copysign(1.0 - fabs(y), x);
        n[1] = copysign(1.0 - fabs(x), y);
    }
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double e = acc_larger(fabs((double)measured.x - n[0] / length),
                          acc_larger(fabs((double)measured.y - n[1] / length),
                                     fabs((double)measured.z - n[2] / length)));
    ACC_ADD(a, e, "code %u of %u bits", code, bits);
}

static void normal_from_oct_snorm_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_u32 bits = 2u + (hdrp_u32)(i % 15);
        hdrp_u32 code = (hdrp_u32)(acc_random_bits(a) >> (64u - 2u * bits));
        double last = ldexp(1.0, (int)bits - 1) - 1.0, all = ldexp(1.0, (int)bits);
        double x = (double)(code & ((1u << bits) - 1u)), y = (double)(code >> bits);
        x = acc_larger((x > last ? x - all : x) / last, -1.0);
        y = acc_larger((y > last ? y - all : y) / last, -1.0);
        oct_decoded(a, hdrp_pack_normal_from_oct_snorm(code, bits), x, y, code, bits);
    }
}

static void normal_from_oct_unorm_error(acc* a)
{
    for (int i = 0; i < 300000; ++i) {
        hdrp_u32 bits = 2u + (hdrp_u32)(i % 15);
        hdrp_u32 code = (hdrp_u32)(acc_random_bits(a) >> (64u - 2u * bits));
        double last = ldexp(1.0, (int)bits) - 1.0;
        double x = (double)(code & ((1u << bits) - 1u)), y = (double)(code >> bits);
        oct_decoded(a, hdrp_pack_normal_from_oct_unorm(code, bits), 2.0 * x / last - 1.0,
                    2.0 * y / last - 1.0, code, bits);
    }
}

static void cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* A random tangent of n: unit and orthogonal to it. */
static void random_tangent(acc* a, hdrp_v3 n, double t[3])
{
    double m[3] = {(double)n.x, (double)n.y, (double)n.z}, d[3], length;
    do {
        acc_direction(a, d);
        cross(m, d, t);
        length = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    } while (length < 0.1);
    for (int i = 0; i < 3; ++i) {
        t[i] /= length;
    }
}

static double unsigned_degrees(hdrp_v3 measured, const double reference[3])
{
    double e = degrees(measured, reference);
    return fmin(e, 180.0 - e);
}

static void angle11_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        hdrp_v3 n = hard_normal(a, i, 2047.0);
        double t[3];
        random_tangent(a, n, t);
        hdrp_v3 tangent = hdrp_v3_make((float)t[0], (float)t[1], (float)t[2]);
        hdrp_u32 code = hdrp_pack_angle11_from_tangent(n, tangent);
        ACC_ADD(a, unsigned_degrees(hdrp_pack_tangent_from_angle11(n, code), t),
                "n = (%.9g, %.9g, %.9g)", (double)n.x, (double)n.y, (double)n.z);
    }
}

static void angle11_fast_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        hdrp_v3 n = hard_normal(a, i, 2047.0);
        double t[3];
        random_tangent(a, n, t);
        hdrp_v3 tangent = hdrp_v3_make((float)t[0], (float)t[1], (float)t[2]);
        hdrp_u32 code = hdrp_pack_angle11_from_tangent_fast(n, tangent);
        ACC_ADD(a, degrees(hdrp_pack_tangent_from_angle11_fast(n, code), t),
                "n = (%.9g, %.9g, %.9g)", (double)n.x, (double)n.y, (double)n.z);
    }
}

/* The default tangent, turned about n by Rodrigues' formula in double. */
static double turned_tangent_error(hdrp_v3 measured, hdrp_v3 n, double angle)
{
    hdrp_v3 t = hdrp_basis_from_normal(n).tangent;
    double m[3] = {(double)n.x, (double)n.y, (double)n.z};
    double t0[3] = {(double)t.x, (double)t.y, (double)t.z}, side[3];
    cross(m, t0, side);
    return acc_larger(
        fabs((double)measured.x - (t0[0] * cos(angle) + side[0] * sin(angle))),
        acc_larger(fabs((double)measured.y - (t0[1] * cos(angle) + side[1] * sin(angle))),
                   fabs((double)measured.z - (t0[2] * cos(angle) + side[2] * sin(angle)))));
}

static void tangent_from_angle11_error(acc* a)
{
    for (int i = 0; i < 204800; ++i) {
        hdrp_v3 n = hard_normal(a, i, 2047.0);
        hdrp_u32 code = (hdrp_u32)i & 2047u;
        ACC_ADD(a,
                turned_tangent_error(hdrp_pack_tangent_from_angle11(n, code), n,
                                     (double)code * (3.14159265358979323846 / 2048.0)),
                "code %u", code);
    }
}

static void tangent_from_angle11_fast_error(acc* a)
{
    for (int i = 0; i < 204800; ++i) {
        hdrp_v3 n = hard_normal(a, i, 2047.0);
        hdrp_u32 code = (hdrp_u32)i & 2047u;
        double smaller = asin((double)(code >> 3u) / 255.0 * sqrt(0.5));
        double from_axis = 0.5 * 3.14159265358979323846 - smaller;
        double angle = (code & 4u) ? smaller : from_axis;
        angle = (code & 2u) ? 3.14159265358979323846 - angle : angle;
        angle = (code & 1u) ? -angle : angle;
        ACC_ADD(a, turned_tangent_error(hdrp_pack_tangent_from_angle11_fast(n, code), n, angle),
                "code %u", code);
    }
}

static void normal_buffer_normal_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        hdrp_v3 n = hard_normal(a, i, 2047.0);
        double reference[3] = {(double)n.x, (double)n.y, (double)n.z};
        hdrp_u32 texel = hdrp_pack_rgba8_from_v4(hdrp_pack_normal_buffer_encode(n, 0.5f));
        hdrp_v3 m = hdrp_pack_normal_buffer_decode(hdrp_pack_v4_from_rgba8(texel)).normal;
        ACC_ADD(a, (m.z < 0.0f) == (n.z < 0.0f) ? degrees(m, reference) : HUGE_VAL,
                "n = (%.9g, %.9g, %.9g)", (double)n.x, (double)n.y, (double)n.z);
    }
}

static void normal_buffer_roughness_error(acc* a)
{
    hdrp_v3 up = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    for (int i = 0; i < 100000; ++i) {
        float r = acc_float(i % 2 ? acc_uniform(a, 0.0, 1.0) : ((double)(i % 510) + 0.5) / 510.0);
        hdrp_u32 texel = hdrp_pack_rgba8_from_v4(hdrp_pack_normal_buffer_encode(up, r));
        double decoded = (double)hdrp_pack_normal_buffer_decode(hdrp_pack_v4_from_rgba8(texel))
                             .perceptual_roughness;
        ACC_ADD(a, fabs(decoded - (double)r), "roughness %.9g", (double)r);
    }
}

static void sss_mask_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        hdrp_pack_sss s;
        s.diffuse_color = hdrp_v3_splat(0.25f);
        s.diffusion_profile = (hdrp_u32)i & 15u;
        s.subsurface_mask = acc_float(acc_uniform(a, 0.0, 1.0));
        hdrp_u32 texel = hdrp_pack_srgba8_from_linear(hdrp_pack_sss_buffer_encode(s));
        hdrp_pack_sss m = hdrp_pack_sss_buffer_decode(hdrp_pack_linear_from_srgba8(texel));
        double error = fabs((double)m.subsurface_mask - (double)s.subsurface_mask);
        ACC_ADD(a, m.diffusion_profile == s.diffusion_profile ? error : HUGE_VAL, "mask %.9g",
                (double)s.subsurface_mask);
    }
}

static hdrp_v3 random_color(acc* a)
{
    return hdrp_v3_make(acc_float(acc_uniform(a, 0.0, 1.0)), acc_float(acc_uniform(a, 0.0, 1.0)),
                        acc_float(acc_uniform(a, 0.0, 1.0)));
}

/* A random valid material of the given feature. */
static hdrp_brdf_data random_material(acc* a, int i, hdrp_u32 features)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    double t[3];
    s.base_color = random_color(a);
    s.metallic = acc_float(acc_uniform(a, 0.0, 1.0));
    s.normal = hard_normal(a, i, 2047.0);
    random_tangent(a, s.normal, t);
    s.tangent = hdrp_v3_make((float)t[0], (float)t[1], (float)t[2]);
    s.anisotropy = acc_float(acc_uniform(a, -1.0, 1.0));
    s.coat_mask = acc_float(acc_uniform(a, 0.0, 1.0));
    s.film_ior = acc_float(acc_uniform(a, 1.0, 3.0));
    s.film_thickness_nm = acc_float(acc_uniform(a, 0.0, 3000.0));
    s.features = features | HDRP_BRDF_FEATURE_CLEAR_COAT;
    return hdrp_brdf_data_from_surface(s);
}

static hdrp_brdf_data through_texels(hdrp_brdf_data d)
{
    hdrp_pack_gbuffer_extra e;
    e.emissive = e.static_diffuse = hdrp_v3_splat(0.0f);
    e.specular_occlusion_data = hdrp_v2_make(0.0f, 0.0f);
    e.light_layers = 0u;
    e.shadow_masks = hdrp_v4_make(0.0f, 0.0f, 0.0f, 0.0f);
    e.targets = 0u;
    hdrp_pack_gbuffer_texel t =
        hdrp_pack_gbuffer_texel_from_targets(hdrp_pack_gbuffer_encode(d, e));
    return hdrp_pack_gbuffer_decode(hdrp_pack_gbuffer_targets_from_texel(t), 0u);
}

static void gbuffer_normal_error(acc* a)
{
    for (int i = 0; i < 60000; ++i) {
        hdrp_u32 feature = 1u << (hdrp_u32)(i % 4);
        hdrp_brdf_data d = random_material(a, i / 4, i % 5 == 4 ? 0u : feature);
        double reference[3] = {(double)d.normal.x, (double)d.normal.y, (double)d.normal.z};
        hdrp_v3 n = through_texels(d).normal;
        ACC_ADD(a, (n.z < 0.0f) == (d.normal.z < 0.0f) ? degrees(n, reference) : HUGE_VAL,
                "n = (%.9g, %.9g, %.9g)", reference[0], reference[1], reference[2]);
    }
}

static void gbuffer_tangent_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        hdrp_brdf_data d = random_material(a, i, HDRP_BRDF_FEATURE_ANISOTROPY);
        double reference[3] = {(double)d.tangent.x, (double)d.tangent.y, (double)d.tangent.z};
        ACC_ADD(a, unsigned_degrees(through_texels(d).tangent, reference), "n = (%.9g, %.9g, %.9g)",
                (double)d.normal.x, (double)d.normal.y, (double)d.normal.z);
    }
}

static double srgb_difference(hdrp_v3 a, hdrp_v3 b)
{
    double x[3] = {(double)a.x, (double)a.y, (double)a.z},
           y[3] = {(double)b.x, (double)b.y, (double)b.z};
    double worst = 0.0;
    for (int i = 0; i < 3; ++i) {
        double ex = x[i] <= 0.0031308 ? 12.92 * x[i] : 1.055 * pow(x[i], 1.0 / 2.4) - 0.055;
        double ey = y[i] <= 0.0031308 ? 12.92 * y[i] : 1.055 * pow(y[i], 1.0 / 2.4) - 0.055;
        worst = acc_larger(worst, fabs(ex - ey));
    }
    return worst;
}

static void gbuffer_color_error(acc* a)
{
    for (int i = 0; i < 20000; ++i) {
        hdrp_brdf_data d = random_material(a, i, 0u);
        ACC_ADD(a, srgb_difference(d.diffuse_color, through_texels(d).diffuse_color),
                "diffuse colour");
        d = random_material(a, i, HDRP_BRDF_FEATURE_ANISOTROPY);
        ACC_ADD(a, srgb_difference(d.base_color, through_texels(d).base_color), "base colour");
    }
}

static void gbuffer_fresnel0_error(acc* a)
{
    for (int i = 0; i < 60000; ++i) {
        hdrp_brdf_data d = random_material(a, i, 0u);
        ACC_ADD(a, srgb_difference(d.fresnel0, through_texels(d).fresnel0), "(%.9g, %.9g, %.9g)",
                (double)d.fresnel0.x, (double)d.fresnel0.y, (double)d.fresnel0.z);
    }
}

static void gbuffer_5_bits_error(acc* a)
{
    for (int i = 0; i < 40000; ++i) {
        hdrp_brdf_data d = random_material(
            a, i, i % 2 ? HDRP_BRDF_FEATURE_ANISOTROPY : HDRP_BRDF_FEATURE_IRIDESCENCE);
        hdrp_brdf_data m = through_texels(d);
        ACC_ADD(a, fabs((double)m.metallic - (double)d.metallic), "metallic %.9g",
                (double)d.metallic);
        ACC_ADD(a, fabs((double)m.coat_mask - (double)d.coat_mask), "coat mask %.9g",
                (double)d.coat_mask);
    }
}

static void gbuffer_film_ior_error(acc* a)
{
    for (int i = 0; i < 40000; ++i) {
        hdrp_brdf_data d = random_material(a, i, HDRP_BRDF_FEATURE_IRIDESCENCE);
        ACC_ADD(a, fabs((double)through_texels(d).film_ior - (double)d.film_ior), "film IOR %.9g",
                (double)d.film_ior);
    }
}

static void gbuffer_anisotropy_error(acc* a)
{
    for (int i = 0; i < 40000; ++i) {
        hdrp_brdf_data d = random_material(a, i, HDRP_BRDF_FEATURE_ANISOTROPY);
        ACC_ADD(a, fabs((double)through_texels(d).anisotropy - (double)d.anisotropy),
                "anisotropy %.9g", (double)d.anisotropy);
    }
}

/* The product, which the phase of the fringes depends on; worst where the stored thickness would
 * have to exceed its maximum. */
static void gbuffer_film_path_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        hdrp_brdf_data d = random_material(a, i, HDRP_BRDF_FEATURE_IRIDESCENCE);
        if (i % 4 == 0) {
            d.film_thickness_nm = 3000.0f;
        }
        hdrp_brdf_data m = through_texels(d);
        ACC_ADD(a,
                fabs((double)m.film_thickness_nm * (double)m.film_ior -
                     (double)d.film_thickness_nm * (double)d.film_ior),
                "%.9g nm, IOR %.9g", (double)d.film_thickness_nm, (double)d.film_ior);
    }
}

const acc_entry acc_pack[] = {
    {"pack_unorm_codes", unorm_codes_error},
    {"pack_float_from_unorm", float_from_unorm_error},
    {"pack_snorm_codes", snorm_codes_error},
    {"pack_float_from_snorm", float_from_snorm_error},
    {"pack_biased_snorm_8", biased_snorm_8_error},
    {"pack_srgb8_codes", srgb8_codes_error},
    {"pack_linear_from_srgb8", linear_from_srgb8_error},
    {"pack_half", half_error},
    {"pack_half_denormal", half_denormal_error},
    {"pack_r11", r11_error},
    {"pack_b10", b10_error},
    {"pack_float_uint_3_of_8", float_uint_3_of_8_error},
    {"pack_float_uint_4_of_8", float_uint_4_of_8_error},
    {"pack_oct_snorm_8", oct_snorm_8_error},
    {"pack_oct_snorm_12", oct_snorm_12_error},
    {"pack_oct_snorm_16", oct_snorm_16_error},
    {"pack_oct_snorm_exact_8", oct_snorm_exact_8_error},
    {"pack_oct_snorm_exact_12", oct_snorm_exact_12_error},
    {"pack_oct_snorm_exact_12_away", oct_snorm_exact_12_away_error},
    {"pack_oct_snorm_exact_16", oct_snorm_exact_16_error},
    {"pack_oct_unorm_8", oct_unorm_8_error},
    {"pack_oct_unorm_12", oct_unorm_12_error},
    {"pack_oct_unorm_16", oct_unorm_16_error},
    {"pack_oct_unorm_exact_8", oct_unorm_exact_8_error},
    {"pack_oct_unorm_exact_12", oct_unorm_exact_12_error},
    {"pack_oct_unorm_exact_16", oct_unorm_exact_16_error},
    {"pack_normal_from_oct_snorm", normal_from_oct_snorm_error},
    {"pack_normal_from_oct_unorm", normal_from_oct_unorm_error},
    {"pack_angle11", angle11_error},
    {"pack_angle11_fast", angle11_fast_error},
    {"pack_tangent_from_angle11", tangent_from_angle11_error},
    {"pack_tangent_from_angle11_fast", tangent_from_angle11_fast_error},
    {"pack_normal_buffer_normal", normal_buffer_normal_error},
    {"pack_normal_buffer_roughness", normal_buffer_roughness_error},
    {"pack_sss_mask", sss_mask_error},
    {"pack_gbuffer_normal", gbuffer_normal_error},
    {"pack_gbuffer_tangent", gbuffer_tangent_error},
    {"pack_gbuffer_color", gbuffer_color_error},
    {"pack_gbuffer_fresnel0", gbuffer_fresnel0_error},
    {"pack_gbuffer_5_bits", gbuffer_5_bits_error},
    {"pack_gbuffer_anisotropy", gbuffer_anisotropy_error},
    {"pack_gbuffer_film_ior", gbuffer_film_ior_error},
    {"pack_gbuffer_film_path", gbuffer_film_path_error},
    {NULL, NULL},
};
