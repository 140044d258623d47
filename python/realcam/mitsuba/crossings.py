"""A lens as a list of surfaces in the order of the ray, towards the film or towards the scene."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .._core import InputError, Lens, Surface, _iris_apothem_mm
from ..dispersion import WavelengthVariable, media_indices

# Wavelength range of Mitsuba's sensors, nm.
WAVELENGTHS_NM = (360.0, 830.0)
# Variable of the wavelength: -1 at the longest and 1 at the shortest.
VARIABLE = WavelengthVariable.between(WAVELENGTHS_NM[1], -1, WAVELENGTHS_NM[0], 1)
# Degree of the polynomials of indices. The fit's error is then below float32's resolution for all glasses with a
# dispersion formula.
DEGREE = 6


@dataclass(frozen=True)
class Asphere:
    """z = conic + u^2 p(u - 1/2), with u = r^2 / reach^2; beyond the reach the sag is constant.

    terms: coefficients of p in mm, the constant first. p is in powers of u - 1/2, because powers of u cancel towards
    the rim. lowest_mm, highest_mm: bounds of the sag.
    """

    reach_mm: float
    terms: tuple[float, ...]
    lowest_mm: float
    highest_mm: float


@dataclass(frozen=True)
class Iris:
    """Diaphragm blades whose edges are arcs of equal curvature; the midpoint of each lies apothem_mm from the axis."""

    apothem_mm: float
    curvature_per_mm: float
    azimuths_rad: tuple[float, ...]


@dataclass(frozen=True)
class Crossing:
    """One surface, in the frame of its vertex. sign_in, sign_out: signs of the ray's z direction before and after it.

    index_change: n'^2 / n^2 - 1 at the design wavelength. index_terms: n'^2 / n^2 - 1 as a polynomial of VARIABLE, the
    constant first; empty if it does not depend on the wavelength.
    """

    vertex_mm: float  #: z of the vertex
    curvature_per_mm: float
    conic: float
    asphere: Asphere | None
    rim_mm: float  #: clear semi-diameter
    hole_mm: float  #: radius of a central hole or obstruction; 0: none
    iris: Iris | None  #: None: no blades at this surface
    sign_in: int
    sign_out: int
    index_change: float
    index_terms: tuple[float, ...]


def check_expressible(lens: Lens) -> None:
    """Raises InputError, which names the surface, if the sensor cannot trace the lens."""
    for number, surface in enumerate(lens.surfaces, 1):
        if surface.form != "conic":
            raise InputError(
                f'surface {number} of lens "{lens.name}" is of the form "{surface.form}"; the Mitsuba sensor traces '
                "spheres, conics and even aspheres"
            )
    mirrors = [number for number, surface in enumerate(lens.surfaces, 1) if surface.type == "mirror"]
    if len(mirrors) % 2:
        raise InputError(
            f'surface {mirrors[-1]} of lens "{lens.name}" is a mirror that sends light away from the film; the Mitsuba '
            "sensor traces lenses with an even number of mirrors"
        )


def crossings_to_film(lens: Lens, dispersive: bool) -> list[Crossing]:
    """Returns the surfaces in order from the scene to the film. Raises InputError as check_expressible."""
    check_expressible(lens)
    sign, found = 1, []
    for index, (surface, vertex) in enumerate(zip(lens.surfaces, lens.vertices_mm, strict=True)):
        sign_out = -sign if surface.type == "mirror" else sign
        found.append(
            Crossing(
                vertex_mm=vertex,
                curvature_per_mm=surface.curvature_per_mm,
                conic=surface.conic,
                asphere=_asphere(surface),
                rim_mm=_rim_mm(lens, index),
                hole_mm=surface.inner_semi_diameter_mm,
                iris=_iris(lens) if index == lens.stop_index else None,
                sign_in=sign,
                sign_out=sign_out,
                index_change=float(_index_change(lens, index, lens.wavelength_nm)),
                index_terms=_index_terms(lens, index) if dispersive else (),
            )
        )
        sign = sign_out
    return found


def crossings_to_scene(crossings: list[Crossing]) -> list[Crossing]:
    """Returns the surfaces of crossings_to_film for the reverse direction."""

    def back(crossing: Crossing) -> Crossing:
        terms = crossing.index_terms
        if terms:
            # The inverse 1 / (1 + change) - 1 is not a polynomial and needs its own fit.
            x = np.cos(np.pi * (np.arange(32) + 0.5) / 32)
            change = np.polynomial.polynomial.polyval(x, terms)
            terms = _fit(x, -change / (1 + change))
        return replace(
            crossing,
            sign_in=-crossing.sign_out,
            sign_out=-crossing.sign_in,
            index_change=-crossing.index_change / (1 + crossing.index_change),
            index_terms=terms,
        )

    return [back(crossing) for crossing in reversed(crossings)]


def _rim_mm(lens: Lens, index: int) -> float:
    """Clear semi-diameter of a surface, or radius of a circular stop."""
    clear = lens.surfaces[index].clear_semi_diameter_mm
    if index != lens.stop_index or _iris(lens):
        return clear
    return min(lens.stop_semi_diameter_mm, clear)


def _iris(lens: Lens) -> Iris | None:
    """Blades of the diaphragm; None: it is circular."""
    apothem_mm = _iris_apothem_mm(lens)
    if apothem_mm is None:
        return None
    azimuths = 2 * np.pi * np.arange(lens.iris_blades) / lens.iris_blades
    return Iris(apothem_mm, lens.iris_rounding / apothem_mm, tuple(np.radians(lens.iris_rotation_deg) + azimuths))


def _asphere(surface: Surface) -> Asphere | None:
    """Aspheric part of a surface; None if it has none."""
    if not surface.aspheric_coefficients:
        return None
    # Slightly beyond the rim, so that a ray that just misses the rim still intersects the surface there.
    reach = 1.02 * surface.clear_semi_diameter_mm
    if not np.isfinite(surface.sag_mm(reach)):
        reach = surface.clear_semi_diameter_mm
    powers = np.zeros(max(surface.aspheric_coefficients) // 2 - 1)
    for power, coefficient in surface.aspheric_coefficients.items():
        powers[power // 2 - 2] = coefficient * reach**power
    terms = np.polynomial.Polynomial(powers)(np.polynomial.Polynomial([0.5, 1])).coef
    sags = [surface.sag_mm(reach * fraction) for fraction in np.linspace(0, 1, 257)]
    margin = 0.02 * np.ptp(sags) + 1e-3 * reach
    return Asphere(reach, tuple(terms.tolist()), min(sags) - margin, max(sags) + margin)


def _index_change(lens: Lens, index: int, nm: float) -> float:
    """n'^2 / n^2 - 1 at a surface, for light towards the film."""
    indices = media_indices(lens, nm)
    return (indices[index + 1] / indices[index]) ** 2 - 1


def _index_terms(lens: Lens, index: int) -> tuple[float, ...]:
    """Polynomial of _index_change over VARIABLE; empty if it is constant."""
    x = np.cos(np.pi * (np.arange(32) + 0.5) / 32)
    change = np.array([_index_change(lens, index, nm) for nm in VARIABLE.wavelength_nm(x)])
    return () if np.ptp(change) == 0 else _fit(x, change)


def _fit(x: np.ndarray, values: np.ndarray) -> tuple[float, ...]:
    """Coefficients of the polynomial of degree DEGREE through values at x, -1 to 1, the constant first."""
    series = np.polynomial.Chebyshev.fit(x, values, DEGREE, domain=[-1, 1])
    return tuple(series.convert(kind=np.polynomial.Polynomial).coef.tolist())
