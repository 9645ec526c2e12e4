#!/usr/bin/env python3
"""Builds and runs programs that use hdrp in a documented way: consume.py WAY --build FOLDER ...

WAY is find_package or pkg_config (after installing from the build folder), subdirectory (the source
tree inside another CMake project), one_file (one header of "make dist", copied) or copied_headers
(the plain headers, copied). Every way compiles as C and as C++.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONSUMER = pathlib.Path(__file__).resolve().parent / "consumer"
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror", "-O2"]
SKIPPED = 77


def run(*command, **options):
    """The output of a command that has to succeed."""
    command = [str(part) for part in command]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            **options)
    if result.returncode:
        sys.exit(f"FAILED {' '.join(command)}\n{result.stdout}")
    return result.stdout


def must_fail(reason, *command):
    command = [str(part) for part in command]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode == 0 or reason not in result.stderr:
        sys.exit(f"FAILED to fail with {reason!r}: {' '.join(command)}\n{result.stderr}")


class Consumer:
    def __init__(self, options):
        self.cmake, self.build, self.out = options.cmake, options.build, options.out.resolve()
        self.version = options.version
        self.greeting = f"hdrp {options.version}\n"

    def run_program(self, program):
        said = run(program)
        if said != self.greeting:
            sys.exit(f"FAILED {program} said {said!r}, not {self.greeting!r}")

    def build_by_hand(self, name, *flags):
        """One source, compiled as C and as C++."""
        for compiler, language, standard in (("gcc", "c", "c99"), ("g++", "c++", "c++11")):
            program = self.out / f"{name}_{compiler}"
            run(compiler, f"-std={standard}", *STRICT, "-x", language, CONSUMER / "consumer.c",
                "-x", "none", *flags, "-o", program)
            self.run_program(program)

    def build_project(self, *definitions):
        modules = ";".join(path.stem[len("hdrp_"):] for path in sorted(ROOT.glob("hdrp_*.h")))
        folder = self.out / "build"
        run(self.cmake, "-S", CONSUMER, "-B", folder, "-DCMAKE_BUILD_TYPE=Release",
            f"-DHDRP_MODULES={modules}", *definitions)
        run(self.cmake, "--build", folder)
        for program in ("consumer_c", "consumer_cxx"):
            self.run_program(folder / program)
        return folder

    def install(self):
        """Installs, then moves: an installed tree does not know where it was made."""
        prefix, moved = self.out / "installed", self.out / "moved"
        run(self.cmake, "--install", self.build, "--prefix", prefix)
        prefix.rename(moved)
        return moved

    def compile_shader(self, prefix):
        """A shader that includes all that is for users' shaders, where there is a compiler."""
        if not shutil.which("glslangValidator"):
            print("no glslangValidator: installed shaders were not compiled")
            return
        include = prefix / "include"
        run("glslangValidator", "-V", "--target-env", "vulkan1.1", f"-I{include}",
            f"-I{include / 'hdrp'}", CONSUMER / "consumer.frag", "-o", self.out / "consumer.spv")

    def find_package(self):
        prefix = self.install()
        self.compile_shader(prefix)
        self.build_project(f"-DCMAKE_PREFIX_PATH={prefix}",
                           f"-DHDRP_WANTED_VERSION={self.version}")
        must_fail('requested version "99.0"',
                  self.cmake, "-S", CONSUMER, "-B", self.out / "too_new",
                  f"-DCMAKE_PREFIX_PATH={prefix}", "-DHDRP_WANTED_VERSION=99.0")

    def pkg_config(self):
        prefix = self.install()
        environment = dict(os.environ, PKG_CONFIG_PATH=str(prefix / "share" / "pkgconfig"))
        said = run("pkg-config", "--modversion", "hdrp", env=environment)
        if said.strip() != self.version:
            sys.exit(f"FAILED pkg-config says version {said}")
        flags = run("pkg-config", "--cflags", "--libs", "hdrp", env=environment).split()
        self.build_by_hand("consumer", *flags)

    def subdirectory(self):
        folder = self.build_project(f"-DHDRP_FOLDER={ROOT}")
        listed = run("ctest", "-N", cwd=folder)
        if "Total Tests: 0" not in listed:
            sys.exit(f"FAILED a parent project got our tests:\n{listed}")

    def one_file(self):
        dist = self.out / "dist"
        run(sys.executable, ROOT / "tools" / "amalgamate.py", dist)
        for source in ("hdrp_brdf.h", "hdrp.h"):
            copied = self.out / source.replace(".", "_")
            copied.mkdir()
            shutil.copy(dist / source, copied / "hdrp_brdf.h")
            self.build_by_hand(f"{copied.name}_consumer", f"-I{copied}", "-lm")

    def copied_headers(self):
        copied = self.out / "copied"
        copied.mkdir()
        for path in ROOT.glob("hdrp_*.h"):
            shutil.copy(path, copied)
        self.build_by_hand("consumer", f"-I{copied}", "-lm")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("way", choices=["find_package", "pkg_config", "subdirectory", "one_file",
                                        "copied_headers"])
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--cmake", default="cmake")
    parser.add_argument("--version", required=True)
    options = parser.parse_args()
    needed = {"gcc", "g++"} | ({"pkg-config"} if options.way == "pkg_config" else set())
    missing = sorted(program for program in needed if not shutil.which(program))
    if missing:
        print("skipped: not installed:", *missing)
        return SKIPPED
    shutil.rmtree(options.out, ignore_errors=True)
    options.out.mkdir(parents=True)
    getattr(Consumer(options), options.way)()
    return 0


if __name__ == "__main__":
    sys.exit(main())
