/* glTF files through tinygltf: the scene graph, lights and cameras. */
#include "gltf_import.h"

#include "file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

namespace rd
{

bool fail(const importer& in, const std::string& where, const std::string& reason)
{
    return rd_fail(in.report, in.file->path, "%s: %s", where.c_str(), reason.c_str());
}

namespace
{

using tinygltf::Model;
using tinygltf::Node;

/* >>files: tinygltf asks for the files that a model names */

bool file_exists(const std::string& name, void* user)
{
    return static_cast<const gltf_file*>(user)->externals.count(name) > 0;
}

std::string expand_path(const std::string& name, void*)
{
    return name;
}

/* Only what the check has seen. A buffer's file may be longer than the buffer, which tinygltf does
 * not accept: cuts it. */
bool read_file(std::vector<unsigned char>* out, std::string* error, const std::string& name,
               void* user)
{
    const external_file& file = static_cast<const gltf_file*>(user)->externals.at(name);
    rd_report report;
    unsigned char* bytes = nullptr;
    size_t size = 0;
    report.failed = false;
    if (!rd_file_read(file.path.c_str(), &bytes, &size, &report)) {
        *error += report.error;
        return false;
    }
    out->assign(bytes, bytes + std::min(size, file.size));
    std::free(bytes);
    return true;
}

/* Keeps the compressed bytes of an image that is a file or a data URI: they are decoded later, in
 * parallel. Those in buffer views stay where they are. */
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*)
{
    if (image->bufferView < 0) {
        image->image.assign(bytes, bytes + size);
    }
    image->as_is = true;
    return true;
}

/* tinygltf parses the text once more: it takes no tree, and our check needs one. A GLB without
 * binary data is read as its text, for tinygltf does not accept an empty chunk. */
bool parse(const gltf_file& file, Model* model, std::string* error)
{
    tinygltf::TinyGLTF loader;
    std::string warning;
    loader.SetFsCallbacks(
        {file_exists, expand_path, read_file, nullptr, const_cast<gltf_file*>(&file)});
    loader.SetImageLoader(keep_image, nullptr);
    return file.bin.empty() ? loader.LoadASCIIFromString(model, error, &warning, file.text.data(),
                                                         unsigned(file.text.size()), file.directory)
                            : loader.LoadBinaryFromMemory(model, error, &warning, file.bytes.get(),
                                                          unsigned(file.size), file.directory);
}

/* >>scene graph */

hdrp_v3 v3(const std::vector<double>& v, float fallback)
{
    return v.size() < 3 ? hdrp_v3_splat(fallback)
                        : hdrp_v3_make(float(v[0]), float(v[1]), float(v[2]));
}

rd_affine local_transform(const Node& n)
{
    if (n.matrix.size() == 16) {
        const std::vector<double>& m = n.matrix;
        rd_affine a;
        a.x = hdrp_v3_make(float(m[0]), float(m[1]), float(m[2]));
        a.y = hdrp_v3_make(float(m[4]), float(m[5]), float(m[6]));
        a.z = hdrp_v3_make(float(m[8]), float(m[9]), float(m[10]));
        a.t = hdrp_v3_make(float(m[12]), float(m[13]), float(m[14]));
        return a;
    }
    hdrp_v4 q = hdrp_v4_make(0.0f, 0.0f, 0.0f, 1.0f);
    if (n.rotation.size() == 4) {
        q = hdrp_v4_make(float(n.rotation[0]), float(n.rotation[1]), float(n.rotation[2]),
                         float(n.rotation[3]));
    }
    return rd_affine_from_trs(v3(n.translation, 0.0f), q, v3(n.scale, 1.0f));
}

void copy_name(char (&out)[RD_NAME_MAX], const std::string& name)
{
    std::snprintf(out, RD_NAME_MAX, "%s", name.c_str());
}

bool import_light(const importer& in, const Node& node, const rd_affine& world)
{
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end()) {
        return true;
    }
    const tinygltf::Light& from =
        in.model->lights[size_t(found->second.Get("light").GetNumberAsInt())];
    rd_light l;
    std::memset(&l, 0, sizeof l);
    l.type = from.type == "directional" ? RD_LIGHT_DIRECTIONAL
             : from.type == "spot"      ? RD_LIGHT_SPOT
                                        : RD_LIGHT_POINT;
    l.position = world.t;
    l.forward = hdrp_normalize_or(hdrp_v3_neg(world.z), hdrp_v3_make(0.0f, 0.0f, -1.0f));
    l.right = hdrp_normalize_or(world.x, hdrp_basis_from_normal(l.forward).tangent);
    l.up = hdrp_v3_cross(l.right, l.forward);
    l.color = v3(from.color, 1.0f);
    l.intensity = float(from.intensity);
    l.range_m = float(from.range);
    l.inner_angle_rad = float(from.spot.innerConeAngle);
    l.outer_angle_rad = float(from.spot.outerConeAngle);
    if (!rd_scene_add_light(in.scene, &l)) {
        return fail(in, "lights", "out of memory");
    }
    return true;
}

