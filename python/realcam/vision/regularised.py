"""Coefficients of a rational camera model that are no larger than the rays of a camera call for.

A numerator and a denominator may have nearly the same factor, so that very different coefficients make nearly the same
model. Among them are huge ones, which mean nothing and lose digits where a program computes in float. Here those are
taken that are nearest to the polynomial without a denominator, among all that fit nearly as well as the best (A. N.
Tikhonov's regularisation, its weight chosen by V. A. Morozov's discrepancy principle).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .models import RadialModel

Array = NDArray[np.float64]

# By how much the fit may be worse than the best, RMS: calibrations with patterns come to some hundredths of a pixel.
ALLOWED_PX, ALLOWED_SHARE = 0.01, 1.05


def nearest_coefficients(
    model: RadialModel, residuals: Callable[[Array], Array], best: Array, start: Array, largest_s: float
) -> Array:
    """Parameters that fit nearly as well as `best`, and whose denominator is as near to 1 as that allows.

    residuals: of parameters, (N, 2) pixels; the last parameters are the coefficients of the model. start: some without
    a denominator. largest_s: of the film, in whose powers coefficients are measured.
    """
    from scipy import optimize  # slow to load

    terms, below = model.terms, len(model.denominator)
    sizes = largest_s ** np.array([*model.numerator, *model.denominator], dtype=float)

    def rms(parameters: Array) -> float:
        return float(np.sqrt(np.mean(np.sum(residuals(parameters) ** 2, axis=1))))

    def solved(f: Callable[[Array], Array], guess: Array) -> Array:
        found: Array = optimize.least_squares(f, guess, method="lm", x_scale="jac", xtol=1e-12, ftol=1e-12).x
        return found

    none = np.zeros(below)
    polynomial = np.append(solved(lambda p: residuals(np.append(p, none)).ravel(), start[:-below]), none)
    allowed = max(rms(best) + ALLOWED_PX, ALLOWED_SHARE * rms(best))
    found = polynomial
    # From strong to weak, each from the last: such a path does not jump to where factors cancel.
    for weight in np.geomspace(1, 1e-6, 19):
        if rms(found) <= allowed:
            return found

        def penalised(parameters: Array, weight: float = weight) -> Array:
            shown = residuals(parameters)
            change = sizes * (parameters - polynomial)[-terms:]
            return np.concatenate([shown.ravel(), weight * np.sqrt(len(shown)) * change])

        found = solved(penalised, found)
    return best


def condition_of(model: RadialModel, s: Array, r: Array) -> float:
    """Of the model's terms over the film, each made a column of unit length: largest over smallest singular value.

    So many times larger than a relative error of what is shown may errors of coefficients be, that make up for one
    another. 1 is the best.
    """
    columns = model.linear_terms(s, r)
    return float(np.linalg.cond(columns / np.linalg.norm(columns, axis=0)))
