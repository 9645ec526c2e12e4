/* test_oit.c - fragments, weights, sums and images of hdrp_oit.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define HDRP_OIT_IMPLEMENTATION
#include "hdrp_oit.h"

static uint64_t random_state = 1;

static float uniform(float lo, float hi)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (float)(random_state >> 40) * 0x1p-24f;
}

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

static hdrp_oit_fragment fragment(hdrp_v3 color, hdrp_v3 emission, float alpha, float z)
{
    return hdrp_oit_fragment_make(hdrp_v3_scale(color, alpha), emission, alpha, z);
}

static hdrp_oit_fragment random_fragment(void)
{
    hdrp_v3 color = v3(uniform(0, 1), uniform(0, 1), uniform(0, 1));
    hdrp_v3 emission = v3(uniform(0, 0.2f), uniform(0, 0.2f), uniform(0, 0.2f));
    return fragment(color, emission, uniform(0.05f, 0.95f), expf(uniform(0.0f, 5.0f)));
}

typedef struct picture {
    hdrp_oit_image image;
    void* memory;
} picture;

static picture make_picture(uint32_t width, uint32_t height, hdrp_oit_mode mode,
                            hdrp_oit_precision precision)
{
    picture p;
    hdrp_oit_desc desc;
    size_t bytes;
    memset(&desc, 0, sizeof desc);
    desc.width_px = width;
    desc.height_px = height;
    desc.mode = mode;
    desc.precision = precision;
    bytes = hdrp_oit_memory_size(&desc);
    assert_true(bytes > 0 && bytes % HDRP_MEMORY_ALIGNMENT == 0);
    p.memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_non_null(p.memory);
    assert_int_equal(hdrp_oit_image_init(&p.image, &desc, p.memory, bytes), HDRP_OK);
    return p;
}

static void blend(picture* p, const hdrp_oit_fragment* f, const uint32_t* pixels, size_t count)
{
    for (uint32_t pass = 0; pass < hdrp_oit_pass_count(p->image.desc.mode); ++pass) {
        hdrp_oit_blend_rows(&p->image, pass, f, pixels, count, 0, p->image.desc.height_px);
    }
}

/* The colour of one pixel of all these fragments. */
static hdrp_v3 color_of(const hdrp_oit_fragment* f, size_t count, hdrp_v3 behind,
                        hdrp_oit_mode mode, hdrp_oit_precision precision)
{
    static const uint32_t pixels[64];
    picture p = make_picture(1, 1, mode, precision);
    hdrp_v3 color;
    blend(&p, f, pixels, count);
    hdrp_oit_composite_rows(&p.image, &behind, &color, 0, 1);
    free(p.memory);
    return color;
}

static void assert_color(hdrp_v3 got, hdrp_v3 wanted, double tolerance)
{
    assert_true(fabs((double)got.x - (double)wanted.x) <= tolerance);
    assert_true(fabs((double)got.y - (double)wanted.y) <= tolerance);
    assert_true(fabs((double)got.z - (double)wanted.z) <= tolerance);
}

static hdrp_v3 over(hdrp_oit_fragment f, hdrp_v3 behind)
{
    return hdrp_v3_mad(hdrp_v3_add(f.premultiplied, f.emission), behind, 1.0f - f.alpha);
}

/* ---- fragments and weights ------------------------------------------------------------------- */

static void fragments_are_finite_whatever_they_are_made_of(void** state)
{
    const float odd[6] = {NAN, INFINITY, -INFINITY, -1.0f, 1e30f, 0.0f};
    (void)state;
    for (int i = 0; i < 6; ++i) {
        hdrp_oit_fragment f = hdrp_oit_fragment_make(hdrp_v3_splat(odd[i]), hdrp_v3_splat(odd[i]),
                                                     odd[(i + 1) % 6], odd[(i + 2) % 6]);
        assert_true(f.alpha >= 0.0f && f.alpha <= 1.0f);
        assert_true(f.z_view >= HDRP_OIT_DEPTH_MIN && f.z_view <= HDRP_OIT_DEPTH_MAX);
        assert_true(f.premultiplied.x >= 0.0f && f.premultiplied.x <= HDRP_OIT_LIGHT_MAX);
        assert_true(f.emission.x >= 0.0f && f.emission.x <= HDRP_OIT_LIGHT_MAX);
    }
    /* A colour that covers nothing is added. */
    hdrp_oit_fragment f = hdrp_oit_fragment_make(v3(1, 2, 3), v3(1, 1, 1), 0.0f, 1.0f);
    assert_color(f.emission, v3(2, 3, 4), 0.0);
    assert_color(f.premultiplied, v3(0, 0, 0), 0.0);
}

static void weights_are_finite_at_every_extreme(void** state)
{
    const float depths[8] = {0.0f, 1e-38f, 1e-6f, 1.0f, 1e6f, 1e38f, INFINITY, NAN};
    const float alphas[6] = {0.0f, 1e-38f, 0.5f, 1.0f, 2.0f, NAN};
    const float exposures[5] = {0.0f, 1e-20f, 1.0f, 1e20f, NAN};
    (void)state;
    for (int i = 0; i < 48; ++i) {
        float z = depths[i / 6], a = alphas[i % 6];
        const float w[6] = {hdrp_oit_weight_eq7(z, a),  hdrp_oit_weight_eq8(z, a),
                            hdrp_oit_weight_eq9(z, a),  hdrp_oit_weight_eq10(z, a),
                            hdrp_oit_weight_2015(z, a), hdrp_oit_weight(z, a)};
        for (int k = 0; k < 6; ++k) {
            assert_true(w[k] >= 0.0f && w[k] <= 3000.0f);
            assert_true(k == 5 || a > 0.0f || w[k] == 0.0f);
        }
        for (int k = 0; k < 5; ++k) {
            hdrp_oit_talk_settings s = hdrp_oit_talk_settings_make(alphas[i % 6], exposures[k]);
            hdrp_oit_fragment f = fragment(hdrp_v3_splat(1.0f), hdrp_v3_splat(z), a, z);
            float talk = hdrp_oit_talk_weight(f, s);
            assert_true(talk >= 0.0f && talk <= 20.0f);
        }
    }
}

