#version 450
// Lists of tiles without slices: fine-pruned, by what their pixels show.
// header: hdrp_gpu_vk_cull.h
// contraction: none
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#define ASKS_PIXELS
#include "cull_tiles.glsl"
