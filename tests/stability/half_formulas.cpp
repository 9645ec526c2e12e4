/* half_formulas.cpp - calls of the formulas of half_formulas.h; compiled twice.
 * SPDX-License-Identifier: MIT */
#include "half_formulas.h"

#include "half.hpp"

#ifdef HALF_PRECISION
#include "half_as_float.hpp"
#define half_eval half_eval_half
#else
#define half_eval half_eval_float
#endif
#include "hdrp_brdf.h"
#include "hdrp_light.h"
#include "hdrp_pack.h"

static hdrp_v3 v3(const double* in)
{
    return hdrp_v3_make((float)in[0], (float)in[1], (float)in[2]);
}

static void put(double out[3], hdrp_v3 v)
{
    out[0] = (double)v.x;
    out[1] = (double)v.y;
    out[2] = (double)v.z;
}

/* in: roughness, view, light, features. Everything that the features need is there and fixed. */
static hdrp_v3 lit(const double* in)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    uint32_t features = (uint32_t)in[7];
    s.base_color = hdrp_v3_make(0.8f, 0.5f, 0.25f);
    s.perceptual_roughness = (float)in[0];
    s.anisotropy = 0.5f;
    s.coat_mask = 1.0f;
    s.coat_perceptual_roughness = (float)in[0];
    s.film_mask = 1.0f;
    s.transmittance = hdrp_v3_make(0.75f, 0.5f, 0.25f);
    s.transmission = 0.5f;
    s.features = features;
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(s);
    hdrp_v3 v = v3(in + 1), l = v3(in + 4);
    hdrp_brdf_fgd fgd = hdrp_brdf_fgd_fast(hdrp_v3_dot(d.normal, v), d.perceptual_roughness);
    hdrp_brdf_lit_view w = hdrp_brdf_lit_view_make(d, v, fgd, features);
    hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, l, features);
    return hdrp_v3_add(r.diffuse, r.specular);
}

void half_eval(enum half_formula formula, const double* in, double out[3])
{
    const float x = (float)in[0], y = (float)in[1], z = (float)in[2];
    const float alpha = hdrp_brdf_alpha_from_perceptual_roughness(x);
    const float one = 1.0f, zero = 0.0f, anisotropy = 0.5f;
    const hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(x, anisotropy);
    float r = zero;
    out[1] = out[2] = 0.0;
    switch (formula) {
    case HALF_D:
        r = hdrp_brdf_d_ggx(y, alpha);
        break;
    case HALF_D_VECTORS:
        r = hdrp_brdf_d_ggx_vectors(v3(in + 1), v3(in + 4), alpha);
        break;
    case HALF_D_ANISO:
        r = hdrp_brdf_d_ggx_aniso(y, z, (float)in[3], a.t, a.b);
        break;
    case HALF_D_ANISO_VECTORS:
        r = hdrp_brdf_d_ggx_aniso_vectors(hdrp_v3_make(one, zero, zero),
                                          hdrp_v3_make(zero, one, zero),
                                          hdrp_v3_make(zero, zero, one), v3(in + 1), a.t, a.b);
        break;
    case HALF_V:
        r = hdrp_brdf_v_smith_ggx(y, z, alpha);
        break;
    case HALF_V_ANISO:
        r = hdrp_brdf_v_smith_ggx_aniso(y, z, (float)in[3], (float)in[4], (float)in[5],
                                        (float)in[6], a.t, a.b);
        break;
    case HALF_PDF_VNDF:
        r = hdrp_brdf_pdf_vndf(v3(in + 1), v3(in + 4), a.t, a.b);
        break;
    case HALF_FRESNEL:
        r = hdrp_brdf_f_schlick(y, one, x);
        break;
    case HALF_MULTISCATTER:
        r = hdrp_brdf_multiscatter(hdrp_brdf_fgd_fit_make(x), y, z, hdrp_v3_splat(one), one).x;
        break;
    case HALF_OCT_DECODE:
        put(out, hdrp_pack_normal_from_oct_snorm((uint32_t)in[1], (uint32_t)in[0]));
        return;
    case HALF_OCT_ROUND_TRIP:
        put(out,
            hdrp_pack_normal_from_oct_snorm(
                hdrp_pack_oct_snorm_from_normal(v3(in + 1), (uint32_t)in[0]), (uint32_t)in[0]));
        return;
    case HALF_FALLOFF:
        r = hdrp_light_falloff(x * x, zero);
        break;
    case HALF_WINDOW_OF_RANGE:
        r = hdrp_light_window(y * y, hdrp_light_inv_range_sq(x));
        break;
    case HALF_LUX:
        r = hdrp_light_lux_from_candela(y, x);
        break;
    case HALF_NITS:
        r = hdrp_light_nits_from_ev100(x);
        break;
    case HALF_EXPOSURE:
        r = hdrp_light_exposure_saturation(x);
        break;
    case HALF_POINT_LIGHT: {
        hdrp_light light =
            hdrp_light_point(hdrp_v3_splat(zero), hdrp_v3_splat(one), HDRP_LIGHT_RANGE_INFINITE);
        r = hdrp_light_eval_point(light, hdrp_v3_scale(v3(in + 1), x)).illuminance.x;
        break;
    }
    case HALF_LIT:
        put(out, lit(in));
        return;
    }
    out[0] = (double)r;
}
