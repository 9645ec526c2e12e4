/* The glTF 2.0 JSON schema as tables: which members exist, their types, ranges and references.
 * Khronos, "glTF 2.0 Specification", chapter 5, and the KHR extensions named below. */
#include "gltf_file.h"

#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

typedef enum kind { K_ANY, K_BOOL, K_INT, K_NUMBER, K_STRING, K_OBJECT, K_INDEX, K_ENUM } kind;

enum { OPTIONAL = 0, REQUIRED = 1, LIST = 2, MAP = 4 };

typedef struct field {
    const char* name;
    kind type;
    int flags;             /* LIST: an array of the type; MAP: an object of values of the type */
    double low, high;      /* of numbers */
    uint32_t fewest, most; /* of list elements */
    const void* detail;    /* K_OBJECT: its fields; K_INDEX: root array; K_ENUM: "a|b" */
} field;

#define ANY_COUNT 0, UINT32_MAX
#define COUNT(n)  n, n
#define END                                                                                        \
    {                                                                                              \
        NULL, K_ANY, 0, 0, 0, 0, 0, NULL                                                           \
    }
#define BOOL(n)                                                                                    \
    {                                                                                              \
        n, K_BOOL, OPTIONAL, 0, 0, ANY_COUNT, NULL                                                 \
    }
#define INT(n, fl, lo, hi)                                                                         \
    {                                                                                              \
        n, K_INT, fl, lo, hi, ANY_COUNT, NULL                                                      \
    }
#define NUM(n, fl, lo, hi)                                                                         \
    {                                                                                              \
        n, K_NUMBER, fl, lo, hi, ANY_COUNT, NULL                                                   \
    }
#define NUMS(n, size, lo, hi)                                                                      \
    {                                                                                              \
        n, K_NUMBER, LIST, lo, hi, size, NULL                                                      \
    }
#define STR(n, fl)                                                                                 \
    {                                                                                              \
        n, K_STRING, fl, 0, 0, ANY_COUNT, NULL                                                     \
    }
#define OBJ(n, fl, fields)                                                                         \
    {                                                                                              \
        n, K_OBJECT, fl, 0, 0, ANY_COUNT, fields                                                   \
    }
#define INDEX(n, fl, array)                                                                        \
    {                                                                                              \
        n, K_INDEX, fl, 0, 0, ANY_COUNT, array                                                     \
    }
#define ENUM(n, fl, words)                                                                         \
    {                                                                                              \
        n, K_ENUM, fl, 0, 0, ANY_COUNT, words                                                      \
    }
#define NAME STR("name", OPTIONAL)

/* The largest integer that a double and every loader hold exactly. */
#define INT_HIGH 9007199254740991.0
/* A factor beyond this is not a colour or distance but a mistake, and overflows when squared. */
#define FACTOR_HIGH 1e15

static const field no_fields[] = {END};

static const field transform_fields[] = {
    NUMS("offset", COUNT(2), -1e6, 1e6), NUM("rotation", 0, -1e6, 1e6),
    NUMS("scale", COUNT(2), -1e6, 1e6), INT("texCoord", 0, 0, 255), END};
static const field texture_info_extensions[] = {OBJ("KHR_texture_transform", 0, transform_fields),
                                                END};
static const field texture_info[] = {
    INDEX("index", REQUIRED, "textures"),          INT("texCoord", 0, 0, 255),
    NUM("scale", 0, -FACTOR_HIGH, FACTOR_HIGH),    NUM("strength", 0, 0, 1),
    OBJ("extensions", 0, texture_info_extensions), END};

static const field clearcoat_fields[] = {NUM("clearcoatFactor", 0, 0, 1),
                                         OBJ("clearcoatTexture", 0, texture_info),
                                         NUM("clearcoatRoughnessFactor", 0, 0, 1),
                                         OBJ("clearcoatRoughnessTexture", 0, texture_info),
                                         OBJ("clearcoatNormalTexture", 0, texture_info),
                                         END};
static const field anisotropy_fields[] = {NUM("anisotropyStrength", 0, 0, 1),
                                          NUM("anisotropyRotation", 0, -1e6, 1e6),
                                          OBJ("anisotropyTexture", 0, texture_info), END};
static const field iridescence_fields[] = {NUM("iridescenceFactor", 0, 0, 1),
                                           OBJ("iridescenceTexture", 0, texture_info),
                                           NUM("iridescenceIor", 0, 1, FACTOR_HIGH),
                                           NUM("iridescenceThicknessMinimum", 0, 0, FACTOR_HIGH),
                                           NUM("iridescenceThicknessMaximum", 0, 0, FACTOR_HIGH),
                                           OBJ("iridescenceThicknessTexture", 0, texture_info),
                                           END};
