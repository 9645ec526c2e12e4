#version 450
// The FGD table, an image of size x size texels: what hdrp_brdf_fgd_bake_rows writes, by another
// quadrature. A group makes a texel; each of its threads sums the half vectors of one azimuth.
// Visible normals map the integral to a square on which masking is a bounded factor, so that
// narrow lobes and grazing views need no more nodes than others.
// header: hdrp_gpu_vk_env.h
#extension GL_GOOGLE_include_directive : require
#include "hdrp_brdf.h"

#define AZIMUTHS 64
#define RADII    256

layout(local_size_x = AZIMUTHS) in;
layout(binding = 0) uniform writeonly image2D table; // x view, y roughness; see hdrp_brdf_fgd_uv
layout(push_constant) uniform Push { uvec4 push; };  // x size

shared vec2 sums[AZIMUTHS];

// The lobe of one azimuth: nodes gather at both ends, where the normals turn fastest.
vec2 azimuth_sum(vec3 v, float alpha, float azimuth)
{
    float smith_v = v.z + hdrp_sqrt(v.z * v.z * (1.0 - alpha * alpha) + alpha * alpha);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < RADII; ++i) {
        float x = (float(i) + 0.5) / float(RADII);
        float radius = x - hdrp_sin(HDRP_TWO_PI * x) / HDRP_TWO_PI;
        float weight = 1.0 - hdrp_cos(HDRP_TWO_PI * x);
        vec3 h = hdrp_brdf_sample_vndf(v, alpha, alpha, vec2(azimuth, radius));
        float v_dot_h = hdrp_saturate(hdrp_v3_dot(v, h));
        float n_dot_l = hdrp_saturate(2.0 * v_dot_h * h.z - v.z);
        // G2 / G1 of the viewer, of which only the part above the horizon remains.
        float g = 2.0 * hdrp_brdf_v_smith_ggx(n_dot_l, v.z, alpha) * n_dot_l * smith_v;
        sum += weight * g * vec2(1.0, hdrp_brdf_schlick_weight(v_dot_h));
    }
    return sum / float(RADII);
}

void main()
{
    uint thread = gl_LocalInvocationID.x;
    uvec2 texel = gl_WorkGroupID.xy;
    vec2 at = vec2(texel) / float(push.x - 1u);
    float n_dot_v = max(at.x * at.x, 1e-6);
    vec3 v = vec3(hdrp_sqrt((1.0 - n_dot_v) * (1.0 + n_dot_v)), 0.0, n_dot_v);
    float alpha = hdrp_brdf_alpha_from_perceptual_roughness(at.y);
    // Half a turn: the other half is its mirror image.
    sums[thread] = azimuth_sum(v, alpha, (float(thread) + 0.5) * (0.5 / float(AZIMUTHS)));
    for (uint n = AZIMUTHS / 2; n > 0u; n >>= 1) {
        barrier();
        if (thread < n) {
            sums[thread] += sums[thread + n];
        }
    }
    if (thread == 0u) {
        vec2 fgd = sums[0] / float(AZIMUTHS);
        fgd.x = hdrp_saturate(fgd.x);
        fgd.y = hdrp_clamp(fgd.y, 0.0, fgd.x);
        imageStore(table, ivec2(texel), vec4(fgd, 0.0, 0.0));
    }
}
