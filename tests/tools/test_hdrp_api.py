#!/usr/bin/env python3
"""What the reader of the headers makes of the house style."""
import math
import unittest

import trees

import hdrp_api

TEXT = '''/* hdrp_env.h - x. */
/* >>lobes: everything */
#define HDRP_ENV_LIMIT 16
#define HDRP_ENV_TWICE (2 * HDRP_ENV_LIMIT) /* both */
#define HDRP_ENV_HALF  0.5f

/* Made by hdrp_env_view_make or
 * hdrp_env_view_other, see hdrp_env.h. Not by hdrp_env_area. */
struct hdrp_env_view {
    float near_m, far_m; /* (0,inf) in front of the camera */
    hdrp_v3 up;          /* unit, orthogonal
                            to the view */
    /* [0,1] of the whole */
    float share;
    hdrp_v3 axis; /* direction, any length */
    hdrp_u32 flags;
    hdrp_v3 unitless; /* area per unit */
};
HDRP_TYPEDEF(hdrp_env_view)

typedef struct hdrp_env_image {
    const float* texels;    /* width * height * 3 */
    int width, *height;     /* [1,65536] */
    float rows[3][4];       /* finite */
    void (*done)(void* user); /* may be NULL */
} hdrp_env_image;

typedef enum hdrp_env_kind {
    HDRP_ENV_LATLONG = 0, /* a, b */
    HDRP_ENV_CUBE
} hdrp_env_kind;

/** A summary over
 * three lines,
 *  and so on.
 *  view     valid  the view
 *  light_m  [0,HDRP_ENV_TWICE)
 *           metres; see "x*y"
 *  returns  unit
 *  edges    none
 *  error    <= 2e-6 relative over the lower half  @accuracy env_low
 *  error    <= .5 degrees over
 *           the upper half      @accuracy env_high
 *  source   nobody 2000 */
HDRP_FN hdrp_v3 hdrp_env_area(hdrp_env_view view,
                              float light_m)
{
    /* a brace { in a comment */
    if (light_m > 1.0f) {
        return view.up;
    }
    return hdrp_env_up(view);
}
#ifndef HDRP_GPU
/** Bakes.
 *  image    what to read
 *  done     called at the end
 *  returns  a code
 *  errors   none */
HDRP_API hdrp_result hdrp_env_bake(const hdrp_env_image* image, void (*done)(void* user, int n));
static inline const char* hdrp_env_kind_string(hdrp_env_kind kind)
{
    return kind == HDRP_ENV_CUBE ? "{" : "}";
}
#endif
#if defined(HDRP_ENV_IMPLEMENTATION) && !defined(HDRP_ENV_IMPLEMENTED)
static const float hdrp_i_env_table[2] = {1.0f, 2.0f};

static hdrp_v3 hdrp_i_env_sum(const float table[2])
{
    return hdrp_v3_splat(table[0]);
}
hdrp_result hdrp_env_bake(const hdrp_env_image* image, void (*done)(void* user, int n))
{
    done(NULL, 1);
    return HDRP_OK;
}
#endif
'''


