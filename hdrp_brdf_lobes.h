/* hdrp_brdf_lobes.h - Fresnel terms, GGX, directional albedo, diffuse, thin film, transmission.
 * SPDX-License-Identifier: MIT
 *
 * The lobes that hdrp_brdf.h builds its material from, each usable alone: scalars and vectors in,
 * values out, no material structs. See hdrp_math.h for the languages, the conventions and the
 * override macros.
 *
 *     float d = hdrp_brdf_d_ggx_vectors(n, h, alpha);
 *     float v = hdrp_brdf_v_smith_ggx(n_dot_l, n_dot_v, alpha);
 *     hdrp_v3 f = hdrp_brdf_f_schlick_rgb(fresnel0, 1.0f, l_dot_h);
 *
 * Roughness is never bare: perceptual_roughness is what artists set, alpha is its square.
 * Directions point away from the surface. Where a function has variants, the plain name is the
 * recommended one, _fast costs less, _exact costs more; the docstrings say what that buys.
 *
 * >>index of the functions, without hdrp_brdf_ (written by tools/api_check.py --write)
 *   fresnel: schlick_weight fresnel90 f_schlick f_schlick_rgb f_dielectric_exact f_conductor_exact
 *       fresnel0_from_ior ior_from_fresnel0 fresnel0_at_interface fresnel0_under_coat
 *       fresnel0_under_coat_fast refracted_cosine
 *   ggx: alpha_from_perceptual_roughness half_vector sin2_between d_ggx d_ggx_vectors v_smith_ggx
 *       dv_ggx dv_ggx_vectors v_smith_ggx_fast d_ggx_aniso d_ggx_aniso_vectors v_smith_ggx_aniso
 *   sampling ggx: sample_vndf pdf_vndf
 *   anisotropy: alphas_kulla alphas_disney kulla_from_alphas env_lobe_aniso
 *   directional albedo: fgd_uv fgd_fit_make fgd_fit_make_aniso fgd_stretch_make fgd_fit_towards
 *       fgd_from_fit fgd_fast energy_compensation bounces_make multiscatter specular_albedo
 *   diffuse: diffuse_disney diffuse_disney_normalized diffuse_share diffuse_share_mean diffuse
 *   thin film: film film_exact film_airy film_fast fresnel0_from_schlick
 *   transmission: refract volume_transmittance refraction_perceptual_roughness btdf_ggx
 *       btdf_thin_ggx
 *   specular antialiasing: variance_from_derivatives variance_from_average_normal
 *       perceptual_roughness_filtered
 *   occlusion: specular_occlusion
 * >>end */
#ifndef HDRP_BRDF_LOBES_H
#define HDRP_BRDF_LOBES_H

#include "hdrp_math.h"

#if HDRP_VERSION != 100
#error "hdrp_brdf_lobes.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* Narrowest GGX lobe. Every function of alpha treats a smaller one as this. */
#define HDRP_ALPHA_MIN 1e-4f
/* Smallest perceptual roughness whose alpha is HDRP_ALPHA_MIN. */
#define HDRP_PERCEPTUAL_ROUGHNESS_MIN 0.01f
/* The coat is a polyurethane or glass layer. */
#define HDRP_BRDF_COAT_IOR      1.5f
#define HDRP_BRDF_COAT_FRESNEL0 0.04f

/* >>fresnel
 * Schlick for real-time work, the exact equations where a reference is wanted. */

/* F0 below which no real dielectric lies (IOR 1.33 is 0.02): taken as specular occlusion. */
#define HDRP_BRDF_FRESNEL0_PHYSICAL_MIN 0.02f

/** Fifth power of 1 - u: the weight of Schlick's approximation.
 *  u        [0,1]  cosine between light and half vector
 *  returns  [0,1]  1 at grazing, 0 at normal incidence
 *  edges    u outside [0,1], as rounding makes it, is limited
 *  error    <= 5.2e-7 relative  @accuracy brdf_schlick_weight
 *  source   Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15 */
HDRP_FN float hdrp_brdf_schlick_weight(float u)
{
    float x = hdrp_saturate(1.0f - u);
    float x2 = x * x;
    return x2 * x2 * x;
}

/** Reflectance at grazing incidence that belongs to F0.
 *  fresnel0  [0,1]  per component
 *  returns   [0,1]  1 for every real material
 *  edges     0 for black, so that a surface without specular has none at grazing either
 *  error     none: definition
 *  source    Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *            section 3.1.2 */
HDRP_FN float hdrp_brdf_fresnel90(hdrp_v3 fresnel0)
{
    return hdrp_saturate(hdrp_v3_max_component(fresnel0) *
                         (1.0f / HDRP_BRDF_FRESNEL0_PHYSICAL_MIN));
}

/** Schlick's Fresnel reflectance.
 *  fresnel0   [0,1]  reflectance at normal incidence
 *  fresnel90  [0,1]  reflectance at grazing incidence, see hdrp_brdf_fresnel90
 *  u          [0,1]  cosine between light and half vector
 *  returns    [0,1]
 *  edges      exactly fresnel0 at u = 1 and fresnel90 at u = 0; u is limited to [0,1]
 *  error      <= 3e-7 absolute against Schlick in double  @accuracy brdf_f_schlick
 *  error      <= 0.04 absolute against a dielectric of IOR 1.5, F0 of 0.04
 *             @accuracy brdf_f_schlick_dielectric
 *  source     Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15
 *  note       against the true dielectric Fresnel term the approximation itself is off by up to
 *             0.036 (IOR 1.5), 0.060 (1.33), 0.125 (3); see hdrp_brdf_f_dielectric_exact */
HDRP_FN float hdrp_brdf_f_schlick(float fresnel0, float fresnel90, float u)
{
    return hdrp_lerp(fresnel0, fresnel90, hdrp_brdf_schlick_weight(u));
}

/** Schlick's Fresnel reflectance of a coloured surface.
 *  fresnel0   [0,1]  reflectance at normal incidence
 *  fresnel90  [0,1]  reflectance at grazing incidence, see hdrp_brdf_fresnel90
 *  u          [0,1]  cosine between light and half vector
 *  returns    [0,1]  per component
 *  edges      as hdrp_brdf_f_schlick
 *  error      none: hdrp_brdf_f_schlick by component
 *  source     Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15 */
HDRP_FN hdrp_v3 hdrp_brdf_f_schlick_rgb(hdrp_v3 fresnel0, float fresnel90, float u)
{
    return hdrp_v3_lerp(fresnel0, hdrp_v3_splat(fresnel90), hdrp_brdf_schlick_weight(u));
}

/** Unpolarised Fresnel reflectance between two dielectrics.
 *  cos_theta_i  [0,1]       cosine of the angle of incidence
 *  eta          [0.25,4]    IOR of the far side over IOR of the side the light is on
 *  returns      [0,1]       1 at total internal reflection
 *  edges        0 for eta = 1; 1 at grazing incidence otherwise
 *  error        <= 4e-6 absolute, cosines 1e-3 and more from that of the critical angle
 *               @accuracy brdf_f_dielectric_exact
 *  error        <= 0.003 absolute, at the critical angle, where the slope is infinite
 *               @accuracy brdf_f_dielectric_critical
 *  source       Born and Wolf 1999, "Principles of Optics", section 1.5.2, eq. 20 and 21
 *  note         each amplitude is multiplied by its conjugate factor, so that nothing cancels for
 *               eta close to 1 */
HDRP_FN float hdrp_brdf_f_dielectric_exact(float cos_theta_i, float eta)
{
    float c = hdrp_saturate(cos_theta_i);
    float e = (eta - 1.0f) * (eta + 1.0f);
    /* eta^2 - 1 + c^2, which is small near total reflection: from its smaller terms. */
    float g2 = c < HDRP_SQRT_HALF ? e + c * c : eta * eta - (1.0f - c) * (1.0f + c);
    float g = hdrp_sqrt(hdrp_max(g2, 0.0f));
    float s = c + g;
    float p = eta * eta * c + g;
    float rs = -e / hdrp_max(s * s, HDRP_FLT_MIN);
    float rp = e * ((eta * eta + 1.0f) * c * c - 1.0f) / hdrp_max(p * p, HDRP_FLT_MIN);
    return g2 > 0.0f ? hdrp_saturate(0.5f * (rs * rs + rp * rp)) : (e < 0.0f ? 1.0f : 0.0f);
}

/** Unpolarised Fresnel reflectance of a conductor in air.
 *  cos_theta_i  [0,1]       cosine of the angle of incidence
 *  eta          [0.01,20]   real part of the conductor's IOR over that of the outer medium
 *  kappa        [0,20]      imaginary part (extinction) over the IOR of the outer medium
 *  returns      [0,1]       for one wavelength or colour channel
 *  edges        1 at grazing incidence, except 0 for eta = 1 and kappa = 0
 *  error        <= 5e-7 absolute, for kappa of at least 0.01; below, as a dielectric
 *               @accuracy brdf_f_conductor_exact
 *  source       Lagarde 2013, "Memo on Fresnel equations", section "Dielectric-Conductor"
 *  note         a or b, whichever would cancel, is formed from the product a * b = eta * kappa */
HDRP_FN float hdrp_brdf_f_conductor_exact(float cos_theta_i, float eta, float kappa)
{
    float c = hdrp_saturate(cos_theta_i);
    float c2 = c * c;
    float s2 = (1.0f - c) * (1.0f + c);
    /* eta^2 - s^2 from its smaller terms, as in hdrp_brdf_f_dielectric_exact. */
    float es = c < HDRP_SQRT_HALF ? (eta - 1.0f) * (eta + 1.0f) + c2 : eta * eta - s2;
    float m = es - kappa * kappa;
    float ek = eta * kappa;
    float a2b2 = hdrp_sqrt(m * m + 4.0f * ek * ek);
    float large = hdrp_sqrt(0.5f * (a2b2 + hdrp_abs(m)));
    float a = m > 0.0f ? large : ek / hdrp_max(large, HDRP_FLT_MIN);
    float t2 = 2.0f * a * c;
    float rs = (a2b2 + c2 - t2) / hdrp_max(a2b2 + c2 + t2, HDRP_FLT_MIN);
    float t3 = c2 * a2b2 + s2 * s2;
    float rp = (t3 - t2 * s2) / hdrp_max(t3 + t2 * s2, HDRP_FLT_MIN);
    return hdrp_saturate(0.5f * rs * (1.0f + rp));
}

/** Reflectance at normal incidence of the interface between two dielectrics.
 *  transmitted_ior  [0.1,4e7]  IOR of the far side
 *  incident_ior     [0.1,10]   IOR of the side the light is on
 *  returns          [0,1]
 *  edges            0 for equal IORs
 *  error            <= 3.5e-7 absolute  @accuracy brdf_fresnel0_from_ior
 *  source           Lagarde 2013, "Memo on Fresnel equations", section "Fresnel at 0 degrees" */
HDRP_FN float hdrp_brdf_fresnel0_from_ior(float transmitted_ior, float incident_ior)
{
    return hdrp_sq((transmitted_ior - incident_ior) / (transmitted_ior + incident_ior));
}

/** IOR of a dielectric in air with the given reflectance at normal incidence.
 *  fresnel0  [0,1]
 *  returns   [1,3.4e7]
 *  edges     the pole at 1 is kept finite: 1 gives 3.3e7, whose F0 is 1 again
 *  error     <= 1.5e-7 absolute, in the F0 of the result  @accuracy brdf_ior_from_fresnel0
 *  source    Lagarde 2013, "Memo on Fresnel equations", section "Fresnel at 0 degrees"
 *  note      the result is a ratio: for an F0 against another medium multiply it by the IOR of that
 *            medium. A medium on the thinner side has the same F0 and the inverse ratio */
HDRP_FN float hdrp_brdf_ior_from_fresnel0(float fresnel0)
{
    float s = hdrp_sqrt(hdrp_saturate(fresnel0));
    return (1.0f + s) / hdrp_max(1.0f - s, 0.5f * HDRP_FLT_EPSILON);
}

/** F0 of a dielectric when the medium above it is not air.
 *  fresnel0      [0,1]   reflectance at normal incidence against air
 *  incident_ior  [1,3]   IOR of the medium above
 *  returns       [0,1]   reflectance at normal incidence of the interface
 *  edges         1 stays 1 and needs no infinite IOR; 0 where the IORs are equal
 *  error         <= 5e-7 absolute  @accuracy brdf_fresnel0_at_interface
 *  source        Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *                Definition Render Pipeline", slides on clear coat
 *  note          the two conversions of the source in one, in which the pole at 1 cancels */
HDRP_FN float hdrp_brdf_fresnel0_at_interface(float fresnel0, float incident_ior)
{
    float s = hdrp_sqrt(hdrp_saturate(fresnel0));
    float down = 1.0f - incident_ior;
    float up = 1.0f + incident_ior;
    return hdrp_sq((down + up * s) / (up + down * s));
}

/** F0 of the base under a clear coat of IOR 1.5, exactly.
 *  fresnel0  [0,1]  against air, per component
 *  returns   [0,1]  against the coat, per component
 *  edges     0 at 0.04 (the base has the coat's IOR) and 1 at 1; rises again below 0.04
 *  error     none: hdrp_brdf_fresnel0_at_interface by component
 *  source    Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *            Definition Render Pipeline", slides on clear coat */
HDRP_FN hdrp_v3 hdrp_brdf_fresnel0_under_coat(hdrp_v3 fresnel0)
{
    return hdrp_v3_make(hdrp_brdf_fresnel0_at_interface(fresnel0.x, HDRP_BRDF_COAT_IOR),
                        hdrp_brdf_fresnel0_at_interface(fresnel0.y, HDRP_BRDF_COAT_IOR),
                        hdrp_brdf_fresnel0_at_interface(fresnel0.z, HDRP_BRDF_COAT_IOR));
}

/** F0 of the base under a clear coat of IOR 1.5: the talk's cubic, three multiply-adds.
 *  fresnel0  [0,1]  against air
 *  returns   [0,1]  against the coat
 *  edges     0 below 0.066, 0.9963 at 1
 *  error     <= 0.042 absolute  @accuracy brdf_fresnel0_under_coat_fast
 *  error     <= 0.004 absolute, from 0.04 upwards  @accuracy brdf_fresnel0_under_coat_fast_upper
 *  source    Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *            Definition Render Pipeline", slides on clear coat
 *  note      below 0.04 the exact form rises again */
