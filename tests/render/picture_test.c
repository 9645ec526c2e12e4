/* Whole pictures: deferred against forward, a white furnace, closed forms of light, bad skies, and
 * real time against the path tracer. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "studio.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COUNT 6
/* Radii of spheres that fill the picture, and of ones that hardly reflect each other. */
#define LARGE 0.45f
#define SMALL 0.2f

static const float roughnesses[COUNT] = {0.05f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f};

/* Spheres of the material at six roughnesses, three in a row. */
static void add_spheres(studio* s, rd_material m, float radius)
{
    for (int i = 0; i < COUNT; ++i) {
        hdrp_v3 at = hdrp_v3_make((float)(i % 3) - 1.0f, i < 3 ? 0.5f : -0.5f, 0.0f);
        m.perceptual_roughness = roughnesses[i];
        add(s, rd_shape_sphere(radius, 96, hdrp_v2_make(1.0f, 1.0f)), m, at);
    }
}

/* >>deferred against forward */

/* The exposure at which white faces under the sky and lights below are about white. */
#define EXPOSURE (HDRP_PI / 20000.0f)

static rd_difference deferred_against_forward(rd_material m, uint32_t without)
{
    studio* s = open_studio();
    rd_difference d;
    float *deferred, *forward;
    s->options.features &= ~without;
    s->scene.slab_color[0] = hdrp_v3_make(0.5f, 0.7f, 0.2f);
    add_spheres(s, m, LARGE);
    add_light(s, RD_LIGHT_POINT, hdrp_v3_make(0.5f, 2.0f, 2.5f), 20000.0f);
    add_light(s, RD_LIGHT_SPOT, hdrp_v3_make(-2.0f, 0.5f, 3.0f), 40000.0f);
    add_light(s, RD_LIGHT_DIRECTIONAL, hdrp_v3_make(1.0f, 1.0f, -0.4f), 3000.0f);
    set_sky(s, NULL, 12000.0f);
    set_up(s);
    s->options.path = RD_PATH_DEFERRED;
    deferred = shoot(s, EXPOSURE);
    s->options.path = RD_PATH_FORWARD;
    forward = shoot(s, EXPOSURE);
    assert_true(rd_compare(deferred, forward, WIDTH, HEIGHT, EXPOSURE, &d));
    free(deferred);
    free(forward);
    close_studio(s);
    return d;
}

static void check_deferred(const char* name, rd_material m, uint32_t without, double least_db)
{
    rd_difference d = deferred_against_forward(m, without);
    print_message(
        "  deferred against forward, %-22s %6.2f dB, HDR error %.4f mean, %.4f at 99.9 %%\n", name,
        d.psnr_db, d.relative_mean, d.relative_p999);
    assert_true(d.pixels > PIXELS / 4);
    /* Infinite where nothing was packed: then this compares nothing. */
    assert_true(isfinite(d.psnr_db));
    assert_true(d.psnr_db >= least_db);
}

static void isotropic_materials_survive_the_gbuffer_within_50_db(void** state)
{
    (void)state;
    check_deferred("dielectric", plain(0.7f, 0.35f, 0.12f, 0.0f), 0u, 50.0);
    check_deferred("metal", plain(0.95f, 0.64f, 0.54f, 1.0f), 0u, 50.0);
    check_deferred("half metal", plain(0.3f, 0.5f, 0.9f, 0.5f), 0u, 50.0);
}

static void special_materials_survive_the_gbuffer_within_45_db(void** state)
{
    rd_material m = plain(0.9f, 0.85f, 0.7f, 1.0f);
    (void)state;
    m.anisotropy = 0.8f;
    m.anisotropy_rotation_rad = 0.7f;
    check_deferred("anisotropic metal", m, 0u, 45.0);
    m = plain(0.6f, 0.55f, 0.5f, 1.0f);
    m.film = 1.0f;
    m.film_ior = 1.6f;
    m.film_thickness_min_nm = m.film_thickness_max_nm = 420.0f;
    check_deferred("iridescent metal", m, 0u, 45.0);
    m = plain(0.5f, 0.05f, 0.04f, 0.0f);
    m.film = 1.0f;
    m.film_thickness_min_nm = m.film_thickness_max_nm = 250.0f;
    check_deferred("iridescent dielectric", m, 0u, 45.0);
    m = plain(0.5f, 0.05f, 0.04f, 0.6f);
    m.coat = 1.0f;
    m.coat_perceptual_roughness = HDRP_BRDF_COAT_PERCEPTUAL_ROUGHNESS;
    /* A filtered coat has a roughness that no texel holds, and would be drawn forward. */
    check_deferred("coated half metal", m, RD_FEATURE_SPECULAR_AA, 45.0);
    m = plain(0.3f, 0.6f, 0.1f, 0.0f);
    m.slab_thickness = 0.6f;
    check_deferred("slab", m, 0u, 45.0);
}

