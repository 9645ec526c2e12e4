/* loops_pack_brdf.c - as loops.c, for codecs and lobes, for AVX2.
 * SPDX-License-Identifier: MIT */
#include "hdrp_pack.h"

#define COUNT 4096

extern float x[COUNT], y[COUNT], z[COUNT], out_a[COUNT], out_b[COUNT], out_c[COUNT];
float x[COUNT], y[COUNT], z[COUNT], out_a[COUNT], out_b[COUNT], out_c[COUNT];
extern hdrp_u32 u[COUNT], out_u[COUNT];
hdrp_u32 u[COUNT], out_u[COUNT];
extern hdrp_brdf_data d;
hdrp_brdf_data d;
extern hdrp_brdf_lit_view w;
hdrp_brdf_lit_view w;

#define XYZ hdrp_v3_make(x[i], y[i], z[i])
#define LOOP(name, body)                                                                           \
    void loop_##name(void);                                                                        \
    void loop_##name(void)                                                                         \
    {                                                                                              \
        for (int i = 0; i < COUNT; ++i) {                                                          \
            body;                                                                                  \
        }                                                                                          \
    }
#define LOOP_U(name, call) LOOP(name, out_u[i] = call)
#define LOOP_1(name, call) LOOP(name, out_a[i] = call)
#define LOOP_3(name, call)                                                                         \
    LOOP(name, hdrp_v3 v = call; out_a[i] = v.x; out_b[i] = v.y; out_c[i] = v.z)
#define LOOP_LIT(name, mask)                                                                       \
    LOOP(name, hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, XYZ, mask);                              \
         out_a[i] = r.diffuse.x + r.specular.x; out_b[i] = r.diffuse.y + r.specular.y;             \
         out_c[i] = r.diffuse.z + r.specular.z)

/* clang-format off */
LOOP_U(pack_oct_snorm_from_normal, hdrp_pack_oct_snorm_from_normal(XYZ, 12u))
LOOP_U(pack_oct_snorm_from_normal_exact, hdrp_pack_oct_snorm_from_normal_exact(XYZ, 12u))
LOOP_3(pack_normal_from_oct_snorm, hdrp_pack_normal_from_oct_snorm(u[i], 12u))
LOOP_U(pack_oct_unorm_from_normal, hdrp_pack_oct_unorm_from_normal(XYZ, 12u))
LOOP_U(pack_oct_unorm_from_normal_exact, hdrp_pack_oct_unorm_from_normal_exact(XYZ, 12u))
LOOP_3(pack_normal_from_oct_unorm, hdrp_pack_normal_from_oct_unorm(u[i], 12u))
LOOP_U(pack_half_from_float, hdrp_pack_half_from_float(x[i]))
LOOP_1(pack_float_from_half, hdrp_pack_float_from_half(u[i]))
LOOP_U(pack_r11g11b10f_from_rgb, hdrp_pack_r11g11b10f_from_rgb(XYZ))
LOOP_3(pack_rgb_from_r11g11b10f, hdrp_pack_rgb_from_r11g11b10f(u[i]))
LOOP_U(pack_unorm_from_float, hdrp_pack_unorm_from_float(x[i], 8u))
LOOP_3(normalize_or, hdrp_normalize_or(XYZ, hdrp_v3_splat(1.0f)))
LOOP_1(brdf_d_ggx, hdrp_brdf_d_ggx(x[i], y[i]))
LOOP_1(brdf_v_smith_ggx, hdrp_brdf_v_smith_ggx(x[i], y[i], z[i]))
LOOP_1(brdf_f_dielectric_exact, hdrp_brdf_f_dielectric_exact(x[i], 1.5f))
LOOP_1(brdf_f_conductor_exact, hdrp_brdf_f_conductor_exact(x[i], 0.2f, 3.9f))
LOOP_1(brdf_fgd_fast, hdrp_brdf_fgd_fast(x[i], y[i]).schlick)
LOOP_LIT(brdf_lit_eval, 0u)
LOOP_LIT(brdf_lit_eval_coat, HDRP_BRDF_FEATURE_CLEAR_COAT)
LOOP_LIT(brdf_lit_eval_anisotropy, HDRP_BRDF_FEATURE_ANISOTROPY)
LOOP_LIT(brdf_lit_eval_transmission, HDRP_BRDF_FEATURE_TRANSMISSION)
LOOP_LIT(brdf_lit_eval_refraction, HDRP_BRDF_FEATURE_REFRACTION)
LOOP_LIT(brdf_lit_eval_all, HDRP_BRDF_FEATURE_ALL)
