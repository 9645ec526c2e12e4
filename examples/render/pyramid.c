#include "pyramid.h"

#include <stdlib.h>
#include <string.h>

static int half(int n)
{
    return n > 1 ? n / 2 : 1;
}

bool rd_pyramid_begin(rd_pyramid* p, hdrp_v3* picture, int width, int height)
{
    size_t texels = 0;
    int w = width, h = height;
    memset(p, 0, sizeof *p);
    p->width = width;
    p->height = height;
    p->level[0] = picture;
    p->level_count = 1;
    while (p->level_count < RD_PYRAMID_MAX && (w > 1 || h > 1)) {
        w = half(w);
        h = half(h);
        texels += (size_t)w * (size_t)h;
        ++p->level_count;
    }
    if (texels == 0) {
        return true;
    }
    p->level[1] = (hdrp_v3*)malloc(texels * sizeof(hdrp_v3));
    if (!p->level[1]) {
        return false;
    }
    w = half(width);
    h = half(height);
    for (int i = 2; i < p->level_count; ++i) {
        p->level[i] = p->level[i - 1] + (size_t)w * (size_t)h;
        w = half(w);
        h = half(h);
    }
    return true;
}

void rd_pyramid_end(rd_pyramid* p)
{
    free(p->level[1]);
    memset(p, 0, sizeof *p);
}

static hdrp_v3 average(const hdrp_v3* from, int width, int height, int x, int y)
{
    int x1 = 2 * x + 1 < width ? 2 * x + 1 : width - 1;
    int y1 = 2 * y + 1 < height ? 2 * y + 1 : height - 1;
    const hdrp_v3* row0 = from + (size_t)(2 * y) * (size_t)width;
    const hdrp_v3* row1 = from + (size_t)y1 * (size_t)width;
    hdrp_v3 sum =
        hdrp_v3_add(hdrp_v3_add(row0[2 * x], row0[x1]), hdrp_v3_add(row1[2 * x], row1[x1]));
    return hdrp_v3_scale(sum, 0.25f);
}

void rd_pyramid_build(rd_pyramid* p)
{
    int w = p->width, h = p->height;
    for (int i = 1; i < p->level_count; ++i) {
        int to_w = half(w), to_h = half(h);
#pragma omp parallel for schedule(static)
        for (int y = 0; y < to_h; ++y) {
            for (int x = 0; x < to_w; ++x) {
                p->level[i][(size_t)y * (size_t)to_w + (size_t)x] =
                    average(p->level[i - 1], w, h, x, y);
            }
        }
        w = to_w;
        h = to_h;
    }
}

static int limited(int i, int n)
{
    return i < 0 ? 0 : i < n ? i : n - 1;
}

static hdrp_v3 sample_level(const rd_pyramid* p, int level, float u, float v)
{
    int w = p->width >> level > 1 ? p->width >> level : 1;
    int h = p->height >> level > 1 ? p->height >> level : 1;
    float x = u * (float)w - 0.5f, y = v * (float)h - 0.5f;
    /* Above -1: adding 1 makes truncation the floor. */
    int left = (int)(x + 1.0f) - 1, top = (int)(y + 1.0f) - 1;
    int x0 = limited(left, w), x1 = limited(left + 1, w);
    const hdrp_v3* row0 = p->level[level] + (size_t)limited(top, h) * (size_t)w;
    const hdrp_v3* row1 = p->level[level] + (size_t)limited(top + 1, h) * (size_t)w;
    return hdrp_v3_lerp(hdrp_v3_lerp(row0[x0], row0[x1], x - (float)left),
                        hdrp_v3_lerp(row1[x0], row1[x1], x - (float)left), y - (float)top);
}

hdrp_v3 rd_pyramid_sample(const rd_pyramid* p, float x, float y, float lod)
{
    float u = hdrp_saturate(x / (float)p->width), v = hdrp_saturate(y / (float)p->height);
    float last = (float)(p->level_count - 1);
    float at = hdrp_clamp(lod, 0.0f, last);
    int level = (int)at;
    hdrp_v3 fine = sample_level(p, level, u, v);
    if ((float)level == at) {
        return fine;
    }
    return hdrp_v3_lerp(fine, sample_level(p, level + 1, u, v), at - (float)level);
}
