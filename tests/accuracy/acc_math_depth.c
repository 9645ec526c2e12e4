/* acc_math_depth.c - accuracy of device depth in hdrp_math.h.
 * SPDX-License-Identifier: MIT
 *
 * Referred to projection matrices: clip.z = a z + b, clip.w = z or 1, device depth their quotient.
 * The matrix is inverted here in double, where its cancellation does not matter. */
#include "accuracy.h"

#include "hdrp_math.h"

typedef struct projection {
    double a, b, near_m, far_m;
    bool flat;
    hdrp_depth_params params;
} projection;

/* a near + b and a far + b are the device depths of the planes times clip.w. */
static projection random_projection(acc* e, bool flat, bool reverse)
{
    projection p;
    float near_m = acc_float(acc_log_uniform(e, 1e-4, 1e3));
    float far_m = acc_float((double)near_m * acc_log_uniform(e, 2.01, 1e9));
    bool endless = !flat && acc_uniform(e, 0.0, 1.0) < 0.2;
    double at_near = reverse ? 1.0 : 0.0, at_far = 1.0 - at_near;
    p.near_m = (double)near_m;
    p.far_m = endless ? 1e300 : (double)far_m;
    p.flat = flat;
    if (endless) {
        p.a = at_far;
        p.b = p.near_m * (at_near - at_far);
        far_m = HDRP_DEPTH_INFINITE;
    } else if (flat) {
        p.a = (at_far - at_near) / (p.far_m - p.near_m);
        p.b = at_near - p.a * p.near_m;
    } else {
        p.a = (at_far * p.far_m - at_near * p.near_m) / (p.far_m - p.near_m);
        p.b = at_near * p.near_m - p.a * p.near_m;
    }
    p.params = flat ? hdrp_depth_params_orthographic(near_m, far_m, reverse ? 1u : 0u)
                    : hdrp_depth_params_perspective(near_m, far_m, reverse ? 1u : 0u);
    return p;
}

static void view_depth_error(acc* e)
{
    for (int i = 0; i < 200000; ++i) {
        bool flat = i & 1, reverse = i & 2;
        projection p = random_projection(e, flat, reverse);
        float d = acc_float(i & 4 ? acc_uniform(e, 0.0, 1.0) : acc_log_uniform(e, 1e-9, 1.0));
        double z = flat ? ((double)d - p.b) / p.a : p.b / ((double)d - p.a);
        double size = flat ? p.far_m : z;
        if (z < 0.9e18 && (reverse || d < 1.0f || !(p.far_m > 1e299))) {
            ACC_ADD(e, fabs((double)hdrp_view_depth(p.params, d) - z) / size,
                    "depth %.9g, near %.9g, far %.9g, %s %s", (double)d, p.near_m, p.far_m,
                    flat ? "orthographic" : "perspective", reverse ? "reverse" : "forward");
        }
    }
}

static void device_depth(acc* e, bool reverse)
{
    for (int i = 0; i < 200000; ++i) {
        bool flat = i & 1;
        projection p = random_projection(e, flat, reverse);
        double range = fmin(p.far_m, 1e12 * p.near_m) / p.near_m;
        float z = acc_float(p.near_m *
                            (i & 2 ? acc_log_uniform(e, 1.0, range) : acc_uniform(e, 1.0, range)));
        double d = flat ? p.a * (double)z + p.b : p.a + p.b / (double)z;
        d = fmin(fmax(d, 0.0), 1.0);
        double error = fabs((double)hdrp_device_depth(p.params, z) - d);
        double size = reverse && !flat ? fmax(d, p.near_m / p.far_m) : 1.0;
        ACC_ADD(e, error / size, "z = %.9g, near %.9g, far %.9g, %s", (double)z, p.near_m, p.far_m,
                flat ? "orthographic" : "perspective");
    }
}

static void device_depth_error(acc* e)
{
    device_depth(e, true);
}

static void device_depth_forward_error(acc* e)
{
    device_depth(e, false);
}

const acc_entry acc_math_depth[] = {{"view_depth", view_depth_error},
                                    {"device_depth", device_depth_error},
                                    {"device_depth_forward", device_depth_forward_error},
                                    {NULL, NULL}};
