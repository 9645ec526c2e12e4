#define HDRP_OIT_IMPLEMENTATION
#include "oit.h"

hdrp_oit_mode rd_oit_mode(rd_oit oit)
{
    switch (oit) {
    case RD_OIT_MCGUIRE:
        return HDRP_OIT_MODE_EQ7;
    case RD_OIT_VOLITION:
        return HDRP_OIT_MODE_TALK;
    case RD_OIT_FRONT:
        return HDRP_OIT_MODE_FRONT;
    case RD_OIT_MOMENTS:
        return HDRP_OIT_MODE_MOMENTS_6;
    case RD_OIT_WAVELET:
        return HDRP_OIT_MODE_WAVELET;
    default:
        return HDRP_OIT_MODE_RECOMMENDED;
    }
}

float rd_oit_unit(float exposure)
{
    return ldexpf(1.0f, (int)floorf(log2f(exposure) + 0.5f));
}
