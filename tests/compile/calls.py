"""Code that calls every formula of a header, in one text for every language.

Arguments are made from two run-time values and every component of a result is used, so that no
compiler drops a call before it has compiled the function.
"""
import hdrp_api

VECTORS = {"hdrp_v2": ("float", "xy"), "hdrp_v3": ("float", "xyz"), "hdrp_v4": ("float", "xyzw"),
           "hdrp_u32x4": ("hdrp_u32", "xyzw")}
SCALARS = {"float": "x + {0}.0f", "hdrp_u32": "u + {0}u"}


class Calls:
    def __init__(self, structs):
        self.structs = structs  # of all headers: name -> [(type, member)]
        self.count = 0
        self.lines = []

    def scalar(self, kind):
        self.count += 1
        return SCALARS[kind].format(self.count % 100)

    def fill(self, kind, target):
        """Statements that give target, a variable of that type, run-time values."""
        if kind in SCALARS:
            self.lines.append(f"    {target} = {self.scalar(kind)};")
        elif kind in VECTORS:
            component, names = VECTORS[kind]
            values = ", ".join(self.scalar(component) for _ in names)
            self.lines.append(f"    {target} = {kind}_make({values});")
        else:
            for member_kind, member in self.members(kind):
                self.fill(member_kind, f"{target}.{member}")

    def members(self, kind):
        if kind not in self.structs:
            raise SystemExit(f"calls.py: {kind} is no type that C and shaders share")
        return self.structs[kind]

    def leaves(self, kind, value):
        """The scalars inside a value, as float expressions."""
        if kind in VECTORS:
            component, names = VECTORS[kind]
            return [leaf for name in names for leaf in self.leaves(component, f"{value}.{name}")]
        if kind == "float":
            return [value]
        if kind in SCALARS:
            return [f"hdrp_f32_from_u32({value})"]
        return [leaf for member_kind, member in self.members(kind)
                for leaf in self.leaves(member_kind, f"{value}.{member}")]

    def function(self, index, function):
        self.lines.append(f"HDRP_FN float call_{index}(float x, hdrp_u32 u)\n{{")
        arguments = [f"a{i}" for i in range(len(function.parameters))]
        for argument, parameter in zip(arguments, function.parameters):
            self.lines.append(f"    {parameter.type} {argument};")
        self.lines.append(f"    {function.type} r;")
        for argument, parameter in zip(arguments, function.parameters):
            self.fill(parameter.type, argument)
        self.lines.append(f"    r = {function.name}({', '.join(arguments)});")
        self.lines.append(f"    return {' + '.join(self.leaves(function.type, 'r'))};")
        self.lines.append("}")


def text(functions, headers):
    """The code for these functions: call_all(x, u) returns a sum over all results. The headers are
    where their structs may come from."""
    structs = {}
    for path in headers:
        structs.update(hdrp_api.structs(path))
    calls = Calls(structs)
    for index, function in enumerate(functions):
        calls.function(index, function)
    calls.lines.append("HDRP_FN float call_all(float x, hdrp_u32 u)\n{\n    float sum = x;")
    calls.lines += [f"    sum += call_{index}(x + sum, u);" for index in range(len(functions))]
    calls.lines.append("    return sum;\n}")
    return "\n".join(calls.lines) + "\n"
