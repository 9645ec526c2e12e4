/* hdrp_math.h - language layer, vectors, fast math, colour, surface gradients, sampling.
 * SPDX-License-Identifier: MIT
 *
 * One text for C99, C++11, GLSL 450, GLSL 310 es and HLSL; OpenCL C and CUDA read it too.
 * Every other hdrp header includes this one. There is nothing to build or link but libm:
 *
 *     #include "hdrp_math.h"
 *     hdrp_v3 sun = hdrp_rec709_from_kelvin(5800.0f);
 *
 * In GLSL, enable the include mechanism first (or paste the file with your own):
 *
 *     #version 450
 *     #extension GL_GOOGLE_include_directive : require
 *     #include "hdrp_math.h"
 *
 * In HLSL, DXC is recognised by itself; with another compiler define HDRP_HLSL.
 *
 * Conventions. Space is right-handed, +Y up. Colour is linear Rec.709 with the D65 white point
 * unless a name says otherwise. Functions are pure and total: inside the documented closed range
 * of its arguments a result is finite and right. Comparisons are written so that a NaN takes the
 * documented safe branch: never compile with -ffast-math, which deletes such guards; use
 * -fno-math-errno instead, which lets gcc vectorise square roots and costs nothing.
 *
 * Override macros, all optional and defined before the first inclusion:
 *     HDRP_FN   qualifier of formula functions      default "static inline" (C, C++)
 *     HDRP_API  qualifier of algorithm functions    default "extern" (C, C++)
 *     HDRP_HLSL the compiler reads HLSL             default: set where DXC is recognised
 *
 * >>index of the functions, without hdrp_ (written by tools/api_check.py --write)
 *   language layer: sqrt sin cos tan asin acos atan2 exp exp2 log log2 pow floor abs f32_from_u32
 *       u32_from_f32 bits_from_f32 f32_from_bits min max clamp saturate lerp sq sign_not_zero
 *   vectors: v2_make v3_make v4_make u32x4_make v2_add v2_sub v2_scale v2_dot v3_splat v3_add
 *       v3_sub v3_mul v3_scale v3_mad v3_neg v3_lerp v3_max v3_saturate v3_max_component v3_dot
 *       v3_cross v3_length v3_normalize v4_mul v4_dot v3_from_v4 v4_from_v3 normalize_or
 *       basis_from_normal
 *   algorithm layer: result_string
 * >>end
 */
#ifndef HDRP_MATH_H
#define HDRP_MATH_H

#define HDRP_VERSION_MAJOR 0
#define HDRP_VERSION_MINOR 1
#define HDRP_VERSION_PATCH 0
/* major * 10000 + minor * 100 + patch; the other headers refuse a copy of another version. */
#define HDRP_VERSION 100

/* >>language layer
 * The only place that knows which language is being compiled. HLSL is tested first, because
 * glslang's HLSL mode also defines GL_core_profile. */

#if defined(__HLSL_VERSION) && !defined(HDRP_HLSL)
#define HDRP_HLSL 1
#endif

#if defined(HDRP_HLSL)
#define HDRP_GPU   1
#define hdrp_v2    float2
#define hdrp_v3    float3
#define hdrp_v4    float4
#define hdrp_u32x4 uint4
#elif defined(GL_core_profile) || defined(GL_ES)
#define HDRP_GPU   1
#define HDRP_GLSL  1
#define hdrp_v2    vec2
#define hdrp_v3    vec3
#define hdrp_v4    vec4
#define hdrp_u32x4 uvec4
#ifdef GL_ES
precision highp float;
precision highp int;
#endif
#elif defined(__OPENCL_C_VERSION__)
#define HDRP_GPU    1
#define HDRP_OPENCL 1
#endif

#ifdef HDRP_GPU
#ifdef HDRP_OPENCL
#define HDRP_FN         static inline
#define HDRP_TYPEDEF(T) typedef struct T T;
#else
#define HDRP_FN
#define HDRP_TYPEDEF(T)
#endif
#define hdrp_u32 uint
#else
#include <math.h>
#include <stdint.h>
#include <string.h>
#ifndef HDRP_FN
#if defined(__CUDACC__) || defined(__CUDA__)
#define HDRP_FN static inline __attribute__((host)) __attribute__((device))
#else
#define HDRP_FN static inline
#endif
#endif
#ifndef HDRP_API
#define HDRP_API extern
#endif
#define HDRP_TYPEDEF(T) typedef struct T T;
typedef uint32_t hdrp_u32;
#endif

