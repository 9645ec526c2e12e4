/* Numbers that C and the shaders agree on: macros alone. */
#ifndef RD_VK_SHARED_H
#define RD_VK_SHARED_H

#define RD_GPU_NONE 0xffffffffu

/* As RD_SLOT_...; behind them the layers of detail. */
#define RD_GPU_SLOT_BASE_COLOR         0
#define RD_GPU_SLOT_METALLIC_ROUGHNESS 1
#define RD_GPU_SLOT_NORMAL             2
#define RD_GPU_SLOT_OCCLUSION          3
#define RD_GPU_SLOT_EMISSIVE           4
#define RD_GPU_SLOT_COAT               5
#define RD_GPU_SLOT_COAT_ROUGHNESS     6
#define RD_GPU_SLOT_COAT_NORMAL        7
#define RD_GPU_SLOT_ANISOTROPY         8
#define RD_GPU_SLOT_FILM               9
#define RD_GPU_SLOT_FILM_THICKNESS     10
#define RD_GPU_SLOT_SPECULAR           11
#define RD_GPU_SLOT_SPECULAR_COLOR     12
#define RD_GPU_SLOT_TRANSMISSION       13
#define RD_GPU_SLOT_THICKNESS          14
#define RD_GPU_SLOT_COUNT              15
#define RD_GPU_DETAILS                 2
#define RD_GPU_TEXTURES                17

#define RD_GPU_ALPHA_OPAQUE            0u
#define RD_GPU_ALPHA_MASK              1u
#define RD_GPU_ALPHA_BLEND             2u

#define RD_GPU_DOUBLE_SIDED            1u
#define RD_GPU_UNLIT                   2u
#define RD_GPU_ADDITIVE                4u

/* As RD_FEATURE_... */
#define RD_GPU_FEATURE_NORMAL_MAPS (1u << 4)
#define RD_GPU_FEATURE_OCCLUSION   (1u << 5)
#define RD_GPU_FEATURE_LIGHTS      (1u << 8)
#define RD_GPU_FEATURE_SHADOWS     (1u << 10)
#define RD_GPU_FEATURE_ENVIRONMENT (1u << 11)
#define RD_GPU_FEATURE_SPECULAR_AA (1u << 13)
#define RD_GPU_FEATURE_BLOCKERS    (1u << 17)

/* As RD_VARIANCE_... */
#define RD_GPU_VARIANCE_STRENGTH 0.16f
#define RD_GPU_VARIANCE_LIMIT    0.1f

/* As RD_VIEW_... */
#define RD_GPU_VIEW_LIT              0u
#define RD_GPU_VIEW_BASE_COLOR       1u
#define RD_GPU_VIEW_NORMAL           2u
#define RD_GPU_VIEW_GEOMETRIC_NORMAL 3u
#define RD_GPU_VIEW_VERTEX_NORMAL    4u
#define RD_GPU_VIEW_TANGENT          5u
#define RD_GPU_VIEW_UV               6u
#define RD_GPU_VIEW_ROUGHNESS        7u
#define RD_GPU_VIEW_METALLIC         8u
#define RD_GPU_VIEW_F0               9u
#define RD_GPU_VIEW_DEPTH            10u
#define RD_GPU_VIEW_FEATURES         11u
#define RD_GPU_VIEW_MATERIAL         12u
#define RD_GPU_VIEW_ALPHA            13u
#define RD_GPU_VIEW_EMISSION         14u
#define RD_GPU_VIEW_OCCLUSION        15u
#define RD_GPU_VIEW_COAT             16u
#define RD_GPU_VIEW_ANISOTROPY       17u
#define RD_GPU_VIEW_FILM             18u
#define RD_GPU_VIEW_TRANSMISSION     19u
#define RD_GPU_VIEW_LAYERS           20u
#define RD_GPU_VIEW_DIFFUSE          21u
#define RD_GPU_VIEW_SPECULAR         22u
#define RD_GPU_VIEW_AO               23u
#define RD_GPU_VIEW_PATH             24u
#define RD_GPU_VIEW_RT0              25u
#define RD_GPU_VIEW_RT1              26u
#define RD_GPU_VIEW_RT2              27u
#define RD_GPU_VIEW_RT3              28u
#define RD_GPU_VIEW_RT4              29u

#endif
