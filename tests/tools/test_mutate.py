#!/usr/bin/env python3
"""Faults are written where they belong, switched on one at a time, noticed and counted."""
import contextlib
import io
import os
import pathlib
import subprocess
import tempfile
import unittest
from unittest import mock

import trees  # puts tools/ on the path

import mutate
import mutation_test

HEADER = '''#define HDRP_FN static inline
#define HDRP_HALF 0.5f

HDRP_FN float hdrp_max(float a, float b)
{
    return a > b ? a : b;
}

HDRP_FN float hdrp_scaled(float x)
{
    float low = x < 1e-6f ? 1e-6f : x;
    return 0.25f * hdrp_max(-1.0f, low) + HDRP_HALF - 2.5e-3f;
}
'''
PROGRAM = '''#include "hdrp_math.h"
int main(void)
{
    float error = hdrp_scaled(4.0f) - 1.4975f;
    return error > 1e-5f || error < -1e-5f;
}
'''


def mutants_of(header, exclusions, folder):
    path = pathlib.Path(folder) / "hdrp_math.h"
    path.write_text(header)
    return mutate.write_mutants(pathlib.Path(folder) / "out", [path],
                                mutate.Exclusions(exclusions))


class Mutate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def keys(self, header=HEADER, exclusions="", kind="constant"):
        return {m.key for m in mutants_of(header, exclusions, self.folder) if m.kind == kind}

    def test_every_literal_is_found_but_limits(self):
        self.assertEqual(self.keys(), {"HDRP_HALF 0.5f 1", "hdrp_scaled 0.25f 1",
                                       "hdrp_scaled 1e-6f 1", "hdrp_scaled 1e-6f 2",
                                       "hdrp_scaled 2.5e-3f 1"})

    def test_a_factor_within_an_argument_is_no_limit(self):
        header = HEADER.replace("-1.0f, low", "-1.0f * x, low")
        self.assertIn("hdrp_scaled 1.0f 1", self.keys(header))
        header = HEADER.replace("-1.0f, low", "hdrp_scaled(1.0f), low")
        self.assertIn("hdrp_scaled 1.0f 1", self.keys(header))

    def test_what_is_named_is_left_out(self):
        self.assertEqual(self.keys(exclusions="guard hdrp_scaled 1e-6f 2  # why"),
                         self.keys() - {"hdrp_scaled 1e-6f 2"})
        self.assertEqual(self.keys(exclusions="guard hdrp_scaled 1e-6f"),
                         self.keys() - {"hdrp_scaled 1e-6f 1", "hdrp_scaled 1e-6f 2"})
        self.assertEqual(self.keys(exclusions="limit hdrp_scaled"), {"HDRP_HALF 0.5f 1"})

    def test_a_coarse_constant_is_changed_by_more(self):
        mutants = mutants_of(HEADER, "coarse hdrp_scaled", self.folder)
        amounts = {m.key: m.amount for m in mutants if m.kind == "constant"}
        self.assertEqual(amounts["hdrp_scaled 0.25f 1"], 1e-2)
        self.assertEqual(amounts["HDRP_HALF 0.5f 1"], 1e-3)
        self.assertNotIn("hdrp_scaled 1.0f 1", amounts)

    def test_names_and_words_that_match_nothing_are_told(self):
        excluded = mutate.Exclusions("guard hdrp_scaled 1e-6f 2\nguard hdrp_gone\n")
        path = self.folder / "hdrp_math.h"
        path.write_text(HEADER)
        mutate.write_mutants(self.folder / "out", [path], excluded)
        self.assertEqual(excluded.unused(), ["hdrp_gone"])
        with self.assertRaises(SystemExit):
            mutate.Exclusions("because hdrp_scaled")

    def test_each_fault_changes_the_result_and_none_does_not(self):
        with mock.patch.dict(mutate.SAMPLED, {kind: 1 for kind in mutate.SAMPLED}):
            mutants = mutants_of(HEADER, "guard hdrp_scaled 1e-6f", self.folder)
        source, program = self.folder / "out/program.c", self.folder / "program"
        source.write_text(PROGRAM)
        support = trees.ROOT / "tests/mutation"
        subprocess.run(["gcc", "-std=c11", "-I", support, source, support / "from_environment.c",
                        "-o", program], check=True)

        def noticed(number, amount):
            environment = {**os.environ, "HDRP_MUTANT": str(number),
                           "HDRP_MUTANT_AMOUNT": str(amount)}
            return subprocess.run([program], env=environment).returncode != 0

        self.assertFalse(noticed(0, 1e-3))
        unnoticed = {m.key for i, m in enumerate(mutants) if not noticed(i + 1, m.amount)}
        # A sign that no argument of the program depends on, and what 1e-5 does not see.
        self.assertEqual(unnoticed, {"hdrp_scaled - 1", "hdrp_scaled 2.5e-3f 1"})


class Count(unittest.TestCase):
    def rows(self, noticed, survived, kind="constant"):
        row = {"header": "hdrp_math.h", "kind": kind, "key": "hdrp_x 1.0f 1"}
        return [{**row, "noticed_by": "x"}] * noticed + \
            [{**row, "key": "hdrp_y 2.0f 1", "noticed_by": ""}] * survived

    def quietly(self, function, *arguments):
        with contextlib.redirect_stdout(io.StringIO()):
            return function(*arguments)

    def test_nine_of_ten_are_enough(self):
        self.assertEqual(self.quietly(mutation_test.report,
                                      self.rows(9, 1) + self.rows(9, 1, "sign")), [])
        self.assertEqual(len(self.quietly(mutation_test.report,
                                          self.rows(89, 11) + self.rows(9, 1, "sign"))), 1)
        self.assertEqual(len(self.quietly(mutation_test.report,
                                          self.rows(9, 1) + self.rows(89, 11, "sign"))), 1)

    def test_each_header_needs_its_share(self):
        rows = self.rows(100, 0) + self.rows(9, 0, "sign")
        rows += [{**row, "header": "hdrp_pack.h"} for row in self.rows(8, 2)]
        self.assertEqual(len(self.quietly(mutation_test.report, rows)), 1)

    def test_a_survivor_needs_a_reason(self):
        rows, key = self.rows(9, 1), "hdrp_y 2.0f 1"
        for listed, failures in (({}, 1), ({key: mutation_test.NO_REASON}, 1), ({key: "why"}, 0)):
            self.assertEqual(len(self.quietly(mutation_test.check_survivors, rows, listed, False)),
                             failures)


if __name__ == "__main__":
    unittest.main()
