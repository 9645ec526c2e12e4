/* acc_oit.c - accuracy of hdrp_oit.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_oit.h"

static double limited(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

static float opacity(acc* a, int i)
{
    const float known[4] = {0.0f, 1.0f, 0.5f, 0.003921569f};
    return i < 4 ? known[i] : acc_float(acc_uniform(a, 0.0, 1.0));
}

static double depth(acc* a, int i)
{
    const double known[4] = {0.0, 1e-6, 1e6, 1.0};
    return i % 1000 < 4 ? known[i % 1000] : acc_log_uniform(a, 1e-6, 1e6);
}

static void weight_of_depth(acc* a, float (*weight)(float, float), double near_scale,
                            double near_power, double far_power, double numerator)
{
    for (int i = 0; i < 100000; ++i) {
        float z = acc_float(depth(a, i)), alpha = opacity(a, i / 4 % 100);
        double below = 1e-5 + pow((double)z / 200.0, far_power);
        below += near_scale > 0.0 ? pow((double)z / near_scale, near_power) : 0.0;
        double reference = (double)alpha * limited(numerator / below, 0.01, 3000.0);
        ACC_ADD(a, acc_relative((double)weight(z, alpha), reference), "z %.9g alpha %.9g",
                (double)z, (double)alpha);
    }
}

static float eq7(float z, float alpha)
{
    return hdrp_oit_weight_eq7(z, alpha);
}

static float eq8(float z, float alpha)
{
    return hdrp_oit_weight_eq8(z, alpha);
}

static float eq9(float z, float alpha)
{
    return hdrp_oit_weight_eq9(z, alpha);
}

static void eq7_error(acc* a)
{
    weight_of_depth(a, eq7, 5.0, 2.0, 6.0, 10.0);
}

static void eq8_error(acc* a)
{
    weight_of_depth(a, eq8, 10.0, 3.0, 6.0, 10.0);
}

static void eq9_error(acc* a)
{
    weight_of_depth(a, eq9, 0.0, 0.0, 4.0, 0.03);
}

static void eq10_error(acc* a)
{
    for (int i = 0; i <= 100000; ++i) {
        float d = i & 1 ? (float)i / 100000.0f : acc_float(acc_uniform(a, 0.0, 1.0));
        float alpha = opacity(a, i % 100);
        double b = 3000.0 * pow(1.0 - (double)d, 3.0);
        ACC_ADD(a,
                acc_relative((double)hdrp_oit_weight_eq10(d, alpha),
                             (double)alpha * limited(b, 0.01, 3000.0)),
                "depth %.9g alpha %.9g", (double)d, (double)alpha);
    }
}

static void form_2015_error(acc* a)
{
    for (int i = 0; i <= 100000; ++i) {
        float d = i & 1 ? (float)i / 100000.0f : acc_float(acc_uniform(a, 0.0, 1.0));
        float alpha = acc_float(acc_log_uniform(a, 1e-6, 1.0));
        double covered = limited(10.0 * (double)alpha, 0.0, 1.0) + 0.01;
        double w = pow(covered * (1.0 - 0.9 * (double)d), 3.0) * 1e8;
        ACC_ADD(a, acc_relative((double)hdrp_oit_weight_2015(d, alpha), limited(w, 0.01, 3000.0)),
                "depth %.9g alpha %.9g", (double)d, (double)alpha);
    }
}

static void weight_error(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        float z = acc_float(depth(a, i)), alpha = opacity(a, i / 4 % 1000);
        double x = log(limited((double)z, 1e-6, 1e6)) / log(2.0), o = (double)alpha;
        double level =
            -7.2936 - 1.4768 * sqrt(o) - 0.7362 * o + 19.4126 * pow(o, 2.0) - 9.3971 * pow(o, 4.0);
        double slope =
            0.48 - 1.3173 * sqrt(o) + 1.3864 * o + 2.3104 * pow(o, 2.0) - 0.889 * pow(o, 8.0);
        double reference = exp(log(2.0) * limited(level - slope * x, -10.0, 4.0));
        ACC_ADD(a, acc_relative((double)hdrp_oit_weight(z, alpha), reference), "z %.9g alpha %.9g",
                (double)z, (double)alpha);
    }
}

/* The talk's own formula, with the canonical depth that it subtracts from 1. */
static void talk_weight_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        double e = acc_log_uniform(a, 1e-4, 10.0), feather = acc_uniform(a, 0.01, 1.0);
        hdrp_v3 emission = hdrp_v3_splat(i & 1 ? acc_float(e) : 0.0f);
        hdrp_oit_fragment f = hdrp_oit_fragment_make(hdrp_v3_splat(0.1f), emission,
                                                     acc_float(acc_uniform(a, 1e-3, 1.0)),
                                                     acc_float(acc_log_uniform(a, 0.1, 1000.0)));
        hdrp_oit_talk_settings s = hdrp_oit_talk_settings_make(acc_float(feather), 0.5f);
        double seen = limited(0.5 * (double)emission.x, 0.0, 1.0) * (double)s.emissive_sensitivity;
        double alpha = limited(3.0 * (double)f.alpha + seen, 0.0, 1.0);
        double z = limited(300.0 / 299.5 - 300.0 * 0.5 / ((double)f.z_view * 299.5), 0.0, 1.0);
        double w = limited(1e4 * pow(1.0 - z, 3.0) + 5.0, 0.0, 20.0) * pow(alpha, 3.0);
        ACC_ADD(a, acc_relative((double)hdrp_oit_talk_weight(f, s), w), "z %.9g alpha %.9g e %.9g",
                (double)f.z_view, (double)f.alpha, (double)emission.x);
    }
}

