"""Draws docs/images/analysis.png: MTF over the field, field curves, pupils and spots of the double Gauss.

python tools/analysis_plot.py [FILE]
"""

from __future__ import annotations

import sys
from pathlib import Path

import realcam as rc
from realcam.analysis import style

IMAGE = Path(__file__).resolve().parents[1] / "docs" / "images" / "analysis.png"


def main(target: Path) -> None:
    """Writes the figure."""
    analysis = rc.analysis
    wide_open = rc.Lens.load("double-gauss-50mm")
    lens = wide_open.stopped_down(4)
    bundles = analysis.Bundles(lens)
    with style.themed("light", 8.0):
        figure = style.new_figure(9.5, 6.4)
        above, below = figure.subfigures(2, 1, height_ratios=[1, 1])
        left, right = above.subplots(1, 2)
        analysis.plot_mtf_over_field(analysis.mtf_over_field(lens, samples=25, bundles=bundles), left)
        analysis.plot_field_curves(analysis.field_curves(lens, samples=31, bundles=bundles), right)
        pupils, spot, disc = below.subplots(1, 3, width_ratios=[2, 1, 1])
        analysis.plot_pupil_shapes(analysis.film_pupils(wide_open, samples=5), pupils)
        analysis.plot_spot_diagram(analysis.spot_diagram(lens, rings=16, bundles=bundles), spot, 1)
        analysis.plot_bokeh(analysis.bokeh(wide_open, rays=1_000_000), disc, 2)
        analysis.save_figure(figure, target, dpi=130)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else IMAGE)
