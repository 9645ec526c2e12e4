#!/usr/bin/env python3
"""Writes the tables of the edge walk for one header: edge_scan.py HEADER OUTPUT.c

The same calls as those of the finite scan (tools/finite_scan.py), but with samples from the inside
of the documented ranges, and with a list of the ends of every range: of float arguments, of
components of vectors, and of members of structs. tests/stability/edges.c walks up to each of them
and across. Ends that are infinite or as large as floats are have no outside and are left out, and
so are members that depend on each other ('Made by').
"""
import math
import pathlib
import random
import sys

import finite_scan
import hdrp_api
from hdrp_api import f32

COUNT = 48
BIGGEST = 1e30


def inside(r, generator):
    """A number well inside a range: of wide ones, of the size that numbers usually have."""
    lo, hi = (-1e3, 1e3) if r.kind in ("any", "finite") else (float(r.lo), float(r.hi))
    if hi - lo <= 64.0:
        return f32(lo + (hi - lo) * generator.uniform(0.05, 0.95))
    magnitude = math.exp(generator.uniform(math.log(1e-2), math.log(1e3)))
    if lo < 0.0 and hi > 0.0:
        return f32(max(lo, min(hi, magnitude * generator.choice((-1.0, 1.0)))))
    return f32(max(lo, min(hi, lo + magnitude if lo >= 0.0 else hi - magnitude)))


def float_samples(r):
    generator = random.Random(1)
    return [inside(r, generator) for _ in range(COUNT)]


def vector_samples(r, size):
    generator = random.Random(2)
    return [tuple(inside(r, generator) for _ in range(size)) for _ in range(COUNT)]


def unit_samples(size):
    generator = random.Random(3)
    result = []
    while len(result) < COUNT:
        v = [generator.gauss(0.0, 1.0) for _ in range(size)]
        v[-1] = abs(v[-1]) if len(result) % 4 else v[-1]  # shading mostly looks at the upper half
        length = math.sqrt(sum(x * x for x in v))
        result.append(tuple(f32(x / length) for x in v))
    return result


def integer_samples(r):
    generator = random.Random(4)
    lo, hi = (0, 2 ** 32 - 1) if r.kind != "interval" else (int(r.lo), min(int(r.hi), 2 ** 32 - 1))
    if hi - lo > 64:  # counts and sizes rather than codes
        hi = min(hi, lo + 1024)
    return [generator.randint(lo + r.lo_open, hi - r.hi_open) for _ in range(COUNT)]


def ends(r):
    """[(end, direction inwards, does it belong to the range?)]"""
    if r is None or r.kind != "interval":
        return []
    found = [(f32(r.lo), 1, not r.lo_open), (f32(r.hi), -1, not r.hi_open)]
    return [e for e in found if abs(e[0]) < BIGGEST and r.lo < r.hi]


def edges_of(writer, kind, token, label, offset):
    """Rows (label, offset, end, inwards, closed) of the floats inside a type."""
    if kind == "float":
        return [(label, offset) + e for e in ends(token)]
    if kind in finite_scan.FLOATS:
        rows = []
        for c in "xyzw"[:finite_scan.FLOATS[kind]]:
            rows += [(f"{label}.{c}", f"{offset} + offsetof({kind}, {c})") + e for e in ends(token)]
        return rows
    struct = writer.structs.get(kind)
    if not struct or token is None or token.kind != "valid" or struct.producers:
        return []
    rows = []
    for m in struct.members:
        r = m.range(writer.macros)
        if m.type in finite_scan.FLOATS and m.groups(writer.macros):
            continue
        rows += edges_of(writer, m.type, r, f"{label}.{m.name}",
                         f"{offset} + offsetof({kind}, {m.name})")
    return rows


def edge_table(writer):
    """C rows of every end that a formula of the header has."""
    rows = []
    for f in finite_scan.scanned(writer.header):
        for i, p in enumerate(f.parameters):
            entry = f.doc.field(p.name) if f.doc else None
            token = entry.range(writer.macros) if entry else None
            for label, offset, end, inwards, closed in edges_of(writer, p.type, token, p.name, "0"):
                rows.append(f'    {{&{writer.function(f)}, "{label}", {i}, {offset}, '
                            f"{finite_scan.c_float(end)}, {inwards}, "
                            f"{'true' if closed else 'false'}}},\n")
    return rows


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n")[0])
    for name in ("float_samples", "vector_samples", "unit_samples", "integer_samples"):
        setattr(finite_scan, name, globals()[name])
    writer = finite_scan.Writer(sys.argv[1])
    text = writer.text()
    rows = "".join(edge_table(writer))
    module = writer.header.module
    text = text.replace("tools/finite_scan.py", "tools/edge_scan.py")
    text = text.replace('#include "finite_scan.h"\n', '#include "edges.h"\n')
    text += (f"\nextern const range_edge edges_{module}[];\n"
             f"const range_edge edges_{module}[] = {{\n{rows}"
             "    {NULL, NULL, 0, 0, 0.0f, 0, false},\n};\n")
    pathlib.Path(sys.argv[2]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
