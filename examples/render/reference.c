/* Path tracing with the exact forms of all lobes: what the passes in real time are measured by.
 *
 * At each surface lights and sky are sampled directly and by following the material, weighed by
 * multiple importance (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation").
 * Volumes bend light at their real boundaries. One thing is approximate: lights and the sun shine
 * straight through volumes, as in real time, because paths of light would hardly ever find such
 * small sources through glass; only the sky makes caustics. Nothing is clamped. */
#include "frame.h"

#include <math.h>
#include <string.h>

#define MAX_EVENTS 256
/* Surfaces that every path may meet before chance decides. */
#define SURE_EVENTS  4
#define MAX_SURVIVAL 0.95f

typedef struct path {
    bool alive;
    bool covered;  /* has met something */
    bool from_eye; /* has only gone straight on or been refracted so far */
    bool sampled; /* the last event also sampled lights and sky: what its direction meets has pdf */
    uint32_t events;
    uint32_t seed, used; /* of random numbers */
    rd_ray ray;
    hdrp_v3 throughput, radiance;
    hdrp_v3 last;              /* where the direction was chosen */
    hdrp_u32 last_layers;      /* of the surface there */
    float travelled_m;         /* from there to the origin of the ray */
    float pdf;                 /* of the direction [1/sr] */
    float light_weight;        /* sum over lights there, see weight_of */
    const rd_material* medium; /* that the ray travels in; NULL: air */
} path;

/* Light that reaches a path if nothing is in the way. */
typedef struct shadow {
    uint32_t path;
    hdrp_v3 light;
} shadow;

typedef struct shadow_list {
    uint32_t count;
    shadow items[RD_RUN];
    rd_ray rays[RD_RUN];
    rd_passing passing;
} shadow_list;

typedef struct wave {
    const rd_sub_frame* s;
    const rd_lighting* lighting;
    path paths[RD_RUN];
    uint32_t count;
    shadow_list lights, sky;
} wave;

/* A surface that a path has met, ready to be lit. */
typedef struct vertex {
    rd_surface surface;
    hdrp_brdf_data data;
    hdrp_brdf_lit_view view;
    hdrp_u32 features;
    float share; /* of the lobes that are sampled by hdrp_brdf_lit_sample, as a probability */
} vertex;

static float random_number(path* p)
{
    return hdrp_unit_from_u32(hdrp_hash2(p->seed, p->used++));
}

static hdrp_v2 random_pair(path* p)
{
    float x = random_number(p);
    return hdrp_v2_make(x, random_number(p));
}

/* Power heuristic. */
static float mis(float pdf, float other)
{
    float r = other / hdrp_max(pdf, HDRP_FLT_MIN);
    return 1.0f / (1.0f + r * r);
}

static void add_light(path* p, hdrp_v3 nits, float weight)
{
    p->radiance = hdrp_v3_mad(p->radiance, hdrp_v3_mul(p->throughput, nits), weight);
}

/* >>lights
 * One is chosen in proportion to its unshadowed illuminance. */

static float weight_of(const hdrp_light* light, hdrp_v3 position, hdrp_u32 layers,
                       hdrp_light_incident* in)
{
    *in = hdrp_light_eval(*light, position);
    return hdrp_light_affects(*light, layers) ? hdrp_luminance(in->illuminance) : 0.0f;
}

static bool lights_on(const wave* v)
{
    return (v->lighting->features & RD_FEATURE_LIGHTS) != 0;
}

/* The chosen light, or -1 where all is dark; its weight, and that of all. */
static int choose_light(const wave* v, path* p, const rd_surface* surface, hdrp_light_incident* in,
                        float* chosen)
{
    const rd_lights* l = &v->lighting->lights;
    int best = -1;
    p->light_weight = 0.0f;
    for (uint32_t i = 0; lights_on(v) && i < l->count; ++i) {
        hdrp_light_incident candidate;
        float w = weight_of(&l->items[i], surface->position, surface->light_layers, &candidate);
        if (w > 0.0f) {
            p->light_weight += w;
            if (random_number(p) * p->light_weight <= w) {
                best = (int)i;
                *chosen = w;
                *in = candidate;
            }
        }
    }
    return best;
}

/* Density of directions even over the disc of a source, seen at a cosine from its axis. */
static float disc_pdf(float sine, float cosine)
{
    return cosine * HDRP_INV_PI / (sine * sine);
}

static rd_ray ray_from(const vertex* x, hdrp_v3 direction)
{
    const rd_surface* s = &x->surface;
    float side = hdrp_sign_not_zero(hdrp_v3_dot(direction, s->geometric_normal));
    rd_ray r;
    r.origin = rd_trace_offset(s->position, hdrp_v3_scale(s->geometric_normal, side));
    r.direction = direction;
    r.t_min = 0.0f;
    r.t_max = HDRP_FLT_MAX;
    return r;
}

