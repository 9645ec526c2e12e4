/* Texture filtering: wrapping, mip chains, footprints of any kind. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One texture of w x h texels, filled by the caller. */
static rd_texture_set make(int w, int h, bool is_srgb, const unsigned char* rgba)
{
    rd_texture_set set;
    rd_report report;
    memset(&set, 0, sizeof set);
    report.failed = false;
    set.count = 1;
    set.items = (rd_texture*)calloc(1, sizeof *set.items);
    set.items[0].is_srgb = is_srgb;
    set.items[0].image.width = w;
    set.items[0].image.height = h;
    set.items[0].image.rgba = (unsigned char*)malloc((size_t)w * (size_t)h * 4);
    memcpy(set.items[0].image.rgba, rgba, (size_t)w * (size_t)h * 4);
    assert_true(rd_textures_prepare(&set, &report));
    return set;
}

static void assert_near(float a, float b, float tolerance)
{
    if (!(fabsf(a - b) <= tolerance)) {
        fail_msg("%g is not %g", (double)a, (double)b);
    }
}

static hdrp_v2 v2(float x, float y)
{
    return hdrp_v2_make(x, y);
}

static void a_constant_stays_constant_whatever_the_footprint(void** state)
{
    static const float odd[] = {0.0f, 1e-30f, 0.01f,  1.0f, -3.7f,
                                1e8f, 1e30f,  -1e30f, NAN,  INFINITY};
    unsigned char texels[5 * 3 * 4];
    rd_texture_set s;
    (void)state;
    memset(texels, 128, sizeof texels);
    s = make(5, 3, false, texels);
    for (size_t i = 0; i < 10; ++i) {
        for (size_t j = 0; j < 10; ++j) {
            hdrp_v4 c = rd_texture_sample(s.items, v2(odd[i], odd[j]), v2(odd[j], odd[i]),
                                          v2(odd[9 - i], odd[j]));
            assert_near(c.x, 128.0f / 255.0f, 1e-5f);
            assert_near(c.w, 128.0f / 255.0f, 1e-5f);
        }
    }
    rd_textures_free(&s);
}

static void colours_average_in_linear_light(void** state)
{
    static const unsigned char texels[16] = {255, 255, 255, 255, 0,   0,   0,   255,
                                             0,   0,   0,   255, 255, 255, 255, 255};
    rd_texture_set color = make(2, 2, true, texels);
    rd_texture_set data = make(2, 2, false, texels);
    (void)state;
    assert_int_equal(color.items[0].level_count, 2);
    /* Half the light is code 187.5, half the value code 127.5. */
    assert_in_range(color.items[0].level[1][0], 187, 188);
    assert_int_equal(data.items[0].level[1][0], 128);
    rd_textures_free(&color);
    rd_textures_free(&data);
}

static void what_is_transparent_tints_nothing(void** state)
{
    static const unsigned char texels[16] = {200, 10,  10, 255, 0, 255, 0, 0,
                                             0,   255, 0,  0,   0, 255, 0, 0};
    rd_texture_set s = make(2, 2, true, texels);
    (void)state;
    assert_true(abs(s.items[0].level[1][0] - 200) <= 1);
    assert_true(abs(s.items[0].level[1][1] - 10) <= 1);
    assert_int_equal(s.items[0].level[1][3], 64);
    rd_textures_free(&s);
}

static void texel_centres_are_exact_and_edges_wrap(void** state)
{
    static const unsigned char texels[16] = {0,   0, 0, 255, 100, 0, 0, 255,
                                             150, 0, 0, 255, 250, 0, 0, 255};
    rd_texture_set s = make(4, 1, false, texels);
    rd_texture* t = &s.items[0];
    (void)state;
    assert_near(rd_texture_sample_finest(t, v2(0.375f, 0.5f)).x * 255.0f, 100.0f, 1e-3f);
    assert_near(rd_texture_sample_finest(t, v2(0.0f, 0.5f)).x * 255.0f, 125.0f, 1e-3f);
    assert_near(rd_texture_sample_finest(t, v2(-0.625f, 0.5f)).x * 255.0f, 100.0f, 1e-3f);
    t->wrap_u = RD_WRAP_CLAMP;
    assert_near(rd_texture_sample_finest(t, v2(0.0f, 0.5f)).x, 0.0f, 1e-6f);
    assert_near(rd_texture_sample_finest(t, v2(7.0f, 0.5f)).x * 255.0f, 250.0f, 1e-3f);
    t->wrap_u = RD_WRAP_MIRROR;
    assert_near(rd_texture_sample_finest(t, v2(1.125f, 0.5f)).x * 255.0f, 250.0f, 1e-3f);
    assert_near(rd_texture_sample_finest(t, v2(-0.375f, 0.5f)).x * 255.0f, 100.0f, 1e-3f);
    rd_textures_free(&s);
}

static void a_large_footprint_sees_the_average(void** state)
{
    unsigned char texels[64 * 64 * 4];
    rd_texture_set s;
    (void)state;
    for (int i = 0; i < 64 * 64; ++i) {
        memset(texels + i * 4, (i + i / 64) % 2 ? 255 : 0, 4);
    }
    s = make(64, 64, false, texels);
    assert_near(rd_texture_sample(s.items, v2(0.3f, 0.7f), v2(0.05f, 0.0f), v2(0.0f, 0.05f)).x,
                0.5f, 0.005f);
    assert_near(rd_texture_sample(s.items, v2(0.3f, 0.7f), v2(0.05f, 0.0f), v2(0.0f, 0.01f)).x,
                0.5f, 0.2f);
    rd_textures_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_stays_constant_whatever_the_footprint),
        cmocka_unit_test(colours_average_in_linear_light),
        cmocka_unit_test(what_is_transparent_tints_nothing),
        cmocka_unit_test(texel_centres_are_exact_and_edges_wrap),
        cmocka_unit_test(a_large_footprint_sees_the_average),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
