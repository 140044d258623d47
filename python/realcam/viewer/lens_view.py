"""A lens as JSON for the browser's drawing: section, table, first-order data, and rays."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from .._core import Film, InputError, Lens
from ..fields import angle_of_height
from ..json_values import json_value
from ..section import CrossSection, cross_section
from ..section.cut import PLANES, Cut, Points

_RAYS = 9  # rays of each bundle
_FIRST_ORDER = (
    "effective_focal_length_mm",
    "f_number",
    "back_focal_distance_mm",
    "front_focal_distance_mm",
    "entrance_pupil_position_mm",
    "entrance_pupil_diameter_mm",
    "exit_pupil_position_mm",
    "exit_pupil_diameter_mm",
)


def lens_view(lens: Lens, plane: str = "yz") -> dict[str, Any]:
    """Returns the section in a plane, "yz" or "xz", with points (z, height); lengths in mm, lens frame.

    is_rotational: true if both planes are equal. is_in_place: true if no surface is tilted or decentred.
    None stands for infinity, which JSON cannot express.
    """
    section = cross_section(lens, plane=plane, rays=0)
    return {
        "name": lens.name,
        "title": lens.title,
        "surfaces": json_value([_row(lens, index) for index in range(len(lens.surfaces))]),
        "film": _points(section.film),
        "plane": plane,
        "is_rotational": lens.is_rotational,
        "is_in_place": Cut(lens).is_in_place,
        "figures": json_value(_figures(lens)),
        **_shapes(section),
    }


def film_point(u: float, v: float, film: Film) -> tuple[float, float]:
    """Film point (x, y) in mm from the lens's axis of a point u, v of the picture; the image is upside down."""
    right, up = film.shift_mm
    return (0.5 - u) * film.width_mm - right, (v - 0.5) * film.height_mm - up


def height_of(u: float, v: float, film: Film) -> float:
    """Distance of the film point from the lens's axis, mm."""
    return math.hypot(*film_point(u, v, film))


def drawn_heights_mm(film: Film, point: tuple[float, float] | None, axis: int | None = None) -> tuple[float, ...]:
    """Film heights for which rays are drawn, mm: 0, and that of a point of the picture (u and v, 0 to 1).

    axis: None: distance from the axis; 0 or 1: the x or y coordinate.
    """
    film_mm = film_point(*(point or (0.5 - 0.35, 0.5 + 0.35)), film)
    height = math.hypot(*film_mm) if axis is None else film_mm[axis]
    return (0.0, height) if abs(height) > 5e-4 * math.hypot(film.width_mm, film.height_mm) else (0.0,)


def ray_view(lens: Lens, heights_mm: Sequence[float], plane: str = "yz") -> dict[str, Any]:
    """Returns ray bundles to heights on the film as paths of (z, height). Heights beyond the image circle are clamped
    to it. If no light passes, there are no bundles, and `note` has the reason.
    """
    try:
        if lens.is_rotational:
            _, largest_mm = angle_of_height(lens, 0.5 * math.hypot(*lens.film_mm))
        else:
            largest_mm = 0.5 * lens.film_mm[PLANES[plane]]
        fields = [max(-1.0, min(1.0, height / largest_mm)) for height in heights_mm]
        section = cross_section(lens, plane=plane, rays=_RAYS, fields=fields)
    except InputError as error:
        return {"bundles": [], "note": str(error)}
    return {
        "bundles": [[_points(path) for path in section.drawn_paths(bundle)] for bundle in section.bundles],
        "note": "",
    }


def _row(lens: Lens, index: int) -> dict[str, Any]:
    """Row of the table of surfaces; z is the position of the vertex, mm."""
    surface = lens.surfaces[index]
    last = index + 1 == len(lens.surfaces)
    in_xz = {"radius_x_mm": surface.radius_of_curvature_x_mm} if surface.form in ("toroid", "biconic") else {}
    return {
        "z": lens.vertices_mm[index],
        "type": surface.type,
        "radius_mm": surface.radius_of_curvature_mm,
        **in_xz,
        "thickness_mm": lens.film_distance_mm if last else surface.thickness_mm,
        "glass": surface.material.label,
        "semi_diameter_mm": surface.clear_semi_diameter_mm,
        "conic": surface.conic,
        "aspheric": {str(power): value for power, value in surface.aspheric_coefficients.items()},
    }


def _shapes(section: CrossSection) -> dict[str, Any]:
    """Lines and polygons of a section: faces, elements, apertures, overlaps of surfaces, and marks."""
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
        "overlaps": [_points(zone) for crossing in section.overlaps for zone in crossing.zones],
        "marks": [{"kind": m.kind, "label": m.label, "z": m.z_mm, "half": m.semi_diameter_mm} for m in section.marks],
    }


def _figures(lens: Lens) -> dict[str, Any]:
    """First-order data."""
    data = lens.first_order()
    return {**{name: getattr(data, name) for name in _FIRST_ORDER}, "film_distance_mm": lens.film_distance_mm}


def _points(points: Points) -> list[list[float]]:
    """(z, height) pairs of points, rounded."""
    # Rounds to a thousandth of a line's width, if the lens fills the window.
    size = float(np.max(np.abs(points), initial=1e-9))
    return np.round(points, max(0, 5 - math.floor(math.log10(size)))).tolist()  # type: ignore[no-any-return]
