#!/usr/bin/env python3
"""Derives the fitted constants of hdrp_math.h: fit_math.py [NAME...]

Needs numpy, mpmath and scipy (Debian: python3-numpy python3-mpmath python3-scipy); the build and
the tests do not run it. Each NAME prints the coefficients, lowest power first, and the largest
error of the fit before its coefficients are rounded to float; tests/accuracy measures the error
of the float functions.
"""
import pathlib
import re
import sys

import mpmath as mp
import numpy as np
from scipy.optimize import linprog

mp.mp.dps = 40
ROOT = pathlib.Path(__file__).resolve().parent.parent
GRID = 2001


def chebyshev_grid(lo, hi, count=GRID):
    return 0.5 * (lo + hi) - 0.5 * (hi - lo) * np.cos(np.pi * np.arange(count) / (count - 1))


def alternating_extrema(error, count):
    """Indices of the largest errors of alternating sign, reduced to count of them."""
    sign = np.where(error < 0, -1, 1)
    pieces = np.split(np.arange(len(error)), np.flatnonzero(sign[1:] != sign[:-1]) + 1)
    found = [p[np.argmax(abs(error[p]))] for p in pieces]
    while len(found) > count:
        smallest = int(np.argmin([abs(error[k]) for k in found]))
        if len(found) == count + 1 or smallest in (0, len(found) - 1):
            del found[0 if abs(error[found[0]]) < abs(error[found[-1]]) else -1]
        else:
            before, after = abs(error[found[smallest - 1]]), abs(error[found[smallest + 1]])
            drop = {smallest, smallest - 1 if before < after else smallest + 1}
            found = [k for i, k in enumerate(found) if i not in drop]
    return found


def remez(target, weight, powers, lo, hi):
    """Minimises the largest |weight (target - sum c_k x^powers_k)|; returns (error, c).

    Pin a value by dividing a factor that vanishes there out of the target and multiplying the
    weight by it: the exchange needs no constraint then."""
    n = len(powers)
    x = chebyshev_grid(lo, hi)
    f = np.array([float(target(mp.mpf(t))) for t in x], dtype=np.longdouble)
    w = np.array([float(weight(mp.mpf(t))) for t in x], dtype=np.longdouble)
    basis = np.array([x.astype(np.longdouble)**p for p in powers])
    chosen = list(np.round(np.linspace(0, GRID - 1, n + 3)[1:-1]).astype(int))
    best = (np.inf, None)
    for _ in range(60):
        a, y = mp.matrix(n + 1, n + 1), mp.matrix(n + 1, 1)
        for row, i in enumerate(chosen):
            for k in range(n):
                a[row, k] = mp.mpf(float(basis[k, i])) * mp.mpf(float(w[i]))
            a[row, n] = (-1)**row
            y[row] = mp.mpf(float(f[i])) * mp.mpf(float(w[i]))
        solution = mp.lu_solve(a, y)
        c = np.array([np.longdouble(mp.nstr(solution[k], 25)) for k in range(n)])
        error = w * (f - (c[:, None] * basis).sum(0))
        worst = float(abs(error).max())
        if worst < best[0]:
            best = (worst, [float(v) for v in c])
        found = alternating_extrema(error, n + 1)
        if len(found) < n + 1 or found == chosen:
            break
        chosen = found
    return best


def show(name, fit):
    error, coefficients = fit
    print(f"{name}: {error:.3g}")
    print("   ", " ".join(f"{np.float32(c):.9g}" for c in coefficients))


def nudged(x, lo, hi):
    """x, kept off the ends of the interval, where a removable singularity sits."""
    return min(max(x, mp.mpf(lo) + mp.mpf(10)**-15), mp.mpf(hi) - mp.mpf(10)**-15)


def acos():
    """acos(x) = sqrt(1 - x) (pi/2 + c1 x + ...) on [0,1]: continuous at 0 with its mirror image."""
    def target(x):
        x = nudged(x, 0, 1)
        return (mp.acos(x) / mp.sqrt(1 - x) - mp.pi / 2) / x
    def weight(x):
        x = nudged(x, 0, 1)
        return x * mp.sqrt(1 - x) / mp.acos(x)
    show("acos, relative, x^1..5", remez(target, weight, range(5), 0, 1))
    def arcsine(z):
        z = nudged(z, 0, 1)
        return (mp.asin(mp.sqrt(z)) / mp.sqrt(z) - 1) / z
    show("exact acos: asin(s) = s + s z P(z), z = s^2 up to 1/4, relative, z^0..4",
         remez(arcsine, lambda z: z * mp.sqrt(z) / mp.asin(mp.sqrt(nudged(z, 0, 1))), range(5), 0,
               0.25))


