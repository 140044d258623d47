"""Colour themes of drawings, for light and dark pages."""

from __future__ import annotations

import bisect
from collections.abc import Sequence
from dataclasses import dataclass

from .._core import InputError


@dataclass(frozen=True)
class Theme:
    """Colours in matplotlib's format. Ray colours differ from the colours of the sign of a radius."""

    page: str
    text: str
    faint: str  #: inconspicuous lines
    grid: str
    glass: str
    edge: str
    positive: str  #: faces whose centre of curvature lies on the film's side
    negative: str
    plane: str
    error: str
    rays: tuple[str, ...]


LIGHT = Theme(
    page="#ffffff",
    text="#1b1f24",
    faint="#8a929c",
    grid="#d5d5d5",
    glass="#dbe8f3",
    edge="#33607f",
    positive="#1757c8",
    negative="#d0281f",
    plane="#5c6670",
    error="#e00000",
    rays=("#b86e00", "#17804e", "#7b3fb0", "#00798c", "#8c4a2f", "#b0307a", "#5d6b00"),
)
DARK = Theme(
    page="#14181d",
    text="#e6e9ec",
    faint="#7f8994",
    grid="#3c4148",
    glass="#223a4e",
    edge="#8db9da",
    positive="#6ea3ff",
    negative="#ff7269",
    plane="#b4bcc4",
    error="#ff4136",
    rays=("#ffb14a", "#4fd08e", "#c79bff", "#4cc9dd", "#e09a78", "#ff8ac4", "#c3d24a"),
)
THEMES = {"light": LIGHT, "dark": DARK}


def theme_named(name: str) -> Theme:
    """Returns the theme of a name. Raises InputError if it is unknown."""
    if name not in THEMES:
        raise InputError(f'theme "{name:.40}" is unknown; expected {" or ".join(THEMES)}')
    return THEMES[name]


def colours_of_wavelengths(wavelengths_nm: Sequence[float], theme: Theme) -> list[str]:
    """Returns ray colours for wavelengths: close to their visual colours if these are all distinct, otherwise in
    sequence."""
    bands = (440, 490, 570, 600)  # nm, between violet, cyan, green, orange and pink
    band_colours = (2, 3, 1, 0, 5)  # indices in Theme.rays
    visual = [theme.rays[band_colours[bisect.bisect(bands, wavelength)]] for wavelength in wavelengths_nm]
    if len(set(visual)) == len(visual):
        return visual
    return [theme.rays[i % len(theme.rays)] for i in range(len(wavelengths_nm))]