/* A camera follows its node without scale: only the directions of the axes count. */
rd_affine rigid(const rd_affine& a)
{
    rd_affine r;
    r.z = hdrp_normalize_or(a.z, hdrp_v3_make(0.0f, 0.0f, 1.0f));
    r.x = hdrp_normalize_or(hdrp_v3_cross(a.y, r.z), hdrp_basis_from_normal(r.z).tangent);
    r.y = hdrp_v3_cross(r.z, r.x);
    r.t = a.t;
    return r;
}

bool import_camera(const importer& in, const Node& node, const rd_affine& world)
{
    if (node.camera < 0) {
        return true;
    }
    const tinygltf::Camera& from = in.model->cameras[size_t(node.camera)];
    rd_scene_camera c;
    std::memset(&c, 0, sizeof c);
    copy_name(c.name, from.name.empty() ? node.name : from.name);
    c.world_from_view = rigid(world);
    c.orthographic = from.type == "orthographic";
    c.fov_y_rad = float(from.perspective.yfov);
    c.half_width = float(from.orthographic.xmag);
    c.half_height = float(from.orthographic.ymag);
    if (!rd_scene_add_camera(in.scene, &c)) {
        return fail(in, "cameras", "out of memory");
    }
    return true;
}

bool import_node(const importer& in, const Node& node, const rd_affine& world)
{
    if (node.skin >= 0 && node.mesh >= 0) {
        rd_warn(in.report, in.file->path, "skins are ignored: %.60s is shown in its bind pose",
                node.name.c_str());
    }
    return (node.mesh < 0 || import_mesh(in, node.mesh, world)) && import_light(in, node, world) &&
           import_camera(in, node, world);
}

std::vector<int> root_nodes(const Model& model)
{
    if (!model.scenes.empty()) {
        const int scene = model.defaultScene >= 0 ? model.defaultScene : 0;
        return model.scenes[size_t(scene)].nodes;
    }
    std::vector<bool> has_parent(model.nodes.size(), false);
    for (const Node& n : model.nodes) {
        for (int child : n.children) {
            has_parent[size_t(child)] = true;
        }
    }
    std::vector<int> roots;
    for (size_t i = 0; i < has_parent.size(); ++i) {
        if (!has_parent[i]) {
            roots.push_back(int(i));
        }
    }
    return roots;
}

struct visit {
    int node;
    rd_affine parent;
};

/* Depth first with a stack of its own: a file may chain nodes deeper than the machine's. */
bool import_nodes(const importer& in)
{
    std::vector<visit> stack;
    const std::vector<int> roots = root_nodes(*in.model);
    for (auto r = roots.rbegin(); r != roots.rend(); ++r) {
        stack.push_back({*r, rd_affine_identity()});
    }
    while (!stack.empty()) {
        const visit v = stack.back();
        const Node& node = in.model->nodes[size_t(v.node)];
        const rd_affine world = rd_affine_mul(v.parent, local_transform(node));
        stack.pop_back();
        if (!import_node(in, node, world)) {
            return false;
        }
        for (auto c = node.children.rbegin(); c != node.children.rend(); ++c) {
            stack.push_back({*c, world});
        }
    }
    return true;
}

void warn_of_ignored(const importer& in)
{
    if (!in.model->animations.empty()) {
        rd_warn(in.report, in.file->path, "animations are ignored");
    }
    if (in.scene->mesh_count == 0) {
        rd_warn(in.report, in.file->path, "the scene has no triangles");
    }
}

bool import_model(const gltf_file& file, rd_scene* scene, rd_report* report)
{
    Model model;
    std::string error;
    const importer in = {&file, &model, scene, report};
    if (!parse(file, &model, &error)) {
        throw refusal(error.empty() ? "cannot be read" : error);
    }
    if (!import_materials(in) || !import_nodes(in)) {
        return false;
    }
    warn_of_ignored(in);
    rd_scene_update_bounds(scene);
    return true;
}

} // namespace
} // namespace rd

bool rd_scene_load_gltf(rd_scene* scene, const char* path, rd_report* report)
{
    std::memset(scene, 0, sizeof *scene);
    try {
        rd::gltf_file file = rd::open_gltf(path, report);
        rd::check_gltf(file);
        return rd::import_model(file, scene, report);
    } catch (const std::bad_alloc&) {
        return rd_fail(report, path, "out of memory");
    } catch (const std::exception& e) {
        return rd_fail(report, path, "%s", e.what());
    } catch (...) {
        return rd_fail(report, path, "unknown failure of a library");
    }
}
