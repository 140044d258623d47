"""Manufacturing tolerances of a lens, and their expansion into tolerances of single surfaces and elements."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from .._core import InputError, Lens
from ..dispersion import LINE_C_NM, LINE_F_NM
from .elements import check_element, check_surface, elements_of, has_glass_behind
from .grades import GRADES

Limits = float | Mapping[int, float] | None
ElementLimits = float | Mapping[tuple[int, int], float] | None

# For each field of Tolerances: quantity, unit, names of the core's errors that it consists of (two if it is directed),
# and factor from its unit to the errors' unit.
KINDS: dict[str, tuple[str, str, tuple[str, ...], float]] = {
    "radius_mm": ("radius", "mm", ("radius",), 1.0),
    "radius_percent": ("radius", "%", ("radius_percent",), 1.0),
    "radius_fringes": ("radius", "fringes", ("radius_fringes",), 1.0),
    "thickness_mm": ("thickness", "mm", ("thickness",), 1.0),
    "index": ("index", "", ("index",), 1.0),
    "abbe_percent": ("Abbe number", "%", ("abbe_percent",), 1.0),
    "wedge_arcmin": ("wedge", "'", ("surface_tilt_x", "surface_tilt_y"), 1 / 60),
    "surface_tilt_arcmin": ("surface tilt", "'", ("surface_tilt_x", "surface_tilt_y"), 1 / 60),
    "surface_decentre_mm": ("surface decentre", "mm", ("surface_decentre_x", "surface_decentre_y"), 1.0),
    "element_tilt_arcmin": ("element tilt", "'", ("element_tilt_x", "element_tilt_y"), 1 / 60),
    "element_decentre_mm": ("element decentre", "mm", ("element_decentre_x", "element_decentre_y"), 1.0),
    "irregularity_fringes": ("irregularity", "fringes", ("irregularity_0", "irregularity_45"), 1.0),
}
# Kinds of radius tolerances, in descending order of precedence.
RADII = ("radius_percent", "radius_mm", "radius_fringes")
# Largest limits; beyond them the lens would be a different one.
MAX_LIMITS = {"radius_percent": 50.0, "abbe_percent": 50.0, "index": 0.2}
MAX_TILT_ARCMIN = 600.0


@dataclass(frozen=True)
class Tolerance:
    """One tolerance of a lens. kind: a field of Tolerances. first, last: surfaces, counted from 0; they differ only for
    elements. limit: plus or minus, or in any direction, in the unit of the kind."""

    kind: str
    first: int
    last: int
    limit: float

    @property
    def quantity(self) -> str:
        return KINDS[self.kind][0]

    @property
    def unit(self) -> str:
        return KINDS[self.kind][1]

    @property
    def label(self) -> str:
        """Text such as "radius of surface 3", with surfaces counted from 1, as in drawings and reports."""
        where = (
            f"surface {self.first + 1}" if self.first == self.last else f"surfaces {self.first + 1} to {self.last + 1}"
        )
        return f"{self.quantity} of {where}"

    @property
    def errors(self) -> list[tuple[str, int, int]]:
        """(name, first surface, last surface) of the core's errors."""
        return [(name, self.first, self.last) for name in KINDS[self.kind][2]]

    @property
    def scale(self) -> float:
        """Factor from the tolerance's unit to the unit of its errors."""
        return KINDS[self.kind][3]

    @property
    def is_directed(self) -> bool:
        """True if the error has a direction: two components."""
        return len(KINDS[self.kind][2]) == 2


