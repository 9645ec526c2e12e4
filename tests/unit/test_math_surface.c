/* test_math_surface.c - surface gradients of hdrp_math.h on surfaces whose normals are known.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hdrp_math.h"

static const hdrp_v3 x_axis = {1.0f, 0.0f, 0.0f};
static const hdrp_v3 y_axis = {0.0f, 1.0f, 0.0f};
static const hdrp_v3 z_axis = {0.0f, 0.0f, 1.0f};

static uint32_t seed = 1u;

static float random_float(float lo, float hi)
{
    seed = hdrp_hash1(seed);
    return hdrp_lerp(lo, hi, hdrp_unit_from_u32(seed));
}

static hdrp_v3 random_direction(void)
{
    float x = random_float(0.0f, 1.0f);
    return hdrp_sphere_uniform(hdrp_v2_make(x, random_float(0.0f, 1.0f)));
}

static hdrp_v3 random_tangent(hdrp_v3 n)
{
    return hdrp_normalize_or(hdrp_v3_cross(n, random_direction()), x_axis);
}

static float separation(hdrp_v3 a, hdrp_v3 b)
{
    return hdrp_v3_length(hdrp_v3_sub(a, b));
}

static void expect_near(hdrp_v3 a, hdrp_v3 b, float tolerance)
{
    assert_true(separation(a, b) <= tolerance);
}

static int is_zero(hdrp_v3 v)
{
    return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f;
}

static hdrp_v3 normal_of(hdrp_v3 n, hdrp_v2 derivative, hdrp_v3 tangent, hdrp_v3 bitangent)
{
    return hdrp_normal_from_surface_gradient(
        n, hdrp_surface_gradient_from_derivative(derivative, tangent, bitangent));
}

/* >>vertex frames */

static void a_vertex_frame_gives_the_classical_transform(void** state)
{
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_v3 n = hdrp_v3_scale(random_direction(), random_float(0.3f, 1.0f));
        /* as interpolated: not unit, not orthogonal */
        hdrp_v3 t = hdrp_v3_mad(random_tangent(n), n, random_float(-0.1f, 0.1f));
        float side = i % 2 ? 1.0f : -1.0f;
        hdrp_v3 b = hdrp_v3_scale(hdrp_v3_cross(n, t), side);
        hdrp_v3 m = random_direction();
        m.z = hdrp_abs(m.z) + 0.3f;
        hdrp_v3 classical =
            hdrp_v3_add(hdrp_v3_mad(hdrp_v3_scale(t, m.x), b, m.y), hdrp_v3_scale(n, m.z));
        hdrp_surface_frame f = hdrp_surface_frame_from_vertex(n, t, side);
        hdrp_v3 ours =
            normal_of(f.normal, hdrp_derivative_from_normal(m, 1.0f), f.tangent, f.bitangent);
        expect_near(ours, hdrp_v3_normalize(classical), 2e-6f);
    }
}

static void a_vertex_frame_without_normal_keeps_the_surface_flat(void** state)
{
    (void)state;
    hdrp_surface_frame f = hdrp_surface_frame_from_vertex(hdrp_v3_splat(0.0f), x_axis, 1.0f);
    assert_true(f.normal.z == 1.0f && is_zero(f.tangent) && is_zero(f.bitangent));
    f = hdrp_surface_frame_from_vertex(y_axis, hdrp_v3_splat(0.0f), 1.0f);
    expect_near(normal_of(f.normal, hdrp_v2_make(5.0f, -3.0f), f.tangent, f.bitangent), y_axis,
                0.0f);
    f = hdrp_surface_frame_from_vertex(z_axis, x_axis, NAN);
    expect_near(f.bitangent, y_axis, 0.0f);
}

static void a_back_face_keeps_the_texture_directions(void** state)
{
    (void)state;
    hdrp_v3 n = random_direction(), t = random_tangent(n);
    hdrp_surface_frame front = hdrp_surface_frame_from_vertex(n, t, -1.0f);
    hdrp_surface_frame back = hdrp_surface_frame_from_vertex(hdrp_v3_neg(n), t, 1.0f);
    expect_near(front.bitangent, back.bitangent, 1e-6f);
    expect_near(front.tangent, back.tangent, 1e-6f);
}

