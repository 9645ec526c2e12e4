/* hdrp_render: renders a glTF scene with nothing but the public hdrp headers. */
#include "compare.h"
#include "exposure.h"
#include "file.h"
#include "options.h"
#include "picture.h"
#include "render.h"
#include "vk_backend.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROGRAM "hdrp_render"

typedef struct app {
    rd_options options;
    rd_report report;
    rd_stats stats;
    rd_progress progress;
    rd_scene scene;
    rd_image_f32 env;
    rd_image_f32 reference; /* of --compare */
    rd_trace* trace;
    rd_environment environment;
    rd_lighting lighting;
    float ev100, exposure;
    rd_renderer renderer;
    rd_vk* vk; /* of --backend vulkan */
} app;

/* >>inputs */

static bool load_scene(app* a)
{
    double begin = rd_now_ms();
    bool ok;
    rd_progress_show(&a->progress, "scene", 0, 1);
    ok = a->options.scene ? rd_scene_load_gltf(&a->scene, a->options.scene, &a->report)
                          : rd_scene_build(&a->scene, a->options.builtin, &a->report);
    rd_stats_pass(&a->stats, "load scene", rd_now_ms() - begin);
    if (!ok) {
        return false;
    }
    if (!(a->options.features & RD_FEATURE_TANGENTS)) {
        rd_scene_drop_tangents(&a->scene);
    }
    begin = rd_now_ms();
    rd_progress_show(&a->progress, "textures", 0.5, 1);
    ok = rd_textures_prepare(&a->scene.textures, &a->report);
    rd_stats_pass(&a->stats, "textures", rd_now_ms() - begin);
    return ok;
}

static bool load_images(app* a)
{
    double begin = rd_now_ms();
    if (a->options.env && !rd_image_read_f32(&a->env, a->options.env, &a->report)) {
        return false;
    }
    if (a->options.env) {
        rd_stats_pass(&a->stats, "load sky", rd_now_ms() - begin);
    }
    if (a->options.compare) {
        if (!rd_image_read_f32(&a->reference, a->options.compare, &a->report)) {
            return false;
        }
        if (a->reference.width != a->options.width || a->reference.height != a->options.height) {
            return rd_fail(&a->report, a->options.compare, "is %d x %d, the picture %d x %d",
                           a->reference.width, a->reference.height, a->options.width,
                           a->options.height);
        }
    }
    return true;
}

/* The name that was asked for; of several, "dir/name.png" of frame 7 is "dir/name_0007.png". */
static char* frame_path(const rd_options* o, int frame)
{
    const char* dot = strrchr(o->out, '.');
    size_t size = strlen(o->out) + 16;
    char* out = (char*)malloc(size);
    if (out && o->frames == 1) {
        snprintf(out, size, "%s", o->out);
    } else if (out) {
        snprintf(out, size, "%.*s_%04d%s", (int)(dot - o->out), o->out, frame, dot);
    }
    return out;
}

static bool check_outputs(app* a)
{
    char* first = frame_path(&a->options, 0);
    bool ok = first ? rd_output_check(first, &a->report)
                    : rd_fail(&a->report, a->options.out, "out of memory");
    free(first);
    return ok && (!a->options.stats || rd_output_check(a->options.stats, &a->report));
}

/* The sun of the procedural sky, for scenes that do not say: behind the left shoulder. */
#define SUN_ELEVATION_RAD 0.75f
#define SUN_AZIMUTH_RAD   -0.65f

/* A glTF file without lights says nothing about how bright its world is, but means emission of 1 to
 * look white: under a sky of this illuminance white surfaces have a luminance of 1. */
static float default_lux(const app* a)
{
    return a->options.env || a->scene.has_sky ? 0.0f : HDRP_PI;
}

