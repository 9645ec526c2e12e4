#!/usr/bin/env python3
"""Holds the record of the full sweeps to the sources: exhaustive_check.py SUBSET.csv RECORDED.csv

The full run takes half an hour and is not repeated by the tests; its subset is. This fails where the
record is of other sweeps or other claims than the program has now, where its worst breaks a claim,
and where the subset has found an input that is worse, which the full run must have seen too.
"""
import csv
import pathlib
import sys

# The digits of libm, and with them a worst case, may differ by this much between machines.
SAME = 1.02
AGAIN = "build the target exhaustive_run"


def read(path):
    """(name, domain, id) -> row."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {(row["name"], row["domain"], row["id"]): row for row in rows}


def problems(subset, recorded):
    for key in sorted(set(subset) | set(recorded)):
        what = " ".join(part for part in key if part)
        if key not in recorded:
            yield f"{what}: not in the record"
        elif key not in subset:
            yield f"{what}: in the record, but not swept"
        else:
            yield from (f"{what}: {text}" for text in compare(subset[key], recorded[key]))


def compare(now, then):
    for column in ("claim", "unit"):
        if now[column] != then[column]:
            yield f"{column} is {now[column]}, recorded as {then[column]}"
    if int(then["non_finite"]):
        yield f"{then['non_finite']} results of the full run are not good"
    if not then["worst_error"]:
        return
    worst = float(then["worst_error"])
    # Both have three digits, of which the last may have been rounded up.
    if worst > float(now["claim"]) * 1.005:
        yield f"the full run found {worst:g}, more than the claim {now['claim']}"
    if now["worst_error"] and float(now["worst_error"]) > worst * SAME:
        yield f"the subset found {now['worst_error']}, the full run only {worst:g}"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.splitlines()[0])
    recorded = pathlib.Path(sys.argv[2])
    if not recorded.is_file():
        print(f"{recorded.name} is missing: {AGAIN}")
        return 1
    subset = read(sys.argv[1])
    found = list(problems(subset, read(recorded)))
    for text in found:
        print(text)
    print(f"{len(subset)} rows, {len(found)} wrong" + (f": {AGAIN}" if found else ""))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
