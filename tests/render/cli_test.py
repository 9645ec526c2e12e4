"""The command line: every wrong use is one line that names its cause; right ones leave the files
that they promise. Needs no assets. Usage: EXE"""
import json
import os
import subprocess
import sys

import render_test

# Arguments, and what the message has to name.
WRONG = [
    (["--size", "0x10"], "--size"),
    (["--size", "10"], "--size"),
    (["--size", "10x10x10"], "--size"),
    (["--size", "16384x16384"], "--size"),
    (["--size"], "--size"),
    (["--size="], "--size"),
    (["--spp", "0"], "--spp"),
    (["--spp", "many"], "--spp"),
    (["--spp", "1e3"], "--spp"),
    (["--lights", "-1"], "--lights"),
    (["--backend", "metal"], "--backend"),
    (["--quality", "best"], "--quality"),
    (["--path", "tiled"], "--path"),
    (["--oit", "alphabetical"], "--oit"),
    (["--oit", "wavelet", "--quality", "reference"], "--oit"),
    (["--view", "everything"], "--view"),
    (["--scene", "moon"], "--scene"),
    (["--scene", "lights", "a.glb"], "--scene"),
    (["--features", "clear_coat,moonlight"], "--features"),
    (["--features", "-"], "--features"),
    (["--exposure", "nan"], "--exposure"),
    (["--exposure", "1e9"], "--exposure"),
    (["--eye", "1,2"], "--eye"),
    (["--eye", "1,2,inf"], "--eye"),
    (["--eye", "1,2,3", "--target", "1,2,3"], "--eye"),
    (["--fov", "180"], "--fov"),
    (["--camera", "99"], "--camera"),
    (["--camera", "0", "--eye", "1,2,3"], "--eye"),
    (["--env-lux", "0"], "--env-lux"),
    (["--frames", "0"], "--frames"),
    (["--out", "picture.jpg"], "--out"),
    (["--out", "no/such/folder/picture.png"], "no/such/folder"),
    (["--frames", "2", "--out", "no/such/folder/picture.png"], "no/such/folder"),
    (["--stats", "no/such/folder/stats.json"], "no/such/folder"),
    (["--env", "no_such_sky.exr"], "no_such_sky.exr"),
    (["--compare", "no_such_picture.exr"], "no_such_picture.exr"),
    (["no_such_scene.glb"], "no_such_scene.glb"),
    (["a.glb", "b.glb"], "b.glb"),
    (["--colour"], "--colour"),
    (["-x"], "-x"),
]
SMALL = ["--size", "32x18", "--spp", "1", "--view", "base_color"]


def run_in(exe, folder, arguments):
    done = subprocess.run([exe] + arguments, cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=60)
    return done.returncode, done.stdout.decode(), done.stderr.decode().splitlines()


def wrong_use(exe, arguments, name):
    def check(folder):
        code, _, lines = run_in(exe, folder, arguments)
        if code != 1 or len(lines) != 1 or name not in lines[0]:
            return f"exit code {code}: " + " | ".join(lines)
        return "left " + ", ".join(os.listdir(folder)) if os.listdir(folder) else None

    return render_test.in_folder(check)


def says_on_stdout(exe, argument, text):
    def check(folder):
        code, out, lines = run_in(exe, folder, [argument])
        return None if code == 0 and text in out and not lines else f"exit code {code}: {out[:80]}"

    return render_test.in_folder(check)


def magic(path, expected):
    with open(path, "rb") as f:
        return f.read(len(expected)) == expected


def writes_what_it_promises(exe):
    def check(folder):
        code, out, lines = run_in(exe, folder, SMALL + ["--out", "a.exr", "--stats", "s.json"])
        if code != 0 or lines or "total" not in out:
            return f"exit code {code}: " + " | ".join(lines)
        if sorted(os.listdir(folder)) != ["a.exr", "s.json"]:
            return "files: " + ", ".join(os.listdir(folder))
        with open(os.path.join(folder, "s.json"), encoding="utf-8") as f:
            stats = json.load(f)
        if stats["width"] != 32 or stats["counts"]["triangles"] < 1000:
            return f"statistics {stats}"
        return None if magic(os.path.join(folder, "a.exr"), b"\x76\x2f\x31\x01") else "no EXR file"

    return render_test.in_folder(check)