static const field specular_fields[] = {NUM("specularFactor", 0, 0, 1),
                                        OBJ("specularTexture", 0, texture_info),
                                        NUMS("specularColorFactor", COUNT(3), 0, FACTOR_HIGH),
                                        OBJ("specularColorTexture", 0, texture_info), END};
/* 0 is allowed: the extension gives it the meaning of an infinite IOR. Checked further there. */
static const field ior_fields[] = {NUM("ior", 0, 0, FACTOR_HIGH), END};
static const field emissive_strength_fields[] = {NUM("emissiveStrength", 0, 0, FACTOR_HIGH), END};
static const field transmission_fields[] = {NUM("transmissionFactor", 0, 0, 1),
                                            OBJ("transmissionTexture", 0, texture_info), END};
static const field volume_fields[] = {
    NUM("thicknessFactor", 0, 0, FACTOR_HIGH), OBJ("thicknessTexture", 0, texture_info),
    NUM("attenuationDistance", 0, DBL_MIN, DBL_MAX), NUMS("attenuationColor", COUNT(3), 0, 1), END};
static const field sheen_fields[] = {
    NUMS("sheenColorFactor", COUNT(3), 0, 1), OBJ("sheenColorTexture", 0, texture_info),
    NUM("sheenRoughnessFactor", 0, 0, 1), OBJ("sheenRoughnessTexture", 0, texture_info), END};
static const field material_extensions[] = {
    OBJ("KHR_materials_clearcoat", 0, clearcoat_fields),
    OBJ("KHR_materials_anisotropy", 0, anisotropy_fields),
    OBJ("KHR_materials_iridescence", 0, iridescence_fields),
    OBJ("KHR_materials_specular", 0, specular_fields),
    OBJ("KHR_materials_ior", 0, ior_fields),
    OBJ("KHR_materials_emissive_strength", 0, emissive_strength_fields),
    OBJ("KHR_materials_transmission", 0, transmission_fields),
    OBJ("KHR_materials_volume", 0, volume_fields),
    OBJ("KHR_materials_sheen", 0, sheen_fields),
    OBJ("KHR_materials_unlit", 0, no_fields),
    END};
static const field pbr_fields[] = {NUMS("baseColorFactor", COUNT(4), 0, 1),
                                   OBJ("baseColorTexture", 0, texture_info),
                                   NUM("metallicFactor", 0, 0, 1),
                                   NUM("roughnessFactor", 0, 0, 1),
                                   OBJ("metallicRoughnessTexture", 0, texture_info),
                                   END};
static const field material_fields[] = {NAME,
                                        OBJ("pbrMetallicRoughness", 0, pbr_fields),
                                        OBJ("normalTexture", 0, texture_info),
                                        OBJ("occlusionTexture", 0, texture_info),
                                        OBJ("emissiveTexture", 0, texture_info),
                                        NUMS("emissiveFactor", COUNT(3), 0, 1),
                                        ENUM("alphaMode", 0, "OPAQUE|MASK|BLEND"),
                                        NUM("alphaCutoff", 0, 0, FACTOR_HIGH),
                                        BOOL("doubleSided"),
                                        OBJ("extensions", 0, material_extensions),
                                        END};

static const field sparse_indices[] = {INDEX("bufferView", REQUIRED, "bufferViews"),
                                       INT("byteOffset", 0, 0, INT_HIGH),
                                       ENUM("componentType", REQUIRED, "5121|5123|5125"), END};
static const field sparse_values[] = {INDEX("bufferView", REQUIRED, "bufferViews"),
                                      INT("byteOffset", 0, 0, INT_HIGH), END};
static const field sparse_fields[] = {INT("count", REQUIRED, 1, INT_HIGH),
                                      OBJ("indices", REQUIRED, sparse_indices),
                                      OBJ("values", REQUIRED, sparse_values), END};
static const field accessor_fields[] = {
    NAME,
    INDEX("bufferView", 0, "bufferViews"),
    INT("byteOffset", 0, 0, INT_HIGH),
    ENUM("componentType", REQUIRED, "5120|5121|5122|5123|5125|5126"),
    BOOL("normalized"),
    INT("count", REQUIRED, 1, INT_HIGH),
    ENUM("type", REQUIRED, "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"),
    {"max", K_NUMBER, LIST, -DBL_MAX, DBL_MAX, 1, 16, NULL},
    {"min", K_NUMBER, LIST, -DBL_MAX, DBL_MAX, 1, 16, NULL},
    OBJ("sparse", 0, sparse_fields),
    END};
