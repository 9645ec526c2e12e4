/* hdrp_oit.h - transparency without sorting: weighted sums, moments and wavelets of transmittance.
 * SPDX-License-Identifier: MIT
 *
 * See hdrp_math.h for the languages, the conventions and the override macros. Fragments are blended
 * into targets in any order; a composite then makes the colour of the pixel. The recommended mode
 * takes one pass and two RGBA16F targets:
 *
 *     hdrp_oit_fragment f = hdrp_oit_fragment_make(color_times_alpha, emission, alpha, z_view);
 *     hdrp_oit_targets t = hdrp_oit_export(f, scale);                    in the fragment shader
 *     color = hdrp_oit_composite(t_of_the_pixel, opaque_color, scale);   for each pixel, afterwards
 *
 * hdrp_oit_describe_targets says which targets each mode needs, and how they are blended. After a
 * pass of depth hdrp_oit_front_export keeps the nearest fragment apart. The better modes draw
 * transparent surfaces three times: the range of depths, what absorbs where, and colour:
 *
 *     hdrp_oit_range_export(f)                                           pass 0, blended with MAX
 *     place = hdrp_oit_place_of(f, range_of_the_pixel);
 *     hdrp_oit_wavelet_insert(f, place)                                  pass 1, added
 *     through = hdrp_oit_wavelet_transmittance(w_of_the_pixel, f, place);
 *     t = hdrp_oit_layer_export(f, through, scale);                      pass 2
 *     color = hdrp_oit_layer_composite(t_of_the_pixel, opaque_color, scale);
 *
 * Emission is what a surface adds whatever its alpha: fire, sparks, glow. It goes into sums of its
 * own, so that pixels where nothing covers anything are exact in every mode but that of the talk,
 * and so is one layer that covers and emits, however thin; published weights lose the colour of one
 * that covers less than 2^-9. What shines in proportion to its alpha is a part of its colour.
 * Colours are as they will be shown, exposed; scale is a power of 2 that brings them near 1 where
 * they are not, and products with weights stay below 65504 / 32 whatever they are: 32 fragments
 * never overflow a half float.
 *
 * Which mode: tests/oit/recorded.csv holds the error of each against sorting, docs/tradeoffs.md
 * shows them. A fragment that is not there (alpha 0, no emission) has no influence on any.
 *
 * The algorithm layer, C and C++ only, does on images what blending hardware does, with the
 * rounding of each format. It is compiled in one source file:
 *
 *     #define HDRP_OIT_IMPLEMENTATION
 *     #include "hdrp_oit.h"
 *
 * >>index of the functions, without hdrp_oit_ (written by tools/api_check.py --write)
 *   fragments: fragment_make
 *   published weights: weight_eq7 weight_eq8 weight_eq9 weight_eq10 weight_2015
 *   recommended: weight weighted_export export composite merge
 *   talk: talk_settings_make talk_weight talk_export talk_composite talk_merge
 *   modes: mode_weight mode_export
 *   places: range_export nearest_of place_of layer_export layer_composite
 *   front: front_export front_composite
 *   wavelet: wavelet_insert wavelet_transmittance
 *   moments: moments_insert moments_transmittance
 *   images: describe_targets bytes_per_pixel pass_count memory_size image_init clear_rows
 *       blend_rows merge_rows composite_rows
 * >>end */
#ifndef HDRP_OIT_H
#define HDRP_OIT_H

#include "hdrp_pack.h"

#if HDRP_VERSION != 100
#error "hdrp_oit.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* >>fragments */

#define HDRP_OIT_LIGHT_MAX   65504.0f /* largest half float: colours are limited to it */
#define HDRP_OIT_PRODUCT_MAX 2047.0f  /* of a colour and its weight: 32 of them fit a half float */
#define HDRP_OIT_THIN_ALPHA  0.001953125f /* 2^-9: below it colours are added as emission is */
#define HDRP_OIT_DEPTH_MIN   1e-6f        /* m */
#define HDRP_OIT_DEPTH_MAX   1e6f         /* m; infinity counts as it */

/* What a surface does to a pixel. Made by hdrp_oit_fragment_make. */
struct hdrp_oit_fragment {
    hdrp_v3 premultiplied; /* colour times alpha, without emission */
    hdrp_v3 emission;      /* added, whatever alpha is */
    float alpha;           /* [0,1] how much of what is behind it hides */
    float z_view;          /* m */
};
HDRP_TYPEDEF(hdrp_oit_fragment)

/* What a fragment shader writes, and what the pixel then holds. */
struct hdrp_oit_targets {
    hdrp_v4 accum; /* colours times weights, and their normalisation: added */
    hdrp_v4 light; /* rgb emission: added; w alpha: the target multiplies 1 - alpha */
};
HDRP_TYPEDEF(hdrp_oit_targets)

/* Light that is finite and not negative. */
HDRP_FN hdrp_v3 hdrp_i_oit_light(hdrp_v3 v)
{
    return hdrp_v3_make(hdrp_clamp(v.x, 0.0f, HDRP_OIT_LIGHT_MAX),
                        hdrp_clamp(v.y, 0.0f, HDRP_OIT_LIGHT_MAX),
                        hdrp_clamp(v.z, 0.0f, HDRP_OIT_LIGHT_MAX));
}

/** A fragment from what shading gives.
 *  premultiplied  any    colour times alpha, without emission
 *  emission       any    what is added whatever alpha is
 *  alpha          any    how much of what is behind is hidden; limited to [0,1]
 *  z_view         any    m in front of the camera
 *  returns        valid
 *  edges          negative light and NaN count as 0, light above HDRP_OIT_LIGHT_MAX as that; depths
 *                 are limited to [HDRP_OIT_DEPTH_MIN,HDRP_OIT_DEPTH_MAX], NaN is the nearest; a
 *                 colour without alpha is emission
 *  error          none: a selection
 *  source         a definition */
HDRP_FN hdrp_oit_fragment hdrp_oit_fragment_make(hdrp_v3 premultiplied, hdrp_v3 emission,
                                                 float alpha, float z_view)
{
    hdrp_oit_fragment f;
    hdrp_v3 color = hdrp_i_oit_light(premultiplied);
    hdrp_v3 added = hdrp_i_oit_light(emission);
    f.alpha = hdrp_saturate(alpha);
    f.z_view = hdrp_clamp(z_view, HDRP_OIT_DEPTH_MIN, HDRP_OIT_DEPTH_MAX);
    f.premultiplied = hdrp_v3_scale(color, f.alpha > 0.0f ? 1.0f : 0.0f);
    f.emission = hdrp_i_oit_light(hdrp_v3_mad(added, color, f.alpha > 0.0f ? 0.0f : 1.0f));
    return f;
}

/* What brings the larger of two numbers down to HDRP_OIT_PRODUCT_MAX. */
HDRP_FN float hdrp_i_oit_limit(float x, float y)
{
    return HDRP_OIT_PRODUCT_MAX / hdrp_max(hdrp_max(x, y), HDRP_OIT_PRODUCT_MAX);
}

/* The caller's scale, within a range where nothing overflows. */
HDRP_FN float hdrp_i_oit_scale(float scale)
{
    return hdrp_clamp(scale, 9.5367431640625e-7f, 1048576.0f); /* 2^-20 to 2^20 */
}

/* >>published weights
 * With hdrp_oit_weighted_export. Their authors' alpha is part of them. */

/* alpha * clamp(x, 0.01, 3000), the form of equations 7 to 10. */
HDRP_FN float hdrp_i_oit_published(float x, float alpha)
{
    return hdrp_saturate(alpha) * hdrp_clamp(x, 1e-2f, 3e3f);
}

/** Weight for scenes up to some 500 m, with much depth complexity near the camera.
 *  z_view   any      m
 *  alpha    any      limited to [0,1]
 *  returns  [0,3000] 0 where alpha is
 *  edges    depth is limited to [0,HDRP_OIT_DEPTH_MAX]; NaN counts as 0
 *  error    <= 5e-7 relative  @accuracy oit_weight_eq7
 *  source   McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency", eq. 7 */
HDRP_FN float hdrp_oit_weight_eq7(float z_view, float alpha)
{
    float z = hdrp_clamp(z_view, 0.0f, HDRP_OIT_DEPTH_MAX);
    float a = z * 0.2f;
    float b = z * 0.005f;
    float b3 = b * b * b;
    return hdrp_i_oit_published(10.0f / (1e-5f + a * a + b3 * b3), alpha);
}

/** Weight that falls later than that of eq. 7.
 *  z_view   any      m
 *  alpha    any      limited to [0,1]
 *  returns  [0,3000] 0 where alpha is
 *  edges    as hdrp_oit_weight_eq7
 *  error    <= 6e-7 relative  @accuracy oit_weight_eq8
 *  source   McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency", eq. 8 */
HDRP_FN float hdrp_oit_weight_eq8(float z_view, float alpha)
{
    float z = hdrp_clamp(z_view, 0.0f, HDRP_OIT_DEPTH_MAX);
    float a = z * 0.1f;
    float b = z * 0.005f;
    float b3 = b * b * b;
    return hdrp_i_oit_published(10.0f / (1e-5f + a * a * a + b3 * b3), alpha);
}

/** Weight that falls with the fourth power of depth.
 *  z_view   any      m
 *  alpha    any      limited to [0,1]
 *  returns  [0,3000] 0 where alpha is
 *  edges    as hdrp_oit_weight_eq7
 *  error    <= 6e-7 relative  @accuracy oit_weight_eq9
 *  source   McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency", eq. 9 */
HDRP_FN float hdrp_oit_weight_eq9(float z_view, float alpha)
{
    float b = hdrp_clamp(z_view, 0.0f, HDRP_OIT_DEPTH_MAX) * 0.005f;
    float b2 = b * b;
    return hdrp_i_oit_published(0.03f / (1e-5f + b2 * b2), alpha);
}

/** Weight by device depth.
 *  device_depth  any      0 at the near plane, 1 at the far one: a reversed depth is 1 - it
 *  alpha         any      limited to [0,1]
 *  returns       [0,3000] 0 where alpha is
 *  edges         depth is limited to [0,1]; NaN counts as 0
 *  error         <= 6e-7 relative  @accuracy oit_weight_eq10
 *  source        McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency",
 *                eq. 10 */
HDRP_FN float hdrp_oit_weight_eq10(float device_depth, float alpha)
{
    float b = 1.0f - hdrp_saturate(device_depth);
    return hdrp_i_oit_published(3e3f * (b * b * b), alpha);
}

/** Weight that also tells thin fragments from dense ones.
 *  device_depth  any      0 at the near plane, 1 at the far one
 *  alpha         any      limited to [0,1]
 *  returns       [0,3000] 0 where alpha is, else at least 0.01
 *  edges         depth is limited to [0,1]; NaN counts as 0
 *  error         <= 2e-6 relative  @accuracy oit_weight_2015
 *  source        McGuire 2015, "Implementing Weighted, Blended Order-Independent Transparency"
 *  note          its author's 0.01 that a fragment without alpha keeps is 0 here, so that what is
 *                not there has no influence */
HDRP_FN float hdrp_oit_weight_2015(float device_depth, float alpha)
{
    float covered = hdrp_saturate(alpha);
    float a = hdrp_min(1.0f, covered * 10.0f) + 0.01f;
    float b = 1.0f - 0.9f * hdrp_saturate(device_depth);
    float w = hdrp_clamp(a * a * a * 1e8f * (b * b * b), 1e-2f, 3e3f);
    return covered > 0.0f ? w : 0.0f;
}

/* >>recommended */

