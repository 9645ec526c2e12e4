// Detail by position, of the built-in scene: triplanar layers of surface.c, noise of noise.h.

float noise_corner(ivec3 at, vec3 d, uint period, uint seed)
{
    uint h = hdrp_hash3(uint(at.x) % period, uint(at.y) % period,
                        uint(at.z) % period + (seed << 16));
    vec3 g = vec3(float(h & 1023u), float(h >> 10 & 1023u), float(h >> 20 & 1023u)) / 511.5 - 1.0;
    return dot(g, d);
}

vec3 fade(vec3 t)
{
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

float noise_at(vec3 p, uint period, uint seed)
{
    ivec3 i = ivec3(p);
    vec3 f = p - vec3(i), k = fade(f);
    float plane[2];
    for (int z = 0; z < 2; ++z) {
        float row[2];
        for (int y = 0; y < 2; ++y) {
            vec3 d = f - vec3(0.0, float(y), float(z));
            float a = noise_corner(i + ivec3(0, y, z), d, period, seed);
            float b = noise_corner(i + ivec3(1, y, z), d - vec3(1.0, 0.0, 0.0), period, seed);
            row[y] = hdrp_lerp(a, b, k.x);
        }
        plane[z] = hdrp_lerp(row[0], row[1], k.y);
    }
    return hdrp_lerp(plane[0], plane[1], k.z);
}

vec3 layer_gradient(int layer, vec3 weights, Surface at)
{
    float strength = MATERIAL.detail[layer + 2];
    vec2 derivative[3];
    for (int i = 0; i < 3; ++i) {
        vec3 texel = texels[SAMPLE_DETAIL + 3 * (layer + 1) + i].xyz;
        derivative[i] = hdrp_derivative_from_normal(hdrp_normal_from_rgb(texel), strength);
        derivative[i].y = -derivative[i].y;
    }
    return hdrp_surface_gradient_from_triplanar(at.vertex_normal, weights, derivative[0],
                                                derivative[1], derivative[2]);
}

vec3 detail_gradient(Surface at)
{
    vec3 weights = hdrp_triplanar_weights(at.vertex_normal, 6.0);
    vec3 sum = layer_gradient(0, weights, at);
    if (MATERIAL.details.x > 1u) {
        float mask = hdrp_saturate(
            0.6 + 1.5 * noise_at(vec3(64.0) + at.position * 5.0, 1u << 20, 3u));
        sum += layer_gradient(1, weights, at) * mask;
    }
    return sum;
}

vec4 detail_base(Surface at)
{
    vec3 w = hdrp_triplanar_weights(at.vertex_normal, 6.0);
    return texels[SAMPLE_DETAIL] * w.x + texels[SAMPLE_DETAIL + 1] * w.y +
           texels[SAMPLE_DETAIL + 2] * w.z;
}
