/* What lights the surfaces: lights, sky, tables. And the light loop, the only one there is: it does
 * not know whether a material came out of a GBuffer or straight from a surface. */
#ifndef RD_LIGHTING_H
#define RD_LIGHTING_H

#include "environment.h"
#include "hdrp_brdf.h"
#include "lights.h"
#include "surface.h"
#include "trace.h"

/* Points that are shaded together: their shadow rays travel in packets, and lights that none of
 * them sees are skipped at once. They should be neighbours. */
#define RD_SHADE_MAX 64

#define RD_FGD_SIZE  64

typedef struct rd_lighting {
    const rd_scene* scene;
    const rd_trace* trace;
    const rd_environment* environment;
    rd_lights lights;
    hdrp_brdf_fgd* fgd;   /* RD_FGD_SIZE squared; NULL: the analytic fit */
    uint32_t features;    /* RD_FEATURE_... */
    bool soft_shadows;    /* aimed at random points of the sources */
    bool fast_irradiance; /* by spherical harmonics */
} rd_lighting;

typedef struct rd_lighting_desc {
    const rd_scene* scene;
    const rd_trace* trace;
    const rd_environment* environment;
    const rd_options* options;
} rd_lighting_desc;

bool rd_lighting_make(rd_lighting* l, const rd_lighting_desc* desc, rd_stats* stats,
                      rd_report* report);
/* Refers to the scene, but has no light. */
void rd_lighting_make_dark(rd_lighting* l, const rd_lighting_desc* desc);
void rd_lighting_free(rd_lighting* l);

/* The features of materials that are switched on. */
hdrp_u32 rd_lighting_material_features(uint32_t features);

/* Engine data of a surface, with what is switched off left out and its roughness filtered; black
 * for one that is unlit or only adds light. */
hdrp_brdf_data rd_engine_data(const rd_surface* s, uint32_t features);

/* What a surface emits. Unlit colours are meant for the screen: this is what exposure shows so. */
hdrp_v3 rd_emission_nits(const rd_surface* s, float exposure);

/* What is left of white light behind the volume of a surface, straight across it. */
hdrp_v3 rd_volume_transmittance(const rd_material* m, float distance_m);

/* The first part of a preintegrated environment, for a view. */
hdrp_brdf_fgd rd_lighting_fgd(const rd_lighting* l, const hdrp_brdf_data* data, hdrp_v3 view);

/* >>the light loop */

typedef struct rd_shade_point {
    hdrp_brdf_data data;
    hdrp_v3 position, geometric_normal;
    hdrp_v3 view;                     /* unit, towards the viewer */
    float visibility;                 /* [0,1] of the surroundings, beside data.ambient_occlusion */
    uint32_t hash;                    /* of the pixel */
    hdrp_u32 layers;                  /* light layers */
    uint32_t x, y;                    /* pixel */
    uint32_t first_entry, last_entry; /* of lists: the lights that may reach it */
} rd_shade_point;

typedef struct rd_shaded {
    hdrp_v3 diffuse, specular; /* nits */
    /* Light from behind, for refractive materials: the caller knows what is there. */
    hdrp_v3 transmitted_weight, transmitted_direction;
    float transmitted_perceptual_roughness;
} rd_shaded;

/* The light loop compiled for sets of material features, see shade.c. */
#define RD_SHADE_VARIANTS 7

typedef struct rd_shade_counts {
    uint64_t shadow_rays;
    /* Pairs of a point and a light: visited, and in the range of the light; by tiles or without
     * lists, and by clusters. */
    uint64_t visited[2], in_range[2];
    uint64_t samples[RD_SHADE_VARIANTS];
    /* Of calls whose points all took the same variant. */
    uint64_t timed_samples[RD_SHADE_VARIANTS];
    double timed_ms[RD_SHADE_VARIANTS];
} rd_shade_counts;

const char* rd_shade_variant_name(int variant);

/* At most RD_SHADE_MAX points. `grid`, of lists.h, has the entries of the points; NULL: they visit
 * all lights. `index` counts the samples of a pixel. */
struct rd_grid;
void rd_shade(const rd_lighting* l, const struct rd_grid* grid, const rd_shade_point* points,
              uint32_t count, uint32_t index, rd_shaded* out, rd_shade_counts* counts);

#endif
