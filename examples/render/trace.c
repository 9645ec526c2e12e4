#include "trace.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PACKET 8

/* What a filter function knows of the triangles that it is called for. */
typedef struct mesh_ref {
    const rd_scene* scene;
    const rd_mesh* mesh;
    const rd_material* material;
    uint32_t index;
} mesh_ref;

struct rd_trace {
    const rd_scene* scene;
    RTCDevice device;
    RTCScene opaque; /* with alpha-tested surfaces */
    RTCScene layers;
    int layer_count;
    mesh_ref* refs;
};

/* What a query wants of the surfaces in the layer scene; with neither, the nearest one. */
typedef struct query {
    struct RTCIntersectContext base; /* first: filters see a pointer to it */
    rd_layers* gather;
    hdrp_v3* transmittance; /* by ray.id */
    const rd_ray* rays;     /* likewise */
    rd_passing passing;
    uint32_t last_mesh[PACKET]; /* of the hit that was multiplied last */
    float last_t[PACKET];
} query;

hdrp_v3 rd_trace_offset(hdrp_v3 p, hdrp_v3 n)
{
    /* Interpolated positions are good to some 2^-22 of their largest coordinate, intersections to
     * some 2^-20; small scenes near the origin need the absolute part. */
    float m = hdrp_max(hdrp_max(hdrp_abs(p.x), hdrp_abs(p.y)), hdrp_abs(p.z));
    return hdrp_v3_mad(p, n, m * 1e-5f + 1e-6f);
}

/* >>filters: called by Embree for each candidate
 * Packets arrive as arrays of N values for each member, in the order of RTCRayN and RTCHitN, for
 * which Embree has accessors in C++ only. */

enum { RAY_TFAR = 8, RAY_ID = 10, HIT_U = 3, HIT_V = 4, HIT_TRIANGLE = 5 };

static float packet_f32(const void* packet, unsigned n, unsigned i, int member)
{
    return ((const float*)packet)[(unsigned)member * n + i];
}

static uint32_t packet_u32(const void* packet, unsigned n, unsigned i, int member)
{
    return ((const uint32_t*)packet)[(unsigned)member * n + i];
}

static hdrp_v2 uv_at(const mesh_ref* r, const rd_texture_slot* slot, uint32_t triangle, float u,
                     float v)
{
    const uint32_t* i = r->mesh->indices + (size_t)triangle * 3;
    const hdrp_v2* uv = r->mesh->uv[slot->uv_set];
    hdrp_v2 a = uv[i[0]], b = uv[i[1]], c = uv[i[2]];
    float w = 1.0f - u - v;
    hdrp_v3 p = hdrp_v3_make(a.x * w + b.x * u + c.x * v, a.y * w + b.y * u + c.y * v, 1.0f);
    return hdrp_v2_make(hdrp_v3_dot(slot->u_row, p), hdrp_v3_dot(slot->v_row, p));
}

/* Base colour and alpha at a candidate, without filtering. */
static hdrp_v4 color_at(const mesh_ref* r, uint32_t triangle, float u, float v)
{
    const rd_texture_slot* slot = &r->material->slot[RD_SLOT_BASE_COLOR];
    hdrp_v4 c = hdrp_v4_from_v3(r->material->base_color, r->material->alpha);
    if (slot->texture >= 0) {
        const rd_texture* t = &r->scene->textures.items[slot->texture];
        c = hdrp_v4_mul(c, rd_texture_sample_finest(t, uv_at(r, slot, triangle, u, v)));
    }
    if (r->mesh->colors) {
        const uint32_t* i = r->mesh->indices + (size_t)triangle * 3;
        const hdrp_v4* q = r->mesh->colors;
        float w = 1.0f - u - v;
        hdrp_v4 vertex = hdrp_v4_make(q[i[0]].x * w + q[i[1]].x * u + q[i[2]].x * v,
                                      q[i[0]].y * w + q[i[1]].y * u + q[i[2]].y * v,
                                      q[i[0]].z * w + q[i[1]].z * u + q[i[2]].z * v,
                                      q[i[0]].w * w + q[i[1]].w * u + q[i[2]].w * v);
        c = hdrp_v4_mul(c, vertex);
    }
    return c;
}

static bool is_cut_out(const mesh_ref* r, float alpha)
{
    return r->material->alpha_mode == RD_ALPHA_MASK && alpha < r->material->alpha_cutoff;
}

