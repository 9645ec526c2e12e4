#version 450
// Lists of tiles without slices, by depth alone.
// header: hdrp_gpu_vk_cull.h
// contraction: none
#extension GL_GOOGLE_include_directive : require
#include "cull_tiles.glsl"
