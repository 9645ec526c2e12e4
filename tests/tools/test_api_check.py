#!/usr/bin/env python3
"""Each rule of api_check.py is broken once and must be reported."""
import subprocess
import sys
import unittest

import trees

import api_check


class ApiCheck(trees.TreeTest):
    def messages(self):
        return [f"{place}:{line}: {text}" for place, line, text in api_check.problems(self.root)]

    def expect(self, *parts):
        """Exactly one problem per part, which contains it."""
        found = self.messages()
        self.assertEqual(len(found), len(parts), "\n".join(found))
        for part in parts:
            self.assertTrue(any(part in message for message in found), f"{part}\n{found}")

    def broken(self, name, old, new, *parts):
        with self.subTest(new=new[:40]):
            self.setUp()
            self.change(name, old, new)
            self.expect(*parts)

    def test_the_tree_is_right(self):
        self.expect()

    def test_the_example_of_the_manual_is_right(self):
        manual = (trees.ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
        example = manual[manual.index("```c\n") + 5:]
        example = example[:example.index("```")] + "{\n    return n_dot_h * alpha;\n}\n\n"
        self.change("hdrp_brdf.h", "/** One over x.", "#define HDRP_ALPHA_MIN 1e-4f\n\n" + example +
                    "/** One over x.")
        self.change("hdrp_brdf.h", "lobes: inverse", "lobes: d_ggx inverse")
        self.expect("hdrp_brdf_d_ggx is in no unit test", "@accuracy brdf_d_ggx has no entry")

    def test_the_program_fails_and_names_file_and_line(self):
        program = [sys.executable, trees.ROOT / "tools" / "api_check.py", "--root", self.root]
        self.assertEqual(subprocess.run(program, capture_output=True, check=False).returncode, 0)
        line = trees.BRDF[:trees.BRDF.index("1.0f / x")].count("\n") + 1
        self.change("hdrp_brdf.h", "1.0f / x", "1.0 / x")
        run = subprocess.run(program, capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 1)
        self.assertIn(f"hdrp_brdf.h:{line}: 1.0 lacks its f", run.stdout)

    def test_a_public_function_has_a_docstring(self):
        self.broken("hdrp_brdf.h", "/** One over x.", "/* One over x.",
                    "hdrp_brdf_inverse has no docstring")

    def test_only_a_primitive_may_have_one_sentence(self):
        self.broken("hdrp_math.h", ".\n *  u        [0,1]  uniform\n *  returns  [0,1]\n"
                    " *  edges    none\n *  error    none: a definition\n *  source   Shirley and "
                    'Chiu 1997, "A Low Distortion Map" */', ". */",
                    "hdrp_disk: parameter 'u' has no entry")

    def test_every_field_is_there(self):
        for field in ("returns  [1,2]", "edges    none", "source   arithmetic"):
            self.broken("hdrp_brdf.h", f" *  {field}", " *",
                        f"hdrp_brdf_inverse: no '{field.split()[0]}'")
        self.broken("hdrp_math.h", " *  error    none: a definition\n", "",
                    "hdrp_disk: no 'error'")

    def test_parameters_are_documented_in_order(self):
        self.broken("hdrp_brdf.h", " *  x        [HDRP", " *  y        [HDRP",
                    "parameter 'x' has no entry in its place (found 'returns')")
        self.broken("hdrp_brdf.h", "float* out,\n                            hdrp_u32 count);",
                    "hdrp_u32 count,\n                            float* out);",
                    "parameter 'count' has no entry in its place (found 'out')")

    def test_a_range_is_one(self):
        for text, message in [("about one", "'x' has no range"), ("[1;2]", "'x' has no range"),
                              ("[0,HDRP_NONE]", "HDRP_NONE has no value"),
                              ("[2,1]", "[2,1] is empty"), ("[0,big]", "'big' is not a number"),
                              ("unit", "'x' is not a vector"), ("valid", "'x' is not a struct")]:
            self.broken("hdrp_brdf.h", "[HDRP_BRDF_LOW,1]", text, message)
        self.broken("hdrp_brdf.h", " *  p         valid", " *  p         [0,1]",
                    "'p' is a struct: its range is 'valid' or 'any'")
        self.broken("hdrp_brdf.h", "[1,1024]  entries", "entries", "'count' has no range")
        self.broken("hdrp_brdf.h", "returns  [1,2]", "returns  [2,1]", "range of 'returns'")
        self.broken("hdrp_brdf.h", "returns  [1,2]", "returns  unit", "'returns' is not a vector")

    def test_a_line_is_a_field_or_its_continuation(self):
        self.broken("hdrp_brdf.h", " *           length", " *  length   of it",
                    "'length' is neither a parameter nor a field")
        self.broken("hdrp_brdf.h", " *           length", " *   length", "'length' is neither a "
                    "field")
        self.broken("hdrp_brdf.h", " *  edges    none", " *  edges", "'edges' is empty")
        self.broken("hdrp_brdf.h", " *  edges    none", " *  edges    none\n *  edges    more",
                    "'edges' appears twice")

    def test_an_error_is_a_claim_or_a_reason(self):
        for text in ("small", "<= 1e-7 @accuracy brdf_inverse", "none", "<= 1e-7 relative"):
            self.broken("hdrp_math.h", "none: a definition", text, "'error' must read")
        self.broken("hdrp_math.h", "error    none: a definition",
                    "error    none: a definition\n *  scan     later", "'scan' must read")

    def test_claims_are_unique_and_registered(self):
        self.broken("hdrp_math.h", "none: a definition", "<= 1 ulp  @accuracy brdf_inverse",
                    "@accuracy brdf_inverse is already the claim of hdrp_disk")
        self.broken("hdrp_math.h", "none: a definition", "<= 1 ulp  @accuracy disk",
                    "@accuracy disk has no entry")

    def test_a_primitive_does_not_round_unseen(self):
        self.broken("hdrp_math.h", "return sqrtf(x)", "return HDRP_I_F(sqrt)(x)",
                    "hdrp_sqrt uses sqrt: one sentence is not enough")
        self.broken("hdrp_math.h", "return sqrtf(x)", "return 1.0f / x",
                    "hdrp_sqrt uses a division: one sentence is not enough")
        self.broken("hdrp_math.h", "return sqrtf(x)", "return HDRP_I_F(floor)(x)")

    def test_a_primitive_that_calls_what_has_an_error_states_its_own(self):
        self.change("hdrp_math.h", "error    none: a definition",
                    "error    <= 1e-7 relative  @accuracy disk")
        self.change("tests/accuracy/acc_brdf.c", '{"brdf_inverse"', '{"disk", g}, {"brdf_inverse"')
        self.expect()
        self.change("hdrp_math.h", "return sqrtf(x)", "return hdrp_disk(x)")
        self.expect("hdrp_sqrt uses hdrp_disk: one sentence is not enough")

    def with_fast_form(self, reason):
        """hdrp_disk and hdrp_disk_fast, whose error lines are the reason."""
        self.setUp()
        begin = trees.MATH.index("/** Radius of a point")
        copy = trees.MATH[begin:trees.MATH.index("#endif", begin)]
        self.change("hdrp_math.h", copy, copy + copy.replace("hdrp_disk", "hdrp_disk_fast"))
        text = (self.root / "hdrp_math.h").read_text(encoding="utf-8")
        self.write("hdrp_math.h", text.replace("none: a definition", reason)
                   .replace("sampling: disk", "sampling: disk disk_fast"))
        self.change("tests/unit/test_brdf.c", "hdrp_disk(1.0f)",
                    "hdrp_disk(1.0f) == hdrp_disk_fast(1.0f)")
        self.change("tests/exhaustive/sweeps.c", "EX_SWEEP(hdrp_disk, d)",
                    "EX_SWEEP(hdrp_disk, d), EX_SWEEP(hdrp_disk_fast, d)")

    def test_one_of_several_forms_has_a_claim_or_leads_to_one(self):
        self.with_fast_form("none: a definition")
        self.expect("hdrp_disk is one of several forms", "hdrp_disk_fast is one of several forms")
        self.with_fast_form("none: exact")
        self.expect()
        self.with_fast_form("none: delegates to hdrp_disk_fast")
        self.expect("hdrp_disk is one of several forms", "hdrp_disk_fast is one of several forms")

    def test_a_codec_has_a_claim_or_leads_to_one(self):
        codec = ("/** A code.\n *  x        any  value\n *  returns  any\n *  edges    none\n"
                 " *  error    {}\n *  source   arithmetic */\n"
                 "HDRP_FN float hdrp_pack_code_from_value(hdrp_v2 x)\n{{\n    return x.x;\n}}\n\n")
        header = trees.BRDF[:trees.BRDF.index("struct hdrp_brdf_pair")].replace("/* Two weights. */\n",
                                                                               "")
        for reason, wrong in (("none: a definition", 1), ("none: exact for every code", 0),
                              ("none: hdrp_brdf_inverse of each", 0)):
            with self.subTest(reason=reason):
                self.setUp()
                self.write("hdrp_pack.h", header.replace("hdrp_brdf_", "hdrp_pack_")
                           .replace("brdf.h", "pack.h").replace("HDRP_BRDF", "HDRP_PACK")
                           .replace("lobes: inverse mix", "lobes: code_from_value")
                           .replace(" *   algorithm layer: bake\n", "") + codec.format(reason) +
                           "#endif\n")
                self.change("tests/unit/test_brdf.c", "int main",
                            "float f = hdrp_pack_code_from_value(v);\nint main")
                self.expect(*["hdrp_pack_code_from_value is a codec"] * wrong)

    def test_a_reason_names_formulas_that_exist(self):
        self.broken("hdrp_math.h", "none: a definition", "none: delegates to hdrp_circle",
                    "hdrp_disk: the reason names hdrp_circle, which is no formula")

    def test_a_formula_of_one_float_is_swept(self):
        self.broken("tests/exhaustive/sweeps.c", "EX_SWEEP(hdrp_disk, d), ", "",
                    "hdrp_disk takes one float and is in no sweep")
        self.change("hdrp_math.h", " *  source   Shirley",
                    " *  scan     none: a reason\n *  source   Shirley")
        self.expect()

    def test_algorithm_functions_say_what_can_go_wrong_and_who_owns_memory(self):
        self.broken("hdrp_brdf.h", " *  edges    on an error the table is untouched */", " */",
                    "neither 'edges' nor 'errors'")
        self.broken("hdrp_brdf.h", " *  returns  0, or 1 when count is out of range\n", "",
                    "hdrp_brdf_bake: no 'returns'")
        with self.subTest("owner"):
            self.setUp()
            self.change("hdrp_brdf.h", "float* out,\n", "void* out,\n")
            self.expect()
            self.change("hdrp_brdf.h", "the table, owned by the caller", "the table")
            self.expect("nothing says who owns the memory of 'out'")

    def test_every_function_is_tested(self):
        self.broken("tests/unit/test_brdf.c", "hdrp_sqrt(1.0f)", "1.0f",
                    "hdrp_sqrt is in no unit test")
        self.broken("tests/unit/test_brdf.c", "hdrp_sqrt(1.0f)", "/* hdrp_sqrt */ 1.0f",
                    "hdrp_sqrt is in no unit test")

    def test_names_begin_with_the_module(self):
        self.broken("hdrp_brdf.h", "static double hdrp_i_brdf_half(double x)",
                    "static double hdrp_brdf_half(double x)", "a private function is named hdrp_i_")
        self.broken("hdrp_brdf.h", "#define HDRP_BRDF_LOW 0.5f",
                    "#define HDRP_BRDF_LOW 0.5f\n#define BRDF_HIGH 1.0f",
                    "macro BRDF_HIGH does not begin with HDRP_")
        self.broken("hdrp_brdf.h", "/* Two weights. */",
                    "struct hdrp_pair {\n    float x;\n};\n/* Two weights. */",
                    "struct hdrp_pair does not begin with hdrp_brdf_")
        self.broken("hdrp_brdf.h", "/* Two weights. */",
                    "enum hdrp_brdf_kind {\n    HDRP_ONE,\n    TWO\n};\n/* Two weights. */",
                    "'enum' is reserved", "enumerator TWO does not begin with HDRP_")
        self.broken("hdrp_brdf.h", "/* Two weights. */",
                    "enum kind {\n    HDRP_ONE\n};\n/* Two weights. */",
                    "'enum' is reserved", "enum kind does not begin with hdrp_brdf_")
        with self.subTest("function"):
            self.setUp()
            self.change("hdrp_brdf.h", "float hdrp_brdf_mix", "float hdrp_mix")
            self.assertTrue(any("hdrp_mix does not begin with hdrp_brdf_" in m
                                for m in self.messages()))

    def test_double_underscores_are_reserved(self):
        self.broken("hdrp_brdf.h", "hdrp_i_brdf_half(double x)", "hdrp_i_brdf__half(double x)",
                    "hdrp_i_brdf__half: '__' is reserved")
        self.broken("hdrp_brdf.h", "#define HDRP_BRDF_LOW 0.5f",
                    "#define HDRP_BRDF_LOW 0.5f\n#define HDRP_BRDF__HIGH 1.0f",
                    "HDRP_BRDF__HIGH: '__' is reserved")

    def test_shader_keywords_are_no_identifiers(self):
        for word, language in [("sample", "GLSL"), ("line", "HLSL"), ("half2", "HLSL"),
                               ("kernel", "MSL"),
                               ("near", "windows.h"), ("global", "OpenCL"), ("new", "C++"),
                               ("bool", "GLSL")]:
            self.broken("hdrp_brdf.h", "    return 0.5f * (p.first + p.second);",
                        f"    float {word} = p.first;\n    return 0.5f * (p.first + p.second);",
                        f"'{word}' is reserved in")
            found = [m for m in self.messages() if language in m]
            self.assertEqual(len(found), 1, language)

    def test_an_empty_parameter_list_says_void(self):
        self.broken("hdrp_brdf.h", "#ifdef HDRP_BRDF_IMPLEMENTATION\n",
                    "#ifdef HDRP_BRDF_IMPLEMENTATION\nstatic int hdrp_i_brdf_one()\n{\n"
                    "    return 1;\n}\n", "hdrp_i_brdf_one() must say (void)")

    def test_private_functions_stay_in_their_header(self):
        self.broken("hdrp_math.h", "return hdrp_sqrt(u);", "return hdrp_i_brdf_half(u);",
                    "hdrp_i_brdf_half is private to hdrp_brdf.h")

    def test_functions_are_short(self):
        for lines, parts in [(36, ()), (37, ("hdrp_brdf_mix has 41 lines, at most 40",))]:
            self.broken("hdrp_brdf.h", "    return 0.5f * (", "    ;\n" * lines +
                        "    return 0.5f * (", *parts)
        self.broken("hdrp_brdf.h", "    if (count < 1u", "    ;\n" * 80 + "    if (count < 1u",
                    "hdrp_brdf_bake has 90 lines, at most 80")

    def test_the_median_function_is_short(self):
        for lines, parts in [(7, ()), (8, ("the median formula function has 11 lines",))]:
            more = "".join(f"HDRP_FN float hdrp_i_brdf_{i}(float x)\n{{\n" + "    ;\n" * lines +
                           "}\n" for i in range(16))
            self.broken("hdrp_brdf.h", "/** One over x.", more + "/** One over x.", *parts)

    def test_a_header_is_short(self):
        self.broken("hdrp_brdf.h", "/* Two weights. */", "\n" * 2200, "hand-written lines, at most "
                    "2200")
        self.broken("hdrp_brdf.h", " * >>index", " *\n" * 90 + " * >>index",
                    "the opening comment has 92 lines, at most 80")
        self.broken("hdrp_brdf.h", "/* Two weights. */", f"/* Two weights. {'x' * 90} */",
                    "109 columns, at most 100")

    def test_float_literals_carry_f(self):
        for literal in ("0.5", "5e-1", ".5", "5."):
            self.broken("hdrp_brdf.h", "0.5f * (p", f"{literal} * (p", f"{literal} lacks its f")
        self.broken("hdrp_brdf.h", "LOW 0.5f", "LOW 0.5", "0.5 lacks its f")

    def test_headers_refuse_another_version(self):
        self.broken("hdrp_brdf.h", "10203", "10204", "the version check is missing")
        self.broken("hdrp_brdf.h", "hdrp_brdf.h 1.2.3", "hdrp_brdf.h 1.2.4",
                    "the version check is missing")
        with self.subTest("number"):
            self.setUp()
            self.change("hdrp_math.h", "VERSION 10203", "VERSION 10204")
            self.assertIn("hdrp_math.h:0: HDRP_VERSION 10204 is not 1.2.3", self.messages())

    def test_includes_go_one_way(self):
        self.broken("hdrp_math.h", "#include <stdint.h>", '#include "hdrp_brdf.h"',
                    'must not include "hdrp_brdf.h"')
        self.broken("hdrp_math.h", "#include <stdint.h>", "#include <stdio.h>",
                    "must not include <stdio.h>")
        with self.subTest("unknown"):
            self.setUp()
            self.write("hdrp_new.h", trees.BRDF.replace("brdf", "new").replace("BRDF", "NEW"))
            self.assertIn("hdrp_new.h:1: not in DEPENDENCIES of tools/api_check.py",
                          self.messages())

    def test_nothing_is_allocated_or_kept(self):
        self.broken("hdrp_brdf.h", "    if (count < 1u", "    free(out);\n    if (count < 1u",
                    "calls free")
        self.broken("hdrp_brdf.h", "static double hdrp_i_brdf_half(",
                    "static int hdrp_i_brdf_calls = 0;\nstatic double hdrp_i_brdf_half(",
                    "data that is not const")
        self.broken("hdrp_brdf.h", "static double hdrp_i_brdf_half(",
                    "static const int hdrp_i_brdf_calls = 0;\nstatic double hdrp_i_brdf_half(")

    def test_paths_of_one_machine_are_found(self):
        for path in ("/ho" "me/someone/x", "/wo" "rk/x", "C:" "\\x"):
            self.broken("tests/unit/test_brdf.c", "int main", f"/* {path} */\nint main",
                        "absolute path of one machine")
        self.broken("tests/unit/test_brdf.c", "int main", "/* ../work/x, https://x.org/home/y */\n"
                    "int main")

    def test_the_index_is_current(self):
        self.broken("hdrp_brdf.h", "lobes: inverse mix", "lobes: mix", "index is not current")
        self.broken("hdrp_brdf.h", " *\n * >>index", " *\n * >>list", "index is missing")

    def test_write_makes_the_index(self):
        good = (self.root / "hdrp_brdf.h").read_text()
        start, end = good.index(" *\n * >>index"), good.index(" * >>end")
        for text in (good[:start] + " */" + good[end + len(" * >>end */"):],
                     good[:start].rstrip() + " */" + good[end + len(" * >>end */"):],
                     good.replace("inverse mix", "old")):
            self.write("hdrp_brdf.h", text)
            program = [sys.executable, trees.ROOT / "tools" / "api_check.py", "--write", "--root",
                       self.root]
            run = subprocess.run(program, capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 0, run.stdout)
            self.assertIn("wrote the index of hdrp_brdf.h", run.stdout)


if __name__ == "__main__":
    unittest.main()
