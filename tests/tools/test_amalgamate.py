#!/usr/bin/env python3
"""One-file headers hold what they need once, what is needed first, and are the same every time."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import amalgamate  # noqa: E402
import hdrp_api  # noqa: E402


class Amalgamate(unittest.TestCase):
    def test_the_order_follows_the_includes_and_each_header_comes_once(self):
        texts = {"hdrp_math.h": "", "hdrp_a.h": '#include "hdrp_b.h"\n#include "hdrp_math.h"\n',
                 "hdrp_b.h": '#include "hdrp_math.h"\n'}
        self.assertEqual(amalgamate.in_order("hdrp_a.h", texts, []),
                         ["hdrp_math.h", "hdrp_b.h", "hdrp_a.h"])

    def test_a_circle_and_a_missing_header_are_errors(self):
        circle = {"hdrp_a.h": '#include "hdrp_b.h"\n', "hdrp_b.h": '#include "hdrp_a.h"\n'}
        for texts in (circle, {"hdrp_a.h": '#include "hdrp_b.h"\n'}):
            with self.assertRaises(SystemExit):
                amalgamate.in_order("hdrp_a.h", texts, [])

    def test_every_module_gets_a_file_without_includes_of_ours(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "hdrp_gone.h").write_text("a module of an earlier version")
            contents = []
            for _ in range(2):
                subprocess.run([sys.executable, ROOT / "tools" / "amalgamate.py", folder],
                               check=True, capture_output=True)
                contents.append({path.name: path.read_text() for path in folder.iterdir()})
        self.assertEqual(contents[0], contents[1])
        modules = {path.name for path in hdrp_api.headers()}
        self.assertEqual(set(contents[0]), modules | {"hdrp.h"})
        for name, text in contents[0].items():
            self.assertIsNone(re.search(r'^\s*#\s*include\s+"', text, re.M), name)
            self.assertIn("Permission is hereby granted", text[-1200:])
        for module in modules:
            guard = "#ifndef " + module.upper().replace(".", "_") + "\n"
            self.assertEqual(contents[0][module].count(guard), 1, module)
            expected = not module.startswith("hdrp_gpu_vk")
            self.assertEqual(contents[0]["hdrp.h"].count(guard), expected, module)


if __name__ == "__main__":
    unittest.main()
