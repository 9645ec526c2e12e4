/* Rays, hits and surfaces: derivatives against finite differences, culling, layers, frames. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "builtin_shape.h"
#include "camera.h"
#include "surface.h"
#include "trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct fixture {
    rd_scene scene;
    rd_trace* trace;
} fixture;

static void add(fixture* f, rd_shape shape, rd_material m, hdrp_v3 where)
{
    rd_affine a = rd_affine_identity();
    assert_true(shape.ok);
    rd_material_update_features(&m);
    a.t = where;
    rd_mesh_transform(&shape.mesh, a);
    shape.mesh.material = rd_scene_add_material(&f->scene, &m);
    assert_true(rd_scene_add_mesh(&f->scene, &shape.mesh));
}

static void build(fixture* f)
{
    rd_report report;
    report.failed = false;
    rd_scene_update_bounds(&f->scene);
    f->trace = rd_trace_build(&f->scene, &report);
    assert_non_null(f->trace);
}

static void release(fixture* f)
{
    rd_trace_free(f->trace);
    rd_scene_free(&f->scene);
}

static fixture empty(void)
{
    fixture f;
    memset(&f, 0, sizeof f);
    return f;
}

static rd_ray ray_along(hdrp_v3 from, hdrp_v3 direction)
{
    rd_ray r;
    r.origin = from;
    r.direction = hdrp_v3_normalize(direction);
    r.t_min = 0.0f;
    r.t_max = HDRP_FLT_MAX;
    return r;
}

static rd_shape sheet(void)
{
    return rd_shape_card(2.0f, 2.0f, 0.0f, hdrp_v2_make(1.0f, -1.0f));
}

static void assert_v3_near(hdrp_v3 a, hdrp_v3 b, float tolerance)
{
    if (!(hdrp_v3_length(hdrp_v3_sub(a, b)) <= tolerance)) {
        fail_msg("(%g %g %g) is not (%g %g %g)", (double)a.x, (double)a.y, (double)a.z, (double)b.x,
                 (double)b.y, (double)b.z);
    }
}

static void camera_spread_is_the_derivative_of_its_rays(void** state)
{
    rd_camera c = rd_camera_look_at(hdrp_v3_make(1.0f, 2.0f, 3.0f), hdrp_v3_make(0.0f, 0.5f, -1.0f),
                                    0.9f, 640, 360);
    (void)state;
    for (int i = 0; i < 20; ++i) {
        hdrp_v2 p = hdrp_r2((hdrp_u32)i);
        float x = p.x * 640.0f, y = p.y * 360.0f;
        rd_ray_spread s = rd_camera_spread(&c, x, y);
        hdrp_v3 dx = hdrp_v3_sub(rd_camera_ray(&c, x + 2.0f, y).direction,
                                 rd_camera_ray(&c, x - 2.0f, y).direction);
        hdrp_v3 dy = hdrp_v3_sub(rd_camera_ray(&c, x, y + 2.0f).direction,
                                 rd_camera_ray(&c, x, y - 2.0f).direction);
        assert_v3_near(s.direction_dx, hdrp_v3_scale(dx, 0.25f), 2e-6f);
        assert_v3_near(s.direction_dy, hdrp_v3_scale(dy, 0.25f), 2e-6f);
    }
}

static bool surface_at(const fixture* f, const rd_camera* c, float x, float y, rd_surface* out)
{
    rd_ray ray = rd_camera_ray(c, x, y);
    rd_ray_spread spread = rd_camera_spread(c, x, y);
    rd_hit hit;
    rd_trace_closest(f->trace, &ray, &hit, 1);
    if (hit.mesh == RD_NO_HIT) {
        return false;
    }
    rd_surface_evaluate(&f->scene, &ray, &spread, &hit, out);
    return true;
}

static void position_derivatives_match_neighbouring_rays(void** state)
{
    fixture f = empty();
    rd_camera c = rd_camera_look_at(hdrp_v3_make(0.7f, 2.5f, 2.0f), hdrp_v3_make(0.0f, 1.0f, 0.0f),
                                    0.5f, 400, 400);
    (void)state;
    add(&f, sheet(), rd_material_default(), hdrp_v3_splat(0.0f));
    build(&f);
    for (int i = 0; i < 20; ++i) {
        hdrp_v2 p = hdrp_r2((hdrp_u32)i);
        float x = 150.0f + 100.0f * p.x, y = 150.0f + 100.0f * p.y;
        rd_surface s, right, down;
        assert_true(surface_at(&f, &c, x, y, &s) && surface_at(&f, &c, x + 0.5f, y, &right) &&
                    surface_at(&f, &c, x, y + 0.5f, &down));
        assert_v3_near(hdrp_v3_scale(s.position_dx, 0.5f), hdrp_v3_sub(right.position, s.position),
                       2e-5f);
        assert_v3_near(hdrp_v3_scale(s.position_dy, 0.5f), hdrp_v3_sub(down.position, s.position),
                       2e-5f);
    }
    release(&f);
}

static void single_sided_surfaces_are_seen_from_the_front_only(void** state)
{
    fixture f = empty();
    rd_material both = rd_material_default();
    rd_ray from_behind = ray_along(hdrp_v3_make(0.1f, 1.0f, -5.0f), hdrp_v3_make(0.0f, 0.0f, 1.0f));
    rd_hit hit;
    (void)state;
    both.double_sided = true;
    add(&f, sheet(), rd_material_default(), hdrp_v3_splat(0.0f));
    add(&f, sheet(), rd_material_default(), hdrp_v3_make(0.0f, 0.0f, 1e-4f));
    add(&f, sheet(), both, hdrp_v3_make(0.0f, 0.0f, 1.0f));
    build(&f);
    rd_trace_closest(f.trace, &from_behind, &hit, 1);
    assert_int_equal(hit.mesh, 2);
    assert_true(fabsf(hit.t - 6.0f) < 1e-5f);
    release(&f);
}

static void layers_come_sorted_and_complete(void** state)
{
    enum { COUNT = 300 };
    fixture f = empty();
    rd_layers layers;
    rd_material glass = rd_material_default();
    rd_ray ray = ray_along(hdrp_v3_make(0.1f, 1.0f, 5.0f), hdrp_v3_make(0.0f, 0.0f, -1.0f));
    (void)state;
    memset(&layers, 0, sizeof layers);
    glass.alpha_mode = RD_ALPHA_BLEND;
    glass.alpha = 0.01f;
    for (int i = 0; i < COUNT; ++i) {
        add(&f, sheet(), glass, hdrp_v3_make(0.0f, 0.0f, -0.01f * (float)(i * 7 % COUNT)));
    }
    build(&f);
    rd_trace_layers(f.trace, &ray, &layers);
    assert_int_equal(layers.count, COUNT);
    assert_int_equal(layers.dropped, 0);
    for (uint32_t i = 1; i < layers.count; ++i) {
        assert_true(layers.hits[i].t >= layers.hits[i - 1].t);
    }
    ray.t_max = 5.0f;
    rd_trace_layers(f.trace, &ray, &layers);
    assert_in_range(layers.count, 0, 1);
    free(layers.hits);
    release(&f);
}

static void transparent_surfaces_multiply_and_opaque_ones_stop_light(void** state)
{
    fixture f = empty();
    rd_material half = rd_material_default();
    rd_ray rays[9];
    hdrp_v3 out[9];
    (void)state;
    half.alpha_mode = RD_ALPHA_BLEND;
    half.alpha = 0.5f;
    half.double_sided = true;
    add(&f, sheet(), half, hdrp_v3_splat(0.0f));
    add(&f, sheet(), half, hdrp_v3_make(0.0f, 0.0f, 0.5f));
    add(&f, sheet(), rd_material_default(), hdrp_v3_make(0.0f, -1.0f, 1.0f));
    build(&f);
    for (int i = 0; i < 9; ++i) {
        /* The opaque sheet reaches from y = -1 to 1, the others from 0 to 2. */
        float y = i < 5 ? 1.5f : 0.5f;
        rays[i] = ray_along(hdrp_v3_make(-0.4f + 0.1f * (float)i, y, -3.0f),
                            hdrp_v3_make(0.0f, 0.0f, 1.0f));
        rays[i].t_max = 10.0f;
    }
    rd_trace_transmittance(f.trace, rays, RD_PASSING_ALL, out, 9);
    for (int i = 0; i < 9; ++i) {
        assert_v3_near(out[i], hdrp_v3_splat(i < 5 ? 0.25f : 0.0f), 1e-6f);
    }
    release(&f);
}

