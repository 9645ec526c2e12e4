// The light loop: what a surface reflects of the lights of its list, of directional lights and of
// the environment. For shaders of any stage, forward and deferred: the renderer of examples/render
// is its readable definition. Before the line that includes it, a shader has
//
//     #extension GL_GOOGLE_include_directive : require
//     #extension GL_EXT_samplerless_texture_functions : require
//     #include "hdrp_gpu_vk_light.h"
//     #define HDRP_FEATURES HDRP_BRDF_FEATURE_CLEAR_COAT  that its materials may have
//     #define HDRP_WORD     HDRP_GPU_VK_WORD_ALL          what else there may be: see below
//
// Both are constants, or specialization constants: what is not in them costs nothing. Of HDRP_WORD
// these count: types of lights in lists, _SHADOW, _NEGATIVE, _SLICES, _MASKS, _BLOCKERS,
// _DIRECTIONAL, _SHADOW_MASK, _ENVIRONMENT. A shader may define, besides:
//
//     HDRP_LIGHTING_SET      descriptor set of what is declared below; 0
//     HDRP_LIGHTING_BINDING  its first binding; 0. It takes those up to + 15
//     HDRP_SHADOW_ATLAS      it has declared float light_shadow(uint shadow_index, vec3 position,
//                            vec3 normal, vec3 l, float distance_m): what lights see, in [0,1];
//                            shaders/shadow_map.glsl, included before, does
//     HDRP_LIGHT_BLOCKERS    it has included shaders/light_blockers.glsl before: what keeps lights
//                            from parts of a cell
//
// Bindings, counted from HDRP_LIGHTING_BINDING; all must be valid, and a stand-in of the same kind
// serves for what HDRP_WORD or the parameters leave out:
//
//     0  uniform buffer  hdrp_gpu_vk_lighting.params, by hdrp_gpu_vk_write_lighting
//     1  storage buffer  lights            6  sampler2D    fgd, linear and clamped to the edge
//     2  storage buffer  tiles             7  samplerCube  specular, linear between levels too
//     3  storage buffer  cells             8  samplerCube  irradiance, linear
//     4  storage buffer  entries           9  texture2D    shadow mask
//     5  storage buffer  masks             10, 11          those of shadow_map.glsl, if included
//                                          12 to 15        those of light_blockers.glsl, likewise
//
// Then for each pixel:
//
//     vec3 offset = hdrp_cull_offset_of_pixel(lighting.camera, ...);  or position less the eye
//     hdrp_lit_surface r = hdrp_light_surface(d, offset, pixel, tile, z_view, layers, 1.0);
//     color = (r.diffuse + r.specular) * lighting.scales.x + exposed emission;

#ifndef HDRP_LIGHTING_SET
#define HDRP_LIGHTING_SET 0
#endif
#ifndef HDRP_LIGHTING_BINDING
#define HDRP_LIGHTING_BINDING 0
#endif
#define HDRP_I_BOUND(n) set = HDRP_LIGHTING_SET, binding = HDRP_LIGHTING_BINDING + n

layout(std140, HDRP_I_BOUND(0)) uniform HdrpLighting
{
    hdrp_gpu_vk_lighting_params lighting;
    vec4 slab_colors[16];
};
layout(std430, HDRP_I_BOUND(1)) readonly buffer HdrpLights { hdrp_light lights[]; };
layout(std430, HDRP_I_BOUND(2)) readonly buffer HdrpTiles { vec4 tile_depths[]; };
layout(std430, HDRP_I_BOUND(3)) readonly buffer HdrpCells { uvec4 cells[]; };
layout(std430, HDRP_I_BOUND(4)) readonly buffer HdrpEntries { uint entries[]; };
layout(std430, HDRP_I_BOUND(5)) readonly buffer HdrpMasks { uint masks[]; };
layout(HDRP_I_BOUND(6)) uniform sampler2D fgd_table;
layout(HDRP_I_BOUND(7)) uniform samplerCube sky_specular;
layout(HDRP_I_BOUND(8)) uniform samplerCube sky_irradiance;
layout(HDRP_I_BOUND(9)) uniform texture2D shadow_mask;