HDRP_FN float hdrp_brdf_fresnel0_under_coat_fast(float fresnel0)
{
    float f = fresnel0;
    return hdrp_saturate(-0.0256868f + f * (0.326846f + (0.978946f - 0.283835f * f) * f));
}

/** Cosine of the angle on the far side of an interface.
 *  cos_theta  [0,1]      on the near side
 *  eta        [0.25,4e7] IOR of the far side over IOR of the near side
 *  returns    [0,1]
 *  edges      0 at and beyond the critical angle; 1 at normal incidence
 *  error      <= 3e-7 absolute, of the squared cosine  @accuracy brdf_refracted_cosine
 *  source     Born and Wolf 1999, "Principles of Optics", section 1.5.1 (Snell's law) */
HDRP_FN float hdrp_brdf_refracted_cosine(float cos_theta, float eta)
{
    float sine = hdrp_sqrt(hdrp_max((1.0f - cos_theta) * (1.0f + cos_theta), 0.0f)) / eta;
    return hdrp_sqrt(hdrp_max((1.0f - sine) * (1.0f + sine), 0.0f));
}

/* >>ggx
 * D and V of the microfacet model D * V * F. Where the half vector is at hand, prefer the forms
 * that take vectors: an fp32 cosine close to 1 no longer carries the angle, so that a highlight
 * narrower than perceptual roughness 0.1 is noise when made from n_dot_h. */

/* Floor of the denominator of V. It is reached only where both cosines are below 1e-6, keeps
 * D * V finite there, and lets the product with n_dot_l = 0 be 0. */
#define HDRP_BRDF_V_DENOMINATOR_MIN 1e-10f

/** Alpha, the GGX width, of a perceptual roughness.
 *  perceptual_roughness  [0,1]
 *  returns               [HDRP_ALPHA_MIN,1]
 *  edges                 below HDRP_PERCEPTUAL_ROUGHNESS_MIN the result is HDRP_ALPHA_MIN
 *  error                 <= 1.2e-7 relative  @accuracy brdf_alpha_from_perceptual_roughness
 *  source                Burley 2012, "Physically-Based Shading at Disney", section 5.4 */
HDRP_FN float hdrp_brdf_alpha_from_perceptual_roughness(float perceptual_roughness)
{
    return hdrp_max(hdrp_sq(hdrp_saturate(perceptual_roughness)), HDRP_ALPHA_MIN);
}

/** Unit half vector of two unit directions.
 *  l        unit  towards the light
 *  v        unit  towards the viewer
 *  n        unit  what to return when l = -v leaves the half vector undefined
 *  returns  unit
 *  edges    l = -v gives n
 *  error    <= 1.5e-7 absolute, per component, for l and v as given where |l + v| >= 1e-3
 *           @accuracy brdf_half_vector
 *  source   Torrance and Sparrow 1967, "Theory for Off-Specular Reflection from Roughened
 *           Surfaces", section 2 */
HDRP_FN hdrp_v3 hdrp_brdf_half_vector(hdrp_v3 l, hdrp_v3 v, hdrp_v3 n)
{
    hdrp_v3 s = hdrp_v3_add(l, v);
    float d = hdrp_v3_dot(s, s);
    /* Squares of what is left of shorter sums would lose digits to underflow. */
    return hdrp_v3_select(d >= 1e-30f ? 1.0f : 0.0f, hdrp_v3_scale(s, 1.0f / hdrp_sqrt(d)), n);
}

/** Squared sine of the angle between two unit vectors, precise for the smallest angles.
 *  n        unit
 *  h        unit
 *  returns  [0,1]
 *  edges    0 for h = n and for h = -n
 *  error    <= 4.5e-7 relative, angles of 1e-5 to 1.5 rad, for n and h as given
 *           @accuracy brdf_sin2_between
 *  source   Lagrange's identity, |n|^2 |h|^2 - (n.h)^2 = |n x h|^2
 *  note     n x h = n x (h - n), and h - n is exact where it is small: a plain cross product, or
 *           1 - cos^2, loses the angle to rounding */
HDRP_FN float hdrp_brdf_sin2_between(hdrp_v3 n, hdrp_v3 h)
{
    hdrp_v3 c = hdrp_v3_cross(n, hdrp_v3_sub(h, n));
    return hdrp_min(hdrp_v3_dot(c, c), 1.0f);
}

/** Isotropic GGX (Trowbridge-Reitz) normal distribution from a cosine.
 *  n_dot_h  [0,1]      cosine between unit normal and unit half vector
 *  alpha    [0,1]      GGX width
 *  returns  [0,3.2e7]  1/sr; D * n_dot_h integrates to 1 over the hemisphere
 *  edges    alpha below HDRP_ALPHA_MIN acts as HDRP_ALPHA_MIN
 *  error    <= 5.5e-7 relative for n_dot_h as given  @accuracy brdf_d_ggx
 *  source   Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 33
 *  note     (1-c)(1+c) does not cancel in the highlight. The input does: rounding n_dot_h alone
 *           costs 1e-3 at perceptual roughness 0.1 and everything below 0.03 */
HDRP_FN float hdrp_brdf_d_ggx(float n_dot_h, float alpha)
{
    float a = hdrp_max(alpha, HDRP_ALPHA_MIN);
    float ca = n_dot_h * a;
    float k = a / ((1.0f - n_dot_h) * (1.0f + n_dot_h) + ca * ca);
    return k * k * HDRP_INV_PI;
}

/** Isotropic GGX normal distribution from vectors, precise at any width.
 *  n        unit       shading normal
 *  h        unit       half vector
 *  alpha    [0,1]      GGX width
 *  returns  [0,3.2e7]  1/sr
 *  edges    alpha below HDRP_ALPHA_MIN acts as HDRP_ALPHA_MIN; a half vector below the horizon
 *           counts as its mirror image above
 *  error    <= 1e-6 relative for n and h as given  @accuracy brdf_d_ggx_vectors
 *  error    <= 1e-3 relative against the h before it was rounded  @accuracy brdf_d_ggx_unrounded
 *  source   Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq.
 *           33 */
HDRP_FN float hdrp_brdf_d_ggx_vectors(hdrp_v3 n, hdrp_v3 h, float alpha)
{
    float a = hdrp_max(alpha, HDRP_ALPHA_MIN);
    float a2 = a * a;
    float k = a / (a2 + hdrp_brdf_sin2_between(n, h) * (1.0f - a2));
    return k * k * HDRP_INV_PI;
}

/** Denominator of V: 0.5 over it is G2 / (4 n_dot_l n_dot_v). */
HDRP_FN float hdrp_i_brdf_v_denominator(float n_dot_l, float n_dot_v, float a2)
{
    float lambda_v = n_dot_l * hdrp_sqrt(n_dot_v * n_dot_v * (1.0f - a2) + a2);
    float lambda_l = n_dot_v * hdrp_sqrt(n_dot_l * n_dot_l * (1.0f - a2) + a2);
    return hdrp_max(lambda_v + lambda_l, HDRP_BRDF_V_DENOMINATOR_MIN);
}

/** Height-correlated Smith visibility of isotropic GGX: G2 / (4 n_dot_l n_dot_v).
 *  n_dot_l  [0,1]    cosine between unit normal and direction to the light
 *  n_dot_v  [0,1]    cosine between unit normal and direction to the viewer
 *  alpha    [0,1]    GGX width
 *  returns  [0,5e9]
 *  edges    exact down to n_dot_l + n_dot_v of 1e-6; limited to 5e9 below
 *  error    <= 3e-7 relative  @accuracy brdf_v_smith_ggx
 *  source   Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs",
 *           eq. 72 and 99 */
HDRP_FN float hdrp_brdf_v_smith_ggx(float n_dot_l, float n_dot_v, float alpha)
{
    float a = hdrp_max(alpha, HDRP_ALPHA_MIN);
    return 0.5f / hdrp_i_brdf_v_denominator(n_dot_l, n_dot_v, a * a);
}

/** D V of isotropic GGX from a cosine, with one division for both.
 *  n_dot_h  [0,1]       cosine between unit normal and unit half vector
 *  n_dot_l  [0,1]       cosine between unit normal and direction to the light
 *  n_dot_v  [0,1]       cosine between unit normal and direction to the viewer
 *  alpha    [0,1]       GGX width
 *  returns  [0,1.6e17]  1/sr; times Fresnel's term it is the BRDF
 *  edges    as hdrp_brdf_d_ggx and hdrp_brdf_v_smith_ggx
 *  error    <= 9e-7 relative for n_dot_h as given  @accuracy brdf_dv_ggx
 *  source   see hdrp_brdf_d_ggx and hdrp_brdf_v_smith_ggx */
HDRP_FN float hdrp_brdf_dv_ggx(float n_dot_h, float n_dot_l, float n_dot_v, float alpha)
{
    float a = hdrp_max(alpha, HDRP_ALPHA_MIN);
    float a2 = a * a;
    float ca = n_dot_h * a;
    float q = (1.0f - n_dot_h) * (1.0f + n_dot_h) + ca * ca;
    return 0.5f * HDRP_INV_PI * a2 / (q * q * hdrp_i_brdf_v_denominator(n_dot_l, n_dot_v, a2));
}

/** D V of isotropic GGX from vectors, precise at any width, with one division for both.
 *  n        unit        normal
 *  h        unit        half vector
 *  n_dot_l  [0,1]       cosine between unit normal and direction to the light
 *  n_dot_v  [0,1]       cosine between unit normal and direction to the viewer
 *  alpha    [0,1]       GGX width
 *  returns  [0,1.6e17]  1/sr; times Fresnel's term it is the BRDF
 *  edges    as hdrp_brdf_d_ggx_vectors and hdrp_brdf_v_smith_ggx
 *  error    <= 1.2e-6 relative for n and h as given  @accuracy brdf_dv_ggx_vectors
 *  source   see hdrp_brdf_d_ggx_vectors and hdrp_brdf_v_smith_ggx */
HDRP_FN float hdrp_brdf_dv_ggx_vectors(hdrp_v3 n, hdrp_v3 h, float n_dot_l, float n_dot_v,
                                       float alpha)
{
    float a = hdrp_max(alpha, HDRP_ALPHA_MIN);
    float a2 = a * a;
    float q = a2 + hdrp_brdf_sin2_between(n, h) * (1.0f - a2);
    return 0.5f * HDRP_INV_PI * a2 / (q * q * hdrp_i_brdf_v_denominator(n_dot_l, n_dot_v, a2));
}

/** Visibility of isotropic GGX without square roots.
 *  n_dot_l  [0,1]    cosine between unit normal and direction to the light
 *  n_dot_v  [0,1]    cosine between unit normal and direction to the viewer
 *  alpha    [0,1]    GGX width
 *  returns  [0,5e9]
 *  edges    as hdrp_brdf_v_smith_ggx
 *  error    <= 0.5 relative, cosines of at least 0.1  @accuracy brdf_v_smith_ggx_fast
 *  source   Hammon 2017, "PBR Diffuse Lighting for GGX+Smith Microsurfaces", slide 83 */
HDRP_FN float hdrp_brdf_v_smith_ggx_fast(float n_dot_l, float n_dot_v, float alpha)
{
    float a = hdrp_max(alpha, HDRP_ALPHA_MIN);
    float d = hdrp_lerp(2.0f * n_dot_l * n_dot_v, n_dot_l + n_dot_v, a);
    return 0.5f / hdrp_max(d, HDRP_BRDF_V_DENOMINATOR_MIN);
}

/** Anisotropic GGX normal distribution from the half vector in the tangent frame.
 *  t_dot_h  [-1,1]     along the tangent
 *  b_dot_h  [-1,1]     along the bitangent
 *  n_dot_h  [0,1]      along the normal
 *  alpha_t  [0,4]      GGX width along the tangent
 *  alpha_b  [0,4]      GGX width along the bitangent
 *  returns  [0,3.2e7]  1/sr
 *  requires hdrp_abs(t_dot_h * t_dot_h + b_dot_h * b_dot_h + n_dot_h * n_dot_h - 1.0f) < 1e-3f;
 *           a unit vector
 *  edges    a width below HDRP_ALPHA_MIN acts as HDRP_ALPHA_MIN
 *  error    <= 8e-7 relative for the arguments as given  @accuracy brdf_d_ggx_aniso
 *  source   Burley 2012, "Physically-Based Shading at Disney", appendix B; arrangement by McAuley
 *           2015, "Rendering the World of Far Cry 4"
 *  note     a2 (a2/s)^2 and not a2^3/s^2: the cube underflows at widths that are in use */
HDRP_FN float hdrp_brdf_d_ggx_aniso(float t_dot_h, float b_dot_h, float n_dot_h, float alpha_t,
                                    float alpha_b)
{
    float at = hdrp_max(alpha_t, HDRP_ALPHA_MIN);
    float ab = hdrp_max(alpha_b, HDRP_ALPHA_MIN);
    float a2 = at * ab;
    float vt = ab * t_dot_h;
    float vb = at * b_dot_h;
    float vn = a2 * n_dot_h;
    /* No unit vector reaches the floor; it keeps what is none finite. */
    float r = a2 / hdrp_max(vt * vt + vb * vb + vn * vn, a2 * a2 * (1.0f / 64.0f));
    return HDRP_INV_PI * a2 * (r * r);
}

