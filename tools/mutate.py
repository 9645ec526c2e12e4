#!/usr/bin/env python3
"""Writes headers in which any constant or operator can be made wrong at run time:
mutate.py FOLDER.

FOLDER gets a copy of every public header and mutants.inc, a table of what can go wrong. In the
copy each numeric constant c is written HDRP_MUTANT_SCALE(k, c), which multiplies by 1 unless mutant
k is switched on, so that one program holds all mutants: nothing is compiled again, and switched off
they change no bit of a result. Signs, comparisons, products and quotients are wrapped in the same
way, on a sample of the places where they occur.

Guards and limits are left out: literals that are an argument of LIMITERS, and what
tests/mutation/exclusions.txt names, with the reason. Zeros and integers have no relative error to
make.
"""
import pathlib
import re
import sys
import zlib
from collections import Counter
from dataclasses import dataclass

import hdrp_api

EXCLUSIONS = hdrp_api.ROOT / "tests/mutation/exclusions.txt"

LITERAL = re.compile(r"(?<![\w.])(?:\d+\.\d*|\.\d+|\d+(?=[eE]|f\b))(?:[eE][+-]?\d+)?f?(?![\w.])")
LITERAL_EXPONENT = re.compile(r"\d[eE][-+]$")
SIGN = re.compile(r"(?<![-+eE])[-+](?![-+=>])|(?<=[A-Za-z_]e)[-+](?![-+=>])")
COMPARISON = re.compile(r"(?<![<>=!-])(?:<=|>=|<|>)(?![<>=])")
FACTOR = re.compile(r"(?<=[\w)\]] )([*/]) (?=[\w(])")

# A literal that is a whole argument of these is a limit.
LIMITERS = re.compile(r"(?<!\w)hdrp_(?:clamp|min|max)$")

# One operator in so many is tried.
SAMPLED = {"sign": 6, "comparison": 4, "factor": 8}
# Relative changes of a constant. Coefficients of a fit that is itself wrong by a percent are
# marked in exclusions.txt.
FINE, COARSE = 1e-3, 1e-2
# Of exclusions.txt; all but the last leave a place as it is.
WORDS = ("guard", "limit", "same", "coarse")


@dataclass
class Mutant:
    header: str
    line: int
    owner: str  # function or macro it stands in
    kind: str  # constant, sign, comparison or factor
    text: str
    occurrence: int  # of this text in its owner, from 1
    amount: float = 0.0

    @property
    def key(self):
        return f"{self.owner} {self.text} {self.occurrence}"


class Exclusions:
    """What exclusions.txt says: words by owner, by owner and text, or by the key of one mutant."""

    def __init__(self, text):
        self.words, self.used, self.counts = {}, set(), Counter()
        for line in text.split("\n"):
            word, *name = line.split("#")[0].split() or [""]
            if word and word not in WORDS:
                sys.exit(f"mutate: no such word: {line}")
            if word:
                self.words[" ".join(name)] = word

    def word(self, mutant):
        """The word for a mutant, the most particular first, or ""."""
        for name in (mutant.key, f"{mutant.owner} {mutant.text}", mutant.owner):
            if name in self.words:
                self.used.add(name)
                return self.words[name]
        return ""

    def unused(self):
        return sorted(set(self.words) - self.used)


def bodies(code):
    """(owner, start, end, is formula) of each function body and macro value."""
    for match in hdrp_api.DECLARATION.finditer(code):
        closing = hdrp_api.matching(code, match.end() - 1, "()")
        tail = re.match(r"\s*\{", code[closing + 1:]) if closing > 0 else None
        if tail and match["type"].split()[0] not in ("return", "else", "typedef"):
            start = closing + 1 + tail.end() - 1
            yield match["name"], start + 1, hdrp_api.matching(code, start, "{}"), \
                match["qualifier"] == "HDRP_FN"
    # A macro's value may go on behind a backslash.
    for match in re.finditer(r"^#\s*define\s+(HDRP_\w+)((?:[^\n]*\\\n)*[^\n]*)", code, re.M):
        yield match[1], match.start(2), match.end(2), False


def operand_end(code, start):
    """End of the primary expression with its calls, members and subscripts that begins at start."""
    at = start
    match = re.compile(r"(?:\w|\.(?=\d))[\w.]*(?:(?<=\d[eE])[-+]\d+f?)?").match(code, at)
    if match:
        at = match.end()
    while at < len(code) and code[at] in "([.":
        if code[at] == ".":
            at = re.compile(r"\.\w+").match(code, at).end()
        else:
            at = hdrp_api.matching(code, at, "()" if code[at] == "(" else "[]") + 1
    return at


def expression_around(code, start, end):
    """Bounds of the arithmetic expressions on both sides of the comparison at start..end; None
    where it belongs to a loop, whose end a mutant must not move."""
    depth, left = 0, start - 1
    while left >= 0:
        c = code[left]
        if c in ")]":
            depth += 1
        elif c in "([":
            if depth == 0:
                break
            depth -= 1
        elif depth == 0 and (c in "?:,;{=" or code[left - 1:left + 1] in ("&&", "||")
                             or re.match(r"return\b", code[left - 5:left + 1] or "")
                             or code[left - 5:left + 1] == "return"):
            break
        left -= 1
    depth, right = 0, end
    while right < len(code):
        c = code[right]
        if c in "([":
            depth += 1
        elif c in ")]":
            if depth == 0:
                break
            depth -= 1
        elif depth == 0 and (c in "?:,;" or code[right:right + 2] in ("&&", "||")):
            break
        right += 1
    if left < 0 or right >= len(code) or code[left] == ";" and "for (" in \
            code[code.rfind("\n", 0, left) + 1:left]:
        return None
    return left + 1, right


