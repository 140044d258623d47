"""How far the numbers of a lens may be off, and what that is for each of its surfaces."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from .._core import InputError, Lens
from .elements import check_element, check_surface, elements_of, has_glass_behind
from .grades import GRADES

Limits = float | Mapping[int, float] | None
ElementLimits = float | Mapping[tuple[int, int], float] | None

# What each field is, its unit in words, and the errors that it consists of, with the unit in which they count.
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
RADII = ("radius_percent", "radius_mm", "radius_fringes")
# Beyond these a number is another lens's.
MOST = {"radius_percent": 50.0, "abbe_percent": 50.0, "index": 0.2}
TILTS_MOST_ARCMIN = 600.0


@dataclass(frozen=True)
class Tolerance:
    """One tolerance of a lens. kind: a field of Tolerances. first, last: surfaces, from 0; the same but for elements.
    limit: to either side, or in any direction, in the unit of the kind."""

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
        """With surfaces counted from 1, as in drawings and reports: "radius of surface 3"."""
        where = (
            f"surface {self.first + 1}" if self.first == self.last else f"surfaces {self.first + 1} to {self.last + 1}"
        )
        return f"{self.quantity} of {where}"

    @property
    def errors(self) -> list[tuple[str, int, int]]:
        return [(name, self.first, self.last) for name in KINDS[self.kind][2]]

    @property
    def scale(self) -> float:
        """From the unit to that in which its errors count."""
        return KINDS[self.kind][3]

    @property
    def is_directed(self) -> bool:
        return len(KINDS[self.kind][2]) == 2


@dataclass(frozen=True)
class Tolerances:
    """How far the numbers of a lens may be off, to either side.

    Each is a number for all surfaces that have it, a dict of surface, from 0, and limit, or None. Of elements the dict
    has (first, last) surface; what is cemented is one element.
    radius: of curvature; a number of fringes is for planes where one of percent or mm is for the others. Fringes are
    half wavelengths of the e line in the sag at the rim, and so are those of irregularity, from valley to peak of an
    astigmatic form. thickness: glass and air, to the next surface; what is behind moves with it. index: at the d line,
    of a melt. abbe: of it, in percent. wedge: between the faces of an element, as the tilt of all but its first.
    surface and element: about a surface's vertex or an element's middle, in any direction.
    distribution: "uniform" up to the limit (of directed ones, over the disc), or "normal" with the limit at two
    standard deviations, and cut there.
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
        """Those of a shop: "commercial", "precision" or "high". docs/tolerances.md has the tables and their sources.
        Raises InputError."""
        if name not in GRADES:
            raise InputError(
                f'unknown grade "{name!s:.40}"; {", ".join(list(GRADES)[:-1])} or {list(GRADES)[-1]} is wanted'
            )
        return Tolerances(**GRADES[name], distribution=distribution)

    def of(self, lens: Lens) -> list[Tolerance]:
        """Each tolerance of that lens by itself, those of 0 left out. Raises InputError for surfaces that do not exist
        or cannot have it, and for limits that are none."""
        check_distribution(self.distribution)
        found = []
        for field in fields(self):
            limits = getattr(self, field.name)
            if field.name == "distribution" or limits is None:
                continue
            if isinstance(limits, Mapping):
                given = {_key(key): limit for key, limit in limits.items()}
                for (first, last), limit in given.items():
                    _check_place(lens, field.name, first, last)
                    _check_limit(field.name, limit, f" of surface {first + 1}")
            else:
                _check_limit(field.name, limits, "")
                given = dict.fromkeys(self._places(lens, field.name), limits)
            found += [Tolerance(field.name, *place, float(limit)) for place, limit in given.items() if limit > 0]
        if not found:
            raise InputError("there is no tolerance: at least one above 0 is wanted")
        return found

    def _places(self, lens: Lens, kind: str) -> Iterator[tuple[int, int]]:
        """Where a number for all surfaces applies."""
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
        """Of several limits for all surfaces, the one that counts: a plane has only fringes."""
        return next(
            (
                kind
                for kind in RADII
                if isinstance(getattr(self, kind), int | float) and not _why_not(lens, kind, surface)
            ),
            None,
        )


