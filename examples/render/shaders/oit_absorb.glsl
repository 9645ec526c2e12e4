// Passes before that of colour: where surfaces are, and what they hide.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scene.glsl"
#include "surface.glsl"
#include "oit.glsl"

layout(location = 0) flat in uint triangle;

void main()
{
    hdrp_oit_write(hdrp_oit_fragment_make(vec3(0.0), vec3(0.0), oit_surface(triangle).coverage,
                                          oit_z_view()));
}
