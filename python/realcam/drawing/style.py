"""Options of drawings, colours of rays, legends and subtitles."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .._core import Lens
from ..number_text import number_text, optics_text
from ..section.ray_paths import RayBundle
from ..section.section import CrossSection
from .themes import LIGHT, Theme, colours_of_wavelengths


@dataclass(frozen=True)
class Style:
    """Options of a drawing."""

    theme: Theme = LIGHT
    radius_colours: bool = False  #: faces by the sign of their radius: positive blue, negative red
    marks: bool = False  #: pupils, principal planes, focal points
    font_pt: float = 9.0


def ray_colour(section: CrossSection, bundle: RayBundle, theme: Theme) -> str:
    """Returns the colour of a bundle: by wavelength if there are several, otherwise by field."""
    wavelengths = section.wavelengths_nm
    if len(wavelengths) > 1:
        return colours_of_wavelengths(wavelengths, theme)[wavelengths.index(bundle.wavelength_nm)]
    return theme.rays[section.fields.index(bundle.field) % len(theme.rays)]


def legend_of_wavelengths(section: CrossSection, theme: Theme) -> Sequence[tuple[str, str]]:
    """Returns text and colour for each wavelength; empty for a single one."""
    wavelengths = section.wavelengths_nm
    if len(wavelengths) < 2:
        return ()
    colours = colours_of_wavelengths(wavelengths, theme)
    return [(f"{wavelength:.4g} nm", colour) for wavelength, colour in zip(wavelengths, colours, strict=True)]


def data_of(lens: Lens, section: CrossSection) -> str:
    """Returns the subtitle of a drawing: focal length, f-number and focus."""
    words = [optics_text(lens)]
    if not math.isinf(lens.focus_distance_m):
        words.append(f"focused at {number_text(lens.focus_distance_m)} m")
    if len(section.wavelengths_nm) == 1:
        words.append(f"{section.wavelengths_nm[0]:.4g} nm")
    return ", ".join(words) + ("   * asphere" if any(face.is_asphere for face in section.faces) else "")
