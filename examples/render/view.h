/* What the picture shows: the lit scene or one quantity of its surfaces. */
#ifndef RD_VIEW_H
#define RD_VIEW_H

#include "surface.h"

typedef enum rd_view {
    RD_VIEW_LIT,
    RD_VIEW_BASE_COLOR,
    RD_VIEW_NORMAL,
    RD_VIEW_GEOMETRIC_NORMAL,
    RD_VIEW_VERTEX_NORMAL,
    RD_VIEW_TANGENT,
    RD_VIEW_UV,
    RD_VIEW_ROUGHNESS,
    RD_VIEW_METALLIC,
    RD_VIEW_F0,
    RD_VIEW_DEPTH,
    RD_VIEW_FEATURES,
    RD_VIEW_MATERIAL,
    RD_VIEW_ALPHA,
    RD_VIEW_EMISSION,
    RD_VIEW_OCCLUSION,
    RD_VIEW_COAT,
    RD_VIEW_ANISOTROPY,
    RD_VIEW_FILM,
    RD_VIEW_TRANSMISSION,
    RD_VIEW_LAYERS,
    RD_VIEW_DIFFUSE,
    RD_VIEW_SPECULAR,
    RD_VIEW_AO,
    RD_VIEW_PATH,
    RD_VIEW_RT0,
    RD_VIEW_RT1,
    RD_VIEW_RT2,
    RD_VIEW_RT3,
    RD_VIEW_RT4,
    RD_VIEW_TILES,
    RD_VIEW_CLUSTERS,
    RD_VIEW_LIGHT_WASTE,
    RD_VIEW_VARIANTS,
    RD_VIEW_BLOCKERS,
    RD_VIEW_COUNT
} rd_view;

/* How the values of a view become a picture with 8 bits a channel. */
typedef enum rd_encoding {
    RD_ENCODE_LIT,     /* exposed, tone-mapped, sRGB */
    RD_ENCODE_COLOR,   /* sRGB of [0,1] */
    RD_ENCODE_DATA,    /* [0,1] as it is */
    RD_ENCODE_SIGNED,  /* [-1,1] to [0,1] */
    RD_ENCODE_DISTANCE /* metres, the nearest white and the farthest dark */
} rd_encoding;

/* Where in the pipeline a view is taken. */
typedef enum rd_view_stage {
    RD_STAGE_MATERIAL, /* from the surfaces, transparent ones included */
    RD_STAGE_GBUFFER,  /* before lighting */
    RD_STAGE_LISTS,    /* the same, of lists of lights */
    RD_STAGE_LIGHTING  /* all passes run */
} rd_view_stage;

const char* rd_view_name(rd_view view);
rd_view_stage rd_view_stage_of(rd_view view);
rd_encoding rd_view_encoding(rd_view view);
/* RD_VIEW_COUNT where there is no such view. */
rd_view rd_view_from_name(const char* name);

/* The quantity at a surface, for the views of RD_STAGE_MATERIAL but RD_VIEW_LAYERS. */
hdrp_v3 rd_view_value(rd_view view, const rd_camera* camera, const rd_surface* s);

#endif
