/* fuzz_cull.c - libFuzzer target: whatever the bytes say, light culling fails with an error or makes
 * lists that are well formed, hold what reaches some places and do not depend on how the work was
 * split. fuzz_blockers.c and fuzz_variants.c go on with these lists.
 * SPDX-License-Identifier: MIT
 *
 * Blocks of memory are allocated exactly, so that AddressSanitizer sees what is written past them,
 * and are filled with bytes that differ between two runs of the same frame, so that lists that depend
 * on them differ. FUZZ_CULL_PRINT=1 in the environment prints what an input stands for. */
#define HDRP_CULL_IMPLEMENTATION
#include "cull_reference.h"
#include "fuzz.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define SHAPES_MAX 32u
/* What one input may cost. */
#define CELLS_MAX  1024u
#define PIXELS_MAX 4096u
#define BYTES_MAX  (256u << 10)
/* Flags that ask for one slice and a depth buffer. */
#define OF_PIXELS (HDRP_CULL_PIXELS | HDRP_CULL_BLOCKS | HDRP_CULL_MASKS)

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

/* Blocks that are freed are kept for a while; not for so long that all are new memory. */
const char* __asan_default_options(void);
const char* __asan_default_options(void)
{
    return "quarantine_size_mb=8:allocator_release_to_os_interval_ms=-1";
}

/* ---- bytes ----------------------------------------------------------------------------------- */

uint32_t read_u8(reader* r)
{
    if (r->at < r->size) {
        return r->data[r->at++];
    }
    return r->size > 0u ? hdrp_hash2(++r->after, r->data[0]) >> 24 : 0u;
}

uint32_t read_u16(reader* r)
{
    uint32_t low = read_u8(r);
    return low | read_u8(r) << 8;
}

uint32_t read_u32(reader* r)
{
    uint32_t low = read_u16(r);
    return low | read_u16(r) << 16;
}

uint32_t read_below(reader* r, uint32_t end)
{
    return (end > 256u ? read_u16(r) : read_u8(r)) % end;
}

float read_float(reader* r)
{
    static const uint32_t special[] = {
        0x00000000u, 0x80000000u, 0x00000001u, 0x80000001u, /* zeros, denormals */
        0x007fffffu, 0x00800000u, 0x3f800000u, 0xbf800000u, /* FLT_MIN, 1 */
        0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffc00000u, /* infinities, NaN */
        0x7f7fffffu, 0xff7fffffu, 0x5d5e0b6bu, 0xdd5e0b6bu, /* FLT_MAX, 1e18 */
        0x358637bdu, 0x3a83126fu, 0x5368d4a5u, 0x4e6e6b28u, /* 1e-6, 1e-3, 1e12, 1e9 */
        0x3fc90fdbu, 0x40490fdbu, 0x7f800001u, 0x459c4000u, /* pi / 2, pi, sNaN, 5000 */
    };
    uint32_t how = read_u8(r);
    if (how < 24u) {
        return hdrp_f32_from_bits(special[how % (sizeof special / sizeof *special)]);
    }
    if (how < 40u) {
        return hdrp_f32_from_bits(read_u32(r));
    }
    if (how < 100u) { /* integers, half of them negative */
        return (float)(int8_t)read_u8(r);
    }
    if (how < 180u) {
        return ((float)read_u16(r) - 32768.0f) * (1.0f / 1024.0f);
    }
    return (float)read_u16(r) * (1.0f / 16384.0f);
}

hdrp_v3 read_v3(reader* r)
{
    float x = read_float(r), y = read_float(r);
    return hdrp_v3_make(x, y, read_float(r));
}

/* ---- what is culled -------------------------------------------------------------------------- */

/* Everything that an input stands for. */
typedef struct frame {
    hdrp_cull_desc desc;
    hdrp_cull_camera camera;
    uint32_t set_capacity, count;
    hdrp_cull_shape shapes[SHAPES_MAX];
    hdrp_v4 places[SHAPES_MAX]; /* hdrp_cull_light_place, or a point */
    ref_body
        bodies[SHAPES_MAX]; /* the same, for the reference; nothing where a shape is not valid */
    bool has_depth;
    float* texels;
    hdrp_depth_params device;
    hdrp_cull_depth depth;
    uint32_t split_seed;
} frame;

