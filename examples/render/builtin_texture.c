#include "builtin_texture.h"

#include "noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The value of a texture at uv in [0,1)^2: encoded colour or data, and alpha. */
typedef hdrp_v4 (*texel_function)(float u, float v);
/* A height whose slopes make a normal map; in units of the texture's width. */
typedef float (*height_function)(float u, float v);

static hdrp_v4 opaque(float r, float g, float b)
{
    return hdrp_v4_make(r, g, b, 1.0f);
}

static hdrp_v3 at(float u, float v, float frequency, float z)
{
    return hdrp_v3_make(u * frequency, v * frequency, z);
}

static float smooth_step(float low, float high, float x)
{
    float t = hdrp_saturate((x - low) / (high - low));
    return t * t * (3.0f - 2.0f * t);
}

/* >>colours and data */

static hdrp_v4 floor_color(float u, float v)
{
    float clouds = rd_fractal_noise(at(u, v, 4.0f, 0.5f), 4u, 5, 11u);
    float grain = rd_noise(at(u, v, 128.0f, 0.5f), 128u, 12u);
    float k = 0.66f + 0.035f * clouds + 0.02f * grain;
    return opaque(k, k * 0.985f, k * 0.96f);
}

static hdrp_v4 floor_roughness(float u, float v)
{
    float clouds = rd_fractal_noise(at(u, v, 6.0f, 0.5f), 6u, 4, 21u);
    return opaque(1.0f, hdrp_saturate(0.80f + 0.16f * clouds), 0.0f);
}

static hdrp_v4 brushed(float u, float v)
{
    float streak = rd_noise(hdrp_v3_make(u * 4.0f, v * 256.0f, 0.5f), 256u, 31u);
    float wide = rd_noise(hdrp_v3_make(u * 2.0f, v * 48.0f, 0.5f), 48u, 32u);
    return opaque(1.0f, hdrp_saturate(0.85f + 0.12f * streak + 0.1f * wide), 1.0f);
}

static hdrp_v4 weave_color(float u, float v)
{
    float stripe = smooth_step(0.42f, 0.44f, hdrp_abs(u - 0.5f));
    float band = smooth_step(0.38f, 0.40f, hdrp_abs(u - 0.5f)) * (1.0f - stripe);
    float fade = 0.04f * rd_fractal_noise(at(u, v, 5.0f, 0.5f), 5u, 3, 41u);
    float k = 1.0f - 0.72f * band;
    return opaque((0.58f + fade) * k + 0.75f * band, (0.40f + fade) * k + 0.64f * band,
                  (0.22f + fade) * k + 0.46f * band);
}

/* Half the width of the blade at height y in [0, 1], with a slightly toothed edge. */
static float leaf_half_width(float y)
{
    float blade = sinf(HDRP_PI * powf(hdrp_saturate(y), 0.75f));
    return 0.42f * blade * (1.0f + 0.03f * sinf(y * 90.0f));
}

static hdrp_v4 leaf(float u, float v)
{
    float y = (1.0f - v - 0.12f) / 0.86f, x = hdrp_abs(u - 0.5f);
    bool blade = y > 0.0f && y < 1.0f && x < leaf_half_width(y);
    bool stem = v > 0.85f && x < 0.016f;
    float middle = 1.0f - smooth_step(0.006f, 0.016f, x);
    float side = sinf((y - x * 0.9f) * 52.0f);
    float vein = hdrp_max(middle, smooth_step(0.93f, 1.0f, side) * 0.6f);
    float mottle = 0.5f + 0.5f * rd_fractal_noise(at(u, v, 8.0f, 0.5f), 8u, 3, 51u);
    hdrp_v3 dark = hdrp_v3_make(0.20f, 0.42f, 0.16f);
    hdrp_v3 c = hdrp_v3_lerp(dark, hdrp_v3_make(0.38f, 0.60f, 0.22f), 0.5f * mottle);
    c = hdrp_v3_lerp(c, hdrp_v3_make(0.62f, 0.75f, 0.42f), 0.7f * vein);
    return hdrp_v4_from_v3(c, blade || stem ? 1.0f : 0.0f);
}

/* Round holes on a hexagonal grid, one period. */
static hdrp_v4 screen(float u, float v)
{
    float nearest = 1.0f;
    for (int j = -1; j <= 2; ++j) {
        for (int i = -1; i <= 1; ++i) {
            float dx = u - ((float)i + (j & 1 ? 1.0f : 0.5f));
            float dy = (v - ((float)j * 0.5f + 0.25f)) * 1.7320508f;
            nearest = hdrp_min(nearest, sqrtf(dx * dx + dy * dy));
        }
    }
    return hdrp_v4_make(0.8f, 0.8f, 0.8f, smooth_step(0.36f, 0.38f, nearest));
}

