#version 450
// Transparent surfaces, from back to front: pass_layers.c, with what is behind looked up in the
// opaque picture.
#extension GL_GOOGLE_include_directive : require
#include "forward.glsl"
#include "sky.glsl"

layout(set = 2, binding = 14) uniform sampler2D opaque;
layout(set = 2, binding = 16) uniform texture2D depths;
layout(location = 0, index = 0) out vec4 color;
layout(location = 0, index = 1) out vec4 through;

#define BLUR_PER_ALPHA 1.4
#define BLUR_TAPS      8u
#define BLUR_LOD_BIAS  1.5

// Where the picture shows a place, in pixels.
vec2 place_of(vec3 position)
{
    vec3 d = position - frame.eye_step.xyz;
    float depth = is_orthographic() ? 1.0 : dot(d, frame.forward_orthographic.xyz);
    vec2 at = vec2(dot(d, frame.right_half_width.xyz) / (depth * frame.right_half_width.w),
                   -dot(d, frame.up_half_height.xyz) / (depth * frame.up_half_height.w));
    return (0.5 + 0.5 * at) * frame.jitter_size.zw;
}

// How far along the ray of a pixel the opaque surface is.
float opaque_distance(vec2 at)
{
    float depth = texelFetch(depths, ivec2(at), 0).x;
    float slope = dot(pixel_ray(at).direction, frame.forward_orthographic.xyz);
    if (is_orthographic()) {
        return frame.depths_exposure.y - depth * (frame.depths_exposure.y - frame.depths_exposure.x);
    }
    return depth > 0.0 ? frame.depths_exposure.x / (depth * slope) : HDRP_FLT_MAX;
}

float blur_radius(Surface s, float perceptual_roughness)
{
    float pixel = 2.0 * frame.up_half_height.w / frame.jitter_size.w;
    float background = opaque_distance(gl_FragCoord.xy);
    float behind = max(1.0 - s.distance_m / background, 0.0);
    return BLUR_PER_ALPHA * hdrp_sq(perceptual_roughness) * behind / pixel;
}

vec3 blurred(vec2 at, float radius)
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint hash = hdrp_hash2(hdrp_hash3(pixel.x, pixel.y, frame.sample_of.y), frame.sample_of.x);
    float turn = hdrp_unit_from_u32(hash) * HDRP_TWO_PI;
    float c = cos(turn), k = sin(turn);
    float lod = log2(max(radius, 1.0)) - BLUR_LOD_BIAS;
    uint taps = radius < 0.5 ? 1u : BLUR_TAPS;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < taps; ++i) {
        vec2 d = radius < 0.5 ? vec2(0.0) : hdrp_fibonacci_disk(i, BLUR_TAPS) * radius;
        vec2 to = at + vec2(c * d.x - k * d.y, k * d.x + c * d.y);
        sum += textureLod(opaque, to / frame.jitter_size.zw, taps > 1u ? max(lod, 0.0) : 0.0).xyz;
    }
    return sum / float(taps);
}

// What light that a volume bends, or a rough surface scatters, comes from.
vec3 behind(Surface s, hdrp_brdf_data data, hdrp_lit_surface lit, float radius)
{
    vec2 straight = floor(gl_FragCoord.xy) + frame.jitter_size.xy;
    vec2 at = straight;
    if (data.volume_thickness_m > 0.0) {
        at = place_of(s.position + lit.transmitted_direction * data.volume_thickness_m);
    }
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, frame.jitter_size.zw))) {
        return hdrp_i_sky_specular(lit.transmitted_direction,
                                   lit.transmitted_perceptual_roughness) *
               frame.depths_exposure.z;
    }
    // Something in front of the glass is not seen through it.
    at = opaque_distance(at) < s.distance_m ? straight : at;
    return blurred(at, radius);
}

void main()
{
    Surface s = surface_at(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    hdrp_brdf_data data = engine_data(s);
    hdrp_lit_surface lit = lit_surface(s, data);
    vec3 light = (lit.diffuse + lit.specular + emission_nits(s)) * frame.depths_exposure.z;
    vec3 passing = lit.transmitted_weight;
    if (hdrp_v3_max_component(passing) > 0.0) {
        float radius = blur_radius(s, lit.transmitted_perceptual_roughness);
        if (data.volume_thickness_m > 0.0 || radius > 0.0) {
            light += passing * behind(s, data, lit, radius);
            passing = vec3(0.0);
        }
    }
    color = vec4(light * s.alpha, s.alpha);
    through = vec4(vec3(1.0 - s.alpha) + passing * s.alpha, 1.0 - s.alpha);
}
