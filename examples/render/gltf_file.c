#include "gltf_file.h"

#include "file.h"

#include <stdlib.h>
#include <string.h>

#define GLB_HEADER       12
#define GLB_CHUNK_HEADER 8
#define GLB_JSON         0x4e4f534au
#define GLB_BIN          0x004e4942u

static uint32_t read_u32(const unsigned char* p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* Takes one chunk; the index decides which types are allowed. */
static bool take_chunk(rd_gltf_file* f, size_t* at, int index, rd_report* report)
{
    uint32_t length, type;
    const unsigned char* data;
    if (f->size - *at < GLB_CHUNK_HEADER) {
        return rd_fail(report, f->path, "GLB chunk header is cut short");
    }
    length = read_u32(f->bytes + *at);
    type = read_u32(f->bytes + *at + 4);
    data = f->bytes + *at + GLB_CHUNK_HEADER;
    *at += GLB_CHUNK_HEADER;
    if (length > f->size - *at) {
        return rd_fail(report, f->path, "GLB chunk of %u bytes is cut short", length);
    }
    if (length % 4 != 0) {
        return rd_fail(report, f->path, "GLB chunk length %u is not a multiple of 4", length);
    }
    *at += length;
    if ((index == 0) != (type == GLB_JSON)) {
        return rd_fail(report, f->path,
                       index == 0 ? "the first GLB chunk is not JSON"
                                  : "GLB has a second JSON chunk");
    }
    if (type == GLB_JSON) {
        f->json = (const char*)data;
        f->json_size = length;
    } else if (type == GLB_BIN && index != 1) {
        return rd_fail(report, f->path, "GLB binary chunk is not the second chunk");
    } else if (type == GLB_BIN) {
        f->bin = data;
        f->bin_size = length;
    }
    return true;
}

static bool open_binary(rd_gltf_file* f, rd_report* report)
{
    size_t at = GLB_HEADER;
    f->is_binary = true;
    if (f->size < GLB_HEADER) {
        return rd_fail(report, f->path, "GLB header is cut short");
    }
    if (read_u32(f->bytes + 4) != 2) {
        return rd_fail(report, f->path, "GLB version %u, expected 2", read_u32(f->bytes + 4));
    }
    if (read_u32(f->bytes + 8) != f->size) {
        return rd_fail(report, f->path, "GLB header says %u bytes, the file has %zu",
                       read_u32(f->bytes + 8), f->size);
    }
    if (at == f->size) {
        return rd_fail(report, f->path, "GLB has no JSON chunk");
    }
    for (int index = 0; at < f->size; ++index) {
        if (!take_chunk(f, &at, index, report)) {
            return false;
        }
    }
    return true;
}

bool rd_gltf_file_open(rd_gltf_file* f, const char* path, rd_report* report)
{
    char why[160];
    memset(f, 0, sizeof *f);
    f->path = path;
    if (!rd_file_read(path, &f->bytes, &f->size, report)) {
        return false;
    }
    f->directory = rd_path_directory(path);
    if (!f->directory) {
        return rd_fail(report, path, "out of memory");
    }
    if (f->size >= 4 && !memcmp(f->bytes, "glTF", 4)) {
        if (!open_binary(f, report)) {
            return false;
        }
    } else {
        f->json = (const char*)f->bytes;
        f->json_size = f->size;
    }
    if (!rd_json_read(&f->document, f->json, f->json_size, why)) {
        return rd_fail(report, path, "%s", why);
    }
    return true;
}

void rd_gltf_file_close(rd_gltf_file* f)
{
    rd_json_free(&f->document);
    free(f->bytes);
    free(f->directory);
    memset(f, 0, sizeof *f);
}

bool rd_gltf_is_data_uri(const char* uri)
{
    return !strncmp(uri, "data:", 5);
}

static bool is_listed(const char* list, const char* word, size_t length)
{
    while (*list) {
        const char* bar = strchr(list, '|');
        size_t n = bar ? (size_t)(bar - list) : strlen(list);
        if (n == length && !memcmp(list, word, n)) {
            return true;
        }
        list += bar ? n + 1 : n;
    }
    return false;
}

static bool base64_size(const char* s, size_t* size)
{
    static const char alphabet[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t n = strspn(s, alphabet);
    size_t padding = strspn(s + n, "=");
    if (s[n + padding] || padding > 2 || (n + padding) % 4 != 0) {
        return false;
    }
    *size = (n + padding) / 4 * 3 - padding;
    return true;
}

bool rd_gltf_data_uri(const char* uri, const char* types, size_t* decoded_size)
{
    static const char marker[] = ";base64,";
    const char* type = uri + 5;
    const char* end = strstr(type, marker);
    return end && is_listed(types, type, (size_t)(end - type)) &&
           base64_size(end + strlen(marker), decoded_size);
}

static int hex_digit(char c)
{
    const char* digits = "0123456789abcdef";
    const char* hit = c ? strchr(digits, c >= 'A' && c <= 'F' ? c + 32 : c) : NULL;
    return hit ? (int)(hit - digits) : -1;
}

/* Decodes %XX in place; false where an escape is broken or hides a terminator. */
static bool percent_decode(char* s)
{
    char* out = s;
    for (; *s; ++s) {
        if (*s == '%') {
            int high = hex_digit(s[1]);
            int low = high < 0 ? -1 : hex_digit(s[2]);
            if (low < 0 || (high == 0 && low == 0)) {
                return false;
            }
            *out++ = (char)(high * 16 + low);
            s += 2;
        } else {
            *out++ = *s;
        }
    }
    *out = '\0';
    return true;
}

char* rd_gltf_uri_path(const rd_gltf_file* f, const char* uri)
{
    size_t prefix = strlen(f->directory);
    char* path;
    if (!uri[0] || uri[0] == '/' || strstr(uri, "://")) {
        return NULL;
    }
    path = rd_path_join(f->directory, uri);
    if (path && (!percent_decode(path + prefix) || path[prefix] == '/')) {
        free(path);
        path = NULL;
    }
    return path;
}
