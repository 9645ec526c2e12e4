/* oit_errors.c - the error of every mode against sorting: oit_errors [--csv FILE]
 * SPDX-License-Identifier: MIT */
#include "oit_harness.h"

#include <stdio.h>
#include <string.h>

static const char* const precisions[] = {"native", "compact", "float"};

int main(int count, char** arguments)
{
    FILE* out = stdout;
    if (count == 3 && strcmp(arguments[1], "--csv") == 0) {
        out = fopen(arguments[2], "w");
    }
    if (!out || (count != 1 && count != 3)) {
        fputs("usage: oit_errors [--csv FILE]\n", stderr);
        return 2;
    }
    fputs("case,mode,precision,bytes_per_pixel,passes,rms,largest\n", out);
    for (size_t i = 0; i < oit_case_count; ++i) {
        oit_pixels pixels;
        oit_generate(&oit_cases[i], &pixels);
        for (uint32_t m = 0; m < HDRP_OIT_MODE_COUNT; ++m) {
            for (int k = 0; k < 3; ++k) {
                hdrp_oit_mode mode = (hdrp_oit_mode)m;
                hdrp_oit_precision precision = (hdrp_oit_precision)k;
                oit_error e = oit_measure(&oit_cases[i], &pixels, mode, precision);
                fprintf(out, "%s,%s,%s,%u,%u,%.5f,%.5f\n", oit_cases[i].name, oit_mode_name(mode),
                        precisions[k], hdrp_oit_bytes_per_pixel(mode, precision),
                        hdrp_oit_pass_count(mode), e.rms, e.largest);
            }
        }
        oit_free(&pixels);
    }
    return out == stdout || fclose(out) == 0 ? 0 : 1;
}
