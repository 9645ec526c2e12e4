/* hdrp_env_image.h - pictures of the whole sphere: mapping, calibration in lux, the sun, sampling.
 * SPDX-License-Identifier: MIT
 *
 * See hdrp_math.h for the languages, the conventions and the override macros. The formula layer
 * maps directions to latitude-longitude images and to cubes, and weighs their texels. The algorithm
 * layer, C and C++ only, is compiled in one source file:
 *
 *     #define HDRP_ENV_IMPLEMENTATION
 *     #include "hdrp_env_image.h"
 *
 * A panorama whose texel values mean nothing to lights in lux, made to fit them:
 *
 *     hdrp_env_image sky = {0};
 *     sky.texels = rgb;                                       three floats a texel
 *     sky.width = 1024;
 *     sky.height = 512;
 *     hdrp_env_sanitize(&sky, NULL, 0, 512, &counts);         NaN, infinity, negative
 *     hdrp_env_measure(&sky, &stats);                         stats.illuminance_lux
 *     hdrp_env_lux_multiplier(&stats, 20000.0, &multiplier);  20,000 lux: clear sky, no sun
 *     sky.nits_per_unit = multiplier;
 *     hdrp_env_find_sun(&sky, 0.0f, &sun);                    a directional light, with shadows,
 *     hdrp_env_remove_sun(&sky, &sun);                        and the sky without it
 *
 * hdrp_env.h filters such images for lighting in real time, and compiles this header's bodies with
 * its own.
 *
 * Conventions. Space is right-handed, +Y up, and a lookup takes the world direction as it is.
 * Latitude-longitude: the first row is at +Y, the middle of the image is +Z, and +X is a quarter
 * of the width from the left edge, the axes of OpenEXR's "envmap" attribute. Cube: faces
 * +X -X +Y -Y +Z -Z, each stored as Vulkan and OpenGL read it. Texels are areas: texel i of n
 * covers [i/n, (i+1)/n], its value is the mean over that area, and the texels tile the sphere.
 * Files with OpenEXR's attribute have samples on the edges instead, and mirrored cube faces:
 * hdrp_env_texels_from_openexr converts them.
 *
 * Radiance is in nits per channel, so that irradiance is in lux: under a constant sky L it is pi L.
 * Functions that read texels take what is no radiance as black, and 1e20 nits as the largest; to do
 * better, call hdrp_env_sanitize first.
 *
 * >>index of the functions, without hdrp_env_ (written by tools/api_check.py --write)
 *   mapping: latlong_from_direction direction_from_latlong cube_from_direction point_from_cube
 *       direction_from_cube cube_from_openexr
 *   texel weights: latlong_solid_angle latlong_cosine_weight cube_solid_angle cube_cosine_weight
 *   images: image_check image_rows image_floats image_texel image_radiance sanitize
 *       texels_from_openexr
 *   calibration: measure_rows stats_from_rows measure lux_multiplier find_sun remove_sun
 *   sampling: sampler_memory_size sampler_init sampler_build sampler_finish sampler_sample
 *       sampler_pdf
 * >>end */
#ifndef HDRP_ENV_IMAGE_H
#define HDRP_ENV_IMAGE_H

#include "hdrp_math.h"

#if HDRP_VERSION != 100
#error "hdrp_env_image.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* >>mapping */

/* Faces of a cube in the order of Vulkan and OpenGL. */
#define HDRP_ENV_FACE_POSITIVE_X 0u
#define HDRP_ENV_FACE_NEGATIVE_X 1u
#define HDRP_ENV_FACE_POSITIVE_Y 2u
#define HDRP_ENV_FACE_NEGATIVE_Y 3u
#define HDRP_ENV_FACE_POSITIVE_Z 4u
#define HDRP_ENV_FACE_NEGATIVE_Z 5u

/* A place on a cube. */
struct hdrp_env_place {
    hdrp_u32 face; /* HDRP_ENV_FACE_... */
    float u;       /* [0,1] left to right as stored */
    float v;       /* [0,1] top to bottom as stored */
};
HDRP_TYPEDEF(hdrp_env_place)

/** Place of a direction in a latitude-longitude image.
 *  direction  unit   of the light that the texel holds, away from the observer
 *  returns    [0,1]  u = 1/2 - longitude / 2 pi, v = angle from +Y / pi; +Z is (1/2, 1/2), +X has
 *                    u = 1/4
 *  edges      u = 1/2 at both poles; the seam, -Z, is u = 0 or 1 by the sign of direction.x
 *  error      <= 2e-7 absolute, in u times the sine of the angle from the pole, and in v
 *             @accuracy env_latlong_uv
 *  source     OpenEXR, ImfEnvmap.h, description of LatLongMap (axes)
 *  note       atan2 of both legs, not an arc cosine, which loses half the digits at the poles */
HDRP_FN hdrp_v2 hdrp_env_latlong_from_direction(hdrp_v3 direction)
{
    float across = hdrp_sqrt(direction.x * direction.x + direction.z * direction.z);
    /* The arc tangent of (0, 0) is undefined on GPUs. */
    float longitude = hdrp_atan2(direction.x, across > 0.0f ? direction.z : 1.0f);
    float polar = hdrp_atan2(across, direction.y);
    return hdrp_v2_make(hdrp_saturate(0.5f - longitude * HDRP_INV_TWO_PI),
                        hdrp_saturate(polar * HDRP_INV_PI));
}

/** Direction at a place of a latitude-longitude image; inverse of
 *  hdrp_env_latlong_from_direction.
 *  uv       [0,1]  see there
 *  returns  unit   direction
 *  edges    both ends of u are -Z; v = 0 is +Y and v = 1 is -Y up to rounding, whatever u
 *  error    <= 4e-7 absolute, per component  @accuracy env_latlong_direction
 *  source   OpenEXR, ImfEnvmap.h, description of LatLongMap (axes) */
HDRP_FN hdrp_v3 hdrp_env_direction_from_latlong(hdrp_v2 uv)
{
    float longitude = (0.5f - uv.x) * HDRP_TWO_PI;
    float polar = uv.y * HDRP_PI;
    float across = hdrp_sin(polar);
    return hdrp_v3_make(across * hdrp_sin(longitude), hdrp_cos(polar),
                        across * hdrp_cos(longitude));
}

/** Face and place of a direction on a cube.
 *  direction  unit   as for hdrp_env_latlong_from_direction
 *  returns    face in [0,5], u and v in [0,1]
 *  edges      any length but 0 serves; on an edge X wins over Y and Y over Z, either of which
 *             seamless filtering reads alike; the zero vector is the centre of +X
 *  error      <= 1.2e-7 absolute, in u and v  @accuracy env_cube_place
 *  source     Vulkan specification, "Cube Map Face Selection and Transformations" */
HDRP_FN hdrp_env_place hdrp_env_cube_from_direction(hdrp_v3 direction)
{
    hdrp_env_place r;
    float ax = hdrp_abs(direction.x);
    float ay = hdrp_abs(direction.y);
    float az = hdrp_abs(direction.z);
    float s = direction.x;
    float t = -direction.y;
    float major = az;
    r.face = direction.z < 0.0f ? HDRP_ENV_FACE_NEGATIVE_Z : HDRP_ENV_FACE_POSITIVE_Z;
    s = direction.z < 0.0f ? -s : s;
    if (ay >= az) {
        r.face = direction.y < 0.0f ? HDRP_ENV_FACE_NEGATIVE_Y : HDRP_ENV_FACE_POSITIVE_Y;
        s = direction.x;
        t = direction.y < 0.0f ? -direction.z : direction.z;
        major = ay;
    }
    if (ax >= ay && ax >= az) {
        r.face = direction.x < 0.0f ? HDRP_ENV_FACE_NEGATIVE_X : HDRP_ENV_FACE_POSITIVE_X;
        s = direction.x < 0.0f ? direction.z : -direction.z;
        t = -direction.y;
        major = ax;
    }
    major = hdrp_max(major, HDRP_FLT_MIN);
    r.u = hdrp_saturate(0.5f + 0.5f * (s / major));
    r.v = hdrp_saturate(0.5f + 0.5f * (t / major));
    return r;
}

/** A point of a face of the cube [-1,1]^3: a direction that is not normalised.
 *  face     [0,5]   HDRP_ENV_FACE_...
 *  s        [-1,1]  2 u - 1
 *  t        [-1,1]  2 v - 1
 *  returns  [-1,1]  one component is 1 or -1
 *  edges    a face above 5 counts as 5
 *  error    none: a selection
 *  source   Vulkan specification, "Cube Map Face Selection and Transformations" */
HDRP_FN hdrp_v3 hdrp_env_point_from_cube(hdrp_u32 face, float s, float t)
{
    hdrp_v3 p = hdrp_v3_make(-s, -t, -1.0f);
    if (face == HDRP_ENV_FACE_POSITIVE_X) {
        p = hdrp_v3_make(1.0f, -t, -s);
    } else if (face == HDRP_ENV_FACE_NEGATIVE_X) {
        p = hdrp_v3_make(-1.0f, -t, s);
    } else if (face == HDRP_ENV_FACE_POSITIVE_Y) {
        p = hdrp_v3_make(s, 1.0f, t);
    } else if (face == HDRP_ENV_FACE_NEGATIVE_Y) {
        p = hdrp_v3_make(s, -1.0f, -t);
    } else if (face == HDRP_ENV_FACE_POSITIVE_Z) {
        p = hdrp_v3_make(s, -t, 1.0f);
    }
    return p;
}

