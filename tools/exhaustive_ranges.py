#!/usr/bin/env python3
"""Writes the ranges of first arguments and results as a C table: exhaustive_ranges.py OUTPUT.

All ends are closed and floats: an open end becomes the next float inside. A result that may be
anything has infinite ends.
"""
import math
import pathlib
import re
import sys

import hdrp_api

WITHIN = re.compile(r"\bto within (\d+) ulp\b")


def closed(found):
    """(lo, hi) of an interval, as floats."""
    lo, hi = hdrp_api.f32(found.lo), hdrp_api.f32(found.hi)
    return (hdrp_api.next_up(lo) if found.lo_open else lo,
            hdrp_api.next_down(hi) if found.hi_open else hi)


def ends(found):
    if found.kind == "interval":
        return closed(found)
    if found.kind == "any":
        return -math.inf, math.inf
    if found.kind == "unit":
        return -1.0, 1.0
    return -hdrp_api.FLT_MAX, hdrp_api.FLT_MAX


def result_ends(function, macros):
    entry = function.doc.field("returns")
    found = entry.range(macros)
    if found is None or found.kind == "any":
        return -math.inf, math.inf
    lo, hi = ends(found)
    slack = WITHIN.search(entry.text)
    for _ in range(int(slack[1]) if slack else 0):
        lo, hi = hdrp_api.next_down(lo), hdrp_api.next_up(hi)
    # A structure is only finite: its members have ranges of their own.
    return lo, hi


def literal(x):
    if math.isinf(x):
        return "INFINITY" if x > 0 else "-INFINITY"
    return float(x).hex() + "f"


def rows(root=hdrp_api.ROOT):
    macros = hdrp_api.macros(root)
    for path in hdrp_api.headers(root):
        for f in hdrp_api.functions(path):
            if not f.is_formula or not f.is_public or not f.parameters or f.is_primitive:
                continue
            entry = f.doc.field(f.parameters[0].name)
            found = entry.range(macros)
            if f.parameters[0].type == "float" or found.kind == "any":
                lo, hi = ends(found)
                result_lo, result_hi = result_ends(f, macros)
                yield (f'{{"{f.name}", {literal(lo)}, {literal(hi)}, {int(found.kind == "any")}, '
                       f"{literal(result_lo)}, {literal(result_hi)}}},")


def main():
    pathlib.Path(sys.argv[1]).write_text("\n".join(rows()) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
