/* Shadow maps of the lights: an atlas, drawn once for lights that stand still and once a picture for
 * the cascades of directional ones. */
#ifndef RD_VK_SHADOW_H
#define RD_VK_SHADOW_H

#include "render.h"
#include "vk_raster.h"

typedef struct rd_vk_shadow {
    bool present;
    uint32_t view_count;
    uint32_t
        cascades[HDRP_GPU_VK_SHADOW_LIGHTS]; /* views of each directional light, which are first */
    uint32_t masked;                         /* directional lights that have some */
    uint32_t without;                        /* lights that got no map */
    uint32_t* light_of_view;                 /* record */
    hdrp_u32x4* maps;
    hdrp_shadow_view* views; /* also in the buffer */
    rd_vk_mapped buffer;
    rd_vk_image atlas;
    hdrp_gpu_vk_image visibility; /* of directional lights, by pixel */
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    bool still_drawn; /* maps of lights that stand still are there */
} rd_vk_shadow;

/* Gives the records their first view, or takes their shadow away. Directional ones are the last. */
bool rd_vk_shadow_make(rd_vk_shadow* s, rd_vk_device* d, const rd_renderer* r, hdrp_light* records,
                       uint32_t listed, uint32_t directional);
void rd_vk_shadow_free(rd_vk_shadow* s, rd_vk_device* d);
/* The cascades for a camera. */
bool rd_vk_shadow_aim(rd_vk_shadow* s, rd_vk_device* d, const rd_renderer* r,
                      const hdrp_light* records);

#endif