/** Anisotropic GGX normal distribution from vectors, precise at any width.
 *  t        unit       tangent, orthogonal to n
 *  b        unit       bitangent, orthogonal to n and t
 *  n        unit       shading normal
 *  h        unit       half vector
 *  alpha_t  [0,4]      GGX width along the tangent
 *  alpha_b  [0,4]      GGX width along the bitangent
 *  returns  [0,3.2e7]  1/sr
 *  requires hdrp_abs(hdrp_v3_dot(t, b)) + hdrp_abs(hdrp_v3_dot(t, n)) +
 *           hdrp_abs(hdrp_v3_dot(b, n)) < 1e-6f; a frame
 *  edges    a width below HDRP_ALPHA_MIN acts as HDRP_ALPHA_MIN; a half vector below the horizon
 *           counts as its mirror image above
 *  error    <= 3e-6 relative for a frame and h as given, widths within 10 to 1
 *           @accuracy brdf_d_ggx_aniso_vectors
 *  error    <= 5e-3 relative for any widths: the frame itself is rounded
 *           @accuracy brdf_d_ggx_aniso_vectors_narrow
 *  source   Burley 2012, "Physically-Based Shading at Disney", appendix B, eq. 13
 *  note     t.h = t.(h - n) in an orthogonal frame, whose small terms do not cancel */
HDRP_FN float hdrp_brdf_d_ggx_aniso_vectors(hdrp_v3 t, hdrp_v3 b, hdrp_v3 n, hdrp_v3 h,
                                            float alpha_t, float alpha_b)
{
    hdrp_v3 d = hdrp_v3_sub(h, n);
    return hdrp_brdf_d_ggx_aniso(hdrp_v3_dot(t, d), hdrp_v3_dot(b, d), hdrp_abs(hdrp_v3_dot(n, h)),
                                 alpha_t, alpha_b);
}

/** Height-correlated Smith visibility of anisotropic GGX.
 *  t_dot_l  [-1,1]   light direction along the tangent
 *  b_dot_l  [-1,1]   light direction along the bitangent
 *  n_dot_l  [0,1]    light direction along the normal
 *  t_dot_v  [-1,1]   view direction along the tangent
 *  b_dot_v  [-1,1]   view direction along the bitangent
 *  n_dot_v  [0,1]    view direction along the normal
 *  alpha_t  [0,4]    GGX width along the tangent
 *  alpha_b  [0,4]    GGX width along the bitangent
 *  returns  [0,5e9]
 *  edges    as hdrp_brdf_v_smith_ggx
 *  error    <= 2.5e-7 relative  @accuracy brdf_v_smith_ggx_aniso
 *  source   Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs",
 *           section 5.3 and eq. 99 */
HDRP_FN float hdrp_brdf_v_smith_ggx_aniso(float t_dot_l, float b_dot_l, float n_dot_l,
                                          float t_dot_v, float b_dot_v, float n_dot_v,
                                          float alpha_t, float alpha_b)
{
    float at = hdrp_max(alpha_t, HDRP_ALPHA_MIN);
    float ab = hdrp_max(alpha_b, HDRP_ALPHA_MIN);
    float gv = hdrp_sqrt(hdrp_sq(at * t_dot_v) + hdrp_sq(ab * b_dot_v) + n_dot_v * n_dot_v);
    float gl = hdrp_sqrt(hdrp_sq(at * t_dot_l) + hdrp_sq(ab * b_dot_l) + n_dot_l * n_dot_l);
    return 0.5f / hdrp_max(n_dot_l * gv + n_dot_v * gl, HDRP_BRDF_V_DENOMINATOR_MIN);
}

/* >>sampling ggx
 * In a local frame: x along the tangent, y along the bitangent, z along the normal. */

/** Half vector drawn from the normals that are visible from v.
 *  v        unit   local direction to the viewer, z >= 0
 *  alpha_t  [0,4]  GGX width along the tangent
 *  alpha_b  [0,4]  GGX width along the bitangent
 *  u        [0,1]  two independent uniform numbers
 *  returns  unit   local half vector, z >= 0
 *  edges    total for grazing v and for u of 0 and 1; below HDRP_ALPHA_MIN as at it
 *  error    none: the distribution is held to hdrp_brdf_pdf_vndf by a chi-squared test
 *  source   Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing
 *           3 */
HDRP_FN hdrp_v3 hdrp_brdf_sample_vndf(hdrp_v3 v, float alpha_t, float alpha_b, hdrp_v2 u)
{
    float at = hdrp_max(alpha_t, HDRP_ALPHA_MIN);
    float ab = hdrp_max(alpha_b, HDRP_ALPHA_MIN);
    hdrp_v3 up = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    hdrp_v3 s = hdrp_normalize_or(hdrp_v3_make(at * v.x, ab * v.y, hdrp_max(v.z, 0.0f)), up);
    float phi = HDRP_TWO_PI * u.x;
    float z = (1.0f - u.y) * (1.0f + s.z) - s.z;
    float r = hdrp_sqrt(hdrp_max((1.0f - z) * (1.0f + z), 0.0f));
    hdrp_v3 h = hdrp_v3_make(r * hdrp_cos(phi) + s.x, r * hdrp_sin(phi) + s.y, z + s.z);
    return hdrp_normalize_or(hdrp_v3_make(at * h.x, ab * h.y, hdrp_max(h.z, 0.0f)), up);
}

/** Density of the reflected directions of hdrp_brdf_sample_vndf.
 *  v        unit       local direction to the viewer, z >= 0
 *  h        unit       local half vector, z >= 0
 *  alpha_t  [0,4]      GGX width along the tangent
 *  alpha_b  [0,4]      GGX width along the bitangent
 *  returns  [0,1.7e11] 1/sr, per solid angle of l = 2 (v.h) h - v
 *  requires v.z >= 0.0f && h.z >= 0.0f
 *  edges    no division by the cosine of v: finite at grazing
 *  error    <= 8.5e-7 relative  @accuracy brdf_pdf_vndf
 *  source   Heitz 2018, "Sampling the GGX Distribution of Visible Normals", eq. 17 */
HDRP_FN float hdrp_brdf_pdf_vndf(hdrp_v3 v, hdrp_v3 h, float alpha_t, float alpha_b)
{
    float at = hdrp_max(alpha_t, HDRP_ALPHA_MIN);
    float ab = hdrp_max(alpha_b, HDRP_ALPHA_MIN);
    float nv = hdrp_max(v.z, 0.0f);
    float g = nv + hdrp_sqrt(hdrp_sq(at * v.x) + hdrp_sq(ab * v.y) + nv * nv);
    float d = hdrp_brdf_d_ggx_aniso(h.x, h.y, hdrp_max(h.z, 0.0f), at, ab);
    return 0.5f * d / hdrp_max(g, HDRP_FLT_MIN);
}

/* >>anisotropy */

/* GGX widths along the tangent and the bitangent. */
struct hdrp_brdf_alphas {
    float t; /* [HDRP_ALPHA_MIN,4] */
    float b; /* [HDRP_ALPHA_MIN,4] */
};
HDRP_TYPEDEF(hdrp_brdf_alphas)

/** GGX widths in the parametrisation of Kulla and Conty: the one the Lit model uses.
 *  perceptual_roughness  [0,1]   of the mean width
 *  anisotropy            [-1,1]  > 0 stretches the highlight along the tangent
 *  returns               [HDRP_ALPHA_MIN,2]
 *  edges                 at +-1 one width is HDRP_ALPHA_MIN, the other twice the mean
 *  error                 <= 2e-7 relative  @accuracy brdf_alphas_kulla
 *  source                Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks",
 *                        slide on anisotropy */
HDRP_FN hdrp_brdf_alphas hdrp_brdf_alphas_kulla(float perceptual_roughness, float anisotropy)
{
    hdrp_brdf_alphas a;
    float alpha = hdrp_brdf_alpha_from_perceptual_roughness(perceptual_roughness);
    float k = hdrp_clamp(anisotropy, -1.0f, 1.0f);
    a.t = hdrp_max(alpha * (1.0f + k), HDRP_ALPHA_MIN);
    a.b = hdrp_max(alpha * (1.0f - k), HDRP_ALPHA_MIN);
    return a;
}

/** GGX widths in the parametrisation of Disney: an aspect ratio of at most 10 to 1.
 *  perceptual_roughness  [0,1]   of the geometric mean width
 *  anisotropy            [-1,1]  > 0 stretches the highlight along the tangent
 *  returns               [HDRP_ALPHA_MIN,3.163]
 *  edges                 negative values swap the axes; the source defines none
 *  error                 <= 4e-7 relative  @accuracy brdf_alphas_disney
 *  source                Burley 2012, "Physically-Based Shading at Disney", section 5.4 */
HDRP_FN hdrp_brdf_alphas hdrp_brdf_alphas_disney(float perceptual_roughness, float anisotropy)
{
    hdrp_brdf_alphas a;
    float alpha = hdrp_brdf_alpha_from_perceptual_roughness(perceptual_roughness);
    float k = hdrp_clamp(anisotropy, -1.0f, 1.0f);
    float aspect = hdrp_sqrt(1.0f - 0.9f * hdrp_abs(k));
    float wide = alpha / aspect;
    float narrow = hdrp_max(alpha * aspect, HDRP_ALPHA_MIN);
    a.t = k < 0.0f ? narrow : wide;
    a.b = k < 0.0f ? wide : narrow;
    return a;
}

/* The Kulla parameters of a pair of widths. */
struct hdrp_brdf_kulla {
    float perceptual_roughness; /* [0,1] */
    float anisotropy;           /* [-1,1] */
};
HDRP_TYPEDEF(hdrp_brdf_kulla)

/** Kulla parameters that give two widths: the way in from other parametrisations.
 *  alphas   valid  e.g. glTF's KHR_materials_anisotropy: t = lerp(alpha, 1, strength^2), b = alpha
 *  returns  valid  hdrp_brdf_alphas_kulla of it is alphas, where their mean is at most 1
 *  edges    a mean above 1 is limited, which keeps the ratio of the widths
 *  error    <= 4e-7 relative, in the widths  @accuracy brdf_kulla_from_alphas
 *  source   Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks" (inverted) */
HDRP_FN hdrp_brdf_kulla hdrp_brdf_kulla_from_alphas(hdrp_brdf_alphas alphas)
{
    hdrp_brdf_kulla k;
    float t = hdrp_max(alphas.t, HDRP_ALPHA_MIN);
    float b = hdrp_max(alphas.b, HDRP_ALPHA_MIN);
    k.perceptual_roughness = hdrp_sqrt(hdrp_min(0.5f * (t + b), 1.0f));
    k.anisotropy = hdrp_clamp((t - b) / (t + b), -1.0f, 1.0f);
    return k;
}

/* What to ask an isotropically prefiltered environment for, in place of a stretched lobe. */
struct hdrp_brdf_env_lobe {
    hdrp_v3 normal;             /* unit; reflect the view direction about it */
    float perceptual_roughness; /* [0,1] of the prefiltered level */
};
HDRP_TYPEDEF(hdrp_brdf_env_lobe)

/** Bent normal and roughness that make an isotropic environment look stretched.
 *  t                     unit    tangent, orthogonal to n
 *  b                     unit    bitangent, orthogonal to n and t
 *  n                     unit    shading normal
 *  v                     unit    towards the viewer
 *  anisotropy            [-1,1]  > 0 stretches along the tangent
 *  perceptual_roughness  [0,1]
 *  returns               valid
 *  edges                 n unchanged where anisotropy is 0 or where v runs along the grain
 *  error                 none: an empirical effect without a reference in the source
 *  source                Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's
 *                        High Definition Render Pipeline", slides on anisotropy; McAuley 2015,
 *                        "Rendering the World of Far Cry 4"
 *  note                  the grain switches at anisotropy 0, not at the 0.8 of the slide, and the
 *                        bent normal is normalised before the blend, without which the amount of
 *                        bending depends on the view */
HDRP_FN hdrp_brdf_env_lobe hdrp_brdf_env_lobe_aniso(hdrp_v3 t, hdrp_v3 b, hdrp_v3 n, hdrp_v3 v,
                                                    float anisotropy, float perceptual_roughness)
{
    hdrp_brdf_env_lobe e;
    float pr = hdrp_saturate(perceptual_roughness);
    float k = hdrp_abs(anisotropy);
    hdrp_v3 grain = hdrp_v3_make(anisotropy < 0.0f ? t.x : b.x, anisotropy < 0.0f ? t.y : b.y,
                                 anisotropy < 0.0f ? t.z : b.z);
    /* v without its part along the grain: the normal of a cylinder whose axis is the grain. */
    hdrp_v3 across = hdrp_normalize_or(hdrp_v3_mad(v, grain, -hdrp_v3_dot(v, grain)), n);
    float stretch = k * hdrp_saturate(1.5f * hdrp_sqrt(pr));
    e.normal = hdrp_normalize_or(hdrp_v3_lerp(n, across, stretch), n);
    e.perceptual_roughness = pr * hdrp_saturate(1.2f - k);
    return e;
}

/* >>directional albedo
 * How much of the light from one direction the specular lobe sends back: FGD. From a table
 * (hdrp_brdf_fgd_bake_rows, baked once, 64 x 64 is enough) or from the analytic fit. */

/* The two integrals over the hemisphere of D V cos for unit Fresnel term and for Schlick's weight.
 * Specular albedo is linear in them, see hdrp_brdf_specular_albedo. Made by hdrp_brdf_fgd_fast. */
struct hdrp_brdf_fgd {
    float albedo;  /* [0,1] of the first bounce, for F = 1 */
    float schlick; /* [0,1] the same, each direction weighted by hdrp_brdf_schlick_weight */
};
HDRP_TYPEDEF(hdrp_brdf_fgd)

/** Position in an FGD table of a view and a roughness, as a texture coordinate.
 *  n_dot_v               [0,1]     cosine between unit normal and direction to the viewer
 *  perceptual_roughness  [0,1]
 *  size                  [2,4096]  width and height of the table in texels
 *  returns               [0,1]     for a clamped bilinear lookup
 *  edges                 inputs are limited; the ends map to the centres of the outer texels
 *  error                 none: definition; the square root gives grazing views more texels
 *  source                half-texel remapping as any table that includes its end points needs */
HDRP_FN hdrp_v2 hdrp_brdf_fgd_uv(float n_dot_v, float perceptual_roughness, float size)
{
    float scale = (size - 1.0f) / size;
    float offset = 0.5f / size;
    return hdrp_v2_make(hdrp_sqrt(hdrp_saturate(n_dot_v)) * scale + offset,
                        hdrp_saturate(perceptual_roughness) * scale + offset);
}

