"""First-order data of lenses without rotational symmetry, about the film centre's chief ray, with derivatives."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .._core import InputError, Lens
from .dual_array import Doubles, DualArray
from .exit_pupil import ChiefRayNeighbours, at_film
from .variable import Variable


def focal_length_and_f_number(
    lens: Lens, variables: Sequence[Variable], wavelength_nm: float
) -> tuple[DualArray, DualArray]:
    """Focal length and f-number, geometric means of both meridians, as in Lens.first_order.

    Rays parallel to the chief ray with transverse positions q leave with optical directions C q. The singular values
    of C are the index behind the lens over each focal length, so their geometric mean follows from the determinant of
    C. In the same way the entrance pupil's area follows from the stop's, by the determinant of the map to the stop. The
    chief ray stays at the centres of stop and film, which determines its own derivatives.
    Raises InputError for rotationally symmetric lenses that are shifted or tilted against the film.
    """
    chief = lens.aim([[0.0, 0.0]], film_mm=(0.0, 0.0), wavelength_nm=wavelength_nm)
    direction = chief.directions[0]
    x = np.cross([0.0, 1.0, 0.0] if abs(direction[1]) < 0.9 else [1.0, 0.0, 0.0], direction)
    x /= np.linalg.norm(x)
    across = np.array([x, np.cross(direction, x)])
    basis = np.zeros((6, 4))
    basis[:3, :2] = basis[3:, 2:] = across.T

    def traced(**options: object) -> tuple[Doubles, Doubles, Doubles]:
        """The traced chief ray, its derivatives by the variables, and by its four coordinates at the start."""
        _, numbers, by, by_ray = lens._ray_derivatives(
            chief.origins_mm,
            chief.directions,
            [v.as_tuple() for v in variables],
            wavelength_nm=wavelength_nm,
            start="scene",
            rims=False,
            **options,  # type: ignore[arg-type]
        )
        return numbers[0, :6], by[0, :6], by_ray[0, :6] @ basis

    _, stop_by, stop_by_start = traced(frame="axis", surface_count=lens.stop_index + 1)
    numbers, by, by_start = traced(frame="film")
    # Derivatives of the film point by the ray's six coordinates behind the lens.
    slope, distance = numbers[3:5] / numbers[5], -numbers[2] / numbers[5]
    on_film = np.hstack([np.eye(2), -slope[:, None], distance * np.eye(2), -distance * slope[:, None]])
    start_by = -np.linalg.solve(
        np.vstack([stop_by_start[:2], on_film @ by_start]), np.vstack([stop_by[:2], on_film @ by])
    )
    rays = ChiefRayNeighbours(
        lens, variables, wavelength_nm, np.hstack([chief.origins_mm[0], direction]), across, start_by
    )
    behind = DualArray(numbers, by + by_start @ start_by)
    film, _ = at_film(rays, behind[:3], behind[3:])
    power, stop = film[2:, :2], rays.stop[:, :2]

    def log_growth(matrix: DualArray) -> Doubles:
        """Derivatives of half the logarithm of the determinant."""
        return np.asarray(0.5 * np.einsum("ij,jiv->v", np.linalg.inv(matrix.value), matrix.by))

    first_order = lens.first_order(wavelength_nm)
    size = 1 / np.sqrt(abs(np.linalg.det(power.value)))
    if abs(size / abs(first_order.effective_focal_length_mm) - 1) > 1e-6:
        # Lens.first_order undoes the shift or tilt.
        raise InputError(
            "shift and tilt against the film do not change focal length and f-number: "
            "differentiate the lens without them"
        )
    growth = -log_growth(power)  # relative derivatives of the focal length
    length = float(np.copysign(size, first_order.effective_focal_length_mm))
    f_number = first_order.f_number
    f_growth = growth + log_growth(stop)  # and of the f-number
    return DualArray(np.array(length), length * growth), DualArray(np.array(f_number), f_number * f_growth)
