#version 450
// Exposed light as what a display shows: hdrp_tonemap, hdrp_srgb_from_linear and hdrp_dithered. A
// thread makes a pixel.
// header: hdrp_gpu_vk_env.h
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_math.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform texture2D light;
layout(binding = 1) uniform writeonly image2D shown;
layout(push_constant) uniform Push
{
    uvec4 picture; // x width, y height, z curve, w 1: stays linear
    uvec4 noise;   // x frame, y 1: there is noise
    vec4 scale;    // x exposure, y largest code, or 0 where the format has none
};

float shown_of(float v, uvec2 pixel, uint channel)
{
    float code = picture.w != 0u ? v : hdrp_srgb_from_linear(v);
    float n = hdrp_dither_from_hash(hdrp_hash3(pixel.x | pixel.y << 16, channel, noise.x));
    n = noise.y != 0u ? n : 0.0;
    return scale.y > 0.0 ? hdrp_dithered(code, scale.y, n) : code;
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, picture.xy))) {
        return;
    }
    vec4 texel = texelFetch(light, ivec2(pixel), 0);
    vec3 v = hdrp_tonemap(texel.xyz * scale.x, picture.z);
    v = vec3(shown_of(v.x, pixel, 0u), shown_of(v.y, pixel, 1u), shown_of(v.z, pixel, 2u));
    imageStore(shown, ivec2(pixel), vec4(v, hdrp_saturate(texel.w)));
}
