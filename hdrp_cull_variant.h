/* hdrp_cull_variant.h - which shader variant a tile runs, and which variants are worth compiling.
 * SPDX-License-Identifier: MIT
 *
 * See hdrp_math.h for the languages, the conventions and the override macros. A tile of the screen
 * needs features: material features of its pixels, kinds of lights in its list. They are one 32-bit
 * word, whose bits mean what the caller says; 0 is a tile without anything to shade. A variant is a
 * shader that was compiled for a set of features; it serves every tile whose features are among
 * them, and what it has beyond them is superfluous there. The algorithm layer, C and C++ only, is
 * compiled in one source file:
 *
 *     #define HDRP_CULL_IMPLEMENTATION
 *     #include "hdrp_cull_variant.h"
 *
 * Every frame, from a feature word per pixel and lists of tiles of the same size (hdrp_cull.h) to
 * indirect dispatches:
 *
 *     hdrp_cull_material_tiles(&image, 16, 0, tile_rows, words);
 *     hdrp_cull_light_features(&lists, &set, 0, tile_count, light_words);
 *     hdrp_cull_combine_features(words, light_words, words, 0, tile_count);
 *     hdrp_cull_assign_variants(&variants, words, chosen, 0, tile_count);
 *     hdrp_cull_build_dispatch(&dispatch, chosen, tiles_x, tiles_y);
 *
 * Once, when shaders are compiled, from the statistics of frames to the variants:
 *
 *     hdrp_cull_histogram_add(&histogram, words, NULL, tile_count);      of many frames
 *     desc.sets = histogram.entries;
 *     desc.set_count = histogram.count;
 *     desc.variant_limit = 8;
 *     desc.cost = hdrp_cull_model_cost;                                  or a table of measurements
 *     desc.user = &model;
 *     bytes = hdrp_cull_choose_memory_size(&desc);
 *     hdrp_cull_choose_variants(&desc, allocate(bytes), bytes, &choice);
 *
 * >>index of the functions, without hdrp_cull_ (written by tools/api_check.py --write)
 *   features of a tile: variant_covers superfluous_features first_covering tile_id tile_id_x
 *       tile_id_y
 *   classification: tiles_along material_tiles combine_features
 *   dispatch: assign_variants build_dispatch
 *   statistics: histogram_add histogram_merge all_features
 *   costs: model_cost report_variants
 *   automatic choice: choose_memory_size choose_variants
 * >>end */
#ifndef HDRP_CULL_VARIANT_H
#define HDRP_CULL_VARIANT_H

#include "hdrp_math.h"

#if HDRP_VERSION != 100
#error "hdrp_cull_variant.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* >>features of a tile */

/* In place of the index of a variant: none covers the tile. */
#define HDRP_CULL_VARIANT_NONE 255u
/* In place of the index of a variant: the tile has no features, so nothing runs. */
#define HDRP_CULL_VARIANT_EMPTY 254u
/* As many variants as there may be. */
#define HDRP_CULL_VARIANT_MAX 64u

/** Whether a variant can shade a tile.
 *  variant   any    features that the shader was compiled for
 *  features  any    features that the tile needs
 *  returns   [0,1]  1 where variant has all of them
 *  edges     every variant covers 0
 *  error     none: exact
 *  source    definition */
HDRP_FN hdrp_u32 hdrp_cull_variant_covers(hdrp_u32 variant, hdrp_u32 features)
{
    return (features & ~variant) == 0u ? 1u : 0u;
}

/** The features that a tile pays for in vain.
 *  variant   any  features that the shader was compiled for
 *  features  any  features that the tile needs
 *  returns   any  those of variant that are not in features
 *  edges     none
 *  error     none: exact
 *  source    definition */
HDRP_FN hdrp_u32 hdrp_cull_superfluous_features(hdrp_u32 variant, hdrp_u32 features)
{
    return variant & ~features;
}

/** One step of the search for the first covering variant, for lists that a shader has in any form:
 *  begin with HDRP_CULL_VARIANT_NONE, call it for index 0, 1, ... in order.
 *  found     any  the result so far
 *  index     any  of the variant
 *  variant   any  features that the shader was compiled for
 *  features  any  features that the tile needs
 *  returns   any  found where there is one already, else index where it covers features, else
 *                 HDRP_CULL_VARIANT_NONE
 *  edges     none
 *  error     none: a selection
 *  source    definition */
HDRP_FN hdrp_u32 hdrp_cull_first_covering(hdrp_u32 found, hdrp_u32 index, hdrp_u32 variant,
                                          hdrp_u32 features)
{
    hdrp_u32 here = (features & ~variant) == 0u ? index : HDRP_CULL_VARIANT_NONE;
    return found == HDRP_CULL_VARIANT_NONE ? here : found;
}

/** The word of a list of tiles that names a tile.
 *  x        [0,65535]  column
 *  y        [0,65535]  row
 *  returns  any        x in the lower 16 bits, y in the upper
 *  edges    higher bits of x and y are dropped
 *  error    none: exact
 *  source   definition */
HDRP_FN hdrp_u32 hdrp_cull_tile_id(hdrp_u32 x, hdrp_u32 y)
{
    return (x & 65535u) | (y << 16u);
}

/** Column of a tile; with hdrp_cull_tile_id_y the inverse of hdrp_cull_tile_id.
 *  id       any        from hdrp_cull_tile_id
 *  returns  [0,65535]  column
 *  edges    none
 *  error    none: exact
 *  source   definition */
HDRP_FN hdrp_u32 hdrp_cull_tile_id_x(hdrp_u32 id)
{
    return id & 65535u;
}

/** Row of a tile; with hdrp_cull_tile_id_x the inverse of hdrp_cull_tile_id.
 *  id       any        from hdrp_cull_tile_id
 *  returns  [0,65535]  row
 *  edges    none
 *  error    none: exact
 *  source   definition */
HDRP_FN hdrp_u32 hdrp_cull_tile_id_y(hdrp_u32 id)
{
    return id >> 16u;
}

#ifndef HDRP_GPU
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* >>classification
 * From pixels to a word per tile. Tiles are row by row; those at the right and the lower edge may
 * be smaller than the others. */

/* A feature word per pixel. The caller owns the pixels. */
typedef struct hdrp_cull_feature_image {
    const uint32_t* pixels; /* row by row; NULL: every pixel counts as fallback */
    uint32_t width, height; /* [1,65536] each */
    size_t row_stride;      /* words from row to row; 0 is width */
    uint32_t skipped;       /* word of pixels with nothing to shade, such as the sky */
    uint32_t fallback;      /* word of all pixels where there are none */
} hdrp_cull_feature_image;

/** Tiles along a side of an image.
 *  size       [0,65536]  pixels along that side
 *  tile_size  [1,65536]  pixels along the edge of a tile
 *  returns    [0,65536]  tiles, the last of which may be smaller
 *  edges      0 for a tile_size of 0 */
HDRP_API uint32_t hdrp_cull_tiles_along(uint32_t size, uint32_t tile_size);

/** Material features of tiles: the union over their pixels.
 *  image      the words of pixels
 *  tile_size  [1,65536]  pixels along the edge of a tile
 *  first_row  [0,65536]  of the rows of tiles
 *  row_count  [0,65536]  rows of tiles
 *  words      the words of all tiles of the image, of which those of the range are written
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT for a bad image, size or range
 *  range      rows are independent
 *  note       a tile whose pixels are all skipped gets 0 */
HDRP_API hdrp_result hdrp_cull_material_tiles(const hdrp_cull_feature_image* image,
                                              uint32_t tile_size, uint32_t first_row,
                                              uint32_t row_count, uint32_t* words);

/** Features of tiles: those of the material and those of the lights.
 *  materials  a word per tile; 0 where there is nothing to shade
 *  lights     a word per tile, as of hdrp_cull_light_features, or NULL for none
 *  words      result, which may be materials or lights; stays 0 where materials is 0
 *  first      [0,4294967295]  first tile
 *  count      [0,4294967295]  tiles
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT where the range ends above 2^32 - 1
 *  range      tiles are independent */
HDRP_API hdrp_result hdrp_cull_combine_features(const uint32_t* materials, const uint32_t* lights,
                                                uint32_t* words, uint32_t first, uint32_t count);

/* >>dispatch */

/* The variants, in the order in which they are tried. */
typedef struct hdrp_cull_variant_list {
    const uint32_t* masks; /* features of each */
    const double* costs; /* NULL: the first that covers a tile gets it; else the cheapest, of equal
                              ones the first */
    uint32_t count;      /* [1,HDRP_CULL_VARIANT_MAX] */
} hdrp_cull_variant_list;

/* Arguments of an indirect dispatch, as VkDispatchIndirectCommand has them, and where the tiles
 * are: group g shades tile tiles[first + g]. */
typedef struct hdrp_cull_arguments {
    uint32_t groups_x, groups_y, groups_z; /* tiles of the variant, 1, 1 */
    uint32_t first;                        /* of the list of tiles */
} hdrp_cull_arguments;

/* What hdrp_cull_build_dispatch writes, and where. The caller owns both arrays. */
typedef struct hdrp_cull_dispatch {
    hdrp_cull_arguments* arguments; /* one per variant */
    uint32_t* tiles;                /* hdrp_cull_tile_id of tiles, variant by variant */
    uint32_t variant_count;         /* [1,HDRP_CULL_VARIANT_MAX] */
    uint32_t tile_capacity;         /* words that tiles has room for */
    uint32_t listed;                /* result: tiles in the list; the four results add up to all */
    uint32_t empty;                 /* result: tiles without features */
    uint32_t uncovered;             /* result: tiles that no variant covers */
    uint32_t dropped;               /* result: tiles for which there was no room */
} hdrp_cull_dispatch;

/** Picks the variant of each tile.
 *  variants  the list
 *  words     features of tiles
 *  chosen    result: index of a variant, HDRP_CULL_VARIANT_NONE or HDRP_CULL_VARIANT_EMPTY
 *  first     [0,4294967295]  first tile
 *  count     [0,4294967295]  tiles
 *  returns   HDRP_OK
 *  errors    HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT for a number of variants out of its
 *            range, a cost that is NaN, and a range that ends above 2^32 - 1
 *  range     tiles are independent */