static void nearer_and_denser_weighs_more(void** state)
{
    (void)state;
    for (float alpha = 0.0f; alpha <= 1.0f; alpha += 0.125f) {
        for (float z = 0.01f; z < 2000.0f; z *= 1.5f) {
            assert_true(hdrp_oit_weight(z * 1.5f, alpha) <= hdrp_oit_weight(z, alpha));
        }
    }
    /* Dense ones by the -2.6th power of depth, thin ones hardly. */
    assert_true(
        fabs(log2((double)hdrp_oit_weight(8.0f, 1.0f) / (double)hdrp_oit_weight(16.0f, 1.0f)) -
             1.9705) < 1e-4);
    assert_true(
        fabs(log2((double)hdrp_oit_weight(8.0f, 0.1f) / (double)hdrp_oit_weight(16.0f, 0.1f)) -
             0.22518) < 1e-4);
}

/* ---- pixels ---------------------------------------------------------------------------------- */

static void one_layer_is_exact_in_every_mode(void** state)
{
    const hdrp_v3 behind = v3(0.7f, 0.2f, 0.4f);
    (void)state;
    for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
        for (int i = 0; i < 200; ++i) {
            float alpha = i == 0 ? 1.0f : uniform(0.02f, 1.0f);
            hdrp_oit_fragment f = fragment(v3(uniform(0, 1), uniform(0, 1), uniform(0, 1)),
                                           v3(0, 0, 0), alpha, expf(uniform(-1.0f, 6.0f)));
            hdrp_oit_mode mode = (hdrp_oit_mode)m;
            hdrp_v3 exact = over(f, behind);
            double rounding = mode == HDRP_OIT_MODE_TALK ? 0.5 / 255.0 : 0.0;
            assert_color(color_of(&f, 1, behind, mode, HDRP_OIT_PRECISION_FLOAT), exact, 2e-6);
            assert_color(color_of(&f, 1, behind, mode, HDRP_OIT_PRECISION_NATIVE), exact,
                         rounding + 0x1p-9);
        }
    }
}

/* Alphas that revealage notices or not, and both sides of what counts as thin. */
static const float layer_alphas[] = {0.0f,    1e-30f,  0x1p-24f, 0x1p-13f,       0x1.fp-10f,
                                     0x1p-9f, 0x1p-7f, 0.02f,    0.1f,           0.11f,
                                     0.5f,    0.9f,    0.9999f,  0x1.fffffep-1f, 1.0f};

static void one_layer_that_shines_is_exact_in_every_mode_but_the_talk(void** state)
{
    const hdrp_v3 behind = v3(0.7f, 0.2f, 0.4f);
    (void)state;
    for (uint32_t m = 0; m < HDRP_OIT_MODE_TALK; ++m) {
        for (size_t i = 0; i < sizeof layer_alphas / sizeof *layer_alphas; ++i) {
            float z = expf(uniform(-1.0f, 6.0f));
            hdrp_oit_fragment f =
                fragment(v3(uniform(0, 1), uniform(0, 1), uniform(0, 1)),
                         v3(uniform(0, 4), uniform(0, 4), uniform(0, 4)), layer_alphas[i], z);
            hdrp_oit_mode mode = (hdrp_oit_mode)m;
            hdrp_v3 exact = over(f, behind);
            /* Published weights times such an alpha are too small to be told from nothing. */
            double lost = m > HDRP_OIT_MODE_MOMENTS_4 && f.alpha < 0x1p-9f ? (double)f.alpha : 0.0;
            assert_color(color_of(&f, 1, behind, mode, HDRP_OIT_PRECISION_FLOAT), exact,
                         4e-6 + lost);
            /* Emission is rounded, and what it is multiplied by changes with rounded revealage. */
            assert_color(color_of(&f, 1, behind, mode, HDRP_OIT_PRECISION_NATIVE), exact, 0x1p-7);
        }
    }
}

/* As on clear glass: far more light than alpha carries. */
static void one_thin_layer_keeps_its_highlight(void** state)
{
    const hdrp_v3 behind = v3(0.7f, 0.2f, 0.4f), black = v3(0, 0, 0);
    (void)state;
    for (uint32_t m = 0; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        for (size_t i = 0; i < sizeof layer_alphas / sizeof *layer_alphas; ++i) {
            float alpha = layer_alphas[i];
            hdrp_oit_fragment f = hdrp_oit_fragment_make(v3(0.25f, 1, 3), black, alpha, 4.0f);
            hdrp_oit_mode mode = (hdrp_oit_mode)m;
            hdrp_v3 exact = over(f, behind);
            /* Revealage has steps of 2^-11 below 1, of which half counts as a share of alpha. */
            double share = alpha < HDRP_OIT_THIN_ALPHA ? 0.0 : 0x1p-12 / (double)alpha;
            assert_color(color_of(&f, 1, behind, mode, HDRP_OIT_PRECISION_FLOAT), exact, 3e-5);
            assert_color(color_of(&f, 1, behind, mode, HDRP_OIT_PRECISION_NATIVE), exact,
                         3.0 * share + 0x1p-9);
        }
    }
}

static void no_layer_leaves_what_is_behind(void** state)
{
    const hdrp_v3 behind = v3(0.7f, 1e4f, 0.0f);
    (void)state;
    for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
        assert_color(color_of(NULL, 0, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE), behind,
                     0.0);
    }
}

static void what_is_not_there_has_no_influence(void** state)
{
    const hdrp_v3 behind = v3(0.3f, 0.5f, 0.9f);
    const float depths[4] = {0.0f, 1.5f, 30.0f, INFINITY};
    (void)state;
    for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
        hdrp_oit_fragment f[9];
        for (int i = 0; i < 5; ++i) {
            f[i] = random_fragment();
        }
        for (int i = 5; i < 9; ++i) {
            f[i] = fragment(v3(9, 9, 9), v3(0, 0, 0), 0.0f, depths[i - 5]);
        }
        hdrp_v3 without = color_of(f, 5, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE);
        hdrp_v3 with = color_of(f, 9, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE);
        assert_color(with, without, 0.0);
    }
}

static void order_changes_no_more_than_rounding(void** state)
{
    const hdrp_v3 behind = v3(0.3f, 0.5f, 0.9f);
    (void)state;
    for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
        /* The talk's target of 8 bits rounds at each of 12 layers; the rest has half floats. */
        double tolerance = m == HDRP_OIT_MODE_TALK ? 12.0 * 8.0 / 255.0 : 0.02;
        for (int i = 0; i < 100; ++i) {
            hdrp_oit_fragment f[12], turned[12];
            for (int k = 0; k < 12; ++k) {
                f[k] = random_fragment();
                turned[(5 * k + i) % 12] = f[k];
            }
            assert_color(color_of(turned, 12, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT),
                         color_of(f, 12, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT),
                         m == HDRP_OIT_MODE_MOMENTS_6 || m == HDRP_OIT_MODE_MOMENTS_4 ? 3e-3
                                                                                      : 2e-5);
            assert_color(color_of(turned, 12, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE),
                         color_of(f, 12, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE),
                         tolerance);
        }
    }
}