static hdrp_cull_desc read_desc(reader* r)
{
    hdrp_cull_desc d;
    uint32_t how = read_u8(r);
    memset(&d, 0, sizeof d);
    d.width_px = 1u + read_below(r, 80u);
    d.height_px = 1u + read_below(r, 80u);
    if (how >= 230u) { /* long and thin */
        d.width_px = 1u + read_below(r, HDRP_CULL_SIZE_MAX);
        d.height_px = 1u;
    }
    d.tile_width_px = read_below(r, 65u);
    d.tile_height_px = read_below(r, 65u);
    d.slice_count = read_below(r, 3u) == 0u ? 1u : read_below(r, HDRP_CULL_SLICES_MAX + 1u);
    d.shape_capacity = SHAPES_MAX + read_u8(r) % 4u;
    d.flags = read_u8(r);
    d.flags &= d.flags < 128u ? 31u : HDRP_CULL_FAST | HDRP_CULL_ONE_SERIES;
    if (d.flags & OF_PIXELS) {
        d.slice_count = 1u;
    }
    if (read_below(r, 3u) != 0u) { /* few, and now and then too few */
        d.entry_capacity = read_u8(r);
        d.entry_capacity += d.entry_capacity < 250u ? d.slice_count : 0u;
    }
    if (read_u8(r) < 64u) {
        d.series_start_m = read_float(r);
        d.series_end_m = read_float(r);
    }
    if (how < 16u) { /* anything in one member */
        uint32_t value = read_u32(r);
        memcpy((char*)&d + sizeof value * read_below(r, sizeof d / sizeof value), &value,
               sizeof value);
    }
    return d;
}

static hdrp_cull_camera read_camera(reader* r)
{
    uint32_t how = read_u8(r);
    hdrp_v3 eye = hdrp_v3_splat(0.0f), forward = hdrp_v3_make(0.0f, 0.0f, -1.0f);
    hdrp_v3 up = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    float edge[4] = {-1.0f, 1.0f, -0.75f, 0.75f}, near_m = 0.1f, far_m = 100.0f;
    if (how & 1u) {
        eye = read_v3(r);
        forward = read_v3(r);
        up = read_v3(r);
    }
    if (how & 2u) {
        for (int i = 0; i < 4; ++i) {
            edge[i] = read_float(r);
        }
    }
    if (how & 4u) {
        near_m = read_float(r);
        far_m = read_float(r);
    }
    return (how & 8u)
               ? hdrp_cull_camera_orthographic(eye, forward, up, edge[0] * 10.0f, edge[1] * 10.0f,
                                               edge[2] * 10.0f, edge[3] * 10.0f, near_m, far_m)
               : hdrp_cull_camera_perspective(eye, forward, up, edge[0], edge[1], edge[2], edge[3],
                                              near_m, far_m);
}

