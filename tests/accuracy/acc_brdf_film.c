/* acc_brdf_film.c - accuracy of the thin film of hdrp_brdf_lobes.h.
 * SPDX-License-Identifier: MIT */
#include "accuracy.h"

#include "../published/published_forms.h"
#include "film_reference.h"
#include "hdrp_brdf_lobes.h"

#define COUNT      9000
#define MAX_F0     0.999 /* the amplitude of a perfect mirror leaves nothing to interfere */
#define TYPICAL_NM 1200.0

/* The worst that searches found, for each of the three forms. */
#define HARDEST 3
static const film_input hardest[HARDEST] = {
    {0.0764717013f, 1.00006902f, 2.88841796f, 55.393856f, 0.961139858f},
    {0.0385589488f, 1.00011158f, 2.64977074f, 2740.57886f, 0.954440951f},
    {0.00739906449f, 1.0f, 1.27751493f, 395.227631f, 0.970750988f},
};

/* The whole domain, evenly, and its corners: grazing views, metals, thick and thin films. Light
 * comes from air, through the outer medium. */
static film_input random_film(acc* a, int i)
{
    film_input f;
    double steep = acc_uniform(a, 0.0, 1.0);
    double in_air = i % 5 ? steep : fmin(steep * steep * steep + 1e-4, 1.0);
    f.outer = acc_float(i % 4 ? 1.0 : acc_uniform(a, 1.0, 1.5));
    double sine2 = (1.0 - in_air * in_air) / ((double)f.outer * (double)f.outer);
    f.cosine = acc_float(sqrt(1.0 - sine2));
    f.ior = acc_float(acc_uniform(a, 1.0, 3.0));
    f.nm = acc_float(i % 3 ? acc_uniform(a, 0.0, TYPICAL_NM) : acc_uniform(a, 0.0, 3000.0));
    f.f0 = acc_float(i % 2   ? acc_uniform(a, 0.0, MAX_F0)
                     : i % 4 ? 0.04
                             : acc_uniform(a, 0.9, MAX_F0));
    if (i < HARDEST) {
        f = hardest[i];
    }
    return f;
}

typedef hdrp_v3 film_function(float, float, float, float, hdrp_v3);

/* References are the same for all entries, so they are made once. */
static double film_error(acc* a, int i, film_function* f, film_input* in)
{
    static double references[COUNT][3];
    static film_input inputs[COUNT];
    static int done;
    if (i == done) {
        inputs[i] = random_film(a, i);
        reference_color(inputs[i], references[i]);
        ++done;
    }
    *in = inputs[i];
    hdrp_v3 m = f(in->cosine, in->outer, in->ior, in->nm, hdrp_v3_splat(in->f0));
    return color_difference(m, references[i]);
}

static void largest(acc* a, film_function* f)
{
    for (int i = 0; i < COUNT; ++i) {
        film_input in;
        double error = film_error(a, i, f, &in);
        ACC_ADD(a, error, "cosine %.6g, outer %.4g, ior %.4g, %.5g nm, F0 %.4g", (double)in.cosine,
                (double)in.outer, (double)in.ior, (double)in.nm, (double)in.f0);
    }
}

static void mean(acc* a, film_function* f)
{
    double sum = 0.0;
    for (int i = 0; i < COUNT; ++i) {
        film_input in;
        sum += film_error(a, i, f, &in);
    }
    ACC_ADD(a, sum / COUNT, "%d films", COUNT);
}

static void film(acc* a)
{
    largest(a, hdrp_brdf_film);
}

static void film_mean(acc* a)
{
    mean(a, hdrp_brdf_film);
}

static void film_exact(acc* a)
{
    largest(a, hdrp_brdf_film_exact);
}

static void film_exact_mean(acc* a)
{
    mean(a, hdrp_brdf_film_exact);
}

static void film_fast(acc* a)
{
    largest(a, hdrp_brdf_film_fast);
}

static void film_fast_mean(acc* a)
{
    mean(a, hdrp_brdf_film_fast);
}

/* Films as the talk makes them, one thickness t for IOR and thickness, over bases of one F0. */
static film_input film_of_talk(acc* a, int i, float f0)
{
    film_input f;
    double t = acc_uniform(a, 0.0, 1.0), c = acc_uniform(a, 0.0, 1.0);
    f.cosine = acc_float(i % 5 ? c : c * c * c + 1e-4 * (1.0 - c));
    f.outer = 1.0f;
    f.ior = acc_float(2.0 - t);
    f.nm = acc_float(1500.0 * t / (2.0 - t));
    f.f0 = f0;
    return f;
}

