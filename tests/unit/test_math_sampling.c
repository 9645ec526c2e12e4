/* test_math_sampling.c - point sets, hashes and mappings of hdrp_math.h.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "hdrp_math.h"

#define PI 3.14159265358979323846

/* >>integers */

static void reversed_bits_are_the_mirror_image(void** state)
{
    (void)state;
    assert_int_equal(hdrp_reverse_bits(1u), 0x80000000u);
    assert_int_equal(hdrp_reverse_bits(0x12345678u), 0x1e6a2c48u);
    for (uint32_t i = 0; i < 32; ++i) {
        assert_int_equal(hdrp_reverse_bits(1u << i), 0x80000000u >> i);
    }
}

static void the_unit_interval_excludes_one(void** state)
{
    (void)state;
    assert_true(hdrp_unit_from_u32(0xffffffffu) == 1.0f - 0x1p-24f);
    assert_true(hdrp_unit_from_u32(0u) == 0.0f && hdrp_unit_from_u32(0x80000000u) == 0.5f);
    assert_true(hdrp_unit_from_u32(255u) == 0.0f && hdrp_unit_from_u32(256u) == 0x1p-24f);
}

static uint32_t first_of_two(uint32_t u)
{
    return hdrp_hash2(u, 5u);
}

static uint32_t second_of_two(uint32_t u)
{
    return hdrp_hash2(5u, u);
}

static uint32_t last_of_three(uint32_t u)
{
    return hdrp_hash3(5u, 6u, u);
}

/* Computed from the definition in another language. */
static void hashes_are_the_same_everywhere(void** state)
{
    (void)state;
    assert_int_equal(hdrp_hash1(0u), 0xc4631032u);
    assert_int_equal(hdrp_hash2(1u, 2u), 0xceadc62u);
    assert_int_equal(hdrp_hash3(1u, 2u, 3u), 0x32c55f92u);
}

/* How far from one half the probability is that flipping bit i of the input flips bit j. */
static double avalanche_bias(uint32_t (*hash)(uint32_t u))
{
    enum { COUNT = 1 << 18 };
    uint32_t flips[32][32] = {{0}};
    uint64_t random = 1u;
    double worst = 0.0;
    for (int n = 0; n < COUNT; ++n) {
        random = random * 6364136223846793005u + 1442695040888963407u; /* Knuth's, in 64 bits */
        uint32_t x = (uint32_t)(random >> 32), h = hash(x);
        for (int i = 0; i < 32; ++i) {
            uint32_t d = h ^ hash(x ^ (1u << i));
            for (int j = 0; j < 32; ++j) {
                flips[i][j] += d >> j & 1u;
            }
        }
    }
    for (int i = 0; i < 32; ++i) {
        for (int j = 0; j < 32; ++j) {
            worst = fmax(worst, fabs(flips[i][j] / (double)COUNT - 0.5));
        }
    }
    return worst;
}

static void each_bit_of_a_hash_depends_on_every_bit_of_its_input(void** state)
{
    (void)state;
    /* 1024 fair coins thrown 2^18 times each: the worst is expected at 3.2e-3 */
    assert_true(avalanche_bias(hdrp_hash1) < 0.0045);
    assert_true(avalanche_bias(first_of_two) < 0.0045);
    assert_true(avalanche_bias(second_of_two) < 0.0045);
    assert_true(avalanche_bias(last_of_three) < 0.0045);
}

static int compare_u32(const void* a, const void* b)
{
    uint32_t x = *(const uint32_t*)a, y = *(const uint32_t*)b;
    return x < y ? -1 : x > y;
}

static uint32_t repeated(uint32_t* values, size_t count)
{
    uint32_t found = 0;
    qsort(values, count, sizeof *values, compare_u32);
    for (size_t i = 1; i < count; ++i) {
        found += values[i] == values[i - 1];
    }
    return found;
}