/** Direction at a place of a cube; inverse of hdrp_env_cube_from_direction.
 *  place    valid
 *  returns  unit   direction
 *  edges    a face above 5 counts as 5
 *  error    <= 2e-7 absolute, per component  @accuracy env_cube_direction
 *  source   Vulkan specification, "Cube Map Face Selection and Transformations" */
HDRP_FN hdrp_v3 hdrp_env_direction_from_cube(hdrp_env_place place)
{
    return hdrp_v3_normalize(
        hdrp_env_point_from_cube(place.face, 2.0f * place.u - 1.0f, 2.0f * place.v - 1.0f));
}

/** The same place on a cube stored as OpenEXR's "envmap" attribute says: the side faces are
 *  mirrored left to right, the faces of the y axis top to bottom.
 *  place    valid
 *  returns  valid  its own inverse
 *  edges    none
 *  error    <= 6e-8 absolute, in u and v  @accuracy env_openexr_place
 *  source   OpenEXR, ImfEnvmap.h, figure of CubeMap */
HDRP_FN hdrp_env_place hdrp_env_cube_from_openexr(hdrp_env_place place)
{
    hdrp_u32 axis = place.face / 2u;
    hdrp_env_place r;
    r.face = place.face;
    r.u = axis == 1u ? place.u : 1.0f - place.u;
    r.v = axis == 1u ? 1.0f - place.v : place.v;
    return r;
}

/* >>texel weights
 * Integrals over a texel in closed form, arranged so that nothing cancels: the difference of two
 * antiderivatives would lose every digit of a texel of a large image in single precision. */

/* Images up to this many texels wide, high, or along the edge of a face. */
#define HDRP_ENV_SIZE_MAX 65536

/** Solid angle of a texel of a latitude-longitude image.
 *  y        [0,65535]  row, below height
 *  width    [1,65536]
 *  height   [1,65536]
 *  returns  (0,inf)    [sr]; over all texels the sum is 4 pi
 *  edges    a row that is not below height counts as the last
 *  error    <= 4.5e-7 relative  @accuracy env_latlong_solid_angle
 *  source   the difference of the cosines of the two edges, as a product */
HDRP_FN float hdrp_env_latlong_solid_angle(hdrp_u32 y, hdrp_u32 width, hdrp_u32 height)
{
    float h = hdrp_f32_from_u32(height);
    float row = hdrp_min(hdrp_f32_from_u32(y), h - 1.0f);
    /* Rows are alike from both poles; the sine is precise near the upper one. */
    float middle = hdrp_sin((hdrp_min(row, h - 1.0f - row) + 0.5f) * (HDRP_PI / h));
    return 4.0f * HDRP_PI * (middle * hdrp_sin(HDRP_HALF_PI / h)) / hdrp_f32_from_u32(width);
}

/** Integral of the cosine to +Y over the part above the horizon of a texel of a
 *  latitude-longitude image: what the texel adds to the illuminance of level ground.
 *  y        [0,65535]  row, below height
 *  width    [1,65536]
 *  height   [1,65536]
 *  returns  [0,inf)    [sr]; over all texels the sum is pi
 *  edges    0 below the horizon; the part above it where an odd height puts it inside a row
 *  error    <= 4.5e-7 relative  @accuracy env_latlong_cosine_weight
 *  source   (pi / width) (sin^2 of the lower edge - sin^2 of the upper edge), as a product */
HDRP_FN float hdrp_env_latlong_cosine_weight(hdrp_u32 y, hdrp_u32 width, hdrp_u32 height)
{
    float h = hdrp_f32_from_u32(height);
    /* Both edges in half rows, cut off at the horizon: exact. */
    float upper = hdrp_min(2.0f * hdrp_f32_from_u32(y), h);
    float lower = hdrp_min(2.0f * hdrp_f32_from_u32(y) + 2.0f, h);
    float sum = hdrp_min(upper + lower, 2.0f * h - (upper + lower));
    float per_half_row = HDRP_HALF_PI / h;
    return HDRP_PI * (hdrp_sin((lower - upper) * per_half_row) * hdrp_sin(sum * per_half_row)) /
           hdrp_f32_from_u32(width);
}

/* Solid angle of the triangle a b c in the plane z = 1, seen from the origin. */
HDRP_FN float hdrp_i_image_triangle(hdrp_v2 a, hdrp_v2 b, hdrp_v2 c, float twice_area)
{
    float la = hdrp_sqrt(1.0f + hdrp_v2_dot(a, a));
    float lb = hdrp_sqrt(1.0f + hdrp_v2_dot(b, b));
    float lc = hdrp_sqrt(1.0f + hdrp_v2_dot(c, c));
    float k = la * lb * lc + (1.0f + hdrp_v2_dot(a, b)) * lc + (1.0f + hdrp_v2_dot(b, c)) * la +
              (1.0f + hdrp_v2_dot(c, a)) * lb;
    return 2.0f * hdrp_atan2(twice_area, k);
}

/** Solid angle of a texel of a cube face.
 *  x        [0,65535]  column, below size
 *  y        [0,65535]  row, below size
 *  size     [1,65536]  texels along the edge of a face
 *  returns  (0,inf)    [sr]; over the texels of one face the sum is 4 pi / 6
 *  edges    a column or row that is not below size counts as the last
 *  error    <= 4e-7 relative  @accuracy env_cube_solid_angle
 *  source   van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle", eq. 8
 *  note     two triangles: their triple products are the area of the texel, which is exact, where
 *           the usual four arc tangents cancel */
HDRP_FN float hdrp_env_cube_solid_angle(hdrp_u32 x, hdrp_u32 y, hdrp_u32 size)
{
    float n = hdrp_f32_from_u32(size);
    float side = 2.0f / n;
    /* Distances from the middle of the face in half texels: exact. */
    float left = 2.0f * hdrp_min(hdrp_f32_from_u32(x), n - 1.0f) - n;
    float upper = 2.0f * hdrp_min(hdrp_f32_from_u32(y), n - 1.0f) - n;
    float s0 = left / n;
    float s1 = (left + 2.0f) / n;
    float t0 = upper / n;
    float t1 = (upper + 2.0f) / n;
    hdrp_v2 a = hdrp_v2_make(s0, t0);
    hdrp_v2 b = hdrp_v2_make(s1, t1);
    return hdrp_i_image_triangle(a, hdrp_v2_make(s1, t0), b, side * side) +
           hdrp_i_image_triangle(a, b, hdrp_v2_make(s0, t1), side * side);
}

/* An edge of a texel: the integral of 1 / (1 + s^2 + t^2) over s in [s0, s1], and how much it falls
 * from t0 to t1. The caller gives both widths, which a difference of rounded ends would spoil. */
struct hdrp_i_image_edge {
    float value;      /* at t1 */
    float difference; /* at t0, less value */
};
HDRP_TYPEDEF(hdrp_i_image_edge)

HDRP_FN hdrp_i_image_edge hdrp_i_image_edge_make(hdrp_v2 s, float ds, hdrp_v2 t, float dt)
{
    hdrp_i_image_edge e;
    float c0 = hdrp_sqrt(1.0f + t.x * t.x);
    float c1 = hdrp_sqrt(1.0f + t.y * t.y);
    float dc = dt * (t.x + t.y) / (c0 + c1);
    float q = s.x * s.y;
    float k0 = c0 * c0 + q;
    float k1 = c1 * c1 + q;
    float angle0 = hdrp_atan2(ds * c0, k0);
    float turn = hdrp_atan2(ds * dc * (c0 * c1 - q), k0 * k1 + ds * ds * c0 * c1);
    e.value = hdrp_atan2(ds * c1, k1) / c1;
    e.difference = (angle0 * dc + c0 * turn) / (c0 * c1);
    return e;
}

/** Integral of the cosine to +Y over the part above the horizon of a texel of a cube: what the
 *  texel adds to the illuminance of level ground.
 *  face     [0,5]      HDRP_ENV_FACE_...
 *  x        [0,65535]  column, below size
 *  y        [0,65535]  row, below size
 *  size     [1,65536]  texels along the edge of a face
 *  returns  [0,inf)    [sr]; over all texels the sum is pi
 *  edges    0 below the horizon; the part above it where an odd size puts it inside a row
 *  error    <= 1e-6 relative  @accuracy env_cube_cosine_weight
 *  source   Lambert 1760, "Photometria": the irradiance of a polygon, a sum over its edges
 *  note     differences of edges by the addition theorem of the arc tangent */
