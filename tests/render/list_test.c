/* Lists of lights: pictures are the same bits as without them, whatever is lit, by whatever lights,
 * for whatever camera; and light layers and blockers do what they say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "studio.h"

#include <stdlib.h>
#include <string.h>

#define EXPOSURE 1e-2f

/* >>scenes */

static float random_of(uint32_t i, uint32_t purpose)
{
    return hdrp_unit_from_u32(hdrp_hash2(i, purpose));
}

static hdrp_v3 random_v3(uint32_t i, uint32_t purpose, float size)
{
    return hdrp_v3_make(size * (2.0f * random_of(i, purpose) - 1.0f),
                        size * (2.0f * random_of(i, purpose + 1u) - 1.0f),
                        size * (2.0f * random_of(i, purpose + 2u) - 1.0f));
}

/* Lights of all types around the origin, on one of three layers or on all. */
static void add_lights(studio* s, uint32_t count, float range_m)
{
    for (uint32_t i = 0; i < count; ++i) {
        rd_light l;
        memset(&l, 0, sizeof l);
        l.type = i % 50u == 7u ? RD_LIGHT_DIRECTIONAL : (rd_light_type)(RD_LIGHT_POINT + i % 4u);
        l.position = random_v3(i, 1u, 1.8f);
        l.forward = hdrp_normalize_or(random_v3(i, 4u, 1.0f), hdrp_v3_make(0.0f, -1.0f, 0.0f));
        l.up = hdrp_v3_make(0.0f, 1.0f, 0.0f);
        l.color = hdrp_v3_make(random_of(i, 7u), random_of(i, 8u), random_of(i, 9u));
        l.intensity = l.type == RD_LIGHT_DIRECTIONAL ? 5.0f : 100.0f;
        l.range_m = range_m * (0.1f + random_of(i, 10u));
        l.inner_angle_rad = 0.2f;
        l.outer_angle_rad = 0.3f + random_of(i, 11u);
        l.half_width = 0.1f + random_of(i, 12u);
        l.half_height = 0.1f + random_of(i, 13u);
        l.light_layers = i % 4u ? 1u << (i % 3u) : 0u;
        l.shadowless = i % 2u == 0u;
        assert_true(rd_scene_add_light(&s->scene, &l));
    }
}

/* A wall in front of which spheres float, each mesh on layers of its own. */
static studio* open_scene(void)
{
    studio* s = open_studio();
    s->options.spp = 2;
    s->options.seed = 5u;
    add(s, rd_shape_card(8.0f, 8.0f, 0.0f, hdrp_v2_make(1.0f, 1.0f)), plain(0.6f, 0.6f, 0.6f, 0.0f),
        hdrp_v3_make(0.0f, -4.0f, -0.8f));
    for (int i = 0; i < 6; ++i) {
        rd_material m = plain(0.9f, 0.6f, 0.3f, (float)(i % 2));
        m.perceptual_roughness = 0.2f + 0.15f * (float)i;
        m.coat = i == 3 ? 1.0f : 0.0f; /* drawn forward */
        add(s, rd_shape_sphere(0.35f, 48, hdrp_v2_make(1.0f, 1.0f)), m,
            hdrp_v3_make((float)(i % 3) - 1.0f, i < 3 ? 0.5f : -0.5f, 0.3f * (float)(i % 2)));
        s->scene.meshes[s->scene.mesh_count - 1].light_layers = 1u << (i % 3);
    }
    return s;
}

static void add_glass(studio* s)
{
    rd_material pane = plain(0.4f, 0.6f, 0.9f, 0.0f), glass = plain(1.0f, 1.0f, 1.0f, 0.0f);
    pane.alpha_mode = RD_ALPHA_BLEND;
    pane.alpha = 0.4f;
    pane.double_sided = true;
    glass.transmission = 1.0f;
    glass.thickness = 0.4f;
    glass.perceptual_roughness = 0.1f;
    for (int i = 0; i < 3; ++i) {
        add(s, rd_shape_card(1.2f, 2.0f, 0.5f, hdrp_v2_make(1.0f, 1.0f)), pane,
            hdrp_v3_make(0.5f * (float)i - 0.8f, -1.0f, 0.9f + 0.6f * (float)i));
    }
    add(s, rd_shape_sphere(0.3f, 48, hdrp_v2_make(1.0f, 1.0f)), glass,
        hdrp_v3_make(0.6f, 0.1f, 1.2f));
}

/* >>comparison */

static float* shoot_with(studio* s, uint32_t features, uint64_t* visited)
{
    float* film;
    s->options.features = features;
    s->lighting.features = features;
    film = shoot(s, EXPOSURE);
    *visited = s->counts.shade.visited[0] + s->counts.shade.visited[1];
    return film;
}

