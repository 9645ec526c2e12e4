#!/usr/bin/env python3
"""Reads the public headers: functions, structs, docstrings, ranges, accuracy claims.

Every tool that needs to know the API asks this module, so the headers are parsed in one way only.
It understands the house style (see CONTRIBUTING.md), not C in general: a public name begins a
declaration at the first column, and the preprocessor guards are the ones every header has.
"""
import functools
import math
import pathlib
import re
import struct
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parent.parent

FLT_MAX = 3.4028234663852886e38
FLT_MIN = 1.1754943508222875e-38

# Sections of hdrp_math.h whose functions are the vocabulary of everything else: one sentence may
# document them, and the finite scan leaves those out, because they promise what the operator or
# built-in function in them does.
PRIMITIVE_SECTIONS = ("language layer", "vectors")

# What a docstring says of a formula, and what it may say of an algorithm besides.
DOC_KEYS = ("returns", "requires", "edges", "error", "scan", "cost", "source", "note")
ALGORITHM_DOC_KEYS = DOC_KEYS + ("errors", "memory", "range")

INDEX_BEGIN = " * >>index"
INDEX_END = " * >>end"

DECLARATION = re.compile(
    r"^(?:(?P<qualifier>HDRP_FN|HDRP_API|static inline|static|extern)\s+)?"
    r"(?P<type>(?:const\s+|struct\s+|unsigned\s+)*[A-Za-z_]\w*(?:\s+const)?[\s*]+)"
    r"(?P<name>hdrp_\w+)\s*\(", re.M)
STRUCT = re.compile(r"^(?:typedef\s+)?struct\s+(?P<name>\w+)\s*\{(?P<body>.*?)^\}", re.M | re.S)
ENUM = re.compile(r"^(?:typedef\s+)?enum\s+(?P<name>\w*)\s*\{(?P<body>.*?)^\}", re.M | re.S)
DEFINE = re.compile(r"^#\s*define\s+(?P<name>\w+)(?P<parameters>\([^)]*\))?[ \t]*(?P<value>.*)$",
                    re.M)
INCLUDE = re.compile(r'^#\s*include\s+(?P<file>"[^"]+"|<[^>]+>)', re.M)
SECTION = re.compile(r"^/\* >>(?P<name>[^\n*:]+)", re.M)
FIELD = re.compile(r"^ {2}(?P<key>\w+)(?:\s+(?P<value>\S.*))?$")
CLAIM = re.compile(r"^<=\s*(?P<bound>[0-9.]+(?:[eE][+-]?[0-9]+)?)\s+"
                   r"(?P<unit>relative|absolute|degrees|ulp)\b.*?@accuracy\s+(?P<id>\w+)$", re.S)
NO_CLAIM = re.compile(r"^none:\s+\S")
MASK = re.compile(r"^(HDRP_\w+_)\.\.\.")
NUMBER = re.compile(r"(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)")


# ---- ranges ------------------------------------------------------------------------------------

class RangeError(ValueError):
    pass


@dataclass(frozen=True)
class Range:
    """What a range token says. kind: interval, any, finite, unit or valid.

    Only an interval has ends. They are Python numbers; hdrp_api.f32 rounds one to the float that a
    C literal of the same digits would be."""
    kind: str
    lo: float = -math.inf
    hi: float = math.inf
    lo_open: bool = False
    hi_open: bool = False

    def contains(self, x):
        if self.kind == "any":
            return True
        if math.isnan(x):
            return False
        if self.kind == "finite":
            return math.isfinite(x)
        above = x > self.lo if self.lo_open else x >= self.lo
        below = x < self.hi if self.hi_open else x <= self.hi
        return above and below

    def __str__(self):
        if self.kind != "interval":
            return self.kind
        return (f"{'(' if self.lo_open else '['}{self.lo:.9g},"
                f"{self.hi:.9g}{')' if self.hi_open else ']'}")