/* A scene that brings its own lights is dark apart from them. */
static bool make_environment(app* a)
{
    const rd_scene* s = &a->scene;
    const hdrp_v3 dry_ground = {0.24f, 0.22f, 0.19f};
    rd_environment_desc d;
    if (!a->options.env && !s->has_sky && s->light_count > 0) {
        return true;
    }
    d.file = a->options.env ? &a->env : NULL;
    d.name = a->options.env ? a->options.env : "sky";
    d.lux = a->options.env_lux > 0.0f ? a->options.env_lux : default_lux(a);
    d.sun_elevation_rad = s->has_sky ? s->sun_elevation_rad : SUN_ELEVATION_RAD;
    d.sun_azimuth_rad = s->has_sky ? s->sun_azimuth_rad : SUN_AZIMUTH_RAD;
    d.ground_albedo = s->has_sky ? s->ground_albedo : dry_ground;
    d.quality = a->options.quality;
    rd_progress_show(&a->progress, "sky", 0.8, 1);
    return rd_environment_make(&a->environment, &d, &a->stats, &a->report);
}

/* Pictures of surfaces need no light. */
static bool needs_light(const app* a)
{
    return rd_view_stage_of(a->options.view) != RD_STAGE_MATERIAL;
}

static bool make_lighting(app* a)
{
    rd_lighting_desc d = {&a->scene, a->trace, &a->environment, &a->options};
    if (!needs_light(a)) {
        rd_lighting_make_dark(&a->lighting, &d);
        return true;
    }
    return make_environment(a) && rd_lighting_make(&a->lighting, &d, &a->stats, &a->report);
}

static bool load(app* a)
{
    double begin;
    if (!check_outputs(a) || !load_images(a) || !load_scene(a)) {
        return false;
    }
    begin = rd_now_ms();
    a->trace = rd_trace_build(&a->scene, &a->report);
    rd_stats_pass(&a->stats, "build BVH", rd_now_ms() - begin);
    return a->trace && make_lighting(a);
}

static void count_scene(app* a)
{
    rd_stats_count(&a->stats, "triangles", (double)a->scene.triangle_count);
    rd_stats_count(&a->stats, "meshes", a->scene.mesh_count);
    rd_stats_count(&a->stats, "materials", a->scene.material_count);
    rd_stats_count(&a->stats, "textures", a->scene.textures.count);
    rd_stats_count(&a->stats, "texture_bytes", (double)a->scene.textures.memory);
    rd_stats_count(&a->stats, "lights", a->scene.light_count);
}

/* >>pictures */

static bool choose_camera(app* a, rd_camera* out)
{
    const rd_options* o = &a->options;
    const float fov = o->fov_deg * (HDRP_PI / 180.0f);
    rd_camera framed = rd_camera_frame(&a->scene, fov, o->width, o->height);
    *out = framed;
    if (o->has_camera && o->camera >= a->scene.camera_count) {
        return rd_fail(&a->report, "--camera", "%d, but the scene has %d", o->camera,
                       a->scene.camera_count);
    }
    if (o->has_eye || o->has_target) {
        hdrp_v3 eye = o->has_eye ? o->eye : framed.eye;
        hdrp_v3 target = o->has_target ? o->target : framed.target;
        if (!(hdrp_v3_length(hdrp_v3_sub(target, eye)) > 0.0f)) {
            return rd_fail(&a->report, "--eye", "is where --target is, or the scene's centre");
        }
        *out = rd_camera_look_at(eye, target, fov, o->width, o->height);
    } else if (a->scene.camera_count > 0 && !o->has_fov) {
        *out = rd_camera_from_scene(&a->scene, o->camera, o->width, o->height);
    }
    return true;
}

static bool write_picture(app* a, const char* path)
{
    double begin = rd_now_ms();
    const rd_renderer* r = &a->renderer;
    bool ok = rd_picture_write(path, r->width, r->height, r->film,
                               rd_view_encoding(a->options.view), a->exposure, &a->report);
    rd_stats_pass(&a->stats, "write picture", rd_now_ms() - begin);
    return ok;
}

/* Around a thing in full circles; inside a room, to and fro by a small angle. */
static float frame_angle(const app* a, const rd_camera* camera, int frame)
{
    const rd_bounds* b = &a->scene.bounds;
    hdrp_v3 e = camera->eye;
    float turn = HDRP_TWO_PI * (float)frame / (float)a->options.frames;
    bool inside = e.x > b->low.x && e.x < b->high.x && e.y > b->low.y && e.y < b->high.y &&
                  e.z > b->low.z && e.z < b->high.z;
    return inside ? 0.3f * sinf(turn) : turn;
}

