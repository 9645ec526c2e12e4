#!/usr/bin/env python3
"""What the passes of hdrp_gpu_vk.h cost on AMD GPUs, without one:

    gcn_passes.py [PASS...]           a table for each family of GPUs
    gcn_passes.py --check [PASS...]   fails where a pass takes more registers than it may, and where
                                      the recorded numbers are no longer right; bonaire alone
    gcn_passes.py --write             records them in bench/results
    gcn_passes.py --half [PASS...]    what they would take with all arithmetic in 16 bits, on the
                                      families that have it

Registers, local memory (LDS) and occupancy of every embedded shader, and of deferred lighting in
variants from simple to complex. The words come from the headers; gcn_probe.py says which driver
compiles them, and why any other versions of it are skipped (exit status 77).
tools/tradeoffs.py shows what is recorded, with what each feature adds.
"""
import argparse
import csv
import io
import pathlib
import re
import struct
import sys
import tempfile

import embed_spirv
import gcn_probe
import hdrp_api

WORDS = re.compile(r"hdrp_i_gpu_vk_spirv_(?P<name>\w+)\[\] = \{(?P<words>[^}]*)\}")

# Instructions and numbers of SPIR-V.
OP_TYPE_IMAGE, OP_TYPE_SAMPLED_IMAGE, OP_TYPE_POINTER, OP_VARIABLE, OP_DECORATE = 25, 27, 32, 59, 71
BINDING, STORAGE_BUFFER, UNIFORM_CONSTANT, STORAGE_IMAGE = 33, 12, 0, 2
OP_SPEC_CONSTANT, SPEC_ID = 50, 1

# Words of features, HDRP_GPU_VK_WORD_... of hdrp_gpu_vk_light.h.
BLOCKERS, LIT, POINT, SPOT, PYRAMID, BOX = 1, 1 << 25, 1 << 2, 1 << 3, 1 << 4, 1 << 5
PUNCTUAL, ATLAS, NEGATIVE = POINT | SPOT, 1 << 16, 1 << 18
SLICES, SUN, MASK, SKY, SPLIT = 1 << 26, 1 << 27, 1 << 28, 1 << 29, 1 << 30
SUBSURFACE, TRANSMISSION, STRETCH, FILM, COAT = (1 << (20 + bit) for bit in range(5))
SIMPLE = LIT | PUNCTUAL
VARIANTS = {
    "punctual": SIMPLE,
    "point": LIT | POINT,
    "sun": LIT | SUN | MASK,
    "sky": LIT | SKY,
    "punctual+sun": SIMPLE | SUN,
    "punctual+sun+mask": SIMPLE | SUN | MASK,
    "punctual+sky": SIMPLE | SKY,
    "punctual+sun+mask+sky": SIMPLE | SUN | MASK | SKY,
    "punctual+pyramids": SIMPLE | PYRAMID,
    "punctual+boxes": SIMPLE | BOX,
    "punctual+negative": SIMPLE | NEGATIVE,
    "punctual+atlas": SIMPLE | ATLAS,
    "punctual+slices": SIMPLE | SLICES,
    "punctual+split": SIMPLE | SPLIT | SUBSURFACE,
    "punctual+transmission": SIMPLE | TRANSMISSION,
    "punctual+anisotropy": SIMPLE | STRETCH,
    "punctual+iridescence": SIMPLE | FILM,
    "punctual+coat": SIMPLE | COAT,
    "punctual+blockers": SIMPLE | BLOCKERS,
    "everything": 0xfff5003f,
}


# HDRP_I_GPU_VK_OIT_... of hdrp_gpu_vk_oit.h: layered modes, front and the talk's.
KINDS = {"oit_composite": {"through": 1, "front": 2, "talk": 3}}


class Embedded:
    """A shader of a header."""

    def __init__(self, name, words):
        self.name, self.words, self.bindings = name, words, bindings_of(words)


def letter_of(pointer, types):
    """As hdrp_i_gpu_vk_shader.bindings has them."""
    storage, pointed = types[pointer][1:3]
    if storage != UNIFORM_CONSTANT:
        return "b" if storage == STORAGE_BUFFER else "u"
    kind = types[pointed]
    if kind[0] == OP_TYPE_SAMPLED_IMAGE:
        return "c"
    return "s" if kind[6] == STORAGE_IMAGE else "t"