HDRP_FN float hdrp_env_cube_cosine_weight(hdrp_u32 face, hdrp_u32 x, hdrp_u32 y, hdrp_u32 size)
{
    float n = hdrp_f32_from_u32(size);
    float side = 2.0f / n;
    float left = 2.0f * hdrp_min(hdrp_f32_from_u32(x), n - 1.0f) - n;
    float upper = 2.0f * hdrp_min(hdrp_f32_from_u32(y), n - 1.0f) - n;
    float above = hdrp_max(-upper, 0.0f);
    float below = hdrp_max(-upper - 2.0f, 0.0f);
    hdrp_v2 s = hdrp_v2_make(left / n, (left + 2.0f) / n);
    hdrp_v2 t = hdrp_v2_make(upper / n, (upper + 2.0f) / n);
    hdrp_i_image_edge rows = hdrp_i_image_edge_make(s, side, t, side);
    hdrp_i_image_edge columns = hdrp_i_image_edge_make(t, side, s, side);
    hdrp_i_image_edge wall =
        hdrp_i_image_edge_make(s, side, hdrp_v2_make(below / n, above / n), (above - below) / n);
    float top =
        side * rows.value - t.x * rows.difference + side * columns.value - s.x * columns.difference;
    float sides = face / 2u == 1u ? 0.0f : wall.difference;
    return 0.5f * (face == HDRP_ENV_FACE_POSITIVE_Y ? top : sides);
}

#ifndef HDRP_GPU
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* >>images */

typedef enum hdrp_env_image_kind {
    HDRP_ENV_LATLONG = 0, /* one picture, first row at +Y, centre +Z */
    HDRP_ENV_CUBE         /* six faces, +X -X +Y -Y +Z -Z, as Vulkan and OpenGL store them */
} hdrp_env_image_kind;

/* Where the texels of a picture are. The functions below read them and never write them, unless
 * they say so. Rows are counted over the whole picture: row y of face f of a cube is row
 * f * height + y. Zero is the default of every member but the first three. */
typedef struct hdrp_env_image {
    float* texels;            /* red of the first texel, then green and blue; the caller's */
    uint32_t width;           /* texels, at most HDRP_ENV_SIZE_MAX */
    uint32_t height;          /* of the picture or of one face, which must be square */
    hdrp_env_image_kind kind; /* default HDRP_ENV_LATLONG */
    uint32_t texel_stride;    /* floats from a texel to the next; default 3 */
    size_t row_stride;        /* floats from a row to the next; default: no gap */
    size_t face_stride;       /* floats from a face to the next; default: no gap */
    float nits_per_unit;      /* [0,1e12] luminance of a white texel of 1; default 1 */
} hdrp_env_image;

/** Whether an image can be read, by what its members say.
 *  image    the picture
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT where a member is outside its range, a
 *           face is not square, or a stride makes texels overlap; HDRP_ERROR_TOO_LARGE */
HDRP_API hdrp_result hdrp_env_image_check(const hdrp_env_image* image);

/** Rows of an image over all its faces: the end of the range that row functions take.
 *  image    the picture
 *  returns  height, times 6 for a cube
 *  edges    0 for a null pointer and for an image that the other functions refuse */
HDRP_API uint32_t hdrp_env_image_rows(const hdrp_env_image* image);

/** Floats between the first and the end of the last texel of an image: what it occupies in memory.
 *  image    the picture
 *  returns  count; the gaps that strides leave between texels count, those after the last do not
 *  edges    0 for a null pointer and for an image that the other functions refuse */
HDRP_API size_t hdrp_env_image_floats(const hdrp_env_image* image);

/** Radiance of one texel.
 *  image    a picture that hdrp_env_image_check accepts
 *  row      [0,393215]  below hdrp_env_image_rows
 *  x        [0,65535]   below the width
 *  returns  [nits], per channel, in [0,1e20]
 *  edges    NaN and negative values count as 0, an infinity as 1e20 */
HDRP_API hdrp_v3 hdrp_env_image_texel(const hdrp_env_image* image, uint32_t row, uint32_t x);

/** Radiance in a direction, bilinear over the texels at full resolution.
 *  image      a picture that hdrp_env_image_check accepts
 *  direction  unit  world direction of the light
 *  returns    [nits], per channel
 *  edges      seamless over the left and right border, the edges and the corners of a cube; at the
 *             two poles of a latitude-longitude image every meridian has a limit of its own, and
 *             an odd width is shifted by half a texel across them; NaN reads some texel */
HDRP_API hdrp_v3 hdrp_env_image_radiance(const hdrp_env_image* image, hdrp_v3 direction);

/* What hdrp_env_sanitize does. Zero is the default. */
typedef struct hdrp_env_sanitize_desc {
    float infinite_as; /* [0,1e20] value of an infinite channel, at most largest; default 65504, the
                          largest half: an infinity is what a half becomes that was too small for
                          its sun */
    float largest;     /* [0,1e20] value that no channel exceeds; default 1e12 */
} hdrp_env_sanitize_desc;

/* Texels in which at least one channel was changed, by reason; a texel may count several times. */
typedef struct hdrp_env_sanitize_counts {
    uint64_t nan_texels;
    uint64_t infinite_texels; /* of either sign */
    uint64_t negative_texels; /* finite and below 0 */
    uint64_t too_large_texels;
} hdrp_env_sanitize_counts;

/** Replaces what is no radiance, in place. Works on values as stored, before nits_per_unit.
 *  Channel by channel: infinity becomes desc->infinite_as or desc->largest, whichever is smaller,
 *  what is below 0 becomes 0, what is above desc->largest becomes that, and NaN becomes the linear
 *  interpolation of the nearest other values to its left and right in the row (around the border of
 *  a latitude-longitude image), 0 if there are none.
 *  image      the picture; its texels are written
 *  desc       what to write; NULL for the defaults
 *  first_row  [0,393216]  first row to treat
 *  row_count  [0,393216]  rows to treat
 *  counts     of the rows treated: add them up over jobs; may be NULL
 *  returns    HDRP_OK
 *  errors     those of hdrp_env_image_check; HDRP_ERROR_BAD_ARGUMENT for a bad range or desc
 *  range      rows are independent */
HDRP_API hdrp_result hdrp_env_sanitize(const hdrp_env_image* image,
                                       const hdrp_env_sanitize_desc* desc, uint32_t first_row,
                                       uint32_t row_count, hdrp_env_sanitize_counts* counts);

/** Areas of this header from the samples of a file with OpenEXR's "envmap" attribute, whose first
 *  and last samples lie on the edges: each output texel is the mean of the four samples at its
 *  corners, so that there is one fewer in each direction; cube faces are mirrored into place.
 *  file       the samples, at least 2 by 2, in the order of the file
 *  first_row  [0,393210]  first row of the output, counted over all faces
 *  row_count  [0,393210]  rows of the output
 *  texels     the whole output, (width - 1) times (height - 1) texels of three floats each face;
 *             the caller's, not overlapping the file
 *  returns    HDRP_OK
 *  errors     those of hdrp_env_image_check; HDRP_ERROR_BAD_ARGUMENT for a bad range, and where
 *             file is less than 2 by 2
 *  range      rows are independent
 *  source     OpenEXR, ImfEnvmap.h, descriptions of LatLongMap and CubeMap */
HDRP_API hdrp_result hdrp_env_texels_from_openexr(const hdrp_env_image* file, uint32_t first_row,
                                                  uint32_t row_count, float* texels);

/* >>calibration */

/* What an image emits: sums over one row. */
typedef struct hdrp_env_row {
    double illuminance_lux[3]; /* on level ground, from above */
    double flux[3];            /* radiance over solid angle [nit sr] */
    double peak_nits;          /* largest luminance */
    uint32_t peak_column;      /* where, the leftmost */
    uint32_t invalid_texels;   /* negative or not finite; counted as black */
    uint32_t limited_texels;   /* with a channel above 1e20 nits, counted as 1e20 */
} hdrp_env_row;

/* What an image emits. Luminance weighs the channels as Rec.709 does. */
typedef struct hdrp_env_stats {
    double illuminance_lux;        /* on level ground (facing +Y), from the upper hemisphere */
    double illuminance_lux_rgb[3]; /* the same by channel */
    double average_nits;           /* mean luminance over the sphere */
    double average_nits_rgb[3];
    double peak_nits;  /* largest luminance of a texel */
    uint32_t peak_row; /* where, the uppermost */
    uint32_t peak_column;
    uint64_t invalid_texels; /* negative or not finite; counted as black */
    uint64_t limited_texels; /* with a channel above 1e20 nits, counted as 1e20: the sums above
                                say too little */
} hdrp_env_stats;

/** Sums of some rows of an image, for hdrp_env_stats_from_rows.
 *  image      the picture
 *  first_row  [0,393216]  first row to measure
 *  row_count  [0,393216]  rows to measure
 *  rows       one record for each row of the image; those of the range are written; the caller's
 *  returns    HDRP_OK
 *  errors     those of hdrp_env_image_check; HDRP_ERROR_BAD_ARGUMENT for a bad range
 *  range      rows are independent
 *  source     the closed forms of the section on texel weights */
HDRP_API hdrp_result hdrp_env_measure_rows(const hdrp_env_image* image, uint32_t first_row,
                                           uint32_t row_count, hdrp_env_row* rows);

/** Statistics of an image from the sums of all its rows.
 *  image    the picture
 *  rows     hdrp_env_image_rows(image) records
 *  stats    result
 *  returns  HDRP_OK
 *  errors   those of hdrp_env_image_check */
