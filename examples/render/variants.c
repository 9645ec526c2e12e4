#include "variants.h"

#include "frame.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bits of the features of a tile. */
#define BIT_LIT      0u
#define BIT_COAT     1u
#define BIT_STRETCH  2u
#define BIT_FILM     3u
#define BIT_SLAB     4u
#define BIT_LIGHTS   8u  /* of type 1, and so on */
#define BIT_BLOCKERS 13u /* lights that have some */

#define BIT(b)       (1u << (b))
#define LIGHT(t)     (1u << (BIT_LIGHTS + (t)-1u))
#define ANY_LIGHT    (LIGHT(1u) | LIGHT(2u) | LIGHT(3u) | LIGHT(4u) | LIGHT(5u) | BIT(BIT_BLOCKERS))
#define MATERIALS    0x1fu
#define LIGHT_MASK   0x3eu /* of types 1 to 5 in the features of a shape */

static const char* const names[] = {"lit",   "coat",     "anisotropy", "iridescence", "slab",
                                    "",      "",         "",           "directional", "point",
                                    "spots", "pyramids", "boxes",      "blockers"};

/* What a GCN GPU makes of hdrp_brdf_lit_*, bonaire in bench/results/gcn_mesa-22.3.6.csv: four
 * cycles for each instruction of a material and eight lights; the rest of the driver's estimate for
 * one wave alone is waiting, a tenth of it where ten waves take turns. Registers are those of the
 * rows of `lit`; those of a film, which only making the view needs, and of a type of light, which
 * only its own evaluation needs, are peaks. A type of light that a tile has not costs its branch in
 * each turn; blockers are an estimate. */
static const hdrp_cull_cost_model costs = {
    .alu = 5304.0,
    .latency = 303.0,
    .registers = 56.0,
    .feature_alu = {[BIT_COAT] = 3364.0,
                    [BIT_STRETCH] = 3596.0,
                    [BIT_FILM] = 2064.0,
                    [BIT_SLAB] = 388.0,
                    [BIT_LIGHTS] = 64.0,
                    [BIT_LIGHTS + 1] = 64.0,
                    [BIT_LIGHTS + 2] = 64.0,
                    [BIT_LIGHTS + 3] = 64.0,
                    [BIT_LIGHTS + 4] = 64.0,
                    [BIT_BLOCKERS] = 200.0},
    .feature_latency =
        {[BIT_COAT] = 38.0, [BIT_STRETCH] = 79.0, [BIT_FILM] = 56.0, [BIT_SLAB] = 3.0},
    .feature_registers = {[BIT_STRETCH] = 28.0, [BIT_SLAB] = 4.0},
    .feature_peak = {[BIT_COAT] = 16.0,
                     [BIT_STRETCH] = 4.0,
                     [BIT_FILM] = 28.0,
                     [BIT_LIGHTS + 1] = 8.0,
                     [BIT_LIGHTS + 2] = 16.0,
                     [BIT_LIGHTS + 3] = 24.0,
                     [BIT_LIGHTS + 4] = 16.0,
                     [BIT_BLOCKERS] = 16.0},
    .register_count = 256.0,
    .waves_max = 10.0,
};

/* As an engine's table says without measuring: each material with few lights and with all, from
 * simple to complex, then everything. */
static const uint32_t by_hand[RD_VARIANT_LIMIT] = {
    BIT(BIT_LIT) | LIGHT(1u) | LIGHT(2u) | LIGHT(3u), BIT(BIT_LIT) | ANY_LIGHT,
    BIT(BIT_LIT) | BIT(BIT_SLAB) | ANY_LIGHT,         BIT(BIT_LIT) | BIT(BIT_STRETCH) | ANY_LIGHT,
    BIT(BIT_LIT) | BIT(BIT_FILM) | ANY_LIGHT,         BIT(BIT_LIT) | BIT(BIT_COAT) | ANY_LIGHT,
    MATERIALS | LIGHT(1u) | LIGHT(2u) | LIGHT(3u),    MATERIALS | ANY_LIGHT,
};

static double cost_of(hdrp_u32 features, void* user)
{
    hdrp_cull_cost_model model = costs;
    (void)user;
    return hdrp_cull_model_cost(features, &model);
}

/* >>features */

