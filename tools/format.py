#!/usr/bin/env python3
"""Checks the layout of every C and C++ file with clang-format 14: format.py [--fix]

Other versions lay code out differently, so they are not used: without version 14 the check is
skipped (exit status 77).
"""
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUFFIXES = {".c", ".h", ".cpp", ".hpp"}
NOT_OURS = re.compile(r"^(build.*|dist|out|\..*)$")
SKIPPED = 77


def sources():
    """Every C and C++ file outside build folders, which may lie anywhere in the tree."""
    found, folders = [], [ROOT]
    while folders:
        for path in sorted(folders.pop().iterdir()):
            if path.is_dir() and not path.is_symlink():
                if not NOT_OURS.match(path.name):
                    folders.append(path)
            elif path.suffix in SUFFIXES:
                found.append(path)
    return found


def find_clang_format():
    for name in ("clang-format-14", "clang-format"):
        program = shutil.which(name)
        if program:
            version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout
            if re.search(r"version 14\.", version):
                return program
    return None


def main():
    program = find_clang_format()
    if not program:
        print("skipped: clang-format 14 is not installed (Debian: clang-format-14)")
        return SKIPPED
    mode = ["-i"] if "--fix" in sys.argv[1:] else ["--dry-run", "--Werror"]
    files = sources()
    result = subprocess.run([program, "--style=file", *mode, *map(str, files)])
    if result.returncode:
        print("style: run tools/format.py --fix")
    else:
        print(f"{len(files)} files")
    return result.returncode != 0


if __name__ == "__main__":
    sys.exit(main())
