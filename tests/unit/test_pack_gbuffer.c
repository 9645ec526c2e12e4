/* test_pack_gbuffer.c - the GBuffer, the normal buffer and the SSS buffer.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_pack.h"

#define BOTH (HDRP_PACK_GBUFFER_RT4 | HDRP_PACK_GBUFFER_RT5)

static const hdrp_u32 variant_features[] = {
    0u,
    HDRP_BRDF_FEATURE_SUBSURFACE,
    HDRP_BRDF_FEATURE_TRANSMISSION,
    HDRP_BRDF_FEATURE_SUBSURFACE | HDRP_BRDF_FEATURE_TRANSMISSION,
    HDRP_BRDF_FEATURE_ANISOTROPY,
    HDRP_BRDF_FEATURE_IRIDESCENCE,
};
#define VARIANTS 6

static hdrp_u32 random_state = 1u;

static hdrp_u32 random_bits(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state;
}

static float random_unit(void)
{
    return hdrp_f32_from_u32(random_bits() >> 8u) * 0x1p-24f;
}

static float random_signed(void)
{
    return 2.0f * random_unit() - 1.0f;
}

static hdrp_v3 random_v3(void)
{
    return hdrp_v3_make(random_unit(), random_unit(), random_unit());
}

static hdrp_brdf_data random_material(hdrp_u32 features)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.base_color = random_v3();
    s.metallic = random_unit();
    s.perceptual_roughness = random_unit();
    s.normal = hdrp_v3_make(random_signed(), random_signed(), random_signed());
    s.tangent = hdrp_v3_make(random_signed(), random_signed(), random_signed());
    s.ambient_occlusion = random_unit();
    s.specular_occlusion = random_unit();
    s.anisotropy = random_signed();
    s.coat_mask = random_unit();
    s.coat_normal = s.normal;
    s.film_mask = random_unit();
    s.film_ior = 1.0f + 2.0f * random_unit();
    s.film_thickness_nm = 3000.0f * random_unit();
    s.subsurface_mask = random_unit();
    s.diffusion_profile = random_bits() & 15u;
    s.thickness = random_unit();
    s.features = features;
    return hdrp_brdf_data_from_surface(s);
}

static hdrp_pack_gbuffer_extra random_extra(hdrp_u32 targets)
{
    hdrp_pack_gbuffer_extra e;
    e.emissive = hdrp_v3_scale(random_v3(), 100.0f);
    e.static_diffuse = hdrp_v3_scale(random_v3(), 100.0f);
    e.specular_occlusion_data = hdrp_v2_make(random_unit(), random_unit());
    e.light_layers = random_bits() & 255u;
    e.shadow_masks = hdrp_v4_from_v3(random_v3(), random_unit());
    e.targets = targets;
    return e;
}

static hdrp_pack_gbuffer_texel texel_of(hdrp_brdf_data d, hdrp_pack_gbuffer_extra e)
{
    return hdrp_pack_gbuffer_texel_from_targets(hdrp_pack_gbuffer_encode(d, e));
}

static int same_texels(hdrp_pack_gbuffer_texel a, hdrp_pack_gbuffer_texel b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static int is_near(float a, float b, float tolerance)
{
    return fabsf(a - b) <= tolerance;
}

static int is_near_v3(hdrp_v3 a, hdrp_v3 b, float tolerance)
{
    return is_near(a.x, b.x, tolerance) && is_near(a.y, b.y, tolerance) &&
           is_near(a.z, b.z, tolerance);
}

/* Every field of every variant comes back within the resolution of its code. */
static void every_variant_returns_what_it_stores(void** state)
{
    (void)state;
    for (int i = 0; i < 60000; ++i) {
        hdrp_u32 variant = (hdrp_u32)(i % VARIANTS);
        hdrp_brdf_data d =
            random_material(variant_features[variant] | HDRP_BRDF_FEATURE_CLEAR_COAT);
        hdrp_pack_gbuffer_texel t = texel_of(d, random_extra(BOTH));
        hdrp_brdf_data m = hdrp_pack_gbuffer_decode(hdrp_pack_gbuffer_targets_from_texel(t), BOTH);
        hdrp_u32 coat = (t.rt2 >> 24u) & 31u;
        assert_int_equal(m.features,
                         variant_features[variant] | (coat ? HDRP_BRDF_FEATURE_CLEAR_COAT : 0u));
        assert_true(is_near_v3(m.normal, d.normal, 1.1e-3f));
        assert_true(is_near(m.perceptual_roughness, d.perceptual_roughness, 0.00197f));
        assert_true(is_near(m.coat_mask, d.coat_mask, 0.0162f));
        assert_true(is_near(m.ambient_occlusion, d.ambient_occlusion, 0.00197f));
        assert_true(is_near(m.specular_occlusion, d.specular_occlusion, 0.00197f));
        assert_true(m.coat_perceptual_roughness == HDRP_BRDF_COAT_PERCEPTUAL_ROUGHNESS);
        assert_true(is_near_v3(m.coat_normal, m.normal, 0.0f));
        if (variant == 0) {
            /* The steepest part of the sRGB curve turns half a code into 0.0045. */
            assert_true(is_near_v3(m.diffuse_color, d.diffuse_color, 0.0046f));
            assert_true(is_near_v3(m.fresnel0, d.fresnel0, 0.0046f));
        } else if (variant < 4) {
            assert_true(is_near_v3(m.diffuse_color, d.diffuse_color, 0.0046f));
            assert_true(is_near_v3(m.fresnel0, hdrp_v3_splat(0.04f), 0.0f));
            assert_true(is_near(m.thickness, d.thickness, 0.00197f));
            assert_int_equal(m.diffusion_profile, d.diffusion_profile);
            assert_true(
                is_near(m.subsurface_mask, variant == 2 ? 0.0f : d.subsurface_mask, 0.0334f));
        } else {
            assert_true(is_near_v3(m.base_color, d.base_color, 0.0046f));
            assert_true(is_near(m.metallic, d.metallic, 0.0162f));
            assert_true(is_near_v3(m.diffuse_color, d.diffuse_color, 0.021f));
            assert_true(is_near_v3(m.fresnel0, d.fresnel0, 0.021f));
        }
        if (variant == 4) {
            assert_true(is_near(m.anisotropy, d.anisotropy, 0.00394f));
            assert_true(fabsf(hdrp_v3_dot(m.tangent, d.tangent)) > 0.99999f);
            assert_true(fabsf(hdrp_v3_dot(m.bitangent, d.bitangent)) > 0.99999f);
        } else if (variant == 5) {
            assert_true(is_near(m.film_ior, d.film_ior, 0.00788f));
            assert_true(
                is_near(m.film_thickness_nm * m.film_ior, d.film_thickness_nm * d.film_ior, 23.8f));
            assert_true(is_near(m.film_mask, d.film_mask, 0.0715f));
        }
    }
}

