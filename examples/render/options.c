#include "options.h"

#include "file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_SIDE    16384
#define MAX_SAMPLES 65536
#define MAX_LIGHTS  1000000
#define MAX_FRAMES  100000

static const struct {
    const char* name;
    uint32_t bits;
} features[] = {
    {"clear_coat", RD_FEATURE_CLEAR_COAT},
    {"anisotropy", RD_FEATURE_ANISOTROPY},
    {"iridescence", RD_FEATURE_IRIDESCENCE},
    {"refraction", RD_FEATURE_REFRACTION},
    {"glass_rays", RD_FEATURE_GLASS_RAYS},
    {"transmission", RD_FEATURE_TRANSMISSION},
    {"tangents", RD_FEATURE_TANGENTS},
    {"normal_maps", RD_FEATURE_NORMAL_MAPS},
    {"occlusion", RD_FEATURE_OCCLUSION},
    {"ao", RD_FEATURE_AO},
    {"alpha_blend", RD_FEATURE_ALPHA_BLEND},
    {"lights", RD_FEATURE_LIGHTS},
    {"sun", RD_FEATURE_SUN},
    {"shadows", RD_FEATURE_SHADOWS},
    {"environment", RD_FEATURE_ENVIRONMENT},
    {"sky", RD_FEATURE_SKY},
    {"specular_aa", RD_FEATURE_SPECULAR_AA},
    {"lists", RD_FEATURE_LISTS},
    {"blockers", RD_FEATURE_BLOCKERS},
    {"half_resolution", RD_FEATURE_HALF_RESOLUTION},
    {"all", RD_FEATURE_ALL},
};

/* What a setter gets: the option with its dashes, its value, where to put it. */
typedef struct argument {
    rd_options* options;
    const char* name;
    const char* value;
    rd_report* report;
} argument;

static bool bad_value(const argument* a, const char* expected)
{
    return rd_fail(a->report, a->name, "\"%.80s\" is not %s", a->value, expected);
}

static bool read_int(const argument* a, int low, int high, int* out)
{
    char* end;
    long v;
    char expected[80];
    errno = 0;
    v = strtol(a->value, &end, 10);
    if (errno || end == a->value || *end || v < low || v > high) {
        snprintf(expected, sizeof expected, "an integer in [%d, %d]", low, high);
        return bad_value(a, expected);
    }
    *out = (int)v;
    return true;
}

static bool read_float(const argument* a, float low, float high, float* out)
{
    char* end;
    float v = strtof(a->value, &end);
    char expected[80];
    if (end == a->value || *end || !(v >= low && v <= high)) {
        snprintf(expected, sizeof expected, "a number in [%g, %g]", (double)low, (double)high);
        return bad_value(a, expected);
    }
    *out = v;
    return true;
}

static bool read_v3(const argument* a, hdrp_v3* out)
{
    char trailing;
    hdrp_v3 v;
    if (sscanf(a->value, "%f,%f,%f%c", &v.x, &v.y, &v.z, &trailing) != 3 || !isfinite(v.x) ||
        !isfinite(v.y) || !isfinite(v.z)) {
        return bad_value(a, "three numbers x,y,z");
    }
    *out = v;
    return true;
}

/* The index of the value among words separated by '|', or -1. */
static int find_word(const char* words, const char* value)
{
    size_t length = strlen(value);
    for (int i = 0; words; ++i) {
        const char* bar = strchr(words, '|');
        size_t n = bar ? (size_t)(bar - words) : strlen(words);
        if (n == length && !memcmp(words, value, n)) {
            return i;
        }
        words = bar ? bar + 1 : NULL;
    }
    return -1;
}

static bool read_word(const argument* a, const char* words, int* out)
{
    char expected[200];
    *out = find_word(words, a->value);
    if (*out < 0) {
        snprintf(expected, sizeof expected, "one of %s", words);
        return bad_value(a, expected);
    }
    return true;
}

/* >>setters, one an option */

static bool set_env(const argument* a)
{
    a->options->env = a->value;
    return true;
}

static bool set_env_lux(const argument* a)
{
    return read_float(a, 1e-6f, 1e9f, &a->options->env_lux);
}

static bool set_out(const argument* a)
{
    a->options->out = a->value;
    if (!rd_path_has_extension(a->value, "exr") && !rd_path_has_extension(a->value, "png")) {
        return bad_value(a, "a name that ends in .exr or .png");
    }
    return true;
}

static bool set_size(const argument* a)
{
    int w, h;
    char trailing;
    if (sscanf(a->value, "%6dx%6d%c", &w, &h, &trailing) != 2 || w < 1 || h < 1 || w > MAX_SIDE ||
        h > MAX_SIDE) {
        return bad_value(a, "WIDTHxHEIGHT, each in [1, 16384]");
    }
    a->options->width = w;
    a->options->height = h;
    return true;
}

