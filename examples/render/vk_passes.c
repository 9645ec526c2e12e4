/* The passes of hdrp_gpu_vk.h. */
#include "vk_api.h"
#define HDRP_SHADOW_IMPLEMENTATION
#define HDRP_GPU_VK_IMPLEMENTATION
#include "hdrp_gpu_vk.h"
