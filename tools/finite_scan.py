#!/usr/bin/env python3
"""Writes the tables of the finite scan for one header: finite_scan.py HEADER OUTPUT.c

Every public formula is called with the extremes of its documented ranges in all arguments at once
(tests/finite/finite_scan.c runs them). The ranges come from the docstring, those inside a struct
from the comments of its members, see CONTRIBUTING.md. A formula that cannot be scanned becomes an
entry that fails, so that a gap in the documentation is a failing test.
"""
import itertools
import math
import pathlib
import re
import sys

import hdrp_api
from hdrp_api import ANY, FINITE, FLT_MAX, FLT_MIN, VALID, RangeError, f32

DENORMAL = 2.0 ** -149
ONE_UP, ONE_DOWN = 1.0 + 2.0 ** -23, 1.0 - 2.0 ** -24
# Squares of 1e-23 and 2e19 leave the range of a float, those of 1e-18 and 1e19 do not.
MAGNITUDES = [0.5, 1e-3, 0.1, 10.0, 1e-7, 1e-18, 1e-23, 1e-30, 1e3, 1e7, 1e19, 2e19, 1e30]
FLOATS = {"hdrp_v2": 2, "hdrp_v3": 3, "hdrp_v4": 4}
VECTORS = {**FLOATS, "hdrp_u32x4": 4}
WITHIN = re.compile(r"\bto within (\d+) ulp\b")


class ScanError(Exception):
    pass


# ---- samples, the most telling ones first ------------------------------------------------------

def unique(values):
    """Without repetition, where -0 and NaN are values like any other."""
    seen, result = set(), []
    for value in values:
        key = hdrp_api.f32_bits(value)
        if key not in seen:
            seen.add(key)
            result.append(value)
    return result


def float_samples(r):
    if r.kind == "any":
        return [math.nan, math.inf, -math.inf] + float_samples(FINITE)
    lo, hi = (-FLT_MAX, FLT_MAX) if r.kind == "finite" else (f32(r.lo), f32(r.hi))
    lo = hdrp_api.next_up(lo) if r.lo_open else lo
    hi = hdrp_api.next_down(hi) if r.hi_open else hi
    bottom, top = max(lo, -FLT_MAX), min(hi, FLT_MAX)
    values = [lo, hi, 0.0, -0.0, bottom, top, DENORMAL, -DENORMAL, 1.0, ONE_DOWN, FLT_MIN,
              -FLT_MIN, -1.0, ONE_UP, -ONE_DOWN, -ONE_UP, hdrp_api.next_up(bottom),
              hdrp_api.next_down(top), bottom / 2 + top / 2]
    values += [s * m for m in MAGNITUDES for s in (1.0, -1.0)]
    if top < 1e9 and bottom > -1e9:
        values += [bottom + (top - bottom) * t for t in (0.25, 0.75, 1e-3)]
    if 0.0 < bottom < top:
        values += [math.exp(math.log(bottom) + math.log(top / bottom) * t)
                   for t in (0.1, 0.35, 0.65, 0.9)]
    return unique([f32(v) for v in values if lo <= f32(v) <= hi])


def vector_samples(r, size):
    scalars = float_samples(r)
    ends = [math.nan, math.inf, 0.0, -FLT_MAX] if r.kind == "any" else scalars[:3]
    vectors = [(s,) * size for s in ends] + list(itertools.product(ends, repeat=size))
    vectors += [(s,) * size for s in scalars]
    rest = 0.0 if r.kind != "interval" or r.contains(0.0) else scalars[0]
    vectors += [tuple(s if i == axis else rest for i in range(size))
                for s in scalars for axis in range(size)]
    state = 1
    for _ in range(24):
        state = state * 6364136223846793005 + 1442695040888963407 & 2 ** 64 - 1
        vectors.append(tuple(scalars[(state >> 20 + 10 * i) % len(scalars)] for i in range(size)))
    return unique_tuples(vectors)


def unique_tuples(tuples):
    return list({tuple(map(hdrp_api.f32_bits, t)): t for t in tuples}.values())


