/* test_cull_blocker.c - blockers, portals and clip planes: positions and cells against doubles.
 * SPDX-License-Identifier: MIT */
#define HDRP_CULL_IMPLEMENTATION
#include "cull_blocker_test.h"

static hdrp_v3 v3(double x, double y, double z)
{
    return hdrp_v3_make((float)x, (float)y, (float)z);
}

static hdrp_v4 at(double x, double y, double z)
{
    return hdrp_v4_from_v3(v3(x, y, z), 1.0f);
}

/* A wall across z = 0. */
static hdrp_cull_blocker wall(double half_width, double half_height)
{
    return hdrp_cull_blocker_rectangle(v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), (float)half_width,
                                       (float)half_height);
}

static void a_wall_blocks_what_is_behind_it_and_nothing_else(void** state)
{
    (void)state;
    hdrp_cull_blocker b = wall(2.0, 1.0);
    for (int flip = -1; flip <= 1; flip += 2) {
        double z = flip;
        assert_true(hdrp_cull_blocker_blocks(b, at(0, 0, z), v3(0, 0, -z)) == 1.0f);
        assert_true(hdrp_cull_blocker_blocks(b, at(0, 0, z), v3(0, 0, 3 * z)) == 0.0f);
        assert_true(hdrp_cull_blocker_blocks(b, at(0, 0, z), v3(3.9, 1.9, -z)) == 1.0f);
        assert_true(hdrp_cull_blocker_blocks(b, at(0, 0, z), v3(4.1, 1.9, -z)) == 0.0f);
        assert_true(hdrp_cull_blocker_blocks(b, at(0, 0, z), v3(-3.9, 2.1, -z)) == 0.0f);
        assert_true(hdrp_cull_blocker_blocks(b, at(0, 0, z), v3(-4, -2, -z)) == 1.0f); /* rim */
    }
}

static void what_is_in_the_plane_of_a_wall_is_not_blocked_by_it(void** state)
{
    (void)state;
    hdrp_cull_blocker b = wall(2.0, 1.0);
    assert_true(hdrp_cull_blocker_blocks(b, at(0, 0, 0), v3(0, 0, -1)) == 0.0f);
    assert_true(hdrp_cull_blocker_blocks(b, at(0, 0, 1), v3(0, 0, 0)) == 0.0f);
    assert_true(hdrp_cull_blocker_blocks(b, at(5, 0, 0), v3(-5, 0, 0)) == 0.0f);
    assert_true(hdrp_cull_blocker_blocks(b, hdrp_v4_make(1.0f, 0.0f, 0.0f, 0.0f), v3(-5, 0, -1)) ==
                0.0f);
}

static void walls_of_no_size_and_positions_that_are_not_numbers_block_nothing(void** state)
{
    (void)state;
    double sizes[] = {0.0, -1.0, (double)NAN};
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(wall(sizes[i], 1.0).bits.x, HDRP_CULL_BLOCKER_NONE);
        assert_int_equal(wall(1.0, sizes[i]).bits.x, HDRP_CULL_BLOCKER_NONE);
        assert_true(hdrp_cull_blocker_blocks(wall(sizes[i], 1.0), at(0, 0, 1), v3(0, 0, -1)) ==
                    0.0f);
    }
    hdrp_cull_blocker lost =
        hdrp_cull_blocker_rectangle(v3((double)NAN, 0, 0), v3(0, 0, 1), v3(0, 1, 0), 1.0f, 1.0f);
    assert_int_equal(lost.bits.x, HDRP_CULL_BLOCKER_NONE);
    assert_true(hdrp_cull_blocker_blocks(wall(1, 1), at((double)NAN, 0, 1), v3(0, 0, -1)) == 0.0f);
    assert_true(hdrp_cull_blocker_blocks(wall(1, 1), at(0, 0, 1), v3(0, 0, (double)NAN)) == 0.0f);
    assert_true(hdrp_cull_blocker_blocks(hdrp_cull_blocker_plane(v3(0, 0, 0), v3(0, 0, 1)),
                                         at(0, 0, 1), v3(0, 0, (double)NAN)) == 0.0f);
}

static void a_plane_blocks_all_behind_it_wherever_the_light_is(void** state)
{
    (void)state;
    hdrp_cull_blocker b = hdrp_cull_blocker_plane(v3(0, 2, 0), v3(0, 5, 0));
    assert_int_equal(b.bits.x, HDRP_CULL_BLOCKER_PLANE);
    for (int i = -3; i <= 7; ++i) {
        assert_true(hdrp_cull_blocker_blocks(b, at(0, i, 0), v3(100, 1.9, -7)) == 1.0f);
        assert_true(hdrp_cull_blocker_blocks(b, at(0, i, 0), v3(100, 2.1, -7)) == 0.0f);
        assert_true(hdrp_cull_blocker_blocks(b, at(0, i, 0), v3(0, 2, 0)) == 0.0f);
    }
}

