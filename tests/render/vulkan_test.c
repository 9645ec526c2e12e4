/* Pictures of --backend vulkan against those of the CPU, of scenes as hdrp_render loads them. Exit
 * status 77 where there is no device. With a file as the first argument that scene is compared, and
 * with --features=LIST and others as for hdrp_render; without, the built-in scene. In front of them,
 * oit=NAME,NAME is for modes of transparency, one after the other on one device. With shadows, which
 * are maps on one side and rays on the other, at least 32 dB are asked for. --progress paints the
 * differences into --out. */
#include "compare.h"
#include "exposure.h"
#include "file.h"
#include "render.h"
#include "vk_backend.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SKIPPED 77

/* The errors that are allowed: root of the mean square of relative differences away from edges, the
 * share of pixels that differ by more than a tenth. */
typedef struct limits {
    double rmse, wrong;
    double psnr_db; /* at least, of all pixels */
    double thin_db; /* where there are edges alone; 0: there must be more */
} limits;

typedef struct studio {
    rd_options options;
    rd_report report;
    rd_stats stats;
    rd_progress progress;
    rd_scene scene;
    rd_trace* trace;
    rd_environment environment;
    rd_lighting lighting;
    rd_camera camera;
    float ev100;
    rd_renderer renderer;
} studio;

static bool load(studio* s)
{
    rd_options* o = &s->options;
    return (o->scene ? rd_scene_load_gltf(&s->scene, o->scene, &s->report)
                     : rd_scene_build(&s->scene, o->builtin, &s->report)) &&
           rd_textures_prepare(&s->scene.textures, &s->report) &&
           (s->trace = rd_trace_build(&s->scene, &s->report)) != NULL;
}

static bool light(studio* s)
{
    const float fov = s->options.fov_deg * (HDRP_PI / 180.0f);
    const rd_options* o = &s->options;
    rd_environment_desc d = {NULL,      "sky", HDRP_PI, 0.75f, -0.65f, {0.24f, 0.22f, 0.19f},
                             o->quality};
    rd_lighting_desc l = {&s->scene, s->trace, &s->environment, o};
    if (s->scene.has_sky) {
        d.lux = 0.0f;
        d.sun_elevation_rad = s->scene.sun_elevation_rad;
        d.sun_azimuth_rad = s->scene.sun_azimuth_rad;
        d.ground_albedo = s->scene.ground_albedo;
    }
    s->camera = rd_camera_frame(&s->scene, fov, o->width, o->height);
    if (o->has_eye) {
        s->camera = rd_camera_look_at(o->eye, o->target, fov, o->width, o->height);
    } else if (s->scene.camera_count > 0) {
        s->camera = rd_camera_from_scene(&s->scene, 0, o->width, o->height);
    }
    return (!s->scene.has_sky && s->scene.light_count > 0
                ? true
                : rd_environment_make(&s->environment, &d, &s->stats, &s->report)) &&
           rd_lighting_make(&s->lighting, &l, &s->stats, &s->report) &&
           rd_exposure_meter(o, &s->lighting, &s->camera, &s->ev100, &s->report);
}

static float* copy_film(const rd_renderer* r)
{
    size_t bytes = (size_t)r->width * (size_t)r->height * 4 * sizeof(float);
    float* film = (float*)malloc(bytes);
    if (film) {
        memcpy(film, r->film, bytes);
    }
    return film;
}

/* >>layers: the nearest transparent surface of each pixel, and how many there are */

typedef struct layer {
    uint32_t mesh, count;
    bool grazed; /* an edge of a triangle is so near that a rasteriser may take the other one */
    float t;
    hdrp_v3 normal;
} layer;

static hdrp_v3 normal_of(const rd_scene* scene, const rd_hit* hit)
{
    const rd_mesh* m = &scene->meshes[hit->mesh];
    const uint32_t* i = m->indices + (size_t)hit->triangle * 3;
    hdrp_v3 a = m->positions[i[0]];
    return hdrp_normalize_or(
        hdrp_v3_cross(hdrp_v3_sub(m->positions[i[1]], a), hdrp_v3_sub(m->positions[i[2]], a)),
        hdrp_v3_splat(0.0f));
}

