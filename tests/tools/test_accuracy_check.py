#!/usr/bin/env python3
"""Broken and stale claims are told from good ones, over the worst family."""
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


if __name__ == "__main__":
    unittest.main()
