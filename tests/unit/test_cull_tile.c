/* test_cull_tile.c - tiles, intervals of depth and bounds of hdrp_cull_volume.h.
 * SPDX-License-Identifier: MIT */
#include "cull_test.h"

static const uint32_t kinds[] = {HDRP_CULL_KIND_BALL, HDRP_CULL_KIND_CONE, HDRP_CULL_KIND_PYRAMID,
                                 HDRP_CULL_KIND_BOX, HDRP_CULL_KIND_FRONT};

static hdrp_v3 v3(float x, float y, float z)
{
    return hdrp_v3_make(x, y, z);
}

/* A camera at the origin of view space. */
static hdrp_cull_camera camera_of(float flat, float left, float right, float bottom, float top,
                                  float near_m, float far_m)
{
    hdrp_v3 o = v3(0, 0, 0), z = v3(0, 0, 1), y = v3(0, 1, 0);
    return flat > 0.0f
               ? hdrp_cull_camera_orthographic(o, z, y, left, right, bottom, top, near_m, far_m)
               : hdrp_cull_camera_perspective(o, z, y, left, right, bottom, top, near_m, far_m);
}

/* A random camera whose window is often off centre; size is that of an orthographic picture. */
static hdrp_cull_camera test_camera(float flat, double size, uint64_t* random)
{
    double k = flat > 0.0f ? size * test_log_uniform(random, 0.1, 10.0)
                           : tan(test_uniform(random, 0.01, 1.4));
    double x = test_random(random) < 0.5 ? 0.0 : k * test_uniform(random, -2.0, 2.0);
    double y = test_random(random) < 0.5 ? 0.0 : k * test_uniform(random, -2.0, 2.0);
    double near_m = size * test_log_uniform(random, 1e-4, 1.0);
    return camera_of(flat, (float)(x - k), (float)(x + k), (float)(y - k), (float)(y + k),
                     (float)near_m, (float)(near_m * test_log_uniform(random, 1.1, 1e7)));
}

static void tiles_enclose_their_pixels(void** state)
{
    uint64_t random = 5;
    (void)state;
    for (int i = 0; i < 100000; ++i) {
        hdrp_cull_camera c = test_camera(i & 1 ? 1.0f : 0.0f, 10.0, &random);
        float w = floorf((float)test_uniform(&random, 1.0, 16384.5));
        float h = floorf((float)test_uniform(&random, 1.0, 16384.5));
        float x0 = floorf((float)test_uniform(&random, 0.0, (double)w));
        float y0 = floorf((float)test_uniform(&random, 0.0, (double)h));
        float x1 = fminf(x0 + 64.0f, w), y1 = fminf(y0 + 16.0f, h);
        hdrp_cull_tile t = hdrp_cull_tile_make(c, x0, y0, x1, y1, w, h);
        double du = (double)c.window.z / (double)w, dv = (double)c.window.w / (double)h;
        double left = (double)c.window.x + (double)x0 * du - (double)t.window.x;
        double right = (double)t.window.y - (double)c.window.x - (double)x1 * du;
        double bottom = (double)c.window.y + ((double)h - (double)y1) * dv - (double)t.window.z;
        double top = (double)t.window.w - (double)c.window.y - ((double)h - (double)y0) * dv;
        double u = fabs((double)c.window.x) + (double)c.window.z;
        double v = fabs((double)c.window.y) + (double)c.window.w;
        if (!(left >= 0.0 && right >= 0.0 && bottom >= 0.0 && top >= 0.0)) {
            fail_msg("tile %d: %g %g %g %g", i, left / u, right / u, bottom / v, top / v);
        }
        assert_true(fmax(left, right) < 1e-6 * u && fmax(bottom, top) < 1e-6 * v);
        assert_true(t.extent.x == fmaxf(fabsf(t.window.x), fabsf(t.window.y)));
        assert_true(t.extent.y == fmaxf(fabsf(t.window.z), fabsf(t.window.w)));
    }
}

/* Whether z is in an interval. */
static bool spans(hdrp_cull_interval r, double z)
{
    return (double)r.nearest <= z && z <= (double)r.farthest;
}

