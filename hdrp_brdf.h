/* hdrp_brdf.h - material model: artist data to engine data, every lobe, and the Lit model.
 * SPDX-License-Identifier: MIT
 *
 * See hdrp_math.h for the languages, the conventions and the override macros.
 *
 * >>index of the functions, without hdrp_brdf_ (written by tools/api_check.py --write)
 *   material: surface_default diffuse_color fresnel0 data_from_surface
 * >>end */
#ifndef HDRP_BRDF_H
#define HDRP_BRDF_H

#include "hdrp_math.h"

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

/* Narrowest GGX lobe. Every function of alpha treats a smaller one as this. */
#define HDRP_ALPHA_MIN 1e-4f
/* Smallest perceptual roughness whose alpha is HDRP_ALPHA_MIN. */
#define HDRP_PERCEPTUAL_ROUGHNESS_MIN 0.01f
/* The coat is a polyurethane or glass layer. */
#define HDRP_BRDF_COAT_IOR      1.5f
#define HDRP_BRDF_COAT_FRESNEL0 0.04f
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

/** Engine data of a surface in the base colour and metallic parametrisation.
 *  s        any  every field; NaN and out-of-range values are limited to the documented range
 *  returns  valid
 *  edges    a normal without direction becomes +Z, a tangent along the normal an arbitrary one;
 *           NaN becomes the lower bound of its field
 *  error    none: limits, and the two formulas above
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slides on material architecture */
HDRP_FN hdrp_brdf_data hdrp_brdf_data_from_surface(hdrp_brdf_surface s)
{
    hdrp_brdf_data d;
    float metallic = hdrp_saturate(s.metallic);
    hdrp_v3 base_color = hdrp_v3_saturate(s.base_color);
    hdrp_v3 n = hdrp_normalize_or(s.normal, hdrp_v3_make(0.0f, 0.0f, 1.0f));
    hdrp_v3 t = hdrp_normalize_or(s.tangent, hdrp_basis_from_normal(n).tangent);
    hdrp_v3 in_plane = hdrp_v3_mad(t, n, -hdrp_v3_dot(t, n));
    d.base_color = base_color;
    d.metallic = metallic;
    d.diffuse_color = hdrp_brdf_diffuse_color(base_color, metallic);
    d.fresnel0 = hdrp_brdf_fresnel0(base_color, metallic, hdrp_v3_saturate(s.dielectric_fresnel0));
    d.perceptual_roughness = hdrp_saturate(s.perceptual_roughness);
    d.normal = n;
    /* Below 1e-3 the tangent is the normal up to rounding and in_plane is noise. */
    if (hdrp_v3_dot(in_plane, in_plane) < 1e-6f) {
        in_plane = hdrp_basis_from_normal(n).tangent;
    }
    d.tangent = hdrp_v3_normalize(in_plane);
    d.bitangent = hdrp_v3_cross(n, d.tangent);
    d.ambient_occlusion = hdrp_saturate(s.ambient_occlusion);
    d.specular_occlusion = hdrp_saturate(s.specular_occlusion);
    d.anisotropy = hdrp_clamp(s.anisotropy, -1.0f, 1.0f);
    d.coat_mask = hdrp_saturate(s.coat_mask);
    d.coat_perceptual_roughness = hdrp_saturate(s.coat_perceptual_roughness);
    d.coat_normal = hdrp_normalize_or(s.coat_normal, n);
    d.film_mask = hdrp_saturate(s.film_mask);
    d.film_ior = hdrp_clamp(s.film_ior, 1.0f, 3.0f);
    d.film_thickness_nm = hdrp_clamp(s.film_thickness_nm, 0.0f, 3000.0f);
    d.subsurface_mask = hdrp_saturate(s.subsurface_mask);
    d.diffusion_profile = s.diffusion_profile & 15u;
    d.thickness = hdrp_saturate(s.thickness);
    d.transmittance = hdrp_v3_saturate(s.transmittance);
    d.transmission = hdrp_saturate(s.transmission);
    d.ior = hdrp_clamp(s.ior, 1.0f, 3.0f);
    d.features = s.features & HDRP_BRDF_FEATURE_ALL;
    return d;
}

#endif /* HDRP_BRDF_H */
