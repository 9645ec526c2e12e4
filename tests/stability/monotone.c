/* monotone.c - formulas that must rise or fall with a parameter: monotone [FORMULA...]
 * SPDX-License-Identifier: MIT
 *
 * Compares neighbouring floats: 4096 runs of 512 of them, spread evenly over the floats of the range,
 * the first and last 65536, and those around round numbers, where formulas like to change branches
 * (16 in each octave, thousandths, and the knees of sRGB); and neighbours of a grid of 2^20 floats. The largest step in the
 * wrong direction must not exceed what the table allows. Prints a CSV line per formula:
 *
 *     formula,parameter,direction,from,to,allowed_ulp,worst_ulp,at
 *
 * Steps are in units in the last place of the result; sums of several terms may take a step back of
 * a few where their roundings differ. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "hdrp_brdf.h"
#include "hdrp_env.h"
#include "hdrp_light.h"
#include "hdrp_pack.h"

typedef struct rule {
    const char *formula, *parameter;
    double (*f)(float x);
    float from, to;
    int direction;  /* 1 rises, -1 falls */
    double allowed; /* units in the last place */
} rule;

#define CALL(name, expression)                                                                     \
    static double name(float x)                                                                    \
    {                                                                                              \
        return (double)(expression);                                                               \
    }

CALL(acos_fast, hdrp_acos_fast(x))
CALL(atan2_fast, hdrp_atan2_fast(x, 1.0f))
CALL(exp2_fast, hdrp_exp2_fast(x))
CALL(log2_fast, hdrp_log2_fast(x))
CALL(pow_fast, hdrp_pow_fast(x, 2.2f))
CALL(rsqrt, hdrp_rsqrt(x))
CALL(rsqrt_fast, hdrp_rsqrt_fast(x))
CALL(linear_from_srgb, hdrp_linear_from_srgb(x))
CALL(srgb_from_linear, hdrp_srgb_from_linear(x))
CALL(linear_from_srgb_fast, hdrp_linear_from_srgb_fast(x))
CALL(srgb_from_linear_fast, hdrp_srgb_from_linear_fast(x))

static double red_over_blue(float kelvin)
{
    hdrp_v3 c = hdrp_rec709_from_kelvin(kelvin);
    return (double)c.x / fmax((double)c.z, 1e-6);
}

static double red_over_blue_fast(float kelvin)
{
    hdrp_v3 c = hdrp_rec709_from_kelvin_fast(kelvin);
    return (double)c.x / fmax((double)c.z, 1e-6);
}