static void lights_come_from_where_their_records_say(void** state)
{
    (void)state;
    hdrp_v3 one = v3(1, 1, 1);
    hdrp_light sun = hdrp_light_directional(v3(0, -2, 0), one, 0.0f);
    hdrp_light box =
        hdrp_light_box(v3(1, 2, 3), v3(0, 0, -1), v3(0, 1, 0), one, 5.0f, 1.0f, 1.0f, 0.0f);
    hdrp_light lamp = hdrp_light_point(v3(1, 2, 3), one, 5.0f);
    hdrp_light spot = hdrp_light_spot(v3(4, 2, 3), v3(0, -1, 0), one, 5.0f, 0.1f, 0.2f);
    hdrp_v4 p = hdrp_cull_light_place(sun);
    assert_true(p.x == 0.0f && p.y == 1.0f && p.z == 0.0f && p.w == 0.0f);
    p = hdrp_cull_light_place(box);
    assert_true(p.x == 0.0f && p.y == 0.0f && p.z == 1.0f && p.w == 0.0f);
    p = hdrp_cull_light_place(lamp);
    assert_true(p.x == 1.0f && p.y == 2.0f && p.z == 3.0f && p.w == 1.0f);
    p = hdrp_cull_light_place(spot);
    assert_true(p.x == 4.0f && p.w == 1.0f);
}

static void negative_lights_count_with_a_minus(void** state)
{
    (void)state;
    hdrp_light lamp = hdrp_light_point(v3(1, 2, 3), v3(1, 1, 1), 5.0f);
    assert_true(hdrp_light_sign(lamp) == 1.0f);
    lamp.bits.x |= HDRP_LIGHT_FEATURE_SHADOW | HDRP_LIGHT_FEATURE_COOKIE;
    assert_true(hdrp_light_sign(lamp) == 1.0f);
    lamp.bits.x |= HDRP_LIGHT_FEATURE_NEGATIVE;
    assert_true(hdrp_light_sign(lamp) == -1.0f);
    assert_int_equal(hdrp_light_type(lamp), HDRP_LIGHT_TYPE_POINT);
}

static void random_positions_are_blocked_where_a_ray_meets_the_rectangle(void** state)
{
    (void)state;
    uint64_t seed = 1;
    int wrong = 0, blocked = 0, count = 400000;
    for (int i = 0; i < count; ++i) {
        double scale = test_log(&seed, 1e-3, 1e4);
        test_v3 c = test_mad(test_vec(0, 0, 0), test_direction(&seed), scale);
        test_v3 l = test_direction(&seed);
        test_v3 p = test_mad(c, test_direction(&seed), scale * test_random(&seed));
        hdrp_v4 light = hdrp_v4_from_v3(test_float(l), 0.0f);
        hdrp_cull_blocker b = hdrp_cull_blocker_rectangle(
            test_float(c), test_float(test_direction(&seed)), test_float(test_direction(&seed)),
            (float)(scale * test_random(&seed)), (float)(scale * test_random(&seed)));
        if (i % 4 != 0) {
            light = hdrp_v4_from_v3(test_float(test_mad(c, l, scale)), 1.0f);
        }
        test_v3 rounded = test_vec((double)(float)p.x, (double)(float)p.y, (double)(float)p.z);
        bool expected = test_blocks(&b, light, rounded);
        /* Rounding may decide where a rectangle a little larger or smaller is answered otherwise. */
        hdrp_cull_blocker more = b, less = b;
        more.right_half.w += (float)(1e-5 * scale);
        more.up_half.w += (float)(1e-5 * scale);
        less.right_half.w -= (float)(1e-5 * scale);
        less.up_half.w -= (float)(1e-5 * scale);
        if (test_blocks(&more, light, rounded) != test_blocks(&less, light, rounded)) {
            continue;
        }
        blocked += expected;
        wrong += (hdrp_cull_blocker_blocks(b, light, test_float(p)) > 0.0f) != expected;
    }
    assert_in_range(blocked, count / 20, count / 2);
    assert_int_equal(wrong, 0);
}

static void portals_open_blockers_and_shares_multiply(void** state)
{
    (void)state;
    for (int i = 0; i < 8; ++i) {
        float visible = (float)(i & 1), blocks = (float)(i >> 1 & 1), through = (float)(i >> 2);
        float expected = visible > 0.0f && (blocks == 0.0f || through > 0.0f) ? 1.0f : 0.0f;
        assert_true(hdrp_cull_blocker_visible(visible, blocks, through) == expected);
    }
    assert_true(hdrp_cull_blocker_visible(0.5f, 0.5f, 0.5f) == 0.375f);
}

static void classes_of_blockers_and_portals_combine(void** state)
{
    (void)state;
    const uint32_t n = HDRP_CULL_SHADOW_NONE, w = HDRP_CULL_SHADOW_WHOLE,
                   p = HDRP_CULL_SHADOW_PIXEL;
    const uint32_t expected[3][3] = {{n, n, n}, {w, n, p}, {p, n, p}};
    for (uint32_t b = 0; b < 3; ++b) {
        for (uint32_t k = 0; k < 3; ++k) {
            assert_int_equal(hdrp_cull_shadow_through(b, k), expected[b][k]);
        }
    }
}

/* What a grid of n^3 positions of a cell says: 1 some are lit, 2 some are blocked. */
static int look(const test_cell* c, const hdrp_cull_blocker* b, hdrp_v4 light, int n)
{
    int seen = 0;
    for (int i = 0; i < n * n * n && seen != 3; ++i) {
        double k = n - 1;
        test_v3 p = test_place(c, i % n / k, i / n % n / k, i / n / n / k);
        seen |= test_blocks(b, light, p) ? 2 : 1;
    }
    return seen;
}

