#!/usr/bin/env python3
"""A record of the full sweeps that does not fit the sources is found."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "tools" / "exhaustive_check.py"
HEAD = ("name,domain,count,worst_error,worst_input,mean,unit,non_finite,non_finite_outside,id,"
        "claim\n")
SUBSET = HEAD + ("hdrp_a,0 to 1,100,0.0019,0.5,0.001,relative,0,0,a,0.002\n"
                 "hdrp_b,every float,100,,,,,0,3,,\n")
FULL = HEAD + ("hdrp_a,0 to 1,9000,0.002,0.25,0.001,relative,0,0,a,0.002\n"
               "hdrp_b,every float,4294967296,,,,,0,30,,\n")


class ExhaustiveCheck(unittest.TestCase):
    def check(self, subset=SUBSET, full=FULL):
        with tempfile.TemporaryDirectory() as folder:
            paths = [pathlib.Path(folder) / name for name in ("subset.csv", "recorded.csv")]
            for path, text in zip(paths, (subset, full)):
                if text is not None:
                    path.write_text(text)
            result = subprocess.run([sys.executable, PROGRAM, *paths], capture_output=True,
                                    text=True, check=False)
        return result.returncode, result.stdout + result.stderr

    def fails(self, message, **files):
        status, output = self.check(**files)
        self.assertEqual(status, 1, output)
        self.assertIn(message, output)

    def test_a_record_that_fits_passes(self):
        self.assertEqual(self.check()[0], 0)

    def test_a_missing_record_fails(self):
        self.fails("recorded.csv is missing", full=None)

    def test_a_new_sweep_fails(self):
        self.fails("hdrp_c every float: not in the record",
                   subset=SUBSET + "hdrp_c,every float,100,,,,,0,3,,\n")

    def test_a_sweep_that_is_gone_fails(self):
        self.fails("hdrp_c every float: in the record, but not swept",
                   full=FULL + "hdrp_c,every float,100,,,,,0,3,,\n")

    def test_a_changed_claim_fails(self):
        self.fails("claim is 0.003, recorded as 0.002", subset=SUBSET.replace("a,0.002", "a,0.003"))

    def test_a_record_that_breaks_a_claim_fails(self):
        self.fails("more than the claim 0.002", full=FULL.replace("9000,0.002", "9000,0.00203"))

    def test_a_record_with_bad_results_fails(self):
        self.fails("7 results of the full run are not good",
                   full=FULL.replace("relative,0,0", "relative,7,0"))

    def test_a_subset_that_is_worse_than_the_full_run_fails(self):
        self.fails("the subset found 0.0019, the full run only 0.0018",
                   full=FULL.replace("9000,0.002", "9000,0.0018"))


if __name__ == "__main__":
    unittest.main()
