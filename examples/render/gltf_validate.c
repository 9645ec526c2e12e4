/* What the schema cannot say: memory extents, accessor use, the node tree, extension names. */
#include "gltf_file.h"

#include "file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An accessor without data is all zeros at no cost to the file: bound what it may ask for. */
#define MAX_DATALESS_COUNT (1u << 22)
#define BUFFER_TYPES       "application/octet-stream|application/gltf-buffer"
#define IMAGE_TYPES        "image/png|image/jpeg"

static const char* const known_extensions[] = {"KHR_lights_punctual",
                                               "KHR_materials_anisotropy",
                                               "KHR_materials_clearcoat",
                                               "KHR_materials_dispersion",
                                               "KHR_materials_emissive_strength",
                                               "KHR_materials_ior",
                                               "KHR_materials_iridescence",
                                               "KHR_materials_sheen",
                                               "KHR_materials_specular",
                                               "KHR_materials_transmission",
                                               "KHR_materials_unlit",
                                               "KHR_materials_variants",
                                               "KHR_materials_volume",
                                               "KHR_mesh_quantization",
                                               "KHR_texture_transform"};

typedef struct checker {
    const rd_gltf_file* file;
    const rd_json* root;
    const rd_json** buffers; /* elements by index, of the arrays that are looked up often */
    const rd_json** views;
    const rd_json** accessors;
    rd_report* report;
} checker;

/* Refers to a member of the element under test: `return refuse(c, "accessors", i, "...")`. */
#define refuse(c, array, i, ...) refuse_at(c, array, (uint32_t)(i), __VA_ARGS__)

static bool RD_PRINTF(4, 5)
    refuse_at(const checker* c, const char* array, uint32_t i, const char* format, ...)
{
    char what[300];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    return rd_fail(c->report, c->file->path, "%s[%u] %s", array, i, what);
}

static const rd_json* elements(const checker* c, const char* array)
{
    const rd_json* a = rd_json_get(c->root, array);
    return a ? a->first : NULL;
}

/* The element that an index member names; the schema check has seen that it exists. */
static const rd_json* referred(const rd_json** table, const rd_json* object, const char* key)
{
    return table[(uint32_t)rd_json_number(object, key, 0)];
}

static bool has(const rd_json* object, const char* key)
{
    return rd_json_get(object, key) != NULL;
}

static bool check_version(const checker* c)
{
    const rd_json* asset = rd_json_get(c->root, "asset");
    const rd_json* version = rd_json_get(asset, "version");
    const rd_json* lowest = rd_json_get(asset, "minVersion");
    if (strncmp(version->string, "2.", 2) != 0) {
        return rd_fail(c->report, c->file->path, "glTF version %.20s, expected 2.x",
                       version->string);
    }
    if (lowest && strcmp(lowest->string, "2.0") != 0) {
        return rd_fail(c->report, c->file->path, "needs glTF %.20s", lowest->string);
    }
    return true;
}

static bool is_known_extension(const char* name)
{
    for (size_t i = 0; i < sizeof known_extensions / sizeof known_extensions[0]; ++i) {
        if (!strcmp(known_extensions[i], name)) {
            return true;
        }
    }
    return false;
}

static bool check_extensions(const checker* c)
{
    for (const rd_json* e = elements(c, "extensionsRequired"); e; e = e->next) {
        if (!is_known_extension(e->string)) {
            return rd_fail(c->report, c->file->path, "requires the unknown extension %.60s",
                           e->string);
        }
    }
    return true;
}

static bool check_external(const checker* c, const char* array, uint32_t i, const char* uri,
                           double needed)
{
    char* path = rd_gltf_uri_path(c->file, uri);
    uint64_t size;
    bool found;
    if (!path) {
        return refuse(c, array, i, "has an unusable URI \"%.80s\"", uri);
    }
    found = rd_file_size(path, &size);
    free(path);
    if (!found) {
        return refuse(c, array, i, "file \"%.160s\" not found", uri);
    }
    if ((double)size < needed) {
        return refuse(c, array, i, "file \"%.160s\" has %llu bytes, %.0f needed", uri,
                      (unsigned long long)size, needed);
    }
    return size <= RD_FILE_MAX ? true : refuse(c, array, i, "file \"%.160s\" is too large", uri);
}

