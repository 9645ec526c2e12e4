/* Blended surfaces without sorting against sorted ones: what has to be equal, and by how much whole
 * scenes differ in each mode, as recorded. --csv FILE writes the record. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "exposure.h"
#include "file.h"
#include "oit.h"
#include "studio.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* >>pictures that are known */

#define EXPOSURE 1e-4f

static rd_material blended(float r, float g, float b, float alpha)
{
    rd_material m = plain(r, g, b, 0.0f);
    m.alpha_mode = RD_ALPHA_BLEND;
    m.double_sided = true;
    m.alpha = alpha;
    return m;
}

static rd_shape square(float size)
{
    return rd_shape_card(size, size, 0.0f, hdrp_v2_make(1.0f, 1.0f));
}

/* A wall behind the origin. */
static studio* open_wall(void)
{
    studio* s = open_studio();
    s->options.quality = RD_QUALITY_FAST;
    add(s, square(20.0f), plain(0.5f, 0.3f, 0.2f, 0.0f), hdrp_v3_make(0.0f, -10.0f, -2.0f));
    add_light(s, RD_LIGHT_DIRECTIONAL, hdrp_v3_make(0.2f, 0.5f, 1.0f), 30000.0f);
    return s;
}

static float* shoot_as(studio* s, rd_oit oit)
{
    s->options.oit = oit;
    return shoot(s, EXPOSURE);
}

/* The largest difference, in what is shown as white. */
static float largest(const float* a, const float* b)
{
    float d = 0.0f;
    for (int i = 0; i < PIXELS * 4; ++i) {
        d = hdrp_max(d, hdrp_abs(a[i] - b[i]) * (i % 4 == 3 ? 1.0f : EXPOSURE));
    }
    return d;
}

/* The same of some modes against sorting. */
static float against_sorted(studio* s, rd_oit first, rd_oit last)
{
    float* sorted = shoot_as(s, RD_OIT_SORTED);
    float d = 0.0f;
    for (int m = (int)first; m <= (int)last; ++m) {
        float* other = shoot_as(s, (rd_oit)m);
        d = hdrp_max(d, largest(sorted, other));
        free(other);
    }
    free(sorted);
    return d;
}

#define FIRST RD_OIT_MCGUIRE
#define LAST  RD_OIT_WAVELET

static void one_layer_is_that_of_sorting_in_every_mode(void** state)
{
    studio* s = open_wall();
    (void)state;
    add(s, square(1.5f), blended(0.1f, 0.6f, 0.3f, 0.4f), hdrp_v3_make(0.0f, -0.75f, 0.0f));
    set_up(s);
    assert_true(against_sorted(s, FIRST, LAST) < 4e-3f); /* a code of 8 bits */
    close_studio(s);
}

/* Three lamps of which two overlap. The talk divides what is added by its weights. */
static void what_only_adds_light_is_exact_but_for_the_talk(void** state)
{
    studio* s = open_wall();
    rd_material m = blended(0.0f, 0.0f, 0.0f, 0.7f);
    float *sorted, *without;
    (void)state;
    m.additive = true;
    m.emission_nits = hdrp_v3_make(9000.0f, 4000.0f, 1000.0f);
    add(s, square(0.8f), m, hdrp_v3_make(-0.5f, -0.4f, 0.0f));
    add(s, square(0.8f), m, hdrp_v3_make(0.0f, -0.4f, 0.5f));
    set_up(s);
    assert_true(against_sorted(s, RD_OIT_MCGUIRE, RD_OIT_MCGUIRE) < 2e-3f);
    assert_true(against_sorted(s, RD_OIT_RECOMMENDED, LAST) < 2e-3f);
    sorted = shoot_as(s, RD_OIT_SORTED);
    s->options.features &= ~(uint32_t)RD_FEATURE_ALPHA_BLEND;
    without = shoot_as(s, RD_OIT_SORTED);
    /* 0.7 of it over the wall, twice in the middle. */
    for (int x = 0; x < WIDTH; ++x) {
        hdrp_v3 d = hdrp_v3_sub(pixel(sorted, x, HEIGHT / 2), pixel(without, x, HEIGHT / 2));
        assert_true(fabsf(d.x) < 1.0f || fabsf(d.x - 6300.0f) < 1.0f ||
                    fabsf(d.x - 12600.0f) < 1.0f);
    }
    assert_true(largest(sorted, without) > 1.2f);
    free(sorted);
    free(without);
    close_studio(s);
}

