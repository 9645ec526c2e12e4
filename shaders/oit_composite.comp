#version 450
// What transparent surfaces have left in targets, over what is opaque: what hdrp_oit_merge_rows and
// hdrp_oit_composite_rows do, without rounding between them. A thread makes a pixel.
// header: hdrp_gpu_vk_oit.h
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_oit.h"

layout(local_size_x = 8, local_size_y = 8) in;
// How targets are read: HDRP_I_GPU_VK_OIT_... of the header.
layout(constant_id = 2) const uint KIND = 0u;
const uint THROUGH = 1u;
const uint FRONT = 2u;
const uint TALK = 3u;

layout(binding = 0) uniform texture2D full_accum;
layout(binding = 1) uniform texture2D full_light;
layout(binding = 2) uniform texture2D full_revealage;
layout(binding = 3) uniform texture2D full_front;
layout(binding = 4) uniform texture2D low_accum;
layout(binding = 5) uniform texture2D low_light;
layout(binding = 6) uniform texture2D low_revealage;
layout(binding = 7) uniform texture2D low_front;
layout(binding = 8) uniform texture2D opaque;
layout(binding = 9) uniform writeonly image2D composed;
layout(push_constant) uniform Push
{
    uvec4 picture; // x width, y height, z 1: revealage has a target of its own, w 1: low is read
    uvec4 low;     // x width, y height
    vec4 scale;    // x of colours, yz low pixels per pixel, w largest value of the format
};

hdrp_oit_front_targets fetch_full(ivec2 at)
{
    hdrp_oit_front_targets t;
    t.front = KIND == FRONT ? texelFetch(full_front, at, 0) : vec4(0.0);
    t.accum = texelFetch(full_accum, at, 0);
    t.light = texelFetch(full_light, at, 0);
    t.light.w = picture.z != 0u ? texelFetch(full_revealage, at, 0).x : t.light.w;
    return t;
}

hdrp_oit_front_targets fetch_low(ivec2 at)
{
    hdrp_oit_front_targets t;
    t.front = KIND == FRONT ? texelFetch(low_front, at, 0) : vec4(0.0);
    t.accum = texelFetch(low_accum, at, 0);
    t.light = texelFetch(low_light, at, 0);
    t.light.w = picture.z != 0u ? texelFetch(low_revealage, at, 0).x : t.light.w;
    return t;
}

hdrp_oit_front_targets mixed(hdrp_oit_front_targets a, hdrp_oit_front_targets b, float t)
{
    a.front = mix(a.front, b.front, t);
    a.accum = mix(a.accum, b.accum, t);
    a.light = mix(a.light, b.light, t);
    return a;
}

// Between four pixels, by floats: samplers filter by fewer bits, and not every format.
hdrp_oit_front_targets sample_low(uvec2 pixel)
{
    vec2 last = vec2(low.xy - 1u);
    vec2 at = clamp((vec2(pixel) + 0.5) * scale.yz - 0.5, vec2(0.0), last);
    vec2 first = floor(at);
    ivec2 a = ivec2(first);
    ivec2 b = ivec2(min(first + 1.0, last));
    vec2 fraction = at - first;
    hdrp_oit_front_targets upper =
        mixed(fetch_low(a), fetch_low(ivec2(b.x, a.y)), fraction.x);
    hdrp_oit_front_targets lower =
        mixed(fetch_low(ivec2(a.x, b.y)), fetch_low(b), fraction.x);
    return mixed(upper, lower, fraction.y);
}

hdrp_oit_targets sums_of(hdrp_oit_front_targets t)
{
    hdrp_oit_targets sums;
    sums.accum = t.accum;
    sums.light = t.light;
    return sums;
}

hdrp_oit_front_targets merged(hdrp_oit_front_targets a, hdrp_oit_front_targets b)
{
    hdrp_oit_targets t = sums_of(a);
    if (KIND == TALK) {
        t = hdrp_oit_talk_merge(t, sums_of(b));
    } else {
        t = hdrp_oit_merge(t, sums_of(b));
    }
    a.front += b.front;
    a.accum = t.accum;
    a.light = t.light;
    return a;
}

vec3 color_of(hdrp_oit_front_targets t, vec3 behind)
{
    if (KIND == TALK) {
        return hdrp_oit_talk_composite(sums_of(t), behind);
    }
    if (KIND == FRONT) {
        return hdrp_oit_front_composite(t, behind, scale.x);
    }
    if (KIND == THROUGH) {
        return hdrp_oit_layer_composite(sums_of(t), behind, scale.x);
    }
    return hdrp_oit_composite(sums_of(t), behind, scale.x);
}

// Share of what is behind that is seen.
float revealage_of(hdrp_oit_front_targets t)
{
    float through = hdrp_saturate(KIND == TALK ? t.light.x : t.light.w);
    return KIND == FRONT ? through * (1.0 - hdrp_saturate(t.front.w)) : through;
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, picture.xy))) {
        return;
    }
    hdrp_oit_front_targets t = fetch_full(ivec2(pixel));
    vec4 behind = texelFetch(opaque, ivec2(pixel), 0);
    if (picture.w != 0u) {
        t = merged(t, sample_low(pixel));
    }
    vec3 color = min(color_of(t, behind.xyz), vec3(scale.w));
    float alpha = behind.w + (1.0 - behind.w) * (1.0 - revealage_of(t));
    imageStore(composed, ivec2(pixel), vec4(color, alpha));
}
