#define HDRP_BRDF_IMPLEMENTATION
#include "lighting.h"

#include <stdlib.h>
#include <string.h>

/* Illuminance of generated lights where the scene has no other to go by. */
#define GENERATED_LUX 500.0f
/* And their share of what the sky sheds. */
#define GENERATED_SHARE 0.5f

/* >>tables */

static bool bake_fgd(rd_lighting* l, rd_stats* stats, rd_report* report)
{
    double begin = rd_now_ms();
    l->fgd = (hdrp_brdf_fgd*)malloc(sizeof *l->fgd * RD_FGD_SIZE * RD_FGD_SIZE);
    if (!l->fgd) {
        return rd_fail(report, "lighting", "out of memory");
    }
#pragma omp parallel for schedule(dynamic, 4)
    for (int row = 0; row < RD_FGD_SIZE; ++row) {
        hdrp_brdf_fgd_bake_rows(l->fgd, RD_FGD_SIZE, row, row + 1);
    }
    rd_stats_pass(stats, "bake FGD table", rd_now_ms() - begin);
    return true;
}

static bool collect_lights(rd_lighting* l, const rd_lighting_desc* d, rd_stats* stats,
                           rd_report* report)
{
    const rd_environment* e = d->environment;
    rd_lights_desc desc;
    desc.scene = d->scene;
    desc.sun = e->has_sun && l->features & RD_FEATURE_SUN ? &e->sun : NULL;
    desc.generated = (uint32_t)d->options->lights;
    desc.generated_lux = e->present ? GENERATED_SHARE * (float)e->ground_lux : GENERATED_LUX;
    desc.seed = d->options->seed;
    if (!rd_lights_make(&l->lights, &desc)) {
        return rd_fail(report, "lights", "out of memory");
    }
    rd_stats_count(stats, "light_records", l->lights.count);
    return true;
}

void rd_lighting_make_dark(rd_lighting* l, const rd_lighting_desc* d)
{
    const rd_options* o = d->options;
    memset(l, 0, sizeof *l);
    l->scene = d->scene;
    l->trace = d->trace;
    l->environment = d->environment;
    l->features = o->features;
    l->soft_shadows = o->quality != RD_QUALITY_FAST;
    l->fast_irradiance = o->quality == RD_QUALITY_FAST;
}

bool rd_lighting_make(rd_lighting* l, const rd_lighting_desc* d, rd_stats* stats, rd_report* report)
{
    bool fit = d->options->quality == RD_QUALITY_FAST;
    rd_lighting_make_dark(l, d);
    return (fit || bake_fgd(l, stats, report)) && collect_lights(l, d, stats, report);
}

void rd_lighting_free(rd_lighting* l)
{
    free(l->fgd);
    rd_lights_free(&l->lights);
    memset(l, 0, sizeof *l);
}

hdrp_brdf_fgd rd_lighting_fgd(const rd_lighting* l, const hdrp_brdf_data* data, hdrp_v3 view)
{
    float n_dot_v = hdrp_saturate(hdrp_v3_dot(data->normal, view));
    return l->fgd ? hdrp_brdf_fgd_lookup(l->fgd, RD_FGD_SIZE, n_dot_v, data->perceptual_roughness)
                  : hdrp_brdf_fgd_fast(n_dot_v, data->perceptual_roughness);
}

/* >>materials */

hdrp_u32 rd_lighting_material_features(uint32_t features)
{
    static const struct {
        uint32_t option;
        hdrp_u32 material;
    } table[] = {
        {RD_FEATURE_CLEAR_COAT, HDRP_BRDF_FEATURE_CLEAR_COAT},
        {RD_FEATURE_ANISOTROPY, HDRP_BRDF_FEATURE_ANISOTROPY},
        {RD_FEATURE_IRIDESCENCE, HDRP_BRDF_FEATURE_IRIDESCENCE},
        {RD_FEATURE_REFRACTION, HDRP_BRDF_FEATURE_REFRACTION},
        {RD_FEATURE_TRANSMISSION, HDRP_BRDF_FEATURE_SUBSURFACE | HDRP_BRDF_FEATURE_TRANSMISSION},
    };
    hdrp_u32 mask = 0u;
    for (size_t i = 0; i < sizeof table / sizeof table[0]; ++i) {
        mask |= features & table[i].option ? table[i].material : 0u;
    }
    return mask;
}

