#!/usr/bin/env python3
"""Derives the fitted constants of hdrp_brdf_lobes.h: fit_brdf.py [fgd] [stretch] [film]

Needs numpy and scipy (Debian: python3-numpy python3-scipy); the build and the tests do not run it.
Prints the coefficients in the order of the code, lowest power first, and the largest error of each
fit; tests/accuracy measures the error of the float functions.
"""
import pathlib
import re
import sys

import numpy as np
from scipy.optimize import least_squares

ROOT = pathlib.Path(__file__).resolve().parent.parent
PERCEPTUAL_ROUGHNESS_MIN = 0.01


def lawson(residual, jacobian, x, asymmetry, rounds):
    """Minimises the largest residual, negative ones counted asymmetry times, by reweighting.

    Returns (largest, x, least residual, greatest residual)."""
    weight = np.ones_like(residual(x))
    best = (np.inf, None)
    for _ in range(rounds):
        root = np.sqrt(weight)
        keywords = {} if jacobian is None else {"jac": lambda y: jacobian(y) * root[:, None]}
        x = least_squares(lambda y: residual(y) * root, x, x_scale="jac", max_nfev=25,
                          **keywords).x
        error = residual(x)
        size = np.where(error < 0, -asymmetry, 1.0) * error
        if size.max() < best[0]:
            best = (size.max(), x.copy(), error.min(), error.max())
        weight *= size / size.max() + 1e-3
        weight = np.maximum(weight / weight.mean(), 1e-6)
    return best


def show(name, fit, terms):
    print(f"{name}: {fit[2]:+.5f} {fit[3]:+.5f}")
    start = 0
    for label, low, high in terms:
        count = high - low + 1
        print(f"  {label:10} " + "  ".join(f"{np.float32(c):.9g}f"
                                           for c in fit[1][start:start + count]))
        start += count


# ---- directional albedo ------------------------------------------------------------------------

def albedos(mu, alpha, polar=64, azimuth=32):
    """(albedo for F = 1, the same weighted by Schlick): the azimuth of D in closed form, the rest
    by Gauss-Legendre and midpoint rules."""
    x, w = np.polynomial.legendre.leggauss(polar)
    phi = (np.arange(azimuth) + 0.5) / azimuth * np.pi
    tv, a2 = np.arccos(mu), alpha * alpha
    albedo = schlick = 0.0
    for lo, hi in ((-np.arcsinh(tv / alpha), 0.0), (0.0, np.arcsinh((np.pi / 2 - tv) / alpha))):
        t = 0.5 * (hi - lo) * x + 0.5 * (hi + lo)
        theta = tv + alpha * np.sinh(t)
        cl, sl, sv = np.cos(theta), np.sin(theta), np.sin(tv)
        plus, minus = 0.5 * (theta + tv), 0.5 * (theta - tv)
        near = 2 * np.cos(plus)**2 * (np.sin(minus)**2 + a2 * np.cos(minus)**2)
        far = 2 * np.cos(minus)**2 * (np.sin(plus)**2 + a2 * np.cos(plus)**2)
        q = 2 * (np.cos(plus) * np.cos(minus))**2 * (a2 - 1)
        root = np.sqrt(near * far)
        closed = 1 - 2 * q / root + 0.5 * (near + far) * q * q / root**3
        k, half = np.sqrt(near / far)[:, None], np.tan(0.5 * phi)[None, :]
        u2 = (k * half)**2
        base_q = near[:, None] + (sl * sv)[:, None] * 2 * u2 / (1 + u2)
        e = q[:, None] / base_q
        smooth = 0.5 * (1 + (cl * mu)[:, None] + (sl * sv)[:, None] * np.cos(phi)[None, :])
        weighted = ((e - 2) * e * k * (1 + half**2) / (1 + u2) * schlick_of(base_q - q[:, None]) +
                    schlick_of(2 * smooth)).mean(1)
        gv, gl = np.sqrt(mu * mu * (1 - a2) + a2), np.sqrt(cl * cl * (1 - a2) + a2)
        scale = w * 0.5 * (hi - lo) * alpha * np.cosh(t) * a2 * cl * sl / (cl * gv + mu * gl)
        albedo += np.sum(scale * closed)
        schlick += np.sum(scale * weighted)
    return albedo, schlick


