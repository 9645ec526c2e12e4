#!/usr/bin/env python3
"""Writes docs/tradeoffs.md from recorded measurements: tradeoffs.py [--check].

Nothing is measured here. Errors come from tests/accuracy/recorded.csv, half precision from half.csv
beside it, costs on a CPU and on AMD GPUs from bench/results; each of those files is written by the
command that the document names, and has a test or a benchmark behind it. --check compares the text
with what is committed. tools/tradeoffs_charts.py draws the same numbers.

Which functions are alternatives to each other is said in tools/tradeoffs_topics.csv, and what to
think of them in TOPICS below. Where two CPUs have results, the one that sorts first is shown; where
none has those of bench_cull, the page has no section on light culling. What bench_gpu measured is
shown of every device that has results.
"""
import collections
import csv
import pathlib
import re
import sys
from dataclasses import dataclass

import hdrp_api

ROOT = hdrp_api.ROOT
DOCUMENT = ROOT / "docs/tradeoffs.md"
RESULTS = ROOT / "bench/results"
GPU = "vega10"  # the family shown where there is room for one
FAMILIES = ("bonaire", "vega10", "gfx1100")

# topic -> title and what a reader should know before choosing. Numbers belong into the tables.
TOPICS = {
    "normal codec 12 bits": (
        "Normals in 24 bits", "For a GBuffer. Rounding is what a shader can afford; the search looks "
        "at four neighbours and suits baking. Rounded SNORM and UNORM are equally good but for the "
        "axes, which SNORM holds exactly."),
    "normal codec 8 bits": (
        "Normals in 16 bits", "Shows banding in reflections; good for diffuse probes and small "
        "meshes. The search is worth most here."),
    "normal codec 16 bits": (
        "Normals in 32 bits", "Vertex data: finer than floats need, cheaper than three of them."),
    "tangent angle 11 bits": (
        "Tangents as an angle", "Even steps fill the range, at the cost of an arc tangent of the C "
                              "library; the code of the HDRP talk leaves some unused."),
    "acos": ("Arc cosine", "On a CPU take the fast one for angles of lobes and lights and the exact "
             "one where an angle is compared or unwrapped; the built-in is the C library's, in no "
             "loop. A GPU's own is as cheap as the fast one, but Vulkan promises little of it."),
    "atan2": ("Arc tangent of two", "The same choice as for the arc cosine; on AMD the built-in is the "
              "dearest of the three."),
    "exp2": ("Power of two", "The fast one vectorises where the C library has no vector form. On a "
             "GPU the built-in is one instruction."),
    "log2": ("Logarithm to base two", "The same choice as for the power of two."),
    "pow": ("Power", "The error of the fast one grows with the exponent of the result; for colours "
            "it is far smaller than its worst."),
    "sine and cosine": ("Sine and cosine", "The fast one is for points on discs and rings. Both are "
                        "better than what Vulkan promises of a device's own."),
    "1/sqrt": ("Inverse square root", "The fast one is made of integer operations and products alone."),
    "sRGB encoding": ("sRGB from linear", "Both give every 8-bit code right; the fast one is made of "
                      "square roots, which vectorise, where the other asks the C library for a power."),
    "sRGB decoding": ("Linear from sRGB", "The same choice: a polynomial, or a power."),
    "colour temperature": ("Colour temperature", "The published fit is against another observer and "
                           "has a step near 6570 K."),
    "small floats": ("Small floats", "All round to nearest. Truncation, which engines use, darkens "
                     "by half a step on average and turns greys yellow."),
    "Fresnel": ("Fresnel reflectance of dielectrics", "Schlick needs no square root and is what "
                "artists' F0 is made for; the exact one knows the index of refraction."),
    "coat F0": ("F0 below a clear coat", "The exact form costs one root and one division."),
    "FGD": ("Directional albedo of GGX", "The fit needs no texture. The table is nearer on average, and "
            "worse only at grazing views of smooth surfaces, which one texel has to hold. The "
            "quadrature is how tables are made."),
    "iridescence": ("Thin-film iridescence", "The fast one is the shape of the talk's, without its "
                    "defects; the recommended one follows the spectrum; the exact one sums it."),
    "GGX visibility": ("GGX visibility", "The fast one mixes two limits instead of taking roots: good "
                       "for previews and for lights that do not graze."),
    "environment irradiance": ("Irradiance of a sky", "Nine coefficients blur a sun; the cube does "
                               "not."),
}

# What bench_cull writes.
CULL_WORDS = ("picture", "mix", "way")
CULL_NUMBERS = ("lights", "project_ms", "depth_ms", "build_ms", "total_ms", "us_per_added_light",
                "ns_per_pair", "pairs", "pairs_over_exact", "visits_over_true", "two_jobs_speedup")
CULL_PICTURE, CULL_LIGHTS = "1280x720", "1000"
CULL_MIXES = ("points", "half", "spots")
# What we would take of the ways to cull -> for what.
CULL_TAKE = {
    "grid 17x9x24": "any surface, fog and particles; no depth needed",
    "clusters 32x32x64": "the same with fewer lights a pixel, where depth is at hand",
    "tiles 16x16, blocks": "opaque surfaces whose lights are dear: next to none in vain",
}
# Those whose times over the number of lights are shown.
CULL_MAIN = ("grid 17x9x24", "grid 17x9x24, fast", "grid 17x9x24, naive", "clusters 32x32x64",
             "tiles 16x16, no pixels", "tiles 16x16", "tiles 16x16, blocks")