static void a_thin_sheet_seen_from_behind_has_the_opposite_normal(void** state)
{
    (void)state;
    hdrp_v3 n = random_direction();
    hdrp_v3 gradient = hdrp_v3_scale(random_tangent(n), 0.7f);
    hdrp_v3 front = hdrp_normal_from_surface_gradient(n, gradient);
    hdrp_v3 sheet = hdrp_normal_from_surface_gradient(hdrp_v3_neg(n), hdrp_v3_neg(gradient));
    hdrp_v3 bump = hdrp_normal_from_surface_gradient(hdrp_v3_neg(n), gradient);
    expect_near(sheet, hdrp_v3_neg(front), 1e-6f);
    /* a bump that sticks out on both sides: only the part along n differs */
    expect_near(bump, hdrp_v3_mad(front, n, -2.0f * hdrp_v3_dot(front, n)), 1e-6f);
}

/* >>frames from screen derivatives */

/* A plane through random axes with UVs that are rotated, scaled and maybe mirrored, seen on a
 * rotated pixel grid whose y runs up or down. */
static void any_uv_set_of_a_plane_gives_its_axes(void** state)
{
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_v3 n = random_direction(), right = random_tangent(n), up = hdrp_v3_cross(n, right);
        float turn = random_float(0.0f, 6.2f), mirror = i & 1 ? -1.0f : 1.0f;
        float down = i & 2 ? -1.0f : 1.0f, face = i & 4 ? -1.0f : 1.0f;
        float su = random_float(0.01f, 100.0f), sv = random_float(0.01f, 100.0f);
        hdrp_sincos_result a = hdrp_sincos(turn);
        hdrp_v3 u = hdrp_v3_mad(hdrp_v3_scale(right, a.cosine), up, a.sine);
        hdrp_v3 v = hdrp_v3_scale(hdrp_v3_mad(hdrp_v3_scale(right, -a.sine), up, a.cosine), mirror);
        hdrp_v3 dx = hdrp_v3_scale(right, 0.01f), dy = hdrp_v3_scale(up, 0.02f * down);
        hdrp_v2 duv_dx = hdrp_v2_make(hdrp_v3_dot(dx, u) * su, hdrp_v3_dot(dx, v) * sv);
        hdrp_v2 duv_dy = hdrp_v2_make(hdrp_v3_dot(dy, u) * su, hdrp_v3_dot(dy, v) * sv);
        hdrp_surface_footprint f =
            hdrp_surface_footprint_from_position(hdrp_v3_scale(n, face), dx, dy);
        hdrp_basis basis = hdrp_basis_from_uv(f, duv_dx, duv_dy);
        expect_near(basis.tangent, u, 2e-5f);
        expect_near(basis.bitangent, v, 2e-5f);
    }
}

static void a_sphere_has_meridians_and_parallels_for_tangents(void** state)
{
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        float longitude = random_float(-3.0f, 3.0f), latitude = random_float(-1.3f, 1.3f);
        hdrp_sincos_result a = hdrp_sincos(longitude), b = hdrp_sincos(latitude);
        hdrp_v3 n = hdrp_v3_make(a.cosine * b.cosine, a.sine * b.cosine, b.sine);
        hdrp_v3 east = hdrp_v3_make(-a.sine, a.cosine, 0.0f), north = hdrp_v3_cross(n, east);
        /* two pixel steps in longitude and latitude, and what they do to a sphere of radius 3 */
        hdrp_v2 dx = hdrp_v2_make(random_float(0.5f, 1.0f), random_float(-0.4f, 0.4f));
        hdrp_v2 dy = hdrp_v2_make(random_float(-0.4f, 0.4f), random_float(0.5f, 1.0f));
        hdrp_v3 px = hdrp_v3_mad(hdrp_v3_scale(east, 3.0f * b.cosine * dx.x), north, 3.0f * dx.y);
        hdrp_v3 py = hdrp_v3_mad(hdrp_v3_scale(east, 3.0f * b.cosine * dy.x), north, 3.0f * dy.y);
        hdrp_surface_footprint f = hdrp_surface_footprint_from_position(n, px, py);
        hdrp_basis basis = hdrp_basis_from_uv(f, dx, dy);
        expect_near(basis.tangent, east, 1e-5f);
        expect_near(basis.bitangent, north, 1e-5f);
    }
}

