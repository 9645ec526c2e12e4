#!/usr/bin/env python3
"""Derives the coefficients of hdrp_cull_log2 in hdrp_cull_grid.h; needs what fit_math.py needs.

log2(1 + m) = m + m (1 - m) q(m) on [0,1], so that powers of 2 are exact: q is minimax in the
absolute error of the logarithm. Prints the coefficients, lowest power first.
"""
import mpmath as mp

from fit_math import nudged, remez, show


def main():
    def target(m):
        m = nudged(m, 0, 1)
        return (mp.log(1 + m, 2) - m) / (m * (1 - m))
    show("cull_log2, absolute, q of m^0..2", remez(target, lambda m: m * (1 - m), range(3), 0, 1))


if __name__ == "__main__":
    main()