@dataclass(frozen=True)
class Tolerances:
    """Manufacturing tolerances of a lens, as plus or minus limits.

    Each field is a number for all surfaces to which it applies, a dict from surface (counted from 0) to limit, or None.
    For elements the keys are (first, last) surface; a cemented group is one element.
    radius: of curvature; if percent or mm and fringes are all numbers, the fringes apply to planes only. A fringe is
    half a wavelength of the e line in the sag at the rim; irregularity is the peak-to-valley of an astigmatic form in
    fringes. thickness: of glass or air, to the next surface; everything behind moves with it. index: at the d line, of
    a melt. abbe: Abbe number, in percent. wedge: between the faces of an element, as a tilt of every face but its
    first. surface and element: tilt and decentre about a surface's vertex or an element's centre, in any direction.
    distribution: "uniform" up to the limit (for directed tolerances, over the disc), or "normal" with the limit at two
    standard deviations, truncated there.
    """

    radius_mm: Limits = None
    radius_percent: Limits = None
    radius_fringes: Limits = None
    thickness_mm: Limits = None
    index: Limits = None
    abbe_percent: Limits = None
    wedge_arcmin: Limits = None
    surface_tilt_arcmin: Limits = None
    surface_decentre_mm: Limits = None
    element_tilt_arcmin: ElementLimits = None
    element_decentre_mm: ElementLimits = None
    irregularity_fringes: Limits = None
    distribution: str = "uniform"

    @staticmethod
    def grade(name: str, *, distribution: str = "uniform") -> Tolerances:
        """Returns the tolerances of a grade: "commercial", "precision" or "high". docs/tolerances.md has the tables and
        their sources. Raises InputError."""
        if name not in GRADES:
            raise InputError(
                f'unknown grade "{name!s:.40}"; expected {", ".join(list(GRADES)[:-1])} or {list(GRADES)[-1]}'
            )
        return Tolerances(**GRADES[name], distribution=distribution)

    def of(self, lens: Lens) -> list[Tolerance]:
        """Expands into the individual tolerances of a lens, without those of 0. Raises InputError for a surface that
        does not exist or to which a tolerance does not apply, and for an invalid limit."""
        check_distribution(self.distribution)
        found = []
        for field in fields(self):
            limits = getattr(self, field.name)
            if field.name == "distribution" or limits is None:
                continue
            if isinstance(limits, Mapping):
                by_surfaces = {_key(key): limit for key, limit in limits.items()}
                for (first, last), limit in by_surfaces.items():
                    _check_surfaces(lens, field.name, first, last)
                    _check_limit(field.name, limit, f" of surface {first + 1}")
            else:
                _check_limit(field.name, limits, "")
                by_surfaces = dict.fromkeys(self._surfaces(lens, field.name), limits)
            found += [
                Tolerance(field.name, *surfaces, float(limit)) for surfaces, limit in by_surfaces.items() if limit > 0
            ]
        if not found:
            raise InputError("at least one tolerance must be above 0")
        return found

    def _surfaces(self, lens: Lens, kind: str) -> Iterator[tuple[int, int]]:
        """(first, last) surfaces to which a number for all surfaces applies."""
        if kind.startswith("element"):
            yield from elements_of(lens)
            return
        for surface in range(len(lens.surfaces)):
            if _why_not(lens, kind, surface) or (kind in RADII and self._radius_kind(lens, surface) != kind):
                continue
            if kind == "surface_decentre_mm" and _is_plane(lens, surface):
                continue
            if kind == "thickness_mm" and lens.surfaces[surface].thickness_mm == 0:
                continue
            yield surface, surface

    def _radius_kind(self, lens: Lens, surface: int) -> str | None:
        """The kind of radius tolerance that applies if several are numbers for all surfaces: a plane has only
        fringes."""
        return next(
            (
                kind
                for kind in RADII
                if isinstance(getattr(self, kind), int | float) and not _why_not(lens, kind, surface)
            ),
            None,
        )


def check_distribution(name: str) -> None:
    """Raises InputError for an unknown distribution."""
    if name not in ("uniform", "normal"):
        raise InputError(f'unknown distribution "{name!s:.40}"; expected uniform or normal')


def errors_of(tolerances: list[Tolerance]) -> list[tuple[str, int, int]]:
    """(name, first surface, last surface) of all errors of the tolerances, in order."""
    return [error for tolerance in tolerances for error in tolerance.errors]