/* The analytic fit of FGD at one roughness, in the cosine c of a direction and t = c / alpha. Made
 * once per pixel, it costs each light two divisions and some multiply-adds. Made by
 * hdrp_brdf_fgd_fit_make. */
struct hdrp_brdf_fgd_fit {
    float inverse_alpha;
    hdrp_v2 loss_n;     /* 1 - albedo = t (x + y t) / */
    hdrp_v3 loss_d;     /* (1 + x t + y t^2 + z t^3) */
    hdrp_v2 cosine_n;   /* schlick / albedo = (1 - m)^5 with m = c + (x + y c) / */
    float cosine_d;     /* (1 + d t), an effective cosine between view and half vector */
    float mean_loss;    /* cosine-weighted mean over the hemisphere of 1 - albedo */
    float mean_schlick; /* of schlick */
};
HDRP_TYPEDEF(hdrp_brdf_fgd_fit)

/** a + b x + c x^2 + d x^3. */
HDRP_FN float hdrp_i_brdf_cubic(float a, float b, float c, float d, float x)
{
    return a + x * (b + x * (c + x * d));
}

/** fit with the effective cosine of a width, given as its root. */
HDRP_FN hdrp_brdf_fgd_fit hdrp_i_brdf_fgd_fit_set_cosine(hdrp_brdf_fgd_fit fit, float q)
{
    hdrp_brdf_fgd_fit f = fit;
    f.cosine_n.x = q * (0.108742684f + q * hdrp_i_brdf_cubic(2.90460491f, -6.76332474f, 6.75303411f,
                                                             -2.55623007f, q));
    f.cosine_n.y = hdrp_i_brdf_cubic(-0.16311945f, -0.653872967f, 0.128006995f, 0.0f, q);
    f.cosine_d = hdrp_i_brdf_cubic(0.72819525f, -1.34152937f, 1.71405375f, -1.40320504f, q);
    return f;
}

/** The analytic fit of FGD at one width. */
HDRP_FN hdrp_brdf_fgd_fit hdrp_i_brdf_fgd_fit_alpha(float a)
{
    hdrp_brdf_fgd_fit f;
    float q = hdrp_sqrt(a);
    float mean;
    f.inverse_alpha = 1.0f / a;
    f.loss_n.x = hdrp_i_brdf_cubic(0.230199918f, 0.0611920953f, 3.76339936f, 1.48308444f, a);
    f.loss_n.y = a * hdrp_i_brdf_cubic(-0.180100933f, 7.54789209f, -13.2210388f, 89.1957245f, a);
    f.loss_d.x = hdrp_i_brdf_cubic(0.674825966f, 5.26004457f, 32.7332573f, 0.0f, a);
    f.loss_d.y =
        0.127423942f + a * hdrp_i_brdf_cubic(-6.9580822f, 11.5299244f, 38.5920219f, 50.5328941f, a);
    f.loss_d.z = hdrp_i_brdf_cubic(0.310372114f, 1.56204367f, 26.442585f, -33.816391f, a);
    mean = hdrp_i_brdf_cubic(39.3234062f, -60.8898277f, 46.7970543f, -13.6633568f, q);
    mean = hdrp_i_brdf_cubic(0.0636951923f, 2.37435579f, -12.3076382f, mean, q);
    f.mean_loss = a * a / mean;
    f = hdrp_i_brdf_fgd_fit_set_cosine(f, q);
    f.mean_schlick = 0.0467854775f + q * hdrp_i_brdf_cubic(0.0539289117f, -0.480697751f,
                                                           0.645444334f, -0.262367249f, q);
    return f;
}

/** The analytic fit of FGD at one roughness.
 *  perceptual_roughness  [0,1]
 *  returns               finite
 *  edges                 total; below HDRP_PERCEPTUAL_ROUGHNESS_MIN as at it
 *  error                 none: see hdrp_brdf_fgd_fast, whose coefficients these are
 *  source                our own minimax fit to a quadrature, by tools/fit_brdf.py */
HDRP_FN hdrp_brdf_fgd_fit hdrp_brdf_fgd_fit_make(float perceptual_roughness)
{
    return hdrp_i_brdf_fgd_fit_alpha(
        hdrp_brdf_alpha_from_perceptual_roughness(perceptual_roughness));
}

/** Mean width, limited as the fit of FGD needs it. */
HDRP_FN float hdrp_i_brdf_mean_alpha(hdrp_brdf_alphas a)
{
    return hdrp_clamp(0.5f * (a.t + a.b), HDRP_ALPHA_MIN, 1.0f);
}

/** Difference of the widths over their sum. */
HDRP_FN float hdrp_i_brdf_anisotropy(hdrp_brdf_alphas a)
{
    return hdrp_clamp((a.t - a.b) / hdrp_max(a.t + a.b, HDRP_ALPHA_MIN), -1.0f, 1.0f);
}

/* How the fit of a stretched lobe depends on the azimuth. Made by hdrp_brdf_fgd_stretch_make. */
struct hdrp_brdf_fgd_stretch {
    hdrp_v3 widths2; /* squared widths along tangent, bitangent and, their mean, normal */
    hdrp_v2 loss_n1; /* changes of the coefficients of the fit: odd in the azimuth */
    hdrp_v3 loss_d1;
    hdrp_v2 loss_n2; /* and quadratic in it */
    hdrp_v2 cosine0; /* even */
    hdrp_v2 cosine1;
    hdrp_v2 cosine2;
};
HDRP_TYPEDEF(hdrp_brdf_fgd_stretch)

/** The even part of the fit of a stretched lobe: what all azimuths share.
 *  alphas   valid   GGX widths along the tangent and the bitangent
 *  returns  finite
 *  edges    equal widths give the fit of the isotropic lobe; widths whose mean is above 1 are
 *           narrowed together
 *  error    <= 0.006 absolute, of mean_loss  @accuracy brdf_fgd_fit_aniso_mean
 *  error    <= 0.004 absolute, of mean_schlick as the mean of hdrp_brdf_fgd_fit_towards
 *           @accuracy brdf_fgd_fit_aniso_mean_schlick
 *  source   our own minimax fit to a quadrature, by tools/fit_brdf.py
 *  note     the means over the hemisphere are those of the stretched lobe */
HDRP_FN hdrp_brdf_fgd_fit hdrp_brdf_fgd_fit_make_aniso(hdrp_brdf_alphas alphas)
{
    float a = hdrp_i_brdf_mean_alpha(alphas);
    float k2 = hdrp_sq(hdrp_i_brdf_anisotropy(alphas));
    float p = hdrp_sqrt(a);
    hdrp_brdf_fgd_fit f = hdrp_i_brdf_fgd_fit_alpha(a);
    float more;
    f.loss_n.x +=
        k2 * (hdrp_i_brdf_cubic(-0.0365382768f, -0.561783612f, 9.2477684f, -0.50158757f, a));
    f.loss_n.y +=
        k2 * (a * hdrp_i_brdf_cubic(0.192181572f, -4.58993721f, 11.7414341f, 91.8174667f, a));
    f.loss_d.x += k2 * (hdrp_i_brdf_cubic(-0.710474253f, 5.67636585f, 2.31629038f, 0.0f, a));
    f.loss_d.y += k2 * (0.451539516f + a * hdrp_i_brdf_cubic(-6.14876413f, 49.4379501f,
                                                             -126.116585f, 167.572815f, a));
    f.loss_d.z +=
        k2 * (hdrp_i_brdf_cubic(-0.127950728f, 1.85519719f, -27.1330452f, 66.9026718f, a));
    more = hdrp_i_brdf_cubic(
        0.448553383f, 15.0812578f, -126.09687f,
        hdrp_i_brdf_cubic(403.127869f, -613.524536f, 446.223267f, -125.012283f, p), p);
    more += k2 * hdrp_i_brdf_cubic(
                     1.78151751f, -32.9540901f, 199.506119f,
                     hdrp_i_brdf_cubic(-548.247375f, 756.980591f, -513.495117f, 136.356628f, p), p);
    f.mean_loss *= 1.0f + k2 * more;
    more = 0.0118954964f +
           p * hdrp_i_brdf_cubic(-0.16995661f, 0.687934995f, -1.0397197f, 0.511018336f, p);
    more += k2 * (-0.0243139695f +
                  p * hdrp_i_brdf_cubic(0.375031084f, -1.22574711f, 1.6955297f, -0.784876227f, p));
    f.mean_schlick += k2 * more;
    return f;
}

/** How the fit of a stretched lobe depends on the azimuth.
 *  alphas   valid   GGX widths along the tangent and the bitangent
 *  returns  finite
 *  edges    no dependence for equal widths; widths whose mean is above 1 are narrowed together
 *  error    none: see hdrp_brdf_fgd_fit_towards, whose coefficients these are
 *  source   our own minimax fit to a quadrature, by tools/fit_brdf.py */
HDRP_FN hdrp_brdf_fgd_stretch hdrp_brdf_fgd_stretch_make(hdrp_brdf_alphas alphas)
{
    hdrp_brdf_fgd_stretch s;
    float a = hdrp_i_brdf_mean_alpha(alphas);
    float k = hdrp_i_brdf_anisotropy(alphas);
    float k2 = k * k;
    float p = hdrp_sqrt(a);
    s.widths2 = hdrp_v3_make(hdrp_sq(a * (1.0f + k)), hdrp_sq(a * (1.0f - k)), a * a * (1.0f + k2));
    s.loss_n1.x =
        k * (hdrp_i_brdf_cubic(0.021816276f, -0.289882451f, -2.72518682f, 0.19281739f, a));
    s.loss_n1.y =
        k * (a * hdrp_i_brdf_cubic(-0.125557095f, 4.87546778f, -39.774601f, 7.00308943f, a));
    s.loss_d1.x = k * (hdrp_i_brdf_cubic(0.30317235f, -4.86158752f, -2.28528261f, 0.0f, a));
    s.loss_d1.y = k * (-0.148174316f + a * hdrp_i_brdf_cubic(2.39053774f, 2.02934384f, -27.4319382f,
                                                             -34.8882942f, a));
    s.loss_d1.z = k * (hdrp_i_brdf_cubic(0.0389700271f, 0.440541476f, -16.3739471f, 36.146656f, a));
    s.loss_n2.x =
        k2 * (hdrp_i_brdf_cubic(-0.00447614538f, 0.42620489f, -2.13635612f, 0.631659448f, a));
    s.loss_n2.y =
        k2 * (a * hdrp_i_brdf_cubic(0.00193235814f, 0.427789181f, -0.572329223f, -9.9255228f, a));
    s.cosine0.x =
        k2 * (p * hdrp_i_brdf_cubic(-0.128583863f, 0.293234527f, -0.599202693f, 0.363714516f, p));
    s.cosine0.y = k2 * (hdrp_i_brdf_cubic(-1.65695548f, 3.32654738f, -1.91087556f, 0.0f, p));
    s.cosine1.x =
        k * (p * hdrp_i_brdf_cubic(0.0259205401f, 0.0163689982f, -0.225944281f, 0.16883482f, p));
    s.cosine1.y = k * (hdrp_i_brdf_cubic(-0.0419251472f, 0.60389179f, -0.62493813f, 0.0f, p));
    s.cosine2.x =
        k2 * (p * hdrp_i_brdf_cubic(0.107054897f, -0.667779207f, 1.29617476f, -0.706300318f, p));
    s.cosine2.y = k2 * (hdrp_i_brdf_cubic(1.27012897f, -2.32210565f, 0.835886657f, 0.0f, p));
    return s;
}

/** The fit of a stretched lobe in the plane of one direction, for hdrp_brdf_fgd_from_fit.
 *  fit      valid   made by hdrp_brdf_fgd_fit_make_aniso
 *  stretch  valid   made by hdrp_brdf_fgd_stretch_make of the same widths
 *  t_dot_x  [-1,1]  direction along the tangent
 *  b_dot_x  [-1,1]  along the bitangent
 *  n_dot_x  [-1,1]  along the normal
 *  returns  finite
 *  edges    fit, up to rounding, for equal widths; vectors shorter than 1 act as limited
 *  error    <= 0.012 absolute, of albedo above the true one, n_dot_x of at least 3e-4
 *           @accuracy brdf_fgd_fit_towards_above
 *  error    <= 0.0055 absolute, of albedo below it, likewise  @accuracy brdf_fgd_fit_towards_below
 *  error    <= 0.065 absolute, of schlick, anisotropy within -0.75 to 0.75, likewise
 *           @accuracy brdf_fgd_fit_towards_schlick
 *  error    <= 0.0065 absolute, of schlick below the true one at any anisotropy, likewise
 *           @accuracy brdf_fgd_fit_towards_schlick_below
 *  source   our own minimax fit to a quadrature, by tools/fit_brdf.py
 *  note     the loss is a rational function of the cosine over the width in the plane of the
 *           direction, with coefficients quadratic in the cosine of twice the azimuth in the space
 *           where the lobe is round. Facets tilted sideways are met at grazing angles, like those
 *           of a narrow lobe: with them the width falls that the Fresnel term sees */
HDRP_FN hdrp_brdf_fgd_fit hdrp_brdf_fgd_fit_towards(hdrp_brdf_fgd_fit fit,
                                                    hdrp_brdf_fgd_stretch stretch, float t_dot_x,
                                                    float b_dot_x, float n_dot_x)
{
    hdrp_v3 w = stretch.widths2;
    float t = w.x * t_dot_x * t_dot_x;
    float b = w.y * b_dot_x * b_dot_x;
    /* The floor is that of the narrowest lobe. */
    float along = hdrp_max(t + b + w.z * n_dot_x * n_dot_x, HDRP_ALPHA_MIN * HDRP_ALPHA_MIN);
    float across = hdrp_max(w.x + w.y - along, 0.0f);
    float turn = (t - b) / along;
    float lobe = hdrp_sqrt(along * (1.0f + 1.5f * along) / (1.0f + 1.5f * across));
    float q = hdrp_sqrt(lobe);
    float narrow = hdrp_clamp(q, 0.01f, 1.0f);
    hdrp_brdf_fgd_fit f = hdrp_i_brdf_fgd_fit_set_cosine(fit, narrow);
    f.inverse_alpha = 1.0f / hdrp_sqrt(along);
    f.loss_n.x += turn * (stretch.loss_n1.x + turn * stretch.loss_n2.x);
    f.loss_n.y += turn * (stretch.loss_n1.y + turn * stretch.loss_n2.y);
    f.loss_d = hdrp_v3_mad(f.loss_d, stretch.loss_d1, turn);
    f.cosine_n.x += stretch.cosine0.x + turn * (stretch.cosine1.x + turn * stretch.cosine2.x);
    f.cosine_n.x += 0.164126456f * hdrp_max(q - 1.0f, 0.0f);
    f.cosine_n.y += stretch.cosine0.y + turn * (stretch.cosine1.y + turn * stretch.cosine2.y);
    f.cosine_d *= hdrp_sqrt(along) / (narrow * narrow); /* in the cosine over its own width */
    return f;
}

