#!/usr/bin/env python3
"""What formulas and the Lit model cost on AMD GPUs, without one:

    gcn_probe.py [FUNCTION...]             a table for each family of GPUs
    gcn_probe.py --check [FUNCTION...]     fails where the recorded numbers are no longer right,
                                           with --family only those of it
    gcn_probe.py --write                   records them
    gcn_probe.py --features [VARIANT...]   fails where a feature that is off costs something
    gcn_probe.py --show SHADER             machine code of a FUNCTION, or KIND:VARIANT of Lit

Mesa's RADV driver compiles for GPUs that are not there; tools/gcn_probe.c asks it what it made of
each shader. Numbers depend on the versions of Mesa, glslang and SPIRV-Tools: those are recorded
too, and --check is skipped (exit status 77) with any others, or without one of the programs.
"""
import argparse
import csv
import io
import os
import pathlib
import platform
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import gcn_shaders
import hdrp_api

RESULTS = hdrp_api.ROOT / "bench" / "results"
SKIPPED = 77
# GCN 2, the generation of the consoles that the talks measured on; GCN 5; RDNA 3.
FAMILIES = ["bonaire", "vega10", "gfx1100"]
COLUMNS = ["kind", "name", "family", "instructions", "vgprs", "sgprs", "lds_bytes",
           "waves_per_simd", "spirv_instructions", "cycles", "busy_cycles", "code_bytes",
           "spilled_registers"]
STATISTICS = {"instructions": "Instructions", "vgprs": "VGPRs", "sgprs": "SGPRs",
              "lds_bytes": "LDS size", "waves_per_simd": "Subgroups per SIMD",
              "cycles": "Latency", "busy_cycles": "Inverse Throughput", "code_bytes": "Code size"}
SPILLS = ["Spilled SGPRs", "Spilled VGPRs"]
# What an extra instruction adds to, and what a shader as a whole has.
ADDITIVE = ["instructions", "spirv_instructions", "cycles", "code_bytes"]
# By how much variants with several features may differ from headers without the others: the order
# in which the driver's passes meet the code decides about a few instructions, either way, and then
# about one unit of allocation of registers.
LEEWAY = {"instructions": 4, "sgprs": 0, "lds_bytes": 0, "spilled_registers": 0}
VGPR_UNIT = {"bonaire": 4, "vega10": 4, "gfx1100": 12}
NOTES = """\
formula: without loads and stores but for registers and waves; arguments are in registers
empty: shaders of loads and stores alone, which have been subtracted
lit: material and view loaded, hdrp_brdf_lit_view_make, a loop over lights
lit_light: one more turn of that loop
lit_env: material and view loaded, hdrp_brdf_lit_view_make, hdrp_brdf_lit_env_make, its lookups
spirv_instructions: inlined, without dead code; of lit variants with the mask as a constant
cycles: the driver's estimate for one wave alone, issue and stalls, 8 turns of each loop
busy_cycles: the driver's estimate for one wave among as many as fit"""
# Mesa's estimate of how often a loop runs.
LOOP_TURNS = 8
# Inlines everything, as every driver does first, and leaves the rest to the driver. Unlike with -O,
# a shader is then the same whether a mask is a constant or a specialization constant.
OPTIMISE = ["--eliminate-dead-functions", "--merge-return", "--inline-entry-points-exhaustive",
            "--eliminate-dead-functions", "--eliminate-local-single-block",
            "--eliminate-local-single-store", "--eliminate-dead-code-aggressive",
            "--scalar-replacement=0", "--convert-local-access-chains",
            "--eliminate-local-single-block", "--eliminate-local-single-store",
            "--eliminate-dead-code-aggressive", "--ssa-rewrite",
            "--eliminate-dead-code-aggressive"]
# What is counted has lost, besides, members of structs that are made and not used: the loads that
# are left then are those that every driver leaves. A driver does not get this, because the order of
# its instructions depends on whether there was a dead branch.
COUNTED = ["--simplify-instructions", "--eliminate-dead-code-aggressive"]
PROBE_FLAGS = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow",
               "-Werror"]
DIFFERENCES_SHOWN = 20


