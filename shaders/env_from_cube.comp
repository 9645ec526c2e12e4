#version 450
// The radiance cube from another cube; see env_resample.glsl. A thread makes a texel.
// header: hdrp_gpu_vk_env.h
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_env_image.h"
#include "env_resample.glsl"

layout(binding = 0) uniform texture2DArray image;

void main()
{
    uint face;
    uvec2 texel;
    if (!env_place_of_thread(face, texel)) {
        return;
    }
    // Texels are split where they are so large that the solid angle varies.
    uint n = cube.x, m = picture.x * picture.z;
    uvec2 begin = texel * m / n;
    uvec2 end = ((texel + 1u) * m + n - 1u) / n;
    for (uint j = begin.y; j < end.y; ++j) {
        for (uint i = begin.x; i < end.x; ++i) {
            // In parts of 1 / (m n) of the face: whole numbers.
            vec2 low = vec2(max(uvec2(i, j) * n, texel * m));
            vec2 high = vec2(min(uvec2(i + 1u, j + 1u) * n, (texel + 1u) * m));
            vec2 side = (high - low) / float(m);
            vec3 v = texelFetch(image, ivec3(i / picture.z, j / picture.z, face), 0).xyz;
            add_piece(side.x * side.y, (low + high) / (float(m) * float(n)) - 1.0, nits_of(v));
        }
    }
    env_store(face, texel);
}
