/* planck.h - colour of a black body in linear Rec.709, from Planck's law and a CIE observer.
 * SPDX-License-Identifier: MIT */
#ifndef PLANCK_H
#define PLANCK_H

#include <math.h>
#include <stdbool.h>

#include "cie_observers.h"

/* Inverse of a 3x3 matrix by Cramer's rule. */
static void inverse3(double m[3][3], double out[3][3])
{
    double det = 0.0;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            out[c][r] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
        det += m[r][0] * out[0][r];
    }
    for (int i = 0; i < 9; ++i) {
        out[i / 3][i % 3] /= det;
    }
}

/* XYZ from Rec.709, from the chromaticities of its primaries and of D65. Its second row is the
 * luminance of the primaries. */
static void xyz_from_rec709(double m[3][3])
{
    static const double xy[4][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};
    double p[3][3], q[3][3], white[3];
    for (int c = 0; c < 4; ++c) {
        double column[3] = {xy[c][0] / xy[c][1], 1.0, (1.0 - xy[c][0] - xy[c][1]) / xy[c][1]};
        for (int r = 0; r < 3; ++r) {
            *(c < 3 ? &p[r][c] : &white[r]) = column[r];
        }
    }
    inverse3(p, q);
    for (int c = 0; c < 3; ++c) {
        double scale = q[c][0] * white[0] + q[c][1] * white[1] + q[c][2] * white[2];
        for (int r = 0; r < 3; ++r) {
            m[r][c] = p[r][c] * scale;
        }
    }
}

/* Planck's law times the observer, summed over the table's wavelengths. What lies outside the gamut
 * is clipped, or whitened until it lies on its border; then the largest channel is 1. */
static void planck_rec709(double kelvin, const double observer[CIE_COUNT][3], bool whiten,
                          double rgb[3])
{
    double m[3][3], rec709_from_xyz[3][3], xyz[3] = {0.0, 0.0, 0.0};
    xyz_from_rec709(m);
    inverse3(m, rec709_from_xyz);
    for (int i = 0; i < CIE_COUNT; ++i) {
        /* h c / k in SI units of 2019; the scale of the wavelength only keeps numbers moderate */
        double nm = CIE_FIRST_NM + CIE_STEP_NM * i, x = nm / 560.0;
        double power = 1.0 / (x * x * x * x * x * expm1(1.438776877503933e7 / (nm * kelvin)));
        for (int k = 0; k < 3; ++k) {
            xyz[k] += power * observer[i][k];
        }
    }
    for (int r = 0; r < 3; ++r) {
        rgb[r] = rec709_from_xyz[r][0] * xyz[0] + rec709_from_xyz[r][1] * xyz[1] +
                 rec709_from_xyz[r][2] * xyz[2];
    }
    double lowest = fmin(0.0, fmin(rgb[0], fmin(rgb[1], rgb[2])));
    double largest = fmax(rgb[0], fmax(rgb[1], rgb[2])) - (whiten ? lowest : 0.0);
    for (int k = 0; k < 3; ++k) {
        rgb[k] = (whiten ? rgb[k] - lowest : fmax(rgb[k], 0.0)) / largest;
    }
}

#endif
