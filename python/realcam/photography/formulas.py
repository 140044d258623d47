"""Thin-lens approximation of a real lens."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .._core import InputError, Lens


@dataclass(frozen=True)
class ThinLens:
    """A thin lens at the front principal plane of a real lens, with the film at the real film's position.

    Focal length and f-number are those of the lens focused at infinity, as engraved on it.
    """

    focal_length_mm: float
    f_number: float
    object_distance_mm: float  #: distance from the plane in focus to the principal plane, inf allowed
    film_from_principal_plane_mm: float  #: distance from the principal plane to the film; object distances from the
    #: film are longer by it than those from the thin lens

    @staticmethod
    def of(lens: Lens) -> ThinLens:
        """Returns the thin lens of a real one. Raises InputError without a positive focal length and an f-number."""
        data = at_infinity(lens).first_order()
        focal_length = data.effective_focal_length_mm
        if not (math.isfinite(focal_length) and focal_length > 0 and math.isfinite(data.f_number)):
            raise InputError(f'lens "{lens.name}" has no positive focal length and f-number to put into a formula')
        focused = lens.first_order()
        principal_plane = focused.front_focal_distance_mm + focused.effective_focal_length_mm
        to_film = lens.film_position_mm - principal_plane
        return ThinLens(focal_length, data.f_number, 1000 * lens.focus_distance_m - to_film, to_film)

    @property
    def magnification(self) -> float:
        """Image over object, as a positive number: m = f / (s - f)."""
        return self.focal_length_mm / (self.object_distance_mm - self.focal_length_mm)

    def hyperfocal_mm(self, circle_mm: float) -> float:
        """Returns the focus distance at which infinity is blurred by the circle of confusion: H = f^2 / (N c) + f."""
        f = self.focal_length_mm
        return f * f / (self.f_number * circle_mm) + f

    def sharp_range_mm(self, circle_mm: float) -> tuple[float, float]:
        """Returns the distances of the nearest and the farthest sharp object from the lens.

        near = s (H - f) / (H + s - 2 f), far = s (H - f) / (H - s), infinite from s = H on (S. F. Ray, Applied
        Photographic Optics, 3rd ed., chapter 22).
        """
        f, s, h = self.focal_length_mm, self.object_distance_mm, self.hyperfocal_mm(circle_mm)
        if math.isinf(s):
            return h - f, math.inf
        near = s * (h - f) / (h + s - 2 * f)
        return near, s * (h - f) / (h - s) if s < h else math.inf

    def approximate_depth_mm(self, circle_mm: float) -> float:
        """Returns 2 N c (m + 1) / m^2: equation 8 of Liu and Hsu (2013), for depths much smaller than the distance."""
        m = self.magnification
        return 2 * self.f_number * circle_mm * (m + 1) / m**2 if m > 0 else math.inf

    def vergence_of_blur_per_mm(self, circle_mm: float) -> float:
        """Returns the change of the inverse object distance that blurs by the circle of confusion, about N c / f^2."""
        return self.f_number * circle_mm / (self.focal_length_mm * self.focal_length_mm)


def at_infinity(lens: Lens) -> Lens:
    """Returns the lens focused at infinity, or unchanged if that is not possible."""
    try:
        return lens.focused(math.inf)
    except InputError:
        return lens