def schlick_of(twice_v_dot_h2):
    return (1 - np.sqrt(np.clip(0.5 * twice_v_dot_h2, 0, 1)))**5


class Grid:
    """1 - albedo and schlick / albedo over roughness (rows) and view, dense at grazing."""

    def __init__(self, rows=64, columns=90):
        p = PERCEPTUAL_ROUGHNESS_MIN + (1 - PERCEPTUAL_ROUGHNESS_MIN) * np.linspace(0, 1, rows)
        self.alpha = np.repeat(p[:, None]**2, columns, 1)
        s = np.linspace(0, 1, columns)[None, :]
        scale = np.minimum(self.alpha, 0.02)
        self.mu = np.clip(scale * np.sinh(s * np.arcsinh(1 / scale)), 1e-6, 1)
        values = [albedos(m, a) for m, a in zip(self.mu.ravel(), self.alpha.ravel())]
        albedo, schlick = np.array(values).T
        self.loss, self.ratio = 1 - albedo, schlick / albedo
        self.alpha, self.mu = self.alpha.ravel(), self.mu.ravel()


class LossModel:
    """1 - albedo as a rational function of t = n_dot_v / alpha, its coefficients polynomials."""

    NUMERATOR = (("loss_n.x", 0, 3), ("loss_n.y", 1, 4))
    DENOMINATOR = (("loss_d.x", 0, 2), ("loss_d.y", 0, 4), ("loss_d.z", 0, 3))
    TERMS = NUMERATOR + DENOMINATOR
    SPLIT = 8  # coefficients in the numerator

    def __init__(self, mu, alpha):
        t = mu / alpha
        scale = np.maximum(t, 1)**-3
        self.one = scale
        self.n, self.d = (np.stack([t**(i + 1) * alpha**k * scale
                                    for i, (_, low, high) in enumerate(terms)
                                    for k in range(low, high + 1)], 1)
                          for terms in (self.NUMERATOR, self.DENOMINATOR))

    def parts(self, x):
        return self.n @ x[:self.SPLIT], self.one + self.d @ x[self.SPLIT:]

    def value(self, x):
        n, d = self.parts(x)
        return n / d

    def jacobian(self, x):
        n, d = self.parts(x)
        return np.concatenate([self.n / d[:, None], -self.d * (n / d**2)[:, None]], 1)

    def start(self, target):
        """Linear least squares, reweighted by the last denominator (Sanathanan and Koerner)."""
        d = np.ones_like(target)
        for _ in range(12):
            a = np.concatenate([self.n, -self.d * target[:, None]], 1) / d[:, None]
            x = np.linalg.lstsq(a, target * self.one / d, rcond=1e-13)[0]
            d = np.maximum(self.parts(x)[1], 1e-9)
        return x


class RatioModel:
    """schlick / albedo = (1 - m)^5, m an effective cosine between view and half vector."""

    TERMS = (("cosine_n.x", 1, 5), ("cosine_n.y", 0, 2), ("cosine_d", 0, 3))
    # Optima at single roughnesses: perceptual roughness and the three coefficients.
    SEEDS = np.array([[1.0, 0.458, -0.663, -0.166], [0.717, 0.380, -0.596, 0.110],
                      [0.434, 0.243, -0.470, 0.284], [0.246, 0.124, -0.323, 0.478],
                      [0.151, 0.064, -0.231, 0.613], [0.057, 0.015, -0.164, 0.794]])

    def __init__(self, mu, alpha):
        self.mu, self.t = mu, mu / alpha
        p = np.sqrt(alpha)
        self.powers = [np.stack([p**k for k in range(low, high + 1)], 1)
                       for _, low, high in self.TERMS]

    def value(self, x):
        c = np.split(x, np.cumsum([p.shape[1] for p in self.powers])[:-1])
        a, b, d = (p @ part for p, part in zip(self.powers, c))
        m = self.mu + (a + b * self.mu) / (1 + d * self.t)
        return (1 - np.clip(m, 0, 1))**5

    def start(self):
        p = self.SEEDS[:, 0]
        return np.concatenate([
            np.linalg.lstsq(np.stack([p**k for k in range(low, high + 1)], 1),
                            self.SEEDS[:, 1 + i], rcond=None)[0]
            for i, (_, low, high) in enumerate(self.TERMS)])


