#!/usr/bin/env python3
"""Holds every accuracy claim to what was measured: accuracy_check.py FOLDER FAMILY...

Reads FOLDER/FAMILY.csv, which the accuracy program of each family (compiler, optimisation,
contraction) has written, prints one table, and fails when a claim is broken by the worst family,
and also when it is more than twice that: a promise nobody needs to read carefully is stale. Claims
up to 4 ulp are never stale, since measurements that small depend on the inputs sampled.

With --recorded FILE it fails too when the largest or the mean error of a family is no longer the
three digits that were recorded. The digits belong to a compiler and a libc, which the file names;
a family that was built with others, or is not there, is left out with a word about it. --record
writes the file anew.
"""
import argparse
import csv
import math
import pathlib
import sys

ULP = 2.0 ** -24  # distance from 1 to the float below it
FLOOR = {"relative": 4 * ULP, "absolute": 4 * ULP, "degrees": math.degrees(4 * ULP), "ulp": 4.0}
SLACK = 2.0
ABOUT = ("id", "function", "unit", "claim")
RECORD_AGAIN = "if that is meant, build the target accuracy_record and say why in CHANGELOG.md"


class Family:
    """The measurements of one program: rows in order, and the compiler and libc of the digits."""

    def __init__(self, folder, name):
        self.name = name
        with open(folder / f"{name}.csv", newline="", encoding="utf-8") as file:
            lines = file.read().splitlines()
        # "# gcc 12.2.0, glibc 2.36 on x86-64 with FMA"
        self.origin = lines.pop(0)[2:] if lines and lines[0].startswith("# ") else "unknown"
        self.rows = list(csv.DictReader(lines))
        self.ids = [row["id"] for row in self.rows]

    def digits(self):
        """id -> what the record says of it: the largest and the mean error."""
        return {row["id"]: {"max": three_digits(row["max"]), "mean": three_digits(row["mean"])}
                for row in self.rows}


def three_digits(text):
    return f"{float(text):.3g}"


def read(folder, names):
    families = [Family(folder, name) for name in names]
    if not families[0].ids:
        sys.exit(f"accuracy: {names[0]} measured nothing")
    for family in families:
        if family.ids != families[0].ids:
            sys.exit(f"accuracy: {family.name} measured other claims than {names[0]}; build again")
    return families


# ---- claims ------------------------------------------------------------------------------------

def worst_of(families):
    """(row of the worst family, name of that family) for each claim, in order."""
    return [max(((f.rows[i], f.name) for f in families), key=lambda pair: float(pair[0]["max"]))
            for i in range(len(families[0].rows))]


def verdict(row):
    claim, measured = float(row["claim"]), float(row["max"])
    if measured > claim or int(row["non_finite"]):
        return "BROKEN"
    if claim > max(SLACK * measured, FLOOR[row["unit"]]):
        return "STALE"
    return "ok"


def check_claims(families):
    """Prints the table; how many claims are wrong."""
    worst = worst_of(families)
    failures = 0
    print(f"{'':6} {'id':36} {'claim':>9} {'worst':>9} {'unit':8} family")
    for row, family in worst:
        result = verdict(row)
        failures += result != "ok"
        print(f"{result:6} {row['id']:36} {float(row['claim']):9.3g} {float(row['max']):9.3g} "
              f"{row['unit']:8} {family}")
    print(f"{len(worst)} claims over {len(families)} families, {failures} wrong"
          + (": a STALE claim promises less than half of what is measured" if failures else ""))
    return failures


# ---- the record --------------------------------------------------------------------------------

def about(row):
    """The columns that do not depend on a family, as the record has them."""
    return {key: f"{float(row[key]):.9g}" if key == "claim" else row[key] for key in ABOUT}


def read_record(path):
    """(family -> origin, id -> row)."""
    lines = path.read_text(encoding="utf-8").splitlines()
    head = [line[2:].split(": ", 1) for line in lines if line.startswith("# ") and ": " in line]
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return {name: origin for name, origin in head}, {row["id"]: row for row in rows}


def check_record(families, path):
    """Prints what is not as recorded; how many values that is."""
    if not path.is_file():
        print(f"{path.name} is missing: build the target accuracy_record")
        return 1
    origins, record = read_record(path)
    failures = []
    rows = {row["id"]: about(row) for row in families[0].rows}
    failures += [f"{name}: measured, but not recorded" for name in rows if name not in record]
    failures += [f"{name}: recorded, but not measured" for name in record if name not in rows]
    common = [name for name in rows if name in record]
    for name in common:
        failures += [f"{name}: {key} is {rows[name][key]}, recorded as {record[name][key]}"
                     for key in ABOUT if rows[name][key] != record[name][key]]
    compared = 0
    for family in families:
        if origins.get(family.name) != family.origin:
            print(f"not compared: {family.name} is of {family.origin}, the record of "
                  f"{origins.get(family.name, 'no such family')}")
            continue
        compared += 1
        digits = family.digits()
        for name in common:
            for key, value in digits[name].items():
                recorded = record[name].get(f"{family.name}_{key}")
                if value != recorded:
                    failures.append(f"{name}: {key} of {family.name} is {value}, recorded as "
                                    f"{recorded}")
    present = {family.name for family in families}
    for name in origins:
        if name not in present:
            print(f"not compared: {name} is recorded, but was not built here")
    for failure in failures:
        print(f"MOVED  {failure}")
    print(f"{compared} of {len(origins)} recorded families compared, {len(failures)} values moved"
          + (f": {RECORD_AGAIN}" if failures else ""))
    return len(failures)


def write_record(families, path):
    """All recorded families must be there, or the record would lose one."""
    if path.is_file():
        lost = set(read_record(path)[0]) - {family.name for family in families}
        if lost:
            sys.exit(f"accuracy: {', '.join(sorted(lost))} would be lost from {path.name}")
    lines = [f"# {family.name}: {family.origin}" for family in families]
    columns = [f"{family.name}_{key}" for family in families for key in ("max", "mean")]
    lines.append(",".join(ABOUT + tuple(columns)))
    digits = [family.digits() for family in families]
    for row in sorted(families[0].rows, key=lambda r: r["id"]):
        values = [d[row["id"]][key] for d in digits for key in ("max", "mean")]
        lines.append(",".join(list(about(row).values()) + values))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(f"recorded {len(families[0].rows)} claims over {len(families)} families")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("families", nargs="+")
    parser.add_argument("--recorded", type=pathlib.Path, help="the record to compare with")
    parser.add_argument("--record", action="store_true", help="write the record instead")
    arguments = parser.parse_args()
    families = read(arguments.folder, arguments.families)
    failures = check_claims(families)
    if arguments.record and arguments.recorded:
        if failures:
            sys.exit("accuracy: nothing is recorded while a claim is wrong")
        write_record(families, arguments.recorded)
    elif arguments.recorded:
        failures += check_record(families, arguments.recorded)
    return failures != 0


if __name__ == "__main__":
    sys.exit(main())