/** The recommended weight: about how much of a fragment is seen beside others.
 *  z_view   any    m
 *  alpha    any    limited to [0,1]
 *  returns  [9.765625e-4,16] from 2^-10
 *  edges    depth is limited to [HDRP_OIT_DEPTH_MIN,HDRP_OIT_DEPTH_MAX]; NaN counts as the least
 *  error    <= 4e-6 relative  @accuracy oit_weight
 *  source   own fit by tools/fit_oit.py
 *  note     a power of depth, so that units matter little: hardly any for thin fragments, whose
 *           order matters little, up to the -2nd for dense ones. Thin ones weigh little, or soft
 *           edges before something dense would take its colour */
HDRP_FN float hdrp_oit_weight(float z_view, float alpha)
{
    float a = hdrp_saturate(alpha);
    float x = hdrp_log2(hdrp_clamp(z_view, HDRP_OIT_DEPTH_MIN, HDRP_OIT_DEPTH_MAX));
    float a2 = a * a;
    float a4 = a2 * a2;
    float root = hdrp_sqrt(a);
    float level = -7.2936f - 1.4768f * root - 0.7362f * a + 19.4126f * a2 - 9.3971f * a4;
    float slope = 0.48f - 1.3173f * root + 1.3864f * a + 2.3104f * a2 - 0.889f * (a4 * a4);
    return hdrp_exp2(hdrp_clamp(level - slope * x, -10.0f, 4.0f));
}

/* One over the mean transmittance over the depth of what absorbs evenly and lets r through:
 * -ln r / (1 - r). */
HDRP_FN float hdrp_i_oit_dimming(float r)
{
    float limited = hdrp_clamp(r, 1.52587890625e-5f, 1.0f);
    float d = 1.0f - limited;
    float near_1 = 1.0f + d * (0.5f + d * (0.333333333f + d * (0.25f + d * 0.2f)));
    float far_from_1 = -0.69314718f * hdrp_log2(hdrp_min(limited, 0.9f)) / hdrp_max(d, 0.1f);
    return d < 0.1f ? near_1 : far_from_1;
}

/* What is too thin for the rounding of revealage adds its colour as emission. */
HDRP_FN hdrp_oit_fragment hdrp_i_oit_thin(hdrp_oit_fragment f)
{
    hdrp_oit_fragment t = f;
    float thin = f.alpha < HDRP_OIT_THIN_ALPHA ? 1.0f : 0.0f;
    t.premultiplied = hdrp_v3_scale(f.premultiplied, 1.0f - thin);
    t.emission = hdrp_v3_mad(f.emission, f.premultiplied, thin);
    return t;
}

/* Emission of what covers goes with its colour, which has a weight of depth, in a share that rises
 * with alpha: seen as all emission is, that of a dense layer would have the wrong depth; divided by
 * sums of alpha, that of a thin one would be what the others are multiplied by. */
HDRP_FN hdrp_oit_fragment hdrp_i_oit_shared(hdrp_oit_fragment f)
{
    hdrp_oit_fragment t = hdrp_i_oit_thin(f);
    float b = 1.0f - f.alpha;
    float apart = b * b * (b * b);
    float with_color = f.alpha < HDRP_OIT_THIN_ALPHA ? 0.0f : 1.0f - apart;
    t.premultiplied = hdrp_v3_mad(t.premultiplied, t.emission, with_color);
    t.emission = hdrp_v3_scale(t.emission, 1.0f - with_color);
    return t;
}

/* Colour and emission, each by how much of it is seen. */
HDRP_FN hdrp_oit_targets hdrp_i_oit_added(hdrp_oit_fragment f, float weight, float seen,
                                          float scale)
{
    hdrp_oit_targets t;
    float w = hdrp_clamp(weight, 0.0f, 3000.0f);
    float s = hdrp_i_oit_scale(scale);
    hdrp_v3 emission = hdrp_v3_scale(f.emission, s * seen);
    /* A weight that goes down with its colour leaves the colour of the fragment what it is. */
    w *= hdrp_i_oit_limit(hdrp_v3_max_component(f.premultiplied) * (w * s), f.alpha * w);
    t.accum = hdrp_v4_from_v3(hdrp_v3_scale(f.premultiplied, w * s), f.alpha * w);
    emission = hdrp_v3_scale(emission, hdrp_i_oit_limit(hdrp_v3_max_component(emission), 0.0f));
    t.light = hdrp_v4_from_v3(emission, f.alpha);
    return t;
}

/** What a fragment adds to the targets with any weight.
 *  f        valid
 *  weight   any    limited to [0,3000]
 *  scale    any    power of 2 that colours are multiplied by; limited to [2^-20,2^20]
 *  returns  valid
 *  edges    where a product is above HDRP_OIT_PRODUCT_MAX the weight is less, so that the fragment
 *           keeps its colour; emission above it is limited, with its hue; NaN counts as 0
 *  error    none: a definition
 *  source   McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency", eq. 6, with
 *           emission in a target of its own
 *  note     emission is divided by what hdrp_oit_composite will multiply it by if nothing else
 *           covers. Revealage in a half float does not notice an alpha below 2^-12, nor in 8 bits
 *           one below 2^-9, and a small one is rounded to their steps, with its colour. Sums stop
 *           to grow where a layer adds less than 2^-12 of them */
HDRP_FN hdrp_oit_targets hdrp_oit_weighted_export(hdrp_oit_fragment f, float weight, float scale)
{
    return hdrp_i_oit_added(f, weight, hdrp_i_oit_dimming(1.0f - f.alpha), scale);
}

/** What a fragment adds to the targets: the recommended single pass.
 *  f        valid
 *  scale    any    power of 2 that colours are multiplied by; limited to [2^-20,2^20]
 *  returns  valid
 *  edges    as hdrp_oit_weighted_export
 *  error    none: hdrp_oit_weighted_export of hdrp_oit_weight, with light moved between sums
 *  source   McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency", eq. 6, with
 *           an own weight and emission in a target of its own
 *  note     the defects of the talk's form are gone: sums are divided by those of alpha times
 *           weight, so that n equal layers cover as n layers do; emission has a float target, so
 *           that there may be more than eight additive layers; products are small enough for 32
 *           fragments. A share of 1 - (1 - alpha)^4 of emission goes with the colour, and below
 *           HDRP_OIT_THIN_ALPHA all of the colour with emission */
HDRP_FN hdrp_oit_targets hdrp_oit_export(hdrp_oit_fragment f, float scale)
{
    return hdrp_oit_weighted_export(hdrp_i_oit_shared(f), hdrp_oit_weight(f.z_view, f.alpha),
                                    scale);
}

/* Mean colour of what covers, what was added, and what shines through. */
HDRP_FN hdrp_v3 hdrp_i_oit_composite(hdrp_oit_targets t, hdrp_v3 behind, float scale, float lit)
{
    float revealage = hdrp_saturate(t.light.w);
    float inverse = 1.0f / hdrp_i_oit_scale(scale);
    hdrp_v3 sum = hdrp_i_oit_light(hdrp_v3_from_v4(t.accum));
    hdrp_v3 added = hdrp_i_oit_light(hdrp_v3_from_v4(t.light));
    float weights = hdrp_clamp(t.accum.w, 1e-8f, HDRP_OIT_LIGHT_MAX);
    hdrp_v3 through = hdrp_v3_scale(behind, revealage);
    hdrp_v3 covered = hdrp_v3_mad(through, sum, (1.0f - revealage) / weights * inverse);
    return hdrp_v3_mad(covered, added, lit * inverse);
}

/** Colour of a pixel of weighted sums.
 *  t        any    what its targets hold
 *  behind   any    colour of what is opaque
 *  scale    any    as for the export
 *  returns  any    finite where behind is
 *  edges    sums that are infinite count as HDRP_OIT_LIGHT_MAX, negative ones and NaN as 0; without
 *           fragments behind, exactly
 *  error    none: a definition
 *  source   McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency", eq. 6
 *  note     the depth of emission is unknown: it is seen through (1 - r) / -ln r, the mean over the
 *           depth of what absorbs evenly and leaves a revealage of r, at least 2^-16 */
HDRP_FN hdrp_v3 hdrp_oit_composite(hdrp_oit_targets t, hdrp_v3 behind, float scale)
{
    return hdrp_i_oit_composite(t, behind, scale, 1.0f / hdrp_i_oit_dimming(t.light.w));
}

/** The sums of two layers of different resolution, or of two streams of fragments.
 *  a        any    what targets hold
 *  b        any    what targets of another layer hold at the place, filtered
 *  returns  any    what one layer would hold
 *  edges    none
 *  error    none: a definition
 *  source   Kircher 2018, "Rendering Technology in Agents of Mayhem", composite shader in
 *           the appendix */
HDRP_FN hdrp_oit_targets hdrp_oit_merge(hdrp_oit_targets a, hdrp_oit_targets b)
{
    hdrp_oit_targets t;
    t.accum = hdrp_v4_make(a.accum.x + b.accum.x, a.accum.y + b.accum.y, a.accum.z + b.accum.z,
                           a.accum.w + b.accum.w);
    t.light = hdrp_v4_make(a.light.x + b.light.x, a.light.y + b.light.y, a.light.z + b.light.z,
                           a.light.w * b.light.w);
    return t;
}

/* >>talk
 * Weighted sums with additiveness as Kircher showed them in 2018 (Agents of Mayhem), for comparison
 * and for content that was tuned for them. Known to be wrong: n equal layers that do not emit keep
 * the brightness of one (alpha 0.3, n = 4: 0.30 where 0.76 is right), as sums are divided by sums
 * of weights without alpha; 1000 * 20 for each fragment overflows a half float at the fourth bright
 * one; additiveness has steps of 1/32 of a layer and ends at eight. */

/* Choices of artists and constants of the shader. Made by hdrp_oit_talk_settings_make. */
struct hdrp_oit_talk_settings {
    float exposure;             /* what emission is multiplied by before it is compared with 1 */
    float emissive_sensitivity; /* [1,100] 1 / feather start */
    float near_m, far_m;        /* of the canonical depth */
    float opacity_sensitivity;
    float bias, precision_scale, weight_max, color_max, additive_sensitivity;
};
HDRP_TYPEDEF(hdrp_oit_talk_settings)

/** The talk's constants.
 *  feather   any    artists' feather start; limited to [0.01,1]: small for dim holograms, large
 *                   against dark halos where feathered emission overlaps
 *  exposure  any    of the camera; limited to [0,1e9]
 *  returns   valid
 *  edges     NaN counts as the least
 *  error     none: a definition
 *  source    Kircher 2018, "Rendering Technology in Agents of Mayhem", shader in the appendix */
HDRP_FN hdrp_oit_talk_settings hdrp_oit_talk_settings_make(float feather, float exposure)
{
    hdrp_oit_talk_settings s;
    s.exposure = hdrp_clamp(exposure, 0.0f, 1e9f);
    s.emissive_sensitivity = 1.0f / hdrp_clamp(feather, 0.01f, 1.0f);
    s.near_m = 0.5f;
    s.far_m = 300.0f;
    s.opacity_sensitivity = 3.0f;
    s.bias = 5.0f;
    s.precision_scale = 10000.0f;
    s.weight_max = 20.0f;
    s.color_max = 1000.0f;
    s.additive_sensitivity = 10.0f;
    return s;
}

/* Luminance of emission as the camera sees it, limited to [0,1] and not. */
HDRP_FN float hdrp_i_oit_talk_emission(hdrp_oit_fragment f, hdrp_oit_talk_settings s)
{
    return hdrp_luminance(f.emission) * s.exposure;
}

/** The talk's weight: canonical depth, bias, limit, then opacity and emission.
 *  f        valid
 *  s        valid
 *  returns  [0,20] 0 for what neither covers nor emits
 *  edges    depths outside of the canonical range count as its ends
 *  error    <= 7e-7 relative with the default settings  @accuracy oit_talk_weight
 *  source   Kircher 2018, "Rendering Technology in Agents of Mayhem", shader in the appendix */
