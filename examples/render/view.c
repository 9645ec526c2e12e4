#include "view.h"

#include <stddef.h>
#include <string.h>

static const struct {
    const char* name;
    rd_encoding encoding;
    rd_view_stage stage;
} views[RD_VIEW_COUNT] = {
    [RD_VIEW_LIT] = {"lit", RD_ENCODE_LIT, RD_STAGE_LIGHTING},
    [RD_VIEW_BASE_COLOR] = {"base_color", RD_ENCODE_COLOR, RD_STAGE_MATERIAL},
    [RD_VIEW_NORMAL] = {"normal", RD_ENCODE_SIGNED, RD_STAGE_MATERIAL},
    [RD_VIEW_GEOMETRIC_NORMAL] = {"geometric_normal", RD_ENCODE_SIGNED, RD_STAGE_MATERIAL},
    [RD_VIEW_VERTEX_NORMAL] = {"vertex_normal", RD_ENCODE_SIGNED, RD_STAGE_MATERIAL},
    [RD_VIEW_TANGENT] = {"tangent", RD_ENCODE_SIGNED, RD_STAGE_MATERIAL},
    [RD_VIEW_UV] = {"uv", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_ROUGHNESS] = {"roughness", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_METALLIC] = {"metallic", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_F0] = {"f0", RD_ENCODE_COLOR, RD_STAGE_MATERIAL},
    [RD_VIEW_DEPTH] = {"depth", RD_ENCODE_DISTANCE, RD_STAGE_MATERIAL},
    [RD_VIEW_FEATURES] = {"features", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_MATERIAL] = {"material", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_ALPHA] = {"alpha", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_EMISSION] = {"emission", RD_ENCODE_COLOR, RD_STAGE_MATERIAL},
    [RD_VIEW_OCCLUSION] = {"occlusion", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_COAT] = {"coat", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_ANISOTROPY] = {"anisotropy", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_FILM] = {"film", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_TRANSMISSION] = {"transmission", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_LAYERS] = {"layers", RD_ENCODE_DATA, RD_STAGE_MATERIAL},
    [RD_VIEW_DIFFUSE] = {"diffuse", RD_ENCODE_LIT, RD_STAGE_LIGHTING},
    [RD_VIEW_SPECULAR] = {"specular", RD_ENCODE_LIT, RD_STAGE_LIGHTING},
    [RD_VIEW_AO] = {"ao", RD_ENCODE_DATA, RD_STAGE_GBUFFER},
    [RD_VIEW_PATH] = {"path", RD_ENCODE_DATA, RD_STAGE_GBUFFER},
    [RD_VIEW_RT0] = {"rt0", RD_ENCODE_COLOR, RD_STAGE_GBUFFER},
    [RD_VIEW_RT1] = {"rt1", RD_ENCODE_DATA, RD_STAGE_GBUFFER},
    [RD_VIEW_RT2] = {"rt2", RD_ENCODE_DATA, RD_STAGE_GBUFFER},
    [RD_VIEW_RT3] = {"rt3", RD_ENCODE_COLOR, RD_STAGE_GBUFFER},
    [RD_VIEW_RT4] = {"rt4", RD_ENCODE_DATA, RD_STAGE_GBUFFER},
    [RD_VIEW_TILES] = {"tiles", RD_ENCODE_COLOR, RD_STAGE_LISTS},
    [RD_VIEW_CLUSTERS] = {"clusters", RD_ENCODE_COLOR, RD_STAGE_LISTS},
    [RD_VIEW_LIGHT_WASTE] = {"light_waste", RD_ENCODE_COLOR, RD_STAGE_LISTS},
    [RD_VIEW_VARIANTS] = {"variants", RD_ENCODE_COLOR, RD_STAGE_LISTS},
    [RD_VIEW_BLOCKERS] = {"blockers", RD_ENCODE_COLOR, RD_STAGE_LISTS},
};

const char* rd_view_name(rd_view view)
{
    return views[view].name;
}

rd_view_stage rd_view_stage_of(rd_view view)
{
    return views[view].stage;
}

rd_encoding rd_view_encoding(rd_view view)
{
    return views[view].encoding;
}

rd_view rd_view_from_name(const char* name)
{
    int i = 0;
    while (i < RD_VIEW_COUNT && strcmp(views[i].name, name) != 0) {
        ++i;
    }
    return (rd_view)i;
}

