"""Inverse of a smooth plane map by Newton's method."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import Array

Map = Callable[[Array], Array]
ROUNDING = 1e-14  # relative residual below which a step that does not reduce it is due to rounding
STEPS = 32  # of the continuation from the centre, for points at which Newton's method alone does not converge


def plane_inverse(function: Map, jacobian: Map, values: Array, start: Array) -> Array:
    """Returns points with function(points) = values, (N, 2); NaN if none is found.

    start: a guess for each value; where it is not finite, the solution is followed from the centre of the plane, which
    the function maps to itself.
    """
    with np.errstate(all="ignore"):
        found = _newton(function, jacobian, values, start)
        (missing,) = np.nonzero(np.isnan(found[:, 0]) & np.isfinite(values).all(axis=1))
        if len(missing):
            followed = np.zeros((len(missing), 2))
            for step in range(1, STEPS + 1):
                followed = _newton(function, jacobian, values[missing] * (step / STEPS), followed)
            found[missing] = followed
        return found


def _newton(function: Map, jacobian: Map, values: Array, start: Array) -> Array:
    """Damped Newton iteration: steps that do not reduce the residual are shortened.

    It ends at a point when the residual is small and no longer falls, as rounding allows no smaller one.
    """
    points: Array = start.copy()
    residual = values - function(points)
    size = np.hypot(*residual.T)
    damping = np.ones(len(points))
    for _ in range(80):
        active = np.flatnonzero((size > 2e-16 * (1 + np.hypot(*values.T))) & (damping > 1e-6))
        if not len(active):
            break
        candidate = points[active] + damping[active, None] * _solved(jacobian(points[active]), residual[active])
        error = values[active] - function(candidate)
        length = np.hypot(*error.T)
        better = length < size[active]
        damping[active] = np.where(better, np.minimum(1, 2 * damping[active]), damping[active] / 4)
        damping[active[~better & (size[active] < ROUNDING * (1 + np.hypot(*values[active].T)))]] = 0
        taken = active[better]
        points[taken], residual[taken], size[taken] = candidate[better], error[better], length[better]
    points[~(size <= 1e-12 * (1 + np.hypot(*values.T)))] = np.nan
    return points


def _solved(matrices: Array, right: Array) -> Array:
    a, b, c, d = matrices[:, 0, 0], matrices[:, 0, 1], matrices[:, 1, 0], matrices[:, 1, 1]
    determinant = a * d - b * c
    adjugate = np.stack([d * right[:, 0] - b * right[:, 1], a * right[:, 1] - c * right[:, 0]], axis=1)
    solved: Array = adjugate / determinant[:, None]
    return solved