/* Whether one of n^2 lines of the shadow, from the light through the rectangle and on, meets a cell: a
 * grid of positions misses shadows that are thin. */
static bool shadow_is_met(const test_cell* c, const hdrp_cull_blocker* b, hdrp_v4 light, int n)
{
    test_v3 axes[3] = {test_of(c->camera.right_far), test_of(c->camera.up),
                       test_of(c->camera.forward_orthographic)};
    test_v3 eye = test_of(c->camera.eye_near);
    hdrp_v4 w = c->camera.window;
    double du = (double)w.z / 1280.0, dv = (double)w.w / 720.0;
    double edges[4] = {(double)w.x + du * c->x0, (double)w.x + du * c->x1,
                       (double)w.y + dv * (720.0 - c->y1), (double)w.y + dv * (720.0 - c->y0)};
    double flat = (double)c->camera.forward_orthographic.w;
    for (int i = 0; i < n * n; ++i) {
        double x = i % n * 2.0 / (n - 1) - 1.0, y = i / n * 2.0 / (n - 1) - 1.0, t0 = 0.0,
               t1 = 1e30;
        test_v3 p =
            test_mad(test_of(b->center), test_of(b->right_half), x * (double)b->right_half.w);
        p = test_mad(p, test_of(b->up_half), y * (double)b->up_half.w);
        test_v3 way =
            test_mad(test_vec(p.x * (double)light.w, p.y * (double)light.w, p.z * (double)light.w),
                     test_of(light), -1.0);
        p = test_mad(p, eye, -1.0);
        double pz = test_dot(p, axes[2]), dz = test_dot(way, axes[2]);
        for (int k = 0; k < 6; ++k) {
            double side = k & 1 ? -1.0 : 1.0, f0, f1;
            if (k < 4) {
                f0 = side * (test_dot(p, axes[k / 2]) - edges[k] * (flat > 0.0 ? 1.0 : pz));
                f1 = side * (test_dot(way, axes[k / 2]) - edges[k] * (flat > 0.0 ? 0.0 : dz));
            } else {
                f0 = side * (pz - (double)(k == 4 ? c->depths.nearest : c->depths.farthest));
                f1 = side * dz;
            }
            t0 = f1 > 0.0 ? fmax(t0, -f0 / f1) : t0;
            t1 = f1 < 0.0 ? fmin(t1, -f0 / f1) : t1;
            t1 = f1 == 0.0 && f0 < 0.0 ? -1.0 : t1;
        }
        if (t0 <= t1) {
            return true;
        }
    }
    return false;
}

static uint32_t classify(const test_cell* c, const hdrp_cull_blocker* b, hdrp_v4 light)
{
    hdrp_cull_shadow s = hdrp_cull_shadow_make(
        hdrp_cull_blocker_in_view(*b, c->camera), hdrp_cull_light_place_in_view(light, c->camera),
        c->tile, c->depths, c->camera.forward_orthographic.w);
    return hdrp_cull_shadow_class(s, c->depths);
}

typedef struct tally {
    int count[3], wrong, needless;
} tally;

/* Positions as a shader has them, with the formula that it uses: same meaning as look. */
static int look_in_view(const test_cell* c, const hdrp_cull_blocker* b, hdrp_v4 light)
{
    hdrp_cull_blocker view = hdrp_cull_blocker_in_view(*b, c->camera);
    hdrp_v4 place = hdrp_cull_light_place_in_view(light, c->camera);
    float flat = c->camera.forward_orthographic.w;
    int seen = 0;
    for (int i = 0; i < 27; ++i) {
        float x = (float)c->x0 + (float)(i % 3) * 0.5f * (float)(c->x1 - c->x0);
        float y = (float)c->y0 + (float)(i / 3 % 3) * 0.5f * (float)(c->y1 - c->y0);
        float u = c->camera.window.x + c->camera.window.z * (x / 1280.0f);
        float v = c->camera.window.y + c->camera.window.w * (1.0f - y / 720.0f);
        float z = i < 9 ? c->depths.nearest : c->depths.farthest;
        z = i >= 18 ? c->depths.nearest * 0.5f + c->depths.farthest * 0.5f : z;
        hdrp_v3 p = hdrp_v3_make(flat > 0.0f ? u : u * z, flat > 0.0f ? v : v * z, z);
        seen |= hdrp_cull_blocker_blocks(view, place, p) > 0.0f ? 2 : 1;
    }
    return seen;
}

static void judge(tally* t, const test_cell* c, const hdrp_cull_blocker* b, hdrp_v4 light,
                  bool closely)
{
    uint32_t class_of = classify(c, b, light);
    int seen = look(c, b, light, 5);
    int seen_by_floats = look_in_view(c, b, light);
    t->count[class_of] += 1;
    t->wrong += class_of == HDRP_CULL_SHADOW_NONE && ((seen | seen_by_floats) & 2) != 0;
    t->wrong += class_of == HDRP_CULL_SHADOW_WHOLE && ((seen | seen_by_floats) & 1) != 0;
    if (closely && class_of == HDRP_CULL_SHADOW_PIXEL && seen != 3 && look(c, b, light, 20) != 3) {
        t->needless +=
            seen == 2 || b->bits.x == HDRP_CULL_BLOCKER_PLANE || !shadow_is_met(c, b, light, 64);
    }
}

