"""Photographic data of a lens: angle of view, breathing, speed, exposure."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .._core import Camera, FieldOfView, InputError, Lens, RayStatus
from .depth import DepthOfField, depth_of_field
from .formulas import at_infinity

_RADII = np.sqrt(np.linspace(0, 1, 2001))  # finds the edge of the bundle within 0.025%


@dataclass(frozen=True)
class Breathing:
    """Focus breathing: the change of the angle of view with focus."""

    nearest_focus_m: float
    is_assumed: bool  #: True if the lens file does not specify a nearest focus; a magnification of 1/10 is used
    at_infinity_deg: FieldOfView
    at_nearest_deg: FieldOfView

    @property
    def change_percent(self) -> float:
        """Change of the diagonal angle from infinity to the nearest focus; negative: the picture gets narrower."""
        return 100 * (self.at_nearest_deg.diagonal / self.at_infinity_deg.diagonal - 1)


@dataclass(frozen=True)
class ExposureValue:
    """Exposure values, in stops."""

    exposure_time_s: float
    iso: float
    ev: float  #: log2(N^2 / t) with the engraved f-number
    ev100: float  #: log2(N^2 / t * 100 / ISO): the scene EV that these settings expose correctly, by the f-number
    ev100_at_film: float  #: the same by T-stop and working f-number, which include losses and extension


@dataclass(frozen=True)
class PhotographicFigures:
    """Photographic data of a lens at its current focus and stop."""

    name: str
    focal_length_mm: float  #: at the current focus
    focal_length_at_infinity_mm: float
    f_number: float  #: engraved: of the lens focused at infinity
    t_stop: float
    working_f_number: float  #: 1 / (2 n' sin u') of the outermost axial ray at the film
    working_f_number_by_formula: float  #: N (1 + m / p), p the pupil magnification
    focus_distance_m: float
    magnification: float  #: image over object, positive; 0 at infinity
    angle_of_view_deg: FieldOfView  #: by real rays from the film's edges
    angle_of_view_by_formula_deg: FieldOfView  #: 2 atan(size / (2 f (1 + m)))
    breathing: Breathing | None  #: None if the lens cannot be focused at infinity or at its nearest focus
    depth_of_field: DepthOfField
    exposure: ExposureValue | None


def angle_of_view_deg(lens: Lens) -> FieldOfView:
    """Returns the full angles over width, height and diagonal of the lens's film, by real rays from its edges, degrees.

    If the image circle is smaller than the film, they are those of the illuminated part.
    """
    return Camera(lens).field_of_view_deg


def breathing(lens: Lens, nearest_focus_m: float | None = None) -> Breathing:
    """Returns the angles of view at infinity and at the nearest focus.

    nearest_focus_m: distance from the object to the film; None: that of the lens file, or that of a magnification of
    1/10. Raises InputError if the lens cannot be focused at one of the two.
    """
    far = lens.focused(math.inf)
    nearest = lens.nearest_focus_m if nearest_focus_m is None else nearest_focus_m
    assumed = not nearest > 0
    if assumed:
        data = far.first_order()
        # Newton's equation: f / m from the front focal point to the object, m f from the rear one to the film.
        f, m = data.effective_focal_length_mm, 0.1
        nearest = (f / m - data.front_focal_distance_mm + far.film_position_mm + m * f * data.image_index) / 1000
    return Breathing(nearest, assumed, angle_of_view_deg(far), angle_of_view_deg(lens.focused(nearest)))


def exposure_value(lens: Lens, exposure_time_s: float, iso: float = 100.0) -> ExposureValue:
    """Returns the exposure values of a lens with these settings. Raises InputError."""
    if not (exposure_time_s > 0 and math.isfinite(exposure_time_s)):
        raise InputError("the exposure time must be a positive number of seconds")
    if not (iso > 0 and math.isfinite(iso)):
        raise InputError("the ISO must be a positive number")
    ev = math.log2(lens.f_number**2 / exposure_time_s)
    working_t_stop = lens.t_stop * working_f_number(lens) / working_f_number(at_infinity(lens))
    iso_stops = math.log2(100 / iso)
    ev_at_film = math.log2(working_t_stop**2 / exposure_time_s)
    return ExposureValue(exposure_time_s, iso, ev, ev + iso_stops, ev_at_film + iso_stops)


def working_f_number(lens: Lens) -> float:
    """Returns 1 / (2 n' sin u') of the outermost passing ray from the axial point of the plane in focus.

    Raises InputError if no light passes.
    """
    rays = lens.aim(np.column_stack([np.zeros_like(_RADII), _RADII]), 0.0)
    passing = rays.status == RayStatus.OK
    if not np.any(passing):
        raise InputError(f'no light passes lens "{lens.name}"')
    out = lens.trace(rays.origins_mm[passing], rays.directions[passing], start="scene")
    steepest = float(np.max(np.abs(out.directions[:, 1])))
    return 0.5 / (lens.first_order().image_index * steepest) if steepest > 0 else math.inf


def magnification(lens: Lens) -> float:
    """Returns the paraxial magnification of the plane in focus, as a positive number; 0 at infinity."""
    data = lens.first_order()
    object_mm = 1000 * lens.focus_distance_m - lens.film_position_mm
    return abs(data.effective_focal_length_mm / (object_mm + data.front_focal_distance_mm))


def photographic_figures(
    lens: Lens,
    *,
    circle_of_confusion_mm: float | None = None,
    exposure_time_s: float | None = None,
    iso: float = 100.0,
) -> PhotographicFigures:
    """Returns all photographic data. Arguments as for depth_of_field and exposure_value. Raises InputError."""
    far, data = at_infinity(lens), lens.first_order()
    at_far = far.first_order()
    m = magnification(lens)
    pupil_magnification = data.exit_pupil_diameter_mm / data.entrance_pupil_diameter_mm
    width, height = lens.film_mm
    by_formula = FieldOfView(
        *(
            math.degrees(2 * math.atan(size / (2 * at_far.effective_focal_length_mm * (1 + m))))
            for size in (width, height, math.hypot(width, height))
        )
    )
    try:
        breath = breathing(lens)
    except InputError:  # macro and relay lenses
        breath = None
    return PhotographicFigures(
        name=lens.name,
        focal_length_mm=data.effective_focal_length_mm,
        focal_length_at_infinity_mm=at_far.effective_focal_length_mm,
        f_number=at_far.f_number,
        t_stop=lens.t_stop,
        working_f_number=working_f_number(lens),
        working_f_number_by_formula=at_far.f_number * (1 + m / pupil_magnification),
        focus_distance_m=lens.focus_distance_m,
        magnification=m,
        angle_of_view_deg=angle_of_view_deg(lens),
        angle_of_view_by_formula_deg=by_formula,
        breathing=breath,
        depth_of_field=depth_of_field(lens, circle_of_confusion_mm),
        exposure=None if exposure_time_s is None else exposure_value(lens, exposure_time_s, iso),
    )