ANY, FINITE, UNIT, VALID = (Range(kind) for kind in ("any", "finite", "unit", "valid"))
WORDS = {"any": ANY, "finite": FINITE, "unit": UNIT, "valid": VALID}
# An interval can only be told from prose in brackets by its comma: "[1/sr]" is a unit.
INTERVAL = re.compile(r"^([\[(])([^,\s]+),([^,\s]+)([\])])$")


def f32(x):
    """The float nearest to x, as a Python number."""
    if math.isinf(x) or math.isnan(x):
        return x
    if abs(x) >= FLT_MAX * (1.0 + 2.0 ** -25):
        return math.copysign(math.inf, x)
    return struct.unpack("<f", struct.pack("<f", x))[0]


def f32_bits(x):
    return struct.unpack("<I", struct.pack("<f", x))[0]


def next_up(x):
    """The next float above x."""
    if x == math.inf:
        return x
    bits = f32_bits(x)
    if x == 0.0:
        bits = 1
    elif x > 0.0:
        bits += 1
    else:
        bits -= 1
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def next_down(x):
    return -next_up(-x)


def evaluate(text, macros):
    """Value of a constant expression of numbers and HDRP_ macros; None when it is not one."""
    def expand(text, depth):
        if depth > 16:
            raise RangeError("macro expands without end")

        def name(match):
            if match[0] not in macros:
                raise RangeError(f"unknown macro {match[0]}")
            return f"({expand(macros[match[0]], depth + 1)})"
        # Number suffixes go first: what is left of a name is then a macro.
        text = re.sub(rf"({NUMBER.pattern})[fFuUlL]*(?!\w)", r"\1", text)
        text = re.sub(r"\(\s*(?:float|hdrp_u32|int|unsigned|uint32_t)\s*\)", "", text)
        return re.sub(r"\b[A-Za-z_]\w*", name, text)

    try:
        expanded = expand(text, 0)
        if not re.fullmatch(r"[\s0-9a-fA-FxX.eE+\-*/()<>|&]+", expanded):
            return None
        # Nothing but digits and operators is left: there is no name that eval could look up.
        return eval(expanded, {"__builtins__": {}}, {})  # pylint: disable=eval-used
    except (RangeError, SyntaxError, ZeroDivisionError, TypeError, NameError):
        return None


def parse_bound(text, macros):
    sign, body = (-1, text[1:]) if text.startswith("-") else (1, text)
    if body == "inf":
        return sign * math.inf
    if body in ("FLT_MAX", "FLT_MIN"):
        return sign * (FLT_MAX if body == "FLT_MAX" else FLT_MIN)
    if NUMBER.fullmatch(body):
        return sign * (int(body, 16) if body[:2] in ("0x", "0X") else
                       int(body) if body.isdigit() else float(body))
    if body.startswith("HDRP_"):
        value = evaluate(body, macros)
        if value is None:
            raise RangeError(f"{body} has no value that a range can use")
        return sign * value
    raise RangeError(f"'{text}' is not a number, inf, FLT_MAX, FLT_MIN or an HDRP_ macro")


def parse_range(token, macros):
    """The Range that a token stands for; None when the token is not a range at all."""
    token = token.rstrip(".,;:")
    if token in WORDS:
        return WORDS[token]
    match = INTERVAL.match(token)
    if not match:
        return None
    lo, hi = parse_bound(match[2], macros), parse_bound(match[3], macros)
    if lo > hi:
        raise RangeError(f"{token} is empty")
    return Range("interval", lo, hi, match[1] == "(", match[4] == ")")


# ---- docstrings --------------------------------------------------------------------------------

@dataclass
class DocField:
    key: str
    text: str
    line: int

    def range(self, macros):
        """The range that the field starts with, or None."""
        words = self.text.split(None, 1)
        return parse_range(words[0], macros) if words else None


@dataclass
class Doc:
    """Summary, then the fields in order; continuation lines are joined to their field."""
    summary: str = ""
    fields: list = field(default_factory=list)
    line: int = 0
    # (line, text) of what is neither a field nor its continuation.
    strays: list = field(default_factory=list)

    def all(self, key):
        return [f.text for f in self.fields if f.key == key]

    def get(self, key):
        found = self.all(key)
        return found[0] if found else None

    def field(self, key):
        return next((f for f in self.fields if f.key == key), None)


