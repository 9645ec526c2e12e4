/* data.c - the arrays that kernels read and write.
 * SPDX-License-Identifier: MIT */
#define HDRP_API static __attribute__((unused))
#define HDRP_BRDF_IMPLEMENTATION
#define HDRP_ENV_IMPLEMENTATION
#include "bench.h"

#include <stdlib.h>

float bench_normal_x[BENCH_COUNT], bench_normal_y[BENCH_COUNT], bench_normal_z[BENCH_COUNT];
float bench_normals[4 * BENCH_COUNT], bench_sorted_normals[4 * BENCH_COUNT];
float bench_light_x[BENCH_COUNT], bench_light_y[BENCH_COUNT], bench_light_z[BENCH_COUNT];
float bench_half_x[BENCH_COUNT], bench_half_y[BENCH_COUNT], bench_half_z[BENCH_COUNT];
float bench_u[BENCH_COUNT], bench_v[BENCH_COUNT], bench_w[BENCH_COUNT];
float bench_cosine[BENCH_COUNT], bench_cosine_2[BENCH_COUNT];
float bench_roughness[BENCH_COUNT], bench_alpha[BENCH_COUNT];
float bench_signed[BENCH_COUNT], bench_signed_2[BENCH_COUNT], bench_angle[BENCH_COUNT];
float bench_positive[BENCH_COUNT], bench_exponent[BENCH_COUNT];
float bench_kelvin[BENCH_COUNT], bench_thickness[BENCH_COUNT];
float bench_red[BENCH_COUNT], bench_green[BENCH_COUNT], bench_blue[BENCH_COUNT];
hdrp_u32 bench_code[BENCH_COUNT];
uint16_t bench_half_code[BENCH_COUNT];
int16_t bench_oct_filtered[4 * BENCH_COUNT];
hdrp_light bench_lights[1];
hdrp_brdf_data bench_material[1];
hdrp_brdf_lit_view bench_view[BENCH_SET_COUNT];
hdrp_env bench_env[1];
hdrp_env_sh bench_sh[1];
hdrp_brdf_fgd bench_fgd[BENCH_TABLE_SIZE * BENCH_TABLE_SIZE];
hdrp_brdf_fgd bench_fgd_noisy[BENCH_TABLE_SIZE * BENCH_TABLE_SIZE];
float bench_out_a[BENCH_COUNT], bench_out_b[BENCH_COUNT], bench_out_c[BENCH_COUNT];
hdrp_u32 bench_out_code[BENCH_COUNT];
uint16_t bench_out_half[BENCH_COUNT];
hdrp_u32 bench_out_oct[2 * BENCH_COUNT];
float bench_memory_a[BENCH_MEMORY_COUNT], bench_memory_b[BENCH_MEMORY_COUNT],
    bench_memory_c[BENCH_MEMORY_COUNT];
hdrp_u32 bench_memory_code[BENCH_MEMORY_COUNT];
uint16_t bench_memory_half[BENCH_MEMORY_COUNT];
hdrp_u32 bench_zero;

/* In [0,1), another for each i and each of the streams. */
static float uniform(int i, hdrp_u32 stream)
{
    return hdrp_unit_from_u32(hdrp_hash2((hdrp_u32)i, stream));
}