HDRP_FN float hdrp_oit_talk_weight(hdrp_oit_fragment f, hdrp_oit_talk_settings s)
{
    float emission = hdrp_saturate(hdrp_i_oit_talk_emission(f, s)) * s.emissive_sensitivity;
    float a = hdrp_saturate(f.alpha * s.opacity_sensitivity + emission);
    float z = hdrp_clamp(f.z_view, s.near_m, s.far_m);
    /* 1 - F / (F - N) + F N / (z (F - N)), without the difference that cancels. */
    float b = s.near_m * (s.far_m - z) / (z * (s.far_m - s.near_m));
    float w = hdrp_min(s.precision_scale * (b * b * b) + s.bias, s.weight_max);
    return w * (a * a * a);
}

/** What a fragment adds to the talk's targets, RGBA16F and RGBA8.
 *  f        valid
 *  s        valid
 *  returns  valid  light: x alpha, w an eighth of the additiveness
 *  edges    colours are limited to s.color_max
 *  error    none: a definition on hdrp_oit_talk_weight
 *  source   Kircher 2018, "Rendering Technology in Agents of Mayhem", shader in the appendix */
HDRP_FN hdrp_oit_targets hdrp_oit_talk_export(hdrp_oit_fragment f, hdrp_oit_talk_settings s)
{
    hdrp_oit_targets t;
    float w = hdrp_oit_talk_weight(f, s);
    hdrp_v3 c = hdrp_v3_add(f.premultiplied, f.emission);
    float additive = hdrp_saturate(hdrp_i_oit_talk_emission(f, s) * s.additive_sensitivity);
    t.accum = hdrp_v4_make(hdrp_min(c.x, s.color_max) * w, hdrp_min(c.y, s.color_max) * w,
                           hdrp_min(c.z, s.color_max) * w, w);
    t.light = hdrp_v4_make(f.alpha, 0.0f, 0.0f, additive * 0.125f);
    return t;
}

/** Colour of a pixel of the talk's sums.
 *  t        any    what its targets hold: light x revealage, w an eighth of the additiveness
 *  behind   any    colour of what is opaque
 *  returns  any    finite where behind is
 *  edges    where a sum of colours is infinite or above a half float, 100; NaN counts as 0
 *  error    none: a definition
 *  source   Kircher 2018, "Rendering Technology in Agents of Mayhem", shader in the appendix */
HDRP_FN hdrp_v3 hdrp_oit_talk_composite(hdrp_oit_targets t, hdrp_v3 behind)
{
    float revealage = hdrp_saturate(t.light.x);
    float additive = hdrp_saturate(t.light.w) * 8.0f;
    hdrp_v3 sum = hdrp_v3_from_v4(t.accum);
    float overflow = hdrp_v3_max_component(sum) > HDRP_OIT_LIGHT_MAX ? 1.0f : 0.0f;
    float weights = hdrp_clamp(t.accum.w, 1e-5f, HDRP_OIT_LIGHT_MAX);
    float amplified =
        hdrp_lerp(additive * 0.25f, additive, revealage) + hdrp_saturate((1.0f - revealage) * 2.0f);
    hdrp_v3 mean = hdrp_v3_scale(hdrp_i_oit_light(sum), hdrp_max(amplified, 1.0f) / weights);
    return hdrp_v3_mad(hdrp_v3_select(overflow, hdrp_v3_splat(100.0f), mean), behind, revealage);
}

/** The talk's sums of two layers of different resolution.
 *  a        any    what targets hold
 *  b        any    what targets of another layer hold at the place, filtered
 *  returns  any    what one layer would hold
 *  edges    none
 *  error    none: a definition
 *  source   Kircher 2018, "Rendering Technology in Agents of Mayhem", composite shader in
 *           the appendix */
HDRP_FN hdrp_oit_targets hdrp_oit_talk_merge(hdrp_oit_targets a, hdrp_oit_targets b)
{
    hdrp_oit_targets t = hdrp_oit_merge(a, b);
    t.light = hdrp_v4_make(a.light.x * b.light.x, 0.0f, 0.0f, a.light.w + b.light.w);
    return t;
}

/* >>modes */

#define HDRP_OIT_MODE_RECOMMENDED 0u /* one pass: hdrp_oit_export */
#define HDRP_OIT_MODE_FRONT       1u /* two passes, the first writes depth: hdrp_oit_front_export */
#define HDRP_OIT_MODE_WAVELET     2u /* three passes: best where depths are spread */
#define HDRP_OIT_MODE_MOMENTS_6   3u /* three passes: best behind a layer far before the others */
#define HDRP_OIT_MODE_MOMENTS_4   4u /* three passes */
#define HDRP_OIT_MODE_EQ7         5u /* one pass with published weights, emission apart */
#define HDRP_OIT_MODE_EQ8         6u
#define HDRP_OIT_MODE_EQ9         7u
#define HDRP_OIT_MODE_EQ10        8u
#define HDRP_OIT_MODE_2015        9u
#define HDRP_OIT_MODE_TALK_WEIGHT 10u /* that of the talk, divided as in eq. 6, emission apart */
#define HDRP_OIT_MODE_TALK        11u /* as shown */
#define HDRP_OIT_MODE_COUNT       12u

/** The weight of a mode, for hdrp_oit_weighted_export.
 *  mode          any    HDRP_OIT_MODE_...
 *  f             valid
 *  device_depth  any    0 at the near plane, 1 at the far one: read by eq. 10 and 2015 alone
 *  s             valid  read by HDRP_OIT_MODE_TALK_WEIGHT alone
 *  returns       [0,3000]
 *  edges         a mode that has no weight of its own, or does not exist, takes the recommended one
 *  error         none: a selection
 *  source        a definition */
HDRP_FN float hdrp_oit_mode_weight(hdrp_u32 mode, hdrp_oit_fragment f, float device_depth,
                                   hdrp_oit_talk_settings s)
{
    float w;
    if (mode == HDRP_OIT_MODE_EQ7) {
        w = hdrp_oit_weight_eq7(f.z_view, f.alpha);
    } else if (mode == HDRP_OIT_MODE_EQ8) {
        w = hdrp_oit_weight_eq8(f.z_view, f.alpha);
    } else if (mode == HDRP_OIT_MODE_EQ9) {
        w = hdrp_oit_weight_eq9(f.z_view, f.alpha);
    } else if (mode == HDRP_OIT_MODE_EQ10) {
        w = hdrp_oit_weight_eq10(device_depth, f.alpha);
    } else if (mode == HDRP_OIT_MODE_2015) {
        w = hdrp_oit_weight_2015(device_depth, f.alpha);
    } else if (mode == HDRP_OIT_MODE_TALK_WEIGHT) {
        w = hdrp_oit_talk_weight(f, s);
    } else {
        w = hdrp_oit_weight(f.z_view, f.alpha);
    }
    return w;
}

/** What a fragment adds to the targets in a mode of one pass, but for HDRP_OIT_MODE_TALK.
 *  mode          any    HDRP_OIT_MODE_...
 *  f             valid
 *  device_depth  any    as for hdrp_oit_mode_weight
 *  s             valid  as for hdrp_oit_mode_weight
 *  scale         any    as for hdrp_oit_export
 *  returns       valid
 *  edges         as hdrp_oit_weighted_export and hdrp_oit_mode_weight
 *  error         none: a selection
 *  source        a definition */
HDRP_FN hdrp_oit_targets hdrp_oit_mode_export(hdrp_u32 mode, hdrp_oit_fragment f,
                                              float device_depth, hdrp_oit_talk_settings s,
                                              float scale)
{
    hdrp_oit_targets t;
    if (mode == HDRP_OIT_MODE_RECOMMENDED) {
        t = hdrp_oit_export(f, scale);
    } else {
        t = hdrp_oit_weighted_export(f, hdrp_oit_mode_weight(mode, f, device_depth, s), scale);
    }
    return t;
}

/* >>places
 * Where a fragment is among those of its pixel. The nearest one is known from the range of depths,
 * so that what it absorbs is kept apart and counted exactly: it matters most. It is the nearest of
 * HDRP_OIT_FRONT_ALPHA or more, as the edge of a sprite is before much and hides nothing. */

#define HDRP_OIT_FRONT_ALPHA 0.1f
#define HDRP_OIT_THINNER     8796093022208.0f   /* 2^43: depths of thinner ones are so much less */
#define HDRP_OIT_NOTHING     8796093022208.0e6f /* depth of what covers nothing: the farthest */

/* Made by hdrp_oit_place_of. */
struct hdrp_oit_place {
    float unit;   /* [0,1] logarithm of depth within the range */
    float behind; /* 1: behind the nearest fragment; 0: at its depth or before it */
    float front;  /* 1: at its depth */
    float beyond; /* 1: behind all that covers */
};
HDRP_TYPEDEF(hdrp_oit_place)

/** What a fragment writes to the target of ranges, which keeps the maximum.
 *  f        valid
 *  returns  [-8.8e18,1e6] x -depth, y depth, m; x times 2^43 below HDRP_OIT_FRONT_ALPHA, so that
 *           they are the nearest where nothing denser is
 *  edges    what covers nothing writes what the target was cleared to: (-HDRP_OIT_NOTHING, 0)
 *  error    none: a selection
 *  source   a definition */
HDRP_FN hdrp_v2 hdrp_oit_range_export(hdrp_oit_fragment f)
{
    float nearest = f.alpha < HDRP_OIT_FRONT_ALPHA ? f.z_view * HDRP_OIT_THINNER : f.z_view;
    return hdrp_v2_make(f.alpha > 0.0f ? -nearest : -HDRP_OIT_NOTHING,
                        f.alpha > 0.0f ? f.z_view : 0.0f);
}

/** The depth of the nearest fragment.
 *  range    any    what the target of ranges holds; y is not looked at
 *  returns  [1e-6,1e6] m
 *  edges    nothing that covers: HDRP_OIT_DEPTH_MAX; NaN: HDRP_OIT_DEPTH_MIN
 *  error    none: a selection
 *  source   a definition */
HDRP_FN float hdrp_oit_nearest_of(hdrp_v2 range)
{
    float m = -range.x;
    float depth = m > HDRP_OIT_DEPTH_MAX ? m * (1.0f / HDRP_OIT_THINNER) : m;
    return hdrp_clamp(depth, HDRP_OIT_DEPTH_MIN, HDRP_OIT_DEPTH_MAX);
}

/** The place of a fragment.
 *  f        valid
 *  range    any    what the target of ranges holds
 *  returns  valid
 *  edges    one depth only, or none: unit is 0
 *  error    <= 1.2e-5 absolute where depths differ by a hundredth or more  @accuracy oit_place
 *  source   a definition
 *  note     both passes must find the same depth: compute it alike ("invariant" in GLSL) */
HDRP_FN hdrp_oit_place hdrp_oit_place_of(hdrp_oit_fragment f, hdrp_v2 range)
{
    hdrp_oit_place p;
    float nearest = hdrp_oit_nearest_of(range);
    float farthest = hdrp_clamp(range.y, nearest, HDRP_OIT_DEPTH_MAX);
    float extent = hdrp_log2(farthest / nearest);
    float at = hdrp_log2(hdrp_clamp(f.z_view, nearest, farthest) / nearest);
    p.unit = hdrp_saturate(at / hdrp_max(extent, 1e-6f));
    p.behind = f.z_view > nearest ? 1.0f : 0.0f;
    p.front = f.z_view == nearest ? 1.0f : 0.0f;
    p.beyond = f.z_view > farthest ? 1.0f : 0.0f;
    return p;
}

/* -ln(1 - alpha), at most 16 ln 2. */
HDRP_FN float hdrp_i_oit_absorbed(float alpha)
{
    return -0.69314718f * hdrp_log2(hdrp_clamp(1.0f - alpha, 1.52587890625e-5f, 1.0f));
}