static uint32_t material_word(hdrp_u32 features)
{
    uint32_t w = BIT(BIT_LIT);
    w |= features & HDRP_BRDF_FEATURE_CLEAR_COAT ? BIT(BIT_COAT) : 0u;
    w |= features & HDRP_BRDF_FEATURE_ANISOTROPY ? BIT(BIT_STRETCH) : 0u;
    w |= features & HDRP_BRDF_FEATURE_IRIDESCENCE ? BIT(BIT_FILM) : 0u;
    w |= features & HDRP_BRDF_FEATURE_TRANSMISSION ? BIT(BIT_SLAB) : 0u;
    return w;
}

hdrp_cull_shape rd_variants_shape(const rd_lights* lights, uint32_t light)
{
    hdrp_cull_shape s = hdrp_cull_shape_from_light(lights->items[light]);
    uint32_t word = (s.bits.z & LIGHT_MASK) << (BIT_LIGHTS - 1u);
    word |= lights->links[light].count > 0u ? BIT(BIT_BLOCKERS) : 0u;
    return hdrp_cull_shape_with_features(s, word, s.bits.y, hdrp_f32_from_bits(s.bits.w));
}

/* What is lit from the GBuffer; other pixels are no business of tiles. */
static uint32_t* pixel_words(const rd_sub_frame* s)
{
    size_t pixels = (size_t)s->r->width * (size_t)s->r->height;
    const rd_gbuffer* g = &s->r->gbuffer;
    uint32_t* words = (uint32_t*)malloc(pixels * sizeof *words);
    for (size_t i = 0; words && i < pixels; ++i) {
        words[i] = g->kinds[i] == RD_PIXEL_DEFERRED
                       ? material_word(rd_gbuffer_decode(g->texels[i], s->r->scene).features)
                       : 0u;
    }
    return words;
}

static bool classify(const rd_sub_frame* s, uint32_t* words, hdrp_u32x4 tiles)
{
    const rd_lists* l = &s->r->lists;
    hdrp_cull_feature_image image;
    uint32_t count = tiles.z * tiles.w;
    uint32_t* pixels = pixel_words(s);
    uint32_t* lights = (uint32_t*)malloc(count * sizeof *lights);
    bool ok;
    memset(&image, 0, sizeof image);
    image.pixels = pixels;
    image.width = (uint32_t)s->r->width;
    image.height = (uint32_t)s->r->height;
    ok = pixels && lights &&
         hdrp_cull_material_tiles(&image, tiles.x, 0u, tiles.w, words) == HDRP_OK &&
         hdrp_cull_light_features(&l->tiles.lists, &l->set, 0u, count, lights) == HDRP_OK &&
         hdrp_cull_combine_features(words, lights, words, 0u, count) == HDRP_OK;
    free(pixels);
    free(lights);
    return ok;
}

/* >>choice */

/* Everything that a tile of the scene can need. */
static uint32_t worst_word(const rd_sub_frame* s)
{
    uint32_t w = 0u;
    for (int i = 0; i < s->r->scene->material_count; ++i) {
        w |= material_word(s->r->scene->materials[i].features);
    }
    for (uint32_t i = 0; i < s->r->lists.count; ++i) {
        w |= s->r->lists.shapes[i].bits.z;
    }
    return w;
}

static double mean_cost(const hdrp_cull_variant_list* list, const hdrp_cull_histogram* h,
                        hdrp_cull_variant_report* reports)
{
    hdrp_cull_variant_total total;
    uint64_t weight = 0u;
    for (uint32_t i = 0; i < h->count; ++i) {
        weight += h->entries[i].weight;
    }
    if (hdrp_cull_report_variants(list, h->entries, h->count, cost_of, NULL, reports, &total) !=
        HDRP_OK) {
        return 0.0;
    }
    return weight > 0u ? total.cost / (double)weight : 0.0;
}

static void compare(rd_variants* v, const hdrp_cull_histogram* h, uint32_t worst)
{
    uint32_t everything = MATERIALS | ANY_LIGHT;
    hdrp_cull_variant_list all = {&everything, NULL, 1u};
    hdrp_cull_variant_list one = {&worst, NULL, 1u};
    hdrp_cull_variant_list hand = {by_hand, NULL, RD_VARIANT_LIMIT};
    hdrp_cull_variant_list chosen = {v->choice.masks, v->choice.costs, v->choice.variant_count};
    v->mean_everything = mean_cost(&all, h, NULL);
    v->mean_one = mean_cost(&one, h, NULL);
    v->mean_by_hand = mean_cost(&hand, h, NULL);
    v->mean_chosen = mean_cost(&chosen, h, v->reports);
    v->mean_bound = v->choice.total_cost > 0.0
                        ? v->mean_chosen * v->choice.lower_bound / v->choice.total_cost
                        : 0.0;
}