def fit_mean(name, p, target, weight, low, high):
    """Polynomial in p with the least largest weighted error."""
    powers = np.stack([p**k for k in range(low, high + 1)], 1)
    fit = lawson(lambda c: (powers @ c - target) * weight, lambda c: powers * weight[:, None],
                 np.linalg.lstsq(powers, target, rcond=None)[0], 1.0, 60)
    show(name, fit, [("", low, high)])


def fgd():
    grid = Grid()
    loss_model = LossModel(grid.mu, grid.alpha)
    # An albedo that is too small would let the diffuse lobe gain energy: count it 1.5 times.
    loss = lawson(lambda x: grid.loss - loss_model.value(x), lambda x: -loss_model.jacobian(x),
                  loss_model.start(grid.loss), 1.5, 60)
    show("albedo", loss, LossModel.TERMS)
    ratio_model = RatioModel(grid.mu, grid.alpha)
    ratio = lawson(lambda x: ratio_model.value(x) - grid.ratio, None, ratio_model.start(), 1.5, 60)
    show("ratio", ratio, RatioModel.TERMS)
    means(loss[1].astype(np.float32), ratio[1].astype(np.float32))


def means(loss, ratio):
    """Cosine-weighted means over the hemisphere of what the fits above give."""
    p = np.linspace(PERCEPTUAL_ROUGHNESS_MIN, 1, 200)
    x, w = np.polynomial.legendre.leggauss(400)
    mean_loss, mean_schlick, largest = [], [], []
    for alpha in p * p:
        # Nodes gathered at grazing, where t = n_dot_v / alpha is of the order of 1.
        top = np.arcsinh(1 / alpha)
        s = 0.5 * top * (x + 1)
        mu = np.clip(alpha * np.sinh(s), 0, 1)
        weight = w * 0.5 * top * alpha * np.cosh(s) * 2 * mu
        a = np.full_like(mu, alpha)
        lost, share = LossModel(mu, a).value(loss), RatioModel(mu, a).value(ratio)
        mean_loss.append(np.sum(weight * lost))
        mean_schlick.append(np.sum(weight * share * (1 - lost)))
        largest.append(0.04 + np.max(lost[mu >= 0.05]))
    mean_loss, mean_schlick = np.array(mean_loss), np.array(mean_schlick)
    # The reciprocal behaves better. An error of it shows in proportion to the loss itself.
    target = p**4 / mean_loss
    fit_mean("alpha^2 / mean_loss", p, target, np.array(largest) / target, 0, 6)
    fit_mean("mean_schlick", p, mean_schlick, np.ones_like(p), 0, 4)


# ---- directional albedo, anisotropic -----------------------------------------------------------

# The isotropic fits as hdrp_brdf_lobes.h has them, lowest power of alpha or of its root first. The
# corrections for stretched lobes are added to them and vanish for equal widths.
ISO_LOSS = ((0.230199918, 0.0611920953, 3.76339936, 1.48308444),
            (0, -0.180100933, 7.54789209, -13.2210388, 89.1957245),
            (0.674825966, 5.26004457, 32.7332573),
            (0.127423942, -6.9580822, 11.5299244, 38.5920219, 50.5328941),
            (0.310372114, 1.56204367, 26.442585, -33.816391))
ISO_COSINE = ((0, 0.108742684, 2.90460491, -6.76332474, 6.75303411, -2.55623007),
              (-0.16311945, -0.653872967, 0.128006995),
              (0.72819525, -1.34152937, 1.71405375, -1.40320504))
ISO_MEAN_LOSS = (0.0636951923, 2.37435579, -12.3076382, 39.3234062, -60.8898277, 46.7970543,
                 -13.6633568)
ISO_MEAN_SCHLICK = (0.0467854775, 0.0539289117, -0.480697751, 0.645444334, -0.262367249)


def polynomial(coefficients, x):
    return np.polynomial.polynomial.polyval(x, coefficients)


