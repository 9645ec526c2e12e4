#define HDRP_OIT_IMPLEMENTATION
#include "oit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

hdrp_oit_mode rd_oit_mode(rd_oit oit)
{
    switch (oit) {
    case RD_OIT_MCGUIRE:
        return HDRP_OIT_MODE_EQ7;
    case RD_OIT_VOLITION:
        return HDRP_OIT_MODE_TALK;
    case RD_OIT_FRONT:
        return HDRP_OIT_MODE_FRONT;
    case RD_OIT_MOMENTS:
        return HDRP_OIT_MODE_MOMENTS_6;
    case RD_OIT_WAVELET:
        return HDRP_OIT_MODE_WAVELET;
    default:
        return HDRP_OIT_MODE_RECOMMENDED;
    }
}

float rd_oit_unit(float exposure)
{
    return ldexpf(1.0f, (int)floorf(log2f(exposure) + 0.5f));
}

bool rd_oit_is_blended(const rd_options* o, const rd_material* m)
{
    bool transmits = m->transmission > 0.0f && (o->features & RD_FEATURE_REFRACTION) != 0u;
    return m->alpha_mode == RD_ALPHA_BLEND && !transmits;
}

bool rd_oit_is_low(const rd_options* o, const rd_material* m)
{
    return o->oit != RD_OIT_SORTED && (o->features & RD_FEATURE_HALF_RESOLUTION) != 0u &&
           m->half_resolution && rd_oit_is_blended(o, m);
}

bool rd_oit_has_low(const rd_options* o, const rd_scene* scene)
{
    bool any = false;
    for (int i = 0; i < scene->material_count; ++i) {
        any = any || rd_oit_is_low(o, &scene->materials[i]);
    }
    return any;
}

static bool make_image(hdrp_oit_image* image, void** memory, const hdrp_oit_desc* desc)
{
    size_t bytes = hdrp_oit_memory_size(desc);
    *memory = bytes ? malloc(bytes) : NULL;
    return *memory && hdrp_oit_image_init(image, desc, *memory, bytes) == HDRP_OK;
}

bool rd_oit_begin(rd_oit_images* o, const rd_oit_desc* d)
{
    size_t pixels = (size_t)d->width * (size_t)d->height;
    hdrp_oit_desc desc;
    memset(o, 0, sizeof *o);
    memset(&desc, 0, sizeof desc);
    desc.width_px = (uint32_t)d->width;
    desc.height_px = (uint32_t)d->height;
    desc.mode = rd_oit_mode(d->oit);
    o->unit = rd_oit_unit(d->exposure);
    desc.exposure = d->exposure / o->unit;
    o->color = (hdrp_v3*)malloc(pixels * sizeof *o->color);
    o->uncovered = (float*)malloc(pixels * sizeof *o->uncovered);
    o->has_low = d->has_low;
    o->present = o->color && o->uncovered && make_image(&o->full, &o->memory[0], &desc);
    desc.width_px = (desc.width_px + 1u) / 2u;
    desc.height_px = (desc.height_px + 1u) / 2u;
    return o->present && (!o->has_low || make_image(&o->low, &o->memory[1], &desc));
}

void rd_oit_end(rd_oit_images* o)
{
    free(o->memory[0]);
    free(o->memory[1]);
    free(o->color);
    free(o->uncovered);
    memset(o, 0, sizeof *o);
}

float rd_oit_revealage(const hdrp_oit_image* image, size_t px)
{
    size_t plane = (size_t)image->desc.width_px * image->desc.height_px;
    hdrp_v4 last = image->texels[(image->target_count - 1u) * plane + px];
    if (image->desc.mode == HDRP_OIT_MODE_TALK) {
        return hdrp_saturate(last.x);
    }
    if (image->desc.mode == HDRP_OIT_MODE_FRONT) {
        return hdrp_saturate(last.w) * (1.0f - hdrp_saturate(image->texels[plane + px].w));
    }
    return hdrp_saturate(last.w);
}
