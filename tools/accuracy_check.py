#!/usr/bin/env python3
"""Holds every accuracy claim to what was measured: accuracy_check.py FOLDER FAMILY...

Reads FOLDER/FAMILY.csv, which the accuracy program of each family (compiler, optimisation,
contraction) has written, prints one table, and fails when a claim is broken by the worst family,
and also when it is more than twice that: a promise nobody needs to read carefully is stale. Claims
up to 4 ulp are never stale, since measurements that small depend on the inputs sampled.
"""
import csv
import math
import pathlib
import sys

ULP = 2.0 ** -24  # distance from 1 to the float below it
FLOOR = {"relative": 4 * ULP, "absolute": 4 * ULP, "degrees": math.degrees(4 * ULP), "ulp": 4.0}
SLACK = 2.0


def read(folder, families):
    """id -> (row of the worst family, that family), in the order of the first file."""
    worst = {}
    ids = None
    for family in families:
        with open(folder / f"{family}.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        if ids is not None and [row["id"] for row in rows] != ids:
            sys.exit(f"accuracy: {family} measured other claims than {families[0]}; build again")
        ids = [row["id"] for row in rows]
        for row in rows:
            if row["id"] not in worst or float(row["max"]) > float(worst[row["id"]][0]["max"]):
                worst[row["id"]] = (row, family)
    return worst


def verdict(row):
    claim, measured = float(row["claim"]), float(row["max"])
    if measured > claim or int(row["non_finite"]):
        return "BROKEN"
    if claim > max(SLACK * measured, FLOOR[row["unit"]]):
        return "STALE"
    return "ok"


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__.splitlines()[0])
    worst = read(pathlib.Path(sys.argv[1]), sys.argv[2:])
    failures = 0
    print(f"{'':6} {'id':36} {'claim':>9} {'worst':>9} {'unit':8} family")
    for row, family in worst.values():
        result = verdict(row)
        failures += result != "ok"
        print(f"{result:6} {row['id']:36} {float(row['claim']):9.3g} {float(row['max']):9.3g} "
              f"{row['unit']:8} {family}")
    print(f"{len(worst)} claims over {len(sys.argv) - 2} families, {failures} wrong"
          + (": a STALE claim promises less than half of what is measured" if failures else ""))
    return failures != 0


if __name__ == "__main__":
    sys.exit(main())