/* Gravity thins the film at the top; swirls stir it. */
static hdrp_v4 film(float u, float v)
{
    float swirl = rd_fractal_noise(at(u, v, 3.0f, 0.5f), 3u, 4, 61u);
    float bent = rd_fractal_noise(at(u, v, 4.0f, 1.5f), 4u, 3, 62u);
    float t = (1.0f - v) * 0.75f + 0.22f * swirl + 0.15f * sinf(9.0f * v + 3.0f * bent);
    return opaque(1.0f, hdrp_saturate(t), 0.0f);
}

static hdrp_v4 rock_color(float u, float v)
{
    float a = rd_fractal_noise(at(u, v, 5.0f, 0.5f), 5u, 5, 71u);
    float b = rd_fractal_noise(at(u, v, 9.0f, 0.5f), 9u, 3, 72u);
    float k = 0.46f + 0.12f * a;
    float warm = smooth_step(0.1f, 0.5f, b) * 0.06f;
    return opaque(k + warm, k, k - warm);
}

static hdrp_v4 label(float u, float v)
{
    float x = u - 0.5f, y = v - 0.5f;
    float r = sqrtf(x * x + y * y);
    float ring = smooth_step(0.30f, 0.32f, r) * (1.0f - smooth_step(0.44f, 0.46f, r));
    float disc = 1.0f - smooth_step(0.20f, 0.24f, r);
    return hdrp_v4_make(0.92f, 0.90f, 0.84f, hdrp_max(0.85f * ring, 0.6f * disc));
}

/* >>heights */

static float hammered_height(float u, float v)
{
    float nearest = 1.0f;
    const float n = 16.0f;
    int32_t cx = (int32_t)(u * n), cy = (int32_t)(v * n);
    for (int32_t j = -1; j <= 1; ++j) {
        for (int32_t i = -1; i <= 1; ++i) {
            uint32_t x = (uint32_t)(cx + i + 16) % 16u, y = (uint32_t)(cy + j + 16) % 16u;
            uint32_t h = hdrp_hash3(x, y, 81u);
            float dx = u * n - ((float)(cx + i) + hdrp_unit_from_u32(h));
            float dy = v * n - ((float)(cy + j) + hdrp_unit_from_u32(hdrp_hash1(h)));
            nearest = hdrp_min(nearest, dx * dx + dy * dy);
        }
    }
    return nearest * 0.017f;
}

static float weave_height(float u, float v)
{
    const float n = 16.0f * HDRP_PI;
    float warp = hdrp_abs(sinf(u * n)), weft = hdrp_abs(sinf(v * n));
    bool over = ((int)(u * 16.0f) + (int)(v * 16.0f)) % 2 == 0;
    return 0.006f * (over ? warp * (0.6f + 0.4f * weft) : weft * (0.6f + 0.4f * warp));
}

static float rock_coarse_height(float u, float v)
{
    float n = rd_fractal_noise(at(u, v, 6.0f, 0.5f), 6u, 5, 91u);
    return -0.035f * hdrp_abs(n);
}

static float rock_fine_height(float u, float v)
{
    return 0.008f * rd_fractal_noise(at(u, v, 24.0f, 0.5f), 24u, 3, 92u);
}

/* >>filling */

typedef struct recipe {
    int width, height;
    texel_function texel;      /* either this */
    height_function height_of; /* or a normal map of this */
    bool is_srgb;
} recipe;

static unsigned char byte_from_unit(float x)
{
    return (unsigned char)(hdrp_saturate(x) * 255.0f + 0.5f);
}

static void put(unsigned char* out, hdrp_v4 c)
{
    out[0] = byte_from_unit(c.x);
    out[1] = byte_from_unit(c.y);
    out[2] = byte_from_unit(c.z);
    out[3] = byte_from_unit(c.w);
}

static hdrp_v4 normal_texel(hdrp_v3 n)
{
    n = hdrp_v3_normalize(n);
    return opaque(0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z);
}

/* Each flake is a flat cell with a tilt of its own. */
static hdrp_v4 flakes(float u, float v)
{
    uint32_t h = hdrp_hash3((uint32_t)(u * 256.0f), (uint32_t)(v * 256.0f), 101u);
    float a = hdrp_unit_from_u32(h) * HDRP_TWO_PI;
    float tilt = 0.16f * sqrtf(hdrp_unit_from_u32(hdrp_hash1(h)));
    return normal_texel(hdrp_v3_make(tilt * cosf(a), tilt * sinf(a), 1.0f));
}

/* >>what is transparent */

static float from_centre(float u, float v)
{
    return 2.0f * sqrtf(hdrp_sq(u - 0.5f) + hdrp_sq(v - 0.5f));
}

