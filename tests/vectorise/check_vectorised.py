#!/usr/bin/env python3
"""Every loop of loops.c and loops_pack_brdf.c is vectorised: check_vectorised.py ROOT.

hdrp_math.h promises it for gcc -O3 -fno-math-errno, and what selects before it divides needs
-fno-trapping-math besides; an unrelated edit that brings back a branch costs a factor of ten and no
other test would see it.
"""
import pathlib
import platform
import re
import subprocess
import sys

COMPILERS = {
    "gcc": (["-fopt-info-vec-optimized"], r"\.c:(\d+):\d+: optimized: loop vectorized"),
    "clang": (["-Rpass=loop-vectorize"], r"\.c:(\d+):\d+: remark: vectorized loop"),
}
SOURCES = {"loops.c": []}
if platform.machine() in ("x86_64", "AMD64"):  # hdrp_floor needs more than SSE2
    SOURCES["loops_pack_brdf.c"] = ["-fno-trapping-math", "-march=x86-64-v3"]


def scalar_loops(root, compiler, source, flags):
    """The names of all loops, and of those that stay scalar."""
    show, pattern = COMPILERS[compiler]
    loops = {number: re.match(r"LOOP\w*\((\w+)", line)[1]
             for number, line in enumerate(source.read_text().split("\n"), 1)
             if re.match(r"LOOP", line)}
    run = subprocess.run([compiler, "-std=c11", "-O3", "-fno-math-errno", *flags, *show,
                          f"-I{root}", "-c", str(source), "-o", "/dev/null"],
                         capture_output=True, text=True)
    if run.returncode:
        sys.exit(run.stderr)
    done = {int(number) for number in re.findall(pattern, run.stderr)}
    return loops, [loops[number] for number in sorted(set(loops) - done)]


def main():
    failures = count = 0
    for name, flags in SOURCES.items():
        for compiler in COMPILERS:
            loops, scalar = scalar_loops(sys.argv[1], compiler,
                                         pathlib.Path(__file__).parent / name, flags)
            count += len(loops)
            for loop in scalar:
                print(f"{compiler}: hdrp_{loop} is not vectorised")
            failures += len(scalar)
    print(f"{count} loops, {failures} failures")
    return failures != 0


if __name__ == "__main__":
    sys.exit(main())
