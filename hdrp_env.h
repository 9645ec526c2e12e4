/* hdrp_env.h - lighting by an environment: GGX prefilter, irradiance, lookup.
 * SPDX-License-Identifier: MIT
 *
 * See hdrp_math.h for the languages, the conventions and the override macros, and hdrp_env_image.h,
 * which this header includes, for images of the sphere and their calibration. The formula layer
 * reads what was baked, in C and in shaders. The algorithm layer, C and C++ only, is compiled in
 * one source file:
 *
 *     #define HDRP_ENV_IMPLEMENTATION
 *     #include "hdrp_env.h"
 *
 * From an image to the light on a surface:
 *
 *     bytes = hdrp_env_memory_size(NULL);
 *     hdrp_env_init(&env, NULL, allocate(bytes), bytes);      alignment: HDRP_MEMORY_ALIGNMENT
 *     hdrp_env_bake(&env, &sky);
 *     mirror  = hdrp_env_specular(&env, reflected, perceptual_roughness);   nits
 *     diffuse = hdrp_env_irradiance(&env, normal);                          lux; times albedo / pi
 *
 * Jobs call hdrp_env_resample, hdrp_env_reduce, hdrp_env_prefilter and
 * hdrp_env_convolve_irradiance on disjoint ranges instead of hdrp_env_bake: one step after the
 * other, any split of a step, the same bits.
 *
 * The cubes are in the layout of hdrp_env_image.h, with the mip levels that a GPU samples: copy the
 * texels to a cube image, let the sampler filter (seamlessly), and take the level of the specular
 * cube from hdrp_env_lod_from_perceptual_roughness.
 *
 * >>index of the functions, without hdrp_env_ (written by tools/api_check.py --write)
 *   levels of roughness: lod_from_perceptual_roughness perceptual_roughness_from_lod
 *   spherical harmonics: irradiance_fast sh_windowed
 *   baking: memory_size init resample reduce specular_rows prefilter convolve_irradiance bake
 *       project_sh cube_image
 *   lookup: cube_lookup radiance specular irradiance
 * >>end */
#ifndef HDRP_ENV_H
#define HDRP_ENV_H

#include "hdrp_env_image.h"

#if HDRP_VERSION != 100
#error "hdrp_env.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* >>levels of roughness */

/* How fast roughness falls from level to level of a prefiltered cube: the slope of the level over
 * perceptual roughness at 0, less 1. 0 spaces the levels evenly; more spends them on smooth
 * surfaces, whose reflections change fastest. hdrp_env_specular measured best with 0.4 to 0.6. */
#define HDRP_ENV_LOD_CURVE 0.5f

/** Level of a prefiltered cube that holds a roughness, for trilinear lookup.
 *  perceptual_roughness  [0,1]
 *  level_count           [1,32]  of the cube
 *  returns               [0,31]  0 is a mirror, level_count - 1 is perceptual_roughness 1
 *  edges                 limited to [0,1], NaN counts as 0; always 0 where there is one level
 *  error                 <= 4 ulp  @accuracy env_lod
 *  source                a quadratic; see HDRP_ENV_LOD_CURVE */
HDRP_FN float hdrp_env_lod_from_perceptual_roughness(float perceptual_roughness,
                                                     hdrp_u32 level_count)
{
    float r = hdrp_saturate(perceptual_roughness);
    float last = hdrp_f32_from_u32(level_count) - 1.0f;
    return last * (r * (1.0f + HDRP_ENV_LOD_CURVE * (1.0f - r)));
}

/** Roughness that a level of a prefiltered cube holds; inverse of
 *  hdrp_env_lod_from_perceptual_roughness.
 *  lod          [0,31]  limited to the levels there are
 *  level_count  [1,32]  of the cube
 *  returns      [0,1]   perceptual roughness
 *  edges        exactly 0 at level 0 and 1 at the last level; NaN counts as level 0
 *  error        <= 3e-7 relative  @accuracy env_perceptual_roughness
 *  source       the smaller root of the quadratic, in the form that does not cancel */
HDRP_FN float hdrp_env_perceptual_roughness_from_lod(float lod, hdrp_u32 level_count)
{
    float last = hdrp_max(hdrp_f32_from_u32(level_count) - 1.0f, 1.0f);
    float t = hdrp_saturate(lod / last);
    float b = 1.0f + HDRP_ENV_LOD_CURVE;
    float root = hdrp_sqrt(b * b - 4.0f * HDRP_ENV_LOD_CURVE * t);
    return hdrp_min(2.0f * t / (b + root), 1.0f);
}

/* >>spherical harmonics */

/* The layout of hdrp_env_sh that C, std140, std430 and structured buffers share: nine vec4 in the
 * order of the members. A change to it, or to what a coefficient means, changes the version; a
 * shader may compare the macro with the number that it was compiled for. */
#define HDRP_ENV_SH_LAYOUT_VERSION 1u
#define HDRP_ENV_SH_LAYOUT_SIZE    144u

/* Irradiance as a quadratic polynomial of the normal, per channel in xyz; w is 0. The
 * coefficients include every constant. */
struct hdrp_env_sh {
    hdrp_v4 mean; /* [-1e22,1e22] */
    hdrp_v4 x;    /* [-1e22,1e22] */
    hdrp_v4 y;    /* [-1e22,1e22] */
    hdrp_v4 z;    /* [-1e22,1e22] */
    hdrp_v4 xy;   /* [-1e22,1e22] */
    hdrp_v4 yz;   /* [-1e22,1e22] */
    hdrp_v4 xz;   /* [-1e22,1e22] */
    hdrp_v4 zz;   /* [-1e22,1e22] of 3 z^2 - 1 */
    hdrp_v4 xx;   /* [-1e22,1e22] of x^2 - y^2 */
};
HDRP_TYPEDEF(hdrp_env_sh)

/** Irradiance from spherical harmonics of order 2.
 *  sh       valid  from hdrp_env_project_sh
 *  normal   unit
 *  returns  [0,inf)  [lux], per channel
 *  edges    the polynomial undershoots opposite a small bright source: negative values become 0
 *  error    <= 1e-1 relative to the largest irradiance, a lone sun, which is the worst case
 *           @accuracy env_irradiance_fast_sun
 *  error    <= 5e-7 relative where radiance is linear in direction  @accuracy env_irradiance_fast
 *  source   Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment
 *           Maps", eq. 13 */
HDRP_FN hdrp_v3 hdrp_env_irradiance_fast(hdrp_env_sh sh, hdrp_v3 normal)
{
    hdrp_v3 e = hdrp_v3_from_v4(sh.mean);
    e = hdrp_v3_mad(e, hdrp_v3_from_v4(sh.x), normal.x);
    e = hdrp_v3_mad(e, hdrp_v3_from_v4(sh.y), normal.y);
    e = hdrp_v3_mad(e, hdrp_v3_from_v4(sh.z), normal.z);
    e = hdrp_v3_mad(e, hdrp_v3_from_v4(sh.xy), normal.x * normal.y);
    e = hdrp_v3_mad(e, hdrp_v3_from_v4(sh.yz), normal.y * normal.z);
    e = hdrp_v3_mad(e, hdrp_v3_from_v4(sh.xz), normal.x * normal.z);
    e = hdrp_v3_mad(e, hdrp_v3_from_v4(sh.zz), 3.0f * normal.z * normal.z - 1.0f);
    e = hdrp_v3_mad(e, hdrp_v3_from_v4(sh.xx), normal.x * normal.x - normal.y * normal.y);
    return hdrp_v3_max(e, 0.0f);
}

/* c times s, all four components. */
HDRP_FN hdrp_v4 hdrp_i_env_scaled(hdrp_v4 c, float s)
{
    return hdrp_v4_make(c.x * s, c.y * s, c.z * s, c.w * s);
}

/** The same spherical harmonics with less ringing: the choice with the least curvature.
 *  sh       valid
 *  lambda   [0,1e6]  0 leaves sh as it is; 0.18 keeps even a lone sun positive everywhere, at the
 *                    price of half its contrast
 *  returns  valid
 *  edges    the mean irradiance stays; a large lambda leaves nothing else
 *  error    <= 3e-7 relative  @accuracy env_sh_windowed
 *  source   Sloan 2008, "Stupid Spherical Harmonics (SH) Tricks", windowing by the squared
 *           Laplacian: 1 / (1 + lambda l^2 (l + 1)^2) */
