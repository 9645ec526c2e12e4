/* fuzz_variants.c - features of tiles, and the variants that are chosen, assigned and dispatched for
 * them, against what a loop over all of them says.
 * SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <math.h>
#include <string.h>

#define SETS_MAX 64u

/* ---- features -------------------------------------------------------------------------------- */

static uint32_t light_word(const hdrp_cull_lists* lists, const hdrp_cull_set* set, uint32_t tile)
{
    uint32_t word = 0u, slices = lists->desc.slice_count, category, i;
    for (size_t c = (size_t)tile * slices; c < (size_t)(tile + 1u) * slices; ++c) {
        for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
            uint32_t last = hdrp_cull_last(lists->cells[c], category);
            for (i = hdrp_cull_first(lists->cells[c], category); i < last; ++i) {
                word |= set->shapes[hdrp_cull_entry_index(lists->entries[i])].bits.z;
            }
        }
    }
    return word;
}

static uint32_t* light_words(reader* r, const hdrp_cull_lists* lists, const hdrp_cull_set* set)
{
    uint32_t tiles = lists->grid.tiles.z * lists->grid.tiles.w;
    uint32_t first = read_below(r, tiles + 1u);
    uint32_t* words = block_of(tiles * sizeof *words, 0x33);
    CHECK(hdrp_cull_light_features(lists, set, first, tiles - first, words) == HDRP_OK);
    for (uint32_t t = 0u; t < tiles; ++t) {
        CHECK(words[t] == (t < first ? 0x33333333u : light_word(lists, set, t)));
    }
    CHECK(hdrp_cull_light_features(lists, set, 0u, first, words) == HDRP_OK);
    return words;
}

/* A few pixels of an image of the tiles' picture. */
static uint32_t* material_words(reader* r, const hdrp_cull_lists* lists)
{
    hdrp_u32x4 grid = lists->grid.tiles;
    hdrp_cull_feature_image image;
    uint32_t *words = block_of(grid.z * grid.w * sizeof *words, 0x33), seed = read_u16(r);
    uint32_t* pixels = NULL;
    memset(&image, 0, sizeof image);
    image.width = lists->desc.width_px;
    image.height = lists->desc.height_px;
    image.fallback = read_u8(r);
    image.skipped = read_u8(r) & 3u;
    if (grid.x != grid.y || (uint64_t)image.width * image.height > 8192u) {
        for (uint32_t t = 0u; t < grid.z * grid.w; ++t) {
            words[t] = hdrp_hash2(t, seed) & hdrp_hash2(t, seed + 1u) & 0xffu;
        }
        return words;
    }
    if (seed & 3u) {
        pixels = block_of((size_t)image.width * image.height * sizeof *pixels, 0);
        for (uint32_t i = 0u; i < image.width * image.height; ++i) {
            uint32_t h = hdrp_hash2(i, seed);
            pixels[i] = h % 61u == 0u ? 1u << (h >> 8) % 12u : image.skipped;
        }
        image.pixels = pixels;
    }
    for (uint32_t y = grid.w; y-- > 0u;) {
        CHECK(hdrp_cull_material_tiles(&image, grid.x, y, 1u, words) == HDRP_OK);
    }
    for (uint32_t i = 0u; pixels && i < image.width * image.height; ++i) {
        uint32_t t = hdrp_cull_tile_of_pixel(lists->grid, i % image.width, i / image.width);
        CHECK(pixels[i] == image.skipped || (pixels[i] & ~words[t]) == 0u);
    }
    free(pixels);
    return words;
}

static void combine(const uint32_t* lights, uint32_t* words, uint32_t tiles)
{
    uint32_t* materials = block_of(tiles * sizeof *materials, 0);
    memcpy(materials, words, tiles * sizeof *materials);
    CHECK(hdrp_cull_combine_features(words, lights, words, 0u, tiles) == HDRP_OK);
    for (uint32_t t = 0u; t < tiles; ++t) {
        CHECK(words[t] == (materials[t] ? materials[t] | lights[t] : 0u));
    }
    free(materials);
}

