/* codecs_pack.c - every code of the codecs of hdrp_pack.h, and the directions they store worst.
 * SPDX-License-Identifier: MIT */
#include "exhaustive.h"

#include "hdrp_pack.h"

/* ---- scalar codes ---------------------------------------------------------------------------- */

/* Index 2^bits + code: every code of every width below 17. */
static hdrp_u32 width_of(uint32_t index)
{
    hdrp_u32 bits = 0u;
    while (index >> (bits + 1u) != 0u) {
        ++bits;
    }
    return bits;
}

static double unorm_error(uint32_t index)
{
    hdrp_u32 bits = width_of(index), code = index - (1u << bits);
    if (bits < 1u) {
        return -1.0;
    }
    float x = hdrp_pack_float_from_unorm(code, bits);
    bool survives = hdrp_pack_unorm_from_float(x, bits) == code &&
                    hdrp_pack_unorm_target(x, bits) == x && x >= 0.0f && x <= 1.0f;
    double reference = (double)code / ((double)(1u << bits) - 1.0);
    return survives ? ex_ulp((double)x, reference) : HUGE_VAL;
}

/* The most negative code stands for the next. */
static double snorm_error(uint32_t index)
{
    hdrp_u32 bits = width_of(index), code = index - (1u << bits);
    if (bits < 2u) {
        return -1.0;
    }
    hdrp_u32 half = 1u << (bits - 1u);
    float x = hdrp_pack_float_from_snorm(code, bits);
    double last = (double)half - 1.0, value = (double)code;
    value -= code >= half ? 2.0 * (double)half : 0.0;
    return hdrp_pack_snorm_from_float(x, bits) == (code == half ? half + 1u : code)
               ? ex_ulp((double)x, fmax(value / last, -1.0))
               : HUGE_VAL;
}

/* Offset binary, whose lowest code stands for the next. */
static double biased_snorm_error(uint32_t index)
{
    hdrp_u32 bits = width_of(index), code = index - (1u << bits);
    if (bits < 2u) {
        return -1.0;
    }
    float x =
        hdrp_pack_float_from_biased_snorm_target(hdrp_pack_float_from_unorm(code, bits), bits);
    float target = hdrp_pack_biased_snorm_target(x, bits);
    double middle = (double)(1u << (bits - 1u));
    return hdrp_pack_unorm_from_float(target, bits) == (code == 0u ? 1u : code)
               ? ex_ulp((double)x, fmax((double)code - middle, 1.0 - middle) / (middle - 1.0))
               : HUGE_VAL;
}

static double srgb8_error(uint32_t code)
{
    float x = hdrp_pack_linear_from_srgb8(code);
    double c = (double)code / 255.0;
    double reference = c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
    return hdrp_pack_srgb8_from_linear(x) == code ? ex_relative((double)x, reference) : HUGE_VAL;
}

/* Either decoder with either encoder. */
static double srgb8_fast_error(uint32_t code)
{
    float c = hdrp_pack_float_from_unorm(code, 8u), x = hdrp_linear_from_srgb_fast(c);
    float plain = hdrp_linear_from_srgb(c);
    bool survives = hdrp_pack_unorm_from_float(hdrp_srgb_from_linear_fast(x), 8u) == code &&
                    hdrp_pack_unorm_from_float(hdrp_srgb_from_linear(x), 8u) == code &&
                    hdrp_pack_unorm_from_float(hdrp_srgb_from_linear_fast(plain), 8u) == code;
    return survives ? 0.0 : HUGE_VAL;
}

/* Index channel * 256 + code. */
static double rgba8_error(uint32_t index)
{
    hdrp_u32 texel = (index & 255u) << (8u * (index >> 8u));
    hdrp_v4 v = hdrp_pack_v4_from_rgba8(texel), linear = hdrp_pack_linear_from_srgba8(texel);
    bool survives =
        hdrp_pack_rgba8_from_v4(v) == texel && hdrp_pack_srgba8_from_linear(linear) == texel;
    return survives ? 0.0 : HUGE_VAL;
}

/* ---- small floats ---------------------------------------------------------------------------- */

/* What a code of five exponent bits is by the definition of the format; infinity and NaN too. */
static double small_float(uint32_t code, int mantissa_bits)
{
    uint32_t exponent = code >> mantissa_bits, mantissa = code & ((1u << mantissa_bits) - 1u);
    double share = ldexp((double)mantissa, -mantissa_bits);
    if (exponent == 31u) {
        return mantissa == 0u ? HUGE_VAL : (double)NAN;
    }
    return exponent == 0u ? ldexp(share, -14) : ldexp(1.0 + share, (int)exponent - 15);
}

