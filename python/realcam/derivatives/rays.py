"""Derivatives of single rays by the numbers of a lens, and by where they start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import Lens
from ..short_text import ShortText
from ..variable import Variable, checked
from .dual_array import Doubles


@dataclass(frozen=True, repr=False)
class RayDerivatives(ShortText):
    """N rays after a lens, lens frame, and their derivatives by V variables. nan where a ray does not pass.

    status: (N,), RayStatus values. origins_mm, directions: (N, 3), on the last surface, unit. optical_path_mm: (N,).
    origins_by, directions_by: (N, 3, V); optical_path_by: (N, V): by the variables, each in its unit.
    origins_by_start, directions_by_start: (N, 3, 6); optical_path_by_start: (N, 6): by the origin, mm, and the
      direction, as they were given.
    """

    status: NDArray[np.int32]
    origins_mm: Doubles
    directions: Doubles
    optical_path_mm: Doubles
    origins_by: Doubles
    directions_by: Doubles
    optical_path_by: Doubles
    origins_by_start: Doubles
    directions_by_start: Doubles
    optical_path_by_start: Doubles


def ray_derivatives(
    lens: Lens,
    origins_mm: ArrayLike,
    directions: ArrayLike,
    variables: Sequence[Variable],
    *,
    wavelength_nm: float | None = None,
    start: str = "film",
) -> RayDerivatives:
    """Traces rays as Lens.trace does, with exact derivatives. origins_mm, directions: (N, 3), lens frame.

    start: "film" or "scene". Raises InputError for wrong shapes, and for variables that the lens has not.
    """
    status, numbers, by, by_start = lens._ray_derivatives(
        np.asarray(origins_mm, float),
        np.asarray(directions, float),
        [v.as_tuple() for v in checked(lens, variables)],
        wavelength_nm=wavelength_nm,
        start=start,
    )
    optical = numbers[:, 3:6]
    index = np.linalg.norm(optical, axis=1)[:, None]
    unit = optical / index

    # A unit vector changes across itself.
    across = (np.eye(3) - unit[:, :, None] * unit[:, None, :]) / index[:, :, None]

    return RayDerivatives(
        status,
        numbers[:, :3],
        unit,
        numbers[:, 6],
        by[:, :3],
        across @ by[:, 3:6],
        by[:, 6],
        by_start[:, :3],
        across @ by_start[:, 3:6],
        by_start[:, 6],
    )
