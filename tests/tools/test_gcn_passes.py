#!/usr/bin/env python3
"""The probe of the passes notices every number that is no longer right, and registers too many."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import trees  # puts tools/ on the path

import gcn_passes
import gcn_probe

PROBE = trees.ROOT / "tools" / "gcn_passes.py"


class Passes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.headers = self.folder / "headers"
        self.headers.mkdir()
        for path in trees.ROOT.glob("hdrp_gpu_vk*.h"):
            shutil.copy(path, self.headers)
        for path in gcn_probe.RESULTS.glob("gcn_passes_*.csv"):
            shutil.copy(path, self.folder)

    def run_probe(self, *arguments, **environment):
        """Exit status and output."""
        result = subprocess.run(
            [sys.executable, PROBE, "--include", self.headers, "--results", self.folder, *arguments],
            capture_output=True, text=True, check=False, env=dict(os.environ, **environment))
        return result.returncode, result.stdout + result.stderr

    def expect(self, status, *arguments):
        found, output = self.run_probe(*arguments)
        if found == 77:
            self.skipTest(output)
        self.assertEqual(found, status, output)
        return output

    def recorded(self):
        return next(self.folder.glob("gcn_passes_*.csv"))

    def change(self, path, pattern, new):
        text, count = re.subn(pattern, new, path.read_text(), count=1, flags=re.M)
        self.assertEqual(count, 1, "the test changes a text that is not there")
        path.write_text(text)

    def test_recorded_numbers_are_what_is_measured(self):
        self.assertIn("2 passes are as measured", self.expect(0, "--check", "depth", "dispatch"))

    def test_half_precision_is_compiled_where_gpus_have_it(self):
        output = self.expect(0, "--half", "tone_map")
        self.assertRegex(output, r"tone_map +\d\d\d")
        self.assertNotIn("bonaire", output)
        self.assertNotEqual(output, self.expect(0, "tone_map"))

    def test_a_changed_number_is_noticed(self):
        self.change(self.recorded(), r"^depth,bonaire,\d+,", "depth,bonaire,7,")
        output = self.expect(1, "--check", "depth")
        self.assertIn("recorded: depth,bonaire,7,", output)
        self.assertRegex(output, r"measured: depth,bonaire,\d\d+,")

    def test_a_pass_that_is_not_recorded_is_noticed(self):
        self.change(self.recorded(), r"^depth,bonaire,.*\n", "")
        self.assertIn("recorded: nothing", self.expect(1, "--check", "depth"))

    def test_a_recorded_pass_that_is_gone_is_noticed(self):
        self.change(self.recorded(), r"^depth,bonaire,(.*)$",
                    r"depth,bonaire,\1\ngone,bonaire,\1")
        self.assertIn("measured: nothing", self.expect(1, "--check", "depth", "gone"))

    def test_a_shader_that_has_changed_is_noticed(self):
        text = (self.headers / "hdrp_gpu_vk_light.h").read_text()
        words = re.search(r"spirv_dispatch\[\] = \{([^}]*)\}", text)[1]
        self.change(self.headers / "hdrp_gpu_vk_cull.h", r"(spirv_depth\[\] = \{)[^}]*\}",
                    lambda match: match[1] + words + "}")
        self.assertIn("measured: depth,bonaire,", self.expect(1, "--check", "depth"))

    def test_other_versions_are_skipped(self):
        self.expect(0, "--check", "depth")
        self.change(self.recorded(), r"glslang \S+", "glslang 1:2.3,")
        status, output = self.run_probe("--check", "depth")
        self.assertEqual(status, 77, output)
        self.recorded().unlink()
        status, output = self.run_probe("--check", "depth")
        self.assertEqual(status, 77, output)
        self.assertIn("no numbers are recorded", output)

    def test_a_missing_driver_is_skipped(self):
        empty = str(self.folder)
        status, output = self.run_probe("--check", XDG_DATA_HOME=empty, XDG_CONFIG_DIRS=empty,
                                        SYSCONFDIR=empty, XDG_DATA_DIRS=empty)
        self.assertEqual(status, 77, output)

    def test_registers_beyond_the_limit_are_named_on_the_family_that_is_checked_alone(self):
        rows = [{"name": name, "family": family, "vgprs": vgprs}
                for name, family, vgprs in (("classify", "bonaire", 48), ("classify", "gfx1100", 72),
                                            ("cull_tiles", "bonaire", 52), ("fgd", "bonaire", 99))]
        self.assertEqual(gcn_passes.too_many(rows),
                         ["cull_tiles: 52 vector registers on bonaire, at most 48"])

    def test_every_family_and_every_embedded_shader_is_recorded(self):
        lines = [line.split(",")[:2] for line in self.recorded().read_text().splitlines()[1:]]
        shaders = [shader.name for shader in gcn_passes.embedded_shaders(trees.ROOT)]
        self.assertGreater(len(shaders), 15)
        names = [name for name in shaders if name != "deferred"]
        names += [f"deferred:{variant}" for variant in gcn_passes.VARIANTS]
        for name in names:
            for family in gcn_probe.FAMILIES:
                self.assertIn([name, family], lines)

    def test_kinds_are_those_of_the_header(self):
        text = (trees.ROOT / "hdrp_gpu_vk_oit.h").read_text()
        for kind, value in gcn_passes.KINDS["oit_composite"].items():
            self.assertRegex(text, rf"HDRP_I_GPU_VK_OIT_{kind.upper()} +{value}u")
        shader = next(shader for shader in gcn_passes.embedded_shaders(trees.ROOT)
                      if shader.name == "oit_composite")
        modules = dict(gcn_passes.modules_of(shader))
        self.assertEqual(len({tuple(words) for words in modules.values()}), 4)
        self.assertEqual(modules["oit_composite"],
                         gcn_passes.specialised(modules["oit_composite/talk"], 2, 0))

    def test_limits_are_of_passes_that_are_there(self):
        recorded = {line.split(",")[0] for line in self.recorded().read_text().splitlines()}
        self.assertEqual(set(gcn_passes.LIMITS) - recorded, set())

    def test_words_of_variants_are_those_of_the_header(self):
        text = (trees.ROOT / "hdrp_gpu_vk_light.h").read_text()
        everything = re.search(r"HDRP_GPU_VK_WORD_ALL +(\w+)u", text)[1]
        self.assertEqual(gcn_passes.VARIANTS["everything"], int(everything, 16))
        for name, word in (("LIT", gcn_passes.LIT), ("SHADOW", gcn_passes.ATLAS),
                           ("NEGATIVE", gcn_passes.NEGATIVE), ("SLICES", gcn_passes.SLICES),
                           ("DIRECTIONAL", gcn_passes.SUN), ("SHADOW_MASK", gcn_passes.MASK),
                           ("ENVIRONMENT", gcn_passes.SKY), ("SPLIT", gcn_passes.SPLIT)):
            bit = re.search(rf"HDRP_GPU_VK_WORD_{name} +\(1u << (\d+)\)", text)[1]
            self.assertEqual(word, 1 << int(bit), name)


if __name__ == "__main__":
    unittest.main()