static void hashes_collide_as_rarely_as_random_numbers(void** state)
{
    (void)state;
    enum { SIDE = 512, COUNT = SIDE * SIDE };
    static uint32_t values[COUNT];
    for (uint32_t i = 0; i < COUNT; ++i) {
        values[i] = hdrp_hash1(i);
    }
    assert_int_equal(repeated(values, COUNT), 0); /* a bijection */
    for (uint32_t i = 0; i < SIDE; ++i) {
        values[i] = hdrp_hash2(i, 77u);
        values[SIDE + i] = hdrp_hash2(77u, i + (i >= 77u));
    }
    assert_int_equal(repeated(values, SIDE), 0);
    for (uint32_t i = 0; i < COUNT; ++i) {
        values[i] = hdrp_hash2(i % SIDE, i / SIDE);
    }
    assert_true(repeated(values, COUNT) < 30); /* 8 expected among 2^18 of 2^32 */
    for (uint32_t i = 0; i < COUNT; ++i) {
        values[i] = hdrp_hash3(i % 64, i / 64 % 64, i / 4096);
    }
    assert_true(repeated(values, COUNT) < 30);
}

/* Sum of (observed - expected)^2 / expected, minus its mean, in its standard deviations. */
static double chi_squared_score(const uint32_t* observed, int bins, double expected)
{
    double sum = 0.0;
    for (int i = 0; i < bins; ++i) {
        sum += ((double)observed[i] - expected) * ((double)observed[i] - expected) / expected;
    }
    return (sum - (bins - 1)) / sqrt(2.0 * (bins - 1));
}

static void hashes_of_neighbours_fill_the_interval_evenly(void** state)
{
    (void)state;
    enum { COUNT = 1 << 18, BINS = 1024 };
    uint32_t one[BINS] = {0}, two[BINS] = {0}, three[BINS] = {0}, pairs[BINS] = {0};
    float before = 0.0f;
    for (uint32_t i = 0; i < COUNT; ++i) {
        float u = hdrp_unit_from_u32(hdrp_hash1(i));
        one[(int)(u * BINS)]++;
        two[(int)(hdrp_unit_from_u32(hdrp_hash2(i % 512, i / 512)) * BINS)]++;
        three[(int)(hdrp_unit_from_u32(hdrp_hash3(i % 64, i / 64 % 64, i / 4096)) * BINS)]++;
        pairs[(int)(u * 32) * 32 + (int)(before * 32)]++;
        before = u;
    }
    double expected = (double)COUNT / BINS;
    assert_true(fabs(chi_squared_score(one, BINS, expected)) < 4.5);
    assert_true(fabs(chi_squared_score(two, BINS, expected)) < 4.5);
    assert_true(fabs(chi_squared_score(three, BINS, expected)) < 4.5);
    assert_true(fabs(chi_squared_score(pairs, BINS, expected)) < 4.5);
}

/* >>points */

static void hammersley_has_its_published_values(void** state)
{
    (void)state;
    static const float expected[4][2] = {
        {0.0f, 0.0f}, {0.25f, 0.5f}, {0.5f, 0.25f}, {0.75f, 0.75f}};
    for (uint32_t i = 0; i < 4; ++i) {
        hdrp_v2 p = hdrp_hammersley(i, 4u);
        assert_true(p.x == expected[i][0] && p.y == expected[i][1]);
    }
    assert_true(hdrp_hammersley(5u, 8u).y == 0.625f);
    for (uint32_t n = 0; n < 2; ++n) {
        hdrp_v2 p = hdrp_hammersley(0xffffffffu, n);
        assert_true(p.x < 1.0f && p.y < 1.0f);
    }
    assert_true(hdrp_hammersley(0xfffffffeu, 0xffffffffu).x < 1.0f);
}

