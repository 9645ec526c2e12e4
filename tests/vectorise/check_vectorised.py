#!/usr/bin/env python3
"""Every loop of loops.c is vectorised: check_vectorised.py ROOT.

hdrp_math.h promises it for gcc -O3 -fno-math-errno; an unrelated edit that brings back a branch
costs a factor of ten and no other test would see it.
"""
import pathlib
import re
import subprocess
import sys

COMPILERS = {
    "gcc": (["-fopt-info-vec-optimized"], r"loops\.c:(\d+):\d+: optimized: loop vectorized"),
    "clang": (["-Rpass=loop-vectorize"], r"loops\.c:(\d+):\d+: remark: vectorized loop"),
}


def main():
    source = pathlib.Path(__file__).parent / "loops.c"
    loops = {number: re.match(r"LOOP\w*\((\w+)", line)[1]
             for number, line in enumerate(source.read_text().split("\n"), 1)
             if re.match(r"LOOP", line)}
    failures = 0
    for compiler, (flags, pattern) in COMPILERS.items():
        run = subprocess.run([compiler, "-std=c11", "-O3", "-fno-math-errno", *flags,
                              f"-I{sys.argv[1]}", "-c", str(source), "-o", "/dev/null"],
                             capture_output=True, text=True)
        if run.returncode:
            sys.exit(run.stderr)
        done = {int(number) for number in re.findall(pattern, run.stderr)}
        for number in sorted(set(loops) - done):
            print(f"{compiler}: hdrp_{loops[number]} is not vectorised")
            failures += 1
    print(f"{len(loops)} loops, {failures} failures")
    return failures != 0


if __name__ == "__main__":
    sys.exit(main())
