"""Exit-pupil distance of lenses without rotational symmetry, by parabasal rays, with derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .._core import Lens
from .dual_array import Doubles, DualArray
from .variable import Variable

# Central difference of the first derivative by four points; its error is of fourth order in the step.
OFFSETS = np.array([-2.0, -1.0, 1.0, 2.0])
WEIGHTS = np.array([1.0, -8.0, 8.0, -1.0]) / 12


class ChiefRayNeighbours:
    """Parabasal rays about a chief ray: first-order transfer from the start to the stop and the film, with derivatives
    by the variables of the lens.

    A ray has four coordinates at its start: position, mm, and direction along two axes perpendicular to the chief ray.
    start: (6,), origin and unit direction of the chief ray in front of the lens. across: (2, 3), the two axes.
    start_by: (4, V), derivatives of the chief ray's own coordinates by the variables.
    stop: (2, 4), position: (3, 4), direction: (3, 4): derivatives of a ray's stop coordinates, and of its position and
    optical direction at the film, by its four coordinates.
    """

    def __init__(
        self,
        lens: Lens,
        variables: Sequence[Variable],
        wavelength_nm: float,
        start: Doubles,
        across: Doubles,
        start_by: Doubles,
    ) -> None:
        self._lens, self._variables = lens, [v.as_tuple() for v in variables]
        self._wavelength_nm = wavelength_nm
        self._start, self._start_by = start, start_by
        self._basis = np.zeros((6, 4))
        self._basis[:3, :2] = self._basis[3:, 2:] = across.T
        to_stop: dict[str, Any] = {"frame": "axis", "surface_count": lens.stop_index + 1, "rims": False}
        # Steps of a thousandth of the stop's radius, where the stencil's error is far below rounding.
        on_stop = (self._traced(start[None], **to_stop)[1][0] @ self._basis)[:2]
        step_on_stop_mm = 1e-3 * lens.surfaces[lens.stop_index].clear_semi_diameter_mm
        self._steps = step_on_stop_mm / np.linalg.norm(on_stop, axis=0)
        self.stop = self._derivatives(2, **to_stop)
        film = self._derivatives(6, frame="film", rims=False)
        self.position, self.direction = film[:3], film[3:]

    def _traced(self, rays: Doubles, **options: Any) -> tuple[Doubles, Doubles]:
        """Derivatives of rays by the variables, and by the rays' starts."""
        o, d = rays[:, :3], rays[:, 3:]
        return self._lens._ray_derivatives(
            o, d, self._variables, wavelength_nm=self._wavelength_nm, start="scene", **options
        )[2:]

    def _derivatives(self, rows: int, **options: Any) -> DualArray:
        """(rows, 4): derivatives of a ray's first `rows` coordinates on the film, or on the stop, by its four
        coordinates at the start."""
        offsets = np.einsum("k,j,rj->jkr", OFFSETS, self._steps, self._basis).reshape(-1, 6)
        by, by_ray = self._traced(np.vstack([self._start[None], self._start + offsets]), **options)
        first = by_ray[:, :rows] @ self._basis
        weights = WEIGHTS / self._steps[:, None]
        neighbours = (4, len(OFFSETS), rows)
        # Second derivatives: by start and variable, and by start twice.
        mixed = np.einsum("jk,jkrv->rjv", weights, by[1:, :rows].reshape(*neighbours, -1))
        bend = np.einsum("ik,ikrj->rji", weights, first[1:].reshape(*neighbours, 4))
        return DualArray(first[0], mixed + bend @ self._start_by)


def exit_pupil_distance(rays: ChiefRayNeighbours, origin: DualArray, direction: DualArray) -> DualArray:
    """Distance from the exit pupil to the film along the chief ray, mm. Same as the C++ function of that name.

    origin, direction: (3,), of the chief ray behind the lens, in the film's frame; directions are optical (times the
    index). The pupil is the image of the stop: a ray with transverse position q and optical direction p at the film
    meets the stop at A q + B p, and the distance is half the trace of -n A^-1 B, the mean of both meridians.
    """
    film, index = at_film(rays, origin, direction)
    by_film = _solved_right(rays.stop, film)
    return -0.5 * index * _trace_of_quotient(by_film[:, :2], by_film[:, 2:])


def at_film(rays: ChiefRayNeighbours, origin: DualArray, direction: DualArray) -> tuple[DualArray, DualArray]:
    """(4, 4): derivatives of transverse positions and optical directions at the film by the four coordinates of a ray
    at its start; and the index behind the lens."""
    square = direction * direction
    index = (square[0] + square[1] + square[2]).sqrt()
    z = [direction[i] / index for i in range(3)]
    width = (z[0] * z[0] + z[2] * z[2]).sqrt()
    zero = DualArray.constant(0.0, direction.count)
    # Two axes perpendicular to the chief ray z.
    x = [z[2] / width, zero, -z[0] / width]
    y = [-(z[0] * z[1]) / width, width, -(z[1] * z[2]) / width]
    distance = -origin[2] / direction[2]  # to the film, whose frame has z = 0
    positions = [rays.position[i] + distance * rays.direction[i] for i in range(3)]
    rows = [
        axis[0] * part[0] + axis[1] * part[1] + axis[2] * part[2]
        for part in (positions, [rays.direction[i] for i in range(3)])
        for axis in (x, y)
    ]
    return DualArray(np.array([row.value for row in rows]), np.array([row.by for row in rows])), index


def _solved_right(a: DualArray, b: DualArray) -> DualArray:
    """a b^-1"""
    inverse = np.linalg.inv(b.value)
    value = a.value @ inverse
    change = a.by - np.einsum("ij,jkv->ikv", value, b.by)
    return DualArray(value, np.einsum("ijv,jk->ikv", change, inverse))


def _trace_of_quotient(a: DualArray, b: DualArray) -> DualArray:
    """The trace of a^-1 b."""
    inverse = np.linalg.inv(a.value)
    value = inverse @ b.value
    change = b.by - np.einsum("ijv,jk->ikv", a.by, value)
    return DualArray(np.trace(value), np.einsum("ij,jiv->v", inverse, change))
