/* cull_harness.c - see cull_harness.h.
 * SPDX-License-Identifier: MIT */
#include "cull_harness.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

void* cull_allocate(size_t bytes)
{
    void* p = aligned_alloc(HDRP_MEMORY_ALIGNMENT, HDRP_MEMORY_ROUND_UP(bytes > 0u ? bytes : 1u));
    if (p == NULL) {
        fprintf(stderr, "no memory for %zu bytes\n", bytes);
        exit(EXIT_FAILURE);
    }
    return p;
}

/* >>random numbers: Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators" */

uint64_t cull_bits(cull_random* r)
{
    uint64_t z = r->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double cull_uniform(cull_random* r, double lo, double hi)
{
    return lo + (hi - lo) * ((double)(cull_bits(r) >> 11) * 0x1p-53);
}

double cull_log_uniform(cull_random* r, double lo, double hi)
{
    return exp(cull_uniform(r, log(lo), log(hi)));
}

uint32_t cull_below(cull_random* r, uint32_t end)
{
    return (uint32_t)((cull_bits(r) >> 32) * end >> 32);
}

hdrp_v3 cull_direction(cull_random* r)
{
    double z = cull_uniform(r, -1.0, 1.0), azimuth = cull_uniform(r, 0.0, 6.283185307179586);
    double across = sqrt(1.0 - z * z);
    return hdrp_v3_make((float)(across * cos(azimuth)), (float)(across * sin(azimuth)), (float)z);
}

/* >>shapes */

const char* cull_type_string(cull_type type)
{
    static const char* const names[CULL_TYPES] = {"directional", "point", "spot",   "wide spot",
                                                  "pyramid",     "box",   "sphere", "disc",
                                                  "rectangle",   "line",  "probe",  "box probe"};
    return names[type];
}

hdrp_light cull_area_light(uint32_t type, hdrp_v3 position, hdrp_v3 forward, hdrp_v3 up,
                           float range, float half_x, float half_y, float radius)
{
    hdrp_v3 one = hdrp_v3_splat(1.0f);
    hdrp_light light = hdrp_light_box(position, forward, up, one, half_x, half_y, range, 1.0f);
    light.half_angle = hdrp_v4_make(-1.0f, 0.0f, -1.0f, 0.0f);
    light.forward_radius.w = radius;
    light.bits.x = type;
    return light;
}

hdrp_light cull_light_of_item(const cull_item* i)
{
    hdrp_v3 one = hdrp_v3_splat(1.0f);
    hdrp_light l = hdrp_light_point(i->position, one, i->range);
    if (i->light != NULL) {
        return *i->light;
    }
    switch (i->type) {
    case CULL_DIRECTIONAL:
        l = hdrp_light_directional(i->forward, one, 0.01f);
        break;
    case CULL_SPOT:
    case CULL_SPOT_WIDE:
        l = hdrp_light_spot(i->position, i->forward, one, i->range, 0.5f * i->half_angle_x,
                            i->half_angle_x);
        break;
    case CULL_PYRAMID:
        l = hdrp_light_pyramid(i->position, i->forward, i->up, one, i->range, i->half_angle_x,
                               i->half_angle_y, 0.2f);
        break;
    case CULL_BOX:
        l = hdrp_light_box(i->position, i->forward, i->up, one, i->half_x, i->half_y, i->range,
                           0.1f);
        break;
    case CULL_SPHERE:
        l = cull_area_light(HDRP_LIGHT_TYPE_SPHERE, i->position, i->forward, i->up, i->range, 0.0f,
                            0.0f, i->half_x);
        break;
    case CULL_DISC:
        l = cull_area_light(HDRP_LIGHT_TYPE_DISC, i->position, i->forward, i->up, i->range, 0.0f,
                            0.0f, i->half_x);
        break;
    case CULL_RECTANGLE:
        l = cull_area_light(HDRP_LIGHT_TYPE_RECTANGLE, i->position, i->forward, i->up, i->range,
                            i->half_x, i->half_y, 0.0f);
        break;
    case CULL_LINE:
        l = cull_area_light(HDRP_LIGHT_TYPE_LINE, i->position, i->forward, i->up, i->range,
                            i->half_x, 0.0f, 0.0f);
        break;
    default:
        break;
    }
    l.edge_importance.w = i->importance;
    return l;
}

hdrp_cull_shape cull_shape_of_item(const cull_item* i)
{
    hdrp_cull_shape s;
    if (i->type == CULL_PROBE) {
        s = hdrp_cull_shape_sphere(i->position, i->range, HDRP_CULL_CATEGORY_ENVIRONMENT);
    } else if (i->type == CULL_PROBE_BOX) {
        s = hdrp_cull_shape_box(i->position, i->forward, i->up, i->half_x * i->range,
                                i->half_y * i->range, i->half_z * i->range,
                                HDRP_CULL_CATEGORY_DECAL);
    } else {
        return hdrp_cull_shape_from_light(cull_light_of_item(i));
    }
    s.bits.w = hdrp_bits_from_f32(i->importance);
    return s;
}

ref_body cull_body_of_item(const cull_item* i, const hdrp_cull_camera* camera)
{
    hdrp_light light;
    if (i->type == CULL_PROBE) {
        return ref_body_of_sphere(i->position, i->range, camera);
    }
    if (i->type == CULL_PROBE_BOX) {
        hdrp_v3 half =
            hdrp_v3_make(i->half_x * i->range, i->half_y * i->range, i->half_z * i->range);
        return ref_body_of_box(i->position, i->forward, i->up, half, camera);
    }
    light = cull_light_of_item(i);
    return ref_body_of_light(&light, camera);
}

void cull_print_item(FILE* file, const cull_item* i)
{
    const float* f = (const float*)i->light;
    fprintf(file, f != NULL ? "  record" : "");
    for (int k = 0; f != NULL && k < 28; ++k) { /* without its bits */
        fprintf(file, " %a", (double)f[k]);
    }
    fprintf(file, f != NULL ? "\n" : "");
    fprintf(file,
            "  %s: position %a %a %a forward %a %a %a up %a %a %a range %a half %a %a %a "
            "half angles %a %a\n",
            cull_type_string(i->type), (double)i->position.x, (double)i->position.y,
            (double)i->position.z, (double)i->forward.x, (double)i->forward.y, (double)i->forward.z,
            (double)i->up.x, (double)i->up.y, (double)i->up.z, (double)i->range, (double)i->half_x,
            (double)i->half_y, (double)i->half_z, (double)i->half_angle_x, (double)i->half_angle_y);
}

/* >>scenes */

void cull_scene_init(cull_test_scene* scene, uint32_t capacity)
{
    memset(scene, 0, sizeof *scene);
    scene->capacity = capacity;
    scene->items = cull_allocate(capacity * sizeof *scene->items);
    memset(scene->items, 0, capacity * sizeof *scene->items);
}

void cull_scene_free(cull_test_scene* scene)
{
    free(scene->items);
    free(scene->texels);
    free(scene->shapes);
    free(scene->bodies);
    free(scene->listed);
    free(scene->set_memory);
    free(scene->lists_memory);
    free(scene->scratch);
    memset(scene, 0, sizeof *scene);
}

static bool failed(hdrp_result r, const char* what)
{
    if (r != HDRP_OK) {
        fprintf(stderr, "%s: %s\n", what, hdrp_result_string(r));
    }
    return r != HDRP_OK;
}

/* Bits of what each cell lists, read as a shader reads it. */
static void read_lists(cull_test_scene* s)
{
    const hdrp_cull_lists* l = &s->lists;
    size_t cells = (size_t)l->grid.tiles.z * l->grid.tiles.w * l->grid.cells.x;
    s->stride = (s->count + 31u) / 32u + 1u;
    free(s->listed);
    s->listed = cull_allocate(cells * s->stride * sizeof *s->listed);
    memset(s->listed, 0, cells * s->stride * sizeof *s->listed);
    for (size_t c = 0; c < cells; ++c) {
        for (uint32_t category = 0; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
            uint32_t i = hdrp_cull_first(l->cells[c], category);
            for (; i < hdrp_cull_last(l->cells[c], category); ++i) {
                uint32_t item = hdrp_cull_entry_index(l->entries[i]);
                s->listed[c * s->stride + item / 32u] |= 1u << (item % 32u);
            }
        }
    }
}

bool cull_scene_run(cull_test_scene* s)
{
    hdrp_cull_depth depth = {s->texels, s->desc.width_px, s->device};
    size_t set_bytes = hdrp_cull_set_memory_size(s->capacity);
    size_t bytes = hdrp_cull_memory_size(&s->desc), scratch = hdrp_cull_scratch_size(&s->desc);
    if (bytes == 0u || scratch == 0u) {
        fprintf(stderr, "the descriptor is not valid\n");
        return false;
    }
    free(s->shapes);
    free(s->bodies);
    free(s->set_memory);
    free(s->lists_memory);
    free(s->scratch);
    s->shapes = cull_allocate(s->capacity * sizeof *s->shapes);
    s->bodies = cull_allocate(s->capacity * sizeof *s->bodies);
    s->set_memory = cull_allocate(set_bytes);
    s->lists_memory = cull_allocate(bytes);
    s->scratch = cull_allocate(scratch);
    for (uint32_t i = 0; i < s->count; ++i) {
        s->shapes[i] = cull_shape_of_item(&s->items[i]);
        s->bodies[i] = cull_body_of_item(&s->items[i], &s->camera);
    }
    if (failed(hdrp_cull_set_init(&s->set, s->capacity, s->set_memory, set_bytes), "set_init") ||
        failed(hdrp_cull_init(&s->lists, &s->desc, s->lists_memory, bytes), "init") ||
        failed(
            hdrp_cull_set_begin(&s->set, &s->camera, s->desc.width_px, s->desc.height_px, s->count),
            "set_begin") ||
        failed(hdrp_cull_set_project(&s->set, s->shapes, 0, s->count), "set_project") ||
        failed(hdrp_cull_begin(&s->lists, &s->set), "begin")) {
        return false;
    }
    if (s->texels != NULL &&
        failed(hdrp_cull_measure_depth(&s->lists, &depth, 0, s->lists.grid.tiles.w),
               "measure_depth")) {
        return false;
    }
    if (failed(hdrp_cull_build(&s->lists, &s->set, s->texels != NULL ? &depth : NULL, 0,
                               hdrp_cull_rows(&s->lists), s->scratch, scratch),
               "build")) {
        return false;
    }
    read_lists(s);
    return true;
}

bool cull_scene_lists(const cull_test_scene* s, uint32_t cell, uint32_t item)
{
    return (s->listed[(size_t)cell * s->stride + item / 32u] >> (item % 32u) & 1u) != 0u;
}

bool cull_scene_covers(const cull_test_scene* s, uint32_t entry, uint32_t x, uint32_t y)
{
    hdrp_cull_grid g = s->lists.grid;
    if (s->lists.masks != NULL) {
        uint32_t word = s->lists.masks[hdrp_cull_mask_word(g, entry, x, y)];
        if ((word >> hdrp_cull_mask_bit(g, x, y) & 1u) == 0u) {
            return false;
        }
    }
    return hdrp_cull_entry_covers(g, s->lists.entries[entry], x, y) != 0u;
}

ref_cell cull_scene_tile(const cull_test_scene* s, uint32_t tile)
{
    hdrp_u32x4 size = s->lists.grid.tiles;
    uint32_t x = tile % size.z * size.x, y = tile / size.z * size.y;
    return ref_cell_of_pixels(&s->camera, x, y, x + size.x, y + size.y, s->desc.width_px,
                              s->desc.height_px);
}

float cull_scene_depth_of_pixel(const cull_test_scene* s, uint32_t x, uint32_t y)
{
    float z = s->texels[(size_t)y * s->desc.width_px + x];
    z = s->device != NULL ? hdrp_view_depth(*s->device, z) : z;
    /* What is within a millionth of the far distance counts as sky. */
    if (!(z >= 0.0f && z < s->camera.right_far.w * (1.0f - 1e-6f))) {
        return -1.0f;
    }
    return z < s->camera.eye_near.w ? s->camera.eye_near.w : z;
}

void cull_scene_slices(const cull_test_scene* s, uint32_t tile, float* lo, float* hi)
{
    const hdrp_cull_lists* l = &s->lists;
    uint32_t x0 = tile % l->grid.tiles.z * l->grid.tiles.x;
    uint32_t y0 = tile / l->grid.tiles.z * l->grid.tiles.y;
    ref_slices(l->grid, l->tiles[tile].z, s->camera.eye_near.w, s->camera.right_far.w, lo, hi);
    if (s->texels == NULL || l->grid.cells.x > 1u) {
        return;
    }
    lo[0] = HDRP_CULL_FAR_INFINITE;
    hi[0] = -1.0f;
    for (uint32_t y = y0; y < y0 + l->grid.tiles.y && y < s->desc.height_px; ++y) {
        for (uint32_t x = x0; x < x0 + l->grid.tiles.x && x < s->desc.width_px; ++x) {
            float z = cull_scene_depth_of_pixel(s, x, y);
            lo[0] = z >= 0.0f && z < lo[0] ? z : lo[0];
            hi[0] = z > hi[0] ? z : hi[0];
        }
    }
}

void cull_print_scene(FILE* file, const cull_test_scene* s)
{
    const hdrp_cull_camera* c = &s->camera;
    const hdrp_v4 rows[5] = {c->eye_near, c->right_far, c->up, c->forward_orthographic, c->window};
    fprintf(file, "  camera");
    for (int i = 0; i < 5; ++i) {
        fprintf(file, " {%a, %a, %a, %a}", (double)rows[i].x, (double)rows[i].y, (double)rows[i].z,
                (double)rows[i].w);
    }
    fprintf(file,
            "\n  picture %u x %u, tiles %u x %u, %u slices, flags %u, series %a %a, %s, %u "
            "shapes\n",
            s->desc.width_px, s->desc.height_px, s->desc.tile_width_px, s->desc.tile_height_px,
            s->desc.slice_count, s->desc.flags, (double)s->desc.series_start_m,
            (double)s->desc.series_end_m, s->texels != NULL ? "depth" : "no depth", s->count);
}

/* >>comparison */

static void print_missed(const cull_test_scene* s, uint64_t seed, uint32_t item, uint32_t tile,
                         const ref_cell* cell, uint32_t slice)
{
    static int printed = 0;
    ref_v3 p = {0, 0, 0};
    hdrp_cull_bounds b = s->set.bounds[item];
    if (++printed > 20) {
        return;
    }
    ref_intersect(&s->bodies[item], cell, &p);
    printf("missed: scene %" PRIu64 ", shape %u, tile %u (column %u, row %u), slice %u of depths "
           "%La to %La, seen at (%La, %La, %La)\n",
           seed, item, tile, tile % s->lists.grid.tiles.z, tile / s->lists.grid.tiles.z, slice,
           cell->z0, cell->z1, p.x, p.y, p.z);
    printf("  bounds: pixels %a %a %a %a, depths %a %a\n", (double)b.rect_px.x, (double)b.rect_px.y,
           (double)b.rect_px.z, (double)b.rect_px.w, (double)b.nearest, (double)b.farthest);
    cull_print_item(stdout, &s->items[item]);
    cull_print_scene(stdout, s);
}

/* Which columns, or rows, a body may be in. */
static void find_strips(const cull_test_scene* s, uint32_t item, bool columns, uint8_t* seen)
{
    hdrp_u32x4 size = s->lists.grid.tiles;
    uint32_t w = s->desc.width_px, h = s->desc.height_px;
    for (uint32_t i = 0; i < (columns ? size.z : size.w); ++i) {
        ref_cell strip =
            columns ? ref_cell_of_pixels(&s->camera, i * size.x, 0, (i + 1u) * size.x, h, w, h)
                    : ref_cell_of_pixels(&s->camera, 0, i * size.y, w, (i + 1u) * size.y, w, h);
        ref_kind kind = s->bodies[item].kind;
        seen[i] = kind == REF_EVERYTHING ||
                  (kind != REF_NOTHING && !ref_outside_a_side(&s->bodies[item], &strip));
    }
}

static void compare_tile(const cull_test_scene* s, uint64_t seed, uint32_t item, uint32_t tile,
                         const float* lo, const float* hi, cull_tally* t)
{
    uint32_t slices = s->lists.grid.cells.x;
    bool reached[HDRP_CULL_SLICES_MAX];
    cull_type type = s->items[item].type;
    ref_cell cell = cull_scene_tile(s, tile);
    cell.z0 = lo[0];
    cell.z1 = hi[slices - 1u];
    if (cell.z0 > cell.z1) {
        return; /* only sky */
    }
    ref_reach(&s->bodies[item], &cell, lo, hi, slices, reached, &t->unknown);
    t->asked += 1u;
    for (uint32_t k = 0; k < slices; ++k) {
        t->reached[type] += reached[k] ? 1u : 0u;
        if (reached[k] && !cull_scene_lists(s, tile * slices + k, item)) {
            t->missed[type] += 1u;
            cell.z0 = lo[k];
            cell.z1 = hi[k];
            print_missed(s, seed, item, tile, &cell, k);
        }
    }
}

void cull_scene_compare(const cull_test_scene* s, uint64_t seed, cull_tally* t)
{
    hdrp_u32x4 size = s->lists.grid.tiles;
    uint32_t tiles = size.z * size.w, slices = s->lists.grid.cells.x;
    uint8_t* strips = cull_allocate((size_t)s->count * (size.z + size.w));
    float lo[HDRP_CULL_SLICES_MAX], hi[HDRP_CULL_SLICES_MAX], scale = -1.0f;
    for (uint32_t i = 0; i < s->count; ++i) {
        uint8_t* strip = strips + (size_t)i * (size.z + size.w);
        find_strips(s, i, true, strip);
        find_strips(s, i, false, strip + size.z);
    }
    for (uint32_t tile = 0; tile < tiles; ++tile) {
        if (s->lists.tiles[tile].z != scale || slices == 1u) {
            cull_scene_slices(s, tile, lo, hi);
            scale = s->lists.tiles[tile].z;
        }
        for (uint32_t i = 0; i < s->count; ++i) {
            const uint8_t* strip = strips + (size_t)i * (size.z + size.w);
            if (strip[tile % size.z] != 0u && strip[size.z + tile / size.z] != 0u) {
                compare_tile(s, seed, i, tile, lo, hi, t);
            }
        }
        for (uint32_t c = tile * slices; c < (tile + 1u) * slices; ++c) {
            for (uint32_t i = hdrp_cull_first(s->lists.cells[c], 0);
                 i < hdrp_cull_last(s->lists.cells[c], HDRP_CULL_CATEGORY_DECAL); ++i) {
                t->listed[s->items[hdrp_cull_entry_index(s->lists.entries[i])].type] += 1u;
            }
        }
    }
    free(strips);
}

uint64_t cull_total(const uint64_t counts[CULL_TYPES])
{
    uint64_t sum = 0u;
    for (int i = 0; i < CULL_TYPES; ++i) {
        sum += counts[i];
    }
    return sum;
}

void cull_print_tally(FILE* file, const cull_tally* t)
{
    for (int i = 0; i < CULL_TYPES; ++i) {
        if (t->reached[i] > 0u) {
            fprintf(file, "  %-11s %9" PRIu64 " pairs, %" PRIu64 " missed, listed %.4f times\n",
                    cull_type_string((cull_type)i), t->reached[i], t->missed[i],
                    (double)t->listed[i] / (double)t->reached[i]);
        }
    }
    fprintf(file,
            "  %-11s %9" PRIu64 " pairs, %" PRIu64 " missed; %" PRIu64 " tiles asked for, %" PRIu64
            " results without certificate\n",
            "all", cull_total(t->reached), cull_total(t->missed), t->asked, t->unknown);
}