static hdrp_v3 reflected(const vertex* x, hdrp_v3 l)
{
    hdrp_brdf_lit lit = hdrp_brdf_lit_eval(x->data, x->view, l, x->features);
    return hdrp_v3_add(lit.diffuse, lit.specular);
}

static float pdf_of(const vertex* x, hdrp_v3 l)
{
    return x->share * hdrp_brdf_lit_pdf(x->data, x->view, l, x->features);
}

static void push(shadow_list* list, uint32_t index, const path* p, rd_ray ray, hdrp_v3 light)
{
    if (hdrp_v3_max_component(light) > 0.0f) {
        list->rays[list->count] = ray;
        list->items[list->count].path = index;
        list->items[list->count].light = hdrp_v3_mul(light, p->throughput);
        ++list->count;
    }
}

static void sample_lights(wave* v, uint32_t index, const vertex* x)
{
    path* p = &v->paths[index];
    hdrp_light_incident in;
    float weight = 0.0f, sine, k, cosine;
    int i = choose_light(v, p, &x->surface, &in, &weight);
    const hdrp_light* light;
    rd_ray ray;
    hdrp_v3 l;
    if (i < 0) {
        return;
    }
    light = &v->lighting->lights.items[i];
    sine = rd_light_sine(light, &in);
    l = sine > 0.0f ? rd_light_direction(&in, sine, random_pair(p)) : in.l;
    k = p->light_weight / weight;
    if (sine > 0.0f) {
        cosine = hdrp_max(hdrp_v3_dot(l, in.l), 1e-3f);
        k *= mis(disc_pdf(sine, cosine) / k, pdf_of(x, l)) / cosine;
    }
    ray = ray_from(x, l);
    ray.t_max = rd_light_shadow_end(light, &in);
    push(&v->lights, index, p, ray, hdrp_v3_scale(hdrp_v3_mul(reflected(x, l), in.illuminance), k));
}

/* Discs of lights between the origin of the ray and what it hits. */
static void meet_lights(const wave* v, path* p, float t)
{
    const rd_lights* l = &v->lighting->lights;
    float end = t < HDRP_FLT_MAX ? p->travelled_m + t : t;
    for (uint32_t i = 0; lights_on(v) && i < l->count; ++i) {
        hdrp_light_incident in;
        float sine, cosine, w, pdf, at;
        if (!(l->items[i].forward_radius.w > 0.0f)) {
            continue;
        }
        w = weight_of(&l->items[i], p->last, p->last_layers, &in);
        sine = rd_light_sine(&l->items[i], &in);
        cosine = hdrp_v3_dot(p->ray.direction, in.l);
        at = rd_light_shadow_end(&l->items[i], &in);
        if (w > 0.0f && sine > 0.0f && at >= p->travelled_m && at <= end &&
            cosine > sqrtf(1.0f - sine * sine)) {
            pdf = disc_pdf(sine, cosine) * w / p->light_weight;
            add_light(p, in.illuminance, HDRP_INV_PI / (sine * sine) * mis(p->pdf, pdf));
        }
    }
}

/* >>sky */

static bool sky_on(const wave* v)
{
    return v->lighting->environment->present && v->lighting->features & RD_FEATURE_ENVIRONMENT;
}

static void sample_sky(wave* v, uint32_t index, const vertex* x)
{
    path* p = &v->paths[index];
    hdrp_v2 u = random_pair(p);
    hdrp_env_sample s;
    if (!sky_on(v)) {
        return;
    }
    s = hdrp_env_sampler_sample(&v->lighting->environment->sampler, u.x, u.y);
    push(&v->sky, index, p, ray_from(x, s.direction),
         hdrp_v3_scale(hdrp_v3_mul(reflected(x, s.direction), s.radiance_nits),
                       mis(s.pdf_per_sr, pdf_of(x, s.direction)) / s.pdf_per_sr));
}

static void leave(const wave* v, path* p)
{
    const rd_environment* e = v->lighting->environment;
    p->alive = false;
    if (p->from_eye) {
        add_light(p, rd_background(v->s, &p->ray), 1.0f);
    } else if (sky_on(v)) {
        float other = p->sampled ? hdrp_env_sampler_pdf(&e->sampler, p->ray.direction) : 0.0f;
        add_light(p, hdrp_env_image_radiance(&e->light, p->ray.direction),
                  p->sampled ? mis(p->pdf, other) : 1.0f);
    }
}