class Skip(Exception):
    """Something is missing that the numbers depend on."""


def need(program):
    path = shutil.which(program)
    if not path:
        raise Skip(f"{program} is not installed")
    return path


def run(command, **options):
    result = subprocess.run(command, capture_output=True, check=False, **options)
    if result.returncode != 0:
        output = b"" if isinstance(result.stdout, bytes) else ""
        output = output.join([result.stdout, result.stderr])
        text = output.decode(errors="replace") if isinstance(output, bytes) else output
        sys.exit(f"{' '.join(map(str, command))}\n{text}")
    return result.stdout


# ---- SPIR-V ------------------------------------------------------------------------------------

OP_NAME, OP_MEMBER_NAME, OP_FUNCTION, OP_FUNCTION_END, OP_FUNCTION_CALL = 5, 6, 54, 56, 57
OP_VARIABLE, OP_LOAD, OP_ACCESS_CHAIN, OP_LABEL = 59, 61, 65, 248
BUFFER_STORAGE = 2, 12  # Uniform, StorageBuffer
HEADER_WORDS = 5


def instructions_of(words):
    """(opcode, index of its first word, index after its last) of every instruction."""
    at = HEADER_WORDS
    while at < len(words):
        end = at + (words[at] >> 16)
        yield words[at] & 0xffff, at, end
        at = end


def words_of(binary):
    return list(struct.unpack(f"<{len(binary) // 4}I", binary))


def bytes_of(words):
    return struct.pack(f"<{len(words)}I", *words)


def functions_of(words):
    """name -> id of every function without parameters."""
    result = {}
    for opcode, at, end in instructions_of(words):
        if opcode == OP_NAME:
            text = bytes_of(words[at + 2:end]).split(b"\0")[0].decode()
            if text == "main" or text.endswith("("):
                result[text.rstrip("(")] = words[at + 1]
    return result


def cut(words):
    """(what stands before the functions, without names; {function: (words, functions called)})"""
    before, functions, callees = words[:HEADER_WORDS], {}, set()
    begin = None
    for opcode, at, end in instructions_of(words):
        if opcode == OP_FUNCTION:
            begin, function, callees = at, words[at + 2], set()
        elif opcode == OP_FUNCTION_CALL:
            callees.add(words[at + 3])
        elif opcode == OP_FUNCTION_END:
            functions[function] = words[begin:end], callees
        elif begin is None and opcode not in (OP_NAME, OP_MEMBER_NAME):
            before += words[at:end]
    return before, functions


def only_call(words, function):
    """A function without its calls of any other function but this one."""
    header, result = [0] * HEADER_WORDS, []
    for opcode, at, end in instructions_of(header + words):
        if opcode != OP_FUNCTION_CALL or words[at - HEADER_WORDS + 3] == function:
            result += words[at - HEADER_WORDS:end - HEADER_WORDS]
    return result


def needed_by(function, functions):
    """The function and all that it calls, directly or not. spirv-opt could find them too, but takes
    a third of a second for it where a module has a hundred."""
    found, pending = {function}, [function]
    while pending:
        new = functions[pending.pop()][1] - found
        found |= new
        pending += new
    return found


def separate(words, names):
    """(name, binary) of each of these functions, as all that main calls."""
    ids, (before, functions) = functions_of(words), cut(words)
    for name in names:
        kept = needed_by(ids[name], functions)
        result = list(before)
        for function, (text, _) in functions.items():
            if function == ids["main"]:
                result += only_call(text, ids[name])
            elif function in kept:
                result += text
        yield name, bytes_of(result)


def count(words):
    """(instructions inside functions, how many of them load from a buffer)"""
    inside, total, loads, pointers = False, 0, 0, set()
    for opcode, at, _ in instructions_of(words):
        if opcode in (OP_FUNCTION, OP_FUNCTION_END):
            inside = opcode == OP_FUNCTION
        elif opcode == OP_VARIABLE and words[at + 3] in BUFFER_STORAGE:
            pointers.add(words[at + 2])
        elif inside and opcode != OP_LABEL:
            total += 1
            if opcode == OP_ACCESS_CHAIN and words[at + 3] in pointers:
                pointers.add(words[at + 2])
            loads += opcode == OP_LOAD and words[at + 3] in pointers
    return total, loads