/* From the centre of the square to an edge: from the pole to the horizon. */
CALL(hemisphere_cosine_z, hdrp_hemisphere_cosine(hdrp_v2_make(0.5f, x)).z)
CALL(hemisphere_uniform_z, hdrp_hemisphere_uniform(hdrp_v2_make(0.3f, x)).z)
CALL(sphere_uniform_z, hdrp_sphere_uniform(hdrp_v2_make(0.3f, x)).z)
CALL(schlick_weight, hdrp_brdf_schlick_weight(x))
CALL(f_schlick, hdrp_brdf_f_schlick(0.04f, 1.0f, x))
CALL(f_dielectric, hdrp_brdf_f_dielectric_exact(x, 1.5f))
CALL(fresnel0_from_ior, hdrp_brdf_fresnel0_from_ior(x, 1.0f))
CALL(ior_from_fresnel0, hdrp_brdf_ior_from_fresnel0(x))
CALL(under_coat, hdrp_brdf_fresnel0_under_coat_fast(x))
CALL(refracted_cosine, hdrp_brdf_refracted_cosine(x, 1.5f))
CALL(alpha, hdrp_brdf_alpha_from_perceptual_roughness(x))
CALL(d_ggx, hdrp_brdf_d_ggx(x, 0.25f))
CALL(d_ggx_narrow, hdrp_brdf_d_ggx(x, 1e-4f))
CALL(v_smith, hdrp_brdf_v_smith_ggx(x, 0.5f, 0.25f))
CALL(v_smith_fast, hdrp_brdf_v_smith_ggx_fast(x, 0.5f, 0.25f))
CALL(fgd_albedo, hdrp_brdf_fgd_fast(x, 0.5f).albedo)
CALL(fgd_albedo_roughness, hdrp_brdf_fgd_fast(0.5f, x).albedo)
CALL(transmittance, hdrp_brdf_volume_transmittance(hdrp_v3_splat(0.5f), 1.0f, x).x)
CALL(roughness_filtered, hdrp_brdf_perceptual_roughness_filtered(0.3f, x))
CALL(specular_occlusion, hdrp_brdf_specular_occlusion(x, 0.5f, 0.5f))
CALL(nits_from_ev100, hdrp_light_nits_from_ev100(x))
CALL(ev100_from_nits, hdrp_light_ev100_from_nits(x))
CALL(lux_from_ev100, hdrp_light_lux_from_ev100(x))
CALL(ev100_from_lux, hdrp_light_ev100_from_lux(x))
CALL(exposure_saturation, hdrp_light_exposure_saturation(x))
CALL(exposure_standard, hdrp_light_exposure_standard_output(x))
CALL(camera_shutter, hdrp_light_ev100_from_camera(8.0f, x, 100.0f))
CALL(solid_angle_cone, hdrp_light_solid_angle_cone(x))
CALL(window, hdrp_light_window(x, 0.01f))
CALL(falloff, hdrp_light_falloff(x, 0.01f))
CALL(falloff_infinite, hdrp_light_falloff(x, 0.0f))
CALL(falloff_gltf, hdrp_light_falloff_gltf(x, 0.01f))
CALL(lux_from_candela, hdrp_light_lux_from_candela(1.0f, x))
CALL(cone, hdrp_light_cone_attenuation(x, hdrp_light_cone_shape_make(0.3f, 0.6f)))
CALL(env_lod, hdrp_env_lod_from_perceptual_roughness(x, 7u))
CALL(env_roughness, hdrp_env_perceptual_roughness_from_lod(x, 7u))
CALL(half_code, hdrp_pack_half_from_float(x))
CALL(half_code_saturated, hdrp_pack_half_from_float_saturated(x))
CALL(r11_code, hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(x, 0.0f, 0.0f)) & 0x7ffu)
CALL(b10_code, hdrp_pack_r11g11b10f_from_rgb(hdrp_v3_make(0.0f, 0.0f, x)) >> 22)
CALL(unorm8_code, hdrp_pack_unorm_from_float(x, 8u))
CALL(unorm16_code, hdrp_pack_unorm_from_float(x, 16u))
CALL(srgb8_code, hdrp_pack_srgb8_from_linear(x))

