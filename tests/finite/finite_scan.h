/* finite_scan.h - calls every public formula at the extremes of its documented ranges.
 * SPDX-License-Identifier: MIT
 *
 * tools/finite_scan.py writes one C file per header with the tables declared here. A source is a
 * list of samples of one argument: a static table, a struct whose members are drawn from sources
 * of their own, or results of the functions that make such a struct. Samples are in order of
 * importance: where not every combination can be called, the first ones meet each other for
 * certain. */
#ifndef FINITE_SCAN_H
#define FINITE_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct fs_function fs_function;
typedef struct fs_source fs_source;

typedef struct fs_part {
    size_t offset;
    fs_source* source;
} fs_part;

struct fs_source {
    size_t size;       /* bytes of one sample */
    size_t count;      /* samples; of a struct, known once it is built */
    const void* table; /* NULL: built from what follows */
    const fs_part* parts;
    size_t part_count;
    const fs_function* const* producers;
    size_t producer_count;
    unsigned char* built;
    bool is_building; /* a struct that is made from itself has no samples */
};

typedef enum fs_kind { FS_F32, FS_U32 } fs_kind;

/* One number inside a type, for printing. */
typedef struct fs_leaf {
    const char* name;
    size_t offset;
    fs_kind kind;
} fs_leaf;

typedef struct fs_type {
    const char* name;
    size_t size;
    const fs_leaf* leaves;
    size_t leaf_count;
} fs_type;

typedef enum fs_rule {
    FS_FINITE,   /* the float is finite */
    FS_INTERVAL, /* the float lies in [lo,hi], which may be infinite; never NaN */
    FS_INTEGER,  /* the integer lies in [lo,hi] */
    FS_UNIT      /* count floats have length 1 within 1e-6 */
} fs_rule;

typedef struct fs_check {
    fs_rule rule;
    size_t offset;
    size_t count;
    double lo, hi;
    bool lo_open, hi_open;
} fs_check;

typedef struct fs_argument {
    const char* name;
    const fs_type* type;
    fs_source* source;
} fs_argument;

struct fs_function {
    const char* name;
    const char* header;
    const char* missing; /* why the function cannot be scanned: a failure; else NULL */
    const fs_type* result;
    const fs_check* checks;
    size_t check_count;
    const fs_argument* arguments;
    size_t argument_count;
    void (*call)(const void* const* arguments, void* result);
    bool (*is_required)(const void* const* arguments); /* NULL: every combination is */
};

#endif
