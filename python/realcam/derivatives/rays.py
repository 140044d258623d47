"""Derivatives of rays, and of functions of rays, by the variables of a lens and by the rays' starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import Lens
from ..short_text import ShortText
from .dual_array import Doubles
from .variable import Variable, checked


@dataclass(frozen=True, repr=False)
class RayDerivatives(ShortText):
    """N rays behind a lens, lens frame, and their derivatives by V variables. nan for rays that do not pass.

    status: (N,), RayStatus values. origins_mm, directions: (N, 3), on the last surface, unit. optical_path_mm: (N,).
    origins_by, directions_by: (N, 3, V); optical_path_by: (N, V): by the variables, per their units.
    origins_by_start, directions_by_start: (N, 3, 6); optical_path_by_start: (N, 6): by the input origin, mm, and the
      input direction.
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

    start: "film" or "scene". Raises InputError for wrong shapes, and for variables that the lens does not have.
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

    # The derivative of a unit vector is perpendicular to it.
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


@dataclass(frozen=True, repr=False)
class RayGradient(ShortText):
    """Derivatives of a scalar function of N rays behind a lens.

    by: (V,), by the variables, per their units. by_origins, by_directions: (N, 3), by the input rays, origins in mm.
      Zero for rays that do not pass.
    """

    by: Doubles
    by_origins: Doubles
    by_directions: Doubles


def backpropagate_rays(
    lens: Lens,
    origins_mm: ArrayLike,
    directions: ArrayLike,
    variables: Sequence[Variable],
    *,
    of_origins: ArrayLike | None = None,
    of_directions: ArrayLike | None = None,
    of_optical_paths: ArrayLike | None = None,
    wavelength_nm: float | None = None,
    start: str = "film",
) -> RayGradient:
    """Gradient of a scalar function of the rays that Lens.trace returns, by reverse-mode differentiation.

    origins_mm, directions, wavelength_nm, start: the input rays, as for Lens.trace.
    of_origins, of_directions: (N, 3), of_optical_paths: (N,): the function's derivatives by the origins, unit
    directions and optical paths of the result; None: it does not depend on them. Values of rays that do not pass are
    ignored. The time hardly depends on the number of variables: for a scalar function of many rays, this is many times
    faster than ray_derivatives. Raises InputError for wrong shapes, and for variables that the lens does not have.
    """
    o, d = np.asarray(origins_mm, float), np.asarray(directions, float)
    by, by_origins, by_directions = lens._backpropagate_rays(
        o,
        d,
        [v.as_tuple() for v in checked(lens, variables)],
        np.zeros_like(o) if of_origins is None else of_origins,
        np.zeros_like(d) if of_directions is None else of_directions,
        np.zeros(len(o)) if of_optical_paths is None else of_optical_paths,
        wavelength_nm=wavelength_nm,
        start=start,
    )
    return RayGradient(by, by_origins, by_directions)