static void encoding_what_was_decoded_gives_the_same_texels(void** state)
{
    (void)state;
    for (int i = 0; i < 60000; ++i) {
        hdrp_u32 targets = i & 64 ? BOTH : 0u;
        hdrp_brdf_data d = random_material(variant_features[i % VARIANTS] |
                                           (i & 32 ? HDRP_BRDF_FEATURE_CLEAR_COAT : 0u));
        hdrp_pack_gbuffer_texel t = texel_of(d, random_extra(targets));
        hdrp_pack_gbuffer g = hdrp_pack_gbuffer_targets_from_texel(t);
        assert_true(same_texels(t, hdrp_pack_gbuffer_texel_from_targets(g)));
        hdrp_brdf_data m = hdrp_pack_gbuffer_decode(g, targets);
        hdrp_pack_gbuffer_texel u = texel_of(m, hdrp_pack_gbuffer_decode_extra(g, targets));
        /* On the outer edge of the octahedral square two codes are the same normal. */
        hdrp_v3 n = hdrp_pack_normal_buffer_decode(hdrp_pack_v4_from_rgba8(u.rt1)).normal;
        assert_true(n.x == m.normal.x && n.y == m.normal.y && n.z == m.normal.z);
        assert_int_equal(u.rt1 >> 24u, t.rt1 >> 24u);
        u.rt1 = t.rt1;
        assert_true(same_texels(t, u));
    }
}