/** Effective cosine between view and half vector. */
HDRP_FN float hdrp_i_brdf_fgd_cosine(hdrp_brdf_fgd_fit fit, float c)
{
    float t = c * fit.inverse_alpha;
    return c + (fit.cosine_n.x + fit.cosine_n.y * c) / (1.0f + fit.cosine_d * t);
}

/** Directional albedo for F = 1. */
HDRP_FN float hdrp_i_brdf_fgd_albedo(hdrp_brdf_fgd_fit fit, float c)
{
    float t = c * fit.inverse_alpha;
    float loss = t * (fit.loss_n.x + fit.loss_n.y * t) /
                 hdrp_i_brdf_cubic(1.0f, fit.loss_d.x, fit.loss_d.y, fit.loss_d.z, t);
    return 1.0f - hdrp_saturate(loss);
}

/** FGD of one direction from the fit of its roughness.
 *  fit      valid  made by hdrp_brdf_fgd_fit_make
 *  n_dot_x  [0,1]  cosine between unit normal and direction
 *  returns  [0,1]
 *  edges    exactly albedo 1 at grazing; not limited, but rounding above 1 does no harm
 *  error    none: see hdrp_brdf_fgd_fast
 *  source   our own minimax fit to a quadrature, by tools/fit_brdf.py */
HDRP_FN hdrp_brdf_fgd hdrp_brdf_fgd_from_fit(hdrp_brdf_fgd_fit fit, float n_dot_x)
{
    hdrp_brdf_fgd f;
    float m = hdrp_i_brdf_fgd_cosine(fit, n_dot_x);
    f.albedo = hdrp_i_brdf_fgd_albedo(fit, n_dot_x);
    f.schlick = hdrp_brdf_schlick_weight(m) * f.albedo;
    return f;
}

/** FGD without a table.
 *  n_dot_v               [0,1]  cosine between unit normal and direction to the viewer
 *  perceptual_roughness  [0,1]
 *  returns               [0,1]
 *  edges                 total; exactly albedo 1 at grazing
 *  error                 <= 0.006 absolute, of schlick and albedo  @accuracy brdf_fgd_fast
 *  error                 <= 0.0022 absolute, of albedo  @accuracy brdf_fgd_fast_albedo
 *  source                our own minimax fit to a quadrature, by tools/fit_brdf.py
 *  note                  it errs towards too much rather than too little, which keeps a diffuse
 *                        lobe that is coupled to it from gaining energy */
HDRP_FN hdrp_brdf_fgd hdrp_brdf_fgd_fast(float n_dot_v, float perceptual_roughness)
{
    return hdrp_brdf_fgd_from_fit(hdrp_brdf_fgd_fit_make(perceptual_roughness),
                                  hdrp_saturate(n_dot_v));
}

/** Factor that gives a GGX lobe back the light that bounces more than once between microfacets.
 *  fgd       valid  at the view and the roughness of the lobe
 *  fresnel0  [0,1]  per component
 *  returns   [1,inf) per component
 *  edges     1 for a black fresnel0; a white furnace stays white for fresnel0 = 1
 *  error     <= 0.056 absolute, in the albedo of a metal with the first bounce, against a random
 *            walk between microfacets (Heitz et al. 2016)  @accuracy brdf_energy_compensation
 *  source    Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *            Definition Render Pipeline", slides on multiscattering GGX (credit: Turquin) */
HDRP_FN hdrp_v3 hdrp_brdf_energy_compensation(hdrp_brdf_fgd fgd, hdrp_v3 fresnel0)
{
    /* GGX keeps 0.307 of the light at worst; a table may hold anything. */
    float missing = 1.0f / hdrp_max(fgd.albedo, 0.05f) - 1.0f;
    return hdrp_v3_make(1.0f + fresnel0.x * missing, 1.0f + fresnel0.y * missing,
                        1.0f + fresnel0.z * missing);
}

/* What becomes of the light that the first bounce between microfacets loses to shadowing. Made by
 * hdrp_brdf_bounces_make. */
struct hdrp_brdf_bounces {
    hdrp_v3 reflected; /* [0,1] share of it that leaves after more bounces */
    hdrp_v3 passed;    /* [0,3] share of it that enters the surface, over 1 - F0 */
};
HDRP_TYPEDEF(hdrp_brdf_bounces)

/** Fate of light that bounces more than once, for one channel: reflected, passed over 1 - F0. */
HDRP_FN hdrp_v2 hdrp_i_brdf_bounces_channel(float again, float f0, float f90)
{
    float below = 1.0f - f90 * (1.0f / 21.0f);
    float mean = 1.0f - (1.0f - f0) * below; /* Schlick's term, cosine-weighted mean */
    float d = 1.0f / (1.0f - again * mean);
    return hdrp_v2_make(mean * mean * (1.0f - again) * d,
                        below * (1.0f + mean * (1.0f - again)) * d);
}

/** What becomes of the light that the first bounce between microfacets loses to shadowing.
 *  fit        valid  made by hdrp_brdf_fgd_fit_make
 *  fresnel0   [0,1]  per component
 *  fresnel90  [0,1]  see hdrp_brdf_fresnel90
 *  returns    valid  reflected + (1 - fresnel0) passed is 1
 *  edges      fresnel0 = 1 reflects all; passed stays finite there
 *  error      <= 0.035 absolute, in the albedo of hdrp_brdf_multiscatter and the first bounce,
 *             against a random walk  @accuracy brdf_bounces
 *  source     Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"
 *  note       the source lets the mean albedo of the first bounce escape from each one. From the
 *             second on more does, a third less of the loss: with that, coloured metals come within
 *             half the distance to the random walk of Heitz et al. 2016 */
HDRP_FN hdrp_brdf_bounces hdrp_brdf_bounces_make(hdrp_brdf_fgd_fit fit, hdrp_v3 fresnel0,
                                                 float fresnel90)
{
    hdrp_brdf_bounces r;
    float again = (2.0f / 3.0f) * fit.mean_loss;
    hdrp_v2 x = hdrp_i_brdf_bounces_channel(again, fresnel0.x, fresnel90);
    hdrp_v2 y = hdrp_i_brdf_bounces_channel(again, fresnel0.y, fresnel90);
    hdrp_v2 z = hdrp_i_brdf_bounces_channel(again, fresnel0.z, fresnel90);
    r.reflected = hdrp_v3_make(x.x, y.x, z.x);
    r.passed = hdrp_v3_make(x.y, y.y, z.y);
    return r;
}

/** Lobe of the light that bounces more than once between microfacets. Added to D V F it keeps a
 *  white furnace white, and it is reciprocal.
 *  fit        valid    made by hdrp_brdf_fgd_fit_make at the roughness of the lobe
 *  n_dot_v    [0,1]    cosine between unit normal and direction to the viewer
 *  n_dot_l    [0,1]    cosine between unit normal and direction to the light
 *  fresnel0   [0,1]    per component
 *  fresnel90  [0,1]    see hdrp_brdf_fresnel90
 *  returns    [0,inf)  1/sr, per component
 *  edges      0 where either direction is grazing: such light escapes at the first bounce
 *  error      <= 0.004 absolute, of the albedo for fresnel0 = 1 and n_dot_v of at least 0.05
 *             @accuracy brdf_multiscatter
 *  error      <= 0.009 absolute, of the albedo for fresnel0 = 1 at any view
 *             @accuracy brdf_multiscatter_grazing
 *  source     Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks", after
 *             Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model
 *             with Importance Sampling" */
HDRP_FN hdrp_v3 hdrp_brdf_multiscatter(hdrp_brdf_fgd_fit fit, float n_dot_v, float n_dot_l,
                                       hdrp_v3 fresnel0, float fresnel90)
{
    float v = 1.0f - hdrp_brdf_fgd_from_fit(fit, hdrp_saturate(n_dot_v)).albedo;
    float l = 1.0f - hdrp_brdf_fgd_from_fit(fit, hdrp_saturate(n_dot_l)).albedo;
    return hdrp_v3_scale(hdrp_brdf_bounces_make(fit, fresnel0, fresnel90).reflected,
                         v * l * HDRP_INV_PI / fit.mean_loss);
}

/** Albedo of the single-scattering specular lobe: what it reflects of a white environment.
 *  fgd        valid  at the view and the roughness of the lobe
 *  fresnel0   [0,1]  per component
 *  fresnel90  [0,1]  see hdrp_brdf_fresnel90
 *  returns    [0,1]  per component
 *  edges      fgd.albedo for fresnel0 = 1
 *  error      none: definition
 *  source     Karis 2013, "Real Shading in Unreal Engine 4", section "Image-Based Lighting" */
HDRP_FN hdrp_v3 hdrp_brdf_specular_albedo(hdrp_brdf_fgd fgd, hdrp_v3 fresnel0, float fresnel90)
{
    float scale = fgd.albedo - fgd.schlick;
    float bias = fresnel90 * fgd.schlick;
    return hdrp_v3_saturate(hdrp_v3_make(fresnel0.x * scale + bias, fresnel0.y * scale + bias,
                                         fresnel0.z * scale + bias));
}

/* >>diffuse */

/** Burley's diffuse lobe as published. Empirical: it reflects more light than it receives.
 *  n_dot_v               [0,1]   cosine between unit normal and direction to the viewer
 *  n_dot_l               [0,1]   cosine between unit normal and direction to the light
 *  l_dot_v               [-1,1]  cosine between both directions
 *  perceptual_roughness  [0,1]
 *  returns               [0,2]   1/sr, for a white surface
 *  edges                 albedo 1.04 at normal incidence, 1.56 at grazing (roughness 1)
 *  error                 <= 4.5e-7 relative  @accuracy brdf_diffuse_disney
 *  source                Burley 2012, "Physically-Based Shading at Disney", section 5.3
 *  note                  2 cos^2 of the half angle is 1 + l_dot_v */
HDRP_FN float hdrp_brdf_diffuse_disney(float n_dot_v, float n_dot_l, float l_dot_v,
                                       float perceptual_roughness)
{
    float fd90 = 0.5f + perceptual_roughness * hdrp_max(1.0f + l_dot_v, 0.0f);
    float fl = hdrp_brdf_f_schlick(1.0f, fd90, n_dot_l);
    float fv = hdrp_brdf_f_schlick(1.0f, fd90, n_dot_v);
    return HDRP_INV_PI * fl * fv;
}

/** Burley's diffuse lobe, rescaled with roughness so that it gains less.
 *  n_dot_v               [0,1]   cosine between unit normal and direction to the viewer
 *  n_dot_l               [0,1]   cosine between unit normal and direction to the light
 *  l_dot_v               [-1,1]  cosine between both directions
 *  perceptual_roughness  [0,1]
 *  returns               [0,2]   1/sr, for a white surface
 *  edges                 albedo at normal incidence 0.95 (smooth) to 0.69 (rough), at grazing 0 to
 *                        1.03
 *  error                 <= 2.5e-7 absolute  @accuracy brdf_diffuse_disney_normalized
 *  source                Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based
 *                        Rendering", listing 1 */
HDRP_FN float hdrp_brdf_diffuse_disney_normalized(float n_dot_v, float n_dot_l, float l_dot_v,
                                                  float perceptual_roughness)
{
    float bias = 0.5f * perceptual_roughness;
    float factor = hdrp_lerp(1.0f, 1.0f / 1.51f, perceptual_roughness);
    float fd90 = bias + perceptual_roughness * hdrp_max(1.0f + l_dot_v, 0.0f);
    float fl = hdrp_brdf_f_schlick(1.0f, fd90, n_dot_l);
    float fv = hdrp_brdf_f_schlick(1.0f, fd90, n_dot_v);
    return HDRP_INV_PI * factor * fl * fv;
}

/** Light that a specular lobe leaves to the diffuse one in one direction, over 1 - F0.
 *  fgd        valid  at the direction and the roughness of the lobe
 *  bounces    valid  of the same lobe
 *  fresnel90  [0,1]  see hdrp_brdf_fresnel90
 *  returns    [0,3]  per component
 *  edges      finite for fresnel0 = 1, where the light and 1 - F0 both vanish
 *  error      none: see hdrp_brdf_diffuse
 *  source     Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model
 *             with Importance Sampling"
 *  note       what enters at the first bounce, and at the later ones. With E the albedo of the
 *             specular lobe and all its bounces it is (1 - E) / (1 - F0), without cancellation */
HDRP_FN hdrp_v3 hdrp_brdf_diffuse_share(hdrp_brdf_fgd fgd, hdrp_brdf_bounces bounces,
                                        float fresnel90)
{
    float first = fgd.albedo - fresnel90 * fgd.schlick;
    return hdrp_v3_mad(hdrp_v3_splat(first), bounces.passed, 1.0f - fgd.albedo);
}

/** Cosine-weighted mean of hdrp_brdf_diffuse_share over the hemisphere.
 *  fit        valid    made by hdrp_brdf_fgd_fit_make at the roughness of the specular lobe
 *  bounces    valid    of the same lobe
 *  fresnel90  [0,1]    see hdrp_brdf_fresnel90
 *  returns    [0.5,2]  per component
 *  edges      1 where both reflectances are 0 and the surface is smooth
 *  error      <= 8.5e-4 relative  @accuracy brdf_diffuse_share_mean
 *  source     our own fit of the mean, by tools/fit_brdf.py */
