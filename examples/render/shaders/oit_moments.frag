#version 450
// Moments of what absorbs.
#extension GL_GOOGLE_include_directive : require
#define HDRP_OIT_OUTPUTS 2
#include "oit_absorb.glsl"
