/* acc_shadow.c - accuracy of hdrp_shadow.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_shadow.h"

static void split_at(acc* a, float n, float f, float share, float weight)
{
    double even = (double)n * (1.0 - (double)share) + (double)f * (double)share;
    double rising = exp(log((double)n) * (1.0 - (double)share) + log((double)f) * (double)share);
    double reference = even * (1.0 - (double)weight) + rising * (double)weight;
    ACC_ADD(a, acc_relative((double)hdrp_shadow_split(n, f, share, weight), reference),
            "near %.9g far %.9g share %.9g weight %.9g", (double)n, (double)f, (double)share,
            (double)weight);
}

static void split_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        double n = acc_log_uniform(a, 1e-6, 1e9);
        float f = acc_float(acc_log_uniform(a, n * 1.0001, 1.0002e9));
        split_at(a, acc_float(n), f < 1e9f ? f : 1e9f, acc_float(acc_uniform(a, 0.0, 1.0)),
                 acc_float(acc_uniform(a, 0.0, 1.0)));
    }
    for (int i = 0; i <= 4; ++i) {
        split_at(a, 1e-6f, 1e9f, (float)i / 4.0f, 1.0f);
        split_at(a, 0.1f, 500.0f, (float)i / 4.0f, 0.75f);
    }
}

/* Distance of the farthest corner from a centre on the axis. */
static double farthest(double c, double n, double f, double tangent)
{
    double to_near = hypot(n * tangent, n - c), to_far = hypot(f * tangent, f - c);
    return to_near > to_far ? to_near : to_far;
}

static void slice_perspective_at(acc* a, float n, float f, float x, float y)
{
    hdrp_v2 ball = hdrp_shadow_slice_perspective(n, f, x, y);
    double t = hypot((double)x, (double)y), lo = (double)n, hi = (double)f, best, r, c;
    for (int i = 0; i < 200; ++i) { /* it has one minimum */
        double p = lo + (hi - lo) / 3.0, q = hi - (hi - lo) / 3.0;
        if (farthest(p, (double)n, (double)f, t) < farthest(q, (double)n, (double)f, t)) {
            hi = q;
        } else {
            lo = p;
        }
    }
    best = farthest(0.5 * (lo + hi), (double)n, (double)f, t);
    r = fabs((double)ball.y - best);
    c = fabs(farthest((double)ball.x, (double)n, (double)f, t) - best);
    ACC_ADD(a, acc_larger(r, c) / (best + 0.1 * (double)f), "near %.9g far %.9g tangents %.9g %.9g",
            (double)n, (double)f, (double)x, (double)y);
}

static void slice_perspective_error(acc* a)
{
    for (int i = 0; i < 20000; ++i) {
        double n = acc_log_uniform(a, 1e-6, 9e8);
        float x = acc_float(acc_log_uniform(a, 1e-3, 16.0));
        float y = acc_float(acc_log_uniform(a, 1e-3, 16.0));
        slice_perspective_at(a, acc_float(n), acc_float(n * acc_log_uniform(a, 1.1, 1.11)), x, y);
        slice_perspective_at(a, acc_float(n), acc_float(acc_log_uniform(a, n * 1.01, 1e9)), x, y);
    }
    slice_perspective_at(a, 1e-6f, 1e9f, 16.0f, 16.0f);
    slice_perspective_at(a, 0.1f, 100.0f, 0.0f, 0.0f);
}

static void slice_orthographic_error(acc* a)
{
    for (int i = 0; i < 100000; ++i) {
        float n = acc_float(acc_log_uniform(a, 1e-6, 9e8));
        float f = acc_float((double)n * acc_log_uniform(a, 1.1, 1.11));
        float x = acc_float(acc_log_uniform(a, 1e-6, 1e9));
        float y = acc_float(acc_log_uniform(a, 1e-6, 1e9));
        hdrp_v2 ball = hdrp_shadow_slice_orthographic(n, f, x, y);
        double depth = 0.5 * ((double)f - (double)n);
        double r = acc_relative((double)ball.y, hypot(hypot((double)x, (double)y), depth));
        double c = acc_relative((double)ball.x, 0.5 * ((double)f + (double)n));
        ACC_ADD(a, acc_larger(r, c), "near %.9g far %.9g half %.9g %.9g", (double)n, (double)f,
                (double)x, (double)y);
    }
}

