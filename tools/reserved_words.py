"""Words that a compiler of some language refuses as an identifier.

Sources: the GLSL 4.50 and GLSL ES 3.10 specifications (section 3.6, keywords and words reserved for
future use), the Direct3D HLSL reference (keywords, reserved words), the Metal Shading Language
specification (attributes and address spaces), the OpenCL C 1.2 specification (section 6.1.9) and
ISO C++11 (2.12). The last list is what windows.h and what it includes define as macros.
"""

GLSL = """
attribute const uniform varying buffer shared coherent volatile restrict readonly writeonly
atomic_uint layout centroid flat smooth noperspective patch sample break continue do for while
switch case default if else subroutine in out inout float double int void bool true false invariant
precise discard return mat2 mat3 mat4 dmat2 dmat3 dmat4 mat2x2 mat2x3 mat2x4 mat3x2 mat3x3 mat3x4
mat4x2 mat4x3 mat4x4 vec2 vec3 vec4 ivec2 ivec3 ivec4 bvec2 bvec3 bvec4 dvec2 dvec3 dvec4 uint
uvec2 uvec3 uvec4 lowp mediump highp precision sampler1D sampler2D sampler3D samplerCube
sampler1DShadow sampler2DShadow samplerCubeShadow sampler1DArray sampler2DArray isampler2D
usampler2D sampler2DRect samplerBuffer image1D image2D image3D imageCube imageBuffer struct common
partition active asm class union enum typedef template this resource goto inline noinline public
static extern external interface long short half fixed unsigned superp input output hvec2 hvec3
hvec4 fvec2 fvec3 fvec4 sampler3DRect filter sizeof cast namespace using main
"""

HLSL = """
AppendStructuredBuffer asm asm_fragment BlendState bool break Buffer ByteAddressBuffer case cbuffer
centroid class column_major compile compile_fragment CompileShader const continue ComputeShader
ConsumeStructuredBuffer default DepthStencilState DepthStencilView discard do double DomainShader
dword else export extern false float for fxgroup GeometryShader groupshared half Hullshader if in
inline inout InputPatch int interface line lineadj linear LineStream matrix min16float min10float
min16int min12int min16uint namespace nointerpolation noperspective NULL out OutputPatch packoffset
pass pixelfragment PixelShader point PointStream precise RasterizerState RenderTargetView return
register row_major RWBuffer RWByteAddressBuffer RWStructuredBuffer RWTexture1D RWTexture2D
RWTexture3D sample sampler SamplerState SamplerComparisonState shared snorm stateblock
stateblock_state static string struct switch StructuredBuffer tbuffer technique technique10
technique11 texture Texture1D Texture1DArray Texture2D Texture2DArray Texture2DMS Texture3D
TextureCube true typedef triangle triangleadj TriangleStream uint uniform unorm unsigned vector
vertexfragment VertexShader void volatile while auto catch char const_cast delete dynamic_cast enum
explicit friend goto long mutable new operator private protected public reinterpret_cast short
signed sizeof static_cast template this throw try typename union using virtual
"""

MSL = """
kernel vertex fragment device constant thread threadgroup threadgroup_imageblock ray_data
object_data half bfloat sampler texture depth visible intersection user position access simdgroup
metal uchar ushort ulong size_t ptrdiff_t packed_float2 packed_float3 packed_float4
"""
# Names of MSL attributes and of the namespace are legal identifiers; only what the compiler or
# SPIRV-Cross must rename stays.
MSL_LEGAL = "depth texture position user visible intersection access metal"

OPENCL = """
kernel global local constant private generic pipe read_only write_only read_write uniform uchar
ushort ulong half quad complex imaginary image1d_t image2d_t image3d_t sampler_t event_t vec_step
"""

CPP = """
alignas alignof and and_eq bitand bitor catch char char16_t char32_t class compl concept const_cast
constexpr decltype delete dynamic_cast explicit export friend long mutable namespace new noexcept
not not_eq nullptr operator or or_eq private protected public register reinterpret_cast requires
short signed sizeof static_assert static_cast template this thread_local throw try typeid typename
union unsigned using virtual wchar_t xor xor_eq restrict goto auto
"""

WINDOWS = "near far min max small hyper interface pascal cdecl IN OUT CONST VOID"

# Vectors and matrices: half2, uint4, float3x4 ...
DIGITS = "1234"
HLSL_SHAPED = {f"{kind}{size}" for kind in "bool int uint half float double".split()
               for size in list(DIGITS) + [f"{a}x{b}" for a in DIGITS for b in DIGITS]}
MSL_SHAPED = {f"{kind}{n}" for kind in "bool char uchar short ushort int uint long ulong half "
              "float bfloat".split() for n in "234"}

LISTS = {
    "GLSL": set(GLSL.split()),
    "HLSL": set(HLSL.split()) | HLSL_SHAPED,
    "MSL": (set(MSL.split()) | MSL_SHAPED) - set(MSL_LEGAL.split()),
    "OpenCL C": set(OPENCL.split()),
    "C++": set(CPP.split()),
    "windows.h": set(WINDOWS.split()),
}

# What the formula layer is written with.
LANGUAGE = set("float int void struct return if else for while do break continue switch case "
               "default".split())


def languages(word):
    """The languages that reserve the word, unless it is one that the formula layer uses."""
    return [] if word in LANGUAGE else [name for name, words in LISTS.items() if word in words]