static void report(const char* name, const tally* t)
{
    print_message("%s: none %d, whole %d, per pixel %d of which needless at most %d (%.2f %%)\n",
                  name, t->count[HDRP_CULL_SHADOW_NONE], t->count[HDRP_CULL_SHADOW_WHOLE],
                  t->count[HDRP_CULL_SHADOW_PIXEL], t->needless,
                  100.0 * t->needless / (t->count[HDRP_CULL_SHADOW_PIXEL] + 1e-9));
}

static void cells_are_never_classified_wrongly_and_seldom_per_pixel_for_nothing(void** state)
{
    (void)state;
    uint64_t seed = 2;
    for (int orthographic = 0; orthographic < 2; ++orthographic) {
        tally t = {0};
        for (int i = 0; i < 60000; ++i) {
            test_cell c = test_random_cell(&seed, orthographic == 1);
            hdrp_v4 light = test_random_light(&seed, &c);
            hdrp_cull_blocker b = test_random_blocker(&seed, &c, light);
            judge(&t, &c, &b, light, true);
        }
        report(orthographic ? "orthographic" : "perspective", &t);
        assert_int_equal(t.wrong, 0);
        for (int i = 0; i < 3; ++i) {
            assert_true(t.count[i] > 3000);
        }
        assert_true(t.needless < 0.005 * t.count[HDRP_CULL_SHADOW_PIXEL]);
    }
}

/* Lights in the plane of a rectangle, at its rim, or a hair in front of it. */
static hdrp_v4 light_close_to(uint64_t* seed, const hdrp_cull_blocker* b)
{
    double sides[4] = {-1.0, 0.0, 1.0, test_between(seed, -2.0, 2.0)};
    double size = (double)(b->right_half.w + b->up_half.w);
    double offset = test_log(seed, 1e-9, 1e-1) * size * (test_random(seed) < 0.5 ? -1.0 : 1.0);
    test_v3 p = test_mad(test_of(b->center), test_of(b->right_half),
                         sides[test_below(seed, 4)] * (double)b->right_half.w);
    p = test_mad(p, test_of(b->up_half), sides[test_below(seed, 4)] * (double)b->up_half.w);
    p = test_mad(p, test_of(b->front), test_random(seed) < 0.2 ? 0.0 : offset);
    return hdrp_v4_from_v3(test_float(p), 1.0f);
}

static void lights_close_to_blockers_are_no_exception(void** state)
{
    (void)state;
    uint64_t seed = 3;
    for (int orthographic = 0; orthographic < 2; ++orthographic) {
        tally t = {0};
        for (int i = 0; i < 40000; ++i) {
            test_cell c = test_random_cell(&seed, orthographic == 1);
            hdrp_v4 light = test_random_light(&seed, &c);
            hdrp_cull_blocker b = test_random_blocker(&seed, &c, light);
            judge(&t, &c, &b, light_close_to(&seed, &b), false);
        }
        assert_true(t.count[HDRP_CULL_SHADOW_NONE] > 1000);
        assert_true(t.count[HDRP_CULL_SHADOW_WHOLE] > 500);
        assert_int_equal(t.wrong, 0);
    }
}

/* A square that leans towards one of its corners, inside the picture: its shadow begins there, and
 * reaches the end of the picture; lit from the other side it is the other way round. */
static void shadows_begin_at_a_corner_of_their_blocker(void** state)
{
    const double lean = 0.6, half = 0.9, middle = 5.0;
    hdrp_cull_camera c = hdrp_cull_camera_orthographic(v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), -3, 3,
                                                       -3, 3, 0.5f, 50.0f);
    hdrp_cull_tile tile = hdrp_cull_tile_make(c, 0, 0, 100, 100, 100, 100);
    hdrp_cull_interval depths = {0.5f, 50.0f};
    (void)state;
    for (int k = 0; k < 4; ++k) {
        double x = k & 1 ? lean : -lean, y = k & 2 ? lean : -lean;
        hdrp_cull_blocker b = hdrp_cull_blocker_rectangle(v3(0, 0, middle), v3(x, y, 1),
                                                          v3(0, 1, 0), (float)half, (float)half);
        double deep = half * (fabs((double)b.right_half.z) + fabs((double)b.up_half.z));
        hdrp_cull_shadow s =
            hdrp_cull_shadow_make(b, hdrp_v4_make(0, 0, -1, 0), tile, depths, 1.0f);
        assert_true(deep > 0.5);
        assert_true((double)s.reached.nearest <= middle - deep);
        assert_true((double)s.reached.nearest >= middle - deep - 1e-4);
        assert_true(s.reached.farthest >= 50.0f);
        s = hdrp_cull_shadow_make(b, hdrp_v4_make(0, 0, 1, 0), tile, depths, 1.0f);
        assert_true((double)s.reached.farthest >= middle + deep);
        assert_true((double)s.reached.farthest <= middle + deep + 1e-4);
        assert_true(s.reached.nearest <= 0.5f);
    }
}

