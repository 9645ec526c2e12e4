#!/usr/bin/env python3
"""Each kind of defect that the compile matrix is for is put into a header once, and reported."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MATRIX = ROOT / "tests" / "compile" / "matrix.py"
HEADER = """#ifndef HDRP_ZED_H
#define HDRP_ZED_H
#include "hdrp_math.h"
{}
#endif
{}
"""
FORMULA = "HDRP_FN float hdrp_zed_scaled(float {0})\n{{\n    return {1};\n}}"
HOST = "#ifndef HDRP_GPU\n{}\n#endif"


class CompileMatrix(unittest.TestCase):
    def run_matrix(self, groups, *headers, options=("--brief",)):
        """Exit status and output for hdrp_math.h and these headers, as (name, text)."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            shutil.copy(ROOT / "hdrp_math.h", folder)
            for name, text in headers:
                (folder / name).write_text(text)
            command = [sys.executable, MATRIX, *groups.split(), "--include", folder, "--out",
                       folder / "out", *options]
            result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.returncode == 77:
            self.skipTest(result.stdout)
        return result.returncode, result.stdout + result.stderr

    def fails(self, groups, what, text, after="", **options):
        """The header with this text fails, and the report holds the command and says what."""
        status, output = self.run_matrix(groups, ("hdrp_zed.h", HEADER.format(text, after)),
                                         **options)
        self.assertEqual(status, 1, output)
        self.assertIn("FAILED", output)
        self.assertIn(what, output)

    def test_a_good_header_passes_and_its_formulas_are_called(self):
        text = HEADER.format(FORMULA.format("x", "x * 2.0f"), "")
        status, output = self.run_matrix("c_gcc glsl hlsl opencl", ("hdrp_zed.h", text))
        self.assertEqual(status, 0, output)
        self.assertIn("0 failed", output)
        self.assertNotIn(" 0 formulas called", output)

    def test_c_needs_guards(self):
        self.fails("c_gcc", "zed-twice", FORMULA.format("x", "x * 2.0f"),
                   "typedef struct hdrp_zed_late { float x; } hdrp_zed_late;")

    def test_c_refuses_the_macros_of_windows(self):
        self.fails("c_gcc", "zed-after-windows", FORMULA.format("near", "near * 2.0f"),
                   options=())

    def test_c_and_cxx_refuse_double(self):
        for group in ("c_clang", "cxx_gcc"):
            self.fails(group, "double", FORMULA.format("x", "x * 2.0"))

    def test_gcc_follows_the_flow(self):
        self.fails("c_gcc", "maybe-uninitialized", HOST.format(
            "HDRP_FN float hdrp_zed_flow(float x)\n{\n    float y;\n    if (x > 3.0f) {\n"
            "        y = x * x;\n    } else if (x < -3.0f) {\n        y = -x;\n    }\n"
            "    return y;\n}"), options=())

    def test_headers_must_not_clash(self):
        text = HEADER.format(FORMULA.format("x", "x * 2.0f"), "")
        for group in ("c_clang", "hlsl"):
            status, output = self.run_matrix(group, ("hdrp_zed.h", text),
                                             ("hdrp_why.h", text.replace("ZED_H", "WHY_H")))
            self.assertEqual(status, 1, output)
            for order in ("all-forwards", "all-backwards"):
                self.assertIn(order, output)

    def test_32_bit_overflow(self):
        self.fails("m32", "shift", HOST.format("HDRP_FN unsigned long hdrp_zed_bit(void)\n{\n"
                                               "    return 1ul << 40;\n}"))

    def test_every_declared_function_links(self):
        self.fails("link", "hdrp_zed_missing",
                   HOST.format("HDRP_API int hdrp_zed_missing(float x);"))

    def test_two_units_define_nothing_twice(self):
        self.fails("link", "multiple definition", HOST.format(
            "int hdrp_zed_twice(float x);\nint hdrp_zed_twice(float x)\n{\n"
            "    return x > 1.0f;\n}"))

    def test_words_of_shading_languages(self):
        for group, word in (("glsl", "sample"), ("hlsl", "linear"), ("glsl_es", "patch"),
                            ("opencl", "kernel")):
            self.fails(group, "hdrp_zed.h:", FORMULA.format(word, f"{word} * 2.0f"))

    def test_es_converts_nothing_by_itself(self):
        self.fails("glsl_es", "int", FORMULA.format("x", "x * 2"))

    def test_cuda_calls_no_host_function(self):
        self.fails("cuda", "__host__", FORMULA.format("x", "roundf(x)"))


if __name__ == "__main__":
    unittest.main()