def atan():
    """atan(t) = t + t^3 (c1 + c2 t^2 + ...) on [0,1]: small angles keep their relative precision."""
    def target(t):
        t = nudged(t, 0, 1)
        return (mp.atan(t) - t) / t**3
    def weight(t):
        return t**3 / mp.atan(nudged(t, 0, 1))
    show("atan, relative, t^3..13", remez(target, weight, range(0, 12, 2), 0, 1))
    show("exact atan, relative, t^3..17", remez(target, weight, range(0, 16, 2), 0, 1))
    for name, whole in (("pi", mp.pi), ("half pi", mp.pi / 2)):
        print(f"{name} less its float: {mp.nstr(whole - mp.mpf(float(np.float32(float(whole)))), 9)}")


def exp2():
    """2^f = 1 + f (c1 + c2 f + ...) on [-1/2,1/2]. The error at both ends is the same, so that the
    pieces join."""
    def target(f):
        f = f if f else mp.mpf(10)**-15
        return (mp.power(2, f) - 1) / f
    show("exp2, relative, f^1..5",
         remez(target, lambda f: abs(f) * mp.power(2, -f), range(5), -0.5, 0.5))


def log2():
    """log2 m = s (c0 + c1 s^2 + c2 s^4), s = (m-1)/(m+1), m in [sqrt 1/2, sqrt 2]."""
    end = 3 - 2 * mp.sqrt(2)
    def target(s):
        s = nudged(s, 0, end)
        return mp.log((1 + s) / (1 - s), 2) / s
    show("log2, relative, s^1,3,5", remez(target, lambda s: 1 / target(s), range(0, 6, 2), 0, float(end)))


def rsqrt_range(magic):
    """The range of w = x y^2 for y = the float with bits magic - bits(x) / 2."""
    x = np.linspace(1, 4, 300001).astype(np.float32)
    y = (np.uint32(magic) - (x.view(np.uint32) >> 1)).view(np.float32)
    w = x.astype(float) * y.astype(float)**2
    return w.min(), w.max()


def rsqrt():
    """1/sqrt(x) = y P(w): the magic constant with the narrowest w, and P against 1/sqrt(w)."""
    magic = min(range(0x5f000000, 0x5f800000, 0x8000),
                key=lambda m: (lambda r: r[1] / r[0])(rsqrt_range(m)))
    lo, hi = rsqrt_range(magic)
    print(f"rsqrt: magic {magic:#x}, w in [{lo:.6f}, {hi:.6f}]")
    show("rsqrt, relative, w^0..3", remez(lambda w: 1 / mp.sqrt(w), mp.sqrt, range(4), lo, hi))


def sincos():
    """Quarter turns for the plain version, half turns for the fast one."""
    def sine(x):
        x = nudged(x, 0, 4)
        return (mp.sin(x) - x) / x**3
    def cosine(x):
        x = nudged(x, 0, 4)
        return (mp.cos(x) - 1) / x**2
    def cosine4(x):
        x = nudged(x, 0, 4)
        return (mp.cos(x) - 1 + x**2 / 2) / x**4
    quarter, half = float(mp.pi / 4), float(mp.pi / 2)
    show("sin, x^3,5,7, |x| <= pi/4", remez(sine, lambda x: x**3, (0, 2, 4), 0, quarter))
    show("cos, x^4,6,8, |x| <= pi/4", remez(cosine4, lambda x: x**4, (0, 2, 4), 0, quarter))
    show("fast sin, x^3,5,7, |x| <= pi/2", remez(sine, lambda x: x**3, (0, 2, 4), 0, half))
    show("fast cos, x^2,4,6, |x| <= pi/2", remez(cosine, lambda x: x**2, (0, 2, 4), 0, half))
    rest = mp.pi / 2
    for name, bits in (("1", 8), ("2", 11), ("3", 24)):
        scale = mp.mpf(2)**(bits - 1 - mp.floor(mp.log(rest, 2)))
        part = mp.nint(rest * scale) / scale
        print(f"half pi, part {name} ({bits} bits): {mp.nstr(part, 17)}")
        rest -= part


def pinned(curve, lo, at_lo, degree, relative):
    """A polynomial on [lo,1] that is at_lo at lo and, summed in floats, exactly 1 at 1."""
    lo, at_lo = mp.mpf(lo), mp.mpf(at_lo)
    line = [(at_lo - lo) / (1 - lo), (1 - at_lo) / (1 - lo)]
    def target(x):
        x = nudged(x, lo, 1)
        return (curve(x) - line[0] - line[1] * x) / ((1 - x) * (x - lo))
    def weight(x):
        return (1 - x) * (x - lo) / (curve(x) if relative else 1)
    error, r = remez(target, weight, range(degree - 1), float(lo), 1.0)
    c = np.polynomial.polynomial.polymul(r, [-float(lo), 1 + float(lo), -1.0])
    c[:2] += [float(v) for v in line]
    total = np.float32(0)
    for v in reversed(c[1:]):
        total = np.float32(v) + total
    c[0] = np.float32(1) - total
    return error, list(c)


