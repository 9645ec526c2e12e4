// Textures of a material, filtered as texture.c does it.
layout(set = 1, binding = 0) uniform sampler2D textures[RD_GPU_TEXTURES];

#define MAX_PROBES 4.0

float texels_along(vec4 size, vec2 d)
{
    vec2 t = d * size.xy;
    return sqrt(t.x * t.x + t.y * t.y);
}

float footprint(vec4 size, vec2 dx, vec2 dy)
{
    return max(texels_along(size, dx), texels_along(size, dy));
}

// Constant indices need no feature of the device.
vec4 texel_at(uint which, vec2 uv, float lod)
{
    switch (which) {
    case 0u: return textureLod(textures[0], uv, lod);
    case 1u: return textureLod(textures[1], uv, lod);
    case 2u: return textureLod(textures[2], uv, lod);
    case 3u: return textureLod(textures[3], uv, lod);
    case 4u: return textureLod(textures[4], uv, lod);
    case 5u: return textureLod(textures[5], uv, lod);
    case 6u: return textureLod(textures[6], uv, lod);
    case 7u: return textureLod(textures[7], uv, lod);
    case 8u: return textureLod(textures[8], uv, lod);
    case 9u: return textureLod(textures[9], uv, lod);
    case 10u: return textureLod(textures[10], uv, lod);
    case 11u: return textureLod(textures[11], uv, lod);
    case 12u: return textureLod(textures[12], uv, lod);
    case 13u: return textureLod(textures[13], uv, lod);
    case 14u: return textureLod(textures[14], uv, lod);
    case 15u: return textureLod(textures[15], uv, lod);
    default: return textureLod(textures[16], uv, lod);
    }
}

// Trilinear, with up to four probes along the longer axis.
vec4 filtered(uint which, vec4 size, vec2 uv, vec2 dx, vec2 dy)
{
    float lx = texels_along(size, dx), ly = texels_along(size, dy);
    vec2 axis = lx > ly ? dx : dy;
    float longer = max(lx, ly), shorter = min(lx, ly);
    float probes = 1.0, lod = 0.0;
    vec4 sum = vec4(0.0);
    uv = all(lessThan(abs(uv), vec2(1e9))) ? uv : vec2(0.0);
    if (!(longer < 1e9)) {
        axis = vec2(0.0);
        lod = size.z - 1.0;
    } else if (longer > 1.0) {
        probes = shorter * MAX_PROBES >= longer ? ceil(longer / shorter) : MAX_PROBES;
        lod = log2(longer / probes);
    }
    [[dont_unroll]] for (float i = 0.0; i < probes; i += 1.0) {
        float along = probes > 1.0 ? (i + 0.5) / probes - 0.5 : 0.0;
        sum += texel_at(which, uv + axis * along, lod);
    }
    return sum / probes;
}