/* Of 2^k points, every box of area 2^-k with sides that are powers of two holds exactly one. */
static void hammersley_fills_every_elementary_box_once(void** state)
{
    (void)state;
    enum { LOG = 10, COUNT = 1 << LOG };
    for (int split = 0; split <= LOG; ++split) {
        uint32_t hits[COUNT] = {0};
        for (uint32_t i = 0; i < COUNT; ++i) {
            hdrp_v2 p = hdrp_hammersley(i, COUNT);
            int columns = 1 << split, rows = COUNT >> split;
            hits[(int)(p.y * (float)rows) * columns + (int)(p.x * (float)columns)]++;
        }
        for (int i = 0; i < COUNT; ++i) {
            assert_int_equal(hits[i], 1);
        }
    }
}

/* Largest difference between the share of points and the area of a box at the origin, over the
 * boxes whose corner takes coordinates of points. */
static double star_discrepancy(const hdrp_v2* p, int count)
{
    double worst = 0.0;
    for (int i = 0; i <= count; ++i) {
        for (int k = 0; k <= count; ++k) {
            float x = i < count ? p[i].x : 1.0f, y = k < count ? p[k].y : 1.0f;
            int open = 0, closed = 0;
            for (int j = 0; j < count; ++j) {
                open += p[j].x < x && p[j].y < y;
                closed += p[j].x <= x && p[j].y <= y;
            }
            double area = (double)x * (double)y;
            worst = fmax(worst, fmax(area - open / (double)count, closed / (double)count - area));
        }
    }
    return worst;
}

static void point_sets_have_a_low_discrepancy(void** state)
{
    (void)state;
    enum { COUNT = 256 };
    hdrp_v2 hammersley[COUNT], r2[COUNT], late[COUNT], random[COUNT];
    for (uint32_t i = 0; i < COUNT; ++i) {
        hammersley[i] = hdrp_hammersley(i, COUNT);
        r2[i] = hdrp_r2(i);
        late[i] = hdrp_r2(4000000000u + i);
        random[i] = hdrp_v2_make(hdrp_unit_from_u32(hdrp_hash1(i)),
                                 hdrp_unit_from_u32(hdrp_hash1(i + COUNT)));
    }
    /* Halton and Zaremba 1969 for 2^k points: (k/3 + 13/9 - (-1)^k 4 / (9 2^k)) / 2^k */
    double known = (8.0 / 3.0 + 13.0 / 9.0 - 4.0 / (9.0 * COUNT)) / COUNT;
    assert_true(fabs(star_discrepancy(hammersley, COUNT) - known) < 1e-7);
    assert_true(star_discrepancy(r2, COUNT) < 0.025);
    assert_true(star_discrepancy(late, COUNT) < 0.025);
    assert_true(star_discrepancy(random, COUNT) > 0.05);
}

static void r2_steps_by_the_plastic_number_at_any_index(void** state)
{
    (void)state;
    hdrp_v2 first = hdrp_r2(0u);
    assert_true(first.x == 0.5f && first.y == 0.5f);
    for (uint32_t i = 0; i < 1000; ++i) {
        uint32_t index = hdrp_hash1(i);
        hdrp_v2 a = hdrp_r2(index), b = hdrp_r2(index + 1u);
        double dx = (double)b.x - (double)a.x - 0.754877666, dy = (double)b.y - (double)a.y;
        dy -= 0.569840291;
        if (index != 0xffffffffu) {
            assert_true(fabs(dx - floor(dx + 0.5)) < 2e-7);
            assert_true(fabs(dy - floor(dy + 0.5)) < 2e-7);
        }
    }
}

static double nearest(const hdrp_v3* p, int count)
{
    double least = 1e9;
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < i; ++k) {
            least = fmin(least, (double)hdrp_v3_length(hdrp_v3_sub(p[i], p[k])));
        }
    }
    return least;
}

