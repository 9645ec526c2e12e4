// Where things are in the opaque picture.
layout(set = 2, binding = 16) uniform texture2D depths;

#define BLUR_PER_ALPHA 1.4

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

// Pixels across which a lobe of a layer sees the surface behind it.
float blur_radius(float distance_m, float perceptual_roughness)
{
    float pixel = 2.0 * frame.up_half_height.w / frame.jitter_size.w;
    float behind = max(1.0 - distance_m / opaque_distance(gl_FragCoord.xy), 0.0);
    return BLUR_PER_ALPHA * hdrp_sq(perceptual_roughness) * behind / pixel;
}