/* >>white furnace */

static studio* furnace(rd_quality quality)
{
    studio* s = open_studio();
    rd_image_f32 sky = uniform_sky(100.0f);
    s->options.quality = quality;
    add_spheres(s, plain(1.0f, 1.0f, 1.0f, 1.0f), LARGE);
    set_sky(s, &sky, 0.0f);
    /* Nothing may be hidden from the sky by the other spheres but what they themselves reflect. */
    s->options.features &= ~(uint32_t)RD_FEATURE_AO;
    set_up(s);
    return s;
}

/* Cosine of the view at the centre of a pixel; 0 off the spheres. */
static float n_dot_v_at(const studio* s, int x, int y)
{
    rd_ray ray = rd_camera_ray(&s->camera, (float)x + 0.5f, (float)y + 0.5f);
    rd_surface surface;
    rd_hit hit;
    rd_trace_closest(s->trace, &ray, &hit, 1);
    if (hit.mesh == RD_NO_HIT) {
        return 0.0f;
    }
    rd_surface_evaluate(&s->scene, &ray, NULL, &hit, &surface);
    return hdrp_v3_dot(surface.brdf.normal, surface.view);
}

static void check_furnace(rd_path path)
{
    studio* s = furnace(RD_QUALITY_BALANCED);
    float* film;
    float worst = 0.0f, worst_grazing = 0.0f;
    s->options.path = path;
    film = shoot(s, 1e-2f);
    for (int i = 0; i < PIXELS; ++i) {
        float c = n_dot_v_at(s, i % WIDTH, i / WIDTH);
        hdrp_v3 p = pixel(film, i % WIDTH, i / WIDTH);
        float error = hdrp_abs(p.y / 100.0f - 1.0f);
        if (c >= 0.05f) {
            worst = hdrp_max(worst, error);
        } else if (c > 0.0f) {
            worst_grazing = hdrp_max(worst_grazing, error);
        }
    }
    print_message("  white furnace, %s: off by %.5f at most for n.v >= 0.05, %.5f beyond\n",
                  path == RD_PATH_DEFERRED ? "deferred" : "forward", (double)worst,
                  (double)worst_grazing);
    assert_true(worst <= 0.005f);
    assert_true(worst_grazing <= 0.02f);
    free(film);
    close_studio(s);
}

static void white_metal_vanishes_in_a_uniform_sky(void** state)
{
    (void)state;
    check_furnace(RD_PATH_FORWARD);
    check_furnace(RD_PATH_DEFERRED);
}

/* Paths bounce between the spheres; still all light that leaves must have come from the sky. */
static void white_metal_vanishes_for_the_path_tracer_too(void** state)
{
    studio* s = furnace(RD_QUALITY_REFERENCE);
    double sum[COUNT] = {0.0};
    int n[COUNT] = {0};
    float* film;
    (void)state;
    s->options.spp = 16;
    film = shoot(s, 1e-2f);
    for (int i = 0; i < PIXELS; ++i) {
        int sphere = i % WIDTH * 3 / WIDTH + (i / WIDTH >= HEIGHT / 2 ? 3 : 0);
        if (film[i * 4 + 3] == 1.0f) {
            sum[sphere] += (double)film[i * 4 + 1] / 100.0;
            ++n[sphere];
        }
    }
    for (int i = 0; i < COUNT; ++i) {
        print_message("  white furnace, reference: mean %.5f at roughness %g\n", sum[i] / n[i],
                      (double)roughnesses[i]);
        assert_true(n[i] > PIXELS / 24);
        assert_true(fabs(sum[i] / n[i] - 1.0) < 0.005);
    }
    free(film);
    close_studio(s);
}

/* >>closed forms */

/* A grey wall that faces +Z, and perhaps a small one before it. */
static studio* wall(bool blocked)
{
    studio* s = open_studio();
    s->options.features |= RD_FEATURE_GREY_CARDS;
    add(s, rd_shape_card(8.0f, 8.0f, 0.0f, hdrp_v2_make(1.0f, 1.0f)), plain(1, 1, 1, 0),
        hdrp_v3_make(0.0f, -4.0f, 0.0f));
    if (blocked) {
        rd_material m = plain(1, 1, 1, 0);
        m.double_sided = true;
        add(s, rd_shape_card(0.4f, 0.4f, 0.0f, hdrp_v2_make(1.0f, 1.0f)), m,
            hdrp_v3_make(1.0f, 0.8f, 1.0f));
    }
    return s;
}

/* In the middle of the picture, which looks at the origin along -Z. */
static float middle(studio* s)
{
    float* film;
    float y;
    set_up(s);
    film = shoot(s, 1e-2f);
    y = pixel(film, WIDTH / 2, HEIGHT / 2).y;
    free(film);
    return y;
}

