/* acc_brdf.c - accuracy of hdrp_brdf.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_brdf.h"

static void diffuse_color_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float base = (float)acc_uniform(a, 0.0, 1.0), metallic = (float)acc_uniform(a, 0.0, 1.0);
        double reference = (double)base - (double)base * (double)metallic;
        float measured = hdrp_brdf_diffuse_color(hdrp_v3_splat(base), metallic).x;
        ACC_ADD(a, fabs((double)measured - reference), "base %.9g, metallic %.9g", (double)base,
                (double)metallic);
    }
}

static void fresnel0_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float base = (float)acc_uniform(a, 0.0, 1.0), metallic = (float)acc_uniform(a, 0.0, 1.0);
        float f0 = (float)acc_uniform(a, 0.0, 1.0);
        double reference = (double)f0 + ((double)base - (double)f0) * (double)metallic;
        hdrp_v3 measured = hdrp_brdf_fresnel0(hdrp_v3_splat(base), metallic, hdrp_v3_splat(f0));
        ACC_ADD(a, fabs((double)measured.y - reference), "base %.9g, metallic %.9g, F0 %.9g",
                (double)base, (double)metallic, (double)f0);
    }
}

const acc_entry acc_brdf[] = {
    {"brdf_diffuse_color", diffuse_color_error},
    {"brdf_fresnel0", fresnel0_error},
    {NULL, NULL},
};
