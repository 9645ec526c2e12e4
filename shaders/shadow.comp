#version 450
// Shadows of directional lights, for the pixels of a picture: a channel for each of up to four, what
// hdrp_shadow_cascades_visibility computes. A thread makes a pixel.
// contraction: none
// header: hdrp_gpu_vk_shadow.h
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_cull_volume.h"
#include "hdrp_pack.h"
#include "hdrp_shadow.h"

#define HDRP_SHADOW_BINDING 0
#include "shadow_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 2) uniform texture2D depths;
layout(binding = 3) uniform texture2D normals;
layout(binding = 4) uniform writeonly image2D visibility;
layout(push_constant) uniform Push
{
    hdrp_cull_camera camera;
    hdrp_depth_params device;
    uvec4 picture; // x width and y height [px] 16 bits each, y HDRP_GPU_VK_SHADOW_..., z first view,
                   // w numbers of views of the lights, 8 bits each
};

#define DEVICE_DEPTH  1u
#define PLAIN_NORMALS 2u

vec3 normal_of(ivec2 at)
{
    vec4 texel = texelFetch(normals, at, 0);
    if ((picture.y & PLAIN_NORMALS) != 0u) {
        return hdrp_normalize_or(texel.xyz, vec3(0.0, 1.0, 0.0));
    }
    return hdrp_pack_normal_buffer_decode(texel).normal;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    uvec2 size = uvec2(picture.x & 0xffffu, picture.x >> 16);
    if (gl_GlobalInvocationID.x >= size.x || gl_GlobalInvocationID.y >= size.y) {
        return;
    }
    float texel = texelFetch(depths, at, 0).x;
    float z = (picture.y & DEVICE_DEPTH) != 0u ? hdrp_view_depth(device, texel) : texel;
    vec4 r = vec4(1.0);
    if (z >= 0.0 && z < camera.right_far.w) { // else sky
        vec2 pixel = vec2(at) + 0.5;
        vec3 offset =
            hdrp_cull_offset_of_pixel(camera, pixel.x, pixel.y, float(size.x), float(size.y), z);
        vec3 position = hdrp_v3_add(hdrp_v3_from_v4(camera.eye_near), offset);
        vec3 normal = normal_of(at);
        uint first = picture.z;
        for (uint light = 0u; light < 4u; ++light) {
            uint count = picture.w >> (8u * light) & 255u;
            if (count > 0u) {
                r[light] = shadow_cascades_visibility(first, count, position, normal);
            }
            first += count;
        }
    }
    imageStore(visibility, at, r);
}
