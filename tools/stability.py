#!/usr/bin/env python3
"""Writes docs/stability.md from the measurements: stability.py [--check]

    stability.py --record NAME PROGRAM    writes tests/stability/NAME.csv from a program of
                                          tests/stability: edges, monotone, lobes or sampling
    stability.py --compare NAME PROGRAM   compares the two: words and digits that matter, since
                                          compilers and libm differ in the last ones

Every end of a range at which a result jumps must be in tests/stability/edges_known.csv with the
reason; what is there and does not jump fails too.
"""
import collections
import csv
import pathlib
import subprocess
import sys

import hdrp_api

FOLDER = hdrp_api.ROOT / "tests" / "stability"
HALF = hdrp_api.ROOT / "tests" / "accuracy" / "half.csv"
TARGET = hdrp_api.ROOT / "docs" / "stability.md"

# Columns that identify a row; those that must be the same; those that may differ by a factor.
SHAPES = {
    "edges": (("function", "parameter", "end"), ("inside", "outside"), ()),
    "monotone": (("formula", "parameter"), ("direction", "from", "to", "allowed_ulp"), ()),
    "lobes": (("lobe", "check"), ("bound",), ("worst",)),
    "sampling": (("sampler",), ("cases", "samples", "bins"), ()),
}
FACTOR, FLOOR = 2.0, 2e-5