HDRP_FN hdrp_v3 hdrp_brdf_diffuse_share_mean(hdrp_brdf_fgd_fit fit, hdrp_brdf_bounces bounces,
                                             float fresnel90)
{
    float first = 1.0f - fit.mean_loss - fresnel90 * fit.mean_schlick;
    return hdrp_v3_mad(hdrp_v3_splat(first), bounces.passed, fit.mean_loss);
}

/** Diffuse lobe of a surface whose specular lobe reflects first: the recommended one.
 *  What either direction loses to the specular lobe is missing from the diffuse one, so that both
 *  together never reflect more than they receive, and the lobe is reciprocal.
 *  fit        valid  made by hdrp_brdf_fgd_fit_make at the roughness of the specular lobe
 *  n_dot_v    [0,1]  cosine between unit normal and direction to the viewer
 *  n_dot_l    [0,1]  cosine between unit normal and direction to the light
 *  fresnel0   [0,1]  of the specular lobe, per component
 *  fresnel90  [0,1]  see hdrp_brdf_fresnel90
 *  returns    [0,1]  1/sr, for a white diffuse albedo, per component
 *  edges      1/pi for a smooth surface without specular, 0 for fresnel0 = 1
 *  error      <= 0.005 absolute, of the sum of both albedos above 1  @accuracy brdf_diffuse_gain
 *  error      <= 0.01 absolute, of the sum of both albedos below 1  @accuracy brdf_diffuse_loss
 *  source     Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model
 *             with Importance Sampling", with the multiscattered GGX albedo */
HDRP_FN hdrp_v3 hdrp_brdf_diffuse(hdrp_brdf_fgd_fit fit, float n_dot_v, float n_dot_l,
                                  hdrp_v3 fresnel0, float fresnel90)
{
    hdrp_brdf_bounces bounces = hdrp_brdf_bounces_make(fit, fresnel0, fresnel90);
    hdrp_brdf_fgd fgd_v = hdrp_brdf_fgd_from_fit(fit, hdrp_saturate(n_dot_v));
    hdrp_brdf_fgd fgd_l = hdrp_brdf_fgd_from_fit(fit, hdrp_saturate(n_dot_l));
    hdrp_v3 v = hdrp_brdf_diffuse_share(fgd_v, bounces, fresnel90);
    hdrp_v3 l = hdrp_brdf_diffuse_share(fgd_l, bounces, fresnel90);
    hdrp_v3 mean = hdrp_brdf_diffuse_share_mean(fit, bounces, fresnel90);
    return hdrp_v3_make(HDRP_INV_PI * (1.0f - fresnel0.x) * v.x * l.x / mean.x,
                        HDRP_INV_PI * (1.0f - fresnel0.y) * v.y * l.y / mean.y,
                        HDRP_INV_PI * (1.0f - fresnel0.z) * v.z * l.z / mean.z);
}

/* >>thin film
 * A film between the medium above and the base, which is described by its F0. For each polarisation
 * the reflectance is a series in the order m of the path difference; the spectrum enters only
 * through the cosine transform of the colour-matching functions, here sums of Gaussians. */

/* One Gaussian of the response to a spectrum cos(2 pi opd / wavelength), at one order m of the path
 * difference: envelope * now. Each order follows from the last without exponential and cosine. */
struct hdrp_i_brdf_wave {
    float cosine;   /* of the phase phi of the first order */
    float now;      /* cos(m phi) */
    float before;   /* cos((m - 1) phi) */
    float envelope; /* g^(m^2), where g is the damping of the first order */
    float decay;    /* g^(2 m + 1), what the next order loses */
    float square;   /* g^2 */
};
HDRP_TYPEDEF(hdrp_i_brdf_wave)

/** Order 1 of a Gaussian in wavenumber: width [um^-2] and frequency [um^-1] of its transform. */
HDRP_FN hdrp_i_brdf_wave hdrp_i_brdf_wave_make(float opd_um, float width, float frequency)
{
    hdrp_i_brdf_wave w;
    w.cosine = hdrp_cos(frequency * opd_um);
    w.now = w.cosine;
    w.before = 1.0f;
    w.envelope = hdrp_exp(-width * opd_um * opd_um);
    w.square = w.envelope * w.envelope;
    w.decay = w.square * w.envelope;
    return w;
}

HDRP_FN hdrp_i_brdf_wave hdrp_i_brdf_wave_next(hdrp_i_brdf_wave w)
{
    float now = w.now;
    w.now = 2.0f * w.cosine * now - w.before;
    w.before = now;
    w.envelope *= w.decay;
    w.decay *= w.square;
    return w;
}

/** Sum of this and all later orders, weighted by 1, x, x^2 ..., as if each decayed as this one: a
 *  geometric series of rotating vectors. Exact without path difference. */
HDRP_FN float hdrp_i_brdf_wave_tail(hdrp_i_brdf_wave w, float x)
{
    float a = x * w.decay;
    float d = hdrp_sq(1.0f - a) + 2.0f * a * (1.0f - w.cosine);
    return w.envelope * (w.now - a * w.before) / (d + HDRP_FLT_MIN);
}

/* Rows of the matrix from Gaussians to linear Rec.709. Equal-energy white gives (1,1,1), and so
 * does no path difference. The colour-matching functions are those of CIE 1931, fitted in
 * wavenumber by tools/fit_brdf.py: 0.12 of worst error, 0.03 rms. */
#define HDRP_I_BRDF_FILM_RED   hdrp_v3_make(1.89250954f, -0.923264807f, 0.0307552715f)
#define HDRP_I_BRDF_FILM_GREEN hdrp_v3_make(-0.554621099f, 1.69194072f, -0.13731962f)
#define HDRP_I_BRDF_FILM_BLUE  hdrp_v3_make(0.00870222753f, -0.175570875f, 1.16686865f)

struct hdrp_i_brdf_waves {
    hdrp_i_brdf_wave a;
    hdrp_i_brdf_wave b;
    hdrp_i_brdf_wave c;
};
HDRP_TYPEDEF(hdrp_i_brdf_waves)

HDRP_FN hdrp_i_brdf_waves hdrp_i_brdf_waves_make(float opd_um)
{
    hdrp_i_brdf_waves w;
    w.a = hdrp_i_brdf_wave_make(opd_um, 0.157541568f, 10.4604743f);
    w.b = hdrp_i_brdf_wave_make(opd_um, 0.368619415f, 11.342566f);
    w.c = hdrp_i_brdf_wave_make(opd_um, 0.252452653f, 13.9199993f);
    return w;
}

HDRP_FN hdrp_i_brdf_waves hdrp_i_brdf_waves_next(hdrp_i_brdf_waves w)
{
    w.a = hdrp_i_brdf_wave_next(w.a);
    w.b = hdrp_i_brdf_wave_next(w.b);
    w.c = hdrp_i_brdf_wave_next(w.c);
    return w;
}

HDRP_FN hdrp_v3 hdrp_i_brdf_waves_values(hdrp_i_brdf_waves w)
{
    return hdrp_v3_make(w.a.envelope * w.a.now, w.b.envelope * w.b.now, w.c.envelope * w.c.now);
}

HDRP_FN hdrp_v3 hdrp_i_brdf_waves_tail(hdrp_i_brdf_waves w, float x)
{
    return hdrp_v3_make(hdrp_i_brdf_wave_tail(w.a, x), hdrp_i_brdf_wave_tail(w.b, x),
                        hdrp_i_brdf_wave_tail(w.c, x));
}

/* The same with six Gaussians, in two halves: 0.008 of worst error. */
#define HDRP_I_BRDF_FILM_RED_1   hdrp_v3_make(1.27137633f, 0.157041905f, -0.422586948f)
#define HDRP_I_BRDF_FILM_RED_2   hdrp_v3_make(-0.116456445f, 0.0280163089f, 0.0826088471f)
#define HDRP_I_BRDF_FILM_GREEN_1 hdrp_v3_make(-0.334036346f, 0.920639558f, 0.454924698f)
#define HDRP_I_BRDF_FILM_GREEN_2 hdrp_v3_make(0.0911263336f, -0.0370514955f, -0.0956027482f)
#define HDRP_I_BRDF_FILM_BLUE_1  hdrp_v3_make(0.0120286391f, -0.126506741f, -0.0349705175f)
#define HDRP_I_BRDF_FILM_BLUE_2  hdrp_v3_make(0.289599047f, 0.158685173f, 0.701164399f)

HDRP_FN hdrp_i_brdf_waves hdrp_i_brdf_waves_make_1(float opd_um)
{
    hdrp_i_brdf_waves w;
    w.a = hdrp_i_brdf_wave_make(opd_um, 0.107845039f, 10.3352171f);
    w.b = hdrp_i_brdf_wave_make(opd_um, 0.211596315f, 11.0887082f);
    w.c = hdrp_i_brdf_wave_make(opd_um, 0.124406963f, 11.9446375f);
    return w;
}

HDRP_FN hdrp_i_brdf_waves hdrp_i_brdf_waves_make_2(float opd_um)
{
    hdrp_i_brdf_waves w;
    w.a = hdrp_i_brdf_wave_make(opd_um, 0.153789368f, 13.1973182f);
    w.b = hdrp_i_brdf_wave_make(opd_um, 0.0475148514f, 13.5356048f);
    w.c = hdrp_i_brdf_wave_make(opd_um, 0.129011908f, 14.2566701f);
    return w;
}

/* One interface for one polarisation: amplitude and transmitted share. */
struct hdrp_i_brdf_amplitude {
    float r; /* [-1,1] amplitude of the reflection */
    float t; /* [0,1] up to rounding: 1 - r^2, without cancellation */
};
HDRP_TYPEDEF(hdrp_i_brdf_amplitude)

/** The interface at which x turns into y, up to a common factor: the paths for s polarisation, the
 *  paths over the squared IORs for p. */
HDRP_FN hdrp_i_brdf_amplitude hdrp_i_brdf_amplitude_make(float x, float y)
{
    hdrp_i_brdf_amplitude a;
    float scale = 1.0f / (x + y + HDRP_FLT_MIN); /* where both are 0 the light is grazing */
    a.r = (x - y) * scale;
    a.t = 4.0f * (x * scale) * (y * scale);
    return a;
}

/* A film over a base of one F0, for one polarisation. */
struct hdrp_i_brdf_cavity {
    float q; /* [-1,1] product of both amplitudes */
    float t; /* [0,1] light that enters the base when all orders add without interference */
};
HDRP_TYPEDEF(hdrp_i_brdf_cavity)

HDRP_FN hdrp_i_brdf_cavity hdrp_i_brdf_cavity_make(hdrp_i_brdf_amplitude top,
                                                   hdrp_i_brdf_amplitude bottom)
{
    hdrp_i_brdf_cavity c;
    float product = top.t * bottom.t;
    c.q = top.r * bottom.r;
    c.t = product / (top.t + bottom.t - product + HDRP_FLT_MIN); /* 1 - q^2 below */
    return c;
}

/** Path in a layer, IOR times cosine, from the squared path above; 0 for total reflection. Squares
 *  of sines would cancel near it. */
HDRP_FN float hdrp_i_brdf_film_path(float outer_path2, float outer_ior, float ior)
{
    return hdrp_sqrt(hdrp_max((ior - outer_ior) * (ior + outer_ior) + outer_path2, 0.0f));
}

/* A film whose light path is known: what all colour channels share. In every layer the path of the
 * light is IOR times cosine; its square is the difference of two squared IORs plus that above. */
struct hdrp_i_brdf_film {
    hdrp_i_brdf_amplitude s; /* top interface, s polarisation */
    hdrp_i_brdf_amplitude p; /* top interface, p polarisation */
    float outer_ior;         /* [1,1.5] */
    float outer_path2;       /* squared path above the film */
    float ior2;              /* [1,9] squared */
    float path;              /* in the film */
    float opd_um;            /* optical path difference of neighbouring orders */
};
HDRP_TYPEDEF(hdrp_i_brdf_film)

HDRP_FN hdrp_i_brdf_film hdrp_i_brdf_film_make(float cos_theta, float outer_ior, float film_ior,
                                               float thickness_nm)
{
    hdrp_i_brdf_film f;
    float outer_path = outer_ior * hdrp_saturate(cos_theta);
    f.outer_ior = outer_ior;
    f.outer_path2 = outer_path * outer_path;
    f.ior2 = film_ior * film_ior;
    f.path = hdrp_i_brdf_film_path(f.outer_path2, outer_ior, film_ior);
    f.s = hdrp_i_brdf_amplitude_make(outer_path, f.path);
    f.p = hdrp_i_brdf_amplitude_make(f.ior2 * outer_path, outer_ior * outer_ior * f.path);
    f.opd_um = 2e-3f * thickness_nm * f.path;
    return f;
}

/* The film over a base of one F0. */
struct hdrp_i_brdf_cavities {
    hdrp_i_brdf_cavity s;
    hdrp_i_brdf_cavity p;
};
HDRP_TYPEDEF(hdrp_i_brdf_cavities)

/** The IOR of the base is a ratio, above / below; times below there is no pole at F0 = 1. */
HDRP_FN hdrp_i_brdf_cavities hdrp_i_brdf_film_cavities(hdrp_i_brdf_film f, float fresnel0)
{
    hdrp_i_brdf_cavities c;
    float root = hdrp_sqrt(hdrp_saturate(fresnel0));
    float above = 1.0f + root;
    float below = 1.0f - root;
    float path = hdrp_i_brdf_film_path(below * below * f.outer_path2, below * f.outer_ior, above);
    c.s = hdrp_i_brdf_cavity_make(f.s, hdrp_i_brdf_amplitude_make(below * f.path, path));
    c.p = hdrp_i_brdf_cavity_make(
        f.p, hdrp_i_brdf_amplitude_make(above * above * f.path, below * f.ior2 * path));
    return c;
}

/** Share that is reflected, where s and p of the light of both polarisations enter the base. */
HDRP_FN float hdrp_i_brdf_film_reflected(float s, float p)
{
    return hdrp_saturate(1.0f - 0.5f * (s + p));
}

