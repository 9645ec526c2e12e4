#include "surface.h"

#include <math.h>
#include <stddef.h>

/* A triangle and the point on it. */
typedef struct patch {
    const rd_scene* scene;
    const rd_mesh* mesh;
    const rd_material* material;
    uint32_t corner[3];
    float weight[3];
    hdrp_v3 edge1, edge2;
    hdrp_v2 weight_dx, weight_dy; /* of corners 1 and 2, from one pixel to the next */
} patch;

typedef struct uv_point {
    hdrp_v2 uv, dx, dy;
} uv_point;

static hdrp_v3 combine3(const patch* p, const hdrp_v3* values)
{
    hdrp_v3 r = hdrp_v3_scale(values[p->corner[0]], p->weight[0]);
    r = hdrp_v3_mad(r, values[p->corner[1]], p->weight[1]);
    return hdrp_v3_mad(r, values[p->corner[2]], p->weight[2]);
}

static hdrp_v4 combine4(const patch* p, const hdrp_v4* values)
{
    hdrp_v4 a = values[p->corner[0]], b = values[p->corner[1]], c = values[p->corner[2]];
    const float* w = p->weight;
    return hdrp_v4_make(a.x * w[0] + b.x * w[1] + c.x * w[2], a.y * w[0] + b.y * w[1] + c.y * w[2],
                        a.z * w[0] + b.z * w[1] + c.z * w[2], a.w * w[0] + b.w * w[1] + c.w * w[2]);
}

static patch make_patch(const rd_scene* scene, const rd_hit* hit)
{
    patch p;
    hdrp_v3 a;
    p.scene = scene;
    p.mesh = &scene->meshes[hit->mesh];
    p.material = &scene->materials[p.mesh->material];
    for (int i = 0; i < 3; ++i) {
        p.corner[i] = p.mesh->indices[(size_t)hit->triangle * 3 + (size_t)i];
    }
    p.weight[0] = 1.0f - hit->u - hit->v;
    p.weight[1] = hit->u;
    p.weight[2] = hit->v;
    a = p.mesh->positions[p.corner[0]];
    p.edge1 = hdrp_v3_sub(p.mesh->positions[p.corner[1]], a);
    p.edge2 = hdrp_v3_sub(p.mesh->positions[p.corner[2]], a);
    p.weight_dx = p.weight_dy = hdrp_v2_make(0.0f, 0.0f);
    return p;
}

/* >>derivatives */

/* How far the hit moves in the plane of normal n when the ray changes by (origin, direction):
 * Igehy 1999, "Tracing Ray Differentials", eq. 10 and 12. */
static hdrp_v3 moved(const rd_ray* ray, float t, hdrp_v3 n, hdrp_v3 origin, hdrp_v3 direction)
{
    hdrp_v3 step = hdrp_v3_mad(origin, direction, t);
    float slope = hdrp_v3_dot(ray->direction, n);
    float k = hdrp_abs(slope) > 1e-6f ? -hdrp_v3_dot(step, n) / slope : 0.0f;
    return hdrp_v3_mad(step, ray->direction, k);
}

/* The change of the weights of corners 1 and 2 for a step in the plane: least squares over the two
 * edges. A sliver without area has no derivatives. */
static hdrp_v2 weight_step(const patch* p, hdrp_v3 step)
{
    float a = hdrp_v3_dot(p->edge1, p->edge1);
    float b = hdrp_v3_dot(p->edge1, p->edge2);
    float c = hdrp_v3_dot(p->edge2, p->edge2);
    float d1 = hdrp_v3_dot(p->edge1, step);
    float d2 = hdrp_v3_dot(p->edge2, step);
    float det = a * c - b * b;
    if (!(det > 1e-12f * a * c)) {
        return hdrp_v2_make(0.0f, 0.0f);
    }
    return hdrp_v2_make((c * d1 - b * d2) / det, (a * d2 - b * d1) / det);
}

static hdrp_v2 uv_step(hdrp_v2 along1, hdrp_v2 along2, hdrp_v2 weight)
{
    return hdrp_v2_add(hdrp_v2_scale(along1, weight.x), hdrp_v2_scale(along2, weight.y));
}

