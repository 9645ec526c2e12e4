/* test_cull_shape.c - shapes of hdrp_cull_volume.h: makers, balls, planes, positions.
 * SPDX-License-Identifier: MIT */
#include "cull_test.h"

static const uint32_t kinds[] = {HDRP_CULL_KIND_BALL, HDRP_CULL_KIND_CONE, HDRP_CULL_KIND_PYRAMID,
                                 HDRP_CULL_KIND_BOX, HDRP_CULL_KIND_FRONT};

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

static void expect_kind(hdrp_cull_shape s, uint32_t kind, uint32_t category)
{
    assert_int_equal(hdrp_cull_shape_kind(s), kind);
    assert_int_equal(hdrp_cull_shape_category(s), category);
}

static void spheres_without_size_or_place_reach_nothing(void** state)
{
    const float nan = (float)NAN, inf = (float)INFINITY;
    hdrp_v3 p = v3(1.0f, 2.0f, 3.0f);
    hdrp_cull_shape s = hdrp_cull_shape_sphere(p, 5.0f, HDRP_CULL_CATEGORY_ENVIRONMENT);
    (void)state;
    expect_kind(s, HDRP_CULL_KIND_BALL, HDRP_CULL_CATEGORY_ENVIRONMENT);
    assert_true(s.center_range.x == 1.0f && s.center_range.w == 5.0f);
    assert_int_equal(s.bits.y, 0xffffffffu);
    assert_int_equal(s.bits.z, 0u);
    assert_true(hdrp_f32_from_bits(s.bits.w) == 1.0f);
    /* A frame like any other's, and an angle of half a turn: all around. */
    assert_true(s.right_half.x == 1.0f && s.up_half.y == 1.0f && s.forward_half.z == -1.0f);
    assert_true(s.half_angle.x == -1.0f && s.half_angle.z == -1.0f);
    expect_kind(hdrp_cull_shape_sphere(p, inf, 7u), HDRP_CULL_KIND_BALL, 3u);
    assert_true(hdrp_cull_shape_sphere(p, inf, 7u).center_range.w == 1e18f);
    expect_kind(hdrp_cull_shape_sphere(p, 0.0f, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_sphere(p, -1.0f, 1u), HDRP_CULL_KIND_NONE, 1u);
    expect_kind(hdrp_cull_shape_sphere(p, nan, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_sphere(v3(nan, 0, 0), 1.0f, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_sphere(v3(0, nan, 0), 1.0f, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_sphere(v3(0, 0, nan), 1.0f, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_sphere(v3(0, 1.01e18f, 0), 1.0f, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_sphere(v3(0, -1e18f, 0), 1.0f, 0u), HDRP_CULL_KIND_BALL, 0u);
    expect_kind(hdrp_cull_shape_sphere(v3(0, inf, -inf), 1.0f, 0u), HDRP_CULL_KIND_NONE, 0u);
}

static void boxes_may_be_flat_but_not_negative(void** state)
{
    const float nan = (float)NAN, inf = (float)INFINITY;
    hdrp_v3 o = v3(0, 0, 0), z = v3(0, 0, 1), y = v3(0, 1, 0);
    hdrp_cull_shape s =
        hdrp_cull_shape_box(v3(4, 5, 6), z, y, 1.0f, 2.0f, 3.0f, HDRP_CULL_CATEGORY_DECAL);
    (void)state;
    expect_kind(s, HDRP_CULL_KIND_BOX, HDRP_CULL_CATEGORY_DECAL);
    assert_true(s.right_half.w == 1.0f && s.up_half.w == 2.0f && s.forward_half.w == 3.0f);
    assert_true(s.center_range.z == 6.0f && s.center_range.w == 0.0f);
    assert_true(s.right_half.x == -1.0f && s.up_half.y == 1.0f && s.forward_half.z == 1.0f);
    expect_kind(hdrp_cull_shape_box(o, z, y, 0, 0, 0, 0u), HDRP_CULL_KIND_BOX, 0u);
    expect_kind(hdrp_cull_shape_box(o, z, y, -1, 1, 1, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_box(o, z, y, 1, nan, 1, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_box(o, z, y, 1, 1, -inf, 0u), HDRP_CULL_KIND_NONE, 0u);
    expect_kind(hdrp_cull_shape_box(v3(0, 0, nan), z, y, 1, 1, 1, 0u), HDRP_CULL_KIND_NONE, 0u);
    s = hdrp_cull_shape_box(o, v3(nan, 0, 0), v3(inf, 0, 0), inf, 1, 1, 5u);
    expect_kind(s, HDRP_CULL_KIND_BOX, 1u);
    assert_true(s.right_half.w == 1e18f && s.forward_half.z == -1.0f);
    assert_true(fabs(dv_length(dv_from_v4(s.right_half)) - 1.0) < 1e-6);
}

static hdrp_light of_type(hdrp_light light, uint32_t type)
{
    light.bits.x = (light.bits.x & ~HDRP_LIGHT_TYPE_MASK) | type;
    return light;
}

static void every_type_of_light_has_its_shape(void** state)
{
    static const struct {
        uint32_t type, kind, category;
    } expected[] = {
        {HDRP_LIGHT_TYPE_NONE, HDRP_CULL_KIND_NONE, HDRP_CULL_CATEGORY_PUNCTUAL},
        {HDRP_LIGHT_TYPE_DIRECTIONAL, HDRP_CULL_KIND_BALL, HDRP_CULL_CATEGORY_PUNCTUAL},
        {HDRP_LIGHT_TYPE_POINT, HDRP_CULL_KIND_BALL, HDRP_CULL_CATEGORY_PUNCTUAL},
        {HDRP_LIGHT_TYPE_SPOT, HDRP_CULL_KIND_CONE, HDRP_CULL_CATEGORY_PUNCTUAL},
        {HDRP_LIGHT_TYPE_PYRAMID, HDRP_CULL_KIND_PYRAMID, HDRP_CULL_CATEGORY_PUNCTUAL},
        {HDRP_LIGHT_TYPE_BOX, HDRP_CULL_KIND_BOX, HDRP_CULL_CATEGORY_PUNCTUAL},
        {HDRP_LIGHT_TYPE_SPHERE, HDRP_CULL_KIND_BALL, HDRP_CULL_CATEGORY_AREA},
        {HDRP_LIGHT_TYPE_DISC, HDRP_CULL_KIND_FRONT, HDRP_CULL_CATEGORY_AREA},
        {HDRP_LIGHT_TYPE_RECTANGLE, HDRP_CULL_KIND_FRONT, HDRP_CULL_CATEGORY_AREA},
        {HDRP_LIGHT_TYPE_LINE, HDRP_CULL_KIND_BOX, HDRP_CULL_CATEGORY_AREA},
        {200u, HDRP_CULL_KIND_NONE, HDRP_CULL_CATEGORY_AREA},
    };
    hdrp_light light = hdrp_light_point(v3(1, 2, 3), v3(4, 5, 6), 7.0f);
    (void)state;
    light.right_half_width.w = 2.0f;
    light.up_half_height.w = 3.0f;
    light.forward_radius.w = 0.5f;
    light.bits.x |= HDRP_LIGHT_FEATURE_COOKIE;
    light.bits.y = 0x1234u;
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; ++i) {
        hdrp_cull_shape s = hdrp_cull_shape_from_light(of_type(light, expected[i].type));
        expect_kind(s, expected[i].kind, expected[i].category);
        assert_int_equal(s.bits.y, 0x1234u);
        assert_int_equal(s.bits.z & 0xffu,
                         HDRP_CULL_FEATURE_OF_TYPE(expected[i].type & 15u) & 255u);
        assert_int_equal(s.bits.z >> 16, HDRP_LIGHT_FEATURE_COOKIE >> 8);
        assert_true(hdrp_f32_from_bits(s.bits.w) == 6.0f);
    }
    light.position_range.w = 0.0f;
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; ++i) {
        hdrp_cull_shape s = hdrp_cull_shape_from_light(of_type(light, expected[i].type));
        assert_int_equal(hdrp_cull_shape_kind(s), HDRP_CULL_KIND_NONE);
    }
}

static float importance_of(hdrp_cull_shape s)
{
    return hdrp_f32_from_bits(s.bits.w);
}

static void any_shape_may_have_features_layers_and_importance(void** state)
{
    hdrp_cull_shape probe = hdrp_cull_shape_sphere(v3(1, 2, 3), 4.0f, 2u);
    hdrp_cull_shape decal = hdrp_cull_shape_box(v3(1, 2, 3), v3(0, 0, 1), v3(0, 1, 0), 1, 2, 3, 3u);
    hdrp_cull_shape p = hdrp_cull_shape_with_features(probe, 0x80000001u, 6u, 2.5f);
    hdrp_cull_shape d = hdrp_cull_shape_with_features(decal, 7u, 0u, 1e30f);
    (void)state;
    assert_int_equal(p.bits.y, 6u);
    assert_int_equal(p.bits.z, 0x80000001u);
    assert_true(importance_of(p) == 2.5f && importance_of(d) == 1e30f);
    /* Nothing else has changed. */
    expect_kind(d, HDRP_CULL_KIND_BOX, HDRP_CULL_CATEGORY_DECAL);
    d.bits = decal.bits;
    p.bits.y = probe.bits.y;
    p.bits.z = probe.bits.z;
    p.bits.w = probe.bits.w;
    assert_memory_equal(&d, &decal, sizeof d);
    assert_memory_equal(&p, &probe, sizeof p);
}

static void shapes_have_an_effect_on_the_layers_they_share(void** state)
{
    hdrp_cull_shape s = hdrp_cull_shape_sphere(v3(0, 0, 0), 1.0f, 0u);
    (void)state;
    assert_int_equal(hdrp_cull_shape_in_layers(s, 0x80000000u), 1u);
    assert_int_equal(hdrp_cull_shape_in_layers(s, 0u), 0u);
    s = hdrp_cull_shape_with_features(s, 0xffffffffu, 0x80000004u, 1.0f);
    assert_int_equal(hdrp_cull_shape_in_layers(s, 0x80000000u), 1u);
    assert_int_equal(hdrp_cull_shape_in_layers(s, 0x7ffffffbu), 0u);
    assert_int_equal(hdrp_cull_shape_in_layers(s, 0x7fffffffu), 1u);
}

/* Lists rank by the bits of importance: whatever it was, they are those of a number from 0 on. */
static void importance_is_a_number_that_is_not_negative(void** state)
{
    const float given[] = {
        0.0f,   -0.0f, -1.0f,        (float)NAN,     -(float)NAN, -(float)INFINITY,
        1e-45f, 3.0f,  HDRP_FLT_MAX, (float)INFINITY};
    const float expected[] = {0, 0, 0, 0, 0, 0, 1e-45f, 3.0f, HDRP_FLT_MAX, HDRP_FLT_MAX};
    hdrp_light light = hdrp_light_point(v3(1, 2, 3), v3(4, 5, 6), 7.0f);
    hdrp_cull_shape s = hdrp_cull_shape_sphere(v3(0, 0, 0), 1.0f, 0u);
    (void)state;
    for (size_t i = 0; i < sizeof given / sizeof given[0]; ++i) {
        light.edge_importance.w = given[i];
        assert_int_equal(hdrp_cull_shape_from_light(light).bits.w, hdrp_bits_from_f32(expected[i]));
        assert_int_equal(hdrp_cull_shape_with_features(s, 0u, 0u, given[i]).bits.w,
                         hdrp_bits_from_f32(expected[i]));
    }
}

static void area_lights_reach_their_range_from_their_surface(void** state)
{
    hdrp_light light =
        hdrp_light_box(v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), v3(1, 1, 1), 2.0f, 3.0f, 10.0f, 0.1f);
    hdrp_cull_shape s = hdrp_cull_shape_from_light(light);
    (void)state;
    /* The box of a projector begins at its position, in view space. */
    hdrp_cull_camera eye =
        hdrp_cull_camera_orthographic(v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), -1, 1, -1, 1, 1, 2);
    hdrp_cull_shape seen = hdrp_cull_shape_in_view(s, eye);
    assert_true(seen.center_range.z == 5.0f && seen.center_range.w == 0.0f &&
                seen.forward_half.w == 5.0f);
    assert_true(s.right_half.w == 2.0f && s.up_half.w == 3.0f);
    light.forward_radius.w = 0.5f;
    s = hdrp_cull_shape_from_light(of_type(light, HDRP_LIGHT_TYPE_SPHERE));
    assert_true(s.center_range.z == 0.0f && s.center_range.w == 10.5f);
    s = hdrp_cull_shape_from_light(of_type(light, HDRP_LIGHT_TYPE_DISC));
    assert_true(s.right_half.w == 0.5f && s.up_half.w == 0.5f && s.forward_half.w == 0.0f);
    assert_true(s.center_range.w == 10.0f);
    s = hdrp_cull_shape_from_light(of_type(light, HDRP_LIGHT_TYPE_RECTANGLE));
    assert_true(s.right_half.w == 2.0f && s.up_half.w == 3.0f && s.forward_half.w == 0.0f);
    s = hdrp_cull_shape_from_light(of_type(light, HDRP_LIGHT_TYPE_LINE));
    assert_true(s.right_half.w == 2.0f && s.up_half.w == 0.0f && s.center_range.w == 10.0f);
    light.position_range.w = 1e18f;
    s = hdrp_cull_shape_from_light(of_type(light, HDRP_LIGHT_TYPE_SPHERE));
    assert_true(s.center_range.w == 1e18f);
}

static void what_is_far_or_endless_becomes_a_ball_around_the_eye(void** state)
{
    hdrp_v3 z = v3(0, 0, 1), y = v3(0, 1, 0), far_away = v3(0, 2e12f, 0);
    hdrp_cull_camera c = hdrp_cull_camera_perspective(v3(0, 0, 0), z, y, -1, 1, -1, 1, 0.1f, 1e18f);
    hdrp_cull_shape s = hdrp_cull_shape_in_view(hdrp_cull_shape_sphere(far_away, 1.0f, 2u), c);
    (void)state;
    expect_kind(s, HDRP_CULL_KIND_BALL, 2u);
    assert_true(s.center_range.y == 0.0f && s.center_range.w == 1e18f);
    s = hdrp_cull_shape_in_view(hdrp_cull_shape_sphere(v3(1, 1, 1), 1e18f, 0u), c);
    assert_true(s.center_range.y == 0.0f && s.center_range.w == 1e18f);
    s = hdrp_cull_shape_in_view(hdrp_cull_shape_box(v3(1, 1, 1), z, y, 1, 2e12f, 1, 3u), c);
    expect_kind(s, HDRP_CULL_KIND_BALL, 3u);
    assert_true(s.center_range.w == 1e18f);
    s = hdrp_cull_shape_in_view(hdrp_cull_shape_sphere(far_away, -1.0f, 0u), c);
    expect_kind(s, HDRP_CULL_KIND_NONE, 0u);
    s = hdrp_cull_shape_in_view(hdrp_cull_shape_sphere(v3(1, 2, 3), 4.0f, 0u), c);
    assert_true(s.center_range.y == 2.0f && s.center_range.z == 3.0f && s.center_range.w == 4.0f);
    assert_true(s.center_range.x == -1.0f); /* this camera's right is -x */
    s = hdrp_cull_shape_in_view(hdrp_cull_shape_from_light(hdrp_light_directional(z, y, 0.0f)), c);
    expect_kind(s, HDRP_CULL_KIND_BALL, 0u);
    assert_true(s.center_range.w == 1e18f);
}

/* Rounding errors of positions are measured by this. */
static double scale_of(const body* b)
{
    return dv_length(b->center) + body_size(b);
}

static void balls_contain_their_shapes_and_fit(void** state)
{
    uint64_t random = 2;
    (void)state;
    for (int i = 0; i < 4000; ++i) {
        hdrp_cull_shape s = test_shape(kinds[i % 5], &random);
        body b = body_of(s);
        hdrp_v4 ball = hdrp_cull_shape_ball(s);
        double true_radius = b.range;
        if (b.kind >= HDRP_CULL_KIND_BOX) {
            true_radius += sqrt(b.half_x * b.half_x + b.half_y * b.half_y + b.half_z * b.half_z);
        }
        assert_true((double)ball.w >= true_radius);
        assert_true((double)ball.w <= true_radius + 4e-6 * scale_of(&b));
        for (int k = 0; k < 16; ++k) {
            dvec p = body_point(&b, &random);
            assert_true(dv_length(dv_mad(p, dv_from_v4(ball), -1.0)) <= (double)ball.w);
        }
    }
    assert_true(hdrp_cull_shape_ball(hdrp_cull_shape_sphere(v3(1, 2, 3), -1.0f, 0u)).w == 0.0f);
}

static void planes_enclose_their_shapes_and_touch_them(void** state)
{
    uint64_t random = 3;
    int outlines = 0;
    (void)state;
    for (int i = 0; i < 10000; ++i) {
        hdrp_cull_shape s = test_shape(kinds[1 + i % 4], &random);
        body b = body_of(s);
        uint32_t count = hdrp_cull_shape_plane_count(s);
        float flat = i & 8 ? 1.0f : 0.0f;
        assert_true(count <= HDRP_CULL_PLANES_MAX);
        for (uint32_t k = 0; k < count; ++k) {
            hdrp_v4 plane = hdrp_cull_shape_plane(s, k, flat);
            dvec n = dv_from_v4(plane);
            double scale = scale_of(&b), support;
            if (dv_length(n) == 0.0) {
                assert_true(plane.w == 1.0f);
                continue;
            }
            assert_true(fabs(dv_length(n) - 1.0) < 1e-6);
            /* hdrp_cull_interval_plane counts a plane as 1e-6 of the distance farther out. */
            support = body_support(&b, n);
            if (!(support <= (double)plane.w + 1e-6 * scale)) {
                fail_msg("kind %u plane %u of shape %d cuts off %g of %g", b.kind, k, i,
                         support - (double)plane.w, scale);
            }
            if (!((double)plane.w - support <= 2e-5 * scale)) {
                fail_msg("kind %u plane %u of shape %d is %g of %g away", b.kind, k, i,
                         (double)plane.w - support, scale);
            }
            outlines += k >= 6u ? 1 : 0;
        }
    }
    assert_true(outlines > 10000);
}

/* Seen from outside, a sharp box has four or six edges in its outline; the planes of the eye and
 * these edges pass through the eye. */
static void planes_of_an_outline_pass_through_the_eye(void** state)
{
    static const hdrp_v3 places[] = {{0, 0, 50}, {0, 20, 50}, {20, 20, 50}, {-9, 14, -30}};
    static const int edges[] = {4, 6, 6, 6};
    (void)state;
    for (size_t i = 0; i < 4; ++i) {
        hdrp_cull_shape s =
            hdrp_cull_shape_box(places[i], v3(0, 0, 1), v3(0, 1, 0), 3.0f, 4.0f, 5.0f, 0u);
        int through = 0, others = 0;
        for (uint32_t k = 6; k < hdrp_cull_shape_plane_count(s); ++k) {
            hdrp_v4 plane = hdrp_cull_shape_plane(s, k, 0.0f);
            others += dv_length(dv_from_v4(plane)) == 0.0 ? 0 : 1;
            through += dv_length(dv_from_v4(plane)) > 0.0 && fabsf(plane.w) < 1e-3f ? 1 : 0;
        }
        if (i == 1) { /* 20 is beside the box, 0 is not */
            assert_true(through >= 4);
        }
        assert_int_equal(through, edges[i]);
        assert_int_equal(others, edges[i]);
    }
    /* An orthographic eye looks along z: normals of outlines are across. */
    hdrp_cull_shape s =
        hdrp_cull_shape_box(v3(7, 8, 9), v3(1, 2, 3), v3(0, 1, 0), 3.0f, 4.0f, 5.0f, 0u);
    for (uint32_t k = 6; k < 12u; ++k) {
        assert_true(fabsf(hdrp_cull_shape_plane(s, k, 1.0f).z) < 1e-6f);
        assert_true(hdrp_cull_shape_plane(s, k, 1.0f).w != 1.0f);
    }
    /* From inside there is no outline. */
    s = hdrp_cull_shape_box(v3(0, 0, 0), v3(1, 2, 3), v3(0, 1, 0), 3.0f, 4.0f, 5.0f, 0u);
    for (uint32_t k = 6; k < 12u; ++k) {
        assert_true(hdrp_cull_shape_plane(s, k, 0.0f).w == 1.0f);
    }
}

static void outlines_of_cones_and_pyramids_pass_through_the_eye(void** state)
{
    const hdrp_v3 white = {1, 1, 1};
    hdrp_cull_shape cone = hdrp_cull_shape_from_light(
        hdrp_light_spot(v3(1, 2, 30), v3(1, 0.2f, 0.1f), white, 10.0f, 0.1f, 0.3f));
    hdrp_cull_shape pyramid = hdrp_cull_shape_from_light(hdrp_light_pyramid(
        v3(1, 2, 30), v3(1, 0.2f, 0.1f), v3(0, 1, 0), white, 10.0f, 0.3f, 0.2f, 0.5f));
    int through = 0;
    (void)state;
    for (uint32_t k = 8; k < 10u; ++k) {
        hdrp_v4 plane = hdrp_cull_shape_plane(cone, k, 0.0f);
        assert_true(dv_length(dv_from_v4(plane)) > 0.5 && fabsf(plane.w) < 2e-4f);
    }
    for (uint32_t k = 6; k < 10u; ++k) {
        hdrp_v4 plane = hdrp_cull_shape_plane(pyramid, k, 0.0f);
        through += dv_length(dv_from_v4(plane)) > 0.5 && fabsf(plane.w) < 2e-4f ? 1 : 0;
    }
    assert_int_equal(through, 2);
    /* From inside the cone there is no such side. */
    cone = hdrp_cull_shape_from_light(
        hdrp_light_spot(v3(0, 0, -1), v3(0, 0, 1), white, 10.0f, 0.1f, 0.3f));
    assert_true(hdrp_cull_shape_plane(cone, 8u, 0.0f).w == 1.0f);
    assert_true(hdrp_cull_shape_plane(cone, 9u, 0.0f).w == 1.0f);
}

/* Seen from outside its apex, a pyramid has two edges in its outline, and each of its planes has one
 * of them in it. */
static void outlines_of_pyramids_hold_two_edges(void** state)
{
    uint64_t random = 8;
    int with_two = 0;
    (void)state;
    for (int i = 0; i < 4000; ++i) {
        dvec f = test_direction(&random);
        float x = (float)test_uniform(&random, 0.2, 1.2),
              y = (float)test_uniform(&random, 0.2, 1.2);
        body b;
        hdrp_cull_shape s = hdrp_cull_shape_from_light(hdrp_light_pyramid(
            v3(3, 4, 30), v3_from(f), v3(0, 1, 0), v3(1, 1, 1), 10.0f, x, y, 0.5f));
        dvec outline[4];
        int count = 0;
        b = body_of(s);
        for (uint32_t k = 6; k < 10u; ++k) {
            hdrp_v4 plane = hdrp_cull_shape_plane(s, k, i & 1 ? 1.0f : 0.0f);
            double most = -1.0;
            if (dv_length(dv_from_v4(plane)) == 0.0) {
                continue;
            }
            for (int edge = 0; edge < 4; ++edge) {
                dvec e = dv_mad(b.forward, b.right, (edge & 1 ? 1 : -1) * tan(b.angle_x));
                e = dv_unit(dv_mad(e, b.up, (edge & 2 ? 1 : -1) * tan(b.angle_y)));
                most = fmax(most, dv_dot(e, dv_from_v4(plane)));
            }
            assert_true(fabs(most) < 1e-5);
            outline[count++] = dv_from_v4(plane);
        }
        assert_true(count <= 2);
        with_two += count == 2 && dv_dot(outline[0], outline[1]) < 0.999 ? 1 : 0;
    }
    assert_true(with_two > 2000);
}

/* Sides of a cone are an eighth of a turn apart. */
static void sides_of_cones_are_all_around(void** state)
{
    const float angle = 0.3f;
    hdrp_cull_shape s = hdrp_cull_shape_from_light(
        hdrp_light_spot(v3(1, 2, 30), v3(0, 0, 1), v3(1, 1, 1), 10.0f, 0.1f, angle));
    (void)state;
    for (uint32_t k = 0; k < 8u; ++k) {
        double turn = 0.25 * TEST_PI * (double)k, cosine = cos((double)angle);
        dvec n = dv_from_v4(hdrp_cull_shape_plane(s, k, 0.0f));
        assert_true(fabs(dv_dot(n, dv_from_v4(s.right_half)) - cos(turn) * cosine) < 1e-5);
        assert_true(fabs(dv_dot(n, dv_from_v4(s.up_half)) - sin(turn) * cosine) < 1e-5);
        assert_true(fabs(n.z + sin((double)angle)) < 1e-5);
    }
    /* An orthographic eye looks along z: outlines have normals across. */
    s = hdrp_cull_shape_from_light(
        hdrp_light_spot(v3(1, 2, 30), v3(1, 0.2f, 0.4f), v3(1, 1, 1), 10.0f, 0.1f, angle));
    for (uint32_t k = 8; k < 10u; ++k) {
        hdrp_v4 plane = hdrp_cull_shape_plane(s, k, 1.0f);
        assert_true(dv_length(dv_from_v4(plane)) > 0.5 && fabsf(plane.z) < 1e-5f);
    }
}

static void balls_and_wide_cones_have_no_planes(void** state)
{
    hdrp_cull_shape s = hdrp_cull_shape_sphere(v3(0, 0, 1), 1.0f, 0u);
    (void)state;
    assert_int_equal(hdrp_cull_shape_plane_count(s), 0u);
    assert_true(hdrp_cull_shape_plane(s, 0u, 0.0f).w == 1.0f);
    assert_int_equal(hdrp_cull_shape_plane_count(hdrp_cull_shape_sphere(v3(0, 0, 1), 0, 0u)), 0u);
    s = hdrp_cull_shape_from_light(
        hdrp_light_spot(v3(0, 0, 5), v3(0, 0, 1), v3(1, 1, 1), 3.0f, 0.0f, 2.5f));
    expect_kind(s, HDRP_CULL_KIND_CONE, 0u);
    assert_int_equal(hdrp_cull_shape_plane_count(s), 0u);
    /* But it has an inside and an outside. */
    assert_true(hdrp_cull_shape_contains(s, v3(0, 0, 6)) == 1.0f);
    assert_true(hdrp_cull_shape_contains(s, v3(2, 0, 5)) == 1.0f);
    assert_true(hdrp_cull_shape_contains(s, v3(0, 0, 3)) == 0.0f);
    assert_true(hdrp_cull_shape_contains(s, v3(0, 0, 9)) == 0.0f);
}

static void positions_are_inside_where_the_definition_says_so(void** state)
{
    uint64_t random = 4;
    int inside = 0, outside = 0;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_cull_shape s = test_shape(kinds[i % 5], &random);
        body b = body_of(s);
        double size = body_size(&b);
        for (int k = 0; k < 8; ++k) {
            dvec p = body_point(&b, &random);
            hdrp_v3 q;
            double out, scale;
            if (k & 1) {
                p = dv_mad(p, test_direction(&random),
                           size * test_log_uniform(&random, 1e-7, 10.0));
            }
            q = v3_from(p);
            p = dv_from(q);
            out = body_outside(&b, p);
            scale = dv_length(p) + dv_length(b.center) + size;
            if (out <= 0.0 || (!(k & 1) && out < 3e-7 * scale)) {
                ++inside;
                if (hdrp_cull_shape_contains(s, q) != 1.0f) {
                    fail_msg("kind %u: %g of %g inside, yet not contained", b.kind, -out, scale);
                }
            } else if (out > 5e-6 * scale) {
                ++outside;
                if (hdrp_cull_shape_contains(s, q) != 0.0f) {
                    fail_msg("kind %u: %g of %g outside, yet contained", b.kind, out, scale);
                }
            }
        }
    }
    assert_true(inside > 40000 && outside > 10000);
    assert_true(hdrp_cull_shape_contains(hdrp_cull_shape_sphere(v3(0, 0, 0), 0.0f, 0u),
                                         v3(0, 0, 0)) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_without_size_or_place_reach_nothing),
        cmocka_unit_test(boxes_may_be_flat_but_not_negative),
        cmocka_unit_test(every_type_of_light_has_its_shape),
        cmocka_unit_test(any_shape_may_have_features_layers_and_importance),
        cmocka_unit_test(shapes_have_an_effect_on_the_layers_they_share),
        cmocka_unit_test(importance_is_a_number_that_is_not_negative),
        cmocka_unit_test(area_lights_reach_their_range_from_their_surface),
        cmocka_unit_test(what_is_far_or_endless_becomes_a_ball_around_the_eye),
        cmocka_unit_test(balls_contain_their_shapes_and_fit),
        cmocka_unit_test(planes_enclose_their_shapes_and_touch_them),
        cmocka_unit_test(planes_of_an_outline_pass_through_the_eye),
        cmocka_unit_test(outlines_of_cones_and_pyramids_pass_through_the_eye),
        cmocka_unit_test(outlines_of_pyramids_hold_two_edges),
        cmocka_unit_test(sides_of_cones_are_all_around),
        cmocka_unit_test(balls_and_wide_cones_have_no_planes),
        cmocka_unit_test(positions_are_inside_where_the_definition_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