def unit_samples(size):
    """Axes, diagonals, nearly axes, and what rounding makes of a unit vector."""
    axes = [tuple(s if i == axis else 0.0 for i in range(size))
            for s in (1.0, -1.0) for axis in reversed(range(size))]
    directions = [(1, 1, 1, 1), (-1, 1, -1, 1), (1, -1, -1, -1), (-1, -1, 1, 1), (3, 4, 0, 0),
                  (0, -3, 4, 0), (4, 0, -3, 0), (1e-4, 1, 1e-4, 0), (1e-4, 0, -1, 0),
                  (0, 1e-3, 1, 0), (1, -2, 3, -4), (-5, 1, 0.01, 2), (1, 1, 1e-3, 0)]
    directions = [d[:size] for d in directions]
    near = [(DENORMAL, 1.0), (-1.0, DENORMAL), (1.0, -FLT_MIN), (1e-20, -1.0), (-0.0, 1.0),
            (ONE_DOWN, 0.0), (0.0, -ONE_DOWN), (ONE_UP, 0.0), (-ONE_UP, 0.0), (3e-4, ONE_DOWN)]
    vectors = list(axes)
    for d in directions:
        length = math.sqrt(sum(x * x for x in d))
        vectors.append(tuple(f32(x / length) for x in d))
    for a, b in near:
        vectors.append((0.0,) * (size - 2) + (f32(a), f32(b)))
        vectors.append((f32(b),) + (0.0,) * (size - 2) + (f32(a),))
    return unique_tuples(vectors)