/* Behind glass and before it: glass keeps its order, and is the same bits where nothing blends. */
static void what_transmits_keeps_its_order(void** state)
{
    studio* s = open_wall();
    rd_material glass = plain(0.9f, 0.5f, 0.4f, 0.0f);
    (void)state;
    glass.transmission = 1.0f;
    glass.double_sided = true;
    add(s, square(1.2f), glass, hdrp_v3_make(0.0f, -0.6f, 0.0f));
    add(s, square(1.2f), glass, hdrp_v3_make(0.2f, -0.5f, 0.5f));
    set_up(s);
    assert_true(against_sorted(s, FIRST, LAST) == 0.0f);
    close_studio(s);
    s = open_wall();
    add(s, square(1.2f), glass, hdrp_v3_make(0.0f, -0.6f, 0.0f));
    add(s, square(0.8f), blended(0.1f, 0.6f, 0.3f, 0.4f), hdrp_v3_make(0.2f, -0.5f, 0.5f));
    set_up(s);
    assert_true(against_sorted(s, RD_OIT_WAVELET, RD_OIT_WAVELET) < 1e-3f);
    close_studio(s);
}

/* >>half of the resolution */

/* A soft thing over the whole picture, and a box before its middle: pixels of the box that are three
 * or more from its edges show no trace of it, others in the open are exact. */
static void half_resolution_leaks_over_no_more_than_edges(void** state)
{
    studio* s = open_wall();
    rd_material soft = blended(0.5f, 0.5f, 0.5f, 0.6f);
    float* sorted;
    int inside = 0, at_edges = 0;
    (void)state;
    soft.unlit = true; /* no shadows, whose edges would be softer */
    soft.half_resolution = true;
    add(s, square(30.0f), soft, hdrp_v3_make(0.0f, -15.0f, -1.0f));
    add(s, square(1.0f), plain(0.02f, 0.02f, 0.02f, 0.0f), hdrp_v3_make(0.0f, -0.5f, 0.0f));
    set_up(s);
    sorted = shoot_as(s, RD_OIT_SORTED);
    for (int m = RD_OIT_SORTED + 1; m < RD_OIT_COUNT; ++m) {
        float* film = shoot_as(s, (rd_oit)m);
        for (int y = 3; y + 3 < HEIGHT; ++y) {
            for (int x = 3; x + 3 < WIDTH; ++x) {
                hdrp_v3 here = pixel(sorted, x, y), is = pixel(film, x, y);
                bool edge = false;
                for (int k = 0; k < 49; ++k) {
                    hdrp_v3 there = pixel(sorted, x + k % 7 - 3, y + k / 7 - 3);
                    edge = edge || hdrp_abs(there.y - here.y) > 1000.0f;
                }
                if (edge) {
                    at_edges += hdrp_abs(is.y - here.y) * EXPOSURE > 0.05f;
                } else {
                    ++inside;
                    assert_true(hdrp_abs(is.y - here.y) * EXPOSURE < 4e-3f);
                }
            }
        }
        free(film);
    }
    assert_true(inside > 6 * PIXELS / 2 && at_edges > 0); /* it does leak: else nothing was low */
    free(sorted);
    close_studio(s);
}

/* Marks change nothing where they are turned off, nor where pictures are sorted. */
static void marks_can_be_turned_off(void** state)
{
    float* film[3];
    (void)state;
    for (int i = 0; i < 3; ++i) {
        studio* s = open_wall();
        rd_material m = blended(0.9f, 0.1f, 0.3f, 0.5f);
        m.half_resolution = i > 0;
        add(s, rd_shape_sphere(0.4f, 24, hdrp_v2_make(1.0f, 1.0f)), m, hdrp_v3_splat(0.0f));
        set_up(s);
        s->options.features &= i == 1 ? ~(uint32_t)RD_FEATURE_HALF_RESOLUTION : ~0u;
        film[i] = shoot_as(s, RD_OIT_MOMENTS);
        close_studio(s);
    }
    assert_memory_equal(film[0], film[1], PIXELS * 4 * sizeof(float));
    assert_true(largest(film[0], film[2]) > 0.01f);
    free(film[0]);
    free(film[1]);
    free(film[2]);
}