def parse_doc(comment, line=0, parameters=()):
    """comment is the text between the opening '/**' and the closing '*/'; line is its first line.

    The summary goes on until a line begins with the name of a parameter or of a field."""
    doc = Doc(line=line)
    known = set(ALGORITHM_DOC_KEYS) | {p.name for p in parameters}
    for number, raw in enumerate(comment.split("\n"), line):
        first = number == line
        if not first and raw.strip() and not raw.lstrip().startswith("*"):
            doc.strays.append((number, raw.strip()))
            continue
        text = raw if first else re.sub(r"^\s*\*", "", raw)
        text = text.rstrip()
        indent = len(text) - len(text.lstrip())
        match = FIELD.match(text) if not first else None
        if match and (doc.fields or match["key"] in known):
            doc.fields.append(DocField(match["key"], match["value"] or "", number))
        elif not text.strip():
            continue
        elif doc.fields and indent >= 4:
            doc.fields[-1].text = (doc.fields[-1].text + " " + text.strip()).strip()
        elif not doc.fields:
            doc.summary = (doc.summary + " " + text.strip()).strip()
        else:
            doc.strays.append((number, text.strip()))
    return doc


# ---- declarations ------------------------------------------------------------------------------

@dataclass
class Parameter:
    type: str
    name: str

    @property
    def is_pointer(self):
        return "*" in self.type


@dataclass
class Claim:
    id: str
    bound: float
    unit: str
    function: str
    header: str
    line: int = 0


@dataclass
class Function:
    header: str
    line: int
    section: str
    qualifier: str
    type: str
    name: str
    parameters: list
    parameter_text: str = ""
    doc: Doc = None
    # Of the definition: first line, number of lines from the signature to the closing brace, and
    # the text between the braces without comments. A declaration alone has none.
    body_line: int = 0
    length: int = 0
    body: str = ""

    @property
    def is_formula(self):
        return self.qualifier == "HDRP_FN"

    @property
    def is_private(self):
        return self.name.startswith("hdrp_i_")

    @property
    def is_public(self):
        return not self.is_private and self.qualifier in ("HDRP_FN", "HDRP_API", "static inline")

    @property
    def is_primitive(self):
        """Is it documented by a single sentence, and may it be?"""
        in_vocabulary = self.header == "hdrp_math.h" and self.section in PRIMITIVE_SECTIONS
        is_name_of_code = self.name.endswith("_string") and self.type == "const char*"
        return (in_vocabulary or is_name_of_code) and bool(self.doc) and not self.doc.fields


@dataclass
class Member:
    type: str
    name: str
    comment: str
    line: int
    array: str = ""

    def range(self, macros):
        """The range that the comment states, or None: a word at its beginning, an interval
        anywhere, or "any length" anywhere, which is a finite vector, zero included."""
        for i, word in enumerate(self.comment.split()):
            found = parse_range(word, macros)
            if found and (found.kind == "interval" or i == 0) and \
                    not self.comment.startswith("any length"):
                return found
        return FINITE if "any length" in self.comment else None

    def groups(self, macros):
        """[(first component, how many, token)] of a comment such as "xyz unit, w [0,1] size",
        which gives the components of a vector ranges of their own; [] for any other."""
        found = re.findall(r"(?:^|(?<=[,;] ))([xyzw]{1,4}|[rgba]{1,4}) (\S+)", self.comment)
        letters = "xyzw" if re.match(r"[xyzw]+ ", self.comment) else "rgba"
        groups = [(letters.find(names), len(names), token) for names, token in found
                  if parse_range(token, macros) or MASK.match(token)]
        starts_so = found and self.comment.startswith(f"{found[0][0]} {found[0][1]}")
        return groups if starts_so and groups and groups[0][0] == 0 else []

    def mask(self):
        """The prefix of the macros whose union the member is, or None."""
        match = MASK.match(self.comment)
        return match[1] if match else None


