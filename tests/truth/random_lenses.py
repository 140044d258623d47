"""Lenses that nobody designed and that could be made: a seed gives a prescription.

Glass and air alternate, with cemented surfaces in between, so that the index goes up and down; the last surface's
curvature gives the lens its f-number, the paraxial rays of the field give each surface its size, and thicknesses grow
until no two surfaces touch within their rims. What cannot be made so is drawn again.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np

from .prescription import Prescription, Row

F_NUMBERS = (2.0, 20.0)
HALF_FIELDS_DEG = (2.0, 20.0)
INDICES = (1.35, 2.0)
CONIC_SHARE, ASPHERE_SHARE = 0.25, 0.25
MIRROR_SHARE = 0.05
STEEPEST = 0.75  # rim over radius
EDGE_GAP = 0.05  # mm between neighbouring surfaces, at the least


@dataclass(frozen=True)
class RandomLens:
    prescription: Prescription
    half_field_deg: float


class UnmakeableError(Exception):
    """This draw does not lead to a lens."""


def random_lens(seed: int) -> RandomLens:
    rng = np.random.default_rng(seed)
    # 1 to 20 surfaces, each number equally often.
    draw = _two_mirrors if rng.uniform() < MIRROR_SHARE else lambda g: _refracting(g, 1 + seed % 20)
    for _ in range(20000):
        try:
            rows, half_field = draw(rng)
            return RandomLens(Prescription(f"random-{seed}", tuple(rows)), half_field)
        except UnmakeableError:
            continue
    raise RuntimeError(f"seed {seed} gives no lens")


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def _sag(row: Row, radii: np.ndarray) -> np.ndarray:
    r2 = radii**2
    radicand = 1 - (1 + row.conic) * (row.curvature * radii) ** 2
    if radicand.min() < 0.1:
        raise UnmakeableError("the rim is close to the conic's end")
    sag = row.curvature * r2 / (1 + np.sqrt(radicand))
    for power, a in row.coefficients.items():
        sag = sag + a * r2 ** (power // 2)
    return sag


def _media(rng: np.random.Generator, count: int) -> list[float]:
    """Index behind each surface."""
    indices, behind = [], 1.0
    for i in range(count):
        last = i + 1 == count
        # A cement keeps the light in glass. A lens may end in glass or water, as an eye does.
        to_air = behind != 1 and (rng.uniform() < 0.7 if not last else rng.uniform() < 0.95)
        behind = 1.0 if to_air else round(rng.uniform(*INDICES), 5)
        indices.append(behind)
    return indices


def _paraxial(rows: list[Row], height: float, slope: float) -> list[tuple[float, float]]:
    """(height, slope behind) at each surface of a lens without mirrors."""
    out, index = [], 1.0
    for row in rows:
        slope = (index * slope - height * row.curvature * (row.index - index)) / row.index
        out.append((height, slope))
        height, index = height + row.thickness * slope, row.index
    return out


def _refracting(rng: np.random.Generator, count: int) -> tuple[list[Row], float]:
    f_number = _log_uniform(rng, *F_NUMBERS)
    half_field = rng.uniform(*HALF_FIELDS_DEG)
    beam = _log_uniform(rng, 1.5, 15.0)  # height of the marginal ray
    final_slope = -1 / (2 * f_number)
    indices = _media(rng, count)
    rows: list[Row] = []
    height, slope, index = beam, 0.0, 1.0
    for i, behind in enumerate(indices):
        if i + 1 < count:
            curvature = 0.0
            if rng.uniform() > 0.08:
                curvature = rng.choice([-1, 1]) / (beam * _log_uniform(rng, 1.8, 25.0))
        else:
            # The last surface gives the f-number.
            curvature = (index * slope - behind * final_slope) / (height * (behind - index))
        radius = round(1 / curvature, 4) if curvature else math.inf
        thickness = beam * (_log_uniform(rng, 0.1, 0.6) if behind != 1 else _log_uniform(rng, 0.02, 0.8))
        row = Row("refracting", beam, radius, round(thickness, 3), behind)
        slope = (index * slope - height * row.curvature * (behind - index)) / behind
        # Neither a steeper cone than the lens's own (with some leave), nor a beam that grows or dies.
        if abs(slope) > max(1.3 * abs(final_slope), 0.15):
            raise UnmakeableError("too strong a surface")
        height += row.thickness * slope
        index = behind
        if not 0.4 * beam < height < 1.6 * beam:
            raise UnmakeableError("the beam leaves the usual width")
        rows.append(row)
    rows = _with_stop(rng, rows)
    rows = _sized(rows, beam, half_field)
    rows = _aspherized(rng, rows)
    _check_edges(rows)
    return rows, half_field


def _with_stop(rng: np.random.Generator, rows: list[Row]) -> list[Row]:
    """A stop in front of the lens, behind it, or in an air gap, which it halves."""
    places = [i for i in range(len(rows) + 1) if i == 0 or rows[i - 1].index == 1]
    # The middle of the lens is the usual place.
    weights = np.array([1.0 + 2 * (0.25 < i / len(rows) < 0.75) for i in places])
    place = int(rng.choice(places, p=weights / weights.sum()))
    gap = rows[place - 1].thickness if place else rows[0].semi_diameter
    stop = Row("stop", 1.0, thickness=round(0.5 * gap, 3))
    before = rows[:place]
    if before:
        before[-1] = replace(before[-1], thickness=round(0.5 * gap, 3))
    return [*before, stop, *rows[place:]]


def _sized(rows: list[Row], beam: float, half_field: float) -> list[Row]:
    """Rims for the beams of the field, and room between the surfaces."""
    tangent = math.tan(math.radians(half_field))
    stop = next(i for i, row in enumerate(rows) if row.type == "stop")
    for _ in range(30):
        unit_height, unit_slope = _paraxial(rows, 1.0, 0.0), _paraxial(rows, 0.0, 1.0)
        # The chief ray of the edge of the field crosses the axis in the stop.
        entrance = unit_slope[stop][0] / unit_height[stop][0]
        chief = _paraxial(rows, -tangent * entrance, tangent)
        if abs(entrance) > 6 * beam or abs(unit_height[stop][0]) < 0.3:
            raise UnmakeableError("a pupil far from the lens")
        u, y = unit_slope[-1][1] - entrance * unit_height[-1][1], unit_slope[-1][0] - entrance * unit_height[-1][0]
        if abs(u) < 0.05 or abs(y / u) > 50 * beam:
            raise UnmakeableError("telecentric on the film's side")
        out, grown = [], False
        for i, row in enumerate(rows):
            axial = abs(beam * unit_height[i][0])
            if i == stop:
                out.append(replace(row, semi_diameter=round(axial, 3)))
                continue
            rim = 1.08 * axial + min(abs(chief[i][0]), 0.9 * axial)
            if rim * abs(row.curvature) > STEEPEST:
                rim = STEEPEST / abs(row.curvature)
                if rim < 1.05 * axial:
                    raise UnmakeableError("the axial beam does not fit through")
            out.append(replace(row, semi_diameter=round(rim, 3)))
        for i in range(len(out) - 1):
            lack = _lack(out[i], out[i + 1])
            if lack > 0:
                out[i] = replace(out[i], thickness=round(out[i].thickness + lack + 0.01, 3))
                grown = True
        rows = out
        if not grown:
            f_number = 1 / abs(2 * beam * unit_height[-1][1])
            if not F_NUMBERS[0] <= f_number <= 1.3 * F_NUMBERS[1]:
                raise UnmakeableError("f-number")
            return rows
    raise UnmakeableError("no room between the surfaces")


def _lack(row: Row, following: Row) -> float:
    """By how much the gap is too narrow, anywhere within the larger of the two rims, for neither to touch."""
    reach = max(row.semi_diameter, following.semi_diameter)
    shares = np.linspace(0, 1, 101)
    # A smaller surface is edged flat at its own rim.
    front = _sag(row, np.minimum(shares * reach, row.semi_diameter))
    back = _sag(following, np.minimum(shares * reach, following.semi_diameter))
    return float((front - back).max()) + EDGE_GAP - row.thickness


def _asphere(rng: np.random.Generator, rim: float) -> dict[int, float]:
    """Terms whose sags at the rim are up to 4% of it, less in each higher one."""
    terms = int(rng.integers(1, 8))
    sags = [rng.uniform(-1, 1) * 0.04 * rim * 0.6**i for i in range(terms)]
    return {4 + 2 * i: float(f"{sag / rim ** (4 + 2 * i):.5e}") for i, sag in enumerate(sags)}


def _aspherized(rng: np.random.Generator, rows: list[Row]) -> list[Row]:
    out = []
    for row in rows:
        changed = row
        if row.type != "stop":
            if rng.uniform() < CONIC_SHARE and math.isfinite(row.radius):
                changed = replace(changed, conic=round(rng.uniform(-3, 0.5), 4))
            if rng.uniform() < ASPHERE_SHARE:
                changed = replace(changed, coefficients=_asphere(rng, row.semi_diameter))
        out.append(changed)
    return out


def _check_edges(rows: list[Row]) -> None:
    if any(_lack(row, following) > 0 for row, following in itertools.pairwise(rows)):
        raise UnmakeableError("surfaces touch")


def _two_mirrors(rng: np.random.Generator) -> tuple[list[Row], float]:
    """A Cassegrain telescope with conics near the classical ones, some with higher terms; some with a rear lens."""
    beam, half_field = _log_uniform(rng, 20, 60), rng.uniform(0.3, 1.0)
    primary_f = 2 * beam * rng.uniform(2.0, 4.0)
    apart = primary_f * rng.uniform(0.6, 0.75)
    magnification = rng.uniform(1.8, 3.5)
    left = primary_f - apart
    second_radius = 2 * left * magnification / (magnification - 1)
    tangent = math.tan(math.radians(half_field))
    small = 1.1 * beam * left / primary_f + 1.2 * tangent * apart
    hole = round(0.6 * small, 3)

    def mirror(radius: float, rim: float, thickness: float, conic: float, inner: float) -> Row:
        coefficients = {}
        if rng.uniform() < 0.5:
            coefficients = {power: a * 1e-3 for power, a in _asphere(rng, rim).items()}
        return Row(
            "mirror", round(rim, 3), round(radius, 4), round(thickness, 3), 1.0, conic, coefficients, round(inner, 3)
        )

    behind = apart + 0.1 * primary_f
    second_conic = -(((magnification + 1) / (magnification - 1)) ** 2)
    rows = [
        Row("stop", round(beam, 3), thickness=round(0.05 * apart, 3)),
        Row("aperture", round(1.3 * beam, 3), thickness=round(apart, 3), inner_semi_diameter=round(1.05 * small, 3)),
        mirror(-2 * primary_f, 1.2 * beam, -apart, round(-rng.uniform(0.8, 1.1), 4), hole),
        mirror(-second_radius, small, behind, round(second_conic * rng.uniform(0.8, 1.2), 4), 0.0),
    ]
    if rng.uniform() < 0.5:
        # A rear lens in the hole; the light that meets it lies within.
        glass = round(rng.uniform(*INDICES), 5)
        rows[-1] = replace(rows[-1], thickness=round(apart, 3))
        bend = rng.choice([-1, 1]) / (hole * rng.uniform(4, 20))
        rows.append(Row("refracting", hole, round(1 / bend, 4), round(0.4 * hole, 3), glass))
        rows.append(Row("refracting", hole, round(rng.uniform(0.8, 1.5) / bend, 4)))
    return rows, half_field
