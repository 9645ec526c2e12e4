/* oit_motion.c - see oit_motion.h.
 * SPDX-License-Identifier: MIT */
#include "oit_motion.h"

#include "oit_harness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH     32
#define HEIGHT    24
#define PIXELS    (WIDTH * HEIGHT)
#define CARDS_MAX 16
#define VALUES    (3 * PIXELS)
#define ORBIT_RAD 0.5

typedef struct vec {
    double x, y, z;
} vec;

typedef struct card {
    vec center, normal; /* in the camera's space: z is depth */
    double radius, alpha, emission;
    vec color;
} card;

typedef struct cards {
    card of[CARDS_MAX];
    size_t count;
} cards;

typedef struct stream {
    hdrp_oit_fragment fragments[PIXELS * CARDS_MAX];
    uint32_t pixels[PIXELS * CARDS_MAX];
    size_t count;
} stream;

const char* motion_sequence_name(motion_sequence sequence)
{
    static const char* const names[MOTION_SEQUENCES] = {"crossing", "orbit", "dolly"};
    return names[sequence];
}

const char* motion_way_name(int way)
{
    return way == MOTION_SORTED_PIXELS  ? "sorted_pixels"
           : way == MOTION_SORTED_CARDS ? "sorted_cards"
                                        : oit_mode_name((hdrp_oit_mode)way);
}

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec turned(vec v, double yaw_rad)
{
    double c = cos(yaw_rad), s = sin(yaw_rad);
    return (vec){c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

/* ---- the scenes ------------------------------------------------------------------------------ */

/* Numbers in [lo,hi] that are spread evenly: multiples of the golden ratio. */
static double spread(size_t i, double which, double lo, double hi)
{
    double x = ((double)i + 1.0) * (0.6180339887498949 + 0.1379 * which) + 0.37 * which;
    return lo + (hi - lo) * (x - floor(x));
}

static vec spread_color(size_t i)
{
    return (vec){spread(i, 1, 0, 1), spread(i, 2, 0, 1), spread(i, 3, 0, 1)};
}

static cards crossing(double t)
{
    cards all = {.count = 8};
    for (size_t i = 0; i < all.count; ++i) {
        all.of[i] = (card){{spread(i, 4, -3, 3), spread(i, 5, -2, 2), 6.0 + 2.0 * (double)i},
                           {0, 0, 1},
                           6.0,
                           spread(i, 6, 0.2, 0.6),
                           0,
                           spread_color(i)};
    }
    all.of[2] = (card){{0, 0, 12 + 4 * t}, {0.1, 0, 1}, 8, 0.8, 0, {0.9, 0.2, 0.1}};
    all.of[3] = (card){{0, 0, 16 - 4 * t}, {0, 0.1, 1}, 8, 0.8, 0, {0.1, 0.3, 0.9}};
    return all;
}

static cards orbit(double t)
{
    cards all = {.count = 12};
    for (size_t i = 0; i < all.count; ++i) {
        vec at = {spread(i, 4, -3, 3), spread(i, 5, -2, 2), spread(i, 6, -3, 3)};
        vec normal = {spread(i, 7, -0.5, 0.5), spread(i, 8, -0.5, 0.5), 1};
        at = turned(at, ORBIT_RAD * t);
        at.z += 8;
        all.of[i] = (card){at,
                           turned(normal, ORBIT_RAD * t),
                           4,
                           spread(i, 10, 0.3, 0.9),
                           i % 4 == 3 ? 0.5 : 0,
                           spread_color(i)};
    }
    return all;
}

static cards dolly(double t)
{
    cards all = {.count = 16};
    for (size_t i = 0; i < all.count; ++i) {
        double z = 3 + 1.5 * (double)i - 12 * t;
        double fade = z <= 0.5 ? 0 : z >= 2.5 ? 1 : (z - 0.5) / 2;
        all.of[i] = (card){{spread(i, 4, -2, 2), spread(i, 5, -1.5, 1.5), z},
                           {0, 0, 1},
                           4,
                           fade * spread(i, 6, 0.1, 0.4),
                           0,
                           spread_color(i)};
    }
    return all;
}

static cards cards_of(motion_sequence sequence, double t)
{
    return sequence == MOTION_CROSSING ? crossing(t)
           : sequence == MOTION_ORBIT  ? orbit(t)
                                       : dolly(t);
}

/* ---- drawing --------------------------------------------------------------------------------- */

/* The fragment of a card in a pixel; 0 where there is none. */
static int hit(const card* c, int pixel, hdrp_oit_fragment* f)
{
    vec ray = {(pixel % WIDTH + 0.5) / WIDTH * 2 - 1, (pixel / WIDTH + 0.5) / HEIGHT * 1.5 - 0.75,
               1};
    double depth = dot(c->center, c->normal) / dot(ray, c->normal);
    if (!(depth > 0.1 && depth < 1000)) {
        return 0;
    }
    vec from = {ray.x * depth - c->center.x, ray.y * depth - c->center.y, depth - c->center.z};
    double soft = 1 - dot(from, from) / (c->radius * c->radius);
    if (soft <= 0) {
        return 0;
    }
    double alpha = c->alpha * soft;
    float r = (float)(c->color.x * alpha), g = (float)(c->color.y * alpha);
    float b = (float)(c->color.z * alpha), e = (float)c->emission;
    hdrp_v3 lit = hdrp_v3_make(r, g, b);
    *f = hdrp_oit_fragment_make(lit, hdrp_v3_scale(lit, e), (float)alpha, (float)depth);
    return 1;
}

static void draw_card(const card* c, stream* s)
{
    for (int pixel = 0; pixel < PIXELS; ++pixel) {
        if (hit(c, pixel, &s->fragments[s->count])) {
            s->pixels[s->count++] = (uint32_t)pixel;
        }
    }
}

static int farther_card_first(const void* a, const void* b)
{
    double x = ((const card*)a)->center.z, y = ((const card*)b)->center.z;
    return x > y ? -1 : x < y;
}

static void blend(const hdrp_oit_fragment* f, hdrp_v3* color)
{
    *color = hdrp_v3_mad(hdrp_v3_add(f->premultiplied, f->emission), *color, 1.0f - f->alpha);
}

static void blend_cards(const cards* all, hdrp_v3* colors)
{
    cards sorted = *all;
    qsort(sorted.of, sorted.count, sizeof *sorted.of, farther_card_first);
    for (size_t i = 0; i < sorted.count; ++i) {
        for (int pixel = 0; pixel < PIXELS; ++pixel) {
            hdrp_oit_fragment f;
            if (hit(&sorted.of[i], pixel, &f)) {
                blend(&f, &colors[pixel]);
            }
        }
    }
}

static void blend_pixels(const cards* all, hdrp_v3* colors)
{
    for (int pixel = 0; pixel < PIXELS; ++pixel) {
        hdrp_oit_fragment sorted[CARDS_MAX];
        size_t count = 0;
        for (size_t i = 0; i < all->count; ++i) {
            count += (size_t)hit(&all->of[i], pixel, &sorted[count]);
        }
        qsort(sorted, count, sizeof *sorted, oit_farther_first);
        for (size_t i = 0; i < count; ++i) {
            blend(&sorted[i], &colors[pixel]);
        }
    }
}

static int blend_unsorted(hdrp_oit_mode mode, const stream* s, hdrp_v3* colors)
{
    hdrp_oit_desc desc = {WIDTH, HEIGHT, mode, HDRP_OIT_PRECISION_NATIVE, 0, 0, 0, 0, 0};
    hdrp_oit_image image;
    size_t bytes = hdrp_oit_memory_size(&desc);
    void* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    int good = memory && hdrp_oit_image_init(&image, &desc, memory, bytes) == HDRP_OK;
    if (good) {
        for (uint32_t pass = 0; pass < hdrp_oit_pass_count(mode); ++pass) {
            hdrp_oit_blend_rows(&image, pass, s->fragments, s->pixels, s->count, 0, HEIGHT);
        }
        hdrp_oit_composite_rows(&image, colors, colors, 0, HEIGHT);
    }
    free(memory);
    return good;
}

static void clear(hdrp_v3* colors)
{
    for (int pixel = 0; pixel < PIXELS; ++pixel) {
        colors[pixel] = hdrp_v3_make(0.4f, 0.5f, 0.6f);
    }
}

/* ---- steps ----------------------------------------------------------------------------------- */

/* Sum of squares of the differences; *largest is raised to the largest of them. */
static double squares(const hdrp_v3* a, const hdrp_v3* b, double* largest)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; ++i) {
        const double d[3] = {(double)a[i].x - (double)b[i].x, (double)a[i].y - (double)b[i].y,
                             (double)a[i].z - (double)b[i].z};
        for (int k = 0; k < 3; ++k) {
            sum += d[k] * d[k];
            *largest = fabs(d[k]) <= *largest ? *largest : fabs(d[k]);
        }
    }
    return sum;
}

