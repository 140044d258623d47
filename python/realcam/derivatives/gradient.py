"""Derivatives of imaging quantities by the variables of a lens: Lens.gradient."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .._core import InputError, Lens
from ..short_text import ShortText
from .dual_array import Doubles, DualArray
from .field_light import FieldLight, field_light
from .first_order import first_order_duals
from .parabasal import focal_length_and_f_number
from .variable import Variable, checked

FIRST_ORDER = (
    "effective_focal_length_mm",
    "back_focal_distance_mm",
    "front_focal_distance_mm",
    "f_number",
    "entrance_pupil_position_mm",
)
QUANTITIES = (
    "spot_mm",
    "wavefront_waves",
    "mtf_tangential",
    "mtf_sagittal",
    "chief_ray_height_mm",
    "chief_ray_angle_deg",
    "distortion_percent",
    "length_mm",
    *FIRST_ORDER,
)


#: Quantities that are defined for lenses without rotational symmetry, too.
OF_ANY_LENS = (
    "spot_mm",
    "wavefront_waves",
    "mtf_tangential",
    "mtf_sagittal",
    "chief_ray_height_mm",
    "length_mm",
    "effective_focal_length_mm",
    "f_number",
)
NEEDS_SYMMETRY = (
    "derivatives of {} need a rotationally symmetric lens and a field angle; those of "
    + ", ".join(OF_ANY_LENS)
    + " do not"
)


@dataclass(frozen=True, repr=False)
class Gradient(ShortText):
    """A quantity and its derivatives.

    value: in the unit at the end of `quantity`. variables: V of them. by: (V,), per unit of the variable (1/mm for
    curvatures; times -1/radius^2 for derivatives by the radius).
    """

    quantity: str
    value: float
    variables: tuple[Variable, ...]
    by: Doubles


def gradient(
    self: Lens,
    quantity: str,
    variables: Sequence[Variable],
    *,
    field_deg: float = 0.0,
    object_distance_m: float | None = None,
    film_mm: tuple[float, float] | None = None,
    wavelength_nm: float | None = None,
    frequency_per_mm: float | None = None,
    remove: str | None = None,
    samples: int = 6,
) -> Gradient:
    """Exact derivatives of a quantity by variables of the lens, by rays in dual numbers.

    quantity: "spot_mm" (RMS radius about the centroid), "wavefront_waves" (RMS), "mtf_tangential" and "mtf_sagittal"
      (geometric, at frequency_per_mm), "chief_ray_height_mm", "chief_ray_angle_deg" (to the film's normal),
      "distortion_percent" (against the paraxial height on the film), "length_mm" (front vertex to film), and of
      first_order(): effective_focal_length_mm, back_focal_distance_mm, front_focal_distance_mm, f_number,
      entrance_pupil_position_mm.
    film_mm: selects the field by the film point of its chief ray, as in Lens.spot. Tangential is then the direction
      away from the film's centre, and the object point is fixed, as always in lenses without rotational symmetry. Those
      only have spot_mm, wavefront_waves, the MTF, chief_ray_height_mm (its y on the film), length_mm, f_number and
      effective_focal_length_mm (means of both meridians).
    remove: None, "tilt" or "focus", of the wavefront. samples: hexapolar rings of rays.
    The film keeps its distance from the last vertex, and the stop its size; rays remain at their stop coordinates. The
    set of vignetted rays is taken as constant. Raises InputError for quantities and variables that the lens does not
    have.
    """
    if quantity not in QUANTITIES:
        raise InputError(f'unknown quantity "{quantity}"; expected one of {", ".join(QUANTITIES)}')
    listed = checked(self, variables)
    nm = self.wavelength_nm if wavelength_nm is None else wavelength_nm
    if quantity in (*FIRST_ORDER, "length_mm"):
        # Traces no rays: checks the variables as for the other quantities.
        self._ray_derivatives(np.zeros((0, 3)), np.zeros((0, 3)), [v.as_tuple() for v in listed])
        result = _of_first_order(self, quantity, listed, nm)
    else:
        if quantity not in OF_ANY_LENS and (film_mm is not None or not self.is_rotational):
            raise InputError(NEEDS_SYMMETRY.format(quantity))
        light = field_light(
            self, listed, field_deg, nm, object_distance_m=object_distance_m, film_mm=film_mm, samples=samples
        )
        x, y = film_mm if film_mm is not None and any(film_mm) else (0.0, 1.0)
        tangential = x / math.hypot(x, y), y / math.hypot(x, y)
        result = _of_bundle(quantity, light, nm, frequency_per_mm, remove, tangential)
    return Gradient(quantity, float(result.value), tuple(listed), np.asarray(result.by))


def _of_first_order(lens: Lens, quantity: str, variables: Sequence[Variable], wavelength_nm: float) -> DualArray:
    """ "length_mm", or one of FIRST_ORDER, in dual numbers. Raises InputError."""
    if quantity == "length_mm":
        length = sum(surface.thickness_mm for surface in lens.surfaces[:-1]) + lens.film_distance_mm
        by = [float(v.quantity in ("thickness", "film_distance")) for v in variables]
        return DualArray(np.array(length), np.array(by))
    if lens.is_rotational:
        result: DualArray = getattr(first_order_duals(lens, variables, wavelength_nm), quantity)
        return result
    if quantity not in OF_ANY_LENS:
        raise InputError(NEEDS_SYMMETRY.format(quantity))
    focal_length, f_number = focal_length_and_f_number(lens, variables, wavelength_nm)
    return f_number if quantity == "f_number" else focal_length


def _of_bundle(
    quantity: str,
    light: FieldLight,
    wavelength_nm: float,
    frequency_per_mm: float | None,
    remove: str | None,
    tangential: tuple[float, float],
) -> DualArray:
    """A quantity of a traced ray bundle in dual numbers. tangential: unit vector on the film. Raises InputError."""
    if quantity == "wavefront_waves":
        return wavefront_rms(light, wavelength_nm, remove)
    points = light.on_film()
    if quantity == "spot_mm":
        return spot_rms(light, points)
    if quantity in ("mtf_tangential", "mtf_sagittal"):
        if frequency_per_mm is None or not frequency_per_mm >= 0:
            raise InputError("the MTF needs a frequency_per_mm of 0 or more")
        x, y = tangential if quantity == "mtf_tangential" else (tangential[1], -tangential[0])
        return transfer(light, x * points[:, 0] + y * points[:, 1], frequency_per_mm)
    if quantity == "chief_ray_angle_deg":
        return chief_ray_angle_deg(light)
    height = points[-1, 1]
    if quantity == "chief_ray_height_mm":
        return height
    if light.field_deg == 0:
        raise InputError("distortion is not defined on the axis")
    if not abs(light.field_deg) < 90:
        raise InputError("distortion is not defined for fields of 90 deg and more")
    assert light.first_order is not None
    paraxial = math.tan(math.radians(light.field_deg)) * light.first_order.paraxial_height_mm
    return 100 * (height / paraxial - 1.0)


def of_passing(light: FieldLight, values: DualArray) -> tuple[Doubles, DualArray]:
    """Selects the rays that pass, without the chief ray, from values of all rays, (N, ...).

    Returns their weights, which sum to 1, and their values.
    """
    passes = light.passes[:-1]
    weights = light.weights[passes]
    return weights / weights.sum(), values[:-1][passes]


def spot_rms(light: FieldLight, film_points: DualArray) -> DualArray:
    """RMS radius about the centroid. film_points: (N, 2), of all rays, mm."""
    weights, points = of_passing(light, film_points)
    offsets = points - points.sum(weights)
    square = offsets * offsets
    return (square[:, 0] + square[:, 1]).sum(weights).sqrt()


def transfer(light: FieldLight, across: DualArray, frequency_per_mm: float) -> DualArray:
    """Geometric MTF: |weighted sum of exp(2 pi i f x)| over the rays.

    across: (N,), coordinates x of the film points in the direction in which the pattern varies, mm.
    """
    weights, x = of_passing(light, across)
    phase = 2 * np.pi * frequency_per_mm * x
    real = phase.mapped(np.cos(phase.value), -np.sin(phase.value)).sum(weights)
    imaginary = phase.mapped(np.sin(phase.value), np.cos(phase.value)).sum(weights)
    return (real * real + imaginary * imaginary).sqrt()


def chief_ray_angle_deg(light: FieldLight) -> DualArray:
    """Angle of the chief ray to the film's normal in the yz plane."""
    p = light.directions[-1]
    rise = p[1] / p[2]
    return rise.mapped(np.degrees(np.arctan(rise.value)), np.degrees(1 / (1 + rise.value**2)))


def wavefront_rms(light: FieldLight, wavelength_nm: float, remove: str | None) -> DualArray:
    """RMS wavefront error in waves, as by Lens.wavefront with the reference sphere about the chief ray's film point."""
    if remove not in (None, "tilt", "focus"):
        raise InputError(f'cannot remove "{remove}"; expected tilt, focus or None')
    weights, waves = of_passing(light, opd_waves(light, wavelength_nm))
    x, y = light.pupil[:-1][light.passes[:-1]].T
    basis = [np.ones_like(x)]
    if remove is not None:
        basis += [x, y]
    if remove == "focus":
        basis.append(x * x + y * y)
    # The residual of a least-squares fit is linear in the fitted values, so it applies to derivatives, too.
    f = np.array(basis).T
    fit = np.linalg.solve(f.T @ (weights[:, None] * f), f.T * weights)
    residual = DualArray(waves.value - f @ (fit @ waves.value), waves.by - f @ (fit @ waves.by))
    return (residual * residual).sum(weights).sqrt()


def opd_waves(light: FieldLight, wavelength_nm: float) -> DualArray:
    """(N,): optical path differences in waves, positive where the wavefront is ahead of the reference sphere.

    The reference sphere is centred at the chief ray's film point and passes through the centre of the exit pupil, on
    the chief ray. A ray (o, d) reaches it at the distance -b.d - R sqrt(1 - m / R^2) from o, with b = o - centre and m
    the squared distance of the ray from the centre. Without the term -R, which is common to all rays, that is
    (m / R) / (1 + sqrt(1 - m / R^2)) - b.d, also for a plane (R infinite).
    """
    o, p, film = light.origins, light.directions, light.film_z
    size = (p[:, 0] * p[:, 0] + p[:, 1] * p[:, 1] + p[:, 2] * p[:, 2]).sqrt()
    n = size[-1]
    d = [p[:, i] / size for i in range(3)]
    centre = light.on_film()[-1]
    if light.first_order is None:
        assert light.exit_pupil is not None
        curvature = 1.0 / light.exit_pupil()
    elif abs(light.field_deg) < 1e-6 * 180 / math.pi:
        curvature = d[2][-1] / (film - light.first_order.exit_pupil_position_mm)
    else:
        curvature = d[1][-1] / centre[1]  # the exit pupil's centre is where the chief ray crosses the axis
    b = [o[:, 0] - centre[0], o[:, 1] - centre[1], o[:, 2] - film]
    moment = [b[1] * d[2] - b[2] * d[1], b[2] * d[0] - b[0] * d[2], b[0] * d[1] - b[1] * d[0]]
    square = (moment[0] * moment[0] + moment[1] * moment[1] + moment[2] * moment[2]) * curvature
    along = b[0] * d[0] + b[1] * d[1] + b[2] * d[2]
    path = light.paths + n * (square / (1.0 + (1.0 - square * curvature).sqrt()) - along)
    return (path[-1] - path) * (1e6 / wavelength_nm)