@dataclass
class Struct:
    header: str
    line: int
    name: str
    members: list
    comment: str
    is_shared: bool  # readable by shaders, not the C-only "typedef struct"

    def __iter__(self):
        """(type, name) of the members."""
        return ((member.type, member.name) for member in self.members)

    @property
    def producers(self):
        """The functions that "Made by hdrp_x ..." in the comment names, up to the full stop."""
        match = re.search(r"\b[Mm]ade by\b(?P<names>.*?)(?:\.(?!\w)|$)", self.comment)
        return re.findall(r"\bhdrp_\w+\b(?!\.h)", match["names"]) if match else []


@dataclass
class Enum:
    header: str
    line: int
    name: str
    constants: list


def parse_parameters(text):
    """Parameters of a list that may span lines; a function pointer counts as a pointer."""
    text = " ".join(text.split())
    if text in ("", "void"):
        return []
    items, depth, start = [], 0, 0
    for i, c in enumerate(text + ","):
        depth += (c == "(") - (c == ")")
        if c == "," and depth == 0:
            items.append(text[start:i].strip())
            start = i + 1
    parameters = []
    for item in items:
        callback = re.match(r"^(?P<type>.+?)\(\s*\*\s*(?P<name>\w+)\s*\)\s*\(.*\)$", item)
        plain = re.match(r"^(?P<type>.*?[\s*])(?P<name>\w+)(?P<array>(\[[^\]]*\])*)$", item)
        if callback:
            parameters.append(Parameter(callback["type"].strip() + " (*)()", callback["name"]))
        elif plain:
            parameters.append(Parameter(plain["type"].strip() + ("*" if plain["array"] else ""),
                                        plain["name"]))
        else:
            parameters.append(Parameter(item, ""))
    return parameters


def blank_comments(text, strings=True):
    """The text with comments (and the contents of strings) as spaces: offsets stay the same."""
    token = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)

    def blank(match):
        if match[0][0] in "\"'":
            return match[0][0] + " " * (len(match[0]) - 2) + match[0][0] if strings else match[0]
        return re.sub(r"[^\n]", " ", match[0])
    return token.sub(blank, text)


def matching(code, start, pair):
    """Offset of the bracket that closes the one at start; -1 when there is none."""
    depth = 0
    for match in re.compile(f"[{re.escape(pair)}]").finditer(code, start):
        depth += 1 if match[0] == pair[0] else -1
        if depth == 0:
            return match.start()
    return -1


# A topic that outgrew its header stands in one of its own and keeps the names: topic -> header.
SPLIT_FROM = {"brdf_lobes": "brdf", "env_image": "env", "cull_volume": "cull",
              "cull_blocker": "cull", "cull_grid": "cull", "cull_tile": "cull",
              "cull_variant": "cull", "gpu_vk_core": "gpu_vk",
              "gpu_vk_cull": "gpu_vk", "gpu_vk_env": "gpu_vk", "gpu_vk_light": "gpu_vk",
              "gpu_vk_oit": "gpu_vk", "gpu_vk_shadow": "gpu_vk"}


