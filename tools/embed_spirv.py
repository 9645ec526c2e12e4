#!/usr/bin/env python3
"""Compiles shaders/*.comp and writes their SPIR-V into headers: embed_spirv.py [--check]

Each shader becomes an array of words, hdrp_i_gpu_vk_spirv_<name>, between the markers in the header
that it names in a line "// header: hdrp_gpu_vk_<topic>.h":
compiled by glslangValidator, optimised and stripped by spirv-opt, checked by spirv-val. A shader
that says "// contraction: none" has its sums and products decorated with NoContraction first, so
that neither spirv-opt nor a driver rounds them in another way than C does. One that says
"// inline: none" keeps its functions, which drivers inline anyway: long formulas that are called
from several places are embedded once.

With --check nothing is written: exit status 1 when the words in a header are stale. Other versions
of the compilers make other words, so that without the pinned ones the check is skipped (exit status
77), and writing is refused.
"""
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = "vulkan1.1"
BEGIN, END = "/* >>spirv", "/* >>end of spirv */"
WORDS_IN_LINE = 8
SKIPPED = 77
PINNED = {"glslangValidator": "Glslang Version: 11:12.0.0",
          "spirv-opt": "SPIRV-Tools v2023.1", "spirv-val": "SPIRV-Tools v2023.1"}
HEADER = re.compile(r"^// header: (\w+\.h)$", re.M)
NO_INLINING = re.compile(r"^// inline: none$", re.M)
# What -O does, without the passes that inline and those that follow up on it.
WITHOUT_INLINING = ("eliminate-dead-functions private-to-local scalar-replacement=100 "
                    "convert-local-access-chains eliminate-local-single-block "
                    "eliminate-local-single-store ssa-rewrite ccp eliminate-dead-code-aggressive "
                    "redundancy-elimination simplify-instructions "
                    "eliminate-dead-code-aggressive compact-ids").split()
NO_CONTRACTION = re.compile(r"^// contraction: none$", re.M)

MAGIC, HEADER_WORDS = 0x07230203, 5
OP_DECORATE, OP_MEMBER_DECORATE, DECORATION_NO_CONTRACTION = 71, 72, 42
# FNegate, FAdd, FSub, FMul, FDiv, FRem, FMod, VectorTimesScalar, MatrixTimesScalar,
# VectorTimesMatrix, MatrixTimesVector, MatrixTimesMatrix, OuterProduct, Dot
ARITHMETIC = {127, 129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 147, 148}


class ToolError(Exception):
    pass


