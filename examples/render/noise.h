/* Tileable gradient noise for generated textures and shapes. */
#ifndef RD_NOISE_H
#define RD_NOISE_H

#include "hdrp_math.h"

/* The lattice gradient at a corner, dotted with the offset from it. */
static inline float rd_noise_corner(int32_t x, int32_t y, int32_t z, hdrp_v3 d, uint32_t period,
                                    uint32_t seed)
{
    uint32_t h =
        hdrp_hash3((uint32_t)x % period, (uint32_t)y % period, (uint32_t)z % period + (seed << 16));
    hdrp_v3 g =
        hdrp_v3_make((float)(h & 1023u) / 511.5f - 1.0f, (float)(h >> 10 & 1023u) / 511.5f - 1.0f,
                     (float)(h >> 20 & 1023u) / 511.5f - 1.0f);
    return hdrp_v3_dot(g, d);
}

static inline float rd_fade(float t)
{
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

/* Perlin 2002, "Improving Noise": about [-1, 1], repeating after `period` in each direction.
 * Coordinates are >= 0. */
static inline float rd_noise(hdrp_v3 p, uint32_t period, uint32_t seed)
{
    int32_t x = (int32_t)p.x, y = (int32_t)p.y, z = (int32_t)p.z;
    hdrp_v3 f = hdrp_v3_make(p.x - (float)x, p.y - (float)y, p.z - (float)z);
    float u = rd_fade(f.x), v = rd_fade(f.y), w = rd_fade(f.z);
    float plane[2];
    for (int k = 0; k < 2; ++k) {
        float row[2];
        for (int j = 0; j < 2; ++j) {
            hdrp_v3 d = hdrp_v3_make(f.x, f.y - (float)j, f.z - (float)k);
            float a = rd_noise_corner(x, y + j, z + k, d, period, seed);
            d.x -= 1.0f;
            row[j] = hdrp_lerp(a, rd_noise_corner(x + 1, y + j, z + k, d, period, seed), u);
        }
        plane[k] = hdrp_lerp(row[0], row[1], v);
    }
    return hdrp_lerp(plane[0], plane[1], w);
}

/* Octaves of noise, each of half the size and strength. */
static inline float rd_fractal_noise(hdrp_v3 p, uint32_t period, int octaves, uint32_t seed)
{
    float sum = 0.0f, strength = 1.0f;
    for (int i = 0; i < octaves; ++i) {
        sum += strength * rd_noise(p, period, seed + (uint32_t)i);
        p = hdrp_v3_scale(p, 2.0f);
        period *= 2u;
        strength *= 0.5f;
    }
    return sum;
}

#endif
