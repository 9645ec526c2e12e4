/* A glTF file in memory: the container taken apart, the JSON tree, the addresses of its data. */
#ifndef RD_GLTF_FILE_H
#define RD_GLTF_FILE_H

#include "json.h"
#include "report.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct rd_gltf_file {
    const char* path;
    char* directory; /* with a slash at its end, or empty */
    unsigned char* bytes;
    size_t size;
    bool is_binary;
    const char* json;
    size_t json_size;
    const unsigned char* bin; /* the binary chunk, NULL where there is none */
    size_t bin_size;
    rd_json_document document;
} rd_gltf_file;

/* Reads the file, checks the container and parses the JSON text. */
bool rd_gltf_file_open(rd_gltf_file* file, const char* path, rd_report* report);
void rd_gltf_file_close(rd_gltf_file* file);

/* Refuses what glTF 2.0 and the extensions we read forbid, as far as it could mislead or harm a
 * loader: types, required members, ranges, references, memory extents, external files. */
bool rd_gltf_validate(const rd_gltf_file* file, rd_report* report);

/* Types, members, ranges and references, by table. */
bool rd_gltf_check_schema(const rd_gltf_file* file, rd_report* report);

/* The payload of a base64 data URI: where it begins and how many bytes it decodes to. False where
 * the URI is malformed or its media type is not one of `types` ("a|b"). */
bool rd_gltf_data_uri(const char* uri, const char* types, size_t* decoded_size);
bool rd_gltf_is_data_uri(const char* uri);

/* The file that a relative URI names, percent-escapes decoded; NULL where it is not a plain
 * relative path. The caller frees it. */
char* rd_gltf_uri_path(const rd_gltf_file* file, const char* uri);

#ifdef __cplusplus
}
#endif
#endif