/* Integral of a tent from a to b, where it is straight: the trapezoid. */
static double straight(double a, double b, double h)
{
    double lo = a < -h ? -h : a, hi = b > h ? h : b;
    double at_lo = (h - fabs(lo)) / (h * h), at_hi = (h - fabs(hi)) / (h * h);
    return hi > lo ? 0.5 * (at_lo + at_hi) * (hi - lo) : 0.0;
}

static double tent(double a, double b, double h)
{
    return a < 0.0 && b > 0.0 ? straight(a, 0.0, h) + straight(0.0, b, h) : straight(a, b, h);
}

static double weight_of(hdrp_shadow_weights w, int i)
{
    const float all[6] = {w.even.x, w.odd.x, w.even.y, w.odd.y, w.even.z, w.odd.z};
    return (double)all[i];
}

static void weights_at(acc* a, hdrp_u32 kind, float fraction)
{
    hdrp_shadow_weights w = hdrp_shadow_weights_make(kind, fraction);
    double sum = 0.0, worst = 0.0, f = (double)fraction;
    for (int i = 0; i < 6; ++i) {
        double at = (double)w.base + i - f;
        double reference = tent(at - 0.5, at + 0.5, (double)kind - 0.5);
        if (kind < 2u) {
            reference = kind == 0u ? (i == (fraction < 0.5f ? 0 : 1) ? 1.0 : 0.0)
                                   : (i == 0   ? 1.0 - f
                                      : i == 1 ? f
                                               : 0.0);
        }
        sum += weight_of(w, i);
        worst = acc_larger(worst, fabs(weight_of(w, i) - reference));
    }
    ACC_ADD(a, acc_larger(worst, fabs(sum - 1.0)), "filter %u, fraction %.9g", kind, f);
}

static void weights_error(acc* a)
{
    for (hdrp_u32 kind = 0; kind < 4; ++kind) {
        for (int i = 0; i <= 20000; ++i) {
            weights_at(a, kind, (float)i / 20000.0f);
            weights_at(a, kind, acc_float(acc_uniform(a, 0.0, 1.0)));
        }
        weights_at(a, kind, 1e-30f);
        weights_at(a, kind, 0.99999994f);
    }
}

static void taps_error(acc* a)
{
    for (hdrp_u32 kind = 0; kind < 4; ++kind) {
        for (int i = 0; i <= 20000; ++i) {
            hdrp_shadow_weights w = hdrp_shadow_weights_make(kind, (float)i / 20000.0f);
            hdrp_shadow_taps t = hdrp_shadow_taps_make(w);
            const float weight[3] = {t.weight.x, t.weight.y, t.weight.z};
            const float place[3] = {t.place.x, t.place.y, t.place.z};
            double worst = 0.0;
            for (int k = 0; k < 3; ++k) {
                double share = (double)place[k] - ((double)w.base + 2.0 * k);
                double even = (double)weight[k] * (1.0 - share), odd = (double)weight[k] * share;
                worst = acc_larger(worst, fabs(even - weight_of(w, 2 * k)));
                worst = acc_larger(worst, fabs(odd - weight_of(w, 2 * k + 1)));
            }
            ACC_ADD(a, worst, "filter %u, fraction %.9g", kind, i / 20000.0);
        }
    }
}

const acc_entry acc_shadow[] = {
    {"shadow_split", split_error},
    {"shadow_slice_perspective", slice_perspective_error},
    {"shadow_slice_orthographic", slice_orthographic_error},
    {"shadow_weights", weights_error},
    {"shadow_taps", taps_error},
    {NULL, NULL},
};
