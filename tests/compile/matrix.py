#!/usr/bin/env python3
"""The compile matrix: matrix.py GROUP... --out FOLDER
    [--include FOLDER] [--full | --brief] [--jobs N]

Writes small sources for every hdrp*.h in the include folder (default: the headers of this tree) and
compiles them; a new header is covered by existing. One that includes a Vulkan header is left out
where there is none. Groups:

    c_gcc c_clang cxx_gcc cxx_clang
             each header, and again behind itself, in the first and the last standard, without and
             with its implementation; all of them forwards and backwards; before and after
             <math.h> and <vulkan/vulkan.h>; after the macros of <windows.h>. gcc also optimises C
             and keeps every function, for its flow warnings
    m32      each header for a 32-bit target
    link     two translation units, C and C++ mixed, one with the implementations: linked and run
    glsl glsl_es hlsl
             shaders that call every formula: SPIR-V, validated, translated by SPIRV-Cross to Metal,
             HLSL and GLSL; each header twice, all of them forwards and backwards
    opencl cuda
             kernels that call every formula, checked by clang

--full uses every standard everywhere, includes every ordered pair by itself and compiles what
SPIRV-Cross wrote; --brief uses one standard and leaves out what does not depend on how the headers
are cut into files.
A failure prints the command and what the compiler said. Exit status 77: a program is missing.
"""
import argparse
import concurrent.futures
import functools
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import calls  # noqa: E402
import hdrp_api  # noqa: E402

SKIPPED = 77
COMMAND_TIMEOUT_S = 120
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow",
            "-Werror"]
ALL_STANDARDS = {"c": ["c99", "c11", "c17"], "cxx": ["c++11", "c++14", "c++17", "c++20"]}
STANDARDS = {"c": ["c99", "c17"], "cxx": ["c++11", "c++20"]}
ONE_STANDARD = {"c": "c99", "cxx": "c++11"}
DRIVER = {("gcc", "c"): "gcc", ("gcc", "cxx"): "g++",
          ("clang", "c"): "clang", ("clang", "cxx"): "clang++"}
SUFFIX = {"c": "c", "cxx": "cpp"}
# Keeps every function, so that warnings which need the flow of data look at all of them.
OPTIMISED = ["-O2", "-fkeep-inline-functions", "-DHDRP_FN=static inline", "-c", "-o", "/dev/null"]
IMPLEMENTATION = re.compile(r"\bHDRP_[A-Z0-9_]+_IMPLEMENTATION\b")
SYSTEM = "".join(f"#include <{name}.h>\n"
                 for name in ("math", "stddef", "stdint", "stdio", "stdlib", "string"))
# What windows.h leaves behind; standard headers do not survive it either, so they come first.
WINDOWS = SYSTEM + """
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define near
#define far
#define small char
#define hyper long
#define interface struct
#define IN
#define OUT
#define OPTIONAL
#define CONST const
#define ERROR 0
#define TRUE 1
#define FALSE 0
"""


@dataclass
class Job:
    """Sources to write and the commands that must succeed on them, one after the other."""
    title: str
    files: dict
    commands: list
    forbidden: str = None  # text that must not appear in what the commands print
    output: str = field(default="", init=False)

    def write(self):
        for path, text in self.files.items():
            path.write_text(text)

    def run(self):
        for command in self.commands:
            try:
                result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                        text=True, errors="replace", timeout=COMMAND_TIMEOUT_S)
                failed, said = result.returncode != 0, result.stdout
            except subprocess.TimeoutExpired:
                failed, said = True, f"still running after {COMMAND_TIMEOUT_S} s"
            if failed or (self.forbidden and self.forbidden in said):
                self.output = f"FAILED {self.title}\n{shlex.join(map(str, command))}\n{said}"
                return False
        return True


PART = re.compile(r"hdrp_gpu_vk_\w+\.h$")