/* e to the power -x for a sum that a target holds. */
HDRP_FN float hdrp_i_oit_through(float x)
{
    return hdrp_saturate(hdrp_exp2(-1.44269504f * hdrp_clamp(x, 0.0f, 100.0f)));
}

/* What is seen, in the mean, through something that absorbs x and is before the fragment with a
 * chance. The exponential of the mean would be much less where it is dense: nothing of layers of
 * which each is before the others half of the time. */
HDRP_FN float hdrp_i_oit_perhaps_through(float x, float chance)
{
    return 1.0f - chance * (1.0f - hdrp_i_oit_through(x));
}

/* What is seen through the nearest fragment and thinner ones before it, whose sum is front. Of a
 * fragment at the nearest depth the others of that sum are thinner ones, which are before it, or
 * share its depth, and are before it half of the time. Which they are is not known: three quarters
 * of the time. */
HDRP_FN float hdrp_i_oit_front(float front, float own, hdrp_oit_place p)
{
    /* A half float of the sum may be 2^-11 more than what the fragment itself absorbs. */
    float x = p.behind > 0.0f ? front : front * 0.9990234375f - own;
    return hdrp_i_oit_perhaps_through(x, p.behind > 0.0f ? 1.0f : 0.75f * p.front);
}

/* What is seen through the fragments behind the nearest, by where the fragment is. */
HDRP_FN float hdrp_i_oit_tail(float within, float all, hdrp_oit_place p)
{
    float through = p.beyond > 0.0f ? hdrp_i_oit_through(all) : within;
    return p.behind > 0.0f ? through : 1.0f;
}

/** What a fragment adds to the targets where it is seen through a known transmittance.
 *  f        valid
 *  through  any    [0,1] how much of it is seen
 *  scale    any    as for hdrp_oit_export
 *  returns  valid
 *  edges    as hdrp_oit_weighted_export: a colour times scale above HDRP_OIT_PRODUCT_MAX counts
 *           less beside others, so that scale is for scenes whose layers are that bright; below
 *           HDRP_OIT_THIN_ALPHA colour is added as emission is
 *  error    none: a definition
 *  source   Muenstermann et al. 2018, "Moment-Based Order-Independent Transparency", section on
 *           compositing, with emission in a target of its own */
HDRP_FN hdrp_oit_targets hdrp_oit_layer_export(hdrp_oit_fragment f, float through, float scale)
{
    float seen = hdrp_saturate(through);
    return hdrp_i_oit_added(hdrp_i_oit_thin(f), seen, seen, scale);
}

/** Colour of a pixel whose fragments were seen through a known transmittance.
 *  t        any    what its targets hold
 *  behind   any    colour of what is opaque
 *  scale    any    as for the export
 *  returns  any    finite where behind is
 *  edges    as hdrp_oit_composite
 *  error    none: a definition
 *  source   Muenstermann et al. 2018, "Moment-Based Order-Independent Transparency", section on
 *           compositing: normalised, so that errors of transmittance change no coverage */
HDRP_FN hdrp_v3 hdrp_oit_layer_composite(hdrp_oit_targets t, hdrp_v3 behind, float scale)
{
    return hdrp_i_oit_composite(t, behind, scale, 1.0f);
}

/* >>front
 * The nearest fragment exactly, the rest as in the recommended mode: two passes, of which the first
 * writes depth only. */

/* What a fragment shader writes, and what the pixel then holds. */
struct hdrp_oit_front_targets {
    hdrp_v4 front; /* the nearest fragment and what is before it, w its alpha: added */
    hdrp_v4 accum; /* the others, as in hdrp_oit_targets */
    hdrp_v4 light;
};
HDRP_TYPEDEF(hdrp_oit_front_targets)

/** What a fragment adds to the targets where the nearest one is kept apart.
 *  f          valid
 *  nearest_m  any    hdrp_oit_nearest_of what the target of ranges holds
 *  scale      any    as for hdrp_oit_export
 *  returns    valid
 *  edges      what is before the nearest depth counts as at it; NaN: nothing is nearest; colours
 *             times scale of the nearest are limited to HDRP_OIT_PRODUCT_MAX, with their hue
 *  error      none: a selection of hdrp_oit_export
 *  source     own: one exact layer and a weighted tail
 *  note       fragments at exactly the nearest depth are added up */
HDRP_FN hdrp_oit_front_targets hdrp_oit_front_export(hdrp_oit_fragment f, float nearest_m,
                                                     float scale)
{
    hdrp_oit_front_targets t;
    float is_front = f.z_view <= nearest_m ? 1.0f : 0.0f;
    float s = hdrp_i_oit_scale(scale) * is_front;
    hdrp_v3 color = hdrp_v3_scale(hdrp_v3_add(f.premultiplied, f.emission), s);
    float limit = hdrp_i_oit_limit(hdrp_v3_max_component(color), 0.0f);
    hdrp_oit_fragment rest = f;
    hdrp_oit_targets tail;
    rest.alpha = f.alpha * (1.0f - is_front);
    rest.premultiplied = hdrp_v3_scale(f.premultiplied, 1.0f - is_front);
    rest.emission = hdrp_v3_scale(f.emission, 1.0f - is_front);
    tail = hdrp_oit_export(rest, scale);
    t.front = hdrp_v4_from_v3(hdrp_v3_scale(color, limit), f.alpha * is_front);
    t.accum = tail.accum;
    t.light = tail.light;
    return t;
}

/** Colour of a pixel whose nearest fragment was kept apart.
 *  t        any    what its targets hold
 *  behind   any    colour of what is opaque
 *  scale    any    as for the export
 *  returns  any    finite where behind is
 *  edges    as hdrp_oit_composite; coverage that adds up to more than 1 is brought back to it, and
 *           its colours with it
 *  error    none: a definition on hdrp_oit_composite
 *  source   Porter and Duff 1984, "Compositing Digital Images", over */
HDRP_FN hdrp_v3 hdrp_oit_front_composite(hdrp_oit_front_targets t, hdrp_v3 behind, float scale)
{
    hdrp_oit_targets tail;
    float covered = hdrp_clamp(t.front.w, 0.0f, HDRP_OIT_LIGHT_MAX);
    float share = 1.0f / (hdrp_i_oit_scale(scale) * hdrp_max(covered, 1.0f));
    hdrp_v3 front = hdrp_v3_scale(hdrp_i_oit_light(hdrp_v3_from_v4(t.front)), share);
    tail.accum = t.accum;
    tail.light = t.light;
    return hdrp_v3_mad(front, hdrp_oit_composite(tail, behind, scale),
                       1.0f - hdrp_min(covered, 1.0f));
}

/* >>wavelet
 * What is absorbed up to a depth, in Haar wavelets of four levels, written as sums of the left
 * halves: no coefficient is negative, and half floats suffice. */

/* Of 16 intervals: the farthest fragment is in the middle of the last. */
#define HDRP_OIT_WAVELET_SPAN 15.5f

/* Additive targets: four RGBA16F and an R16F. */
struct hdrp_oit_wavelet {
    hdrp_v4 coarse; /* x all, y first half, z first quarter, w third quarter */
    hdrp_v4 eighths;
    hdrp_v4 finest_low, finest_high; /* every second sixteenth of the first and the second half */
    float front; /* the nearest fragment and thinner ones before it, in none of the others */
};
HDRP_TYPEDEF(hdrp_oit_wavelet)

/* A value in one of four components. */
HDRP_FN hdrp_v4 hdrp_i_oit_in(hdrp_u32 index, float value)
{
    return hdrp_v4_make(index == 0u ? value : 0.0f, index == 1u ? value : 0.0f,
                        index == 2u ? value : 0.0f, index == 3u ? value : 0.0f);
}

HDRP_FN float hdrp_i_oit_of(hdrp_v4 v, hdrp_u32 index)
{
    float low = index == 0u ? v.x : v.y;
    float high = index == 2u ? v.z : v.w;
    return index < 2u ? low : high;
}

HDRP_FN hdrp_u32 hdrp_i_oit_bin(float unit)
{
    hdrp_u32 bin = hdrp_u32_from_f32(hdrp_saturate(unit) * HDRP_OIT_WAVELET_SPAN);
    return bin < 15u ? bin : 15u;
}

/** What a fragment adds to the wavelet targets.
 *  f        valid
 *  place    valid
 *  returns  valid
 *  edges    alpha above 1 - 2^-16 absorbs as that does
 *  error    none: hdrp_oit_wavelet_transmittance states it
 *  source   Aizenshtein et al. 2022, "Wavelet Transparency": Haar, rank 3, here by sums of the left
 *           halves and with the nearest fragment apart */
HDRP_FN hdrp_oit_wavelet hdrp_oit_wavelet_insert(hdrp_oit_fragment f, hdrp_oit_place place)
{
    hdrp_oit_wavelet w;
    float absorbed = hdrp_i_oit_absorbed(f.alpha);
    float tail = place.behind > 0.0f ? absorbed : 0.0f;
    hdrp_u32 bin = hdrp_i_oit_bin(place.unit);
    hdrp_v4 quarters = hdrp_i_oit_in(bin >> 3u, (bin & 4u) == 0u ? tail : 0.0f);
    hdrp_v4 finest = hdrp_i_oit_in((bin >> 1u) & 3u, (bin & 1u) == 0u ? tail : 0.0f);
    w.coarse = hdrp_v4_make(tail, bin < 8u ? tail : 0.0f, quarters.x, quarters.y);
    w.eighths = hdrp_i_oit_in(bin >> 2u, (bin & 2u) == 0u ? tail : 0.0f);
    w.finest_low = hdrp_v4_make(bin < 8u ? finest.x : 0.0f, bin < 8u ? finest.y : 0.0f,
                                bin < 8u ? finest.z : 0.0f, bin < 8u ? finest.w : 0.0f);
    w.finest_high = hdrp_v4_make(bin < 8u ? 0.0f : finest.x, bin < 8u ? 0.0f : finest.y,
                                 bin < 8u ? 0.0f : finest.z, bin < 8u ? 0.0f : finest.w);
    w.front = absorbed - tail;
    return w;
}

/* One level: x what is absorbed before the half, y within it. */
HDRP_FN hdrp_v2 hdrp_i_oit_descend(hdrp_v2 s, float left, hdrp_u32 right)
{
    return hdrp_v2_make(s.x + (right != 0u ? left : 0.0f), right != 0u ? s.y - left : left);
}

/** How much of a fragment is seen, by wavelets.
 *  w        any    what the targets hold, all fragments added
 *  f        valid
 *  place    valid
 *  returns  [0,1]
 *  edges    1 for the nearest fragment, alone at its depth and without thinner ones before it; NaN
 *           counts as nothing that absorbs
 *  error    <= 6e-7 absolute against sums per interval in double  @accuracy oit_wavelet
 *  source   Aizenshtein et al. 2022, "Wavelet Transparency": Haar, rank 3, linear within the finest
 *           intervals, without what the fragment itself absorbs */
HDRP_FN float hdrp_oit_wavelet_transmittance(hdrp_oit_wavelet w, hdrp_oit_fragment f,
                                             hdrp_oit_place place)
{
    hdrp_u32 bin = hdrp_i_oit_bin(place.unit);
    float own = hdrp_i_oit_absorbed(f.alpha);
    float fraction = hdrp_saturate(place.unit * HDRP_OIT_WAVELET_SPAN - hdrp_f32_from_u32(bin));
    float quarter = bin < 8u ? w.coarse.z : w.coarse.w;
    hdrp_u32 pair = (bin >> 1u) & 3u;
    float finest =
        bin < 8u ? hdrp_i_oit_of(w.finest_low, pair) : hdrp_i_oit_of(w.finest_high, pair);
    hdrp_v2 s = hdrp_i_oit_descend(hdrp_v2_make(0.0f, w.coarse.x), w.coarse.y, bin & 8u);
    float tail;
    s = hdrp_i_oit_descend(s, quarter, bin & 4u);
    s = hdrp_i_oit_descend(s, hdrp_i_oit_of(w.eighths, bin >> 2u), bin & 2u);
    s = hdrp_i_oit_descend(s, finest, bin & 1u);
    tail = hdrp_i_oit_through(s.x) * hdrp_i_oit_perhaps_through(s.y - own, fraction);
    return hdrp_i_oit_front(w.front, own, place) * hdrp_i_oit_tail(tail, w.coarse.x, place);
}

