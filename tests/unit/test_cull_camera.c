/* test_cull_camera.c - the cameras of hdrp_cull_volume.h.
 * SPDX-License-Identifier: MIT */
#include "cull_test.h"

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

static hdrp_cull_camera looking(hdrp_v3 forward, hdrp_v3 up)
{
    return hdrp_cull_camera_perspective(v3(0.0f, 0.0f, 0.0f), forward, up, -1.0f, 1.0f, -1.0f, 1.0f,
                                        0.1f, 100.0f);
}

/* Right, up and forward at right angles, and right-handed as seen from behind. */
static void expect_frame(hdrp_cull_camera c)
{
    dvec x = dv_from_v4(c.right_far), y = dv_from_v4(c.up), z = dv_from_v4(c.forward_orthographic);
    double lengths[] = {dv_length(x), dv_length(y), dv_length(z)};
    double cosines[] = {dv_dot(x, y), dv_dot(y, z), dv_dot(z, x)};
    for (int i = 0; i < 3; ++i) {
        assert_true(fabs(lengths[i] - 1.0) < 4e-7);
        if (!(fabs(cosines[i]) < 4e-7)) {
            fail_msg("cosine %d is %g: right %g %g %g, forward %g %g %g", i, cosines[i], x.x, x.y,
                     x.z, z.x, z.y, z.z);
        }
    }
    assert_true(dv_dot(dv_cross(x, z), y) > 0.99);
}

static void frames_are_orthonormal_whatever_the_directions(void** state)
{
    uint64_t random = 1;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        dvec f = test_direction(&random), aside = test_direction(&random);
        double near_to = test_log_uniform(&random, 1e-8, 10.0);
        double f_length = test_log_uniform(&random, 1e-25, 1e25);
        double up_length = test_log_uniform(&random, 1e-25, 1e25);
        dvec up = dv_mad(f, aside, near_to);
        expect_frame(looking(v3_from(dv_mad(dv(0, 0, 0), f, f_length)),
                             v3_from(dv_mad(dv(0, 0, 0), up, up_length))));
    }
}

static void up_points_upwards(void** state)
{
    hdrp_cull_camera c = looking(v3(0.0f, 0.0f, -2.0f), v3(0.0f, 3.0f, 0.0f));
    (void)state;
    assert_true(c.right_far.x == 1.0f && c.up.y == 1.0f && c.forward_orthographic.z == -1.0f);
    c = looking(v3(1.0f, 0.0f, 0.0f), v3(0.5f, 0.0f, 2.0f));
    assert_true(c.up.z == 1.0f && c.right_far.y == -1.0f);
}

static void a_camera_without_directions_looks_along_negative_z(void** state)
{
    const float bad[] = {0.0f, (float)NAN, (float)INFINITY, -(float)INFINITY, 1e-38f};
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        hdrp_v3 v = v3(bad[i], bad[i], bad[i]);
        hdrp_cull_camera c = looking(v, v3(0.0f, 1.0f, 0.0f));
        assert_true(c.forward_orthographic.z == -1.0f && c.up.y == 1.0f);
        expect_frame(c);
        c = looking(v3(0.0f, 0.0f, 1.0f), v);
        assert_true(c.forward_orthographic.z == 1.0f);
        expect_frame(c);
    }
    expect_frame(looking(v3(0.0f, 1.0f, 0.0f), v3(0.0f, 1.0f, 0.0f)));
    expect_frame(looking(v3(0.0f, -1.0f, 0.0f), v3(0.0f, 1.0f, 0.0f)));
}

static void depths_and_eyes_are_limited(void** state)
{
    const float nan = (float)NAN, inf = (float)INFINITY;
    hdrp_v3 z = v3(0.0f, 0.0f, 1.0f), y = v3(0.0f, 1.0f, 0.0f);
    hdrp_cull_camera c = hdrp_cull_camera_perspective(v3(nan, inf, -inf), z, y, -1.0f, 1.0f, -1.0f,
                                                      1.0f, 0.0f, -1.0f);
    (void)state;
    assert_true(c.eye_near.x == -1e18f && c.eye_near.y == 1e18f && c.eye_near.z == -1e18f);
    assert_true(c.eye_near.w == 1e-6f && c.right_far.w == 1e-6f);
    assert_true(c.forward_orthographic.w == 0.0f && c.up.w == 0.0f);
    c = hdrp_cull_camera_orthographic(v3(1.0f, 2.0f, 3.0f), z, y, -1.0f, 1.0f, -1.0f, 1.0f, inf,
                                      inf);
    assert_true(c.eye_near.w == 1e9f && c.right_far.w == HDRP_CULL_FAR_INFINITE);
    assert_true(c.forward_orthographic.w == 1.0f);
    assert_true(c.eye_near.x == 1.0f && c.eye_near.y == 2.0f && c.eye_near.z == 3.0f);
    c = hdrp_cull_camera_perspective(z, z, y, -1.0f, 1.0f, -1.0f, 1.0f, nan, nan);
    assert_true(c.eye_near.w == 1e-6f && c.right_far.w == 1e-6f);
    c = hdrp_cull_camera_perspective(z, z, y, -1.0f, 1.0f, -1.0f, 1.0f, 0.5f, 200.0f);
    assert_true(c.eye_near.w == 0.5f && c.right_far.w == 200.0f);
}

