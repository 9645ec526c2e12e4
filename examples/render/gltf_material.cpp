/* glTF materials and textures. Extensions: Khronos, "KHR_materials_*" and "KHR_texture_transform". */
#include "gltf_import.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace rd
{
namespace
{

using tinygltf::ExtensionMap;
using tinygltf::Material;
using tinygltf::Value;

/* The textures made so far: glTF textures that show the same image in the same way share one. */
struct texture_key {
    int image, sampler;
    bool is_srgb, is_normal;
    bool operator==(const texture_key& o) const
    {
        return image == o.image && sampler == o.sampler && is_srgb == o.is_srgb &&
               is_normal == o.is_normal;
    }
};

struct material_importer {
    const importer* in;
    std::vector<texture_key> keys;
    std::vector<rd_texture> textures;
    bool warned_of_sheen;
};

double number(const Value& object, const char* name, double fallback)
{
    return object.IsObject() && object.Has(name) ? object.Get(name).GetNumberAsDouble() : fallback;
}

float number_f(const Value& object, const char* name, float fallback)
{
    return float(number(object, name, double(fallback)));
}

hdrp_v3 color(const Value& object, const char* name, hdrp_v3 fallback)
{
    if (!object.IsObject() || !object.Has(name)) {
        return fallback;
    }
    const Value& c = object.Get(name);
    return hdrp_v3_make(float(c.Get(0).GetNumberAsDouble()), float(c.Get(1).GetNumberAsDouble()),
                        float(c.Get(2).GetNumberAsDouble()));
}

double pair_element(const Value& object, const char* name, int i, double fallback)
{
    return object.Has(name) ? object.Get(name).Get(i).GetNumberAsDouble() : fallback;
}

rd_wrap wrap_from(int mode)
{
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? RD_WRAP_CLAMP
           : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? RD_WRAP_MIRROR
                                                           : RD_WRAP_REPEAT;
}

char* copy_text(const std::string& text)
{
    char* out = static_cast<char*>(std::malloc(text.size() + 1));
    if (out) {
        std::memcpy(out, text.c_str(), text.size() + 1);
    }
    return out;
}

/* Copies the compressed bytes of an image out of the model. */
void set_encoded(const importer& in, int index, rd_texture* t)
{
    const tinygltf::Image& image = in.model->images[size_t(index)];
    const unsigned char* bytes = image.image.data();
    size_t size = image.image.size();
    if (image.bufferView >= 0) {
        const tinygltf::BufferView& v = in.model->bufferViews[size_t(image.bufferView)];
        bytes = in.model->buffers[size_t(v.buffer)].data.data() + v.byteOffset;
        size = v.byteLength;
    }
    const std::string what = image.uri.empty() || image.uri.compare(0, 5, "data:") == 0
                                 ? "images[" + std::to_string(index) + "]"
                                 : image.uri;
    t->name = copy_text(std::string(in.file->path) + ": " + what);
    t->encoded = static_cast<unsigned char*>(std::malloc(size ? size : 1));
    if (!t->name || !t->encoded) {
        throw std::bad_alloc();
    }
    std::memcpy(t->encoded, bytes, size);
    t->encoded_size = size;
}

int add_texture(material_importer& m, const texture_key& key)
{
    for (size_t i = 0; i < m.keys.size(); ++i) {
        if (m.keys[i] == key) {
            return int(i);
        }
    }
    m.keys.push_back(key);
    m.textures.push_back(rd_texture());
    rd_texture& t = m.textures.back();
    std::memset(&t, 0, sizeof t);
    t.is_srgb = key.is_srgb;
    t.is_normal = key.is_normal;
    if (key.sampler >= 0) {
        const tinygltf::Sampler& s = m.in->model->samplers[size_t(key.sampler)];
        t.wrap_u = wrap_from(s.wrapS);
        t.wrap_v = wrap_from(s.wrapT);
        t.is_nearest = s.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    set_encoded(*m.in, key.image, &t);
    return int(m.keys.size()) - 1;
}

void set_transform(rd_texture_slot* slot, const Value& transform)
{
    const double angle = number(transform, "rotation", 0.0);
    const double c = std::cos(angle), s = std::sin(angle);
    const double sx = pair_element(transform, "scale", 0, 1.0);
    const double sy = pair_element(transform, "scale", 1, 1.0);
    slot->u_row = hdrp_v3_make(float(c * sx), float(s * sy),
                               float(pair_element(transform, "offset", 0, 0.0)));
    slot->v_row = hdrp_v3_make(float(-s * sx), float(c * sy),
                               float(pair_element(transform, "offset", 1, 0.0)));
    slot->uv_set = int(number(transform, "texCoord", slot->uv_set));
}

bool is_color_slot(rd_slot slot)
{
    return slot == RD_SLOT_BASE_COLOR || slot == RD_SLOT_EMISSIVE || slot == RD_SLOT_SPECULAR_COLOR;
}

void set_slot(material_importer& m, rd_material* to, rd_slot slot, int texture, int uv_set,
              const Value& transform)
{
    if (texture < 0) {
        return;
    }
    const tinygltf::Texture& t = m.in->model->textures[size_t(texture)];
    const bool is_normal = slot == RD_SLOT_NORMAL || slot == RD_SLOT_COAT_NORMAL;
    const texture_key key = {t.source, t.sampler, is_color_slot(slot), is_normal};
    rd_texture_slot* s = &to->slot[slot];
    *s = rd_texture_slot_make(add_texture(m, key));
    s->uv_set = uv_set;
    if (transform.IsObject()) {
        set_transform(s, transform);
    }
}

template <class Info>
void set_slot(material_importer& m, rd_material* to, rd_slot slot, const Info& i)
{
    const auto found = i.extensions.find("KHR_texture_transform");
    set_slot(m, to, slot, i.index, i.texCoord,
             found == i.extensions.end() ? Value() : found->second);
}

/* A texture info inside an extension, which tinygltf hands over as plain values. */
void set_slot(material_importer& m, rd_material* to, rd_slot slot, const Value& owner,
              const char* name)
{
    if (!owner.Has(name)) {
        return;
    }
    const Value& i = owner.Get(name);
    Value transform;
    if (i.Has("extensions") && i.Get("extensions").Has("KHR_texture_transform")) {
        transform = i.Get("extensions").Get("KHR_texture_transform");
    }
    set_slot(m, to, slot, int(number(i, "index", -1.0)), int(number(i, "texCoord", 0.0)),
             transform);
}

void read_core(material_importer& m, const Material& from, rd_material* to)
{
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    const std::vector<double>& c = pbr.baseColorFactor;
    std::snprintf(to->name, RD_NAME_MAX, "%s", from.name.c_str());
    to->base_color = hdrp_v3_make(float(c[0]), float(c[1]), float(c[2]));
    to->alpha = float(c[3]);
    to->metallic = float(pbr.metallicFactor);
    to->perceptual_roughness = float(pbr.roughnessFactor);
    to->normal_scale = float(from.normalTexture.scale);
    to->occlusion_strength = float(from.occlusionTexture.strength);
    to->double_sided = from.doubleSided;
    to->alpha_cutoff = float(from.alphaCutoff);
    to->alpha_mode = from.alphaMode == "MASK"    ? RD_ALPHA_MASK
                     : from.alphaMode == "BLEND" ? RD_ALPHA_BLEND
                                                 : RD_ALPHA_OPAQUE;
    if (from.emissiveFactor.size() == 3) {
        to->emission_nits =
            hdrp_v3_make(float(from.emissiveFactor[0]), float(from.emissiveFactor[1]),
                         float(from.emissiveFactor[2]));
    }
    set_slot(m, to, RD_SLOT_BASE_COLOR, pbr.baseColorTexture);
    set_slot(m, to, RD_SLOT_METALLIC_ROUGHNESS, pbr.metallicRoughnessTexture);
    set_slot(m, to, RD_SLOT_NORMAL, from.normalTexture);
    set_slot(m, to, RD_SLOT_OCCLUSION, from.occlusionTexture);
    set_slot(m, to, RD_SLOT_EMISSIVE, from.emissiveTexture);
}

void read_coat(material_importer& m, const Value& e, rd_material* to)
{
    to->coat = number_f(e, "clearcoatFactor", 0.0f);
    to->coat_perceptual_roughness = number_f(e, "clearcoatRoughnessFactor", 0.0f);
    set_slot(m, to, RD_SLOT_COAT, e, "clearcoatTexture");
    set_slot(m, to, RD_SLOT_COAT_ROUGHNESS, e, "clearcoatRoughnessTexture");
    set_slot(m, to, RD_SLOT_COAT_NORMAL, e, "clearcoatNormalTexture");
    if (e.Has("clearcoatNormalTexture")) {
        to->coat_normal_scale = number_f(e.Get("clearcoatNormalTexture"), "scale", 1.0f);
    }
}

void read_anisotropy(material_importer& m, const Value& e, rd_material* to)
{
    to->anisotropy = number_f(e, "anisotropyStrength", 0.0f);
    to->anisotropy_rotation_rad = number_f(e, "anisotropyRotation", 0.0f);
    set_slot(m, to, RD_SLOT_ANISOTROPY, e, "anisotropyTexture");
}

void read_iridescence(material_importer& m, const Value& e, rd_material* to)
{
    to->film = number_f(e, "iridescenceFactor", 0.0f);
    to->film_ior = number_f(e, "iridescenceIor", to->film_ior);
    to->film_thickness_min_nm =
        number_f(e, "iridescenceThicknessMinimum", to->film_thickness_min_nm);
    to->film_thickness_max_nm =
        number_f(e, "iridescenceThicknessMaximum", to->film_thickness_max_nm);
    set_slot(m, to, RD_SLOT_FILM, e, "iridescenceTexture");
    set_slot(m, to, RD_SLOT_FILM_THICKNESS, e, "iridescenceThicknessTexture");
}

void read_specular(material_importer& m, const Value& e, rd_material* to)
{
    to->specular = number_f(e, "specularFactor", 1.0f);
    to->specular_color = color(e, "specularColorFactor", to->specular_color);
    set_slot(m, to, RD_SLOT_SPECULAR, e, "specularTexture");
    set_slot(m, to, RD_SLOT_SPECULAR_COLOR, e, "specularColorTexture");
}

void read_transmission(material_importer& m, const Value& e, rd_material* to)
{
    to->transmission = number_f(e, "transmissionFactor", 0.0f);
    set_slot(m, to, RD_SLOT_TRANSMISSION, e, "transmissionTexture");
}

void read_volume(material_importer& m, const Value& e, rd_material* to)
{
    const double distance = number(e, "attenuationDistance", double(HDRP_FLT_MAX));
    to->thickness = number_f(e, "thicknessFactor", 0.0f);
    to->attenuation_distance_m = float(std::fmin(distance, double(HDRP_FLT_MAX)));
    to->attenuation_color = color(e, "attenuationColor", to->attenuation_color);
    set_slot(m, to, RD_SLOT_THICKNESS, e, "thicknessTexture");
}

void read_emissive_strength(material_importer&, const Value& e, rd_material* to)
{
    to->emission_nits = hdrp_v3_scale(to->emission_nits, number_f(e, "emissiveStrength", 1.0f));
}

void read_ior(material_importer&, const Value& e, rd_material* to)
{
    to->ior = number_f(e, "ior", 1.5f);
}

void read_unlit(material_importer&, const Value&, rd_material* to)
{
    to->unlit = true;
}

void warn_of_sheen(material_importer& m, const Value&, rd_material*)
{
    if (!m.warned_of_sheen) {
        rd_warn(m.in->report, m.in->file->path, "KHR_materials_sheen is ignored");
        m.warned_of_sheen = true;
    }
}

const struct {
    const char* name;
    void (*read)(material_importer&, const Value&, rd_material*);
} extension_readers[] = {
    {"KHR_materials_clearcoat", read_coat},
    {"KHR_materials_anisotropy", read_anisotropy},
    {"KHR_materials_iridescence", read_iridescence},
    {"KHR_materials_specular", read_specular},
    {"KHR_materials_transmission", read_transmission},
    {"KHR_materials_volume", read_volume},
    {"KHR_materials_emissive_strength", read_emissive_strength},
    {"KHR_materials_ior", read_ior},
    {"KHR_materials_unlit", read_unlit},
    {"KHR_materials_sheen", warn_of_sheen},
};

rd_material read_material(material_importer& m, const Material& from)
{
    rd_material to = rd_material_default();
    read_core(m, from, &to);
    for (const auto& reader : extension_readers) {
        const auto found = from.extensions.find(reader.name);
        if (found != from.extensions.end() && found->second.IsObject()) {
            reader.read(m, found->second, &to);
        }
    }
    rd_material_update_features(&to);
    return to;
}

bool move_textures(material_importer& m)
{
    const size_t count = m.textures.size();
    rd_texture_set* set = &m.in->scene->textures;
    set->items = static_cast<rd_texture*>(std::calloc(count ? count : 1, sizeof(rd_texture)));
    if (!set->items) {
        return fail(*m.in, "textures", "out of memory");
    }
    set->count = int(count);
    for (size_t i = 0; i < count; ++i) {
        set->items[i] = m.textures[i];
    }
    return true;
}

} // namespace

bool import_materials(const importer& in)
{
    material_importer m = {&in, {}, {}, false};
    const rd_material fallback = rd_material_default();
    bool ok = true;
    for (size_t i = 0; ok && i < in.model->materials.size(); ++i) {
        const rd_material material = read_material(m, in.model->materials[i]);
        ok = rd_scene_add_material(in.scene, &material) >= 0;
    }
    ok = ok && rd_scene_add_material(in.scene, &fallback) >= 0;
    if (!ok) {
        fail(in, "materials", "out of memory");
    }
    return move_textures(m) && ok;
}

} // namespace rd
