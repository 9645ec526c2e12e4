// Level 0 of the radiance cube from an image, by the areas that texels of both share: what
// hdrp_env_resample does, texel of the cube by texel instead of texel of the image by texel.
#define SIDE 8

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(std430, binding = 1) writeonly buffer Radiance { vec4 radiance[]; };
layout(push_constant) uniform Push
{
    uvec4 cube;    // x size, y first row, z end of the rows, over all faces
    uvec4 picture; // x width, y height, z and w in how many parts its texels are split
    vec4 scale;    // x nits per unit
};

// The mean of the texel that is made, so far, and the solid angle that it is of.
vec4 mean = vec4(0.0);

// Nits of what was read, as hdrp_env_image_texel.
vec3 nits_of(vec3 v)
{
    return vec3(hdrp_clamp(v.x * scale.x, 0.0, 1e20), hdrp_clamp(v.y * scale.x, 0.0, 1e20),
                hdrp_clamp(v.z * scale.x, 0.0, 1e20));
}

// Adds a piece: its area in texels of the cube, and its middle in [-1,1] on the face. A running
// mean: thousands of equal values leave it as it is, to the bit.
void add_piece(float area, vec2 middle, vec3 nits)
{
    float r = 1.0 + hdrp_v2_dot(middle, middle);
    float weight = area / (r * hdrp_sqrt(r));
    mean.w += weight;
    mean.xyz += (weight / hdrp_max(mean.w, HDRP_FLT_MIN)) * (nits - mean.xyz);
}

// False for a thread beyond the rows.
bool env_place_of_thread(out uint face, out uvec2 texel)
{
    uint row = cube.y + gl_GlobalInvocationID.y;
    face = row / cube.x;
    texel = uvec2(gl_GlobalInvocationID.x, row % cube.x);
    return texel.x < cube.x && row < cube.z;
}

void env_store(uint face, uvec2 texel)
{
    radiance[(face * cube.x + texel.y) * cube.x + texel.x] =
        vec4(mean.xyz, hdrp_env_cube_solid_angle(texel.x, texel.y, cube.x));
}
