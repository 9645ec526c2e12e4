/* test_oit_moments.c - what four and six power moments say of transmittance, against linear algebra.
 * SPDX-License-Identifier: MIT
 *
 * The reference solves the moment problem in double as its definition says: of all distributions
 * with the moments of what absorbs, the one that has most at the place of the fragment has it there
 * and at the roots of a polynomial, with weights that give the moments back. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "hdrp_oit.h"

#define LAYERS    12
#define POWERS    7 /* 0 to 6 */
#define UNKNOWNS  4
#define NEAREST_M 1.0f
#define RANGE     16.0f

static uint64_t random_state = 7;

static double uniform(double lo, double hi)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (double)(random_state >> 11) * 0x1p-53;
}

/* a x = b of n unknowns, by elimination with pivots; x replaces b. */
static void solve(double a[UNKNOWNS][UNKNOWNS], double* b, int n)
{
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i) {
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        }
        for (int j = 0; j < n; ++j) {
            double swap = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = swap;
        }
        double swap = b[k];
        b[k] = b[pivot];
        b[pivot] = swap;
        for (int i = k + 1; i < n; ++i) {
            double factor = a[i][k] / a[k][k];
            for (int j = k; j < n; ++j) {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for (int k = n - 1; k >= 0; --k) {
        for (int j = k + 1; j < n; ++j) {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= a[k][k];
    }
}

/* Real roots of a polynomial of degree n whose roots are all real: Durand and Kerner's iteration. */
static void find_roots(const double* c, int n, double* roots)
{
    double complex r[UNKNOWNS];
    for (int i = 0; i < n; ++i) {
        r[i] = cpow(0.4 + 0.9 * (double complex)I, i);
    }
    for (int step = 0; step < 500; ++step) {
        for (int i = 0; i < n; ++i) {
            double complex value = c[n], others = c[n];
            for (int k = n - 1; k >= 0; --k) {
                value = value * r[i] + c[k];
            }
            for (int k = 0; k < n; ++k) {
                others *= k == i ? 1.0 : r[i] - r[k];
            }
            r[i] -= value / others;
        }
    }
    for (int i = 0; i < n; ++i) {
        roots[i] = creal(r[i]);
    }
}

/* Shares before x and, at most, at x, by the moments b of degree 0 to 2 n. */
static void share_before(const double* b, int n, double x, double* before, double* most)
{
    double matrix[UNKNOWNS][UNKNOWNS], kernel[UNKNOWNS], at[UNKNOWNS], weights[UNKNOWNS];
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            matrix[i][j] = b[i + j];
        }
        kernel[i] = pow(x, i);
    }
    solve(matrix, kernel, n + 1);
    at[0] = x;
    find_roots(kernel, n, at + 1);
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            matrix[i][j] = pow(at[j], i);
        }
        weights[i] = b[i];
    }
    solve(matrix, weights, n + 1);
    *most = weights[0];
    *before = 0.0;
    for (int i = 1; i <= n; ++i) {
        *before += at[i] < x ? weights[i] : 0.0;
    }
}

/* Through all that is before, and two layers that are so half of the time each: what is at the place
 * at most, without what the fragment itself absorbs. */
static double seen_through(double before, double at, double own)
{
    double layer = 0.5 * (1.0 + exp(-0.5 * fmax(at - 1.2 * own, 0.0)));
    return exp(-before) * layer * layer;
}

typedef struct pixel {
    hdrp_oit_fragment f[LAYERS];
    hdrp_oit_place place[LAYERS];
    hdrp_oit_moments sums;
    double power[POWERS]; /* of what absorbs behind the nearest, and its sum */
    double front;         /* what the nearest absorbs */
} pixel;

static void add(hdrp_v4* to, hdrp_v4 v)
{
    *to = hdrp_v4_make(to->x + v.x, to->y + v.y, to->z + v.z, to->w + v.w);
}

/* One layer at the nearest depth and others spread over the range, so that moments tell them. */
static pixel random_pixel(void)
{
    pixel p;
    memset(&p, 0, sizeof p);
    for (int i = 0; i < LAYERS; ++i) {
        double at = i == 0 ? 0.0 : ((double)i + uniform(-0.4, 0.4)) / (LAYERS - 0.5);
        float alpha = (float)uniform(0.05, 0.25), z = NEAREST_M * powf(RANGE, (float)at);
        hdrp_v3 black = hdrp_v3_splat(0.0f);
        p.f[i] = hdrp_oit_fragment_make(black, black, alpha, z);
        p.place[i] = hdrp_oit_place_of(p.f[i], hdrp_v2_make(-NEAREST_M, NEAREST_M * RANGE));
        hdrp_oit_moments own = hdrp_oit_moments_insert(p.f[i], p.place[i]);
        add(&p.sums.power, own.power);
        add(&p.sums.high, own.high);
        double absorbed = -log1p(-(double)alpha), x = 2.0 * log2((double)z) / 4.0 - 1.0;
        for (int k = 0; k < POWERS && i > 0; ++k) {
            p.power[k] += absorbed * pow(x, k);
        }
        p.front += i == 0 ? absorbed : 0.0;
    }
    return p;
}

