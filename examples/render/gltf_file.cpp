#include "gltf_file.h"

#include "file.h"

#include <cstring>

namespace rd
{
namespace
{

/* >>JSON */

const int max_depth = 64;
const size_t max_values = size_t(1) << 22;

/* Bounds depth and size of a text before the parser believes them. Returns how many members all
 * objects together have. */
size_t scan(std::string_view text)
{
    size_t values = 1, members = 0;
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            in_string = !in_string;
        } else if (in_string) {
            i += c == '\\';
        } else {
            depth += (c == '[' || c == '{') - (c == ']' || c == '}');
            values += c == '[' || c == '{' || c == ',';
            members += c == ':';
        }
        if (depth > max_depth || values > max_values) {
            throw refusal(depth > max_depth ? "JSON: nested too deeply" : "JSON: too many values");
        }
    }
    return members;
}

size_t count_members(const json& value)
{
    size_t count = value.is_object() ? value.size() : 0;
    for (const json& v : value) {
        count += v.is_structured() ? count_members(v) : 0;
    }
    return count;
}

json parse(std::string_view text)
{
    const size_t members = scan(text);
    if (text.find("\\u0000") != text.npos) {
        throw refusal("JSON: a string contains \\u0000");
    }
    try {
        json document = json::parse(text.begin(), text.end());
        if (count_members(document) != members) {
            throw refusal("JSON: an object has the same key twice");
        }
        return document;
    } catch (const json::exception& e) {
        /* "[json.exception.ID] REASON; last read: 'TEXT'" */
        const std::string what = e.what();
        const size_t begin = what.find("] ") + 2;
        throw refusal("JSON: " + what.substr(begin, what.find("; last read") - begin));
    }
}

/* >>GLB: a header of 12 bytes, then chunks: length, type, data */

uint32_t read_u32(const unsigned char* p)
{
    return uint32_t(p[0]) | uint32_t(p[1]) << 8 | uint32_t(p[2]) << 16 | uint32_t(p[3]) << 24;
}

/* The data of the chunk at `at`, which moves behind it. */
std::string_view take_chunk(const gltf_file& f, size_t* at, uint32_t* type)
{
    const unsigned char* chunk = f.bytes.get() + *at;
    const size_t left = f.size - *at;
    if (left < 8 || left - 8 < read_u32(chunk)) {
        throw refusal("GLB chunk is cut short");
    }
    const uint32_t length = read_u32(chunk);
    if (length % 4 != 0) {
        throw refusal("GLB chunk length is not a multiple of 4");
    }
    *type = read_u32(chunk + 4);
    *at += 8 + length;
    return {reinterpret_cast<const char*>(chunk + 8), length};
}

void open_container(gltf_file& f)
{
    const uint32_t json_type = 0x4e4f534a, bin_type = 0x004e4942;
    const unsigned char* header = f.bytes.get();
    size_t at = 12;
    if (f.size < at || read_u32(header + 4) != 2) {
        throw refusal("not a GLB file of version 2");
    }
    if (read_u32(header + 8) != f.size) {
        throw refusal("GLB header says " + std::to_string(read_u32(header + 8)) +
                      " bytes, the file has " + std::to_string(f.size));
    }
    for (int i = 0; i == 0 || at < f.size; ++i) {
        uint32_t type;
        const std::string_view data = take_chunk(f, &at, &type);
        if ((type == json_type) != (i == 0) || (type == bin_type && i != 1)) {
            throw refusal("GLB chunks are not JSON, then binary data");
        }
        if (type == json_type) {
            f.text = data;
        } else if (type == bin_type) {
            f.bin = data;
        }
    }
}

} // namespace

gltf_file open_gltf(const char* path, rd_report* report)
{
    gltf_file f = {};
    unsigned char* bytes = nullptr;
    const char* slash = std::strrchr(path, '/');
    f.path = path;
    f.directory = slash ? std::string(path, slash + 1) : "";
    if (!rd_file_read(path, &bytes, &f.size, report)) {
        throw refusal(""); /* the reason is in the report already */
    }
    f.bytes.reset(bytes);
    f.text = {reinterpret_cast<const char*>(bytes), f.size};
    if (f.text.substr(0, 4) == "glTF") {
        open_container(f);
    }
    f.document = parse(f.text);
    return f;
}

} // namespace rd
