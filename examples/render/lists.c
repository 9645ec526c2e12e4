#define HDRP_CULL_IMPLEMENTATION
#include "frame.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#define TILE_PX 16u
#define SLICES  64u
/* Entries of a tile at first; a frame that needs more gets more, up to so much memory. */
#define TILE_ENTRIES    256u
#define CLUSTER_ENTRIES 2048u
#define MEMORY_MAX      ((size_t)1 << 30)
/* Clusters begin at this share of the size of a scene. */
#define SERIES_START 2e-3f

/* >>memory */

static void free_grid(rd_grid* g)
{
    free(g->memory);
    free(g->scratch);
    free(g->masks);
}

static bool place_masks(const rd_lists* l, rd_grid* g)
{
    const hdrp_cull_desc* d = &g->lists.desc;
    size_t columns = (d->width_px + d->tile_width_px - 1u) / d->tile_width_px;
    size_t rows = (d->height_px + d->tile_height_px - 1u) / d->tile_height_px;
    size_t entries = columns * rows * d->entry_capacity;
    g->masks = l->scene ? (uint32_t*)calloc(entries, sizeof *g->masks) : NULL;
    return !l->scene || g->masks;
}

static bool place_grid(const rd_lists* l, rd_grid* g, const hdrp_cull_desc* desc)
{
    rd_grid n;
    size_t bytes = hdrp_cull_memory_size(desc);
    memset(&n, 0, sizeof n);
    n.scratch_bytes = hdrp_cull_scratch_size(desc);
    if (bytes == 0 || bytes > MEMORY_MAX) {
        return false;
    }
    n.memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    n.scratch = aligned_alloc(HDRP_MEMORY_ALIGNMENT, n.scratch_bytes * l->threads);
    if (!n.memory || !n.scratch || hdrp_cull_init(&n.lists, desc, n.memory, bytes) != HDRP_OK ||
        !place_masks(l, &n)) {
        free_grid(&n);
        return false;
    }
    free_grid(g);
    *g = n;
    return true;
}

/* No tile needs more than all lights in all of its slices. */
static uint32_t room(const rd_lists* l, const hdrp_cull_desc* desc, uint32_t entries)
{
    uint32_t most = l->count * desc->slice_count;
    return entries < most ? entries : most;
}

static bool place_set(rd_lists* l)
{
    size_t bytes = hdrp_cull_set_memory_size(l->count);
    l->set_memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    return l->set_memory && hdrp_cull_set_init(&l->set, l->count, l->set_memory, bytes) == HDRP_OK;
}

static bool place_blockers(rd_lists* l, const hdrp_cull_blocker_scene* scene)
{
    hdrp_cull_blocker_desc d = {scene->light_count, scene->link_count, scene->blocker_count};
    size_t bytes = hdrp_cull_blocker_memory_size(&d);
    l->scene = scene;
    l->blocker_memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    return l->blocker_memory &&
           hdrp_cull_blocker_init(&l->blockers, &d, l->blocker_memory, bytes) == HDRP_OK;
}

bool rd_lists_begin(rd_lists* l, const rd_lights* lights, bool blocked, int width, int height,
                    float size_m)
{
    hdrp_cull_desc tiles, clusters;
    memset(l, 0, sizeof *l);
    if (lights->count == 0 || lights->count > HDRP_CULL_SHAPES_MAX) {
        l->left_out = lights->count;
        return true;
    }
    l->count = lights->count;
    l->threads = (uint32_t)omp_get_max_threads();
    l->shapes = (hdrp_cull_shape*)malloc(l->count * sizeof *l->shapes);
    l->depth = (float*)malloc((size_t)width * (size_t)height * sizeof *l->depth);
    memset(&tiles, 0, sizeof tiles);
    tiles.width_px = (uint32_t)width;
    tiles.height_px = (uint32_t)height;
    tiles.shape_capacity = l->count;
    clusters = tiles;
    tiles.tile_width_px = tiles.tile_height_px = TILE_PX;
    tiles.slice_count = 1u;
    tiles.flags = HDRP_CULL_PIXELS | HDRP_CULL_BLOCKS;
    tiles.entry_capacity = room(l, &tiles, TILE_ENTRIES);
    clusters.slice_count = SLICES;
    clusters.entry_capacity = room(l, &clusters, CLUSTER_ENTRIES);
    clusters.series_start_m = SERIES_START * size_m;
    if (!l->shapes || !l->depth || !place_set(l) ||
        (blocked && lights->blockers.link_count > 0u && !place_blockers(l, &lights->blockers)) ||
        !place_grid(l, &l->tiles, &tiles) || !place_grid(l, &l->clusters, &clusters)) {
        rd_lists_end(l);
        return false;
    }
    for (uint32_t i = 0; i < l->count; ++i) {
        l->shapes[i] = rd_variants_shape(lights, i);
    }
    return true;
}

