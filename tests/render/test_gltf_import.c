/* What glTF geometry, transforms and references become; files are written by the test. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FILE_NAME "test_gltf_import.gltf"

/* >>files */

static void base64(const void* bytes, size_t size, char* out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char* p = (const unsigned char*)bytes;
    for (size_t i = 0; i < size; i += 3) {
        uint32_t u = (uint32_t)p[i] << 16;
        u |= i + 1 < size ? (uint32_t)p[i + 1] << 8 : 0u;
        u |= i + 2 < size ? (uint32_t)p[i + 2] : 0u;
        *out++ = digits[u >> 18];
        *out++ = digits[u >> 12 & 63u];
        *out++ = i + 1 < size ? digits[u >> 6 & 63u] : '=';
        *out++ = i + 2 < size ? digits[u & 63u] : '=';
    }
    *out = '\0';
}

/* A file with one buffer; `rest` are the other members, beginning with a comma. */
static void write_gltf(const void* bytes, size_t size, const char* rest)
{
    char* data = (char*)malloc(size * 2 + 8);
    FILE* f = fopen(FILE_NAME, "w");
    assert_non_null(f);
    base64(bytes, size, data);
    fprintf(f,
            "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu,\"uri\":"
            "\"data:application/octet-stream;base64,%s\"}]%s}",
            size, data, rest);
    fclose(f);
    free(data);
}

static rd_scene load(void)
{
    rd_report report;
    rd_scene scene;
    report.failed = false;
    report.warning_count = 0;
    if (!rd_scene_load_gltf(&scene, FILE_NAME, &report)) {
        fail_msg("%s", report.error);
    }
    return scene;
}

static void refuses(const char* because)
{
    rd_report report;
    rd_scene scene;
    report.failed = false;
    report.warning_count = 0;
    assert_false(rd_scene_load_gltf(&scene, FILE_NAME, &report));
    if (!strstr(report.error, because)) {
        fail_msg("expected \"%s\" in: %s", because, report.error);
    }
    rd_scene_free(&scene);
}

/* >>a quad of four vertices, in the order of a strip, that faces +Z */

typedef struct quad_data {
    float positions[4][3];
    float uv[4][2];
    uint32_t indices[6];
} quad_data;

static const quad_data quad = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                               {{0, 1}, {1, 1}, {0, 0}, {1, 0}},
                               {0, 1, 2, 2, 1, 3}};

#define VIEWS                                                                                      \
    ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"          \
    "\"byteLength\":32},{\"buffer\":0,\"byteOffset\":80,\"byteLength\":24}]"
#define POSITIONS                                                                                  \
    "{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":4,\"min\":[0,0,0],"      \
    "\"max\":[1,1,0]}"
#define UVS       "{\"bufferView\":1,\"componentType\":5126,\"type\":\"VEC2\",\"count\":4}"
#define INDICES   "{\"bufferView\":2,\"componentType\":5125,\"type\":\"SCALAR\",\"count\":6}"
#define ACCESSORS ",\"accessors\":[" POSITIONS "," UVS "," INDICES "]"
#define SCENE     ",\"scenes\":[{\"nodes\":[0]}],\"scene\":0"
#define ONE_NODE  SCENE ",\"nodes\":[{\"mesh\":0}]"

static hdrp_v3 face_normal(const rd_mesh* m, uint32_t triangle)
{
    const uint32_t* i = m->indices + (size_t)triangle * 3;
    hdrp_v3 a = m->positions[i[0]];
    return hdrp_v3_cross(hdrp_v3_sub(m->positions[i[1]], a), hdrp_v3_sub(m->positions[i[2]], a));
}

static void assert_near(float a, float b)
{
    if (!(fabsf(a - b) < 1e-5f)) {
        fail_msg("%g is not %g", (double)a, (double)b);
    }
}

static void check_quad(const char* rest)
{
    rd_scene s;
    write_gltf(&quad, sizeof quad, rest);
    s = load();
    assert_int_equal(s.mesh_count, 1);
    assert_int_equal(s.triangle_count, 2);
    assert_near(face_normal(&s.meshes[0], 0).z, 1.0f);
    assert_near(face_normal(&s.meshes[0], 1).z, 1.0f);
    rd_scene_free(&s);
}

