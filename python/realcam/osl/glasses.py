"""Dispersion: squared refractive indices as polynomials of wavelength, for OSL."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .._core import Lens
from ..dispersion import WavelengthVariable, media_indices

_TERMS = 4  # powers of the colour variable


def colour_variable(lens: Lens) -> WavelengthVariable:
    """Returns the colour variable: 0 at the lens's design wavelength, 1 at 400 nm."""
    return WavelengthVariable.between(lens.wavelength_nm, 0, 400, 1)


def squared_indices(lens: Lens, wavelengths_nm: Sequence[float]) -> list[list[float]]:
    """n^2 of the medium before the lens and behind each surface, as coefficients of a polynomial of the colour
    variable.

    The constant comes first and is exact. A medium without dispersion has only the constant.
    """

    def squares(wavelength_nm: float) -> NDArray[np.float64]:
        return np.array(media_indices(lens, wavelength_nm), dtype=np.float64) ** 2

    design = squares(lens.wavelength_nm)
    variables = colour_variable(lens).at(np.array(wavelengths_nm))
    values = np.array([squares(wavelength_nm) for wavelength_nm in wavelengths_nm]) - design
    powers = variables[:, None] ** np.arange(1, 1 + _TERMS)
    coefficients = np.linalg.lstsq(powers, values, rcond=None)[0].T
    return [
        [float(constant), *map(float, terms)] if np.ptp(column) > 1e-7 else [float(constant)]
        for constant, terms, column in zip(design, coefficients, values.T, strict=True)
    ]
