/* complex.h - what the registry uses of C11's complex numbers, for g++.
 * SPDX-License-Identifier: MIT */
#define complex __complex__
#define I       1.0i
#define csqrt   __builtin_csqrt
#define cexp    __builtin_cexp
#define cabs    __builtin_cabs
#define creal   __builtin_creal
#define cimag   __builtin_cimag
#define conj    __builtin_conj
