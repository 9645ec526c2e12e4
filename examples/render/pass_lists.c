/* Pictures of lists: how many lights they hold, what for, and which variant a tile would run. */
#include "frame.h"

/* >>colours */

/* Of counts, in steps of factors of two; in between they blend. */
static const struct {
    uint32_t count;
    hdrp_v3 color;
} heat[] = {
    {0u, {0.03f, 0.03f, 0.04f}},  {1u, {0.05f, 0.08f, 0.40f}},  {2u, {0.02f, 0.25f, 0.75f}},
    {4u, {0.00f, 0.55f, 0.60f}},  {8u, {0.06f, 0.60f, 0.12f}},  {16u, {0.80f, 0.75f, 0.04f}},
    {32u, {0.95f, 0.33f, 0.02f}}, {64u, {0.75f, 0.03f, 0.10f}},
};
#define HEAT_COUNT (sizeof heat / sizeof heat[0])

static const hdrp_v3 palette[RD_VARIANT_LIMIT] = {
    {0.25f, 0.45f, 0.80f}, {0.20f, 0.65f, 0.30f}, {0.85f, 0.75f, 0.15f}, {0.85f, 0.40f, 0.10f},
    {0.75f, 0.10f, 0.15f}, {0.65f, 0.20f, 0.70f}, {0.10f, 0.60f, 0.65f}, {0.75f, 0.75f, 0.75f}};

static hdrp_v3 heat_color(uint32_t n)
{
    size_t i = 1;
    float low, high;
    while (i + 1 < HEAT_COUNT && heat[i].count < n) {
        ++i;
    }
    low = (float)heat[i - 1].count;
    high = (float)heat[i].count;
    return hdrp_v3_lerp(heat[i - 1].color, heat[i].color,
                        hdrp_saturate(((float)n - low) / (high - low)));
}

/* >>legend: a row of boxes with their numbers, in the lower left corner */

#define BOX_WIDTH  12
#define BOX_HEIGHT 9

static bool is_ink(uint32_t number, int x, int y)
{
    /* Three by five dots, row by row. */
    static const uint16_t digits[10] = {0x7b6f, 0x2c97, 0x73e7, 0x73cf, 0x5bc9,
                                        0x79cf, 0x79ef, 0x7249, 0x7bef, 0x7bcf};
    uint32_t digit = number < 10u || x >= 4 ? number % 10u : number / 10u;
    int column = x % 4;
    if (x < 0 || x >= (number < 10u ? 3 : 7) || y < 0 || y >= 5 || column == 3) {
        return false;
    }
    return (digits[digit] >> (14 - (y * 3 + column))) & 1;
}

static bool legend(const rd_sub_frame* s, int x, int y, hdrp_v3* out)
{
    bool variants = s->r->options->view == RD_VIEW_VARIANTS;
    int boxes = variants ? (int)s->r->variants.choice.variant_count : (int)HEAT_COUNT;
    int dot = s->r->width / 480 > 1 ? s->r->width / 480 : 1;
    int column = x / dot, row = BOX_HEIGHT - 1 - (s->r->height - 1 - y) / dot;
    int box = column / BOX_WIDTH;
    if (row < 0 || box >= boxes) {
        return false;
    }
    *out = variants ? palette[box] : heat[box].color;
    if (is_ink(variants ? (uint32_t)box : heat[box].count, column % BOX_WIDTH - 2, row - 2)) {
        *out = hdrp_v3_splat(hdrp_luminance(*out) < 0.2f ? 1.0f : 0.0f);
    }
    return true;
}

/* >>counts */

/* Lights whose entries cover the pixel. */
static uint32_t visited(const rd_sub_frame* s, const rd_shade_point* p)
{
    const hdrp_cull_lists* lists = &s->r->lists.tiles.lists;
    uint32_t n = 0u;
    for (uint32_t e = p->first_entry; e < p->last_entry; ++e) {
        n += hdrp_cull_entry_covers(lists->grid, lists->entries[e], p->x, p->y);
    }
    return n;
}

static uint32_t in_range(const rd_sub_frame* s, const rd_shade_point* p)
{
    const hdrp_cull_lists* lists = &s->r->lists.tiles.lists;
    uint32_t n = 0u;
    for (uint32_t e = p->first_entry; e < p->last_entry; ++e) {
        uint32_t light = hdrp_cull_entry_index(lists->entries[e]);
        hdrp_light_incident in = hdrp_light_eval(s->r->lighting->lights.items[light], p->position);
        n += hdrp_v3_max_component(in.illuminance) > 0.0f;
    }
    return n;
}

/* Blockers that the pixel has to test. */
static uint32_t blockers(const rd_sub_frame* s, const rd_shade_point* p)
{
    const hdrp_cull_lists* lists = &s->r->lists.tiles.lists;
    uint32_t n = 0u;
    for (uint32_t e = p->first_entry; s->r->lists.tiles.masks && e < p->last_entry; ++e) {
        uint32_t mask = s->r->lists.tiles.masks[e];
        for (; hdrp_cull_entry_covers(lists->grid, lists->entries[e], p->x, p->y) && mask != 0u;
             mask &= mask - 1u) {
            ++n;
        }
    }
    return n;
}

static hdrp_v3 value(const rd_sub_frame* s, int x, int y)
{
    rd_shade_point p;
    uint8_t variant;
    p.position = s->r->gbuffer.positions[rd_pixel(s, x, y)];
    rd_lists_find_tile(&s->r->lists, x, y, &p);
    switch (s->r->options->view) {
    case RD_VIEW_TILES:
        return heat_color(p.last_entry - p.first_entry);
    case RD_VIEW_CLUSTERS:
        rd_lists_find_cluster(&s->r->lists, x, y, &p);
        return heat_color(p.last_entry - p.first_entry);
    case RD_VIEW_LIGHT_WASTE:
        return heat_color(visited(s, &p) - in_range(s, &p));
    case RD_VIEW_BLOCKERS:
        return heat_color(blockers(s, &p));
    default:
        variant = s->r->variants.ready
                      ? s->r->variants.tiles[hdrp_cull_tile_of_pixel(s->r->lists.tiles.lists.grid,
                                                                     (hdrp_u32)x, (hdrp_u32)y)]
                      : HDRP_CULL_VARIANT_EMPTY;
        return variant < RD_VARIANT_LIMIT ? palette[variant] : heat[0].color;
    }
}

/* A little of the shape of things. */
static float relief(const rd_sub_frame* s, int x, int y)
{
    rd_ray ray = rd_pixel_ray(s, x, y);
    hdrp_v3 n = s->r->gbuffer.geometric_normals[rd_pixel(s, x, y)];
    return 0.5f + 0.5f * hdrp_abs(hdrp_v3_dot(n, ray.direction));
}

void rd_lists_view_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    (void)w;
    for (int x = 0; x < s->r->width; ++x) {
        float* film = s->r->film + rd_pixel(s, x, y) * 4;
        hdrp_v3 v = hdrp_v3_splat(0.0f);
        bool covered = legend(s, x, y, &v);
        if (!covered && s->r->lists.ready &&
            s->r->gbuffer.kinds[rd_pixel(s, x, y)] != RD_PIXEL_SKY) {
            v = hdrp_v3_scale(value(s, x, y), relief(s, x, y));
            covered = true;
        }
        film[0] += v.x;
        film[1] += v.y;
        film[2] += v.z;
        film[3] += covered ? 1.0f : 0.0f;
    }
}