/* >>moments
 * What is absorbed up to a depth, from power moments of it: the least that any distribution with
 * these moments allows, and what it then has at that depth half of the time. */

/* Additive targets. Four moments need power and high.zw, six all of it; 32-bit floats. */
struct hdrp_oit_moments {
    hdrp_v4 power; /* first to fourth moment times what is absorbed */
    hdrp_v4 high;  /* x fifth, y sixth, z what is absorbed; w the nearest fragment and thinner
        ones before it, in none of the others */
};
HDRP_TYPEDEF(hdrp_oit_moments)

/** What a fragment adds to the targets of moments.
 *  f        valid
 *  place    valid
 *  returns  valid
 *  edges    alpha above 1 - 2^-16 absorbs as that does
 *  error    none: hdrp_oit_moments_transmittance states it
 *  source   Muenstermann et al. 2018, "Moment-Based Order-Independent Transparency", section on
 *           power moments; the nearest fragment apart */
HDRP_FN hdrp_oit_moments hdrp_oit_moments_insert(hdrp_oit_fragment f, hdrp_oit_place place)
{
    hdrp_oit_moments m;
    float absorbed = hdrp_i_oit_absorbed(f.alpha);
    float tail = place.behind > 0.0f ? absorbed : 0.0f;
    float x = 2.0f * place.unit - 1.0f;
    float x2 = x * x;
    float x3 = x2 * x;
    m.power = hdrp_v4_make(tail * x, tail * x2, tail * x3, tail * (x2 * x2));
    m.high = hdrp_v4_make(tail * (x2 * x3), tail * (x3 * x3), tail, absorbed - tail);
    return m;
}

/* a / b where b may be 0. */
HDRP_FN float hdrp_i_oit_ratio(float a, float b)
{
    float magnitude = hdrp_max(hdrp_abs(b), 1e-20f);
    return hdrp_clamp(b < 0.0f ? -a / magnitude : a / magnitude, -1e18f, 1e18f);
}

/* By four moments m, which are biased, x the share that is absorbed before a place and y at it, at
 * most. */
HDRP_FN hdrp_v2 hdrp_i_oit_before_4(hdrp_v4 m, float x)
{
    float l21_d = m.z - m.x * m.y;
    float d1 = hdrp_max(m.y - m.x * m.x, 1e-8f);
    float l21 = l21_d / d1;
    float d2 = hdrp_max(m.w - m.y * m.y - l21_d * l21, 1e-8f);
    float y1 = x - m.x;
    float c2 = (x * x - m.y - l21 * y1) / d2;
    float c1 = y1 / d1 - l21 * c2;
    float c0 = 1.0f - c1 * m.x - c2 * m.y;
    /* Roots of c0 + c1 t + c2 t^2 without the difference that cancels where one is far off. */
    float root = hdrp_sqrt(hdrp_max(c1 * c1 - 4.0f * c0 * c2, 0.0f));
    float q = -0.5f * (c1 + (c1 < 0.0f ? -root : root));
    float r1 = hdrp_i_oit_ratio(q, c2);
    float r2 = hdrp_i_oit_ratio(c0, q);
    float a = hdrp_min(r1, r2);
    float b = hdrp_max(r1, r2);
    float fa = a < x ? 1.0f : 0.0f;
    float fb = b < x ? 1.0f : 0.0f;
    /* Newton's polynomial through 0 at x and the steps at the roots, in its mean. */
    float xa = hdrp_i_oit_ratio(fa, a - x);
    float ab = hdrp_i_oit_ratio(fb - fa, b - a);
    float xab = hdrp_i_oit_ratio(ab - xa, b - x);
    float before = xa * (m.x - x) + xab * (m.y - (x + a) * m.x + x * a);
    return hdrp_v2_make(hdrp_saturate(before), 1.0f / hdrp_max(c0 + x * (c1 + x * c2), 1.0f));
}

/* The roots of c0 + c1 t + c2 t^2 + c3 t^3, three real ones, of which none is far off. */
HDRP_FN hdrp_v3 hdrp_i_oit_near_roots(float c0, float c1, float c2, float c3)
{
    float s = hdrp_i_oit_ratio(c2, c3) * 0.333333333f;
    float q = hdrp_i_oit_ratio(c1, c3) * 0.333333333f;
    float t = hdrp_i_oit_ratio(c0, c3);
    float u = hdrp_clamp(s * s - q, 1e-12f, 1e12f);
    float v = 0.5f * (2.0f * s * s * s - 3.0f * s * q + t);
    float r = hdrp_sqrt(u);
    float cosine = hdrp_clamp(-v / (u * r), -1.0f, 1.0f);
    float angle = hdrp_acos_fast(cosine) * 0.333333333f;
    hdrp_sincos_result e = hdrp_sincos(angle);
    float c = r * e.cosine;
    float d = 1.73205081f * r * e.sine;
    return hdrp_v3_make(-c - d - s, d - c - s, 2.0f * c - s);
}

/* The same roots wherever they are. One that is far off leaves no digits to the others, so that
 * their reciprocals are looked for where c3 is small. */
HDRP_FN hdrp_v3 hdrp_i_oit_cubic(float c0, float c1, float c2, float c3)
{
    float turned = hdrp_abs(c3) < hdrp_abs(c0) ? 1.0f : 0.0f;
    hdrp_v3 r = hdrp_i_oit_near_roots(turned > 0.0f ? c3 : c0, turned > 0.0f ? c2 : c1,
                                      turned > 0.0f ? c1 : c2, turned > 0.0f ? c0 : c3);
    return hdrp_v3_make(turned > 0.0f ? hdrp_i_oit_ratio(1.0f, r.x) : r.x,
                        turned > 0.0f ? hdrp_i_oit_ratio(1.0f, r.y) : r.y,
                        turned > 0.0f ? hdrp_i_oit_ratio(1.0f, r.z) : r.z);
}

/* Newton's polynomial through 0 at x and the steps at three roots, in its mean. */
HDRP_FN float hdrp_i_oit_steps(hdrp_v3 m, float x, hdrp_v3 roots)
{
    float f1 = roots.x < x ? 1.0f : 0.0f;
    float f2 = roots.y < x ? 1.0f : 0.0f;
    float f3 = roots.z < x ? 1.0f : 0.0f;
    float f01 = hdrp_i_oit_ratio(f1, roots.x - x);
    float f12 = hdrp_i_oit_ratio(f2 - f1, roots.y - roots.x);
    float f23 = hdrp_i_oit_ratio(f3 - f2, roots.z - roots.y);
    float f012 = hdrp_i_oit_ratio(f12 - f01, roots.y - x);
    float f123 = hdrp_i_oit_ratio(f23 - f12, roots.z - roots.x);
    float f0123 = hdrp_i_oit_ratio(f123 - f012, roots.z - x);
    float sum = x + roots.x;
    float product = x * roots.x;
    float e2 = m.y - sum * m.x + product;
    float e3 = m.z - (sum + roots.y) * m.y + (product + sum * roots.y) * m.x - product * roots.y;
    return hdrp_saturate(f01 * (m.x - x) + f012 * e2 + f0123 * e3);
}

/* The same by six moments m and h. */
HDRP_FN hdrp_v2 hdrp_i_oit_before_6(hdrp_v4 m, hdrp_v2 h, float x)
{
    float d1 = hdrp_max(m.y - m.x * m.x, 1e-8f);
    float l21_d = m.z - m.x * m.y;
    float l21 = l21_d / d1;
    float d2 = hdrp_max(m.w - m.y * m.y - l21 * l21_d, 1e-8f);
    float l31_d = m.w - m.x * m.z;
    float l31 = l31_d / d1;
    float l32_d = h.x - m.y * m.z - l21 * l31_d;
    float l32 = l32_d / d2;
    float d3 = hdrp_max(h.y - m.z * m.z - l31 * l31_d - l32 * l32_d, 1e-8f);
    float y1 = x - m.x;
    float y2 = x * x - m.y - l21 * y1;
    float y3 = x * x * x - m.z - l31 * y1 - l32 * y2;
    float c3 = y3 / d3;
    float c2 = y2 / d2 - l32 * c3;
    float c1 = y1 / d1 - l21 * c2 - l31 * c3;
    float c0 = 1.0f - m.x * c1 - m.y * c2 - m.z * c3;
    float before =
        hdrp_i_oit_steps(hdrp_v3_make(m.x, m.y, m.z), x, hdrp_i_oit_cubic(c0, c1, c2, c3));
    return hdrp_v2_make(before, 1.0f / hdrp_max(c0 + x * (c1 + x * (c2 + x * c3)), 1.0f));
}

/* Moments between their own and those of a distribution that fills the range. */
HDRP_FN float hdrp_i_oit_biased(float sum, float inverse, float even, float bias)
{
    return hdrp_lerp(hdrp_clamp(sum * inverse, -1.0f, 1.0f), even, bias);
}

/* How much of what is absorbed at a place is the fragment's own, over what it absorbs: the most
 * that moments allow there is seldom reached. Chosen on the pixels of tests/oit. */
#define HDRP_I_OIT_OWN 1.2f

/** How much of a fragment is seen, by moments.
 *  m        any    what the targets hold, all fragments added
 *  f        valid
 *  place    valid
 *  count    any    4 or 6 moments; below 6 counts as 4
 *  returns  [0,1]
 *  edges    1 for the nearest fragment, alone at its depth and without thinner ones before it; NaN
 *           counts as nothing that absorbs
 *  error    none: an estimate; tests/oit measures pixels against sorting
 *  source   Muenstermann et al. 2018, "Moment-Based Order-Independent Transparency", algorithms for
 *           four and six power moments with the bias of 32-bit floats
 *  note     theirs is the exponential of all that is absorbed before the fragment, and of a quarter
 *           of what may be at its depth. Here each half of that, without the fragment's own, is
 *           before it half of the time: the mean of transmittances, not of what is absorbed. The
 *           bias is what they give six moments of 16 bits, and twice what they give four, so that
 *           noise in the last bits of sums counts less than their rounding to half floats: the
 *           order of fragments changes colours up to 0.002 in 32 bits, and 0.004 in 16 */
HDRP_FN float hdrp_oit_moments_transmittance(hdrp_oit_moments m, hdrp_oit_fragment f,
                                             hdrp_oit_place place, hdrp_u32 count)
{
    float six = count < 6u ? 0.0f : 1.0f;
    float bias = six > 0.0f ? 6e-4f : 1.2e-4f;
    float inverse = 1.0f / hdrp_clamp(m.high.z, 1e-6f, 1e6f);
    float x = 2.0f * place.unit - 1.0f;
    float own = hdrp_i_oit_absorbed(f.alpha);
    float all = hdrp_max(m.high.z, 0.0f);
    float even2 = six > 0.0f ? 0.48f : 0.375f;
    float even4 = six > 0.0f ? 0.451f : 0.375f;
    hdrp_v4 b = hdrp_v4_make(hdrp_i_oit_biased(m.power.x, inverse, 0.0f, bias),
                             hdrp_i_oit_biased(m.power.y, inverse, even2, bias),
                             hdrp_i_oit_biased(m.power.z, inverse, 0.0f, bias),
                             hdrp_i_oit_biased(m.power.w, inverse, even4, bias));
    hdrp_v2 h = hdrp_v2_make(hdrp_i_oit_biased(m.high.x, inverse, 0.0f, bias),
                             hdrp_i_oit_biased(m.high.y, inverse, 0.45f, bias));
    hdrp_v2 before = six > 0.0f ? hdrp_i_oit_before_6(b, h, x) : hdrp_i_oit_before_4(b, x);
    /* As if what may be before the fragment were two layers. */
    float half_at = 0.5f * (all * before.y - HDRP_I_OIT_OWN * own);
    float layer = hdrp_i_oit_perhaps_through(half_at, 0.5f);
    float tail = hdrp_i_oit_through(all * before.x) * layer * layer;
    return hdrp_i_oit_front(m.high.w, own, place) * hdrp_i_oit_tail(tail, all, place);
}

