/* consumer.c - a program of somebody else, valid C99 and C++11.
 * SPDX-License-Identifier: MIT */
#include "hdrp_brdf.h"

#include <stdio.h>

int main(void)
{
    hdrp_brdf_surface surface = hdrp_brdf_surface_default();
    hdrp_brdf_data data;
    surface.normal = hdrp_v3_make(0.0f, 5.0f, 0.0f);
    data = hdrp_brdf_data_from_surface(surface);
    printf("hdrp %d.%d.%d\n", HDRP_VERSION_MAJOR, HDRP_VERSION_MINOR, HDRP_VERSION_PATCH);
    return data.normal.y == 1.0f ? 0 : 1;
}
