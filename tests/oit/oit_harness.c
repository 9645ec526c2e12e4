/* oit_harness.c - see oit_harness.h.
 * SPDX-License-Identifier: MIT */
#define HDRP_OIT_IMPLEMENTATION
#include "oit_harness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const oit_case oit_cases[] = {
    {"low", 0.05, 0.3, 1, 200, 12, 0, 0, 0, 0, 1, 0, 0},
    {"mixed", 0.05, 0.95, 1, 200, 12, 0, 0, 0, 0, 1, 0, 0},
    {"high", 0.8, 0.99, 1, 200, 12, 0, 0, 0, 0, 1, 0, 0},
    {"low_1_10", 0.05, 0.3, 1, 10, 12, 0, 0, 0, 0, 1, 0, 0},
    {"mixed_1_10", 0.05, 0.95, 1, 10, 12, 0, 0, 0, 0, 1, 0, 0},
    {"high_1_10", 0.8, 0.99, 1, 10, 12, 0, 0, 0, 0, 1, 0, 0},
    {"low_0.1_1000", 0.05, 0.3, 0.1, 1000, 12, 0, 0, 0, 0, 1, 0, 0},
    {"mixed_0.1_1000", 0.05, 0.95, 0.1, 1000, 12, 0, 0, 0, 0, 1, 0, 0},
    {"high_0.1_1000", 0.8, 0.99, 0.1, 1000, 12, 0, 0, 0, 0, 1, 0, 0},
    {"low_32", 0.05, 0.3, 1, 200, 32, 0, 0, 0, 0, 1, 0, 0},
    {"mixed_32", 0.05, 0.95, 1, 200, 32, 0, 0, 0, 0, 1, 0, 0},
    {"high_32", 0.8, 0.99, 1, 200, 32, 0, 0, 0, 0, 1, 0, 0},
    {"additive", 0.05, 0.95, 1, 200, 12, 1, 0, 0, 0, 1, 0, 0},
    {"half_emissive", 0.05, 0.95, 1, 200, 12, 0.5, 0, 0, 0, 1, 0, 0},
    {"half_emissive_bright", 0.05, 0.95, 1, 200, 12, 0.5, 0, 0, 0, 4, 0, 0},
    {"front_99", 0.05, 0.95, 1, 200, 12, 0, 0, 0.99, 0, 1, 0, 0},
    {"stops_-10", 0.05, 0.95, 1, 200, 12, 0, -10, 0, 0, 1, 0, 0},
    {"stops_-5", 0.05, 0.95, 1, 200, 12, 0, -5, 0, 0, 1, 0, 0},
    {"stops_5", 0.05, 0.95, 1, 200, 12, 0, 5, 0, 0, 1, 0, 0},
    {"stops_10", 0.05, 0.95, 1, 200, 12, 0, 10, 0, 0, 1, 0, 0},
    {"stops_-10_scaled", 0.05, 0.95, 1, 200, 12, 0, -10, 0, 10, 1, 0, 0},
    {"shining_low", 0.01, 0.3, 1, 200, 12, 0, 0, 0, 0, 1, 0.5, 0},
    {"shining", 0.05, 0.95, 1, 200, 12, 0, 0, 0, 0, 1, 0.5, 0},
    {"shining_high", 0.8, 0.99, 1, 200, 12, 0, 0, 0, 0, 1, 0.5, 0},
    {"pane", 0.05, 0.95, 50, 60, 12, 0, 0, 0, 0, 1, 0, 1},
};
const size_t oit_case_count = sizeof oit_cases / sizeof *oit_cases;

const char* oit_mode_name(hdrp_oit_mode mode)
{
    static const char* const names[HDRP_OIT_MODE_COUNT] = {
        "recommended", "front", "wavelet", "moments_6", "moments_4",   "eq7",
        "eq8",         "eq9",   "eq10",    "2015",      "talk_weight", "talk"};
    return names[mode];
}

/* SplitMix64 (Steele, Lea and Flood 2014). */
static double uniform(uint64_t* state, double lo, double hi)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return lo + (hi - lo) * ((double)(z >> 11) / 9007199254740992.0);
}

static hdrp_v3 color(uint64_t* state, double brightness)
{
    float r = (float)uniform(state, 0, brightness), g = (float)uniform(state, 0, brightness);
    return hdrp_v3_make(r, g, (float)uniform(state, 0, brightness));
}

static hdrp_oit_fragment layer(const oit_case* c, uint64_t* state, double brightness)
{
    double z = exp(uniform(state, log(c->nearest_m), log(c->farthest_m)));
    double alpha = uniform(state, c->alpha_low, c->alpha_high);
    hdrp_v3 rgb = color(state, brightness), black = hdrp_v3_splat(0.0f);
    if (uniform(state, 0, 1) < c->additive) {
        return hdrp_oit_fragment_make(black, hdrp_v3_scale(rgb, (float)(alpha * c->emission)), 0.0f,
                                      (float)z);
    }
    hdrp_v3 glow =
        c->shining > 0 && uniform(state, 0, 1) < c->shining ? color(state, brightness) : black;
    return hdrp_oit_fragment_make(hdrp_v3_scale(rgb, (float)alpha), glow, (float)alpha, (float)z);
}

