/* In builds without the headers of Vulkan. */
#include "vk_backend.h"

rd_vk* rd_vk_open(rd_renderer* r, rd_report* report)
{
    (void)r;
    rd_fail(report, "--backend",
            "vulkan: this program was built without it (Debian: libvulkan-dev, "
            "glslang-tools)");
    return NULL;
}

bool rd_vk_render(rd_vk* vk, rd_renderer* r, const rd_camera* camera)
{
    (void)vk;
    (void)r;
    (void)camera;
    return false;
}

void rd_vk_close(rd_vk* vk)
{
    (void)vk;
}

void rd_vk_count(const rd_vk* vk, rd_stats* stats)
{
    (void)vk;
    (void)stats;
}

unsigned rd_vk_messages(const rd_vk* vk)
{
    (void)vk;
    return 0;
}

const char* rd_vk_device_name(const rd_vk* vk)
{
    (void)vk;
    return "";
}
