#version 450
// The sky behind the scene.
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#include "hdrp_env.h"
#include "rays.glsl"
#include "sky.glsl"

layout(location = 0) out vec4 color;

void main()
{
    color = vec4(sky_seen(pixel_ray(gl_FragCoord.xy).direction) * frame.depths_exposure.z, 0.0);
}