/* ---- choice ---------------------------------------------------------------------------------- */

/* What is chosen from, and what it costs. */
typedef struct market {
    hdrp_cull_cost_model model;
    hdrp_cull_feature_count sets[SETS_MAX];
    uint32_t count;
} market;

static void read_model(reader* r, hdrp_cull_cost_model* model)
{
    memset(model, 0, sizeof *model);
    model->alu = read_u8(r);
    model->latency = read_u8(r);
    model->registers = read_u8(r);
    model->register_count = 256.0;
    model->waves_max = 1.0 + read_below(r, 10u);
    for (uint32_t b = 0u; b < 32u; ++b) {
        uint32_t h = hdrp_hash2(b, (uint32_t)model->alu);
        model->feature_alu[b] = h & 255u;
        model->feature_latency[b] = h >> 8 & 15u;
        model->feature_registers[b] = h >> 12 & 31u;
        model->feature_peak[b] = h >> 17 & 63u;
    }
}

/* All at once, and in two parts that are merged. */
static void count_sets(reader* r, const uint32_t* words, uint32_t tiles, market* m)
{
    hdrp_cull_feature_count part[2][SETS_MAX];
    uint32_t room = 1u + read_below(r, SETS_MAX), cut = read_below(r, tiles + 1u), shaded = 0u;
    hdrp_cull_histogram whole = {m->sets, room, 0u, 0u};
    hdrp_cull_histogram one = {part[0], room, 0u, 0u}, two = {part[1], room, 0u, 0u};
    uint64_t weight;
    CHECK(hdrp_cull_histogram_add(&whole, words, NULL, tiles) == HDRP_OK);
    CHECK(hdrp_cull_histogram_add(&one, words + cut, NULL, tiles - cut) == HDRP_OK);
    CHECK(hdrp_cull_histogram_add(&two, words, NULL, cut) == HDRP_OK);
    CHECK(hdrp_cull_histogram_merge(&one, &two) == HDRP_OK);
    CHECK(one.count == whole.count && one.left_out == whole.left_out);
    weight = whole.left_out;
    for (uint32_t i = 0u; i < whole.count; ++i) {
        CHECK(one.entries[i].features == m->sets[i].features);
        CHECK(one.entries[i].weight == m->sets[i].weight);
        CHECK(m->sets[i].features != 0u && m->sets[i].weight > 0u);
        CHECK(i == 0u || m->sets[i].features > m->sets[i - 1u].features);
        weight += m->sets[i].weight;
    }
    for (uint32_t t = 0u; t < tiles; ++t) {
        shaded += words[t] ? 1u : 0u;
    }
    CHECK(weight == shaded);
    m->count = whole.count;
}

static double cheapest(const uint32_t* masks, const double* costs, uint32_t count,
                       uint32_t features)
{
    double best = INFINITY;
    for (uint32_t i = 0u; i < count; ++i) {
        best = (features & ~masks[i]) == 0u && costs[i] < best ? costs[i] : best;
    }
    return best;
}

static double total_of(const market* m, const uint32_t* masks, const double* costs, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0u; i < m->count; ++i) {
        sum += (double)m->sets[i].weight * cheapest(masks, costs, count, m->sets[i].features);
    }
    return sum;
}

static uint32_t union_of(const market* m, uint32_t which)
{
    uint32_t mask = 0u;
    for (uint32_t i = 0u; i < m->count; ++i) {
        mask |= which >> i & 1u ? m->sets[i].features : 0u;
    }
    return mask;
}

