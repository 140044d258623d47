"""Least squares between pictures: rc.fit_pictures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._core import InputError
from ..settings import whole_number
from .dual_array import Doubles

LONGEST = 2.0  # step, in units of the values' scale
SHORTEST = 0.1  # step, in standard deviations of the fit
CONVERGED = 1.0  # longest remaining step of a fit that has converged, in standard deviations of the fit
LEAST_INFORMATION = 1e-12  # along an axis, of the values in units of their scale


@dataclass(frozen=True)
class PictureFit:
    """Result of a fit to pictures.

    values: (P,). covariance: (P, P), of the values, from the noise of the pictures and the prior: the inverse of the
    information matrix. Without a prior it is the Cramer-Rao bound. It does not contain the noise of renderings.
    Standard deviations along axes of which neither pictures nor prior say anything are 1e6 of the scale.
    chi_square: mean square of the residuals of the finest level, in units of their noise. evaluations: number of
    rendered sets of pictures.
    remaining_step: length of the undamped Gauss-Newton step from `values`, at the finest level, in standard deviations:
    the square root of step^T information step (the Newton decrement of Boyd and Vandenberghe, Convex Optimization,
    2004, 9.5.1). Axes without information do not count, nor do values that a bound holds. message: why the search
    ended. The search itself ends at remaining steps of 0.1, which noise of derivatives or renderings can prevent.
    """

    values: Doubles
    covariance: Doubles
    chi_square: float
    evaluations: int
    remaining_step: float
    message: str

    @property
    def converged(self) -> bool:
        """True if the remaining step is shorter than one standard deviation.

        The values then differ from those of the nearest minimum by less than their uncertainty, as far as the pictures
        are linear in them. Noise of derivatives lengthens the remaining step. Another minimum is not detected: see
        chi_square.
        """
        return self.remaining_step < CONVERGED

    @property
    def errors(self) -> Doubles:
        """(P,): standard deviations of the values."""
        return np.sqrt(np.diag(self.covariance))

    def directions(self, scale: ArrayLike) -> tuple[Doubles, Doubles]:
        """Principal axes of the uncertainty, of the values in units of `scale`, (P,), the worst determined first.

        Returns standard deviations along the axes, (P,), and the axes as rows, (P, P). With the prior's standard
        deviations as `scale`, pictures say nothing about axes with a standard deviation of 1.
        """
        units = np.asarray(scale, float)
        squares, axes = np.linalg.eigh(self.covariance / np.outer(units, units))
        return np.sqrt(squares[::-1]), axes.T[::-1]


def fit_pictures(
    pictures_of: Callable[[Doubles, int], ArrayLike],
    derivatives_of: Callable[[Doubles, int, int], ArrayLike],
    observed: ArrayLike,
    variance: ArrayLike,
    start: ArrayLike,
    scale: ArrayLike,
    *,
    prior: tuple[ArrayLike, ArrayLike] | None = None,
    bounds: tuple[ArrayLike, ArrayLike] = (-np.inf, np.inf),
    blocks: Sequence[int] = (8, 4, 2, 1),
    steps: int = 8,
    seed: int = 0,
) -> PictureFit:
    """Fits P values to pictures by damped Gauss-Newton steps (Levenberg-Marquardt), coarse to fine.

    pictures_of(values, block): returns the pictures, (K, H, W, C), with fixed random numbers. derivatives_of(values,
    block, seed): returns an unbiased estimate of their derivatives, (P, K, H, W, C), with the random numbers of seed.
    Both may take fewer samples for larger blocks.
    observed, variance: pictures and the variance of their pixels' noise, (K, H, W, C). start: (P,). scale: (P,),
    changes of the values that matter equally. prior: mean and standard deviation of the values, (P,), inf where there
    is none. bounds: of the values. blocks: sizes of the blocks of pixels whose means are compared, from coarse to fine,
    which must divide H and W; coarse pictures tolerate a start that is further away. steps: most steps with each. A fit
    whose steps do not suffice is returned, too: PictureFit.converged is False then.

    The information matrix is the product of two independent estimates of the derivatives, because the noise of one,
    squared, would be taken for information (which is why scipy's least_squares is not used).
    Raises InputError, also for pictures or derivatives of other shapes, and with values that are not finite.
    """
    wanted, spread = np.asarray(observed, float), np.asarray(variance, float)
    units, values = np.asarray(scale, float), np.asarray(start, float)
    if wanted.ndim != 4 or spread.shape != wanted.shape or not (spread > 0).all():
        raise InputError("observed and variance must be arrays (K, H, W, C) of one shape, and variances positive")
    _finite("observed", wanted, wanted.shape)
    if units.shape != values.shape or values.ndim != 1 or not (units > 0).all():
        raise InputError("start and scale must be (P,), and scales positive")
    _finite("start and scale", np.array([values, units]), (2, max(len(values), 1)))
    height, width = wanted.shape[1:3]
    sizes = np.asarray(blocks)
    if sizes.ndim != 1 or sizes.dtype.kind not in "iu" or any(b < 1 or height % b or width % b for b in sizes):
        raise InputError(f"blocks must divide pictures of {width} x {height} pixels; found {blocks!r:.60}")
    steps, seed = whole_number("steps", steps, 1), whole_number("seed", seed, 0)
    means, deviations = (values, np.full(len(values), np.inf)) if prior is None else _pair("prior", prior, values)
    if not (deviations > 0).all() or not np.isfinite(means).all():
        raise InputError("prior must have finite means, and positive standard deviations")
    low, high = _pair("bounds", bounds, values)
    if not ((low <= values) & (values <= high)).all():
        raise InputError("start must lie within bounds")
    of_prior = units / deviations
    evaluations = 0
    for level, block in enumerate(blocks, start=1):
        noise = np.sqrt(_block_means(spread, block)) / block

        def residuals(at: Doubles, block: int = block, noise: Doubles = noise) -> Doubles:
            """Residuals of the pixels, followed by those of the prior."""
            nonlocal evaluations
            evaluations += 1
            pictures = _finite("pictures_of(values, block)", pictures_of(at, block), wanted.shape)
            pixels = _block_means(pictures - wanted, block) / noise
            return np.concatenate([pixels.ravel(), (at - means) / deviations])

        def jacobian(at: Doubles, block: int = block, noise: Doubles = noise) -> Doubles:
            """(pixels, P), by the values in units of their scale."""
            nonlocal seed
            seed += 1
            slopes = _finite(
                "derivatives_of(values, block, seed)", derivatives_of(at, block, seed), (len(at), *wanted.shape)
            )
            found = [_block_means(slope, block) / noise for slope in slopes]
            return np.asarray(np.reshape(found, (len(at), -1)).T * units)

        damping, now = 1.0, residuals(values)
        # After the last step of the finest level, derivatives are computed once more, for the uncertainty of the fit.
        for step in range(steps + (level == len(blocks))):
            first, second = jacobian(values), jacobian(values)
            # Noise can make small eigenvalues negative.
            strengths, axes = np.linalg.eigh((first.T @ second + second.T @ first) / 2)
            information = axes @ np.diag(np.maximum(strengths, 0)) @ axes.T + np.diag(of_prior**2)
            by_pixels, by_prior = now[: -len(values)], now[-len(values) :]
            gradient = (first + second).T @ by_pixels / 2 + of_prior * by_prior
            free = ~((values <= low) & (gradient > 0) | (values >= high) & (gradient < 0))
            strengths, axes = np.linalg.eigh(information[np.ix_(free, free)])
            slope = axes.T @ gradient[free]
            remaining = _newton_decrement(strengths, slope)
            if remaining < SHORTEST:
                message = f"The next step is shorter than {SHORTEST:g} standard deviations."
                break
            if step == steps:
                message = f"All steps are used up: {steps} with blocks of {block} x {block} pixels."
                break
            is_better = is_rejected = False
            for _ in range(20):
                change = slope / (strengths + damping)
                if is_rejected and (strengths * change**2).sum() < SHORTEST**2:
                    break
                if np.linalg.norm(change) < LONGEST:
                    there = values.copy()
                    there[free] -= units[free] * (axes @ change)
                    then = residuals(np.clip(there, low, high, out=there))
                    if is_better := bool(then @ then < now @ now):
                        values, now, damping = there, then, damping / 10
                        break
                    is_rejected = True
                damping *= 10
            if not is_better:
                message = f"No step lowers the sum of squares with blocks of {block} x {block} pixels."
                break
    strengths, axes = np.linalg.eigh(information)
    covariance = (axes / np.maximum(strengths, LEAST_INFORMATION)) @ axes.T * np.outer(units, units)
    chi_square = float((now[: -len(values)] ** 2).mean())
    return PictureFit(values, covariance, chi_square, evaluations, remaining, message)


def _newton_decrement(strengths: Doubles, slope: Doubles) -> float:
    """Length of a Gauss-Newton step, in standard deviations: from the information along its principal axes, and half
    the derivatives of the sum of squares along them."""
    # Rounding leaves some 1e-15 of the largest eigenvalue along axes without information.
    known = strengths > LEAST_INFORMATION * max(1.0, strengths.max(initial=0.0))
    return float(np.sqrt((slope[known] ** 2 / strengths[known]).sum()))


def _finite(name: str, values: ArrayLike, shape: tuple[int, ...]) -> Doubles:
    """Returns values as an array. Raises InputError unless they have the shape and are finite."""
    array = np.asarray(values, float)
    if array.shape != shape:
        raise InputError(f"{name} must have shape {shape}; found {array.shape}")
    if not np.isfinite(array).all():
        raise InputError(f"{name} must be finite; found {array[~np.isfinite(array)][0]}")
    return array


def _pair(name: str, pair: tuple[ArrayLike, ArrayLike], values: Doubles) -> tuple[Doubles, Doubles]:
    """Returns two arrays of numbers for each value, (P,). Raises InputError."""
    arrays = [np.asarray(part, float) for part in pair] if np.iterable(pair) else []
    if len(arrays) != 2 or any(array.shape not in ((), values.shape) for array in arrays):
        raise InputError(f"{name} must be two numbers or arrays ({len(values)},)")
    first, second = (np.broadcast_to(array, values.shape) for array in arrays)
    return first, second


def _block_means(pictures: Doubles, block: int) -> Doubles:
    """Means over blocks of pixels: (K, H, W, C) to (K, H / block, W / block, C)."""
    count, height, width, channels = pictures.shape
    blocks = pictures.reshape(count, height // block, block, width // block, block, channels)
    return np.asarray(blocks.mean((2, 4)))
