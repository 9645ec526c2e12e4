#!/usr/bin/env python3
"""The finite scan is generated, compiled and run on formulas with a known defect each."""
import math
import re
import subprocess
import unittest

import trees

import finite_scan
import hdrp_api

RUNNER = trees.ROOT / "tests" / "finite"


def formula(body, name="broken", kind="float", parameters="float x", entries=(("x", "[0,1]"),),
            returns="finite", more=""):
    fields = "".join(f" *  {k}  {v}\n" for k, v in entries)
    return (f"/** A formula.\n{fields} *  returns  {returns}\n{more} *  edges  none\n"
            " *  error  none: a test\n *  source  none */\n"
            f"HDRP_FN {kind} hdrp_{name}({parameters})\n{{\n    {body}\n}}\n\n")


class FiniteScan(trees.TreeTest):
    def run_scan(self, text, *flags):
        """Exit status and output of the scan of a header with only this text in it."""
        math_header = trees.MATH
        start = math_header.index("/* >>sampling */")
        self.write("hdrp_math.h", math_header[:start] + "/* >>sampling */\n\n" + text + "#endif\n")
        self.write("modules.inc", "FS_HEADER(math)\n")
        self.write("scan.c", finite_scan.Writer(self.root / "hdrp_math.h").text())
        program = self.root / "scan"
        subprocess.run(["cc", "-std=c11", "-O1", "-Wall", "-Wpedantic", "-Wconversion", "-Werror",
                        f"-I{self.root}", f"-I{RUNNER}", *flags,
                        RUNNER / "finite_scan.c", self.root / "scan.c", "-o", program, "-lm"],
                       check=True)
        run = subprocess.run([program], capture_output=True, text=True, check=False)
        return run.returncode, run.stdout

    def passes(self, text):
        status, output = self.run_scan(text)
        self.assertEqual(status, 0, output)
        return output

    def fails(self, text, *parts):
        status, output = self.run_scan(text)
        self.assertEqual(status, 1, output)
        for part in parts:
            self.assertIn(part, output)
        return output

    def test_a_total_formula_passes(self):
        output = self.passes(formula("return x;", returns="[0,1]"))
        self.assertIn("1 functions, 0 failed", output)
        names = ("arguments", "result")  # which the generated code might use itself
        self.passes("".join(formula(f"return {n};", name=f"of_{n}", parameters=f"float {n}",
                                    entries=[(n, "[0,1]")]) for n in names))

    def test_a_pole_at_an_end_is_found(self):
        self.fails(formula("return 1.0f / (1.0f - x);"), "FAIL hdrp_broken (hdrp_math.h)",
                   "x          0x1p+0 (1)", "returned   inf (inf)", "is not finite")
        self.fails(formula("return 1.0f / x;"), "0x1p-149")
        self.passes(formula("return 1.0f / x;", entries=[("x", "[FLT_MIN,1]")]))

    def test_one_ulp_beside_one_is_tried(self):
        self.fails(formula("return 1.0f / (x - 0.99999994f);"), "0x1.fffffep-1")
        self.fails(formula("return 1.0f / (x - 1.00000012f);", entries=[("x", "[0,2]")]),
                   "0x1.000002p+0")

    def test_denormals_and_huge_values_are_tried(self):
        self.fails(formula("return 1.0f / (x - 1.17549435e-38f);"), "0x1p-126")
        self.fails(formula("return x * x;", entries=[("x", "finite")]), "0x1.fffffep+127")
        self.fails(formula("return 2.0f * x;", entries=[("x", "[0,inf)")]), "0x1.fffffep+127")

    def test_minus_zero_is_tried(self):
        self.fails(formula("return 1.0f / (1.0f / x + 1.0f) >= 0.0f || x > 0.0f ? 0.0f"
                           " : sqrtf(-1.0f);", entries=[("x", "[0,1]")], returns="any") +
                   formula("return signbit(x) ? sqrtf(-1.0f) : 0.0f;", name="other"),
                   "FAIL hdrp_other", "-0x0p+0")

    def test_open_ends_are_left_out(self):
        self.passes(formula("return x == 0.0f || x == 1.0f ? sqrtf(-1.0f) : x;",
                            entries=[("x", "(0,1)")]))

    def test_any_brings_nan_and_infinities(self):
        self.fails(formula("return x > 0.0f ? 1.0f : x;", entries=[("x", "any")]), "nan")
        self.fails(formula("return x == x ? x : 0.0f;", entries=[("x", "any")]), "inf")
        self.passes(formula("return x > 0.0f ? 1.0f : 0.0f;", entries=[("x", "any")]))

    def test_the_result_range_is_checked(self):
        self.fails(formula("return x + 1e-6f;", returns="[0,1]"), "is not in [0,1]")
        self.fails(formula("return x;", returns="(0,1]"), "is not in (0,1]")
        self.passes(formula("return x / x;", returns="any"))
        self.fails(formula("return x * 1.0000001f;", returns="[0,1]"), "is not in [0,1]")
        self.passes(formula("return x * 1.0000001f;", returns="[0,1] to within 2 ulp"))
        self.fails(formula("return 16u;", kind="hdrp_u32", returns="[0,15]"),
                   "is not in [0,15]")

    def test_vectors_and_unit_vectors(self):
        v3 = {"kind": "hdrp_v3", "parameters": "hdrp_v3 x"}
        self.fails(formula("x.y = 1.0f / (2.0f - x.x); return x;", entries=[("x", "[0,2]")], **v3),
                   "returned   x 0x1p+1")
        self.fails(formula("x.x = x.z; return x;", entries=[("x", "unit")], returns="unit", **v3),
                   "is not a unit vector")
        self.passes(formula("return x;", entries=[("x", "unit")], returns="unit", **v3))
        # What rounding makes of a unit vector: 1 - z^2 may be negative.
        self.fails(formula("x.x = hdrp_sqrt(1.0f - x.z * x.z); return x;",
                           entries=[("x", "unit")], **v3), "0x1.000002p+0")
        self.fails(formula("return 1.0f / (1.0f + a.x * b.x + a.y * b.y + a.z * b.z);",
                           parameters="hdrp_v3 a, hdrp_v3 b",
                           entries=[("a", "unit"), ("b", "unit")]), "inf")

    def test_structs_are_built_from_the_comments_of_their_members(self):
        pair = ("struct hdrp_pair {\n    float a; /* [0,1] */\n    hdrp_v3 n; /* unit */\n"
                "    hdrp_u32 mask; /* HDRP_PAIR_... */\n};\nHDRP_TYPEDEF(hdrp_pair)\n"
                "#define HDRP_PAIR_ONE 1u\n#define HDRP_PAIR_FOUR 4u\n\n")
        of_pair = {"parameters": "hdrp_pair p", "entries": [("p", "valid")]}
        self.passes(pair + formula("return p.a;", returns="[0,1]", **of_pair))
        self.fails(pair + formula("return 1.0f / (1.0f - p.a);", **of_pair), "a 0x1p+0")
        self.fails(pair + formula("return p.mask == 5u && p.n.z == -1.0f ? sqrtf(-1.0f) : 0.0f;",
                                  **of_pair), "mask 5", "n.z -0x1p+0")
        self.passes(pair + formula("return p.mask > 5u ? sqrtf(-1.0f) : 0.0f;", **of_pair))
        self.fails(pair + formula("return p.a;", parameters="hdrp_pair p", entries=[("p", "any")]),
                   "nan")
        self.fails(pair + formula("p.a = p.a + 1.0f; return p;", kind="hdrp_pair", returns="valid",
                                  **of_pair), "is not in [0,1]")
        self.fails(pair.replace("/* unit */", "/* a normal */") + formula("return p.a;", **of_pair),
                   "is not scanned: hdrp_pair.n has no range in its comment")

    def test_components_of_a_vector_may_have_ranges_of_their_own(self):
        self.assertIn("struct hdrp_v3", trees.MATH)
        record = ("struct hdrp_v4 {\n    float x, y, z, w;\n};\nHDRP_TYPEDEF(hdrp_v4)\n"
                  "struct hdrp_u32x4 {\n    hdrp_u32 x, y, z, w;\n};\nHDRP_TYPEDEF(hdrp_u32x4)\n"
                  "struct hdrp_record {\n    hdrp_v4 axis; /* xyz unit, w [2,3] size */\n"
                  "    hdrp_u32x4 bits; /* x HDRP_BIT_..., yz [5,6], w any */\n};\n"
                  "HDRP_TYPEDEF(hdrp_record)\n#define HDRP_BIT_ONE 1u\n\n")
        of_record = {"parameters": "hdrp_record r", "entries": [("r", "valid")]}
        self.passes(record + formula(
            "float l = r.axis.x * r.axis.x + r.axis.y * r.axis.y + r.axis.z * r.axis.z;\n"
            "    return fabsf(l - 1.0f) > 1e-6f || r.axis.w < 2.0f || r.axis.w > 3.0f ||\n"
            "    r.bits.x > 1u || r.bits.y < 5u || r.bits.z > 6u ? sqrtf(-1.0f) : 0.0f;",
            **of_record))
        self.fails(record + formula("return 1.0f / (3.0f - r.axis.w);", **of_record),
                   "axis.w 0x1.8p+1")
        self.fails(record + formula("r.axis.w = 1.0f; return r;", kind="hdrp_record",
                                    returns="valid", **of_record), "axis.w is not in [2,3]")
        self.fails(record + formula("r.axis.x = r.axis.w; return r;", kind="hdrp_record",
                                    returns="valid", **of_record), "axis.x begins what is not a "
                   "unit vector")
        self.fails(record.replace(", w [2,3] size", "") + formula("return 0.0f;", **of_record),
                   "is not scanned: the comment of hdrp_record.axis gives a range to 3 of 4")

    def test_structs_made_by_a_function_come_from_it(self):
        made = ("/* Made by hdrp_made_from. */\nstruct hdrp_made {\n    float a, b;\n};\n"
                "HDRP_TYPEDEF(hdrp_made)\n\n" +
                formula("hdrp_made m; m.a = x; m.b = 1.0f - x; return m;", name="made_from",
                        kind="hdrp_made"))
        of_made = {"parameters": "hdrp_made m", "entries": [("m", "valid")]}
        self.passes(made + formula("return m.a + m.b == 1.0f ? 0.0f : sqrtf(-1.0f);", **of_made))
        self.fails(made + formula("return 1.0f / m.b;", **of_made), "a 0x1p+0 (1), b 0x0p+0 (0)")
        self.fails(made.replace("by hdrp_made_from", "by hdrp_made_of") +
                   formula("return m.a;", **of_made), "hdrp_made_of, said to make hdrp_made, does "
                   "not return one")

    def test_requires_leaves_combinations_out(self):
        ordered = {"parameters": "float lo, float hi",
                   "entries": [("lo", "[0,1]"), ("hi", "[0,1]")],
                   "more": " *  requires  lo <= hi; in this order\n"}
        self.passes(formula("return hi < lo ? sqrtf(-1.0f) : 0.0f;", **ordered))
        ordered["more"] = ""
        self.fails(formula("return hi < lo ? sqrtf(-1.0f) : 0.0f;", **ordered), "returned")
        ordered["more"] = " *  requires  lo > hi + 1.0f\n"
        self.fails(formula("return 0.0f;", **ordered), "no sample meets its 'requires'")

    def test_too_many_combinations_are_thinned_but_keep_their_corners(self):
        names = "abcdefgh"
        many = {"parameters": ", ".join(f"float {n}" for n in names),
                "entries": [(n, "[0,1]") for n in names]}
        output = self.passes(formula("return 0.0f;", **many))
        calls = int(re.search(r"(\d+) calls", output)[1])
        self.assertTrue(100000 <= calls <= 300000, output)
        ones = " && ".join(f"{n} == 1.0f" for n in names)
        self.fails(formula(f"return {ones} ? sqrtf(-1.0f) : 0.0f;", **many), "returned")

    def test_integers_take_their_ends_and_powers_of_two(self):
        index = {"parameters": "hdrp_u32 i", "entries": [("i", "[3,70000]")]}
        for value in (3, 70000, 4, 65536):
            self.fails(formula(f"return i == {value}u ? sqrtf(-1.0f) : 0.0f;", **index),
                       f"i          {value}")
        self.passes(formula("return i < 3u || i > 70000u ? sqrtf(-1.0f) : 0.0f;", **index))

    def test_undefined_behaviour_is_reported_with_its_arguments(self):
        status, output = self.run_scan(
            formula("return (hdrp_u32)x;", kind="hdrp_u32", entries=[("x", "[-2,1]")]),
            "-fsanitize=undefined,float-cast-overflow", "-fno-sanitize-recover=all")
        self.assertEqual(status, 1, output)
        self.assertIn("FAIL hdrp_broken (hdrp_math.h) does what is undefined\n"
                      "     x          -0x1p+1", output)

    def test_a_formula_that_cannot_be_scanned_fails(self):
        for entries, reason in [((("x", "about one"),), "parameter x has no range"),
                                ((("x", "[1,0]"),), "[1,0] is empty"),
                                ((("y", "[0,1]"),), "parameter x has no range"),
                                ((("x", "valid"),), "float does not take 'valid'"),
                                ((("x", "unit"),), "float does not take 'unit'")]:
            self.fails(formula("return x;", entries=entries),
                       f"FAIL hdrp_broken (hdrp_math.h) is not scanned: {reason}")
        bare = "HDRP_FN float hdrp_broken(float x)\n{\n    return x;\n}\n"
        self.fails(bare, "its docstring has no fields")
        self.fails("/** One sentence. */\n" + bare, "its docstring has no fields")

    def test_a_docstring_may_excuse_its_formula(self):
        excused = formula("return 1.0f / x;", more=" *  scan  none: derivatives\n")
        self.passes(excused + formula("return x;", name="good"))
        self.fails(excused.replace("none: derivatives", "no") + formula("return x;", name="good"))

    def test_samples_stay_in_their_range(self):
        for token in ("[0,1]", "(0,1]", "[-1,1]", "(0,inf)", "[1000,40000]", "[FLT_MIN,FLT_MAX]",
                      "[1e-4,1e-4]", "finite", "[-inf,inf]"):
            r = hdrp_api.parse_range(token, {})
            samples = finite_scan.float_samples(r)
            self.assertTrue(samples, token)
            for x in samples:
                self.assertTrue(hdrp_api.Range("interval", hdrp_api.f32(r.lo), hdrp_api.f32(r.hi),
                                               r.lo_open, r.hi_open).contains(x) or
                                r.kind == "finite" and math.isfinite(x), (token, x))
        for size in (2, 3, 4):
            for v in finite_scan.unit_samples(size):
                self.assertLess(abs(math.sqrt(sum(x * x for x in v)) - 1.0), 2e-7, v)


if __name__ == "__main__":
    unittest.main()
