#!/usr/bin/env python3
"""Errors in half precision: half.py [--record FLOAT] HALF RANGES

Runs tests/stability's programs (HALF: the accuracy registry in half precision; RANGES: where
formulas stop being usable) and compares with tests/accuracy/half.csv. --record writes that file
instead, with the errors of the same registry in float for comparison, by the program FLOAT.
Numbers may differ by a hundredth, as libm differs between processors. With another compiler or
libc than those the file names, nothing is compared: exit status 77.
"""
import csv
import pathlib
import subprocess
import sys

import hdrp_api

FILE = hdrp_api.ROOT / "tests" / "accuracy" / "half.csv"
COLUMNS = ["id", "function", "unit", "float_max", "half_max", "half_mean", "non_finite_share",
           "usable"]
SKIPPED = 77
# What half may add to the error of a formula and still be usable; an ulp of a half is 2^-10.
LIMITS = {"relative": 0.02, "absolute": 1.0 / 255.0, "degrees": 0.5, "ulp": 20.0, "share": 0.02}
# Entries whose own inputs or guards use bit patterns, while what they measure is arithmetic.
ARITHMETIC = {"rsqrt", "sqrt", "acos_exact", "atan2_fast", "atan2_fast_relative", "atan2_exact",
              "atan2_exact_absolute"}
# Conversions of bit patterns: floats are halves already, so that there is nothing to measure.
BITS = {"pack_half", "pack_half_denormal", "pack_r11", "pack_b10"}
HALF_MIN, HALF_MAX = "6.1e-05", "65504"


def start(program):
    return subprocess.Popen([program], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)


def rows_of(process):
    """(the line that names the compiler, the rows) that a program prints."""
    text, _ = process.communicate()
    if process.returncode:
        sys.exit(f"half: {process.args[0]} ended with {process.returncode}")
    lines = text.splitlines()
    return lines[0], list(csv.DictReader(lines[1:]))


def number(text):
    return f"{float(text):.3g}"


def reason(row):
    """Why an entry cannot be measured in half precision, or None."""
    if row["id"] in BITS or "b" in row["marks"] and row["id"] not in ARITHMETIC:
        return "none: float bits"
    if "i" in row["marks"]:
        return "none: integer codes"
    if int(row["count"]) == 0:
        return "none: inputs beyond half"
    return None


def inside(r):
    """The range of a parameter in words; '' where it is all that was walked."""
    lo, hi, first, last = (float(r[k]) for k in ("lo", "hi", "first", "last"))
    if lo > hi:
        return "no"
    if lo <= first and hi >= last:
        return "yes"
    if hi >= last:
        return f"inside {r['parameter']} >= {r['lo']}"
    if lo <= first:
        return f"inside {r['parameter']} <= {r['hi']}"
    return f"inside {r['parameter']} {r['lo']} to {r['hi']}"


def usable(row, float_max, r):
    limit = LIMITS[row["unit"]]
    finite = float(row["non_finite_share"]) == 0.0
    if finite and float(row["max"]) <= float_max + limit:
        return "yes"
    if finite and row["unit"] == "relative" and 0.0 < float(row["largest"]) <= 1.0 and \
            float(row["absolute_max"]) <= LIMITS["absolute"]:
        return "yes"
    if r:
        # A walk that found nothing wrong went less far than the registry, which did.
        walked = f"inside {r['parameter']} {r['first']} to {r['last']}"
        return walked if inside(r) == "yes" else inside(r)
    if float(row["normal_max"]) <= float_max + limit and row["unit"] in ("relative", "ulp"):
        return f"inside results {HALF_MIN} to {HALF_MAX}"
    return "no"


def table(half, ranges, float_max):
    ranges = {r["id"]: r for r in ranges}
    result = []
    for row in half:
        r = ranges.pop(row["id"], None)
        known = float_max.get(row["id"])
        line = [row["id"], row["function"], row["unit"], known or ""]
        why = reason(row)
        if why:
            found = inside(r) if r else "no"
            result.append(line + ["", "", "", why if found == "no" else found])
        else:
            some = float(row["non_finite_share"]) < 1.0
            result.append(line + [number(row["max"]) if some else "",
                                  number(row["mean"]) if some else "",
                                  number(row["non_finite_share"]),
                                  usable(row, float(known or 0.0), r)])
    for r in ranges.values():
        result.append([r["id"], r["function"], r["unit"], "", "", "", "", inside(r)])
    return sorted(result)


def differs(a, b):
    """Whether two cells say something else. Numbers in words may move by a step of the walk."""
    a_words, b_words = a.split(" "), b.split(" ")
    if len(a_words) != len(b_words):
        return True
    for x, y in zip(a_words, b_words):
        try:
            near = abs(float(x) - float(y)) <= 0.05 * abs(float(x)) + 1e-9
        except ValueError:
            near = x == y
        if not near:
            return True
    return False


def main():
    arguments = sys.argv[1:]
    record = arguments[0] if arguments else ""
    if record == "--record":
        floats = start(arguments[1])
        arguments = arguments[2:]
    if len(arguments) != 2:
        sys.exit(__doc__.splitlines()[0])
    half_process, range_process = (start(a) for a in arguments)
    made_by, half = rows_of(half_process)
    ranges = rows_of(range_process)[1]
    if record == "--record":
        float_max = {r["id"]: number(r["max"]) for r in rows_of(floats)[1]}
        lines = [",".join(row) for row in [COLUMNS] + table(half, ranges, float_max)]
        FILE.write_text("\n".join([made_by] + lines) + "\n")
        return 0

    lines = FILE.read_text().splitlines()
    if lines[0] != made_by:
        print(f"half: recorded with '{lines[0]}', this is '{made_by}': not compared")
        return SKIPPED
    known = {row["id"]: row for row in csv.DictReader(lines[1:])}
    now = table(half, ranges, {i: row["float_max"] for i, row in known.items()})
    bad = []
    for row in now:
        old = known.pop(row[0], None)
        if not old or any(differs(old[c], value) for c, value in zip(COLUMNS, row)):
            bad.append(row[0])
            print("recorded", ",".join(old.values()) if old else "nothing")
            print("now     ", ",".join(row))
    for name in known:
        print(f"recorded {name}, which is no entry any more")
    print(f"{len(now)} entries in half precision, {len(bad) + len(known)} differ from "
          f"{FILE.relative_to(hdrp_api.ROOT)}"
          + ("; if that is intended, build the target half_record" if bad or known else ""))
    return bool(bad or known)


if __name__ == "__main__":
    sys.exit(main())
