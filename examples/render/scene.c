#include "scene.h"

#include <stdlib.h>
#include <string.h>

rd_texture_slot rd_texture_slot_make(int texture)
{
    rd_texture_slot s;
    s.texture = texture;
    s.uv_set = 0;
    s.u_row = hdrp_v3_make(1.0f, 0.0f, 0.0f);
    s.v_row = hdrp_v3_make(0.0f, 1.0f, 0.0f);
    return s;
}

rd_material rd_material_default(void)
{
    rd_material m;
    memset(&m, 0, sizeof m);
    m.alpha = 1.0f;
    m.alpha_cutoff = 0.5f;
    m.base_color = hdrp_v3_splat(1.0f);
    m.metallic = 1.0f;
    m.perceptual_roughness = 1.0f;
    m.normal_scale = 1.0f;
    m.occlusion_strength = 1.0f;
    m.coat_normal_scale = 1.0f;
    m.film_ior = 1.3f;
    m.film_thickness_min_nm = 100.0f;
    m.film_thickness_max_nm = 400.0f;
    m.specular = 1.0f;
    m.specular_color = hdrp_v3_splat(1.0f);
    m.ior = 1.5f;
    m.attenuation_distance_m = HDRP_FLT_MAX;
    m.attenuation_color = hdrp_v3_splat(1.0f);
    for (int i = 0; i < RD_SLOT_COUNT; ++i) {
        m.slot[i] = rd_texture_slot_make(-1);
    }
    return m;
}

void rd_material_update_features(rd_material* m)
{
    hdrp_u32 f = 0u;
    f |= m->coat > 0.0f ? HDRP_BRDF_FEATURE_CLEAR_COAT : 0u;
    f |= m->anisotropy != 0.0f ? HDRP_BRDF_FEATURE_ANISOTROPY : 0u;
    f |= m->film > 0.0f ? HDRP_BRDF_FEATURE_IRIDESCENCE : 0u;
    f |= m->transmission > 0.0f ? HDRP_BRDF_FEATURE_REFRACTION : 0u;
    f |= m->slab_thickness > 0.0f ? HDRP_BRDF_FEATURE_SUBSURFACE | HDRP_BRDF_FEATURE_TRANSMISSION
                                  : 0u;
    m->features = f;
}

bool rd_material_is_layer(const rd_material* m)
{
    return m->alpha_mode == RD_ALPHA_BLEND || m->transmission > 0.0f;
}

bool rd_material_scatters(const rd_material* m)
{
    const float smooth = 0.1f;
    return m->transmission > 0.0f && !(m->thickness > 0.0f) &&
           hdrp_brdf_refraction_perceptual_roughness(m->perceptual_roughness, m->ior) > smooth;
}

hdrp_v3 rd_slab_transmittance(const rd_scene* scene, hdrp_u32 profile, float thickness)
{
    return hdrp_brdf_volume_transmittance(scene->slab_color[profile % RD_MAX_PROFILES], 1.0f,
                                          thickness);
}

/* calloc(0) may return NULL, which would read as a failure. */
static void* allocate(size_t count, size_t size)
{
    return calloc(count ? count : 1, size);
}

bool rd_mesh_allocate(rd_mesh* mesh, uint32_t vertices, uint32_t triangles, bool normals,
                      bool tangents, bool colors, uint32_t uv_sets)
{
    bool ok;
    mesh->vertex_count = vertices;
    mesh->triangle_count = triangles;
    mesh->scale = 1.0f;
    mesh->positions = (hdrp_v3*)allocate((size_t)vertices + 1, sizeof *mesh->positions);
    mesh->indices = (uint32_t*)allocate((size_t)triangles * 3, sizeof *mesh->indices);
    ok = mesh->positions && mesh->indices;
    if (normals) {
        mesh->normals = (hdrp_v3*)allocate(vertices, sizeof *mesh->normals);
        ok = ok && mesh->normals;
    }
    if (tangents) {
        mesh->tangents = (hdrp_v4*)allocate(vertices, sizeof *mesh->tangents);
        ok = ok && mesh->tangents;
    }
    if (colors) {
        mesh->colors = (hdrp_v4*)allocate(vertices, sizeof *mesh->colors);
        ok = ok && mesh->colors;
    }
    for (int i = 0; i < RD_MAX_UV_SETS; ++i) {
        if (uv_sets >> i & 1u) {
            mesh->uv[i] = (hdrp_v2*)allocate(vertices, sizeof *mesh->uv[i]);
            ok = ok && mesh->uv[i];
        }
    }
    return ok;
}

void rd_mesh_free(rd_mesh* mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->tangents);
    free(mesh->colors);
    free(mesh->indices);
    for (int i = 0; i < RD_MAX_UV_SETS; ++i) {
        free(mesh->uv[i]);
    }
    memset(mesh, 0, sizeof *mesh);
}

uint32_t rd_mesh_light_layers(const rd_mesh* mesh)
{
    return mesh->light_layers ? mesh->light_layers & 255u : 255u;
}

