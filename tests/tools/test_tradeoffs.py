#!/usr/bin/env python3
"""The sections on light culling and on passes show what was recorded, and refuse what was not."""
import contextlib
import hashlib
import io
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import trees  # puts tools/ on the path

import tradeoffs

HEAD = ("picture,mix,lights,way,project_ms,depth_ms,build_ms,total_ms,us_per_added_light,"
        "ns_per_pair,pairs,pairs_over_exact,visits_over_true,two_jobs_speedup")
REMARK = "# AMD Test 7, gcc 1.2.3: one pinned core, medians; flags in bench/README.md"
WAYS = ("grid 17x9x24", "grid 17x9x24, fast", "grid 17x9x24, naive", "clusters 32x32x64",
        "clusters 32x32x64, fast", "tiles 16x16", "tiles 16x16, blocks", "tiles 16x16, no pixels")
# With matplotlib, where make tradeoffs asks for it.
PLOTTER = "/usr/bin/python3"
DRAW = """
import pathlib, sys
sys.path.insert(0, sys.argv[1])
import tradeoffs, tradeoffs_charts
tradeoffs_charts.IMAGES = pathlib.Path(sys.argv[3])
tradeoffs_charts.draw_culling(tradeoffs.cull_rows(pathlib.Path(sys.argv[2])))
"""

DEVICE = """# device: Test 9000, driver 7
height,lights,way,median_ms,least_ms
1080,10,"clusters, no depth",0.0711,0.06
1080,500,"clusters, no depth",0.123456,0.11
1080,500,tiles,0.25,0.24
"""


def results():
    """A file of results. A way has its own numbers, a larger picture other visits than them all."""
    lines = [REMARK, HEAD]
    for picture in ("1280x720", "1920x1080"):
        for mix in ("points", "half", "spots"):
            for lights in ("10", "500", "1000", "10000"):
                for i, way in enumerate(WAYS):
                    build = f"{(i + 1) / 100:g}" if lights == "1000" else "7"
                    exact = "" if lights == "10000" else "1.25"
                    visits = "7.7" if picture == "1920x1080" else f"1.{i}"
                    lines.append(f'{picture},{mix},{lights},"{way}",0.1,,{build},5{i},0.5,9,'
                                 f"3.6e+04,{exact},{visits},")
    return "\n".join(lines) + "\n"


