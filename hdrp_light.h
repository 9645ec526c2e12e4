/* hdrp_light.h - photometric units, exposure, attenuation, and the light record of every pass.
 * SPDX-License-Identifier: MIT
 *
 * One record, hdrp_light, describes a light to culling, shading and fog, on the CPU and in shaders.
 * A function builds it, a function evaluates it, and the lit surface needs nothing else:
 *
 *     float candela = hdrp_light_candela_from_lumen_spot(1000.0f, 0.3f, 0.4f);
 *     hdrp_v3 color = hdrp_v3_splat(candela);
 *     hdrp_light lamp = hdrp_light_spot(position, forward, color, 20.0f, 0.3f, 0.4f);
 *     ...
 *     hdrp_light_incident i = hdrp_light_eval(lamp, surface_position);
 *     luminance += i.illuminance * BRDF(i.l, v) * n_dot_l;     (nits: lux times 1/sr)
 *
 * In a shader the record is an element of a buffer:
 *
 *     layout(std430, binding = 0) readonly buffer lights_buffer { hdrp_light lights[]; };
 *     StructuredBuffer<hdrp_light> lights;                                       (HLSL)
 *
 * What the colour of a record holds, and where an artist's number comes from:
 *
 *     light              colour    artist's unit, and the function that converts it
 *     directional, sun   lux       lux at zenith: as it is
 *     point              candela   lumen: hdrp_light_candela_from_lumen_point
 *     spot               candela   lumen as an occluder, as a reflector, or with a soft edge:
 *                                  ..._spot_occluder, ..._spot_reflector, ..._spot
 *     pyramid spot       candela   lumen: ..._pyramid
 *     box projector      lux       lux: as it is
 *     area, emissive     nits      lumen: hdrp_light_nits_from_lumen_sphere, _disc, _rectangle,
 *                                  _line; EV100: hdrp_light_nits_from_ev100
 *     environment        nits      lux of the upper hemisphere: hdrp_env.h
 *
 * Conventions. Reflectors and pyramids take full angles, as lamps are sold; soft spots and records
 * take half angles, as in glTF; the parameter says which. A light shines along its forward axis and
 * looks like a camera (right, up, forward); l points from the surface to the light. The functions
 * that make records accept anything, so that evaluation has nothing left to check.
 *
 * See hdrp_math.h for the languages and the override macros. There is no algorithm layer.
 *
 * >>index of the functions, without hdrp_light_ (written by tools/api_check.py --write)
 *   photometric units: candela_from_lumen_point lumen_from_candela_point
 *       candela_from_lumen_spot_occluder lumen_from_candela_spot_occluder solid_angle_cone
 *       candela_from_lumen_spot_reflector lumen_from_candela_spot_reflector solid_angle_pyramid
 *       candela_from_lumen_pyramid lumen_from_candela_pyramid nits_from_lumen_sphere
 *       lumen_from_nits_sphere nits_from_lumen_disc lumen_from_nits_disc nits_from_lumen_rectangle
 *       lumen_from_nits_rectangle nits_from_lumen_line lumen_from_nits_line
 *       candela_m_from_lumen_line_isotropic lumen_from_candela_m_line_isotropic nits_from_ev100
 *       ev100_from_nits lux_from_ev100 ev100_from_lux lux_from_candela candela_from_lux
 *       lux_ground_from_lux_sun lux_sun_from_lux_ground nits_from_lux_sky_disc
 *       lux_from_nits_sky_disc
 *   exposure: ev100_from_camera ev100_compensated nits_max_saturation exposure_saturation
 *       nits_max_standard_output exposure_standard_output
 *   attenuation: inv_range_sq window falloff falloff_gltf versine cone_shape_make cone_attenuation
 *       solid_angle_spot candela_from_lumen_spot lumen_from_candela_spot pyramid_shape_make
 *       pyramid_attenuation box_attenuation
 *   light record: type affects sign directional point spot pyramid box
 *   evaluation: eval_directional eval_point eval_spot eval_pyramid eval_box eval sine variance
 * >>end */
#ifndef HDRP_LIGHT_H
#define HDRP_LIGHT_H

#include "hdrp_math.h"

#if HDRP_VERSION != 100
#error "hdrp_light.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

#ifndef HDRP_GPU
#include <stddef.h>
#endif

/* Lengths of area lights below a micrometre count as a micrometre. */
#define HDRP_LIGHT_SIZE_MIN_M 1e-6f
/* Reflected-light meter constant, in nits s: an average scene of L nits is exposed at
 * EV100 = log2(100 L / K). Used by camera makers and by Lagarde and de Rousiers 2014. */
#define HDRP_LIGHT_METER_K 12.5f
/* Incident-light meter constant of a flat receptor, in lux s. ISO 2720:1974 allows 240 to 400. */
#define HDRP_LIGHT_METER_C 250.0f
/* EV100 arguments are limited to -this and this: all results stay normal floats. */
#define HDRP_LIGHT_EV100_MAX 120.0f
/* Aperture, shutter time and ISO speed are limited to this range. */
#define HDRP_LIGHT_CAMERA_MIN 1e-6f
#define HDRP_LIGHT_CAMERA_MAX 1e6f

/* sin(x share) / share for x share in [0, pi/2], within 1.3e-7 of itself however small: Vulkan
 * devices promise the built-in an absolute error of 2^-11 only. A normal x stays normal, which a
 * share of it might not. The coefficients are minimax in relative error. */
HDRP_FN float hdrp_i_light_sin_of_share(float x, float share)
{
    float y = hdrp_sq(share * x);
    float p = -1.98096029e-4f + y * 2.60578059e-6f;
    p = y * (-1.66666596e-1f + y * (8.33306625e-3f + y * p));
    return x + x * p;
}

/* The sine of x in [0, pi/2], likewise. */
HDRP_FN float hdrp_i_light_sin(float x)
{
    return hdrp_i_light_sin_of_share(x, 1.0f);
}

/* The cosine of x in [0, pi/2], likewise. The second constant is pi/2 minus the first. */
HDRP_FN float hdrp_i_light_cos(float x)
{
    return hdrp_i_light_sin(hdrp_max((HDRP_HALF_PI - x) - 4.37113883e-8f, 0.0f));
}

/* a / b for a, b >= 0: 0 where a is 0 or NaN, else at most FLT_MAX, also where b is 0. */
HDRP_FN float hdrp_i_light_ratio(float a, float b)
{
    return a > 0.0f ? hdrp_min(a / b, HDRP_FLT_MAX) : 0.0f;
}

/* a over the area of a circle of diameter d, limited likewise. The product d (pi/4 d) would
 * underflow for small circles; in this order neither quotient overflows unless the result does. */
HDRP_FN float hdrp_i_light_over_circle(float a, float d)
{
    return hdrp_i_light_ratio(a / d, 0.25f * HDRP_PI * d);
}

/* a times that area, at most FLT_MAX. Its inverse, in the opposite order. */
HDRP_FN float hdrp_i_light_times_circle(float a, float d)
{
    return hdrp_min(a * (0.25f * HDRP_PI * d) * d, HDRP_FLT_MAX);
}

/* The circle as large as a cone's cap of the unit sphere, 4 pi sin^2(full / 4): its diameter. */
HDRP_FN float hdrp_i_light_cone_diameter(float full_angle_rad)
{
    return hdrp_i_light_sin_of_share(hdrp_clamp(full_angle_rad, 0.0f, HDRP_TWO_PI), 0.25f);
}

/* The circle as large as a sky disc's projection on what faces it, pi sin^2(full / 2). */
HDRP_FN float hdrp_i_light_sky_diameter(float full_angle_rad)
{
    return hdrp_i_light_sin_of_share(hdrp_clamp(full_angle_rad, 0.0f, HDRP_PI), 0.5f);
}

/* A width or radius as the area light functions read it. */
HDRP_FN float hdrp_i_light_size(float size_m)
{
    return hdrp_max(size_m, HDRP_LIGHT_SIZE_MIN_M);
}

/* >>photometric units
 * Point-like lights: luminous intensity [cd] from luminous flux [lm] and back. The relative errors
 * of this section hold where arguments and result are normal numbers or 0. */

/** Luminous intensity of a point light of a given flux.
 *  lumen    [0,FLT_MAX]  luminous flux
 *  returns  [0,2.8e37]   cd, the same in every direction
 *  edges    linear down to the smallest flux
 *  error    <= 1.2e-7 relative against an integral over the sphere  @accuracy light_candela_point
 *  source   Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 *           on light units */
HDRP_FN float hdrp_light_candela_from_lumen_point(float lumen)
{
    return lumen * (0.25f * HDRP_INV_PI);
}

/** Flux of a point light of a given luminous intensity.
 *  candela  [0,2.7e37]  luminous intensity
 *  returns  [0,3.4e38]  lm
 *  edges    overflows above the range
 *  error    <= 1.1e-7 relative against an integral over the sphere  @accuracy light_lumen_point
 *  source   Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 *           on light units */
HDRP_FN float hdrp_light_lumen_from_candela_point(float candela)
{
    return candela * (4.0f * HDRP_PI);
}

/** Luminous intensity of a spot that is a point light behind an opaque shade: narrowing the cone
 *  hides light and leaves the intensity alone.
 *  lumen    [0,FLT_MAX]  luminous flux of the bare lamp
 *  returns  [0,2.8e37]   cd inside the cone, whatever its angle
 *  edges    those of hdrp_light_candela_from_lumen_point
 *  error    none: delegates to hdrp_light_candela_from_lumen_point
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slides on physical light units */
HDRP_FN float hdrp_light_candela_from_lumen_spot_occluder(float lumen)
{
    return hdrp_light_candela_from_lumen_point(lumen);
}

/** Flux of the bare lamp in a spot that is a point light behind an opaque shade.
 *  candela  [0,2.7e37]  luminous intensity inside the cone
 *  returns  [0,3.4e38]  lm of the lamp, not of the beam
 *  edges    those of hdrp_light_lumen_from_candela_point
 *  error    none: delegates to hdrp_light_lumen_from_candela_point
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slides on physical light units */
HDRP_FN float hdrp_light_lumen_from_candela_spot_occluder(float candela)
{
    return hdrp_light_lumen_from_candela_point(candela);
}