def drawn(tolerances: list[Tolerance], distribution: str, copies: int, seed: int) -> NDArray[np.float64]:
    """Draws the errors, (copies, errors), in the core's units. The first copies do not depend on their number."""
    from scipy.special import ndtr, ndtri  # slow to load

    count = sum(len(t.errors) for t in tolerances)
    uniform = np.random.Generator(np.random.PCG64(seed)).random((copies, count))
    sizes = np.empty_like(uniform)
    column = 0
    for tolerance in tolerances:
        limit = tolerance.limit * tolerance.scale
        u = uniform[:, column]
        if not tolerance.is_directed:
            if distribution == "uniform":
                sizes[:, column] = limit * (2 * u - 1)
            else:
                sizes[:, column] = 0.5 * limit * ndtri(ndtr(-2) + u * (ndtr(2) - ndtr(-2)))
            column += 1
            continue
        if distribution == "uniform":
            radius = limit * np.sqrt(u)
        else:
            radius = 0.5 * limit * np.sqrt(-2 * np.log1p(-u * (1 - math.exp(-2))))
        azimuth = 2 * np.pi * uniform[:, column + 1]
        sizes[:, column], sizes[:, column + 1] = radius * np.cos(azimuth), radius * np.sin(azimuth)
        column += 2
    return sizes


def _key(key: int | tuple[int, int]) -> tuple[int, int]:
    """(first, last) surface of a key of the limits. Raises InputError."""
    if isinstance(key, tuple):
        if len(key) != 2:
            raise InputError(f"an element must be the indices of its first and last surface; found {key!r:.40}")
        return key
    return key, key


def _check_surfaces(lens: Lens, kind: str, first: int, last: int) -> None:
    """Raises InputError if a tolerance does not apply to these surfaces."""
    if kind.startswith("element"):
        check_element(lens, first, last)
        return
    check_surface(lens, first)
    if first != last:
        raise InputError(f"{kind}: expected a surface, as an index from 0; found ({first}, {last})")
    if why := _why_not(lens, kind, first):
        raise InputError(f"{kind}: {why}")


def _check_limit(kind: str, limit: float, where: str) -> None:
    try:
        value = float(limit)
    except (TypeError, ValueError):
        value = math.nan
    if not (value >= 0 and math.isfinite(value)):
        raise InputError(f"{kind}{where} is {limit!r:.40}; expected a number of 0 or more")
    largest = MAX_TILT_ARCMIN if kind.endswith("arcmin") else MAX_LIMITS.get(kind, math.inf)
    if value > largest:
        raise InputError(f"{kind}{where} is {value:g}; expected at most {largest:g}")


def _is_plane(lens: Lens, surface: int) -> bool:
    s = lens.surfaces[surface]
    return s.curvature_per_mm == 0 and not s.aspheric_coefficients and s.form == "conic" and not s.xy_terms


def _why_not(lens: Lens, kind: str, surface: int) -> str:
    """Reason why a tolerance does not apply to a surface; empty if it does."""
    s = lens.surfaces[surface]
    if kind == "thickness_mm":
        if surface == len(lens.surfaces) - 1:
            return f"surface {surface + 1} is the last; the distance to the film is adjusted by refocusing"
        return ""
    if s.type in ("stop", "aperture"):
        return f"surface {surface + 1} is a {s.type}, which does not refract"
    if kind in ("radius_mm", "radius_percent") and s.curvature_per_mm == 0:
        return f"surface {surface + 1} is a plane and has no radius; use radius_fringes"
    if kind in ("index", "abbe_percent"):
        if not has_glass_behind(lens, surface):
            return f"there is no glass behind surface {surface + 1}"
        if kind == "abbe_percent" and not s.material.index(LINE_F_NM) > s.material.index(LINE_C_NM):
            return f"the dispersion of the glass behind surface {surface + 1} is unknown"
    if kind == "wedge_arcmin" and (surface == 0 or not has_glass_behind(lens, surface - 1)):
        return f"there is no glass in front of surface {surface + 1}, and no wedge; use surface_tilt_arcmin"
    return ""
