// From a pixel of a triangle to what lighting wants: surface.c, line by line.
#include "rays.glsl"
#include "texture.glsl"

struct Surface {
    hdrp_brdf_surface brdf;
    vec3 position;
    vec3 view;
    vec3 geometric_normal;
    vec3 vertex_normal;
    vec3 position_dx, position_dy;
    vec3 normal_dx, normal_dy;
    vec2 uv;
    float distance_m;
    vec3 emission_nits;
    float alpha;
    float coverage; // alpha, or 0 where only light is added
    bool back_face;
    uint light_layers;
    float map_variance;
    float coat_map_variance;
};

// The triangle and the point on it.
Mesh mesh;
uint material_index;
uvec3 corner;
vec3 weight, edge1, edge2;
vec2 weight_dx, weight_dy;
#define MATERIAL materials[material_index]

// >>the point

vec3 combine3(uint first)
{
    return fetch3(first, corner.x) * weight.x + fetch3(first, corner.y) * weight.y +
           fetch3(first, corner.z) * weight.z;
}

vec4 combine4(uint first)
{
    return fetch4(first, corner.x) * weight.x + fetch4(first, corner.y) * weight.y +
           fetch4(first, corner.z) * weight.z;
}

vec3 set_triangle(uint mesh_index, uint triangle)
{
    vec3 a;
    mesh = meshes[mesh_index];
    material_index = mesh.more.z;
    for (int i = 0; i < 3; ++i) {
        corner[i] = indices[mesh.data.x + 3u * triangle + uint(i)];
    }
    a = fetch3(mesh.data.y, corner.x);
    edge1 = fetch3(mesh.data.y, corner.y) - a;
    edge2 = fetch3(mesh.data.y, corner.z) - a;
    weight_dx = weight_dy = vec2(0.0);
    return a;
}

// Where the ray meets the plane of the triangle; its distance. Moeller and Trumbore 1997.
float set_patch(uint mesh_index, uint triangle, Ray ray)
{
    vec3 a = set_triangle(mesh_index, triangle);
    vec3 s = ray.origin - a, p = cross(ray.direction, edge2), q = cross(s, edge1);
    float k = dot(edge1, p);
    k = k != 0.0 ? 1.0 / k : 0.0;
    weight.y = dot(s, p) * k;
    weight.z = dot(ray.direction, q) * k;
    weight.x = 1.0 - weight.y - weight.z;
    return dot(edge2, q) * k;
}

vec3 moved(Ray ray, float t, vec3 n, vec3 origin, vec3 direction)
{
    vec3 change = origin + direction * t;
    float slope = dot(ray.direction, n);
    float k = abs(slope) > 1e-6 ? -dot(change, n) / slope : 0.0;
    return change + ray.direction * k;
}

vec2 weight_step(vec3 change)
{
    float a = dot(edge1, edge1), b = dot(edge1, edge2), c = dot(edge2, edge2);
    float d1 = dot(edge1, change), d2 = dot(edge2, change);
    float det = a * c - b * b;
    if (!(det > 1e-12 * a * c)) {
        return vec2(0.0);
    }
    return vec2((c * d1 - b * d2) / det, (a * d2 - b * d1) / det);
}

vec3 normal_step(vec2 w)
{
    vec3 first;
    if (mesh.data.z == RD_GPU_NONE) {
        return vec3(0.0);
    }
    first = fetch3(mesh.data.z, corner.x);
    return (fetch3(mesh.data.z, corner.y) - first) * w.x +
           (fetch3(mesh.data.z, corner.z) - first) * w.y;
}

// >>textures

vec2 uv_along(uint set, uint which)
{
    uint first = mesh.uv[set];
    return first == RD_GPU_NONE ? vec2(0.0) : fetch2(first, corner[which]) - fetch2(first, corner.x);
}

struct UvPoint {
    vec2 uv, dx, dy;
};

