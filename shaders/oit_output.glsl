// What a fragment shader writes into the targets of transparency, in every mode and pass of
// hdrp_oit.h. Before the line that includes it, a shader has
//
//     #extension GL_GOOGLE_include_directive : require
//     #extension GL_EXT_samplerless_texture_functions : require
//     #include "hdrp_oit.h"
//     #define HDRP_OIT_MODE HDRP_OIT_MODE_RECOMMENDED
//     #define HDRP_OIT_PASS 0u  of hdrp_oit_pass_count(mode), from 0 on
//
// Both are constants, or specialization constants, so that one module serves all modes: what is not
// in them costs nothing. A shader may define, besides:
//
//     HDRP_OIT_OUTPUTS       how many targets the pass has, 1 to 5; 2. What is written beyond them
//                            goes nowhere
//     HDRP_OIT_SET           descriptor set of what passes read; 0
//     HDRP_OIT_BINDING       its first binding; 0. It takes those up to + 5
//     HDRP_OIT_ONE_PASS      its modes take one pass: nothing is read, and nothing declared
//     HDRP_OIT_SCALE         power of 2 that colours are multiplied by; 1.0
//     HDRP_OIT_DEVICE_DEPTH  for HDRP_OIT_MODE_EQ10 and _2015, 0 at the near plane; gl_FragCoord.z,
//                            of a reversed depth 1.0 - gl_FragCoord.z
//     HDRP_OIT_FEATHER       of the talk; 1.0 / 3.0
//     HDRP_OIT_EXPOSURE      of the talk; 1.0
//
// Targets are those of hdrp_oit_describe_targets. A pass writes its own, in their order, at
// locations from 0 on. It reads those of passes before as texture2D of its own resolution: number k
// at HDRP_OIT_BINDING + k. All must be valid; a stand-in of the same kind serves for what a mode
// leaves out. Then for each pixel:
//
//     if (hdrp_oit_writes_color()) { ... light the surface, by light_loop.glsl for example }
//     hdrp_oit_write(hdrp_oit_fragment_make(color * alpha, emission, alpha, z_view));
//
// Light and emission count in the last pass only; alpha and z_view must be the same bits in all of
// them: the position is invariant, and their expressions are precise.

#ifndef HDRP_OIT_OUTPUTS
#define HDRP_OIT_OUTPUTS 2
#endif
#ifndef HDRP_OIT_SET
#define HDRP_OIT_SET 0
#endif
#ifndef HDRP_OIT_BINDING
#define HDRP_OIT_BINDING 0
#endif
#ifndef HDRP_OIT_SCALE
#define HDRP_OIT_SCALE 1.0
#endif
#ifndef HDRP_OIT_DEVICE_DEPTH
#define HDRP_OIT_DEVICE_DEPTH gl_FragCoord.z
#endif
#ifndef HDRP_OIT_FEATHER
#define HDRP_OIT_FEATHER (1.0 / 3.0)
#endif
#ifndef HDRP_OIT_EXPOSURE
#define HDRP_OIT_EXPOSURE 1.0
#endif

layout(location = 0) out vec4 hdrp_oit_0;
#if HDRP_OIT_OUTPUTS > 1
layout(location = 1) out
#endif
    vec4 hdrp_oit_1;
#if HDRP_OIT_OUTPUTS > 2
layout(location = 2) out
#endif
    vec4 hdrp_oit_2;
#if HDRP_OIT_OUTPUTS > 3
layout(location = 3) out
#endif
    vec4 hdrp_oit_3;
#if HDRP_OIT_OUTPUTS > 4
layout(location = 4) out
#endif
    vec4 hdrp_oit_4;

bool hdrp_i_out_has(uint mode)
{
    return HDRP_OIT_MODE == mode;
}

bool hdrp_i_out_is_layered()
{
    return hdrp_i_out_has(HDRP_OIT_MODE_WAVELET) || hdrp_i_out_has(HDRP_OIT_MODE_MOMENTS_6) ||
           hdrp_i_out_has(HDRP_OIT_MODE_MOMENTS_4);
}

// Whether the pass writes colours: the others need depth and alpha alone.
bool hdrp_oit_writes_color()
{
    return HDRP_OIT_PASS ==
           (hdrp_i_out_is_layered() ? 2u : hdrp_i_out_has(HDRP_OIT_MODE_FRONT) ? 1u : 0u);
}

#ifndef HDRP_OIT_ONE_PASS
#define HDRP_I_OUT_BOUND(n) set = HDRP_OIT_SET, binding = HDRP_OIT_BINDING + n
layout(HDRP_I_OUT_BOUND(0)) uniform texture2D hdrp_oit_range;
layout(HDRP_I_OUT_BOUND(1)) uniform texture2D hdrp_oit_before_1;
layout(HDRP_I_OUT_BOUND(2)) uniform texture2D hdrp_oit_before_2;
layout(HDRP_I_OUT_BOUND(3)) uniform texture2D hdrp_oit_before_3;
layout(HDRP_I_OUT_BOUND(4)) uniform texture2D hdrp_oit_before_4;
layout(HDRP_I_OUT_BOUND(5)) uniform texture2D hdrp_oit_before_5;

