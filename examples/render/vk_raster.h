/* Images that are drawn to, render passes and pipelines. */
#ifndef RD_VK_RASTER_H
#define RD_VK_RASTER_H

#include "vk_device.h"

/* Colours that a pass draws to, at most. */
#define RD_VK_COLORS_MAX 7u

typedef enum rd_vk_target {
    RD_VK_RT0,
    RD_VK_RT1,
    RD_VK_RT2,
    RD_VK_RT3,
    RD_VK_RT4,
    RD_VK_KINDS,       /* rd_pixel_kind */
    RD_VK_NORMALS,     /* of triangles, for shadows */
    RD_VK_LIT,         /* luminance times exposure, coverage */
    RD_VK_LAYER_LIGHT, /* of layers alone */
    RD_VK_LAYER_THROUGH,
    RD_VK_LAYER_MOVED,
    RD_VK_LAYER_MOST,
    RD_VK_LAYER_DIRECTION,
    RD_VK_DEPTH, /* reverse */
    RD_VK_TARGET_COUNT
} rd_vk_target;

typedef enum rd_vk_pass {
    RD_VK_PASS_DEPTH,   /* cleared */
    RD_VK_PASS_GBUFFER, /* cleared, over the depth */
    RD_VK_PASS_LIT,     /* loaded, depth is only tested, as in what follows */
    RD_VK_PASS_LAYERS,  /* cleared */
    RD_VK_PASS_BEHIND,  /* cleared */
    RD_VK_PASS_COUNT
} rd_vk_pass;

typedef struct rd_vk_raster {
    uint32_t width, height;
    rd_vk_image targets[RD_VK_TARGET_COUNT];
    VkRenderPass passes[RD_VK_PASS_COUNT];
    VkFramebuffer framebuffers[RD_VK_PASS_COUNT];
    VkPipelineLayout layout;
} rd_vk_raster;

/* The layout has the sets of descriptors, and push constants of 16 bytes for both stages. */
bool rd_vk_raster_make(rd_vk_raster* r, rd_vk_device* d, uint32_t width, uint32_t height,
                       const VkDescriptorSetLayout* sets, uint32_t set_count);
void rd_vk_raster_free(rd_vk_raster* r, rd_vk_device* d);

/* Recording. Images are in the layouts of attachments at begin and at end. */
void rd_vk_pass_begin(const rd_vk_raster* r, rd_vk_device* d, rd_vk_pass pass);
void rd_vk_pass_end(rd_vk_device* d);

/* >>render passes of others */

/* An attachment that is stored; where it is loaded, it is in that layout before too. */
VkAttachmentDescription rd_vk_attachment(VkFormat format, VkAttachmentLoadOp load,
                                         VkImageLayout layout);
/* A pass of up to RD_VK_COLORS_MAX colours and, behind them, a depth, in the layout that it is used
 * in. All that was recorded before is done first, and all that comes after waits. */
bool rd_vk_pass_make(rd_vk_device* d, const VkAttachmentDescription* attachments, uint32_t colors,
                     VkImageLayout depth, VkRenderPass* out);
/* The images that it draws to, in the order of attachments. */
bool rd_vk_framebuffer_make(rd_vk_device* d, VkRenderPass pass, const VkImageView* views,
                            uint32_t count, uint32_t width, uint32_t height, VkFramebuffer* out);

/* >>pipelines */

typedef struct rd_vk_code {
    const uint32_t* words;
    size_t bytes;
} rd_vk_code;

typedef enum rd_vk_blend {
    RD_VK_BLEND_NONE,
    RD_VK_BLEND_OVER,  /* premultiplied alpha */
    RD_VK_BLEND_LAYER, /* second output: what is let through */
    RD_VK_BLEND_BEHIND /* of bend.frag: product, sum, largest, last */
} rd_vk_blend;

typedef struct rd_vk_pipeline_desc {
    rd_vk_code vertex, fragment; /* no fragment code: depth alone */
    rd_vk_pass pass;
    VkRenderPass other_pass; /* in place of `pass` and `blend`, with a blend state each */
    const VkPipelineColorBlendAttachmentState* blends;
    uint32_t blend_count;
    VkCompareOp compare;
    bool writes_depth, clamps_depth;
    rd_vk_blend blend;
    const uint32_t* constants; /* for the fragment shader, from constant_id 0 on */
    uint32_t constant_count;
} rd_vk_pipeline_desc;

bool rd_vk_pipeline_make(const rd_vk_raster* r, rd_vk_device* d, const rd_vk_pipeline_desc* desc,
                         VkPipeline* out);

#endif
