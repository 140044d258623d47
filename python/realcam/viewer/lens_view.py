"""What the browser draws of a lens as JSON: its section, its table and its first-order data; and its rays."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from .._core import Film, InputError, Lens
from ..drawing import CrossSection, cross_section
from ..drawing.cut import PLANES, Cut, Points
from ..fields import angle_of_height

_RAYS = 9


def lens_view(lens: Lens, plane: str = "yz") -> dict[str, Any]:
    """The section in a plane, "yz" or "xz", of points (z, height); lengths in mm, lens frame.

    `is_rotational` tells that both planes are alike, `is_in_place` that all surfaces stand upright on one axis.
    """
    section = cross_section(lens, plane=plane, rays=0)
    return {
        "name": lens.name,
        "title": lens.title,
        "surfaces": [_row(lens, index) for index in range(len(lens.surfaces))],
        "film": _points(section.film),
        "plane": plane,
        "is_rotational": lens.is_rotational,
        "is_in_place": Cut(lens).is_in_place,
        "figures": _figures(lens),
        **_shapes(section),
    }


def place_of(u: float, v: float, film: Film) -> tuple[float, float]:
    """(x, y) on the film, mm from the lens's axis, of a place in the picture, which a lens turns upside down."""
    right, up = film.shift_mm
    return (0.5 - u) * film.width_mm - right, (v - 0.5) * film.height_mm - up


def height_of(u: float, v: float, film: Film) -> float:
    """Distance from the lens's axis, mm."""
    return math.hypot(*place_of(u, v, film))


def drawn_heights_mm(film: Film, place: tuple[float, float] | None, axis: int | None = None) -> tuple[float, ...]:
    """Heights above the lens's axis: that of the axis, and that of a place of the picture (u and v, 0 to 1).

    axis: None is the distance in any direction; 0 and 1 take the height along x or y alone.
    """
    at = place_of(*(place or (0.5 - 0.35, 0.5 + 0.35)), film)
    height = math.hypot(*at) if axis is None else at[axis]
    return (0.0, height) if abs(height) > 5e-4 * math.hypot(film.width_mm, film.height_mm) else (0.0,)


def ray_view(lens: Lens, heights_mm: Sequence[float], plane: str = "yz") -> dict[str, Any]:
    """Bundles of rays to heights on the film as paths of (z, height). Beyond the last height that gets light it is
    drawn instead. Where no light passes there are none, and `note` says why.
    """
    try:
        if lens.is_rotational:
            _, last_mm = angle_of_height(lens, 0.5 * math.hypot(*lens.film_mm))
        else:
            last_mm = 0.5 * lens.film_mm[PLANES[plane]]
        fields = [max(-1.0, min(1.0, height / last_mm)) for height in heights_mm]
        section = cross_section(lens, plane=plane, rays=_RAYS, fields=fields)
    except InputError as error:
        return {"bundles": [], "note": str(error)}
    return {
        "bundles": [[_points(path) for path in section.drawn_paths(bundle)] for bundle in section.bundles],
        "note": "",
    }


def _row(lens: Lens, index: int) -> dict[str, Any]:
    surface = lens.surfaces[index]
    last = index + 1 == len(lens.surfaces)
    in_xz = {"radius_x_mm": _finite(surface.radius_of_curvature_x_mm)} if surface.form in ("toroid", "biconic") else {}
    return {
        "z": lens.vertices_mm[index],
        "type": surface.type,
        "radius_mm": _finite(surface.radius_of_curvature_mm),
        **in_xz,
        "thickness_mm": lens.film_distance_mm if last else surface.thickness_mm,
        "glass": surface.material.label,
        "semi_diameter_mm": surface.clear_semi_diameter_mm,
        "conic": surface.conic,
        "aspheric": {str(power): value for power, value in surface.aspheric_coefficients.items()},
    }


def _shapes(section: CrossSection) -> dict[str, Any]:
    return {
        "faces": [
            {
                "surface": face.surface,
                "sign": face.radius_sign,
                "is_mirror": face.is_mirror,
                "parts": [_points(part) for part in face.parts],
            }
            for face in section.faces
        ],
        "elements": [_points(polygon) for element in section.elements for polygon in element.polygons],
        "blockers": [
            {
                "surface": b.surface,
                "is_stop": b.is_stop,
                "lines": [_points(line) for line in b.lines],
            }
            for b in section.blockers
        ],
        "crossings": [_points(zone) for crossing in section.crossings for zone in crossing.zones],
        "marks": [{"kind": m.kind, "label": m.label, "z": m.z_mm, "half": m.semi_diameter_mm} for m in section.marks],
    }


def _figures(lens: Lens) -> dict[str, float | None]:
    data = lens.first_order()
    return {
        "effective_focal_length_mm": _finite(data.effective_focal_length_mm),
        "f_number": _finite(data.f_number),
        "back_focal_distance_mm": _finite(data.back_focal_distance_mm),
        "front_focal_distance_mm": _finite(data.front_focal_distance_mm),
        "entrance_pupil_position_mm": _finite(data.entrance_pupil_position_mm),
        "entrance_pupil_diameter_mm": _finite(data.entrance_pupil_diameter_mm),
        "exit_pupil_position_mm": _finite(data.exit_pupil_position_mm),
        "exit_pupil_diameter_mm": _finite(data.exit_pupil_diameter_mm),
        "film_distance_mm": lens.film_distance_mm,
    }


def _points(points: Points) -> list[list[float]]:
    # A thousandth of the thickness of a line, wherever a lens is as large as the window.
    size = float(np.max(np.abs(points), initial=1e-9))
    return np.round(points, max(0, 5 - math.floor(math.log10(size)))).tolist()  # type: ignore[no-any-return]


def _finite(value: float) -> float | None:
    """JSON has no infinity."""
    return value if math.isfinite(value) else None