/** Solid angle of a cone.
 *  full_angle_rad  [0,HDRP_TWO_PI]  between opposite sides of the cone
 *  returns         [0,12.57]        sr
 *  edges           4 pi for the whole sphere; an angle outside or NaN counts as the nearer end or
 *                  0; below 1e-18 rad the result underflows towards 0
 *  error           <= 3.1e-7 relative against quadrature  @accuracy light_solid_angle_cone
 *  source          a spherical cap of half angle a covers 2 pi (1 - cos a)
 *  note            4 pi sin^2(full / 4) is the same and does not cancel: in floats 1 - cos loses
 *                  6 % at 0.1 degrees and everything at 0.02 */
HDRP_FN float hdrp_light_solid_angle_cone(float full_angle_rad)
{
    return hdrp_i_light_times_circle(1.0f, hdrp_i_light_cone_diameter(full_angle_rad));
}

/** Luminous intensity of a spot whose reflector gathers the whole flux into a cone of constant
 *  intensity.
 *  lumen           [0,FLT_MAX]      luminous flux
 *  full_angle_rad  [0,HDRP_TWO_PI]  between opposite sides of the cone
 *  returns         [0,FLT_MAX]      cd inside the cone
 *  edges           FLT_MAX where the result would be larger, as at angle 0; 0 for no flux; an angle
 *                  outside or NaN counts as the nearer end or 0
 *  error           <= 3.5e-7 relative against quadrature  @accuracy light_candela_spot_reflector
 *  source          Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *                  section on light units
 *  note            for a cone with a soft edge see hdrp_light_candela_from_lumen_spot */
HDRP_FN float hdrp_light_candela_from_lumen_spot_reflector(float lumen, float full_angle_rad)
{
    return hdrp_i_light_over_circle(lumen, hdrp_i_light_cone_diameter(full_angle_rad));
}

/** Flux of a cone of constant luminous intensity.
 *  candela         [0,FLT_MAX]      luminous intensity inside the cone
 *  full_angle_rad  [0,HDRP_TWO_PI]  between opposite sides of the cone
 *  returns         [0,FLT_MAX]      lm
 *  edges           FLT_MAX where the result would be larger; 0 at angle 0; an angle outside or NaN
 *                  counts as the nearer end or 0
 *  error           <= 3.4e-7 relative against quadrature  @accuracy light_lumen_spot_reflector
 *  source          Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *                  section on light units */
HDRP_FN float hdrp_light_lumen_from_candela_spot_reflector(float candela, float full_angle_rad)
{
    return hdrp_i_light_times_circle(candela, hdrp_i_light_cone_diameter(full_angle_rad));
}

/** Solid angle of a rectangular pyramid with its apex on the axis.
 *  full_angle_x_rad  [0,HDRP_PI]  between the left and the right face
 *  full_angle_y_rad  [0,HDRP_PI]  between the lower and the upper face
 *  returns           [0,6.29]     sr
 *  edges             2 pi where both are pi; 0 where one is 0; an angle outside or NaN counts as
 *                    the nearer end or 0; below 1e-36 rad^2 the result underflows towards 0
 *  error             <= 3e-7 relative against quadrature  @accuracy light_solid_angle_pyramid
 *  source            Mazonka 2012, "Solid Angle of Conical Surfaces, Polyhedral Cones, and
 *                    Intersecting Spherical Caps", section on the rectangular pyramid
 *  note              4 asin(sin sin) as an arc tangent: near pi the sines are all 1, and asin turns
 *                    their rounding into 3e-4 */
HDRP_FN float hdrp_light_solid_angle_pyramid(float full_angle_x_rad, float full_angle_y_rad)
{
    float x = 0.5f * hdrp_clamp(full_angle_x_rad, 0.0f, HDRP_PI);
    float y = 0.5f * hdrp_clamp(full_angle_y_rad, 0.0f, HDRP_PI);
    float sin_x = hdrp_i_light_sin(x);
    float cos_x = hdrp_i_light_cos(x);
    float cos_y = hdrp_i_light_cos(y);
    float adjacent = hdrp_sqrt(cos_x * cos_x + sin_x * sin_x * (cos_y * cos_y));
    return 4.0f * hdrp_atan2(sin_x * hdrp_i_light_sin(y), adjacent);
}

/* The sines of a pyramid's half angles, the smaller times 4: where their product is small it is the
 * solid angle. One after the other they neither underflow nor overflow unless the result does. */
struct hdrp_i_light_sides {
    float larger;   /* [0,1] */
    float smaller;  /* [0,4] */
    float is_small; /* [0,1] 1 where the product is it: the next term is less than 1e-20 of it */
};
HDRP_TYPEDEF(hdrp_i_light_sides)

HDRP_FN hdrp_i_light_sides hdrp_i_light_pyramid_sides(float full_angle_x_rad,
                                                      float full_angle_y_rad)
{
    hdrp_i_light_sides s;
    float x = hdrp_i_light_sin_of_share(hdrp_clamp(full_angle_x_rad, 0.0f, HDRP_PI), 0.5f);
    float y = hdrp_i_light_sin_of_share(hdrp_clamp(full_angle_y_rad, 0.0f, HDRP_PI), 0.5f);
    s.larger = 0.5f * hdrp_max(x, y);
    s.smaller = 2.0f * hdrp_min(x, y);
    s.is_small = s.larger * s.smaller < 1e-10f ? 1.0f : 0.0f;
    return s;
}

/** Luminous intensity of a pyramid spot whose reflector gathers the whole flux inside its faces.
 *  lumen             [0,FLT_MAX]  luminous flux
 *  full_angle_x_rad  [0,HDRP_PI]  between the left and the right face
 *  full_angle_y_rad  [0,HDRP_PI]  between the lower and the upper face
 *  returns           [0,FLT_MAX]  cd inside the pyramid
 *  edges             FLT_MAX where the result would be larger, as at angle 0; 0 for no flux
 *  error             <= 3.7e-7 relative against quadrature  @accuracy light_candela_pyramid
 *  source            Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *                    Definition Render Pipeline", slides on physical light units
 *  note              exact for hard edges; a soft edge takes light away */
HDRP_FN float hdrp_light_candela_from_lumen_pyramid(float lumen, float full_angle_x_rad,
                                                    float full_angle_y_rad)
{
    hdrp_i_light_sides s = hdrp_i_light_pyramid_sides(full_angle_x_rad, full_angle_y_rad);
    float solid_angle = hdrp_light_solid_angle_pyramid(full_angle_x_rad, full_angle_y_rad);
    float narrow = hdrp_i_light_ratio(lumen / s.larger, s.smaller);
    return s.is_small > 0.0f ? narrow : hdrp_i_light_ratio(lumen, solid_angle);
}

/** Flux of a pyramid of constant luminous intensity.
 *  candela           [0,5e37]     luminous intensity inside the pyramid
 *  full_angle_x_rad  [0,HDRP_PI]  between the left and the right face
 *  full_angle_y_rad  [0,HDRP_PI]  between the lower and the upper face
 *  returns           [0,3.2e38]   lm
 *  edges             0 where an angle is 0; overflows above the range of candela
 *  error             <= 3.6e-7 relative against quadrature  @accuracy light_lumen_pyramid
 *  source            Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *                    Definition Render Pipeline", slides on physical light units */
HDRP_FN float hdrp_light_lumen_from_candela_pyramid(float candela, float full_angle_x_rad,
                                                    float full_angle_y_rad)
{
    hdrp_i_light_sides s = hdrp_i_light_pyramid_sides(full_angle_x_rad, full_angle_y_rad);
    float solid_angle = hdrp_light_solid_angle_pyramid(full_angle_x_rad, full_angle_y_rad);
    return s.is_small > 0.0f ? candela * s.larger * s.smaller : candela * solid_angle;
}

/* Area lights: luminance [nits = cd/m^2] from luminous flux and back. Every point of the surface
 * is Lambertian, so that an area A facing one way emits pi A L. */

/** Luminance of a sphere of a given flux.
 *  lumen     [0,1e24]  luminous flux
 *  radius_m  [0,1e12]
 *  returns   [0,3e34]  nits
 *  edges     a radius below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 2.7e-7 relative against quadrature  @accuracy light_nits_sphere
 *  source    Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *            section on area lights */
HDRP_FN float hdrp_light_nits_from_lumen_sphere(float lumen, float radius_m)
{
    float r = hdrp_i_light_size(radius_m);
    return lumen / (4.0f * HDRP_PI * HDRP_PI * r * r);
}

/** Flux of a sphere of a given luminance.
 *  nits      [0,1e12]  luminance
 *  radius_m  [0,1e12]
 *  returns   [0,4e37]  lm
 *  edges     a radius below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 2.6e-7 relative against quadrature  @accuracy light_lumen_sphere
 *  source    Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *            section on area lights */
HDRP_FN float hdrp_light_lumen_from_nits_sphere(float nits, float radius_m)
{
    float r = hdrp_i_light_size(radius_m);
    return nits * (4.0f * HDRP_PI * HDRP_PI * r * r);
}

/** Luminance of a disc that emits on one side.
 *  lumen     [0,1e24]    luminous flux
 *  radius_m  [0,1e12]
 *  returns   [0,1.1e35]  nits
 *  edges     a radius below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 2.7e-7 relative against quadrature  @accuracy light_nits_disc
 *  source    Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *            section on area lights */
HDRP_FN float hdrp_light_nits_from_lumen_disc(float lumen, float radius_m)
{
    float r = hdrp_i_light_size(radius_m);
    return lumen / (HDRP_PI * HDRP_PI * r * r);
}

/** Flux of a disc that emits on one side.
 *  nits      [0,1e12]  luminance
 *  radius_m  [0,1e12]
 *  returns   [0,1e37]  lm
 *  edges     a radius below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 2.6e-7 relative against quadrature  @accuracy light_lumen_disc
 *  source    Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *            section on area lights */
HDRP_FN float hdrp_light_lumen_from_nits_disc(float nits, float radius_m)
{
    float r = hdrp_i_light_size(radius_m);
    return nits * (HDRP_PI * HDRP_PI * r * r);
}

/** Luminance of a rectangle that emits on one side.
 *  lumen     [0,1e24]    luminous flux
 *  width_m   [0,1e12]
 *  height_m  [0,1e12]
 *  returns   [0,3.3e35]  nits
 *  edges     a side below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 2e-7 relative against quadrature  @accuracy light_nits_rectangle
 *  source    Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *            section on area lights */
HDRP_FN float hdrp_light_nits_from_lumen_rectangle(float lumen, float width_m, float height_m)
{
    return lumen / (HDRP_PI * hdrp_i_light_size(width_m) * hdrp_i_light_size(height_m));
}

/** Flux of a rectangle that emits on one side.
 *  nits      [0,1e12]  luminance
 *  width_m   [0,1e12]
 *  height_m  [0,1e12]
 *  returns   [0,4e36]  lm
 *  edges     a side below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 2e-7 relative against quadrature  @accuracy light_lumen_rectangle
 *  source    Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *            section on area lights */