UvPoint uv_of_set(uint set)
{
    vec2 along1 = uv_along(set, 1u), along2 = uv_along(set, 2u);
    vec2 first = mesh.uv[set] == RD_GPU_NONE ? vec2(0.0) : fetch2(mesh.uv[set], corner.x);
    UvPoint r;
    r.uv = first + along1 * weight.y + along2 * weight.z;
    r.dx = along1 * weight_dx.x + along2 * weight_dx.y;
    r.dy = along1 * weight_dy.x + along2 * weight_dy.y;
    return r;
}

vec2 map_uv(int slot, vec2 uv, float w)
{
    vec3 v = vec3(uv, w);
    return vec2(dot(MATERIAL.slots[slot].u_row.xyz, v), dot(MATERIAL.slots[slot].v_row.xyz, v));
}

uint set_of(int slot)
{
    return uint(MATERIAL.slots[slot].u_row.w);
}

bool has_texture(int slot)
{
    return MATERIAL.slots[slot].v_row.w != 0.0;
}

// >>all samples of a material
// Taken in one loop: compilers for CPUs need seconds for the code of each place that samples.

// The slots; the normals a pixel to the right and below, of both normal maps; the three planes of
// the base colour and of the layers of detail.
#define SAMPLE_BESIDE (RD_GPU_SLOT_COUNT)
#define SAMPLE_DETAIL (RD_GPU_SLOT_COUNT + 4)
#define SAMPLE_COUNT  (RD_GPU_SLOT_COUNT + 4 + 9)

vec4 texels[SAMPLE_COUNT];

struct Request {
    uint texture; // RD_GPU_NONE: nothing to sample
    vec4 size;
    UvPoint at;
};

Request request_slot(int slot, vec2 pixels)
{
    UvPoint at = uv_of_set(set_of(slot));
    Request r;
    r.texture = has_texture(slot) ? uint(slot) : RD_GPU_NONE;
    r.size = MATERIAL.slots[slot].size;
    r.at.dx = map_uv(slot, at.dx, 0.0);
    r.at.dy = map_uv(slot, at.dy, 0.0);
    r.at.uv = map_uv(slot, at.uv, 1.0) + (r.at.dx * pixels.x + r.at.dy * pixels.y);
    return r;
}

vec2 plane_coordinates(vec3 p, int plane)
{
    return plane == 0 ? p.zy : plane == 1 ? p.xz : p.xy;
}

// Layer 0: the base colour.
Request request_detail(int layer, int plane, Surface at)
{
    float scale = MATERIAL.detail[max(layer - 1, 0)];
    bool wanted = layer == 0 ? has_texture(RD_GPU_SLOT_BASE_COLOR)
                             : uint(layer) <= MATERIAL.details.x;
    Request r;
    r.texture = layer == 0 ? uint(RD_GPU_SLOT_BASE_COLOR) : uint(RD_GPU_SLOT_COUNT + layer - 1);
    r.texture = wanted && MATERIAL.details.x > 0u ? r.texture : RD_GPU_NONE;
    r.size = layer == 0 ? MATERIAL.slots[RD_GPU_SLOT_BASE_COLOR].size
                        : MATERIAL.detail_size[max(layer - 1, 0)];
    r.at.uv = plane_coordinates(at.position, plane) * scale;
    r.at.dx = plane_coordinates(at.position_dx, plane) * scale;
    r.at.dy = plane_coordinates(at.position_dy, plane) * scale;
    return r;
}

Request request_of(int i, Surface at)
{
    if (i < SAMPLE_BESIDE) {
        return request_slot(i, vec2(0.0));
    }
    if (i < SAMPLE_DETAIL) {
        int k = i - SAMPLE_BESIDE;
        return request_slot(k < 2 ? RD_GPU_SLOT_NORMAL : RD_GPU_SLOT_COAT_NORMAL,
                            (k & 1) == 0 ? vec2(1.0, 0.0) : vec2(0.0, 1.0));
    }
    return request_detail((i - SAMPLE_DETAIL) / 3, (i - SAMPLE_DETAIL) % 3, at);
}

