#include "vk_scene.h"

#include "lighting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What shaders take for granted. */
_Static_assert(sizeof(rd_vk_material) == 60 * 16, "layout of materials");
_Static_assert(sizeof(rd_vk_mesh) == 48, "layout of meshes");
_Static_assert(RD_GPU_SLOT_COUNT == (int)RD_SLOT_COUNT, "slots");
_Static_assert(RD_GPU_SLOT_THICKNESS == (int)RD_SLOT_THICKNESS, "slots");
_Static_assert(RD_GPU_DETAILS == RD_MAX_DETAIL_LAYERS, "layers of detail");
_Static_assert(RD_GPU_TEXTURES == RD_GPU_SLOT_COUNT + RD_GPU_DETAILS, "textures of a material");
_Static_assert(RD_GPU_ALPHA_BLEND == (unsigned)RD_ALPHA_BLEND, "alpha modes");
_Static_assert(RD_MAX_UV_SETS == 4, "uv sets");

/* >>meshes */

/* Arrays of floats, one behind the other. */
typedef struct pool {
    float* floats;
    size_t count;
} pool;

static size_t floats_of(const rd_mesh* m)
{
    size_t n = 3u + (m->normals ? 3u : 0u) + (m->tangents ? 4u : 0u) + (m->colors ? 4u : 0u);
    for (int i = 0; i < RD_MAX_UV_SETS; ++i) {
        n += m->uv[i] ? 2u : 0u;
    }
    return n * m->vertex_count;
}

static uint32_t append(pool* p, const void* values, size_t count)
{
    size_t first = p->count;
    if (!values) {
        return RD_GPU_NONE;
    }
    memcpy(p->floats + first, values, count * sizeof(float));
    p->count += count;
    return (uint32_t)first;
}

static rd_vk_mesh mesh_record(pool* p, const rd_mesh* m, uint32_t first_index)
{
    size_t n = m->vertex_count;
    rd_vk_mesh r;
    r.data[0] = first_index;
    r.data[1] = append(p, m->positions, 3 * n);
    r.data[2] = append(p, m->normals, 3 * n);
    r.data[3] = append(p, m->tangents, 4 * n);
    for (int i = 0; i < RD_MAX_UV_SETS; ++i) {
        r.uv[i] = append(p, m->uv[i], 2 * n);
    }
    r.more[0] = append(p, m->colors, 4 * n);
    r.more[1] = rd_mesh_light_layers(m);
    r.more[2] = (uint32_t)m->material;
    memcpy(&r.more[3], &m->scale, sizeof m->scale);
    return r;
}

static bool upload_meshes(rd_vk_scene* s, rd_vk_device* d)
{
    const rd_scene* scene = s->scene;
    size_t floats = 1, indices = 0;
    pool p = {NULL, 0};
    uint32_t* index;
    rd_vk_mesh* records;
    bool ok;
    for (int i = 0; i < scene->mesh_count; ++i) {
        floats += floats_of(&scene->meshes[i]);
    }
    p.floats = (float*)malloc(floats * sizeof(float));
    index = (uint32_t*)malloc(((size_t)scene->triangle_count * 3 + 1) * sizeof *index);
    records = (rd_vk_mesh*)malloc(((size_t)scene->mesh_count + 1) * sizeof *records);
    ok = p.floats && index && records;
    for (int i = 0; ok && i < scene->mesh_count; ++i) {
        const rd_mesh* m = &scene->meshes[i];
        records[i] = mesh_record(&p, m, (uint32_t)indices);
        memcpy(index + indices, m->indices, (size_t)m->triangle_count * 3 * sizeof *index);
        indices += (size_t)m->triangle_count * 3;
    }
    if (!ok) {
        rd_fail(d->report, "--backend vulkan", "out of memory");
    }
    ok = ok && rd_vk_buffer_fill(d, p.floats, p.count * sizeof(float), &s->vertices) &&
         rd_vk_buffer_fill(d, index, indices * sizeof *index, &s->indices) &&
         rd_vk_buffer_fill(d, records, (size_t)scene->mesh_count * sizeof *records, &s->meshes);
    free(p.floats);
    free(index);
    free(records);
    return ok;
}

