/* peers.c - loops over what C libraries offer.
 * SPDX-License-Identifier: MIT */
#define _GNU_SOURCE
#include "bench.h"

#include <immintrin.h>

/* Imath without F16C: what it does itself. With it, each call is that instruction. */
#pragma push_macro("__F16C__")
#undef __F16C__
#include <Imath/half.h>
#pragma pop_macro("__F16C__")

#include <cglm/cglm.h>

#include "rows_begin.h"

static inline hdrp_v3 bench_v3_from_cglm(const float* v)
{
    return hdrp_v3_make(v[0], v[1], v[2]);
}

static inline float bench_cglm_dot(hdrp_v3 a, hdrp_v3 b)
{
    vec3 x = {a.x, a.y, a.z}, y = {b.x, b.y, b.z};
    return glm_vec3_dot(x, y);
}

static inline hdrp_v3 bench_cglm_cross(hdrp_v3 a, hdrp_v3 b)
{
    vec3 x = {a.x, a.y, a.z}, y = {b.x, b.y, b.z}, r;
    glm_vec3_cross(x, y, r);
    return bench_v3_from_cglm(r);
}

static inline hdrp_v3 bench_cglm_normalize(hdrp_v3 a)
{
    vec3 x = {a.x, a.y, a.z};
    glm_vec3_normalize(x);
    return bench_v3_from_cglm(x);
}

static inline hdrp_v3 bench_libm_sincos(float x)
{
    float s, c;
    sincosf(x, &s, &c);
    return hdrp_v3_make(s, c, 0.0f);
}

static inline float bench_libm_linear(float c)
{
    return c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
}

static inline float bench_libm_srgb(float x)
{
    return x <= 0.0031308f ? x * 12.92f : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
}

static inline void bench_f16c_encode(uint16_t* to, const float* from, size_t count)
{
    for (size_t i = 0; i < count; i += 8) {
        _mm_store_si128((__m128i*)(to + i), _mm256_cvtps_ph(_mm256_load_ps(from + i), 0));
    }
}

static inline void bench_f16c_decode(float* to, const uint16_t* from, size_t count)
{
    for (size_t i = 0; i < count; i += 8) {
        _mm256_store_ps(to + i, _mm256_cvtph_ps(_mm_load_si128((const __m128i*)(from + i))));
    }
}

/* 16 bytes an element, read and written. */
static inline void bench_copy_two(float* to, const float* from)
{
    memcpy(to, from, BENCH_MEMORY_COUNT * sizeof *to);
    memcpy(bench_memory_code, bench_memory_c, BENCH_MEMORY_COUNT * sizeof *to);
}

/* The three conversions of a colour, packed as loosely as it costs nothing: what three channels
 * would take if the instruction knew the format. */
static inline void bench_f16c_encode_rgb(uint16_t* to, const float* r, const float* g,
                                         const float* b, size_t count)
{
    for (size_t i = 0; i < count; i += 8) {
        __m128i x = _mm256_cvtps_ph(_mm256_load_ps(r + i), 0);
        __m128i y = _mm256_cvtps_ph(_mm256_load_ps(g + i), 0);
        __m128i z = _mm256_cvtps_ph(_mm256_load_ps(b + i), 0);
        _mm_store_si128((__m128i*)(to + i), _mm_xor_si128(_mm_xor_si128(x, y), z));
    }
}

/* FGD by importance sampling, as most renderers make their table. */
static void bench_fgd_monte_carlo(hdrp_brdf_fgd* table, int samples)
{
    for (int k = 0; k < BENCH_TABLE_SIZE * BENCH_TABLE_SIZE; ++k) {
        float c = ((float)(k % BENCH_TABLE_SIZE) + 0.5f) / BENCH_TABLE_SIZE;
        float a = hdrp_sq(((float)(k / BENCH_TABLE_SIZE) + 0.5f) / BENCH_TABLE_SIZE);
        float s = sqrtf(1.0f - c * c), albedo = 0.0f, schlick = 0.0f;
        for (int i = 0; i < samples; ++i) {
            hdrp_v2 u = hdrp_hammersley((hdrp_u32)i, (hdrp_u32)samples);
            float nh = sqrtf((1.0f - u.y) / (1.0f + (a * a - 1.0f) * u.y));
            float vh = s * sqrtf(1.0f - nh * nh) * cosf(HDRP_TWO_PI * u.x) + c * nh;
            float nl = 2.0f * vh * nh - c;
            if (nl > 0.0f && vh > 0.0f) {
                float g = 4.0f * hdrp_brdf_v_smith_ggx(nl, c, a) * nl * vh / nh;
                albedo += g;
                schlick += g * hdrp_brdf_schlick_weight(vh);
            }
        }
        table[k].albedo = albedo / (float)samples;
        table[k].schlick = schlick / (float)samples;
    }
}

#include "peers.inc"

#define BENCH_TABLE
#include "rows_begin.h"

static const bench_kernel kernels[] = {
#include "peers.inc"
};

const bench_list BENCH_LIST = {kernels, sizeof kernels / sizeof kernels[0]};
