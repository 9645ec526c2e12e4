// Whether a point of a material with holes is one: without filtering, as for rays.
bool is_hole()
{
    float alpha = MATERIAL.base_alpha.w;
    if (has_texture(RD_GPU_SLOT_BASE_COLOR)) {
        vec2 uv = map_uv(RD_GPU_SLOT_BASE_COLOR, uv_of_set(set_of(RD_GPU_SLOT_BASE_COLOR)).uv, 1.0);
        vec4 size = MATERIAL.slots[RD_GPU_SLOT_BASE_COLOR].size;
        alpha *= IS_COARSE ? filtered_exactly(RD_GPU_SLOT_BASE_COLOR, size, uv, 0.0).w
                              : textureLod(textures[RD_GPU_SLOT_BASE_COLOR], uv, 0.0).w;
    }
    if (mesh.more.x != RD_GPU_NONE) {
        alpha *= combine4(mesh.more.x).w;
    }
    return alpha < MATERIAL.emission_cutoff.w;
}