static int in_unit(float x)
{
    return x >= 0.0f && x <= 1.0f;
}

static int in_unit_v3(hdrp_v3 v)
{
    return in_unit(v.x) && in_unit(v.y) && in_unit(v.z);
}

static void expect_valid(hdrp_brdf_data d)
{
    assert_true(in_unit_v3(d.diffuse_color) && in_unit_v3(d.fresnel0) && in_unit_v3(d.base_color));
    assert_true(in_unit(d.metallic) && in_unit(d.perceptual_roughness));
    assert_true(is_near(hdrp_v3_dot(d.normal, d.normal), 1.0f, 1e-6f));
    assert_true(is_near(hdrp_v3_dot(d.tangent, d.tangent), 1.0f, 1e-6f));
    assert_true(is_near(hdrp_v3_dot(d.tangent, d.normal), 0.0f, 1e-6f));
    assert_true(is_near_v3(hdrp_v3_cross(d.normal, d.tangent), d.bitangent, 1e-6f));
    assert_true(is_near(hdrp_v3_dot(d.coat_normal, d.coat_normal), 1.0f, 1e-6f));
    assert_true(in_unit(d.ambient_occlusion) && in_unit(d.specular_occlusion));
    assert_true(d.anisotropy >= -1.0f && d.anisotropy <= 1.0f);
    assert_true(in_unit(d.coat_mask) && in_unit(d.coat_perceptual_roughness));
    assert_true(in_unit(d.film_mask) && d.film_ior >= 1.0f && d.film_ior <= 3.0f);
    assert_true(d.film_thickness_nm >= 0.0f && d.film_thickness_nm <= 3000.0f);
    assert_true(in_unit(d.subsurface_mask) && d.diffusion_profile < 16u && in_unit(d.thickness));
    assert_true(in_unit_v3(d.transmittance) && in_unit(d.transmission) && d.ior == 1.5f);
    assert_int_equal(d.features & ~31u, 0);
}

static void any_bit_pattern_decodes_to_valid_data(void** state)
{
    (void)state;
    for (int i = 0; i < 200000; ++i) {
        hdrp_pack_gbuffer_texel t = {random_bits(), random_bits(), random_bits(),
                                     random_bits(), random_bits(), random_bits()};
        hdrp_pack_gbuffer g = hdrp_pack_gbuffer_targets_from_texel(t);
        hdrp_brdf_data d = hdrp_pack_gbuffer_decode(g, random_bits());
        hdrp_pack_gbuffer_extra e = hdrp_pack_gbuffer_decode_extra(g, BOTH);
        expect_valid(d);
        assert_true(e.static_diffuse.x >= 0.0f && e.static_diffuse.x <= 64512.0f);
        assert_true(e.static_diffuse.z >= 0.0f && e.static_diffuse.z <= 64512.0f);
        assert_true(e.light_layers < 256u);
        /* One pass makes it canonical; the second changes nothing. */
        hdrp_pack_gbuffer_texel u = texel_of(d, e);
        hdrp_pack_gbuffer h = hdrp_pack_gbuffer_targets_from_texel(u);
        assert_true(same_texels(u, texel_of(hdrp_pack_gbuffer_decode(h, BOTH),
                                            hdrp_pack_gbuffer_decode_extra(h, BOTH))));
    }
}

/* Struct members that a walk over floats can reach: all but the trailing integers. */
static float any_float(void)
{
    const float special[] = {NAN,  INFINITY, -INFINITY, 0.0f,         -0.0f,
                             1.0f, -1.0f,    1e-45f,    HDRP_FLT_MAX, -HDRP_FLT_MAX};
    hdrp_u32 k = random_bits();
    return k % 3u == 0u ? special[(k >> 8u) % 10u] : hdrp_f32_from_bits(random_bits());
}

static hdrp_v3 any_v3(void)
{
    return hdrp_v3_make(any_float(), any_float(), any_float());
}

static hdrp_v4 any_v4(void)
{
    return hdrp_v4_from_v3(any_v3(), any_float());
}

