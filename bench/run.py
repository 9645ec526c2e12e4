#!/usr/bin/env python3
"""Runs bench_cpu and keeps its results by the name of the processor: run.py BENCH_CPU FOLDER"""
import pathlib
import re
import subprocess
import sys


def machine():
    """The processor in a file name: "AMD EPYC 9354 32-Core Processor" gives amd-epyc-9354."""
    words = re.sub(r"\(r\)|\(tm\)|@.*|\d+-core|processor|cpu", " ", model().lower())
    return "-".join(re.findall(r"[a-z0-9.]+", words))


def model():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    return re.search(r"^model name\s*:\s*(.*)$", text, re.M)[1]


def remark(text):
    """The first line of a file of results: what it was measured on."""
    versions = [subprocess.run([compiler, "-dumpfullversion", "-dumpversion"], text=True,
                               capture_output=True).stdout.split()[0]
                for compiler in ("gcc", "clang")]
    return f"# {model()}, gcc {versions[0]}, clang {versions[1]}: {text}\n"


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(exist_ok=True)
    name = machine()
    cpu, features = folder / f"cpu_{name}.csv", folder / f"features_cpu_{name}.csv"
    done = subprocess.run([program, "--csv", cpu, "--features-csv", features])
    if done.returncode == 0:
        for path in (cpu, features):
            path.write_text(remark("one pinned core, medians; flags in bench/README.md") +
                            path.read_text())
        print(f"wrote {cpu} and {features}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
