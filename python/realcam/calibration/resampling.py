"""Values of a picture between its pixel centres."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._core import InputError
from .arrays import Array, Booleans

ORDERS = {"bilinear": 1, "bicubic": 3}


def checked_image(image: ArrayLike, size: tuple[int, int] | None = None) -> Array:
    """Returns an (H, W) or (H, W, C) array of doubles. Raises InputError for another shape. size: None: any."""
    try:
        values = np.asarray(image, dtype=float)
    except (TypeError, ValueError):
        raise InputError("image must be an array of (H, W) or (H, W, C) numbers") from None
    if size is None:
        if values.ndim not in (2, 3) or not values.size:
            raise InputError(f"image must be an array of (H, W) or (H, W, C) numbers; its shape is {values.shape}")
    elif values.ndim not in (2, 3) or values.shape[:2] != (size[1], size[0]):
        raise InputError(
            f"image must be an array of ({size[1]}, {size[0]}) or ({size[1]}, {size[0]}, C) numbers, as the "
            f"calibration; its shape is {values.shape}"
        )
    return values


def pixel_centres(size: tuple[int, int]) -> Array:
    """Returns the (H W, 2) centres of all pixels, row by row; the first is (0.5, 0.5)."""
    columns, rows = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    return np.column_stack([columns.ravel(), rows.ravel()])


def remapped(image: Array, positions: Array, interpolation: str) -> Array:
    """Returns the picture whose pixels read an image at (H, W, 2) positions; NaN beside the image."""
    height, width = image.shape[:2]
    pixels = positions.reshape(-1, 2).copy()
    with np.errstate(invalid="ignore"):
        pixels[~((pixels >= 0) & (pixels <= [width, height])).all(axis=1)] = np.nan
    return sampled(image, pixels, interpolation).reshape(*positions.shape[:2], *image.shape[2:])


def sampled(image: Array, pixels: Array, interpolation: str) -> Array:
    """Returns the values of an image at (N, 2) pixels, (N,) or (N, C); NaN at pixels that are NaN.

    Within half a pixel of the edge the image continues with the values of its outermost pixels. bicubic: cubic splines
    through the pixels. Raises InputError for an unknown interpolation.
    """
    from scipy import ndimage  # slow to load

    if interpolation not in ORDERS:
        raise InputError(f'unknown interpolation "{interpolation!s:.40}"; expected one of {", ".join(ORDERS)}')
    is_hidden: Booleans = np.logical_or.reduce(np.isnan(pixels), axis=1)
    positions = np.where(is_hidden[:, None], 0.0, pixels - 0.5).T[::-1]
    channels = image[:, :, None] if image.ndim == 2 else image
    values = np.stack(
        [
            ndimage.map_coordinates(channels[:, :, i], positions, order=ORDERS[interpolation], mode="nearest")
            for i in range(channels.shape[2])
        ],
        axis=1,
    )
    values[is_hidden] = np.nan
    return values[:, 0] if image.ndim == 2 else values
