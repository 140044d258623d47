"""Regularised coefficients of a rational camera model.

Numerator and denominator may share nearly the same factor, so that very different coefficients describe nearly the same
model. Some of them are huge, which is meaningless and loses digits in programs that compute in float. Among all
coefficients that fit nearly as well as the best, this module chooses those closest to the polynomial without a
denominator (A. N. Tikhonov's regularisation, its weight chosen by V. A. Morozov's discrepancy principle).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .models import RadialModel

Array = NDArray[np.float64]

# Allowed increase of the RMS over the best fit: calibrations with patterns reach a few hundredths of a pixel.
ALLOWED_PX, ALLOWED_SHARE = 0.01, 1.05


def nearest_coefficients(
    model: RadialModel, residuals: Callable[[Array], Array], best: Array, start: Array, largest_s: float
) -> Array:
    """Returns parameters that fit nearly as well as `best` and are as close as possible to the polynomial model.

    residuals: maps parameters to (N, 2) pixels; the last parameters are the model's coefficients. best: parameters of
    the best fit. start: parameters with a denominator of 1. largest_s: largest s on the film; its powers scale the
    coefficients.
    """
    from scipy import optimize  # slow to load

    terms, denominator_terms = model.terms, len(model.denominator)
    sizes = largest_s ** np.array([*model.numerator, *model.denominator], dtype=float)

    def rms(parameters: Array) -> float:
        return float(np.sqrt(np.mean(np.sum(residuals(parameters) ** 2, axis=1))))

    def solved(f: Callable[[Array], Array], guess: Array) -> Array:
        solution: Array = optimize.least_squares(f, guess, method="lm", x_scale="jac", xtol=1e-12, ftol=1e-12).x
        return solution

    zeros = np.zeros(denominator_terms)
    numerator = solved(lambda p: residuals(np.append(p, zeros)).ravel(), start[:-denominator_terms])
    polynomial = np.append(numerator, zeros)
    allowed = max(rms(best) + ALLOWED_PX, ALLOWED_SHARE * rms(best))
    parameters = polynomial
    # The penalty falls gradually, so that the solution does not jump to one in which factors cancel.
    for weight in np.geomspace(1, 1e-6, 19):
        if rms(parameters) <= allowed:
            return parameters

        def penalised(trial: Array, weight: float = weight) -> Array:
            errors = residuals(trial)
            change = sizes * (trial - polynomial)[-terms:]
            return np.concatenate([errors.ravel(), weight * np.sqrt(len(errors)) * change])

        parameters = solved(penalised, parameters)
    return best


def condition_of(model: RadialModel, s: Array, r: Array) -> float:
    """Returns the condition number of the model's linear terms over the film, with columns normalised to unit length.

    Errors of the coefficients that compensate each other may be larger than the relative error of the projection by
    this factor. The best value is 1.
    """
    columns = model.linear_terms(s, r)
    return float(np.linalg.cond(columns / np.linalg.norm(columns, axis=0)))
