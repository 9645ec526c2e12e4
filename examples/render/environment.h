/* The sky as a source of light: a file or the procedural one, cleaned, calibrated and filtered. */
#ifndef RD_ENVIRONMENT_H
#define RD_ENVIRONMENT_H

#include "hdrp_env.h"
#include "hdrp_light.h"
#include "image.h"
#include "options.h"
#include "stats.h"

typedef struct rd_environment {
    bool present;         /* false: it is black */
    hdrp_env_image seen;  /* what the camera sees, with its sun */
    hdrp_env_image light; /* what lights the scene beside the sun */
    bool has_sun;
    hdrp_light sun;
    bool disc; /* the sun is not in the picture: it is drawn as a disc */
    hdrp_env baked;
    hdrp_env_sh sh;
    hdrp_env_sampler sampler; /* reference only */
    double ground_lux;        /* on level ground, sun included */
    float* texels[2];
    void* memory[2];
} rd_environment;

/* What the sky is made from. */
typedef struct rd_environment_desc {
    rd_image_f32* file; /* its texels are taken over; NULL: the procedural sky */
    const char* name;   /* for messages */
    float lux;          /* wanted on level ground; 0: as the file or the sun says */
    float sun_elevation_rad, sun_azimuth_rad; /* of the procedural sky */
    hdrp_v3 ground_albedo;                    /* likewise */
    rd_quality quality;
} rd_environment_desc;

bool rd_environment_make(rd_environment* e, const rd_environment_desc* desc, rd_stats* stats,
                         rd_report* report);
void rd_environment_free(rd_environment* e);

/* What a camera ray sees that leaves the scene. */
hdrp_v3 rd_environment_seen(const rd_environment* e, hdrp_v3 direction);

#endif