def srgb():
    """Above the linear piece: decoding as a polynomial of the code, encoding of the fourth root.

    The curves start by so much above the linear piece that rounding cannot make a step down."""
    print("encoding pieces cross at", mp.nstr(mp.findroot(
        lambda x: 1.055 * x**(1 / mp.mpf(2.4)) - 0.055 - 12.92 * x, 0.00313), 10))
    knee = mp.mpf("0.04045")
    show("decode, relative, degree 5",
         pinned(lambda c: ((c + mp.mpf("0.055")) / mp.mpf("1.055"))**mp.mpf("2.4"), knee,
                knee / mp.mpf("12.92") * mp.mpf("1.00003"), 5, True))
    knee = mp.mpf("0.0031306")
    show("encode, absolute, degree 4",
         pinned(lambda u: mp.mpf("1.055") * u**(4 / mp.mpf("2.4")) - mp.mpf("0.055"),
                knee**0.25, knee * mp.mpf("12.92") * mp.mpf("1.000005"), 4, False))


def observer(name):
    """(wavelengths in m, 3 rows of colour-matching functions) from the tests' table."""
    text = (ROOT / "tests/accuracy/cie_observers.h").read_text()
    rows = re.search(name + r"\[[^{]*\{(.*?)\n\};", text, re.S)[1]
    table = np.array([[float(v) for v in row.split(",")]
                      for row in re.findall(r"\{([^{}]*)\}", rows)])
    return (360 + 5 * np.arange(len(table))) * 1e-9, table.T


def rec709_from_xyz():
    def xyz(x, y):
        return np.array([x / y, 1.0, (1 - x - y) / y])
    primaries = np.stack([xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06)], 1)
    return np.linalg.inv(primaries * np.linalg.solve(primaries, xyz(0.3127, 0.3290)))


def kelvin():
    """r, g, b up to a common factor as polynomials of u = 1000 K / T with degrees 3, 4, 4.

    For a trial error E, "divided by the largest channel, every channel is within E" is a linear
    programme in all coefficients at once; bisection finds the smallest feasible E."""
    wavelength, cmf = observer("cie_1931_2_degree")
    c2 = 6.62607015e-34 * 299792458.0 / 1.380649e-23
    def rgb(u):
        planck = wavelength**-5 / np.expm1(c2 * u / (wavelength * 1000.0))
        return rec709_from_xyz() @ (cmf @ (planck / planck.max()))
    lo, hi, count, degree = 1 / 40.0, 1.0, 600, (3, 4, 4)
    u = chebyshev_grid(lo, hi, count)
    color = np.array([rgb(t) for t in u])
    largest = np.argmax(color, 1)
    color /= color.max(1)[:, None]
    basis = [np.polynomial.chebyshev.chebvander((2 * u - lo - hi) / (hi - lo), d) for d in degree]
    columns = np.cumsum([0] + [d + 1 for d in degree])
    def channel(k, rows):
        """The rows of the matrix that evaluate channel k."""
        m = np.zeros((rows.sum(), columns[3]))
        m[:, columns[k]:columns[k + 1]] = basis[k][rows]
        return m
    def feasible(bound):
        scale, a = 0.05 / bound, []
        for top in np.unique(largest):
            for k in range(3):
                rows = (largest == top) & (color[:, k] > 0)
                m = channel(top, rows)
                for sign in (1, -1) if k != top else ():
                    a.append(scale * sign * (channel(k, rows) - color[rows, k, None] * m)
                             - scale * bound * m)
                clipped = (largest == top) & (color[:, k] <= 0)
                a.append(scale * channel(k, clipped))
        a = np.vstack(a)
        a = np.hstack([a, -np.ones((len(a), 1))])
        positive = np.hstack([-channel(0, u > 0), np.zeros((count, 1))])
        objective = np.zeros(columns[3] + 1)
        objective[-1] = 1
        fixed_scale = np.zeros((1, columns[3] + 1))
        fixed_scale[0, 0] = 1
        return linprog(objective, A_ub=np.vstack([a, positive]),
                       b_ub=np.r_[np.zeros(len(a)), np.full(count, -0.02)], A_eq=fixed_scale,
                       b_eq=[1], bounds=[(None, None)] * columns[3] + [(-1, None)],
                       method="highs")
    good, bad, solution = 1e-2, 1e-6, None
    for _ in range(20):
        trial = np.sqrt(good * bad)
        result = feasible(trial)
        if result.status == 0 and result.fun <= 1e-9:
            good, solution = trial, result.x
        else:
            bad = trial
    print(f"kelvin, absolute: {good:.3g}")
    factor = None
    for k, name in enumerate("rgb"):
        fit = np.polynomial.Chebyshev(solution[columns[k]:columns[k + 1]], domain=[lo, hi])
        c = fit.convert(kind=np.polynomial.Polynomial).coef
        factor = factor or 1 / c[0]
        print("   ", name, " ".join(f"{np.float32(v * factor):.9g}" for v in c))


FITS = {f.__name__: f for f in (acos, atan, exp2, log2, rsqrt, sincos, srgb, kelvin)}

if __name__ == "__main__":
    for key in sys.argv[1:] or FITS:
        FITS[key]()
