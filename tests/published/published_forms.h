/* published_forms.h - what others have published for the same purpose, to compare with.
 * SPDX-License-Identifier: MIT
 *
 * In float and limited to [0,1], as a shader would use them; nothing is repaired. */
#ifndef PUBLISHED_FORMS_H
#define PUBLISHED_FORMS_H

#include <math.h>

#include "hdrp_brdf_lobes.h"

/* Response of the observer, in XYZ, to a spectrum cos(2 pi opd / wavelength + shift), read as RGB by
 * the talk. Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of
 * Varying Iridescence", the constants of its supplement. */
static inline hdrp_v3 published_sensitivity(float opd_um, float shift)
{
    const float two_pi = 6.28318531f, scale = 1.0f / 1.0685e-7f;
    float phase = two_pi * opd_um * 1e-6f, p2 = phase * phase;
    float x1 = 5.4856e-13f * sqrtf(two_pi * 4.3278e9f) * cosf(1.6810e6f * phase + shift);
    float x2 = 9.7470e-14f * sqrtf(two_pi * 4.5282e9f) * cosf(2.2399e6f * phase + shift);
    float y = 4.4201e-13f * sqrtf(two_pi * 9.3046e9f) * cosf(1.7953e6f * phase + shift);
    float z = 5.2481e-13f * sqrtf(two_pi * 6.6121e9f) * cosf(2.2084e6f * phase + shift);
    return hdrp_v3_make(scale * (x1 * expf(-4.3278e9f * p2) + x2 * expf(-4.5282e9f * p2)),
                        scale * y * expf(-9.3046e9f * p2), scale * z * expf(-6.6121e9f * p2));
}

static inline float published_film_channel(float r12, float r23, float s1, float s2)
{
    float t121 = 1.0f - r12, r123 = r12 * r23, root = sqrtf(r123);
    float rs = t121 * t121 * r23 / (1.0f - r123);
    float c1 = (rs - t121) * root;
    return hdrp_saturate(r12 + rs + 2.0f * (c1 * s1 + c1 * root * s2));
}

/* Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High Definition Render
 * Pipeline", slides on iridescence (credit: Belcour). The thickness t there, in [0,1], is
 * film_ior = 2 - t and thickness_nm = 1500 t / film_ior. */
static inline hdrp_v3 published_film(float cos_theta, float outer_ior, float film_ior,
                                     float thickness_nm, hdrp_v3 fresnel0)
{
    const float pi = 3.14159265f;
    float ratio = outer_ior / film_ior, r0 = (film_ior - outer_ior) / (film_ior + outer_ior);
    float c2 = sqrtf(1.0f - ratio * ratio * (1.0f - cos_theta * cos_theta));
    float opd_um = 2e-3f * film_ior * thickness_nm * c2;
    float r12 = hdrp_brdf_f_schlick(r0 * r0, 1.0f, cos_theta);
    hdrp_v3 r23 = hdrp_brdf_f_schlick_rgb(fresnel0, 1.0f, c2);
    hdrp_v3 s1 = published_sensitivity(opd_um, pi);
    hdrp_v3 s2 = published_sensitivity(2.0f * opd_um, 2.0f * pi);
    return hdrp_v3_make(published_film_channel(r12, r23.x, s1.x, s2.x),
                        published_film_channel(r12, r23.y, s1.y, s2.y),
                        published_film_channel(r12, r23.z, s1.z, s2.z));
}

/* Karis 2014, "Physically Based Shading on Mobile": the environment BRDF without a table. */
static inline hdrp_brdf_fgd published_fgd(float n_dot_v, float perceptual_roughness)
{
    hdrp_brdf_fgd f;
    float x = 1.0f - perceptual_roughness;
    float y = 0.0425f - 0.0275f * perceptual_roughness;
    float a004 = fminf(x * x, exp2f(-9.28f * n_dot_v)) * x + y;
    float scale = -1.04f * a004 + 1.04f - 0.572f * perceptual_roughness;
    f.schlick = hdrp_saturate(1.04f * a004 - 0.04f + 0.022f * perceptual_roughness);
    f.albedo = hdrp_saturate(scale + f.schlick);
    return f;
}

/* Abramowitz and Stegun 1964, "Handbook of Mathematical Functions", 4.4.45, for x in [0,1]. */
static inline float published_acos(float x)
{
    return sqrtf(1.0f - x) * (1.5707288f + x * (-0.2121144f + x * (0.0742610f + x * -0.0187293f)));
}

/* A float with bits_lost bits of its mantissa cut off instead of rounded, as packing by shifts and
 * masks does to normal numbers. */
static inline float published_truncated(float x, hdrp_u32 bits_lost)
{
    return hdrp_f32_from_bits(hdrp_bits_from_f32(x) >> bits_lost << bits_lost);
}

#endif
