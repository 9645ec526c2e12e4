/* sweeps_light.c - functions of one float of hdrp_light.h.
 * SPDX-License-Identifier: MIT */
#include "exhaustive.h"

#include "hdrp_light.h"

EX_VALUES(light_candela_point, hdrp_light_candela_from_lumen_point)
EX_ERROR(light_candela_point, ex_relative(EX_Y(0), x / (4.0 * EX_PI)))
EX_VALUES(light_candela_occluder, hdrp_light_candela_from_lumen_spot_occluder)

EX_VALUES(light_lumen_point, hdrp_light_lumen_from_candela_point)
EX_ERROR(light_lumen_point, ex_relative(EX_Y(0), x*(4.0 * EX_PI)))
EX_VALUES(light_lumen_occluder, hdrp_light_lumen_from_candela_spot_occluder)

/* 2 pi (1 - cos a), by its series where that cancels. */
static double cap(double a)
{
    double q = a * a;
    double series = 0.5 * q * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0)));
    return 2.0 * EX_PI * (a < 0.05 ? series : 1.0 - cos(a));
}

EX_VALUES(light_solid_angle_cone, hdrp_light_solid_angle_cone)
EX_ERROR(light_solid_angle_cone, ex_relative(EX_Y(0), cap(0.5 * x)))

EX_VALUES(light_nits_ev100, hdrp_light_nits_from_ev100)
EX_ERROR(light_nits_ev100, ex_relative(EX_Y(0), exp2(x) * 12.5 / 100.0))

EX_VALUES(light_ev100_nits, hdrp_light_ev100_from_nits)
EX_ERROR(light_ev100_nits, ex_absolute(EX_Y(0), log2(x * 100.0 / 12.5)))

EX_VALUES(light_lux_ev100, hdrp_light_lux_from_ev100)
EX_ERROR(light_lux_ev100, ex_relative(EX_Y(0), exp2(x) * 250.0 / 100.0))

EX_VALUES(light_ev100_lux, hdrp_light_ev100_from_lux)
EX_ERROR(light_ev100_lux, ex_absolute(EX_Y(0), log2(x * 100.0 / 250.0)))

/* Exposure q L t / N^2 at speed S, where N^2 / t = 2^ev S / 100, is 78 / S or 10 / S. */
EX_VALUES(light_nits_saturation, hdrp_light_nits_max_saturation)
EX_ERROR(light_nits_saturation, ex_relative(EX_Y(0), exp2(x) * 78.0 / 65.0))
EX_VALUES(light_exposure_saturation, hdrp_light_exposure_saturation)
EX_ERROR(light_exposure_saturation, ex_relative(EX_Y(0), exp2(-x) * 65.0 / 78.0))
EX_VALUES(light_nits_standard_output, hdrp_light_nits_max_standard_output)
EX_ERROR(light_nits_standard_output, ex_relative(EX_Y(0), exp2(x) * 10.0 / 65.0 / 0.18))
EX_VALUES(light_exposure_standard_output, hdrp_light_exposure_standard_output)
EX_ERROR(light_exposure_standard_output, ex_relative(EX_Y(0), exp2(-x) * 65.0 * 0.18 / 10.0))

EX_VALUES(light_inv_range_sq, hdrp_light_inv_range_sq)
EX_ERROR(light_inv_range_sq, ex_relative(EX_Y(0), 1.0 / x / x))

const ex_sweep ex_sweeps_light[] = {
    EX_SWEEP(hdrp_light_candela_from_lumen_point, light_candela_point,
             EX_CLAIM(light_candela_point, 1.5e-37f, FLT_MAX)),
    EX_SWEEP(hdrp_light_candela_from_lumen_spot_occluder, light_candela_occluder, EX_NO_CLAIM),
    EX_SWEEP(hdrp_light_lumen_from_candela_point, light_lumen_point,
             EX_CLAIM(light_lumen_point, FLT_MIN, 2.7e37f)),
    EX_SWEEP(hdrp_light_lumen_from_candela_spot_occluder, light_lumen_occluder, EX_NO_CLAIM),
    EX_SWEEP(hdrp_light_solid_angle_cone, light_solid_angle_cone,
             EX_CLAIM(light_solid_angle_cone, 2e-18f, HDRP_TWO_PI)),
    EX_SWEEP(hdrp_light_nits_from_ev100, light_nits_ev100,
             EX_CLAIM(light_nits_ev100, -120.0f, 120.0f)),
    EX_SWEEP(hdrp_light_ev100_from_nits, light_ev100_nits,
             EX_CLAIM(light_ev100_nits, 1.5e-39f, 4.2e37f)),
    EX_SWEEP(hdrp_light_lux_from_ev100, light_lux_ev100,
             EX_CLAIM(light_lux_ev100, -120.0f, 120.0f)),
    EX_SWEEP(hdrp_light_ev100_from_lux, light_ev100_lux,
             EX_CLAIM(light_ev100_lux, 3e-38f, FLT_MAX)),
    EX_SWEEP(hdrp_light_nits_max_saturation, light_nits_saturation,
             EX_CLAIM(light_nits_saturation, -120.0f, 120.0f)),
    EX_SWEEP(hdrp_light_exposure_saturation, light_exposure_saturation,
             EX_CLAIM(light_exposure_saturation, -120.0f, 120.0f)),
    EX_SWEEP(hdrp_light_nits_max_standard_output, light_nits_standard_output,
             EX_CLAIM(light_nits_standard_output, -120.0f, 120.0f)),
    EX_SWEEP(hdrp_light_exposure_standard_output, light_exposure_standard_output,
             EX_CLAIM(light_exposure_standard_output, -120.0f, 120.0f)),
    EX_SWEEP(hdrp_light_inv_range_sq, light_inv_range_sq,
             EX_CLAIM(light_inv_range_sq, 1e-6f, 9.9e17f)),
    {NULL, NULL, 0, NULL, {EX_NO_CLAIM}},
};
