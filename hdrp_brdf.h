/* hdrp_brdf.h - material model: artist data to engine data, every lobe, and the Lit model.
 * SPDX-License-Identifier: MIT
 *
 * See hdrp_math.h for the languages, the conventions and the override macros.
 *
 *     hdrp_brdf_data d = hdrp_brdf_data_from_surface(surface);
 *     float n_dot_v = hdrp_v3_dot(d.normal, v);
 *     hdrp_brdf_fgd fgd = hdrp_brdf_fgd_fast(n_dot_v, d.perceptual_roughness);
 *     hdrp_brdf_lit_view w = hdrp_brdf_lit_view_make(d, v, fgd, d.features);
 *     hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, l, d.features);
 *     hdrp_v3 nits = hdrp_v3_scale(hdrp_v3_add(r.diffuse, r.specular), lux);
 *
 * The first four lines once per pixel, the last two for each light. surface begins as
 * hdrp_brdf_surface_default(); v and l point to the viewer and to the light.
 *
 * >>index of the functions, without hdrp_brdf_ (written by tools/api_check.py --write)
 *   material: surface_default diffuse_color fresnel0 data_from_surface metallic_from_colors
 *       data_from_diffuse_specular dielectric_fresnel0
 *   lit: lit_view_make lit_view_widened lit_eval dominant_direction lit_env_make
 *   sampling lit: lit_pdf lit_sample
 *   fgd table, C and C++ only: fgd_integrate fgd_bake_rows fgd_lookup
 * >>end */
#ifndef HDRP_BRDF_H
#define HDRP_BRDF_H

#include "hdrp_brdf_lobes.h"

#if HDRP_VERSION != 100
#error "hdrp_brdf.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* >>material
 * What artists set (hdrp_brdf_surface) and what lighting reads (hdrp_brdf_data). A GBuffer stores
 * the second, see hdrp_pack.h. */

/* Features of a material, or-ed. A constant mask lets the compiler drop what is not in it. */
#define HDRP_BRDF_FEATURE_SUBSURFACE   1u  /* diffuse light is blurred under the surface */
#define HDRP_BRDF_FEATURE_TRANSMISSION 2u  /* diffuse light crosses a thin slab */
#define HDRP_BRDF_FEATURE_ANISOTROPY   4u  /* the base lobe is stretched along the tangent */
#define HDRP_BRDF_FEATURE_IRIDESCENCE  8u  /* a thin film covers the base */
#define HDRP_BRDF_FEATURE_CLEAR_COAT   16u /* a thin dielectric layer covers everything */
#define HDRP_BRDF_FEATURE_REFRACTION   32u /* specular light crosses the surface; forward only */
#define HDRP_BRDF_FEATURE_ALL          63u

/* The coat's width where a layout has no room for one. Lagarde and Golubev 2018, "The Road toward
 * Unified Rendering with Unity's High Definition Render Pipeline", slides on clear coat. */
#define HDRP_BRDF_COAT_PERCEPTUAL_ROUGHNESS 0.03f

/* What artists set. All colours are linear Rec.709. */
struct hdrp_brdf_surface {
    hdrp_v3 base_color;          /* [0,1] diffuse albedo of a dielectric, F0 of a metal */
    float metallic;              /* [0,1] */
    float perceptual_roughness;  /* [0,1] */
    hdrp_v3 dielectric_fresnel0; /* [0,1] F0 where metallic is 0; 0.04 is IOR 1.5 */
    hdrp_v3 normal;              /* shading normal, any length */
    hdrp_v3 tangent;             /* direction of anisotropy, any length, need not be orthogonal */
    float ambient_occlusion;     /* [0,1] 1 is open */
    float specular_occlusion;    /* [0,1] 1 is open */
    float anisotropy;            /* [-1,1] > 0 stretches the highlight along the tangent */
    float coat_mask;             /* [0,1] */
    float coat_perceptual_roughness; /* [0,1] */
    hdrp_v3 coat_normal;             /* any length */
    float film_mask;                 /* [0,1] */
    float film_ior;                  /* [1,3] */
    float film_thickness_nm;         /* [0,3000] */
    float subsurface_mask;           /* [0,1] */
    hdrp_u32 diffusion_profile;      /* [0,15] index into the caller's profiles */
    float thickness;                 /* [0,1] of the slab, relative to the profile's range */
    hdrp_v3 transmittance;           /* [0,1] of the slab, from profile and thickness */
    float transmission;              /* [0,1] share of light that refracts instead of diffusing */
    float ior;                       /* [1,3] of the volume below the surface */
    float volume_thickness_m;        /* [0,1e6] below the surface; 0 is a thin wall */
    hdrp_u32 features;               /* HDRP_BRDF_FEATURE_... */
};
HDRP_TYPEDEF(hdrp_brdf_surface)

/* What lighting reads. Made by hdrp_brdf_data_from_surface or by decoding a GBuffer, both of which
 * guarantee the ranges below. */
struct hdrp_brdf_data {
    hdrp_v3 diffuse_color;           /* [0,1] */
    hdrp_v3 fresnel0;                /* [0,1] against air, without coat and film */
    hdrp_v3 base_color;              /* [0,1] kept for layouts that store it */
    float metallic;                  /* [0,1] likewise */
    float perceptual_roughness;      /* [0,1] */
    hdrp_v3 normal;                  /* unit */
    hdrp_v3 tangent;                 /* unit, orthogonal to normal */
    hdrp_v3 bitangent;               /* cross(normal, tangent) */
    float ambient_occlusion;         /* [0,1] */
    float specular_occlusion;        /* [0,1] */
    float anisotropy;                /* [-1,1] */
    float coat_mask;                 /* [0,1] */
    float coat_perceptual_roughness; /* [0,1] */
    hdrp_v3 coat_normal;             /* unit */
    float film_mask;                 /* [0,1] */
    float film_ior;                  /* [1,3] */
    float film_thickness_nm;         /* [0,3000] */
    float subsurface_mask;           /* [0,1] */
    hdrp_u32 diffusion_profile;      /* [0,15] */
    float thickness;                 /* [0,1] */
    hdrp_v3 transmittance;           /* [0,1] */
    float transmission;              /* [0,1] */
    float ior;                       /* [1,3] */
    float volume_thickness_m;        /* [0,1e6] */
    hdrp_u32 features;               /* HDRP_BRDF_FEATURE_... */
};
HDRP_TYPEDEF(hdrp_brdf_data)

/** A grey, half-rough dielectric that faces +Z: the values a material leaves alone.
 *  returns  every field inside its documented range
 *  edges    none
 *  error    none: constants
 *  source   glTF 2.0 specification, section 3.9 and the KHR_materials extensions (defaults) */
HDRP_FN hdrp_brdf_surface hdrp_brdf_surface_default(void)
{
    hdrp_brdf_surface s;
    s.base_color = hdrp_v3_splat(0.5f);
    s.metallic = 0.0f;
    s.perceptual_roughness = 0.5f;
    s.dielectric_fresnel0 = hdrp_v3_splat(0.04f);
    s.normal = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    s.tangent = hdrp_v3_make(1.0f, 0.0f, 0.0f);
    s.ambient_occlusion = 1.0f;
    s.specular_occlusion = 1.0f;
    s.anisotropy = 0.0f;
    s.coat_mask = 0.0f;
    s.coat_perceptual_roughness = HDRP_BRDF_COAT_PERCEPTUAL_ROUGHNESS;
    s.coat_normal = s.normal;
    s.film_mask = 0.0f;
    s.film_ior = 1.3f;
    s.film_thickness_nm = 400.0f;
    s.subsurface_mask = 0.0f;
    s.diffusion_profile = 0u;
    s.thickness = 1.0f;
    s.transmittance = hdrp_v3_splat(0.0f);
    s.transmission = 0.0f;
    s.ior = 1.5f;
    s.volume_thickness_m = 0.0f;
    s.features = 0u;
    return s;
}

/** Diffuse albedo in the base colour and metallic parametrisation.
 *  base_color  [0,1]  linear Rec.709
 *  metallic    [0,1]
 *  returns     [0,1]  per component
 *  edges       black for a metal
 *  error       <= 1.2e-7 absolute  @accuracy brdf_diffuse_color
 *  source      Burley 2012, "Physically-Based Shading at Disney", section 5.2 */
HDRP_FN hdrp_v3 hdrp_brdf_diffuse_color(hdrp_v3 base_color, float metallic)
{
    return hdrp_v3_scale(base_color, 1.0f - metallic);
}

/** Reflectance at normal incidence in the base colour and metallic parametrisation.
 *  base_color           [0,1]  linear Rec.709
 *  metallic             [0,1]
 *  dielectric_fresnel0  [0,1]  reflectance where metallic is 0
 *  returns              [0,1]  per component
 *  edges                exactly dielectric_fresnel0 and base_color at the ends of metallic
 *  error                <= 1.2e-7 absolute  @accuracy brdf_fresnel0
 *  source               Burley 2012, "Physically-Based Shading at Disney", section 5.2 */
HDRP_FN hdrp_v3 hdrp_brdf_fresnel0(hdrp_v3 base_color, float metallic, hdrp_v3 dielectric_fresnel0)
{
    return hdrp_v3_lerp(dielectric_fresnel0, base_color, metallic);
}