static void set_directions(int i)
{
    hdrp_v3 n = hdrp_sphere_uniform(hdrp_v2_make(uniform(i, 0u), uniform(i, 1u)));
    hdrp_v3 l = hdrp_hemisphere_uniform(hdrp_v2_make(uniform(i, 2u), uniform(i, 3u)));
    hdrp_v3 v = hdrp_v3_make(0.6f, 0.0f, 0.8f);
    hdrp_v3 h = hdrp_brdf_half_vector(l, v, hdrp_v3_make(0.0f, 0.0f, 1.0f));
    hdrp_u32 code;
    bench_normals[4 * i] = bench_normal_x[i] = n.x;
    bench_normals[4 * i + 1] = bench_normal_y[i] = n.y;
    bench_normals[4 * i + 2] = bench_normal_z[i] = n.z;
    code = hdrp_pack_oct_snorm_from_normal(n, 12u);
    bench_oct_filtered[4 * i] = (int16_t)hdrp_i_pack_float_from_signed_code(code, 12u);
    bench_oct_filtered[4 * i + 1] = (int16_t)hdrp_i_pack_float_from_signed_code(code >> 12, 12u);
    bench_oct_filtered[4 * i + 2] = 2047;
    bench_light_x[i] = l.x;
    bench_light_y[i] = l.y;
    bench_light_z[i] = l.z;
    bench_half_x[i] = h.x;
    bench_half_y[i] = h.y;
    bench_half_z[i] = h.z;
}

/* Numbers in the ranges that a renderer meets. Colours spread over what a half can hold; one blue
 * of 256 is a denormal half. */
static void set_numbers(int i)
{
    bench_u[i] = uniform(i, 4u);
    bench_v[i] = uniform(i, 5u);
    bench_w[i] = uniform(i, 6u);
    bench_cosine[i] = 0.01f + 0.99f * uniform(i, 7u);
    bench_cosine_2[i] = 0.01f + 0.99f * uniform(i, 8u);
    bench_roughness[i] = 0.05f + 0.95f * uniform(i, 9u);
    bench_alpha[i] = hdrp_sq(bench_roughness[i]);
    bench_signed[i] = 2.0f * uniform(i, 10u) - 1.0f;
    bench_signed_2[i] = 2.0f * uniform(i, 11u) - 1.0f;
    bench_angle[i] = HDRP_TWO_PI * bench_signed[i];
    bench_positive[i] = hdrp_exp2(10.0f * bench_signed[i]);
    bench_exponent[i] = 20.0f * bench_signed_2[i];
    bench_kelvin[i] = 1500.0f + 13500.0f * uniform(i, 12u);
    bench_thickness[i] = 100.0f + 800.0f * uniform(i, 13u);
    bench_red[i] = hdrp_exp2(14.0f - 28.0f * uniform(i, 14u));
    bench_green[i] = hdrp_exp2(14.0f - 28.0f * uniform(i, 15u));
    bench_blue[i] = i % 256 ? hdrp_exp2(14.0f - 28.0f * uniform(i, 16u)) : 1e-5f;
    bench_code[i] = hdrp_hash2((hdrp_u32)i, 17u);
    bench_half_code[i] = (uint16_t)hdrp_pack_half_from_float(i % 2 ? bench_red[i] : -bench_blue[i]);
}

/* A material that has everything, so that a mask decides alone what is evaluated. */
static void set_material(void)
{
#define MASK(id, name, mask) mask,
    static const hdrp_u32 masks[] = {BENCH_SETS(MASK)};
#undef MASK
    hdrp_brdf_surface s = hdrp_brdf_surface_default();
    s.base_color = hdrp_v3_make(0.7f, 0.5f, 0.2f);
    s.metallic = 0.3f;
    s.perceptual_roughness = 0.4f;
    s.anisotropy = 0.5f;
    s.coat_mask = 0.8f;
    s.coat_normal = hdrp_v3_make(0.1f, 0.1f, 0.99f);
    s.film_mask = 0.7f;
    s.transmittance = hdrp_v3_make(0.3f, 0.4f, 0.5f);
    s.transmission = 0.4f;
    s.features = HDRP_BRDF_FEATURE_ALL;
    bench_material[0] = hdrp_brdf_data_from_surface(s);
    for (int i = 0; i < BENCH_SET_COUNT; ++i) {
        bench_view[i] =
            hdrp_brdf_lit_view_make(bench_material[0], hdrp_v3_make(0.6f, 0.0f, 0.8f),
                                    hdrp_brdf_fgd_fast(0.8f, s.perceptual_roughness), masks[i]);
    }
}

