// What all shaders read: the frame, meshes, materials. Buffers hold vectors of four, so that both
// sides agree on the layout; see vk_scene.h for the same in C.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "hdrp_brdf.h"
#include "vk_shared.h"

layout(set = 0, binding = 0) uniform Frame {
    vec4 eye_step;             // w: size of the part of a pixel that a sample stands for
    vec4 right_half_width;     // of the picture at distance 1; orthographic: in metres
    vec4 up_half_height;
    vec4 forward_orthographic;
    vec4 jitter_size;          // of the sample in its pixel, size of the picture in pixels
    vec4 depths_exposure;      // nearest, farthest, exposure
    uvec4 bits;                // features, features of materials, view, 1: forward path
    uvec4 sample_of;           // index, seed, 1: table of FGD, 1: lists of lights
    vec4 sky;                  // 1: lat-long, 2: cube; squared sine of the radius of the sun
    vec4 to_sun;
    vec4 sun_nits;             // of its disc
} frame;

struct Mesh {
    uvec4 data;  // first index; first float of positions, normals, tangents
    uvec4 uv;    // first float of each set
    uvec4 more;  // first float of colours, light layers, material, scale
};

struct Slot {
    vec4 u_row; // w: uv set
    vec4 v_row; // w: 1 where there is a texture
    vec4 size;  // in texels, levels, how it is sampled
};

struct Material {
    vec4 base_alpha;
    vec4 emission_cutoff;
    vec4 surface;  // metallic, perceptual roughness, normal scale, strength of occlusion
    vec4 coat;     // mask, perceptual roughness, normal scale; anisotropy
    vec4 film;     // mask, ior, thickness from, to
    vec4 specular; // colour, weight
    vec4 optics;   // ior, transmission, thickness, attenuation distance
    vec4 volume;   // attenuation colour, thickness of a slab
    vec4 turn;     // cosine and sine of the rotation of anisotropy
    vec4 slab;     // light behind the slab
    uvec4 bits;    // alpha mode, RD_GPU_..., features, diffusion profile
    vec4 detail;   // scales, strengths
    uvec4 details; // count of layers; hash of the name
    Slot slots[RD_GPU_SLOT_COUNT];
    vec4 detail_size[RD_GPU_DETAILS];
};

layout(std430, set = 0, binding = 1) readonly buffer Meshes { Mesh meshes[]; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { Material materials[]; };
layout(std430, set = 0, binding = 3) readonly buffer Vertices { float vertices[]; };
layout(std430, set = 0, binding = 4) readonly buffer Indices { uint indices[]; };
layout(std430, set = 0, binding = 5) readonly buffer Order { uint order[]; }; // of transparent ones

layout(push_constant) uniform Draw {
    uint mesh;
    uint ordered; // 1: triangles are those of the order
    uint view;    // of a shadow map
    uint low;     // 1: into targets of half the resolution
} draw;

vec2 fetch2(uint first, uint i)
{
    return vec2(vertices[first + 2u * i], vertices[first + 2u * i + 1u]);
}

vec3 fetch3(uint first, uint i)
{
    uint k = first + 3u * i;
    return vec3(vertices[k], vertices[k + 1u], vertices[k + 2u]);
}

vec4 fetch4(uint first, uint i)
{
    uint k = first + 4u * i;
    return vec4(vertices[k], vertices[k + 1u], vertices[k + 2u], vertices[k + 3u]);
}

bool is_orthographic()
{
    return frame.forward_orthographic.w != 0.0;
}
