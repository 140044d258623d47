"""Cross-sections of lenses, with matplotlib."""

from __future__ import annotations

import io
import os
from pathlib import Path

import matplotlib.figure
import numpy as np
from matplotlib.axes import Axes

from . import files
from ._core import ImageFileError, InputError, Lens, RayStatus, Surface

GLASS = "#cfe3f2"
EDGE = "#27547a"
RAYS = ("#c0392b", "#27864a", "#2c5fb3")  # axis, 0.7 of the field, edge of the field


def save_cross_section(lens: Lens, path: str | os.PathLike[str], rays: int = 7) -> None:
    """Writes the meridional section of a lens as .svg or .png; the film is on the right.

    rays: how many from each of three points of the film. Raises ImageFileError.
    """
    target = Path(path)
    if target.suffix.lower() not in (".svg", ".png"):
        raise ImageFileError(f"{target}: unknown suffix; .svg or .png is wanted")
    files.check_target(target)
    figure = matplotlib.figure.Figure(figsize=(10, 6), layout="constrained")
    draw_cross_section(lens, figure.add_subplot(), rays)
    # In memory, because matplotlib takes its time: a program that is ended meanwhile leaves nothing behind.
    drawing = io.BytesIO()
    figure.savefig(drawing, format=target.suffix[1:].lower(), dpi=160)
    files.write_whole(target, drawing.getvalue())


def draw_cross_section(lens: Lens, axes: Axes, rays: int = 7) -> None:
    """Draws glass, stop, film and rays on axes that share one scale in mm."""
    _draw_glass(lens, axes)
    z = lens.vertices_mm
    for position, surface in zip(z, lens.surfaces, strict=True):
        if surface.type in ("stop", "aperture"):
            _draw_stop(axes, position, surface, lens)
        else:
            _draw_surface(axes, position, surface)
    heights = _film_heights(lens)
    span = lens.film_position_mm - min(z)
    for colour, height in zip(RAYS, heights, strict=True):
        for path in _ray_paths(lens, height, rays, reach=0.25 * span):
            axes.plot(path[:, 2], path[:, 1], color=colour, linewidth=0.7, zorder=5)
    half = 0.5 * float(np.hypot(*lens.film_mm))
    axes.plot([lens.film_position_mm] * 2, [-half, half], color="black", linewidth=2)
    data = lens.first_order()
    title = f"{lens.title or lens.name}   f = {data.effective_focal_length_mm:.4g} mm, f/{data.f_number:.3g}"
    # Titles are text, and a dollar sign in one begins no formula.
    axes.set_title("".join(c for c in title if c.isprintable()), parse_math=False)
    axes.set_xlabel("z / mm")
    axes.set_ylabel("y / mm")
    axes.set_aspect("equal")
    axes.spines[["top", "right"]].set_visible(False)


def _profile(surface: Surface, position: float, points: int = 81) -> np.ndarray:
    y = np.linspace(-surface.clear_semi_diameter_mm, surface.clear_semi_diameter_mm, points)
    return np.column_stack([position + np.array([surface.sag_mm(abs(v)) for v in y]), y])


def _draw_glass(lens: Lens, axes: Axes) -> None:
    """Fills the glass between neighbouring surfaces; the smaller one is carried out to the larger one's rim."""
    z = lens.vertices_mm
    for i, (front, back) in enumerate(zip(lens.surfaces, lens.surfaces[1:], strict=False)):
        if front.type != "refracting" or front.material.index(lens.wavelength_nm) <= 1.0001:
            continue
        rim = max(front.clear_semi_diameter_mm, back.clear_semi_diameter_mm)
        a, b = (_out_to_rim(_profile(*place), rim) for place in ((front, z[i]), (back, z[i + 1])))
        axes.fill(
            *np.concatenate([a, b[::-1]]).T,
            facecolor=GLASS,
            edgecolor=EDGE,
            linewidth=0.8,
            zorder=2,
            alpha=0.8,
        )


def _out_to_rim(profile: np.ndarray, rim: float) -> np.ndarray:
    ends = profile[[0, -1]].copy()
    ends[:, 1] = (-rim, rim)
    return np.concatenate([ends[:1], profile, ends[1:]])


