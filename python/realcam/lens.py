"""Functions that create surfaces of a lens: the stop and mirrors."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ._core import Coating, Surface


def Stop(*, clear_semi_diameter_mm: float, thickness_mm: float = 0.0) -> Surface:  # noqa: N802
    """Returns a Surface that is the aperture stop: a plane with the diaphragm. A lens must have exactly one.

    clear_semi_diameter_mm: radius of the fully open diaphragm. thickness_mm: distance to the next surface.
    """
    return Surface(type="stop", clear_semi_diameter_mm=clear_semi_diameter_mm, thickness_mm=thickness_mm)


def Mirror(  # noqa: N802
    *,
    clear_semi_diameter_mm: float,
    radius_of_curvature_mm: float = math.inf,
    thickness_mm: float = 0.0,
    conic: float = 0.0,
    aspheric_coefficients: Mapping[int, float] | None = None,
    inner_semi_diameter_mm: float = 0.0,
    coating: str | Coating = "unknown",
) -> Surface:
    """Returns a Surface that is a mirror; arguments as for Surface(). Thicknesses are negative up to the next
    mirror."""
    return Surface(
        type="mirror",
        radius_of_curvature_mm=radius_of_curvature_mm,
        thickness_mm=thickness_mm,
        clear_semi_diameter_mm=clear_semi_diameter_mm,
        conic=conic,
        aspheric_coefficients=dict(aspheric_coefficients or {}),
        inner_semi_diameter_mm=inner_semi_diameter_mm,
        coating=coating,
    )