/* Largest and mean error of the talk's form and of a film, on the same films. */
static void compare_with_talk(acc* a, float f0, film_function* f, double talk[2], double ours[2])
{
    const int count = 2000;
    talk[0] = talk[1] = ours[0] = ours[1] = 0.0;
    for (int i = 0; i < count; ++i) {
        double reference[3];
        film_input in = film_of_talk(a, i, f0);
        reference_color(in, reference);
        for (int k = 0; k < 2; ++k) {
            double* sum = k ? ours : talk;
            hdrp_v3 m =
                (k ? f : published_film)(in.cosine, in.outer, in.ior, in.nm, hdrp_v3_splat(in.f0));
            double error = color_difference(m, reference);
            sum[0] = acc_larger(sum[0], error);
            sum[1] += error / count;
        }
    }
}

static void film_to_talk(acc* a, film_function* f, int which)
{
    const float f0s[] = {0.02f, 0.04f, 0.1f, 0.2f, 0.5f, 0.7f};
    for (int i = 0; i < 6; ++i) {
        double talk[2], ours[2];
        compare_with_talk(a, f0s[i], f, talk, ours);
        ACC_ADD(a, ours[which] / talk[which], "F0 %.3g: %.4g against %.4g", (double)f0s[i],
                ours[which], talk[which]);
    }
}

static void film_to_talk_largest(acc* a)
{
    film_to_talk(a, hdrp_brdf_film, 0);
}

static void film_to_talk_mean(acc* a)
{
    film_to_talk(a, hdrp_brdf_film, 1);
}

static void film_fast_to_talk_largest(acc* a)
{
    film_to_talk(a, hdrp_brdf_film_fast, 0);
}

static void film_fast_to_talk_mean(acc* a)
{
    film_to_talk(a, hdrp_brdf_film_fast, 1);
}

static void compare_airy(acc* a, film_input in, float base)
{
    float wavelength = acc_float(acc_uniform(a, 300.0, 1000.0));
    stack s = make_stack((double)in.cosine, (double)in.outer, (double)in.ior, (double)base,
                         (double)in.nm);
    float m = hdrp_brdf_film_airy(in.cosine, in.outer, in.ior, base, in.nm, wavelength);
    ACC_ADD(a, fabs((double)m - airy(&s, (double)wavelength)),
            "cosine %.9g, outer %.9g, ior %.9g, %.9g nm, base %.9g, %.9g nm", (double)in.cosine,
            (double)in.outer, (double)in.ior, (double)in.nm, (double)base, (double)wavelength);
}

static void film_airy(acc* a)
{
    for (int i = 0; i < 200000; ++i) {
        film_input in = random_film(a, i);
        compare_airy(a, in, acc_float(ior_of((double)in.f0)));
    }
}

/* Cosine at and below which an interface to this IOR reflects totally; 0 where it never does. */
static double critical_cosine(double outer, double ior)
{
    return sqrt(acc_larger(1.0 - ior * ior / (outer * outer), 0.0));
}

/* Films and bases that are thinner than the medium above, which the light did not enter from air:
 * at the critical angle of the base, or from 1e-3 above in cosine. */
static void airy_inside(acc* a, double least, double most)
{
    for (int i = 0; i < 200000; ++i) {
        film_input in = random_film(a, i);
        in.outer = acc_float(acc_uniform(a, 1.0, 1.5));
        float base = acc_float(acc_uniform(a, 1.0, (double)in.outer));
        double critical = critical_cosine((double)in.outer, (double)base);
        in.cosine = acc_float(fmin(critical + acc_log_uniform(a, least, most), 1.0));
        if (critical_cosine((double)in.outer, (double)in.ior) + 1e-3 <= (double)in.cosine) {
            compare_airy(a, in, base);
        }
    }
}

static void film_airy_inside(acc* a)
{
    airy_inside(a, 1e-3, 1.0);
}

static void film_airy_critical(acc* a)
{
    airy_inside(a, 1e-9, 1e-3);
}

const acc_entry acc_brdf_film[] = {
    {"brdf_film", film},
    {"brdf_film_mean", film_mean},
    {"brdf_film_exact", film_exact},
    {"brdf_film_exact_mean", film_exact_mean},
    {"brdf_film_fast", film_fast},
    {"brdf_film_fast_mean", film_fast_mean},
    {"brdf_film_to_talk", film_to_talk_largest},
    {"brdf_film_to_talk_mean", film_to_talk_mean},
    {"brdf_film_fast_to_talk", film_fast_to_talk_largest},
    {"brdf_film_fast_to_talk_mean", film_fast_to_talk_mean},
    {"brdf_film_airy", film_airy},
    {"brdf_film_airy_inside", film_airy_inside},
    {"brdf_film_airy_critical", film_airy_critical},
    {NULL, NULL},
};