/** d with an orthonormal frame from a normal and a tangent of any length. */
HDRP_FN hdrp_brdf_data hdrp_i_brdf_data_set_frame(hdrp_brdf_data d, hdrp_v3 normal, hdrp_v3 tangent)
{
    hdrp_v3 n = hdrp_normalize_or(normal, hdrp_v3_make(0.0f, 0.0f, 1.0f));
    hdrp_v3 t = hdrp_normalize_or(tangent, hdrp_basis_from_normal(n).tangent);
    hdrp_v3 in_plane = hdrp_v3_mad(t, n, -hdrp_v3_dot(t, n));
    /* Below 1e-3 the tangent is the normal up to rounding and in_plane is noise. */
    if (hdrp_v3_dot(in_plane, in_plane) < 1e-6f) {
        in_plane = hdrp_basis_from_normal(n).tangent;
    }
    d.normal = n;
    d.tangent = hdrp_v3_normalize(in_plane);
    d.bitangent = hdrp_v3_cross(n, d.tangent);
    return d;
}

/** x where the features have the flag, else 0. */
HDRP_FN float hdrp_i_brdf_feature(float x, hdrp_u32 features, hdrp_u32 flag)
{
    return (features & flag) != 0u ? x : 0.0f;
}

/** d with the values of all features; those that the material lacks become neutral. */
HDRP_FN hdrp_brdf_data hdrp_i_brdf_data_set_features(hdrp_brdf_data d, hdrp_brdf_surface s)
{
    hdrp_u32 f = s.features & HDRP_BRDF_FEATURE_ALL;
    hdrp_u32 crossing = HDRP_BRDF_FEATURE_TRANSMISSION | HDRP_BRDF_FEATURE_REFRACTION;
    float anisotropy = hdrp_clamp(s.anisotropy, -1.0f, 1.0f);
    d.features = f;
    d.anisotropy = hdrp_i_brdf_feature(anisotropy, f, HDRP_BRDF_FEATURE_ANISOTROPY);
    d.coat_mask = hdrp_i_brdf_feature(hdrp_saturate(s.coat_mask), f, HDRP_BRDF_FEATURE_CLEAR_COAT);
    d.coat_perceptual_roughness = hdrp_saturate(s.coat_perceptual_roughness);
    d.coat_normal = hdrp_normalize_or(s.coat_normal, d.normal);
    d.film_mask = hdrp_i_brdf_feature(hdrp_saturate(s.film_mask), f, HDRP_BRDF_FEATURE_IRIDESCENCE);
    d.film_ior = hdrp_clamp(s.film_ior, 1.0f, 3.0f);
    d.film_thickness_nm = hdrp_clamp(s.film_thickness_nm, 0.0f, 3000.0f);
    d.subsurface_mask =
        hdrp_i_brdf_feature(hdrp_saturate(s.subsurface_mask), f, HDRP_BRDF_FEATURE_SUBSURFACE);
    d.diffusion_profile = s.diffusion_profile & 15u;
    d.thickness = hdrp_saturate(s.thickness);
    d.transmittance =
        hdrp_v3_scale(hdrp_v3_saturate(s.transmittance), hdrp_i_brdf_feature(1.0f, f, crossing));
    d.transmission =
        hdrp_i_brdf_feature(hdrp_saturate(s.transmission), f, HDRP_BRDF_FEATURE_REFRACTION);
    d.ior = hdrp_clamp(s.ior, 1.0f, 3.0f);
    d.volume_thickness_m = hdrp_clamp(s.volume_thickness_m, 0.0f, 1e6f);
    return d;
}

/** Engine data of a surface in the base colour and metallic parametrisation.
 *  s        any  every field; NaN and out-of-range values are limited to the documented range
 *  returns  valid; what belongs to a feature that s.features lacks is neutral
 *  edges    a normal without direction becomes +Z, a tangent along the normal an arbitrary one; NaN
 *           becomes the lower bound of its field
 *  error    none: limits, and the two formulas above
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slides on material architecture */
HDRP_FN hdrp_brdf_data hdrp_brdf_data_from_surface(hdrp_brdf_surface s)
{
    hdrp_brdf_data d;
    hdrp_v3 dielectric = hdrp_v3_saturate(s.dielectric_fresnel0);
    d.metallic = hdrp_saturate(s.metallic);
    d.base_color = hdrp_v3_saturate(s.base_color);
    d.diffuse_color = hdrp_brdf_diffuse_color(d.base_color, d.metallic);
    d.fresnel0 = hdrp_brdf_fresnel0(d.base_color, d.metallic, dielectric);
    d.perceptual_roughness = hdrp_saturate(s.perceptual_roughness);
    d.ambient_occlusion = hdrp_saturate(s.ambient_occlusion);
    d.specular_occlusion = hdrp_saturate(s.specular_occlusion);
    d = hdrp_i_brdf_data_set_frame(d, s.normal, s.tangent);
    return hdrp_i_brdf_data_set_features(d, s);
}

/** Metallic that a diffuse and a specular colour amount to, by their largest components.
 *  diffuse   [0,1]
 *  specular  [0,1]
 *  returns   [0,1]  m with diffuse = base (1 - m), specular = 0.04 (1 - m) + base m for some base
 *  edges     1 for a black diffuse colour, 0 for a specular colour of 0.04 and less
 *  error     <= 4e-6 absolute, in the specular colour of a result of at most 0.99, where one
 *            exists  @accuracy brdf_metallic_from_colors
 *  error     <= 4e-5 absolute, likewise up to 0.999: 1 - m carries few digits there
 *            @accuracy brdf_metallic_from_colors_metal
 *  source    both equations of Burley 2012, "Physically-Based Shading at Disney", solved for m
 *  note      the smaller root of 0.04 x^2 - (specular + diffuse) x + diffuse with x = 1 - m, in the
 *            form that does not cancel */
HDRP_FN float hdrp_brdf_metallic_from_colors(float diffuse, float specular)
{
    float s = hdrp_max(specular, HDRP_BRDF_COAT_FRESNEL0);
    float sum = s + diffuse;
    float root = hdrp_sqrt(hdrp_max(sum * sum - 4.0f * HDRP_BRDF_COAT_FRESNEL0 * diffuse, 0.0f));
    return hdrp_saturate(1.0f - 2.0f * diffuse / (sum + root));
}

/** Base colour whose diffuse and specular parts come nearest to two values, by least squares. */
HDRP_FN float hdrp_i_brdf_nearest_base(float diffuse, float specular, float metallic)
{
    float rest = 1.0f - metallic;
    float base = diffuse * rest + (specular - HDRP_BRDF_COAT_FRESNEL0 * rest) * metallic;
    return hdrp_saturate(base / (rest * rest + metallic * metallic));
}

/** Engine data of a surface in the diffuse and specular colour parametrisation.
 *  s               any  base_color, metallic and dielectric_fresnel0 are not read
 *  diffuse_color   any  linear Rec.709, limited to [0,1]
 *  specular_color  any  F0, limited to [0,1]
 *  returns         valid; base_color and metallic are the nearest equivalent, which layouts that
 *                  store those instead of the colours will use
 *  edges           as hdrp_brdf_data_from_surface
 *  error           none: limits, and the formula above
 *  source          Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *                  Definition Render Pipeline", slides on the Lit shader */
HDRP_FN hdrp_brdf_data hdrp_brdf_data_from_diffuse_specular(hdrp_brdf_surface s,
                                                            hdrp_v3 diffuse_color,
                                                            hdrp_v3 specular_color)
{
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    hdrp_v3 f0 = hdrp_v3_saturate(specular_color);
    hdrp_v3 diffuse = hdrp_v3_saturate(diffuse_color);
    float m =
        hdrp_brdf_metallic_from_colors(hdrp_v3_max_component(diffuse), hdrp_v3_max_component(f0));
    d.diffuse_color = diffuse;
    d.fresnel0 = f0;
    d.metallic = m;
    d.base_color = hdrp_v3_make(hdrp_i_brdf_nearest_base(diffuse.x, f0.x, m),
                                hdrp_i_brdf_nearest_base(diffuse.y, f0.y, m),
                                hdrp_i_brdf_nearest_base(diffuse.z, f0.z, m));
    return d;
}

/** F0 of a dielectric from its IOR and an artist's weight and tint.
 *  ior             [1,4]  against air
 *  specular_color  [0,inf)  tint of F0, linear Rec.709
 *  specular        [0,1]  weight: 0 is no specular reflection at any angle
 *  returns         [0,1]  for hdrp_brdf_surface.dielectric_fresnel0
 *  edges           0.04 for IOR 1.5, white and weight 1
 *  error           <= 2.5e-7 absolute  @accuracy brdf_dielectric_fresnel0
 *  source          glTF 2.0, KHR_materials_ior and KHR_materials_specular, "Implementation"
 *  note            the extension also scales the reflectance at grazing by the weight; here that
 *                  follows from F0, see hdrp_brdf_fresnel90 */
HDRP_FN hdrp_v3 hdrp_brdf_dielectric_fresnel0(float ior, hdrp_v3 specular_color, float specular)
{
    float f0 = hdrp_brdf_fresnel0_from_ior(ior, 1.0f);
    float w = hdrp_saturate(specular);
    return hdrp_v3_make(hdrp_saturate(specular_color.x * f0) * w,
                        hdrp_saturate(specular_color.y * f0) * w,
                        hdrp_saturate(specular_color.z * f0) * w);
}

/* >>lit
 * The whole material for one light direction, and what it asks of an environment. Make the view
 * first, once per pixel; then evaluate each light. Each function takes a mask of features: pass a
 * constant that covers what the materials have, and the code for all else folds away. A material
 * that lacks a feature of the mask has neutral data for it and comes out the same.
 *
 * Layers, from the top: clear coat, thin film (part of the base's Fresnel term), specular base,
 * diffuse or transmitted light. What a layer reflects, the layers below it do not receive. */

/* May be or-ed to the features: references evaluate the thin film for each light, exactly, and know
 * what it leaves to the diffuse lobe. Of a white furnace a view then receives at most 1.01; what is
 * sent everywhere by one light is at most 1.07 of it, because only the view's side knows. */
