/* How the program speaks of failure: the first error as one line, warnings as a short list. */
#ifndef RD_REPORT_H
#define RD_REPORT_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define RD_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define RD_PRINTF(format_index, first)
#endif

#define RD_TEXT_MAX    600
#define RD_WARNING_MAX 32

typedef struct rd_report {
    bool failed;
    char error[RD_TEXT_MAX]; /* "FILE: reason", printable, no line break */
    int warning_count;       /* also counts those beyond RD_WARNING_MAX, which are not kept */
    char warning[RD_WARNING_MAX][RD_TEXT_MAX];
} rd_report;

/* Records "subject: reason" unless an error is already there. Always returns false, so that a
 * function can end with `return rd_fail(...)`. */
bool rd_fail(rd_report* r, const char* subject, const char* format, ...) RD_PRINTF(3, 4);

void rd_warn(rd_report* r, const char* subject, const char* format, ...) RD_PRINTF(3, 4);

/* Prints the warnings that were kept, one line each, and how many were not. */
void rd_print_warnings(const rd_report* r, const char* program);

#ifdef __cplusplus
}
#endif
#endif