static float lit_by(rd_light_type type, float intensity, bool blocked)
{
    studio* s = wall(blocked);
    float y;
    add_light(s, type, hdrp_v3_make(2.0f, 2.0f, 2.0f), intensity);
    y = middle(s);
    close_studio(s);
    return y;
}

static void assert_relative(float value, float expected, float tolerance)
{
    if (!(hdrp_abs(value - expected) <= tolerance * expected)) {
        fail_msg("%g, expected %g", (double)value, (double)expected);
    }
}

static void lights_have_their_units(void** state)
{
    const float albedo = HDRP_LIGHT_MIDDLE_GREY, cosine = 1.0f / sqrtf(3.0f);
    (void)state;
    /* 12 m^2 away, aslant; pixels lie half of one beside the origin. */
    assert_relative(lit_by(RD_LIGHT_POINT, 1200.0f, false), 100.0f * cosine * albedo / HDRP_PI,
                    0.01f);
    assert_relative(lit_by(RD_LIGHT_SPOT, 1200.0f, false), 100.0f * cosine * albedo / HDRP_PI,
                    0.01f);
    assert_relative(lit_by(RD_LIGHT_DIRECTIONAL, 100.0f, false), 100.0f * cosine * albedo / HDRP_PI,
                    0.01f);
}

static void what_is_in_the_way_of_a_light_casts_a_shadow(void** state)
{
    (void)state;
    assert_true(lit_by(RD_LIGHT_POINT, 1200.0f, true) == 0.0f);
    assert_true(lit_by(RD_LIGHT_SPOT, 1200.0f, true) == 0.0f);
    assert_true(lit_by(RD_LIGHT_DIRECTIONAL, 100.0f, true) == 0.0f);
}

/* Of a leaf that is lit from behind. */
static float lit_through_a_leaf(uint32_t without)
{
    studio* s = open_studio();
    rd_material leaf = plain(0.5f, 0.5f, 0.5f, 0.0f);
    float y;
    leaf.slab_thickness = 1.0f;
    leaf.double_sided = true;
    s->scene.slab_color[0] = hdrp_v3_splat(0.5f);
    s->options.features &= ~without;
    add(s, rd_shape_card(8.0f, 8.0f, 0.0f, hdrp_v2_make(1.0f, 1.0f)), leaf,
        hdrp_v3_make(0.0f, -4.0f, 0.0f));
    add_light(s, RD_LIGHT_POINT, hdrp_v3_make(0.0f, 0.0f, -2.0f), 400.0f);
    y = middle(s);
    close_studio(s);
    return y;
}

static void light_crosses_leaves(void** state)
{
    /* 100 lux; of what is not reflected at once, half is not absorbed, and half of that crosses. */
    const float all = 100.0f * 0.5f * 0.5f / HDRP_PI;
    float y = lit_through_a_leaf(0u);
    (void)state;
    assert_true(y > 0.7f * all && y < all);
    assert_true(lit_through_a_leaf(RD_FEATURE_TRANSMISSION) == 0.0f);
}

static void a_sky_of_so_many_lux_lights_the_ground_so_much(void** state)
{
    studio* s = wall(false);
    rd_image_f32 sky = uniform_sky(7.0f);
    (void)state;
    /* A uniform sky has pi times its luminance on any plane, also on this one. */
    set_sky(s, &sky, 500.0f);
    s->options.features &= ~(uint32_t)RD_FEATURE_AO;
    assert_relative(middle(s), 500.0f * HDRP_LIGHT_MIDDLE_GREY / HDRP_PI, 0.01f);
    close_studio(s);
}

/* >>bad skies */

static double count_of(const studio* s, const char* name)
{
    for (int i = 0; i < s->stats.count_count; ++i) {
        if (!strcmp(s->stats.counts[i].name, name)) {
            return s->stats.counts[i].value;
        }
    }
    fail_msg("nothing was counted as %s", name);
    return 0.0;
}

static void set_texel(rd_image_f32* sky, int i, float r, float g, float b)
{
    float* t = sky->rgba + i * 4;
    t[0] = r;
    t[1] = g;
    t[2] = b;
}

static void assert_all_finite(const float* film)
{
    for (int i = 0; i < PIXELS * 4; ++i) {
        assert_true(isfinite(film[i]));
    }
}

