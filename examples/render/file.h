/* Whole-file reads with a size limit, and output files that appear complete or not at all. */
#ifndef RD_FILE_H
#define RD_FILE_H

#include "report.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The largest input file that is read at all. */
#define RD_FILE_MAX ((uint64_t)2 << 30)

/* Size of a regular file; false where there is none. */
bool rd_file_size(const char* path, uint64_t* size);

/* Reads a regular file of at most RD_FILE_MAX bytes; the caller frees *bytes. */
bool rd_file_read(const char* path, unsigned char** bytes, size_t* size, rd_report* report);

/* The part after the last dot in lower case is `extension`, which is given without the dot. */
bool rd_path_has_extension(const char* path, const char* extension);

/* Where a writer puts its bytes until they are complete: a name beside `path`. */
typedef struct rd_output {
    const char* path;
    char* temporary;
} rd_output;

/* Fails where `path` cannot be written, before the work for it is done. */
bool rd_output_check(const char* path, rd_report* report);
bool rd_output_begin(rd_output* out, const char* path, rd_report* report);
/* Renames the temporary file to its final name when `complete`, else removes it. */
bool rd_output_end(rd_output* out, bool complete, rd_report* report);

#ifdef __cplusplus
}
#endif
#endif
