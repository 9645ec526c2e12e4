/* half_as_float.hpp - from here on, float is hdrp_half.
 * SPDX-License-Identifier: MIT */
#define float hdrp_half
#define memcpy half_memcpy
#undef isfinite
#undef isnan
#define isfinite half_isfinite
#define isnan    half_isnan
/* A NaN among several errors must not be lost in their maximum. */
#define fmax half_fmax
