/* loops.c - one loop per line over each function that promises to vectorise.
 * SPDX-License-Identifier: MIT */
#include "hdrp_math.h"

#define COUNT 4096

extern float x[COUNT], y[COUNT], z[COUNT], out_a[COUNT], out_b[COUNT], out_c[COUNT];
float x[COUNT], y[COUNT], z[COUNT], out_a[COUNT], out_b[COUNT], out_c[COUNT];

#define LOOP(name, body)                                                                           \
    void loop_##name(void);                                                                        \
    void loop_##name(void)                                                                         \
    {                                                                                              \
        for (int i = 0; i < COUNT; ++i) {                                                          \
            body;                                                                                  \
        }                                                                                          \
    }
#define LOOP_3(name, call)                                                                         \
    LOOP(name, hdrp_v3 v = call; out_a[i] = v.x; out_b[i] = v.y; out_c[i] = v.z)
#define LOOP_SINCOS(name, call)                                                                    \
    LOOP(name, hdrp_sincos_result r = call; out_a[i] = r.sine; out_b[i] = r.cosine)

/* clang-format off */
LOOP(rsqrt, out_a[i] = hdrp_rsqrt(x[i]))
LOOP(rsqrt_fast, out_a[i] = hdrp_rsqrt_fast(x[i]))
LOOP(acos_fast, out_a[i] = hdrp_acos_fast(x[i]))
LOOP(atan2_fast, out_a[i] = hdrp_atan2_fast(x[i], y[i]))
LOOP(acos_exact, out_a[i] = hdrp_acos_exact(x[i]))
LOOP(atan2_exact, out_a[i] = hdrp_atan2_exact(x[i], y[i]))
LOOP(exp2_fast, out_a[i] = hdrp_exp2_fast(x[i]))
LOOP(log2_fast, out_a[i] = hdrp_log2_fast(x[i]))
LOOP(pow_fast, out_a[i] = hdrp_pow_fast(x[i], y[i]))
LOOP_SINCOS(sincos, hdrp_sincos(x[i]))
LOOP_SINCOS(sincos_fast, hdrp_sincos_fast(x[i]))
LOOP(linear_from_srgb_fast, out_a[i] = hdrp_linear_from_srgb_fast(x[i]))
LOOP(srgb_from_linear_fast, out_a[i] = hdrp_srgb_from_linear_fast(x[i]))
LOOP_3(linear_v3_fast, hdrp_v3_linear_from_srgb_fast(hdrp_v3_make(x[i], y[i], z[i])))
LOOP_3(rec709_from_kelvin, hdrp_rec709_from_kelvin(x[i]))
LOOP_3(rec709_from_kelvin_fast, hdrp_rec709_from_kelvin_fast(x[i]))
