#version 450
// The depth prepass of materials with holes.
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#include "surface.glsl"

layout(location = 0) flat in uint triangle;

void main()
{
    float alpha;
    set_patch(draw.mesh, triangle, pixel_ray(gl_FragCoord.xy));
    alpha = MATERIAL.base_alpha.w;
    if (has_texture(RD_GPU_SLOT_BASE_COLOR)) {
        vec2 uv = map_uv(RD_GPU_SLOT_BASE_COLOR, uv_of_set(set_of(RD_GPU_SLOT_BASE_COLOR)).uv, 1.0);
        alpha *= textureLod(textures[RD_GPU_SLOT_BASE_COLOR], uv, 0.0).w;
    }
    if (mesh.more.x != RD_GPU_NONE) {
        alpha *= combine4(mesh.more.x).w;
    }
    if (alpha < MATERIAL.emission_cutoff.w) {
        discard;
    }
}
