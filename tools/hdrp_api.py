#!/usr/bin/env python3
"""Reads the public headers: functions, structs, docstrings, accuracy claims.

Every tool that needs to know the API asks this module, so the headers are parsed in one way only.
It understands the house style (see CONTRIBUTING.md), not C in general.
"""
import pathlib
import re
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parent.parent

FUNCTION = re.compile(
    r"^(?P<qualifier>HDRP_FN|HDRP_API|static inline)\s+(?P<type>[A-Za-z_][\w ]*\**)\s*"
    r"(?P<name>hdrp_\w+)\((?P<parameters>[^)]*)\)\s*(?P<end>[{;]|$)", re.M)
STRUCT = re.compile(r"^(?:typedef )?struct (?P<name>hdrp_\w+) \{(?P<body>.*?)^\}", re.M | re.S)
DOCSTRING = re.compile(r"/\*\*(?P<text>.*?)\*/\s*$", re.S)
FIELD = re.compile(r"^ {2}(?P<key>\w+) {1,}(?P<value>\S.*)$")
CLAIM = re.compile(r"<=\s*(?P<bound>[0-9.eE+-]+)\s+(?P<unit>relative|absolute|degrees|ulp)\b"
                   r".*?@accuracy\s+(?P<id>\w+)", re.S)
SECTION = re.compile(r"^/\* >>(?P<name>[^\n*:]+)", re.M)


@dataclass
class Parameter:
    type: str
    name: str


@dataclass
class Claim:
    id: str
    bound: float
    unit: str
    function: str
    header: str


@dataclass
class Function:
    header: str
    line: int
    section: str
    qualifier: str
    type: str
    name: str
    parameters: list
    doc: "Doc"

    @property
    def is_formula(self):
        return self.qualifier == "HDRP_FN"

    @property
    def is_private(self):
        return self.name.startswith("hdrp_i_")


@dataclass
class Doc:
    """summary, then (key, text) in order; continuation lines are joined to their field."""
    summary: str = ""
    fields: list = field(default_factory=list)

    def all(self, key):
        return [text for k, text in self.fields if k == key]

    def get(self, key):
        found = self.all(key)
        return found[0] if found else None


def headers():
    """The public headers in dependency order: hdrp_math.h first, then by name."""
    paths = sorted(ROOT.glob("hdrp_*.h"))
    return sorted(paths, key=lambda p: (p.name != "hdrp_math.h", p.name))


def parse_doc(comment):
    doc = Doc()
    for raw in comment.split("\n"):
        line = re.sub(r"^\s*\*(?=\s|$)", "", raw) if raw.lstrip().startswith("*") else raw
        line = line.rstrip()
        match = FIELD.match(line)
        if match:
            doc.fields.append([match["key"], match["value"]])
        elif doc.fields and line.strip():
            doc.fields[-1][1] += " " + line.strip()
        elif line.strip():
            doc.summary = (doc.summary + " " + line.strip()).strip()
    doc.fields = [tuple(f) for f in doc.fields]
    return doc


def parse_parameters(text):
    text = " ".join(text.split())
    if text in ("", "void"):
        return []
    parameters = []
    for item in text.split(","):
        match = re.match(r"^(?P<type>.*?[\s*])(?P<name>\w+)(?P<array>(\[\w*\])*)$", item.strip())
        parameters.append(Parameter(match["type"].strip() + ("*" if match["array"] else ""),
                                    match["name"]))
    return parameters


def functions(path):
    """Every documented or public function that the header declares or defines, once each."""
    text = path.read_text()
    seen, result = set(), []
    sections = [(m.start(), m["name"].strip()) for m in SECTION.finditer(text)]
    for match in FUNCTION.finditer(text):
        if match["name"] in seen:
            continue
        before = text[:match.start()]
        comment = DOCSTRING.search(before[before.rfind("/*"):]) if "/*" in before else None
        section = ""
        for start, name in sections:
            if start < match.start():
                section = name
        seen.add(match["name"])
        result.append(Function(path.name, before.count("\n") + 1, section, match["qualifier"],
                               match["type"].strip(), match["name"],
                               parse_parameters(match["parameters"]),
                               parse_doc(comment["text"]) if comment else None))
    return result


def structs(path):
    """name -> [(type, member)] for the structs of a header."""
    result = {}
    for match in STRUCT.finditer(path.read_text()):
        members = []
        body = re.sub(r"/\*.*?\*/", "", match["body"], flags=re.S)
        for declaration in body.split(";"):
            declaration = " ".join(declaration.split())
            if declaration:
                kind, names = declaration.split(" ", 1)
                members += [(kind, name.strip()) for name in names.split(",")]
        result[match["name"]] = members
    return result


def claims():
    """Every 'error <= ... @accuracy id' of every public header."""
    result = []
    for path in headers():
        for function in functions(path):
            for text in (function.doc.all("error") if function.doc else []):
                match = CLAIM.search(text)
                if match:
                    result.append(Claim(match["id"], float(match["bound"]), match["unit"],
                                        function.name, path.name))
    return result