static hdrp_brdf_data any_material(void)
{
    hdrp_brdf_data d = random_material(0u);
    d.diffuse_color = any_v3();
    d.fresnel0 = any_v3();
    d.base_color = any_v3();
    d.metallic = any_float();
    d.perceptual_roughness = any_float();
    d.normal = any_v3();
    d.tangent = any_v3();
    d.bitangent = any_v3();
    d.ambient_occlusion = any_float();
    d.specular_occlusion = any_float();
    d.anisotropy = any_float();
    d.coat_mask = any_float();
    d.film_mask = any_float();
    d.film_ior = any_float();
    d.film_thickness_nm = any_float();
    d.subsurface_mask = any_float();
    d.diffusion_profile = random_bits();
    d.thickness = any_float();
    d.features = random_bits();
    return d;
}

static void expect_targets(hdrp_v4 v)
{
    assert_true(in_unit_v3(hdrp_v3_from_v4(v)) && in_unit(v.w));
}

static void any_material_encodes_to_valid_targets(void** state)
{
    (void)state;
    for (int i = 0; i < 200000; ++i) {
        hdrp_pack_gbuffer_extra e;
        e.emissive = any_v3();
        e.static_diffuse = any_v3();
        e.specular_occlusion_data = hdrp_v2_make(any_float(), any_float());
        e.light_layers = random_bits();
        e.shadow_masks = any_v4();
        e.targets = random_bits();
        hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(any_material(), e);
        expect_targets(g.rt0);
        expect_targets(g.rt1);
        expect_targets(g.rt2);
        expect_targets(g.rt4);
        expect_targets(g.rt5);
        assert_true(g.rt3.x >= 0.0f && g.rt3.x <= 64512.0f);
        assert_true(g.rt3.y >= 0.0f && g.rt3.y <= 64512.0f);
        assert_true(g.rt3.z >= 0.0f && g.rt3.z <= 64512.0f);
        g.rt0 = any_v4();
        g.rt1 = any_v4();
        g.rt2 = any_v4();
        g.rt3 = any_v3();
        g.rt4 = any_v4();
        expect_valid(hdrp_pack_gbuffer_decode(g, random_bits()));
    }
}

/* A target may store a value one unit in the last place off, or multiply less precisely: whatever
 * stays within a tenth of a code changes no integer. */
static void small_errors_of_the_hardware_change_no_integer(void** state)
{
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_brdf_data d =
            random_material(variant_features[i % VARIANTS] | HDRP_BRDF_FEATURE_CLEAR_COAT);
        hdrp_pack_gbuffer_extra e = random_extra(BOTH);
        hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(d, e);
        float off = (i & 1 ? 0.1f : -0.1f) / 255.0f;
        hdrp_u32 rt1 = hdrp_pack_rgba8_from_v4(g.rt1), rt2 = hdrp_pack_rgba8_from_v4(g.rt2);
        g.rt1 = hdrp_v4_make(g.rt1.x + off, g.rt1.y + off, g.rt1.z + off, g.rt1.w);
        /* Blue holds two numbers in every variant but Standard. */
        g.rt2.z += i % VARIANTS != 0 ? off : 0.0f;
        g.rt2.w += off;
        g.rt4.w += off;
        assert_int_equal(hdrp_pack_rgba8_from_v4(g.rt1), rt1);
        assert_int_equal(hdrp_pack_rgba8_from_v4(g.rt2), rt2);
        assert_int_equal(hdrp_pack_gbuffer_decode_extra(g, BOTH).light_layers, e.light_layers);
    }
}

static void classification_reads_nothing_but_rt2(void** state)
{
    (void)state;
    for (hdrp_u32 alpha = 0; alpha < 256u; ++alpha) {
        hdrp_u32 variant = alpha >> 5u;
        hdrp_u32 expected = variant < VARIANTS ? variant_features[variant] : 0u;
        expected |= alpha & 31u ? HDRP_BRDF_FEATURE_CLEAR_COAT : 0u;
        assert_int_equal(hdrp_pack_gbuffer_texel_features((alpha << 24u) | 0x123456u), expected);
        hdrp_v4 rt2 = hdrp_pack_v4_from_rgba8(alpha << 24u);
        assert_int_equal(hdrp_pack_gbuffer_features(rt2), expected);
    }
    assert_int_equal(hdrp_pack_gbuffer_features(hdrp_v4_make(0.0f, 0.0f, 0.0f, NAN)), 0);
}