#if !defined(HDRP_HLSL) && !defined(HDRP_GLSL)
struct hdrp_v2 {
    float x, y;
};
HDRP_TYPEDEF(hdrp_v2)
struct hdrp_v3 {
    float x, y, z;
};
HDRP_TYPEDEF(hdrp_v3)
struct hdrp_v4 {
    float x, y, z, w;
};
HDRP_TYPEDEF(hdrp_v4)
struct hdrp_u32x4 {
    hdrp_u32 x, y, z, w;
};
HDRP_TYPEDEF(hdrp_u32x4)
#endif

#define HDRP_PI          3.14159265358979f
#define HDRP_TWO_PI      6.28318530717959f
#define HDRP_HALF_PI     1.57079632679490f
#define HDRP_INV_PI      0.318309886183791f
#define HDRP_SQRT_2      1.41421356237310f
#define HDRP_SQRT_HALF   0.707106781186548f
#define HDRP_FLT_MIN     1.17549435e-38f  /* smallest positive normal float */
#define HDRP_FLT_MAX     3.40282347e+38f  /* largest finite float */
#define HDRP_FLT_EPSILON 1.1920928955e-7f /* distance from 1 to the next float, 2^-23 */

/* HDRP_I_F(sqrt)(x) is the single-precision built-in or libm function. */
#ifdef HDRP_GPU
#define HDRP_I_F(name) name
#else
#define HDRP_I_F(name) name##f
#endif

/** Square root; x >= 0. */
HDRP_FN float hdrp_sqrt(float x)
{
    return HDRP_I_F(sqrt)(x);
}

/** Sine of x [rad]. */
HDRP_FN float hdrp_sin(float x)
{
    return HDRP_I_F(sin)(x);
}

/** Cosine of x [rad]. */
HDRP_FN float hdrp_cos(float x)
{
    return HDRP_I_F(cos)(x);
}

/** Tangent of x [rad]. */
HDRP_FN float hdrp_tan(float x)
{
    return HDRP_I_F(tan)(x);
}

/** Arc sine [rad]; x in [-1,1]. */
HDRP_FN float hdrp_asin(float x)
{
    return HDRP_I_F(asin)(x);
}

/** Arc cosine [rad]; x in [-1,1]. */
HDRP_FN float hdrp_acos(float x)
{
    return HDRP_I_F(acos)(x);
}

/** Angle of the point (x, y) from the +x axis, in [-pi, pi]. GPUs leave (0, 0) undefined. */
HDRP_FN float hdrp_atan2(float y, float x)
{
#ifdef HDRP_GLSL
    return atan(y, x);
#else
    return HDRP_I_F(atan2)(y, x);
#endif
}

/** e to the power x. */
HDRP_FN float hdrp_exp(float x)
{
    return HDRP_I_F(exp)(x);
}

/** 2 to the power x. */
HDRP_FN float hdrp_exp2(float x)
{
    return HDRP_I_F(exp2)(x);
}

/** Natural logarithm; x > 0. */
HDRP_FN float hdrp_log(float x)
{
    return HDRP_I_F(log)(x);
}

/** Logarithm to the base 2; x > 0. */
HDRP_FN float hdrp_log2(float x)
{
    return HDRP_I_F(log2)(x);
}

/** x to the power y; x > 0, since shading languages define no more. */
HDRP_FN float hdrp_pow(float x, float y)
{
    return HDRP_I_F(pow)(x, y);
}

/** Largest integer not above x. */
HDRP_FN float hdrp_floor(float x)
{
    return HDRP_I_F(floor)(x);
}

/** Absolute value. */
HDRP_FN float hdrp_abs(float x)
{
#if defined(HDRP_HLSL) || defined(HDRP_GLSL)
    return abs(x);
#else
    return HDRP_I_F(fabs)(x);
#endif
}

/** u as a float, rounded to nearest where it has more than 24 bits. */
HDRP_FN float hdrp_f32_from_u32(hdrp_u32 u)
{
#ifdef HDRP_OPENCL
    return convert_float(u);
#elif defined(HDRP_GPU)
    return float(u);
#else
    return (float)u;
#endif
}