def integer_samples(r):
    lo, hi = (0, 2 ** 32 - 1) if r.kind != "interval" else (int(r.lo), min(int(r.hi), 2 ** 32 - 1))
    lo, hi = lo + r.lo_open, hi - r.hi_open
    if hi - lo < 20:
        return list(range(lo, hi + 1))
    values = [lo, hi, lo + 1, hi - 1, (lo + hi) // 2]
    values += [2 ** k for k in range(32)] + [2 ** k - 1 for k in range(2, 33, 5)]
    values += [lo + (0x9e3779b9 * k & 2 ** 32 - 1) % (hi - lo + 1) for k in range(1, 9)]
    return [v for v in dict.fromkeys(values) if lo <= v <= hi]


def mask_samples(prefix, macros):
    """Nothing, each flag whose name begins so, and all of them."""
    flags = [hdrp_api.evaluate(value, macros) for name, value in macros.items()
             if name.startswith(prefix)]
    flags = sorted({f for f in flags if isinstance(f, int)})
    if not flags:
        raise ScanError(f"no macro begins with {prefix}")
    union = 0
    for flag in flags:
        union |= flag
    return list(dict.fromkeys([0, union] + flags))


# ---- C text ------------------------------------------------------------------------------------

def c_float(x):
    if math.isnan(x):
        return "NAN"
    if math.isinf(x):
        return "INFINITY" if x > 0 else "-INFINITY"
    return f"{x.hex()}f"


def c_double(x):
    # INFINITY is a float, whose silent promotion clang warns of
    return c_float(x).rstrip("f") if math.isfinite(x) else f"(double){c_float(x)}"


class Writer:
    """Collects the tables that the functions of one header need."""

    def __init__(self, path):
        self.header = hdrp_api.header(path)
        root = self.header.path.parent
        self.macros = hdrp_api.macros(root)
        self.structs, self.functions = {}, {}
        for other in hdrp_api.headers(root):
            self.structs.update(hdrp_api.structs(other))
            self.functions.update((f.name, f) for f in hdrp_api.functions(other))
        for known in VECTORS:
            self.structs.pop(known, None)
        self.declared, self.defined = [], []
        self.names = {}

    def name(self, kind, key):
        """(identifier, is it new?) for what the key stands for."""
        full = (kind,) + key
        is_new = full not in self.names
        self.names.setdefault(full, f"{kind}_{len(self.names)}")
        return self.names[full], is_new

    def array(self, declaration, rows):
        """Defines an array and returns (its name or NULL, its length)."""
        if not rows:
            return "NULL", 0
        name = f"list_{len(self.defined)}"
        body = "".join(f"    {row},\n" for row in rows)
        self.defined.append(f"static {declaration} {name}[] = {{\n{body}}};\n")
        return name, len(rows)

    # Types

    def leaves(self, kind, label="", offset="0"):
        """[(label, offset expression, 'FS_F32' or 'FS_U32')] of the numbers inside a type."""
        def inside(member, of):
            return f"{offset} + offsetof({of}, {member})" if offset != "0" else \
                f"offsetof({of}, {member})"
        if kind in ("float", "hdrp_u32"):
            return [(label, offset, "FS_F32" if kind == "float" else "FS_U32")]
        dot = f"{label}." if label else ""
        if kind in VECTORS:
            number = "FS_U32" if kind == "hdrp_u32x4" else "FS_F32"
            return [(dot + c, inside(c, kind), number) for c in "xyzw"[:VECTORS[kind]]]
        if kind not in self.structs:
            raise ScanError(f"type {kind} is none that the scan knows")
        result = []
        for m in self.structs[kind].members:
            if m.array:
                raise ScanError(f"{kind}.{m.name} is an array")
            result += self.leaves(m.type, dot + m.name, inside(m.name, kind))
        return result

    def type(self, kind):
        name, is_new = self.name("type", (kind,))
        if is_new:
            rows = [f'{{"{label}", {offset}, {number}}}'
                    for label, offset, number in self.leaves(kind)]
            leaves, count = self.array("const fs_leaf", rows)
            self.defined.append(f'static const fs_type {name} = {{"{kind}", sizeof({kind}), '
                                f"{leaves}, {count}}};\n")
        return name

    # Sources

    def source(self, kind, r):
        """Identifier of the samples of a type within a range."""
        if kind in self.structs:
            return self.struct_source(kind, r)
        if r.kind == "valid" or r.kind == "unit" and kind not in FLOATS:
            raise ScanError(f"{kind} does not take '{r}'")
        if kind == "hdrp_u32":
            return self.table(kind, (r,), [f"{v}u" for v in integer_samples(r)])
        if kind == "float":
            return self.table(kind, (r,), [c_float(v) for v in float_samples(r)])
        if kind in FLOATS:
            size = FLOATS[kind]
            vectors = unit_samples(size) if r.kind == "unit" else vector_samples(r, size)
            return self.table(kind, (r,),
                              [f"{{{', '.join(map(c_float, v))}}}" for v in vectors])
        if kind == "hdrp_u32x4":
            values = integer_samples(r)
            rows = [f"{{{a}u, {b}u, {a}u, {c}u}}" for a, b, c in
                    zip(values, values[1:] + values[:1], reversed(values))]
            return self.table(kind, (r,), rows + [f"{{{v}u, {v}u, {v}u, {v}u}}" for v in values])
        raise ScanError(f"type {kind} is none that the scan knows")

    def table(self, kind, key, rows):
        name, is_new = self.name("source", (kind,) + key)
        if is_new:
            values, count = self.array(f"const {kind}", rows)
            self.declared.append(f"static fs_source {name};\n")
            self.defined.append(f"static fs_source {name} = {{sizeof({kind}), {count}, {values}, "
                                "NULL, 0, NULL, 0, NULL, false};\n")
        return name

    def struct_source(self, kind, r):
        struct = self.structs[kind]
        if r.kind not in ("valid", "any"):
            raise ScanError(f"struct {kind} takes 'valid' or 'any', not {r}")
        name, is_new = self.name("source", (kind, r.kind))
        if not is_new:
            return name
        self.declared.append(f"static fs_source {name};\n")
        made = [self.functions.get(p) for p in struct.producers] if r.kind == "valid" else []
        producers = []
        for producer, wanted in zip(made, struct.producers):
            if not producer or not producer.is_formula or producer.type != kind:
                raise ScanError(f"{wanted}, said to make {kind}, does not return one")
            producers.append(f"&{self.function(producer)}")
        rows = [] if producers else [
            f"{{offsetof({kind}, {m.name}), &{self.member_source(struct, m, r)}}}"
            for m in struct.members]
        parts, part_count = self.array("const fs_part", rows)
        makers, maker_count = self.array("const fs_function* const", producers)
        self.defined.append(f"static fs_source {name} = {{sizeof({kind}), 0, NULL, {parts}, "
                            f"{part_count}, {makers}, {maker_count}, NULL, false}};\n")
        return name

    def member_source(self, struct, member, r):
        if member.array:
            raise ScanError(f"{struct.name}.{member.name} is an array")
        if r.kind == "any":
            return self.source(member.type, ANY)
        groups = member.groups(self.macros) if member.type in VECTORS else []
        if groups:
            return self.group_source(struct, member, groups)
        if member.mask() and member.type == "hdrp_u32":
            return self.mask_source(member.mask())
        token = member.range(self.macros)
        if not token and member.type in self.structs:
            token = VALID
        if not token:
            raise ScanError(f"{struct.name}.{member.name} has no range in its comment, and the "
                            "comment of the struct no 'made by hdrp_...'")
        return self.source(member.type, token)

    def mask_source(self, prefix):
        return self.table("hdrp_u32", (prefix,),
                          [f"{v}u" for v in mask_samples(prefix, self.macros)])

    def group_source(self, struct, member, groups):
        """A vector whose components have ranges of their own."""
        name, is_new = self.name("source", (struct.name, member.name))
        if not is_new:
            return name
        integers = member.type == "hdrp_u32x4"
        rows, covered = [], 0
        for first, count, token in groups:
            covered += count
            if token.startswith("HDRP_"):
                kind, source = "hdrp_u32", self.mask_source(hdrp_api.MASK.match(token)[1])
            else:
                kind = "hdrp_u32" if integers else f"hdrp_v{count}" if count > 1 else "float"
                source = self.source(kind, hdrp_api.parse_range(token, self.macros))
            for i in range(count if integers else 1):
                rows.append(f"{{offsetof({member.type}, {'xyzw'[first + i]}), &{source}}}")
        if covered != VECTORS[member.type]:
            raise ScanError(f"the comment of {struct.name}.{member.name} gives a range to "
                            f"{covered} of {VECTORS[member.type]} components")
        self.declared.append(f"static fs_source {name};\n")
        parts, count = self.array("const fs_part", rows)
        self.defined.append(f"static fs_source {name} = {{sizeof({member.type}), 0, NULL, {parts}, "
                            f"{count}, NULL, 0, NULL, false}};\n")
        return name

    # Results

    def checks(self, kind, r, text="", offset="0"):
        """Rows of fs_check for a result of a type."""
        def row(rule, at, count=1, bounds=None):
            lo, hi, lo_open, hi_open = bounds or (0.0, 0.0, False, False)
            return (f"{{{rule}, {at}, {count}, {c_double(lo)}, {c_double(hi)}, "
                    f"{'true' if lo_open else 'false'}, {'true' if hi_open else 'false'}}}")

        def interval():
            within = WITHIN.search(text)
            lo, hi = f32(r.lo), f32(r.hi)
            for _ in range(int(within[1]) if within else 0):
                lo, hi = hdrp_api.next_down(lo), hdrp_api.next_up(hi)
            return lo, hi, r.lo_open, r.hi_open

        if r and r.kind == "any":
            return []
        if kind in self.structs:
            rows = []
            for m in self.structs[kind].members:
                token, comment, at = r, text, f"{offset} + offsetof({kind}, {m.name})"
                if r and r.kind == "valid":
                    token, comment = m.range(self.macros), m.comment
                    token = VALID if not token and m.type in self.structs else token
                    if m.type in FLOATS and m.groups(self.macros):
                        rows += self.group_checks(m, at)
                        continue
                rows += self.checks(m.type, token, comment, at)
            return rows
        if r and r.kind == "unit" and kind in FLOATS:
            return [row("FS_UNIT", offset, FLOATS[kind])]
        rows = []
        for _, at, number in self.leaves(kind, offset=offset):
            if number == "FS_U32" and r and r.kind == "interval":
                rows.append(row("FS_INTEGER", at, bounds=(float(r.lo), float(r.hi), r.lo_open,
                                                          r.hi_open)))
            elif number == "FS_F32" and r and r.kind == "interval":
                rows.append(row("FS_INTERVAL", at, bounds=interval()))
            elif number == "FS_F32":
                rows.append(row("FS_FINITE", at))
        return rows

    def group_checks(self, member, offset):
        rows = []
        for first, count, token in member.groups(self.macros):
            rows += self.checks(f"hdrp_v{count}" if count > 1 else "float",
                                hdrp_api.parse_range(token, self.macros), member.comment,
                                f"{offset} + {first} * sizeof(float)")
        return rows

    # Functions

    def function(self, f):
        """Identifier of the fs_function of f; a ScanError leaves one that fails."""
        name, is_new = self.name("function", (f.name,))
        if not is_new:
            return name
        self.declared.append(f"static const fs_function {name};\n")
        mark = len(self.declared), len(self.defined)
        known = dict(self.names)
        try:
            self.define(f, name)
        except (ScanError, RangeError) as error:
            # Half a table would not compile: forget what the attempt added.
            del self.declared[mark[0]:], self.defined[mark[1]:]
            self.names = known
            self.defined.append(f'static const fs_function {name} = {{"{f.name}", "{f.header}", '
                                f'"{error}", NULL, NULL, 0, NULL, 0, NULL, NULL}};\n')
        return name

    def define(self, f, name):
        if not f.doc or not f.doc.field("returns"):
            raise ScanError("its docstring has no fields")
        rows = []
        for p in f.parameters:
            entry = f.doc.field(p.name)
            token = entry.range(self.macros) if entry else None
            if not token:
                raise ScanError(f"parameter {p.name} has no range")
            rows.append(f'{{"{p.name}", &{self.type(p.type)}, &{self.source(p.type, token)}}}')
        returns = f.doc.field("returns")
        checks, check_count = self.array("const fs_check", self.checks(
            f.type, returns.range(self.macros), returns.text))
        result = self.type(f.type)
        arguments, count = self.array("const fs_argument", rows)
        unpack = [f"    {p.type} {p.name};\n    memcpy(&{p.name}, fs_arguments[{i}], "
                  f"sizeof {p.name});\n" for i, p in enumerate(f.parameters)]
        names = ", ".join(p.name for p in f.parameters)
        self.defined.append(
            f"static void call_{f.name}(const void* const* fs_arguments, void* fs_result)\n{{\n"
            f"{''.join(unpack)}    {f.type} fs_r = {f.name}({names});\n"
            "    (void)fs_arguments;\n    memcpy(fs_result, &fs_r, sizeof fs_r);\n}\n")
        requires = self.requires(f, unpack)
        self.defined.append(
            f'static const fs_function {name} = {{"{f.name}", "{f.header}", NULL, &{result}, '
            f"{checks}, {check_count}, {arguments}, {count}, call_{f.name}, {requires}}};\n")

    def requires(self, f, unpack):
        conditions = [text.split(";")[0].strip() for text in f.doc.all("requires")]
        if not conditions:
            return "NULL"
        unused = "".join(f"    (void){p.name};\n" for p in f.parameters)
        joined = " && ".join(f"({c})" for c in conditions)
        self.defined.append(f"static bool required_{f.name}(const void* const* fs_arguments)\n{{\n"
                            f"{''.join(unpack)}{unused}    return {joined};\n}}\n")
        return f"required_{f.name}"

    def text(self):
        entries = [f"&{self.function(f)}" for f in scanned(self.header)]
        listed = "".join(f"    {entry},\n" for entry in entries + ["NULL"])
        return (f'/* Written by tools/finite_scan.py from {self.header.name}. */\n'
                '#include "finite_scan.h"\n\n#include <string.h>\n\n'
                f'#include "{self.header.name}"\n\n' + "".join(self.declared) + "\n" +
                "\n".join(self.defined) +
                f"\nextern const fs_function* const fs_{self.header.module}[];\n"
                f"const fs_function* const fs_{self.header.module}[] = {{\n{listed}}};\n")


def scanned(header):
    """The public formulas, less the primitives and those whose docstring says 'scan none: why'."""
    return [f for f in header.functions()
            if f.is_formula and f.is_public and not f.is_primitive and
            not (f.doc and hdrp_api.NO_CLAIM.match(f.doc.get("scan") or ""))]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n")[0])
    pathlib.Path(sys.argv[2]).write_text(Writer(sys.argv[1]).text(), encoding="utf-8")


if __name__ == "__main__":
    main()