/* The same bits with lists and without; how many more lights are visited without. */
static double compare_lists(studio* s)
{
    size_t size = (size_t)s->options.width * (size_t)s->options.height * 4u * sizeof(float);
    uint64_t listed, all;
    float* with = shoot_with(s, RD_FEATURE_ALL, &listed);
    float* without = shoot_with(s, RD_FEATURE_ALL & ~RD_FEATURE_LISTS, &all);
    assert_memory_equal(with, without, size);
    free(with);
    free(without);
    return (double)all / (double)listed;
}

static void check(studio* s, const char* name, double least_gain)
{
    double gain = compare_lists(s);
    print_message("  %-34s %6.2f times as many lights visited without lists\n", name, gain);
    assert_true(s->counts.shade.in_range[0] > 0u);
    assert_true(gain >= least_gain);
}

static void pictures_are_the_same_with_lists(void** state)
{
    studio* s = open_scene();
    (void)state;
    add_lights(s, 300u, 0.8f);
    set_up(s);
    check(s, "deferred", 2.0);
    s->options.path = RD_PATH_FORWARD;
    check(s, "forward", 2.0);
    close_studio(s);
}

static void transparent_surfaces_are_the_same_with_clusters(void** state)
{
    studio* s = open_scene();
    (void)state;
    add_glass(s);
    add_lights(s, 300u, 0.8f);
    set_up(s);
    check(s, "transparent", 2.0);
    close_studio(s);
}

static void cameras_of_all_kinds_are_the_same_with_lists(void** state)
{
    studio* s = open_scene();
    (void)state;
    add_glass(s);
    add_lights(s, 200u, 0.8f);
    set_up(s);
    s->camera.orthographic = true;
    s->camera.half_width = 1.5f;
    s->camera.half_height = 1.0f;
    check(s, "orthographic", 2.0);
    s->camera = rd_camera_look_at(hdrp_v3_make(0.1f, 0.05f, 0.9f), hdrp_v3_make(0.3f, -0.2f, 0.0f),
                                  2.6f, WIDTH, HEIGHT);
    check(s, "wide, among the lights", 1.2);
    s->camera =
        rd_camera_look_at(s->scene.lights[0].position, hdrp_v3_splat(0.0f), 0.8f, WIDTH, HEIGHT);
    check(s, "at a light", 1.0);
    close_studio(s);
}

static void pictures_of_all_sizes_are_the_same_with_lists(void** state)
{
    static const int sizes[4][2] = {{1, 1}, {17, 33}, {70, 3}, {241, 65}};
    (void)state;
    for (int i = 0; i < 4; ++i) {
        studio* s = open_scene();
        s->options.width = sizes[i][0];
        s->options.height = sizes[i][1];
        add_glass(s);
        add_lights(s, 100u, 0.8f);
        set_up(s);
        compare_lists(s);
        close_studio(s);
    }
}

/* More of them than a tile has room for at first. */
static void lights_without_range_are_all_listed(void** state)
{
    studio* s = open_scene();
    (void)state;
    s->options.width = 64;
    s->options.height = 40;
    add_glass(s);
    add_lights(s, 700u, 0.0f);
    set_up(s);
    check(s, "without range", 1.0);
    close_studio(s);
}

/* >>the street: blockers, portals and clip planes */

static studio* open_street(void)
{
    studio* s = open_studio();
    rd_lighting_desc d = {&s->scene, NULL, &s->environment, &s->options};
    assert_true(rd_scene_build(&s->scene, RD_BUILTIN_LIGHTS, &s->report));
    s->trace = rd_trace_build(&s->scene, &s->report);
    assert_non_null(s->trace);
    d.trace = s->trace;
    assert_true(rd_lighting_make(&s->lighting, &d, &s->stats, &s->report));
    s->camera = rd_camera_from_scene(&s->scene, 0, WIDTH, HEIGHT);
    return s;
}

static void blockers_that_masks_leave_out_keep_no_light_away(void** state)
{
    studio* s = open_street();
    uint64_t ignored;
    size_t size = PIXELS * 4u * sizeof(float);
    float *blocked, *leaking;
    (void)state;
    check(s, "street", 4.0);
    blocked = shoot_with(s, RD_FEATURE_ALL, &ignored);
    leaking = shoot_with(s, RD_FEATURE_ALL & ~RD_FEATURE_BLOCKERS, &ignored);
    assert_true(memcmp(blocked, leaking, size) != 0);
    free(blocked);
    free(leaking);
    close_studio(s);
}

