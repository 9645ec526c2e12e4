#include "gbuffer.h"

#include <stdlib.h>
#include <string.h>

bool rd_gbuffer_allocate(rd_gbuffer* g, size_t pixels)
{
    g->texels = (hdrp_pack_gbuffer_texel*)malloc(pixels * sizeof *g->texels);
    g->positions = (hdrp_v3*)malloc(pixels * sizeof *g->positions);
    g->geometric_normals = (hdrp_v3*)malloc(pixels * sizeof *g->geometric_normals);
    g->kinds = (uint8_t*)malloc(pixels * sizeof *g->kinds);
    return g->texels && g->positions && g->geometric_normals && g->kinds;
}

void rd_gbuffer_free(rd_gbuffer* g)
{
    free(g->texels);
    free(g->positions);
    free(g->geometric_normals);
    free(g->kinds);
    memset(g, 0, sizeof *g);
}

hdrp_pack_gbuffer_texel rd_gbuffer_encode(hdrp_brdf_data data, hdrp_v3 emission_nits,
                                          hdrp_u32 light_layers, float exposure)
{
    hdrp_pack_gbuffer_extra e;
    e.emissive = hdrp_v3_scale(emission_nits, exposure);
    e.static_diffuse = hdrp_v3_splat(0.0f);
    e.specular_occlusion_data = hdrp_v2_make(0.0f, 0.0f);
    e.light_layers = light_layers;
    e.shadow_masks = hdrp_v4_make(1.0f, 1.0f, 1.0f, 1.0f);
    e.targets = RD_GBUFFER_TARGETS;
    return hdrp_pack_gbuffer_texel_from_targets(hdrp_pack_gbuffer_encode(data, e));
}

hdrp_brdf_data rd_gbuffer_decode(hdrp_pack_gbuffer_texel texel, const rd_scene* scene)
{
    hdrp_brdf_data d =
        hdrp_pack_gbuffer_decode(hdrp_pack_gbuffer_targets_from_texel(texel), RD_GBUFFER_TARGETS);
    if (d.features & HDRP_BRDF_FEATURE_TRANSMISSION) {
        d.transmittance = rd_slab_transmittance(scene, d.diffusion_profile, d.thickness);
    }
    return d;
}

hdrp_v3 rd_gbuffer_decode_emission(hdrp_pack_gbuffer_texel texel, float exposure)
{
    return hdrp_v3_scale(hdrp_pack_rgb_from_r11g11b10f(texel.rt3), 1.0f / exposure);
}

hdrp_u32 rd_gbuffer_decode_light_layers(hdrp_pack_gbuffer_texel texel)
{
    return hdrp_pack_gbuffer_decode_extra(hdrp_pack_gbuffer_targets_from_texel(texel),
                                          RD_GBUFFER_TARGETS)
        .light_layers;
}

hdrp_pack_gbuffer_texel rd_gbuffer_encode_normal(hdrp_brdf_data data)
{
    hdrp_pack_gbuffer_texel t;
    memset(&t, 0, sizeof t);
    t.rt1 = hdrp_pack_rgba8_from_v4(
        hdrp_pack_normal_buffer_encode(data.normal, data.perceptual_roughness));
    return t;
}

hdrp_v3 rd_gbuffer_decode_normal(hdrp_pack_gbuffer_texel texel)
{
    return hdrp_pack_normal_buffer_decode(hdrp_pack_v4_from_rgba8(texel.rt1)).normal;
}
