#include "texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Probes along the longer axis of a footprint; what is longer still is blurred. */
#define MAX_PROBES 4
/* Codes are looked up by the square root of the linear value, which is nearly the code. */
#define ENCODE_STEPS 4096

/* Filled by rd_textures_prepare before its jobs start; constant from then on. */
static float linear_from_code[256];
static float unorm_from_code[256];
static unsigned char code_from_root[ENCODE_STEPS + 1];

static void fill_tables(void)
{
    for (int i = 0; i < 256; ++i) {
        linear_from_code[i] = hdrp_linear_from_srgb((float)i / 255.0f);
        unorm_from_code[i] = (float)i / 255.0f;
    }
    for (int i = 0; i <= ENCODE_STEPS; ++i) {
        float root = (float)i / ENCODE_STEPS;
        code_from_root[i] = (unsigned char)(hdrp_srgb_from_linear(root * root) * 255.0f + 0.5f);
    }
}

static unsigned char encode_srgb(float x)
{
    return code_from_root[(int)(sqrtf(x) * ENCODE_STEPS + 0.5f)];
}

static unsigned char encode_unorm(float x)
{
    return (unsigned char)(x * 255.0f + 0.5f);
}

/* Box of source texels that one texel of the next level covers. */
typedef struct box {
    int x0, x1, y0, y1;
} box;

/* The colours of an sRGB texture are averaged in linear light, weighted by alpha: what is behind
 * a transparent texel must not tint its neighbours. */
static void average_color(const unsigned char* from, int width, box b, unsigned char* to)
{
    float sum[3] = {0, 0, 0}, plain[3] = {0, 0, 0}, alpha = 0;
    float count = (float)((b.x1 - b.x0) * (b.y1 - b.y0));
    for (int y = b.y0; y < b.y1; ++y) {
        for (int x = b.x0; x < b.x1; ++x) {
            const unsigned char* p = from + ((size_t)y * (size_t)width + (size_t)x) * 4;
            float a = (float)p[3] / 255.0f;
            for (int c = 0; c < 3; ++c) {
                sum[c] += linear_from_code[p[c]] * a;
                plain[c] += linear_from_code[p[c]];
            }
            alpha += a;
        }
    }
    for (int c = 0; c < 3; ++c) {
        to[c] = encode_srgb(fminf(alpha > 0 ? sum[c] / alpha : plain[c] / count, 1.0f));
    }
    to[3] = encode_unorm(alpha / count);
}

static void average_data(const unsigned char* from, int width, box b, unsigned char* to)
{
    unsigned sum[4] = {0, 0, 0, 0};
    unsigned count = (unsigned)((b.x1 - b.x0) * (b.y1 - b.y0));
    for (int y = b.y0; y < b.y1; ++y) {
        for (int x = b.x0; x < b.x1; ++x) {
            const unsigned char* p = from + ((size_t)y * (size_t)width + (size_t)x) * 4;
            for (int c = 0; c < 4; ++c) {
                sum[c] += p[c];
            }
        }
    }
    for (int c = 0; c < 4; ++c) {
        to[c] = (unsigned char)((sum[c] + count / 2) / count);
    }
}

static int half(int n)
{
    return n > 1 ? n / 2 : 1;
}

static void build_level(const rd_texture* t, int level, int width, int height)
{
    int w = half(width), h = half(height);
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            box b = {x * width / w, ((x + 1) * width + w - 1) / w, y * height / h,
                     ((y + 1) * height + h - 1) / h};
            unsigned char* to = t->level[level] + ((size_t)y * (size_t)w + (size_t)x) * 4;
            if (t->is_srgb) {
                average_color(t->level[level - 1], width, b, to);
            } else {
                average_data(t->level[level - 1], width, b, to);
            }
        }
    }
}

static size_t count_levels(rd_texture* t)
{
    size_t texels = 0;
    int w = t->width, h = t->height;
    for (t->level_count = 0; t->level_count < RD_TEXTURE_MAX_LEVELS;) {
        texels += (size_t)w * (size_t)h;
        ++t->level_count;
        if (w == 1 && h == 1) {
            break;
        }
        w = half(w);
        h = half(h);
    }
    return texels * 4;
}

