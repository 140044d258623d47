"""Operands of an optimisation in addition to small spots."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .._core import InputError, Lens, Surface
from ..derivatives.dual_array import Doubles
from ..derivatives.gradient import QUANTITIES as GRADIENT_QUANTITIES
from ..derivatives.variable import Variable, check_surface_exists

#: Thickness operands, in addition to the quantities of Lens.gradient.
THICKNESSES = ("centre_thickness_mm", "edge_thickness_mm")
BOUNDS = ("equal", "least", "most")


@dataclass(frozen=True)
class Operand:
    """A quantity with a target value or a one-sided bound.

    quantity: one of Lens.gradient's, or "centre_thickness_mm" or "edge_thickness_mm": from `surface` to the next, on
      the axis, or at the larger of the two rims. surface: its index, from 0.
    target: in the unit of the quantity. bound: "equal", "least" or "most".
    weight: an error of 1 counts as `weight` mm of the RMS spot radius.
    field_deg, wavelength_nm, frequency_per_mm: as for Lens.gradient. A telecentric lens has a chief_ray_angle_deg of 0.
    """

    quantity: str
    target: float = 0.0
    weight: float = 1.0
    bound: str = "equal"
    field_deg: float = 0.0
    wavelength_nm: float | None = None
    frequency_per_mm: float | None = None
    surface: int = 0

    def checked(self, lens: Lens) -> Operand:
        """Returns the operand. Raises InputError if it is invalid for the lens."""
        if self.quantity not in (*GRADIENT_QUANTITIES, *THICKNESSES):
            raise InputError(
                f'unknown operand "{self.quantity}"; expected one of {", ".join((*GRADIENT_QUANTITIES, *THICKNESSES))}'
            )
        if self.bound not in BOUNDS:
            raise InputError(f'unknown bound "{self.bound}"; expected equal, least or most')
        if not (math.isfinite(self.target) and math.isfinite(self.weight) and self.weight > 0):
            raise InputError(f"the operand {self.quantity} needs a finite target and a positive weight")
        if self.quantity in THICKNESSES:
            check_surface_exists(lens, self.surface)
            if self.surface == len(lens.surfaces) - 1:
                raise InputError(f"{self.quantity}: surface {self.surface + 1} is the last and has no thickness")
        return self

    def residual(self, value: float) -> float:
        """Residual of the least-squares problem, mm, for a value of the quantity; 0 if a bound is met."""
        error = value - self.target
        if (self.bound == "least" and error >= 0) or (self.bound == "most" and error <= 0):
            return 0.0
        return self.weight * error

    def value_of(self, lens: Lens, samples: int) -> float:
        """Value of the quantity. samples: as for Lens.gradient. Raises InputError."""
        if self.quantity in THICKNESSES:
            return self._thickness(lens.surfaces[self.surface], lens.surfaces[self.surface + 1])
        return self.gradient_of(lens, [Variable.film_distance()], samples)[0]

    def gradient_of(self, lens: Lens, variables: Sequence[Variable], samples: int) -> tuple[float, Doubles]:
        """The value, and its derivatives (V,) at constant distance from the last vertex to the film."""
        if self.quantity in THICKNESSES:
            return self._thickness_gradient(lens, variables)
        found = lens.gradient(
            self.quantity,
            variables,
            field_deg=self.field_deg,
            wavelength_nm=self.wavelength_nm,
            frequency_per_mm=self.frequency_per_mm,
            samples=samples,
        )
        return found.value, found.by

    def _thickness(self, front: Surface, back: Surface) -> float:
        """Thickness between two surfaces at the centre or at the edge, mm."""
        if self.quantity == "centre_thickness_mm":
            return front.thickness_mm
        rim = max(front.clear_semi_diameter_mm, back.clear_semi_diameter_mm)
        return front.thickness_mm + back.sag_mm(rim) - front.sag_mm(rim)

    def _thickness_gradient(self, lens: Lens, variables: Sequence[Variable]) -> tuple[float, Doubles]:
        """Thickness and its derivatives (V,). Sag is a closed form: central differences are accurate to 1e-8."""
        pair = {i: lens.surfaces[i] for i in (self.surface, self.surface + 1)}

        def moved(variable: Variable, step: float) -> float:
            changed = dict(pair)
            surface = changed[variable.surface]
            changed[variable.surface] = variable.set(surface, variable.of(surface) + step)
            return self._thickness(*changed.values())

        by = np.zeros(len(variables))
        for i, variable in enumerate(variables):
            if variable.surface in pair and variable.quantity in ("curvature", "thickness", "conic", "aspheric"):
                step = variable.step(pair[variable.surface])
                by[i] = (moved(variable, step) - moved(variable, -step)) / (2 * step)
        return self._thickness(*pair.values()), by