static void bad_texels_of_a_sky_are_counted_and_harm_nothing(void** state)
{
    const rd_quality qualities[3] = {RD_QUALITY_FAST, RD_QUALITY_BALANCED, RD_QUALITY_REFERENCE};
    (void)state;
    for (int q = 0; q < 3; ++q) {
        studio* s = open_studio();
        rd_image_f32 sky = uniform_sky(100.0f);
        float* film;
        set_texel(&sky, 5, NAN, 1.0f, 1.0f);
        set_texel(&sky, 700, 1.0f, NAN, NAN);
        set_texel(&sky, 900, INFINITY, 1.0f, 1.0f);
        set_texel(&sky, 1500, 1.0f, -INFINITY, 1.0f);
        set_texel(&sky, 2000, 1.0f, -3.0f, 1.0f);
        s->options.quality = qualities[q];
        add_spheres(s, plain(0.9f, 0.8f, 0.7f, 0.5f), LARGE);
        set_sky(s, &sky, 0.0f);
        set_up(s);
        film = shoot(s, 1e-2f);
        assert_all_finite(film);
        assert_true(count_of(s, "sky_texels_nan") == 2.0);
        assert_true(count_of(s, "sky_texels_infinite") == 2.0);
        assert_true(count_of(s, "sky_texels_negative") == 1.0);
        assert_int_equal(s->report.warning_count, 1);
        free(film);
        close_studio(s);
    }
}

static void a_sun_beyond_the_largest_half_keeps_its_light(void** state)
{
    studio* s = open_studio();
    rd_image_f32 sky = uniform_sky(0.0f);
    const int row = 4;
    const float nits = 3e6f;
    const double solid_angle = (double)hdrp_env_latlong_solid_angle((hdrp_u32)row, 64u, 32u);
    float* film;
    (void)state;
    set_texel(&sky, row * 64 + 20, nits, nits, nits);
    add_spheres(s, plain(0.9f, 0.8f, 0.7f, 0.5f), LARGE);
    set_sky(s, &sky, 0.0f);
    set_up(s);
    film = shoot(s, 1e-6f);
    assert_all_finite(film);
    /* On level ground, from a texel at this height. */
    assert_relative(
        (float)s->environment.ground_lux,
        (float)((double)nits * solid_angle * cos(((double)row + 0.5) * 3.14159265 / 32)), 0.01f);
    free(film);
    close_studio(s);
}

/* >>real time against the path tracer */

static rd_difference balanced_against_reference(rd_material m)
{
    rd_difference d;
    float* film[2];
    for (int i = 0; i < 2; ++i) {
        studio* s = open_studio();
        s->options.quality = i == 0 ? RD_QUALITY_BALANCED : RD_QUALITY_REFERENCE;
        s->options.spp = i == 0 ? 4 : 32;
        add_spheres(s, m, SMALL);
        add_light(s, RD_LIGHT_POINT, hdrp_v3_make(0.5f, 2.0f, 2.5f), 20000.0f);
        set_sky(s, NULL, 12000.0f);
        set_up(s);
        film[i] = shoot(s, EXPOSURE);
        close_studio(s);
    }
    assert_true(rd_compare(film[0], film[1], WIDTH, HEIGHT, EXPOSURE, &d));
    free(film[0]);
    free(film[1]);
    return d;
}

static void check_reference(const char* name, rd_material m, double least_db)
{
    rd_difference d = balanced_against_reference(m);
    print_message("  balanced against reference, %-18s %6.2f dB, relMSE %.5f, mean ratio %.4f\n",
                  name, d.psnr_db, d.relative_mse, d.mean_ratio);
    assert_true(d.psnr_db >= least_db);
}

static void real_time_comes_near_the_reference(void** state)
{
    rd_material m = plain(0.7f, 0.35f, 0.12f, 0.0f);
    (void)state;
    check_reference("dielectric", m, 30.0);
    m.coat = 1.0f;
    check_reference("coated dielectric", m, 25.0);
    m = plain(0.95f, 0.64f, 0.54f, 1.0f);
    check_reference("metal", m, 22.0);
    m.anisotropy = 0.8f;
    check_reference("anisotropic metal", m, 22.0);
    m = plain(0.6f, 0.55f, 0.5f, 1.0f);
    m.film = 1.0f;
    m.film_ior = 1.6f;
    m.film_thickness_min_nm = m.film_thickness_max_nm = 420.0f;
    check_reference("iridescent metal", m, 22.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isotropic_materials_survive_the_gbuffer_within_50_db),
        cmocka_unit_test(special_materials_survive_the_gbuffer_within_45_db),
        cmocka_unit_test(white_metal_vanishes_in_a_uniform_sky),
        cmocka_unit_test(white_metal_vanishes_for_the_path_tracer_too),
        cmocka_unit_test(lights_have_their_units),
        cmocka_unit_test(what_is_in_the_way_of_a_light_casts_a_shadow),
        cmocka_unit_test(light_crosses_leaves),
        cmocka_unit_test(a_sky_of_so_many_lux_lights_the_ground_so_much),
        cmocka_unit_test(bad_texels_of_a_sky_are_counted_and_harm_nothing),
        cmocka_unit_test(a_sun_beyond_the_largest_half_keeps_its_light),
        cmocka_unit_test(real_time_comes_near_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
