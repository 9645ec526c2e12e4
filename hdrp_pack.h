/* hdrp_pack.h - bit-level codecs, octahedral normals, and the GBuffer.
 * SPDX-License-Identifier: MIT
 *
 * See hdrp_math.h for the languages, the conventions and the override macros.
 *
 *     hdrp_pack_gbuffer g = hdrp_pack_gbuffer_encode(material, extra);   what a shader writes
 *     hdrp_pack_gbuffer_texel t = hdrp_pack_gbuffer_texel_from_targets(g); what memory then holds
 *     hdrp_brdf_data d = hdrp_pack_gbuffer_decode(hdrp_pack_gbuffer_targets_from_texel(t), 0u);
 *
 * A codec comes in up to two forms. A *code* is the integer that memory holds. A *target value* is
 * the float that a fragment shader writes so that the hardware stores that code; for a UNORM render
 * target of b bits it is code / (2^b - 1). Between two codes Direct3D lets hardware be off by 0.6
 * of a code, and Vulkan only prefers the nearest, so that two devices may store different codes.
 * Where a code is made of several numbers that would change the upper ones. There, target values
 * are exact codes, which every device stores alike; a channel that holds one plain number is left
 * to the hardware to round.
 *
 * Encoders are total: any material or texture value gives a valid code. Decoders are total: any bit
 * pattern gives finite values within their documented range.
 *
 * >>index of the functions, without hdrp_pack_ (written by tools/api_check.py --write)
 *   scalar codecs: unorm_from_float float_from_unorm unorm_target snorm_from_float float_from_snorm
 *       biased_snorm_target float_from_biased_snorm_target srgb8_from_linear linear_from_srgb8
 *       rgba8_from_v4 v4_from_rgba8 srgba8_from_linear linear_from_srgba8
 *   small floats: half_from_float half_from_float_saturated float_from_half r11g11b10f_from_rgb
 *       rgb_from_r11g11b10f
 *   float and integer together: float_uint_code float_uint_from_code float_uint
 *       float_uint_from_target
 *   octahedral normals: oct_snorm_from_normal oct_snorm_from_normal_exact normal_from_oct_snorm
 *       oct_unorm_from_normal oct_unorm_from_normal_exact normal_from_oct_unorm oct24_target
 *       oct24_from_target
 *   tangent frame: angle11_from_tangent tangent_from_angle11 angle11_from_tangent_fast
 *       tangent_from_angle11_fast
 *   normal buffer: normal_buffer_encode normal_buffer_decode
 *   SSS buffer: sss_buffer_encode sss_buffer_decode
 *   GBuffer: gbuffer_features gbuffer_texel_features gbuffer_losses gbuffer_supports gbuffer_encode
 *       gbuffer_decode_features gbuffer_decode gbuffer_decode_extra gbuffer_texel_from_targets
 *       gbuffer_targets_from_texel
 * >>end */
#ifndef HDRP_PACK_H
#define HDRP_PACK_H

#include "hdrp_brdf.h"

#if HDRP_VERSION != 100
#error "hdrp_pack.h 0.1.0 needs the hdrp_math.h of the same version"
#endif

/* >>scalar codecs */

/** A whole number between -2^22 and 2^22 in two's complement of 22 bits. Loops vectorise better so
 *  than with hdrp_u32_from_f32: no x86 before AVX-512 converts to unsigned integers. */
HDRP_FN hdrp_u32 hdrp_i_pack_u32_from_whole(float x)
{
    return hdrp_bits_from_f32(x + 12582912.0f) & 0x3fffffu; /* 1.5 * 2^23 */
}

/** The UNORM code nearest to x.
 *  x        any    value; limited to [0,1]
 *  bits     [0,16] width of the code
 *  returns  [0,65535] code, at most 2^bits - 1
 *  edges    NaN gives 0; 0.5, the only possible tie, rounds up
 *  error    <= 0.5 absolute in codes: correctly rounded for every float  @accuracy pack_unorm_codes
 *  source   Direct3D 11.3 functional specification, "FLOAT -> UNORM"
 *  note     x * (2^bits - 1) would round before it is rounded; x * 2^bits is exact, and so are both
 *           comparisons with its fraction */
HDRP_FN hdrp_u32 hdrp_pack_unorm_from_float(float x, hdrp_u32 bits)
{
    float v = hdrp_saturate(x);
    float scaled = v * hdrp_f32_from_u32(1u << bits);
    float whole = hdrp_floor(scaled);
    float fraction = scaled - whole;
    float up = fraction - 0.5f >= v ? 1.0f : 0.0f;
    float down = fraction < v - 0.5f ? 1.0f : 0.0f;
    return hdrp_i_pack_u32_from_whole(whole + up - down);
}

/** Value of a UNORM code.
 *  code     [0,65535] at most 2^bits - 1
 *  bits     [1,16] width of the code
 *  returns  [0,65535] code / (2^bits - 1), in [0,1] for a code that fits
 *  edges    the largest code is exactly 1
 *  error    <= 0.5 ulp  @accuracy pack_float_from_unorm
 *  source   Direct3D 11.3 functional specification, "UNORM -> FLOAT" */
HDRP_FN float hdrp_pack_float_from_unorm(hdrp_u32 code, hdrp_u32 bits)
{
    return hdrp_f32_from_u32(code) / hdrp_f32_from_u32((1u << bits) - 1u);
}

/** Target value of a UNORM: x rounded to a multiple of 1 / (2^bits - 1).
 *  x        any    value; limited to [0,1]
 *  bits     [1,16] width of the code
 *  returns  [0,1]  what every render target stores without rounding
 *  edges    NaN gives 0
 *  error    none: hdrp_pack_unorm_from_float, then hdrp_pack_float_from_unorm
 *  source   see hdrp_pack_unorm_from_float */
HDRP_FN float hdrp_pack_unorm_target(float x, hdrp_u32 bits)
{
    return hdrp_pack_float_from_unorm(hdrp_pack_unorm_from_float(x, bits), bits);
}

/* Two's complement of a magnitude in the low bits of a word. */
HDRP_FN hdrp_u32 hdrp_i_pack_signed_code(hdrp_u32 magnitude, float sign_of, hdrp_u32 bits)
{
    return (sign_of < 0.0f ? 0u - magnitude : magnitude) & ((1u << bits) - 1u);
}

/* Value of a two's complement code. The most negative one has no counterpart and counts as the
 * next, as in every SNORM format. */
HDRP_FN float hdrp_i_pack_float_from_signed_code(hdrp_u32 code, hdrp_u32 bits)
{
    hdrp_u32 half_range = 1u << (bits - 1u);
    float value = hdrp_f32_from_u32(code & (half_range - 1u));
    float top = hdrp_f32_from_u32(half_range);
    return (code & half_range) != 0u ? hdrp_max(value - top, 1.0f - top) : value;
}

/** The SNORM code nearest to x, in two's complement.
 *  x        any    value; limited to [-1,1]
 *  bits     [2,16] width of the code
 *  returns  [0,65535] code in the low bits
 *  edges    NaN gives 0; 0.5 and -0.5 round away from 0; the most negative code is not used
 *  error    <= 0.5 absolute in codes: correctly rounded for every float  @accuracy pack_snorm_codes
 *  source   Direct3D 11.3 functional specification, "FLOAT -> SNORM" */
HDRP_FN hdrp_u32 hdrp_pack_snorm_from_float(float x, hdrp_u32 bits)
{
    return hdrp_i_pack_signed_code(hdrp_pack_unorm_from_float(hdrp_abs(x), bits - 1u), x, bits);
}

/** Value of an SNORM code in two's complement.
 *  code     any    the low bits are used
 *  bits     [2,16] width of the code
 *  returns  [-1,1] code / (2^(bits - 1) - 1)
 *  edges    the two most negative codes are both -1
 *  error    <= 0.5 ulp  @accuracy pack_float_from_snorm
 *  source   Direct3D 11.3 functional specification, "SNORM -> FLOAT" */
HDRP_FN float hdrp_pack_float_from_snorm(hdrp_u32 code, hdrp_u32 bits)
{
    return hdrp_i_pack_float_from_signed_code(code, bits) /
           hdrp_f32_from_u32((1u << (bits - 1u)) - 1u);
}

/** Target value, for a UNORM target, of a number in [-1,1] whose 0 must stay 0.
 *  x        any    value; limited to [-1,1]
 *  bits     [2,16] width of the target
 *  returns  [0,1]  (2^(bits - 1) + SNORM code) / (2^bits - 1)
 *  edges    NaN gives the value of 0; the lowest code is not used
 *  error    <= 0.00393701 absolute after decoding, 8 bits  @accuracy pack_biased_snorm_8
 *  source   offset binary
 *  note     the usual x / 2 + 1/2 cannot store 0: a UNORM has an even number of codes */
HDRP_FN float hdrp_pack_biased_snorm_target(float x, hdrp_u32 bits)
{
    hdrp_u32 half_range = 1u << (bits - 1u);
    hdrp_u32 code = hdrp_pack_snorm_from_float(x, bits) ^ half_range;
    return hdrp_pack_float_from_unorm(code, bits);
}

/** The number that hdrp_pack_biased_snorm_target stored.
 *  target   any    value of the target; limited to [0,1]
 *  bits     [2,16] width of the target
 *  returns  [-1,1]
 *  edges    NaN gives -1, the two lowest codes both -1
 *  error    none: hdrp_pack_unorm_from_float, then hdrp_pack_float_from_snorm
 *  source   see hdrp_pack_biased_snorm_target */
HDRP_FN float hdrp_pack_float_from_biased_snorm_target(float target, hdrp_u32 bits)
{
    hdrp_u32 half_range = 1u << (bits - 1u);
    return hdrp_pack_float_from_snorm(hdrp_pack_unorm_from_float(target, bits) ^ half_range, bits);
}

/** The 8-bit sRGB code nearest to a linear value.
 *  x        any    linear value; limited to [0,1]
 *  returns  [0,255] code
 *  edges    NaN gives 0
 *  error    <= 0.50002 absolute in codes  @accuracy pack_srgb8_codes
 *  source   IEC 61966-2-1:1999, section 5.3
 *  note     nearest in encoded values, as render targets round */
HDRP_FN hdrp_u32 hdrp_pack_srgb8_from_linear(float x)
{
    return hdrp_pack_unorm_from_float(hdrp_srgb_from_linear(hdrp_saturate(x)), 8u);
}

/** Linear value of an 8-bit sRGB code.
 *  code     [0,255]
 *  returns  [0,1]  linear value
 *  edges    0 and 255 are exactly 0 and 1
 *  error    <= 5e-7 relative  @accuracy pack_linear_from_srgb8
 *  source   IEC 61966-2-1:1999, section 5.2 */
HDRP_FN float hdrp_pack_linear_from_srgb8(hdrp_u32 code)
{
    return hdrp_linear_from_srgb(hdrp_pack_float_from_unorm(code & 255u, 8u));
}

