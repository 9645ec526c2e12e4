/* hdrp_render: renders a glTF scene with nothing but the public hdrp headers. */
#include "compare.h"
#include "file.h"
#include "options.h"
#include "picture.h"
#include "render.h"

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
    rd_renderer renderer;
} app;

/* >>inputs */

static bool load_scene(app* a)
{
    double begin = rd_now_ms();
    bool ok;
    rd_progress_show(&a->progress, "scene", 0, 1);
    ok = a->options.scene ? rd_scene_load_gltf(&a->scene, a->options.scene, &a->report)
                          : rd_scene_build_builtin(&a->scene, &a->report);
    rd_stats_pass(&a->stats, "load scene", rd_now_ms() - begin);
    if (!ok) {
        return false;
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

static bool check_outputs(app* a)
{
    return (a->options.frames > 1 || rd_output_check(a->options.out, &a->report)) &&
           (!a->options.stats || rd_output_check(a->options.stats, &a->report));
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
    return a->trace != NULL;
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
        *out =
            rd_camera_look_at(o->has_eye ? o->eye : framed.eye,
                              o->has_target ? o->target : framed.target, fov, o->width, o->height);
    } else if (a->scene.camera_count > 0 && !o->has_fov) {
        *out = rd_camera_from_scene(&a->scene, o->camera, o->width, o->height);
    }
    return true;
}

/* "dir/name.png" of frame 7 is "dir/name_0007.png". */
static char* frame_path(const char* path, int frame)
{
    const char* dot = strrchr(path, '.');
    size_t size = strlen(path) + 16;
    char* out = (char*)malloc(size);
    if (out) {
        snprintf(out, size, "%.*s_%04d%s", (int)(dot - path), path, frame, dot);
    }
    return out;
}

static bool write_picture(app* a, const char* path)
{
    double begin = rd_now_ms();
    const rd_renderer* r = &a->renderer;
    bool ok = rd_picture_write(path, r->width, r->height, r->film,
                               rd_view_encoding(a->options.view), 1.0f, &a->report);
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

static bool render_frames(app* a, const rd_camera* camera)
{
    for (int i = 0; i < a->options.frames; ++i) {
        rd_camera c = rd_camera_orbit(*camera, frame_angle(a, camera, i));
        char* path;
        bool ok;
        rd_render(&a->renderer, &c);
        if (a->options.frames == 1) {
            return write_picture(a, a->options.out);
        }
        path = frame_path(a->options.out, i);
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
                    1.0f, &d)) {
        return rd_fail(&a->report, a->options.compare, "out of memory");
    }
    rd_stats_error(&a->stats, "compared_pixels", (double)d.pixels);
    rd_stats_error(&a->stats, "psnr_db", d.psnr_db);
    rd_stats_error(&a->stats, "relative_mean", d.relative_mean);
    rd_stats_error(&a->stats, "relative_p999", d.relative_p999);
    rd_stats_error(&a->stats, "relative_max", d.relative_max);
    rd_stats_error(&a->stats, "mean_ratio", d.mean_ratio);
    return true;
}

static bool finish(app* a)
{
    rd_stats_count(&a->stats, "primary_rays", (double)a->renderer.ray_count);
    rd_stats_count(&a->stats, "layer_hits", (double)a->renderer.layer_hit_count);
    rd_stats_limit(&a->stats, "transparent_layers_dropped", (double)a->renderer.layers_dropped);
    if (!compare(a)) {
        return false;
    }
    a->stats.spp = a->renderer.spp;
    return !a->options.stats || rd_stats_write(&a->stats, a->options.stats, &a->report);
}

static bool run(app* a)
{
    rd_camera camera;
    rd_stats_begin(&a->stats);
    rd_progress_begin(&a->progress, a->options.progress);
    a->stats.scene = a->options.scene;
    a->stats.width = a->options.width;
    a->stats.height = a->options.height;
    if (!load(a) || !choose_camera(a, &camera)) {
        return false;
    }
    count_scene(a);
    return rd_renderer_begin(&a->renderer, &a->options, &a->scene, a->trace, &a->stats,
                             &a->progress, &a->report) &&
           render_frames(a, &camera) && finish(a);
}

static void release(app* a)
{
    rd_renderer_end(&a->renderer);
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
        printf("%s\n", a.options.out);
    }
    release(&a);
    return ok ? 0 : report_failure(&a);
}