def stretched_albedos(mu, phi, at, ab, side=88):
    """(albedo for F = 1, the same weighted by Schlick) by visible normals (Dupuy and Benyoub 2023)
    of stratified numbers."""
    u = (np.arange(side) + 0.5) / side
    turn, z = 2 * np.pi * u[:, None], u[None, :]
    s = np.sqrt(1 - mu * mu)
    v = np.array([s * np.cos(phi), s * np.sin(phi), mu])
    w = np.array([at * v[0], ab * v[1], v[2]])
    w /= np.sqrt(w @ w)
    z = (1 - z) * (1 + w[2]) - w[2]
    r = np.sqrt(np.clip(1 - z * z, 0, 1))
    h = np.stack([at * (r * np.cos(turn) + w[0]), ab * (r * np.sin(turn) + w[1]),
                  np.maximum(z + w[2], 1e-12) + 0 * turn])
    h /= np.sqrt((h * h).sum(0))
    c = np.tensordot(v, h, 1)
    l = 2 * c * h - v[:, None, None]

    def shadowing(x, y, z):
        return 0.5 * np.sqrt(1 + ((at * x)**2 + (ab * y)**2) / np.maximum(z, 1e-9)**2) - 0.5

    own = 1 + shadowing(*v)
    kept = np.where(l[2] > 0, own / (own + shadowing(*l)), 0)
    return kept.mean(), (kept * (1 - np.clip(c, 0, 1))**5).mean()


class StretchedGrid:
    """Albedos over roughness, anisotropy and direction, with the variables of the fit."""

    ANISOTROPIES = (0.12, 0.25, 0.38, 0.5, 0.62, 0.75, 0.85, 0.93, 0.98, 1.0)
    AZIMUTHS = np.radians((0, 20, 40, 55, 65, 73, 80, 86, 90))

    def __init__(self, rows=19, columns=26):
        p = PERCEPTUAL_ROUGHNESS_MIN + (1 - PERCEPTUAL_ROUGHNESS_MIN) * np.linspace(0, 1, rows)
        table = []
        for alpha in p * p:
            for k in self.ANISOTROPIES:
                at, ab = np.maximum(alpha * np.array((1 + k, 1 - k)), 1e-4)
                scale = np.clip(0.5 * ab, 3e-4, 0.02)
                s = np.arange(1, columns + 1) / columns
                for mu in np.minimum(scale * np.sinh(s * np.arcsinh(1 / scale)), 1):
                    table += [(at, ab, mu, phi, *stretched_albedos(mu, phi, at, ab))
                              for phi in self.AZIMUTHS]
        self.at, self.ab, self.mu, phi, self.albedo, schlick = np.array(table).T
        self.loss, self.ratio = 1 - self.albedo, schlick / self.albedo
        s = np.sqrt(1 - self.mu**2)
        self.x, self.y = s * np.cos(phi), s * np.sin(phi)


class Stretch:
    """Variables of the fit: mean width, anisotropy, cosine over the width towards the direction,
    and the azimuth in the space where the lobe is round."""

    def __init__(self, at, ab, x, y, mu):
        self.mu, self.alpha, self.k = mu, 0.5 * (at + ab), (at - ab) / (at + ab)
        x2, y2, z2 = (at * x)**2, (ab * y)**2, 0.5 * (at**2 + ab**2) * mu**2
        along = x2 + y2 + z2  # squared width in the plane of the direction
        across = np.maximum(at**2 + ab**2 - along, 0)
        self.t = mu / np.sqrt(along)
        self.turn = (x2 - y2) / along
        # Facets that are tilted sideways are met at grazing angles, as those of narrow lobes are.
        self.lobe = np.sqrt(along * (1 + 1.5 * along) / (1 + 1.5 * across))

    def columns(self, terms, base):
        """One column for each coefficient: parts are even, odd and quadratic in the azimuth."""
        part = (self.k**2, self.k * self.turn, (self.k * self.turn)**2)
        return [part[i] * base**n for i, powers in enumerate(terms) for n in powers]


def powers(low, high):
    return range(low, high + 1)


# For each coefficient the powers in its even, odd and quadratic part.
LOSS_TERMS = tuple((p, p, q) for p, q in (
    (powers(0, 3), powers(0, 3)), (powers(1, 4), powers(1, 4)), (powers(0, 2), ()),
    (powers(0, 4), ()), (powers(0, 3), ())))
COSINE_TERMS = ((powers(1, 4),) * 3, (powers(0, 2),) * 3)
LOSS_NAMES = ("loss_n.x", "loss_n.y", "loss_d.x", "loss_d.y", "loss_d.z")
COSINE_NAMES = ("cosine_n.x", "cosine_n.y")


