/* from_environment.c - gives a program built against mutated headers its fault by the environment:
 * HDRP_MUTANT=number and HDRP_MUTANT_AMOUNT=relative change; HDRP_MUTANT_REACHED=file gets the
 * numbers of the faults whose places were passed, when the program ends.
 * SPDX-License-Identifier: MIT */
#include "mutant.h"

#include <stdio.h>
#include <stdlib.h>

int hdrp_mutant;
float hdrp_mutant_factor = 1.0f;
unsigned char hdrp_mutant_reached[HDRP_MUTANT_MAX];

__attribute__((constructor)) static void read_environment(void)
{
    const char *number = getenv("HDRP_MUTANT"), *amount = getenv("HDRP_MUTANT_AMOUNT");
    hdrp_mutant = number ? atoi(number) : 0;
    hdrp_mutant_factor = amount ? 1.0f + (float)atof(amount) : 1.0f;
}

__attribute__((destructor)) static void write_reached(void)
{
    const char* path = getenv("HDRP_MUTANT_REACHED");
    FILE* file = path ? fopen(path, "w") : NULL;
    for (int k = 0; file && k < HDRP_MUTANT_MAX; ++k) {
        if (hdrp_mutant_reached[k]) {
            fprintf(file, "%d\n", k);
        }
    }
    if (file) {
        fclose(file);
    }
}
