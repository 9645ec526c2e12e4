/* half_ranges.cpp - where formulas stop being usable in half precision.
 * SPDX-License-Identifier: MIT
 *
 * Walks one parameter of each formula through the halves of its range; at each, the others vary at
 * random. Prints a line that names the compiler, then a CSV line per formula:
 *
 *     id,function,unit,limit,parameter,lo,hi,first,last
 *
 * lo and hi are the ends of the longest run of the parameter without an error above the limit,
 * first and last those of the walk. Errors are against the same text in float, which is a thousand
 * times as precise, at inputs that are halves. */
#include "half_formulas.h"

#include "half.hpp"

static uint64_t state;

/* SplitMix64 (Steele, Lea and Flood 2014). */
static double uniform(double lo, double hi)
{
    uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return lo + (hi - lo) * (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static const double PI = 3.14159265358979323846;

static void direction(double cosine, double azimuth, double* out)
{
    double s = sqrt((1.0 - cosine) * (1.0 + cosine));
    out[0] = s * cos(azimuth);
    out[1] = s * sin(azimuth);
    out[2] = cosine;
}

static double alpha_of(double roughness)
{
    return fmax(roughness * roughness, 1e-4);
}

/* A half vector in the lobe: up to 4 widths from its middle, where D has fallen to a 300th. */
static void half_vector(double roughness, double* out)
{
    double t = alpha_of(roughness) * uniform(0.0, 4.0);
    direction(1.0 / sqrt(1.0 + t * t), uniform(0.0, 2.0 * PI), out);
}

/* v reflected about a half vector in the lobe, or any direction. */
static void view_and_light(double roughness, double least, double* out)
{
    double h[3], c;
    do {
        half_vector(roughness, h);
        direction(uniform(least, 1.0), uniform(0.0, 2.0 * PI), out);
        c = out[0] * h[0] + out[1] * h[1] + out[2] * h[2];
        for (int i = 0; i < 3; ++i) {
            out[3 + i] = 2.0 * c * h[i] - out[i];
        }
        if (uniform(0.0, 1.0) < 0.3) {
            direction(uniform(least, 1.0), uniform(0.0, 2.0 * PI), out + 3);
        }
    } while (out[5] < least);
}

/* About any normal, not only +Z, whose components are no halves. */
static void tilted_half_vector(double roughness, double* out)
{
    double x[3], t[3], b[3], local[3];
    direction(uniform(-1.0, 1.0), uniform(0.0, 2.0 * PI), out);
    direction(uniform(-1.0, 1.0), uniform(0.0, 2.0 * PI), x);
    half_vector(roughness, local);
    b[0] = out[1] * x[2] - out[2] * x[1];
    b[1] = out[2] * x[0] - out[0] * x[2];
    b[2] = out[0] * x[1] - out[1] * x[0];
    double length = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    for (int i = 0; i < 3; ++i) {
        b[i] /= length;
    }
    t[0] = b[1] * out[2] - b[2] * out[1];
    t[1] = b[2] * out[0] - b[0] * out[2];
    t[2] = b[0] * out[1] - b[1] * out[0];
    for (int i = 0; i < 3; ++i) {
        out[3 + i] = t[i] * local[0] + b[i] * local[1] + out[i] * local[2];
    }
}

/* How errors are measured. */
enum measure {
    RELATIVE,  /* of each result */
    UNROUNDED, /* the same, against the result for the inputs before they were rounded to half */
    SHARE,     /* of the largest result, but at least of 1/5: a fiftieth of that is 1/255 */
    ABSOLUTE,
    DEGREES,
    CODE_DEGREES /* the same of a vector that was stored in so many bits, beyond their own error */
};

struct walk {
    const char *id, *function, *parameter;
    enum half_formula formula;
    double first, last;
    int count; /* steps, geometric; 0: all integers */
    enum measure measure;
    int feature; /* bit of HDRP_BRDF_FEATURE_... and 1, or 0 */
};

static const double EV_FIRST = -20.0, EV_LAST = 24.0;
static const walk walks[] = {
    {"brdf_d_ggx", "hdrp_brdf_d_ggx", "perceptual_roughness", HALF_D, 0.02, 1.0, 160, RELATIVE, 0},
    {"brdf_d_ggx_vectors", "hdrp_brdf_d_ggx_vectors", "perceptual_roughness", HALF_D_VECTORS, 0.02,
     1.0, 160, RELATIVE, 0},
    {"brdf_d_ggx_cosine_unrounded", "hdrp_brdf_d_ggx", "perceptual_roughness", HALF_D, 0.02, 1.0,
     160, UNROUNDED, 0},
    {"brdf_d_ggx_unrounded", "hdrp_brdf_d_ggx_vectors", "perceptual_roughness", HALF_D_VECTORS,
     0.02, 1.0, 160, UNROUNDED, 0},
    {"brdf_d_ggx_aniso", "hdrp_brdf_d_ggx_aniso", "perceptual_roughness", HALF_D_ANISO, 0.02, 1.0,
     160, RELATIVE, 0},
    {"brdf_d_ggx_aniso_vectors", "hdrp_brdf_d_ggx_aniso_vectors", "perceptual_roughness",
     HALF_D_ANISO_VECTORS, 0.02, 1.0, 160, RELATIVE, 0},
    {"brdf_v_smith_ggx", "hdrp_brdf_v_smith_ggx", "n_dot_v", HALF_V, 1e-3, 1.0, 160, RELATIVE, 0},
    {"brdf_v_smith_ggx_aniso", "hdrp_brdf_v_smith_ggx_aniso", "n_dot_v", HALF_V_ANISO, 1e-3, 1.0,
     160, RELATIVE, 0},
    {"brdf_pdf_vndf", "hdrp_brdf_pdf_vndf", "perceptual_roughness", HALF_PDF_VNDF, 0.02, 1.0, 160,
     RELATIVE, 0},
    {"brdf_f_schlick", "hdrp_brdf_f_schlick", "u", HALF_FRESNEL, 1e-3, 1.0, 160, RELATIVE, 0},
    {"brdf_multiscatter", "hdrp_brdf_multiscatter", "perceptual_roughness", HALF_MULTISCATTER, 0.02,
     1.0, 160, ABSOLUTE, 0},
    {"pack_normal_from_oct_snorm", "hdrp_pack_normal_from_oct_snorm", "bits", HALF_OCT_DECODE, 2.0,
     16.0, 0, DEGREES, 0},
    {"pack_oct_snorm_12", "hdrp_pack_oct_snorm_from_normal", "bits", HALF_OCT_ROUND_TRIP, 4.0, 16.0,
     0, CODE_DEGREES, 0},
    {"light_falloff", "hdrp_light_falloff", "distance_m", HALF_FALLOFF, 0.01, 1e4, 240, RELATIVE,
     0},
    {"light_window", "hdrp_light_window", "range_m", HALF_WINDOW_OF_RANGE, 0.01, 1e4, 240, ABSOLUTE,
     0},
    {"light_lux_candela", "hdrp_light_lux_from_candela", "distance_m", HALF_LUX, 0.01, 1e4, 240,
     RELATIVE, 0},
    {"light_nits_ev100", "hdrp_light_nits_from_ev100", "ev100", HALF_NITS, EV_FIRST, EV_LAST, 0,
     RELATIVE, 0},
    {"light_exposure_saturation", "hdrp_light_exposure_saturation", "ev100", HALF_EXPOSURE,
     EV_FIRST, EV_LAST, 0, RELATIVE, 0},
    {"light_eval_point", "hdrp_light_eval_point", "distance_m", HALF_POINT_LIGHT, 0.01, 1e4, 240,
     RELATIVE, 0},
    {"brdf_lit_standard", "hdrp_brdf_lit_eval", "perceptual_roughness", HALF_LIT, 0.02, 1.0, 160,
     SHARE, 0},
    {"brdf_lit_anisotropy", "hdrp_brdf_lit_eval", "perceptual_roughness", HALF_LIT, 0.02, 1.0, 160,
     SHARE, 3},
    {"brdf_lit_coat", "hdrp_brdf_lit_eval", "perceptual_roughness", HALF_LIT, 0.02, 1.0, 160, SHARE,
     5},
    {"brdf_lit_iridescence", "hdrp_brdf_lit_eval", "perceptual_roughness", HALF_LIT, 0.02, 1.0, 160,
     SHARE, 4},
    {"brdf_lit_transmission", "hdrp_brdf_lit_eval", "perceptual_roughness", HALF_LIT, 0.02, 1.0,
     160, SHARE, 2},
    {"brdf_lit_refraction", "hdrp_brdf_lit_eval", "perceptual_roughness", HALF_LIT, 0.02, 1.0, 160,
     SHARE, 6},
};

static double limit(enum measure m)
{
    return m == DEGREES || m == CODE_DEGREES ? 0.5 : m == ABSOLUTE ? 1.0 / 255.0 : 0.02;
}

/* Inputs of one call for a value x of the parameter, which comes first but for cosines. */
static void fill(const walk* w, double x, double in[8])
{
    in[0] = x;
    switch (w->formula) {
    case HALF_D: {
        double h[3];
        half_vector(x, h);
        in[1] = h[2];
        break;
    }
    case HALF_D_VECTORS:
        tilted_half_vector(x, in + 1);
        break;
    case HALF_D_ANISO:
    case HALF_D_ANISO_VECTORS:
        half_vector(x, in + 1);
        break;
    case HALF_V:
        in[0] = uniform(0.02, 1.0);
        in[1] = uniform(x, 1.0);
        in[2] = x;
        break;
    case HALF_V_ANISO:
        in[0] = uniform(0.02, 1.0);
        direction(uniform(x, 1.0), uniform(0.0, 2.0 * PI), in + 1);
        direction(x, uniform(0.0, 2.0 * PI), in + 4);
        break;
    case HALF_PDF_VNDF:
        half_vector(x, in + 4);
        direction(uniform(0.05, 1.0), uniform(0.0, 2.0 * PI), in + 1);
        break;
    case HALF_FRESNEL:
        in[1] = uniform(0.02, 1.0);
        break;
    case HALF_MULTISCATTER:
        in[1] = uniform(0.0, 1.0);
        in[2] = uniform(0.0, 1.0);
        break;
    case HALF_OCT_DECODE:
        in[1] = floor(uniform(0.0, ldexp(1.0, (int)(2.0 * x))));
        break;
    case HALF_OCT_ROUND_TRIP:
    case HALF_POINT_LIGHT:
        direction(uniform(-1.0, 1.0), uniform(0.0, 2.0 * PI), in + 1);
        break;
    case HALF_WINDOW_OF_RANGE:
        in[1] = x * uniform(0.0, 1.0);
        break;
    case HALF_LUX:
        in[1] = 1.0;
        break;
    case HALF_LIT:
        view_and_light(x, 0.05, in + 1);
        in[7] = w->feature ? ldexp(1.0, w->feature - 1) : 0.0;
        break;
    case HALF_NITS:
    case HALF_EXPOSURE:
        in[0] += uniform(-0.5, 0.5);
        break;
    default:
        break;
    }
}

static double degrees(const double a[3], const double b[3])
{
    double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double s = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    /* A vector of no length has no direction. */
    return fabs(dot) + s > 0.25 ? atan2(s, dot) * 180.0 / PI : HUGE_VAL;
}

/* in is what was meant, rounded is what half makes of it. */
static double error(const walk* w, const double in[8], const double rounded[8])
{
    double half[3], exact[3];
    half_eval_half(w->formula, rounded, half);
    half_eval_float(w->formula, w->measure == UNROUNDED ? in : rounded, exact);
    if (w->measure == DEGREES) {
        return degrees(half, exact);
    }
    if (w->measure == CODE_DEGREES) {
        return degrees(half, rounded + 1) - ldexp(245.0, -(int)in[0]); /* 0.96 for 8 bits */
    }
    double worst = 0.0, largest = fmax(fmax(fabs(exact[0]), fabs(exact[1])), fabs(exact[2]));
    for (int i = 0; i < 3; ++i) {
        double e = fabs(half[i] - exact[i]);
        double of = w->measure == SHARE      ? fmax(largest, 50.0 / 255.0)
                    : w->measure == ABSOLUTE ? 1.0
                                             : fabs(exact[i]);
        e = e == 0.0 ? 0.0 : e / of;
        worst = e <= worst ? worst : e; /* NaN stays */
    }
    return worst;
}

/* Whether each of many calls is below the limit; NaN is not. */
static bool usable(const walk* w, double x, double* seen)
{
    bool good = true;
    for (int i = 0; i < 1500; ++i) {
        double in[8] = {0}, rounded[8];
        fill(w, x, in);
        for (int k = 0; k < 8; ++k) {
            bool is_code = w->formula == HALF_OCT_DECODE;
            rounded[k] = is_code ? in[k] : (double)half_rounded((float)in[k]);
        }
        double e = error(w, in, rounded);
        good = good && e <= limit(w->measure);
        *seen = e <= *seen ? *seen : e;
    }
    return good;
}

static double place(const walk* w, int i)
{
    if (w->count == 0) {
        return w->first + i;
    }
    double x = w->first * pow(w->last / w->first, (double)i / w->count);
    return (double)half_rounded((float)x);
}

int main(void)
{
    half_print_origin();
    printf("id,function,unit,limit,parameter,lo,hi,first,last\n");
    for (const walk& w : walks) {
        int count = w.count ? w.count : (int)(w.last - w.first), best = 0, run = 0, end = 0;
        state = 1;
        for (int i = 0; i <= count; ++i) {
            double seen = 0.0;
            run = usable(&w, place(&w, i), &seen) ? run + 1 : 0;
            if (getenv("HALF_VERBOSE")) {
                fprintf(stderr, "%s %s %.4g: %.3g\n", w.id, w.parameter, place(&w, i), seen);
            }
            if (run > best) {
                best = run;
                end = i;
            }
        }
        const char* units[] = {"relative", "relative", "share", "absolute", "degrees", "degrees"};
        double lo = best ? place(&w, end - best + 1) : 0.0, hi = best ? place(&w, end) : 0.0;
        printf("%s,%s,%s,%.3g,%s,%.3g,%.3g,%.3g,%.3g\n", w.id, w.function, units[w.measure],
               limit(w.measure), w.parameter, lo, best ? hi : -1.0, w.first, w.last);
    }
    return 0;
}