HDRP_API hdrp_result hdrp_cull_assign_variants(const hdrp_cull_variant_list* variants,
                                               const uint32_t* words, uint8_t* chosen,
                                               uint32_t first, uint32_t count);

/** Lists the tiles of each variant, in increasing order, and the arguments that dispatch them.
 *  dispatch  arrays and capacities; results
 *  chosen    of hdrp_cull_assign_variants over all tiles; an index beyond the variants counts as
 *            HDRP_CULL_VARIANT_NONE
 *  tiles_x   [1,65536]  tiles in a row
 *  tiles_y   [1,65536]  rows
 *  returns   HDRP_OK, also where tiles are uncovered or dropped: look at the counts
 *  errors    HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT for sizes out of their ranges
 *  note      where the list is full, the last tiles of the last variants are dropped */
HDRP_API hdrp_result hdrp_cull_build_dispatch(hdrp_cull_dispatch* dispatch, const uint8_t* chosen,
                                              uint32_t tiles_x, uint32_t tiles_y);

/* >>statistics */

/* A set of features and how often it was seen. */
typedef struct hdrp_cull_feature_count {
    uint64_t weight; /* tiles, or pixels */
    uint32_t features;
} hdrp_cull_feature_count;

/* Distinct sets of features, in increasing order of their words. The caller owns entries, and sets
 * count and left_out to 0 at first. */
typedef struct hdrp_cull_histogram {
    hdrp_cull_feature_count* entries;
    uint32_t capacity; /* entries that there is room for, at least 1 */
    uint32_t count;    /* entries so far */
    uint64_t left_out; /* weight for which there was no room */
} hdrp_cull_histogram;

/** Counts the features of tiles.
 *  histogram  to which they are added
 *  words      features of tiles; 0 is not counted
 *  weights    what each tile counts for, as its pixels; NULL for 1
 *  count      [0,4294967295]  tiles
 *  returns    HDRP_OK, also where something is left out
 *  errors     HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT for a histogram that is not one
 *  note       where there is no room, the sets with the smallest words stay, and their weights are
 *             exact: the result does not depend on the order of tiles */
HDRP_API hdrp_result hdrp_cull_histogram_add(hdrp_cull_histogram* histogram, const uint32_t* words,
                                             const uint32_t* weights, uint32_t count);

/** Adds a histogram to another, such as those of jobs or of frames.
 *  histogram  to which it is added
 *  other      what is added, of the same capacity if weights are to be exact
 *  returns    HDRP_OK, also where something is left out
 *  errors     HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT for a histogram that is not one */
HDRP_API hdrp_result hdrp_cull_histogram_merge(hdrp_cull_histogram* histogram,
                                               const hdrp_cull_histogram* other);

/** All features of some sets: those of a single variant that covers everything.
 *  sets     the sets
 *  count    [0,4294967295]  sets
 *  returns  [0,4294967295]  the union
 *  edges    0 for a null pointer */
HDRP_API uint32_t hdrp_cull_all_features(const hdrp_cull_feature_count* sets, uint32_t count);

/* >>costs */

/* What shading a tile costs in a variant of these features, in any unit; in [0,1e30]. user is the
 * caller's, who owns it. More features should not cost less. */
typedef double (*hdrp_cull_cost)(hdrp_u32 features, void* user);

/* A model of the cost on a GPU: instructions, and waiting that other waves hide, as many as fit the
 * registers. Every member is in [0,1e6]; bit b of the features adds element b. */
typedef struct hdrp_cull_cost_model {
    double alu, latency, registers; /* of the shader without features */
    double feature_alu[32];
    double feature_latency[32];
    double feature_registers[32]; /* that live as long as the shader runs */
    double feature_peak[32];      /* that live only in the feature: the largest counts */
    double register_count;        /* of a lane of a unit, shared by its waves; 256 on GCN */
    double waves_max;             /* that a unit can hold; 10 on GCN; at least 1 */
} hdrp_cull_cost_model;

/** Cost by an hdrp_cull_cost_model: alu + latency * waves_max / waves.
 *  features  [0,4294967295]  of the variant
 *  model     an hdrp_cull_cost_model, which the caller owns
 *  returns   [0,1e15]  cost; more features never cost less
 *  edges     0 for a null pointer; at least 1 wave runs, at most waves_max
 *  note      waves are whole: a register too many costs a whole one, as on GPUs */
HDRP_API double hdrp_cull_model_cost(hdrp_u32 features, void* model);

/* What a variant does, by the order of its list. */
typedef struct hdrp_cull_variant_report {
    double cost;              /* of a tile */
    uint64_t weight;          /* of the sets that it serves */
    uint64_t superfluous[32]; /* for each bit the weight of sets that carry it in vain */
} hdrp_cull_variant_report;

/* What a list of variants does. */
typedef struct hdrp_cull_variant_total {
    double cost;        /* of all that is covered */
    uint64_t uncovered; /* weight of the sets that no variant covers */
} hdrp_cull_variant_total;

/** What a list of variants costs for a histogram: one that was made by hand, a single variant for
 *  everything, or one that was chosen.
 *  variants   the list, with the rule by which sets go to variants
 *  sets       the histogram
 *  set_count  [0,4294967295]  sets
 *  cost       of a tile
 *  user       handed to cost; the caller owns it
 *  reports    result: one per variant; NULL for none
 *  total      result
 *  returns    HDRP_OK
 *  errors     HDRP_ERROR_NULL_POINTER; HDRP_ERROR_BAD_ARGUMENT for a number of variants out of its
 *             range and for a cost that is NaN */
HDRP_API hdrp_result hdrp_cull_report_variants(const hdrp_cull_variant_list* variants,
                                               const hdrp_cull_feature_count* sets,
                                               uint32_t set_count, hdrp_cull_cost cost, void* user,
                                               hdrp_cull_variant_report* reports,
                                               hdrp_cull_variant_total* total);

/* >>automatic choice */

/* Sets that a choice can take. */
#define HDRP_CULL_SET_MAX 4096u

/* What to choose from. Zero is the default where one is named. */
typedef struct hdrp_cull_choice_desc {
    const hdrp_cull_feature_count* sets; /* all are covered, those of weight 0 too; the weights add
                                            up to at most 2^32 */
    uint32_t set_count;                  /* [1,HDRP_CULL_SET_MAX] */
    uint32_t variant_limit;              /* [1,HDRP_CULL_VARIANT_MAX] */
    hdrp_cull_cost cost;
    void* user;           /* handed to cost; the caller owns it */
    uint32_t union_limit; /* below candidate_capacity: so many unions are all looked at, more are
                                    searched; default 4096. A cost that is not monotone needs it */
    uint32_t candidate_capacity; /* up to 2^20; default, and at least, 32768 */
    uint32_t effort;             /* up to 1000000: millions of comparisons of a set with a candidate
                                    after which it stops proving, about 2 ms each; default 1000 */
} hdrp_cull_choice_desc;

/* The variants that were chosen. */
typedef struct hdrp_cull_choice {
    uint32_t variant_count;                /* at most variant_limit */
    uint32_t masks[HDRP_CULL_VARIANT_MAX]; /* by increasing cost: first covering is cheapest */
    double costs[HDRP_CULL_VARIANT_MAX];
    double total_cost;        /* sum of weight times cost of the cheapest covering */
    double lower_bound;       /* no choice of unions of sets costs less */
    uint32_t is_optimal;      /* 1: proven, to within rounding */
    uint32_t is_monotone;     /* 0: a set was seen to cost more than its union with
                                               others */
    uint32_t candidate_count; /* unions that were looked at in the end */
    uint32_t node_count;      /* nodes of the search */
} hdrp_cull_choice;

/** Bytes that hdrp_cull_choose_variants needs.
 *  desc     what to choose from; sizes only
 *  returns  bytes, a multiple of HDRP_MEMORY_ALIGNMENT
 *  edges    0 for a null pointer and where a size is out of its range */
HDRP_API size_t hdrp_cull_choose_memory_size(const hdrp_cull_choice_desc* desc);

/** Chooses the variants that cost least: of all unions of sets at most variant_limit, so that each
 *  set has one that covers it, and the sum of weights times the cost of the cheapest is smallest.
 *  desc          what to choose from
 *  memory        block of the caller, aligned to HDRP_MEMORY_ALIGNMENT; it is free again afterwards
 *  memory_bytes  size of the block, at least hdrp_cull_choose_memory_size(desc)
 *  choice        result
 *  returns       HDRP_OK
 *  errors        HDRP_ERROR_NULL_POINTER, HDRP_ERROR_BAD_ARGUMENT for sizes and costs out of their
 *                ranges, HDRP_ERROR_TOO_LARGE for weights that are, HDRP_ERROR_MEMORY_TOO_SMALL,
 *                HDRP_ERROR_MEMORY_ALIGNMENT
 *  source        Cornuejols, Fisher and Nemhauser 1977, "Location of Bank Accounts to Optimize
 *                Float" (bound by Lagrangian relaxation); Camerini, Fratta and Maffioli 1975, "On
 *                improving relaxation methods by modified gradient techniques"; Whitaker 1983, "A
 *                Fast Algorithm for the Greedy Interchange of Large-Scale Clustering and Median
 *                Location Problems"
 *  note          it is the p-median problem with a facility for each union of sets. Merging and
 *                interchange find a choice, a Lagrangian relaxation with pricing bounds it, branch
 *                and bound closes the gap. Costs are rounded to a grid, 2^-48 of the largest total,
 *                on which all sums are exact: the choice does not depend on the compiler
 *  note          if a cost is not monotone, the choice is still valid, and the best of all unions
 *                if union_limit allows them; if it does not, lower_bound is 0 */
HDRP_API hdrp_result hdrp_cull_choose_variants(const hdrp_cull_choice_desc* desc, void* memory,
                                               size_t memory_bytes, hdrp_cull_choice* choice);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_CULL_VARIANT_H */

#if defined(HDRP_CULL_IMPLEMENTATION) && !defined(HDRP_CULL_VARIANT_IMPLEMENTED) &&                \
    !defined(HDRP_GPU)
#define HDRP_CULL_VARIANT_IMPLEMENTED

/* ---- classification -------------------------------------------------------------------------- */

HDRP_API uint32_t hdrp_cull_tiles_along(uint32_t size, uint32_t tile_size)
{
    return tile_size == 0u ? 0u : size / tile_size + (size % tile_size != 0u ? 1u : 0u);
}

