"""Aspheres for OSL: the cheapest polynomial and number of Newton steps that are accurate for the rays of the lens."""

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
"""Relative to the film's diagonal. An error of the sag matters because the ray then meets a different slope."""
_SLOPE_TOLERANCE = 3e-5
"""Largest error of the image point, in focal lengths or film diagonals: 0.04 pixels of 1200."""
_MAX_TERMS = 30
_ROUGH_TERMS, _ROUGH_STEPS, _STEPS = (2, 3, 4), range(4), range(1, 9)  # candidates for Asphere's fields
_MAX_LAST_STEP = 0.05
"""Relative to the rim. If the last Newton step is longer, the intersection has not converged."""
_AZIMUTHS, _RINGS = 9, 8  # of the test rays in a pupil
# Chebyshev nodes in t at which polynomials are fitted.
_NODES = np.cos(np.pi * (np.arange(2 * _MAX_TERMS) + 0.5) / (2 * _MAX_TERMS))


@dataclass(frozen=True)
class Asphere:
    """Sag in mm as a polynomial of t, which is linear in the squared distance from the axis: -1 on the axis, 1 at the
    rim.

    Beyond the rim the sag is continued linearly in t. A ray is intersected by Newton's method from the plane z =
    start_mm: first `rough_steps` with a polynomial of few terms, then `steps` with the sag itself. Finally the second
    derivative corrects the slope.
    """

    height: Chebyshev
    rough: Chebyshev
    start_mm: float
    rim_mm: float
    rough_steps: int
    steps: int

    @property
    def scale(self) -> float:
        """Factor in t = scale r^2 - 1, per mm^2."""
        return 2 / self.rim_mm**2

    @property
    def operations(self) -> int:
        """Approximate number of additions and multiplications of all steps; a division counts as eight."""
        return self.rough_steps * (4 * self.rough.degree() + 14) + self.steps * (6 * self.height.degree() + 18)

    def function(self, number: int, mirror: bool) -> str:
        """OSL functions of the surface with this number."""
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
            farthest=float_text(_MAX_LAST_STEP * self.rim_mm),
            turn="-2 * along" if mirror else "(forwards * sqrt(refracted) - along)",
            steps=rough_step * self.rough_steps + STEP.format(number=number) * self.steps,
        )

    def intersected(self, at: Doubles, way: Doubles) -> tuple[Doubles, Doubles, Doubles, NDArray[np.bool_]]:
        """Intersects rays as the shader does. at, way: (N, 3), positions, mm, from the vertex, and directions.

        Returns z in mm, slope dz/dt, t, and true if an intersection is found, (N,) each.
        """
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
        # Rejects intersections at which the ray crosses the surface from the wrong side.
        enters = (way[:, 2] - 2 * slope * (b + path * a)) * way[:, 2] > 0
        found = enters & (abs(step) < _MAX_LAST_STEP * self.rim_mm) & (following < 1)
        return at[:, 2] + path * way[:, 2], slope, following, found


def is_asphere(surface: Surface) -> bool:
    """True if the surface is not a sphere or plane."""
    return surface.type in ("refracting", "mirror") and bool(surface.conic or surface.aspheric_coefficients)


def aspheres(focusing: FocusRange, table: PupilTable, wavelengths_nm: Sequence[float]) -> dict[int, Asphere]:
    """Returns the aspheres by surface, each the cheapest that is within the tolerances for all rays that the shader
    draws.

    Raises InputError, which names the surface, if no number of steps is enough.
    """
    surfaces = [i for i, surface in enumerate(focusing.lens.surfaces) if is_asphere(surface)]
    if not surfaces:
        return {}
    rays: dict[int, list[tuple[Doubles, Doubles]]] = {i: [] for i in surfaces}
    for lens, origins_mm, directions in _pupil_rays(focusing, table):
        vertices_mm = np.cumsum([0.0, *gaps_of(lens)])
        for wavelength_nm, i in product(wavelengths_nm, surfaces):
            at, way = origins_mm, directions
            crossed = len(lens.surfaces) - 1 - i
            if crossed:
                traced = lens.trace(origins_mm, directions, surface_count=crossed, wavelength_nm=wavelength_nm)
                at, way = (part[traced.status == 0] for part in (traced.origins_mm, traced.directions))
            rays[i].append((at - [0, 0, vertices_mm[i]], way))
    return {i: _asphere(focusing.lens, i, *map(np.concatenate, zip(*rays[i], strict=True))) for i in surfaces}