/* >>images */
#ifndef HDRP_GPU
#ifdef __cplusplus
extern "C" {
#endif

typedef uint32_t hdrp_oit_mode; /* HDRP_OIT_MODE_... */

typedef enum hdrp_oit_format {
    HDRP_OIT_FORMAT_RGBA32F = 0,
    HDRP_OIT_FORMAT_RG32F,
    HDRP_OIT_FORMAT_R32F,
    HDRP_OIT_FORMAT_RGBA16F,
    HDRP_OIT_FORMAT_R16F,
    HDRP_OIT_FORMAT_R11G11B10F,
    HDRP_OIT_FORMAT_RGBA8,
    HDRP_OIT_FORMAT_R8
} hdrp_oit_format;

/* What the target, or what the fragment writes, is multiplied by before both are added. MAX ignores
 * factors, as graphics interfaces do. */
typedef enum hdrp_oit_blend {
    HDRP_OIT_BLEND_ADD = 0,   /* ONE, ONE */
    HDRP_OIT_BLEND_REVEALAGE, /* ZERO, ONE_MINUS_SRC_COLOR; for alpha ONE_MINUS_SRC_ALPHA */
    HDRP_OIT_BLEND_MAX
} hdrp_oit_blend;

/* Which formats emulation rounds to. */
typedef enum hdrp_oit_precision {
    HDRP_OIT_PRECISION_NATIVE = 0, /* those of hdrp_oit_describe_targets */
    HDRP_OIT_PRECISION_COMPACT,    /* light in R11G11B10F and R8 where it is RGBA16F */
    HDRP_OIT_PRECISION_FLOAT       /* 32-bit floats everywhere: what rounding alone costs */
} hdrp_oit_precision;

#define HDRP_OIT_TARGETS_MAX 9u /* of all passes; at most five in one */

/* A render target: where in the passes it is written, and how. */
typedef struct hdrp_oit_target {
    hdrp_oit_format format;
    hdrp_oit_blend color, alpha; /* of rgb and of alpha */
    uint32_t pass;               /* [0,2] in which it is written; later passes and composite read */
    hdrp_v4 clear;
} hdrp_oit_target;

/* Zeros are defaults. */
typedef struct hdrp_oit_desc {
    uint32_t width_px, height_px;
    hdrp_oit_mode mode;
    hdrp_oit_precision precision;
    float scale;         /* as for hdrp_oit_export; 0: 1 */
    float near_m, far_m; /* of device depths, for eq. 10 and 2015; 0: 0.5 and 300; near < far */
    float feather;       /* of the talk; 0: 1/3 */
    float exposure;      /* of the talk; 0: 1 */
} hdrp_oit_desc;

/* What the targets hold, in memory of the caller. Made by hdrp_oit_image_init. */
typedef struct hdrp_oit_image {
    hdrp_oit_desc desc; /* with defaults filled in */
    hdrp_oit_target targets[HDRP_OIT_TARGETS_MAX];
    uint32_t target_count;
    hdrp_v4* texels; /* one plane for each target */
} hdrp_oit_image;

/** The targets of a mode.
 *  mode       any  HDRP_OIT_MODE_...
 *  precision  any  HDRP_OIT_PRECISION_...
 *  targets    result; HDRP_OIT_TARGETS_MAX of them
 *  returns    how many are used; 0 for a mode or precision that does not exist, with targets
 *             untouched
 *  edges      none */
HDRP_API uint32_t hdrp_oit_describe_targets(hdrp_oit_mode mode, hdrp_oit_precision precision,
                                            hdrp_oit_target* targets);

/** Bytes per pixel of all targets of a mode.
 *  mode       any  HDRP_OIT_MODE_...
 *  precision  any  HDRP_OIT_PRECISION_...
 *  returns    bytes; 0 for a mode or precision that does not exist
 *  edges      none */
HDRP_API uint32_t hdrp_oit_bytes_per_pixel(hdrp_oit_mode mode, hdrp_oit_precision precision);

/** Passes over the fragments of a mode.
 *  mode     any  HDRP_OIT_MODE_...
 *  returns  [0,3] 0 for a mode that does not exist
 *  edges    none */
HDRP_API uint32_t hdrp_oit_pass_count(hdrp_oit_mode mode);

/** Size of the block of an image.
 *  desc     the picture
 *  returns  bytes, a multiple of HDRP_MEMORY_ALIGNMENT
 *  edges    0 for a desc that hdrp_oit_image_init rejects */
HDRP_API size_t hdrp_oit_memory_size(const hdrp_oit_desc* desc);

/** Makes an image whose targets are cleared.
 *  image        result
 *  desc         the picture
 *  memory       block of the caller, aligned to HDRP_MEMORY_ALIGNMENT; it must outlive image
 *  memory_size  bytes of it
 *  returns      HDRP_OK, or an error, with image and memory untouched
 *  errors       HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT, HDRP_ERROR_TOO_LARGE for a size
 *               that size_t cannot count, HDRP_ERROR_MEMORY_TOO_SMALL,
 *               HDRP_ERROR_MEMORY_ALIGNMENT */
HDRP_API hdrp_result hdrp_oit_image_init(hdrp_oit_image* image, const hdrp_oit_desc* desc,
                                         void* memory, size_t memory_size);

/** Clears rows, for the next frame.
 *  image      made by hdrp_oit_image_init
 *  row_begin  any  first row
 *  row_end    any  after the last row; limited to the height
 *  edges      an empty range changes nothing */
HDRP_API void hdrp_oit_clear_rows(hdrp_oit_image* image, uint32_t row_begin, uint32_t row_end);

/** Blends fragments into the targets of a pass.
 *  image      made by hdrp_oit_image_init
 *  pass       any  from 0 on; each after all fragments went through the one before
 *  fragments  made by hdrp_oit_fragment_make, count of them
 *  pixels     row * width_px + column of each; what is outside of the picture is skipped
 *  count      any  of them
 *  row_begin  any  rows whose pixels are blended: others are skipped
 *  row_end    any  after the last row; limited to the height
 *  edges      a pass that the mode does not have changes nothing
 *  range      rows: disjoint ranges may be blended at the same time
 *  note       a pixel blends its fragments in the order of the stream. Results are the same bits
 *             however rows are split, and however the stream is cut into calls that follow each
 *             other */
HDRP_API void hdrp_oit_blend_rows(hdrp_oit_image* image, uint32_t pass,
                                  const hdrp_oit_fragment* fragments, const uint32_t* pixels,
                                  size_t count, uint32_t row_begin, uint32_t row_end);

/** Adds the sums of an image of lower resolution: all targets of the last pass.
 *  image      of the full resolution
 *  low        of the same mode; any size; sampled bilinearly, clamped at its edges
 *  row_begin  any  first row of image
 *  row_end    any  after the last row; limited to the height
 *  returns    HDRP_OK, or an error, with image untouched
 *  errors     HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for another mode, precision or scale
 *  range      rows: disjoint ranges may be added at the same time
 *  note       in modes of several passes both images need all fragments in every pass but the last:
 *             what is nearest and what absorbs hides those of the other resolution too. In the last
 *             pass each gets its own
 *  note       targets are not rounded again: a composite shader adds in registers */
HDRP_API hdrp_result hdrp_oit_merge_rows(hdrp_oit_image* image, const hdrp_oit_image* low,
                                         uint32_t row_begin, uint32_t row_end);

/** Colours of rows of the picture.
 *  image      with all fragments blended
 *  behind     colours of what is opaque, width_px * height_px of them
 *  color      result, as many; may be behind
 *  row_begin  any  first row
 *  row_end    any  after the last row; limited to the height
 *  edges      an empty range changes nothing
 *  range      rows: disjoint ranges may be made at the same time */
HDRP_API void hdrp_oit_composite_rows(const hdrp_oit_image* image, const hdrp_v3* behind,
                                      hdrp_v3* color, uint32_t row_begin, uint32_t row_end);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_OIT_H */

#if defined(HDRP_OIT_IMPLEMENTATION) && !defined(HDRP_OIT_IMPLEMENTED) && !defined(HDRP_GPU)
#define HDRP_OIT_IMPLEMENTED

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- targets --------------------------------------------------------------------------------- */

static int hdrp_i_oit_is_layered(hdrp_oit_mode mode)
{
    return mode >= HDRP_OIT_MODE_WAVELET && mode <= HDRP_OIT_MODE_MOMENTS_4;
}

static int hdrp_i_oit_exists(hdrp_oit_mode mode, hdrp_oit_precision precision)
{
    return mode < HDRP_OIT_MODE_COUNT && (uint32_t)precision <= (uint32_t)HDRP_OIT_PRECISION_FLOAT;
}

static hdrp_oit_target hdrp_i_oit_target(hdrp_oit_format format, hdrp_oit_blend color,
                                         hdrp_oit_blend alpha, uint32_t pass)
{
    hdrp_oit_target t;
    float first = color == HDRP_OIT_BLEND_REVEALAGE ? 1.0f : 0.0f;
    float last = alpha == HDRP_OIT_BLEND_REVEALAGE ? 1.0f : 0.0f;
    t.format = format;
    t.color = color;
    t.alpha = alpha;
    t.pass = pass;
    t.clear = hdrp_v4_make(first, first, first, last);
    if (color == HDRP_OIT_BLEND_MAX) {
        t.clear = hdrp_v4_make(-HDRP_OIT_NOTHING, 0.0f, 0.0f, 0.0f);
    }
    return t;
}

static hdrp_oit_target hdrp_i_oit_sum(hdrp_oit_format format, uint32_t pass)
{
    return hdrp_i_oit_target(format, HDRP_OIT_BLEND_ADD, HDRP_OIT_BLEND_ADD, pass);
}

/* Targets of range and absorption of a mode of three passes. */
static uint32_t hdrp_i_oit_absorbing(hdrp_oit_mode mode, hdrp_oit_target* targets)
{
    uint32_t i;
    targets[0] =
        hdrp_i_oit_target(HDRP_OIT_FORMAT_RG32F, HDRP_OIT_BLEND_MAX, HDRP_OIT_BLEND_MAX, 0u);
    if (mode == HDRP_OIT_MODE_WAVELET) {
        for (i = 1u; i < 5u; ++i) {
            targets[i] = hdrp_i_oit_sum(HDRP_OIT_FORMAT_RGBA16F, 1u);
        }
        targets[5] = hdrp_i_oit_sum(HDRP_OIT_FORMAT_R16F, 1u);
        return 6u;
    }
    targets[1] = hdrp_i_oit_sum(HDRP_OIT_FORMAT_RGBA32F, 1u);
    targets[2] = hdrp_i_oit_sum(
        mode == HDRP_OIT_MODE_MOMENTS_6 ? HDRP_OIT_FORMAT_RGBA32F : HDRP_OIT_FORMAT_RG32F, 1u);
    return 3u;
}

HDRP_API uint32_t hdrp_oit_describe_targets(hdrp_oit_mode mode, hdrp_oit_precision precision,
                                            hdrp_oit_target* targets)
{
    int layered = hdrp_i_oit_is_layered(mode);
    int compact = precision == HDRP_OIT_PRECISION_COMPACT;
    int front = mode == HDRP_OIT_MODE_FRONT;
    uint32_t i, n = 0u, pass = layered ? 2u : front ? 1u : 0u;
    if (!targets || !hdrp_i_oit_exists(mode, precision)) {
        return 0u;
    }
    if (layered) {
        n = hdrp_i_oit_absorbing(mode, targets);
    }
    if (front) {
        targets[n++] =
            hdrp_i_oit_target(HDRP_OIT_FORMAT_R32F, HDRP_OIT_BLEND_MAX, HDRP_OIT_BLEND_MAX, 0u);
        targets[n++] = hdrp_i_oit_sum(HDRP_OIT_FORMAT_RGBA16F, 1u);
    }
    targets[n++] = hdrp_i_oit_sum(HDRP_OIT_FORMAT_RGBA16F, pass);
    if (mode == HDRP_OIT_MODE_TALK) {
        targets[n++] = hdrp_i_oit_target(HDRP_OIT_FORMAT_RGBA8, HDRP_OIT_BLEND_REVEALAGE,
                                         HDRP_OIT_BLEND_ADD, pass);
    } else if (compact) {
        targets[n++] = hdrp_i_oit_sum(HDRP_OIT_FORMAT_R11G11B10F, pass);
        targets[n++] = hdrp_i_oit_target(HDRP_OIT_FORMAT_R8, HDRP_OIT_BLEND_REVEALAGE,
                                         HDRP_OIT_BLEND_REVEALAGE, pass);
    } else {
        targets[n++] = hdrp_i_oit_target(HDRP_OIT_FORMAT_RGBA16F, HDRP_OIT_BLEND_ADD,
                                         HDRP_OIT_BLEND_REVEALAGE, pass);
    }
    for (i = 0u; i < n && precision == HDRP_OIT_PRECISION_FLOAT; ++i) {
        targets[i].format = HDRP_OIT_FORMAT_RGBA32F;
    }
    return n;
}

HDRP_API uint32_t hdrp_oit_bytes_per_pixel(hdrp_oit_mode mode, hdrp_oit_precision precision)
{
    static const uint32_t bytes[8] = {16u, 8u, 4u, 8u, 2u, 4u, 4u, 1u};
    hdrp_oit_target targets[HDRP_OIT_TARGETS_MAX];
    uint32_t i, sum = 0u, n = hdrp_oit_describe_targets(mode, precision, targets);
    for (i = 0u; i < n; ++i) {
        sum += bytes[targets[i].format];
    }
    return sum;
}

HDRP_API uint32_t hdrp_oit_pass_count(hdrp_oit_mode mode)
{
    return !hdrp_i_oit_exists(mode, HDRP_OIT_PRECISION_NATIVE) ? 0u
           : hdrp_i_oit_is_layered(mode)                       ? 3u
           : mode == HDRP_OIT_MODE_FRONT                       ? 2u
                                                               : 1u;
}

/* ---- blending -------------------------------------------------------------------------------- */

static float hdrp_i_oit_half(float x)
{
    return hdrp_pack_float_from_half(hdrp_pack_half_from_float(x));
}

/* What a format stores of a colour. */
static hdrp_v4 hdrp_i_oit_stored(hdrp_oit_format format, hdrp_v4 v)
{
    switch (format) {
    case HDRP_OIT_FORMAT_RGBA16F:
    case HDRP_OIT_FORMAT_R16F:
        return hdrp_v4_make(hdrp_i_oit_half(v.x), hdrp_i_oit_half(v.y), hdrp_i_oit_half(v.z),
                            hdrp_i_oit_half(v.w));
    case HDRP_OIT_FORMAT_R11G11B10F:
        return hdrp_v4_from_v3(
            hdrp_pack_rgb_from_r11g11b10f(hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_from_v4(v))), 1.0f);
    case HDRP_OIT_FORMAT_RGBA8:
    case HDRP_OIT_FORMAT_R8:
        return hdrp_pack_v4_from_rgba8(hdrp_pack_rgba8_from_v4(v));
    case HDRP_OIT_FORMAT_RGBA32F:
    case HDRP_OIT_FORMAT_RG32F:
    case HDRP_OIT_FORMAT_R32F:
        break;
    }
    return v;
}

