"""Annotations of a section: pupils and planes, focus group, overlapping faces."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from matplotlib.axes import Axes

from ..section.marks import Mark
from ..section.section import CrossSection
from .style import Style


def draw_marks(section: CrossSection, axes: Axes, style: Style, shift: float) -> None:
    """Draws pupils, principal planes and focal points; those outside of the axes are listed as text.

    shift: is added to z, mm, also in the functions below.
    """
    theme = style.theme
    low, high = axes.get_xlim()
    shown = [mark for mark in section.marks if low <= mark.z_mm + shift <= high]
    outside = [mark for mark in section.marks if mark not in shown]
    tall = 1.06 * max(face.parts[-1][-1, 1] for face in section.faces)
    positions = []
    for mark in shown:
        z = mark.z_mm + shift
        if mark.kind == "pupil":
            axes.plot([z] * 2, [-mark.semi_diameter_mm, mark.semi_diameter_mm], color=theme.text, linewidth=1,
                      linestyle=(0, (4, 2)), zorder=6, marker="_", markersize=7)  # fmt: skip
            positions.append((z, mark.semi_diameter_mm, 4))
        elif mark.kind == "principal plane":
            axes.plot([z] * 2, [-tall, tall], color=theme.text, linewidth=0.9, linestyle=(0, (6, 2, 1, 2)), zorder=6)
            positions.append((z, -tall, -3))
        else:
            axes.plot([z], [0], "o", color=theme.text, markersize=4, zorder=6)
            positions.append((z, 0, -5))
    for mark, position, side in zip(shown, positions, _sides(axes, style, positions), strict=True):
        _label(axes, mark, *position, side, style)
    if outside:
        text = "outside: " + ", ".join(f"{mark.label} at {mark.z_mm:.4g} mm" for mark in outside)
        axes.text(0.01, 0.01, text, transform=axes.transAxes, fontsize=0.85 * style.font_pt, color=theme.text, zorder=7)


def _sides(axes: Axes, style: Style, positions: list[tuple[float, float, int]]) -> list[str]:
    """Returns the horizontal alignment of labels: of two that would overlap, one is left and the other right of its
    mark.

    positions: (z, y, vertical offset of the label in points) of each mark.
    """
    axes.apply_aspect()  # changes the axes' limits, on which the positions depend
    figure = axes.get_figure()
    assert figure is not None
    points = (
        72 / figure.dpi * axes.transData.transform(np.array([position[:2] for position in positions]).reshape(-1, 2))
    )
    sides = ["center"] * len(positions)
    for i, j in combinations(range(len(positions)), 2):
        z, y = points[j] - points[i]
        if positions[i][2] == positions[j][2] and abs(z) < 2.2 * style.font_pt and abs(y) < 1.4 * style.font_pt:
            sides[i], sides[j] = ("right", "left") if z >= 0 else ("left", "right")
    return sides


def _label(axes: Axes, mark: Mark, z: float, y: float, points_up: float, side: str, style: Style) -> None:
    axes.annotate(
        mark.label, (z, y), ({"left": 2, "right": -2}.get(side, 0), points_up), textcoords="offset points", ha=side,
        va="bottom" if points_up > 0 else "top", fontsize=style.font_pt, color=style.theme.text, zorder=7,
        bbox={"facecolor": style.theme.page, "edgecolor": "none", "alpha": 0.7, "pad": 0.5},
    )  # fmt: skip


def draw_focus_group(section: CrossSection, axes: Axes, style: Style, shift: float) -> None:
    """Draws a bracket above the focus group, with its travel."""
    group = section.focus_group
    if group is None:
        return
    inside = [p for face in section.faces if group.first <= face.surface <= group.last for p in face.parts]
    if not inside:
        return
    points = np.concatenate(inside)
    z_low, z_high = points[:, 0].min() + shift, points[:, 0].max() + shift
    # Above all faces and pupils, so that nothing lies behind the text.
    tops = [float(face.parts[-1][:, 1].max()) for face in section.faces]
    tallest = max(tops + [mark.semi_diameter_mm for mark in section.marks if style.marks])
    base = 1.04 * tallest + (0.12 * tallest if style.marks else 0)
    top = base + 0.06 * tallest
    colour = style.theme.text
    axes.plot([z_low, z_low, z_high, z_high], [base, top, top, base], color=colour, linewidth=1, zorder=6)
    for z in (z_low, z_high):
        axes.plot([z, z], [points[:, 1].max(), base], color=style.theme.faint, linewidth=0.6, zorder=1)
    text = "focus group"
    if group.travel_mm is not None:
        arrow = "→" if group.travel_mm > 0 else "←"
        text += f" {arrow} {abs(group.travel_mm):.3g} mm to {group.nearest_focus_m:.3g} m"
    axes.annotate(text, (0.5 * (z_low + z_high), top), (0, 2), textcoords="offset points", ha="center", va="bottom",
                  fontsize=0.85 * style.font_pt, color=colour, zorder=6)  # fmt: skip


def draw_overlaps(section: CrossSection, axes: Axes, style: Style, shift: float) -> None:
    """Draws the overlaps of faces in the colour of errors, and describes them as text."""
    colour = style.theme.error
    lines = []
    for overlap in section.overlaps:
        for zone in overlap.zones:
            axes.fill(
                zone[:, 0] + shift, zone[:, 1], facecolor=colour, edgecolor=colour, linewidth=1.2, alpha=0.75, zorder=8
            )
        lines.append(
            f"error: surfaces {overlap.first + 1} and {overlap.second + 1} cross, by {overlap.depth_mm:.3g} mm at "
            f"{overlap.radius_mm:.3g} mm from the axis"
        )
    if lines:
        axes.text(0.01, 0.99, "\n".join(lines), transform=axes.transAxes, ha="left", va="top", color=colour,
                  fontsize=style.font_pt, zorder=9)  # fmt: skip
