/* evaluate_light.c - a 1000 lm reflector over a floor: illuminance, luminance, camera exposure.
 * SPDX-License-Identifier: MIT
 *
 *     cc -I. examples/evaluate_light.c -lm && ./a.out
 *
 * Exits with 1 when the numbers are implausible. */
#include <stdio.h>

#include "hdrp_light.h"

#define LUMEN     1000.0f /* a bright household lamp */
#define INNER_RAD 0.30f
#define OUTER_RAD 0.45f
#define RANGE_M   20.0f
#define ALBEDO    0.18f

static hdrp_light lamp_at(float height_m)
{
    float candela = hdrp_light_candela_from_lumen_spot(LUMEN, INNER_RAD, OUTER_RAD);
    return hdrp_light_spot(hdrp_v3_make(0.0f, height_m, 0.0f), hdrp_v3_make(0.0f, -1.0f, 0.0f),
                           hdrp_v3_splat(candela), RANGE_M, INNER_RAD, OUTER_RAD);
}

/* The lamp's whole light on a floor that it stands over: lux times area, in rings. */
static float lumen_on_floor(hdrp_light lamp, float radius_m)
{
    const int rings = 2000;
    float sum = 0.0f, step_m = radius_m / (float)rings;
    for (int i = 0; i < rings; ++i) {
        float r = ((float)i + 0.5f) * step_m;
        hdrp_light_incident in = hdrp_light_eval(lamp, hdrp_v3_make(r, 0.0f, 0.0f));
        sum += in.illuminance.x * in.l.y * HDRP_TWO_PI * r * step_m; /* l.y is n_dot_l */
    }
    return sum;
}

static int report(float height_m, float* lux)
{
    hdrp_light lamp = lamp_at(height_m);
    hdrp_light_incident in = hdrp_light_eval(lamp, hdrp_v3_splat(0.0f));
    float nits = in.illuminance.x * in.l.y * ALBEDO * HDRP_INV_PI;
    float ev100 = hdrp_light_ev100_from_nits(nits);
    /* At f/2.8 and ISO 100, EV100 = log2(2.8^2 / t). */
    float shutter_s = 2.8f * 2.8f / hdrp_exp2(ev100);
    float pixel = nits * hdrp_light_exposure_standard_output(
                             hdrp_light_ev100_from_camera(2.8f, shutter_s, 100.0f));
    *lux = in.illuminance.x;
    printf("%6.2f m %9.1f lux %8.2f nits  EV100 %5.2f  1/%-6.1f s  pixel %.3f\n", (double)height_m,
           (double)*lux, (double)nits, (double)ev100, 1.0 / (double)shutter_s, (double)pixel);
    /* A metered surface renders as K q 0.18 / 10 = 0.146, however bright it is. */
    return pixel > 0.14f && pixel < 0.15f && in.distance_m == height_m;
}

int main(void)
{
    const float heights_m[] = {0.5f, 1.0f, 2.0f, 4.0f, 8.0f};
    float lux[5], floor_lumen;
    int good = 1;
    printf("%.0f lm, full within %.1f and dark beyond %.1f degrees, 18 %% grey floor, f/2.8\n",
           (double)LUMEN, (double)INNER_RAD * 57.2957795, (double)OUTER_RAD * 57.2957795);
    for (int i = 0; i < 5; ++i) {
        good &= report(heights_m[i], &lux[i]);
        /* The inverse square, less what the window takes near the range. */
        good &= i == 0 || (lux[i] <= lux[i - 1] * 0.2501f && lux[i] >= lux[i - 1] * 0.23f);
    }
    floor_lumen = lumen_on_floor(lamp_at(1.0f), 0.6f);
    printf("on the floor, 1 m below the lamp: %.1f lm\n", (double)floor_lumen);
    good &= floor_lumen > 0.999f * LUMEN && floor_lumen < 1.001f * LUMEN;
    printf("%s\n", good ? "plausible" : "implausible");
    return good ? 0 : 1;
}
