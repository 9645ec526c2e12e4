/* Rays against the scene, through Embree. */
#ifndef RD_TRACE_H
#define RD_TRACE_H

#include "report.h"
#include "scene.h"

#define RD_NO_HIT UINT32_MAX
/* Transparent surfaces along one ray that are kept; further ones are counted as dropped. */
#define RD_LAYERS_MAX 4096

typedef struct rd_ray {
    hdrp_v3 origin;
    float t_min;
    hdrp_v3 direction; /* unit, so that t is a distance */
    float t_max;
} rd_ray;

/* Barycentric weights: 1 - u - v, u and v of the three corners. */
typedef struct rd_hit {
    float t, u, v;
    uint32_t mesh; /* RD_NO_HIT: the ray leaves the scene */
    uint32_t triangle;
} rd_hit;

/* The transparent surfaces along a ray, nearest first. Grows by itself; one for each thread. */
typedef struct rd_layers {
    rd_hit* hits;
    uint32_t count, capacity;
    uint64_t dropped; /* beyond RD_LAYERS_MAX, summed over all rays */
} rd_layers;

typedef struct rd_trace rd_trace;

/* Keeps referring to the scene. NULL on failure. */
rd_trace* rd_trace_build(const rd_scene* scene, rd_report* report);
void rd_trace_free(rd_trace* trace);

/* Is there anything transparent at all? */
bool rd_trace_has_layers(const rd_trace* trace);

/* Nearest opaque or alpha-tested surface of each ray. Back faces of single-sided materials are
 * passed through. Neighbouring rays should be alike: they travel in packets. */
void rd_trace_closest(const rd_trace* trace, const rd_ray* rays, rd_hit* hits, uint32_t count);

/* The same including transparent surfaces, and without culling: for paths of light. */
void rd_trace_closest_any(const rd_trace* trace, const rd_ray* rays, rd_hit* hits, uint32_t count);

/* Which transparent surfaces let light straight through. The others stop it: whoever asks finds
 * that light by following it through them. */
typedef enum rd_passing {
    RD_PASSING_ALL,    /* real time */
    RD_PASSING_SMOOTH, /* all but rough sheets */
    RD_PASSING_THIN    /* smooth sheets; no volumes, which bend light */
} rd_passing;

/* Share of light that passes from end to end of each ray: 0 behind opaque surfaces, coloured by
 * the transparent ones between. */
void rd_trace_transmittance(const rd_trace* trace, const rd_ray* rays, rd_passing passing,
                            hdrp_v3* out, uint32_t count);

/* Does anything opaque lie between the ends of each ray? Rays need not be alike. */
void rd_trace_hidden(const rd_trace* trace, const rd_ray* rays, bool* hidden, uint32_t count);

/* All transparent surfaces between t_min and t_max of the ray, nearest first. */
void rd_trace_layers(const rd_trace* trace, const rd_ray* ray, rd_layers* layers);

/* Where a ray that leaves the surface at p towards the side of normal n starts: off the surface by
 * more than the rounding of its coordinates. */
hdrp_v3 rd_trace_offset(hdrp_v3 p, hdrp_v3 n);

#endif
