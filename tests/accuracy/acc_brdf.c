/* acc_brdf.c - accuracy of hdrp_brdf.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_brdf.h"

static void diffuse_color_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float base = acc_float(acc_uniform(a, 0.0, 1.0)),
              metallic = acc_float(acc_uniform(a, 0.0, 1.0));
        double reference = (double)base - (double)base * (double)metallic;
        float measured = hdrp_brdf_diffuse_color(hdrp_v3_splat(base), metallic).x;
        ACC_ADD(a, fabs((double)measured - reference), "base %.9g, metallic %.9g", (double)base,
                (double)metallic);
    }
}

static void fresnel0_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float base = acc_float(acc_uniform(a, 0.0, 1.0)),
              metallic = acc_float(acc_uniform(a, 0.0, 1.0));
        float f0 = acc_float(acc_uniform(a, 0.0, 1.0));
        double reference = (double)f0 + ((double)base - (double)f0) * (double)metallic;
        hdrp_v3 measured = hdrp_brdf_fresnel0(hdrp_v3_splat(base), metallic, hdrp_v3_splat(f0));
        ACC_ADD(a, fabs((double)measured.y - reference), "base %.9g, metallic %.9g, F0 %.9g",
                (double)base, (double)metallic, (double)f0);
    }
}

/* The specular colour that the result stands for: 0.04 (1 - m) + base m, with the base that gives
 * the diffuse colour. */
static void metallic_error(acc* a, double lo, double hi)
{
    for (int i = 0; i < 400000; ++i) {
        double metallic = acc_uniform(a, lo, hi), base = acc_uniform(a, 0.04, 1.0);
        float diffuse = acc_float(base * (1.0 - metallic));
        float specular = acc_float(0.04 + (base - 0.04) * metallic);
        double m = (double)hdrp_brdf_metallic_from_colors(diffuse, specular);
        double back = 0.04 * (1.0 - m) + (double)diffuse / (1.0 - m) * m;
        ACC_ADD(a, fabs(back - (double)specular), "diffuse %.9g, specular %.9g", (double)diffuse,
                (double)specular);
    }
}

static void metallic_from_colors_error(acc* a)
{
    metallic_error(a, 0.0, 0.99);
}

static void metallic_from_colors_metal_error(acc* a)
{
    metallic_error(a, 0.99, 0.999);
}

/* Reflected is what is not transmitted: 1 - 4 n / (n + 1)^2. */
static void dielectric_fresnel0_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float ior = acc_float(acc_uniform(a, 1.0, 4.0)), tint = acc_float(acc_uniform(a, 0.0, 2.0));
        float weight = acc_float(acc_uniform(a, 0.0, 1.0));
        double n = (double)ior, f0 = 1.0 - 4.0 * n / ((n + 1.0) * (n + 1.0));
        double reference = fmin((double)tint * f0, 1.0) * (double)weight;
        float m = hdrp_brdf_dielectric_fresnel0(ior, hdrp_v3_splat(tint), weight).z;
        ACC_ADD(a, fabs((double)m - reference), "IOR %.9g, tint %.9g, weight %.9g", n, (double)tint,
                (double)weight);
    }
}

const acc_entry acc_brdf[] = {
    {"brdf_diffuse_color", diffuse_color_error},
    {"brdf_fresnel0", fresnel0_error},
    {"brdf_metallic_from_colors", metallic_from_colors_error},
    {"brdf_metallic_from_colors_metal", metallic_from_colors_metal_error},
    {"brdf_dielectric_fresnel0", dielectric_fresnel0_error},
    {NULL, NULL},
};
