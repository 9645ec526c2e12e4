#!/usr/bin/env python3
"""Derives the fitted constants of hdrp_brdf_lobes.h: fit_brdf.py [fgd] [film]

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
    jobs = {"fgd": fgd, "film": film}
    for name in sys.argv[1:] or jobs:
        jobs[name]()


if __name__ == "__main__":
    main()