static void windows_may_be_off_centre_and_have_a_width(void** state)
{
    const float nan = (float)NAN, inf = (float)INFINITY;
    hdrp_v3 z = v3(0.0f, 0.0f, 1.0f), y = v3(0.0f, 1.0f, 0.0f);
    hdrp_cull_camera c =
        hdrp_cull_camera_perspective(z, z, y, 0.25f, 0.75f, -3.0f, -1.0f, 0.1f, 10.0f);
    (void)state;
    assert_true(c.window.x == 0.25f && c.window.z == 0.5f);
    assert_true(c.window.y == -3.0f && c.window.w == 2.0f);
    /* exchanged edges are put in order */
    c = hdrp_cull_camera_perspective(z, z, y, 0.75f, 0.25f, 1.0f, -1.0f, 0.1f, 10.0f);
    assert_true(c.window.x == 0.25f && c.window.z == 0.5f);
    assert_true(c.window.y == -1.0f && c.window.w == 2.0f);
    c = hdrp_cull_camera_perspective(z, z, y, -inf, inf, 1.0f, 1.0f, 0.1f, 10.0f);
    assert_true(c.window.x == -HDRP_CULL_TANGENT_MAX && c.window.z == 2 * HDRP_CULL_TANGENT_MAX);
    assert_true(c.window.y == 1.0f && c.window.w > 0.0f && c.window.w < 2e-6f);
    c = hdrp_cull_camera_perspective(z, z, y, nan, nan, 0.0f, 0.0f, 0.1f, 10.0f);
    assert_true(c.window.x == -HDRP_CULL_TANGENT_MAX && c.window.z > 0.0f);
    assert_true(c.window.y == 0.0f && c.window.w > 0.0f);
    c = hdrp_cull_camera_orthographic(z, z, y, -2e9f, 5.0f, -inf, inf, 0.1f, 10.0f);
    assert_true(c.window.x == -1e9f && c.window.y == -1e9f && c.window.w == 2e9f);
    c = hdrp_cull_camera_orthographic(z, z, y, -20.0f, 30.0f, 2.0f, 7.0f, 0.1f, 10.0f);
    assert_true(c.window.x == -20.0f && c.window.z == 50.0f);
    assert_true(c.window.y == 2.0f && c.window.w == 5.0f);
}

static void nothing_is_lost_far_from_the_origin(void** state)
{
    hdrp_v3 eye = v3(1e6f, -2e6f, 3e6f);
    hdrp_cull_camera c = hdrp_cull_camera_perspective(eye, v3(0.0f, 0.0f, -1.0f), v3(0, 1, 0),
                                                      -1.0f, 1.0f, -1.0f, 1.0f, 0.1f, 10.0f);
    hdrp_v3 p = hdrp_cull_view_from_world(v3(1e6f + 0.5f, -2e6f - 0.25f, 3e6f - 4.0f), c);
    (void)state;
    assert_true(p.x == 0.5f && p.y == -0.25f && p.z == 4.0f);
    p = hdrp_cull_view_from_world(eye, c);
    assert_true(p.x == 0.0f && p.y == 0.0f && p.z == 0.0f);
    p = hdrp_cull_view_from_world(v3(-1e18f, 1e18f, -1e18f), c);
    assert_true(p.x < -0.99e18f && p.y > 0.99e18f && p.z > 0.99e18f);
}

/* Back to the pixel that it was, whatever the camera. */
static void pixels_are_found_in_the_world(void** state)
{
    uint64_t random = 7;
    (void)state;
    for (int i = 0; i < 5000; ++i) {
        dvec f = test_direction(&random);
        hdrp_v3 forward = v3((float)f.x, (float)f.y, (float)f.z), up = v3(0.1f, 1.0f, 0.2f);
        bool flat = i % 2 == 1;
        hdrp_cull_camera c =
            flat ? hdrp_cull_camera_orthographic(v3(3, 4, 5), forward, up, -7, 9, -2, 5, 0.1f, 100)
                 : hdrp_cull_camera_perspective(v3(3, 4, 5), forward, up, -0.7f, 0.9f, -0.2f, 0.5f,
                                                0.1f, 100);
        float x = 320.0f * (float)(i % 31) / 31.0f, y = 200.0f * (float)(i % 17) / 17.0f;
        float z = (float)test_log_uniform(&random, 0.1, 100.0);
        hdrp_v3 offset = hdrp_cull_offset_of_pixel(c, x, y, 320.0f, 200.0f, z);
        hdrp_v3 p = hdrp_cull_view_from_world(hdrp_v3_add(offset, v3(3, 4, 5)), c);
        hdrp_v3 v = hdrp_cull_direction_to_eye(c, offset);
        float scale = flat ? 1.0f : z;
        assert_true(fabsf(p.z - z) < 2e-6f * (z + 10.0f));
        assert_true(fabsf((p.x / scale - c.window.x) / c.window.z * 320.0f - x) < 2e-3f);
        assert_true(fabsf((1.0f - (p.y / scale - c.window.y) / c.window.w) * 200.0f - y) < 2e-3f);
        assert_true(fabsf(hdrp_v3_length(v) - 1.0f) < 1e-6f);
        p = flat ? hdrp_v3_from_v4(c.forward_orthographic) : hdrp_v3_normalize(offset);
        assert_true(hdrp_v3_length(hdrp_v3_add(v, p)) < 1e-6f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_orthonormal_whatever_the_directions),
        cmocka_unit_test(up_points_upwards),
        cmocka_unit_test(a_camera_without_directions_looks_along_negative_z),
        cmocka_unit_test(depths_and_eyes_are_limited),
        cmocka_unit_test(windows_may_be_off_centre_and_have_a_width),
        cmocka_unit_test(nothing_is_lost_far_from_the_origin),
        cmocka_unit_test(pixels_are_found_in_the_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