/** RGBA8 UNORM texel; red in the low byte.
 *  v        any    each component limited to [0,1]
 *  returns  any    the four codes
 *  edges    NaN gives 0
 *  error    none: four times hdrp_pack_unorm_from_float
 *  source   Vulkan specification, VK_FORMAT_R8G8B8A8_UNORM on a little-endian host */
HDRP_FN hdrp_u32 hdrp_pack_rgba8_from_v4(hdrp_v4 v)
{
    return hdrp_pack_unorm_from_float(v.x, 8u) | (hdrp_pack_unorm_from_float(v.y, 8u) << 8u) |
           (hdrp_pack_unorm_from_float(v.z, 8u) << 16u) |
           (hdrp_pack_unorm_from_float(v.w, 8u) << 24u);
}

/** Values of an RGBA8 UNORM texel.
 *  texel    any    red in the low byte
 *  returns  [0,1]
 *  edges    none
 *  error    none: four times hdrp_pack_float_from_unorm
 *  source   Vulkan specification, VK_FORMAT_R8G8B8A8_UNORM on a little-endian host */
HDRP_FN hdrp_v4 hdrp_pack_v4_from_rgba8(hdrp_u32 texel)
{
    return hdrp_v4_make(hdrp_pack_float_from_unorm(texel & 255u, 8u),
                        hdrp_pack_float_from_unorm((texel >> 8u) & 255u, 8u),
                        hdrp_pack_float_from_unorm((texel >> 16u) & 255u, 8u),
                        hdrp_pack_float_from_unorm(texel >> 24u, 8u));
}

/** RGBA8 sRGB texel of a linear colour with a plain alpha; red in the low byte.
 *  v        any    each component limited to [0,1]
 *  returns  any    the four codes
 *  edges    NaN gives 0
 *  error    none: hdrp_pack_srgb8_from_linear, and hdrp_pack_unorm_from_float for alpha
 *  source   Vulkan specification, VK_FORMAT_R8G8B8A8_SRGB on a little-endian host */
HDRP_FN hdrp_u32 hdrp_pack_srgba8_from_linear(hdrp_v4 v)
{
    return hdrp_pack_srgb8_from_linear(v.x) | (hdrp_pack_srgb8_from_linear(v.y) << 8u) |
           (hdrp_pack_srgb8_from_linear(v.z) << 16u) | (hdrp_pack_unorm_from_float(v.w, 8u) << 24u);
}

/** Linear colour and alpha of an RGBA8 sRGB texel.
 *  texel    any    red in the low byte
 *  returns  [0,1]
 *  edges    none
 *  error    none: hdrp_pack_linear_from_srgb8, and hdrp_pack_float_from_unorm for alpha
 *  source   Vulkan specification, VK_FORMAT_R8G8B8A8_SRGB on a little-endian host */
HDRP_FN hdrp_v4 hdrp_pack_linear_from_srgba8(hdrp_u32 texel)
{
    return hdrp_v4_make(hdrp_pack_linear_from_srgb8(texel & 255u),
                        hdrp_pack_linear_from_srgb8((texel >> 8u) & 255u),
                        hdrp_pack_linear_from_srgb8((texel >> 16u) & 255u),
                        hdrp_pack_float_from_unorm(texel >> 24u, 8u));
}

/* >>small floats
 * Half, and the 11- and 10-bit channels of R11G11B10F: five exponent bits, bias 15, and 10, 6 or 5
 * mantissa bits. Integer arithmetic but for one addition, which rounds what becomes denormal: it
 * wants rounding to nearest, as every GPU has it, and neither sees nor makes denormal floats. */

/* Rounds the bits of a finite float >= 0 to such a format, to nearest with ties to even. Too large
 * a value gives the code of infinity or one above it. */
HDRP_FN hdrp_u32 hdrp_i_pack_small_float(hdrp_u32 magnitude, hdrp_u32 mantissa_bits)
{
    hdrp_u32 drop = 23u - mantissa_bits;
    hdrp_u32 odd = (magnitude >> drop) & 1u;
    /* The exponent is re-biased by 112. */
    hdrp_u32 normal = (magnitude - 0x38000000u + ((1u << (drop - 1u)) - 1u) + odd) >> drop;
    /* Below 2^-14, exponent 113, the result is a fixed-point number, whose last bit is worth
     * 2^(-14 - mantissa_bits): that of a float whose exponent is 23 larger. */
    hdrp_u32 aligner = (136u - mantissa_bits) << 23u;
    float aligned = hdrp_f32_from_bits(magnitude) + hdrp_f32_from_bits(aligner);
    return magnitude < 0x38800000u ? hdrp_bits_from_f32(aligned) - aligner : normal;
}

HDRP_FN float hdrp_i_pack_float_from_small(hdrp_u32 code, hdrp_u32 mantissa_bits)
{
    hdrp_u32 exponent = code >> mantissa_bits;
    hdrp_u32 aligned = code << (23u - mantissa_bits);
    /* Exponents are re-biased by 112; that of infinity and NaN goes from 31 to 255. */
    float normal = hdrp_f32_from_bits(aligned + (exponent == 31u ? 0x70000000u : 0x38000000u));
    float denormal_unit = hdrp_f32_from_bits((113u - mantissa_bits) << 23u);
    return exponent == 0u ? hdrp_f32_from_u32(code) * denormal_unit : normal;
}

/* The code of one unsigned channel, see hdrp_pack_r11g11b10f_from_rgb. It takes differences whose
 * highest bit says which number is larger: of so many selections compilers make branches. */
HDRP_FN hdrp_u32 hdrp_i_pack_unsigned_float(float x, hdrp_u32 mantissa_bits)
{
    hdrp_u32 bits = hdrp_bits_from_f32(x);
    hdrp_u32 magnitude = bits & 0x7fffffffu;
    hdrp_u32 largest = 0x47800000u - (1u << (23u - mantissa_bits));
    hdrp_u32 finite =
        hdrp_i_pack_small_float(magnitude < largest ? magnitude : largest, mantissa_bits);
    hdrp_u32 not_finite = (0x7f7fffffu - magnitude) >> 31u;
    hdrp_u32 nan = (0x7f800000u - magnitude) >> 31u;
    hdrp_u32 kept = ((bits >> 31u) - 1u) | (0u - nan);
    /* The code of infinity is the next after the largest number. */
    return ((finite + not_finite) & kept) | (nan << (mantissa_bits - 1u));
}

HDRP_FN hdrp_u32 hdrp_i_pack_half(float x, hdrp_u32 overflow)
{
    hdrp_u32 bits = hdrp_bits_from_f32(x);
    hdrp_u32 magnitude = bits & 0x7fffffffu;
    hdrp_u32 rounded = hdrp_i_pack_small_float(magnitude, 10u);
    hdrp_u32 number = rounded < overflow ? rounded : overflow;
    /* A quiet NaN keeps the upper bits of its payload. */
    hdrp_u32 nan = 0x7e00u | ((magnitude >> 13u) & 0x3ffu);
    return ((bits >> 16u) & 0x8000u) | (magnitude > 0x7f800000u ? nan : number);
}

/** Half-precision code of x, rounded to nearest with ties to even.
 *  x        any    number, infinity or NaN
 *  returns  [0,65535] IEEE 754 binary16
 *  edges    from 65520 on infinity; below 2^-14 denormal, up to 2^-25 zero; the sign of zero is
 *           kept; NaN gives a quiet NaN of the same sign and upper payload
 *  error    <= 4.8829e-4 relative in [2^-14,65520)  @accuracy pack_half
 *  error    <= 2.9803e-8 absolute below 2^-14  @accuracy pack_half_denormal
 *  source   IEEE 754-2008, sections 3.6 and 4.3.1 */
HDRP_FN hdrp_u32 hdrp_pack_half_from_float(float x)
{
    return hdrp_i_pack_half(x, 0x7c00u);
}

/** hdrp_pack_half_from_float without infinities: the recommended form for light.
 *  x        any    number, infinity or NaN
 *  returns  [0,65535] IEEE 754 binary16
 *  edges    from 65520 on, and at infinity, 65504 with the sign of x; NaN stays NaN
 *  error    none: hdrp_pack_half_from_float where that is finite
 *  source   IEEE 754-2008, sections 3.6 and 4.3.1 */
HDRP_FN hdrp_u32 hdrp_pack_half_from_float_saturated(float x)
{
    return hdrp_i_pack_half(x, 0x7bffu);
}

/** Value of a half-precision code.
 *  code     any    IEEE 754 binary16 in the low 16 bits
 *  returns  any    the same value, infinity or NaN
 *  edges    denormals and the sign of zero are kept
 *  error    none: exact
 *  source   IEEE 754-2008, section 3.4 */
HDRP_FN float hdrp_pack_float_from_half(hdrp_u32 code)
{
    float magnitude = hdrp_i_pack_float_from_small(code & 0x7fffu, 10u);
    return hdrp_f32_from_bits(hdrp_bits_from_f32(magnitude) | ((code & 0x8000u) << 16u));
}

/** R11G11B10F texel, rounded to nearest with ties to even; red in the low bits.
 *  rgb      any    colour
 *  returns  any    VK_FORMAT_B10G11R11_UFLOAT_PACK32, DXGI_FORMAT_R11G11B10_FLOAT
 *  edges    negative numbers and -infinity give 0; finite numbers above 65024 (red, green) or 64512
 *           (blue) give that number; infinity and NaN of either sign stay what they are
 *  error    <= 0.0077520 relative for red and green in [2^-14,65024]  @accuracy pack_r11
 *  error    <= 0.0153847 relative for blue in [2^-14,64512]  @accuracy pack_b10
 *  source   Vulkan specification, "Unsigned 11-Bit Floating-Point Numbers" and the 10-bit section
 *  note     hardware may also round towards 0, which darkens by half a step and blue most; a shader
 *           that wants this function's result everywhere writes to an R32_UINT target */
HDRP_FN hdrp_u32 hdrp_pack_r11g11b10f_from_rgb(hdrp_v3 rgb)
{
    return hdrp_i_pack_unsigned_float(rgb.x, 6u) | (hdrp_i_pack_unsigned_float(rgb.y, 6u) << 11u) |
           (hdrp_i_pack_unsigned_float(rgb.z, 5u) << 22u);
}

/** Colour of an R11G11B10F texel.
 *  texel    any    red in the low bits
 *  returns  any    never negative; infinity and NaN as they are
 *  edges    denormals are kept
 *  error    none: exact
 *  source   Vulkan specification, "Unsigned 11-Bit Floating-Point Numbers" and the 10-bit
 *           section */
HDRP_FN hdrp_v3 hdrp_pack_rgb_from_r11g11b10f(hdrp_u32 texel)
{
    return hdrp_v3_make(hdrp_i_pack_float_from_small(texel & 2047u, 6u),
                        hdrp_i_pack_float_from_small((texel >> 11u) & 2047u, 6u),
                        hdrp_i_pack_float_from_small(texel >> 22u, 5u));
}