static void the_free_variants_decode_as_standard(void** state)
{
    (void)state;
    hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(random_material(0u), random_extra(0u));
    hdrp_brdf_data standard = hdrp_pack_gbuffer_decode(g, 0u);
    for (hdrp_u32 variant = 6; variant < 8u; ++variant) {
        g.rt2.w = hdrp_pack_float_uint(0.0f, variant, 3u, 8u);
        hdrp_brdf_data d = hdrp_pack_gbuffer_decode(g, 0u);
        assert_memory_equal(&d, &standard, sizeof d);
    }
}

static void exclusive_features_are_chosen_as_stated(void** state)
{
    (void)state;
    hdrp_pack_gbuffer_extra e = random_extra(0u);
    for (hdrp_u32 features = 0; features < 64u; ++features) {
        hdrp_u32 stored = features & 3u ? features & 3u : features & 4u ? 4u : features & 8u;
        hdrp_brdf_data d = random_material(features);
        d.coat_mask = 1.0f;
        hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(d, e);
        assert_int_equal(hdrp_pack_gbuffer_features(g.rt2), stored | (features & 16u));
    }
}

static hdrp_brdf_data fitting(hdrp_u32 features)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.features = features;
    return hdrp_brdf_data_from_surface(s);
}

/* What is lost is what differs by more than half a code of 8 bits, 0.002, or by 1e-3 rad. */
static void differences_below_the_resolution_are_no_losses(void** state)
{
    const float times[] = {0.9997f, 1.0003f};
    (void)state;
    for (hdrp_u32 above = 0u; above < 2u; ++above) {
        hdrp_brdf_data d = fitting(HDRP_BRDF_FEATURE_ANISOTROPY);
        d.fresnel0.y += times[above] * 0.002f;
        assert_int_equal(hdrp_pack_gbuffer_losses(d), above * HDRP_PACK_GBUFFER_LOSS_COLOR);
        d = fitting(HDRP_BRDF_FEATURE_ANISOTROPY);
        d.diffuse_color = hdrp_v3_splat(times[above] * 0.002f);
        d.base_color = hdrp_v3_splat(0.0f);
        assert_int_equal(hdrp_pack_gbuffer_losses(d), above * HDRP_PACK_GBUFFER_LOSS_COLOR);
        d = fitting(HDRP_BRDF_FEATURE_CLEAR_COAT);
        d.coat_normal.x += times[above] * 0.001f;
        assert_int_equal(hdrp_pack_gbuffer_losses(d), above * HDRP_PACK_GBUFFER_LOSS_COAT_NORMAL);
        d = fitting(HDRP_BRDF_FEATURE_CLEAR_COAT);
        d.coat_perceptual_roughness = 0.03f - times[above] * 0.002f;
        assert_int_equal(hdrp_pack_gbuffer_losses(d),
                         above * HDRP_PACK_GBUFFER_LOSS_COAT_ROUGHNESS);
    }
}

static void nothing_is_in_shadow_where_no_mask_is_stored(void** state)
{
    (void)state;
    hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(fitting(0u), random_extra(0u));
    hdrp_v4 m = hdrp_pack_gbuffer_decode_extra(g, 0u).shadow_masks;
    assert_true(m.x == 1.0f && m.y == 1.0f && m.z == 1.0f && m.w == 1.0f);
}