def finds_no_difference_to_itself(exe):
    def check(folder):
        run_in(exe, folder, SMALL + ["--out", "a.exr"])
        code, _, lines = run_in(exe, folder, SMALL + ["--out", "b.png", "--compare", "a.exr",
                                                      "--stats", "s.json"])
        if code != 0:
            return " | ".join(lines)
        with open(os.path.join(folder, "s.json"), encoding="utf-8") as f:
            errors = json.load(f)["errors"]
        if errors["psnr_db"] is not None or errors["relative_max"] != 0:
            return f"errors {errors}"
        code, _, lines = run_in(exe, folder, ["--size", "16x18", "--compare", "a.exr"])
        return None if code == 1 and "a.exr" in lines[0] else "took a picture of another size"

    return render_test.in_folder(check)


def numbers_its_frames(exe):
    def check(folder):
        code, said, lines = run_in(exe, folder, SMALL + ["--frames", "3", "--out", "f.png"])
        names = sorted(os.listdir(folder))
        if code != 0 or names != ["f_0000.png", "f_0001.png", "f_0002.png"]:
            return f"exit code {code}, files: {names} " + " | ".join(lines)
        if said.splitlines()[-3:] != names:
            return "does not name its pictures: " + said
        contents = {open(os.path.join(folder, n), "rb").read() for n in names}
        return None if len(contents) == 3 else "the camera did not move"

    return render_test.in_folder(check)


def keeps_an_old_picture_when_it_fails(exe):
    def check(folder):
        path = os.path.join(folder, "a.png")
        with open(path, "w", encoding="utf-8") as f:
            f.write("old")
        code, _, _ = run_in(exe, folder, ["no_such_scene.glb", "--out", "a.png"])
        with open(path, encoding="utf-8") as f:
            return None if code == 1 and f.read() == "old" else "the old picture is gone"

    return render_test.in_folder(check)


def is_the_same_on_any_number_of_threads(exe):
    def check(folder):
        for threads in ("1", "3"):
            subprocess.run([exe] + SMALL + ["--out", threads + ".exr"], cwd=folder, check=True,
                           env=dict(os.environ, OMP_NUM_THREADS=threads),
                           stdout=subprocess.DEVNULL, timeout=60)
        one, three = (open(os.path.join(folder, t + ".exr"), "rb").read() for t in ("1", "3"))
        return None if one == three else "the pictures differ"

    return render_test.in_folder(check)


# Options, and what is wrong with the numbers that --stats writes.
def by_vulkan(exe, options, fault):
    def check(folder):
        with open(os.path.join(folder, "empty.gltf"), "w") as f:
            json.dump({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{}]}, f)
        code, _, errors = run_in(exe, folder, options + [
            "--backend", "vulkan", "--size", "3x2", "--spp", "1", "--quality", "fast",
            "--out", "a.exr", "--stats", "a.json"])
        if code != 0:
            missing = any("there is no" in line for line in errors)  # driver or device
            return None if missing else f"exit status {code}: {errors}"
        with open(os.path.join(folder, "a.json")) as f:
            return fault(json.load(f))

    return render_test.in_folder(check)


def draws_an_empty_scene_by_vulkan(exe):
    def fault(stats):
        total, passes = stats["total_ms"], sum(stats["passes_ms"].values())
        return None if passes <= total else f"passes take {passes} ms of {total}"

    return by_vulkan(exe, ["empty.gltf"], fault)


def lights_by_vulkan_what_no_list_holds(exe):
    def fault(stats):
        left_out = stats["limits_hit"]["lights_without_lists"]
        return None if left_out >= 65536 else f"{left_out} lights are without lists"

    return by_vulkan(exe, ["--lights", "65536", "--features", "-shadows,-ao"], fault)


def main():
    exe = os.path.abspath(sys.argv[1])
    tally = render_test.Tally()
    for arguments, name in WRONG:
        tally.check(" ".join(arguments), wrong_use(exe, arguments, name))
    tally.check("--help", says_on_stdout(exe, "--help", "--features"))
    tally.check("--version", says_on_stdout(exe, "--version", "hdrp_render "))
    for check in (writes_what_it_promises, finds_no_difference_to_itself, numbers_its_frames,
                  keeps_an_old_picture_when_it_fails, is_the_same_on_any_number_of_threads,
                  draws_an_empty_scene_by_vulkan, lights_by_vulkan_what_no_list_holds):
        tally.check(check.__name__, check(exe))
    tally.finish()


if __name__ == "__main__":
    main()