class Page(unittest.TestCase):
    """A folder of results and a page that are for this test alone."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.page = self.folder / "tradeoffs.md"
        for path in tradeoffs.RESULTS.glob("*.csv"):
            if not path.name.startswith(("cull_cpu_", "gpu_")):
                shutil.copy(path, self.folder)
        for name, value in (("RESULTS", self.folder), ("DOCUMENT", self.page)):
            patch = mock.patch.object(tradeoffs, name, value)
            patch.start()
            self.addCleanup(patch.stop)

    def run_tool(self, *arguments):
        """What the program ends with: None when it is content."""
        with mock.patch.object(sys, "argv", ["tradeoffs.py", *arguments]), \
                contextlib.redirect_stderr(io.StringIO()):
            try:
                tradeoffs.main()
            except SystemExit as end:
                return end.code
        return None


class Culling(Page):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "cull_cpu_amd-test-7.csv"

    def write(self, old="", new="", count=1):
        text = results()
        self.assertIn(old, text, "the test changes a text that is not there")
        self.file.write_text(text.replace(old, new, count) if old else text)

    def section(self):
        found = tradeoffs.cull_rows(self.file)
        return tradeoffs.culling(mock.Mock(cull_file=self.file, cull=found))

    def refused(self, *change):
        """The message with which changed results are refused."""
        self.write(*change)
        with self.assertRaises(SystemExit) as caught:
            tradeoffs.cull_rows(self.file)
        message = str(caught.exception)
        self.assertIn(self.file.name, message)
        return message

    def test_without_results_the_page_has_no_such_section(self):
        self.assertIsNone(self.run_tool())
        text = self.page.read_text()
        self.assertNotIn("## Light culling", text)
        self.assertNotIn("culling.svg", text)
        self.assertIn("\n\n## Skies\n", text)

    def test_a_page_that_is_stale_is_noticed(self):
        self.assertIsNone(self.run_tool())
        self.assertIsNone(self.run_tool("--check"))
        self.write()
        self.assertIn("not what the measurements say", self.run_tool("--check"))
        self.assertIsNone(self.run_tool())
        self.assertIsNone(self.run_tool("--check"))
        text = self.page.read_text()
        self.assertEqual(text.count("\n## Light culling\n"), 1)
        self.assertIn(f"\n- {REMARK[2:]}\n", text)
        self.write("spots,1000,\"tiles 16x16\",0.1,,0.06", "spots,1000,\"tiles 16x16\",0.1,,0.08")
        self.assertIn("not what the measurements say", self.run_tool("--check"))

    def test_every_way_stands_with_what_was_measured_and_a_dash_for_what_was_not(self):
        row = 'half,1000,"grid 17x9x24, fast",0.1,,0.02,51,0.5,9,3.6e+04,1.25,1.1,'
        self.write(row, row + "1.83")
        text = self.section()
        self.assertIn("the machine: AMD Test 7, gcc 1.2.3.\n", text)
        for mix in ("points", "half", "spots"):
            for i, way in enumerate(WAYS):
                jobs = "1.83" if (mix, i) == ("half", 1) else "–"
                self.assertIn(f"| {mix} | `{way}` | {(i + 1) / 100:g} | 5{i} | 1.25 | "
                              f"{tradeoffs.shown(f'1.{i}')} | {jobs} |\n", text)
        self.assertNotIn("7.7", text, "of another size of picture")

    def test_what_to_take_has_the_times_and_visits_of_its_way(self):
        self.write('points,1000,"clusters 32x32x64",0.1,,0.04,53,0.5,9,3.6e+04,1.25,1.3,',
                   'points,1000,"clusters 32x32x64",0.1,,0.04,6.54,0.5,9,3.6e+04,1.25,1.56,')
        self.assertIn("| `clusters 32x32x64` | 6.54 | 1.56 | 53 | 1.3 |\n", self.section())

    def test_times_stand_over_numbers_of_lights_in_their_order(self):
        self.write('points,10000,"tiles 16x16",0.1,,7,55', 'points,10000,"tiles 16x16",0.1,,7,812')
        text = self.section()
        self.assertIn("| lights | way | 10 | 500 | 1000 | 10000 |\n", text)
        self.assertIn("| points | `tiles 16x16` | 55 | 55 | 55 | 812 |\n", text)

    def test_every_flag_is_explained(self):
        self.write()
        text = self.section()
        for flag in ("FAST", "PIXELS", "BLOCKS", "MASKS"):
            self.assertIn(f"\n- `HDRP_CULL_{flag}` ", text)

    def test_a_column_that_is_missing_or_new_is_refused_by_name(self):
        self.assertIn("has no column build_ms", self.refused("build_ms,", "built_ms,"))
        self.assertIn("has no column visits_over_true", self.refused("visits_over_true", "visits"))
        self.assertIn("has an unknown column more", self.refused(HEAD, HEAD + ",more"))
        self.assertIn("has no column mix", self.refused("picture,mix,", "picture,"))

    def test_a_cell_that_is_no_number_is_refused_with_its_place(self):
        place = "1280x720, points, 10 lights, grid 17x9x24"
        for word in ("fast", "-1", "nan", "1.2.3"):
            with self.subTest(word):
                self.assertIn(f"{place}: build_ms is no number but '{word}'",
                              self.refused(",,7,", f",,{word},"))
        self.assertIn("lights is no number but ''", self.refused("points,10,", "points,,"))
        self.assertIn("fewer cells", self.refused("1.25,1.0,\n", "1.25,1.0\n"))
        self.assertIn("more or", self.refused("1.25,1.0,\n", "1.25,1.0,,\n"))

    def test_a_way_that_the_page_needs_must_be_there_in_each_mix(self):
        self.assertIn("1280x720, spots, 1000 lights, clusters 32x32x64",
                      self.refused('1280x720,spots,1000,"clusters 32x32x64"',
                                   '1280x720,spots,1000,"bins"'))
        self.assertIn("1280x720, points, 1000 lights, grid 17x9x24",
                      self.refused('points,1000,"grid 17x9x24",0.1,,0.01,',
                                   'points,1000,"grid 17x9x24",0.1,,,'))
        self.file.write_text(REMARK + "\n" + HEAD + "\n")
        with self.assertRaisesRegex(SystemExit, "has no rows"):
            tradeoffs.cull_rows(self.file)

    def test_ways_that_the_page_names_are_those_of_the_benchmark(self):
        source = (trees.ROOT / "bench/bench_cull.c").read_text()
        for way in (*tradeoffs.CULL_MAIN, *tradeoffs.CULL_TAKE):
            self.assertIn(f'add_way("{way}",', source)
        for column in tradeoffs.CULL_WORDS + tradeoffs.CULL_NUMBERS:
            self.assertIn(column, source)

    def test_results_of_no_machine_are_refused(self):
        self.assertIn("machine", self.refused(REMARK + "\n", ""))

    def test_a_chart_of_the_same_numbers_is_the_same_file_and_names_every_way(self):
        if not shutil.which(PLOTTER) or subprocess.run([PLOTTER, "-c", "import matplotlib"],
                                                       capture_output=True, check=False).returncode:
            self.skipTest("no matplotlib")
        self.write()
        charts = []
        for _ in range(2):
            subprocess.run([PLOTTER, "-c", DRAW, trees.ROOT / "tools", self.file, self.folder],
                           check=True)
            charts.append((self.folder / "tradeoffs_culling.svg").read_bytes())
        self.assertEqual(*(hashlib.sha256(chart).hexdigest() for chart in charts))
        for mix in ("points", "spots"):
            self.assertIn(f"<!-- 1000 {mix}: hollow with HDRP_CULL_FAST -->".encode(), charts[0])
        for way in WAYS:
            named = 0 if way.endswith(", fast") else 2
            self.assertEqual(charts[0].count(f"<!-- {way} -->".encode()), named, way)
        self.assertIn("(images/tradeoffs_culling.svg)", self.section())


class Passes(Page):
    def setUp(self):
        super().setUp()
        self.file = next(self.folder.glob("gcn_passes_*.csv"))
        self.device = self.folder / "gpu_test-9000.csv"

    def section(self):
        return tradeoffs.gpu_passes(tradeoffs.Data())

    def change(self, pattern, new):
        text, count = re.subn(pattern, new, self.file.read_text(), count=1, flags=re.M)
        self.assertEqual(count, 1, "the test changes a text that is not there")
        self.file.write_text(text)

    def test_without_results_the_page_has_no_such_section(self):
        self.file.unlink()
        self.assertIsNone(self.run_tool())
        self.assertNotIn("## Passes on the GPU", self.page.read_text())
        self.assertIn("\n\n## Skies\n", self.page.read_text())

    def test_a_pass_stands_with_all_of_one_family_and_the_registers_of_the_others(self):
        self.change("^depth,bonaire,.*$", "depth,bonaire,101,102,103,104,5,6")
        self.change("^depth,vega10,.*$", "depth,vega10,1,202,3,4,7,5")
        self.change("^depth,gfx1100,.*$", "depth,gfx1100,1,302,3,4,8,5")
        self.assertIn("| `depth` | 101 | 102 | 103 | 104 | 5 | 6 | 202 | 7 | 302 | 8 |\n",
                      self.section())

    def test_a_variant_stands_with_what_it_adds_to_the_plain_one(self):
        self.change("^deferred:punctual,bonaire,.*$", "deferred:punctual,bonaire,1000,40,3,4,5,6")
        self.change("^deferred:punctual.sun,bonaire,.*$",
                    "deferred:punctual+sun,bonaire,990,48,3,4,5,6")
        text = self.section()
        self.assertIn("| `punctual+sun` | -10 | +8 | 990 | 48 |", text)
        self.assertIn("| `punctual` |  |  | 1000 | 40 |", text)
        self.assertRegex(text, r"\| `everything` \|  \|  \| ")

    def test_every_pass_that_is_recorded_is_shown_once(self):
        text = self.section()
        names = {line.split(",")[0] for line in self.file.read_text().splitlines()
                 if ",bonaire," in line}
        self.assertGreater(len(names), 30)
        for name in names:
            self.assertEqual(text.count(f"| `{name.split(':')[-1]}` |"), 1, name)

    def test_times_of_a_device_stand_over_numbers_of_lights(self):
        self.assertNotIn("Milliseconds of the building", self.section())
        self.device.write_text(DEVICE)
        text = self.section()
        self.assertIn("\nTest 9000, driver 7:\n\n| rows of pixels | way | 10 | 500 |\n", text)
        self.assertIn("| 1080 | `clusters, no depth` | 0.0711 | 0.123 |\n", text)
        self.assertIn("| 1080 | `tiles` | – | 0.25 |\n", text)

    def test_a_page_that_is_stale_is_noticed(self):
        self.device.write_text(DEVICE)
        self.assertIsNone(self.run_tool())
        self.assertEqual(self.page.read_text().count("\n## Passes on the GPU\n"), 1)
        self.assertIsNone(self.run_tool("--check"))
        self.device.write_text(DEVICE.replace("0.25", "0.26"))
        self.assertIn("not what the measurements say", self.run_tool("--check"))
        self.device.write_text(DEVICE)
        self.change("^depth,gfx1100,.*$", "depth,gfx1100,1,2,3,4,5,6")
        self.assertIn("not what the measurements say", self.run_tool("--check"))

    def test_what_the_benchmark_does_not_write_is_refused(self):
        for old, new, message in (("# device: ", "# ", "names the device"),
                                  ("0.123456", "fast", "median_ms is no number but 'fast'"),
                                  ("way,", "ways,", "the columns are not"),
                                  ('"clusters, no depth"', "clusters, no depth", "the columns"),
                                  (",0.24", "", "the columns are not")):
            with self.subTest(new):
                self.device.write_text(DEVICE.replace(old, new))
                self.assertIn(message, self.run_tool())
                self.assertIn(self.device.name, self.run_tool())

    def test_columns_are_those_of_the_benchmark(self):
        source = (trees.ROOT / "bench/bench_gpu.c").read_text()
        self.assertIn("# device: %s\\n" + ",".join(tradeoffs.DEVICE_COLUMNS) + "\\n", source)


if __name__ == "__main__":
    unittest.main()
