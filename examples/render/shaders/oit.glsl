// Blended surfaces into the targets of a mode of hdrp_oit.h: pass_oit.c. Each shader has another
// number of them, and says which by HDRP_OIT_OUTPUTS.
#include "hdrp_oit.h"

layout(constant_id = 3) const uint OIT_MODE = 0u;
layout(constant_id = 4) const uint OIT_PASS = 0u;
#define HDRP_OIT_MODE OIT_MODE
#define HDRP_OIT_PASS OIT_PASS
#define HDRP_OIT_SET  3
// The CPU's device depth is of depths from 0.5 to 300 m; no mode of the renderer reads it.
#define HDRP_OIT_DEVICE_DEPTH 0.0
#include "shaders/oit_output.glsl"

// Pixels of the picture from one sample to the next.
vec2 oit_step()
{
    return draw.low != 0u ? frame.jitter_size.zw / ceil(0.5 * frame.jitter_size.zw) : vec2(1.0);
}

// Where the sample is, less its jitter.
vec2 oit_place()
{
    return (floor(gl_FragCoord.xy) + 0.5) * oit_step() - 0.5;
}

Ray oit_ray()
{
    vec2 pixels = oit_step();
    return sample_ray(oit_place() + frame.jitter_size.xy, max(pixels.x, pixels.y));
}

// From the depth that was rasterised: in all passes the same bits, whatever else is computed.
float oit_z_view()
{
    float near = frame.depths_exposure.x, far = frame.depths_exposure.y;
    return is_orthographic() ? far - gl_FragCoord.z * (far - near) : near / gl_FragCoord.z;
}
