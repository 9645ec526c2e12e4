#version 450
// The range of depths, or the nearest one.
#extension GL_GOOGLE_include_directive : require
#define HDRP_OIT_OUTPUTS 1
#include "oit_absorb.glsl"
