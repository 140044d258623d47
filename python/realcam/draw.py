"""Drawings of lenses, with matplotlib. What they show, as arrays: realcam.drawing."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ._core import InputError, Lens
from .drawing.draw import draw_section, extent_of, prepare_axes
from .drawing.figure import Row, figure_of
from .drawing.section import CrossSection, cross_section
from .drawing.style import Style
from .drawing.themes import theme_named
from .figure_files import check_figure_target, save_figure

__all__ = ["draw_cross_section", "draw_states", "lens_figure", "save_cross_section", "save_states", "states_of"]


def lens_figure(
    lens: Lens,
    rays: int = 7,
    *,
    rays_from: str = "object",
    fields: Sequence[float] = (0.0, 0.7, 1.0),
    fields_deg: Sequence[float] | None = None,
    wavelengths_nm: Sequence[float] | None = None,
    object_distance_m: float | None = None,
    radius_colours: bool = False,
    marks: bool = False,
    insets: bool = True,
    ghost: Lens | None = None,
    theme: str = "light",
    width_px: int = 1600,
) -> Figure:
    """The meridional section of a lens; the film is on the right.

    rays, rays_from, fields, fields_deg, wavelengths_nm, object_distance_m: as realcam.drawing.cross_section takes them.
    radius_colours: faces in blue where the radius of curvature is positive, in red where it is negative.
    marks: entrance and exit pupil (EP, XP), principal planes (H, H'), focal points (F, F').
    insets: the rays of each field where they meet the film, magnified.
    ghost: the lens in another state, of which the glass that stands elsewhere is drawn as outlines.
    theme: "light" or "dark". width_px: of the picture.
    Raises InputError where no light passes the lens or what is asked makes no sense.
    """
    style = Style(theme_named(theme), radius_colours, marks)
    section = cross_section(
        lens,
        rays=rays,
        rays_from=rays_from,
        fields=fields,
        fields_deg=fields_deg,
        wavelengths_nm=wavelengths_nm,
        object_distance_m=object_distance_m,
    )
    other = None if ghost is None else cross_section(ghost, rays=0)
    row = Row(lens.title or lens.name, _data_of(lens, section), section, other)
    # Rays that were sent from one point of the film meet in it, whatever the lens does.
    return figure_of([row], style, width_px=width_px, insets=insets and rays_from == "object")


def save_cross_section(
    lens: Lens,
    path: str | os.PathLike[str],
    rays: int = 7,
    *,
    rays_from: str = "object",
    fields: Sequence[float] = (0.0, 0.7, 1.0),
    fields_deg: Sequence[float] | None = None,
    wavelengths_nm: Sequence[float] | None = None,
    object_distance_m: float | None = None,
    radius_colours: bool = False,
    marks: bool = False,
    insets: bool = True,
    ghost: Lens | None = None,
    theme: str = "light",
    width_px: int = 1600,
) -> None:
    """Writes lens_figure as .svg, .png or .pdf. Raises ImageFileError and InputError."""
    target = check_figure_target(path)
    figure = lens_figure(
        lens,
        rays,
        rays_from=rays_from,
        fields=fields,
        fields_deg=fields_deg,
        wavelengths_nm=wavelengths_nm,
        object_distance_m=object_distance_m,
        radius_colours=radius_colours,
        marks=marks,
        insets=insets,
        ghost=ghost,
        theme=theme,
        width_px=width_px,
    )
    save_figure(figure, target, dpi=width_px / figure.get_figwidth())


def draw_cross_section(
    lens: Lens,
    axes: Axes,
    rays: int = 7,
    *,
    rays_from: str = "object",
    fields: Sequence[float] = (0.0, 0.7, 1.0),
    fields_deg: Sequence[float] | None = None,
    wavelengths_nm: Sequence[float] | None = None,
    object_distance_m: float | None = None,
    radius_colours: bool = False,
    marks: bool = False,
    ghost: Lens | None = None,
    theme: str = "light",
) -> CrossSection:
    """Draws a cross-section on axes of one's own, without insets, and returns the arrays behind it."""
    style = Style(theme_named(theme), radius_colours, marks)
    section = cross_section(
        lens,
        rays=rays,
        rays_from=rays_from,
        fields=fields,
        fields_deg=fields_deg,
        wavelengths_nm=wavelengths_nm,
        object_distance_m=object_distance_m,
    )
    other = None if ghost is None else cross_section(ghost, rays=0)
    prepare_axes(axes, extent_of(section, style), style)
    draw_section(section, axes, style, ghost=other)
    # Titles are text, and a dollar sign in one begins no formula.
    title = f"{lens.title or lens.name}   {_data_of(lens, section)}"
    axes.set_title("".join(c for c in title if c.isprintable()), parse_math=False, color=style.theme.text)
    return section


