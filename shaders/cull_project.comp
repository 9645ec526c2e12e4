#version 450
// Shapes in view space, their planes and their bounds on the screen: hdrp_cull_set_project. And
// tiles as hdrp_cull_begin leaves them.
// header: hdrp_gpu_vk_cull.h
// contraction: none
#extension GL_GOOGLE_include_directive : require
#define PROJECTS
#define FRAME_ACCESS readonly
#define SHAPE_ACCESS
#include "cull_lists.glsl"

layout(std430, binding = 4) readonly buffer World { hdrp_cull_shape world[]; };
layout(std430, binding = 5) writeonly buffer Tiles { vec4 tiles[]; };
// The same as FrameData, of which devices read more cheaply what a shader does not write to.
layout(std430, binding = 6) buffer FoundData { Frame frame_found; };

// What a thread wrote before it reads again, here and below, instead of keeping it in registers:
// that is what the barriers are for.
void write_bounds(uint i)
{
    hdrp_cull_shape s = shapes[i];
    hdrp_cull_bounds b = hdrp_cull_shape_bounds(s, frame.camera, float(frame.picture.x),
                                                float(frame.picture.y));
    // The bits of floats that are not negative are ordered as the floats are.
    seen_shapes[i] = Seen(b.rect_px, hdrp_cull_shape_ball(s), b.nearest, b.farthest,
                          hdrp_cull_shape_kind(s) | hdrp_cull_shape_category(s) << 8 |
                              hdrp_cull_shape_plane_count(s) << 16,
                          ~s.bits.w & 0x7fffffffu);
}

void main()
{
    frame = frame_in_memory;
    uint i = thread_index();
    if (i < frame.grid.tiles.z * frame.grid.tiles.w) { // as long as no depth is known
        tiles[i] = vec4(frame.pixel.z, frame.pixel.w, frame.grid.series.w, 0.0);
    }
    if (i >= frame.numbers.x) {
        return;
    }
    shapes[i] = hdrp_cull_shape_in_view(world[i], frame.camera);
    memoryBarrierBuffer();
    write_bounds(i);
    memoryBarrierBuffer();
    if (seen_shapes[i].rect_px.x > seen_shapes[i].rect_px.z) {
        return; // not seen: nobody asks for its planes
    }
    atomicOr(frame_found.found.x, 1u << category_of(seen_shapes[i]));
    uint count = seen_shapes[i].kind >> 16;
    for (uint k = 0u; k < count; ++k) {
        planes[i * PLANES_STRIDE + k] =
            hdrp_cull_shape_plane(shapes[i], k, frame.camera.forward_orthographic.w);
    }
}
