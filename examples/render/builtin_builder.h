/* What built-in scenes are put together with. */
#ifndef RD_BUILTIN_BUILDER_H
#define RD_BUILTIN_BUILDER_H

#include "builtin_shape.h"

typedef struct rd_builder {
    rd_scene* scene;
    bool ok; /* false: out of memory; what follows does nothing */
} rd_builder;

/* The built-in scenes, into an empty one. */
void rd_build_display(rd_builder* b);
void rd_build_street(rd_builder* b);
void rd_build_transparency(rd_builder* b);

rd_affine rd_translation(float x, float y, float z);
rd_affine rd_rotation_x(float angle);
rd_affine rd_rotation_y(float angle);
rd_affine rd_rotation_z(float angle);
hdrp_v2 rd_uv_scale(float u, float v);

rd_material rd_metal(hdrp_v3 f0, float perceptual_roughness);
rd_material rd_dielectric(hdrp_v3 color, float perceptual_roughness);
rd_material rd_glass(float ior, float thickness_m);
/* A light without intensity that looks at a target. */
rd_light rd_light_at(rd_light_type type, hdrp_v3 position, hdrp_v3 target, hdrp_v3 color);

int rd_build_material(rd_builder* b, rd_material* m, const char* name);
void rd_build_mesh(rd_builder* b, rd_shape shape, int material, rd_affine where, const char* name);
void rd_build_light(rd_builder* b, const rd_light* l);
int rd_build_blocker(rd_builder* b, hdrp_cull_blocker blocker);
/* A light that some blockers keep away, and nothing else. */
void rd_build_blocked_light(rd_builder* b, rd_light l, const int* blockers, uint32_t count);
void rd_build_camera(rd_builder* b, hdrp_v3 eye, hdrp_v3 target, float fov_y_rad, const char* name);

#endif