/* One exposure for all frames, so that they do not flicker. */
static bool expose(app* a, const rd_camera* camera)
{
    double begin = rd_now_ms();
    bool ok = true;
    a->ev100 = a->options.exposure_ev100;
    if (!a->options.has_exposure && needs_light(a)) {
        ok = rd_exposure_meter(&a->options, &a->lighting, camera, &a->ev100, &a->report);
        rd_stats_pass(&a->stats, "meter exposure", rd_now_ms() - begin);
    }
    a->exposure = hdrp_light_exposure_saturation(a->ev100);
    rd_stats_count(&a->stats, "ev100", (double)a->ev100);
    return ok;
}

static bool begin_rendering(app* a)
{
    rd_renderer_desc d = {&a->options, &a->lighting, a->exposure, &a->stats, &a->progress};
    if (!rd_renderer_begin(&a->renderer, &d, &a->report)) {
        return false;
    }
    if (a->options.backend == RD_BACKEND_VULKAN) {
        a->vk = rd_vk_open(&a->renderer, &a->report);
        a->stats.device = a->vk ? rd_vk_device_name(a->vk) : NULL;
        return a->vk != NULL;
    }
    return true;
}

static bool render(app* a, const rd_camera* camera)
{
    if (a->vk) {
        return rd_vk_render(a->vk, &a->renderer, camera);
    }
    rd_render(&a->renderer, camera);
    return true;
}

static bool render_frames(app* a, const rd_camera* camera)
{
    for (int i = 0; i < a->options.frames; ++i) {
        rd_camera c = rd_camera_orbit(*camera, frame_angle(a, camera, i));
        char* path;
        bool ok;
        if (!render(a, &c)) {
            return false;
        }
        path = frame_path(&a->options, i);
        ok = path ? write_picture(a, path) : rd_fail(&a->report, a->options.out, "out of memory");
        free(path);
        if (!ok) {
            return false;
        }
    }
    return true;
}

static bool compare(app* a)
{
    rd_difference d;
    if (!a->options.compare) {
        return true;
    }
    if (!rd_compare(a->renderer.film, a->reference.rgba, a->renderer.width, a->renderer.height,
                    a->exposure, &d)) {
        return rd_fail(&a->report, a->options.compare, "out of memory");
    }
    rd_stats_error(&a->stats, "compared_pixels", (double)d.pixels);
    rd_stats_error(&a->stats, "psnr_db", d.psnr_db);
    rd_stats_error(&a->stats, "relative_mean", d.relative_mean);
    rd_stats_error(&a->stats, "relative_p999", d.relative_p999);
    rd_stats_error(&a->stats, "relative_max", d.relative_max);
    rd_stats_error(&a->stats, "relative_mse", d.relative_mse);
    rd_stats_error(&a->stats, "mean_ratio", d.mean_ratio);
    return true;
}

static void count_lighting(app* a)
{
    const rd_shade_counts* c = &a->renderer.counts.shade;
    for (int i = 0; i < RD_SHADE_VARIANTS; ++i) {
        if (c->samples[i] > 0) {
            double timed = c->timed_samples[i] > 0 ? (double)c->timed_samples[i] : (double)NAN;
            rd_stats_lit(&a->stats, rd_shade_variant_name(i), (double)c->samples[i],
                         1e6 * c->timed_ms[i] / timed);
        }
    }
}

static void count_lists(app* a)
{
    const rd_lists* l = &a->renderer.lists;
    const rd_shade_counts* c = &a->renderer.counts.shade;
    double samples = 0.0;
    for (int i = 0; i < RD_SHADE_VARIANTS; ++i) {
        samples += (double)c->samples[i];
    }
    if (samples > 0.0) {
        rd_stats_list(&a->stats, "lights_visited",
                      (double)(c->visited[0] + c->visited[1]) / samples);
        rd_stats_list(&a->stats, "lights_in_range",
                      (double)(c->in_range[0] + c->in_range[1]) / samples);
    }
    for (int i = 0; i < 2; ++i) {
        if (c->in_range[i] > 0u) {
            rd_stats_list(&a->stats, i ? "waste_of_clusters" : "waste_of_tiles",
                          (double)c->visited[i] / (double)c->in_range[i]);
        }
    }
    rd_stats_limit(&a->stats, "lights_without_lists", (double)l->left_out);
    rd_stats_limit(&a->stats, "listed_lights_dropped", (double)l->dropped);
    rd_stats_limit(&a->stats, "tiles_full", (double)l->full);
    if (l->ready) {
        rd_stats_list(&a->stats, "tile_entries", (double)l->tiles.counts.entries);
        rd_stats_list(&a->stats, "tile_longest", (double)l->tiles.counts.longest);
        rd_stats_list(&a->stats, "cluster_entries", (double)l->clusters.counts.entries);
        rd_stats_list(&a->stats, "cluster_longest", (double)l->clusters.counts.longest);
        if (l->scene) {
            rd_stats_list(&a->stats, "blocked_lights", (double)l->blocked.lights_removed);
            rd_stats_list(&a->stats, "blockers_by_pixel", (double)l->blocked.pixel);
        }
    }
    rd_variants_count(&a->renderer.variants, &a->stats);
}

