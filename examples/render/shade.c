/* The light loop: every light and the sky on a run of points. */
#include "lists.h"

#include <math.h>

/* >>variants
 * A constant mask of features lets the compiler drop what a material does not have; the mask that a
 * GBuffer texel carries chooses the variant, as tile classification does on a GPU. */

typedef struct variant {
    const char* name;
    hdrp_u32 features;
    void (*view)(const rd_shade_point* p, hdrp_brdf_fgd fgd, hdrp_brdf_lit_view* out);
    hdrp_brdf_lit (*eval)(const rd_shade_point* p, const hdrp_brdf_lit_view* view, hdrp_v3 l,
                          float variance);
    hdrp_brdf_lit_env (*env)(const rd_shade_point* p, const hdrp_brdf_lit_view* view,
                             float occlusion, float specular_occlusion);
} variant;

/* A source with a size is seen as if the surface had more variance of its normals. */
#define DEFINE_VARIANT(name, features)                                                             \
    static void view_##name(const rd_shade_point* p, hdrp_brdf_fgd fgd, hdrp_brdf_lit_view* out)   \
    {                                                                                              \
        *out = hdrp_brdf_lit_view_make(p->data, p->view, fgd, features);                           \
    }                                                                                              \
    static hdrp_brdf_lit eval_##name(const rd_shade_point* p, const hdrp_brdf_lit_view* view,      \
                                     hdrp_v3 l, float variance)                                    \
    {                                                                                              \
        return hdrp_brdf_lit_eval(p->data, hdrp_brdf_lit_view_widened(*view, variance), l,         \
                                  features);                                                       \
    }                                                                                              \
    static hdrp_brdf_lit_env env_##name(const rd_shade_point* p, const hdrp_brdf_lit_view* view,   \
                                        float occlusion, float specular_occlusion)                 \
    {                                                                                              \
        hdrp_brdf_data d = p->data;                                                                \
        d.ambient_occlusion = occlusion;                                                           \
        d.specular_occlusion = specular_occlusion;                                                 \
        return hdrp_brdf_lit_env_make(d, *view, features);                                         \
    }

#define REFRACTIVE (HDRP_BRDF_FEATURE_REFRACTION | HDRP_BRDF_FEATURE_IRIDESCENCE)
#define SLAB       (HDRP_BRDF_FEATURE_SUBSURFACE | HDRP_BRDF_FEATURE_TRANSMISSION)
#define EVERYTHING HDRP_BRDF_FEATURE_ALL

DEFINE_VARIANT(standard, 0u)
DEFINE_VARIANT(anisotropy, HDRP_BRDF_FEATURE_ANISOTROPY)
DEFINE_VARIANT(iridescence, HDRP_BRDF_FEATURE_IRIDESCENCE)
DEFINE_VARIANT(coat, HDRP_BRDF_FEATURE_CLEAR_COAT)
DEFINE_VARIANT(slab, SLAB)
DEFINE_VARIANT(refraction, REFRACTIVE)
DEFINE_VARIANT(all, EVERYTHING)

#define VARIANT(name, features)                                                                    \
    {                                                                                              \
#name, features, view_##name, eval_##name, env_##name                                      \
    }

/* From few features to all: the first that has what a material needs serves. */
static const variant variants[RD_SHADE_VARIANTS] = {
    VARIANT(standard, 0u),
    VARIANT(anisotropy, HDRP_BRDF_FEATURE_ANISOTROPY),
    VARIANT(iridescence, HDRP_BRDF_FEATURE_IRIDESCENCE),
    VARIANT(coat, HDRP_BRDF_FEATURE_CLEAR_COAT),
    VARIANT(slab, SLAB),
    VARIANT(refraction, REFRACTIVE),
    VARIANT(all, EVERYTHING),
};

static const variant* find_variant(hdrp_u32 features)
{
    const variant* v = variants;
    while (features & ~v->features) {
        ++v;
    }
    return v;
}

const char* rd_shade_variant_name(int i)
{
    return variants[i].name;
}

/* >>a run of points */

typedef struct run {
    const rd_lighting* lighting;
    const rd_grid* grid;
    const rd_shade_point* points;
    uint32_t count, index;
    rd_shaded* out;
    rd_shade_counts* counts;
    const variant* variants[RD_SHADE_MAX];
    hdrp_brdf_lit_view views[RD_SHADE_MAX];
} run;