/* The least that one or two unions of few sets can cost. */
static double least_of_two(market* m, uint32_t limit)
{
    uint32_t unions = 1u << m->count, masks[2];
    double costs[2], least = INFINITY;
    for (uint32_t a = 1u; a < unions; ++a) {
        masks[0] = union_of(m, a);
        costs[0] = hdrp_cull_model_cost(masks[0], &m->model);
        for (uint32_t b = limit > 1u ? a : unions - 1u; b < unions; ++b) {
            double total;
            masks[1] = union_of(m, b);
            costs[1] = hdrp_cull_model_cost(masks[1], &m->model);
            total = total_of(m, masks, costs, limit > 1u ? 2u : 1u);
            least = total < least ? total : least;
        }
    }
    return least;
}

static void choose(reader* r, market* m, hdrp_cull_choice* choice)
{
    hdrp_cull_choice_desc d;
    size_t bytes;
    void* memory;
    memset(&d, 0, sizeof d);
    d.sets = m->sets;
    d.set_count = m->count;
    d.variant_limit = 1u + read_below(r, 6u);
    d.cost = hdrp_cull_model_cost;
    d.user = &m->model;
    d.effort = 1u;
    bytes = hdrp_cull_choose_memory_size(&d);
    CHECK((bytes > 0u) == (m->count > 0u));
    memory = block_of(bytes, 0x5a);
    CHECK(hdrp_cull_choose_variants(&d, memory, bytes, choice) == HDRP_OK);
    free(memory);
    CHECK(choice->variant_count >= 1u && choice->variant_count <= d.variant_limit);
    for (uint32_t i = 0u; i < choice->variant_count; ++i) {
        CHECK(choice->costs[i] == hdrp_cull_model_cost(choice->masks[i], &m->model));
        CHECK(i == 0u || choice->costs[i] >= choice->costs[i - 1u]);
        CHECK((choice->masks[i] & ~hdrp_cull_all_features(m->sets, m->count)) == 0u);
    }
    double total = total_of(m, choice->masks, choice->costs, choice->variant_count);
    CHECK(fabs(total - choice->total_cost) <= 1e-9 * total);
    CHECK(choice->lower_bound <= choice->total_cost && choice->is_monotone == 1u);
    if (m->count <= 5u && d.variant_limit <= 2u) {
        double least = least_of_two(m, d.variant_limit);
        CHECK(choice->lower_bound <= least * (1.0 + 1e-9));
        CHECK(total >= least * (1.0 - 1e-9));
        CHECK(!choice->is_optimal || total <= least * (1.0 + 1e-9));
    }
}

/* ---- dispatch -------------------------------------------------------------------------------- */

static uint8_t* assign(reader* r, const hdrp_cull_variant_list* list, const uint32_t* words,
                       uint32_t tiles)
{
    uint32_t cut = read_below(r, tiles + 1u);
    uint8_t* chosen = block_of(tiles, 0x33);
    CHECK(hdrp_cull_assign_variants(list, words, chosen, cut, tiles - cut) == HDRP_OK);
    CHECK(cut == 0u || chosen[0] == 0x33u);
    CHECK(hdrp_cull_assign_variants(list, words, chosen, 0u, cut) == HDRP_OK);
    for (uint32_t t = 0u; t < tiles; ++t) {
        uint32_t first = HDRP_CULL_VARIANT_NONE;
        for (uint32_t i = 0u; i < list->count; ++i) {
            first = hdrp_cull_first_covering(first, i, list->masks[i], words[t]);
        }
        if (words[t] == 0u || first == HDRP_CULL_VARIANT_NONE) {
            CHECK(chosen[t] == (words[t] ? HDRP_CULL_VARIANT_NONE : HDRP_CULL_VARIANT_EMPTY));
        } else if (!list->costs) {
            CHECK(chosen[t] == first);
        } else {
            CHECK(chosen[t] < list->count &&
                  hdrp_cull_variant_covers(list->masks[chosen[t]], words[t]));
            CHECK(list->costs[chosen[t]] ==
                  cheapest(list->masks, list->costs, list->count, words[t]));
        }
    }
    return chosen;
}