static void triangles_strips_and_fans_face_the_same_way(void** state)
{
    (void)state;
    check_quad(VIEWS ACCESSORS ONE_NODE
               ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2}]}]");
    check_quad(VIEWS ACCESSORS ONE_NODE
               ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":5}]}]");
    {
        static const quad_data fan = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                      {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
                                      {0, 1, 2, 0, 2, 3}};
        rd_scene s;
        write_gltf(&fan, sizeof fan,
                   VIEWS ACCESSORS ONE_NODE
                   ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":6}]}]");
        s = load();
        assert_int_equal(s.triangle_count, 2);
        assert_near(face_normal(&s.meshes[0], 1).z, 1.0f);
        rd_scene_free(&s);
    }
}

static void a_mirrored_node_turns_triangles_with_the_surface(void** state)
{
    rd_scene s;
    (void)state;
    write_gltf(&quad, sizeof quad,
               VIEWS ACCESSORS SCENE
               ",\"nodes\":[{\"mesh\":0,\"scale\":[-2,1,1]}]"
               ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2}]}]");
    s = load();
    /* A sheet mirrored in x still faces +Z: what was seen from the front still is. */
    assert_near(face_normal(&s.meshes[0], 0).z, 2.0f);
    assert_near(s.bounds.low.x, -2.0f);
    assert_near(s.bounds.high.x, 0.0f);
    rd_scene_free(&s);
}

static void parents_translate_rotate_and_scale_in_that_order(void** state)
{
    rd_scene s;
    (void)state;
    write_gltf(&quad, sizeof quad,
               VIEWS ACCESSORS SCENE
               ",\"nodes\":[{\"children\":[1],\"translation\":[10,0,0],\"scale\":[2,2,2]},"
               "{\"mesh\":0,\"rotation\":[0,0,0.70710678,0.70710678],\"translation\":[0,5,0]}]"
               ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2}]}]");
    s = load();
    /* A quarter turn about z takes (1,0) to (0,1), then + (0,5), times 2, + (10,0). */
    assert_near(s.bounds.low.x, 8.0f);
    assert_near(s.bounds.high.x, 10.0f);
    assert_near(s.bounds.low.y, 10.0f);
    assert_near(s.bounds.high.y, 12.0f);
    rd_scene_free(&s);
}

static void sparse_values_replace_single_elements(void** state)
{
    static const struct {
        float values[3];
        uint16_t index, padding;
    } data = {{4, 5, 6}, 2, 0};
    rd_scene s;
    (void)state;
    write_gltf(&data, sizeof data,
               ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":12},{\"buffer\":0,\"byteOffset\":12,"
               "\"byteLength\":2}],\"accessors\":[{\"componentType\":5126,\"type\":\"VEC3\","
               "\"count\":3,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":1,"
               "\"componentType\":5123},\"values\":{\"bufferView\":0}}}]" ONE_NODE
               ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]");
    s = load();
    assert_near(s.meshes[0].positions[1].x, 0.0f);
    assert_near(s.meshes[0].positions[2].x, 4.0f);
    assert_near(s.meshes[0].positions[2].z, 6.0f);
    rd_scene_free(&s);
}

static void normalized_integers_cover_zero_to_one(void** state)
{
    struct {
        float positions[3][3];
        uint8_t uv[3][4];
        uint16_t color[3][4];
    } data;
    rd_scene s;
    (void)state;
    memset(&data, 0, sizeof data);
    data.positions[1][0] = data.positions[2][1] = 1.0f;
    data.uv[1][0] = 255;
    data.color[2][0] = 65535;
    data.color[0][1] = 32768;
    write_gltf(&data, sizeof data,
               ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
               "\"byteLength\":12,\"byteStride\":4},{\"buffer\":0,\"byteOffset\":48,"
               "\"byteLength\":24,\"byteStride\":8}],\"accessors\":[{\"bufferView\":0,"
               "\"componentType\":5126,\"type\":\"VEC3\",\"count\":3},{\"bufferView\":1,"
               "\"componentType\":5121,\"normalized\":true,\"type\":\"VEC2\",\"count\":3},"
               "{\"bufferView\":2,\"componentType\":5123,\"normalized\":true,\"type\":\"VEC3\","
               "\"count\":3}]" ONE_NODE ",\"meshes\":[{\"primitives\":[{\"attributes\":"
               "{\"POSITION\":0,\"TEXCOORD_0\":1,\"COLOR_0\":2}}]}]");
    s = load();
    assert_near(s.meshes[0].uv[0][1].x, 1.0f);
    assert_near(s.meshes[0].colors[2].x, 1.0f);
    assert_near(s.meshes[0].colors[0].y, 32768.0f / 65535.0f);
    assert_near(s.meshes[0].colors[0].w, 1.0f);
    rd_scene_free(&s);
}

