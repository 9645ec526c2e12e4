/* acc_math_colour.c - accuracy of colour and colour temperature of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "hdrp_math.h"
#include "planck.h"
#include "srgb_reference.h"

/* Uniform, in powers of ten, and around the end of the straight piece. */
static float unit_input(acc* a, int i, double knee)
{
    double x = acc_uniform(a, 0.0, 1.0);
    if (i % 4 == 1) {
        x = acc_log_uniform(a, 1e-45, 1.0);
    } else if (i % 4 == 2) {
        x = knee * acc_uniform(a, 0.999, 1.001);
    }
    return i == 0 ? 1.0f : (float)x;
}

static void linear_from_srgb_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        float c = unit_input(a, i, 0.04045);
        if (c > HDRP_FLT_MIN * 20.0f) {
            ACC_ADD(a, acc_relative((double)hdrp_linear_from_srgb(c), linear_from_srgb((double)c)),
                    "c = %.9g", (double)c);
        }
    }
}

static void linear_from_srgb_hdr_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        float c = acc_float(acc_log_uniform(a, 1.0, 1e16));
        ACC_ADD(a, acc_relative((double)hdrp_linear_from_srgb(c), linear_from_srgb((double)c)),
                "c = %.9g", (double)c);
    }
}

static void srgb_from_linear_error(acc* a)
{
    for (int i = 0; i < 800000; ++i) {
        float x =
            i % 2 ? unit_input(a, i / 2, 0.0031308) : acc_float(acc_log_uniform(a, 1.0, 3e38));
        if (x > HDRP_FLT_MIN) {
            ACC_ADD(a, acc_relative((double)hdrp_srgb_from_linear(x), srgb_from_linear((double)x)),
                    "x = %.9g", (double)x);
        }
    }
}

static void linear_from_srgb_fast_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        float c = unit_input(a, i, 0.04045);
        if (c > HDRP_FLT_MIN * 20.0f) {
            ACC_ADD(
                a, acc_relative((double)hdrp_linear_from_srgb_fast(c), linear_from_srgb((double)c)),
                "c = %.9g", (double)c);
        }
    }
}

static void linear_from_srgb_fast_absolute_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        float c = unit_input(a, i, 0.04045);
        ACC_ADD(a, fabs((double)hdrp_linear_from_srgb_fast(c) - linear_from_srgb((double)c)),
                "c = %.9g", (double)c);
    }
}

static void srgb_from_linear_absolute(acc* a, float (*f)(float))
{
    for (int i = 0; i < 400000; ++i) {
        float x = unit_input(a, i, 0.0031308);
        ACC_ADD(a, fabs((double)f(x) - srgb_from_linear((double)x)), "x = %.9g", (double)x);
    }
}

static void srgb_from_linear_fast_error(acc* a)
{
    srgb_from_linear_absolute(a, hdrp_srgb_from_linear_fast);
}

static void srgb_from_linear_absolute_error(acc* a)
{
    srgb_from_linear_absolute(a, hdrp_srgb_from_linear);
}

/* The standard rounds the weights to four digits, and with these the function is compared: the
 * primaries themselves give 0.21264, 0.71517, 0.07219. Checked here, or the constants could be
 * anything. */
static void luminance_error(acc* a)
{
    static const double weight[3] = {0.2126, 0.7152, 0.0722};
    double m[3][3];
    xyz_from_rec709(m);
    for (int i = 0; i < 3; ++i) {
        if (fabs(m[1][i] - weight[i]) > 5e-5) {
            ACC_ADD(a, 1.0, "weight %d is not that of the primaries, %g", i, m[1][i]);
        }
    }
    for (int i = 0; i < 400000; ++i) {
        double x = acc_log_uniform(a, 1e-4, 1.0), y = acc_log_uniform(a, 1e-4, 1.0);
        double z = acc_log_uniform(a, 1e-4, 1.0);
        hdrp_v3 c = hdrp_v3_make((float)x, (float)y, (float)z);
        double reference =
            weight[0] * (double)c.x + weight[1] * (double)c.y + weight[2] * (double)c.z;
        ACC_ADD(a, acc_relative((double)hdrp_luminance(c), reference), "(%.9g, %.9g, %.9g)",
                (double)c.x, (double)c.y, (double)c.z);
    }
}