# What bench_gpu writes.
DEVICE_COLUMNS = ("height", "lights", "way", "median_ms", "least_ms")
PLAIN_VARIANT = "deferred:punctual"  # the one that others are compared with
# Lagarde and Golubev 2018, "Tile / Cluster Performance" and "Classification Performance": ms on a
# PlayStation 4 at 1920x1080 with 10, 50, 100 and 500 punctual lights.
TALK_LIGHTS = ("10", "50", "100", "500")
TALK_TIMES = (
    ("lists in total", "0.956", "1.007", "1.096", "2.647"),
    ("screen bounds", "0.167", "0.170", "0.171", "0.170"),
    ("big tiles", "0.026", "0.050", "0.092", "0.391"),
    ("lists of tiles", "0.360", "0.370", "0.388", "0.702"),
    ("lists of clusters", "0.403", "0.417", "0.445", "1.384"),
    ("deferred lighting of a simple material, one shader", "0.665", "1.033", "0.972", "2.575"),
    ("the same by variants", "0.468", "0.669", "0.555", "1.228"))


def rows(path):
    """The rows of a CSV file without its remarks; none when there is no such file."""
    if not path or not path.exists():
        return []
    lines = [line for line in path.read_text().split("\n") if line and not line.startswith("#")]
    return list(csv.DictReader(lines))


def remarks(path):
    """The remarks at the top of a CSV file."""
    if not path or not path.exists():
        return []
    return [line[1:].strip() for line in path.read_text().split("\n") if line.startswith("#")]


def first_result(pattern):
    return next(iter(sorted(RESULTS.glob(pattern))), None)


def cull_row_name(row):
    return f"{row['picture']}, {row['mix']}, {row['lights']} lights, {row['way']}"


def cull_at(found, mix, way, lights=CULL_LIGHTS):
    """The row of a way in the picture that is shown, or None."""
    return next((row for row in found if (row["picture"], row["mix"], row["way"], row["lights"]) ==
                 (CULL_PICTURE, mix, way, lights)), None)


def cull_fault(path, found):
    """What is wrong with results of bench_cull, or None. A cell may be empty: not measured."""
    columns = CULL_WORDS + CULL_NUMBERS
    if not remarks(path):
        return "does not begin with a remark that names the machine, as bench/run.py writes"
    if not found:
        return "has no rows"
    for name in (*columns, *filter(None, found[0])):
        if name not in found[0]:
            return f"has no column {name}"
        if name not in columns:
            return f"has an unknown column {name}"
    for row in found:
        if None in row or None in row.values():
            return f"{row['picture']}, {row['mix']}: a row with more or fewer cells than columns"
        for name in CULL_NUMBERS:
            number = r"\d+" if name == "lights" else r"(\d+(\.\d+)?(e[+-]?\d+)?)?"
            if not re.fullmatch(number, row[name]):
                return f"{cull_row_name(row)}: {name} is no number but {row[name]!r}"
    for mix in CULL_MIXES:
        for way in (*CULL_MAIN, *CULL_TAKE):
            row = cull_at(found, mix, way)
            if not row or not (row["build_ms"] and row["total_ms"] and row["visits_over_true"]):
                return ("has no times or no visits of "
                        f"{CULL_PICTURE}, {mix}, {CULL_LIGHTS} lights, {way}")
    return None


def cull_rows(path):
    """The results of bench_cull; ends the program where they are not what it writes."""
    found = rows(path)
    fault = path and cull_fault(path, found)
    if fault:
        sys.exit(f"tradeoffs: {path.name}: {fault}")
    return found


def device_rows(path):
    """The results of bench_gpu; ends the program where they are not what it writes."""
    found = rows(path)
    if not remarks(path) or not remarks(path)[0].startswith("device: "):
        sys.exit(f"tradeoffs: {path.name}: does not begin with a remark that names the device")
    for row in found:
        if tuple(row) != DEVICE_COLUMNS or None in row.values():
            sys.exit(f"tradeoffs: {path.name}: the columns are not {', '.join(DEVICE_COLUMNS)}")
        for name in set(DEVICE_COLUMNS) - {"way"}:
            if not re.fullmatch(r"\d+(\.\d+)?", row[name]):
                sys.exit(f"tradeoffs: {path.name}: {row['way']}: {name} is no number but "
                         f"{row[name]!r}")
    return found


@dataclass
class Variant:
    """What is known of one function. Strings are shown as they are recorded."""
    topic: str
    label: str
    function: str
    take: bool
    unit: str
    claim: str
    worst: str
    mean: str
    ns: str
    instructions: str
    vgprs: str
    half: str