def bindings_of(words):
    """A letter for each binding; what the shader does without is a buffer."""
    types, numbers, letters = {}, {}, {}
    for opcode, at, end in gcn_probe.instructions_of(words):
        if opcode in (OP_TYPE_IMAGE, OP_TYPE_SAMPLED_IMAGE, OP_TYPE_POINTER):
            types[words[at + 1]] = [opcode, *words[at + 2:end]]
        elif opcode == OP_DECORATE and words[at + 2] == BINDING:
            numbers[words[at + 1]] = words[at + 3]
        elif opcode == OP_VARIABLE and words[at + 2] in numbers:
            letters[numbers[words[at + 2]]] = letter_of(words[at + 1], types)
    return "".join(letters.get(k, "b") for k in range(max(letters) + 1))


def embedded_shaders(root):
    for path in sorted(root.glob("hdrp_gpu_vk*.h")):
        for match in WORDS.finditer(path.read_text(encoding="utf-8")):
            words = [int(word, 16) for word in match["words"].split(",") if word.strip()]
            yield Embedded(match["name"], words)


def in_halves(shader, folder):
    """The shader with 16-bit arithmetic, or None where spirv-opt makes no valid module of it."""
    plain, half = folder / "float.spv", folder / "half.spv"
    embed_spirv.write_words(plain, shader.words)
    try:
        embed_spirv.run("spirv-opt", "--relax-float-ops", "--convert-relaxed-to-half", "-O",
                        f"--target-env={embed_spirv.TARGET}", plain, "-o", half)
        embed_spirv.run("spirv-val", "--target-env", embed_spirv.TARGET, half)
    except embed_spirv.ToolError:
        return None
    return Embedded(shader.name, embed_spirv.read_words(half))


def specialised(words, number, value):
    """The words with another default of a specialization constant."""
    result = list(words)
    constant = next(words[at + 1] for opcode, at, _ in gcn_probe.instructions_of(words)
                    if opcode == OP_DECORATE and words[at + 2:at + 4] == [SPEC_ID, number])
    for opcode, at, _ in gcn_probe.instructions_of(words):
        if opcode == OP_SPEC_CONSTANT and words[at + 2] == constant:
            result[at + 3] = value
    return result


def modules_of(shader):
    """(name, words) of a shader, and of the kinds that constant 2 makes of it."""
    yield shader.name, shader.words
    for kind, value in KINDS.get(shader.name, {}).items():
        yield f"{shader.name}/{kind}", specialised(shader.words, 2, value)


class Compiled:
    """What gcn_probe.Bench.ask asks about."""

    def __init__(self, name, path, mask, bindings):
        self.path = path
        self.shader = gcn_probe.gcn_shaders.Shader(name, mask=f"{mask} {bindings}")


def compiled_shaders(root, folder, wanted, half=False):
    for shader in embedded_shaders(root):
        if wanted and shader.name not in wanted:
            continue
        shader = in_halves(shader, folder) if half else shader
        if not shader:
            continue
        for module, words in modules_of(shader):
            path = folder / f"{module.replace('/', '_')}.spv"
            path.write_bytes(struct.pack(f"<{len(words)}I", *words))
            if shader.name != "deferred":
                yield Compiled(module, path, "-", shader.bindings)
                continue
            for name, word in VARIANTS.items():
                yield Compiled(f"{shader.name}:{name}", path, word, shader.bindings)


SHOWN = {"instructions": "instructions", "vgprs": "VGPRs", "sgprs": "SGPRs",
         "lds_bytes": "LDS, bytes", "waves_per_simd": "waves", "spilled_registers": "spilled"}
COLUMNS = ["name", "family", *SHOWN]
NOTES = """\
deferred: one module; punctual is the Standard material with points and spots, and what follows a
+ is a feature more. sun: directional lights, mask: their shadow image, sky: the environment"""
HAVE_HALVES = ["vega10", "gfx1100"]
CHECKED = "bonaire"  # the family for which --check has time
# Vector registers on it, at most. The aim for lists is 48 throughout. That of blockers is out of
# reach: a blocker and its light are 25 numbers, an edge of a tile 21, what its edges say together 11,
# and all of them are used at once; above 84 registers a few more cost nothing up to 128.
LIMITS = {"classify": 48, "dispatch": 48, "cull_project": 48, "cull_coarse": 48, "cull_tiles": 48,
          "cull_pixels": 48, "cull_clusters": 48, "cull_blockers": 116, "depth": 48,
          "oit_composite": 48, "deferred:punctual": 48, "deferred:punctual+sun+mask+sky": 64}