class Matrix:
    def __init__(self, options):
        self.include = options.include.resolve()
        self.out = options.out.resolve()
        self.full, self.brief = options.full, options.brief
        self.headers = sorted(path for path in self.include.glob("hdrp*.h")
                              if has_vulkan() or "<vulkan/" not in path.read_text())
        self.orders = self.orders_of_inclusion()
        self.implementations = {path: sorted(set(IMPLEMENTATION.findall(path.read_text())))
                                for path in self.headers}
        self.called = 0

    def orders_of_inclusion(self):
        """name -> headers, so that each comes somewhere before and after every other: all of them
        forwards and backwards, or every pair by itself."""
        if self.full:
            return {f"{a.stem}-{b.stem}": [a, b]
                    for a in self.headers for b in self.headers if a != b}
        return {"all-forwards": self.headers, "all-backwards": self.headers[::-1]}

    def orders_of_optimising(self):
        """name -> headers, so that each function of them is compiled once, or with each header."""
        if self.full:
            return {header.stem: [header] for header in self.headers}
        return {"all": self.headers}

    def standards(self, language):
        if self.full:
            return ALL_STANDARDS[language]
        return [ONE_STANDARD[language]] if self.brief else STANDARDS[language]

    def few_standards(self, language):
        return ALL_STANDARDS[language] if self.full else [ONE_STANDARD[language]]

    def define(self, *headers):
        names = sorted({name for header in headers for name in self.implementations[header]})
        return "".join(f"#define {name}\n" for name in names)

    # C and C++

    def host_job(self, compiler, language, standard, name, text, flags=("-fsyntax-only",)):
        source = self.out / f"{name}.{SUFFIX[language]}"
        command = [DRIVER[compiler, language], f"-std={standard}", *WARNINGS, f"-I{self.include}",
                   *flags, source]
        return Job(f"{name} as {standard} with {compiler}", {source: text}, [command])

    def alone(self, header):
        """name -> source: what is tried in every standard. One that includes the header again
        begins with the header by itself."""
        stem = header.stem
        include = f'#include "{header.name}"\n'
        define = self.define(header)
        texts = {f"{stem}-twice": include + define + include + include}
        if define:
            texts[f"{stem}-implementation"] = define + include
        return texts

    def contexts(self, header):
        include = self.define(header) + f'#include "{header.name}"\n'
        others = "#include <math.h>\n#include <vulkan/vulkan.h>\n"
        return {f"{header.stem}-after-windows": WINDOWS + include,
                f"{header.stem}-after-others": others + include,
                f"{header.stem}-before-others": include + others}

    def order_text(self, headers):
        return self.define(*headers) + "".join(f'#include "{h.name}"\n' for h in headers)

    def host(self, compiler, language):
        few, jobs = {}, []
        for header in self.headers:
            # A part of a module is tried with the header that includes it, and once by itself.
            is_part = PART.match(header.name) and not self.full
            if is_part and self.brief:
                continue
            standards = [ONE_STANDARD[language]] if is_part else self.standards(language)
            for name, text in self.alone(header).items():
                jobs += [self.host_job(compiler, language, standard, name, text)
                         for standard in standards]
            if not self.brief and not is_part:
                few.update(self.contexts(header))
        if compiler == "gcc" and not self.brief and (language == "c" or self.full):
            jobs += [self.host_job(compiler, language, ONE_STANDARD[language], f"{name}-optimised",
                                   self.order_text(headers), OPTIMISED)
                     for name, headers in self.orders_of_optimising().items()]
        few.update({name: self.order_text(headers) for name, headers in self.orders.items()})
        return jobs + [self.host_job(compiler, language, standard, name, text)
                       for name, text in few.items() for standard in self.few_standards(language)]

    def m32(self):
        return [self.host_job(compiler, language, standard, f"{header.stem}-m32-{compiler}",
                              self.define(header) + f'#include "{header.name}"\n',
                              ["-m32", "-fsyntax-only"])
                for header in self.headers for compiler, language in DRIVER
                for standard in self.few_standards(language)]

    def link(self):
        includes = "".join(f'#include "{header.name}"\n' for header in self.headers)
        functions = [function.name for header in self.headers
                     for function in hdrp_api.functions(header) if function.qualifier == "HDRP_API"]
        table = "".join(f"    (any_function)&{name},\n" for name in functions)
        unit = self.define(*self.headers) + includes
        # Called through volatile pointers, so that no function is dropped before the linker.
        user = (includes + "typedef void (*any_function)(void);\n"
                "static any_function volatile functions[] = {\n" + table +
                "    (any_function)&hdrp_result_string,\n};\nint main(void)\n{\n"
                "    unsigned missing = 0, i;\n"
                "    for (i = 0; i < sizeof functions / sizeof functions[0]; ++i) {\n"
                "        missing += functions[i] == 0;\n    }\n    return missing != 0;\n}\n")
        jobs = []
        for compiler in ("gcc", "clang"):
            pairs = [("c", "c"), ("cxx", "c"), ("c", "cxx"), ("cxx", "cxx")]
            for user_language, unit_language in pairs[:1] if self.brief else pairs:
                name = f"link-{compiler}-{user_language}-{unit_language}"
                files, commands, objects = {}, [], []
                for part, language, text in (("user", user_language, user),
                                             ("unit", unit_language, unit)):
                    source = self.out / f"{name}-{part}.{SUFFIX[language]}"
                    files[source] = text
                    objects.append(source.with_suffix(".o"))
                    commands.append([DRIVER[compiler, language],
                                     f"-std={ONE_STANDARD[language]}", *WARNINGS,
                                     f"-I{self.include}", "-c", source, "-o", objects[-1]])
                program = self.out / name
                linker = "cxx" if "cxx" in (user_language, unit_language) else "c"
                commands += [[DRIVER[compiler, linker], *objects, "-o", program, "-lm"], [program]]
                jobs.append(Job(name, files, commands))
        return jobs

    # Shaders

    def shared_functions(self, header, define):
        """The formulas that a header has in a language which defines that macro."""
        command = ["gcc", "-E", "-P", "-x", "c", f"-D{define}", f"-I{self.include}", str(header)]
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode:
            sys.exit(f"FAILED {shlex.join(command)}\n{result.stderr}")
        present = set(re.findall(r"\b(hdrp_\w+)\([^()]*\)\s*\{", result.stdout))
        found = [function for function in hdrp_api.functions(header)
                 if function.is_formula and function.name in present]
        self.called += len(found)
        return found

    def shader_sources(self, language, stage, includes, body, calls_all):
        include = "".join(f'#include "{name}"\n' for name in includes)
        result = "call_all(x, u)" if calls_all else "x"
        if language == "hlsl":
            if stage == "comp":
                return (f"{include}RWStructuredBuffer<float> data : register(u0);\n{body}"
                        "[numthreads(1, 1, 1)]\nvoid main(uint3 id : SV_DispatchThreadID)\n{\n"
                        "    float x = data[id.x];\n    uint u = id.y;\n"
                        f"    data[id.x] = {result};\n}}\n")
            return (f"{include}{body}"
                    "float4 main(float x : TEXCOORD0, nointerpolation uint u : TEXCOORD1)"
                    " : SV_Target0\n{\n    float r = "
                    f"{result};\n    return float4(r, r, r, r);\n}}\n")
        version = "310 es" if language == "glsl_es" else "450"
        start = (f"#version {version}\n#extension GL_GOOGLE_include_directive : require\n"
                 f"{include}{body}")
        if stage == "comp":
            return (start + "layout(local_size_x = 1) in;\n"
                    "layout(std430, binding = 0) buffer Data { float data[]; };\n"
                    "void main()\n{\n    uint i = gl_GlobalInvocationID.x;\n"
                    "    float x = data[i];\n    uint u = gl_GlobalInvocationID.y;\n"
                    f"    data[i] = {result};\n}}\n")
        return (start + "layout(location = 0) in float x;\n"
                "layout(location = 1) flat in uint u;\n"
                "layout(location = 0) out vec4 color;\n"
                f"void main()\n{{\n    color = vec4({result});\n}}\n")

    def shader_job(self, language, stage, name, includes, body="", calls_all=False):
        name = f"{name}-{language}-{stage}"
        suffix = "hlsl" if language == "hlsl" else stage
        source = self.out / f"{name}.{suffix}"
        module = self.out / f"{name}.spv"
        text = self.shader_sources(language, stage, includes, body, calls_all)
        flags = ["-D", "-DHDRP_HLSL", "-S", stage, "-e", "main"] if language == "hlsl" else []
        commands = [["glslangValidator", "-V", *flags, f"-I{self.include}", "-o", module, source]]
        if language == "glsl_es":
            # Linking instead of -V applies the rules of OpenGL ES itself, not those of Vulkan.
            commands.append(["glslangValidator", "-l", f"-I{self.include}", source])
        if calls_all:
            metal, hlsl, glsl = (self.out / f"{name}.{s}"
                                 for s in ("metal", "out.hlsl", f"out.{stage}"))
            version = ["--version", "450"]
            if language == "glsl_es":
                version = ["--version", "310", "--es"]
            commands += [
                ["spirv-val", "--target-env", "vulkan1.0", module],
                ["spirv-cross", module, "--msl", "--output", metal],
                ["spirv-cross", module, "--hlsl", "--shader-model", "50", "--output", hlsl],
                ["spirv-cross", module, *version, "--output", glsl]]
            if self.full:
                commands.append(["glslangValidator", glsl])
        return Job(name, {source: text}, commands, forbidden="WARNING")

    def for_shaders(self):
        """Headers with formulas. The one-file versions of those of passes hold the formulas of all
        others again, and take as long as these together."""
        return [header for header in self.headers
                if not (self.brief and header.name.startswith("hdrp_gpu_"))]

    def shaders(self, language, stages):
        jobs = []
        stages = stages[:1] if self.brief else stages
        define = "HDRP_HLSL" if language == "hlsl" else "GL_core_profile"
        for header in self.for_shaders():
            if not self.brief:  # the text of formulas is the same in all files
                body = calls.text(self.shared_functions(header, define), self.headers)
                jobs += [self.shader_job(language, stage, header.stem, [header.name], body, True)
                         for stage in stages]
            jobs.append(self.shader_job(language, stages[0], f"{header.stem}-twice",
                                        [header.name, header.name]))
        if self.full or language != "glsl_es":
            jobs += [self.shader_job(language, stages[0], name, [h.name for h in headers])
                     for name, headers in self.orders.items()]
        return jobs

    # Kernels

    def opencl(self):
        jobs = []
        for header in self.headers:
            functions = self.shared_functions(header, "__OPENCL_C_VERSION__=200")
            source = self.out / f"{header.stem}.cl"
            text = (f'#include "{header.name}"\n{calls.text(functions, self.headers)}'
                    "kernel void all(global float* data)\n{\n"
                    "    data[0] = call_all(data[0], (uint)get_global_id(0));\n}\n")
            for standard in ("CL1.2", "CL2.0"):
                jobs.append(Job(f"{header.stem} as OpenCL {standard}", {source: text},
                                [["clang", "-x", "cl", f"-cl-std={standard}", "-Xclang",
                                  "-finclude-default-header", "-Wall", "-Werror",
                                  f"-I{self.include}", "-fsyntax-only", source]]))
        return jobs

    def cuda(self):
        """CUDA's own headers are not needed: what they declare for a device is declared here."""
        used = {}
        for header in self.headers:
            for name, arguments in re.findall(r"HDRP_I_F\((\w+)\)\(([^()]*)\)",
                                              header.read_text()):
                used[name] = arguments.count(",") + 1
        device = "__attribute__((device))"
        prelude = ("#include <math.h>\n#include <string.h>\n"
                   f"{device} void* memcpy(void*, const void*, size_t);\n")
        prelude += "".join(f"{device} float {name}f({', '.join(['float'] * count)});\n"
                           for name, count in sorted(used.items()))
        jobs = []
        for header in self.headers:
            functions = self.shared_functions(header, "HDRP_HLSL")
            source = self.out / f"{header.stem}.cu"
            text = (f'{prelude}#include "{header.name}"\n{calls.text(functions, self.headers)}'
                    f"__attribute__((global)) void all(float* data)\n{{\n"
                    "    data[0] = call_all(data[0], 1u);\n}\n")
            jobs.append(Job(f"{header.stem} as CUDA", {source: text},
                            [["clang", "-x", "cuda", "--cuda-gpu-arch=sm_60", "-nocudalib",
                              "-nocudainc", "-Wno-unknown-cuda-version",
                              "-Wall", "-Werror", f"-I{self.include}",
                              "-fsyntax-only", source]]))
        return jobs


