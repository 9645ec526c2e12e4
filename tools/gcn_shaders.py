"""The compute shaders that gcn_probe.py measures: their text, and what they are called."""
import pathlib
import re
import sys
from dataclasses import dataclass

import hdrp_api

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "compile"))
import calls  # noqa: E402  pylint: disable=wrong-import-position

PRELUDE = """#version 450
#extension GL_GOOGLE_include_directive : require
{include}
layout(local_size_x = 64) in;
"""

# ---- formulas ----------------------------------------------------------------------------------

# Every shader has the same stride, so that the arithmetic of addresses is the same too. Volatile,
# because of the barrier: it waits for all loads, so that a formula begins with its arguments in
# registers, and what is spent on loads and stores depends on nothing but their number.
STRIDE = 128
FORMULA_BUFFERS = """
layout(std430, binding = 0) volatile readonly buffer Values { float values[]; };
layout(std430, binding = 1) volatile writeonly buffer Results { float results[]; };
"""
FORMULA_MAIN = """void {name}()
{{
    uint i = gl_GlobalInvocationID.x * {stride}u;
{load}    memoryBarrierBuffer();
{statements}{store}}}
"""


@dataclass
class Shader:
    """One function of a module. mask: the value of specialization constant 0."""
    name: str
    stores: int = 0
    mask: str = "-"
    entry: str = "main"


@dataclass
class Module:
    """A text for the shader compiler, and the shaders that are made of it: one for each function in
    it, or one for each value of its constant."""
    name: str
    text: str
    shaders: list


class BufferCalls(calls.Calls):
    """A call whose arguments come from one buffer and whose results go to another."""

    def scalar(self, kind):
        value = f"v{self.count}"
        self.count += 1
        return value if kind == "float" else f"floatBitsToUint({value})"

    def leaves(self, kind, value):
        return [f"uintBitsToFloat({value})"] if kind == "hdrp_u32" else super().leaves(kind, value)


def entry_text(name, loads, statements, results):
    if max(loads, len(results)) > STRIDE:
        raise SystemExit(f"gcn_shaders.py: {name} has more than {STRIDE} arguments or results")
    load = "".join(f"    float v{k} = values[i + {k}u];\n" for k in range(loads))
    store = "".join(f"    results[i + {k}u] = {value};\n" for k, value in enumerate(results))
    return FORMULA_MAIN.format(name=name, stride=STRIDE, load=load, statements=statements,
                               store=store)


def formula_entry(function, structs):
    """(Shader, text of its function)"""
    made = BufferCalls({name: list(struct) for name, struct in structs.items()})
    arguments = [f"a{k}" for k in range(len(function.parameters))]
    for argument, parameter in zip(arguments, function.parameters):
        made.lines.append(f"    {parameter.type} {argument};")
        made.fill(parameter.type, argument)
    made.lines.append(f"    {function.type} r = {function.name}({', '.join(arguments)});")
    results = made.leaves(function.type, "r")
    shader = Shader(function.name, len(results), entry=f"run_{function.name}")
    return shader, entry_text(shader.entry, made.count, "\n".join(made.lines) + "\n", results)


def empty_name(loads, stores):
    return f"load_{loads}_store_{stores}"


def empty_entry(loads, stores):
    results = [f"v{k % loads}" if loads else "0.0" for k in range(stores)]
    shader = Shader(empty_name(loads, stores), stores, entry=f"run_{empty_name(loads, stores)}")
    return shader, entry_text(shader.entry, loads, "", results)


def module_of(name, include, entries):
    """main calls every function, which keeps the shader compiler from leaving any out."""
    text = PRELUDE.format(include=include) + FORMULA_BUFFERS
    text += "".join(text for _, text in entries)
    called = "".join(f"    {shader.entry}();\n" for shader, _ in entries)
    text += f"void main()\n{{\n{called}}}\n"
    return Module(name, text, [shader for shader, _ in entries])


def empty_module(signatures):
    """Loads and stores without a formula; a signature is (loads, stores)."""
    return module_of("empty", "", [empty_entry(*signature) for signature in sorted(signatures)])


def formula_modules(root, names=None):
    """One for each header in a folder, with its public formulas or those of these names."""
    structs, modules = {}, []
    for path in hdrp_api.headers(root):
        structs.update(hdrp_api.structs(path))
    for path in hdrp_api.headers(root):
        entries = [formula_entry(function, structs) for function in hdrp_api.functions(path)
                   if function.is_formula and function.is_public
                   and (not names or function.name in names)]
        if entries:
            modules.append(module_of(path.stem, f'#include "{path.name}"', entries))
    return modules


# ---- the Lit model -----------------------------------------------------------------------------

FEATURES = {"subsurface": 1, "transmission": 2, "anisotropy": 4, "iridescence": 8, "coat": 16,
            "refraction": 32, "exact": 256}
