#version 450
// The radiance cube from a latitude-longitude image; see env_resample.glsl. A thread makes a texel,
// from the texels of the image that it may share an area with.
// header: hdrp_gpu_vk_env.h
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "hdrp_env_image.h"
#include "env_resample.glsl"

layout(binding = 0) uniform texture2D image;

// A piece of a texel of the image, in texels of the cube from the corner of the one that is made. A
// quadrilateral cut by four lines has at most eight corners.
vec2 corners[8];
uint corner_count;

// Keeps what is above a limit on one axis (side 1), or below it (side -1).
void cut(int axis, float limit, float side)
{
    vec2 kept[8];
    uint count = 0u;
    for (uint i = 0u; i < corner_count; ++i) {
        vec2 p = corners[i];
        vec2 q = corners[i + 1u < corner_count ? i + 1u : 0u];
        float a = side * (p[axis] - limit);
        float b = side * (q[axis] - limit);
        if (a >= 0.0 && count < 8u) {
            kept[count++] = p;
        }
        if ((a > 0.0 && b < 0.0 || a < 0.0 && b > 0.0) && count < 8u) {
            vec2 c = p + a / (a - b) * (q - p);
            c[axis] = limit;
            kept[count++] = c;
        }
    }
    corner_count = count;
    for (uint i = 0u; i < count; ++i) {
        corners[i] = kept[i];
    }
}

void add_corners(uvec2 texel, vec3 nits)
{
    float twice_area = 0.0;
    vec2 sum = vec2(0.0);
    for (uint i = 2u; i < corner_count; ++i) {
        vec2 a = corners[i - 1u] - corners[0];
        vec2 b = corners[i] - corners[0];
        float twice = a.x * b.y - b.x * a.y;
        twice_area += twice;
        sum += twice * (a + b);
    }
    if (twice_area != 0.0) {
        vec2 at = corners[0] + sum / (3.0 * twice_area) + vec2(texel);
        add_piece(hdrp_abs(twice_area), 2.0 * at / float(cube.x) - 1.0, nits);
    }
}

// A corner of the image on the face, 2 u - 1 and 2 v - 1 there: column i of w, row j of h. Angles
// are counted from where they are small, in whole numbers.
vec2 corner_of(uint face, int i, int j, int w, int h)
{
    const int quarters[6] = int[](1, 3, 2, 2, 2, 4); // of the middle of the face, in longitude
    hdrp_sincos_result longitude =
        hdrp_sincos(HDRP_HALF_PI * float(quarters[face] * w - 4 * i) / float(w));
    if (face / 2u != 1u) {
        hdrp_sincos_result down = hdrp_sincos(HDRP_HALF_PI * float(2 * j - h) / float(h));
        return vec2(longitude.sine, down.sine / down.cosine) / longitude.cosine;
    }
    int from_pole = face == HDRP_ENV_FACE_POSITIVE_Y ? j : h - j;
    hdrp_sincos_result polar = hdrp_sincos(HDRP_PI * float(from_pole) / float(h));
    float radius = polar.sine / polar.cosine;
    return radius * vec2(longitude.sine, face == HDRP_ENV_FACE_POSITIVE_Y ? longitude.cosine
                                                                          : -longitude.cosine);
}

// Columns and rows of w by h that a texel of a side face may share an area with: x and y, z and w.
// s and t are its edges on the face.
vec4 range_of_side(uint face, vec2 s, vec2 t, float w, float h)
{
    const float middles[6] = float[](0.25, 0.75, 0.0, 0.0, 0.5, 1.0);
    float nearest = s.x * s.y > 0.0 ? hdrp_min(hdrp_abs(s.x), hdrp_abs(s.y)) : 0.0;
    float farthest = hdrp_max(hdrp_abs(s.x), hdrp_abs(s.y));
    float far = hdrp_sqrt(1.0 + farthest * farthest), near = hdrp_sqrt(1.0 + nearest * nearest);
    float upper = hdrp_atan2_exact(t.x < 0.0 ? near : far, -t.x);
    float lower = hdrp_atan2_exact(t.y < 0.0 ? far : near, -t.y);
    // v grows with the angle from +Y, u falls with longitude.
    return vec4(w * (middles[face] - hdrp_atan2_exact(s.y, 1.0) * HDRP_INV_TWO_PI),
                w * (middles[face] - hdrp_atan2_exact(s.x, 1.0) * HDRP_INV_TWO_PI),
                h * upper * HDRP_INV_PI, h * lower * HDRP_INV_PI);
}

