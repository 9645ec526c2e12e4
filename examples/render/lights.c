#include "lights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Width of the soft edge of pyramids and boxes, as a share of their size. */
#define SOFT_EDGE 0.15f

static hdrp_light unlayered_record(const rd_light* l)
{
    hdrp_v3 color = hdrp_v3_scale(l->color, l->intensity);
    float range = l->range_m > 0.0f ? l->range_m : HDRP_LIGHT_RANGE_INFINITE;
    hdrp_light r;
    switch (l->type) {
    case RD_LIGHT_DIRECTIONAL:
        return hdrp_light_directional(l->forward, color, 2.0f * l->angular_radius_rad);
    case RD_LIGHT_SPOT:
        r = hdrp_light_spot(l->position, l->forward, color, range, l->inner_angle_rad,
                            l->outer_angle_rad);
        break;
    case RD_LIGHT_PYRAMID:
        r = hdrp_light_pyramid(l->position, l->forward, l->up, color, range, atanf(l->half_width),
                               atanf(l->half_height), SOFT_EDGE);
        break;
    case RD_LIGHT_BOX:
        r = hdrp_light_box(l->position, l->forward, l->up, color, l->half_width, l->half_height,
                           range, SOFT_EDGE * hdrp_min(l->half_width, l->half_height));
        break;
    default:
        r = hdrp_light_point(l->position, color, range);
        break;
    }
    r.forward_radius.w = l->radius_m;
    return r;
}

hdrp_light rd_light_record(const rd_light* l)
{
    hdrp_light r = unlayered_record(l);
    r.bits.x |= l->shadowless ? 0u : HDRP_LIGHT_FEATURE_SHADOW;
    r.bits.y = l->light_layers ? l->light_layers : HDRP_LIGHT_LAYERS_ALL;
    return r;
}

/* >>generated lights */

static hdrp_v3 hue(float h)
{
    float x = h * 6.0f;
    return hdrp_v3_saturate(hdrp_v3_make(hdrp_abs(x - 3.0f) - 1.0f, 2.0f - hdrp_abs(x - 2.0f),
                                         2.0f - hdrp_abs(x - 4.0f)));
}

/* A number in [0,1) for each light and purpose. */
static float random_of(uint32_t seed, uint32_t light, uint32_t purpose)
{
    return hdrp_unit_from_u32(hdrp_hash3(seed, light, purpose));
}

/* Ranges are such that a place is reached by about eight lights, whatever their number; that makes
 * the average lux eight times those of one light, averaged over the volume of its range. */
static hdrp_light generated(const rd_lights_desc* d, uint32_t i)
{
    const rd_bounds* b = &d->scene->bounds;
    hdrp_v3 size = hdrp_v3_sub(b->high, b->low);
    hdrp_v3 least = hdrp_v3_splat(0.02f * hdrp_v3_length(size) + 1e-3f);
    hdrp_v3 box = hdrp_v3_make(hdrp_max(size.x, least.x), hdrp_max(size.y, least.y),
                               hdrp_max(size.z, least.z));
    float volume = box.x * box.y * box.z;
    float range = cbrtf(8.0f * volume / (float)d->generated * 3.0f / (4.0f * HDRP_PI));
    hdrp_v3 at = hdrp_v3_make(random_of(d->seed, i, 0u), random_of(d->seed, i, 1u),
                              random_of(d->seed, i, 2u));
    /* Somewhat paler than a pure hue, and of equal luminance. */
    hdrp_v3 color = hdrp_v3_lerp(hue(random_of(d->seed, i, 3u)), hdrp_v3_splat(1.0f), 0.25f);
    /* The mean of candela / d^2 over a ball of radius R is 3 candela / R^2. */
    float candela = d->generated_lux * range * range / (8.0f * 3.0f);
    hdrp_light l = hdrp_light_point(hdrp_v3_add(b->low, hdrp_v3_mul(at, box)),
                                    hdrp_v3_scale(color, candela / hdrp_luminance(color)), range);
    l.bits.x |= HDRP_LIGHT_FEATURE_SHADOW;
    return l;
}

/* >>the list */

static void add(rd_lights* lights, hdrp_light light, uint32_t first_blocker, uint32_t blockers)
{
    hdrp_cull_blocker_links links = {first_blocker, blockers};
    lights->items[lights->count] = light;
    lights->places[lights->count] = hdrp_cull_light_place(light);
    lights->links[lights->count++] = links;
}