/* Moments are moved a little towards these, as Muenstermann et al. do it: then
 * noise in their last bits cannot make them those of no distribution. */
static const double even[2][POWERS] = {{1, 0, 0.375, 0, 0.375, 0, 0},
                                       {1, 0, 0.48, 0, 0.451, 0, 0.45}};
static const double bias[2] = {1.2e-4, 6e-4};

/* Largest and mean error of the transmittance of all fragments but the nearest. */
static void measure(int count, int pixels, double* largest, double* mean)
{
    *largest = 0;
    *mean = 0;
    for (int i = 0; i < pixels; ++i) {
        pixel p = random_pixel();
        double b[POWERS];
        for (int k = 0; k < POWERS; ++k) {
            b[k] = p.power[k] / p.power[0];
            b[k] += (even[count == 6][k] - b[k]) * bias[count == 6];
        }
        for (int k = 1; k < LAYERS; ++k) {
            double own = -log1p(-(double)p.f[k].alpha), all = p.power[0], before, most;
            double x = 2.0 * log2((double)p.f[k].z_view) / 4.0 - 1.0;
            share_before(b, count / 2, x, &before, &most);
            double through = exp(-p.front) * seen_through(all * before, all * most, own);
            float got = hdrp_oit_moments_transmittance(p.sums, p.f[k], p.place[k], (hdrp_u32)count);
            double error = fabs((double)got - through);
            *largest = error <= *largest ? *largest : error;
            *mean += error / (pixels * (LAYERS - 1));
        }
    }
}

static void four_moments_solve_the_moment_problem(void** state)
{
    double largest, mean;
    (void)state;
    measure(4, 400, &largest, &mean);
    assert_true(largest <= 4e-6 && mean <= 1.5e-7);
}

static void six_moments_solve_the_moment_problem(void** state)
{
    double largest, mean;
    (void)state;
    /* So many that some fragments are where one root of the polynomial is far off. */
    measure(6, 2000, &largest, &mean);
    assert_true(largest <= 4e-5 && mean <= 2e-7);
}

/* One root is so far off that the other, near the last layer, would be a difference of two numbers
 * much larger than it. */
static void a_root_that_is_far_off_leaves_the_other_its_digits(void** state)
{
    static const float at[3] = {-0.656827569f, -0.00118151773f, -0.453386635f};
    static const float alpha[3] = {0.838678434f, 0.72331702f, 0.120856501f};
    double power[POWERS] = {0}, b[POWERS], before, most;
    hdrp_oit_fragment f[3];
    hdrp_oit_place place[3];
    hdrp_oit_moments sums;
    (void)state;
    memset(&sums, 0, sizeof sums);
    memset(place, 0, sizeof place);
    for (int i = 0; i < 3; ++i) {
        f[i] = hdrp_oit_fragment_make(hdrp_v3_splat(0.0f), hdrp_v3_splat(0.0f), alpha[i], 1.0f);
        place[i].unit = 0.5f + 0.5f * at[i];
        place[i].behind = 1.0f;
        hdrp_oit_moments own = hdrp_oit_moments_insert(f[i], place[i]);
        add(&sums.power, own.power);
        add(&sums.high, own.high);
        for (int k = 0; k < POWERS; ++k) {
            power[k] -= log1p(-(double)alpha[i]) * pow((double)at[i], k);
        }
    }
    for (int k = 0; k < POWERS; ++k) {
        b[k] = power[k] / power[0];
        b[k] += (even[0][k] - b[k]) * bias[0];
    }
    share_before(b, 2, (double)at[2], &before, &most);
    double through = seen_through(power[0] * before, power[0] * most, -log1p(-(double)alpha[2]));
    float got = hdrp_oit_moments_transmittance(sums, f[2], place[2], 4u);
    assert_true(fabs((double)got - through) <= 1e-3);
}

static void the_nearest_is_seen_whole(void** state)
{
    (void)state;
    pixel p = random_pixel();
    assert_true(hdrp_oit_moments_transmittance(p.sums, p.f[0], p.place[0], 4u) == 1.0f);
    assert_true(hdrp_oit_moments_transmittance(p.sums, p.f[0], p.place[0], 6u) == 1.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_moments_solve_the_moment_problem),
        cmocka_unit_test(six_moments_solve_the_moment_problem),
        cmocka_unit_test(a_root_that_is_far_off_leaves_the_other_its_digits),
        cmocka_unit_test(the_nearest_is_seen_whole),
    };
    return cmocka_run_group_tests_name("oit moments", tests, NULL, NULL);
}
