"""Prints how far real time is from the path tracer, scene by scene. No test: it takes minutes.
Usage: EXE SOURCE_ROOT [SPP_OF_REFERENCE]"""
import json
import os
import subprocess
import sys
import tempfile

import render_test

SIZE = "240x160"
INSIDE_SPONZA = ["--eye", "-12,2,0", "--target", "0,3,0", "--fov", "60"]
SCENES = [
    (None, []),
    ("FlightHelmet/FlightHelmet.gltf", []),
    ("AnisotropyBarnLamp.glb", []),
    ("ClearCoatTest.glb", []),
    ("SunglassesKhronos.glb", []),
    ("SpecularTest.glb", []),
    ("AnisotropyStrengthTest.glb", []),
    ("NormalTangentTest.glb", []),
    ("AttenuationTest.glb", []),
    ("Lights.glb", []),
    ("sponza.glb", INSIDE_SPONZA),
]


def render(exe, folder, arguments):
    done = subprocess.run([exe] + arguments, cwd=folder, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stderr)


def differences(exe, folder, scene, spp):
    render(exe, folder, scene + ["--quality", "reference", "--spp", spp, "--out", "truth.exr"])
    rows = {}
    for quality in ("fast", "balanced"):
        render(exe, folder, scene + ["--quality", quality, "--spp", "16", "--out", "a.png",
                                     "--compare", "truth.exr", "--stats", "s.json"])
        with open(os.path.join(folder, "s.json"), encoding="utf-8") as f:
            rows[quality] = json.load(f)["errors"]
    return rows


def main():
    exe, source_root = os.path.abspath(sys.argv[1]), sys.argv[2]
    spp = sys.argv[3] if len(sys.argv) > 3 else "256"
    assets = os.path.abspath(render_test.assets(source_root))
    print(f"{SIZE}, reference with {spp} samples a pixel; mean ratio above 1: too bright")
    print(f"{'scene':24} {'quality':10} {'PSNR dB':>8} {'relMSE':>9} {'mean ratio':>11}")
    for name, view in SCENES:
        scene = ([os.path.join(assets, "gltf", name)] if name else []) + view + ["--size", SIZE]
        with tempfile.TemporaryDirectory() as folder:
            for quality, e in differences(exe, folder, scene, spp).items():
                title = os.path.basename(name).split(".")[0] if name else "built-in"
                print(f"{title:24} {quality:10} {e['psnr_db']:8.2f} {e['relative_mse']:9.5f} "
                      f"{e['mean_ratio']:11.4f}", flush=True)


if __name__ == "__main__":
    main()
