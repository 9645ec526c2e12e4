/* What the passes of the Vulkan backend share. */
#ifndef RD_VK_FRAME_H
#define RD_VK_FRAME_H

#include "frame.h"
#include "vk_backend.h"
#include "vk_light.h"
#include "vk_oit.h"
#include "vk_raster.h"
#include "vk_scene.h"

/* As in shaders/scene.glsl. */
typedef struct rd_vk_frame {
    hdrp_v4 eye_step, right_half_width, up_half_height, forward_orthographic;
    hdrp_v4 jitter_size, depths_exposure;
    uint32_t bits[4], sample_of[4];
    hdrp_v4 sky, to_sun, sun_nits;
} rd_vk_frame;

/* Triangles of one mesh, of those that are sorted. */
typedef struct rd_vk_run {
    uint32_t mesh, first, count;
} rd_vk_batch;

/* What is seen through, from back to front. */
typedef struct rd_vk_order {
    uint32_t capacity, count; /* triangles */
    uint32_t run_count;
    void* keys;
    rd_vk_batch* runs;
    rd_vk_mapped buffer; /* triangles of their meshes */
} rd_vk_order;

typedef enum rd_vk_program {
    RD_VK_PROGRAM_DEPTH,
    RD_VK_PROGRAM_MASK,
    RD_VK_PROGRAM_GBUFFER,
    RD_VK_PROGRAM_VIEW,
    RD_VK_PROGRAM_VIEW_LAYER,
    RD_VK_PROGRAM_FORWARD,
    RD_VK_PROGRAM_SKY,
    RD_VK_PROGRAM_LAYER,       /* over the opaque picture */
    RD_VK_PROGRAM_LAYER_APART, /* where some bend or scatter what is behind them */
    RD_VK_PROGRAM_BEND,
    RD_VK_PROGRAM_COMPOSITE,
    RD_VK_PROGRAM_COUNT
} rd_vk_program;

struct rd_vk {
    rd_vk_device device;
    rd_vk_scene scene;
    rd_vk_raster raster;
    rd_vk_order order;
    rd_vk_light light;
    rd_vk_oit oit;
    rd_vk_mapped frame;   /* rd_vk_frame */
    rd_vk_mapped picture; /* what is read back */
    VkDescriptorSetLayout frame_layout;
    VkDescriptorPool pool;
    VkDescriptorSet frame_set;
    VkPipeline programs[RD_VK_PROGRAM_COUNT], casters[2][2], bound;
    rd_vk_frame values;
    const rd_options* options;
    uint64_t dropped; /* lights that lists had no room for */
};

/* What forward lighting is compiled for, beside materials. */
#define RD_VK_FORWARD_WORD (HDRP_GPU_VK_WORD_ALL & ~HDRP_GPU_VK_WORD_NEGATIVE)

/* vk_frame.c */
bool rd_vk_is_lit(const rd_renderer* r);
void rd_vk_fill_frame(rd_vk* vk, const rd_sub_frame* s);

/* vk_order.c */
bool rd_vk_order_make(rd_vk* vk);
void rd_vk_order_free(rd_vk* vk);
void rd_vk_order_sort(rd_vk* vk, const rd_camera* camera);

/* vk_draw.c */
/* Which opaque meshes. */
typedef enum rd_vk_choice {
    RD_VK_ALL,
    RD_VK_SOLID,
    RD_VK_MASKED,
    RD_VK_FORWARD /* that a GBuffer may not hold */
} rd_vk_choice;

/* Of one triangle over the picture, or of meshes. */
rd_vk_code rd_vk_vertex_code(bool screen);
void rd_vk_programs_free(rd_vk* vk);
/* `light`: which set of lighting; 1 is that of layers. */
void rd_vk_bind_frame(rd_vk* vk, int light);
void rd_vk_draw_meshes(rd_vk* vk, rd_vk_program program, rd_vk_choice choice);
/* All of a mesh, or a run of its sorted triangles, with the pipeline that is bound. */
typedef struct rd_vk_piece {
    uint32_t mesh, first, count;
    bool ordered, low; /* into targets of half the resolution */
} rd_vk_piece;

void rd_vk_draw_piece(rd_vk* vk, const rd_vk_piece* piece);
/* The sorted triangles. */
void rd_vk_draw_layers(rd_vk* vk, rd_vk_program program);
/* RD_VK_PROGRAM_SKY and _COMPOSITE. */
void rd_vk_draw_screen(rd_vk* vk, rd_vk_program program);
/* Materials of layers through which light refracts. */
bool rd_vk_has_glass(const rd_vk* vk);

/* vk_blended.c */
/* Has the scene surfaces that are blended without sorting? Are they shown? */
bool rd_vk_has_blended(const rd_vk* vk);
/* All passes of the mode, in both resolutions, over the lit picture. */
bool rd_vk_draw_blended(rd_vk* vk);

/* vk_pyramid.c */
void rd_vk_keep_opaque(rd_vk* vk);

/* vk_casters.c */
void rd_vk_draw_shadows(rd_vk* vk);
void rd_vk_casters_free(rd_vk* vk);

#endif