static float hdrp_i_oit_blended(hdrp_oit_blend blend, float source, float destination)
{
    if (blend == HDRP_OIT_BLEND_MAX) {
        return hdrp_max(destination, source);
    }
    return blend == HDRP_OIT_BLEND_ADD ? destination + source : destination * (1.0f - source);
}

/* What hardware does: what is normalised is limited first, the result is rounded once. */
static void hdrp_i_oit_blend_texel(const hdrp_oit_target* target, hdrp_v4* texel, hdrp_v4 s)
{
    hdrp_v4 d = *texel;
    if (target->format == HDRP_OIT_FORMAT_RGBA8 || target->format == HDRP_OIT_FORMAT_R8) {
        s = hdrp_v4_from_v3(hdrp_v3_saturate(hdrp_v3_from_v4(s)), hdrp_saturate(s.w));
    }
    d.x = hdrp_i_oit_blended(target->color, s.x, d.x);
    d.y = hdrp_i_oit_blended(target->color, s.y, d.y);
    d.z = hdrp_i_oit_blended(target->color, s.z, d.z);
    d.w = hdrp_i_oit_blended(target->alpha, s.w, d.w);
    *texel = hdrp_i_oit_stored(target->format, d);
}

/* ---- images ---------------------------------------------------------------------------------- */

static float hdrp_i_oit_near_m(const hdrp_oit_desc* d)
{
    return d->near_m > 0.0f ? d->near_m : 0.5f;
}

static float hdrp_i_oit_far_m(const hdrp_oit_desc* d)
{
    return d->far_m > 0.0f ? d->far_m : 300.0f;
}

static int hdrp_i_oit_desc_valid(const hdrp_oit_desc* d)
{
    return d->width_px > 0u && d->height_px > 0u && hdrp_i_oit_exists(d->mode, d->precision) &&
           d->scale >= 0.0f && d->scale <= 1048576.0f && d->near_m >= 0.0f && d->far_m >= 0.0f &&
           hdrp_i_oit_far_m(d) > hdrp_i_oit_near_m(d) && d->far_m <= HDRP_OIT_DEPTH_MAX &&
           d->feather >= 0.0f && d->feather <= 1.0f && d->exposure >= 0.0f && d->exposure <= 1e9f;
}

/* Bytes of the texels; 0 where they cannot be counted, or a pixel not in 32 bits. */
static size_t hdrp_i_oit_bytes(const hdrp_oit_desc* d)
{
    hdrp_oit_target targets[HDRP_OIT_TARGETS_MAX];
    size_t each = hdrp_oit_describe_targets(d->mode, d->precision, targets) * sizeof(hdrp_v4);
    uint64_t count = (uint64_t)d->width_px * d->height_px;
    if (count > 0xffffffffu || count > (size_t)-1 / each) {
        return 0u;
    }
    return (size_t)count * each;
}

HDRP_API size_t hdrp_oit_memory_size(const hdrp_oit_desc* desc)
{
    return desc && hdrp_i_oit_desc_valid(desc) ? hdrp_i_oit_bytes(desc) : 0u;
}