/* >>float and integer together
 * One UNORM channel of bits_target bits that holds an integer in its upper bits_i bits and a float
 * in [0,1] in the rest. */

struct hdrp_pack_float_uint_pair {
    float f;    /* [0,1] */
    hdrp_u32 i; /* [0,65535] below 2^bits_i */
};
HDRP_TYPEDEF(hdrp_pack_float_uint_pair)

/* Bits left for the float; 0 where the integer takes all. */
HDRP_FN hdrp_u32 hdrp_i_pack_float_bits(hdrp_u32 bits_i, hdrp_u32 bits_target)
{
    return bits_i < bits_target ? bits_target - bits_i : 0u;
}

/** Code of a float and an integer in one channel.
 *  f            any    value; limited to [0,1]
 *  i            any    integer; bits beyond bits_i are dropped
 *  bits_i       [0,16] width of the integer in bits, not its number of values; at most bits_target
 *  bits_target  [1,16] width of the channel
 *  returns      [0,65535] i << (bits_target - bits_i) | UNORM code of f
 *  edges        NaN counts as f = 0
 *  error        <= 0.0161291 absolute in f, 3 of 8 bits  @accuracy pack_float_uint_3_of_8
 *  error        <= 0.0333334 absolute in f, 4 of 8 bits  @accuracy pack_float_uint_4_of_8
 *  source       Lagarde 2018, "GBuffer helper - Packing integer and float together" */
HDRP_FN hdrp_u32 hdrp_pack_float_uint_code(float f, hdrp_u32 i, hdrp_u32 bits_i,
                                           hdrp_u32 bits_target)
{
    hdrp_u32 bits_f = hdrp_i_pack_float_bits(bits_i, bits_target);
    return hdrp_pack_unorm_from_float(f, bits_f) | ((i << bits_f) & ((1u << bits_target) - 1u));
}

/** Float and integer of a code of hdrp_pack_float_uint_code.
 *  code         any    bits beyond bits_target are dropped
 *  bits_i       [0,16] as encoded
 *  bits_target  [1,16] as encoded
 *  returns      valid
 *  edges        f is 0 where no bits are left for it
 *  error        none: the integer is exact for every code, f is hdrp_pack_float_from_unorm
 *  source       Lagarde 2018, "GBuffer helper - Packing integer and float together" */
HDRP_FN hdrp_pack_float_uint_pair hdrp_pack_float_uint_from_code(hdrp_u32 code, hdrp_u32 bits_i,
                                                                 hdrp_u32 bits_target)
{
    hdrp_pack_float_uint_pair pair;
    hdrp_u32 bits_f = hdrp_i_pack_float_bits(bits_i, bits_target);
    hdrp_u32 last = (1u << bits_f) - 1u;
    pair.f = hdrp_f32_from_u32(code & last) / hdrp_f32_from_u32(last == 0u ? 1u : last);
    pair.i = (code & ((1u << bits_target) - 1u)) >> bits_f;
    return pair;
}

/** Target value of a float and an integer in one channel.
 *  f            any    value; limited to [0,1]
 *  i            any    integer; bits beyond bits_i are dropped
 *  bits_i       [0,16] width of the integer in bits, not its number of values; at most bits_target
 *  bits_target  [1,16] width of the UNORM render target
 *  returns      [0,1]  what to write to the render target
 *  edges        NaN counts as f = 0
 *  error        none: hdrp_pack_float_uint_code, then hdrp_pack_float_from_unorm
 *  source       Lagarde 2018, "GBuffer helper - Packing integer and float together"
 *  note         the slides of the same author pass the number of values, 8, where this takes 3; 8
 *               bits of 8 leave none for the float, which divides by 0 there. The post leaves f to
 *               the hardware to round and then needs an epsilon on decoding, without which up to
 *               half of all codes lose one in the integer; whole codes need none */
HDRP_FN float hdrp_pack_float_uint(float f, hdrp_u32 i, hdrp_u32 bits_i, hdrp_u32 bits_target)
{
    return hdrp_pack_float_from_unorm(hdrp_pack_float_uint_code(f, i, bits_i, bits_target),
                                      bits_target);
}

/** Float and integer of a target value of hdrp_pack_float_uint.
 *  value        any    what the render target returned; limited to [0,1]
 *  bits_i       [0,16] as encoded
 *  bits_target  [1,16] as encoded
 *  returns      valid
 *  edges        NaN counts as 0
 *  error        none: exact for every code of every split
 *  source       Lagarde 2018, "GBuffer helper - Packing integer and float together" */
HDRP_FN hdrp_pack_float_uint_pair hdrp_pack_float_uint_from_target(float value, hdrp_u32 bits_i,
                                                                   hdrp_u32 bits_target)
{
    return hdrp_pack_float_uint_from_code(hdrp_pack_unorm_from_float(value, bits_target), bits_i,
                                          bits_target);
}

/* >>octahedral normals
 * The unit sphere on a square (Meyer et al. 2010), x and y quantised alike to `bits` each.
 *
 * SNORM codes hold the six axes exactly and spend one code of 2^bits; UNORM codes use them all and
 * miss every axis by half a step. Both coordinates are multiples of a half in units of a code step,
 * so that decoding is exact up to the final normalisation, and the sign of z is a comparison of
 * integers.
 *
 * Encoders never change the sign of z (z = -0 counts as positive, and so does a z that decodes as
 * 0): hdrp_basis_from_normal of a decoded normal is then close to that of the original, where else
 * it would be mirrored for normals near the equator. Where plain rounding would cross the equator,
 * the coordinate that loses less goes to the next code. One step is always enough, and costs
 * nothing in the worst case, because the map is finest there: at 12 bits the error within a step of
 * the equator is at most 0.0362 degrees for UNORM and 0.0507 for SNORM, against 0.0594 for plain
 * rounding in the middle of a face. */

/* Magnitudes of the octahedral coordinates in code steps; scale is that of coordinate 1. The
 * division comes last: nothing here can be contracted, and codes are the same in every build. */
HDRP_FN hdrp_v2 hdrp_i_pack_oct_project(hdrp_v3 n, float scale)
{
    float l1 = hdrp_abs(n.x) + hdrp_abs(n.y) + hdrp_abs(n.z);
    float x = hdrp_abs(n.x) * scale / l1;
    float y = hdrp_abs(n.y) * scale / l1;
    /* A rounded quotient can exceed scale by an ulp. */
    return hdrp_v2_make(hdrp_abs(n.z < 0.0f ? scale - y : x), hdrp_abs(n.z < 0.0f ? scale - x : y));
}

/* code, or the one of +Z where n has no direction that survives a sum of its components. */
HDRP_FN hdrp_u32 hdrp_i_pack_oct_known(hdrp_u32 code, hdrp_v3 n, hdrp_u32 code_up)
{
    float l1 = hdrp_abs(n.x) + hdrp_abs(n.y) + hdrp_abs(n.z);
    hdrp_u32 known = l1 <= 1e30f ? code : code_up;
    return l1 >= 1e-30f ? known : code_up;
}

/* 1 where the code with these magnitudes is below the equator, else 0. A code is magnitude + offset
 * steps from the middle; the equator is where both sum to last + offset. */
HDRP_FN float hdrp_i_pack_oct_below(float x, float y, float last, float offset)
{
    return x + y > last - offset ? 1.0f : 0.0f;
}

/* The magnitudes nearest to p, each in [0,last], on the side of the equator that n_z tells. */
HDRP_FN hdrp_v2 hdrp_i_pack_oct_round(hdrp_v2 p, float n_z, float last, float offset)
{
    float x = hdrp_floor(p.x + (0.5f - offset));
    float y = hdrp_floor(p.y + (0.5f - offset));
    float move = (n_z < 0.0f ? 1.0f : 0.0f) - hdrp_i_pack_oct_below(x, y, last, offset);
    /* How much farther p lies on that side in x than in y; at the corners of the square, where one
     * of them has no next code, the other goes. */
    float corner = move * (x - y);
    float gain = move * ((p.x - p.y) - (x - y));
    gain = corner >= last ? -1.0f : gain;
    gain = corner <= -last ? 1.0f : gain;
    return hdrp_v2_make(x + (gain >= 0.0f ? move : 0.0f), y + (gain >= 0.0f ? 0.0f : move));
}

/* The vector, of any length, at a signed point of the square. */
HDRP_FN hdrp_v3 hdrp_i_pack_oct_unfold(hdrp_v2 p, float scale)
{
    float z = scale - hdrp_abs(p.x) - hdrp_abs(p.y);
    float fold = hdrp_max(-z, 0.0f);
    return hdrp_v3_make(p.x - hdrp_sign_not_zero(p.x) * fold, p.y - hdrp_sign_not_zero(p.y) * fold,
                        z);
}

/* Squared sine of the angle between a code and n, times |n|^2. n.x and n.y count as positive. */
HDRP_FN float hdrp_i_pack_oct_error(hdrp_v2 code, hdrp_v3 n, float last, float offset)
{
    hdrp_v2 p = hdrp_v2_make(code.x + offset, code.y + offset);
    hdrp_v3 d = hdrp_i_pack_oct_unfold(p, last + offset);
    hdrp_v3 c = hdrp_v3_cross(d, hdrp_v3_make(hdrp_abs(n.x), hdrp_abs(n.y), n.z));
    return hdrp_v3_dot(c, c) / hdrp_v3_dot(d, d);
}

/* best, a code and its error, or another code where that is on the right side and nearer to n. */
HDRP_FN hdrp_v3 hdrp_i_pack_oct_nearer(hdrp_v3 best, float x, float y, hdrp_v3 n, float last,
                                       float offset)
{
    float cx = hdrp_clamp(x, 0.0f, last);
    float cy = hdrp_clamp(y, 0.0f, last);
    float below = hdrp_i_pack_oct_below(cx, cy, last, offset);
    float error = hdrp_i_pack_oct_error(hdrp_v2_make(cx, cy), n, last, offset);
    float other = n.z < 0.0f ? 1.0f - below : below;
    float limit = other > 0.0f ? 0.0f : best.z;
    return hdrp_v3_make(error < limit ? cx : best.x, error < limit ? cy : best.y,
                        error < limit ? error : best.z);
}

/* The best of the four codes around p, and of the rounded one, which has the right side for sure.
 * Written out, because compilers unroll loops only after they have vectorised the one around. */
