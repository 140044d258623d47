"""The pupil as points of the film see it: its outline in direction cosines, and the light that it sends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import Lens, RayStatus
from ..short_text import ShortText
from . import style
from .fields import Bundles, Doubles, bundles_of, fields_of

SPOKES, STEPS, HALVINGS = 96, 26, 26


@dataclass(frozen=True, repr=False)
class FilmPupils(ShortText):
    """What the lens lets pass to points of the film, where the chief rays of F fields land.

    fields_deg: (F,); film_mm: (F,), heights of the points.
    outlines: F arrays (M, 2, 2), pieces of the edge of what passes, in direction cosines x and y of light on its way to
      the film.
    solid_angle_sr: (F,), area in direction cosines: the integral of the cosine over the solid angle. The illuminance
      of an even field of luminance L is L times that: what pictures are exposed by.
    relative_illumination: (F,), over that on the axis.
    """

    fields_deg: Doubles
    film_mm: Doubles
    outlines: tuple[Doubles, ...]
    solid_angle_sr: Doubles
    relative_illumination: Doubles


def film_pupils(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    *,
    wavelength_nm: float | None = None,
    samples: int = 31,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> FilmPupils:
    """By real rays from the film to the scene: the edges of what passes, along spokes about its middle.

    None: `samples` fields up to the corner of the film; the design wavelength. Coatings take no part.
    """
    source = bundles_of(lens, object_distance_m, bundles)
    nm = lens.wavelength_nm if wavelength_nm is None else wavelength_nm
    fields = fields_of(lens, fields_deg, samples, source)
    # The axis comes along, for what the others are relative to.
    light = [source.at(float(field), nm) for field in (0.0, *fields)]
    heights = np.array([b.chief_ray_mm[1] for b in light])
    cosines = [b.directions[:, :2] for b in light]
    low, high = (np.array([f(c, axis=0) for c in cosines]) for f in (np.min, np.max))
    middle, reach = 0.5 * (low + high), 0.5 * (high - low)
    angle = 2 * np.pi * (np.arange(SPOKES) + 0.5) / SPOKES
    unit = np.column_stack([np.cos(angle), np.sin(angle)])
    steps = np.linspace(0, 1.75, STEPS)

    def passes(point: np.ndarray, spoke: np.ndarray, radius: Doubles) -> np.ndarray:
        cosine = middle[point] + radius[:, None] * unit[spoke] * reach[point]
        square = (cosine**2).sum(axis=1)
        way_z = np.sqrt(np.maximum(1 - square, 0.0))
        origins = np.column_stack([0 * radius, heights[point], np.full(len(radius), lens.film_position_mm)])
        # Backwards: the light that comes with these cosines.
        out = lens.trace(origins, -np.column_stack([cosine, np.maximum(way_z, 1e-9)]), wavelength_nm=nm, start="film")
        passed: np.ndarray = (out.status == RayStatus.OK) & (square < 1)
        return passed

    point, spoke, step = (a.ravel() for a in np.indices((len(light), SPOKES, STEPS)))
    open_ = passes(point, spoke, steps[step]).reshape(len(light), SPOKES, STEPS)
    at_point, at_spoke, at_step = np.nonzero(open_[:, :, 1:] != open_[:, :, :-1])
    begins = open_[at_point, at_spoke, at_step + 1]
    inner, outer = steps[at_step], steps[at_step + 1]
    for _ in range(HALVINGS):
        half = 0.5 * (inner + outer)
        like_outer = passes(at_point, at_spoke, half) == begins
        inner, outer = np.where(like_outer, inner, half), np.where(like_outer, half, outer)
    edge = 0.5 * (inner + outer)
    signed = np.where(begins, -1.0, 1.0) * edge**2
    sums = np.bincount(at_point, weights=signed, minlength=len(light))
    area = sums * np.pi / SPOKES * reach[:, 0] * reach[:, 1]
    outlines = tuple(
        _outline(edge[at_point == k], begins[at_point == k], at_spoke[at_point == k], middle[k], unit * reach[k])
        for k in range(1, len(light))
    )
    return FilmPupils(fields, heights[1:], outlines, area[1:], area[1:] / area[0])


def _outline(edge: Doubles, begins: np.ndarray, spoke: np.ndarray, middle: Doubles, ways: Doubles) -> Doubles:
    """Pieces between the edges of neighbouring spokes that follow each other on them in the same way; where the light
    ends between two spokes, along the lit one."""
    by_spoke = [
        [(float(r), bool(b)) for r, b in zip(edge[spoke == s], begins[spoke == s], strict=True)]
        for s in range(len(ways))
    ]
    stretches = []
    for edges in by_spoke:
        ends = edges if not edges or edges[0][1] else [(0.0, True), *edges]
        stretches.append([(ends[i][0], ends[i + 1][0]) for i in range(0, len(ends) - 1, 2)])
    pieces = []
    for s, here in enumerate(stretches):
        t = (s + 1) % len(stretches)
        for i in range(max(len(here), len(stretches[t]))):
            if i < len(here) and i < len(stretches[t]):
                for end in (0, 1):
                    if here[i][end] or stretches[t][i][end]:
                        pieces.append((middle + here[i][end] * ways[s], middle + stretches[t][i][end] * ways[t]))
            else:
                lit, (a, b) = (s, here[i]) if i < len(here) else (t, stretches[t][i])
                pieces.append((middle + a * ways[lit], middle + b * ways[lit]))
    return np.array(pieces).reshape(-1, 2, 2)


def plot_relative_illumination(data: FilmPupils, axes: Axes) -> None:
    """Over the field, beside the fourth power of the field's cosine."""
    axes.plot(data.fields_deg, 100 * data.relative_illumination, color=style.BLUE, label="lens")
    angle = np.radians(np.linspace(0, min(float(data.fields_deg.max()), 90.0), 61))
    axes.plot(np.degrees(angle), 100 * np.cos(angle) ** 4, ":", color=style.GREY, label="cos⁴")
    axes.set_xlim(0, max(float(data.fields_deg.max()), 1e-9))
    axes.set_ylim(0, max(105.0, 103 * float(data.relative_illumination.max())))
    axes.set_xlabel("field / °")
    axes.set_ylabel("relative illumination / %")
    axes.set_title("Relative illumination")
    axes.legend(loc="best")


def plot_pupil_shapes(data: FilmPupils, axes: Axes) -> None:
    """Outlines side by side, to one scale, as a lamp far out of focus shows them."""
    from matplotlib.collections import LineCollection

    boxes = [(o.reshape(-1, 2).min(axis=0), o.reshape(-1, 2).max(axis=0)) for o in data.outlines]
    widest = max(float((high - low).max()) for low, high in boxes)
    for k, (outline, (low, high)) in enumerate(zip(data.outlines, boxes, strict=True)):
        away = np.array([1.15 * widest * k, 0.0]) - 0.5 * (low + high)
        axes.add_collection(
            LineCollection(list(outline + away), colors=style.field_colour(k), linewidths=1.2, capstyle="round")
        )
        axes.annotate(f"{data.fields_deg[k]:.3g}°", (1.15 * widest * k, -0.62 * widest), ha="center", va="top")
    axes.set_xlim(-0.65 * widest, (1.15 * len(boxes) - 0.5) * widest)
    axes.set_ylim(-0.85 * widest, 0.6 * widest)
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.set_xticks([])
    axes.set_xlabel("side by side, at the scale of direction cosine y")
    axes.set_ylabel("direction cosine y")
    axes.set_title("Pupil seen from the film")
