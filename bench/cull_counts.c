/* cull_counts.c - how good lists are, and the simple method.
 * SPDX-License-Identifier: MIT */
#include "cull_counts.h"

#include "cull_reference.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pixels times lights that are looked at for the visits. */
#define VISITS_MAX 60e6
/* Tiles that the exact count looks at, about: a pair of it takes microseconds. */
#define COMPARED_TILES 200u

static void* allocate(size_t count, size_t size)
{
    void* p = calloc(count + 1u, size);
    if (!p) {
        fprintf(stderr, "bench_cull: out of memory\n");
        exit(1);
    }
    return p;
}

/* ---- truth ------------------------------------------------------------------------------------*/

static void place_of_pixel(const cull_truth* truth, uint32_t x, uint32_t y, double place[3])
{
    const cull_scene* s = truth->scene;
    const hdrp_cull_camera* c = &s->camera;
    double z = (double)truth->texels[(size_t)y * s->width_px + x];
    double u = (double)c->window.x + (x + 0.5) * (double)c->window.z / s->width_px;
    double v = (double)c->window.y + (s->height_px - y - 0.5) * (double)c->window.w / s->height_px;
    const float* eye = &c->eye_near.x;
    const float* right = &c->right_far.x;
    const float* up = &c->up.x;
    const float* forward = &c->forward_orthographic.x;
    for (int k = 0; k < 3; ++k) {
        place[k] =
            (double)eye[k] + z * ((double)forward[k] + u * (double)right[k] + v * (double)up[k]);
    }
}

static bool is_sky(const cull_truth* truth, uint32_t x, uint32_t y)
{
    return truth->texels[(size_t)y * truth->scene->width_px + x] >=
           truth->scene->camera.right_far.w;
}

static bool reaches(const cull_truth_light* light, const double place[3])
{
    double d2 = 0.0, along = 0.0;
    for (int k = 0; k < 3; ++k) {
        double d = place[k] - light->position[k];
        d2 += d * d;
        along += d * light->forward[k];
    }
    return d2 <= light->range * light->range &&
           (light->cosine < -1.0 || along >= light->cosine * sqrt(d2));
}

static void choose_pixels(cull_truth* truth)
{
    const cull_scene* s = truth->scene;
    double all = (double)s->width_px * s->height_px * truth->light_count;
    uint32_t step = (uint32_t)fmax(4.0, ceil(sqrt(all / VISITS_MAX)));
    size_t most = (size_t)(s->width_px / step + 1u) * (s->height_px / step + 1u);
    truth->pixel_x = allocate(most, sizeof *truth->pixel_x);
    truth->pixel_y = allocate(most, sizeof *truth->pixel_y);
    truth->reached = allocate(most, sizeof *truth->reached);
    for (uint32_t y0 = 0u; y0 < s->height_px; y0 += step) {
        for (uint32_t x0 = 0u; x0 < s->width_px; x0 += step) {
            uint32_t h = hdrp_hash2(x0, y0), x = x0 + h % step, y = y0 + (h >> 16) % step;
            if (x < s->width_px && y < s->height_px && !is_sky(truth, x, y)) {
                truth->pixel_x[truth->pixel_count] = x;
                truth->pixel_y[truth->pixel_count++] = y;
            }
        }
    }
}

void cull_truth_make(cull_truth* truth, const cull_scene* scene, const float* texels,
                     cull_scene_mix mix, uint32_t light_count)
{
    memset(truth, 0, sizeof *truth);
    truth->scene = scene;
    truth->texels = texels;
    truth->mix = mix;
    truth->light_count = light_count;
    truth->lights = allocate(light_count, sizeof *truth->lights);
    for (uint32_t i = 0u; i < light_count; ++i) {
        cull_truth_light* t = &truth->lights[i];
        hdrp_light light = cull_scene_light(scene, mix, i);
        for (int k = 0; k < 3; ++k) {
            t->position[k] = (double)(&light.position_range.x)[k];
            t->forward[k] = (double)(&light.forward_radius.x)[k];
        }
        t->range = (double)light.position_range.w;
        t->cosine =
            hdrp_light_type(light) == HDRP_LIGHT_TYPE_SPOT ? (double)light.half_angle.x : -2.0;
    }
    choose_pixels(truth);
    for (uint32_t p = 0u; p < truth->pixel_count; ++p) {
        double place[3];
        place_of_pixel(truth, truth->pixel_x[p], truth->pixel_y[p], place);
        for (uint32_t i = 0u; i < light_count; ++i) {
            truth->reached[p] += reaches(&truth->lights[i], place);
        }
    }
}

