/* edges.h - the ends of every documented range; tools/edge_scan.py writes the tables.
 * SPDX-License-Identifier: MIT */
#ifndef EDGES_H
#define EDGES_H

#include "../finite/finite_scan.h"

typedef struct range_edge {
    const fs_function* function;
    const char* parameter; /* with the member or component */
    size_t argument, offset;
    float end;
    int inwards; /* 1: the range lies above the end, -1: below */
    bool closed; /* the end belongs to the range */
} range_edge;

#endif
