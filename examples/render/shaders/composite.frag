#version 450
// Layers over the opaque picture, which those that bend or scatter light look up elsewhere.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scene.glsl"
#include "hdrp_pack.h"
#include "hdrp_gpu_vk_light.h"
#include "rays.glsl"
#define HDRP_FEATURES     0u
#define HDRP_WORD         0u
#define HDRP_LIGHTING_SET 2
#include "shaders/light_loop.glsl"
#include "behind.glsl"

layout(set = 2, binding = 14) uniform sampler2D opaque;
layout(set = 2, binding = 17) uniform texture2D layer_light;
layout(set = 2, binding = 18) uniform texture2D layer_through;
layout(set = 2, binding = 19) uniform texture2D layer_moved;
layout(set = 2, binding = 20) uniform texture2D layer_most;
layout(set = 2, binding = 21) uniform texture2D layer_direction;
layout(location = 0) out vec4 color;

#define BLUR_TAPS     8u
#define BLUR_LOD_BIAS 1.5

// Lavapipe takes one level of detail for four pixels: there levels are filtered here.
layout(constant_id = 2) const bool IS_COARSE = false;

vec3 level_at(vec2 uv, int level)
{
    ivec2 n = max(ivec2(frame.jitter_size.zw) >> level, ivec2(1));
    vec2 at = clamp(uv, 0.0, 1.0) * vec2(n) - 0.5, first = floor(at), t = at - first;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 w = mix(1.0 - t, t, vec2(i & 1, i >> 1));
        ivec2 to = clamp(ivec2(first) + ivec2(i & 1, i >> 1), ivec2(0), n - 1);
        sum += texelFetch(opaque, to, level).xyz * (w.x * w.y);
    }
    return sum;
}

vec3 picture_at(vec2 uv, float lod)
{
    float level = clamp(floor(lod), 0.0, float(textureQueryLevels(opaque) - 1));
    int next = min(int(level) + 1, textureQueryLevels(opaque) - 1);
    if (!IS_COARSE) {
        return textureLod(opaque, uv, lod).xyz;
    }
    return mix(level_at(uv, int(level)), level_at(uv, next), clamp(lod - level, 0.0, 1.0));
}

vec3 blurred(vec2 at, float radius)
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint hash = hdrp_hash2(hdrp_hash3(pixel.x, pixel.y, frame.sample_of.y), frame.sample_of.x);
    float turn = hdrp_unit_from_u32(hash) * HDRP_TWO_PI;
    float c = cos(turn), k = sin(turn);
    float lod = log2(max(radius, 1.0)) - BLUR_LOD_BIAS;
    uint taps = radius < 0.5 ? 1u : BLUR_TAPS;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < taps; ++i) {
        vec2 d = radius < 0.5 ? vec2(0.0) : hdrp_fibonacci_disk(i, BLUR_TAPS) * radius;
        vec2 to = at + vec2(c * d.x - k * d.y, k * d.x + c * d.y);
        sum += picture_at(to / frame.jitter_size.zw, taps > 1u ? max(lod, 0.0) : 0.0);
    }
    return sum / float(taps);
}

vec3 behind(ivec2 pixel)
{
    vec4 moved = texelFetch(layer_moved, pixel, 0), most = texelFetch(layer_most, pixel, 0);
    vec4 direction = texelFetch(layer_direction, pixel, 0);
    vec2 straight = vec2(pixel) + frame.jitter_size.xy, at = straight + moved.xy;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, frame.jitter_size.zw))) {
        bool sky = (lighting.lights.w & HDRP_GPU_VK_WORD_ENVIRONMENT) != 0u;
        return sky ? hdrp_i_sky_specular(direction.xyz, most.y) * frame.depths_exposure.z
                   : vec3(0.0);
    }
    if (most.x == 0.0 && moved.z <= 0.0) {
        return texelFetch(opaque, pixel, 0).xyz;
    }
    // Something in front of the glass is not seen through it.
    at = most.x > 0.0 && opaque_distance(at) * most.x < 1.0 ? straight : at;
    return blurred(at, sqrt(moved.z));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 light = texelFetch(layer_light, pixel, 0), through = texelFetch(layer_through, pixel, 0);
    if (light.w == 0.0 && through == vec4(1.0)) {
        discard;
    }
    color = vec4(light.xyz + through.xyz * behind(pixel),
                 light.w + texelFetch(opaque, pixel, 0).w * (1.0 - light.w));
}