static hdrp_cull_interval interval_of(hdrp_cull_shape s, hdrp_cull_tile t, float flat)
{
    hdrp_cull_interval r = hdrp_cull_interval_ball(t, hdrp_cull_shape_ball(s), flat);
    for (uint32_t k = 0; k < hdrp_cull_shape_plane_count(s); ++k) {
        r = hdrp_cull_interval_plane(r, t, hdrp_cull_shape_plane(s, k, flat), flat);
    }
    return r;
}

/* Points of shapes are in the interval of the tile that sees them, in the bounds and in the shape. */
static void points_of_shapes_are_found_in_their_tiles(void** state)
{
    uint64_t random = 6;
    int seen = 0;
    (void)state;
    for (int i = 0; i < 60000; ++i) {
        float flat = i & 1 ? 1.0f : 0.0f;
        hdrp_cull_shape s = test_shape(kinds[i / 2 % 5], &random);
        body b = body_of(s);
        hdrp_cull_camera c = test_camera(flat, dv_length(b.center) + body_size(&b), &random);
        const double width = 1920.0, height = 1080.0;
        hdrp_cull_bounds bounds = hdrp_cull_shape_bounds(s, c, (float)width, (float)height);
        for (int k = 0; k < 8; ++k) {
            dvec p = body_point(&b, &random);
            double u = flat > 0.0f ? p.x : p.x / p.z, v = flat > 0.0f ? p.y : p.y / p.z;
            double x = (u - (double)c.window.x) / (double)c.window.z * width;
            double y = height - (v - (double)c.window.y) / (double)c.window.w * height;
            if (!(p.z >= (double)c.eye_near.w && p.z <= (double)c.right_far.w && x >= 0.0 &&
                  x <= width && y >= 0.0 && y <= height)) {
                continue;
            }
            float x0 = 16.0f * floorf((float)x / 16.0f), y0 = 16.0f * floorf((float)y / 16.0f);
            hdrp_cull_tile t =
                hdrp_cull_tile_make(c, x0, y0, x0 + 16.0f, y0 + 16.0f, (float)width, (float)height);
            hdrp_cull_interval r = interval_of(s, t, flat);
            ++seen;
            if (!spans(r, p.z)) {
                fail_msg("kind %u %d: depth %.9g is not in %.9g to %.9g", b.kind, i, p.z,
                         (double)r.nearest, (double)r.farthest);
            }
            if (!((double)bounds.rect_px.x <= x && x <= (double)bounds.rect_px.z &&
                  (double)bounds.rect_px.y <= y && y <= (double)bounds.rect_px.w)) {
                fail_msg("kind %u %d: pixel %.9g %.9g is not in %.9g %.9g %.9g %.9g", b.kind, i, x,
                         y, (double)bounds.rect_px.x, (double)bounds.rect_px.y,
                         (double)bounds.rect_px.z, (double)bounds.rect_px.w);
            }
            if (!((double)bounds.nearest <= p.z && p.z <= (double)bounds.farthest)) {
                fail_msg("kind %u %d: depth %.9g is not in bounds %.9g to %.9g", b.kind, i, p.z,
                         (double)bounds.nearest, (double)bounds.farthest);
            }
        }
    }
    assert_true(seen > 20000);
}

/* What is beside a tile by more than rounding is not listed in it. */
static void shapes_miss_tiles_beside_them(void** state)
{
    hdrp_cull_camera c = camera_of(0.0f, -1, 1, -1, 1, 0.1f, 1000.0f);
    hdrp_cull_tile left = hdrp_cull_tile_make(c, 0, 0, 50, 100, 100, 100);
    hdrp_cull_shape s = hdrp_cull_shape_sphere(v3(0.51f, 0, 10), 0.5f, 0u);
    hdrp_cull_interval r = interval_of(s, left, 0.0f);
    (void)state;
    assert_true(r.nearest > r.farthest);
    r = interval_of(hdrp_cull_shape_sphere(v3(0.49f, 0, 10), 0.5f, 0u), left, 0.0f);
    assert_true(r.nearest < 10.0f && r.farthest > 9.9f && r.farthest < 10.2f);
    /* A rounded box whose ball reaches the tile, but whose face is 1 cm beside it. */
    s = hdrp_cull_shape_box(v3(0.51f, 0, 10), v3(0, 0, 1), v3(0, 1, 0), 0.5f, 4.0f, 0.5f, 0u);
    r = interval_of(s, left, 0.0f);
    assert_true(r.nearest > r.farthest || r.farthest < 0.0f);
    r = interval_of(s, hdrp_cull_tile_make(c, 50, 0, 100, 100, 100, 100), 0.0f);
    assert_true(r.nearest > 9.4f && r.nearest < 9.51f && r.farthest > 10.49f && r.farthest < 10.6f);
}

