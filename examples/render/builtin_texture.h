/* Textures of the built-in scene, computed texel by texel. */
#ifndef RD_BUILTIN_TEXTURE_H
#define RD_BUILTIN_TEXTURE_H

#include "texture.h"

typedef enum rd_builtin_texture {
    RD_TEX_FLOOR_COLOR, /* worn concrete, nearly even */
    RD_TEX_FLOOR_ROUGHNESS,
    RD_TEX_BRUSHED,      /* roughness streaks along u */
    RD_TEX_FLAKES,       /* normals of metal flakes under a coat */
    RD_TEX_HAMMERED,     /* normals of small dents, sharp when far away */
    RD_TEX_WEAVE_NORMAL, /* plain weave */
    RD_TEX_WEAVE_COLOR,  /* its stripes */
    RD_TEX_LEAF,         /* colour and alpha of a leaf with its stem */
    RD_TEX_SCREEN,       /* alpha of a perforated sheet */
    RD_TEX_FILM,         /* thickness of a soap film, in green */
    RD_TEX_ROCK_COLOR,
    RD_TEX_ROCK_COARSE, /* normals for triplanar layers */
    RD_TEX_ROCK_FINE,
    RD_TEX_LABEL,    /* alpha and colour of a faded ring */
    RD_TEX_SMOKE,    /* alpha of a puff */
    RD_TEX_GLOW,     /* alpha of a bright point in its halo */
    RD_TEX_HOLOGRAM, /* alpha of lines on a sheet that fades out */
    RD_TEX_COUNT
} rd_builtin_texture;

/* Makes all of them, indexed by the enum, ready for rd_textures_prepare. */
bool rd_builtin_textures(rd_texture_set* set);

#endif
