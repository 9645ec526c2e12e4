#!/usr/bin/env python3
"""Checks the house rules that a compiler cannot: api_check.py [--root DIR] [--write].

CONTRIBUTING.md states the rules; each check_* function below is one of them. --write brings the
generated function index of every header up to date first. Exit status 1 when a rule is broken.
"""
import argparse
import pathlib
import re
import statistics
import subprocess
import sys
import textwrap

import hdrp_api
import reserved_words
from hdrp_api import RangeError

COLUMNS = 100
FORMULA_LINES = 40
FORMULA_MEDIAN = 10
MEDIAN_NEEDS = 8  # a median of fewer functions says nothing
ALGORITHM_LINES = 80
HEADER_LINES = 2200
OPENING_LINES = 80

# Which headers a header may include; DESIGN section 2. A new header gets its line here.
DEPENDENCIES = {
    "math": "",
    "light": "math",
    "brdf_lobes": "math",
    "brdf": "math brdf_lobes",
    "oit": "math pack",
    "sss": "math",
    "env_image": "math",
    "env": "math env_image",
    "pack": "math brdf",
    "area": "math light",
    "cull_volume": "math light",
    "cull_grid": "math light cull_volume",
    "cull_tile": "math light cull_volume",
    "cull_variant": "math",
    "cull_blocker": "math light cull_volume",
    "cull": "math light cull_volume cull_blocker cull_grid cull_tile cull_variant",
    "vol": "math light cull",
    "shadow": "math light",
    "gpu_vk_core": "math",
    "gpu_vk_cull": "math light cull gpu_vk_core",
    "gpu_vk_env": "math brdf env gpu_vk_core",
    "gpu_vk_light": "math light brdf pack env cull cull_grid shadow gpu_vk_core gpu_vk_cull",
    "gpu_vk_oit": "math oit gpu_vk_core",
    "gpu_vk_shadow": "math light shadow pack cull_volume gpu_vk_core",
    "gpu_vk": "gpu_vk_core gpu_vk_cull gpu_vk_env gpu_vk_light gpu_vk_oit gpu_vk_shadow",
}
SYSTEM_HEADERS = {"<math.h>", "<stdint.h>", "<stddef.h>", "<string.h>", "<float.h>", "<limits.h>",
                  "<vulkan/vulkan.h>", "<vulkan/vulkan_core.h>"}
FORBIDDEN_CALLS = ("malloc calloc realloc free alloca printf fprintf puts abort exit assert "
                   "rand srand strtok getenv").split()

# A count of bytes (size_t) has no range that could be written down.
SCALARS = ("float", "double", "int", "unsigned", "hdrp_u32", "uint8_t", "uint16_t", "uint32_t",
           "uint64_t", "int32_t", "int64_t")
VECTORS = ("hdrp_v2", "hdrp_v3", "hdrp_v4", "hdrp_u32x4")
EXACT_BUILT_INS = {"floor", "fabs"}
CODEC = re.compile(r"_from_|encode|decode|_target|_code")
ABSOLUTE_PATH = re.compile(r"(?<![\w.~$)}/])/(?:home|work|root|Users|tmp|mnt|media)/\w|"
                           r"(?<!\w)[A-Z]:\\\\?\w")
FLOAT_LITERAL = re.compile(r"(?<![\w.])(?:\d+\.\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?|"
                           r"\d+[eE][+-]?\d+)(?P<suffix>[fFlL]?)(?!\w)")


