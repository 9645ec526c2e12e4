#include "builtin_builder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* >>placing */

rd_affine rd_translation(float x, float y, float z)
{
    rd_affine a = rd_affine_identity();
    a.t = hdrp_v3_make(x, y, z);
    return a;
}

rd_affine rd_rotation_x(float angle)
{
    rd_affine a = rd_affine_identity();
    a.y = hdrp_v3_make(0.0f, cosf(angle), sinf(angle));
    a.z = hdrp_v3_make(0.0f, -sinf(angle), cosf(angle));
    return a;
}

rd_affine rd_rotation_y(float angle)
{
    rd_affine a = rd_affine_identity();
    a.x = hdrp_v3_make(cosf(angle), 0.0f, -sinf(angle));
    a.z = hdrp_v3_make(sinf(angle), 0.0f, cosf(angle));
    return a;
}

rd_affine rd_rotation_z(float angle)
{
    rd_affine a = rd_affine_identity();
    a.x = hdrp_v3_make(cosf(angle), sinf(angle), 0.0f);
    a.y = hdrp_v3_make(-sinf(angle), cosf(angle), 0.0f);
    return a;
}

int rd_build_material(rd_builder* b, rd_material* m, const char* name)
{
    int index;
    snprintf(m->name, RD_NAME_MAX, "%s", name);
    rd_material_update_features(m);
    index = rd_scene_add_material(b->scene, m);
    b->ok = b->ok && index >= 0;
    return index;
}

void rd_build_mesh(rd_builder* b, rd_shape shape, int material, rd_affine where, const char* name)
{
    b->ok = b->ok && shape.ok;
    if (!b->ok) {
        rd_mesh_free(&shape.mesh);
        return;
    }
    shape.mesh.material = material;
    snprintf(shape.mesh.name, RD_NAME_MAX, "%s", name);
    rd_mesh_transform(&shape.mesh, where);
    b->ok = rd_scene_add_mesh(b->scene, &shape.mesh);
}

void rd_build_light(rd_builder* b, const rd_light* l)
{
    b->ok = b->ok && rd_scene_add_light(b->scene, l);
}

hdrp_v2 rd_uv_scale(float u, float v)
{
    return hdrp_v2_make(u, v);
}

/* >>materials */

rd_material rd_metal(hdrp_v3 f0, float perceptual_roughness)
{
    rd_material m = rd_material_default();
    m.base_color = f0;
    m.perceptual_roughness = perceptual_roughness;
    return m;
}

rd_material rd_dielectric(hdrp_v3 color, float perceptual_roughness)
{
    rd_material m = rd_metal(color, perceptual_roughness);
    m.metallic = 0.0f;
    return m;
}

rd_material rd_glass(float ior, float thickness_m)
{
    rd_material m = rd_dielectric(hdrp_v3_splat(1.0f), 0.0f);
    m.ior = ior;
    m.transmission = 1.0f;
    m.thickness = thickness_m;
    return m;
}

rd_light rd_light_at(rd_light_type type, hdrp_v3 position, hdrp_v3 target, hdrp_v3 color)
{
    rd_light l;
    memset(&l, 0, sizeof l);
    l.type = type;
    l.position = position;
    l.forward = hdrp_normalize_or(hdrp_v3_sub(target, position), hdrp_v3_make(0.0f, -1.0f, 0.0f));
    l.right = hdrp_normalize_or(hdrp_v3_cross(l.forward, hdrp_v3_make(0.0f, 1.0f, 0.0f)),
                                hdrp_v3_make(1.0f, 0.0f, 0.0f));
    l.up = hdrp_v3_cross(l.right, l.forward);
    l.color = color;
    return l;
}

int rd_build_blocker(rd_builder* b, hdrp_cull_blocker blocker)
{
    int index = rd_scene_add_blocker(b->scene, &blocker);
    b->ok = b->ok && index >= 0;
    return index;
}

void rd_build_blocked_light(rd_builder* b, rd_light l, const int* blockers, uint32_t count)
{
    l.shadowless = true;
    l.first_blocker = (uint32_t)b->scene->blocker_link_count;
    l.blocker_count = count;
    for (uint32_t i = 0; i < count; ++i) {
        b->ok = b->ok && rd_scene_link_blocker(b->scene, (uint32_t)blockers[i]);
    }
    rd_build_light(b, &l);
}

void rd_build_camera(rd_builder* b, hdrp_v3 eye, hdrp_v3 target, float fov_y_rad, const char* name)
{
    hdrp_v3 forward = hdrp_v3_normalize(hdrp_v3_sub(target, eye));
    rd_scene_camera c;
    memset(&c, 0, sizeof c);
    snprintf(c.name, RD_NAME_MAX, "%s", name);
    c.world_from_view.z = hdrp_v3_neg(forward);
    c.world_from_view.x = hdrp_v3_normalize(hdrp_v3_cross(forward, hdrp_v3_make(0.0f, 1.0f, 0.0f)));
    c.world_from_view.y = hdrp_v3_cross(c.world_from_view.x, forward);
    c.world_from_view.t = eye;
    c.fov_y_rad = fov_y_rad;
    b->ok = b->ok && rd_scene_add_camera(b->scene, &c);
}

/* >>scenes */

bool rd_scene_build(rd_scene* scene, rd_builtin which, rd_report* report)
{
    static void (*const build[])(rd_builder*) = {rd_build_display, rd_build_street,
                                                 rd_build_transparency};
    rd_builder b = {scene, true};
    memset(scene, 0, sizeof *scene);
    build[which](&b);
    if (!b.ok) {
        return rd_fail(report, "built-in scene", "out of memory");
    }
    rd_scene_update_bounds(scene);
    return true;
}