static void a_light_in_the_plane_of_a_wall_covers_nothing(void** state)
{
    (void)state;
    hdrp_cull_camera camera = hdrp_cull_camera_perspective(v3(0, 0, 5), v3(0, 0, -1), v3(0, 1, 0),
                                                           -1.0f, 1.0f, -1.0f, 1.0f, 0.1f, 100.0f);
    hdrp_cull_tile tile = hdrp_cull_tile_make(camera, 0.0f, 0.0f, 8.0f, 8.0f, 8.0f, 8.0f);
    hdrp_cull_interval depths = {6.0f, 7.0f};
    hdrp_cull_blocker b = hdrp_cull_blocker_in_view(wall(100.0, 100.0), camera);
    hdrp_cull_shadow in_plane = hdrp_cull_shadow_make(
        b, hdrp_cull_light_place_in_view(at(0, 0, 0), camera), tile, depths, 0.0f);
    hdrp_cull_shadow in_front = hdrp_cull_shadow_make(
        b, hdrp_cull_light_place_in_view(at(0, 0, 1), camera), tile, depths, 0.0f);
    hdrp_cull_shadow aside = hdrp_cull_shadow_make(
        b, hdrp_cull_light_place_in_view(at(200, 0, 0), camera), tile, depths, 0.0f);
    assert_int_equal(hdrp_cull_shadow_class(in_plane, depths), HDRP_CULL_SHADOW_PIXEL);
    assert_int_equal(hdrp_cull_shadow_class(in_front, depths), HDRP_CULL_SHADOW_WHOLE);
    assert_int_equal(hdrp_cull_shadow_class(aside, depths), HDRP_CULL_SHADOW_NONE);
    assert_true(fabsf(in_front.reached.nearest - 5.0f) < 1e-4f || in_front.reached.nearest == 0.0f);
    assert_true(fabsf(in_front.covered.nearest - 5.0f) < 1e-4f);
}

static void what_is_too_far_to_compute_with_is_left_to_pixels(void** state)
{
    (void)state;
    uint64_t seed = 4;
    test_cell c = test_random_cell(&seed, false);
    hdrp_cull_blocker b = wall(1.0, 1.0), far = wall(1.0, 1.0), none = wall(0.0, 1.0);
    far.center.x = 1e15f;
    assert_int_equal(classify(&c, &far, at(0, 0, 1)), HDRP_CULL_SHADOW_PIXEL);
    assert_int_equal(classify(&c, &b, at(0, 1e15, 1)), HDRP_CULL_SHADOW_PIXEL);
    b.right_half.w = 1e15f;
    assert_int_equal(classify(&c, &b, at(0, 0, 1)), HDRP_CULL_SHADOW_PIXEL);
    assert_int_equal(classify(&c, &none, at(0, 0, 1)), HDRP_CULL_SHADOW_NONE);
    assert_int_equal(classify(&c, &none, at(0, 1e15, 1)), HDRP_CULL_SHADOW_NONE);
}

/* ---- many lights ----------------------------------------------------------------------------- */

#define LIGHTS 12u
#define LINKS  64u
#define WALLS  160u
#define SLICES 6u

typedef struct scene {
    hdrp_v4 places[LIGHTS];
    hdrp_cull_blocker_links lights[LIGHTS];
    uint32_t links[LINKS];
    hdrp_cull_blocker blockers[WALLS];
    hdrp_cull_blocker_scene all;
} scene;

/* Walls with up to three holes, shared by lights; a hole may be larger than its wall, or elsewhere. */
static void make_scene(scene* s, uint64_t* seed, const test_cell* c)
{
    uint32_t walls = 40, next = walls;
    memset(s, 0, sizeof *s);
    for (uint32_t i = 0; i < LIGHTS; ++i) {
        s->places[i] = test_random_light(seed, c);
        s->lights[i].first = s->all.link_count;
        s->lights[i].count = test_below(seed, 5);
        s->all.link_count += s->lights[i].count;
    }
    for (uint32_t i = 0; i < s->all.link_count; ++i) {
        s->links[i] = test_below(seed, walls);
    }
    for (uint32_t i = 0; i < walls; ++i) {
        hdrp_v4 light = s->places[test_below(seed, LIGHTS)];
        uint32_t holes = test_below(seed, 4);
        s->blockers[i] = test_random_blocker(seed, c, light);
        s->blockers[i] = hdrp_cull_blocker_with_portals(s->blockers[i], next, holes);
        for (uint32_t k = 0; k < holes; ++k, ++next) {
            hdrp_cull_blocker hole = s->blockers[i];
            double x = test_between(seed, -1.0, 1.0) * (double)hole.right_half.w;
            test_v3 p = test_mad(test_of(hole.center), test_of(hole.right_half), x);
            hole.right_half.w *= (float)test_log(seed, 0.1, 2.0);
            hole.up_half.w *= (float)test_log(seed, 0.1, 2.0);
            hole.center = hdrp_v4_from_v3(test_float(p), 0.0f);
            hole.bits.y = hole.bits.z = 0;
            s->blockers[next] =
                test_random(seed) < 0.3 ? test_random_blocker(seed, c, light) : hole;
        }
    }
    s->all.places = s->places;
    s->all.lights = s->lights;
    s->all.links = s->links;
    s->all.blockers = s->blockers;
    s->all.light_count = LIGHTS;
    s->all.blocker_count = next;
}