static bool check_uri(const checker* c, const char* array, uint32_t i, const char* uri,
                      const char* types, double needed)
{
    size_t size;
    if (!rd_gltf_is_data_uri(uri)) {
        return check_external(c, array, i, uri, needed);
    }
    if (!rd_gltf_data_uri(uri, types, &size)) {
        return refuse(c, array, i, "has an invalid data URI");
    }
    return (double)size >= needed
               ? true
               : refuse(c, array, i, "data URI holds %zu bytes, %.0f needed", size, needed);
}

static bool check_buffers(const checker* c)
{
    uint32_t i = 0;
    for (const rd_json* b = elements(c, "buffers"); b; b = b->next, ++i) {
        const rd_json* uri = rd_json_get(b, "uri");
        double length = rd_json_number(b, "byteLength", 0);
        if (uri) {
            if (!check_uri(c, "buffers", i, uri->string, BUFFER_TYPES, length)) {
                return false;
            }
        } else if (i != 0 || !c->file->is_binary || !c->file->bin) {
            return refuse(c, "buffers", i, "has no data");
        } else if (length > (double)c->file->bin_size) {
            return refuse(c, "buffers", i, "needs %.0f bytes, the GLB binary chunk has %zu", length,
                          c->file->bin_size);
        }
    }
    return true;
}

static bool check_buffer_views(const checker* c)
{
    uint32_t i = 0;
    for (const rd_json* v = elements(c, "bufferViews"); v; v = v->next, ++i) {
        const rd_json* b = referred(c->buffers, v, "buffer");
        double offset = rd_json_number(v, "byteOffset", 0);
        double length = rd_json_number(v, "byteLength", 0);
        if (offset + length > rd_json_number(b, "byteLength", 0)) {
            return refuse(c, "bufferViews", i, "reaches beyond its buffer");
        }
        if (fmod(rd_json_number(v, "byteStride", 4), 4) != 0) {
            return refuse(c, "bufferViews", i, "has a byteStride that is not a multiple of 4");
        }
    }
    return true;
}

static uint32_t component_size(double component_type)
{
    return component_type < 5122 ? 1 : component_type < 5124 ? 2 : 4;
}

/* Bytes of one element. Matrix columns begin at multiples of 4 bytes. */
static uint32_t element_size(const char* type, uint32_t component)
{
    uint32_t n = (uint32_t)(type[0] == 'S' ? 1 : type[strlen(type) - 1] - '0');
    if (type[0] != 'M') {
        return n * component;
    }
    return n * ((n * component + 3) / 4 * 4);
}

/* `count` elements of `size` bytes, `stride` apart, from `offset` on, lie inside view v. */
static bool check_extent(const checker* c, uint32_t accessor, const rd_json* v, double offset,
                         double count, uint32_t size, double stride, uint32_t component)
{
    double end = offset + stride * (count - 1) + size;
    if (end > rd_json_number(v, "byteLength", 0)) {
        return refuse(c, "accessors", accessor, "reaches beyond its buffer view");
    }
    if (fmod(offset + rd_json_number(v, "byteOffset", 0), component) != 0) {
        return refuse(c, "accessors", accessor, "is not aligned to its component size");
    }
    return true;
}

static bool check_sparse(const checker* c, uint32_t i, const rd_json* a, const rd_json* sparse)
{
    const rd_json* indices = rd_json_get(sparse, "indices");
    const rd_json* values = rd_json_get(sparse, "values");
    const rd_json* index_view = referred(c->views, indices, "bufferView");
    const rd_json* value_view = referred(c->views, values, "bufferView");
    double count = rd_json_number(sparse, "count", 0);
    uint32_t index_size = component_size(rd_json_number(indices, "componentType", 0));
    uint32_t component = component_size(rd_json_number(a, "componentType", 0));
    uint32_t size = element_size(rd_json_get(a, "type")->string, component);
    if (count > rd_json_number(a, "count", 0)) {
        return refuse(c, "accessors", i, "has more sparse values than elements");
    }
    if (has(index_view, "byteStride") || has(value_view, "byteStride")) {
        return refuse(c, "accessors", i, "uses a buffer view with a byteStride for sparse data");
    }
    return check_extent(c, i, index_view, rd_json_number(indices, "byteOffset", 0), count,
                        index_size, index_size, index_size) &&
           check_extent(c, i, value_view, rd_json_number(values, "byteOffset", 0), count, size,
                        size, component);
}

