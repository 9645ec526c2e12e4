/* oit_steps.c - the largest step between two frames for every mode: oit_steps [--csv FILE]
 * SPDX-License-Identifier: MIT */
#include "oit_motion.h"

#include <stdio.h>
#include <string.h>

int main(int count, char** arguments)
{
    FILE* out = stdout;
    if (count == 3 && strcmp(arguments[1], "--csv") == 0) {
        out = fopen(arguments[2], "w");
    }
    if (!out || (count != 1 && count != 3)) {
        fputs("usage: oit_steps [--csv FILE]\n", stderr);
        return 2;
    }
    fputs("sequence,way,picture_step,pixel_step,rms\n", out);
    for (int s = 0; s < MOTION_SEQUENCES; ++s) {
        motion_step steps[MOTION_WAYS];
        if (!motion_measure((motion_sequence)s, steps)) {
            fputs("oit_steps: out of memory\n", stderr);
            return 1;
        }
        for (int way = 0; way < MOTION_WAYS; ++way) {
            fprintf(out, "%s,%s,%.5f,%.5f,%.5f\n", motion_sequence_name((motion_sequence)s),
                    motion_way_name(way), steps[way].picture, steps[way].pixel, steps[way].error);
        }
    }
    return out == stdout || fclose(out) == 0 ? 0 : 1;
}
