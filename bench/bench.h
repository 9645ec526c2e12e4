/* bench.h - what is measured, and the data it is measured on.
 * SPDX-License-Identifier: MIT
 *
 * A list of kernels is a file of ROW_... lines, included twice: once for the loops, once for the
 * table of them. It is built by gcc and by clang, each with the flags of CMakeLists.txt. */
#ifndef HDRP_BENCH_H
#define HDRP_BENCH_H

#include "hdrp_brdf.h"
#include "hdrp_env.h"
#include "hdrp_light.h"
#include "hdrp_pack.h"

#include <stddef.h>

/* Texels of an FGD table: as many as the arrays have elements. */
#define BENCH_TABLE_SIZE 64

/* Elements of each array: three in and three out fit the L2 cache. */
#define BENCH_COUNT 4096

/* Elements of the arrays of the form "memory": 16 MiB each. */
#define BENCH_MEMORY_COUNT (1 << 22)

typedef struct bench_kernel {
    const char* topic;
    const char* name; /* the function of hdrp, also where a peer is measured */
    const char* peer; /* what stands in for it, or NULL */
    const char* form; /* "scalar", "vector" or "memory" */
    void (*run)(void);
} bench_kernel;

typedef struct bench_list {
    const bench_kernel* kernels;
    size_t count;
} bench_list;

#define BENCH_ALIGNED __attribute__((aligned(64)))
#define BENCH_DATA    extern BENCH_ALIGNED

/* Sets of features of the Lit model whose cost is asked for: X(identifier, name, mask). */
/* clang-format off */
#define BENCH_SETS(X)                                                                              \
    X(standard, standard, 0u)                                                                      \
    X(coat, standard+coat, HDRP_BRDF_FEATURE_CLEAR_COAT)                                         \
    X(aniso, standard+anisotropy, HDRP_BRDF_FEATURE_ANISOTROPY)                                  \
    X(film, standard+iridescence, HDRP_BRDF_FEATURE_IRIDESCENCE)                                 \
    X(slab, standard+transmission, HDRP_BRDF_FEATURE_TRANSMISSION)                               \
    X(wall, standard+refraction, HDRP_BRDF_FEATURE_REFRACTION)                                   \
    X(coat_aniso, standard+coat+anisotropy,                                                    \
      HDRP_BRDF_FEATURE_CLEAR_COAT | HDRP_BRDF_FEATURE_ANISOTROPY)                                 \
    X(coat_film, standard+coat+iridescence,                                                    \
      HDRP_BRDF_FEATURE_CLEAR_COAT | HDRP_BRDF_FEATURE_IRIDESCENCE)                                \
    X(aniso_film, standard+anisotropy+iridescence,                                             \
      HDRP_BRDF_FEATURE_ANISOTROPY | HDRP_BRDF_FEATURE_IRIDESCENCE)                                \
    X(coat_slab, standard+coat+transmission,                                                   \
      HDRP_BRDF_FEATURE_CLEAR_COAT | HDRP_BRDF_FEATURE_TRANSMISSION)                               \
    X(coat_aniso_film, standard+coat+anisotropy+iridescence,                                 \
      HDRP_BRDF_FEATURE_CLEAR_COAT | HDRP_BRDF_FEATURE_ANISOTROPY | HDRP_BRDF_FEATURE_IRIDESCENCE) \
    X(all, all, HDRP_BRDF_FEATURE_ALL)
/* clang-format on */
#define BENCH_SET_INDEX(id, name, mask) BENCH_SET_##id,
enum { BENCH_SETS(BENCH_SET_INDEX) BENCH_SET_COUNT };

