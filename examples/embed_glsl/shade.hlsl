// Compile: dxc -T ps_6_0 -I <folder of the headers> shade.hlsl
//      or: glslangValidator -V -D -DHDRP_HLSL -S frag -e main -I<folder> shade.hlsl
#include "hdrp_brdf.h"

Texture2D base_color_texture : register(t0);
SamplerState linear_sampler : register(s0);

struct varyings {
    float3 normal : NORMAL;
    float2 uv : TEXCOORD0;
    float4 position : SV_Position;
};

float4 main(varyings v) : SV_Target0
{
    hdrp_brdf_surface surface = hdrp_brdf_surface_default();
    surface.base_color = base_color_texture.Sample(linear_sampler, v.uv).rgb;
    surface.normal = v.normal;

    hdrp_brdf_data data = hdrp_brdf_data_from_surface(surface);
    return hdrp_v4_from_v3(data.diffuse_color, hdrp_saturate(data.normal.y));
}