static const field buffer_fields[] = {NAME, STR("uri", 0), INT("byteLength", REQUIRED, 1, INT_HIGH),
                                      END};
static const field buffer_view_fields[] = {NAME,
                                           INDEX("buffer", REQUIRED, "buffers"),
                                           INT("byteOffset", 0, 0, INT_HIGH),
                                           INT("byteLength", REQUIRED, 1, INT_HIGH),
                                           INT("byteStride", 0, 4, 252),
                                           ENUM("target", 0, "34962|34963"),
                                           END};

static const field primitive_fields[] = {
    {"attributes", K_INDEX, REQUIRED | MAP, 0, 0, 1, UINT32_MAX, "accessors"},
    INDEX("indices", 0, "accessors"),
    INDEX("material", 0, "materials"),
    ENUM("mode", 0, "0|1|2|3|4|5|6"),
    {"targets", K_INDEX, LIST | MAP, 0, 0, ANY_COUNT, "accessors"},
    END};
static const field mesh_fields[] = {
    NAME,
    {"primitives", K_OBJECT, REQUIRED | LIST, 0, 0, 1, UINT32_MAX, primitive_fields},
    {"weights", K_NUMBER, LIST, -DBL_MAX, DBL_MAX, ANY_COUNT, NULL},
    END};

static const field node_light_fields[] = {INDEX("light", REQUIRED, "lights"), END};
static const field node_extensions[] = {OBJ("KHR_lights_punctual", 0, node_light_fields), END};
static const field node_fields[] = {NAME,
                                    INDEX("camera", 0, "cameras"),
                                    INDEX("mesh", 0, "meshes"),
                                    INDEX("skin", 0, "skins"),
                                    INDEX("children", LIST, "nodes"),
                                    NUMS("matrix", COUNT(16), -FACTOR_HIGH, FACTOR_HIGH),
                                    NUMS("rotation", COUNT(4), -1, 1),
                                    NUMS("scale", COUNT(3), -FACTOR_HIGH, FACTOR_HIGH),
                                    NUMS("translation", COUNT(3), -FACTOR_HIGH, FACTOR_HIGH),
                                    {"weights", K_NUMBER, LIST, -DBL_MAX, DBL_MAX, ANY_COUNT, NULL},
                                    OBJ("extensions", 0, node_extensions),
                                    END};
static const field scene_fields[] = {NAME, INDEX("nodes", LIST, "nodes"), END};
static const field skin_fields[] = {
    NAME,
    INDEX("inverseBindMatrices", 0, "accessors"),
    INDEX("skeleton", 0, "nodes"),
    {"joints", K_INDEX, REQUIRED | LIST, 0, 0, 1, UINT32_MAX, "nodes"},
    END};

static const field perspective_fields[] = {
    NUM("aspectRatio", 0, DBL_MIN, DBL_MAX), NUM("yfov", REQUIRED, 1e-6, PI - 1e-6),
    NUM("zfar", 0, DBL_MIN, DBL_MAX), NUM("znear", REQUIRED, DBL_MIN, DBL_MAX), END};
static const field orthographic_fields[] = {
    NUM("xmag", REQUIRED, 1e-12, FACTOR_HIGH), NUM("ymag", REQUIRED, 1e-12, FACTOR_HIGH),
    NUM("zfar", REQUIRED, DBL_MIN, DBL_MAX), NUM("znear", REQUIRED, 0, DBL_MAX), END};
static const field camera_fields[] = {NAME, ENUM("type", REQUIRED, "perspective|orthographic"),
                                      OBJ("perspective", 0, perspective_fields),
                                      OBJ("orthographic", 0, orthographic_fields), END};

static const field image_fields[] = {NAME, STR("uri", 0),
                                     ENUM("mimeType", 0, "image/png|image/jpeg"),
                                     INDEX("bufferView", 0, "bufferViews"), END};
static const field sampler_fields[] = {NAME,
                                       ENUM("magFilter", 0, "9728|9729"),
                                       ENUM("minFilter", 0, "9728|9729|9984|9985|9986|9987"),
                                       ENUM("wrapS", 0, "33071|33648|10497"),
                                       ENUM("wrapT", 0, "33071|33648|10497"),
                                       END};
static const field texture_fields[] = {NAME, INDEX("sampler", 0, "samplers"),
                                       INDEX("source", 0, "images"), END};

static const field channel_target_fields[] = {INDEX("node", 0, "nodes"), STR("path", REQUIRED),
                                              END};
static const field channel_fields[] = {INT("sampler", REQUIRED, 0, INT_HIGH),
                                       OBJ("target", REQUIRED, channel_target_fields), END};