static hdrp_v3 normal_step(const patch* p, hdrp_v2 weight)
{
    const hdrp_v3* n = p->mesh->normals;
    hdrp_v3 along1, along2;
    if (!n) {
        return hdrp_v3_splat(0.0f);
    }
    along1 = hdrp_v3_sub(n[p->corner[1]], n[p->corner[0]]);
    along2 = hdrp_v3_sub(n[p->corner[2]], n[p->corner[0]]);
    return hdrp_v3_mad(hdrp_v3_scale(along1, weight.x), along2, weight.y);
}

/* >>textures */

static uv_point uv_of_set(const patch* p, int set)
{
    const hdrp_v2* uv = p->mesh->uv[set];
    uv_point r;
    hdrp_v2 a, b, c, along1, along2;
    if (!uv) {
        r.uv = r.dx = r.dy = hdrp_v2_make(0.0f, 0.0f);
        return r;
    }
    a = uv[p->corner[0]];
    b = uv[p->corner[1]];
    c = uv[p->corner[2]];
    along1 = hdrp_v2_sub(b, a);
    along2 = hdrp_v2_sub(c, a);
    r.uv = hdrp_v2_add(a, uv_step(along1, along2, hdrp_v2_make(p->weight[1], p->weight[2])));
    r.dx = uv_step(along1, along2, p->weight_dx);
    r.dy = uv_step(along1, along2, p->weight_dy);
    return r;
}

static hdrp_v2 map_uv(const rd_texture_slot* s, hdrp_v2 uv, float w)
{
    hdrp_v3 v = hdrp_v3_make(uv.x, uv.y, w);
    return hdrp_v2_make(hdrp_v3_dot(s->u_row, v), hdrp_v3_dot(s->v_row, v));
}

static hdrp_v4 sample(const patch* p, rd_slot slot, hdrp_v4 fallback)
{
    const rd_texture_slot* s = &p->material->slot[slot];
    uv_point at;
    if (s->texture < 0) {
        return fallback;
    }
    at = uv_of_set(p, s->uv_set);
    return rd_texture_sample(&p->scene->textures.items[s->texture], map_uv(s, at.uv, 1.0f),
                             map_uv(s, at.dx, 0.0f), map_uv(s, at.dy, 0.0f));
}

static hdrp_v4 white(void)
{
    return hdrp_v4_make(1.0f, 1.0f, 1.0f, 1.0f);
}

/* >>frames */

/* The directions in which u and -v of a slot's texture grow: the frame of a glTF normal map. */
static hdrp_basis frame_from_uv(const patch* p, const rd_texture_slot* s, hdrp_v3 n)
{
    const hdrp_v2* uv = p->mesh->uv[s->uv_set];
    hdrp_basis f = hdrp_basis_from_normal(n);
    hdrp_v2 d1, d2;
    hdrp_v3 t, b;
    float det;
    if (!uv) {
        return f;
    }
    d1 = map_uv(s, hdrp_v2_sub(uv[p->corner[1]], uv[p->corner[0]]), 0.0f);
    d2 = map_uv(s, hdrp_v2_sub(uv[p->corner[2]], uv[p->corner[0]]), 0.0f);
    det = hdrp_sign_not_zero(d1.x * d2.y - d1.y * d2.x);
    t = hdrp_v3_scale(hdrp_v3_mad(hdrp_v3_scale(p->edge1, d2.y), p->edge2, -d1.y), det);
    b = hdrp_v3_scale(hdrp_v3_mad(hdrp_v3_scale(p->edge1, d2.x), p->edge2, -d1.x), det);
    t = hdrp_v3_mad(t, n, -hdrp_v3_dot(t, n));
    b = hdrp_v3_mad(b, n, -hdrp_v3_dot(b, n));
    f.tangent = hdrp_normalize_or(t, f.tangent);
    f.bitangent = hdrp_normalize_or(b, hdrp_v3_cross(n, f.tangent));
    return f;
}

/* The mesh's own tangents where it has them and they belong to the uv set, as MikkTSpace means
 * them: the bitangent from the interpolated vectors. */
static hdrp_basis tangent_frame(const patch* p, const rd_texture_slot* s, hdrp_v3 n, bool flipped)
{
    hdrp_basis f;
    hdrp_v4 t;
    float sign;
    if (!p->mesh->tangents || s->uv_set != 0) {
        return frame_from_uv(p, s, n);
    }
    t = combine4(p, p->mesh->tangents);
    f.tangent = hdrp_normalize_or(hdrp_v3_from_v4(t), hdrp_v3_splat(0.0f));
    if (hdrp_v3_dot(f.tangent, f.tangent) < 0.5f) {
        return frame_from_uv(p, s, n);
    }
    sign = flipped ? -t.w : t.w;
    f.bitangent = hdrp_v3_scale(hdrp_v3_cross(n, f.tangent), hdrp_sign_not_zero(sign));
    return f;
}