void cull_truth_free(cull_truth* truth)
{
    free(truth->lights);
    free(truth->pixel_x);
    free(truth->pixel_y);
    free(truth->reached);
    memset(truth, 0, sizeof *truth);
}

/* Lights that reach a pixel of a tile. The box around its surfaces leaves out most of them. */
static uint64_t lights_of_tile(const cull_truth* truth, uint32_t x0, uint32_t y0, uint32_t x1,
                               uint32_t y1, double (*places)[3])
{
    double lo[3] = {1e30, 1e30, 1e30}, hi[3] = {-1e30, -1e30, -1e30};
    uint32_t n = 0u;
    uint64_t pairs = 0u;
    for (uint32_t y = y0; y < y1; ++y) {
        for (uint32_t x = x0; x < x1; ++x) {
            if (!is_sky(truth, x, y)) {
                place_of_pixel(truth, x, y, places[n]);
                for (int k = 0; k < 3; ++k) {
                    lo[k] = fmin(lo[k], places[n][k]);
                    hi[k] = fmax(hi[k], places[n][k]);
                }
                ++n;
            }
        }
    }
    for (uint32_t i = 0u; i < truth->light_count && n > 0u; ++i) {
        const cull_truth_light* t = &truth->lights[i];
        double d2 = 0.0;
        bool found = false;
        for (int k = 0; k < 3; ++k) {
            double d = fmax(fmax(lo[k] - t->position[k], t->position[k] - hi[k]), 0.0);
            d2 += d * d;
        }
        for (uint32_t p = 0u; d2 <= t->range * t->range && p < n && !found; ++p) {
            found = reaches(t, places[p]);
        }
        pairs += found;
    }
    return pairs;
}

/* Cells of a tile, and lights that reach them. */
static uint64_t lights_of_cells(const cull_truth* truth, const ref_body* bodies,
                                const hdrp_cull_lists* lists, uint32_t tile)
{
    float lo[HDRP_CULL_SLICES_MAX], hi[HDRP_CULL_SLICES_MAX];
    bool reached[HDRP_CULL_SLICES_MAX];
    hdrp_cull_grid g = lists->grid;
    uint32_t x0 = tile % g.tiles.z * g.tiles.x, y0 = tile / g.tiles.z * g.tiles.y;
    uint32_t x1 = x0 + g.tiles.x, y1 = y0 + g.tiles.y;
    uint32_t width = lists->desc.width_px, height = lists->desc.height_px;
    ref_cell cell = ref_cell_of_pixels(&lists->camera, x0, y0, x1 < width ? x1 : width,
                                       y1 < height ? y1 : height, width, height);
    uint64_t pairs = 0u, unknown = 0u;
    if (g.cells.x == 1u) { /* what is between the nearest and the farthest surface */
        lo[0] = lists->tiles[tile].x;
        hi[0] = lists->tiles[tile].y;
        cell.z0 = (ref_real)lo[0];
        cell.z1 = (ref_real)hi[0];
    } else {
        ref_slices(g, lists->tiles[tile].z, lists->camera.eye_near.w, lists->camera.right_far.w, lo,
                   hi);
    }
    for (uint32_t i = 0u; i < truth->light_count && (g.cells.x > 1u || lo[0] <= hi[0]); ++i) {
        if (!ref_outside_a_side(&bodies[i], &cell)) {
            pairs += ref_reach(&bodies[i], &cell, lo, hi, g.cells.x, reached, &unknown);
        }
    }
    return pairs;
}

static uint64_t lights_of_pixels(const cull_truth* truth, const hdrp_cull_lists* lists,
                                 uint32_t tile, double (*places)[3])
{
    hdrp_cull_grid g = lists->grid;
    uint32_t x0 = tile % g.tiles.z * g.tiles.x, y0 = tile / g.tiles.z * g.tiles.y;
    uint32_t x1 = x0 + g.tiles.x, y1 = y0 + g.tiles.y;
    uint32_t width = lists->desc.width_px, height = lists->desc.height_px;
    return lights_of_tile(truth, x0, y0, x1 < width ? x1 : width, y1 < height ? y1 : height,
                          places);
}

/* Whether the exact count looks at a tile: at all of coarse grids, and at some of others. */
static bool is_compared(const hdrp_cull_lists* lists, uint32_t tile)
{
    uint32_t step = lists->grid.tiles.z * lists->grid.tiles.w / COMPARED_TILES + 1u;
    return hdrp_hash1(tile) % step == 0u;
}

