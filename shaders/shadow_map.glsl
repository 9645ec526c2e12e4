// Share of a light that reaches a position: what hdrp_shadow_visibility computes, from the views and
// the atlas of a set. For shaders of any stage; also the hook of light_loop.glsl for its atlas.
// Before the line that includes it, a shader has
//
//     #extension GL_GOOGLE_include_directive : require
//     #extension GL_EXT_samplerless_texture_functions : require
//     #include "hdrp_shadow.h"
//
// and may define HDRP_SHADOW_SET and HDRP_SHADOW_BINDING. Without them they are those of the light
// loop: the set is HDRP_LIGHTING_SET, the bindings HDRP_LIGHTING_BINDING + 10 and + 11.
//
//     HDRP_SHADOW_BINDING      storage buffer  views, an hdrp_shadow_view each
//     HDRP_SHADOW_BINDING + 1  texture2D       the atlas: depth aspect, or red channel
//
// With HDRP_SHADOW_ATLAS defined after it, light_loop.glsl asks light_shadow for lights with
// HDRP_LIGHT_FEATURE_SHADOW, whose shadow index (bits.z of the record) is that of their first view.
//
// Texels are fetched and compared here: no sampler, and no format that filters, is needed.

#ifndef HDRP_SHADOW_SET
#ifdef HDRP_LIGHTING_SET
#define HDRP_SHADOW_SET HDRP_LIGHTING_SET
#else
#define HDRP_SHADOW_SET 0
#endif
#endif
#ifndef HDRP_SHADOW_BINDING
#ifdef HDRP_LIGHTING_BINDING
#define HDRP_SHADOW_BINDING (HDRP_LIGHTING_BINDING + 10)
#else
#define HDRP_SHADOW_BINDING 10
#endif
#endif

layout(std430, set = HDRP_SHADOW_SET, binding = HDRP_SHADOW_BINDING) readonly buffer HdrpShadowViews
{
    hdrp_shadow_view shadow_views[];
};
layout(set = HDRP_SHADOW_SET, binding = HDRP_SHADOW_BINDING + 1) uniform texture2D shadow_atlas;

// Whether the texel at a place leaves a receiver lit.
float hdrp_i_shadow_fetch(hdrp_shadow_view view, hdrp_shadow_receiver receiver, vec2 at)
{
    vec2 inside = clamp(at, view.limits.xy, view.limits.zw);
    float depth = texelFetch(shadow_atlas, ivec2(inside), 0).x;
    return hdrp_shadow_lit(view, receiver, inside + 0.5, depth);
}

// One row of texels, from the first on, with weights.
float hdrp_i_shadow_row(hdrp_shadow_view view, hdrp_shadow_receiver receiver,
                        hdrp_shadow_weights weights, vec2 first, int pairs)
{
    float sum = 0.0;
    for (int i = 0; i < pairs; ++i) {
        vec2 at = first + vec2(2.0 * float(i), 0.0);
        sum += weights.even[i] * hdrp_i_shadow_fetch(view, receiver, at);
        sum += weights.odd[i] * hdrp_i_shadow_fetch(view, receiver, at + vec2(1.0, 0.0));
    }
    return sum;
}

float shadow_visibility(uint view_index, vec3 position, vec3 normal)
{
    hdrp_shadow_view view = shadow_views[view_index];
    hdrp_shadow_receiver receiver = hdrp_shadow_receiver_make(view, position, normal);
    uint filter_kind = hdrp_u32_from_f32(view.fade.y);
    int pairs = int(max(filter_kind, 1u));
    vec2 before = floor(receiver.place.xy - 0.5);
    vec2 fraction = receiver.place.xy - 0.5 - before;
    hdrp_shadow_weights across = hdrp_shadow_weights_make(filter_kind, fraction.x);
    hdrp_shadow_weights down = hdrp_shadow_weights_make(filter_kind, fraction.y);
    vec2 first = before + across.base;
    float sum = 0.0;
    if (receiver.place.w <= 0.0) {
        return 1.0;
    }
    for (int k = 0; k < pairs; ++k) {
        vec2 at = first + vec2(0.0, 2.0 * float(k));
        sum += down.even[k] * hdrp_i_shadow_row(view, receiver, across, at, pairs);
        sum += down.odd[k] *
               hdrp_i_shadow_row(view, receiver, across, at + vec2(0.0, 1.0), pairs);
    }
    return hdrp_saturate(sum);
}

// By the cascades of a directional light: what hdrp_shadow_cascades_visibility computes.
float shadow_cascades_visibility(uint first_view, uint count, vec3 position, vec3 normal)
{
    float left = 1.0;
    float sum = 0.0;
    for (uint i = 0u; i < count && left > 0.0; ++i) {
        float w = hdrp_shadow_cascade_weight(shadow_views[first_view + i], position);
        if (w > 0.0) {
            sum += left * w * shadow_visibility(first_view + i, position, normal);
            left *= 1.0 - w;
        }
    }
    return hdrp_saturate(sum + left);
}

// The hook of light_loop.glsl: l points from the position to the light.
float light_shadow(uint shadow_index, vec3 position, vec3 normal, vec3 l, float distance_m)
{
    uint map = hdrp_shadow_map_of_direction(shadow_views[shadow_index], -l);
    return shadow_visibility(shadow_index + map, position, normal);
}