static const field animation_sampler_fields[] = {
    INDEX("input", REQUIRED, "accessors"), INDEX("output", REQUIRED, "accessors"),
    ENUM("interpolation", 0, "LINEAR|STEP|CUBICSPLINE"), END};
static const field animation_fields[] = {NAME, OBJ("channels", REQUIRED | LIST, channel_fields),
                                         OBJ("samplers", REQUIRED | LIST, animation_sampler_fields),
                                         END};

static const field spot_fields[] = {NUM("innerConeAngle", 0, 0, PI / 2),
                                    NUM("outerConeAngle", 0, 0, PI / 2 + 1e-6), END};
static const field light_fields[] = {NAME,
                                     NUMS("color", COUNT(3), 0, FACTOR_HIGH),
                                     NUM("intensity", 0, 0, FACTOR_HIGH),
                                     ENUM("type", REQUIRED, "directional|point|spot"),
                                     NUM("range", 0, DBL_MIN, FACTOR_HIGH),
                                     OBJ("spot", 0, spot_fields),
                                     END};
static const field root_lights_fields[] = {OBJ("lights", REQUIRED | LIST, light_fields), END};
static const field root_extensions[] = {OBJ("KHR_lights_punctual", 0, root_lights_fields), END};

static const field asset_fields[] = {STR("version", REQUIRED), STR("minVersion", 0),
                                     STR("generator", 0), STR("copyright", 0), END};
static const field root_fields[] = {OBJ("asset", REQUIRED, asset_fields),
                                    STR("extensionsUsed", LIST),
                                    STR("extensionsRequired", LIST),
                                    INDEX("scene", 0, "scenes"),
                                    OBJ("accessors", LIST, accessor_fields),
                                    OBJ("animations", LIST, animation_fields),
                                    OBJ("bufferViews", LIST, buffer_view_fields),
                                    OBJ("buffers", LIST, buffer_fields),
                                    OBJ("cameras", LIST, camera_fields),
                                    OBJ("images", LIST, image_fields),
                                    OBJ("materials", LIST, material_fields),
                                    OBJ("meshes", LIST, mesh_fields),
                                    OBJ("nodes", LIST, node_fields),
                                    OBJ("samplers", LIST, sampler_fields),
                                    OBJ("scenes", LIST, scene_fields),
                                    OBJ("skins", LIST, skin_fields),
                                    OBJ("textures", LIST, texture_fields),
                                    OBJ("extensions", 0, root_extensions),
                                    END};

#define WHERE_MAX 200

typedef struct checker {
    const rd_gltf_file* file;
    rd_report* report;
    char where[WHERE_MAX]; /* path of the value under test, for messages */
    size_t length;
} checker;

static bool RD_PRINTF(2, 3) refuse(checker* c, const char* format, ...)
{
    char what[200];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    return rd_fail(c->report, c->file->path, "%s %s", c->length ? c->where : "root", what);
}

static size_t RD_PRINTF(2, 3) enter(checker* c, const char* format, ...)
{
    size_t before = c->length;
    va_list args;
    int n;
    va_start(args, format);
    n = vsnprintf(c->where + c->length, WHERE_MAX - c->length, format, args);
    va_end(args);
    c->length += n > 0 ? (size_t)n : 0;
    c->length = c->length < WHERE_MAX ? c->length : WHERE_MAX - 1;
    return before;
}

static void leave(checker* c, size_t before)
{
    c->length = before;
    c->where[before] = '\0';
}

static const rd_json* root_array(const rd_gltf_file* file, const char* name)
{
    const rd_json* owner = file->document.root;
    if (!strcmp(name, "lights")) {
        owner = rd_json_get(rd_json_get(owner, "extensions"), "KHR_lights_punctual");
    }
    return rd_json_get(owner, name);
}

