#include "image.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

/* A block of 64 pixels takes at least a bit in a file; progressive files reach near that. */
#define MAX_PIXELS_PER_BYTE 1024

typedef struct decoder {
    struct jpeg_error_mgr base;
    jmp_buf jump;
    char why[JMSG_LENGTH_MAX];
} decoder;

static void on_error(j_common_ptr c)
{
    decoder* d = (decoder*)(void*)c->err;
    c->err->format_message(c, d->why);
    longjmp(d->jump, 1);
}

/* libjpeg only warns when the data are corrupt or end early, and invents the rest. */
static void on_message(j_common_ptr c, int level)
{
    if (level < 0) {
        on_error(c);
    }
}

static void fail(j_decompress_ptr c, const char* why)
{
    decoder* d = (decoder*)(void*)c->err;
    snprintf(d->why, sizeof d->why, "%s", why);
    longjmp(d->jump, 1);
}

static void check_size(j_decompress_ptr c, size_t file_size)
{
    uint64_t pixels = (uint64_t)c->image_width * c->image_height;
    if (c->image_width > RD_IMAGE_MAX_SIDE || c->image_height > RD_IMAGE_MAX_SIDE ||
        pixels > RD_IMAGE_MAX_PIXELS) {
        fail(c, "too many pixels");
    }
    if (pixels / MAX_PIXELS_PER_BYTE > file_size) {
        fail(c, "too little data for its size");
    }
}

static bool decode(j_decompress_ptr c, decoder* d, const unsigned char* bytes, size_t size,
                   rd_image_u8* image)
{
    if (setjmp(d->jump)) {
        return false;
    }
    jpeg_create_decompress(c);
    jpeg_mem_src(c, bytes, (unsigned long)size);
    jpeg_read_header(c, TRUE);
    check_size(c, size);
    c->out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(c);
    image->width = (int)c->output_width;
    image->height = (int)c->output_height;
    image->rgba = (unsigned char*)calloc((size_t)image->width * (size_t)image->height, 4);
    if (!image->rgba) {
        fail(c, "out of memory");
    }
    while (c->output_scanline < c->output_height) {
        JSAMPROW row = image->rgba + (size_t)c->output_scanline * (size_t)image->width * 4;
        jpeg_read_scanlines(c, &row, 1);
    }
    jpeg_finish_decompress(c);
    return true;
}

bool rd_image_decode_jpeg(rd_image_u8* image, const unsigned char* bytes, size_t size,
                          const char* name, rd_report* report)
{
    struct jpeg_decompress_struct c;
    decoder d;
    bool ok;
    memset(&c, 0, sizeof c);
    memset(&d, 0, sizeof d);
    c.err = jpeg_std_error(&d.base);
    d.base.error_exit = on_error;
    d.base.emit_message = on_message;
    ok = decode(&c, &d, bytes, size, image);
    jpeg_destroy_decompress(&c);
    if (!ok) {
        rd_image_free_u8(image);
        return rd_fail(report, name, "JPEG: %s", d.why);
    }
    return true;
}
