#!/usr/bin/env python3
"""Shaders are embedded between the markers, without contraction where they say so, and stale words
are seen."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import embed_spirv  # noqa: E402

SHADER = """#version 450
{comment}
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Data {{ float data[]; }};
void main() {{ data[0] = data[1] * data[2] + data[3]; }}
"""
HEAD = [embed_spirv.MAGIC, 0x10300, 0, 9, 0]


def instruction(opcode, *operands):
    return [(len(operands) + 1) << 16 | opcode, *operands]


class Modules(unittest.TestCase):
    def test_results_of_arithmetic_are_decorated_once(self):
        decorate, multiply, load = 71, 133, 61
        words = HEAD + instruction(decorate, 5, 2) + instruction(decorate, 7, 42) + \
            instruction(multiply, 1, 6, 5, 5) + instruction(load, 1, 8, 5) + \
            instruction(multiply, 1, 7, 5, 5)
        expected = HEAD + instruction(decorate, 5, 2) + instruction(decorate, 7, 42) + \
            instruction(decorate, 6, 42) + words[len(HEAD) + 6:]
        self.assertEqual(embed_spirv.without_contraction(words), expected)
        self.assertEqual(embed_spirv.without_contraction(expected), expected)

    def test_modules_that_are_none_are_errors(self):
        for words in (HEAD, HEAD + [0], HEAD + [9 << 16]):
            with self.assertRaises(embed_spirv.ToolError):
                embed_spirv.without_contraction(words)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "x.spv")
            path.write_bytes(b"\0" * 8)
            with self.assertRaises(embed_spirv.ToolError):
                embed_spirv.read_words(path)

    @unittest.skipIf(embed_spirv.missing_programs(), "other compilers")
    def test_a_shader_that_says_so_keeps_its_products(self):
        fused = 50  # of GLSL.std.450
        for comment, found in (("", True), ("// contraction: none", False)):
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                (folder / "x.comp").write_text(SHADER.format(comment=comment))
                words = embed_spirv.compiled(folder / "x.comp", ROOT, folder)
            instructions = [(op, words[at + 4]) for at, op, count
                            in embed_spirv.instructions(words) if count > 4]
            self.assertEqual((12, fused) in instructions, found)

    @unittest.skipIf(embed_spirv.missing_programs(), "other compilers")
    def test_a_shader_that_does_not_compile_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "x.comp").write_text("#version 450\nvoid main() { nothing(); }\n")
            with self.assertRaises(embed_spirv.ToolError):
                embed_spirv.compiled(folder / "x.comp", ROOT, folder)


class Header(unittest.TestCase):
    def test_words_stand_between_the_markers_in_the_order_of_names(self):
        block = embed_spirv.generated({"b": [1] * 9, "a": [2]})
        text = embed_spirv.embedded("before\n/* >>spirv */\nold\n/* >>end of spirv */\nafter", block)
        self.assertTrue(text.startswith("before\n/* >>spirv"))
        self.assertTrue(text.endswith("\n/* >>end of spirv */\nafter"))
        self.assertNotIn("old", text)
        self.assertLess(text.index("spirv_a[] = {\n    0x00000002,\n};"), text.index("spirv_b[]"))
        self.assertEqual(text.count("0x00000001,"), 9)
        self.assertEqual(embed_spirv.embedded(text, block), text)

    def test_a_header_without_markers_is_an_error(self):
        for text in ("", "/* >>spirv", "/* >>end of spirv */ /* >>spirv */"):
            with self.assertRaises(embed_spirv.ToolError):
                embed_spirv.embedded(text, "block")

    @unittest.skipIf(embed_spirv.missing_programs(), "other compilers")
    def test_stale_words_are_seen_and_renewed(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("tools", "shaders"):
                (root / name).mkdir()
            tool = root / "tools" / "embed_spirv.py"
            tool.write_text((ROOT / "tools" / "embed_spirv.py").read_text())
            (root / "shaders" / "x.comp").write_text(SHADER.format(comment="// header: hdrp_gpu_vk.h"))
            header = root / "hdrp_gpu_vk.h"
            header.write_text("/* >>spirv */\n/* >>end of spirv */\n")

            def status(*arguments):
                return subprocess.run([sys.executable, tool, *arguments], cwd=root,
                                      stdout=subprocess.DEVNULL).returncode
            self.assertEqual(status("--check"), 1)
            self.assertEqual(status(), 0)
            self.assertEqual(status("--check"), 0)
            header.write_text(header.read_text().replace("0x07230203", "0x07230204"))
            self.assertEqual(status("--check"), 1)


if __name__ == "__main__":
    unittest.main()