# ---- the driver --------------------------------------------------------------------------------

@dataclass
class Compiled:
    """A shader as the driver will get it."""
    shader: gcn_shaders.Shader
    path: pathlib.Path
    spirv_instructions: int
    loads: int


@dataclass
class Measured:
    statistics: dict = field(default_factory=dict)  # as the driver names them
    code: str = ""

    def numbers(self):
        """column -> number"""
        result = {column: int(self.statistics[name]) for column, name in STATISTICS.items()
                  if name in self.statistics}
        result["spilled_registers"] = sum(int(self.statistics.get(name, 0)) for name in SPILLS)
        return result


def find_driver():
    """The file by which Vulkan's loader finds RADV."""
    folders = [folder for key, default in
               (("XDG_DATA_HOME", "~/.local/share"), ("XDG_CONFIG_DIRS", "/etc/xdg"),
                ("SYSCONFDIR", "/etc"), ("XDG_DATA_DIRS", "/usr/local/share:/usr/share"))
               for folder in os.environ.get(key, default).split(":")]
    for folder in folders:
        found = sorted(pathlib.Path(folder).expanduser().glob("vulkan/icd.d/radeon_icd*.json"),
                       key=lambda path: (platform.machine() not in path.name, path.name))
        if found:
            return found[0]
    raise Skip("Mesa's driver for AMD is not installed (no vulkan/icd.d/radeon_icd*.json)")


class Bench:
    """Compiles shaders in a folder of its own and asks the driver about them."""

    def __init__(self, folder, root=hdrp_api.ROOT, families=None):
        self.folder, self.root = pathlib.Path(folder), pathlib.Path(root)
        self.families = families or FAMILIES
        self.glslang, self.spirv_opt = need("glslangValidator"), need("spirv-opt")
        self.driver = find_driver()
        self.program = self.folder / "gcn_probe"
        self.build_probe()

    def build_probe(self):
        compiler = need("cc")
        source = pathlib.Path(__file__).with_suffix(".c")
        test = subprocess.run([compiler, "-E", "-x", "c", "-"], capture_output=True, text=True,
                              input="#include <vulkan/vulkan.h>\n", check=False)
        if test.returncode != 0:
            raise Skip("<vulkan/vulkan.h> is not installed")
        run([compiler, *PROBE_FLAGS, source, "-o", self.program, "-lvulkan"])

    def versions(self):
        """One line that names everything the numbers depend on."""
        _, driver = self.ask([], FAMILIES[0])
        glslang = re.search(r"Glslang Version: (\S+)", run([self.glslang, "--version"], text=True))
        # spirv-opt says it on stderr.
        said = subprocess.run([self.spirv_opt, "--version"], capture_output=True, check=True)
        tools = re.search(r"SPIRV-Tools (\S+)", (said.stdout + said.stderr).decode())
        return (f"{driver['version']} ({driver['name']}), glslang {glslang[1]}, "
                f"SPIRV-Tools {tools[1]}")

    def compile(self, modules):
        """Compiled of every shader of the modules."""
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            binaries = list(pool.map(self.compile_text, modules))
            jobs = []
            for module, words in zip(modules, binaries):
                made = {}
                names = sorted({shader.entry for shader in module.shaders})
                for name, binary in ([("main", bytes_of(words))] if names == ["main"]
                                     else separate(words, names)):
                    stem = re.sub(r"\W", "_", f"{module.name}_{name}")
                    made[name] = pool.submit(self.optimise, binary, stem)
                jobs += [(shader, made[shader.entry]) for shader in module.shaders]
            return [Compiled(shader, *job.result()) for shader, job in jobs]

    def compile_text(self, module):
        stem = self.folder / re.sub(r"\W", "_", module.name)
        source, binary = stem.with_suffix(".comp"), stem.with_suffix(".spv")
        source.write_text(module.text)
        run([self.glslang, "-V", f"-I{self.root}", source, "-o", binary])
        return words_of(binary.read_bytes())

    def optimise(self, binary, stem):
        path, counted = self.folder / f"{stem}.opt.spv", self.folder / f"{stem}.counted.spv"
        run([self.spirv_opt, *OPTIMISE, "-", "-o", path], input=binary)
        run([self.spirv_opt, *COUNTED, path, "-o", counted])
        return path, *count(words_of(counted.read_bytes()))

    def ask(self, compiled, family, with_code=False):
        """({name: Measured}, {what the driver says of itself})"""
        code = self.folder / f"code_{family}"
        code.mkdir(exist_ok=True)
        environment = dict(os.environ, RADV_FORCE_FAMILY=family, MESA_SHADER_CACHE_DISABLE="1",
                           VK_ICD_FILENAMES=str(self.driver), VK_DRIVER_FILES=str(self.driver),
                           VK_LOADER_LAYERS_DISABLE="~implicit~", RADV_DEBUG="", RADV_PERFTEST="")
        lines = "".join(f"{c.shader.name} {c.path} {c.shader.mask}\n" for c in compiled)
        output = run([self.program, *([code] if with_code else [])], input=lines, text=True,
                     env=environment)
        result, driver = {c.shader.name: Measured() for c in compiled}, {}
        for line in output.splitlines():
            name, key, value = line.split("\t")
            (driver if name == "driver" else result[name].statistics)[key] = value
        if "RADV" not in driver.get("device", ""):
            raise Skip(f"{driver.get('device')} is not RADV's null device")
        for name, measured in result.items():
            path = code / name
            if with_code and path.exists() and "not supported" not in path.read_text()[:100]:
                measured.code = path.read_text()
        return result, driver

    def ask_all(self, compiled, with_code=False):
        """family -> {name: Measured}"""
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            jobs = {family: pool.submit(self.ask, compiled, family, with_code)
                    for family in self.families}
            return {family: job.result()[0] for family, job in jobs.items()}


