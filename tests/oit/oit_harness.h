/* oit_harness.h - random pixels of transparent layers, what sorting makes of them, and each mode.
 * SPDX-License-Identifier: MIT
 *
 * Layers of a pixel are drawn from a fixed sequence: 2 to 12 of them or as many as a case says,
 * depths log-uniform, opacities, colours and emission uniform. The stream is in no order of depth.
 * The reference sorts each pixel and blends back to front, in double. */
#ifndef OIT_HARNESS_H
#define OIT_HARNESS_H

#include "hdrp_oit.h"

#include <stddef.h>

#define OIT_PIXELS     3072u /* of each case */
#define OIT_WIDTH      64u
#define OIT_LAYERS_MAX 32u

typedef struct oit_case {
    const char* name;
    double alpha_low, alpha_high;
    double nearest_m, farthest_m;
    uint32_t layers_max;
    double additive;    /* share of layers that cover nothing and emit */
    double stops;       /* exposure: all colours are multiplied by 2^stops */
    double front_alpha; /* 0, or that of the nearest layer */
    double scale_stops; /* of the caller's scale */
    double emission;    /* of layers that emit, over colour times opacity, as of a sprite */
    double shining;     /* share of layers that cover and emit, up to a colour whatever covers */
    double pane_m;      /* 0, or the depth of the first layer */
} oit_case;

typedef struct oit_pixels {
    hdrp_oit_fragment* fragments;
    uint32_t* pixels;
    size_t count;
    hdrp_v3* behind;
    double* exact; /* three for each pixel */
    double brightness;
} oit_pixels;

typedef struct oit_error {
    double rms, largest; /* of linear RGB, in units of 2^stops */
} oit_error;

extern const oit_case oit_cases[];
extern const size_t oit_case_count;
const char* oit_mode_name(hdrp_oit_mode mode);

/* For qsort, on fragments. */
int oit_farther_first(const void* a, const void* b);

void oit_generate(const oit_case* c, oit_pixels* p);
void oit_free(oit_pixels* p);
oit_error oit_measure(const oit_case* c, const oit_pixels* p, hdrp_oit_mode mode,
                      hdrp_oit_precision precision);

#endif