HDRP_API hdrp_result hdrp_oit_image_init(hdrp_oit_image* image, const hdrp_oit_desc* desc,
                                         void* memory, size_t memory_size)
{
    size_t bytes;
    if (!image || !desc || !memory) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (!hdrp_i_oit_desc_valid(desc)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    bytes = hdrp_i_oit_bytes(desc);
    if (bytes == 0u) {
        return HDRP_ERROR_TOO_LARGE;
    }
    if (memory_size < bytes) {
        return HDRP_ERROR_MEMORY_TOO_SMALL;
    }
    if ((uintptr_t)memory % HDRP_MEMORY_ALIGNMENT != 0u) {
        return HDRP_ERROR_MEMORY_ALIGNMENT;
    }
    image->desc = *desc;
    image->desc.scale = desc->scale > 0.0f ? desc->scale : 1.0f;
    image->desc.near_m = hdrp_i_oit_near_m(desc);
    image->desc.far_m = hdrp_i_oit_far_m(desc);
    image->desc.feather = desc->feather > 0.0f ? desc->feather : 1.0f / 3.0f;
    image->desc.exposure = desc->exposure > 0.0f ? desc->exposure : 1.0f;
    image->target_count = hdrp_oit_describe_targets(desc->mode, desc->precision, image->targets);
    image->texels = (hdrp_v4*)memory;
    hdrp_oit_clear_rows(image, 0u, desc->height_px);
    return HDRP_OK;
}

/* Texels of a target from a pixel on. */
static hdrp_v4* hdrp_i_oit_texel(const hdrp_oit_image* image, uint32_t target, size_t pixel)
{
    size_t plane = (size_t)image->desc.width_px * image->desc.height_px;
    return image->texels + target * plane + pixel;
}

HDRP_API void hdrp_oit_clear_rows(hdrp_oit_image* image, uint32_t row_begin, uint32_t row_end)
{
    size_t width = image->desc.width_px, pixel;
    uint32_t end = row_end < image->desc.height_px ? row_end : image->desc.height_px, i;
    for (i = 0u; i < image->target_count; ++i) {
        for (pixel = row_begin * width; pixel < end * width; ++pixel) {
            *hdrp_i_oit_texel(image, i, pixel) = image->targets[i].clear;
        }
    }
}

/* ---- fragments ------------------------------------------------------------------------------- */

/* Where the targets of colour begin. */
static uint32_t hdrp_i_oit_first_color(const hdrp_oit_image* image)
{
    uint32_t i = 0u, last = hdrp_oit_pass_count(image->desc.mode) - 1u;
    while (image->targets[i].pass < last) {
        ++i;
    }
    return image->desc.mode == HDRP_OIT_MODE_FRONT ? i + 1u : i;
}

static float hdrp_i_oit_device_depth(const hdrp_oit_desc* d, hdrp_oit_fragment f)
{
    return d->far_m / (d->far_m - d->near_m) * (1.0f - d->near_m / f.z_view);
}

static hdrp_oit_place hdrp_i_oit_image_place(const hdrp_oit_image* image, hdrp_oit_fragment f,
                                             size_t pixel)
{
    hdrp_v4 range = *hdrp_i_oit_texel(image, 0u, pixel);
    return hdrp_oit_place_of(f, hdrp_v2_make(range.x, range.y));
}

/* How much of a fragment is seen, from what the pass before left. */
static float hdrp_i_oit_image_through(const hdrp_oit_image* image, hdrp_oit_fragment f,
                                      size_t pixel)
{
    hdrp_oit_place place = hdrp_i_oit_image_place(image, f, pixel);
    if (image->desc.mode == HDRP_OIT_MODE_WAVELET) {
        hdrp_oit_wavelet w;
        w.coarse = *hdrp_i_oit_texel(image, 1u, pixel);
        w.eighths = *hdrp_i_oit_texel(image, 2u, pixel);
        w.finest_low = *hdrp_i_oit_texel(image, 3u, pixel);
        w.finest_high = *hdrp_i_oit_texel(image, 4u, pixel);
        w.front = hdrp_i_oit_texel(image, 5u, pixel)->x;
        return hdrp_oit_wavelet_transmittance(w, f, place);
    } else {
        hdrp_oit_moments m;
        int six = image->desc.mode == HDRP_OIT_MODE_MOMENTS_6;
        m.power = *hdrp_i_oit_texel(image, 1u, pixel);
        m.high = *hdrp_i_oit_texel(image, 2u, pixel);
        if (!six) {
            m.high = hdrp_v4_make(0.0f, 0.0f, m.high.x, m.high.y);
        }
        return hdrp_oit_moments_transmittance(m, f, place, six ? 6u : 4u);
    }
}

/* What a fragment writes in the passes before the last. */
static void hdrp_i_oit_absorb(const hdrp_oit_image* image, uint32_t pass, hdrp_oit_fragment f,
                              size_t pixel, hdrp_v4* out)
{
    hdrp_oit_place place;
    if (pass == 0u) {
        hdrp_v2 range = hdrp_oit_range_export(f);
        out[0] = hdrp_v4_make(range.x, range.y, 0.0f, 0.0f);
        return;
    }
    place = hdrp_i_oit_image_place(image, f, pixel);
    if (image->desc.mode == HDRP_OIT_MODE_WAVELET) {
        hdrp_oit_wavelet w = hdrp_oit_wavelet_insert(f, place);
        out[0] = w.coarse;
        out[1] = w.eighths;
        out[2] = w.finest_low;
        out[3] = w.finest_high;
        out[4] = hdrp_v4_make(w.front, 0.0f, 0.0f, 0.0f);
    } else {
        hdrp_oit_moments m = hdrp_oit_moments_insert(f, place);
        out[0] = m.power;
        out[1] = image->desc.mode == HDRP_OIT_MODE_MOMENTS_6
                     ? m.high
                     : hdrp_v4_make(m.high.z, m.high.w, 0.0f, 0.0f);
    }
}

/* What a fragment writes to the targets of colour. */
static void hdrp_i_oit_shade(const hdrp_oit_image* image, hdrp_oit_fragment f, size_t pixel,
                             hdrp_v4* out)
{
    const hdrp_oit_desc* d = &image->desc;
    hdrp_oit_talk_settings talk = hdrp_oit_talk_settings_make(d->feather, d->exposure);
    hdrp_oit_targets t;
    if (d->mode == HDRP_OIT_MODE_FRONT) {
        hdrp_v4 range = *hdrp_i_oit_texel(image, 0u, pixel);
        float nearest = hdrp_oit_nearest_of(hdrp_v2_make(range.x, 0.0f));
        hdrp_oit_front_targets all = hdrp_oit_front_export(f, nearest, d->scale);
        *out++ = all.front;
        t.accum = all.accum;
        t.light = all.light;
    } else if (d->mode == HDRP_OIT_MODE_TALK) {
        t = hdrp_oit_talk_export(f, talk);
    } else if (hdrp_i_oit_is_layered(d->mode)) {
        t = hdrp_oit_layer_export(f, hdrp_i_oit_image_through(image, f, pixel), d->scale);
    } else {
        t = hdrp_oit_mode_export(d->mode, f, hdrp_i_oit_device_depth(d, f), talk, d->scale);
    }
    out[0] = t.accum;
    out[1] = t.light;
    out[2] = hdrp_v4_make(t.light.w, 0.0f, 0.0f, 0.0f); /* where it has a target of its own */
}

HDRP_API void hdrp_oit_blend_rows(hdrp_oit_image* image, uint32_t pass,
                                  const hdrp_oit_fragment* fragments, const uint32_t* pixels,
                                  size_t count, uint32_t row_begin, uint32_t row_end)
{
    size_t width = image->desc.width_px, i;
    uint32_t end = row_end < image->desc.height_px ? row_end : image->desc.height_px;
    uint32_t k, first = 0u, last, passes = hdrp_oit_pass_count(image->desc.mode);
    hdrp_v4 out[HDRP_OIT_TARGETS_MAX];
    if (pass >= passes) {
        return;
    }
    while (image->targets[first].pass < pass) {
        ++first;
    }
    for (last = first; last < image->target_count && image->targets[last].pass == pass; ++last) {
    }
    for (i = 0u; i < count; ++i) {
        size_t pixel = pixels[i];
        if (pixel < row_begin * width || pixel >= end * width) {
            continue;
        }
        if (pass + 1u == passes) {
            hdrp_i_oit_shade(image, fragments[i], pixel, out);
        } else {
            hdrp_i_oit_absorb(image, pass, fragments[i], pixel, out);
        }
        for (k = first; k < last; ++k) {
            hdrp_i_oit_blend_texel(&image->targets[k], hdrp_i_oit_texel(image, k, pixel),
                                   out[k - first]);
        }
    }
}

/* ---- composite ------------------------------------------------------------------------------- */

/* What the targets of colour of a pixel hold. */
static hdrp_oit_targets hdrp_i_oit_sums(const hdrp_oit_image* image, size_t pixel)
{
    uint32_t first = hdrp_i_oit_first_color(image);
    hdrp_oit_targets t;
    t.accum = *hdrp_i_oit_texel(image, first, pixel);
    t.light = *hdrp_i_oit_texel(image, first + 1u, pixel);
    if (first + 2u < image->target_count) {
        t.light.w = hdrp_i_oit_texel(image, first + 2u, pixel)->x;
    }
    return t;
}

/* Four pixels and what lies between them. */
typedef struct hdrp_i_oit_tap {
    size_t pixel[4];
    float x, y;
} hdrp_i_oit_tap;

/* x and y in pixels, 0.5 at the centre of the first. */
static hdrp_i_oit_tap hdrp_i_oit_tap_at(const hdrp_oit_image* image, float x, float y)
{
    float last_x = (float)(image->desc.width_px - 1u), last_y = (float)(image->desc.height_px - 1u);
    float px = hdrp_clamp(x - 0.5f, 0.0f, last_x), py = hdrp_clamp(y - 0.5f, 0.0f, last_y);
    float column = hdrp_floor(px), row = hdrp_floor(py);
    size_t width = image->desc.width_px;
    size_t step_x = column < last_x ? 1u : 0u, step_y = row < last_y ? width : 0u;
    hdrp_i_oit_tap tap;
    tap.pixel[0] = (size_t)row * width + (size_t)column;
    tap.pixel[1] = tap.pixel[0] + step_x;
    tap.pixel[2] = tap.pixel[0] + step_y;
    tap.pixel[3] = tap.pixel[2] + step_x;
    tap.x = px - column;
    tap.y = py - row;
    return tap;
}

static hdrp_v4 hdrp_i_oit_lerp4(hdrp_v4 a, hdrp_v4 b, float t)
{
    return hdrp_v4_make(hdrp_lerp(a.x, b.x, t), hdrp_lerp(a.y, b.y, t), hdrp_lerp(a.z, b.z, t),
                        hdrp_lerp(a.w, b.w, t));
}

static hdrp_v4 hdrp_i_oit_mixed(const hdrp_v4* v, const hdrp_i_oit_tap* tap)
{
    return hdrp_i_oit_lerp4(hdrp_i_oit_lerp4(v[0], v[1], tap->x),
                            hdrp_i_oit_lerp4(v[2], v[3], tap->x), tap->y);
}

/* The sums of an image between four pixels. */
static hdrp_oit_targets hdrp_i_oit_sampled(const hdrp_oit_image* image, const hdrp_i_oit_tap* tap)
{
    hdrp_v4 accum[4], light[4];
    hdrp_oit_targets t;
    int i;
    for (i = 0; i < 4; ++i) {
        t = hdrp_i_oit_sums(image, tap->pixel[i]);
        accum[i] = t.accum;
        light[i] = t.light;
    }
    t.accum = hdrp_i_oit_mixed(accum, tap);
    t.light = hdrp_i_oit_mixed(light, tap);
    return t;
}

/* The nearest fragments of both: each image has those whose surface is its own. */
static void hdrp_i_oit_merge_front(hdrp_oit_image* image, const hdrp_oit_image* low, size_t pixel,
                                   const hdrp_i_oit_tap* tap)
{
    uint32_t plane = hdrp_i_oit_first_color(image) - 1u;
    hdrp_v4* to = hdrp_i_oit_texel(image, plane, pixel);
    hdrp_v4 v[4], added;
    int i;
    for (i = 0; i < 4; ++i) {
        v[i] = *hdrp_i_oit_texel(low, plane, tap->pixel[i]);
    }
    added = hdrp_i_oit_mixed(v, tap);
    *to = hdrp_v4_make(to->x + added.x, to->y + added.y, to->z + added.z, to->w + added.w);
}

static void hdrp_i_oit_merge_pixel(hdrp_oit_image* image, const hdrp_oit_image* low, size_t pixel,
                                   const hdrp_i_oit_tap* tap)
{
    uint32_t first = hdrp_i_oit_first_color(image);
    hdrp_oit_targets a = hdrp_i_oit_sums(image, pixel), b = hdrp_i_oit_sampled(low, tap);
    a = image->desc.mode == HDRP_OIT_MODE_TALK ? hdrp_oit_talk_merge(a, b) : hdrp_oit_merge(a, b);
    *hdrp_i_oit_texel(image, first, pixel) = a.accum;
    *hdrp_i_oit_texel(image, first + 1u, pixel) = a.light;
    if (first + 2u < image->target_count) {
        *hdrp_i_oit_texel(image, first + 2u, pixel) = hdrp_v4_make(a.light.w, 0.0f, 0.0f, 0.0f);
    }
    if (image->desc.mode == HDRP_OIT_MODE_FRONT) {
        hdrp_i_oit_merge_front(image, low, pixel, tap);
    }
}

HDRP_API hdrp_result hdrp_oit_merge_rows(hdrp_oit_image* image, const hdrp_oit_image* low,
                                         uint32_t row_begin, uint32_t row_end)
{
    uint32_t x, y, end;
    float scale_x, scale_y;
    if (!image || !low) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (image->desc.mode != low->desc.mode || image->desc.precision != low->desc.precision ||
        image->desc.scale != low->desc.scale) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    end = row_end < image->desc.height_px ? row_end : image->desc.height_px;
    scale_x = (float)low->desc.width_px / (float)image->desc.width_px;
    scale_y = (float)low->desc.height_px / (float)image->desc.height_px;
    for (y = row_begin; y < end; ++y) {
        for (x = 0u; x < image->desc.width_px; ++x) {
            hdrp_i_oit_tap tap =
                hdrp_i_oit_tap_at(low, ((float)x + 0.5f) * scale_x, ((float)y + 0.5f) * scale_y);
            hdrp_i_oit_merge_pixel(image, low, (size_t)y * image->desc.width_px + x, &tap);
        }
    }
    return HDRP_OK;
}

HDRP_API void hdrp_oit_composite_rows(const hdrp_oit_image* image, const hdrp_v3* behind,
                                      hdrp_v3* color, uint32_t row_begin, uint32_t row_end)
{
    size_t width = image->desc.width_px, pixel;
    uint32_t end = row_end < image->desc.height_px ? row_end : image->desc.height_px;
    hdrp_oit_mode mode = image->desc.mode;
    for (pixel = row_begin * width; pixel < end * width; ++pixel) {
        hdrp_oit_targets t = hdrp_i_oit_sums(image, pixel);
        if (mode == HDRP_OIT_MODE_FRONT) {
            hdrp_oit_front_targets all;
            all.front = *hdrp_i_oit_texel(image, 1u, pixel);
            all.accum = t.accum;
            all.light = t.light;
            color[pixel] = hdrp_oit_front_composite(all, behind[pixel], image->desc.scale);
            continue;
        }
        color[pixel] = mode == HDRP_OIT_MODE_TALK ? hdrp_oit_talk_composite(t, behind[pixel])
                       : hdrp_i_oit_is_layered(mode)
                           ? hdrp_oit_layer_composite(t, behind[pixel], image->desc.scale)
                           : hdrp_oit_composite(t, behind[pixel], image->desc.scale);
    }
}

#ifdef __cplusplus
}
#endif

#endif /* HDRP_OIT_IMPLEMENTATION */