static void mask_filter(const struct RTCFilterFunctionNArguments* a)
{
    const mesh_ref* r = (const mesh_ref*)a->geometryUserPtr;
    for (unsigned i = 0; i < a->N; ++i) {
        if (a->valid[i] == -1) {
            hdrp_v4 c =
                color_at(r, packet_u32(a->hit, a->N, i, HIT_TRIANGLE),
                         packet_f32(a->hit, a->N, i, HIT_U), packet_f32(a->hit, a->N, i, HIT_V));
            a->valid[i] = is_cut_out(r, c.w) ? 0 : -1;
        }
    }
}

static void gather(rd_layers* layers, const rd_hit* hit)
{
    if (layers->count == layers->capacity) {
        uint32_t capacity = layers->capacity ? layers->capacity * 2 : 64;
        rd_hit* grown = capacity <= RD_LAYERS_MAX
                            ? (rd_hit*)realloc(layers->hits, (size_t)capacity * sizeof *grown)
                            : NULL;
        if (!grown) {
            ++layers->dropped;
            return;
        }
        layers->hits = grown;
        layers->capacity = capacity;
    }
    layers->hits[layers->count++] = *hit;
}

static hdrp_v3 triangle_normal(const mesh_ref* r, uint32_t triangle)
{
    const uint32_t* i = r->mesh->indices + (size_t)triangle * 3;
    hdrp_v3 a = r->mesh->positions[i[0]];
    return hdrp_v3_cross(hdrp_v3_sub(r->mesh->positions[i[1]], a),
                         hdrp_v3_sub(r->mesh->positions[i[2]], a));
}

/* What a transmissive surface does to light that goes straight on. A volume tints and absorbs it
 * once, where it enters; each surface reflects some. */
static hdrp_v3 transmitted(const mesh_ref* r, uint32_t triangle, hdrp_v3 direction, hdrp_v3 color)
{
    const rd_material* m = r->material;
    hdrp_v3 n = hdrp_normalize_or(triangle_normal(r, triangle), direction);
    float cosine = hdrp_v3_dot(n, direction);
    float ior = m->ior > 0.0f ? m->ior : 3.0f;
    float f0 = m->specular * hdrp_brdf_fresnel0_from_ior(ior, 1.0f);
    float share = 1.0f - hdrp_brdf_f_schlick(f0, 1.0f, hdrp_abs(cosine));
    hdrp_v3 left = color;
    if (m->thickness > 0.0f) {
        left = hdrp_v3_mul(color, hdrp_brdf_volume_transmittance(m->attenuation_color,
                                                                 m->attenuation_distance_m,
                                                                 m->thickness * r->mesh->scale));
        left = cosine > 0.0f ? hdrp_v3_splat(1.0f) : left;
    }
    return hdrp_v3_scale(left, share * m->transmission * (1.0f - m->metallic));
}

static bool passes(const rd_material* m, rd_passing passing)
{
    bool volume = m->thickness > 0.0f;
    return volume ? passing != RD_PASSING_THIN
                  : passing == RD_PASSING_ALL || !rd_material_scatters(m);
}

/* Light that goes straight on through a transparent surface: what it does not cover, and what a
 * transmissive one lets through. */
static hdrp_v3 pass_through(const mesh_ref* r, const query* q, uint32_t triangle, hdrp_v4 c,
                            hdrp_v3 direction)
{
    const rd_material* m = r->material;
    float alpha = m->additive ? 0.0f : m->alpha_mode == RD_ALPHA_BLEND ? hdrp_saturate(c.w) : 1.0f;
    hdrp_v3 open = hdrp_v3_splat(1.0f - alpha);
    if (!(m->transmission > 0.0f) || !passes(m, q->passing)) {
        return open;
    }
    return hdrp_v3_mad(open, transmitted(r, triangle, direction, hdrp_v3_from_v4(c)), alpha);
}

/* A ray along an edge meets both triangles there: one surface, not two. */
static bool is_same_surface(uint32_t mesh, float t, const rd_hit* hit)
{
    return mesh == hit->mesh && hdrp_abs(t - hit->t) <= 2e-6f * hit->t;
}