SHADER_PROGRAMS = ["gcc", "glslangValidator", "spirv-val", "spirv-cross"]
GROUPS = {
    "c_gcc": (["gcc"], lambda m: m.host("gcc", "c")),
    "c_clang": (["clang"], lambda m: m.host("clang", "c")),
    "cxx_gcc": (["g++"], lambda m: m.host("gcc", "cxx")),
    "cxx_clang": (["clang++"], lambda m: m.host("clang", "cxx")),
    "m32": (list(DRIVER.values()), Matrix.m32),
    "link": (list(DRIVER.values()), Matrix.link),
    "glsl": (SHADER_PROGRAMS, lambda m: m.shaders("glsl", ["comp", "frag"])),
    "glsl_es": (SHADER_PROGRAMS, lambda m: m.shaders("glsl_es", ["frag"])),
    "hlsl": (SHADER_PROGRAMS, lambda m: m.shaders("hlsl", ["comp", "frag"])),
    "opencl": (["gcc", "clang"], Matrix.opencl),
    "cuda": (["gcc", "clang"], Matrix.cuda),
}


@functools.lru_cache(maxsize=None)
def has_vulkan():
    return subprocess.run(["gcc", "-x", "c", "-include", "vulkan/vulkan_core.h", "-fsyntax-only",
                           "/dev/null"], capture_output=True).returncode == 0