static void losses_are_told(void** state)
{
    (void)state;
    for (int v = 0; v < VARIANTS; ++v) {
        hdrp_brdf_data d = fitting(variant_features[v]);
        assert_int_equal(hdrp_pack_gbuffer_losses(d), 0);
        assert_int_equal(hdrp_pack_gbuffer_supports(d), 1);
        d.coat_perceptual_roughness = 0.5f;
        d.coat_normal = hdrp_v3_make(1.0f, 0.0f, 0.0f);
        assert_int_equal(hdrp_pack_gbuffer_losses(d), 0); /* without a coat these do not matter */
        d.features |= HDRP_BRDF_FEATURE_CLEAR_COAT;
        assert_int_equal(hdrp_pack_gbuffer_losses(d), HDRP_PACK_GBUFFER_LOSS_COAT_NORMAL |
                                                          HDRP_PACK_GBUFFER_LOSS_COAT_ROUGHNESS);
        d = fitting(variant_features[v] | HDRP_BRDF_FEATURE_REFRACTION);
        assert_int_equal(hdrp_pack_gbuffer_losses(d), HDRP_PACK_GBUFFER_LOSS_REFRACTION);
        assert_int_equal(hdrp_pack_gbuffer_supports(d), 0);
        d = fitting(variant_features[v]);
        d.fresnel0 = hdrp_v3_splat(0.2f); /* no dielectric of IOR 1.5 */
        assert_int_equal(hdrp_pack_gbuffer_losses(d), v == 0 ? 0u : HDRP_PACK_GBUFFER_LOSS_COLOR);
    }
    assert_int_equal(hdrp_pack_gbuffer_losses(
                         fitting(HDRP_BRDF_FEATURE_ANISOTROPY | HDRP_BRDF_FEATURE_IRIDESCENCE)),
                     HDRP_PACK_GBUFFER_LOSS_FEATURE);
    assert_int_equal(hdrp_pack_gbuffer_losses(
                         fitting(HDRP_BRDF_FEATURE_ANISOTROPY | HDRP_BRDF_FEATURE_SUBSURFACE)),
                     HDRP_PACK_GBUFFER_LOSS_FEATURE);
}

static void occlusion_darkens_baked_light_only_without_rt4(void** state)
{
    (void)state;
    hdrp_brdf_data d = fitting(0u);
    d.ambient_occlusion = 0.5f;
    hdrp_pack_gbuffer_extra e = random_extra(0u);
    e.emissive = hdrp_v3_make(1.0f, 2.0f, 0.0f);
    e.static_diffuse = hdrp_v3_make(8.0f, 0.0f, 4.0f);
    hdrp_v3 rt3 = hdrp_pack_gbuffer_encode(d, e).rt3;
    assert_true(rt3.x == 5.0f && rt3.y == 2.0f && rt3.z == 2.0f);
    e.targets = HDRP_PACK_GBUFFER_RT4;
    hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(d, e);
    assert_true(g.rt3.x == 9.0f && g.rt3.y == 2.0f && g.rt3.z == 4.0f);
    assert_true(hdrp_pack_gbuffer_decode(g, e.targets).ambient_occlusion == 0.5f);
    assert_true(hdrp_pack_gbuffer_decode(g, 0u).ambient_occlusion == 1.0f);
}

static void forward_passes_write_the_same_buffers(void** state)
{
    (void)state;
    for (int i = 0; i < 1000; ++i) {
        hdrp_brdf_data d = random_material(HDRP_BRDF_FEATURE_SUBSURFACE);
        hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(d, random_extra(0u));
        hdrp_pack_sss s = {d.diffuse_color, d.diffusion_profile, d.subsurface_mask};
        hdrp_v4 normal = hdrp_pack_normal_buffer_encode(d.normal, d.perceptual_roughness);
        hdrp_v4 sss = hdrp_pack_sss_buffer_encode(s);
        assert_memory_equal(&g.rt1, &normal, sizeof normal);
        assert_memory_equal(&g.rt0, &sss, sizeof sss);
        /* Lighting reads profile and mask from RT2, the filter from RT0. */
        assert_true(g.rt2.z == g.rt0.w);
        hdrp_pack_sss back = hdrp_pack_sss_buffer_decode(sss);
        hdrp_brdf_data m = hdrp_pack_gbuffer_decode(g, 0u);
        assert_true(back.diffusion_profile == m.diffusion_profile &&
                    back.subsurface_mask == m.subsurface_mask);
    }
}

