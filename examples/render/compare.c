#include "compare.h"

#include "hdrp_math.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Below this share of full scale a difference is invisible, however large relative to itself. */
#define DARK 1e-3
/* The same for squares, as papers on Monte Carlo methods have it. */
#define DARK_OF_SQUARES 1e-2

static double encode(float x, float scale)
{
    return (double)hdrp_srgb_from_linear(hdrp_saturate(x * scale));
}

static double luminance(const float* p)
{
    return 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2];
}

static int compare_doubles(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return x < y ? -1 : x > y;
}

static void summarize(double* relative, uint64_t n, rd_difference* out)
{
    double sum = 0;
    qsort(relative, (size_t)n, sizeof *relative, compare_doubles);
    for (uint64_t i = 0; i < n; ++i) {
        sum += relative[i];
    }
    out->relative_mean = sum / (double)n;
    out->relative_max = relative[n - 1];
    out->relative_p999 = relative[(uint64_t)(0.999 * (double)(n - 1))];
}

bool rd_compare(const float* a, const float* b, int width, int height, float scale,
                rd_difference* out)
{
    size_t count = (size_t)width * (size_t)height;
    double* relative = (double*)malloc((count ? count : 1) * sizeof *relative);
    double square = 0, relative_square = 0, sum_a = 0, sum_b = 0;
    double floor_of_squares = DARK_OF_SQUARES / (double)scale;
    uint64_t n = 0;
    memset(out, 0, sizeof *out);
    if (!relative) {
        return false;
    }
    for (size_t i = 0; i < count; ++i, a += 4, b += 4) {
        double la = luminance(a), lb = luminance(b);
        if (!(a[3] > 0.0f && b[3] > 0.0f)) {
            continue;
        }
        for (int c = 0; c < 3; ++c) {
            double d = encode(a[c], scale) - encode(b[c], scale);
            square += d * d / 3.0;
        }
        relative[n++] = fabs(la - lb) / fmax(fmax(la, lb), DARK / (double)scale);
        relative_square += (la - lb) * (la - lb) / (lb * lb + floor_of_squares * floor_of_squares);
        sum_a += la;
        sum_b += lb;
    }
    out->pixels = n;
    if (n) {
        out->psnr_db = square > 0 ? -10.0 * log10(square / (double)n) : (double)INFINITY;
        out->relative_mse = relative_square / (double)n;
        out->mean_ratio = sum_b > 0 ? sum_a / sum_b : 1.0;
        summarize(relative, n, out);
    }
    free(relative);
    return true;
}
