/* mutant.h - switches for the faults that tools/mutate.py writes into copies of the headers.
 * SPDX-License-Identifier: MIT
 *
 * hdrp_mutant is the number of the fault that is on, 0 for none. Every fault whose place is passed
 * is noted in hdrp_mutant_reached, so that only tests that get there need to be run for it. */
#ifndef MUTANT_H
#define MUTANT_H

#define HDRP_MUTANT_MAX 16384

extern int hdrp_mutant;
extern float hdrp_mutant_factor; /* what a constant is multiplied by */
extern unsigned char hdrp_mutant_reached[HDRP_MUTANT_MAX];

#define HDRP_MUTANT_ON(k)            (hdrp_mutant_reached[k] = 1, hdrp_mutant == (k))
#define HDRP_MUTANT_SCALE(k, c)      ((c) * (HDRP_MUTANT_ON(k) ? hdrp_mutant_factor : 1.0f))
#define HDRP_MUTANT_SIGN(k)          (HDRP_MUTANT_ON(k) ? -1 : 1)
#define HDRP_MUTANT_NOT(k, c)        ((c) != HDRP_MUTANT_ON(k))
#define HDRP_MUTANT_RECIPROCAL(k, c) (HDRP_MUTANT_ON(k) ? (__typeof__(c))(1.0f / (float)(c)) : (c))

#endif