static bool set_backend(const argument* a)
{
    int i;
    bool ok = read_word(a, "cpu|vulkan", &i);
    a->options->backend = (rd_backend)i;
    return ok;
}

static bool set_quality(const argument* a)
{
    int i;
    bool ok = read_word(a, "fast|balanced|reference", &i);
    a->options->quality = (rd_quality)i;
    return ok;
}

static bool set_path(const argument* a)
{
    int i;
    bool ok = read_word(a, "deferred|forward", &i);
    a->options->path = (rd_path)i;
    return ok;
}

static const char* const oit_names[RD_OIT_COUNT] = {"sorted", "mcguire", "volition", "recommended",
                                                    "front",  "moments", "wavelet"};

const char* rd_oit_name(rd_oit oit)
{
    return oit_names[oit];
}

static bool set_oit(const argument* a)
{
    for (int i = 0; i < RD_OIT_COUNT; ++i) {
        if (!strcmp(a->value, oit_names[i])) {
            a->options->oit = (rd_oit)i;
            return true;
        }
    }
    return bad_value(a, "one of sorted|mcguire|volition|recommended|front|moments|wavelet");
}

static bool set_builtin(const argument* a)
{
    int i;
    bool ok = read_word(a, "display|lights|transparency", &i);
    a->options->has_builtin = true;
    a->options->builtin = (rd_builtin)i;
    return ok;
}

static bool set_spp(const argument* a)
{
    return read_int(a, 1, MAX_SAMPLES, &a->options->spp);
}

static bool set_lights(const argument* a)
{
    return read_int(a, 0, MAX_LIGHTS, &a->options->lights);
}

static bool set_frames(const argument* a)
{
    return read_int(a, 1, MAX_FRAMES, &a->options->frames);
}

static bool set_seed(const argument* a)
{
    int v = 0;
    bool ok = read_int(a, 0, 2147483647, &v);
    a->options->seed = (uint32_t)v;
    return ok;
}

static bool set_camera(const argument* a)
{
    a->options->has_camera = true;
    return read_int(a, 0, 1000000, &a->options->camera);
}

static bool set_exposure(const argument* a)
{
    a->options->has_exposure = true;
    return read_float(a, -40.0f, 40.0f, &a->options->exposure_ev100);
}

static bool set_eye(const argument* a)
{
    a->options->has_eye = true;
    return read_v3(a, &a->options->eye);
}

static bool set_target(const argument* a)
{
    a->options->has_target = true;
    return read_v3(a, &a->options->target);
}

static bool set_fov(const argument* a)
{
    a->options->has_fov = true;
    return read_float(a, 1.0f, 170.0f, &a->options->fov_deg);
}

static bool set_compare(const argument* a)
{
    a->options->compare = a->value;
    return true;
}

static bool set_stats(const argument* a)
{
    a->options->stats = a->value;
    return true;
}

static bool set_view(const argument* a)
{
    a->options->view = rd_view_from_name(a->value);
    return a->options->view != RD_VIEW_COUNT ? true : bad_value(a, "a view, see --help");
}

static bool switch_feature(const argument* a, const char* name, size_t length, bool on)
{
    for (size_t i = 0; i < sizeof features / sizeof features[0]; ++i) {
        if (strlen(features[i].name) == length && !memcmp(features[i].name, name, length)) {
            uint32_t* mask = &a->options->features;
            *mask = on ? *mask | features[i].bits : *mask & ~features[i].bits;
            return true;
        }
    }
    return rd_fail(a->report, a->name, "unknown feature \"%.*s\", see --help", (int)length, name);
}

static bool set_features(const argument* a)
{
    const char* at = a->value;
    while (*at) {
        size_t n = strcspn(at, ",");
        bool on = *at != '-';
        if (!switch_feature(a, on ? at : at + 1, on ? n : n - 1, on)) {
            return false;
        }
        at += n + (at[n] == ',');
    }
    return true;
}