static void planes_shorten_intervals_on_their_own_side(void** state)
{
    hdrp_cull_camera c = camera_of(0.0f, -1, 1, -1, 1, 0.1f, 1000.0f);
    hdrp_cull_tile t = hdrp_cull_tile_make(c, 40, 40, 60, 60, 100, 100);
    hdrp_cull_interval all = {1.0f, 100.0f}, r;
    (void)state;
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(0, 0, 0, 1), 0.0f); /* no plane */
    assert_true(r.nearest == 1.0f && r.farthest == 100.0f);
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(0, 0, 1, 20), 0.0f); /* z <= 20 */
    assert_true(r.nearest == 1.0f && r.farthest > 20.0f && r.farthest < 20.001f);
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(0, 0, -1, -20), 0.0f); /* z >= 20 */
    assert_true(r.nearest < 20.0f && r.nearest > 19.999f && r.farthest == 100.0f);
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(0, 0, 1, -20), 0.0f); /* behind */
    assert_true(r.nearest > r.farthest || r.farthest < 0.0f);
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(-1, 0, 0, -2), 0.0f); /* x >= 2, u <= 0.2 */
    assert_true(r.nearest < 10.0f && r.nearest > 9.99f && r.farthest == 100.0f);
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(1, 0, 0, -2), 0.0f); /* x <= -2 */
    assert_true(r.nearest < 10.0f && r.nearest > 9.99f && r.farthest == 100.0f);
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(0, 1, 0, -2), 0.0f); /* y <= -2 */
    assert_true(r.nearest < 10.0f && r.nearest > 9.99f && r.farthest == 100.0f);
    c = camera_of(1.0f, -10, 10, -10, 10, 0.1f, 1000.0f);
    t = hdrp_cull_tile_make(c, 40, 40, 60, 60, 100, 100);                  /* -2 to 2 m */
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(1, 0, 0, -3), 1.0f); /* x <= -3 */
    assert_true(r.nearest > r.farthest || r.farthest < 0.0f);
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(1, 0, 0, -1.5f), 1.0f);
    assert_true(r.nearest == 1.0f && r.farthest == 100.0f);
    r = hdrp_cull_interval_plane(all, t, hdrp_v4_make(0.6f, 0, 0.8f, 10), 1.0f);
    assert_true(r.farthest > 14.0f && r.farthest < 14.01f); /* (10 + 0.6 * 2) / 0.8 */
}

/* The same by angles: extremes of x / z of a disc in front of the near distance. */
static void extent(double x, double z, double r, double near_m, double out[2])
{
    double d = hypot(x, z), at = near_m - z;
    double middle = atan2(x, z), half = d > r ? asin(r / d) : TEST_PI;
    double cut = fabs(at) <= r ? sqrt(r * r - at * at) : -1.0;
    for (int side = 0; side < 2; ++side) {
        double sign = side ? 1.0 : -1.0, a = middle + sign * half;
        /* where the tangent touches: at d cos(half) along it */
        bool touches = d > r && fabs(a) < 0.5 * TEST_PI && d * cos(half) * cos(a) >= near_m;
        out[side] = touches ? tan(a) : cut >= 0.0 ? (x + sign * cut) / near_m : sign * 1e30;
    }
}

/* In pixels, a pixel beyond the picture at most: left, upper, right, lower. */
static void rectangle(dvec p, double r, hdrp_cull_camera c, double width, double height,
                      double out[4])
{
    double x[2], y[2];
    extent(p.x, p.z, r, (double)c.eye_near.w, x);
    extent(p.y, p.z, r, (double)c.eye_near.w, y);
    out[0] = (x[0] - (double)c.window.x) / (double)c.window.z * width;
    out[2] = (x[1] - (double)c.window.x) / (double)c.window.z * width;
    out[1] = height - (y[1] - (double)c.window.y) / (double)c.window.w * height;
    out[3] = height - (y[0] - (double)c.window.y) / (double)c.window.w * height;
    for (int n = 0; n < 4; ++n) {
        out[n] = fmin(fmax(out[n], -1.0), (n & 1 ? height : width) + 1.0);
    }
}