// What leaves the surface [nits], and for surfaces that light crosses what to ask of what is behind.
struct hdrp_lit_surface {
    vec3 diffuse;
    vec3 specular;
    vec3 transmitted_weight;
    vec3 transmitted_direction;
    float transmitted_perceptual_roughness;
};

bool hdrp_i_has(uint word)
{
    return (HDRP_WORD & word) != 0u;
}

bool hdrp_i_has_light(uint type)
{
    return hdrp_i_has(HDRP_CULL_FEATURE_OF_TYPE(type));
}

bool hdrp_i_there_is(uint flag)
{
    return (lighting.picture.z & flag) != 0u;
}

// hdrp_light_eval without the types that no list has.
hdrp_light_incident hdrp_i_incident(hdrp_light light, vec3 position)
{
    hdrp_light_incident r;
    uint type = hdrp_light_type(light);
    r.l = vec3(0.0, 1.0, 0.0);
    r.distance_m = 0.0;
    r.illuminance = vec3(0.0);
    bool parallel = hdrp_i_has_light(HDRP_LIGHT_TYPE_DIRECTIONAL) ||
                    hdrp_i_has(HDRP_GPU_VK_WORD_DIRECTIONAL);
    if (parallel && type == HDRP_LIGHT_TYPE_DIRECTIONAL) {
        r = hdrp_light_eval_directional(light);
    }
    if (hdrp_i_has_light(HDRP_LIGHT_TYPE_POINT) && type == HDRP_LIGHT_TYPE_POINT) {
        r = hdrp_light_eval_point(light, position);
    }
    if (hdrp_i_has_light(HDRP_LIGHT_TYPE_SPOT) && type == HDRP_LIGHT_TYPE_SPOT) {
        r = hdrp_light_eval_spot(light, position);
    }
    if (hdrp_i_has_light(HDRP_LIGHT_TYPE_PYRAMID) && type == HDRP_LIGHT_TYPE_PYRAMID) {
        r = hdrp_light_eval_pyramid(light, position);
    }
    if (hdrp_i_has_light(HDRP_LIGHT_TYPE_BOX) && type == HDRP_LIGHT_TYPE_BOX) {
        r = hdrp_light_eval_box(light, position);
    }
    return r;
}

