#include "image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool rd_image_read_f32(rd_image_f32* image, const char* path, rd_report* report)
{
    unsigned char magic[4] = {0, 0, 0, 0};
    FILE* f = fopen(path, "rb");
    size_t n = f ? fread(magic, 1, 4, f) : 0;
    memset(image, 0, sizeof *image);
    if (!f) {
        return rd_fail(report, path, "cannot open");
    }
    fclose(f);
    if (n == 4 && !memcmp(magic, "\x76\x2f\x31\x01", 4)) {
        return rd_image_read_exr(image, path, report);
    }
    if (n == 4 && !memcmp(magic, "#?", 2)) {
        return rd_image_read_hdr(image, path, report);
    }
    return rd_fail(report, path, "neither an OpenEXR nor a Radiance image");
}

void rd_image_free_f32(rd_image_f32* image)
{
    free(image->rgba);
    memset(image, 0, sizeof *image);
}

bool rd_image_decode_u8(rd_image_u8* image, const unsigned char* bytes, size_t size,
                        const char* name, rd_report* report)
{
    memset(image, 0, sizeof *image);
    if (size >= 8 && !memcmp(bytes, "\x89PNG\r\n\x1a\n", 8)) {
        return rd_image_decode_png(image, bytes, size, name, report);
    }
    if (size >= 3 && !memcmp(bytes, "\xff\xd8\xff", 3)) {
        return rd_image_decode_jpeg(image, bytes, size, name, report);
    }
    return rd_fail(report, name, "neither a PNG nor a JPEG image");
}

void rd_image_free_u8(rd_image_u8* image)
{
    free(image->rgba);
    memset(image, 0, sizeof *image);
}