typedef hdrp_v3 kelvin_function(float kelvin);

static void kelvin_error(acc* a, kelvin_function* f, const double observer[CIE_COUNT][3],
                         bool whiten)
{
    for (int i = 0; i <= 8000; ++i) {
        double t = i % 2 ? 1000.0 * pow(40.0, i / 8000.0) : acc_log_uniform(a, 1000.0, 40000.0);
        double rgb[3];
        float kelvin = (float)t;
        planck_rec709((double)kelvin, observer, whiten, rgb);
        hdrp_v3 c = f(kelvin);
        double measured[3] = {(double)c.x, (double)c.y, (double)c.z};
        for (int k = 0; k < 3; ++k) {
            ACC_ADD(a, fabs(measured[k] - rgb[k]), "T = %.9g, channel %d", (double)kelvin, k);
        }
    }
}

static void rec709_from_kelvin_error(acc* a)
{
    kelvin_error(a, hdrp_rec709_from_kelvin, cie_1931_2_degree, false);
}

static void rec709_from_kelvin_fast_1964_error(acc* a)
{
    kelvin_error(a, hdrp_rec709_from_kelvin_fast, cie_1964_10_degree, true);
}

static void rec709_from_kelvin_fast_1931_error(acc* a)
{
    kelvin_error(a, hdrp_rec709_from_kelvin_fast, cie_1931_2_degree, false);
}

/* As published, in double: with the early return, and white as a mix of two. */
static void neutral(const double c[3], double shown[3])
{
    double low = fmin(c[0], fmin(c[1], c[2]));
    double offset = low < 0.08 ? low - 6.25 * low * low : 0.04;
    double peak = fmax(c[0], fmax(c[1], c[2])) - offset;
    double limited = 1.0 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
    double white = 1.0 - 1.0 / (0.15 * (peak - limited) + 1.0);
    for (int i = 0; i < 3; ++i) {
        shown[i] = c[i] - offset;
        if (peak >= 0.76) {
            shown[i] = shown[i] * (limited / peak) * (1.0 - white) + limited * white;
        }
    }
}

static void tonemap_neutral_error(acc* a)
{
    for (int i = 0; i < 400000; ++i) {
        double range = i % 2 ? 2.0 : 1e18, least = i % 2 ? 1e-3 : 1e-6;
        float c[3];
        double exact[3], reference[3];
        hdrp_v3 shown;
        for (int k = 0; k < 3; ++k) {
            c[k] = (float)acc_log_uniform(a, least, range);
            exact[k] = (double)c[k];
        }
        if (i % 5 == 0) {
            c[i % 3] = 0.0f;
            exact[i % 3] = 0.0;
        }
        neutral(exact, reference);
        shown = hdrp_tonemap_neutral(hdrp_v3_make(c[0], c[1], c[2]));
        ACC_ADD(a, fabs((double)shown.x - reference[0]), "(%.9g, %.9g, %.9g)", exact[0], exact[1],
                exact[2]);
        ACC_ADD(a, fabs((double)shown.y - reference[1]), "(%.9g, %.9g, %.9g)", exact[0], exact[1],
                exact[2]);
        ACC_ADD(a, fabs((double)shown.z - reference[2]), "(%.9g, %.9g, %.9g)", exact[0], exact[1],
                exact[2]);
    }
}

const acc_entry acc_math_colour[] = {
    {"linear_from_srgb", linear_from_srgb_error},
    {"linear_from_srgb_hdr", linear_from_srgb_hdr_error},
    {"srgb_from_linear", srgb_from_linear_error},
    {"linear_from_srgb_fast", linear_from_srgb_fast_error},
    {"linear_from_srgb_fast_absolute", linear_from_srgb_fast_absolute_error},
    {"srgb_from_linear_fast", srgb_from_linear_fast_error},
    {"srgb_from_linear_absolute", srgb_from_linear_absolute_error},
    {"luminance", luminance_error},
    {"tonemap_neutral", tonemap_neutral_error},
    {"rec709_from_kelvin", rec709_from_kelvin_error},
    {"rec709_from_kelvin_fast_1964", rec709_from_kelvin_fast_1964_error},
    {"rec709_from_kelvin_fast_1931", rec709_from_kelvin_fast_1931_error},
    {NULL, NULL},
};
