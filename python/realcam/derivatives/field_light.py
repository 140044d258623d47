"""Ray bundle of one object point that fills the real stop, with derivatives at constant stop coordinates.

Each ray is aimed at a fixed point of the stop. When a variable of the lens changes, the ray's start in front of the
lens must follow; its derivative results from the derivatives at the stop by the implicit function theorem.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import AimedRays, InputError, Lens
from .dual_array import Doubles, DualArray
from .exit_pupil import ChiefRayNeighbours, exit_pupil_distance
from .first_order import FirstOrderDuals, first_order_duals
from .variable import Variable


@dataclass(frozen=True)
class FieldLight:
    """Rays behind the lens, mm. The last ray is the chief ray.

    weights: (N - 1,), fractions of the stop's area, 0 for rays that do not pass. pupil: (N, 2), points on the stop.
    origins, directions: (N, 3), directions times the index; paths: (N,), optical. For field angles of rotationally
    symmetric lenses, z is measured from the last vertex, and first_order is set. Otherwise z is measured from the film,
    in its frame, and exit_pupil returns the distance from the exit pupil to the film.
    """

    field_deg: float
    first_order: FirstOrderDuals | None
    weights: Doubles
    pupil: Doubles
    passes: NDArray[np.bool_]
    origins: DualArray
    directions: DualArray
    paths: DualArray
    exit_pupil: Callable[[], DualArray] | None = None

    @property
    def film_z(self) -> DualArray:
        """z of the film, mm."""
        if self.first_order is not None:
            return self.first_order.film_distance_mm
        return DualArray.constant(0.0, self.origins.count)

    def on_film(self) -> DualArray:
        """(N, 2): intersections of the rays with the film, or with its tangent plane at the centre."""
        o, p = self.origins, self.directions
        distance = (self.film_z - o[:, 2]) / p[:, 2]
        x, y = o[:, 0] + distance * p[:, 0], o[:, 1] + distance * p[:, 1]
        return DualArray(np.stack([x.value, y.value], 1), np.stack([x.by, y.by], 1))


def field_light(
    lens: Lens,
    variables: Sequence[Variable],
    field_deg: float,
    wavelength_nm: float,
    *,
    object_distance_m: float | None = None,
    film_mm: tuple[float, float] | None = None,
    samples: int = 6,
    pattern: str = "hexapolar",
) -> FieldLight:
    """Traces the bundle of a field point with derivatives by the variables.

    film_mm: the field as a film point, in place of field_deg. samples, pattern: as for Lens.spot.
    Raises InputError if no light passes, if the chief ray is blocked, or if the film is curved.
    """
    if math.isfinite(lens.film_radius_of_curvature_mm):
        raise InputError(f'derivatives of a spot or wavefront need a flat film; that of lens "{lens.name}" is curved')
    count = len(variables)
    keywords: dict[str, Any] = {
        "object_distance_m": object_distance_m,
        "film_mm": film_mm,
        "wavelength_nm": wavelength_nm,
    }
    spot = lens.spot(field_deg, samples=samples, pattern=pattern, **keywords)
    pupil = np.vstack([spot.pupil, [[0.0, 0.0]]])
    aimed = lens.aim(pupil, field_deg, **keywords)
    passes = aimed.status == 0
    if not passes[-1]:
        where = f"at {field_deg:.6g} deg" if film_mm is None else f"of the film point {film_mm}"
        raise InputError(f"the ray {where} through the centre of the stop is blocked")
    weights = np.where(passes[:-1], spot.weights, 0.0)
    first_order, frame = None, "film"
    if lens.is_rotational and film_mm is None:
        first_order, frame = first_order_duals(lens, variables, wavelength_nm), "axis"
        start, path = _start_of_field_angle(lens, first_order, aimed.origins_mm, field_deg, object_distance_m, count)
    else:
        distance = lens.focus_distance_m if object_distance_m is None else object_distance_m
        start, path = _start_of_fixed_point(aimed, math.isfinite(distance), count)
    value = start.value
    listed = [v.as_tuple() for v in variables]
    _, _, at_stop, at_stop_by_ray = lens._ray_derivatives(
        value[:, :3],
        value[:, 3:],
        listed,
        wavelength_nm=wavelength_nm,
        start="scene",
        frame="axis",
        surface_count=lens.stop_index + 1,
        rims=False,
    )
    _, numbers, by, by_ray = lens._ray_derivatives(
        value[:, :3], value[:, 3:], listed, wavelength_nm=wavelength_nm, start="scene", frame=frame
    )
    at_stop_by = at_stop_by_ray[:, :2] @ start.by
    at_stop_by[..., 2:] += at_stop[:, :2]
    # Derivatives of the rays' starts, (N, 2, V), that keep their stop coordinates; nan for rays that do not pass.
    entry_by = np.full((len(pupil), 2, count), np.nan)
    is_finite = np.isfinite(at_stop_by).all(axis=(1, 2))
    entry_by[is_finite] = -np.linalg.solve(at_stop_by[is_finite][..., :2], at_stop_by[is_finite][..., 2:])
    all_by = by_ray @ start.by
    all_by[..., 2:] += by
    all_by[:, 6] += path.by
    total = all_by[..., 2:] + all_by[..., :2] @ entry_by
    origins = DualArray(numbers[:, :3], total[:, :3])
    directions = DualArray(numbers[:, 3:6], total[:, 3:6])

    def exit_pupil() -> DualArray:
        chief_by = start.by[-1][:, :2]  # its six coordinates by the two that aim it
        across = chief_by[:3].T
        moves = np.vstack([entry_by[-1], (across @ chief_by[3:]) @ entry_by[-1]])
        rays = ChiefRayNeighbours(lens, variables, wavelength_nm, value[-1], across, moves)
        return exit_pupil_distance(rays, origins[-1], directions[-1])

    return FieldLight(
        field_deg,
        first_order,
        weights,
        pupil,
        passes,
        origins,
        directions,
        DualArray(numbers[:, 6] + path.value, total[:, 6]),
        None if first_order is not None else exit_pupil,
    )


def _start_of_fixed_point(aimed: AimedRays, is_finite: bool, count: int) -> tuple[DualArray, DualArray]:
    """Starts of rays from a fixed object point: (N, 6) origins and unit directions, and (N,) paths. The first two
    derivatives are by the position along two axes perpendicular to the ray, mm."""
    o, d = aimed.origins_mm, aimed.directions
    passes = aimed.status == 0
    x = np.cross(np.where(np.abs(d[:, 1:2]) < 0.9, [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]]), d)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(d, x)
    by = np.zeros((len(o), 6, count + 2))
    by[:, :3, 0], by[:, :3, 1] = x, y
    path = np.zeros(len(o))
    if is_finite:
        # The object point: the point nearest to all rays.
        across = np.eye(3) - d[passes, :, None] * d[passes, None, :]
        point = np.linalg.solve(across.sum(0), np.einsum("nij,nj->i", across, o[passes]))
        distance = np.linalg.norm(o - point, axis=1)
        by[:, 3:, 0], by[:, 3:, 1] = x / distance[:, None], y / distance[:, None]
        path = np.einsum("ni,ni->n", o - o[-1], o + o[-1] - 2 * point) / (distance + distance[-1])
    return DualArray(np.hstack([o, d]), by), DualArray(path, np.zeros((len(o), count + 2)))


def _start_of_field_angle(
    lens: Lens,
    first_order: FirstOrderDuals,
    origins_mm: Doubles,
    field_deg: float,
    object_distance_m: float | None,
    count: int,
) -> tuple[DualArray, DualArray]:
    """Starts of rays of a field angle: (N, 6) origins and unit directions in the plane through the entrance pupil's
    centre, as from Lens.aim, and (N,) paths from the object relative to the central ray's. The first two derivatives
    are by the two coordinates in that plane, mm."""
    sine, cosine = math.sin(math.radians(field_deg)), math.cos(math.radians(field_deg))

    def widened(number: DualArray) -> DualArray:
        """The number with derivatives of 0 by the two coordinates."""
        return DualArray(number.value, np.concatenate([[0.0, 0.0], number.by]))

    pupil = widened(first_order.entrance_pupil_position_mm)
    distance = 1000 * object_distance_m if object_distance_m is not None else None
    if distance is None and math.isfinite(lens.focus_distance_m):
        to_film = widened(first_order.last_vertex_mm) + widened(first_order.film_distance_mm)
        inverse = cosine / (1000 * lens.focus_distance_m - to_film + pupil)
    elif distance is not None and math.isfinite(distance):
        inverse = cosine / (distance + pupil)
    else:
        inverse = DualArray.constant(0.0, count + 2)
    x = origins_mm[:, 0]
    along = origins_mm[:, 1] * cosine - (origins_mm[:, 2] - pupil.value) * sine
    units = np.zeros((2, len(x), count + 2))
    units[0, :, 0] = units[1, :, 1] = 1
    ex, ey = DualArray(x, units[0]), DualArray(along, units[1])  # coordinates in the plane
    square = ex * ex + ey * ey
    root = (1.0 + square * inverse * inverse).sqrt()
    # Direction (towards + inverse * offset) / root; `root` is its length because the offset is perpendicular.
    parts = [ex, ey * cosine, pupil - ey * sine]
    parts += [(ex * inverse) / root, (sine + ey * inverse * cosine) / root, (cosine - ey * inverse * sine) / root]
    start = DualArray(np.stack([p.value for p in parts], 1), np.stack([p.by for p in parts], 1))
    return start, square * inverse / (1.0 + root)