HDRP_FN hdrp_env_sh hdrp_env_sh_windowed(hdrp_env_sh sh, float lambda)
{
    float order1 = 1.0f / (1.0f + 4.0f * lambda);
    float order2 = 1.0f / (1.0f + 36.0f * lambda);
    hdrp_env_sh r;
    r.mean = sh.mean;
    r.x = hdrp_i_env_scaled(sh.x, order1);
    r.y = hdrp_i_env_scaled(sh.y, order1);
    r.z = hdrp_i_env_scaled(sh.z, order1);
    r.xy = hdrp_i_env_scaled(sh.xy, order2);
    r.yz = hdrp_i_env_scaled(sh.yz, order2);
    r.xz = hdrp_i_env_scaled(sh.xz, order2);
    r.zz = hdrp_i_env_scaled(sh.zz, order2);
    r.xx = hdrp_i_env_scaled(sh.xx, order2);
    return r;
}

/* >>parts of the sky
 * What baking sums far lights by, in C and in shaders. */

/* Where in a part of the sky something is: its mean direction, which is shorter than 1, and the
 * variances and covariances around it. */
struct hdrp_env_spread {
    hdrp_v3 mean; /* [-1,1] */
    float xx;     /* [0,1] */
    float yy;     /* [0,1] */
    float zz;     /* [0,1] */
    float xy;     /* [-1,1] */
    float yz;     /* [-1,1] */
    float xz;     /* [-1,1] */
};
HDRP_TYPEDEF(hdrp_env_spread)

/* A part of the sky: a texel of a level of the radiance cube. */
struct hdrp_env_node {
    hdrp_env_spread light; /* of what it emits, the channels added up */
    hdrp_env_spread area;  /* of its area */
    hdrp_v3 red;           /* [-2,2] mean directions of the channels, less light.mean */
    hdrp_v3 green;         /* [-2,2] */
    hdrp_v3 blue;          /* [-2,2] */
};
HDRP_TYPEDEF(hdrp_env_node)

HDRP_FN hdrp_v3 hdrp_i_env_texel_centre(hdrp_u32 face, hdrp_u32 x, hdrp_u32 y, hdrp_u32 size)
{
    hdrp_env_place place;
    place.face = face;
    place.u = (hdrp_f32_from_u32(x) + 0.5f) / hdrp_f32_from_u32(size);
    place.v = (hdrp_f32_from_u32(y) + 0.5f) / hdrp_f32_from_u32(size);
    return hdrp_env_direction_from_cube(place);
}

HDRP_FN hdrp_env_spread hdrp_i_env_spread_splat(float s)
{
    hdrp_env_spread r;
    r.mean = hdrp_v3_splat(s);
    r.xx = s;
    r.yy = s;
    r.zz = s;
    r.xy = s;
    r.yz = s;
    r.xz = s;
    return r;
}

HDRP_FN hdrp_env_node hdrp_i_env_node_make(hdrp_env_spread spread)
{
    hdrp_env_node n;
    n.light = spread;
    n.area = spread;
    n.red = hdrp_v3_splat(0.0f);
    n.green = n.red;
    n.blue = n.red;
    return n;
}

/* A square of side s has the variance s^2 / 12 along both axes at right angles to its direction. */
HDRP_FN hdrp_env_spread hdrp_i_env_square(hdrp_v3 c, float solid_angle)
{
    float variance = solid_angle * (1.0f / 12.0f);
    hdrp_env_spread r;
    r.mean = c;
    r.xx = variance * (1.0f - c.x * c.x);
    r.yy = variance * (1.0f - c.y * c.y);
    r.zz = variance * (1.0f - c.z * c.z);
    r.xy = -variance * c.x * c.y;
    r.yz = -variance * c.y * c.z;
    r.xz = -variance * c.x * c.z;
    return r;
}

/* What lies under a texel of level 0, whose light is spread evenly. */
HDRP_FN hdrp_env_node hdrp_i_env_leaf(hdrp_u32 face, hdrp_u32 x, hdrp_u32 y, hdrp_u32 size,
                                      float solid_angle)
{
    float k = 2.0f / hdrp_f32_from_u32(size);
    hdrp_v3 c = hdrp_v3_normalize(hdrp_env_point_from_cube(
        face, (hdrp_f32_from_u32(x) + 0.5f) * k - 1.0f, (hdrp_f32_from_u32(y) + 0.5f) * k - 1.0f));
    return hdrp_i_env_node_make(hdrp_i_env_square(c, solid_angle));
}

/* What one of four texels of a level weighs in the texel of the next that they make. */
struct hdrp_i_env_share {
    float area;       /* of the solid angle; the shares add up to 1 */
    float light;      /* of the light, the channels added up; not yet divided by its sum */
    hdrp_v3 channels; /* of the light, by channel */
};
HDRP_TYPEDEF(hdrp_i_env_share)

/* Channels weigh alike: a blue lamp is a lamp. */
HDRP_FN float hdrp_i_env_light_of(hdrp_v4 texel)
{
    return texel.x + texel.y + texel.z;
}

/* `light` is the sum over the four of area times hdrp_i_env_light_of, `radiance` their mean. */
HDRP_FN hdrp_i_env_share hdrp_i_env_share_make(hdrp_v4 texel, float solid_angle, float light,
                                               hdrp_v3 radiance)
{
    hdrp_i_env_share s;
    float by_light;
    s.area = texel.w / solid_angle;
    by_light = s.area * hdrp_i_env_light_of(texel);
    /* Where there is nothing, there is nothing to weigh. */
    s.light = light > 0.0f ? by_light / light : s.area;
    s.channels = hdrp_v3_make(s.area * texel.x / hdrp_max(radiance.x, HDRP_FLT_MIN),
                              s.area * texel.y / hdrp_max(radiance.y, HDRP_FLT_MIN),
                              s.area * texel.z / hdrp_max(radiance.z, HDRP_FLT_MIN));
    return s;
}

/* First the means of all four are added, */
HDRP_FN hdrp_env_node hdrp_i_env_add_means(hdrp_env_node sum, hdrp_env_node part,
                                           hdrp_i_env_share share)
{
    hdrp_env_node r = sum;
    r.light.mean = hdrp_v3_mad(sum.light.mean, part.light.mean, share.light);
    r.area.mean = hdrp_v3_mad(sum.area.mean, part.area.mean, share.area);
    return r;
}

HDRP_FN hdrp_env_spread hdrp_i_env_add_variance(hdrp_env_spread sum, hdrp_env_spread part,
                                                float weight)
{
    hdrp_env_spread r;
    hdrp_v3 d = hdrp_v3_sub(part.mean, sum.mean);
    r.mean = sum.mean;
    r.xx = sum.xx + weight * (part.xx + d.x * d.x);
    r.yy = sum.yy + weight * (part.yy + d.y * d.y);
    r.zz = sum.zz + weight * (part.zz + d.z * d.z);
    r.xy = sum.xy + weight * (part.xy + d.x * d.y);
    r.yz = sum.yz + weight * (part.yz + d.y * d.z);
    r.xz = sum.xz + weight * (part.xz + d.x * d.z);
    return r;
}

/* and then what is measured from them. */
HDRP_FN hdrp_env_node hdrp_i_env_add_rest(hdrp_env_node sum, hdrp_env_node part,
                                          hdrp_i_env_share share)
{
    hdrp_env_node r;
    hdrp_v3 d = hdrp_v3_sub(part.light.mean, sum.light.mean);
    r.light = hdrp_i_env_add_variance(sum.light, part.light, share.light);
    r.area = hdrp_i_env_add_variance(sum.area, part.area, share.area);
    r.red = hdrp_v3_mad(sum.red, hdrp_v3_add(part.red, d), share.channels.x);
    r.green = hdrp_v3_mad(sum.green, hdrp_v3_add(part.green, d), share.channels.y);
    r.blue = hdrp_v3_mad(sum.blue, hdrp_v3_add(part.blue, d), share.channels.z);
    return r;
}

/* A lobe: the GGX kernel for N = V = R. With q the squared distance of two unit vectors it is
 * n.l / (m q + 4 a)^2, where a is alpha squared and m is 1 - a; constants cancel. */
