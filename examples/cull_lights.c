/* cull_lights.c - lamps over a floor in front of a wall: which of them does each pixel visit?
 * SPDX-License-Identifier: MIT
 *
 *     cc -I. examples/cull_lights.c -lm && ./a.out
 *
 * Light lists are made twice, as a renderer does: in clusters, which serve any depth, and in
 * tiles of 16 x 16 pixels, which serve what the depth buffer shows and are pruned by its pixels.
 * Every pixel is lit from all lamps and from either list. Exits with 1 where that differs. */
#define HDRP_CULL_IMPLEMENTATION
#include "hdrp_cull.h"

#include <stdio.h>
#include <stdlib.h>

#define WIDTH  320u
#define HEIGHT 180u
#define LAMPS  96u

/* Memory of lists, which is the caller's. */
typedef struct grid {
    hdrp_cull_lists lists;
    void *memory, *scratch;
} grid;

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

/* Every fourth is a reflector that looks down. */
static hdrp_light lamp(hdrp_u32 i)
{
    hdrp_v2 u = hdrp_r2(i);
    hdrp_v3 p = v3(24.0f * u.x - 12.0f, 0.5f + (float)(i % 5u) * 0.5f, 30.0f * u.y);
    hdrp_v3 candela = hdrp_v3_splat(5.0f + (float)(i % 7u));
    return i % 4u == 0u ? hdrp_light_spot(p, v3(0.3f, -1.0f, 0.2f), candela, 6.0f, 0.4f, 0.7f)
                        : hdrp_light_point(p, candela, 3.5f);
}

/* Where the centre of a pixel looks; the camera is at (0, 2, 0) and looks along z. */
static hdrp_v3 ray(hdrp_u32 x, hdrp_u32 y)
{
    return v3(((float)x + 0.5f - 0.5f * (float)WIDTH) * (-2.0f / (float)HEIGHT),
              (0.5f * (float)HEIGHT - (float)y - 0.5f) * (2.0f / (float)HEIGHT), 1.0f);
}

/* Depth of the floor or, 30 m away and 6 m high, of the wall; above is sky. */
static float depth_of(hdrp_u32 x, hdrp_u32 y)
{
    hdrp_v3 r = ray(x, y);
    float floor_m = r.y < 0.0f ? -2.0f / r.y : HDRP_FLT_MAX;
    return floor_m < 30.0f ? floor_m : 2.0f + 30.0f * r.y < 6.0f ? 30.0f : HDRP_FLT_MAX;
}

/* Lists of the lamps: a block of memory for the size of picture, then what each frame does. */
static int grid_build(grid* g, const hdrp_cull_desc* desc, const hdrp_cull_set* set,
                      const hdrp_cull_depth* depth)
{
    size_t bytes = hdrp_cull_memory_size(desc), scratch_bytes = hdrp_cull_scratch_size(desc);
    hdrp_cull_lists* l = &g->lists;
    g->memory = malloc(bytes);
    g->scratch = malloc(scratch_bytes);
    return g->memory && g->scratch && hdrp_cull_init(l, desc, g->memory, bytes) == HDRP_OK &&
           hdrp_cull_begin(l, set) == HDRP_OK &&
           hdrp_cull_measure_depth(l, depth, 0u, l->grid.tiles.w) == HDRP_OK &&
           hdrp_cull_build(l, set, depth, 0u, hdrp_cull_rows(l), g->scratch, scratch_bytes) ==
               HDRP_OK; /* independent jobs could share the rows */
}

/* Lux of the lamps that the list of a pixel names, and how many these are: what a shader does. */
static float lit_from(const hdrp_cull_lists* l, const hdrp_light* lamps, hdrp_u32 x, hdrp_u32 y,
                      float z, hdrp_v3 position, double* visits)
{
    hdrp_u32 tile = hdrp_cull_tile_of_pixel(l->grid, x, y);
    hdrp_u32 slice = hdrp_cull_slice(l->grid, l->tiles[tile].z, z);
    hdrp_u32x4 cell = l->cells[hdrp_cull_cell(l->grid, tile, slice)];
    hdrp_u32 i, last = hdrp_cull_last(cell, HDRP_CULL_CATEGORY_PUNCTUAL);
    float lux = 0.0f;
    for (i = hdrp_cull_first(cell, HDRP_CULL_CATEGORY_PUNCTUAL); i < last; ++i) {
        if (hdrp_cull_entry_covers(l->grid, l->entries[i], x, y) != 0u) {
            lux += hdrp_light_eval(lamps[hdrp_cull_entry_index(l->entries[i])], position)
                       .illuminance.x;
            *visits += 1.0;
        }
    }
    return lux;
}

