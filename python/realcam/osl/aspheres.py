"""Aspheres for OSL: polynomials and Newton steps, as few as hold on the rays of the lens."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial
from numpy.typing import NDArray

from .._core import InputError, Lens, Surface
from .figures import estrin, float_text, horner
from .focus_range import FocusRange, gaps_of
from .functions import ASPHERE, ROUGH_STEP, STEP
from .pupil_outlines import Doubles
from .pupil_table import STOPS, PupilTable

_HEIGHT_TOLERANCE = 3e-6
"""Of the film's diagonal. The height itself bends no light, but where it is off, light meets another slope."""
_SLOPE_TOLERANCE = 3e-5
"""At the worst place light then misses its own by less than so many focal lengths or diagonals: 0.04 of 1200 pixels."""
_MOST_TERMS = 30
_ROUGH_TERMS, _ROUGH_STEPS, _STEPS = (2, 3, 4), range(4), range(1, 9)
_FARTHEST_STEP = 0.05
"""Of the rim. A last step that is longer has not found the surface."""
_AZIMUTHS, _RINGS = 9, 8
_NODES = np.cos(np.pi * (np.arange(2 * _MOST_TERMS) + 0.5) / (2 * _MOST_TERMS))


@dataclass(frozen=True)
class Asphere:
    """The height over the vertex, mm, is a polynomial of t, which is -1 on the axis and 1 at the rim, and grows as the
    square of the distance from the axis. Beyond the rim its slope in t stays.

    A ray is followed from the plane z = start_mm by Newton's method: by some steps with a polynomial of few terms, then
    by some with the height's own. After the last one its second derivative corrects the slope.
    """

    height: Chebyshev
    rough: Chebyshev
    start_mm: float
    rim_mm: float
    rough_steps: int
    steps: int

    @property
    def scale(self) -> float:
        """t = scale r^2 - 1."""
        return 2 / self.rim_mm**2

    @property
    def operations(self) -> int:
        """About so many are the sums and products of the steps; a division is worth eight."""
        return self.rough_steps * (4 * self.rough.degree() + 14) + self.steps * (6 * self.height.degree() + 18)

    def function(self, number: int, mirror: bool) -> str:
        """OSL for the surface of this number."""
        height, rough = (each.convert(kind=Polynomial) for each in (self.height, self.rough))
        powers, text = estrin(height.coef, "t")
        rough_step = ROUGH_STEP.format(height=horner(rough.coef, "next"), slope=horner(rough.deriv().coef, "next"))
        return ASPHERE.format(
            number=number,
            powers="".join(f"    {power}\n" for power in powers),
            height=text,
            slope=estrin(height.deriv().coef, "t")[1],
            bow=estrin(height.deriv(2).coef, "t")[1],
            start=float_text(self.start_mm),
            scale=float_text(self.scale),
            lean=float_text(2 * self.scale),
            farthest=float_text(_FARTHEST_STEP * self.rim_mm),
            turn="-2 * along" if mirror else "(forwards * sqrt(refracted) - along)",
            steps=rough_step * self.rough_steps + STEP.format(number=number) * self.steps,
        )

    def met(self, at: Doubles, way: Doubles) -> tuple[Doubles, Doubles, Doubles, NDArray[np.bool_]]:
        """Of rays (N, 3) z in mm, the slope in t and t, as the shader finds them, and whether it does."""
        start = self.scale * (at[:, 0] ** 2 + at[:, 1] ** 2) - 1
        b = self.scale * (at[:, 0] * way[:, 0] + at[:, 1] * way[:, 1])
        a = self.scale * (way[:, 0] ** 2 + way[:, 1] ** 2)
        path = (self.start_mm - at[:, 2]) / way[:, 2]
        following = start + path * (2 * b + path * a)
        for height in [self.rough] * self.rough_steps + [self.height] * self.steps:
            t = following
            near = t if height is self.rough else np.minimum(t, 1)
            slope = height.deriv()(near)
            miss = at[:, 2] + path * way[:, 2] - height(near) - slope * (t - near)
            step = miss / (way[:, 2] - 2 * slope * (b + path * a))
            path = path - step
            following = start + path * (2 * b + path * a)
        slope = slope + self.height.deriv(2)(near) * (following - t)
        # A ray that leaves through the surface comes from its other side.
        enters = (way[:, 2] - 2 * slope * (b + path * a)) * way[:, 2] > 0
        found = enters & (abs(step) < _FARTHEST_STEP * self.rim_mm) & (following < 1)
        return at[:, 2] + path * way[:, 2], slope, following, found


def is_asphere(surface: Surface) -> bool:
    return surface.type in ("refracting", "mirror") and bool(surface.conic or surface.aspheric_coefficients)