/* Small cubes of noise: a lookup takes the same time whatever is in them. */
static void set_environment(void)
{
    hdrp_env_desc desc = {0};
    size_t bytes;
    void* memory;
    desc.radiance_size = 16;
    desc.specular_size = 16;
    desc.irradiance_size = 8;
    bytes = hdrp_env_memory_size(&desc);
    memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    if (!memory || hdrp_env_init(bench_env, &desc, memory, bytes) != HDRP_OK) {
        abort();
    }
    for (size_t i = 0; i < bytes / sizeof(float); ++i) {
        ((float*)memory)[i] = uniform((int)i, 18u);
    }
    for (int i = 0; i < 9; ++i) {
        (&bench_sh->mean)[i] =
            hdrp_v4_make(uniform(i, 19u), uniform(i, 20u), uniform(i, 21u), 0.0f);
    }
}

static void swap(void* data, size_t size, size_t i, size_t j)
{
    char* bytes = (char*)data;
    char saved[16];
    memcpy(saved, bytes + i * size, size);
    memcpy(bytes + i * size, bytes + j * size, size);
    memcpy(bytes + j * size, saved, size);
}

/* The outputs are left where they are. */
void bench_data_shuffle(void)
{
    static float* const floats[] = {
        bench_normal_x, bench_normal_y, bench_normal_z,  bench_light_x,  bench_light_y,
        bench_light_z,  bench_half_x,   bench_half_y,    bench_half_z,   bench_u,
        bench_v,        bench_w,        bench_cosine,    bench_alpha,    bench_cosine_2,
        bench_signed,   bench_angle,    bench_roughness, bench_signed_2, bench_exponent,
        bench_positive, bench_kelvin,   bench_thickness, bench_red,      bench_green,
        bench_blue,
    };
    static hdrp_u32 turn = 0u;
    ++turn;
    for (size_t i = BENCH_COUNT - 1u; i > 0u; --i) {
        size_t j = hdrp_hash2((hdrp_u32)i, turn) % (i + 1u);
        for (size_t k = 0; k < sizeof floats / sizeof floats[0]; ++k) {
            swap(floats[k], sizeof(float), i, j);
        }
        swap(bench_normals, 4 * sizeof(float), i, j);
        swap(bench_oct_filtered, 4 * sizeof(int16_t), i, j);
        swap(bench_code, sizeof bench_code[0], i, j);
        swap(bench_half_code, sizeof bench_half_code[0], i, j);
    }
}

static int octant(const float* n)
{
    return (n[0] < 0.0f) + 2 * (n[1] < 0.0f) + 4 * (n[2] < 0.0f);
}

static int by_octant(const void* a, const void* b)
{
    return octant((const float*)a) - octant((const float*)b);
}

void bench_data_init(void)
{
    for (int i = 0; i < BENCH_COUNT; ++i) {
        set_directions(i);
        set_numbers(i);
    }
    memcpy(bench_sorted_normals, bench_normals, sizeof bench_normals);
    qsort(bench_sorted_normals, BENCH_COUNT, 4 * sizeof(float), by_octant);
    for (int i = 0; i < BENCH_MEMORY_COUNT; ++i) {
        bench_memory_a[i] = bench_red[i % BENCH_COUNT];
        bench_memory_b[i] = bench_green[i % BENCH_COUNT];
        bench_memory_c[i] = bench_blue[i % BENCH_COUNT];
    }
    bench_lights[0] =
        hdrp_light_spot(hdrp_v3_make(0.0f, 0.0f, 5.0f), hdrp_v3_make(0.0f, 0.0f, -1.0f),
                        hdrp_v3_splat(100.0f), 20.0f, 0.5f, 0.7f);
    set_material();
    set_environment();
    if (hdrp_brdf_fgd_bake_rows(bench_fgd, BENCH_TABLE_SIZE, 0, BENCH_TABLE_SIZE) != HDRP_OK) {
        abort();
    }
}