static rd_bounds bounds_of(const rd_shade_point* p, uint32_t count)
{
    rd_bounds b;
    b.low = b.high = p[0].position;
    for (uint32_t i = 1; i < count; ++i) {
        hdrp_v3 q = p[i].position;
        b.low =
            hdrp_v3_make(hdrp_min(b.low.x, q.x), hdrp_min(b.low.y, q.y), hdrp_min(b.low.z, q.z));
        b.high =
            hdrp_v3_make(hdrp_max(b.high.x, q.x), hdrp_max(b.high.y, q.y), hdrp_max(b.high.z, q.z));
    }
    return b;
}

static void begin(run* r)
{
    hdrp_v3 zero = hdrp_v3_splat(0.0f);
    for (uint32_t i = 0; i < r->count; ++i) {
        const rd_shade_point* p = &r->points[i];
        r->variants[i] = find_variant(p->data.features);
        r->variants[i]->view(p, rd_lighting_fgd(r->lighting, &p->data, p->view), &r->views[i]);
        r->out[i].diffuse = r->out[i].specular = r->out[i].transmitted_weight = zero;
        r->out[i].transmitted_direction = hdrp_v3_neg(p->view);
        r->out[i].transmitted_perceptual_roughness = 0.0f;
    }
}

/* >>lights */

/* The points that a light reaches, and the rays that tell whether it does. */
typedef struct reached {
    uint32_t count;
    uint32_t point[RD_SHADE_MAX];
    hdrp_light_incident incident[RD_SHADE_MAX];
    float variance[RD_SHADE_MAX]; /* that stands for the size of the source */
    rd_ray rays[RD_SHADE_MAX];
    hdrp_v3 transmittance[RD_SHADE_MAX];
} reached;

/* Towards a point of the source for this sample of this pixel and light. */
static hdrp_v3 shadow_direction(const run* r, const rd_shade_point* p, uint32_t light,
                                const hdrp_light_incident* in, float sine)
{
    hdrp_v2 u = hdrp_r2(r->index);
    uint32_t hash = hdrp_hash2(p->hash, light);
    if (!r->lighting->soft_shadows || !(sine > 0.0f)) {
        return in->l;
    }
    u.x += (float)(hash & 0xffffu) / 65536.0f;
    u.y += (float)(hash >> 16) / 65536.0f;
    return rd_light_direction(in, sine, hdrp_v2_make(u.x - floorf(u.x), u.y - floorf(u.y)));
}

static rd_ray shadow_ray(const run* r, const rd_shade_point* p, uint32_t light,
                         const hdrp_light_incident* in, float sine)
{
    rd_ray ray;
    hdrp_v3 l = shadow_direction(r, p, light, in, sine);
    float side = hdrp_sign_not_zero(hdrp_v3_dot(l, p->geometric_normal));
    ray.origin = rd_trace_offset(p->position, hdrp_v3_scale(p->geometric_normal, side));
    ray.direction = l;
    ray.t_min = 0.0f;
    ray.t_max = rd_light_shadow_end(&r->lighting->lights.items[light], in);
    return ray;
}

static bool is_lit(const rd_shade_point* p, const hdrp_light_incident* in)
{
    bool crosses =
        (p->data.features & (HDRP_BRDF_FEATURE_REFRACTION | HDRP_BRDF_FEATURE_TRANSMISSION)) != 0u;
    return crosses || hdrp_v3_dot(p->data.normal, in->l) > 0.0f ||
           hdrp_v3_dot(p->data.coat_normal, in->l) > 0.0f;
}

static bool is_blocked(const run* r, uint32_t light, uint32_t mask, hdrp_v3 position)
{
    return r->lighting->features & RD_FEATURE_BLOCKERS && mask != 0u &&
           hdrp_cull_blocker_light_visible(&r->lighting->lights.blockers, light, mask, position) ==
               0.0f;
}

/* What may keep a light from all points. */
#define ALL_BLOCKERS UINT32_MAX

