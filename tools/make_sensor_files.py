"""Writes the quantum efficiencies of sensors/*.toml that are derived from tables: python tools/make_sensor_files.py.

Needs the tables of colour-science.

sony-imx071-color.toml: the spectral response of each filter is that of a Nikon D5100, which has this sensor: Darrodi,
Finlayson, Goodman and Mackiewicz, "Reference data set for camera spectral sensitivity estimation", J. Opt. Soc. Am. A
32 (2015), 381, from colour-science: per unit of energy, each filter normalised to a maximum of 1. The ratios of the
filters follow from the raw values of white by Adobe's colour matrix of the D5100 for D65 (DNG Converter; also in LibRaw
and dcraw). Response over wavelength is then proportional to electrons per photon; the factor is fixed by PEAK.
"""

from __future__ import annotations

import re
from pathlib import Path

import colour
import numpy as np

PEAK = 0.5  # largest electrons per photon of any filter, an assumption that is stated in the file
ADOBE_D5100 = np.array([[8198, -2239, -724], [-4871, 12389, 2798], [-1043, 2050, 7181]]) / 10000
D65_XYZ = np.array([0.95047, 1, 1.08883])
FILE = Path(__file__).resolve().parents[1] / "sensors" / "sony-imx071-color.toml"


def d5100_quantum_efficiency() -> tuple[np.ndarray, np.ndarray]:
    """Returns wavelengths in nm, (n,), and electrons per photon of the red, green and blue filter, (n, 3)."""
    curves = colour.MSDS_CAMERA_SENSITIVITIES["Nikon 5100 (NPL)"]
    wavelengths, response = curves.wavelengths, curves.values
    light = colour.SDS_ILLUMINANTS["D65"].copy().align(curves.shape).values
    raw_white = (light[:, None] * response).sum(axis=0)
    response = response * (ADOBE_D5100 @ D65_XYZ / raw_white)
    per_photon = response / wavelengths[:, None]
    return wavelengths, PEAK * per_photon / per_photon.max()


def main() -> None:
    """Replaces the table in the file."""
    rows = zip(*d5100_quantum_efficiency(), strict=True)
    table = "".join(f"    [{nm:g}, {r:.5f}, {g:.5f}, {b:.5f}],\n" for nm, (r, g, b) in rows)
    text = FILE.read_text()
    FILE.write_text(re.sub(r"(?<=quantum_efficiency = \[\n)(.*?)(?=^\])", table, text, flags=re.DOTALL | re.MULTILINE))


if __name__ == "__main__":
    main()