class Data:
    def __init__(self):
        self.cpu_file = first_result("cpu_*.csv")
        self.gcn_file = first_result("gcn_mesa-*.csv")
        self.passes_file = first_result("gcn_passes_*.csv")
        self.devices = {path: device_rows(path) for path in sorted(RESULTS.glob("gpu_*.csv"))}
        self.features_cpu_file = first_result("features_cpu_*.csv")
        self.features_render_file = first_result("features_render_*.csv")
        self.published = rows(ROOT / "tests/published/recorded.csv")
        self.prefilters = rows(first_result("prefilters_cpu_*.csv"))
        self.cull_file = first_result("cull_cpu_*.csv")
        self.cull = cull_rows(self.cull_file)
        self.oit = rows(ROOT / "tests/oit/recorded.csv")
        self.oit_times_file = first_result("oit_*.csv")
        self.oit_times = rows(self.oit_times_file)
        self.oit_pictures = rows(ROOT / "tests/oit/pictures.csv")
        self.oit_steps = rows(ROOT / "tests/oit/steps.csv")
        self.recorded_file = ROOT / "tests/accuracy/recorded.csv"
        self.recorded = {row["id"]: row for row in rows(self.recorded_file)}
        self.half = {row["id"]: row for row in rows(ROOT / "tests/accuracy/half.csv")}
        self.cpu = rows(self.cpu_file)
        self.gcn = rows(self.gcn_file)
        self.passes = {(row["name"], row["family"]): row for row in rows(self.passes_file)}
        self.features_cpu = rows(self.features_cpu_file)
        self.features_render = rows(self.features_render_file)
        self.variants = [self.variant(**row) for row in rows(ROOT / "tools/tradeoffs_topics.csv")]

    def worst(self, accuracy_id):
        """(max, mean) of the worst build family, as recorded."""
        row = self.recorded.get(accuracy_id, {})

        def largest(suffix):
            return max((value for key, value in row.items() if key.endswith(suffix) and value),
                       key=float, default="")
        return largest("_max"), largest("_mean")

    def ns(self, function, build="gcc", form="vector"):
        return next((row["ns"] for row in self.cpu if (row["name"], row["build"], row["form"]) ==
                     (function, build, form)), "")

    def gpu(self, name, column, family=GPU, kind="formula"):
        return next((row[column] for row in self.gcn if (row["kind"], row["name"], row["family"])
                     == (kind, name, family)), "")

    def variant(self, topic, function, accuracy_id, label, take):
        row = self.recorded.get(accuracy_id, {})
        worst, mean = self.worst(accuracy_id)
        return Variant(topic, label, function, take == "yes", row.get("unit", ""), row.get("claim", ""), worst,
                       mean, self.ns(function), self.gpu(function, "instructions"),
                       self.gpu(function, "vgprs"), self.half.get(accuracy_id, {}).get("usable", ""))

    def topics(self):
        """topic -> its variants, the worst first, in the order of the file."""
        result = {}
        for variant in self.variants:
            result.setdefault(variant.topic, []).append(variant)
        for variants in result.values():
            variants.sort(key=lambda v: -float(v.worst or "inf"))
        return result


def table(heads, lines, align):
    """A Markdown table; align has l or r for each column."""
    rule = ["---:" if a == "r" else "---" for a in align]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [heads, rule, *lines]) + "\n"


def shown(text, digits=3):
    """A recorded number for people, a dash where there is none."""
    return f"{float(text):.{digits}g}" if text else "–"


def code(name):
    return f"`{name}`"


def minute(data):
    """One line for each topic: what to take, and what the alternatives buy."""
    lines = []
    for topic, variants in data.topics().items():
        def named(variant):
            cost = f"; {variant.ns} ns" if variant.ns else ""
            return (f"{variant.label}: {code(variant.function)} ({shown(variant.worst)}, mean "
                    f"{shown(variant.mean)}{cost})")
        best = next(v for v in variants if v.take)
        others = [v for v in variants if v is not best]
        lines.append([f"[{TOPICS[topic][0]}](#{anchor(TOPICS[topic][0])})", named(best),
                      "<br>".join(map(named, others)), variants[0].unit])
    return table(["for", "take (worst error, mean; time)", "or", "error in"], lines, "llll")


def slug(topic):
    """A topic as part of a file name."""
    return re.sub(r"\W+", "_", topic.lower())


def anchor(title):
    return re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-")


def topic_section(topic, variants):
    title, advice = TOPICS[topic]
    unit = variants[0].unit
    heads = ["variant", "function", f"worst, {unit}", "mean", "ns", "instructions", "VGPRs", "half"]
    lines = [[v.label, code(v.function), shown(v.worst), shown(v.mean), v.ns or "–",
              v.instructions or "–", v.vgprs or "–", v.half or "–"] for v in variants]
    return (f"### {title}\n\n{advice}\n\n![{title}: worst error against cost]"
            f"(images/tradeoffs_{slug(topic)}.svg)\n\n" + table(heads, lines, "llrrrrrl"))


def gpu_set(name):
    """The name of a feature set in the probe: standard is not said of what has more."""
    every = "coat+anisotropy+iridescence+transmission+refraction"
    return every if name == "all" else name.replace("standard+", "")


def features_table(data):
    """Lit by feature set: what one more light costs a CPU and a GPU, and the registers of both."""
    heads = ["feature set", "ns a pixel", "ns a light", f"{GPU} instructions a pixel"]
    for family in FAMILIES:
        heads += [f"{family} instructions a light", "VGPRs", "waves"]
    lines = [[row["set"], row["view_ns"], row["ns"],
              data.gpu(gpu_set(row["set"]), "instructions", GPU, "lit") or "–",
              *(cell for family in FAMILIES for cell in (
                  data.gpu(gpu_set(row["set"]), "instructions", family, "lit_light") or "–",
                  data.gpu(gpu_set(row["set"]), "vgprs", family, "lit") or "–",
                  data.gpu(gpu_set(row["set"]), "waves_per_simd", family, "lit") or "–"))]
             for row in data.features_cpu]
    return table(heads, lines, "l" + "r" * (len(heads) - 1))


