/* fuzz_blockers.c - blockers of lights that share them: what stays in lists does not depend on how
 * links are shared or the work is split, and decides at some places as all blockers do.
 * SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <string.h>

#define WALLS_MAX  12u
#define LINKS_MAX  24u
#define LIGHTS_MAX 32u
#define PATTERN    0x33333333u

/* A scene, and the same where each light has links of its own. */
typedef struct world {
    hdrp_cull_blocker blockers[WALLS_MAX];
    uint32_t links[LINKS_MAX], own_links[LIGHTS_MAX * LINKS_MAX];
    hdrp_cull_blocker_links lights[LIGHTS_MAX], own_lights[LIGHTS_MAX];
    hdrp_v4 places[LIGHTS_MAX];
    hdrp_cull_blocker_scene shared, own;
} world;

static hdrp_cull_blocker read_blocker(reader* r)
{
    uint32_t how = read_u8(r);
    hdrp_v3 center = read_v3(r), front = read_v3(r);
    hdrp_cull_blocker b = hdrp_cull_blocker_plane(center, front);
    if (how >= 50u) {
        hdrp_v3 up = read_v3(r);
        float width = read_float(r), height = read_float(r);
        b = hdrp_cull_blocker_rectangle(center, front, up, hdrp_abs(width), hdrp_abs(height));
    }
    if (how % 3u == 0u) { /* portals may be any blockers, of themselves too */
        uint32_t first = read_below(r, WALLS_MAX);
        b = hdrp_cull_blocker_with_portals(b, first, read_below(r, WALLS_MAX - first + 1u) % 4u);
    }
    return b;
}

static void read_world(reader* r, world* w, const hdrp_v4* places, uint32_t light_count)
{
    uint32_t links = read_below(r, LINKS_MAX + 1u), own = 0u;
    for (uint32_t i = 0u; i < WALLS_MAX; ++i) {
        w->blockers[i] = read_blocker(r);
    }
    for (uint32_t i = 0u; i < links; ++i) {
        w->links[i] = read_below(r, WALLS_MAX);
    }
    for (uint32_t i = 0u; i < light_count; ++i) {
        uint32_t first = read_below(r, links + 1u), count = read_below(r, 9u);
        w->lights[i].first = first;
        w->lights[i].count = count < links - first ? count : links - first;
        w->own_lights[i].first = own;
        w->own_lights[i].count = w->lights[i].count;
        memcpy(w->own_links + own, w->links + first, w->lights[i].count * sizeof *w->links);
        own += w->lights[i].count;
        w->places[i] = places[i];
    }
    memset(&w->shared, 0, sizeof w->shared);
    w->shared.places = w->places;
    w->shared.lights = w->lights;
    w->shared.links = w->links;
    w->shared.blockers = w->blockers;
    w->shared.light_count = light_count;
    w->shared.link_count = links;
    w->shared.blocker_count = WALLS_MAX;
    w->own = w->shared;
    w->own.lights = w->own_lights;
    w->own.links = w->own_links;
    w->own.link_count = own;
}

/* ---- lists after blockers -------------------------------------------------------------------- */

typedef struct outcome {
    hdrp_cull_lists lists; /* cells, entries and masks of their own */
    uint32_t* masks;
    hdrp_cull_blocker_stats stats;
} outcome;

static void copy_lists(outcome* o, const hdrp_cull_lists* lists)
{
    size_t tiles = (size_t)lists->grid.tiles.z * lists->grid.tiles.w;
    size_t cells = tiles * lists->desc.slice_count, entries = tiles * lists->desc.entry_capacity;
    size_t words = lists->masks ? entries * hdrp_cull_mask_words(lists->grid) : 0u;
    o->lists = *lists;
    o->lists.cells = block_of(cells * sizeof *lists->cells, 0);
    o->lists.entries = block_of(entries * sizeof *lists->entries, 0);
    memcpy(o->lists.cells, lists->cells, cells * sizeof *lists->cells);
    memcpy(o->lists.entries, lists->entries, entries * sizeof *lists->entries);
    if (lists->masks) {
        o->lists.masks = block_of(words * sizeof *lists->masks, 0);
        memcpy(o->lists.masks, lists->masks, words * sizeof *lists->masks);
    }
    o->masks = block_of(entries * sizeof *o->masks, 0x33);
    memset(&o->stats, 0, sizeof o->stats);
}

static void free_outcome(outcome* o)
{
    free(o->lists.cells);
    free(o->lists.entries);
    free(o->lists.masks);
    free(o->masks);
}

