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
 * -fno-math-errno -fno-trapping-math instead (clang's defaults but for the first), with which gcc
 * vectorises square roots and selections and which change no result.
 *
 * Override macros, all optional and defined before the first inclusion:
 *     HDRP_FN   qualifier of formula functions      default "static inline" (C, C++), always
 *                                                   inlined in optimised builds: constant feature
 *                                                   masks fold, loops vectorise
 *     HDRP_API  qualifier of algorithm functions    default "extern" (C, C++)
 *     HDRP_HLSL the compiler reads HLSL             default: set where DXC is recognised
 *
 * >>index of the functions, without hdrp_ (written by tools/api_check.py --write)
 *   language layer: sqrt rsqrt sin cos tan asin acos atan2 exp exp2 log log2 pow floor abs
 *       f32_from_u32 u32_from_f32 reverse_bits bits_from_f32 f32_from_bits min max clamp saturate
 *       lerp sq sign_not_zero
 *   vectors: v2_make v3_make v4_make u32x4_make v2_add v2_sub v2_scale v2_dot v3_splat v3_add
 *       v3_sub v3_mul v3_scale v3_mad v3_neg v3_lerp v3_max v3_saturate v3_select v3_max_component
 *       v3_dot v3_cross v3_length v3_normalize v4_mul v4_dot v3_from_v4 v4_from_v3 normalize_or
 *       basis_from_normal
 *   fast math: acos_fast atan2_fast acos_exact atan2_exact exp2_fast log2_fast pow_fast rsqrt_fast
 *       sincos sincos_fast
 *   colour: linear_from_srgb srgb_from_linear linear_from_srgb_fast srgb_from_linear_fast
 *       v3_linear_from_srgb v3_srgb_from_linear v3_linear_from_srgb_fast v3_srgb_from_linear_fast
 *       luminance
 *   display: tonemap_neutral tonemap dither_from_hash dithered
 *   colour temperature: rec709_from_kelvin rec709_from_kelvin_fast
 *   surface gradients: surface_frame_from_vertex surface_footprint_from_position basis_from_uv
 *       normal_from_xy normal_from_rgb normal_from_ag derivative_from_normal
 *       derivative_from_heights surface_gradient_from_derivative surface_gradient_from_normal
 *       surface_gradient_from_volume surface_gradient_from_height triplanar_weights
 *       surface_gradient_from_triplanar normal_from_surface_gradient_unclamped
 *       normal_from_surface_gradient
 *   sampling: unit_from_u32 hash1 hash2 hash3 hammersley r2 fibonacci_disk fibonacci_sphere
 *       disk_concentric disk_polar hemisphere_cosine hemisphere_cosine_pdf hemisphere_uniform
 *       sphere_uniform
 *   depth: depth_params_perspective depth_params_orthographic view_depth device_depth
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
#elif defined(__OPTIMIZE__) && defined(__GNUC__)
/* Left to choose, compilers keep one body of a long formula for several calls, with run-time tests
 * in place of constant feature masks, and loops around a call stay scalar. */
#define HDRP_FN static inline __attribute__((always_inline))
#elif defined(_MSC_VER)
#define HDRP_FN static __forceinline
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

/* HDRP_I_F(sqrt)(x) is the single-precision built-in or libm function. The errors stated below are
 * those of the GNU C library; shading languages promise less, and other libraries may. */
#ifdef HDRP_GPU
#define HDRP_I_F(name) name
#else
#define HDRP_I_F(name) name##f
#endif

/** Square root.
 *  x        [0,inf]  anything
 *  returns  [0,inf]
 *  edges    -0 gives -0, negative and NaN give NaN
 *  error    <= 0.5 ulp  @accuracy sqrt
 *  source   IEEE 754-2008, section 5.4.1 */
HDRP_FN float hdrp_sqrt(float x)
{
    return HDRP_I_F(sqrt)(x);
}

/** Reciprocal square root in full precision.
 *  x        (0,inf]   anything
 *  returns  [0,inf)   1 / sqrt(x)
 *  edges    +-0 gives +-infinity, infinity gives 0, negative and NaN give NaN; see
 *           hdrp_rsqrt_fast for a form that is finite everywhere
 *  error    <= 1.1e-7 relative for every positive float  @accuracy rsqrt
 *  source   definition; the built-in where the language has one */
HDRP_FN float hdrp_rsqrt(float x)
{
#if defined(HDRP_GLSL)
    return inversesqrt(x);
#elif defined(HDRP_GPU)
    return rsqrt(x);
#else
    return 1.0f / sqrtf(x);
#endif
}

/** Sine.
 *  x        finite  [rad]
 *  returns  [-1,1]
 *  edges    infinities and NaN give NaN; see hdrp_sincos, which vectorises
 *  error    <= 0.6 ulp  @accuracy sin
 *  source   the built-in of the language */
HDRP_FN float hdrp_sin(float x)
{
    return HDRP_I_F(sin)(x);
}

/** Cosine.
 *  x        finite  [rad]
 *  returns  [-1,1]
 *  edges    infinities and NaN give NaN; see hdrp_sincos, which vectorises
 *  error    <= 0.6 ulp  @accuracy cos
 *  source   the built-in of the language */
HDRP_FN float hdrp_cos(float x)
{
    return HDRP_I_F(cos)(x);
}

/** Tangent.
 *  x        finite  [rad]
 *  returns  finite
 *  edges    infinities and NaN give NaN
 *  error    <= 1.5 ulp  @accuracy tan
 *  source   the built-in of the language */
HDRP_FN float hdrp_tan(float x)
{
    return HDRP_I_F(tan)(x);
}

/** Arc sine.
 *  x        [-1,1]                        sine
 *  returns  [-HDRP_HALF_PI,HDRP_HALF_PI]  [rad]
 *  edges    outside and NaN give NaN
 *  error    <= 1 ulp  @accuracy asin
 *  source   the built-in of the language */
HDRP_FN float hdrp_asin(float x)
{
    return HDRP_I_F(asin)(x);
}

/** Arc cosine.
 *  x        [-1,1]       cosine
 *  returns  [0,HDRP_PI]  [rad]
 *  edges    outside and NaN give NaN
 *  error    <= 1 ulp  @accuracy acos
 *  error    <= 2.2e-7 absolute  @accuracy acos_absolute
 *  source   the built-in of the language */
HDRP_FN float hdrp_acos(float x)
{
    return HDRP_I_F(acos)(x);
}

/** Angle of the point (x, y) from the +x axis.
 *  y        finite              second coordinate
 *  x        finite              first coordinate
 *  returns  [-HDRP_PI,HDRP_PI]  [rad]
 *  edges    signs of zeros count in C; shading languages leave (0, 0) undefined
 *  error    <= 1.6 ulp  @accuracy atan2
 *  error    <= 2.6e-7 absolute  @accuracy atan2_absolute
 *  source   the built-in of the language */
HDRP_FN float hdrp_atan2(float y, float x)
{
#ifdef HDRP_GLSL
    return atan(y, x);
#else
    return HDRP_I_F(atan2)(y, x);
#endif
}

/** e to the power x.
 *  x        [-inf,inf]  exponent
 *  returns  [0,inf]
 *  edges    infinite from 88.73 on, 0 below -104; NaN gives NaN
 *  error    <= 0.6 ulp where the result is a normal float  @accuracy exp
 *  source   the built-in of the language */
HDRP_FN float hdrp_exp(float x)
{
    return HDRP_I_F(exp)(x);
}

/** 2 to the power x.
 *  x        [-inf,inf]  exponent
 *  returns  [0,inf]
 *  edges    infinite from 128 on, 0 below -150; NaN gives NaN
 *  error    <= 0.6 ulp where the result is a normal float  @accuracy exp2
 *  error    <= 7e-8 relative, likewise  @accuracy exp2_relative
 *  source   the built-in of the language */
HDRP_FN float hdrp_exp2(float x)
{
    return HDRP_I_F(exp2)(x);
}

/** Natural logarithm.
 *  x        (0,inf]     anything
 *  returns  [-104,inf]
 *  edges    in C 0 gives -infinity, negative and NaN give NaN; shading languages define neither
 *  error    <= 1 ulp  @accuracy log
 *  source   the built-in of the language */
HDRP_FN float hdrp_log(float x)
{
    return HDRP_I_F(log)(x);
}

/** Logarithm to the base 2.
 *  x        (0,inf]     anything
 *  returns  [-149,inf]
 *  edges    in C 0 gives -infinity, negative and NaN give NaN; shading languages define neither
 *  error    <= 1 ulp  @accuracy log2
 *  error    <= 1.2e-7 relative  @accuracy log2_relative
 *  source   the built-in of the language */
HDRP_FN float hdrp_log2(float x)
{
    return HDRP_I_F(log2)(x);
}

/** x to the power y.
 *  x        (0,FLT_MAX]  base
 *  y        finite       exponent
 *  returns  [0,inf]
 *  edges    overflow gives infinity; a base of 0 and negative ones are undefined in shading
 *           languages
 *  error    <= 1 ulp where the result is a normal float  @accuracy pow
 *  error    <= 1e-7 relative, likewise  @accuracy pow_relative
 *  source   the built-in of the language */
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

/** u with the order of its 32 bits reversed. */
HDRP_FN hdrp_u32 hdrp_reverse_bits(hdrp_u32 u)
{
#if defined(HDRP_HLSL)
    return reversebits(u);
#elif defined(HDRP_GLSL)
    return bitfieldReverse(u);
#else
    u = ((u >> 1) & 0x55555555u) | ((u & 0x55555555u) << 1);
    u = ((u >> 2) & 0x33333333u) | ((u & 0x33333333u) << 2);
    u = ((u >> 4) & 0x0f0f0f0fu) | ((u & 0x0f0f0f0fu) << 4);
    u = ((u >> 8) & 0x00ff00ffu) | ((u & 0x00ff00ffu) << 8);
    return (u >> 16) | (u << 16);
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

/** a where condition is positive, else b; without a branch, which would keep loops scalar. */
HDRP_FN hdrp_v3 hdrp_v3_select(float condition, hdrp_v3 a, hdrp_v3 b)
{
    return hdrp_v3_make(condition > 0.0f ? a.x : b.x, condition > 0.0f ? a.y : b.y,
                        condition > 0.0f ? a.z : b.z);
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

/** Euclidean length.
 *  v        [-1e19,1e19]  any direction
 *  returns  [0,inf)
 *  edges    lengths below 1e-18 lose digits, below 1e-23 everything
 *  error    <= 2 ulp for lengths in [1e-18,1e19]  @accuracy v3_length
 *  source   definition */
HDRP_FN float hdrp_v3_length(hdrp_v3 v)
{
    return hdrp_sqrt(hdrp_v3_dot(v, v));
}

/** v over its length.
 *  v         [-1e18,1e18]  any direction; see hdrp_normalize_or for other lengths
 *  returns   unit
 *  requires  hdrp_v3_dot(v, v) >= 1e-36f; a length of at least 1e-18
 *  edges     none: undefined where the length is 0
 *  error     <= 2e-7 absolute, per component  @accuracy v3_normalize
 *  source    definition */
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
    float usable = d >= 1.0f ? 1.0f : 0.0f;
    usable = m <= HDRP_FLT_MAX ? usable : 0.0f;
    return hdrp_v3_select(usable, hdrp_v3_scale(s, k), fallback);
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
 *  error    <= 3.9e-7 absolute in any dot product of two axes and in their lengths, where n is as
 *           good as normalising makes it  @accuracy basis
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

/* >>fast math
 * For loops on a CPU: compilers vectorise a loop over any of these, where a call into libm stays
 * scalar; outside loops libm's exp2f, log2f and powf are as quick. Errors are near 1e-6, those of
 * the _exact ones near 2e-7, and every argument gives a finite result. On a GPU prefer hdrp_cos and
 * so on, which are hardware instructions; these are for results that must agree with the CPU.
 * tools/fit_math.py derives the coefficients. Limits and selections are integer arithmetic on the
 * bits of floats, whose order is the same for positive ones: from a ternary gcc makes a branch. */

#define HDRP_I_SIGN_BIT      0x80000000u
#define HDRP_I_ONE_BITS      0x3f800000u
#define HDRP_I_FLT_MIN_BITS  0x00800000u
#define HDRP_I_FLT_MAX_BITS  0x7f7fffffu
#define HDRP_I_INFINITY_BITS 0x7f800000u
/* A float in [2^23,2^24) has its integer value in its lowest 23 bits: adding 2^23 rounds to the
 * nearest integer, and or-ing these bits makes a float of an integer. */
#define HDRP_I_INTEGER_BITS 0x4b000000u

/** The smaller of a and b. */
HDRP_FN hdrp_u32 hdrp_i_min_u32(hdrp_u32 a, hdrp_u32 b)
{
    return a < b ? a : b;
}

/** The larger of a and b. */
HDRP_FN hdrp_u32 hdrp_i_max_u32(hdrp_u32 a, hdrp_u32 b)
{
    return a > b ? a : b;
}

/** The bits of x limited to [lo, hi], bits of positive floats; lo where x is negative or NaN. */
HDRP_FN hdrp_u32 hdrp_i_limited_bits(float x, hdrp_u32 lo, hdrp_u32 hi)
{
    hdrp_u32 u = hdrp_bits_from_f32(x);
    hdrp_u32 bad = (u | (HDRP_I_INFINITY_BITS - u)) >> 31;
    return hdrp_i_max_u32(hdrp_i_min_u32(u & (bad - 1u), hi), lo);
}

/** x limited to [0, 1]; 0 where x is NaN. */
HDRP_FN float hdrp_i_saturate(float x)
{
    return hdrp_f32_from_bits(hdrp_i_limited_bits(x, 0u, HDRP_I_ONE_BITS));
}

/** x limited to [-m, m], m having the bits limit; -m where x is NaN. */
HDRP_FN float hdrp_i_limited_magnitude(float x, hdrp_u32 limit)
{
    hdrp_u32 u = hdrp_bits_from_f32(x);
    hdrp_u32 magnitude = u & ~HDRP_I_SIGN_BIT;
    hdrp_u32 sign = (u | (HDRP_I_INFINITY_BITS - magnitude)) & HDRP_I_SIGN_BIT;
    return hdrp_f32_from_bits(hdrp_i_min_u32(magnitude, limit) | sign);
}

/** a where bit, 0 or 1, is 0, else b. */
HDRP_FN float hdrp_i_select(hdrp_u32 bit, float a, float b)
{
    hdrp_u32 u = hdrp_bits_from_f32(a);
    return hdrp_f32_from_bits(u ^ ((u ^ hdrp_bits_from_f32(b)) & (0u - bit)));
}

/** x with its sign flipped where the lowest bit of bit is 1. */
HDRP_FN float hdrp_i_flip_sign(float x, hdrp_u32 bit)
{
    return hdrp_f32_from_bits(hdrp_bits_from_f32(x) ^ (bit << 31));
}

/** x where bit, 0 or 1, is 0, else total - x. */
HDRP_FN float hdrp_i_complement(hdrp_u32 bit, float total, float x)
{
    hdrp_u32 u = hdrp_bits_from_f32(total) & (0u - bit);
    return hdrp_f32_from_bits(u) + hdrp_i_flip_sign(x, bit);
}

/** Arc cosine by a polynomial of degree 5 and a square root.
 *  x        any          cosine
 *  returns  [0,HDRP_PI]  [rad]
 *  edges    exactly pi at -1 and 0 at 1; limited to [-1,1]; NaN gives 0 or pi
 *  error    <= 1.6e-6 absolute for x in [-1,1]  @accuracy acos_fast
 *  error    <= 1.2e-6 relative for x in [0,1]   @accuracy acos_fast_relative
 *  source   form of Abramowitz and Stegun 1964, 4.4.45, which has 7e-5; coefficients own
 *  note     the constant term is pi/2, so that the two halves meet at 0 */
HDRP_FN float hdrp_acos_fast(float x)
{
    hdrp_u32 u = hdrp_bits_from_f32(x);
    float a = hdrp_f32_from_bits(hdrp_i_min_u32(u & ~HDRP_I_SIGN_BIT, HDRP_I_ONE_BITS));
    float p = 0.0196373835f + a * -0.00444137724f;
    p = 0.0880043358f + a * (-0.0452490188f + a * p);
    p = HDRP_HALF_PI + a * (-0.214535296f + a * p);
    return hdrp_i_complement(u >> 31, HDRP_PI, hdrp_sqrt(1.0f - a) * p);
}

/** Angle of the point (x, y) from the +x axis by a polynomial of degree 13.
 *  y        any  second coordinate
 *  x        any  first coordinate
 *  returns  [-3.1415928,3.1415928]  [rad]; carries the sign of y
 *  edges    signs of zeros count, as in C; an infinite coordinate or NaN counts as FLT_MAX; where
 *           both are denormal the angle is that of (x, FLT_MIN) or (FLT_MIN, y)
 *  error    <= 1e-6 absolute            @accuracy atan2_fast
 *  error    <= 1e-6 relative for x > 0  @accuracy atan2_fast_relative
 *  source   odd minimax polynomial of the smaller over the larger coordinate; coefficients own */
HDRP_FN float hdrp_atan2_fast(float y, float x)
{
    hdrp_u32 sx = hdrp_bits_from_f32(x);
    hdrp_u32 sy = hdrp_bits_from_f32(y);
    hdrp_u32 ax = hdrp_i_min_u32(sx & ~HDRP_I_SIGN_BIT, HDRP_I_FLT_MAX_BITS);
    hdrp_u32 ay = hdrp_i_min_u32(sy & ~HDRP_I_SIGN_BIT, HDRP_I_FLT_MAX_BITS);
    hdrp_u32 larger = hdrp_i_max_u32(hdrp_i_max_u32(ax, ay), HDRP_I_FLT_MIN_BITS);
    float t = hdrp_f32_from_bits(hdrp_i_min_u32(ax, ay)) / hdrp_f32_from_bits(larger);
    float z = t * t;
    float p = 0.0848410651f + z * (-0.0377967432f + z * 0.00810637604f);
    p = -0.333284914f + z * (0.198978737f + z * (-0.135445774f + z * p));
    p = hdrp_i_complement((ax - ay) >> 31, HDRP_HALF_PI, t + t * (z * p));
    p = hdrp_i_complement(sx >> 31, HDRP_PI, p);
    return hdrp_i_flip_sign(p, sy >> 31);
}

/* What the float pi has too much; half of it, what half pi has. */
#define HDRP_I_PI_EXCESS      8.742278e-8f
#define HDRP_I_HALF_PI_EXCESS 4.371139e-8f

/** Arc cosine almost to the last place.
 *  x        any          cosine
 *  returns  [0,HDRP_PI]  [rad]
 *  edges    exactly pi at -1 and 0 at 1; limited to [-1,1]; NaN gives 0 or pi
 *  error    <= 1.4 ulp                        @accuracy acos_exact
 *  error    <= 3e-7 absolute for x in [-1,1]  @accuracy acos_exact_absolute
 *  source   acos x = 2 asin sqrt((1 - x) / 2) beyond 1/2, as in Cody and Waite 1980, "Software
 *           Manual for the Elementary Functions"; coefficients own
 *  note     in a loop 2.5 times as costly as hdrp_acos_fast, a tenth or less of libm's */
HDRP_FN float hdrp_acos_exact(float x)
{
    hdrp_u32 u = hdrp_bits_from_f32(x);
    float a = hdrp_f32_from_bits(hdrp_i_min_u32(u & ~HDRP_I_SIGN_BIT, HDRP_I_ONE_BITS));
    hdrp_u32 beyond = (hdrp_bits_from_f32(0.5f) - hdrp_bits_from_f32(a)) >> 31;
    float z = hdrp_i_select(beyond, a * a, 0.5f - 0.5f * a);
    float s = hdrp_i_select(beyond, a, hdrp_sqrt(z));
    float p = 0.0454703756f + z * (0.0241795108f + z * 0.042166315f);
    p = s + s * (z * (0.166667521f + z * (0.0749529749f + z * p)));
    z = HDRP_HALF_PI - (hdrp_i_flip_sign(p, u >> 31) + HDRP_I_HALF_PI_EXCESS);
    p = 2.0f * p + hdrp_i_select(u >> 31, 0.0f, HDRP_I_PI_EXCESS);
    return hdrp_i_select(beyond, z, hdrp_i_complement(u >> 31, HDRP_PI, p));
}

/** Angle of the point (x, y) from the +x axis, almost to the last place.
 *  y        any  second coordinate
 *  x        any  first coordinate
 *  returns  [-3.1415928,3.1415928]  [rad]; carries the sign of y
 *  edges    as hdrp_atan2_fast
 *  error    <= 2 ulp where the result is a normal float  @accuracy atan2_exact
 *  error    <= 3e-7 absolute                             @accuracy atan2_exact_absolute
 *  source   odd minimax polynomial of the smaller over the larger coordinate; coefficients own
 *  note     in a loop up to 1.4 times as costly as hdrp_atan2_fast, a twentieth of libm's */
HDRP_FN float hdrp_atan2_exact(float y, float x)
{
    hdrp_u32 sx = hdrp_bits_from_f32(x);
    hdrp_u32 sy = hdrp_bits_from_f32(y);
    hdrp_u32 ax = hdrp_i_min_u32(sx & ~HDRP_I_SIGN_BIT, HDRP_I_FLT_MAX_BITS);
    hdrp_u32 ay = hdrp_i_min_u32(sy & ~HDRP_I_SIGN_BIT, HDRP_I_FLT_MAX_BITS);
    hdrp_u32 larger = hdrp_i_max_u32(hdrp_i_max_u32(ax, ay), HDRP_I_FLT_MIN_BITS);
    hdrp_u32 steep = (ax - ay) >> 31;
    hdrp_u32 behind = sx >> 31;
    float t = hdrp_f32_from_bits(hdrp_i_min_u32(ax, ay)) / hdrp_f32_from_bits(larger);
    float z = t * t;
    float p = 0.0432118662f + z * (-0.0163679309f + z * 0.00292069302f);
    p = -0.142110556f + z * (0.106660046f + z * (-0.0755221471f + z * p));
    p = t + t * (z * (-0.333331525f + z * (0.199937731f + z * p)));
    p = hdrp_i_complement(steep, HDRP_HALF_PI,
                          p + hdrp_i_select(steep, 0.0f, HDRP_I_HALF_PI_EXCESS));
    p = hdrp_i_complement(behind, HDRP_PI, p + hdrp_i_select(behind, 0.0f, HDRP_I_PI_EXCESS));
    return hdrp_i_flip_sign(p, sy >> 31);
}

/** 2 to the power x by a polynomial of degree 5.
 *  x        any          exponent
 *  returns  [0,FLT_MAX]  exact for integers; denormal results are rounded once
 *  edges    0 below -150, FLT_MAX from 128 on: never infinite; NaN gives 0
 *  error    <= 2.5e-7 relative for x in [-126,128)  @accuracy exp2_fast
 *  source   minimax polynomial over half an octave on each side; coefficients own
 *  note     the scale is applied as two factors, each of which is a normal float */
HDRP_FN float hdrp_exp2_fast(float x)
{
    float c = hdrp_i_limited_magnitude(x, 0x43180000u); /* 152 */
    /* The nearest integer, plus 256. */
    hdrp_u32 n = hdrp_bits_from_f32(c + (8388608.0f + 256.0f)) & 0x3ffu;
    float f = c - (hdrp_f32_from_bits(n | HDRP_I_INTEGER_BITS) - (8388608.0f + 256.0f));
    hdrp_u32 h = n >> 1;
    float p = 0.00967151299f + f * 0.00132647273f;
    p = 0.240222424f + f * (0.0555073358f + f * p);
    p = 1.0f + f * (0.693147004f + f * p);
    p = p * hdrp_f32_from_bits((h - 1u) << 23) * hdrp_f32_from_bits((n - h - 1u) << 23);
    return hdrp_f32_from_bits(hdrp_i_min_u32(hdrp_bits_from_f32(p), HDRP_I_FLT_MAX_BITS));
}

/** Logarithm to the base 2 by a rational function.
 *  x        any         denormals included
 *  returns  [-151,128]  exact for powers of 2
 *  edges    0, negative and NaN give -151, below the logarithm of every positive float (-149);
 *           infinity gives 128
 *  error    <= 4e-7 relative for every positive float  @accuracy log2_fast
 *  source   log m = 2 atanh((m - 1) / (m + 1)) with an odd minimax polynomial; coefficients own */
HDRP_FN float hdrp_log2_fast(float x)
{
    hdrp_u32 u = hdrp_i_limited_bits(x, 0u, HDRP_I_INFINITY_BITS);
    hdrp_u32 shift = ((u - HDRP_I_FLT_MIN_BITS) >> 31) * 24u; /* 2^24 makes a denormal normal */
    u = hdrp_bits_from_f32(hdrp_f32_from_bits(u) * hdrp_f32_from_bits((127u + shift) << 23));
    /* Moves the step of the exponent field from 1 to sqrt(1/2), whose bits are 0x3f3504f3. */
    u = u + (0x3f800000u - 0x3f3504f3u);
    float e = hdrp_f32_from_bits(((u >> 23) + 24u - shift) | HDRP_I_INTEGER_BITS) -
              (8388608.0f + 24.0f + 127.0f);
    float m = hdrp_f32_from_bits((u & 0x007fffffu) + 0x3f3504f3u);
    float s = (m - 1.0f) / (m + 1.0f);
    float z = s * s;
    return e + s * (2.88539052f + z * (0.961588323f + z * 0.59578073f));
}

/** x to the power y by hdrp_log2_fast and hdrp_exp2_fast.
 *  x        any          base
 *  y        any          exponent
 *  returns  [0,FLT_MAX]  exactly 1 where x = 1 or y = 0
 *  edges    x <= 0 and NaN count as 0, whose power is 0 for y > 0, 1 for y = 0 and FLT_MAX for
 *           y < 0; overflow gives FLT_MAX; NaN for y and 1 to an infinite power give 0
 *  error    <= 3e-5 relative where the result is a normal float  @accuracy pow_fast
 *  error    <= 1.9e-6 relative for x in [1e-3,1] and y in [0.3,2.5]  @accuracy pow_fast_colour
 *  source   definition
 *  note     the error grows with |y log2 x|, the rounding of which is an error of the exponent */
HDRP_FN float hdrp_pow_fast(float x, float y)
{
    /* At 0 this logarithm does what -infinity would, without 0 * infinity. */
    hdrp_u32 zero = (hdrp_i_limited_bits(x, 0u, HDRP_I_INFINITY_BITS) - 1u) >> 31;
    return hdrp_exp2_fast(y * hdrp_i_select(zero, hdrp_log2_fast(x), -HDRP_FLT_MAX));
}

/** Reciprocal square root by integer arithmetic and one correction of third order.
 *  x        any         anything
 *  returns  (0,9.3e18]  1 / sqrt(x)
 *  edges    limited to [FLT_MIN,FLT_MAX]: 0, denormals, negative and NaN give 9.22e18
 *  error    <= 6.7e-7 relative for x in [FLT_MIN,FLT_MAX]  @accuracy rsqrt_fast
 *  source   Lomont 2003, "Fast Inverse Square Root", for the integer step; correction own
 *  note     the magic constant is not the one that makes the first guess y best, but the one that
 *           makes x y^2 vary least, [0.75,0.844]; a cubic corrects that to 4e-7, where Newton's
 *           step needs two rounds */
HDRP_FN float hdrp_rsqrt_fast(float x)
{
    hdrp_u32 u = hdrp_i_limited_bits(x, HDRP_I_FLT_MIN_BITS, HDRP_I_FLT_MAX_BITS);
    float y = hdrp_f32_from_bits(0x5f200000u - (u >> 1));
    float w = hdrp_f32_from_bits(u) * y * y;
    return y * (2.45272088f + w * (-3.08219337f + w * (2.3225863f + w * -0.69411695f)));
}

struct hdrp_sincos_result {
    float sine;   /* [-1.0000012,1.0000012] */
    float cosine; /* [-1.0000012,1.0000012] */
};
HDRP_TYPEDEF(hdrp_sincos_result)

/** Sine and cosine in nearly full precision, also where the built-ins have little.
 *  x        any     [rad]
 *  returns  [-1,1]
 *  edges    sine(-0) = -0; beyond +-8192 [rad] as at the end of the range; NaN as -8192
 *  error    <= 1.1e-7 absolute for |x| <= 8192  @accuracy sincos
 *  source   Cody and Waite 1980, "Software Manual for the Elementary Functions", for the reduction
 *           by pi/2 in three parts; coefficients own
 *  note     the parts have 8, 11 and 24 bits, so that two of the three products are exact */
HDRP_FN hdrp_sincos_result hdrp_sincos(float x)
{
    hdrp_sincos_result r;
    float c = hdrp_i_limited_magnitude(x, 0x46000000u); /* 8192 */
    /* The nearest quarter turn, plus 8192; 2/pi. */
    hdrp_u32 n = hdrp_bits_from_f32(c * 0.636619772f + (8388608.0f + 8192.0f)) & 0x3fffu;
    float q = hdrp_f32_from_bits(n | HDRP_I_INTEGER_BITS) - (8388608.0f + 8192.0f);
    float t = ((c - q * 1.5703125f) - q * 0.000483751297f) - q * 7.54979013e-8f;
    float z = t * t;
    float s = t + t * (z * (-0.166666508f + z * (0.00833197869f + z * -0.000194956359f)));
    float k = 0.0416666456f + z * (-0.00138873677f + z * 2.44384519e-5f);
    k = 1.0f + z * (-0.5f + z * k);
    r.sine = hdrp_i_flip_sign(hdrp_i_select(n & 1u, s, k), n >> 1);
    r.cosine = hdrp_i_flip_sign(hdrp_i_select(n & 1u, k, s), (n + 1u) >> 1);
    return r;
}

/** Sine and cosine by half turns: two short polynomials and no exchange of the two.
 *  x        any  [rad]
 *  returns  [-1.0000012,1.0000012]
 *  edges    beyond +-8192 [rad] as at the end of the range; NaN as -8192
 *  error    <= 1.2e-6 absolute in the sine    @accuracy sincos_fast_sine
 *  error    <= 9e-6 absolute in the cosine    @accuracy sincos_fast_cosine
 *  source   as hdrp_sincos, with pi in two parts; coefficients own */
HDRP_FN hdrp_sincos_result hdrp_sincos_fast(float x)
{
    hdrp_sincos_result r;
    float c = hdrp_i_limited_magnitude(x, 0x46000000u); /* 8192 */
    /* The nearest half turn, plus 4096. */
    hdrp_u32 n = hdrp_bits_from_f32(c * HDRP_INV_PI + (8388608.0f + 4096.0f)) & 0x1fffu;
    float q = hdrp_f32_from_bits(n | HDRP_I_INTEGER_BITS) - (8388608.0f + 4096.0f);
    float t = (c - q * 3.140625f) - q * 0.000967653590f;
    float z = t * t;
    float s = t + t * (z * (-0.166656807f + z * (0.00831236597f + z * -0.00018492181f)));
    float k = 1.0f + z * (-0.499935627f + z * (0.0415070653f + z * -0.00127575197f));
    r.sine = hdrp_i_flip_sign(s, n);
    r.cosine = hdrp_i_flip_sign(k, n);
    return r;
}

/* >>colour
 * Light is added, filtered and shaded as linear Rec.709. sRGB codes are what 8-bit textures and
 * displays hold: decode with linear_from_srgb, encode with srgb_from_linear. A texture format or
 * render target that converts in hardware is cheaper than either. Use the plain pair where values
 * above 1 or the standard's exact curve matter, the _fast pair for 8-bit data: its error is a
 * twentieth of a code. */

/* The codes and linear values where the curve leaves its straight piece, IEC 61966-2-1. */
#define HDRP_SRGB_CODE_KNEE 0.04045f
/* The standard's 0.0031308 makes the curve step down by 2.9e-8. Here it steps up by 1.5e-8. */
#define HDRP_SRGB_LINEAR_KNEE 0.0031306f
#define HDRP_SRGB_SLOPE       12.92f

/** Linear value of an sRGB code.
 *  srgb     [0,1e16]     code; 1 is white, and above 1 the curve continues
 *  returns  [0,FLT_MAX]  monotone; exactly 0 at 0 and 1 at 1
 *  edges    negative and NaN give 0; above 1e16 it overflows
 *  error    <= 6e-7 relative for codes in [0,1]     @accuracy linear_from_srgb
 *  error    <= 5e-6 relative for codes in [1,1e16]  @accuracy linear_from_srgb_hdr
 *  source   IEC 61966-2-1:1999, section 5.2 */
HDRP_FN float hdrp_linear_from_srgb(float srgb)
{
    float c = hdrp_max(srgb, 0.0f);
    /* 1 / 1.055 and 0.055 / 1.055, which add up to 1 */
    float curve = hdrp_pow(c * 0.947867299f + 0.0521327014f, 2.4f);
    return c <= HDRP_SRGB_CODE_KNEE ? c * (1.0f / HDRP_SRGB_SLOPE) : curve;
}

/** sRGB code of a linear value.
 *  x        [0,FLT_MAX]  linear; 1 is white, and above 1 the curve continues
 *  returns  [0,1.3e16]   monotone; exactly 0 at 0 and 1 at 1
 *  edges    negative and NaN give 0
 *  error    <= 1.1e-6 relative  @accuracy srgb_from_linear
 *  error    <= 1.2e-7 absolute for x in [0,1]  @accuracy srgb_from_linear_absolute
 *  source   IEC 61966-2-1:1999, section 5.2
 *  note     7e-7 of the error is the moved knee, see HDRP_SRGB_LINEAR_KNEE */
HDRP_FN float hdrp_srgb_from_linear(float x)
{
    float c = hdrp_max(x, 0.0f);
    float p = hdrp_pow(hdrp_max(c, HDRP_SRGB_LINEAR_KNEE), 0.416666667f); /* 1 / 2.4 */
    /* 1.055 p - 0.055, exact at 1 */
    float curve = p + 0.055f * (p - 1.0f);
    return c <= HDRP_SRGB_LINEAR_KNEE ? c * HDRP_SRGB_SLOPE : curve;
}

/** Linear value of an sRGB code by a polynomial of degree 5.
 *  srgb     any    code; limited to [0,1]
 *  returns  [0,1]  monotone up to rounding, 2e-7; exactly 0 at 0 and 1 at 1
 *  edges    negative and NaN give 0
 *  error    <= 4.6e-4 relative  @accuracy linear_from_srgb_fast
 *  error    <= 3.6e-4 absolute  @accuracy linear_from_srgb_fast_absolute
 *  source   minimax fit to IEC 61966-2-1:1999, pinned at the knee and at 1; coefficients own
 *  note     all 256 8-bit codes survive decoding here and encoding with either encoder */
HDRP_FN float hdrp_linear_from_srgb_fast(float srgb)
{
    hdrp_u32 u = hdrp_i_limited_bits(srgb, 0u, HDRP_I_ONE_BITS);
    hdrp_u32 curved = (hdrp_bits_from_f32(HDRP_SRGB_CODE_KNEE) - u) >> 31;
    float c = hdrp_f32_from_bits(u);
    float p = 0.70983088f + c * (-0.364954323f + c * 0.113103628f);
    p = 0.000879108906f + c * (0.0340180881f + c * (0.507122636f + c * p));
    return hdrp_i_select(curved, c * (1.0f / HDRP_SRGB_SLOPE), p);
}

/** sRGB code of a linear value by a polynomial of its fourth root.
 *  x        any    linear; limited to [0,1]
 *  returns  [0,1]  monotone up to rounding, 4e-7; exactly 0 at 0 and 1 at 1
 *  edges    negative and NaN give 0
 *  error    <= 5e-5 absolute  @accuracy srgb_from_linear_fast
 *  source   minimax fit to IEC 61966-2-1:1999, pinned at the knee and at 1; coefficients own */
HDRP_FN float hdrp_srgb_from_linear_fast(float x)
{
    hdrp_u32 u = hdrp_i_limited_bits(x, 0u, HDRP_I_ONE_BITS);
    hdrp_u32 curved = (hdrp_bits_from_f32(HDRP_SRGB_LINEAR_KNEE) - u) >> 31;
    float c = hdrp_f32_from_bits(u);
    float t = hdrp_sqrt(hdrp_sqrt(c));
    float p = 1.12687695f + t * (-0.338865966f + t * 0.082160078f);
    p = -0.0642935038f + t * (0.194122478f + t * p);
    return hdrp_i_select(curved, c * HDRP_SRGB_SLOPE, p);
}

/** Linear colour of an sRGB-coded one.
 *  srgb     [0,1e16]  code
 *  returns  [0,inf)   linear
 *  edges    as hdrp_linear_from_srgb
 *  error    none: delegates to hdrp_linear_from_srgb
 *  source   IEC 61966-2-1:1999, section 5.2 */
HDRP_FN hdrp_v3 hdrp_v3_linear_from_srgb(hdrp_v3 srgb)
{
    return hdrp_v3_make(hdrp_linear_from_srgb(srgb.x), hdrp_linear_from_srgb(srgb.y),
                        hdrp_linear_from_srgb(srgb.z));
}

/** sRGB code of a linear colour.
 *  v        [0,FLT_MAX]  linear
 *  returns  [0,1.3e16]   code
 *  edges    as hdrp_srgb_from_linear
 *  error    none: delegates to hdrp_srgb_from_linear
 *  source   IEC 61966-2-1:1999, section 5.2 */
HDRP_FN hdrp_v3 hdrp_v3_srgb_from_linear(hdrp_v3 v)
{
    return hdrp_v3_make(hdrp_srgb_from_linear(v.x), hdrp_srgb_from_linear(v.y),
                        hdrp_srgb_from_linear(v.z));
}

/** Linear colour of an sRGB-coded one by hdrp_linear_from_srgb_fast.
 *  srgb     any    code; limited to [0,1]
 *  returns  [0,1]  linear
 *  edges    as hdrp_linear_from_srgb_fast
 *  error    none: delegates to hdrp_linear_from_srgb_fast
 *  source   IEC 61966-2-1:1999, section 5.2 */
HDRP_FN hdrp_v3 hdrp_v3_linear_from_srgb_fast(hdrp_v3 srgb)
{
    return hdrp_v3_make(hdrp_linear_from_srgb_fast(srgb.x), hdrp_linear_from_srgb_fast(srgb.y),
                        hdrp_linear_from_srgb_fast(srgb.z));
}

/** sRGB code of a linear colour by hdrp_srgb_from_linear_fast.
 *  v        any    linear; limited to [0,1]
 *  returns  [0,1]  code
 *  edges    as hdrp_srgb_from_linear_fast
 *  error    none: delegates to hdrp_srgb_from_linear_fast
 *  source   IEC 61966-2-1:1999, section 5.2 */
HDRP_FN hdrp_v3 hdrp_v3_srgb_from_linear_fast(hdrp_v3 v)
{
    return hdrp_v3_make(hdrp_srgb_from_linear_fast(v.x), hdrp_srgb_from_linear_fast(v.y),
                        hdrp_srgb_from_linear_fast(v.z));
}

/** Relative luminance of a linear Rec.709 colour.
 *  color    [0,FLT_MAX]  linear Rec.709
 *  returns  [0,FLT_MAX]  luminance in the unit of the colour; exactly 1 for white
 *  edges    finite even where all three are FLT_MAX; negative components count as such
 *  error    <= 2.4e-7 relative  @accuracy luminance
 *  source   Recommendation ITU-R BT.709-6, item 3.2, rounded to four digits as there */
HDRP_FN float hdrp_luminance(hdrp_v3 color)
{
    return 0.2126f * color.x + 0.7152f * color.y + 0.0722f * color.z;
}

/* >>display
 * From light that was exposed, so that 1 is the white of the display, to the codes it shows. */

/* Curves of hdrp_tonemap. */
#define HDRP_TONEMAP_NEUTRAL 0u /* hdrp_tonemap_neutral */
#define HDRP_TONEMAP_CLAMP   1u /* none: what is above 1 is 1 */

/** Khronos PBR Neutral: base colours under white light come out as they were set, up to 0.8, and
 *  highlights are compressed towards white.
 *  color    [0,1e18]  exposed linear Rec.709
 *  returns  [0,1]     display-referred linear Rec.709
 *  edges    NaN and what is below 0 give 0, infinity is as 1e18, which is white
 *  error    <= 2e-7 absolute  @accuracy tonemap_neutral
 *  source   Khronos Group 2024, "Khronos PBR Neutral Tone Mapper" */
HDRP_FN hdrp_v3 hdrp_tonemap_neutral(hdrp_v3 color)
{
    float start = 0.8f - 0.04f; /* where compression begins; 0.04 is the F0 it takes away */
    float d = 1.0f - start;
    hdrp_v3 v = hdrp_v3_make(hdrp_clamp(color.x, 0.0f, 1e18f), hdrp_clamp(color.y, 0.0f, 1e18f),
                             hdrp_clamp(color.z, 0.0f, 1e18f));
    float low = hdrp_min(v.x, hdrp_min(v.y, v.z));
    float offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
    float peak, limited, white;
    v = hdrp_v3_sub(v, hdrp_v3_splat(offset));
    peak = hdrp_v3_max_component(v);
    limited = 1.0f - d * d / (hdrp_max(peak, start) + d - start);
    white = 1.0f - 1.0f / (0.15f * (hdrp_max(peak, start) - limited) + 1.0f);
    limited = peak >= start ? limited : peak;
    white = peak >= start ? white : 0.0f;
    v = hdrp_v3_scale(v, peak >= start ? limited / peak : 1.0f);
    return hdrp_v3_saturate(hdrp_v3_lerp(v, hdrp_v3_splat(limited), white));
}

/** A tone curve by its number.
 *  color    [0,1e18]  exposed linear Rec.709
 *  curve    [0,1]     HDRP_TONEMAP_...
 *  returns  [0,1]     display-referred linear Rec.709
 *  edges    as hdrp_tonemap_neutral; a number above 1 counts as HDRP_TONEMAP_CLAMP
 *  error    none: delegates to hdrp_tonemap_neutral
 *  source   definition */
HDRP_FN hdrp_v3 hdrp_tonemap(hdrp_v3 color, hdrp_u32 curve)
{
    hdrp_v3 r = hdrp_v3_saturate(color);
    if (curve == HDRP_TONEMAP_NEUTRAL) {
        r = hdrp_tonemap_neutral(color);
    }
    return r;
}

/** Noise for hdrp_dithered that adds nothing to the mean and keeps the variance of codes the same
 *  everywhere: triangular.
 *  hash     any    a random number, such as hdrp_hash3 of a pixel and a frame
 *  returns  [-1,1]  0 most often
 *  edges    none
 *  error    none: exact
 *  source   Lipshitz et al. 1992, "Quantization and Dither: A Theoretical Survey" */
HDRP_FN float hdrp_dither_from_hash(hdrp_u32 hash)
{
    return (hdrp_f32_from_u32(hash >> 16) - hdrp_f32_from_u32(hash & 0xffffu)) * (1.0f / 65536.0f);
}

/** The code of a value, as a fraction of the largest code, after noise was added.
 *  x        [0,1]      value
 *  largest  [1,65535]  code of 1: 255 for 8 bits
 *  noise    [-1,1]     [codes]  of hdrp_dither_from_hash; 0: none
 *  returns  [0,1]      a whole number over largest
 *  edges    exactly 0 at 0 and 1 at 1, whatever the noise, which fades within a code of both ends;
 *           limited to [0,1], NaN gives 0
 *  error    none: rounding is its purpose
 *  source   definition */
HDRP_FN float hdrp_dithered(float x, float largest, float noise)
{
    float v = hdrp_saturate(x) * largest;
    float room = hdrp_min(hdrp_min(v, largest - v), 1.0f);
    return hdrp_clamp(hdrp_floor(v + noise * room + 0.5f), 0.0f, largest) / largest;
}

/* >>colour temperature
 * The colour of a black body, for lights given in kelvin: multiply a filter colour by it. Use the
 * plain version; the _fast one is for scenes that must match an engine with the published fit.
 * Two choices define such a curve. Observer: sRGB and Rec.709 are defined with the CIE 1931
 * 2-degree one. Gamut: below 1900 K the colour lies outside Rec.709; its negative blue is set to 0
 * (clipped), or as much white is added until it is 0 (whitened). Then the largest channel is 1. */

#define HDRP_KELVIN_MIN 1000.0f
#define HDRP_KELVIN_MAX 40000.0f

/** kelvin limited to the range of both fits; NaN as the lower end. */
HDRP_FN float hdrp_i_limited_kelvin(float kelvin)
{
    return hdrp_f32_from_bits(hdrp_i_limited_bits(kelvin, hdrp_bits_from_f32(HDRP_KELVIN_MIN),
                                                  hdrp_bits_from_f32(HDRP_KELVIN_MAX)));
}

/** Colour of a black body for the CIE 1931 2-degree observer, clipped to the gamut.
 *  kelvin   any    [K] temperature; limited to [1000,40000]
 *  returns  [0,1]  linear Rec.709; the largest channel is exactly 1
 *  edges    NaN as 1000
 *  error    <= 1.5e-4 absolute against Planck's law and that observer  @accuracy rec709_from_kelvin
 *  source   own fit: red, green and blue up to a common factor are polynomials of 1/T
 *  note     without pivots: the one division at the end decides which channel is the largest */
HDRP_FN hdrp_v3 hdrp_rec709_from_kelvin(float kelvin)
{
    float u = 1000.0f / hdrp_i_limited_kelvin(kelvin);
    float r = 1.0f + u * (4.45542669f + u * (30.1580944f + u * 97.1854858f));
    float g = 28.6866264f + u * (-42.0580521f + u * 9.21962261f);
    float b = -20.9616623f + u * (28.9121723f + u * -13.0662136f);
    hdrp_u32 blue;
    float m;
    g = 1.47408795f + u * (3.83817077f + u * g);
    b = 3.35240054f + u * (-1.44934654f + u * b);
    blue = hdrp_i_limited_bits(b, 0u, HDRP_I_INFINITY_BITS);
    m = hdrp_f32_from_bits(
        hdrp_i_max_u32(hdrp_i_max_u32(hdrp_bits_from_f32(r), hdrp_bits_from_f32(g)), blue));
    return hdrp_v3_make(r / m, g / m, hdrp_f32_from_bits(blue) / m);
}

/** Colour of a black body by the published fit.
 *  kelvin   any    [K] temperature; limited to [1000,40000]
 *  returns  [0,1]  linear Rec.709; red is 1 below 6570 K, blue is 1 above
 *  edges    NaN as 1000; at 6570 K green steps by 0.0021 and blue by 0.0017
 *  error    <= 0.008 absolute against the CIE 1964 10-degree observer, whitened
 *           @accuracy rec709_from_kelvin_fast_1964
 *  error    <= 0.0331 absolute against the CIE 1931 2-degree observer, clipped
 *           @accuracy rec709_from_kelvin_fast_1931
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slides on physical light units
 *  note     the slide misprints two constants of green as 2770.24 and -4625.89, which costs 0.0012
 *           near 4800 K */
HDRP_FN hdrp_v3 hdrp_rec709_from_kelvin_fast(float kelvin)
{
    float k = hdrp_i_limited_kelvin(kelvin) * 0.001f;
    hdrp_u32 pivot = hdrp_bits_from_f32(6.57f);
    hdrp_u32 warm = (hdrp_bits_from_f32(k) - pivot) >> 31;
    hdrp_u32 cold = (pivot - hdrp_bits_from_f32(k)) >> 31;
    float red = (1.35651f + k * (0.216422f + k * 0.000633715f)) / (-3.24223f + 0.918711f * k);
    float green_warm =
        (-399.809f + k * (414.271f + k * 111.543f)) / (2779.24f + k * (164.143f + k * 84.7356f));
    float green_cold = (1370.38f + k * (734.616f + k * 0.689955f)) / (-4625.69f + 1699.87f * k);
    float blue =
        (348.963f + k * (-523.53f + k * 183.62f)) / (2848.82f + k * (-214.52f + k * 78.8614f));
    float r = hdrp_i_select(warm, red, 1.0f);
    float g = hdrp_i_select(warm, green_cold, green_warm);
    float b = hdrp_i_select(cold, blue, 1.0f);
    return hdrp_v3_make(hdrp_i_saturate(r), hdrp_i_saturate(g), hdrp_i_saturate(b));
}

/* >>surface gradients
 * Normal mapping in which every source of detail becomes one vector in the tangent plane, the
 * gradient of the bump height along the surface. Gradients add up: layers from any mix of maps and
 * UV sets are a running sum whose order does not matter, and the shading normal comes last.
 *
 *     hdrp_v3 sum = base;                                      each from a function below
 *     sum = hdrp_v3_mad(sum, detail, mask * strength);         add with a weight
 *     sum = hdrp_v3_lerp(sum, moss, moss_mask);                or replace
 *     hdrp_v3 normal = hdrp_normal_from_surface_gradient(n, sum);
 *
 * n is always the unit interpolated vertex normal. The sources:
 *     normal map baked with vertex tangents   hdrp_surface_frame_from_vertex (MikkTSpace)
 *     normal map on any other UV set,
 *     or on a mesh without tangents           hdrp_surface_footprint_from_position once a pixel,
 *                                             then hdrp_basis_from_uv for each UV set
 *     object- or world-space normal map       hdrp_surface_gradient_from_normal
 *     noise or a distance field in space      hdrp_surface_gradient_from_volume
 *     three planar projections                hdrp_surface_gradient_from_triplanar
 *     a height that is computed in a shader   hdrp_surface_gradient_from_height
 * Tangent-space normals and heights first become derivatives: the change of height for one unit
 * along the tangent and along the bitangent.
 *
 * Green. A derivative counts along the direction in which green grows. In OpenGL and glTF maps that
 * is up in the picture, against the v of glTF: hand 1 - v to hdrp_basis_from_uv.
 * Back faces. Negate n (and with vertex tangents the handedness) and build everything from that.
 * Keep the gradient for bumps that stick out on both sides, negate it for a thin sheet, where a
 * bump seen from behind is a dent. */

/* Steepest slope that a normal stands for, 89.55 degrees: the smallest z of an 8-bit map. */
#define HDRP_SLOPE_MAX 128.0f
/* A shading normal keeps this cosine to n, so that rounding cannot turn it below the surface. */
#define HDRP_SURFACE_COSINE_MIN 1e-5f

struct hdrp_surface_frame {
    hdrp_v3 normal;    /* unit */
    hdrp_v3 tangent;   /* finite, in units of the length of the interpolated vertex normal */
    hdrp_v3 bitangent; /* finite, handedness * cross(normal, vertex tangent) */
};
HDRP_TYPEDEF(hdrp_surface_frame)

/** Frame of a vertex normal and tangent as interpolated, without normalising either.
 *  normal      [-1e9,1e9]  interpolated vertex normal
 *  tangent     [-1e9,1e9]  interpolated vertex tangent
 *  handedness  any         negative: the bitangent is -cross(normal, tangent)
 *  returns     valid  the three vectors, scaled alike to make the normal unit: what a gradient
 *              resolves to is then MikkTSpace's normalize(tangent x + bitangent y + normal z)
 *  edges       a normal shorter than 1e-18 gives zero tangents, so that the surface stays flat, and
 *              +Z where it has no direction at all; handedness 0 and NaN count as positive
 *  error       <= 3e-7 relative to the length of normal and tangent  @accuracy surface_frame
 *  source      Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited"; Mikkelsen 2020,
 *              "Surface Gradient-Based Bump Mapping Framework", section on vertex tangent space */
HDRP_FN hdrp_surface_frame hdrp_surface_frame_from_vertex(hdrp_v3 normal, hdrp_v3 tangent,
                                                          float handedness)
{
    hdrp_surface_frame f;
    float length = hdrp_v3_length(normal);
    float usable = length > 1e-18f ? 1.0f : 0.0f;
    f.normal = hdrp_normalize_or(normal, hdrp_v3_make(0.0f, 0.0f, 1.0f));
    f.tangent = hdrp_v3_scale(tangent, usable / hdrp_max(length, 1e-18f));
    f.bitangent =
        hdrp_v3_scale(hdrp_v3_cross(f.normal, tangent), usable * hdrp_sign_not_zero(handedness));
    return f;
}

/* Made by hdrp_surface_footprint_from_position. */
struct hdrp_surface_footprint {
    hdrp_v3 normal;  /* unit */
    hdrp_v3 sigma_x; /* finite, [m] change of position to the next pixel on the tangent plane */
    hdrp_v3 sigma_y; /* finite, [m] likewise in y */
    float area;      /* finite, [m^2] signed, of the two; 0 where they span none */
};
HDRP_TYPEDEF(hdrp_surface_footprint)

/** Footprint of a pixel on the tangent plane, which serves every UV set.
 *  normal   unit  interpolated vertex normal, normalised
 *  dp_dx    any   [m] screen derivative of position; use the fine one of the language
 *  dp_dy    any   [m] likewise in y, which may run up or down
 *  returns  valid
 *  edges    two derivatives that are parallel within 1e-6, shorter than 1e-10, above 1e9 or not
 *           finite span no area: all zero, from which follow zero tangents and a flat surface
 *  error    <= 3e-7 relative in area, to the product of both lengths  @accuracy surface_footprint
 *  source   Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU"
 *  note     position relative to the camera, else its derivative is rounding noise */
HDRP_FN hdrp_surface_footprint hdrp_surface_footprint_from_position(hdrp_v3 normal, hdrp_v3 dp_dx,
                                                                    hdrp_v3 dp_dy)
{
    hdrp_surface_footprint f;
    hdrp_v3 x = hdrp_v3_mad(dp_dx, normal, -hdrp_v3_dot(dp_dx, normal));
    hdrp_v3 y = hdrp_v3_mad(dp_dy, normal, -hdrp_v3_dot(dp_dy, normal));
    float area = hdrp_v3_dot(normal, hdrp_v3_cross(x, y));
    float xx = hdrp_v3_dot(x, x);
    float yy = hdrp_v3_dot(y, y);
    f.normal = normal;
    f.sigma_x = x;
    f.sigma_y = y;
    f.area = area;
    if (!(area * area > 1e-12f * xx * yy && hdrp_min(xx, yy) > 1e-20f &&
          area * area < HDRP_FLT_MAX)) {
        f.sigma_x = hdrp_v3_splat(0.0f);
        f.sigma_y = hdrp_v3_splat(0.0f);
        f.area = 0.0f;
    }
    return f;
}

/** Tangent frame of any UV set, procedural ones included, from screen derivatives alone.
 *  footprint  valid  of the same pixel
 *  duv_dx     any    screen derivative of the coordinates; the one in which green grows second
 *  duv_dy     any    likewise in y
 *  returns    a tangent along growing u (.x) and a bitangent on the side of growing v (.y), on both
 *             faces and for mirrored UVs; unit, orthogonal to the normal and to each other
 *  edges      coordinates whose lines are parallel within 1e-6, or change by less than 1e-19 or
 *             more than 1e18 a pixel, and a footprint without area: zero vectors, so that the
 *             surface stays flat
 *  error      <= 2e-4 degrees against the tangent of a parametric surface, where neither pair of
 *             derivatives is closer to parallel than 0.1 rad  @accuracy basis_from_uv
 *  source     Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU"; Mikkelsen 2020,
 *             "Surface Gradient-Based Bump Mapping Framework", section on other UV sets
 *  note       not MikkTSpace: a map baked with vertex tangents changes slightly, most where a
 *             coarse mesh relies on the map to look smooth */
HDRP_FN hdrp_basis hdrp_basis_from_uv(hdrp_surface_footprint footprint, hdrp_v2 duv_dx,
                                      hdrp_v2 duv_dy)
{
    hdrp_basis f;
    float a = duv_dx.x * duv_dy.y;
    float b = duv_dx.y * duv_dy.x;
    float det = a - b;
    float size = hdrp_abs(a) + hdrp_abs(b);
    float side = hdrp_sign_not_zero(det);
    float turn = side * hdrp_sign_not_zero(footprint.area);
    hdrp_v3 zero = hdrp_v3_splat(0.0f);
    /* d(position)/du times |det|; dividing by it would only change the length. */
    hdrp_v3 t = hdrp_v3_mad(hdrp_v3_scale(footprint.sigma_x, side * duv_dy.y), footprint.sigma_y,
                            -side * duv_dx.y);
    f.tangent = zero;
    f.bitangent = zero;
    if (hdrp_abs(det) > 1e-6f * size && size <= HDRP_FLT_MAX) {
        f.tangent = hdrp_normalize_or(t, zero);
        f.bitangent = hdrp_v3_scale(hdrp_v3_cross(footprint.normal, f.tangent), turn);
    }
    return f;
}

/** Unit tangent-space normal of two signed components; z is what makes it unit.
 *  x        [-1,1]  along the tangent
 *  y        [-1,1]  along the bitangent
 *  returns  unit    z >= 0
 *  edges    where x and y alone are longer than 1 (after filtering or compression) they are
 *           shortened to 1 and z = 0
 *  error    <= 0.025 degrees                @accuracy normal_from_xy
 *  error    <= 2.2e-5 degrees where z > 0.1  @accuracy normal_from_xy_upright
 *  source   definition
 *  note     near z = 0 an error of 1e-8 in x already turns z by 0.01 degrees */
HDRP_FN hdrp_v3 hdrp_normal_from_xy(float x, float y)
{
    float d = x * x + y * y;
    float k = d > 1.0f ? 1.0f / hdrp_sqrt(d) : 1.0f;
    return hdrp_v3_make(x * k, y * k, hdrp_sqrt(hdrp_max(1.0f - d, 0.0f)));
}

/** Tangent-space normal of a three-channel texel.
 *  rgb      [0,1]   UNORM texel
 *  returns  [-1,1]  2 rgb - 1, of the length that the texture stores
 *  edges    (0.5,0.5,0.5) gives zero, which hdrp_derivative_from_normal takes as flat
 *  error    <= 4e-8 absolute  @accuracy normal_from_rgb
 *  source   definition */
HDRP_FN hdrp_v3 hdrp_normal_from_rgb(hdrp_v3 rgb)
{
    return hdrp_v3_make(rgb.x * 2.0f - 1.0f, rgb.y * 2.0f - 1.0f, rgb.z * 2.0f - 1.0f);
}

/** Tangent-space normal of a two-channel texel, x in alpha (DXT5nm) or in red (BC5).
 *  texel    [0,1]  UNORM texel; DXT5nm has red = 1, a two-channel format reads alpha = 1
 *  returns  unit   z >= 0
 *  edges    as hdrp_normal_from_xy
 *  error    none: delegates to hdrp_normal_from_xy
 *  source   definition; red times alpha serves both formats */
HDRP_FN hdrp_v3 hdrp_normal_from_ag(hdrp_v4 texel)
{
    return hdrp_normal_from_xy(texel.x * texel.w * 2.0f - 1.0f, texel.y * 2.0f - 1.0f);
}

/** Height derivative of a tangent-space normal.
 *  v        [-1e18,1e18]  tangent-space normal of any length, from a function above
 *  scale    [-1e6,1e6]    strength of the bumps; 1 as stored, negative turns bumps into dents
 *  returns  change of height along tangent and bitangent; at most HDRP_SLOPE_MAX * |scale| long
 *  edges    z <= 0 and slopes above HDRP_SLOPE_MAX give that slope in the direction of (x,y), or
 *           flat where x = y = 0; a zero vector gives flat
 *  error    <= 2.4e-7 relative to the length  @accuracy derivative_from_normal
 *  source   Mikkelsen 2020, "Surface Gradient-Based Bump Mapping Framework", section on
 *           tangent-space normals; here the limit is on the length of the slope, and z < 0 is not
 *           folded to z > 0 */
HDRP_FN hdrp_v2 hdrp_derivative_from_normal(hdrp_v3 v, float scale)
{
    float steep = hdrp_sqrt(v.x * v.x + v.y * v.y) * (1.0f / HDRP_SLOPE_MAX);
    float limited = hdrp_max(v.z, steep);
    float z = limited > 0.0f ? limited : 1.0f;
    return hdrp_v2_make(v.x / z * -scale, v.y / z * -scale);
}

/** Height derivative at a texel of a height map, from its four neighbours.
 *  left     [-1e9,1e9]  [m] height at the neighbour against the tangent
 *  right    [-1e9,1e9]  [m] along the tangent
 *  below    [-1e9,1e9]  [m] against the bitangent
 *  above    [-1e9,1e9]  [m] along the bitangent
 *  spacing  [1e-9,1e9]  [m] between neighbouring texels along tangent and bitangent
 *  returns  change of height along tangent and bitangent
 *  edges    a smaller spacing, also NaN, counts as 1e-9
 *  error    <= 2e-7 relative to the central difference  @accuracy derivative_from_heights
 *  source   central difference, whose own error is of second order in the spacing */
HDRP_FN hdrp_v2 hdrp_derivative_from_heights(float left, float right, float below, float above,
                                             hdrp_v2 spacing)
{
    return hdrp_v2_make(0.5f * (right - left) / hdrp_max(spacing.x, 1e-9f),
                        0.5f * (above - below) / hdrp_max(spacing.y, 1e-9f));
}

/** Surface gradient of a height derivative in a tangent frame.
 *  derivative  [-1e18,1e18]  from hdrp_derivative_from_normal or hdrp_derivative_from_heights
 *  tangent     [-1e18,1e18]  of hdrp_surface_frame_from_vertex or hdrp_basis_from_uv
 *  bitangent   [-1e18,1e18]  likewise
 *  returns     derivative.x * tangent + derivative.y * bitangent
 *  edges       zero tangents give a zero gradient: flat
 *  error       <= 1.5e-7 relative to the sum of both lengths  @accuracy surface_gradient_derivative
 *  source      Mikkelsen 2020, "Surface Gradient-Based Bump Mapping Framework" */
HDRP_FN hdrp_v3 hdrp_surface_gradient_from_derivative(hdrp_v2 derivative, hdrp_v3 tangent,
                                                      hdrp_v3 bitangent)
{
    return hdrp_v3_mad(hdrp_v3_scale(tangent, derivative.x), bitangent, derivative.y);
}

/** Surface gradient that turns n into a given normal: an object- or world-space map.
 *  n        unit  interpolated vertex normal, normalised
 *  v        any   the other normal, of any length, in the space of n
 *  returns  tangent to the surface, at most HDRP_SLOPE_MAX long
 *  edges    at 89.55 degrees from n and beyond, below the surface too, the slope stays
 *           HDRP_SLOPE_MAX towards v; v within 5e-7 rad of -n, zero or not finite gives flat
 *  error    <= 1.4e-5 degrees between the resolved normal and v  @accuracy surface_gradient_normal
 *  source   Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU"; Mikkelsen 2020,
 *           "Surface Gradient-Based Bump Mapping Framework", section on object-space normals */
HDRP_FN hdrp_v3 hdrp_surface_gradient_from_normal(hdrp_v3 n, hdrp_v3 v)
{
    hdrp_v3 u = hdrp_normalize_or(v, n);
    float k = hdrp_v3_dot(n, u);
    hdrp_v3 p = hdrp_v3_mad(u, n, -k);
    float z = hdrp_max(k, hdrp_v3_length(p) * (1.0f / HDRP_SLOPE_MAX));
    /* At v = -n, p is rounding noise, up to 5e-7 long. */
    return hdrp_v3_scale(p, z > 5e-7f / HDRP_SLOPE_MAX ? -1.0f / z : 0.0f);
}

/** Surface gradient of a bump height that is defined in space, such as noise.
 *  n         unit          interpolated vertex normal, normalised
 *  gradient  [-1e18,1e18]  of the height in space
 *  returns   its part in the tangent plane
 *  edges     a gradient along n moves no normal: zero up to rounding
 *  error     <= 3e-7 relative to the length of gradient  @accuracy surface_gradient_volume
 *  source    Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU", equation 2 */
HDRP_FN hdrp_v3 hdrp_surface_gradient_from_volume(hdrp_v3 n, hdrp_v3 gradient)
{
    return hdrp_v3_mad(gradient, n, -hdrp_v3_dot(n, gradient));
}

/** Surface gradient of a height that is known only through its screen derivatives.
 *  footprint  valid       of the same pixel
 *  dh_dx      [-1e9,1e9]  [m] screen derivative of the height
 *  dh_dy      [-1e9,1e9]  [m] likewise in y
 *  returns    tangent to the surface
 *  edges      a footprint without area gives flat
 *  error      <= 3e-6 relative against the gradient of a plane wave, where the derivatives are no
 *             closer to parallel than 0.1 rad  @accuracy surface_gradient_height
 *  source     Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU"
 *  note       blocky at 2x2 pixels, as screen derivatives of a height are; prefer the gradient */
HDRP_FN hdrp_v3 hdrp_surface_gradient_from_height(hdrp_surface_footprint footprint, float dh_dx,
                                                  float dh_dy)
{
    float area = footprint.area != 0.0f ? footprint.area : 1.0f;
    hdrp_v3 rx = hdrp_v3_cross(footprint.sigma_y, footprint.normal);
    hdrp_v3 ry = hdrp_v3_cross(footprint.normal, footprint.sigma_x);
    return hdrp_v3_mad(hdrp_v3_scale(rx, dh_dx / area), ry, dh_dy / area);
}

/** q to the power sharpness, 0 for 0. */
HDRP_FN float hdrp_i_triplanar_weight(float q, float sharpness)
{
    return q > HDRP_FLT_MIN ? hdrp_pow(hdrp_max(q, HDRP_FLT_MIN), sharpness) : 0.0f;
}

/** Weights of the three planes of a triplanar projection.
 *  n          any    normal, of any length
 *  sharpness  any    limited to [1,64]: 1 blends everywhere, 8 over some 30 degrees
 *  returns    [0,1]  weight of the x, y and z plane; the sum is 1
 *  edges      on an axis exactly 1 and two 0; a normal without direction gives three equal weights
 *  error      <= 2e-6 absolute  @accuracy triplanar_weights
 *  source     Golus 2017, "Normal Mapping for a Triplanar Shader", on powers of the components */
HDRP_FN hdrp_v3 hdrp_triplanar_weights(hdrp_v3 n, float sharpness)
{
    hdrp_v3 u = hdrp_normalize_or(n, hdrp_v3_splat(1.0f));
    float s = hdrp_clamp(sharpness, 1.0f, 64.0f);
    float largest = hdrp_max(hdrp_max(hdrp_abs(u.x), hdrp_abs(u.y)), hdrp_abs(u.z));
    float x = hdrp_i_triplanar_weight(hdrp_abs(u.x) / largest, s);
    float y = hdrp_i_triplanar_weight(hdrp_abs(u.y) / largest, s);
    float z = hdrp_i_triplanar_weight(hdrp_abs(u.z) / largest, s);
    float sum = x + y + z;
    return hdrp_v3_make(x / sum, y / sum, z / sum);
}

/** Surface gradient of three planar projections.
 *  n         unit          interpolated vertex normal, normalised
 *  weights   [0,1]         from hdrp_triplanar_weights
 *  x_plane   [-1e18,1e18]  derivative of the map looked up with (z,y)
 *  y_plane   [-1e18,1e18]  derivative of the map looked up with (x,z)
 *  z_plane   [-1e18,1e18]  derivative of the map looked up with (x,y)
 *  returns   tangent to the surface
 *  edges     faces towards the negative axes need nothing special: the picture is mirrored there,
 *            the bumps are right; where a coordinate is negated for the look-up (to unmirror it, or
 *            because green grows against it) negate that component of the derivative
 *  error     <= 4e-7 relative to the largest derivative  @accuracy surface_gradient_triplanar
 *  source    Mikkelsen 2020, "Surface Gradient-Based Bump Mapping Framework", section on triplanar
 *            projection */
HDRP_FN hdrp_v3 hdrp_surface_gradient_from_triplanar(hdrp_v3 n, hdrp_v3 weights, hdrp_v2 x_plane,
                                                     hdrp_v2 y_plane, hdrp_v2 z_plane)
{
    hdrp_v3 gradient = hdrp_v3_make(weights.y * y_plane.x + weights.z * z_plane.x,
                                    weights.x * x_plane.y + weights.z * z_plane.y,
                                    weights.x * x_plane.x + weights.y * y_plane.y);
    return hdrp_surface_gradient_from_volume(n, gradient);
}

/** Shading normal of a surface gradient, wherever it points.
 *  n         unit  interpolated vertex normal, normalised
 *  gradient  any   sum of surface gradients
 *  returns   unit  normalize(n - gradient)
 *  edges     n where n - gradient is zero or not finite; below the surface where the gradient has
 *            a part along n that takes it there
 *  error     <= 2e-7 absolute, per component, for gradients up to 1e4
 *            @accuracy normal_from_surface_gradient_unclamped
 *  source    Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU", equation 4 */
HDRP_FN hdrp_v3 hdrp_normal_from_surface_gradient_unclamped(hdrp_v3 n, hdrp_v3 gradient)
{
    return hdrp_normalize_or(hdrp_v3_sub(n, gradient), n);
}

/** Shading normal of a surface gradient, never below the surface.
 *  n         unit  interpolated vertex normal, normalised
 *  gradient  any   sum of surface gradients
 *  returns   unit  normalize(n - gradient), at a cosine to n of at least 9e-6
 *  edges     n where n - gradient is zero, opposite to n or not finite; lifted to
 *            HDRP_SURFACE_COSINE_MIN where it would lie below
 *  error     <= 2e-7 absolute, per component, for gradients in the tangent plane up to 1e4
 *            @accuracy normal_from_surface_gradient
 *  source    Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU"
 *  note      only a gradient along n can take it below: the interpolated tangents of a coarse mesh
 *            have such a part, as has the classical tangent-space transform */
HDRP_FN hdrp_v3 hdrp_normal_from_surface_gradient(hdrp_v3 n, hdrp_v3 gradient)
{
    hdrp_v3 u = hdrp_normal_from_surface_gradient_unclamped(n, gradient);
    float c = hdrp_v3_dot(n, u);
    float lift = hdrp_max(HDRP_SURFACE_COSINE_MIN - c, 0.0f);
    hdrp_v3 lifted = hdrp_normalize_or(hdrp_v3_mad(u, n, lift), n);
    if (c < HDRP_SURFACE_COSINE_MIN) {
        return lifted;
    }
    return u;
}

/* >>sampling
 * Points. hdrp_hammersley for a fixed number of samples (tables, prefiltering): the most even, but
 * the number must be known. hdrp_r2 for a growing number (accumulation over frames): every prefix
 * is even. The Fibonacci disk and sphere where a pattern is seen or rotated: no clumps, no axes.
 * Hashes, where neighbours must share nothing: seeds, dither, offsets of the above per pixel.
 * Everything is integer arithmetic until the last step, so that index 10^9 is as exact as index 1.
 *
 * Mappings take a point of the unit square, [0,1] with both ends, to a disk or to directions around
 * +Z; hdrp_basis_from_normal turns those into world space. They keep areas, so that an even point
 * set stays even. */

#define HDRP_INV_TWO_PI  0.159154943091895f  /* [1/sr] density of hdrp_hemisphere_uniform */
#define HDRP_INV_FOUR_PI 0.0795774715459477f /* [1/sr] density of hdrp_sphere_uniform */

/** A float in [0,1) of the upper 24 bits of u.
 *  u        any    all 2^32 values
 *  returns  [0,1)  a multiple of 2^-24; at most 1 - 2^-24
 *  edges    none
 *  error    none: exact truncation
 *  source   definition */
HDRP_FN float hdrp_unit_from_u32(hdrp_u32 u)
{
    return hdrp_f32_from_u32(u >> 8) * 5.9604644775390625e-8f; /* 2^-24 */
}

/** Integer hash: a bijection of the 32-bit integers in which every bit changes every other.
 *  u        any  all 2^32 values
 *  returns  any  flipping a bit of u flips each bit of the result with probability 0.5 +- 0.001
 *  edges    none; 0 is not mapped to 0
 *  error    none: exact
 *  source   two rounds of multiply and xor-shift, as the finaliser of MurmurHash3 (Appleby 2011);
 *           multipliers from Wellons 2018, "Prospecting for Hash Functions" */
HDRP_FN hdrp_u32 hdrp_hash1(hdrp_u32 u)
{
    hdrp_u32 h = u ^ 0x9e3779b9u; /* any number but 0, which would stay 0 */
    h = (h ^ (h >> 16)) * 0x21f0aaadu;
    h = (h ^ (h >> 15)) * 0xd35a2d97u;
    return h ^ (h >> 15);
}

/** Integer hash of two numbers, such as the coordinates of a pixel.
 *  x        any  all 2^32 values
 *  y        any  all 2^32 values
 *  returns  any  as hdrp_hash1
 *  edges    no collisions in a row or a column
 *  error    none: exact
 *  source   hdrp_hash1 of both; the odd factor only tells them apart
 *  note     in the cheaper hash1(x + hash1(y)) whole rows repeat, shifted, wherever two values of
 *           hash1(y) are close */
HDRP_FN hdrp_u32 hdrp_hash2(hdrp_u32 x, hdrp_u32 y)
{
    return hdrp_hash1(hdrp_hash1(x) ^ (hdrp_hash1(y) * 0x9e3779b9u));
}

/** Integer hash of three numbers, such as a pixel and a frame.
 *  x        any  all 2^32 values
 *  y        any  all 2^32 values
 *  z        any  all 2^32 values
 *  returns  any  as hdrp_hash1
 *  edges    none
 *  error    none: exact
 *  source   hdrp_hash1 of all three; the odd factors only tell them apart */
HDRP_FN hdrp_u32 hdrp_hash3(hdrp_u32 x, hdrp_u32 y, hdrp_u32 z)
{
    return hdrp_hash1(hdrp_hash1(x) ^ (hdrp_hash1(y) * 0x9e3779b9u) ^
                      (hdrp_hash1(z) * 0x85ebca6bu));
}

/** Fraction of i times (high + low 2^-32) 2^-32, in units of 2^-32; exact to 3 units. */
HDRP_FN hdrp_u32 hdrp_i_fraction_of_multiple(hdrp_u32 i, hdrp_u32 high, hdrp_u32 low)
{
    hdrp_u32 a = i >> 16;
    hdrp_u32 b = i & 0xffffu;
    hdrp_u32 c = low >> 16;
    hdrp_u32 d = low & 0xffffu;
    return i * high + a * c + ((a * d) >> 16) + ((b * c) >> 16);
}

/** Point i of the Hammersley set of n points in the unit square.
 *  i        any    index below n
 *  n        any    number of points
 *  returns  [0,1)  (i/n, radical inverse of i in base 2)
 *  edges    n = 0 counts as 1; an index from n on stays below 1
 *  error    <= 1.8e-7 absolute  @accuracy hammersley
 *  source   Hammersley 1960, "Monte Carlo Methods for Solving Multivariable Problems" */
HDRP_FN hdrp_v2 hdrp_hammersley(hdrp_u32 i, hdrp_u32 n)
{
    float x = hdrp_f32_from_u32(i) / hdrp_max(hdrp_f32_from_u32(n), 1.0f);
    /* 1 - 2^-24 */
    return hdrp_v2_make(hdrp_min(x, 0.999999940f), hdrp_unit_from_u32(hdrp_reverse_bits(i)));
}

/** Point i of the R2 sequence in the unit square.
 *  i        any    index
 *  returns  [0,1)  (1/2 + i/p, 1/2 + i/p^2) modulo 1, p = 1.3247 with p^3 = p + 1
 *  edges    none
 *  error    <= 6.2e-8 absolute, modulo 1, for every index  @accuracy r2
 *  source   Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences" */
HDRP_FN hdrp_v2 hdrp_r2(hdrp_u32 i)
{
    hdrp_u32 x = hdrp_i_fraction_of_multiple(i, 0xc13fa9a9u, 0x02a6328fu) + 0x80000000u;
    hdrp_u32 y = hdrp_i_fraction_of_multiple(i, 0x91e10da5u, 0xc79e7b1du) + 0x80000000u;
    return hdrp_v2_make(hdrp_unit_from_u32(x), hdrp_unit_from_u32(y));
}

/** Sine and cosine of i golden angles, i times 222.49 degrees. */
HDRP_FN hdrp_sincos_result hdrp_i_sincos_golden(hdrp_u32 i)
{
    hdrp_u32 turn = hdrp_i_fraction_of_multiple(i, 0x9e3779b9u, 0x7f4a7c16u);
    return hdrp_sincos(hdrp_unit_from_u32(turn) * HDRP_TWO_PI);
}

/** Point i of n on the Fibonacci spiral in the unit disk.
 *  i        any     index below n
 *  n        any     number of points
 *  returns  [-1,1]  point at radius sqrt((i + 1/2) / n)
 *  edges    n = 0 counts as 1; an index from n on lies on the circle
 *  error    <= 6e-7 absolute, per component, for every index  @accuracy fibonacci_disk
 *  source   Vogel 1979, "A Better Way to Construct the Sunflower Head" */
HDRP_FN hdrp_v2 hdrp_fibonacci_disk(hdrp_u32 i, hdrp_u32 n)
{
    float t = (hdrp_f32_from_u32(i) + 0.5f) / hdrp_max(hdrp_f32_from_u32(n), 1.0f);
    float r = hdrp_sqrt(hdrp_min(t, 1.0f));
    hdrp_sincos_result a = hdrp_i_sincos_golden(i);
    return hdrp_v2_make(r * a.cosine, r * a.sine);
}

/** Direction i of n on the Fibonacci spiral around the unit sphere, from +Z to -Z.
 *  i        any   index below n
 *  n        any   number of directions
 *  returns  unit  direction at z = 1 - (2 i + 1) / n
 *  edges    n = 0 counts as 1; an index from n on gives -Z
 *  error    <= 6e-7 absolute, per component, for every index  @accuracy fibonacci_sphere
 *  source   Keinert et al. 2015, "Spherical Fibonacci Mapping" */
HDRP_FN hdrp_v3 hdrp_fibonacci_sphere(hdrp_u32 i, hdrp_u32 n)
{
    hdrp_u32 count = n > 0u ? n : 1u;
    hdrp_u32 rest = count > i ? count - i : 0u;
    float all = hdrp_f32_from_u32(count);
    /* The shares of the sphere above and below, each precise where it is small. */
    float above = hdrp_min((hdrp_f32_from_u32(i) + 0.5f) / all, 1.0f);
    float below = hdrp_max((hdrp_f32_from_u32(rest) - 0.5f) / all, 0.0f);
    float r = 2.0f * hdrp_sqrt(above * below);
    hdrp_sincos_result a = hdrp_i_sincos_golden(i);
    return hdrp_v3_make(r * a.cosine, r * a.sine, below - above);
}

/** Point of the unit disk by the concentric map: squares around the middle become circles.
 *  u        [0,1]   point of the unit square
 *  returns  [-1,1]  uniform over the disk, density 1/pi; (0,0) from the middle
 *  edges    the border of the square is the circle; outside, also NaN, as at the border
 *  error    <= 2e-7 absolute, per component  @accuracy disk_concentric
 *  source   Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square" */
HDRP_FN hdrp_v2 hdrp_disk_concentric(hdrp_v2 u)
{
    float a = 2.0f * hdrp_saturate(u.x) - 1.0f;
    float b = 2.0f * hdrp_saturate(u.y) - 1.0f;
    float steep = hdrp_abs(b) > hdrp_abs(a) ? 1.0f : 0.0f;
    float r = steep > 0.0f ? b : a;
    float s = steep > 0.0f ? a : b;
    float q = s / (r != 0.0f ? r : 1.0f);
    hdrp_sincos_result t = hdrp_sincos(0.25f * HDRP_PI * q);
    float along = r * t.cosine;
    float across = r * t.sine;
    return hdrp_v2_make(steep > 0.0f ? across : along, steep > 0.0f ? along : across);
}

/** Point of the unit disk by polar coordinates: rows become rings, columns become sectors.
 *  u        [0,1]   x sets the radius, y the angle
 *  returns  [-1,1]  uniform over the disk, density 1/pi
 *  edges    outside, also NaN, as at the border
 *  error    <= 5e-7 absolute, per component  @accuracy disk_polar
 *  source   definition: radius sqrt(x), angle 2 pi y */
HDRP_FN hdrp_v2 hdrp_disk_polar(hdrp_v2 u)
{
    float r = hdrp_sqrt(hdrp_saturate(u.x));
    hdrp_sincos_result a = hdrp_sincos(hdrp_saturate(u.y) * HDRP_TWO_PI);
    return hdrp_v2_make(r * a.cosine, r * a.sine);
}

/** Direction around +Z with a density proportional to its cosine, for diffuse light.
 *  u        [0,1]  point of the unit square
 *  returns  unit   z >= 0; density hdrp_hemisphere_cosine_pdf(z)
 *  edges    the border of the square is the horizon; outside, also NaN, as at the border
 *  error    <= 2e-7 absolute, per component  @accuracy hemisphere_cosine
 *  source   Malley's method, in Pharr et al. 2016, "Physically Based Rendering", section 13.6.3
 *  note     z from the square, not from x and y: its relative precision holds at the horizon */
HDRP_FN hdrp_v3 hdrp_hemisphere_cosine(hdrp_v2 u)
{
    hdrp_v2 d = hdrp_disk_concentric(u);
    float x = hdrp_saturate(u.x);
    float y = hdrp_saturate(u.y);
    /* Distance to the border of the square: the radius is 1 - 2 e. */
    float e = hdrp_min(hdrp_min(x, 1.0f - x), hdrp_min(y, 1.0f - y));
    return hdrp_v3_make(d.x, d.y, 2.0f * hdrp_sqrt(e * (1.0f - e)));
}

/** Density of hdrp_hemisphere_cosine.
 *  cosine   [-1,1]           of the angle to +Z
 *  returns  [0,HDRP_INV_PI]  [1/sr]
 *  edges    0 below the horizon and for NaN
 *  error    <= 1.2e-7 relative  @accuracy hemisphere_cosine_pdf
 *  source   definition */
HDRP_FN float hdrp_hemisphere_cosine_pdf(float cosine)
{
    return hdrp_max(cosine, 0.0f) * HDRP_INV_PI;
}

/** Direction of the upper hemisphere with density HDRP_INV_TWO_PI.
 *  u        [0,1]  x sets the height, y the angle
 *  returns  unit   z = 1 - x
 *  edges    outside, also NaN, as at the border
 *  error    <= 5e-7 absolute, per component  @accuracy hemisphere_uniform
 *  source   Archimedes: the area of a band of a sphere is proportional to its height */
HDRP_FN hdrp_v3 hdrp_hemisphere_uniform(hdrp_v2 u)
{
    float x = hdrp_saturate(u.x);
    float r = hdrp_sqrt(x * (2.0f - x));
    hdrp_sincos_result a = hdrp_sincos(hdrp_saturate(u.y) * HDRP_TWO_PI);
    return hdrp_v3_make(r * a.cosine, r * a.sine, 1.0f - x);
}

/** Direction of the sphere with density HDRP_INV_FOUR_PI.
 *  u        [0,1]  x sets the height, y the angle
 *  returns  unit   z = 1 - 2 x
 *  edges    outside, also NaN, as at the border
 *  error    <= 5e-7 absolute, per component  @accuracy sphere_uniform
 *  source   Archimedes: the area of a band of a sphere is proportional to its height */
HDRP_FN hdrp_v3 hdrp_sphere_uniform(hdrp_v2 u)
{
    float x = hdrp_saturate(u.x);
    float r = 2.0f * hdrp_sqrt(x * (1.0f - x));
    hdrp_sincos_result a = hdrp_sincos(hdrp_saturate(u.y) * HDRP_TWO_PI);
    return hdrp_v3_make(r * a.cosine, r * a.sine, 1.0f - 2.0f * x);
}

/* >>depth */

/* How to turn device depth into metres. Made by hdrp_depth_params_perspective and
 * hdrp_depth_params_orthographic. */
struct hdrp_depth_params {
    hdrp_v4 ratio;    /* [-1e18,1e18] depth = (x e + y) / (z e + w) with e: */
    hdrp_v4 nearness; /* [-1,1] e = x * device depth + y, 1 at the near and 0 at the far distance */
};
HDRP_TYPEDEF(hdrp_depth_params)

#ifndef HDRP_GPU
typedef char hdrp_i_depth_params_size_of[sizeof(hdrp_depth_params) == 32 ? 1 : -1];
#endif

/* Metres; as the far distance: none. Also the depth of what is behind everything. */
#define HDRP_DEPTH_INFINITE 1e18f

HDRP_FN hdrp_v4 hdrp_i_depth_nearness(hdrp_u32 reverse)
{
    return hdrp_v4_make(reverse != 0u ? 1.0f : -1.0f, reverse != 0u ? 0.0f : 1.0f, 0.0f, 0.0f);
}

/** How to read the device depth of a perspective projection.
 *  near_m   [1e-6,1e9]     distance of the near plane
 *  far_m    [1e-6,FLT_MAX] distance of the far plane; HDRP_DEPTH_INFINITE or more: none
 *  reverse  [0,1]          1 where device depth is 1 at the near plane and 0 at the far one
 *  returns  valid
 *  edges    a far plane in front of the near one counts as at it
 *  error    none: a quotient and a difference
 *  source   Lapidous and Jiao 1999, "Optimal Depth Buffer for Low-Cost Graphics Hardware", for the
 *           complement
 *  note     forward depth is complemented first, which is exact from 1/2 to 1: nothing else is lost
 *           than what the buffer has lost */
HDRP_FN hdrp_depth_params hdrp_depth_params_perspective(float near_m, float far_m, hdrp_u32 reverse)
{
    hdrp_depth_params p;
    float k = far_m >= HDRP_DEPTH_INFINITE ? 0.0f : near_m / hdrp_max(far_m, near_m);
    p.ratio = hdrp_v4_make(0.0f, near_m, 1.0f - k, k);
    p.nearness = hdrp_i_depth_nearness(reverse);
    return p;
}

/** How to read the device depth of an orthographic projection.
 *  near_m   [0,1e9]  distance of the near plane
 *  far_m    [0,1e18] distance of the far plane
 *  reverse  [0,1]    1 where device depth is 1 at the near plane and 0 at the far one
 *  returns  valid
 *  edges    none
 *  error    none: a difference
 *  source   a definition */
HDRP_FN hdrp_depth_params hdrp_depth_params_orthographic(float near_m, float far_m,
                                                         hdrp_u32 reverse)
{
    hdrp_depth_params p;
    p.ratio = hdrp_v4_make(near_m - far_m, far_m, 0.0f, 1.0f);
    p.nearness = hdrp_i_depth_nearness(reverse);
    return p;
}

/** Depth in front of the camera, in metres, from device depth.
 *  params        valid
 *  device_depth  any
 *  returns       [0,HDRP_DEPTH_INFINITE]
 *  edges         HDRP_DEPTH_INFINITE at the far plane of an infinite projection; a device depth
 *                outside [0,1] counts as the nearer end, NaN as 0
 *  error         <= 2.4e-7 relative against the projection matrix in double, however far apart near
 *                and far are; orthographic to the far distance  @accuracy view_depth
 *  source        inverse of the projection */
HDRP_FN float hdrp_view_depth(hdrp_depth_params params, float device_depth)
{
    /* Products by themselves, because clang fuses what is in one expression: see hdrp_cull.h. */
    float share = hdrp_saturate(device_depth) * params.nearness.x;
    float e = share + params.nearness.y;
    float above = params.ratio.x * e;
    float below = params.ratio.z * e;
    float z = (above + params.ratio.y) / hdrp_max(below + params.ratio.w, HDRP_FLT_MIN);
    return hdrp_clamp(z, 0.0f, HDRP_DEPTH_INFINITE);
}

/** Device depth of a depth in front of the camera.
 *  params   valid
 *  z_view   any    m
 *  returns  [0,1]
 *  edges    the near plane's in front of it, the far plane's behind it and for NaN; an infinite far
 *           plane counts as at HDRP_DEPTH_INFINITE here
 *  error    <= 2.4e-7 relative, of a reverse depth above near / far, which is at most a half;
 *           orthographic absolute  @accuracy device_depth
 *  error    <= 1.8e-7 absolute, of forward depth, likewise  @accuracy device_depth_forward
 *  source   the projection */
HDRP_FN float hdrp_device_depth(hdrp_depth_params params, float z_view)
{
    float z = z_view >= 0.0f ? hdrp_min(z_view, HDRP_DEPTH_INFINITE) : HDRP_DEPTH_INFINITE;
    float e = (params.ratio.y - params.ratio.w * z) / (params.ratio.z * z - params.ratio.x);
    e = z_view < 0.0f ? 1.0f : hdrp_saturate(e);
    return (e - params.nearness.y) * params.nearness.x;
}

/* >>algorithm layer: results, C and C++ only */
#ifndef HDRP_GPU

typedef enum hdrp_result {
    HDRP_OK = 0,
    HDRP_ERROR_NULL_POINTER,         /* a required pointer is NULL */
    HDRP_ERROR_BAD_ARGUMENT,         /* a value is outside its documented range, or not finite */
    HDRP_ERROR_MEMORY_TOO_SMALL,     /* the block is smaller than hdrp_<module>_memory_size said */
    HDRP_ERROR_MEMORY_ALIGNMENT,     /* the block is not aligned to HDRP_MEMORY_ALIGNMENT bytes */
    HDRP_ERROR_TOO_LARGE,            /* a size does not fit the arithmetic of the target */
    HDRP_ERROR_OUT_OF_HOST_MEMORY,   /* a graphics driver found no memory */
    HDRP_ERROR_OUT_OF_DEVICE_MEMORY, /* a graphics device or a pool of it has no room */
    HDRP_ERROR_UNSUPPORTED,          /* a device lacks what is needed */
    HDRP_ERROR_DEVICE_LOST,          /* the device has to be made again */
    HDRP_ERROR_DRIVER                /* another failure of a graphics driver */
} hdrp_result;

#define HDRP_MEMORY_ALIGNMENT 16
/* Sizes of blocks are rounded up to it, as aligned_alloc of C11 asks. */
#define HDRP_MEMORY_ROUND_UP(bytes)                                                                \
    (((bytes) + (HDRP_MEMORY_ALIGNMENT - 1u)) / HDRP_MEMORY_ALIGNMENT * HDRP_MEMORY_ALIGNMENT)

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
    case HDRP_ERROR_OUT_OF_HOST_MEMORY:
        return "the graphics driver is out of memory";
    case HDRP_ERROR_OUT_OF_DEVICE_MEMORY:
        return "the graphics device is out of memory";
    case HDRP_ERROR_UNSUPPORTED:
        return "the graphics device lacks what is needed";
    case HDRP_ERROR_DEVICE_LOST:
        return "the graphics device is lost";
    case HDRP_ERROR_DRIVER:
        return "the graphics driver failed";
    }
    return "unknown result";
}

#endif /* HDRP_GPU */
#endif /* HDRP_MATH_H */
