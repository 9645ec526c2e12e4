#!/usr/bin/env python3
"""Counts how many faults in the headers the tests notice: mutation_test.py FOLDER [--write].

FOLDER holds the programs that the build target `mutation` makes. Each fault is tried on the
registry first, then on the unit tests that pass its place. Fails when less than 90 % of the
constants, or of the operators, are noticed, and when a fault that nothing notices is not listed
in tests/mutation/survivors.txt with the reason why. --write adds those to the list, without one.
"""
import concurrent.futures
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import time
from collections import Counter

import hdrp_api

SURVIVORS = hdrp_api.ROOT / "tests/mutation/survivors.txt"
LEAST_NOTICED = 0.90
JOBS = 2
NO_REASON = "no reason yet"


def run_registry(folder):
    """The rows of the registry's program: one per fault."""
    parts = [folder / f"registry_{i}.csv" for i in range(JOBS)]
    running = [subprocess.Popen([folder / "mutation_registry", "--part", str(i), str(JOBS), part])
               for i, part in enumerate(parts)]
    if any([process.wait() for process in running]):
        sys.exit("mutation_test: the registry's program failed")
    rows = [row for part in parts for row in csv.DictReader(part.open())]
    return sorted(rows, key=lambda row: int(row["number"]))


def learn_unit_tests(folder):
    """[(seconds, program, faults whose places it passes)], the quickest first."""
    tests = []
    for program in sorted(folder.glob("mutation_test_*")):
        with tempfile.NamedTemporaryFile("r") as reached:
            start = time.monotonic()
            result = subprocess.run([program], capture_output=True,
                                    env={**os.environ, "HDRP_MUTANT_REACHED": reached.name})
            if result.returncode:
                sys.exit(f"mutation_test: {program.name} fails without any fault")
            tests.append((time.monotonic() - start, program,
                          {int(line) for line in reached.read().split()}))
    return sorted(tests, key=lambda test: test[0])


def ask_unit_tests(row, tests):
    """The first unit test that notices a fault, or ""."""
    number = int(row["number"])
    environment = {**os.environ, "HDRP_MUTANT": row["number"],
                   "HDRP_MUTANT_AMOUNT": row["amount"]}
    for seconds, program, reached in tests:
        if number in reached:
            try:
                result = subprocess.run([program], capture_output=True, env=environment,
                                        timeout=30 + 10 * seconds)
            except subprocess.TimeoutExpired:
                return program.name
            if result.returncode:
                return program.name
    return ""


def listed_survivors():
    """key -> reason."""
    lines = SURVIVORS.read_text().split("\n") if SURVIVORS.exists() else []
    return dict(line.split(": ", 1) for line in lines if line and not line.startswith("#"))


def report(rows, survivors):
    """Prints the count of each kind; True when enough faults were noticed."""
    enough = True
    for name, kinds in (("constants", {"constant"}), ("operators", {"sign", "comparison",
                                                                    "factor"})):
        group = [row for row in rows if row["kind"] in kinds]
        noticed = [row for row in group if row["noticed_by"]]
        by_registry = sum(not row["noticed_by"].startswith("mutation_test") for row in noticed)
        share = len(noticed) / max(1, len(group))
        enough = enough and share >= LEAST_NOTICED
        print(f"{name}: {len(noticed)} of {len(group)} faults noticed, {100 * share:.1f} %; "
              f"{by_registry} by the registry, {len(noticed) - by_registry} by unit tests")
        for header, total in sorted(Counter(row["header"] for row in group).items()):
            seen = sum(row["header"] == header for row in noticed)
            print(f"    {header:20} {seen:4} of {total:4}")
    for key in sorted(set(survivors)):
        print(f"survived: {key}")
    return enough


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.split("\n")[0])
    folder = pathlib.Path(sys.argv[1])
    rows = run_registry(folder)
    tests = learn_unit_tests(folder)
    left = [row for row in rows if not row["noticed_by"]]
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        for row, noticed in zip(left, pool.map(lambda row: ask_unit_tests(row, tests), left)):
            row["noticed_by"] = noticed
    with (folder / "mutation.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    survivors = [row["key"] for row in rows if not row["noticed_by"]]
    listed = listed_survivors()
    enough = report(rows, survivors)
    unlisted = [key for key in survivors if key not in listed]
    if "--write" in sys.argv and unlisted:
        with SURVIVORS.open("a") as file:
            file.writelines(f"{key}: {NO_REASON}\n" for key in unlisted)
    for key in unlisted:
        print(f"FAIL survives and is not listed: {key}")
    for key in sorted(set(listed) - set(survivors)):
        print(f"note: listed, but noticed by now or gone: {key}")
    return not enough or bool(unlisted)


if __name__ == "__main__":
    sys.exit(main())
