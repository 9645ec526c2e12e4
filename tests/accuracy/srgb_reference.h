/* srgb_reference.h - the sRGB curve and its inverse in double precision.
 * SPDX-License-Identifier: MIT */
#ifndef SRGB_REFERENCE_H
#define SRGB_REFERENCE_H

#include <math.h>

/* IEC 61966-2-1 with the constants as printed there. */
static inline double linear_from_srgb(double c)
{
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static inline double srgb_from_linear(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

#endif