void rd_lists_end(rd_lists* l)
{
    free(l->shapes);
    free(l->depth);
    free(l->set_memory);
    free(l->blocker_memory);
    free(l->blocker_scratch);
    free_grid(&l->tiles);
    free_grid(&l->clusters);
    memset(l, 0, sizeof *l);
}

/* >>stages */

/* What the camera sees through the samples of a sub-frame, as if they were centres of pixels: only
 * then are the pixels that lists are pruned by those that are lit. */
static hdrp_cull_camera camera_of(const rd_sub_frame* s)
{
    const rd_camera* c = &s->r->camera;
    float w = (float)c->width_px, h = (float)c->height_px;
    float x = s->jitter.x - 0.5f, y = s->jitter.y - 0.5f;
    float left = (2.0f * x / w - 1.0f) * c->half_width;
    float right = (2.0f * (x + w) / w - 1.0f) * c->half_width;
    float top = (1.0f - 2.0f * y / h) * c->half_height;
    float bottom = (1.0f - 2.0f * (y + h) / h) * c->half_height;
    return (c->orthographic ? hdrp_cull_camera_orthographic : hdrp_cull_camera_perspective)(
        c->eye, c->forward, c->up, left, right, bottom, top, 0.0f, HDRP_CULL_FAR_INFINITE);
}

static double stage(const rd_sub_frame* s, const char* name, double begin)
{
    double now = rd_now_ms();
    if (s->r->stats) {
        rd_stats_pass(s->r->stats, name, now - begin);
    }
    return now;
}

static bool project(const rd_sub_frame* s)
{
    rd_lists* l = &s->r->lists;
    hdrp_cull_camera camera = camera_of(s);
    return hdrp_cull_set_begin(&l->set, &camera, (uint32_t)s->r->width, (uint32_t)s->r->height,
                               l->count) == HDRP_OK &&
           hdrp_cull_set_project(&l->set, l->shapes, 0u, l->count) == HDRP_OK;
}

static void fill_depth(const rd_sub_frame* s)
{
    const rd_gbuffer* g = &s->r->gbuffer;
    rd_lists* l = &s->r->lists;
    int pixels = s->r->width * s->r->height;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < pixels; ++i) {
        l->depth[i] = g->kinds[i] == RD_PIXEL_SKY
                          ? INFINITY
                          : hdrp_cull_view_from_world(g->positions[i], l->set.camera).z;
    }
}

static bool measure(const rd_sub_frame* s, rd_grid* g, const hdrp_cull_depth* depth)
{
    int failed = hdrp_cull_begin(&g->lists, &s->r->lists.set) != HDRP_OK;
    int rows = (int)g->lists.grid.tiles.w;
#pragma omp parallel for schedule(static) reduction(| : failed)
    for (int y = 0; y < rows; ++y) {
        failed |= hdrp_cull_measure_depth(&g->lists, depth, (uint32_t)y, 1u) != HDRP_OK;
    }
    return !failed;
}

static bool build(const rd_sub_frame* s, rd_grid* g, const hdrp_cull_depth* depth)
{
    int rows = (int)hdrp_cull_rows(&g->lists), threads = (int)s->r->lists.threads, failed = 0;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) reduction(| : failed)
    for (int y = 0; y < rows; ++y) {
        unsigned char* scratch =
            (unsigned char*)g->scratch + (size_t)omp_get_thread_num() * g->scratch_bytes;
        failed |= hdrp_cull_build(&g->lists, &s->r->lists.set, depth, (uint32_t)y, 1u, scratch,
                                  g->scratch_bytes) != HDRP_OK;
    }
    return !failed && hdrp_cull_count(&g->lists, &g->counts) == HDRP_OK;
}

/* Twice the room, and all over again, for as long as something is dropped and there is memory. */
static bool build_grid(const rd_sub_frame* s, rd_grid* g, const hdrp_cull_depth* depth)
{
    rd_lists* l = &s->r->lists;
    bool ok = build(s, g, depth);
    while (ok && g->counts.dropped > 0u) {
        hdrp_cull_desc more = g->lists.desc;
        more.entry_capacity = room(l, &more, 2u * more.entry_capacity);
        if (more.entry_capacity == g->lists.desc.entry_capacity || !place_grid(l, g, &more)) {
            l->dropped += g->counts.dropped;
            l->full += g->counts.tiles_full;
            return true;
        }
        ok = measure(s, g, depth) && build(s, g, depth);
    }
    return ok;
}