static void bounds_of_balls_are_tight(void** state)
{
    const double width = 1920.0, height = 1080.0;
    uint64_t random = 7;
    int compared = 0;
    (void)state;
    for (int i = 0; i < 200000; ++i) {
        double k = tan(test_uniform(&random, 0.05, 1.047));
        hdrp_cull_camera c =
            camera_of(0.0f, (float)-k, (float)k, (float)(-0.6 * k), (float)(0.6 * k), 0.1f, 1e6f);
        hdrp_v3 q = v3_from(
            dv_mad(dv(0, 0, 0), test_direction(&random), test_log_uniform(&random, 1e-2, 1e5)));
        dvec p = dv_from(q);
        double near_m = (double)c.eye_near.w, least[4], most[4];
        double r = dv_length(p) * test_log_uniform(&random, 1e-4, 10.0);
        hdrp_v4 ball = hdrp_cull_shape_ball(hdrp_cull_shape_sphere(q, (float)r, 0u));
        hdrp_cull_bounds b = hdrp_cull_ball_bounds(ball, c, (float)width, (float)height);
        double found[] = {(double)b.rect_px.x, (double)b.rect_px.y, (double)b.rect_px.z,
                          (double)b.rect_px.w};
        double slack = fmin(fabs(hypot(p.x, p.z) - r), fabs(hypot(p.y, p.z) - r)) / r;
        r = (double)(float)r;
        rectangle(p, r, c, width, height, least);
        rectangle(p, (double)ball.w, c, width, height, most);
        if (p.z + r < near_m * (1.0 + 1e-5) || least[0] > width || least[2] < 0.0 ||
            least[1] > height || least[3] < 0.0) {
            continue; /* behind or beside the picture */
        }
        ++compared;
        for (int n = 0; n < 4; ++n) {
            double wider = n < 2 ? least[n] - found[n] : found[n] - least[n];
            double too_wide = n < 2 ? most[n] - found[n] : found[n] - most[n];
            if (!(wider >= 0.0 && (too_wide <= 0.1 || p.z - r < near_m || slack < 1e-3))) {
                fail_msg("edge %d of (%.9g %.9g %.9g) %.9g: wider by %g px", n, p.x, p.y, p.z, r,
                         wider);
            }
        }
        assert_true((double)b.nearest <= fmax(p.z - r, near_m));
        assert_true((double)b.nearest >= fmax(p.z - r, near_m) - 5e-6 * (dv_length(p) + r));
        assert_true((double)b.farthest >= p.z + r);
        assert_true((double)b.farthest <= p.z + r + 5e-6 * (dv_length(p) + r));
    }
    assert_true(compared > 20000);
}

static bool is_empty(hdrp_cull_bounds b)
{
    return b.rect_px.x > b.rect_px.z;
}

static void what_is_not_in_front_has_no_bounds(void** state)
{
    hdrp_cull_camera c = camera_of(0.0f, -1, 1, -1, 1, 0.5f, 100.0f);
    hdrp_cull_bounds b;
    (void)state;
    assert_true(is_empty(hdrp_cull_ball_bounds(hdrp_v4_make(0, 0, -5, 1), c, 100, 100)));
    assert_true(is_empty(hdrp_cull_ball_bounds(hdrp_v4_make(0, 0, 0, 0.4f), c, 100, 100)));
    assert_true(is_empty(hdrp_cull_ball_bounds(hdrp_v4_make(0, 0, 102, 1), c, 100, 100)));
    assert_true(is_empty(hdrp_cull_ball_bounds(hdrp_v4_make(30, 0, 10, 1), c, 100, 100)));
    assert_true(is_empty(hdrp_cull_ball_bounds(hdrp_v4_make(0, -30, 10, 1), c, 100, 100)));
    assert_false(is_empty(hdrp_cull_ball_bounds(hdrp_v4_make(0, 0, 100.5f, 1), c, 100, 100)));
    b = hdrp_cull_ball_bounds(hdrp_v4_make(0, 0, 0, 1), c, 100, 80); /* around the eye */
    assert_true(b.rect_px.x <= 0 && b.rect_px.y <= 0 && b.rect_px.z >= 100 && b.rect_px.w >= 80);
    assert_true(b.nearest == 0.5f && b.farthest > 1.0f && b.farthest < 1.001f);
    b = hdrp_cull_shape_bounds(hdrp_cull_shape_sphere(v3(0, 0, 5), -1.0f, 0u), c, 100, 100);
    assert_true(is_empty(b));
    c = camera_of(1.0f, -10, 10, -10, 10, 0.5f, 100.0f);
    b = hdrp_cull_ball_bounds(hdrp_v4_make(5, -2, 50, 1), c, 200, 100);
    assert_true(b.rect_px.x > 139.9f && b.rect_px.x <= 140 && b.rect_px.z >= 160);
    assert_true(b.rect_px.y > 54.9f && b.rect_px.y <= 55 && b.rect_px.w >= 65);
}

