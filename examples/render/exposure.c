#include "exposure.h"

#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define METER_WIDTH 160
/* Percentiles outside of which deep shadows and lamps lie. */
#define DARKEST   0.10
#define BRIGHTEST 0.95
/* A meter makes the average a tenth of white, a grey card is 0.18 of it: half a stop more shows
 * materials at about their own brightness. */
#define COMPENSATION_STOPS 0.8f
/* What black scenes are exposed for: a room at night. */
#define EV100_OF_BLACK 0.0f

static int compare_floats(const void* a, const void* b)
{
    float x = *(const float*)a, y = *(const float*)b;
    return x < y ? -1 : x > y;
}

static size_t gather(const float* film, size_t pixels, bool covered_only, float* out)
{
    size_t n = 0;
    for (size_t i = 0; i < pixels; ++i) {
        float l = hdrp_luminance(hdrp_v3_make(film[i * 4], film[i * 4 + 1], film[i * 4 + 2]));
        if (l > 0.0f && isfinite(l) && (!covered_only || film[i * 4 + 3] > 0.5f)) {
            out[n++] = l;
        }
    }
    return n;
}

bool rd_exposure_of_film(const float* film, size_t pixels, bool covered_only, float* ev100)
{
    float* l = (float*)malloc((pixels ? pixels : 1) * sizeof *l);
    size_t n = l ? gather(film, pixels, covered_only, l) : 0;
    size_t first = (size_t)(DARKEST * (double)n), end = (size_t)ceil(BRIGHTEST * (double)n);
    double sum = 0.0;
    if (n > 0) {
        qsort(l, n, sizeof *l, compare_floats);
        for (size_t i = first; i < end; ++i) {
            sum += log2((double)l[i]);
        }
        *ev100 = hdrp_light_ev100_compensated(
            hdrp_light_ev100_from_nits((float)exp2(sum / (double)(end - first))),
            COMPENSATION_STOPS);
    }
    free(l);
    return n > 0;
}

/* The picture's options at a fraction of its cost. */
static rd_options small_options(const rd_options* o)
{
    rd_options s = *o;
    s.width = o->width < METER_WIDTH ? o->width : METER_WIDTH;
    s.height = o->height * s.width / o->width;
    s.height = s.height > 0 ? s.height : 1;
    s.spp = 1;
    s.quality = RD_QUALITY_FAST;
    s.oit = RD_OIT_SORTED;
    s.path = RD_PATH_FORWARD; /* a GBuffer would need to know the exposure */
    return s;
}

static bool meter(const rd_options* o, const rd_lighting* lighting, const rd_camera* camera,
                  bool* found, float* ev100, rd_report* report)
{
    rd_camera c = *camera;
    rd_progress silent;
    rd_renderer r;
    rd_renderer_desc d = {o, lighting, 1.0f, NULL, &silent};
    size_t pixels = (size_t)o->width * (size_t)o->height;
    bool cards = (o->features & RD_FEATURE_GREY_CARDS) != 0;
    memset(&silent, 0, sizeof silent);
    if (!rd_renderer_begin(&r, &d, report)) {
        return false;
    }
    c.width_px = o->width;
    c.height_px = o->height;
    rd_render(&r, &c);
    *found = rd_exposure_of_film(r.film, pixels, cards, ev100);
    rd_renderer_end(&r);
    return true;
}

bool rd_exposure_meter(const rd_options* options, const rd_lighting* lighting,
                       const rd_camera* camera, float* ev100, rd_report* report)
{
    rd_options o = small_options(options);
    rd_lighting l = *lighting;
    bool found = false;
    /* The same for pictures of every quality, as far as may be. */
    l.soft_shadows = false;
    l.fast_irradiance = true;
    *ev100 = EV100_OF_BLACK;
    o.view = RD_VIEW_DIFFUSE;
    o.features |= RD_FEATURE_GREY_CARDS;
    if (!meter(&o, &l, camera, &found, ev100, report) || found) {
        return !report->failed;
    }
    o.view = RD_VIEW_LIT;
    o.features &= ~(uint32_t)RD_FEATURE_GREY_CARDS;
    return meter(&o, &l, camera, &found, ev100, report);
}