/* Steps back allowed are those measured, rounded up: each is a fact about the formula. */
static const rule rules[] = {
    {"hdrp_acos_fast", "x", acos_fast, -1.0f, 1.0f, -1, 2},
    /* Two fits meet where y = x, each with its own error there. */
    {"hdrp_atan2_fast", "y over x", atan2_fast, -1e6f, 1e6f, 1, 18},
    {"hdrp_exp2_fast", "x", exp2_fast, -126.0f, 127.9999f, 1, 2},
    {"hdrp_log2_fast", "x", log2_fast, FLT_MIN, FLT_MAX, 1, 0},
    {"hdrp_pow_fast", "x; y = 2.2", pow_fast, 1e-6f, 1e6f, 1, 0},
    {"hdrp_rsqrt", "x", rsqrt, FLT_MIN, FLT_MAX, -1, 0},
    {"hdrp_rsqrt_fast", "x", rsqrt_fast, FLT_MIN, FLT_MAX, -1, 5},
    {"hdrp_linear_from_srgb", "srgb", linear_from_srgb, 0.0f, 1.0f, 1, 1},
    {"hdrp_srgb_from_linear", "x", srgb_from_linear, 0.0f, 1.0f, 1, 1},
    {"hdrp_linear_from_srgb_fast", "srgb", linear_from_srgb_fast, 0.0f, 1.0f, 1, 2},
    {"hdrp_srgb_from_linear_fast", "x", srgb_from_linear_fast, 0.0f, 1.0f, 1, 3},
    {"hdrp_rec709_from_kelvin", "kelvin; red over blue", red_over_blue, 2000.0f, 25000.0f, -1, 32},
    {"hdrp_rec709_from_kelvin_fast", "kelvin; red over blue", red_over_blue_fast, 2000.0f, 25000.0f,
     -1, 5},
    {"hdrp_hemisphere_cosine", "u.y; z", hemisphere_cosine_z, 0.5f, 1.0f, -1, 1},
    {"hdrp_hemisphere_uniform", "u.y; z", hemisphere_uniform_z, 0.0f, 1.0f, -1, 1},
    {"hdrp_sphere_uniform", "u.y; z", sphere_uniform_z, 0.0f, 1.0f, -1, 1},
    {"hdrp_brdf_schlick_weight", "u", schlick_weight, 0.0f, 1.0f, -1, 0},
    {"hdrp_brdf_f_schlick", "u", f_schlick, 0.0f, 1.0f, -1, 2},
    {"hdrp_brdf_f_dielectric_exact", "cos_theta_i", f_dielectric, 0.0f, 0.8f, -1, 4},
    {"hdrp_brdf_fresnel0_from_ior", "transmitted_ior", fresnel0_from_ior, 1.0f, 4.0f, 1, 4},
    {"hdrp_brdf_ior_from_fresnel0", "fresnel0", ior_from_fresnel0, 0.0f, 0.9f, 1, 0},
    {"hdrp_brdf_fresnel0_under_coat_fast", "fresnel0", under_coat, 0.04f, 1.0f, 1, 3},
    {"hdrp_brdf_refracted_cosine", "cos_theta", refracted_cosine, 0.0f, 1.0f, 1, 4},
    {"hdrp_brdf_alpha_from_perceptual_roughness", "perceptual_roughness", alpha, 0.0f, 1.0f, 1, 0},
    {"hdrp_brdf_d_ggx", "n_dot_h; alpha = 1/4", d_ggx, 0.0f, 1.0f, 1, 8},
    {"hdrp_brdf_d_ggx", "n_dot_h; alpha = 1e-4", d_ggx_narrow, 0.0f, 1.0f, 1, 7},
    {"hdrp_brdf_v_smith_ggx", "n_dot_l", v_smith, 1e-3f, 1.0f, -1, 0},
    {"hdrp_brdf_v_smith_ggx_fast", "n_dot_l", v_smith_fast, 1e-3f, 1.0f, -1, 0},
    {"hdrp_brdf_fgd_fast", "n_dot_v; albedo", fgd_albedo, 0.0f, 0.1f, -1, 2},
    {"hdrp_brdf_fgd_fast", "perceptual_roughness; albedo", fgd_albedo_roughness, 0.2f, 1.0f, -1, 9},
    {"hdrp_brdf_volume_transmittance", "path", transmittance, 0.0f, 100.0f, -1, 1},
    {"hdrp_brdf_perceptual_roughness_filtered", "variance", roughness_filtered, 0.0f, 1.0f, 1, 0},
    {"hdrp_brdf_specular_occlusion", "ambient_occlusion", specular_occlusion, 0.0f, 1.0f, 1, 1},
    {"hdrp_light_nits_from_ev100", "ev100", nits_from_ev100, -20.0f, 24.0f, 1, 0},
    {"hdrp_light_ev100_from_nits", "nits", ev100_from_nits, 1e-6f, 1e9f, 1, 1},
    {"hdrp_light_lux_from_ev100", "ev100", lux_from_ev100, -20.0f, 24.0f, 1, 0},
    {"hdrp_light_ev100_from_lux", "lux", ev100_from_lux, 1e-6f, 1e9f, 1, 1},
    {"hdrp_light_exposure_saturation", "ev100", exposure_saturation, -20.0f, 24.0f, -1, 0},
    {"hdrp_light_exposure_standard_output", "ev100", exposure_standard, -20.0f, 24.0f, -1, 0},
    {"hdrp_light_ev100_from_camera", "shutter_s", camera_shutter, 1e-5f, 60.0f, -1, 1},
    {"hdrp_light_solid_angle_cone", "full_angle_rad", solid_angle_cone, 0.0f, 6.2831f, 1, 5},
    {"hdrp_light_window", "distance_sq; range 10 m", window, 0.0f, 200.0f, -1, 5},
    {"hdrp_light_falloff", "distance_sq; range 10 m", falloff, 0.0f, 200.0f, -1, 6},
    {"hdrp_light_falloff", "distance_sq; no range", falloff_infinite, 0.0f, 1e18f, -1, 0},
    {"hdrp_light_falloff_gltf", "distance_sq; range 10 m", falloff_gltf, 0.0f, 200.0f, -1, 4},
    {"hdrp_light_lux_from_candela", "distance_m", lux_from_candela, 1e-3f, 1e9f, -1, 0},
    {"hdrp_light_cone_attenuation", "versine; edge 0.3 to 0.6 rad", cone, 0.0f, 1.0f, -1, 0},
    {"hdrp_env_lod_from_perceptual_roughness", "perceptual_roughness", env_lod, 0.0f, 1.0f, 1, 3},
    {"hdrp_env_perceptual_roughness_from_lod", "lod", env_roughness, 0.0f, 6.0f, 1, 0},
    {"hdrp_pack_half_from_float", "x", half_code, 0.0f, FLT_MAX, 1, 0},
    {"hdrp_pack_half_from_float_saturated", "x", half_code_saturated, 0.0f, FLT_MAX, 1, 0},
    {"hdrp_pack_r11g11b10f_from_rgb", "rgb.x; 11 bits", r11_code, 0.0f, FLT_MAX, 1, 0},
    {"hdrp_pack_r11g11b10f_from_rgb", "rgb.z; 10 bits", b10_code, 0.0f, FLT_MAX, 1, 0},
    {"hdrp_pack_unorm_from_float", "x; 8 bits", unorm8_code, 0.0f, 1.0f, 1, 0},
    {"hdrp_pack_unorm_from_float", "x; 16 bits", unorm16_code, 0.0f, 1.0f, 1, 0},
    {"hdrp_pack_srgb8_from_linear", "x", srgb8_code, 0.0f, 1.0f, 1, 0},
};

