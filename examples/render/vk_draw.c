/* Pipelines that draw meshes, and their draws. */
#include "vk_frame.h"

#include "bend_frag.h"
#include "composite_frag.h"
#include "forward_frag.h"
#include "gbuffer_frag.h"
#include "layer_frag.h"
#include "mask_frag.h"
#include "mesh_vert.h"
#include "screen_vert.h"
#include "sky_frag.h"
#include "view_frag.h"

#include <string.h>

#define CODE(name)                                                                                 \
    {                                                                                              \
        spirv_##name, sizeof spirv_##name                                                          \
    }

/* >>pipelines */

static const struct {
    rd_vk_pass pass;
    rd_vk_code fragment;
    VkCompareOp compare;
    bool writes_depth;
    rd_vk_blend blend;
} programs[RD_VK_PROGRAM_COUNT] = {
    [RD_VK_PROGRAM_DEPTH] =
        {RD_VK_PASS_DEPTH, {NULL, 0}, VK_COMPARE_OP_GREATER, true, RD_VK_BLEND_NONE},
    [RD_VK_PROGRAM_MASK] = {RD_VK_PASS_DEPTH, CODE(mask_frag), VK_COMPARE_OP_GREATER, true,
                            RD_VK_BLEND_NONE},
    [RD_VK_PROGRAM_GBUFFER] = {RD_VK_PASS_GBUFFER, CODE(gbuffer_frag), VK_COMPARE_OP_EQUAL, false,
                               RD_VK_BLEND_NONE},
    [RD_VK_PROGRAM_VIEW] = {RD_VK_PASS_LIT, CODE(view_frag), VK_COMPARE_OP_EQUAL, false,
                            RD_VK_BLEND_NONE},
    [RD_VK_PROGRAM_VIEW_LAYER] = {RD_VK_PASS_LIT, CODE(view_frag), VK_COMPARE_OP_GREATER, false,
                                  RD_VK_BLEND_OVER},
    [RD_VK_PROGRAM_FORWARD] = {RD_VK_PASS_LIT, CODE(forward_frag), VK_COMPARE_OP_EQUAL, false,
                               RD_VK_BLEND_NONE},
    [RD_VK_PROGRAM_SKY] = {RD_VK_PASS_LIT, CODE(sky_frag), VK_COMPARE_OP_EQUAL, false,
                           RD_VK_BLEND_NONE},
    [RD_VK_PROGRAM_LAYER] = {RD_VK_PASS_LIT, CODE(layer_frag), VK_COMPARE_OP_GREATER, false,
                             RD_VK_BLEND_LAYER},
    [RD_VK_PROGRAM_LAYER_APART] = {RD_VK_PASS_LAYERS, CODE(layer_frag), VK_COMPARE_OP_GREATER,
                                   false, RD_VK_BLEND_LAYER},
    [RD_VK_PROGRAM_BEND] = {RD_VK_PASS_BEHIND, CODE(bend_frag), VK_COMPARE_OP_GREATER, false,
                            RD_VK_BLEND_BEHIND},
    [RD_VK_PROGRAM_COMPOSITE] = {RD_VK_PASS_LIT, CODE(composite_frag), VK_COMPARE_OP_ALWAYS, false,
                                 RD_VK_BLEND_NONE},
};

rd_vk_code rd_vk_vertex_code(bool screen)
{
    static const rd_vk_code of_screen = CODE(screen_vert), of_meshes = CODE(mesh_vert);
    return screen ? of_screen : of_meshes;
}

/* Features of the materials that a program may meet. */
static hdrp_u32 features_of(const rd_vk* vk, rd_vk_program program)
{
    const rd_scene* scene = vk->scene.scene;
    hdrp_u32 features = 0u;
    for (int i = 0; i < scene->material_count; ++i) {
        const rd_material* m = &scene->materials[i];
        if (rd_material_is_layer(m) == (program != RD_VK_PROGRAM_FORWARD)) {
            features |= m->features;
        }
    }
    return features & vk->values.bits[1];
}

