#!/usr/bin/env python3
"""Writes docs/REFERENCES.md from the "source" lines of the docstrings: references.py [--check]

With --check it writes nothing and fails when the file is not what it would write.
"""
import re
import sys

import hdrp_api

TARGET = hdrp_api.ROOT / "docs" / "REFERENCES.md"
# Authors 2012, "Title"
WORK = re.compile(r"""[A-Z][\w.'-]*(?:,?\ (?:and|et|al\.|da|de|der|van|von|[A-Z][\w.'-]*))*
                      \ (?:1\d|20)\d\d,\ "[^"]+\"""", re.X)
HEADING = """# References

Where every formula comes from, by work. Generated from the docstrings by `tools/references.py`.
"""


def citations():
    """(work or None, place in it, function) of every source; a field may cite several works."""
    result = []
    for path in hdrp_api.headers():
        for function in hdrp_api.functions(path):
            for text in (function.doc.all("source") if function.doc else []):
                works = list(WORK.finditer(text))
                if not works and not re.match(r"see |a definition$", text):
                    result.append((None, text, function))
                ends = [match.start() for match in works[1:]] + [len(text)]
                for match, end in zip(works, ends):
                    place = text[match.end():end].strip(" ,;:)")
                    result.append((match[0], re.sub(r"[,;]? and$", "", place), function))
    return result


def document():
    by_work, others = {}, []
    for work, place, function in citations():
        line = f"- `{function.name}` ({function.header})" + (f": {place}" if place else "")
        (by_work.setdefault(work, []) if work else others).append(line)
    lines = [HEADING]
    for work in sorted(by_work, key=str.casefold):
        lines += [f"## {work}", "", *by_work[work], ""]
    if others:
        lines += ["## Specifications, definitions and derivations", "", *others, ""]
    return "\n".join(lines)


def main():
    text = document()
    if sys.argv[1:] == ["--check"]:
        if not TARGET.exists() or TARGET.read_text() != text:
            print(f"{TARGET.relative_to(hdrp_api.ROOT)} is out of date: run tools/references.py")
            return 1
        return 0
    if sys.argv[1:]:
        sys.exit(__doc__.splitlines()[0])
    TARGET.parent.mkdir(exist_ok=True)
    TARGET.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
