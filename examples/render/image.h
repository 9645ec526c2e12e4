/* Images in memory and on disk. Rows run from top to bottom. */
#ifndef RD_IMAGE_H
#define RD_IMAGE_H

#include "report.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* No picture larger than this is read: 1 GiB as 32-bit float RGBA. */
#define RD_IMAGE_MAX_PIXELS (1u << 26)
#define RD_IMAGE_MAX_SIDE   32768

typedef enum rd_image_layout { RD_LAYOUT_PLAIN, RD_LAYOUT_LATLONG, RD_LAYOUT_CUBE } rd_image_layout;

/* Linear, 32-bit float, RGBA; alpha is 1 where the file has none. */
typedef struct rd_image_f32 {
    int width, height;
    rd_image_layout layout; /* what the file says of itself */
    float* rgba;
} rd_image_f32;

/* 8 bits a channel, RGBA, as stored in the file. */
typedef struct rd_image_u8 {
    int width, height;
    unsigned char* rgba;
} rd_image_u8;

bool rd_image_read_exr(rd_image_f32* image, const char* path, rd_report* report);
bool rd_image_read_hdr(rd_image_f32* image, const char* path, rd_report* report);
/* Either of the two, by content. */
bool rd_image_read_f32(rd_image_f32* image, const char* path, rd_report* report);
void rd_image_free_f32(rd_image_f32* image);

/* PNG or JPEG in memory, by content. `name` is what an error calls it. */
bool rd_image_decode_u8(rd_image_u8* image, const unsigned char* bytes, size_t size,
                        const char* name, rd_report* report);
bool rd_image_decode_png(rd_image_u8* image, const unsigned char* bytes, size_t size,
                         const char* name, rd_report* report);
bool rd_image_decode_jpeg(rd_image_u8* image, const unsigned char* bytes, size_t size,
                          const char* name, rd_report* report);
void rd_image_free_u8(rd_image_u8* image);

/* Both write a temporary file and rename it: the path holds a complete image or what it held. */
bool rd_image_write_exr(const char* path, int width, int height, const float* rgba,
                        rd_report* report);
bool rd_image_write_png(const char* path, int width, int height, const unsigned char* rgb,
                        rd_report* report);

#ifdef __cplusplus
}
#endif
#endif