MACROS = {"HDRP_BRDF_FEATURE_SUBSURFACE": 1, "HDRP_BRDF_FEATURE_TRANSMISSION": 2,
          "HDRP_BRDF_FEATURE_ANISOTROPY": 4, "HDRP_BRDF_FEATURE_IRIDESCENCE": 8,
          "HDRP_BRDF_FEATURE_CLEAR_COAT": 16, "HDRP_BRDF_FEATURE_REFRACTION": 32,
          "HDRP_BRDF_LIT_EXACT": 256}
VARIANTS = ["standard", "coat", "anisotropy", "iridescence", "transmission", "refraction",
            "coat+anisotropy", "coat+iridescence", "coat+transmission",
            "anisotropy+iridescence", "anisotropy+transmission",
            "coat+anisotropy+iridescence", "coat+anisotropy+iridescence+transmission",
            "iridescence+exact",
            "coat+anisotropy+iridescence+transmission+refraction"]
RUN_TIME = "run_time_mask"  # every feature is in the code, and the material says which it has

# The members of hdrp_brdf_data that a feature brings, and those that every material has. What only
# a GBuffer or the diffusion pass reads is not here.
MEMBERS = {0: [("v3", "diffuse_color"), ("v3", "fresnel0"), ("f", "perceptual_roughness"),
               ("v3", "normal"), ("f", "ambient_occlusion"), ("f", "specular_occlusion")],
           2: [("v3", "transmittance"), ("u", "features")],
           4: [("v3", "tangent"), ("v3", "bitangent"), ("f", "anisotropy")],
           8: [("f", "film_mask"), ("f", "film_ior"), ("f", "film_thickness_nm")],
           16: [("f", "coat_mask"), ("f", "coat_perceptual_roughness"), ("v3", "coat_normal")],
           32: [("f", "transmission"), ("f", "ior"), ("f", "volume_thickness_m")]}
# A member that two features need.
ALSO = {"transmittance": 2 | 32, "features": 2, "tangent": 4 | 256, "bitangent": 4 | 256}

LIT_BUFFERS = """
layout(std430, binding = 0) readonly buffer Values { float values[]; };
layout(std430, binding = 1) writeonly buffer Results { vec4 results[]; };
layout(std430, binding = 2) readonly buffer Lights { vec4 lights[]; };
layout(binding = 3) uniform samplerCube sky;
layout(push_constant) uniform Push { uint first_count; uint second_count; };
"""

LIT_MAIN = """
void main()
{{
    uint i = gl_GlobalInvocationID.x;
    uint at = i * {stride}u;
    hdrp_brdf_data d;
    vec3 v = vec3(values[at], values[at + 1u], values[at + 2u]);
{load}{mask}    float n_dot_v = hdrp_v3_dot(d.normal, v);
    hdrp_brdf_fgd fgd = hdrp_brdf_fgd_fast(n_dot_v, d.perceptual_roughness);
    hdrp_brdf_lit_view w = hdrp_brdf_lit_view_make(d, v, fgd, features);
    vec3 diffuse = vec3(0.0);
    vec3 specular = vec3(0.0);
{body}    results[2u * i] = vec4(diffuse, 0.0);
    results[2u * i + 1u] = vec4(specular, 0.0);
}}
"""
# Each light is a direction and an illuminance.
LIGHT_LOOP = """    for (uint k = {begin}; k < {end}; ++k) {{
        vec3 l = lights[2u * k].xyz;
        vec3 lux = lights[2u * k + 1u].xyz;
        hdrp_brdf_lit r = hdrp_brdf_lit_eval(d, w, l, features);
        diffuse += r.diffuse * lux;
        specular += r.specular * lux;
    }}
"""
ONE_LOOP = LIGHT_LOOP.format(begin="0u", end="first_count")
TWO_LOOPS = ONE_LOOP + LIGHT_LOOP.format(begin="first_count", end="second_count")
ENVIRONMENT = """    hdrp_brdf_lit_env e = hdrp_brdf_lit_env_make(d, w, features);
    diffuse += e.diffuse_weight * textureLod(sky, d.normal, 7.0).xyz;
    specular += e.specular_weight * textureLod(sky, e.specular_direction,
                                               6.0 * e.specular_perceptual_roughness).xyz;
    if ((features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u) {
        specular += e.coat_weight * textureLod(sky, e.coat_direction,
                                               6.0 * e.coat_perceptual_roughness).xyz;
    }
    if ((features & HDRP_BRDF_FEATURE_TRANSMISSION) != 0u) {
        diffuse += e.through_weight * textureLod(sky, -d.normal, 7.0).xyz;
    }
    if ((features & HDRP_BRDF_FEATURE_REFRACTION) != 0u) {
        specular += e.transmitted_weight * textureLod(sky, e.transmitted_direction,
                                                      6.0 * e.transmitted_perceptual_roughness).xyz;
    }
"""
BODIES = {"lit": ONE_LOOP, "lit_light": TWO_LOOPS, "lit_env": ENVIRONMENT}


