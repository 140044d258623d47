"""The exit pupil seen from film points: its outline in direction cosines, and relative illumination."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import Lens
from ..short_text import ShortText
from . import style
from .fields import Bundles, Doubles, bundles_of, fields_of


@dataclass(frozen=True, repr=False)
class FilmPupils(ShortText):
    """Vignetted pupils of the film points of F chief rays.

    fields_deg: (F,); film_mm: (F,), heights of the points.
    outlines: F arrays (M, 2, 2), segments of the pupil's outline, in direction cosines x and y of light travelling to
      the film.
    solid_angle_sr: (F,), projected solid angle: area in direction cosines. The illuminance from a uniform field of
      luminance L, which exposes pictures, is L times this.
    relative_illumination: (F,), relative to the axis.
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
    """Pupils by real rays from the film to the scene: their edges along radial scan lines about the pupil's centre.

    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    Other defaults: `samples` fields from the axis to the film's corner; the design wavelength. Coatings are ignored.
    """
    source = bundles_of(lens, object_distance_m, bundles)
    nm = lens.wavelength_nm if wavelength_nm is None else wavelength_nm
    fields = fields_of(lens, fields_deg, samples, source)
    points = np.array([source.at(float(field), nm).chief_ray_mm for field in fields])
    pupils = [lens.film_pupil((x, y), nm) for x, y in points]
    light = np.array([pupil.irradiance for pupil in pupils])
    on_axis = lens.film_pupil((0.0, 0.0), nm).irradiance
    return FilmPupils(fields, points[:, 1], tuple(pupil.outline for pupil in pupils), light, light / on_axis)


def plot_relative_illumination(data: FilmPupils, axes: Axes) -> None:
    """Plots relative illumination over the field, with the cos^4 law for comparison."""
    axes.plot(data.fields_deg, 100 * data.relative_illumination, color=style.BLUE, label="lens")
    low, high = style.field_limits(data.fields_deg)
    angle_deg = np.linspace(max(low, -90.0), min(high, 90.0), 61)
    axes.plot(angle_deg, 100 * np.cos(np.radians(angle_deg)) ** 4, ":", color=style.GREY, label="cos⁴")
    axes.set_xlim(low, high)
    axes.set_ylim(0, max(105.0, 103 * float(data.relative_illumination.max())))
    axes.set_xlabel("field / °")
    axes.set_ylabel("relative illumination / %")
    axes.set_title("Relative illumination")
    axes.legend(loc="best")


def plot_pupil_shapes(data: FilmPupils, axes: Axes) -> None:
    """Plots the outlines side by side at one scale, as the shapes of defocused lamps."""
    from matplotlib.collections import LineCollection

    boxes = [(o.reshape(-1, 2).min(axis=0), o.reshape(-1, 2).max(axis=0)) for o in data.outlines]
    widest = max(float((high - low).max()) for low, high in boxes)
    for k, (outline, (low, high)) in enumerate(zip(data.outlines, boxes, strict=True)):
        offset = np.array([1.15 * widest * k, 0.0]) - 0.5 * (low + high)
        axes.add_collection(
            LineCollection(list(outline + offset), colors=style.field_colour(k), linewidths=1.2, capstyle="round")
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
