#!/usr/bin/env python3
"""Derives the constants of hdrp_oit_weight in hdrp_oit.h: fit_oit.py

Needs numpy (Debian: python3-numpy); the build and the tests do not run it. The training set is made
here, from a fixed seed: pixels of 2 to 12 layers between 1 and 200 m, in three ranges of opacity, in
all of them down to a thousandth, and thin ones among dense ones, as soft edges before glass are.
The sum of squared errors against sorting, each kind in units of its goal, is minimised over the
coefficients of log2 w, without rounding to targets. Prints them and the errors of the fit; errors
on other pixels, depths and counts are those of tests/oit.
"""
import numpy as np


def even(low, high):
    return lambda rng, shape: rng.uniform(low, high, shape)


def logarithmic(low, high):
    return lambda rng, shape: np.exp(rng.uniform(np.log(low), np.log(high), shape))


def thin_among_dense(rng, shape):
    is_thin = rng.uniform(0, 1, shape) < 0.7
    return np.where(is_thin, logarithmic(0.001, 0.1)(rng, shape), even(0.8, 0.99)(rng, shape))


# name -> opacities of layers, and the error to reach
KINDS = {"low": (even(0.05, 0.3), 0.030), "mixed": (even(0.05, 0.95), 0.095),
         "high": (even(0.8, 0.99), 0.125), "any": (logarithmic(0.001, 1.0), 0.080),
         "thin among dense": (thin_among_dense, 0.060)}
PIXELS = 6000
LOWEST, HIGHEST = -10.0, 4.0  # of log2 w: products with alpha and colour are half floats
STEPS = 600


def training_set(rng, opacities):
    """Layers of PIXELS pixels from front to back, and the colour that sorting gives."""
    count = rng.integers(2, 13, PIXELS)
    there = np.arange(12)[None] < count[:, None]
    z = np.exp(rng.uniform(0.0, np.log(200.0), (PIXELS, 12)))
    alpha = opacities(rng, (PIXELS, 12)) * there
    color, behind = rng.uniform(0, 1, (PIXELS, 12, 3)), rng.uniform(0, 1, (PIXELS, 3))
    order = np.argsort(z, 1, kind="stable")
    z, alpha = np.take_along_axis(z, order, 1), np.take_along_axis(alpha, order, 1)
    through = np.cumprod(1 - alpha, 1)
    before = np.concatenate([np.ones((PIXELS, 1)), through[:, :-1]], 1)
    revealage = through[:, -1:]
    exact = ((alpha * before)[..., None] * color).sum(1)
    return np.log2(z), alpha, color, revealage, exact


def terms(log2_z, a):
    """What the coefficients multiply, in the order of the code."""
    shapes = [np.ones_like(a), np.sqrt(a), a, a * a]
    return [*shapes, a**4, *(-shape * log2_z for shape in shapes), -a**8 * log2_z]


def error_and_gradient(p, pixels):
    log2_z, alpha, color, revealage, exact = pixels
    t = terms(log2_z, alpha)
    free = sum(c * x for c, x in zip(p, t))
    log2_w = np.clip(free, LOWEST, HIGHEST)
    share = alpha * np.exp2(log2_w)
    share /= share.sum(1, keepdims=True)
    mean = (share[..., None] * color).sum(1)
    error = mean * (1 - revealage) - exact
    slope = share * (error[:, None] * (color - mean[:, None])).sum(2) * (1 - revealage)
    slope *= (2 * np.log(2.0) / error.size) * (free == log2_w)
    return np.mean(error**2), np.array([(slope * x).sum() for x in t])


def main():
    rng = np.random.default_rng(1)
    sets = [(training_set(rng, opacities), goal) for opacities, goal in KINDS.values()]
    p = np.array([-7.0, 0.0, 0.0, 15.0, -7.0, 0.2, 0.0, 0.0, 3.0, -0.5])
    first, second = np.zeros_like(p), np.zeros_like(p)
    for step in range(1, STEPS + 1):  # Adam, with a step that shrinks
        gradient = 0.0
        for pixels, goal in sets:
            gradient = gradient + error_and_gradient(p, pixels)[1] / goal**2
        first = 0.9 * first + 0.1 * gradient
        second = 0.99 * second + 0.01 * gradient**2
        rate = 0.06 * (1.0 - step / (STEPS + 1.0))
        p = p - rate * (first / (1 - 0.9**step)) / (np.sqrt(second / (1 - 0.99**step)) + 1e-12)
    print("log2 w:", "  ".join(f"{c:.4f}f" for c in p))
    p = np.round(p, 4)
    for (pixels, goal), name in zip(sets, KINDS):
        error = np.sqrt(error_and_gradient(p, pixels)[0])
        print(f"{name}: RMSE {error:.4f}, goal {goal:g}")


if __name__ == "__main__":
    main()