/* Behind a layer far before them, which leaves moments and wavelets no digits to tell them. */
static void order_changes_little_where_depths_are_close(void** state)
{
    const hdrp_v3 behind = v3(0.3f, 0.5f, 0.9f);
    (void)state;
    for (uint32_t m = 0; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        for (int i = 0; i < 3000; ++i) {
            hdrp_oit_fragment f[12], turned[12];
            float spread = exp2f(uniform(-20.0f, 0.0f)), base = expf(uniform(0.2f, 5.0f));
            for (int k = 0; k < 12; ++k) {
                f[k] = random_fragment();
                f[k].emission = v3(0, 0, 0);
                f[k].z_view = k == 0 ? 1.0f : base * (1.0f + uniform(0.0f, spread));
                turned[(5 * k + i) % 12] = f[k];
            }
            assert_color(color_of(turned, 12, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE),
                         color_of(f, 12, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE),
                         0.006); /* twelve roundings of sums up to 4 */
            assert_color(color_of(turned, 12, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT),
                         color_of(f, 12, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT),
                         m >= HDRP_OIT_MODE_MOMENTS_6 ? 0.002 : 1e-5);
        }
    }
}

/* One root of the polynomial of four moments is far off here, and the other lost its digits to it. */
static void order_changes_little_where_a_root_is_far_off(void** state)
{
    static const float z[4] = {1.01402318f, 1.01401937f, 1.62059438f, 0.864019692f};
    static const float alpha[4] = {0.794286668f, 0.632009625f, 0.876359642f, 0.360421687f};
    static const float light[4] = {0.687715769f, 0.149993211f, 0.584428906f, 0.311914563f};
    static const int order[4] = {2, 0, 3, 1};
    hdrp_oit_fragment f[4], turned[4];
    (void)state;
    for (int i = 0; i < 4; ++i) {
        f[i] = hdrp_oit_fragment_make(hdrp_v3_splat(light[i]), v3(0, 0, 0), alpha[i], z[i]);
    }
    for (int i = 0; i < 4; ++i) {
        turned[i] = f[order[i]];
    }
    for (uint32_t m = HDRP_OIT_MODE_MOMENTS_6; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        assert_color(color_of(turned, 4, v3(1, 1, 1), (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT),
                     color_of(f, 4, v3(1, 1, 1), (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT),
                     0.001);
    }
}

static hdrp_oit_fragment without_emission(hdrp_oit_fragment f)
{
    f.emission = v3(0, 0, 0);
    return f;
}

static void two_layers_are_exact_in_the_better_modes(void** state)
{
    const hdrp_v3 behind = v3(0.3f, 0.5f, 0.9f);
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_FRONT; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        for (int i = 0; i < 200; ++i) {
            hdrp_oit_fragment f[2] = {random_fragment(), random_fragment()};
            if (m == HDRP_OIT_MODE_FRONT) { /* for which the second layer has no known depth */
                f[0] = without_emission(f[0]);
                f[1] = without_emission(f[1]);
            }
            int near_one = f[1].z_view < f[0].z_view;
            hdrp_v3 exact = over(f[near_one], over(f[1 - near_one], behind));
            /* A bias moves some of what moments see absorbed to where nothing is. And what is too
             * thin for a front is not quite before the other, or covers beside it. */
            double tolerance = m >= HDRP_OIT_MODE_MOMENTS_6 ? 0x1p-11 : 1e-6;
            if (f[near_one].alpha < HDRP_OIT_FRONT_ALPHA) {
                tolerance = m == HDRP_OIT_MODE_FRONT ? 0.1 : 0.008;
            }
            assert_color(color_of(f, 2, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT), exact,
                         tolerance);
        }
    }
}

static void layers_at_one_depth_share(void** state)
{
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_WAVELET; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        hdrp_oit_fragment f[2] = {fragment(v3(1, 0, 0), v3(0, 0, 0), 0.5f, 3.0f),
                                  fragment(v3(0, 1, 0), v3(0, 0, 0), 0.5f, 3.0f)};
        hdrp_v3 c = color_of(f, 2, v3(0, 0, 0), (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT);
        assert_color(c, v3(0.375f, 0.375f, 0.0f), 1e-6);
    }
}

/* Sprites that face the camera around one point: none of them hides all others. */
static void many_layers_at_one_depth_stay_visible(void** state)
{
    const float alphas[4] = {0.5f, 0.9f, 0.99f, 1.0f};
    hdrp_oit_fragment f[64];
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_WAVELET; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        for (int i = 0; i < 4; ++i) {
            for (int k = 0; k < 64; ++k) {
                f[k] = fragment(v3(1, 0.5f, 0), v3(0, 0, 0), alphas[i], 3.0f);
            }
            for (size_t n = 1; n <= 64; ++n) {
                float covered = 1.0f - powf(1.0f - alphas[i], (float)n);
                hdrp_v3 c =
                    color_of(f, n, v3(0, 0, 0), (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE);
                assert_color(c, v3(covered, 0.5f * covered, 0.0f), 4e-3);
            }
        }
    }
}

static void emission_is_seen_through_what_is_before_it(void** state)
{
    const hdrp_oit_fragment glass = fragment(v3(0, 0, 0), v3(0, 0, 0), 0.75f, 5.0f);
    /* At the same depth something is before it in three of four cases. */
    const float depths[3] = {2.0f, 5.0f, 9.0f}, seen[3] = {1.0f, 0.4375f, 0.25f};
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_WAVELET; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        for (int i = 0; i < 3; ++i) {
            hdrp_oit_fragment f[2] = {fragment(v3(0, 0, 0), v3(1, 2, 4), 0.0f, depths[i]), glass};
            float s = seen[i];
            hdrp_v3 c = color_of(f, 2, v3(0, 0, 0), (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT);
            assert_color(c, v3(s, 2.0f * s, 4.0f * s), i == 1 ? 3e-3 : 1e-5);
        }
    }
    /* Without depth: the mean over what absorbs evenly. */
    hdrp_oit_fragment f[2] = {fragment(v3(0, 0, 0), v3(1, 2, 4), 0.0f, 2.0f), glass};
    float s = 0.75f / logf(4.0f);
    assert_color(color_of(f, 2, v3(0, 0, 0), HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_FLOAT),
                 v3(s, 2.0f * s, 4.0f * s), 1e-5);
}

/* Soft edges of sprites are before much, and hide nothing. */
static void a_wisp_is_no_front(void** state)
{
    const hdrp_v3 black = v3(0, 0, 0), behind = v3(0.5f, 0.5f, 0.5f);
    const float alphas[4] = {1e-7f, 1e-3f, 0.02f, 0.09f};
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_FRONT; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        for (int i = 0; i < 4; ++i) {
            hdrp_oit_fragment f[3] = {fragment(v3(0, 1, 0), black, alphas[i], 0.5f),
                                      fragment(v3(1, 0, 0), black, 0.99f, 2.0f),
                                      fragment(v3(0, 0, 1), black, 0.9f, 2.02f)};
            hdrp_v3 exact = over(f[0], over(f[1], over(f[2], behind)));
            assert_color(color_of(f, 3, behind, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE), exact,
                         0.02);
        }
    }
}

