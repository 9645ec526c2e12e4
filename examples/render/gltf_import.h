/* Between the C++ files that read a glTF model through tinygltf. Everything here runs after
 * check_gltf: types, references and memory extents are known to be right. */
#ifndef RD_GLTF_IMPORT_H
#define RD_GLTF_IMPORT_H

#include "gltf_file.h"
#include "scene.h"

#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace rd
{

struct importer {
    const gltf_file* file;
    const tinygltf::Model* model;
    rd_scene* scene;
    rd_report* report;
};

/* "meshes[3].primitives[1]: reason" under the name of the file; false. */
bool fail(const importer& in, const std::string& where, const std::string& reason);

/* gltf_material.cpp: all materials, the default one last, and the textures that they use. */
bool import_materials(const importer& in);

/* gltf_mesh.cpp: the triangles of one glTF mesh, moved to world space. */
bool import_mesh(const importer& in, int mesh, rd_affine world_from_node);

} // namespace rd

#endif