HDRP_FN hdrp_v2 hdrp_i_pack_oct_search(hdrp_v2 p, hdrp_v3 n, float last, float offset)
{
    hdrp_v2 r = hdrp_i_pack_oct_round(p, n.z, last, offset);
    hdrp_v3 best = hdrp_v3_make(r.x, r.y, hdrp_i_pack_oct_error(r, n, last, offset));
    float x = hdrp_floor(p.x - offset);
    float y = hdrp_floor(p.y - offset);
    best = hdrp_i_pack_oct_nearer(best, x, y, n, last, offset);
    best = hdrp_i_pack_oct_nearer(best, x + 1.0f, y, n, last, offset);
    best = hdrp_i_pack_oct_nearer(best, x, y + 1.0f, n, last, offset);
    best = hdrp_i_pack_oct_nearer(best, x + 1.0f, y + 1.0f, n, last, offset);
    return hdrp_v2_make(best.x, best.y);
}

/* A magnitude with the sign of another number. */
HDRP_FN float hdrp_i_pack_with_sign(float magnitude, float sign_of)
{
    return hdrp_f32_from_bits(hdrp_bits_from_f32(magnitude) |
                              (hdrp_bits_from_f32(sign_of) & 0x80000000u));
}

/* Both coordinates in two's complement. */
HDRP_FN hdrp_u32 hdrp_i_pack_oct_snorm_code(hdrp_v2 code, hdrp_v3 n, hdrp_u32 bits)
{
    hdrp_u32 mask = (1u << bits) - 1u;
    hdrp_u32 x = hdrp_i_pack_u32_from_whole(hdrp_i_pack_with_sign(code.x, n.x)) & mask;
    hdrp_u32 y = hdrp_i_pack_u32_from_whole(hdrp_i_pack_with_sign(code.y, n.y)) & mask;
    return hdrp_i_pack_oct_known(x | (y << bits), n, 0u);
}

/* A whole magnitude and half a step more on the side of 0 that a sign tells, counted from -1. In
 * integers, since shader compilers regroup sums of floats, and half a step is lost next to the
 * constant that hdrp_i_pack_u32_from_whole adds. */
HDRP_FN hdrp_u32 hdrp_i_pack_oct_counted(float magnitude, float sign_of, hdrp_u32 middle)
{
    hdrp_u32 negative = 0u - (hdrp_bits_from_f32(sign_of) >> 31);
    return middle + (hdrp_i_pack_u32_from_whole(magnitude) ^ negative); /* ~m is -1 - m */
}

/* Both coordinates counted from -1. */
HDRP_FN hdrp_u32 hdrp_i_pack_oct_unorm_code(hdrp_v2 code, hdrp_v3 n, hdrp_u32 bits)
{
    hdrp_u32 middle = 1u << (bits - 1u);
    hdrp_u32 x = hdrp_i_pack_oct_counted(code.x, n.x, middle);
    hdrp_u32 y = hdrp_i_pack_oct_counted(code.y, n.y, middle);
    return hdrp_i_pack_oct_known(x | (y << bits), n, middle | (middle << bits));
}

/* The largest magnitude of a code. */
HDRP_FN float hdrp_i_pack_oct_last(hdrp_u32 bits)
{
    return hdrp_f32_from_u32((1u << (bits - 1u)) - 1u);
}

/** Octahedral code of a normal, SNORM: the recommended one, in which the axes are exact.
 *  n        any    normal of any length in [1e-30,1e30]
 *  bits     [2,16] of each coordinate
 *  returns  any    x in the low bits, y in the next, both in two's complement
 *  edges    a zero, NaN or infinite n gives +Z, code 0; the sign of z survives
 *  error    <= 0.0595 degrees at 12 bits  @accuracy pack_oct_snorm_12
 *  error    <= 0.96 degrees at 8 bits  @accuracy pack_oct_snorm_8
 *  error    <= 0.0038 degrees at 16 bits  @accuracy pack_oct_snorm_16
 *  source   Meyer et al. 2010, "On Floating-Point Normal Vectors", section 3.2; Cigolle et al.
 *           2014, "A Survey of Efficient Representations for Independent Unit Vectors", listing
 *           1 */
HDRP_FN hdrp_u32 hdrp_pack_oct_snorm_from_normal(hdrp_v3 n, hdrp_u32 bits)
{
    float last = hdrp_i_pack_oct_last(bits);
    hdrp_v2 p = hdrp_i_pack_oct_project(n, last);
    return hdrp_i_pack_oct_snorm_code(hdrp_i_pack_oct_round(p, n.z, last, 0.0f), n, bits);
}

/** Octahedral code of a normal, SNORM, the best of the codes around it.
 *  n        any    normal of any length in [1e-15,1e15]
 *  bits     [2,16] of each coordinate
 *  returns  any    as hdrp_pack_oct_snorm_from_normal
 *  edges    a zero, NaN or infinite n gives +Z, code 0; the sign of z survives
 *  error    <= 0.0507 degrees at 12 bits  @accuracy pack_oct_snorm_exact_12
 *  error    <= 0.040 degrees at 12 bits, except where z is in (-1e-3,0)
 *           @accuracy pack_oct_snorm_exact_12_away
 *  error    <= 0.82 degrees at 8 bits  @accuracy pack_oct_snorm_exact_8
 *  error    <= 0.0032 degrees at 16 bits  @accuracy pack_oct_snorm_exact_16
 *  source   Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit
 *           Vectors", listing 4 (precise encoding)
 *  note     codes with z = 0 are taken as positive, so that a z just below 0 has to go one step
 *           down: UNORM, which has no such codes, is better there */
HDRP_FN hdrp_u32 hdrp_pack_oct_snorm_from_normal_exact(hdrp_v3 n, hdrp_u32 bits)
{
    float last = hdrp_i_pack_oct_last(bits);
    hdrp_v2 p = hdrp_i_pack_oct_project(n, last);
    return hdrp_i_pack_oct_snorm_code(hdrp_i_pack_oct_search(p, n, last, 0.0f), n, bits);
}

/** Unit normal of an SNORM octahedral code.
 *  code     any    x in the low bits, y in the next, both in two's complement
 *  bits     [2,16] of each coordinate
 *  returns  unit   normal
 *  edges    every code is a normal; the most negative coordinate counts as the next
 *  error    <= 1.8e-7 absolute, per component  @accuracy pack_normal_from_oct_snorm
 *  source   Meyer et al. 2010, "On Floating-Point Normal Vectors", section 3.2 */
HDRP_FN hdrp_v3 hdrp_pack_normal_from_oct_snorm(hdrp_u32 code, hdrp_u32 bits)
{
    hdrp_v2 p = hdrp_v2_make(hdrp_i_pack_float_from_signed_code(code, bits),
                             hdrp_i_pack_float_from_signed_code(code >> bits, bits));
    return hdrp_v3_normalize(hdrp_i_pack_oct_unfold(p, hdrp_i_pack_oct_last(bits)));
}

/** Octahedral code of a normal, UNORM.
 *  n        any    normal of any length in [1e-30,1e30]
 *  bits     [2,16] of each coordinate
 *  returns  any    x in the low bits, y in the next, both counted from -1
 *  edges    a zero, NaN or infinite n counts as +Z, which itself is half a step off; the sign of z
 *           survives
 *  error    <= 0.0595 degrees at 12 bits  @accuracy pack_oct_unorm_12
 *  error    <= 0.96 degrees at 8 bits  @accuracy pack_oct_unorm_8
 *  error    <= 0.0038 degrees at 16 bits  @accuracy pack_oct_unorm_16
 *  source   Meyer et al. 2010, "On Floating-Point Normal Vectors", section 3.2; Cigolle et al.
 *           2014, "A Survey of Efficient Representations for Independent Unit Vectors", listing 1
 *  note     truncating, as floor(u * 4095.5) does for UNORM 12, errs by up to 0.108 degrees */
HDRP_FN hdrp_u32 hdrp_pack_oct_unorm_from_normal(hdrp_v3 n, hdrp_u32 bits)
{
    float last = hdrp_i_pack_oct_last(bits);
    hdrp_v2 p = hdrp_i_pack_oct_project(n, last + 0.5f);
    return hdrp_i_pack_oct_unorm_code(hdrp_i_pack_oct_round(p, n.z, last, 0.5f), n, bits);
}

/** Octahedral code of a normal, UNORM, the best of the codes around it.
 *  n        any    normal of any length in [1e-15,1e15]
 *  bits     [2,16] of each coordinate
 *  returns  any    as hdrp_pack_oct_unorm_from_normal
 *  edges    a zero, NaN or infinite n counts as +Z; the sign of z survives
 *  error    <= 0.040 degrees at 12 bits  @accuracy pack_oct_unorm_exact_12
 *  error    <= 0.64 degrees at 8 bits  @accuracy pack_oct_unorm_exact_8
 *  error    <= 0.0025 degrees at 16 bits  @accuracy pack_oct_unorm_exact_16
 *  source   Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit
 *           Vectors", listing 4 (precise encoding) */
HDRP_FN hdrp_u32 hdrp_pack_oct_unorm_from_normal_exact(hdrp_v3 n, hdrp_u32 bits)
{
    float last = hdrp_i_pack_oct_last(bits);
    hdrp_v2 p = hdrp_i_pack_oct_project(n, last + 0.5f);
    return hdrp_i_pack_oct_unorm_code(hdrp_i_pack_oct_search(p, n, last, 0.5f), n, bits);
}

/** Unit normal of a UNORM octahedral code.
 *  code     any    x in the low bits, y in the next, both counted from -1
 *  bits     [2,16] of each coordinate
 *  returns  unit   normal; z is never 0
 *  edges    every code is a normal
 *  error    <= 1.8e-7 absolute, per component  @accuracy pack_normal_from_oct_unorm
 *  source   Meyer et al. 2010, "On Floating-Point Normal Vectors", section 3.2 */
HDRP_FN hdrp_v3 hdrp_pack_normal_from_oct_unorm(hdrp_u32 code, hdrp_u32 bits)
{
    hdrp_u32 mask = (1u << bits) - 1u;
    float scale = hdrp_i_pack_oct_last(bits) + 0.5f;
    hdrp_v2 p = hdrp_v2_make(hdrp_f32_from_u32(code & mask) - scale,
                             hdrp_f32_from_u32((code >> bits) & mask) - scale);
    return hdrp_v3_normalize(hdrp_i_pack_oct_unfold(p, scale));
}

/** Target value of a 12/12 octahedral code, for the colour channels of an RGBA8 UNORM target.
 *  code     any    24 bits: x in the low 12 bits, y in the next
 *  returns  [0,1]  red: upper 8 bits of x; green: upper 8 bits of y; blue: lower 4 of x, then of y
 *  edges    none
 *  error    none: exact
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", GBuffer slides ("Octahedral 12/12")
 *  note     the slides leave the order of the bits open; here red and green alone are an 8/8
 *           code */
HDRP_FN hdrp_v3 hdrp_pack_oct24_target(hdrp_u32 code)
{
    hdrp_u32 low = ((code & 15u) << 4u) | ((code >> 12u) & 15u);
    return hdrp_v3_make(hdrp_pack_float_from_unorm((code >> 4u) & 255u, 8u),
                        hdrp_pack_float_from_unorm((code >> 16u) & 255u, 8u),
                        hdrp_pack_float_from_unorm(low, 8u));
}