HDRP_FN float hdrp_light_lumen_from_nits_rectangle(float nits, float width_m, float height_m)
{
    return nits * (HDRP_PI * hdrp_i_light_size(width_m) * hdrp_i_light_size(height_m));
}

/** Luminance of a line light of a given flux, for the line integrals of hdrp_area.h.
 *  lumen     [0,1e24]  luminous flux
 *  length_m  [0,1e12]
 *  returns   [0,6e28]  nits m: luminance times radius of the thin Lambertian cylinder that the line
 *                      stands for. A metre of it shines with 2 * this [cd] square to its axis
 *  edges     a length below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 2.1e-7 relative against quadrature  @accuracy light_nits_line
 *  source    Heitz and Hill 2017, "Real-Time Line- and Disk-Light Shading with Linearly Transformed
 *            Cosines", whose integrand has a metre emit 2 sin(theta) per unit of luminance; the
 *            integral of that over the sphere is 2 pi^2
 *  note      pairing that integrand with the isotropic 4 pi per metre, as the slides of Lagarde and
 *            Golubev 2018 do, emits pi/2 times the requested flux */
HDRP_FN float hdrp_light_nits_from_lumen_line(float lumen, float length_m)
{
    return lumen / (2.0f * HDRP_PI * HDRP_PI * hdrp_i_light_size(length_m));
}

/** Flux of a line light of a given luminance.
 *  nits_m    [0,1e24]  luminance times radius, see hdrp_light_nits_from_lumen_line
 *  length_m  [0,1e12]
 *  returns   [0,2e37]  lm
 *  edges     a length below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 2.1e-7 relative against quadrature  @accuracy light_lumen_line
 *  source    derived, see hdrp_light_nits_from_lumen_line */
HDRP_FN float hdrp_light_lumen_from_nits_line(float nits_m, float length_m)
{
    return nits_m * (2.0f * HDRP_PI * HDRP_PI * hdrp_i_light_size(length_m));
}

/** Intensity per length of a line whose points shine equally in all directions. Not for the line
 *  integrals of hdrp_area.h.
 *  lumen     [0,1e24]  luminous flux
 *  length_m  [0,1e12]
 *  returns   [0,8e28]  cd/m
 *  edges     a length below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error     <= 1.6e-7 relative against quadrature  @accuracy light_nits_line_isotropic
 *  source    Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *            Definition Render Pipeline", slides on physical light units */
HDRP_FN float hdrp_light_candela_m_from_lumen_line_isotropic(float lumen, float length_m)
{
    return lumen / (4.0f * HDRP_PI * hdrp_i_light_size(length_m));
}

/** Flux of a line whose points shine equally in all directions.
 *  candela_m  [0,1e24]    intensity per length, cd/m
 *  length_m   [0,1e12]
 *  returns    [0,1.3e37]  lm
 *  edges      a length below HDRP_LIGHT_SIZE_MIN_M or NaN counts as that
 *  error      <= 1.6e-7 relative against quadrature  @accuracy light_lumen_line_isotropic
 *  source     Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *             Definition Render Pipeline", slides on physical light units */
HDRP_FN float hdrp_light_lumen_from_candela_m_line_isotropic(float candela_m, float length_m)
{
    return candela_m * (4.0f * HDRP_PI * hdrp_i_light_size(length_m));
}

/* Exposure values as units: EV100 of a luminance with K = 12.5, of an illuminance with C = 250. */

/* 2 to the power of an EV100 argument. */
HDRP_FN float hdrp_i_light_exp2(float ev100)
{
    return hdrp_exp2(hdrp_clamp(ev100, -HDRP_LIGHT_EV100_MAX, HDRP_LIGHT_EV100_MAX));
}

/** Luminance that a reflected-light meter reads as EV100.
 *  ev100    [-HDRP_LIGHT_EV100_MAX,HDRP_LIGHT_EV100_MAX]  exposure value at ISO 100
 *  returns  [9e-38,1.7e35]  nits
 *  edges    outside the range as at its ends; NaN as at the lower
 *  error    <= 7.2e-8 relative against double  @accuracy light_nits_ev100
 *  source   Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 *           on light units; ISO 2720:1974 with K = HDRP_LIGHT_METER_K */
HDRP_FN float hdrp_light_nits_from_ev100(float ev100)
{
    return hdrp_i_light_exp2(ev100) * (0.01f * HDRP_LIGHT_METER_K);
}

/** EV100 of an average luminance: what a reflected-light meter, or auto exposure, sets.
 *  nits     [0,FLT_MAX]  luminance
 *  returns  [-126,128]   EV100
 *  edges    outside [1.5e-39,4.2e37] nits, and for NaN, as at the nearer end or the lower
 *  error    <= 4.6e-6 absolute against double  @accuracy light_ev100_nits
 *  source   Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 *           on the physically based camera; ISO 2720:1974 with K = HDRP_LIGHT_METER_K */
HDRP_FN float hdrp_light_ev100_from_nits(float nits)
{
    float x = nits * (100.0f / HDRP_LIGHT_METER_K);
    return hdrp_log2(hdrp_clamp(x, HDRP_FLT_MIN, HDRP_FLT_MAX));
}

/** Illuminance that an incident-light meter reads as EV100.
 *  ev100    [-HDRP_LIGHT_EV100_MAX,HDRP_LIGHT_EV100_MAX]  exposure value at ISO 100
 *  returns  [1.8e-36,3.4e36]  lux
 *  edges    outside the range as at its ends; NaN as at the lower
 *  error    <= 1.3e-7 relative against double  @accuracy light_lux_ev100
 *  source   ISO 2720:1974 with C = HDRP_LIGHT_METER_C */
HDRP_FN float hdrp_light_lux_from_ev100(float ev100)
{
    return hdrp_i_light_exp2(ev100) * (0.01f * HDRP_LIGHT_METER_C);
}

/** EV100 that an incident-light meter reads.
 *  lux      [0,FLT_MAX]  illuminance
 *  returns  [-126,127]   EV100
 *  edges    anything below 3e-38 lux, and NaN, counts as that
 *  error    <= 4.7e-6 absolute against double  @accuracy light_ev100_lux
 *  source   ISO 2720:1974 with C = HDRP_LIGHT_METER_C */
HDRP_FN float hdrp_light_ev100_from_lux(float lux)
{
    return hdrp_log2(hdrp_max(lux * (100.0f / HDRP_LIGHT_METER_C), HDRP_FLT_MIN));
}

/* Illuminance. */

/** Illuminance of a surface that faces a point-like light, without range or minimum distance.
 *  candela     [0,FLT_MAX]  luminous intensity towards the surface
 *  distance_m  [0,FLT_MAX]
 *  returns     [0,FLT_MAX]  lux
 *  edges       FLT_MAX where the result would be larger, as at distance 0; 0 for no light
 *  error       <= 1.4e-7 relative against the flux through a sphere  @accuracy light_lux_candela
 *  source      the inverse square law */
HDRP_FN float hdrp_light_lux_from_candela(float candela, float distance_m)
{
    return hdrp_i_light_ratio(candela / distance_m, distance_m);
}

/** Luminous intensity that gives a wanted illuminance at a distance.
 *  lux         [0,FLT_MAX]  illuminance of a surface that faces the light
 *  distance_m  [0,FLT_MAX]
 *  returns     [0,FLT_MAX]  cd
 *  edges       FLT_MAX where the result would be larger
 *  error       <= 1.4e-7 relative against the flux through a sphere  @accuracy light_candela_lux
 *  source      the inverse square law */
HDRP_FN float hdrp_light_candela_from_lux(float lux, float distance_m)
{
    return hdrp_min(lux * distance_m * distance_m, HDRP_FLT_MAX);
}

/** Illuminance of level ground under a sun whose lux are given as for the zenith.
 *  lux            [0,FLT_MAX]                    illuminance of a surface that faces the sun: the
 *                                                colour of a directional light
 *  elevation_rad  [-HDRP_HALF_PI,HDRP_HALF_PI]  of the sun above the horizon
 *  returns        [0,FLT_MAX]                    lux
 *  edges          0 below the horizon; lux itself at the zenith; NaN counts as below
 *  error          <= 1.7e-7 relative against a dot product in double  @accuracy light_lux_ground
 *  source         Lambert's cosine law; Lagarde and Golubev 2018, "The Road toward Unified
 *                 Rendering with Unity's High Definition Render Pipeline", slides on physical
 *                 light units
 *  note           the atmosphere, which dims and reddens a low sun, is not modelled */
HDRP_FN float hdrp_light_lux_ground_from_lux_sun(float lux, float elevation_rad)
{
    return lux * hdrp_min(hdrp_i_light_sin(hdrp_clamp(elevation_rad, 0.0f, HDRP_HALF_PI)), 1.0f);
}

/** Lux of a sun, as for the zenith, that lights level ground with a wanted illuminance.
 *  lux            [0,FLT_MAX]                    illuminance of the ground
 *  elevation_rad  [-HDRP_HALF_PI,HDRP_HALF_PI]  of the sun above the horizon
 *  returns        [0,FLT_MAX]                    lux of a surface that faces the sun
 *  edges          FLT_MAX where the result would be larger, as at and below the horizon; 0 for 0
 *  error          <= 1.6e-7 relative against a dot product in double  @accuracy light_lux_sun
 *  source         Lambert's cosine law, see hdrp_light_lux_ground_from_lux_sun */
HDRP_FN float hdrp_light_lux_sun_from_lux_ground(float lux, float elevation_rad)
{
    return hdrp_i_light_ratio(lux, hdrp_i_light_sin(hdrp_clamp(elevation_rad, 0.0f, HDRP_HALF_PI)));
}

/** Luminance of a disc in the sky, such as the sun's, that gives a wanted illuminance.
 *  lux                   [0,FLT_MAX]  on a surface that faces the centre of the disc
 *  angular_diameter_rad  [0,HDRP_PI]  the sun's is 0.0093
 *  returns               [0,FLT_MAX]  nits, the same all over the disc
 *  edges                 FLT_MAX where the result would be larger, as at diameter 0; 0 for no
 *                        light; a diameter outside or NaN counts as the nearer end or 0
 *  error                 <= 3.4e-7 relative against quadrature  @accuracy light_nits_sky_disc
 *  source                derived: the integral of cos over a cap of half angle a is pi sin^2 a
 *  note                  a diameter of pi is a uniform sky: lux / pi */