void take_samples(Surface at)
{
    [[dont_unroll]] for (int i = 0; i < SAMPLE_COUNT; ++i) {
        Request r = request_of(i, at);
        texels[i] = vec4(1.0);
        if (r.texture != RD_GPU_NONE) {
            texels[i] = filtered(r.texture, r.size, r.at.uv, r.at.dx, r.at.dy);
        }
    }
}

#define SAMPLE(slot, fallback) (has_texture(slot) ? texels[slot] : fallback)
#define WHITE vec4(1.0)

// >>frames and normals

hdrp_basis tangent_frame(int slot, Surface at)
{
    float side = at.back_face ? -1.0 : 1.0;
    vec2 d1, d2;
    if (mesh.data.w != RD_GPU_NONE && set_of(slot) == 0u) {
        vec4 t = combine4(mesh.data.w);
        if (dot(t.xyz, t.xyz) > 0.01) {
            hdrp_surface_frame f = hdrp_surface_frame_from_vertex(combine3(mesh.data.z) * side,
                                                                  t.xyz, t.w * side);
            hdrp_basis b;
            b.tangent = f.tangent;
            b.bitangent = f.bitangent;
            return b;
        }
    }
    d1 = map_uv(slot, uv_along(set_of(slot), 1u), 0.0);
    d2 = map_uv(slot, uv_along(set_of(slot), 2u), 0.0);
    return hdrp_basis_from_uv(hdrp_surface_footprint_from_position(at.vertex_normal, edge1, edge2),
                              vec2(d1.x, -d1.y), vec2(d2.x, -d2.y));
}

#define LENGTH_TOLERANCE 0.0075
#define ROUGH            0.45

float variance_below_footprint(int slot, vec3 normal)
{
    UvPoint at = uv_of_set(set_of(slot));
    float texels = footprint(MATERIAL.slots[slot].size, map_uv(slot, at.dx, 0.0),
                             map_uv(slot, at.dy, 0.0));
    float size = min(hdrp_v3_length(normal) + LENGTH_TOLERANCE, 1.0);
    return hdrp_saturate(texels - 1.0) * hdrp_brdf_variance_from_average_normal(size);
}

float variance_across_footprints(int slot, vec3 normal)
{
    vec3 up = vec3(0.0, 0.0, 1.0);
    int beside = SAMPLE_BESIDE + (slot == RD_GPU_SLOT_NORMAL ? 0 : 2);
    vec3 n = hdrp_normalize_or(normal, up);
    vec3 nx = hdrp_normalize_or(hdrp_normal_from_rgb(texels[beside].xyz), up);
    vec3 ny = hdrp_normalize_or(hdrp_normal_from_rgb(texels[beside + 1].xyz), up);
    return hdrp_brdf_variance_from_derivatives(nx - n, ny - n, RD_GPU_VARIANCE_STRENGTH,
                                               RD_GPU_VARIANCE_LIMIT);
}

// xyz: the gradient of a normal map; w: the variance that filtering took out of it.
vec4 map_gradient(int slot, float scale, Surface at, float perceptual_roughness)
{
    vec3 normal = hdrp_normal_from_rgb(texels[slot].xyz);
    float variance = variance_below_footprint(slot, normal);
    hdrp_basis f = tangent_frame(slot, at);
    if (perceptual_roughness < ROUGH) {
        variance += variance_across_footprints(slot, normal);
    }
    return vec4(hdrp_surface_gradient_from_derivative(
                    hdrp_derivative_from_normal(normal, at.back_face ? -scale : scale), f.tangent,
                    f.bitangent),
                min(variance, 1.0));
}

#define GRADIENT(slot, scale, at, roughness)                                                       \
    (has_texture(slot) ? map_gradient(slot, scale, at, roughness) : vec4(0.0))

#include "detail.glsl"

vec4 base_texel(Surface at)
{
    if (MATERIAL.details.x == 0u || !has_texture(RD_GPU_SLOT_BASE_COLOR)) {
        return SAMPLE(RD_GPU_SLOT_BASE_COLOR, WHITE);
    }
    return detail_base(at);
}

