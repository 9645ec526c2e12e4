/* Transparency without sorting: what both backends know of the modes of hdrp_oit.h. */
#ifndef RD_OIT_H
#define RD_OIT_H

#include "hdrp_oit.h"
#include "options.h"
#include "scene.h"

/* Of anything but RD_OIT_SORTED. */
hdrp_oit_mode rd_oit_mode(rd_oit oit);

/* What light [nits] is multiplied by, so that colours are near 1: the power of 2 that is nearest to
 * the exposure, so that nothing is rounded. */
float rd_oit_unit(float exposure);

/* Covers some of what is behind it and changes none of the rest: what --oit is about. What transmits
 * light keeps its order; with --features=-refraction nothing does. */
bool rd_oit_is_blended(const rd_options* options, const rd_material* m);

/* Is it lit at half of the resolution? And anything in the scene? */
bool rd_oit_is_low(const rd_options* options, const rd_material* m);
bool rd_oit_has_low(const rd_options* options, const rd_scene* scene);

/* Images of a picture, and of what is lit at half of its resolution. */
typedef struct rd_oit_images {
    bool present;
    bool has_low;
    float unit;
    hdrp_oit_image full, low;
    void* memory[2];
    hdrp_v3* color;   /* behind the blended surfaces, and then with them, times unit */
    float* uncovered; /* share of what is opaque that other transparent surfaces leave */
} rd_oit_images;

typedef struct rd_oit_desc {
    rd_oit oit;
    int width, height;
    float exposure;
    bool has_low;
} rd_oit_desc;

/* False: no memory. */
bool rd_oit_begin(rd_oit_images* o, const rd_oit_desc* desc);
void rd_oit_end(rd_oit_images* o);

/* Share of what is behind that the blended surfaces of a pixel leave. */
float rd_oit_revealage(const hdrp_oit_image* image, size_t px);

#endif