static bool check_accessor(const checker* c, uint32_t i, const rd_json* a)
{
    const rd_json* sparse = rd_json_get(a, "sparse");
    double count = rd_json_number(a, "count", 0);
    uint32_t component = component_size(rd_json_number(a, "componentType", 0));
    uint32_t size = element_size(rd_json_get(a, "type")->string, component);
    if (has(a, "bufferView")) {
        const rd_json* view = referred(c->views, a, "bufferView");
        double stride = rd_json_number(view, "byteStride", size);
        if (stride < size) {
            return refuse(c, "accessors", i, "has elements longer than the byteStride");
        }
        if (!check_extent(c, i, view, rd_json_number(a, "byteOffset", 0), count, size, stride,
                          component)) {
            return false;
        }
    } else if (has(a, "byteOffset")) {
        return refuse(c, "accessors", i, "has a byteOffset but no buffer view");
    } else if (count > MAX_DATALESS_COUNT) {
        return refuse(c, "accessors", i, "asks for %.0f elements without data", count);
    }
    return sparse ? check_sparse(c, i, a, sparse) : true;
}

static bool check_accessors(const checker* c)
{
    uint32_t i = 0;
    for (const rd_json* a = elements(c, "accessors"); a; a = a->next, ++i) {
        if (!check_accessor(c, i, a)) {
            return false;
        }
    }
    return true;
}

static bool check_images(const checker* c)
{
    uint32_t i = 0;
    for (const rd_json* m = elements(c, "images"); m; m = m->next, ++i) {
        const rd_json* uri = rd_json_get(m, "uri");
        if ((uri != NULL) == has(m, "bufferView")) {
            return refuse(c, "images", i, "needs either a uri or a bufferView");
        }
        if (uri && !check_uri(c, "images", i, uri->string, IMAGE_TYPES, 1)) {
            return false;
        }
    }
    i = 0;
    for (const rd_json* t = elements(c, "textures"); t; t = t->next, ++i) {
        if (!has(t, "source")) {
            return refuse(c, "textures", i, "has no image that can be read (PNG or JPEG)");
        }
    }
    return true;
}

/* The component types (as bits from 5120 on) and the element types that an attribute may have. */
typedef struct attribute_rule {
    const char* prefix;
    const char* types;
    uint32_t components, quantized_components;
} attribute_rule;

#define BIT(component_type) (1u << ((component_type)-5120))
static const attribute_rule attribute_rules[] = {
    {"POSITION", "VEC3", BIT(5126), BIT(5126) | BIT(5120) | BIT(5121) | BIT(5122) | BIT(5123)},
    {"NORMAL", "VEC3", BIT(5126), BIT(5126) | BIT(5120) | BIT(5122)},
    {"TANGENT", "VEC4", BIT(5126), BIT(5126) | BIT(5120) | BIT(5122)},
    {"TEXCOORD_", "VEC2", BIT(5126) | BIT(5121) | BIT(5123),
     BIT(5126) | BIT(5120) | BIT(5121) | BIT(5122) | BIT(5123)},
    {"COLOR_", "VEC3|VEC4", BIT(5126) | BIT(5121) | BIT(5123), BIT(5126) | BIT(5121) | BIT(5123)},
};

static bool uses_extension(const checker* c, const char* name)
{
    for (const rd_json* e = elements(c, "extensionsUsed"); e; e = e->next) {
        if (!strcmp(e->string, name)) {
            return true;
        }
    }
    return false;
}

static bool check_attribute(const checker* c, uint32_t mesh, const rd_json* attribute)
{
    const rd_json* a = c->accessors[(uint32_t)attribute->number];
    uint32_t bit = BIT((uint32_t)rd_json_number(a, "componentType", 0));
    bool quantized = uses_extension(c, "KHR_mesh_quantization");
    for (size_t i = 0; i < sizeof attribute_rules / sizeof attribute_rules[0]; ++i) {
        const attribute_rule* rule = &attribute_rules[i];
        if (strncmp(attribute->key, rule->prefix, strlen(rule->prefix)) != 0) {
            continue;
        }
        if (!strstr(rule->types, rd_json_get(a, "type")->string) ||
            !(bit & (quantized ? rule->quantized_components : rule->components))) {
            return refuse(c, "meshes", mesh, "has a %.40s of the wrong type", attribute->key);
        }
    }
    return true;
}