/* A stand-in for the surface-gradient functions of hdrp_math.h. */
static hdrp_v3 perturb(hdrp_v3 n, hdrp_basis f, hdrp_v3 ts)
{
    hdrp_v3 r = hdrp_v3_scale(n, hdrp_max(ts.z, 1e-3f));
    r = hdrp_v3_mad(hdrp_v3_mad(r, f.tangent, ts.x), f.bitangent, ts.y);
    return hdrp_normalize_or(r, n);
}

static hdrp_v3 normal_map(const patch* p, rd_slot slot, float scale, hdrp_v3 n, bool flipped,
                          float* length)
{
    const rd_texture_slot* s = &p->material->slot[slot];
    /* Seen from behind, a bump is a dent. */
    float slope = flipped ? -scale : scale;
    hdrp_v4 texel;
    hdrp_v3 ts;
    if (s->texture < 0) {
        return n;
    }
    texel = sample(p, slot, white());
    ts = hdrp_v3_make(texel.x * 2.0f - 1.0f, texel.y * 2.0f - 1.0f, texel.z * 2.0f - 1.0f);
    *length = hdrp_v3_length(ts);
    ts = hdrp_v3_make(ts.x * slope, ts.y * slope, ts.z);
    return perturb(n, tangent_frame(p, s, n, flipped), ts);
}

/* >>the material at the point */

static void set_geometry(patch* p, const rd_ray* ray, const rd_ray_spread* spread,
                         const rd_hit* hit, rd_surface* out)
{
    hdrp_v3 n = hdrp_normalize_or(hdrp_v3_cross(p->edge1, p->edge2), hdrp_v3_neg(ray->direction));
    hdrp_v3 zero = hdrp_v3_splat(0.0f);
    out->view = hdrp_v3_neg(ray->direction);
    out->distance_m = hit->t;
    out->position = combine3(p, p->mesh->positions);
    out->back_face = hdrp_v3_dot(n, out->view) < 0.0f;
    out->geometric_normal = out->back_face ? hdrp_v3_neg(n) : n;
    out->position_dx = out->position_dy = zero;
    if (spread) {
        out->position_dx = moved(ray, hit->t, n, spread->origin_dx, spread->direction_dx);
        out->position_dy = moved(ray, hit->t, n, spread->origin_dy, spread->direction_dy);
        p->weight_dx = weight_step(p, out->position_dx);
        p->weight_dy = weight_step(p, out->position_dy);
    }
}

static void set_vertex_normal(const patch* p, rd_surface* out)
{
    float side = out->back_face ? -1.0f : 1.0f;
    out->vertex_normal = out->geometric_normal;
    if (p->mesh->normals) {
        out->vertex_normal = hdrp_normalize_or(hdrp_v3_scale(combine3(p, p->mesh->normals), side),
                                               out->geometric_normal);
    }
    out->normal_dx = hdrp_v3_scale(normal_step(p, p->weight_dx), side);
    out->normal_dy = hdrp_v3_scale(normal_step(p, p->weight_dy), side);
}

static void set_base(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    hdrp_v4 vertex = p->mesh->colors ? combine4(p, p->mesh->colors) : white();
    hdrp_v4 base = hdrp_v4_mul(sample(p, RD_SLOT_BASE_COLOR, white()), vertex);
    hdrp_v4 mr = sample(p, RD_SLOT_METALLIC_ROUGHNESS, white());
    hdrp_v4 emission = sample(p, RD_SLOT_EMISSIVE, white());
    float occlusion = sample(p, RD_SLOT_OCCLUSION, white()).x;
    out->brdf.base_color = hdrp_v3_mul(m->base_color, hdrp_v3_from_v4(base));
    out->alpha = m->alpha_mode == RD_ALPHA_BLEND ? hdrp_saturate(m->alpha * base.w) : 1.0f;
    out->brdf.metallic = m->metallic * mr.z;
    out->brdf.perceptual_roughness = m->perceptual_roughness * mr.y;
    out->emission_nits = hdrp_v3_mul(m->emission_nits, hdrp_v3_from_v4(emission));
    out->brdf.ambient_occlusion = hdrp_lerp(1.0f, occlusion, m->occlusion_strength);
}