/* >>surfaces */

static void go_on(path* p, const rd_surface* s, hdrp_v3 direction)
{
    p->travelled_m += s->distance_m;
    float side = hdrp_sign_not_zero(hdrp_v3_dot(direction, s->geometric_normal));
    p->ray.origin = rd_trace_offset(s->position, hdrp_v3_scale(s->geometric_normal, side));
    p->ray.direction = direction;
    p->ray.t_min = 0.0f;
    p->ray.t_max = HDRP_FLT_MAX;
}

static bool is_volume(const rd_material* m)
{
    return m->transmission > 0.0f && m->thickness > 0.0f;
}

/* Surfaces that the eye does not see, see rd_trace_closest, and the open part of a blended one. */
static bool passes_by(path* p, const rd_surface* s)
{
    const rd_material* m = s->material;
    bool culled = s->back_face && !m->double_sided && p->from_eye && !is_volume(m);
    return culled || m->additive || (s->alpha < 1.0f && random_number(p) >= s->alpha);
}

static void emit(path* p, const rd_surface* s, float exposure)
{
    bool shown = p->from_eye || !(s->material->is_lamp || s->material->unlit);
    if (shown && (!s->back_face || s->material->double_sided)) {
        add_light(p, rd_emission_nits(s, exposure), s->material->additive ? s->alpha : 1.0f);
    }
}

/* The lobes of a material that reflect, and what it transmits. */
static hdrp_v3 prepare(const wave* v, vertex* x)
{
    uint32_t options = v->lighting->features & ~(uint32_t)RD_FEATURE_SPECULAR_AA;
    hdrp_v3 through;
    hdrp_brdf_lit_env e;
    float rest;
    x->data = rd_engine_data(&x->surface, options);
    if (x->data.features & HDRP_BRDF_FEATURE_REFRACTION) {
        /* In a volume light is absorbed on its way, not at the surface. */
        x->data.transmittance = hdrp_v3_splat(1.0f);
    }
    /* Paths find out themselves what is occluded. */
    x->data.ambient_occlusion = x->data.specular_occlusion = 1.0f;
    x->features = x->data.features | HDRP_BRDF_LIT_EXACT;
    x->view = hdrp_brdf_lit_view_make(x->data, x->surface.view,
                                      rd_lighting_fgd(v->lighting, &x->data, x->surface.view),
                                      x->features);
    e = hdrp_brdf_lit_env_make(x->data, x->view, x->features);
    through = e.transmitted_weight;
    x->share = 1.0f;
    if (!rd_material_scatters(x->surface.material) && hdrp_v3_max_component(through) > 0.0f) {
        x->view.transmitted = hdrp_v3_splat(0.0f);
        rest = hdrp_v3_max_component(x->view.specular_albedo) +
               hdrp_v3_max_component(x->view.diffuse_albedo) + e.coat_weight;
        x->share = rest / (rest + hdrp_v3_max_component(through));
        x->share = hdrp_clamp(x->share, 0.1f, 0.9f);
        return through;
    }
    return hdrp_v3_splat(0.0f);
}

/* Reflects off the lobes of the Lit model. */
static void scatter(wave* v, uint32_t index, const vertex* x)
{
    path* p = &v->paths[index];
    float choice = random_number(p);
    hdrp_v2 u = random_pair(p);
    hdrp_v3 l = hdrp_brdf_lit_sample(x->data, x->view, hdrp_v3_make(choice, u.x, u.y), x->features);
    hdrp_v3 f = reflected(x, l);
    float below = hdrp_v3_dot(l, x->surface.geometric_normal) * hdrp_v3_dot(l, x->data.normal);
    p->pdf = pdf_of(x, l);
    p->from_eye = false;
    p->sampled = true;
    p->last = x->surface.position;
    p->last_layers = x->surface.light_layers;
    if (!(p->pdf > 0.0f) || below <= 0.0f) {
        p->alive = false;
        return;
    }
    p->throughput = hdrp_v3_scale(hdrp_v3_mul(p->throughput, f), 1.0f / p->pdf);
    go_on(p, &x->surface, l);
    p->travelled_m = 0.0f;
}

/* >>transmission */

/* A microfacet that the path meets on a smooth interface, and how much of it is masked. */
typedef struct facet {
    hdrp_v3 t, b, n, h, v;
    float alpha, v_dot_h;
} facet;

