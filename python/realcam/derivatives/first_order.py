"""First-order data of rotationally symmetric lenses with derivatives: paraxial rays in dual numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .._core import InputError, Lens
from .dual_array import DualArray
from .variable import FORM_TERMS, Variable


@dataclass(frozen=True)
class FirstOrderDuals:
    """FirstOrder in dual numbers; paraxial_height_mm: height on the film per tangent of the field angle."""

    effective_focal_length_mm: DualArray
    back_focal_distance_mm: DualArray
    front_focal_distance_mm: DualArray
    f_number: DualArray
    entrance_pupil_position_mm: DualArray
    exit_pupil_position_mm: DualArray  # from the last vertex
    paraxial_height_mm: DualArray
    last_vertex_mm: DualArray
    film_distance_mm: DualArray
    index_behind: DualArray


def first_order_duals(lens: Lens, variables: Sequence[Variable], wavelength_nm: float) -> FirstOrderDuals:
    """First-order data with derivatives by the variables. Raises InputError for lenses without rotational symmetry or
    with terms whose derivatives are not supported."""
    if not lens.is_rotational:
        raise InputError(
            "first-order derivatives need a rotationally symmetric lens; those of spots and wavefronts do not"
        )
    lens.first_order(wavelength_nm)  # raises if the lens has no first-order data
    count = len(variables)
    surfaces = lens.surfaces

    def dual(value: float, quantity: str, surface: int) -> DualArray:
        by = [float(v.quantity == quantity and v.surface == surface) for v in variables]
        return DualArray(np.array(value), np.array(by))

    curvatures, thicknesses = [], []
    indices = [DualArray.constant(1.0, count)]
    sign = 1.0
    for i, surface in enumerate(surfaces):
        curvature = dual(surface.curvature_per_mm, "curvature", i)
        for terms in FORM_TERMS:
            if getattr(surface, terms):
                raise InputError(
                    f"surface {i + 1} has {terms} terms, for which first-order derivatives are not supported"
                )
        if surface.radial_terms:
            bend = [2.0 * (v.quantity == "radial" and v.surface == i and v.power == 2) for v in variables]
            curvature = curvature + DualArray(np.array(2 * surface.radial_terms.get(2, 0.0)), np.array(bend))
        curvatures.append(curvature)
        thicknesses.append(dual(surface.thickness_mm, "thickness", i))
        if surface.type == "mirror":
            sign = -sign
            indices.append(-indices[-1])
        elif surface.type == "refracting":
            indices.append(sign * dual(surface.material.index(wavelength_nm), "index", i))
        else:
            indices.append(indices[-1])

    def traced(height: float, slope: float, first: int, last: int) -> tuple[DualArray, DualArray]:
        """Height and slope behind surface last - 1 of a paraxial ray in front of surface `first`."""
        y, u = DualArray.constant(height, count), DualArray.constant(slope, count)
        for i in range(first, last):
            before, behind = indices[i], indices[i + 1]
            u = (before * u - y * curvatures[i] * (behind - before)) / behind
            if i + 1 < last:
                y = y + thicknesses[i] * u
        return y, u

    stop, end = lens.stop_index, len(surfaces)
    # Behind the lens, a ray parallel to the axis with height 1, and a ray through the front vertex with slope 1.
    (y, u), (_, inclined) = traced(1, 0, 0, end), traced(0, 1, 0, end)
    parallel_at_stop, inclined_at_stop = traced(1, 0, 0, stop + 1)[0], traced(0, 1, 0, stop + 1)[0]
    behind = indices[-1] if indices[-1].value > 0 else -indices[-1]
    focal_length = -1.0 / (behind * u)
    radius = 0.5 * lens.first_order(wavelength_nm).entrance_pupil_diameter_mm * abs(float(parallel_at_stop.value))
    pupil = inclined_at_stop / parallel_at_stop
    diameter = 2 * radius / parallel_at_stop
    chief_y, chief_u = traced(0, 1, stop, end)
    film = dual(lens.film_distance_mm, "film_distance", -1)
    # The ray through the centre of the entrance pupil with the slope 1.
    at_end_y = -pupil * y + traced(0, 1, 0, end)[0]
    at_end_u = -pupil * u + inclined
    last_vertex = DualArray.constant(0.0, count)
    for thickness in thicknesses[:-1]:
        last_vertex = last_vertex + thickness
    f_number = focal_length / diameter
    return FirstOrderDuals(
        focal_length,
        -y / u,
        inclined / u,
        f_number if f_number.value > 0 else -f_number,
        pupil,
        -chief_y / chief_u,
        at_end_y + film * at_end_u,
        last_vertex,
        film,
        behind,
    )