/* Turns t->image into a mip chain; returns its size in bytes, 0 without memory. */
static size_t build_levels(rd_texture* t)
{
    size_t bytes;
    int w = t->width = t->image.width;
    int h = t->height = t->image.height;
    bytes = count_levels(t);
    t->level[0] = (unsigned char*)realloc(t->image.rgba, bytes);
    if (!t->level[0]) {
        return 0;
    }
    t->image.rgba = NULL;
    for (int i = 1; i < t->level_count; ++i) {
        t->level[i] = t->level[i - 1] + (size_t)w * (size_t)h * 4;
        build_level(t, i, w, h);
        w = half(w);
        h = half(h);
    }
    return bytes;
}

/* One job: its errors go to a report of its own, so that the first texture with an error wins
 * whatever the order of the jobs. `memory` is shared by all jobs. */
static bool prepare(rd_texture* t, size_t* memory, rd_report* report)
{
    const char* name = t->name ? t->name : "texture";
    size_t bytes, total;
    if (t->level[0]) {
        return true;
    }
    if (t->encoded) {
        bool ok = rd_image_decode_u8(&t->image, t->encoded, t->encoded_size, name, report);
        free(t->encoded);
        t->encoded = NULL;
        if (!ok) {
            return false;
        }
    }
    bytes = build_levels(t);
#pragma omp atomic capture
    total = *memory += bytes;
    if (total > RD_TEXTURES_MAX_BYTES) {
        return rd_fail(report, name, "the textures of the scene need more than 4 GiB");
    }
    return bytes > 0 ? true : rd_fail(report, name, "out of memory");
}

bool rd_textures_prepare(rd_texture_set* set, rd_report* report)
{
    int worst = set->count;
    char first_error[RD_TEXT_MAX] = "";
    fill_tables();
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < set->count; ++i) {
        rd_report r;
        r.failed = false;
        if (prepare(&set->items[i], &set->memory, &r)) {
            continue;
        }
#pragma omp critical(rd_texture_error)
        if (i < worst) {
            worst = i;
            memcpy(first_error, r.error, sizeof first_error);
        }
    }
    if (worst < set->count && !report->failed) {
        report->failed = true;
        memcpy(report->error, first_error, sizeof first_error);
    }
    return worst == set->count;
}

void rd_textures_free(rd_texture_set* set)
{
    for (int i = 0; i < set->count; ++i) {
        free(set->items[i].level[0]);
        free(set->items[i].encoded);
        free(set->items[i].name);
        rd_image_free_u8(&set->items[i].image);
    }
    free(set->items);
    memset(set, 0, sizeof *set);
}

/* A coordinate in [0, 1], whatever comes in. */
static float wrap_coordinate(float u, rd_wrap wrap)
{
    if (!(fabsf(u) < 1e9f)) {
        return 0.0f;
    }
    if (wrap == RD_WRAP_CLAMP) {
        return hdrp_saturate(u);
    }
    if (wrap == RD_WRAP_REPEAT) {
        return u - floorf(u);
    }
    u -= 2.0f * floorf(u * 0.5f);
    return u > 1.0f ? 2.0f - u : u;
}

static int wrap_index(int i, int n, rd_wrap wrap)
{
    if (i < 0) {
        return wrap == RD_WRAP_REPEAT ? n - 1 : 0;
    }
    if (i >= n) {
        return wrap == RD_WRAP_REPEAT ? 0 : n - 1;
    }
    return i;
}

/* One texel times its weight, added up. */
static void add_texel(const float* decode, const unsigned char* texel, float weight, float sum[4])
{
    sum[0] += decode[texel[0]] * weight;
    sum[1] += decode[texel[1]] * weight;
    sum[2] += decode[texel[2]] * weight;
    sum[3] += unorm_from_code[texel[3]] * weight;
}