/* Lights leave cells that blockers keep dark. */
static bool apply_blockers(const rd_sub_frame* s, rd_grid* g)
{
    rd_lists* l = &s->r->lists;
    size_t bytes = hdrp_cull_blocker_scratch_size(&l->blockers);
    hdrp_u32x4 tiles = g->lists.grid.tiles;
    int rows = (int)tiles.w, threads = (int)l->threads, failed = 0;
#pragma omp parallel num_threads(threads) reduction(| : failed)
    {
        hdrp_cull_blocker_job job;
        unsigned char* scratch =
            (unsigned char*)l->blocker_scratch + (size_t)omp_get_thread_num() * bytes;
        int ok = hdrp_cull_blocker_job_begin(&job, &l->blockers, scratch, bytes) == HDRP_OK;
        failed |= !ok;
#pragma omp for schedule(dynamic, 1)
        for (int y = 0; y < rows; ++y) {
            failed |= !ok || hdrp_cull_apply_blockers(&g->lists, &job, (uint32_t)y * tiles.z,
                                                      tiles.z, g->masks) != HDRP_OK;
        }
#pragma omp critical(rd_blocked)
        if (ok) {
            l->blocked.whole += job.stats.whole;
            l->blocked.pixel += job.stats.pixel;
            l->blocked.lights += job.stats.lights;
            l->blocked.lights_removed += job.stats.lights_removed;
        }
    }
    return !failed;
}

static bool block(const rd_sub_frame* s)
{
    rd_lists* l = &s->r->lists;
    uint32_t all = l->scene->light_count + l->scene->blocker_count;
    if (hdrp_cull_blocker_begin(&l->blockers, l->scene, &l->set.camera) != HDRP_OK ||
        hdrp_cull_blocker_project(&l->blockers, 0u, all) != HDRP_OK) {
        return false;
    }
    if (!l->blocker_scratch) {
        l->blocker_scratch = aligned_alloc(
            HDRP_MEMORY_ALIGNMENT, hdrp_cull_blocker_scratch_size(&l->blockers) * l->threads);
    }
    memset(&l->blocked, 0, sizeof l->blocked);
    return l->blocker_scratch && apply_blockers(s, &l->tiles) && apply_blockers(s, &l->clusters);
}

void rd_lists_build(const rd_sub_frame* s)
{
    rd_lists* l = &s->r->lists;
    hdrp_cull_depth depth = {l->depth, (size_t)s->r->width, NULL};
    double at = rd_now_ms();
    l->ready = false;
    if (l->count == 0u || !project(s)) {
        return;
    }
    at = stage(s, "lists: project", at);
    fill_depth(s);
    if (!measure(s, &l->tiles, &depth) || !measure(s, &l->clusters, &depth)) {
        return;
    }
    at = stage(s, "lists: depth", at);
    if (!build_grid(s, &l->tiles, &depth)) {
        return;
    }
    at = stage(s, "lists: tiles", at);
    l->ready = build_grid(s, &l->clusters, &depth);
    at = stage(s, "lists: clusters", at);
    if (l->ready && l->scene) {
        l->ready = block(s);
        stage(s, "lists: blockers", at);
    }
}

/* >>reading */

static void find(const hdrp_cull_lists* lists, float z_view, int x, int y, rd_shade_point* p)
{
    hdrp_u32 tile = hdrp_cull_tile_of_pixel(lists->grid, (hdrp_u32)x, (hdrp_u32)y);
    hdrp_u32 slice = hdrp_cull_slice(lists->grid, lists->tiles[tile].z, z_view);
    hdrp_u32x4 cell = lists->cells[hdrp_cull_cell(lists->grid, tile, slice)];
    p->x = (uint32_t)x;
    p->y = (uint32_t)y;
    p->first_entry = hdrp_cull_first(cell, HDRP_CULL_CATEGORY_PUNCTUAL);
    p->last_entry = hdrp_cull_last(cell, HDRP_CULL_CATEGORY_PUNCTUAL);
}

void rd_lists_find_tile(const rd_lists* l, int x, int y, rd_shade_point* p)
{
    find(&l->tiles.lists, 0.0f, x, y, p);
}

void rd_lists_find_cluster(const rd_lists* l, int x, int y, rd_shade_point* p)
{
    find(&l->clusters.lists, hdrp_cull_view_from_world(p->position, l->set.camera).z, x, y, p);
}
