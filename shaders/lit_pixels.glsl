// Which pixels are lit from the GBuffer: for classification and deferred lighting.
// Needs light_loop.glsl, or what it declares of bindings 0 to 5; depths and kinds come with it.

// Depth of a pixel [m].
float view_depth(ivec2 pixel)
{
    float texel = texelFetch(depths, pixel, 0).x;
    bool is_device = (lighting.picture.z & HDRP_GPU_VK_LIGHTING_DEVICE_DEPTH) != 0u;
    return is_device ? hdrp_view_depth(lighting.depth, texel) : texel;
}

// The same; negative where there is nothing to light.
float lit_depth(uvec2 pixel)
{
    float z = view_depth(ivec2(pixel));
    float seen = hdrp_cull_opaque_depth(z, lighting.camera.eye_near.w, lighting.camera.right_far.w);
    if ((lighting.picture.z & HDRP_GPU_VK_LIGHTING_KINDS) != 0u) {
        uint kind = texelFetch(kinds, ivec2(pixel), 0).x;
        seen = (kind & lighting.kinds.x) == lighting.kinds.y ? seen : -1.0;
    }
    return seen >= 0.0 ? z : -1.0;
}