/** The 12/12 octahedral code that hdrp_pack_oct24_target stored.
 *  target   any    red, green and blue of the target; limited to [0,1]
 *  returns  [0,16777215] code
 *  edges    NaN counts as 0
 *  error    none: exact for every code
 *  source   see hdrp_pack_oct24_target */
HDRP_FN hdrp_u32 hdrp_pack_oct24_from_target(hdrp_v3 target)
{
    hdrp_u32 low = hdrp_pack_unorm_from_float(target.z, 8u);
    hdrp_u32 x = (hdrp_pack_unorm_from_float(target.x, 8u) << 4u) | (low >> 4u);
    hdrp_u32 y = (hdrp_pack_unorm_from_float(target.y, 8u) << 4u) | (low & 15u);
    return x | (y << 12u);
}

/* >>tangent frame
 * The direction of anisotropy as an angle from the default tangent of hdrp_basis_from_normal. */

/* Cosine and sine, of any common scale, of the tangent's angle in the default frame of n. */
HDRP_FN hdrp_v2 hdrp_i_pack_tangent_direction(hdrp_v3 n, hdrp_v3 tangent)
{
    hdrp_basis frame = hdrp_basis_from_normal(n);
    float x = hdrp_v3_dot(tangent, frame.tangent);
    float y = hdrp_v3_dot(tangent, frame.bitangent);
    float d2 = x * x + y * y;
    if (!(d2 >= 1e-30f && d2 <= 1e30f)) {
        return hdrp_v2_make(1.0f, 0.0f);
    }
    return hdrp_v2_make(x, y);
}

HDRP_FN hdrp_v3 hdrp_i_pack_tangent_at(hdrp_v3 n, float cos_angle, float sin_angle)
{
    hdrp_basis frame = hdrp_basis_from_normal(n);
    return hdrp_v3_mad(hdrp_v3_scale(frame.tangent, cos_angle), frame.bitangent, sin_angle);
}

/** Angle of a tangent in the default frame, up to half a turn, in 11 bits.
 *  n        unit   the normal that the decoder will have: decode it before, if it is packed too
 *  tangent  any    direction; its part along n is ignored
 *  returns  [0,2047] code: 2048 steps of half a turn
 *  edges    a tangent along n, without direction, or whose length in the plane is outside
 *           [1e-15,1e15] gives the default tangent, code 0
 *  error    <= 0.0440 degrees, up to the sign of the tangent  @accuracy pack_angle11
 *  source   derived: half a turn is enough, because anisotropic GGX is the same for t and -t
 *  note     twice the resolution of hdrp_pack_angle11_from_tangent_fast at the cost of an arc
 *           tangent here and of a sine and cosine in the decoder */
HDRP_FN hdrp_u32 hdrp_pack_angle11_from_tangent(hdrp_v3 n, hdrp_v3 tangent)
{
    hdrp_v2 d = hdrp_i_pack_tangent_direction(n, tangent);
    float steps = hdrp_atan2(d.y, d.x) * (2048.0f / HDRP_PI);
    /* Steps count modulo 2048, and two turns of them keep a coarse arc tangent above 0. */
    return hdrp_u32_from_f32(steps + 4096.5f) & 2047u;
}

/** Tangent of a code of hdrp_pack_angle11_from_tangent.
 *  n        unit   normal
 *  code     any    the low 11 bits are used
 *  returns  unit   tangent, orthogonal to n; the encoder's or its opposite
 *  edges    code 0 is the default tangent
 *  error    <= 4e-7 absolute, per component  @accuracy pack_tangent_from_angle11
 *  source   see hdrp_pack_angle11_from_tangent
 *  note     the bitangent is cross(n, tangent) of this tangent; the slides cross the normal with
 *           the default one and so lose the rotation */
HDRP_FN hdrp_v3 hdrp_pack_tangent_from_angle11(hdrp_v3 n, hdrp_u32 code)
{
    float angle_rad = hdrp_f32_from_u32(code & 2047u) * (HDRP_PI / 2048.0f);
    return hdrp_i_pack_tangent_at(n, hdrp_cos(angle_rad), hdrp_sin(angle_rad));
}

/** Angle of a tangent in the default frame, over the whole turn, in 8 + 3 bits.
 *  n        unit   the normal that the decoder will have: decode it before, if it is packed too
 *  tangent  any    direction; its part along n is ignored
 *  returns  [0,2047] code: the smaller of |sin| and |cos| in the upper 8 bits, then 4 where that is
 *           the sine, 2 where the cosine is negative, 1 where the sine is negative
 *  edges    as hdrp_pack_angle11_from_tangent
 *  error    <= 0.1125 degrees  @accuracy pack_angle11_fast
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slide "GBuffer Design - Anisotropy" */
HDRP_FN hdrp_u32 hdrp_pack_angle11_from_tangent_fast(hdrp_v3 n, hdrp_v3 tangent)
{
    hdrp_v2 d = hdrp_i_pack_tangent_direction(n, tangent);
    float x = hdrp_abs(d.x);
    float y = hdrp_abs(d.y);
    float smaller = hdrp_min(x, y) / hdrp_sqrt(x * x + y * y);
    return (hdrp_pack_unorm_from_float(smaller * HDRP_SQRT_2, 8u) << 3u) | (y < x ? 4u : 0u) |
           (d.x < 0.0f ? 2u : 0u) | (d.y < 0.0f ? 1u : 0u);
}

/** Tangent of a code of hdrp_pack_angle11_from_tangent_fast.
 *  n        unit   normal
 *  code     any    the low 11 bits are used
 *  returns  unit   tangent, orthogonal to n
 *  edges    every code is a tangent
 *  error    <= 3e-7 absolute, per component  @accuracy pack_tangent_from_angle11_fast
 *  source   see hdrp_pack_angle11_from_tangent_fast */
HDRP_FN hdrp_v3 hdrp_pack_tangent_from_angle11_fast(hdrp_v3 n, hdrp_u32 code)
{
    float smaller = hdrp_pack_float_from_unorm((code >> 3u) & 255u, 8u) * HDRP_SQRT_HALF;
    float larger = hdrp_sqrt(1.0f - smaller * smaller);
    float sin_angle = (code & 4u) != 0u ? smaller : larger;
    float cos_angle = (code & 4u) != 0u ? larger : smaller;
    return hdrp_i_pack_tangent_at(n, (code & 2u) != 0u ? -cos_angle : cos_angle,
                                  (code & 1u) != 0u ? -sin_angle : sin_angle);
}

/* >>normal buffer
 * RT1 of the GBuffer, which a forward prepass writes in the same encoding, so that screen-space
 * passes need not know which path a pixel takes. */

struct hdrp_pack_normal_pair {
    hdrp_v3 normal;             /* unit */
    float perceptual_roughness; /* [0,1] */
};
HDRP_TYPEDEF(hdrp_pack_normal_pair)

/* RT1 of a 12/12 code. */
HDRP_FN hdrp_v4 hdrp_i_pack_normal_buffer(hdrp_u32 code, float perceptual_roughness)
{
    return hdrp_v4_from_v3(hdrp_pack_oct24_target(code),
                           hdrp_saturate(1.0f - perceptual_roughness));
}

/** Target value of the normal buffer, RGBA8 UNORM.
 *  normal                any    any length in [1e-30,1e30]
 *  perceptual_roughness  any    limited to [0,1]
 *  returns               [0,1]  the SNORM 12/12 octahedral code and the perceptual smoothness
 *  edges                 a normal without direction gives +Z, a NaN roughness 1; the sign of z
 *                        survives
 *  error                 <= 0.0595 degrees in the normal  @accuracy pack_normal_buffer_normal
 *  error                 <= 0.00196082 absolute in the roughness  @accuracy
 *                        pack_normal_buffer_roughness
 *  source                Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's
 *                        High Definition Render Pipeline", GBuffer slides
 *  note                  half a step of smoothness changes alpha by 4 % at perceptual roughness
 *                        0.1, by 14 % at 0.03, and by up to 43 % at 0.01 */
HDRP_FN hdrp_v4 hdrp_pack_normal_buffer_encode(hdrp_v3 normal, float perceptual_roughness)
{
    return hdrp_i_pack_normal_buffer(hdrp_pack_oct_snorm_from_normal(normal, 12u),
                                     perceptual_roughness);
}

/** Normal and roughness of the normal buffer.
 *  rt1      any    what the target returned; limited to [0,1]
 *  returns  valid
 *  edges    NaN counts as 0
 *  error    none: hdrp_pack_oct24_from_target, then hdrp_pack_normal_from_oct_snorm
 *  source   see hdrp_pack_normal_buffer_encode */
HDRP_FN hdrp_pack_normal_pair hdrp_pack_normal_buffer_decode(hdrp_v4 rt1)
{
    hdrp_pack_normal_pair pair;
    pair.normal =
        hdrp_pack_normal_from_oct_snorm(hdrp_pack_oct24_from_target(hdrp_v3_from_v4(rt1)), 12u);
    pair.perceptual_roughness = 1.0f - hdrp_saturate(rt1.w);
    return pair;
}

/* >>SSS buffer
 * RT0 of the GBuffer for materials with subsurface scattering, which a forward pass writes in the
 * same encoding: all that the screen-space filter needs. */

struct hdrp_pack_sss {
    hdrp_v3 diffuse_color;      /* [0,1] linear Rec.709 */
    hdrp_u32 diffusion_profile; /* [0,15] */
    float subsurface_mask;      /* [0,1] */
};
HDRP_TYPEDEF(hdrp_pack_sss)

/** Target value of the SSS buffer, RGBA8 sRGB.
 *  s        any    NaN and out-of-range values are limited; of the profile 4 bits are kept
 *  returns  [0,1]  linear colour, which the hardware encodes; profile (4) and mask (4) in alpha
 *  edges    NaN gives 0
 *  error    <= 0.0333334 absolute in the mask  @accuracy pack_sss_mask
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", slide "GBuffer Design - Subsurface scattering" */
HDRP_FN hdrp_v4 hdrp_pack_sss_buffer_encode(hdrp_pack_sss s)
{
    return hdrp_v4_from_v3(hdrp_v3_saturate(s.diffuse_color),
                           hdrp_pack_float_uint(s.subsurface_mask, s.diffusion_profile, 4u, 8u));
}

/** Colour, profile and mask of the SSS buffer.
 *  rt0      any    what the target returned; limited to [0,1]
 *  returns  valid
 *  edges    NaN counts as 0
 *  error    none: a selection, and hdrp_pack_float_uint_from_target
 *  source   see hdrp_pack_sss_buffer_encode */