static void degenerate_derivatives_keep_the_surface_flat(void** state)
{
    (void)state;
    hdrp_v3 zero = hdrp_v3_splat(0.0f), huge = hdrp_v3_splat(HDRP_FLT_MAX);
    hdrp_v3 odd = hdrp_v3_make(0.3f, -0.7f, 0.0f);
    hdrp_v3 pairs[][2] = {{zero, zero},
                          {x_axis, zero},
                          {odd, hdrp_v3_scale(odd, -3.0f)},
                          {hdrp_v3_make(0.1f, 0.3f, 0.0f), hdrp_v3_make(0.3f, 0.9f, 0.0f)},
                          {z_axis, z_axis},
                          {x_axis, z_axis},
                          {huge, x_axis},
                          {hdrp_v3_make(NAN, 0.0f, 0.0f), y_axis},
                          {hdrp_v3_make(INFINITY, 0.0f, 0.0f), y_axis}};
    for (int i = 0; i < 9; ++i) {
        hdrp_surface_footprint f =
            hdrp_surface_footprint_from_position(z_axis, pairs[i][0], pairs[i][1]);
        hdrp_basis basis =
            hdrp_basis_from_uv(f, hdrp_v2_make(1.0f, 0.0f), hdrp_v2_make(0.0f, 1.0f));
        assert_true(f.area == 0.0f && is_zero(f.sigma_x) && is_zero(f.sigma_y));
        assert_true(is_zero(basis.tangent) && is_zero(basis.bitangent));
        assert_true(is_zero(hdrp_surface_gradient_from_height(f, 3.0f, 4.0f)));
    }
    hdrp_surface_footprint good = hdrp_surface_footprint_from_position(z_axis, x_axis, y_axis);
    hdrp_v2 uvs[][2] = {{{0.0f, 0.0f}, {0.0f, 0.0f}},    {{1.0f, 2.0f}, {2.0f, 4.0f}},
                        {{0.0f, 1.0f}, {0.0f, 3.0f}},    {{0.1f, 0.3f}, {0.3f, 0.9f}},
                        {{NAN, 0.0f}, {0.0f, 1.0f}},     {{INFINITY, 0.0f}, {0.0f, 1.0f}},
                        {{1e-30f, 0.0f}, {0.0f, 1e-30f}}};
    for (int i = 0; i < 7; ++i) {
        hdrp_basis basis = hdrp_basis_from_uv(good, uvs[i][0], uvs[i][1]);
        assert_true(is_zero(basis.tangent) && is_zero(basis.bitangent));
    }
}

/* >>heights */

/* A quadratic height field: its central difference is exact. */
static void a_height_map_gives_the_normal_of_its_height_field(void** state)
{
    (void)state;
    for (int i = 0; i < 1000; ++i) {
        float a = random_float(-2.0f, 2.0f), b = random_float(-2.0f, 2.0f);
        float c = random_float(-2.0f, 2.0f), s = random_float(0.01f, 0.1f);
        /* h(x, y) = a x + b y + c x x */
        hdrp_v2 slope = hdrp_derivative_from_heights(-a * s + c * s * s, a * s + c * s * s, -b * s,
                                                     b * s, hdrp_v2_make(s, s));
        expect_near(normal_of(z_axis, slope, x_axis, y_axis),
                    hdrp_v3_normalize(hdrp_v3_make(-a, -b, 1.0f)), 2e-6f);
    }
}

/* The sphere |p| = 1 displaced along its normal by h = 1e-4 sin(k p), whose slope reaches 2: the
 * normal of the displaced surface, in double and by differences, against three sources. */
static void wave(const double p[3], const double k[3], double out[3])
{
    double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    double phase = (k[0] * p[0] + k[1] * p[1] + k[2] * p[2]) / length;
    for (int i = 0; i < 3; ++i) {
        out[i] = p[i] / length * (1.0 + 1e-4 * sin(phase));
    }
}