HDRP_FN float hdrp_light_nits_from_lux_sky_disc(float lux, float angular_diameter_rad)
{
    return hdrp_i_light_over_circle(lux, hdrp_i_light_sky_diameter(angular_diameter_rad));
}

/** Illuminance of a surface that faces the centre of a disc in the sky, such as the sun's.
 *  nits                  [0,FLT_MAX]  luminance, the same all over the disc
 *  angular_diameter_rad  [0,HDRP_PI]  the sun's is 0.0093
 *  returns               [0,FLT_MAX]  lux
 *  edges                 FLT_MAX where the result would be larger; 0 at diameter 0
 *  error                 <= 3.4e-7 relative against quadrature  @accuracy light_lux_sky_disc
 *  source                derived, see hdrp_light_nits_from_lux_sky_disc */
HDRP_FN float hdrp_light_lux_from_nits_sky_disc(float nits, float angular_diameter_rad)
{
    return hdrp_i_light_times_circle(nits, hdrp_i_light_sky_diameter(angular_diameter_rad));
}

/* >>exposure
 * From a camera to the factor that turns nits into the 0 to 1 of an image. EV100 from an average
 * luminance, for auto exposure, is hdrp_light_ev100_from_nits. Two conventions map EV100 to a
 * factor; both are scales of the same curve and differ by 0.49 stops. */

/* Vignetting, transmission and angle of a lens: H = q L t / N^2. ISO 12232:2006. */
#define HDRP_LIGHT_LENS_Q 0.65f
/* ISO 12232:2006: exposures H [lux s] of a sensor of speed S that clip, 78 / S, and that print as
 * middle grey, 10 / S. */
#define HDRP_LIGHT_SPEED_SATURATION      78.0f
#define HDRP_LIGHT_SPEED_STANDARD_OUTPUT 10.0f
/* Linear value of sRGB code 118, which standard output sensitivity aims at. */
#define HDRP_LIGHT_MIDDLE_GREY 0.18f

/** EV100 of camera settings.
 *  aperture_f_number  [HDRP_LIGHT_CAMERA_MIN,HDRP_LIGHT_CAMERA_MAX]  N, as in f/16
 *  shutter_s          [HDRP_LIGHT_CAMERA_MIN,HDRP_LIGHT_CAMERA_MAX]  exposure time
 *  iso                [HDRP_LIGHT_CAMERA_MIN,HDRP_LIGHT_CAMERA_MAX]  speed S
 *  returns            [-74,87]  log2(N^2 / t * 100 / S)
 *  edges              outside the ranges as at their ends; NaN as at the lower end
 *  error              <= 4.8e-6 absolute against double  @accuracy light_ev100_camera
 *  source             Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based
 *                     Rendering", section on the physically based camera */
HDRP_FN float hdrp_light_ev100_from_camera(float aperture_f_number, float shutter_s, float iso)
{
    float n = hdrp_clamp(aperture_f_number, HDRP_LIGHT_CAMERA_MIN, HDRP_LIGHT_CAMERA_MAX);
    float t = hdrp_clamp(shutter_s, HDRP_LIGHT_CAMERA_MIN, HDRP_LIGHT_CAMERA_MAX);
    float s = hdrp_clamp(iso, HDRP_LIGHT_CAMERA_MIN, HDRP_LIGHT_CAMERA_MAX);
    return hdrp_log2(n * n * 100.0f / (t * s));
}

/** EV100 to render with when the photographer dials in a compensation.
 *  ev100    [-1e30,1e30]  metered
 *  stops    [-1e30,1e30]  positive brightens the image: + 1 doubles it
 *  returns  finite        ev100 - stops
 *  edges    none
 *  error    none: one subtraction
 *  source   Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 *           on the physically based camera */
HDRP_FN float hdrp_light_ev100_compensated(float ev100, float stops)
{
    return ev100 - stops;
}

/** Luminance that clips, saturation-based: the sensor's speed is 78 over the exposure that
 *  saturates it (ISO 12232). A metered average then renders as 0.104.
 *  ev100    [-HDRP_LIGHT_EV100_MAX,HDRP_LIGHT_EV100_MAX]  exposure value at ISO 100
 *  returns  [9e-37,1.6e36]  nits that render as 1; 1.2 * 2^ev100
 *  edges    outside the range as at its ends; NaN as at the lower
 *  error    <= 1.7e-7 relative against a simulated sensor  @accuracy light_nits_saturation
 *  source   Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 *           on the physically based camera; ISO 12232:2006, saturation based speed, q = 0.65 */
HDRP_FN float hdrp_light_nits_max_saturation(float ev100)
{
    return hdrp_i_light_exp2(ev100) * (HDRP_LIGHT_SPEED_SATURATION / (100.0f * HDRP_LIGHT_LENS_Q));
}

/** Factor from nits to image values, saturation-based: 1 is the luminance that clips the sensor.
 *  ev100    [-HDRP_LIGHT_EV100_MAX,HDRP_LIGHT_EV100_MAX]  exposure value at ISO 100
 *  returns  [6e-37,1.2e36]  1/nits
 *  edges    outside the range as at its ends; NaN as at the lower
 *  error    <= 2.1e-7 relative against a simulated sensor  @accuracy light_exposure_saturation
 *  source   see hdrp_light_nits_max_saturation */
HDRP_FN float hdrp_light_exposure_saturation(float ev100)
{
    return 1.0f / hdrp_light_nits_max_saturation(ev100);
}

/** Luminance that renders as 1, speed-based: by standard output sensitivity (ISO 12232) an exposure
 *  of 10 over the speed renders as middle grey, 0.18. A metered average then renders as 0.146.
 *  ev100    [-HDRP_LIGHT_EV100_MAX,HDRP_LIGHT_EV100_MAX]  exposure value at ISO 100
 *  returns  [6e-37,1.2e36]  nits that render as 1; 0.855 * 2^ev100
 *  edges    outside the range as at its ends; NaN as at the lower
 *  error    <= 2e-7 relative against a simulated sensor  @accuracy light_nits_standard_output
 *  source   ISO 12232:2006, standard output sensitivity, q = 0.65 */
HDRP_FN float hdrp_light_nits_max_standard_output(float ev100)
{
    return hdrp_i_light_exp2(ev100) * (HDRP_LIGHT_SPEED_STANDARD_OUTPUT /
                                       (100.0f * HDRP_LIGHT_LENS_Q * HDRP_LIGHT_MIDDLE_GREY));
}

/** Factor from nits to image values, speed-based: standard output sensitivity.
 *  ev100    [-HDRP_LIGHT_EV100_MAX,HDRP_LIGHT_EV100_MAX]  exposure value at ISO 100
 *  returns  [8e-37,1.6e36]  1/nits
 *  edges    outside the range as at its ends; NaN as at the lower
 *  error    <= 2.4e-7 relative against a simulated sensor  @accuracy light_exposure_standard_output
 *  source   see hdrp_light_nits_max_standard_output */
HDRP_FN float hdrp_light_exposure_standard_output(float ev100)
{
    return 1.0f / hdrp_light_nits_max_standard_output(ev100);
}

/* >>attenuation
 * Factors of a punctual light: by distance, by direction, and by place in a projector's box. */

/* A range that means none, in metres; a light's position may lie as far out. The squares of both
 * and of their differences are finite. */
#define HDRP_LIGHT_RANGE_INFINITE 1e18f
#define HDRP_LIGHT_POSITION_MAX   1e18f
/* Distance given for lights that are infinitely far; above every other distance. */
#define HDRP_LIGHT_DISTANCE_INFINITE 1e19f
/* Nearer than this, in metres, light stops growing: a lamp is about this large. */
#define HDRP_LIGHT_DISTANCE_MIN_M 0.01f
/* Shorter ranges, in metres, count as this: the inverse square stays finite. */
#define HDRP_LIGHT_RANGE_MIN_M 1e-6f
/* Narrower beams, in radians, count as this. A direction in floats is good to 1e-7. */
#define HDRP_LIGHT_HALF_ANGLE_MIN 1e-5f
/* Edges are at least this wide, as a share of what they limit: a slope stays finite. */
#define HDRP_LIGHT_EDGE_MIN 1e-4f

/** The window parameter of a range, to be computed once per light.
 *  range_m  [0,FLT_MAX]  distance at which the light ends; HDRP_LIGHT_RANGE_INFINITE or more: never
 *  returns  [0,1e12]     1 / range_m^2
 *  edges    exactly 0 for an infinite range; below HDRP_LIGHT_RANGE_MIN_M or NaN as at it
 *  error    <= 1.1e-7 relative against double  @accuracy light_inv_range_sq
 *  source   a definition */
HDRP_FN float hdrp_light_inv_range_sq(float range_m)
{
    float r = hdrp_max(range_m, HDRP_LIGHT_RANGE_MIN_M);
    return r >= HDRP_LIGHT_RANGE_INFINITE ? 0.0f : 1.0f / (r * r);
}

/** Window that ends a light at its range: (1 - (d/r)^4)^2. Value and slope are exactly 0 there.
 *  distance_sq   [0,FLT_MAX]  m^2, from the light
 *  inv_range_sq  [0,1e12]     from hdrp_light_inv_range_sq
 *  returns       [0,1]
 *  edges         1 at the light and everywhere for an infinite range; 0 at the range and beyond; 0
 *                for NaN
 *  error         <= 2.5e-7 absolute against double  @accuracy light_window
 *  source        Karis 2013, "Real Shading in Unreal Engine 4", eq. 9
 *  note          (1 - x)(1 + x) with x = d^2/r^2 keeps its digits near the range */
HDRP_FN float hdrp_light_window(float distance_sq, float inv_range_sq)
{
    float x = hdrp_min(distance_sq * inv_range_sq, 1.0f);
    return hdrp_sq((1.0f - x) * (1.0f + x));
}

/* 1 / d^2 with the minimum distance. */
HDRP_FN float hdrp_i_light_inverse_square(float distance_sq)
{
    return 1.0f / hdrp_max(distance_sq, HDRP_LIGHT_DISTANCE_MIN_M * HDRP_LIGHT_DISTANCE_MIN_M);
}

/** Inverse square falloff that ends at the light's range.
 *  distance_sq   [0,FLT_MAX]  m^2, from the light
 *  inv_range_sq  [0,1e12]     from hdrp_light_inv_range_sq
 *  returns       [0,10001]    1/m^2: lux per candela on a surface that faces the light
 *  edges         constant nearer than HDRP_LIGHT_DISTANCE_MIN_M; 0 at the range and beyond, with
 *                slope 0; for an infinite range plain 1/d^2
 *  error         <= 3.6e-7 absolute, as a share of 1/d^2  @accuracy light_falloff
 *  source        Karis 2013, "Real Shading in Unreal Engine 4", eq. 9; Lagarde and de Rousiers
 *                2014, "Moving Frostbite to Physically Based Rendering", section on punctual
 *                lights, for the minimum distance */
