/* The reader of the table in gltf_rules.cpp, and the extra checks that the table refers to. */
#include "gltf_rules.h"

#include "file.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace rd
{

/* >>the reader of the table */

bool is_one_of(const char* words, const std::string& word)
{
    return word.find('|') == std::string::npos && !word.empty() &&
           ("|" + std::string(words) + "|").find("|" + word + "|") != std::string::npos;
}

void checker::refuse(const char* format, ...) const
{
    char what[400];
    va_list args;
    va_start(args, format);
    std::vsnprintf(what, sizeof what, format, args);
    va_end(args);
    throw refusal((place_.empty() ? "the document" : place_) + " " + what);
}

void checker::expect(bool is_right, const char* reason) const
{
    if (!is_right) {
        refuse("%s", reason);
    }
}

void checker::check(const json& value, const rule& r)
{
    switch (r.type) {
    case kind::flag:
        expect(value.is_boolean(), "is not true or false");
        break;
    case kind::integer:
        expect(value.is_number_integer(), "is not an integer");
        check_number(value, r);
        break;
    case kind::number:
        expect(value.is_number(), "is not a number");
        check_number(value, r);
        break;
    case kind::text:
        expect(value.is_string(), "is not a string");
        break;
    case kind::word:
        expect(value.is_string(), "is not a string");
        check_word(value, r.words);
        break;
    case kind::code:
        expect(value.is_number_integer(), "is not an integer");
        check_word(value.dump(), r.words);
        break;
    case kind::index:
        expect(value.is_number_unsigned(), "is not an index");
        check_index(value, r.words);
        break;
    case kind::object:
        expect(value.is_object(), "is not an object");
        check_members(value, r);
        break;
    case kind::list:
    case kind::map:
        expect(r.type == kind::list ? value.is_array() : value.is_object(),
               r.type == kind::list ? "is not an array" : "is not an object");
        check_elements(value, r);
        break;
    }
    if (r.also && runs_extra_checks_) {
        r.also(*this, value);
    }
}

void checker::check_at(const std::string& step, const json& value, const rule& r)
{
    const size_t before = place_.size();
    place_ += step;
    check(value, r);
    place_.resize(before);
}

void checker::check_number(const json& value, const rule& r)
{
    const double v = value.get<double>();
    if (v < r.low || v > r.high) {
        refuse("is %g, outside [%g, %g]", v, r.low, r.high);
    }
}

void checker::check_word(const std::string& word, const char* words)
{
    if (!is_one_of(words, word)) {
        refuse("is %.60s, expected one of %s", word.c_str(), words);
    }
}

void checker::check_index(const json& value, const char* array)
{
    const json::json_pointer path("/" + std::string(array));
    const size_t count = file.document.contains(path) ? file.document.at(path).size() : 0;
    if (value.get<size_t>() >= count) {
        refuse("is %zu, but %s has %zu elements", value.get<size_t>(), array, count);
    }
}

void checker::check_members(const json& value, const rule& r)
{
    for (const auto& [name, rule_of_member] : r.members) {
        const auto found = value.find(name);
        if (found != value.end()) {
            check_at((place_.empty() ? "" : ".") + std::string(name), *found, rule_of_member);
        } else if (rule_of_member.is_required) {
            refuse("has no \"%s\"", name);
        }
    }
}

void checker::check_elements(const json& value, const rule& r)
{
    const double count = double(value.size());
    if (count < r.low || count > r.high) {
        refuse("has %zu elements", value.size());
    }
    for (const auto& e : value.items()) {
        check_at(value.is_array() ? "[" + e.key() + "]" : "." + e.key().substr(0, 40), e.value(),
                 r.members.front().second);
    }
}

void checker::run()
{
    check(file.document, document_rule);
    runs_extra_checks_ = true;
    check(file.document, document_rule);
}

void check_gltf(gltf_file& file)
{
    checker(file).run();
}

/* >>extra checks. Here all integers are at most 2^53 and all strides at most 252, so that no sum or
 * product below can overflow. */

namespace
{

/* An accessor without data is all zeros at no cost to the file: bound what it may ask for. */
const uint64_t max_dataless_count = 1u << 22;

uint64_t integer_of(const json& object, const char* name, uint64_t fallback = 0)
{
    return object.value(name, fallback);
}

const json& element(const checker& c, const char* array, const json& index)
{
    return c.file.document.at(array).at(index.get<size_t>());
}

/* %20 and its like decoded; empty where that fails or yields a terminator. */
std::string decode(const std::string& uri)
{
    std::string out;
    for (size_t i = 0; i < uri.size(); ++i) {
        unsigned char c = static_cast<unsigned char>(uri[i]);
        if (c == '%') {
            const char* digits = uri.data() + i + 1;
            if (uri.size() - i < 3 ||
                std::from_chars(digits, digits + 2, c, 16).ptr != digits + 2) {
                return "";
            }
            i += 2;
        }
        if (c == '\0') {
            return "";
        }
        out += static_cast<char>(c);
    }
    return out;
}

/* tinygltf takes a plus sign for a space. */
std::string name_for_tinygltf(const gltf_file& file, std::string uri)
{
    std::replace(uri.begin(), uri.end(), '+', ' ');
    return file.directory + decode(uri);
}

void check_data_uri(const checker& c, const std::string& uri, uint64_t needed)
{
    std::vector<unsigned char> bytes;
    std::string type;
    if (!tinygltf::DecodeDataURI(&bytes, type, uri, 0, false)) {
        c.refuse("has an invalid data URI");
    }
    if (needed && bytes.size() != needed) {
        c.refuse("data URI holds %zu bytes, byteLength is %zu", bytes.size(), size_t(needed));
    }
}

/* `needed` is 0 where any size will do. */
void check_uri(const checker& c, const std::string& uri, uint64_t needed)
{
    if (tinygltf::IsDataURI(uri)) {
        check_data_uri(c, uri, needed);
        return;
    }
    const std::string name = decode(uri);
    const std::string path = c.file.directory + name;
    uint64_t size;
    if (name.empty() || name[0] == '/' || uri.compare(0, 5, "data:") == 0 ||
        uri.find("://") != std::string::npos) {
        c.refuse("has an unusable URI \"%.80s\"", uri.c_str());
    }
    if (!rd_file_size(path.c_str(), &size)) {
        c.refuse("file \"%.160s\" not found", uri.c_str());
    }
    if (size < needed || size > RD_FILE_MAX) {
        c.refuse("file \"%.160s\" has %zu bytes, %zu needed", uri.c_str(), size_t(size),
                 size_t(needed));
    }
    c.file.externals[name_for_tinygltf(c.file, uri)] = {path, size_t(needed ? needed : size)};
}

/* Elements in a buffer view: sizes in bytes. */
struct layout {
    uint64_t offset, count, size, stride, component;
};

void check_extent(const checker& c, const json& view, const layout& l)
{
    if (l.offset + l.stride * (l.count - 1) + l.size > integer_of(view, "byteLength")) {
        c.refuse("reaches beyond its buffer view");
    }
    if ((l.offset + integer_of(view, "byteOffset")) % l.component != 0) {
        c.refuse("is not aligned to its component size");
    }
}

uint64_t component_size(const json& object)
{
    return uint64_t(tinygltf::GetComponentSizeInBytes(object.at("componentType").get<uint32_t>()));
}

/* Bytes of one element. Matrix columns begin at multiples of 4 bytes. */
uint64_t element_size(const json& accessor)
{
    const std::string type = accessor.at("type");
    const uint64_t n = type == "SCALAR" ? 1 : uint64_t(type.back() - '0');
    const uint64_t column = n * component_size(accessor);
    return type[0] == 'M' ? n * ((column + 3) / 4 * 4) : column;
}

void check_sparse(const checker& c, const json& accessor, const json& sparse)
{
    const json& indices = sparse.at("indices");
    const json& values = sparse.at("values");
    const json& index_view = element(c, "bufferViews", indices.at("bufferView"));
    const json& value_view = element(c, "bufferViews", values.at("bufferView"));
    const uint64_t count = integer_of(sparse, "count");
    const uint64_t index = component_size(indices);
    const uint64_t element = element_size(accessor);
    if (count > integer_of(accessor, "count")) {
        c.refuse("has more sparse values than elements");
    }
    if (index_view.contains("byteStride") || value_view.contains("byteStride")) {
        c.refuse("uses a buffer view with a byteStride for sparse data");
    }
    check_extent(c, index_view, {integer_of(indices, "byteOffset"), count, index, index, index});
    check_extent(
        c, value_view,
        {integer_of(values, "byteOffset"), count, element, element, component_size(accessor)});
}

bool is_quantized(const checker& c)
{
    const json used = c.file.document.value("extensionsUsed", json::array());
    return std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
}

void check_attribute(const checker& c, const std::string& name, const json& accessor)
{
    for (const attribute_rule& r : attribute_rules) {
        if (name.compare(0, std::strlen(r.prefix), r.prefix) == 0 &&
            (!is_one_of(r.types, accessor.at("type")) ||
             !is_one_of(is_quantized(c) ? r.quantized : r.components,
                        accessor.at("componentType").dump()))) {
            c.refuse("has a %.40s of the wrong type", name.c_str());
        }
    }
}

void check_indices(const checker& c, const json& accessor)
{
    if (accessor.at("type") != "SCALAR" ||
        !is_one_of("5121|5123|5125", accessor.at("componentType").dump())) {
        c.refuse("has indices of the wrong type");
    }
    if (accessor.contains("bufferView") &&
        element(c, "bufferViews", accessor.at("bufferView")).contains("byteStride")) {
        c.refuse("has indices with a byteStride");
    }
}

} // namespace

void buffer_has_its_bytes(checker& c, const json& buffer)
{
    const uint64_t length = integer_of(buffer, "byteLength");
    if (buffer.contains("uri")) {
        check_uri(c, buffer.at("uri"), length);
    } else if (&buffer != &c.file.document.at("buffers").front() || c.file.bin.empty()) {
        c.refuse("has no data");
    } else if (length > c.file.bin.size()) {
        c.refuse("needs %zu bytes, the GLB binary chunk has %zu", size_t(length),
                 c.file.bin.size());
    }
}

void view_lies_in_its_buffer(checker& c, const json& view)
{
    const json& buffer = element(c, "buffers", view.at("buffer"));
    if (integer_of(view, "byteOffset") + integer_of(view, "byteLength") >
        integer_of(buffer, "byteLength")) {
        c.refuse("reaches beyond its buffer");
    }
    if (integer_of(view, "byteStride") % 4 != 0) {
        c.refuse("has a byteStride that is not a multiple of 4");
    }
}

void accessor_lies_in_its_views(checker& c, const json& accessor)
{
    const uint64_t count = integer_of(accessor, "count");
    const uint64_t offset = integer_of(accessor, "byteOffset");
    const uint64_t size = element_size(accessor);
    if (accessor.contains("bufferView")) {
        const json& view = element(c, "bufferViews", accessor.at("bufferView"));
        const uint64_t stride = integer_of(view, "byteStride", size);
        if (stride < size) {
            c.refuse("has elements longer than the byteStride");
        }
        check_extent(c, view, {offset, count, size, stride, component_size(accessor)});
    } else if (offset > 0) {
        c.refuse("has a byteOffset but no buffer view");
    } else if (count > max_dataless_count) {
        c.refuse("asks for %zu elements without data", size_t(count));
    }
    if (accessor.contains("sparse")) {
        check_sparse(c, accessor, accessor.at("sparse"));
    }
}

void image_has_one_source(checker& c, const json& image)
{
    if (image.contains("uri") == image.contains("bufferView")) {
        c.refuse("needs either a uri or a bufferView");
    }
    if (image.contains("uri")) {
        check_uri(c, image.at("uri"), 0);
    }
}

/* 0 stands for infinity: the extension says so. */
void ior_is_possible(checker& c, const json& ior)
{
    if (ior > 0 && ior < 1) {
        c.refuse("is %g, expected 0 or at least 1", ior.get<double>());
    }
}

void primitive_fits_its_accessors(checker& c, const json& primitive)
{
    uint64_t count = 0;
    for (const auto& a : primitive.at("attributes").items()) {
        const json& accessor = element(c, "accessors", a.value());
        check_attribute(c, a.key(), accessor);
        if (count > 0 && integer_of(accessor, "count") != count) {
            c.refuse("has attributes of different length");
        }
        count = integer_of(accessor, "count");
    }
    if (primitive.contains("indices")) {
        check_indices(c, element(c, "accessors", primitive.at("indices")));
    }
}

void camera_has_its_lens(checker& c, const json& camera)
{
    const std::string type = camera.at("type");
    if (!camera.contains(type)) {
        c.refuse("has no \"%s\" member", type.c_str());
    }
    const json& lens = camera.at(type);
    if (lens.contains("zfar") && lens.at("zfar") <= lens.at("znear")) {
        c.refuse("has a zfar that is not beyond znear");
    }
}

void light_has_its_cone(checker& c, const json& light)
{
    const json spot = light.value("spot", json::object());
    const double inner = spot.value("innerConeAngle", 0.0);
    const double outer = spot.value("outerConeAngle", 0.785398163397448);
    if (light.at("type") == "spot" && !light.contains("spot")) {
        c.refuse("is a spot light without \"spot\"");
    }
    if (inner >= outer) {
        c.refuse("innerConeAngle %g is not below outerConeAngle %g", inner, outer);
    }
}

void node_has_one_transform(checker& c, const json& node)
{
    double square = 0.0;
    if (node.contains("matrix") &&
        (node.contains("translation") || node.contains("rotation") || node.contains("scale"))) {
        c.refuse("has a matrix and translation, rotation or scale");
    }
    for (const json& e : node.value("rotation", json({0, 0, 0, 1}))) {
        square += e.get<double>() * e.get<double>();
    }
    /* A tolerance for exporters that write few digits; a loader normalises what passes. */
    if (std::fabs(square - 1.0) >= 0.02) {
        c.refuse("has a rotation that is not a unit quaternion");
    }
}

/* Every node has at most one parent; then a cycle is a component without a root. */
void nodes_form_trees(checker& c, const json& nodes)
{
    const size_t none = nodes.size();
    std::vector<size_t> parent(nodes.size(), none), visit(nodes.size(), none);
    for (size_t i = 0; i < nodes.size(); ++i) {
        for (const size_t child : nodes[i].value("children", std::vector<size_t>())) {
            if (parent[child] != none) {
                c.refuse("has two parents for node %zu", child);
            }
            parent[child] = i;
        }
    }
    for (size_t i = 0; i < nodes.size(); ++i) {
        size_t n = i;
        while (n != none && visit[n] == none) {
            visit[n] = i;
            n = parent[n];
        }
        if (n != none && visit[n] == i) {
            c.refuse("has a cycle through node %zu", n);
        }
    }
}

} // namespace rd