static void texture_transforms_scale_then_rotate_then_shift(void** state)
{
    rd_scene s;
    const rd_texture_slot* slot;
    hdrp_v3 uv = {1.0f, 0.0f, 1.0f};
    (void)state;
    write_gltf(&quad, sizeof quad,
               VIEWS ACCESSORS ",\"images\":[{\"uri\":\"data:image/png;base64,AAAA\"}],"
                               "\"textures\":[{\"source\":0}],\"materials\":[{\"emissiveTexture\":"
                               "{\"index\":0,\"texCoord\":1,\"extensions\":{"
                               "\"KHR_texture_transform\":{\"offset\":[0.25,0.5],\"rotation\":"
                               "1.5707963267948966,\"scale\":[3,2],\"texCoord\":0}}}}]");
    s = load();
    slot = &s.materials[0].slot[RD_SLOT_EMISSIVE];
    assert_int_equal(slot->uv_set, 0);
    /* The picture turns against the clock, so that coordinates turn with it: (3,0) to (0,-3). */
    assert_near(hdrp_v3_dot(slot->u_row, uv), 0.25f);
    assert_near(hdrp_v3_dot(slot->v_row, uv), 0.5f - 3.0f);
    assert_true(s.textures.items[slot->texture].is_srgb);
    rd_scene_free(&s);
}

/* What glTF has no word for. Extras may be anything, and other marks are none. */
static void extras_mark_what_is_additive_or_soft(void** state)
{
    static const char* const marked[4] = {"{\"hdrp_additive\":true,\"hdrp_half_resolution\":true}",
                                          "[true]", "\"hdrp_additive\"",
                                          "{\"hdrp_additive\":1,\"hdrp_half_resolution\":false}"};
    (void)state;
    for (int i = 0; i < 4; ++i) {
        const char* modes[2] = {"BLEND", "MASK"};
        for (int k = 0; k < 2; ++k) {
            char rest[400];
            rd_scene s;
            snprintf(rest, sizeof rest, ",\"materials\":[{\"alphaMode\":\"%s\",\"extras\":%s}]",
                     modes[k], marked[i]);
            write_gltf("four", 4, rest);
            s = load();
            assert_int_equal(s.materials[0].additive, i == 0 && k == 0);
            assert_int_equal(s.materials[0].half_resolution, i == 0);
            rd_scene_free(&s);
        }
    }
}

static void a_buffer_may_be_the_beginning_of_a_longer_file(void** state)
{
    static const float data[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 7, 7, 7};
    rd_scene s;
    FILE* bin = fopen("test gltf import.bin", "wb");
    FILE* f = fopen(FILE_NAME, "w");
    (void)state;
    assert_true(bin && f && fwrite(data, sizeof data, 1, bin) == 1);
    fprintf(f,
            "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":"
            "\"test%%20gltf%%20import.bin\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
            "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\","
            "\"count\":3}]" ONE_NODE
            ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}");
    fclose(bin);
    fclose(f);
    s = load();
    assert_int_equal(s.triangle_count, 1);
    rd_scene_free(&s);
    remove("test gltf import.bin");
}