// >>the material at the point

Surface set_geometry(Surface s, Ray ray, float t)
{
    vec3 n = hdrp_normalize_or(cross(edge1, edge2), -ray.direction);
    s.view = -ray.direction;
    s.distance_m = t;
    s.position = combine3(mesh.data.y);
    s.back_face = dot(n, s.view) < 0.0;
    s.geometric_normal = s.back_face ? -n : n;
    s.position_dx = moved(ray, t, n, ray.origin_dx, ray.direction_dx);
    s.position_dy = moved(ray, t, n, ray.origin_dy, ray.direction_dy);
    weight_dx = weight_step(s.position_dx);
    weight_dy = weight_step(s.position_dy);
    return s;
}

Surface set_vertex_normal(Surface s)
{
    float side = s.back_face ? -1.0 : 1.0;
    s.vertex_normal = s.geometric_normal;
    if (mesh.data.z != RD_GPU_NONE) {
        s.vertex_normal = hdrp_normalize_or(combine3(mesh.data.z) * side, s.geometric_normal);
    }
    s.normal_dx = normal_step(weight_dx) * side;
    s.normal_dy = normal_step(weight_dy) * side;
    return s;
}

Surface set_base(Surface s)
{
    vec4 vertex = mesh.more.x != RD_GPU_NONE ? combine4(mesh.more.x) : WHITE;
    vec4 base = base_texel(s) * vertex;
    vec4 mr = SAMPLE(RD_GPU_SLOT_METALLIC_ROUGHNESS, WHITE);
    vec4 emission = SAMPLE(RD_GPU_SLOT_EMISSIVE, WHITE);
    float occlusion = SAMPLE(RD_GPU_SLOT_OCCLUSION, WHITE).x;
    s.brdf.base_color = MATERIAL.base_alpha.xyz * base.xyz;
    s.alpha = MATERIAL.bits.x == RD_GPU_ALPHA_BLEND
                  ? hdrp_saturate(MATERIAL.base_alpha.w * base.w)
                  : 1.0;
    s.coverage = (MATERIAL.bits.y & RD_GPU_ADDITIVE) != 0u ? 0.0 : s.alpha;
    s.brdf.metallic = MATERIAL.surface.x * mr.z;
    s.brdf.perceptual_roughness = MATERIAL.surface.y * mr.y;
    s.emission_nits = MATERIAL.emission_cutoff.xyz * emission.xyz;
    s.brdf.ambient_occlusion = hdrp_lerp(1.0, occlusion, MATERIAL.surface.w);
    return s;
}

Surface set_normal(Surface s)
{
    vec4 sum = GRADIENT(RD_GPU_SLOT_NORMAL, MATERIAL.surface.z, s, s.brdf.perceptual_roughness);
    s.map_variance = sum.w;
    if (MATERIAL.details.x > 0u) {
        sum.xyz += detail_gradient(s);
    }
    s.brdf.normal = hdrp_normal_from_surface_gradient(s.vertex_normal, sum.xyz);
    return s;
}

Surface set_specular(Surface s)
{
    float ior = MATERIAL.optics.x;
    float w = MATERIAL.specular.w * SAMPLE(RD_GPU_SLOT_SPECULAR, WHITE).w;
    vec3 tint = MATERIAL.specular.xyz * SAMPLE(RD_GPU_SLOT_SPECULAR_COLOR, WHITE).xyz;
    s.brdf.dielectric_fresnel0 = ior > 0.0 ? hdrp_brdf_dielectric_fresnel0(ior, tint, w)
                                           : hdrp_v3_saturate(tint) * w;
    s.brdf.ior = ior > 0.0 ? ior : 3.0;
    return s;
}