HDRP_FN float hdrp_light_falloff(float distance_sq, float inv_range_sq)
{
    return hdrp_light_window(distance_sq, inv_range_sq) * hdrp_i_light_inverse_square(distance_sq);
}

/** Falloff as glTF recommends it: the window is not squared, so that light ends with a crease.
 *  distance_sq   [0,FLT_MAX]  m^2, from the light
 *  inv_range_sq  [0,1e12]     from hdrp_light_inv_range_sq
 *  returns       [0,10001]    1/m^2: lux per candela on a surface that faces the light
 *  edges         constant nearer than HDRP_LIGHT_DISTANCE_MIN_M, which glTF leaves infinite; 0 at
 *                the range and beyond; for an infinite range plain 1/d^2
 *  error         <= 2.3e-7 absolute, as a share of 1/d^2  @accuracy light_falloff_gltf
 *  source        Khronos 2018, glTF extension KHR_lights_punctual, "Range Property" */
HDRP_FN float hdrp_light_falloff_gltf(float distance_sq, float inv_range_sq)
{
    float x = hdrp_min(distance_sq * inv_range_sq, 1.0f);
    return (1.0f - x) * (1.0f + x) * hdrp_i_light_inverse_square(distance_sq);
}

/** 1 - cos of the angle between two directions, precise for the smallest angles.
 *  a        unit
 *  b        unit
 *  returns  [0,2]
 *  edges    0 for equal directions, 2 for opposite ones
 *  error    <= 1.9e-7 absolute, as a share of the angle, against double  @accuracy light_versine
 *  source   |a - b|^2 = 2 - 2 cos
 *  note     1 - dot(a, b) is off by up to 10 % at 0.1 degrees, where this is off by 1e-4 */
HDRP_FN float hdrp_light_versine(hdrp_v3 a, hdrp_v3 b)
{
    hdrp_v3 d = hdrp_v3_sub(a, b);
    return hdrp_min(0.5f * hdrp_v3_dot(d, d), 2.0f);
}

/* 1 - cos of a half angle in [0, pi]. */
HDRP_FN float hdrp_i_light_versine(float half_angle_rad)
{
    float s = hdrp_i_light_sin(0.5f * half_angle_rad);
    return 2.0f * s * s;
}

/* A cone of light in the form that hdrp_light_cone_attenuation reads. Made by
 * hdrp_light_cone_shape_make. */
struct hdrp_light_cone_shape {
    float versine_outer; /* [4.9e-11,2.0003] 1 - cos of the half angle at which light ends */
    float scale;         /* [0.49,2.1e14] 1 over the versine's change across the edge */
};
HDRP_TYPEDEF(hdrp_light_cone_shape)

/** The cone between two half angles, to be computed once per light.
 *  inner_half_angle_rad  [0,HDRP_PI]  up to which the intensity is full
 *  outer_half_angle_rad  [0,HDRP_PI]  at which the light ends; pi/2 is half the sphere, pi all
 *  returns               valid
 *  edges                 an outer angle below HDRP_LIGHT_HALF_ANGLE_MIN or NaN counts as that, an
 *                        inner angle above the outer as the outer, a negative one or NaN as 0. An
 *                        edge that is narrower than HDRP_LIGHT_EDGE_MIN of the versine is widened
 *                        outwards: a hard cone ends 5e-5 of its angle later, and two angles of pi
 *                        make a point light without a hole
 *  error                 <= 2.8e-7 relative, of versine_outer  @accuracy light_cone_shape
 *  source                Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based
 *                        Rendering", section on punctual lights; with versines for cosines */
HDRP_FN hdrp_light_cone_shape hdrp_light_cone_shape_make(float inner_half_angle_rad,
                                                         float outer_half_angle_rad)
{
    hdrp_light_cone_shape c;
    float outer_rad = hdrp_clamp(outer_half_angle_rad, HDRP_LIGHT_HALF_ANGLE_MIN, HDRP_PI);
    float outer_versine = hdrp_i_light_versine(outer_rad);
    float inner_versine = hdrp_i_light_versine(hdrp_clamp(inner_half_angle_rad, 0.0f, outer_rad));
    float width = hdrp_max(outer_versine - inner_versine, HDRP_LIGHT_EDGE_MIN * outer_versine);
    c.versine_outer = inner_versine + width;
    c.scale = 1.0f / width;
    return c;
}

/** Share of a spot's intensity that leaves in a direction.
 *  versine  [0,2]  of the angle to the axis: hdrp_light_versine, or 1 - cos for wide cones
 *  cone     valid  from hdrp_light_cone_shape_make
 *  returns  [0,1]
 *  edges    1 inside the inner angle, 0 outside the outer one, with slope 0 there
 *  error    <= 2.6e-6 absolute against double, for edges at least as wide as 0.1 of the cosine's
 *           change over the whole cone  @accuracy light_cone_attenuation
 *  source   Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 *           on punctual lights; the same curve as in the glTF extension KHR_lights_punctual */
HDRP_FN float hdrp_light_cone_attenuation(float versine, hdrp_light_cone_shape cone)
{
    return hdrp_sq(hdrp_saturate((cone.versine_outer - versine) * cone.scale));
}

/** Solid angle that the flux of a soft spot would fill at full intensity.
 *  inner_half_angle_rad  [0,HDRP_PI]   up to which the intensity is full
 *  outer_half_angle_rad  [0,HDRP_PI]   at which the light ends
 *  returns               [1e-10,12.57] sr; the integral of hdrp_light_cone_attenuation
 *  edges                 those of hdrp_light_cone_shape_make; an inner angle above 3.12 makes the
 *                        result up to 4e-5 too large, and never more than 4 pi
 *  error                 <= 4.8e-7 relative against quadrature  @accuracy light_solid_angle_spot
 *  source                derived: the attenuation is a parabola in the cosine, whose integral over
 *                        the edge is a third of the edge */
HDRP_FN float hdrp_light_solid_angle_spot(float inner_half_angle_rad, float outer_half_angle_rad)
{
    hdrp_light_cone_shape c =
        hdrp_light_cone_shape_make(inner_half_angle_rad, outer_half_angle_rad);
    float versine = c.versine_outer - 0.666666667f / c.scale;
    return hdrp_min(HDRP_TWO_PI * versine, 4.0f * HDRP_PI);
}

/** Luminous intensity of a spot with a soft edge that emits a given flux.
 *  lumen                 [0,1e28]      luminous flux
 *  inner_half_angle_rad  [0,HDRP_PI]   up to which the intensity is full
 *  outer_half_angle_rad  [0,HDRP_PI]   at which the light ends
 *  returns               [0,FLT_MAX]   cd inside the inner angle
 *  edges                 those of hdrp_light_solid_angle_spot
 *  error                 <= 4.2e-7 relative against quadrature  @accuracy light_candela_spot
 *  source                derived, see hdrp_light_solid_angle_spot
 *  note                  hdrp_light_candela_from_lumen_spot_reflector, as published, ignores the
 *                        edge, so that a soft spot emits less than it was given */
HDRP_FN float hdrp_light_candela_from_lumen_spot(float lumen, float inner_half_angle_rad,
                                                 float outer_half_angle_rad)
{
    return lumen / hdrp_light_solid_angle_spot(inner_half_angle_rad, outer_half_angle_rad);
}

/** Flux of a spot with a soft edge.
 *  candela               [0,2.7e37]   luminous intensity inside the inner angle
 *  inner_half_angle_rad  [0,HDRP_PI]  up to which the intensity is full
 *  outer_half_angle_rad  [0,HDRP_PI]  at which the light ends
 *  returns               [0,3.4e38]   lm
 *  edges                 those of hdrp_light_solid_angle_spot
 *  error                 <= 4.7e-7 relative against quadrature  @accuracy light_lumen_spot
 *  source                derived, see hdrp_light_solid_angle_spot */
HDRP_FN float hdrp_light_lumen_from_candela_spot(float candela, float inner_half_angle_rad,
                                                 float outer_half_angle_rad)
{
    return candela * hdrp_light_solid_angle_spot(inner_half_angle_rad, outer_half_angle_rad);
}

/* A pyramid of light in the form that hdrp_light_pyramid_attenuation reads. Made by
 * hdrp_light_pyramid_shape_make. */
struct hdrp_light_pyramid_shape {
    float cos_x;   /* [0,1] cosine of the half angle between the left and the right face */
    float sin_x;   /* [9.9e-6,1] */
    float cos_y;   /* [0,1] likewise between the lower and the upper face */
    float sin_y;   /* [9.9e-6,1] */
    float scale_x; /* [0.99,1.1e9] 1 over the sine of the angle across the edge */
    float scale_y; /* [0.99,1.1e9] */
};
HDRP_TYPEDEF(hdrp_light_pyramid_shape)

/** The pyramid between four faces, to be computed once per light.
 *  half_angle_x_rad  [0,HDRP_HALF_PI]  from the axis to the right face
 *  half_angle_y_rad  [0,HDRP_HALF_PI]  from the axis to the upper face
 *  edge              [0,1]             share of the half angles over which light fades inwards; 0
 *                                      is a hard edge, 1 fades from the axis on
 *  returns           valid
 *  edges             an angle below HDRP_LIGHT_HALF_ANGLE_MIN or NaN counts as that; an edge is at
 *                    least HDRP_LIGHT_EDGE_MIN wide and never reaches beyond the faces
 *  error             <= 1.6e-7 relative, of the sines and cosines  @accuracy light_pyramid_shape
 *  source            derived: sin(half angle - a) is the distance of the direction at angle a from
 *                    the face */
HDRP_FN hdrp_light_pyramid_shape hdrp_light_pyramid_shape_make(float half_angle_x_rad,
                                                               float half_angle_y_rad, float edge)
{
    hdrp_light_pyramid_shape p;
    float x = hdrp_clamp(half_angle_x_rad, HDRP_LIGHT_HALF_ANGLE_MIN, HDRP_HALF_PI);
    float y = hdrp_clamp(half_angle_y_rad, HDRP_LIGHT_HALF_ANGLE_MIN, HDRP_HALF_PI);
    float share = hdrp_clamp(edge, HDRP_LIGHT_EDGE_MIN, 1.0f);
    p.cos_x = hdrp_i_light_cos(x);
    p.sin_x = hdrp_i_light_sin(x);
    p.cos_y = hdrp_i_light_cos(y);
    p.sin_y = hdrp_i_light_sin(y);
    p.scale_x = 1.0f / hdrp_i_light_sin(share * x);
    p.scale_y = 1.0f / hdrp_i_light_sin(share * y);
    return p;
}

