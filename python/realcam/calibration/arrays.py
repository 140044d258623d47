"""Array types and checks of the package."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InputError

# Arrays of doubles, as numpy's functions return them.
Array = NDArray[Any]
Integers = NDArray[np.intp]
Booleans = NDArray[np.bool_]


def rows_of(values: ArrayLike, columns: int, name: str) -> Array:
    """Returns an (N, columns) array of doubles. Raises InputError for another shape or type."""
    try:
        rows = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be an array of (N, {columns}) numbers") from None
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise InputError(f"{name} must be an array of (N, {columns}) numbers; its shape is {rows.shape}")
    return rows


def picture_size(size: object) -> tuple[int, int]:
    """Returns (width, height) in pixels. Raises InputError unless both are whole and from 1 to 1,000,000."""
    try:
        stated: Any = size
        width, height = stated
        whole = int(width), int(height)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"size must be (width, height) in pixels, not {size!r:.60}") from None
    if whole != (width, height) or not all(1 <= side <= 1_000_000 for side in whole):
        raise InputError(f"size must be two whole numbers of pixels from 1 to 1000000, not {size!r:.60}")
    return whole
