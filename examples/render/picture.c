#include "picture.h"

#include "file.h"
#include "image.h"

#include <stdlib.h>

static float srgb(float x)
{
    return hdrp_srgb_from_linear(hdrp_saturate(x));
}

/* The nearest covered distance, for RD_ENCODE_DISTANCE. */
static float nearest(const float* film, size_t pixels)
{
    float d = HDRP_FLT_MAX;
    for (size_t i = 0; i < pixels; ++i, film += 4) {
        if (film[3] > 0.99f && film[0] < d) {
            d = film[0];
        }
    }
    return d;
}

static float encode(float v, rd_encoding encoding, float scale)
{
    switch (encoding) {
    case RD_ENCODE_LIT:
    case RD_ENCODE_COLOR:
        return srgb(v);
    case RD_ENCODE_DATA:
        return hdrp_saturate(v);
    case RD_ENCODE_SIGNED:
        return hdrp_saturate(v * 0.5f + 0.5f);
    case RD_ENCODE_DISTANCE:
        return v > 0.0f ? hdrp_saturate(scale / v) : 0.0f;
    }
    return 0.0f;
}

static unsigned char code(float v, rd_encoding encoding, float scale)
{
    return (unsigned char)(encode(v, encoding, scale) * 255.0f + 0.5f);
}

static bool write_png(const char* path, int width, int height, const float* film,
                      rd_encoding encoding, float scale, rd_report* report)
{
    size_t pixels = (size_t)width * (size_t)height;
    unsigned char* rgb = (unsigned char*)malloc(pixels * 3);
    bool ok;
    if (!rgb) {
        return rd_fail(report, path, "out of memory");
    }
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < pixels; ++i) {
        hdrp_v3 v = hdrp_v3_make(film[i * 4], film[i * 4 + 1], film[i * 4 + 2]);
        if (encoding == RD_ENCODE_LIT) {
            v = hdrp_tonemap_neutral(hdrp_v3_scale(v, scale));
        }
        rgb[i * 3] = code(v.x, encoding, scale);
        rgb[i * 3 + 1] = code(v.y, encoding, scale);
        rgb[i * 3 + 2] = code(v.z, encoding, scale);
    }
    ok = rd_image_write_png(path, width, height, rgb, report);
    free(rgb);
    return ok;
}

bool rd_picture_write(const char* path, int width, int height, const float* film,
                      rd_encoding encoding, float exposure, rd_report* report)
{
    float scale = exposure;
    if (rd_path_has_extension(path, "exr")) {
        return rd_image_write_exr(path, width, height, film, report);
    }
    if (encoding == RD_ENCODE_DISTANCE) {
        scale = nearest(film, (size_t)width * (size_t)height);
    }
    return write_png(path, width, height, film, encoding, scale, report);
}