static void name_variant(char* out, uint32_t mask)
{
    size_t at = 0;
    for (uint32_t b = 0; b < sizeof names / sizeof names[0]; ++b) {
        if (mask & BIT(b)) {
            at += (size_t)snprintf(out + at, RD_VARIANT_NAME_MAX - at, "%s%s", at ? "+" : "",
                                   names[b]);
        }
    }
}

static bool choose(rd_variants* v, const hdrp_cull_histogram* h)
{
    hdrp_cull_choice_desc d;
    size_t bytes;
    void* memory;
    bool ok;
    memset(&d, 0, sizeof d);
    d.sets = h->entries;
    d.set_count = h->count;
    d.variant_limit = RD_VARIANT_LIMIT;
    d.cost = cost_of;
    d.effort = 100u;
    bytes = hdrp_cull_choose_memory_size(&d);
    memory = bytes ? aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes) : NULL;
    ok = memory && hdrp_cull_choose_variants(&d, memory, bytes, &v->choice) == HDRP_OK;
    free(memory);
    for (uint32_t i = 0; ok && i < v->choice.variant_count; ++i) {
        name_variant(v->names[i], v->choice.masks[i]);
    }
    return ok;
}

static bool learn(const rd_sub_frame* s, uint32_t tiles)
{
    rd_variants* v = &s->r->variants;
    hdrp_cull_histogram h = {NULL, RD_VARIANT_SETS, 0u, 0u};
    uint32_t worst = worst_word(s), weight = 0u;
    bool ok;
    h.entries = (hdrp_cull_feature_count*)malloc(RD_VARIANT_SETS * sizeof *h.entries);
    /* Seen or not, something has to cover the rest of the scene. */
    ok = h.entries && hdrp_cull_histogram_add(&h, v->words, NULL, tiles) == HDRP_OK &&
         hdrp_cull_histogram_add(&h, &worst, &weight, 1u) == HDRP_OK && choose(v, &h);
    if (ok) {
        compare(v, &h, worst);
    }
    free(h.entries);
    return ok;
}

void rd_variants_build(const rd_sub_frame* s)
{
    rd_variants* v = &s->r->variants;
    hdrp_u32x4 size = s->r->lists.tiles.lists.grid.tiles;
    uint32_t tiles = size.z * size.w;
    hdrp_cull_variant_list list;
    if (!s->r->lists.ready) {
        return;
    }
    if (!v->words) {
        v->words = (uint32_t*)malloc(tiles * sizeof *v->words);
        v->tiles = (uint8_t*)malloc(tiles);
    }
    if (!v->words || !v->tiles || !classify(s, v->words, size)) {
        return;
    }
    v->ready = v->ready || learn(s, tiles);
    list.masks = v->choice.masks;
    list.costs = v->choice.costs;
    list.count = v->choice.variant_count;
    v->ready =
        v->ready && hdrp_cull_assign_variants(&list, v->words, v->tiles, 0u, tiles) == HDRP_OK;
}

void rd_variants_end(rd_variants* v)
{
    free(v->words);
    free(v->tiles);
    memset(v, 0, sizeof *v);
}

void rd_variants_count(const rd_variants* v, rd_stats* stats)
{
    if (!v->ready) {
        return;
    }
    for (uint32_t i = 0; i < v->choice.variant_count; ++i) {
        rd_stats_variant(stats, v->names[i], (double)v->reports[i].weight, v->reports[i].cost);
    }
    rd_stats_list(stats, "tile_cost_everything", v->mean_everything);
    rd_stats_list(stats, "tile_cost_one_variant", v->mean_one);
    rd_stats_list(stats, "tile_cost_by_hand", v->mean_by_hand);
    rd_stats_list(stats, "tile_cost_chosen", v->mean_chosen);
    rd_stats_list(stats, "tile_cost_bound", v->mean_bound);
}