/* >>scenes */

#define COPIES 4

typedef struct figures {
    double pixels, rmse, worst, psnr_db;
} figures;

static const char* const scenes[] = {"transparency", "AlphaBlendModeTest", "glass-table", "love"};
#define SCENES (sizeof scenes / sizeof scenes[0])

static void* copied(const void* from, size_t bytes)
{
    void* to = from ? malloc(bytes) : NULL;
    assert_true(!from || to);
    return from ? memcpy(to, from, bytes) : NULL;
}

static rd_mesh copy_of(const rd_mesh* m)
{
    rd_mesh c = *m;
    c.positions = copied(m->positions, (m->vertex_count + 1u) * sizeof *m->positions);
    c.normals = copied(m->normals, m->vertex_count * sizeof *m->normals);
    c.tangents = copied(m->tangents, m->vertex_count * sizeof *m->tangents);
    c.colors = copied(m->colors, m->vertex_count * sizeof *m->colors);
    c.indices = copied(m->indices, m->triangle_count * 3u * sizeof *m->indices);
    for (int i = 0; i < RD_MAX_UV_SETS; ++i) {
        c.uv[i] = copied(m->uv[i], m->vertex_count * sizeof *m->uv[i]);
    }
    return c;
}

/* Again and again behind itself, a little to the side. */
static void repeat(studio* s)
{
    int count = s->scene.mesh_count;
    hdrp_v3 size = hdrp_v3_sub(s->scene.bounds.high, s->scene.bounds.low);
    hdrp_v3 side = hdrp_v3_scale(s->camera.right, 0.06f * hdrp_v3_length(size));
    hdrp_v3 step = hdrp_v3_mad(side, s->camera.forward, 0.4f * hdrp_v3_length(size));
    for (int k = 1; k < COPIES; ++k) {
        for (int i = 0; i < count; ++i) {
            rd_mesh m = copy_of(&s->scene.meshes[i]);
            rd_affine a = rd_affine_identity();
            a.t = hdrp_v3_scale(step, (float)k);
            rd_mesh_transform(&m, a);
            assert_true(rd_scene_add_mesh(&s->scene, &m));
        }
    }
    rd_scene_update_bounds(&s->scene);
}

static bool load(studio* s, const char* name)
{
    const char* assets = getenv("HDRP_TEST_ASSETS");
    char path[1000];
    uint64_t bytes;
    if (!strcmp(name, "transparency")) {
        return rd_scene_build(&s->scene, RD_BUILTIN_TRANSPARENCY, &s->report);
    }
    snprintf(path, sizeof path, "%s/gltf/%s.glb", assets ? assets : ASSETS, name);
    return rd_file_size(path, &bytes) && rd_scene_load_gltf(&s->scene, path, &s->report);
}

static void light(studio* s)
{
    const rd_scene* scene = &s->scene;
    rd_environment_desc d = {
        NULL, "sky", HDRP_PI, 0.75f, -0.65f, {0.24f, 0.22f, 0.19f}, s->options.quality};
    rd_lighting_desc l = {scene, NULL, &s->environment, &s->options};
    if (scene->has_sky) {
        d.lux = 0.0f;
        d.sun_elevation_rad = scene->sun_elevation_rad;
        d.sun_azimuth_rad = scene->sun_azimuth_rad;
        d.ground_albedo = scene->ground_albedo;
    }
    s->trace = rd_trace_build(scene, &s->report);
    assert_non_null(s->trace);
    l.trace = s->trace;
    assert_true(rd_environment_make(&s->environment, &d, &s->stats, &s->report) &&
                rd_lighting_make(&s->lighting, &l, &s->stats, &s->report));
}