def _pupil_rays(focusing: FocusRange, table: PupilTable) -> Iterator[tuple[Lens, Doubles, Doubles]]:
    """Yields, for each focus of the table, the lens with origins and directions of rays from the centre of each pupil
    to its edge. Only one half of each pupil is sampled, as it is mirror-symmetric."""
    ring, azimuth = np.meshgrid(np.linspace(0, 1, _RINGS), np.linspace(0, np.pi, _AZIMUTHS))
    across, up = (ring * np.cos(azimuth)).ravel(), (ring * np.sin(azimuth)).ravel()
    widest = table.ellipses[:, STOPS.index(1.0)]
    for focus, ellipses in zip(np.linspace(0, 1, len(widest)), widest, strict=True):
        lens = focusing.lens_at(focus)
        rows = np.linspace(0, 1, len(ellipses))[:, None]
        radius_mm = table.reach_mm * (1 - (1 - rows) ** 2) + 0 * across
        l = ellipses[:, :1] + ellipses[:, 1:2] * across  # noqa: E741
        m = ellipses[:, 2:3] * up
        exists = l * l + m * m < 1
        l, m, radius_mm = l[exists], m[exists], radius_mm[exists]  # noqa: E741
        origins_mm = np.stack([radius_mm, 0 * radius_mm, np.full_like(radius_mm, lens.film_position_mm)], axis=1)
        yield lens, origins_mm, np.stack([l, m, -np.sqrt(1 - l * l - m * m)], axis=1)


def _asphere(lens: Lens, index: int, at: Doubles, way: Doubles) -> Asphere:
    """The cheapest asphere of a surface for these rays, (N, 3), from its vertex. Raises InputError."""
    surface = lens.surfaces[index]
    rim_mm = surface.clear_semi_diameter_mm
    heights = np.array([surface.sag_mm(rim_mm * math.sqrt(0.5 * (1 + t))) for t in _NODES])
    diagonal_mm, focal_mm = math.hypot(*lens.film_mm), abs(lens.first_order().effective_focal_length_mm)
    steepness = _SLOPE_TOLERANCE * min(1, diagonal_mm / focal_mm)
    # Rows: sags, and their derivatives in t. dz/dr = dz/dt 4 r / rim^2, at most dz/dt 4 / rim.
    tolerance = np.array([[_HEIGHT_TOLERANCE * diagonal_mm], [steepness * rim_mm / 4]])
    positions = np.linspace(-1, 1, 401)

    def fitted(degree: int) -> Chebyshev:
        fit: Chebyshev = Chebyshev.fit(_NODES, heights, degree, domain=[-1, 1])
        return fit

    def shape(height: Chebyshev) -> Doubles:
        return np.array([height(positions), height.deriv()(positions)])

    finest = fitted(_MAX_TERMS)
    heights_fit = (fitted(degree) for degree in range(2, _MAX_TERMS))
    height = next((fit for fit in heights_fit if (abs(shape(fit) - shape(finest)) < tolerance).all()), finest)
    start_mm = 0.5 * float(heights.min() + heights.max())
    _, _, t, exists = Asphere(height, height, start_mm, rim_mm, 0, 20).intersected(at, way)
    # At the rim itself rounding decides whether a ray passes.
    inside = exists & (t < 0.999)
    candidates = [
        Asphere(height, rough, start_mm, rim_mm, rough_steps, steps)
        for rough, rough_steps, steps in product(map(fitted, _ROUGH_TERMS), _ROUGH_STEPS, _STEPS)
    ]
    for asphere in sorted(candidates, key=lambda each: each.operations):
        z, slope, t, found = asphere.intersected(at, way)
        errors = np.array([z - height(t), slope - height.deriv()(t)])
        if found[inside].all() and (abs(errors) < tolerance)[:, found].all():
            return asphere
    raise InputError(
        f'lens "{lens.name}" cannot be written as OSL: Newton\'s method does not find all rays on surface {index + 1}'
    )