static void fibonacci_points_keep_their_distance(void** state)
{
    (void)state;
    enum { COUNT = 1000 };
    hdrp_v3 disk[COUNT], sphere[COUNT];
    for (uint32_t i = 0; i < COUNT; ++i) {
        hdrp_v2 p = hdrp_fibonacci_disk(i, COUNT);
        disk[i] = hdrp_v3_make(p.x, p.y, 0.0f);
        sphere[i] = hdrp_fibonacci_sphere(i, COUNT);
    }
    /* in units of the side of a square that each point could have */
    assert_true(nearest(disk, COUNT) > 0.75 * sqrt(PI / COUNT));
    assert_true(nearest(sphere, COUNT) > 0.75 * sqrt(4.0 * PI / COUNT));
}

static void fibonacci_points_have_the_moments_of_disk_and_sphere(void** state)
{
    (void)state;
    enum { COUNT = 4096 };
    double m1[3] = {0.0, 0.0, 0.0}, m2[3] = {0.0, 0.0, 0.0}, d2 = 0.0, dx = 0.0;
    for (uint32_t i = 0; i < COUNT; ++i) {
        hdrp_v3 p = hdrp_fibonacci_sphere(i, COUNT);
        hdrp_v2 q = hdrp_fibonacci_disk(i, COUNT);
        double v[3] = {(double)p.x, (double)p.y, (double)p.z};
        for (int k = 0; k < 3; ++k) {
            m1[k] += v[k] / COUNT;
            m2[k] += v[k] * v[k] / COUNT;
        }
        assert_true(fabs((double)hdrp_v3_length(p) - 1.0) < 1e-6);
        d2 += (double)hdrp_v2_dot(q, q) / COUNT;
        dx += (double)(q.x + q.y) / COUNT;
    }
    for (int k = 0; k < 3; ++k) {
        assert_true(fabs(m1[k]) < 1e-3 && fabs(m2[k] - 1.0 / 3.0) < 1e-3);
    }
    assert_true(fabs(d2 - 0.5) < 1e-6 && fabs(dx) < 2e-3);
    assert_true(hdrp_fibonacci_sphere(7u, 0u).z == -1.0f);
}

/* Point i stands for ring i of n equal ones, and for zone i of n: it lies in the middle. */
static void fibonacci_points_lie_in_the_middle_of_their_rings(void** state)
{
    (void)state;
    for (uint32_t n = 1u; n <= 3u; ++n) {
        for (uint32_t i = 0u; i < n; ++i) {
            hdrp_v2 p = hdrp_fibonacci_disk(i, n);
            double middle = (i + 0.5) / n;
            assert_true(fabs((double)hdrp_v2_dot(p, p) - middle) < 1e-6);
            assert_true(fabs((double)hdrp_fibonacci_sphere(i, n).z - (1.0 - 2.0 * middle)) < 1e-6);
        }
    }
}

static void large_indices_keep_the_golden_angle(void** state)
{
    (void)state;
    double golden = 2.0 * PI * 0.6180339887498949;
    for (uint32_t i = 0xfffffff0u; i < 0xfffffffeu; ++i) {
        hdrp_v2 a = hdrp_fibonacci_disk(i, 0xffffffffu),
                b = hdrp_fibonacci_disk(i + 1u, 0xffffffffu);
        double turn = atan2((double)b.y, (double)b.x) - atan2((double)a.y, (double)a.x) - golden;
        turn /= 2.0 * PI;
        assert_true(fabs(turn - floor(turn + 0.5)) < 2e-7);
    }
}

/* >>mappings */

