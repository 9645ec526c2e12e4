/* film_reference.h - the reference of thin films, in double.
 * SPDX-License-Identifier: MIT
 *
 * Sums complex amplitudes of both polarisations for every nanometre of the CIE 1931 2-degree
 * observer, weights them so that equal energy is white, and limits the colour to [0,1]. */
#ifndef FILM_REFERENCE_H
#define FILM_REFERENCE_H

#include <complex.h>
#include <math.h>

#include "cie_observers.h"
#include "hdrp_brdf_lobes.h"

#define PI       3.14159265358979323846
#define FIRST_NM 360
#define LAST_NM  830

typedef struct film_input {
    float cosine, outer, ior, nm, f0;
} film_input;

/* Response of linear Rec.709 to one nanometre; the sum over all is 1 for each channel. */
static inline const double* sensitivity(int nm)
{
    static double table[LAST_NM - FIRST_NM + 1][3];
    static const double rec709[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                        {-0.9692660, 1.8760108, 0.0415560},
                                        {0.0556434, -0.2040259, 1.0572252}};
    if (table[0][0] == 0.0) {
        double sum[3] = {0.0, 0.0, 0.0};
        for (int i = 0; i <= LAST_NM - FIRST_NM; ++i) {
            int k = i / 5 < CIE_COUNT - 1 ? i / 5 : CIE_COUNT - 2;
            double t = i / 5.0 - k;
            for (int c = 0; c < 3; ++c) {
                for (int xyz = 0; xyz < 3; ++xyz) {
                    table[i][c] += rec709[c][xyz] * ((1.0 - t) * cie_1931_2_degree[k][xyz] +
                                                     t * cie_1931_2_degree[k + 1][xyz]);
                }
                sum[c] += table[i][c];
            }
        }
        for (int i = 0; i <= LAST_NM - FIRST_NM; ++i) {
            for (int c = 0; c < 3; ++c) {
                table[i][c] /= sum[c];
            }
        }
    }
    return table[nm - FIRST_NM];
}

typedef struct stack {
    double complex top[2], bottom[2]; /* amplitudes, s and p */
    double complex path_nm;           /* optical path difference */
} stack;

static inline stack make_stack(double c1, double n1, double n2, double n3, double nm)
{
    stack s;
    double sine = n1 * sqrt((1.0 - c1) * (1.0 + c1));
    double complex c2 = csqrt(1.0 - sine * sine / (n2 * n2));
    double complex c3 = csqrt(1.0 - sine * sine / (n3 * n3));
    s.top[0] = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
    s.top[1] = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
    s.bottom[0] = (n2 * c2 - n3 * c3) / (n2 * c2 + n3 * c3);
    s.bottom[1] = (n3 * c2 - n2 * c3) / (n3 * c2 + n2 * c3);
    s.path_nm = 2.0 * n2 * nm * c2;
    return s;
}

static inline double airy(const stack* s, double wavelength_nm)
{
    double complex turn = cexp(2.0 * PI * (double complex)I * s->path_nm / wavelength_nm);
    double sum = 0.0;
    for (int p = 0; p < 2; ++p) {
        double complex r =
            (s->top[p] + s->bottom[p] * turn) / (1.0 + s->top[p] * s->bottom[p] * turn);
        sum += 0.5 * creal(r * conj(r));
    }
    return sum;
}

static inline double ior_of(double f0)
{
    return (1.0 + sqrt(f0)) / (1.0 - sqrt(f0));
}

static inline void reference_color(film_input in, double rgb[3])
{
    stack s = make_stack((double)in.cosine, (double)in.outer, (double)in.ior, ior_of((double)in.f0),
                         (double)in.nm);
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    for (int nm = FIRST_NM; nm <= LAST_NM; ++nm) {
        double r = airy(&s, nm);
        for (int c = 0; c < 3; ++c) {
            rgb[c] += r * sensitivity(nm)[c];
        }
    }
    for (int c = 0; c < 3; ++c) {
        rgb[c] = fmin(fmax(rgb[c], 0.0), 1.0);
    }
}

static inline double color_difference(hdrp_v3 m, const double r[3])
{
    return fmax(fmax(fabs((double)m.x - r[0]), fabs((double)m.y - r[1])), fabs((double)m.z - r[2]));
}

#endif
