/* The difference between two linear images. */
#ifndef RD_COMPARE_H
#define RD_COMPARE_H

#include "image.h"

typedef struct rd_difference {
    uint64_t pixels;      /* covered in both: alpha > 0 */
    double psnr_db;       /* of exposed, clipped, sRGB-encoded values; infinite if identical */
    double relative_mean; /* of |a - b| / max(a, b), over pixels, by luminance */
    double relative_p999; /* its 99.9th percentile */
    double relative_max;
    double relative_mse; /* of (a - b)^2 / (b^2 + 1 % of full scale, squared), by luminance */
    double mean_ratio;   /* mean luminance of a over that of b */
} rd_difference;

/* Both RGBA of the same size. `scale` is the exposure before clipping. */
bool rd_compare(const float* a, const float* b, int width, int height, float scale,
                rd_difference* out);

#endif
