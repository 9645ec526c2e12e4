/* Blended surfaces without sorting, in a mode of hdrp_oit.h. What transmits light keeps its order and
 * comes first, over what is opaque; all that is blended comes before it, as engines draw it.
 *
 * Passes of range and absorption see all fragments at either resolution, the last one those that
 * are lit at it. All of them are one walk over a row: a pixel needs no other one. */
#include "layers.h"

/* >>which surfaces */

static bool has_passes_of_absorption(const rd_sub_frame* s)
{
    return hdrp_oit_pass_count(s->r->oit.full.desc.mode) > 1u;
}

static rd_layer_use light_blended(const rd_sub_frame* s, const rd_material* m, bool low)
{
    return rd_oit_is_low(s->r->options, m) == low ? RD_LAYER_LIT
           : has_passes_of_absorption(s)          ? RD_LAYER_UNLIT
                                                  : RD_LAYER_IGNORED;
}

static rd_layer_use light_full(const rd_sub_frame* s, const rd_material* m)
{
    return rd_oit_is_blended(s->r->options, m) ? light_blended(s, m, false) : RD_LAYER_LIT;
}

static rd_layer_use light_low(const rd_sub_frame* s, const rd_material* m)
{
    return rd_oit_is_blended(s->r->options, m) ? light_blended(s, m, true) : RD_LAYER_IGNORED;
}

/* >>blending */

/* What a surface emits in proportion to its alpha is hidden like the rest of its colour, and a part
 * of that. A colour without alpha is emission: that of what only adds light. */
static void blend_layer(const rd_sub_frame* s, hdrp_oit_image* image, uint32_t pass,
                        const rd_layer* l, int y)
{
    hdrp_v3 light = hdrp_v3_scale(l->light, s->r->oit.unit);
    hdrp_oit_fragment f =
        hdrp_oit_fragment_make(light, hdrp_v3_splat(0.0f), l->coverage, l->z_view);
    uint32_t row = (uint32_t)y;
    uint32_t pixel = row * image->desc.width_px + (uint32_t)l->x;
    hdrp_oit_blend_rows(image, pass, &f, &pixel, 1, row, row + 1u);
}

static void blend_row(const rd_sub_frame* s, const rd_worker* w, hdrp_oit_image* image, int y)
{
    uint32_t passes = hdrp_oit_pass_count(image->desc.mode);
    hdrp_oit_clear_rows(image, (uint32_t)y, (uint32_t)y + 1u);
    for (uint32_t pass = 0; pass < passes; ++pass) {
        for (uint32_t i = 0; i < w->list->count; ++i) {
            const rd_layer* l = &w->list->items[i];
            if (rd_oit_is_blended(s->r->options, l->material) &&
                (l->is_lit || pass + 1u < passes)) {
                blend_layer(s, image, pass, l, y);
            }
        }
    }
}

void rd_oit_low_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    rd_oit_images* o = &s->r->oit;
    const hdrp_oit_desc* low = &o->low.desc;
    const rd_layer_grid grid = {(int)low->width_px, (float)s->r->width / (float)low->width_px,
                                (float)s->r->height / (float)low->height_px, light_low};
    if (rd_layers_gather(s, w, &grid, y)) {
        blend_row(s, w, &o->low, y);
    } else {
        hdrp_oit_clear_rows(&o->low, (uint32_t)y, (uint32_t)y + 1u);
    }
}

/* >>the picture */

/* What is behind the blended surfaces: the opaque picture, and what transmits it. */
static void fill_behind(const rd_sub_frame* s, const rd_worker* w, int y)
{
    uint32_t at = 0;
    for (int x = 0; x < s->r->width; ++x) {
        size_t px = rd_pixel(s, x, y);
        uint32_t first = at;
        rd_layers_seen seen;
        while (at < w->list->count && w->list->items[at].x == x) {
            ++at;
        }
        seen =
            rd_layers_over(s, w->list->items + first, at - first, RD_LAYERS_WITHOUT_BLENDED, x, y);
        s->r->oit.color[px] = hdrp_v3_scale(seen.color, s->r->oit.unit);
        s->r->oit.uncovered[px] = seen.uncovered;
    }
}

void rd_oit_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    const rd_layer_grid grid = {s->r->width, 1.0f, 1.0f, light_full};
    rd_oit_images* o = &s->r->oit;
    uint32_t row = (uint32_t)y;
    if (!rd_layers_gather(s, w, &grid, y)) {
        rd_resolve_row(s, w, y);
        return;
    }
    blend_row(s, w, &o->full, y);
    if (o->has_low) {
        hdrp_oit_merge_rows(&o->full, &o->low, row, row + 1u);
    }
    fill_behind(s, w, y);
    hdrp_oit_composite_rows(&o->full, o->color, o->color, row, row + 1u);
    for (int x = 0; x < s->r->width; ++x) {
        size_t px = rd_pixel(s, x, y);
        rd_layers_seen seen = {hdrp_v3_scale(o->color[px], 1.0f / o->unit),
                               o->uncovered[px] * rd_oit_revealage(&o->full, px)};
        rd_layers_resolve(s, seen, x, y);
    }
}
