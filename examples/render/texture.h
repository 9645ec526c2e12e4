/* Textures: 8-bit RGBA with mip chains, decoded in parallel, sampled with filtering. */
#ifndef RD_TEXTURE_H
#define RD_TEXTURE_H

#include "hdrp_math.h"
#include "image.h"
#include "report.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RD_TEXTURE_MAX_LEVELS 16
#define RD_TEXTURES_MAX_BYTES ((size_t)4 << 30)

typedef enum rd_wrap { RD_WRAP_REPEAT, RD_WRAP_CLAMP, RD_WRAP_MIRROR } rd_wrap;

typedef struct rd_texture {
    int width, height, level_count;
    bool is_srgb;   /* colour channels hold sRGB codes; alpha is always linear */
    bool is_normal; /* mips hold the average vector, not a unit one: its length tells the spread */
    bool is_nearest;
    rd_wrap wrap_u, wrap_v;
    unsigned char* level[RD_TEXTURE_MAX_LEVELS]; /* slices of one block, at level[0] */
    /* Until rd_textures_prepare: either compressed bytes and what errors call them, or texels. */
    unsigned char* encoded;
    size_t encoded_size;
    char* name;
    rd_image_u8 image;
} rd_texture;

typedef struct rd_texture_set {
    rd_texture* items;
    int count;
    size_t memory; /* bytes of all levels */
} rd_texture_set;

/* Decodes what is still encoded and builds the mip chains, one job a texture. */
bool rd_textures_prepare(rd_texture_set* set, rd_report* report);
void rd_textures_free(rd_texture_set* set);

/* Linear RGBA at uv (the origin is the upper left corner, as in glTF), filtered for a footprint
 * with the given derivatives: trilinear, with up to 4 probes along the longer axis. */
hdrp_v4 rd_texture_sample(const rd_texture* t, hdrp_v2 uv, hdrp_v2 d_dx, hdrp_v2 d_dy);

/* Texels of the finest level that such a footprint is long. */
float rd_texture_footprint(const rd_texture* t, hdrp_v2 d_dx, hdrp_v2 d_dy);

/* Bilinear at the finest level: for alpha tests, where averages would change the coverage. */
hdrp_v4 rd_texture_sample_finest(const rd_texture* t, hdrp_v2 uv);

#ifdef __cplusplus
}
#endif
#endif