hdrp_v3 rd_volume_transmittance(const rd_material* m, float distance_m)
{
    return hdrp_brdf_volume_transmittance(m->attenuation_color, m->attenuation_distance_m,
                                          distance_m);
}

static float curvature_variance(const rd_surface* s)
{
    return hdrp_brdf_variance_from_derivatives(s->normal_dx, s->normal_dy, RD_VARIANCE_STRENGTH,
                                               RD_VARIANCE_LIMIT);
}

static float filtered_alpha(float alpha, float variance)
{
    return hdrp_sq(hdrp_brdf_perceptual_roughness_filtered(hdrp_sqrt(alpha), variance));
}

/* Both widths of a stretched lobe grow, the narrow one more. */
static void filter_roughness(hdrp_brdf_surface* b, float variance)
{
    hdrp_brdf_alphas a;
    hdrp_brdf_kulla k;
    if (!(b->features & HDRP_BRDF_FEATURE_ANISOTROPY)) {
        b->perceptual_roughness =
            hdrp_brdf_perceptual_roughness_filtered(b->perceptual_roughness, variance);
        return;
    }
    a = hdrp_brdf_alphas_kulla(b->perceptual_roughness, b->anisotropy);
    a.t = filtered_alpha(a.t, variance);
    a.b = filtered_alpha(a.b, variance);
    k = hdrp_brdf_kulla_from_alphas(a);
    b->perceptual_roughness = k.perceptual_roughness;
    b->anisotropy = k.anisotropy;
}

/* Only diffuse. */
static hdrp_brdf_data matte(const rd_surface* s, float albedo)
{
    hdrp_brdf_surface b = hdrp_brdf_surface_default();
    b.base_color = hdrp_v3_splat(albedo);
    b.dielectric_fresnel0 = hdrp_v3_splat(0.0f);
    b.normal = s->brdf.normal;
    return hdrp_brdf_data_from_surface(b);
}

hdrp_v3 rd_emission_nits(const rd_surface* s, float exposure)
{
    return s->material->unlit ? hdrp_v3_scale(s->brdf.base_color, 1.0f / exposure)
                              : s->emission_nits;
}

hdrp_brdf_data rd_engine_data(const rd_surface* s, uint32_t features)
{
    hdrp_brdf_surface b = s->brdf;
    bool dark = s->material->unlit || s->material->additive;
    if (dark || features & RD_FEATURE_GREY_CARDS) {
        return matte(s, dark ? 0.0f : HDRP_LIGHT_MIDDLE_GREY);
    }
    b.features &= rd_lighting_material_features(features);
    if (!(features & RD_FEATURE_NORMAL_MAPS)) {
        b.normal = b.coat_normal = s->vertex_normal;
    }
    if (!(features & RD_FEATURE_OCCLUSION)) {
        b.ambient_occlusion = 1.0f;
    }
    if (features & RD_FEATURE_SPECULAR_AA) {
        float curvature = curvature_variance(s);
        filter_roughness(&b, hdrp_min(curvature + s->map_variance, 1.0f));
        b.coat_perceptual_roughness = hdrp_brdf_perceptual_roughness_filtered(
            b.coat_perceptual_roughness, hdrp_min(curvature + s->coat_map_variance, 1.0f));
    }
    if (b.features & HDRP_BRDF_FEATURE_REFRACTION) {
        b.transmittance = rd_volume_transmittance(s->material, b.volume_thickness_m);
    }
    return hdrp_brdf_data_from_surface(b);
}
