/* The scene as the renderer sees it: triangles in world space, materials, lights, cameras. */
#ifndef RD_SCENE_H
#define RD_SCENE_H

#include "hdrp_brdf.h"
#include "hdrp_cull_blocker.h"
#include "texture.h"
#include "transform.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RD_MAX_UV_SETS 4
#define RD_NAME_MAX    64
/* What one scene may hold; beyond it loading fails with a message. */
#define RD_MAX_TRIANGLES (1u << 25)
#define RD_MAX_VERTICES  (1u << 26)

/* What a texture of a material drives. */
typedef enum rd_slot {
    RD_SLOT_BASE_COLOR,
    RD_SLOT_METALLIC_ROUGHNESS,
    RD_SLOT_NORMAL,
    RD_SLOT_OCCLUSION,
    RD_SLOT_EMISSIVE,
    RD_SLOT_COAT,
    RD_SLOT_COAT_ROUGHNESS,
    RD_SLOT_COAT_NORMAL,
    RD_SLOT_ANISOTROPY,
    RD_SLOT_FILM,
    RD_SLOT_FILM_THICKNESS,
    RD_SLOT_SPECULAR,
    RD_SLOT_SPECULAR_COLOR,
    RD_SLOT_TRANSMISSION,
    RD_SLOT_THICKNESS,
    RD_SLOT_COUNT
} rd_slot;

/* A texture seen through an affine map of one uv set: uv' = (u_row . (u, v, 1), v_row . ...). */
typedef struct rd_texture_slot {
    int texture; /* -1: none */
    int uv_set;
    hdrp_v3 u_row, v_row;
} rd_texture_slot;

typedef enum rd_alpha_mode { RD_ALPHA_OPAQUE, RD_ALPHA_MASK, RD_ALPHA_BLEND } rd_alpha_mode;

#define RD_MAX_DETAIL_LAYERS 2

/* Surface detail by world position, without uv: triplanar height layers blended by a mask of
 * noise. The built-in scene uses it; glTF has no such thing. */
typedef struct rd_detail {
    int layer_count;
    int texture[RD_MAX_DETAIL_LAYERS]; /* normal maps */
    float scale[RD_MAX_DETAIL_LAYERS]; /* repetitions per metre */
    float strength[RD_MAX_DETAIL_LAYERS];
} rd_detail;

typedef struct rd_material {
    char name[RD_NAME_MAX];
    rd_alpha_mode alpha_mode;
    float alpha, alpha_cutoff;
    bool double_sided, unlit;
    bool additive;        /* adds what it emits, alpha of it, and hides nothing */
    bool half_resolution; /* with --oit: soft enough to be lit at half of the resolution */
    bool is_lamp; /* what it emits is also a light of the scene: reflections show that instead */
    hdrp_v3 base_color;
    float metallic, perceptual_roughness;
    float normal_scale, occlusion_strength;
    hdrp_v3 emission_nits;
    float coat, coat_perceptual_roughness, coat_normal_scale;
    float anisotropy, anisotropy_rotation_rad;
    float film, film_ior, film_thickness_min_nm, film_thickness_max_nm;
    float specular;
    hdrp_v3 specular_color;
    float ior;
    float transmission;
    float thickness; /* of what is below the surface, in units of the file; 0: a thin wall */
    float attenuation_distance_m; /* may be infinite */
    hdrp_v3 attenuation_color;
    float
        slab_thickness; /* of a leaf or cloth that light crosses, of its profile's; 0: none does */
    hdrp_u32 diffusion_profile; /* below RD_MAX_PROFILES */
    hdrp_u32 features;          /* HDRP_BRDF_FEATURE_... */
    rd_texture_slot slot[RD_SLOT_COUNT];
    rd_detail detail;
} rd_material;

/* Triangles of one material. Arrays of absent attributes are NULL. */
typedef struct rd_mesh {
    char name[RD_NAME_MAX];
    int material;
    uint32_t vertex_count, triangle_count;
    float scale; /* metres for one unit of the file: the thickness of volumes grows with it */
    uint32_t light_layers; /* of its surfaces, 8 bits; 0: all */
    hdrp_v3* positions;    /* one element of padding follows: Embree reads 16 bytes at a time */
    hdrp_v3* normals;      /* unit; NULL: flat */
    hdrp_v4* tangents;     /* unit, w is the sign of the bitangent */
    hdrp_v4* colors;       /* linear */
    hdrp_v2* uv[RD_MAX_UV_SETS];
    uint32_t* indices;
} rd_mesh;

typedef enum rd_light_type {
    RD_LIGHT_DIRECTIONAL,
    RD_LIGHT_POINT,
    RD_LIGHT_SPOT,
    RD_LIGHT_PYRAMID,
    RD_LIGHT_BOX
} rd_light_type;