/* A cone or a box that points at the camera ends in front of the ball that holds it. */
static void bounds_of_shapes_are_tighter_than_those_of_balls(void** state)
{
    hdrp_cull_camera c = camera_of(0.0f, -1, 1, -1, 1, 0.5f, 100.0f);
    hdrp_cull_shape s = hdrp_cull_shape_from_light(
        hdrp_light_spot(v3(0, 0, 20), v3(0, 0, -1), v3(1, 1, 1), 10.0f, 0.1f, 0.2f));
    hdrp_cull_bounds b = hdrp_cull_shape_bounds(s, c, 1000, 1000);
    (void)state;
    assert_true(b.nearest > 9.999f && b.nearest <= 10.0f);
    assert_true(b.farthest >= 20.0f && b.farthest < 20.001f);
    assert_true(b.rect_px.x > 310.0f && b.rect_px.z < 690.0f); /* the ball: 211 to 789 */
    s = hdrp_cull_shape_box(v3(0, 0, 20), v3(0, 0, 1), v3(0, 1, 0), 3, 3, 1, 0u);
    b = hdrp_cull_shape_bounds(s, c, 1000, 1000);
    assert_true(b.nearest > 18.99f && b.nearest <= 19.0f);
    assert_true(b.farthest >= 21.0f && b.farthest < 21.01f);
    s.forward_half.w = 0.0f;
    s.center_range.w = 2.0f;
    s.bits.x = HDRP_CULL_KIND_FRONT;
    b = hdrp_cull_shape_bounds(s, c, 1000, 1000);
    assert_true(b.nearest > 19.99f && b.farthest < 22.01f && b.farthest >= 22.0f);
}

/* The nearest and the farthest depth of a body, along the axis of view. */
static void depths_of_cones_and_boxes_are_tight(void** state)
{
    static const uint32_t tight[] = {HDRP_CULL_KIND_CONE, HDRP_CULL_KIND_BOX, HDRP_CULL_KIND_FRONT};
    hdrp_cull_camera c = camera_of(1.0f, -1, 1, -1, 1, 1e-6f, 1e18f);
    uint64_t random = 9;
    int compared = 0;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_cull_shape s = test_shape(tight[i % 3], &random);
        body b = body_of(s);
        double slack = 2e-5 * (dv_length(b.center) + body_size(&b));
        double nearest = -body_support(&b, dv(0, 0, -1)), farthest = body_support(&b, dv(0, 0, 1));
        hdrp_cull_bounds bounds = hdrp_cull_shape_bounds(s, c, 100.0f, 100.0f);
        if (nearest <= 1e-5 || (b.kind == HDRP_CULL_KIND_CONE && b.angle_x > 0.5 * TEST_PI)) {
            continue; /* not in front of the camera, or as wide as its ball */
        }
        ++compared;
        assert_true((double)bounds.nearest <= nearest && (double)bounds.farthest >= farthest);
        assert_true((double)bounds.nearest >= nearest - slack);
        assert_true((double)bounds.farthest <= farthest + slack);
    }
    assert_true(compared > 4000);
}