def rational(s, iso, terms, base, factors, split):
    """(constant, columns) of numerator and denominator; split coefficients are the former's."""
    result = []
    for start, first, last in ((0.0, 0, split), (1.0, split, len(terms))):
        constant, columns = start + 0 * s.mu, []
        for i in range(first, last):
            constant = constant + factors[i] * polynomial(iso[i], base)
            columns += [factors[i] * c for c in s.columns(terms[i], base)]
        result.append((constant, np.stack(columns, 1)))
    return result


def loss_parts(s):
    t, scale = s.t, np.maximum(s.t, 1)**-3
    parts = rational(s, ISO_LOSS, LOSS_TERMS, s.alpha, (t, t * t, t, t * t, t**3), 2)
    return [(constant * scale, columns * scale[:, None]) for constant, columns in parts]


class CosineModel:
    """schlick / albedo = (1 - m)^5 with the isotropic m of the width Stretch.lobe, corrected."""

    def __init__(self, s):
        # The isotropic fit ends at a width of 1; what lies beyond adds to its first coefficient.
        q = np.minimum(np.sqrt(s.lobe), 1)
        self.mu, p = s.mu, np.sqrt(s.alpha)
        x, y, d = (polynomial(c, q) for c in ISO_COSINE)
        below = 1 + d * s.mu / (q * q)
        self.fixed = s.mu + (x + y * s.mu) / below
        columns = s.columns(COSINE_TERMS[0], p) + [np.maximum(np.sqrt(s.lobe) - 1, 0)]
        columns += [s.mu * c for c in s.columns(COSINE_TERMS[1], p)]
        self.columns = np.stack(columns, 1) / below[:, None]

    def cosine(self, c):
        return np.clip(self.fixed + self.columns @ c, 0, 1)


def quotient(parts, x):
    (n0, n), (d0, d) = parts
    return (n0 + n @ x[:n.shape[1]]) / (d0 + d @ x[n.shape[1]:])


def fit_rational(parts, target, error_of, slope, asymmetry, rounds=40):
    """Least largest error by reweighted linear least squares (Sanathanan and Koerner); positive
    errors count asymmetry times. error_of maps values of the quotient to errors."""
    (n0, n), (d0, d) = parts
    weight, below, best = slope**2, d0.copy(), (np.inf, None)
    for step in range(rounds):
        root = np.sqrt(weight) / below
        a = np.concatenate([n, -d * target[:, None]], 1) * root[:, None]
        norm = np.linalg.norm(a, axis=0)
        a /= norm
        x = np.linalg.solve(a.T @ a + 1e-9 * np.eye(a.shape[1]),
                            a.T @ ((target * d0 - n0) * root)) / norm
        raw = d0 + d @ x[n.shape[1]:]
        below = np.maximum(raw, 1e-3 * d0)
        error = error_of((n0 + n @ x[:n.shape[1]]) / below)
        size = np.where(error > 0, asymmetry, -1.0) * error
        if (raw >= below).all() and size.max() < best[0]:
            best = (size.max(), x, error.min(), error.max())
        if step > 2:
            weight = weight * (np.minimum(size / np.quantile(size, 0.9995), 1) + 0.05)
            weight = np.clip(weight / weight.mean(), 1e-3, 1e2)
    return best


def show_stretched(name, fit, names, terms, split):
    print(f"{name}: {fit[2]:+.5f} {fit[3]:+.5f}")
    start = 0
    for label, parts in zip(names, terms):
        for part, wanted in zip(("even", "odd", "quadratic"), parts):
            if wanted:
                values = fit[1][start:start + len(wanted)]
                print(f"  {label:10} {part:9} a^{min(wanted)}: " +
                      ", ".join(f"{np.float32(c):.9g}f" for c in values))
            start += len(wanted)


def stretch():
    grid = StretchedGrid()
    s = Stretch(grid.at, grid.ab, grid.x, grid.y, grid.mu)
    # A loss that is too large lets a metal gain energy, a Schlick that is too small a dielectric.
    loss = fit_rational(loss_parts(s), grid.loss, lambda q: q - grid.loss, np.ones_like(s.mu), 4.0)
    show_stretched("loss", loss, LOSS_NAMES, LOSS_TERMS, 2)
    model = CosineModel(s)
    schlick = grid.albedo * grid.ratio
    cosine = fit_cosine(model, grid, schlick + 0.003 * np.minimum(4 * s.k, 1))
    short = schlick - grid.albedo * (1 - model.cosine(cosine))**5
    n = sum(len(part) for part in COSINE_TERMS[0])
    show_stretched("schlick, short by", (0, np.delete(cosine, n), short.min(), short.max()),
                   COSINE_NAMES, COSINE_TERMS, 1)
    print(f"  {COSINE_NAMES[0]} beyond a width of 1: {np.float32(cosine[n]):.9g}f")
    stretched_means(loss[1].astype(np.float32), cosine.astype(np.float32))