def pictures_table(data):
    heads = ["scene", "quality", "feature", "", "ms", "error"]
    lines = [[row["scene"], row["quality"], row["feature"],
              "on" if row["on"] == "1" else "off", row["milliseconds"],
              shown(row["error"])] for row in data.features_render]
    return table(heads, lines, "llllrr")


def every_formula(data):
    """All claims, by header."""
    text, claims = [], collections.defaultdict(list)
    for claim in hdrp_api.claims():
        claims[claim.function].append(claim)
    for path in hdrp_api.headers():
        lines = []
        for function in hdrp_api.functions(path):
            for claim in claims[function.name]:
                worst, mean = data.worst(claim.id)
                lines.append([code(function.name), f"{claim.bound:g} {claim.unit}", shown(worst),
                              shown(mean), data.ns(function.name) or "–",
                              *(data.gpu(function.name, "instructions", family) or "–"
                                for family in FAMILIES),
                              data.gpu(function.name, "vgprs") or "–",
                              data.half.get(claim.id, {}).get("usable") or "–"])
        if lines:
            heads = ["function", "claim", "worst", "mean", "ns", *FAMILIES, "VGPRs", "half"]
            text.append(f"### {path.name}\n\n" + table(heads, lines, "llrrrrrrrl"))
    return "\n".join(text)


def peers(data):
    lines = [[code(row["name"]), row["build"], row["form"], row["ns"], row["peer"], row["peer_ns"],
              row["ratio"]] for row in data.cpu if row["peer"]]
    return table(["function", "compiler", "form", "ns", "peer", "its ns", "times faster"], lines,
                 "lllrlrr")


def published(data):
    lines = [[row["topic"], code(row["form"]) if row["form"].startswith("hdrp_") else row["form"],
              row["quantity"], f"{shown(row['max'])} {row['unit']}", shown(row["mean"]),
              shown(row["bias"])] for row in data.published]
    return table(["topic", "form", "quantity", "worst", "mean", "bias"], lines, "lllrrr")


def skies(data):
    lines = [[row["quantity"], row["sky"],
              code(row["method"]) if row["method"].startswith("hdrp_") else row["method"],
              row["setting"], shown(row["max"]), shown(row["mean"]), row["milliseconds"]]
             for row in data.prefilters]
    return table(["quantity", "sky", "method", "setting", "worst", "mean", "ms"], lines, "llllrrr")


def cull_choice(data):
    """What to take, for whom, at which price."""
    heads = ["for", "take"]
    for mix in ("points", "spots"):
        heads += [f"{mix}: ms in total", "visited / true"]
    lines = []
    for way, purpose in CULL_TAKE.items():
        found = [cull_at(data.cull, mix, way) for mix in ("points", "spots")]
        lines.append([purpose, code(way), *(shown(row[column]) for row in found
                                            for column in ("total_ms", "visits_over_true"))])
    return table(heads, lines, "llrrrr")


def cull_ways(data):
    """Every way that was measured, for each mix of lights."""
    heads = ["lights", "way", "build, ms", "in total, ms", "pairs / exact", "visited / true",
             "two jobs"]
    lines = [[row["mix"], code(row["way"]),
              *(shown(row[column]) for column in ("build_ms", "total_ms", "pairs_over_exact",
                                                  "visits_over_true", "two_jobs_speedup"))]
             for row in data.cull
             if (row["picture"], row["lights"]) == (CULL_PICTURE, CULL_LIGHTS)]
    return table(heads, lines, "llrrrrr")


def cull_times(data):
    """Milliseconds over the number of lights."""
    counts = sorted({row["lights"] for row in data.cull if row["picture"] == CULL_PICTURE},
                    key=int)
    lines = []
    for mix in ("points", "spots"):
        for way in CULL_MAIN:
            found = [cull_at(data.cull, mix, way, count) for count in counts]
            lines.append([mix, code(way), *(shown(row["total_ms"] if row else "")
                                            for row in found)])
    return table(["lights", "way", *counts], lines, "ll" + "r" * len(counts))


def culling(data):
    """The section on light culling; nothing where it has not been measured."""
    if not data.cull:
        return ""
    machine = remarks(data.cull_file)[0].split(": ")[0]
    return CULLING.format(lights=CULL_LIGHTS, picture=CULL_PICTURE, machine=machine,
                          choice=cull_choice(data), ways=cull_ways(data), times=cull_times(data))


def pass_cells(data, name):
    """All of a pass on the first family, registers and waves on the others."""
    first, *others = (data.passes[name, family] for family in FAMILIES)
    return [*(first[column] for column in ("instructions", "vgprs", "sgprs", "lds_bytes",
                                           "waves_per_simd", "spilled_registers")),
            *(row[column] for row in others for column in ("vgprs", "waves_per_simd"))]