#define HDRP_BRDF_LIT_EXACT 256u

/* Smallest cosine of the view. What lies beyond is shaded as if it were just visible. */
#define HDRP_BRDF_N_DOT_V_MIN 1e-4f

/* What the lights of a pixel share. Made by hdrp_brdf_lit_view_make. */
struct hdrp_brdf_lit_view {
    hdrp_v3 v;                     /* unit */
    float n_dot_v;                 /* [HDRP_BRDF_N_DOT_V_MIN,1] */
    hdrp_brdf_alphas alphas;       /* of the base lobe */
    hdrp_v3 fresnel0;              /* [0,1] of the base, under its film and coat */
    float fresnel90;               /* [0,1] */
    hdrp_brdf_fgd_fit fit;         /* of the base lobe */
    hdrp_brdf_fgd_stretch stretch; /* of the base lobe, where it is anisotropic */
    hdrp_brdf_bounces bounces;     /* of the base lobe */
    float multiscatter;      /* [0,inf) 1/sr, what all lights share of hdrp_brdf_multiscatter */
    hdrp_v3 diffuse;         /* [0,inf) 1/sr, what all lights share of hdrp_brdf_diffuse */
    hdrp_v3 specular_albedo; /* [0,1] of the base lobe, all bounces */
    hdrp_v3 diffuse_albedo;  /* [0,1] of the diffuse lobe on the side of v */
    hdrp_v3 transmitted;     /* [0,1] colour of refracted light, before the Fresnel term */
    float transmitted_alpha; /* [HDRP_ALPHA_MIN,4] of what refracts, else of the base lobe */
    hdrp_v3 coat_v;          /* unit, v as the coat sees it: on its own side */
    float coat_n_dot_v;      /* [HDRP_BRDF_N_DOT_V_MIN,1] */
    float coat_alpha;        /* [HDRP_ALPHA_MIN,4] of the coat, else of the base lobe */
    float below_coat;        /* [0,1] share of light from v that the coat lets through */
};
HDRP_TYPEDEF(hdrp_brdf_lit_view)

/* Light reflected per unit of illuminance on a surface that faces the light: BRDF times n_dot_l.
 * In two parts, because subsurface scattering blurs only the first. */
struct hdrp_brdf_lit {
    hdrp_v3 diffuse;  /* [0,inf) 1/sr, with light that crosses a thin slab */
    hdrp_v3 specular; /* [0,inf) 1/sr, with light that is refracted through a wall */
};
HDRP_TYPEDEF(hdrp_brdf_lit)

/** Share of light from a direction that the coat lets through to the layers below. */
HDRP_FN float hdrp_i_brdf_below_coat(float coat_mask, float n_dot_x)
{
    return 1.0f - coat_mask * hdrp_brdf_f_schlick(HDRP_BRDF_COAT_FRESNEL0, 1.0f, n_dot_x);
}

