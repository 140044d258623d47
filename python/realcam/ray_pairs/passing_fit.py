"""The rays that pass a lens, as those whose points lie inside all of a few circles.

Each rim of a lens, and its stop, is a circle that a ray crosses at a smooth function of the film point x and the point p
behind the lens. By rotational symmetry this is a x + b p, where a and b are polynomials of x.x, p.p and x.p of degree 1
here. In p, the circle of a film point is then an ellipse that is deformed by aberrations and moves with the field
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
_MOST_START_RAYS = 4000
_TRIED = 3  # of the best starts
_REACH = 25  # widths
_SEPARATIONS = (0.3, 0.6, 1.0, 1.6)  # of the circles in p at the edge of the field, in radii of the stop


def fitted_discs(x: Array, p: Array, ok: Booleans) -> Array:
    """Returns (DISCS, 4, 2): a and b for the monomials 1, x.p, p.p, x.x; first the circle that is smallest at x = 0."""
    start = np.random.default_rng(0).permutation(len(ok))[:_MOST_START_RAYS]
    if not ok[start].any():
        start = np.arange(len(ok))
    linear = [_minimised(x[start], p[start], ok[start], discs, (0.1, 0.03)) for discs in _starts(x, p, ok)]
    best = sorted(linear, key=lambda found: found[0])[:_TRIED]
    cubic = [np.concatenate([circles, np.zeros((DISCS, 3, 2))], 1) for _, circles in best]
    # A narrower width would follow single rays: of a fisheye's 4800, 0.001 decides 4% of others wrongly.
    found = [_minimised(x, p, ok, circles, (0.05, 0.02, 0.006)) for circles in cubic]
    discs = min(found, key=lambda result: result[0])[1]
    return discs[np.argsort(-np.abs(discs[:, 0, 1]), kind="stable")]


def inside(discs: Array, x: Array, p: Array) -> Booleans:
    """True for rays whose points lie inside all circles."""
    return (_Rays(x, p, np.zeros(len(x), bool), 4).radii(discs)[1] <= 1).all(1)


class _Rays:
    """Rays, with the vectors of which the points of the circles are combinations."""

    def __init__(self, x: Array, p: Array, ok: Booleans, terms: int) -> None:
        scalars = monomials(x, p, 1)[:, :terms]
        vectors = np.stack([scalars[:, :, None] * x[:, None], scalars[:, :, None] * p[:, None]], 2)
        self.count, self.ok = len(x), ok
        self.basis = vectors.reshape(len(x), 2 * terms, 2).transpose(2, 0, 1).reshape(2 * len(x), 2 * terms)

    def radii(self, discs: Array) -> tuple[Array, Array]:
        """Returns the points (2 N, discs), first x, then y, and their radii (N, discs)."""
        points = self.basis @ discs.reshape(len(discs), -1).T
        return points, np.sqrt(points[: self.count] ** 2 + points[self.count :] ** 2 + 1e-12)

    def loss(self, discs: Array, width: float) -> tuple[float, Array]:
        """Returns the mean negative log-likelihood, and its gradient by the coefficients."""
        points, radii = self.radii(discs)
        depth = np.clip((1 - radii) / width, -500, 500)
        passing = np.minimum(-np.logaddexp(0, -depth).sum(1), -1e-12)  # logarithm of the probability
        blocked = -np.expm1(passing)
        slope = np.where(self.ok, -1, np.exp(passing) / np.maximum(blocked, 1e-12)) / self.count
        by_radius = -slope[:, None] / (1 + np.exp(depth)) / width / radii
        gradient = (np.concatenate([by_radius, by_radius]) * points).T @ self.basis
        return float(-np.where(self.ok, passing, np.log(blocked)).mean()), gradient


def _minimised(x: Array, p: Array, ok: Booleans, discs: Array, widths: tuple[float, ...]) -> tuple[float, Array]:
    """Returns the loss and the circles after steps of decreasing width. Rays farther from the edge of the light than
    _REACH widths have no influence, and are left out."""
    loss, terms = np.inf, discs.shape[1]
    for width in widths:
        outermost = _Rays(x, p, ok, terms).radii(discs)[1].max(1)
        near = np.abs(outermost - 1) < _REACH * width
        rays = _Rays(x[near], p[near], ok[near], terms)

        def of(numbers: Array, width: float = width, rays: _Rays = rays) -> tuple[float, Array]:
            loss, gradient = rays.loss(numbers.reshape(discs.shape), width)
            return loss, gradient.ravel()

        found = minimize(of, discs.ravel(), jac=True, method="L-BFGS-B", options={"maxiter": 200})
        loss, discs = float(found.fun) * rays.count / len(x), found.x.reshape(discs.shape)
    return loss, discs


def _starts(x: Array, p: Array, ok: Booleans) -> list[Array]:
    """Returns sets of circles (DISCS, 1, 2) to start from: the stop, and two that move across it in opposite directions
    as the field grows."""
    radius = np.hypot(*x.T)
    near = ok & (radius < 0.3 * radius[ok].max())
    slope = (x[near] * p[near]).sum() / (x[near] ** 2).sum() if near.any() else 0.0
    used = near if near.any() else ok
    stop = np.quantile(np.hypot(*(p[used] - slope * x[used]).T), 0.98)
    return [
        np.array([[[-slope, 1.0]], [[-slope - s * stop, 1.0]], [[-slope + s * stop, 1.0]]])
        / (stop * np.array([1.0, 1.3, 1.3])[:, None, None])
        for s in _SEPARATIONS
    ]
