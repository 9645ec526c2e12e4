/* brdf_test.h - what the tests of the BRDF headers share: random numbers and measured albedos.
 * SPDX-License-Identifier: MIT */
#ifndef BRDF_TEST_H
#define BRDF_TEST_H

#include "../brdf_quadrature.h"
#include "hdrp_brdf.h"

/* SplitMix64 (Steele, Lea and Flood 2014): every run sees the same numbers. */
static inline double bt_random(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static inline float bt_random_f(uint64_t* state)
{
    return (float)(bt_random(state) * 0.99999997);
}

static inline hdrp_v3 bt_v3(const double v[3])
{
    return hdrp_v3_make((float)v[0], (float)v[1], (float)v[2]);
}

/* A unit vector from the cosine of its angle to +Z and an azimuth. */
static inline hdrp_v3 bt_direction(double cosine, double azimuth)
{
    double s = sqrt((1.0 - cosine) * (1.0 + cosine));
    return hdrp_v3_make((float)(s * cos(azimuth)), (float)(s * sin(azimuth)), (float)cosine);
}

static inline double bt_component(hdrp_v3 v, int channel)
{
    return (double)(channel == 0 ? v.x : channel == 1 ? v.y : v.z);
}

/* One GGX lobe about +Z to gather points for: on the side of the light, and mirrored below. */
typedef struct bt_lobe {
    double at, ab;
    int below;
} bt_lobe;

/* Points that resolve several lobes at once, each with its density in all of them (the balance
 * heuristic of Veach 1997): visible normals per lobe and cosines on both sides, stratified. */
static inline int bt_mixed_points(const double v[3], const bt_lobe* lobes, int lobe_count, int side,
                                  bq_point* out)
{
    int count = 0;
    for (int source = 0; source < lobe_count + 2; ++source) {
        for (int k = 0; k < side * side; ++k) {
            double u = (k % side + 0.5) / side, w = (k / side + 0.5) / side, l[3];
            double phi = 2.0 * BQ_PI * u;
            if (source < lobe_count) {
                bt_lobe a = lobes[source];
                double s[3] = {a.at * v[0], a.ab * v[1], v[2]}, h[3], c = 0.0;
                double length = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
                double z = (1.0 - w) * (1.0 + s[2] / length) - s[2] / length;
                double r = sqrt(fmax(1.0 - z * z, 0.0));
                h[0] = a.at * (r * cos(phi) + s[0] / length);
                h[1] = a.ab * (r * sin(phi) + s[1] / length);
                h[2] = z + s[2] / length;
                length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
                for (int i = 0; i < 3; ++i) {
                    h[i] /= length;
                    c += h[i] * v[i];
                }
                for (int i = 0; i < 3; ++i) {
                    l[i] = 2.0 * c * h[i] - v[i];
                }
                if (l[2] <= 0.0) {
                    continue;
                }
                l[2] = a.below ? -l[2] : l[2];
            } else {
                l[0] = sqrt(w) * cos(phi);
                l[1] = sqrt(w) * sin(phi);
                l[2] = (source == lobe_count ? 1.0 : -1.0) * sqrt(1.0 - w);
            }
            double density = fabs(l[2]) / BQ_PI, lz = fabs(l[2]);
            for (int i = 0; i < lobe_count; ++i) {
                bt_lobe a = lobes[i];
                double h[3] = {l[0] + v[0], l[1] + v[1], lz + v[2]};
                double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
                for (int j = 0; j < 3; ++j) {
                    h[j] /= length;
                }
                double g = v[2] + sqrt(a.at * a.at * v[0] * v[0] + a.ab * a.ab * v[1] * v[1] +
                                       v[2] * v[2]);
                density += (l[2] < 0.0) == a.below ? 0.5 * bq_d(h, a.at, a.ab) / g : 0.0;
            }
            for (int i = 0; i < 3; ++i) {
                out[count].l[i] = l[i];
            }
            out[count++].weight = 1.0 / (density * side * side);
        }
    }
    return count;
}

static inline double bt_alpha(float perceptual_roughness)
{
    return (double)hdrp_brdf_alpha_from_perceptual_roughness(perceptual_roughness);
}

/* Points for all lobes of a material whose normals are +Z and whose tangent is +X, up to 40000. */
static inline int bt_lit_points(hdrp_brdf_data d, const double v[3], hdrp_u32 features,
                                bq_point* out)
{
    static bq_rule rule;
    double coat = bt_alpha(d.coat_perceptual_roughness), alpha = bt_alpha(d.perceptual_roughness);
    if (features & HDRP_BRDF_FEATURE_ANISOTROPY) {
        hdrp_brdf_alphas a = hdrp_brdf_alphas_kulla(d.perceptual_roughness, d.anisotropy);
        bt_lobe lobes[2] = {{(double)a.t, (double)a.b, 0}, {coat, coat, 0}};
        return bt_mixed_points(v, lobes, features & HDRP_BRDF_FEATURE_CLEAR_COAT ? 2 : 1, 96, out);
    }
    if (rule.polar == 0) {
        rule = bq_make(16, 12);
    }
    alpha = features & HDRP_BRDF_FEATURE_CLEAR_COAT ? fmin(alpha, coat) : alpha;
    if (features & HDRP_BRDF_FEATURE_REFRACTION) {
        float p = hdrp_brdf_refraction_perceptual_roughness(d.perceptual_roughness, d.ior);
        alpha = fmin(alpha, bt_alpha(p));
    }
    int count = bq_points(&rule, acos(v[2]), atan2(v[1], v[0]), alpha, out);
    for (int i = 0; i < count; ++i) {
        out[count + i] = out[i];
        out[count + i].l[2] = -out[i].l[2];
    }
    return features & (HDRP_BRDF_FEATURE_REFRACTION | HDRP_BRDF_FEATURE_TRANSMISSION) ? 2 * count
                                                                                      : count;
}

/* A material that nothing but its arguments describes. */
static inline hdrp_brdf_surface bt_surface(float base_color, float metallic,
                                           float dielectric_fresnel0, float perceptual_roughness)
{
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.base_color = hdrp_v3_splat(base_color);
    s.metallic = metallic;
    s.dielectric_fresnel0 = hdrp_v3_splat(dielectric_fresnel0);
    s.perceptual_roughness = perceptual_roughness;
    return s;
}

static inline hdrp_brdf_lit_view bt_view(hdrp_brdf_data d, hdrp_v3 v, hdrp_u32 features)
{
    float n_dot_v = hdrp_v3_dot(d.normal, v);
    return hdrp_brdf_lit_view_make(d, v, hdrp_brdf_fgd_fast(n_dot_v, d.perceptual_roughness),
                                   features);
}

static inline double bt_lit_sum(hdrp_brdf_lit r, int channel)
{
    return bt_component(r.diffuse, channel) + bt_component(r.specular, channel);
}

/* Chi-squared of a histogram, in standard deviations above what is expected of good samples. Bins
 * that expect less than 10 are put together. */
static inline double bt_chi_squared(const double* seen, const double* expected, int count)
{
    double chi2 = 0.0, freedom = -1.0, rest_seen = 0.0, rest = 0.0;
    for (int i = 0; i < count; ++i) {
        if (expected[i] < 10.0) {
            rest_seen += seen[i];
            rest += expected[i];
        } else {
            chi2 += (seen[i] - expected[i]) * (seen[i] - expected[i]) / expected[i];
            freedom += 1.0;
        }
    }
    chi2 += (rest_seen - rest) * (rest_seen - rest) / fmax(rest, 1.0);
    return (chi2 - freedom - 1.0) / sqrt(2.0 * freedom + 2.0);
}

#endif