# ---- rows --------------------------------------------------------------------------------------

def numbers_of(compiled, measured):
    """name -> {column: number}"""
    result = {}
    for c in compiled:
        result[c.shader.name] = measured[c.shader.name].numbers()
        result[c.shader.name]["spirv_instructions"] = c.spirv_instructions
    return result


def formula_rows(bench, names):
    compiled = bench.compile(gcn_shaders.formula_modules(bench.root, names))
    # Arguments that are not used are not loaded.
    signatures = {c.shader.name: (c.loads, c.shader.stores) for c in compiled}
    # With more loads than stores, every load still needs a store to be kept.
    measured_signatures = {(1, 1), (1, 2)} | {(loads, max(loads, stores))
                                              for loads, stores in signatures.values()}
    compiled += bench.compile([gcn_shaders.empty_module(measured_signatures)])
    for family, measured in bench.ask_all(compiled).items():
        numbers = numbers_of(compiled, measured)
        one, two = (numbers[gcn_shaders.empty_name(1, stores)] for stores in (1, 2))
        for name, (loads, stores) in signatures.items():
            row, most = numbers[name], max(loads, stores)
            empty = numbers[gcn_shaders.empty_name(loads, most)]
            for column in ADDITIVE:
                store = two[column] - one[column]
                row[column] -= empty[column] - (most - stores) * store
            # An estimate: what is scheduled around many loads may save more than a formula takes.
            row["cycles"] = max(row["cycles"], 0)
            del row["busy_cycles"]  # not a sum
            yield dict(row, kind="formula", name=name, family=family)
        for loads, stores in measured_signatures:
            name = gcn_shaders.empty_name(loads, stores)
            yield dict(numbers[name], kind="empty", name=name, family=family)


