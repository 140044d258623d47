"""Draws the picture of docs/psf.md: point spread functions of the double Gauss at f/2 and f/8, with and without
diffraction."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import matplotlib.figure
import numpy as np
import realcam as rc

WIDTH_UM = 100.0  # of each panel on the film
SAMPLES = 320  # across each panel


def save_plot(path: Path) -> None:
    """Plots each point spread function on a logarithmic scale relative to its peak."""
    figure = matplotlib.figure.Figure(figsize=(10, 10.2), layout="constrained")
    panels = figure.subplots(3, 3, squeeze=False)
    wide_open = rc.Lens.load("double-gauss-50mm")
    rows = [("f/2", wide_open), ("f/8", wide_open.stopped_down(8))]
    rows.append(("f/8, 7 blades", wide_open.with_iris(7).stopped_down(8)))
    for row_panels, (name, lens) in zip(panels, rows, strict=True):
        columns = [(0.0, "direct"), (15.0, "direct"), (15.0, "geometric")]
        for panel, (field, method) in zip(row_panels, columns, strict=True):
            psf = lens.psf(
                field,
                object_distance_m=math.inf,
                method=method,
                size=SAMPLES,
                pitch_um=WIDTH_UM / SAMPLES,
                centre="centroid",
            )
            decades = np.log10(np.maximum(psf.values / psf.values.max(), 1e-6))
            edge = WIDTH_UM / 2
            image = panel.imshow(
                decades, extent=(-edge, edge, -edge, edge), origin="lower", cmap="inferno", vmin=-5, vmax=0
            )
            detail = "geometric" if method == "geometric" else f"Strehl {psf.strehl:.2g}"
            panel.set_title(f"{name}, {field:.0f}°, {detail}", fontsize=10)
    for panel in panels[:, 0]:
        panel.set_ylabel("y / um")
    for panel in panels[-1]:
        panel.set_xlabel("x / um")
    figure.colorbar(image, ax=panels, shrink=0.4, label="log10 of the largest value")
    figure.savefig(path, dpi=72)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/psf_plot.py PICTURE")
    save_plot(Path(sys.argv[1]))