/** Share of a pyramid spot's intensity that leaves in a direction.
 *  direction  unit   in the light's frame: x along right, y along up, z along forward
 *  pyramid    valid  from hdrp_light_pyramid_shape_make
 *  returns    [0,1]
 *  edges      0 on the faces, with slope 0, and outside them; 1 where the edge is over
 *  error      <= 3.1e-6 absolute against double, for edges of at least 0.1 and half angles of at
 *             least 1 degree  @accuracy light_pyramid_attenuation
 *  source     derived: the curve of a cone, by the distance to each pair of faces */
HDRP_FN float hdrp_light_pyramid_attenuation(hdrp_v3 direction, hdrp_light_pyramid_shape pyramid)
{
    float x = direction.z * pyramid.sin_x - hdrp_abs(direction.x) * pyramid.cos_x;
    float y = direction.z * pyramid.sin_y - hdrp_abs(direction.y) * pyramid.cos_y;
    return hdrp_sq(hdrp_saturate(x * pyramid.scale_x) * hdrp_saturate(y * pyramid.scale_y));
}

/** Share of a box projector's light that reaches a place: parallel rays inside a box.
 *  place          [-4e18,4e18]  m, in the light's frame: x along right, y along up, z along forward
 *                               from the face that emits
 *  half_width_m   [0,1e18]      of the box along x
 *  half_height_m  [0,1e18]      of the box along y
 *  depth_m        [0,1e18]      of the box along z
 *  inv_edge_m     [0,1e10]      1/m: 1 over the width of the border that fades inwards
 *  returns        [0,1]
 *  edges          0 outside, before the emitting face, and on the other five faces, with slope 0
 *                 there; 1 where the border is over. A box narrower than two borders stays below 1
 *  error          <= 3.5e-7 absolute against double, for borders of at least 0.1 of the smallest
 *                 size  @accuracy light_box_attenuation
 *  source         derived: the curve of a cone, by the distance to each face */
HDRP_FN float hdrp_light_box_attenuation(hdrp_v3 place, float half_width_m, float half_height_m,
                                         float depth_m, float inv_edge_m)
{
    float x = hdrp_saturate((half_width_m - hdrp_abs(place.x)) * inv_edge_m);
    float y = hdrp_saturate((half_height_m - hdrp_abs(place.y)) * inv_edge_m);
    float z = hdrp_saturate((depth_m - place.z) * inv_edge_m);
    return place.z >= 0.0f ? hdrp_sq(x * y * z) : 0.0f;
}

/* >>light record
 * The layout that C, std430 and structured buffers share. Offsets in bytes:
 *
 *       0  position_range      xyz  position [m], in whatever frame the caller shades in
 *                              w    range [m] at which the light ends; a box: its depth
 *      16  color_inv_range_sq  rgb  candela, lux or nits by type; intensity times colour
 *                              w    hdrp_light_inv_range_sq of the range
 *      32  right_half_width    xyz  unit axis
 *                              w    half size along it [m]: box, rectangle, line (half its length)
 *      48  up_half_height      xyz  unit axis
 *                              w    half size along it [m]: box, rectangle
 *      64  forward_radius      xyz  unit axis along which the light shines
 *                              w    size of the source, for soft shadows: radius [m] of a lamp,
 *                                   sphere or disc; angular diameter [rad] of a directional light
 *      80  half_angle          xyzw cos and sin of the half angle across x, then across y, of all
 *                              the light there is: what bounds need. A cone repeats its own, which
 *                              is rounded up; that of a pyramid is good to 3e-7 rad; a point light
 *                              has -1 0 -1 0, parallel light 1 0 1 0
 *      96  edge_importance     x    cone: versine_outer; pyramid: scale_x; box: 1/m, 1 over border
 *                              y    cone: scale; pyramid: scale_y
 *                              z    0, reserved
 *                              w    importance: what lists keep first when they are full
 *     112  bits                x    HDRP_LIGHT_TYPE_... | HDRP_LIGHT_FEATURE_...
 *                              y    layers that the light affects, one bit each
 *                              z    shadow index, w cookie index: the caller's, no formula reads
 *                                   them; HDRP_LIGHT_INDEX_NONE where there is none
 *     128  the next record
 *
 * A change to it changes the layout version; a shader may compare the macro with the number that it
 * was compiled for. A record of zeros is HDRP_LIGHT_TYPE_NONE: dark, and safe to evaluate. */
#define HDRP_LIGHT_LAYOUT_VERSION   1u
#define HDRP_LIGHT_LAYOUT_SIZE      128u

#define HDRP_LIGHT_TYPE_NONE        0u
#define HDRP_LIGHT_TYPE_DIRECTIONAL 1u
#define HDRP_LIGHT_TYPE_POINT       2u
#define HDRP_LIGHT_TYPE_SPOT        3u /* a cone */
#define HDRP_LIGHT_TYPE_PYRAMID     4u /* a spot with four faces */
#define HDRP_LIGHT_TYPE_BOX         5u /* parallel rays inside a box */
/* Area lights: records may carry them, evaluation here finds them dark. See hdrp_area.h. */
#define HDRP_LIGHT_TYPE_SPHERE    6u
#define HDRP_LIGHT_TYPE_DISC      7u
#define HDRP_LIGHT_TYPE_RECTANGLE 8u
#define HDRP_LIGHT_TYPE_LINE      9u
#define HDRP_LIGHT_TYPE_MASK      255u

/* For the caller's own code: a maker sets neither. */
#define HDRP_LIGHT_FEATURE_SHADOW 256u /* the shadow index counts */
#define HDRP_LIGHT_FEATURE_COOKIE 512u /* the cookie index counts */
/* The light takes light away: hdrp_light_sign. */
#define HDRP_LIGHT_FEATURE_NEGATIVE 1024u

#define HDRP_LIGHT_LAYERS_ALL       0xffffffffu
#define HDRP_LIGHT_INDEX_NONE       0xffffffffu
/* Brightest colour of a record: the lux of any light at any distance stay below FLT_MAX. */
#define HDRP_LIGHT_COLOR_MAX 1e30f

/* Made by hdrp_light_directional, hdrp_light_point, hdrp_light_spot, hdrp_light_pyramid and
 * hdrp_light_box. */
struct hdrp_light {
    hdrp_v4 position_range;     /* xyz [-1e18,1e18], w [0,1e18] */
    hdrp_v4 color_inv_range_sq; /* xyz [0,HDRP_LIGHT_COLOR_MAX], w [0,1.1e12] */
    hdrp_v4 right_half_width;   /* xyz unit, w [0,1e18] */
    hdrp_v4 up_half_height;     /* xyz unit, w [0,1e18] */
    hdrp_v4 forward_radius;     /* xyz unit, w [0,1e18] */
    hdrp_v4 half_angle;         /* [-1,1] */
    hdrp_v4 edge_importance;    /* xy [0,2.1e14], z [0,0], w [0,HDRP_LIGHT_COLOR_MAX] */
    hdrp_u32x4 bits;            /* any */
};
HDRP_TYPEDEF(hdrp_light)

#ifndef HDRP_GPU
/* The array has a negative size, which is an error in every C and C++, where an offset is wrong. */
#define HDRP_I_LIGHT_OFFSET(member, offset)                                                        \
    typedef char hdrp_i_light_##member[offsetof(hdrp_light, member) == (offset) ? 1 : -1];
HDRP_I_LIGHT_OFFSET(position_range, 0)
HDRP_I_LIGHT_OFFSET(color_inv_range_sq, 16)
HDRP_I_LIGHT_OFFSET(right_half_width, 32)
HDRP_I_LIGHT_OFFSET(up_half_height, 48)
HDRP_I_LIGHT_OFFSET(forward_radius, 64)
HDRP_I_LIGHT_OFFSET(half_angle, 80)
HDRP_I_LIGHT_OFFSET(edge_importance, 96)
HDRP_I_LIGHT_OFFSET(bits, 112)
typedef char hdrp_i_light_size_of[sizeof(hdrp_light) == HDRP_LIGHT_LAYOUT_SIZE ? 1 : -1];
#undef HDRP_I_LIGHT_OFFSET
#endif

/** The type of a light.
 *  light    any
 *  returns  [0,255]  HDRP_LIGHT_TYPE_...
 *  edges    none
 *  error    none: a selection of bits
 *  source   a definition */
HDRP_FN hdrp_u32 hdrp_light_type(hdrp_light light)
{
    return light.bits.x & HDRP_LIGHT_TYPE_MASK;
}

/** Whether a light affects a surface: light layers, also called light linking.
 *  light    any
 *  layers   any    of the surface, one bit each
 *  returns  [0,1]  1 where they share a layer
 *  edges    a surface on no layer is never lit
 *  error    none: a selection of bits
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slides on light layers */
HDRP_FN hdrp_u32 hdrp_light_affects(hdrp_light light, hdrp_u32 layers)
{
    return (light.bits.y & layers) != 0u ? 1u : 0u;
}

/** The sign with which a light counts: artists darken corners with lights that take light away.
 *  light    any
 *  returns  [-1,1]  -1 for a light with HDRP_LIGHT_FEATURE_NEGATIVE, else 1
 *  edges    none
 *  error    none: a selection of bits
 *  source   Kircher 2018, "Rendering Technology in Agents of Mayhem", slides on lighting compute
 *  note     the sum over all lights may be negative: limit it to 0, after the last light and before
 *           exposure. Limits within the sum would make it depend on the order of the lights.
 *           Culling and attenuation are those of any light, and a colour stays positive */
HDRP_FN float hdrp_light_sign(hdrp_light light)
{
    return (light.bits.x & HDRP_LIGHT_FEATURE_NEGATIVE) != 0u ? -1.0f : 1.0f;
}

/* 1 where x is a usable coordinate. */
HDRP_FN float hdrp_i_light_usable(float x)
{
    return hdrp_abs(x) <= HDRP_LIGHT_POSITION_MAX ? 1.0f : 0.0f;
}