#ifdef __cplusplus
extern "C" {
#endif

/* Inputs. data.c says how they are distributed. */
BENCH_DATA float bench_normal_x[BENCH_COUNT], bench_normal_y[BENCH_COUNT],
    bench_normal_z[BENCH_COUNT];
BENCH_DATA float bench_normals[4 * BENCH_COUNT];        /* the same, xyz0 of each in turn */
BENCH_DATA float bench_sorted_normals[4 * BENCH_COUNT]; /* the same, by octants */
BENCH_DATA float bench_light_x[BENCH_COUNT], bench_light_y[BENCH_COUNT], bench_light_z[BENCH_COUNT];
BENCH_DATA float bench_half_x[BENCH_COUNT], bench_half_y[BENCH_COUNT], bench_half_z[BENCH_COUNT];
BENCH_DATA float bench_u[BENCH_COUNT], bench_v[BENCH_COUNT], bench_w[BENCH_COUNT];
BENCH_DATA float bench_cosine[BENCH_COUNT], bench_cosine_2[BENCH_COUNT];
BENCH_DATA float bench_roughness[BENCH_COUNT], bench_alpha[BENCH_COUNT];
BENCH_DATA float bench_signed[BENCH_COUNT], bench_signed_2[BENCH_COUNT], bench_angle[BENCH_COUNT];
BENCH_DATA float bench_positive[BENCH_COUNT], bench_exponent[BENCH_COUNT];
BENCH_DATA float bench_kelvin[BENCH_COUNT], bench_thickness[BENCH_COUNT];
BENCH_DATA float bench_red[BENCH_COUNT], bench_green[BENCH_COUNT], bench_blue[BENCH_COUNT];
BENCH_DATA hdrp_u32 bench_code[BENCH_COUNT];
BENCH_DATA uint16_t bench_half_code[BENCH_COUNT];
BENCH_DATA int16_t bench_oct_filtered[4 * BENCH_COUNT];
BENCH_DATA hdrp_light bench_lights[1];
BENCH_DATA hdrp_brdf_data bench_material[1];               /* of all features */
BENCH_DATA hdrp_brdf_lit_view bench_view[BENCH_SET_COUNT]; /* of it, for each of BENCH_SETS */
BENCH_DATA hdrp_env bench_env[1];
BENCH_DATA hdrp_env_sh bench_sh[1];

BENCH_DATA float bench_memory_a[BENCH_MEMORY_COUNT], bench_memory_b[BENCH_MEMORY_COUNT],
    bench_memory_c[BENCH_MEMORY_COUNT];
BENCH_DATA hdrp_u32 bench_memory_code[BENCH_MEMORY_COUNT];
BENCH_DATA uint16_t bench_memory_half[BENCH_MEMORY_COUNT];

BENCH_DATA hdrp_brdf_fgd bench_fgd[BENCH_TABLE_SIZE * BENCH_TABLE_SIZE];
BENCH_DATA hdrp_brdf_fgd bench_fgd_noisy[BENCH_TABLE_SIZE * BENCH_TABLE_SIZE];

/* Outputs. */
BENCH_DATA float bench_out_a[BENCH_COUNT], bench_out_b[BENCH_COUNT], bench_out_c[BENCH_COUNT];
BENCH_DATA hdrp_u32 bench_out_code[BENCH_COUNT];
BENCH_DATA uint16_t bench_out_half[BENCH_COUNT];
BENCH_DATA hdrp_u32 bench_out_oct[2 * BENCH_COUNT];

/* 0, which no compiler knows. */
extern hdrp_u32 bench_zero;

void bench_data_init(void);

/* Another order of the same elements. Where the branches of a function go is learned within a few
 * repetitions, even for thousands of elements, and would seem to cost nothing. */
void bench_data_shuffle(void);

/* The lists. Their names end in the compiler that built them. */
#define BENCH_LISTS(build)                                                                         \
    extern const bench_list bench_formulas_##build, bench_peers_##build, bench_peers_cpp_##build
BENCH_LISTS(gcc);
BENCH_LISTS(gcc_trapping);
BENCH_LISTS(clang);

#ifdef __cplusplus
}
#endif

/* x, which the processor cannot have before it has after: how calls are made to depend on each
 * other. Takes two instructions of a cycle each. */
static inline hdrp_u32 bench_chain_u32(hdrp_u32 x, hdrp_u32 after, hdrp_u32 zero)
{
    return x | (after & zero);
}

static inline float bench_chain(float x, float after, hdrp_u32 zero)
{
    return hdrp_f32_from_bits(
        bench_chain_u32(hdrp_bits_from_f32(x), hdrp_bits_from_f32(after), zero));
}

/* What the next call of a chain depends on: some of each component. */
static inline hdrp_u32 bench_joined_bits(hdrp_v3 r)
{
    return hdrp_bits_from_f32(r.x) ^ hdrp_bits_from_f32(r.y) ^ hdrp_bits_from_f32(r.z);
}

static inline float bench_joined(hdrp_v3 r)
{
    return hdrp_f32_from_bits(bench_joined_bits(r));
}

#endif
