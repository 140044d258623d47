"""Insets of a drawing: the rays of one field near the film, magnified."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from ..fields import Field
from ..section.section import CrossSection
from .style import Style, ray_colour

_STEPS = (1, 2, 5)  # mantissas of magnifications and of lengths of scale bars


def shown_in_insets(section: CrossSection) -> list[Field]:
    """Returns the fields with an inset, sorted by height on the film: at most four of those with rays."""
    with_rays = [f for f in section.fields if any(len(b.paths_mm) for b in section.bundles if b.field == f)]
    with_rays.sort(key=lambda field: field.film_height_mm)
    if len(with_rays) <= 4:
        return with_rays
    return [with_rays[i] for i in np.linspace(0, len(with_rays) - 1, 4).round().astype(int)]


def letter_of(section: CrossSection, field: Field) -> str:
    """Returns the letter that denotes a field in a drawing: "a" for the first one."""
    return chr(ord("a") + section.fields.index(field) % 26)


def draw_inset(axes: Axes, section: CrossSection, field: Field, style: Style, inches_per_mm: float) -> float:
    """Draws the rays of one field near the film; returns the magnification relative to the drawing.

    inches_per_mm: scale of the drawing. The magnification is the largest of 1, 2, 5, 10 ... at which the spot fills no
    more than two thirds of the height.
    """
    theme = style.theme
    bundles = [bundle for bundle in section.bundles if bundle.field == field and len(bundle.paths_mm)]
    heights = np.concatenate([section.drawn(bundle.paths_mm)[:, -1, 1] for bundle in bundles])
    centre, size = 0.5 * (heights.min() + heights.max()), float(np.ptp(heights))
    box = axes.get_window_extent()
    width, height = box.width / axes.figure.dpi, box.height / axes.figure.dpi
    magnification = _rounded_down(2 / 3 * height / (inches_per_mm * max(size, 1e-9)))
    magnification = min(max(magnification, 1.0), 1e5)
    half_z, half_y = (0.5 * inches / (inches_per_mm * magnification) for inches in (width, height))
    for bundle in bundles:
        z_part, y_part = section.drawn(bundle.directions_at_film).T
        film_heights = section.drawn(bundle.paths_mm)[:, -1, 1]
        for y, slope in zip(film_heights - centre, y_part / z_part, strict=True):
            # Clipped to the frame here, because not every SVG viewer clips.
            z = np.clip((np.array([-half_y, half_y]) - y) / slope, -half_z, half_z) if slope else [-half_z, half_z]
            axes.plot(z, y + slope * np.asarray(z), color=ray_colour(section, bundle, theme), linewidth=0.7)
    axes.axvline(0, color=theme.text, linewidth=1.5)
    bar = _rounded_down(0.8 * half_z)
    y_bar = -0.86 * half_y
    axes.plot([0.9 * half_z - bar, 0.9 * half_z], [y_bar] * 2, color=theme.text, linewidth=2, solid_capstyle="butt")
    small = 0.85 * style.font_pt
    halo = {"facecolor": theme.page, "edgecolor": "none", "alpha": 0.75, "pad": 1.0}
    axes.text(0.9 * half_z, y_bar + 0.06 * half_y, _length(bar), ha="right", va="bottom", fontsize=small,
              color=theme.text, bbox=halo)  # fmt: skip
    axes.text(-0.94 * half_z, -0.92 * half_y, f"× {magnification:g}", ha="left", va="bottom", fontsize=small,
              color=theme.text, bbox=halo)  # fmt: skip
    colour = ray_colour(section, bundles[0], theme) if len(section.wavelengths_nm) == 1 else theme.text
    axes.set_title(
        f"{letter_of(section, field)}: {field.angle_deg:.3g}°, {field.film_height_mm:.3g} mm",
        fontsize=small,
        color=colour,
        pad=3,
    )
    axes.set_xlim(-half_z, half_z)
    axes.set_ylim(-half_y, half_y)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_facecolor("none")
    for spine in axes.spines.values():
        spine.set_color(theme.faint)
    return magnification


def _rounded_down(value: float) -> float:
    """Rounds down to 1, 2 or 5 times a power of ten."""
    power = math.floor(math.log10(value))
    return float(max(step for step in _STEPS if step * 10.0**power <= value * (1 + 1e-12)) * 10.0**power)


def _length(mm: float) -> str:
    return f"{mm:g} mm" if mm >= 0.1 else f"{1000 * mm:g} µm"