static bool is_word_of(const char* words, const char* word)
{
    size_t length = strlen(word);
    for (const char* at = words; at; at = strchr(at, '|')) {
        at += *at == '|';
        if (!strncmp(at, word, length) && (at[length] == '|' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

static bool check_enum(checker* c, const rd_json* v, const char* words)
{
    char digits[32];
    const char* word = v->string;
    bool wants_number = words[0] >= '0' && words[0] <= '9';
    if (v->type != (wants_number ? RD_JSON_NUMBER : RD_JSON_STRING)) {
        return refuse(c, "is not %s", wants_number ? "an integer" : "a string");
    }
    if (wants_number) {
        snprintf(digits, sizeof digits, "%.17g", v->number);
        word = digits;
    }
    if (!word[0] || strchr(word, '|') || !is_word_of(words, word)) {
        return refuse(c, "is %.40s, expected one of %s", word, words);
    }
    return true;
}

static bool check_number(checker* c, const rd_json* v, const field* f)
{
    if (v->type != RD_JSON_NUMBER) {
        return refuse(c, "is not a number");
    }
    if (f->type == K_INT && !v->is_integer) {
        return refuse(c, "is not an integer");
    }
    if (v->number < f->low || v->number > f->high) {
        return refuse(c, "is %g, outside [%g, %g]", v->number, f->low, f->high);
    }
    return true;
}

static bool check_index(checker* c, const rd_json* v, const char* array_name)
{
    const rd_json* array = root_array(c->file, array_name);
    uint32_t count = array ? array->count : 0;
    if (v->type != RD_JSON_NUMBER || !v->is_integer || v->number < 0) {
        return refuse(c, "is not an index");
    }
    if (v->number >= (double)count) {
        return refuse(c, "is %.0f, but %s has %u elements", v->number, array_name, count);
    }
    return true;
}

static bool check_object(checker* c, const rd_json* v, const field* fields);

static bool check_single(checker* c, const rd_json* v, const field* f)
{
    switch (f->type) {
    case K_BOOL:
        return v->type == RD_JSON_BOOL ? true : refuse(c, "is not true or false");
    case K_INT:
    case K_NUMBER:
        return check_number(c, v, f);
    case K_STRING:
        return v->type == RD_JSON_STRING ? true : refuse(c, "is not a string");
    case K_OBJECT:
        return check_object(c, v, (const field*)f->detail);
    case K_INDEX:
        return check_index(c, v, (const char*)f->detail);
    case K_ENUM:
        return check_enum(c, v, (const char*)f->detail);
    case K_ANY:
        break;
    }
    return true;
}

static bool check_map(checker* c, const rd_json* v, const field* f)
{
    if (v->type != RD_JSON_OBJECT) {
        return refuse(c, "is not an object");
    }
    if (v->count < f->fewest) {
        return refuse(c, "is empty");
    }
    for (const rd_json* m = v->first; m; m = m->next) {
        size_t before = enter(c, ".%.40s", m->key);
        if (!check_single(c, m, f)) {
            return false;
        }
        leave(c, before);
    }
    return true;
}

static bool check_list(checker* c, const rd_json* v, const field* f)
{
    uint32_t i = 0;
    if (v->type != RD_JSON_ARRAY) {
        return refuse(c, "is not an array");
    }
    if (v->count < f->fewest || v->count > f->most) {
        return refuse(c, "has %u elements", v->count);
    }
    for (const rd_json* e = v->first; e; e = e->next, ++i) {
        size_t before = enter(c, "[%u]", i);
        if (!(f->flags & MAP ? check_map(c, e, f) : check_single(c, e, f))) {
            return false;
        }
        leave(c, before);
    }
    return true;
}

static bool check_field(checker* c, const rd_json* object, const field* f)
{
    const rd_json* v = rd_json_get(object, f->name);
    size_t before = enter(c, "%s%s", c->length ? "." : "", f->name);
    bool ok = true;
    if (!v) {
        ok = f->flags & REQUIRED ? refuse(c, "is missing") : true;
    } else if (f->flags & LIST) {
        ok = check_list(c, v, f);
    } else {
        ok = f->flags & MAP ? check_map(c, v, f) : check_single(c, v, f);
    }
    leave(c, before);
    return ok;
}

static bool check_object(checker* c, const rd_json* v, const field* fields)
{
    if (v->type != RD_JSON_OBJECT) {
        return refuse(c, "is not an object");
    }
    for (const field* f = fields; f->name; ++f) {
        if (!check_field(c, v, f)) {
            return false;
        }
    }
    return true;
}

/* Loaders copy every "extensions" object, known or not: it has to be an object of objects. */
static bool check_extensions(checker* c, const rd_json* v)
{
    for (const rd_json* m = v->first; m; m = m->next) {
        if (m->key && !strcmp(m->key, "extensions") && m->type != RD_JSON_OBJECT) {
            return refuse(c, "has \"extensions\" that are not an object");
        }
        if ((!m->key || strcmp(m->key, "extras") != 0) && !check_extensions(c, m)) {
            return false;
        }
    }
    return true;
}

bool rd_gltf_check_schema(const rd_gltf_file* file, rd_report* report)
{
    checker c;
    memset(&c, 0, sizeof c);
    c.file = file;
    c.report = report;
    return check_object(&c, file->document.root, root_fields) &&
           check_extensions(&c, file->document.root);
}