static void the_concentric_map_keeps_its_landmarks(void** state)
{
    (void)state;
    hdrp_v2 p = hdrp_disk_concentric(hdrp_v2_make(0.5f, 0.5f));
    assert_true(p.x == 0.0f && p.y == 0.0f);
    p = hdrp_disk_concentric(hdrp_v2_make(1.0f, 0.5f));
    assert_true(p.x == 1.0f && p.y == 0.0f);
    p = hdrp_disk_concentric(hdrp_v2_make(0.5f, 0.0f));
    assert_true(p.x == 0.0f && p.y == -1.0f);
    p = hdrp_disk_concentric(hdrp_v2_make(0.0f, 1.0f));
    assert_true(fabsf(p.x + HDRP_SQRT_HALF) < 1e-6f && fabsf(p.y - HDRP_SQRT_HALF) < 1e-6f);
    /* neighbours stay neighbours, across the seams of the four wedges too */
    for (int i = 0; i < 256; ++i) {
        for (int k = 0; k < 256; ++k) {
            hdrp_v2 u = hdrp_v2_make((float)i / 256.0f, (float)k / 256.0f);
            hdrp_v2 a = hdrp_disk_concentric(u);
            hdrp_v2 b = hdrp_disk_concentric(hdrp_v2_add(u, hdrp_v2_make(1.0f / 256.0f, 0.0f)));
            hdrp_v2 d = hdrp_v2_sub(b, a);
            assert_true(hdrp_v2_dot(d, d) < 0.013f * 0.013f);
        }
    }
}

typedef hdrp_v3 direction_map(hdrp_v2 u);

static hdrp_v3 concentric(hdrp_v2 u)
{
    hdrp_v2 p = hdrp_disk_concentric(u);
    return hdrp_v3_make(p.x, p.y, 0.0f);
}

static hdrp_v3 polar(hdrp_v2 u)
{
    hdrp_v2 p = hdrp_disk_polar(u);
    return hdrp_v3_make(p.x, p.y, 0.0f);
}

typedef struct mapping {
    direction_map* map;
    double xx, z, zz; /* mean of x^2, z and z^2, by integration */
} mapping;

static const mapping mappings[] = {
    {concentric, 1.0 / 4.0, 0.0, 0.0},
    {polar, 1.0 / 4.0, 0.0, 0.0},
    {hdrp_hemisphere_cosine, 1.0 / 4.0, 2.0 / 3.0, 1.0 / 2.0},
    {hdrp_hemisphere_uniform, 1.0 / 3.0, 1.0 / 2.0, 1.0 / 3.0},
    {hdrp_sphere_uniform, 1.0 / 3.0, 0.0, 1.0 / 3.0},
};

static void mappings_have_the_moments_of_their_density(void** state)
{
    (void)state;
    enum { COUNT = 1 << 14 };
    for (int m = 0; m < 5; ++m) {
        double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0, z = 0.0, zz = 0.0;
        for (uint32_t i = 0; i < COUNT; ++i) {
            hdrp_v3 p = mappings[m].map(hdrp_hammersley(i, COUNT));
            x += (double)p.x / COUNT;
            y += (double)p.y / COUNT;
            xx += (double)(p.x * p.x) / COUNT;
            yy += (double)(p.y * p.y) / COUNT;
            xy += (double)(p.x * p.y) / COUNT;
            z += (double)p.z / COUNT;
            zz += (double)(p.z * p.z) / COUNT;
            if (m > 1) {
                assert_true(fabs((double)hdrp_v3_length(p) - 1.0) < 1e-6);
                assert_true(p.z >= 0.0f || m == 4);
            } else {
                assert_true(p.x * p.x + p.y * p.y < 1.000001f);
            }
        }
        assert_true(fabs(x) < 1e-3 && fabs(y) < 1e-3 && fabs(xy) < 1e-3);
        assert_true(fabs(xx - mappings[m].xx) < 1e-3 && fabs(yy - mappings[m].xx) < 1e-3);
        assert_true(fabs(z - mappings[m].z) < 1e-3 && fabs(zz - mappings[m].zz) < 1e-3);
    }
}

/* Equal-area cells: 16 sectors and 16 rings, whose borders follow from the cumulative density of
 * the distance to the axis. */
static int ring_of(int m, hdrp_v3 p)
{
    double rr = (double)p.x * (double)p.x + (double)p.y * (double)p.y, share = rr;
    if (m == 3) {
        share = 1.0 - (double)p.z;
    } else if (m == 4) {
        share = 0.5 - 0.5 * (double)p.z;
    }
    return (int)fmin(15.0, share * 16.0);
}