/* What covers least in a pixel is its front where nothing is denser. */
static void wisps_alone_are_in_order(void** state)
{
    const hdrp_v3 black = v3(0, 0, 0);
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_WAVELET; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        hdrp_oit_fragment f[2] = {fragment(black, black, 0.09f, 2.0f),
                                  fragment(black, v3(1, 2, 4), 0.05f, 3.0f)};
        float s = 1.0f - 0.09f;
        assert_color(color_of(f, 2, black, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT),
                     v3(s, 2.0f * s, 4.0f * s), 1e-4);
    }
}

/* A faint pane before dense layers that nothing tells from each other: not all of it is the pane. */
static void a_faint_pane_does_not_take_the_picture(void** state)
{
    const hdrp_v3 black = v3(0, 0, 0);
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_WAVELET; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        hdrp_oit_fragment f[4] = {
            fragment(v3(1, 1, 1), black, 0.15f, 1.0f), fragment(black, black, 1.0f, 98.0f),
            fragment(black, black, 1.0f, 99.0f), fragment(black, black, 1.0f, 100.0f)};
        hdrp_v3 c = color_of(f, 4, black, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_NATIVE);
        assert_true(c.x >= 0.09f && c.x <= 0.27f);
    }
}

/* Behind all that covers everything is between. */
static void emission_behind_all_is_seen_through_all(void** state)
{
    const hdrp_v3 black = v3(0, 0, 0);
    (void)state;
    for (uint32_t m = HDRP_OIT_MODE_WAVELET; m <= HDRP_OIT_MODE_MOMENTS_4; ++m) {
        hdrp_oit_fragment f[3] = {fragment(black, black, 0.3f, 2.0f),
                                  fragment(black, black, 0.9f, 10.0f),
                                  fragment(black, v3(1, 2, 4), 0.0f, 12.0f)};
        hdrp_v3 c = color_of(f, 3, black, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT);
        assert_color(c, v3(0.07f, 0.14f, 0.28f), 1e-5);
    }
}

static void transmittance_never_leaves_its_range(void** state)
{
    const float odd[7] = {NAN, INFINITY, -INFINITY, 1e30f, -1.0f, 0.0f, 1.0f};
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_oit_fragment f = random_fragment();
        hdrp_oit_place p =
            hdrp_oit_place_of(f, hdrp_v2_make(uniform(-50.0f, 0.0f), uniform(0.0f, 200.0f)));
        hdrp_oit_wavelet w;
        hdrp_oit_moments m;
        float x = i % 7 ? uniform(-1.0f, 3.0f) : odd[i / 7 % 7];
        w.coarse = hdrp_v4_make(x, uniform(0, 1), uniform(0, 1), uniform(0, 1));
        w.eighths = w.coarse;
        w.finest_low = w.coarse;
        w.finest_high = w.coarse;
        w.front = uniform(0, 1);
        m.power = hdrp_v4_make(uniform(-2, 2), uniform(0, 2), uniform(-2, 2), x);
        m.high = hdrp_v4_make(uniform(-2, 2), uniform(0, 2), uniform(0, 2), x);
        float t[3] = {hdrp_oit_wavelet_transmittance(w, f, p),
                      hdrp_oit_moments_transmittance(m, f, p, 4u),
                      hdrp_oit_moments_transmittance(m, f, p, 6u)};
        for (int k = 0; k < 3; ++k) {
            assert_true(t[k] >= 0.0f && t[k] <= 1.0f);
        }
    }
}

static void moments_are_powers_of_the_place(void** state)
{
    hdrp_oit_fragment f = fragment(v3(1, 1, 1), v3(0, 0, 0), 0.5f, 8.0f);
    hdrp_oit_place p = hdrp_oit_place_of(f, hdrp_v2_make(-1.0f, 16.0f)); /* 3/4 */
    hdrp_oit_moments m = hdrp_oit_moments_insert(f, p);
    double b = log(2.0);
    (void)state;
    assert_true(p.unit == 0.75f && p.behind == 1.0f && p.front == 0.0f);
    assert_color(v3(m.power.x, m.power.y, m.power.z),
                 v3((float)(b / 2), (float)(b / 4), (float)(b / 8)), 1e-7);
    assert_color(v3(m.power.w, m.high.x, m.high.y),
                 v3((float)(b / 16), (float)(b / 32), (float)(b / 64)), 1e-7);
    assert_color(v3(m.high.z, m.high.w, 0), v3((float)b, 0, 0), 1e-7);
    m = hdrp_oit_moments_insert(f, hdrp_oit_place_of(f, hdrp_v2_make(-8.0f, 16.0f)));
    assert_color(v3(m.high.z, m.high.w, m.power.x), v3(0, (float)b, 0), 1e-7); /* the nearest */
}

/* ---- defects of the talk's form -------------------------------------------------------------- */