static void almost_no_light_is_visited_in_vain(void** state)
{
    studio* s = open_street();
    const rd_shade_counts* c = &s->counts.shade;
    double tiles, clusters;
    (void)state;
    free(shoot(s, EXPOSURE));
    tiles = (double)c->visited[0] / (double)c->in_range[0];
    clusters = (double)c->visited[1] / (double)c->in_range[1];
    print_message("  visited over in range: %.3f by tiles, %.3f by clusters\n", tiles, clusters);
    /* Tiles are as large here as five times as many pixels of a full picture are. */
    assert_true(tiles >= 1.0 && tiles <= 1.35);
    assert_true(clusters >= 1.0 && clusters <= 4.0);
    close_studio(s);
}

/* >>what lights are kept from */

/* The middle of a grey wall at which a light shines. */
static float wall_lit(rd_quality quality, rd_path path, uint32_t wall_layers, uint32_t light_layers,
                      const hdrp_cull_blocker* blockers, uint32_t count)
{
    studio* s = open_studio();
    float* film;
    float y;
    s->options.quality = quality;
    s->options.path = path;
    add(s, rd_shape_card(8.0f, 8.0f, 0.0f, hdrp_v2_make(1.0f, 1.0f)), plain(0.5f, 0.5f, 0.5f, 0.0f),
        hdrp_v3_make(0.0f, -4.0f, 0.0f));
    s->scene.meshes[0].light_layers = wall_layers;
    add_light(s, RD_LIGHT_POINT, hdrp_v3_make(0.0f, 0.0f, 2.0f), 100.0f);
    s->scene.lights[0].light_layers = light_layers;
    for (uint32_t i = 0; i < count; ++i) {
        assert_true(rd_scene_add_blocker(&s->scene, &blockers[i]) == (int)i);
    }
    if (count > 0u) { /* the first is linked, others are its portals */
        assert_true(rd_scene_link_blocker(&s->scene, 0u));
        s->scene.lights[0].blocker_count = 1u;
    }
    set_up(s);
    film = shoot(s, EXPOSURE);
    y = pixel(film, WIDTH / 2, HEIGHT / 2).y;
    free(film);
    close_studio(s);
    return y;
}

static void lights_shine_on_their_layers_only(void** state)
{
    (void)state;
    for (int q = 0; q < 2; ++q) {
        rd_quality quality = q ? RD_QUALITY_REFERENCE : RD_QUALITY_BALANCED;
        for (int p = 0; p < 2; ++p) {
            rd_path path = p ? RD_PATH_FORWARD : RD_PATH_DEFERRED;
            assert_true(wall_lit(quality, path, 0u, 2u, NULL, 0u) > 0.0f);
            assert_true(wall_lit(quality, path, 6u, 2u, NULL, 0u) > 0.0f);
            assert_true(wall_lit(quality, path, 1u, 2u, NULL, 0u) == 0.0f);
        }
    }
}

static void a_blocker_keeps_light_away_but_for_its_portal(void** state)
{
    hdrp_v3 at = hdrp_v3_make(0.0f, 0.0f, 1.0f), front = hdrp_v3_make(0.0f, 0.0f, 1.0f);
    hdrp_v3 up = hdrp_v3_make(0.0f, 1.0f, 0.0f), beside = hdrp_v3_make(2.0f, 0.0f, 1.0f);
    hdrp_cull_blocker b[2];
    rd_quality quality = RD_QUALITY_BALANCED;
    (void)state;
    b[0] = hdrp_cull_blocker_rectangle(at, front, up, 1.0f, 1.0f);
    b[1] = hdrp_cull_blocker_rectangle(at, front, up, 0.1f, 0.1f);
    assert_true(wall_lit(quality, RD_PATH_DEFERRED, 0u, 0u, b, 1u) == 0.0f);
    b[0] = hdrp_cull_blocker_with_portals(b[0], 1u, 1u);
    assert_true(wall_lit(quality, RD_PATH_DEFERRED, 0u, 0u, b, 2u) > 0.0f);
    b[0] = hdrp_cull_blocker_rectangle(beside, front, up, 1.0f, 1.0f);
    assert_true(wall_lit(quality, RD_PATH_DEFERRED, 0u, 0u, b, 1u) > 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_the_same_with_lists),
        cmocka_unit_test(transparent_surfaces_are_the_same_with_clusters),
        cmocka_unit_test(cameras_of_all_kinds_are_the_same_with_lists),
        cmocka_unit_test(pictures_of_all_sizes_are_the_same_with_lists),
        cmocka_unit_test(lights_without_range_are_all_listed),
        cmocka_unit_test(blockers_that_masks_leave_out_keep_no_light_away),
        cmocka_unit_test(almost_no_light_is_visited_in_vain),
        cmocka_unit_test(lights_shine_on_their_layers_only),
        cmocka_unit_test(a_blocker_keeps_light_away_but_for_its_portal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
