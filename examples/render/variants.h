/* Which of a few compiled light loops each tile would run, and which are worth compiling. */
#ifndef RD_VARIANTS_H
#define RD_VARIANTS_H

#include "hdrp_cull_variant.h"
#include "lists.h"
#include "stats.h"

#define RD_VARIANT_LIMIT    8
#define RD_VARIANT_NAME_MAX 160
/* Distinct sets of features of tiles: 5 bits of materials and 6 of lights make no more. */
#define RD_VARIANT_SETS 2048

typedef struct rd_variants {
    bool ready;
    hdrp_cull_choice choice; /* from the tiles of the first sub-frame */
    uint32_t* words;         /* of each tile: what its materials and lights need */
    uint8_t* tiles;          /* the variant of each */
    /* Cost of a tile: in a variant of everything there is, in one of what the scene has, by a list
     * made by hand, and by the choice, with its bound. */
    double mean_everything, mean_one, mean_by_hand, mean_chosen, mean_bound;
    hdrp_cull_variant_report reports[RD_VARIANT_LIMIT];
    char names[RD_VARIANT_LIMIT][RD_VARIANT_NAME_MAX];
} rd_variants;

/* Where a light reaches, with the features that it needs of a variant. */
hdrp_cull_shape rd_variants_shape(const rd_lights* lights, uint32_t light);

void rd_variants_end(rd_variants* v);
void rd_variants_count(const rd_variants* v, rd_stats* stats);

#endif
