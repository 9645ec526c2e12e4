"""Small source trees for the tests of the tools: one that is right, and changes that break it."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))

MATH = '''/* hdrp_math.h - the vocabulary.
 *
 * >>index of the functions, without hdrp_ (written by tools/api_check.py --write)
 *   language layer: sqrt
 *   sampling: disk
 * >>end */
#ifndef HDRP_MATH_H
#define HDRP_MATH_H

#define HDRP_VERSION_MAJOR 1
#define HDRP_VERSION_MINOR 2
#define HDRP_VERSION_PATCH 3
#define HDRP_VERSION 10203

/* >>language layer */

#include <math.h>
#include <stdint.h>
#define HDRP_FN static inline
#define HDRP_API extern
#define HDRP_TYPEDEF(T) typedef struct T T;
typedef uint32_t hdrp_u32;
struct hdrp_v2 {
    float x, y;
};
HDRP_TYPEDEF(hdrp_v2)
struct hdrp_v3 {
    float x, y, z;
};
HDRP_TYPEDEF(hdrp_v3)

/** Square root; x >= 0. */
HDRP_FN float hdrp_sqrt(float x)
{
    return sqrtf(x);
}

/* >>sampling */

/** Radius of a point on the unit disk.
 *  u        [0,1]  uniform
 *  returns  [0,1]
 *  edges    none
 *  error    none: a definition
 *  source   Shirley and Chiu 1997, "A Low Distortion Map" */
HDRP_FN float hdrp_disk(float u)
{
    return hdrp_sqrt(u);
}

#endif
'''

BRDF = '''/* hdrp_brdf.h - lobes.
 *
 * >>index of the functions, without hdrp_brdf_ (written by tools/api_check.py --write)
 *   lobes: inverse mix
 *   algorithm layer: bake
 * >>end */
#ifndef HDRP_BRDF_H
#define HDRP_BRDF_H

#include "hdrp_math.h"

#if HDRP_VERSION != 10203
#error "hdrp_brdf.h 1.2.3 needs the hdrp_math.h of the same version"
#endif

#define HDRP_BRDF_LOW 0.5f

/* >>lobes */

/* Two weights. */
struct hdrp_brdf_pair {
    float first;  /* [0,1] */
    float second; /* [0,1] */
};
HDRP_TYPEDEF(hdrp_brdf_pair)

/** One over x.
 *  x        [HDRP_BRDF_LOW,1]  any
 *           length
 *  returns  [1,2]
 *  edges    none
 *  error    <= 1e-7 relative against division in double, over the whole
 *           range  @accuracy brdf_inverse
 *  source   arithmetic */
HDRP_FN float hdrp_brdf_inverse(float x)
{
    return 1.0f / x;
}

/** The mean of two weights.
 *  p         valid  the weights
 *  returns   [0,1]
 *  edges     none
 *  error     none: a definition
 *  source    arithmetic */
HDRP_FN float hdrp_brdf_mix(hdrp_brdf_pair p)
{
    return 0.5f * (p.first + p.second);
}

/* >>algorithm layer: C and C++ only */
#ifndef HDRP_GPU
#ifdef __cplusplus
extern "C" {
#endif

/** Fills a table.
 *  out      the table, owned by the caller
 *  count    [1,1024]  entries
 *  returns  0, or 1 when count is out of range
 *  edges    on an error the table is untouched */
HDRP_API int hdrp_brdf_bake(float* out,
                            hdrp_u32 count);

#ifdef __cplusplus
}
#endif
#endif /* HDRP_GPU */
#endif /* HDRP_BRDF_H */

#ifdef HDRP_BRDF_IMPLEMENTATION
#ifndef HDRP_BRDF_IMPLEMENTED
#define HDRP_BRDF_IMPLEMENTED

static double hdrp_i_brdf_half(double x)
{
    return 0.5 * x;
}

int hdrp_brdf_bake(float* out, hdrp_u32 count)
{
    if (count < 1u || count > 1024u) {
        return 1;
    }
    for (hdrp_u32 i = 0u; i < count; ++i) {
        out[i] = (float)hdrp_i_brdf_half((double)i);
    }
    return 0;
}

#endif
#endif
'''

TESTS = '''#include "hdrp_brdf.h"
int main(void)
{
    return hdrp_sqrt(1.0f) == hdrp_disk(1.0f) && hdrp_brdf_bake(0, 0u) && hdrp_brdf_mix(pair());
}
'''

REGISTRY = 'const acc_entry acc_brdf[] = {{"brdf_inverse", f}}; /* hdrp_brdf_inverse */\n' \
           'int used = hdrp_brdf_inverse(1.0f);\n'

SWEEPS = 'const ex_sweep ex_sweeps[] = {EX_SWEEP(hdrp_disk, d), EX_SWEEP(hdrp_brdf_inverse, i)};\n'

FILES = {"hdrp_math.h": MATH, "hdrp_brdf.h": BRDF, "tests/unit/test_brdf.c": TESTS,
         "tests/accuracy/acc_brdf.c": REGISTRY, "tests/exhaustive/sweeps.c": SWEEPS}


class TreeTest(unittest.TestCase):
    """A test with a temporary tree of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name, text in FILES.items():
            self.write(name, text)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def change(self, name, old, new):
        """Replaces a text that must be there."""
        text = (self.root / name).read_text(encoding="utf-8")
        self.assertIn(old, text, "the test changes a text that is not there")
        self.write(name, text.replace(old, new, 1))
