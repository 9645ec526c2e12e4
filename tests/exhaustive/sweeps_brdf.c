/* sweeps_brdf.c - functions of one float of hdrp_brdf_lobes.h.
 * SPDX-License-Identifier: MIT */
#include "exhaustive.h"

#include "hdrp_brdf_lobes.h"

EX_VALUES(brdf_schlick_weight, hdrp_brdf_schlick_weight)
EX_ERROR(brdf_schlick_weight, ex_relative(EX_Y(0), exp(5.0 * log1p(-x))))

/* The reflectance of the IOR is the given one. */
EX_VALUES(brdf_ior_from_fresnel0, hdrp_brdf_ior_from_fresnel0)
static double brdf_ior_from_fresnel0_error(double x, const float* y)
{
    double r = (EX_Y(0) - 1.0) / (EX_Y(0) + 1.0);
    return ex_absolute(r * r, x);
}
EX_ERRORS(brdf_ior_from_fresnel0)

/* From air to the IOR of the F0, and from the coat to that. */
static double under_coat(double f0)
{
    double s = sqrt(f0), coat = 1.5;
    double r = (1.0 + s - coat * (1.0 - s)) / (1.0 + s + coat * (1.0 - s));
    return r * r;
}

EX_VALUES(brdf_fresnel0_under_coat_fast, hdrp_brdf_fresnel0_under_coat_fast)
EX_ERROR(brdf_fresnel0_under_coat_fast, ex_absolute(EX_Y(0), under_coat(x)))
EX_ERROR(brdf_fresnel0_under_coat_fast_upper, ex_absolute(EX_Y(0), under_coat(x)))

EX_VALUES(brdf_alpha_from_perceptual_roughness, hdrp_brdf_alpha_from_perceptual_roughness)
EX_ERROR(brdf_alpha_from_perceptual_roughness,
         ex_relative(EX_Y(0), ex_larger(x* x, (double)HDRP_ALPHA_MIN)))

/* Its error is a claim of hdrp_brdf_fgd_fast; here only that the coefficients are finite. */
static void brdf_fgd_fit_values(const float* restrict x, float* restrict y, int n)
{
    for (int i = 0; i < n; ++i) {
        hdrp_brdf_fgd_fit f = hdrp_brdf_fgd_fit_make(x[i]);
        float loss = f.loss_d.x + f.loss_d.y + f.loss_d.z;
        y[i] = f.mean_loss;
        y[EX_BLOCK + i] = f.mean_schlick;
        y[2 * EX_BLOCK + i] = loss;
    }
}

EX_VALUES(brdf_variance_from_average_normal, hdrp_brdf_variance_from_average_normal)

const ex_sweep ex_sweeps_brdf[] = {
    EX_SWEEP(hdrp_brdf_schlick_weight, brdf_schlick_weight,
             EX_CLAIM(brdf_schlick_weight, 0.0f, 0.99999994f)),
    EX_SWEEP(hdrp_brdf_ior_from_fresnel0, brdf_ior_from_fresnel0,
             EX_CLAIM(brdf_ior_from_fresnel0, 0.0f, 1.0f)),
    EX_SWEEP(hdrp_brdf_fresnel0_under_coat_fast, brdf_fresnel0_under_coat_fast,
             EX_CLAIM(brdf_fresnel0_under_coat_fast, 0.0f, 1.0f),
             EX_CLAIM(brdf_fresnel0_under_coat_fast_upper, 0.04f, 1.0f)),
    EX_SWEEP(hdrp_brdf_alpha_from_perceptual_roughness, brdf_alpha_from_perceptual_roughness,
             EX_CLAIM(brdf_alpha_from_perceptual_roughness, 0.0f, 1.0f)),
    {"hdrp_brdf_fgd_fit_make", "", 3, brdf_fgd_fit_values, {EX_NO_CLAIM}},
    EX_SWEEP(hdrp_brdf_variance_from_average_normal, brdf_variance_from_average_normal,
             EX_NO_CLAIM),
    {NULL, NULL, 0, NULL, {EX_NO_CLAIM}},
};
