/* lit.c - the Lit model with a constant mask of features. See check_features.py.
 * SPDX-License-Identifier: MIT */
/* So that it is not the size of a function before its dead statements are gone that decides whether it
 * is inlined. */
#define HDRP_FN static inline __attribute__((always_inline))
#include "hdrp_brdf.h"

hdrp_brdf_lit_view lit_view(const hdrp_brdf_data* d, const float* x);
hdrp_brdf_lit lit_eval(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x);
hdrp_brdf_lit_env lit_env(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w);
hdrp_v3 lit_sample(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x);
float lit_pdf(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x);
void lit_loop(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x, float* y);

static hdrp_v3 vector(const float* x)
{
    return hdrp_v3_make(x[0], x[1], x[2]);
}

hdrp_brdf_lit_view lit_view(const hdrp_brdf_data* d, const float* x)
{
    return hdrp_brdf_lit_view_make(*d, vector(x), hdrp_brdf_fgd_fast(x[3], x[4]), MASK);
}

hdrp_brdf_lit lit_eval(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x)
{
    return hdrp_brdf_lit_eval(*d, *w, vector(x), MASK);
}

hdrp_brdf_lit_env lit_env(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w)
{
    return hdrp_brdf_lit_env_make(*d, *w, MASK);
}

hdrp_v3 lit_sample(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x)
{
    return hdrp_brdf_lit_sample(*d, *w, vector(x), MASK);
}

float lit_pdf(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x)
{
    return hdrp_brdf_lit_pdf(*d, *w, vector(x), MASK);
}

void lit_loop(const hdrp_brdf_data* d, const hdrp_brdf_lit_view* w, const float* x, float* y)
{
    for (int i = 0; i < 1024; ++i) {
        hdrp_brdf_lit r =
            hdrp_brdf_lit_eval(*d, *w, hdrp_v3_make(x[i], x[i + 1024], x[i + 2048]), MASK);
        y[i] = r.diffuse.x + r.specular.x;
    }
}
