"""Variables of a lens, for optimisation and differentiation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .._core import Glass, InputError, Lens, Surface, _form_terms
from ..dispersion import LINE_D_NM

FORM_TERMS = _form_terms()
"""Kinds of terms of the sag, as keywords of Surface."""
QUANTITIES = (
    "curvature",
    "thickness",
    "conic",
    "aspheric",
    "index",
    "decentre",
    "tilt",
    "curvature_x",
    "conic_x",
    "radial",
    "xy",
    *FORM_TERMS,
    "film_distance",
)

#: Quantities that Variable.set supports.
SETTABLE = ("curvature", "thickness", "conic", "aspheric", "index", "tilt", "decentre")


@dataclass(frozen=True)
class Variable:
    """A variable of a lens.

    quantity: "curvature" (1/mm), "thickness" (mm), "conic", "aspheric" (the coefficient of r^power, mm^(1-power)),
      "index" (of the medium behind the surface, equally at all wavelengths), "decentre" (mm) or "tilt" (degrees;
      power 0, 1, 2: along or about x, y, z), "curvature_x" and "conic_x" (of toroids and biconics), "radial" (of
      r^power), "xy" (of x^power y^power_y), a keyword of Surface for terms, such as "zernike" (term number power) or
      "forbes" (a_power), or "film_distance" (of no surface: last vertex to film, mm).
    surface: its index, from 0. lower, upper: bounds, in the same unit.
    Tilting or decentring an untilted, centred surface moves it alone; for other surfaces their `returns` decides.
    """

    quantity: str
    surface: int
    power: int = 0
    lower: float = -math.inf
    upper: float = math.inf
    power_y: int = 0

    @staticmethod
    def radius(surface: int, least_radius_mm: float = 0.0) -> Variable:
        """The curvature, of either sign and through zero, with a radius of at least least_radius_mm."""
        most = 1 / least_radius_mm if least_radius_mm > 0 else math.inf
        return Variable("curvature", surface, lower=-most, upper=most)

    @staticmethod
    def thickness(surface: int, lower_mm: float = 0.1, upper_mm: float = math.inf) -> Variable:
        """The distance from this surface to the next."""
        return Variable("thickness", surface, lower=lower_mm, upper=upper_mm)

    @staticmethod
    def conic(surface: int, lower: float = -math.inf, upper: float = math.inf) -> Variable:
        return Variable("conic", surface, lower=lower, upper=upper)

    @staticmethod
    def aspheric(surface: int, power: int, lower: float = -math.inf, upper: float = math.inf) -> Variable:
        return Variable("aspheric", surface, power, lower, upper)

    @staticmethod
    def index(surface: int, lower: float = 1.0, upper: float = math.inf) -> Variable:
        """The refractive index of the medium behind this surface. An optimisation requires a Glass.constant there."""
        return Variable("index", surface, lower=lower, upper=upper)

    @staticmethod
    def tilt(surface: int, axis: str = "x", most_deg: float = math.inf) -> Variable:
        return Variable("tilt", surface, _axis(axis), -most_deg, most_deg)

    @staticmethod
    def decentre(surface: int, axis: str = "y", most_mm: float = math.inf) -> Variable:
        return Variable("decentre", surface, _axis(axis), -most_mm, most_mm)

    @staticmethod
    def film_distance(lower_mm: float = -math.inf, upper_mm: float = math.inf) -> Variable:
        """The distance from the last vertex to the film."""
        return Variable("film_distance", -1, lower=lower_mm, upper=upper_mm)

    def as_tuple(self) -> tuple[str, int, int, int]:
        """The variable without its bounds, as the core identifies it."""
        return self.quantity, self.surface, self.power, self.power_y

    def __str__(self) -> str:
        """Name of the variable, with the surface counted from 1 as in lens tables and messages."""
        if self.quantity == "film_distance":
            return "film distance"
        which = ""
        if self.quantity in ("tilt", "decentre"):
            which = " " + "xyz"[self.power]
        elif self.quantity == "xy":
            which = f" x^{self.power} y^{self.power_y}"
        elif self.quantity in ("aspheric", "radial"):
            which = f" r^{self.power}"
        elif self.quantity in FORM_TERMS:
            which = f" {self.power}"
        return f"{self.quantity}{which} of surface {self.surface + 1}"

    def of(self, surface: Surface) -> float:
        """Value of the variable; `surface` is the one it belongs to. Only for the quantities that `set` supports."""
        if self.quantity == "curvature":
            return surface.curvature_per_mm
        if self.quantity == "thickness":
            return surface.thickness_mm
        if self.quantity == "conic":
            return surface.conic
        if self.quantity == "index":
            return surface.material.index(LINE_D_NM)
        if self.quantity in ("tilt", "decentre"):
            return (surface.tilt_deg if self.quantity == "tilt" else surface.decentre_mm)[self.power]
        return surface.aspheric_coefficients.get(self.power, 0.0)

    def set(self, surface: Surface, value: float) -> Surface:
        """Returns the surface with another value of the variable: a curvature, thickness, conic, aspheric coefficient,
        index, tilt or decentre."""
        if self.quantity == "curvature":
            return surface.replace(radius_of_curvature_mm=math.inf if value == 0 else 1 / value)
        if self.quantity == "thickness":
            return surface.replace(thickness_mm=value)
        if self.quantity == "conic":
            return surface.replace(conic=value)
        if self.quantity == "index":
            return surface.replace(material=Glass.constant(value))
        if self.quantity in ("tilt", "decentre"):
            moved = surface.tilt_deg if self.quantity == "tilt" else surface.decentre_mm
            numbers = [value if i == self.power else number for i, number in enumerate(moved)]
            in_place = not any(surface.tilt_deg) and not any(surface.decentre_mm)
            returns = surface.returns or in_place
            if self.quantity == "tilt":
                return surface.replace(tilt_deg=numbers, returns=returns)
            return surface.replace(decentre_mm=numbers, returns=returns)
        return surface.replace(aspheric_coefficients={**surface.aspheric_coefficients, self.power: value})

    def step(self, surface: Surface) -> float:
        """Step that moves rays by some micrometres: the unit in which optimisations scale the variable."""
        rim = surface.clear_semi_diameter_mm
        sag = 1e-3  # mm at the rim
        if self.quantity == "curvature":
            return 2 * sag / rim**2
        if self.quantity in ("thickness", "decentre"):
            return 10 * sag
        if self.quantity == "index":
            return sag
        if self.quantity == "tilt":
            return math.degrees(sag / rim)
        if self.quantity == "conic":
            return 8 * sag / max(abs(surface.curvature_per_mm) ** 3 * rim**4, 1e-12)
        return sag / float(rim) ** self.power


def _axis(name: str) -> int:
    """Index of an axis. Raises InputError."""
    if name not in ("x", "y", "z"):
        raise InputError(f'unknown axis "{name}"; expected x, y or z')
    return "xyz".index(name)


def check_surface_exists(lens: Lens, surface: int) -> None:
    """Raises InputError if the lens has no surface of this index."""
    if not 0 <= surface < len(lens.surfaces):
        raise InputError(f"there is no surface {surface}; the lens has {len(lens.surfaces)}, counted from 0")


def checked(lens: Lens, variables: Sequence[Variable]) -> list[Variable]:
    """Returns the variables as a list. Raises InputError if there are none, or for duplicates, unknown quantities and
    surfaces that the lens does not have."""
    if not variables:
        raise InputError("variables must have at least one Variable")
    if len({v.as_tuple() for v in variables}) < len(variables):
        raise InputError("variables must be distinct")
    for variable in variables:
        if variable.quantity not in QUANTITIES:
            raise InputError(f'unknown quantity "{variable.quantity}"; expected one of {", ".join(QUANTITIES)}')
        if variable.quantity != "film_distance":
            check_surface_exists(lens, variable.surface)
    return list(variables)


def with_values(lens: Lens, variables: Sequence[Variable], values: Sequence[float]) -> Lens:
    """Returns the lens with these values of its variables. Raises InputError if that lens cannot be built."""
    surfaces: dict[int, Surface] = {}
    for variable, value in zip(variables, values, strict=True):
        surface = surfaces.get(variable.surface, lens.surfaces[variable.surface])
        surfaces[variable.surface] = variable.set(surface, float(value))
    return lens.with_surfaces(surfaces)