/* Rasterisers place corners on a grid of 1/256 of a pixel. */
#define GRAZED_PX (1.0f / 64.0f)

static float distance_px(hdrp_v2 a, hdrp_v2 b, float x, float y)
{
    hdrp_v2 d = hdrp_v2_sub(b, a);
    return fabsf(d.x * (y - a.y) - d.y * (x - a.x)) / fmaxf(hypotf(d.x, d.y), 1e-9f);
}

static bool is_grazed(const studio* s, const rd_hit* hit, size_t pixel)
{
    const rd_mesh* m = &s->scene.meshes[hit->mesh];
    float x = (float)(pixel % (size_t)s->renderer.width) + 0.5f;
    float y = (float)(pixel / (size_t)s->renderer.width) + 0.5f;
    hdrp_v2 corner[3];
    bool grazed = false;
    for (int i = 0; i < 3; ++i) {
        corner[i] = rd_camera_project(
            &s->camera, m->positions[m->indices[(size_t)hit->triangle * 3 + (size_t)i]]);
    }
    for (int i = 0; i < 3; ++i) {
        grazed = grazed || distance_px(corner[i], corner[(i + 1) % 3], x, y) < GRAZED_PX;
    }
    return grazed;
}

static layer* find_layers(const studio* s)
{
    const rd_renderer* r = &s->renderer;
    size_t pixels = (size_t)r->width * (size_t)r->height;
    layer* out = (layer*)calloc(pixels, sizeof *out);
    rd_layers l = {NULL, 0, 0, 0};
    for (size_t i = 0; out && i < pixels; ++i) {
        rd_ray ray = rd_camera_ray(&s->camera, (float)(i % (size_t)r->width) + 0.5f,
                                   (float)(i / (size_t)r->width) + 0.5f);
        ray.t_max = r->hits[i].t;
        rd_trace_layers(s->trace, &ray, &l);
        out[i].grazed = r->hits[i].mesh != RD_NO_HIT && is_grazed(s, &r->hits[i], i);
        for (uint32_t k = 0; k < l.count; ++k) {
            out[i].grazed = out[i].grazed || is_grazed(s, &l.hits[k], i);
        }
        out[i].count = l.count;
        out[i].mesh = l.count ? l.hits[0].mesh : RD_NO_HIT;
        out[i].t = l.count ? l.hits[0].t : 0.0f;
        out[i].normal = l.count ? normal_of(&s->scene, &l.hits[0]) : hdrp_v3_splat(0.0f);
    }
    free(l.hits);
    return out;
}

/* >>edges: pixels beside which is another mesh, or a surface that is turned away or farther off, and
 * those that the edge of a triangle grazes */

static bool continues(const rd_renderer* r, const layer* layers, size_t a, size_t b)
{
    const rd_hit *x = &r->hits[a], *y = &r->hits[b];
    const layer *p = &layers[a], *q = &layers[b];
    const hdrp_v3* n = r->gbuffer.geometric_normals;
    if (p->mesh != q->mesh || p->count != q->count ||
        (p->count &&
         (hdrp_v3_dot(p->normal, q->normal) < 0.9f || fabsf(p->t - q->t) > 0.05f * p->t))) {
        return false;
    }
    if (x->mesh != y->mesh || x->mesh == RD_NO_HIT) {
        return x->mesh == y->mesh;
    }
    return hdrp_v3_dot(n[a], n[b]) > 0.9f && fabsf(x->t - y->t) < 0.05f * x->t;
}