static facet choose_facet(path* p, const vertex* x)
{
    facet f;
    hdrp_v3 local, h;
    f.t = x->data.tangent;
    f.b = x->data.bitangent;
    f.n = x->data.normal;
    f.v = x->view.v;
    f.alpha = hdrp_brdf_alpha_from_perceptual_roughness(x->data.perceptual_roughness);
    local = hdrp_v3_make(hdrp_v3_dot(f.t, f.v), hdrp_v3_dot(f.b, f.v), hdrp_v3_dot(f.n, f.v));
    h = hdrp_brdf_sample_vndf(local, f.alpha, f.alpha, random_pair(p));
    f.h = hdrp_v3_normalize(hdrp_v3_mad(hdrp_v3_mad(hdrp_v3_scale(f.t, h.x), f.b, h.y), f.n, h.z));
    f.v_dot_h = hdrp_saturate(hdrp_v3_dot(f.v, f.h));
    return f;
}

/* G2 / G1: the weight of a direction whose facet was drawn from the visible ones. */
static float unmasked(const facet* f, hdrp_v3 l)
{
    float n_dot_v = hdrp_v3_dot(f->n, f->v), n_dot_l = hdrp_abs(hdrp_v3_dot(f->n, l));
    float both = hdrp_brdf_v_smith_ggx(n_dot_l, n_dot_v, f->alpha);
    float one = hdrp_brdf_v_smith_ggx(1.0f, n_dot_v, f->alpha);
    /* V is G2 / (4 n.l n.v), and that of a light along the normal has the G1 of the view. */
    return n_dot_l * both / hdrp_max(one, HDRP_FLT_MIN);
}

/* Into a volume. */
static void refract_in(path* p, const vertex* x, hdrp_v3 tint)
{
    facet f = choose_facet(p, x);
    hdrp_brdf_refraction r = hdrp_brdf_refract(f.v, f.h, 1.0f / x->data.ior);
    hdrp_v3 fresnel = hdrp_brdf_f_schlick_rgb(x->view.fresnel0, x->view.fresnel90, f.v_dot_h);
    if (!(hdrp_v3_dot(r.direction, x->surface.geometric_normal) < 0.0f)) {
        p->alive = false;
        return;
    }
    p->throughput = hdrp_v3_scale(
        hdrp_v3_mul(hdrp_v3_mul(p->throughput, tint), hdrp_v3_sub(hdrp_v3_splat(1.0f), fresnel)),
        unmasked(&f, r.direction));
    p->medium = x->surface.material;
    p->sampled = false;
    go_on(p, &x->surface, r.direction);
}

/* Meets the boundary of a volume from inside: out, or back. */
static void refract_out(path* p, vertex* x)
{
    float ior = x->surface.brdf.ior;
    facet f;
    hdrp_brdf_refraction r;
    hdrp_v3 l;
    bool out;
    x->data = hdrp_brdf_data_from_surface(x->surface.brdf);
    x->view.v = x->surface.view;
    f = choose_facet(p, x);
    r = hdrp_brdf_refract(f.v, f.h, ior);
    out = random_number(p) >= hdrp_brdf_f_dielectric_exact(f.v_dot_h, 1.0f / ior);
    l = out ? r.direction : hdrp_v3_normalize(hdrp_v3_mad(hdrp_v3_neg(f.v), f.h, 2.0f * f.v_dot_h));
    if (!((hdrp_v3_dot(l, x->surface.geometric_normal) < 0.0f) == out)) {
        p->alive = false;
        return;
    }
    p->throughput = hdrp_v3_scale(p->throughput, unmasked(&f, l));
    p->medium = out ? NULL : p->medium;
    p->sampled = false;
    go_on(p, &x->surface, l);
}

static void transmit(path* p, const vertex* x, hdrp_v3 through)
{
    const rd_surface* s = &x->surface;
    float k = 1.0f / (1.0f - x->share);
    p->throughput = hdrp_v3_scale(p->throughput, k);
    if (is_volume(s->material)) {
        refract_in(p, x, x->data.diffuse_color);
        p->throughput = hdrp_v3_scale(p->throughput, x->data.transmission);
    } else {
        p->throughput = hdrp_v3_mul(p->throughput, through);
        go_on(p, s, p->ray.direction);
    }
}

/* >>paths */

static void meet_surface(wave* v, uint32_t index, const rd_hit* hit)
{
    path* p = &v->paths[index];
    vertex x;
    hdrp_v3 through;
    rd_surface_evaluate(v->s->r->scene, &p->ray, NULL, hit, &x.surface);
    if (passes_by(p, &x.surface)) {
        if (x.surface.material->additive) {
            emit(p, &x.surface, v->s->r->exposure);
        }
        go_on(p, &x.surface, p->ray.direction);
        return;
    }
    p->covered = true;
    if (is_volume(x.surface.material) && x.surface.back_face) {
        refract_out(p, &x);
        return;
    }
    emit(p, &x.surface, v->s->r->exposure);
    if (x.surface.material->unlit) {
        p->alive = false;
        return;
    }
    through = prepare(v, &x);
    if (hdrp_v3_max_component(through) > 0.0f && random_number(p) >= x.share) {
        transmit(p, &x, through);
        return;
    }
    sample_lights(v, index, &x);
    sample_sky(v, index, &x);
    scatter(v, index, &x);
}

