#version 450
// A stream of fragments, drawn as a point each, for test_gpu_oit.c.
struct Point {
    vec4 color;    // xyz premultiplied, w alpha
    vec4 emission; // w depth [m]
    uvec4 place;   // x column, y row, z bits of the device's depth
};
layout(std430, binding = 6) readonly buffer Stream { Point points[]; };
layout(push_constant) uniform Push
{
    vec4 picture; // xy size [px], z scale
    vec4 talk;    // x feather, y exposure
};
layout(location = 0) flat out vec4 color;
layout(location = 1) flat out vec4 emission;
layout(location = 2) flat out float device_depth;

void main()
{
    Point p = points[gl_VertexIndex];
    vec2 at = (vec2(p.place.xy) + 0.5) / picture.xy;
    color = p.color;
    emission = p.emission;
    device_depth = uintBitsToFloat(p.place.z);
    gl_PointSize = 1.0;
    gl_Position = vec4(2.0 * at - 1.0, 0.0, 1.0);
}