static hdrp_v4 ball_of(const rd_mesh* m)
{
    hdrp_v3 low = hdrp_v3_splat(HDRP_FLT_MAX), high = hdrp_v3_splat(-HDRP_FLT_MAX), center;
    for (uint32_t i = 0; i < m->vertex_count; ++i) {
        hdrp_v3 p = m->positions[i];
        low = hdrp_v3_make(hdrp_min(low.x, p.x), hdrp_min(low.y, p.y), hdrp_min(low.z, p.z));
        high = hdrp_v3_make(hdrp_max(high.x, p.x), hdrp_max(high.y, p.y), hdrp_max(high.z, p.z));
    }
    center = hdrp_v3_scale(hdrp_v3_add(low, high), 0.5f);
    return hdrp_v4_from_v3(center, hdrp_v3_length(hdrp_v3_sub(high, center)));
}

static bool make_balls(rd_vk_scene* s, rd_vk_device* d)
{
    s->balls = (hdrp_v4*)malloc(((size_t)s->scene->mesh_count + 1) * sizeof *s->balls);
    for (int i = 0; s->balls && i < s->scene->mesh_count; ++i) {
        s->balls[i] = ball_of(&s->scene->meshes[i]);
    }
    return s->balls || rd_fail(d->report, "--backend vulkan", "out of memory");
}

/* >>materials */

static hdrp_v4 size_of(const rd_scene* scene, int texture)
{
    const rd_texture* t;
    if (texture < 0) {
        return hdrp_v4_make(1.0f, 1.0f, 1.0f, 0.0f);
    }
    t = &scene->textures.items[texture];
    return hdrp_v4_make((float)t->width, (float)t->height, (float)t->level_count,
                        (float)((int)t->is_nearest | (int)t->wrap_u << 1 | (int)t->wrap_v << 3 |
                                (int)t->is_srgb << 5));
}

static rd_vk_slot slot_record(const rd_scene* scene, const rd_texture_slot* t)
{
    rd_vk_slot r;
    r.u_row = hdrp_v4_from_v3(t->u_row, (float)t->uv_set);
    r.v_row = hdrp_v4_from_v3(t->v_row, t->texture >= 0 ? 1.0f : 0.0f);
    r.size = size_of(scene, t->texture);
    return r;
}

static uint32_t hash_of(const char* name)
{
    uint32_t hash = 2166136261u;
    for (const char* c = name; *c; ++c) {
        hash = (hash ^ (uint32_t)(unsigned char)*c) * 16777619u;
    }
    return hash;
}

static void set_factors(rd_vk_material* r, const rd_scene* scene, const rd_material* m)
{
    r->base_alpha = hdrp_v4_from_v3(m->base_color, m->alpha);
    r->emission_cutoff = hdrp_v4_from_v3(m->emission_nits, m->alpha_cutoff);
    r->surface =
        hdrp_v4_make(m->metallic, m->perceptual_roughness, m->normal_scale, m->occlusion_strength);
    r->coat =
        hdrp_v4_make(m->coat, m->coat_perceptual_roughness, m->coat_normal_scale, m->anisotropy);
    r->film =
        hdrp_v4_make(m->film, m->film_ior, m->film_thickness_min_nm, m->film_thickness_max_nm);
    r->specular = hdrp_v4_from_v3(m->specular_color, m->specular);
    r->optics = hdrp_v4_make(m->ior, m->transmission, m->thickness,
                             hdrp_min(m->attenuation_distance_m, HDRP_FLT_MAX));
    r->volume = hdrp_v4_from_v3(m->attenuation_color, m->slab_thickness);
    r->turn = hdrp_v4_make(cosf(m->anisotropy_rotation_rad), sinf(m->anisotropy_rotation_rad), 0.0f,
                           0.0f);
    r->slab = hdrp_v4_from_v3(rd_slab_transmittance(scene, m->diffusion_profile, m->slab_thickness),
                              0.0f);
    r->bits[0] = (uint32_t)m->alpha_mode;
    r->bits[1] = (m->double_sided ? RD_GPU_DOUBLE_SIDED : 0u) | (m->unlit ? RD_GPU_UNLIT : 0u) |
                 (m->additive ? RD_GPU_ADDITIVE : 0u);
    r->bits[2] = m->features;
    r->bits[3] = m->diffusion_profile;
}