/** IOR of what lies above the base. */
HDRP_FN float hdrp_i_brdf_outer_ior(hdrp_brdf_data d, hdrp_u32 features)
{
    return (features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u
               ? hdrp_lerp(1.0f, HDRP_BRDF_COAT_IOR, d.coat_mask)
               : 1.0f;
}

/** Reflectance of film and base at an angle, given as its cosine in air. */
HDRP_FN hdrp_v3 hdrp_i_brdf_lit_film(hdrp_brdf_data d, float u, hdrp_u32 features)
{
    float outer = hdrp_i_brdf_outer_ior(d, features);
    float c = hdrp_brdf_refracted_cosine(u, outer);
    if ((features & HDRP_BRDF_LIT_EXACT) != 0u) {
        return hdrp_brdf_film_exact(c, outer, d.film_ior, d.film_thickness_nm, d.fresnel0);
    }
    return hdrp_brdf_film(c, outer, d.film_ior, d.film_thickness_nm, d.fresnel0);
}

/** F0 of the base without film, as light finds it under a coat. */
HDRP_FN hdrp_v3 hdrp_i_brdf_lit_bare_fresnel0(hdrp_brdf_data d, hdrp_u32 features)
{
    if ((features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u) {
        return hdrp_v3_lerp(d.fresnel0, hdrp_brdf_fresnel0_under_coat(d.fresnel0), d.coat_mask);
    }
    return d.fresnel0;
}

/* Most grazing view for which a film is evaluated. Beyond, its phase hardly changes, and a Schlick
 * curve through its reflectance would say nothing about other angles. */
#define HDRP_I_BRDF_FILM_N_DOT_V_MIN 0.25f

/** F0 of the film over its base. A film has none: it gets that of the Schlick curve through its
 *  reflectance at this view, so that lights from elsewhere follow a plausible curve. */
HDRP_FN hdrp_v3 hdrp_i_brdf_lit_film_fresnel0(hdrp_brdf_data d, float n_dot_v, hdrp_u32 features)
{
    float u = hdrp_max(n_dot_v, HDRP_I_BRDF_FILM_N_DOT_V_MIN);
    hdrp_v3 f = hdrp_i_brdf_lit_film(d, u, features);
    return hdrp_v3_make(hdrp_brdf_fresnel0_from_schlick(f.x, u),
                        hdrp_brdf_fresnel0_from_schlick(f.y, u),
                        hdrp_brdf_fresnel0_from_schlick(f.z, u));
}

/** The widths of the base lobe. */
HDRP_FN hdrp_brdf_alphas hdrp_i_brdf_lit_alphas(hdrp_brdf_data d, hdrp_u32 features)
{
    hdrp_brdf_alphas a;
    if ((features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u) {
        return hdrp_brdf_alphas_kulla(d.perceptual_roughness, d.anisotropy);
    }
    a.t = hdrp_brdf_alpha_from_perceptual_roughness(d.perceptual_roughness);
    a.b = a.t;
    return a;
}

/** v, or where n does not face it the direction nearest to v that n does face. */
HDRP_FN hdrp_v3 hdrp_i_brdf_facing(hdrp_v3 v, hdrp_v3 n)
{
    float missing = HDRP_BRDF_N_DOT_V_MIN - hdrp_v3_dot(n, v);
    return hdrp_v3_select(missing, hdrp_normalize_or(hdrp_v3_mad(v, n, missing), n), v);
}

/** w with the Fresnel term of the base. */
HDRP_FN hdrp_brdf_lit_view hdrp_i_brdf_lit_view_set_fresnel(hdrp_brdf_lit_view w, hdrp_brdf_data d,
                                                            hdrp_u32 features)
{
    w.fresnel0 = hdrp_i_brdf_lit_bare_fresnel0(d, features);
    w.fresnel90 = hdrp_brdf_fresnel90(w.fresnel0);
    if ((features & HDRP_BRDF_FEATURE_IRIDESCENCE) != 0u) {
        w.fresnel0 = hdrp_v3_lerp(w.fresnel0, hdrp_i_brdf_lit_film_fresnel0(d, w.n_dot_v, features),
                                  d.film_mask);
        w.fresnel90 = hdrp_lerp(w.fresnel90, 1.0f, d.film_mask);
    }
    return w;
}

/** No dependence on the azimuth, for a lobe of equal widths. */
HDRP_FN hdrp_brdf_fgd_stretch hdrp_i_brdf_lit_no_stretch(float alpha)
{
    hdrp_brdf_fgd_stretch s;
    s.widths2 = hdrp_v3_splat(alpha * alpha);
    s.loss_n1 = hdrp_v2_make(0.0f, 0.0f);
    s.loss_d1 = hdrp_v3_splat(0.0f);
    s.loss_n2 = s.loss_n1;
    s.cosine0 = s.loss_n1;
    s.cosine1 = s.loss_n1;
    s.cosine2 = s.loss_n1;
    return s;
}

/** w with the fit of the directional albedo of the base lobe. */
HDRP_FN hdrp_brdf_lit_view hdrp_i_brdf_lit_view_set_fit(hdrp_brdf_lit_view w, hdrp_brdf_data d,
                                                        hdrp_u32 features)
{
    if ((features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u) {
        w.fit = hdrp_brdf_fgd_fit_make_aniso(w.alphas);
        w.stretch = hdrp_brdf_fgd_stretch_make(w.alphas);
        return w;
    }
    w.fit = hdrp_brdf_fgd_fit_make(d.perceptual_roughness);
    w.stretch = hdrp_i_brdf_lit_no_stretch(w.alphas.t);
    return w;
}

/** FGD of the base lobe from its fit, in a direction whose cosine is given too. */
HDRP_FN hdrp_brdf_fgd hdrp_i_brdf_lit_fgd(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 x,
                                          float n_dot_x, hdrp_u32 features)
{
    hdrp_brdf_fgd_fit fit = w.fit;
    if ((features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u) {
        fit = hdrp_brdf_fgd_fit_towards(fit, w.stretch, hdrp_v3_dot(d.tangent, x),
                                        hdrp_v3_dot(d.bitangent, x), n_dot_x);
    }
    return hdrp_brdf_fgd_from_fit(fit, n_dot_x);
}

/** FGD of a round lobe, changed by what the fit of the stretched one differs from its own. */
HDRP_FN hdrp_brdf_fgd hdrp_i_brdf_fgd_stretched(hdrp_brdf_fgd fgd, hdrp_brdf_fgd stretched,
                                                hdrp_brdf_fgd isotropic)
{
    hdrp_brdf_fgd f;
    f.albedo = hdrp_saturate(fgd.albedo + (stretched.albedo - isotropic.albedo));
    f.schlick = hdrp_clamp(fgd.schlick + (stretched.schlick - isotropic.schlick), 0.0f, f.albedo);
    return f;
}

/** albedo, or where a specular lobe leaves less light to a colour, what it leaves. A table of FGD
 *  and the fit that the other lobes are made of differ at grazing. */
HDRP_FN hdrp_v3 hdrp_i_brdf_no_more_than_left(hdrp_v3 albedo, hdrp_v3 color,
                                              hdrp_v3 specular_albedo)
{
    return hdrp_v3_make(hdrp_min(albedo.x, color.x * (1.0f - specular_albedo.x)),
                        hdrp_min(albedo.y, color.y * (1.0f - specular_albedo.y)),
                        hdrp_min(albedo.z, color.z * (1.0f - specular_albedo.z)));
}

/** Fresnel term of the base for one light. */
HDRP_FN hdrp_v3 hdrp_i_brdf_lit_f(hdrp_brdf_data d, hdrp_brdf_lit_view w, float l_dot_h,
                                  hdrp_u32 features)
{
    if ((features & HDRP_BRDF_LIT_EXACT) != 0u &&
        (features & HDRP_BRDF_FEATURE_IRIDESCENCE) != 0u) {
        hdrp_v3 f0 = hdrp_i_brdf_lit_bare_fresnel0(d, features);
        hdrp_v3 bare = hdrp_brdf_f_schlick_rgb(f0, hdrp_brdf_fresnel90(f0), l_dot_h);
        hdrp_v3 film = hdrp_i_brdf_lit_film(d, hdrp_saturate(l_dot_h), features);
        return hdrp_v3_lerp(bare, film, d.film_mask);
    }
    return hdrp_brdf_f_schlick_rgb(w.fresnel0, w.fresnel90, l_dot_h);
}

/** Mirror direction of v about n. */
HDRP_FN hdrp_v3 hdrp_i_brdf_reflect(hdrp_v3 v, hdrp_v3 n)
{
    return hdrp_v3_sub(hdrp_v3_scale(n, 2.0f * hdrp_v3_dot(n, v)), v);
}

/* Facets over which an exact film is averaged, once per view. A white surface under it gains up to
 * 0.7 %; with half as many facets it would be 1.6 %. */
#define HDRP_I_BRDF_FILM_FACETS 64u

/** Mean Fresnel term of the first bounce in the base lobe, over facets that v sees and that let its
 *  light go again. The Schlick curve of an exact film is right at one angle only. */
HDRP_FN hdrp_v3 hdrp_i_brdf_lit_f_mean(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_u32 features)
{
    hdrp_v3 v = hdrp_v3_make(hdrp_v3_dot(d.tangent, w.v), hdrp_v3_dot(d.bitangent, w.v), w.n_dot_v);
    hdrp_v3 sum = hdrp_v3_splat(0.0f);
    float facets = HDRP_FLT_MIN;
    hdrp_u32 i;
    for (i = 0u; i < HDRP_I_BRDF_FILM_FACETS; ++i) {
        hdrp_v2 u = hdrp_hammersley(i, HDRP_I_BRDF_FILM_FACETS);
        hdrp_v3 h = hdrp_brdf_sample_vndf(
            v, w.alphas.t, w.alphas.b,
            hdrp_v2_make(u.x, u.y + 0.5f / hdrp_f32_from_u32(HDRP_I_BRDF_FILM_FACETS)));
        hdrp_v3 l = hdrp_i_brdf_reflect(v, h);
        float open = hdrp_saturate(l.z);
        open *= hdrp_brdf_v_smith_ggx_aniso(l.x, l.y, open, v.x, v.y, v.z, w.alphas.t, w.alphas.b);
        facets += open;
        sum = hdrp_v3_mad(sum, hdrp_i_brdf_lit_f(d, w, hdrp_v3_dot(v, h), features), open);
    }
    return hdrp_v3_scale(sum, 1.0f / facets);
}

/** w with what all lights share of the lobes of the base. */
HDRP_FN hdrp_brdf_lit_view hdrp_i_brdf_lit_view_set_lobes(hdrp_brdf_lit_view w, hdrp_brdf_data d,
                                                          hdrp_brdf_fgd mean_fgd, hdrp_u32 features)
{
    hdrp_brdf_fgd own = hdrp_i_brdf_lit_fgd(d, w, w.v, w.n_dot_v, features);
    hdrp_brdf_fgd fgd = mean_fgd;
    hdrp_v3 below = hdrp_v3_sub(hdrp_v3_splat(1.0f), w.fresnel0);
    hdrp_v3 share, mean, diffuse;
    if ((features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u) {
        fgd = hdrp_i_brdf_fgd_stretched(mean_fgd, own,
                                        hdrp_brdf_fgd_fast(w.n_dot_v, d.perceptual_roughness));
    }
    w.bounces = hdrp_brdf_bounces_make(w.fit, w.fresnel0, w.fresnel90);
    w.multiscatter = (1.0f - own.albedo) * HDRP_INV_PI / w.fit.mean_loss;
    w.specular_albedo =
        hdrp_v3_saturate(hdrp_v3_mad(hdrp_brdf_specular_albedo(fgd, w.fresnel0, w.fresnel90),
                                     w.bounces.reflected, 1.0f - hdrp_saturate(fgd.albedo)));
    share = hdrp_brdf_diffuse_share(own, w.bounces, w.fresnel90);
    mean = hdrp_brdf_diffuse_share_mean(w.fit, w.bounces, w.fresnel90);
    diffuse = hdrp_v3_mul(hdrp_v3_mul(d.diffuse_color, below), share);
    if ((features & HDRP_BRDF_LIT_EXACT) != 0u &&
        (features & HDRP_BRDF_FEATURE_IRIDESCENCE) != 0u) {
        hdrp_v3 one = hdrp_v3_splat(1.0f);
        hdrp_v3 f = hdrp_i_brdf_lit_f_mean(d, w, features);
        hdrp_v3 again = w.bounces.reflected;
        float albedo = hdrp_saturate(fgd.albedo);
        w.specular_albedo = hdrp_v3_saturate(hdrp_v3_lerp(again, f, albedo));
        diffuse = hdrp_v3_mul(d.diffuse_color,
                              hdrp_v3_sub(one, hdrp_v3_lerp(again, f, hdrp_saturate(own.albedo))));
    }
    w.diffuse = hdrp_v3_make(HDRP_INV_PI * diffuse.x / mean.x, HDRP_INV_PI * diffuse.y / mean.y,
                             HDRP_INV_PI * diffuse.z / mean.z);
    w.diffuse_albedo = hdrp_i_brdf_no_more_than_left(diffuse, d.diffuse_color, w.specular_albedo);
    return w;
}

/** w with its diffuse lobe weakened. */
HDRP_FN hdrp_brdf_lit_view hdrp_i_brdf_lit_view_scale_diffuse(hdrp_brdf_lit_view w, hdrp_v3 scale)
{
    w.diffuse = hdrp_v3_mul(w.diffuse, scale);
    w.diffuse_albedo = hdrp_v3_mul(w.diffuse_albedo, scale);
    return w;
}

/** Transmittance of the slab. That of a wall without one shares the field. */
HDRP_FN hdrp_v3 hdrp_i_brdf_slab_transmittance(hdrp_brdf_data d)
{
    return hdrp_v3_scale(d.transmittance,
                         hdrp_i_brdf_feature(1.0f, d.features, HDRP_BRDF_FEATURE_TRANSMISSION));
}

/** Share of diffuse light that stays in front of a thin slab: what crosses it cannot be reflected.
 *  1 / (1 + color transmittance) keeps both together below 1, leaves dark or dense slabs as they
 *  are, and splits white light evenly where the slab is thinnest. */
HDRP_FN hdrp_v3 hdrp_i_brdf_slab_share(hdrp_v3 diffuse_color, hdrp_v3 transmittance)
{
    return hdrp_v3_make(1.0f / (1.0f + diffuse_color.x * transmittance.x),
                        1.0f / (1.0f + diffuse_color.y * transmittance.y),
                        1.0f / (1.0f + diffuse_color.z * transmittance.z));
}

/** What the lights of a pixel share.
 *  d         valid  material
 *  v         unit   towards the viewer
 *  fgd       valid  at the cosine of v and d.perceptual_roughness, by hdrp_brdf_fgd_lookup or
 *            hdrp_brdf_fgd_fast; only hdrp_brdf_lit_env_make and hdrp_brdf_lit_pdf depend on it
 *  features  any    HDRP_BRDF_FEATURE_... that the material may have, HDRP_BRDF_LIT_EXACT
 *  returns   valid
 *  edges     a v below the surface is bent to just above it, as normal maps make them; one below
 *            the coat likewise, for the coat alone
 *  error     none: composed of the functions above
 *  source    Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *            Definition Render Pipeline", slides on the Lit shader
 *  note      light that crosses a thin slab is missing from its front, unlike in the source. A
 *            white surface reflects at most 1.005 of what it receives, and at least 0.99; where it
 *            is anisotropic and not a metal at least 0.97 (anisotropy 0.5) and 0.93 (1), for an
 *            n_dot_v of at least 0.05 */
HDRP_FN hdrp_brdf_lit_view hdrp_brdf_lit_view_make(hdrp_brdf_data d, hdrp_v3 v, hdrp_brdf_fgd fgd,
                                                   hdrp_u32 features)
{
    hdrp_brdf_lit_view w;
    w.v = hdrp_i_brdf_facing(v, d.normal);
    w.n_dot_v = hdrp_clamp(hdrp_v3_dot(d.normal, w.v), HDRP_BRDF_N_DOT_V_MIN, 1.0f);
    w.alphas = hdrp_i_brdf_lit_alphas(d, features);
    w = hdrp_i_brdf_lit_view_set_fit(w, d, features);
    w = hdrp_i_brdf_lit_view_set_fresnel(w, d, features);
    w = hdrp_i_brdf_lit_view_set_lobes(w, d, fgd, features);
    if ((features & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u) {
        w = hdrp_i_brdf_lit_view_scale_diffuse(
            w, hdrp_i_brdf_slab_share(d.diffuse_color, hdrp_i_brdf_slab_transmittance(d)));
    }
    w.transmitted = hdrp_v3_splat(0.0f);
    w.transmitted_alpha = w.alphas.t;
    if ((features & HDRP_BRDF_FEATURE_REFRACTION) != 0u) {
        w = hdrp_i_brdf_lit_view_scale_diffuse(w, hdrp_v3_splat(1.0f - d.transmission));
        w.transmitted =
            hdrp_v3_scale(hdrp_v3_mul(d.diffuse_color, d.transmittance), d.transmission);
        w.transmitted_alpha = hdrp_brdf_alpha_from_perceptual_roughness(
            hdrp_brdf_refraction_perceptual_roughness(d.perceptual_roughness, d.ior));
    }
    w.coat_v = w.v;
    w.coat_n_dot_v = w.n_dot_v;
    w.coat_alpha = w.alphas.t;
    w.below_coat = 1.0f;
    if ((features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u) {
        w.coat_v = hdrp_i_brdf_facing(w.v, d.coat_normal);
        w.coat_n_dot_v =
            hdrp_clamp(hdrp_v3_dot(d.coat_normal, w.coat_v), HDRP_BRDF_N_DOT_V_MIN, 1.0f);
        w.coat_alpha = hdrp_brdf_alpha_from_perceptual_roughness(d.coat_perceptual_roughness);
        w.below_coat = hdrp_i_brdf_below_coat(d.coat_mask, w.coat_n_dot_v);
    }
    return w;
}

/** The view for a light whose source has a size: as if normals varied that much more.
 *  w         valid
 *  variance  [0,1]  in units of alpha^2, such as hdrp_light_variance gives
 *  returns   valid  for hdrp_brdf_lit_eval alone
 *  edges     unchanged for variance 0
 *  error     none: variances of independent deviations add up
 *  source    Kaplanyan et al. 2016, "Filtering Distributions of Normals for Shading Antialiasing",
 *            eq. 8 */
HDRP_FN hdrp_brdf_lit_view hdrp_brdf_lit_view_widened(hdrp_brdf_lit_view w, float variance)
{
    w.alphas.t = hdrp_sqrt(w.alphas.t * w.alphas.t + variance);
    w.alphas.b = hdrp_sqrt(w.alphas.b * w.alphas.b + variance);
    w.coat_alpha = hdrp_sqrt(w.coat_alpha * w.coat_alpha + variance);
    return w;
}

/** D V of the base lobe. */
HDRP_FN float hdrp_i_brdf_lit_dv(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 l, hdrp_v3 h,
                                 float n_dot_l, hdrp_u32 features)
{
    if ((features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u) {
        return hdrp_brdf_d_ggx_aniso_vectors(d.tangent, d.bitangent, d.normal, h, w.alphas.t,
                                             w.alphas.b) *
               hdrp_brdf_v_smith_ggx_aniso(hdrp_v3_dot(d.tangent, l), hdrp_v3_dot(d.bitangent, l),
                                           n_dot_l, hdrp_v3_dot(d.tangent, w.v),
                                           hdrp_v3_dot(d.bitangent, w.v), w.n_dot_v, w.alphas.t,
                                           w.alphas.b);
    }
    return hdrp_brdf_dv_ggx_vectors(d.normal, h, n_dot_l, w.n_dot_v, w.alphas.t);
}

/** The coat's own lobe, cosine included. */
HDRP_FN float hdrp_i_brdf_lit_coat(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 l,
                                   float coat_n_dot_l)
{
    hdrp_v3 h = hdrp_brdf_half_vector(l, w.coat_v, d.coat_normal);
    float l_dot_h = hdrp_saturate(hdrp_v3_dot(l, h));
    return d.coat_mask * hdrp_brdf_f_schlick(HDRP_BRDF_COAT_FRESNEL0, 1.0f, l_dot_h) *
           hdrp_brdf_dv_ggx_vectors(d.coat_normal, h, coat_n_dot_l, w.coat_n_dot_v, w.coat_alpha) *
           coat_n_dot_l;
}

/** Light refracted through a thin wall. */
HDRP_FN hdrp_v3 hdrp_i_brdf_lit_refracted(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 l)
{
    return hdrp_v3_mul(w.transmitted, hdrp_brdf_btdf_thin_ggx(d.normal, w.v, l, w.transmitted_alpha,
                                                              w.fresnel0, w.fresnel90));
}

/** What the base lobe reflects at the first bounce, cosine included. */
HDRP_FN hdrp_v3 hdrp_i_brdf_lit_first(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 l, hdrp_v3 h,
                                      hdrp_u32 features)
{
    float front = hdrp_saturate(hdrp_v3_dot(d.normal, l));
    hdrp_v3 f = hdrp_i_brdf_lit_f(d, w, hdrp_v3_dot(l, h), features);
    return hdrp_v3_scale(f, hdrp_i_brdf_lit_dv(d, w, l, h, front, features) * front);
}

/** The Lit model, from its first bounce, its diffuse lobe without cosine, and the albedo of l.
 *  Shaders that keep little in registers call the parts one after the other. */
HDRP_FN hdrp_brdf_lit hdrp_i_brdf_lit_rest(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 l,
                                           hdrp_v3 first, hdrp_v3 diffuse, float albedo,
                                           hdrp_u32 features)
{
    hdrp_brdf_lit r;
    float n_dot_l = hdrp_v3_dot(d.normal, l);
    float front = hdrp_saturate(n_dot_l);
    float again = w.multiscatter * (1.0f - albedo) * front;
    r.specular = hdrp_v3_mad(first, w.bounces.reflected, again);
    r.diffuse = hdrp_v3_scale(diffuse, front);
    if ((features & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u) {
        hdrp_v3 through = hdrp_v3_mul(diffuse, hdrp_i_brdf_slab_transmittance(d));
        r.diffuse = hdrp_v3_mad(r.diffuse, through, hdrp_saturate(-n_dot_l));
    }
    if ((features & HDRP_BRDF_FEATURE_REFRACTION) != 0u) {
        r.specular = hdrp_v3_add(r.specular, hdrp_i_brdf_lit_refracted(d, w, l));
    }
    if ((features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u) {
        float coat_n_dot_l = hdrp_v3_dot(d.coat_normal, l);
        float coat_front = hdrp_saturate(coat_n_dot_l);
        float both = w.below_coat * hdrp_i_brdf_below_coat(d.coat_mask, hdrp_abs(coat_n_dot_l));
        float coat = hdrp_i_brdf_lit_coat(d, w, l, coat_front);
        r.diffuse = hdrp_v3_scale(r.diffuse, both);
        r.specular = hdrp_v3_add(hdrp_v3_scale(r.specular, both), hdrp_v3_splat(coat));
    }
    return r;
}

/** The Lit model for one light direction.
 *  d         valid  material
 *  w         valid  of the same material and features
 *  l         unit   towards the light
 *  features  any    as for hdrp_brdf_lit_view_make
 *  returns   valid  times the light's illuminance it is reflected luminance
 *  requires  hdrp_abs(hdrp_v3_dot(d.normal, w.v) - w.n_dot_v) < 1e-5f; w was made from d
 *  edges     black below the horizon, but for light through a thin slab or wall
 *  error     none: composed of the functions above
 *  source    Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *            Definition Render Pipeline", slides on the Lit shader
 *  note      the source scales the base under a coat by (1 - F(l_dot_h))^2 and leaves the diffuse
 *            lobe alone, which gains energy at grazing. Here the coat dims light on its way in and
 *            on its way out, each by the cosine of its own direction */
HDRP_FN hdrp_brdf_lit hdrp_brdf_lit_eval(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 l,
                                         hdrp_u32 features)
{
    float n_dot_l = hdrp_v3_dot(d.normal, l);
    hdrp_v3 h = hdrp_brdf_half_vector(l, w.v, d.normal);
    hdrp_v3 first = hdrp_i_brdf_lit_first(d, w, l, h, features);
    hdrp_brdf_fgd fgd = hdrp_i_brdf_lit_fgd(d, w, l, hdrp_abs(n_dot_l), features);
    hdrp_v3 diffuse = hdrp_v3_mul(w.diffuse, hdrp_brdf_diffuse_share(fgd, w.bounces, w.fresnel90));
    return hdrp_i_brdf_lit_rest(d, w, l, first, diffuse, fgd.albedo, features);
}

/* What the Lit model asks of a prefiltered environment. Reflected light is the sum of
 *   specular_weight * radiance(specular_direction, specular_perceptual_roughness)
 *   coat_weight * radiance(coat_direction, coat_perceptual_roughness)
 *   diffuse_weight * irradiance(normal) / pi + through_weight * irradiance(-normal) / pi
 *   transmitted_weight * radiance(transmitted_direction, transmitted_perceptual_roughness). */
struct hdrp_brdf_lit_env {
    hdrp_v3 specular_direction;             /* unit */
    float specular_perceptual_roughness;    /* [0,1] */
    hdrp_v3 specular_weight;                /* [0,1] */
    hdrp_v3 coat_direction;                 /* unit */
    float coat_perceptual_roughness;        /* [0,1] */
    float coat_weight;                      /* [0,1] */
    hdrp_v3 diffuse_weight;                 /* [0,1] */
    hdrp_v3 through_weight;                 /* [0,1] */
    hdrp_v3 transmitted_direction;          /* unit */
    float transmitted_perceptual_roughness; /* [0,1] */
    hdrp_v3 transmitted_weight;             /* [0,1] */
};
HDRP_TYPEDEF(hdrp_brdf_lit_env)

/** Direction from which a GGX lobe receives most of an environment that was filtered for views
 *  along the normal: between the mirror direction and the normal.
 *  n          unit   shading normal
 *  reflected  unit   mirror direction of the view
 *  alpha      [0,1]  GGX width
 *  returns    unit
 *  edges      the mirror direction for alpha 0, n for alpha 1
 *  error      none: an empirical fit of the source
 *  source     Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *             listing 22 */
HDRP_FN hdrp_v3 hdrp_brdf_dominant_direction(hdrp_v3 n, hdrp_v3 reflected, float alpha)
{
    float smoothness = 1.0f - hdrp_saturate(alpha);
    float t = smoothness * (hdrp_sqrt(smoothness) + hdrp_saturate(alpha));
    return hdrp_normalize_or(hdrp_v3_lerp(n, reflected, t), n);
}

/** e with the light that a refractive material lets through. */
HDRP_FN hdrp_brdf_lit_env hdrp_i_brdf_lit_env_set_transmitted(hdrp_brdf_lit_env e, hdrp_brdf_data d,
                                                              hdrp_brdf_lit_view w)
{
    float p = hdrp_brdf_refraction_perceptual_roughness(d.perceptual_roughness, d.ior);
    hdrp_brdf_fgd fgd = hdrp_brdf_fgd_fast(w.n_dot_v, p);
    hdrp_v3 reflected = hdrp_brdf_specular_albedo(fgd, w.fresnel0, w.fresnel90);
    e.transmitted_perceptual_roughness = p;
    e.transmitted_weight = hdrp_i_brdf_no_more_than_left(
        hdrp_v3_mul(w.transmitted, hdrp_v3_sub(hdrp_v3_splat(fgd.albedo), reflected)),
        w.transmitted, w.specular_albedo);
    if (d.volume_thickness_m > 0.0f) {
        e.transmitted_direction = hdrp_brdf_refract(w.v, d.normal, 1.0f / d.ior).direction;
    }
    return e;
}

/* Cosine-weighted mean of the coat's Fresnel term over the hemisphere, (1 + 20 F0) / 21. */
#define HDRP_I_BRDF_COAT_FRESNEL_MEAN (1.8f / 21.0f)

/** e with the coat, which dims what lies below it. Light of the specular lobe is taken to meet the
 *  coat at the angles at which it meets the microfacets, diffuse light at all angles. */
HDRP_FN hdrp_brdf_lit_env hdrp_i_brdf_lit_env_set_coat(hdrp_brdf_lit_env e, hdrp_brdf_data d,
                                                       hdrp_brdf_lit_view w, hdrp_u32 features)
{
    hdrp_brdf_fgd coat = hdrp_brdf_fgd_fast(w.coat_n_dot_v, d.coat_perceptual_roughness);
    hdrp_brdf_fgd base = hdrp_i_brdf_lit_fgd(d, w, w.v, w.n_dot_v, features);
    float weight = base.schlick / base.albedo;
    float lobe = 1.0f - d.coat_mask * hdrp_lerp(HDRP_BRDF_COAT_FRESNEL0, 1.0f, weight);
    float all_around = 1.0f - d.coat_mask * HDRP_I_BRDF_COAT_FRESNEL_MEAN;
    e.coat_direction = hdrp_normalize_or(hdrp_i_brdf_reflect(w.coat_v, d.coat_normal), d.normal);
    e.coat_weight = d.coat_mask * hdrp_lerp(coat.schlick, coat.albedo, HDRP_BRDF_COAT_FRESNEL0);
    e.specular_weight = hdrp_v3_scale(e.specular_weight, w.below_coat * lobe);
    e.transmitted_weight = hdrp_v3_scale(e.transmitted_weight, w.below_coat * lobe);
    e.diffuse_weight = hdrp_v3_scale(e.diffuse_weight, w.below_coat * all_around);
    return e;
}

/** What the Lit model asks of a prefiltered environment.
 *  d         valid  material; its occlusions are part of the weights
 *  w         valid  of the same material and features
 *  features  any    as for hdrp_brdf_lit_view_make
 *  returns   valid
 *  requires  hdrp_abs(hdrp_v3_dot(d.normal, w.v) - w.n_dot_v) < 1e-5f; w was made from d
 *  edges     weights of absent features are 0
 *  error     none: composed of the functions above
 *  source    Karis 2013, "Real Shading in Unreal Engine 4", section "Image-Based Lighting";
 *            Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *            Definition Render Pipeline", slides on the Lit shader */
HDRP_FN hdrp_brdf_lit_env hdrp_brdf_lit_env_make(hdrp_brdf_data d, hdrp_brdf_lit_view w,
                                                 hdrp_u32 features)
{
    hdrp_brdf_lit_env e;
    hdrp_brdf_env_lobe lobe;
    lobe.normal = d.normal;
    lobe.perceptual_roughness = d.perceptual_roughness;
    if ((features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u) {
        lobe = hdrp_brdf_env_lobe_aniso(d.tangent, d.bitangent, d.normal, w.v, d.anisotropy,
                                        d.perceptual_roughness);
    }
    e.specular_direction = hdrp_brdf_dominant_direction(
        lobe.normal, hdrp_normalize_or(hdrp_i_brdf_reflect(w.v, lobe.normal), lobe.normal),
        hdrp_brdf_alpha_from_perceptual_roughness(lobe.perceptual_roughness));
    e.specular_perceptual_roughness = lobe.perceptual_roughness;
    e.specular_weight = w.specular_albedo;
    e.diffuse_weight = w.diffuse_albedo;
    e.coat_direction = d.normal;
    e.coat_perceptual_roughness = d.coat_perceptual_roughness;
    e.coat_weight = 0.0f;
    e.transmitted_direction = hdrp_v3_neg(w.v);
    e.transmitted_perceptual_roughness = d.perceptual_roughness;
    e.transmitted_weight = hdrp_v3_splat(0.0f);
    if ((features & HDRP_BRDF_FEATURE_REFRACTION) != 0u) {
        e = hdrp_i_brdf_lit_env_set_transmitted(e, d, w);
    }
    if ((features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u) {
        e = hdrp_i_brdf_lit_env_set_coat(e, d, w, features);
    }
    e.through_weight = hdrp_v3_splat(0.0f);
    if ((features & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u) {
        e.through_weight = hdrp_v3_mul(e.diffuse_weight, hdrp_i_brdf_slab_transmittance(d));
    }
    e.diffuse_weight = hdrp_v3_scale(e.diffuse_weight, d.ambient_occlusion);
    e.specular_weight = hdrp_v3_scale(e.specular_weight, d.specular_occlusion);
    e.coat_weight *= d.specular_occlusion;
    return e;
}

/* >>sampling lit
 * One direction from all lobes of the Lit model, for path tracers. */

/* Least share of its light by which a refracting wall is chosen. At a grazing view the Fresnel term
 * of the view is 1, but facets of a rough wall are met at other angles and let light in. */
#define HDRP_I_BRDF_REFRACTED_MIN 0.25f

/* Relative shares of the lobes, and the sum of all. */
struct hdrp_i_brdf_shares {
    float diffuse; /* with what bounces more than once between microfacets */
    float through;
    float coat;
    float refracted;
    float specular;
    float sum;
};
HDRP_TYPEDEF(hdrp_i_brdf_shares)

HDRP_FN hdrp_i_brdf_shares hdrp_i_brdf_lit_shares(hdrp_brdf_data d, hdrp_brdf_lit_view w,
                                                  hdrp_u32 features)
{
    hdrp_i_brdf_shares s;
    float again =
        hdrp_v3_max_component(w.bounces.reflected) * w.multiscatter * HDRP_PI * w.fit.mean_loss;
    float diffuse = hdrp_v3_max_component(w.diffuse_albedo) * w.below_coat;
    float f = hdrp_brdf_f_schlick(hdrp_v3_max_component(w.fresnel0), w.fresnel90, w.n_dot_v);
    s.diffuse = diffuse + again * w.below_coat;
    s.through = (features & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u
                    ? diffuse * hdrp_v3_max_component(hdrp_i_brdf_slab_transmittance(d))
                    : 0.0f;
    s.coat = (features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u ? 1.0f - w.below_coat : 0.0f;
    s.refracted = (features & HDRP_BRDF_FEATURE_REFRACTION) != 0u
                      ? hdrp_v3_max_component(w.transmitted) *
                            hdrp_max(1.0f - f, HDRP_I_BRDF_REFRACTED_MIN) * w.below_coat
                      : 0.0f;
    s.specular = (hdrp_v3_max_component(w.specular_albedo) - again) * w.below_coat;
    /* A black material still needs some lobe. */
    s.specular = hdrp_max(s.specular, 1e-3f);
    s.sum = s.diffuse + s.through + s.coat + s.refracted + s.specular;
    return s;
}

/** Equal widths of an isotropic lobe. */
HDRP_FN hdrp_brdf_alphas hdrp_i_brdf_equal_alphas(float perceptual_roughness)
{
    hdrp_brdf_alphas a;
    a.t = hdrp_brdf_alpha_from_perceptual_roughness(perceptual_roughness);
    a.b = a.t;
    return a;
}

/** The widths of light refracted through a thin wall. */
HDRP_FN hdrp_brdf_alphas hdrp_i_brdf_refracted_alphas(hdrp_brdf_data d)
{
    return hdrp_i_brdf_equal_alphas(
        hdrp_brdf_refraction_perceptual_roughness(d.perceptual_roughness, d.ior));
}

/** Density of a reflected direction of a GGX lobe about a frame; below the horizon too, where some
 *  visible normals reflect. */
HDRP_FN float hdrp_i_brdf_lobe_pdf(hdrp_v3 t, hdrp_v3 b, hdrp_v3 n, hdrp_v3 view, hdrp_v3 l,
                                   hdrp_brdf_alphas a)
{
    hdrp_v3 v = hdrp_i_brdf_facing(view, n);
    hdrp_v3 h = hdrp_brdf_half_vector(l, v, n);
    hdrp_v3 dh = hdrp_v3_sub(h, n);
    hdrp_v3 v_local = hdrp_v3_make(hdrp_v3_dot(t, v), hdrp_v3_dot(b, v), hdrp_v3_dot(n, v));
    hdrp_v3 h_local = hdrp_v3_make(hdrp_v3_dot(t, dh), hdrp_v3_dot(b, dh), hdrp_v3_dot(n, h));
    return h_local.z > 0.0f ? hdrp_brdf_pdf_vndf(v_local, h_local, a.t, a.b) : 0.0f;
}

/** Density of hdrp_brdf_lit_sample.
 *  d         valid  material
 *  w         valid  of the same material and features
 *  l         unit   towards the light
 *  features  any    as for hdrp_brdf_lit_view_make
 *  returns   [0,inf)  1/sr, per solid angle
 *  requires  hdrp_abs(hdrp_v3_dot(d.normal, w.v) - w.n_dot_v) < 1e-5f; w was made from d
 *  edges     integrates to 1 over the sphere: it counts what a lobe reflects below the horizon
 *  error     none: held to the sampler by a chi-squared test
 *  source    Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", chapter 9 */
HDRP_FN float hdrp_brdf_lit_pdf(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 l,
                                hdrp_u32 features)
{
    hdrp_i_brdf_shares s = hdrp_i_brdf_lit_shares(d, w, features);
    float n_dot_l = hdrp_v3_dot(d.normal, l);
    float p = s.specular * hdrp_i_brdf_lobe_pdf(d.tangent, d.bitangent, d.normal, w.v, l, w.alphas);
    p += s.diffuse * hdrp_hemisphere_cosine_pdf(n_dot_l);
    p += s.through * hdrp_hemisphere_cosine_pdf(-n_dot_l);
    if ((features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u) {
        hdrp_basis f = hdrp_basis_from_normal(d.coat_normal);
        p += s.coat * hdrp_i_brdf_lobe_pdf(f.tangent, f.bitangent, d.coat_normal, w.coat_v, l,
                                           hdrp_i_brdf_equal_alphas(d.coat_perceptual_roughness));
    }
    if ((features & HDRP_BRDF_FEATURE_REFRACTION) != 0u) {
        hdrp_v3 mirrored = hdrp_v3_mad(l, d.normal, -2.0f * n_dot_l);
        p += s.refracted * hdrp_i_brdf_lobe_pdf(d.tangent, d.bitangent, d.normal, w.v, mirrored,
                                                hdrp_i_brdf_refracted_alphas(d));
    }
    return p / s.sum;
}

/** Vector from its components in a frame. */
HDRP_FN hdrp_v3 hdrp_i_brdf_from_frame(hdrp_v3 t, hdrp_v3 b, hdrp_v3 n, hdrp_v3 x)
{
    return hdrp_v3_mad(hdrp_v3_mad(hdrp_v3_scale(t, x.x), b, x.y), n, x.z);
}

/** Mirror direction of v about a half vector drawn from a GGX lobe. */
HDRP_FN hdrp_v3 hdrp_i_brdf_lobe_sample(hdrp_v3 t, hdrp_v3 b, hdrp_v3 n, hdrp_v3 view,
                                        hdrp_brdf_alphas a, hdrp_v2 u)
{
    hdrp_v3 v = hdrp_i_brdf_facing(view, n);
    hdrp_v3 v_local = hdrp_v3_make(hdrp_v3_dot(t, v), hdrp_v3_dot(b, v), hdrp_v3_dot(n, v));
    hdrp_v3 h = hdrp_i_brdf_from_frame(t, b, n, hdrp_brdf_sample_vndf(v_local, a.t, a.b, u));
    return hdrp_i_brdf_reflect(v, h);
}

/** Direction drawn in proportion, roughly, to the Lit model: for path tracers.
 *  d         valid  material
 *  w         valid  of the same material and features
 *  u         [0,1]  three independent uniform numbers; the first chooses the lobe
 *  features  any    as for hdrp_brdf_lit_view_make
 *  returns   unit   towards a light; where hdrp_brdf_lit_eval is 0 there, the path ends
 *  requires  hdrp_abs(hdrp_v3_dot(d.normal, w.v) - w.n_dot_v) < 1e-5f; w was made from d
 *  edges     total for u of 0 and 1
 *  error     none: held to hdrp_brdf_lit_pdf by a chi-squared test
 *  source    Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", chapter 9 */
HDRP_FN hdrp_v3 hdrp_brdf_lit_sample(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_v3 u,
                                     hdrp_u32 features)
{
    hdrp_i_brdf_shares s = hdrp_i_brdf_lit_shares(d, w, features);
    float x = u.x * s.sum;
    float through = s.diffuse + s.through;
    float coat = through + s.coat;
    hdrp_v2 uv = hdrp_v2_make(u.y, u.z);
    hdrp_v3 l;
    if (x < through) {
        l = hdrp_hemisphere_cosine(uv);
        l.z = x < s.diffuse ? l.z : -l.z;
        l = hdrp_i_brdf_from_frame(d.tangent, d.bitangent, d.normal, l);
    } else if ((features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u && x < coat) {
        hdrp_basis f = hdrp_basis_from_normal(d.coat_normal);
        l = hdrp_i_brdf_lobe_sample(f.tangent, f.bitangent, d.coat_normal, w.coat_v,
                                    hdrp_i_brdf_equal_alphas(d.coat_perceptual_roughness), uv);
    } else if ((features & HDRP_BRDF_FEATURE_REFRACTION) != 0u && x < coat + s.refracted) {
        l = hdrp_i_brdf_lobe_sample(d.tangent, d.bitangent, d.normal, w.v,
                                    hdrp_i_brdf_refracted_alphas(d), uv);
        l = hdrp_v3_mad(l, d.normal, -2.0f * hdrp_v3_dot(l, d.normal));
    } else {
        l = hdrp_i_brdf_lobe_sample(d.tangent, d.bitangent, d.normal, w.v, w.alphas, uv);
    }
    return hdrp_normalize_or(l, d.normal);
}

/* >>fgd table, C and C++ only */
#ifndef HDRP_GPU
#ifdef __cplusplus
extern "C" {
#endif

/** FGD by quadrature, to 1e-4 and without noise: what the table holds.
 *  n_dot_v               [0,1]  cosine between unit normal and direction to the viewer
 *  perceptual_roughness  [0,1]
 *  returns               valid
 *  edges                 inputs are limited; a grazing view below 1e-6 acts as 1e-6
 *  error                 <= 1e-4 absolute  @accuracy brdf_fgd_integrate
 *  source                the integrals of Karis 2013, "Real Shading in Unreal Engine 4"; the
 *                        azimuth of the distribution in closed form, the polar angle by
 *                        Gauss-Legendre nodes gathered at the mirror direction */
HDRP_API hdrp_brdf_fgd hdrp_brdf_fgd_integrate(float n_dot_v, float perceptual_roughness);

/** Rows of the FGD table: columns are views, rows are roughnesses, see hdrp_brdf_fgd_uv.
 *  table      size * size texels, row by row
 *  size       [2,4096] texels; 64 keeps a white furnace white to 0.1 % from n_dot_v 0.05 upwards
 *  row_begin  [0,4096] first row to write
 *  row_end    [0,4096] one past the last row to write
 *  returns    HDRP_OK, or an error with the table untouched
 *  errors     HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT
 *  memory     the caller's; nothing is allocated
 *  range      rows are independent: jobs may write disjoint ranges of rows in parallel */
HDRP_API hdrp_result hdrp_brdf_fgd_bake_rows(hdrp_brdf_fgd* table, int size, int row_begin,
                                             int row_end);

/** FGD from a table, bilinear.
 *  table                 size * size texels as written by hdrp_brdf_fgd_bake_rows
 *  size                  [2,4096] texels
 *  n_dot_v               [0,1]  cosine between unit normal and direction to the viewer
 *  perceptual_roughness  [0,1]
 *  returns               valid
 *  edges                 inputs are limited, NaN acts as 0
 *  error                 <= 0.0015 relative, size 64 and n_dot_v of at least 0.05
 *                        @accuracy brdf_fgd_lookup
 *  error                 <= 0.065 absolute, size 64 at any view  @accuracy brdf_fgd_lookup_grazing
 *  source                bilinear interpolation between texel centres */
HDRP_API hdrp_brdf_fgd hdrp_brdf_fgd_lookup(const hdrp_brdf_fgd* table, int size, float n_dot_v,
                                            float perceptual_roughness);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_BRDF_H */

#if defined(HDRP_BRDF_IMPLEMENTATION) && !defined(HDRP_BRDF_IMPLEMENTED)
#define HDRP_BRDF_IMPLEMENTED

/* Nodes of the quadrature of hdrp_brdf_fgd_integrate: polar on each side of the mirror direction,
 * azimuthal on a half turn. Chosen so that its error stays below 1e-4. */
#define HDRP_I_BRDF_POLAR_NODES   16
#define HDRP_I_BRDF_AZIMUTH_NODES 16

typedef struct hdrp_i_brdf_quadrature {
    double x[HDRP_I_BRDF_POLAR_NODES]; /* Gauss-Legendre nodes in (-1,1) */
    double w[HDRP_I_BRDF_POLAR_NODES];
    double tan2_half[HDRP_I_BRDF_AZIMUTH_NODES]; /* squared, of equidistant azimuths */
    double cosine[HDRP_I_BRDF_AZIMUTH_NODES];
} hdrp_i_brdf_quadrature;

/* The roots of the Legendre polynomial by Newton's method (Abramowitz and Stegun, 25.4.29). */
static void hdrp_i_brdf_quadrature_init(hdrp_i_brdf_quadrature* q)
{
    const double pi = 3.14159265358979323846;
    const int n = HDRP_I_BRDF_POLAR_NODES;
    int i, j, step;
    for (i = 0; i < n; ++i) {
        double x = cos(pi * ((double)i + 0.75) / ((double)n + 0.5));
        double slope = 1.0;
        for (step = 0; step < 6; ++step) {
            double p0 = 1.0, p1 = x;
            for (j = 2; j <= n; ++j) {
                double p2 = ((2.0 * j - 1.0) * x * p1 - (j - 1.0) * p0) / j;
                p0 = p1;
                p1 = p2;
            }
            slope = n * (x * p1 - p0) / (x * x - 1.0);
            x -= p1 / slope;
        }
        q->x[i] = x;
        q->w[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    for (i = 0; i < HDRP_I_BRDF_AZIMUTH_NODES; ++i) {
        double phi = pi * ((double)i + 0.5) / HDRP_I_BRDF_AZIMUTH_NODES;
        q->tan2_half[i] = tan(0.5 * phi) * tan(0.5 * phi);
        q->cosine[i] = cos(phi);
    }
}

static double hdrp_i_brdf_schlick_weight_of_square(double v_dot_h2)
{
    double x = 1.0 - sqrt(v_dot_h2);
    return x * x * x * x * x;
}

/* A polar angle by the cosine and the sine of its half. */
typedef struct hdrp_i_brdf_half_angle {
    double c, s;
} hdrp_i_brdf_half_angle;

/* D integrated over the azimuth of a light l, times alpha^-2; and the same weighted by Schlick.
 * With base = 2 (v.h)^2 = p - r cos(azimuth) the distribution is alpha^2 / pi times the square of
 * base / (base + q), so that the first integral is closed. The second splits into the constant
 * part, smooth in the azimuth, and the rest, smooth in the half-angle variable of 1 / (base + q).
 */
static void hdrp_i_brdf_azimuth(const hdrp_i_brdf_quadrature* nodes, hdrp_i_brdf_half_angle v,
                                hdrp_i_brdf_half_angle l, double alpha2, double* albedo,
                                double* schlick)
{
    double cs = l.c * v.c - l.s * v.s, cd = l.c * v.c + l.s * v.s; /* half sum and difference */
    double ss = l.s * v.c + l.c * v.s, sd = l.s * v.c - l.c * v.s;
    double lo = 2.0 * cs * cs * (sd * sd + alpha2 * cd * cd); /* base + q, azimuth 0 */
    double hi = 2.0 * cd * cd * (ss * ss + alpha2 * cs * cs); /* base + q, azimuth pi */
    double q = 2.0 * cs * cs * cd * cd * (alpha2 - 1.0);
    double p = cs * cs + cd * cd, r = 4.0 * l.s * l.c * v.s * v.c;
    double root = sqrt(lo * hi), k = sqrt(lo / hi), sum = 0.0;
    double terms[HDRP_I_BRDF_AZIMUTH_NODES]; /* a sum in the loop would keep it scalar */
    int i;
    for (i = 0; i < HDRP_I_BRDF_AZIMUTH_NODES; ++i) {
        double t2 = nodes->tan2_half[i], u2 = k * k * t2, w = 1.0 / (1.0 + u2);
        double base_q = lo + 2.0 * r * u2 * w, e = q / base_q;
        double direct = hdrp_i_brdf_schlick_weight_of_square(0.5 * (base_q - q));
        terms[i] = (e - 2.0) * e * k * (1.0 + t2) * w * direct +
                   hdrp_i_brdf_schlick_weight_of_square(0.5 * (p - r * nodes->cosine[i]));
    }
    for (i = 0; i < HDRP_I_BRDF_AZIMUTH_NODES; ++i) {
        sum += terms[i];
    }
    *albedo = 2.0 * (1.0 - 2.0 * q / root + 0.5 * (lo + hi) * q * q / (root * root * root));
    *schlick = 2.0 * sum / HDRP_I_BRDF_AZIMUTH_NODES;
}

/* Both halves of the hemisphere's polar angle, below and above the mirror direction. sinh gathers
 * the nodes there: a lobe of width alpha decays over a few of its arguments. At grazing a wide lobe
 * needs them as well, because shadowing changes on the scale of n_dot_v. */
static hdrp_brdf_fgd hdrp_i_brdf_integrate(const hdrp_i_brdf_quadrature* nodes, double n_dot_v,
                                           double alpha)
{
    const double half_pi = 1.57079632679489661923;
    double c = n_dot_v > 1e-6 ? (n_dot_v < 1.0 ? n_dot_v : 1.0) : 1e-6;
    double theta_v = acos(c), alpha2 = alpha * alpha;
    double gv = sqrt(c * c * (1.0 - alpha2) + alpha2);
    double gather = alpha / (1.0 + 20.0 * alpha * (1.0 - c) * (1.0 - c) * (1.0 - c));
    double albedo = 0.0, schlick = 0.0;
    hdrp_i_brdf_half_angle v;
    hdrp_brdf_fgd result;
    int side, i;
    v.c = cos(0.5 * theta_v);
    v.s = sin(0.5 * theta_v);
    for (side = 0; side < 2; ++side) {
        double t0 = side ? 0.0 : -asinh(theta_v / gather);
        double t1 = side ? asinh((half_pi - theta_v) / gather) : 0.0;
        for (i = 0; i < HDRP_I_BRDF_POLAR_NODES; ++i) {
            double e = exp(0.5 * (t0 + t1) + 0.5 * (t1 - t0) * nodes->x[i]);
            double theta = theta_v + 0.5 * gather * (e - 1.0 / e); /* sinh, and its slope cosh */
            double scale = 0.25 * (t1 - t0) * nodes->w[i] * gather * (e + 1.0 / e);
            double cl, gl, a, s;
            hdrp_i_brdf_half_angle l;
            l.c = cos(0.5 * theta);
            l.s = sin(0.5 * theta);
            cl = (l.c - l.s) * (l.c + l.s);
            gl = sqrt(cl * cl * (1.0 - alpha2) + alpha2);
            scale *= alpha2 * cl * l.s * l.c / (cl * gv + c * gl);
            hdrp_i_brdf_azimuth(nodes, v, l, alpha2, &a, &s);
            albedo += scale * a;
            schlick += scale * s;
        }
    }
    result.albedo = (float)(albedo < 1.0 ? albedo : 1.0);
    result.schlick = (float)(schlick < albedo ? schlick : albedo);
    return result;
}

hdrp_brdf_fgd hdrp_brdf_fgd_integrate(float n_dot_v, float perceptual_roughness)
{
    hdrp_i_brdf_quadrature nodes;
    float alpha = hdrp_brdf_alpha_from_perceptual_roughness(perceptual_roughness);
    hdrp_i_brdf_quadrature_init(&nodes);
    return hdrp_i_brdf_integrate(&nodes, (double)hdrp_saturate(n_dot_v), (double)alpha);
}

hdrp_result hdrp_brdf_fgd_bake_rows(hdrp_brdf_fgd* table, int size, int row_begin, int row_end)
{
    hdrp_i_brdf_quadrature nodes;
    int row, column;
    if (!table) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (size < 2 || size > 4096 || row_begin < 0 || row_end > size || row_begin > row_end) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    hdrp_i_brdf_quadrature_init(&nodes);
    for (row = row_begin; row < row_end; ++row) {
        float perceptual_roughness = (float)row / (float)(size - 1);
        float alpha = hdrp_brdf_alpha_from_perceptual_roughness(perceptual_roughness);
        for (column = 0; column < size; ++column) {
            double u = (double)column / (double)(size - 1);
            table[(size_t)row * (size_t)size + (size_t)column] =
                hdrp_i_brdf_integrate(&nodes, u * u, (double)alpha);
        }
    }
    return HDRP_OK;
}

hdrp_brdf_fgd hdrp_brdf_fgd_lookup(const hdrp_brdf_fgd* table, int size, float n_dot_v,
                                   float perceptual_roughness)
{
    float last = (float)(size - 1);
    float x = hdrp_sqrt(hdrp_saturate(n_dot_v)) * last;
    float y = hdrp_saturate(perceptual_roughness) * last;
    int i = x < last ? (int)x : size - 2, j = y < last ? (int)y : size - 2;
    float fx = x - (float)i, fy = y - (float)j;
    const hdrp_brdf_fgd* at = table + (size_t)j * (size_t)size + (size_t)i;
    const hdrp_brdf_fgd* next = at + size;
    hdrp_brdf_fgd r;
    r.albedo = hdrp_lerp(hdrp_lerp(at[0].albedo, at[1].albedo, fx),
                         hdrp_lerp(next[0].albedo, next[1].albedo, fx), fy);
    r.schlick = hdrp_lerp(hdrp_lerp(at[0].schlick, at[1].schlick, fx),
                          hdrp_lerp(next[0].schlick, next[1].schlick, fx), fy);
    return r;
}

#endif /* HDRP_BRDF_IMPLEMENTATION */