Surface set_coat(Surface s)
{
    vec4 gradient;
    s.brdf.coat_normal = s.vertex_normal;
    if ((MATERIAL.bits.z & HDRP_BRDF_FEATURE_CLEAR_COAT) == 0u) {
        return s;
    }
    s.brdf.coat_mask = MATERIAL.coat.x * SAMPLE(RD_GPU_SLOT_COAT, WHITE).x;
    s.brdf.coat_perceptual_roughness =
        MATERIAL.coat.y * SAMPLE(RD_GPU_SLOT_COAT_ROUGHNESS, WHITE).y;
    gradient = GRADIENT(RD_GPU_SLOT_COAT_NORMAL, MATERIAL.coat.z, s,
                        s.brdf.coat_perceptual_roughness);
    s.coat_map_variance = gradient.w;
    s.brdf.coat_normal = hdrp_normal_from_surface_gradient(s.vertex_normal, gradient.xyz);
    return s;
}

Surface set_anisotropy(Surface s)
{
    vec4 texel = SAMPLE(RD_GPU_SLOT_ANISOTROPY, vec4(1.0, 0.5, 1.0, 1.0));
    vec2 at = texel.xy * 2.0 - 1.0;
    float c = MATERIAL.turn.x, k = MATERIAL.turn.y;
    hdrp_basis f = tangent_frame(has_texture(RD_GPU_SLOT_ANISOTROPY) ? RD_GPU_SLOT_ANISOTROPY
                                                                      : RD_GPU_SLOT_NORMAL, s);
    s.brdf.tangent = f.tangent * (c * at.x - k * at.y) + f.bitangent * (k * at.x + c * at.y);
    if ((MATERIAL.bits.z & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u) {
        hdrp_brdf_alphas a;
        hdrp_brdf_kulla kulla;
        a.b = hdrp_brdf_alpha_from_perceptual_roughness(s.brdf.perceptual_roughness);
        a.t = hdrp_lerp(a.b, 1.0, hdrp_sq(hdrp_saturate(MATERIAL.coat.w * texel.z)));
        kulla = hdrp_brdf_kulla_from_alphas(a);
        s.brdf.perceptual_roughness = kulla.perceptual_roughness;
        s.brdf.anisotropy = kulla.anisotropy;
    }
    return s;
}

Surface set_others(Surface s)
{
    uint features = MATERIAL.bits.z;
    if ((features & HDRP_BRDF_FEATURE_IRIDESCENCE) != 0u) {
        s.brdf.film_mask = MATERIAL.film.x * SAMPLE(RD_GPU_SLOT_FILM, WHITE).x;
        s.brdf.film_ior = MATERIAL.film.y;
        s.brdf.film_thickness_nm = hdrp_lerp(MATERIAL.film.z, MATERIAL.film.w,
                                             SAMPLE(RD_GPU_SLOT_FILM_THICKNESS, WHITE).y);
    }
    if ((features & HDRP_BRDF_FEATURE_REFRACTION) != 0u) {
        s.brdf.transmission = MATERIAL.optics.y * SAMPLE(RD_GPU_SLOT_TRANSMISSION, WHITE).x;
        s.brdf.volume_thickness_m = MATERIAL.optics.z * uintBitsToFloat(mesh.more.w) *
                                    SAMPLE(RD_GPU_SLOT_THICKNESS, WHITE).y;
    }
    if ((features & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u) {
        s.brdf.subsurface_mask = 1.0;
        s.brdf.diffusion_profile = MATERIAL.bits.w;
        s.brdf.thickness = MATERIAL.volume.w;
        s.brdf.transmittance = MATERIAL.slab.xyz;
    }
    return s;
}

Surface surface_at(uint mesh_index, uint triangle, Ray ray)
{
    float t = set_patch(mesh_index, triangle, ray);
    Surface s;
    s.light_layers = mesh.more.y;
    s.brdf = hdrp_brdf_surface_default();
    s.brdf.features = MATERIAL.bits.z;
    s.map_variance = s.coat_map_variance = 0.0;
    s = set_geometry(s, ray, t);
    s = set_vertex_normal(s);
    s.uv = uv_of_set(0u).uv;
    take_samples(s);
    s = set_base(s);
    s = set_normal(s);
    s = set_specular(s);
    s = set_coat(s);
    s = set_anisotropy(s);
    return set_others(s);
}
