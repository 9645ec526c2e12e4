#version 450
// Where the light behind transparent surfaces comes from: pass_layers.c, in sums and products that
// need no order.
#extension GL_GOOGLE_include_directive : require
#include "forward.glsl"
#include "behind.glsl"

layout(location = 0) out vec4 through; // multiplied
layout(location = 1) out vec4 moved_px; // added; z: square of the radius of blur
layout(location = 2) out vec4 most;     // the larger: of 1 / distance, roughness
layout(location = 3) out vec4 direction; // of the last that bends

void main()
{
    Surface s = surface_at(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    hdrp_brdf_data data = engine_data(s);
    hdrp_lit_surface lit = lit_surface(s, data);
    bool bends = data.volume_thickness_m > 0.0;
    vec2 straight = floor(gl_FragCoord.xy) + frame.jitter_size.xy;
    vec3 source = s.position + lit.transmitted_direction * data.volume_thickness_m;
    // Coverage lets light through as it is, however rough the surface.
    float roughness = hdrp_v3_max_component(lit.transmitted_weight) > 0.0
                          ? lit.transmitted_perceptual_roughness
                          : 0.0;
    float radius = blur_radius(s.distance_m, roughness);
    through = vec4(vec3(1.0 - s.coverage) + lit.transmitted_weight * s.coverage, 1.0 - s.coverage);
    moved_px = vec4(bends ? place_of(source) - straight : vec2(0.0), radius * radius, 0.0);
    most = vec4(bends ? 1.0 / s.distance_m : 0.0, roughness, 0.0, 0.0);
    direction = vec4(bends ? lit.transmitted_direction : vec3(0.0), bends ? 1.0 : 0.0);
}
