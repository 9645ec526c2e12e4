/* half.hpp - IEEE 754 half precision for the text of the headers and of the registry.
 * SPDX-License-Identifier: MIT
 *
 * Included before everything else in C++; `#define float hdrp_half` after it turns every float that
 * follows into this class. A value is kept as the float it equals, rounded to nearest even to 11
 * bits, denormals included, after every operation. Sum, difference, product, quotient and square
 * root in float are correctly rounded to half in this way, because 24 >= 2 * 11 + 2 (Figueroa 1995,
 * "When is double rounding innocuous?"); other functions are as good as libm in float.
 *
 * What no half can do leaves a mark, so that the registry can say why an entry has no number. */
#ifndef HDRP_HALF_HPP
#define HDRP_HALF_HPP

#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <cfloat>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct half_marks {
    bool bits;     /* made from a bit pattern that is no half, or infinity taken apart */
    bool integers; /* an integer that half does not hold, in either direction */
    bool outside;  /* an input in double beyond the range of half, or so small that it became 0 */
};
inline half_marks half_mark;

static inline uint32_t half_bits(float x)
{
    uint32_t u;
    std::memcpy(&u, &x, sizeof u);
    return u;
}

static inline float half_from_bits(uint32_t u)
{
    float x;
    std::memcpy(&x, &u, sizeof x);
    return x;
}

/* The nearest half. Below 2^-14 halves are multiples of 2^-24: adding and taking away 0.5, whose
 * last place is 2^-24, rounds to that; from 65520 on they are infinite. */
static inline float half_rounded(float x)
{
    uint32_t u = half_bits(x), magnitude = u & 0x7fffffffu;
    if (magnitude < 0x38800000u) {
        float y = (half_from_bits(magnitude) + 0.5f) - 0.5f;
        return half_from_bits(half_bits(y) | (u & 0x80000000u));
    }
    if (magnitude > 0x7f800000u) {
        return x;
    }
    magnitude = (magnitude + 0xfffu + ((magnitude >> 13) & 1u)) & ~0x1fffu;
    magnitude = magnitude > 0x477fe000u ? 0x7f800000u : magnitude;
    return half_from_bits(magnitude | (u & 0x80000000u));
}

class hdrp_half
{
  public:
    hdrp_half() = default;
    hdrp_half(float x) : value(half_rounded(x))
    {
    }
    hdrp_half(int i) : value(half_rounded((float)i))
    {
    }
    explicit hdrp_half(long i) : value(half_rounded((float)i))
    {
    }
    explicit hdrp_half(unsigned long i) : value(half_rounded((float)i))
    {
    }
    explicit hdrp_half(uint32_t u) : value(half_rounded((float)u))
    {
        half_mark.integers = half_mark.integers || (double)value != (double)u;
    }
    /* Rounded to odd on the way, lest a tie be made that was none. */
    explicit hdrp_half(double x)
    {
        float y = (float)x;
        uint32_t u = half_bits(y);
        if ((double)y != x && x - x == 0.0 && u << 1 < 0xff000000u) {
            bool up = fabs((double)y) > fabs(x);
            y = half_from_bits((up ? u - 1u : u) | 1u);
        }
        value = half_rounded(y);
        half_mark.outside = half_mark.outside || (x - x == 0.0 && !std::isfinite(value)) ||
                            (x != 0.0 && value == 0.0f);
    }
    explicit operator float() const
    {
        return value;
    }
    explicit operator double() const
    {
        return (double)value;
    }
    explicit operator int() const
    {
        return (int)value;
    }
    explicit operator long() const
    {
        return (long)value;
    }
    explicit operator unsigned long() const
    {
        return (unsigned long)value;
    }
    explicit operator bool() const
    {
        return value != 0.0f;
    }
    explicit operator uint32_t() const
    {
        half_mark.integers = half_mark.integers || !(value <= 2048.0f);
        return value >= 0.0f && value < 4294967296.0f ? (uint32_t)value : 0u;
    }

    hdrp_half operator-() const
    {
        hdrp_half r;
        r.value = -value;
        return r;
    }
    friend hdrp_half operator+(hdrp_half a, hdrp_half b)
    {
        return a.value + b.value;
    }
    friend hdrp_half operator-(hdrp_half a, hdrp_half b)
    {
        return a.value - b.value;
    }
    friend hdrp_half operator*(hdrp_half a, hdrp_half b)
    {
        return a.value * b.value;
    }
    friend hdrp_half operator/(hdrp_half a, hdrp_half b)
    {
        return a.value / b.value;
    }
    hdrp_half& operator+=(hdrp_half b)
    {
        return *this = *this + b;
    }
    hdrp_half& operator-=(hdrp_half b)
    {
        return *this = *this - b;
    }
    hdrp_half& operator*=(hdrp_half b)
    {
        return *this = *this * b;
    }
    hdrp_half& operator/=(hdrp_half b)
    {
        return *this = *this / b;
    }
    friend bool operator<(hdrp_half a, hdrp_half b)
    {
        return a.value < b.value;
    }
    friend bool operator>(hdrp_half a, hdrp_half b)
    {
        return a.value > b.value;
    }
    friend bool operator<=(hdrp_half a, hdrp_half b)
    {
        return a.value <= b.value;
    }
    friend bool operator>=(hdrp_half a, hdrp_half b)
    {
        return a.value >= b.value;
    }
    friend bool operator==(hdrp_half a, hdrp_half b)
    {
        return a.value == b.value;
    }
    friend bool operator!=(hdrp_half a, hdrp_half b)
    {
        return a.value != b.value;
    }

