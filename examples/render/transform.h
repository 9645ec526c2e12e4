/* Affine transforms of the scene graph. */
#ifndef RD_TRANSFORM_H
#define RD_TRANSFORM_H

#include "hdrp_math.h"

/* x, y and z are the images of the axes, t that of the origin: columns of a 3x4 matrix. */
typedef struct rd_affine {
    hdrp_v3 x, y, z, t;
} rd_affine;

static inline rd_affine rd_affine_identity(void)
{
    rd_affine a;
    a.x = hdrp_v3_make(1.0f, 0.0f, 0.0f);
    a.y = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    a.z = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    a.t = hdrp_v3_make(0.0f, 0.0f, 0.0f);
    return a;
}

static inline hdrp_v3 rd_affine_vector(rd_affine a, hdrp_v3 v)
{
    return hdrp_v3_mad(hdrp_v3_mad(hdrp_v3_scale(a.x, v.x), a.y, v.y), a.z, v.z);
}

static inline hdrp_v3 rd_affine_point(rd_affine a, hdrp_v3 p)
{
    return hdrp_v3_add(rd_affine_vector(a, p), a.t);
}

/* First b, then a. */
static inline rd_affine rd_affine_mul(rd_affine a, rd_affine b)
{
    rd_affine r;
    r.x = rd_affine_vector(a, b.x);
    r.y = rd_affine_vector(a, b.y);
    r.z = rd_affine_vector(a, b.z);
    r.t = rd_affine_point(a, b.t);
    return r;
}

static inline float rd_affine_determinant(rd_affine a)
{
    return hdrp_v3_dot(a.x, hdrp_v3_cross(a.y, a.z));
}

/* Normals go with the inverse transpose: the cofactors, with the sign of the determinant. */
static inline hdrp_v3 rd_affine_normal(rd_affine a, hdrp_v3 n)
{
    float s = hdrp_sign_not_zero(rd_affine_determinant(a));
    hdrp_v3 r = hdrp_v3_scale(hdrp_v3_cross(a.y, a.z), n.x * s);
    r = hdrp_v3_mad(r, hdrp_v3_cross(a.z, a.x), n.y * s);
    r = hdrp_v3_mad(r, hdrp_v3_cross(a.x, a.y), n.z * s);
    return hdrp_normalize_or(r, n);
}

/* Scale s, then the rotation of the quaternion q (any length but 0), then the translation t. */
static inline rd_affine rd_affine_from_trs(hdrp_v3 t, hdrp_v4 q, hdrp_v3 s)
{
    rd_affine r;
    float k = 2.0f / hdrp_v4_dot(q, q);
    float xx = q.x * q.x * k, yy = q.y * q.y * k, zz = q.z * q.z * k;
    float xy = q.x * q.y * k, xz = q.x * q.z * k, yz = q.y * q.z * k;
    float wx = q.w * q.x * k, wy = q.w * q.y * k, wz = q.w * q.z * k;
    r.x = hdrp_v3_scale(hdrp_v3_make(1.0f - yy - zz, xy + wz, xz - wy), s.x);
    r.y = hdrp_v3_scale(hdrp_v3_make(xy - wz, 1.0f - xx - zz, yz + wx), s.y);
    r.z = hdrp_v3_scale(hdrp_v3_make(xz + wy, yz - wx, 1.0f - xx - yy), s.z);
    r.t = t;
    return r;
}

#endif
