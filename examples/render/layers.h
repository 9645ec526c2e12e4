/* Transparent surfaces along the rays of a row, lit: what passes put together. */
#ifndef RD_LAYERS_H
#define RD_LAYERS_H

#include "frame.h"

typedef struct rd_layer {
    int x; /* in its row */
    const rd_material* material;
    hdrp_v3 light;   /* what it sends towards the viewer [nits]; 0 where it was not lit */
    hdrp_v3 through; /* share of the light behind that it lets through */
    float coverage;  /* 0: only adds light */
    float distance_m, z_view;
    float transmitted_perceptual_roughness;
    bool is_lit;
    bool bends; /* a volume: light comes from the place or from the sky in the direction below */
    bool sees_sky;
    hdrp_v3 source_direction, source;
} rd_layer;

struct rd_layer_list {
    rd_layer* items;
    uint32_t count, capacity;
    uint64_t dropped;
};

/* What a pass does with the surfaces of a material. */
typedef enum rd_layer_use {
    RD_LAYER_IGNORED,
    RD_LAYER_UNLIT, /* it has to know where they are and what they hide */
    RD_LAYER_LIT
} rd_layer_use;

typedef rd_layer_use (*rd_layer_chooser)(const rd_sub_frame* s, const rd_material* m);

/* Samples of a picture, or of one with fewer pixels. */
typedef struct rd_layer_grid {
    int width;
    float step_x, step_y; /* pixels of the picture from one sample to the next */
    rd_layer_chooser use;
} rd_layer_grid;

/* Replaces w->list by the layers of a row, from left to right, nearest first. False: no memory. */
bool rd_layers_gather(const rd_sub_frame* s, rd_worker* w, const rd_layer_grid* grid, int y);

/* The layers of a pixel over each other and over what is opaque: they are looked at in their order,
 * those of other materials than `blended` says are left out. */
typedef struct rd_layers_seen {
    hdrp_v3 color;   /* [nits] */
    float uncovered; /* share of what is behind that is seen */
} rd_layers_seen;

typedef enum rd_layer_choice { RD_LAYERS_ALL, RD_LAYERS_WITHOUT_BLENDED } rd_layer_choice;

rd_layers_seen rd_layers_over(const rd_sub_frame* s, const rd_layer* layers, uint32_t count,
                              rd_layer_choice choice, int x, int y);
/* Adds the colour of a pixel to the film. */
void rd_layers_resolve(const rd_sub_frame* s, rd_layers_seen seen, int x, int y);

#endif