static hdrp_cull_blocker_set make_set(const scene* s, const hdrp_cull_camera* camera, void** memory)
{
    hdrp_cull_blocker_set set;
    hdrp_cull_blocker_desc desc = {LIGHTS, LINKS, WALLS};
    size_t bytes = hdrp_cull_blocker_memory_size(&desc);
    *memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_int_equal(hdrp_cull_blocker_init(&set, &desc, *memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_blocker_begin(&set, &s->all, camera), HDRP_OK);
    uint32_t items = s->all.light_count + s->all.blocker_count, half = items / 2u;
    assert_int_equal(hdrp_cull_blocker_project(&set, half, items - half), HDRP_OK);
    assert_int_equal(hdrp_cull_blocker_project(&set, 0, half), HDRP_OK);
    return set;
}

static hdrp_cull_blocker_job begin(const hdrp_cull_blocker_set* set, void** scratch)
{
    hdrp_cull_blocker_job job;
    size_t bytes = hdrp_cull_blocker_scratch_size(set);
    *scratch = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    memset(*scratch, 0xff, bytes);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, set, *scratch, bytes), HDRP_OK);
    return job;
}

/* A slice of the depths of a cell. */
static test_cell slice_of(const test_cell* c, uint32_t k)
{
    test_cell r = *c;
    float lo = c->depths.nearest, hi = hdrp_min(c->depths.farthest, 1e6f);
    r.depths.nearest = lo + (hi - lo) * (float)k / (float)SLICES;
    r.depths.farthest = lo + (hi - lo) * ((float)k + 1.0f) / (float)SLICES;
    r.depths.farthest = k + 1u == SLICES ? c->depths.farthest : r.depths.farthest;
    return r;
}

static void masks_keep_all_that_decides_and_lights_go_that_are_kept_out(void** state)
{
    (void)state;
    uint64_t seed = 5;
    int wrong = 0, removed = 0, bits = 0, pairs = 0;
    for (int i = 0; i < 700; ++i) {
        test_cell c = test_random_cell(&seed, i % 4 == 0);
        scene s;
        void *memory, *scratch;
        make_scene(&s, &seed, &c);
        hdrp_cull_blocker_set set = make_set(&s, &c.camera, &memory);
        hdrp_cull_blocker_job job = begin(&set, &scratch);
        assert_int_equal(hdrp_cull_blocker_job_tile(&job, &c.tile, c.depths), HDRP_OK);
        for (uint32_t k = 0; k < SLICES * LIGHTS; ++k) {
            test_cell cell = slice_of(&c, k / LIGHTS);
            uint32_t light = k % LIGHTS, mask = 77;
            uint32_t stays = hdrp_cull_blocker_classify(&job, light, cell.depths, &mask);
            for (int q = 0; q < 64; ++q) {
                test_v3 p = test_place(&cell, q % 4 / 3.0, q / 4 % 4 / 3.0, q / 16 / 3.0);
                bool lit = test_reaches(&s.all, light, 0xffffffffu, p);
                wrong += lit != (stays && test_reaches(&s.all, light, mask, p));
            }
            assert_true(stays || mask == 0);
            assert_true(s.lights[light].count == 32u || mask >> s.lights[light].count == 0u);
            removed += !stays;
            pairs += (int)s.lights[light].count;
            for (uint32_t m = mask; m != 0u; m &= m - 1u) {
                ++bits;
            }
        }
        assert_int_equal(job.stats.lights, SLICES * LIGHTS);
        assert_true(job.stats.shadows <= set.pair_count);
        assert_true(job.stats.none + job.stats.whole + job.stats.pixel <=
                    SLICES * s.all.link_count);
        assert_true(job.stats.lights_removed == job.stats.whole);
        free(memory);
        free(scratch);
    }
    print_message("%d pairs in cells, %d bits left, %d lights removed\n", pairs, bits, removed);
    assert_int_equal(wrong, 0);
    assert_true(removed > 1000 && bits > 1000 && bits < pairs);
}

static void cells_do_not_depend_on_what_a_job_did_before(void** state)
{
    (void)state;
    uint64_t seed = 6;
    for (int i = 0; i < 100; ++i) {
        test_cell c = test_random_cell(&seed, false);
        hdrp_cull_tile tiles[4];
        scene s;
        void *memory, *scratch;
        uint32_t first[4 * SLICES * LIGHTS], again[4 * SLICES * LIGHTS], mask;
        make_scene(&s, &seed, &c);
        hdrp_cull_blocker_set set = make_set(&s, &c.camera, &memory);
        for (uint32_t t = 0; t < 4; ++t) {
            float x = (float)c.x0 + 64.0f * (float)t;
            tiles[t] = hdrp_cull_tile_make(c.camera, x, (float)c.y0, x + 64.0f, (float)c.y0 + 64.0f,
                                           1280.0f, 720.0f);
        }
        hdrp_cull_blocker_job job = begin(&set, &scratch);
        for (uint32_t k = 0; k < 4 * SLICES * LIGHTS; ++k) {
            if (k % (SLICES * LIGHTS) == 0u) {
                hdrp_cull_blocker_job_tile(&job, &tiles[k / (SLICES * LIGHTS)], c.depths);
            }
            test_cell cell = slice_of(&c, k / LIGHTS % SLICES);
            first[k] = hdrp_cull_blocker_classify(&job, k % LIGHTS, cell.depths, &mask) << 31;
            first[k] |= mask;
        }
        free(scratch);
        for (uint32_t t = 4; t-- > 0u;) { /* a job for each tile, from the last to the first cell */
            job = begin(&set, &scratch);
            hdrp_cull_blocker_job_tile(&job, &tiles[t], c.depths);
            for (uint32_t k = SLICES * LIGHTS; k-- > 0u;) {
                test_cell cell = slice_of(&c, k / LIGHTS);
                uint32_t* r = &again[t * SLICES * LIGHTS + k];
                *r = hdrp_cull_blocker_classify(&job, k % LIGHTS, cell.depths, &mask) << 31;
                *r |= mask;
            }
            free(scratch);
        }
        assert_memory_equal(first, again, sizeof first);
        free(memory);
    }
}