/* All tiles, in jobs of `step` of them, the last first; 0: one job. */
static void apply(outcome* o, const hdrp_cull_blocker_scene* scene, uint32_t step)
{
    hdrp_cull_blocker_desc limits = {LIGHTS_MAX, LIGHTS_MAX * LINKS_MAX, WALLS_MAX};
    size_t bytes = hdrp_cull_blocker_memory_size(&limits), scratch_bytes;
    void *memory = block_of(bytes, 0x5a), *scratch;
    uint32_t end = o->lists.grid.tiles.z * o->lists.grid.tiles.w;
    hdrp_cull_blocker_set set;
    CHECK(hdrp_cull_blocker_init(&set, &limits, memory, bytes) == HDRP_OK);
    CHECK(hdrp_cull_blocker_begin(&set, scene, &o->lists.camera) == HDRP_OK);
    CHECK(hdrp_cull_blocker_project(&set, 0u, scene->light_count + WALLS_MAX) == HDRP_OK);
    scratch_bytes = hdrp_cull_blocker_scratch_size(&set);
    scratch = block_of(scratch_bytes, 0x5a);
    step = step > 0u ? step : end;
    while (end > 0u) {
        hdrp_cull_blocker_job job;
        uint32_t count = step < end ? step : end;
        end -= count;
        CHECK(hdrp_cull_blocker_job_begin(&job, &set, scratch, scratch_bytes) == HDRP_OK);
        CHECK(hdrp_cull_apply_blockers(&o->lists, &job, end, count, o->masks) == HDRP_OK);
        o->stats.none += job.stats.none;
        o->stats.whole += job.stats.whole;
        o->stats.pixel += job.stats.pixel;
        o->stats.lights += job.stats.lights;
        o->stats.lights_removed += job.stats.lights_removed;
    }
    free(memory);
    free(scratch);
}

/* ---- checks ---------------------------------------------------------------------------------- */

/* What stays is what was there, in the same order; whatever has no blockers stays. */
static void check_rest(const world* w, const hdrp_cull_lists* before, const outcome* o)
{
    size_t cells = (size_t)before->grid.tiles.z * before->grid.tiles.w * before->desc.slice_count,
           c;
    uint64_t gone = 0u;
    for (c = 0u; c < cells; ++c) {
        hdrp_u32x4 old = before->cells[c], now = o->lists.cells[c];
        CHECK(old.x == now.x && old.w == now.w);
        for (uint32_t category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
            uint32_t at = hdrp_cull_first(now, category), end = hdrp_cull_last(now, category);
            uint32_t last = hdrp_cull_last(old, category);
            for (uint32_t i = hdrp_cull_first(old, category); i < last; ++i) {
                uint32_t shape = hdrp_cull_entry_index(before->entries[i]);
                bool stays = at < end && o->lists.entries[at] == before->entries[i];
                uint32_t count = shape < w->shared.light_count ? w->lights[shape].count : 0u;
                CHECK(stays || count > 0u);
                CHECK(!stays || count > 31u || o->masks[at] >> count == 0u);
                gone += stays ? 0u : 1u;
                at += stays ? 1u : 0u;
            }
            CHECK(at == end);
        }
    }
    CHECK(gone == o->stats.lights_removed);
}

static void check_same(const outcome* a, const outcome* b)
{
    const hdrp_cull_lists* l = &a->lists;
    size_t tiles = (size_t)l->grid.tiles.z * l->grid.tiles.w, c;
    size_t entries = tiles * l->desc.entry_capacity;
    CHECK(!memcmp(l->cells, b->lists.cells, tiles * l->desc.slice_count * sizeof *l->cells));
    CHECK(!memcmp(l->entries, b->lists.entries, entries * sizeof *l->entries));
    CHECK(!memcmp(a->masks, b->masks, entries * sizeof *a->masks));
    CHECK(a->stats.none == b->stats.none && a->stats.whole == b->stats.whole);
    CHECK(a->stats.pixel == b->stats.pixel && a->stats.lights == b->stats.lights);
    for (c = 0u; l->masks && c < tiles; ++c) { /* pixels of entries go with them */
        uint32_t words = hdrp_cull_mask_words(l->grid), first = l->cells[c].x;
        CHECK(!memcmp(l->masks + first * words, b->lists.masks + first * words,
                      (hdrp_cull_last(l->cells[c], 3u) - first) * words * sizeof *l->masks));
    }
}

/* Where a shape is in the list of a cell; 0xffffffff where it is not. */
static uint32_t find(const hdrp_cull_lists* lists, uint32_t cell, uint32_t shape)
{
    hdrp_u32x4 c = lists->cells[cell];
    for (uint32_t i = c.x; i < hdrp_cull_last(c, 3u); ++i) {
        if (hdrp_cull_entry_index(lists->entries[i]) == shape) {
            return i;
        }
    }
    return 0xffffffffu;
}

static float size_of(hdrp_v4 v)
{
    return hdrp_abs(v.x) + hdrp_abs(v.y) + hdrp_abs(v.z);
}

