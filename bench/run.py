#!/usr/bin/env python3
"""Runs both programs and keeps their results by the name of the processor:
run.py BENCH_CPU BENCH_CULL FOLDER"""
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


def run(program, results):
    """Runs a program that writes results, a file for each of its options."""
    command = [program, *(word for option, path in results.items() for word in (option, path))]
    status = subprocess.run(command).returncode
    if status == 0:
        for path in results.values():
            path.write_text(remark("one pinned core, medians; flags in bench/README.md") +
                            path.read_text())
            print(f"wrote {path}")
    return status


def main():
    bench_cpu, bench_cull, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    folder.mkdir(exist_ok=True)
    name = machine()
    return (run(bench_cpu, {"--csv": folder / f"cpu_{name}.csv",
                            "--features-csv": folder / f"features_cpu_{name}.csv"}) or
            run(bench_cull, {"--csv": folder / f"cull_cpu_{name}.csv"}))


if __name__ == "__main__":
    sys.exit(main())
