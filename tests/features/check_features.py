#!/usr/bin/env python3
"""A feature that is off costs nothing: check_features.py ROOT.

The Lit model is compiled with a constant mask that lacks a feature, once from the header and once
from a copy of it in which the statements of that feature are cut out, so that no compiler has to
notice that they are dead. clang must make the same instructions and constants of both, to the byte.
gcc, whose numbers of variables and blocks decide ties of the register allocator, must make as many
of each instruction that computes something: moves, jumps and padding do not count. With the feature
on they must differ, or the test would see nothing. A second mask in the same file must not change
what the first one computes: compilers like to share one body among calls.
"""
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

FEATURES = ("CLEAR_COAT", "ANISOTROPY", "IRIDESCENCE", "TRANSMISSION", "REFRACTION")
BUILDS = (("gcc", "-O2"), ("clang", "-O2"))
FLAGS = ["-std=c11", "-march=x86-64-v3", "-fno-math-errno", "-fno-trapping-math", "-Wall",
         "-Wno-unused-variable", "-Wno-unused-function"]
# What gcc adds where it likes.
NO_WORK = re.compile(r"v?mov|j|nop|xchg|data16|cs$|lea|push|pop|\.byte")

# What a second mask may change of the first: what compilers keep for both, a constant here and there.
MOST_CHANGE = 0.02


def matching(text, start, closing):
    """The position of the bracket that closes the one at start, of any kind."""
    depth = 0
    for i in range(start, len(text)):
        depth += text[i] in "([{"
        depth -= text[i] in ")]}"
        if depth == 0 and text[i] == closing:
            return i
    raise ValueError("brackets do not match")


def end_of_operand(text, start):
    """Where the last operand of a ?: ends: at a ; or , of its level, or the bracket around it."""
    depth = 0
    for i in range(start, len(text)):
        if depth == 0 and text[i] in ";,)":
            return i
        depth += text[i] in "([{"
        depth -= text[i] in ")]}"
    raise ValueError("an expression does not end")


def without(text, feature):
    """The header without the if statements and without the ?: that ask for a feature."""
    ask = re.compile(rf"\((?:\w+\.)?features & HDRP_BRDF_FEATURE_{feature}\) != 0u")
    while match := ask.search(text):
        at = match.start()
        line = text[:at].rsplit(";", 1)[-1].rsplit("{", 1)[-1]
        condition = re.search(r"(?:\belse )?\bif \((?!.*\bif \()", line, re.S)
        if condition:
            start = at - len(line) + condition.start()
            close = matching(text, text.index("(", start), ")")
            end = matching(text, text.index("{", close), "}") + 1
            text = text[:start] + text[end:].lstrip()
        else:
            choice = text.index("?", at)
            colon = text.index(":", choice)
            end = end_of_operand(text, colon + 1)
            text = text[:at] + text[colon + 1:end].strip() + text[end:]
    return text


def made(compiler, level, headers, source, folder, *definitions):
    """The object file."""
    target = folder / "lit.o"
    subprocess.run([compiler, level, *FLAGS, f"-I{headers}", *definitions, "-c", str(source), "-o",
                    str(target)], check=True)
    return target


def work_of_first(target):
    """How many instructions each function of the first mask has that compute something."""
    listing = subprocess.run(["objdump", "-d", "--no-show-raw-insn", str(target)], check=True,
                             capture_output=True, text=True).stdout
    functions = re.findall(r"<(first_\w+)>:\n(.*?)(?:\n\n|\Z)", listing, re.S)
    return {name: sum(not NO_WORK.match(i) for i in re.findall(r"^ *[0-9a-f]+:\t(\S+)", body, re.M))
            for name, body in functions}


def compiled(compiler, level, headers, source, mask, folder):
    """What the compilers make of it, as far as it must be equal."""
    target = made(compiler, level, headers, source, folder, f"-DMASK={mask}")
    show = ["-s", "-j", ".text", "-j", ".rodata*"] if compiler == "clang" else []
    listing = subprocess.run(["objdump", "-d", "-r", "--no-show-raw-insn", *show, str(target)],
                             check=True, capture_output=True, text=True).stdout
    if compiler == "clang":
        return listing
    names = re.findall(r"^ *[0-9a-f]+:\t(\S+)", listing, re.M)
    return collections.Counter(name for name in names if not NO_WORK.match(name))


def main():
    root = pathlib.Path(sys.argv[1])
    source = pathlib.Path(__file__).parent / "lit.c"
    everything = " | ".join(f"HDRP_BRDF_FEATURE_{f}" for f in FEATURES)
    failures = checks = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        header = (root / "hdrp_brdf.h").read_text()
        for feature in FEATURES:
            copy = folder / feature
            copy.mkdir()
            for path in root.glob("hdrp_*.h"):
                (copy / path.name).write_bytes(path.read_bytes())
            (copy / "hdrp_brdf.h").write_text(without(header, feature))
        for compiler, level in BUILDS:
            on = compiled(compiler, level, root, source, f"({everything})", folder)
            plain = compiled(compiler, level, root, source, "0u", folder)
            alone = work_of_first(made(compiler, level, root, source, folder, "-DMASK=0u"))
            beside = work_of_first(made(compiler, level, root, source, folder, "-DMASK=0u",
                                        f"-DOTHER_MASK=({everything})"))
            checks += 1
            if any(abs(alone[name] - beside[name]) > MOST_CHANGE * alone[name] for name in alone):
                print(f"{compiler} {level}: a second mask changes what the first computes")
                failures += 1
            for feature in FEATURES:
                others = f"(({everything}) & ~HDRP_BRDF_FEATURE_{feature})"
                for mask in ("0u", others):
                    off = plain
                    if mask != "0u":
                        off = compiled(compiler, level, root, source, mask, folder)
                    cut = compiled(compiler, level, folder / feature, source, mask, folder)
                    checks += 1
                    if off != cut:
                        print(f"{compiler} {level}: {feature} is off and leaves something behind, "
                              f"mask {mask}")
                        failures += 1
                if off == on:
                    print(f"{compiler} {level}: {feature} makes no difference when it is on")
                    failures += 1
    print(f"{checks} comparisons, {failures} failures")
    return failures != 0


if __name__ == "__main__":
    sys.exit(main())
