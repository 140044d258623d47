"""The rays that pass a lens, as those whose points lie inside all of a few circles.

Each rim of a lens, and its stop, is a circle that a ray crosses at a smooth function of the film point x and the point
p behind the lens. By rotational symmetry this is a x + b p, where a and b are polynomials of x.x, p.p and x.p, here of
degree 1. In p, the circle of a film point is then an ellipse that is deformed by aberrations and moves with the field
(intersections of ellipses by field: Goossens et al. 2022). The coefficients are found by logistic regression: a ray
passes with the probability prod_k sigma((1 - |q_k|) / t), with the points q_k and a width t that decreases.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from .polynomial_fit import monomials

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]

DISCS = 3  # the stop, and the rims on both sides of it that vignette most
_MOST_START_RAYS = 6000
# Widths t: two sequences for the search for good starts, because each is better for some lenses, and that of the last
# steps with all rays. Narrower ones follow single rays: of a fisheye's 4800, 0.001 decides 4% of others wrongly.
_WIDTHS = ((0.05, 0.02, 0.006), (0.1, 0.05, 0.02, 0.01))
_LAST_WIDTHS = (0.02, 0.006)
_TRIED = 2
_RIDGE = 1e-2  # penalty of the squared coefficients beyond the linear ones, which rays inside a circle do not determine
_REACH = 25  # widths
_SEPARATIONS = (0.3, 0.6, 1.0, 1.6)  # between the circles at the edge of the field, in radii of the stop


def fitted_discs(x: Array, p: Array, ok: Booleans) -> Array:
    """Returns (DISCS, 4, 2): a and b for the monomials 1, x.p, p.p, x.x."""
    # The search is in y = (p - slope x) / radius, in which the stop is about the unit circle at every field: in p, it
    # ends in worse minima.
    slope, radius = stop_near_axis(x, p, ok)
    y = (p - slope * x) / radius
    few = np.random.default_rng(0).permutation(len(ok))[:_MOST_START_RAYS]

    def wrong(discs: Array) -> int:
        return int((inside(discs, x, y) != ok).sum())

    candidates = []
    for separation in _SEPARATIONS:
        # The stop, and two circles that move across it in opposite directions as the field grows.
        discs = np.array([[[0, 1]], [[-separation, 1]], [[separation, 1]]]) / np.array([1, 1.3, 1.3])[:, None, None]
        linear = _minimised(x[few], y[few], ok[few], discs, (0.1, 0.03))
        cubic = np.concatenate([linear, np.zeros((DISCS, 3, 2))], 1)
        candidates += [_minimised(x[few], y[few], ok[few], cubic, widths) for widths in _WIDTHS]
    candidates = sorted(candidates, key=wrong)[:_TRIED]
    candidates += [_minimised(x, y, ok, discs, _LAST_WIDTHS) for discs in candidates]
    return _in_p(min(candidates, key=wrong), slope, radius)


def stop_near_axis(x: Array, p: Array, ok: Booleans) -> tuple[float, float]:
    """Returns the slope of p by x at the centre of the stop near the axis, and the radius of the stop in p there."""
    radius = np.hypot(*x.T)
    near = ok & (radius < 0.3 * radius[ok].max())
    near = near if near.any() else ok
    slope = float((x[near] * p[near]).sum() / (x[near] ** 2).sum())
    return slope, float(np.quantile(np.hypot(*(p[near] - slope * x[near]).T), 0.98))


def _in_p(discs: Array, slope: float, radius: float) -> Array:
    """Converts circles whose points are a x + b y, with y = (p - slope x) / radius, to points a x + b p."""
    # Rows: the monomials 1, x.y, y.y and x.x; columns: 1, x.p, p.p and x.x.
    monomials_in_p = np.array(
        [
            [1, 0, 0, 0],
            [0, 1 / radius, 0, -slope / radius],
            [0, -2 * slope / radius**2, 1 / radius**2, (slope / radius) ** 2],
            [0, 0, 0, 1],
        ]
    )
    a, b = (discs[:, :, i] @ monomials_in_p for i in (0, 1))
    return np.stack([a - slope / radius * b, b / radius], 2)


def inside(discs: Array, x: Array, p: Array) -> Booleans:
    """True for rays whose points lie inside all circles."""
    radii = _Rays(x, p, np.zeros(len(x), bool), 4).radii(discs)[1]
    return np.asarray((radii <= 1).all(1))


class _Rays:
    """Rays, with the vectors whose linear combinations are the points of the circles."""

    def __init__(self, x: Array, p: Array, ok: Booleans, terms: int) -> None:
        scalars = monomials(x, p, 1)[:, :terms]
        vectors = np.stack([scalars[:, :, None] * x[:, None], scalars[:, :, None] * p[:, None]], 2)
        self.count, self.ok = len(x), ok
        self.basis = vectors.reshape(len(x), 2 * terms, 2).transpose(2, 0, 1).reshape(2 * len(x), 2 * terms)

    def radii(self, discs: Array) -> tuple[Array, Array]:
        """Returns the points (2 N, discs), first x, then y, and their radii (N, discs)."""
        points = self.basis @ discs.reshape(len(discs), -1).T
        return points, np.sqrt(points[: self.count] ** 2 + points[self.count :] ** 2 + 1e-12)

    def loss(self, numbers: Array, shape: tuple[int, ...], width: float) -> tuple[float, Array]:
        """Returns the mean negative log-likelihood, and its gradient by the coefficients."""
        discs = numbers.reshape(shape)
        points, radii = self.radii(discs)
        depth = np.clip((1 - radii) / width, -500, 500)
        passing = np.minimum(-np.logaddexp(0, -depth).sum(1), -1e-12)  # logarithm of the probability
        blocked = -np.expm1(passing)
        slope = np.where(self.ok, -1, np.exp(passing) / np.maximum(blocked, 1e-12)) / self.count
        by_radius = -slope[:, None] / (1 + np.exp(depth)) / width / radii
        gradient = (np.concatenate([by_radius, by_radius]) * points).T @ self.basis
        gradient[:, 2:] += 2 * _RIDGE * discs.reshape(len(discs), -1)[:, 2:]
        ridge = _RIDGE * (discs[:, 1:] ** 2).sum()
        gradient = gradient.ravel()
        return float(-np.where(self.ok, passing, np.log(blocked)).mean() + ridge), gradient


def _minimised(x: Array, p: Array, ok: Booleans, discs: Array, widths: tuple[float, ...]) -> Array:
    """Returns the circles after steps of decreasing width. Rays farther from the edge of the light than _REACH widths
    have no influence, and are left out."""
    for width in widths:
        outermost = _Rays(x, p, ok, discs.shape[1]).radii(discs)[1].max(1)
        near = np.abs(outermost - 1) < _REACH * width
        rays = _Rays(x[near], p[near], ok[near], discs.shape[1])
        found = minimize(
            rays.loss, discs.ravel(), (discs.shape, width), jac=True, method="L-BFGS-B", options={"maxiter": 200}
        )
        discs = found.x.reshape(discs.shape)
    return discs
