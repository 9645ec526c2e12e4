#version 450
// Compile: glslangValidator -V -I<folder of the headers> shade.comp -o shade.spv
#extension GL_GOOGLE_include_directive : require
#include "hdrp_brdf.h"

layout(local_size_x = 64) in;

// Buffers that C fills hold vec4 only, so that both sides agree on the layout.
layout(std430, binding = 0) readonly buffer Surfaces { vec4 surfaces[]; };
layout(std430, binding = 1) writeonly buffer Shaded { vec4 shaded[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(shaded.length())) {
        return;
    }
    hdrp_brdf_surface surface = hdrp_brdf_surface_default();
    surface.base_color = surfaces[2u * i].xyz;
    surface.metallic = surfaces[2u * i].w;
    surface.normal = surfaces[2u * i + 1u].xyz;

    hdrp_brdf_data data = hdrp_brdf_data_from_surface(surface);
    shaded[i] = hdrp_v4_from_v3(data.diffuse_color, hdrp_saturate(data.normal.y));
}