PASS_HEADS = [f"{FAMILIES[0]} instructions", "VGPRs", "SGPRs", "LDS, bytes", "waves", "spilled",
              *(head for family in FAMILIES[1:] for head in (f"{family} VGPRs", "waves"))]


def pass_names(data):
    return list(dict.fromkeys(name for name, _ in data.passes))


def passes_table(data):
    lines = [[code(name), *pass_cells(data, name)] for name in pass_names(data) if ":" not in name]
    return table(["pass", *PASS_HEADS], lines, "l" + "r" * len(PASS_HEADS))


def added(data, name, column):
    """What a variant has more than the plain one, a blank where it is not that and more."""
    if not name.startswith(f"{PLAIN_VARIANT}+"):
        return ""
    own, plain = (int(data.passes[which, FAMILIES[0]][column]) for which in (name, PLAIN_VARIANT))
    return f"{own - plain:+d}"


def variants_table(data):
    heads = ["variant", "adds instructions", "adds VGPRs", *PASS_HEADS]
    lines = [[code(name.split(":")[1]), added(data, name, "instructions"),
              added(data, name, "vgprs"), *pass_cells(data, name)]
             for name in pass_names(data) if ":" in name]
    return table(heads, lines, "l" + "r" * (len(heads) - 1))


def device_tables(data):
    """Milliseconds over the number of lights, for each device with results."""
    text = []
    for path, found in data.devices.items():
        counts = sorted({row["lights"] for row in found}, key=int)
        times = {(row["height"], row["way"], row["lights"]): row["median_ms"] for row in found}
        lines = [[height, code(way), *(shown(times.get((height, way, count), ""))
                                       for count in counts)]
                 for height, way in dict.fromkeys((row["height"], row["way"]) for row in found)]
        text.append(f"{remarks(path)[0][len('device: '):]}:\n\n"
                    + table(["rows of pixels", "way", *counts], lines, "rl" + "r" * len(counts)))
    return "\n".join([DEVICES, *text, ""]) if text else ""


def gpu_passes(data):
    """The section on passes; nothing where they have not been measured."""
    if not data.passes:
        return ""
    talk = table(["ms", *TALK_LIGHTS], [list(line) for line in TALK_TIMES],
                 "l" + "r" * len(TALK_LIGHTS))
    return PASSES.format(passes=passes_table(data), variants=variants_table(data),
                         devices=device_tables(data), talk=talk)


def oit_lines(data, cases, precision="native"):
    """The error of each mode on some cases of random pixels."""
    found = {(row["mode"], row["case"]): row for row in data.oit if row["precision"] == precision}
    lines = []
    for mode in dict.fromkeys(row["mode"] for row in data.oit):
        some = found[mode, cases[0]]
        lines.append([mode, some["passes"], some["bytes_per_pixel"],
                      *(shown(found[mode, case]["rms"]) for case in cases)])
    return lines


def transparency(data):
    """The section on transparency without sorting; nothing where it has not been measured."""
    if not data.oit:
        return ""
    heads = ["mode", "passes", "bytes per pixel"]
    tables = {name: table(heads + titles, oit_lines(data, cases, precision),
                          "lrr" + "r" * len(cases))
              for name, (titles, cases, precision) in OIT_TABLES.items()}
    leaks = {row["mode"]: float(row["largest"]) for row in data.oit
             if row["case"] == "front_99" and row["precision"] == "native"}
    least = max(leak for mode, leak in leaks.items() if mode in OIT_SEVERAL_PASSES)
    return TRANSPARENCY.format(leak=f"{leaks['recommended']:.2g}", least_leak=f"{least:.1g}",
                               steps=oit_steps_table(data), pictures=oit_pictures(data),
                               costs=oit_costs(data), times=oit_times(data), gpu=GPU, **tables)


def oit_formula_cells(data, names):
    """Instructions of all of these formulas, and the registers of the one that has most."""
    if not names:
        return ["", ""]
    instructions, vgprs = ([int(data.gpu(f"hdrp_oit_{name}", column)) for name in names]
                           for column in ("instructions", "vgprs"))
    return [str(sum(instructions)), str(max(vgprs))]


def oit_costs(data):
    """What fragments of each mode take, and the composite."""
    lines = []
    for mode, (absorbing, color, composite) in OIT_COSTS.items():
        passed = data.passes.get((composite, GPU), {})
        lines.append([mode, *oit_formula_cells(data, absorbing), *oit_formula_cells(data, color),
                      passed.get("instructions", ""), passed.get("vgprs", "")])
    heads = ["mode", "absorbing: instructions", "VGPRs", "colour: instructions", "VGPRs",
             "composite: instructions", "VGPRs"]
    return table(heads, lines, "l" + "r" * 6)


def oit_times(data):
    """Milliseconds of what is drawn in each mode; nothing where they have not been measured."""
    if not data.oit_times:
        return ""
    lines = []
    for mode in dict.fromkeys(row["mode"] for row in data.oit_times):
        ms = {kind: sum(float(row["ms"]) for row in data.oit_times
                        if row["mode"] == mode and row["pass"].startswith(kind))
              for kind in ("transparent surfaces", "transparent:", "half resolution",
                           "composition")}
        lines.append([mode, *(f"{value:.3g}" for value in (*ms.values(), sum(ms.values())))])
    heads = ["mode", "in order", "unsorted", "half resolution", "composition", "together"]
    device = remarks(data.oit_times_file)[0][len("device: "):]
    return OIT_TIMES.format(device=device, times=table(heads, lines, "l" + "r" * 5))