static hdrp_v4 smoke(float u, float v)
{
    float billows = rd_fractal_noise(at(u, v, 4.0f, 0.5f), 4u, 4, 101u);
    float edge = 1.0f - smooth_step(0.15f, 1.0f, from_centre(u, v));
    return hdrp_v4_make(1.0f, 1.0f, 1.0f, hdrp_saturate(edge * (0.75f + 0.5f * billows)));
}

static hdrp_v4 glow(float u, float v)
{
    float r = from_centre(u, v), left = hdrp_max(1.0f - r, 0.0f);
    return hdrp_v4_make(1.0f, 1.0f, 1.0f, left * left * left);
}

static hdrp_v4 hologram(float u, float v)
{
    float line = 0.5f + 0.5f * sinf(v * 20.0f * HDRP_TWO_PI);
    float column = smooth_step(0.9f, 1.0f, hdrp_abs(sinf(u * 6.0f * HDRP_PI)));
    float edge = hdrp_min(hdrp_min(u, 1.0f - u), hdrp_min(v, 1.0f - v));
    float inside = smooth_step(0.02f, 0.12f, edge);
    return hdrp_v4_make(1.0f, 1.0f, 1.0f, inside * (0.2f + 0.5f * line * line + 0.3f * column));
}

static float wrapped(float x)
{
    return x - floorf(x);
}

/* The green channel points against v, as in glTF. */
static hdrp_v4 normal_from_height(height_function f, float u, float v, float step)
{
    float du = f(wrapped(u + step), v) - f(wrapped(u - step), v);
    float dv = f(u, wrapped(v + step)) - f(u, wrapped(v - step));
    return normal_texel(hdrp_v3_make(-du / (2.0f * step), dv / (2.0f * step), 1.0f));
}

static void fill_row(const recipe* r, unsigned char* out, int y)
{
    float v = ((float)y + 0.5f) / (float)r->height;
    for (int x = 0; x < r->width; ++x, out += 4) {
        float u = ((float)x + 0.5f) / (float)r->width;
        put(out, r->texel ? r->texel(u, v)
                          : normal_from_height(r->height_of, u, v, 0.5f / (float)r->width));
    }
}

static const recipe recipes[RD_TEX_COUNT] = {
    [RD_TEX_FLOOR_COLOR] = {256, 256, floor_color, NULL, true},
    [RD_TEX_FLOOR_ROUGHNESS] = {128, 128, floor_roughness, NULL, false},
    [RD_TEX_BRUSHED] = {128, 512, brushed, NULL, false},
    [RD_TEX_FLAKES] = {256, 256, flakes, NULL, false},
    [RD_TEX_HAMMERED] = {256, 256, NULL, hammered_height, false},
    [RD_TEX_WEAVE_NORMAL] = {128, 128, NULL, weave_height, false},
    [RD_TEX_WEAVE_COLOR] = {256, 128, weave_color, NULL, true},
    [RD_TEX_LEAF] = {256, 512, leaf, NULL, true},
    [RD_TEX_SCREEN] = {128, 128, screen, NULL, true},
    [RD_TEX_FILM] = {256, 256, film, NULL, false},
    [RD_TEX_ROCK_COLOR] = {256, 256, rock_color, NULL, true},
    [RD_TEX_ROCK_COARSE] = {256, 256, NULL, rock_coarse_height, false},
    [RD_TEX_ROCK_FINE] = {256, 256, NULL, rock_fine_height, false},
    [RD_TEX_LABEL] = {128, 128, label, NULL, true},
    [RD_TEX_SMOKE] = {128, 128, smoke, NULL, true},
    [RD_TEX_GLOW] = {64, 64, glow, NULL, true},
    [RD_TEX_HOLOGRAM] = {128, 128, hologram, NULL, true},
};

static bool allocate(rd_texture* t, const recipe* r, int index)
{
    t->is_srgb = r->is_srgb;
    t->is_normal = r->height_of != NULL || index == RD_TEX_FLAKES;
    t->image.width = r->width;
    t->image.height = r->height;
    t->image.rgba = (unsigned char*)malloc((size_t)r->width * (size_t)r->height * 4);
    return t->image.rgba != NULL;
}

bool rd_builtin_textures(rd_texture_set* set)
{
    bool ok = true;
    set->items = (rd_texture*)calloc(RD_TEX_COUNT, sizeof *set->items);
    if (!set->items) {
        return false;
    }
    set->count = RD_TEX_COUNT;
    for (int i = 0; i < RD_TEX_COUNT; ++i) {
        ok = allocate(&set->items[i], &recipes[i], i) && ok;
    }
    if (!ok) {
        return false;
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < RD_TEX_COUNT; ++i) {
        const recipe* r = &recipes[i];
        for (int y = 0; y < r->height; ++y) {
            fill_row(r, set->items[i].image.rgba + (size_t)y * (size_t)r->width * 4, y);
        }
    }
    return true;
}
