/* --backend vulkan: the passes of a frame on a GPU, or on Mesa's lavapipe where there is none. */
#ifndef RD_VK_BACKEND_H
#define RD_VK_BACKEND_H

#include "render.h"

typedef struct rd_vk rd_vk;

/* Uploads the scene of a renderer. NULL, with an error, where Vulkan or a device is missing, where
 * the device lacks something, and where what is asked for is not done by this backend. */
rd_vk* rd_vk_open(rd_renderer* r, rd_report* report);
/* As rd_render. The mode of --oit may be another one than before. */
bool rd_vk_render(rd_vk* vk, rd_renderer* r, const rd_camera* camera);
void rd_vk_close(rd_vk* vk);

/* Limits that were hit. */
void rd_vk_count(const rd_vk* vk, rd_stats* stats);

const char* rd_vk_device_name(const rd_vk* vk);
/* Of validation layers; 0 where they were not asked for. */
unsigned rd_vk_messages(const rd_vk* vk);

#endif