vec4 hdrp_i_out_fetch(texture2D target)
{
    return texelFetch(target, ivec2(gl_FragCoord.xy), 0);
}

hdrp_oit_place hdrp_i_out_place(hdrp_oit_fragment f)
{
    return hdrp_oit_place_of(f, hdrp_i_out_fetch(hdrp_oit_range).xy);
}

// How much of a fragment is seen, from what the pass before left.
float hdrp_i_out_through(hdrp_oit_fragment f)
{
    hdrp_oit_place place = hdrp_i_out_place(f);
    if (hdrp_i_out_has(HDRP_OIT_MODE_WAVELET)) {
        hdrp_oit_wavelet w;
        w.coarse = hdrp_i_out_fetch(hdrp_oit_before_1);
        w.eighths = hdrp_i_out_fetch(hdrp_oit_before_2);
        w.finest_low = hdrp_i_out_fetch(hdrp_oit_before_3);
        w.finest_high = hdrp_i_out_fetch(hdrp_oit_before_4);
        w.front = hdrp_i_out_fetch(hdrp_oit_before_5).x;
        return hdrp_oit_wavelet_transmittance(w, f, place);
    }
    hdrp_oit_moments m;
    m.power = hdrp_i_out_fetch(hdrp_oit_before_1);
    m.high = hdrp_i_out_fetch(hdrp_oit_before_2);
    if (hdrp_i_out_has(HDRP_OIT_MODE_MOMENTS_4)) {
        m.high = vec4(0.0, 0.0, m.high.xy);
        return hdrp_oit_moments_transmittance(m, f, place, 4u);
    }
    return hdrp_oit_moments_transmittance(m, f, place, 6u);
}

void hdrp_i_out_absorb(hdrp_oit_fragment f)
{
    hdrp_oit_place place = hdrp_i_out_place(f);
    if (hdrp_i_out_has(HDRP_OIT_MODE_WAVELET)) {
        hdrp_oit_wavelet w = hdrp_oit_wavelet_insert(f, place);
        hdrp_oit_0 = w.coarse;
        hdrp_oit_1 = w.eighths;
        hdrp_oit_2 = w.finest_low;
        hdrp_oit_3 = w.finest_high;
        hdrp_oit_4 = vec4(w.front, 0.0, 0.0, 0.0);
    } else {
        hdrp_oit_moments m = hdrp_oit_moments_insert(f, place);
        hdrp_oit_0 = m.power;
        hdrp_oit_1 = hdrp_i_out_has(HDRP_OIT_MODE_MOMENTS_6) ? m.high : vec4(m.high.zw, 0.0, 0.0);
    }
}
#endif

// To the targets of colour, from a location on.
void hdrp_i_out_targets(hdrp_oit_targets t)
{
    hdrp_oit_0 = t.accum;
    hdrp_oit_1 = t.light;
    hdrp_oit_2 = vec4(t.light.w, 0.0, 0.0, 0.0); // where it has a target of its own
}

void hdrp_i_out_color(hdrp_oit_fragment f)
{
    hdrp_oit_talk_settings talk = hdrp_oit_talk_settings_make(HDRP_OIT_FEATHER, HDRP_OIT_EXPOSURE);
#ifndef HDRP_OIT_ONE_PASS
    if (hdrp_i_out_has(HDRP_OIT_MODE_FRONT)) {
        float nearest = hdrp_oit_nearest_of(hdrp_i_out_fetch(hdrp_oit_range).xy);
        hdrp_oit_front_targets all = hdrp_oit_front_export(f, nearest, HDRP_OIT_SCALE);
        hdrp_oit_0 = all.front;
        hdrp_oit_1 = all.accum;
        hdrp_oit_2 = all.light;
        hdrp_oit_3 = vec4(all.light.w, 0.0, 0.0, 0.0);
        return;
    }
    if (hdrp_i_out_is_layered()) {
        hdrp_i_out_targets(hdrp_oit_layer_export(f, hdrp_i_out_through(f), HDRP_OIT_SCALE));
        return;
    }
#endif
    if (hdrp_i_out_has(HDRP_OIT_MODE_TALK)) {
        hdrp_i_out_targets(hdrp_oit_talk_export(f, talk));
    } else {
        hdrp_i_out_targets(hdrp_oit_mode_export(HDRP_OIT_MODE, f, HDRP_OIT_DEVICE_DEPTH, talk,
                                                HDRP_OIT_SCALE));
    }
}

// All that a fragment writes in the pass.
void hdrp_oit_write(hdrp_oit_fragment f)
{
    hdrp_oit_0 = vec4(0.0);
    hdrp_oit_1 = vec4(0.0);
    hdrp_oit_2 = vec4(0.0);
    hdrp_oit_3 = vec4(0.0);
    hdrp_oit_4 = vec4(0.0);
#ifndef HDRP_OIT_ONE_PASS
    if (!hdrp_oit_writes_color()) {
        if (HDRP_OIT_PASS == 0u) {
            hdrp_oit_0 = vec4(hdrp_oit_range_export(f), 0.0, 0.0);
        } else {
            hdrp_i_out_absorb(f);
        }
        return;
    }
#endif
    hdrp_i_out_color(f);
}
