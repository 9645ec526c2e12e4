/* evaluate_brdf.c - the Lit model by itself: one light over car paint, and a white furnace.
 * SPDX-License-Identifier: MIT
 *
 *     cc -I. examples/evaluate_brdf.c -lm && ./a.out
 *
 * The furnace lights a material from all sides with a luminance of 1: what it reflects is its
 * albedo. Exits with 1 where a material gives back more than it receives, or where summing all
 * lights and the weights for a prefiltered environment disagree. */
#include "hdrp_brdf.h"

#include <math.h>
#include <stdio.h>

/* Only these features are compiled in: the mask is a constant. */
#define FEATURES HDRP_BRDF_FEATURE_CLEAR_COAT

static hdrp_brdf_data car_paint(void)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.base_color = hdrp_v3_make(0.75f, 0.04f, 0.03f);
    s.metallic = 0.5f;
    s.perceptual_roughness = 0.6f;
    s.coat_mask = 1.0f;
    s.coat_perceptual_roughness = 0.2f;
    s.features = HDRP_BRDF_FEATURE_CLEAR_COAT;
    return hdrp_brdf_data_from_surface(s);
}

static hdrp_v3 direction(float n_dot_x, float azimuth_rad)
{
    float sine = hdrp_sqrt(1.0f - n_dot_x * n_dot_x);
    return hdrp_v3_make(sine * cosf(azimuth_rad), sine * sinf(azimuth_rad), n_dot_x);
}

static hdrp_brdf_lit_view view_of(hdrp_brdf_data d, hdrp_v3 v)
{
    hdrp_brdf_fgd fgd = hdrp_brdf_fgd_fast(hdrp_v3_dot(d.normal, v), d.perceptual_roughness);
    return hdrp_brdf_lit_view_make(d, v, fgd, FEATURES);
}

/* Luminance per lux on the surface for lights in the plane of a view at 45 degrees. */
static void print_lobes(hdrp_brdf_data d)
{
    hdrp_brdf_lit_view w = view_of(d, direction(0.70710678f, HDRP_PI));
    printf("light, degrees    diffuse r g b             specular r g b\n");
    for (int degrees = -75; degrees <= 75; degrees += 15) {
        float angle = (float)degrees * (HDRP_PI / 180.0f);
        hdrp_brdf_lit r =
            hdrp_brdf_lit_eval(d, w, hdrp_v3_make(sinf(angle), 0.0f, cosf(angle)), FEATURES);
        printf("%8d       %7.4f %7.4f %7.4f   %7.4f %7.4f %7.4f\n", degrees, (double)r.diffuse.x,
               (double)r.diffuse.y, (double)r.diffuse.z, (double)r.specular.x, (double)r.specular.y,
               (double)r.specular.z);
    }
}

/* All lights of the hemisphere, in equal solid angles. */
static hdrp_v3 albedo_by_lights(hdrp_brdf_data d, hdrp_brdf_lit_view w)
{
    const int rings = 256, sectors = 512;
    hdrp_v3 sum = hdrp_v3_splat(0.0f);
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sectors; ++j) {
            hdrp_v3 l = direction(((float)i + 0.5f) / (float)rings,
                                  ((float)j + 0.5f) * (HDRP_TWO_PI / (float)sectors));
            hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, l, FEATURES);
            sum = hdrp_v3_add(sum, hdrp_v3_add(r.diffuse, r.specular));
        }
    }
    return hdrp_v3_scale(sum, HDRP_TWO_PI / (float)(rings * sectors));
}

/* What the environment's weights say about the same. */
static hdrp_v3 albedo_by_weights(hdrp_brdf_data d, hdrp_brdf_lit_view w)
{
    hdrp_brdf_lit_env e = hdrp_brdf_lit_env_make(d, w, FEATURES);
    hdrp_v3 below = hdrp_v3_add(e.specular_weight, e.diffuse_weight);
    return hdrp_v3_add(below, hdrp_v3_splat(e.coat_weight));
}

static int furnace_disagrees(hdrp_brdf_data d, float n_dot_v)
{
    hdrp_brdf_lit_view w = view_of(d, direction(n_dot_v, 0.0f));
    hdrp_v3 lights = albedo_by_lights(d, w), weights = albedo_by_weights(d, w);
    float apart = hdrp_v3_length(hdrp_v3_sub(lights, weights));
    printf("%8.2f       %7.4f %7.4f %7.4f   %7.4f %7.4f %7.4f\n", (double)n_dot_v, (double)lights.x,
           (double)lights.y, (double)lights.z, (double)weights.x, (double)weights.y,
           (double)weights.z);
    return !(hdrp_v3_max_component(lights) <= 1.005f) || !(apart <= 0.04f);
}

int main(void)
{
    hdrp_brdf_data paint = car_paint();
    int bad = 0;
    print_lobes(paint);
    printf("\n n_dot_v       albedo by lights r g b    by environment weights\n");
    for (int i = 1; i <= 5; ++i) {
        bad += furnace_disagrees(paint, 0.2f * (float)i);
    }
    return bad != 0;
}
