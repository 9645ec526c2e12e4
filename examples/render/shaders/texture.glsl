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

// Lavapipe filters with eight bits, and rounds what comes out to as many: too coarse for normals.
// There texels are decoded and filtered here.
layout(constant_id = 2) const bool IS_COARSE = false;

vec4 fetch_texel(uint which, ivec2 at, int level)
{
    switch (which) {
    case 0u: return texelFetch(textures[0], at, level);
    case 1u: return texelFetch(textures[1], at, level);
    case 2u: return texelFetch(textures[2], at, level);
    case 3u: return texelFetch(textures[3], at, level);
    case 4u: return texelFetch(textures[4], at, level);
    case 5u: return texelFetch(textures[5], at, level);
    case 6u: return texelFetch(textures[6], at, level);
    case 7u: return texelFetch(textures[7], at, level);
    case 8u: return texelFetch(textures[8], at, level);
    case 9u: return texelFetch(textures[9], at, level);
    case 10u: return texelFetch(textures[10], at, level);
    case 11u: return texelFetch(textures[11], at, level);
    case 12u: return texelFetch(textures[12], at, level);
    case 13u: return texelFetch(textures[13], at, level);
    case 14u: return texelFetch(textures[14], at, level);
    case 15u: return texelFetch(textures[15], at, level);
    default: return texelFetch(textures[16], at, level);
    }
}

#define WRAP_REPEAT 0u
#define WRAP_CLAMP  1u

float wrap_coordinate(float u, uint wrap)
{
    float mirrored = u - 2.0 * floor(u * 0.5);
    return wrap == WRAP_CLAMP    ? hdrp_saturate(u)
           : wrap == WRAP_REPEAT ? u - floor(u)
           : mirrored > 1.0      ? 2.0 - mirrored
                                 : mirrored;
}

int wrap_index(int i, int n, uint wrap)
{
    return i < 0 ? (wrap == WRAP_REPEAT ? n - 1 : 0) : i < n ? i : wrap == WRAP_REPEAT ? 0 : n - 1;
}

// Bilinear in one level and, with lod between two, in the next: in one loop, see surface.glsl.
vec4 filtered_exactly(uint which, vec4 size, vec2 uv, float lod)
{
    uint kind = uint(size.w); // nearest, wrap_u << 1, wrap_v << 3, sRGB << 5
    uvec2 wrap = uvec2(kind >> 1 & 3u, kind >> 3 & 3u);
    float fine = clamp(floor(lod), 0.0, size.z - 1.0);
    float between = fine < size.z - 1.0 ? clamp(lod - fine, 0.0, 1.0) : 0.0;
    int taps = between > 0.0 ? 8 : 4;
    vec2 wrapped = vec2(wrap_coordinate(uv.x, wrap.x), wrap_coordinate(uv.y, wrap.y));
    vec4 sum = vec4(0.0);
    [[dont_unroll]] for (int i = 0; i < taps; ++i) {
        int level = int(fine) + (i >> 2);
        ivec2 n = max(ivec2(size.xy) >> level, ivec2(1));
        vec2 at = wrapped * vec2(n) - 0.5, first = floor(at), t = at - first;
        ivec2 to = ivec2(first) + ivec2(i & 1, i >> 1 & 1);
        t = (kind & 1u) != 0u && level == 0 ? step(vec2(0.5), t) : t;
        t = mix(1.0 - t, t, vec2(i & 1, i >> 1 & 1));
        to = ivec2(wrap_index(to.x, n.x, wrap.x), wrap_index(to.y, n.y, wrap.y));
        vec4 texel = fetch_texel(which, to, level);
        if ((kind & 32u) != 0u) {
            texel.xyz = vec3(hdrp_linear_from_srgb(texel.x), hdrp_linear_from_srgb(texel.y),
                             hdrp_linear_from_srgb(texel.z));
        }
        sum += texel * (t.x * t.y * (i < 4 ? 1.0 - between : between));
    }
    return sum;
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
        vec2 at = uv + axis * along;
        sum += IS_COARSE ? filtered_exactly(which, size, at, lod) : texel_at(which, at, lod);
    }
    return sum / probes;
}