static void over(double* rgb, const hdrp_oit_fragment* f)
{
    double through = 1.0 - (double)f->alpha;
    rgb[0] = rgb[0] * through + (double)f->premultiplied.x + (double)f->emission.x;
    rgb[1] = rgb[1] * through + (double)f->premultiplied.y + (double)f->emission.y;
    rgb[2] = rgb[2] * through + (double)f->premultiplied.z + (double)f->emission.z;
}

int oit_farther_first(const void* a, const void* b)
{
    float x = ((const hdrp_oit_fragment*)a)->z_view, y = ((const hdrp_oit_fragment*)b)->z_view;
    return x > y ? -1 : x < y;
}

static void sort_and_blend(const hdrp_oit_fragment* fragments, size_t count, hdrp_v3 behind,
                           double* rgb)
{
    hdrp_oit_fragment sorted[OIT_LAYERS_MAX];
    memcpy(sorted, fragments, count * sizeof *fragments);
    qsort(sorted, count, sizeof *sorted, oit_farther_first);
    rgb[0] = (double)behind.x;
    rgb[1] = (double)behind.y;
    rgb[2] = (double)behind.z;
    for (size_t i = 0; i < count; ++i) {
        over(rgb, &sorted[i]);
    }
}

static void set_front(hdrp_oit_fragment* fragments, size_t count, float alpha)
{
    size_t nearest = 0;
    for (size_t i = 1; i < count; ++i) {
        nearest = fragments[i].z_view < fragments[nearest].z_view ? i : nearest;
    }
    hdrp_oit_fragment* f = &fragments[nearest];
    f->premultiplied = hdrp_v3_scale(f->premultiplied, alpha / f->alpha);
    f->alpha = alpha;
}

void oit_generate(const oit_case* c, oit_pixels* p)
{
    uint64_t state = 1;
    for (const char* s = c->name; *s; ++s) {
        state = state * 31u + (unsigned char)*s;
    }
    p->brightness = exp2(c->stops);
    p->fragments = malloc(OIT_PIXELS * OIT_LAYERS_MAX * sizeof *p->fragments);
    p->pixels = malloc(OIT_PIXELS * OIT_LAYERS_MAX * sizeof *p->pixels);
    p->behind = malloc(OIT_PIXELS * sizeof *p->behind);
    p->exact = malloc(OIT_PIXELS * 3 * sizeof *p->exact);
    p->count = 0;
    for (uint32_t i = 0; i < OIT_PIXELS; ++i) {
        hdrp_oit_fragment* first = p->fragments + p->count;
        size_t layers = 2u + (size_t)uniform(&state, 0, (double)c->layers_max - 1.0);
        for (size_t k = 0; k < layers; ++k) {
            first[k] = layer(c, &state, p->brightness);
            p->pixels[p->count + k] = i;
        }
        if (c->pane_m > 0) {
            first->z_view = (float)c->pane_m;
        }
        if (c->front_alpha > 0) {
            set_front(first, layers, (float)c->front_alpha);
        }
        p->behind[i] = color(&state, p->brightness);
        sort_and_blend(first, layers, p->behind[i], p->exact + 3 * i);
        p->count += layers;
    }
}

void oit_free(oit_pixels* p)
{
    free(p->fragments);
    free(p->pixels);
    free(p->behind);
    free(p->exact);
}

static oit_error difference(const oit_pixels* p, const hdrp_v3* got)
{
    oit_error e = {0, 0};
    for (size_t i = 0; i < OIT_PIXELS; ++i) {
        const double rgb[3] = {(double)got[i].x, (double)got[i].y, (double)got[i].z};
        for (size_t k = 0; k < 3; ++k) {
            double d = fabs(rgb[k] - p->exact[3 * i + k]) / p->brightness;
            e.rms += d * d;
            e.largest = d <= e.largest ? e.largest : d;
        }
    }
    e.rms = sqrt(e.rms / (3.0 * OIT_PIXELS));
    return e;
}

oit_error oit_measure(const oit_case* c, const oit_pixels* p, hdrp_oit_mode mode,
                      hdrp_oit_precision precision)
{
    hdrp_oit_desc desc = {OIT_WIDTH, OIT_PIXELS / OIT_WIDTH, mode, precision, 0, 0, 0, 0, 0};
    desc.scale = (float)exp2(c->scale_stops);
    hdrp_oit_image image;
    size_t bytes = hdrp_oit_memory_size(&desc);
    void* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    hdrp_v3* got = malloc(OIT_PIXELS * sizeof *got);
    oit_error e = {NAN, NAN};
    if (memory && got && hdrp_oit_image_init(&image, &desc, memory, bytes) == HDRP_OK) {
        for (uint32_t pass = 0; pass < hdrp_oit_pass_count(mode); ++pass) {
            hdrp_oit_blend_rows(&image, pass, p->fragments, p->pixels, p->count, 0, desc.height_px);
        }
        hdrp_oit_composite_rows(&image, p->behind, got, 0, desc.height_px);
        e = difference(p, got);
    }
    free(memory);
    free(got);
    return e;
}