static void file_names_may_contain_a_plus_sign(void** state)
{
    static const float data[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    rd_scene s;
    FILE* bin = fopen("test+gltf.bin", "wb");
    FILE* f = fopen(FILE_NAME, "w");
    (void)state;
    assert_true(bin && f && fwrite(data, sizeof data, 1, bin) == 1);
    fprintf(f, "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":"
               "\"test+gltf.bin\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
               "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\","
               "\"count\":3}]" ONE_NODE
               ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}");
    fclose(bin);
    fclose(f);
    s = load();
    assert_int_equal(s.triangle_count, 1);
    rd_scene_free(&s);
    remove("test+gltf.bin");
}

static void integers_of_extensions_may_be_large(void** state)
{
    rd_scene s;
    (void)state;
    write_gltf(&quad, sizeof quad,
               ",\"materials\":[{\"emissiveFactor\":[1,0,1],\"extensions\":{"
               "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4000000000}}}]");
    s = load();
    assert_true(s.materials[0].emission_nits.x == 4e9f);
    assert_true(s.materials[0].emission_nits.y == 0.0f);
    rd_scene_free(&s);
}

/* >>refusals that no file in the shared assets covers */

/* A member "extras", in which everything is allowed, of `count` times the same text. */
static void write_extras(const char* text, int count, const char* end)
{
    const size_t length = strlen(text);
    char* rest = (char*)malloc(length * (size_t)count + strlen(end) + 32);
    char* at = rest + sprintf(rest, ",\"extras\":");
    for (int i = 0; i < count; ++i, at += length) {
        memcpy(at, text, length);
    }
    strcpy(at, end);
    write_gltf(&quad, sizeof quad, rest);
    free(rest);
}

static void refuses_texts_that_are_deep_or_long(void** state)
{
    rd_scene s;
    (void)state;
    write_extras("[", 100000, "");
    refuses("nested too deeply");
    write_extras("{\"a\":", 64, "0");
    refuses("nested too deeply");
    write_extras("[0,", 1,
                 "\"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[\"]");
    s = load();
    rd_scene_free(&s);
    write_extras("[0],", 1 << 21, "0");
    refuses("too many values");
}

static void refuses_keys_that_appear_twice(void** state)
{
    (void)state;
    write_gltf(&quad, sizeof quad, ",\"extras\":[{\"a\":{\"b\":1,\"c:\":2,\"b\":3}}]");
    refuses("same key twice");
}

static void refuses_numbers_and_strings_that_c_cannot_hold(void** state)
{
    (void)state;
    write_gltf(&quad, sizeof quad, ",\"extras\":1e999");
    refuses("1e999");
    write_gltf(&quad, sizeof quad, ",\"extras\":NaN");
    refuses("JSON");
    write_gltf(&quad, sizeof quad, ",\"extras\":\"a\\u0000b\"");
    refuses("u0000");
    write_gltf(&quad, sizeof quad, ",\"extras\":\"\xc0\xaf\"");
    refuses("UTF-8");
}

static void refuses_indices_that_are_no_integers(void** state)
{
    static const char* const bad[] = {"-1", "0.0", "1e0", "\"0\"", "18446744073709551616", "true"};
    char rest[64];
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        sprintf(rest, ",\"scenes\":[{}],\"scene\":%s", bad[i]);
        write_gltf(&quad, sizeof quad, rest);
        refuses("scene is not an index");
    }
    write_gltf(&quad, sizeof quad, ",\"scenes\":[{}],\"scene\":1");
    refuses("scene is 1, but scenes has 1 elements");
}

static void refuses_paths_that_are_not_relative(void** state)
{
    (void)state;
    write_gltf(&quad, sizeof quad, ",\"images\":[{\"uri\":\"/etc/passwd\"}]");
    refuses("unusable URI");
    write_gltf(&quad, sizeof quad, ",\"images\":[{\"uri\":\"%2Fetc/passwd\"}]");
    refuses("unusable URI");
    write_gltf(&quad, sizeof quad, ",\"images\":[{\"uri\":\"file:///etc/passwd\"}]");
    refuses("unusable URI");
    write_gltf(&quad, sizeof quad, ",\"images\":[{\"uri\":\"a%2\"}]");
    refuses("unusable URI");
}

static void names_a_missing_texture(void** state)
{
    (void)state;
    write_gltf(&quad, sizeof quad, ",\"images\":[{\"uri\":\"no%20such.png\"}]");
    refuses("no%20such.png");
}

