"""Every sky lights a scene: what is no radiance is counted and told in one line, and the picture is
finite. Usage: EXE SOURCE_ROOT"""
import glob
import json
import os
import sys

import render_test


def numbers(folder):
    with open(os.path.join(folder, "s.json"), encoding="utf-8") as f:
        return json.load(f)


def test_sky(exe, assets, sky):
    def check(folder):
        picture, stats = os.path.join(folder, "a.exr"), os.path.join(folder, "s.json")
        scene = os.path.join(assets, "gltf", "CornellBox.glb")
        options = [scene, "--env", sky, "--size", "32x18", "--quality", "fast", "--stats", stats]
        code, lines = render_test.run(exe, options + ["--out", picture])
        if code != 0:
            return " | ".join(lines)
        counts = numbers(folder)["counts"]
        spoilt = sum(counts["sky_texels_" + k] for k in ("nan", "infinite", "negative", "too_large"))
        if len(lines) != (1 if spoilt else 0) or (spoilt and "replaced texels" not in lines[0]):
            return f"{spoilt} bad texels, but says: " + " | ".join(lines)
        if os.path.basename(sky) == "BrightRingsNanInf.exr" and not (
                counts["sky_texels_nan"] > 0 and counts["sky_texels_infinite"] > 0):
            return f"found no NaN or infinity: {counts}"
        # A picture with NaN in it differs from itself.
        code, lines = render_test.run(exe, options + ["--out", os.path.join(folder, "b.exr"),
                                                      "--compare", picture])
        difference = numbers(folder)["errors"]["relative_max"] if code == 0 else lines
        return None if difference == 0 else f"differs from itself by {difference}"

    return render_test.in_folder(check)


def main():
    exe, source_root = os.path.abspath(sys.argv[1]), sys.argv[2]
    assets = os.path.abspath(render_test.assets(source_root))
    tally = render_test.Tally()
    skies = glob.glob(os.path.join(assets, "hdri", "**", "*.*"), recursive=True)
    for sky in sorted(skies):
        tally.check(os.path.relpath(sky, assets), test_sky(exe, assets, sky))
    tally.finish()


if __name__ == "__main__":
    main()