static void equal_layers_keep_the_brightness_of_one_only_in_the_talk(void** state)
{
    hdrp_oit_fragment f[4];
    (void)state;
    for (int i = 0; i < 4; ++i) {
        f[i] = fragment(v3(1, 1, 1), v3(0, 0, 0), 0.3f, 10.0f);
    }
    hdrp_v3 talk = color_of(f, 4, v3(0, 0, 0), HDRP_OIT_MODE_TALK, HDRP_OIT_PRECISION_FLOAT);
    hdrp_v3 ours = color_of(f, 4, v3(0, 0, 0), HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_FLOAT);
    /* 0.30, amplified by what it calls opacity: sat(2 (1 - R)) is 1 here. */
    assert_color(talk, hdrp_v3_splat(0.3f), 1e-5);
    assert_color(ours, hdrp_v3_splat(0.7599f), 1e-5);
}

static void bright_layers_overflow_only_in_the_talk(void** state)
{
    hdrp_oit_fragment f[32];
    (void)state;
    for (int i = 0; i < 32; ++i) {
        f[i] = fragment(hdrp_v3_splat(1100.0f), v3(0, 0, 0), 0.95f, 0.6f);
    }
    hdrp_v3 three = color_of(f, 3, v3(0, 0, 0), HDRP_OIT_MODE_TALK, HDRP_OIT_PRECISION_NATIVE);
    hdrp_v3 four = color_of(f, 4, v3(0, 0, 0), HDRP_OIT_MODE_TALK, HDRP_OIT_PRECISION_NATIVE);
    assert_true(three.x > 900.0f);
    assert_color(four, hdrp_v3_splat(100.0f), 0.0); /* infinite */
    for (int i = 0; i < 32; ++i) {
        f[i] = fragment(hdrp_v3_splat(4000.0f), v3(0, 0, 0), 0.95f, 0.6f);
    }
    for (size_t n = 1; n <= 32; ++n) {
        hdrp_v3 c =
            color_of(f, n, v3(0, 0, 0), HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_NATIVE);
        assert_true(fabsf(c.x - 4000.0f * (1.0f - powf(0.05f, (float)n))) < 50.0f);
    }
}

static void additive_layers_end_at_eight_only_in_the_talk(void** state)
{
    hdrp_oit_fragment f[32];
    (void)state;
    for (int i = 0; i < 32; ++i) {
        f[i] = fragment(v3(0, 0, 0), hdrp_v3_splat(0.5f), 0.0f, 10.0f);
    }
    hdrp_v3 eight = color_of(f, 8, v3(0, 0, 0), HDRP_OIT_MODE_TALK, HDRP_OIT_PRECISION_NATIVE);
    hdrp_v3 all = color_of(f, 32, v3(0, 0, 0), HDRP_OIT_MODE_TALK, HDRP_OIT_PRECISION_NATIVE);
    assert_color(eight, hdrp_v3_splat(4.0f), 0.02);
    assert_color(all, hdrp_v3_splat(4.0f), 0.02);
    for (size_t n = 1; n <= 32; ++n) {
        assert_color(
            color_of(f, n, v3(0, 0, 0), HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_NATIVE),
            hdrp_v3_splat(0.5f * (float)n), 0.0);
    }
}

/* ---- images ---------------------------------------------------------------------------------- */

#define SIDE  16u
#define COUNT 2000u

static void splits_give_the_same_bits(void** state)
{
    static hdrp_oit_fragment f[COUNT];
    static uint32_t pixels[COUNT];
    static hdrp_v3 behind[SIDE * SIDE], a[SIDE * SIDE], b[SIDE * SIDE];
    (void)state;
    for (uint32_t i = 0; i < COUNT; ++i) {
        f[i] = random_fragment();
        pixels[i] = (uint32_t)uniform(0.0f, (float)(SIDE * SIDE + 8u)); /* some are outside */
    }
    for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
        picture whole = make_picture(SIDE, SIDE, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_COMPACT);
        picture split = make_picture(SIDE, SIDE, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_COMPACT);
        blend(&whole, f, pixels, COUNT);
        hdrp_oit_composite_rows(&whole.image, behind, a, 0, SIDE);
        hdrp_oit_clear_rows(&split.image, 0, 7);
        hdrp_oit_clear_rows(&split.image, 7, 99);
        for (uint32_t pass = 0; pass < hdrp_oit_pass_count((hdrp_oit_mode)m); ++pass) {
            for (uint32_t row = SIDE; row-- > 0u;) {
                for (uint32_t i = 0; i < COUNT; i += 333u) {
                    uint32_t n = COUNT - i < 333u ? COUNT - i : 333u;
                    hdrp_oit_blend_rows(&split.image, pass, f + i, pixels + i, n, row, row + 1u);
                }
            }
        }
        hdrp_oit_blend_rows(&split.image, 3u, f, pixels, COUNT, 0, SIDE); /* no such pass */
        hdrp_oit_composite_rows(&split.image, behind, b, 9, 99);
        hdrp_oit_composite_rows(&split.image, behind, b, 0, 9);
        assert_memory_equal(a, b, sizeof a);
        free(whole.memory);
        free(split.memory);
    }
}

/* Passes of range and absorption see all fragments in both resolutions, the last one its own. */
static void blend_both(picture* p, const hdrp_oit_fragment* f, int own, uint32_t pixel)
{
    const uint32_t pixels[2] = {pixel, pixel};
    uint32_t last = hdrp_oit_pass_count(p->image.desc.mode) - 1u;
    for (uint32_t pass = 0; pass < last; ++pass) {
        hdrp_oit_blend_rows(&p->image, pass, f, pixels, 2, 0, p->image.desc.height_px);
    }
    hdrp_oit_blend_rows(&p->image, last, f + own, pixels, 1, 0, p->image.desc.height_px);
}

static void check_low(hdrp_oit_mode mode, int near_is_low)
{
    const hdrp_v3 behind = v3(0.3f, 0.5f, 0.9f);
    picture high = make_picture(4, 4, mode, HDRP_OIT_PRECISION_FLOAT);
    picture low = make_picture(2, 2, mode, HDRP_OIT_PRECISION_FLOAT);
    hdrp_oit_fragment f[2] = {random_fragment(), random_fragment()};
    hdrp_v3 both, backdrop[16], color[16];
    f[0].z_view = near_is_low ? 9.0f : 5.0f;
    f[1].z_view = near_is_low ? 5.0f : 9.0f;
    both = color_of(f, 2, behind, mode, HDRP_OIT_PRECISION_FLOAT);
    for (uint32_t i = 0; i < 16u; ++i) {
        backdrop[i] = behind;
        blend_both(&high, f, 0, i);
    }
    for (uint32_t i = 0; i < 4u; ++i) {
        blend_both(&low, f, 1, i);
    }
    assert_int_equal(hdrp_oit_merge_rows(&high.image, &low.image, 0, 1), HDRP_OK);
    assert_int_equal(hdrp_oit_merge_rows(&high.image, &low.image, 1, 9), HDRP_OK);
    hdrp_oit_composite_rows(&high.image, backdrop, color, 0, 4);
    for (int i = 0; i < 16; ++i) {
        assert_color(color[i], both, 2e-6);
    }
    free(high.memory);
    free(low.memory);
}

