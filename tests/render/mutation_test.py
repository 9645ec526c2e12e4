"""Small valid files with bytes flipped, inserted, removed, or cut off: whatever comes of it, the
program renders or refuses, and no sanitizer speaks. Usage: EXE SOURCE_ROOT SECONDS"""
import os
import random
import struct
import sys
import time

import render_test

SEED = 20240531
ROUNDS = 600
# Half of the damage goes to the front, where headers and JSON are.
FRONT_BYTES = 2000


def small_hdr():
    """A Radiance picture of 16 x 4 with run-length encoded rows."""
    rows = b""
    for y in range(4):
        rows += bytes([2, 2, 0, 16])
        for channel in range(4):
            rows += bytes([128 + 8, 128 if channel == 3 else 10 * y]) + bytes([8]) + bytes(range(8))
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 16\n" + rows


def sources(assets):
    names = ["gltf/Lights.glb", "gltf/CornellBox.glb", "gltf/AttenuationTest.glb",
             "gltf/TextureTransform/09_texture_transform.gltf",
             "malformed/gltf/tinygltf-zero-sized-bin-chunk-issue-440.glb",
             "malformed/gltf/tinygltf-issue-492.glb", "hdri/conformance/DisplayWindow_t05.exr",
             "hdri/conformance/WideFloatRange.exr"]
    files = {}
    for name in names:
        with open(os.path.join(assets, name), "rb") as f:
            files[name] = f.read()
    files["generated.hdr"] = small_hdr()
    return files


def position(rng, data):
    return rng.randrange(min(len(data), FRONT_BYTES) if rng.random() < 0.5 else len(data))


def mutate_once(rng, data):
    at = position(rng, data)
    kind = rng.randrange(6)
    if kind == 0:
        data[at] ^= 1 << rng.randrange(8)
    elif kind == 1:
        data[at] = rng.choice([0, 1, 0x7f, 0x80, 0xff])
    elif kind == 2:
        data[at:at + 4] = struct.pack("<I", rng.choice([0, 1, 0x7fffffff, 0x80000000, 0xffffffff]))
    elif kind == 3:
        del data[at:at + rng.randrange(1, 9)]
    elif kind == 4:
        data[at:at] = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 9)))
    else:
        # A digit: stays well-formed JSON and reaches what lies behind the parser.
        digits = [i for i in range(max(0, at - 200), min(len(data), at + 200)) if 48 <= data[i] <= 57]
        if digits:
            data[rng.choice(digits)] = 48 + rng.randrange(10)


def repair_glb(data):
    """Makes the lengths of a mutated GLB right again, so that its content is looked at."""
    if len(data) < 20:
        return
    json_length = struct.unpack("<I", data[12:16])[0]
    if 20 + json_length <= len(data):
        data[8:12] = struct.pack("<I", len(data))


def mutate(rng, original):
    data = bytearray(original)
    if rng.random() < 0.1:
        del data[rng.randrange(len(data)):]
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        if data:
            mutate_once(rng, data)
    if data[:4] == b"glTF" and rng.random() < 0.7:
        repair_glb(data)
    return bytes(data)


def outcome_problem(code, lines):
    if code == 0:
        bad = [line for line in lines if not line.startswith("hdrp_render: warning: ")]
        return "unexpected output: " + " | ".join(bad[:3]) if bad else None
    if code == 1 and len(lines) == 1 and lines[0].startswith("hdrp_render: "):
        return None
    return f"exit code {code}: " + " | ".join(lines[:6])


def test_mutant(exe, assets, name, data):
    def check(folder):
        out_folder = os.path.join(folder, "out")
        path = os.path.join(folder, os.path.basename(name))
        os.mkdir(out_folder)
        with open(path, "wb") as f:
            f.write(data)
        if name.endswith(".gltf"):
            link_neighbours(os.path.join(assets, os.path.dirname(name)), folder)
        out, options = render_test.quick_options(out_folder)
        scene = os.path.join(assets, "gltf", "Lights.glb")
        code, lines = render_test.run(exe, render_test.input_arguments(path, scene) + options)
        problem = outcome_problem(code, lines)
        if problem is None and code == 1 and os.listdir(out_folder):
            problem = "something was left in the output folder"
        return problem

    return render_test.in_folder(check)


def link_neighbours(source, folder):
    for name in os.listdir(source):
        if not name.endswith(".gltf"):
            os.symlink(os.path.join(source, name), os.path.join(folder, name))


def keep(data, name, round_index):
    """Leaves the file that showed a problem where it can be looked at."""
    path = os.path.abspath(f"mutant_{round_index}_{os.path.basename(name)}")
    with open(path, "wb") as f:
        f.write(data)
    return path


def main():
    exe, source_root, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    assets = render_test.assets(source_root)
    files = sorted(sources(assets).items())
    tally = render_test.Tally()
    begin = time.monotonic()
    for i in range(ROUNDS):
        rng = random.Random(SEED + i)
        name, original = files[i % len(files)]
        data = mutate(rng, original)
        problem = test_mutant(exe, os.path.abspath(assets), name, data)
        if problem is not None:
            problem += f" (kept as {keep(data, name, i)})"
        tally.check(f"round {i} of {name}", problem)
        if time.monotonic() - begin > seconds:
            print(f"stopped after {i + 1} of {ROUNDS} rounds: {seconds:g} s are over")
            break
    tally.finish()


if __name__ == "__main__":
    main()
