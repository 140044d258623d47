"""Check whether a lens can be written as an OSL shader."""

from __future__ import annotations

import math

from .._core import InputError, Lens, Surface
from ..derivatives.variable import FORM_TERMS


def check_expressible(lens: Lens) -> None:
    """Raises InputError, with the surface or other reason, if the lens cannot be written as OSL."""
    for number, surface in enumerate(lens.surfaces, 1):
        reason = _why_not(surface)
        if reason:
            _refuse(lens, f"surface {number} {reason}")
    if math.isfinite(lens.film_radius_of_curvature_mm):
        _refuse(lens, "its film is curved")
    if not lens.is_rotational:
        _refuse(lens, "its film is tilted or shifted")
    if lens.surfaces[-1].type == "refracting" and lens.surfaces[-1].material.index(lens.wavelength_nm) != 1:
        _refuse(lens, f"surface {len(lens.surfaces)} has glass up to the film")
    if lens.first_order().effective_focal_length_mm == 0 or not math.isfinite(lens.first_order().f_number):
        _refuse(lens, "it is afocal or telecentric before its film, and has no f-number")


def _refuse(lens: Lens, reason: str) -> None:
    """Raises InputError."""
    raise InputError(f'lens "{lens.name}" cannot be written as OSL: {reason}')


def _why_not(surface: Surface) -> str:
    """Reason why a surface cannot be written, as a predicate; empty if it can."""
    if any(surface.decentre_mm) or any(surface.tilt_deg):
        return "is tilted or decentred"
    if surface.form != "conic":
        return f"is a {surface.form}"
    if surface.radial_terms:
        return "has radial_terms"
    if surface.xy_terms or any(getattr(surface, terms) for terms in FORM_TERMS):
        return "has freeform terms"
    if surface.aperture:
        return "has an aperture that is not a circle about the axis"
    if surface.obscurations:
        return "has obscurations"
    return ""
