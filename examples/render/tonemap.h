/* From exposed light to what a display shows. */
#ifndef RD_TONEMAP_H
#define RD_TONEMAP_H

#include "hdrp_math.h"

/* Exposed linear Rec.709 in, display-referred linear Rec.709 in [0,1] out.
 * Khronos 2024, "Khronos PBR Neutral Tone Mapper": base colours under white light come out as they
 * were set, up to 0.8, and highlights are compressed towards white. */
static inline hdrp_v3 rd_tonemap(hdrp_v3 c)
{
    const float start = 0.8f - 0.04f; /* where compression begins; 0.04 is the F0 it takes away */
    const float desaturation = 0.15f;
    const float d = 1.0f - start;
    hdrp_v3 v = hdrp_v3_max(c, 0.0f);
    float low = hdrp_min(v.x, hdrp_min(v.y, v.z));
    float offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
    float peak, limited, white;
    v = hdrp_v3_sub(v, hdrp_v3_splat(offset));
    peak = hdrp_v3_max_component(v);
    if (!(peak >= start)) {
        return v;
    }
    peak = hdrp_min(peak, 1e18f);
    limited = 1.0f - d * d / (peak + d - start);
    white = 1.0f - 1.0f / (desaturation * (peak - limited) + 1.0f);
    v = hdrp_v3_scale(v, limited / peak);
    return hdrp_v3_saturate(hdrp_v3_lerp(v, hdrp_v3_splat(limited), white));
}

#endif
