"""Text tables of a lens: its prescription, and its first-order and photographic data."""

from __future__ import annotations

import math
from collections.abc import Iterator

from .._core import Lens, Surface
from ..dispersion import LINE_D_NM
from ..number_text import number_text
from ..photography import magnification, photographic_figures

PRESCRIPTION = ("", "kind", "radius / mm", "thickness / mm", "glass, n_d", "semi-diameter / mm")


def number(value: float, digits: int = 4) -> str:
    """Text of a number with this many significant digits; "∞" for infinity."""
    return number_text(value, digits, infinite="∞")


def prescription(lens: Lens) -> Iterator[tuple[str, ...]]:
    """Yields one row of texts per surface, with the columns of PRESCRIPTION. The last thickness is the distance to the
    film."""
    for index, surface in enumerate(lens.surfaces):
        kind = "" if surface.type == "refracting" else surface.type
        if surface.aspheric_coefficients or surface.conic:
            kind = f"{kind} asphere".strip()
        radius = _radius(surface.radius_of_curvature_mm)
        if surface.form in ("toroid", "biconic"):
            kind = f"{kind} {surface.form}".strip()
            radius = f"{radius}; in xz {_radius(surface.radius_of_curvature_x_mm)}"
        if any(surface.decentre_mm) or any(surface.tilt_deg):
            kind = f"{kind} moved".strip()
        is_last = index == len(lens.surfaces) - 1
        thickness = lens.film_distance_mm if is_last else surface.thickness_mm
        yield (
            str(index + 1),
            kind,
            radius,
            number(thickness, 6),
            _glass(surface),
            number(surface.clear_semi_diameter_mm, 5),
        )


def _radius(radius_mm: float) -> str:
    return "plane" if math.isinf(radius_mm) else number(radius_mm, 6)


def _glass(surface: Surface) -> str:
    """Name and index of the glass behind a surface, or the index and Abbe number stated in the lens file."""
    label = surface.material.label.strip("[]()")
    if not label or label[0].isdigit():
        return label
    return f"{label}, {surface.material.index(LINE_D_NM):.5f}"


def first_order(lens: Lens) -> Iterator[tuple[str, str]]:
    """Yields (name, value) texts of the lens's data at its current focus and stop. Raises InputError if no light
    passes."""
    data, photo = lens.first_order(), photographic_figures(lens)
    angle = photo.angle_of_view_deg
    width, height = lens.film_mm
    yield "focal length", f"{number(data.effective_focal_length_mm)} mm"
    if not lens.is_rotational:
        for meridian in lens.meridians():
            yield f"{meridian.azimuth_deg:.3g}° from x", f"{number(meridian.focal_length_mm)} mm"
    assumption = ", assuming that surfaces with unknown coatings are uncoated" if lens.unknown_coatings else ""
    yield "f-number", f"f/{number(photo.f_number, 3)}, T/{number(photo.t_stop, 3)}{assumption}"
    if math.isfinite(lens.focus_distance_m):
        yield "in focus", f"{number(lens.focus_distance_m)} m from the film, magnification {magnification(lens):.3g}"
    yield "film", f"{number(width)} x {number(height)} mm"
    yield "angle of view", f"{angle.horizontal:.1f}° x {angle.vertical:.1f}°, diagonal {angle.diagonal:.1f}°"
    yield "back focal distance", f"{number(data.back_focal_distance_mm)} mm"
    yield "entrance pupil", _pupil(data.entrance_pupil_position_mm, data.entrance_pupil_diameter_mm)
    yield "exit pupil", _pupil(data.exit_pupil_position_mm, data.exit_pupil_diameter_mm)
    if lens.nearest_focus_m > 0:
        yield "nearest focus", f"{number(lens.nearest_focus_m, 3)} m"


def _pupil(position_mm: float, diameter_mm: float) -> str:
    if math.isinf(position_mm):
        return "at infinity: telecentric"
    side = "behind" if position_mm >= 0 else "before"
    return f"{number(abs(diameter_mm))} mm wide, {number(abs(position_mm))} mm {side} the front vertex"
