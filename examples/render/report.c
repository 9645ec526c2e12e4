#include "report.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Libraries speak in several lines, and names in a hostile file may hold terminal escapes: keeps
 * one printable line. */
static void make_printable(char* s)
{
    size_t length = strlen(s);
    for (size_t i = 0; i < length; ++i) {
        unsigned char c = (unsigned char)s[i];
        if (c < 0x20 || c == 0x7f) {
            s[i] = c == '\n' ? ' ' : '?';
        }
    }
    while (length > 0 && s[length - 1] == ' ') {
        s[--length] = '\0';
    }
}

static void write_line(char* out, const char* subject, const char* format, va_list args)
{
    int n = snprintf(out, RD_TEXT_MAX, "%s: ", subject);
    if (n < 0 || n >= RD_TEXT_MAX) {
        n = RD_TEXT_MAX - 1;
    }
    vsnprintf(out + n, (size_t)(RD_TEXT_MAX - n), format, args);
    make_printable(out);
}

bool rd_fail(rd_report* r, const char* subject, const char* format, ...)
{
    va_list args;
    if (r->failed) {
        return false;
    }
    r->failed = true;
    va_start(args, format);
    write_line(r->error, subject, format, args);
    va_end(args);
    return false;
}

void rd_warn(rd_report* r, const char* subject, const char* format, ...)
{
    va_list args;
    if (r->warning_count < RD_WARNING_MAX) {
        va_start(args, format);
        write_line(r->warning[r->warning_count], subject, format, args);
        va_end(args);
    }
    ++r->warning_count;
}

void rd_print_warnings(const rd_report* r, const char* program)
{
    int kept = r->warning_count < RD_WARNING_MAX ? r->warning_count : RD_WARNING_MAX;
    for (int i = 0; i < kept; ++i) {
        fprintf(stderr, "%s: warning: %s\n", program, r->warning[i]);
    }
    if (r->warning_count > kept) {
        fprintf(stderr, "%s: warning: and %d more\n", program, r->warning_count - kept);
    }
}
