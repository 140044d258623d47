"""Shorthands for stops and mirrors."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ._core import Coating, Surface


def Stop(*, clear_semi_diameter_mm: float, thickness_mm: float = 0.0) -> Surface:  # noqa: N802
    """The aperture stop: a plane whose opening the f-number ring changes. A lens has exactly one."""
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
    """A mirror. Thicknesses after it are negative until the next mirror."""
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
