/* The language of the table in gltf_rules.cpp, and the reader of the table. */
#ifndef RD_GLTF_RULES_H
#define RD_GLTF_RULES_H

#include "gltf_file.h"

#include <limits>
#include <utility>
#include <vector>

namespace rd
{

class checker;
struct rule;

using member = std::pair<const char*, rule>;
/* What no type can say. It runs when the whole document has the types of the table. */
using extra_check = void (*)(checker&, const json&);

enum class kind { flag, integer, number, text, word, code, index, object, list, map };

struct rule {
    kind type;
    double low = 0.0; /* of a number, or of the count of a list or map */
    double high = std::numeric_limits<double>::infinity();
    const char* words = ""; /* word: "a|b|c"; code: "1|2|3"; index: the array that it points into */
    std::vector<member> members = {}; /* of an object; of a list or map the one for all elements */
    extra_check also = nullptr;
    bool is_required = false;
};

/* The accessors that a mesh attribute may use: "|" between component types, element types. */
struct attribute_rule {
    const char* prefix; /* of the attribute's name */
    const char* types;
    const char* components;
    const char* quantized; /* components with KHR_mesh_quantization */
};

extern const rule document_rule;
extern const std::vector<attribute_rule> attribute_rules;

/* True where "a|b|c" has the word. */
bool is_one_of(const char* words, const std::string& word);

/* Walks through a document along its rules and knows where it is. */
class checker
{
  public:
    gltf_file& file;

    explicit checker(gltf_file& f) : file(f)
    {
    }

    /* First the table for all, then the extra checks. */
    void run();

    /* Throws "PLACE REASON". */
    [[noreturn]] void refuse(const char* format, ...) const RD_PRINTF(2, 3);

  private:
    std::string place_; /* as in "meshes[0].primitives[1]" */
    bool runs_extra_checks_ = false;

    void expect(bool is_right, const char* reason) const;
    void check(const json& value, const rule& r);
    void check_at(const std::string& step, const json& value, const rule& r);
    void check_number(const json& value, const rule& r);
    void check_word(const std::string& word, const char* words);
    void check_index(const json& value, const char* array);
    void check_members(const json& value, const rule& r);
    void check_elements(const json& value, const rule& r);
};

/* The extra checks, gltf_check.cpp. */
void buffer_has_its_bytes(checker& c, const json& buffer);
void view_lies_in_its_buffer(checker& c, const json& view);
void accessor_lies_in_its_views(checker& c, const json& accessor);
void image_has_one_source(checker& c, const json& image);
void ior_is_possible(checker& c, const json& ior);
void primitive_fits_its_accessors(checker& c, const json& primitive);
void camera_has_its_lens(checker& c, const json& camera);
void light_has_its_cone(checker& c, const json& light);
void node_has_one_transform(checker& c, const json& node);
void nodes_form_trees(checker& c, const json& nodes);

} // namespace rd

#endif
