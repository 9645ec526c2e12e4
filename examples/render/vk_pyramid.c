/* The opaque picture, and its levels, for glass. */
#include "vk_frame.h"

static VkOffset3D corner(uint32_t width, uint32_t height, uint32_t level)
{
    VkOffset3D o = {(int32_t)(width >> level ? width >> level : 1u),
                    (int32_t)(height >> level ? height >> level : 1u), 1};
    return o;
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* Each level is the mean of four texels of the one before. */
static void make_levels(rd_vk_device* d, const rd_vk_image* image)
{
    VkImageMemoryBarrier b = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                              .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                              .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT,
                              .oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                              .newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                              .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                              .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                              .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    b.image = image->base.image;
    for (uint32_t i = 0; i < image->levels; ++i) {
        VkImageBlit blit = {.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i, 0, 1},
                            .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i + 1, 0, 1}};
        b.subresourceRange.baseMipLevel = i;
        vkCmdPipelineBarrier(d->commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1, &b);
        /* Without the last row and column where there is an odd number, as in pyramid.c. */
        blit.dstOffsets[1] = corner(image->base.width_px, image->base.height_px, i + 1);
        blit.srcOffsets[1] = corner(image->base.width_px, image->base.height_px, i);
        blit.srcOffsets[1].x = least(2 * blit.dstOffsets[1].x, blit.srcOffsets[1].x);
        blit.srcOffsets[1].y = least(2 * blit.dstOffsets[1].y, blit.srcOffsets[1].y);
        if (i + 1 < image->levels) {
            vkCmdBlitImage(d->commands, image->base.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           image->base.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                           VK_FILTER_LINEAR);
        }
    }
}

/* Reading the depth that a pass tests against would need a feature. */
static void keep_depth(rd_vk* vk)
{
    rd_vk_device* d = &vk->device;
    const rd_vk_image *depth = &vk->raster.targets[RD_VK_DEPTH], *kept = &vk->light.behind_depth;
    const VkImageCopy whole = {.srcSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1},
                               .dstSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1},
                               .extent = {vk->raster.width, vk->raster.height, 1}};
    rd_vk_layout(d, depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    rd_vk_layout(d, kept, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyImage(d->commands, depth->base.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   kept->base.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole);
    rd_vk_layout(d, depth, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    rd_vk_layout(d, kept, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void rd_vk_keep_opaque(rd_vk* vk)
{
    rd_vk_device* d = &vk->device;
    const rd_vk_image *lit = &vk->raster.targets[RD_VK_LIT], *behind = &vk->light.behind;
    const VkImageCopy whole = {.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                               .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                               .extent = {vk->raster.width, vk->raster.height, 1}};
    rd_vk_layout(d, lit, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    rd_vk_layout(d, behind, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyImage(d->commands, lit->base.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   behind->base.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole);
    make_levels(d, behind);
    keep_depth(vk);
    rd_vk_layout(d, lit, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    rd_vk_layout(d, behind, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    rd_vk_mark(d, "pyramid");
}
