/* Radiance pictures: Ward 1994, "The RADIANCE Lighting Simulation and Rendering System", and the
 * file format notes of the Radiance distribution. RGBE, flat or run-length encoded by component. */
#include "image.h"

#include "file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct reader {
    const unsigned char* at;
    const unsigned char* end;
    const char* path;
    rd_report* report;
} reader;

static bool fail(reader* r, const char* why)
{
    return rd_fail(r->report, r->path, "Radiance image: %s", why);
}

/* One header line without its break; false at the end of the data. */
static bool take_line(reader* r, char* line, size_t size)
{
    size_t n = 0;
    while (r->at < r->end && *r->at != '\n') {
        if (n + 1 < size) {
            line[n++] = (char)*r->at;
        }
        ++r->at;
    }
    line[n] = '\0';
    if (r->at == r->end) {
        return false;
    }
    ++r->at;
    return true;
}

static bool read_header(reader* r, int* width, int* height)
{
    char line[256];
    char trailing;
    while (take_line(r, line, sizeof line) && line[0]) {
        if (!strncmp(line, "FORMAT=", 7) && strcmp(line, "FORMAT=32-bit_rle_rgbe") != 0) {
            return fail(r, "only 32-bit_rle_rgbe is read");
        }
    }
    if (!take_line(r, line, sizeof line) ||
        sscanf(line, "-Y %6d +X %6d%c", height, width, &trailing) != 2) {
        return fail(r, "no resolution line of the form \"-Y height +X width\"");
    }
    if (*width < 1 || *height < 1 || *width > RD_IMAGE_MAX_SIDE || *height > RD_IMAGE_MAX_SIDE ||
        (uint64_t)*width * (uint64_t)*height > RD_IMAGE_MAX_PIXELS) {
        return fail(r, "unusable size");
    }
    return true;
}

/* One component of a row: runs (count > 128) and literals. */
static bool read_component(reader* r, unsigned char* out, int width)
{
    for (int x = 0; x < width;) {
        int count, run;
        if (r->at == r->end) {
            return false;
        }
        run = *r->at > 128;
        count = run ? *r->at - 128 : *r->at;
        ++r->at;
        if (count == 0 || count > width - x || r->end - r->at < (run ? 1 : count)) {
            return false;
        }
        for (int i = 0; i < count; ++i) {
            out[(x + i) * 4] = run ? r->at[0] : r->at[i];
        }
        r->at += run ? 1 : count;
        x += count;
    }
    return true;
}

static bool is_rle_row(const reader* r, int width)
{
    return width >= 8 && width < 32768 && r->end - r->at >= 4 && r->at[0] == 2 && r->at[1] == 2 &&
           (r->at[2] << 8 | r->at[3]) == width;
}

static bool read_row(reader* r, unsigned char* rgbe, int width)
{
    if (is_rle_row(r, width)) {
        r->at += 4;
        for (int c = 0; c < 4; ++c) {
            if (!read_component(r, rgbe + c, width)) {
                return fail(r, "damaged row");
            }
        }
        return true;
    }
    if (r->end - r->at < (ptrdiff_t)width * 4) {
        return fail(r, "cut short");
    }
    memcpy(rgbe, r->at, (size_t)width * 4);
    r->at += (ptrdiff_t)width * 4;
    return true;
}

static void decode_row(const unsigned char* rgbe, float* rgba, int width)
{
    for (int x = 0; x < width; ++x, rgbe += 4, rgba += 4) {
        /* The exponent is biased by 128 and the mantissas are 8-bit fractions. */
        float scale = rgbe[3] ? ldexpf(1.0f, rgbe[3] - (128 + 8)) : 0.0f;
        for (int c = 0; c < 3; ++c) {
            rgba[c] = (float)rgbe[c] * scale;
        }
        rgba[3] = 1.0f;
    }
}

static bool read_pixels(reader* r, rd_image_f32* image)
{
    unsigned char* row = (unsigned char*)malloc((size_t)image->width * 4);
    bool ok = row != NULL;
    image->rgba = (float*)malloc((size_t)image->width * (size_t)image->height * 4 * sizeof(float));
    if (!image->rgba || !row) {
        ok = fail(r, "out of memory");
    }
    for (int y = 0; ok && y < image->height; ++y) {
        ok = read_row(r, row, image->width);
        if (ok) {
            decode_row(row, image->rgba + (size_t)y * (size_t)image->width * 4, image->width);
        }
    }
    free(row);
    return ok;
}

bool rd_image_read_hdr(rd_image_f32* image, const char* path, rd_report* report)
{
    unsigned char* bytes;
    size_t size;
    reader r;
    bool ok;
    memset(image, 0, sizeof *image);
    if (!rd_file_read(path, &bytes, &size, report)) {
        return false;
    }
    r.at = bytes;
    r.end = bytes + size;
    r.path = path;
    r.report = report;
    ok = read_header(&r, &image->width, &image->height);
    /* Run-length encoding yields at most 127 bytes from 2. */
    if (ok && (uint64_t)image->width * (uint64_t)image->height * 4 / 64 > size) {
        ok = fail(&r, "too little data for its size");
    }
    ok = ok && read_pixels(&r, image);
    free(bytes);
    if (!ok) {
        rd_image_free_f32(image);
    }
    return ok;
}
