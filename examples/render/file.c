#define _POSIX_C_SOURCE 200809L
#include "file.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool rd_file_size(const char* path, uint64_t* size)
{
    struct stat s;
    if (stat(path, &s) != 0 || !S_ISREG(s.st_mode) || s.st_size < 0) {
        return false;
    }
    *size = (uint64_t)s.st_size;
    return true;
}

static bool read_all(FILE* f, unsigned char* bytes, size_t size)
{
    return fread(bytes, 1, size, f) == size && fgetc(f) == EOF;
}

bool rd_file_read(const char* path, unsigned char** bytes, size_t* size, rd_report* report)
{
    uint64_t length;
    FILE* f;
    bool ok;
    /* Before opening: a pipe would block, a device never end. */
    if (access(path, R_OK) != 0) {
        return rd_fail(report, path, "cannot open: %s", strerror(errno));
    }
    if (!rd_file_size(path, &length) || length > RD_FILE_MAX) {
        return rd_fail(report, path, "not a regular file of at most 2 GiB");
    }
    f = fopen(path, "rb");
    *size = (size_t)length;
    *bytes = (unsigned char*)malloc(*size + 1);
    ok = f && *bytes && read_all(f, *bytes, *size);
    if (f) {
        fclose(f);
    }
    if (!ok) {
        free(*bytes);
        *bytes = NULL;
        return rd_fail(report, path, "cannot read");
    }
    return true;
}

bool rd_path_has_extension(const char* path, const char* extension)
{
    const char* dot = strrchr(path, '.');
    size_t i = 0;
    if (!dot) {
        return false;
    }
    for (++dot; dot[i] && extension[i]; ++i) {
        if (tolower((unsigned char)dot[i]) != extension[i]) {
            return false;
        }
    }
    return dot[i] == extension[i];
}

bool rd_output_begin(rd_output* out, const char* path, rd_report* report)
{
    size_t n = strlen(path) + 32;
    FILE* f;
    out->path = path;
    out->temporary = (char*)malloc(n);
    if (!out->temporary) {
        return rd_fail(report, path, "out of memory");
    }
    snprintf(out->temporary, n, "%s.part-%ld", path, (long)getpid());
    f = fopen(out->temporary, "wb");
    if (!f) {
        int reason = errno;
        free(out->temporary);
        out->temporary = NULL;
        return rd_fail(report, path, "cannot write: %s", strerror(reason));
    }
    fclose(f);
    return true;
}

bool rd_output_end(rd_output* out, bool complete, rd_report* report)
{
    bool ok = complete;
    if (complete && rename(out->temporary, out->path) != 0) {
        ok = rd_fail(report, out->path, "cannot write: %s", strerror(errno));
    }
    if (!ok) {
        remove(out->temporary);
    }
    free(out->temporary);
    out->temporary = NULL;
    return ok;
}

bool rd_output_check(const char* path, rd_report* report)
{
    rd_output out;
    if (!rd_output_begin(&out, path, report)) {
        return false;
    }
    rd_output_end(&out, false, report);
    return true;
}