static bool check_indices(const checker* c, uint32_t mesh, const rd_json* primitive)
{
    const rd_json* a;
    double type;
    if (!has(primitive, "indices")) {
        return true;
    }
    a = referred(c->accessors, primitive, "indices");
    type = rd_json_number(a, "componentType", 0);
    if (strcmp(rd_json_get(a, "type")->string, "SCALAR") != 0 ||
        (type != 5121 && type != 5123 && type != 5125)) {
        return refuse(c, "meshes", mesh, "has indices of the wrong type");
    }
    if (has(a, "bufferView") && has(referred(c->views, a, "bufferView"), "byteStride")) {
        return refuse(c, "meshes", mesh, "has indices with a byteStride");
    }
    return true;
}

static bool check_primitive(const checker* c, uint32_t mesh, const rd_json* primitive)
{
    double count = -1;
    if (!check_indices(c, mesh, primitive)) {
        return false;
    }
    for (const rd_json* m = rd_json_get(primitive, "attributes")->first; m; m = m->next) {
        double n = rd_json_number(c->accessors[(uint32_t)m->number], "count", 0);
        if (!check_attribute(c, mesh, m)) {
            return false;
        }
        if (count >= 0 && n != count) {
            return refuse(c, "meshes", mesh, "has attributes of different length");
        }
        count = n;
    }
    return true;
}

static bool check_meshes(const checker* c)
{
    uint32_t i = 0;
    for (const rd_json* m = elements(c, "meshes"); m; m = m->next, ++i) {
        for (const rd_json* p = rd_json_get(m, "primitives")->first; p; p = p->next) {
            if (!check_primitive(c, i, p)) {
                return false;
            }
        }
    }
    return true;
}

static bool check_material(const checker* c, uint32_t i, const rd_json* material)
{
    const rd_json* extensions = rd_json_get(material, "extensions");
    const rd_json* ior = rd_json_get(rd_json_get(extensions, "KHR_materials_ior"), "ior");
    if (ior && ior->number != 0 && ior->number < 1) {
        return refuse(c, "materials", i, "ior is %g, expected 0 or at least 1", ior->number);
    }
    return true;
}

static bool check_materials(const checker* c)
{
    uint32_t i = 0;
    for (const rd_json* m = elements(c, "materials"); m; m = m->next, ++i) {
        if (!check_material(c, i, m)) {
            return false;
        }
    }
    return true;
}

static bool check_cameras(const checker* c)
{
    uint32_t i = 0;
    for (const rd_json* m = elements(c, "cameras"); m; m = m->next, ++i) {
        const char* type = rd_json_get(m, "type")->string;
        const rd_json* lens = rd_json_get(m, type);
        if (!lens) {
            return refuse(c, "cameras", i, "has no \"%s\" member", type);
        }
        if (has(lens, "zfar") &&
            rd_json_number(lens, "zfar", 0) <= rd_json_number(lens, "znear", 0)) {
            return refuse(c, "cameras", i, "has a zfar that is not beyond znear");
        }
    }
    return true;
}

static bool check_lights(const checker* c)
{
    const rd_json* owner = rd_json_get(rd_json_get(c->root, "extensions"), "KHR_lights_punctual");
    const rd_json* lights = rd_json_get(owner, "lights");
    uint32_t i = 0;
    for (const rd_json* l = lights ? lights->first : NULL; l; l = l->next, ++i) {
        const rd_json* spot = rd_json_get(l, "spot");
        double inner = rd_json_number(spot, "innerConeAngle", 0);
        double outer = rd_json_number(spot, "outerConeAngle", 0.785398163397448);
        if (!strcmp(rd_json_get(l, "type")->string, "spot") && !spot) {
            return refuse(c, "lights", i, "is a spot light without \"spot\"");
        }
        if (spot && inner >= outer) {
            return refuse(c, "lights", i, "innerConeAngle %g is not below outerConeAngle %g", inner,
                          outer);
        }
    }
    return true;
}

