/* The GBuffer in its real memory layout, and what a pixel needs beside it. */
#ifndef RD_GBUFFER_H
#define RD_GBUFFER_H

#include "hdrp_pack.h"
#include "scene.h"

#include <stddef.h>
#include <stdint.h>

/* What a stencil says of a pixel. */
typedef enum rd_pixel_kind {
    RD_PIXEL_SKY,
    RD_PIXEL_DEFERRED,
    RD_PIXEL_FORWARD /* a material that no layout holds */
} rd_pixel_kind;

/* Besides RT0 to RT3: ambient occlusion and light layers. */
#define RD_GBUFFER_TARGETS HDRP_PACK_GBUFFER_RT4

typedef struct rd_gbuffer {
    hdrp_pack_gbuffer_texel* texels;
    hdrp_v3* positions;         /* as the depth buffer has them */
    hdrp_v3* geometric_normals; /* of the triangles, for the offset of rays */
    uint8_t* kinds;             /* rd_pixel_kind */
} rd_gbuffer;

bool rd_gbuffer_allocate(rd_gbuffer* g, size_t pixels);
void rd_gbuffer_free(rd_gbuffer* g);

/* Emission in nits; the texel holds it times the exposure, which keeps it inside its range. */
hdrp_pack_gbuffer_texel rd_gbuffer_encode(hdrp_brdf_data data, hdrp_v3 emission_nits,
                                          hdrp_u32 light_layers, float exposure);
/* The scene has the diffusion profiles, of which texels hold the index. */
hdrp_brdf_data rd_gbuffer_decode(hdrp_pack_gbuffer_texel texel, const rd_scene* scene);
hdrp_v3 rd_gbuffer_decode_emission(hdrp_pack_gbuffer_texel texel, float exposure);
hdrp_u32 rd_gbuffer_decode_light_layers(hdrp_pack_gbuffer_texel texel);

/* Only what passes before lighting read of a forward material: normal and roughness. */
hdrp_pack_gbuffer_texel rd_gbuffer_encode_normal(hdrp_brdf_data data);
hdrp_v3 rd_gbuffer_decode_normal(hdrp_pack_gbuffer_texel texel);

#endif