/* 1 where all pixels are lit alike. */
static int compare(const hdrp_cull_lists* clusters, const hdrp_cull_lists* tiles,
                   const hdrp_light* lamps, const float* texels)
{
    double pixels = 0.0, reached = 0.0, cluster_visits = 0.0, tile_visits = 0.0;
    int wrong = 0;
    hdrp_u32 i, k;
    for (i = 0u; i < WIDTH * HEIGHT; ++i) {
        hdrp_u32 x = i % WIDTH, y = i / WIDTH;
        float z = texels[i], lux = 0.0f;
        hdrp_v3 p = hdrp_v3_add(v3(0.0f, 2.0f, 0.0f), hdrp_v3_scale(ray(x, y), z));
        if (z == HDRP_FLT_MAX) {
            continue;
        }
        for (k = 0u; k < LAMPS; ++k) {
            float of_lamp = hdrp_light_eval(lamps[k], p).illuminance.x;
            lux += of_lamp;
            reached += of_lamp > 0.0f ? 1.0 : 0.0;
        }
        /* Lists are in the order of the lamps: the sums are the same to the last bit. */
        wrong += lit_from(clusters, lamps, x, y, z, p, &cluster_visits) != lux;
        wrong += lit_from(tiles, lamps, x, y, z, p, &tile_visits) != lux;
        pixels += 1.0;
    }
    printf("lamps that light a pixel %6.2f\nvisited in its tile      %6.2f\n", reached / pixels,
           tile_visits / pixels);
    printf("visited in its cluster   %6.2f\nwithout lists            %6.2f\n",
           cluster_visits / pixels, (double)LAMPS);
    return wrong == 0 && reached > pixels && tile_visits >= reached &&
           cluster_visits >= tile_visits;
}

int main(void)
{
    static hdrp_light lamps[LAMPS];
    static hdrp_cull_shape shapes[LAMPS];
    static float texels[WIDTH * HEIGHT];
    static grid clusters, tiles;
    const float aspect = (float)WIDTH / (float)HEIGHT;
    hdrp_cull_depth depth = {texels, WIDTH, NULL}; /* in metres */
    hdrp_cull_camera camera = hdrp_cull_camera_perspective(
        v3(0.0f, 2.0f, 0.0f), v3(0.0f, 0.0f, 1.0f), v3(0.0f, 1.0f, 0.0f), -aspect, aspect, -1.0f,
        1.0f, 0.1f, 1000.0f);
    hdrp_cull_desc desc = {0}; /* clusters of 32 x 32 pixels and 64 slices */
    hdrp_cull_desc fine;
    hdrp_cull_set set;
    size_t bytes = hdrp_cull_set_memory_size(LAMPS);
    void* memory = malloc(bytes);
    hdrp_u32 i;
    int good;
    desc.width_px = WIDTH;
    desc.height_px = HEIGHT;
    fine = desc;
    fine.tile_width_px = fine.tile_height_px = 16u;
    fine.slice_count = 1u;
    fine.flags = HDRP_CULL_BLOCKS;
    for (i = 0u; i < LAMPS; ++i) {
        lamps[i] = lamp(i);
        shapes[i] = hdrp_cull_shape_from_light(lamps[i]);
    }
    for (i = 0u; i < WIDTH * HEIGHT; ++i) {
        texels[i] = depth_of(i % WIDTH, i / WIDTH);
    }
    good = memory && hdrp_cull_set_init(&set, LAMPS, memory, bytes) == HDRP_OK &&
           hdrp_cull_set_begin(&set, &camera, WIDTH, HEIGHT, LAMPS) == HDRP_OK &&
           hdrp_cull_set_project(&set, shapes, 0u, LAMPS) == HDRP_OK &&
           grid_build(&clusters, &desc, &set, &depth) && grid_build(&tiles, &fine, &set, &depth) &&
           compare(&clusters.lists, &tiles.lists, lamps, texels);
    free(memory);
    free(clusters.memory);
    free(clusters.scratch);
    free(tiles.memory);
    free(tiles.scratch);
    printf("%s\n", good ? "the same light" : "not the same light");
    return good ? 0 : 1;
}