static bool check_rotation(const checker* c, uint32_t i, const rd_json* node)
{
    const rd_json* q = rd_json_get(node, "rotation");
    double square = 0;
    for (const rd_json* e = q ? q->first : NULL; e; e = e->next) {
        square += e->number * e->number;
    }
    /* A tolerance for exporters that write few digits; a loader normalises what passes. */
    return !q || fabs(square - 1) < 0.02
               ? true
               : refuse(c, "nodes", i, "has a rotation that is not a unit quaternion");
}

/* Every node has at most one parent; then a cycle is a component without a root. */
static bool link_parents(const checker* c, const rd_json* nodes, uint32_t* parent)
{
    uint32_t i = 0;
    for (const rd_json* n = nodes->first; n; n = n->next, ++i) {
        const rd_json* children = rd_json_get(n, "children");
        for (const rd_json* e = children ? children->first : NULL; e; e = e->next) {
            uint32_t child = (uint32_t)e->number;
            if (child == i) {
                return refuse(c, "nodes", i, "is its own child");
            }
            if (parent[child] != UINT32_MAX) {
                return refuse(c, "nodes", child, "has two parents");
            }
            parent[child] = i;
        }
    }
    return true;
}

static bool find_cycle(const checker* c, uint32_t count, const uint32_t* parent, uint32_t* mark)
{
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t n = i;
        while (n != UINT32_MAX && mark[n] == UINT32_MAX) {
            mark[n] = i;
            n = parent[n];
        }
        if (n != UINT32_MAX && mark[n] == i) {
            return refuse(c, "nodes", n, "is part of a cycle");
        }
    }
    return true;
}

static bool check_tree(const checker* c, const rd_json* nodes)
{
    uint32_t* parent = (uint32_t*)malloc((size_t)nodes->count * 2 * sizeof *parent);
    bool ok;
    if (!parent) {
        return rd_fail(c->report, c->file->path, "out of memory");
    }
    memset(parent, 0xff, (size_t)nodes->count * 2 * sizeof *parent);
    ok = link_parents(c, nodes, parent) &&
         find_cycle(c, nodes->count, parent, parent + nodes->count);
    free(parent);
    return ok;
}

static bool check_nodes(const checker* c)
{
    const rd_json* nodes = rd_json_get(c->root, "nodes");
    uint32_t i = 0;
    for (const rd_json* n = nodes ? nodes->first : NULL; n; n = n->next, ++i) {
        bool has_trs = has(n, "translation") || has(n, "rotation") || has(n, "scale");
        if (has(n, "matrix") && has_trs) {
            return refuse(c, "nodes", i, "has a matrix and translation, rotation or scale");
        }
        if (!check_rotation(c, i, n)) {
            return false;
        }
    }
    return !nodes || nodes->count == 0 || check_tree(c, nodes);
}

static const rd_json** make_table(const checker* c, const char* array)
{
    const rd_json* a = rd_json_get(c->root, array);
    const rd_json** table = (const rd_json**)malloc(((a ? a->count : 0) + 1) * sizeof *table);
    uint32_t i = 0;
    for (const rd_json* e = a && table ? a->first : NULL; e; e = e->next) {
        table[i++] = e;
    }
    return table;
}

static bool check_all(checker* c)
{
    c->buffers = make_table(c, "buffers");
    c->views = make_table(c, "bufferViews");
    c->accessors = make_table(c, "accessors");
    if (!c->buffers || !c->views || !c->accessors) {
        return rd_fail(c->report, c->file->path, "out of memory");
    }
    return check_version(c) && check_extensions(c) && check_buffers(c) && check_buffer_views(c) &&
           check_accessors(c) && check_images(c) && check_meshes(c) && check_materials(c) &&
           check_cameras(c) && check_lights(c) && check_nodes(c);
}

bool rd_gltf_validate(const rd_gltf_file* file, rd_report* report)
{
    checker c;
    bool ok;
    if (!rd_gltf_check_schema(file, report)) {
        return false;
    }
    memset(&c, 0, sizeof c);
    c.file = file;
    c.root = file->document.root;
    c.report = report;
    ok = check_all(&c);
    free(c.buffers);
    free(c.views);
    free(c.accessors);
    return ok;
}