/* NULL where the file is missing. Nothing transmits: that would not be blended. */
static studio* open_scene(const char* name)
{
    studio* s = open_studio();
    s->options.quality = RD_QUALITY_FAST;
    s->options.fov_deg = 40.0f;
    if (!load(s, name)) {
        close_studio(s);
        return NULL;
    }
    if (strcmp(name, "transparency") != 0) {
        s->options.features &= ~(uint32_t)RD_FEATURE_REFRACTION;
    }
    assert_true(rd_textures_prepare(&s->scene.textures, &s->report));
    s->camera = s->scene.camera_count > 0 ? rd_camera_from_scene(&s->scene, 0, WIDTH, HEIGHT)
                                          : rd_camera_frame(&s->scene, 0.7f, WIDTH, HEIGHT);
    if (!strcmp(name, "love")) {
        repeat(s);
    }
    light(s);
    return s;
}

static bool has_half_resolution(const studio* s)
{
    rd_options o = s->options;
    o.oit = RD_OIT_WAVELET;
    return rd_oit_has_low(&o, &s->scene);
}

/* Of the pixels that blended surfaces change in either picture. */
static figures difference(const float* without, const float* sorted, float* film, float exposure)
{
    rd_difference d;
    figures f;
    for (size_t i = 0; i < PIXELS * 4; i += 4) {
        bool touched = memcmp(without + i, sorted + i, 12) || memcmp(without + i, film + i, 12);
        film[i + 3] = touched ? 1.0f : 0.0f;
    }
    assert_true(rd_compare(film, sorted, WIDTH, HEIGHT, exposure, &d));
    f.pixels = (double)d.pixels;
    f.rmse = sqrt(d.relative_mse);
    f.worst = d.relative_max;
    f.psnr_db = d.psnr_db;
    return f;
}

/* Of all modes, with half resolution and without; false where the scene is missing. */
static bool measure(const char* name, figures out[2][RD_OIT_COUNT])
{
    studio* s = open_scene(name);
    float *sorted, *without, exposure, ev100;
    if (!s) {
        return false;
    }
    assert_true(rd_exposure_meter(&s->options, &s->lighting, &s->camera, &ev100, &s->report));
    exposure = hdrp_light_exposure_saturation(ev100);
    sorted = shoot(s, exposure);
    s->options.features &= ~(uint32_t)RD_FEATURE_ALPHA_BLEND;
    without = shoot(s, exposure);
    s->options.features |= RD_FEATURE_ALPHA_BLEND;
    for (size_t i = 0; i < PIXELS; ++i) {
        sorted[i * 4 + 3] = 1.0f;
    }
    for (int full = 0; full < 2; ++full) {
        for (int m = FIRST; m <= LAST && (full || has_half_resolution(s)); ++m) {
            float* film;
            s->options.oit = (rd_oit)m;
            film = shoot(s, exposure);
            out[full][m] = difference(without, sorted, film, exposure);
            free(film);
        }
        s->options.features &= ~(uint32_t)RD_FEATURE_HALF_RESOLUTION;
    }
    free(sorted);
    free(without);
    close_studio(s);
    return true;
}

/* >>the record */

static bool recorded(const char* scene, const char* resolution, const char* mode, figures* out)
{
    FILE* f = fopen(RECORDED, "r");
    char line[300], key[150];
    bool found = false;
    int end;
    snprintf(key, sizeof key, "%s,%s,%s,", scene, resolution, mode);
    end = (int)strlen(key);
    while (f && !found && fgets(line, sizeof line, f)) {
        found =
            !strncmp(line, key, (size_t)end) && sscanf(line + end, "%lf,%lf,%lf,%lf", &out->pixels,
                                                       &out->rmse, &out->worst, &out->psnr_db) == 4;
    }
    if (f) {
        fclose(f);
    }
    return found;
}

/* Other compilers and processors round otherwise; single pixels may then lie on another side of an
 * edge. */
static bool is_near(double is, double was, double share, double floor)
{
    return fabs(is - was) <= fmax(share * was, floor);
}

