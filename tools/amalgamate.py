#!/usr/bin/env python3
"""Writes the one-file headers: amalgamate.py FOLDER

For each hdrp_<module>.h a file of the same name that needs no other hdrp file, and hdrp.h with all
of them but those that need a header of a graphics API. A one-file header is the plain headers one after the other, what is needed first, with
their include lines removed and their guards kept. So any of the files may be included together, in
C, C++, GLSL and HLSL alike, and an HDRP_<MODULE>_IMPLEMENTATION works as in the plain header.
"""
import pathlib
import re
import sys

import hdrp_api

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"(?P<name>hdrp_\w+\.h)"[^\n]*\n', re.M)
GRAPHICS = re.compile(r"^#include <vulkan/", re.M)
VERSION = re.compile(r"^#define HDRP_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", re.M)


def in_order(name, texts, done, open_files=()):
    """Appends to done what the header needs, then the header itself."""
    if name in open_files:
        sys.exit("amalgamate: headers include each other: " + " > ".join([*open_files, name]))
    if name not in texts:
        sys.exit(f"amalgamate: {open_files[-1]} includes {name}, which does not exist")
    if name not in done:
        for match in INCLUDE.finditer(texts[name]):
            in_order(match["name"], texts, done, (*open_files, name))
        done.append(name)
    return done


def amalgamation(title, names, texts, version):
    parts = [f"/* {title} - one-file version of hdrp {version}, generated; it contains\n"
             + "".join(f" *     {name}\n" for name in names)
             + " * whose own comments below say how to use it. SPDX-License-Identifier: MIT */\n"]
    for name in names:
        parts.append(f"\n/* ---- {name} ---- */\n" + INCLUDE.sub("", texts[name]).strip() + "\n")
    license_text = (hdrp_api.ROOT / "LICENSE").read_text().strip()
    parts.append("\n/*\n" + license_text + "\n*/\n")
    return "".join(parts)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.splitlines()[0])
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for stale in folder.glob("hdrp*.h"):
        stale.unlink()
    texts = {path.name: path.read_text() for path in hdrp_api.headers()}
    version = ".".join(VERSION.findall(texts["hdrp_math.h"]))
    everything = []
    for name in texts:
        files = in_order(name, texts, [])
        if not any(GRAPHICS.search(texts[file]) for file in files):
            in_order(name, texts, everything)
        (folder / name).write_text(amalgamation(name, files, texts, version))
    (folder / "hdrp.h").write_text(amalgamation("hdrp.h", everything, texts, version))
    print(f"{len(texts) + 1} headers in {folder}")


if __name__ == "__main__":
    main()