static hdrp_v4 sample_level(const rd_texture* t, int level, hdrp_v2 uv)
{
    const float* decode = t->is_srgb ? linear_from_code : unorm_from_code;
    int w = t->width >> level > 1 ? t->width >> level : 1;
    int h = t->height >> level > 1 ? t->height >> level : 1;
    float x = wrap_coordinate(uv.x, t->wrap_u) * (float)w - 0.5f;
    float y = wrap_coordinate(uv.y, t->wrap_v) * (float)h - 0.5f;
    /* x is above -1: adding 1 makes truncation the floor. */
    int left = (int)(x + 1.0f) - 1, top = (int)(y + 1.0f) - 1;
    float tx = x - (float)left, ty = y - (float)top;
    int x0 = wrap_index(left, w, t->wrap_u), x1 = wrap_index(left + 1, w, t->wrap_u);
    int y0 = wrap_index(top, h, t->wrap_v), y1 = wrap_index(top + 1, h, t->wrap_v);
    const unsigned char* row0 = t->level[level] + (size_t)y0 * (size_t)w * 4;
    const unsigned char* row1 = t->level[level] + (size_t)y1 * (size_t)w * 4;
    float sum[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    if (t->is_nearest && level == 0) {
        tx = tx < 0.5f ? 0.0f : 1.0f;
        ty = ty < 0.5f ? 0.0f : 1.0f;
    }
    add_texel(decode, row0 + (size_t)x0 * 4, (1.0f - tx) * (1.0f - ty), sum);
    add_texel(decode, row0 + (size_t)x1 * 4, tx * (1.0f - ty), sum);
    add_texel(decode, row1 + (size_t)x0 * 4, (1.0f - tx) * ty, sum);
    add_texel(decode, row1 + (size_t)x1 * 4, tx * ty, sum);
    return hdrp_v4_make(sum[0], sum[1], sum[2], sum[3]);
}

static hdrp_v4 mix(hdrp_v4 a, hdrp_v4 b, float t)
{
    return hdrp_v4_make(a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t,
                        a.w + (b.w - a.w) * t);
}

static hdrp_v4 sample_trilinear(const rd_texture* t, hdrp_v2 uv, float lod)
{
    float floor_lod = floorf(lod);
    int level = (int)floor_lod;
    if (level >= t->level_count - 1) {
        return sample_level(t, t->level_count - 1, uv);
    }
    if (!(lod > 0.0f)) {
        return sample_level(t, 0, uv);
    }
    return mix(sample_level(t, level, uv), sample_level(t, level + 1, uv), lod - floor_lod);
}

hdrp_v4 rd_texture_sample_finest(const rd_texture* t, hdrp_v2 uv)
{
    return sample_level(t, 0, uv);
}

static float texels_along(const rd_texture* t, hdrp_v2 d)
{
    return sqrtf(hdrp_sq(d.x * (float)t->width) + hdrp_sq(d.y * (float)t->height));
}

float rd_texture_footprint(const rd_texture* t, hdrp_v2 d_dx, hdrp_v2 d_dy)
{
    return hdrp_max(texels_along(t, d_dx), texels_along(t, d_dy));
}

/* Heckbert's ellipse reduced to its two derivative vectors, as graphics hardware does. */
hdrp_v4 rd_texture_sample(const rd_texture* t, hdrp_v2 uv, hdrp_v2 d_dx, hdrp_v2 d_dy)
{
    float lx = texels_along(t, d_dx), ly = texels_along(t, d_dy);
    hdrp_v2 axis = lx > ly ? d_dx : d_dy;
    float longer = lx > ly ? lx : ly;
    float shorter = lx > ly ? ly : lx;
    hdrp_v4 sum = hdrp_v4_make(0.0f, 0.0f, 0.0f, 0.0f);
    float lod;
    int probes;
    if (!(longer > 1.0f)) {
        return sample_level(t, 0, uv);
    }
    if (!(longer < 1e9f)) {
        return sample_level(t, t->level_count - 1, uv);
    }
    probes = shorter * MAX_PROBES >= longer ? (int)ceilf(longer / shorter) : MAX_PROBES;
    lod = log2f(longer / (float)probes);
    for (int i = 0; i < probes; ++i) {
        float s = ((float)i + 0.5f) / (float)probes - 0.5f;
        hdrp_v2 at = hdrp_v2_make(uv.x + axis.x * s, uv.y + axis.y * s);
        hdrp_v4 c = sample_trilinear(t, at, lod);
        sum = hdrp_v4_make(sum.x + c.x, sum.y + c.y, sum.z + c.z, sum.w + c.w);
    }
    return hdrp_v4_make(sum.x / (float)probes, sum.y / (float)probes, sum.z / (float)probes,
                        sum.w / (float)probes);
}