static bool same(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* A NaN becomes quiet. */
static double half_error(uint32_t code)
{
    float x = hdrp_pack_float_from_half(code);
    double reference = small_float(code & 0x7fffu, 10);
    bool is_nan = isnan(reference);
    bool decoded =
        same(fabs((double)x), reference) && (is_nan || (signbit(x) != 0) == (code >> 15u != 0u));
    bool survives = hdrp_pack_half_from_float(x) == (is_nan ? code | 0x200u : code);
    bool saturated =
        isinf(reference) || hdrp_pack_half_from_float_saturated(x) == hdrp_pack_half_from_float(x);
    return decoded && survives && saturated ? 0.0 : HUGE_VAL;
}

/* Index channel * 2048 + code. Of the NaNs only that they stay such. */
static double r11g11b10f_error(uint32_t index)
{
    uint32_t channel = index >> 11u, code = index & 2047u;
    if (channel == 2u && code > 1023u) {
        return -1.0;
    }
    hdrp_u32 texel = code << (11u * channel);
    hdrp_v3 v = hdrp_pack_rgb_from_r11g11b10f(texel);
    float x = channel == 0u ? v.x : channel == 1u ? v.y : v.z;
    double reference = small_float(code, channel == 2u ? 5 : 6);
    hdrp_u32 again = hdrp_pack_r11g11b10f_from_rgb(v);
    hdrp_v3 w = hdrp_pack_rgb_from_r11g11b10f(again);
    float y = channel == 0u ? w.x : channel == 1u ? w.y : w.z;
    bool survives = isnan(reference) ? isnan(y) : again == texel;
    return same((double)x, reference) && survives ? 0.0 : HUGE_VAL;
}

/* ---- float and integer together -------------------------------------------------------------- */

/* Index bits_i * 2^17 + 2^bits_target + code: every code of every split. */
static double float_uint_walk_error(uint32_t index)
{
    hdrp_u32 bits_i = index >> 17u, rest = index & 0x1ffffu;
    hdrp_u32 bits_target = rest == 0u ? 0u : width_of(rest);
    if (bits_target < 1u || bits_i > bits_target) {
        return -1.0;
    }
    hdrp_u32 code = rest - (1u << bits_target), bits_f = bits_target - bits_i;
    hdrp_pack_float_uint_pair p = hdrp_pack_float_uint_from_code(code, bits_i, bits_target);
    float target = hdrp_pack_float_uint(p.f, p.i, bits_i, bits_target);
    hdrp_pack_float_uint_pair q = hdrp_pack_float_uint_from_target(target, bits_i, bits_target);
    bool survives = hdrp_pack_float_uint_code(p.f, p.i, bits_i, bits_target) == code &&
                    hdrp_pack_unorm_from_float(target, bits_target) == code && q.i == p.i &&
                    q.f == p.f && p.i == code >> bits_f;
    double last = fmax((double)(1u << bits_f) - 1.0, 1.0);
    return survives ? ex_ulp((double)p.f, (double)(code & ((1u << bits_f) - 1u)) / last) : HUGE_VAL;
}

/* ---- octahedral codes ------------------------------------------------------------------------ */

typedef hdrp_u32 oct_encoder(hdrp_v3 n, hdrp_u32 bits);
typedef hdrp_v3 oct_decoder(hdrp_u32 code, hdrp_u32 bits);

static double degrees_between(hdrp_v3 a, const double b[3])
{
    double x = (double)a.x, y = (double)a.y, z = (double)a.z;
    double c[3] = {y * b[2] - z * b[1], z * b[0] - x * b[2], x * b[1] - y * b[0]};
    double s = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    return atan2(s, x * b[0] + y * b[1] + z * b[2]) * (180.0 / EX_PI);
}

static double degrees_between_floats(hdrp_v3 a, hdrp_v3 b)
{
    double d[3] = {(double)b.x, (double)b.y, (double)b.z};
    return degrees_between(a, d);
}

/* A decoded direction against the definition of the map: below the equator a point is the mirror
 * image in the line |x| + |y| = 1. x and y are those of the code, in [-1,1]. */
static double unfolded_error(hdrp_v3 measured, double x, double y)
{
    double n[3] = {x, y, 1.0 - fabs(x) - fabs(y)};
    if (n[2] < 0.0) {
        n[0] = copysign(1.0 - fabs(y), x);
        n[1] = copysign(1.0 - fabs(x), y);
    }
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return fmax(
        fabs((double)measured.x - n[0] / length),
        fmax(fabs((double)measured.y - n[1] / length), fabs((double)measured.z - n[2] / length)));
}

static double snorm12(hdrp_u32 code)
{
    return fmax((double)(code < 2048u ? (int)code : (int)code - 4096) / 2047.0, -1.0);
}

static double oct_snorm_decoded_error(uint32_t code)
{
    return unfolded_error(hdrp_pack_normal_from_oct_snorm(code, 12u), snorm12(code & 4095u),
                          snorm12(code >> 12u));
}

static double oct_unorm_decoded_error(uint32_t code)
{
    return unfolded_error(hdrp_pack_normal_from_oct_unorm(code, 12u),
                          2.0 * (double)(code & 4095u) / 4095.0 - 1.0,
                          2.0 * (double)(code >> 12u) / 4095.0 - 1.0);
}

/* A code decodes to a direction whose code decodes to it again: the code itself, or where several
 * mean the same direction another of these. The side of the equator stays. */
static double oct_again(oct_encoder* encode, oct_decoder* decode, uint32_t code, hdrp_u32 bits)
{
    hdrp_v3 n = decode(code, bits);
    hdrp_u32 again = encode(n, bits);
    hdrp_v3 m = decode(again, bits);
    bool same_side = (m.z < 0.0f) == (n.z < 0.0f);
    return again == code ? 0.0 : same_side ? degrees_between_floats(n, m) : HUGE_VAL;
}

#define OCT_WALK(kind, bits)                                                                       \
    static double oct_##kind##_##bits##_error(uint32_t code)                                       \
    {                                                                                              \
        return oct_again(hdrp_pack_oct_##kind##_from_normal, hdrp_pack_normal_from_oct_##kind,     \
                         code, bits##u);                                                           \
    }                                                                                              \
    static double oct_##kind##_exact_##bits##_error(uint32_t code)                                 \
    {                                                                                              \
        return oct_again(hdrp_pack_oct_##kind##_from_normal_exact,                                 \
                         hdrp_pack_normal_from_oct_##kind, code, bits##u);                         \
    }
OCT_WALK(snorm, 8)
OCT_WALK(snorm, 12)
OCT_WALK(unorm, 8)
OCT_WALK(unorm, 12)

static double oct24_target_error(uint32_t code)
{
    hdrp_v3 target = hdrp_pack_oct24_target(code);
    hdrp_v4 stored =
        hdrp_pack_v4_from_rgba8(hdrp_pack_rgba8_from_v4(hdrp_v4_from_v3(target, 0.0f)));
    return hdrp_pack_oct24_from_target(target) == code &&
                   hdrp_pack_oct24_from_target(hdrp_v3_from_v4(stored)) == code
               ? 0.0
               : HUGE_VAL;
}

static hdrp_v3 rounded(const ex_point* p)
{
    return hdrp_v3_make((float)p->direction[0], (float)p->direction[1], (float)p->direction[2]);
}

/* Against the rounded direction, which is what the encoder was given. */
static double oct_stored(oct_encoder* encode, oct_decoder* decode, hdrp_u32 bits, const ex_point* p)
{
    hdrp_v3 n = rounded(p), m = decode(encode(n, bits), bits);
    return (m.z < 0.0f) == (n.z < 0.0f) ? degrees_between_floats(m, n) : HUGE_VAL;
}

#define OCT_SEARCH(kind, bits)                                                                     \
    static double stored_##kind##_##bits(const ex_point* p)                                        \
    {                                                                                              \
        return oct_stored(hdrp_pack_oct_##kind##_from_normal, hdrp_pack_normal_from_oct_##kind,    \
                          bits##u, p);                                                             \
    }                                                                                              \
    static double stored_##kind##_exact_##bits(const ex_point* p)                                  \
    {                                                                                              \
        return oct_stored(hdrp_pack_oct_##kind##_from_normal_exact,                                \
                          hdrp_pack_normal_from_oct_##kind, bits##u, p);                           \
    }
OCT_SEARCH(snorm, 8)
OCT_SEARCH(snorm, 12)
OCT_SEARCH(snorm, 16)
OCT_SEARCH(unorm, 8)
OCT_SEARCH(unorm, 12)
OCT_SEARCH(unorm, 16)

/* Without the normals just below the equator, where SNORM has to leave its codes with z = 0. */
static double stored_snorm_exact_12_away(const ex_point* p)
{
    float z = (float)p->direction[2];
    return z < 0.0f && z > -1e-3f ? -1.0 : stored_snorm_exact_12(p);
}

/* ---- tangents -------------------------------------------------------------------------------- */

/* Index normal * 2048 + code; normals spiral from pole to pole. */
static hdrp_v3 spiral_normal(uint32_t i, uint32_t n)
{
    double z = 1.0 - (2.0 * (double)i + 1.0) / (double)n, phi = 2.39996322972865332 * (double)i;
    double r = sqrt(1.0 - z * z);
    return hdrp_v3_make((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

static double angle11_again_error(uint32_t index)
{
    hdrp_v3 n = spiral_normal(index >> 11u, 512u), t = hdrp_pack_tangent_from_angle11(n, index);
    return hdrp_pack_angle11_from_tangent(n, t) == (index & 2047u) ? 0.0 : HUGE_VAL;
}

/* Several codes may mean the same tangent: those on an axis. */
static double angle11_fast_again_error(uint32_t index)
{
    hdrp_v3 n = spiral_normal(index >> 11u, 512u);
    hdrp_v3 t = hdrp_pack_tangent_from_angle11_fast(n, index);
    hdrp_u32 again = hdrp_pack_angle11_from_tangent_fast(n, t);
    return again == (index & 2047u)
               ? 0.0
               : degrees_between_floats(hdrp_pack_tangent_from_angle11_fast(n, again), t);
}

/* The tangent at an angle about the direction; *t in double, and rounded what is encoded. */
static hdrp_v3 tangent_at(const ex_point* p, double t[3])
{
    const double* n = p->direction;
    double axis[3] = {fabs(n[0]) < 0.6 ? 1.0 : 0.0, fabs(n[0]) < 0.6 ? 0.0 : 1.0, 0.0};
    double dot = axis[0] * n[0] + axis[1] * n[1], u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = axis[k] - dot * n[k];
    }
    double length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    v[0] = (n[1] * u[2] - n[2] * u[1]) / length;
    v[1] = (n[2] * u[0] - n[0] * u[2]) / length;
    v[2] = (n[0] * u[1] - n[1] * u[0]) / length;
    for (int k = 0; k < 3; ++k) {
        t[k] = cos(p->angle) * u[k] / length + sin(p->angle) * v[k];
    }
    return hdrp_v3_make((float)t[0], (float)t[1], (float)t[2]);
}

static double stored_angle11(const ex_point* p)
{
    double t[3];
    hdrp_v3 n = rounded(p), tangent = tangent_at(p, t);
    hdrp_u32 code = hdrp_pack_angle11_from_tangent(n, tangent);
    double e = degrees_between(hdrp_pack_tangent_from_angle11(n, code), t);
    return fmin(e, 180.0 - e);
}

static double stored_angle11_fast(const ex_point* p)
{
    double t[3];
    hdrp_v3 n = rounded(p), tangent = tangent_at(p, t);
    hdrp_u32 code = hdrp_pack_angle11_from_tangent_fast(n, tangent);
    return degrees_between(hdrp_pack_tangent_from_angle11_fast(n, code), t);
}

/* Decoding rounds directions by 1.8e-7, which is this many degrees: codes of one direction. */
#define SAME_DIRECTION 3e-5

const ex_walk ex_walks_pack[] = {
    {"hdrp_pack_float_from_unorm", "every code of 1 to 16 bits", "pack_float_from_unorm", 0.0, "",
     1u << 17, 1u, unorm_error},
    {"hdrp_pack_float_from_snorm", "every code of 2 to 16 bits", "pack_float_from_snorm", 0.0, "",
     1u << 17, 1u, snorm_error},
    {"hdrp_pack_float_from_biased_snorm_target", "every code of 2 to 16 bits", NULL, 0.5, "ulp",
     1u << 17, 1u, biased_snorm_error},
    {"hdrp_pack_linear_from_srgb8", "every code", "pack_linear_from_srgb8", 0.0, "", 256u, 1u,
     srgb8_error},
    {"hdrp_linear_from_srgb_fast", "every 8-bit code survives", NULL, 0.0, "absolute", 256u, 1u,
     srgb8_fast_error},
    {"hdrp_pack_v4_from_rgba8", "every code of every channel survives", NULL, 0.0, "absolute",
     1024u, 1u, rgba8_error},
    {"hdrp_pack_float_from_half", "every code", NULL, 0.0, "absolute", 65536u, 1u, half_error},
    {"hdrp_pack_rgb_from_r11g11b10f", "every code of every channel", NULL, 0.0, "absolute",
     3u * 2048u, 1u, r11g11b10f_error},
    {"hdrp_pack_float_uint_from_code", "every code of every split up to 16 bits", NULL, 0.5, "ulp",
     17u << 17, 1u, float_uint_walk_error},
    {"hdrp_pack_oct24_target", "every code", NULL, 0.0, "absolute", 1u << 24, 61u,
     oct24_target_error},
    {"hdrp_pack_normal_from_oct_snorm", "every code of 12 and 12 bits",
     "pack_normal_from_oct_snorm", 0.0, "", 1u << 24, 61u, oct_snorm_decoded_error},
    {"hdrp_pack_normal_from_oct_unorm", "every code of 12 and 12 bits",
     "pack_normal_from_oct_unorm", 0.0, "", 1u << 24, 61u, oct_unorm_decoded_error},
    {"hdrp_pack_oct_snorm_from_normal", "every code of 8 and 8 bits survives", NULL, SAME_DIRECTION,
     "degrees", 1u << 16, 1u, oct_snorm_8_error},
    {"hdrp_pack_oct_snorm_from_normal_exact", "every code of 8 and 8 bits survives", NULL,
     SAME_DIRECTION, "degrees", 1u << 16, 1u, oct_snorm_exact_8_error},
    {"hdrp_pack_oct_unorm_from_normal", "every code of 8 and 8 bits survives", NULL, SAME_DIRECTION,
     "degrees", 1u << 16, 1u, oct_unorm_8_error},
    {"hdrp_pack_oct_unorm_from_normal_exact", "every code of 8 and 8 bits survives", NULL,
     SAME_DIRECTION, "degrees", 1u << 16, 1u, oct_unorm_exact_8_error},
    {"hdrp_pack_oct_snorm_from_normal", "every code of 12 and 12 bits survives", NULL,
     SAME_DIRECTION, "degrees", 1u << 24, 61u, oct_snorm_12_error},
    {"hdrp_pack_oct_snorm_from_normal_exact", "every code of 12 and 12 bits survives", NULL,
     SAME_DIRECTION, "degrees", 1u << 24, 61u, oct_snorm_exact_12_error},
    {"hdrp_pack_oct_unorm_from_normal", "every code of 12 and 12 bits survives", NULL,
     SAME_DIRECTION, "degrees", 1u << 24, 61u, oct_unorm_12_error},
    {"hdrp_pack_oct_unorm_from_normal_exact", "every code of 12 and 12 bits survives", NULL,
     SAME_DIRECTION, "degrees", 1u << 24, 61u, oct_unorm_exact_12_error},
    {"hdrp_pack_tangent_from_angle11", "every code of 512 normals survives", NULL, 0.0, "degrees",
     1u << 20, 3u, angle11_again_error},
    {"hdrp_pack_tangent_from_angle11_fast", "every code of 512 normals survives", NULL,
     SAME_DIRECTION, "degrees", 1u << 20, 3u, angle11_fast_again_error},
    {NULL, NULL, NULL, 0.0, NULL, 0u, 0u, NULL},
};

#define OCT_ROWS(kind, bits)                                                                       \
    {"hdrp_pack_oct_" #kind "_from_normal", "search at " #bits " bits",                            \
     "pack_oct_" #kind "_" #bits, stored_##kind##_##bits},                                         \
    {                                                                                              \
        "hdrp_pack_oct_" #kind "_from_normal_exact", "search at " #bits " bits",                   \
            "pack_oct_" #kind "_exact_" #bits, stored_##kind##_exact_##bits                        \
    }

const ex_search ex_searches_pack[] = {
    OCT_ROWS(snorm, 8),
    OCT_ROWS(snorm, 12),
    OCT_ROWS(snorm, 16),
    OCT_ROWS(unorm, 8),
    OCT_ROWS(unorm, 12),
    OCT_ROWS(unorm, 16),
    {"hdrp_pack_oct_snorm_from_normal_exact", "search at 12 bits but z in -1e-3 to 0",
     "pack_oct_snorm_exact_12_away", stored_snorm_exact_12_away},
    {"hdrp_pack_angle11_from_tangent", "search", "pack_angle11", stored_angle11},
    {"hdrp_pack_angle11_from_tangent_fast", "search", "pack_angle11_fast", stored_angle11_fast},
    {NULL, NULL, NULL, NULL},
};