static hdrp_v3 displaced_normal(hdrp_v3 n, hdrp_v3 t, hdrp_v3 b, const double k[3])
{
    double corner[4][3];
    double step = 1e-8;
    for (int i = 0; i < 4; ++i) {
        double s = i < 2 ? (i ? step : -step) : 0.0, r = i < 2 ? 0.0 : (i == 3 ? step : -step);
        double p[3] = {(double)n.x + s * (double)t.x + r * (double)b.x,
                       (double)n.y + s * (double)t.y + r * (double)b.y,
                       (double)n.z + s * (double)t.z + r * (double)b.z};
        wave(p, k, corner[i]);
    }
    double x[3], y[3];
    for (int i = 0; i < 3; ++i) {
        x[i] = (corner[1][i] - corner[0][i]) / step;
        y[i] = (corner[3][i] - corner[2][i]) / step;
    }
    return hdrp_v3_normalize(hdrp_v3_make((float)(x[1] * y[2] - x[2] * y[1]),
                                          (float)(x[2] * y[0] - x[0] * y[2]),
                                          (float)(x[0] * y[1] - x[1] * y[0])));
}

static void a_displaced_sphere_has_the_normal_of_its_gradient(void** state)
{
    (void)state;
    for (int i = 0; i < 500; ++i) {
        hdrp_v3 n = random_direction(), t = random_tangent(n), b = hdrp_v3_cross(n, t);
        hdrp_v3 w = hdrp_v3_scale(random_direction(), 2e4f);
        double k[3] = {(double)w.x, (double)w.y, (double)w.z};
        double phase =
            (k[0] * (double)n.x + k[1] * (double)n.y + k[2] * (double)n.z) /
            sqrt((double)n.x * (double)n.x + (double)n.y * (double)n.y + (double)n.z * (double)n.z);
        hdrp_v3 gradient = hdrp_v3_scale(w, (float)(1e-4 * cos(phase)));
        hdrp_v3 expected = displaced_normal(n, t, b, k);
        hdrp_v3 volume = hdrp_surface_gradient_from_volume(n, gradient);
        /* a pixel that is 2e-3 by 3e-3 in size and skewed */
        hdrp_v3 dx = hdrp_v3_scale(t, 2e-3f), dy = hdrp_v3_mad(hdrp_v3_scale(t, 1e-3f), b, -3e-3f);
        hdrp_surface_footprint f = hdrp_surface_footprint_from_position(n, dx, dy);
        hdrp_v3 height = hdrp_surface_gradient_from_height(f, hdrp_v3_dot(gradient, dx),
                                                           hdrp_v3_dot(gradient, dy));
        expect_near(hdrp_normal_from_surface_gradient(n, volume), expected, 5e-4f);
        expect_near(hdrp_normal_from_surface_gradient(n, height), expected, 5e-4f);
        expect_near(hdrp_surface_gradient_from_normal(n, expected), volume, 5e-3f);
    }
}

/* >>textures */

static void every_texture_format_of_a_normal_gives_the_same_derivative(void** state)
{
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        hdrp_v3 m = random_direction();
        m.z = hdrp_abs(m.z) + 0.05f;
        m = hdrp_v3_normalize(m);
        hdrp_v3 c = hdrp_v3_mad(hdrp_v3_splat(0.5f), m, 0.5f);
        hdrp_v2 rgb = hdrp_derivative_from_normal(hdrp_normal_from_rgb(c), 2.0f);
        hdrp_v2 dxt5nm = hdrp_derivative_from_normal(
            hdrp_normal_from_ag(hdrp_v4_make(1.0f, c.y, 1.0f, c.x)), 2.0f);
        hdrp_v2 bc5 = hdrp_derivative_from_normal(
            hdrp_normal_from_ag(hdrp_v4_make(c.x, c.y, 0.0f, 1.0f)), 2.0f);
        float size = 1.0f + hdrp_abs(rgb.x) + hdrp_abs(rgb.y);
        assert_true(hdrp_abs(rgb.x * m.z + 2.0f * m.x) < 2e-5f * size);
        assert_true(hdrp_abs(rgb.y * m.z + 2.0f * m.y) < 2e-5f * size);
        assert_true(dxt5nm.x == bc5.x && dxt5nm.y == bc5.y);
        assert_true(hdrp_abs(bc5.x - rgb.x) < 2e-4f * size * size);
        assert_true(hdrp_abs(bc5.y - rgb.y) < 2e-4f * size * size);
    }
}