HDRP_API hdrp_result hdrp_env_stats_from_rows(const hdrp_env_image* image, const hdrp_env_row* rows,
                                              hdrp_env_stats* stats);

/** Illuminance, mean and peak of an image: the two functions above in one, with the same bits.
 *  image    the picture
 *  stats    result
 *  returns  HDRP_OK
 *  errors   those of hdrp_env_image_check
 *  error    <= 3.5e-7 relative against texels integrated in double, illuminance and mean
 *           @accuracy env_measure
 *  source   Lagarde et al. 2016, "An Artist-Friendly Workflow for Panoramic HDRI" (the idea);
 *           Lagarde and Golubev 2018 sample the sphere instead, see the slide on HDRI
 *  note     texels count as areas of constant radiance and are weighed in closed form: a constant
 *           sky L gives pi L, and a sun of one texel counts in full. The published loop over steps
 *           of 0.005 rad reads a constant sky 2.8e-4 too bright, and a disc of 0.53 degrees wrong
 *           by tens of percent, either way */
HDRP_API hdrp_result hdrp_env_measure(const hdrp_env_image* image, hdrp_env_stats* stats);

/** Factor that brings an image to a wanted illuminance.
 *  stats       of the image
 *  wanted_lux  (0,1e12]  on level ground; 20,000 is a clear sky without its sun
 *  multiplier  result: multiply nits_per_unit (1 where it is 0) or every texel by it
 *  returns     HDRP_OK
 *  errors      HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT where wanted_lux is not in its
 *              range, the upper hemisphere is black, the multiplier would not be in [1e-30,1e12],
 *              or the image has invalid texels, which hdrp_env_sanitize replaces, or limited ones
 *  source      Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *              Definition Render Pipeline", slide on HDRI */
HDRP_API hdrp_result hdrp_env_lux_multiplier(const hdrp_env_stats* stats, double wanted_lux,
                                             float* multiplier);

/* A small bright part of an image, as the directional light that replaces it. */
typedef struct hdrp_env_sun {
    hdrp_v3 direction;       /* unit, to the light */
    hdrp_v3 illuminance_lux; /* per channel, on a plane facing the light */
    float solid_angle_sr;    /* of its texels brighter than half its peak */
    float share;             /* [0,1] of the luminance of the whole sphere that it is */
    hdrp_v3 background_nits; /* of the ring around it: what remains in its place */
    hdrp_v3 centre;          /* unit; middle of the disc that is searched */
    float cos_radius;        /* of the disc */
} hdrp_env_sun;

/** Finds the brightest spot of an image and what it has over its surroundings: everything in a disc
 *  around the brightest texel that exceeds, channel by channel, the mean of the ring around it
 *  (up to twice the radius; of all the rest in an image so small that the ring holds no texel, and
 *  of the disc itself where there is no rest). Whether that is a sun is for the caller to say, by
 *  share.
 *  image       the picture
 *  radius_rad  [0,0.5]  of the disc; 0 means 0.035 (2 degrees, seven times the radius of the sun,
 *              for its glare), at least one and a half texels
 *  sun         result
 *  returns     HDRP_OK; for an image without contrast a sun without light
 *  errors      HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT where image or radius is out of
 *              range or the image has invalid or limited texels, see hdrp_env_stats */
HDRP_API hdrp_result hdrp_env_find_sun(const hdrp_env_image* image, float radius_rad,
                                       hdrp_env_sun* sun);

/** Takes the light that hdrp_env_find_sun found out of the image: texels of its disc are limited to
 *  the background. The image and a directional light then add up to the illuminance of the
 *  original on every plane that sees the whole disc.
 *  image    the picture that the sun was found in, unchanged; its texels are written
 *  sun      from hdrp_env_find_sun
 *  returns  HDRP_OK
 *  error    <= 2.5e-7 relative, luminance of the sum against the original, level ground, disc above
 *           the horizon  @accuracy env_remove_sun
 *  errors   those of hdrp_env_image_check */
HDRP_API hdrp_result hdrp_env_remove_sun(const hdrp_env_image* image, const hdrp_env_sun* sun);

/* >>sampling
 * Directions with a density in proportion to luminance, for path tracing. */

/* Cumulated weights of the rows of an image and of the texels of each row. */
typedef struct hdrp_env_sampler {
    hdrp_env_image image; /* its texels must stay as they were */
    double* rows;         /* rows + 1 */
    float* columns;       /* rows times (width + 1) */
} hdrp_env_sampler;

typedef struct hdrp_env_sample {
    hdrp_v3 direction;     /* unit */
    hdrp_v3 radiance_nits; /* hdrp_env_image_radiance in that direction */
    float pdf_per_sr;      /* > 0 */
} hdrp_env_sample;

/** Bytes that hdrp_env_sampler_init needs.
 *  image    the picture
 *  returns  bytes, a multiple of HDRP_MEMORY_ALIGNMENT
 *  edges    0 where the image is not valid, or too large for the target */
HDRP_API size_t hdrp_env_sampler_memory_size(const hdrp_env_image* image);

/** Places the tables of a sampler in a block of memory.
 *  sampler       result
 *  image         the picture
 *  memory        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT; it must outlive sampler
 *  memory_bytes  size of the block, at least hdrp_env_sampler_memory_size(image)
 *  returns       HDRP_OK
 *  errors        HDRP_ERROR_NULL_POINTER, those of hdrp_env_image_check, HDRP_ERROR_TOO_LARGE where
 *                hdrp_env_sampler_memory_size is 0, HDRP_ERROR_MEMORY_TOO_SMALL,
 *                HDRP_ERROR_MEMORY_ALIGNMENT */
HDRP_API hdrp_result hdrp_env_sampler_init(hdrp_env_sampler* sampler, const hdrp_env_image* image,
                                           void* memory, size_t memory_bytes);

/** First step: the tables of some rows. A texel weighs the mean of the bilinear radiance over it,
 *  so that the density is positive wherever hdrp_env_image_radiance is.
 *  sampler    from hdrp_env_sampler_init
 *  first_row  [0,393216]  first row
 *  row_count  [0,393216]  rows
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT (range)
 *  range      rows are independent */
HDRP_API hdrp_result hdrp_env_sampler_build(hdrp_env_sampler* sampler, uint32_t first_row,
                                            uint32_t row_count);

/** Second step: the table of the rows.
 *  sampler  after hdrp_env_sampler_build of all rows
 *  returns  HDRP_OK
 *  errors   HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT where the image is black */
HDRP_API hdrp_result hdrp_env_sampler_finish(hdrp_env_sampler* sampler);

/** A direction with a density in proportion to luminance.
 *  sampler  finished
 *  u1       [0,1)  random: the row
 *  u2       [0,1)  random: the column
 *  returns  direction, radiance and density; neighbours in u1 and u2 are neighbours on the sphere
 *           within a row, so that stratified numbers give stratified directions
 *  edges    numbers outside the range and NaN are limited to it */
HDRP_API hdrp_env_sample hdrp_env_sampler_sample(const hdrp_env_sampler* sampler, float u1,
                                                 float u2);

/** Density with which hdrp_env_sampler_sample returns a direction.
 *  sampler    finished
 *  direction  unit  any direction
 *  returns    [1/sr]; the integral over the sphere is 1
 *  edges      constant over a texel of a latitude-longitude image */
HDRP_API float hdrp_env_sampler_pdf(const hdrp_env_sampler* sampler, hdrp_v3 direction);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_ENV_IMAGE_H */

#if defined(HDRP_ENV_IMPLEMENTATION) && !defined(HDRP_ENV_IMAGE_IMPLEMENTED) && !defined(HDRP_GPU)
#define HDRP_ENV_IMAGE_IMPLEMENTED

/* ---- images ---------------------------------------------------------------------------------- */

/* No channel of radiance exceeds this: products with a narrow lobe stay finite. */
#define HDRP_I_IMAGE_NITS_MAX 1e20f

/* Strides in floats, with their defaults. */
static size_t hdrp_i_image_texel_stride(const hdrp_env_image* image)
{
    return image->texel_stride ? image->texel_stride : 3u;
}

static size_t hdrp_i_image_row_stride(const hdrp_env_image* image)
{
    return image->row_stride ? image->row_stride : image->width * hdrp_i_image_texel_stride(image);
}

static size_t hdrp_i_image_face_stride(const hdrp_env_image* image)
{
    return image->face_stride ? image->face_stride : image->height * hdrp_i_image_row_stride(image);
}