static void no_ray_leaves_through_the_seams_of_a_sphere(void** state)
{
    fixture f = empty();
    rd_material m = rd_material_default();
    int lost = 0;
    (void)state;
    m.double_sided = true;
    add(&f, rd_shape_sphere(1.0f, 64, hdrp_v2_make(1.0f, 1.0f)), m, hdrp_v3_splat(0.0f));
    build(&f);
    for (int i = 0; i < 20000; ++i) {
        hdrp_v2 a = hdrp_r2((hdrp_u32)i);
        float turn = HDRP_TWO_PI * a.x, z = 2.0f * a.y - 1.0f, r = sqrtf(1.0f - z * z);
        rd_ray ray = ray_along(hdrp_v3_make(0.2f, 0.1f, -0.3f),
                               hdrp_v3_make(r * cosf(turn), z, r * sinf(turn)));
        rd_hit hit;
        rd_trace_closest(f.trace, &ray, &hit, 1);
        lost += hit.mesh == RD_NO_HIT;
    }
    assert_int_equal(lost, 0);
    release(&f);
}

static void a_ray_that_leaves_a_surface_does_not_meet_it_again(void** state)
{
    fixture f = empty();
    rd_material m = rd_material_default();
    int met = 0;
    (void)state;
    m.double_sided = true;
    add(&f, sheet(), m, hdrp_v3_make(100.0f, -40.0f, 250.0f));
    build(&f);
    for (int i = 0; i < 5000; ++i) {
        hdrp_v2 a = hdrp_r2((hdrp_u32)i), b = hdrp_r2((hdrp_u32)(i * 7 + 3));
        rd_ray ray = ray_along(hdrp_v3_make(100.0f, -39.0f, 253.0f),
                               hdrp_v3_make(a.x - 0.5f, a.y - 0.5f, -3.0f));
        rd_surface s;
        rd_hit hit;
        float turn = HDRP_TWO_PI * b.x, z = 0.001f + b.y, r = sqrtf(hdrp_max(1.0f - z * z, 0.0f));
        rd_trace_closest(f.trace, &ray, &hit, 1);
        rd_surface_evaluate(&f.scene, &ray, NULL, &hit, &s);
        ray = ray_along(rd_trace_offset(s.position, s.geometric_normal),
                        hdrp_v3_make(r * cosf(turn), r * sinf(turn), z));
        rd_trace_closest(f.trace, &ray, &hit, 1);
        met += hit.mesh != RD_NO_HIT;
    }
    assert_int_equal(met, 0);
    release(&f);
}

