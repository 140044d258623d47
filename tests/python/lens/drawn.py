"""Lenses and rays that hypothesis draws for test_properties.py: ordinary ones mixed with hard cases."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import realcam as rc
from hypothesis import strategies as st

ANY = st.one_of(st.floats(), st.sampled_from([0.0, -0.0, 1e-300, 1e-12, 1.0, 36.0, 1e18, 1e300, math.inf, math.nan]))


@dataclass(frozen=True)
class Row:
    """A surface's numbers, lengths in units of the lens's own size."""

    type: str
    curvature: float
    conic: float
    aspheric: tuple[float, ...]  # terms at the rim, from r^4
    thickness: float
    index: float
    rim: float

    def surface(self, size: float) -> rc.Surface:
        rim = self.rim * size
        powers = {4 + 2 * i: a * size / rim ** (4 + 2 * i) for i, a in enumerate(self.aspheric)}
        shape = {} if self.type == "stop" else {"conic": self.conic, "aspheric_coefficients": powers}
        if self.type == "refracting":
            shape["material"] = self.index
        radius = size / self.curvature if self.curvature else math.inf
        return rc.Surface(
            type=self.type,
            radius_of_curvature_mm=radius,
            thickness_mm=self.thickness * size,
            clear_semi_diameter_mm=rim,
            **shape,
        )


@st.composite
def rows(draw: st.DrawFn, hard: bool) -> Row:
    """A refracting surface. Hard: hemispheres, flats of 1e-12, conics from -1e3 to 1e3, walls, no thickness."""
    rim = draw(st.floats(0.3, 1.5))
    conic = draw(st.one_of(st.just(0.0), st.floats(-2, 1), st.floats(-1e3, 1e3) if hard else st.just(-1.0)))
    steepest = 1 / (rim * math.sqrt(1 + conic)) if conic > -1 else 10 / rim
    steepest *= 1 - 1e-12  # 1 / (1 / c) may round to more than a hemisphere
    share = st.floats(-0.6, 0.6)
    if hard:
        share = st.one_of(share, st.sampled_from([0.0, 1e-12, -1e-12, 1.0, -1.0]), st.floats(-1, 1))
    term = st.floats(-1, 1) if hard else st.floats(-0.01, 0.01)
    return Row(
        type="refracting",
        curvature=steepest * draw(share),
        conic=conic,
        aspheric=draw(st.one_of(st.just(()), st.tuples(term), st.tuples(term, term, term))),
        thickness=draw(st.one_of(st.floats(0.01, 1), st.sampled_from([0.0, 1e-9])) if hard else st.floats(0.05, 1)),
        index=draw(st.one_of(st.floats(1.3, 2), st.sampled_from([1.0, 1.0000001, 4.0])) if hard else st.floats(1.3, 2)),
        rim=rim,
    )


@dataclass(frozen=True)
class Drawn:
    rows: tuple[Row, ...]
    size: float

    def lens(self, scale: float = 1.0) -> rc.Lens:
        size = self.size * scale
        surfaces = [row.surface(size) for row in self.rows]
        # Nobody asked whether it can be made.
        return rc.Lens(surfaces=surfaces, film_distance_mm=3 * size, allow_overlap=True)


@st.composite
def lenses(draw: st.DrawFn, *, hard: bool, largest: int = 5) -> Drawn:
    found = draw(st.lists(rows(hard), min_size=1, max_size=largest))
    # Glass and air take turns, so that light comes through.
    found = [replace(row, index=row.index if i % 2 == 0 else 1.0) for i, row in enumerate(found)]
    if hard and len(found) >= 2 and draw(st.booleans()):
        # Two mirrors, and light that goes back between them.
        found[0] = replace(found[0], type="mirror", thickness=-found[0].thickness)
        found[1] = replace(found[1], type="mirror")
    plane = draw(rows(hard))
    stop = Row("stop", 0.0, 0.0, (), abs(plane.thickness), 1.0, plane.rim)
    place = draw(st.sampled_from([0, len(found)]))
    found.insert(place, stop)
    return Drawn(tuple(found), draw(st.sampled_from([1.0, 8.0, 0.125, 100.0])))


def rays(drawn: Drawn, start: str, seed: int, count: int = 64) -> tuple[np.ndarray, np.ndarray]:
    """From within a few sizes in front of the lens towards its first surface; lens frame."""
    rng = np.random.default_rng(seed)
    size = drawn.size
    first = drawn.rows[0] if start == "scene" else drawn.rows[-1]
    direction = 1.0 if start == "scene" else -1.0
    z = 0.0 if start == "scene" else drawn.lens().vertices_mm[-1]
    turn, radius = rng.uniform(0, 2 * np.pi, count), first.rim * size * np.sqrt(rng.uniform(0, 1, count))
    target = np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(count, z)], axis=1)
    spread = 10 ** rng.uniform(-3, 0, (count, 1))
    directions = np.concatenate([spread * rng.uniform(-1, 1, (count, 2)), np.full((count, 1), direction)], axis=1)
    return target - rng.uniform(2, 5, (count, 1)) * size * directions, directions
