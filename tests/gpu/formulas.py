#!/usr/bin/env python3
"""Formulas on the device and in C: formulas.py [--record] PROGRAM [FUNCTION...]

PROGRAM is made of formulas.c. Every formula that the finite scan calls becomes a compute shader,
and its results are compared with those of the C build. With what tests/gpu/formulas_DRIVER.csv was
recorded with, the table must be the same. Otherwise no number may be far off, by more than 2^-10
absolute or relative, or be NaN or another integer where it should not.

What is more than 1024 ulp away, or far off, needs its reason in tests/gpu/formulas_known.csv; with
the recorded driver a reason for which there is no such number fails too. Exit status 77 without a
device or a shader compiler.

A FUNCTION only prints its line, and the arguments of its worst result.
"""
import argparse
import csv
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
sys.path.insert(0, str(ROOT / "tools"))
import finite_scan  # noqa: E402  pylint: disable=wrong-import-position
import gcn_probe  # noqa: E402  pylint: disable=wrong-import-position
import gcn_shaders  # noqa: E402  pylint: disable=wrong-import-position
import hdrp_api  # noqa: E402  pylint: disable=wrong-import-position

KNOWN = FOLDER / "formulas_known.csv"
SKIPPED = 77
SHOWN = 20


def write_shaders(compiler, folder, chosen):
    """FOLDER/<function>.spv for every formula of the finite scan, or those that are chosen."""
    names = {f.name for path in hdrp_api.headers()
             for f in finite_scan.scanned(hdrp_api.header(path))
             if not chosen or f.name in chosen}
    for module in gcn_shaders.formula_modules(ROOT, names) if names else []:
        source, binary = folder / f"{module.name}.comp", folder / f"{module.name}.all"
        source.write_text(module.text, encoding="utf-8")
        gcn_probe.run([compiler, "-V", f"-I{ROOT}", source, "-o", binary])
        entries = {shader.entry: shader.name for shader in module.shaders}
        for entry, words in gcn_probe.separate(gcn_probe.words_of(binary.read_bytes()),
                                               sorted(entries)):
            (folder / f"{entries[entry]}.spv").write_bytes(words)


def versions(compiler, driver):
    """One line that names everything the table depends on."""
    said = gcn_probe.run([compiler, "--version"], text=True)
    glslang = re.search(r"Glslang Version: (\S+)", said)[1]
    return f"{driver}, glslang {glslang}, {' '.join(platform.libc_ver())}, {platform.machine()}"


def record_path(driver):
    """Named by the device and the version of Mesa, or the first one that the driver tells."""
    name = re.match(r"\w+", driver)[0].lower()
    version = re.search(r"\bMesa ([0-9.]+)", driver) or re.search(r"([0-9]+(?:\.[0-9]+)+)", driver)
    return FOLDER / f"formulas_{name}-{version[1] if version else 'unknown'}.csv"


def rows_of(lines):
    return list(csv.DictReader(lines))


def problems(rows, recorded, known):
    """Lines about what is not as it has to be; recorded: the rows of this driver, or None."""
    found = []
    for row in rows:
        away = int(row["far"]) if recorded is None else sum(
            int(row[column]) for column in ("beyond", "different", "far"))
        if away and row["function"] not in known:
            found.append(f"{row['function']} is off, for no reason in {KNOWN.name}: {row['worst']}")
        if recorded is not None and not away and row["function"] in known:
            found.append(f"{row['function']} is not off, and has a reason in {KNOWN.name}")
    new = {row["function"]: row for row in rows}
    found += [f"{name} has a reason in {KNOWN.name}, but there is no such formula"
              for name in known if name not in new]
    if recorded is not None:
        old = {row["function"]: row for row in recorded}
        for name in [*old, *(name for name in new if name not in old)]:
            if old.get(name) != new.get(name):
                found += [f"recorded: {text(old.get(name))}\n  measured: {text(new.get(name))}"]
    return found


def text(row):
    return ",".join(row.values()) if row else "nothing"


def report(rows):
    """How many formulas are how close."""
    def within(columns):
        return sum(int(row["results"]) == sum(int(row[column]) for column in columns)
                   for row in rows)
    near = ["equal", "ulp_1", "ulp_4", "ulp_64", "ulp_1024"]
    print(f"{len(rows)} formulas: {within(near[:1])} equal, {within(near[:2])} within 1 ulp, "
          f"{within(near[:4])} within 64, {within(near)} within 1024")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--record", action="store_true")
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("functions", nargs="*", metavar="FUNCTION")
    options = parser.parse_args()
    compiler = shutil.which("glslangValidator")
    if not compiler:
        print("skipped: glslangValidator is not installed (Debian: glslang-tools)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        write_shaders(compiler, pathlib.Path(folder), options.functions)
        # The driver keeps what it compiled in a cache of the user; a test begins without.
        done = subprocess.run([options.program.resolve(), folder, *options.functions],
                              stdout=subprocess.PIPE, text=True, check=False,
                              env=dict(os.environ, MESA_SHADER_CACHE_DISABLE="true"))
    if done.returncode != 0 or options.functions:
        print(done.stdout, end="")
        return done.returncode
    device, driver, *table = done.stdout.splitlines()
    driver = driver.removeprefix("driver: ")
    print(device)
    return judge(driver, f"# {versions(compiler, driver)}", table, options.record)


def judge(driver, head, table, is_recorded):
    path, rows, recorded = record_path(driver), rows_of(table), None
    report(rows)
    if is_recorded:
        path.write_text("\n".join([head, *table, ""]), encoding="utf-8")
        print(f"wrote {path}")
    if path.exists():
        old_head, *old_table = path.read_text(encoding="utf-8").splitlines()
        if old_head == head:
            recorded = rows_of(old_table)
        else:
            print(f"{path.name} is for {old_head.lstrip('# ')}; this is {head.lstrip('# ')}")
    else:
        print(f"nothing is recorded for {head.lstrip('# ')}")
    known = {row["function"]: row["reason"]
             for row in rows_of(KNOWN.read_text(encoding="utf-8").splitlines())}
    found = problems(rows, recorded, known)
    for line in found[:SHOWN]:
        print(f"  {line}")
    if found:
        print(f"{len(found)} differences. If what changed is meant: ninja gpu_formulas_record")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