/* Everything that the makers share: limits, the frame, and neutral values for the rest. */
HDRP_FN hdrp_light hdrp_i_light_make(hdrp_u32 type, hdrp_v3 position, hdrp_v3 forward, hdrp_v3 up,
                                     hdrp_v3 color, float range_m)
{
    hdrp_light r;
    hdrp_v3 f = hdrp_normalize_or(forward, hdrp_v3_make(0.0f, -1.0f, 0.0f));
    hdrp_basis basis = hdrp_basis_from_normal(hdrp_v3_neg(f));
    hdrp_v3 x = hdrp_v3_cross(f, hdrp_normalize_or(up, f));
    float range_limited = hdrp_clamp(range_m, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    float usable = hdrp_i_light_usable(position.x) * hdrp_i_light_usable(position.y) *
                   hdrp_i_light_usable(position.z);
    float color_max = usable > 0.0f && range_limited > 0.0f ? HDRP_LIGHT_COLOR_MAX : 0.0f;
    /* Below 1e-3 up is forward up to rounding, and x is noise. */
    if (hdrp_v3_dot(x, x) < 1e-6f) {
        x = basis.tangent;
    }
    x = hdrp_v3_normalize(x);
    /* Where up is nearly along f, rounding leaves x askew: by up to 4e-5. */
    x = hdrp_v3_normalize(hdrp_v3_mad(x, f, -hdrp_v3_dot(x, f)));
    if (usable < 1.0f) {
        position = hdrp_v3_splat(0.0f);
    }
    r.color_inv_range_sq =
        hdrp_v4_make(hdrp_clamp(color.x, 0.0f, color_max), hdrp_clamp(color.y, 0.0f, color_max),
                     hdrp_clamp(color.z, 0.0f, color_max), hdrp_light_inv_range_sq(range_limited));
    r.position_range = hdrp_v4_from_v3(position, range_limited);
    r.right_half_width = hdrp_v4_from_v3(x, 0.0f);
    r.up_half_height = hdrp_v4_from_v3(hdrp_v3_cross(x, f), 0.0f);
    r.forward_radius = hdrp_v4_from_v3(f, 0.0f);
    r.half_angle = hdrp_v4_make(-1.0f, 0.0f, -1.0f, 0.0f);
    r.edge_importance = hdrp_v4_make(0.0f, 0.0f, 0.0f,
                                     hdrp_v3_max_component(hdrp_v3_from_v4(r.color_inv_range_sq)));
    r.bits =
        hdrp_u32x4_make(type, HDRP_LIGHT_LAYERS_ALL, HDRP_LIGHT_INDEX_NONE, HDRP_LIGHT_INDEX_NONE);
    return r;
}

/** A directional light, such as the sun.
 *  forward               any  direction of travel, away from the sun; any length
 *  color_lux             any  illuminance of a surface that faces the light
 *  angular_diameter_rad  any  of the disc, for soft shadows and reflections; 0 is a sharp sun
 *  returns               valid
 *  edges                 without a direction it shines down; negative or NaN colour becomes 0,
 *                        colour above HDRP_LIGHT_COLOR_MAX that; the diameter is limited to [0, pi]
 *  error                 none: limits
 *  source                Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based
 *                        Rendering", section on the sun */
HDRP_FN hdrp_light hdrp_light_directional(hdrp_v3 forward, hdrp_v3 color_lux,
                                          float angular_diameter_rad)
{
    hdrp_v3 none = hdrp_v3_splat(0.0f);
    hdrp_light r = hdrp_i_light_make(HDRP_LIGHT_TYPE_DIRECTIONAL, none, forward, none, color_lux,
                                     HDRP_LIGHT_RANGE_INFINITE);
    r.forward_radius.w = hdrp_clamp(angular_diameter_rad, 0.0f, HDRP_PI);
    r.half_angle = hdrp_v4_make(1.0f, 0.0f, 1.0f, 0.0f);
    return r;
}

/** A point light.
 *  position       any  m
 *  color_candela  any  luminous intensity
 *  range_m        any  distance at which the light ends; HDRP_LIGHT_RANGE_INFINITE or more: never
 *  returns        valid
 *  edges          dark where the position is NaN or beyond HDRP_LIGHT_POSITION_MAX and where the
 *                 range is 0, negative or NaN; negative or NaN colour becomes 0, colour above
 *                 HDRP_LIGHT_COLOR_MAX that
 *  error          none: limits
 *  source         Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
 *                 section on punctual lights */
HDRP_FN hdrp_light hdrp_light_point(hdrp_v3 position, hdrp_v3 color_candela, float range_m)
{
    hdrp_v3 none = hdrp_v3_splat(0.0f);
    return hdrp_i_light_make(HDRP_LIGHT_TYPE_POINT, position, none, none, color_candela, range_m);
}

/* What a versine may be too small by, relative, and a direction, in radians. */
#define HDRP_I_LIGHT_BOUND_VERSINE 1e-6f
#define HDRP_I_LIGHT_BOUND_RAD     2e-7f

/** A spot: a cone of light with a soft edge.
 *  position              any  m
 *  forward               any  direction in which it shines; any length
 *  color_candela         any  luminous intensity inside the inner angle
 *  range_m               any  distance at which the light ends
 *  inner_half_angle_rad  any  up to which the intensity is full
 *  outer_half_angle_rad  any  at which the light ends
 *  returns               valid
 *  edges                 those of hdrp_light_point and of hdrp_light_cone_shape_make; without a
 *                        direction it shines down
 *  error                 none: limits, and hdrp_light_cone_shape_make
 *  source                Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based
 *                        Rendering", section on punctual lights */
HDRP_FN hdrp_light hdrp_light_spot(hdrp_v3 position, hdrp_v3 forward, hdrp_v3 color_candela,
                                   float range_m, float inner_half_angle_rad,
                                   float outer_half_angle_rad)
{
    hdrp_light r = hdrp_i_light_make(HDRP_LIGHT_TYPE_SPOT, position, forward, hdrp_v3_splat(0.0f),
                                     color_candela, range_m);
    hdrp_light_cone_shape c =
        hdrp_light_cone_shape_make(inner_half_angle_rad, outer_half_angle_rad);
    float outer = hdrp_min(c.versine_outer, 2.0f);
    /* Directions and their versines are rounded: so much further out there may be light. */
    float versine = hdrp_min(outer * (1.0f + HDRP_I_LIGHT_BOUND_VERSINE) +
                                 HDRP_I_LIGHT_BOUND_RAD * hdrp_sqrt(outer * (2.0f - outer)),
                             2.0f);
    float cosine = 1.0f - versine;
    float sine = hdrp_sqrt(versine * (2.0f - versine));
    r.half_angle = hdrp_v4_make(cosine, sine, cosine, sine);
    r.edge_importance.x = c.versine_outer;
    r.edge_importance.y = c.scale;
    return r;
}

/** A pyramid spot: light between four faces that meet in a point.
 *  position          any  m
 *  forward           any  direction in which it shines; any length
 *  up                any  roughly towards the upper face; any length, need not be orthogonal
 *  color_candela     any  luminous intensity inside the edges
 *  range_m           any  distance at which the light ends
 *  half_angle_x_rad  any  from the axis to the right face
 *  half_angle_y_rad  any  from the axis to the upper face
 *  edge              any  share of the half angles over which light fades
 *  returns           valid
 *  edges             those of hdrp_light_point and of hdrp_light_pyramid_shape_make; without a
 *                    direction it shines down; an up along forward gives an arbitrary one
 *  error             none: limits, and hdrp_light_pyramid_shape_make
 *  source            Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *                    Definition Render Pipeline", slides on lights */
HDRP_FN hdrp_light hdrp_light_pyramid(hdrp_v3 position, hdrp_v3 forward, hdrp_v3 up,
                                      hdrp_v3 color_candela, float range_m, float half_angle_x_rad,
                                      float half_angle_y_rad, float edge)
{
    hdrp_light r =
        hdrp_i_light_make(HDRP_LIGHT_TYPE_PYRAMID, position, forward, up, color_candela, range_m);
    hdrp_light_pyramid_shape p =
        hdrp_light_pyramid_shape_make(half_angle_x_rad, half_angle_y_rad, edge);
    r.half_angle = hdrp_v4_make(p.cos_x, p.sin_x, p.cos_y, p.sin_y);
    r.edge_importance.x = p.scale_x;
    r.edge_importance.y = p.scale_y;
    return r;
}

/** A box projector: parallel rays of constant illuminance inside a box.
 *  position       any  m, the centre of the face that emits
 *  forward        any  direction of the rays; any length
 *  up             any  roughly along the height; any length, need not be orthogonal
 *  color_lux      any  illuminance of a surface that faces the light
 *  half_width_m   any  of the box
 *  half_height_m  any  of the box
 *  depth_m        any  of the box along the rays
 *  edge_m         any  width of the border over which light fades, on all faces but the first
 *  returns        valid
 *  edges          dark where the position is NaN or beyond HDRP_LIGHT_POSITION_MAX and where a size
 *                 is 0, negative or NaN; sizes are limited to 1e18, the border to the smallest
 *                 size; the rest as for hdrp_light_pyramid
 *  error          none: limits
 *  source         Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *                 Definition Render Pipeline", slides on lights */
HDRP_FN hdrp_light hdrp_light_box(hdrp_v3 position, hdrp_v3 forward, hdrp_v3 up, hdrp_v3 color_lux,
                                  float half_width_m, float half_height_m, float depth_m,
                                  float edge_m)
{
    hdrp_light r =
        hdrp_i_light_make(HDRP_LIGHT_TYPE_BOX, position, forward, up, color_lux, depth_m);
    float smallest_m;
    r.right_half_width.w = hdrp_clamp(half_width_m, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    r.up_half_height.w = hdrp_clamp(half_height_m, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    smallest_m = hdrp_min(hdrp_min(r.right_half_width.w, r.up_half_height.w), r.position_range.w);
    smallest_m = hdrp_i_light_size(smallest_m);
    r.half_angle = hdrp_v4_make(1.0f, 0.0f, 1.0f, 0.0f);
    r.edge_importance.x = 1.0f / hdrp_clamp(edge_m, HDRP_LIGHT_EDGE_MIN * smallest_m, smallest_m);
    return r;
}

/* >>evaluation
 * The body of every light loop. Luminance towards the viewer is the sum over lights of
 * illuminance * BRDF * n_dot_l, with the 1/pi of a diffuse BRDF inside the BRDF. */

struct hdrp_light_incident {
    hdrp_v3 l;           /* unit, from the surface towards the light */
    float distance_m;    /* [0,HDRP_LIGHT_DISTANCE_INFINITE] length of a shadow ray along l */
    hdrp_v3 illuminance; /* [0,1.1e34] lux on a surface that faces the light, unshadowed */
};
HDRP_TYPEDEF(hdrp_light_incident)

/* Squared distances below this, in m^2, have lost digits to underflow: no direction. */
#define HDRP_LIGHT_COINCIDENT_SQ 1e-30f

/** Light of a directional light.
 *  light    valid  of type HDRP_LIGHT_TYPE_DIRECTIONAL
 *  returns  valid  the same everywhere; distance_m is HDRP_LIGHT_DISTANCE_INFINITE
 *  edges    none
 *  error    none: a selection
 *  source   a definition */
HDRP_FN hdrp_light_incident hdrp_light_eval_directional(hdrp_light light)
{
    hdrp_light_incident r;
    r.l = hdrp_v3_neg(hdrp_v3_from_v4(light.forward_radius));
    r.distance_m = HDRP_LIGHT_DISTANCE_INFINITE;
    r.illuminance = hdrp_v3_from_v4(light.color_inv_range_sq);
    return r;
}

/** Light of a point light at a place.
 *  light     valid         of type HDRP_LIGHT_TYPE_POINT
 *  position  [-1e18,1e18]  m
 *  returns   valid
 *  edges     at the light's own position l is against its forward axis and the illuminance that of
 *            HDRP_LIGHT_DISTANCE_MIN_M; black at the range and beyond
 *  error     <= 5.1e-7 absolute, as a share of candela / d^2  @accuracy light_eval_point
 *  error     <= 1.8e-7 absolute, per component of l  @accuracy light_eval_direction
 *  source    see hdrp_light_falloff */
HDRP_FN hdrp_light_incident hdrp_light_eval_point(hdrp_light light, hdrp_v3 position)
{
    hdrp_light_incident r;
    hdrp_v3 d = hdrp_v3_sub(hdrp_v3_from_v4(light.position_range), position);
    float distance_sq = hdrp_v3_dot(d, d);
    r.distance_m = hdrp_sqrt(distance_sq);
    r.l = hdrp_v3_scale(d, 1.0f / hdrp_max(r.distance_m, HDRP_FLT_MIN));
    if (distance_sq < HDRP_LIGHT_COINCIDENT_SQ) {
        r.l = hdrp_v3_neg(hdrp_v3_from_v4(light.forward_radius));
    }
    r.illuminance = hdrp_v3_scale(hdrp_v3_from_v4(light.color_inv_range_sq),
                                  hdrp_light_falloff(distance_sq, light.color_inv_range_sq.w));
    return r;
}

/** Light of a spot at a place.
 *  light     valid         of type HDRP_LIGHT_TYPE_SPOT
 *  position  [-1e18,1e18]  m
 *  returns   valid
 *  edges     those of hdrp_light_eval_point; black outside the cone; its own position is inside
 *  error     <= 5.6e-6 absolute, as a share of candela / d^2, for outer half angles of at least 10
 *            degrees and edges as in hdrp_light_cone_attenuation  @accuracy light_eval_spot
 *  error     <= 4e-5 absolute, likewise from 1 degree on  @accuracy light_eval_spot_narrow
 *  source    see hdrp_light_cone_attenuation */
HDRP_FN hdrp_light_incident hdrp_light_eval_spot(hdrp_light light, hdrp_v3 position)
{
    hdrp_light_incident r = hdrp_light_eval_point(light, position);
    float versine = hdrp_light_versine(hdrp_v3_neg(r.l), hdrp_v3_from_v4(light.forward_radius));
    hdrp_light_cone_shape c;
    c.versine_outer = light.edge_importance.x;
    c.scale = light.edge_importance.y;
    r.illuminance = hdrp_v3_scale(r.illuminance, hdrp_light_cone_attenuation(versine, c));
    return r;
}

/** Light of a pyramid spot at a place.
 *  light     valid         of type HDRP_LIGHT_TYPE_PYRAMID
 *  position  [-1e18,1e18]  m
 *  returns   valid
 *  edges     those of hdrp_light_eval_point; black outside the faces; its own position is inside
 *  error     <= 6.4e-6 absolute, as a share of candela / d^2, for half angles of at least 10
 *            degrees and edges of at least 0.1  @accuracy light_eval_pyramid
 *  error     <= 3.9e-5 absolute, likewise from 1 degree on  @accuracy light_eval_pyramid_narrow
 *  source    see hdrp_light_pyramid_attenuation */
HDRP_FN hdrp_light_incident hdrp_light_eval_pyramid(hdrp_light light, hdrp_v3 position)
{
    hdrp_light_incident r = hdrp_light_eval_point(light, position);
    hdrp_light_pyramid_shape p;
    hdrp_v3 direction = hdrp_v3_make(-hdrp_v3_dot(r.l, hdrp_v3_from_v4(light.right_half_width)),
                                     -hdrp_v3_dot(r.l, hdrp_v3_from_v4(light.up_half_height)),
                                     -hdrp_v3_dot(r.l, hdrp_v3_from_v4(light.forward_radius)));
    p.cos_x = light.half_angle.x;
    p.sin_x = light.half_angle.y;
    p.cos_y = light.half_angle.z;
    p.sin_y = light.half_angle.w;
    p.scale_x = light.edge_importance.x;
    p.scale_y = light.edge_importance.y;
    r.illuminance = hdrp_v3_scale(r.illuminance, hdrp_light_pyramid_attenuation(direction, p));
    return r;
}

/** Light of a box projector at a place.
 *  light     valid         of type HDRP_LIGHT_TYPE_BOX
 *  position  [-1e18,1e18]  m
 *  returns   valid         distance_m is measured to the emitting face
 *  edges     black outside the box; distance_m is 0 before the emitting face
 *  error     <= 1.3e-5 absolute, as a share of the colour, for sizes within a factor of 10
 *            of each other and borders of at least 0.1 of the smallest  @accuracy light_eval_box
 *  source    see hdrp_light_box_attenuation */
HDRP_FN hdrp_light_incident hdrp_light_eval_box(hdrp_light light, hdrp_v3 position)
{
    hdrp_light_incident r;
    hdrp_v3 forward = hdrp_v3_from_v4(light.forward_radius);
    hdrp_v3 d = hdrp_v3_sub(position, hdrp_v3_from_v4(light.position_range));
    hdrp_v3 place = hdrp_v3_make(hdrp_v3_dot(d, hdrp_v3_from_v4(light.right_half_width)),
                                 hdrp_v3_dot(d, hdrp_v3_from_v4(light.up_half_height)),
                                 hdrp_v3_dot(d, forward));
    float share =
        hdrp_light_box_attenuation(place, light.right_half_width.w, light.up_half_height.w,
                                   light.position_range.w, light.edge_importance.x);
    r.l = hdrp_v3_neg(forward);
    r.distance_m = hdrp_max(place.z, 0.0f);
    r.illuminance = hdrp_v3_scale(hdrp_v3_from_v4(light.color_inv_range_sq), share);
    return r;
}

/** Light of any light at a place: direction, length of the shadow ray, illuminance.
 *  light     valid         from a maker, or a record of zeros
 *  position  [-1e18,1e18]  m, in the frame of the record
 *  returns   valid
 *  edges     those of the type; HDRP_LIGHT_TYPE_NONE, area lights and unknown types are black, with
 *            l upwards
 *  error     none: a selection of the functions above
 *  source    a definition
 *  note      a loop over lights of one type does without the choice by calling its function */
HDRP_FN hdrp_light_incident hdrp_light_eval(hdrp_light light, hdrp_v3 position)
{
    hdrp_light_incident r;
    hdrp_u32 type = hdrp_light_type(light);
    r.l = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    r.distance_m = 0.0f;
    r.illuminance = hdrp_v3_splat(0.0f);
    if (type == HDRP_LIGHT_TYPE_DIRECTIONAL) {
        r = hdrp_light_eval_directional(light);
    }
    if (type == HDRP_LIGHT_TYPE_POINT) {
        r = hdrp_light_eval_point(light, position);
    }
    if (type == HDRP_LIGHT_TYPE_SPOT) {
        r = hdrp_light_eval_spot(light, position);
    }
    if (type == HDRP_LIGHT_TYPE_PYRAMID) {
        r = hdrp_light_eval_pyramid(light, position);
    }
    if (type == HDRP_LIGHT_TYPE_BOX) {
        r = hdrp_light_eval_box(light, position);
    }
    return r;
}

/* hdrp_light_sine of lights that are not directional. */
HDRP_FN float hdrp_i_light_sine_near(hdrp_light light, hdrp_light_incident incident)
{
    float size = light.forward_radius.w;
    float sine = hdrp_min(size / hdrp_max(incident.distance_m, 1e-6f), 0.99f);
    return hdrp_light_type(light) == HDRP_LIGHT_TYPE_BOX || !(size > 0.0f) ? 0.0f : sine;
}

/** Sine of half the angle at which the source of a light is seen.
 *  light     valid
 *  incident  valid  of the light, at the place that sees it
 *  returns   [0,1]
 *  edges     0 where the light has no size and for boxes; from 0.99 on 0.99, but for directional
 *            lights
 *  error     none: a definition
 *  source    a ball of the radius of the record; a disc of its angle in the sky */
HDRP_FN float hdrp_light_sine(hdrp_light light, hdrp_light_incident incident)
{
    float half_angle = hdrp_clamp(0.5f * light.forward_radius.w, 0.0f, HDRP_HALF_PI);
    float sine = hdrp_i_light_sine_near(light, incident);
    return hdrp_light_type(light) == HDRP_LIGHT_TYPE_DIRECTIONAL ? hdrp_i_light_sin(half_angle)
                                                                 : sine;
}

/* hdrp_light_variance of a source that is seen under twice an angle of that sine. */
HDRP_FN float hdrp_i_light_variance_of_sine(float sine)
{
    return 0.5f * hdrp_sq(0.5f * sine);
}

/** Variance of normals that widens a highlight as the size of a source does.
 *  light     valid
 *  incident  valid  of the light, at the place that sees it
 *  returns   [0,0.125]  in units of alpha^2, for hdrp_brdf_lit_view_widened
 *  edges     those of hdrp_light_sine
 *  error     none: a model
 *  source    half vectors move by half the angle, so that their slopes are even over a disc of
 *            radius sine / 2, whose variance along an axis is a quarter of its square; alpha^2 is
 *            twice a variance */
HDRP_FN float hdrp_light_variance(hdrp_light light, hdrp_light_incident incident)
{
    return hdrp_i_light_variance_of_sine(hdrp_light_sine(light, incident));
}

#endif /* HDRP_LIGHT_H */