def missing_programs():
    """What is not installed, or not in the pinned version."""
    problems = []
    for program, version in PINNED.items():
        if not shutil.which(program):
            problems.append(f"{program} is not installed")
            continue
        said = subprocess.run([program, "--version"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True).stdout  # spirv-opt: the latter
        if not re.search(rf"^{re.escape(version)}(?!\S)", said, re.M):
            problems.append(f"{program} is not of the version '{version}'")
    return problems


def run(*command):
    result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    if result.returncode:
        raise ToolError(f"{' '.join(str(word) for word in command)}\n{result.stdout}")


def instructions(words):
    """(first word, opcode, number of words) of the instructions of a module."""
    at = HEADER_WORDS
    while at < len(words):
        count, opcode = words[at] >> 16, words[at] & 0xffff
        if count == 0 or at + count > len(words):
            raise ToolError("a module with an instruction of no length")
        yield at, opcode, count
        at += count


def without_contraction(words):
    """The module with NoContraction on the result of every arithmetic instruction."""
    results, decorated, place = [], set(), None
    for at, opcode, count in instructions(words):
        if opcode in (OP_DECORATE, OP_MEMBER_DECORATE):
            place = at + count  # behind the last of the decorations
            if opcode == OP_DECORATE and words[at + 2] == DECORATION_NO_CONTRACTION:
                decorated.add(words[at + 1])
        elif opcode in ARITHMETIC:
            results.append(words[at + 2])
    if place is None:
        raise ToolError("a module without decorations")
    added = []
    for result in results:
        if result not in decorated:
            added += [3 << 16 | OP_DECORATE, result, DECORATION_NO_CONTRACTION]
    return words[:place] + added + words[place:]


def read_words(path):
    data = path.read_bytes()
    words = list(struct.unpack(f"<{len(data) // 4}I", data))
    if not words or words[0] != MAGIC:
        raise ToolError(f"{path.name} is no SPIR-V module")
    return words


def write_words(path, words):
    path.write_bytes(struct.pack(f"<{len(words)}I", *words))


def compiled(source, include, folder):
    """The words of a shader."""
    plain, final = folder / f"{source.stem}.spv", folder / f"{source.stem}.final.spv"
    run("glslangValidator", "-V", "--target-env", TARGET, f"-I{include}", source, "-o", plain)
    text = source.read_text(encoding="utf-8")
    if NO_CONTRACTION.search(text):
        write_words(plain, without_contraction(read_words(plain)))
    passes = [f"--{name}" for name in WITHOUT_INLINING] if NO_INLINING.search(text) else ["-O"]
    run("spirv-opt", *passes, "--strip-debug", f"--target-env={TARGET}", plain, "-o", final)
    run("spirv-val", "--target-env", TARGET, final)
    return read_words(final)


def array_text(name, words):
    lines = [f"static const uint32_t hdrp_i_gpu_vk_spirv_{name}[] = {{"]
    for at in range(0, len(words), WORDS_IN_LINE):
        lines.append("    " + " ".join(f"0x{word:08x}," for word in words[at:at + WORDS_IN_LINE]))
    return "\n".join(lines + ["};"])


def generated(modules):
    """The text between the markers, both included; modules maps names to words."""
    versions = f"{PINNED['glslangValidator']}, {PINNED['spirv-opt']}"
    arrays = "\n".join(array_text(name, modules[name]) for name in sorted(modules))
    return (f"{BEGIN}, written by tools/embed_spirv.py\n * {versions} */\n"
            f"/* clang-format off */\n{arrays}\n/* clang-format on */\n{END}")


def embedded(text, block):
    """The header with another block between its markers."""
    begin, end = text.find(BEGIN), text.find(END)
    if begin < 0 or end < begin:
        raise ToolError(f"no markers '{BEGIN}' and '{END}'")
    return text[:begin] + block + text[end + len(END):]


def by_header(sources):
    """The shaders of each header that one of them names."""
    headers = {}
    for source in sources:
        named = HEADER.search(source.read_text(encoding="utf-8"))
        if not named:
            raise ToolError(f"{source.name} has no line '// header: hdrp_gpu_vk_<topic>.h'")
        headers.setdefault(ROOT / named.group(1), []).append(source)
    return headers


def renew(header, sources, folder, check):
    """Writes the words of a header; whether they were what they should be."""
    modules = {source.stem: compiled(source, ROOT, folder) for source in sources}
    text = header.read_text(encoding="utf-8")
    renewed = embedded(text, generated(modules))
    if not check:
        header.write_text(renewed, encoding="utf-8")
    sizes = ", ".join(f"{name} {4 * len(words)} bytes" for name, words in sorted(modules.items()))
    print(f"{header.name}: {sizes}")
    return renewed == text


def main():
    check = "--check" in sys.argv[1:]
    problems = missing_programs()
    if problems:
        print("skipped:" if check else "embed_spirv.py:", "; ".join(problems))
        return SKIPPED if check else 1
    stale = []
    try:
        with tempfile.TemporaryDirectory() as folder:
            for header, sources in sorted(by_header(sorted((ROOT / "shaders").glob("*.comp"))).items()):
                if not renew(header, sources, pathlib.Path(folder), check):
                    stale.append(header.name)
    except (ToolError, OSError) as error:
        print(f"embed_spirv.py: {error}")
        return 1
    if check and stale:
        print(f"{', '.join(stale)} stale: run tools/embed_spirv.py")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
