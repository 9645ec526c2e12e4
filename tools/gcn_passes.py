#!/usr/bin/env python3
"""What the passes of hdrp_gpu_vk.h cost on AMD GPUs, without one: gcn_passes.py [PASS...]

A table for each family of GPUs: registers, local memory (LDS) and occupancy of every embedded
shader, and of deferred lighting in variants from simple to complex, with what each feature adds.
The words come from the headers; see gcn_probe.py for the driver that compiles them. Exit status 77
where something is missing.
"""
import pathlib
import re
import struct
import sys
import tempfile

import gcn_probe
import hdrp_api

SHADER = re.compile(r"hdrp_i_gpu_vk_shader_make\((?P<arguments>[^;]*?)\);\s*"
                    r"s\.words = hdrp_i_gpu_vk_spirv_(?P<name>\w+);")
WORDS = re.compile(r"hdrp_i_gpu_vk_spirv_(?P<name>\w+)\[\] = \{(?P<words>[^}]*)\}")
STRING = re.compile(r'"([^"]*)"')

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

    def __init__(self, name, bindings, words):
        self.name, self.bindings, self.words = name, bindings, words


def embedded_shaders():
    shaders = []
    for path in sorted(hdrp_api.ROOT.glob("hdrp_gpu_vk*.h")):
        text = path.read_text(encoding="utf-8")
        arrays = {m["name"]: [int(word, 16) for word in m["words"].split(",") if word.strip()]
                  for m in WORDS.finditer(text)}
        for match in SHADER.finditer(text):
            _, bindings = STRING.findall(match["arguments"])[:2]
            shaders.append(Embedded(match["name"], bindings, arrays[match["name"]]))
    return shaders


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


def main():
    shown = ["instructions", "vgprs", "sgprs", "lds_bytes", "waves_per_simd", "spilled_registers"]
    try:
        with tempfile.TemporaryDirectory() as folder:
            bench = gcn_probe.Bench(folder)
            compiled = list(compiled_shaders(pathlib.Path(folder), sys.argv[1:]))
            for family, measured in bench.ask_all(compiled).items():
                print(f"\n{family:<34}" + "".join(f"{column.split('_')[0]:>13}" for column in shown))
                for c in compiled:
                    numbers = measured[c.shader.name].numbers()
                    print(f"{c.shader.name:<34}" +
                          "".join(f"{numbers[column]:>13}" for column in shown))
    except gcn_probe.Skip as missing:
        print(f"skipped: {missing}")
        return gcn_probe.SKIPPED
    return 0


if __name__ == "__main__":
    sys.exit(main())