typedef struct film {
    stream drawn;
    hdrp_v3 now[MOTION_WAYS][PIXELS];
    hdrp_v3 before[MOTION_WAYS][PIXELS];
} film;

static int draw_frame(film* m, motion_sequence sequence, double t)
{
    cards all = cards_of(sequence, t);
    int good = 1;
    m->drawn.count = 0;
    for (size_t i = 0; i < all.count; ++i) {
        draw_card(&all.of[i], &m->drawn);
    }
    for (int way = 0; way < MOTION_WAYS; ++way) {
        clear(m->now[way]);
        if (way < (int)HDRP_OIT_MODE_COUNT) {
            good = good && blend_unsorted((hdrp_oit_mode)way, &m->drawn, m->now[way]);
        }
    }
    blend_pixels(&all, m->now[MOTION_SORTED_PIXELS]);
    blend_cards(&all, m->now[MOTION_SORTED_CARDS]);
    return good;
}

int motion_measure(motion_sequence sequence, motion_step steps[MOTION_WAYS])
{
    film* m = malloc(sizeof *m);
    int good = m != NULL;
    memset(steps, 0, MOTION_WAYS * sizeof *steps);
    for (unsigned frame = 0; good && frame < MOTION_FRAMES; ++frame) {
        good = draw_frame(m, sequence, (double)frame / (MOTION_FRAMES - 1));
        for (int way = 0; way < MOTION_WAYS; ++way) {
            double unused = 0;
            steps[way].error += squares(m->now[way], m->now[MOTION_SORTED_PIXELS], &unused);
            if (frame > 0) {
                double step = squares(m->now[way], m->before[way], &steps[way].pixel);
                steps[way].picture = fmax(steps[way].picture, sqrt(step / VALUES));
            }
        }
        memcpy(m->before, m->now, sizeof m->now);
    }
    for (int way = 0; way < MOTION_WAYS; ++way) {
        steps[way].error = sqrt(steps[way].error / ((double)VALUES * MOTION_FRAMES));
    }
    free(m);
    return good;
}