static bool is_inside(const rd_renderer* r, const layer* layers, int x, int y)
{
    size_t w = (size_t)r->width, at = (size_t)y * w + (size_t)x;
    if (layers[at].grazed || x < 1 || y < 1 || x + 1 >= r->width || y + 1 >= r->height) {
        return false;
    }
    for (int k = 0; k < 9; ++k) {
        if (!continues(r, layers, at, at + (size_t)(k / 3) * w + (size_t)(k % 3) - w - 1)) {
            return false;
        }
    }
    return true;
}

/* >>comparison */

static double luminance(const float* p)
{
    return 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2];
}

/* Grey where pictures are equal, red where the GPU is brighter, blue where it is darker; full where a
 * tenth is missing. Edges are dimmed. */
static void paint(const studio* s, const layer* layers, const float* cpu, const float* gpu)
{
    const rd_renderer* r = &s->renderer;
    float floor_nits = 1e-2f / hdrp_light_exposure_saturation(s->ev100);
    unsigned char* rgb = (unsigned char*)malloc((size_t)r->width * (size_t)r->height * 3);
    for (int i = 0; rgb && i < r->width * r->height; ++i) {
        double a = luminance(cpu + 4 * (size_t)i), b = luminance(gpu + 4 * (size_t)i);
        double e = 10.0 * (b - a) / fmax(a, (double)floor_nits);
        double k = is_inside(r, layers, i % r->width, i / r->width) ? 127.0 : 40.0;
        rgb[3 * i] = (unsigned char)(k * (1.0 + fmax(fmin(e, 1.0), -1.0)));
        rgb[3 * i + 1] = (unsigned char)(k * (1.0 - fmin(fabs(e), 1.0)));
        rgb[3 * i + 2] = (unsigned char)(k * (1.0 - fmax(fmin(e, 1.0), -1.0)));
    }
    if (rgb) {
        rd_image_write_png(s->options.out, r->width, r->height, rgb, (rd_report*)&s->report);
    }
    free(rgb);
}

/* Relative to what is there, or a thousandth of what the picture shows as white. */
static bool compare(const studio* s, const layer* layers, const float* cpu, const float* gpu,
                    limits most)
{
    const rd_renderer* r = &s->renderer;
    float exposure = hdrp_light_exposure_saturation(s->ev100);
    double square = 0, cpu_sum = 0, gpu_sum = 0;
    size_t n = 0, wrong = 0, edges = 0;
    rd_difference d;
    for (int y = 0; y < r->height; ++y) {
        for (int x = 0; x < r->width; ++x) {
            size_t at = ((size_t)y * (size_t)r->width + (size_t)x) * 4;
            double a = luminance(cpu + at), b = luminance(gpu + at);
            double e = fabs(a - b) / fmax(a, 1e-2 / (double)exposure);
            if (!(cpu[at + 3] > 0.0f)) {
                continue;
            }
            if (!is_inside(r, layers, x, y)) {
                ++edges;
                continue;
            }
            square += e * e;
            wrong += e > 0.1;
            cpu_sum += a;
            gpu_sum += b;
            ++n;
        }
    }
    if (s->options.progress) {
        paint(s, layers, cpu, gpu);
    }
    rd_compare(gpu, cpu, r->width, r->height, exposure, &d);
    printf("%zu pixels, %zu more at edges: relative RMSE %.4f %%, over a tenth %.4f %%, mean %.5f, "
           "PSNR of all %.2f dB\n",
           n, edges, 100.0 * sqrt(square / (double)(n ? n : 1u)),
           100.0 * (double)wrong / (double)(n ? n : 1u), n ? gpu_sum / cpu_sum : 1.0, d.psnr_db);
    if (n == 0) {
        return edges > 0 && most.thin_db > 0.0 && d.psnr_db >= most.thin_db;
    }
    return sqrt(square / (double)n) <= most.rmse && (double)wrong / (double)n <= most.wrong &&
           d.psnr_db >= most.psnr_db;
}