static const char* const resolutions[2] = {"half", "full"};

static bool check_figures(const char* name, const char* resolution, const figures* is)
{
    bool ok = true;
    for (int m = FIRST; m <= LAST; ++m) {
        const char* mode = rd_oit_name((rd_oit)m);
        figures was;
        print_message("  %-18s %s %-11s %5.0f pixels, RMSE %.5f, worst %.4f, %.1f dB\n", name,
                      resolution, mode, is[m].pixels, is[m].rmse, is[m].worst, is[m].psnr_db);
        ok = recorded(name, resolution, mode, &was) && ok;
        ok = ok && is_near(is[m].pixels, was.pixels, 0.01, 20.0) &&
             is_near(is[m].rmse, was.rmse, 0.03, 1e-4) &&
             is_near(is[m].worst, was.worst, 0.15, 2e-3);
    }
    return ok;
}

static bool was_measured(const figures* is)
{
    return is[FIRST].pixels > 0.0;
}

static void check_scene(const char* name)
{
    figures is[2][RD_OIT_COUNT];
    memset(is, 0, sizeof is);
    if (!measure(name, is)) {
        print_message("  skipped: %s is not there\n", name);
        return;
    }
    assert_true(was_measured(is[1]));
    for (int i = 0; i < 2; ++i) {
        assert_true(!was_measured(is[i]) || check_figures(name, resolutions[i], is[i]));
    }
}

static void scenes_differ_from_sorting_as_recorded(void** state)
{
    (void)state;
    for (size_t i = 0; i < SCENES; ++i) {
        check_scene(scenes[i]);
    }
}

static void rows_may_be_done_by_any_number_of_threads(void** state)
{
    studio* s = open_scene("transparency");
    int threads = omp_get_max_threads();
    float* film[2];
    (void)state;
    for (int i = 0; i < 2; ++i) {
        omp_set_num_threads(i ? 3 : 1);
        film[i] = shoot_as(s, RD_OIT_WAVELET);
    }
    omp_set_num_threads(threads);
    assert_memory_equal(film[0], film[1], PIXELS * 4 * sizeof(float));
    free(film[0]);
    free(film[1]);
    close_studio(s);
}

static int record(const char* path)
{
    FILE* f = fopen(path, "w");
    if (!f) {
        return 1;
    }
    fprintf(f, "scene,resolution,mode,pixels,relative_rmse,relative_worst,psnr_db\n");
    for (size_t i = 0; i < SCENES; ++i) {
        figures x[2][RD_OIT_COUNT];
        memset(x, 0, sizeof x);
        if (!measure(scenes[i], x)) {
            printf("%s is not there\n", scenes[i]);
            fclose(f);
            return 1;
        }
        for (int k = FIRST; k < 2 * RD_OIT_COUNT; ++k) {
            int full = k / RD_OIT_COUNT, m = k % RD_OIT_COUNT;
            if (m >= FIRST && was_measured(x[full])) {
                fprintf(f, "%s,%s,%s,%.0f,%.3g,%.3g,%.3g\n", scenes[i], resolutions[full],
                        rd_oit_name((rd_oit)m), x[full][m].pixels, x[full][m].rmse,
                        x[full][m].worst, fmin(x[full][m].psnr_db, 999.0));
            }
        }
    }
    return fclose(f) != 0;
}

int main(int argc, char** argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_layer_is_that_of_sorting_in_every_mode),
        cmocka_unit_test(what_only_adds_light_is_exact_but_for_the_talk),
        cmocka_unit_test(what_transmits_keeps_its_order),
        cmocka_unit_test(half_resolution_leaks_over_no_more_than_edges),
        cmocka_unit_test(marks_can_be_turned_off),
        cmocka_unit_test(rows_may_be_done_by_any_number_of_threads),
        cmocka_unit_test(scenes_differ_from_sorting_as_recorded),
    };
    if (argc == 3 && !strcmp(argv[1], "--csv")) {
        return record(argv[2]);
    }
    return cmocka_run_group_tests_name("transparency without sorting", tests, NULL, NULL);
}