/* Floats in order: 0 and up, negative numbers below. */
static int64_t place_of(float x)
{
    uint32_t u;
    memcpy(&u, &x, sizeof u);
    return u & 0x80000000u ? -(int64_t)(u & 0x7fffffffu) : (int64_t)u;
}

static float float_at(int64_t place)
{
    uint32_t u = place < 0 ? 0x80000000u | (uint32_t)-place : (uint32_t)place;
    float x;
    memcpy(&x, &u, sizeof x);
    return x;
}

typedef struct worst {
    double ulps;
    float at;
} worst;

/* Follows the floats from one place to another. */
static worst follow(const rule* r, worst w, int64_t first, int64_t last, int64_t stride)
{
    double before = r->f(float_at(first));
    for (int64_t place = first + stride; place <= last; place += stride) {
        double now = r->f(float_at(place)), back = (before - now) * r->direction;
        if (!(back <= 0.0)) {
            int exponent;
            frexp(fmax(fmax(fabs(before), fabs(now)), (double)FLT_MIN), &exponent);
            double ulps = back / ldexp(1.0, exponent - 24);
            if (!(ulps <= w.ulps)) {
                w.ulps = ulps;
                w.at = float_at(place);
            }
        }
        before = now;
    }
    return w;
}

/* The floats around x, as far as the range goes. */
static worst follow_around(const rule* r, worst w, float x)
{
    int64_t first = place_of(x) - 4, last = first + 8;
    bool inside = first >= place_of(r->from) && last <= place_of(r->to);
    return inside ? follow(r, w, first, last, 1) : w;
}

static worst follow_round_numbers(const rule* r, worst w)
{
    for (uint32_t u = 16; u < 255u << 4; ++u) {
        float x = float_at((int64_t)u << 19);
        w = follow_around(r, follow_around(r, w, x), -x);
    }
    for (int i = 1; i < 2000; ++i) {
        w = follow_around(r, follow_around(r, w, (float)i * 1e-3f), (float)i * -1e-3f);
    }
    return follow_around(r, follow_around(r, w, 0.0031308f), 0.04045f);
}

int main(int argc, char** argv)
{
    int failures = 0;
    printf("formula,parameter,direction,from,to,allowed_ulp,worst_ulp,at\n");
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; ++i) {
        const rule* r = &rules[i];
        if (argc > 1 && strcmp(argv[1], r->formula) != 0) {
            continue;
        }
        int64_t first = place_of(r->from), last = place_of(r->to), span = last - first;
        worst w = {0.0, 0.0f};
        w = follow(r, w, first, last, span >> 20 ? span >> 20 : 1);
        w = follow(r, w, first, first + (span < 65536 ? span : 65536), 1);
        w = follow(r, w, last - (span < 65536 ? span : 65536), last, 1);
        w = follow_round_numbers(r, w);
        for (int64_t run = 0; run < 4096; ++run) {
            int64_t begin = first + (span - 512) / 4096 * run;
            w = follow(r, w, begin, begin + 512, 1);
        }
        bool good = w.ulps <= r->allowed;
        failures += !good;
        printf("%s,%s,%s,%.6g,%.6g,%g,%.3g,%.9g\n", r->formula, r->parameter,
               r->direction > 0 ? "rises" : "falls", (double)r->from, (double)r->to, r->allowed,
               w.ulps, (double)w.at);
        if (!good) {
            fprintf(stderr, "monotone: %s takes a step back of %.3g ulp at %.9g (%a)\n", r->formula,
                    w.ulps, (double)w.at, (double)w.at);
        }
    }
    return failures != 0;
}
