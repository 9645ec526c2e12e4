/* Blended surfaces without sorting: pass_oit.c on the device. */
#include "vk_frame.h"

#include "oit_color_frag.h"
#include "oit_depth_frag.h"
#include "oit_front_frag.h"
#include "oit_moments_frag.h"
#include "oit_range_frag.h"
#include "oit_wavelet_frag.h"

#include <string.h>

#define CODE(name)                                                                                 \
    {                                                                                              \
        spirv_##name, sizeof spirv_##name                                                          \
    }

/* >>which surfaces */

static bool is_blended(const rd_vk* vk, const rd_material* m)
{
    return vk->options->features & RD_FEATURE_ALPHA_BLEND && rd_oit_is_blended(vk->options, m);
}

bool rd_vk_has_blended(const rd_vk* vk)
{
    const rd_scene* scene = vk->scene.scene;
    bool any = false;
    for (int i = 0; vk->oit.present && i < scene->mesh_count; ++i) {
        any = any || is_blended(vk, &scene->materials[scene->meshes[i].material]);
    }
    return any;
}

static hdrp_u32 features_of(const rd_vk* vk)
{
    const rd_scene* scene = vk->scene.scene;
    hdrp_u32 features = 0u;
    for (int i = 0; i < scene->material_count; ++i) {
        features |= is_blended(vk, &scene->materials[i]) ? scene->materials[i].features : 0u;
    }
    return features & vk->values.bits[1];
}

/* >>pipelines, made when they are first needed */

/* By the number of targets, which says what they are. */
static rd_vk_code code_of(const rd_vk_oit* o, uint32_t pass, uint32_t targets)
{
    static const rd_vk_code range = CODE(oit_range_frag), moments = CODE(oit_moments_frag),
                            wavelet = CODE(oit_wavelet_frag), color = CODE(oit_color_frag),
                            front = CODE(oit_front_frag);
    if (pass + 1 == o->pass_count) {
        return targets == 3 ? front : color;
    }
    return targets == 1 ? range : targets == 2 ? moments : wavelet;
}

static VkPipeline pipeline_of(rd_vk* vk, uint32_t pass)
{
    rd_vk_oit* o = &vk->oit;
    uint32_t first = rd_vk_oit_pass_first(o, pass);
    uint32_t count = rd_vk_oit_pass_first(o, pass + 1) - first;
    const uint32_t constants[5] = {features_of(vk), RD_VK_FORWARD_WORD,
                                   rd_vk_is_coarse(&vk->device), (uint32_t)o->mode, pass};
    VkPipelineColorBlendAttachmentState blends[HDRP_OIT_TARGETS_MAX];
    rd_vk_pipeline_desc desc;
    if (o->pipelines[pass] || vk->device.report->failed) {
        return o->pipelines[pass];
    }
    for (uint32_t i = 0; i < count; ++i) {
        blends[i] = hdrp_gpu_vk_oit_attachment_of(&o->targets[first + i]).blend;
    }
    memset(&desc, 0, sizeof desc);
    desc.vertex = rd_vk_vertex_code(false);
    desc.fragment = code_of(o, pass, count);
    desc.other_pass = o->passes[pass];
    desc.blends = blends;
    desc.blend_count = count;
    desc.compare = VK_COMPARE_OP_GREATER;
    desc.constants = constants;
    desc.constant_count = 5;
    rd_vk_pipeline_make(&vk->raster, &vk->device, &desc, &o->pipelines[pass]);
    return o->pipelines[pass];
}

static VkPipeline depth_pipeline(rd_vk* vk)
{
    static const rd_vk_code code = CODE(oit_depth_frag);
    rd_vk_oit* o = &vk->oit;
    rd_vk_pipeline_desc desc;
    if (o->depth_pipeline || vk->device.report->failed) {
        return o->depth_pipeline;
    }
    memset(&desc, 0, sizeof desc);
    desc.vertex = rd_vk_vertex_code(true);
    desc.fragment = code;
    desc.other_pass = o->depth_pass;
    desc.compare = VK_COMPARE_OP_ALWAYS;
    desc.writes_depth = true;
    rd_vk_pipeline_make(&vk->raster, &vk->device, &desc, &o->depth_pipeline);
    return o->depth_pipeline;
}

/* >>draws */

static void bind(rd_vk* vk, VkPipeline pipeline, uint32_t layer, uint32_t pass)
{
    rd_vk_bind_frame(vk, 1);
    vkCmdBindPipeline(vk->device.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(vk->device.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, vk->raster.layout,
                            3, 1, &vk->oit.layers[layer].sets[pass], 0, NULL);
}

/* Passes before the last see all surfaces in both resolutions, the last one those of its own. */
static void draw_pass(rd_vk* vk, uint32_t layer, uint32_t pass)
{
    const rd_scene* scene = vk->scene.scene;
    bool is_last = pass + 1 == vk->oit.pass_count, low = layer == 1;
    VkPipeline pipeline = pipeline_of(vk, pass);
    if (!pipeline) {
        return;
    }
    rd_vk_oit_pass_begin(&vk->oit, &vk->device, layer, pass);
    bind(vk, pipeline, layer, pass);
    for (int i = 0; i < scene->mesh_count; ++i) {
        const rd_mesh* m = &scene->meshes[i];
        const rd_material* material = &scene->materials[m->material];
        const rd_vk_piece piece = {(uint32_t)i, 0, m->triangle_count, false, low};
        if (is_blended(vk, material) && (!is_last || rd_oit_is_low(vk->options, material) == low)) {
            rd_vk_draw_piece(vk, &piece);
        }
    }
    rd_vk_pass_end(&vk->device);
}

static void draw_low_depth(rd_vk* vk)
{
    VkPipeline pipeline = depth_pipeline(vk);
    if (pipeline) {
        rd_vk_oit_depth_begin(&vk->oit, &vk->device);
        bind(vk, pipeline, 1, 0);
        vkCmdDraw(vk->device.commands, 3, 1, 0, 0);
        rd_vk_pass_end(&vk->device);
    }
}

bool rd_vk_draw_blended(rd_vk* vk)
{
    static const char* const names[2][RD_VK_OIT_PASSES] = {
        {"transparent: range", "transparent: absorption", "transparent: colour"},
        {"half resolution: range", "half resolution: absorption", "half resolution: colour"}};
    rd_vk_oit* o = &vk->oit;
    bool ok;
    if (o->layer_count > 1) {
        draw_low_depth(vk);
        rd_vk_mark(&vk->device, "half resolution: depth");
    }
    for (uint32_t layer = 0; layer < o->layer_count; ++layer) {
        for (uint32_t pass = 0; pass < o->pass_count; ++pass) {
            bool is_last = pass + 1 == o->pass_count;
            draw_pass(vk, layer, pass);
            rd_vk_mark(&vk->device, names[layer][is_last ? RD_VK_OIT_PASSES - 1 : pass]);
        }
    }
    ok = rd_vk_oit_compose(o, &vk->device, &vk->raster);
    rd_vk_mark(&vk->device, "composition");
    return ok && !vk->device.report->failed;
}
