"""Writes cpp/camera/effects/dispersion/spectra.hpp: spectra for dispersion, every 5 nm from 380 to 780 nm.

Needs the tables of colour-science (pip install colour-science): the CIE 1931 observer, the CIE illuminants
D65, D50, A and FL2, and the basis of Mallett and Yuksel, "Spectral Primary Decomposition for Rendering with sRGB
Reflectance" (EGSR 2019).

    python tools/make_spectra.py && clang-format -i cpp/camera/effects/dispersion/spectra.hpp
"""

import warnings
from pathlib import Path

import numpy as np

warnings.simplefilter("ignore")

import colour  # noqa: E402
from colour.recovery import MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019 as BASIS  # noqa: E402

TARGET = Path(__file__).resolve().parents[1] / "cpp/camera/effects/dispersion/spectra.hpp"
WAVELENGTHS_NM = np.arange(380, 781, 5)
HEAD = """#pragma once
#include <array>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

// Written by tools/make_spectra.py from the tables of colour-science; do not edit by hand.

inline constexpr double kFirstWavelength_nm = 380, kLastWavelength_nm = 780, kSpectrumStep_nm = 5;

/// Values every 5 nm from 380 to 780, linear in between.
using VisibleSpectrum = std::array<double, 81>;

"""


def table(name: str, comment: str, values: np.ndarray) -> str:
    """C++ declaration of a spectrum."""
    numbers = ", ".join(f"{float(v):.9g}" for v in values)
    return f"/// {comment}\ninline constexpr VisibleSpectrum {name} = {{{numbers}}};\n"


def row(values: np.ndarray, wavelengths: np.ndarray) -> np.ndarray:
    """Values at WAVELENGTHS_NM. wavelengths: of all values; they must include WAVELENGTHS_NM."""
    index = {int(nm): i for i, nm in enumerate(wavelengths)}
    return np.array([values[index[int(nm)]] for nm in WAVELENGTHS_NM])


def main() -> None:
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    text = HEAD
    for i, name in enumerate(("X", "Y", "Z")):
        values = row(observer.values[:, i], observer.wavelengths)
        text += table(f"kObserver{name}", f"CIE 1931 2 degree observer, {'xyz'[i]}.", values)
    for name in ("D65", "D50", "A", "FL2"):
        illuminant = colour.SDS_ILLUMINANTS[name]
        text += table(
            f"kIlluminant{name}", f"CIE illuminant {name}, relative.", row(illuminant.values, illuminant.wavelengths)
        )
    for i, name in enumerate(("Red", "Green", "Blue")):
        values = row(BASIS.values[:, i], BASIS.wavelengths)
        text += table(
            f"kBasis{name}",
            f"{name} basis spectrum for upsampling linear sRGB reflectance (Mallett and Yuksel 2019).",
            values,
        )
    TARGET.write_text(text + "\n}  // namespace REALCAM_NAMESPACE\n", encoding="utf-8")


if __name__ == "__main__":
    main()