class Reader(trees.TreeTest):
    def setUp(self):
        super().setUp()
        self.write("hdrp_env.h", TEXT)
        self.header = hdrp_api.header(self.root / "hdrp_env.h")
        self.functions = {f.name: f for f in self.header.functions()}
        self.macros = hdrp_api.macros(self.root)

    def test_functions_are_found_once_with_their_definition(self):
        self.assertEqual(list(self.functions), ["hdrp_env_area", "hdrp_env_bake",
                                                "hdrp_env_kind_string", "hdrp_i_env_sum"])
        area, bake = self.functions["hdrp_env_area"], self.functions["hdrp_env_bake"]
        self.assertEqual((area.section, area.type, area.length), ("lobes", "hdrp_v3", 9))
        self.assertEqual([(p.type, p.name) for p in area.parameters],
                         [("hdrp_env_view", "view"), ("float", "light_m")])
        self.assertEqual([(p.type, p.name) for p in bake.parameters],
                         [("const hdrp_env_image*", "image"), ("void (*)()", "done")])
        self.assertEqual((bake.qualifier, bake.length), ("HDRP_API", 5))
        self.assertGreater(bake.body_line, bake.line)
        self.assertEqual(bake.doc.get("errors"), "none")
        self.assertTrue(self.functions["hdrp_i_env_sum"].parameters[0].is_pointer)
        self.assertTrue(area.is_public and area.is_formula)
        self.assertFalse(self.functions["hdrp_i_env_sum"].is_public)
        self.assertEqual(self.functions["hdrp_env_kind_string"].length, 4)

    def test_docstrings_join_continuations(self):
        doc = self.functions["hdrp_env_area"].doc
        self.assertEqual(doc.summary, "A summary over three lines, and so on.")
        self.assertEqual([f.key for f in doc.fields], ["view", "light_m", "returns", "edges",
                                                       "error", "error", "source"])
        self.assertEqual(doc.get("light_m"), '[0,HDRP_ENV_TWICE) metres; see "x*y"')
        self.assertEqual(doc.strays, [])
        line = TEXT[:TEXT.index(" *  light_m")].count("\n") + 1
        self.assertEqual(doc.field("light_m").line, line)

    def test_several_claims_of_one_function(self):
        found = [c for c in hdrp_api.claims(self.root) if c.header == "hdrp_env.h"]
        self.assertEqual([(c.id, c.bound, c.unit) for c in found],
                         [("env_low", 2e-6, "relative"), ("env_high", 0.5, "degrees")])

    def test_struct_comments_carry_ranges(self):
        view = self.header.structs()["hdrp_env_view"]
        self.assertEqual(view.producers, ["hdrp_env_view_make", "hdrp_env_view_other"])
        self.assertTrue(view.is_shared)
        ranges = {m.name: str(m.range(self.macros)) for m in view.members}
        self.assertEqual(ranges, {"near_m": "(0,inf)", "far_m": "(0,inf)", "up": "unit",
                                  "share": "[0,1]", "axis": "finite", "flags": "None",
                                  "unitless": "None"})
        self.assertEqual(list(view)[2], ("hdrp_v3", "up"))
        image = self.header.structs()["hdrp_env_image"]
        self.assertFalse(image.is_shared)
        self.assertEqual([(m.type, m.name, m.array) for m in image.members],
                         [("const float*", "texels", ""), ("int", "width", ""),
                          ("int*", "height", ""), ("float", "rows", "[3][4]"),
                          ("void (*)()", "done", "")])
        line = TEXT[:TEXT.index("hdrp_u32 flags")].count("\n") + 1
        self.assertEqual(next(m.line for m in view.members if m.name == "flags"), line)

    def test_enums_macros_and_layers(self):
        self.assertEqual([(e.name, e.constants) for e in self.header.enums()],
                         [("hdrp_env_kind", ["HDRP_ENV_LATLONG", "HDRP_ENV_CUBE"])])
        self.assertEqual(hdrp_api.evaluate("HDRP_ENV_TWICE + 1u", self.macros), 33)
        self.assertEqual(hdrp_api.evaluate("-HDRP_ENV_HALF", self.macros), -0.5)
        self.assertIsNone(hdrp_api.evaluate("HDRP_ENV_NONE", self.macros))
        self.assertIsNone(hdrp_api.evaluate("sizeof(float)", self.macros))

        def layer(text):
            return self.header.layer_of(TEXT[:TEXT.index(text)].count("\n") + 1)
        self.assertEqual(layer("HDRP_FN hdrp_v3 hdrp_env_area"), "formula")
        self.assertEqual(layer("#ifndef HDRP_GPU"), "directive")
        self.assertEqual(layer("HDRP_API hdrp_result"), "algorithm")
        self.assertEqual(layer("static const float"), "implementation")

    def test_range_tokens(self):
        def read(token):
            return hdrp_api.parse_range(token, self.macros)
        self.assertEqual(str(read("[0,1];")), "[0,1]")
        self.assertEqual(str(read("(-HDRP_ENV_HALF,1e3)")), "(-0.5,1000)")
        self.assertEqual(read("[-inf,FLT_MAX]").lo, -math.inf)
        self.assertEqual(read("[FLT_MIN,0xff]").hi, 255)
        self.assertEqual(read("[FLT_MIN,FLT_MAX]").lo, 2.0 ** -126)
        for word in ("any", "finite", "unit", "valid"):
            self.assertEqual(read(word + ",").kind, word)
        for word in ("[1/sr]", "anything", "0..1", "[0", "a,b", "[0, 1]"):
            self.assertIsNone(read(word), word)
        for token in ("[1,0]", "[0,x]", "[0,HDRP_NONE]", "[0,--1]"):
            with self.assertRaises(hdrp_api.RangeError, msg=token):
                read(token)

    def test_ranges_contain(self):
        half_open = hdrp_api.parse_range("(0,1]", {})
        self.assertEqual([half_open.contains(x) for x in (0.0, -0.0, 1e-45, 1.0, 1.1, math.nan)],
                         [False, False, True, True, False, False])
        self.assertTrue(hdrp_api.parse_range("[0,inf]", {}).contains(math.inf))
        self.assertFalse(hdrp_api.parse_range("[0,inf)", {}).contains(math.inf))
        self.assertFalse(hdrp_api.FINITE.contains(math.inf))

    def test_floats_step_by_one_ulp(self):
        self.assertEqual(hdrp_api.next_up(0.0), 2.0 ** -149)
        self.assertEqual(hdrp_api.next_up(-0.0), 2.0 ** -149)
        self.assertEqual(hdrp_api.next_down(1.0), 1.0 - 2.0 ** -24)
        self.assertEqual(hdrp_api.next_up(-1.0), -1.0 + 2.0 ** -24)
        self.assertEqual(hdrp_api.next_up(hdrp_api.FLT_MAX), math.inf)
        self.assertEqual(hdrp_api.f32(1e39), math.inf)


if __name__ == "__main__":
    unittest.main()
