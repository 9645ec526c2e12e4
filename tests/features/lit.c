/* lit.c - the Lit model with a constant mask of features, or with two, as an engine that chooses
 * between variants has them in one file. See check_features.py.
 * SPDX-License-Identifier: MIT */
#include "hdrp_brdf.h"

static hdrp_v3 vector(const float* x)
{
    return hdrp_v3_make(x[0], x[1], x[2]);
}

#define VARIANT(name, mask)                                                                        \
    hdrp_brdf_lit_view name##_view(const hdrp_brdf_data* d, const float* x)                        \
    {                                                                                              \
        return hdrp_brdf_lit_view_make(*d, vector(x), hdrp_brdf_fgd_fast(x[3], x[4]), mask);       \
    }                                                                                              \
    hdrp_brdf_lit name##_eval(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w,                \
                              const float* x)                                                      \
    {                                                                                              \
        return hdrp_brdf_lit_eval(*d, *w, vector(x), mask);                                        \
    }                                                                                              \
    hdrp_brdf_lit_env name##_env(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w)             \
    {                                                                                              \
        return hdrp_brdf_lit_env_make(*d, *w, mask);                                               \
    }                                                                                              \
    hdrp_v3 name##_sample(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x)    \
    {                                                                                              \
        return hdrp_brdf_lit_sample(*d, *w, vector(x), mask);                                      \
    }                                                                                              \
    float name##_pdf(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x)         \
    {                                                                                              \
        return hdrp_brdf_lit_pdf(*d, *w, vector(x), mask);                                         \
    }                                                                                              \
    void name##_loop(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x,         \
                     float* y)                                                                     \
    {                                                                                              \
        for (int i = 0; i < 1024; ++i) {                                                           \
            hdrp_brdf_lit r =                                                                      \
                hdrp_brdf_lit_eval(*d, *w, hdrp_v3_make(x[i], x[i + 1024], x[i + 2048]), mask);    \
            y[i] = r.diffuse.x + r.specular.x;                                                     \
        }                                                                                          \
    }

VARIANT(first, MASK)
#ifdef OTHER_MASK
VARIANT(second, OTHER_MASK)
#endif