/* A picture by both in the mode of the options. */
static bool run_mode(studio* s, const layer* layers, rd_vk* vk, limits most)
{
    float *cpu, *gpu = NULL;
    bool ok;
    rd_render(&s->renderer, &s->camera);
    cpu = copy_film(&s->renderer);
    ok = rd_vk_render(vk, &s->renderer, &s->camera);
    gpu = copy_film(&s->renderer);
    printf("%s: ", rd_oit_name(s->options.oit));
    ok =
        ok && cpu && gpu && layers && compare(s, layers, cpu, gpu, most) && rd_vk_messages(vk) == 0;
    free(cpu);
    free(gpu);
    return ok;
}

/* A renderer for the mode of the options: images are those of the mode. */
static bool begin(studio* s)
{
    rd_renderer_desc d = {&s->options, &s->lighting, 0.0f, &s->stats, &s->progress};
    d.exposure = hdrp_light_exposure_saturation(s->ev100);
    return rd_renderer_begin(&s->renderer, &d, &s->report);
}

/* Is a mode among names with commas between? */
static bool is_named(const char* names, rd_oit oit)
{
    size_t length = strlen(rd_oit_name(oit));
    for (const char* at = names; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        if (!strncmp(at, rd_oit_name(oit), length) && (!at[length] || at[length] == ',')) {
            return true;
        }
    }
    return false;
}

/* 0, 1 or SKIPPED. With the names of modes without sorting, in each of them. */
static int run(studio* s, limits most, const char* modes)
{
    layer* layers;
    rd_vk* vk;
    bool ok = true;
    if (!load(s) || !light(s) || !begin(s)) {
        return 1;
    }
    rd_render(&s->renderer, &s->camera);
    layers = find_layers(s);
    vk = rd_vk_open(&s->renderer, &s->report);
    if (!vk) {
        printf("skipped: %s\n", s->report.error);
        free(layers);
        return SKIPPED;
    }
    puts(rd_vk_device_name(vk));
    if (!modes) {
        ok = run_mode(s, layers, vk, most);
    }
    for (int i = 0; modes && ok && i < RD_OIT_COUNT; ++i) {
        if (is_named(modes, (rd_oit)i)) {
            rd_renderer_end(&s->renderer);
            s->options.oit = (rd_oit)i;
            ok = begin(s) && run_mode(s, layers, vk, most);
        }
    }
    rd_vk_close(vk);
    free(layers);
    return !ok;
}

int main(int argc, char** argv)
{
    static studio s; /* zeroed, and large for a stack */
    limits most = {0.01, 0.002, 0.0, 0.0};
    int status;
    char default_features[] = "--features=-shadows,-glass_rays,-ao";
    char* defaults[] = {argv[0], "--size=320x180", "--quality=fast", default_features};
    const char* modes = argc > 1 && !strncmp(argv[1], "oit=", 4) ? argv[1] + 4 : NULL;
    bool given = argc > 1;
    uint64_t bytes;
    if (modes) {
        argv[1] = argv[0];
        ++argv;
        --argc;
    }
    if (!rd_options_parse(&s.options, given ? argc : 4, given ? argv : defaults, &s.report)) {
        fprintf(stderr, "%s\n", s.report.error);
        return 1;
    }
    if (s.options.scene && !rd_file_size(s.options.scene, &bytes)) {
        printf("skipped: there is no %s\n", s.options.scene);
        return SKIPPED;
    }
    most.thin_db = modes ? 40.0 : 0.0; /* the tubes of love.glb */
    if (s.options.features & RD_FEATURE_SHADOWS) {
        most.rmse = most.wrong = INFINITY;
        most.psnr_db = 32.0;
    }
    status = run(&s, most, modes);
    if (status == 1 && s.report.failed) {
        fprintf(stderr, "%s\n", s.report.error);
    }
    rd_renderer_end(&s.renderer);
    rd_lighting_free(&s.lighting);
    rd_environment_free(&s.environment);
    rd_trace_free(s.trace);
    rd_scene_free(&s.scene);
    return status;
}
