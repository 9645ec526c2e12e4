/* oit_motion.h - how much a picture of transparent cards changes from one frame to the next.
 * SPDX-License-Identifier: MIT
 *
 * Discs of soft edges, drawn as streams of fragments in the order of the cards. What jumps where
 * nothing in the scene does is seen at once: the largest step between two frames is measured, for
 * each mode, for sorting per pixel and for sorting the cards by the depth of their centres. */
#ifndef OIT_MOTION_H
#define OIT_MOTION_H

#include "hdrp_oit.h"

#define MOTION_FRAMES 240u

typedef enum motion_sequence {
    MOTION_CROSSING, /* two tilted panes go through each other, between others that stand still */
    MOTION_ORBIT,    /* the camera goes half a radian around cards that cut each other */
    MOTION_DOLLY,    /* the camera goes through smoke that fades where it is near */
    MOTION_SEQUENCES
} motion_sequence;

/* Ways to draw: the modes of hdrp_oit.h, and after them these. */
#define MOTION_SORTED_PIXELS ((int)HDRP_OIT_MODE_COUNT)
#define MOTION_SORTED_CARDS  ((int)HDRP_OIT_MODE_COUNT + 1)
#define MOTION_WAYS          ((int)HDRP_OIT_MODE_COUNT + 2)

typedef struct motion_step {
    double picture; /* largest root mean square over a picture, of linear RGB, between two frames */
    double pixel;   /* largest change of a component of a pixel */
    double error;   /* root mean square against sorting per pixel, over all frames */
} motion_step;

const char* motion_sequence_name(motion_sequence sequence);
const char* motion_way_name(int way);

/* Steps of all ways. Returns 0 where there is no memory. */
int motion_measure(motion_sequence sequence, motion_step steps[MOTION_WAYS]);

#endif