/* Appends those of some points. */
static void find_reached(const run* r, uint32_t light, uint32_t mask, uint32_t first, uint32_t end,
                         reached* out)
{
    const hdrp_light* item = &r->lighting->lights.items[light];
    int kind = r->grid && r->grid->lists.desc.slice_count > 1u;
    for (uint32_t i = first; i < end; ++i) {
        const rd_shade_point* p = &r->points[i];
        hdrp_light_incident in = hdrp_light_eval(*item, p->position);
        bool in_range = hdrp_v3_max_component(in.illuminance) > 0.0f;
        r->counts->in_range[kind] += in_range;
        if (in_range && hdrp_light_affects(*item, p->layers) && is_lit(p, &in) &&
            !is_blocked(r, light, mask, p->position)) {
            float sine = rd_light_sine(item, &in);
            out->point[out->count] = i;
            out->incident[out->count] = in;
            out->variance[out->count] = rd_light_variance(sine);
            out->rays[out->count] = shadow_ray(r, p, light, &in, sine);
            ++out->count;
        }
    }
    r->counts->visited[kind] += end - first;
}

static void trace_shadows(const run* r, uint32_t light, reached* l)
{
    bool casts = (r->lighting->lights.items[light].bits.x & HDRP_LIGHT_FEATURE_SHADOW) != 0u;
    if (!casts || !(r->lighting->features & RD_FEATURE_SHADOWS)) {
        for (uint32_t k = 0; k < l->count; ++k) {
            l->transmittance[k] = hdrp_v3_splat(1.0f);
        }
        return;
    }
    rd_trace_transmittance(r->lighting->trace, l->rays, RD_PASSING_ALL, l->transmittance, l->count);
    r->counts->shadow_rays += l->count;
}

static void add_light(const run* r, uint32_t light, reached* l)
{
    trace_shadows(r, light, l);
    for (uint32_t k = 0; k < l->count; ++k) {
        uint32_t i = l->point[k];
        hdrp_v3 lux = hdrp_v3_mul(l->incident[k].illuminance, l->transmittance[k]);
        hdrp_brdf_lit lit;
        if (!(hdrp_v3_max_component(lux) > 0.0f)) {
            continue;
        }
        lit = r->variants[i]->eval(&r->points[i], &r->views[i], l->incident[k].l, l->variance[k]);
        r->out[i].diffuse = hdrp_v3_add(r->out[i].diffuse, hdrp_v3_mul(lux, lit.diffuse));
        r->out[i].specular = hdrp_v3_add(r->out[i].specular, hdrp_v3_mul(lux, lit.specular));
    }
}

static void add_all_lights(const run* r)
{
    const rd_lights* lights = &r->lighting->lights;
    rd_bounds bounds = bounds_of(r->points, r->count);
    for (uint32_t i = 0; i < lights->count; ++i) {
        if (!rd_light_misses(&lights->items[i], &bounds)) {
            reached l;
            l.count = 0;
            find_reached(r, i, ALL_BLOCKERS, 0, r->count, &l);
            add_light(r, i, &l);
        }
    }
}

/* Neighbours with one list, in one sixteenth of a tile: which entries they have yet to visit. */
typedef struct cursor {
    uint32_t first_point, end_point;
    uint32_t entry, last_entry;
} cursor;

static bool shares_entries(const run* r, const rd_shade_point* a, const rd_shade_point* b)
{
    hdrp_u32x4 block = r->grid->lists.grid.cells;
    return a->first_entry == b->first_entry && a->last_entry == b->last_entry &&
           a->x / block.z == b->x / block.z && a->y / block.w == b->y / block.w;
}

static uint32_t make_cursors(const run* r, cursor* cursors)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < r->count; ++i) {
        const rd_shade_point* p = &r->points[i];
        if (n > 0 && shares_entries(r, p, &r->points[i - 1])) {
            ++cursors[n - 1].end_point;
        } else {
            cursor c = {i, i + 1, p->first_entry, p->last_entry};
            cursors[n++] = c;
        }
    }
    return n;
}

/* The next light of a list; NO_LIGHT at its end. */
#define NO_LIGHT UINT32_MAX

static uint32_t next_light(const run* r, const cursor* c)
{
    return c->entry < c->last_entry ? hdrp_cull_entry_index(r->grid->lists.entries[c->entry])
                                    : NO_LIGHT;
}

/* Takes the next entry. */
static void visit(const run* r, cursor* c, uint32_t light, reached* out)
{
    const rd_shade_point* p = &r->points[c->first_point];
    uint32_t entry = c->entry++;
    uint32_t mask = r->grid->masks ? r->grid->masks[entry] : ALL_BLOCKERS;
    if (hdrp_cull_entry_covers(r->grid->lists.grid, r->grid->lists.entries[entry], p->x, p->y)) {
        find_reached(r, light, mask, c->first_point, c->end_point, out);
    }
}