struct hdrp_i_env_lobe {
    hdrp_v3 axis;
    float m;
    float a4;
    float opening2; /* square of the opening */
    float horizon2; /* the same for parts that cross the horizon */
};
HDRP_TYPEDEF(hdrp_i_env_lobe)

HDRP_FN hdrp_i_env_lobe hdrp_i_env_lobe_make(float alpha, float opening)
{
    hdrp_i_env_lobe lobe;
    lobe.axis = hdrp_v3_splat(0.0f);
    lobe.m = 1.0f - alpha * alpha;
    lobe.a4 = 4.0f * alpha * alpha;
    lobe.opening2 = opening * opening;
    /* The wider the lobe, the more of it is at the horizon, where it has an edge. */
    lobe.horizon2 = lobe.opening2 * hdrp_min(1.0f, 1.0f / (4.0f * lobe.a4));
    return lobe;
}

/* Mean of the kernel over a part of the sky, and how it changes as the part moves. */
struct hdrp_i_env_mean {
    float value;
    hdrp_v3 gradient;
};
HDRP_TYPEDEF(hdrp_i_env_mean)

/* To second order in the spread: with d from the axis to the mean direction, the squared distance
 * has the mean q + trace, where q = d.d, and the variance 4 g, where g = d^T (xx ... xz) d. */
HDRP_FN hdrp_i_env_mean hdrp_i_env_kernel(hdrp_i_env_lobe lobe, hdrp_env_spread part)
{
    hdrp_i_env_mean mean;
    hdrp_v3 d = hdrp_v3_sub(part.mean, lobe.axis);
    float q = hdrp_v3_dot(d, d);
    float trace = part.xx + part.yy + part.zz;
    float g = d.x * (d.x * part.xx + 2.0f * d.y * part.xy) +
              d.y * (d.y * part.yy + 2.0f * d.z * part.yz) +
              d.z * (d.z * part.zz + 2.0f * d.x * part.xz);
    float r = 1.0f / (lobe.m * q + lobe.a4);
    float mr = lobe.m * r;
    float cosine = 1.0f - 0.5f * (q + trace);
    float slope = cosine > 0.0f ? 1.0f : 0.0f;
    /* Across the horizon: the mean of max(x, 0) where x is spread evenly around the cosine. */
    if (cosine * cosine < 3.0f * g) {
        float half_width = hdrp_sqrt(3.0f * g);
        slope = (cosine + half_width) / (2.0f * half_width);
        cosine = slope * slope * half_width;
    }
    cosine = hdrp_max(cosine, 0.0f);
    mean.gradient =
        hdrp_v3_mad(hdrp_v3_scale(lobe.axis, r * r * slope), d, -4.0f * r * r * mr * cosine);
    /* Where the lobe is narrower than a texel of the finest level, the series ends here. */
    if (4.0f * trace * mr > 1.0f) {
        g *= 0.25f / (trace * mr);
        trace = 0.25f / mr;
    }
    mean.value =
        r * r * (cosine * (1.0f + 2.0f * mr * (6.0f * mr * g - trace)) + slope * 4.0f * mr * g);
    return mean;
}

/* 1 where no point of a part is above the horizon: q is the squared distance of its middle from the
 * axis, side2 its solid angle. */
HDRP_FN hdrp_u32 hdrp_i_env_is_hidden(float q, float side2)
{
    return q > 2.0f && hdrp_sq(q - 2.0f) > 16.0f * side2 ? 1u : 0u;
}

/* 1 where a part is small against its distance, and is summed as one. */
HDRP_FN hdrp_u32 hdrp_i_env_is_far(hdrp_i_env_lobe lobe, float q, float side2)
{
    float largest = hdrp_sq(q - 2.0f) < 4.0f * side2 ? lobe.horizon2 : lobe.opening2;
    return side2 * lobe.m <= lobe.opening2 * (lobe.m * q + lobe.a4) && side2 <= largest ? 1u : 0u;
}

/* What a channel of a part weighs, whose light is off the mean of the channels by an offset. */
HDRP_FN float hdrp_i_env_weight(hdrp_i_env_mean k, hdrp_v3 offset, float solid_angle)
{
    return solid_angle * hdrp_max(k.value + hdrp_v3_dot(k.gradient, offset), 0.0f);
}

/* What a part adds to the light under a lobe, by channel, and in w to the lobe itself. On level 0
 * light and area are one. */
HDRP_FN hdrp_v4 hdrp_i_env_part_of(hdrp_i_env_lobe lobe, hdrp_env_node node, hdrp_v4 texel,
                                   hdrp_u32 level)
{
    hdrp_i_env_mean k = hdrp_i_env_kernel(lobe, node.light);
    float red = hdrp_i_env_weight(k, node.red, texel.w);
    float green = hdrp_i_env_weight(k, node.green, texel.w);
    float blue = hdrp_i_env_weight(k, node.blue, texel.w);
    if (level > 0u) {
        k = hdrp_i_env_kernel(lobe, node.area);
    }
    return hdrp_v4_make(red * texel.x, green * texel.y, blue * texel.z, texel.w * k.value);
}

#ifndef HDRP_GPU
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The array has a negative size, which is an error in every C and C++, where an offset is wrong. */
#define HDRP_I_ENV_SH_OFFSET(member, offset)                                                       \
    typedef char hdrp_i_env_sh_##member[offsetof(hdrp_env_sh, member) == (offset) ? 1 : -1];
HDRP_I_ENV_SH_OFFSET(mean, 0)
HDRP_I_ENV_SH_OFFSET(x, 16)
HDRP_I_ENV_SH_OFFSET(y, 32)
HDRP_I_ENV_SH_OFFSET(z, 48)
HDRP_I_ENV_SH_OFFSET(xy, 64)
HDRP_I_ENV_SH_OFFSET(yz, 80)
HDRP_I_ENV_SH_OFFSET(xz, 96)
HDRP_I_ENV_SH_OFFSET(zz, 112)
HDRP_I_ENV_SH_OFFSET(xx, 128)
typedef char hdrp_i_env_sh_size_of[sizeof(hdrp_env_sh) == HDRP_ENV_SH_LAYOUT_SIZE ? 1 : -1];
#undef HDRP_I_ENV_SH_OFFSET

/* >>baking
 * From an image to three cubes: radiance with all mip levels, GGX lobes by roughness, irradiance.
 * Memory is one block of the caller. */

/* A cube with mip levels, level after level; in a level face after face, in a face row after row:
 * the order in which Vulkan copies a buffer to a cube image. xyz is the value, w the solid angle of
 * the texel [sr], which no lookup needs. */
typedef struct hdrp_env_cube {
    hdrp_v4* texels;
    uint32_t size;        /* of level 0: a power of two */
    uint32_t level_count; /* level k has size >> k */
} hdrp_env_cube;

/* Sizes and quality of a bake. Zero is the default. */
typedef struct hdrp_env_desc {
    uint32_t radiance_size;   /* power of two up to 4096; default 256 */
    uint32_t specular_size;   /* power of two up to radiance_size; default 128 or radiance_size */
    uint32_t specular_levels; /* default: down to 4 by 4 texels */
    uint32_t irradiance_size; /* power of two up to 256; default 16 */
    float opening;            /* [0.05,1] largest side of a part of the sky that is summed as one,
                                 over its distance from the middle of the lobe; time goes with its
                                 square; default 0.4 */
} hdrp_env_desc;

/* A baked environment. The members are for reading; init sets the pointers. */
typedef struct hdrp_env {
    hdrp_env_cube radiance;   /* [nits] all levels down to 1 by 1 texel */
    hdrp_env_cube specular;   /* [nits] GGX lobes; level from hdrp_env_lod_from_... */
    hdrp_env_cube irradiance; /* [lux] one level */
    hdrp_env_node* nodes;     /* of the texels of the radiance levels above 0 */
    float opening;
} hdrp_env;

/** Bytes that hdrp_env_init needs.
 *  desc     sizes; NULL for the defaults
 *  returns  bytes, a multiple of HDRP_MEMORY_ALIGNMENT
 *  edges    0 where desc is not valid, or too large for the target */
HDRP_API size_t hdrp_env_memory_size(const hdrp_env_desc* desc);