static void a_low_layer_joins_as_if_it_were_full(void** state)
{
    (void)state;
    for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
        for (int i = 0; i < 8; ++i) {
            check_low((hdrp_oit_mode)m, i & 1);
        }
    }
}

/* A column that is covered at half of the resolution fades over the next two pixels: what was added
 * does, too, whichever target it went to. */
static void low_pixels_fade_into_each_other(void** state)
{
    const float share[8] = {1.0f, 1.0f, 1.0f, 0.75f, 0.25f, 0.0f, 0.0f, 0.0f};
    const hdrp_oit_fragment f = fragment(v3(0.5f, 0.5f, 0.5f), v3(0.25f, 0, 0), 0.5f, 4.0f);
    (void)state;
    for (uint32_t m = 0; m < HDRP_OIT_MODE_TALK; ++m) {
        picture high = make_picture(8, 1, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT);
        picture low = make_picture(4, 1, (hdrp_oit_mode)m, HDRP_OIT_PRECISION_FLOAT);
        const uint32_t pixels[2] = {0, 1};
        const hdrp_oit_fragment both[2] = {f, f};
        hdrp_v3 behind[8], color[8];
        memset(behind, 0, sizeof behind);
        blend(&low, both, pixels, 2);
        assert_int_equal(hdrp_oit_merge_rows(&high.image, &low.image, 0, 1), HDRP_OK);
        hdrp_oit_composite_rows(&high.image, behind, color, 0, 1);
        for (int i = 0; i < 8; ++i) {
            assert_true(fabsf(color[i].y - 0.25f * share[i]) < 1e-6f);
        }
        free(high.memory);
        free(low.memory);
    }
}

static void other_modes_do_not_join(void** state)
{
    picture a = make_picture(2, 2, HDRP_OIT_MODE_WAVELET, HDRP_OIT_PRECISION_NATIVE);
    picture b = make_picture(2, 2, HDRP_OIT_MODE_MOMENTS_6, HDRP_OIT_PRECISION_NATIVE);
    picture c = make_picture(2, 2, HDRP_OIT_MODE_WAVELET, HDRP_OIT_PRECISION_FLOAT);
    (void)state;
    assert_int_equal(hdrp_oit_merge_rows(&a.image, &b.image, 0, 2), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_oit_merge_rows(&a.image, &c.image, 0, 2), HDRP_ERROR_BAD_ARGUMENT);
    c.image.desc = a.image.desc;
    c.image.desc.scale = 2.0f;
    assert_int_equal(hdrp_oit_merge_rows(&a.image, &c.image, 0, 2), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_oit_merge_rows(NULL, &a.image, 0, 2), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_oit_merge_rows(&a.image, NULL, 0, 2), HDRP_ERROR_NULL_POINTER);
    free(a.memory);
    free(b.memory);
    free(c.memory);
}

static void merged_sums_are_those_of_both(void** state)
{
    hdrp_oit_targets a, b, t;
    (void)state;
    a.accum = hdrp_v4_make(1, 2, 3, 4);
    a.light = hdrp_v4_make(0.5f, 2, 3, 0.25f);
    b = a;
    t = hdrp_oit_merge(a, b);
    assert_color(v3(t.accum.x, t.accum.w, t.light.y), v3(2, 8, 4), 0.0);
    assert_true(t.light.w == 0.0625f);
    t = hdrp_oit_talk_merge(a, b);
    assert_color(v3(t.accum.z, t.light.x, t.light.w), v3(6, 0.25f, 0.5f), 0.0);
}

static void targets_are_rounded_as_they_are_stored(void** state)
{
    const hdrp_oit_fragment f[2] = {
        fragment(v3(1, 1, 1), v3(0, 0, 0), 0.3f, 10.0f), /* 178.5 codes, less */
        fragment(v3(0, 0, 0), v3(1.0f / 3.0f, 0, 0), 0.0f, 10.0f)};
    const uint32_t pixels[2] = {0, 0};
    (void)state;
    picture half = make_picture(1, 1, HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_NATIVE);
    blend(&half, f, pixels, 2);
    assert_true(half.image.texels[1].x ==
                hdrp_pack_float_from_half(hdrp_pack_half_from_float(1.0f / 3.0f)));
    assert_true(half.image.texels[1].w ==
                hdrp_pack_float_from_half(hdrp_pack_half_from_float(1.0f - 0.3f)));
    free(half.memory);
    picture small = make_picture(1, 1, HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_COMPACT);
    blend(&small, f, pixels, 2);
    assert_true(small.image.texels[1].x == 0.33203125f); /* 85 / 256: 6 bits behind the point */
    assert_true(small.image.texels[2].x == 178.0f / 255.0f);
    free(small.memory);
    assert_int_equal(hdrp_oit_bytes_per_pixel(HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_NATIVE),
                     16);
    assert_int_equal(
        hdrp_oit_bytes_per_pixel(HDRP_OIT_MODE_RECOMMENDED, HDRP_OIT_PRECISION_COMPACT), 13);
    assert_int_equal(hdrp_oit_bytes_per_pixel(HDRP_OIT_MODE_WAVELET, HDRP_OIT_PRECISION_NATIVE),
                     58);
    assert_int_equal(hdrp_oit_bytes_per_pixel(HDRP_OIT_MODE_TALK, HDRP_OIT_PRECISION_NATIVE), 12);
}

