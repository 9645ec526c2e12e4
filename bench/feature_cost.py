#!/usr/bin/env python3
"""What each feature of a material costs in a picture: feature_cost.py HDRP_RENDER ASSETS FOLDER
    [--repeat N] [--spp N] [--size WxH]

Renders a scene that needs a feature, and one that does not, with the feature on and off at each
quality, and writes FOLDER/features_render_<processor>.csv: milliseconds of the passes that evaluate
materials, on one thread, the least of all repetitions, and the mean relative error of the picture
against a path-traced one with everything on. On and off take turns.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import run

# A scene that has the feature; "" is the built-in one.
SCENES = {
    "clear_coat": "ClearCoatTest.glb",
    "anisotropy": "AnisotropyStrengthTest.glb",
    "iridescence": "",
    "transmission": "",
    "refraction": "AttenuationTest.glb",
}
WITHOUT_ANY = "FlightHelmet/FlightHelmet.gltf"
QUALITIES = ("fast", "balanced")
PASSES = ("GBuffer", "deferred lighting", "forward opaque and sky", "pyramid",
          "transparent surfaces")


class Renderer:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.references = {}

    def render(self, scene, *arguments):
        """Statistics of a picture."""
        stats = self.folder / "stats.json"
        command = [self.options.renderer, "--size", self.options.size, "--seed", "1", "--stats",
                   str(stats), *arguments]
        if scene:
            command.insert(1, str(self.options.assets / "gltf" / scene))
        done = subprocess.run(command, capture_output=True, text=True,
                              env=dict(os.environ, OMP_NUM_THREADS="1"))
        if done.returncode:
            sys.exit(done.stderr)
        return json.loads(stats.read_text())

    def reference(self, scene):
        if scene not in self.references:
            path = self.folder / f"reference_{len(self.references)}.exr"
            self.render(scene, "--quality", "reference", "--spp", "64", "--out", str(path))
            self.references[scene] = str(path)
        return self.references[scene]

    def measure(self, scene, quality, feature, on):
        features = [] if on else [f"--features=-{feature}"]
        stats = self.render(scene, "--quality", quality, "--spp", str(self.options.spp), "--out",
                            str(self.folder / "picture.exr"), "--compare", self.reference(scene),
                            *features)
        passes = stats["passes_ms"]
        return sum(passes.get(name, 0.0) for name in PASSES), stats["errors"]["relative_mean"]


def rows(renderer, repeat):
    for feature, needs_it in SCENES.items():
        for scene in (needs_it, WITHOUT_ANY):
            for quality in QUALITIES:
                taken = {1: [], 0: []}
                for _ in range(repeat):
                    for on in taken:
                        taken[on].append(renderer.measure(scene, quality, feature, on))
                name = pathlib.Path(scene).stem or "built-in"
                for on, results in taken.items():
                    milliseconds = min(ms for ms, _ in results)
                    yield (f"{name},{quality},{feature},{on},{milliseconds:.3g},"
                           f"{results[0][1]:.3g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("renderer")
    parser.add_argument("assets", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--size", default="240x160")
    options = parser.parse_args()
    if not (options.assets / "gltf" / WITHOUT_ANY).is_file():
        sys.exit(f"feature_cost: no scenes in {options.assets}")
    with tempfile.TemporaryDirectory() as folder:
        lines = list(rows(Renderer(options, pathlib.Path(folder)), options.repeat))
    path = options.folder / f"features_render_{run.machine()}.csv"
    said = run.remark(f"pictures of {options.size}, {options.spp} samples a pixel, one thread, "
                      f"the least of {options.repeat}")
    path.write_text(said + "\n".join(["scene,quality,feature,on,milliseconds,error", *lines]) + "\n")
    print(f"wrote {path}")


if __name__ == "__main__":
    main()