def draw_states(
    states: Sequence[tuple[str, Lens]],
    *,
    rays: int = 7,
    rays_from: str = "object",
    fields: Sequence[float] = (0.0, 0.7, 1.0),
    wavelengths_nm: Sequence[float] | None = None,
    radius_colours: bool = False,
    marks: bool = False,
    insets: bool = True,
    theme: str = "light",
    width_px: int = 1600,
) -> Figure:
    """Several lenses, or states of one, in rows of one scale with their films below each other.

    states: (name, lens) pairs, as states_of gives them. Raises InputError.
    """
    if not states:
        raise InputError("there is no lens to draw")
    style = Style(theme_named(theme), radius_colours, marks)
    rows = []
    for name, lens in states:
        section = cross_section(lens, rays=rays, rays_from=rays_from, fields=fields, wavelengths_nm=wavelengths_nm)
        rows.append(Row(name, _data_of(lens, section), section))
    return figure_of(rows, style, width_px=width_px, insets=insets and rays_from == "object", align="film")


def save_states(
    states: Sequence[tuple[str, Lens]],
    path: str | os.PathLike[str],
    *,
    rays: int = 7,
    rays_from: str = "object",
    fields: Sequence[float] = (0.0, 0.7, 1.0),
    wavelengths_nm: Sequence[float] | None = None,
    radius_colours: bool = False,
    marks: bool = False,
    insets: bool = True,
    theme: str = "light",
    width_px: int = 1600,
) -> None:
    """Writes draw_states as .svg, .png or .pdf. Raises ImageFileError and InputError."""
    target = check_figure_target(path)
    figure = draw_states(
        states,
        rays=rays,
        rays_from=rays_from,
        fields=fields,
        wavelengths_nm=wavelengths_nm,
        radius_colours=radius_colours,
        marks=marks,
        insets=insets,
        theme=theme,
        width_px=width_px,
    )
    save_figure(figure, target, dpi=width_px / figure.get_figwidth())


def states_of(lens: Lens) -> list[tuple[str, Lens]]:
    """The zoom positions of a lens that has some; else infinity and its nearest focus, if its file names one."""
    zoom: Any = lens if hasattr(lens, "zoom_positions") else None
    if zoom is not None and zoom.zoom_positions:
        return [(f"{lens.title or lens.name}, {name}", zoom.zoomed(name)) for name in zoom.zoom_positions]
    name = lens.title or lens.name
    states = [(f"{name}, focused at infinity", lens.focused(math.inf))]
    if lens.nearest_focus_m > 0:
        states.append((f"{name}, focused at {lens.nearest_focus_m:.4g} m", lens.focused(lens.nearest_focus_m)))
    return states


def _data_of(lens: Lens, section: CrossSection) -> str:
    data = lens.first_order()
    words = [f"f = {data.effective_focal_length_mm:.4g} mm"]
    is_far = math.isinf(lens.focus_distance_m)
    # An f-number is one of the lens at infinity, and a group that has moved makes another lens.
    if is_far or lens.focus_group is None:
        words.append(f"f/{data.f_number:.3g}")
    if not is_far:
        words.append(f"focused at {lens.focus_distance_m:.4g} m")
    if len(section.wavelengths_nm) == 1:
        words.append(f"{section.wavelengths_nm[0]:.4g} nm")
    return ", ".join(words) + ("   * asphere" if any(face.is_asphere for face in section.faces) else "")
