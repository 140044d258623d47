"""Depth of field as a post-process: blurs a sharp picture by the circles of confusion of its depths.

Rendering through a lens is compared with these two methods (docs/accuracy.md). Both take linear light, (H, W, 3), and
the diameters of the circles of confusion in pixels, (H, W). Neither can recover what is occluded in the sharp picture.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

Picture = NDArray[np.float32]


def gathered(picture: Picture, diameters: Picture, depth: Picture) -> Picture:
    """Blurs a picture with a separable gather filter: one pass along the columns and one along the rows.

    After T. Zhou, J. X. Chen and M. Pullen, "Accurate depth of field simulation in real time", Computer Graphics Forum
    26 (2007). A pixel gathers from pixels whose circles of confusion cover it; for pixels behind it, the radius is
    limited to its own circle, so that a blurred background does not bleed over sharp objects. Weights are Gaussian,
    with the variance of a uniform disc. depth: (H, W), in metres.
    """
    for axis in (0, 1):
        picture = _gathered_along(axis, picture, diameters, depth)
    return picture


def _gathered_along(axis: int, picture: Picture, diameters: Picture, depth: Picture) -> Picture:
    # A uniform disc of diameter d has the variance d^2 / 16 along each axis. With a sigma of a third of a pixel the
    # picture stays sharp.
    sigma = np.maximum(diameters / 4, 0.33).astype(np.float32)
    total = np.zeros_like(picture)
    weights = np.zeros_like(depth)
    reach = min(int(np.ceil(3 * sigma.max())), picture.shape[axis] - 1)
    for offset in range(-reach, reach + 1):
        pixels, neighbours = _overlap(picture.shape[axis], offset, axis)
        is_behind = depth[neighbours] > depth[pixels]
        spread = np.where(is_behind, np.minimum(sigma[neighbours], sigma[pixels]), sigma[neighbours])
        weight = np.exp(-0.5 * (offset / spread) ** 2) / spread
        total[pixels] += weight[..., None] * picture[neighbours]
        weights[pixels] += weight
    blurred: Picture = total / weights[..., None]
    return blurred


def _overlap(length: int, offset: int, axis: int) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Returns the index of all pixels with a neighbour at `offset` along the axis, and that of these neighbours."""
    pixels = slice(max(0, -offset), length - max(0, offset))
    neighbours = slice(max(0, offset), length - max(0, -offset))
    whole = slice(None)
    return ((pixels, whole), (neighbours, whole)) if axis == 0 else ((whole, pixels), (whole, neighbours))


def diffused(picture: Picture, diameters: Picture) -> Picture:
    """Blurs a picture by heat diffusion: light spreads with a conductivity given by the circles of confusion.

    After M. Kass, A. Lefohn and J. Owens, "Interactive depth of field using simulated diffusion on a GPU", Pixar
    (2006): one implicit step along the rows and one along the columns, each a tridiagonal system. The smaller circle of
    two adjacent pixels gives the conductivity between them.
    """
    variance = (diameters / 4).astype(np.float64) ** 2
    spread = _step_along_rows(picture.astype(np.float64), variance)
    spread = _step_along_rows(spread.swapaxes(0, 1), variance.T).swapaxes(0, 1)
    blurred: Picture = spread.astype(np.float32)
    return blurred


def _step_along_rows(picture: NDArray[np.float64], variance: NDArray[np.float64]) -> NDArray[np.float64]:
    """Solves u - (k u')' = picture along each row. The impulse response has the variance 2 k."""
    conductivity = 0.5 * np.minimum(variance[:, :-1], variance[:, 1:])
    left, right = np.pad(conductivity, ((0, 0), (1, 0))), np.pad(conductivity, ((0, 0), (0, 1)))
    # One system for all rows: the conductivity between the last pixel of a row and the first of the next is 0.
    bands = np.stack([-left.ravel(), (1 + left + right).ravel()])
    solved: NDArray[np.float64] = solveh_banded(bands, picture.reshape(-1, 3)).reshape(picture.shape)
    return solved