/* Made when a draw first needs it: compiling takes time. Without, the report says why. */
static VkPipeline pipeline_of(rd_vk* vk, rd_vk_program program)
{
    VkPipeline* p = &vk->programs[program];
    bool screen = program == RD_VK_PROGRAM_SKY || program == RD_VK_PROGRAM_COMPOSITE;
    const uint32_t constants[3] = {features_of(vk, program),
                                   program == RD_VK_PROGRAM_BEND ? 0u : RD_VK_FORWARD_WORD,
                                   rd_vk_is_coarse(&vk->device)};
    rd_vk_pipeline_desc desc;
    if (*p || vk->device.report->failed) {
        return *p;
    }
    memset(&desc, 0, sizeof desc);
    desc.vertex = rd_vk_vertex_code(screen);
    desc.constants = constants;
    desc.constant_count = 3;
    desc.fragment = programs[program].fragment;
    desc.pass = programs[program].pass;
    desc.compare = programs[program].compare;
    desc.writes_depth = programs[program].writes_depth;
    desc.blend = programs[program].blend;
    rd_vk_pipeline_make(&vk->raster, &vk->device, &desc, p);
    return *p;
}

void rd_vk_programs_free(rd_vk* vk)
{
    for (int i = 0; vk->device.device && i < RD_VK_PROGRAM_COUNT; ++i) {
        vkDestroyPipeline(vk->device.device, vk->programs[i], NULL);
    }
}

/* >>draws */

void rd_vk_draw_piece(rd_vk* vk, const rd_vk_piece* piece)
{
    int material = vk->scene.scene->meshes[piece->mesh].material;
    VkCommandBuffer commands = vk->device.commands;
    const uint32_t push[4] = {piece->mesh, piece->ordered, 0, piece->low};
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, vk->raster.layout, 1, 1,
                            &vk->scene.material_sets[material], 0, NULL);
    vkCmdPushConstants(commands, vk->raster.layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                       push);
    vkCmdDraw(commands, piece->count * 3, 1, piece->first * 3, 0);
}

static void draw(rd_vk* vk, rd_vk_program program, const rd_vk_piece* piece)
{
    VkPipeline p = pipeline_of(vk, program);
    if (!p) {
        return;
    }
    if (p != vk->bound) {
        vkCmdBindPipeline(vk->device.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p);
        vk->bound = p;
    }
    rd_vk_draw_piece(vk, piece);
}

void rd_vk_bind_frame(rd_vk* vk, int light)
{
    vk->bound = VK_NULL_HANDLE;
    vkCmdBindDescriptorSets(vk->device.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, vk->raster.layout,
                            0, 1, &vk->frame_set, 0, NULL);
    if (vk->light.sets[light]) {
        vkCmdBindDescriptorSets(vk->device.commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                                vk->raster.layout, 2, 1, &vk->light.sets[light], 0, NULL);
    }
}

/* The standard layout holds all that has no feature. */
static bool may_be_forward(const rd_vk* vk, const rd_material* m)
{
    return vk->values.bits[3] != 0u || m->unlit || (m->features & vk->values.bits[1]) != 0u;
}

static bool is_chosen(const rd_vk* vk, const rd_material* m, rd_vk_choice choice)
{
    bool masked = m->alpha_mode == RD_ALPHA_MASK;
    switch (choice) {
    case RD_VK_SOLID:
        return !masked;
    case RD_VK_MASKED:
        return masked;
    case RD_VK_FORWARD:
        return may_be_forward(vk, m);
    default:
        return true;
    }
}

void rd_vk_draw_meshes(rd_vk* vk, rd_vk_program program, rd_vk_choice choice)
{
    const rd_scene* scene = vk->scene.scene;
    rd_vk_bind_frame(vk, 0);
    for (int i = 0; i < scene->mesh_count; ++i) {
        const rd_mesh* m = &scene->meshes[i];
        const rd_material* material = &scene->materials[m->material];
        if (!rd_material_is_layer(material) && is_chosen(vk, material, choice)) {
            const rd_vk_piece piece = {(uint32_t)i, 0, m->triangle_count, false, false};
            draw(vk, program, &piece);
        }
    }
}

void rd_vk_draw_layers(rd_vk* vk, rd_vk_program program)
{
    rd_vk_bind_frame(vk, 1);
    for (uint32_t i = 0; i < vk->order.run_count; ++i) {
        const rd_vk_batch* run = &vk->order.runs[i];
        const rd_vk_piece piece = {run->mesh, run->first, run->count, true, false};
        draw(vk, program, &piece);
    }
}

bool rd_vk_has_glass(const rd_vk* vk)
{
    return (features_of(vk, RD_VK_PROGRAM_LAYER) & HDRP_BRDF_FEATURE_REFRACTION) != 0u;
}

void rd_vk_draw_screen(rd_vk* vk, rd_vk_program program)
{
    VkPipeline p = pipeline_of(vk, program);
    rd_vk_bind_frame(vk, 0);
    if (p) {
        vkCmdBindPipeline(vk->device.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p);
        vkCmdDraw(vk->device.commands, 3, 1, 0, 0);
    }
}
