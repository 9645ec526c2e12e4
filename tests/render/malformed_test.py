"""Every malformed file is refused with one line, valid ones load. Usage: EXE SOURCE_ROOT MEMORY_MIB
(0: no limit, for builds with sanitizers, which reserve far more addresses than they use)."""
import glob
import os
import sys

import render_test

VALID = {"tinygltf-issue-492.glb", "tinygltf-zero-sized-bin-chunk-issue-440.glb"}


def test_file(exe, path, scene, must_load, address_space):
    def check(folder):
        out, options = render_test.quick_options(folder)
        arguments = render_test.input_arguments(path, scene) + options
        code, lines = render_test.run(exe, arguments, address_space=address_space)
        if must_load:
            return render_test.acceptance_problem(code, lines, out)
        return render_test.refusal_problem(code, lines, out, os.path.basename(path))

    return render_test.in_folder(check)


def valid_files(assets):
    """All skies, and the scenes that are small enough for a build with sanitizers."""
    small = ["Lights.glb", "CornellBox.glb", "glass-table.glb", "AttenuationTest.glb",
             "TextureTransform/09_texture_transform.gltf", "FlightHelmet/FlightHelmet.gltf",
             "MixedLightingExample/MixedLightingExample.gltf", "ClearCoatTest.glb"]
    scenes = [os.path.join(assets, "gltf", s) for s in small]
    skies = [p for p in glob.glob(os.path.join(assets, "hdri", "**", "*.*"), recursive=True)]
    return scenes + sorted(skies)


def malformed_files(assets):
    pattern = os.path.join(assets, "malformed", "*", "*.*")
    return sorted(p for p in glob.glob(pattern) if not p.endswith(".bin"))


def main():
    exe, source_root, memory_mib = sys.argv[1], sys.argv[2], int(sys.argv[3])
    assets = render_test.assets(source_root)
    scene = os.path.join(assets, "gltf", "Lights.glb")
    limit = memory_mib << 20 or None
    tally = render_test.Tally()
    for path in malformed_files(assets):
        must_load = os.path.basename(path) in VALID
        problem = test_file(exe, path, scene, must_load, limit)
        tally.check(os.path.relpath(path, assets), problem)
    for path in valid_files(assets):
        # Whole programs need room for threads and acceleration structures.
        tally.check(os.path.relpath(path, assets), test_file(exe, path, scene, True, None))
    tally.finish()


if __name__ == "__main__":
    main()