OIT_TIMES = """Milliseconds of all passes over what is transparent in the built-in scene, light loops
included, for a sample of every pixel, on {device}. What transmits light stays in order in every mode;
sorted is by triangles, smoke at full resolution too:

{times}
"""


def oit_steps_table(data):
    """The largest step between two frames, of all ways, for each sequence."""
    found = {(row["way"], row["sequence"]): row for row in data.oit_steps}
    sequences = list(dict.fromkeys(row["sequence"] for row in data.oit_steps))
    lines = [[way.replace("_cards", " by card").replace("_pixels", " by pixel"),
              *(shown(found[way, sequence][column]) for sequence in sequences
                for column in ("picture_step", "pixel_step", "rms"))]
             for way in dict.fromkeys(row["way"] for row in data.oit_steps)]
    heads = [f"{sequence}: {column}" for sequence in sequences
             for column in ("picture", "pixel", "RMSE")]
    return table(["mode", *heads], lines, "l" + "r" * len(heads))


def percent(text):
    """A recorded share for people; less than a thousandth of a percent is rounding."""
    share = 100.0 * float(text)
    return f"{share:.2g}" if share >= 1e-3 else "0"


def oit_pictures(data):
    """The error of each mode of the renderer on whole scenes."""
    found = {(row["mode"], row["scene"], row["resolution"]): row for row in data.oit_pictures}
    lines = []
    for mode in dict.fromkeys(row["mode"] for row in data.oit_pictures):
        some = (found[mode, scene, resolution] for _, scene, resolution in OIT_SCENES)
        lines.append([f"`--oit {mode}`", *(f"{percent(row['relative_rmse'])} / "
                                           f"{percent(row['relative_worst'])}" for row in some)])
    return table(["", *(title for title, _, _ in OIT_SCENES)], lines, "l" + "r" * len(OIT_SCENES))


OIT_SEVERAL_PASSES = ("front", "wavelet", "moments_6", "moments_4")

# Of each mode: formulas that a fragment calls before the pass of colour and in it, hdrp_oit_...,
# and the pass that composes.
OIT_COSTS = {
    "recommended": ([], ["export"], "oit_composite"),
    "front": (["range_export"], ["front_export"], "oit_composite/front"),
    "wavelet": (["range_export", "place_of", "wavelet_insert"],
                ["place_of", "wavelet_transmittance", "layer_export"], "oit_composite/through"),
    "moments_6, moments_4": (["range_export", "place_of", "moments_insert"],
                             ["place_of", "moments_transmittance", "layer_export"],
                             "oit_composite/through"),
    "eq7": ([], ["weight_eq7", "weighted_export"], "oit_composite"),
    "talk": ([], ["talk_export"], "oit_composite/talk"),
}


# Heads of columns, scene and resolution of what is soft.
OIT_SCENES = [("transparency", "transparency", "full"),
              ("the same, smoke at half resolution", "transparency", "half"),
              ("AlphaBlendModeTest", "AlphaBlendModeTest", "full"),
              ("glass-table", "glass-table", "full"), ("love, four times", "love", "full")]


# Of each table: heads of columns, cases, and the precision of targets.
OIT_TABLES = {
    "opacities": (["0.05 to 0.3", "0.05 to 0.95", "0.8 to 0.99", "only adds", "half of it adds",
                   "behind 0.99"],
                  ["low", "mixed", "high", "additive", "half_emissive", "front_99"], "native"),
    "depths": ([f"{a} {d} m" for d in ("1 to 10", "0.1 to 1000") for a in ("low", "mixed", "high")],
               [f"{a}_{d}" for d in ("1_10", "0.1_1000") for a in ("low", "mixed", "high")],
               "native"),
    "counts": (["low", "mixed", "high", "-10 stops", "-5 stops", "+5 stops", "+10 stops"],
               ["low_32", "mixed_32", "high_32", "stops_-10", "stops_-5", "stops_5", "stops_10"],
               "native"),
    "shining": (["0.01 to 0.3", "0.05 to 0.95", "0.8 to 0.99", "behind a pane"],
                ["shining_low", "shining", "shining_high", "pane"], "native"),
    "compact": (["0.05 to 0.3", "0.05 to 0.95", "0.8 to 0.99", "only adds", "half of it adds"],
                ["low", "mixed", "high", "additive", "half_emissive"], "compact"),
}