/* KHR_materials_ior and KHR_materials_specular: the F0 of the dielectric. */
static void set_specular(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    float weight = m->specular * sample(p, RD_SLOT_SPECULAR, white()).w;
    hdrp_v3 tint =
        hdrp_v3_mul(m->specular_color, hdrp_v3_from_v4(sample(p, RD_SLOT_SPECULAR_COLOR, white())));
    float r = (m->ior - 1.0f) / (m->ior + 1.0f);
    float f0 = m->ior > 0.0f ? r * r : 1.0f;
    out->brdf.dielectric_fresnel0 =
        hdrp_v3_scale(hdrp_v3_saturate(hdrp_v3_scale(tint, f0)), weight);
    out->brdf.ior = m->ior > 0.0f ? m->ior : 3.0f;
}

static void set_coat(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    float unused = 1.0f;
    out->brdf.coat_normal = out->vertex_normal;
    if (!(m->features & HDRP_BRDF_FEATURE_CLEAR_COAT)) {
        return;
    }
    out->brdf.coat_mask = m->coat * sample(p, RD_SLOT_COAT, white()).x;
    out->brdf.coat_perceptual_roughness =
        m->coat_perceptual_roughness * sample(p, RD_SLOT_COAT_ROUGHNESS, white()).y;
    out->brdf.coat_normal = normal_map(p, RD_SLOT_COAT_NORMAL, m->coat_normal_scale,
                                       out->vertex_normal, out->back_face, &unused);
}

/* KHR_materials_anisotropy: the texture's direction, turned counter-clockwise by the rotation, in
 * the frame of the normal map's uv. */
static void set_anisotropy(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    const rd_texture_slot* s = &m->slot[RD_SLOT_ANISOTROPY];
    hdrp_v4 texel = sample(p, RD_SLOT_ANISOTROPY, hdrp_v4_make(1.0f, 0.5f, 1.0f, 1.0f));
    float c = cosf(m->anisotropy_rotation_rad), k = sinf(m->anisotropy_rotation_rad);
    float x = texel.x * 2.0f - 1.0f, y = texel.y * 2.0f - 1.0f;
    hdrp_basis f;
    if (s->texture < 0) {
        s = &m->slot[RD_SLOT_NORMAL];
    }
    f = tangent_frame(p, s, out->brdf.normal, out->back_face);
    out->brdf.tangent =
        hdrp_v3_mad(hdrp_v3_scale(f.tangent, c * x - k * y), f.bitangent, k * x + c * y);
    out->brdf.anisotropy = m->anisotropy * texel.z;
}

static void set_film(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    float t;
    if (!(m->features & HDRP_BRDF_FEATURE_IRIDESCENCE)) {
        return;
    }
    t = sample(p, RD_SLOT_FILM_THICKNESS, white()).y;
    out->brdf.film_mask = m->film * sample(p, RD_SLOT_FILM, white()).x;
    out->brdf.film_ior = m->film_ior;
    out->brdf.film_thickness_nm = hdrp_lerp(m->film_thickness_min_nm, m->film_thickness_max_nm, t);
}

static void set_transmission(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    out->thickness_m = 0.0f;
    if (!(m->features & HDRP_BRDF_FEATURE_REFRACTION)) {
        return;
    }
    out->brdf.transmission = m->transmission * sample(p, RD_SLOT_TRANSMISSION, white()).x;
    out->thickness_m = m->thickness_m * sample(p, RD_SLOT_THICKNESS, white()).y;
}

void rd_surface_evaluate(const rd_scene* scene, const rd_ray* ray, const rd_ray_spread* spread,
                         const rd_hit* hit, rd_surface* out)
{
    patch p = make_patch(scene, hit);
    out->material = p.material;
    out->brdf = hdrp_brdf_surface_default();
    out->brdf.features = p.material->features;
    out->normal_map_length = 1.0f;
    set_geometry(&p, ray, spread, hit, out);
    set_vertex_normal(&p, out);
    out->uv = uv_of_set(&p, 0).uv;
    out->brdf.normal = normal_map(&p, RD_SLOT_NORMAL, p.material->normal_scale, out->vertex_normal,
                                  out->back_face, &out->normal_map_length);
    set_base(&p, out);
    set_specular(&p, out);
    set_coat(&p, out);
    set_anisotropy(&p, out);
    set_film(&p, out);
    set_transmission(&p, out);
}
