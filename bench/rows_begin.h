/* rows_begin.h - turns the ROW_... lines that follow into loops; with BENCH_TABLE into the table.
 * SPDX-License-Identifier: MIT
 *
 * ROW_RESULT(topic, function, peer, id, array, expression): expression is of the given result and
 * contains x, an element of array, and i, its index. The calls of the scalar form depend on each
 * other; those of the vector form do not. ROW_RESULT_SCALAR has no vector form. ROW_VECTOR is a
 * vector form whose statements do all themselves, ROW_ONCE one that handles all elements in a call.
 * The arrays of ROW_MEMORY are too large for any cache. id makes the names of the loops. */
#undef ROW_F
#undef ROW_3
#undef ROW_U
#undef ROW_UF
#undef ROW_U3
#undef ROW_U_SCALAR
#undef ROW_UF_SCALAR
#undef ROW_VECTOR
#undef ROW_MEMORY
#undef ROW_MEMORY_ONCE
#undef ROW_ONCE

#ifdef BENCH_TABLE

#define BENCH_ENTRY(topic, name, peer, id, form) {#topic, #name, peer, #form, id##_##form},
#define BENCH_BOTH(topic, name, peer, id)                                                          \
    BENCH_ENTRY(topic, name, peer, id, scalar) BENCH_ENTRY(topic, name, peer, id, vector)
#define ROW_F(topic, name, peer, id, array, ...)         BENCH_BOTH(topic, name, peer, id)
#define ROW_3(topic, name, peer, id, array, ...)         BENCH_BOTH(topic, name, peer, id)
#define ROW_U(topic, name, peer, id, array, ...)         BENCH_BOTH(topic, name, peer, id)
#define ROW_UF(topic, name, peer, id, array, ...)        BENCH_BOTH(topic, name, peer, id)
#define ROW_U3(topic, name, peer, id, array, ...)        BENCH_BOTH(topic, name, peer, id)
#define ROW_VECTOR(topic, name, peer, id, ...)           BENCH_ENTRY(topic, name, peer, id, vector)
#define ROW_MEMORY(topic, name, peer, id, ...)           BENCH_ENTRY(topic, name, peer, id, memory)
#define ROW_MEMORY_ONCE(topic, name, peer, id, ...)      BENCH_ENTRY(topic, name, peer, id, memory)
#define ROW_U_SCALAR(topic, name, peer, id, array, ...)  BENCH_ENTRY(topic, name, peer, id, scalar)
#define ROW_UF_SCALAR(topic, name, peer, id, array, ...) BENCH_ENTRY(topic, name, peer, id, scalar)
#define ROW_ONCE(topic, name, peer, id, ...)             BENCH_ENTRY(topic, name, peer, id, vector)

#else

#define BENCH_VECTOR(id, ...)                                                                      \
    static void id##_vector(void)                                                                  \
    {                                                                                              \
        for (int i = 0; i < BENCH_COUNT; ++i) {                                                    \
            __VA_ARGS__;                                                                           \
        }                                                                                          \
    }
#define BENCH_SCALAR(id, type, result, chain, array, ...)                                          \
    static void id##_scalar(void)                                                                  \
    {                                                                                              \
        const hdrp_u32 zero = bench_zero;                                                          \
        type before = (type)zero;                                                                  \
        for (int i = 0; i < BENCH_COUNT; ++i) {                                                    \
            type x = chain(array[i], before, zero);                                                \
            before = result(__VA_ARGS__);                                                          \
        }                                                                                          \
        bench_out_a[0] = (float)before;                                                            \
    }
/* A float in, a float, a vector or a code out. */
#define ROW_F(topic, name, peer, id, array, ...)                                                   \
    BENCH_VECTOR(id, float x = array[i]; bench_out_a[i] = (__VA_ARGS__))                           \
    BENCH_SCALAR(id, float, , bench_chain, array, __VA_ARGS__)
#define ROW_3(topic, name, peer, id, array, ...)                                                   \
    BENCH_VECTOR(id, float x = array[i]; hdrp_v3 r = (__VA_ARGS__); bench_out_a[i] = r.x;          \
                 bench_out_b[i] = r.y; bench_out_c[i] = r.z)                                       \
    BENCH_SCALAR(id, float, bench_joined, bench_chain, array, __VA_ARGS__)
#define ROW_U(topic, name, peer, id, array, ...)                                                   \
    BENCH_VECTOR(id, float x = array[i]; bench_out_code[i] = (__VA_ARGS__))                        \
    BENCH_SCALAR(id, float, hdrp_f32_from_bits, bench_chain, array, __VA_ARGS__)
/* A code in. */
#define ROW_UF(topic, name, peer, id, array, ...)                                                  \
    BENCH_VECTOR(id, hdrp_u32 x = array[i]; bench_out_a[i] = (__VA_ARGS__))                        \
    BENCH_SCALAR(id, hdrp_u32, hdrp_bits_from_f32, bench_chain_u32, array, __VA_ARGS__)
#define ROW_U3(topic, name, peer, id, array, ...)                                                  \
    BENCH_VECTOR(id, hdrp_u32 x = array[i]; hdrp_v3 r = (__VA_ARGS__); bench_out_a[i] = r.x;       \
                 bench_out_b[i] = r.y; bench_out_c[i] = r.z)                                       \
    BENCH_SCALAR(id, hdrp_u32, bench_joined_bits, bench_chain_u32, array, __VA_ARGS__)
#define ROW_U_SCALAR(topic, name, peer, id, array, ...)                                            \
    BENCH_SCALAR(id, float, hdrp_f32_from_bits, bench_chain, array, __VA_ARGS__)
#define ROW_UF_SCALAR(topic, name, peer, id, array, ...)                                           \
    BENCH_SCALAR(id, hdrp_u32, hdrp_bits_from_f32, bench_chain_u32, array, __VA_ARGS__)
#define ROW_VECTOR(topic, name, peer, id, ...) BENCH_VECTOR(id, __VA_ARGS__)
#define ROW_MEMORY(topic, name, peer, id, ...)                                                     \
    static void id##_memory(void)                                                                  \
    {                                                                                              \
        for (int i = 0; i < BENCH_MEMORY_COUNT; ++i) {                                             \
            __VA_ARGS__;                                                                           \
        }                                                                                          \
    }
#define ROW_ONCE(topic, name, peer, id, ...)                                                       \
    static void id##_vector(void)                                                                  \
    {                                                                                              \
        __VA_ARGS__;                                                                               \
    }
#define ROW_MEMORY_ONCE(topic, name, peer, id, ...)                                                \
    static void id##_memory(void)                                                                  \
    {                                                                                              \
        __VA_ARGS__;                                                                               \
    }

#endif