/** Light that enters the base of one polarisation: first order, then the tail from the second. */
HDRP_FN float hdrp_i_brdf_cavity_light(hdrp_i_brdf_cavity c, hdrp_v3 row, hdrp_v3 first,
                                       hdrp_i_brdf_waves second)
{
    float x = -c.q;
    hdrp_v3 sum = hdrp_v3_mad(first, hdrp_i_brdf_waves_tail(second, x), x);
    return c.t * (1.0f + 2.0f * x * hdrp_v3_dot(row, sum));
}

HDRP_FN float hdrp_i_brdf_film_channel(hdrp_i_brdf_film f, float fresnel0, hdrp_v3 row,
                                       hdrp_v3 first, hdrp_i_brdf_waves second)
{
    hdrp_i_brdf_cavities c = hdrp_i_brdf_film_cavities(f, fresnel0);
    return hdrp_i_brdf_film_reflected(hdrp_i_brdf_cavity_light(c.s, row, first, second),
                                      hdrp_i_brdf_cavity_light(c.p, row, first, second));
}

/** Reflectance of a thin film over a base: the recommended form.
 *  cos_theta     [0,1]     cosine of the angle above the film
 *  outer_ior     [1,1.5]   IOR of the medium above: 1 for air, 1.5 for a clear coat
 *  film_ior      [1,3]
 *  thickness_nm  [0,3000]
 *  fresnel0      [0,1]     of the base against air, per channel; taken as a dielectric of that F0
 *  returns       [0,1]     linear Rec.709, colours out of gamut are limited
 *  edges         no thickness gives the bare base exactly; 1 at grazing, for fresnel0 = 1 and, at
 *                any thickness, where a film of less than outer_ior reflects totally
 *  error         <= 0.15 absolute, at grazing over a metal  @accuracy brdf_film
 *  error         <= 0.0035 absolute, mean over the domain  @accuracy brdf_film_mean
 *  error         <= 0.06 relative to the largest error of the talk's form, F0 of 0.02 to 0.7
 *                @accuracy brdf_film_to_talk
 *  error         <= 0.03 relative to the mean error of the talk's form, likewise
 *                @accuracy brdf_film_to_talk_mean
 *  source        Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the
 *                Modeling of Varying Iridescence", section 4, per polarisation, with our own
 *                spectral fit and the series in closed form
 *  note          three exponentials and cosines, as hdrp_brdf_film_fast; 18 divisions against 6
 *                for the series. The talk's one thickness t in [0,1] is film_ior = 2 - t and
 *                thickness_nm = 1500 t / film_ior. Its form reads XYZ as RGB, describes the base
 *                against air instead of against the film, ignores which of the two is denser, and
 *                is 0/0 or the root of a negative number at grazing and under a coat */
HDRP_FN hdrp_v3 hdrp_brdf_film(float cos_theta, float outer_ior, float film_ior, float thickness_nm,
                               hdrp_v3 fresnel0)
{
    hdrp_i_brdf_film f = hdrp_i_brdf_film_make(cos_theta, outer_ior, film_ior, thickness_nm);
    hdrp_i_brdf_waves w = hdrp_i_brdf_waves_make(f.opd_um);
    hdrp_v3 first = hdrp_i_brdf_waves_values(w);
    w = hdrp_i_brdf_waves_next(w);
    return hdrp_v3_make(hdrp_i_brdf_film_channel(f, fresnel0.x, HDRP_I_BRDF_FILM_RED, first, w),
                        hdrp_i_brdf_film_channel(f, fresnel0.y, HDRP_I_BRDF_FILM_GREEN, first, w),
                        hdrp_i_brdf_film_channel(f, fresnel0.z, HDRP_I_BRDF_FILM_BLUE, first, w));
}

/* Order at which the series of the exact form is closed. */
#define HDRP_BRDF_FILM_ORDERS 8

/* A sum over the orders of both polarisations, in one channel. */
struct hdrp_i_brdf_series {
    hdrp_i_brdf_cavities c;
    float power_s; /* (-q)^m */
    float power_p;
    float sum_s;
    float sum_p;
};
HDRP_TYPEDEF(hdrp_i_brdf_series)

HDRP_FN hdrp_i_brdf_series hdrp_i_brdf_series_make(hdrp_i_brdf_film f, float fresnel0)
{
    hdrp_i_brdf_series r;
    r.c = hdrp_i_brdf_film_cavities(f, fresnel0);
    r.power_s = -r.c.s.q;
    r.power_p = -r.c.p.q;
    r.sum_s = 0.0f;
    r.sum_p = 0.0f;
    return r;
}

HDRP_FN hdrp_i_brdf_series hdrp_i_brdf_series_add(hdrp_i_brdf_series r, float spectrum)
{
    r.sum_s += r.power_s * spectrum;
    r.sum_p += r.power_p * spectrum;
    r.power_s *= -r.c.s.q;
    r.power_p *= -r.c.p.q;
    return r;
}

/* The orders from the last on, both halves of the spectrum. */
HDRP_FN float hdrp_i_brdf_series_close(hdrp_i_brdf_series r, hdrp_v3 row1, hdrp_i_brdf_waves w1,
                                       hdrp_v3 row2, hdrp_i_brdf_waves w2)
{
    float tail_s = hdrp_v3_dot(row1, hdrp_i_brdf_waves_tail(w1, -r.c.s.q)) +
                   hdrp_v3_dot(row2, hdrp_i_brdf_waves_tail(w2, -r.c.s.q));
    float tail_p = hdrp_v3_dot(row1, hdrp_i_brdf_waves_tail(w1, -r.c.p.q)) +
                   hdrp_v3_dot(row2, hdrp_i_brdf_waves_tail(w2, -r.c.p.q));
    return hdrp_i_brdf_film_reflected(r.c.s.t * (1.0f + 2.0f * (r.sum_s + r.power_s * tail_s)),
                                      r.c.p.t * (1.0f + 2.0f * (r.sum_p + r.power_p * tail_p)));
}

/** Reflectance of a thin film over a base, to order 8 and with a finer spectrum: for references.
 *  cos_theta     [0,1]     cosine of the angle above the film
 *  outer_ior     [1,1.5]   IOR of the medium above
 *  film_ior      [1,3]
 *  thickness_nm  [0,3000]
 *  fresnel0      [0,1]     of the base against air, per channel; taken as a dielectric of that F0
 *  returns       [0,1]     linear Rec.709, colours out of gamut are limited
 *  edges         as hdrp_brdf_film
 *  error         <= 0.015 absolute, at grazing over a metal  @accuracy brdf_film_exact
 *  error         <= 3.5e-4 absolute, mean over the domain  @accuracy brdf_film_exact_mean
 *  source        Born and Wolf 1999, "Principles of Optics", section 1.6.4, integrated over the
 *                colour-matching functions term by term
 *  note          what is left is the fit of the spectrum. hdrp_brdf_film_airy has single
 *                wavelengths */
HDRP_FN hdrp_v3 hdrp_brdf_film_exact(float cos_theta, float outer_ior, float film_ior,
                                     float thickness_nm, hdrp_v3 fresnel0)
{
    hdrp_i_brdf_film f = hdrp_i_brdf_film_make(cos_theta, outer_ior, film_ior, thickness_nm);
    hdrp_i_brdf_series red = hdrp_i_brdf_series_make(f, fresnel0.x);
    hdrp_i_brdf_series green = hdrp_i_brdf_series_make(f, fresnel0.y);
    hdrp_i_brdf_series blue = hdrp_i_brdf_series_make(f, fresnel0.z);
    hdrp_i_brdf_waves w1 = hdrp_i_brdf_waves_make_1(f.opd_um);
    hdrp_i_brdf_waves w2 = hdrp_i_brdf_waves_make_2(f.opd_um);
    int m;
    for (m = 1; m < HDRP_BRDF_FILM_ORDERS; ++m) {
        hdrp_v3 s1 = hdrp_i_brdf_waves_values(w1);
        hdrp_v3 s2 = hdrp_i_brdf_waves_values(w2);
        red = hdrp_i_brdf_series_add(red, hdrp_v3_dot(HDRP_I_BRDF_FILM_RED_1, s1) +
                                              hdrp_v3_dot(HDRP_I_BRDF_FILM_RED_2, s2));
        green = hdrp_i_brdf_series_add(green, hdrp_v3_dot(HDRP_I_BRDF_FILM_GREEN_1, s1) +
                                                  hdrp_v3_dot(HDRP_I_BRDF_FILM_GREEN_2, s2));
        blue = hdrp_i_brdf_series_add(blue, hdrp_v3_dot(HDRP_I_BRDF_FILM_BLUE_1, s1) +
                                                hdrp_v3_dot(HDRP_I_BRDF_FILM_BLUE_2, s2));
        w1 = hdrp_i_brdf_waves_next(w1);
        w2 = hdrp_i_brdf_waves_next(w2);
    }
    return hdrp_v3_make(
        hdrp_i_brdf_series_close(red, HDRP_I_BRDF_FILM_RED_1, w1, HDRP_I_BRDF_FILM_RED_2, w2),
        hdrp_i_brdf_series_close(green, HDRP_I_BRDF_FILM_GREEN_1, w1, HDRP_I_BRDF_FILM_GREEN_2, w2),
        hdrp_i_brdf_series_close(blue, HDRP_I_BRDF_FILM_BLUE_1, w1, HDRP_I_BRDF_FILM_BLUE_2, w2));
}

/** Airy reflectance of a thin film at one wavelength, unpolarised.
 *  cos_theta      [0,1]       cosine of the angle above the film
 *  outer_ior      [1,1.5]     IOR of the medium above
 *  film_ior       [1,3]       at this wavelength
 *  base_ior       [1,4e7]     at this wavelength
 *  thickness_nm   [0,3000]
 *  wavelength_nm  [300,1000]
 *  returns        [0,1]
 *  edges          1 at grazing, and where the film reflects totally: light does not tunnel through
 *  error          <= 1.3e-4 absolute, light that came from air into the medium above
 *                 @accuracy brdf_film_airy
 *  error          <= 8e-5 absolute, other light with a cosine 1e-3 and more above those at which
 *                 film or base reflect totally  @accuracy brdf_film_airy_inside
 *  error          <= 0.06 absolute, at the critical angle of the base, where the slope is infinite
 *                 @accuracy brdf_film_airy_critical
 *  source         Born and Wolf 1999, "Principles of Optics", section 1.6.4, eq. 58
 *  note           1 + 2 q cos(phase) + q^2 as (1 + q)^2 - 4 q sin^2(phase / 2) */
HDRP_FN float hdrp_brdf_film_airy(float cos_theta, float outer_ior, float film_ior, float base_ior,
                                  float thickness_nm, float wavelength_nm)
{
    hdrp_i_brdf_film f = hdrp_i_brdf_film_make(cos_theta, outer_ior, film_ior, thickness_nm);
    float path = hdrp_i_brdf_film_path(f.outer_path2, outer_ior, base_ior);
    hdrp_i_brdf_amplitude s = hdrp_i_brdf_amplitude_make(f.path, path);
    hdrp_i_brdf_amplitude p =
        hdrp_i_brdf_amplitude_make(base_ior * base_ior * f.path, f.ior2 * path);
    float half_phase = HDRP_PI * (f.opd_um * 1e3f / wavelength_nm);
    float sin2 = hdrp_sq(hdrp_sin(half_phase));
    float qs = f.s.r * s.r;
    float qp = f.p.r * p.r;
    float ts = f.s.t * s.t / hdrp_max(hdrp_sq(1.0f + qs) - 4.0f * qs * sin2, HDRP_FLT_MIN);
    float tp = f.p.t * p.t / hdrp_max(hdrp_sq(1.0f + qp) - 4.0f * qp * sin2, HDRP_FLT_MIN);
    return hdrp_saturate(1.0f - 0.5f * (ts + tp));
}

/** Light that enters the base of one polarisation, second order. The tail of the series is closed
 *  as if it had the spectrum of its first term, which makes a vanishing film exact. */
HDRP_FN float hdrp_i_brdf_cavity_second_order(hdrp_i_brdf_cavity c, float s1, float s2)
{
    float tail = c.q * c.q * s2 / hdrp_max(1.0f + c.q, 1e-6f);
    return c.t * (1.0f + 2.0f * (tail - c.q * s1));
}

HDRP_FN float hdrp_i_brdf_film_fast_channel(hdrp_i_brdf_film f, float fresnel0, hdrp_v3 row,
                                            hdrp_v3 first, hdrp_v3 second)
{
    hdrp_i_brdf_cavities c = hdrp_i_brdf_film_cavities(f, fresnel0);
    float s1 = hdrp_v3_dot(row, first);
    float s2 = hdrp_v3_dot(row, second);
    return hdrp_i_brdf_film_reflected(hdrp_i_brdf_cavity_second_order(c.s, s1, s2),
                                      hdrp_i_brdf_cavity_second_order(c.p, s1, s2));
}

/** Reflectance of a thin film over a base, to second order.
 *  cos_theta     [0,1]     cosine of the angle above the film
 *  outer_ior     [1,1.5]   IOR of the medium above
 *  film_ior      [1,3]
 *  thickness_nm  [0,3000]
 *  fresnel0      [0,1]     of the base against air, per channel; taken as a dielectric of that F0
 *  returns       [0,1]     linear Rec.709, colours out of gamut are limited
 *  edges         as hdrp_brdf_film
 *  error         <= 0.53 absolute, at grazing over a metal  @accuracy brdf_film_fast
 *  error         <= 0.006 absolute, mean over the domain  @accuracy brdf_film_fast_mean
 *  error         <= 0.5 relative to the largest error of the talk's form, F0 of 0.02 to 0.7
 *                @accuracy brdf_film_fast_to_talk
 *  error         <= 0.11 relative to the mean error of the talk's form, likewise
 *                @accuracy brdf_film_fast_to_talk_mean
 *  source        Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the
 *                Modeling of Varying Iridescence", section 4, per polarisation and with our own
 *                spectral fit
 *  note          nearly as good as hdrp_brdf_film for F0 below 0.5 */
