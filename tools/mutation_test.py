#!/usr/bin/env python3
"""Counts how many faults in the headers the tests notice: mutation_test.py FOLDER [--write]
[--only TEXT].

FOLDER holds the programs that the build target `mutation` makes. Each fault is tried on the
registry first, then on the unit tests that pass its place. Fails when less than 90 % of the
constants, or of the operators, are noticed, or 85 % of the constants of one header, and when a
fault that nothing notices is not listed in tests/mutation/survivors.txt with the reason why.
--write adds those to the list, without a reason. --only tries faults whose header or key holds a
text, and asks for no share.
"""
import argparse
import concurrent.futures
import csv
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
from collections import Counter

import hdrp_api

SURVIVORS = hdrp_api.ROOT / "tests/mutation/survivors.txt"
LEAST_NOTICED, LEAST_OF_A_HEADER = 0.90, 0.85
JOBS = 2
# A test of more CPU seconds is not run for every fault: those that integrate over hemispheres.
SLOWEST = 10
NO_REASON = "no reason yet"
OPERATORS = ("sign", "comparison", "factor")


def run_registry(folder, only):
    """The rows of the registry's program: one per fault."""
    parts = [folder / f"registry_{i}.csv" for i in range(JOBS)]
    running = [subprocess.Popen([folder / "mutation_registry", "--part", str(i), str(JOBS),
                                 "--only", only, part]) for i, part in enumerate(parts)]
    if any([process.wait() for process in running]):
        sys.exit("mutation_test: the registry's program failed")
    rows = [row for part in parts for row in csv.DictReader(part.open())]
    return sorted(rows, key=lambda row: int(row["number"]))


def run_limited(program, cpu_seconds, **environment):
    """Exit status of a program that may use so much of a processor: not 0 where it does not end."""
    return subprocess.run(["prlimit", f"--cpu={cpu_seconds:.0f}", program], capture_output=True,
                          env={**os.environ, **environment}).returncode


def learn_unit_tests(folder):
    """[(seconds, program, faults whose places it passes)], the quickest first."""
    tests = []
    for program in sorted(folder.glob("mutation_test_*")):
        with tempfile.NamedTemporaryFile("r") as reached:
            start = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            status = run_limited(program, SLOWEST, HDRP_MUTANT_REACHED=reached.name)
            seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - start
            if status == 0:
                tests.append((seconds, program, {int(line) for line in reached.read().split()}))
            elif seconds < SLOWEST - 1:
                sys.exit(f"mutation_test: {program.name} fails without any fault")
            else:
                print(f"note: {program.name} takes more than {SLOWEST} s: not asked")
    return sorted(tests, key=lambda test: test[0])


def ask_unit_tests(row, tests):
    """The first unit test that notices a fault, or ""."""
    for seconds, program, reached in tests:
        if int(row["number"]) in reached and \
                run_limited(program, 10 + 10 * seconds, HDRP_MUTANT=row["number"],
                            HDRP_MUTANT_AMOUNT=row["amount"]) != 0:
            return program.name
    return ""


def listed_survivors():
    """key -> reason."""
    lines = SURVIVORS.read_text().split("\n") if SURVIVORS.exists() else []
    return dict(line.split(": ", 1) for line in lines if line and not line.startswith("#"))


def share(rows):
    return sum(bool(row["noticed_by"]) for row in rows) / max(1, len(rows))


def report(rows):
    """Prints the count of each kind and header; messages about what is too little."""
    failures = []
    for name, kinds in (("constants", ("constant",)), ("operators", OPERATORS)):
        group = [row for row in rows if row["kind"] in kinds]
        by = Counter("nothing" if not row["noticed_by"] else
                     "unit tests" if row["noticed_by"].startswith("mutation_test") else
                     "the registry" for row in group)
        print(f"{name}: {100 * share(group):.1f} % of {len(group)} faults noticed; by " +
              ", ".join(f"{what} {n}" for what, n in by.most_common()))
        if share(group) < LEAST_NOTICED:
            failures.append(f"less than {100 * LEAST_NOTICED:.0f} % of the {name} are noticed")
        for header in sorted({row["header"] for row in group}):
            part = [row for row in group if row["header"] == header]
            print(f"    {header:20} {100 * share(part):5.1f} % of {len(part):4}")
            if name == "constants" and share(part) < LEAST_OF_A_HEADER:
                failures.append(f"less than {100 * LEAST_OF_A_HEADER:.0f} % of the constants of "
                                f"{header} are noticed")
    return failures


def check_survivors(rows, listed, write):
    """Messages about faults that survive without a reason."""
    survivors = [row["key"] for row in rows if not row["noticed_by"]]
    if write:
        with SURVIVORS.open("a") as file:
            file.writelines(f"{key}: {NO_REASON}\n" for key in survivors if key not in listed)
    for key in survivors:
        print(f"survived: {key}: {listed.get(key, NO_REASON)}")
    noticed = {row["key"] for row in rows if row["noticed_by"]}
    for key in sorted(noticed & set(listed)):
        print(f"note: listed as a survivor, but noticed: {key}")
    return [f"survives, and no reason is listed: {key}" for key in survivors
            if listed.get(key, NO_REASON) == NO_REASON]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    rows = run_registry(options.folder, options.only)
    if not rows:
        sys.exit(f"mutation_test: no fault holds {options.only}")
    tests = learn_unit_tests(options.folder)
    left = [row for row in rows if not row["noticed_by"]]
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        for row, noticed in zip(left, pool.map(lambda row: ask_unit_tests(row, tests), left)):
            row["noticed_by"] = noticed
    with (options.folder / "mutation.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    failures = report(rows)
    failures = check_survivors(rows, listed_survivors(), options.write) + \
        ([] if options.only else failures)
    for failure in failures:
        print(f"FAIL {failure}")
    return bool(failures)


if __name__ == "__main__":
    sys.exit(main())