/* An area light, for which there is no maker yet. */
static hdrp_light area_light(reader* r, hdrp_u32 type)
{
    hdrp_v3 position = read_v3(r), forward = read_v3(r);
    float x = read_float(r), y = read_float(r);
    hdrp_light light = hdrp_light_pyramid(position, forward, read_v3(r), hdrp_v3_splat(1.0f),
                                          read_float(r), 1.0f, 1.0f, 0.5f);
    light.right_half_width.w = hdrp_clamp(x, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    light.up_half_height.w = hdrp_clamp(y, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    light.forward_radius.w = hdrp_clamp(x, 0.0f, HDRP_LIGHT_RANGE_INFINITE);
    light.bits.x = type;
    return light;
}

static hdrp_light read_light(reader* r, uint32_t type)
{
    hdrp_v3 white = hdrp_v3_splat(1.0f), position, forward, up;
    float range, x, y;
    if (type >= HDRP_LIGHT_TYPE_SPHERE) {
        return area_light(r, type);
    }
    position = read_v3(r);
    range = read_float(r);
    if (type == HDRP_LIGHT_TYPE_POINT) {
        return hdrp_light_point(position, white, range);
    }
    forward = read_v3(r);
    x = read_float(r);
    if (type == HDRP_LIGHT_TYPE_SPOT) {
        return hdrp_light_spot(position, forward, white, range, 0.5f * x, x);
    }
    y = read_float(r);
    up = read_v3(r);
    if (type == HDRP_LIGHT_TYPE_PYRAMID) {
        return hdrp_light_pyramid(position, forward, up, white, range, x, y, 0.1f);
    }
    return type == HDRP_LIGHT_TYPE_BOX
               ? hdrp_light_box(position, forward, up, white, x, y, range, 0.1f)
               : hdrp_light_directional(forward, white, x);
}

/* Any bits as a record, of a type that exists or of none. */
static hdrp_light read_record(reader* r)
{
    hdrp_light light;
    uint32_t type = read_u8(r);
    for (size_t i = 0; i < sizeof light / sizeof(uint32_t); ++i) {
        uint32_t word = hdrp_bits_from_f32(read_float(r));
        memcpy((char*)&light + i * sizeof word, &word, sizeof word);
    }
    light.bits.x = type < 200u ? type % 12u : light.bits.x;
    return light;
}

static hdrp_cull_shape read_shape(reader* r, const hdrp_cull_camera* camera, ref_body* body,
                                  hdrp_v4* place)
{
    uint32_t how = read_u8(r);
    hdrp_cull_shape shape;
    hdrp_light light;
    memset(body, 0, sizeof *body);
    body->kind = REF_NOTHING;
    if (how < 32u) {
        shape = hdrp_cull_shape_from_light(read_record(r));
    } else if (how < 60u) {
        hdrp_v3 center = read_v3(r);
        float radius = read_float(r);
        shape = hdrp_cull_shape_sphere(center, radius, how & 3u);
        *body = ref_body_of_sphere(center, radius, camera);
    } else if (how < 90u) {
        hdrp_v3 center = read_v3(r), forward = read_v3(r), up = read_v3(r), half = read_v3(r);
        shape = hdrp_cull_shape_box(center, forward, up, half.x, half.y, half.z, how & 3u);
        *body = ref_body_of_box(center, forward, up, half, camera);
    } else {
        light = read_light(r, how % 10u);
        shape = hdrp_cull_shape_from_light(light);
        *body = ref_body_of_light(&light, camera);
        *place = hdrp_cull_light_place(light);
    }
    if (hdrp_cull_shape_kind(shape) == HDRP_CULL_KIND_NONE) {
        body->kind = REF_NOTHING;
    }
    if (how < 90u || body->kind == REF_NOTHING) {
        *place = hdrp_v4_from_v3(hdrp_v3_from_v4(shape.center_range), 1.0f);
    }
    if (how & 64u) {
        shape = hdrp_cull_shape_with_features(shape, 1u << read_below(r, 32u), ~0u, read_float(r));
    }
    return shape;
}

static void read_depth(reader* r, frame* f)
{
    uint32_t how = read_u8(r), seed = read_u16(r);
    float lo = read_float(r), hi = read_float(r);
    uint32_t width = f->desc.width_px, height = f->desc.height_px;
    size_t count;
    f->has_depth = how >= 48u || (f->desc.flags & OF_PIXELS);
    f->depth.row_stride = width + (how & 3u);
    if (how < 2u && width > 1u) {
        f->depth.row_stride = width - 1u; /* too short */
    }
    if (!f->has_depth || (uint64_t)f->depth.row_stride * height > PIXELS_MAX) {
        f->has_depth = false;
        return;
    }
    count = f->depth.row_stride * (height - 1u) + width;
    f->texels = malloc(count * sizeof *f->texels);
    for (size_t i = 0; i < count; ++i) {
        uint32_t h = hdrp_hash2((uint32_t)i, seed);
        f->texels[i] = lo + (hi - lo) * hdrp_unit_from_u32(h);
        if ((how & 4u) && h % 64u == 0u) {
            f->texels[i] = read_float(r);
        }
    }
    f->depth.texels = f->texels;
    if (how & 8u) {
        float near_m = (how & 16u) ? read_float(r) : f->camera.eye_near.w;
        float far_m = (how & 16u) ? read_float(r) : f->camera.right_far.w;
        f->device = f->camera.forward_orthographic.w > 0.0f
                        ? hdrp_depth_params_orthographic(near_m, far_m, how >> 5 & 1u)
                        : hdrp_depth_params_perspective(near_m, far_m, how >> 5 & 1u);
        f->depth.device = &f->device;
    }
}

/* ---- a frame --------------------------------------------------------------------------------- */

void* block_of(size_t bytes, int fill)
{
    void* p = malloc(bytes > 0u ? bytes : 1u);
    CHECK(p && (uintptr_t)p % HDRP_MEMORY_ALIGNMENT == 0u);
    memset(p, fill, bytes);
    return p;
}

typedef struct result {
    hdrp_result code;
    hdrp_cull_set set;
    hdrp_cull_lists lists;
    void *set_memory, *memory, *scratch;
} result;

typedef enum stage { PROJECT, MEASURE, BUILD } stage;

static hdrp_result run_range(const frame* f, result* out, stage what, uint32_t first,
                             uint32_t count)
{
    const hdrp_cull_depth* depth = f->has_depth ? &f->depth : NULL;
    if (what == PROJECT) {
        return hdrp_cull_set_project(&out->set, f->shapes, first, count);
    }
    if (what == MEASURE) {
        return depth ? hdrp_cull_measure_depth(&out->lists, depth, first, count) : HDRP_OK;
    }
    return hdrp_cull_build(&out->lists, &out->set, depth, first, count, out->scratch,
                           hdrp_cull_scratch_size(&f->desc));
}

/* All of a stage: in one call, or in ranges, the later ones first. */
static hdrp_result run_stage(const frame* f, result* out, stage what, uint32_t seed)
{
    uint32_t rows = what == MEASURE ? out->lists.grid.tiles.w : hdrp_cull_rows(&out->lists);
    uint32_t end = what == PROJECT ? f->count : rows;
    hdrp_result code = HDRP_OK;
    if (seed == 0u) {
        return run_range(f, out, what, 0u, end);
    }
    while (end > 0u && code == HDRP_OK) {
        uint32_t count = 1u + hdrp_hash2(seed, end) % (seed % 5u + 1u);
        count = count < end ? count : end;
        end -= count;
        code = run_range(f, out, what, end, count);
    }
    return code;
}

/* seed 0: nothing is split. */
static void run_frame(const frame* f, result* out, uint32_t seed, int fill)
{
    size_t set_bytes = hdrp_cull_set_memory_size(f->set_capacity);
    size_t bytes = hdrp_cull_memory_size(&f->desc);
    size_t scratch_bytes = hdrp_cull_scratch_size(&f->desc);
    memset(out, fill, sizeof *out);
    out->scratch = block_of(scratch_bytes < BYTES_MAX ? scratch_bytes : 1u, fill);
    out->set_memory = block_of(set_bytes, fill);
    out->memory = block_of(bytes < BYTES_MAX ? bytes : 1u, fill);
    out->code = hdrp_cull_init(&out->lists, &f->desc, out->memory, bytes < BYTES_MAX ? bytes : 1u);
    CHECK((bytes > 0u && bytes < BYTES_MAX) == (out->code == HDRP_OK));
    if (out->code == HDRP_OK) {
        out->code = hdrp_cull_set_init(&out->set, f->set_capacity, out->set_memory, set_bytes);
    }
    if (out->code == HDRP_OK) {
        out->code = hdrp_cull_set_begin(&out->set, &f->camera, f->desc.width_px, f->desc.height_px,
                                        f->count);
        CHECK((f->count <= f->set_capacity) == (out->code == HDRP_OK));
    }
    if (out->code == HDRP_OK) {
        out->code = run_stage(f, out, PROJECT, seed);
        CHECK(out->code == HDRP_OK);
        out->code = hdrp_cull_begin(&out->lists, &out->set);
        CHECK(out->code == HDRP_OK);
        out->code = run_stage(f, out, MEASURE, seed);
    }
    if (out->code == HDRP_OK) {
        out->code = run_stage(f, out, BUILD, seed);
    }
}

static void free_result(result* r)
{
    free(r->set_memory);
    free(r->memory);
    free(r->scratch);
}

/* ---- checks ---------------------------------------------------------------------------------- */

static uint32_t check_cell(const frame* f, const hdrp_cull_lists* lists, size_t c, uint32_t tile)
{
    hdrp_u32x4 cell = lists->cells[c];
    uint32_t all = lists->desc.flags & HDRP_CULL_BLOCKS ? 0u : 0xffffu, category, i;
    CHECK(cell.x >= tile * lists->desc.entry_capacity);
    CHECK(hdrp_cull_last(cell, HDRP_CULL_CATEGORY_DECAL) <=
          (tile + 1u) * lists->desc.entry_capacity);
    CHECK(cell.w == lists->tile_dropped[tile]);
    for (category = 0u; category < HDRP_CULL_CATEGORY_COUNT; ++category) {
        uint32_t first = hdrp_cull_first(cell, category), last = hdrp_cull_last(cell, category);
        for (i = first; i < last; ++i) {
            uint32_t index = hdrp_cull_entry_index(lists->entries[i]);
            CHECK(index < f->count);
            CHECK(hdrp_cull_shape_category(f->shapes[index]) == category);
            CHECK(hdrp_cull_shape_kind(f->shapes[index]) != HDRP_CULL_KIND_NONE);
            CHECK(i == first || index > hdrp_cull_entry_index(lists->entries[i - 1u]));
            CHECK(all ? lists->entries[i] >> 16 == all : lists->entries[i] >> 16 != 0u);
        }
    }
    return hdrp_cull_last(cell, HDRP_CULL_CATEGORY_DECAL) - cell.x;
}

/* Pixels of an entry are in its blocks, and there is at least one. */
static void check_pixels(const hdrp_cull_lists* lists, uint32_t tile)
{
    hdrp_u32x4 size = lists->grid.tiles, cell = lists->cells[tile];
    uint32_t x0 = tile % size.z * size.x, y0 = tile / size.z * size.y;
    for (uint32_t i = cell.x; i < hdrp_cull_last(cell, HDRP_CULL_CATEGORY_DECAL); ++i) {
        uint32_t reached = 0u;
        for (uint32_t y = y0; y < y0 + size.y && y < lists->desc.height_px; ++y) {
            for (uint32_t x = x0; x < x0 + size.x && x < lists->desc.width_px; ++x) {
                uint32_t word = lists->masks[hdrp_cull_mask_word(lists->grid, i, x, y)];
                if (word >> hdrp_cull_mask_bit(lists->grid, x, y) & 1u) {
                    CHECK(hdrp_cull_entry_covers(lists->grid, lists->entries[i], x, y));
                    ++reached;
                }
            }
        }
        CHECK(reached > 0u);
    }
}

static void check_lists(const frame* f, const hdrp_cull_lists* lists)
{
    size_t tiles = (size_t)lists->grid.tiles.z * lists->grid.tiles.w, t, c;
    uint32_t slices = lists->desc.slice_count;
    uint64_t entries = 0u, dropped = 0u;
    hdrp_cull_stats stats;
    for (t = 0; t < tiles; ++t) {
        uint32_t of_tile = 0u;
        for (c = t * slices; c < (t + 1u) * slices; ++c) {
            of_tile += check_cell(f, lists, c, (uint32_t)t);
        }
        CHECK(of_tile <= lists->desc.entry_capacity);
        if (lists->masks) {
            check_pixels(lists, (uint32_t)t);
        }
        CHECK(lists->tile_dropped[t] <= f->count);
        entries += of_tile;
        dropped += lists->tile_dropped[t];
    }
    CHECK(hdrp_cull_count(lists, &stats) == HDRP_OK);
    CHECK(stats.entries == entries && stats.dropped == dropped);
}

static void check_masks(const frame* f, const hdrp_cull_lists* lists)
{
    uint32_t tiles = lists->grid.tiles.z * lists->grid.tiles.w, stride = (f->count + 31u) / 32u;
    uint32_t first = f->split_seed % (tiles + 1u), i;
    size_t cells = (size_t)(tiles - first) * lists->desc.slice_count, c;
    uint32_t* words = block_of(cells * stride * sizeof *words, 0x33);
    CHECK(hdrp_cull_masks(lists, first, tiles - first, words, stride) == HDRP_OK);
    for (c = 0; c < cells && stride > 0u; ++c) {
        hdrp_u32x4 cell = lists->cells[(size_t)first * lists->desc.slice_count + c];
        uint32_t bits = 0u, k;
        for (k = 0u; k < stride; ++k) {
            bits += (uint32_t)__builtin_popcount(words[c * stride + k]);
        }
        for (i = hdrp_cull_first(cell, 0u); i < hdrp_cull_last(cell, 3u); ++i) {
            uint32_t index = hdrp_cull_entry_index(lists->entries[i]);
            CHECK(words[c * stride + index / 32u] >> index % 32u & 1u);
        }
        CHECK(bits == hdrp_cull_last(cell, 3u) - hdrp_cull_first(cell, 0u));
    }
    free(words);
}

/* Two runs of a frame made the same lists. */
static void check_same(const hdrp_cull_lists* a, const hdrp_cull_lists* b)
{
    size_t tiles = (size_t)a->grid.tiles.z * a->grid.tiles.w, c;
    CHECK(!memcmp(a->tiles, b->tiles, tiles * sizeof *a->tiles));
    CHECK(!memcmp(a->tile_dropped, b->tile_dropped, tiles * sizeof *a->tile_dropped));
    CHECK(!memcmp(a->cells, b->cells, tiles * a->desc.slice_count * sizeof *a->cells));
    for (c = 0; c < tiles * a->desc.slice_count; ++c) {
        uint32_t first = a->cells[c].x, last = hdrp_cull_last(a->cells[c], 3u);
        CHECK(!memcmp(a->entries + first, b->entries + first, (last - first) * sizeof *a->entries));
        if (a->masks) {
            uint32_t words = hdrp_cull_mask_words(a->grid);
            CHECK(!memcmp(a->masks + first * words, b->masks + first * words,
                          (last - first) * words * sizeof *a->masks));
        }
    }
}

/* Whether a shape is in the list of a place, or was dropped by its tile. */
static bool is_listed(const hdrp_cull_lists* lists, uint32_t shape, uint32_t x, uint32_t y, float z)
{
    uint32_t tile = hdrp_cull_tile_of_pixel(lists->grid, x, y), i;
    uint32_t slice = hdrp_cull_slice(lists->grid, lists->tiles[tile].z, z);
    hdrp_u32x4 cell = lists->cells[hdrp_cull_cell(lists->grid, tile, slice)];
    for (i = hdrp_cull_first(cell, 0u); i < hdrp_cull_last(cell, 3u); ++i) {
        uint32_t word = ~0u;
        if (lists->masks) {
            word = lists->masks[hdrp_cull_mask_word(lists->grid, i, x, y)] >>
                   hdrp_cull_mask_bit(lists->grid, x, y);
        }
        if (hdrp_cull_entry_index(lists->entries[i]) == shape && (word & 1u) != 0u &&
            hdrp_cull_entry_covers(lists->grid, lists->entries[i], x, y)) {
            return true;
        }
    }
    return cell.w > 0u;
}

/* A depth that the lists are good for; NaN where there is none. */
static float depth_of_place(const frame* f, uint32_t seed, uint32_t x, uint32_t y)
{
    float near_m = f->camera.eye_near.w, far_m = hdrp_min(f->camera.right_far.w, 1e6f * near_m);
    float z = near_m + (far_m - near_m) * hdrp_sq(hdrp_sq(hdrp_unit_from_u32(seed)));
    bool tiles = f->desc.slice_count == 1u;
    if (f->has_depth && (tiles || (seed & 1u))) {
        z = f->texels[y * f->depth.row_stride + x];
        z = f->depth.device ? hdrp_view_depth(f->device, z) : z;
    }
    return z >= near_m && z < f->camera.right_far.w * (1.0f - 2e-6f)
               ? z
               : hdrp_f32_from_bits(0x7fc00000u);
}

/* Shapes are listed where a place is well inside of them. */
static void check_places(const frame* f, const hdrp_cull_lists* lists)
{
    for (uint32_t n = 0u; n < 16u; ++n) {
        uint32_t h = hdrp_hash2(n, f->split_seed);
        uint32_t x = h % f->desc.width_px, y = (h >> 14) % f->desc.height_px;
        float z = depth_of_place(f, hdrp_hash1(h), x, y);
        ref_v3 p = ref_position_of_pixel(&f->camera, x + 0.5L, y + 0.5L, f->desc.width_px,
                                         f->desc.height_px, z);
        for (uint32_t i = 0u; i < f->count && z == z; ++i) {
            const ref_body* b = &f->bodies[i];
            ref_real size = fabsl(b->center.x) + fabsl(b->center.y) + fabsl(b->center.z) +
                            b->half.x + b->half.y + b->half.z + b->range + fabsl(p.x) + fabsl(p.y) +
                            fabsl(p.z);
            if (ref_contains(b, p, -1e-5L * size)) {
                CHECK(is_listed(lists, i, x, y, z));
            }
        }
    }
}

/* ---- what an input stands for ---------------------------------------------------------------- */

static void print_v4(const char* what, hdrp_v4 v)
{
    printf("    %s %a %a %a %a\n", what, (double)v.x, (double)v.y, (double)v.z, (double)v.w);
}

static void print_frame(const frame* f)
{
    const hdrp_cull_desc* d = &f->desc;
    printf("desc %" PRIu32 "x%" PRIu32 " tiles %" PRIu32 "x%" PRIu32 "x%" PRIu32 " shapes %" PRIu32
           " entries %" PRIu32 " flags %" PRIu32 " series %a %a\n",
           d->width_px, d->height_px, d->tile_width_px, d->tile_height_px, d->slice_count,
           d->shape_capacity, d->entry_capacity, d->flags, (double)d->series_start_m,
           (double)d->series_end_m);
    printf("camera\n");
    print_v4("eye_near", f->camera.eye_near);
    print_v4("right_far", f->camera.right_far);
    print_v4("up", f->camera.up);
    print_v4("forward_orthographic", f->camera.forward_orthographic);
    print_v4("window", f->camera.window);
    printf("depth %d stride %zu device %d, set of %" PRIu32 " in %" PRIu32 ", split %" PRIu32 "\n",
           f->has_depth, f->depth.row_stride, f->depth.device != NULL, f->count, f->set_capacity,
           f->split_seed);
    for (uint32_t i = 0u; i < f->count && i < SHAPES_MAX; ++i) {
        const hdrp_cull_shape* s = &f->shapes[i];
        printf("shape %" PRIu32 ": kind %" PRIu32 " category %" PRIu32 " importance %08" PRIx32
               "\n",
               i, hdrp_cull_shape_kind(*s), hdrp_cull_shape_category(*s), s->bits.w);
        print_v4("center_range", s->center_range);
        print_v4("right_half", s->right_half);
        print_v4("up_half", s->up_half);
        print_v4("forward_half", s->forward_half);
        print_v4("half_angle", s->half_angle);
    }
    fflush(stdout);
}

/* ---- entry ----------------------------------------------------------------------------------- */

/* Whether an input takes milliseconds only. Descriptors that are not valid cost nothing. */
static bool is_cheap(const hdrp_cull_desc* d)
{
    uint32_t tile_width = d->tile_width_px ? d->tile_width_px : 32u;
    uint32_t tile_height = d->tile_height_px ? d->tile_height_px : 32u;
    uint64_t tiles = ((uint64_t)d->width_px + tile_width - 1u) / tile_width *
                     (((uint64_t)d->height_px + tile_height - 1u) / tile_height);
    uint32_t slices = d->slice_count ? d->slice_count : 64u;
    uint64_t scratch = hdrp_cull_scratch_size(d);
    return hdrp_cull_memory_size(d) == 0u || hdrp_cull_memory_size(d) >= BYTES_MAX ||
           (tiles * slices <= CELLS_MAX && scratch < BYTES_MAX);
}

static void read_frame(reader* r, frame* f)
{
    f->desc = read_desc(r);
    f->camera = read_camera(r);
    f->split_seed = 1u + read_u8(r);
    f->count = read_below(r, SHAPES_MAX + 1u);
    f->set_capacity = read_u8(r) < 8u ? read_u8(r) : SHAPES_MAX;
    for (uint32_t i = 0u; i < f->count; ++i) {
        f->shapes[i] = read_shape(r, &f->camera, &f->bodies[i], &f->places[i]);
    }
    if (hdrp_cull_memory_size(&f->desc) > 0u) {
        read_depth(r, f);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    reader r = {data, size, 0u, 0u};
    frame f;
    result whole, split;
    memset(&f, 0, sizeof f);
    read_frame(&r, &f);
    if (getenv("FUZZ_CULL_PRINT")) {
        print_frame(&f);
    }
    if (is_cheap(&f.desc)) {
        run_frame(&f, &whole, 0u, 0x00);
        run_frame(&f, &split, f.split_seed, 0xa5);
        CHECK(whole.code == split.code);
        if (whole.code == HDRP_OK) {
            check_lists(&f, &whole.lists);
            check_masks(&f, &whole.lists);
            check_places(&f, &whole.lists);
            check_same(&whole.lists, &split.lists);
            fuzz_variants(&r, &whole.lists, &whole.set);
            fuzz_blockers(&r, &whole.lists, f.places, f.count);
        }
        free_result(&whole);
        free_result(&split);
    }
    free(f.texels);
    return 0;
}
