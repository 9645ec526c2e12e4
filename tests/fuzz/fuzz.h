/* fuzz.h - what the parts of the fuzz target share: bytes as a source of anything, and checks.
 * SPDX-License-Identifier: MIT */
#ifndef FUZZ_H
#define FUZZ_H

#include "hdrp_cull.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);                        \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

typedef struct reader {
    const uint8_t* data;
    size_t size, at;
    uint32_t after; /* bytes read behind the end: they go on as a hash */
} reader;

uint32_t read_u8(reader* r);
uint32_t read_u16(reader* r);
uint32_t read_u32(reader* r);
uint32_t read_below(reader* r, uint32_t end);
float read_float(reader* r);
hdrp_v3 read_v3(reader* r);

/* A block of as many bytes, all of them the same: AddressSanitizer sees what is written past it. */
void* block_of(size_t bytes, int fill);

/* What tiles need, from their lists to the dispatch of variants. */
void fuzz_variants(reader* r, const hdrp_cull_lists* lists, const hdrp_cull_set* set);

/* What blockers leave of lists, with lights some of which share links. A place is that of a light,
 * hdrp_cull_light_place; the lights are the first of the shapes, at most 32. */
void fuzz_blockers(reader* r, const hdrp_cull_lists* lists, const hdrp_v4* places,
                   uint32_t light_count);

#endif
