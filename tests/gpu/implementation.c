/* implementation.c - the algorithms that the tests of the GPU call. SPDX-License-Identifier: MIT */
#include "hdrp_gpu_vk.h" /* bodies may be asked for later */
#define HDRP_BRDF_IMPLEMENTATION
#define HDRP_CULL_IMPLEMENTATION
#define HDRP_ENV_IMPLEMENTATION
#define HDRP_GPU_VK_IMPLEMENTATION
#define HDRP_OIT_IMPLEMENTATION
#define HDRP_SHADOW_IMPLEMENTATION
#include "hdrp_brdf.h"
#include "hdrp_env.h"
#include "hdrp_gpu_vk.h"
#include "hdrp_oit.h"
#include "hdrp_shadow.h"