def lit_rows(bench):
    variants = gcn_shaders.VARIANTS
    modules = []
    for kind in gcn_shaders.BODIES:
        modules += [gcn_shaders.lit_module(kind, variants), gcn_shaders.lit_module_run_time(kind)]
    compiled = bench.compile(modules)
    constants = {c.shader.name.rsplit(":", 1)[0]: c.spirv_instructions for c in bench.compile(
        [gcn_shaders.lit_module_without(kind, variant, bench.root)
         for kind in gcn_shaders.BODIES for variant in variants])}
    for family, measured in bench.ask_all(compiled).items():
        numbers = numbers_of(compiled, measured)
        for name, row in numbers.items():
            row["spirv_instructions"] = constants.get(name, row["spirv_instructions"])
        for name, row in numbers.items():
            kind, variant = name.split(":")
            if kind == "lit_light":
                row = one_turn(numbers[gcn_shaders.lit_name("lit", variant)], row)
            yield dict(row, kind=kind, name=variant, family=family)


def one_turn(one_loop, two_loops):
    """What the second loop adds to the first, per turn; registers are those of one loop."""
    row = dict(one_loop)
    for column in ADDITIVE + ["busy_cycles"]:
        row[column] = two_loops[column] - one_loop[column]
    for column in ("cycles", "busy_cycles"):
        row[column] = round(row[column] / LOOP_TURNS)
    return row


def all_rows(bench, names=None):
    rows = list(formula_rows(bench, names))
    if not names:
        rows += lit_rows(bench)
    kinds = ["formula", "empty", *gcn_shaders.BODIES]
    return sorted(rows, key=lambda row: (kinds.index(row["kind"]), row["name"],
                                         FAMILIES.index(row["family"])))


