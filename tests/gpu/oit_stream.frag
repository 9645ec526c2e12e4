#version 450
// A stream of fragments into the targets of every mode, for test_gpu_oit.c.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_oit.h"

layout(constant_id = 0) const uint MODE = 0u;
layout(constant_id = 1) const uint PASS = 0u;
layout(push_constant) uniform Push
{
    vec4 picture; // xy size [px], z scale
    vec4 talk;    // x feather, y exposure
};
layout(location = 0) flat in vec4 color;
layout(location = 1) flat in vec4 emission;
layout(location = 2) flat in float device_depth;

#define HDRP_OIT_MODE         MODE
#define HDRP_OIT_PASS         PASS
#define HDRP_OIT_SCALE        picture.z
#define HDRP_OIT_DEVICE_DEPTH device_depth
#define HDRP_OIT_FEATHER      talk.x
#define HDRP_OIT_EXPOSURE     talk.y
#include "oit_output.glsl"

void main()
{
    hdrp_oit_fragment f;
    f.premultiplied = color.xyz;
    f.emission = emission.xyz;
    f.alpha = color.w;
    f.z_view = emission.w;
    hdrp_oit_write(f);
}