static void texels_without_a_usable_normal_are_flat_or_limited(void** state)
{
    (void)state;
    hdrp_v2 d = hdrp_derivative_from_normal(hdrp_normal_from_rgb(hdrp_v3_splat(0.5f)), 1.0f);
    assert_true(d.x == 0.0f && d.y == 0.0f);
    d = hdrp_derivative_from_normal(hdrp_v3_make(0.0f, 0.0f, -1.0f), 1.0f);
    assert_true(d.x == 0.0f && d.y == 0.0f);
    d = hdrp_derivative_from_normal(hdrp_v3_make(0.6f, 0.8f, -0.5f), 1.0f);
    assert_true(hdrp_abs(d.x + 0.6f * 128.0f) < 1e-4f && hdrp_abs(d.y + 0.8f * 128.0f) < 1e-4f);
    d = hdrp_derivative_from_normal(hdrp_v3_make(0.0f, -1.0f, 0.0f), -0.5f);
    assert_true(d.x == 0.0f && d.y == -64.0f);
    d = hdrp_derivative_from_normal(hdrp_normal_from_xy(1.0f, 1.0f), 1.0f);
    assert_true(hdrp_abs(hdrp_sqrt(hdrp_v2_dot(d, d)) - 128.0f) < 1e-3f);
    hdrp_v3 n = hdrp_normal_from_xy(-1.0f, 1.0f);
    assert_true(n.z == 0.0f && hdrp_abs(hdrp_v3_length(n) - 1.0f) < 1e-6f);
    assert_true(hdrp_normal_from_xy(0.0f, 0.0f).z == 1.0f);
    assert_true(fabsf(hdrp_v3_length(hdrp_normal_from_xy(1.0003f, 0.0f)) - 1.0f) < 1e-6f);
    d = hdrp_derivative_from_normal(hdrp_v3_make(1e-45f, 0.0f, 0.0f), 1e6f);
    assert_true(isfinite(d.x) && isfinite(d.y));
}

/* >>object-space normals */

static void normals_at_and_below_the_horizon_keep_the_largest_slope(void** state)
{
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        hdrp_v3 n = random_direction(), t = random_tangent(n);
        hdrp_sincos_result a = hdrp_sincos(random_float(1.57f, 3.0f));
        hdrp_v3 v = hdrp_v3_mad(hdrp_v3_scale(n, a.cosine), t, a.sine);
        hdrp_v3 g = hdrp_surface_gradient_from_normal(n, v);
        assert_true(hdrp_abs(hdrp_v3_length(g) - HDRP_SLOPE_MAX) < 1e-3f);
        expect_near(hdrp_normal_from_surface_gradient(n, g), t, 0.008f);
        assert_true(hdrp_v3_length(hdrp_surface_gradient_from_normal(n, hdrp_v3_neg(n))) == 0.0f);
        assert_true(hdrp_v3_length(hdrp_surface_gradient_from_normal(n, n)) < 1e-6f);
    }
}

static void an_object_space_normal_without_direction_is_flat(void** state)
{
    (void)state;
    float bad[] = {0.0f, NAN, INFINITY};
    for (int i = 0; i < 3; ++i) {
        hdrp_v3 g = hdrp_surface_gradient_from_normal(y_axis, hdrp_v3_splat(bad[i]));
        assert_true(is_zero(g));
    }
    hdrp_v3 small = hdrp_v3_make(1e-45f, 1e-45f, 0.0f), large = hdrp_v3_make(3e38f, 3e38f, 0.0f);
    expect_near(hdrp_surface_gradient_from_normal(y_axis, small), hdrp_v3_neg(x_axis), 1e-6f);
    expect_near(hdrp_surface_gradient_from_normal(y_axis, large), hdrp_v3_neg(x_axis), 1e-6f);
}

/* >>triplanar projection */

static float component(hdrp_v3 v, int axis)
{
    return axis == 0 ? v.x : (axis == 1 ? v.y : v.z);
}

