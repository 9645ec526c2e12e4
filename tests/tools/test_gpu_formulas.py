#!/usr/bin/env python3
"""The comparison of formulas on a device notices what it is there to notice."""
import contextlib
import io
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "gpu"))
import formulas  # noqa: E402

COLUMNS = ["function", "results", "equal", "ulp_1", "ulp_4", "ulp_64", "ulp_1024", "beyond",
           "different", "far", "denormals", "worst"]


def row(name, **changed):
    return {**dict.fromkeys(COLUMNS, "0"), "function": name, "worst": "",
            **{column: str(value) for column, value in changed.items()}}


class Formulas(unittest.TestCase):
    def test_a_table_as_recorded_is_right(self):
        rows = [row("hdrp_a", equal=3), row("hdrp_b", beyond=1)]
        self.assertEqual(formulas.problems(rows, rows, {"hdrp_b": "why"}), [])

    def test_another_number_or_formula_than_recorded_fails(self):
        recorded = [row("hdrp_a", equal=3)]
        self.assertEqual(len(formulas.problems([row("hdrp_a", ulp_1=3)], recorded, {})), 1)
        self.assertEqual(len(formulas.problems(recorded + [row("hdrp_b")], recorded, {})), 1)
        self.assertEqual(len(formulas.problems([], recorded, {})), 1)

    def test_what_is_off_needs_a_reason(self):
        for column in ("beyond", "different", "far"):
            rows = [row("hdrp_a", **{column: 1})]
            self.assertEqual(len(formulas.problems(rows, rows, {})), 1)
            self.assertEqual(formulas.problems(rows, rows, {"hdrp_a": "why"}), [])

    def test_a_reason_for_nothing_fails(self):
        rows = [row("hdrp_a", equal=1)]
        self.assertEqual(len(formulas.problems(rows, rows, {"hdrp_a": "why"})), 1)
        self.assertEqual(len(formulas.problems(rows, rows, {"hdrp_gone": "why"})), 1)

    def test_another_driver_may_differ_but_not_by_far(self):
        recorded = None
        self.assertEqual(formulas.problems([row("hdrp_a", beyond=1)], recorded, {}), [])
        self.assertEqual(len(formulas.problems([row("hdrp_a", far=1)], recorded, {})), 1)
        self.assertEqual(formulas.problems([row("hdrp_a")], recorded, {"hdrp_a": "why"}), [])

    def test_a_record_is_named_by_device_and_version(self):
        path = formulas.record_path("llvmpipe (LLVM 15.0.6), llvmpipe, Mesa 22.3.6 (LLVM)")
        self.assertEqual(path.name, "formulas_llvmpipe-22.3.6.csv")

    def test_another_driver_is_not_compared_with_the_record(self):
        for driver in ("llvmpipe, Mesa 22.3.6", "other 1.2"):
            with contextlib.redirect_stdout(io.StringIO()) as said:
                status = formulas.judge(driver, "# another", [",".join(COLUMNS)], False)
            self.assertEqual(status, 1)  # the reasons name formulas that are not in the table
            self.assertRegex(said.getvalue(), "is for|nothing is recorded")


if __name__ == "__main__":
    unittest.main()