def is_limit(code, start, end):
    """Whether the literal at start..end is, but for a sign, a whole argument of LIMITERS."""
    before = code[:start].rstrip(" \n-")
    if code[end:].lstrip()[:1] not in (",", ")") or before[-1:] not in ("(", ","):
        return False
    depth, at = 0, len(before) - 1
    while depth or code[at] not in "({};":
        depth += {")": 1, "(": -1}.get(code[at], 0)
        at -= 1
    return code[at] == "(" and bool(LIMITERS.search(code, 0, at))


def is_sampled(mutant):
    return zlib.crc32(mutant.key.encode()) % SAMPLED[mutant.kind] == 0


class Mutator:
    """Collects the edits of one header: (offset, end, text) with {k} for the number."""

    def __init__(self, header, excluded, first):
        self.header, self.excluded, self.first = header, excluded, first
        self.code = header.code
        self.mutants, self.edits, self.seen = [], [], Counter()

    def add(self, place, owner, kind, edits):
        text = self.code[slice(*place)]
        self.seen[owner, text] += 1
        mutant = Mutant(self.header.name, self.header.line_of(place[0]), owner, kind, text,
                        self.seen[owner, text])
        word = self.excluded.word(mutant)
        if kind == "constant" and word in ("", "coarse") and is_limit(self.code, *place):
            word = "limit"
        if word and word != "coarse":
            self.excluded.counts[word] += kind == "constant"
            return
        if kind == "constant":
            mutant.amount = COARSE if word == "coarse" else FINE
        elif not is_sampled(mutant):
            return
        number = self.first + len(self.mutants)
        self.mutants.append(mutant)
        self.edits += [(start, end, new.format(k=number)) for start, end, new in edits]

    def constants(self, owner, start, end):
        for match in LITERAL.finditer(self.code, start, end):
            if float(match[0].rstrip("f")) != 0.0:
                self.add(match.span(), owner, "constant",
                         [(match.start(), match.start(), "HDRP_MUTANT_SCALE({k}, "),
                          (match.end(), match.end(), ")")])

    def operators(self, owner, start, end):
        for match in SIGN.finditer(self.code, start, end):
            line = self.code[self.code.rfind("\n", 0, match.start()):match.start()]
            if "case " not in line and "#" not in line and not \
                    LITERAL_EXPONENT.search(self.code[match.start() - 4:match.start() + 1]):
                self.add(match.span(), owner, "sign",
                         [(match.end(), match.end(), " HDRP_MUTANT_SIGN({k}) *")])
        for match in COMPARISON.finditer(self.code, start, end):
            around = expression_around(self.code, match.start(), match.end())
            if around and around[0] > start and around[1] < end:
                self.add(match.span(), owner, "comparison",
                         [(around[0], around[0], " HDRP_MUTANT_NOT({k}, "),
                          (around[1], around[1], ")")])
        for match in FACTOR.finditer(self.code, start, end):
            stop = operand_end(self.code, match.end())
            if stop > match.end() and self.code[match.end():match.end() + 2] != "(h":
                self.add(match.span(1), owner, "factor",
                         [(match.end(), match.end(), "HDRP_MUTANT_RECIPROCAL({k}, "),
                          (stop, stop, ")")])

    def run(self):
        for owner, start, end, is_formula in bodies(self.code):
            self.constants(owner, start, end)
            if is_formula:
                self.operators(owner, start, end)
        return self

    def text(self):
        # What opens at one place nests the longer span outside; what closes there, the other way.
        text = self.header.text
        for start, _, new in sorted(self.edits, key=lambda e: e[0], reverse=True):
            text = text[:start] + new + text[start:]
        # A table in a function may then hold what is no constant to the compiler.
        return re.sub(r"^( +)static (const \w+ \w+\[\d*\] = )", r"\1\2", text, flags=re.M)


def write_mutants(folder, paths, excluded):
    """Writes the headers and mutants.inc into folder; the mutants, number 1 first."""
    folder.mkdir(parents=True, exist_ok=True)
    mutants = []
    for path in paths:
        mutator = Mutator(hdrp_api.header(path), excluded, len(mutants) + 1)
        mutator.run()
        mutants += mutator.mutants
        text = mutator.text()
        if path.name == "hdrp_math.h":
            text = '#include "mutant.h"\n' + text
        (folder / path.name).write_text(text)
    rows = [f'{{"{m.header}", {m.line}, "{m.kind}", "{m.key}", {m.amount!r}f}},' for m in mutants]
    (folder / "mutants.inc").write_text("\n".join(rows) + "\n")
    return mutants


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.split("\n")[0])
    excluded = Exclusions(EXCLUSIONS.read_text())
    mutants = write_mutants(pathlib.Path(sys.argv[1]), hdrp_api.headers(), excluded)
    kinds = Counter(mutant.kind for mutant in mutants)
    print(", ".join(f"{n} {kind}s" for kind, n in sorted(kinds.items())))
    print("left out: " + ", ".join(f"{n} {word}" for word, n in sorted(excluded.counts.items())))
    if excluded.unused():
        sys.exit(f"mutate: {EXCLUSIONS.name} names what is not there: {excluded.unused()}")


if __name__ == "__main__":
    main()