static uint64_t count_exact(const cull_truth* truth, const hdrp_cull_lists* lists)
{
    hdrp_cull_grid g = lists->grid;
    ref_body* bodies = allocate(truth->light_count, sizeof *bodies);
    double(*places)[3] = allocate((size_t)g.tiles.x * g.tiles.y, sizeof *places);
    uint64_t pairs = 0u;
    for (uint32_t i = 0u; i < truth->light_count; ++i) {
        hdrp_light light = cull_scene_light(truth->scene, truth->mix, i);
        bodies[i] = ref_body_of_light(&light, &lists->camera);
    }
    for (uint32_t tile = 0u; tile < g.tiles.z * g.tiles.w; ++tile) {
        if (is_compared(lists, tile)) {
            pairs += lists->desc.flags & HDRP_CULL_PIXELS
                         ? lights_of_pixels(truth, lists, tile, places)
                         : lights_of_cells(truth, bodies, lists, tile);
        }
    }
    free(bodies);
    free(places);
    return pairs;
}

void cull_counts_exact(cull_counts* counts, cull_truth* truth, const hdrp_cull_lists* lists)
{
    bool for_pixels = (lists->desc.flags & HDRP_CULL_PIXELS) != 0u;
    cull_exact* e = truth->exact;
    while (e < truth->exact + truth->exact_count &&
           (e->tile_px != lists->grid.tiles.x || e->slices != lists->grid.cells.x ||
            e->for_pixels != for_pixels)) {
        ++e;
    }
    if (e == truth->exact + truth->exact_count) {
        e->tile_px = lists->grid.tiles.x;
        e->slices = lists->grid.cells.x;
        e->for_pixels = for_pixels;
        e->pairs = count_exact(truth, lists);
        truth->exact_count += truth->exact_count + 1u < CULL_EXACT_MAX;
    }
    counts->exact_pairs = e->pairs;
}

/* ---- lists ------------------------------------------------------------------------------------*/

/* The cell of a pixel of the scene. */
static size_t cell_of_pixel(const cull_truth* truth, const hdrp_cull_lists* lists, uint32_t x,
                            uint32_t y)
{
    uint32_t tile = hdrp_cull_tile_of_pixel(lists->grid, x, y);
    float z = truth->texels[(size_t)y * truth->scene->width_px + x];
    return hdrp_cull_cell(lists->grid, tile, hdrp_cull_slice(lists->grid, lists->tiles[tile].z, z));
}

/* Whether a pixel shades with the light of an entry: what lists tell of pixels, it asks. */
static uint32_t is_visited(const hdrp_cull_lists* lists, uint32_t entry, uint32_t x, uint32_t y)
{
    hdrp_cull_grid g = lists->grid;
    if (lists->masks) {
        uint32_t word = lists->masks[hdrp_cull_mask_word(g, entry, x, y)];
        return word >> hdrp_cull_mask_bit(g, x, y) & 1u;
    }
    return hdrp_cull_entry_covers(g, lists->entries[entry], x, y);
}

void cull_counts_lists(cull_counts* counts, const cull_truth* truth, const hdrp_cull_lists* lists)
{
    hdrp_cull_stats stats;
    uint32_t slices = lists->grid.cells.x;
    memset(&stats, 0, sizeof stats);
    hdrp_cull_count(lists, &stats);
    counts->pairs = stats.entries;
    counts->compared_pairs = 0u;
    for (size_t c = 0u; c < (size_t)lists->grid.tiles.z * lists->grid.tiles.w * slices; ++c) {
        if (is_compared(lists, (uint32_t)(c / slices))) {
            counts->compared_pairs +=
                hdrp_cull_last(lists->cells[c], 3u) - hdrp_cull_first(lists->cells[c], 0u);
        }
    }
    counts->visits = counts->true_visits = 0u;
    for (uint32_t p = 0u; p < truth->pixel_count; ++p) {
        uint32_t x = truth->pixel_x[p], y = truth->pixel_y[p];
        hdrp_u32x4 cell = lists->cells[cell_of_pixel(truth, lists, x, y)];
        for (uint32_t i = hdrp_cull_first(cell, 0u); i < hdrp_cull_last(cell, 3u); ++i) {
            counts->visits += is_visited(lists, i, x, y);
        }
        counts->true_visits += truth->reached[p];
    }
}

/* ---- the simple method ------------------------------------------------------------------------*/