static void survive(path* p)
{
    float q = hdrp_min(hdrp_v3_max_component(p->throughput), MAX_SURVIVAL);
    ++p->events;
    if (!p->alive || p->events <= SURE_EVENTS) {
        return;
    }
    if (p->events > MAX_EVENTS || !(random_number(p) < q)) {
        p->alive = false;
        return;
    }
    p->throughput = hdrp_v3_scale(p->throughput, 1.0f / q);
}

static void advance(wave* v, uint32_t index, const rd_hit* hit)
{
    path* p = &v->paths[index];
    if (p->medium && hit->mesh != RD_NO_HIT) {
        p->throughput = hdrp_v3_mul(p->throughput, rd_volume_transmittance(p->medium, hit->t));
    }
    if (p->sampled) {
        meet_lights(v, p, hit->mesh == RD_NO_HIT ? HDRP_FLT_MAX : hit->t);
    }
    if (hit->mesh == RD_NO_HIT) {
        leave(v, p);
        return;
    }
    meet_surface(v, index, hit);
    survive(p);
}

static void add_unshadowed(wave* v, shadow_list* list, rd_worker* w)
{
    hdrp_v3 transmittance[RD_RUN];
    bool shadows = (v->lighting->features & RD_FEATURE_SHADOWS) != 0;
    if (shadows && list->count > 0) {
        rd_trace_transmittance(v->lighting->trace, list->rays, list->passing, transmittance,
                               list->count);
        w->counts.shadow_rays += list->count;
    }
    for (uint32_t i = 0; i < list->count; ++i) {
        path* p = &v->paths[list->items[i].path];
        hdrp_v3 light = list->items[i].light;
        p->radiance =
            hdrp_v3_add(p->radiance, shadows ? hdrp_v3_mul(light, transmittance[i]) : light);
    }
    list->count = 0;
}

/* One event of all paths that are still under way. */
static bool step(wave* v, rd_worker* w)
{
    rd_ray rays[RD_RUN];
    rd_hit hits[RD_RUN];
    uint32_t index[RD_RUN], n = 0;
    for (uint32_t i = 0; i < v->count; ++i) {
        if (v->paths[i].alive) {
            rays[n] = v->paths[i].ray;
            index[n++] = i;
        }
    }
    if (n == 0) {
        return false;
    }
    rd_trace_closest_any(v->lighting->trace, rays, hits, n);
    w->counts.path_rays += n;
    for (uint32_t i = 0; i < n; ++i) {
        advance(v, index[i], &hits[i]);
    }
    add_unshadowed(v, &v->lights, w);
    add_unshadowed(v, &v->sky, w);
    return true;
}

static path begin(const rd_sub_frame* s, int x, int y)
{
    path p;
    memset(&p, 0, sizeof p);
    p.alive = p.from_eye = true;
    p.ray = rd_pixel_ray(s, x, y);
    p.throughput = hdrp_v3_splat(1.0f);
    p.seed = hdrp_hash2(rd_pixel_hash(s, x, y), s->index);
    return p;
}

void rd_reference_row(const rd_sub_frame* s, rd_worker* w, int y)
{
    wave v;
    float* film = s->r->film + rd_pixel(s, 0, y) * 4;
    v.s = s;
    v.lighting = s->r->lighting;
    v.lights.count = v.sky.count = 0;
    v.lights.passing = RD_PASSING_SMOOTH;
    v.sky.passing = RD_PASSING_THIN;
    for (int x0 = 0; x0 < s->r->width; x0 += RD_RUN) {
        v.count = (uint32_t)(s->r->width - x0 < RD_RUN ? s->r->width - x0 : RD_RUN);
        for (uint32_t i = 0; i < v.count; ++i) {
            v.paths[i] = begin(s, x0 + (int)i, y);
        }
        while (step(&v, w)) {
        }
        for (uint32_t i = 0; i < v.count; ++i, film += 4) {
            film[0] += v.paths[i].radiance.x;
            film[1] += v.paths[i].radiance.y;
            film[2] += v.paths[i].radiance.z;
            film[3] += v.paths[i].covered ? 1.0f : 0.0f;
        }
    }
    w->counts.primary_rays += (uint64_t)s->r->width;
}
