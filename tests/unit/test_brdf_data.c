/* test_brdf_data.c - what artists set becomes what lighting may rely on.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_brdf.h"

static void expect_v3(hdrp_v3 v, float x, float y, float z)
{
    assert_true(v.x == x && v.y == y && v.z == z);
}

static hdrp_brdf_surface surface_of(float value)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.base_color = s.dielectric_fresnel0 = s.transmittance = hdrp_v3_splat(value);
    s.normal = s.tangent = s.coat_normal = hdrp_v3_splat(value);
    s.metallic = s.perceptual_roughness = s.ambient_occlusion = s.specular_occlusion = value;
    s.anisotropy = s.coat_mask = s.coat_perceptual_roughness = s.film_mask = value;
    s.film_ior = s.film_thickness_nm = s.subsurface_mask = s.thickness = value;
    s.transmission = s.ior = s.volume_thickness_m = value;
    s.diffusion_profile = s.features = 0xffffffffu;
    return s;
}

static void the_default_surface_is_a_grey_dielectric(void** state)
{
    (void)state;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(hdrp_brdf_surface_default());
    expect_v3(d.diffuse_color, 0.5f, 0.5f, 0.5f);
    expect_v3(d.fresnel0, 0.04f, 0.04f, 0.04f);
    expect_v3(d.normal, 0.0f, 0.0f, 1.0f);
    expect_v3(d.tangent, 1.0f, 0.0f, 0.0f);
    expect_v3(d.bitangent, 0.0f, 1.0f, 0.0f);
    expect_v3(d.coat_normal, 0.0f, 0.0f, 1.0f);
    assert_true(d.perceptual_roughness == 0.5f && d.ior == 1.5f && d.features == 0u);
}

/* What a material leaves alone does not darken it, and a film is one that is seen. */
static void features_of_the_default_surface_have_usual_values(void** state)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    (void)state;
    expect_v3(s.normal, 0.0f, 0.0f, 1.0f);
    expect_v3(s.tangent, 1.0f, 0.0f, 0.0f);
    expect_v3(s.coat_normal, 0.0f, 0.0f, 1.0f);
    assert_true(s.ambient_occlusion == 1.0f && s.specular_occlusion == 1.0f);
    assert_true(s.coat_perceptual_roughness == 0.03f && s.thickness == 1.0f);
    /* The defaults of KHR_materials_iridescence: its IOR, and its thickness_maximum. */
    assert_true(s.film_ior == 1.3f && s.film_thickness_nm == 400.0f);
}

static void each_channel_of_a_dielectric_has_its_own_tint(void** state)
{
    (void)state;
    hdrp_v3 f0 = hdrp_brdf_dielectric_fresnel0(1.5f, hdrp_v3_make(0.5f, 1.0f, 2.0f), 0.5f);
    assert_true(fabsf(f0.x - 0.01f) < 1e-7f && fabsf(f0.y - 0.02f) < 1e-7f);
    assert_true(fabsf(f0.z - 0.04f) < 1e-7f);
}

static void nan_becomes_the_lower_bound(void** state)
{
    (void)state;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(surface_of(NAN));
    expect_v3(d.base_color, 0.0f, 0.0f, 0.0f);
    expect_v3(d.fresnel0, 0.0f, 0.0f, 0.0f);
    expect_v3(d.normal, 0.0f, 0.0f, 1.0f);
    expect_v3(d.coat_normal, 0.0f, 0.0f, 1.0f);
    expect_v3(d.transmittance, 0.0f, 0.0f, 0.0f);
    assert_true(d.metallic == 0.0f && d.perceptual_roughness == 0.0f && d.anisotropy == -1.0f);
    assert_true(d.ambient_occlusion == 0.0f && d.specular_occlusion == 0.0f);
    assert_true(d.coat_mask == 0.0f && d.coat_perceptual_roughness == 0.0f);
    assert_true(d.film_mask == 0.0f && d.film_ior == 1.0f && d.film_thickness_nm == 0.0f);
    assert_true(d.subsurface_mask == 0.0f && d.thickness == 0.0f);
    assert_true(d.transmission == 0.0f && d.ior == 1.0f);
}

static void huge_values_are_limited(void** state)
{
    (void)state;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(surface_of(HDRP_FLT_MAX));
    expect_v3(d.diffuse_color, 0.0f, 0.0f, 0.0f);
    expect_v3(d.fresnel0, 1.0f, 1.0f, 1.0f);
    assert_true(d.anisotropy == 1.0f && d.film_ior == 3.0f && d.film_thickness_nm == 3000.0f);
    assert_true(d.diffusion_profile == 15u && d.features == HDRP_BRDF_FEATURE_ALL);
    assert_true(d.ior == 3.0f && d.volume_thickness_m == 1e6f);
    expect_v3(d.transmittance, 1.0f, 1.0f, 1.0f);
}

static void the_tangent_is_made_orthogonal(void** state)
{
    (void)state;
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.normal = hdrp_v3_make(0.0f, 4.0f, 0.0f);
    s.tangent = hdrp_v3_make(0.0f, 3.0f, 3.0f);
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    expect_v3(d.normal, 0.0f, 1.0f, 0.0f);
    assert_true(fabsf(d.tangent.x) < 1e-6f && fabsf(d.tangent.y) < 1e-6f);
    assert_true(fabsf(d.tangent.z - 1.0f) < 1e-6f && fabsf(d.bitangent.x - 1.0f) < 1e-6f);
}

static void a_tangent_along_the_normal_is_replaced(void** state)
{
    (void)state;
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.normal = hdrp_v3_make(1.0f, 2.0f, -3.0f);
    s.tangent = hdrp_v3_make(-2.0f, -4.0f, 6.0f);
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    assert_true(fabsf(hdrp_v3_dot(d.normal, d.tangent)) < 1e-6f);
    assert_true(fabsf(hdrp_v3_length(d.tangent) - 1.0f) < 1e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_default_surface_is_a_grey_dielectric),
        cmocka_unit_test(features_of_the_default_surface_have_usual_values),
        cmocka_unit_test(each_channel_of_a_dielectric_has_its_own_tint),
        cmocka_unit_test(nan_becomes_the_lower_bound),
        cmocka_unit_test(huge_values_are_limited),
        cmocka_unit_test(the_tangent_is_made_orthogonal),
        cmocka_unit_test(a_tangent_along_the_normal_is_replaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
