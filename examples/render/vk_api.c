#include "vk_api.h"

#include <dlfcn.h>
#include <string.h>

#define DEFINE(name) PFN_vk##name vk##name;
RD_VK_GLOBAL_FUNCTIONS(DEFINE)
RD_VK_INSTANCE_FUNCTIONS(DEFINE)
RD_VK_DEVICE_FUNCTIONS(DEFINE)
#undef DEFINE
PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr;

bool rd_vk_load(void)
{
    void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    void* symbol = library ? dlsym(library, "vkGetInstanceProcAddr") : NULL;
    if (!symbol) {
        return false;
    }
    /* ISO C has no conversion from an object pointer to that of a function. */
    memcpy(&vkGetInstanceProcAddr, &symbol, sizeof symbol);
#define LOAD(name) vk##name = (PFN_vk##name)vkGetInstanceProcAddr(NULL, "vk" #name);
    RD_VK_GLOBAL_FUNCTIONS(LOAD)
#undef LOAD
    return vkCreateInstance != NULL;
}

void rd_vk_load_instance(VkInstance instance)
{
#define LOAD(name) vk##name = (PFN_vk##name)vkGetInstanceProcAddr(instance, "vk" #name);
    RD_VK_INSTANCE_FUNCTIONS(LOAD)
#undef LOAD
}

void rd_vk_load_device(VkDevice device)
{
#define LOAD(name) vk##name = (PFN_vk##name)vkGetDeviceProcAddr(device, "vk" #name);
    RD_VK_DEVICE_FUNCTIONS(LOAD)
#undef LOAD
}