static void multiply(query* q, const mesh_ref* r, const rd_hit* hit, hdrp_v4 c, unsigned ray_id)
{
    hdrp_v3* t = &q->transmittance[ray_id];
    if (!is_same_surface(q->last_mesh[ray_id], q->last_t[ray_id], hit)) {
        hdrp_v3 direction = q->rays[ray_id].direction;
        *t = hdrp_v3_mul(*t, pass_through(r, q, hit->triangle, c, direction));
    }
    q->last_mesh[ray_id] = hit->mesh;
    q->last_t[ray_id] = hit->t;
}

static bool accept_layer(const mesh_ref* r, query* q, const rd_hit* hit, unsigned ray_id)
{
    hdrp_v4 c;
    if (r->material->alpha_mode != RD_ALPHA_MASK && !q->transmittance) {
        c = hdrp_v4_make(1.0f, 1.0f, 1.0f, 1.0f);
    } else {
        c = color_at(r, hit->triangle, hit->u, hit->v);
    }
    if (is_cut_out(r, c.w)) {
        return false;
    }
    if (q->gather) {
        gather(q->gather, hit);
        return false;
    }
    if (q->transmittance) {
        multiply(q, r, hit, c, ray_id);
        return false;
    }
    return true;
}

static void layer_filter(const struct RTCFilterFunctionNArguments* a)
{
    const mesh_ref* r = (const mesh_ref*)a->geometryUserPtr;
    query* q = (query*)a->context;
    for (unsigned i = 0; i < a->N; ++i) {
        rd_hit hit;
        if (a->valid[i] != -1) {
            continue;
        }
        hit.t = packet_f32(a->ray, a->N, i, RAY_TFAR);
        hit.u = packet_f32(a->hit, a->N, i, HIT_U);
        hit.v = packet_f32(a->hit, a->N, i, HIT_V);
        hit.mesh = r->index;
        hit.triangle = packet_u32(a->hit, a->N, i, HIT_TRIANGLE);
        a->valid[i] = accept_layer(r, q, &hit, packet_u32(a->ray, a->N, i, RAY_ID)) ? -1 : 0;
    }
}

/* >>building */

static RTCGeometry make_geometry(rd_trace* t, mesh_ref* ref)
{
    RTCGeometry g = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               ref->mesh->positions, 0, sizeof(hdrp_v3), ref->mesh->vertex_count);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, ref->mesh->indices, 0,
                               3 * sizeof(uint32_t), ref->mesh->triangle_count);
    rtcSetGeometryUserData(g, ref);
    if (rd_material_is_layer(ref->material)) {
        rtcSetGeometryIntersectFilterFunction(g, layer_filter);
        rtcSetGeometryOccludedFilterFunction(g, layer_filter);
    } else if (ref->material->alpha_mode == RD_ALPHA_MASK) {
        rtcSetGeometryIntersectFilterFunction(g, mask_filter);
        rtcSetGeometryOccludedFilterFunction(g, mask_filter);
    }
    rtcCommitGeometry(g);
    return g;
}

static void attach_meshes(rd_trace* t)
{
    for (int i = 0; i < t->scene->mesh_count; ++i) {
        mesh_ref* ref = &t->refs[i];
        RTCGeometry g;
        bool is_layer;
        ref->scene = t->scene;
        ref->mesh = &t->scene->meshes[i];
        ref->material = &t->scene->materials[ref->mesh->material];
        ref->index = (uint32_t)i;
        is_layer = rd_material_is_layer(ref->material);
        g = make_geometry(t, ref);
        rtcAttachGeometryByID(is_layer ? t->layers : t->opaque, g, (unsigned)i);
        rtcReleaseGeometry(g);
        t->layer_count += is_layer;
    }
}