static rd_vk_material material_record(const rd_scene* scene, const rd_material* m)
{
    rd_vk_material r;
    memset(&r, 0, sizeof r);
    set_factors(&r, scene, m);
    r.detail = hdrp_v4_make(m->detail.scale[0], m->detail.scale[1], m->detail.strength[0],
                            m->detail.strength[1]);
    r.details[0] = (uint32_t)m->detail.layer_count;
    r.details[1] = hash_of(m->name);
    for (int i = 0; i < RD_SLOT_COUNT; ++i) {
        r.slots[i] = slot_record(scene, &m->slot[i]);
    }
    for (int i = 0; i < m->detail.layer_count; ++i) {
        r.detail_size[i] = size_of(scene, m->detail.texture[i]);
    }
    return r;
}

static bool upload_materials(rd_vk_scene* s, rd_vk_device* d)
{
    size_t count = (size_t)s->scene->material_count;
    rd_vk_material* records = (rd_vk_material*)malloc((count + 1) * sizeof *records);
    bool ok;
    if (!records) {
        return rd_fail(d->report, "--backend vulkan", "out of memory");
    }
    for (size_t i = 0; i < count; ++i) {
        records[i] = material_record(s->scene, &s->scene->materials[i]);
    }
    ok = rd_vk_buffer_fill(d, records, count * sizeof *records, &s->materials);
    free(records);
    return ok;
}

/* >>textures */

static bool upload_texture(rd_vk_device* d, const rd_texture* t, rd_vk_image* image)
{
    const rd_vk_image_desc desc = {t->is_srgb && !rd_vk_is_coarse(d) ? VK_FORMAT_R8G8B8A8_SRGB
                                                                     : VK_FORMAT_R8G8B8A8_UNORM,
                                   (uint32_t)t->width,
                                   (uint32_t)t->height,
                                   (uint32_t)t->level_count,
                                   1,
                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                   0};
    size_t offsets[RD_TEXTURE_MAX_LEVELS], bytes = 0;
    for (int i = 0; i < t->level_count; ++i) {
        size_t w = (size_t)(t->width >> i ? t->width >> i : 1);
        size_t h = (size_t)(t->height >> i ? t->height >> i : 1);
        offsets[i] = bytes; /* the levels are one block */
        bytes += w * h * 4;
    }
    return rd_vk_image_make(d, &desc, image) &&
           rd_vk_image_fill(d, image, t->level[0], bytes, offsets);
}

/* What stands in for a texture that is not there: in the format and with levels as others in its
 * place have them, because lavapipe compiles shaders anew for each combination. */
static bool upload_white(rd_vk_device* d, bool is_srgb, rd_vk_image* image)
{
    unsigned char texels[5 * 4];
    rd_texture white;
    memset(&white, 0, sizeof white);
    memset(texels, 255, sizeof texels);
    white.width = white.height = white.level_count = 2;
    white.is_srgb = is_srgb;
    white.level[0] = texels;
    return upload_texture(d, &white, image);
}

static bool upload_textures(rd_vk_scene* s, rd_vk_device* d)
{
    const rd_texture_set* set = &s->scene->textures;
    s->textures = (rd_vk_image*)calloc((size_t)set->count + 2, sizeof *s->textures);
    if (!s->textures) {
        return rd_fail(d->report, "--backend vulkan", "out of memory");
    }
    for (int i = 0; i < set->count; ++i) {
        if (!upload_texture(d, &set->items[i], &s->textures[i])) {
            return false;
        }
    }
    return upload_white(d, false, &s->textures[set->count]) &&
           upload_white(d, true, &s->textures[set->count + 1]);
}

static bool make_samplers(rd_vk_scene* s, rd_vk_device* d)
{
    static const VkSamplerAddressMode modes[3] = {
        [RD_WRAP_REPEAT] = VK_SAMPLER_ADDRESS_MODE_REPEAT,
        [RD_WRAP_CLAMP] = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        [RD_WRAP_MIRROR] = VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT};
    bool ok = true;
    for (int n = 0; n < 2; ++n) {
        for (int u = 0; u < 3; ++u) {
            for (int v = 0; v < 3; ++v) {
                ok = ok && rd_vk_sampler_make(d, n ? VK_FILTER_NEAREST : VK_FILTER_LINEAR, modes[u],
                                              modes[v], &s->samplers[n][u][v]);
            }
        }
    }
    return ok;
}

/* >>sets of descriptors, one for each material */