def mask_of(variant):
    """The mask of a variant such as coat+anisotropy."""
    return sum(FEATURES[word] for word in variant.split("+") if word != "standard")


def load_data(mask):
    """Statements that load a material; what no feature of the mask needs is 0."""
    lines, offset = [], 3
    for feature, members in MEMBERS.items():
        for kind, name in members:
            size = 3 if kind == "v3" else 1
            terms = [f"values[at + {offset + k}u]" for k in range(size)]
            offset += size
            needed = feature == 0 or mask & ALSO.get(name, feature)
            if kind == "v3":
                value = f"vec3({', '.join(terms)})" if needed else "vec3(0.0)"
            elif kind == "u":
                value = f"floatBitsToUint({terms[0]})" if needed else "0u"
            else:
                value = terms[0] if needed else "0.0"
            lines.append(f"    d.{name} = {value};\n")
    lines += ["    d.base_color = vec3(0.0);\n", "    d.metallic = 0.0;\n",
              "    d.subsurface_mask = 0.0;\n", "    d.diffusion_profile = 0u;\n",
              "    d.thickness = 0.0;\n"]
    return "".join(lines), offset


ALL = sum(FEATURES.values())


def lit_text(kind, define, load_mask=ALL, mask_statement="", include='#include "hdrp_brdf.h"'):
    load, stride = load_data(load_mask)
    text = PRELUDE.format(include=include) + define + LIT_BUFFERS
    return text + LIT_MAIN.format(load=load, stride=stride, mask=mask_statement, body=BODIES[kind])


def lit_name(kind, variant):
    return f"{kind}:{variant}"


def lit_module(kind, variants):
    """As a user writes it: the mask is a specialization constant."""
    define = "layout(constant_id = 0) const uint features = 0u;\n"
    return Module(kind, lit_text(kind, define),
                  [Shader(lit_name(kind, variant), mask=str(mask_of(variant)))
                   for variant in variants])


def lit_module_constant(kind, variant):
    """The mask is a constant of the text."""
    name = lit_name(kind, variant) + ":constant"
    define = f"const uint features = {mask_of(variant)}u;\n"
    return Module(name, lit_text(kind, define), [Shader(name)])


def lit_module_run_time(kind):
    """The mask comes from the material."""
    name = lit_name(kind, RUN_TIME)
    statement = "    uint features = d.features & HDRP_BRDF_FEATURE_ALL;\n"
    return Module(name, lit_text(kind, "", ALL, statement), [Shader(name)])


def lit_module_without(kind, variant, root):
    """The code of absent features is deleted from the headers and from the shader, and their data
    is not loaded."""
    name = lit_name(kind, variant) + ":without"
    mask = mask_of(variant)
    headers = [hdrp_api.header(pathlib.Path(root, header)).code  # comments are blank in it
               for header in ("hdrp_math.h", "hdrp_brdf_lobes.h", "hdrp_brdf.h")]
    include = re.sub(r'#include "[^"]*"', "", "\n".join(headers))
    text = lit_text(kind, f"const uint features = {mask}u;\n", mask, include=include)
    return Module(name, without_features(text, mask), [Shader(name)])


# ---- text without a feature --------------------------------------------------------------------

TEST = re.compile(r"\(features & (?P<macro>HDRP_BRDF_\w+)\) != 0u")


def without_features(text, mask):
    """The text without the branches that need a feature which the mask lacks."""
    while True:
        found = next((match for match in TEST.finditer(text)
                      if not MACROS[match["macro"]] & mask), None)
        if not found:
            return text
        text = cut_branch(text, found)


def cut_branch(text, test):
    """Deletes what is done where the test, alone or a term of a conjunction, holds."""
    statement = max(text.rfind(mark, 0, test.start()) for mark in ";{}")
    branch = re.compile(r"\s*(?P<else>else )?if \(").match(text, statement + 1)
    if branch and branch.end() <= test.start():
        opening = branch.end() - 1
        closing = hdrp_api.matching(text, opening, "()")
        if "||" in text[opening:closing]:
            raise SystemExit(f"gcn_shaders.py: no conjunction: {text[opening:closing]}")
        end = hdrp_api.matching(text, text.index("{", closing), "{}") + 1
        other = re.compile(r"\s*else\b").match(text, end)
        if other and not branch["else"]:
            end = other.end()
        return text[:statement + 1] + text[end:]
    ternary = re.compile(r"\s*\?").match(text, test.end())
    if not ternary:
        raise SystemExit(f"gcn_shaders.py: neither if nor ?: {text[statement + 1:test.end()]}")
    depth, at = 0, ternary.end()
    while depth > 0 or text[at] != ":":
        depth += (text[at] in "(?") - (text[at] in "):")
        at += 1
    return text[:test.start()] + text[at + 1:]