/** x rounded towards zero; x in [0, 2^32), everything else is undefined. */
HDRP_FN hdrp_u32 hdrp_u32_from_f32(float x)
{
#if defined(HDRP_GPU) && !defined(HDRP_OPENCL)
    return uint(x);
#else
    return (hdrp_u32)x;
#endif
}

/** The IEEE 754 bit pattern of x. */
HDRP_FN hdrp_u32 hdrp_bits_from_f32(float x)
{
#if defined(HDRP_HLSL)
    return asuint(x);
#elif defined(HDRP_GLSL)
    return floatBitsToUint(x);
#elif defined(HDRP_OPENCL)
    return as_uint(x);
#else
    hdrp_u32 u;
    memcpy(&u, &x, sizeof u);
    return u;
#endif
}

/** The float with IEEE 754 bit pattern u. */
HDRP_FN float hdrp_f32_from_bits(hdrp_u32 u)
{
#if defined(HDRP_HLSL)
    return asfloat(u);
#elif defined(HDRP_GLSL)
    return uintBitsToFloat(u);
#elif defined(HDRP_OPENCL)
    return as_float(u);
#else
    float x;
    memcpy(&x, &u, sizeof x);
    return x;
#endif
}

/** The smaller of x and y; y where x is NaN. A ternary, because gcc does not vectorise fminf. */
HDRP_FN float hdrp_min(float x, float y)
{
    return x < y ? x : y;
}

/** The larger of x and y; y where x is NaN. */
HDRP_FN float hdrp_max(float x, float y)
{
    return x > y ? x : y;
}

/** x limited to [lo, hi]; lo where x is NaN. */
HDRP_FN float hdrp_clamp(float x, float lo, float hi)
{
    return hdrp_min(hdrp_max(x, lo), hi);
}

/** x limited to [0, 1]; 0 where x is NaN. */
HDRP_FN float hdrp_saturate(float x)
{
    return hdrp_clamp(x, 0.0f, 1.0f);
}

/** a at t = 0, exactly b at t = 1. */
HDRP_FN float hdrp_lerp(float a, float b, float t)
{
    return a * (1.0f - t) + b * t;
}

/** x squared. */
HDRP_FN float hdrp_sq(float x)
{
    return x * x;
}

/** -1 for x < 0, else +1: a sign that is never 0. */
HDRP_FN float hdrp_sign_not_zero(float x)
{
    return x < 0.0f ? -1.0f : 1.0f;
}

/* >>vectors
 * Written out by component: the order of summation is then the same in every language. */

/** The vector (x, y). */
HDRP_FN hdrp_v2 hdrp_v2_make(float x, float y)
{
#if defined(HDRP_HLSL) || defined(HDRP_GLSL)
    return hdrp_v2(x, y);
#else
    hdrp_v2 v;
    v.x = x;
    v.y = y;
    return v;
#endif
}

/** The vector (x, y, z). */
HDRP_FN hdrp_v3 hdrp_v3_make(float x, float y, float z)
{
#if defined(HDRP_HLSL) || defined(HDRP_GLSL)
    return hdrp_v3(x, y, z);
#else
    hdrp_v3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
#endif
}

/** The vector (x, y, z, w). */
HDRP_FN hdrp_v4 hdrp_v4_make(float x, float y, float z, float w)
{
#if defined(HDRP_HLSL) || defined(HDRP_GLSL)
    return hdrp_v4(x, y, z, w);
#else
    hdrp_v4 v;
    v.x = x;
    v.y = y;
    v.z = z;
    v.w = w;
    return v;
#endif
}

/** The integer vector (x, y, z, w). */
HDRP_FN hdrp_u32x4 hdrp_u32x4_make(hdrp_u32 x, hdrp_u32 y, hdrp_u32 z, hdrp_u32 w)
{
#if defined(HDRP_HLSL) || defined(HDRP_GLSL)
    return hdrp_u32x4(x, y, z, w);
#else
    hdrp_u32x4 v;
    v.x = x;
    v.y = y;
    v.z = z;
    v.w = w;
    return v;
#endif
}

/** a + b. */
HDRP_FN hdrp_v2 hdrp_v2_add(hdrp_v2 a, hdrp_v2 b)
{
    return hdrp_v2_make(a.x + b.x, a.y + b.y);
}

