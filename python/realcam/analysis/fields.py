"""Ray bundles, and default fields, wavelengths and frequencies of analyses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InputError, Lens, RayBundle
from ..dispersion import LINE_C_NM, LINE_F_NM
from ..fields import FieldPosition, angle_of_height, field_arguments

Doubles = NDArray[np.float64]


class Bundles:
    """Cache of the ray bundles of object points, so that several plots share them.

    object_distance_m: object plane to front vertex, positive or inf; None is the plane in focus. Raises InputError.
    """

    def __init__(self, lens: Lens, object_distance_m: float | None = None) -> None:
        if object_distance_m is not None and not object_distance_m > 0:
            raise InputError(f"object_distance_m must be a positive length, or inf; it is {object_distance_m}")
        self.lens = lens
        self.object_distance_m = object_distance_m
        self._bundles: dict[tuple[FieldPosition, float, int, int], RayBundle] = {}

    def at(self, field: FieldPosition, wavelength_nm: float, arms: int = 32, nodes: int = 6) -> RayBundle:
        """Ray bundle of a field point, with `arms` radial scan lines of `nodes` rays. Raises InputError if no light
        passes."""
        key = (field, float(wavelength_nm), arms, nodes)
        if key not in self._bundles:
            self._bundles[key] = self.lens.bundle(
                **field_arguments(field),
                wavelength_nm=key[1],
                object_distance_m=self.object_distance_m,
                arms=arms,
                nodes=nodes,
            )
        return self._bundles[key]

    def chief(self, field: FieldPosition, wavelength_nm: float) -> RayBundle:
        """Smallest ray bundle of a field point, sufficient for chief-ray data. Raises InputError if no light passes."""
        return self.at(field, wavelength_nm, 8, 2)

    @cached_property
    def largest_field_deg(self) -> float:
        """Field angle of the film's corner, or slightly inside the edge of the illuminated field if that is smaller.

        Raises InputError if no axial light passes.
        """
        corner = 0.5 * math.hypot(*self.lens.film_mm)
        angle_deg, height_mm = angle_of_height(self.lens, corner, self.object_distance_m)
        return angle_deg if height_mm > 0.999 * corner else 0.99 * angle_deg


def bundles_of(lens: Lens, object_distance_m: float | None, bundles: Bundles | None) -> Bundles:
    """Returns the caller's bundles, or new ones. Raises InputError if they are of another lens or object distance."""
    if bundles is None:
        return Bundles(lens, object_distance_m)
    if bundles.lens != lens or (object_distance_m is not None and bundles.object_distance_m != object_distance_m):
        raise InputError("bundles must have been made for this lens and object distance")
    return bundles


def wavelengths_of(lens: Lens, wavelengths_nm: ArrayLike | None) -> Doubles:
    """(W,): the specified wavelengths; by default F line, design wavelength and C line, or only the design wavelength
    if that is not between these lines."""
    if wavelengths_nm is not None:
        return numbers_of(wavelengths_nm, "wavelengths_nm")
    design = lens.wavelength_nm
    return np.array([LINE_F_NM, design, LINE_C_NM] if LINE_F_NM < design < LINE_C_NM else [design])


def numbers_of(values: ArrayLike, name: str) -> Doubles:
    """Returns a one-dimensional array of at least one finite number. Raises InputError with the argument's name."""
    array = np.atleast_1d(np.asarray(values, dtype=float))
    if array.ndim != 1 or array.size == 0 or not np.isfinite(array).all():
        raise InputError(f"{name} must be finite numbers, at least one")
    return array


def fields_of(lens: Lens, fields_deg: ArrayLike | None, count: int, bundles: Bundles) -> Doubles:
    """(F,): the specified angles; by default `count` from the axis to the film corner, equidistant in image height."""
    if fields_deg is not None:
        return numbers_of(fields_deg, "fields_deg")
    return field_angles_deg(lens, np.linspace(0, 1, checked_count(count)), bundles)


def checked_count(count: int, name: str = "samples") -> int:
    """Returns a number of things. Raises InputError with the argument's name unless it is 1 or more."""
    if count < 1:
        raise InputError(f"{name} must be 1 or more; it is {count}")
    return count


def frequencies_of(values: ArrayLike, name: str = "frequencies_per_mm") -> Doubles:
    """Returns a one-dimensional array of at least one frequency, 0 or more. Raises InputError with the argument's
    name."""
    frequencies = numbers_of(values, name)
    if (frequencies < 0).any():
        raise InputError(f"{name} must not be negative")
    return frequencies