// Likewise on a face of the y axis, where a texel is in one quarter of the circle or is all of it.
vec4 range_of_pole(uint face, vec2 s, vec2 t, float w, float h)
{
    vec2 low = vec2(s.x * s.y < 0.0 ? 0.0 : hdrp_min(hdrp_abs(s.x), hdrp_abs(s.y)),
                    t.x * t.y < 0.0 ? 0.0 : hdrp_min(hdrp_abs(t.x), hdrp_abs(t.y)));
    vec2 high = vec2(hdrp_max(hdrp_abs(s.x), hdrp_abs(s.y)), hdrp_max(hdrp_abs(t.x), hdrp_abs(t.y)));
    float begin = hdrp_atan2_exact(low.x, high.y), end = hdrp_atan2_exact(high.x, low.y);
    float nearest = hdrp_atan2_exact(length(low), 1.0) * HDRP_INV_PI;
    float farthest = hdrp_atan2_exact(length(high), 1.0) * HDRP_INV_PI;
    bool up = face == HDRP_ENV_FACE_POSITIVE_Y;
    bool front = (t.x + t.y > 0.0) == up; // at longitudes around +Z
    bool left = s.x + s.y > 0.0;          // at positive longitudes, in the left half of the image
    vec2 columns = front ? vec2(begin, end) : vec2(HDRP_PI - end, HDRP_PI - begin);
    columns = left ? 0.5 - columns.yx * HDRP_INV_TWO_PI : 0.5 + columns * HDRP_INV_TWO_PI;
    columns = cube.x == 1u ? vec2(0.0, 1.0) : columns;
    vec2 rows = up ? vec2(nearest, farthest) : vec2(1.0 - farthest, 1.0 - nearest);
    return vec4(w * columns, h * rows);
}

void main()
{
    uint face;
    uvec2 texel;
    if (!env_place_of_thread(face, texel)) {
        return;
    }
    // Split, their curved edges are straight enough.
    int w = int(picture.x * picture.z), h = int(picture.y * picture.w);
    vec2 low = 2.0 * vec2(texel) / float(cube.x) - 1.0;
    vec2 high = 2.0 * vec2(texel + 1u) / float(cube.x) - 1.0;
    vec2 s = vec2(low.x, high.x), t = vec2(low.y, high.y);
    bool pole = face / 2u == 1u;
    vec4 range = pole ? range_of_pole(face, s, t, float(w), float(h))
                      : range_of_side(face, s, t, float(w), float(h));
    // Rounding moves an end by less than a hundredth of a texel of the largest image.
    ivec4 r = ivec4(floor(range.x - 0.02), ceil(range.y + 0.02), max(floor(range.z - 0.02), 0.0),
                    min(ceil(range.w + 0.02), float(h)));
    if (pole && cube.x == 1u) {
        r.xy = ivec2(0, w);
    }
    for (int j = r.z; j < r.w; ++j) {
        vec2 upper_left = corner_of(face, r.x, j, w, h);
        vec2 lower_left = corner_of(face, r.x, j + 1, w, h);
        for (int i = r.x; i < r.y; ++i) {
            vec2 upper = corner_of(face, i + 1, j, w, h), lower = corner_of(face, i + 1, j + 1, w, h);
            float k = 0.5 * float(cube.x);
            vec2 shift = k - vec2(texel);
            corners[0] = k * lower_left + shift;
            corners[1] = k * upper_left + shift;
            corners[2] = k * upper + shift;
            corners[3] = k * lower + shift;
            corner_count = 4u;
            upper_left = upper;
            lower_left = lower;
            vec2 least = min(min(corners[0], corners[1]), min(corners[2], corners[3]));
            vec2 most = max(max(corners[0], corners[1]), max(corners[2], corners[3]));
            if (any(greaterThanEqual(least, vec2(1.0))) || any(lessThanEqual(most, vec2(0.0)))) {
                continue;
            }
            for (int axis = 0; axis < 2; ++axis) {
                if (least[axis] < 0.0) {
                    cut(axis, 0.0, 1.0);
                }
                if (most[axis] > 1.0) {
                    cut(axis, 1.0, -1.0);
                }
            }
            ivec2 at = ivec2((i + w) % w / int(picture.z), j / int(picture.w));
            add_corners(texel, nits_of(texelFetch(image, at, 0).xyz));
        }
    }
    env_store(face, texel);
}
