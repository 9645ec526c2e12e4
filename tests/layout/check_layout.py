#!/usr/bin/env python3
"""Checks that shaders see a shared struct where C does: check_layout.py HEADER STRUCT SIZE.

The struct may only have 16-byte members. Their offsets in a GLSL storage buffer and in an HLSL
structured buffer are read back from the SPIR-V. On the C side the header asserts them itself.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import hdrp_api  # noqa: E402

GLSL = """#version 450
#extension GL_GOOGLE_include_directive : require
#include "{header}"
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer block {{ {struct} records[]; }};
void main() {{ records[1] = records[0]; }}
"""
HLSL = """#include "{header}"
RWStructuredBuffer<{struct}> records : register(u0);
[numthreads(1, 1, 1)] void main() {{ records[1] = records[0]; }}
"""
LANGUAGES = {"GLSL": (GLSL, ["-V"]),
             "HLSL": (HLSL, ["-D", "-V", "-DHDRP_HLSL", "-e", "main"])}


def reflect(text, flags, header, struct):
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder, "layout.comp")
        binary = pathlib.Path(folder, "layout.spv")
        source.write_text(text.format(header=header, struct=struct))
        subprocess.run(["glslangValidator", *flags, f"-I{ROOT}", "-S", "comp", source, "-o", binary],
                       check=True, stdout=subprocess.DEVNULL)
        return json.loads(subprocess.run(["spirv-cross", binary, "--reflect"], check=True,
                                         stdout=subprocess.PIPE).stdout)


def layout(reflection, struct):
    """(stride of the array of records, {member: offset})"""
    types = reflection["types"]
    for block in types.values():
        for member in block["members"]:
            record = types.get(member["type"])
            if record and record["name"] == struct and "array_stride" in member:
                return member["array_stride"], {m["name"]: m["offset"] for m in record["members"]}
    sys.exit(f"{struct}: not found in the reflection")


def main():
    header, struct, size = sys.argv[1], sys.argv[2], int(sys.argv[3])
    members = list(hdrp_api.structs(ROOT / header)[struct])
    small = [name for kind, name in members if kind not in ("hdrp_v4", "hdrp_u32x4")]
    if small:
        sys.exit(f"{struct}: not a 16-byte member: {', '.join(small)}")
    expected = size, {name: 16 * i for i, (_, name) in enumerate(members)}
    for language, (text, flags) in LANGUAGES.items():
        found = layout(reflect(text, flags, header, struct), struct)
        if found != expected:
            sys.exit(f"{struct} in {language}: {found}, expected {expected}")
        print(f"{struct} in {language}: {len(members)} members, {size} bytes")


if __name__ == "__main__":
    main()