def aspheres(focusing: FocusRange, table: PupilTable, wavelengths_nm: Sequence[float]) -> dict[int, Asphere]:
    """By surface, with as few steps as are within the tolerances for all rays that the shader draws.

    Raises InputError where no number of steps is enough, with the surface.
    """
    surfaces = [i for i, surface in enumerate(focusing.lens.surfaces) if is_asphere(surface)]
    if not surfaces:
        return {}
    rays: dict[int, list[tuple[Doubles, Doubles]]] = {i: [] for i in surfaces}
    for lens, origins_mm, ways in _drawn(focusing, table):
        vertices_mm = np.cumsum([0.0, *gaps_of(lens)])
        for wavelength_nm, i in product(wavelengths_nm, surfaces):
            at, way = origins_mm, ways
            crossed = len(lens.surfaces) - 1 - i
            if crossed:
                traced = lens.trace(origins_mm, ways, surface_count=crossed, wavelength_nm=wavelength_nm)
                at, way = (part[traced.status == 0] for part in (traced.origins_mm, traced.directions))
            rays[i].append((at - [0, 0, vertices_mm[i]], way))
    return {i: _asphere(focusing.lens, i, *map(np.concatenate, zip(*rays[i], strict=True))) for i in surfaces}


def _drawn(focusing: FocusRange, table: PupilTable) -> Iterator[tuple[Lens, Doubles, Doubles]]:
    """At each focus of the table the lens, and origins and directions of its rays from the middle of each pupil to its
    edge. The other half of a pupil is the same."""
    ring, azimuth = np.meshgrid(np.linspace(0, 1, _RINGS), np.linspace(0, np.pi, _AZIMUTHS))
    across, up = (ring * np.cos(azimuth)).ravel(), (ring * np.sin(azimuth)).ravel()
    widest = table.ellipses[:, STOPS.index(1.0)]
    for focus, ellipses in zip(np.linspace(0, 1, len(widest)), widest, strict=True):
        lens = focusing.lens_at(focus)
        rows = np.linspace(0, 1, len(ellipses))[:, None]
        radius_mm = table.reach_mm * (1 - (1 - rows) ** 2) + 0 * across
        l = ellipses[:, :1] + ellipses[:, 1:2] * across  # noqa: E741
        m = ellipses[:, 2:3] * up
        there = l * l + m * m < 1
        l, m, radius_mm = l[there], m[there], radius_mm[there]  # noqa: E741
        origins_mm = np.stack([radius_mm, 0 * radius_mm, np.full_like(radius_mm, lens.film_position_mm)], axis=1)
        yield lens, origins_mm, np.stack([l, m, -np.sqrt(1 - l * l - m * m)], axis=1)


def _asphere(lens: Lens, index: int, at: Doubles, way: Doubles) -> Asphere:
    surface = lens.surfaces[index]
    rim_mm = surface.clear_semi_diameter_mm
    heights = np.array([surface.sag_mm(rim_mm * math.sqrt(0.5 * (1 + t))) for t in _NODES])
    diagonal_mm, focal_mm = math.hypot(*lens.film_mm), abs(lens.first_order().effective_focal_length_mm)
    steepness = _SLOPE_TOLERANCE * min(1, diagonal_mm / focal_mm)
    # Rows: heights, and their derivatives over t. dz/dr = dz/dt 4 r / rim^2, at most dz/dt 4 / rim.
    tolerance = np.array([[_HEIGHT_TOLERANCE * diagonal_mm], [steepness * rim_mm / 4]])
    places = np.linspace(-1, 1, 401)

    def fitted(degree: int) -> Chebyshev:
        fit: Chebyshev = Chebyshev.fit(_NODES, heights, degree, domain=[-1, 1])
        return fit

    def shape(height: Chebyshev) -> Doubles:
        return np.array([height(places), height.deriv()(places)])

    finest = fitted(_MOST_TERMS)
    heights_fit = (fitted(degree) for degree in range(2, _MOST_TERMS))
    height = next((fit for fit in heights_fit if (abs(shape(fit) - shape(finest)) < tolerance).all()), finest)
    start_mm = 0.5 * float(heights.min() + heights.max())
    _, _, t, exists = Asphere(height, height, start_mm, rim_mm, 0, 20).met(at, way)
    # At the rim itself rounding decides.
    inside = exists & (t < 0.999)
    tried = [
        Asphere(height, rough, start_mm, rim_mm, rough_steps, steps)
        for rough, rough_steps, steps in product(map(fitted, _ROUGH_TERMS), _ROUGH_STEPS, _STEPS)
    ]
    for asphere in sorted(tried, key=lambda each: each.operations):
        z, slope, t, found = asphere.met(at, way)
        off = np.array([z - height(t), slope - height.deriv()(t)])
        if found[inside].all() and (abs(off) < tolerance)[:, found].all():
            return asphere
    raise InputError(
        f'lens "{lens.name}" cannot be written as OSL: Newton\'s method does not find all rays on surface {index + 1}'
    )