def three_fields(lens: Lens, fields_deg: ArrayLike | None, bundles: Bundles) -> Doubles:
    """(F,): the specified angles; by default those of 0, 0.7 and 1 times the largest image height."""
    return field_angles_deg(lens, [0, 0.7, 1], bundles) if fields_deg is None else numbers_of(fields_deg, "fields_deg")


def three_of(values: Sequence[float], middle: float | None = None) -> list[float]:
    """Selects the smallest, a middle and the largest of the values in a lens file, sorted and without duplicates.

    middle: None is the value nearest to 0.7 times the largest, or exactly 0.7 times the largest if there is no value in
    between.
    """
    least, largest = min(values), max(values)
    between = [value for value in values if least < value < largest]
    if middle is None:
        middle = min(between, key=lambda value: abs(value - 0.7 * largest), default=0.7 * largest)
    return sorted({least, middle, largest})


def film_points_of(film_mm: ArrayLike) -> list[FieldPosition]:
    """Returns F pairs (x, y), mm, of an array of film points (F, 2). Raises InputError."""
    points = np.asarray(film_mm, dtype=float)
    if points.ndim != 2 or points.shape[1] != 2 or points.size == 0 or not np.isfinite(points).all():
        raise InputError("film_mm must be at least one film point, (x, y) in mm")
    return [(float(x), float(y)) for x, y in points]


def analysis_inputs(
    lens: Lens,
    fields_deg: ArrayLike | None,
    wavelengths_nm: ArrayLike | None,
    object_distance_m: float | None,
    bundles: Bundles | None,
    samples: int | None = None,
) -> tuple[Bundles, Doubles, Doubles]:
    """Returns the inputs of most analyses: bundles, (F,) fields and (W,) wavelengths, specified or default.

    samples: number of default fields; None is 0, 0.7 and 1 times the largest image height.
    """
    source = bundles_of(lens, object_distance_m, bundles)
    fields = three_fields(lens, fields_deg, source) if samples is None else fields_of(lens, fields_deg, samples, source)
    return source, fields, wavelengths_of(lens, wavelengths_nm)


def field_angles_deg(lens: Lens, shares: ArrayLike, bundles: Bundles | None = None) -> Doubles:
    """(F,): field angles whose chief rays reach fractions of the largest image height.

    shares: (F,), the fractions, 0 to 1. The largest image height is half the film's diagonal. If the illuminated field
    is smaller, it is that of 0.99 times the angle of its edge, because at the edge itself the pupil is a sliver that
    few rays find. Raises InputError if no axial light passes the lens.
    """
    source = bundles or Bundles(lens)
    largest = source.largest_field_deg
    largest_mm = _height_mm(source, largest)
    fractions = numbers_of(shares, "shares")
    # The chief ray's height is a smooth function of the angle: nine samples suffice for interpolation.
    angles = largest * np.linspace(0, 1, 9)
    heights = np.array([0.0 if a == 0 else _height_mm(source, a) for a in angles])
    fields: Doubles = np.interp(fractions * largest_mm, heights, angles)
    return fields


def _height_mm(bundles: Bundles, field_deg: float) -> float:
    """Height of the chief ray on the film; nan if no light arrives."""
    try:
        # The chief ray alone proves that there is light. If it is blocked, a whole bundle has to search.
        spot = bundles.lens.spot(field_deg, object_distance_m=bundles.object_distance_m, pupil=[[0.0, 0.0]])
        return math.hypot(*spot.chief_ray_mm)
    except InputError:
        pass
    try:
        return math.hypot(*bundles.chief(field_deg, bundles.lens.wavelength_nm).chief_ray_mm)
    except InputError:
        return math.nan


def default_frequencies_per_mm(lens: Lens) -> Doubles:
    """(3,): 10, 20 and 40 periods per mm for a film diagonal of 43.27 mm, scaled inversely to other diagonals and
    rounded."""
    scale = 43.27 / math.hypot(*lens.film_mm)
    return np.array([_round_number(f * scale) for f in (10.0, 20.0, 40.0)])


def _round_number(value: float) -> float:
    """The nearest 1, 2, 4 or 5 times a power of ten, by ratio."""
    power = 10.0 ** math.floor(math.log10(value))
    return float(min((1, 2, 4, 5, 10), key=lambda step: abs(math.log(step * power / value)))) * power


def texts_of(values: Sequence[float] | Doubles, unit: str) -> list[str]:
    """Texts of values with their unit, for legends; no space before a degree sign."""
    return [f"{value:.4g}{'' if unit == '°' else ' '}{unit}" for value in values]
