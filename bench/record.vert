#version 450
// A box, drawn without buffers: for bench_record.c. The push constants are the rows of the
// projection of the unit box of an object.
layout(push_constant) uniform Push { vec4 rows[4]; };

const int corners[36] = int[36](0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, //
                                2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5);

void main()
{
    int i = corners[gl_VertexIndex];
    vec4 p = vec4(float(i & 1), float(i >> 1 & 1), float(i >> 2), 1.0);
    gl_Position = vec4(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p), dot(rows[3], p));
}