static bool build(rd_trace* t, rd_report* report)
{
    /* One thread a core is Embree's default; its start-up would otherwise pin them. */
    t->device = rtcNewDevice("set_affinity=0");
    if (!t->device) {
        return rd_fail(report, "Embree", "no device");
    }
    t->opaque = rtcNewScene(t->device);
    t->layers = rtcNewScene(t->device);
    /* Without this, single rays slip through between neighbouring triangles. */
    rtcSetSceneFlags(t->opaque, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneFlags(t->layers, RTC_SCENE_FLAG_ROBUST);
    t->refs = (mesh_ref*)calloc((size_t)t->scene->mesh_count + 1, sizeof *t->refs);
    if (!t->refs) {
        return rd_fail(report, "Embree", "out of memory");
    }
    attach_meshes(t);
    rtcCommitScene(t->opaque);
    rtcCommitScene(t->layers);
    if (rtcGetDeviceError(t->device) != RTC_ERROR_NONE) {
        return rd_fail(report, "Embree", "cannot build the acceleration structure");
    }
    return true;
}

rd_trace* rd_trace_build(const rd_scene* scene, rd_report* report)
{
    rd_trace* t = (rd_trace*)calloc(1, sizeof *t);
    if (!t) {
        rd_fail(report, "Embree", "out of memory");
        return NULL;
    }
    t->scene = scene;
    if (!build(t, report)) {
        rd_trace_free(t);
        return NULL;
    }
    return t;
}

void rd_trace_free(rd_trace* t)
{
    if (!t) {
        return;
    }
    if (t->device) {
        rtcReleaseScene(t->opaque);
        rtcReleaseScene(t->layers);
        rtcReleaseDevice(t->device);
    }
    free(t->refs);
    free(t);
}

bool rd_trace_has_layers(const rd_trace* t)
{
    return t->layer_count > 0;
}

/* >>queries */

static query make_query(bool coherent)
{
    query q;
    memset(&q, 0, sizeof q);
    memset(q.last_mesh, 0xff, sizeof q.last_mesh); /* RD_NO_HIT */
    rtcInitIntersectContext(&q.base);
    q.base.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return q;
}

static void load_rays(struct RTCRay8* p, int* valid, const rd_ray* rays, uint32_t count)
{
    for (uint32_t i = 0; i < PACKET; ++i) {
        const rd_ray* r = &rays[i < count ? i : 0];
        valid[i] = i < count ? -1 : 0;
        p->org_x[i] = r->origin.x;
        p->org_y[i] = r->origin.y;
        p->org_z[i] = r->origin.z;
        p->dir_x[i] = r->direction.x;
        p->dir_y[i] = r->direction.y;
        p->dir_z[i] = r->direction.z;
        p->tnear[i] = r->t_min;
        p->tfar[i] = r->t_max;
        p->time[i] = 0.0f;
        p->mask[i] = UINT32_MAX;
        p->id[i] = i;
        p->flags[i] = 0;
    }
}

static void intersect_packet(RTCScene scene, const rd_ray* rays, rd_hit* hits, uint32_t count)
{
    query q = make_query(true);
    int valid[PACKET] __attribute__((aligned(32)));
    struct RTCRayHit8 p;
    load_rays(&p.ray, valid, rays, count);
    for (uint32_t i = 0; i < PACKET; ++i) {
        p.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        p.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, scene, &q.base, &p);
    for (uint32_t i = 0; i < count; ++i) {
        hits[i].t = p.ray.tfar[i];
        hits[i].u = p.hit.u[i];
        hits[i].v = p.hit.v[i];
        hits[i].mesh = p.hit.geomID[i];
        hits[i].triangle = p.hit.primID[i];
    }
}

static bool is_culled(const rd_trace* t, const rd_ray* ray, const rd_hit* hit)
{
    const mesh_ref* r;
    if (hit->mesh == RD_NO_HIT || t->refs[hit->mesh].material->double_sided) {
        return false;
    }
    r = &t->refs[hit->mesh];
    return hdrp_v3_dot(triangle_normal(r, hit->triangle), ray->direction) > 0.0f;
}

/* The next surface behind a culled one. Steps by more than the rounding of t. */
static void retrace(const rd_trace* t, const rd_ray* ray, rd_hit* hit)
{
    rd_ray r = *ray;
    while (is_culled(t, ray, hit)) {
        r.t_min = hit->t * (1.0f + 4e-7f) + 1e-7f;
        intersect_packet(t->opaque, &r, hit, 1);
    }
}

void rd_trace_closest(const rd_trace* t, const rd_ray* rays, rd_hit* hits, uint32_t count)
{
    for (uint32_t at = 0; at < count; at += PACKET) {
        uint32_t n = count - at < PACKET ? count - at : PACKET;
        intersect_packet(t->opaque, rays + at, hits + at, n);
        for (uint32_t i = at; i < at + n; ++i) {
            retrace(t, &rays[i], &hits[i]);
        }
    }
}

static void closer_layers(const rd_trace* t, const rd_ray* rays, rd_hit* hits, uint32_t count)
{
    rd_ray shorter[PACKET];
    rd_hit layer[PACKET];
    for (uint32_t i = 0; i < count; ++i) {
        shorter[i] = rays[i];
        shorter[i].t_max = hits[i].t;
    }
    intersect_packet(t->layers, shorter, layer, count);
    for (uint32_t i = 0; i < count; ++i) {
        if (layer[i].mesh != RD_NO_HIT) {
            hits[i] = layer[i];
        }
    }
}

void rd_trace_closest_any(const rd_trace* t, const rd_ray* rays, rd_hit* hits, uint32_t count)
{
    for (uint32_t at = 0; at < count; at += PACKET) {
        uint32_t n = count - at < PACKET ? count - at : PACKET;
        intersect_packet(t->opaque, rays + at, hits + at, n);
        if (t->layer_count) {
            closer_layers(t, rays + at, hits + at, n);
        }
    }
}

static void transmittance_packet(const rd_trace* t, const rd_ray* rays, rd_passing passing,
                                 hdrp_v3* out, uint32_t count)
{
    query q = make_query(true);
    int valid[PACKET] __attribute__((aligned(32)));
    struct RTCRay8 p;
    load_rays(&p, valid, rays, count);
    rtcOccluded8(valid, t->opaque, &q.base, &p);
    for (uint32_t i = 0; i < count; ++i) {
        /* Embree marks an occluded ray by an infinite negative end. */
        out[i] = hdrp_v3_splat(p.tfar[i] < 0.0f ? 0.0f : 1.0f);
        valid[i] = p.tfar[i] < 0.0f ? 0 : -1;
    }
    if (t->layer_count) {
        q.transmittance = out;
        q.rays = rays;
        q.passing = passing;
        rtcOccluded8(valid, t->layers, &q.base, &p);
    }
}

void rd_trace_transmittance(const rd_trace* t, const rd_ray* rays, rd_passing passing, hdrp_v3* out,
                            uint32_t count)
{
    for (uint32_t at = 0; at < count; at += PACKET) {
        uint32_t n = count - at < PACKET ? count - at : PACKET;
        transmittance_packet(t, rays + at, passing, out + at, n);
    }
}

void rd_trace_hidden(const rd_trace* t, const rd_ray* rays, bool* hidden, uint32_t count)
{
    for (uint32_t at = 0; at < count; at += PACKET) {
        query q = make_query(false);
        int valid[PACKET] __attribute__((aligned(32)));
        uint32_t n = count - at < PACKET ? count - at : PACKET;
        struct RTCRay8 p;
        load_rays(&p, valid, rays + at, n);
        rtcOccluded8(valid, t->opaque, &q.base, &p);
        for (uint32_t i = 0; i < n; ++i) {
            hidden[at + i] = p.tfar[i] < 0.0f;
        }
    }
}

static int compare_hits(const void* a, const void* b)
{
    const rd_hit* x = (const rd_hit*)a;
    const rd_hit* y = (const rd_hit*)b;
    if (x->t != y->t) {
        return x->t < y->t ? -1 : 1;
    }
    if (x->mesh != y->mesh) {
        return x->mesh < y->mesh ? -1 : 1;
    }
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static void remove_doubles(rd_layers* layers)
{
    uint32_t kept = 1;
    for (uint32_t i = 1; i < layers->count; ++i) {
        const rd_hit* last = &layers->hits[kept - 1];
        if (!is_same_surface(last->mesh, last->t, &layers->hits[i])) {
            layers->hits[kept++] = layers->hits[i];
        }
    }
    layers->count = kept;
}

void rd_trace_layers(const rd_trace* t, const rd_ray* ray, rd_layers* layers)
{
    query q = make_query(false);
    struct RTCRayHit p;
    layers->count = 0;
    if (!t->layer_count) {
        return;
    }
    memset(&p, 0, sizeof p);
    p.ray.org_x = ray->origin.x;
    p.ray.org_y = ray->origin.y;
    p.ray.org_z = ray->origin.z;
    p.ray.dir_x = ray->direction.x;
    p.ray.dir_y = ray->direction.y;
    p.ray.dir_z = ray->direction.z;
    p.ray.tnear = ray->t_min;
    p.ray.tfar = ray->t_max;
    p.ray.mask = UINT32_MAX;
    p.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    q.gather = layers;
    rtcIntersect1(t->layers, &q.base, &p);
    if (layers->count > 1) {
        qsort(layers->hits, layers->count, sizeof *layers->hits, compare_hits);
        remove_doubles(layers);
    }
}
