"""Shared by the tests of hdrp_render: runs the program and judges what it did."""
import os
import resource
import subprocess
import sys
import tempfile

SKIPPED = 77  # the exit code that CTest reads as "skipped"
PROGRAM = "hdrp_render"
SANITIZER_OPTIONS = {
    "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=0:max_allocation_size_mb=2048",
    "UBSAN_OPTIONS": "print_stacktrace=1",
    "OMP_NUM_THREADS": "2",
}


def assets(source_root):
    """The folder of test assets; ends the test as skipped where there is none."""
    folder = os.environ.get("HDRP_TEST_ASSETS") or os.path.join(source_root, "..", "shared", "assets")
    if not os.path.isdir(os.path.join(folder, "gltf")):
        print(f"skipped: no test assets in {os.path.normpath(folder)} (set HDRP_TEST_ASSETS)")
        sys.exit(SKIPPED)
    return folder


def run(exe, arguments, timeout=60, address_space=None):
    """Runs the program; returns its exit code and the lines it wrote to stderr."""
    def limit():
        if address_space:
            resource.setrlimit(resource.RLIMIT_AS, (address_space, address_space))

    done = subprocess.run([exe] + arguments, env=dict(os.environ, **SANITIZER_OPTIONS),
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=timeout,
                          preexec_fn=limit)
    return done.returncode, done.stderr.decode("utf-8", "replace").splitlines()


def input_arguments(path, sky_scene):
    """A scene is rendered; a sky needs a scene to be seen in."""
    if path.endswith((".exr", ".hdr")):
        return [sky_scene, "--env", path]
    return [path]


class Tally:
    def __init__(self):
        self.passed = 0
        self.failures = []

    def check(self, name, problem):
        """Counts one case; `problem` is None where it went well."""
        if problem is None:
            self.passed += 1
        else:
            self.failures.append(f"{name}: {problem}")
            print(f"FAILED {name}: {problem}")

    def finish(self):
        print(f"{self.passed} passed, {len(self.failures)} failed")
        sys.exit(1 if self.failures else 0)


def quick_options(folder):
    out = os.path.join(folder, "out.png")
    return out, ["--size", "16x9", "--spp", "1", "--view", "base_color", "--out", out]


def refusal_problem(code, lines, out, name):
    """What is wrong with how a bad file was refused; None if nothing."""
    if code != 1:
        return f"exit code {code}, expected 1; " + " | ".join(lines[:3])
    if len(lines) != 1:
        return f"{len(lines)} lines on stderr, expected 1: " + " | ".join(lines[:3])
    if not lines[0].startswith(PROGRAM + ": ") or name not in lines[0]:
        return "the message does not name the file: " + lines[0]
    if os.path.exists(out) or os.listdir(os.path.dirname(out)):
        return "something was left in the output folder"
    return None


def acceptance_problem(code, lines, out):
    if code != 0:
        return f"exit code {code}: " + " | ".join(lines[:3])
    if not os.path.exists(out):
        return "no picture"
    return None


def in_folder(check):
    """Calls check(folder) with an empty folder that is removed afterwards."""
    with tempfile.TemporaryDirectory() as folder:
        return check(folder)
