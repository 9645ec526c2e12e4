// Passes before that of colour: where surfaces are, and what they hide.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scene.glsl"
#include "surface.glsl"
#include "oit.glsl"

layout(location = 0) flat in uint triangle;

// The coverage of surface_at, to the bit, without the textures that it has nothing to do with.
float coverage_at(Ray ray)
{
    float t = set_patch(draw.mesh, triangle, ray);
    Surface s;
    Request base;
    if (MATERIAL.details.x > 0u) {
        return surface_at(draw.mesh, triangle, ray).coverage;
    }
    s.brdf = hdrp_brdf_surface_default();
    s = set_geometry(s, ray, t);
    s.uv = uv_of_set(0u).uv;
    base = request_of(RD_GPU_SLOT_BASE_COLOR, s);
    if (base.texture != RD_GPU_NONE) {
        texels[RD_GPU_SLOT_BASE_COLOR] =
            filtered(base.texture, base.size, base.at.uv, base.at.dx, base.at.dy);
    }
    return set_base(s).coverage;
}

void main()
{
    hdrp_oit_write(hdrp_oit_fragment_make(vec3(0.0), vec3(0.0), coverage_at(oit_ray()),
                                          oit_z_view()));
}
