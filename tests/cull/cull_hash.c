/* cull_hash.c - prints a hash of the lists of each of some scenes, the same from every compiler.
 * SPDX-License-Identifier: MIT
 *
 * "cull_hash FILE" writes it to a file. */
#define HDRP_CULL_IMPLEMENTATION
#include "cull_hash.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

/* Fowler, Noll and Vo, FNV-1a. */
static uint64_t hash_bytes(uint64_t hash, const void* memory, size_t bytes)
{
    const unsigned char* p = memory;
    for (size_t i = 0; i < bytes; ++i) {
        hash = (hash ^ p[i]) * 0x100000001b3u;
    }
    return hash;
}

static uint64_t hash_lists(const hdrp_cull_lists* l)
{
    size_t tiles = (size_t)l->grid.tiles.z * l->grid.tiles.w, cells = tiles * l->grid.cells.x;
    uint64_t hash = 0xcbf29ce484222325u;
    hash = hash_bytes(hash, &l->grid, sizeof l->grid);
    hash = hash_bytes(hash, l->tiles, tiles * sizeof *l->tiles);
    hash = hash_bytes(hash, l->cells, cells * sizeof *l->cells);
    hash = hash_bytes(hash, l->tile_dropped, tiles * sizeof *l->tile_dropped);
    for (size_t c = 0; c < cells; ++c) {
        uint32_t first = hdrp_cull_first(l->cells[c], 0u);
        uint32_t count = hdrp_cull_last(l->cells[c], 3u) - first;
        size_t words = hdrp_cull_mask_words(l->grid);
        hash = hash_bytes(hash, l->entries + first, count * sizeof *l->entries);
        if (l->masks) {
            hash = hash_bytes(hash, l->masks + first * words, count * words * sizeof *l->masks);
        }
    }
    return hash;
}

static void* block(size_t bytes)
{
    return aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
}

/* The depths of a scene, read as those of a device: of a projection in round numbers, for making one
 * may round differently. Any will do, as long as it is the same one. */
static float* device_texels(const cull_hash_scene* s)
{
    size_t count = (size_t)s->desc.width_px * s->desc.height_px;
    float* texels = malloc(count * sizeof *texels);
    for (size_t i = 0; texels && i < count; ++i) {
        texels[i] = s->texels[i] / 256.0f;
    }
    return texels;
}

static int run(FILE* file, const cull_hash_scene* s, uint32_t index, int device_depth)
{
    const hdrp_depth_params device = {{-0.3f, 1.3f, 0.37f, 0.013f}, {0.7f, 0.1f, 0.0f, 0.0f}};
    float* texels = device_depth ? device_texels(s) : NULL;
    hdrp_cull_depth depth = {texels ? texels : s->texels, s->desc.width_px,
                             texels ? &device : NULL};
    hdrp_cull_set set;
    hdrp_cull_lists lists;
    hdrp_cull_stats stats;
    size_t set_bytes = hdrp_cull_set_memory_size(CULL_HASH_SHAPES_MAX);
    size_t bytes = hdrp_cull_memory_size(&s->desc),
           scratch_bytes = hdrp_cull_scratch_size(&s->desc);
    void *a = block(set_bytes), *b = block(bytes), *scratch = block(scratch_bytes);
    int ok = a && b && scratch &&
             hdrp_cull_set_init(&set, CULL_HASH_SHAPES_MAX, a, set_bytes) == HDRP_OK &&
             hdrp_cull_init(&lists, &s->desc, b, bytes) == HDRP_OK &&
             hdrp_cull_set_begin(&set, &s->camera, s->desc.width_px, s->desc.height_px, s->count) ==
                 HDRP_OK &&
             hdrp_cull_set_project(&set, s->shapes, 0u, s->count) == HDRP_OK &&
             hdrp_cull_begin(&lists, &set) == HDRP_OK &&
             (!s->texels ||
              hdrp_cull_measure_depth(&lists, &depth, 0u, lists.grid.tiles.w) == HDRP_OK) &&
             hdrp_cull_build(&lists, &set, s->texels ? &depth : NULL, 0u, hdrp_cull_rows(&lists),
                             scratch, scratch_bytes) == HDRP_OK &&
             hdrp_cull_count(&lists, &stats) == HDRP_OK;
    if (ok) {
        fprintf(file, "%2u %016" PRIx64 " %" PRIu64 " entries, %" PRIu64 " dropped\n", index,
                hash_lists(&lists), stats.entries, stats.dropped);
    }
    free(texels);
    free(a);
    free(b);
    free(scratch);
    return ok;
}

int main(int argc, char** argv)
{
    static cull_hash_scene scene;
    FILE* file = argc > 1 ? fopen(argv[1], "w") : stdout;
    int ok = file != NULL;
    for (uint32_t i = 0; ok && i < CULL_HASH_SCENES; ++i) {
        cull_hash_scene_make(&scene, i);
        ok = run(file, &scene, i, 0) && (!scene.texels || run(file, &scene, i, 1));
        free(scene.texels);
    }
    if (!ok || (file != stdout && fclose(file) != 0)) {
        fprintf(stderr, "cull_hash: a stage failed\n");
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
