// Engine data of a surface: lighting.c.

float filtered_alpha(float alpha, float variance)
{
    return hdrp_sq(hdrp_brdf_perceptual_roughness_filtered(hdrp_sqrt(alpha), variance));
}

hdrp_brdf_surface filter_roughness(hdrp_brdf_surface b, float variance)
{
    hdrp_brdf_alphas a;
    hdrp_brdf_kulla k;
    if ((b.features & HDRP_BRDF_FEATURE_ANISOTROPY) == 0u) {
        b.perceptual_roughness =
            hdrp_brdf_perceptual_roughness_filtered(b.perceptual_roughness, variance);
        return b;
    }
    a = hdrp_brdf_alphas_kulla(b.perceptual_roughness, b.anisotropy);
    a.t = filtered_alpha(a.t, variance);
    a.b = filtered_alpha(a.b, variance);
    k = hdrp_brdf_kulla_from_alphas(a);
    b.perceptual_roughness = k.perceptual_roughness;
    b.anisotropy = k.anisotropy;
    return b;
}

bool is_unlit()
{
    return (MATERIAL.bits.y & RD_GPU_UNLIT) != 0u;
}

// Nothing is reflected.
bool is_dark()
{
    return (MATERIAL.bits.y & (RD_GPU_UNLIT | RD_GPU_ADDITIVE)) != 0u;
}

hdrp_brdf_data black(Surface s)
{
    hdrp_brdf_surface b = hdrp_brdf_surface_default();
    b.base_color = vec3(0.0);
    b.dielectric_fresnel0 = vec3(0.0);
    b.normal = s.brdf.normal;
    return hdrp_brdf_data_from_surface(b);
}

vec3 emission_nits(Surface s)
{
    return is_unlit() ? s.brdf.base_color / frame.depths_exposure.z : s.emission_nits;
}

hdrp_brdf_data engine_data(Surface s)
{
    hdrp_brdf_surface b = s.brdf;
    if (is_dark()) {
        return black(s);
    }
    b.features &= frame.bits.y;
    if ((frame.bits.x & RD_GPU_FEATURE_NORMAL_MAPS) == 0u) {
        b.normal = b.coat_normal = s.vertex_normal;
    }
    if ((frame.bits.x & RD_GPU_FEATURE_OCCLUSION) == 0u) {
        b.ambient_occlusion = 1.0;
    }
    if ((frame.bits.x & RD_GPU_FEATURE_SPECULAR_AA) != 0u) {
        float curvature = hdrp_brdf_variance_from_derivatives(
            s.normal_dx, s.normal_dy, RD_GPU_VARIANCE_STRENGTH, RD_GPU_VARIANCE_LIMIT);
        b = filter_roughness(b, min(curvature + s.map_variance, 1.0));
        b.coat_perceptual_roughness = hdrp_brdf_perceptual_roughness_filtered(
            b.coat_perceptual_roughness, min(curvature + s.coat_map_variance, 1.0));
    }
    if ((b.features & HDRP_BRDF_FEATURE_REFRACTION) != 0u) {
        b.transmittance = hdrp_brdf_volume_transmittance(
            MATERIAL.volume.xyz, MATERIAL.optics.w, b.volume_thickness_m);
    }
    return hdrp_brdf_data_from_surface(b);
}
