#!/usr/bin/env python3
"""What the passes of hdrp_gpu_vk.h cost on AMD GPUs, without one:

    gcn_passes.py [PASS...]   a table for each family of GPUs
    gcn_passes.py --check     fails where a pass takes more registers than it may
    gcn_passes.py --write     records the table in docs/gcn_passes.md

Registers, local memory (LDS) and occupancy of every embedded shader, and of deferred lighting in
variants from simple to complex, with what each feature adds. The words come from the headers; see
gcn_probe.py for the driver that compiles them. Exit status 77 where something is missing.
"""
import pathlib
import re
import struct
import sys
import tempfile

import gcn_probe
import hdrp_api

WORDS = re.compile(r"hdrp_i_gpu_vk_spirv_(?P<name>\w+)\[\] = \{(?P<words>[^}]*)\}")

# Instructions and numbers of SPIR-V.
OP_TYPE_IMAGE, OP_TYPE_SAMPLED_IMAGE, OP_TYPE_POINTER, OP_VARIABLE, OP_DECORATE = 25, 27, 32, 59, 71
BINDING, STORAGE_BUFFER, UNIFORM_CONSTANT, STORAGE_IMAGE = 33, 12, 0, 2

# Words of features, HDRP_GPU_VK_WORD_... of hdrp_gpu_vk_light.h.
LIT, POINT, SPOT, PYRAMID, BOX = 1 << 25, 1 << 2, 1 << 3, 1 << 4, 1 << 5
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
    "everything": 0xfff5003e,
}


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


def embedded_shaders():
    for path in sorted(hdrp_api.ROOT.glob("hdrp_gpu_vk*.h")):
        for match in WORDS.finditer(path.read_text(encoding="utf-8")):
            words = [int(word, 16) for word in match["words"].split(",") if word.strip()]
            yield Embedded(match["name"], words)


class Compiled:
    """What gcn_probe.Bench.ask asks about."""

    def __init__(self, name, path, mask, bindings):
        self.path = path
        self.shader = gcn_probe.gcn_shaders.Shader(name, mask=f"{mask} {bindings}")


def compiled_shaders(folder, wanted):
    for shader in embedded_shaders():
        if wanted and shader.name not in wanted:
            continue
        path = folder / f"{shader.name}.spv"
        path.write_bytes(struct.pack(f"<{len(shader.words)}I", *shader.words))
        if shader.name != "deferred":
            yield Compiled(shader.name, path, "-", shader.bindings)
            continue
        for name, word in VARIANTS.items():
            yield Compiled(f"{shader.name}:{name}", path, word, shader.bindings)


SHOWN = {"instructions": "instructions", "vgprs": "VGPRs", "sgprs": "SGPRs",
         "lds_bytes": "LDS, bytes", "waves_per_simd": "waves", "spilled_registers": "spilled"}
# Vector registers on bonaire, at most. The aim for lists is 48 throughout.
LIMITS = {"classify": 48, "dispatch": 48, "cull_project": 84, "cull_coarse": 48, "cull_tiles": 48,
          "cull_pixels": 48, "cull_clusters": 68, "depth": 48, "deferred:punctual": 48,
          "deferred:punctual+sun+mask+sky": 64}
DOCUMENT = hdrp_api.ROOT / "docs" / "gcn_passes.md"
INTRODUCTION = """# Registers of the GPU passes

Written by `tools/gcn_passes.py --write`; {versions}. Deferred lighting is one module; each of its
rows is a variant: `punctual` is the Standard material with points and spots, and what follows a +
is a feature more. `sun` is directional lights, `mask` their shadow image, `sky` the environment.
"""


def measured_rows(bench, folder, wanted):
    """family -> [(name, numbers)]"""
    compiled = list(compiled_shaders(folder, wanted))
    return {family: [(c.shader.name, measured[c.shader.name].numbers()) for c in compiled]
            for family, measured in bench.ask_all(compiled).items()}


def print_rows(rows):
    for family, shaders in rows.items():
        print(f"\n{family:<34}" + "".join(f"{head:>14}" for head in SHOWN.values()))
        for name, numbers in shaders:
            print(f"{name:<34}" + "".join(f"{numbers[column]:>14}" for column in SHOWN))


def document(versions, rows):
    lines = [INTRODUCTION.format(versions=versions)]
    for family, shaders in rows.items():
        plain = dict(shaders).get("deferred:punctual")
        lines += [f"## {family}", "", f"| pass | {' | '.join(SHOWN.values())} | VGPRs added |",
                  "|---|" + "---|" * (len(SHOWN) + 1)]
        for name, numbers in shaders:
            added = ""
            if name.startswith("deferred:punctual+") and plain:
                added = f"{numbers['vgprs'] - plain['vgprs']:+d}"
            values = " | ".join(str(numbers[column]) for column in SHOWN)
            lines.append(f"| {name} | {values} | {added} |")
        lines.append("")
    return "\n".join(lines)


def too_many(rows):
    """Passes that take more registers than they may."""
    return [f"{name}: {numbers['vgprs']} vector registers on bonaire, at most {LIMITS[name]}"
            for name, numbers in rows["bonaire"]
            if name in LIMITS and numbers["vgprs"] > LIMITS[name]]


def main():
    wanted = [word for word in sys.argv[1:] if not word.startswith("--")]
    try:
        with tempfile.TemporaryDirectory() as folder:
            bench = gcn_probe.Bench(folder)
            rows = measured_rows(bench, pathlib.Path(folder), wanted)
            versions = bench.versions()
    except gcn_probe.Skip as missing:
        print(f"skipped: {missing}")
        return gcn_probe.SKIPPED
    if "--write" in sys.argv:
        DOCUMENT.write_text(document(versions, rows), encoding="utf-8")
    if "--check" in sys.argv:
        problems = too_many(rows)
        print("\n".join(problems) if problems else "all passes keep within their registers")
        return 1 if problems else 0
    print_rows(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
