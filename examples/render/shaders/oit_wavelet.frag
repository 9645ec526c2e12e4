#version 450
// Wavelets of what absorbs.
#extension GL_GOOGLE_include_directive : require
#define HDRP_OIT_OUTPUTS 5
#include "oit_absorb.glsl"