def document(versions, rows):
    text = io.StringIO()
    text.write("".join(f"# {line}\n" for line in [versions, *NOTES.splitlines()]))
    writer = csv.DictWriter(text, COLUMNS, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


# ---- commands ----------------------------------------------------------------------------------

def print_report(rows):
    """A table for each family, the dearest first."""
    shown = ["instructions", "vgprs", "sgprs", "waves_per_simd", "spirv_instructions", "cycles",
             "busy_cycles", "spilled_registers"]
    heads = ["instr.", "VGPRs", "SGPRs", "waves", "SPIR-V", "cycles", "busy", "spilled"]
    width = max(len(f"{row['kind']} {row['name']}") for row in rows)
    for family in sorted({row["family"] for row in rows}, key=FAMILIES.index):
        print(f"\n{family}".ljust(width + 1) + "".join(f"{head:>8}" for head in heads))
        mine = [row for row in rows if row["family"] == family and row["kind"] != "empty"]
        kinds = ["lit", "lit_light", "lit_env", "formula"]
        for row in sorted(mine, key=lambda row: (kinds.index(row["kind"]), -row["instructions"],
                                                 row["name"])):
            print(f"{row['kind']} {row['name']}".ljust(width)
                  + "".join(f"{row.get(column, ''):>8}" for column in shown))


def recorded_path(versions, results):
    version = re.search(r"[0-9]+(\.[0-9]+)+", versions)
    return pathlib.Path(results) / f"gcn_mesa-{version[0]}.csv"


def check(bench, results, names):
    """0 when the recorded numbers, or those of these functions, are those that are measured."""
    versions = bench.versions()
    path = recorded_path(versions, results)
    if not path.exists():
        raise Skip(f"no numbers are recorded for {versions}")
    recorded = path.read_text().splitlines()
    if recorded[:1] != [f"# {versions}"]:
        raise Skip(f"{path.name} is for {recorded[0].lstrip('# ')}; this is {versions}")
    measured = document(versions, all_rows(bench, names)).splitlines()
    old, new = (dict(keyed(line) for line in lines) for lines in (recorded, measured))
    # The rest has not been measured.
    old = {key: line for key, line in old.items()
           if key[0] == "#" or key[2] in ("family", *bench.families)}
    if names:
        old = {key: line for key, line in old.items() if key in new or key[1] in names}
    keys = [key for key in [*old, *(key for key in new if key not in old)]
            if old.get(key) != new.get(key)]
    if not keys:
        print(f"{path.name}: {len(new)} lines are as measured, {versions}")
        return 0
    print(f"{path.name} differs in {len(keys)} lines. If that is meant: tools/gcn_probe.py --write")
    for key in keys[:DIFFERENCES_SHOWN]:
        print(f"  recorded: {old.get(key, 'nothing')}\n  measured: {new.get(key, 'nothing')}")
    return 1


def keyed(line):
    """(what the line is about, line)"""
    return line if line.startswith("#") else tuple(line.split(",")[:3]), line


def write(bench, results):
    versions = bench.versions()
    path = recorded_path(versions, results)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(document(versions, all_rows(bench)))
    print(f"wrote {path}")
    return 0


def differences(mine, other):
    """{column: by how much two shaders differ in it}; "code" is 1 where instructions differ."""
    a, b = mine.numbers(), other.numbers()
    code = int(mine.code != other.code or mine.statistics["Hash"] != other.statistics["Hash"])
    found = dict({column: a[column] - b[column] for column in a}, code=code)
    return {column: difference for column, difference in found.items() if difference}


def check_features(bench, variants):
    """0 when every variant is what comes of headers without the features that it lacks.

    The machine code of the standard material and of those with one feature has to be the same to
    the bit, and with a mask that is a constant of the text any; see LEEWAY for the rest."""
    kinds = ["lit", "lit_env"]
    modules = [gcn_shaders.lit_module(kind, variants) for kind in kinds]
    modules += [gcn_shaders.lit_module_without(kind, variant, bench.root)
                for kind in kinds for variant in variants]
    modules += [gcn_shaders.lit_module_constant("lit", variant) for variant in variants[:2]]
    compiled, counts = bench.compile(modules), {"identical": 0, "close": 0, "differ": 0}
    pairs = [name for name in (c.shader.name for c in compiled)
             if name.endswith((":without", ":constant"))]
    for family, measured in bench.ask_all(compiled, with_code=True).items():
        for name in pairs:
            found = differences(measured[name.rsplit(":", 1)[0]], measured[name])
            if not found:
                counts["identical"] += 1
            elif "+" in name and name.endswith(":without") and all(
                    abs(found.get(column, 0)) <= most
                    for column, most in dict(LEEWAY, vgprs=VGPR_UNIT[family]).items()):
                counts["close"] += 1
            else:
                counts["differ"] += 1
                said = ", ".join(f"{column} {by:+}" for column, by in found.items())
                print(f"{family} {name}, with the code in place: {said}")
    print(f"{counts['identical']} pairs of shaders are the same to the bit, {counts['close']} of"
          f" several features are within {LEEWAY['instructions']} instructions, {counts['differ']}"
          f" differ")
    return 1 if counts["differ"] or not counts["identical"] else 0


def show(bench, name):
    kind, _, variant = name.partition(":")
    if kind in gcn_shaders.BODIES:
        compiled = bench.compile([gcn_shaders.lit_module(kind, [variant])])
    else:
        compiled = bench.compile(gcn_shaders.formula_modules(bench.root, [name]))
    for family in bench.families:
        for measured in bench.ask(compiled, family, with_code=True)[0].values():
            print(f"{family}\n{measured.code or 'the driver cannot disassemble this'}")
    return 0 if compiled else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    action = parser.add_mutually_exclusive_group()
    action.add_argument("--check", action="store_true")
    action.add_argument("--write", action="store_true")
    action.add_argument("--features", action="store_true")
    action.add_argument("--show", metavar="SHADER")
    parser.add_argument("--family", action="append", choices=FAMILIES,
                        help="default: all")
    parser.add_argument("--include", type=pathlib.Path, default=hdrp_api.ROOT,
                        help="folder of the headers")
    parser.add_argument("--results", type=pathlib.Path, default=RESULTS,
                        help="folder of the recorded numbers")
    options = parser.parse_args()
    try:
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(folder, options.include, options.family)
            if options.check:
                return check(bench, options.results, options.names)
            if options.write:
                bench.families = FAMILIES
                return write(bench, options.results)
            if options.features:
                return check_features(bench, options.names or gcn_shaders.VARIANTS
                                      + ["subsurface"])
            if options.show:
                return show(bench, options.show)
            print(bench.versions())
            print_report(all_rows(bench, options.names))
            return 0
    except Skip as reason:
        print(f"skipped: {reason}")
        return SKIPPED


if __name__ == "__main__":
    sys.exit(main())
