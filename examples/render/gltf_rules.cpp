/* What is checked of a glTF file, as one table: the members of every object that we or tinygltf
 * look at, their types, ranges and references, and the functions that check the rest. Members that
 * the table does not name may be anything. Khronos, "glTF 2.0 Specification", chapter 5, and the
 * KHR extensions named below. Where we are stricter, a comment says why. */
#include "gltf_rules.h"

#include <cfloat>

namespace rd
{
namespace
{

/* The largest integer that a double and every loader hold exactly. */
const double exact = 9007199254740991.0;
/* A factor beyond this is not a colour or distance but a mistake, and overflows when squared. */
const double huge = 1e15;
/* The same for an angle or a texture coordinate. */
const double wide = 1e6;
const double above_zero = DBL_MIN;
const double any = DBL_MAX;
const double half_pi = 1.57079632679489662;

const rule flag = {kind::flag};
const rule text = {kind::text};

rule integer(double low, double high)
{
    return {kind::integer, low, high};
}

rule number(double low, double high)
{
    return {kind::number, low, high};
}

rule one_of(const char* words)
{
    return {kind::word, 0.0, 0.0, words};
}

rule one_of_codes(const char* codes)
{
    return {kind::code, 0.0, 0.0, codes};
}

/* An index into an array, given by its path from the root of the document. */
rule index(const char* array)
{
    return {kind::index, 0.0, 0.0, array};
}

rule object(std::vector<member> members)
{
    /* Every object may have these two. */
    members.push_back({"name", text});
    members.push_back({"extensions", {kind::object}});
    return {kind::object, 0.0, 0.0, "", std::move(members)};
}

rule list(rule element, double fewest = 0.0, double most = any)
{
    return {kind::list, fewest, most, "", {{"", std::move(element)}}};
}

rule numbers(double count, double low, double high)
{
    return list(number(low, high), count, count);
}

/* An object with members of any name. */
rule map(rule element, double fewest = 0.0)
{
    return {kind::map, fewest, any, "", {{"", std::move(element)}}};
}

rule required(rule r)
{
    r.is_required = true;
    return r;
}

rule also(extra_check check, rule r)
{
    r.also = check;
    return r;
}

// clang-format off
const rule texture_info = object({
    {"index", required(index("textures"))},
    {"texCoord", integer(0, 255)},
    {"scale", number(-huge, huge)},
    {"strength", number(0, 1)},
    {"extensions", object({
        {"KHR_texture_transform", object({
            {"offset", numbers(2, -wide, wide)},
            {"rotation", number(-wide, wide)},
            {"scale", numbers(2, -wide, wide)},
            {"texCoord", integer(0, 255)}})}})}});

const rule material = object({
    {"pbrMetallicRoughness", object({
        {"baseColorFactor", numbers(4, 0, 1)},
        {"baseColorTexture", texture_info},
        {"metallicFactor", number(0, 1)},
        {"roughnessFactor", number(0, 1)},
        {"metallicRoughnessTexture", texture_info}})},
    {"normalTexture", texture_info},
    {"occlusionTexture", texture_info},
    {"emissiveTexture", texture_info},
    {"emissiveFactor", numbers(3, 0, 1)},
    {"alphaMode", one_of("OPAQUE|MASK|BLEND")},
    {"alphaCutoff", number(0, huge)},
    {"doubleSided", flag},
    {"extensions", object({
        {"KHR_materials_anisotropy", object({
            {"anisotropyStrength", number(0, 1)},
            {"anisotropyRotation", number(-wide, wide)},
            {"anisotropyTexture", texture_info}})},
        {"KHR_materials_clearcoat", object({
            {"clearcoatFactor", number(0, 1)},
            {"clearcoatTexture", texture_info},
            {"clearcoatRoughnessFactor", number(0, 1)},
            {"clearcoatRoughnessTexture", texture_info},
            {"clearcoatNormalTexture", texture_info}})},
        {"KHR_materials_emissive_strength", object({
            {"emissiveStrength", number(0, huge)}})},
        {"KHR_materials_ior", object({
            {"ior", also(ior_is_possible, number(0, huge))}})},
        {"KHR_materials_iridescence", object({
            {"iridescenceFactor", number(0, 1)},
            {"iridescenceTexture", texture_info},
            {"iridescenceIor", number(1, huge)},
            {"iridescenceThicknessMinimum", number(0, huge)},
            {"iridescenceThicknessMaximum", number(0, huge)},
            {"iridescenceThicknessTexture", texture_info}})},
        {"KHR_materials_sheen", object({
            {"sheenColorFactor", numbers(3, 0, 1)},
            {"sheenColorTexture", texture_info},
            {"sheenRoughnessFactor", number(0, 1)},
            {"sheenRoughnessTexture", texture_info}})},
        {"KHR_materials_specular", object({
            {"specularFactor", number(0, 1)},
            {"specularTexture", texture_info},
            {"specularColorFactor", numbers(3, 0, huge)},
            {"specularColorTexture", texture_info}})},
        {"KHR_materials_transmission", object({
            {"transmissionFactor", number(0, 1)},
            {"transmissionTexture", texture_info}})},
        {"KHR_materials_unlit", object({})},
        {"KHR_materials_volume", object({
            {"thicknessFactor", number(0, huge)},
            {"thicknessTexture", texture_info},
            {"attenuationDistance", number(above_zero, any)},
            {"attenuationColor", numbers(3, 0, 1)}})}})}});

const rule accessor = object({
    {"bufferView", index("bufferViews")},
    {"byteOffset", integer(0, exact)},
    {"componentType", required(one_of_codes("5120|5121|5122|5123|5125|5126"))},
    {"normalized", flag},
    {"count", required(integer(1, exact))},
    {"type", required(one_of("SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"))},
    {"max", list(number(-any, any), 1, 16)},
    {"min", list(number(-any, any), 1, 16)},
    {"sparse", object({
        {"count", required(integer(1, exact))},
        {"indices", required(object({
            {"bufferView", required(index("bufferViews"))},
            {"byteOffset", integer(0, exact)},
            {"componentType", required(one_of_codes("5121|5123|5125"))}}))},
        {"values", required(object({
            {"bufferView", required(index("bufferViews"))},
            {"byteOffset", integer(0, exact)}}))}})}});

const rule primitive = object({
    {"attributes", required(map(index("accessors"), 1))},
    {"indices", index("accessors")},
    {"material", index("materials")},
    {"mode", one_of_codes("0|1|2|3|4|5|6")},
    {"targets", list(map(index("accessors")))}});

const rule light = object({
    {"color", numbers(3, 0, huge)},
    {"intensity", number(0, huge)},
    {"type", required(one_of("directional|point|spot"))},
    {"range", number(above_zero, huge)},
    {"spot", object({
        {"innerConeAngle", number(0, half_pi)},
        /* Exporters round pi / 2 up. */
        {"outerConeAngle", number(0, half_pi + 1e-6)}})}});

const rule node = object({
    {"camera", index("cameras")},
    {"mesh", index("meshes")},
    {"skin", index("skins")},
    {"children", list(index("nodes"))},
    {"matrix", numbers(16, -huge, huge)},
    {"rotation", numbers(4, -1, 1)},
    {"scale", numbers(3, -huge, huge)},
    {"translation", numbers(3, -huge, huge)},
    {"weights", list(number(-any, any))},
    {"extensions", object({
        {"KHR_lights_punctual", object({
            {"light", required(index("extensions/KHR_lights_punctual/lights"))}})}})}});
// clang-format on

} // namespace

// clang-format off
const rule document_rule = object({
    {"asset", required(object({
        /* What a later 2.x cannot do without, it says in minVersion. */
        {"version", required(one_of("2.0|2.1"))},
        {"minVersion", one_of("2.0")},
        {"generator", text},
        {"copyright", text}}))},
    {"extensionsUsed", list(text)},
    /* Those that we read or may ignore. */
    {"extensionsRequired", list(one_of(
        "KHR_lights_punctual|KHR_materials_anisotropy|KHR_materials_clearcoat|"
        "KHR_materials_dispersion|KHR_materials_emissive_strength|KHR_materials_ior|"
        "KHR_materials_iridescence|KHR_materials_sheen|KHR_materials_specular|"
        "KHR_materials_transmission|KHR_materials_unlit|KHR_materials_variants|"
        "KHR_materials_volume|KHR_mesh_quantization|KHR_texture_transform"))},

    {"bufferViews", list(also(view_lies_in_its_buffer, object({
        {"buffer", required(index("buffers"))},
        {"byteOffset", integer(0, exact)},
        {"byteLength", required(integer(1, exact))},
        {"byteStride", integer(4, 252)},
        {"target", one_of_codes("34962|34963")}})))},
    {"accessors", list(also(accessor_lies_in_its_views, accessor))},

    {"samplers", list(object({
        {"magFilter", one_of_codes("9728|9729")},
        {"minFilter", one_of_codes("9728|9729|9984|9985|9986|9987")},
        {"wrapS", one_of_codes("33071|33648|10497")},
        {"wrapT", one_of_codes("33071|33648|10497")}}))},
    {"textures", list(object({
        {"sampler", index("samplers")},
        /* Optional in glTF, for extensions with images of other formats, which we do not read. */
        {"source", required(index("images"))}}))},
    {"materials", list(material)},
    {"meshes", list(object({
        {"primitives", required(list(also(primitive_fits_its_accessors, primitive), 1))},
        {"weights", list(number(-any, any))}}))},

    {"cameras", list(also(camera_has_its_lens, object({
        {"type", required(one_of("perspective|orthographic"))},
        {"perspective", object({
            {"aspectRatio", number(above_zero, any)},
            {"yfov", required(number(1e-6, 2 * half_pi - 1e-6))},
            {"zfar", number(above_zero, any)},
            {"znear", required(number(above_zero, any))}})},
        {"orthographic", object({
            {"xmag", required(number(1e-12, huge))},
            {"ymag", required(number(1e-12, huge))},
            {"zfar", required(number(above_zero, any))},
            {"znear", required(number(0, any))}})}})))},
    {"extensions", object({
        {"KHR_lights_punctual", object({
            {"lights", required(list(also(light_has_its_cone, light)))}})}})},
    {"nodes", also(nodes_form_trees, list(also(node_has_one_transform, node)))},
    {"scene", index("scenes")},
    {"scenes", list(object({{"nodes", list(index("nodes"))}}))},

    {"skins", list(object({
        {"inverseBindMatrices", index("accessors")},
        {"skeleton", index("nodes")},
        {"joints", required(list(index("nodes"), 1))}}))},
    {"animations", list(object({
        {"samplers", required(list(object({
            {"input", required(index("accessors"))},
            {"output", required(index("accessors"))},
            {"interpolation", one_of("LINEAR|STEP|CUBICSPLINE")}})))},
        {"channels", required(list(object({
            {"sampler", required(integer(0, exact))},
            {"target", required(object({
                {"node", index("nodes")},
                {"path", required(text)}}))}})))}}))},

    /* Last, because they look for files. */
    {"buffers", list(also(buffer_has_its_bytes, object({
        {"uri", text},
        {"byteLength", required(integer(1, exact))}})))},
    {"images", list(also(image_has_one_source, object({
        {"uri", text},
        {"mimeType", one_of("image/png|image/jpeg")},
        {"bufferView", index("bufferViews")}})))}});

const std::vector<attribute_rule> attribute_rules = {
    {"POSITION", "VEC3", "5126", "5120|5121|5122|5123|5126"},
    {"NORMAL", "VEC3", "5126", "5120|5122|5126"},
    {"TANGENT", "VEC4", "5126", "5120|5122|5126"},
    {"TEXCOORD_", "VEC2", "5121|5123|5126", "5120|5121|5122|5123|5126"},
    {"COLOR_", "VEC3|VEC4", "5121|5123|5126", "5121|5123|5126"},
};
// clang-format on

} // namespace rd