class Header:
    """One header, parsed on demand."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.name = self.path.name
        self.text = self.path.read_text(encoding="utf-8")
        self.code = blank_comments(self.text)
        self.lines = self.text.split("\n")
        self._functions = self._layers = None

    @property
    def module(self):
        return self.name[len("hdrp_"):-len(".h")]

    @property
    def prefix(self):
        """What every public function and type of the header begins with."""
        module = SPLIT_FROM.get(self.module, self.module)
        return "hdrp_" if module == "math" else f"hdrp_{module}_"

    def line_of(self, offset):
        return self.text.count("\n", 0, offset) + 1

    def comment_before(self, offset, opening="/*"):
        """(comment text, first line) of the comment that ends just before offset, or None."""
        before = self.text[:offset].rstrip()
        start = before.rfind("/*")
        if not before.endswith("*/") or start < 0 or not before.startswith(opening, start):
            return None
        return before[start + len(opening):-2], self.line_of(start)

    @property
    def opening_comment(self):
        match = re.match(r"/\*.*?\*/", self.text, re.S)
        return match[0] if match else ""

    @functools.cached_property
    def sections(self):
        return [(m.start(), m["name"].strip()) for m in SECTION.finditer(self.text)]

    def section_of(self, offset):
        return next((name for start, name in reversed(self.sections) if start < offset), "")

    def layers(self):
        """For each line: 'formula', 'algorithm' or 'implementation', and 'directive' lines."""
        if self._layers is None:
            self._layers = self._find_layers()
        return self._layers

    def layer_of(self, line):
        return self.layers()[line - 1]

    def _find_layers(self):
        result, stack, continued = [], [], False
        for line in self.code.split("\n"):
            directive = continued or line.lstrip().startswith("#")
            match = re.match(r"\s*#\s*(ifdef|ifndef|if|elif|else|endif)\b\s*(.*)", line)
            if match and not continued:
                word, condition = match[1], match[2].strip()
                if word in ("if", "ifdef", "ifndef"):
                    stack.append(self._layer_of_condition(word, condition))
                elif word == "endif" and stack:
                    stack.pop()
                elif word == "else" and stack:
                    stack[-1] = {"not gpu": "", "gpu": "algorithm"}.get(stack[-1], stack[-1])
            continued = directive and line.endswith("\\")
            if directive:
                result.append("directive")
            elif "implementation" in stack:
                result.append("implementation")
            elif "not gpu" in stack or "algorithm" in stack:
                result.append("algorithm")
            else:
                result.append("formula")
        return result

    @staticmethod
    def _layer_of_condition(word, condition):
        if word != "ifndef" and re.search(r"\bHDRP_\w+_IMPLEMENTATION\b", condition):
            return "implementation"
        if word == "ifndef" and condition == "HDRP_GPU":
            return "not gpu"
        if word == "if" and re.match(r"!\s*defined\s*\(?\s*HDRP_GPU\s*\)?", condition):
            return "not gpu"
        if word == "ifdef" and condition == "HDRP_GPU":
            return "gpu"
        return ""

    def functions(self):
        """Every function that begins at the first column, once each: a definition is joined to
        its declaration, and the docstring is looked for at both."""
        if self._functions is None:
            found = {}
            for match in DECLARATION.finditer(self.code):
                function = self._function(match)
                if function and function.name in found:
                    self._join(found[function.name], function)
                elif function:
                    found[function.name] = function
            self._functions = list(found.values())
        return self._functions

    def _function(self, match):
        if match["type"].split()[0] in ("return", "else", "typedef"):
            return None
        opening = match.end() - 1
        closing = matching(self.code, opening, "()")
        tail = re.match(r"\s*([{;])", self.code[closing + 1:]) if closing > 0 else None
        if not tail:
            return None
        comment = self.comment_before(match.start(), "/**")
        line = self.line_of(match.start())
        text = self.code[opening + 1:closing]
        parameters = parse_parameters(text)
        function = Function(self.name, line, self.section_of(match.start()),
                            match["qualifier"] or "", " ".join(match["type"].split()),
                            match["name"], parameters, " ".join(text.split()),
                            parse_doc(*comment, parameters) if comment else None)
        if tail[1] == "{":
            brace = closing + 1 + tail.end() - 1
            end = matching(self.code, brace, "{}")
            function.body_line = line
            function.body = self.code[brace + 1:end]
            function.length = self.line_of(end) - line + 1
        return function

    @staticmethod
    def _join(known, other):
        known.doc = known.doc or other.doc
        if other.length and not known.length:
            known.body, known.body_line, known.length = other.body, other.body_line, other.length

    def structs(self):
        """name -> Struct."""
        result = {}
        for match in STRUCT.finditer(self.code):
            offset = match.start("body")
            members = self._members(self.text[offset:match.end("body")], self.line_of(offset))
            comment = self.comment_before(match.start())
            comment = " ".join(re.sub(r"^\s*\*", "", line).strip()
                               for line in comment[0].split("\n")) if comment else ""
            result[match["name"]] = Struct(self.name, self.line_of(match.start()), match["name"],
                                           members, comment,
                                           not match[0].startswith("typedef"))
        return result

    @staticmethod
    def _members(body, line):
        """A member's comment is the one that follows its semicolon on the same line (and goes on
        below), or else the one that stands alone above it."""
        members, pending, above = [], [], ""
        token = re.compile(r"/\*(?P<comment>.*?)\*/|(?P<declaration>[^;/\s][^;/]*;)", re.S)
        for match in token.finditer(body):
            at = line + body.count("\n", 0, match.start())
            if match["comment"] is not None:
                text = " ".join(re.sub(r"^\s*\*(?!/)", "", part).strip()
                                for part in match["comment"].split("\n")).strip()
                if pending and "\n" not in body[pending_end:match.start()]:
                    for member in pending:
                        member.comment = text
                    pending = []
                else:
                    above = text
            else:
                declaration = " ".join(match["declaration"][:-1].split())
                pending, pending_end = [], match.end()
                kind = re.match(r"^((?:const |struct |enum |unsigned )*\w+[ *]+(?:const\b)?)",
                                declaration)
                if kind and "(" not in declaration:
                    for name in declaration[kind.end():].split(","):
                        name, stars = name.strip().lstrip("* "), name.count("*")
                        array = re.search(r"\[.*\]", name)
                        pending.append(Member(kind[1].strip() + "*" * stars,
                                              re.sub(r"\[.*\]", "", name).strip(), above, at,
                                              array[0] if array else ""))
                elif "(*" in declaration:
                    name = re.search(r"\(\s*\*\s*(\w+)", declaration)
                    pending.append(Member("void (*)()", name[1] if name else declaration, above,
                                          at))
                members += pending
                above = ""
        return members

    def enums(self):
        result = []
        for match in ENUM.finditer(self.code):
            constants = [c.split("=")[0].strip() for c in match["body"].split(",")]
            result.append(Enum(self.name, self.line_of(match.start()), match["name"],
                               [c for c in constants if c]))
        return result

    def defines(self):
        """(name, has parameters, value, line) of every #define."""
        code = blank_comments(self.text, strings=False)
        return [(m["name"], bool(m["parameters"]), m["value"].strip(), self.line_of(m.start()))
                for m in DEFINE.finditer(code)]

    def includes(self):
        """(file with its quotes or brackets, line); strings are text, so not the blanked code."""
        code = blank_comments(self.text, strings=False)
        return [(m["file"], self.line_of(m.start())) for m in INCLUDE.finditer(code)]