/* A bump that rises along a coordinate leans the normal against it, on all six faces alike. */
static void triplanar_bumps_have_the_right_orientation_on_all_six_faces(void** state)
{
    (void)state;
    static const int look_up[3][2] = {{2, 1}, {0, 2}, {0, 1}};
    for (int face = 0; face < 6; ++face) {
        int axis = face / 2;
        float side = face % 2 ? -1.0f : 1.0f;
        hdrp_v3 axes[3] = {x_axis, y_axis, z_axis};
        hdrp_v3 n = hdrp_v3_scale(axes[axis], side), w = hdrp_triplanar_weights(n, 4.0f);
        assert_true(component(w, axis) == 1.0f && w.x + w.y + w.z == 1.0f);
        for (int k = 0; k < 2; ++k) {
            hdrp_v2 d[3] = {{0.0f, 0.0f}, {0.0f, 0.0f}, {0.0f, 0.0f}};
            d[axis] = hdrp_v2_make(k == 0 ? 0.5f : 0.0f, k == 1 ? 0.5f : 0.0f);
            hdrp_v3 g = hdrp_surface_gradient_from_triplanar(n, w, d[0], d[1], d[2]);
            hdrp_v3 r = hdrp_normal_from_surface_gradient(n, g);
            hdrp_v3 expected = hdrp_v3_mad(n, axes[look_up[axis][k]], -0.5f);
            expect_near(r, hdrp_v3_normalize(expected), 1e-6f);
        }
    }
}

static void triplanar_weights_sum_to_one_and_sharpen(void** state)
{
    (void)state;
    for (int i = 0; i < 5000; ++i) {
        hdrp_v3 n = random_direction();
        hdrp_v3 soft = hdrp_triplanar_weights(n, 1.0f), hard = hdrp_triplanar_weights(n, 16.0f);
        assert_true(hdrp_abs(hard.x + hard.y + hard.z - 1.0f) < 1e-6f);
        assert_true(hdrp_v3_max_component(hard) >= hdrp_v3_max_component(soft));
        float sum = hdrp_abs(n.x) + hdrp_abs(n.y) + hdrp_abs(n.z);
        assert_true(hdrp_abs(soft.y - hdrp_abs(n.y) / sum) < 1e-6f);
    }
    float bad[] = {0.0f, NAN, INFINITY};
    for (int i = 0; i < 3; ++i) {
        hdrp_v3 w = hdrp_triplanar_weights(hdrp_v3_splat(bad[i]), 4.0f);
        expect_near(w, hdrp_v3_splat(1.0f / 3.0f), 1e-6f);
    }
    hdrp_v3 limited = hdrp_triplanar_weights(hdrp_v3_make(1.0f, 0.5f, 0.0f), NAN);
    expect_near(limited, hdrp_v3_make(2.0f / 3.0f, 1.0f / 3.0f, 0.0f), 1e-6f);
}

/* Derivatives of a height in space are those of its three look-ups: a linear height in space is
 * seen the same by the volume and by the triplanar source, with any weights. */
static void a_linear_height_in_space_needs_no_particular_weights(void** state)
{
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        hdrp_v3 n = random_direction(), g = random_direction();
        hdrp_v3 r = hdrp_surface_gradient_from_volume(n, g);
        hdrp_v3 sum = hdrp_v3_splat(0.0f);
        hdrp_v2 d[3] = {{g.z, g.y}, {g.x, g.z}, {g.x, g.y}};
        /* each component of the gradient is in two of the three look-ups: weights of one half */
        sum = hdrp_surface_gradient_from_triplanar(n, hdrp_v3_splat(0.5f), d[0], d[1], d[2]);
        expect_near(sum, r, 1e-6f);
    }
}

/* >>blending and resolving */

static void layers_add_up_in_any_order(void** state)
{
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        hdrp_v3 n = random_direction(), layer[4], up = hdrp_v3_splat(0.0f), down = up;
        float weight[4];
        for (int k = 0; k < 4; ++k) {
            layer[k] = hdrp_v3_scale(random_tangent(n), random_float(0.0f, 4.0f));
            weight[k] = random_float(0.0f, 1.0f);
        }
        for (int k = 0; k < 4; ++k) {
            up = hdrp_v3_mad(up, layer[k], weight[k]);
            down = hdrp_v3_mad(down, layer[3 - k], weight[3 - k]);
        }
        expect_near(hdrp_normal_from_surface_gradient(n, up),
                    hdrp_normal_from_surface_gradient(n, down), 2e-6f);
    }
}