static void refuses_required_extensions_it_does_not_know(void** state)
{
    (void)state;
    write_gltf(&quad, sizeof quad, ",\"extensionsRequired\":[\"EXT_unheard_of\"]");
    refuses("EXT_unheard_of");
}

static void refuses_accessors_that_cost_the_file_nothing(void** state)
{
    (void)state;
    write_gltf(&quad, sizeof quad,
               ",\"accessors\":[{\"componentType\":5126,\"type\":\"VEC3\",\"count\":2000000000}]");
    refuses("without data");
}

static void refuses_cycles_and_shared_children(void** state)
{
    (void)state;
    write_gltf(&quad, sizeof quad, ",\"nodes\":[{\"children\":[1]},{\"children\":[0]}]");
    refuses("cycle");
    write_gltf(&quad, sizeof quad, ",\"nodes\":[{\"children\":[2]},{\"children\":[2]},{}]");
    refuses("two parents");
}

static void refuses_uv_sets_that_the_mesh_lacks(void** state)
{
    (void)state;
    write_gltf(
        &quad, sizeof quad,
        VIEWS ACCESSORS ONE_NODE
        ",\"images\":[{\"uri\":\"data:image/png;base64,AAAA\"}],\"textures\":[{\"source\":0}]"
        ",\"materials\":[{\"normalTexture\":{\"index\":0}}],\"meshes\":[{\"primitives\":["
        "{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":0}]}]");
    refuses("TEXCOORD_0");
}

static void refuses_positions_that_are_no_numbers(void** state)
{
    float data[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    (void)state;
    data[4] = NAN;
    write_gltf(
        data, sizeof data,
        ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
        "\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}]" ONE_NODE
        ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]");
    refuses("vertex 1");
}

static void survives_a_chain_of_many_nodes(void** state)
{
    const int count = 50000;
    char* rest = (char*)malloc((size_t)count * 32 + 64);
    char* at = rest;
    rd_scene s;
    (void)state;
    at += sprintf(at, "%s,\"nodes\":[", SCENE);
    for (int i = 0; i + 1 < count; ++i) {
        at += sprintf(at, "{\"children\":[%d]},", i + 1);
    }
    sprintf(at, "{}]");
    write_gltf(&quad, sizeof quad, rest);
    s = load();
    assert_int_equal(s.mesh_count, 0);
    rd_scene_free(&s);
    free(rest);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_strips_and_fans_face_the_same_way),
        cmocka_unit_test(a_mirrored_node_turns_triangles_with_the_surface),
        cmocka_unit_test(parents_translate_rotate_and_scale_in_that_order),
        cmocka_unit_test(sparse_values_replace_single_elements),
        cmocka_unit_test(normalized_integers_cover_zero_to_one),
        cmocka_unit_test(texture_transforms_scale_then_rotate_then_shift),
        cmocka_unit_test(extras_mark_what_is_additive_or_soft),
        cmocka_unit_test(a_buffer_may_be_the_beginning_of_a_longer_file),
        cmocka_unit_test(file_names_may_contain_a_plus_sign),
        cmocka_unit_test(integers_of_extensions_may_be_large),
        cmocka_unit_test(refuses_texts_that_are_deep_or_long),
        cmocka_unit_test(refuses_keys_that_appear_twice),
        cmocka_unit_test(refuses_numbers_and_strings_that_c_cannot_hold),
        cmocka_unit_test(refuses_indices_that_are_no_integers),
        cmocka_unit_test(refuses_paths_that_are_not_relative),
        cmocka_unit_test(names_a_missing_texture),
        cmocka_unit_test(refuses_required_extensions_it_does_not_know),
        cmocka_unit_test(refuses_accessors_that_cost_the_file_nothing),
        cmocka_unit_test(refuses_cycles_and_shared_children),
        cmocka_unit_test(refuses_uv_sets_that_the_mesh_lacks),
        cmocka_unit_test(refuses_positions_that_are_no_numbers),
        cmocka_unit_test(survives_a_chain_of_many_nodes),
    };
    int failures = cmocka_run_group_tests(tests, NULL, NULL);
    remove(FILE_NAME);
    return failures;
}