static int hdrp_i_variant_is_size(uint32_t size)
{
    return size >= 1u && size <= 65536u;
}

/* The union of the words of a tile. */
static uint32_t hdrp_i_variant_tile_word(const hdrp_cull_feature_image* image, uint32_t x_begin,
                                         uint32_t x_end, uint32_t y_begin, uint32_t y_end)
{
    size_t stride = image->row_stride ? image->row_stride : image->width;
    uint32_t word = 0u, x, y;
    for (y = y_begin; y < y_end; ++y) {
        const uint32_t* row = image->pixels + stride * y;
        for (x = x_begin; x < x_end; ++x) {
            word |= row[x] == image->skipped ? 0u : row[x];
        }
    }
    return word;
}

HDRP_API hdrp_result hdrp_cull_material_tiles(const hdrp_cull_feature_image* image,
                                              uint32_t tile_size, uint32_t first_row,
                                              uint32_t row_count, uint32_t* words)
{
    uint32_t tiles_x, tiles_y, x, y;
    if (!image || !words) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (!hdrp_i_variant_is_size(image->width) || !hdrp_i_variant_is_size(image->height) ||
        !hdrp_i_variant_is_size(tile_size) ||
        (image->row_stride != 0u && image->row_stride < image->width)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    tiles_x = hdrp_cull_tiles_along(image->width, tile_size);
    tiles_y = hdrp_cull_tiles_along(image->height, tile_size);
    if (first_row > tiles_y || row_count > tiles_y - first_row) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (y = first_row; y < first_row + row_count; ++y) {
        uint32_t bottom = y + 1u == tiles_y ? image->height : (y + 1u) * tile_size;
        for (x = 0u; x < tiles_x; ++x) {
            uint32_t right = x + 1u == tiles_x ? image->width : (x + 1u) * tile_size;
            uint32_t word = image->fallback == image->skipped ? 0u : image->fallback;
            if (image->pixels) {
                word = hdrp_i_variant_tile_word(image, x * tile_size, right, y * tile_size, bottom);
            }
            words[(size_t)y * tiles_x + x] = word;
        }
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_cull_combine_features(const uint32_t* materials, const uint32_t* lights,
                                                uint32_t* words, uint32_t first, uint32_t count)
{
    uint32_t i;
    if (!materials || !words) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (count > 0xffffffffu - first) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (i = first; i < first + count; ++i) {
        words[i] = materials[i] == 0u ? 0u : materials[i] | (lights ? lights[i] : 0u);
    }
    return HDRP_OK;
}

/* ---- dispatch -------------------------------------------------------------------------------- */

static hdrp_result hdrp_i_variant_check_list(const hdrp_cull_variant_list* variants)
{
    uint32_t r;
    if (!variants || !variants->masks) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (variants->count < 1u || variants->count > HDRP_CULL_VARIANT_MAX) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (r = 0u; variants->costs && r < variants->count; ++r) {
        if (!(variants->costs[r] == variants->costs[r])) {
            return HDRP_ERROR_BAD_ARGUMENT;
        }
    }
    return HDRP_OK;
}

/* The variant of a set: the first that covers it, or the cheapest. */
static uint32_t hdrp_i_variant_of(const hdrp_cull_variant_list* variants, uint32_t features)
{
    uint32_t best = HDRP_CULL_VARIANT_NONE, r;
    for (r = 0u; r < variants->count; ++r) {
        if (hdrp_cull_variant_covers(variants->masks[r], features) == 0u) {
            continue;
        }
        if (!variants->costs) {
            return r;
        }
        if (best == HDRP_CULL_VARIANT_NONE || variants->costs[r] < variants->costs[best]) {
            best = r;
        }
    }
    return best;
}

HDRP_API hdrp_result hdrp_cull_assign_variants(const hdrp_cull_variant_list* variants,
                                               const uint32_t* words, uint8_t* chosen,
                                               uint32_t first, uint32_t count)
{
    hdrp_result result = hdrp_i_variant_check_list(variants);
    uint32_t i, last_word = 0u, last = HDRP_CULL_VARIANT_EMPTY;
    if (result != HDRP_OK || !words || !chosen) {
        return result != HDRP_OK ? result : HDRP_ERROR_NULL_POINTER;
    }
    if (count > 0xffffffffu - first) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (i = first; i < first + count; ++i) {
        if (words[i] != last_word) { /* neighbours are often alike */
            last_word = words[i];
            last =
                last_word == 0u ? HDRP_CULL_VARIANT_EMPTY : hdrp_i_variant_of(variants, last_word);
        }
        chosen[i] = (uint8_t)last;
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_cull_build_dispatch(hdrp_cull_dispatch* dispatch, const uint8_t* chosen,
                                              uint32_t tiles_x, uint32_t tiles_y)
{
    uint64_t wanted[HDRP_CULL_VARIANT_MAX] = {0u};
    uint64_t empty = 0u, uncovered = 0u, dropped = 0u, i;
    uint32_t r, x, y, room;
    if (!dispatch || !dispatch->arguments || !chosen ||
        (!dispatch->tiles && dispatch->tile_capacity > 0u)) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (dispatch->variant_count < 1u || dispatch->variant_count > HDRP_CULL_VARIANT_MAX ||
        !hdrp_i_variant_is_size(tiles_x) || !hdrp_i_variant_is_size(tiles_y) ||
        tiles_x > 0xffffffffu / tiles_y) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    for (i = 0u; i < (uint64_t)tiles_x * tiles_y; ++i) {
        if (chosen[i] < dispatch->variant_count) {
            ++wanted[chosen[i]];
        } else if (chosen[i] == HDRP_CULL_VARIANT_EMPTY) {
            ++empty;
        } else {
            ++uncovered;
        }
    }
    room = dispatch->tile_capacity;
    for (r = 0u; r < dispatch->variant_count; ++r) {
        uint32_t fits = wanted[r] < room ? (uint32_t)wanted[r] : room;
        dispatch->arguments[r].groups_x = fits;
        dispatch->arguments[r].groups_y = 1u;
        dispatch->arguments[r].groups_z = 1u;
        dispatch->arguments[r].first = dispatch->tile_capacity - room;
        dropped += wanted[r] - fits;
        room -= fits;
        wanted[r] = 0u; /* from here on the tiles written so far */
    }
    for (y = 0u; y < tiles_y; ++y) {
        for (x = 0u; x < tiles_x; ++x) {
            r = chosen[(size_t)y * tiles_x + x];
            if (r < dispatch->variant_count && wanted[r] < dispatch->arguments[r].groups_x) {
                dispatch->tiles[dispatch->arguments[r].first + (uint32_t)wanted[r]++] =
                    hdrp_cull_tile_id(x, y);
            }
        }
    }
    dispatch->listed = dispatch->tile_capacity - room;
    dispatch->empty = (uint32_t)empty;
    dispatch->uncovered = (uint32_t)uncovered;
    dispatch->dropped = (uint32_t)dropped;
    return HDRP_OK;
}

/* ---- statistics ------------------------------------------------------------------------------ */

static hdrp_result hdrp_i_variant_check_histogram(const hdrp_cull_histogram* histogram)
{
    if (!histogram || !histogram->entries) {
        return HDRP_ERROR_NULL_POINTER;
    }
    return histogram->capacity < 1u || histogram->count > histogram->capacity
               ? HDRP_ERROR_BAD_ARGUMENT
               : HDRP_OK;
}

/* Adds weight to a set; where there is no room the largest word goes. */
static void hdrp_i_variant_count(hdrp_cull_histogram* h, uint32_t features, uint64_t weight)
{
    uint32_t low = 0u, high = h->count, i;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2u;
        if (h->entries[middle].features < features) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    if (low < h->count && h->entries[low].features == features) {
        h->entries[low].weight += weight;
        return;
    }
    if (h->count == h->capacity) {
        if (low == h->count) {
            h->left_out += weight;
            return;
        }
        h->left_out += h->entries[--h->count].weight;
    }
    for (i = h->count; i > low; --i) {
        h->entries[i] = h->entries[i - 1u];
    }
    h->entries[low].features = features;
    h->entries[low].weight = weight;
    ++h->count;
}

HDRP_API hdrp_result hdrp_cull_histogram_add(hdrp_cull_histogram* histogram, const uint32_t* words,
                                             const uint32_t* weights, uint32_t count)
{
    hdrp_result result = hdrp_i_variant_check_histogram(histogram);
    uint32_t i;
    if (result != HDRP_OK || !words) {
        return result != HDRP_OK ? result : HDRP_ERROR_NULL_POINTER;
    }
    for (i = 0u; i < count; ++i) {
        if (words[i] != 0u) {
            hdrp_i_variant_count(histogram, words[i], weights ? weights[i] : 1u);
        }
    }
    return HDRP_OK;
}

HDRP_API hdrp_result hdrp_cull_histogram_merge(hdrp_cull_histogram* histogram,
                                               const hdrp_cull_histogram* other)
{
    hdrp_result result = hdrp_i_variant_check_histogram(histogram);
    uint32_t i;
    result = result == HDRP_OK ? hdrp_i_variant_check_histogram(other) : result;
    if (result == HDRP_OK) {
        for (i = 0u; i < other->count; ++i) {
            hdrp_i_variant_count(histogram, other->entries[i].features, other->entries[i].weight);
        }
        histogram->left_out += other->left_out;
    }
    return result;
}

HDRP_API uint32_t hdrp_cull_all_features(const hdrp_cull_feature_count* sets, uint32_t count)
{
    uint32_t all = 0u, i;
    for (i = 0u; sets && i < count; ++i) {
        all |= sets[i].features;
    }
    return all;
}

/* ---- costs ----------------------------------------------------------------------------------- */

HDRP_API double hdrp_cull_model_cost(hdrp_u32 features, void* model)
{
    const hdrp_cull_cost_model* m = (const hdrp_cull_cost_model*)model;
    double alu, latency, registers, peak = 0.0, waves, whole = 1.0;
    uint32_t b;
    if (!m) {
        return 0.0;
    }
    alu = m->alu;
    latency = m->latency;
    registers = m->registers;
    for (b = 0u; b < 32u; ++b) {
        if (((features >> b) & 1u) != 0u) {
            alu += m->feature_alu[b];
            latency += m->feature_latency[b];
            registers += m->feature_registers[b];
            peak = m->feature_peak[b] > peak ? m->feature_peak[b] : peak;
        }
    }
    registers += peak;
    waves = registers > 0.0 ? m->register_count / registers : m->waves_max;
    waves = waves < m->waves_max ? waves : m->waves_max;
    if (waves >= 1.0) {
        whole = (double)(uint32_t)waves;
    }
    /* Quotients, whose sums no compiler contracts. */
    return alu + latency / (whole / m->waves_max);
}

HDRP_API hdrp_result hdrp_cull_report_variants(const hdrp_cull_variant_list* variants,
                                               const hdrp_cull_feature_count* sets,
                                               uint32_t set_count, hdrp_cull_cost cost, void* user,
                                               hdrp_cull_variant_report* reports,
                                               hdrp_cull_variant_total* total)
{
    hdrp_result result = hdrp_i_variant_check_list(variants);
    double costs[HDRP_CULL_VARIANT_MAX];
    uint32_t i, r, b;
    if (result != HDRP_OK || !sets || !cost || !total) {
        return result != HDRP_OK ? result : HDRP_ERROR_NULL_POINTER;
    }
    for (r = 0u; r < variants->count; ++r) {
        costs[r] = cost(variants->masks[r], user);
        if (!(costs[r] == costs[r])) {
            return HDRP_ERROR_BAD_ARGUMENT;
        }
    }
    for (r = 0u; reports && r < variants->count; ++r) {
        memset(&reports[r], 0, sizeof reports[r]);
        reports[r].cost = costs[r];
    }
    total->cost = 0.0;
    total->uncovered = 0u;
    for (i = 0u; i < set_count; ++i) {
        uint32_t vain;
        r = hdrp_i_variant_of(variants, sets[i].features);
        if (r == HDRP_CULL_VARIANT_NONE) {
            total->uncovered += sets[i].weight;
            continue;
        }
        total->cost += costs[r] * (double)sets[i].weight;
        vain = hdrp_cull_superfluous_features(variants->masks[r], sets[i].features);
        for (b = 0u; reports && b < 32u; ++b) {
            reports[r].superfluous[b] += ((vain >> b) & 1u) != 0u ? sets[i].weight : 0u;
        }
        if (reports) {
            reports[r].weight += sets[i].weight;
        }
    }
    return HDRP_OK;
}

/* ---- automatic choice: state ----------------------------------------------------------------- */

#define HDRP_I_VARIANT_NONE     0xffffffffu
#define HDRP_I_VARIANT_CACHE    16384u /* costs that are remembered, a power of two */
#define HDRP_I_VARIANT_LEVELS   33u    /* of the tree over features: one per bit and the root */
#define HDRP_I_VARIANT_INFINITE ((int64_t)1 << 56)

/* Totals stay below 2^48 and sums over sets below 2^60. */
#define HDRP_I_VARIANT_TOTAL ((double)((int64_t)1 << 48))

/* A choice: masks of variants. */
typedef struct hdrp_i_variant_set {
    uint32_t count;
    uint32_t masks[HDRP_CULL_VARIANT_MAX];
} hdrp_i_variant_set;

/* The columns of smallest value, in increasing order, and one more. */
typedef struct hdrp_i_variant_pick {
    uint32_t count;
    uint32_t columns[HDRP_CULL_VARIANT_MAX + 1u];
} hdrp_i_variant_pick;

/* The search. "Sets" are what is to be covered, "columns" unions of them that may become variants.
 * Costs are whole numbers on the grid. */
typedef struct hdrp_i_variant_search {
    hdrp_cull_cost cost_of;
    void* user;
    double scale; /* grid points per unit of cost, a power of two */
    int64_t work, work_limit;
    int64_t upper, lower; /* best total, bound that is proven */
    hdrp_i_variant_set best;
    uint32_t n, limit, capacity, union_limit;
    uint32_t all;          /* union of all sets */
    int64_t worst;         /* its cost */
    uint32_t count;        /* of columns */
    uint32_t active_count; /* of those that a better choice may use */
    uint32_t nodes;
    int is_complete; /* all unions are columns */
    int is_bad;      /* the caller's cost is out of its range */
    int is_not_monotone;
    /* per set */
    uint32_t *feature, *owner, *order, *sorted_feature, *group_mask, *group_next;
    int64_t *weight, *own;         /* own: cost of the cheapest that covers it */
    int64_t *first, *second;       /* cheapest and next in the choice that was assigned last */
    int64_t *lambda, *kept, *root; /* multipliers: now, of the best bound, of the root's */
    int64_t *sorted_weight, *sorted_lambda, *sorted_cut, *cut;
    int64_t *group_weight, *group_delta;
    int64_t* levels; /* multipliers of the nodes above */
    int32_t* direction;
    uint32_t* lists; /* of the tree over features */
    /* per column */
    uint32_t *mask, *hash, *hits, *active;
    int64_t *cost, *rho;
    uint8_t* is_in;
    /* costs that were asked for */
    uint32_t* cache_mask;
    int64_t* cache_cost;
} hdrp_i_variant_search;

/* A place in the caller's block; without a block it only counts. */
static void* hdrp_i_variant_take(unsigned char* block, size_t* used, size_t count, size_t size)
{
    size_t at = *used;
    *used += HDRP_MEMORY_ROUND_UP(count * size);
    return block ? (void*)(block + at) : NULL;
}

/* Sets the pointers of a search whose sizes are known. Returns the bytes it takes. */
static size_t hdrp_i_variant_place(hdrp_i_variant_search* s, unsigned char* block)
{
    size_t used = 0u, n = s->n, columns = s->capacity, i;
    uint32_t** words[6];
    int64_t** numbers[13];
    words[0] = &s->feature;
    words[1] = &s->owner;
    words[2] = &s->order;
    words[3] = &s->sorted_feature;
    words[4] = &s->group_mask;
    words[5] = &s->group_next;
    numbers[0] = &s->weight;
    numbers[1] = &s->own;
    numbers[2] = &s->first;
    numbers[3] = &s->second;
    numbers[4] = &s->lambda;
    numbers[5] = &s->kept;
    numbers[6] = &s->root;
    numbers[7] = &s->sorted_weight;
    numbers[8] = &s->sorted_lambda;
    numbers[9] = &s->sorted_cut;
    numbers[10] = &s->cut;
    numbers[11] = &s->group_weight;
    numbers[12] = &s->group_delta;
    for (i = 0u; i < 6u; ++i) {
        *words[i] = (uint32_t*)hdrp_i_variant_take(block, &used, n, sizeof(uint32_t));
    }
    for (i = 0u; i < 13u; ++i) {
        *numbers[i] = (int64_t*)hdrp_i_variant_take(block, &used, n, sizeof(int64_t));
    }
    s->levels = (int64_t*)hdrp_i_variant_take(block, &used, n * s->limit, sizeof(int64_t));
    s->direction = (int32_t*)hdrp_i_variant_take(block, &used, n, sizeof(int32_t));
    s->lists =
        (uint32_t*)hdrp_i_variant_take(block, &used, n * HDRP_I_VARIANT_LEVELS, sizeof(uint32_t));
    s->mask = (uint32_t*)hdrp_i_variant_take(block, &used, columns, sizeof(uint32_t));
    s->hash = (uint32_t*)hdrp_i_variant_take(block, &used, 2u * columns, sizeof(uint32_t));
    s->hits = (uint32_t*)hdrp_i_variant_take(block, &used, columns, sizeof(uint32_t));
    s->active = (uint32_t*)hdrp_i_variant_take(block, &used, columns, sizeof(uint32_t));
    s->cost = (int64_t*)hdrp_i_variant_take(block, &used, columns, sizeof(int64_t));
    s->rho = (int64_t*)hdrp_i_variant_take(block, &used, columns, sizeof(int64_t));
    s->is_in = (uint8_t*)hdrp_i_variant_take(block, &used, columns, sizeof(uint8_t));
    s->cache_mask =
        (uint32_t*)hdrp_i_variant_take(block, &used, HDRP_I_VARIANT_CACHE, sizeof(uint32_t));
    s->cache_cost =
        (int64_t*)hdrp_i_variant_take(block, &used, HDRP_I_VARIANT_CACHE, sizeof(int64_t));
    return used;
}

/* Cost of a mask on the grid. What costs more than the union of all is as good as that. */
static int64_t hdrp_i_variant_cost(hdrp_i_variant_search* s, uint32_t mask)
{
    uint32_t slot = hdrp_hash1(mask) & (HDRP_I_VARIANT_CACHE - 1u);
    if (s->cache_cost[slot] < 0 || s->cache_mask[slot] != mask) {
        double c = s->cost_of(mask, s->user);
        int64_t grid = s->worst;
        if (!(c >= 0.0 && c <= 1e30)) {
            s->is_bad = 1;
            c = 0.0;
        }
        c *= s->scale;
        if (c < (double)s->worst) {
            grid = (int64_t)(c + 0.5);
        }
        s->cache_mask[slot] = mask;
        s->cache_cost[slot] = grid;
        s->is_not_monotone |= c > (double)s->worst + 0.5;
    }
    return s->cache_cost[slot];
}

static int hdrp_i_variant_lacks(uint32_t features, uint32_t mask)
{
    return (features & ~mask) != 0u;
}

/* The column of a mask, which becomes one where there is room. */
static uint32_t hdrp_i_variant_column(hdrp_i_variant_search* s, uint32_t mask)
{
    uint32_t size = 2u * s->capacity;
    uint32_t slot = hdrp_hash1(mask) % size;
    while (s->hash[slot] != HDRP_I_VARIANT_NONE) {
        if (s->mask[s->hash[slot]] == mask) {
            return s->hash[slot];
        }
        slot = slot + 1u == size ? 0u : slot + 1u;
    }
    if (s->count == s->capacity) {
        return HDRP_I_VARIANT_NONE;
    }
    s->hash[slot] = s->count;
    s->mask[s->count] = mask;
    s->cost[s->count] = hdrp_i_variant_cost(s, mask);
    s->hits[s->count] = 0u;
    s->is_in[s->count] = 0u;
    return s->count++;
}

static void hdrp_i_variant_activate(hdrp_i_variant_search* s)
{
    uint32_t j;
    for (j = 0u; j < s->count; ++j) {
        s->active[j] = j;
        s->is_in[j] = 0u;
    }
    s->active_count = s->count;
}

/* Columns of all unions where there are few, else of the sets and the union of all. */
static void hdrp_i_variant_close(hdrp_i_variant_search* s)
{
    uint32_t i, j;
    s->count = 0u;
    memset(s->hash, 0xff, 2u * (size_t)s->capacity * sizeof *s->hash);
    s->is_complete = 1;
    for (i = 0u; i < s->n && s->is_complete; ++i) {
        uint32_t before = s->count;
        hdrp_i_variant_column(s, s->feature[i]);
        for (j = 0u; j < before && s->is_complete; ++j) {
            uint32_t u = s->mask[j] | s->feature[i];
            hdrp_i_variant_column(s, u);
            s->is_complete = s->count <= s->union_limit;
        }
        s->work += before;
    }
    if (!s->is_complete) {
        s->count = 0u;
        memset(s->hash, 0xff, 2u * (size_t)s->capacity * sizeof *s->hash);
        for (i = 0u; i < s->n; ++i) {
            hdrp_i_variant_column(s, s->feature[i]);
        }
        hdrp_i_variant_column(s, s->all);
    }
    hdrp_i_variant_activate(s);
}

/* The cost of the cheapest column that covers each set: its own, if the cost is monotone. */
static void hdrp_i_variant_own_costs(hdrp_i_variant_search* s)
{
    uint32_t i, j;
    s->lower = 0;
    for (i = 0u; i < s->n; ++i) {
        int64_t least = hdrp_i_variant_cost(s, s->feature[i]);
        for (j = 0u; s->is_complete && j < s->count; ++j) {
            if (s->cost[j] < least && !hdrp_i_variant_lacks(s->feature[i], s->mask[j])) {
                least = s->cost[j];
                s->is_not_monotone = 1;
            }
        }
        s->own[i] = least;
        s->lower += s->weight[i] * least;
    }
}

/* ---- automatic choice: choices --------------------------------------------------------------- */

/* Total of a choice; which variant serves each set, its cost and that of the next. */
static int64_t hdrp_i_variant_assign(hdrp_i_variant_search* s, const hdrp_i_variant_set* v)
{
    int64_t c[HDRP_CULL_VARIANT_MAX], total = 0;
    uint32_t i, r;
    for (r = 0u; r < v->count; ++r) {
        c[r] = hdrp_i_variant_cost(s, v->masks[r]);
    }
    for (i = 0u; i < s->n; ++i) {
        int64_t a = HDRP_I_VARIANT_INFINITE, b = HDRP_I_VARIANT_INFINITE;
        uint32_t who = 0u;
        for (r = 0u; r < v->count; ++r) {
            if (hdrp_i_variant_lacks(s->feature[i], v->masks[r])) {
                continue;
            }
            if (c[r] < a) {
                b = a;
                a = c[r];
                who = r;
            } else if (c[r] < b) {
                b = c[r];
            }
        }
        s->first[i] = a;
        s->second[i] = b;
        s->owner[i] = who;
        if (a == HDRP_I_VARIANT_INFINITE || total == HDRP_I_VARIANT_INFINITE) {
            total = HDRP_I_VARIANT_INFINITE;
        } else {
            total += s->weight[i] * a;
        }
    }
    s->work += (int64_t)s->n * v->count;
    return total;
}

/* Takes from each variant what no set that it serves needs, and drops the idle, while that helps.
 * Returns the total of the result, to which the sets are assigned. */
static int64_t hdrp_i_variant_shrink(hdrp_i_variant_search* s, hdrp_i_variant_set* v)
{
    int64_t total = hdrp_i_variant_assign(s, v), before = HDRP_I_VARIANT_INFINITE;
    while (total < before) {
        uint32_t need[HDRP_CULL_VARIANT_MAX] = {0u}, i, r, kept = 0u;
        uint8_t is_used[HDRP_CULL_VARIANT_MAX] = {0u};
        for (i = 0u; i < s->n; ++i) {
            need[s->owner[i]] |= s->feature[i];
            is_used[s->owner[i]] = 1u;
        }
        for (r = 0u; r < v->count; ++r) {
            uint32_t m = v->masks[r];
            if (is_used[r]) {
                v->masks[kept++] =
                    hdrp_i_variant_cost(s, need[r]) <= hdrp_i_variant_cost(s, m) ? need[r] : m;
            }
        }
        v->count = kept;
        before = total;
        total = hdrp_i_variant_assign(s, v);
    }
    return total;
}

static void hdrp_i_variant_offer(hdrp_i_variant_search* s, const hdrp_i_variant_set* v,
                                 int64_t total)
{
    if (total < s->upper) {
        s->upper = total;
        s->best = *v;
    }
}

/* An exchange of variant r for a mask; r is the number of variants where it is added. */
typedef struct hdrp_i_variant_move {
    int64_t gain;
    uint32_t mask, r;
} hdrp_i_variant_move;

/* The best exchange that brings a mask in. */
static void hdrp_i_variant_try(hdrp_i_variant_search* s, uint32_t mask, int64_t c, uint32_t count,
                               hdrp_i_variant_move* best)
{
    int64_t loss[HDRP_CULL_VARIANT_MAX], gain = 0;
    uint32_t i, r;
    for (r = 0u; r < count; ++r) {
        loss[r] = 0;
    }
    for (i = 0u; i < s->n; ++i) {
        int64_t now = s->first[i], next = s->second[i];
        if (!hdrp_i_variant_lacks(s->feature[i], mask)) {
            if (c < now) {
                gain += s->weight[i] * (now - c);
                continue;
            }
            next = c < next ? c : next;
        }
        loss[s->owner[i]] += next >= HDRP_I_VARIANT_INFINITE ? HDRP_I_VARIANT_INFINITE / 256
                                                             : s->weight[i] * (next - now);
    }
    s->work += s->n;
    if (count < s->limit && gain > best->gain) {
        best->gain = gain;
        best->mask = mask;
        best->r = count;
    }
    for (r = 0u; r < count; ++r) {
        if (gain - loss[r] > best->gain) {
            best->gain = gain - loss[r];
            best->mask = mask;
            best->r = r;
        }
    }
}

/* Exchanges for what is close to a variant: with one set more, or without one feature. */
static void hdrp_i_variant_neighbours(hdrp_i_variant_search* s, const hdrp_i_variant_set* v,
                                      hdrp_i_variant_move* best)
{
    uint32_t r, i, b;
    for (r = 0u; r < v->count; ++r) {
        for (i = 0u; i < s->n; ++i) {
            uint32_t u = v->masks[r] | s->feature[i];
            if (u != v->masks[r]) {
                hdrp_i_variant_try(s, u, hdrp_i_variant_cost(s, u), v->count, best);
            }
        }
        for (b = 0u; b < 32u; ++b) {
            uint32_t less = v->masks[r] & ~(1u << b), u = 0u;
            for (i = 0u; less != v->masks[r] && i < s->n; ++i) {
                u |= hdrp_i_variant_lacks(s->feature[i], less) ? 0u : s->feature[i];
            }
            if (u != 0u) {
                hdrp_i_variant_try(s, u, hdrp_i_variant_cost(s, u), v->count, best);
            }
        }
    }
}

/* The best exchanges one after the other, until none helps. */
static void hdrp_i_variant_interchange(hdrp_i_variant_search* s, hdrp_i_variant_set* v)
{
    int64_t total = hdrp_i_variant_shrink(s, v);
    for (;;) {
        hdrp_i_variant_move best = {0, 0u, 0u};
        uint32_t a;
        for (a = 0u; a < s->active_count; ++a) {
            uint32_t j = s->active[a];
            hdrp_i_variant_try(s, s->mask[j], s->cost[j], v->count, &best);
        }
        if (best.gain <= 0) {
            hdrp_i_variant_neighbours(s, v, &best);
        }
        if (best.gain <= 0) {
            break;
        }
        if (!s->is_complete) {
            hdrp_i_variant_column(s, best.mask);
        }
        v->masks[best.r] = best.mask;
        v->count += best.r == v->count ? 1u : 0u;
        total = hdrp_i_variant_shrink(s, v);
    }
    hdrp_i_variant_offer(s, v, total);
}

/* How much more two groups cost in one variant than in two. */
static int64_t hdrp_i_variant_merged(hdrp_i_variant_search* s, uint32_t a, uint32_t b)
{
    uint32_t both = s->group_mask[a] | s->group_mask[b];
    return (s->group_weight[a] + s->group_weight[b]) * hdrp_i_variant_cost(s, both) -
           s->group_weight[a] * hdrp_i_variant_cost(s, s->group_mask[a]) -
           s->group_weight[b] * hdrp_i_variant_cost(s, s->group_mask[b]);
}

static void hdrp_i_variant_nearest(hdrp_i_variant_search* s, uint32_t a, uint32_t begin,
                                   uint32_t end)
{
    uint32_t b;
    for (b = begin; b < end; ++b) {
        int64_t d = hdrp_i_variant_merged(s, a, b);
        if (s->group_next[a] == HDRP_I_VARIANT_NONE || d < s->group_delta[a]) {
            s->group_delta[a] = d;
            s->group_next[a] = b;
        }
    }
    s->work += end - begin;
}

/* A first choice: each set a group of its own, and the two merged that cost least, again and
 * again. */
static void hdrp_i_variant_agglomerate(hdrp_i_variant_search* s, hdrp_i_variant_set* v)
{
    uint32_t count = s->n, i;
    for (i = 0u; i < count; ++i) {
        s->group_mask[i] = s->feature[i];
        s->group_weight[i] = s->weight[i];
        s->group_next[i] = HDRP_I_VARIANT_NONE;
    }
    for (i = 0u; i < count; ++i) {
        hdrp_i_variant_nearest(s, i, i + 1u, count);
    }
    while (count > s->limit) {
        uint32_t a = 0u, b;
        for (i = 1u; i + 1u < count; ++i) {
            a = s->group_delta[i] < s->group_delta[a] ? i : a;
        }
        b = s->group_next[a];
        s->group_mask[a] |= s->group_mask[b];
        s->group_weight[a] += s->group_weight[b];
        --count;
        s->group_mask[b] = s->group_mask[count]; /* the last group moves */
        s->group_weight[b] = s->group_weight[count];
        if (!s->is_complete) {
            hdrp_i_variant_column(s, s->group_mask[a]);
        }
        for (i = 0u; i < count; ++i) {
            uint32_t to = s->group_next[i];
            if (i == a || i == b || to == a || to == b || to >= count) {
                s->group_next[i] = HDRP_I_VARIANT_NONE;
                hdrp_i_variant_nearest(s, i, i + 1u, count);
                continue;
            }
            if (a > i) {
                hdrp_i_variant_nearest(s, i, a, a + 1u);
            }
            if (b > i && b < count) {
                hdrp_i_variant_nearest(s, i, b, b + 1u);
            }
        }
    }
    v->count = count;
    memcpy(v->masks, s->group_mask, count * sizeof *v->masks);
}

/* ---- automatic choice: bounds ---------------------------------------------------------------- */

/* Puts the sets in the order of the cost of a variant at which it is no longer worth to serve them:
 * then those that a column serves are among the first. */
static void hdrp_i_variant_sort(hdrp_i_variant_search* s)
{
    uint32_t i;
    for (i = 0u; i < s->n; ++i) {
        int64_t w = s->weight[i], l = s->lambda[i];
        s->cut[i] = w > 0 ? (l + w - 1) / w : (l > 0 ? HDRP_I_VARIANT_INFINITE : 0);
    }
    for (i = 1u; i < s->n; ++i) {
        uint32_t q = s->order[i], a = i;
        for (; a > 0u && s->cut[s->order[a - 1u]] < s->cut[q]; --a) {
            s->order[a] = s->order[a - 1u];
        }
        s->order[a] = q;
    }
    for (i = 0u; i < s->n; ++i) {
        uint32_t q = s->order[i];
        s->sorted_feature[i] = s->feature[q];
        s->sorted_weight[i] = s->weight[q];
        s->sorted_lambda[i] = s->lambda[q];
        s->sorted_cut[i] = s->cut[q];
    }
}

/* What a column is worth at the multipliers: the sum of min(0, weight * cost - lambda) over the
 * sets that it covers. */
static int64_t hdrp_i_variant_rho(hdrp_i_variant_search* s, uint32_t j)
{
    uint32_t out = ~s->mask[j], low = 0u, high = s->n, i;
    int64_t weight = 0, lambda = 0;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2u;
        if (s->sorted_cut[middle] > s->cost[j]) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    for (i = 0u; i < low; ++i) {
        int64_t covered = -(int64_t)((s->sorted_feature[i] & out) == 0u);
        weight += s->sorted_weight[i] & covered;
        lambda += s->sorted_lambda[i] & covered;
    }
    s->work += low + 4u;
    return weight * s->cost[j] - lambda;
}

static int64_t hdrp_i_variant_sum(const int64_t* v, uint32_t count)
{
    int64_t sum = 0;
    uint32_t i;
    for (i = 0u; i < count; ++i) {
        sum += v[i];
    }
    return sum;
}

/* The value of the relaxation at the multipliers: with the columns that are in and the best of the
 * other active ones, at most so many as wanted, one more of which is picked. */
static int64_t hdrp_i_variant_relax(hdrp_i_variant_search* s, hdrp_i_variant_pick* pick,
                                    uint32_t wanted)
{
    int64_t sum = hdrp_i_variant_sum(s->lambda, s->n);
    uint32_t a, q;
    hdrp_i_variant_sort(s);
    pick->count = 0u;
    for (a = 0u; a < s->active_count; ++a) {
        uint32_t j = s->active[a];
        int64_t rho = hdrp_i_variant_rho(s, j);
        s->rho[j] = rho;
        if (s->is_in[j]) {
            sum += rho;
            continue;
        }
        q = pick->count;
        if (rho >= 0 || (q > wanted && rho >= s->rho[pick->columns[q - 1u]])) {
            continue;
        }
        q -= q > wanted ? 1u : 0u;
        pick->count = q + 1u;
        for (; q > 0u && s->rho[pick->columns[q - 1u]] > rho; --q) {
            pick->columns[q] = pick->columns[q - 1u];
        }
        pick->columns[q] = j;
    }
    for (a = 0u; a < pick->count && a < wanted; ++a) {
        sum += s->rho[pick->columns[a]];
    }
    return sum;
}

/* The columns that are in and those that were picked. */
static void hdrp_i_variant_gather(const hdrp_i_variant_search* s, const hdrp_i_variant_pick* pick,
                                  uint32_t wanted, hdrp_i_variant_set* v)
{
    uint32_t a;
    v->count = 0u;
    for (a = 0u; a < s->active_count; ++a) {
        if (s->is_in[s->active[a]]) {
            v->masks[v->count++] = s->mask[s->active[a]];
        }
    }
    for (a = 0u; a < pick->count && a < wanted; ++a) {
        v->masks[v->count++] = s->mask[pick->columns[a]];
    }
}

/* Makes a choice cover everything, as cheaply as one more or one larger variant can, and offers
 * it. */
static void hdrp_i_variant_repair(hdrp_i_variant_search* s, hdrp_i_variant_set v)
{
    int64_t least = HDRP_I_VARIANT_INFINITE;
    uint32_t i, r, u = 0u, best = 0u;
    hdrp_i_variant_assign(s, &v);
    for (i = 0u; i < s->n; ++i) {
        u |= s->first[i] >= HDRP_I_VARIANT_INFINITE ? s->feature[i] : 0u;
    }
    if (v.count < s->limit) {
        v.masks[v.count++] = u;
    } else if (u != 0u) {
        for (r = 0u; r < v.count; ++r) {
            uint32_t mask = v.masks[r];
            int64_t total;
            v.masks[r] |= u;
            total = hdrp_i_variant_assign(s, &v);
            best = total < least ? r : best;
            least = total < least ? total : least;
            v.masks[r] = mask;
        }
        v.masks[best] |= u;
    }
    least = hdrp_i_variant_shrink(s, &v);
    hdrp_i_variant_offer(s, &v, least);
}

/* One step along the subgradient, deflected by the steps before. Returns 0 where there is none. */
static int hdrp_i_variant_step(hdrp_i_variant_search* s, const hdrp_i_variant_set* v, double theta,
                               int64_t value)
{
    int64_t c[HDRP_CULL_VARIANT_MAX], norm = 0;
    uint32_t i, r;
    double step;
    for (r = 0u; r < v->count; ++r) {
        c[r] = hdrp_i_variant_cost(s, v->masks[r]);
    }
    for (i = 0u; i < s->n; ++i) {
        int32_t g = 16; /* steps are in sixteenths */
        for (r = 0u; r < v->count; ++r) {
            if (!hdrp_i_variant_lacks(s->feature[i], v->masks[r]) &&
                s->weight[i] * c[r] < s->lambda[i]) {
                g -= 16;
            }
        }
        s->direction[i] = g + s->direction[i] * 10 / 16;
        norm += (int64_t)s->direction[i] * s->direction[i];
    }
    s->work += (int64_t)s->n * v->count;
    if (norm == 0) {
        return 0;
    }
    step = theta * 16.0 * (double)(s->upper - value + s->upper / 1024) / (double)norm;
    for (i = 0u; i < s->n; ++i) {
        int64_t low = s->weight[i] * s->own[i];
        int64_t l = s->lambda[i] + (int64_t)(step * (double)s->direction[i]);
        l = l < s->upper ? l : s->upper;
        s->lambda[i] = l > low ? l : low;
    }
    return 1;
}

/* Improves the multipliers, and offers choices on the way. Leaves the best multipliers, and in hits
 * how often each column was picked. */
static void hdrp_i_variant_ascend(hdrp_i_variant_search* s, uint32_t wanted, uint32_t steps,
                                  double theta)
{
    int64_t best = -HDRP_I_VARIANT_INFINITE;
    uint32_t t, a, stale = 0u;
    for (a = 0u; a < s->active_count; ++a) {
        s->hits[s->active[a]] = 0u;
    }
    memset(s->direction, 0, s->n * sizeof *s->direction);
    memcpy(s->kept, s->lambda, s->n * sizeof *s->kept);
    for (t = 0u; t < steps && best < s->upper && theta >= 0.01; ++t) {
        hdrp_i_variant_pick pick;
        hdrp_i_variant_set v;
        int64_t value = hdrp_i_variant_relax(s, &pick, wanted);
        if (value > best) {
            best = value;
            stale = 0u;
            memcpy(s->kept, s->lambda, s->n * sizeof *s->kept);
        } else if (++stale == 8u) {
            theta *= 0.5;
            stale = 0u;
            memcpy(s->lambda, s->kept, s->n * sizeof *s->kept);
            memset(s->direction, 0, s->n * sizeof *s->direction);
            continue;
        }
        hdrp_i_variant_gather(s, &pick, wanted, &v);
        for (a = 0u; a < pick.count && a < wanted; ++a) {
            ++s->hits[pick.columns[a]];
        }
        if (!hdrp_i_variant_step(s, &v, theta, value)) {
            break;
        }
        if (t % 8u == 7u) {
            hdrp_i_variant_repair(s, v);
        }
    }
    memcpy(s->lambda, s->kept, s->n * sizeof *s->kept);
}

/* ---- automatic choice: pricing --------------------------------------------------------------- */

/* A walk over all unions, by deciding features: with a bit first, then without it. */
typedef struct hdrp_i_variant_tree {
    uint32_t depth;
    uint32_t with[HDRP_I_VARIANT_LEVELS + 1u];  /* features that are in */
    uint32_t bit[HDRP_I_VARIANT_LEVELS + 1u];   /* that is decided, as a mask */
    uint32_t count[HDRP_I_VARIANT_LEVELS + 1u]; /* of the sets that may still count */
    uint8_t stage[HDRP_I_VARIANT_LEVELS + 1u];
    uint32_t found;
    int64_t least[HDRP_CULL_VARIANT_MAX]; /* the smallest values, ascending */
} hdrp_i_variant_tree;

/* Bounds the values of unions that have the features of this level. A set adds at best what it
 * would in its union with them, if more features never cost less. Keeps the sets that add, and
 * picks the bit that decides most. */
static int64_t hdrp_i_variant_tree_bound(hdrp_i_variant_search* s, hdrp_i_variant_tree* t,
                                         uint32_t* needed)
{
    uint32_t d = t->depth, with = t->with[d], kept = 0u, i, b;
    uint32_t* list = s->lists + (size_t)d * s->n;
    int64_t share[32] = {0}, sum = 0, largest = -1;
    *needed = 0u;
    for (i = 0u; i < t->count[d]; ++i) {
        uint32_t q = list[i], rest = s->feature[q] & ~with;
        int64_t c = hdrp_i_variant_cost(s, with | s->feature[q]);
        int64_t g = s->weight[q] * c - s->lambda[q];
        s->is_not_monotone |= c < s->own[q];
        if (g >= 0) {
            continue;
        }
        list[kept++] = q;
        sum += g;
        *needed |= s->feature[q];
        for (b = 0u; rest != 0u; ++b, rest >>= 1u) {
            share[b] -= (rest & 1u) != 0u ? g : 0;
        }
    }
    s->work += 4 * (int64_t)t->count[d] + 32;
    t->count[d] = kept;
    t->bit[d] = 0u;
    for (b = 0u; b < 32u; ++b) {
        if (((*needed & ~with) >> b & 1u) != 0u && share[b] > largest) {
            largest = share[b];
            t->bit[d] = 1u << b;
        }
    }
    return sum;
}

/* One level deeper, with the bit that was picked or without. */
static void hdrp_i_variant_tree_descend(hdrp_i_variant_search* s, hdrp_i_variant_tree* t)
{
    uint32_t d = t->depth, kept = 0u, i;
    const uint32_t* list = s->lists + (size_t)d * s->n;
    uint32_t* next = s->lists + (size_t)(d + 1u) * s->n;
    for (i = 0u; i < t->count[d]; ++i) {
        if (t->stage[d] == 0u || (s->feature[list[i]] & t->bit[d]) == 0u) {
            next[kept++] = list[i];
        }
    }
    t->with[d + 1u] = t->stage[d] == 0u ? t->with[d] | t->bit[d] : t->with[d];
    t->count[d + 1u] = kept;
    t->stage[d + 1u] = 0u;
    ++t->stage[d];
    ++t->depth;
}

/* Makes columns of all unions whose value is below a threshold, which is lowered to the largest of
 * the wanted smallest values; wanted may be 0. Adds up those. Returns 0 where there is no room, or
 * after too much work. */
static int hdrp_i_variant_price(hdrp_i_variant_search* s, int64_t threshold, uint32_t wanted,
                                int64_t work, int64_t* least)
{
    hdrp_i_variant_tree t;
    int64_t end = s->work + work;
    uint32_t i, needed = 0u, q;
    t.depth = 0u;
    t.found = 0u;
    t.with[0] = 0u;
    t.count[0] = s->n;
    t.stage[0] = 0u;
    for (i = 0u; i < s->n; ++i) {
        s->lists[i] = i;
    }
    for (;;) {
        uint32_t d = t.depth;
        int64_t sum = t.stage[d] == 0u ? hdrp_i_variant_tree_bound(s, &t, &needed) : 0;
        if (s->work > end) {
            return 0;
        }
        /* Features that no set needs only cost: the union without them is another leaf. */
        if (t.stage[d] == 1u ||
            (t.stage[d] == 0u && sum < threshold && (t.with[d] & ~needed) == 0u && t.bit[d])) {
            hdrp_i_variant_tree_descend(s, &t);
            continue;
        }
        if (t.stage[d] == 0u && sum < threshold && needed == t.with[d]) {
            if (hdrp_i_variant_column(s, needed) == HDRP_I_VARIANT_NONE) {
                return 0;
            }
            q = t.found < wanted ? t.found++ : wanted - 1u;
            for (; wanted > 0u && q > 0u && t.least[q - 1u] > sum; --q) {
                t.least[q] = t.least[q - 1u];
            }
            if (wanted > 0u) {
                t.least[q] = sum;
                threshold = t.found == wanted ? t.least[wanted - 1u] : threshold;
            }
        }
        if (d == 0u) {
            break;
        }
        --t.depth;
    }
    *least = hdrp_i_variant_sum(t.least, t.found);
    return 1;
}

/* ---- automatic choice: search ---------------------------------------------------------------- */

/* The bound of the whole, and the multipliers that give it. Columns are added where not all unions
 * are columns. Returns 0 where the bound is not that of all unions. */
static int hdrp_i_variant_bound_root(hdrp_i_variant_search* s)
{
    uint32_t round, i, stale = 0u;
    int is_priced = 0;
    double theta = 1.0;
    hdrp_i_variant_assign(s, &s->best);
    for (i = 0u; i < s->n; ++i) {
        s->lambda[i] = s->weight[i] * s->first[i];
    }
    memcpy(s->root, s->lambda, s->n * sizeof *s->root);
    if (s->is_complete) {
        hdrp_i_variant_ascend(s, s->limit, 400u, theta);
        memcpy(s->root, s->lambda, s->n * sizeof *s->root);
        return 1;
    }
    for (round = 0u; round < 60u && stale < 5u && theta > 0.05 && s->lower < s->upper; ++round) {
        int64_t least, bound, before = s->lower;
        uint32_t columns = s->count;
        hdrp_i_variant_set v;
        if (s->work > s->work_limit / 2) {
            break;
        }
        hdrp_i_variant_activate(s);
        hdrp_i_variant_ascend(s, s->limit, round < 3u ? 60u : 40u, theta);
        if (!hdrp_i_variant_price(s, 0, s->limit, s->work_limit / 8, &least)) {
            break;
        }
        bound = hdrp_i_variant_sum(s->lambda, s->n) + least;
        if (bound > s->lower || !is_priced) {
            memcpy(s->root, s->lambda, s->n * sizeof *s->root);
            is_priced = 1;
        }
        s->lower = bound > s->lower ? bound : s->lower;
        stale = s->lower - before < s->upper / 16384 ? stale + 1u : 0u;
        theta *= s->count == columns ? 0.5 : 1.0;
        hdrp_i_variant_activate(s);
        v = s->best;
        hdrp_i_variant_interchange(s, &v);
    }
    memcpy(s->lambda, s->root, s->n * sizeof *s->lambda);
    return is_priced;
}

/* Moves columns out of the active ones that no better choice can use. */
static void hdrp_i_variant_fix(hdrp_i_variant_search* s, int64_t bound,
                               const hdrp_i_variant_pick* pick, uint32_t wanted)
{
    int64_t last = wanted > 0u && pick->count >= wanted ? s->rho[pick->columns[wanted - 1u]] : 0;
    uint32_t a = 0u;
    while (a < s->active_count) {
        uint32_t j = s->active[a];
        int64_t replaced = s->rho[j] < last ? s->rho[j] : last;
        if (!s->is_in[j] && bound - replaced + s->rho[j] >= s->upper) {
            s->active[a] = s->active[--s->active_count];
            s->active[s->active_count] = j;
        } else {
            ++a;
        }
    }
}

static void hdrp_i_variant_drop(hdrp_i_variant_search* s, uint32_t j)
{
    uint32_t a;
    for (a = 0u; a < s->active_count; ++a) {
        if (s->active[a] == j) {
            s->active[a] = s->active[--s->active_count];
            s->active[s->active_count] = j;
            return;
        }
    }
}

/* Interchange from a relaxed choice. */
static void hdrp_i_variant_polish(hdrp_i_variant_search* s, const hdrp_i_variant_pick* pick,
                                  uint32_t wanted)
{
    hdrp_i_variant_set v;
    hdrp_i_variant_gather(s, pick, wanted, &v);
    if (hdrp_i_variant_assign(s, &v) >= HDRP_I_VARIANT_INFINITE) {
        v.count += v.count < s->limit ? 1u : 0u;
        v.masks[v.count - 1u] = s->all;
    }
    hdrp_i_variant_interchange(s, &v);
}

/* All choices that have the columns that are in and one more. */
static void hdrp_i_variant_try_last(hdrp_i_variant_search* s)
{
    hdrp_i_variant_pick none;
    hdrp_i_variant_set v;
    uint32_t a, i, need = 0u;
    none.count = 0u;
    hdrp_i_variant_gather(s, &none, 0u, &v);
    hdrp_i_variant_assign(s, &v);
    for (i = 0u; i < s->n; ++i) {
        need |= s->first[i] >= HDRP_I_VARIANT_INFINITE ? s->feature[i] : 0u;
    }
    ++v.count;
    for (a = 0u; a < s->active_count; ++a) {
        uint32_t j = s->active[a];
        int64_t c = s->cost[j], total = 0;
        ++s->work;
        if (s->is_in[j] || hdrp_i_variant_lacks(need, s->mask[j])) {
            continue;
        }
        for (i = 0u; i < s->n && total < s->upper; ++i) {
            int is_better = c < s->first[i] && !hdrp_i_variant_lacks(s->feature[i], s->mask[j]);
            total += s->weight[i] * (is_better ? c : s->first[i]);
        }
        s->work += i;
        v.masks[v.count - 1u] = s->mask[j];
        hdrp_i_variant_offer(s, &v, total);
    }
}

/* The column to decide next. To find good choices soon, the one that the relaxed choices agreed on
 * most; to prove soon, of those they did not agree on the costliest, on which most depends. */
static uint32_t hdrp_i_variant_branching(const hdrp_i_variant_search* s,
                                         const hdrp_i_variant_pick* pick, uint32_t wanted,
                                         int is_dive)
{
    uint32_t best = HDRP_I_VARIANT_NONE, i;
    int64_t largest = -1;
    for (i = 0u; i < pick->count && i < wanted; ++i) {
        uint32_t j = pick->columns[i];
        int64_t rank = s->hits[j] < 17u ? s->cost[j] : 0;
        rank = is_dive ? (int64_t)s->hits[j] : rank;
        best = rank > largest ? j : best;
        largest = rank > largest ? rank : largest;
    }
    return best;
}

/* Branch and bound over the active columns, the multipliers being those of the root. Returns 1 when
 * nothing is left; else lower is what bounds the rest, among these columns. */
static int hdrp_i_variant_branch(hdrp_i_variant_search* s, int64_t work, int is_dive,
                                 int64_t* lower)
{
    int64_t bound[HDRP_CULL_VARIANT_MAX + 1u];
    uint32_t saved[HDRP_CULL_VARIANT_MAX], column[HDRP_CULL_VARIANT_MAX], depth = 0u, i;
    int64_t end = s->work + work;
    int is_fresh = 1;
    bound[0] = 0;
    while (s->work <= end) {
        uint32_t wanted = s->limit - depth, best = HDRP_I_VARIANT_NONE;
        hdrp_i_variant_pick pick;
        ++s->nodes;
        if (wanted == 1u) {
            hdrp_i_variant_try_last(s);
        } else {
            int64_t value;
            /* With two to go, the level below tries all: the bound is hardly worth its time. */
            if (depth == 0u && is_fresh) {
                hdrp_i_variant_ascend(s, wanted, 300u, 1.0);
            } else if (is_fresh || wanted > 2u) {
                hdrp_i_variant_ascend(s, wanted, is_fresh ? 40u : 20u, 0.5);
            }
            value = hdrp_i_variant_relax(s, &pick, wanted);
            if (is_fresh) {
                hdrp_i_variant_polish(s, &pick, wanted);
            }
            bound[depth] = value > bound[depth] ? value : bound[depth];
            if (bound[depth] < s->upper) {
                hdrp_i_variant_fix(s, value, &pick, wanted);
                best = hdrp_i_variant_branching(s, &pick, wanted, is_dive);
            }
        }
        if (best != HDRP_I_VARIANT_NONE) {
            memcpy(s->levels + (size_t)depth * s->n, s->lambda, s->n * sizeof *s->lambda);
            saved[depth] = s->active_count;
            column[depth] = best;
            s->is_in[best] = 1u;
            bound[depth + 1u] = bound[depth];
            ++depth;
            is_fresh = 1;
        } else if (depth == 0u) {
            *lower = s->upper;
            return 1;
        } else {
            --depth;
            is_fresh = 0;
            s->is_in[column[depth]] = 0u;
            s->active_count = saved[depth];
            hdrp_i_variant_drop(s, column[depth]);
            memcpy(s->lambda, s->levels + (size_t)depth * s->n, s->n * sizeof *s->lambda);
        }
    }
    *lower = s->upper;
    for (i = 0u; i <= depth; ++i) {
        *lower = bound[i] < *lower ? bound[i] : *lower;
    }
    return 0;
}

/* From the first choice to the best, or until the work is done. */
static void hdrp_i_variant_solve(hdrp_i_variant_search* s)
{
    hdrp_i_variant_set v;
    hdrp_i_variant_pick pick;
    int64_t bound, rest, last;
    int is_proof;
    s->best.count = 1u;
    s->best.masks[0] = s->all;
    s->upper = hdrp_i_variant_assign(s, &s->best);
    hdrp_i_variant_agglomerate(s, &v);
    hdrp_i_variant_interchange(s, &v);
    is_proof = hdrp_i_variant_bound_root(s);
    hdrp_i_variant_activate(s);
    bound = hdrp_i_variant_relax(s, &pick, s->limit);
    if (is_proof && bound > s->lower) {
        s->lower = bound;
    }
    if (s->lower >= s->upper) {
        return;
    }
    if (!s->is_complete) {
        /* A better choice first: the closer it is to the bound, the fewer unions matter. */
        hdrp_i_variant_fix(s, bound, &pick, s->limit);
        hdrp_i_variant_branch(s, s->work_limit / 8, 1, &rest);
        memcpy(s->lambda, s->root, s->n * sizeof *s->lambda);
        hdrp_i_variant_activate(s);
        bound = hdrp_i_variant_relax(s, &pick, s->limit);
        last = pick.count >= s->limit ? s->rho[pick.columns[s->limit - 1u]] : 0;
        is_proof = is_proof &&
                   (bound >= s->upper ||
                    hdrp_i_variant_price(s, s->upper - bound + last, 0u, s->work_limit / 4, &rest));
        hdrp_i_variant_activate(s);
        bound = hdrp_i_variant_relax(s, &pick, s->limit);
    }
    hdrp_i_variant_fix(s, bound, &pick, s->limit);
    v = s->best;
    hdrp_i_variant_interchange(s, &v);
    hdrp_i_variant_branch(s, s->work_limit - s->work, 0, &rest);
    if (is_proof && rest > s->lower) {
        s->lower = rest;
    }
}

/* ---- automatic choice: entry ----------------------------------------------------------------- */

/* The sizes with their defaults; 0 where one is out of its range. */
static int hdrp_i_variant_resolve(const hdrp_cull_choice_desc* desc, hdrp_i_variant_search* s)
{
    memset(s, 0, sizeof *s);
    s->n = desc->set_count;
    s->limit = desc->variant_limit;
    s->capacity = desc->candidate_capacity > 32768u ? desc->candidate_capacity : 32768u;
    s->union_limit = desc->union_limit ? desc->union_limit : 4096u;
    s->work_limit = (int64_t)1000000 * (desc->effort ? desc->effort : 1000u);
    return s->n >= 1u && s->n <= HDRP_CULL_SET_MAX && s->limit >= 1u &&
           s->limit <= HDRP_CULL_VARIANT_MAX && s->capacity <= 1048576u &&
           s->union_limit < s->capacity && desc->effort <= 1000000u;
}

HDRP_API size_t hdrp_cull_choose_memory_size(const hdrp_cull_choice_desc* desc)
{
    hdrp_i_variant_search s;
    return desc && hdrp_i_variant_resolve(desc, &s) ? hdrp_i_variant_place(&s, NULL) : 0u;
}

/* The sets, the grid, and the caches. */
static hdrp_result hdrp_i_variant_begin(hdrp_i_variant_search* s, const hdrp_cull_choice_desc* desc)
{
    const uint64_t most = (uint64_t)1 << 32;
    uint64_t total = 0u;
    double worst;
    uint32_t i;
    for (i = 0u; i < s->n; ++i) {
        if (desc->sets[i].weight > most || total > most - desc->sets[i].weight) {
            return HDRP_ERROR_TOO_LARGE;
        }
        total += desc->sets[i].weight;
        s->feature[i] = desc->sets[i].features;
        s->weight[i] = (int64_t)desc->sets[i].weight;
        s->order[i] = i;
    }
    for (i = 0u; i < HDRP_I_VARIANT_CACHE; ++i) {
        s->cache_cost[i] = -1;
    }
    s->cost_of = desc->cost;
    s->user = desc->user;
    s->all = hdrp_cull_all_features(desc->sets, s->n);
    worst = desc->cost(s->all, desc->user);
    if (!(worst >= 0.0 && worst <= 1e30)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    s->scale = 1.0;
    total += total == 0u ? 1u : 0u;
    /* Costs below 1e-30 of a unit count as nothing. */
    while (worst * s->scale * (double)total * 2.0 <= HDRP_I_VARIANT_TOTAL && s->scale < 1e45) {
        s->scale *= 2.0;
    }
    while (worst * s->scale * (double)total > HDRP_I_VARIANT_TOTAL) {
        s->scale *= 0.5;
    }
    s->worst = (int64_t)(worst * s->scale + 0.5);
    return HDRP_OK;
}

/* The choice in the caller's units, by increasing cost. */
static void hdrp_i_variant_finish(hdrp_i_variant_search* s, hdrp_cull_choice* choice)
{
    double worst = s->cost_of(s->all, s->user);
    int64_t weight = hdrp_i_variant_sum(s->weight, s->n);
    uint32_t i, r;
    memset(choice, 0, sizeof *choice);
    for (r = 0u; r < s->best.count; ++r) {
        uint32_t mask = s->best.masks[r], q;
        double c = s->cost_of(mask, s->user);
        mask = c > worst ? s->all : mask;
        c = c > worst ? worst : c;
        for (q = choice->variant_count++;
             q > 0u && (choice->costs[q - 1u] > c ||
                        (choice->costs[q - 1u] == c && choice->masks[q - 1u] > mask));
             --q) {
            choice->masks[q] = choice->masks[q - 1u];
            choice->costs[q] = choice->costs[q - 1u];
        }
        choice->masks[q] = mask;
        choice->costs[q] = c;
    }
    for (i = 0u; i < s->n; ++i) {
        for (r = 0u; hdrp_i_variant_lacks(s->feature[i], choice->masks[r]);) {
            ++r;
        }
        choice->total_cost += choice->costs[r] * (double)s->weight[i];
    }
    choice->is_monotone = s->is_not_monotone ? 0u : 1u;
    choice->candidate_count = s->count;
    choice->node_count = s->nodes;
    if (s->is_complete || choice->is_monotone) {
        /* Every cost may be rounded up by half a point of the grid. */
        double bound = ((double)s->lower - 0.5 * (double)weight) / s->scale;
        bound = bound > 0.0 ? bound : 0.0;
        choice->is_optimal = s->lower >= s->upper ? 1u : 0u;
        choice->lower_bound = bound < choice->total_cost ? bound : choice->total_cost;
    }
}

HDRP_API hdrp_result hdrp_cull_choose_variants(const hdrp_cull_choice_desc* desc, void* memory,
                                               size_t memory_bytes, hdrp_cull_choice* choice)
{
    hdrp_i_variant_search s;
    hdrp_result result;
    if (!desc || !memory || !choice || !desc->sets || !desc->cost) {
        return HDRP_ERROR_NULL_POINTER;
    }
    if (!hdrp_i_variant_resolve(desc, &s)) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    if (((uintptr_t)memory & (HDRP_MEMORY_ALIGNMENT - 1u)) != 0u) {
        return HDRP_ERROR_MEMORY_ALIGNMENT;
    }
    if (memory_bytes < hdrp_cull_choose_memory_size(desc)) {
        return HDRP_ERROR_MEMORY_TOO_SMALL;
    }
    hdrp_i_variant_place(&s, (unsigned char*)memory);
    result = hdrp_i_variant_begin(&s, desc);
    if (result != HDRP_OK) {
        return result;
    }
    hdrp_i_variant_close(&s);
    hdrp_i_variant_own_costs(&s);
    hdrp_i_variant_solve(&s);
    if (s.is_bad) {
        return HDRP_ERROR_BAD_ARGUMENT;
    }
    hdrp_i_variant_finish(&s, choice);
    return HDRP_OK;
}

#endif /* HDRP_CULL_IMPLEMENTATION */
