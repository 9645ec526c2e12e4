#include "image.h"

#include "file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The first bytes of a regular file; zeros where it has none. */
static void read_magic(const char* path, unsigned char magic[4])
{
    uint64_t size;
    FILE* f = rd_file_size(path, &size) ? fopen(path, "rb") : NULL;
    memset(magic, 0, 4);
    if (f && fread(magic, 1, 4, f) != 4) {
        memset(magic, 0, 4);
    }
    if (f) {
        fclose(f);
    }
}

bool rd_image_read_f32(rd_image_f32* image, const char* path, rd_report* report)
{
    unsigned char magic[4];
    uint64_t size;
    read_magic(path, magic);
    memset(image, 0, sizeof *image);
    if (!memcmp(magic, "\x76\x2f\x31\x01", 4)) {
        return rd_image_read_exr(image, path, report);
    }
    if (!memcmp(magic, "#?", 2)) {
        return rd_image_read_hdr(image, path, report);
    }
    return rd_fail(report, path,
                   rd_file_size(path, &size) ? "neither an OpenEXR nor a Radiance image"
                                             : "no such file");
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
