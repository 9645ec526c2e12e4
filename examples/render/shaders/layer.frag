#version 450
// Transparent surfaces, from back to front: pass_layers.c, with what is behind looked up in the
// opaque picture.
#extension GL_GOOGLE_include_directive : require
#include "forward.glsl"
#include "sky.glsl"

layout(set = 2, binding = 14) uniform sampler2D opaque;
layout(location = 0, index = 0) out vec4 color;
layout(location = 0, index = 1) out vec4 through;

// Where the picture shows a place; outside of [0,1] where it does not.
vec2 place_of(vec3 position)
{
    vec3 d = position - frame.eye_step.xyz;
    float depth = is_orthographic() ? 1.0 : dot(d, frame.forward_orthographic.xyz);
    vec2 at = vec2(dot(d, frame.right_half_width.xyz) / (depth * frame.right_half_width.w),
                   -dot(d, frame.up_half_height.xyz) / (depth * frame.up_half_height.w));
    return 0.5 + 0.5 * at + (0.5 - frame.jitter_size.xy) / frame.jitter_size.zw;
}

// What light that a volume bends comes from.
vec3 behind(Surface s, hdrp_brdf_data data, hdrp_lit_surface lit)
{
    vec2 at = place_of(s.position + lit.transmitted_direction * data.volume_thickness_m);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) {
        return hdrp_i_sky_specular(lit.transmitted_direction,
                                   lit.transmitted_perceptual_roughness) *
               frame.depths_exposure.z;
    }
    return textureLod(opaque, at, 0.0).xyz;
}

void main()
{
    Surface s = surface_at(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    hdrp_brdf_data data = engine_data(s);
    hdrp_lit_surface lit = lit_surface(s, data);
    vec3 light = (lit.diffuse + lit.specular + emission_nits(s)) * frame.depths_exposure.z;
    vec3 passing = lit.transmitted_weight;
    if (data.volume_thickness_m > 0.0 && hdrp_v3_max_component(passing) > 0.0) {
        light += passing * behind(s, data, lit);
        passing = vec3(0.0);
    }
    color = vec4(light * s.alpha, s.alpha);
    through = vec4(vec3(1.0 - s.alpha) + passing * s.alpha, 1.0 - s.alpha);
}