HDRP_API hdrp_result hdrp_env_image_check(const hdrp_env_image* image)
{
    const size_t limit = (size_t)-1 / sizeof(float);
    if (!image || !image->texels) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (image->width < 1u || image->width > HDRP_ENV_SIZE_MAX || image->height < 1u ||
        image->height > HDRP_ENV_SIZE_MAX ||
        (image->kind != HDRP_ENV_LATLONG && image->kind != HDRP_ENV_CUBE) ||
        (image->kind == HDRP_ENV_CUBE && image->width != image->height) ||
        hdrp_i_image_texel_stride(image) < 3u || hdrp_i_image_texel_stride(image) > 256u ||
        !(image->nits_per_unit >= 0.0f && image->nits_per_unit <= 1e12f)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    if (hdrp_i_image_row_stride(image) > limit / image->height / 6u ||
        hdrp_i_image_face_stride(image) > limit / 6u) {
        return HDRP_ERROR_TOO_LARGE;
    }
    if (hdrp_i_image_row_stride(image) < image->width * hdrp_i_image_texel_stride(image) ||
        hdrp_i_image_face_stride(image) < image->height * hdrp_i_image_row_stride(image)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    return HDRP_OK;
}

HDRP_API uint32_t hdrp_env_image_rows(const hdrp_env_image* image)
{
    if (hdrp_env_image_check(image) != HDRP_OK) {
        return 0u;
    }
    return image->height * (image->kind == HDRP_ENV_CUBE ? 6u : 1u);
}

static hdrp_result hdrp_i_image_check_rows(const hdrp_env_image* image, uint32_t first_row,
                                           uint32_t row_count)
{
    hdrp_result r = hdrp_env_image_check(image);
    uint32_t rows = hdrp_env_image_rows(image);
    if (r == HDRP_OK && (first_row > rows || row_count > rows - first_row)) {
        r = HDRP_ERROR_BAD_ARGUMENT;
    }
    return r;
}

/* The three channels of a texel as stored. */
static float* hdrp_i_image_at(const hdrp_env_image* image, uint32_t face, uint32_t y, uint32_t x)
{
    return image->texels +
           (face * hdrp_i_image_face_stride(image) + y * hdrp_i_image_row_stride(image) +
            x * hdrp_i_image_texel_stride(image));
}

static float* hdrp_i_image_stored(const hdrp_env_image* image, uint32_t row, uint32_t x)
{
    return hdrp_i_image_at(image, row / image->height, row % image->height, x);
}

HDRP_API size_t hdrp_env_image_floats(const hdrp_env_image* image)
{
    uint32_t rows = hdrp_env_image_rows(image);
    const float* last;
    if (rows == 0u) {
        return 0u;
    }
    last = hdrp_i_image_stored(image, rows - 1u, image->width - 1u);
    return (size_t)(last - image->texels) + 3u;
}

static float hdrp_i_image_scale(const hdrp_env_image* image)
{
    return image->nits_per_unit > 0.0f ? image->nits_per_unit : 1.0f;
}

static hdrp_v3 hdrp_i_image_read(const hdrp_env_image* image, uint32_t face, uint32_t y, uint32_t x)
{
    const float* c = hdrp_i_image_at(image, face, y, x);
    float k = hdrp_i_image_scale(image);
    return hdrp_v3_make(hdrp_clamp(c[0] * k, 0.0f, HDRP_I_IMAGE_NITS_MAX),
                        hdrp_clamp(c[1] * k, 0.0f, HDRP_I_IMAGE_NITS_MAX),
                        hdrp_clamp(c[2] * k, 0.0f, HDRP_I_IMAGE_NITS_MAX));
}

HDRP_API hdrp_v3 hdrp_env_image_texel(const hdrp_env_image* image, uint32_t row, uint32_t x)
{
    return hdrp_i_image_read(image, row / image->height, row % image->height, x);
}

static double hdrp_i_image_luminance(const double rgb[3])
{
    return (double)hdrp_luminance(hdrp_v3_make((float)rgb[0], (float)rgb[1], (float)rgb[2]));
}

static float hdrp_i_image_texel_solid_angle(const hdrp_env_image* image, uint32_t row, uint32_t x)
{
    return image->kind == HDRP_ENV_CUBE
               ? hdrp_env_cube_solid_angle(x, row % image->height, image->height)
               : hdrp_env_latlong_solid_angle(row, image->width, image->height);
}

static float hdrp_i_image_texel_cosine_weight(const hdrp_env_image* image, uint32_t row, uint32_t x)
{
    return image->kind == HDRP_ENV_CUBE
               ? hdrp_env_cube_cosine_weight(row / image->height, x, row % image->height,
                                             image->height)
               : hdrp_env_latlong_cosine_weight(row, image->width, image->height);
}

static hdrp_v3 hdrp_i_image_texel_direction(const hdrp_env_image* image, uint32_t row, uint32_t x)
{
    hdrp_env_place place;
    place.face = row / image->height;
    place.u = ((float)x + 0.5f) / (float)image->width;
    place.v = ((float)(row % image->height) + 0.5f) / (float)image->height;
    return image->kind == HDRP_ENV_CUBE
               ? hdrp_env_direction_from_cube(place)
               : hdrp_env_direction_from_latlong(hdrp_v2_make(place.u, place.v));
}

/* The texel of a cube that is one step outside a face, across the edge. */
static hdrp_v3 hdrp_i_image_read_across(const hdrp_env_image* image, uint32_t face, int x, int y)
{
    int n = (int)image->height;
    float size = (float)n;
    float inside = 1.0f - 1.0f / size;
    hdrp_env_place place;
    /* The texel folded over the edge: one half texel below it on the other face. */
    hdrp_v3 p = hdrp_env_point_from_cube(
        face, hdrp_clamp((2.0f * (float)x + 1.0f - size) / size, -1.0f, 1.0f),
        hdrp_clamp((2.0f * (float)y + 1.0f - size) / size, -1.0f, 1.0f));
    p.x *= face / 2u == 0u ? inside : 1.0f;
    p.y *= face / 2u == 1u ? inside : 1.0f;
    p.z *= face / 2u == 2u ? inside : 1.0f;
    place = hdrp_env_cube_from_direction(p);
    x = (int)(place.u * size);
    y = (int)(place.v * size);
    return hdrp_i_image_read(image, place.face, (uint32_t)(y < n ? y : n - 1),
                             (uint32_t)(x < n ? x : n - 1));
}

/* Radiance of a texel up to one step outside the picture or the face. */
static hdrp_v3 hdrp_i_image_read_wrapped(const hdrp_env_image* image, uint32_t face, int x, int y)
{
    int w = (int)image->width;
    int h = (int)image->height;
    int in_x = x < 0 ? 0 : (x >= w ? w - 1 : x);
    int in_y = y < 0 ? 0 : (y >= h ? h - 1 : y);
    if (x == in_x && y == in_y) {
        return hdrp_i_image_read(image, face, (uint32_t)y, (uint32_t)x);
    }
    if (image->kind == HDRP_ENV_LATLONG) {
        /* Across a pole is half way around. */
        x = (x + w + (y == in_y ? 0 : w / 2)) % w;
        return hdrp_i_image_read(image, face, (uint32_t)in_y, (uint32_t)x);
    }
    if (x != in_x && y != in_y) {
        hdrp_v3 sum = hdrp_i_image_read(image, face, (uint32_t)in_y, (uint32_t)in_x);
        sum = hdrp_v3_add(sum, hdrp_i_image_read_across(image, face, x, in_y));
        sum = hdrp_v3_add(sum, hdrp_i_image_read_across(image, face, in_x, y));
        return hdrp_v3_scale(sum, 1.0f / 3.0f);
    }
    return hdrp_i_image_read_across(image, face, x, y);
}

static hdrp_env_place hdrp_i_image_place(const hdrp_env_image* image, hdrp_v3 direction)
{
    hdrp_env_place place;
    if (image->kind == HDRP_ENV_CUBE) {
        place = hdrp_env_cube_from_direction(direction);
    } else {
        hdrp_v2 uv = hdrp_env_latlong_from_direction(direction);
        place.face = 0u;
        place.u = uv.x;
        place.v = uv.y;
    }
    return place;
}

HDRP_API hdrp_v3 hdrp_env_image_radiance(const hdrp_env_image* image, hdrp_v3 direction)
{
    hdrp_env_place place = hdrp_i_image_place(image, direction);
    float x = place.u * (float)image->width - 0.5f;
    float y = place.v * (float)image->height - 0.5f;
    float x0 = hdrp_floor(x);
    float y0 = hdrp_floor(y);
    int ix = (int)x0;
    int iy = (int)y0;
    hdrp_v3 upper = hdrp_v3_lerp(hdrp_i_image_read_wrapped(image, place.face, ix, iy),
                                 hdrp_i_image_read_wrapped(image, place.face, ix + 1, iy), x - x0);
    hdrp_v3 lower =
        hdrp_v3_lerp(hdrp_i_image_read_wrapped(image, place.face, ix, iy + 1),
                     hdrp_i_image_read_wrapped(image, place.face, ix + 1, iy + 1), x - x0);
    return hdrp_v3_lerp(upper, lower, y - y0);
}

static int hdrp_i_image_is_nan(float v)
{
    return !(v == v);
}

/* Fills the NaN of one channel of a row from its neighbours. */
static void hdrp_i_image_fill_nan(const hdrp_env_image* image, uint32_t row, int channel)
{
    uint32_t w = image->width;
    uint32_t first = 0u;
    uint32_t k, end;
    int around = image->kind == HDRP_ENV_LATLONG;
    while (first < w && hdrp_i_image_is_nan(hdrp_i_image_stored(image, row, first)[channel])) {
        ++first;
    }
    if (first == w) {
        for (k = 0u; k < w; ++k) {
            hdrp_i_image_stored(image, row, k)[channel] = 0.0f;
        }
        return;
    }
    if (!around) {
        for (k = 0u; k < first; ++k) {
            hdrp_i_image_stored(image, row, k)[channel] =
                hdrp_i_image_stored(image, row, first)[channel];
        }
        first = 0u;
    }
    /* Every run of NaN from first on, once around, lies between two values. */
    for (k = 1u; k < w; k = end + 1u) {
        float left = hdrp_i_image_stored(image, row, (first + k - 1u) % w)[channel];
        float right, t;
        uint32_t i;
        for (end = k; end < w && hdrp_i_image_is_nan(hdrp_i_image_stored(
                                     image, row, (first + end) % w)[channel]);) {
            ++end;
        }
        right =
            end < w || around ? hdrp_i_image_stored(image, row, (first + end) % w)[channel] : left;
        for (i = k; i < end; ++i) {
            t = (float)(i - k + 1u) / (float)(end - k + 1u);
            hdrp_i_image_stored(image, row, (first + i) % w)[channel] = hdrp_lerp(left, right, t);
        }
    }
}

static void hdrp_i_image_sanitize_row(const hdrp_env_image* image, uint32_t row, float infinite_as,
                                      float largest, hdrp_env_sanitize_counts* counts)
{
    uint32_t x;
    int nan[3] = {0, 0, 0};
    int channel;
    for (x = 0u; x < image->width; ++x) {
        float* c = hdrp_i_image_stored(image, row, x);
        int is_nan = 0, is_infinite = 0, is_negative = 0, is_large = 0;
        for (channel = 0; channel < 3; ++channel) {
            float v = c[channel];
            if (v >= 0.0f && v <= largest) {
                continue;
            }
            if (hdrp_i_image_is_nan(v)) {
                is_nan = nan[channel] = 1;
            } else if (v > HDRP_FLT_MAX || v < -HDRP_FLT_MAX) {
                is_infinite = 1;
                c[channel] = v > 0.0f ? infinite_as : 0.0f;
            } else if (v < 0.0f) {
                is_negative = 1;
                c[channel] = 0.0f;
            } else {
                is_large = 1;
                c[channel] = largest;
            }
        }
        counts->nan_texels += (uint64_t)is_nan;
        counts->infinite_texels += (uint64_t)is_infinite;
        counts->negative_texels += (uint64_t)is_negative;
        counts->too_large_texels += (uint64_t)is_large;
    }
    for (channel = 0; channel < 3; ++channel) {
        if (nan[channel]) {
            hdrp_i_image_fill_nan(image, row, channel);
        }
    }
}

HDRP_API hdrp_result hdrp_env_sanitize(const hdrp_env_image* image,
                                       const hdrp_env_sanitize_desc* desc, uint32_t first_row,
                                       uint32_t row_count, hdrp_env_sanitize_counts* counts)
{
    hdrp_result r = hdrp_i_image_check_rows(image, first_row, row_count);
    hdrp_env_sanitize_counts sum = {0u, 0u, 0u, 0u};
    float infinite_as = desc && desc->infinite_as != 0.0f ? desc->infinite_as : 65504.0f;
    float largest = desc && desc->largest != 0.0f ? desc->largest : 1e12f;
    uint32_t row;
    if (r != HDRP_OK) {
        return r;
    }
    if (!(infinite_as > 0.0f && infinite_as <= HDRP_I_IMAGE_NITS_MAX && largest > 0.0f &&
          largest <= HDRP_I_IMAGE_NITS_MAX)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (row = first_row; row < first_row + row_count; ++row) {
        hdrp_i_image_sanitize_row(image, row, hdrp_min(infinite_as, largest), largest, &sum);
    }
    if (counts) {
        *counts = sum;
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_env_texels_from_openexr(const hdrp_env_image* file, uint32_t first_row,
                                                  uint32_t row_count, float* texels)
{
    hdrp_result r = hdrp_env_image_check(file);
    uint32_t w, h, row, x;
    int corner, channel;
    if (r != HDRP_OK || !texels) {
        return r != HDRP_OK ? r : HDRP_ERROR_NULL_POINTER;
    }
    w = file->width - 1u;
    h = file->height - 1u;
    if (w < 1u || h < 1u || first_row > hdrp_env_image_rows(file) / file->height * h ||
        row_count > hdrp_env_image_rows(file) / file->height * h - first_row) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (row = first_row; row < first_row + row_count; ++row) {
        uint32_t face = row / h;
        int mirror_x = file->kind == HDRP_ENV_CUBE && face / 2u != 1u;
        int mirror_y = file->kind == HDRP_ENV_CUBE && face / 2u == 1u;
        uint32_t y = face * file->height + (mirror_y ? h - 1u - row % h : row % h);
        for (x = 0u; x < w; ++x) {
            float* texel = texels + ((size_t)row * w + x) * 3u;
            uint32_t from_x = mirror_x ? w - 1u - x : x;
            texel[0] = texel[1] = texel[2] = 0.0f;
            for (corner = 0; corner < 4; ++corner) {
                const float* c = hdrp_i_image_stored(file, y + (uint32_t)(corner / 2),
                                                     from_x + (uint32_t)(corner % 2));
                for (channel = 0; channel < 3; ++channel) {
                    texel[channel] += 0.25f * c[channel];
                }
            }
        }
    }
    return HDRP_OK;
}

/* ---- calibration ----------------------------------------------------------------------------- */

static void hdrp_i_image_measure_row(const hdrp_env_image* image, uint32_t row,
                                     hdrp_env_row* result)
{
    hdrp_env_row sum;
    float scale = hdrp_i_image_scale(image);
    double cosine_weight = 0.0, solid_angle = 0.0;
    uint32_t x;
    int channel;
    memset(&sum, 0, sizeof sum);
    for (x = 0u; x < image->width; ++x) {
        const float* c = hdrp_i_image_stored(image, row, x);
        double nits[3];
        if (x == 0u || image->kind == HDRP_ENV_CUBE) {
            cosine_weight = (double)hdrp_i_image_texel_cosine_weight(image, row, x);
            solid_angle = (double)hdrp_i_image_texel_solid_angle(image, row, x);
        }
        if (!(c[0] >= 0.0f && c[0] <= HDRP_FLT_MAX && c[1] >= 0.0f && c[1] <= HDRP_FLT_MAX &&
              c[2] >= 0.0f && c[2] <= HDRP_FLT_MAX)) {
            sum.invalid_texels += 1u;
            continue;
        }
        sum.limited_texels += hdrp_max(hdrp_max(c[0], c[1]), c[2]) * scale > HDRP_I_IMAGE_NITS_MAX;
        for (channel = 0; channel < 3; ++channel) {
            nits[channel] = (double)hdrp_min(c[channel] * scale, HDRP_I_IMAGE_NITS_MAX);
            sum.illuminance_lux[channel] += cosine_weight * nits[channel];
            sum.flux[channel] += solid_angle * nits[channel];
        }
        if (hdrp_i_image_luminance(nits) > sum.peak_nits) {
            sum.peak_nits = hdrp_i_image_luminance(nits);
            sum.peak_column = x;
        }
    }
    *result = sum;
}

HDRP_API hdrp_result hdrp_env_measure_rows(const hdrp_env_image* image, uint32_t first_row,
                                           uint32_t row_count, hdrp_env_row* rows)
{
    hdrp_result r = hdrp_i_image_check_rows(image, first_row, row_count);
    uint32_t row;
    if (r != HDRP_OK || !rows) {
        return r != HDRP_OK ? r : HDRP_ERROR_NULL_POINTER;
    }
    for (row = first_row; row < first_row + row_count; ++row) {
        hdrp_i_image_measure_row(image, row, rows + row);
    }
    return HDRP_OK;
}

static void hdrp_i_image_add_row(hdrp_env_stats* stats, const hdrp_env_row* row, uint32_t index)
{
    int channel;
    for (channel = 0; channel < 3; ++channel) {
        stats->illuminance_lux_rgb[channel] += row->illuminance_lux[channel];
        stats->average_nits_rgb[channel] += row->flux[channel] / (4.0 * 3.14159265358979324);
    }
    if (row->peak_nits > stats->peak_nits) {
        stats->peak_nits = row->peak_nits;
        stats->peak_row = index;
        stats->peak_column = row->peak_column;
    }
    stats->invalid_texels += row->invalid_texels;
    stats->limited_texels += row->limited_texels;
    stats->illuminance_lux = hdrp_i_image_luminance(stats->illuminance_lux_rgb);
    stats->average_nits = hdrp_i_image_luminance(stats->average_nits_rgb);
}

HDRP_API hdrp_result hdrp_env_stats_from_rows(const hdrp_env_image* image, const hdrp_env_row* rows,
                                              hdrp_env_stats* stats)
{
    hdrp_result r = hdrp_env_image_check(image);
    uint32_t row;
    if (r != HDRP_OK || !rows || !stats) {
        return r != HDRP_OK ? r : HDRP_ERROR_NULL_POINTER;
    }
    memset(stats, 0, sizeof *stats);
    for (row = 0u; row < hdrp_env_image_rows(image); ++row) {
        hdrp_i_image_add_row(stats, rows + row, row);
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_env_measure(const hdrp_env_image* image, hdrp_env_stats* stats)
{
    hdrp_result r = hdrp_env_image_check(image);
    uint32_t row;
    if (r != HDRP_OK || !stats) {
        return r != HDRP_OK ? r : HDRP_ERROR_NULL_POINTER;
    }
    memset(stats, 0, sizeof *stats);
    for (row = 0u; row < hdrp_env_image_rows(image); ++row) {
        hdrp_env_row sum;
        hdrp_i_image_measure_row(image, row, &sum);
        hdrp_i_image_add_row(stats, &sum, row);
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_env_lux_multiplier(const hdrp_env_stats* stats, double wanted_lux,
                                             float* multiplier)
{
    double k;
    if (!stats || !multiplier) {
        return HDRP_ERROR_NULL_POINTER;
    }
    k = wanted_lux / stats->illuminance_lux;
    if (!(wanted_lux > 0.0 && wanted_lux <= 1e12) || stats->invalid_texels != 0u ||
        stats->limited_texels != 0u || !(stats->illuminance_lux > 0.0) || !(k <= 1e12) ||
        !(k >= 1e-30)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    *multiplier = (float)k;
    return HDRP_OK;
}

/* Sums over the texels of a disc or ring. */
typedef struct hdrp_i_image_disc {
    double solid_angle;
    double flux[3];      /* of what exceeds the background */
    double vector[3][3]; /* the same times direction, per channel */
    double bright;       /* solid angle where luminance exceeds half the peak */
} hdrp_i_image_disc;

/* Rows that can lie within an angle of a direction. */
static int hdrp_i_image_row_is_near(const hdrp_env_image* image, uint32_t row, hdrp_v3 centre,
                                    float radius_rad)
{
    float polar = ((float)row + 0.5f) * (HDRP_PI / (float)image->height);
    return image->kind == HDRP_ENV_CUBE ||
           hdrp_abs(polar - hdrp_env_latlong_from_direction(centre).y * HDRP_PI) <=
               radius_rad + HDRP_PI / (float)image->height;
}

/* Sums what exceeds the background where inner < angle <= outer. */
static hdrp_i_image_disc hdrp_i_image_sum_disc(const hdrp_env_image* image, hdrp_v3 centre,
                                               float inner_rad, float outer_rad,
                                               const double background[3], double peak_nits)
{
    hdrp_i_image_disc sum;
    float cos_inner = inner_rad > 0.0f ? hdrp_cos(inner_rad) : 2.0f;
    float cos_outer = outer_rad < HDRP_PI ? hdrp_cos(outer_rad) : -2.0f;
    uint32_t row, x;
    int channel;
    memset(&sum, 0, sizeof sum);
    for (row = 0u; row < hdrp_env_image_rows(image); ++row) {
        if (!hdrp_i_image_row_is_near(image, row, centre, outer_rad)) {
            continue;
        }
        for (x = 0u; x < image->width; ++x) {
            hdrp_v3 d = hdrp_i_image_texel_direction(image, row, x);
            float c = hdrp_v3_dot(d, centre);
            hdrp_v3 read = hdrp_env_image_texel(image, row, x);
            double nits[3], solid_angle, vertical;
            if (!(c >= cos_outer && c < cos_inner)) {
                continue;
            }
            nits[0] = (double)read.x;
            nits[1] = (double)read.y;
            nits[2] = (double)read.z;
            solid_angle = (double)hdrp_i_image_texel_solid_angle(image, row, x);
            /* The vertical share exactly as measuring weighs it. */
            vertical = d.y > 0.0f
                           ? (double)hdrp_i_image_texel_cosine_weight(image, row, x) / solid_angle
                           : (double)d.y;
            sum.solid_angle += solid_angle;
            sum.bright += hdrp_i_image_luminance(nits) > 0.5 * peak_nits ? solid_angle : 0.0;
            for (channel = 0; channel < 3; ++channel) {
                double over = nits[channel] - background[channel];
                over = over > 0.0 ? over * solid_angle : 0.0;
                sum.flux[channel] += over;
                sum.vector[channel][0] += over * (double)d.x;
                sum.vector[channel][1] += over * vertical;
                sum.vector[channel][2] += over * (double)d.z;
            }
        }
    }
    return sum;
}

/* Direction of the luminance of a disc. */
static hdrp_v3 hdrp_i_image_disc_direction(const hdrp_i_image_disc* disc, hdrp_v3 fallback)
{
    double v[3], length;
    int axis;
    for (axis = 0; axis < 3; ++axis) {
        double rgb[3];
        rgb[0] = disc->vector[0][axis];
        rgb[1] = disc->vector[1][axis];
        rgb[2] = disc->vector[2][axis];
        v[axis] = hdrp_i_image_luminance(rgb);
    }
    length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0.0)) {
        return fallback;
    }
    return hdrp_v3_make((float)(v[0] / length), (float)(v[1] / length), (float)(v[2] / length));
}

/* What is around a disc: the ring up to twice its radius; where that holds no texel, all that is
 * outside the disc; where that is nothing, the disc itself. */
static hdrp_i_image_disc hdrp_i_image_surroundings(const hdrp_env_image* image, hdrp_v3 centre,
                                                   float radius, double peak_nits)
{
    double none[3] = {0.0, 0.0, 0.0};
    hdrp_i_image_disc ring =
        hdrp_i_image_sum_disc(image, centre, radius, 2.0f * radius, none, peak_nits);
    if (!(ring.solid_angle > 0.0)) {
        ring = hdrp_i_image_sum_disc(image, centre, radius, HDRP_TWO_PI, none, peak_nits);
    }
    if (!(ring.solid_angle > 0.0)) {
        ring = hdrp_i_image_sum_disc(image, centre, 0.0f, HDRP_TWO_PI, none, peak_nits);
    }
    return ring;
}

HDRP_API hdrp_result hdrp_env_find_sun(const hdrp_env_image* image, float radius_rad,
                                       hdrp_env_sun* sun)
{
    hdrp_env_stats stats;
    hdrp_result r = hdrp_env_measure(image, &stats);
    double background[3];
    float radius, lux[3];
    hdrp_v3 centre;
    hdrp_i_image_disc disc;
    int pass, channel;
    if (r != HDRP_OK || !sun) {
        return r != HDRP_OK ? r : HDRP_ERROR_NULL_POINTER;
    }
    if (!(radius_rad >= 0.0f && radius_rad <= 0.5f) || stats.invalid_texels != 0u ||
        stats.limited_texels != 0u) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    radius =
        hdrp_max(radius_rad > 0.0f ? radius_rad : 0.035f,
                 1.5f * (image->kind == HDRP_ENV_CUBE ? 2.0f : HDRP_PI) / (float)image->height);
    radius = hdrp_min(radius, 0.5f);
    centre = hdrp_i_image_texel_direction(image, stats.peak_row, stats.peak_column);
    /* Twice: around the brightest texel, then around the middle of what was found there. */
    for (pass = 0; pass < 2; ++pass) {
        hdrp_i_image_disc ring = hdrp_i_image_surroundings(image, centre, radius, stats.peak_nits);
        for (channel = 0; channel < 3; ++channel) {
            background[channel] = ring.flux[channel] / ring.solid_angle;
        }
        disc = hdrp_i_image_sum_disc(image, centre, 0.0f, radius, background, stats.peak_nits);
        sun->centre = centre;
        centre = hdrp_i_image_disc_direction(&disc, centre);
    }
    sun->direction = centre;
    for (channel = 0; channel < 3; ++channel) {
        lux[channel] = (float)(disc.vector[channel][0] * (double)centre.x +
                               disc.vector[channel][1] * (double)centre.y +
                               disc.vector[channel][2] * (double)centre.z);
    }
    sun->illuminance_lux = hdrp_v3_make(lux[0], lux[1], lux[2]);
    sun->solid_angle_sr = (float)disc.bright;
    sun->share = stats.average_nits > 0.0
                     ? (float)(hdrp_i_image_luminance(disc.flux) / stats.average_nits) *
                           (0.25f * HDRP_INV_PI)
                     : 0.0f;
    sun->background_nits =
        hdrp_v3_make((float)background[0], (float)background[1], (float)background[2]);
    sun->cos_radius = hdrp_cos(radius);
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_env_remove_sun(const hdrp_env_image* image, const hdrp_env_sun* sun)
{
    hdrp_result r = hdrp_env_image_check(image);
    uint32_t row, x;
    float limit[3];
    if (r != HDRP_OK || !sun) {
        return r != HDRP_OK ? r : HDRP_ERROR_NULL_POINTER;
    }
    limit[0] = sun->background_nits.x / hdrp_i_image_scale(image);
    limit[1] = sun->background_nits.y / hdrp_i_image_scale(image);
    limit[2] = sun->background_nits.z / hdrp_i_image_scale(image);
    for (row = 0u; row < hdrp_env_image_rows(image); ++row) {
        if (!hdrp_i_image_row_is_near(image, row, sun->centre, hdrp_acos(sun->cos_radius))) {
            continue;
        }
        for (x = 0u; x < image->width; ++x) {
            hdrp_v3 d = hdrp_i_image_texel_direction(image, row, x);
            float* c = hdrp_i_image_stored(image, row, x);
            if (hdrp_v3_dot(d, sun->centre) >= sun->cos_radius) {
                c[0] = hdrp_min(c[0], limit[0]);
                c[1] = hdrp_min(c[1], limit[1]);
                c[2] = hdrp_min(c[2], limit[2]);
            }
        }
    }
    return HDRP_OK;
}

/* ---- sampling -------------------------------------------------------------------------------- */

HDRP_API size_t hdrp_env_sampler_memory_size(const hdrp_env_image* image)
{
    size_t rows = hdrp_env_image_rows(image);
    size_t limit = (size_t)-1 / 2u / sizeof(double);
    if (rows == 0u || rows + 1u > limit / ((size_t)image->width + 2u)) {
        return 0u;
    }
    return HDRP_MEMORY_ROUND_UP((rows + 1u) * sizeof(double) +
                                rows * ((size_t)image->width + 1u) * sizeof(float));
}

HDRP_API hdrp_result hdrp_env_sampler_init(hdrp_env_sampler* sampler, const hdrp_env_image* image,
                                           void* memory, size_t memory_bytes)
{
    hdrp_result r = hdrp_env_image_check(image);
    if (r != HDRP_OK || !sampler || !memory) {
        return r != HDRP_OK ? r : HDRP_ERROR_NULL_POINTER;
    }
    if (hdrp_env_sampler_memory_size(image) == 0u) {
        return HDRP_ERROR_TOO_LARGE;
    }
    if (((uintptr_t)memory & (HDRP_MEMORY_ALIGNMENT - 1u)) != 0u) {
        return HDRP_ERROR_MEMORY_ALIGNMENT;
    }
    if (memory_bytes < hdrp_env_sampler_memory_size(image)) {
        return HDRP_ERROR_MEMORY_TOO_SMALL;
    }
    sampler->image = *image;
    sampler->rows = (double*)memory;
    sampler->columns = (float*)(void*)(sampler->rows + hdrp_env_image_rows(image) + 1u);
    return HDRP_OK;
}

/* Luminance of the mean of the bilinear radiance over a texel: weights 1/8, 6/8, 1/8. */
static double hdrp_i_image_bilinear_mean(const hdrp_env_image* image, uint32_t row, uint32_t x)
{
    static const double weight[3] = {0.125, 0.75, 0.125};
    double sum = 0.0;
    int i, j;
    for (j = 0; j < 3; ++j) {
        for (i = 0; i < 3; ++i) {
            hdrp_v3 c = hdrp_i_image_read_wrapped(image, row / image->height, (int)x + i - 1,
                                                  (int)(row % image->height) + j - 1);
            double rgb[3];
            rgb[0] = (double)c.x;
            rgb[1] = (double)c.y;
            rgb[2] = (double)c.z;
            sum += weight[i] * weight[j] * hdrp_i_image_luminance(rgb);
        }
    }
    return sum;
}

HDRP_API hdrp_result hdrp_env_sampler_build(hdrp_env_sampler* sampler, uint32_t first_row,
                                            uint32_t row_count)
{
    hdrp_result r = sampler ? hdrp_i_image_check_rows(&sampler->image, first_row, row_count)
                            : HDRP_ERROR_NULL_POINTER;
    uint32_t row, x, w;
    if (r != HDRP_OK) {
        return r;
    }
    w = sampler->image.width;
    for (row = first_row; row < first_row + row_count; ++row) {
        float* column = sampler->columns + (size_t)row * (w + 1u);
        double sum = 0.0, running = 0.0, least;
        for (x = 0u; x < w; ++x) {
            double weight = hdrp_i_image_bilinear_mean(&sampler->image, row, x) *
                            (double)hdrp_i_image_texel_solid_angle(&sampler->image, row, x);
            column[x + 1u] = (float)weight;
            sum += weight;
        }
        /* Every texel gets four steps of a 24-bit fraction, so that rounding loses none. */
        least = sum > 0.0 ? sum / 4194304.0 : 1.0;
        column[0] = 0.0f;
        sampler->rows[row + 1u] = sum;
        sum += least * w;
        for (x = 0u; x < w; ++x) {
            running += (double)column[x + 1u] + least;
            column[x + 1u] = (float)(running / sum);
        }
        column[w] = 1.0f;
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_env_sampler_finish(hdrp_env_sampler* sampler)
{
    uint32_t row, rows;
    double sum = 0.0, running = 0.0;
    if (!sampler) {
        return HDRP_ERROR_NULL_POINTER;
    }
    rows = hdrp_env_image_rows(&sampler->image);
    for (row = 0u; row < rows; ++row) {
        sum += sampler->rows[row + 1u];
    }
    if (!(sum > 0.0)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    sampler->rows[0] = 0.0;
    for (row = 0u; row < rows; ++row) {
        running += sampler->rows[row + 1u];
        sampler->rows[row + 1u] = running / sum;
    }
    return HDRP_OK;
}

/* The density within a texel, of a probability. */
static float hdrp_i_image_density(const hdrp_env_image* image, uint32_t row, hdrp_env_place place,
                                  double probability)
{
    float n = (float)image->height;
    float s = 2.0f * place.u - 1.0f;
    float t = 2.0f * place.v - 1.0f;
    float k = 1.0f + s * s + t * t;
    if (image->kind == HDRP_ENV_LATLONG) {
        return (float)(probability /
                       (double)hdrp_env_latlong_solid_angle(row, image->width, image->height));
    }
    return (float)probability * (0.25f * n * n) * (k * hdrp_sqrt(k));
}

HDRP_API hdrp_env_sample hdrp_env_sampler_sample(const hdrp_env_sampler* sampler, float u1,
                                                 float u2)
{
    const hdrp_env_image* image = &sampler->image;
    uint32_t rows = hdrp_env_image_rows(image);
    uint32_t w = image->width;
    uint32_t low = 0u, high = rows, row, x;
    const float* column;
    double probability;
    hdrp_env_place place;
    hdrp_env_sample r;
    float down, right;
    u1 = hdrp_clamp(u1, 0.0f, 1.0f - 0.5f * HDRP_FLT_EPSILON);
    u2 = hdrp_clamp(u2, 0.0f, 1.0f - 0.5f * HDRP_FLT_EPSILON);
    while (high - low > 1u) {
        uint32_t middle = low + (high - low) / 2u;
        if (sampler->rows[middle] <= (double)u1) {
            low = middle;
        } else {
            high = middle;
        }
    }
    row = low;
    column = sampler->columns + (size_t)row * (w + 1u);
    for (low = 0u, high = w; high - low > 1u;) {
        uint32_t middle = low + (high - low) / 2u;
        if (column[middle] <= u2) {
            low = middle;
        } else {
            high = middle;
        }
    }
    x = low;
    probability = sampler->rows[row + 1u] - sampler->rows[row];
    down = (float)(((double)u1 - sampler->rows[row]) / probability);
    right = (u2 - column[x]) / (column[x + 1u] - column[x]);
    probability *= (double)(column[x + 1u] - column[x]);
    place.face = row / image->height;
    place.u = ((float)x + right) / (float)w;
    place.v = ((float)(row % image->height) + down) / (float)image->height;
    if (image->kind == HDRP_ENV_CUBE) {
        r.direction = hdrp_env_direction_from_cube(place);
    } else {
        /* Even in solid angle: in the squared sine of half the polar angle. */
        float upper = hdrp_sq(hdrp_sin((float)row * (HDRP_HALF_PI / (float)rows)));
        float lower = hdrp_sq(hdrp_sin((float)(row + 1u) * (HDRP_HALF_PI / (float)rows)));
        float s2 = hdrp_saturate(hdrp_lerp(upper, lower, down));
        float across = 2.0f * hdrp_sqrt(s2 * (1.0f - s2));
        float longitude = (0.5f - place.u) * HDRP_TWO_PI;
        r.direction = hdrp_v3_make(across * hdrp_sin(longitude), 1.0f - 2.0f * s2,
                                   across * hdrp_cos(longitude));
    }
    r.radiance_nits = hdrp_env_image_radiance(image, r.direction);
    r.pdf_per_sr = hdrp_i_image_density(image, row, place, probability);
    return r;
}

HDRP_API float hdrp_env_sampler_pdf(const hdrp_env_sampler* sampler, hdrp_v3 direction)
{
    const hdrp_env_image* image = &sampler->image;
    hdrp_env_place place = hdrp_i_image_place(image, direction);
    uint32_t x = (uint32_t)(place.u * (float)image->width);
    uint32_t y = (uint32_t)(place.v * (float)image->height);
    uint32_t row;
    const float* column;
    x = x < image->width ? x : image->width - 1u;
    row = place.face * image->height + (y < image->height ? y : image->height - 1u);
    column = sampler->columns + (size_t)row * (image->width + 1u);
    return hdrp_i_image_density(image, row, place,
                                (sampler->rows[row + 1u] - sampler->rows[row]) *
                                    (double)(column[x + 1u] - column[x]));
}

#endif /* HDRP_ENV_IMPLEMENTATION */
