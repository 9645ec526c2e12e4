/* The scene on the device: vertices, materials, textures. */
#ifndef RD_VK_SCENE_H
#define RD_VK_SCENE_H

#include "scene.h"
#include "vk_device.h"
#include "vk_shared.h"

/* As in shaders/scene.glsl. */
typedef struct rd_vk_mesh {
    uint32_t data[4], uv[4], more[4];
} rd_vk_mesh;

typedef struct rd_vk_slot {
    hdrp_v4 u_row, v_row, size;
} rd_vk_slot;

typedef struct rd_vk_material {
    hdrp_v4 base_alpha, emission_cutoff, surface, coat, film, specular, optics, volume, turn, slab;
    uint32_t bits[4];
    hdrp_v4 detail;
    uint32_t details[4];
    rd_vk_slot slots[RD_GPU_SLOT_COUNT];
    hdrp_v4 detail_size[RD_GPU_DETAILS];
} rd_vk_material;

typedef struct rd_vk_scene {
    const rd_scene* scene;
    hdrp_gpu_vk_buffer meshes, materials, vertices, indices;
    rd_vk_image* textures;       /* two more than the scene has: white */
    VkSampler samplers[2][3][3]; /* by rd_texture.is_nearest, wrap_u, wrap_v */
    VkDescriptorSetLayout material_layout;
    VkDescriptorPool pool;
    VkDescriptorSet* material_sets;
    hdrp_v4* balls; /* around each mesh */
} rd_vk_scene;

bool rd_vk_scene_make(rd_vk_scene* s, rd_vk_device* d, const rd_scene* scene);
void rd_vk_scene_free(rd_vk_scene* s, rd_vk_device* d);

#endif
