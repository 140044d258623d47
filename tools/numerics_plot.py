"""The plot of docs/generated/numerics.md: float32 errors of each lens over field and aperture."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import matplotlib
import matplotlib.figure
import numpy as np
import realcam as rc
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.float32_error import LIMIT_UM, ImagePointErrors, image_point_errors, rays_over_film_and_pupil

COLUMNS = 5  # of panels
STOP_BANDS = 24  # cells over the height in the stop
MIN_UM = 1e-3  # lower end of the colour scale
TICKS_UM = (0.001, 0.003, 0.01, 0.03, LIMIT_UM)
OVER_LIMIT_COLOUR = "#d62728"


def save_error_plot(names: list[str], path: Path) -> int:
    """Measures each lens and draws one panel of it. Returns the number of rays."""
    columns = min(COLUMNS, len(names))
    rows = math.ceil(len(names) / columns)
    figure = matplotlib.figure.Figure(figsize=(2.4 * columns + 1, 2.5 * rows + 0.5), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel()
    for panel in panels[len(names) :]:
        panel.axis("off")
    count = 0
    for name, panel in zip(names, panels, strict=False):
        lens = rc.Lens.load(name)
        errors = image_point_errors(lens, rays_over_film_and_pupil(lens))
        count += len(errors.error_um)
        mesh = _draw(name, errors, panel)
    figure.supxlabel("film radius / mm", fontsize=10)
    figure.supylabel("height in the stop, relative to its radius", fontsize=10)
    bar = figure.colorbar(mesh, ax=panels, extend="both", ticks=TICKS_UM, aspect=40, pad=0.01)
    bar.ax.set_yticklabels([f"{tick:g}" for tick in TICKS_UM])
    bar.ax.minorticks_off()
    bar.set_label("worst error / µm (red: above the limit)")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=130)
    return count


def _draw(name: str, errors: ImagePointErrors, axes: Axes) -> QuadMesh:
    """Draws the largest error over film radius and height in the stop."""
    radii, field = np.unique(errors.film_radius_mm, return_inverse=True)
    band = np.minimum((errors.stop_height * STOP_BANDS).astype(int), STOP_BANDS - 1)
    worst = np.full((STOP_BANDS, len(radii)), -1.0)
    np.maximum.at(worst, (band, field), errors.error_um)

    half = 0.5 * (radii[1] - radii[0])
    mesh = axes.pcolormesh(
        np.append(radii - half, radii[-1] + half),
        np.linspace(0, 1, STOP_BANDS + 1),
        np.ma.masked_less(worst, 0),  # hides cells without passing rays
        norm=LogNorm(MIN_UM, LIMIT_UM),
        cmap=matplotlib.colormaps["viridis"].with_extremes(over=OVER_LIMIT_COLOUR),
    )
    axes.set_xlim(0, radii[-1])
    axes.tick_params(labelsize=8)
    largest = errors.error_um.max()
    axes.set_title(
        f"{name}\nworst {largest:.3f} µm, limit {LIMIT_UM:g} µm",
        fontsize=8.5,
        color=OVER_LIMIT_COLOUR if largest > LIMIT_UM else "black",
    )
    return mesh
