/* What lights the scene on the device: records, tables, sky, lists. */
#ifndef RD_VK_LIGHT_H
#define RD_VK_LIGHT_H

#include "render.h"
#include "vk_lists.h"

/* Bindings of the set of lighting: those of shaders/light_loop.glsl, and behind them our own. */
#define RD_VK_BIND_PARAMS     0u
#define RD_VK_BIND_LIGHTS     1u
#define RD_VK_BIND_TILES      2u
#define RD_VK_BIND_CELLS      3u
#define RD_VK_BIND_ENTRIES    4u
#define RD_VK_BIND_MASKS      5u
#define RD_VK_BIND_FGD        6u
#define RD_VK_BIND_SPECULAR   7u
#define RD_VK_BIND_IRRADIANCE 8u
#define RD_VK_BIND_SUN_MASK   9u
#define RD_VK_BIND_VIEWS      10u
#define RD_VK_BIND_ATLAS      11u
#define RD_VK_BIND_SKY        12u
#define RD_VK_BIND_SKY_CUBE   13u
#define RD_VK_BIND_BEHIND     14u
#define RD_VK_BIND_KINDS      15u
#define RD_VK_BIND_DEPTH      16u
#define RD_VK_BIND_LAYERS     17u /* from here on RD_VK_LAYER_... */
#define RD_VK_BIND_BLOCKERS   22u /* four of shaders/light_blockers.glsl */
#define RD_VK_BIND_COUNT      26u

/* A grid of lists in buffers. */
typedef struct rd_vk_grid {
    hdrp_cull_grid grid;
    hdrp_gpu_vk_range tiles, cells, entries, masks;
    uint32_t flags;
} rd_vk_grid;

typedef struct rd_vk_light {
    const rd_lighting* lighting;
    rd_vk_lists lists;
    rd_vk_shadow shadow;
    hdrp_gpu_vk_buffer nothing; /* zeros stand for lists that are not there */
    rd_vk_mapped params[2];     /* of opaque surfaces, of layers */
    hdrp_gpu_vk_image fgd;
    rd_vk_image specular, irradiance, sky, sky_cube;
    rd_vk_image behind, behind_depth; /* the opaque picture */
    rd_vk_image black, black_cube;
    VkSampler clamped, around;
    hdrp_gpu_vk_variants variants;
    hdrp_gpu_vk_tiles tiles;
    hdrp_gpu_vk_lighting desc[2]; /* of opaque surfaces, of layers */
    hdrp_gpu_vk_blockers blockers[2];
    rd_vk_grid grids[2];
    VkDescriptorSetLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet sets[2];
    hdrp_depth_params device_depth;
} rd_vk_light;

/* The layout alone is there for pictures without light. */
bool rd_vk_light_layout_make(rd_vk_light* l, rd_vk_device* d);
bool rd_vk_light_sets_make(rd_vk_light* l, rd_vk_device* d);
void rd_vk_light_set_write(const rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster,
                           int which);
bool rd_vk_light_make(rd_vk_light* l, rd_vk_device* d, const rd_renderer* r,
                      const rd_vk_raster* raster);
void rd_vk_light_free(rd_vk_light* l, rd_vk_device* d);

/* Recording, for each picture. */
bool rd_vk_light_begin(rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster,
                       const hdrp_cull_camera* camera, hdrp_v2 depths, float exposure);
/* The GBuffer is to be sampled, the lit image a storage image. */
bool rd_vk_light_deferred(rd_vk_light* l, rd_vk_device* d, const rd_vk_raster* raster);

#endif