class Tree:
    """Everything the checks look at, and the list of what they found."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.headers = [hdrp_api.header(p) for p in hdrp_api.headers(root)]
        self.macros = hdrp_api.macros(root)
        self.problems = []

    def report(self, place, line, message):
        self.problems.append((place, line, message))

    def functions(self):
        return [(h, f) for h in self.headers for f in h.functions()]

    def files(self):
        """Files of the tree that are or will be committed."""
        listing = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=self.root,
                                 capture_output=True, text=True, check=False)
        if listing.returncode == 0:
            return [self.root / name for name in listing.stdout.splitlines()
                    if (self.root / name).is_file()]
        return [p for p in self.root.rglob("*") if p.is_file() and "build" not in p.parts]


def code_lines(header, layers):
    """(line number, code without comments) of the lines that are in one of the layers."""
    for number, line in enumerate(header.code.split("\n"), 1):
        if header.layer_of(number) in layers:
            yield number, line


# ---- docstrings --------------------------------------------------------------------------------

def check_docstrings(tree):
    for header, function in tree.functions():
        if not function.is_public:
            continue
        if not function.doc:
            tree.report(header.name, function.line, f"{function.name} has no docstring")
            continue
        if not function.doc.summary:
            tree.report(header.name, function.doc.line, f"{function.name}: no summary")
        for line, text in function.doc.strays:
            tree.report(header.name, line, f"{function.name}: '{text[:30]}' is neither a field "
                        "(two spaces after the *) nor a continuation (five or more)")
        if not function.is_primitive:
            check_fields(tree, header, function)


def check_fields(tree, header, function):
    doc, names = function.doc, [p.name for p in function.parameters]
    formula = function.is_formula

    def report(message, line=doc.line):
        tree.report(header.name, line, f"{function.name}: {message}")

    entries, rest = doc.fields[:len(names)], doc.fields[len(names):]
    documented = [f.key for f in entries]
    if documented != names:
        wrong = next((i for i, n in enumerate(names)
                      if i >= len(documented) or documented[i] != n), 0)
        got = f"'{documented[wrong]}'" if wrong < len(documented) else "nothing"
        report(f"parameter '{names[wrong]}' has no entry in its place (found {got})")
        return
    for parameter, entry in zip(function.parameters, entries):
        check_parameter(tree, header, function, parameter, entry)
    allowed = hdrp_api.DOC_KEYS if formula else hdrp_api.ALGORITHM_DOC_KEYS
    for entry in rest:
        if entry.key not in allowed:
            report(f"'{entry.key}' is neither a parameter nor a field of a docstring; indent a "
                   "continuation by five or more", entry.line)
        elif not entry.text:
            report(f"'{entry.key}' is empty", entry.line)
    keys = [f.key for f in rest]
    for key in ("returns", "edges", "scan"):
        if keys.count(key) > 1:
            report(f"'{key}' appears twice")
    required = ["returns", "edges", "error", "source"] if formula else []
    if not formula and function.type != "void":
        required.append("returns")
    for key in required:
        if key not in keys:
            report(f"no '{key}'")
    if not formula and not {"edges", "errors", "error"} & set(keys):
        report("neither 'edges' nor 'errors'")
    check_errors(report, rest)
    check_returns(tree, report, function, doc.field("returns"))
    scan = doc.field("scan")
    if scan and not hdrp_api.NO_CLAIM.match(scan.text):
        report("'scan' must read 'none: reason'", scan.line)


def check_parameter(tree, header, function, parameter, entry):
    def report(message):
        tree.report(header.name, entry.line, f"{function.name}: {message}")
    try:
        token = entry.range(tree.macros)
    except RangeError as error:
        report(f"range of '{parameter.name}': {error}")
        return
    kind = parameter.type.replace("const ", "").replace("struct ", "").strip()
    is_struct = kind not in SCALARS and kind not in VECTORS and not parameter.is_pointer
    if token is None:
        if function.is_formula or (not parameter.is_pointer and kind in SCALARS):
            report(f"'{parameter.name}' has no range ([a,b], any, finite, unit or valid)")
        elif not entry.text:
            report(f"'{parameter.name}' says nothing")
    elif function.is_formula and is_struct and token.kind not in ("any", "valid"):
        report(f"'{parameter.name}' is a struct: its range is 'valid' or 'any'")
    elif token.kind == "unit" and kind not in VECTORS and not parameter.is_pointer:
        report(f"'{parameter.name}' is not a vector, so not 'unit'")
    elif token.kind == "valid" and kind in SCALARS + VECTORS:
        report(f"'{parameter.name}' is not a struct: its range is not 'valid'")
    if "*" in kind and kind.startswith("void") and "const" not in parameter.type and \
            not re.search(r"\bcaller|\bown", " ".join(f.text for f in function.doc.fields)):
        report(f"nothing says who owns the memory of '{parameter.name}' (caller, owner)")


def check_errors(report, fields):
    for entry in fields:
        if entry.key == "error" and not hdrp_api.CLAIM.match(entry.text) and \
                not hdrp_api.NO_CLAIM.match(entry.text):
            report("'error' must read '<= NUMBER relative|absolute|degrees|ulp ... @accuracy id' "
                   "or 'none: reason'", entry.line)


def check_returns(tree, report, function, entry):
    if not entry or not entry.text:
        return
    try:
        token = entry.range(tree.macros)
    except RangeError as error:
        report(f"range of 'returns': {error}", entry.line)
        return
    if token and token.kind == "unit" and function.type in SCALARS:
        report("'returns' is not a vector, so not 'unit'", entry.line)


def check_claims(tree):
    """Ids are unique, and each is an entry of the registry."""
    registry = "".join(p.read_text(encoding="utf-8")
                       for p in sorted(tree.root.glob("tests/accuracy/acc_*.c")))
    seen = {}
    for claim in hdrp_api.claims(tree.root):
        if claim.id in seen:
            tree.report(claim.header, claim.line,
                        f"@accuracy {claim.id} is already the claim of {seen[claim.id]}")
        seen.setdefault(claim.id, claim.function)
        if f'"{claim.id}"' not in registry:
            tree.report(claim.header, claim.line,
                        f"@accuracy {claim.id} has no entry in tests/accuracy/acc_*.c")


def check_primitives(tree):
    """One sentence may document what does no more than +, -, *, compare and select. Rounding of
    another kind, or an approximation, has an error to be stated."""
    claimed = {claim.function for claim in hdrp_api.claims(tree.root)}
    for header, function in tree.functions():
        if not (function.is_formula and function.is_public and function.is_primitive):
            continue
        calls = set(re.findall(r"\bhdrp_\w+(?=\()", function.body)) & claimed
        built_in = set(re.findall(r"\bHDRP_I_F\((\w+)\)", function.body)) - EXACT_BUILT_INS
        if "/" in function.body or built_in or calls:
            what = ", ".join(sorted(calls | built_in)) or "a division"
            tree.report(header.name, function.line, f"{function.name} uses {what}: one sentence is "
                        "not enough, it needs an 'error' line")


def variants(names):
    """The names of which there are several forms: with and without _fast or _exact."""
    forms = {}
    for name in names:
        forms.setdefault(re.sub(r"_(fast|exact)$", "", name), set()).add(name)
    return set().union(*(f for f in forms.values() if len(f) > 1))


def check_reasons(tree):
    """A form of which there are several, and a codec, has a claim or leads to one: 'none:' may say
    that it is exact, or name the functions that it is made of. What it names must exist."""
    claimed = {claim.function for claim in hdrp_api.claims(tree.root)}
    formulas = {f.name: (h, f) for h, f in tree.functions() if f.is_formula and f.is_public}
    reasons = {name: next((t for t in f.doc.all("error") if t.startswith("none:")), None)
               for name, (_, f) in formulas.items() if f.doc}

    def leads_to_a_claim(name, seen=()):
        reason = reasons.get(name)
        return name in claimed or bool(reason) and name not in seen and (
            bool(re.match(r"none:\s+exact\b", reason)) or
            any(leads_to_a_claim(other, seen + (name,))
                for other in re.findall(r"\bhdrp_\w+", reason)))
    several = variants(formulas)
    for name, (header, function) in formulas.items():
        for other in re.findall(r"\bhdrp_\w+", reasons.get(name) or ""):
            if other not in formulas:
                tree.report(header.name, function.line,
                            f"{name}: the reason names {other}, which is no formula")
        is_codec = header.module == "pack" and CODEC.search(name)
        if (name in several or is_codec) and not leads_to_a_claim(name):
            tree.report(header.name, function.line, f"{name} is "
                        f"{'a codec' if is_codec else 'one of several forms'}: it needs a claim, or "
                        "a reason that is 'exact' or names a function with a claim")


def check_sweeps(tree):
    """Every formula of one float is swept over all floats, unless the scan cannot call it either."""
    text = "".join(p.read_text(encoding="utf-8")
                   for p in sorted(tree.root.glob("tests/exhaustive/*.c")))
    swept = set(re.findall(r"\bhdrp_\w+", hdrp_api.blank_comments(text, strings=False)))
    for header, function in tree.functions():
        if function.is_formula and function.is_public and not function.is_primitive and \
                [p.type for p in function.parameters] == ["float"] and \
                not (function.doc and function.doc.get("scan")) and function.name not in swept:
            tree.report(header.name, function.line,
                        f"{function.name} takes one float and is in no sweep of tests/exhaustive")


def check_coverage(tree):
    """Every public function is named by a test of tests/unit or tests/gpu, or an entry of the
    registry."""
    text = "".join(p.read_text(encoding="utf-8") for folder in ("unit", "accuracy", "gpu")
                   for p in sorted((tree.root / "tests" / folder).glob("*.[ch]")))
    words = set(re.findall(r"\bhdrp_\w+", hdrp_api.blank_comments(text)))
    for header, function in tree.functions():
        if function.is_public and function.name not in words:
            tree.report(header.name, function.line,
                        f"{function.name} is in no unit test and no accuracy entry")


# ---- names -------------------------------------------------------------------------------------

def check_prefixes(tree):
    for header in tree.headers:
        own = header.prefix

        def fits(name, own=own):
            return name.startswith((own, "hdrp_i_")) or name + "_" == own
        for function in header.functions():
            if not fits(function.name):
                tree.report(header.name, function.line,
                            f"{function.name} does not begin with {own}")
            if function.qualifier in ("static", "extern", "") and not function.is_private:
                tree.report(header.name, function.line, f"{function.name} is neither HDRP_FN nor "
                            "HDRP_API: a private function is named hdrp_i_...")
        for struct in header.structs().values():
            if not fits(struct.name):
                tree.report(header.name, struct.line, f"struct {struct.name} does not begin with "
                            f"{own}")
        for enum in header.enums():
            if not fits(enum.name):
                tree.report(header.name, enum.line, f"enum {enum.name} does not begin with {own}")
            for constant in enum.constants:
                if not constant.startswith("HDRP_"):
                    tree.report(header.name, enum.line,
                                f"enumerator {constant} does not begin with HDRP_")


def check_macros(tree):
    """Macros are HDRP_...; the language layer may also map its own types."""
    for header in tree.headers:
        for name, _, _, line in header.defines():
            is_type = name.startswith("hdrp_") and header.name == "hdrp_math.h"
            if not name.startswith("HDRP_") and not is_type:
                tree.report(header.name, line, f"macro {name} does not begin with HDRP_")


def check_double_underscores(tree):
    for header in tree.headers:
        for number, line in enumerate(header.code.split("\n"), 1):
            directive = header.layer_of(number) == "directive"
            for name in re.findall(r"\b\w*__\w*", line):
                # Directives ask for what compilers define.
                if not directive or name.lower().startswith("hdrp_"):
                    tree.report(header.name, number, f"{name}: '__' is reserved")


def check_keywords(tree):
    for header in tree.headers:
        language = first_section_lines(header, "language layer")
        for number, line in code_lines(header, ("formula",)):
            if number in language:
                continue
            for word in sorted(set(re.findall(r"\b[A-Za-z_]\w*", line))):
                languages = reserved_words.languages(word)
                if languages:
                    tree.report(header.name, number,
                                f"'{word}' is reserved in {', '.join(languages)}")


def first_section_lines(header, name):
    """Line numbers of a section of hdrp_math.h, the only header that has a language layer."""
    starts = header.sections + [(len(header.text), "")]
    for (start, section), (end, _) in zip(starts, starts[1:]):
        if section == name and header.name == "hdrp_math.h":
            return range(header.line_of(start), header.line_of(end - 1) + 1)
    return range(0)


def check_void_parameters(tree):
    for header, function in tree.functions():
        if function.parameter_text == "":
            tree.report(header.name, function.line, f"{function.name}() must say (void)")


# Headers that are one module in parts: their private names belong to all of them.
FAMILY = re.compile(r"hdrp_gpu_vk\w*\.h$")


def family(name):
    """What shares the private names of a header."""
    return FAMILY.pattern if FAMILY.match(name) else name


def check_private_use(tree):
    """A private name belongs to one header, or to one family of them."""
    owner = {}
    for header in tree.headers:
        for function in header.functions():
            if function.is_private:
                owner.setdefault(function.name, header.name)
        for name, _, _, _ in header.defines():
            if name.startswith("HDRP_I_"):
                owner.setdefault(name, header.name)
        for name in header.structs():
            if name.startswith("hdrp_i_"):
                owner.setdefault(name, header.name)
    for header in tree.headers:
        for number, line in enumerate(header.code.split("\n"), 1):
            for name in sorted(set(re.findall(r"\b(?:hdrp_i|HDRP_I)_\w+", line))):
                if family(owner.get(name, header.name)) != family(header.name):
                    tree.report(header.name, number, f"{name} is private to {owner[name]}")


# ---- text --------------------------------------------------------------------------------------

def check_lengths(tree):
    for header in tree.headers:
        formulas = []
        for function in header.functions():
            limit = FORMULA_LINES if function.is_formula else ALGORITHM_LINES
            if function.is_formula and function.length:
                formulas.append(function.length)
            if function.length > limit:
                tree.report(header.name, function.body_line,
                            f"{function.name} has {function.length} lines, at most {limit}")
        if len(formulas) >= MEDIAN_NEEDS and statistics.median(formulas) > FORMULA_MEDIAN:
            tree.report(header.name, 1, "the median formula function has "
                        f"{statistics.median(formulas):g} lines, at most {FORMULA_MEDIAN}")
        index = len(index_lines(header.lines))
        generated = index + spirv_lines(header.lines)
        if len(header.lines) - 1 - generated > HEADER_LINES:
            tree.report(header.name, HEADER_LINES, f"{len(header.lines) - 1 - generated} "
                        f"hand-written lines, at most {HEADER_LINES}: split a topic off")
        opening = header.opening_comment.count("\n") + 1 - index
        if opening > OPENING_LINES:
            tree.report(header.name, 1,
                        f"the opening comment has {opening} lines, at most {OPENING_LINES}")
        for number, line in enumerate(header.lines, 1):
            if len(line) > COLUMNS:
                tree.report(header.name, number, f"{len(line)} columns, at most {COLUMNS}")


def check_literals(tree):
    """A float literal of a formula or a macro carries f. Algorithms may compute in double, and
    -Wdouble-promotion sees where they do so by mistake."""
    for header in tree.headers:
        for number, line in code_lines(header, ("formula", "directive")):
            for match in FLOAT_LITERAL.finditer(line):
                if match["suffix"] not in ("f", "F"):
                    tree.report(header.name, number, f"{match[0]} lacks its f")


def check_version(tree):
    math_header = next((h for h in tree.headers if h.name == "hdrp_math.h"), None)
    if not math_header:
        tree.report("hdrp_math.h", 0, "missing")
        return
    parts = [tree.macros.get(f"HDRP_VERSION_{part}", "?") for part in ("MAJOR", "MINOR", "PATCH")]
    number = tree.macros.get("HDRP_VERSION", "?")
    if not all(p.isdigit() for p in parts) or \
            str(int(parts[0]) * 10000 + int(parts[1]) * 100 + int(parts[2])) != number:
        tree.report("hdrp_math.h", 0, f"HDRP_VERSION {number} is not {'.'.join(parts)}")
    for header in tree.headers:
        block = (f"#if HDRP_VERSION != {number}\n"
                 f'#error "{header.name} {".".join(parts)} needs the hdrp_math.h of the same '
                 'version"\n#endif\n')
        if header is not math_header and block not in header.text:
            tree.report(header.name, 1, "the version check is missing or not this:\n" +
                        textwrap.indent(block, "    ").rstrip())


def check_includes(tree):
    for header in tree.headers:
        if header.module not in DEPENDENCIES:
            tree.report(header.name, 1, "not in DEPENDENCIES of tools/api_check.py")
            continue
        allowed = {f'"hdrp_{m}.h"' for m in DEPENDENCIES[header.module].split()} | SYSTEM_HEADERS
        for name, line in header.includes():
            if name not in allowed:
                tree.report(header.name, line, f"must not include {name}")


def check_state(tree):
    """No allocation, no input or output, no data that changes."""
    calls = re.compile(r"(?<![\w.>])(" + "|".join(FORBIDDEN_CALLS) + r")\s*\(")
    data = re.compile(r"^(?:static|extern|HDRP_API)\s+(?!.*\bconst\b)(?!inline\b)[\w\s*]+?"
                      r"(?:\[[^\]]*\]\s*)*(?:=|;)")
    for header in tree.headers:
        for number, line in code_lines(header, ("formula", "algorithm", "implementation")):
            for match in calls.finditer(line):
                tree.report(header.name, number, f"calls {match[1]}")
            if data.match(line):
                tree.report(header.name, number, "data that is not const")


def check_paths(tree):
    for path in tree.files():
        try:
            text = path.read_text(encoding="utf-8")
        except (UnicodeDecodeError, OSError):
            continue
        for number, line in enumerate(text.split("\n"), 1):
            match = ABSOLUTE_PATH.search(line)
            if match:
                tree.report(path.relative_to(tree.root), number,
                            f"absolute path of one machine: {line[match.start():][:40]}")


# ---- the function index ------------------------------------------------------------------------

def make_index(header):
    """The lines of the index: every public function by section, without the common prefix."""
    sections = {}
    for function in header.functions():
        if function.is_public:
            sections.setdefault(function.section or "other", []).append(
                function.name[len(header.prefix):])
    lines = [f"{hdrp_api.INDEX_BEGIN} of the functions, without {header.prefix} "
             "(written by tools/api_check.py --write)"]
    for section, names in sections.items():
        lines += textwrap.wrap(f"{section}: {' '.join(names)}", COLUMNS, break_on_hyphens=False,
                               initial_indent=" *   ", subsequent_indent=" *       ")
    return lines + [hdrp_api.INDEX_END]


def index_lines(lines):
    """Positions of the index in the lines of a header, both markers included; else empty."""
    begin = next((i for i, l in enumerate(lines) if l.startswith(hdrp_api.INDEX_BEGIN)), None)
    end = next((i for i, l in enumerate(lines) if l.startswith(hdrp_api.INDEX_END)), None)
    return range(begin, end + 1) if begin is not None and end is not None else range(0)


def spirv_lines(lines):
    """How many lines tools/embed_spirv.py wrote."""
    begin = next((i for i, l in enumerate(lines) if l.startswith("/* >>spirv")), 0)
    end = next((i for i, l in enumerate(lines) if l.startswith("/* >>end of spirv")), 0)
    return max(end - begin, 0)


def with_index(header):
    """The header's text with a current index; a first one goes to the end of the opening
    comment."""
    lines = list(header.lines)
    where, index = index_lines(lines), make_index(header)
    if not where:
        last = header.opening_comment.count("\n")
        if lines[last].strip() == "*/":
            lines[last:last] = [" *"] + index
        else:
            lines[last:last + 1] = [re.sub(r"\s*\*/$", "", lines[last]), " *"] + index
            lines[last + 1 + len(index)] += " */"
        return "\n".join(lines)
    index[-1] += lines[where[-1]][len(hdrp_api.INDEX_END):]
    lines[where[0]:where[-1] + 1] = index
    return "\n".join(lines)


def check_index(tree):
    for header in tree.headers:
        if with_index(header) != header.text:
            where = index_lines(header.lines)
            tree.report(header.name, where[0] + 1 if where else 1, "the function index is "
                        f"{'not current' if where else 'missing'}: run tools/api_check.py --write")


CHECKS = [check_docstrings, check_claims, check_primitives, check_reasons, check_sweeps,
          check_coverage, check_prefixes, check_macros,
          check_double_underscores, check_keywords, check_void_parameters, check_private_use,
          check_lengths, check_literals, check_version, check_includes, check_state, check_paths,
          check_index]


def problems(root, checks=None):
    """(file, line, message) of everything that is wrong, in order."""
    tree = Tree(root)
    for check in checks or CHECKS:
        check(tree)
    return sorted(tree.problems, key=lambda p: (str(p[0]), p[1]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--root", default=hdrp_api.ROOT, help="the tree to check")
    parser.add_argument("--write", action="store_true", help="update the function indexes first")
    arguments = parser.parse_args()
    if arguments.write:
        for path in hdrp_api.headers(arguments.root):
            header = hdrp_api.header(path)
            text = with_index(header)
            if text != header.text:
                path.write_text(text, encoding="utf-8")
                print(f"wrote the index of {path.name}")
    found = problems(arguments.root)
    for place, line, message in found:
        print(f"{place}:{line}: {message}")
    print(f"api_check: {len(found)} problems")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
