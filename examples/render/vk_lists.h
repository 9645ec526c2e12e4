/* Records of lights on the device, and lists of those that reach tiles and clusters. */
#ifndef RD_VK_LISTS_H
#define RD_VK_LISTS_H

#include "render.h"
#include "vk_raster.h"
#include "vk_shadow.h"

typedef struct rd_vk_lists {
    hdrp_light* items; /* those of lists, then directional ones */
    uint32_t listed, directional;
    bool ready;        /* lists are built; else surfaces visit all lights */
    uint32_t left_out; /* all lights, where they are too many for lists */
    hdrp_gpu_vk_buffer records, shapes;
    bool blocked; /* by blockers of the scene; of each record its place and where its links are */
    hdrp_gpu_vk_buffer places, own_links, links, blockers;
    hdrp_gpu_vk_buffer blocker_masks[2]; /* of grids */
    hdrp_gpu_vk_lists grids[2];          /* tiles, for opaque surfaces; clusters, for layers */
    rd_vk_mapped dropped[2];
} rd_vk_lists;

bool rd_vk_lists_make(rd_vk_lists* l, rd_vk_device* d, const rd_renderer* r, rd_vk_shadow* shadow);
void rd_vk_lists_free(rd_vk_lists* l, rd_vk_device* d);
/* Recording. */
bool rd_vk_lists_build(rd_vk_lists* l, rd_vk_device* d, const rd_vk_raster* raster,
                       const hdrp_cull_camera* camera, const hdrp_depth_params* device);
/* What keeps lights away, where the scene has that; without lists there are no masks. */
hdrp_gpu_vk_blockers rd_vk_lists_blockers(const rd_vk_lists* l, int which);
/* Lights that the last lists had no room for. */
uint64_t rd_vk_lists_dropped(const rd_vk_lists* l);

#endif