/** a - b. */
HDRP_FN hdrp_v2 hdrp_v2_sub(hdrp_v2 a, hdrp_v2 b)
{
    return hdrp_v2_make(a.x - b.x, a.y - b.y);
}

/** v times s. */
HDRP_FN hdrp_v2 hdrp_v2_scale(hdrp_v2 v, float s)
{
    return hdrp_v2_make(v.x * s, v.y * s);
}

/** Dot product. */
HDRP_FN float hdrp_v2_dot(hdrp_v2 a, hdrp_v2 b)
{
    return a.x * b.x + a.y * b.y;
}

/** All three components equal to s. */
HDRP_FN hdrp_v3 hdrp_v3_splat(float s)
{
    return hdrp_v3_make(s, s, s);
}

/** a + b. */
HDRP_FN hdrp_v3 hdrp_v3_add(hdrp_v3 a, hdrp_v3 b)
{
    return hdrp_v3_make(a.x + b.x, a.y + b.y, a.z + b.z);
}

/** a - b. */
HDRP_FN hdrp_v3 hdrp_v3_sub(hdrp_v3 a, hdrp_v3 b)
{
    return hdrp_v3_make(a.x - b.x, a.y - b.y, a.z - b.z);
}

/** Component-wise product. */
HDRP_FN hdrp_v3 hdrp_v3_mul(hdrp_v3 a, hdrp_v3 b)
{
    return hdrp_v3_make(a.x * b.x, a.y * b.y, a.z * b.z);
}

/** v times s. */
HDRP_FN hdrp_v3 hdrp_v3_scale(hdrp_v3 v, float s)
{
    return hdrp_v3_make(v.x * s, v.y * s, v.z * s);
}