def has_32_bit_libraries():
    return subprocess.run(["gcc", "-m32", "-x", "c", "-include", "stdint.h", "-fsyntax-only",
                           "/dev/null"], capture_output=True).returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("groups", nargs="+", choices=GROUPS, metavar="GROUP")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--include", type=pathlib.Path, default=hdrp_api.ROOT)
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--brief", action="store_true")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()

    missing = sorted({program for group in options.groups for program in GROUPS[group][0]
                      if not shutil.which(program)})
    if missing:
        print("skipped: not installed:", *missing)
        return SKIPPED
    if "m32" in options.groups and not has_32_bit_libraries():
        print("skipped: no 32-bit C library here (Debian on amd64: gcc-multilib g++-multilib)")
        return SKIPPED

    start = time.monotonic()
    options.out.mkdir(parents=True, exist_ok=True)
    matrix = Matrix(options)
    jobs = [job for group in options.groups for job in GROUPS[group][1](matrix)]
    for job in jobs:  # several jobs may share a source
        job.write()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        good = list(pool.map(Job.run, jobs))
    for job in jobs:
        if job.output:
            print(job.output)
    print(f"{len(matrix.headers)} headers, {len(jobs)} sources, {matrix.called} formulas called, "
          f"{good.count(False)} failed, {time.monotonic() - start:.1f} s")
    return not jobs or not all(good)


if __name__ == "__main__":
    sys.exit(main())