static bool make_layout(rd_vk_scene* s, rd_vk_device* d)
{
    const uint32_t materials = (uint32_t)s->scene->material_count + 1;
    const VkDescriptorSetLayoutBinding binding = {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                  RD_GPU_TEXTURES, VK_SHADER_STAGE_FRAGMENT_BIT,
                                                  NULL};
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding};
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                       RD_GPU_TEXTURES * materials};
    const VkDescriptorPoolCreateInfo pool_info = {.sType =
                                                      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                  .maxSets = materials,
                                                  .poolSizeCount = 1,
                                                  .pPoolSizes = &size};
    return rd_vk_check(d,
                       vkCreateDescriptorSetLayout(d->device, &layout, NULL, &s->material_layout),
                       "a layout of descriptors") &&
           rd_vk_check(d, vkCreateDescriptorPool(d->device, &pool_info, NULL, &s->pool),
                       "descriptors");
}

static bool holds_color(int slot)
{
    return slot == RD_SLOT_BASE_COLOR || slot == RD_SLOT_EMISSIVE || slot == RD_SLOT_SPECULAR_COLOR;
}

static VkDescriptorImageInfo texture_info(const rd_vk_scene* s, int slot, int texture)
{
    const rd_texture_set* set = &s->scene->textures;
    const rd_texture* t = texture >= 0 ? &set->items[texture] : NULL;
    VkDescriptorImageInfo info;
    info.sampler = t ? s->samplers[t->is_nearest][t->wrap_u][t->wrap_v] : s->samplers[0][0][0];
    info.imageView = s->textures[t ? texture : set->count + holds_color(slot)].base.view;
    info.imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return info;
}

static void write_set(const rd_vk_scene* s, rd_vk_device* d, const rd_material* m,
                      VkDescriptorSet set)
{
    VkDescriptorImageInfo infos[RD_GPU_TEXTURES];
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .descriptorCount = RD_GPU_TEXTURES,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    for (int i = 0; i < RD_SLOT_COUNT; ++i) {
        infos[i] = texture_info(s, i, m->slot[i].texture);
    }
    for (int i = 0; i < RD_MAX_DETAIL_LAYERS; ++i) {
        infos[RD_SLOT_COUNT + i] =
            texture_info(s, RD_SLOT_NORMAL, i < m->detail.layer_count ? m->detail.texture[i] : -1);
    }
    write.dstSet = set;
    write.pImageInfo = infos;
    vkUpdateDescriptorSets(d->device, 1, &write, 0, NULL);
}

static bool make_sets(rd_vk_scene* s, rd_vk_device* d)
{
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorSetCount = 1};
    size_t count = (size_t)s->scene->material_count;
    s->material_sets = (VkDescriptorSet*)malloc((count + 1) * sizeof *s->material_sets);
    if (!s->material_sets) {
        return rd_fail(d->report, "--backend vulkan", "out of memory");
    }
    info.descriptorPool = s->pool;
    info.pSetLayouts = &s->material_layout;
    for (size_t i = 0; i < count; ++i) {
        if (!rd_vk_check(d, vkAllocateDescriptorSets(d->device, &info, &s->material_sets[i]),
                         "descriptors")) {
            return false;
        }
        write_set(s, d, &s->scene->materials[i], s->material_sets[i]);
    }
    return true;
}

bool rd_vk_scene_make(rd_vk_scene* s, rd_vk_device* d, const rd_scene* scene)
{
    memset(s, 0, sizeof *s);
    s->scene = scene;
    return upload_meshes(s, d) && make_balls(s, d) && upload_materials(s, d) &&
           upload_textures(s, d) && make_samplers(s, d) && make_layout(s, d) && make_sets(s, d);
}

void rd_vk_scene_free(rd_vk_scene* s, rd_vk_device* d)
{
    for (int i = 0; s->textures && i < s->scene->textures.count + 2; ++i) {
        rd_vk_image_free(d, &s->textures[i]);
    }
    for (int i = 0; d->device && i < 18; ++i) {
        vkDestroySampler(d->device, s->samplers[i / 9][i / 3 % 3][i % 3], NULL);
    }
    if (d->device) {
        vkDestroyDescriptorPool(d->device, s->pool, NULL);
        vkDestroyDescriptorSetLayout(d->device, s->material_layout, NULL);
    }
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &s->meshes);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &s->materials);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &s->vertices);
    hdrp_gpu_vk_buffer_destroy(&d->gpu, &s->indices);
    free(s->textures);
    free(s->balls);
    free(s->material_sets);
    memset(s, 0, sizeof *s);
}
