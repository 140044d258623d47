"""Drawing of a cross-section on matplotlib axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from ..section.cut import Points
from ..section.outlines import Element, Face
from ..section.section import CrossSection
from .notes import draw_focus_group, draw_marks, draw_overlaps
from .style import Style, ray_colour
from .themes import Theme


@dataclass(frozen=True)
class Extent:
    """Bounds of a drawing, mm."""

    z_low: float
    z_high: float
    y_low: float
    y_high: float

    @property
    def width(self) -> float:
        return self.z_high - self.z_low

    @property
    def height(self) -> float:
        return self.y_high - self.y_low


def extent_of(section: CrossSection, style: Style) -> Extent:
    """Returns the bounds of a section's drawing, with a margin."""
    points: list[Points] = [polygon for element in section.elements for polygon in element.polygons]
    points += [part for face in section.faces for part in face.parts]
    points += [line for blocker in section.blockers for line in blocker.lines]
    points += [section.drawn(bundle.paths_mm).reshape(-1, 2) for bundle in section.bundles]
    points.append(section.film)
    all_points = np.concatenate(points)
    (z_low, y_low), (z_high, y_high) = all_points.min(axis=0), all_points.max(axis=0)
    if style.marks:
        # Marks that are farther away are listed as text (draw_marks).
        reach = 0.25 * (z_high - z_low)
        near = [mark for mark in section.marks if z_low - reach < mark.z_mm < z_high + reach]
        z_low = min([z_low, *(mark.z_mm for mark in near)])
        z_high = max([z_high, *(mark.z_mm for mark in near)])
        y_high = max([y_high, *(mark.semi_diameter_mm for mark in near)])
        y_low = min([y_low, *(-mark.semi_diameter_mm for mark in near)])
    margin = 0.04 * max(z_high - z_low, y_high - y_low)
    above = 3.2 * margin if section.focus_group else margin
    below = 2.6 * margin if style.marks else margin  # for labels of principal planes, and the text of marks outside
    return Extent(z_low - margin, z_high + margin, y_low - below, y_high + above)


def draw_section(
    section: CrossSection, axes: Axes, style: Style, *, shift_mm: float = 0.0, ghost: CrossSection | None = None
) -> None:
    """Draws a section on axes with equal scales; `shift_mm` is added to z.

    ghost: another state of the lens, drawn as outlines where it differs. The films of both states coincide, as in a
    camera.
    """
    theme = style.theme
    colours = {face.surface: _colour_of(face, style) for face in section.faces}
    for element in section.elements:
        for polygon in element.polygons:
            axes.fill(
                *_shifted(polygon, shift_mm), facecolor=theme.glass, edgecolor=theme.edge, linewidth=0.7, zorder=2
            )
    for face in section.faces:
        for part in face.parts:
            width = 2.2 if face.is_mirror else 1.4 if style.radius_colours else 0.9
            axes.plot(*_shifted(part, shift_mm), color=colours[face.surface], linewidth=width, zorder=3)
        if face.is_asphere:
            z, y = face.parts[-1][-1]
            axes.annotate(
                "*", (z + shift_mm, y), (0, 0), textcoords="offset points", color=colours[face.surface],
                fontsize=style.font_pt, ha="center", va="bottom", zorder=6,
            )  # fmt: skip
    if ghost is not None:
        _draw_ghost(section, ghost, axes, theme, shift_mm)
    _draw_blockers(section, axes, theme, shift_mm)
    _draw_rays(section, axes, theme, shift_mm)
    axes.plot(*_shifted(section.film, shift_mm), color=theme.text, linewidth=2, zorder=4)
    if style.marks:
        draw_marks(section, axes, style, shift_mm)
    draw_focus_group(section, axes, style, shift_mm)
    draw_overlaps(section, axes, style, shift_mm)


def prepare_axes(axes: Axes, extent: Extent, style: Style, plane: str = "yz", z_label: str = "z / mm") -> None:
    """Sets limits, labels and colours of axes."""
    theme = style.theme
    axes.set_xlim(extent.z_low, extent.z_high)
    axes.set_ylim(extent.y_low, extent.y_high)
    axes.set_aspect("equal")
    axes.set_facecolor("none")
    axes.set_xlabel(z_label, color=theme.text, fontsize=style.font_pt)
    axes.set_ylabel(f"{plane[0]} / mm", color=theme.text, fontsize=style.font_pt)
    axes.tick_params(colors=theme.text, labelsize=style.font_pt)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(theme.text)


def _shifted(points: Points, shift: float) -> tuple[Points, Points]:
    """Returns z + shift and y of points (N, 2)."""
    return points[:, 0] + shift, points[:, 1]


def _colour_of(face: Face, style: Style) -> str:
    theme = style.theme
    if style.radius_colours:
        return {1: theme.positive, -1: theme.negative, 0: theme.plane}[face.radius_sign]
    return theme.text if face.is_mirror else theme.edge


def _draw_ghost(section: CrossSection, ghost: CrossSection, axes: Axes, theme: Theme, shift: float) -> None:
    """Draws the outlines of those elements of another state that have moved relative to the film."""
    to_film = section.film_z_mm - ghost.film_z_mm
    elements = {(e.front, e.back): e for e in section.elements}
    for element in ghost.elements:
        if not _has_moved(element, elements.get((element.front, element.back)), to_film):
            continue
        for polygon in element.polygons:
            axes.fill(*_shifted(polygon, to_film + shift), fill=False, edgecolor=theme.faint, linewidth=0.9,
                      linestyle=(0, (3, 2)), zorder=3.5)  # fmt: skip


def _has_moved(element: Element, other: Element | None, shift: float) -> bool:
    """Returns True if an element shifted along z differs from the other one, or there is no other one."""
    if other is None:
        return True
    return any(
        a.shape != b.shape or not np.allclose(a + np.array([shift, 0.0]), b, rtol=0, atol=1e-6)
        for a, b in zip(element.polygons, other.polygons, strict=True)
    )


def _draw_blockers(section: CrossSection, axes: Axes, theme: Theme, shift: float) -> None:
    for blocker in section.blockers:
        opening_lines = len(blocker.lines) - (blocker.obstruction_mm > 0)  # those around the opening come first
        for k, line in enumerate(blocker.lines):
            is_stop = blocker.is_stop and k < opening_lines
            width, colour = (2.4, theme.text) if is_stop else (1.6, theme.faint)
            axes.plot(*_shifted(line, shift), color=colour, linewidth=width, solid_capstyle="butt", zorder=4)


def _draw_rays(section: CrossSection, axes: Axes, theme: Theme, shift: float) -> None:
    for bundle in section.bundles:
        colour = ray_colour(section, bundle, theme)
        for path in section.drawn_paths(bundle):
            axes.plot(*_shifted(path, shift), color=colour, linewidth=0.7, zorder=5, alpha=0.85, gid="ray")