HDRP_FN hdrp_pack_sss hdrp_pack_sss_buffer_decode(hdrp_v4 rt0)
{
    hdrp_pack_sss s;
    hdrp_pack_float_uint_pair pair = hdrp_pack_float_uint_from_target(rt0.w, 4u, 8u);
    s.diffuse_color = hdrp_v3_saturate(hdrp_v3_from_v4(rt0));
    s.diffusion_profile = pair.i;
    s.subsurface_mask = pair.f;
    return s;
}

/* >>GBuffer
 * Four render targets of 32 bits and two optional ones. RT0 to RT2 by variant:
 *
 *                  R               G              B                       A
 * RT0 RGBA8 sRGB   diffuse or base colour                                 specular occlusion
 * RT1 RGBA8        normal, SNORM octahedral 12/12                         perceptual smoothness
 * RT2 RGBA8        by variant                                             variant(3) coat mask(5)
 *   Standard       F0 on the sRGB curve
 *   Anisotropy     anisotropy      angle, high 8  angle, low 3, metallic(5)
 *   Iridescence    d low, IOR(7)   d, high 8      film mask(3) metallic(5)
 *   SSS or Transm. spec. occlusion thickness      profile(4) mask(4)
 * RT3 R11G11B10F   light that leaves the surface: emissive and static diffuse
 * RT4 RGBA8        extra specular occlusion data  ambient occlusion       light layers
 * RT5 RGBA8        four shadow masks
 *
 * With SSS or transmission RT0 is the SSS buffer: profile and mask take the place of the specular
 * occlusion, and are stored in RT2 again, so that lighting can do without RT0 until its end.
 *
 * RT0 holds the diffuse colour in the Standard and SSS variants, the base colour in the others.
 * Anisotropy is an offset-binary SNORM with an exact 0. The film IOR is (ior - 1) / 2 in 7 bits,
 * and d is sqrt(nm / 3000) of the film thickness in 9: the square root makes steps finer where
 * fringes have more contrast, and the bit is worth more there. The stored thickness is that of the
 * stored IOR, so that the optical path stays the same. hdrp_brdf_film of films of 100 to 800 nm
 * is off by 0.0026 (root of the mean square), against 0.0046 for 8 and 8 bits.
 *
 * What no layout stores, and what decoding gives instead: coat roughness
 * (HDRP_BRDF_COAT_PERCEPTUAL_ROUGHNESS), coat normal (the normal), refraction (none, IOR 1.5),
 * transmittance (0: it follows from profile and thickness). Except in Standard, F0 is that of base
 * colour and metallic over HDRP_PACK_GBUFFER_FRESNEL0; SSS has metallic 0. Standard does not keep
 * base colour and metallic: it gives the diffuse colour and 0. See hdrp_pack_gbuffer_losses. */

/* Version of the layouts; a shader and a tool that disagree must not share texels. */
#define HDRP_PACK_GBUFFER_VERSION 1u

/* Variant field of RT2.a. 0 to 3 combine HDRP_BRDF_FEATURE_SUBSURFACE and _TRANSMISSION. 6 and 7
 * are free, and decode as Standard. */
#define HDRP_PACK_GBUFFER_STANDARD    0u
#define HDRP_PACK_GBUFFER_ANISOTROPY  4u
#define HDRP_PACK_GBUFFER_IRIDESCENCE 5u

/* Optional targets, or-ed. */
#define HDRP_PACK_GBUFFER_RT4 16u
#define HDRP_PACK_GBUFFER_RT5 32u

/* F0 of a dielectric in the variants that do not store it: IOR 1.5. */
#define HDRP_PACK_GBUFFER_FRESNEL0 0.04f
/* Largest number that all three channels of R11G11B10F hold. */
#define HDRP_PACK_R11G11B10F_MAX 64512.0f
/* Thickest film, as in hdrp_brdf_data. */
#define HDRP_PACK_GBUFFER_FILM_MAX_NM 3000.0f

/* What a material would lose, or-ed; see hdrp_pack_gbuffer_losses. */
#define HDRP_PACK_GBUFFER_LOSS_FEATURE        1u  /* more than one exclusive feature */
#define HDRP_PACK_GBUFFER_LOSS_REFRACTION     2u  /* refraction is forward only */
#define HDRP_PACK_GBUFFER_LOSS_COAT_NORMAL    4u  /* the coat has a normal of its own */
#define HDRP_PACK_GBUFFER_LOSS_COAT_ROUGHNESS 8u  /* the coat has a roughness of its own */
#define HDRP_PACK_GBUFFER_LOSS_COLOR          16u /* colours that the variant cannot express */

/* What a fragment shader writes, and what a texture fetch returns. RT0 is linear; the hardware
 * encodes it. */
struct hdrp_pack_gbuffer {
    hdrp_v4 rt0; /* [0,1] */
    hdrp_v4 rt1; /* [0,1] */
    hdrp_v4 rt2; /* [0,1] */
    hdrp_v3 rt3; /* [0,HDRP_PACK_R11G11B10F_MAX] */
    hdrp_v4 rt4; /* [0,1] */
    hdrp_v4 rt5; /* [0,1] */
};
HDRP_TYPEDEF(hdrp_pack_gbuffer)

/* What memory holds. */
struct hdrp_pack_gbuffer_texel {
    hdrp_u32 rt0; /* VK_FORMAT_R8G8B8A8_SRGB */
    hdrp_u32 rt1; /* VK_FORMAT_R8G8B8A8_UNORM */
    hdrp_u32 rt2; /* VK_FORMAT_R8G8B8A8_UNORM */
    hdrp_u32 rt3; /* VK_FORMAT_B10G11R11_UFLOAT_PACK32 */
    hdrp_u32 rt4; /* VK_FORMAT_R8G8B8A8_UNORM */
    hdrp_u32 rt5; /* VK_FORMAT_R8G8B8A8_UNORM */
};
HDRP_TYPEDEF(hdrp_pack_gbuffer_texel)

/* What a GBuffer stores beside the material. */
struct hdrp_pack_gbuffer_extra {
    hdrp_v3 emissive;                /* [0,inf) luminance, pre-exposed */
    hdrp_v3 static_diffuse;          /* [0,inf) luminance of baked light, pre-exposed */
    hdrp_v2 specular_occlusion_data; /* [0,1] the caller's, for example a bent normal; RT4 */
    hdrp_u32 light_layers;           /* [0,255] mask; RT4 */
    hdrp_v4 shadow_masks;            /* [0,1] RT5 */
    hdrp_u32 targets;                /* HDRP_PACK_GBUFFER_RT4, _RT5: which of them exist */
};
HDRP_TYPEDEF(hdrp_pack_gbuffer_extra)

#ifndef HDRP_GPU
/* The sizes that tools and captures rely on. */
typedef char hdrp_i_pack_gbuffer_is_92_bytes[sizeof(hdrp_pack_gbuffer) == 92 ? 1 : -1];
typedef char hdrp_i_pack_gbuffer_texel_is_24_bytes[sizeof(hdrp_pack_gbuffer_texel) == 24 ? 1 : -1];
#endif

/* The variant that stores these features. Where several exclusive ones are set, subsurface and
 * transmission go first, then anisotropy. */
