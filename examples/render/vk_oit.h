/* Blended surfaces without sorting, on the device: their targets, passes and pipelines. */
#ifndef RD_VK_OIT_H
#define RD_VK_OIT_H

#include "render.h"
#include "vk_raster.h"

#define RD_VK_OIT_PASSES 3u
#define RD_VK_OIT_READ   6u /* targets that later passes read; behind them the depth */

/* The picture, or what is lit at half of its resolution. */
typedef struct rd_vk_oit_layer {
    uint32_t width, height;
    rd_vk_image targets[HDRP_OIT_TARGETS_MAX];
    VkFramebuffer framebuffers[RD_VK_OIT_PASSES];
    VkDescriptorSet sets[RD_VK_OIT_PASSES];
} rd_vk_oit_layer;

typedef struct rd_vk_oit {
    bool present; /* with --oit other than sorted */
    rd_oit made_for;
    hdrp_oit_mode mode;
    uint32_t pass_count, target_count, layer_count;
    hdrp_oit_target targets[HDRP_OIT_TARGETS_MAX];
    rd_vk_oit_layer layers[2];
    rd_vk_image low_depth;
    VkRenderPass passes[RD_VK_OIT_PASSES], depth_pass;
    VkFramebuffer depth_framebuffer;
    VkPipeline pipelines[RD_VK_OIT_PASSES], depth_pipeline;
    VkDescriptorSetLayout set_layout; /* there without the rest too */
    VkDescriptorPool pool;
} rd_vk_oit;

bool rd_vk_oit_layout_make(rd_vk_oit* o, rd_vk_device* d);
/* For the mode of the options, in place of what was made for another one. False, with an error that
 * names what the device lacks for it. `nothing` is any image that is to be sampled. */
bool rd_vk_oit_make(rd_vk_oit* o, rd_vk_device* d, const rd_renderer* r, const rd_vk_raster* raster,
                    const rd_vk_image* nothing);
void rd_vk_oit_free(rd_vk_oit* o, rd_vk_device* d);

/* Targets of a pass, from the first on. */
uint32_t rd_vk_oit_pass_first(const rd_vk_oit* o, uint32_t pass);

/* Recording. Targets are left to be sampled. */
void rd_vk_oit_pass_begin(const rd_vk_oit* o, rd_vk_device* d, uint32_t layer, uint32_t pass);
void rd_vk_oit_depth_begin(const rd_vk_oit* o, rd_vk_device* d);
/* Over the lit picture, in the layout of an attachment. */
bool rd_vk_oit_compose(const rd_vk_oit* o, rd_vk_device* d, const rd_vk_raster* raster);

#endif
