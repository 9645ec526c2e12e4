#include "image.h"

#include "file.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Deflate cannot expand data more than this: a smaller file is a lie about its size. */
#define DEFLATE_RATIO 1032

typedef struct source {
    const unsigned char* at;
    size_t left;
    char why[128];
} source;

static void on_error(png_structp png, png_const_charp message)
{
    source* s = (source*)png_get_error_ptr(png);
    snprintf(s->why, sizeof s->why, "%s", message);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_read(png_structp png, png_bytep out, size_t size)
{
    source* s = (source*)png_get_io_ptr(png);
    if (size > s->left) {
        png_error(png, "the file is cut short");
    }
    memcpy(out, s->at, size);
    s->at += size;
    s->left -= size;
}

static void expand_to_rgba8(png_structp png)
{
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
}

static void check_size(png_structp png, png_infop info, size_t file_size)
{
    uint64_t pixels = (uint64_t)png_get_image_width(png, info) * png_get_image_height(png, info);
    uint64_t raw = pixels * png_get_bit_depth(png, info) * png_get_channels(png, info) / 8;
    if (pixels > RD_IMAGE_MAX_PIXELS) {
        png_error(png, "too many pixels");
    }
    if (raw / DEFLATE_RATIO > file_size) {
        png_error(png, "too little data for its size");
    }
}

/* Not libpng's simplified interface: it changes samples by the gamma that a file claims, which glTF
 * says to ignore. Everything that libpng may jump out of is here; what it allocates hangs on its
 * arguments. */
static bool decode(png_structp png, png_infop info, source* s, rd_image_u8* image)
{
    size_t size = s->left;
    int passes;
    if (setjmp(png_jmpbuf(png))) {
        return false;
    }
    png_set_read_fn(png, s, on_read);
    png_set_user_limits(png, RD_IMAGE_MAX_SIDE, RD_IMAGE_MAX_SIDE);
    png_set_chunk_malloc_max(png, 1u << 24);
    png_read_info(png, info);
    check_size(png, info, size);
    expand_to_rgba8(png);
    passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    image->width = (int)png_get_image_width(png, info);
    image->height = (int)png_get_image_height(png, info);
    image->rgba = (unsigned char*)calloc((size_t)image->width * (size_t)image->height, 4);
    if (!image->rgba || png_get_rowbytes(png, info) != (size_t)image->width * 4) {
        png_error(png, "out of memory");
    }
    for (int pass = 0; pass < passes; ++pass) {
        for (int y = 0; y < image->height; ++y) {
            png_read_row(png, image->rgba + (size_t)y * (size_t)image->width * 4, NULL);
        }
    }
    png_read_end(png, NULL);
    return true;
}

bool rd_image_decode_png(rd_image_u8* image, const unsigned char* bytes, size_t size,
                         const char* name, rd_report* report)
{
    source s = {bytes, size, "out of memory"};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &s, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    bool ok = info && decode(png, info, &s, image);
    png_destroy_read_struct(png ? &png : NULL, info ? &info : NULL, NULL);
    if (!ok) {
        rd_image_free_u8(image);
        return rd_fail(report, name, "PNG: %s", s.why);
    }
    return true;
}

bool rd_image_write_png(const char* path, int width, int height, const unsigned char* rgb,
                        rd_report* report)
{
    png_image image;
    rd_output out;
    memset(&image, 0, sizeof image);
    image.version = PNG_IMAGE_VERSION;
    image.width = (png_uint_32)width;
    image.height = (png_uint_32)height;
    image.format = PNG_FORMAT_RGB;
    /* A sixth of the time of the defaults for a quarter more bytes. */
    image.flags = PNG_IMAGE_FLAG_FAST;
    if (!rd_output_begin(&out, path, report)) {
        return false;
    }
    if (!png_image_write_to_file(&image, out.temporary, 0, rgb, 0, NULL)) {
        rd_fail(report, path, "PNG: %s", image.message);
    }
    return rd_output_end(&out, !PNG_IMAGE_FAILED(image), report);
}