/** a + b * s. */
HDRP_FN hdrp_v3 hdrp_v3_mad(hdrp_v3 a, hdrp_v3 b, float s)
{
    return hdrp_v3_make(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}

/** -v. */
HDRP_FN hdrp_v3 hdrp_v3_neg(hdrp_v3 v)
{
    return hdrp_v3_make(-v.x, -v.y, -v.z);
}

/** a at t = 0, b at t = 1. */
HDRP_FN hdrp_v3 hdrp_v3_lerp(hdrp_v3 a, hdrp_v3 b, float t)
{
    return hdrp_v3_make(hdrp_lerp(a.x, b.x, t), hdrp_lerp(a.y, b.y, t), hdrp_lerp(a.z, b.z, t));
}

/** Component-wise hdrp_max with the scalar s; s where a component is NaN. */
HDRP_FN hdrp_v3 hdrp_v3_max(hdrp_v3 v, float s)
{
    return hdrp_v3_make(hdrp_max(v.x, s), hdrp_max(v.y, s), hdrp_max(v.z, s));
}

/** Component-wise hdrp_saturate; 0 where a component is NaN. */
HDRP_FN hdrp_v3 hdrp_v3_saturate(hdrp_v3 v)
{
    return hdrp_v3_make(hdrp_saturate(v.x), hdrp_saturate(v.y), hdrp_saturate(v.z));
}

/** The largest component. */
HDRP_FN float hdrp_v3_max_component(hdrp_v3 v)
{
    return hdrp_max(hdrp_max(v.x, v.y), v.z);
}

/** Dot product. */
HDRP_FN float hdrp_v3_dot(hdrp_v3 a, hdrp_v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/** Cross product. */
HDRP_FN hdrp_v3 hdrp_v3_cross(hdrp_v3 a, hdrp_v3 b)
{
    return hdrp_v3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/** Euclidean length; finite for components below 1e19. */
HDRP_FN float hdrp_v3_length(hdrp_v3 v)
{
    return hdrp_sqrt(hdrp_v3_dot(v, v));
}

/** v over its length; the length must lie in [1e-18, 1e18]. See hdrp_normalize_or otherwise. */
HDRP_FN hdrp_v3 hdrp_v3_normalize(hdrp_v3 v)
{
    return hdrp_v3_scale(v, 1.0f / hdrp_v3_length(v));
}

/** Component-wise product. */
HDRP_FN hdrp_v4 hdrp_v4_mul(hdrp_v4 a, hdrp_v4 b)
{
    return hdrp_v4_make(a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w);
}

/** Dot product. */
HDRP_FN float hdrp_v4_dot(hdrp_v4 a, hdrp_v4 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

/** The first three components. */
HDRP_FN hdrp_v3 hdrp_v3_from_v4(hdrp_v4 v)
{
    return hdrp_v3_make(v.x, v.y, v.z);
}

/** (v.x, v.y, v.z, w). */
HDRP_FN hdrp_v4 hdrp_v4_from_v3(hdrp_v3 v, float w)
{
    return hdrp_v4_make(v.x, v.y, v.z, w);
}

/** Unit vector along v, whatever its length.
 *  v         any     direction; any length, any value
 *  fallback  finite  what to return when v has no direction
 *  returns   finite  v / |v|, of length 1, or fallback
 *  edges     a zero, infinite or NaN v gives fallback; no overflow or underflow in between
 *  error     <= 1.5e-7 absolute, per component  @accuracy normalize_or
 *  source    scaling by the largest component, as in Blue 1978, "A Portable Fortran Program to
 *            Find the Euclidean Norm of a Vector" */
HDRP_FN hdrp_v3 hdrp_normalize_or(hdrp_v3 v, hdrp_v3 fallback)
{
    float m = hdrp_max(hdrp_max(hdrp_abs(v.x), hdrp_abs(v.y)), hdrp_abs(v.z));
    hdrp_v3 s = hdrp_v3_make(v.x / m, v.y / m, v.z / m);
    float d = hdrp_v3_dot(s, s);
    float k = 1.0f / hdrp_sqrt(d);
    /* For a usable v, d is in [1,3]. 0/0, inf/inf and NaN make d a NaN, which fails the test. */
    if (!(d >= 1.0f && m <= HDRP_FLT_MAX)) {
        return fallback;
    }
    return hdrp_v3_scale(s, k);
}

struct hdrp_basis {
    hdrp_v3 tangent;
    hdrp_v3 bitangent;
};
HDRP_TYPEDEF(hdrp_basis)

/** Two unit vectors that make a right-handed orthonormal basis (tangent, bitangent, n).
 *  n        unit  direction of the third axis
 *  returns  unit vectors; cross(tangent, bitangent) = n
 *  edges    continuous except where n.z changes sign; n.z = -0 counts as positive
 *  error    <= 3e-7 absolute in any dot product of two axes and in their lengths  @accuracy basis
 *  source   Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3 */
HDRP_FN hdrp_basis hdrp_basis_from_normal(hdrp_v3 n)
{
    hdrp_basis f;
    float s = hdrp_sign_not_zero(n.z);
    float a = -1.0f / (s + n.z);
    float b = n.x * n.y * a;
    f.tangent = hdrp_v3_make(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    f.bitangent = hdrp_v3_make(b, s + n.y * n.y * a, -n.y);
    return f;
}

/* >>algorithm layer: results, C and C++ only */
#ifndef HDRP_GPU

typedef enum hdrp_result {
    HDRP_OK = 0,
    HDRP_ERROR_NULL_POINTER,     /* a required pointer is NULL */
    HDRP_ERROR_BAD_ARGUMENT,     /* a value is outside its documented range, or not finite */
    HDRP_ERROR_MEMORY_TOO_SMALL, /* the block is smaller than hdrp_<module>_memory_size said */
    HDRP_ERROR_MEMORY_ALIGNMENT, /* the block is not aligned to HDRP_MEMORY_ALIGNMENT bytes */
    HDRP_ERROR_TOO_LARGE         /* a size does not fit the arithmetic of the target */
} hdrp_result;

#define HDRP_MEMORY_ALIGNMENT 16

/** One line of English for r; never NULL. */
static inline const char* hdrp_result_string(hdrp_result r)
{
    switch (r) {
    case HDRP_OK:
        return "success";
    case HDRP_ERROR_NULL_POINTER:
        return "a required pointer is null";
    case HDRP_ERROR_BAD_ARGUMENT:
        return "a value is outside its documented range";
    case HDRP_ERROR_MEMORY_TOO_SMALL:
        return "the memory block is smaller than required";
    case HDRP_ERROR_MEMORY_ALIGNMENT:
        return "the memory block is not aligned";
    case HDRP_ERROR_TOO_LARGE:
        return "a size is too large for this target";
    }
    return "unknown result";
}

#endif /* HDRP_GPU */
#endif /* HDRP_MATH_H */