def read(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def run(program):
    """(what a program printed, did it succeed?)"""
    done = subprocess.run([program], stdout=subprocess.PIPE, text=True, check=False)
    return done.stdout, done.returncode == 0


def is_near(a, b):
    a, b = float(a), float(b)
    return abs(a - b) <= FLOOR or (a * b > 0.0 and max(a / b, b / a) <= FACTOR)


def problems(name, old, new):
    """Lines about rows that differ."""
    keys, same, near = SHAPES[name]
    known = {tuple(row[k] for k in keys): row for row in old}
    found = []
    for row in new:
        key = tuple(row[k] for k in keys)
        before = known.pop(key, None)
        if before is None:
            found.append(f"{' '.join(key)} is not recorded")
            continue
        found += [f"{' '.join(key)}: {c} was {before[c]}, is {row[c]}" for c in same
                  if before[c] != row[c]]
        found += [f"{' '.join(key)}: {c} was {before[c]}, is {row[c]}" for c in near
                  if not is_near(before[c], row[c])]
    return found + [f"{' '.join(key)} is recorded and gone" for key in known]


def surprises(rows):
    """{end: row} of the ends where something happens."""
    bad = ("jumps", "not finite")
    return {(r["function"], r["parameter"], r["end"]): r for r in rows
            if r["inside"] in bad or r["outside"] in bad}


def unexplained(rows):
    """Lines about jumps without a reason, and reasons without a jump."""
    reasons = {(r["function"], r["parameter"], r["end"]) for r in read(FOLDER / "edges_known.csv")}
    found = surprises(rows)
    return [f"{' '.join(k)}: inside {r['inside']}, outside {r['outside']}; give the reason in "
            "edges_known.csv" for k, r in found.items() if k not in reasons] + \
           [f"{' '.join(k)}: edges_known.csv explains what does not happen"
            for k in sorted(reasons) if k not in found]


# ---- the document ------------------------------------------------------------------------------

INTRODUCTION = """\
# Stability

What the formulas do where numbers end: at the edges of their ranges, as integrals over the
hemisphere, and in half precision. Every figure is measured by the test suite from the text of the
headers, at the inputs that were worst, and this page is generated from those figures
(`tools/stability.py`). Errors against references are in the docstrings; see the registry,
`tests/accuracy/`.
"""

LOBES = """\
## Lobes

By quadrature in double around the float formulas, perceptual roughness 0.05 to 1, cosines of the
view 0.02 to 1, anisotropy -0.9 to 0.9. *Normalisation*: by how much the integral of D n.h, or of a
density, misses 1. *Reciprocity*: by how much exchanging light and view changes the BRDF, relative,
from roughness 0.2 on. *Above 1* and *below 1*: largest gain and loss of energy, for a white surface
in a white environment; what is negative never happens. *Sent*: gain of what one light sends in all
directions. A loss is no defect by itself: GGX without multiscattering is dark where it is rough, a
coat keeps the light that it reflects back down, and the diffuse lobe leaves what is specular.
"""

SAMPLING = """\
## Sampling

Pearson's chi-squared of drawn directions against the stated density, over roughness, angle and
anisotropy. The least p of n good cases is about 1/n.
"""

EDGES = """\
## Edges

At each end of each documented range: the value there, at the 16 floats inside and at the 16
outside, with everything else drawn at random. A *jump* is a step between neighbouring floats that
neither slope nor rounding explains.
"""

MONOTONE = """\
## Monotonicity

Formulas that rise or fall where the quantity does, over all floats of the range in samples of
neighbours. A step back of one unit in the last place (ulp) is rounding; it matters where a result
is compared with another one.
"""

HALF_TEXT = """\
## Half precision

The same text evaluated with IEEE halves (11 bits, 6e-8 to 65504, denormals kept), each operation
rounded, as by `mediump` on hardware that takes it literally. Inputs are halves, so that these are
errors of the arithmetic. *Usable* means that half adds no more than 2 % relative, 1/255 absolute or
0.5 degrees to the error in float. Functions that take float bits apart, and integers beyond 2048,
have no counterpart in half.
"""


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def lobe_tables():
    rows = read(FOLDER / "lobes.csv")
    columns = {"normalisation of D n.h": "normalisation", "normalisation of the density":
               "normalisation", "reciprocity": "reciprocity", "albedo above 1": "above 1",
               "reflected and refracted above 1": "above 1", "albedo below 1": "below 1",
               "light sent above 1": "sent above 1", "shadowing above 1": "G above 1"}
    head = ["normalisation", "G above 1", "reciprocity", "above 1", "below 1", "sent above 1"]
    lobes = collections.defaultdict(dict)
    for r in rows:
        lobes[r["lobe"]][columns[r["check"]]] = r["worst"]
    return table(["lobe"] + head, [[name] + [cells.get(c, "") for c in head]
                                   for name, cells in lobes.items()])


def sampling_table():
    return table(["sampler", "cases", "samples each", "bins", "least p", "integral off by"],
                 [[f"`{r['sampler']}`", r["cases"], r["samples"], r["bins"],
                   r["least_p"] if r["bins"] != "0" else "", r["integral_error"]]
                  for r in read(FOLDER / "sampling.csv")])


def edge_text():
    rows = read(FOLDER / "edges.csv")
    reasons = {(r["function"], r["parameter"], r["end"]): r["reason"]
               for r in read(FOLDER / "edges_known.csv")}
    found = surprises(rows)
    held = sum(r["outside"] == "held" for r in rows)
    continued = sum(r["outside"] == "continues" for r in rows)
    functions = len({r["function"] for r in rows})
    finite = sum(r["inside"] != "not finite" for r in rows)
    text = (f"{len(rows)} ends of {functions} formulas. Inside, {finite} of them are finite and "
            f"{sum(r['inside'] == 'smooth' for r in rows)} smooth.\nOutside, {held} hold the "
            f"value of the end and {continued} continue smoothly. The rest:\n\n")
    return text + table(
        ["formula", "parameter", "end", "value there", "jump [ulp]", "why"],
        [[f"`{k[0]}`", k[1], k[2], r["value"], r["jump"] if r["inside"] == "jumps" else "",
          reasons.get(k, "")] for k, r in found.items()])


def monotone_table():
    return table(["formula", "parameter", "", "from", "to", "worst step back [ulp]", "at"],
                 [[f"`{r['formula']}`", r["parameter"], r["direction"], r["from"], r["to"],
                   r["worst_ulp"], r["at"] if float(r["worst_ulp"]) > 0.0 else ""]
                  for r in read(FOLDER / "monotone.csv")])


def half_text():
    rows = read(HALF)
    inside = [r for r in rows if r["usable"].startswith("inside")]
    no = [r for r in rows if r["usable"] == "no"]
    yes = [r for r in rows if r["usable"] == "yes"]
    none = collections.defaultdict(set)
    for r in rows:
        if r["usable"].startswith("none: "):
            none[r["usable"][6:]].add(r["function"])
    head = ["measured", "function", "unit", "float", "half, worst", "half, mean", "not finite"]

    def cells(r):
        share = r["non_finite_share"]
        return [r["id"], f"`{r['function']}`", r["unit"], r["float_max"], r["half_max"],
                r["half_mean"], f"{100.0 * float(share):.3g} %" if share else ""]
    text = "### Where half stops being usable\n\n"
    text += table(["measured", "function", "usable for", "half, worst", "not finite"],
                  [[r["id"], f"`{r['function']}`", r["usable"].replace("inside ", ""),
                    r["half_max"], cells(r)[6]] for r in inside])
    text += ("\n`_unrounded` counts what rounding the inputs to half costs as well: a highlight "
             "needs vectors, not a cosine, and `brdf_lit_...` is the whole Lit model with that "
             "feature.\n\n### Not usable over the documented range\n\n")
    text += table(head, [cells(r) for r in no])
    text += "\n### Usable\n\n" + table(head, [cells(r) for r in yes])
    text += "\n### Not evaluated\n\n"
    for why, functions in sorted(none.items()):
        text += f"- {why}: {', '.join(f'`{f}`' for f in sorted(functions))}\n"
    return text


def document():
    return "\n".join([INTRODUCTION, LOBES, lobe_tables(), SAMPLING, sampling_table(), EDGES,
                      edge_text(), MONOTONE, monotone_table(), HALF_TEXT, half_text()])


def main():
    arguments = sys.argv[1:]
    if len(arguments) == 3 and arguments[0] in ("--record", "--compare"):
        mode, name, program = arguments
        text, good = run(program)
        rows = list(csv.DictReader(text.splitlines()))
        path = FOLDER / f"{name}.csv"
        found = unexplained(rows) if name == "edges" else []
        if mode == "--record":
            path.write_text(text)
        else:
            found += problems(name, read(path), rows)
        print(f"stability: {len(rows)} rows of {name}, {len(found)} problems", *found, sep="\n")
        return bool(found) or not good
    if arguments == ["--check"]:
        if not TARGET.exists() or TARGET.read_text() != document():
            print(f"{TARGET.relative_to(hdrp_api.ROOT)} is out of date: run tools/stability.py")
            return 1
        return 0
    if arguments:
        sys.exit(__doc__.splitlines()[0])
    TARGET.write_text(document())
    return 0


if __name__ == "__main__":
    sys.exit(main())
