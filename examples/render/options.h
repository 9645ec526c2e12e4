/* The command line. */
#ifndef RD_OPTIONS_H
#define RD_OPTIONS_H

#include "hdrp_math.h"
#include "report.h"
#include "view.h"

typedef enum rd_quality { RD_QUALITY_FAST, RD_QUALITY_BALANCED, RD_QUALITY_REFERENCE } rd_quality;
typedef enum rd_backend { RD_BACKEND_CPU, RD_BACKEND_VULKAN } rd_backend;
typedef enum rd_path { RD_PATH_DEFERRED, RD_PATH_FORWARD } rd_path;
/* How blended surfaces are put together: sorted, or in a mode of hdrp_oit.h. */
typedef enum rd_oit {
    RD_OIT_SORTED,
    RD_OIT_MCGUIRE,  /* weights of equation 7 */
    RD_OIT_VOLITION, /* as the talk shows it */
    RD_OIT_RECOMMENDED,
    RD_OIT_FRONT,
    RD_OIT_MOMENTS, /* six */
    RD_OIT_WAVELET,
    RD_OIT_COUNT
} rd_oit;

/* What --features turns on and off. */
#define RD_FEATURE_CLEAR_COAT      (1u << 0)
#define RD_FEATURE_ANISOTROPY      (1u << 1)
#define RD_FEATURE_IRIDESCENCE     (1u << 2)
#define RD_FEATURE_REFRACTION      (1u << 3)
#define RD_FEATURE_NORMAL_MAPS     (1u << 4)
#define RD_FEATURE_OCCLUSION       (1u << 5) /* maps of ambient occlusion */
#define RD_FEATURE_AO              (1u << 6) /* short rays */
#define RD_FEATURE_ALPHA_BLEND     (1u << 7)
#define RD_FEATURE_LIGHTS          (1u << 8) /* all but the sky, the sun included */
#define RD_FEATURE_SUN             (1u << 9)
#define RD_FEATURE_SHADOWS         (1u << 10)
#define RD_FEATURE_ENVIRONMENT     (1u << 11) /* light of the sky */
#define RD_FEATURE_SKY             (1u << 12) /* the sky behind the scene */
#define RD_FEATURE_SPECULAR_AA     (1u << 13)
#define RD_FEATURE_TRANSMISSION    (1u << 14) /* light crosses leaves and cloth */
#define RD_FEATURE_TANGENTS        (1u << 15) /* of the file; without: from uv, as the file has none */
#define RD_FEATURE_LISTS           (1u << 16) /* of lights; without: all surfaces visit all lights */
#define RD_FEATURE_BLOCKERS        (1u << 17) /* of the lights of the scene */
#define RD_FEATURE_GLASS_RAYS      (1u << 18) /* through volumes, to what is behind them */
#define RD_FEATURE_HALF_RESOLUTION (1u << 19) /* with --oit, of materials that are marked so */
#define RD_FEATURE_ALL             ((1u << 20) - 1u)
/* Not for the command line: all materials are middle grey, as exposure meters want it. */
#define RD_FEATURE_GREY_CARDS (1u << 20)

typedef struct rd_options {
    const char* scene; /* NULL: a built-in one */
    rd_builtin builtin;
    const char* env; /* NULL: the procedural sky */
    const char* out;
    const char* compare;
    const char* stats;
    float env_lux; /* 0: as the image says */
    int width, height;
    int spp; /* 0: what the quality says */
    int lights;
    int frames;
    uint32_t seed;
    rd_backend backend;
    rd_quality quality;
    rd_path path;
    rd_oit oit;
    rd_view view;
    uint32_t features;
    bool has_exposure, has_eye, has_target, has_fov, has_camera, has_builtin;
    float exposure_ev100;
    int camera;
    hdrp_v3 eye, target;
    float fov_deg;
    bool progress; /* show it even where stderr is no terminal */
    bool show_help, show_version;
} rd_options;

bool rd_options_parse(rd_options* o, int argc, char** argv, rd_report* report);
void rd_options_print_help(void);

/* As the command line has it. */
const char* rd_oit_name(rd_oit oit);

#endif
