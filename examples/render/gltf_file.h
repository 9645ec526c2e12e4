/* A glTF file in memory, before tinygltf sees it: the container taken apart, the JSON text read and
 * checked. What is checked stands in one table, gltf_rules.cpp. */
#ifndef RD_GLTF_FILE_H
#define RD_GLTF_FILE_H

#include "report.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rd
{

using nlohmann::json;

/* Why a file is refused, in words for its user. rd_scene_load_gltf turns it into the report. */
struct refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct free_bytes {
    void operator()(unsigned char* p) const
    {
        std::free(p);
    }
};

/* A file that the model names, and how much of its beginning belongs to the model. */
struct external_file {
    std::string path;
    size_t size;
};

struct gltf_file {
    const char* path;
    std::string directory; /* with a slash at its end, or empty */
    std::unique_ptr<unsigned char, free_bytes> bytes;
    size_t size;
    std::string_view text; /* JSON, inside bytes */
    std::string_view bin;  /* the binary chunk, empty where there is none */
    json document;
    std::map<std::string, external_file> externals; /* by the name under which tinygltf asks */
};

/* Reads the file, checks the container and parses the JSON text, or throws. */
gltf_file open_gltf(const char* path, rd_report* report);

/* Throws unless the document obeys the table; finds the external files. */
void check_gltf(gltf_file& file);

} // namespace rd

#endif
