#version 450
// The same where the nearest fragment is kept apart.
#extension GL_GOOGLE_include_directive : require
#define HDRP_OIT_OUTPUTS 3
#include "oit_color.glsl"