static void mappings_fill_equal_areas_equally(void** state)
{
    (void)state;
    enum { COUNT = 1 << 16 };
    for (int m = 0; m < 5; ++m) {
        uint32_t hits[256] = {0};
        for (uint32_t i = 0; i < COUNT; ++i) {
            hdrp_v2 u = hdrp_v2_make(hdrp_unit_from_u32(hdrp_hash2(i, 1u)),
                                     hdrp_unit_from_u32(hdrp_hash2(i, 2u)));
            hdrp_v3 p = mappings[m].map(u);
            double turn = atan2((double)p.y, (double)p.x) / (2.0 * PI) + 0.5;
            hits[ring_of(m, p) * 16 + (int)fmin(15.0, turn * 16.0)]++;
        }
        assert_true(fabs(chi_squared_score(hits, 256, COUNT / 256.0)) < 4.5);
    }
}

static void mappings_hold_the_border_of_the_square(void** state)
{
    (void)state;
    float outside[] = {-1.0f, 2.0f, NAN, INFINITY, -INFINITY};
    for (int m = 0; m < 5; ++m) {
        for (int i = 0; i < 5; ++i) {
            hdrp_v3 a = mappings[m].map(hdrp_v2_make(outside[i], 0.25f));
            hdrp_v3 b = mappings[m].map(hdrp_v2_make(hdrp_saturate(outside[i]), 0.25f));
            assert_true(a.x == b.x && a.y == b.y && a.z == b.z);
        }
        for (int i = 0; i < 4; ++i) {
            hdrp_v3 p = mappings[m].map(hdrp_v2_make((float)(i & 1), (float)(i / 2)));
            assert_true(isfinite(p.x) && isfinite(p.y) && isfinite(p.z));
        }
    }
}

static void densities_integrate_to_one(void** state)
{
    (void)state;
    double sum = 0.0;
    enum { COUNT = 4096 };
    for (int i = 0; i < COUNT; ++i) {
        float z = ((float)i + 0.5f) / COUNT;
        sum += 2.0 * PI * (double)hdrp_hemisphere_cosine_pdf(z) / COUNT;
    }
    assert_true(fabs(sum - 1.0) < 1e-6);
    assert_true(fabs((double)HDRP_INV_TWO_PI * 2.0 * PI - 1.0) < 1e-7);
    assert_true(fabs((double)HDRP_INV_FOUR_PI * 4.0 * PI - 1.0) < 1e-7);
    assert_true(hdrp_hemisphere_cosine_pdf(-0.5f) == 0.0f);
    assert_true(hdrp_hemisphere_cosine_pdf(NAN) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reversed_bits_are_the_mirror_image),
        cmocka_unit_test(the_unit_interval_excludes_one),
        cmocka_unit_test(hashes_are_the_same_everywhere),
        cmocka_unit_test(each_bit_of_a_hash_depends_on_every_bit_of_its_input),
        cmocka_unit_test(hashes_collide_as_rarely_as_random_numbers),
        cmocka_unit_test(hashes_of_neighbours_fill_the_interval_evenly),
        cmocka_unit_test(hammersley_has_its_published_values),
        cmocka_unit_test(hammersley_fills_every_elementary_box_once),
        cmocka_unit_test(point_sets_have_a_low_discrepancy),
        cmocka_unit_test(r2_steps_by_the_plastic_number_at_any_index),
        cmocka_unit_test(fibonacci_points_keep_their_distance),
        cmocka_unit_test(fibonacci_points_have_the_moments_of_disk_and_sphere),
        cmocka_unit_test(fibonacci_points_lie_in_the_middle_of_their_rings),
        cmocka_unit_test(large_indices_keep_the_golden_angle),
        cmocka_unit_test(the_concentric_map_keeps_its_landmarks),
        cmocka_unit_test(mappings_have_the_moments_of_their_density),
        cmocka_unit_test(mappings_fill_equal_areas_equally),
        cmocka_unit_test(mappings_hold_the_border_of_the_square),
        cmocka_unit_test(densities_integrate_to_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