def fit_cosine(model, grid, target, rounds=70):
    """Least squares (Levenberg and Marquardt) in which a Schlick that is too small counts 1000
    times, and large errors more."""
    pick = slice(0, None, 5)
    albedo, target, columns = grid.albedo[pick], target[pick], model.columns[pick]

    def short(c):
        m = np.clip(model.fixed[pick] + columns @ c, 0, 1)
        return target - albedo * (1 - m)**5, 5 * albedo * (1 - m)**4

    def merit(error, small, tail):
        return np.sum(np.where(error > 0, small, 1) * error**2 *
                      (1 + tail * (error / 0.035)**4 / 3))

    c, damping = np.zeros(columns.shape[1]), 1e-2
    for step in range(rounds):
        small, tail = (3, 0) if step < 8 else (1000, 1)
        error, slope = short(c)
        weight = np.where(error > 0, small, 1) * (1 + tail * (error / 0.035)**4)
        jacobian = columns * slope[:, None]
        normal = jacobian.T @ (jacobian * weight[:, None])
        gradient = jacobian.T @ (weight * error)
        for _ in range(8):
            move = np.linalg.solve(normal + damping * np.diag(np.diag(normal) + 1e-9), -gradient)
            if merit(short(c + move)[0], small, tail) < merit(error, small, tail):
                c, damping = c + move, max(damping / 5, 1e-8)
                break
            damping = min(damping * 6, 1e4)
    return c


def stretched_means(loss, cosine):
    """Cosine-weighted means over the hemisphere of what the fits above give, over the means of the
    isotropic lobe of the mean width, as 1 + k^2 (polynomial in its root and k^2)."""
    x, w = np.polynomial.legendre.leggauss(120)
    y, v = np.polynomial.legendre.leggauss(60)
    rows = []
    for p in np.linspace(PERCEPTUAL_ROUGHNESS_MIN, 1, 34):
        for k in np.linspace(0.05, 1, 20):
            at, ab = np.maximum(p * p * np.array((1 + k, 1 - k)), 1e-4)
            top = np.arcsinh(1 / ab)
            q = 0.5 * top * (x + 1)
            mu = np.clip(ab * np.sinh(q), 0, 1)
            # Azimuths gathered at the narrow side, like those of a round lobe.
            round_phi = 0.25 * np.pi * (y + 1)
            phi = np.arctan2(at**0.5 * np.sin(round_phi), ab**0.5 * np.cos(round_phi))
            jacobian = (at * ab)**0.5 / (ab * np.cos(round_phi)**2 + at * np.sin(round_phi)**2)
            weight = np.outer(w * 0.5 * top * ab * np.cosh(q) * 2 * mu, 0.5 * v * jacobian).ravel()
            mu, phi = (z.ravel() for z in np.meshgrid(mu, phi, indexing="ij"))
            side = np.sqrt(1 - mu * mu)
            s = Stretch(at + 0 * mu, ab + 0 * mu, side * np.cos(phi), side * np.sin(phi), mu)
            lost = np.clip(quotient(loss_parts(s), loss), 0, 1)
            m = CosineModel(s).cosine(cosine)
            rows.append((0.5 * (at + ab), (at - ab) / (at + ab), weight @ lost,
                         weight @ ((1 - m)**5 * (1 - lost)), weight.sum()))
    a, k, mean_loss, mean_schlick, one = np.array(rows).T
    print(f"  (weights add up to {one.min():.5f} to {one.max():.5f})")
    p = np.sqrt(a)
    # A mean loss that is too small or a mean Schlick that is too large lets energy be gained.
    worst = 0.04 + 0.75 * np.minimum(1, 2 * mean_loss)
    ratio = mean_loss * polynomial(ISO_MEAN_LOSS, p) / a**2
    for name, target, size, weight in (
            ("mean_loss over isotropic", ratio - 1, (7, 2), worst / ratio),
            ("mean_schlick less isotropic", mean_schlick - polynomial(ISO_MEAN_SCHLICK, p),
             (5, 2), -np.ones_like(a))):
        columns = np.stack([p**i * k**(2 + 2 * j) for j in range(size[1])
                            for i in range(size[0])], 1)
        fit = lawson(lambda c: (columns @ c - target) * weight, lambda c: columns * weight[:, None],
                     np.linalg.lstsq(columns, target, rcond=None)[0], 3.0, 40)
        print(f"{name}: {fit[2]:+.5f} {fit[3]:+.5f}")
        for j in range(size[1]):
            print(f"  k^{2 + 2 * j}: " + ", ".join(
                f"{np.float32(c):.9g}f" for c in fit[1][j * size[0]:(j + 1) * size[0]]))


