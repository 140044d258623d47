"""Third-order (Seidel) aberrations by surface, with a bar chart."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from .._core import Lens
from ..short_text import ShortText
from . import style
from .fields import Bundles, Doubles, bundles_of, field_angles_deg

NAMES = ("spherical", "coma", "astigmatism", "Petzval", "distortion", "axial colour", "lateral colour")


@dataclass(frozen=True, repr=False)
class SeidelBars(ShortText):
    """Third-order aberrations of S surfaces at a field.

    names: of the 7 aberrations. surfaces: (S,), their indices in `lens.surfaces`, from 0.
    sums_mm: (S, 7), surface contributions to the Seidel sums S_I to S_V and the chromatic sums C_I and C_II.
    waves: (S, 7), wavefront coefficients at the edge of pupil and field: S_I / 8, S_II / 2, S_III / 2,
      S_IV / 4, S_V / 2, C_I / 2, C_II over the wavelength.
    """

    field_deg: float
    names: tuple[str, ...]
    surfaces: np.ndarray
    sums_mm: Doubles
    waves: Doubles


def seidel_bars(
    lens: Lens,
    field_deg: float | None = None,
    *,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> SeidelBars:
    """Computes Seidel sums.

    field_deg: None is the film's corner, but at most 60 degrees.
    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    """
    source = bundles_of(lens, object_distance_m, bundles)
    field = min(float(field_angles_deg(lens, 1.0, source)[0]), 60.0) if field_deg is None else field_deg
    table = lens.seidel(field, object_distance_m=source.object_distance_m)
    sums = np.column_stack([table.seidel_mm, table.colour_mm])
    to_wavefront = np.array([1 / 8, 1 / 2, 1 / 2, 1 / 4, 1 / 2, 1 / 2, 1])
    return SeidelBars(field, NAMES, np.arange(len(sums)), sums, 1e6 / table.wavelength_nm * to_wavefront * sums)


#: Symbols of the columns of SeidelBars.sums_mm.
SYMBOLS = ("S_I", "S_II", "S_III", "S_IV", "S_V", "C_I", "C_II")


def seidel_table(data: SeidelBars) -> list[tuple[str, ...]]:
    """Seidel sums in µm as text: a row of seven for each surface, and a last row with the sums over all surfaces."""
    rows = np.concatenate([data.sums_mm, data.sums_mm.sum(axis=0)[None]])
    # The same number of decimals for all, so that columns can be compared at a glance.
    digits = int(np.clip(4 - math.floor(math.log10(max(1e3 * float(np.abs(rows).max()), 1e-3))), 0, 4))
    return [tuple(f"{round(1e3 * value, digits) + 0.0:.{digits}f}" for value in row) for row in rows]


def plot_seidel_bars(data: SeidelBars, axes: Axes) -> None:
    """Plots bars grouped by surface, numbered from 1 as in lens tables and files, and their sum."""
    width = 0.8 / len(data.names)
    positions = np.arange(len(data.surfaces) + 1)
    values = np.concatenate([data.waves, data.waves.sum(axis=0)[None]])
    for k, name in enumerate(data.names):
        offset = (k - 0.5 * (len(data.names) - 1)) * width
        axes.bar(positions + offset, values[:, k], width, color=style.field_colour(k), label=name, linewidth=0)
    style.zero_lines(axes, x=False)
    axes.axvline(len(data.surfaces) - 0.5, color=style.GREY, linewidth=0.6)
    axes.set_xticks(positions, [*map(str, data.surfaces + 1), "sum"])
    axes.set_xlabel("surface")
    axes.set_ylabel("wavefront / waves")
    axes.set_title(f"Third order at {data.field_deg:.3g}°")
    axes.grid(visible=False, axis="x")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), ncols=4, columnspacing=1.0)