/* Adding derivatives in one frame is adding heights. */
static void gradients_are_linear_in_the_derivative(void** state)
{
    (void)state;
    for (int i = 0; i < 2000; ++i) {
        hdrp_v3 t = random_direction(), b = random_direction();
        hdrp_v2 p = hdrp_v2_make(random_float(-4.0f, 4.0f), random_float(-4.0f, 4.0f));
        hdrp_v2 q = hdrp_v2_make(random_float(-4.0f, 4.0f), random_float(-4.0f, 4.0f));
        float s = random_float(-2.0f, 2.0f);
        hdrp_v3 together =
            hdrp_surface_gradient_from_derivative(hdrp_v2_add(p, hdrp_v2_scale(q, s)), t, b);
        hdrp_v3 apart = hdrp_v3_mad(hdrp_surface_gradient_from_derivative(p, t, b),
                                    hdrp_surface_gradient_from_derivative(q, t, b), s);
        expect_near(together, apart, 1e-5f);
    }
}

static void a_resolved_normal_is_unit_and_above_the_surface(void** state)
{
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_v3 n = random_direction(), r;
        float length = hdrp_exp2(random_float(-140.0f, 127.0f));
        hdrp_v3 g = hdrp_v3_scale(i % 2 ? random_tangent(n) : random_direction(), length);
        r = hdrp_normal_from_surface_gradient(n, g);
        assert_true(hdrp_abs(hdrp_v3_length(r) - 1.0f) < 1e-6f);
        assert_true(hdrp_v3_dot(n, r) >= 9e-6f);
        r = hdrp_normal_from_surface_gradient_unclamped(n, g);
        assert_true(hdrp_abs(hdrp_v3_length(r) - 1.0f) < 1e-6f);
    }
}

static void a_gradient_that_cannot_be_resolved_gives_the_surface_normal(void** state)
{
    (void)state;
    hdrp_v3 n = z_axis;
    hdrp_v3 bad[] = {n,
                     hdrp_v3_splat(NAN),
                     hdrp_v3_splat(INFINITY),
                     hdrp_v3_splat(-INFINITY),
                     hdrp_v3_scale(n, 1e30f),
                     hdrp_v3_splat(0.0f)};
    for (int i = 0; i < 6; ++i) {
        expect_near(hdrp_normal_from_surface_gradient(n, bad[i]), n, 0.0f);
    }
    expect_near(hdrp_normal_from_surface_gradient_unclamped(n, hdrp_v3_scale(n, 3.0f)),
                hdrp_v3_neg(n), 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_vertex_frame_gives_the_classical_transform),
        cmocka_unit_test(a_vertex_frame_without_normal_keeps_the_surface_flat),
        cmocka_unit_test(a_back_face_keeps_the_texture_directions),
        cmocka_unit_test(a_thin_sheet_seen_from_behind_has_the_opposite_normal),
        cmocka_unit_test(any_uv_set_of_a_plane_gives_its_axes),
        cmocka_unit_test(a_sphere_has_meridians_and_parallels_for_tangents),
        cmocka_unit_test(degenerate_derivatives_keep_the_surface_flat),
        cmocka_unit_test(a_height_map_gives_the_normal_of_its_height_field),
        cmocka_unit_test(a_displaced_sphere_has_the_normal_of_its_gradient),
        cmocka_unit_test(every_texture_format_of_a_normal_gives_the_same_derivative),
        cmocka_unit_test(texels_without_a_usable_normal_are_flat_or_limited),
        cmocka_unit_test(normals_at_and_below_the_horizon_keep_the_largest_slope),
        cmocka_unit_test(an_object_space_normal_without_direction_is_flat),
        cmocka_unit_test(triplanar_bumps_have_the_right_orientation_on_all_six_faces),
        cmocka_unit_test(triplanar_weights_sum_to_one_and_sharpen),
        cmocka_unit_test(a_linear_height_in_space_needs_no_particular_weights),
        cmocka_unit_test(layers_add_up_in_any_order),
        cmocka_unit_test(gradients_are_linear_in_the_derivative),
        cmocka_unit_test(a_resolved_normal_is_unit_and_above_the_surface),
        cmocka_unit_test(a_gradient_that_cannot_be_resolved_gives_the_surface_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