typedef struct rd_light {
    rd_light_type type;
    hdrp_v3 position;
    hdrp_v3 forward, right, up;             /* unit; light travels along forward */
    hdrp_v3 color;                          /* linear */
    float intensity;                        /* lux for directional and box, else candela */
    float range_m;                          /* 0: unlimited */
    float inner_angle_rad, outer_angle_rad; /* spot: half angles of the cone */
    float half_width, half_height;          /* pyramid: at distance 1; box: in metres */
    float radius_m;                         /* size of the source for soft shadows; 0: a point */
    float angular_radius_rad;               /* the same of a directional light */
    uint32_t light_layers;                  /* that it lights; 0: all */
    bool shadowless;                        /* only blockers keep it away */
    uint32_t first_blocker, blocker_count;  /* of the links of the scene */
} rd_light;

typedef struct rd_scene_camera {
    char name[RD_NAME_MAX];
    rd_affine world_from_view; /* looks along -z, rigid */
    bool orthographic;
    float fov_y_rad;               /* perspective */
    float half_width, half_height; /* orthographic */
} rd_scene_camera;

typedef struct rd_bounds {
    hdrp_v3 low, high;
} rd_bounds;

/* As many as a GBuffer can name. */
#define RD_MAX_PROFILES 16

typedef struct rd_scene {
    rd_material* materials;
    rd_mesh* meshes;
    rd_light* lights;
    rd_scene_camera* cameras;
    hdrp_cull_blocker* blockers; /* and their portals */
    uint32_t* blocker_links;     /* indices of blockers, those of a light in one piece */
    int material_count, mesh_count, light_count, camera_count, blocker_count, blocker_link_count;
    rd_texture_set textures;
    uint64_t triangle_count, vertex_count;
    hdrp_v3 slab_color[RD_MAX_PROFILES]; /* of white light behind a slab of thickness 1 */
    rd_bounds bounds;                    /* low > high where there is no geometry */
    bool has_sky; /* wants the procedural sky, although it has lights of its own */
    float sun_elevation_rad, sun_azimuth_rad;
    hdrp_v3 ground_albedo; /* below the horizon of that sky */
} rd_scene;

/* Loads a glTF file: container, validation, materials, geometry. The textures are left encoded,
 * for rd_textures_prepare. *scene is to be freed in any case. */
bool rd_scene_load_gltf(rd_scene* scene, const char* path, rd_report* report);

/* The scene that is shown when no file is given, a street of many lights, and transparent things
 * before the former. */
typedef enum rd_builtin {
    RD_BUILTIN_DISPLAY,
    RD_BUILTIN_LIGHTS,
    RD_BUILTIN_TRANSPARENCY
} rd_builtin;

bool rd_scene_build(rd_scene* scene, rd_builtin which, rd_report* report);

void rd_scene_free(rd_scene* scene);

/* The default glTF material: white, metallic, rough. */
rd_material rd_material_default(void);
/* Sets material->features from its factors. */
void rd_material_update_features(rd_material* m);
rd_texture_slot rd_texture_slot_make(int texture);

/* Is seen through: cannot enter a GBuffer, is composited in order of depth. */
bool rd_material_is_layer(const rd_material* m);

/* Transmits light through a sheet that is so rough that it scatters. */
bool rd_material_scatters(const rd_material* m);

/* Share of light that crosses a slab of a diffusion profile. */
hdrp_v3 rd_slab_transmittance(const rd_scene* scene, hdrp_u32 profile, float thickness);

/* Room for the arrays of a mesh; `uv_sets` is a mask. Tangents need normals. */
bool rd_mesh_allocate(rd_mesh* mesh, uint32_t vertices, uint32_t triangles, bool normals,
                      bool tangents, bool colors, uint32_t uv_sets);
/* Moves a mesh to world space; a mirroring transform turns the triangles around. */
void rd_mesh_transform(rd_mesh* mesh, rd_affine world_from_object);
void rd_mesh_free(rd_mesh* mesh);
/* As a GBuffer holds them. */
uint32_t rd_mesh_light_layers(const rd_mesh* mesh);

/* From then on tangents come from the uv. */
void rd_scene_drop_tangents(rd_scene* scene);

/* Appends and counts; takes over the arrays of *mesh, which is freed on failure. */
bool rd_scene_add_mesh(rd_scene* scene, rd_mesh* mesh);
int rd_scene_add_material(rd_scene* scene, const rd_material* m); /* -1: out of memory */
bool rd_scene_add_light(rd_scene* scene, const rd_light* l);
bool rd_scene_add_camera(rd_scene* scene, const rd_scene_camera* c);
int rd_scene_add_blocker(rd_scene* scene, const hdrp_cull_blocker* b); /* -1: out of memory */
bool rd_scene_link_blocker(rd_scene* scene, uint32_t blocker);
void rd_scene_update_bounds(rd_scene* scene);

#ifdef __cplusplus
}
#endif
#endif