    float value; /* public, so that a vector of halves may still be copied as bytes */
};
static_assert(sizeof(hdrp_half) == sizeof(uint32_t), "bits are read as those of a float");

#define HALF_FUNCTION(name)                                                                        \
    static inline hdrp_half name(hdrp_half x)                                                      \
    {                                                                                              \
        return hdrp_half(name(x.value));                                                           \
    }
HALF_FUNCTION(sqrtf)
HALF_FUNCTION(sinf)
HALF_FUNCTION(cosf)
HALF_FUNCTION(tanf)
HALF_FUNCTION(asinf)
HALF_FUNCTION(acosf)
HALF_FUNCTION(expf)
HALF_FUNCTION(exp2f)
HALF_FUNCTION(logf)
HALF_FUNCTION(log2f)
HALF_FUNCTION(floorf)
HALF_FUNCTION(fabsf)
HALF_FUNCTION(roundf)
#undef HALF_FUNCTION
static inline hdrp_half powf(hdrp_half x, hdrp_half y)
{
    return powf(x.value, y.value);
}
static inline hdrp_half atan2f(hdrp_half y, hdrp_half x)
{
    return atan2f(y.value, x.value);
}
static inline hdrp_half fmaxf(hdrp_half x, hdrp_half y)
{
    return fmaxf(x.value, y.value);
}
static inline hdrp_half fminf(hdrp_half x, hdrp_half y)
{
    return fminf(x.value, y.value);
}
static inline hdrp_half copysignf(hdrp_half x, hdrp_half y)
{
    return copysignf(x.value, y.value);
}
static inline hdrp_half ldexpf(hdrp_half x, int e)
{
    return ldexpf(x.value, e);
}
/* The next half: in float the last place of a half is bit 13. */
static inline hdrp_half nextafterf(hdrp_half x, hdrp_half towards)
{
    if (x.value == towards.value) {
        return towards;
    }
    uint32_t u = half_bits(x.value) & 0x7fffffffu;
    double step = u < 0x38800000u ? 0x1p-24 : ldexp(1.0, (int)(u >> 23) - 127 - 10);
    bool down_in_size = (x.value > 0.0f) != (towards.value > x.value) && x.value != 0.0f;
    if (down_in_size && (u & 0x7fffffu) == 0 && u > 0x38800000u) {
        step *= 0.5;
    }
    return hdrp_half((double)x.value + (towards.value > x.value ? step : -step));
}
static inline bool half_isfinite(hdrp_half x)
{
    return std::isfinite(x.value);
}
static inline bool half_isfinite(double x)
{
    return std::isfinite(x);
}
static inline bool half_isnan(hdrp_half x)
{
    return std::isnan(x.value);
}
static inline bool half_isnan(double x)
{
    return std::isnan(x);
}

static inline double half_fmax(double x, double y)
{
    return x >= y ? x : y >= x ? y : x + y;
}

/* memcpy in the headers and the registry: a bit pattern that comes in must be that of a half. */
static inline void* half_memcpy(hdrp_half* to, const uint32_t* from, size_t size)
{
    float x = half_from_bits(*from);
    half_mark.bits = half_mark.bits || !(half_rounded(x) == x || x != x);
    to->value = half_rounded(x);
    return (void)size, to;
}
static inline void* half_memcpy(uint32_t* to, const hdrp_half* from, size_t size)
{
    half_mark.bits = half_mark.bits || !std::isfinite(from->value);
    *to = half_bits(from->value);
    return (void)size, to;
}
static inline void* half_memcpy(void* to, const void* from, size_t size)
{
    return std::memcpy(to, from, size);
}

/* What the recorded numbers depend on. */
static inline void half_print_origin(void)
{
    const char* version = __VERSION__;
#ifdef __GLIBC__
    printf("# g++ %.*s glibc %d.%d\n", (int)strcspn(version, " "), version, __GLIBC__,
           __GLIBC_MINOR__);
#else
    printf("# g++ %.*s\n", (int)strcspn(version, " "), version);
#endif
}

#endif
