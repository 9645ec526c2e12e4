// The ray through the sample of a pixel, and what changes to the next pixel: camera.c.
struct Ray {
    vec3 origin;
    vec3 direction;
    vec3 origin_dx, origin_dy;
    vec3 direction_dx, direction_dy;
};

vec3 normalized_derivative(vec3 d, vec3 change)
{
    float size = hdrp_v3_length(d);
    vec3 unit = d / size;
    return (change - unit * dot(unit, change)) / size;
}

// Through a place in the picture, for a sample of some pixels.
Ray sample_ray(vec2 at, float pixels)
{
    vec2 s = vec2(2.0 * at.x / frame.jitter_size.z - 1.0, 1.0 - 2.0 * at.y / frame.jitter_size.w);
    vec3 right = frame.right_half_width.xyz * frame.right_half_width.w;
    vec3 up = frame.up_half_height.xyz * frame.up_half_height.w;
    vec3 on_plane = right * s.x + up * s.y;
    vec3 forward = frame.forward_orthographic.xyz;
    vec3 dx = right * (2.0 / frame.jitter_size.z) * (frame.eye_step.w * pixels);
    vec3 dy = -up * (2.0 / frame.jitter_size.w) * (frame.eye_step.w * pixels);
    Ray r;
    if (is_orthographic()) {
        r.origin = frame.eye_step.xyz + on_plane;
        r.direction = forward;
        r.origin_dx = dx;
        r.origin_dy = dy;
        r.direction_dx = r.direction_dy = vec3(0.0);
    } else {
        r.origin = frame.eye_step.xyz;
        r.direction = hdrp_v3_normalize(forward + on_plane);
        r.origin_dx = r.origin_dy = vec3(0.0);
        r.direction_dx = normalized_derivative(forward + on_plane, dx);
        r.direction_dy = normalized_derivative(forward + on_plane, dy);
    }
    return r;
}

// Through the sample of a pixel.
Ray pixel_ray(vec2 pixel)
{
    return sample_ray(floor(pixel) + frame.jitter_size.xy, 1.0);
}