/* The least depth in a slice; found by halving, for floats are ordered as their bits are. */
static float slice_begin(hdrp_cull_grid grid, float scale, uint32_t slice)
{
    hdrp_u32 lo = hdrp_bits_from_f32(grid.series.x), hi = hdrp_bits_from_f32(1e18f);
    while (lo < hi) {
        hdrp_u32 middle = lo + (hi - lo) / 2u;
        if (hdrp_cull_slice(grid, scale, hdrp_f32_from_bits(middle)) >= slice) {
            hi = middle;
        } else {
            lo = middle + 1u;
        }
    }
    return hdrp_f32_from_bits(lo);
}

void cull_naive_free(cull_naive* naive)
{
    free(naive->lo);
    free(naive->hi);
    free(naive->begin);
    free(naive->entries);
    memset(naive, 0, sizeof *naive);
}

void cull_naive_make(cull_naive* naive, const hdrp_cull_lists* lists)
{
    hdrp_cull_grid g = lists->grid;
    hdrp_v4 w = lists->camera.window;
    float du = w.z / (float)lists->desc.width_px, dv = w.w / (float)lists->desc.height_px;
    uint32_t tiles = g.tiles.z * g.tiles.w, n = 0u;
    cull_naive_free(naive);
    naive->cell_count = tiles * g.cells.x;
    naive->lo = allocate(naive->cell_count, sizeof *naive->lo);
    naive->hi = allocate(naive->cell_count, sizeof *naive->hi);
    naive->begin = allocate(naive->cell_count + 1u, sizeof *naive->begin);
    for (uint32_t tile = 0u; tile < tiles; ++tile) {
        float u0 = w.x + (float)(tile % g.tiles.z * g.tiles.x) * du;
        float v1 = w.y + w.w - (float)(tile / g.tiles.z * g.tiles.y) * dv;
        float u1 = u0 + (float)g.tiles.x * du, v0 = v1 - (float)g.tiles.y * dv;
        for (uint32_t k = 0u; k < g.cells.x; ++k, ++n) {
            float z0 = k ? slice_begin(g, g.series.w, k) : lists->camera.eye_near.w;
            float z1 =
                k + 1u < g.cells.x ? slice_begin(g, g.series.w, k + 1u) : lists->camera.right_far.w;
            naive->lo[n] = hdrp_v3_make(hdrp_min(u0 * z0, u0 * z1), hdrp_min(v0 * z0, v0 * z1), z0);
            naive->hi[n] = hdrp_v3_make(hdrp_max(u1 * z0, u1 * z1), hdrp_max(v1 * z0, v1 * z1), z1);
        }
    }
}

static bool ball_meets_box(hdrp_v4 ball, hdrp_v3 lo, hdrp_v3 hi)
{
    float x = hdrp_max(hdrp_max(lo.x - ball.x, ball.x - hi.x), 0.0f);
    float y = hdrp_max(hdrp_max(lo.y - ball.y, ball.y - hi.y), 0.0f);
    float z = hdrp_max(hdrp_max(lo.z - ball.z, ball.z - hi.z), 0.0f);
    return x * x + y * y + z * z <= ball.w * ball.w;
}

void cull_naive_build(cull_naive* naive, const hdrp_cull_set* set)
{
    uint32_t n = 0u;
    for (uint32_t c = 0u; c < naive->cell_count; ++c) {
        naive->begin[c] = n;
        if (naive->entry_capacity < n + set->count) {
            naive->entry_capacity = 2u * (n + set->count);
            naive->entries = realloc(naive->entries, naive->entry_capacity * sizeof(uint16_t));
        }
        for (uint32_t i = 0u; i < set->count; ++i) {
            naive->entries[n] = (uint16_t)i;
            n += ball_meets_box(set->balls[i], naive->lo[c], naive->hi[c]);
        }
    }
    naive->begin[naive->cell_count] = n;
}

void cull_counts_naive(cull_counts* counts, const cull_truth* truth, const cull_naive* naive,
                       const hdrp_cull_lists* lists)
{
    counts->pairs = counts->compared_pairs = naive->begin[naive->cell_count];
    counts->visits = counts->true_visits = 0u;
    for (uint32_t p = 0u; p < truth->pixel_count; ++p) {
        size_t cell = cell_of_pixel(truth, lists, truth->pixel_x[p], truth->pixel_y[p]);
        counts->visits += naive->begin[cell + 1u] - naive->begin[cell];
        counts->true_visits += truth->reached[p];
    }
}
