#!/usr/bin/env python3
"""Writes the accuracy claims of the docstrings as a C table: accuracy_claims.py OUTPUT."""
import pathlib
import sys

import hdrp_api


def main():
    rows = [f'{{"{c.id}", "{c.function}", "{c.header}", {c.bound!r}, "{c.unit}"}},'
            for c in hdrp_api.claims()]
    pathlib.Path(sys.argv[1]).write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