static void bad_descriptions_are_rejected(void** state)
{
    hdrp_oit_target targets[HDRP_OIT_TARGETS_MAX];
    hdrp_oit_desc d;
    hdrp_oit_image image, untouched;
    _Alignas(16) static char memory[4096];
    (void)state;
    memset(&image, 7, sizeof image);
    untouched = image;
    memset(&d, 0, sizeof d);
    assert_int_equal(hdrp_oit_memory_size(&d), 0);
    assert_int_equal(hdrp_oit_memory_size(NULL), 0);
    assert_int_equal(hdrp_oit_image_init(&image, &d, memory, sizeof memory),
                     HDRP_ERROR_BAD_ARGUMENT);
    d.width_px = 4;
    d.height_px = 4;
    assert_int_equal(hdrp_oit_image_init(NULL, &d, memory, sizeof memory), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_oit_image_init(&image, &d, memory, 511), HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(hdrp_oit_image_init(&image, &d, memory + 4, 2048),
                     HDRP_ERROR_MEMORY_ALIGNMENT);
    d.scale = NAN;
    assert_int_equal(hdrp_oit_image_init(&image, &d, memory, sizeof memory),
                     HDRP_ERROR_BAD_ARGUMENT);
    d.scale = 0.0f;
    d.mode = HDRP_OIT_MODE_COUNT;
    assert_int_equal(hdrp_oit_image_init(&image, &d, memory, sizeof memory),
                     HDRP_ERROR_BAD_ARGUMENT);
    d.mode = HDRP_OIT_MODE_RECOMMENDED;
    d.width_px = d.height_px = 0x10000u;
    assert_int_equal(hdrp_oit_image_init(&image, &d, memory, sizeof memory), HDRP_ERROR_TOO_LARGE);
    assert_memory_equal(&image, &untouched, sizeof image);
    assert_int_equal(
        hdrp_oit_describe_targets(HDRP_OIT_MODE_COUNT, HDRP_OIT_PRECISION_NATIVE, targets), 0);
    assert_int_equal(hdrp_oit_pass_count(HDRP_OIT_MODE_COUNT), 0);
    assert_int_equal(hdrp_oit_bytes_per_pixel(HDRP_OIT_MODE_COUNT, HDRP_OIT_PRECISION_NATIVE), 0);
    for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
        for (int p = 0; p < 3; ++p) {
            assert_in_range(
                hdrp_oit_describe_targets((hdrp_oit_mode)m, (hdrp_oit_precision)p, targets), 2,
                HDRP_OIT_TARGETS_MAX);
        }
    }
}

static void exports_go_by_their_weights(void** state)
{
    hdrp_oit_fragment f = fragment(v3(1, 0.5f, 0), v3(0, 1, 0), 0.5f, 20.0f);
    hdrp_oit_targets a = hdrp_oit_export(f, 2.0f);
    hdrp_oit_fragment dull = hdrp_oit_fragment_make(f.premultiplied, v3(0, 0, 0), f.alpha, 20.0f);
    hdrp_oit_targets e = hdrp_oit_export(dull, 2.0f);
    hdrp_oit_targets b = hdrp_oit_weighted_export(dull, hdrp_oit_weight(20.0f, 0.5f), 2.0f);
    hdrp_oit_targets c = hdrp_oit_layer_export(f, 0.25f, 1.0f);
    hdrp_oit_targets d = hdrp_oit_talk_export(f, hdrp_oit_talk_settings_make(1.0f, 1.0f));
    (void)state;
    assert_memory_equal(&e, &b, sizeof e);
    /* A 16th of the emission is apart, over what evenly absorbing halves of light let through. */
    assert_true(fabsf(a.light.y - 2.0f * logf(2.0f) / 8.0f) <= 1e-6f && a.light.w == 0.5f);
    assert_true(c.accum.x == 0.125f && c.accum.w == 0.125f && c.light.y == 0.25f);
    assert_true(d.light.x == 0.5f && d.light.w == 0.125f);
    /* From 2^-9 on alpha carries the colour. */
    assert_true(hdrp_oit_export(fragment(v3(1, 1, 1), v3(0, 0, 0), 0x1p-9f, 1.0f), 1.0f).accum.x >
                0.0f);
    assert_true(
        hdrp_oit_export(fragment(v3(1, 1, 1), v3(0, 0, 0), 0x1.fffp-10f, 1.0f), 1.0f).accum.x ==
        0.0f);
    /* A colour behind a scale comes back. */
    a.light.w = 0.5f;
    assert_color(hdrp_oit_composite(a, v3(0, 0, 0), 2.0f), v3(0.5f, 0.25f + 1.0f, 0.0f), 1e-6);
    c.light.w = 0.5f;
    assert_color(hdrp_oit_layer_composite(c, v3(0, 0, 0), 1.0f), v3(0.5f, 0.5f, 0.0f), 1e-6);
    d.light.x = 0.5f;
    assert_color(hdrp_oit_talk_composite(d, v3(1, 1, 1)), v3(1.3125f, 1.78125f, 0.5f), 2.0);
}

/* Each mode by its own text: published equations written out here, others by what they call. */
static void modes_export_by_their_weights(void** state)
{
    hdrp_oit_fragment f = fragment(v3(1, 0.5f, 0), v3(0, 1, 0), 0.5f, 20.0f);
    hdrp_oit_talk_settings s = hdrp_oit_talk_settings_make(1.0f, 1.0f);
    hdrp_oit_targets a = hdrp_oit_mode_export(HDRP_OIT_MODE_RECOMMENDED, f, 0.5f, s, 2.0f);
    hdrp_oit_targets b = hdrp_oit_export(f, 2.0f);
    hdrp_oit_targets c = hdrp_oit_mode_export(HDRP_OIT_MODE_EQ10, f, 0.5f, s, 2.0f);
    hdrp_oit_targets d = hdrp_oit_weighted_export(f, hdrp_oit_weight_eq10(0.5f, 0.5f), 2.0f);
    (void)state;
    assert_memory_equal(&a, &b, sizeof a);
    assert_memory_equal(&c, &d, sizeof c);
}

static void ranges_tell_what_is_thin(void** state)
{
    const hdrp_v3 black = v3(0, 0, 0);
    hdrp_v2 dense = hdrp_oit_range_export(fragment(black, black, 0.1f, 7.0f));
    hdrp_v2 thin = hdrp_oit_range_export(fragment(black, black, 0.0999f, 3.0f));
    hdrp_v2 far_one = hdrp_oit_range_export(fragment(black, black, 1.0f, INFINITY));
    hdrp_v2 none = hdrp_oit_range_export(fragment(black, v3(1, 1, 1), 0.0f, 2.0f));
    (void)state;
    assert_true(hdrp_oit_nearest_of(dense) == 7.0f && dense.y == 7.0f);
    assert_true(hdrp_oit_nearest_of(thin) == 3.0f && thin.y == 3.0f);
    assert_true(hdrp_oit_nearest_of(far_one) == 1e6f && far_one.y == 1e6f);
    assert_true(hdrp_oit_nearest_of(none) == 1e6f && none.y == 0.0f);
    /* Of what is kept: the nearest dense one, else the nearest thin one, else nothing. */
    assert_true(dense.x > thin.x && far_one.x > thin.x && thin.x > none.x);
    assert_true(hdrp_oit_nearest_of(hdrp_v2_make(NAN, 0.0f)) == 1e-6f);
}