/* A texture of one tilted normal. */
static void add_normal_texture(fixture* f)
{
    static const unsigned char tilted[4] = {190, 150, 230, 255};
    rd_report report;
    rd_texture* t = (rd_texture*)calloc(1, sizeof *t);
    report.failed = false;
    t->image.width = t->image.height = 1;
    t->image.rgba = (unsigned char*)malloc(4);
    memcpy(t->image.rgba, tilted, 4);
    f->scene.textures.items = t;
    f->scene.textures.count = 1;
    assert_true(rd_textures_prepare(&f->scene.textures, &report));
}

static void frames_from_uv_and_from_vertex_tangents_agree(void** state)
{
    hdrp_v3 normal[2][2];
    (void)state;
    for (int with_tangents = 0; with_tangents < 2; ++with_tangents) {
        fixture f = empty();
        rd_material m = rd_material_default();
        rd_shape shape = sheet();
        m.double_sided = true;
        m.slot[RD_SLOT_NORMAL] = rd_texture_slot_make(0);
        add_normal_texture(&f);
        if (!with_tangents) {
            free(shape.mesh.tangents);
            shape.mesh.tangents = NULL;
        } else {
            /* The sheet's v grows downwards: its -v is up, which is cross(n, t). */
            for (uint32_t i = 0; i < shape.mesh.vertex_count; ++i) {
                shape.mesh.tangents[i].w = 1.0f;
            }
        }
        add(&f, shape, m, hdrp_v3_splat(0.0f));
        build(&f);
        for (int back = 0; back < 2; ++back) {
            rd_ray ray = ray_along(hdrp_v3_make(0.1f, 1.0f, back ? -2.0f : 2.0f),
                                   hdrp_v3_make(0.0f, 0.0f, back ? 1.0f : -1.0f));
            rd_surface s;
            rd_hit hit;
            rd_trace_closest(f.trace, &ray, &hit, 1);
            rd_surface_evaluate(&f.scene, &ray, NULL, &hit, &s);
            normal[with_tangents][back] = s.brdf.normal;
        }
        release(&f);
    }
    for (int back = 0; back < 2; ++back) {
        assert_v3_near(normal[0][back], normal[1][back], 1e-5f);
    }
    /* Red leans right, green up; from behind it is the same sheet seen from the other side. */
    assert_true(normal[0][0].x > 0.3f && normal[0][0].y > 0.1f && normal[0][0].z > 0.7f);
    assert_v3_near(normal[0][1], hdrp_v3_neg(normal[0][0]), 1e-5f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_spread_is_the_derivative_of_its_rays),
        cmocka_unit_test(position_derivatives_match_neighbouring_rays),
        cmocka_unit_test(single_sided_surfaces_are_seen_from_the_front_only),
        cmocka_unit_test(layers_come_sorted_and_complete),
        cmocka_unit_test(transparent_surfaces_multiply_and_opaque_ones_stop_light),
        cmocka_unit_test(no_ray_leaves_through_the_seams_of_a_sphere),
        cmocka_unit_test(a_ray_that_leaves_a_surface_does_not_meet_it_again),
        cmocka_unit_test(frames_from_uv_and_from_vertex_tangents_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