static void visibility_on_the_cpu_is_the_definition(void** state)
{
    (void)state;
    uint64_t seed = 7;
    int dark = 0, count = 0, other = 0;
    for (int i = 0; i < 300; ++i) {
        test_cell c = test_random_cell(&seed, false);
        scene s;
        make_scene(&s, &seed, &c);
        for (uint32_t light = 0; light < LIGHTS; ++light) {
            for (int q = 0; q < 8; ++q, ++count) {
                test_v3 p = test_place(&c, 0.2 + q % 2 * 0.5, 0.3 + q / 2 % 2 * 0.5, q / 4 * 0.01);
                hdrp_v3 f = test_float(p);
                p = test_vec((double)f.x, (double)f.y, (double)f.z);
                uint32_t mask = q % 2 ? 0xffffffffu : test_below(&seed, 32);
                bool expected = test_reaches(&s.all, light, mask, p);
                float visible = hdrp_cull_blocker_light_visible(&s.all, light, mask, f);
                assert_true(visible == 0.0f || visible == 1.0f);
                dark += !expected;
                other += expected != (visible > 0.0f);
            }
        }
        assert_true(hdrp_cull_blocker_light_visible(&s.all, LIGHTS, 0xffffffffu, v3(0, 0, 0)) ==
                    1.0f);
    }
    assert_true(hdrp_cull_blocker_light_visible(NULL, 0, 0xffffffffu, v3(0, 0, 0)) == 1.0f);
    assert_in_range(dark, count / 20, count / 2);
    assert_true(other * 1000 < count); /* positions at a rim */
}

static void bad_arguments_are_told_and_nothing_is_written(void** state)
{
    (void)state;
    hdrp_cull_blocker_desc desc = {LIGHTS, LINKS, WALLS}, bad;
    hdrp_cull_blocker_set set;
    hdrp_cull_blocker_job job;
    hdrp_cull_camera camera = hdrp_cull_camera_perspective(v3(0, 0, 5), v3(0, 0, -1), v3(0, 1, 0),
                                                           -1.0f, 1.0f, -1.0f, 1.0f, 0.1f, 100.0f);
    size_t bytes = hdrp_cull_blocker_memory_size(&desc);
    unsigned char* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes + HDRP_MEMORY_ALIGNMENT);
    uint64_t seed = 8;
    test_cell c = test_random_cell(&seed, false);
    scene s;
    make_scene(&s, &seed, &c);
    assert_int_equal(bytes % HDRP_MEMORY_ALIGNMENT, 0);
    assert_int_equal(hdrp_cull_blocker_memory_size(NULL), 0);
    for (int i = 0; i < 6; ++i) {
        uint32_t* member[3] = {&bad.light_capacity, &bad.link_capacity, &bad.blocker_capacity};
        bad = desc;
        *member[i / 2] = i % 2 ? 0x7fffffffu : 0u;
        assert_int_equal(hdrp_cull_blocker_memory_size(&bad), 0);
        assert_int_equal(hdrp_cull_blocker_init(&set, &bad, memory, bytes),
                         HDRP_ERROR_BAD_ARGUMENT);
    }
    assert_int_equal(hdrp_cull_blocker_init(NULL, &desc, memory, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_init(&set, NULL, memory, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_init(&set, &desc, NULL, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_init(&set, &desc, memory + 4, bytes),
                     HDRP_ERROR_MEMORY_ALIGNMENT);
    assert_int_equal(hdrp_cull_blocker_init(&set, &desc, memory, bytes - 1u),
                     HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(hdrp_cull_blocker_init(&set, &desc, memory, bytes), HDRP_OK);

    assert_int_equal(hdrp_cull_blocker_begin(NULL, &s.all, &camera), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_begin(&set, NULL, &camera), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_begin(&set, &s.all, NULL), HDRP_ERROR_NULL_POINTER);
    for (int i = 0; i < 11; ++i) {
        scene t = s;
        t.all.places = t.places;
        t.all.lights = t.lights;
        t.all.links = t.links;
        t.all.blockers = t.blockers;
        t.all.places = i == 0 ? NULL : t.all.places;
        t.all.lights = i == 1 ? NULL : t.all.lights;
        t.all.links = i == 2 ? NULL : t.all.links;
        t.all.blockers = i == 3 ? NULL : t.all.blockers;
        t.all.light_count = i == 4 ? LIGHTS + 1u : t.all.light_count;
        t.all.link_count = i == 5 ? LINKS + 1u : t.all.link_count;
        t.all.blocker_count = i == 6 ? WALLS + 1u : t.all.blocker_count;
        t.links[1] = i == 7 ? t.all.blocker_count : t.links[1];
        t.lights[2].first = i == 8 ? t.all.link_count + 1u : t.lights[2].first;
        t.lights[3].count = i == 9 ? HDRP_CULL_BLOCKERS_MAX + 1u : t.lights[3].count;
        t.blockers[0].bits.y = i == 10 ? t.all.blocker_count : t.blockers[0].bits.y;
        t.blockers[0].bits.z = i == 10 ? 1u : t.blockers[0].bits.z;
        assert_int_equal(hdrp_cull_blocker_begin(&set, &t.all, &camera),
                         i < 4 ? HDRP_ERROR_NULL_POINTER : HDRP_ERROR_BAD_ARGUMENT);
        assert_null(set.scene.places);
    }
    assert_int_equal(hdrp_cull_blocker_begin(&set, &s.all, &camera), HDRP_OK);
    uint32_t items = s.all.light_count + s.all.blocker_count;
    assert_int_equal(hdrp_cull_blocker_project(NULL, 0, 0), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_project(&set, 1, items), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_blocker_project(&set, items + 1u, 0), HDRP_ERROR_BAD_ARGUMENT);
    assert_int_equal(hdrp_cull_blocker_project(&set, 0, items), HDRP_OK);

    assert_int_equal(hdrp_cull_blocker_scratch_size(NULL), 0);
    bytes = hdrp_cull_blocker_scratch_size(&set);
    unsigned char* scratch = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes + HDRP_MEMORY_ALIGNMENT);
    assert_int_equal(hdrp_cull_blocker_job_begin(NULL, &set, scratch, bytes),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, NULL, scratch, bytes),
                     HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, &set, NULL, bytes), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, &set, scratch + 8, bytes),
                     HDRP_ERROR_MEMORY_ALIGNMENT);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, &set, scratch, bytes - 1u),
                     HDRP_ERROR_MEMORY_TOO_SMALL);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, &set, scratch, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_blocker_job_tile(NULL, &c.tile, c.depths), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_job_tile(&job, NULL, c.depths), HDRP_ERROR_NULL_POINTER);
    assert_int_equal(hdrp_cull_blocker_job_tile(&job, &c.tile, c.depths), HDRP_OK);
    uint32_t mask = 5;
    assert_int_equal(hdrp_cull_blocker_classify(&job, LIGHTS, c.depths, &mask), 1);
    assert_int_equal(mask, 0);
    free(memory);
    free(scratch);
}