/** Places an environment in a block of memory. Texels are not initialised.
 *  env           result
 *  desc          sizes; NULL for the defaults
 *  memory        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT; it must outlive env
 *  memory_bytes  size of the block, at least hdrp_env_memory_size(desc)
 *  returns       HDRP_OK
 *  errors        HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT, HDRP_ERROR_TOO_LARGE for the
 *                target, HDRP_ERROR_MEMORY_TOO_SMALL, HDRP_ERROR_MEMORY_ALIGNMENT */
HDRP_API hdrp_result hdrp_env_init(hdrp_env* env, const hdrp_env_desc* desc, void* memory,
                                   size_t memory_bytes);

/** First step: level 0 of the radiance cube from an image, by the areas that texels of both share.
 *  env        from hdrp_env_init
 *  image      the picture; not level 0 of env itself, which is written
 *  first_row  [0,24576]  of the 6 * radiance.size rows of the cube
 *  row_count  [0,24576]  rows to write; a call costs a look at the part of the image that its face
 *             sees, so a quarter of a face is a good job, a single row is not
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER, those of hdrp_env_image_check, HDRP_ERROR_BAD_ARGUMENT for a
 *             bad range and for an image that overlaps level 0 of the radiance of env
 *  range      rows are independent
 *  error      <= 1e-4 relative, flux of any sky  @accuracy env_resample_flux
 *  note       piecewise constant in, piecewise constant out: a constant stays constant, no light is
 *             lost or doubled, not even of a sun of one texel, which only moves by a part of a
 *             texel; the curved edges of rows count as straight between 1.4 degrees */
HDRP_API hdrp_result hdrp_env_resample(hdrp_env* env, const hdrp_env_image* image,
                                       uint32_t first_row, uint32_t row_count);

/** Second step: the mip levels of the radiance cube, each texel the mean of four by solid angle,
 *  and for each where its light comes from.
 *  env         after hdrp_env_resample of all rows
 *  first_face  [0,6]  first face
 *  face_count  [0,6]  faces
 *  returns     HDRP_OK
 *  errors      HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range
 *  range       faces are independent */
HDRP_API hdrp_result hdrp_env_reduce(hdrp_env* env, uint32_t first_face, uint32_t face_count);

/** Rows of the specular cube over all levels and faces: where the range of hdrp_env_prefilter ends.
 *  env      from hdrp_env_init
 *  returns  rows; level 0 first
 *  edges    0 for a null pointer */
HDRP_API uint32_t hdrp_env_specular_rows(const hdrp_env* env);

/** Third step: the specular cube. A texel is the radiance that a surface facing it reflects towards
 *  its normal: mean over l of L(l) D(h) n.l, h halfway between n and l, for GGX of the roughness of
 *  the level (the first half of the split sum, N = V = R). Level 0 is a mirror.
 *  env        after hdrp_env_reduce of all faces
 *  first_row  [0,49152]  first of the hdrp_env_specular_rows
 *  row_count  [0,49152]  rows to write
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range
 *  range      rows are independent; rows of level 1 cost most
 *  error      <= 1.6e-3 relative to the largest channel of the texel, broad coloured lights and
 *             default opening  @accuracy env_prefilter_broad
 *  error      <= 1e-2 relative to the largest channel of the texel, with lamps of one or two texels
 *             that outshine the sky by 1e4 (0.1 % on average), default opening
 *             @accuracy env_prefilter_lamps
 *  error      <= 4e-4 absolute, a sky of mean 1 that is linear in direction, default opening
 *             @accuracy env_prefilter_linear
 *  source     Karis 2013, "Real Shading in Unreal Engine 4" (split sum, weight n.l); Barnes and Hut
 *             1986, "A hierarchical O(N log N) force-calculation algorithm" (summing far parts of
 *             the sky as one)
 *  note       no random numbers and no noise: every texel of the sky counts, far ones in groups. A
 *             group is summed where its light is, with the second derivatives of the lobe times
 *             the variance of the light and the first times the distance of each channel from it.
 *             A constant sky stays constant to rounding; time goes with the inverse square of
 *             opening, errors with its square or cube */
HDRP_API hdrp_result hdrp_env_prefilter(hdrp_env* env, uint32_t first_row, uint32_t row_count);

/** Fourth step, independent of the third: the irradiance cube. Irradiance is pi times the lobe of
 *  alpha 1, and summed in the same way.
 *  env        after hdrp_env_reduce of all faces
 *  first_row  [0,1536]  of the 6 * irradiance.size rows
 *  row_count  [0,1536]  rows to write
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for a bad range
 *  range      rows are independent
 *  error      <= 5e-4 relative to the largest irradiance, any sky, at texel centres
 *             @accuracy env_irradiance */
HDRP_API hdrp_result hdrp_env_convolve_irradiance(hdrp_env* env, uint32_t first_row,
                                                  uint32_t row_count);

/** All four steps over their whole ranges.
 *  env      from hdrp_env_init
 *  image    the picture
 *  returns  HDRP_OK
 *  errors   those of hdrp_env_resample */
HDRP_API hdrp_result hdrp_env_bake(hdrp_env* env, const hdrp_env_image* image);

/** Spherical harmonics of order 2 of the irradiance.
 *  env      after hdrp_env_reduce of all faces
 *  sh       result, for hdrp_env_irradiance_fast
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER
 *  source   Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment
 *           Maps" */
HDRP_API hdrp_result hdrp_env_project_sh(const hdrp_env* env, hdrp_env_sh* sh);

/** One level of a cube as an image, for measuring it or sampling it.
 *  cube     of a baked environment
 *  level    [0,31]  limited to the levels there are
 *  returns  a view: it owns nothing
 *  edges    none */
HDRP_API hdrp_env_image hdrp_env_cube_image(const hdrp_env_cube* cube, uint32_t level);

/* >>lookup */

/** Value of a cube in a direction, trilinear and seamless over edges and corners.
 *  cube       of a baked environment
 *  direction  unit   world direction
 *  lod        [0,31]  limited to the levels there are; NaN counts as 0
 *  returns    the unit of the cube, per channel
 *  edges      the same value from both sides of an edge and from the three sides of a corner, where
 *             the missing fourth texel is the mean of the three */
HDRP_API hdrp_v3 hdrp_env_cube_lookup(const hdrp_env_cube* cube, hdrp_v3 direction, float lod);

/** Radiance in a direction.
 *  env        baked
 *  direction  unit    world direction
 *  lod        [0,31]  level of detail: 0 is the finest; each level halves the resolution
 *  returns    [nits], per channel
 *  edges      as hdrp_env_cube_lookup */
HDRP_API hdrp_v3 hdrp_env_radiance(const hdrp_env* env, hdrp_v3 direction, float lod);

/** Radiance that a GGX lobe sees: the first half of the split sum.
 *  env                   baked
 *  direction             unit   middle of the lobe: the reflected view direction
 *  perceptual_roughness  [0,1]
 *  returns               [nits], per channel; times the directional albedo of the lobe
 *  edges                 as hdrp_env_cube_lookup
 *  error                 <= 7e-2 relative to the mean of a sky of broad lights, roughness 0.05
 *                        to 1: nearly all of it is interpolation between levels of roughness
 *                        @accuracy env_specular */
HDRP_API hdrp_v3 hdrp_env_specular(const hdrp_env* env, hdrp_v3 direction,
                                   float perceptual_roughness);

/** Irradiance of a surface.
 *  env      baked
 *  normal   unit
 *  returns  [lux], per channel: pi times the radiance of a constant sky
 *  edges    as hdrp_env_cube_lookup
 *  error    <= 3e-3 relative to the largest irradiance, many lights, interpolation included,
 *           default size  @accuracy env_irradiance_lookup
 *  error    <= 3e-2 relative to the largest irradiance, a lone sun, which is the worst case,
 *           likewise  @accuracy env_irradiance_lookup_sun */
HDRP_API hdrp_v3 hdrp_env_irradiance(const hdrp_env* env, hdrp_v3 normal);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_ENV_H */

#if defined(HDRP_ENV_IMPLEMENTATION) && !defined(HDRP_ENV_IMPLEMENTED) && !defined(HDRP_GPU)
#define HDRP_ENV_IMPLEMENTED

/* Its bodies too, where it was included before the macro was defined. */
#include "hdrp_env_image.h"

