#!/usr/bin/env python3
"""Broken and stale claims are told from good ones, over the worst family, and digits that moved
from those that were recorded."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "tools" / "accuracy_check.py"
HEAD = "id,function,unit,claim,max,mean,count,non_finite\n"


class AccuracyCheck(unittest.TestCase):
    def check(self, *families):
        """Exit status and output for one CSV per family, each a list of rows."""
        with tempfile.TemporaryDirectory() as folder:
            names = [f"family{i}" for i in range(len(families))]
            for name, rows in zip(names, families):
                (pathlib.Path(folder) / f"{name}.csv").write_text(HEAD + "\n".join(rows) + "\n")
            result = subprocess.run([sys.executable, PROGRAM, folder, *names], capture_output=True,
                                    text=True, check=False)
        return result.returncode, result.stdout + result.stderr

    def verdict(self, unit, claim, measured, non_finite=0):
        status, output = self.check([f"x,hdrp_x,{unit},{claim},{measured},0,10,{non_finite}"])
        word = next(line for line in output.splitlines() if " x " in line).split()[0]
        self.assertEqual(status != 0, word != "ok", output)
        return word

    def test_a_claim_holds_up_to_twice_the_measurement(self):
        self.assertEqual(self.verdict("relative", 2e-3, 2e-3), "ok")
        self.assertEqual(self.verdict("relative", 2e-3, 1e-3), "ok")
        self.assertEqual(self.verdict("relative", 2e-3, 0.99e-3), "STALE")
        self.assertEqual(self.verdict("relative", 2e-3, 2.01e-3), "BROKEN")

    def test_a_result_that_is_not_finite_breaks_a_claim(self):
        self.assertEqual(self.verdict("absolute", 2e-3, 2e-3, non_finite=1), "BROKEN")

    def test_four_ulp_are_never_stale(self):
        for unit, floor in (("relative", 2.38e-7), ("absolute", 2.38e-7), ("degrees", 1.36e-5),
                            ("ulp", 4)):
            with self.subTest(unit=unit):
                self.assertEqual(self.verdict(unit, floor, 0), "ok")
                self.assertEqual(self.verdict(unit, 1.1 * floor, 0), "STALE")

    def test_the_worst_family_decides(self):
        row = "x,hdrp_x,relative,0.01,{},0,10,0"
        status, output = self.check([row.format(0.001)], [row.format(0.006)], [row.format(0.002)])
        self.assertEqual(status, 0, output)
        self.assertIn("family1", output)
        status, output = self.check([row.format(0.001)], [row.format(0.011)])
        self.assertEqual(status, 1, output)

    def test_families_of_different_claims_are_refused(self):
        row = "{},hdrp_x,relative,0.01,0.01,0,10,0"
        status, output = self.check([row.format("x")], [row.format("y")])
        self.assertNotEqual(status, 0)
        self.assertIn("other claims", output)


class AccuracyRecord(unittest.TestCase):
    """The record of two families, and what happens when something is not as it says."""
    ORIGINS = ("gcc 12.2.0, glibc 2.36 on x86-64 with FMA", "clang 14.0.6, glibc 2.36 on x86-64 "
               "with FMA")
    ROWS = ["b,hdrp_b,relative,0.01,0.0061249,0.0012351,10,0", "a,hdrp_a,ulp,4,1.5,0.25,10,0"]

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.recorded = self.folder / "recorded.csv"
        for name, origin in zip(("gcc", "clang"), self.ORIGINS):
            self.write(name, origin, self.ROWS)
        self.run_tool("--record")

    def write(self, name, origin, rows):
        (self.folder / f"{name}.csv").write_text(f"# {origin}\n{HEAD}" + "\n".join(rows) + "\n")

    def run_tool(self, *arguments, families=("gcc", "clang")):
        result = subprocess.run([sys.executable, PROGRAM, "--recorded", self.recorded, *arguments,
                                 self.folder, *families], capture_output=True, text=True,
                                check=False)
        return result.returncode, result.stdout + result.stderr

    def change(self, name, old, new):
        path = self.folder / f"{name}.csv"
        text = path.read_text()
        self.assertIn(old, text)
        path.write_text(text.replace(old, new))

    def test_the_record_is_sorted_and_has_three_digits(self):
        self.assertEqual(self.recorded.read_text().splitlines(), [
            f"# gcc: {self.ORIGINS[0]}", f"# clang: {self.ORIGINS[1]}",
            "id,function,unit,claim,gcc_max,gcc_mean,clang_max,clang_mean",
            "a,hdrp_a,ulp,4,1.5,0.25,1.5,0.25",
            "b,hdrp_b,relative,0.01,0.00612,0.00124,0.00612,0.00124"])

    def test_what_was_just_recorded_passes(self):
        status, output = self.run_tool()
        self.assertEqual(status, 0, output)
        self.assertIn("2 of 2 recorded families compared, 0 values moved", output)

    def test_a_change_below_three_digits_passes(self):
        self.change("gcc", "0.0061249", "0.0061151")
        self.assertEqual(self.run_tool()[0], 0)

    def test_a_largest_error_that_moves_fails(self):
        self.change("gcc", "0.0061249", "0.0061251")
        status, output = self.run_tool()
        self.assertEqual(status, 1, output)
        self.assertIn("MOVED  b: max of gcc is 0.00613, recorded as 0.00612", output)

    def test_a_mean_that_moves_fails(self):
        self.change("clang", "0.25", "0.249")
        status, output = self.run_tool()
        self.assertEqual(status, 1, output)
        self.assertIn("MOVED  a: mean of clang is 0.249, recorded as 0.25", output)

    def test_a_claim_that_is_not_the_recorded_one_fails(self):
        for name in ("gcc", "clang"):
            self.change(name, "relative,0.01,", "relative,0.012,")
        status, output = self.run_tool()
        self.assertEqual(status, 1, output)
        self.assertIn("MOVED  b: claim is 0.012, recorded as 0.01", output)

    def test_a_claim_without_a_record_fails(self):
        for name, origin in zip(("gcc", "clang"), self.ORIGINS):
            self.write(name, origin, self.ROWS + ["c,hdrp_c,ulp,4,1,0.5,10,0"])
        status, output = self.run_tool()
        self.assertEqual(status, 1, output)
        self.assertIn("MOVED  c: measured, but not recorded", output)

    def test_a_record_without_a_claim_fails(self):
        for name, origin in zip(("gcc", "clang"), self.ORIGINS):
            self.write(name, origin, self.ROWS[:1])
        status, output = self.run_tool()
        self.assertEqual(status, 1, output)
        self.assertIn("MOVED  a: recorded, but not measured", output)

    def test_another_compiler_or_libc_is_not_compared(self):
        for old, new in (("gcc 12.2.0", "gcc 13.1.0"), ("glibc 2.36", "glibc 2.40"),
                         ("with FMA", "without FMA")):
            with self.subTest(new=new):
                self.write("gcc", self.ORIGINS[0].replace(old, new), self.ROWS)
                self.change("gcc", "0.0061249", "0.0071")
                status, output = self.run_tool()
                self.assertEqual(status, 0, output)
                self.assertIn("not compared: gcc is of " + self.ORIGINS[0].replace(old, new),
                              output)
                self.assertIn("1 of 2 recorded families compared", output)

    def test_an_absent_family_is_left_out_with_a_word(self):
        status, output = self.run_tool(families=("gcc",))
        self.assertEqual(status, 0, output)
        self.assertIn("not compared: clang is recorded, but was not built here", output)

    def test_recording_loses_no_family(self):
        status, output = self.run_tool("--record", families=("gcc",))
        self.assertNotEqual(status, 0)
        self.assertIn("clang would be lost", output)

    def test_nothing_is_recorded_while_a_claim_is_wrong(self):
        before = self.recorded.read_text()
        self.change("gcc", "0.0061249", "0.02")
        status, output = self.run_tool("--record")
        self.assertNotEqual(status, 0)
        self.assertIn("while a claim is wrong", output)
        self.assertEqual(self.recorded.read_text(), before)

    def test_a_missing_record_fails(self):
        self.recorded.unlink()
        status, output = self.run_tool()
        self.assertEqual(status, 1, output)
        self.assertIn("accuracy_record", output)


if __name__ == "__main__":
    unittest.main()
