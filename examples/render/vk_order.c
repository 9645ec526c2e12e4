/* Transparent triangles from back to front. */
#include "vk_frame.h"

#include <stdlib.h>
#include <string.h>

typedef struct key {
    float mesh_depth, depth;
    uint32_t mesh, is_front, triangle;
} key;

static bool is_layer(const rd_scene* scene, int mesh)
{
    return rd_material_is_layer(&scene->materials[scene->meshes[mesh].material]);
}

bool rd_vk_order_make(rd_vk* vk)
{
    const rd_scene* scene = vk->scene.scene;
    rd_vk_order* o = &vk->order;
    uint32_t count = 0;
    for (int i = 0; i < scene->mesh_count; ++i) {
        count += is_layer(scene, i) ? scene->meshes[i].triangle_count : 0u;
    }
    o->capacity = count;
    o->keys = malloc(((size_t)count + 1) * sizeof(key));
    o->runs = (rd_vk_batch*)malloc(((size_t)count + 1) * sizeof *o->runs);
    if (!o->keys || !o->runs) {
        return rd_fail(vk->device.report, "--backend vulkan", "out of memory");
    }
    return rd_vk_mapped_make(&vk->device, ((size_t)count + 64) * sizeof(uint32_t),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &o->buffer);
}

void rd_vk_order_free(rd_vk* vk)
{
    free(vk->order.keys);
    free(vk->order.runs);
    rd_vk_mapped_free(&vk->device, &vk->order.buffer);
    memset(&vk->order, 0, sizeof vk->order);
}

static float depth_at(hdrp_v3 p, const rd_camera* c)
{
    hdrp_v3 to = hdrp_v3_sub(p, c->eye);
    return c->orthographic ? hdrp_v3_dot(to, c->forward) : hdrp_v3_dot(to, to);
}

/* Of a mesh, what is turned away comes first: thin shells are behind their own front, however large
 * their triangles are. */
static key key_of(const rd_vk* vk, uint32_t mesh, uint32_t triangle, const rd_camera* c)
{
    const rd_mesh* m = &vk->scene.scene->meshes[mesh];
    const uint32_t* i = m->indices + (size_t)triangle * 3;
    hdrp_v3 p = m->positions[i[0]], q = m->positions[i[1]], r = m->positions[i[2]];
    hdrp_v3 n = hdrp_v3_cross(hdrp_v3_sub(q, p), hdrp_v3_sub(r, p));
    hdrp_v3 to = c->orthographic ? c->forward : hdrp_v3_sub(p, c->eye);
    key k;
    k.mesh_depth = depth_at(hdrp_v3_from_v4(vk->scene.balls[mesh]), c);
    k.depth = depth_at(hdrp_v3_scale(hdrp_v3_add(hdrp_v3_add(p, q), r), 1.0f / 3.0f), c);
    k.mesh = mesh;
    k.is_front = hdrp_v3_dot(n, to) < 0.0f;
    k.triangle = triangle;
    return k;
}

static int by_depth(const void* a, const void* b)
{
    const key *x = (const key*)a, *y = (const key*)b;
    if (x->mesh_depth != y->mesh_depth) {
        return x->mesh_depth > y->mesh_depth ? -1 : 1;
    }
    if (x->mesh != y->mesh) {
        return x->mesh < y->mesh ? -1 : 1;
    }
    if (x->is_front != y->is_front) {
        return x->is_front ? 1 : -1;
    }
    if (x->depth != y->depth) {
        return x->depth > y->depth ? -1 : 1;
    }
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

/* Neighbours of one mesh are drawn together. */
static void find_runs(rd_vk_order* o)
{
    const key* keys = (const key*)o->keys;
    uint32_t* triangles = (uint32_t*)o->buffer.at;
    o->run_count = 0;
    for (uint32_t i = 0; i < o->count; ++i) {
        triangles[i] = keys[i].triangle;
        if (i == 0 || keys[i].mesh != keys[i - 1].mesh) {
            rd_vk_batch run = {keys[i].mesh, i, 0};
            o->runs[o->run_count++] = run;
        }
        ++o->runs[o->run_count - 1].count;
    }
}

/* What is blended without sorting is none of those. */
static bool is_sorted(const rd_vk* vk, int mesh)
{
    const rd_scene* scene = vk->scene.scene;
    const rd_material* m = &scene->materials[scene->meshes[mesh].material];
    return is_layer(scene, mesh) &&
           (vk->options->features & RD_FEATURE_ALPHA_BLEND || m->alpha_mode != RD_ALPHA_BLEND) &&
           !(vk->oit.present && rd_oit_is_blended(vk->options, m));
}

void rd_vk_order_sort(rd_vk* vk, const rd_camera* camera)
{
    const rd_scene* scene = vk->scene.scene;
    rd_vk_order* o = &vk->order;
    key* keys = (key*)o->keys;
    o->count = 0;
    for (int i = 0; i < scene->mesh_count; ++i) {
        const rd_mesh* m = &scene->meshes[i];
        for (uint32_t t = 0; is_sorted(vk, i) && t < m->triangle_count; ++t) {
            keys[o->count++] = key_of(vk, (uint32_t)i, t, camera);
        }
    }
    qsort(keys, o->count, sizeof *keys, by_depth);
    find_runs(o);
}