def measured_rows(bench, wanted, half=False):
    """A row for each shader and family."""
    compiled = list(compiled_shaders(bench.root, bench.folder, wanted, half))
    measured = bench.ask_all(compiled)
    return [dict({column: measured[family][c.shader.name].numbers()[column] for column in SHOWN},
                 name=c.shader.name, family=family)
            for c in compiled for family in bench.families]


def print_rows(rows):
    for family in sorted({row["family"] for row in rows}, key=gcn_probe.FAMILIES.index):
        print(f"\n{family:<34}" + "".join(f"{head:>14}" for head in SHOWN.values()))
        for row in rows:
            if row["family"] == family:
                print(f"{row['name']:<34}" + "".join(f"{row[column]:>14}" for column in SHOWN))


def document(versions, rows):
    text = io.StringIO()
    text.write("".join(f"# {line}\n" for line in [versions, *NOTES.splitlines()]))
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def recorded_path(versions, results):
    name = gcn_probe.recorded_path(versions, results).name
    return pathlib.Path(results) / name.replace("gcn_", "gcn_passes_")


def too_many(rows):
    """Passes that take more registers than they may."""
    return [f"{row['name']}: {row['vgprs']} vector registers on {CHECKED}, at most "
            f"{LIMITS[row['name']]}" for row in rows
            if row["family"] == CHECKED and row["vgprs"] > LIMITS.get(row["name"], row["vgprs"])]


def lines_of(text, wanted):
    """{pass: line} of the family that is checked, and of these passes."""
    found = (line.split(",") for line in text.splitlines() if not line.startswith("#"))
    return {cells[0]: ",".join(cells) for cells in found
            if cells[1] == CHECKED and (not wanted or re.split("[:/]", cells[0])[0] in wanted)}


def check(bench, results, wanted):
    versions = bench.versions()
    path = recorded_path(versions, results)
    if not path.exists():
        raise gcn_probe.Skip(f"no numbers are recorded for {versions}")
    recorded = path.read_text(encoding="utf-8")
    if not recorded.startswith(f"# {versions}\n"):
        raise gcn_probe.Skip(f"{path.name} is for other versions; this is {versions}")
    rows = measured_rows(bench, wanted)
    problems = too_many(rows)
    old, new = (lines_of(text, wanted) for text in (recorded, document(versions, rows)))
    for name in sorted({*old, *new}):
        if old.get(name) != new.get(name):
            problems += [f"recorded: {old.get(name, 'nothing')}\nmeasured: {new.get(name, 'nothing')}"]
    if problems:
        print("\n".join(problems))
        print(f"{path.name}: if that is meant, tools/gcn_passes.py --write")
        return 1
    print(f"{path.name}: {len(new)} passes are as measured on {CHECKED}, {versions}")
    return 0


def write(bench, results):
    path = recorded_path(bench.versions(), results)
    path.write_text(document(bench.versions(), measured_rows(bench, [])), encoding="utf-8")
    print(f"wrote {path}")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("passes", nargs="*", metavar="PASS")
    action = parser.add_mutually_exclusive_group()
    action.add_argument("--check", action="store_true")
    action.add_argument("--write", action="store_true")
    action.add_argument("--half", action="store_true")
    parser.add_argument("--include", type=pathlib.Path, default=hdrp_api.ROOT,
                        help="folder of the headers")
    parser.add_argument("--results", type=pathlib.Path, default=gcn_probe.RESULTS,
                        help="folder of the recorded numbers")
    options = parser.parse_args()
    try:
        with tempfile.TemporaryDirectory() as folder:
            families = [CHECKED] if options.check else HAVE_HALVES if options.half else None
            bench = gcn_probe.Bench(folder, options.include, families)
            if options.check:
                return check(bench, options.results, options.passes)
            if options.write:
                return write(bench, options.results)
            print_rows(measured_rows(bench, options.passes, options.half))
    except gcn_probe.Skip as missing:
        print(f"skipped: {missing}")
        return gcn_probe.SKIPPED
    return 0


if __name__ == "__main__":
    sys.exit(main())