static void modes_choose_their_weights(void** state)
{
    const hdrp_oit_talk_settings s = hdrp_oit_talk_settings_make(0.5f, 2.0f);
    const double alpha = 0.375, z = 20.0, depth = 0.75;
    hdrp_oit_fragment f = fragment(v3(1, 0.5f, 0), v3(0, 1, 0), (float)alpha, (float)z);
    const double expected[HDRP_OIT_MODE_COUNT] = {
        (double)hdrp_oit_weight(f.z_view, f.alpha),
        (double)hdrp_oit_weight(f.z_view, f.alpha),
        (double)hdrp_oit_weight(f.z_view, f.alpha),
        (double)hdrp_oit_weight(f.z_view, f.alpha),
        (double)hdrp_oit_weight(f.z_view, f.alpha),
        alpha * 10.0 / (1e-5 + pow(z / 5.0, 2.0) + pow(z / 200.0, 6.0)),
        alpha * 10.0 / (1e-5 + pow(z / 10.0, 3.0) + pow(z / 200.0, 6.0)),
        alpha * 0.03 / (1e-5 + pow(z / 200.0, 4.0)),
        alpha * 3e3 * pow(1.0 - depth, 3.0),
        3000.0, /* the limit: 1.01^3 * 1e8 * (1 - 0.9 * 0.75)^3 is more */
        (double)hdrp_oit_talk_weight(f, s),
        (double)hdrp_oit_weight(f.z_view, f.alpha)};
    (void)state;
    for (uint32_t mode = 0; mode < HDRP_OIT_MODE_COUNT; ++mode) {
        float w = hdrp_oit_mode_weight(mode, f, (float)depth, s);
        assert_true(fabs((double)w - expected[mode]) <= 2e-6 * expected[mode]);
    }
    assert_true(hdrp_oit_mode_weight(HDRP_OIT_MODE_COUNT, f, 0.5f, s) == (float)expected[0]);
    f.alpha = 0.05f;
    assert_true(hdrp_oit_mode_weight(HDRP_OIT_MODE_2015, f, 0.999f, s) ==
                hdrp_oit_weight_2015(0.999f, 0.05f));
}

static void the_front_is_kept_apart(void** state)
{
    hdrp_oit_fragment f = fragment(v3(1, 0.5f, 0), v3(0, 1, 0), 0.5f, 20.0f);
    hdrp_oit_front_targets a = hdrp_oit_front_export(f, 20.0f, 2.0f);
    hdrp_oit_front_targets b = hdrp_oit_front_export(f, 19.0f, 2.0f);
    hdrp_oit_targets tail = hdrp_oit_export(f, 2.0f);
    (void)state;
    assert_color(v3(a.front.x, a.front.y, a.front.w), v3(1.0f, 2.5f, 0.5f), 0.0);
    assert_color(v3(a.accum.x, a.accum.w, a.light.w), v3(0, 0, 0), 0.0);
    assert_color(v3(b.front.x, b.front.y, b.front.w), v3(0, 0, 0), 0.0);
    assert_memory_equal(&b.accum, &tail.accum, sizeof tail.accum);
    a.light.w = 1.0f;
    assert_color(hdrp_oit_front_composite(a, v3(1, 1, 1), 2.0f), v3(1.0f, 1.75f, 0.5f), 1e-6);
    a.front.w = 2.0f; /* four at one depth */
    assert_color(hdrp_oit_front_composite(a, v3(1, 1, 1), 2.0f), v3(0.25f, 0.625f, 0.0f), 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fragments_are_finite_whatever_they_are_made_of),
        cmocka_unit_test(weights_are_finite_at_every_extreme),
        cmocka_unit_test(nearer_and_denser_weighs_more),
        cmocka_unit_test(one_layer_is_exact_in_every_mode),
        cmocka_unit_test(one_layer_that_shines_is_exact_in_every_mode_but_the_talk),
        cmocka_unit_test(one_thin_layer_keeps_its_highlight),
        cmocka_unit_test(no_layer_leaves_what_is_behind),
        cmocka_unit_test(what_is_not_there_has_no_influence),
        cmocka_unit_test(order_changes_no_more_than_rounding),
        cmocka_unit_test(order_changes_little_where_depths_are_close),
        cmocka_unit_test(order_changes_little_where_a_root_is_far_off),
        cmocka_unit_test(two_layers_are_exact_in_the_better_modes),
        cmocka_unit_test(layers_at_one_depth_share),
        cmocka_unit_test(many_layers_at_one_depth_stay_visible),
        cmocka_unit_test(emission_is_seen_through_what_is_before_it),
        cmocka_unit_test(a_wisp_is_no_front),
        cmocka_unit_test(wisps_alone_are_in_order),
        cmocka_unit_test(a_faint_pane_does_not_take_the_picture),
        cmocka_unit_test(emission_behind_all_is_seen_through_all),
        cmocka_unit_test(transmittance_never_leaves_its_range),
        cmocka_unit_test(moments_are_powers_of_the_place),
        cmocka_unit_test(equal_layers_keep_the_brightness_of_one_only_in_the_talk),
        cmocka_unit_test(bright_layers_overflow_only_in_the_talk),
        cmocka_unit_test(additive_layers_end_at_eight_only_in_the_talk),
        cmocka_unit_test(splits_give_the_same_bits),
        cmocka_unit_test(a_low_layer_joins_as_if_it_were_full),
        cmocka_unit_test(low_pixels_fade_into_each_other),
        cmocka_unit_test(other_modes_do_not_join),
        cmocka_unit_test(merged_sums_are_those_of_both),
        cmocka_unit_test(targets_are_rounded_as_they_are_stored),
        cmocka_unit_test(bad_descriptions_are_rejected),
        cmocka_unit_test(the_front_is_kept_apart),
        cmocka_unit_test(exports_go_by_their_weights),
        cmocka_unit_test(modes_export_by_their_weights),
        cmocka_unit_test(ranges_tell_what_is_thin),
        cmocka_unit_test(modes_choose_their_weights),
    };
    return cmocka_run_group_tests_name("oit", tests, NULL, NULL);
}