def check_distribution(name: str) -> None:
    if name not in ("uniform", "normal"):
        raise InputError(f'unknown distribution "{name!s:.40}"; uniform or normal is wanted')


def errors_of(tolerances: list[Tolerance]) -> list[tuple[str, int, int]]:
    return [error for tolerance in tolerances for error in tolerance.errors]


def drawn(tolerances: list[Tolerance], distribution: str, copies: int, seed: int) -> NDArray[np.float64]:
    """(copies, errors): their sizes. The first copies are the same however many follow."""
    from scipy.special import ndtr, ndtri  # slow to load

    count = sum(len(t.errors) for t in tolerances)
    shares = np.random.Generator(np.random.PCG64(seed)).random((copies, count))
    sizes = np.empty_like(shares)
    column = 0
    for tolerance in tolerances:
        most = tolerance.limit * tolerance.scale
        share = shares[:, column]
        if not tolerance.is_directed:
            if distribution == "uniform":
                sizes[:, column] = most * (2 * share - 1)
            else:
                sizes[:, column] = 0.5 * most * ndtri(ndtr(-2) + share * (ndtr(2) - ndtr(-2)))
            column += 1
            continue
        if distribution == "uniform":
            radius = most * np.sqrt(share)
        else:
            radius = 0.5 * most * np.sqrt(-2 * np.log1p(-share * (1 - math.exp(-2))))
        azimuth = 2 * np.pi * shares[:, column + 1]
        sizes[:, column], sizes[:, column + 1] = radius * np.cos(azimuth), radius * np.sin(azimuth)
        column += 2
    return sizes


def _key(key: int | tuple[int, int]) -> tuple[int, int]:
    if isinstance(key, tuple):
        if len(key) != 2:
            raise InputError(f"{key!r:.40} is no element; the numbers of its first and last surface are wanted")
        return key
    return key, key


def _check_place(lens: Lens, kind: str, first: int, last: int) -> None:
    if kind.startswith("element"):
        check_element(lens, first, last)
        return
    check_surface(lens, first)
    if first != last:
        raise InputError(f"{kind}: ({first}, {last}) is no surface; a number from 0 is wanted")
    if why := _why_not(lens, kind, first):
        raise InputError(f"{kind}: {why}")


def _check_limit(kind: str, limit: float, where: str) -> None:
    try:
        value = float(limit)
    except (TypeError, ValueError):
        value = math.nan
    if not (value >= 0 and math.isfinite(value)):
        raise InputError(f"{kind}{where} is {limit!r:.40}; a number of 0 or more is wanted")
    most = TILTS_MOST_ARCMIN if kind.endswith("arcmin") else MOST.get(kind, math.inf)
    if value > most:
        raise InputError(f"{kind}{where} is {value:g}; at most {most:g} is wanted")


def _is_plane(lens: Lens, surface: int) -> bool:
    s = lens.surfaces[surface]
    return s.curvature_per_mm == 0 and not s.aspheric_coefficients and s.form == "conic" and not s.xy_terms


def _why_not(lens: Lens, kind: str, surface: int) -> str:
    """Why a surface cannot have a tolerance; empty: it can."""
    s = lens.surfaces[surface]
    if kind == "thickness_mm":
        if surface == len(lens.surfaces) - 1:
            return f"surface {surface + 1} is the last; the film follows it, which is refocused"
        return ""
    if s.type in ("stop", "aperture"):
        return f"surface {surface + 1} is a {s.type}, which bends no light"
    if kind in ("radius_mm", "radius_percent") and s.curvature_per_mm == 0:
        return f"surface {surface + 1} is a plane and has no radius; radius_fringes is wanted"
    if kind in ("index", "abbe_percent"):
        if not has_glass_behind(lens, surface):
            return f"there is no glass behind surface {surface + 1}"
        if kind == "abbe_percent" and not s.material.index(486.1327) > s.material.index(656.2725):
            return f"the dispersion of the glass behind surface {surface + 1} is not known"
    if kind == "wedge_arcmin" and (surface == 0 or not has_glass_behind(lens, surface - 1)):
        return f"there is no glass in front of surface {surface + 1}, and no wedge; surface_tilt_arcmin is wanted"
    return ""
