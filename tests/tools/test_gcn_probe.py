#!/usr/bin/env python3
"""The probe of AMD GPUs counts what a formula adds, and notices what it is there to notice."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import gcn_probe  # noqa: E402
import gcn_shaders  # noqa: E402

PROBE = ROOT / "tools" / "gcn_probe.py"
RESULTS = ROOT / "bench" / "results"


class Probe(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.results = self.folder / "results"
        self.headers = self.folder / "headers"
        self.headers.mkdir()
        for path in ROOT.glob("hdrp_*.h"):
            shutil.copy(path, self.headers)
        shutil.copytree(RESULTS, self.results)

    def run_probe(self, *arguments, **environment):
        """Exit status and output."""
        result = subprocess.run(
            [sys.executable, PROBE, "--include", self.headers, "--results", self.results,
             *arguments], capture_output=True, text=True, check=False,
            env=dict(os.environ, **environment))
        return result.returncode, result.stdout + result.stderr

    def expect(self, status, *arguments):
        found, output = self.run_probe(*arguments)
        if found == 77:
            self.skipTest(output)
        self.assertEqual(found, status, output)
        return output

    def recorded(self):
        return next(self.results.glob("gcn_mesa-*.csv"))

    def change(self, path, pattern, new):
        text, count = re.subn(pattern, new, path.read_text(), count=1, flags=re.M)
        self.assertEqual(count, 1, "the test changes a text that is not there")
        path.write_text(text)

    def test_recorded_numbers_are_what_is_measured(self):
        self.assertIn("as measured", self.expect(0, "--check", "hdrp_sqrt", "hdrp_floor"))

    def test_a_built_in_of_the_gpu_is_one_instruction_and_an_addition_of_vectors_is_three(self):
        output = self.expect(0, "hdrp_sqrt", "hdrp_v3_add")
        for name, instructions in (("hdrp_sqrt", 1), ("hdrp_v3_add", 3)):
            found = re.findall(rf"^formula {name} +(\d+)", output, re.M)
            self.assertEqual(found, [str(instructions)] * len(gcn_probe.FAMILIES), output)

    def test_no_formula_is_recorded_as_cheaper_than_nothing(self):
        lines = [line.split(",") for line in self.recorded().read_text().splitlines()
                 if line.startswith("formula,")]
        self.assertGreater(len(lines), 500)
        for column in ("instructions", "spirv_instructions", "cycles", "code_bytes"):
            at = gcn_probe.COLUMNS.index(column)
            self.assertEqual([line for line in lines if int(line[at]) < 0], [], column)

    def test_arguments_that_are_ignored_are_no_loads(self):
        output = self.expect(0, "hdrp_light_type", "--family", "vega10")
        self.assertRegex(output, r"(?m)^formula hdrp_light_type +1 ")

    def test_a_changed_number_is_noticed(self):
        self.change(self.recorded(), r"^formula,hdrp_sqrt,vega10,1,", "formula,hdrp_sqrt,vega10,2,")
        output = self.expect(1, "--check", "hdrp_sqrt")
        self.assertIn("recorded: formula,hdrp_sqrt,vega10,2,", output)
        self.assertIn("measured: formula,hdrp_sqrt,vega10,1,", output)

    def test_a_formula_that_is_not_recorded_is_noticed(self):
        self.change(self.recorded(), r"^formula,hdrp_sqrt,gfx1100,.*\n", "")
        self.assertIn("recorded: nothing", self.expect(1, "--check", "hdrp_sqrt"))

    def test_a_recorded_formula_that_is_gone_is_noticed(self):
        self.change(self.recorded(), r"^formula,hdrp_sqrt,vega10,(.*)$",
                    r"formula,hdrp_sqrt,vega10,\1\nformula,hdrp_gone,vega10,\1")
        self.assertIn("measured: nothing", self.expect(1, "--check", "hdrp_sqrt", "hdrp_gone"))

    def test_a_formula_that_has_become_dearer_is_noticed(self):
        self.change(self.headers / "hdrp_math.h", r"^(HDRP_FN float hdrp_sq\(.*\n\{\n    return )",
                    r"\g<1>0.5f + x * ")
        self.assertIn("hdrp_sq,vega10", self.expect(1, "--check", "hdrp_sq"))

    def test_other_versions_are_skipped(self):
        self.expect(0, "--check", "hdrp_sqrt")
        self.change(self.recorded(), r"glslang \S+", "glslang 1:2.3,")
        status, output = self.run_probe("--check", "hdrp_sqrt")
        self.assertEqual(status, 77, output)
        self.assertIn("glslang 1:2.3", output)
        self.recorded().unlink()
        status, output = self.run_probe("--check", "hdrp_sqrt")
        self.assertEqual(status, 77, output)
        self.assertIn("no numbers are recorded", output)

    def test_a_missing_driver_is_skipped(self):
        empty = str(self.folder)
        status, output = self.run_probe("--check", XDG_DATA_HOME=empty, XDG_CONFIG_DIRS=empty,
                                        SYSCONFDIR=empty, XDG_DATA_DIRS=empty)
        self.assertEqual(status, 77, output)

    def test_features_that_are_off_cost_nothing(self):
        output = self.expect(0, "--features", "--family", "vega10", "standard", "anisotropy")
        self.assertIn("6 pairs of shaders are the same to the bit", output)

    def test_a_feature_that_costs_where_it_is_off_is_noticed(self):
        self.change(self.headers / "hdrp_brdf.h",
                    r"if \(\(features & HDRP_BRDF_FEATURE_CLEAR_COAT\) != 0u\) \{"
                    r"(?=\n        float coat_n_dot_l)", "if (d.coat_mask > 0.0f) {")
        output = self.expect(1, "--features", "--family", "vega10", "standard", "anisotropy")
        self.assertIn("vega10 lit:standard:without", output)


class Text(unittest.TestCase):
    COAT = "(features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u"

    def cut(self, text):
        return "".join(gcn_shaders.without_features(text, 0).split())

    def test_a_branch_is_deleted(self):
        self.assertEqual(self.cut(f"a(); if ({self.COAT}) {{ b({{}}); }} c();"), "a();c();")

    def test_what_is_done_otherwise_stays(self):
        self.assertEqual(self.cut(f"if (x) {{ a(); }} else if ({self.COAT} && x < y) {{ b(); }}"
                                  " else { c(); }"), "if(x){a();}else{c();}")
        self.assertEqual(self.cut(f"a(); if ({self.COAT}) {{ b(); }} else {{ c(); }}"),
                         "a();{c();}")

    def test_a_selection_becomes_its_other_side(self):
        self.assertEqual(self.cut(f"x = {self.COAT} ? f(a ? b : c) : g;"), "x=g;")

    def test_features_of_the_mask_stay(self):
        text = f"if ({self.COAT}) {{ b(); }}"
        self.assertEqual(gcn_shaders.without_features(text, gcn_shaders.mask_of("coat")), text)

    def test_what_cannot_be_deleted_is_refused(self):
        for text in (f"a(); if ({self.COAT} || x) {{ b(); }}", f"a({self.COAT});"):
            with self.assertRaises(SystemExit):
                self.cut(text)


if __name__ == "__main__":
    unittest.main()