static void dispatch(reader* r, const uint8_t* chosen, hdrp_u32x4 grid, uint32_t variants)
{
    hdrp_cull_arguments arguments[HDRP_CULL_VARIANT_MAX];
    hdrp_cull_dispatch d;
    uint32_t tiles = grid.z * grid.w, at = 0u, seen = 0u;
    memset(&d, 0, sizeof d);
    d.arguments = arguments;
    d.variant_count = variants;
    d.tile_capacity = read_u8(r) & 1u ? tiles : read_below(r, tiles + 1u);
    d.tiles = block_of(d.tile_capacity * sizeof *d.tiles, 0x33);
    CHECK(hdrp_cull_build_dispatch(&d, chosen, grid.z, grid.w) == HDRP_OK);
    CHECK(d.listed + d.empty + d.uncovered + d.dropped == tiles);
    CHECK(d.dropped == 0u || d.listed == d.tile_capacity);
    for (uint32_t i = 0u; i < variants; ++i) {
        CHECK(arguments[i].first == at && arguments[i].groups_y == 1u);
        for (uint32_t g = 0u; g < arguments[i].groups_x; ++g, ++at) {
            uint32_t x = hdrp_cull_tile_id_x(d.tiles[at]), y = hdrp_cull_tile_id_y(d.tiles[at]);
            CHECK(x < grid.z && y < grid.w && chosen[y * grid.z + x] == i);
            CHECK(g == 0u || y * grid.z + x > seen);
            seen = y * grid.z + x;
        }
    }
    CHECK(at == d.listed);
    free(d.tiles);
}

static void report(market* m, const hdrp_cull_variant_list* list)
{
    hdrp_cull_variant_report reports[HDRP_CULL_VARIANT_MAX];
    hdrp_cull_variant_total total;
    uint64_t weight = 0u, all = 0u;
    CHECK(hdrp_cull_report_variants(list, m->sets, m->count, hdrp_cull_model_cost, &m->model,
                                    reports, &total) == HDRP_OK);
    for (uint32_t i = 0u; i < list->count; ++i) {
        weight += reports[i].weight;
    }
    for (uint32_t i = 0u; i < m->count; ++i) {
        all += m->sets[i].weight;
    }
    CHECK(weight + total.uncovered == all && total.cost >= 0.0);
}

void fuzz_variants(reader* r, const hdrp_cull_lists* lists, const hdrp_cull_set* set)
{
    uint32_t tiles = lists->grid.tiles.z * lists->grid.tiles.w, how = read_u8(r);
    uint32_t* lights = light_words(r, lists, set);
    uint32_t* words = material_words(r, lists);
    hdrp_cull_variant_list list;
    hdrp_cull_choice choice;
    uint8_t* chosen;
    market m;
    combine(lights, words, tiles);
    read_model(r, &m.model);
    count_sets(r, words, tiles, &m);
    memset(&choice, 0, sizeof choice);
    if (m.count > 0u && (how & 7u) == 0u) { /* this takes longer than all the rest */
        choose(r, &m, &choice);
    } else { /* variants that do not cover everything */
        choice.variant_count = 1u + read_below(r, HDRP_CULL_VARIANT_MAX);
        for (uint32_t i = 0u; i < choice.variant_count; ++i) {
            choice.masks[i] = hdrp_hash2(i, how) | (i & 1u ? hdrp_hash2(i, how + 1u) : 0u);
            choice.costs[i] = (double)(hdrp_hash2(i, how + 2u) & 7u);
        }
    }
    list.masks = choice.masks;
    list.costs = how & 8u ? choice.costs : NULL;
    list.count = choice.variant_count;
    chosen = assign(r, &list, words, tiles);
    dispatch(r, chosen, lists->grid.tiles, list.count);
    report(&m, &list);
    free(chosen);
    free(lights);
    free(words);
}
