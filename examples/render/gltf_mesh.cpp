/* glTF geometry: accessors of any layout to plain arrays, checked value by value. */
#include "gltf_import.h"

#include <cmath>
#include <cstdio>
#include <cstring>

namespace rd
{
namespace
{

using tinygltf::Accessor;
using tinygltf::Model;
using tinygltf::Primitive;

/* Beyond this, 32-bit floats and ray tracing lose every detail of a scene in metres. */
const float position_limit = 1e9f;

/* One primitive on its way: where it is, for messages, and how far its arrays are. */
struct job {
    const importer* in;
    const Primitive* primitive;
    std::string where;
    rd_mesh mesh;
};

size_t component_size(int type)
{
    return size_t(tinygltf::GetComponentSizeInBytes(uint32_t(type)));
}

size_t component_count(int type)
{
    return size_t(tinygltf::GetNumComponentsInType(uint32_t(type)));
}

template <class T> T load(const unsigned char* p)
{
    T v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

float load_float(const unsigned char* p, int type, bool normalized)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
        const float v = float(load<int8_t>(p));
        return normalized ? std::fmax(v / 127.0f, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return float(load<uint8_t>(p)) / (normalized ? 255.0f : 1.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
        const float v = float(load<int16_t>(p));
        return normalized ? std::fmax(v / 32767.0f, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return float(load<uint16_t>(p)) / (normalized ? 65535.0f : 1.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return float(load<uint32_t>(p));
    default:
        return load<float>(p);
    }
}

uint32_t load_index(const unsigned char* p, int type)
{
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? load<uint8_t>(p)
           : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? load<uint16_t>(p)
                                                            : load<uint32_t>(p);
}

const unsigned char* view_data(const Model& model, int view, size_t offset)
{
    const tinygltf::BufferView& v = model.bufferViews[size_t(view)];
    return model.buffers[size_t(v.buffer)].data.data() + v.byteOffset + offset;
}

void load_element(const unsigned char* from, const Accessor& a, float* out)
{
    const size_t size = component_size(a.componentType);
    for (size_t c = 0; c < component_count(a.type); ++c) {
        out[c] = load_float(from + c * size, a.componentType, a.normalized);
    }
}

/* Where an accessor keeps its elements; NULL stands for zeros. */
struct elements {
    const unsigned char* data;
    size_t stride;
};

elements elements_of(const Model& model, const Accessor& a)
{
    const size_t packed = component_size(a.componentType) * component_count(a.type);
    if (a.bufferView < 0) {
        return {nullptr, 0};
    }
    const size_t stride = model.bufferViews[size_t(a.bufferView)].byteStride;
    return {view_data(model, a.bufferView, a.byteOffset), stride ? stride : packed};
}

bool apply_sparse(const job& j, const Accessor& a, float* out)
{
    const Model& model = *j.in->model;
    const size_t components = component_count(a.type);
    const size_t size = component_size(a.componentType) * components;
    const auto& s = a.sparse;
    const unsigned char* index =
        view_data(model, s.indices.bufferView, size_t(s.indices.byteOffset));
    const unsigned char* value = view_data(model, s.values.bufferView, size_t(s.values.byteOffset));
    const size_t index_size = component_size(s.indices.componentType);
    for (int i = 0; i < s.count; ++i, index += index_size, value += size) {
        const uint32_t at = load_index(index, s.indices.componentType);
        if (at >= a.count) {
            return fail(*j.in, j.where, "sparse index " + std::to_string(at) + " is out of range");
        }
        load_element(value, a, out + at * components);
    }
    return true;
}

/* All elements as floats, in the accessor's own number of components. */
bool read_floats(const job& j, const Accessor& a, std::vector<float>* out)
{
    const elements e = elements_of(*j.in->model, a);
    const size_t components = component_count(a.type);
    out->assign(a.count * components, 0.0f);
    for (size_t i = 0; e.data && i < a.count; ++i) {
        load_element(e.data + i * e.stride, a, out->data() + i * components);
    }
    return !a.sparse.isSparse || apply_sparse(j, a, out->data());
}

const Accessor* attribute(const job& j, const char* name)
{
    const auto found = j.primitive->attributes.find(name);
    return found == j.primitive->attributes.end() ? nullptr
                                                  : &j.in->model->accessors[size_t(found->second)];
}

bool bad_vertex(const job& j, const char* name, size_t i, const char* what)
{
    return fail(*j.in, j.where, std::string(name) + " of vertex " + std::to_string(i) + " " + what);
}

bool all_finite(const job& j, const char* name, const std::vector<float>& v, size_t components)
{
    for (size_t i = 0; i < v.size(); ++i) {
        if (!std::isfinite(v[i])) {
            return bad_vertex(j, name, i / components, "is not finite");
        }
    }
    return true;
}

bool read_attribute(const job& j, const char* name, const Accessor& a, std::vector<float>* out)
{
    return read_floats(j, a, out) && all_finite(j, name, *out, component_count(a.type));
}

bool read_positions(job& j)
{
    std::vector<float> v;
    if (!read_attribute(j, "POSITION", *attribute(j, "POSITION"), &v)) {
        return false;
    }
    for (size_t i = 0; i < j.mesh.vertex_count; ++i) {
        j.mesh.positions[i] = hdrp_v3_make(v[i * 3], v[i * 3 + 1], v[i * 3 + 2]);
    }
    return true;
}

/* glTF demands unit normals. Inexact ones are rescaled; what is far off is no direction at all,
 * and the file is refused. */
bool read_normals(job& j)
{
    std::vector<float> v;
    bool inexact = false;
    if (!read_attribute(j, "NORMAL", *attribute(j, "NORMAL"), &v)) {
        return false;
    }
    for (size_t i = 0; i < j.mesh.vertex_count; ++i) {
        const hdrp_v3 n = hdrp_v3_make(v[i * 3], v[i * 3 + 1], v[i * 3 + 2]);
        const float length = hdrp_v3_length(n);
        if (!(length > 0.5f && length < 2.0f)) {
            return bad_vertex(j, "NORMAL", i, "is not a unit vector");
        }
        inexact = inexact || std::fabs(length - 1.0f) > 0.02f;
        j.mesh.normals[i] = hdrp_v3_scale(n, 1.0f / length);
    }
    if (inexact) {
        rd_warn(j.in->report, j.in->file->path, "%s: normals were not of unit length",
                j.where.c_str());
    }
    return true;
}

/* A tangent without direction stays zero: shading then derives one from the uv. */
bool read_tangents(job& j)
{
    std::vector<float> v;
    if (!read_attribute(j, "TANGENT", *attribute(j, "TANGENT"), &v)) {
        return false;
    }
    for (size_t i = 0; i < j.mesh.vertex_count; ++i) {
        const float* p = &v[i * 4];
        const hdrp_v3 t = hdrp_normalize_or(hdrp_v3_make(p[0], p[1], p[2]), hdrp_v3_splat(0.0f));
        j.mesh.tangents[i] = hdrp_v4_from_v3(t, p[3] < 0.0f ? -1.0f : 1.0f);
    }
    return true;
}

bool read_colors(job& j)
{
    std::vector<float> v;
    const Accessor& a = *attribute(j, "COLOR_0");
    const size_t n = component_count(a.type);
    if (!read_attribute(j, "COLOR_0", a, &v)) {
        return false;
    }
    for (size_t i = 0; i < j.mesh.vertex_count; ++i) {
        const float* p = &v[i * n];
        j.mesh.colors[i] = hdrp_v4_make(hdrp_saturate(p[0]), hdrp_saturate(p[1]),
                                        hdrp_saturate(p[2]), n == 4 ? hdrp_saturate(p[3]) : 1.0f);
    }
    return true;
}

std::string uv_name(int set)
{
    return "TEXCOORD_" + std::to_string(set);
}

bool read_uv(job& j, int set)
{
    std::vector<float> v;
    const std::string name = uv_name(set);
    if (!read_attribute(j, name.c_str(), *attribute(j, name.c_str()), &v)) {
        return false;
    }
    for (size_t i = 0; i < j.mesh.vertex_count; ++i) {
        j.mesh.uv[set][i] = hdrp_v2_make(v[i * 2], v[i * 2 + 1]);
    }
    return true;
}

bool read_vertices(job& j)
{
    bool ok = read_positions(j);
    ok = ok && (!j.mesh.normals || read_normals(j));
    ok = ok && (!j.mesh.tangents || read_tangents(j));
    ok = ok && (!j.mesh.colors || read_colors(j));
    for (int i = 0; ok && i < RD_MAX_UV_SETS; ++i) {
        ok = !j.mesh.uv[i] || read_uv(j, i);
    }
    return ok;
}

/* The vertices of the primitive in order of use. */
bool read_indices(const job& j, size_t vertex_count, std::vector<uint32_t>* out)
{
    if (j.primitive->indices < 0) {
        out->resize(vertex_count);
        for (size_t i = 0; i < vertex_count; ++i) {
            (*out)[i] = uint32_t(i);
        }
        return true;
    }
    const Accessor& a = j.in->model->accessors[size_t(j.primitive->indices)];
    if (a.sparse.isSparse) {
        return fail(*j.in, j.where, "sparse indices are not read");
    }
    const elements e = elements_of(*j.in->model, a);
    out->assign(a.count, 0);
    for (size_t i = 0; e.data && i < a.count; ++i) {
        (*out)[i] = load_index(e.data + i * e.stride, a.componentType);
    }
    for (uint32_t index : *out) {
        if (index >= vertex_count) {
            return fail(*j.in, j.where,
                        "index " + std::to_string(index) + " is beyond its " +
                            std::to_string(vertex_count) + " vertices");
        }
    }
    return true;
}

size_t triangles_of(int mode, size_t indices)
{
    return mode == TINYGLTF_MODE_TRIANGLES ? indices / 3 : indices < 3 ? 0 : indices - 2;
}

void write_triangles(int mode, const std::vector<uint32_t>& v, rd_mesh* mesh)
{
    for (size_t i = 0; i < mesh->triangle_count; ++i) {
        size_t a = i * 3, b = i * 3 + 1, c = i * 3 + 2;
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            a = i;
            b = i + 1 + i % 2;
            c = i + 2 - i % 2;
        } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            a = i + 1;
            b = i + 2;
            c = 0;
        }
        mesh->indices[i * 3] = v[a];
        mesh->indices[i * 3 + 1] = v[b];
        mesh->indices[i * 3 + 2] = v[c];
    }
}

bool within_limits(const job& j)
{
    for (size_t i = 0; i < j.mesh.vertex_count; ++i) {
        const hdrp_v3 p = j.mesh.positions[i];
        const float m = std::fmax(std::fabs(p.x), std::fmax(std::fabs(p.y), std::fabs(p.z)));
        if (!(m <= position_limit)) {
            return bad_vertex(j, "POSITION", i, "is more than 1e9 m from the origin");
        }
    }
    return true;
}

/* The uv sets that the material reads have to be there. */
bool check_uv_sets(const job& j, const rd_material& material)
{
    for (const rd_texture_slot& slot : material.slot) {
        if (slot.texture < 0) {
            continue;
        }
        if (slot.uv_set >= RD_MAX_UV_SETS) {
            return fail(*j.in, j.where, uv_name(slot.uv_set) + " is beyond the sets that are read");
        }
        if (!attribute(j, uv_name(slot.uv_set).c_str())) {
            return fail(*j.in, j.where, "the material needs " + uv_name(slot.uv_set));
        }
    }
    return true;
}

uint32_t uv_mask(const job& j)
{
    uint32_t mask = 0;
    for (int i = 0; i < RD_MAX_UV_SETS; ++i) {
        mask |= attribute(j, uv_name(i).c_str()) ? 1u << i : 0u;
    }
    return mask;
}

bool allocate(job& j, size_t vertices, size_t triangles)
{
    const rd_scene* scene = j.in->scene;
    if (scene->vertex_count + vertices > RD_MAX_VERTICES ||
        scene->triangle_count + triangles > RD_MAX_TRIANGLES) {
        return fail(*j.in, j.where, "the scene has too many triangles");
    }
    const bool normals = attribute(j, "NORMAL") != nullptr;
    if (!rd_mesh_allocate(&j.mesh, uint32_t(vertices), uint32_t(triangles), normals,
                          normals && attribute(j, "TANGENT"), attribute(j, "COLOR_0") != nullptr,
                          uv_mask(j))) {
        return fail(*j.in, j.where, "out of memory");
    }
    return true;
}

bool fill(job& j, const rd_affine& world)
{
    const Accessor& positions = *attribute(j, "POSITION");
    const int mode = j.primitive->mode < 0 ? TINYGLTF_MODE_TRIANGLES : j.primitive->mode;
    std::vector<uint32_t> order;
    if (!check_uv_sets(j, j.in->scene->materials[j.mesh.material]) ||
        !read_indices(j, positions.count, &order) ||
        !allocate(j, positions.count, triangles_of(mode, order.size())) || !read_vertices(j)) {
        return false;
    }
    write_triangles(mode, order, &j.mesh);
    rd_mesh_transform(&j.mesh, world);
    return within_limits(j);
}

bool is_drawn(const job& j)
{
    const int mode = j.primitive->mode;
    if (mode >= 0 && mode < TINYGLTF_MODE_TRIANGLES) {
        rd_warn(j.in->report, j.in->file->path, "%s: points and lines are not drawn",
                j.where.c_str());
        return false;
    }
    if (!attribute(j, "POSITION")) {
        rd_warn(j.in->report, j.in->file->path, "%s: has no POSITION", j.where.c_str());
        return false;
    }
    if (!j.primitive->targets.empty()) {
        rd_warn(j.in->report, j.in->file->path, "%s: morph targets are ignored", j.where.c_str());
    }
    return true;
}

bool import_primitive(job& j, const rd_affine& world)
{
    if (!is_drawn(j)) {
        return true;
    }
    if (!fill(j, world)) {
        rd_mesh_free(&j.mesh);
        return false;
    }
    if (j.mesh.triangle_count == 0) {
        rd_mesh_free(&j.mesh);
        return true;
    }
    return rd_scene_add_mesh(j.in->scene, &j.mesh) ? true : fail(*j.in, j.where, "out of memory");
}

} // namespace

bool import_mesh(const importer& in, int index, rd_affine world_from_node)
{
    const tinygltf::Mesh& mesh = in.model->meshes[size_t(index)];
    for (size_t i = 0; i < mesh.primitives.size(); ++i) {
        job j;
        j.in = &in;
        j.primitive = &mesh.primitives[i];
        j.where = "meshes[" + std::to_string(index) + "].primitives[" + std::to_string(i) + "]";
        std::memset(&j.mesh, 0, sizeof j.mesh);
        std::snprintf(j.mesh.name, RD_NAME_MAX, "%s", mesh.name.c_str());
        j.mesh.material =
            j.primitive->material >= 0 ? j.primitive->material : in.scene->material_count - 1;
        if (!import_primitive(j, world_from_node)) {
            return false;
        }
    }
    return true;
}

} // namespace rd
