/* test_half.cpp - the class that stands for half precision rounds like IEEE 754 says.
 * SPDX-License-Identifier: MIT
 *
 * Against exact arithmetic in double: the nearest of all 63488 finite halves, ties to even. */
#include "half.hpp"

static double halves[0x7c01]; /* not negative, in order; the last one stands for infinity */
static int failures;

static void expect(bool good, const char* what, double x)
{
    if (!good && failures++ < 20) {
        printf("FAIL %s at %a\n", what, x);
    }
}

static double nearest(double x)
{
    double magnitude = fabs(x);
    int lo = 0, hi = 0x7c00;
    while (hi - lo > 1) {
        int middle = (lo + hi) / 2;
        (magnitude >= halves[middle] ? lo : hi) = middle;
    }
    double below = magnitude - halves[lo], above = halves[hi] - magnitude;
    int best = magnitude >= halves[0x7c00] ? 0x7c00
               : below != above            ? (below < above ? lo : hi)
               : lo % 2 == 0               ? lo
                                           : hi;
    return copysign(best == 0x7c00 ? HUGE_VAL : halves[best], x);
}

static uint32_t random_bits(uint64_t* state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u; /* Knuth's, in 64 bits */
    return (uint32_t)(*state >> 32);
}

int main(void)
{
    uint64_t state = 1;
    for (int i = 0; i < 0x7c00; ++i) {
        int exponent = i >> 10, mantissa = i & 0x3ff;
        halves[i] = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    }
    halves[0x7c00] = 65536.0;
    for (int i = 0; i < 0x7bff; ++i) {
        double middle = 0.5 * (halves[i] + halves[i + 1]);
        const double places[] = {halves[i], middle, nextafter(middle, 0.0), nextafter(middle, 1e9)};
        for (double x : places) {
            expect((double)hdrp_half(x) == nearest(x), "conversion from double", x);
            float f = (float)x;
            expect((double)hdrp_half(f) == nearest((double)f), "conversion from float", x);
        }
        expect((double)nextafterf(hdrp_half(halves[i]), hdrp_half(1e9)) == halves[i + 1], "next",
               halves[i]);
        expect((double)nextafterf(hdrp_half(halves[i + 1]), hdrp_half(0.0)) == halves[i],
               "previous", halves[i + 1]);
    }
    for (int i = 0; i < 3000000; ++i) {
        uint32_t u = random_bits(&state);
        float f = half_from_bits(u);
        if (f == f) {
            expect((double)hdrp_half(f) == nearest((double)f), "conversion from float", (double)f);
        }
        double a = halves[(u & 0xffff) % 0x7c00], b = halves[(u >> 16) % 0x7c00];
        hdrp_half x(a), y(u & 0x80 ? -b : b);
        b = (double)y;
        expect((double)(x + y) == nearest(a + b), "sum", a);
        expect((double)(x - y) == nearest(a - b), "difference", a);
        expect((double)(x * y) == nearest(a * b), "product", a);
        expect(b == 0.0 || (double)(x / y) == nearest(a / b), "quotient", a);
        expect((double)sqrtf(x) == nearest(sqrt(a)), "square root", a);
    }
    printf("%d failed\n", failures);
    return failures != 0;
}
