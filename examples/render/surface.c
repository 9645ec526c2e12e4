#include "surface.h"

#include "noise.h"

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
    bool has_footprint;
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

/* How the coordinates change from corner 0 to another. */
static hdrp_v2 uv_along(const patch* p, int set, int corner)
{
    const hdrp_v2* uv = p->mesh->uv[set];
    return uv ? hdrp_v2_sub(uv[p->corner[corner]], uv[p->corner[0]]) : hdrp_v2_make(0.0f, 0.0f);
}

static uv_point uv_of_set(const patch* p, int set)
{
    hdrp_v2 along1 = uv_along(p, set, 1), along2 = uv_along(p, set, 2);
    hdrp_v2 first = p->mesh->uv[set] ? p->mesh->uv[set][p->corner[0]] : hdrp_v2_make(0.0f, 0.0f);
    uv_point r;
    r.uv = hdrp_v2_add(first, uv_step(along1, along2, hdrp_v2_make(p->weight[1], p->weight[2])));
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

/* >>frames and normals, by surface gradients */

/* Where the texture of a slot gets its tangents from: the mesh where it has some and they belong to
 * the uv set, else the uv themselves. The derivatives along two edges serve as well as those along
 * two screen axes, and do not vanish where a ray has no footprint. */
static hdrp_basis tangent_frame(const patch* p, const rd_texture_slot* s, const rd_surface* at)
{
    float side = at->back_face ? -1.0f : 1.0f;
    hdrp_v2 d1, d2;
    if (p->mesh->tangents && s->uv_set == 0) {
        hdrp_v4 t = combine4(p, p->mesh->tangents);
        if (hdrp_v3_dot(hdrp_v3_from_v4(t), hdrp_v3_from_v4(t)) > 0.01f) {
            hdrp_v3 n = hdrp_v3_scale(combine3(p, p->mesh->normals), side);
            hdrp_surface_frame f =
                hdrp_surface_frame_from_vertex(n, hdrp_v3_from_v4(t), t.w * side);
            hdrp_basis b;
            b.tangent = f.tangent;
            b.bitangent = f.bitangent;
            return b;
        }
    }
    d1 = map_uv(s, uv_along(p, s->uv_set, 1), 0.0f);
    d2 = map_uv(s, uv_along(p, s->uv_set, 2), 0.0f);
    /* Green grows upwards in the picture, against v. */
    return hdrp_basis_from_uv(
        hdrp_surface_footprint_from_position(at->vertex_normal, p->edge1, p->edge2),
        hdrp_v2_make(d1.x, -d1.y), hdrp_v2_make(d2.x, -d2.y));
}

/* Codes of 8 bits make unit vectors shorter by up to this, which is no roughness. */
#define LENGTH_TOLERANCE 0.0075f

/* The tangent-space normal some pixels away, as far as averaging left it. */
static hdrp_v3 sample_normal(const patch* p, const rd_texture_slot* s, float pixels_x,
                             float pixels_y)
{
    uv_point at = uv_of_set(p, s->uv_set);
    hdrp_v2 dx = map_uv(s, at.dx, 0.0f), dy = map_uv(s, at.dy, 0.0f);
    hdrp_v2 uv = map_uv(s, at.uv, 1.0f);
    hdrp_v4 texel;
    uv = hdrp_v2_add(uv, hdrp_v2_add(hdrp_v2_scale(dx, pixels_x), hdrp_v2_scale(dy, pixels_y)));
    texel = rd_texture_sample(&p->scene->textures.items[s->texture], uv, dx, dy);
    return hdrp_normal_from_rgb(hdrp_v3_from_v4(texel));
}

/* Averaging shortens normals by their variance. Interpolation between texels does so too, and is no
 * sign of roughness: it counts as far as the footprint is larger than a texel. */
static float variance_below_footprint(const patch* p, const rd_texture_slot* s, hdrp_v3 normal)
{
    uv_point at = uv_of_set(p, s->uv_set);
    float texels = rd_texture_footprint(&p->scene->textures.items[s->texture],
                                        map_uv(s, at.dx, 0.0f), map_uv(s, at.dy, 0.0f));
    float length = hdrp_min(hdrp_v3_length(normal) + LENGTH_TOLERANCE, 1.0f);
    return hdrp_saturate(texels - 1.0f) * hdrp_brdf_variance_from_average_normal(length);
}

/* From one footprint to the next, as the derivatives of graphics hardware show it. */
static float variance_across_footprints(const patch* p, const rd_texture_slot* s, hdrp_v3 normal)
{
    hdrp_v3 up = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    hdrp_v3 n = hdrp_normalize_or(normal, up);
    hdrp_v3 nx = hdrp_normalize_or(sample_normal(p, s, 1.0f, 0.0f), up);
    hdrp_v3 ny = hdrp_normalize_or(sample_normal(p, s, 0.0f, 1.0f), up);
    return hdrp_brdf_variance_from_derivatives(hdrp_v3_sub(nx, n), hdrp_v3_sub(ny, n),
                                               RD_VARIANCE_STRENGTH, RD_VARIANCE_LIMIT);
}

/* What is rougher than this hides the small changes that the second kind finds. */
#define ROUGH 0.45f

static float map_variance(const patch* p, const rd_texture_slot* s, hdrp_v3 normal,
                          float perceptual_roughness)
{
    float sum = 0.0f;
    if (p->has_footprint) {
        sum = variance_below_footprint(p, s, normal);
        sum += perceptual_roughness < ROUGH ? variance_across_footprints(p, s, normal) : 0.0f;
    }
    return hdrp_min(sum, 1.0f);
}

/* The gradient of a normal map, and the variance that filtering took out of it. */
static hdrp_v3 map_gradient(const patch* p, rd_slot slot, float scale, const rd_surface* at,
                            float perceptual_roughness, float* variance)
{
    const rd_texture_slot* s = &p->material->slot[slot];
    hdrp_v3 normal;
    hdrp_basis f;
    *variance = 0.0f;
    if (s->texture < 0) {
        return hdrp_v3_splat(0.0f);
    }
    normal = sample_normal(p, s, 0.0f, 0.0f);
    *variance = map_variance(p, s, normal, perceptual_roughness);
    f = tangent_frame(p, s, at);
    /* Materials are sheets: a bump seen from behind is a dent. */
    return hdrp_surface_gradient_from_derivative(
        hdrp_derivative_from_normal(normal, at->back_face ? -scale : scale), f.tangent,
        f.bitangent);
}

/* >>detail by position: triplanar layers */

static hdrp_v4 sample_plane(const patch* p, int texture, float scale, hdrp_v2 at, hdrp_v2 dx,
                            hdrp_v2 dy)
{
    return rd_texture_sample(&p->scene->textures.items[texture], hdrp_v2_scale(at, scale),
                             hdrp_v2_scale(dx, scale), hdrp_v2_scale(dy, scale));
}

/* The three planes in the order and with the axes of hdrp_surface_gradient_from_triplanar. */
static hdrp_v2 plane_coordinates(hdrp_v3 p, int plane)
{
    return plane == 0   ? hdrp_v2_make(p.z, p.y)
           : plane == 1 ? hdrp_v2_make(p.x, p.z)
                        : hdrp_v2_make(p.x, p.y);
}

static hdrp_v4 sample_triplane(const patch* p, int texture, float scale, const rd_surface* at,
                               int plane)
{
    return sample_plane(p, texture, scale, plane_coordinates(at->position, plane),
                        plane_coordinates(at->position_dx, plane),
                        plane_coordinates(at->position_dy, plane));
}

static hdrp_v3 layer_gradient(const patch* p, int layer, hdrp_v3 weights, const rd_surface* at)
{
    const rd_detail* d = &p->material->detail;
    hdrp_v2 derivative[3];
    for (int i = 0; i < 3; ++i) {
        hdrp_v4 texel = sample_triplane(p, d->texture[layer], d->scale[layer], at, i);
        hdrp_v3 normal = hdrp_normal_from_rgb(hdrp_v3_from_v4(texel));
        derivative[i] = hdrp_derivative_from_normal(normal, d->strength[layer]);
        derivative[i].y = -derivative[i].y; /* green grows against v */
    }
    return hdrp_surface_gradient_from_triplanar(at->vertex_normal, weights, derivative[0],
                                                derivative[1], derivative[2]);
}

/* The first layer everywhere, the others in patches. */
static hdrp_v3 detail_gradient(const patch* p, const rd_surface* at)
{
    const rd_detail* d = &p->material->detail;
    hdrp_v3 weights = hdrp_triplanar_weights(at->vertex_normal, 6.0f);
    hdrp_v3 sum = hdrp_v3_splat(0.0f);
    for (int i = 0; i < d->layer_count; ++i) {
        hdrp_v3 where = hdrp_v3_mad(hdrp_v3_splat(64.0f), at->position, 5.0f);
        float mask = i == 0 ? 1.0f : hdrp_saturate(0.6f + 1.5f * rd_noise(where, 1u << 20, 3u));
        sum = hdrp_v3_mad(sum, layer_gradient(p, i, weights, at), mask);
    }
    return sum;
}

static hdrp_v4 base_texel(const patch* p, const rd_surface* at)
{
    const rd_detail* d = &p->material->detail;
    int texture = p->material->slot[RD_SLOT_BASE_COLOR].texture;
    hdrp_v3 w;
    hdrp_v4 x, y, z;
    if (d->layer_count == 0 || texture < 0) {
        return sample(p, RD_SLOT_BASE_COLOR, white());
    }
    w = hdrp_triplanar_weights(at->vertex_normal, 6.0f);
    x = sample_triplane(p, texture, d->scale[0], at, 0);
    y = sample_triplane(p, texture, d->scale[0], at, 1);
    z = sample_triplane(p, texture, d->scale[0], at, 2);
    return hdrp_v4_make(x.x * w.x + y.x * w.y + z.x * w.z, x.y * w.x + y.y * w.y + z.y * w.z,
                        x.z * w.x + y.z * w.y + z.z * w.z, x.w * w.x + y.w * w.y + z.w * w.z);
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
    p->has_footprint = spread != NULL;
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

static void set_normal(const patch* p, rd_surface* out)
{
    hdrp_v3 sum = map_gradient(p, RD_SLOT_NORMAL, p->material->normal_scale, out,
                               out->brdf.perceptual_roughness, &out->map_variance);
    if (p->material->detail.layer_count > 0) {
        sum = hdrp_v3_add(sum, detail_gradient(p, out));
    }
    out->brdf.normal = hdrp_normal_from_surface_gradient(out->vertex_normal, sum);
}

static void set_base(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    hdrp_v4 vertex = p->mesh->colors ? combine4(p, p->mesh->colors) : white();
    hdrp_v4 base = hdrp_v4_mul(base_texel(p, out), vertex);
    hdrp_v4 mr = sample(p, RD_SLOT_METALLIC_ROUGHNESS, white());
    hdrp_v4 emission = sample(p, RD_SLOT_EMISSIVE, white());
    float occlusion = sample(p, RD_SLOT_OCCLUSION, white()).x;
    out->brdf.base_color = hdrp_v3_mul(m->base_color, hdrp_v3_from_v4(base));
    out->alpha = m->alpha_mode == RD_ALPHA_BLEND ? hdrp_saturate(m->alpha * base.w) : 1.0f;
    out->coverage = m->additive ? 0.0f : out->alpha;
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
    /* An IOR of 0 stands for one without end, which reflects everything. */
    out->brdf.dielectric_fresnel0 = m->ior > 0.0f
                                        ? hdrp_brdf_dielectric_fresnel0(m->ior, tint, weight)
                                        : hdrp_v3_scale(hdrp_v3_saturate(tint), weight);
    out->brdf.ior = m->ior > 0.0f ? m->ior : 3.0f;
}

static void set_coat(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    out->brdf.coat_normal = out->vertex_normal;
    if (!(m->features & HDRP_BRDF_FEATURE_CLEAR_COAT)) {
        return;
    }
    out->brdf.coat_mask = m->coat * sample(p, RD_SLOT_COAT, white()).x;
    out->brdf.coat_perceptual_roughness =
        m->coat_perceptual_roughness * sample(p, RD_SLOT_COAT_ROUGHNESS, white()).y;
    out->brdf.coat_normal = hdrp_normal_from_surface_gradient(
        out->vertex_normal,
        map_gradient(p, RD_SLOT_COAT_NORMAL, m->coat_normal_scale, out,
                     out->brdf.coat_perceptual_roughness, &out->coat_map_variance));
}

/* glTF widens the lobe along its direction from the width across it, which is that of the material;
 * the surface wants the mean and the ratio. */
static void set_widths(rd_surface* out, float strength)
{
    hdrp_brdf_alphas a;
    hdrp_brdf_kulla k;
    a.b = hdrp_brdf_alpha_from_perceptual_roughness(out->brdf.perceptual_roughness);
    a.t = hdrp_lerp(a.b, 1.0f, hdrp_sq(hdrp_saturate(strength)));
    k = hdrp_brdf_kulla_from_alphas(a);
    out->brdf.perceptual_roughness = k.perceptual_roughness;
    out->brdf.anisotropy = k.anisotropy;
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
    f = tangent_frame(p, s, out);
    out->brdf.tangent =
        hdrp_v3_mad(hdrp_v3_scale(f.tangent, c * x - k * y), f.bitangent, k * x + c * y);
    if (m->features & HDRP_BRDF_FEATURE_ANISOTROPY) {
        set_widths(out, m->anisotropy * texel.z);
    }
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
    if (!(m->features & HDRP_BRDF_FEATURE_REFRACTION)) {
        return;
    }
    out->brdf.transmission = m->transmission * sample(p, RD_SLOT_TRANSMISSION, white()).x;
    out->brdf.volume_thickness_m =
        m->thickness * p->mesh->scale * sample(p, RD_SLOT_THICKNESS, white()).y;
}

static void set_slab(const patch* p, rd_surface* out)
{
    const rd_material* m = p->material;
    if (!(m->features & HDRP_BRDF_FEATURE_TRANSMISSION)) {
        return;
    }
    out->brdf.subsurface_mask = 1.0f;
    out->brdf.diffusion_profile = m->diffusion_profile;
    out->brdf.thickness = m->slab_thickness;
    out->brdf.transmittance =
        rd_slab_transmittance(p->scene, m->diffusion_profile, m->slab_thickness);
}

void rd_surface_evaluate(const rd_scene* scene, const rd_ray* ray, const rd_ray_spread* spread,
                         const rd_hit* hit, rd_surface* out)
{
    patch p = make_patch(scene, hit);
    out->material = p.material;
    out->light_layers = rd_mesh_light_layers(&scene->meshes[hit->mesh]);
    out->brdf = hdrp_brdf_surface_default();
    out->brdf.features = p.material->features;
    out->map_variance = out->coat_map_variance = 0.0f;
    set_geometry(&p, ray, spread, hit, out);
    set_vertex_normal(&p, out);
    out->uv = uv_of_set(&p, 0).uv;
    set_base(&p, out);
    set_normal(&p, out);
    set_specular(&p, out);
    set_coat(&p, out);
    set_anisotropy(&p, out);
    set_film(&p, out);
    set_transmission(&p, out);
    set_slab(&p, out);
}
