"""Draws the plot of docs/coatings.md: reflectance of uncoated, single-layer and three-layer coated glass."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.figure
import numpy as np
import realcam as rc

GLASS = 1.5168  # refractive index
DESIGN_NM = 550.0


def coatings() -> dict[str, tuple[rc.Coating, str]]:
    """Returns coatings with their colours, by the text of the legend."""

    def layer(index: float, waves: float) -> rc.CoatingLayer:
        return rc.CoatingLayer(index, thickness_waves=waves, design_wavelength_nm=DESIGN_NM)

    # Quarter, half and quarter wave (H. A. Macleod, Thin-Film Optical Filters, chapter 4).
    three = rc.Coating([layer(1.38, 0.25), layer(2.1, 0.5), layer(1.7, 0.25)])
    return {
        "bare": (rc.Coating.named("bare"), "#444444"),
        "quarter wave of 1.38": (rc.Coating.named("quarter_wave"), "#1f77b4"),
        "three layers, 1.38, 2.1, 1.7": (three, "#d62728"),
    }


def save_plot(path: Path) -> None:
    """Plots reflectance over wavelength at normal incidence, and over the angle of incidence at the design wavelength
    for s and p polarisation and their mean."""
    figure = matplotlib.figure.Figure(figsize=(10, 4), layout="constrained")
    over_wavelength, over_angle = figure.subplots(1, 2)
    wavelengths, angles = np.linspace(380, 780, 401), np.linspace(0, 89, 357)
    for name, (coating, colour) in coatings().items():
        normal = coating.response(0, wavelengths, inside=GLASS)
        over_wavelength.plot(wavelengths, 100 * normal.reflectance_s, color=colour, label=name)
        oblique = coating.response(angles, DESIGN_NM, inside=GLASS)
        s, p = 100 * oblique.reflectance_s, 100 * oblique.reflectance_p
        over_angle.plot(angles, (s + p) / 2, color=colour, label=name)
        over_angle.plot(angles, s, color=colour, linestyle="--", linewidth=0.8)
        over_angle.plot(angles, p, color=colour, linestyle=":", linewidth=0.8)
    over_wavelength.set(xlabel="wavelength / nm", ylabel="reflectance / %", xlim=(380, 780), ylim=(0, 6))
    over_wavelength.set_title("normal incidence", fontsize=10)
    over_wavelength.legend(frameon=False, fontsize=9, loc="center right")
    over_angle.set(xlabel="angle of incidence / degrees", ylabel="reflectance / %", xlim=(0, 85), ylim=(0, 40))
    over_angle.set_title(f"{DESIGN_NM:.0f} nm; dashed s, dotted p", fontsize=10)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/coatings_plot.py PICTURE")
    save_plot(Path(sys.argv[1]))
