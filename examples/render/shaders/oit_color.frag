#version 450
// Blended surfaces lit, in the modes but that with a front.
#extension GL_GOOGLE_include_directive : require
#define HDRP_OIT_OUTPUTS 2
#include "oit_color.glsl"