static void turn_around(rd_mesh* mesh)
{
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        uint32_t* t = mesh->indices + (size_t)i * 3;
        uint32_t swap = t[1];
        t[1] = t[2];
        t[2] = swap;
    }
}

void rd_mesh_transform(rd_mesh* mesh, rd_affine a)
{
    float determinant = rd_affine_determinant(a);
    float sign = hdrp_sign_not_zero(determinant);
    mesh->scale *= cbrtf(hdrp_abs(determinant));
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        mesh->positions[i] = rd_affine_point(a, mesh->positions[i]);
        if (mesh->normals) {
            mesh->normals[i] = rd_affine_normal(a, mesh->normals[i]);
        }
        if (mesh->tangents) {
            hdrp_v4 t = mesh->tangents[i];
            hdrp_v3 v = hdrp_v3_from_v4(t);
            v = hdrp_normalize_or(rd_affine_vector(a, v), v);
            mesh->tangents[i] = hdrp_v4_from_v3(v, t.w * sign);
        }
    }
    if (sign < 0.0f) {
        turn_around(mesh);
    }
}

void rd_scene_drop_tangents(rd_scene* scene)
{
    for (int i = 0; i < scene->mesh_count; ++i) {
        free(scene->meshes[i].tangents);
        scene->meshes[i].tangents = NULL;
    }
}

/* Appends one element, doubling the room. */
static void* append(void* items, int* count, size_t size, const void* item)
{
    int n = *count;
    if ((n & (n - 1)) == 0) {
        void* grown = realloc(items, (n ? (size_t)n * 2 : 1) * size);
        if (!grown) {
            return NULL;
        }
        items = grown;
    }
    memcpy((char*)items + (size_t)n * size, item, size);
    *count = n + 1;
    return items;
}

bool rd_scene_add_mesh(rd_scene* scene, rd_mesh* mesh)
{
    void* grown = append(scene->meshes, &scene->mesh_count, sizeof *mesh, mesh);
    if (!grown) {
        rd_mesh_free(mesh);
        return false;
    }
    scene->meshes = (rd_mesh*)grown;
    scene->triangle_count += mesh->triangle_count;
    scene->vertex_count += mesh->vertex_count;
    return true;
}

int rd_scene_add_material(rd_scene* scene, const rd_material* m)
{
    void* grown = append(scene->materials, &scene->material_count, sizeof *m, m);
    if (!grown) {
        return -1;
    }
    scene->materials = (rd_material*)grown;
    return scene->material_count - 1;
}

bool rd_scene_add_light(rd_scene* scene, const rd_light* l)
{
    void* grown = append(scene->lights, &scene->light_count, sizeof *l, l);
    if (grown) {
        scene->lights = (rd_light*)grown;
    }
    return grown != NULL;
}

bool rd_scene_add_camera(rd_scene* scene, const rd_scene_camera* c)
{
    void* grown = append(scene->cameras, &scene->camera_count, sizeof *c, c);
    if (grown) {
        scene->cameras = (rd_scene_camera*)grown;
    }
    return grown != NULL;
}

int rd_scene_add_blocker(rd_scene* scene, const hdrp_cull_blocker* b)
{
    void* grown = append(scene->blockers, &scene->blocker_count, sizeof *b, b);
    if (!grown) {
        return -1;
    }
    scene->blockers = (hdrp_cull_blocker*)grown;
    return scene->blocker_count - 1;
}

bool rd_scene_link_blocker(rd_scene* scene, uint32_t blocker)
{
    void* grown =
        append(scene->blocker_links, &scene->blocker_link_count, sizeof blocker, &blocker);
    if (grown) {
        scene->blocker_links = (uint32_t*)grown;
    }
    return grown != NULL;
}

void rd_scene_update_bounds(rd_scene* scene)
{
    rd_bounds b;
    b.low = hdrp_v3_splat(HDRP_FLT_MAX);
    b.high = hdrp_v3_splat(-HDRP_FLT_MAX);
    for (int m = 0; m < scene->mesh_count; ++m) {
        const rd_mesh* mesh = &scene->meshes[m];
        for (size_t i = 0; i < (size_t)mesh->triangle_count * 3; ++i) {
            hdrp_v3 p = mesh->positions[mesh->indices[i]];
            b.low = hdrp_v3_make(hdrp_min(b.low.x, p.x), hdrp_min(b.low.y, p.y),
                                 hdrp_min(b.low.z, p.z));
            b.high = hdrp_v3_make(hdrp_max(b.high.x, p.x), hdrp_max(b.high.y, p.y),
                                  hdrp_max(b.high.z, p.z));
        }
    }
    scene->bounds = b;
}

void rd_scene_free(rd_scene* scene)
{
    for (int i = 0; i < scene->mesh_count; ++i) {
        rd_mesh_free(&scene->meshes[i]);
    }
    free(scene->meshes);
    free(scene->materials);
    free(scene->lights);
    free(scene->cameras);
    free(scene->blockers);
    free(scene->blocker_links);
    rd_textures_free(&scene->textures);
    memset(scene, 0, sizeof *scene);
}
