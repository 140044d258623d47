"""Refractive indices of a lens over the wavelength."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ._core import Lens

LINE_F_NM, LINE_D_NM, LINE_C_NM = 486.1327, 587.5618, 656.2725  # Fraunhofer lines, as kLineF_nm and so on in C++
POLE_NM = 200.0  # a typical resonance of optical glass, in the ultraviolet, towards which indices increase


@dataclass(frozen=True)
class WavelengthVariable:
    """scale / (wavelength - POLE_NM) - offset, a variable in which refractive indices are nearly polynomials."""

    scale: float
    offset: float

    @classmethod
    def between(cls, first_nm: float, at_first: float, last_nm: float, at_last: float) -> WavelengthVariable:
        """Returns the variable that has these values at two wavelengths; 0 everywhere if the wavelengths are equal."""
        if first_nm == last_nm:
            return cls(0.0, 0.0)
        first, last = 1 / (first_nm - POLE_NM), 1 / (last_nm - POLE_NM)
        scale = (at_last - at_first) / (last - first)
        return cls(scale, scale * first - at_first)

    def at(self, wavelength_nm: Any) -> Any:
        """Returns the values at wavelengths: a number, an array or a Dr.Jit value."""
        return self.scale / (wavelength_nm - POLE_NM) - self.offset

    def wavelength_nm(self, value: Any) -> Any:
        """Returns the wavelengths at which the variable has these values."""
        return POLE_NM + self.scale / (value + self.offset)


def media_indices(lens: Lens, wavelength_nm: float) -> list[float]:
    """Returns the refractive indices before the lens and behind each surface."""
    indices = [1.0]
    for surface in lens.surfaces:
        indices.append(surface.material.index(wavelength_nm) if surface.type == "refracting" else indices[-1])
    return indices
