/* formulas.c - loops over the formulas of hdrp.
 * SPDX-License-Identifier: MIT */
/* A copy of the algorithms by each compiler; not inlined, as where they are in another file. */
#define HDRP_API static __attribute__((unused, noinline))
#define HDRP_BRDF_IMPLEMENTATION
#define HDRP_ENV_IMPLEMENTATION
#include "bench.h"

#include "rows_begin.h"

HDRP_FN hdrp_v3 bench_v3_from_sincos(hdrp_sincos_result r)
{
    return hdrp_v3_make(r.sine, r.cosine, 0.0f);
}

/* What the filter of meshoptimizer writes: x, y, 1 and w in 16 bits each. */
static inline void bench_store_oct(int i, hdrp_u32 code)
{
    bench_out_oct[2 * i] = (code & 4095u) | ((code & 0xfff000u) << 4);
    bench_out_oct[2 * i + 1] = 2047u;
}

HDRP_FN hdrp_brdf_fgd bench_fgd_of(float albedo)
{
    hdrp_brdf_fgd f;
    f.albedo = albedo;
    f.schlick = albedo;
    return f;
}

HDRP_FN hdrp_v3 bench_lit(hdrp_brdf_lit_view w, hdrp_v3 l, hdrp_u32 features)
{
    hdrp_brdf_lit r = hdrp_brdf_lit_eval(bench_material[0], w, l, features);
    return hdrp_v3_add(r.diffuse, r.specular);
}

/* The material of one pixel. */
HDRP_FN hdrp_brdf_data bench_pixel(int i)
{
    hdrp_brdf_data d = bench_material[0];
    d.perceptual_roughness = bench_roughness[i];
    d.coat_perceptual_roughness = bench_roughness[i];
    d.anisotropy = bench_signed[i];
    d.film_thickness_nm = bench_thickness[i];
    return d;
}

HDRP_FN hdrp_brdf_lit_view bench_view_of(hdrp_brdf_data d, hdrp_v3 v, hdrp_u32 features)
{
    return hdrp_brdf_lit_view_make(d, v, hdrp_brdf_fgd_fast(v.z, d.perceptual_roughness), features);
}

/* The sum needs every part of the view that lights need. */
HDRP_FN hdrp_v3 bench_lit_view(int i, hdrp_v3 v, hdrp_u32 features)
{
    hdrp_brdf_lit_view w = bench_view_of(bench_pixel(i), v, features);
    hdrp_v3 r = hdrp_v3_add(w.diffuse, hdrp_v3_add(w.bounces.reflected, w.bounces.passed));
    r = hdrp_v3_mad(r, w.fresnel0, w.fresnel90 * w.multiscatter);
    r = hdrp_v3_mad(r, hdrp_v3_add(w.transmitted, w.coat_v), w.below_coat * w.coat_n_dot_v);
    return hdrp_v3_mad(r, w.transmitted, w.coat_alpha + w.transmitted_alpha);
}

/* A pixel of its own for each light. */
HDRP_FN hdrp_v3 bench_lit_both(int i, hdrp_v3 l)
{
    hdrp_brdf_data d = bench_pixel(i);
    hdrp_brdf_lit_view w = bench_view_of(d, hdrp_v3_make(0.6f, 0.0f, 0.8f), 0u);
    hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, l, 0u);
    return hdrp_v3_add(r.diffuse, r.specular);
}

#include "formulas.inc"

#define BENCH_TABLE
#include "rows_begin.h"

static const bench_kernel kernels[] = {
#include "formulas.inc"
};

const bench_list BENCH_LIST = {kernels, sizeof kernels / sizeof kernels[0]};
