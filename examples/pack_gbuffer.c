/* pack_gbuffer.c - two materials through the GBuffer and back.
 * SPDX-License-Identifier: MIT
 *
 * A fragment shader writes what hdrp_pack_gbuffer_encode returns to its render targets, and the
 * lighting pass decodes what it reads from them. Between the two stands the hardware, whose
 * rounding the texel functions do on the CPU. Prints the texels and what the material lost, and
 * fails where that is more than the header promises. */
#include "hdrp_pack.h"

#include <stdio.h>

static hdrp_brdf_data brushed_copper(void)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.base_color = hdrp_v3_make(0.955f, 0.638f, 0.538f);
    s.metallic = 1.0f;
    s.perceptual_roughness = 0.35f;
    s.normal = hdrp_v3_make(0.3f, 0.8f, -0.001f); /* next to the seam of the tangent frame */
    s.tangent = hdrp_v3_make(0.7f, -0.2f, 0.6f);
    s.anisotropy = 0.8f;
    s.features = HDRP_BRDF_FEATURE_ANISOTROPY;
    return hdrp_brdf_data_from_surface(s);
}

static hdrp_brdf_data oily_plastic(void)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.base_color = hdrp_v3_make(0.02f, 0.03f, 0.05f);
    s.perceptual_roughness = 0.2f;
    s.normal = hdrp_v3_make(0.1f, 0.9f, 0.4f);
    s.coat_normal = s.normal;
    s.coat_mask = 0.5f;
    s.film_mask = 1.0f;
    s.film_ior = 1.47f;
    s.film_thickness_nm = 380.0f;
    s.features = HDRP_BRDF_FEATURE_IRIDESCENCE | HDRP_BRDF_FEATURE_CLEAR_COAT;
    return hdrp_brdf_data_from_surface(s);
}

/* Prints one quantity; 1 where it is off by more than it should be. */
static int compare(const char* name, float stored, float original, float limit)
{
    float error = stored - original;
    printf("  %-18s %10.5f -> %10.5f  error %+.5f\n", name, (double)original, (double)stored,
           (double)error);
    return error > limit || error < -limit;
}

static float degrees_between(hdrp_v3 a, hdrp_v3 b)
{
    float sine = hdrp_v3_length(hdrp_v3_cross(a, b));
    return hdrp_atan2(sine, hdrp_v3_dot(a, b)) * (180.0f / HDRP_PI);
}

static int round_trip(const char* name, hdrp_brdf_data d)
{
    hdrp_pack_gbuffer_extra extra = {
        {0.0f, 0.0f, 0.0f}, {0.4f, 0.3f, 0.2f}, {0.0f, 0.0f}, 255u, {1.0f, 1.0f, 1.0f, 1.0f}, 0u};
    hdrp_pack_gbuffer_texel t;
    hdrp_brdf_data m;
    float tangent_degrees;
    int bad = 0;

    t = hdrp_pack_gbuffer_texel_from_targets(hdrp_pack_gbuffer_encode(d, extra));
    m = hdrp_pack_gbuffer_decode(hdrp_pack_gbuffer_targets_from_texel(t), extra.targets);

    printf("%s\n  RT0 %08x  RT1 %08x  RT2 %08x  RT3 %08x\n", name, (unsigned)t.rt0, (unsigned)t.rt1,
           (unsigned)t.rt2, (unsigned)t.rt3);
    if (!hdrp_pack_gbuffer_supports(d) || m.features != d.features ||
        hdrp_pack_gbuffer_texel_features(t.rt2) != d.features) {
        printf("  does not fit\n");
        return 1;
    }
    bad += compare("normal, degrees", degrees_between(m.normal, d.normal), 0.0f, 0.0595f);
    bad += compare("roughness", m.perceptual_roughness, d.perceptual_roughness, 0.00197f);
    bad += compare("metallic", m.metallic, d.metallic, 0.0162f);
    bad += compare("F0 green", m.fresnel0.y, d.fresnel0.y, 0.005f);
    if (d.features & HDRP_BRDF_FEATURE_ANISOTROPY) {
        /* Half a turn is the same to an anisotropic highlight, and is not stored. */
        tangent_degrees = degrees_between(m.tangent, d.tangent);
        tangent_degrees = hdrp_min(tangent_degrees, 180.0f - tangent_degrees);
        bad += compare("tangent, degrees", tangent_degrees, 0.0f, 0.075f);
        bad += compare("anisotropy", m.anisotropy, d.anisotropy, 0.00394f);
    }
    if (d.features & HDRP_BRDF_FEATURE_IRIDESCENCE) {
        bad += compare("film IOR", m.film_ior, d.film_ior, 0.0079f);
        /* The thickness makes up for the rounding of the IOR. */
        bad += compare("film path, nm", m.film_ior * m.film_thickness_nm,
                       d.film_ior * d.film_thickness_nm, 23.8f);
    }
    if (d.features & HDRP_BRDF_FEATURE_CLEAR_COAT) {
        bad += compare("coat mask", m.coat_mask, d.coat_mask, 0.0162f);
    }
    return bad;
}

int main(void)
{
    int bad = round_trip("brushed copper", brushed_copper());
    bad += round_trip("oily plastic, half coated", oily_plastic());
    return bad != 0;
}