# ---- thin film ---------------------------------------------------------------------------------

# Linear Rec.709 (D65) from CIE XYZ, IEC 61966-2-1.
REC709_FROM_XYZ = np.array([[3.2404542, -1.5371385, -0.4985314],
                            [-0.9692660, 1.8760108, 0.0415560],
                            [0.0556434, -0.2040259, 1.0572252]])
LONGEST_OPD_UM = 8.0


def sensitivities():
    """(wavenumbers in 1/um, response of linear Rec.709 to each, (1,1,1) to equal energy)."""
    text = (ROOT / "tests" / "accuracy" / "cie_observers.h").read_text(encoding="utf-8")
    table = text[text.index("cie_1931"):text.index("};")]
    rows = np.array([[float(x) for x in row.split(",")]
                     for row in re.findall(r"\{([-+.\d]+, [-+.\de]+, [-+.\de]+)\}", table)])
    nm = np.arange(360.0, 831.0)
    xyz = np.stack([np.interp(nm, 360.0 + 5.0 * np.arange(len(rows)), rows[:, k])
                    for k in range(3)])
    rgb = REC709_FROM_XYZ @ xyz
    return 1e3 / nm, rgb / rgb.sum(1, keepdims=True)


def gaussians(parameters, opd):
    """Cosine transforms of Gaussians: centre and standard deviation in wavenumber."""
    centre, sigma = np.split(parameters, 2)
    return np.exp(-2 * (np.pi * sigma[:, None] * opd)**2) * np.cos(2 * np.pi * centre[:, None] * opd)


def amplitudes(parameters, opd, target):
    """Least squares, with each channel's sum held at 1: no path difference is no colour."""
    basis = gaussians(parameters, opd)
    ends = basis[:-1] - basis[-1]
    part = np.linalg.lstsq(ends.T, (target - basis[-1]).T, rcond=None)[0].T
    return np.concatenate([part, 1 - part.sum(1, keepdims=True)], 1)


def film():
    wavenumber, response = sensitivities()
    opd = np.linspace(0, LONGEST_OPD_UM, 801)
    target = response @ np.cos(2 * np.pi * wavenumber[:, None] * opd[None, :])
    for count, starts in ((3, 12), (6, 40)):
        def residual(parameters):
            return (amplitudes(parameters, opd, target) @ gaussians(parameters, opd) -
                    target).ravel()
        best = None
        for seed in range(starts):
            start = np.concatenate([
                np.sort(np.random.default_rng(seed).uniform(1.5, 2.4, count)),
                np.full(count, 0.08)])
            fit = least_squares(residual, start, max_nfev=400)
            size = np.abs(amplitudes(fit.x, opd, target)).max()
            # Terms that cancel each other would lose digits.
            if size < 3 and (best is None or fit.cost < best.cost):
                best = fit
        centre, sigma = np.split(best.x, 2)
        order = np.argsort(centre)
        error = residual(best.x)
        print(f"film, {count} Gaussians: largest {np.abs(error).max():.4f}, "
              f"rms {np.sqrt(np.mean(error**2)):.5f}")
        print("  exp  ", ", ".join(f"{-2 * (np.pi * x)**2:.9g}f" for x in sigma[order]))
        print("  cos  ", ", ".join(f"{2 * np.pi * x:.9g}f" for x in centre[order]))
        for name, row in zip("rgb", amplitudes(best.x, opd, target)[:, order]):
            print(f"  {name}    ", ", ".join(f"{x:.9g}f" for x in row))


def main():
    jobs = {"fgd": fgd, "stretch": stretch, "film": film}
    for name in sys.argv[1:] or jobs:
        jobs[name]()


if __name__ == "__main__":
    main()
