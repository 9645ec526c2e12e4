/* glTF materials and textures, from the checked document: tinygltf keeps extensions as values of its
 * own, in which large integers are lost. Khronos, "KHR_materials_*" and "KHR_texture_transform". */
#include "gltf_import.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace rd
{
namespace
{

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

/* A member, or an empty object. */
const json& part(const json& object, const char* name)
{
    static const json none = json::object();
    const auto found = object.find(name);
    return found == object.end() ? none : *found;
}

hdrp_v3 color(const json& object, const char* name, hdrp_v3 fallback)
{
    const auto c = object.value(name, std::array<float, 3>{fallback.x, fallback.y, fallback.z});
    return hdrp_v3_make(c[0], c[1], c[2]);
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
    const std::string what =
        image.uri.empty() ? "images[" + std::to_string(index) + "]" : image.uri;
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

void set_transform(rd_texture_slot* slot, const json& transform)
{
    using pair = std::array<double, 2>;
    const double angle = transform.value("rotation", 0.0);
    const double c = std::cos(angle), s = std::sin(angle);
    const pair scale = transform.value("scale", pair{1.0, 1.0});
    const pair offset = transform.value("offset", pair{0.0, 0.0});
    slot->u_row = hdrp_v3_make(float(c * scale[0]), float(s * scale[1]), float(offset[0]));
    slot->v_row = hdrp_v3_make(float(-s * scale[0]), float(c * scale[1]), float(offset[1]));
    slot->uv_set = transform.value("texCoord", slot->uv_set);
}

bool is_color_slot(rd_slot slot)
{
    return slot == RD_SLOT_BASE_COLOR || slot == RD_SLOT_EMISSIVE || slot == RD_SLOT_SPECULAR_COLOR;
}

void set_slot(material_importer& m, rd_material* to, rd_slot slot, const json& owner,
              const char* name)
{
    const json& info = part(owner, name);
    if (info.empty()) {
        return;
    }
    const tinygltf::Texture& t = m.in->model->textures[info.at("index").get<size_t>()];
    const bool is_normal = slot == RD_SLOT_NORMAL || slot == RD_SLOT_COAT_NORMAL;
    rd_texture_slot* s = &to->slot[slot];
    *s =
        rd_texture_slot_make(add_texture(m, {t.source, t.sampler, is_color_slot(slot), is_normal}));
    s->uv_set = info.value("texCoord", 0);
    set_transform(s, part(part(info, "extensions"), "KHR_texture_transform"));
}

/* A member of `extras`, which may be anything. */
bool is_marked(const json& from, const char* name)
{
    const json& mark = part(part(from, "extras"), name);
    return mark.is_boolean() && mark.get<bool>();
}

void read_core(material_importer& m, const json& from, rd_material* to)
{
    const json& pbr = part(from, "pbrMetallicRoughness");
    const auto c = pbr.value("baseColorFactor", std::array<float, 4>{1.0f, 1.0f, 1.0f, 1.0f});
    const std::string alpha_mode = from.value("alphaMode", "OPAQUE");
    std::snprintf(to->name, RD_NAME_MAX, "%s", from.value("name", "").c_str());
    to->base_color = hdrp_v3_make(c[0], c[1], c[2]);
    to->alpha = c[3];
    to->metallic = pbr.value("metallicFactor", 1.0f);
    to->perceptual_roughness = pbr.value("roughnessFactor", 1.0f);
    to->normal_scale = part(from, "normalTexture").value("scale", 1.0f);
    to->occlusion_strength = part(from, "occlusionTexture").value("strength", 1.0f);
    to->double_sided = from.value("doubleSided", false);
    to->alpha_cutoff = from.value("alphaCutoff", 0.5f);
    to->alpha_mode = alpha_mode == "MASK"    ? RD_ALPHA_MASK
                     : alpha_mode == "BLEND" ? RD_ALPHA_BLEND
                                             : RD_ALPHA_OPAQUE;
    to->additive = to->alpha_mode == RD_ALPHA_BLEND && is_marked(from, "hdrp_additive");
    to->half_resolution = is_marked(from, "hdrp_half_resolution");
    to->emission_nits = color(from, "emissiveFactor", hdrp_v3_splat(0.0f));
    set_slot(m, to, RD_SLOT_BASE_COLOR, pbr, "baseColorTexture");
    set_slot(m, to, RD_SLOT_METALLIC_ROUGHNESS, pbr, "metallicRoughnessTexture");
    set_slot(m, to, RD_SLOT_NORMAL, from, "normalTexture");
    set_slot(m, to, RD_SLOT_OCCLUSION, from, "occlusionTexture");
    set_slot(m, to, RD_SLOT_EMISSIVE, from, "emissiveTexture");
}

void read_coat(material_importer& m, const json& e, rd_material* to)
{
    to->coat = e.value("clearcoatFactor", 0.0f);
    to->coat_perceptual_roughness = e.value("clearcoatRoughnessFactor", 0.0f);
    set_slot(m, to, RD_SLOT_COAT, e, "clearcoatTexture");
    set_slot(m, to, RD_SLOT_COAT_ROUGHNESS, e, "clearcoatRoughnessTexture");
    set_slot(m, to, RD_SLOT_COAT_NORMAL, e, "clearcoatNormalTexture");
    to->coat_normal_scale = part(e, "clearcoatNormalTexture").value("scale", 1.0f);
}

void read_anisotropy(material_importer& m, const json& e, rd_material* to)
{
    to->anisotropy = e.value("anisotropyStrength", 0.0f);
    to->anisotropy_rotation_rad = e.value("anisotropyRotation", 0.0f);
    set_slot(m, to, RD_SLOT_ANISOTROPY, e, "anisotropyTexture");
}

void read_iridescence(material_importer& m, const json& e, rd_material* to)
{
    to->film = e.value("iridescenceFactor", 0.0f);
    to->film_ior = e.value("iridescenceIor", to->film_ior);
    to->film_thickness_min_nm = e.value("iridescenceThicknessMinimum", to->film_thickness_min_nm);
    to->film_thickness_max_nm = e.value("iridescenceThicknessMaximum", to->film_thickness_max_nm);
    set_slot(m, to, RD_SLOT_FILM, e, "iridescenceTexture");
    set_slot(m, to, RD_SLOT_FILM_THICKNESS, e, "iridescenceThicknessTexture");
}

void read_specular(material_importer& m, const json& e, rd_material* to)
{
    to->specular = e.value("specularFactor", 1.0f);
    to->specular_color = color(e, "specularColorFactor", to->specular_color);
    set_slot(m, to, RD_SLOT_SPECULAR, e, "specularTexture");
    set_slot(m, to, RD_SLOT_SPECULAR_COLOR, e, "specularColorTexture");
}

void read_transmission(material_importer& m, const json& e, rd_material* to)
{
    to->transmission = e.value("transmissionFactor", 0.0f);
    set_slot(m, to, RD_SLOT_TRANSMISSION, e, "transmissionTexture");
}

void read_volume(material_importer& m, const json& e, rd_material* to)
{
    const double distance = e.value("attenuationDistance", double(HDRP_FLT_MAX));
    to->thickness = e.value("thicknessFactor", 0.0f);
    to->attenuation_distance_m = float(std::fmin(distance, double(HDRP_FLT_MAX)));
    to->attenuation_color = color(e, "attenuationColor", to->attenuation_color);
    set_slot(m, to, RD_SLOT_THICKNESS, e, "thicknessTexture");
}

void read_emissive_strength(material_importer&, const json& e, rd_material* to)
{
    to->emission_nits = hdrp_v3_scale(to->emission_nits, e.value("emissiveStrength", 1.0f));
}

void read_ior(material_importer&, const json& e, rd_material* to)
{
    to->ior = e.value("ior", 1.5f);
}

void read_unlit(material_importer&, const json&, rd_material* to)
{
    to->unlit = true;
}

void warn_of_sheen(material_importer& m, const json&, rd_material*)
{
    if (!m.warned_of_sheen) {
        rd_warn(m.in->report, m.in->file->path, "KHR_materials_sheen is ignored");
        m.warned_of_sheen = true;
    }
}

const struct {
    const char* name;
    void (*read)(material_importer&, const json&, rd_material*);
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

rd_material read_material(material_importer& m, const json& from)
{
    rd_material to = rd_material_default();
    const json& extensions = part(from, "extensions");
    read_core(m, from, &to);
    for (const auto& reader : extension_readers) {
        if (extensions.contains(reader.name)) {
            reader.read(m, extensions.at(reader.name), &to);
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
    for (const json& from : part(in.file->document, "materials")) {
        const rd_material material = read_material(m, from);
        ok = ok && rd_scene_add_material(in.scene, &material) >= 0;
    }
    ok = ok && rd_scene_add_material(in.scene, &fallback) >= 0;
    if (!ok) {
        fail(in, "materials", "out of memory");
    }
    return move_textures(m) && ok;
}

} // namespace rd