TRANSPARENCY = """## Transparency without sorting

The modes of `hdrp_oit.h` against sorting: root mean square errors of linear RGB in [0,1] on random
pixels of tests/oit, 2 to 12 layers between 1 and 200 m in no order, blended as hardware rounds.
Passes are those over transparent surfaces. By opacity of the layers; where all of them or half of
them cover nothing and emit their colour times such an opacity; and behind a nearest layer of 0.99:

{opacities}
- `recommended` is what one pass can do with two RGBA16F targets. Its weight was fitted on depths of
  1 to 200 m, thin layers among dense ones included (tools/fit_oit.py). What a layer of 0.99 hides is
  {leak} off in the worst pixel; in modes of several passes at most {least_leak}.
- `front` keeps the nearest layer apart, whose depth a pass before it wrote: that of a tenth or more,
  so that the soft edge of a sprite is no front. The other modes of several passes do so, too.
- `wavelet` and `moments` know how much of each layer is seen, and so of emission. They draw three
  times. Moments need 32-bit floats; wavelets add half floats.
- `eq7` to `2015` are published weights (McGuire and Bavoil 2013, McGuire 2015), `talk_weight` is that
  of Kircher 2018, all of them divided by sums of weighted alpha and with emission in a target of its
  own; `talk` is the latter's form as shown.

Other depths, with opacities as above:

{depths}
Up to 32 layers; and colours 2^-10 to 2^10 times as bright, relative to that:

{counts}
Where half of the layers emit up to a colour beside what they cover with, by opacity; and layers of
0.05 to 0.95 between 50 and 60 m that do not, behind one at 1 m:

{shining}
- One layer is exact in every mode but `talk`, whatever it covers and emits: what is divided by its
  own coverage, or seen through it, is so without error, but for published weights below an opacity
  of 2^-9. In `recommended` a share of emission that grows with opacity goes with the colour, the
  rest with what only adds.
- A pane far before a group leaves all of it to two of the 16 intervals of `wavelet`. Moments have
  no intervals, and few digits for what is close together.

Light in R11G11B10F and coverage in R8 where the first table has RGBA16F for both. What only adds
is then rounded at each layer:

{compact}
What a fragment takes of AMD's {gpu} in the passes before that of colour, all of them, and in that
one, beside its shading: formulas as compute shaders, instructions of all of them and the registers
of the largest. And `hdrp_gpu_vk_oit_composite`, which merges two resolutions, for a pixel:

{costs}
{times}In motion: the largest step between two frames that follow each other, root mean square over the
picture and of any pixel, and the error over all frames, against sorting each pixel. Two panes go
through each other (*crossing*), the camera goes half a radian around cards that cut each other
(*orbit*) or through smoke (*dolly*), 240 frames each:

{steps}
What knows no order cannot jump where it changes: where layers change places, one pass is smoother
than either way of sorting. `front` jumps where another layer becomes the nearest, `wavelet` and
`moments` as little as sorting each pixel, which is what they come close to; sorting whole cards jumps
over the whole picture. Where layers come near the camera and fade, weights that grow fast there
(`eq7`, `eq8`, `eq10`) take the picture with them.

Whole pictures of [hdrp_render](../examples/render/README.md), 240 x 160, against `--oit sorted`, over
the pixels that blended surfaces touch: relative RMSE of luminance and, behind the slash, the worst
pixel, in percent. `transparency` is the built-in scene of smoke, panes, sparks and holograms; of the
others nothing transmits (`--features=-refraction`), and love stands behind itself:

{pictures}
- `mcguire` is `eq7`, `volition` is `talk`. Glass that is black and of one opacity, as that of
  glass-table, needs no order.
- What a glTF material emits is in proportion to its opacity, and a part of its colour; only what
  hides nothing goes into the sums of emission.
- Half the resolution costs 1 % at this size, and less in larger pictures. A quarter of it lies along
  silhouettes, over which smoke leaks; the rest is within the smoke, whose billows and shadows blur.

![Sorted, recommended, wavelet and volition, from left to right and down](images/oit.png)

"""


def document(data):
    topics = "\n".join(topic_section(topic, variants)
                       for topic, variants in data.topics().items())
    return TEMPLATE.format(gpu=GPU, minute=minute(data), topics=topics, lit=features_table(data),
                           pictures=pictures_table(data), culling=culling(data),
                           gpu_passes=gpu_passes(data), transparency=transparency(data),
                           peers=peers(data), published=published(data), skies=skies(data),
                           formulas=every_formula(data),
                           remarks="\n".join(f"- {remark}" for path in (
                               data.recorded_file, data.cpu_file, data.gcn_file, data.passes_file,
                               data.features_cpu_file, data.features_render_file, data.cull_file)
                               for remark in remarks(path)))


CULLING = """## Light culling

Which lights reach which pixels, by `hdrp_cull.h`: {lights} lights in a street, {picture}. No way
misses a light. What a cheap one loses is time of pixels, which visit lights that are out of range.

{choice}
Times are medians on one core; the machine: {machine}.
Ways, scene and columns are those of [bench/README.md](../bench/README.md).

- Zero, the default, tests the volume of a light against that of each cell. A light may still
  reach the cell but not the pixel: small cells have less of that, and more entries.
- `HDRP_CULL_FAST` tests rectangles on the screen and depths only. Lists are built sooner and are
  longer, those of spots most, which fill little of their rectangle. For lights that are cheap to
  shade. The next three disregard it.
- `HDRP_CULL_PIXELS` keeps what reaches a pixel of the tile. It needs the depth buffer and one
  slice: for opaque surfaces.
- `HDRP_CULL_BLOCKS` notes in each entry which sixteenths of the tile the light reaches; pixels of
  the others skip it, by `hdrp_cull_entry_covers`.
- `HDRP_CULL_MASKS` notes it for each pixel: `hdrp_cull_mask_word`. An entry takes one bit
  for each pixel of its tile, 32 bytes at 16 x 16, and no light is visited in vain but for rounding.

![Lights visited over those in range, against milliseconds](images/tradeoffs_culling.svg)

*Pairs* are those of a cell and a light in its list, *exact* those where it reaches the cell, or one
of its pixels where they are asked; *visited* are lights that pixels visit, *true* those in range of
them. 1 is the least of both. *Two jobs* says how much faster two cores are, where one takes 2 ms or
more.

{ways}
Milliseconds in total over the number of lights; `naive`, for comparison, tests every light with
every cell:

{times}
"""