/* The smallest ball around a cone: through apex and rim, or from 45 degrees on around the rim. */
static void bounds_of_cones_and_pyramids_are_those_of_their_smallest_balls(void** state)
{
    const double width = 1920.0, height = 1080.0;
    const hdrp_v3 white = {1, 1, 1};
    hdrp_cull_camera c = camera_of(0.0f, -1, 1, -0.6f, 0.6f, 0.5f, 1000.0f);
    uint64_t random = 10;
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        hdrp_v3 p = v3((float)test_uniform(&random, -5.0, 5.0),
                       (float)test_uniform(&random, -3.0, 3.0), 20.0f);
        hdrp_v3 f = v3_from(test_direction(&random));
        float x = (float)test_uniform(&random, 0.1, 1.4),
              y = (float)test_uniform(&random, 0.1, 1.4);
        hdrp_cull_shape s = hdrp_cull_shape_from_light(
            i & 1 ? hdrp_light_spot(p, f, white, 10.0f, 0.0f, x)
                  : hdrp_light_pyramid(p, f, v3(0, 1, 0), white, 10.0f, x, y, 0.5f));
        body b = body_of(s);
        double angle = i & 1 ? b.angle_x : atan(hypot(tan(b.angle_x), tan(b.angle_y)));
        bool narrow = angle < 0.25 * TEST_PI;
        double along = b.range * (narrow ? 0.5 / cos(angle) : cos(angle));
        double whole[4], least[4];
        hdrp_cull_bounds r = hdrp_cull_shape_bounds(s, c, (float)width, (float)height);
        double found[] = {(double)r.rect_px.x, (double)r.rect_px.y, (double)r.rect_px.z,
                          (double)r.rect_px.w};
        rectangle(b.center, b.range, c, width, height, whole);
        rectangle(dv_mad(b.center, b.forward, along), narrow ? along : b.range * sin(angle), c,
                  width, height, least);
        for (int n = 0; n < 4; ++n) {
            double wider =
                n < 2 ? fmax(whole[n], least[n]) - found[n] : found[n] - fmin(whole[n], least[n]);
            if (!(wider >= 0.0 && wider <= 0.1)) {
                fail_msg("kind %u %d, edge %d: wider by %g px", b.kind, i, n, wider);
            }
        }
    }
}

/* Half a ball whose flat side is all but across the axis: its rim is what reaches back. The cosine
 * of the tilt is 1 in floats. */
static void a_slight_tilt_is_not_lost(void** state)
{
    const double tilt = 2e-4;
    hdrp_cull_camera c = camera_of(0.0f, -3, 3, -3, 3, 0.5f, 1000.0f);
    hdrp_v3 f = v3((float)sin(tilt), 0, (float)cos(tilt)), white = v3(1, 1, 1);
    hdrp_cull_shape spot = hdrp_cull_shape_from_light(
        hdrp_light_spot(v3(0, 0, 100), f, white, 50.0f, 0.1f, (float)(0.5 * TEST_PI)));
    hdrp_cull_shape front = hdrp_cull_shape_box(v3(0, 0, 100), f, v3(0, 1, 0), 0, 0, 0, 0u);
    (void)state;
    front.center_range.w = 50.0f;
    front.bits.x = HDRP_CULL_KIND_FRONT;
    assert_true((double)hdrp_cull_shape_bounds(spot, c, 100, 100).nearest <
                100.0 - 50.0 * sin(tilt));
    assert_true((double)hdrp_cull_shape_bounds(front, c, 100, 100).nearest <
                100.0 - 50.0 * sin(tilt));
    assert_true(hdrp_cull_shape_bounds(front, c, 100, 100).nearest > 99.98f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_enclose_their_pixels),
        cmocka_unit_test(points_of_shapes_are_found_in_their_tiles),
        cmocka_unit_test(shapes_miss_tiles_beside_them),
        cmocka_unit_test(planes_shorten_intervals_on_their_own_side),
        cmocka_unit_test(bounds_of_balls_are_tight),
        cmocka_unit_test(what_is_not_in_front_has_no_bounds),
        cmocka_unit_test(bounds_of_shapes_are_tighter_than_those_of_balls),
        cmocka_unit_test(depths_of_cones_and_boxes_are_tight),
        cmocka_unit_test(bounds_of_cones_and_pyramids_are_those_of_their_smallest_balls),
        cmocka_unit_test(a_slight_tilt_is_not_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
