#!/usr/bin/env python3
"""What each mode of transparency takes on a Vulkan device:
    oit_times.py HDRP_RENDER FILE [--size WxH]

Renders the built-in scene of transparent things in every mode with few samples and with more, and
writes FILE: milliseconds of each pass for one sample of all pixels, by timestamps of the device.
The difference is taken, for what happens once, as compiling, is in both.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

MODES = ("sorted", "mcguire", "volition", "recommended", "front", "moments", "wavelet")
PASSES = ("transparent", "half resolution", "composition")
FEW, MORE = 1, 5


def passes_ms(program, mode, size, samples, folder):
    """Milliseconds of the passes over what is transparent, and the name of the device."""
    stats = pathlib.Path(folder, "stats.json")
    subprocess.run([program, "--backend", "vulkan", "--scene", "transparency", "--oit", mode,
                    "--size", size, "--spp", str(samples), "--stats", stats,
                    "--out", pathlib.Path(folder, "picture.exr")],
                   check=True, stdout=subprocess.DEVNULL)
    said = json.loads(stats.read_text())
    return {name: ms for name, ms in said["passes_ms"].items()
            if name.startswith(PASSES)}, said["device"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--size", default="320x180")
    options = parser.parse_args()
    rows, device = [], ""
    with tempfile.TemporaryDirectory() as folder:
        for mode in MODES:
            few, device = passes_ms(options.program, mode, options.size, FEW, folder)
            more, device = passes_ms(options.program, mode, options.size, MORE, folder)
            rows += [[mode, name, f"{max(ms - few.get(name, 0), 0) / (MORE - FEW):.3f}"]
                     for name, ms in more.items()]
    with options.file.open("w", newline="") as out:
        out.write(f"# device: {device}, {options.size}\n")
        csv.writer(out, lineterminator="\n").writerows([["mode", "pass", "ms"], *rows])
    return 0


if __name__ == "__main__":
    sys.exit(main())