def _draw_surface(axes: Axes, position: float, surface: Surface) -> None:
    profile = _profile(surface, position, 161)
    inner = surface.inner_semi_diameter_mm
    mirror = surface.type == "mirror"
    for part in (profile[profile[:, 1] >= inner], profile[profile[:, 1] <= -inner]) if inner else (profile,):
        axes.plot(
            part[:, 0],
            part[:, 1],
            color="black" if mirror else EDGE,
            linewidth=2 if mirror else 0.8,
            zorder=3,
        )


def _draw_stop(axes: Axes, position: float, surface: Surface, lens: Lens) -> None:
    rim = surface.clear_semi_diameter_mm
    opening = min(lens.stop_semi_diameter_mm, rim) if surface.type == "stop" else rim
    for side in (-1, 1):
        axes.plot([position] * 2, [side * opening, side * 1.25 * rim], color="black", linewidth=2.5, zorder=4)
    if surface.inner_semi_diameter_mm:
        inner = surface.inner_semi_diameter_mm
        axes.plot([position] * 2, [-inner, inner], color="black", linewidth=2.5, zorder=4)


def _film_heights(lens: Lens) -> list[float]:
    """Heights on the film of axis, 0.7 and full field: the corner of the film, or the edge of the image circle."""
    corner = 0.5 * float(np.hypot(*lens.film_mm))
    lit = [h for h in np.linspace(0, corner, 41) if len(_passing_angles(lens, h))]
    if not lit:
        raise InputError(f'no light passes lens "{lens.name}"')
    return [0.0, 0.7 * lit[-1], lit[-1]]


def _passing_angles(lens: Lens, height: float, count: int = 2001) -> np.ndarray:
    """Angles in the meridional plane under which rays from a film point leave the lens."""
    last = lens.surfaces[-1].clear_semi_diameter_mm
    ends = np.arctan2(np.array([-last, last]) * 1.05 - height, lens.film_distance_mm)
    angle = np.linspace(ends[0], ends[1], count)
    # A closed diaphragm may lie between two of these rays: the next ones go between the two beside its middle, until
    # there are enough that pass.
    for _ in range(4):
        passing: np.ndarray = angle[lens.trace(*_film_rays(lens, height, angle), start="film").status == RayStatus.OK]
        if len(passing) > count // 20:
            break
        around = passing if len(passing) else _beside_the_middle_of_the_stop(lens, height, angle)
        if not len(around):
            break
        step = angle[1] - angle[0]
        angle = np.linspace(around[0] - step, around[-1] + step, count)
    return passing


def _beside_the_middle_of_the_stop(lens: Lens, height: float, angle: np.ndarray) -> np.ndarray:
    """Of rays that all miss the stop's opening: the two between which its middle lies. Empty where there are none."""
    behind = len(lens.surfaces) - lens.stop_index
    out = lens.trace(*_film_rays(lens, height, angle), start="film", surface_count=behind)
    at_stop = (out.surface_index == lens.stop_index) & (out.status != RayStatus.MISSED)
    y = np.where(at_stop, out.origins_mm[:, 1], np.nan)
    crossing = np.flatnonzero(y[:-1] * y[1:] <= 0)[:1]
    return np.concatenate([angle[crossing], angle[crossing + 1]])


def _film_rays(lens: Lens, height: float, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    zero = np.zeros_like(angle)
    origins = np.column_stack([zero, zero + height, zero + lens.film_position_mm])
    return origins, np.column_stack([zero, np.sin(angle), -np.cos(angle)])


def _ray_paths(lens: Lens, height: float, count: int, reach: float) -> list[np.ndarray]:
    """Points of each ray, from the film to `reach` mm past the front surface: (surfaces + 2, 3) mm each."""
    passing = _passing_angles(lens, height)
    if not len(passing):  # the image may be lit in a ring alone
        return []
    angle = (
        np.linspace(passing[0], passing[-1], count) if count > 1 else passing[len(passing) // 2 : len(passing) // 2 + 1]
    )
    origins, directions = _film_rays(lens, height, angle)
    points = [origins]
    for surfaces in range(1, len(lens.surfaces) + 1):
        out = lens.trace(origins, directions, start="film", surface_count=surfaces)
        points.append(out.origins_mm)
    points.append(out.origins_mm + reach * out.directions)
    paths = np.stack(points, axis=1)
    return list(paths[out.status == RayStatus.OK])