/* ---- memory ---------------------------------------------------------------------------------- */

/* Texels of the levels of a cube before a level. */
static size_t hdrp_i_env_level_offset(uint32_t size, uint32_t level)
{
    size_t sum = 0u;
    uint32_t k;
    for (k = 0u; k < level; ++k) {
        sum += (size_t)6u * (size >> k) * (size >> k);
    }
    return sum;
}

static uint32_t hdrp_i_env_levels(uint32_t size)
{
    uint32_t levels = 1u;
    while ((size >> levels) > 0u) {
        ++levels;
    }
    return levels;
}

static int hdrp_i_env_is_power_of_two(uint32_t size, uint32_t limit)
{
    return size >= 1u && size <= limit && (size & (size - 1u)) == 0u;
}

/* The sizes with their defaults; 0 where they are not valid. */
static int hdrp_i_env_resolve(const hdrp_env_desc* desc, hdrp_env_desc* resolved)
{
    hdrp_env_desc d = {0u, 0u, 0u, 0u, 0.0f};
    uint32_t levels;
    if (desc) {
        d = *desc;
    }
    d.radiance_size = d.radiance_size ? d.radiance_size : 256u;
    if (d.specular_size == 0u) {
        d.specular_size = d.radiance_size < 128u ? d.radiance_size : 128u;
    }
    d.irradiance_size = d.irradiance_size ? d.irradiance_size : 16u;
    d.opening = d.opening != 0.0f ? d.opening : 0.4f;
    if (!hdrp_i_env_is_power_of_two(d.radiance_size, 4096u) ||
        !hdrp_i_env_is_power_of_two(d.specular_size, d.radiance_size) ||
        !hdrp_i_env_is_power_of_two(d.irradiance_size, 256u) ||
        !(d.opening >= 0.05f && d.opening <= 1.0f)) {
        return 0;
    }
    levels = hdrp_i_env_levels(d.specular_size);
    if (d.specular_levels == 0u) {
        d.specular_levels = levels > 3u ? levels - 2u : levels;
    }
    *resolved = d;
    return d.specular_levels <= levels;
}

/* Texels of the levels of the radiance cube, all and above level 0. */
static size_t hdrp_i_env_radiance_texels(const hdrp_env_desc* d, uint32_t first_level)
{
    return hdrp_i_env_level_offset(d->radiance_size, hdrp_i_env_levels(d->radiance_size)) -
           hdrp_i_env_level_offset(d->radiance_size, first_level);
}

HDRP_API size_t hdrp_env_memory_size(const hdrp_env_desc* desc)
{
    hdrp_env_desc d;
    uint64_t bytes;
    if (!hdrp_i_env_resolve(desc, &d)) {
        return 0u;
    }
    /* The largest, faces of 4096 texels, need 5 GB: the sizes below fit 64 bits, and their counts
     * 32. */
    bytes =
        (uint64_t)sizeof(hdrp_v4) * ((uint64_t)hdrp_i_env_radiance_texels(&d, 0u) +
                                     hdrp_i_env_level_offset(d.specular_size, d.specular_levels) +
                                     hdrp_i_env_level_offset(d.irradiance_size, 1u));
    bytes += (uint64_t)sizeof(hdrp_env_node) * hdrp_i_env_radiance_texels(&d, 1u);
    return bytes > (size_t)-1 / 2u ? 0u : HDRP_MEMORY_ROUND_UP((size_t)bytes);
}