/* Whether a light is seen: 2 where that depends on a ten thousandth of what is there. */
static uint32_t seen(world* w, uint32_t light, hdrp_v3 p)
{
    hdrp_v4 place = w->places[light];
    float size = size_of(hdrp_v4_from_v3(p, 0.0f)) + place.w * size_of(place), step;
    float is_lit = hdrp_cull_blocker_light_visible(&w->shared, light, 0xffffffffu, p);
    for (uint32_t i = 0u; i < WALLS_MAX; ++i) {
        size = hdrp_max(size, size_of(w->blockers[i].center));
    }
    step = 1e-4f * size;
    for (uint32_t i = 0u; i < 12u; ++i) {
        hdrp_v3 d = hdrp_v3_scale(hdrp_v3_make(i % 3u == 0u, i % 3u == 1u, i % 3u == 2u),
                                  i & 1u ? step : -step);
        float lit;
        if (i < 6u) {
            lit =
                hdrp_cull_blocker_light_visible(&w->shared, light, 0xffffffffu, hdrp_v3_add(p, d));
        } else {
            hdrp_v3 moved = hdrp_v3_scale(d, place.w > 0.0f ? 1.0f : 1e-4f / step);
            w->places[light] = hdrp_v4_from_v3(hdrp_v3_add(hdrp_v3_from_v4(place), moved), place.w);
            lit = hdrp_cull_blocker_light_visible(&w->shared, light, 0xffffffffu, p);
            w->places[light] = place;
        }
        if (!(lit == is_lit)) {
            return 2u;
        }
    }
    return is_lit > 0.0f ? 1u : 0u;
}

/* Lists and masks decide at a place of a cell as all blockers do. */
static void check_place(world* w, const hdrp_cull_lists* before, const outcome* o, uint32_t x,
                        uint32_t y, float z)
{
    const hdrp_cull_camera* c = &before->camera;
    float k = c->forward_orthographic.w > 0.0f ? 1.0f : z;
    float u = k * (c->window.x + c->window.z * ((float)x + 0.5f) / (float)before->desc.width_px);
    float v = k * (c->window.y +
                   c->window.w * (1.0f - ((float)y + 0.5f) / (float)before->desc.height_px));
    hdrp_v3 p = hdrp_v3_from_v4(c->eye_near);
    uint32_t tile = hdrp_cull_tile_of_pixel(before->grid, x, y);
    uint32_t slice = hdrp_cull_slice(before->grid, before->tiles[tile].z, z);
    uint32_t cell = hdrp_cull_cell(before->grid, tile, slice);
    p = hdrp_v3_add(p, hdrp_v3_scale(hdrp_v3_from_v4(c->right_far), u));
    p = hdrp_v3_add(p, hdrp_v3_scale(hdrp_v3_from_v4(c->up), v));
    p = hdrp_v3_add(p, hdrp_v3_scale(hdrp_v3_from_v4(c->forward_orthographic), z));
    if (!(size_of(hdrp_v4_from_v3(p, 0.0f)) < 1e12f)) {
        return;
    }
    for (uint32_t i = 0u; i < w->shared.light_count; ++i) {
        uint32_t was = find(before, cell, i), is = find(&o->lists, cell, i), expected;
        if (was == 0xffffffffu) {
            CHECK(is == 0xffffffffu);
            continue;
        }
        expected = seen(w, i, p);
        if (expected == 1u) {
            CHECK(is != 0xffffffffu);
        }
        if (expected < 2u && is != 0xffffffffu) {
            CHECK(hdrp_cull_blocker_light_visible(&w->shared, i, o->masks[is], p) ==
                  (float)expected);
        }
    }
}

static void check_places(reader* r, world* w, const hdrp_cull_lists* before, const outcome* o)
{
    uint32_t seed = read_u16(r);
    for (uint32_t n = 0u; n < 12u; ++n) {
        uint32_t h = hdrp_hash2(n, seed);
        uint32_t x = h % before->desc.width_px, y = (h >> 14) % before->desc.height_px;
        hdrp_v4 t = before->tiles[hdrp_cull_tile_of_pixel(before->grid, x, y)];
        float share = hdrp_sq(hdrp_unit_from_u32(hdrp_hash1(h)));
        float lo = before->camera.eye_near.w;
        float hi = hdrp_min(before->camera.right_far.w, 1e5f * lo);
        if (before->desc.slice_count == 1u) { /* lists are good between the depths of the tile */
            lo = t.x;
            hi = hdrp_min(t.y, 1e5f * t.x);
        }
        if (lo <= hi) {
            check_place(w, before, o, x, y, hdrp_min(lo + (hi - lo) * share, hi));
        }
    }
}

void fuzz_blockers(reader* r, const hdrp_cull_lists* lists, const hdrp_v4* places,
                   uint32_t light_count)
{
    outcome whole, split;
    world w;
    read_world(r, &w, places, light_count);
    copy_lists(&whole, lists);
    copy_lists(&split, lists);
    apply(&whole, &w.shared, 0u);
    apply(&split, &w.own, 1u + read_below(r, 5u));
    check_rest(&w, lists, &whole);
    check_same(&whole, &split);
    check_places(r, &w, lists, &whole);
    free_outcome(&whole);
    free_outcome(&split);
}