/* A hue for each index. */
static hdrp_v3 index_color(uint32_t i)
{
    float h = hdrp_unit_from_u32(hdrp_hash1(i)) * 6.0f;
    return hdrp_v3_saturate(hdrp_v3_make(hdrp_abs(h - 3.0f) - 1.0f, 2.0f - hdrp_abs(h - 2.0f),
                                         2.0f - hdrp_abs(h - 4.0f)));
}

/* Each feature adds its colour to a dim grey. */
static hdrp_v3 feature_color(hdrp_u32 f)
{
    static const struct {
        hdrp_u32 feature;
        hdrp_v3 color;
    } table[] = {
        {HDRP_BRDF_FEATURE_CLEAR_COAT, {0.8f, 0.1f, 0.1f}},
        {HDRP_BRDF_FEATURE_ANISOTROPY, {0.1f, 0.7f, 0.1f}},
        {HDRP_BRDF_FEATURE_IRIDESCENCE, {0.1f, 0.2f, 0.8f}},
        {HDRP_BRDF_FEATURE_REFRACTION, {0.0f, 0.6f, 0.6f}},
        {HDRP_BRDF_FEATURE_SUBSURFACE, {0.6f, 0.4f, 0.0f}},
        {HDRP_BRDF_FEATURE_TRANSMISSION, {0.5f, 0.0f, 0.5f}},
    };
    hdrp_v3 c = hdrp_v3_splat(0.15f);
    for (size_t i = 0; i < sizeof table / sizeof table[0]; ++i) {
        if (f & table[i].feature) {
            c = hdrp_v3_add(c, table[i].color);
        }
    }
    return hdrp_v3_saturate(c);
}

static hdrp_v3 uv_color(hdrp_v2 uv)
{
    return hdrp_v3_make(uv.x - hdrp_floor(uv.x), uv.y - hdrp_floor(uv.y), 0.0f);
}

hdrp_v3 rd_view_value(rd_view view, const rd_camera* camera, const rd_surface* s)
{
    const hdrp_brdf_surface* b = &s->brdf;
    switch (view) {
    case RD_VIEW_BASE_COLOR:
        return b->base_color;
    case RD_VIEW_NORMAL:
        return b->normal;
    case RD_VIEW_GEOMETRIC_NORMAL:
        return s->geometric_normal;
    case RD_VIEW_VERTEX_NORMAL:
        return s->vertex_normal;
    case RD_VIEW_TANGENT:
        return hdrp_normalize_or(b->tangent, hdrp_v3_splat(0.0f));
    case RD_VIEW_UV:
        return uv_color(s->uv);
    case RD_VIEW_ROUGHNESS:
        return hdrp_v3_splat(b->perceptual_roughness);
    case RD_VIEW_METALLIC:
        return hdrp_v3_splat(b->metallic);
    case RD_VIEW_F0:
        return hdrp_brdf_fresnel0(b->base_color, b->metallic, b->dielectric_fresnel0);
    case RD_VIEW_DEPTH:
        return hdrp_v3_splat(hdrp_v3_dot(hdrp_v3_sub(s->position, camera->eye), camera->forward));
    case RD_VIEW_FEATURES:
        return feature_color(b->features);
    case RD_VIEW_MATERIAL: {
        const rd_material* m = s->material;
        uint32_t hash = 2166136261u;
        for (const char* c = m->name; *c; ++c) {
            hash = (hash ^ (uint32_t)(unsigned char)*c) * 16777619u;
        }
        return index_color(hash);
    }
    case RD_VIEW_ALPHA:
        return hdrp_v3_splat(s->alpha);
    case RD_VIEW_EMISSION:
        return s->emission_nits;
    case RD_VIEW_OCCLUSION:
        return hdrp_v3_splat(b->ambient_occlusion);
    case RD_VIEW_COAT:
        return hdrp_v3_make(b->coat_mask, b->coat_perceptual_roughness, 0.0f);
    case RD_VIEW_ANISOTROPY:
        return hdrp_v3_splat(b->anisotropy);
    case RD_VIEW_FILM:
        return hdrp_v3_make(b->film_mask, b->film_thickness_nm / 1000.0f, 0.0f);
    case RD_VIEW_TRANSMISSION:
        return hdrp_v3_make(b->transmission, b->volume_thickness_m, 0.0f);
    default:
        return hdrp_v3_splat(0.0f);
    }
}