HDRP_API hdrp_result hdrp_env_init(hdrp_env* env, const hdrp_env_desc* desc, void* memory,
                                   size_t memory_bytes)
{
    hdrp_env_desc d;
    hdrp_v4* next = (hdrp_v4*)memory;
    if (!env || !memory) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (!hdrp_i_env_resolve(desc, &d)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    if (hdrp_env_memory_size(desc) == 0u) {
        return HDRP_ERROR_TOO_LARGE;
    }
    if (((uintptr_t)memory & (HDRP_MEMORY_ALIGNMENT - 1u)) != 0u) {
        return HDRP_ERROR_MEMORY_ALIGNMENT;
    }
    if (memory_bytes < hdrp_env_memory_size(desc)) {
        return HDRP_ERROR_MEMORY_TOO_SMALL;
    }
    env->radiance.texels = next;
    env->radiance.size = d.radiance_size;
    env->radiance.level_count = hdrp_i_env_levels(d.radiance_size);
    next += hdrp_i_env_radiance_texels(&d, 0u);
    env->specular.texels = next;
    env->specular.size = d.specular_size;
    env->specular.level_count = d.specular_levels;
    next += hdrp_i_env_level_offset(d.specular_size, d.specular_levels);
    env->irradiance.texels = next;
    env->irradiance.size = d.irradiance_size;
    env->irradiance.level_count = 1u;
    next += hdrp_i_env_level_offset(d.irradiance_size, 1u);
    env->nodes = (hdrp_env_node*)(void*)next;
    env->opening = d.opening;
    return HDRP_OK;
}

/* ---- image to cube --------------------------------------------------------------------------- */

/* A piece of a texel of the image on a face, in texels of the cube. A quadrilateral cut by four
 * lines has at most eight corners. */
typedef struct hdrp_i_env_polygon {
    double x[8], y[8];
    int count;
} hdrp_i_env_polygon;

/* The rows of a face that are being written. */
typedef struct hdrp_i_env_target {
    hdrp_v4* texels; /* of the face; xyz is the mean so far, w its weight */
    uint32_t face, size, first_row, end_row;
} hdrp_i_env_target;

/* What lies at or above a limit on one axis (sign 1), or at or below it (sign -1). */
static void hdrp_i_env_clip(hdrp_i_env_polygon* p, int along_y, double limit, double sign)
{
    hdrp_i_env_polygon r;
    int i;
    r.count = 0;
    for (i = 0; i < p->count; ++i) {
        int j = i + 1 < p->count ? i + 1 : 0;
        double a = sign * ((along_y ? p->y[i] : p->x[i]) - limit);
        double b = sign * ((along_y ? p->y[j] : p->x[j]) - limit);
        if (a >= 0.0) {
            r.x[r.count] = p->x[i];
            r.y[r.count] = p->y[i];
            ++r.count;
        }
        if ((a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)) {
            double t = a / (a - b);
            r.x[r.count] = along_y ? p->x[i] + t * (p->x[j] - p->x[i]) : limit;
            r.y[r.count] = along_y ? limit : p->y[i] + t * (p->y[j] - p->y[i]);
            ++r.count;
        }
    }
    *p = r;
}

/* Solid angle of a small piece: its area times the density at its centroid. */
static double hdrp_i_env_piece(const hdrp_i_env_polygon* p, double size)
{
    double twice_area = 0.0, x = 0.0, y = 0.0;
    int i;
    for (i = 2; i < p->count; ++i) {
        double ax = p->x[i - 1] - p->x[0];
        double ay = p->y[i - 1] - p->y[0];
        double bx = p->x[i] - p->x[0];
        double by = p->y[i] - p->y[0];
        double cross = ax * by - bx * ay;
        twice_area += cross;
        x += cross * (ax + bx);
        y += cross * (ay + by);
    }
    if (twice_area == 0.0) {
        return 0.0;
    }
    x = 2.0 * (p->x[0] + x / (3.0 * twice_area)) / size - 1.0;
    y = 2.0 * (p->y[0] + y / (3.0 * twice_area)) / size - 1.0;
    x = 1.0 + x * x + y * y;
    return fabs(twice_area) / (x * sqrt(x));
}

static double hdrp_i_env_smallest(const double* v, int count)
{
    double m = v[0];
    int i;
    for (i = 1; i < count; ++i) {
        m = v[i] < m ? v[i] : m;
    }
    return m;
}

static double hdrp_i_env_largest(const double* v, int count)
{
    double m = v[0];
    int i;
    for (i = 1; i < count; ++i) {
        m = v[i] > m ? v[i] : m;
    }
    return m;
}

/* Adds a texel of the image, a quadrilateral on the face, to the texels it covers. */
static void hdrp_i_env_splat(const hdrp_i_env_target* target, const hdrp_i_env_polygon* quad,
                             hdrp_v3 radiance)
{
    double x_low = hdrp_i_env_smallest(quad->x, 4);
    double x_high = hdrp_i_env_largest(quad->x, 4);
    double y_low = hdrp_i_env_smallest(quad->y, 4);
    double y_high = hdrp_i_env_largest(quad->y, 4);
    double begin = (double)target->first_row;
    double end = (double)target->end_row;
    uint32_t x, y, x_begin, y_begin;
    if (!(x_low < (double)target->size && x_high > 0.0 && y_low < end && y_high > begin)) {
        return;
    }
    x_begin = x_low > 0.0 ? (uint32_t)x_low : 0u;
    y_begin = y_low > begin ? (uint32_t)y_low : target->first_row;
    for (y = y_begin; y < target->end_row && (double)y < y_high; ++y) {
        hdrp_i_env_polygon row = *quad;
        if (y_low < (double)y) {
            hdrp_i_env_clip(&row, 1, (double)y, 1.0);
        }
        if (y_high > (double)y + 1.0) {
            hdrp_i_env_clip(&row, 1, (double)y + 1.0, -1.0);
        }
        for (x = x_begin; x < target->size && (double)x < x_high; ++x) {
            hdrp_i_env_polygon piece = row;
            hdrp_v4* texel = target->texels + (size_t)y * target->size + x;
            float weight;
            if (x_low < (double)x) {
                hdrp_i_env_clip(&piece, 0, (double)x, 1.0);
            }
            if (x_high > (double)x + 1.0) {
                hdrp_i_env_clip(&piece, 0, (double)x + 1.0, -1.0);
            }
            weight = (float)hdrp_i_env_piece(&piece, (double)target->size);
            texel->w += weight;
            /* A running mean: thousands of equal values leave it as it is, to the bit. */
            weight /= hdrp_max(texel->w, HDRP_FLT_MIN);
            texel->x += weight * (radiance.x - texel->x);
            texel->y += weight * (radiance.y - texel->y);
            texel->z += weight * (radiance.z - texel->z);
        }
    }
}

/* Gnomonic projection of a direction (sines and cosines of longitude and polar angle) on a face. */
static void hdrp_i_env_project(const hdrp_i_env_target* target, double sin_longitude,
                               double cos_longitude, double sin_polar, double cos_polar, double* x,
                               double* y)
{
    double dx = sin_polar * sin_longitude;
    double dy = cos_polar;
    double dz = sin_polar * cos_longitude;
    double s, t;
    switch (target->face) {
    case HDRP_ENV_FACE_POSITIVE_X:
    case HDRP_ENV_FACE_NEGATIVE_X:
        s = -dz / dx;
        t = -dy / fabs(dx);
        break;
    case HDRP_ENV_FACE_POSITIVE_Y:
    case HDRP_ENV_FACE_NEGATIVE_Y:
        s = dx / fabs(dy);
        t = dz / dy;
        break;
    default:
        s = dx / dz;
        t = -dy / fabs(dz);
        break;
    }
    *x = (0.5 + 0.5 * s) * target->size;
    *y = (0.5 + 0.5 * t) * target->size;
}

/* Can a row of the image with these polar angles touch the face? */
static int hdrp_i_env_row_sees(const hdrp_i_env_target* target, const double sin_polar[2],
                               const double cos_polar[2])
{
    /* Heights of the edges on a side face where it is closest, and, by sqrt(2), at its sides. */
    double upper = cos_polar[0] / sin_polar[0];
    double lower = cos_polar[1] / sin_polar[1];
    double begin = 1.0 - 2.0 * target->first_row / target->size;
    double end = 1.0 - 2.0 * target->end_row / target->size;
    if (target->face == HDRP_ENV_FACE_POSITIVE_Y) {
        return cos_polar[0] > 0.0 && sin_polar[0] < 1.4143 * cos_polar[0];
    }
    if (target->face == HDRP_ENV_FACE_NEGATIVE_Y) {
        return cos_polar[1] < 0.0 && sin_polar[1] < -1.4143 * cos_polar[1];
    }
    upper *= upper > 0.0 ? 1.4143 : 1.0;
    lower *= lower > 0.0 ? 1.0 : 1.4143;
    return lower < begin && upper > end;
}

/* How often a size must be split so that a texel is small against the curvature of its edges. */
static uint32_t hdrp_i_env_splits(uint32_t size, uint32_t wanted)
{
    return (wanted + size - 1u) / size;
}

static void hdrp_i_env_splat_latlong(const hdrp_i_env_target* target, const hdrp_env_image* image)
{
    /* Eighths of the circle at which the side faces begin: +X at u = 1/8, -X 5/8, +Z 3/8, -Z 7/8;
     * the faces of the y axis see the whole circle. */
    static const uint32_t first_eighth[6] = {1u, 5u, 0u, 0u, 3u, 7u};
    static const uint32_t eighths[6] = {2u, 2u, 8u, 8u, 2u, 2u};
    uint32_t split_x = hdrp_i_env_splits(image->width, 256u);
    uint32_t split_y = hdrp_i_env_splits(image->height, 128u);
    uint32_t w = image->width * split_x;
    uint32_t h = image->height * split_y;
    uint32_t begin = first_eighth[target->face] * w / 8u;
    uint32_t end = ((first_eighth[target->face] + eighths[target->face]) * w + 7u) / 8u;
    double pi = 3.14159265358979324;
    uint32_t i, j;
    for (j = 0u; j < h; ++j) {
        double sin_polar[2], cos_polar[2];
        hdrp_i_env_polygon quad;
        sin_polar[0] = sin(pi * j / h);
        cos_polar[0] = cos(pi * j / h);
        sin_polar[1] = sin(pi * (j + 1.0) / h);
        cos_polar[1] = cos(pi * (j + 1.0) / h);
        if (!hdrp_i_env_row_sees(target, sin_polar, cos_polar)) {
            continue;
        }
        quad.count = 4;
        for (i = begin; i <= end; ++i) {
            double longitude = (0.5 - (double)i / w) * (2.0 * pi);
            double s = sin(longitude);
            double c = cos(longitude);
            hdrp_i_env_project(target, s, c, sin_polar[0], cos_polar[0], &quad.x[2], &quad.y[2]);
            hdrp_i_env_project(target, s, c, sin_polar[1], cos_polar[1], &quad.x[3], &quad.y[3]);
            if (i > begin) {
                hdrp_i_env_splat(target, &quad,
                                 hdrp_env_image_texel(image, j / split_y, (i - 1u) % w / split_x));
            }
            /* The right edge of this texel is the left edge of the next. */
            quad.x[0] = quad.x[3];
            quad.y[0] = quad.y[3];
            quad.x[1] = quad.x[2];
            quad.y[1] = quad.y[2];
        }
    }
}

static void hdrp_i_env_splat_cube(const hdrp_i_env_target* target, const hdrp_env_image* image)
{
    uint32_t split = hdrp_i_env_splits(image->width, 64u);
    uint32_t n = image->width * split;
    double to_target = (double)target->size / n;
    uint32_t i, j;
    for (j = 0u; j < n; ++j) {
        hdrp_i_env_polygon quad;
        quad.count = 4;
        quad.y[0] = quad.y[1] = j * to_target;
        quad.y[2] = quad.y[3] = (j + 1.0) * to_target;
        for (i = 0u; i < n && quad.y[2] > target->first_row && quad.y[0] < target->end_row; ++i) {
            quad.x[0] = quad.x[3] = i * to_target;
            quad.x[1] = quad.x[2] = (i + 1.0) * to_target;
            hdrp_i_env_splat(
                target, &quad,
                hdrp_env_image_texel(image, target->face * image->height + j / split, i / split));
        }
    }
}

/* Whether the texels of an image and level 0 of the radiance share memory. */
static int hdrp_i_env_overlaps(const hdrp_env* env, const hdrp_env_image* image)
{
    uint32_t n = env->radiance.size;
    uintptr_t level = (uintptr_t)env->radiance.texels;
    uintptr_t level_end = level + (size_t)6u * n * n * sizeof(hdrp_v4);
    uintptr_t texels = (uintptr_t)image->texels;
    return texels < level_end && level < (uintptr_t)(image->texels + hdrp_env_image_floats(image));
}

HDRP_API hdrp_result hdrp_env_resample(hdrp_env* env, const hdrp_env_image* image,
                                       uint32_t first_row, uint32_t row_count)
{
    hdrp_result r = hdrp_env_image_check(image);
    uint32_t row, n;
    if (r != HDRP_OK || !env) {
        return r != HDRP_OK ? r : HDRP_ERROR_NULL_POINTER;
    }
    n = env->radiance.size;
    if (first_row > 6u * n || row_count > 6u * n - first_row || hdrp_i_env_overlaps(env, image)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (row = first_row; row < first_row + row_count;) {
        hdrp_i_env_target target;
        uint32_t x, y;
        target.face = row / n;
        target.size = n;
        target.texels = env->radiance.texels + (size_t)target.face * n * n;
        target.first_row = row % n;
        target.end_row = target.first_row + (first_row + row_count - row);
        target.end_row = target.end_row < n ? target.end_row : n;
        memset(target.texels + (size_t)target.first_row * n, 0,
               (size_t)(target.end_row - target.first_row) * n * sizeof(hdrp_v4));
        if (image->kind == HDRP_ENV_CUBE) {
            hdrp_i_env_splat_cube(&target, image);
        } else {
            hdrp_i_env_splat_latlong(&target, image);
        }
        for (y = target.first_row; y < target.end_row; ++y) {
            for (x = 0u; x < n; ++x) {
                target.texels[(size_t)y * n + x].w = hdrp_env_cube_solid_angle(x, y, n);
            }
        }
        row += target.end_row - target.first_row;
    }
    return HDRP_OK;
}

/* ---- mip levels and nodes -------------------------------------------------------------------- */

/* What lies under a texel of a level of the radiance cube; level 0 stores none. */
static hdrp_env_node hdrp_i_env_node_at(const hdrp_env* env, uint32_t level, size_t index)
{
    uint32_t n = env->radiance.size;
    if (level > 0u) {
        return env->nodes[index - (size_t)6u * n * n];
    }
    return hdrp_i_env_leaf((hdrp_u32)(index / n / n), (hdrp_u32)(index % n),
                           (hdrp_u32)(index / n % n), n, env->radiance.texels[index].w);
}

/* Joins four texels of a level into one of the next. */
static void hdrp_i_env_join(const hdrp_env_node child[4], const hdrp_v4 texel[4],
                            hdrp_env_node* node, hdrp_v4* sum)
{
    hdrp_i_env_share share[4];
    float total = 0.0f;
    hdrp_v3 radiance = hdrp_v3_splat(0.0f);
    int i;
    float solid_angle = texel[0].w + texel[1].w + texel[2].w + texel[3].w;
    for (i = 0; i < 4; ++i) {
        float by_area = texel[i].w / solid_angle;
        radiance = hdrp_v3_mad(radiance, hdrp_v3_from_v4(texel[i]), by_area);
        total += by_area * hdrp_i_env_light_of(texel[i]);
    }
    *node = hdrp_i_env_node_make(hdrp_i_env_spread_splat(0.0f));
    for (i = 0; i < 4; ++i) {
        share[i] = hdrp_i_env_share_make(texel[i], solid_angle, total, radiance);
        *node = hdrp_i_env_add_means(*node, child[i], share[i]);
    }
    for (i = 0; i < 4; ++i) {
        *node = hdrp_i_env_add_rest(*node, child[i], share[i]);
    }
    *sum = hdrp_v4_from_v3(radiance, solid_angle);
}

HDRP_API hdrp_result hdrp_env_reduce(hdrp_env* env, uint32_t first_face, uint32_t face_count)
{
    uint32_t level, face, x, y;
    if (!env) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (first_face > 6u || face_count > 6u - first_face) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (level = 1u; level < env->radiance.level_count; ++level) {
        uint32_t n = env->radiance.size >> level;
        size_t from = hdrp_i_env_level_offset(env->radiance.size, level - 1u);
        size_t to = hdrp_i_env_level_offset(env->radiance.size, level);
        size_t finest = hdrp_i_env_level_offset(env->radiance.size, 1u);
        for (face = first_face; face < first_face + face_count; ++face) {
            for (y = 0u; y < n; ++y) {
                for (x = 0u; x < n; ++x) {
                    size_t index = to + ((size_t)face * n + y) * n + x;
                    hdrp_env_node child[4];
                    hdrp_v4 texel[4];
                    uint32_t i;
                    for (i = 0u; i < 4u; ++i) {
                        uint32_t cx = 2u * x + i % 2u, cy = 2u * y + i / 2u;
                        size_t at = from + ((size_t)face * 2u * n + cy) * 2u * n + cx;
                        child[i] = hdrp_i_env_node_at(env, level - 1u, at);
                        texel[i] = env->radiance.texels[at];
                    }
                    hdrp_i_env_join(child, texel, env->nodes + (index - finest),
                                    env->radiance.texels + index);
                }
            }
        }
    }
    return HDRP_OK;
}

/* ---- filter ---------------------------------------------------------------------------------- */

#define HDRP_I_ENV_LEVELS_MAX 13 /* of a cube of 4096 */

/* Mean radiance under a lobe. Walks the mip levels as a tree: what is small against its distance
 * counts as one, everything else is opened. */
static hdrp_v3 hdrp_i_env_gather(const hdrp_env* env, const hdrp_i_env_lobe* lobe)
{
    struct {
        uint16_t x, y;
        uint8_t face, level;
    } stack[6 + 3 * HDRP_I_ENV_LEVELS_MAX], at;
    size_t offset[HDRP_I_ENV_LEVELS_MAX];
    double red = 0.0, green = 0.0, blue = 0.0, total = 0.0;
    int depth = 0;
    uint32_t i;
    for (i = 0u; i < env->radiance.level_count; ++i) {
        offset[i] = hdrp_i_env_level_offset(env->radiance.size, i);
    }
    for (i = 0u; i < 6u; ++i) {
        stack[depth].x = stack[depth].y = 0u;
        stack[depth].face = (uint8_t)i;
        stack[depth].level = (uint8_t)(env->radiance.level_count - 1u);
        ++depth;
    }
    while (depth > 0) {
        hdrp_env_node node;
        hdrp_v4 texel;
        hdrp_v3 d;
        float q;
        uint32_t n;
        size_t index;
        at = stack[--depth];
        n = env->radiance.size >> at.level;
        index = offset[at.level] + ((size_t)at.face * n + at.y) * n + at.x;
        texel = env->radiance.texels[index];
        node = hdrp_i_env_node_at(env, at.level, index);
        d = hdrp_v3_sub(node.area.mean, lobe->axis);
        q = hdrp_v3_dot(d, d);
        if (hdrp_i_env_is_hidden(q, texel.w)) {
            continue;
        }
        if (at.level == 0u || hdrp_i_env_is_far(*lobe, q, texel.w)) {
            hdrp_v4 part = hdrp_i_env_part_of(*lobe, node, texel, at.level);
            red += (double)part.x;
            green += (double)part.y;
            blue += (double)part.z;
            total += (double)part.w;
            continue;
        }
        for (i = 0u; i < 4u; ++i) {
            stack[depth].x = (uint16_t)(2u * at.x + i % 2u);
            stack[depth].y = (uint16_t)(2u * at.y + i / 2u);
            stack[depth].face = at.face;
            stack[depth].level = (uint8_t)(at.level - 1u);
            ++depth;
        }
    }
    return hdrp_v3_make((float)(red / total), (float)(green / total), (float)(blue / total));
}

HDRP_API uint32_t hdrp_env_specular_rows(const hdrp_env* env)
{
    uint32_t level, rows = 0u;
    for (level = 0u; env && level < env->specular.level_count; ++level) {
        rows += 6u * (env->specular.size >> level);
    }
    return rows;
}

HDRP_API hdrp_result hdrp_env_prefilter(hdrp_env* env, uint32_t first_row, uint32_t row_count)
{
    uint32_t rows = hdrp_env_specular_rows(env);
    uint32_t level, begin = 0u;
    if (!env) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (first_row > rows || row_count > rows - first_row) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (level = 0u; level < env->specular.level_count; ++level) {
        uint32_t n = env->specular.size >> level;
        uint32_t end = begin + 6u * n;
        uint32_t row = first_row > begin ? first_row : begin;
        uint32_t last = first_row + row_count < end ? first_row + row_count : end;
        hdrp_v4* texels = env->specular.texels + hdrp_i_env_level_offset(env->specular.size, level);
        /* The mirror is the level of the radiance cube that has the same size. */
        const hdrp_v4* mirror =
            env->radiance.texels +
            hdrp_i_env_level_offset(env->radiance.size, env->radiance.level_count -
                                                            hdrp_i_env_levels(env->specular.size));
        hdrp_i_env_lobe lobe = hdrp_i_env_lobe_make(hdrp_sq(hdrp_env_perceptual_roughness_from_lod(
                                                        (float)level, env->specular.level_count)),
                                                    env->opening);
        for (; row < last; ++row) {
            uint32_t x;
            for (x = 0u; x < n; ++x) {
                size_t index = (size_t)(row - begin) * n + x;
                if (level == 0u) {
                    texels[index] = mirror[index];
                    continue;
                }
                lobe.axis = hdrp_i_env_texel_centre((row - begin) / n, x, (row - begin) % n, n);
                texels[index] = hdrp_v4_from_v3(hdrp_i_env_gather(env, &lobe),
                                                hdrp_env_cube_solid_angle(x, (row - begin) % n, n));
            }
        }
        begin = end;
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_env_convolve_irradiance(hdrp_env* env, uint32_t first_row,
                                                  uint32_t row_count)
{
    hdrp_i_env_lobe lobe;
    uint32_t row, x, n;
    if (!env) {
        return HDRP_ERROR_NULL_POINTER;
    }
    n = env->irradiance.size;
    if (first_row > 6u * n || row_count > 6u * n - first_row) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    lobe = hdrp_i_env_lobe_make(1.0f, env->opening);
    for (row = first_row; row < first_row + row_count; ++row) {
        for (x = 0u; x < n; ++x) {
            lobe.axis = hdrp_i_env_texel_centre(row / n, x, row % n, n);
            env->irradiance.texels[(size_t)row * n + x] =
                hdrp_v4_from_v3(hdrp_v3_scale(hdrp_i_env_gather(env, &lobe), HDRP_PI),
                                hdrp_env_cube_solid_angle(x, row % n, n));
        }
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_env_bake(hdrp_env* env, const hdrp_env_image* image)
{
    hdrp_result r = env ? HDRP_OK : HDRP_ERROR_NULL_POINTER;
    if (r == HDRP_OK) {
        r = hdrp_env_resample(env, image, 0u, 6u * env->radiance.size);
    }
    if (r == HDRP_OK) {
        r = hdrp_env_reduce(env, 0u, 6u);
    }
    if (r == HDRP_OK) {
        r = hdrp_env_prefilter(env, 0u, hdrp_env_specular_rows(env));
    }
    if (r == HDRP_OK) {
        r = hdrp_env_convolve_irradiance(env, 0u, 6u * env->irradiance.size);
    }
    return r;
}

/* Adds the polynomials of hdrp_env_sh in a direction, times a weight. */
static void hdrp_i_env_add_sh(double sum[9], hdrp_v3 d, double weight)
{
    double x = (double)d.x, y = (double)d.y, z = (double)d.z;
    sum[0] += weight;
    sum[1] += weight * x;
    sum[2] += weight * y;
    sum[3] += weight * z;
    sum[4] += weight * x * y;
    sum[5] += weight * y * z;
    sum[6] += weight * x * z;
    sum[7] += weight * (3.0 * z * z - 1.0);
    sum[8] += weight * (x * x - y * y);
}

HDRP_API hdrp_result hdrp_env_project_sh(const hdrp_env* env, hdrp_env_sh* sh)
{
    /* The products of the normal that hdrp_env_sh multiplies, and what turns the mean of radiance
     * times a product into its coefficient: (2 l + 1) / N times the transfer pi, 2 pi / 3, pi / 4
     * of a clamped cosine, N the square of the polynomial's normalisation. */
    static const double scale[9] = {3.14159265358979324, 6.28318530717958648, 6.28318530717958648,
                                    6.28318530717958648, 11.7809724509617246, 11.7809724509617246,
                                    11.7809724509617246, 0.98174770424681039, 2.94524311274043116};
    double sum[3][9], total = 0.0;
    hdrp_v4* coefficients[9];
    uint32_t level = 0u, n, face, x, y;
    size_t offset;
    int k;
    if (!env || !sh) {
        return HDRP_ERROR_NULL_POINTER;
    }
    /* 64 texels resolve order 2 to 1e-4. */
    while ((env->radiance.size >> level) > 64u) {
        ++level;
    }
    n = env->radiance.size >> level;
    offset = hdrp_i_env_level_offset(env->radiance.size, level);
    memset(sum, 0, sizeof sum);
    for (face = 0u; face < 6u; ++face) {
        for (y = 0u; y < n; ++y) {
            for (x = 0u; x < n; ++x) {
                size_t index = offset + ((size_t)face * n + y) * n + x;
                hdrp_v4 texel = env->radiance.texels[index];
                hdrp_env_node node = hdrp_i_env_node_at(env, level, index);
                total += (double)texel.w;
                hdrp_i_env_add_sh(sum[0], hdrp_v3_add(node.light.mean, node.red),
                                  (double)texel.w * (double)texel.x);
                hdrp_i_env_add_sh(sum[1], hdrp_v3_add(node.light.mean, node.green),
                                  (double)texel.w * (double)texel.y);
                hdrp_i_env_add_sh(sum[2], hdrp_v3_add(node.light.mean, node.blue),
                                  (double)texel.w * (double)texel.z);
            }
        }
    }
    coefficients[0] = &sh->mean;
    coefficients[1] = &sh->x;
    coefficients[2] = &sh->y;
    coefficients[3] = &sh->z;
    coefficients[4] = &sh->xy;
    coefficients[5] = &sh->yz;
    coefficients[6] = &sh->xz;
    coefficients[7] = &sh->zz;
    coefficients[8] = &sh->xx;
    for (k = 0; k < 9; ++k) {
        double c = scale[k] / total;
        *coefficients[k] = hdrp_v4_make((float)(sum[0][k] * c), (float)(sum[1][k] * c),
                                        (float)(sum[2][k] * c), 0.0f);
    }
    return HDRP_OK;
}

/* ---- lookup ---------------------------------------------------------------------------------- */

HDRP_API hdrp_env_image hdrp_env_cube_image(const hdrp_env_cube* cube, uint32_t level)
{
    hdrp_env_image image;
    level = level < cube->level_count ? level : cube->level_count - 1u;
    memset(&image, 0, sizeof image);
    image.texels = &cube->texels[hdrp_i_env_level_offset(cube->size, level)].x;
    image.width = image.height = cube->size >> level;
    image.kind = HDRP_ENV_CUBE;
    image.texel_stride = 4u;
    return image;
}

HDRP_API hdrp_v3 hdrp_env_cube_lookup(const hdrp_env_cube* cube, hdrp_v3 direction, float lod)
{
    float l = hdrp_clamp(lod, 0.0f, (float)(cube->level_count - 1u));
    uint32_t level = (uint32_t)l;
    float t = l - (float)level;
    hdrp_env_image fine = hdrp_env_cube_image(cube, level);
    hdrp_v3 r = hdrp_env_image_radiance(&fine, direction);
    if (t > 0.0f) {
        hdrp_env_image coarse = hdrp_env_cube_image(cube, level + 1u);
        r = hdrp_v3_lerp(r, hdrp_env_image_radiance(&coarse, direction), t);
    }
    return r;
}

HDRP_API hdrp_v3 hdrp_env_radiance(const hdrp_env* env, hdrp_v3 direction, float lod)
{
    return hdrp_env_cube_lookup(&env->radiance, direction, lod);
}

HDRP_API hdrp_v3 hdrp_env_specular(const hdrp_env* env, hdrp_v3 direction,
                                   float perceptual_roughness)
{
    return hdrp_env_cube_lookup(
        &env->specular, direction,
        hdrp_env_lod_from_perceptual_roughness(perceptual_roughness, env->specular.level_count));
}

HDRP_API hdrp_v3 hdrp_env_irradiance(const hdrp_env* env, hdrp_v3 normal)
{
    return hdrp_env_cube_lookup(&env->irradiance, normal, 0.0f);
}

#endif /* HDRP_ENV_IMPLEMENTATION */
