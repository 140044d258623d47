"""The plane of a cross-section, and the positions of surfaces and film in it."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InputError, Lens

Points = NDArray[np.float64]
PLANES = {"yz": 1, "xz": 0}  #: index of the height axis in the lens frame, by plane


class Cut:
    """A lens cut by the plane x = 0 ("yz") or y = 0 ("xz") of its frame. Points are (z, height) in mm, lens frame.
    axis: index of the height axis, 1 for y and 0 for x.

    A surface that is tilted out of the plane is cut in its own frame, and the cut is projected onto the plane. Raises
    InputError for another plane.
    """

    def __init__(self, lens: Lens, plane: str = "yz") -> None:
        if plane not in PLANES:
            raise InputError(f'the plane of a drawing is "{plane}"; expected yz or xz')
        self.lens, self.plane = lens, plane
        self.axis = PLANES[plane]

    @cached_property
    def is_in_place(self) -> bool:
        """True if surfaces and film are neither tilted nor decentred."""
        return all(
            not any(surface.decentre_mm) and not any(surface.tilt_deg) for surface in self.lens.surfaces
        ) and bool(np.allclose(self.lens.film_frame[:3], np.eye(3), atol=1e-12))

    def sag(self, surface: int, heights: ArrayLike) -> Points:
        """Returns the sags in mm of a surface at heights in the plane of the cut, relative to its vertex."""
        shape = self.lens.surfaces[surface]
        values = np.asarray(heights, float)
        return np.array([shape.sag_at_mm(0.0, v) if self.axis == 1 else shape.sag_at_mm(v, 0.0) for v in values])

    def placed(self, surface: int, sags: ArrayLike, heights: ArrayLike) -> Points:
        """Converts points (sag, height) from a surface's own frame to the plane of the cut, (N, 2)."""
        z, height = np.asarray(sags, float), np.asarray(heights, float)
        if self.is_in_place:
            return np.column_stack([self.lens.vertices_mm[surface] + z, height])
        return self._projected(self.lens.surface_frames[surface], z, height)

    def _projected(self, frame: Points, z: Points, height: Points) -> Points:
        """Projects points of a frame, (4, 3) as in Lens.surface_frames, onto the plane of the cut."""
        points: Points = frame[3] + height[:, None] * frame[self.axis] + z[:, None] * frame[2]
        return points[:, [2, self.axis]]

    @cached_property
    def film(self) -> Points:
        """(N, 2): outline of the film, half its diagonal to either side."""
        semi = 0.5 * float(np.hypot(*self.lens.film_mm))
        height = np.linspace(-semi, semi, 2 if np.isinf(self.lens.film_radius_of_curvature_mm) else 61)
        sag = film_sag(self.lens, height)
        if self.is_in_place:
            return np.column_stack([self.lens.film_position_mm + sag, height])
        return self._projected(self.lens.film_frame, sag, height)


def film_sag(lens: Lens, distance_mm: Points) -> Points:
    """Returns the sag of the film at a distance from its centre, mm."""
    radius = lens.film_radius_of_curvature_mm
    root = np.sqrt(np.maximum(1 - (distance_mm / radius) ** 2, 0.0))
    sag: Points = distance_mm**2 / radius / (1 + root)
    return sag


def on_film(cut: Cut, points: Points, directions: Points) -> Points:
    """Returns the intersections (N, 3) of rays, as straight lines, with the film. All in the lens frame."""
    lens = cut.lens
    is_flat = np.isinf(lens.film_radius_of_curvature_mm)
    if cut.is_in_place and is_flat:
        plane: Points = points + directions * ((lens.film_position_mm - points[:, 2]) / directions[:, 2])[:, None]
        return plane
    frame = lens.film_frame
    local, direction = (points - frame[3]) @ frame[:3].T, directions @ frame[:3].T
    hits = local - (local[:, 2] / direction[:, 2])[:, None] * direction  # with the film's vertex plane
    if not is_flat:  # a sphere: the intersection closer to the vertex plane
        from_centre = hits - [0, 0, lens.film_radius_of_curvature_mm]
        half_b = (from_centre * direction).sum(axis=1)  # of the quadratic equation t^2 + 2 half_b t + c = 0
        discriminant = half_b**2 - (from_centre**2).sum(axis=1) + lens.film_radius_of_curvature_mm**2
        root = np.sqrt(np.maximum(discriminant, 0.0))
        hits = hits + np.where(half_b > 0, root - half_b, -root - half_b)[:, None] * direction
    result: Points = frame[3] + hits @ frame[:3]
    return result