static void place_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        double n = acc_log_uniform(a, 1e-6, 9e5);
        float nearest = acc_float(n);
        float farthest = acc_float(acc_log_uniform(a, n * 1.01, 1e6));
        double at = log((double)nearest) +
                    acc_uniform(a, 0.0, 1.0) * log((double)farthest / (double)nearest);
        hdrp_oit_fragment f = hdrp_oit_fragment_make(hdrp_v3_splat(0.0f), hdrp_v3_splat(0.0f), 0.5f,
                                                     acc_float(exp(at)));
        double reference = limited(log((double)f.z_view / (double)nearest) /
                                       log((double)farthest / (double)nearest),
                                   0.0, 1.0);
        hdrp_oit_place p = hdrp_oit_place_of(f, hdrp_v2_make(-nearest, farthest));
        ACC_ADD(a, fabs((double)p.unit - reference), "from %.9g to %.9g at %.9g", (double)nearest,
                (double)farthest, (double)f.z_view);
    }
}

/* What is seen of layer i: through all intervals before its own, of which the farthest layer is in the
 * middle of the last, and through its own by how far in it the layer is. */
static double seen(const hdrp_oit_fragment* f, const hdrp_oit_place* p, int count, int i)
{
    double at = 15.5 * (double)p[i].unit, nearest = 0.0, before = 0.0, within = 0.0;
    for (int k = 0; k < count; ++k) {
        double absorbed = -log1p(-(double)f[k].alpha), bin = floor(15.5 * (double)p[k].unit);
        if (!(p[k].behind > 0.0f)) {
            nearest += absorbed;
        } else if (bin < floor(at)) {
            before += absorbed;
        } else if (bin == floor(at) && k != i) {
            within += absorbed;
        }
    }
    if (p[i].behind > 0.0f) {
        return exp(-nearest - before) * (1.0 - (at - floor(at)) * (1.0 - exp(-within)));
    }
    within = fmax(nearest * (1.0 - 0x1p-10) + log1p(-(double)f[i].alpha), 0.0);
    return p[i].front > 0.0f ? 1.0 - 0.75 * (1.0 - exp(-within)) : 1.0;
}

static hdrp_v4 add(hdrp_v4 a, hdrp_v4 b)
{
    return hdrp_v4_make(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w);
}

static void wavelet_error(acc* a)
{
    for (int i = 0; i < 20000; ++i) {
        hdrp_oit_fragment f[8];
        hdrp_oit_place p[8];
        hdrp_oit_wavelet w;
        hdrp_v2 range = hdrp_v2_make(-HDRP_OIT_NOTHING, 0.0f);
        memset(&w, 0, sizeof w);
        for (int k = 0; k < 8; ++k) {
            hdrp_v2 own;
            f[k] = hdrp_oit_fragment_make(hdrp_v3_splat(0.0f), hdrp_v3_splat(0.0f),
                                          acc_float(acc_uniform(a, 0.01, 0.99)),
                                          acc_float(acc_log_uniform(a, 1.0, 200.0)));
            own = hdrp_oit_range_export(f[k]);
            range = hdrp_v2_make(hdrp_max(range.x, own.x), hdrp_max(range.y, own.y));
        }
        for (int k = 0; k < 8; ++k) {
            hdrp_oit_wavelet own;
            p[k] = hdrp_oit_place_of(f[k], range);
            own = hdrp_oit_wavelet_insert(f[k], p[k]);
            w.coarse = add(w.coarse, own.coarse);
            w.eighths = add(w.eighths, own.eighths);
            w.finest_low = add(w.finest_low, own.finest_low);
            w.finest_high = add(w.finest_high, own.finest_high);
            w.front += own.front;
        }
        for (int k = 0; k < 8; ++k) {
            double through = (double)hdrp_oit_wavelet_transmittance(w, f[k], p[k]);
            ACC_ADD(a, fabs(through - seen(f, p, 8, k)), "layer %d of pixel %d", k, i);
        }
    }
}

const acc_entry acc_oit[] = {
    {"oit_weight_eq7", eq7_error},          {"oit_weight_eq8", eq8_error},
    {"oit_weight_eq9", eq9_error},          {"oit_weight_eq10", eq10_error},
    {"oit_weight_2015", form_2015_error},   {"oit_weight", weight_error},
    {"oit_talk_weight", talk_weight_error}, {"oit_place", place_error},
    {"oit_wavelet", wavelet_error},         {NULL, NULL},
};