// Whether light from a direction has a way to the viewer: what has none is black anyway.
bool hdrp_i_is_lit(hdrp_brdf_data d, vec3 l)
{
    uint crossing = HDRP_BRDF_FEATURE_REFRACTION | HDRP_BRDF_FEATURE_TRANSMISSION;
    bool lit = hdrp_v3_dot(d.normal, l) > 0.0;
    if ((HDRP_FEATURES & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u) {
        lit = lit || hdrp_v3_dot(d.coat_normal, l) > 0.0;
    }
    return lit || (d.features & HDRP_FEATURES & crossing) != 0u;
}

// What the atlas says of a light.
float hdrp_i_shadow(hdrp_light light, hdrp_light_incident i, hdrp_brdf_data d, vec3 position)
{
#ifdef HDRP_SHADOW_ATLAS
    bool has_atlas = hdrp_i_has(HDRP_GPU_VK_WORD_SHADOW) &&
                     (lighting.lights.w & HDRP_GPU_VK_WORD_SHADOW) != 0u;
    if (has_atlas && (light.bits.x & HDRP_LIGHT_FEATURE_SHADOW) != 0u) {
        return light_shadow(light.bits.z, position, d.normal, i.l, i.distance_m);
    }
#endif
    return 1.0;
}

// Whether blockers keep a light from a position. entry is that of a light that is listed.
bool hdrp_i_is_blocked(uint light, bool is_listed, uint entry, vec3 position)
{
#ifdef HDRP_LIGHT_BLOCKERS
    bool has_blockers = hdrp_i_has(HDRP_GPU_VK_WORD_BLOCKERS) &&
                        (lighting.lights.w & HDRP_GPU_VK_WORD_BLOCKERS) != 0u;
    if (has_blockers && light < lighting.kinds.z) {
        uint mask = is_listed ? blocker_masks[entry] : 0xffffffffu;
        return is_light_blocked(light, mask, hdrp_cull_light_place(lights[light]), position);
    }
#endif
    return false;
}

// What a loop keeps of a view for each light, in half the registers: smooth factors of at most a
// few, whose 11 bits cost 2e-4 of the light.
struct hdrp_i_kept {
    uvec4 fit;
    uvec4 factors;
    uint last;
    uvec2 fresnel;
};

uvec4 hdrp_i_keep_fit(hdrp_brdf_fgd_fit fit)
{
    return uvec4(packHalf2x16(fit.cosine_n), packHalf2x16(vec2(fit.cosine_d, fit.loss_n.x)),
                 packHalf2x16(vec2(fit.loss_n.y, fit.loss_d.x)), packHalf2x16(fit.loss_d.yz));
}

void hdrp_i_keep_factors(inout hdrp_i_kept k, hdrp_brdf_lit_view w)
{
    vec3 r = w.bounces.reflected;
    vec3 p = w.bounces.passed;
    k.factors = uvec4(packHalf2x16(p.xy), packHalf2x16(vec2(p.z, w.diffuse.x)),
                      packHalf2x16(w.diffuse.yz), packHalf2x16(r.xy));
    // What hardly loses light divides by that: 3e5 at roughness 0, more than halves hold.
    k.last = packHalf2x16(vec2(r.z, w.multiscatter * (1.0 / 256.0)));
    k.fresnel = uvec2(packHalf2x16(w.fresnel0.xy), packHalf2x16(vec2(w.fresnel0.z, w.fresnel90)));
}

// The fit that hdrp_brdf_lit_view_make makes, kept before it makes the rest.
uvec4 hdrp_i_keep_early(hdrp_brdf_data d)
{
    hdrp_brdf_lit_view w;
    w.alphas = hdrp_i_brdf_lit_alphas(d, HDRP_FEATURES);
    w = hdrp_i_brdf_lit_view_set_fit(w, d, HDRP_FEATURES);
    return hdrp_i_keep_fit(w.fit);
}

// hdrp_i_brdf_lit_fgd towards a light.
hdrp_brdf_fgd hdrp_i_kept_fgd(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_i_kept k, vec3 l,
                              float alpha)
{
    float cosine = hdrp_abs(hdrp_v3_dot(d.normal, l));
    hdrp_brdf_fgd fgd;
    if ((HDRP_FEATURES & HDRP_BRDF_FEATURE_ANISOTROPY) == 0u) {
        w.fit.inverse_alpha = inversesqrt(alpha * alpha); // whose square the lobe needs anyway
    }
    w.fit.cosine_n = unpackHalf2x16(k.fit.x);
    w.fit.cosine_d = unpackHalf2x16(k.fit.y).x;
    if ((HDRP_FEATURES & HDRP_BRDF_FEATURE_ANISOTROPY) == 0u) {
        fgd.schlick = hdrp_brdf_schlick_weight(hdrp_i_brdf_fgd_cosine(w.fit, cosine));
    }
    w.fit.loss_n = vec2(unpackHalf2x16(k.fit.y).y, unpackHalf2x16(k.fit.z).x);
    w.fit.loss_d = vec3(unpackHalf2x16(k.fit.z).y, unpackHalf2x16(k.fit.w));
    if ((HDRP_FEATURES & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u) {
        return hdrp_i_brdf_lit_fgd(d, w, l, cosine, HDRP_FEATURES);
    }
    fgd.albedo = hdrp_i_brdf_fgd_albedo(w.fit, cosine);
    fgd.schlick *= fgd.albedo;
    return fgd;
}

// hdrp_brdf_lit_eval, its parts in an order that needs few registers: nothing is restored before
// it is needed.
hdrp_brdf_lit hdrp_i_eval(hdrp_brdf_data d, hdrp_brdf_lit_view w, hdrp_i_kept kept, vec3 l,
                          float variance)
{
    float alpha = w.alphas.t;
    vec3 h = hdrp_brdf_half_vector(l, w.v, d.normal);
    hdrp_brdf_fgd fgd;
    vec3 first, diffuse;
    w = hdrp_brdf_lit_view_widened(w, variance);
    w.fresnel0 = vec3(unpackHalf2x16(kept.fresnel.x), unpackHalf2x16(kept.fresnel.y).x);
    w.fresnel90 = unpackHalf2x16(kept.fresnel.y).y;
    first = hdrp_i_brdf_lit_first(d, w, l, h, HDRP_FEATURES);
    fgd = hdrp_i_kept_fgd(d, w, kept, l, alpha);
    w.bounces.passed =
        vec3(unpackHalf2x16(kept.factors.x), unpackHalf2x16(kept.factors.y).x);
    diffuse = hdrp_brdf_diffuse_share(fgd, w.bounces, w.fresnel90);
    diffuse *= vec3(unpackHalf2x16(kept.factors.y).y, unpackHalf2x16(kept.factors.z));
    w.bounces.reflected = vec3(unpackHalf2x16(kept.factors.w), unpackHalf2x16(kept.last).x);
    w.multiscatter = 256.0 * unpackHalf2x16(kept.last).y;
    return hdrp_i_brdf_lit_rest(d, w, l, first, diffuse, fgd.albedo, HDRP_FEATURES);
}

void hdrp_i_add(inout hdrp_lit_surface r, vec3 diffuse, vec3 specular)
{
    if (hdrp_i_has(HDRP_GPU_VK_WORD_SPLIT)) {
        r.diffuse += diffuse;
        r.specular += specular;
    } else { // fewer registers
        r.specular += diffuse + specular;
    }
}

void hdrp_i_add_light(inout hdrp_lit_surface r, hdrp_brdf_data d, hdrp_brdf_lit_view w,
                      hdrp_i_kept kept, hdrp_light light, hdrp_light_incident i, float visible)
{
    bool parallel = hdrp_i_has_light(HDRP_LIGHT_TYPE_DIRECTIONAL) ||
                    hdrp_i_has(HDRP_GPU_VK_WORD_DIRECTIONAL);
    float sine = parallel ? hdrp_light_sine(light, i) : hdrp_i_light_sine_near(light, i);
    hdrp_brdf_lit s = hdrp_i_eval(d, w, kept, i.l, hdrp_i_light_variance_of_sine(sine));
    vec3 lux = i.illuminance * visible;
    if (hdrp_i_has(HDRP_GPU_VK_WORD_NEGATIVE)) {
        lux *= hdrp_light_sign(light);
    }
    hdrp_i_add(r, lux * s.diffuse, lux * s.specular);
}

// Which entries of a list are for a pixel. Few registers: they are kept over the loop.
struct hdrp_i_covered {
    uint block_layers; // bit of entries, in the upper half, and layers of the surface
    uint mask_first;   // word of masks of entry 0
    uint mask_bit;
};

hdrp_i_covered hdrp_i_covered_make(uvec2 pixel, uint layers)
{
    hdrp_i_covered c;
    c.block_layers = hdrp_cull_entry_bit(lighting.grid, pixel.x, pixel.y) | (layers & 0xffffu);
    c.mask_first = hdrp_cull_mask_word(lighting.grid, 0u, pixel.x, pixel.y);
    c.mask_bit = 1u << hdrp_cull_mask_bit(lighting.grid, pixel.x, pixel.y);
    return c;
}

bool hdrp_i_covers(hdrp_i_covered c, uint k, uint entry)
{
    bool covers = (entry & c.block_layers) > 0xffffu;
    if (hdrp_i_has(HDRP_GPU_VK_WORD_MASKS) &&
        (lighting.lights.w & HDRP_GPU_VK_WORD_MASKS) != 0u) {
        uint word = k * hdrp_cull_mask_words(lighting.grid) + c.mask_first;
        covers = covers && (masks[word] & c.mask_bit) != 0u;
    }
    return covers;
}

// Of hdrp_cull_tile_id, for pixels.
ivec2 hdrp_i_pixel(uint id)
{
    return ivec2(hdrp_cull_tile_id_x(id), hdrp_cull_tile_id_y(id));
}

// Directional lights that are in no list, then those of the list: one loop, so that there is one
// body.
void hdrp_i_add_lights(inout hdrp_lit_surface r, hdrp_brdf_data d, hdrp_brdf_lit_view w,
                       hdrp_i_kept kept, vec3 position, uvec2 pixel, uvec4 cell, uint layers)
{
    hdrp_i_covered covered = hdrp_i_covered_make(pixel, layers);
    uint at_pixel = hdrp_cull_tile_id(pixel.x, pixel.y); // one register over the loop
    uint first = hdrp_cull_first(cell, HDRP_CULL_CATEGORY_PUNCTUAL);
    uint everywhere = hdrp_i_has(HDRP_GPU_VK_WORD_DIRECTIONAL) ? lighting.lights.y : 0u;
    uint count = everywhere;
    if (hdrp_i_has(HDRP_GPU_VK_WORD_LIGHTS)) {
        count += hdrp_cull_last(cell, HDRP_CULL_CATEGORY_PUNCTUAL) - first;
    }
    for (uint k = 0u; k < count; ++k) {
        bool is_listed = hdrp_i_has(HDRP_GPU_VK_WORD_LIGHTS) && k >= everywhere;
        uint light = lighting.lights.x + k;
        float visible = 1.0;
        if (is_listed) {
            uint at = first + (k - everywhere);
            uint entry = entries[at];
            light = hdrp_cull_entry_index(entry);
            visible = hdrp_i_covers(covered, at, entry) ? 1.0 : 0.0;
        } else if (hdrp_i_has(HDRP_GPU_VK_WORD_SHADOW_MASK)) {
            uint channel = light - lighting.lights.z; // huge for those in front
            visible = channel < lighting.picture.w
                          ? texelFetch(shadow_mask, hdrp_i_pixel(at_pixel), 0)[channel]
                          : 1.0;
        }
        if (visible > 0.0 &&
            hdrp_light_affects(lights[light], covered.block_layers & 0xffffu) != 0u) {
            hdrp_light_incident i = hdrp_i_incident(lights[light], position);
            if (hdrp_v3_max_component(i.illuminance) > 0.0 && hdrp_i_is_lit(d, i.l) &&
                !hdrp_i_is_blocked(light, is_listed, first + (k - everywhere), position)) {
                visible *= is_listed ? hdrp_i_shadow(lights[light], i, d, position) : 1.0;
                hdrp_i_add_light(r, d, w, kept, lights[light], i, visible);
            }
        }
    }
}

vec3 hdrp_i_sky_irradiance(vec3 normal)
{
    if (hdrp_i_there_is(HDRP_GPU_VK_LIGHTING_IRRADIANCE)) {
        return textureLod(sky_irradiance, normal, 0.0).xyz;
    }
    return hdrp_env_irradiance_fast(lighting.sh, normal);
}

vec3 hdrp_i_sky_specular(vec3 direction, float perceptual_roughness)
{
    uint levels = hdrp_u32_from_f32(lighting.scales.y);
    float lod = hdrp_env_lod_from_perceptual_roughness(perceptual_roughness, levels);
    return textureLod(sky_specular, direction, lod).xyz;
}

// What hdrp_brdf_lit_env asks of the sky.
void hdrp_i_add_sky(inout hdrp_lit_surface r, hdrp_brdf_lit_env e, vec3 normal)
{
    vec3 diffuse = hdrp_i_sky_irradiance(normal) * e.diffuse_weight * HDRP_INV_PI;
    if ((HDRP_FEATURES & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u) {
        diffuse += hdrp_i_sky_irradiance(-normal) * e.through_weight * HDRP_INV_PI;
    }
    hdrp_i_add(r, diffuse,
               hdrp_i_sky_specular(e.specular_direction, e.specular_perceptual_roughness) *
                   e.specular_weight);
    if ((HDRP_FEATURES & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u) {
        r.specular +=
            hdrp_i_sky_specular(e.coat_direction, e.coat_perceptual_roughness) * e.coat_weight;
    }
}

hdrp_brdf_fgd hdrp_i_fgd(hdrp_brdf_data d, vec3 v)
{
    float n_dot_v = hdrp_saturate(hdrp_v3_dot(d.normal, v));
    hdrp_brdf_fgd fgd;
    if (hdrp_i_there_is(HDRP_GPU_VK_LIGHTING_FGD)) {
        vec2 uv = hdrp_brdf_fgd_uv(n_dot_v, d.perceptual_roughness, lighting.scales.z);
        vec2 texel = textureLod(fgd_table, uv, 0.0).xy;
        fgd.albedo = texel.x;
        fgd.schlick = texel.y;
        return fgd;
    }
    return hdrp_brdf_fgd_fast(n_dot_v, d.perceptual_roughness);
}

// The list of a place.
uvec4 hdrp_i_cell(uint tile, float z_view)
{
    uint slice = 0u;
    if (hdrp_i_has(HDRP_GPU_VK_WORD_SLICES)) {
        slice = hdrp_cull_slice(lighting.grid, tile_depths[tile].z, z_view);
    }
    return cells[hdrp_cull_cell(lighting.grid, tile, slice)];
}

// What the light loop keeps of a surface.
struct hdrp_light_state {
    hdrp_brdf_data d;
    hdrp_brdf_lit_view w;
    hdrp_i_kept kept;
};

// The first step: the view of a surface, and the light of the sky. v points to the viewer,
// visibility is the ambient occlusion that the material does not know of.
hdrp_light_state hdrp_light_begin(out hdrp_lit_surface r, hdrp_brdf_data d, vec3 v,
                                  float visibility)
{
    hdrp_light_state s;
    hdrp_brdf_lit_env e;
    hdrp_brdf_fgd fgd = hdrp_i_fgd(d, v);
    s.kept.fit = hdrp_i_keep_early(d);
    s.w = hdrp_brdf_lit_view_make(d, v, fgd, HDRP_FEATURES);
    hdrp_i_keep_factors(s.kept, s.w);
    r.diffuse = vec3(0.0);
    r.specular = vec3(0.0);
    d.ambient_occlusion = hdrp_min(d.ambient_occlusion, visibility);
    d.specular_occlusion *=
        hdrp_brdf_specular_occlusion(d.ambient_occlusion, s.w.n_dot_v, d.perceptual_roughness);
    e = hdrp_brdf_lit_env_make(d, s.w, HDRP_FEATURES);
    r.transmitted_weight = e.transmitted_weight;
    r.transmitted_direction = e.transmitted_direction;
    r.transmitted_perceptual_roughness = e.transmitted_perceptual_roughness;
    if (hdrp_i_has(HDRP_GPU_VK_WORD_ENVIRONMENT) &&
        (lighting.lights.w & HDRP_GPU_VK_WORD_ENVIRONMENT) != 0u) {
        hdrp_i_add_sky(r, e, d.normal);
    }
    s.d = d;
    return s;
}

// The second step, after the sky, so that the loop does without what only the sky asks for: all
// other lights. position is in the world, tile that of the pixel by hdrp_cull_tile_of_pixel, z_view
// its depth, layers those that the surface is on.
void hdrp_light_end(inout hdrp_lit_surface r, hdrp_light_state s, vec3 position, uvec2 pixel,
                    uint tile, float z_view, uint layers)
{
    if (hdrp_i_has(HDRP_GPU_VK_WORD_DIRECTIONAL | HDRP_GPU_VK_WORD_LIGHTS)) {
        uvec4 cell = uvec4(0u);
        if (hdrp_i_has(HDRP_GPU_VK_WORD_LIGHTS)) {
            cell = hdrp_i_cell(tile, z_view);
        }
        hdrp_i_add_lights(r, s.d, s.w, s.kept, position, pixel, cell, layers);
    }
}

// All light that a surface sends to the viewer. offset is its place less the eye. Without
// HDRP_GPU_VK_WORD_SPLIT all of it counts as specular in the result: only the sum means something.
hdrp_lit_surface hdrp_light_surface(hdrp_brdf_data d, vec3 offset, uvec2 pixel, uint tile,
                                    float z_view, uint layers, float visibility)
{
    hdrp_lit_surface r;
    vec3 v = hdrp_cull_direction_to_eye(lighting.camera, offset);
    hdrp_light_state s = hdrp_light_begin(r, d, v, visibility);
    hdrp_light_end(r, s, offset + hdrp_v3_from_v4(lighting.camera.eye_near), pixel, tile, z_view,
                   layers);
    return r;
}