static void an_empty_scene_needs_no_arrays(void** state)
{
    (void)state;
    hdrp_cull_blocker_desc desc = {1, 1, 1};
    hdrp_cull_blocker_scene none = {0};
    hdrp_cull_blocker_set set;
    hdrp_cull_blocker_job job;
    uint64_t seed = 9;
    test_cell c = test_random_cell(&seed, false);
    size_t bytes = hdrp_cull_blocker_memory_size(&desc);
    void* memory = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_int_equal(hdrp_cull_blocker_init(&set, &desc, memory, bytes), HDRP_OK);
    assert_int_equal(hdrp_cull_blocker_begin(&set, &none, &c.camera), HDRP_OK);
    assert_int_equal(hdrp_cull_blocker_project(&set, 0, 0), HDRP_OK);
    bytes = hdrp_cull_blocker_scratch_size(&set);
    assert_int_equal(bytes, HDRP_MEMORY_ALIGNMENT);
    void* scratch = aligned_alloc(HDRP_MEMORY_ALIGNMENT, bytes);
    assert_int_equal(hdrp_cull_blocker_job_begin(&job, &set, scratch, bytes), HDRP_OK);
    uint32_t mask = 5;
    assert_int_equal(hdrp_cull_blocker_classify(&job, 0, c.depths, &mask), 1);
    assert_int_equal(mask, 0);
    free(scratch);
    free(memory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_blocks_what_is_behind_it_and_nothing_else),
        cmocka_unit_test(what_is_in_the_plane_of_a_wall_is_not_blocked_by_it),
        cmocka_unit_test(walls_of_no_size_and_positions_that_are_not_numbers_block_nothing),
        cmocka_unit_test(a_plane_blocks_all_behind_it_wherever_the_light_is),
        cmocka_unit_test(lights_come_from_where_their_records_say),
        cmocka_unit_test(negative_lights_count_with_a_minus),
        cmocka_unit_test(random_positions_are_blocked_where_a_ray_meets_the_rectangle),
        cmocka_unit_test(portals_open_blockers_and_shares_multiply),
        cmocka_unit_test(classes_of_blockers_and_portals_combine),
        cmocka_unit_test(cells_are_never_classified_wrongly_and_seldom_per_pixel_for_nothing),
        cmocka_unit_test(lights_close_to_blockers_are_no_exception),
        cmocka_unit_test(shadows_begin_at_a_corner_of_their_blocker),
        cmocka_unit_test(a_light_in_the_plane_of_a_wall_covers_nothing),
        cmocka_unit_test(what_is_too_far_to_compute_with_is_left_to_pixels),
        cmocka_unit_test(masks_keep_all_that_decides_and_lights_go_that_are_kept_out),
        cmocka_unit_test(cells_do_not_depend_on_what_a_job_did_before),
        cmocka_unit_test(visibility_on_the_cpu_is_the_definition),
        cmocka_unit_test(bad_arguments_are_told_and_nothing_is_written),
        cmocka_unit_test(an_empty_scene_needs_no_arrays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