static void set_blockers(rd_lights* lights, const rd_scene* scene)
{
    hdrp_cull_blocker_scene* b = &lights->blockers;
    b->places = lights->places;
    b->lights = lights->links;
    b->links = scene->blocker_links;
    b->blockers = scene->blockers;
    b->light_count = lights->count;
    b->link_count = (uint32_t)scene->blocker_link_count;
    b->blocker_count = (uint32_t)scene->blocker_count;
}

bool rd_lights_make(rd_lights* lights, const rd_lights_desc* d)
{
    size_t n = (size_t)d->scene->light_count + d->generated + 1;
    memset(lights, 0, sizeof *lights);
    lights->items = (hdrp_light*)malloc(n * sizeof *lights->items);
    lights->places = (hdrp_v4*)malloc(n * sizeof *lights->places);
    lights->links = (hdrp_cull_blocker_links*)malloc(n * sizeof *lights->links);
    if (!lights->items || !lights->places || !lights->links) {
        rd_lights_free(lights);
        return false;
    }
    if (d->sun) {
        hdrp_light sun = *d->sun;
        sun.bits.x |= HDRP_LIGHT_FEATURE_SHADOW;
        add(lights, sun, 0u, 0u);
    }
    for (int i = 0; i < d->scene->light_count; ++i) {
        const rd_light* l = &d->scene->lights[i];
        add(lights, rd_light_record(l), l->first_blocker, l->blocker_count);
    }
    for (uint32_t i = 0; i < d->generated; ++i) {
        add(lights, generated(d, i), 0u, 0u);
    }
    set_blockers(lights, d->scene);
    return true;
}

void rd_lights_free(rd_lights* lights)
{
    free(lights->items);
    free(lights->places);
    free(lights->links);
    memset(lights, 0, sizeof *lights);
}

/* >>geometry of a light */

static float outside(float x, float low, float high)
{
    return hdrp_max(hdrp_max(low - x, x - high), 0.0f);
}

bool rd_light_misses(const hdrp_light* light, const rd_bounds* box)
{
    hdrp_v4 c = light->position_range;
    hdrp_u32 type = hdrp_light_type(*light);
    hdrp_v3 d;
    if (type == HDRP_LIGHT_TYPE_DIRECTIONAL || type == HDRP_LIGHT_TYPE_BOX) {
        return false;
    }
    d = hdrp_v3_make(outside(c.x, box->low.x, box->high.x), outside(c.y, box->low.y, box->high.y),
                     outside(c.z, box->low.z, box->high.z));
    return hdrp_v3_dot(d, d) >= c.w * c.w;
}

float rd_light_sine(const hdrp_light* light, const hdrp_light_incident* incident)
{
    hdrp_u32 type = hdrp_light_type(*light);
    float size = light->forward_radius.w;
    if (type == HDRP_LIGHT_TYPE_DIRECTIONAL) {
        return sinf(0.5f * size);
    }
    if (type == HDRP_LIGHT_TYPE_BOX || !(size > 0.0f)) {
        return 0.0f;
    }
    return hdrp_min(size / hdrp_max(incident->distance_m, 1e-6f), 0.99f);
}

float rd_light_variance(float sine)
{
    /* Half vectors move by half the angle: slopes even over a disc of radius sine / 2, whose variance
     * along an axis is a quarter of its square. Variances are in units of alpha^2, twice that. */
    return 2.0f * 0.25f * hdrp_sq(0.5f * sine);
}

hdrp_v3 rd_light_direction(const hdrp_light_incident* incident, float sine, hdrp_v2 u)
{
    hdrp_basis b = hdrp_basis_from_normal(incident->l);
    hdrp_v2 disc = hdrp_v2_scale(hdrp_disk_concentric(u), sine);
    float along = sqrtf(hdrp_max(1.0f - hdrp_v2_dot(disc, disc), 0.0f));
    hdrp_v3 side = hdrp_v3_mad(hdrp_v3_scale(b.tangent, disc.x), b.bitangent, disc.y);
    return hdrp_v3_normalize(hdrp_v3_mad(side, incident->l, along));
}

float rd_light_shadow_end(const hdrp_light* light, const hdrp_light_incident* incident)
{
    if (hdrp_light_type(*light) == HDRP_LIGHT_TYPE_DIRECTIONAL) {
        return HDRP_FLT_MAX;
    }
    return hdrp_max(incident->distance_m - light->forward_radius.w, 0.0f) * (1.0f - 1e-4f);
}