HDRP_FN hdrp_u32 hdrp_i_pack_gbuffer_variant(hdrp_u32 features)
{
    hdrp_u32 sss = features & (HDRP_BRDF_FEATURE_SUBSURFACE | HDRP_BRDF_FEATURE_TRANSMISSION);
    hdrp_u32 film = (features & HDRP_BRDF_FEATURE_IRIDESCENCE) != 0u ? HDRP_PACK_GBUFFER_IRIDESCENCE
                                                                     : HDRP_PACK_GBUFFER_STANDARD;
    hdrp_u32 other =
        (features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u ? HDRP_PACK_GBUFFER_ANISOTROPY : film;
    return sss != 0u ? sss : other;
}

/* Features of a decoded RT2.a. */
HDRP_FN hdrp_u32 hdrp_i_pack_gbuffer_features(hdrp_u32 rt2_alpha)
{
    hdrp_u32 variant = rt2_alpha >> 5u;
    hdrp_u32 film = variant == HDRP_PACK_GBUFFER_IRIDESCENCE ? HDRP_BRDF_FEATURE_IRIDESCENCE : 0u;
    hdrp_u32 other = variant == HDRP_PACK_GBUFFER_ANISOTROPY ? HDRP_BRDF_FEATURE_ANISOTROPY : film;
    return (variant < HDRP_PACK_GBUFFER_ANISOTROPY ? variant : other) |
           ((rt2_alpha & 31u) != 0u ? HDRP_BRDF_FEATURE_CLEAR_COAT : 0u);
}

/** Features of a GBuffer texel: all that material classification reads.
 *  rt2      any    what the target returned
 *  returns  [0,31] HDRP_BRDF_FEATURE_... mask
 *  edges    NaN counts as 0; the free variants have no feature; a coat mask that rounded to 0 is
 *           none
 *  error    none: exact
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", GBuffer slides */
HDRP_FN hdrp_u32 hdrp_pack_gbuffer_features(hdrp_v4 rt2)
{
    return hdrp_i_pack_gbuffer_features(hdrp_pack_unorm_from_float(rt2.w, 8u));
}

/** hdrp_pack_gbuffer_features of the texel in memory.
 *  rt2      any    texel of RT2
 *  returns  [0,31] HDRP_BRDF_FEATURE_... mask
 *  edges    the free variants have no feature
 *  error    none: exact
 *  source   see hdrp_pack_gbuffer_features */
HDRP_FN hdrp_u32 hdrp_pack_gbuffer_texel_features(hdrp_u32 rt2)
{
    return hdrp_i_pack_gbuffer_features(rt2 >> 24u);
}

/* 1 where any component of a and b differs by more than tolerance, else 0. */
HDRP_FN hdrp_u32 hdrp_i_pack_differs(hdrp_v3 a, hdrp_v3 b, float tolerance)
{
    hdrp_v3 d = hdrp_v3_sub(a, b);
    float e = hdrp_max(hdrp_max(hdrp_abs(d.x), hdrp_abs(d.y)), hdrp_abs(d.z));
    return e <= tolerance ? 0u : 1u;
}

/** What a material loses in the GBuffer beyond the resolution of its codes.
 *  d        valid  engine data
 *  returns  [0,31] HDRP_PACK_GBUFFER_LOSS_... mask
 *  edges    fields whose feature is not set do not count
 *  error    none: comparisons
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", "Exclusive Material features due to storage space"
 *  note     transmittance is not counted: it follows from profile and thickness */
HDRP_FN hdrp_u32 hdrp_pack_gbuffer_losses(hdrp_brdf_data d)
{
    hdrp_u32 variant = hdrp_i_pack_gbuffer_variant(d.features);
    hdrp_u32 stored = hdrp_i_pack_gbuffer_features(variant << 5u);
    hdrp_u32 exclusive = HDRP_BRDF_FEATURE_SUBSURFACE | HDRP_BRDF_FEATURE_TRANSMISSION |
                         HDRP_BRDF_FEATURE_ANISOTROPY | HDRP_BRDF_FEATURE_IRIDESCENCE;
    hdrp_u32 coat = (d.features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u ? 1u : 0u;
    float metallic = variant < HDRP_PACK_GBUFFER_ANISOTROPY ? 0.0f : d.metallic;
    hdrp_v3 base = variant < HDRP_PACK_GBUFFER_ANISOTROPY ? d.diffuse_color : d.base_color;
    hdrp_v3 f0 = hdrp_brdf_fresnel0(base, metallic, hdrp_v3_splat(HDRP_PACK_GBUFFER_FRESNEL0));
    /* 2e-3 is half a code of 8 bits, 1e-3 radians the error of the normal. */
    hdrp_u32 color =
        hdrp_i_pack_differs(d.fresnel0, f0, 2e-3f) |
        hdrp_i_pack_differs(d.diffuse_color, hdrp_brdf_diffuse_color(base, metallic), 2e-3f);
    hdrp_u32 coat_normal = hdrp_i_pack_differs(d.coat_normal, d.normal, 1e-3f);
    float coat_roughness = d.coat_perceptual_roughness - HDRP_BRDF_COAT_PERCEPTUAL_ROUGHNESS;
    return ((d.features & exclusive) != stored ? HDRP_PACK_GBUFFER_LOSS_FEATURE : 0u) |
           ((d.features & HDRP_BRDF_FEATURE_REFRACTION) != 0u ? HDRP_PACK_GBUFFER_LOSS_REFRACTION
                                                              : 0u) |
           coat * coat_normal * HDRP_PACK_GBUFFER_LOSS_COAT_NORMAL |
           (hdrp_abs(coat_roughness) > 2e-3f ? coat * HDRP_PACK_GBUFFER_LOSS_COAT_ROUGHNESS : 0u) |
           (variant == HDRP_PACK_GBUFFER_STANDARD ? 0u : color * HDRP_PACK_GBUFFER_LOSS_COLOR);
}

/** Whether the GBuffer stores a material up to the resolution of its codes.
 *  d        valid  engine data
 *  returns  [0,1]  1 where hdrp_pack_gbuffer_losses is 0: deferred; else it should be drawn forward
 *  edges    as hdrp_pack_gbuffer_losses
 *  error    none: a comparison
 *  source   see hdrp_pack_gbuffer_losses */
HDRP_FN hdrp_u32 hdrp_pack_gbuffer_supports(hdrp_brdf_data d)
{
    return hdrp_pack_gbuffer_losses(d) == 0u ? 1u : 0u;
}

/* Every component limited to what R11G11B10F holds; 0 where it is NaN. */
HDRP_FN hdrp_v3 hdrp_i_pack_gbuffer_light(hdrp_v3 v)
{
    return hdrp_v3_make(hdrp_clamp(v.x, 0.0f, HDRP_PACK_R11G11B10F_MAX),
                        hdrp_clamp(v.y, 0.0f, HDRP_PACK_R11G11B10F_MAX),
                        hdrp_clamp(v.z, 0.0f, HDRP_PACK_R11G11B10F_MAX));
}

/* RT0 in linear values. */
HDRP_FN hdrp_v4 hdrp_i_pack_gbuffer_rt0(hdrp_brdf_data d, hdrp_u32 variant)
{
    hdrp_pack_sss s;
    hdrp_v3 color = d.base_color;
    if (variant == HDRP_PACK_GBUFFER_STANDARD) {
        color = d.diffuse_color;
    } else if (variant < HDRP_PACK_GBUFFER_ANISOTROPY) {
        s.diffuse_color = d.diffuse_color;
        s.diffusion_profile = d.diffusion_profile;
        /* Without the feature nothing may be blurred, and the SSS pass reads nothing but RT0. */
        s.subsurface_mask =
            (variant & HDRP_BRDF_FEATURE_SUBSURFACE) != 0u ? d.subsurface_mask : 0.0f;
        return hdrp_pack_sss_buffer_encode(s);
    }
    return hdrp_v4_from_v3(hdrp_v3_saturate(color), hdrp_saturate(d.specular_occlusion));
}

/* RT2 without alpha of the iridescence variant. The thickness makes up for the rounding of the IOR:
 * what fringes depend on is their product. */
HDRP_FN hdrp_v3 hdrp_i_pack_gbuffer_rt2_film(hdrp_brdf_data d)
{
    float ior = hdrp_clamp(d.film_ior, 1.0f, 3.0f);
    float ior_code = hdrp_pack_unorm_target(ior * 0.5f - 0.5f, 7u);
    float thickness_nm = d.film_thickness_nm * ior / (1.0f + 2.0f * ior_code);
    float root = hdrp_sqrt(hdrp_saturate(thickness_nm / HDRP_PACK_GBUFFER_FILM_MAX_NM));
    hdrp_u32 bits = hdrp_pack_unorm_from_float(root, 9u);
    hdrp_u32 mask = hdrp_pack_unorm_from_float(d.film_mask, 3u);
    return hdrp_v3_make(hdrp_pack_float_uint(ior_code, bits & 1u, 1u, 8u),
                        hdrp_pack_float_from_unorm(bits >> 1u, 8u),
                        hdrp_pack_float_uint(d.metallic, mask, 3u, 8u));
}

/* RT2 without alpha; n is the normal that the decoder will have. rt0 is encoded already. */
HDRP_FN hdrp_v3 hdrp_i_pack_gbuffer_rt2(hdrp_brdf_data d, hdrp_u32 variant, hdrp_v3 n, hdrp_v4 rt0)
{
    hdrp_u32 bits;
    if (variant == HDRP_PACK_GBUFFER_ANISOTROPY) {
        bits = hdrp_pack_angle11_from_tangent(n, d.tangent);
        return hdrp_v3_make(hdrp_pack_biased_snorm_target(d.anisotropy, 8u),
                            hdrp_pack_float_from_unorm(bits >> 3u, 8u),
                            hdrp_pack_float_uint(d.metallic, bits & 7u, 3u, 8u));
    }
    if (variant == HDRP_PACK_GBUFFER_IRIDESCENCE) {
        return hdrp_i_pack_gbuffer_rt2_film(d);
    }
    if (variant == HDRP_PACK_GBUFFER_STANDARD) {
        return hdrp_v3_srgb_from_linear_fast(d.fresnel0);
    }
    return hdrp_v3_make(hdrp_saturate(d.specular_occlusion), hdrp_saturate(d.thickness), rt0.w);
}

/** Target values of a material and what goes with it.
 *  d        any    engine data; NaN and out-of-range values are limited
 *  e        any    emissive and baked light, masks, and which optional targets exist
 *  returns  valid
 *  edges    a normal or tangent without direction gives a default, NaN the lower bound of its field
 *           and roughness 1; bits beyond a field's are dropped. Of several exclusive features
 *           subsurface and transmission win, then anisotropy. Targets that do not exist are 0
 *  error    <= 0.0595 degrees in the normal, every variant  @accuracy pack_gbuffer_normal
 *  error    <= 0.075 degrees in the tangent, up to its sign  @accuracy pack_gbuffer_tangent
 *  error    <= 0.0019611 absolute in colours, as sRGB codes in [0,1]  @accuracy pack_gbuffer_color
 *  error    <= 0.0022 absolute in F0, likewise  @accuracy pack_gbuffer_fresnel0
 *  error    <= 0.0161291 absolute in metallic and coat mask  @accuracy pack_gbuffer_5_bits
 *  error    <= 0.00393702 absolute in anisotropy  @accuracy pack_gbuffer_anisotropy
 *  error    <= 0.0078742 absolute in film IOR  @accuracy pack_gbuffer_film_ior
 *  error    <= 23.8 absolute in film IOR times thickness, nm  @accuracy pack_gbuffer_film_path
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", GBuffer slides
 *  note     without RT4 there is no place for the ambient occlusion: baked light is multiplied by
 *           it here (the slide says "if no RT5", its erratum RT4), so that screen-space occlusion
 *           darkens it twice. With RT4 whoever applies it to RT3 also darkens the emissive part */
HDRP_FN hdrp_pack_gbuffer hdrp_pack_gbuffer_encode(hdrp_brdf_data d, hdrp_pack_gbuffer_extra e)
{
    hdrp_pack_gbuffer g;
    hdrp_u32 variant = hdrp_i_pack_gbuffer_variant(d.features);
    hdrp_u32 normal = hdrp_pack_oct_snorm_from_normal(d.normal, 12u);
    float coat = (d.features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u ? d.coat_mask : 0.0f;
    float ambient_occlusion = hdrp_saturate(d.ambient_occlusion);
    float layers = hdrp_pack_float_from_unorm(e.light_layers & 255u, 8u);
    float baked_occlusion = ambient_occlusion;
    g.rt0 = hdrp_i_pack_gbuffer_rt0(d, variant);
    g.rt1 = hdrp_i_pack_normal_buffer(normal, d.perceptual_roughness);
    g.rt2 = hdrp_v4_from_v3(
        hdrp_i_pack_gbuffer_rt2(d, variant, hdrp_pack_normal_from_oct_snorm(normal, 12u), g.rt0),
        hdrp_pack_float_uint(coat, variant, 3u, 8u));
    g.rt4 = hdrp_v4_make(0.0f, 0.0f, 0.0f, 0.0f);
    g.rt5 = g.rt4;
    if ((e.targets & HDRP_PACK_GBUFFER_RT4) != 0u) {
        g.rt4 = hdrp_v4_make(hdrp_saturate(e.specular_occlusion_data.x),
                             hdrp_saturate(e.specular_occlusion_data.y), ambient_occlusion, layers);
        baked_occlusion = 1.0f;
    }
    if ((e.targets & HDRP_PACK_GBUFFER_RT5) != 0u) {
        g.rt5 = hdrp_v4_make(hdrp_saturate(e.shadow_masks.x), hdrp_saturate(e.shadow_masks.y),
                             hdrp_saturate(e.shadow_masks.z), hdrp_saturate(e.shadow_masks.w));
    }
    g.rt3 = hdrp_i_pack_gbuffer_light(hdrp_v3_mad(hdrp_i_pack_gbuffer_light(e.emissive),
                                                  hdrp_i_pack_gbuffer_light(e.static_diffuse),
                                                  baked_occlusion));
    return g;
}

/* Adds the metallic of the anisotropy and iridescence variants. */
HDRP_FN hdrp_brdf_data hdrp_i_pack_gbuffer_set_metallic(hdrp_brdf_data d, float metallic)
{
    d.metallic = metallic;
    d.diffuse_color = hdrp_brdf_diffuse_color(d.base_color, d.metallic);
    d.fresnel0 =
        hdrp_brdf_fresnel0(d.base_color, d.metallic, hdrp_v3_splat(HDRP_PACK_GBUFFER_FRESNEL0));
    return d;
}

/* Adds what the anisotropy variant stores. */
HDRP_FN hdrp_brdf_data hdrp_i_pack_gbuffer_decode_stretched(hdrp_brdf_data d, hdrp_v4 rt2)
{
    hdrp_pack_float_uint_pair pair = hdrp_pack_float_uint_from_target(rt2.z, 3u, 8u);
    hdrp_u32 angle = (hdrp_pack_unorm_from_float(rt2.y, 8u) << 3u) | pair.i;
    d.anisotropy = hdrp_pack_float_from_biased_snorm_target(rt2.x, 8u);
    d.tangent = hdrp_pack_tangent_from_angle11(d.normal, angle);
    d.bitangent = hdrp_v3_cross(d.normal, d.tangent);
    return hdrp_i_pack_gbuffer_set_metallic(d, pair.f);
}

/* Adds what the iridescence variant stores. */
HDRP_FN hdrp_brdf_data hdrp_i_pack_gbuffer_decode_film(hdrp_brdf_data d, hdrp_v4 rt2)
{
    hdrp_pack_float_uint_pair pair = hdrp_pack_float_uint_from_target(rt2.z, 3u, 8u);
    hdrp_pack_float_uint_pair film = hdrp_pack_float_uint_from_target(rt2.x, 1u, 8u);
    float thickness =
        hdrp_pack_float_from_unorm((hdrp_pack_unorm_from_float(rt2.y, 8u) << 1u) | film.i, 9u);
    d.film_ior = 1.0f + 2.0f * film.f;
    d.film_thickness_nm = thickness * thickness * HDRP_PACK_GBUFFER_FILM_MAX_NM;
    d.film_mask = hdrp_pack_float_from_unorm(pair.i, 3u);
    return hdrp_i_pack_gbuffer_set_metallic(d, pair.f);
}

/* Adds what the SSS and transmission variants store. */
HDRP_FN hdrp_brdf_data hdrp_i_pack_gbuffer_decode_sss(hdrp_brdf_data d, hdrp_v4 rt2)
{
    hdrp_pack_float_uint_pair pair = hdrp_pack_float_uint_from_target(rt2.z, 4u, 8u);
    d.fresnel0 = hdrp_v3_splat(HDRP_PACK_GBUFFER_FRESNEL0);
    d.specular_occlusion = hdrp_saturate(rt2.x);
    d.thickness = hdrp_saturate(rt2.y);
    d.diffusion_profile = pair.i;
    d.subsurface_mask = pair.f;
    return d;
}

/** Engine data of target values whose material has no other features than some.
 *  g         any    what the targets returned; limited to their ranges
 *  targets   any    HDRP_PACK_GBUFFER_RT4, _RT5: which optional targets exist
 *  features  any    HDRP_BRDF_FEATURE_... that the material may have: a constant mask lets the
 *            compiler drop the code for the others
 *  returns   valid
 *  edges     NaN counts as 0; fields that the variant does not store get the defaults listed above,
 *            and so do those of a feature that is not in the mask
 *  error     none: see hdrp_pack_gbuffer_encode
 *  source    Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *            Definition Render Pipeline", GBuffer slides
 *  note      a caller whose profiles have an F0 or a transmittance sets them afterwards */
HDRP_FN hdrp_brdf_data hdrp_pack_gbuffer_decode_features(hdrp_pack_gbuffer g, hdrp_u32 targets,
                                                         hdrp_u32 features)
{
    hdrp_brdf_data d = hdrp_brdf_data_from_surface(hdrp_brdf_surface_default());
    hdrp_pack_normal_pair rt1 = hdrp_pack_normal_buffer_decode(g.rt1);
    hdrp_pack_float_uint_pair rt2 = hdrp_pack_float_uint_from_target(g.rt2.w, 3u, 8u);
    hdrp_basis frame = hdrp_basis_from_normal(rt1.normal);
    hdrp_u32 sss = features & (HDRP_BRDF_FEATURE_SUBSURFACE | HDRP_BRDF_FEATURE_TRANSMISSION);
    d.features = hdrp_pack_gbuffer_features(g.rt2) & features;
    d.diffuse_color = hdrp_v3_saturate(hdrp_v3_from_v4(g.rt0));
    d.base_color = d.diffuse_color;
    d.specular_occlusion = hdrp_saturate(g.rt0.w);
    d.normal = rt1.normal;
    d.perceptual_roughness = rt1.perceptual_roughness;
    d.tangent = frame.tangent;
    d.bitangent = frame.bitangent;
    d.coat_normal = rt1.normal;
    d.coat_mask = (features & HDRP_BRDF_FEATURE_CLEAR_COAT) != 0u ? rt2.f : 0.0f;
    if ((targets & HDRP_PACK_GBUFFER_RT4) != 0u) {
        d.ambient_occlusion = hdrp_saturate(g.rt4.z);
    }
    if ((features & HDRP_BRDF_FEATURE_ANISOTROPY) != 0u && rt2.i == HDRP_PACK_GBUFFER_ANISOTROPY) {
        return hdrp_i_pack_gbuffer_decode_stretched(d, g.rt2);
    }
    if ((features & HDRP_BRDF_FEATURE_IRIDESCENCE) != 0u &&
        rt2.i == HDRP_PACK_GBUFFER_IRIDESCENCE) {
        return hdrp_i_pack_gbuffer_decode_film(d, g.rt2);
    }
    if (sss != 0u && rt2.i != HDRP_PACK_GBUFFER_STANDARD && rt2.i < HDRP_PACK_GBUFFER_ANISOTROPY) {
        return hdrp_i_pack_gbuffer_decode_sss(d, g.rt2);
    }
    d.fresnel0 = hdrp_v3_linear_from_srgb_fast(hdrp_v3_from_v4(g.rt2));
    return d;
}

/** Engine data of target values.
 *  g        any    what the targets returned; limited to their ranges
 *  targets  any    HDRP_PACK_GBUFFER_RT4, _RT5: which optional targets exist
 *  returns  valid
 *  edges    NaN counts as 0; fields that the variant does not store get the defaults listed above
 *  error    none: see hdrp_pack_gbuffer_encode
 *  source   Lagarde and Golubev 2018, "The Road toward Unified Rendering with Unity's High
 *           Definition Render Pipeline", GBuffer slides
 *  note     a caller whose diffusion profiles have an F0 or a transmittance sets them afterwards */
HDRP_FN hdrp_brdf_data hdrp_pack_gbuffer_decode(hdrp_pack_gbuffer g, hdrp_u32 targets)
{
    return hdrp_pack_gbuffer_decode_features(g, targets, HDRP_BRDF_FEATURE_ALL);
}

/** What target values hold beside the material.
 *  g        any    what the targets returned; limited to their ranges
 *  targets  any    HDRP_PACK_GBUFFER_RT4, _RT5: which optional targets exist
 *  returns  valid: all of RT3 as static_diffuse, and the fields of the targets that exist; the rest
 *           is 0, except light_layers and shadow_masks, which are all ones
 *  edges    NaN counts as 0, infinity as 64512
 *  error    none: exact for every code
 *  source   see hdrp_pack_gbuffer_decode */
HDRP_FN hdrp_pack_gbuffer_extra hdrp_pack_gbuffer_decode_extra(hdrp_pack_gbuffer g,
                                                               hdrp_u32 targets)
{
    hdrp_pack_gbuffer_extra e;
    e.targets = targets & (HDRP_PACK_GBUFFER_RT4 | HDRP_PACK_GBUFFER_RT5);
    e.emissive = hdrp_v3_splat(0.0f);
    e.static_diffuse = hdrp_i_pack_gbuffer_light(g.rt3);
    e.specular_occlusion_data = hdrp_v2_make(0.0f, 0.0f);
    e.light_layers = 255u;
    e.shadow_masks = hdrp_v4_make(1.0f, 1.0f, 1.0f, 1.0f);
    if ((targets & HDRP_PACK_GBUFFER_RT4) != 0u) {
        e.specular_occlusion_data = hdrp_v2_make(hdrp_saturate(g.rt4.x), hdrp_saturate(g.rt4.y));
        e.light_layers = hdrp_pack_unorm_from_float(g.rt4.w, 8u);
    }
    if ((targets & HDRP_PACK_GBUFFER_RT5) != 0u) {
        e.shadow_masks = hdrp_v4_make(hdrp_saturate(g.rt5.x), hdrp_saturate(g.rt5.y),
                                      hdrp_saturate(g.rt5.z), hdrp_saturate(g.rt5.w));
    }
    return e;
}

/** What memory holds after a shader wrote target values.
 *  g        any    target values
 *  returns  any    one texel per target
 *  edges    NaN is stored as 0 in RT0 to RT2, RT4 and RT5, and as NaN in RT3
 *  error    none: hdrp_pack_srgba8_from_linear, hdrp_pack_rgba8_from_v4 and
 *           hdrp_pack_r11g11b10f_from_rgb
 *  source   Vulkan specification, "Fixed-Point Data Conversions"
 *  note     a device may round RT3 towards 0 and differ by one code where a value lies between
 *           two */
HDRP_FN hdrp_pack_gbuffer_texel hdrp_pack_gbuffer_texel_from_targets(hdrp_pack_gbuffer g)
{
    hdrp_pack_gbuffer_texel t;
    t.rt0 = hdrp_pack_srgba8_from_linear(g.rt0);
    t.rt1 = hdrp_pack_rgba8_from_v4(g.rt1);
    t.rt2 = hdrp_pack_rgba8_from_v4(g.rt2);
    t.rt3 = hdrp_pack_r11g11b10f_from_rgb(g.rt3);
    t.rt4 = hdrp_pack_rgba8_from_v4(g.rt4);
    t.rt5 = hdrp_pack_rgba8_from_v4(g.rt5);
    return t;
}

/** What a texture fetch returns for texels in memory.
 *  t        any    one texel per target
 *  returns  any    target values, in [0,1] but for RT3
 *  edges    infinity and NaN in RT3 are returned; decoding limits them
 *  error    none: hdrp_pack_linear_from_srgba8, hdrp_pack_v4_from_rgba8 and
 *           hdrp_pack_rgb_from_r11g11b10f
 *  source   Vulkan specification, "Fixed-Point Data Conversions" */
HDRP_FN hdrp_pack_gbuffer hdrp_pack_gbuffer_targets_from_texel(hdrp_pack_gbuffer_texel t)
{
    hdrp_pack_gbuffer g;
    g.rt0 = hdrp_pack_linear_from_srgba8(t.rt0);
    g.rt1 = hdrp_pack_v4_from_rgba8(t.rt1);
    g.rt2 = hdrp_pack_v4_from_rgba8(t.rt2);
    g.rt3 = hdrp_pack_rgb_from_r11g11b10f(t.rt3);
    g.rt4 = hdrp_pack_v4_from_rgba8(t.rt4);
    g.rt5 = hdrp_pack_v4_from_rgba8(t.rt5);
    return g;
}

#endif /* HDRP_PACK_H */