HDRP_FN hdrp_v3 hdrp_brdf_film_fast(float cos_theta, float outer_ior, float film_ior,
                                    float thickness_nm, hdrp_v3 fresnel0)
{
    hdrp_i_brdf_film f = hdrp_i_brdf_film_make(cos_theta, outer_ior, film_ior, thickness_nm);
    hdrp_i_brdf_waves w = hdrp_i_brdf_waves_make(f.opd_um);
    hdrp_v3 s1 = hdrp_i_brdf_waves_values(w);
    hdrp_v3 s2 = hdrp_i_brdf_waves_values(hdrp_i_brdf_waves_next(w));
    return hdrp_v3_make(
        hdrp_i_brdf_film_fast_channel(f, fresnel0.x, HDRP_I_BRDF_FILM_RED, s1, s2),
        hdrp_i_brdf_film_fast_channel(f, fresnel0.y, HDRP_I_BRDF_FILM_GREEN, s1, s2),
        hdrp_i_brdf_film_fast_channel(f, fresnel0.z, HDRP_I_BRDF_FILM_BLUE, s1, s2));
}

/** F0 of the Schlick curve that goes through a given reflectance.
 *  f        [0,1]  reflectance at u
 *  u        [0,1]  cosine between light and half vector
 *  returns  [0,1]
 *  edges    0 where f is below the curve of F0 = 0, and at u = 0, where all curves meet
 *  error    <= 3e-7 absolute, in hdrp_brdf_f_schlick of the result, for u of at least 0.1
 *           @accuracy brdf_fresnel0_from_schlick
 *  source   Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering" (inverted)
 *  note     an error of f is amplified by 1 / (1 - (1 - u)^5): 2.4 at u = 0.1, 21 at 0.01 */
HDRP_FN float hdrp_brdf_fresnel0_from_schlick(float f, float u)
{
    float w = hdrp_brdf_schlick_weight(u);
    return hdrp_saturate((f - w) / hdrp_max(1.0f - w, HDRP_FLT_EPSILON));
}

/* >>transmission
 * Light that crosses the surface: through a thin wall with parallel sides, or into a volume.
 * Diffuse light through a thin slab is part of the Lit model below. */

/* Closest ratio of two IORs to 1 for which a rough interface is told from none. */
#define HDRP_BRDF_ETA_MARGIN 1e-3f

/* A refracted direction. */
struct hdrp_brdf_refraction {
    hdrp_v3 direction; /* unit; away from the surface, on the far side */
    float transmits;   /* [0,1] 1, or 0 at total internal reflection */
};
HDRP_TYPEDEF(hdrp_brdf_refraction)

/** Direction of light beyond a smooth interface.
 *  v        unit      on the near side, pointing away from the surface
 *  n        unit      normal on the side of v
 *  eta      [0.25,4]  IOR of the near side over IOR of the far side
 *  returns  valid     where total reflection leaves none, the mirror direction with transmits 0
 *  edges    eta = 1 gives -v
 *  error    <= 4e-6 absolute, per component, away from the critical angle
 *           @accuracy brdf_refract
 *  source   Born and Wolf 1999, "Principles of Optics", section 1.5.1 (Snell's law) */
HDRP_FN hdrp_brdf_refraction hdrp_brdf_refract(hdrp_v3 v, hdrp_v3 n, float eta)
{
    hdrp_brdf_refraction r;
    float c = hdrp_saturate(hdrp_v3_dot(v, n));
    float k = 1.0f - eta * eta * (1.0f - c) * (1.0f + c);
    float across = k >= 0.0f ? -eta : -1.0f;
    float along = k >= 0.0f ? eta * c - hdrp_sqrt(hdrp_max(k, 0.0f)) : 2.0f * c;
    r.direction =
        hdrp_normalize_or(hdrp_v3_mad(hdrp_v3_scale(v, across), n, along), hdrp_v3_neg(v));
    r.transmits = k >= 0.0f ? 1.0f : 0.0f;
    return r;
}

/** Share of light that a volume lets through, from the colour it takes on after some distance.
 *  attenuation_color       [0,1]    of white light after attenuation_distance_m, per component
 *  attenuation_distance_m  [0,inf]  infinite for a clear volume
 *  distance_m              [0,inf)  path in the volume
 *  returns                 [0,1]    per component
 *  edges                   1 for distance 0, for an infinite attenuation distance and for a white
 *                          colour; else 0 for a black colour or an attenuation distance of 0
 *  error                   <= 8e-8 absolute  @accuracy brdf_volume_transmittance
 *  source                  Beer-Lambert law, in the terms of glTF's KHR_materials_volume */
HDRP_FN hdrp_v3 hdrp_brdf_volume_transmittance(hdrp_v3 attenuation_color,
                                               float attenuation_distance_m, float distance_m)
{
    float d = hdrp_max(distance_m, 0.0f);
    /* A path of no length stays at 1 where the volume is black, and 0 / inf is 0. */
    float x = d > 0.0f ? d / hdrp_max(attenuation_distance_m, HDRP_FLT_MIN) : 0.0f;
    float e = hdrp_min(x, HDRP_FLT_MAX);
    /* The smallest normal float stands for black: its logarithm is finite, and 0 * inf is not. */
    hdrp_v3 c = hdrp_v3_max(hdrp_v3_saturate(attenuation_color), HDRP_FLT_MIN);
    return hdrp_v3_make(hdrp_exp2(hdrp_log2(c.x) * e), hdrp_exp2(hdrp_log2(c.y) * e),
                        hdrp_exp2(hdrp_log2(c.z) * e));
}

/** Perceptual roughness that blurs what is seen through a rough interface.
 *  perceptual_roughness  [0,1]  of the interface
 *  ior                   [1,3]  of the volume behind it
 *  returns               [0,1]
 *  edges                 0 for IOR 1, which bends nothing; unchanged from IOR 1.5 upwards
 *  error                 none: an empirical scale
 *  source                Khronos 2021, "glTF Sample Viewer", applyIorToRoughness */
HDRP_FN float hdrp_brdf_refraction_perceptual_roughness(float perceptual_roughness, float ior)
{
    return hdrp_saturate(perceptual_roughness) * hdrp_saturate(2.0f * (ior - 1.0f));
}

/** Rough refraction into a volume: BTDF times the cosine of l.
 *  n        unit       normal on the side of v
 *  v        unit       near side, towards the viewer
 *  l        unit       far side, towards the light
 *  alpha    [0,1]      GGX width
 *  eta      [0.25,4]   IOR of the far side over IOR of the near side
 *  returns  [0,inf)    1/sr, before colour and absorption; Fresnel transmission is included
 *  edges    0 where v or l is on the wrong side and beyond the critical angle; eta within
 *           HDRP_BRDF_ETA_MARGIN of 1 acts as that far from it
 *  error    <= 1.6e-5 relative, alpha of at least 0.05 and cosines of at least 0.05
 *           @accuracy brdf_btdf_ggx
 *  source   Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 21
 *  note     scaled by eta^2, as for an engine that keeps L / ior^2 in a volume: a white furnace
 *           stays white */
HDRP_FN float hdrp_brdf_btdf_ggx(hdrp_v3 n, hdrp_v3 v, hdrp_v3 l, float alpha, float eta)
{
    float away = eta < 1.0f ? -HDRP_BRDF_ETA_MARGIN : HDRP_BRDF_ETA_MARGIN;
    float e = hdrp_abs(eta - 1.0f) < HDRP_BRDF_ETA_MARGIN ? 1.0f + away : eta;
    float n_dot_v = hdrp_v3_dot(n, v);
    float n_dot_l = -hdrp_v3_dot(n, l);
    hdrp_v3 sum = hdrp_v3_mad(v, l, e);
    hdrp_v3 h = hdrp_normalize_or(hdrp_v3_scale(sum, hdrp_sign_not_zero(hdrp_v3_dot(sum, n))), n);
    float v_dot_h = hdrp_v3_dot(v, h);
    float l_dot_h = -hdrp_v3_dot(l, h);
    float d = hdrp_brdf_d_ggx_vectors(n, h, alpha);
    float vis = hdrp_brdf_v_smith_ggx(n_dot_l, n_dot_v, alpha);
    float f = hdrp_brdf_f_dielectric_exact(v_dot_h, e);
    float w = v_dot_h - e * l_dot_h;
    float facing = hdrp_min(hdrp_min(n_dot_v, n_dot_l), hdrp_min(v_dot_h, l_dot_h));
    float t =
        4.0f * e * e * v_dot_h * l_dot_h * n_dot_l * (1.0f - f) * d * vis / hdrp_max(w * w, 1e-12f);
    return facing > 0.0f ? t : 0.0f;
}

/** Rough transmission through a thin wall: BTDF times the cosine of l.
 *  n          unit     normal on the side of v
 *  v          unit     near side, towards the viewer
 *  l          unit     far side, towards the light
 *  alpha      [0,1]    GGX width
 *  fresnel0   [0,1]    of the wall, per component
 *  fresnel90  [0,1]    see hdrp_brdf_fresnel90
 *  returns    [0,inf)  1/sr, before colour; Fresnel transmission is included
 *  edges      0 where v or l is on the wrong side
 *  error      none: the reflective lobe with l mirrored to the side of v, and 1 - F in place of F
 *  source     glTF 2.0, KHR_materials_transmission, "Implementation Notes" */
HDRP_FN hdrp_v3 hdrp_brdf_btdf_thin_ggx(hdrp_v3 n, hdrp_v3 v, hdrp_v3 l, float alpha,
                                        hdrp_v3 fresnel0, float fresnel90)
{
    hdrp_v3 mirrored = hdrp_v3_mad(l, n, -2.0f * hdrp_v3_dot(n, l));
    hdrp_v3 h = hdrp_brdf_half_vector(mirrored, v, n);
    float n_dot_v = hdrp_max(hdrp_v3_dot(n, v), 0.0f);
    float n_dot_l = hdrp_saturate(hdrp_v3_dot(n, mirrored));
    float dv = hdrp_brdf_dv_ggx_vectors(n, h, n_dot_l, n_dot_v, alpha);
    hdrp_v3 f = hdrp_brdf_f_schlick_rgb(fresnel0, fresnel90, hdrp_v3_dot(v, h));
    float both = n_dot_v > 0.0f ? dv * n_dot_l : 0.0f;
    return hdrp_v3_scale(hdrp_v3_sub(hdrp_v3_splat(1.0f), f), both);
}

/* >>specular antialiasing
 * Normals that vary within a pixel widen its lobe. Variances are of the slope, in alpha^2 units. */

/** Variance of the normal across a pixel, from its screen-space derivatives.
 *  dndx      finite  change of the unit shading normal to the next pixel in x
 *  dndy      finite  in y
 *  strength  [0,1]   variance of the pixel filter in pixels^2; 0.25 is a pixel wide
 *  limit     [0,1]   largest variance; 0.18 keeps silhouettes from turning dull
 *  returns   [0,1]
 *  edges     NaN derivatives, as at the edge of a quad, give 0
 *  error     none: definition
 *  source    Tokuyoshi and Kaplanyan 2019, "Improved Geometric Specular Antialiasing", listing 3 */
HDRP_FN float hdrp_brdf_variance_from_derivatives(hdrp_v3 dndx, hdrp_v3 dndy, float strength,
                                                  float limit)
{
    float square = hdrp_v3_dot(dndx, dndx) + hdrp_v3_dot(dndy, dndy);
    return hdrp_min(2.0f * strength * hdrp_clamp(square, 0.0f, 4.0f), limit);
}

/** Variance of the normals under a texel, from the length of their average.
 *  average_length  [0,1]  of the filtered tangent-space normals before normalisation
 *  returns         [0,1]
 *  edges           0 for length 1, 1 for 0.5 and below, where the average says no more
 *  error           none: definition
 *  source          Toksvig 2005, "Mipmapping Normal Maps", eq. 1, as a GGX width */
HDRP_FN float hdrp_brdf_variance_from_average_normal(float average_length)
{
    float r = hdrp_saturate(average_length);
    /* Slope variance (1 - r) / r of a Gaussian lobe; alpha^2 is twice that. */
    return hdrp_saturate(2.0f * (1.0f - r) / hdrp_max(r, 0.5f));
}

/** Perceptual roughness of a lobe that also stands for normals of some variance.
 *  perceptual_roughness  [0,1]
 *  variance              [0,1]  of the normals, as given by the functions above; sums add up
 *  returns               [0,1]
 *  edges                 unchanged for variance 0, never less than perceptual_roughness
 *  error                 <= 8.5e-8 absolute  @accuracy brdf_perceptual_roughness_filtered
 *  source                Kaplanyan et al. 2016, "Filtering Distributions of Normals for Shading
 *                        Antialiasing", eq. 8 */
HDRP_FN float hdrp_brdf_perceptual_roughness_filtered(float perceptual_roughness, float variance)
{
    float alpha = hdrp_sq(hdrp_saturate(perceptual_roughness));
    return hdrp_sqrt(hdrp_sqrt(hdrp_min(alpha * alpha + hdrp_max(variance, 0.0f), 1.0f)));
}

/* >>occlusion */

/** Share of the specular lobe that ambient occlusion leaves visible.
 *  ambient_occlusion     [0,1]  1 is open
 *  n_dot_v               [0,1]  cosine between unit normal and direction to the viewer
 *  perceptual_roughness  [0,1]
 *  returns               [0,1]
 *  edges                 exactly 1 for ambient_occlusion 1, 0 for 0
 *  error                 none: an empirical effect
 *  source                Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based
 *                        Rendering", listing 26 */
HDRP_FN float hdrp_brdf_specular_occlusion(float ambient_occlusion, float n_dot_v,
                                           float perceptual_roughness)
{
    float ao = hdrp_saturate(ambient_occlusion);
    float alpha = hdrp_sq(hdrp_saturate(perceptual_roughness));
    float open = hdrp_max(hdrp_saturate(n_dot_v) + ao, HDRP_FLT_MIN);
    float s = hdrp_pow(open, hdrp_exp2(-16.0f * alpha - 1.0f)) - 1.0f + ao;
    return ao < 1.0f ? hdrp_saturate(s) * (ao > 0.0f ? 1.0f : 0.0f) : 1.0f;
}

#endif /* HDRP_BRDF_LOBES_H */