/* Data that was not made from a surface may have a mask without the feature. */
static void a_mask_without_subsurface_scattering_is_not_stored(void** state)
{
    (void)state;
    for (int i = 0; i < 100; ++i) {
        hdrp_brdf_data d = random_material(HDRP_BRDF_FEATURE_TRANSMISSION);
        d.subsurface_mask = 0.1f + 0.9f * random_unit();
        hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(d, random_extra(0u));
        assert_true(hdrp_pack_sss_buffer_decode(g.rt0).subsurface_mask == 0.0f);
        assert_int_equal(hdrp_pack_sss_buffer_decode(g.rt0).diffusion_profile, d.diffusion_profile);
        assert_true(hdrp_pack_gbuffer_decode(g, 0u).subsurface_mask == 0.0f);
        d.features |= HDRP_BRDF_FEATURE_SUBSURFACE;
        g = hdrp_pack_gbuffer_encode(d, random_extra(0u));
        assert_true(hdrp_pack_sss_buffer_decode(g.rt0).subsurface_mask > 0.0f);
    }
}

static void neutral_values_are_exact(void** state)
{
    (void)state;
    hdrp_brdf_data d = fitting(HDRP_BRDF_FEATURE_ANISOTROPY);
    d.normal = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    d.perceptual_roughness = 1.0f;
    hdrp_brdf_data m = hdrp_pack_gbuffer_decode(
        hdrp_pack_gbuffer_targets_from_texel(texel_of(d, random_extra(0u))), 0u);
    assert_true(m.anisotropy == 0.0f && m.metallic == 0.0f && m.coat_mask == 0.0f);
    assert_true(m.perceptual_roughness == 1.0f && m.specular_occlusion == 1.0f);
    assert_true(m.normal.x == 0.0f && m.normal.y == 1.0f && m.normal.z == 0.0f);
    /* A cleared texel is a black Standard surface that faces +Z. */
    hdrp_pack_gbuffer_texel zero = {0u, 0u, 0u, 0u, 0u, 0u};
    m = hdrp_pack_gbuffer_decode(hdrp_pack_gbuffer_targets_from_texel(zero), 0u);
    assert_true(m.features == 0u && m.normal.z == 1.0f && m.diffuse_color.x == 0.0f);
}

/* A mask that has all features of a texel changes nothing; one that lacks some has none of them. */
static void a_mask_of_features_is_for_the_compiler(void** state)
{
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_pack_gbuffer_texel t =
            texel_of(random_material(random_bits() & 31u), random_extra(BOTH));
        hdrp_pack_gbuffer g = hdrp_pack_gbuffer_targets_from_texel(t);
        hdrp_brdf_data all = hdrp_pack_gbuffer_decode(g, BOTH), d;
        hdrp_u32 mask = random_bits() & 31u;
        d = hdrp_pack_gbuffer_decode_features(g, BOTH, all.features | mask);
        assert_memory_equal(&d, &all, sizeof d);
        d = hdrp_pack_gbuffer_decode_features(g, BOTH, mask);
        assert_int_equal(d.features, all.features & mask);
        expect_valid(d);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_variant_returns_what_it_stores),
        cmocka_unit_test(encoding_what_was_decoded_gives_the_same_texels),
        cmocka_unit_test(any_bit_pattern_decodes_to_valid_data),
        cmocka_unit_test(any_material_encodes_to_valid_targets),
        cmocka_unit_test(small_errors_of_the_hardware_change_no_integer),
        cmocka_unit_test(classification_reads_nothing_but_rt2),
        cmocka_unit_test(the_free_variants_decode_as_standard),
        cmocka_unit_test(exclusive_features_are_chosen_as_stated),
        cmocka_unit_test(differences_below_the_resolution_are_no_losses),
        cmocka_unit_test(nothing_is_in_shadow_where_no_mask_is_stored),
        cmocka_unit_test(losses_are_told),
        cmocka_unit_test(occlusion_darkens_baked_light_only_without_rt4),
        cmocka_unit_test(forward_passes_write_the_same_buffers),
        cmocka_unit_test(a_mask_without_subsurface_scattering_is_not_stored),
        cmocka_unit_test(neutral_values_are_exact),
        cmocka_unit_test(a_mask_of_features_is_for_the_compiler),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
