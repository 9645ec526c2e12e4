#version 450
// The farthest depth of the pixels that a sample of the low resolution lies among: then soft things
// stop at no silhouette, and leak over it by less than one sample.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scene.glsl"

layout(set = 3, binding = 6) uniform texture2D depths;

void main()
{
    vec2 size = frame.jitter_size.zw, pixels = size / ceil(0.5 * size);
    ivec2 first = ivec2(floor(gl_FragCoord.xy) * pixels);
    ivec2 last = min(ivec2(ceil(floor(gl_FragCoord.xy + 1.0) * pixels)), ivec2(size)) - 1;
    float farthest = 1.0; // of reverse depth the least
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            farthest = min(farthest, texelFetch(depths, ivec2(x, y), 0).x);
        }
    }
    gl_FragDepth = farthest;
}
