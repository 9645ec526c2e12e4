/* What tests of pictures share: a scene, what lights it, and how it is seen. */
#ifndef STUDIO_H
#define STUDIO_H

#include "builtin_shape.h"
#include "compare.h"
#include "render.h"

#define WIDTH  240
#define HEIGHT 160
#define PIXELS (WIDTH * HEIGHT)

typedef struct studio {
    rd_options options;
    rd_scene scene;
    rd_trace* trace;
    rd_environment environment;
    rd_lighting lighting;
    rd_camera camera;
    rd_stats stats;
    rd_report report;
    rd_render_counts counts; /* of the last picture */
} studio;

/* One sample a pixel, balanced, with all features. */
studio* open_studio(void);
void close_studio(studio* s);

rd_material plain(float r, float g, float b, float metallic);
void add(studio* s, rd_shape shape, rd_material m, hdrp_v3 where);
/* Shines at the origin. */
void add_light(studio* s, rd_light_type type, hdrp_v3 position, float intensity);
/* `sky` is taken over; NULL: the procedural one. */
void set_sky(studio* s, rd_image_f32* sky, float lux);
rd_image_f32 uniform_sky(float nits);
/* After the scene is complete. Looks at the origin along -Z. */
void set_up(studio* s);

/* The film, to be freed. */
float* shoot(studio* s, float exposure);
hdrp_v3 pixel(const float* film, int x, int y);

#endif