static bool finish(app* a)
{
    const rd_render_counts* c = &a->renderer.counts;
    rd_stats_count(&a->stats, "primary_rays", (double)c->primary_rays);
    rd_stats_count(&a->stats, "shadow_rays", (double)c->shadow_rays);
    rd_stats_count(&a->stats, "occlusion_rays", (double)c->occlusion_rays);
    rd_stats_count(&a->stats, "path_rays", (double)c->path_rays);
    rd_stats_count(&a->stats, "deferred_samples", (double)c->deferred_samples);
    rd_stats_count(&a->stats, "forward_samples", (double)c->forward_samples);
    rd_stats_count(&a->stats, "layer_hits", (double)c->layer_hits);
    rd_stats_limit(&a->stats, "transparent_layers_dropped", (double)c->layers_dropped);
    count_lighting(a);
    count_lists(a);
    if (a->vk) {
        rd_vk_count(a->vk, &a->stats);
    }
    if (!compare(a)) {
        return false;
    }
    a->stats.spp = a->renderer.spp;
    return !a->options.stats || rd_stats_write(&a->stats, a->options.stats, &a->report);
}

/* In statistics; the default has none. */
static const char* const builtin_names[] = {NULL, "built-in lights", "built-in transparency"};

static bool run(app* a)
{
    rd_camera camera;
    rd_stats_begin(&a->stats);
    rd_progress_begin(&a->progress, a->options.progress);
    a->stats.scene = a->options.scene ? a->options.scene : builtin_names[a->options.builtin];
    a->stats.width = a->options.width;
    a->stats.height = a->options.height;
    if (!load(a) || !choose_camera(a, &camera)) {
        return false;
    }
    count_scene(a);
    return expose(a, &camera) && begin_rendering(a) && render_frames(a, &camera) && finish(a);
}

static void print_pictures(const rd_options* o)
{
    for (int i = 0; i < o->frames; ++i) {
        char* path = frame_path(o, i);
        printf("%s\n", path ? path : o->out);
        free(path);
    }
}

static void release(app* a)
{
    rd_vk_close(a->vk);
    rd_renderer_end(&a->renderer);
    rd_lighting_free(&a->lighting);
    rd_environment_free(&a->environment);
    rd_trace_free(a->trace);
    rd_scene_free(&a->scene);
    rd_image_free_f32(&a->env);
    rd_image_free_f32(&a->reference);
}

static int report_failure(const app* a)
{
    fprintf(stderr, PROGRAM ": %s\n", a->report.error);
    return 1;
}

int main(int argc, char** argv)
{
    static app a; /* zeroed, and large for a stack */
    bool ok;
    if (!rd_options_parse(&a.options, argc, argv, &a.report)) {
        return report_failure(&a);
    }
    if (a.options.show_help) {
        rd_options_print_help();
        return 0;
    }
    if (a.options.show_version) {
        printf(PROGRAM " %d.%d.%d\n", HDRP_VERSION_MAJOR, HDRP_VERSION_MINOR, HDRP_VERSION_PATCH);
        return 0;
    }
    ok = run(&a);
    rd_progress_end(&a.progress);
    if (ok) {
        rd_print_warnings(&a.report, PROGRAM);
        rd_stats_print(&a.stats);
        print_pictures(&a.options);
    }
    release(&a);
    return ok ? 0 : report_failure(&a);
}