# ---- the whole API -----------------------------------------------------------------------------

_cache = {}


def header(path):
    """The parsed header; parsed again only when the file has changed."""
    path = pathlib.Path(path).resolve()
    stamp = path.stat().st_mtime_ns, path.stat().st_size
    if path not in _cache or _cache[path][0] != stamp:
        _cache[path] = stamp, Header(path)
    return _cache[path][1]


def headers(root=ROOT):
    """Paths of the public headers: hdrp_math.h first, then by name."""
    paths = sorted(pathlib.Path(root).glob("hdrp_*.h"))
    return sorted(paths, key=lambda p: (p.name != "hdrp_math.h", p.name))


def functions(path):
    """Every function that the header declares or defines, once each."""
    return header(path).functions()


def structs(path):
    """name -> Struct of the header."""
    return header(path).structs()


def macros(root=ROOT):
    """name -> value of every macro without parameters, over all headers."""
    result = {}
    for path in headers(root):
        for name, has_parameters, value, _ in header(path).defines():
            if value and not has_parameters:
                result.setdefault(name, value)
    return result


def claims(root=ROOT):
    """Every 'error <= ... @accuracy id' of every public header."""
    result = []
    for path in headers(root):
        for function in functions(path):
            for entry in (function.doc.fields if function.doc else []):
                match = CLAIM.match(entry.text) if entry.key == "error" else None
                if match:
                    result.append(Claim(match["id"], float(match["bound"]), match["unit"],
                                        function.name, path.name, entry.line))
    return result