/* Lists are in the order of the lights: merged, they give that of the loop over all of them. */
static void add_listed_lights(const run* r)
{
    cursor cursors[RD_SHADE_MAX];
    uint32_t n = make_cursors(r, cursors);
    for (;;) {
        uint32_t light = NO_LIGHT;
        reached l;
        for (uint32_t i = 0; i < n; ++i) {
            uint32_t next = next_light(r, &cursors[i]);
            light = next < light ? next : light;
        }
        if (light == NO_LIGHT) {
            return;
        }
        l.count = 0;
        for (uint32_t i = 0; i < n; ++i) {
            if (next_light(r, &cursors[i]) == light) {
                visit(r, &cursors[i], light, &l);
            }
        }
        add_light(r, light, &l);
    }
}

/* >>sky */

static hdrp_v3 irradiance(const rd_lighting* l, hdrp_v3 normal)
{
    return l->fast_irradiance ? hdrp_env_irradiance_fast(l->environment->sh, normal)
                              : hdrp_env_irradiance(&l->environment->baked, normal);
}

static void add_sky(const rd_lighting* l, const hdrp_brdf_lit_env* e, const rd_shade_point* p,
                    rd_shaded* out)
{
    const hdrp_env* env = &l->environment->baked;
    hdrp_v3 lux = irradiance(l, p->data.normal);
    hdrp_v3 nits = hdrp_env_specular(env, e->specular_direction, e->specular_perceptual_roughness);
    out->diffuse = hdrp_v3_mad(out->diffuse, hdrp_v3_mul(lux, e->diffuse_weight), HDRP_INV_PI);
    out->specular = hdrp_v3_add(out->specular, hdrp_v3_mul(nits, e->specular_weight));
    if (hdrp_v3_max_component(e->through_weight) > 0.0f) {
        lux = irradiance(l, hdrp_v3_neg(p->data.normal));
        out->diffuse = hdrp_v3_mad(out->diffuse, hdrp_v3_mul(lux, e->through_weight), HDRP_INV_PI);
    }
    if (e->coat_weight > 0.0f) {
        nits = hdrp_env_specular(env, e->coat_direction, e->coat_perceptual_roughness);
        out->specular = hdrp_v3_mad(out->specular, nits, e->coat_weight);
    }
}

static void add_environment(const run* r)
{
    const rd_lighting* l = r->lighting;
    bool sky = l->environment->present && l->features & RD_FEATURE_ENVIRONMENT;
    for (uint32_t i = 0; i < r->count; ++i) {
        const rd_shade_point* p = &r->points[i];
        float occlusion = hdrp_min(p->data.ambient_occlusion, p->visibility);
        float specular = p->data.specular_occlusion *
                         hdrp_brdf_specular_occlusion(occlusion, r->views[i].n_dot_v,
                                                      p->data.perceptual_roughness);
        hdrp_brdf_lit_env e = r->variants[i]->env(p, &r->views[i], occlusion, specular);
        r->out[i].transmitted_weight = e.transmitted_weight;
        r->out[i].transmitted_direction = e.transmitted_direction;
        r->out[i].transmitted_perceptual_roughness = e.transmitted_perceptual_roughness;
        if (sky) {
            add_sky(l, &e, p, &r->out[i]);
        }
    }
}

static void count(const run* r, double ms)
{
    rd_shade_counts* c = r->counts;
    ptrdiff_t first = r->variants[0] - variants;
    bool same = true;
    for (uint32_t i = 0; i < r->count; ++i) {
        ++c->samples[r->variants[i] - variants];
        same = same && r->variants[i] == r->variants[0];
    }
    if (same) {
        c->timed_samples[first] += r->count;
        c->timed_ms[first] += ms;
    }
}

void rd_shade(const rd_lighting* l, const rd_grid* grid, const rd_shade_point* points,
              uint32_t point_count, uint32_t index, rd_shaded* out, rd_shade_counts* counts)
{
    run r;
    double start = rd_now_ms();
    if (point_count == 0) {
        return;
    }
    r.lighting = l;
    r.grid = grid;
    r.points = points;
    r.count = point_count;
    r.index = index;
    r.out = out;
    r.counts = counts;
    begin(&r);
    if (l->features & RD_FEATURE_LIGHTS) {
        (grid ? add_listed_lights : add_all_lights)(&r);
    }
    add_environment(&r);
    count(&r, rd_now_ms() - start);
}
