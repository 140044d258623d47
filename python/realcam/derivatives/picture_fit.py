"""Least squares between pictures: rc.fit_pictures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InputError

Doubles = NDArray[np.float64]

LONGEST = 2.0  # step, in units of the values' scale
SHORTEST = 0.1  # step, in standard deviations


@dataclass(frozen=True)
class PictureFit:
    """Result of a fit to pictures.

    values: (P,). covariance: (P, P), of the values, from the noise of the pictures and the prior: the inverse of the
    information matrix. Without a prior it is the Cramer-Rao bound. It does not contain the noise of renderings.
    chi_square: mean square of the residuals of the finest level, in units of their noise. evaluations: number of
    rendered sets of pictures.
    """

    values: Doubles
    covariance: Doubles
    chi_square: float
    evaluations: int

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
    which must divide H and W; coarse pictures tolerate a start that is further away. steps: most steps with each.

    The information matrix is the product of two independent estimates of the derivatives, because the noise of one,
    squared, would be taken for information (which is why scipy's least_squares is not used).
    Raises InputError.
    """
    wanted, spread = np.asarray(observed, float), np.asarray(variance, float)
    units, values = np.asarray(scale, float), np.asarray(start, float)
    if wanted.ndim != 4 or spread.shape != wanted.shape or not (spread > 0).all():
        raise InputError("observed and variance must be arrays (K, H, W, C) of one shape, and variances positive")
    if units.shape != values.shape or values.ndim != 1 or not (units > 0).all():
        raise InputError("start and scale must be (P,), and scales positive")
    if not blocks or any(wanted.shape[1] % block or wanted.shape[2] % block for block in blocks):
        raise InputError(f"blocks must divide pictures of {wanted.shape[2]} x {wanted.shape[1]} pixels; found {blocks}")
    means, deviations = (values, np.inf) if prior is None else (np.asarray(part, float) for part in prior)
    of_prior = np.broadcast_to(units / deviations, values.shape)
    evaluations = 0
    for block in blocks:
        noise = np.sqrt(_block_means(spread, block)) / block

        def residuals(at: Doubles, block: int = block, noise: Doubles = noise) -> Doubles:
            """Residuals of the pixels, followed by those of the prior."""
            nonlocal evaluations
            evaluations += 1
            pixels = _block_means(np.asarray(pictures_of(at, block), float) - wanted, block) / noise
            return np.concatenate([pixels.ravel(), (at - means) / deviations])

        def jacobian(at: Doubles, block: int = block, noise: Doubles = noise) -> Doubles:
            """(pixels, P), by the values in units of their scale."""
            nonlocal seed
            seed += 1
            found = [
                _block_means(np.asarray(d, float), block) / noise for d in np.asarray(derivatives_of(at, block, seed))
            ]
            return np.asarray(np.reshape(found, (len(at), -1)).T * units)

        damping, now = 1.0, residuals(values)
        for _ in range(steps):
            first, second = jacobian(values), jacobian(values)
            # Noise can make small eigenvalues negative.
            strengths, axes = np.linalg.eigh((first.T @ second + second.T @ first) / 2)
            information = axes @ np.diag(np.maximum(strengths, 0)) @ axes.T + np.diag(of_prior**2)
            strengths, axes = np.linalg.eigh(information)
            by_pixels, by_prior = now[: -len(values)], now[-len(values) :]
            slope = axes.T @ ((first + second).T @ by_pixels / 2 + of_prior * by_prior)
            is_better, change = False, np.zeros_like(slope)
            for _ in range(20):
                change = slope / (strengths + damping)
                if (strengths * change**2).sum() < SHORTEST**2:
                    break
                if np.linalg.norm(change) < LONGEST:
                    there = np.clip(values - units * (axes @ change), *bounds)
                    then = residuals(there)
                    if is_better := bool(then @ then < now @ now):
                        values, now, damping = there, then, damping / 10
                        break
                damping *= 10
            if not is_better:
                break
    covariance = np.linalg.pinv(information) * np.outer(units, units)
    return PictureFit(values, covariance, float((now[: -len(values)] ** 2).mean()), evaluations)


def _block_means(pictures: Doubles, block: int) -> Doubles:
    """Means over blocks of pixels: (K, H, W, C) to (K, H / block, W / block, C)."""
    count, height, width, channels = pictures.shape
    blocks = pictures.reshape(count, height // block, block, width // block, block, channels)
    return np.asarray(blocks.mean((2, 4)))