PASSES = """## Passes on the GPU

What the compute shaders in `hdrp_gpu_vk.h` take of an AMD GPU, as Mesa compiles them. *VGPRs* and
*SGPRs* are registers of a thread and of a wave, *LDS* is the local memory of a group, *waves* are
those that fit a SIMD at the same time, *spilled* are registers that went to memory. A test fails
when a number of bonaire moves, and when a pass takes more registers than it was made for.

{passes}
There is no second set of shaders with 16-bit arithmetic. `tools/gcn_passes.py --half` makes one of
the same words and compiles it: on vega10 and gfx1100, which have such instructions, every pass then
takes more of them (tone mapping a fifth, harmonics half as much again), for the conversions. Only
the composite of transparency and the copy of a cube fit the GPU more often, and both wait for memory.

Deferred lighting is one module and these are its variants, by specialisation. *punctual* is the
Standard material with points and spots, what follows a + is a feature more, and *adds* is what it
costs on bonaire: directional lights (*sun*), their resolved shadows (*mask*), the environment (*sky*),
shadows of lights in lists (*atlas*), lists in slices of depth, light below surfaces written apart
(*split*). A tile runs the first variant that has what it needs: it pays for what is in it.

{variants}
{devices}The talk times the same passes on a PlayStation 4, whose GPU is of bonaire's generation, at
1920x1080 in a scene of its own. It builds tiles and clusters each frame, where here a frame chooses.
Its scene and its device are others: how the numbers grow with the lights, and what variants
save, can be compared, milliseconds cannot. It gives no registers of these passes.

{talk}
"""

DEVICES = """Milliseconds of the building of lists over the number of lights, projection and depth included, in
the street of the section above, by timestamps of the device: medians.
"""

TEMPLATE = """# Trade-offs

<!-- Generated by tools/tradeoffs.py from recorded measurements; `make tradeoffs` measures again. -->

What each variant of a formula gets wrong, and what it costs. Errors are the worst and the mean over
the documented range, against an independent reference in double precision, for the worst of six
builds (gcc and clang, -O0 and -O3, with and without fused multiply-add, where that changes a bit); a
test fails when one of them moves in its third digit. The mean is over the inputs that the registry
tries, which favour the ends of ranges. *ns* is one call in a loop compiled by gcc, on one core; compilers turn such a loop into
vectors where the function calls nothing of the C library. *Instructions* are those of the formula in
a compute shader for AMD's {gpu}, without loads and stores; *VGPRs* are the registers of that shader. *Half* says whether the formula still serves when every operation is
rounded to 16 bits.

"The talk" is the one on the High Definition Render Pipeline (Lagarde and Golubev 2018, see [REFERENCES.md](REFERENCES.md)).

## In one minute

Where nothing is known of a user, the plain name is what we would take; for loops on a CPU the table
names a `_fast` one where it loses next to nothing. On a GPU the built-in functions are one or a few
instructions: the `_fast` ones are for CPUs.

{minute}
## Variants

{topics}
## What a feature costs

The Lit model by feature set, once per pixel (`hdrp_brdf_lit_view_make`, with what it takes to load a
material) and once per light (`hdrp_brdf_lit_eval`). A film is paid per pixel, a coat in both. A
feature that is off is not in the code: the instructions are those of a build that never had it, which
tests compare. At most 10 waves fit a SIMD of {gpu} and bonaire, 16 a SIMD of gfx1100, which the
driver counts in pairs.

{lit}
The same from the renderer: milliseconds of the lighting passes and the error of the picture against
the path-traced reference, with a feature on and off, in a scene that needs it and in one that does
not. Times of equal work differ by up to a fifth from run to run; errors do not.

![Image error against milliseconds](images/tradeoffs_render.svg)

{pictures}
{culling}{gpu_passes}{transparency}## Skies

GGX lobes and irradiance of a sky against brute force, relative to what is right, and one core's time
for a whole map.

{skies}
## Against published forms

The same inputs, the same reference.

{published}
## Against other libraries

The same work, in the same run, on the same pinned core.

{peers}
## Every claim

{formulas}
## Where the numbers come from

`make tradeoffs` measures anew and writes this page, all but the skies, which the build target
`prefilters_table` prints. Errors and instruction counts come out the same to the digit, and tests
fail when one moves; nanoseconds and milliseconds are records of one machine, the first by name in
`bench/results`.

{remarks}
"""


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__.split("\n")[0])
    text = document(Data())
    if not sys.argv[1:]:
        DOCUMENT.write_text(text)
    elif not DOCUMENT.exists() or DOCUMENT.read_text() != text:
        sys.exit("tradeoffs: docs/tradeoffs.md is not what the measurements say; run tools/tradeoffs.py")


if __name__ == "__main__":
    main()