static const struct {
    const char* name;
    bool (*set)(const argument*);
    const char* value;
    const char* help;
} table[] = {
    {"--scene", set_builtin, "NAME",
     "without a file: display (default), lights (a street), transparency"},
    {"--env", set_env, "FILE", "sky: lat-long or cube, .exr or .hdr (default: a procedural sky)"},
    {"--env-lux", set_env_lux, "LUX", "scale the sky to this illuminance on level ground"},
    {"--out", set_out, "FILE", ".png (tone-mapped) or .exr (linear); default hdrp_render.png"},
    {"--size", set_size, "WxH", "default 1280x720"},
    {"--backend", set_backend, "NAME", "cpu (default) or vulkan: a GPU, else Mesa's lavapipe"},
    {"--quality", set_quality, "NAME", "fast, balanced (default), reference (path traced)"},
    {"--path", set_path, "NAME", "deferred (default) or forward"},
    {"--oit", set_oit, "NAME",
     "blended surfaces: sorted (default), or without sorting, see README"},
    {"--spp", set_spp, "N", "samples a pixel; default by quality"},
    {"--lights", set_lights, "N", "scatter N generated lights over the scene"},
    {"--features", set_features, "LIST", "a,b,-c turns features on or off; -all first for a few"},
    {"--view", set_view, "NAME", "what to show instead of the lit scene"},
    {"--exposure", set_exposure, "EV100", "fixed exposure; default: from the scene's light"},
    {"--camera", set_camera, "INDEX", "a camera of the scene; default: the first, or all in view"},
    {"--eye", set_eye, "X,Y,Z", "look from here"},
    {"--target", set_target, "X,Y,Z", "look at this; default: the centre of the scene"},
    {"--fov", set_fov, "DEGREES", "vertical field of view; default 40"},
    {"--frames", set_frames, "N", "render N frames around the target; files get a number"},
    {"--compare", set_compare, "FILE", "measure the difference to this .exr image"},
    {"--stats", set_stats, "FILE", "write times, counts and limits as JSON"},
    {"--seed", set_seed, "N", "of all random choices; default 0"},
};
#define TABLE_SIZE (sizeof table / sizeof table[0])

/* Options without a value. */
static bool set_switch(rd_options* o, const char* name)
{
    if (!strcmp(name, "--help") || !strcmp(name, "-h")) {
        return o->show_help = true;
    }
    if (!strcmp(name, "--version")) {
        return o->show_version = true;
    }
    if (!strcmp(name, "--progress")) {
        return o->progress = true;
    }
    return false;
}

/* argv[*i] is an option; takes its value from behind '=' or from the next argument. */
static bool take_option(rd_options* o, int argc, char** argv, int* i, rd_report* report)
{
    const char* text = argv[*i];
    size_t length = strcspn(text, "=");
    argument a = {o, NULL, NULL, report};
    if (set_switch(o, text)) {
        return true;
    }
    for (size_t k = 0; k < TABLE_SIZE; ++k) {
        if (strlen(table[k].name) != length || memcmp(table[k].name, text, length) != 0) {
            continue;
        }
        a.name = table[k].name;
        if (text[length] == '=') {
            a.value = text + length + 1;
        } else if (*i + 1 < argc) {
            a.value = argv[++*i];
        } else {
            return rd_fail(report, a.name, "needs a value");
        }
        return a.value[0] ? table[k].set(&a) : bad_value(&a, table[k].value);
    }
    return rd_fail(report, text, "unknown option, see --help");
}

static bool check_together(const rd_options* o, rd_report* report)
{
    if (o->has_builtin && o->scene) {
        return rd_fail(report, "--scene", "cannot be combined with a file");
    }
    if (o->has_camera && o->has_eye) {
        return rd_fail(report, "--eye", "cannot be combined with --camera");
    }
    if (o->oit != RD_OIT_SORTED && o->quality == RD_QUALITY_REFERENCE) {
        return rd_fail(report, "--oit", "%s cannot be combined with --quality reference",
                       rd_oit_name(o->oit));
    }
    if ((uint64_t)o->width * (uint64_t)o->height > RD_IMAGE_MAX_PIXELS) {
        return rd_fail(report, "--size", "too many pixels");
    }
    return true;
}

bool rd_options_parse(rd_options* o, int argc, char** argv, rd_report* report)
{
    memset(o, 0, sizeof *o);
    o->out = "hdrp_render.png";
    o->width = 1280;
    o->height = 720;
    o->frames = 1;
    o->quality = RD_QUALITY_BALANCED;
    o->features = RD_FEATURE_ALL;
    o->fov_deg = 40.0f;
    for (int i = 1; i < argc; ++i) {
        if (argv[i][0] == '-') {
            if (!take_option(o, argc, argv, &i, report)) {
                return false;
            }
        } else if (o->scene) {
            return rd_fail(report, argv[i], "only one scene can be rendered");
        } else {
            o->scene = argv[i];
        }
    }
    return check_together(o, report);
}

void rd_options_print_help(void)
{
    printf("usage: hdrp_render [SCENE.gltf|SCENE.glb] [options]\n"
           "Renders a glTF scene, or a built-in one, with the hdrp headers.\n\n");
    for (size_t i = 0; i < TABLE_SIZE; ++i) {
        printf("  %-11s %-8s %s\n", table[i].name, table[i].value, table[i].help);
    }
    printf("  %-20s show progress even where stderr is no terminal\n", "--progress");
    printf("  %-20s\n  %-20s\n\nviews:", "--help", "--version");
    for (int i = 0; i < RD_VIEW_COUNT; ++i) {
        printf(" %s", rd_view_name((rd_view)i));
    }
    printf("\nfeatures:");
    for (size_t i = 0; i < sizeof features / sizeof features[0]; ++i) {
        printf(" %s", features[i].name);
    }
    printf("\n");
}
